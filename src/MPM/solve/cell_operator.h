/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_CELL_OPERATOR_H
#define MPM_SOLVE_CELL_OPERATOR_H

#include "solve/bytes_of.h"
#include "solve/lattice_ranks.h"

namespace MPM_NS {
/** Cells and the coefficients between them: the contribution of one rank to (A x)_i = sum_j face_ij
 *  (x_i - x_j) + outside_i x_i. */
struct CellGraph {
  std::vector<int> index;        ///< [cell][3] index on the lattice of the level, within the period
  std::vector<int64_t> where;    ///< [cell] its index in vectors
  std::vector<int> first;        ///< [cells + 1] ranges in neighbor and face
  std::vector<int64_t> neighbor;    ///< index in vectors of the cell behind a face
  std::vector<double> face;         ///< coefficient of a face, not negative
  std::vector<double> outside;      ///< [cell] coefficient to places where x is 0
  /** [cell] one over the diagonal, summed over ranks; 0 where the diagonal is 0 */
  std::vector<double> inverse;
  std::vector<int> colored[2];    ///< cells with an even, and with an odd sum of their index

  int size() const { return where.size(); }
  void color();    ///< makes the lists of colors
  /** Do neighbors always have different colors? For graphs in which the index of a cell in vectors
   *  is its number. */
  bool is_proper() const;

  /** This rank's part of (A x) at a cell. */
  double flow(int cell, const double *x) const
  {
    const double mine = x[where[cell]];
    double sum = outside[cell] * mine;
    for (int k = first[cell]; k < first[cell + 1]; k++) sum += face[k] * (mine - x[neighbor[k]]);
    return sum;
  }
  /** This rank's contribution to the diagonal of A at a cell. */
  double diagonal(int cell) const
  {
    double sum = outside[cell];
    for (int k = first[cell]; k < first[cell + 1]; k++) sum += face[k];
    return sum;
  }
  double memory_usage() const
  {
    return bytes_of(index, first, colored[0], colored[1], where, neighbor, face, outside, inverse);
  }
};
/** Poisson's equation for the cells of a lattice, such as the equation for the pressure of an
 *  incompressible flow:
 *
 *      (A p)_i = sum over faces to cells j of face_ij (p_i - p_j) + outside_i p_i.
 *
 *  There is one unknown for each node of a Grid; node i of an axis may stand for the cell between
 *  nodes i and i + 1. A face coefficient is, for example, the open share of the face times its area
 *  over density and spacing; it is 0 at walls. outside is the sum of the coefficients of faces to
 *  places of known pressure (a free surface, with the distance to it instead of the spacing); the
 *  known pressure itself goes to the right side.
 *
 *  The coefficients of a rank are contributions to a sum over ranks and periodic images, like sums
 *  over points. If several ranks or images know a face, either one of them gives its coefficient,
 *  or all give the same value and share() is called. Coefficients are set at nodes that a rank
 *  shares with others if these ranks have the nodes, too (Grid::Block::reached), and not at other
 *  nodes in its blocks.
 *
 *  A cell without any coefficient is not in the system: all vectors are 0 there. Cells that faces
 *  connect and that have no outside coefficients form a closed pool, in which pressures are
 *  determined up to a constant (CellMultigrid::project()). */
class CellOperator {
 public:
  const Grid &grid;
  LatticeRanks &ranks;
  std::vector<double> face;       ///< [node][dim] coefficient to the next node along each axis
  std::vector<double> outside;    ///< [node] sum of the coefficients to known pressures

  CellOperator(const Grid &grid, LatticeRanks &ranks) : grid(grid), ranks(ranks) {}

  void clear();    ///< clears the coefficients, for the present blocks of the grid
  /** For coefficients that are the same on all ranks and images that have them: divides each by
   *  their number, so that the sum is right. Collective. */
  void share();
  void finish();    ///< call when coefficients are complete. Collective

  /** y = A x. If x is the same on all ranks and images that have a node, so is y. Collective. */
  void apply(const double *x, double *y) const;
  /** z = r divided by the diagonal. */
  void scale(const double *r, double *z) const;
  /** The contribution of this rank to the operator; call after finish(). */
  const CellGraph &cells() const { return graph; }
  double memory_usage() const { return bytes_of(face, outside) + graph.memory_usage(); }

 private:
  CellGraph graph;
};

}    // namespace MPM_NS
#endif
