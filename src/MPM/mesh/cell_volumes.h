/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_CELL_VOLUMES_H
#define MPM_MESH_CELL_VOLUMES_H

// What cells of a lattice have of a body inside of a surface of triangles. Nothing here knows about
// LAMMPS.

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace MPM_NS {

/** The volume that each cell of a lattice has of the body inside of a closed surface of triangles, and its center, exact to
 *  rounding.
 *
 *  A place is inside if a ray from it along +x leaves the body once more often than it enters it: each triangle adds to the places that it is seen
 *  from along x, with the sign of its normal. So the volume in a cell is a sum of integrals over the parts
 *  of the triangles in its column of cells along x, of polynomials. Where the surface winds twice around places, these count twice. */
class CellVolumes {
 public:
  using Point = std::array<double, 3>;

  /** Of a cell: volume, and the integral of the position relative to its lower corner. */
  struct Sums {
    double volume = 0.0;
    Point moment = {0.0, 0.0, 0.0};
  };

  /** Cells that are asked for along an axis, the last one included. */
  struct Range {
    int64_t first, last;
  };

  /** Cell i has its lower corner at origin + i size; what is known is that of the cells in the ranges [3], whose number bounds the
   *  effort, however far the surface reaches. Throws std::runtime_error if that is more than 1e9 cells along an axis. */
  CellVolumes(const std::vector<std::array<Point, 3>> &triangles, const double *origin,
              const double *size, const Range *ranges);

  Sums operator()(int64_t i, int64_t j, int64_t k) const;

 private:
  struct Entry {    // where triangles are in a column
    int64_t cell;
    double part[4] = {0.0};     // volume and moments in this cell
    double below[3] = {0.0};    // area, and its moments along y and z, for the cells below it
  };
  using Column = std::vector<Entry>;    // in increasing order of the cells at last

  double origin[3], size[3];
  Range ranges[3];
  std::unordered_map<uint64_t, Column> columns;

  static uint64_t key(int64_t j, int64_t k) { return (uint64_t) (uint32_t) j << 32 | (uint32_t) k; }
  void add(const std::vector<Point> &polygon, int64_t j, int64_t k);
  void add_piece(const std::vector<Point> &piece, Entry &);
};

}    // namespace MPM_NS
#endif
