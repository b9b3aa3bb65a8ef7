/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_FIX_MPM_PASSES_H
#define LMP_FIX_MPM_PASSES_H

// Passes over the points of a field, block by block, besides the two of the plain step: sums at nodes
// that are not those of the step, what points get of them, and velocity gradients. For the files of
// fix mpm.

#include "fix_mpm.h"

#include <algorithm>

namespace LAMMPS_NS {

/** nodes_apart = what map(run, base, box) puts into the tile of each block with its kernel P2G,
 *  before copies are summed. It may leave out runs. */
template <class Map> void FixMPM::map_apart(const MPM_NS::TransferKernels &with, const Map &map)
{
  nodes_apart.assign(grid->nnodes() * with.nreal, 0.0);
  for (auto &a : active) {
    int base[3], *const box = a.box_apart;
    tile_base(a, base);
    for (int d = 0; d < 3; d++) {
      box[d] = 127;
      box[3 + d] = -127;
    }
    for (int k = a.first_run; k < a.last_run; k++) map(runs[k], base, box);
    if (box[0] <= box[3]) with.flush(tile, nodes_apart.data(), grid->blocks[a.slot].slot, box);
  }
}

/** Calls gather(run, base) for all runs with nodes_apart in tile_load where map_apart() has been. */
template <class Gather>
void FixMPM::gather_apart(const MPM_NS::TransferKernels &with, const Gather &gather)
{
  for (const auto &a : active) {
    const int *const box = a.box_apart;
    if (box[0] > box[3]) continue;
    int base[3];
    tile_base(a, base);
    with.load(tile_load, nodes_apart.data(), grid->blocks[a.slot].slot, box);
    for (int k = a.first_run; k < a.last_run; k++) gather(runs[k], base);
  }
}

/** Velocity gradients of the nodes' velocities at the points: use(run, first, n, base, L) for up to
 *  BATCH of them, L in the array of_all of all points if that is not null; corners of CPDI2 that have moved
 *  with these velocities go to corners_new. */
template <class Use>
void FixMPM::visit_gradients(double *of_all, const Use &use, double *corners_new)
{
  MPM_NS::PointRows r = rows();
  r.corners_new = corners_new;
  const MPM_NS::TransferStep s = step_data();
  double batch_gradients[9 * MPM_NS::BATCH];
  for (const auto &a : active) {
    int base[3];
    load_tile(a, base);
    for (int k = a.first_run; k < a.last_run; k++)
      for (int i = runs[k].first; i < runs[k].last; i += MPM_NS::BATCH) {
        const int n = std::min(MPM_NS::BATCH, runs[k].last - i);
        double *const L = of_all ? of_all + affine_size() * (bigint) i : batch_gradients;
        kernel.g2p_gradient(r, s, i, i + n, base, tile_load, L);
        use(runs[k], i, n, base, L);
      }
  }
}

}    // namespace LAMMPS_NS
#endif
