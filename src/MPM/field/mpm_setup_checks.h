/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_SETUP_CHECKS_H
#define LMP_MPM_SETUP_CHECKS_H

#include "field/mpm_coupling.h"
#include "field/mpm_doubts.h"
#include "lmptype.h"
#include "pointers.h"

#include <optional>
#include <set>
#include <string>

namespace LAMMPS_NS {
class MPMField;

/** Checks of the input and of the points of a field at the start of each run. Each is one function,
 *  and stops with an error or warns. */
class MPMSetupChecks : protected Pointers {
 public:
  MPMSetupChecks(class LAMMPS *lmp, MPMField &field) :
      Pointers(lmp), uncoupled(lmp), field(field), doubts(lmp)
  {
  }

  /** Groups of checks, in the order in which they are possible. */
  enum When {
    POINTS,    ///< points have their materials
    PAIRS,     ///< only with a pair style
    PLACES,    ///< the frame knows where points are on the lattice
    LISTS      ///< only with a pair style: there are neighbor lists
  };
  /** Makes the checks of one group. first: also those that are of all fields together.
   *  Collective. */
  void run(When, bool first);

  /** Settings that decide when neighbor lists are made, and with this the order of sums. */
  struct Lists {
    double skin;
    int every, delay, check, once;
  };
  /** The present settings. */
  Lists lists() const;
  /** Settings of the restart file that the next run continues from. */
  std::optional<Lists> lists_of_file;

  MPMUncoupled uncoupled;    ///< of all fields

  /** Once in each step: what may become wrong in it. */
  void look();

  /** Stops with an error if points that meet grains have no radius or one that is too large, or are
   *  rings around an axis of symmetry. */
  void radii();

 private:
  MPMField &field;
  MPMDoubts doubts;
  bool warned_of_locking = false, warned_of_liquid = false, weighed = false;
  std::set<std::string> told_of;    // IDs of computes, columns of the log

  /** Is another fix an integrator of points of the field, too? */
  void integrators();
  /** Has each point one material, positive volume and mass, and a finite state? */
  void points();
  /** Have rings around an axis the volumes of rings? */
  void rings();
  /** Are there points that no field moves? */
  void forgotten_points();
  /** Is there other matter that goes through the points? */
  void coupling();
  /** Do other fixes silently have no effect on points, or do harm? */
  void fixes();
  /** Do regions reach across periodic faces? */
  void regions() { doubts.check_regions(); }
  /** Have new points temperatures that hardly anybody means? */
  void new_points();
  /** Do computes and columns of the log see a part of points only? */
  void computes();
  void columns();
  bool has_energies() const;
  void skin();
  /** Are neighbor lists made as in the run that wrote the restart file? */
  void lists_after_restart();
  /** Do settings of LAMMPS make neighbor lists of points and grains slow? */
  void neighbors();
  /** Are points, by construction, at places where round-off decides which stress they get? */
  void places();
  /** Are there nearly incompressible solids without a cure for locking? */
  void locking();
  /** Is there liquid next to bodies that deform, without smooth volumes? */
  void liquid_on_bodies();
  /** Do neighbor lists consist mostly of skin? */
  void lists_of_pairs();
};

/** Number of material points that are in both groups, of which these are the bits. Bits of groups
 *  say nothing about this by themselves: all points are in group all, whose bit no other group has.
 *  Collective. */
bigint points_in_both(class LAMMPS *, int one, int other);

/** What to do about a time step that is above a limit: a fix mpm/dt which is there has found the
 *  limit some steps before. */
std::string remedy_of_step(class LAMMPS *);

/** What time_integrate of a fix that moves material points is to be. LAMMPS warns when the groups
 *  of two integrators overlap, but atoms of this group that are no points may well be moved by
 *  others; refuse_other_integrators() looks at the points. One of all fixes remains an
 *  integrator. */
int seen_as_integrator(class LAMMPS *, const class Fix &mine);

/** Points need no ghosts: without forces between atoms, a cutoff that is next to nothing spares
 *  LAMMPS's warning about none. With pair forces it would warn of this one, too, and with bonds
 *  any cutoff of the user keeps it from taking one from their lengths. h: node spacing. Called in
 *  init(). */
void allow_no_ghosts(class LAMMPS *, double h);

/** Stops with an error if another fix, too, moves material points in the group of a fix that moves
 *  them. Called at the start of a run by all ranks. */
void refuse_other_integrators(class LAMMPS *, const class Fix &mine);

/** Warns of material points that no fix moves. A group contains the atoms that existed at the time
 *  of its command, so points that were made later are easily forgotten. style: of the fix that
 *  should move them; lack: the consequence for them. Returns the number of all points. */
bigint warn_of_forgotten_points(class LAMMPS *, const std::string &style, const std::string &lack);

}    // namespace LAMMPS_NS
#endif
