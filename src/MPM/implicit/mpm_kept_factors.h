/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_KEPT_FACTORS_H
#define LMP_MPM_KEPT_FACTORS_H

#include "implicit/mpm_implicit_options.h"
#include "implicit/mpm_implicit_report.h"
#include "implicit/mpm_kept_state.h"
#include "solve/shared_nodes.h"

#include <cstdint>
#include <vector>

namespace LAMMPS_NS {
class MPMConstraints;
class MPMForceBalance;
class MPMMotionSystem;
class MPMNewton;
class MPMSolvedNodes;
class MPMTangent;

/** Solves steps with inertia with what earlier steps have left: an extrapolation of their motions
 *  as the first guess, and factors of an earlier tangent, which quasi-Newton corrections bring up
 *  to date (see mpm_kept_factors.cpp). One field, without contact. */
class MPMKeptFactors {
 public:
  MPMKeptFactors(MPMSolvedNodes &, MPMForceBalance &, MPMConstraints &, MPMMotionSystem &,
                 MPMNewton &, const MPMImplicitOptions &, MPMImplicitReport &, MPMImplicitTimes &);

  /** Solves a step of duration dt from the guess u. False, with u as it was, if this does not lead
   *  to its end. Collective. */
  bool solve(std::vector<double> &u, double dt);
  /** Stores the motion u of a step that has been solved, in one way or another. Collective. */
  void store(const std::vector<double> &u);
  /** Discards all that was kept. */
  void clear()
  {
    kept.clear();
    large = false;
  }
  double memory_usage() const;

 private:
  MPMSolvedNodes &nodes;
  MPMForceBalance &balance;
  MPMConstraints &constraints;
  MPMMotionSystem &system;
  MPMNewton &newton;
  const MPMImplicitOptions &options;
  MPMImplicitReport &report;
  MPMImplicitTimes &times;
  MPMTangent &tangent;

  MPMKeptState kept;
  MPM_NS::SharedNodes shared;    // nodes with a mass, of all ranks
  double dt = 0.0;
  bool large = false;    // too many unknowns for factors: multigrid levels are used
  // share of the last correction that was made; 0: none that the factors have not learned from yet
  double taken = 0.0;
  // [active node][dim][dim] rotation of the body since the factors were made; empty: none
  std::vector<double> turns, rotations;
  std::vector<double> owned, gathered, whole;    // buffers: of this rank, all ranks, factors
  std::vector<double> forces, moved, solved, corrected;    // vectors of shared nodes

  void check();
  bool walls_are_same(const std::vector<double> &walls) const;
  void gather(const std::vector<double> &values, std::vector<double> &all);
  void extrapolate(std::vector<double> &u);
  bool make_factors(const std::vector<double> &u);
  void find_turns();
  void solve_with_factors();
  void find_correction();
  void learn();
  bool iterate(std::vector<double> &u);
};

}    // namespace LAMMPS_NS
#endif
