/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/cells,FixMPMCells);
// clang-format on
#else

#ifndef LMP_FIX_MPM_CELLS_H
#define LMP_FIX_MPM_CELLS_H

#include "fix.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Averages over the points in each cell of a lattice, for dump grid, fix ave/grid, dump image.
 *
 *  The computing lattice is sparse and has no arrays that LAMMPS could read. This fix has a dense
 *  grid of cells over the box, partitioned like other LAMMPS grids (fix ave/grid relies on that).
 *  It is filled when its data are first requested in a step, and costs nothing otherwise.
 */
class FixMPMCells : public Fix {
 public:
  FixMPMCells(class LAMMPS *, int, char **);
  ~FixMPMCells() override { deallocate(); }
  int setmask() override { return 0; }
  void init() override;
  void reset_grid() override;
  void pack_reverse_grid(int, void *, int, int *) override;
  void unpack_reverse_grid(int, void *, int, int *) override;
  int get_grid_by_name(const std::string &, int &) override;
  void *get_grid_by_index(int) override;
  int get_griddata_by_name(int, const std::string &, int &) override;
  void *get_griddata_by_index(int) override;
  double memory_usage() override;

 private:
  /** Inclusive range of cells, x y z; in 2d z is 0..0. */
  struct Cells {
    int lo[3], hi[3];
    bigint size() const
    {
      return (bigint) (hi[0] - lo[0] + 1) * (hi[1] - lo[1] + 1) * (hi[2] - lo[2] + 1);
    }
    bigint index(int x, int y, int z) const
    {
      return ((bigint) (z - lo[2]) * (hi[1] - lo[1] + 1) + y - lo[1]) * (hi[0] - lo[0] + 1) + x -
          lo[0];
    }
  };
  /** An average: an array of one value or of several columns per cell, the other pointer is null.
   *  In 2d, LAMMPS gets the part z = 0. */
  struct Average {
    double ***scalar;     // [z][y][x]
    double ****vector;    // [z][y][x][column]
  };

  std::string field_id;
  int dim, ncell[3];
  class Grid2d *grid2d = nullptr;
  class Grid3d *grid3d = nullptr;
  Cells owned, all;     // cells of this rank, without and with ghost cells
  double skin = 0.0;    // neighbor skin when the grid was made
  std::vector<double> buf1, buf2;
  std::vector<double> sums;    // [all][NSUM]
  std::vector<Average> averages;
  bigint filled = -1;    // time step of the averages; -1: none

  void set_size();
  void deallocate();
  void sum_points();
  void average();
  double *value(int, int, int, int);
};

}    // namespace LAMMPS_NS
#endif
#endif
