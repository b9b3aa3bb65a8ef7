/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_viscosity.h"

#include "flow/mpm_flow_viscosities.h"

#include <algorithm>

using namespace LAMMPS_NS;

// shortest distance of the surface that forces across it use, in spacings
static constexpr double NEAREST = 0.25;
// least number of wet cells of the four around an edge that is in the fluid.
// Where a surface steps from one layer of cells to the next there are three,
// and without the shear at that edge what is above it would slide freely
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
  const int stride2[2] = {3, 1}, stride3[3] = {9, 3, 1};
  const int *const stride = dim == 2 ? stride2 : stride3;
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
