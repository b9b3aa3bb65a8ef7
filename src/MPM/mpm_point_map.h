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
class MPMField;

/** Which points are in which blocks of the lattice, and their order in memory. */
class MPMPointMap : protected Pointers {
 public:
  /** Consecutive points of one block and material (null: nodes of elements). */
  struct Run {
    int first, last, slot;
    FixMPMMaterial *material;
  };
  /** A block with points: its runs, and boxes of base nodes in its tile. */
  struct ActiveBlock {
    int slot, first_run, last_run;
    int box[6];             ///< of the last momentum
    int other_box[6];       ///< of the last other sum
    int low[3], high[3];    ///< offsets of the first and last blocks that its points reach
  };

  std::vector<Run> runs;    ///< grouped by block
  std::vector<ActiveBlock> active;
  double *tile, *tile_load;    ///< one that points add to, one that they read
  bool valid = false;          ///< the blocks are those of the present points
  int drifted = 0;             ///< a point has left the range of its tile

  MPMPointMap(class LAMMPS *, MPMField &);
  ~MPMPointMap();

  /** Start of a run: do rebuilds of neighbor lists bound the drift of points? */
  void setup();
  /** Runs of points, and the blocks in their reach; nothing while these are valid. */
  void find_blocks();
  /** Neighbors of blocks, room for their nodes, sharers on other ranks; then they are valid. */
  void finish_blocks();
  /** The blocks are to be found anew where a point has left its tile on any rank. */
  void check_drift();

  /** Put points in the order of block, material, cell and tag, the data itself. */
  void sort();
  /** Has the order decayed since the last sort? */
  bool wants_sort() const;

  /** Base node of a position and its coordinates there in cells; false: not a usable position. */
  bool base_node(const double *x, int base[3], double t[3]) const;
  /** Node index of the first entry of the tile of a block. */
  void tile_base(const ActiveBlock &, int base[3]) const;
  /** Nodes of a block to the tile, and those of the next block towards the cache; mean: see
   *  TransferKernels::load_mean. */
  void load_tile(const ActiveBlock &, int base[3], bool mean);

  bigint npoints() const;
  std::size_t tile_reals() const;
  double memory_usage() const;

  double sort_time = 0.0;    ///< in this run [s]
  bigint nsort = 0, nbuild = 0;

 private:
  MPMField &field;
  bool watch_drift = false;    // rebuilds of neighbor lists do not bound the drift: check each step
  bigint switches = 0;         // neighbors in memory that are in different cells, now
  bigint sorted_switches = 0;     // and right after the last sort
  bigint disorder = 0;            // neighbors in memory that are in different cells or blocks, now
  bigint sorted_disorder = -1;    // and right after the last sort; negative: not counted yet
  bigint extra_disorder = 0;      // what was more than that since then, summed over steps
};

}    // namespace LAMMPS_NS
#endif
