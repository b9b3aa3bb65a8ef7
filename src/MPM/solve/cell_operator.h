/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_CELL_OPERATOR_H
#define MPM_SOLVE_CELL_OPERATOR_H

#include "solve/cell_graph.h"
#include "solve/lattice_ranks.h"

namespace MPM_NS {

/** Poisson's equation for cells of a lattice, such as that of the pressure of an incompressible flow:
 *
 *    (A p)_i = sum over faces to cells j of face_ij (p_i - p_j) + outside_i p_i.
 *
 *  There is one unknown for each node of a Grid; node i of an axis may stand for the cell between nodes i and i + 1.  A face
 *  coefficient is, for example, the open share of the face times its area over density and spacing; 0 at walls.  outside is
 *  the sum of those of faces to places of known pressure (a free surface, with the distance to it
 *  instead of the spacing); this pressure itself goes to the right side.
 *
 *  Coefficients are what a rank adds to the sum over ranks and periodic images, like sums over points: who knows a face on several ranks, or
 *  on several images, gives it once, or the same everywhere and then calls share().  Coefficients are for nodes that a rank shares with
 *  others where these have them, too (Grid::Block::reached), not for others in its blocks.
 *
 *  A cell without any coefficient is not in the system: all vectors are 0 there.  Cells that faces join and that have nothing
 *  outside are a closed pool, where pressures are known but for a constant (CellMultigrid::project()). */
class CellOperator {
 public:
  const Grid &grid;
  LatticeRanks &ranks;
  std::vector<double> face;       ///< [node][dim] to the next node along each axis
  std::vector<double> outside;    ///< [node]

  CellOperator(const Grid &grid, LatticeRanks &ranks) : grid(grid), ranks(ranks) {}

  void clear();     ///< no coefficients, for the blocks that the grid has now
  void share();     ///< coefficients are alike on all ranks and images that have them.  Collective
  void finish();    ///< coefficients are there.  Collective

  /** y = A x, the same on all that have a node if x is.  Collective. */
  void apply(const double *x, double *y) const;
  /** z = r over the diagonal. */
  void scale(const double *r, double *z) const;
  /** After finish(): this rank's part. */
  const CellGraph &cells() const { return graph; }
  double memory_usage() const;

 private:
  CellGraph graph;
};

}    // namespace MPM_NS
#endif
