/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PASSES_H
#define LMP_MPM_PASSES_H

// Passes over the points of a field, block by block: sums over the points at the nodes, and what
// points get of values at the nodes. Stages of the step and other sums over points are made of
// these.

#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_point_map.h"
#include "material/batch_kernels.h"

#include <algorithm>

namespace LAMMPS_NS {

/** Calls use(run, i) for each point i of the field. */
template <class Use> void each_point(const MPMField &field, const Use &use)
{
  for (const auto &run : field.map->runs)
    for (int i = run.first; i < run.last; i++) use(run, i);
}

/** Calls use(run, first, n) for n <= BATCH points of a run at a time. */
template <class Use> void each_point_batch(const MPMField &field, const Use &use)
{
  for (const auto &run : field.map->runs)
    for (int i = run.first; i < run.last; i += MPM_NS::BATCH)
      use(run, i, std::min(MPM_NS::BATCH, run.last - i));
}

/** Makes a range of base nodes in a tile empty: lower bounds in box[0..2], upper bounds in
 *  box[3..5]. */
inline void reset_box(int box[6])
{
  std::fill_n(box, 3, 127);
  std::fill_n(box + 3, 3, -127);
}

/** Sets nodes to what map(run, base, box) adds to the tile of each block with its kernel P2G,
 *  before copies are summed: for sums other than that of momentum. map may leave out runs. */
template <class Map>
void points_to(std::vector<double> &nodes, MPMField &field, const MPM_NS::TransferKernels &with,
               const Map &map)
{
  MPMPointMap &points = *field.map;
  nodes.assign(field.grid.nnodes() * with.nreal, 0.0);
  for (auto &a : points.active) {
    int base[3], *const box = a.other_box;
    points.tile_base(a, base);
    reset_box(box);
    for (int k = a.first_run; k < a.last_run; k++) map(points.runs[k], base, box);
    if (box[0] <= box[3])
      with.flush(points.tile, nodes.data(), field.grid.blocks[a.slot].slot, box);
  }
}

/** Calls gather(run, base) for all runs in blocks where points_to() has added something, with these
 *  nodes in tile_load. */
template <class Gather>
void points_from(std::vector<double> &nodes, MPMField &field, const MPM_NS::TransferKernels &with,
                 const Gather &gather)
{
  MPMPointMap &points = *field.map;
  for (const auto &a : points.active) {
    const int *const box = a.other_box;
    if (box[0] > box[3]) continue;
    int base[3];
    points.tile_base(a, base);
    with.load(points.tile_load, nodes.data(), field.grid.blocks[a.slot].slot, box);
    for (int k = a.first_run; k < a.last_run; k++) gather(points.runs[k], base);
  }
}

/** Calls gather(run, first, n, base) for up to BATCH points of a run at a time, with the nodes of
 *  the step in tile_load. mean: long records, with the mean of old and new velocities. */
template <class Gather>
void points_from_step(MPMField &field, const Gather &gather, bool mean = false)
{
  MPMPointMap &points = *field.map;
  for (const auto &a : points.active) {
    int base[3];
    points.load_tile(a, base, mean);
    for (int k = a.first_run; k < a.last_run; k++) {
      const auto &run = points.runs[k];
      for (int i = run.first; i < run.last; i += MPM_NS::BATCH)
        gather(run, i, std::min(MPM_NS::BATCH, run.last - i), base);
    }
  }
}

/** Transfers the points of a run to the tile of their block. */
void run_to_tile(MPMField &field, MPM_NS::P2G p2g, const MPM_NS::PointRows &,
                 const MPM_NS::TransferStep &, const MPMPointMap::Run &, const int base[3],
                 int box[6]);
/** Returns the rows shifted so that the point first becomes the first one. */
MPM_NS::PointRows rows_from(const MPMField &, const MPM_NS::PointRows &, int first);

}    // namespace LAMMPS_NS
#endif
