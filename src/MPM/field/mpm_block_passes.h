/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_BLOCK_PASSES_H
#define LMP_MPM_BLOCK_PASSES_H

// Passes over the blocks of a field, over the blocks around positions, and over points of one
// material at a time; those over points and nodes are in mpm_passes.h.

#include "field/mpm_passes.h"
#include "field/mpm_stencil.h"

#include "atom.h"

#include <vector>

namespace LAMMPS_NS {

/** Calls use(block) for each block that has points of the field. */
template <class Use> void each_block(const MPMField &field, const Use &use)
{
  for (const auto &block : field.map->active) use(block);
}

/** Calls gather(run, base) for all runs in the blocks wanted(slot), with these nodes in
 *  tile_load. */
template <class Wanted, class Gather>
void points_from(double *nodes, MPMField &field, const MPM_NS::TransferKernels &with,
                 const Wanted &wanted, const Gather &gather)
{
  MPMPointMap &points = *field.map;
  each_block(field, [&](const auto &block) {
    if (!wanted(block.slot)) return;
    int base[3];
    points.tile_base(block, base);
    with.load(points.tile_load, nodes, field.grid.blocks[block.slot].slot, block.box);
    for (int k = block.first_run; k < block.last_run; k++) gather(points.runs[k], base);
  });
}

/** Calls use(block) with the coordinates of each block that has nodes which a position x reaches,
 *  or would reach after a shift of at most drift node spacings along each axis, and of those up to
 *  more nodes beyond. */
template <class Use>
void blocks_around(const MPMField &field, const double *x, double drift, int more, const Use &use)
{
  const MPMStencil stencil(field);
  int low[3] = {0, 0, 0}, high[3] = {0, 0, 0}, b[3];
  for (int d = 0; d < field.lattice.dim; d++) {
    const double t = (x[d] - field.lattice.origin[d]) / field.lattice.h;
    double w[4];
    stencil.weights(t - drift, low[d], w);
    const int n = stencil.weights(t + drift, high[d], w);
    low[d] = (low[d] - more) >> field.grid.shift_bits;
    high[d] = (high[d] + n - 1 + more) >> field.grid.shift_bits;
  }
  for (b[0] = low[0]; b[0] <= high[0]; b[0]++)
    for (b[1] = low[1]; b[1] <= high[1]; b[1]++)
      for (b[2] = low[2]; b[2] <= high[2]; b[2]++) use(b);
}

/** Calls use(list, material) for lists of up to BATCH points of the field with the same material,
 *  in their order in memory. Points without material, and nodes of elements, are left out. */
template <class Use> void each_material_batch(const MPMField &field, const Use &use)
{
  std::vector<int> list;
  const FixMPMMaterial *material = nullptr;
  for (int i = 0; i < field.atom->nlocal; i++) {
    if (!field.is_point(i) || field.is_element_node(i)) continue;
    const auto *const mine = field.material_of(i);
    if (!list.empty() && (mine != material || list.size() == MPM_NS::BATCH)) {
      use(list, material);
      list.clear();
    }
    material = mine;
    if (mine) list.push_back(i);
  }
  if (!list.empty()) use(list, material);
}

}    // namespace LAMMPS_NS
#endif
