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

/** Cells, and what flows between them: the part that one rank has of (A x)_i = sum_j face_ij (x_i - x_j) + outside_i x_i. */
struct CellGraph {
  std::vector<int> index;        ///< [cell][3] place on the lattice of the level, within the period
  std::vector<int64_t> where;    ///< [cell] its place in vectors
  std::vector<int> first;        ///< [cells + 1] range in these two:
  std::vector<int64_t> neighbor;    ///< place in vectors of the cell behind a face
  std::vector<double> face;         ///< its coefficient, not negative
  std::vector<double> outside;      ///< [cell] coefficient to what is 0
  std::vector<double> inverse;      ///< [cell] one over the diagonal of all ranks, 0 where that is
  std::vector<int> colored[2];      ///< cells with an even, and with an odd sum of their index

  int size() const { return where.size(); }
  void color();    ///< make the lists of colors
  /** Have neighbors different colors? For graphs whose places in vectors are their cells. */
  bool is_proper() const;

  /** This rank's part of (A x) at a cell. */
  double flow(int cell, const double *x) const
  {
    const double mine = x[where[cell]];
    double sum = outside[cell] * mine;
    for (int k = first[cell]; k < first[cell + 1]; k++) sum += face[k] * (mine - x[neighbor[k]]);
    return sum;
  }
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
