/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_IMPLICIT_PARTS_H
#define LMP_MPM_IMPLICIT_PARTS_H

#include "implicit/mpm_implicit_options.h"
#include "implicit/mpm_solved_nodes.h"

#include "platform.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

class MPMConstraints;
class MPMForceBalance;
class MPMFreeBodies;

/** Result of an implicit step. */
struct MPMImplicitReport {
  /** Greatest asymmetry of tangents, for conjugate gradients. */
  static constexpr double SYMMETRIC = 1.0e-3;

  bool converged = false;
  int iterations = 0, linear = 0, cuts = 0;
  int made = 0;          ///< number of times that levels, or factors, of a tangent were made
  int indefinite = 0;    ///< iterations in which the energy had no minimum along some direction
  int parts = 0;         ///< parts of the step that converged
  /** There was no balance without the stiffness of nodes that points barely reach. */
  bool stuck = false;
  /** Energy of the stiffness of nodes that points barely reach [mass velocity^2]. */
  double stabilizing = 0.0;
  double reached = 0.0;             ///< share of the step that was reached
  double unbalanced = 0.0;          ///< sum of the unbalanced forces [mass acceleration]
  double ratio = 0.0;               ///< ratio of these to all forces
  double water = 0.0;               ///< the same ratio for the equations of a pressure of nodes
  double asymmetry = 0.0;           ///< asymmetry of the tangents
  std::vector<double> residuals;    ///< sums of forces before each iteration of the last part
  std::string failure;

  /** Adds the counts of an attempt that failed before. */
  void add_counts(const MPMImplicitReport &other)
  {
    iterations += other.iterations;
    linear += other.linear;
    cuts += other.cuts;
    made += other.made;
    indefinite += other.indefinite;
  }
};

/** Times of the parts of implicit steps, in seconds of this rank. */
class MPMImplicitTimes {
 public:
  /** Forces of trial motions, tangents, preconditioners, and linear systems. */
  enum Part { FORCES, TANGENTS, PRECONDITIONERS, SYSTEMS, NPARTS };
  double seconds[NPARTS] = {};

  /** Adds its lifetime to the time of a part, without the time of other clocks within it. */
  class Clock {
   public:
    Clock(MPMImplicitTimes &times, Part which) :
        times(times), which(which), outer(times.running), start(platform::walltime())
    {
      times.running = this;
    }
    ~Clock()
    {
      const double passed = platform::walltime() - start;
      times.seconds[which] += passed - within;
      if (outer) outer->within += passed;
      times.running = outer;
    }
    Clock(const Clock &) = delete;
    Clock &operator=(const Clock &) = delete;

   private:
    MPMImplicitTimes &times;
    const Part which;
    Clock *const outer;
    const double start;
    double within = 0.0;
  };

 private:
  Clock *running = nullptr;
};

/** What all parts of an implicit step share. */
struct MPMImplicitParts {
  MPMSolvedNodes &nodes;
  MPMForceBalance &balance;
  MPMConstraints &constraints;
  MPMFreeBodies &free_bodies;
  const MPMImplicitOptions &options;
  MPMImplicitReport &report;
  MPMImplicitTimes &times;
};

}    // namespace LAMMPS_NS
#endif
