/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_KEPT_STATE_H
#define LMP_MPM_KEPT_STATE_H

#include "solve/quasi_newton.h"

#include <cstdint>
#include <deque>
#include <vector>

namespace LAMMPS_NS {

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
    double reals = nodes.capacity() + walls.capacity() + turned.capacity();
    for (const auto &motion : motions) reals += motion.capacity();
    return reals * sizeof(double) + in_factors.capacity() * sizeof(int) + pairs.memory_usage();
  }
};

}    // namespace LAMMPS_NS
#endif
