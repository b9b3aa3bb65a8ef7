/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* A node in the other material that reaches points of conducting ones on one side alone sees them
   at a mean distance r of 0.4 node spacings at the interface, and more further away (quadratic
   functions; in a concave corner 0.7 times that). Where they are on two sides, r is small. */

#include "contact/mpm_leaks.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "field/mpm_field.h"
#include "field/mpm_point_map.h"
#include "field/mpm_stencil.h"
#include "math_extra.h"

#include <algorithm>
#include <limits>
#include <vector>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double INSIDE =
    0.5;    // share of the volume of a node that is of the other material
static constexpr double SEEN = 0.005;    // the same of what conducts
static constexpr double ONE_SIDE =
    0.3;    // mean distance of points from there on, in node spacings

MPMLeaks LAMMPS_NS::find_leaks(MPMField &field, MPI_Comm world,
                               const std::function<bool(const FixMPMMaterial *)> &conducts)
{
  enum { OTHER, CONDUCTING, MOMENT, NREAL = MOMENT + 3 };
  std::vector<double> sums(NREAL * field.grid.nnodes(), 0.0);
  const MPMStencil stencil(field);
  for (const auto &run : field.map->runs) {
    if (!run.material) continue;    // nodes of elements
    const auto &block = field.grid.blocks[run.slot];
    const bool through = conducts(run.material);
    for (int i = run.first; i < run.last; i++) {
      const double V = field.atom->vfrac[i] * field.points->jacobian(i);
      stencil.visit(block, i, [&](const MPMStencil::Node &node) {
        double *const to = &sums[NREAL * node.number];
        to[through ? CONDUCTING : OTHER] += V * node.weight;
        for (int d = 0; d < 3 && through; d++) to[MOMENT + d] += V * node.weight * node.r[d];
      });
    }
  }
  field.nodes.sum(sums.data(), NREAL, 0, NREAL);

  constexpr int64_t SHIFT = 1 << 20;
  int64_t mine[2] = {0, std::numeric_limits<int64_t>::max()}, count, least;
  const double cell = field.lattice.cell_volume();
  for (std::size_t ib = 0; ib < field.grid.blocks.size(); ib++) {
    const auto &block = field.grid.blocks[ib];
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if ((block.alias >> n & 1) || !(block.owned >> n & 1)) continue;
      const double *const of = &sums[NREAL * (ib * NODES_PER_BLOCK + n)];
      if (of[OTHER] < INSIDE * cell || of[CONDUCTING] < SEEN * cell) continue;
      if (MathExtra::len3(of + MOMENT) > ONE_SIDE * of[CONDUCTING]) continue;
      int index[3] = {0, 0, 0};
      field.grid.node_index(block, n, index);
      mine[0]++;
      mine[1] = std::min(
          mine[1], ((index[0] + SHIFT) << 42) + ((index[1] + SHIFT) << 21) + (index[2] + SHIFT));
    }
  }
  MPI_Allreduce(&mine[0], &count, 1, MPI_INT64_T, MPI_SUM, world);
  MPI_Allreduce(&mine[1], &least, 1, MPI_INT64_T, MPI_MIN, world);
  MPMLeaks leaks;
  leaks.nodes = count;
  for (int d = 0; d < 3 && count; d++)
    leaks.first[d] = field.lattice.origin[d] +
        (double) ((least >> (42 - 21 * d) & ((1 << 21) - 1)) - SHIFT) * field.lattice.h;
  return leaks;
}
