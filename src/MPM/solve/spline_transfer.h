/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_SPLINE_TRANSFER_H
#define MPM_SOLVE_SPLINE_TRANSFER_H

#include "solve/block_rows.h"
#include "solve/lattice_nodes.h"
#include "solve/lattice_ranks.h"
#include "solve/node_constraints.h"

#include <vector>

namespace MPM_NS {

/** The transfer between the nodes of a rank and the first coarse level. Each rank has its part of
 *  that level, the nodes that its own nodes are functions of, and all ranks have complete vectors of
 *  the level. */
class SplineTransfer {
 public:
  SplineTransfer(const NodeConstraints &nodes, LatticeRanks &ranks, int order) :
      nodes(nodes), ranks(ranks), order(order)
  {
  }
  /** Finds the functions of the level that the nodes have a part in. to_itself: the level has the
   *  nodes themselves. */
  void setup(bool to_itself);

  bool whole = false;              ///< the level has the nodes themselves
  int period[3] = {0, 0, 0};       ///< of the level, in nodes; 0: not periodic
  LatticeNodes mine;               ///< nodes of the part of this rank
  CoarseParts parts;               ///< of nodes without constraints in these
  ConstrainedParts constrained;    ///< of nodes with constraints
  std::vector<int> number;         ///< of the part of this rank in the level; -1: no stiffness

  /** Numbers the nodes of the level in the order of ranks. used: those of this rank that have a
   *  stiffness. rows: [ranks + 1], receives the first node of each rank. Collective. */
  LatticeNodes number_nodes(const std::vector<char> &used, std::vector<int> &rows);
  /** b = P^T (r - done), on all ranks. done: null: nothing. in_system: [node] it has a stiffness.
   *  Collective. */
  void restriction(const double *r, const double *done, const std::vector<char> &in_system,
                   std::vector<double> &b);
  /** z += P x */
  void prolongation(const std::vector<double> &x, const std::vector<char> &in_system,
                    double *z) const;
  double memory_usage() const
  {
    return parts.memory_usage() + constrained.memory_usage() + node_list_bytes(mine) +
        (number.capacity() + all_numbers.capacity()) * sizeof(int) +
        (partial.capacity() + gathered.capacity()) * sizeof(double);
  }

 private:
  const NodeConstraints &nodes;
  LatticeRanks &ranks;
  const int order;
  std::vector<int> all_numbers;    // nodes of the level that ranks have a part of, rank by rank
  std::vector<double> partial, gathered;
};

}    // namespace MPM_NS
#endif
