/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_LATTICE_H
#define LMP_MPM_FLOW_LATTICE_H

#include "field/mpm_halo.h"
#include "lattice/grid.h"
#include "pointers.h"
#include "solve/bytes_of.h"

#include <array>
#include <vector>

namespace LAMMPS_NS {

/** A face of the box as a wall of a flow. */
struct MPMFlowWall {
  bool is = false;                  ///< is the face a wall (fixed)? Else it is periodic
  bool named = false;               ///< is it named in the input?
  bool sticks = false;              ///< no slip
  double v[3] = {0.0, 0.0, 0.0};    ///< velocity of a wall without slip, along itself
};

/** The cells of a staggered lattice in reach of the points of a group: a Grid whose node i stands
 *  for the cell between nodes i and i + 1 of the lattice and for its lower faces, see
 *  lattice/staggered.h.
 *
 *  All ranks have all values in reach of their points, and in requested layers of cells around it
 *  (overlap). Each cell is owned by one rank, which also has its neighbors. Owners compute values,
 *  and publish() sends them to the other ranks.
 *
 *  Beyond walls there is a layer of images of cells, so that velocities are of second order next to
 *  walls: normal components are odd, tangential ones even (slip) or odd about the velocity of the
 *  wall (stick). */
class MPMFlowLattice : protected Pointers {
 public:
  /** Points from points[first] to points[last - 1], which are in the same block. */
  struct Run {
    int first, last, slot;
  };
  struct Cell {
    int number;     ///< slot*64 + n
    int near[6];    ///< numbers of neighbors: lower and upper one of each axis; images at walls
    int walls;      ///< bit 2 d + s: the lower (s = 0) or upper face along axis d is a wall
    int index[3];
  };

  MPM_NS::Grid grid;
  MPM_NS::Lattice &lattice;
  MPMFlowWall walls[3][2];
  std::vector<int> points;    ///< atoms that are points, in the order of block, cell, and tag
  std::vector<Run> runs;
  std::vector<Cell> cells;      ///< owned by this rank, within walls
  std::vector<int> around;      ///< [cells][3^dim] numbers of cells around each one and itself
  bool wants_around = false;    ///< is this list needed?
  int wants_more = 0;    ///< more layers of cells around those in reach of points, for smoothing
  int overlap = 1;       ///< layers of cells that a rank has around those in reach of its points
  std::vector<int> visitors;    ///< atoms that are not points, around which cells are needed, too
  bool valid = false;           ///< do the blocks belong to the present points?
  bigint nbuild = 0;            ///< how often the blocks have been found

  /** Number of spacings that points may move in a step. Half of it must be in reach of a rank
   *  before it moves them. */
  static constexpr double MOST_MOTION = 2.0;
  /** Strides of the neighbors along each axis in around, by dimension. */
  static constexpr int STRIDE[2][3] = {{3, 1, 0}, {9, 3, 1}};

  /** groupbit: of the group of the points. */
  MPMFlowLattice(class LAMMPS *, const MPM_NS::Lattice &, int groupbit);

  /** Finds the walls. Stops with an error if the lattice does not fit the box, for example if a
   *  length is not a multiple of the spacing. style: of the fix, for messages. */
  void check_box(const char *style);
  /** Is atom i a point of the group? */
  bool is_point(int i) const;
  /** Finds the order of points, after atoms have got other numbers. Moves their data into it now
   *  and then, and if move is true. Collective. */
  void sort(bool move = false);
  /** Finds blocks, cells, and lists; does nothing while these are valid. */
  void find_cells();
  /** Are the cells that a point with this base reaches still among those of its run? */
  template <int dim> bool in_reach(const Run &run, const int base[3]) const
  {
    const Range &r = ranges[run.slot];
    bool in = true;
    for (int d = 0; d < dim; d++)
      in = in && base[d] >= r.low[d] - DRIFT && base[d] <= r.high[d] + DRIFT;
    return in;
  }

  /** Are the cells that the visitors reach still among those that were found? */
  bool visitors_in_reach() const;
  /** Finds the cell base of a place; returns the slot of its block, -1: there is none. */
  int find_block(const double *x, int base[3]) const;

