/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_LEDGER_H
#define LMP_MPM_LEDGER_H

#include "pointers.h"

#include <vector>

namespace MPM_NS {
struct PointRows;
}

namespace LAMMPS_NS {
class MPMField;

/** Energy spent or gained by a field since the first step with a ledger, this rank's share [energy]. */
struct MPMEnergies {
  double
      external;    ///< work of atom->f (gravity, contact by pair styles, walls, ...) and of loads that are a stress
  double boundary;    ///< work of node actions of kind boundary
  double contact;     ///< work of node actions between fields
  double internal;    ///< work of stress at the mean of old and new velocity: taken from the motion
  double transfer;    ///< kinetic energy gained (mostly lost: negative) by transfers and collisions
  double deleted_kinetic, deleted_stored;    ///< energy of points that were deleted
};

/** The energy accounts of a field. Each of them is a sum of its own: works are forces or impulses times
 *  velocities, and transfers have kinetic energies before and after. None is what the others leave, so that
 *  their balance is a check, see "The ledger" in the developer guide. */
class MPMLedger : protected Pointers, public MPMEnergies {
 public:
  bool on = false;    ///< a compute mpm/energy exists; set in init()
  /** Work that moving walls, rigid bodies, grains, and atoms have done on the nodes, this rank's share [energy];
   *  counted in any run, without what is lost by friction at walls and between bodies. */
  double driven = 0.0;
  std::vector<double> start;    ///< of compute mpm/energy, until the end of the next run

  MPMLedger(class LAMMPS *lmp, MPMField &field) : Pointers(lmp), MPMEnergies(), field(field) {}

  /** Start of a run. */
  void setup()
  {
    if (on) kinetic_points = point_kinetic_energy();
  }
  /** After the momentum equation, before node actions. */
  void nodes_solved() { impulses.clear(); }
  /** Work of forces and kinetic energies, before points get what was done to the nodes. */
  void account_for_nodes();
  /** End of a step: what the way from nodes to points has changed. */
  void account_for_points();
  /** Points are about to be deleted. */
  void remove(double kinetic, double stored)
  {
    deleted_kinetic -= kinetic;
    deleted_stored -= stored;
    kinetic_points -= kinetic;
  }

  /** Points have lost kinetic energy that is in the account of other physics. */
  void take(double kinetic) { kinetic_points -= kinetic; }

  /** Change the velocity of a node by an impulse, which counts as contact where the node is owned. */
  void push_node(double *record, bool owned, const double *impulse);
  /** The same for an impulse that has the whole step to act: its work is that at the mean of old and new velocity,
   *  and nothing is lost as in a collision. */
  void drag_node(double *record, bool owned, const double *impulse);
  /** An owned node had its velocity changed by contact: its record has the new one. */
  void count_push(const double *record, const double *change);
  /** An owned node had its velocity changed by whatever action, after which others may come: its mass times
   *  the difference of the changes is the impulse. change_old: of the old velocity, null: none. */
  void note_push(const double *record, const double *change, const double *change_old = nullptr);
  /** All nodes have had these velocities [node][3] before, which have become those of the records by more
   *  terms of a series. */
  void count_series(const std::vector<double> &velocities);

  /** Of the nodes that this rank owns, with the velocities before the momentum equation and the present ones. */
  void nodal_kinetic_energies(double &old, double &now) const;
  double point_kinetic_energy() const;

 private:
  MPMField &field;
  double kinetic_points = 0.0;    // at the end of the last step
  std::vector<double>
      impulses;    // [node][3] of node actions on owned nodes in this step; empty: none

  double *impulse(const double *record);
  static bool change_by(double *record, const double *impulse, double change[3]);
  void account_for_forces();
  double stress_power(MPM_NS::PointRows &, int first, int n, const double *L) const;
};

}    // namespace LAMMPS_NS
#endif
