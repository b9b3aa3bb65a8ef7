/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_TANGENT_GATHER_H
#define LMP_MPM_TANGENT_GATHER_H

#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_passes.h"
#include "implicit/mpm_tangent.h"
#include "material/batch_kernels.h"

#include <algorithm>
#include <type_traits>

namespace LAMMPS_NS {

/** Calls use(run, first, n, H) with the gradients H [n][nH] of the motion u for up to BATCH points
 *  from first on. */
template <class Use> void MPMTangent::gather(const double *u, const Use &use)
{
  // all but the motion stays zero
  const std::size_t nreals = field.grid.nnodes() * with.nreal;
  if (motion_nodes.size() != nreals) motion_nodes.assign(nreals, 0.0);
  const auto give = [&](auto constant) {
    constexpr int D = decltype(constant)::value;
    double *record = motion_nodes.data();
    const int64_t end = D * field.grid.nnodes();
    for (int64_t k = 0; k < end; k += D, record += with.nreal) std::copy_n(u + k, D, record);
  };
  if (dim == 2)
    give(std::integral_constant<int, 2>());
  else
    give(std::integral_constant<int, 3>());
  field.nodes.complete(motion_nodes.data(), with.nreal, 3);
  MPM_NS::PointRows rows = field.rows();
  rows.P = P.data();
  rows.F = nullptr;
  const MPM_NS::TransferStep step = field.step_data();
  double L[9 * MPM_NS::BATCH], H[10 * MPM_NS::BATCH], motion[3 * MPM_NS::BATCH];
  points_from(motion_nodes, field, with, [&](const MPMPointMap::Run &run, const int *base) {
    for (int i = run.first; i < run.last; i += MPM_NS::BATCH) {
      const int n = std::min(MPM_NS::BATCH, run.last - i);
      MPM_NS::PointRows b = rows_from(field, rows, i);
      b.P = P.data() + (bigint) nL * i;
      if (nH > nL) b.velocity = motion;
      with.g2p_gradient(b, step, 0, n, base, field.map->tile_load, L);
      if (nH == nL) {
        use(run, i, n, L);
        continue;
      }
      for (int p = 0; p < n; p++) {
        std::copy_n(L + nL * p, nL, H + nH * p);
        H[nH * p + nL] = motion[3 * p] / field.frame->radius(i + p, b.x[3 * p]);
      }
      use(run, i, n, H);
    }
  });
}

}    // namespace LAMMPS_NS
#endif
