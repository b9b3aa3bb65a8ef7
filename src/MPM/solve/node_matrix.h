/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_NODE_MATRIX_H
#define MPM_SOLVE_NODE_MATRIX_H

#include "lattice/grid.h"

#include <vector>

namespace MPM_NS {

/** The matrix A = sum over points of G K G^T between nodes of a grid, with one value each, for many
 *  products with the same points. It has the part of the points of one rank, in the rows of all
 *  nodes that these reach, periodic images included: products are to be summed over ranks and
 *  images as transfers to nodes are.
 *
 *  Gradients of a constant are zero, and so is the sum of each row. A product is therefore made of
 *  differences, y_i = sum_j A_ij (x_j - x_i): round-off is that of what flows between nodes, and
 *  not of the values themselves.
 *
 *  A row has the (2 reach + 1)^dim nodes around its node, whether or not they share points with it.
 *  There is no list of columns, and rows of a block are side by side, so that a product is a
 *  sequence of multiplications of vectors. */
class NodeMatrix {
 public:
  /** A matrix of zeros for the present blocks of the grid, whose neighbor tables must be there.
   *  reach: the largest difference of the indices of two nodes of a point along an axis, 1 to 3. */
  void begin(const Grid &, int reach);
  /** Adds a point that reaches n nodes, numbers in the grid. gradient: G [n][ngrad], with the sum
   *  zero over the nodes; stiffness: K [ngrad][ngrad], ngrad <= 3. Points with the same nodes are
   *  best added one after the other. */
  void add_point(int n, const int64_t *nodes, int ngrad, const double *gradient,
                 const double *stiffness);
  /** To be called after the last point. */
  void finish() { flush(); }
  /** y = A x, both [nnodes of the grid]. */
  void multiply(const double *x, double *y) const;
  double diagonal(int64_t node) const { return value[place(node, width / 2)]; }

  double memory_usage() const;

 private:
  const Grid *grid = nullptr;
  int dim = 0, reach = 0;
  int width = 0;    // entries of a row
  // [block][row of side nodes along the last axis][entry of a row][node along the last axis]
  std::vector<double> value;
  std::vector<char> used;    // [block][row of side nodes] does a point reach one of them?
  // a block with the nodes around it: where each of these is
  struct Source {
    int neighbor, node;    // index in Grid::Block::slot, number in that block
  };
  std::vector<Source> sources;
  // points with the same nodes: these, and their sum [n][n]
  std::vector<int64_t> current;
  std::vector<double> element, by_axis;

  std::size_t place(int64_t node, int entry) const
  {
    const int side = grid->side;
    return ((std::size_t)(node / side) * width + entry) * side + node % side;
  }
  void flush();
  template <int DIM, int REACH> void multiply_blocks(const double *x, double *y) const;
};

}    // namespace MPM_NS
#endif
