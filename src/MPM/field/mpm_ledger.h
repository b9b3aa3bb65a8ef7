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

/** Energies spent or gained by a field since the first step with a ledger, share of this rank
 *  [energy]. */
struct MPMEnergies {
  /** Work of atom->f (gravity, contact by pair styles, walls, ...) and of loads given as a
   *  stress. */
  double external;
  double boundary;    ///< work of node actions of kind boundary
  double contact;     ///< work of node actions between fields
  double internal;    ///< work of stress at the mean of old and new velocity, taken from the motion
  double transfer;    ///< kinetic energy gained (mostly lost: negative) by transfers and collisions
  double deleted_kinetic, deleted_stored;    ///< energy of points that were deleted
};

/** Energy accounts of a field. Each account is a sum of its own: works are forces or impulses times
 *  velocities, and transfers are differences of kinetic energies before and after. No account is
 *  found as the remainder of the others, so their balance is a check; see "The ledger" in the
 *  developer guide. Where forces on points are an acceleration that most have in common, this check
 *  is made in some of the steps only: in the others, the work of stress is what nodes lose. */
class MPMLedger : protected Pointers, public MPMEnergies {
 public:
  bool on = false;    ///< a compute mpm/energy exists; set in init()
  /** Work that moving walls, rigid bodies, grains, and atoms have done on the nodes, share of this
   *  rank [energy]. Counted in any run, without losses by friction at walls and between bodies. */
  double driven = 0.0;
  /** Initial values of compute mpm/energy, until the end of the next run. */
  std::vector<double> start;

  MPMLedger(class LAMMPS *lmp, MPMField &field) : Pointers(lmp), MPMEnergies(), field(field) {}

  /** Start of a run. Collective. */
  void setup();
  /** Before anything changes the velocities of points in a step: what other fixes and commands have
   *  done to them since the last one is in no account. */
  void begin_step();
  /** Called after the momentum equation, before node actions. */
  void nodes_solved()
  {
    impulses.clear();
    spent_before = spent();
  }
  /** Something acts on the nodes in this step that has an account of its own outside of the time
   *  from nodes_solved() to account_for_nodes(), or none: work is counted at points. To be called
   *  in each such step, on all ranks. */
  void count_at_points() { at_points = true; }
  /** Accounts for the work of forces and kinetic energies, before points receive the changes at the
   *  nodes. */
  void account_for_nodes();
  /** End of a step: accounts for the change by the transfer from nodes to points. */
  void account_for_points();
  /** Accounts for points that are about to be deleted. */
  void remove(double kinetic, double stored)
  {
    deleted_kinetic -= kinetic;
    deleted_stored -= stored;
    kinetic_points -= kinetic;
  }

  /** Accounts for kinetic energy that points lost to the account of other physics. */
  void take(double kinetic) { kinetic_points -= kinetic; }

  /** Changes the velocity of a node by an impulse; the work counts as contact if the node is
   *  owned. */
  void push_node(double *record, bool owned, const double *impulse);
  /** The same for an impulse that acts over the whole step: its work is that at the mean of old and
   *  new velocity, without the loss of a collision. */
  void drag_node(double *record, bool owned, const double *impulse);
  /** Counts a change of the velocity of an owned node by contact. record: already with the new
   *  velocity. */
  void count_push(const double *record, const double *change);
  /** Notes a change of the velocity of an owned node by any action, after which others may follow.
   *  The impulse is the mass of the node times the difference of change and change_old. change_old:
   *  of the old velocity; null: none. */
  void note_push(const double *record, const double *change, const double *change_old = nullptr);
  /** Counts the change of all nodes from these velocities [node][3] to those of the records, which
   *  are due to further terms of a series. */
  void count_series(const std::vector<double> &velocities);

  /** Sums over the nodes that this rank owns, with the velocities before the momentum equation and
   *  with the present ones. */
  struct NodeSums {
    double old_energy = 0.0, energy = 0.0;    ///< kinetic
    double mass = 0.0, momentum[3] = {};      ///< of the mean of both velocities
  };
  NodeSums sums_over_nodes() const;
  /** Kinetic energy of this rank's points [energy]. */
  double point_kinetic_energy() const;

 private:
  MPMField &field;
  double kinetic_points = 0.0;    // at the end of the last step
  bool disturbed = false;         // other fixes may change velocities after it
  // [node][3] of node actions on owned nodes in this step; empty: none
  std::vector<double> impulses;
  // of forces in this step, at the mean of the old and the new velocity of the nodes
  double work_at_nodes = 0.0;
  // points with other forces than those of the common acceleration, in rising order where there is
  // one, and [other][6] their places and velocities before points move
  std::vector<int> others;
  std::vector<double> starts;
  double spent_before = 0.0;    // spent() before node actions
  // acceleration that nearly all points have in common in this step, by the forces on them, and
  // before points move the sum of their masses times the place along it, and of their momenta
  bool common = false, at_points = false;    // at_points: see count_at_points()
  double acceleration[3] = {};
  struct PointSums {
    double place = 0.0, velocity = 0.0;
  } before_motion;

  bool finds_others() const;
  double *impulse(const double *record);
  static bool change_by(double *record, const double *impulse, double change[3]);
  /** What the accounts say that nodes have gained. */
  double spent() const { return external + boundary + contact + transfer - internal; }
  bool elect_acceleration(const MPM_NS::PointRows &, double a[3]) const;
  bool finds_common_acceleration(const NodeSums &);
  bool is_accelerated() const
  {
    return acceleration[0] != 0.0 || acceleration[1] != 0.0 || acceleration[2] != 0.0;
  }
  PointSums sums_along_acceleration() const;
  void account_for_forces(const NodeSums &);
  void account_at_points();
  void note_starts();
  void find_other_force(const MPM_NS::PointRows &, int i, double f[3]) const;
  /** Of forces on others beyond the common acceleration, and of loads given as a stress. */
  struct OtherPowers {
    double forces = 0.0, loads = 0.0;
  };
  OtherPowers powers_of_others();
  double added_stress_power(MPM_NS::PointRows &, int first, int n, const double *L) const;
  double work_on_points(double &late) const;
  double stress_power(MPM_NS::PointRows &, int first, int n, const double *L) const;
};

/** Keeps the energies that a run has started with. Implemented by a compute. */
class MPMEnergyStart {
 public:
  /** Sums and accounts at the start of the ledger, for restart files; empty before the start. */
  virtual const std::vector<double> &start_sums() const = 0;

 protected:
  ~MPMEnergyStart() = default;    // owned and deleted as a Compute
};

}    // namespace LAMMPS_NS
#endif
