/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LATTICE_NODE_FIELD_H
#define MPM_LATTICE_NODE_FIELD_H

// Reals of the nodes besides mass and momentum.

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace MPM_NS {

/** width reals for each node of a Grid, in the order of its blocks: node slot*64 + n. */
struct NodeField {
  const std::string name;
  const int width;
  std::vector<double> values;

  double *at(int64_t node) { return values.data() + node * width; }
  const double *at(int64_t node) const { return values.data() + node * width; }
  void zero() { std::fill(values.begin(), values.end(), 0.0); }
};

}    // namespace MPM_NS
#endif
