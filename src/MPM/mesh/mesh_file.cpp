/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/mesh_file.h"

#include "table/regular_file.h"

#include <fstream>
#include <iterator>
#include <stdexcept>

using namespace MPM_NS;

Mesh MPM_NS::read_mesh(const std::string &file)
{
  std::ifstream in(file, std::ios::binary);
  if (!in || is_no_file(file)) throw std::runtime_error("cannot open the mesh file " + file);
  std::string line;
  std::getline(in, line);
  in.clear();
  in.seekg(0);
  const auto begins = [&](const std::string &words) {
    return line.compare(0, words.size(), words) == 0;
  };
  if (begins("# vtk DataFile")) return read_vtk_mesh(in, file);
  if (begins("<?xml") || begins("<VTKFile"))
    return read_vtu_mesh({std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()},
                         file);
  // comments of Abaqus begin with two stars, keywords with one
  if (begins("*")) return read_abaqus(in, file);
  return read_gmsh(in, file);
}
