/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TABLE_TABLE_H
#define MPM_TABLE_TABLE_H

// Tables of points from files: columns of numbers with names. Nothing here knows about LAMMPS.

#include <cstdint>
#include <string>
#include <vector>

namespace MPM_NS {

/** Columns of numbers by name. Components of what has several are columns NAME:0, NAME:1, ... */
struct Table {
  std::vector<std::string> names;
  std::vector<double> values;        ///< row by row, all finite
  std::vector<std::string> words;    ///< word k stands as the number -1 - k in the column of types
  std::string units;                 ///< name of the units of a dump, empty: the file does not tell
  int64_t step = -1;                 ///< of a dump, -1: the file does not tell
  double time = 0.0;                 ///< of a dump
  bool is_dump = false;              ///< of dump mpm/vtk

  std::size_t rows() const { return names.empty() ? 0 : values.size() / names.size(); }
  double at(std::size_t row, std::size_t column) const
  {
    return values[row * names.size() + column];
  }
};

/** Reads a file of comma-separated values or XYZ, or a VTK file of points (.vtp, .pvtp) as dump mpm/vtk writes it; its first line
 *  tells which it is. columns: their names, separated by commas, for files that do not name them; empty: the file
 *  does, or those of XYZ are type,x,y,z. Throws std::runtime_error that begins with the name of the file. */
Table read_table(const std::string &file, const std::string &columns);

// by format, of the whole file; name: of the file, for messages
Table read_csv(const std::string &text, const std::string &columns, const std::string &name);
Table read_xyz(const std::string &text, const std::string &columns, const std::string &name);
Table read_vtk_points(const std::string &text, const std::string &name);

}    // namespace MPM_NS
#endif
