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

#include <optional>

namespace LAMMPS_NS {

/** Treatment of points of a field that become bad or fail (keywords bad and failed). */
class MPMGuard : protected Pointers {
 public:
  /** Sums over the points deleted so far on all ranks, as in restart files. */
  struct Deleted {
    double points, mass, momentum[3];
  } deleted = {};

  MPMGuard(class LAMMPS *lmp, MPMField &field) : Pointers(lmp), field(field) {}

  /** Set-up of a run: checks that each point has one material, one integrator, positive volume and mass, and a
   *  finite state, and that pair styles know its radius. */
  void check_points() const;
  /** Stops with an error if another fix integrates points of the field, too. */
  void check_integrators() const;
  /** Warns if there are material points that no field moves. */
  void check_other_points();
  /** Warns if points lie, by construction, at places where round-off decides which stress they get. */
  void check_places() const;
  /** Warns once about nearly incompressible solids without a cure for locking. Collective. */
  void check_locking();
  /** Warns about settings of LAMMPS that make neighbor lists of points and grains slow; for all fields. */
  void check_neighbors() const;
  /** Stops with an error if points that meet grains have no radius or one that is too large, or are rings
   *  around an axis of symmetry. */
  void check_radii() const;
  /** Warns if neighbor lists consist mostly of skin; call it once lists exist. For all fields. */
  void check_lists() const;
  /** Checks for other commands that silently have no effect on points, or do harm; for all fields. */
  void check_commands();

  /** Settings that decide when neighbor lists are made, and with this the order of sums. */
  struct Lists {
    double skin;
    int every, delay, check, once;
  };
  /** The present settings. */
  Lists lists() const;
  /** Settings of the restart file that the next set-up of a run continues from. */
  std::optional<Lists> lists_of_file;

  /** Position, velocity and volume ratio, for messages. */
  std::string describe(int i) const;
  /** Reports a bad point: stops, or notes it for handle_bad_points(). */
  void
  point_is_bad(int i, const std::string &what,
               const std::string &cure = "it keeps its previous deformation",
               const std::string &hint =
                   ": try a smaller time step (fix mpm/dt), more points per cell, or a smoother "
                   "shape function; fix mpm ... bad warn|delete goes on");
  /** Notes a point that has failed and is to be deleted. */
  void point_has_failed(int i) { failed_points.push_back(atom->tag[i]); }
  /** Checks all positions: the kernels must never see one that is not finite. */
  void check_positions();
  /** End of a step: counts bad points and requests an exchange, at which bad or failed points are deleted. */
  void handle_bad_points();
  /** Called before an exchange, which would silently lose points outside of fixed faces: these points are bad.
   *  Deletes the points that are to be deleted. */
  void check_inside_box();
  /** Reports which other atoms (grains) the exchange will lose, unless thermo_modify lost ignores them.
   *  Collective. */
  void tell_lost_atoms() const;
  /** Wraps points back that have moved by more than a period of the box. LAMMPS subtracts one period when
   *  neighbor lists are made, which may be rare. */
  void wrap_far_points();

  /** May points of the field be deleted? */
  bool may_delete() const
  {
    return field.options.bad == MPMFieldOptions::DELETE || field.options.delete_failed;
  }
  /** Number of bad points so far. */
  bigint nbad() const { return nbad_total; }

  /** Points that fixes added to the field minus points that they removed, on this rank. A fix that counts
   *  points uses it to detect points that came or went for other reasons. */
  double brought = 0.0;

 private:
  MPMField &field;
  std::vector<tagint> bad_points;       // bad points of this step, policies warn and delete
  std::vector<tagint> failed_points;    // failed points of this step, to be deleted
  bigint nbad_total = 0;
  bool has_told_of_locking = false;
  bigint npoints = 0;    // points of all fields and ranks at the start of the run

  void check_rings() const;

  void check_fixes() const;
  void check_skin() const;
  void delete_points(std::vector<tagint> &, bool warn);    // also clears the list
};

}    // namespace LAMMPS_NS
#endif
