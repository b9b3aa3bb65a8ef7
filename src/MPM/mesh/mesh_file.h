/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_MESH_FILE_H
#define MPM_MESH_MESH_FILE_H

// Meshes of linear elements from files of several programs. Nothing here knows about LAMMPS.

#include "mesh/gmsh.h"

namespace MPM_NS {

/** A mesh of Gmsh (see read_gmsh()), VTK, or Abaqus: what a file is tells its first line. Points and
 *  lines of the mesh are left out; other elements than triangles, quadrangles, tetrahedra, and hexahedra of first order
 *  are an error. Throws std::runtime_error that begins with the name of the file. */
Mesh read_mesh(const std::string &file);

/** Legacy files of VTK, ASCII or binary, with an unstructured grid (versions to 5.1), with the numbers that they have for points and
 *  cells. Labels of elements are their numbers in the file, from 0. */
Mesh read_vtk_mesh(std::istream &, const std::string &name);

/** The same in XML (.vtu, see table/vtk_xml.h), of the whole file. */
Mesh read_vtu_mesh(const std::string &text, const std::string &name);

/** Input files of Abaqus: *NODE, *ELEMENT, and *ELSET, in parts, too, where *INSTANCE puts them. Sets of elements are in Mesh::sets, those of *ELEMENT,
 *  ELSET=... first. What else the file has says nothing about the mesh and is not read. */
Mesh read_abaqus(std::istream &, const std::string &name);

}    // namespace MPM_NS
#endif
