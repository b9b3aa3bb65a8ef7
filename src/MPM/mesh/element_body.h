/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */
#ifndef MPM_MESH_ELEMENT_BODY_H
#define MPM_MESH_ELEMENT_BODY_H

#include "mesh/bending.h"
#include "mesh/element.h"
#include "mesh/near_nodes.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace MPM_NS {

/** Triangles of a quadrangle, each with the weight 1/2; the first one also stands for a
 *  triangle. */
static constexpr int SPLIT[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};

/** The elements of a body that one rank has. Each is a row of numbers, which can move to another
 *  rank or into a file:
 *
 *    label and type of the element, IDs of its nodes [maxnode], their reference positions relative
 *    to the first one [maxnode][dim], and for each integration point F [9], tau [6], history, and,
 *    for surfaces and lines, the gradient of the motion along them [9];
 *    where the surface is curved, last, its area over that of the flat element.
 *
 *  Parts that bend have rows of their own, with the square of their extent and a BentTriangle,
 *  BentLine, or SharedStrain in place of positions and integration points. */
class ElementBody {
 public:
  enum Bending { NONE, CONSTANT, LINEAR };

  /** along: dimension of the elements in space of dim dimensions. across: volume per area of a
   *  surface, or per length of a line; 0: a solid. */
  ElementBody(int dim, int along, double across, Bending bending, bool curved) :
      dim(dim), along(along), across(across), bending(bending), curved(curved)
  {
  }
  /** Finds maxnode and maxpoint. */
  void count_nodes_and_points(const Mesh &);
  /** Chooses for each element the one of its corners that owns fewest elements so far. most: raised
   *  to the largest number that a node owns. */
  static std::vector<int> choose_owners(const Mesh &, int &most);
  /** Sets the length of rows for points with so many history variables. */
  void set_history(int nhistory);

  const int dim, along;
  const double across;
  const Bending bending;
  const bool curved;
  int maxnode = 0, maxpoint = 0;       ///< of the largest element of the mesh
  int nhistory = 0, stride = 0;        ///< history variables of a point; length of a row
  double stiffness = 0.0, nu = 0.0;    ///< of bending

  std::vector<double> pool;    ///< rows of all elements
  /** Of each element, in the order of rows: local indices of its nodes, and of its owner. */
  std::vector<std::array<int, PATCH_NODES>> nodes;
  std::vector<int> owner;

  std::size_t size() const { return pool.size() / stride; }
  bool is_thin() const { return across > 0.0; }
  double *row(std::size_t e) const { return const_cast<double *>(pool.data()) + e * stride; }
  static ElementType type_of(const double *row) { return (ElementType) (int) row[1]; }
  static const ElementRule &rule_of(const double *row) { return ElementRule::of(type_of(row)); }
  /** Is it a part that bends? */
  static bool bends(const double *row)
  {
    return type_of(row) == ElementType::PATCH || type_of(row) == ElementType::CORNER ||
        type_of(row) == ElementType::EDGE;
  }
  int nodes_of(const double *row) const;
  double *state_of(double *row, int q) const
  {
    return row + 2 + maxnode * (1 + dim) + q * point_size();
  }
  int point_size() const { return 15 + nhistory + (is_thin() ? 9 : 0); }
  /** Gradient of the motion along a surface or line, in the state of a point. */
  double *motion_of(double *state) const { return state + 15 + nhistory; }
  /** Area of the curved surface divided by that of the flat element. */
  double swell_of(const double *row) const { return curved ? row[stride - 1] : 1.0; }

  /** Undeformed edges of elements and diagonals of quadrangles. Nodes are numbered from the ID low
   *  on. */
  std::vector<NearNodes::Edge> edges(int64_t low) const;

  /** Face of a surface (in 2d: a line): an element or half of a quadrangle. */
  struct Face {
    int64_t element;    ///< its label
    int part;           ///< 0 or 1: half of a quadrangle
    int node[3];        ///< local indices, in the order of the element
  };
  std::vector<Face> faces() const;

  /** Face with nodes numbered from the ID low on. */
  struct NumberedFace {
    int64_t element, part;
    int64_t node[3];
  };
  /** Adds the faces of an element. */
  void add_numbered_faces(std::size_t e, int64_t low, std::vector<NumberedFace> &) const;

  /** Distances of nodes of elements. nodes: largest one, times the Frobenius norm of F. bent: that
   *  of parts that bend, without deformation, squared; stretch: largest square of the norm. */
  struct Extents {
    double nodes = 0.0, bent = 0.0, stretch = 0.0;
  };
  Extents extents() const;

  /** Fills the row of a part that bends, from the positions X of its nodes. rough: counts triangles
   *  that know too few nodes around them. Returns false for lines that make an angle. */
  bool define_bending(double *row, const double (*X)[3], bool inside, int64_t &rough) const;
  /** Energy of a row, and its forces on the nodes. */
  double bend(const double *row, const double (*x)[3], double (*f)[3]) const;
  /** Adds the sums of rows of the stiffness of bending to the nodes, numbered from the ID low
   *  on. */
  void add_bending_sums(int64_t low, std::vector<double> &sum) const;

  /** Calls visit(energy, element, number of nodes, forces on them) for all parts that bend. x:
   *  positions of points. */
  template <class Visit> void for_bending(const double *const *x, const Visit &visit) const
  {
    for (std::size_t e = 0; e < nodes.size(); e++) {
      const double *const r = row(e);
      if (!bends(r)) continue;
      const int nnode = nodes_of(r);
      double at[PATCH_NODES][3], f[PATCH_NODES][3] = {{0.0}};
      relative(x, e, nnode, at);
      const double energy = bend(r, at, f);
      visit(energy, e, nnode, f);
    }
  }
  /** Calls visit(x, nodes) for the edges of a curved surface (in 2d: corners), with the positions
   *  of their nodes relative to the first one. */
  template <class Visit> void for_curved_edges(const double *const *x, const Visit &visit) const
  {
    for (std::size_t e = 0; e < nodes.size() && curved; e++) {
      if (type_of(row(e)) != ElementType::EDGE && type_of(row(e)) != ElementType::CORNER) continue;
      double at[4][3];
      relative(x, e, nodes_of(row(e)), at);
      visit(at, nodes[e].data());
    }
  }

 private:
  double square_between(const double *row, int k, int m) const;
  /** Calls use(part, number of its nodes) for the element of a surface, or the two halves of a
   *  quadrangle. */
  template <class Use> void for_halves(const double *row, const Use &use) const
  {
    if (along != dim - 1 || bends(row)) return;
    const int nnode = rule_of(row).nnode;
    for (int part = 0; part < (nnode == 4 ? 2 : 1); part++) use(part, nnode < 3 ? nnode : 3);
  }
  double &extent_of(double *row) const { return row[2 + maxnode]; }
  double *bent_of(const double *row) const { return const_cast<double *>(row) + 3 + maxnode; }
  BentTriangle bent_triangle(const double *row) const;
  void relative(const double *const *x, std::size_t e, int nnode, double (*at)[3]) const
  {
    for (int m = 0; m < nnode; m++)
      for (int d = 0; d < 3; d++) at[m][d] = x[nodes[e][m]][d] - x[nodes[e][0]][d];
  }
};

}    // namespace MPM_NS
#endif
