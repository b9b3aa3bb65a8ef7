/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_BACKGROUND_MESH_H
#define MPM_MESH_BACKGROUND_MESH_H

// A mesh of linear elements as the grid under material points: which cell a point is in, and the
// shape functions there. Nothing here knows about LAMMPS.

#include "mesh/gmsh.h"

namespace MPM_NS {

/** Cells that share their nodes. Points are found by walking from cell to cell (V.P. Nguyen, A. de
 *  Vaucorbeil, S. Bordas, The Material Point Method, Springer 2023, section 5.4). */
class BackgroundMesh {
 public:
  struct Cell {
    ElementType type;
    int nnode, nface;
    int node[8];
    int neighbor[6];    ///< the cell across each face; -1: none
    int64_t label;      ///< its number in the mesh file
    /** Volume over the area of its largest face (of a simplex: times the dimension). */
    double height;
    std::array<double, 3> low, high;
    /** Of a square or cube: coefficients of the map from natural coordinates to positions, for the
     *  terms 1, xi, eta, zeta, xi eta, eta zeta, zeta xi, xi eta zeta. */
    double map[8][3];
    bool parallel;    ///< are opposite sides parallel, so that the map is linear?
  };
  /** A side of a cell with no other cell behind it. Seen from outside, its nodes go around
   *  counterclockwise; in the plane, the mesh is on their left. */
  struct Face {
    int cell, nnode;
    int node[4];
  };
  /** Location of a point in the mesh. */
  struct Place {
    int cell = -1;     ///< -1: in no cell
    double outside;    ///< distance outside of the cell as a share of its width, 0 inside
    /** Shape functions of the nodes of the cell. For a point outside, they are those of a place at
     *  the rim of the cell. */
    double N[8];
    double g[8][3];    ///< gradients of the shape functions [1/length]
  };

  int dim = 0;
  std::vector<std::array<double, 3>> nodes;
  std::vector<Cell> cells;

  /** Makes cells of the elements of dimension dim in a mesh, or only of those in the physical group
   *  or set part, unless it is empty. Throws std::runtime_error if there are none, if an element is
   *  inside out or has no volume, or if a face belongs to three cells. */
  BackgroundMesh(const Mesh &, int dim, const std::string &part);

  /** Finds the cell of a point by walking from the cell hint (-1: no hint), and by search if that
   *  fails. If several cells contain the point, the first one in the file is taken. */
  void find(const double *x, int hint, Place &) const;

  /** Nodes of the elements of a physical group or set of any dimension, in ascending order. Throws
   *  std::runtime_error if there is no such group, or if none of its nodes belongs to a cell. */
  std::vector<int> nodes_of(const std::string &group) const;

  /** Sides of cells that are the elements of a group. Throws std::runtime_error in the same cases
   *  as nodes_of(), and if an element of the group is not a side of a cell, or lies between two
   *  cells. */
  std::vector<Face> faces_of(const std::string &group) const;

  /** Area of a side whose nodes are at these positions. normal: normal vector whose length is the
   *  area. share[k]: the part of the area that belongs to node k of the side (the integral of its
   *  shape function). */
  void area(const Face &, const std::vector<std::array<double, 3>> &positions, double normal[3],
            double share[4]) const;

 private:
  Mesh rest;    // elements of lower dimension, with their groups; nodes as in the file
  std::vector<int> place_of;    // of nodes in the file among those of cells, -1: not one of these
  std::array<double, 3> low;    // of bins
  double size[3];
  int nbin[3];
  std::vector<int> first_in_bin, in_bin;

  void add_cells(const Mesh &, const std::string &part);
  void connect();
  void sort_into_bins();
  std::vector<const MeshElement *> elements_of(const std::string &group) const;
  double natural(const Cell &, const double *x, double *xi, int &across) const;
  void evaluate(const Cell &, const double *xi, Place &) const;
};

}    // namespace MPM_NS
#endif
