/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Normals of fix mpm/contact by logistic regression: the plane that separates the points of two bodies
// best, near a node, with the weights of the shape functions

#include "contact/fix_mpm_contact.h"

#include "comm.h"
#include "field/mpm_field.h"
#include "field/mpm_halo.h"
#include "field/mpm_node_sums.h"
#include "math/plane_between.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

void FixMPMContact::separate_points()
{
  constexpr int NREAL = PlaneBetween::NREAL;
  const int dim = bodies[0].field->lattice.dim, nfields = (int) bodies.size();

  // contact nodes by their index in the grids of the fields; images on periodic axes are the same node

  std::vector<std::vector<int>> wanted(nfields);
  for (int k = 0; k < nfields; k++) {
    Grid &grid = bodies[k].field->grid;
    wanted[k].assign(grid.nnodes(), -1);
    for (std::size_t m = 0; m < nodes.size(); m++)
      if (nodes[m].record[k]) wanted[k][(nodes[m].record[k] - grid.nodes()) / grid.nreal] = (int) m;
    for (const int slot : bodies[k].images)
      for (int n = 0; n < NODES_PER_BLOCK; n++) {
        if (!(grid.blocks[slot].alias >> n & 1)) continue;
        int index[3];
        grid.node_index(grid.blocks[slot], n, index);
        for (int d = 0; d < dim; d++) index[d] = grid.lattice.wrap(d, index[d]);
        const int64_t canonical = grid.locate(index);
        if (canonical >= 0) wanted[k][(int64_t) slot * NODES_PER_BLOCK + n] = wanted[k][canonical];
      }
  }

  std::vector<PlaneBetween> planes(pairs.size());
  std::vector<double> sums(pairs.size() * NREAL), shared;
  for (int round = 0; round < PlaneBetween::ROUNDS; round++) {
    sums.assign(sums.size(), 0.0);
    for (int k = 0; k < nfields; k++)
      visit_points(*bodies[k].field, wanted[k],
                   [&](int, int which, double weight, const double *r) {
                     const Node &node = nodes[which];
                     for (int p = node.first; p < node.last; p++) {
                       const Pair &pair = pairs[p];
                       if (pair.a != k && pair.b != k) continue;
                       planes[p].add(weight, r, pair.b == k, &sums[(std::size_t) p * NREAL]);
                     }
                   });

    if (comm->nprocs > 1)    // by pairs of bodies, on the nodes of the first of them
      for (int a = 0; a < nfields; a++) {
        Grid &grid = bodies[a].field->grid;
        for (int b = a + 1; b < nfields; b++) {
          shared.assign(grid.nnodes() * NREAL, 0.0);
          for (const bool summed : {false, true}) {
            if (summed) bodies[a].field->nodes.halo->sum(shared.data(), NREAL, 0, NREAL);
            for (std::size_t p = 0; p < pairs.size(); p++) {
              if (pairs[p].a != a || pairs[p].b != b) continue;
              double *const mine = &sums[p * NREAL];
              double *const node = &shared[(pairs[p].ra - grid.nodes()) / grid.nreal * NREAL];
              std::copy_n(summed ? node : mine, NREAL, summed ? mine : node);
            }
          }
        }
      }

    for (std::size_t p = 0; p < pairs.size(); p++) planes[p].advance(&sums[p * NREAL], dim);
  }

  for (std::size_t p = 0; p < pairs.size(); p++) {
    const double *const phi = planes[p].phi;
    double n[3] = {phi[0], phi[1], dim == 3 ? phi[2] : 0.0};
    const double length = MathExtra::len3(n);
    // points that lie on a line do not say more than the gradient
    if (!(length > 0.0) || MathExtra::dot3(n, pairs[p].n) < 0.5 * length) continue;
    for (int d = 0; d < 3; d++) pairs[p].n[d] = n[d] / length;
  }
}
