/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_viscosities.h"

#include "flow/mpm_flow_stencil.h"
#include "lattice/staggered.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// least viscosity over the largest one: equations have to divide by it
static constexpr double LEAST = 1.0e-9;
// share that a box gets from points in the next half of its neighbors, along each axis, for those
// that have no points of their own
static constexpr double FROM_AFAR = 1.0e-8;

namespace {
/** Share of a point in the box along an axis that it is in and in the nearer one of the next, from
 *  first on. Lower ends of boxes are at whole numbers. */
struct Overlap {
  int first;
  double share[2];

  void find(double t, double width)
  {
    first = cell_below(t - 0.5);
    const double low = t - 0.5 * width - first, high = low + width;
    for (int k = 0; k < 2; k++)
      share[k] =
          FROM_AFAR + std::max(0.0, std::min(high, k + 1.0) - std::max(low, (double) k)) / width;
  }
};
}    // namespace

MPMFlowViscosities::MPMFlowViscosities(const MPMFlowLattice &cells, double viscosity) :
    cells(cells), dim(cells.lattice.dim), most(viscosity), viscosities({viscosity})
{
}

void MPMFlowViscosities::add(int bit, double viscosity)
{
  bits.push_back(bit);
  viscosities.push_back(viscosity);
  most = std::max(most, viscosity);
}

template <int d>
void MPMFlowViscosities::give(double *const *x, const double *volume, const int *mask)
{
  constexpr int KINDS = kinds(d);
  constexpr int PAIRS[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  const auto &lattice = cells.lattice;
  const double inv_h = 1.0 / lattice.h, per_cell = 1.0 / lattice.cell_volume();
  double last_volume = 0.0, width = 1.0;
  Overlap of[2][d];    // boxes of cells, and boxes around nodes
  for (const auto &run : cells.runs) {
    const auto &block = cells.grid.blocks[run.slot];
    for (int i = run.first; i < run.last; i++) {
      const double V = volume[i];
      double mu = viscosities[0];
      for (std::size_t k = 1; k < bits.size(); k++)
        if (mask[i] & bits[k]) mu = viscosities[k];
      mu = std::max(LEAST, mu / most);
      if (V != last_volume) {
        last_volume = V;
        width = std::min(1.0, std::pow(V * per_cell, 1.0 / d));
      }
      int base[3] = {0, 0, 0};
      for (int e = 0; e < d; e++) {
        const double t = (x[i][e] - lattice.origin[e]) * inv_h;
        base[e] = cell_below(t - 0.5);
        of[0][e].find(t, width);
        of[1][e].find(t + 0.5, width);
      }
      const MPMFlowStencil<d> reach(cells.grid, block, base);
      for (int kind = 0; kind < KINDS; kind++) {
        const Overlap *along[3];
        for (int e = 0; e < d; e++)
          along[e] = &of[kind > 0 && (e == PAIRS[kind - 1][0] || e == PAIRS[kind - 1][1])][e];
        const double value = kind ? 1.0 / mu : mu;
        const auto add = [&](int kx, int ky, int kz, double share) {
          double *const to = sums.data() + (reach.number(kx, ky, kz) * KINDS + kind) * 2;
          to[0] += share;
          to[1] += share * value;
        };
        for (int k = 0; k < 2; k++)
          for (int l = 0; l < 2; l++) {
            const double share = V * along[0]->share[k] * along[1]->share[l];
            const int kx = along[0]->first - base[0] + k, ky = along[1]->first - base[1] + l;
            if constexpr (d == 2)
              add(kx, ky, 0, share);
            else
              for (int m = 0; m < 2; m++)
                add(kx, ky, along[2]->first - base[2] + m, share * along[2]->share[m]);
          }
      }
    }
  }
}

void MPMFlowViscosities::find(double *const *x, const double *volume, const int *mask)
{
  const int n = kinds(dim);
  sums.assign(cells.size() * n * 2, 0.0);
  dim == 2 ? give<2>(x, volume, mask) : give<3>(x, volume, mask);
  cells.sum_freely(sums.data(), 2 * n);
  mean.assign(cells.size() * n, LEAST);
  for (int64_t k = 0; k < cells.size() * n; k++) {
    const double all = sums[2 * k], other = sums[2 * k + 1];
    if (all > 0.0) mean[k] = k % n ? all / other : other / all;
  }
}
