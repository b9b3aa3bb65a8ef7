/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_TWO_SCALE_RELATION_H
#define MPM_SOLVE_TWO_SCALE_RELATION_H

#include "solve/lattice_key.h"

#include <algorithm>
#include <initializer_list>

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

}    // namespace MPM_NS
#endif