  /** Moves the values that points gave to images beyond walls to the cells within, and adds up
   *  values of periodic images and ranks. values: [cell][width], the first dim of a cell are
   *  momenta of its faces, the next dim masses, the next dim forces; all others are plain sums.
   *  moving false: walls are at rest. Collective. */
  void sum(double *values, int width, bool moving = true) const;
  /** Adds up values [cell][width] of periodic images and ranks, without walls. Collective. */
  void sum_freely(double *values, int width) const;
  /** Sends values [cell][width] of owners to other ranks and periodic images; the values of all
   *  others must be zero. Collective. */
  void publish(double *values, int width) const;
  /** As publish(), for values that all ranks have already and of which owners have changed some. */
  void renew(double *values, int width) const;
  /** The ranks that share cells, for solves. */
  MPMHalo &halo_of_cells() const { return halo; }
  /** Sets the values [cell][width] of all cells to zero that are not in the list of owned cells. */
  void keep_owned(double *values, int width) const;
  /** Sets velocities [cell][dim] at walls and beyond; sticks false: as if all walls had slip. */
  void reflect_velocities(double *values, bool sticks = true) const;
  /** Sets the velocities [cell][dim] with which points move, at walls and beyond. Normal to a wall
   *  without slip, the velocity grows with the square of the distance, so that it is even, and the
   *  face in the wall has the value for which the interpolated velocity is zero there. */
  void reflect_paths(double *values) const;
  /** Sets values [cell][width] of faces beyond walls to those of the faces whose images they are;
   *  value k is that of a face normal to k modulo dim. */
  void reflect_faces(double *values, int width) const;
  /** Sets values in the middle of images of cells to those of the cells. */
  void reflect_cells(double *values) const;
  /** Sets values in the middle of images of cells to f(cell, axis, side). Changes beyond several
   *  walls add up. */
  template <class F> void fill_images(double *values, const F &f) const
  {
    for (const auto &image : images) {
      const double here = values[image.source];
      double change = 0.0;
      for (int s = 0; s < 2 * lattice.dim; s++)
        if (image.walls >> s & 1) change += f(image.source, s / 2, s % 2) - here;
      values[image.number] = here + change;
    }
  }
  /** Is the next face that is normal to an axis, beyond side s of a cell (as in Cell::near), in or
   *  behind a wall? */
  bool ends_at_wall(const Cell &cell, int axis, int s) const
  {
    return cell.walls >> s & 1 ||
        (s == 2 * axis && !lattice.periodic[axis] && cell.index[axis] == 1);
  }
  /** Number of a cell, or of the cell of which it is a periodic image; -1: this rank does not have
   *  it. */
  int canonical(const int index[3]) const;
  /** Sets values in the middle of images of cells by linear extrapolation along the axes for whose
   *  last two cells inside(number) is true, else to those of the cells. */
  template <class F> void extrapolate_cells(double *values, const F &inside) const
  {
    for (const auto &image : images) {
      const double here = values[image.source];
      double change = 0.0;
      for (int d = 0; d < lattice.dim; d++)
        if (image.walls >> 2 * d & 3 && inside(image.source) && inside(image.behind[d]))
          change += here - values[image.behind[d]];
      values[image.number] = here + change;
    }
  }

  /** Number of cells of all blocks on this rank: the length of arrays [cell]. */
  int64_t size() const { return grid.nnodes(); }
  double memory_usage() const;

 private:
  static constexpr int DRIFT = 1;    // largest motion of points since blocks were found, in cells
  static constexpr int HALF = 1;     // half of their largest motion in a step, in cells

  struct Range {
    int low[3], high[3];
  };
  struct Image {
    int number, source;
    int walls;        // bit 2 d + s: the image is beyond the lower (s = 0) or upper wall of axis d
    int behind[3];    // the cell behind source, along each of these axes
  };
  // a face in or beyond a wall: its velocity is factor times that of the source, plus shift, which
  // is due to the motion of a wall; with slip at all walls it is slip times that of the source
  struct FaceImage {
    int number, axis;
    int source;
    int walls;    // as in Image
    double factor, shift, slip;
  };
  const int groupbit;
  int sorts = 0;    // how often the order was found since data was moved
  mutable MPMHalo halo;
  mutable std::vector<double> kept;
  std::vector<Range> ranges;            // of bases, by slot
  std::vector<Range> visitor_ranges;    // their bases when cells were found
  std::vector<Image> images;
  std::vector<FaceImage> face_images, path_images;    // for velocities and for paths

  std::vector<int> borrowed;    // cells of other ranks that this rank has, too

  void base_of(const double *x, int base[3]) const;
  std::array<int, 3> block_of(const int base[3]) const;
  int rank_around(int number) const;
  void list_cells();
  void list_images();
  int beyond(const int index[3]) const;
  void add_image(int number, const int index[3]);
  void add_face_image(int number, const int index[3], int axis);
  void reflect(double *values, const std::vector<FaceImage> &faces) const;
};

/** Extends the velocities of the water to faces in the air that points near the surface reach:
 *  layer by layer, as means of the known velocities around. */
class MPMFlowAir {
 public:
  /** Layers of faces that a point just below the surface reaches, also from its place after half a
   *  step. */
  static constexpr int LAYERS = 3;

  explicit MPMFlowAir(const MPMFlowLattice &cells) : cells(cells) {}

  /** velocity, known (1 or 0): [cell][dim], of owned cells before and of all cells afterwards.
   *  Collective. */
  void extend(std::vector<double> &velocity, std::vector<double> &known);
  double memory_usage() const { return MPM_NS::bytes_of(all, unknown, found); }

 private:
  struct Face {
    int cell, axis;    // cell: place in the list of cells
  };
  struct Found {
    int64_t place;    // in the array all
    double value;
  };
  const MPMFlowLattice &cells;
  std::vector<double> all;
  std::vector<Face> unknown;
  std::vector<Found> found;
};

}    // namespace LAMMPS_NS
#endif
