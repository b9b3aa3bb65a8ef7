/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_CREATE_POINTS_TABLE_H
#define LMP_CREATE_POINTS_TABLE_H

// create_points TYPE table FILE: keywords for the table, and its rows as points.

#include "create/mpm_point_columns.h"
#include "declare/option.h"

#include <array>
#include <string>
#include <vector>

namespace MPM_NS {
struct Table;
}

namespace LAMMPS_NS {

struct CreatePointsTableOptions {
  std::string columns;    ///< names of columns, separated by commas; empty: names in the file
  double scale = 1.0, move[3] = {0.0, 0.0, 0.0};
  double volume = 0.0;    ///< of each point; 0: taken from a column
  int part = 0;           ///< only rows of this type; 0: all rows
  bool new_ids = false;
  double diameter = 0.0;
  std::string group_id;
  std::vector<std::array<std::string, 2>> data;    ///< columns, and what they set of points
  struct Factor {
    std::string column;
    double value = 1.0;
  };
  std::vector<Factor> factors;

  MPM_NS::Options declare(int dimension, bool has_radius);

 private:
  std::array<std::string, 2> renamed;
  Factor factor;
};

/** The points of a table: rank 0 keeps all of them and hands out rows to the other ranks. */
class CreatePointsTable : protected Pointers {
 public:
  /** Reads and checks the file; stops with an error if it is not valid. type: of points that have
   *  none in the file. */
  CreatePointsTable(LAMMPS *, const CreatePointsTableOptions &, int type, const char *file);

  MPMPointColumns columns;
  bigint npoint = 0;    ///< points on all ranks

  /** Points and values [n][width()] of the rows first to first + n - 1, on all ranks.
   *  Collective. */
  void rows(bigint first, int n, std::vector<CreatePointsSite> &, std::vector<double> &) const;
  int width() const { return ncolumn; }

 private:
  int ncolumn = 0;
  std::vector<CreatePointsSite> points;    // of rank 0; tags are the IDs in the file, 0: new ones
  std::vector<double> values;              // of rank 0, npoint rows

  void read(const CreatePointsTableOptions &, int type, const std::string &file);
  void make_points(const CreatePointsTableOptions &, const MPM_NS::Table &, int type,
                   const std::string &file);
  void check_points(const std::string &file);
  void warn_of_near_points(const std::string &file) const;
};

}    // namespace LAMMPS_NS
#endif
