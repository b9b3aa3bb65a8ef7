/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_IMPLICIT_MEMORY_H
#define LMP_MPM_IMPLICIT_MEMORY_H

#include "solve/quasi_newton.h"

#include <cstdint>
#include <deque>
#include <vector>

namespace LAMMPS_NS {

/** What implicit steps with inertia keep for the next ones, as long as the nodes stay the same and walls hold the same of them: the
 *  motions of the last steps, from which the next one is foreseen, and whether factors of a tangent are there, with what corrections
 *  have told of how tangents changed since. None of it changes what a step converges to, only the way. Vectors have the nodes of all
 *  ranks in the order of SharedNodes: nodes may come to other ranks. */
struct MPMImplicitMemory {
  bool known = false;    // is there anything?
  std::vector<uint64_t>
      nodes;                    // blocks, those which this rank owns of each, and those with a mass
  std::vector<double> walls;    // what these leave of a motion that is no special one
  double dt = 0.0;
  std::deque<std::vector<double>> motions;    // the last one first
  bool structured = false;    // factors were there, whose structure is of use for those to come
  bool factorized = false;
  bool levels = false;            // there are some in their place
  double stiffness = 0.0;         // that goes with the factors, see MPMTangent::linearize()
  double asymmetry = 0.0;         // of the same
  std::vector<int> in_factors;    // places of nodes in the system of the factors, -1: none
  std::vector<double> turned;     // rotations of the body around nodes, at the factors
  MPM_NS::QuasiNewton pairs;
  int64_t steps = 0, iterations = 0, last = 0;    // with these factors; those of the last step

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
