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

/** Reads a mesh of Gmsh (see read_gmsh()), VTK, or Abaqus; the first line of the file tells which.
 *  Points and lines of the mesh are left out. Elements other than triangles, quadrangles,
 *  tetrahedra, and hexahedra of first order are an error. Throws std::runtime_error with a message
 *  that begins with the name of the file. */
Mesh read_mesh(const std::string &file);

/** Reads a legacy VTK file, ASCII or binary, with an unstructured grid (versions up to 5.1), and
 *  its data of points and cells. Labels of elements are their numbers in the file, from 0. */
Mesh read_vtk_mesh(std::istream &, const std::string &name);

/** The same for the XML format (.vtu, see table/vtk_xml.h); text is the whole file. */
Mesh read_vtu_mesh(const std::string &text, const std::string &name);

/** Reads an Abaqus input file: *NODE, *ELEMENT, and *ELSET, also in parts, which are placed by
 *  *INSTANCE. Sets of elements go to Mesh::sets, those of *ELEMENT, ELSET=... first. Everything
 *  else in the file does not concern the mesh and is ignored. */
Mesh read_abaqus(std::istream &, const std::string &name);

}    // namespace MPM_NS
#endif
