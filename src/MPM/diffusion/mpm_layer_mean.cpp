/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   What flows through an interface of two conductivities has a gradient that jumps there, and smooth
   functions of nodes cannot have that: the best that they find, of all gradients, lets too much
   through, by an error of first order (Galerkin's method bounds the conductance from above). The
   flow does not jump, hence the resistance 1/k, which adds up across layers, may be smoothed
   without changing what flows, and so may be the conductivity along them: in place of k points have

     k = k_t (I - n n^T) + k_n n n^T,  1/k_n = sum_i N_ip sum_q V_q N_iq/k_q / sum_q V_q N_iq,
     k_t = sum_i N_ip sum_q V_q N_iq k_q / sum_q V_q N_iq,   n along the gradient of 1/k_n.

   The sums of the resistances and of the conductivities of all points stay what they are, so that
   layers in series and in parallel let through what they should, and as this varies within a cell
   and not from point to point, functions can follow. (Means across and along
   interfaces are those of electromagnetics on lattices: A. Farjadpour et al., Opt. Lett. 31 (2006)
   2972.)

   The mean along interfaces gives a point of little capacity next to one that conducts well a
   diffusivity that neither of the materials has, and with it short time steps. So it is taken only
   where the greatest conductivity over the smallest capacity is not above MOST times the greatest
   diffusivity; otherwise points keep their own along interfaces, which is right for flat ones, too.

   Where all points conduct the same, it is what they have. In the middle of a layer that is thinner
   than a cell there may be no direction; then there is no mean across.
------------------------------------------------------------------------- */

#include "diffusion/mpm_layer_mean.h"

#include "atom.h"
#include "field/mpm_field.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// differences of means, and slopes of them per node spacing, below which a point sees one
// conductivity only
static constexpr double SAME = 1.0e-9;

void MPMLayerMean::find(const Fill &fill)
{
  means.resize(field.atom->nmax);
  nodes.points_to_nodes(
      [&](const MPMPointMap::Run &run, int first, int n, MPMNodeScalar::Points &points) {
        double k[BATCH];
        if (!fill(run, first, n, k, points.capacity)) return false;
        for (int p = 0; p < n; p++) {
          means[first + p].along = k[p];
          points.row[p][3] = 1.0 / std::max(k[p], LEAST);
          points.volume[p] = points.capacity[p] * k[p];
        }
        return true;
      },
      false);

  // across

  const double h = field.lattice.h;
  nodes.nodes_to_points(
      [&](const MPMPointMap::Run &, int first, int n, MPMNodeScalar::Rows q, const double *) {
        for (int p = 0; p < n; p++) {
          Mean &m = means[first + p];
          const double slope = std::sqrt(q[p][0] * q[p][0] + q[p][1] * q[p][1] + q[p][2] * q[p][2]);
          const double across = std::min(1.0 / q[p][3], MOST * m.along);
          const bool varies = slope * h > SAME * q[p][3];
          m.less = varies ? m.along - across : 0.0;
          for (int d = 0; d < 3; d++) m.normal[d] = varies ? q[p][d] / slope : 0.0;
        }
      },
      false);
  if (!means_along) return;

  // along

  for (std::size_t k = 0; k < nodes.value.size(); k++)
    nodes.value[k] = nodes.capacity[k] > 0.0 ? nodes.volume[k] / nodes.capacity[k] : 0.0;
  nodes.values_to_points([&](const MPMPointMap::Run &, int first, int n, const double *values) {
    for (int p = 0; p < n; p++) {
      Mean &m = means[first + p];
      if (std::fabs(values[p] - m.along) < SAME * m.along) continue;
      m.less += values[p] - m.along;
      m.along = values[p];
    }
  });
}

void MPMLayerMean::find_means(const Fill &fill, std::vector<double> &values)
{
  values.resize(field.atom->nmax);
  nodes.points_to_nodes(
      [&](const MPMPointMap::Run &run, int first, int n, MPMNodeScalar::Points &points) {
        double value[BATCH];
        if (!fill(run, first, n, value, points.capacity)) return false;
        for (int p = 0; p < n; p++) {
          points.row[p][3] = value[p];
          points.volume[p] = 0.0;
        }
        return true;
      },
      false);
  nodes.values_to_points([&](const MPMPointMap::Run &, int first, int n, const double *mean) {
    std::copy_n(mean, n, values.begin() + first);
  });
}
