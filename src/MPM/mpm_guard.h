/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_GUARD_H
#define LMP_MPM_GUARD_H

#include "atom.h"
#include "mpm_field.h"

#include <optional>

namespace LAMMPS_NS {

/** Points of a field that go bad or fail, and what is done about it (keywords bad and failed). */
class MPMGuard : protected Pointers {
 public:
  /** What was deleted so far, on all ranks; as in restart files. */
  struct Deleted {
    double points, mass, momentum[3];
  } deleted = {};

  MPMGuard(class LAMMPS *lmp, MPMField &field) : Pointers(lmp), field(field) {}

  /** Set-up of a run: each point must have one material, one integrator, positive volume and mass, and
   *  a finite state; pair styles must know its radius. */
  void check_points() const;
  void check_integrators() const;
  /** Warns of material points that no field moves. */
  void check_other_points();
  /** Warns where places of points, which must be known, leave it to round-off what stress they get. */
  void check_places() const;
  /** Warns once of solids that keep their volume where nothing cures locking. Collective. */
  void check_locking();
  /** Settings of LAMMPS that make neighbor lists of points and grains slow; all fields. */
  void check_neighbors() const;
  void check_radii() const;
  /** Warns of lists that are mostly skin; when there are lists, and for all fields. */
  void check_lists() const;
  /** Other commands that do nothing to points, or harm, without a word; all fields. */
  void check_commands();

  /** What decides when neighbor lists are made, and with this the order of sums. */
  struct Lists {
    double skin;
    int every, delay, check, once;
  };
  Lists lists() const;
  /** Those of the restart file that the next set-up of a run goes on from. */
  std::optional<Lists> lists_of_file;

  /** Position, velocity and volume ratio, for messages. */
  std::string describe(int i) const;
  /** A point is bad: stop, or note it for handle_bad_points(). */
  void
  point_is_bad(int i, const std::string &what,
               const std::string &cure = "it keeps its previous deformation",
               const std::string &hint =
                   ": try a smaller time step (fix mpm/dt), more points per cell, or a smoother "
                   "shape function; fix mpm ... bad warn|delete goes on");
  /** A point has failed and is to be deleted. */
  void point_has_failed(int i) { failed_points.push_back(atom->tag[i]); }
  /** The kernels must never see a position that is not finite. */
  void check_positions();
  /** End of a step: count bad points, and ask for an exchange, at which points that are bad or have
   *  failed are deleted. */
  void handle_bad_points();
  /** Before an exchange, which would lose points outside of fixed faces silently: these are bad. Points
   *  that are to be deleted go. */
  void check_inside_box();
  /** Tells which other atoms (grains) the exchange will lose, unless thermo_modify lost ignores them; all
   *  ranks together. */
  void tell_lost_atoms() const;
  /** Points that have gone by more than a period of the box, come back into it: LAMMPS takes one period
   *  from them when neighbor lists are made, which it may do rarely. */
  void wrap_far_points();

  bool may_delete() const
  {
    return field.options.bad == MPMFieldOptions::DELETE || field.options.delete_failed;
  }
  bigint nbad() const { return nbad_total; }

  /** Points that fixes have brought into the field less those that they took, in this process: whoever counts points wants to
   *  know that none came or went for other reasons. */
  double brought = 0.0;

 private:
  MPMField &field;
  std::vector<tagint> bad_points;       // of this step, policies warn and delete
  std::vector<tagint> failed_points;    // of this step, to be deleted
  bigint nbad_total = 0;
  bool has_told_of_locking = false;
  bigint npoints = 0;    // of all fields and ranks, at the start of the run

  void check_rings() const;

  void check_fixes() const;
  void check_skin() const;
  void delete_points(std::vector<tagint> &, bool warn);    // and forget them
};

}    // namespace LAMMPS_NS
#endif
