/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TABLE_REGULAR_FILE_H
#define MPM_TABLE_REGULAR_FILE_H

#include <filesystem>
#include <string>

namespace MPM_NS {

/** Is there something of this name that is no file, such as a folder, a device, or a pipe? Reading
 *  it may never end. */
inline bool is_no_file(const std::string &name)
{
  std::error_code ignored;
  const auto status = std::filesystem::status(name, ignored);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

}    // namespace MPM_NS
#endif
