/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_CELL_VOLUMES_H
#define MPM_MESH_CELL_VOLUMES_H

// The share of each cell of a lattice that is inside of a surface of triangles. Nothing here knows
// about LAMMPS.

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace MPM_NS {

/** For each cell of a lattice, the volume of the part of a body in it and the center of that part,
 *  exact to rounding. The body is the inside of a closed surface of triangles.
 *
 *  A place is inside if a ray from it along +x leaves the body once more often than it enters it.
 *  Each triangle counts, with the sign of its normal, for the places from which it is seen along x.
 *  So the volume in a cell is a sum of integrals of polynomials over the parts of the triangles in
 *  its column of cells along x. Places around which the surface winds twice count twice. */
class CellVolumes {
 public:
  using Point = std::array<double, 3>;

  /** Integrals over the part of the body in a cell: its volume, and the position relative to the
   *  lower corner of the cell. */
  struct Sums {
    double volume = 0.0;
    Point moment = {0.0, 0.0, 0.0};
  };

  /** Range of cells along an axis, including the last one. */
  struct Range {
    int64_t first, last;
  };

  /** Cell i has its lower corner at origin + i size. Only cells in the ranges [3] can be asked for;
   *  their number bounds the effort, however far the surface reaches. Throws std::runtime_error if
   *  a range has more than 1e9 cells. */
  CellVolumes(const std::vector<std::array<Point, 3>> &triangles, const double *origin,
              const double *size, const Range *ranges);

  /** The sums of a cell within the ranges. */
  Sums operator()(int64_t i, int64_t j, int64_t k) const;

 private:
  struct Entry {    // contribution of triangles in a column
    int64_t cell;
    double part[4] = {0.0};     // volume and moments in this cell
    double below[3] = {0.0};    // area and its moments along y and z, for the cells below it
  };
  using Column = std::vector<Entry>;    // sorted by increasing cell once complete

  double origin[3], size[3];
  Range ranges[3];
  std::unordered_map<uint64_t, Column> columns;

  static uint64_t key(int64_t j, int64_t k) { return (uint64_t) (uint32_t) j << 32 | (uint32_t) k; }
  void add(const std::vector<Point> &polygon, int64_t j, int64_t k);
  void add_piece(const std::vector<Point> &piece, Entry &);
};

}    // namespace MPM_NS
#endif
