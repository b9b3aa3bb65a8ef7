/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_KEPT_FACTORS_H
#define LMP_MPM_KEPT_FACTORS_H

#include "implicit/mpm_implicit_parts.h"
#include "solve/bytes_of.h"
#include "solve/quasi_newton.h"
#include "solve/shared_nodes.h"

#include <cstdint>
#include <deque>
#include <vector>

namespace LAMMPS_NS {
class MPMMotionSystem;
class MPMNewton;
class MPMTangent;

/** What implicit steps with inertia keep for the next steps, as long as the nodes stay the same and
 *  walls hold the same motions: the motions of the last steps, from which the next one is
 *  predicted; whether factors of a tangent exist; and what corrections have revealed about changes
 *  of the tangent since these were made. This affects only the path of the iterations, not the
 *  result that a step converges to. Vectors have the nodes of all ranks in the order of
 *  SharedNodes, because nodes may move to other ranks. */
struct MPMKeptState {
  bool known = false;    // is anything stored?
  // blocks, the nodes of each that this rank owns, and those with a mass
  std::vector<uint64_t> nodes;
  std::vector<double> walls;    // what walls leave of a generic motion
  double dt = 0.0;
  std::deque<std::vector<double>> motions;    // the last one first
  bool structured = false;    // there were factors, whose structure is useful for the next ones
  bool factorized = false;
  bool levels = false;            // multigrid levels are used in place of factors
  double stiffness = 0.0;         // stiffness of the factors, see MPMTangent::linearize()
  double asymmetry = 0.0;         // asymmetry of the same tangent
  std::vector<int> in_factors;    // indices of nodes in the system of the factors, -1: none
  std::vector<double> turned;     // rotations of the body around nodes when the factors were made
  MPM_NS::QuasiNewton pairs;
  int64_t steps = 0, iterations = 0,
          last = 0;    // with these factors; last: iterations of the last step

  /** Forgets the factors and the corrections that belong to them. */
  void drop_factors()
  {
    factorized = false;
    pairs.start(walls.size());
    steps = iterations = last = 0;
  }
  void clear() { *this = {}; }
  double memory_usage() const
  {
    double bytes = MPM_NS::bytes_of(nodes, walls, turned, in_factors) + pairs.memory_usage();
    for (const auto &motion : motions) bytes += MPM_NS::bytes_of(motion);
    return bytes;
  }
};

/** Solves steps with inertia with what earlier steps have left: an extrapolation of their motions
 *  as the first guess, and factors of an earlier tangent, which quasi-Newton corrections bring up
 *  to date (see mpm_kept_factors.cpp). One field, without contact. */
class MPMKeptFactors : private MPMImplicitParts {
 public:
  MPMKeptFactors(const MPMImplicitParts &, MPMMotionSystem &, MPMNewton &);

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
  MPMMotionSystem &system;
  MPMNewton &newton;
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
