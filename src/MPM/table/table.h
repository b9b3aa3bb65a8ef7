/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TABLE_TABLE_H
#define MPM_TABLE_TABLE_H

// Tables of points from files: named columns of numbers. Nothing here knows about LAMMPS.

#include <cstdint>
#include <string>
#include <vector>

namespace MPM_NS {

/** Named columns of numbers. A quantity with several components has columns NAME:0, NAME:1, ... */
struct Table {
  std::vector<std::string> names;
  std::vector<double> values;        ///< row by row, all finite
  std::vector<std::string> words;    ///< in the column of types, word k is the number -1 - k
  std::string units;                 ///< name of the units of a dump; empty: not given
  int64_t step = -1;                 ///< time step of a dump; -1: not given
  double time = 0.0;                 ///< time of a dump
  bool is_dump = false;              ///< was it written by dump mpm/vtk?

  std::size_t rows() const { return names.empty() ? 0 : values.size() / names.size(); }
  double at(std::size_t row, std::size_t column) const
  {
    return values[row * names.size() + column];
  }
};

/** Reads a file of comma-separated values or XYZ, or a VTK file of points (.vtp, .pvtp) as written
 *  by dump mpm/vtk. The format is found from the first line. columns: names of the columns,
 *  separated by commas, for files without names; empty: the names are in the file, or are
 *  type,x,y,z for XYZ. On errors, throws std::runtime_error that begins with the name of the
 *  file. */
Table read_table(const std::string &file, const std::string &columns);

/** The reader of VTK files; text: the whole file, name: name of the file for messages. */
Table read_vtk_points(const std::string &text, const std::string &name);

}    // namespace MPM_NS
#endif
