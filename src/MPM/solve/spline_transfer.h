/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_SPLINE_TRANSFER_H
#define MPM_SOLVE_SPLINE_TRANSFER_H

#include "solve/block_rows.h"
#include "solve/lattice_nodes.h"
#include "solve/lattice_ranks.h"
#include "solve/node_constraints.h"

#include <algorithm>
#include <initializer_list>
#include <vector>

namespace MPM_NS {

/** Two-scale relation of B-splines: the functions of twice the spacing that have a function in them
 *  along an axis, and the weight of the function in each. Returns their number. */
inline int parents(int order, int i, int *parent, double *weight)
{
  const int m = i >> 1;
  const bool odd = i & 1;
  const auto give = [&](int n, std::initializer_list<int> of, std::initializer_list<double> by) {
    std::copy(of.begin(), of.end(), parent);
    std::copy(by.begin(), by.end(), weight);
    return n;
  };
  if (order == 1) return odd ? give(2, {m, m + 1}, {0.5, 0.5}) : give(1, {m}, {1.0});
  if (order == 2)
    return odd ? give(2, {m, m + 1}, {0.75, 0.25}) : give(2, {m - 1, m}, {0.25, 0.75});
  return odd ? give(2, {m, m + 1}, {0.5, 0.5}) : give(3, {m - 1, m, m + 1}, {0.125, 0.75, 0.125});
}

/** Calls f(index, weight) for all parents of a node. period: of the coarse level along each axis,
 *  0: none. */
template <class F>
void each_parent(int order, int dim, const LatticeIndex &index, const int *period, const F &f)
{
  int parent[3][3], n[3] = {1, 1, 1};
  double weight[3][3];
  for (int d = 0; d < 3; d++) {
    parent[d][0] = 0;
    weight[d][0] = 1.0;
    if (d >= dim) continue;
    n[d] = parents(order, index[d], parent[d], weight[d]);
    if (period[d] > 0)
      for (int k = 0; k < n[d]; k++) parent[d][k] = (parent[d][k] + period[d]) % period[d];
  }
  for (int i = 0; i < n[0]; i++)
    for (int j = 0; j < n[1]; j++)
      for (int k = 0; k < n[2]; k++)
        f(LatticeIndex{parent[0][i], parent[1][j], parent[2][k]},
          weight[0][i] * weight[1][j] * weight[2][k]);
}
/** The transfer between the nodes of a rank and the first coarse level. Each rank has its part of
 *  that level, the nodes that its own nodes are functions of, and all ranks have complete vectors
 *  of the level. */
class SplineTransfer {
 public:
  SplineTransfer(const NodeConstraints &nodes, LatticeRanks &ranks, int order) :
      nodes(nodes), ranks(ranks), order(order)
  {
  }
  /** Finds the functions of the level that the nodes have a part in. to_itself: the level has the
   *  nodes themselves. */
  void setup(bool to_itself);

  bool whole = false;              ///< the level has the nodes themselves
  int period[3] = {0, 0, 0};       ///< of the level, in nodes; 0: not periodic
  LatticeNodes mine;               ///< nodes of the part of this rank
  CoarseParts parts;               ///< of nodes without constraints in these
  ConstrainedParts constrained;    ///< of nodes with constraints
  std::vector<int> number;         ///< of the part of this rank in the level; -1: no stiffness

  /** Numbers the nodes of the level in the order of ranks. used: those of this rank that have a
   *  stiffness. rows: [ranks + 1], receives the first node of each rank. Collective. */
  LatticeNodes number_nodes(const std::vector<char> &used, std::vector<int> &rows);
  /** b = P^T (r - done), on all ranks. done: null: nothing. in_system: [node] it has a stiffness.
   *  Collective. */
  void restriction(const double *r, const double *done, const std::vector<char> &in_system,
                   std::vector<double> &b);
  /** z += P x */
  void prolongation(const std::vector<double> &x, const std::vector<char> &in_system,
                    double *z) const;
  double memory_usage() const
  {
    return parts.memory_usage() + constrained.memory_usage() + mine.memory_usage() +
        bytes_of(number, all_numbers, partial, gathered);
  }

 private:
  const NodeConstraints &nodes;
  LatticeRanks &ranks;
  const int order;
  std::vector<int> all_numbers;    // nodes of the level that ranks have a part of, rank by rank
  std::vector<double> partial, gathered;
};

}    // namespace MPM_NS
#endif
