/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_viscosity.h"

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
    for (int nth = run.first; nth < run.last; nth++) {
      const int i = cells.points[nth];
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

/* ---------------------------------------------------------------------- */

// shortest distance of the surface that forces across it use, in spacings
static constexpr double NEAREST = 0.25;
// least number of wet cells of the four around an edge that is in the fluid. Where a surface steps
// from one layer of cells to the next there are three, and without the shear at that edge what is
// above it would slide freely
static constexpr int LEAST_AT_EDGE = 3;
// least height of what shear acts on, in spacings: half a cell, as where a surface is in the middle
// of a cell
static constexpr double LEAST_HEIGHT = 0.5;

void MPMFlowViscosity::add(double factor, const std::vector<double> &u,
                           std::vector<double> &sum) const
{
  viscosities ? add<true>(factor, u, sum) : add<false>(factor, u, sum);
}

template <bool several>
void MPMFlowViscosity::add(double factor, const std::vector<double> &u,
                           std::vector<double> &sum) const
{
  const int dim = cells.lattice.dim, here = dim == 2 ? 4 : 13, naround = dim == 2 ? 9 : 27;
  const int *const stride = MPMFlowLattice::STRIDE[dim - 2];
  const double scale = factor / (cells.lattice.h * cells.lattice.h);
  for (std::size_t k = 0; k < cells.cells.size(); k++) {
    const auto &cell = cells.cells[k];
    const int *const at = cells.around.data() + k * naround + here;
    const auto v = [&](int c, int offset) {
      return u[(int64_t) at[offset] * dim + c];
    };
    const auto wet = [&](int offset) {
      return water.is_wet(at[offset]);
    };
    // from the middle of a wet cell to a side of it, or to the surface before that; elsewhere half
    // a spacing
    const auto reach = [&](int offset, int to) {
      return wet(offset) && !wet(to) ? std::max(0.0, water.distance(at[offset], at[to])) : 0.5;
    };
    // viscosities over the largest one, in the middle of a cell and at an edge
    const auto in_cell = [&](int offset) {
      return several ? viscosities->in_cell(at[offset]) : 1.0;
    };
    const auto at_edge = [&](int c, int d, int offset) {
      return several ? viscosities->at_edge(at[offset], c + d - 1) : 1.0;
    };
    for (int c = 0; c < dim; c++) {
      if (cell.walls >> 2 * c & 1) continue;
      const int e = stride[c];
      if (!wet(0) && !wet(-e)) continue;
      double normal = 0.0, length = 1.0;
      if (wet(0)) normal += in_cell(0) * (v(c, e) - v(c, 0));
      if (wet(-e)) normal -= in_cell(-e) * (v(c, 0) - v(c, -e));
      if (!wet(0)) length = std::max(NEAREST, reach(-e, 0));
      if (!wet(-e)) length = std::max(NEAREST, reach(0, -e));
      double force = 2.0 * normal / length;
      for (int d = 0; d < dim; d++) {
        if (d == c) continue;
        const int n = stride[d];
        const auto in_fluid = [&](int side) {
          return wet(0) + wet(-e) + wet(side) + wet(side - e) >= LEAST_AT_EDGE;
        };
        double shear = 0.0, height = 0.0;
        if (in_fluid(n)) shear += at_edge(c, d, n) * (v(c, n) - v(c, 0) + v(d, n) - v(d, n - e));
        if (in_fluid(-n)) shear -= at_edge(c, d, 0) * (v(c, 0) - v(c, -n) + v(d, 0) - v(d, -e));
        if (shear == 0.0) continue;
        for (const int from : {0, -e})
          if (wet(from)) height += reach(from, from + n) + reach(from, from - n);
        height = std::max(LEAST_HEIGHT, height / (wet(0) + wet(-e)));
        force += shear / height;
      }
      sum[(int64_t) cell.number * dim + c] += scale * force;
    }
  }
}
