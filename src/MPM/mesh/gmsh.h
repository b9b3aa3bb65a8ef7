/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_GMSH_H
#define MPM_MESH_GMSH_H

// Meshes of linear elements, and the reader for Gmsh files (other files: mesh/mesh_file.h). Nothing
// here knows about LAMMPS.

#include <array>
#include <cstdint>
#include <istream>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace MPM_NS {

/** Linear elements; their nodes are in Gmsh's order, which is that of VTK. */
enum class ElementType : int {
  /** A triangle and its neighbors, see mesh/bending.h. This type and the next two are never in a
   *  file. */
  TRIANGLE,
  QUAD,
  TETRAHEDRON,
  HEXAHEDRON,
  LINE,
  PATCH,
  CORNER,    ///< two lines that meet, see BentLine
  EDGE,      ///< two triangles that meet, see mesh/bending.h
};

/** Number of nodes of an element. */
constexpr int element_nodes(ElementType t)
{
  switch (t) {
    case ElementType::LINE:
      return 2;
    case ElementType::TRIANGLE:
    case ElementType::CORNER:
      return 3;
    case ElementType::PATCH:
      return 12;
    case ElementType::EDGE:
      return 4;
    case ElementType::HEXAHEDRON:
      return 8;
    default:
      return 4;
  }
}
/** Dimension of an element: 1, 2 or 3. */
constexpr int element_dimension(ElementType t)
{
  if (t == ElementType::LINE) return 1;
  return t == ElementType::TRIANGLE || t == ElementType::QUAD ? 2 : 3;
}

/** An element of a mesh; plain data, so that a mesh can be sent as bytes. */
struct MeshElement {
  ElementType type;
  int physical;           ///< tag of its physical group (the first one of several), 0: none
  int64_t label;          ///< number of the element in the file
  int node[12];           ///< indices in Mesh::nodes
  bool inside = false;    ///< PATCH: is none of its nodes on a rim of the surface?
};

/** A named set of elements. */
struct MeshSet {
  std::string name;
  std::vector<int> elements;    ///< indices in Mesh::elements
};

/** Data of a file for each node or each element. */
struct MeshData {
  std::string name;
  bool at_nodes;
  int width;                     ///< values per node or element
  std::vector<double> values;    ///< [node or element][width]
};

/** Topology of the elements of a surface (in the plane: lines). */
struct SurfaceKind {
  bool closed;      ///< does each rim belong to two elements?
  bool oriented;    ///< do all elements have their normals on the same side?
};

/** Nodes and elements of a mesh. */
struct Mesh {
  std::vector<std::array<double, 3>> nodes;
  std::vector<MeshElement> elements;
  std::map<std::pair<int, int>, std::string> groups;    ///< (dimension, tag) -> name
  /** Sets from files in which an element can be in several sets; for other files, keep() fills
   *  this. */
  std::vector<MeshSet> sets;
  std::vector<MeshData> data;    ///< data of the file, if any

  /** Keeps only the elements of a dimension (for example, drops the surface of a solid) and, if
   *  group is not empty, of a physical group (name or tag) or set, and then only the nodes that
   *  these elements use. Physical groups become sets, named by their tags if they have no name.
   *  Throws std::runtime_error if nothing is left. */
  void keep(int dim, const std::string &group = "");

  /** Divides each element into elements of half its size along each edge, 4 for a triangle or
   *  quadrangle and 8 for a solid. They inherit label, groups, and data of the element. They do not
   *  share nodes, and data of nodes are dropped. */
  void halve_elements();

  /** Reverses the numbering of the nodes of elements of a dimension whose size is negative (a body
   *  of elements of dimension 2 has its normal along +z). */
  void orient(int dim);

  /** Throws std::runtime_error if two elements have the same nodes, as their mass would count
   *  twice. */
  void check_repeated(const std::string &hint = "") const;

  /** Numbers the nodes of the elements of a surface such that neighbors go around in the same
   *  sense. */
  SurfaceKind orient_surface();

  /** Appends patches and corners for the bending of a surface or of lines. Throws
   *  std::runtime_error if it cannot bend somewhere. */
  void add_bending();

  /** Area or volume of an element of the dimension of the mesh, negative if its nodes are numbered
   *  in the wrong sense. */
  double size(const MeshElement &) const;
};

/** Reads the Gmsh formats 2.2 and 4.1, ASCII or binary in either byte order. Point elements are
 *  left out, and sections that do not describe the mesh are skipped. Throws std::runtime_error with
 *  a message that begins with name:line. */
Mesh read_gmsh(std::istream &, const std::string &name);

/** The same from a file. */
Mesh read_gmsh(const std::string &file);

}    // namespace MPM_NS
#endif
