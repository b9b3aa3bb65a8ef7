/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_POINT_MAP_H
#define LMP_MPM_POINT_MAP_H

#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {
class FixMPMMaterial;
class LAMMPS;
class MPMField;

/** Which points lie in which blocks of the lattice, and their order in memory. */
class MPMPointMap : protected Pointers {
 public:
  /** Consecutive points of one block and one material (null: nodes of elements). */
  struct Run {
    int first, last, slot;
    FixMPMMaterial *material;
  };
  /** A block with points: its runs, and the boxes of base nodes in its tile. */
  struct ActiveBlock {
    int slot, first_run, last_run;
    int box[6];             ///< of the last sum of momentum
    int other_box[6];       ///< of the last sum of anything else
    int low[3], high[3];    ///< offsets of the first and last blocks that its points reach
  };

  std::vector<Run> runs;    ///< grouped by block
  std::vector<ActiveBlock> active;
  double *tile, *tile_load;    ///< tile that points add to, and tile that they read
  bool valid = false;          ///< the blocks are those of the present points
  int drifted = 0;             ///< nonzero: a point has left the range of its tile

  MPMPointMap(class LAMMPS *, MPMField &);
  ~MPMPointMap();

  /** Start of a run: find out whether rebuilds of neighbor lists bound the drift of points. */
  void setup();
  /** Find the runs of points, and the blocks in their reach. Does nothing while these are valid. */
  void find_blocks();
  /** Find the neighbors of blocks, allocate their nodes, and find the ranks that share them. The
   *  blocks are valid then. */
  void finish_blocks();
  /** If a point has left its tile on any rank, mark the blocks to be found again. */
  void check_drift();

  /** Sort the data of the points by block, material, cell, and tag. */
  void sort();
  /** Has the order decayed since the last sort so that another one pays? */
  bool wants_sort() const;

  /** Base node of a position, and the coordinates of the position relative to it in cells. Returns
   *  false if the position is not usable. */
  bool base_node(const double *x, int base[3], double t[3]) const;
  /** Node index of the first entry of the tile of a block. */
  void tile_base(const ActiveBlock &, int base[3]) const;
  /** Load the nodes of a block into the tile, and prefetch those of the next block. mean: see
   *  TransferKernels::load_mean. */
  void load_tile(const ActiveBlock &, int base[3], bool mean);

  /** Number of points in all runs. */
  bigint npoints() const;
  /** Number of reals in a tile. */
  std::size_t tile_reals() const;
  double memory_usage() const;

  double sort_time = 0.0;    ///< in this run [s]
  bigint nsort = 0, nbuild = 0;

 private:
  MPMField &field;
  bool watch_drift = false;       // neighbor lists do not bound the drift: check it in each step
  bigint switches = 0;            // neighbors in memory that are in different cells, now
  bigint sorted_switches = 0;     // and right after the last sort
  bigint disorder = 0;            // neighbors in memory that are in different cells or blocks, now
  bigint sorted_disorder = -1;    // and right after the last sort; negative: not counted yet
  bigint extra_disorder =
      0;    // excess of disorder over sorted_disorder, summed over the steps since the last sort
};

/** Indices of the atoms of this rank in the order of their keys; atoms with equal keys are sorted
 *  by tag.
 *
 *  key: [nlocal] from 0 to nkeys - 1. Atoms with a negative key come last, in their present order.
 *  If LAMMPS wants the atoms of a group to be first (atom_modify first), they stay first and are
 *  sorted in the same way among themselves. The vector is overwritten. */
std::vector<int> order_by_keys(LAMMPS *, std::vector<int> &key, int nkeys);
/** Moves the data of the atoms of this rank: atom i is order[i] of before. Collective. */
void put_in_order(LAMMPS *, const std::vector<int> &order);

}    // namespace LAMMPS_NS
#endif
