/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_GMSH_H
#define MPM_MESH_GMSH_H

// Meshes of linear elements, and files of Gmsh with them (others: mesh/mesh_file.h). Nothing here knows
// about LAMMPS.

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
  TRIANGLE,
  QUAD,
  TETRAHEDRON,
  HEXAHEDRON,
  LINE,
  PATCH,    ///< a triangle and its neighbors, see mesh/bending.h; never in a file, nor is the next one
  CORNER,    ///< two lines
  EDGE,      ///< two triangles, see mesh/shared_strain.h
};

/** Number of nodes of an element, and its dimension (1, 2 or 3). */
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
constexpr int element_dimension(ElementType t)
{
  if (t == ElementType::LINE) return 1;
  return t == ElementType::TRIANGLE || t == ElementType::QUAD ? 2 : 3;
}

/** An element of a mesh; plain data, so that a mesh can be sent as bytes. */
struct MeshElement {
  ElementType type;
  int physical;           ///< tag of its physical group, 0 for none (the first one of several)
  int64_t label;          ///< its number in the file
  int node[12];           ///< places in Mesh::nodes
  bool inside = false;    ///< of a PATCH: is none of its nodes on a rim of the surface?
};

/** Elements that have a name together. */
struct MeshSet {
  std::string name;
  std::vector<int> elements;    ///< places in Mesh::elements
};

/** Numbers that a file has for each node, or each element. */
struct MeshData {
  std::string name;
  bool at_nodes;
  int width;                     ///< numbers of each
  std::vector<double> values;    ///< [node or element][width]
};

/** What the elements of a surface (in the plane: lines) are together. */
struct SurfaceKind {
  bool closed;      ///< does each rim belong to two elements?
  bool oriented;    ///< do all elements have their normals on the same side?
};

/** Nodes and elements of a mesh file. */
struct Mesh {
  std::vector<std::array<double, 3>> nodes;
  std::vector<MeshElement> elements;
  std::map<std::pair<int, int>, std::string> groups;    ///< (dimension, tag) -> name
  std::vector<MeshSet>
      sets;    ///< of files whose elements can be in several; filled by keep() for others
  std::vector<MeshData> data;    ///< of files that have any

  /** Keep only elements of a dimension (drop the surface of a solid, say) and, when not empty, of a
   *  physical group (a name, or a tag) or set, then only the nodes that these use. Physical groups become
   *  sets, with their tags as names if they have none. Throws std::runtime_error when nothing is left. */
  void keep(int dim, const std::string &group = "");

  /** Divide each element into those of half of its size along each edge, 4 of a triangle or a quadrangle and 8 of a
   *  solid, with its label, groups, and data. They do not share their nodes, and data of nodes are dropped. */
  void halve_elements();

  /** Number the nodes of elements of a dimension whose size is negative in the opposite sense (a body of elements of
   *  dimension 2 has its normal along +z). */
  void orient(int dim);

  /** Throws std::runtime_error if two elements have the same nodes, which would be twice their mass. */
  void check_repeated(const std::string &hint = "") const;

  /** Number the nodes of elements of a surface such that those of neighbors go around in the same sense. */
  SurfaceKind orient_surface();

  /** Append patches and corners for the bending of a surface or of lines. Throws std::runtime_error where it cannot bend. */
  void add_bending();

  /** Area or volume of an element of the dimension of the mesh, negative when its nodes are numbered in the wrong
   *  sense. */
  double size(const MeshElement &) const;
};

/** Read the formats 2.2 and 4.1 of Gmsh, ASCII or binary of either order of bytes. Points of the mesh are left out, as are
 *  sections that describe no mesh. Throws std::runtime_error that begins with name:line. */
Mesh read_gmsh(std::istream &, const std::string &name);

/** The same from a file. */
Mesh read_gmsh(const std::string &file);

}    // namespace MPM_NS
#endif
