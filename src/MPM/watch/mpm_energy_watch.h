/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_ENERGY_WATCH_H
#define LMP_MPM_ENERGY_WATCH_H

#include "field/mpm_interfaces.h"
#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Detects when numerical errors add energy to the points (keyword gain of fix mpm).
 *
 *  The energy that all points have and have spent may grow by the work that is done on them. The
 *  work of moving walls, rigid bodies, atoms, and deleted points is always counted. The work of
 *  friction at walls and between bodies is not: where friction holds material at rest, nodes have
 *  velocities that points do not have, and its work is mostly spurious. The work of forces on
 *  points is that on all points where most of it is done, as those under a load. On the others it
 *  is estimated from a part of them in each step, chosen by their IDs, so that it does not depend
 *  on their order.
 *
 *  The remaining growth is the sum of the errors transfer, integration, and residual of compute
 *  mpm/energy. It counts from its lowest value in a run, so that energy that a dissipative transfer
 *  took at first does not hide energy that is added later. It is compared with the energy in play:
 *  the largest sum so far of kinetic energy, stored energy, and energy spent in this run.
 *
 *  Where nothing but transfers can take energy without an account, it also warns of what they
 *  take. */
class MPMEnergyWatch : public MPMWatch, protected Pointers {
 public:
  MPMEnergyWatch(class LAMMPS *lmp, const std::vector<MPMField *> &fields) :
      Pointers(lmp), fields(fields)
  {
  }

  /** Start of a run. */
  void start() override;
  /** Start of a step of the cycle, where positions, velocities, and forces belong to one time. */
  void step() override;
  /** Later in the same step: points have moved and have their new velocities, and still have the
   *  forces and the places in memory of its start. */
  void moved() override;
  /** End of a run. */
  void finish() override;
  /** A line about the energy of the run for its summary; empty if too little is known. */
  std::string report() const override;

 private:
  /** Sums over all ranks. */
  struct Sums {
    double points, met, mass;    // met: points that pair styles may act on
    double kinetic, stored, spent;
    double heat;       // part of the stored energy, in the accounts of physics
    double elastic;    // part of the stored energy that is not heat: in the stress of points
    double work;       // done on the points, less the energy of deleted points
    /** Energy that work does not explain, up to a constant. */
    double unexplained() const { return kinetic + stored + spent - work; }
  };

  static constexpr int AHEAD = 16;
  /** The points from begin to end in memory. Each is looked at in one of 2^bits steps (its turn).
   *  places: points whose turn comes in this step or one of the next AHEAD - 1. */
  struct Part {
    int bits = 0;
    int begin = -1, end = -1, first = 0;    // first: turn of places[0]
    bigint list = -1;                       // step of the neighbor list
    struct Place {
      int field, i;
    };
    std::vector<Place> places[AHEAD];
  };

  const std::vector<MPMField *> &fields;
  Part parts[2];
  std::vector<const double *> forces;    // [field] on points in this step
  // forces other than gravity on points: none, those of pair styles, any
  enum Loads { NO_LOADS, PAIRS, ANY_LOADS } loads = NO_LOADS;
  double much = 0.0;          // points with a larger power are looked at in each step
  double mean_power = 0.0;    // of the last step, on this rank
  /** A point that is looked at in this step, once in so many turns, with its place and velocity
   *  before. */
  struct Seen {
    int field, i, turns;
    double x[3], v[3];
  };
  std::vector<Seen> seen;
  struct {
    bigint steps;
    double force_work;    // of forces on points, this rank's share
    Sums start;
    double lowest;        // least energy so far that work does not explain
    double in_play;       // largest energy so far
    double mechanical;    // the same without heat
    double gained;        // unexplained energy above the lowest
    Sums last;            // of the last check
    double elastic;       // at the start of the step that has noted it
    bigint noted;         // steps done by then, plus 1; 0: none
    bool warned;          // has a warning of gained energy been printed?
    bool warned_of_loss;
  } run = {};

  int number_met() const;
  Loads kind_of_loads() const;
  void find_forces();
  double power_on(int field, int i, double half) const;
  void note_loaded(int end);
  void note(int field, int i, int turns);
  void note_points(Part &, int begin, int end);
  void find_places(Part &) const;
  void choose_turns(const Sums &);
  Sums sums() const;
  bool strain_follows() const;
  bool is_last_step() const;
  double energy_at_hand() const;
  bool is_round_off(double energy) const;
  void center_start();
  void begin(const Sums &);
  void check();
  void note_play(const Sums &);
  bool only_transfers_take() const;
  void look_for_loss(double mass);
  bool is_much_in_play(double mass) const;
};

}    // namespace LAMMPS_NS
#endif
