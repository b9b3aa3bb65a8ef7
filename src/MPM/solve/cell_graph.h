/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_CELL_GRAPH_H
#define MPM_SOLVE_CELL_GRAPH_H

#include <cstddef>
#include <cstdint>
#include <vector>

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
  double memory_usage() const;
};

}    // namespace MPM_NS
#endif
