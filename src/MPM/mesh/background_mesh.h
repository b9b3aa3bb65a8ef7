/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_BACKGROUND_MESH_H
#define MPM_MESH_BACKGROUND_MESH_H

// A mesh of linear elements as the grid under material points: which cell a point is in, and the shape
// functions there. Nothing here knows about LAMMPS.

#include "mesh/gmsh.h"

namespace MPM_NS {

/** Cells that share their nodes. Points are found by walking from cell to cell (V.P. Nguyen, A. de Vaucorbeil,
 *  S. Bordas, The Material Point Method, Springer 2023, section 5.4). */
class BackgroundMesh {
 public:
  struct Cell {
    ElementType type;
    int nnode, nface;
    int node[8];
    int neighbor[6];    ///< across each face, -1: none
    int64_t label;      ///< its number in the file
    double
        height;    ///< volume over the area of its largest face (of a simplex: times the dimension)
    double low[3], high[3];
    /** Of a square or cube, whose places are the sum of these times 1, xi, eta, zeta, xi eta, eta zeta, zeta xi, xi eta zeta. */
    double map[8][3];
    bool parallel;    ///< are sides that face each other parallel: is that map linear?
  };
  /** A side of a cell with no other cell behind it; nodes go around counterclockwise as seen from outside, in the
   *  plane with the mesh on the left. */
  struct Face {
    int cell, nnode;
    int node[4];
  };
  /** Where a point is. */
  struct Place {
    int cell = -1;     ///< -1: in none
    double outside;    ///< by which share of the width of the cell it is outside, 0 inside
    double N
        [8];    ///< shape functions of the nodes of the cell; of points outside those of a place at its rim
    double g[8][3];    ///< and their gradients [1/length]
  };

  int dim = 0;
  std::vector<std::array<double, 3>> nodes;
  std::vector<Cell> cells;

  /** The cells are the elements of dimension dim in a mesh, or those of a physical group or set. Throws
   *  std::runtime_error when there are none, when one is turned inside out or without volume, or when a face belongs to
   *  three cells. */
  BackgroundMesh(const Mesh &, int dim, const std::string &part);

  /** Finds the cell of a point by walking from the cell hint (-1: from none), and else by search; of several those that
   *  come first in the file. */
  void find(const double *x, int hint, Place &) const;

  /** Nodes of elements of a physical group or set of any dimension, in ascending order; throws
   *  std::runtime_error when there is no such group, or none of its nodes belongs to a cell. */
  std::vector<int> nodes_of(const std::string &group) const;

  /** Sides of cells that are the elements of a group; throws std::runtime_error as nodes_of(), and when one of its
   *  elements is not a side, or lies between two cells. */
  std::vector<Face> faces_of(const std::string &group) const;

  /** Normal with the length of its area, of a side whose nodes are at these positions; share[k]: the part of its area that belongs to its node k (the
   *  integral of its shape function). */
  void area(const Face &, const std::vector<std::array<double, 3>> &positions, double normal[3],
            double share[4]) const;

 private:
  Mesh rest;    // elements of lower dimension, with their groups; nodes as in the file
  std::vector<int> place_of;    // of nodes in the file among those of cells, -1: not one of these
  double low[3], size[3];       // of bins
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
