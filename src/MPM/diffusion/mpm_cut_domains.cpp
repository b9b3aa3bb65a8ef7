/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "diffusion/mpm_cut_domains.h"

#include "atom.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_passes.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// of the end of a domain, in cells: a side there does not divide it
static constexpr double NEAR = 1.0e-6;
// half of a domain, in cells: at most one side along an axis divides it
static constexpr double MOST = 0.499;

int MPMCutDomains::dim() const
{
  return field.lattice.dim;
}

/** The functions in the middle of a part, in cells from the origin. False if this rank does not
 *  have all nodes. */
bool MPMCutDomains::set_nodes(const double *middle, int slot, Part &part) const
{
  const Grid &grid = field.grid;
  const auto &block = grid.blocks[slot];
  const int last = dim() == 3 ? NODES : 1;
  int first[3] = {0, 0, 0};
  for (int d = 0; d < dim(); d++) {
    const double low = std::floor(middle[d]), f = middle[d] - low, g = 1.0 - f;
    first[d] = 2 * (int) low;
    const double w[NODES] = {g * g, 2.0 * f * g, f * f}, slope[NODES] = {-g, 1.0 - 2.0 * f, f};
    for (int k = 0; k < NODES; k++) {
      part.w[d][k] = w[k];
      part.slope[d][k] = slope[k] / field.lattice.h;
    }
  }
  int n = 0;
  for (int a = 0; a < NODES; a++)
    for (int b = 0; b < NODES; b++)
      for (int c = 0; c < last; c++) {
        const int index[3] = {first[0] + a, first[1] + b, first[2] + c};
        const int64_t node = grid.locate_near(block, index);
        if (node < 0) return false;
        part.node[n++] = (int) node;
      }
  return true;
}

bool MPMCutDomains::make_whole(int point, const MPMPointMap::Run &run, Part &part) const
{
  const auto &lattice = field.lattice;
  const double *const x = field.frame->places()[point];
  double middle[3];
  for (int d = 0; d < dim(); d++) middle[d] = (x[d] - lattice.origin[d]) / (2.0 * lattice.h);
  part = {point, 1.0, 1.0, {{0.0}, {0.0}, {1.0}}, {}, {}};
  return set_nodes(middle, run.slot, part);
}

void MPMCutDomains::find(const std::function<bool(const MPMPointMap::Run &)> &wanted)
{
  const Lattice &lattice = field.lattice;
  const MPMFrame &frame = *field.frame;
  const int dim = lattice.dim;
  const double cell = 2.0 * lattice.h;
  parts.clear();
  is_cut.assign(field.atom->nmax, 0);
  each_point(field, [&](const auto &run, int i) {
    if (!wanted(run)) return;
    const double *const x = frame.places()[i];
    const double volume = field.atom->vfrac[i] * frame.lattice_jacobian(i) / frame.circle(x[0]),
                 half = std::min(MOST, 0.5 * std::pow(volume, 1.0 / dim) / cell);
    double middle[3][2], length[3][2];    // of the pieces along an axis
    int pieces[3] = {1, 1, 1};
    for (int d = 0; d < dim; d++) {
      const double at = (x[d] - lattice.origin[d]) / cell, side = std::round(at);
      middle[d][0] = at;
      length[d][0] = 1.0;
      if (std::fabs(side - at) > half - NEAR) continue;
      pieces[d] = 2;
      for (int k = 0; k < 2; k++) {
        const double end = k ? at + half : at - half;
        middle[d][k] = 0.5 * (side + end);
        length[d][k] = 0.5 * std::fabs(end - side) / half;
      }
      is_cut[i] = 1;
    }
    if (!is_cut[i]) return;
    int piece[3];
    for (piece[0] = 0; piece[0] < pieces[0]; piece[0]++)
      for (piece[1] = 0; piece[1] < pieces[1]; piece[1]++)
        for (piece[2] = 0; piece[2] < pieces[2]; piece[2]++) {
          Part part = {i, 1.0, 1.0, {{0.0}, {0.0}, {1.0}}, {}, {}};
          double place[3];
          for (int d = 0; d < dim; d++) {
            part.volume *= length[d][piece[d]];
            place[d] = middle[d][piece[d]];
          }
          if (set_nodes(place, run.slot, part)) parts.push_back(part);
        }
  });
}

void MPMCutDomains::gradient(const Part &part, const std::vector<double> &values, double g[3]) const
{
  g[0] = g[1] = g[2] = 0.0;
  each_node(part, [&](int node, const double *slope) {
    for (int d = 0; d < 3; d++) g[d] += values[node] * slope[d];
  });
}

void MPMCutDomains::add(const Part &part, const double *q, std::vector<double> &nodes) const
{
  each_node(part, [&](int node, const double *slope) {
    nodes[node] += q[0] * slope[0] + q[1] * slope[1] + q[2] * slope[2];
  });
}
