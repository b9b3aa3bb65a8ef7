/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_POCKETS_H
#define LMP_MPM_FLOW_POCKETS_H

#include "flow/mpm_flow_lattice.h"

#include <cstdint>
#include <map>
#include <vector>

namespace LAMMPS_NS {
class MPMFlowPressure;
class MPMFlowRegions;

/** Pockets: connected sets of empty cells between a flow and walls; cells are connected through
 *  faces. Most of their cells can be far from all points, where the lattice of the flow has no
 *  cells. So this object has all cells of the box, one number each, the same on all ranks. Ranks
 *  exchange one bit for each cell, and number pockets in the order of their first cells. */
class MPMFlowPockets : protected Pointers {
 public:
  static constexpr int NONE = -1;    ///< pocket of a wet or solid cell

  /** Number of cells that a new pocket has in common with one before. If no pocket has cells in
   *  common with the one before, the nearest ones take their place. */
  struct Overlap {
    int from, to;
    bigint cells;
  };

  bool open[3][2] = {};    ///< faces of the box next to which there is open air

  /** Stops with an error if the box has more cells than a rank can have. */
  MPMFlowPockets(class LAMMPS *, const MPMFlowLattice &);
  /** Finds the cells of the box that are solid, those with their middle in a region; null: none. */
  void find_solid(const MPMFlowRegions *);
  /** Finds the pockets for the cells that are wet now. Returns false if nothing has changed; else
   *  overlaps() relate them to the pockets before. Collective. */
  bool find(const MPMFlowPressure &);
  int n() const { return (int) infos.size(); }    ///< number of pockets
  bigint cells_of(int pocket) const { return infos[pocket].cells; }
  /** Volume of these cells that is not solid, in volumes of a cell. */
  double volume_of(int pocket) const { return infos[pocket].volume; }
  /** Does a pocket reach an open face of the box? */
  bool is_open(int pocket) const { return infos[pocket].open; }
  /** Sum of the open shares of the cells of a pocket at a wall of the box. */
  double cells_at(int pocket, int axis, int side) const { return infos[pocket].at[axis][side]; }
  const std::vector<Overlap> &overlaps() const { return common_cells; }

  /** Pocket of a cell of the lattice of the flow; NONE: it is in none, or beyond a wall. */
  int pocket(int64_t number) const { return pocket_of_cell[number]; }

  /** For restart files: pairs of the number of a pocket and the number of consecutive cells that
   *  have it. */
  std::vector<double> runs() const;
  /** Takes n reals of runs(); returns false if they belong to another lattice. */
  bool set_runs(const double *from, std::size_t n);

  double memory_usage() const
  {
    return MPM_NS::bytes_of(wet, closed, closed_before, solid, volume_fractions, stack, cut, labels,
                            labels_before, pocket_of_cell, infos, common_cells);
  }

 private:
  struct Info {
    bigint cells = 0;
    double volume = 0.0, at[3][2] = {};
    bool open = false;
  };

  const MPMFlowLattice &cells;
  int ncell[3];
  int64_t size;
  std::vector<uint64_t> wet, closed, closed_before, solid;    // bits of cells
  std::vector<int64_t> cut;                                   // solid cells that are open in part
  std::vector<float> volume_fractions;                        // of cells, with regions
  std::vector<int> labels, labels_before, pocket_of_cell;
  std::vector<int64_t> stack;
  std::vector<Info> infos;
  std::vector<Overlap> common_cells;
  int nbefore = 0;

  int64_t place(const int *index) const
  {
    return ((int64_t) index[0] * ncell[1] + index[1]) * ncell[2] + index[2];
  }
  void index_of(int64_t place, int *index) const;
  bool step(int *index, int axis, int by) const;
  int next_to(const int *index) const;
  void fill(int64_t first, int label);
  void number();
  std::map<int, bigint> nearest(int before) const;
  void compare();
  void find_lattice(const MPMFlowPressure &);
};

}    // namespace LAMMPS_NS
#endif
