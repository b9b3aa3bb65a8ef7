/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_GUARD_H
#define LMP_MPM_GUARD_H

#include "atom.h"
#include "field/mpm_field.h"

namespace LAMMPS_NS {

/** Treatment of points of a field that become bad or fail during a run (keywords bad and
 *  failed). */
class MPMGuard : protected Pointers {
 public:
  /** Sums over the points deleted so far on all ranks, as in restart files. */
  struct Deleted {
    double points, mass, momentum[3];
  } deleted = {};

  MPMGuard(class LAMMPS *lmp, MPMField &field) : Pointers(lmp), field(field) {}

  /** Position, velocity and volume ratio, for messages. */
  std::string describe(int i) const;
  /** Reports a bad point: stops, or notes it for handle_bad_points(). */
  void point_is_bad(
      int i, const std::string &what, const std::string &cure = "it keeps its previous deformation",
      const std::string &hint = ": try a smaller time step (fix mpm/dt), more points per cell, or "
                                "a smoother shape function; fix mpm ... bad warn|delete goes on");
  /** Notes a point that has failed and is to be deleted. */
  void point_has_failed(int i) { failed_points.push_back(atom->tag[i]); }
  /** Checks all positions: the kernels must never see one that is not finite. */
  void check_positions();
  /** End of a step: counts bad points and requests an exchange, at which bad or failed points are
   *  deleted. */
  void handle_bad_points();
  /** Called before an exchange, which would silently lose points outside of fixed faces: these
   *  points are bad. Deletes the points that are to be deleted. */
  void check_inside_box();
  /** Reports which other atoms (grains) the exchange will lose, unless thermo_modify lost ignores
   *  them. Collective. */
  void tell_lost_atoms() const;
  /** Wraps points back that have moved by more than a period of the box. LAMMPS subtracts one
   *  period when neighbor lists are made, which may be rare. */
  void wrap_far_points();

  /** May points of the field be deleted? */
  bool may_delete() const
  {
    return field.options.bad == MPMFieldOptions::DELETE || field.options.delete_failed;
  }
  /** Sets the number of points of all fields and ranks at the start of the run. */
  void expect_points(bigint n) { npoints = n; }
  /** Number of bad points so far. */
  bigint nbad() const { return nbad_total; }

  /** Points that fixes added to the field minus points that they removed, on this rank. A fix that
   *  counts points uses it to detect points that came or went for other reasons. */
  double brought = 0.0;

 private:
  MPMField &field;
  std::vector<tagint> bad_points;       // bad points of this step, policies warn and delete
  std::vector<tagint> failed_points;    // failed points of this step, to be deleted
  bigint nbad_total = 0;
  bigint npoints = 0;    // points of all fields and ranks at the start of the run

  void delete_points(std::vector<tagint> &, bool warn);    // also clears the list
};

}    // namespace LAMMPS_NS
#endif
