/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "table/table.h"

#include <fstream>
#include <iterator>
#include <stdexcept>

using namespace MPM_NS;

Table MPM_NS::read_table(const std::string &file, const std::string &columns)
{
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(file + ": cannot be read");
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (in.bad()) throw std::runtime_error(file + ": cannot be read to its end");
  if (text.compare(0, 3, "\xef\xbb\xbf") == 0) text.erase(0, 3);    // byte order mark of UTF-8
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) throw std::runtime_error(file + ": is empty");

  if (text[first] == '<') {
    if (!columns.empty())
      throw std::runtime_error(file + ": names its columns itself: leave the keyword columns out");
    return read_vtk_points(text, file);
  }
  if (text.find('\0') != std::string::npos)
    throw std::runtime_error(file +
                             ": is no text: expected comma-separated values, XYZ, or a VTK file of "
                             "points (.vtp)");
  if (text.compare(first, 14, "# vtk DataFile") == 0)
    throw std::runtime_error(file + ": is a legacy file of VTK: save it as .vtp");

  // the number of atoms stands alone in the first line of XYZ

  const std::string line = text.substr(first, text.find_first_of("\r\n", first) - first);
  const auto end = line.find_last_not_of(" \t");
  if (line.substr(0, end + 1).find_first_not_of("0123456789") == std::string::npos)
    return read_xyz(text, columns, file);
  return read_csv(text, columns, file);
}
