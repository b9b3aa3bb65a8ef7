/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_SPREAD_H
#define LMP_MPM_FLOW_SPREAD_H

#include "mpm_flow_lattice.h"
#include "solve/krylov.h"

#include <vector>

namespace LAMMPS_NS {

/** Equations of cells that are well conditioned, of which the diagonal is all that a preconditioner needs:
 *
 *    diagonal_i x_i - sum over neighbors j of weight_ij x_j = right_side_i,
 *
 *  symmetric, with a diagonal that is greater than the sum of the weights. Neighbors of a cell with an even sum of indices have an odd one, so that every
 *  second unknown is known by those around it. Conjugate gradients for the other half, with a diagonal of one, take half as many
 *  iterations as those for all of them (J.K. Reid, SIAM J. Numer. Anal. 9 (1972) 325), and have one sum over ranks in each
 *  (A.T. Chronopoulos, C.W. Gear, J. Comput. Appl. Math. 25 (1989) 153).
 *
 *  Vectors have the cells with equations alone, and not all of the blocks; ranks get what is next to theirs, and nothing else. */
class MPMFlowSpread {
 public:
  MPMFlowSpread(class LAMMPS *lmp, const MPMFlowLattice &cells) : lmp(lmp), cells(cells) {}

  /** An equation of a cell that this rank owns. */
  struct Row {
    int number;              ///< of the cell
    const int *near;         ///< [2 dim] numbers of neighbors, -1: no unknown
    const double *weight;    ///< [2 dim]
    double right_side;
  };
  /** No equations; inverse_root: [cell] one over the root of the diagonal, of all cells, also of other ranks. */
  void begin(const double *inverse_root);
  void add(const Row &);
  /** x: [cell] the solution, in cells with equations. The residual is that of equations over the root of their diagonal.
   *  Collective. */
  MPM_NS::SolveReport solve(double *x, const MPM_NS::SolveGoal &);

  double memory_usage() const;

 private:
  enum { KEPT, KNOWN };    // unknowns of the solve, and those that are known by them
  struct Peer {
    int rank;
    std::vector<int> give[2];    // places in values
    int first[2], many[2];       // of what it gives
    std::vector<double> send;
  };
  struct Half {
    std::vector<int> row;    // in the order of add()
    int first = 0;           // place in values
    int inner = 0;           // the first so many have no neighbors on other ranks
    int size() const { return (int) row.size(); }
  };

  class LAMMPS *const lmp;
  const MPMFlowLattice &cells;
  int sides = 0;
  const double *inverse_root = nullptr;
  std::vector<int> number, near;       // [row], [row][sides]
  std::vector<double> weight, load;    // the same, of the scaled equations
  Half halves[2];
  std::vector<int> place_of;      // [cell] in values, -1: none
  std::vector<int> places;        // [place][sides] of neighbors
  std::vector<double> factors;    // [place][sides]
  std::vector<double> values, right_side, solution, direction, changes, product, sums;
  std::vector<Peer> peers;
  std::vector<MPI_Request> requests;
  std::vector<char> flags_out, flags_in;

  int half_of(const int index[3]) const;
  void arrange();
  void find_peers();
  void sum_neighbors(int half, double *sum);
  template <int width> void sum_some(int first, int last, double *sum) const;
};

}    // namespace LAMMPS_NS
#endif
