/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Normals of fix mpm/contact by logistic regression: the plane that tells the points of two bodies
// apart best, near a node (J.A. Nairn, C.C. Hammerquist, G.D. Smith, Comput. Methods Appl. Mech. Eng.
// 362 (2020) 112859; here with the likelihood as measure, whose only minimum Newton's method finds).
//
// With the distance r of a point from the node and c = (r, 1), the points of body b, next to those of
// body a, shall have the probability s(z) = 1/(1 + exp(-z)), z = phi . c. The plane is z = 0, its normal
// the direction of the first components of phi, which minimize
//
//   sum_p w_p [ln(1 + exp(z_p)) - y_p z_p] + RIDGE/2 |n|^2,   y = 0 in a, 1 in b,
//
// with the weights w_p of the shape functions. The last term keeps n finite where a plane separates all
// points; the smaller it is, the closer is the plane to the one in the middle of the gap.

#include "fix_mpm_contact.h"

#include "comm.h"
#include "math_extra.h"
#include "mpm_field.h"
#include "mpm_halo.h"
#include "mpm_node_sums.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

void FixMPMContact::separate_points()
{
  constexpr int ROUNDS = 6,
                NREAL = 14;    // converged to 1e-4; 4 of the gradient, 10 second derivatives
  constexpr double RIDGE = 1.0e-3;
  const int dim = bodies[0].field->lattice.dim, nfields = (int) bodies.size();

  // contact nodes by their places in the grids of the fields; images on periodic axes are the same node

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

  std::vector<std::array<double, 4>> phi(pairs.size(), {0.0, 0.0, 0.0, 0.0});
  std::vector<double> sums(pairs.size() * NREAL), shared;
  for (int round = 0; round < ROUNDS; round++) {
    sums.assign(sums.size(), 0.0);
    for (int k = 0; k < nfields; k++)
      visit_points(*bodies[k].field, wanted[k],
                   [&](int, int which, double weight, const double *r) {
                     const Node &node = nodes[which];
                     for (int p = node.first; p < node.last; p++) {
                       const Pair &pair = pairs[p];
                       if (pair.a != k && pair.b != k) continue;
                       double c[4] = {r[0], r[1], r[2], 1.0}, z = 0.0;
                       for (int i = 0; i < 4; i++) z += phi[p][i] * c[i];
                       const double s = 1.0 / (1.0 + std::exp(-z)), slope = weight * s * (1.0 - s);
                       double *const to = &sums[(std::size_t) p * NREAL];
                       for (int i = 0, m = 4; i < 4; i++) {
                         to[i] += weight * (s - (pair.b == k)) * c[i];
                         for (int j = 0; j <= i; j++) to[m++] += slope * c[i] * c[j];
                       }
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

    for (std::size_t p = 0; p < pairs.size(); p++) {
      const double *from = &sums[p * NREAL];
      Eigen::Matrix4d H;
      Eigen::Vector4d g;
      for (int i = 0, m = 4; i < 4; i++) {
        g(i) = from[i];
        for (int j = 0; j <= i; j++) H(i, j) = H(j, i) = from[m++];
      }
      for (int i = 0; i < 3; i++) {
        g(i) += RIDGE * phi[p][i];
        H(i, i) += i < dim ? RIDGE : 1.0;
      }
      H(3, 3) += 1.0e-10;
      Eigen::Vector4d step = H.ldlt().solve(g);
      const double size = step.norm();    // far from the minimum, Newton's steps can be too long
      if (size > 4.0) step *= 4.0 / size;
      for (int i = 0; i < 4; i++) phi[p][i] -= step(i);
    }
  }

  for (std::size_t p = 0; p < pairs.size(); p++) {
    double n[3] = {phi[p][0], phi[p][1], dim == 3 ? phi[p][2] : 0.0};
    const double length = MathExtra::len3(n);
    // points that lie in a line do not say more than the gradient
    if (!(length > 0.0) || MathExtra::dot3(n, pairs[p].n) < 0.5 * length) continue;
    for (int d = 0; d < 3; d++) pairs[p].n[d] = n[d] / length;
  }
}
