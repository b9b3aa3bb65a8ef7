/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_LATTICE_H
#define LMP_MPM_FLOW_LATTICE_H

#include "lattice/grid.h"
#include "mpm_halo.h"
#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {

/** What the fixed faces of the box are to a flow. */
struct MPMFlowWall {
  bool is = false;                  ///< no periodic face
  bool named = false;               ///< in the input
  bool sticks = false;              ///< no slip
  double v[3] = {0.0, 0.0, 0.0};    ///< velocity of one that sticks, along itself
};

/** The cells of a staggered lattice in reach of the points of a group: a Grid whose node i stands for the cell between nodes
 *  i and i + 1 of the lattice and for its lower faces, see lattice/staggered.h.
 *
 *  All ranks have all values in reach of their points, and in the layers around it that they want (overlap). Each cell is owned by one rank, which
 *  has its neighbors, too: values are made by owners, and publish() brings them to the others.
 *
 *  Beyond walls there is a layer of images of cells, so that velocities are of second order next to walls: normal components
 *  are odd, tangential ones even (slip) or odd about the velocity of the wall (stick). */
class MPMFlowLattice : protected Pointers {
 public:
  /** Points that are neighbors in memory and in the same block. */
  struct Run {
    int first, last, slot;
  };
  struct Cell {
    int number;     ///< slot*64 + n
    int near[6];    ///< neighbors: lower and upper one of each axis; images, next to walls
    int walls;      ///< bit 2 d + s: the lower (s = 0) or upper face along axis d is a wall
    int index[3];
  };

  MPM_NS::Grid grid;
  MPM_NS::Lattice &lattice;
  MPMFlowWall walls[3][2];
  std::vector<Run> runs;
  std::vector<Cell> cells;    ///< owned by this rank, within walls
  std::vector<int> around;    ///< [cells][3^dim] cells around each one and itself, if wanted
  bool wants_around = false;
  int wants_more =
      0;    ///< layers of cells around those in reach of points, whose values smoothing reaches
  int overlap = 1;              ///< layers of cells around its own ones that a rank has
  std::vector<int> visitors;    ///< atoms that are no points, around which there are cells, too
  bool valid = false;           ///< the blocks are those of the present points
  bigint nbuild = 0;

  /** Points may move so many spacings in a step: half of that has to be in reach of a rank before it moves them. */
  static constexpr double MOST_MOTION = 2.0;

  MPMFlowLattice(class LAMMPS *, const MPM_NS::Lattice &, int groupbit);

  /** The lattice must fit the box; finds the walls. */
  void check_box(const char *style);
  bool is_point(int i) const;
  /** Put points in the order of block, cell, and tag. */
  void sort();
  /** Blocks, cells, and lists; nothing while these are valid. */
  void find_cells();
  /** Does a point with this base still have its cells in those of its run? */
  template <int dim> bool in_reach(const Run &run, const int base[3]) const
  {
    const Range &r = ranges[run.slot];
    bool in = true;
    for (int d = 0; d < dim; d++)
      in = in && base[d] >= r.low[d] - DRIFT && base[d] <= r.high[d] + DRIFT;
    return in;
  }

  /** Do the visitors still have their cells? */
  bool visitors_in_reach() const;
  /** Slot of the block with the cell base of a place, which gets that; -1: there is none. */
  int find_block(const double *x, int base[3]) const;

  /** The values that points gave to images beyond walls go to cells within, width reals for each cell: the first dim of
   *  them are momenta, the next ones masses, and then forces at faces; all others are plain sums. Then sums over periodic images and ranks. Not moving: walls are at rest. */
  void sum(double *values, int width, bool moving = true) const;
  /** Values that belong to no wall: sums over periodic images and ranks. */
  void sum_freely(double *values, int width) const;
  /** Values of owners to other ranks and periodic images; the values of all others must be zero. */
  void publish(double *values, int width) const;
  /** The same for values that all ranks have already, of which owners have changed some. */
  void renew(double *values, int width) const;
  /** Who shares cells, for solves. */
  MPMHalo &halo_of_cells() const { return halo; }
  /** Zero for all cells that are not in the list. */
  void keep_owned(double *values, int width) const;
  /** Velocities [cell][dim] at walls and beyond; moving: those of the walls count. */
  void reflect_velocities(double *values, bool moving = true) const;
  /** Velocities that points move with [cell][dim], at walls and beyond: those normal to a wall without slip grow with the square of the
   *  distance, so that they are even, and the face in the wall has what makes them zero there when interpolated. */
  void reflect_paths(double *values) const;
  /** Even images of values in the middle of cells. */
  void reflect_cells(double *values) const;
  /** Images of values in the middle of cells, by f(cell that it is an image of, axis, side, value there). */
  template <class F> void fill_images(double *values, const F &f) const
  {
    for (auto image = images.rbegin(); image != images.rend(); ++image)
      values[image->number] = f(image->of_cell, image->axis, image->side, values[image->of_cell]);
  }
  /** Is a cell within walls? */
  bool is_inside(int64_t number) const;
  /** Number of a cell or of what it is a periodic image of; -1: not of this rank. */
  int canonical(const int index[3]) const;
  /** Images of values in the middle of cells that go on linearly, where inside(number) is true of the last two cells. */
  template <class F> void extrapolate_cells(double *values, const F &inside) const
  {
    for (auto image = images.rbegin(); image != images.rend(); ++image) {
      const int one = image->of_cell, next = image->of_next;
      values[image->number] = inside(one) && inside(next) ? 2.0 * values[one] - values[next]
                                                          : values[one];
    }
  }

  int64_t size() const { return grid.nnodes(); }
  double memory_usage() const;

 private:
  static constexpr int DRIFT = 1;    // of points since blocks were found, in cells
  static constexpr int HALF = 1;     // and half of what they move in a step

  struct Range {
    int low[3], high[3];
  };
  struct Image {
    int number, of_face,
        of_cell;    // images about the wall: of the normal component, and of all else
    int of_next;    // the cell behind of_cell
    int axis, side;
  };
  const int groupbit;
  mutable MPMHalo halo;
  mutable std::vector<double> kept;
  std::vector<Range> ranges;         // of bases, by slot
  std::vector<Range> of_visitors;    // their bases when cells were found
  std::vector<Image> images;         // by axis
  struct AtWall {
    int number, axis, side;
    int inner;    // the next one within, if there is any, or -1
  };
  std::vector<AtWall> at_walls;    // cells whose lower face is one

  std::vector<int> borrowed;    // cells of other ranks that this one has, too

  void base_of(const double *x, int base[3]) const;
  int rank_around(int number) const;
  void list_cells();
  void list_images();
};

}    // namespace LAMMPS_NS
#endif
