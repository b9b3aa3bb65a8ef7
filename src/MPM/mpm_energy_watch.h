/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_ENERGY_WATCH_H
#define LMP_MPM_ENERGY_WATCH_H

#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Tells when numerics add energy to the points (keyword gain of fix mpm).
 *
 *  What all points have and have spent may grow by the work that is done on them. That of moving
 *  walls, rigid bodies, atoms, and deleted points is always counted; what friction takes at walls and
 *  between bodies is not: where it holds material at rest, nodes have velocities that points do not
 *  have, and its work is mostly spurious. That of forces on points is estimated from a part of the
 *  points in each step. What is left is the sum of the errors transfer, integration and residual of
 *  compute mpm/energy. It counts from its lowest value in a run, so that
 *  energy that a dissipative transfer took at first does not hide what is added later, and is
 *  compared with the energy in play: the largest sum so far of kinetic energy, stored energy, and
 *  energy spent in this run.
 */
class MPMEnergyWatch : protected Pointers {
 public:
  MPMEnergyWatch(class LAMMPS *lmp, const std::vector<MPMField *> &fields) :
      Pointers(lmp), fields(fields)
  {
  }

  /** Start of a run. */
  void start() { run = {}; }
  /** Start of a step of the cycle, where positions, velocities, and forces belong to one time. */
  void step();
  /** End of a run. */
  void finish();
  /** A line about the energy of the run for its summary; empty where too little is known. */
  std::string report() const;

 private:
  /** Sums over all ranks. */
  struct Sums {
    double points, mass;
    double kinetic, stored, spent;
    double work;    // done on the points, less what deleted points had
    /** Energy that work does not explain, from the same start. */
    double unexplained() const { return kinetic + stored + spent - work; }
  };

  const std::vector<MPMField *> &fields;
  struct {
    bigint steps;
    double force_work;    // of forces on points, this rank's share
    Sums start;
    double lowest;     // energy that work does not explain
    double in_play;    // largest energy so far
    double gained;     // since it was lowest
    Sums last;         // at the last look
    bool told;
  } run = {};

  void add_force_work();
  /** That on points from begin to end, one of so many at most. */
  void add_force_work(int begin, int end, int most);
  Sums sums() const;
  void begin(const Sums &);
  void check();
};

}    // namespace LAMMPS_NS
#endif
