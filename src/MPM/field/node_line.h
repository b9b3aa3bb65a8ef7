/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_NODE_LINE_H
#define LMP_MPM_NODE_LINE_H

#include "lattice/grid.h"

#include <cstdint>
#include <vector>

namespace LAMMPS_NS {

/** Nodes of a field in a row along an axis, through a surface, and their weights in values at the
 *  surface. Only the first n entries are valid. */
struct NodeLine {
  static constexpr int MOST = 4;    ///< nodes that a shape function of any order needs

  int axis = 0, n = 0;
  int64_t node[MOST] = {};    ///< numbers of nodes; -1: out of reach of points
  double weight[MOST] = {};

  /** Value at the surface of what nodes have, sum_k weight_k v_k; of_nodes: [node][width]. */
  double value(const double *of_nodes, int width = 1, int component = 0) const
  {
    double sum = 0.0;
    for (int k = 0; k < n; k++)
      if (node[k] >= 0) sum += weight[k] * of_nodes[width * node[k] + component];
    return sum;
  }

  /** Spreads an amount at the surface over the nodes by their weights: the transpose of value(). */
  void spread(double amount, double *of_nodes, int width = 1, int component = 0) const
  {
    for (int k = 0; k < n; k++)
      if (node[k] >= 0) of_nodes[width * node[k] + component] += amount * weight[k];
  }

  /** Are all nodes in reach of points? */
  bool is_complete() const
  {
    bool complete = true;
    for (int k = 0; k < n; k++) complete = complete && node[k] >= 0;
    return complete;
  }

  /** Marks the blocks [slot] that contain nodes of the line. */
  void mark_blocks(std::vector<char> &blocks) const
  {
    for (int k = 0; k < n; k++)
      if (node[k] >= 0) blocks[node[k] / MPM_NS::NODES_PER_BLOCK] = 1;
  }
};

}    // namespace LAMMPS_NS
#endif
