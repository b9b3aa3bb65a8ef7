/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MESH_RANKS_H
#define LMP_MPM_MESH_RANKS_H

#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {

/** Distribution of the nodes of a mesh, which all ranks know, over ranks, and sums over ranks at
 *  shared nodes. */
class MPMMeshRanks : protected Pointers {
 public:
  std::vector<int> nodes;     ///< nodes of this rank, in ascending order
  std::vector<char> first;    ///< [node] is this the first rank that has it?

  explicit MPMMeshRanks(class LAMMPS *lmp) : Pointers(lmp) {}

  /** Finds the nodes and sharers. mine: [node] does this rank need the node? Collective. */
  void find(const std::vector<char> &mine);

  /** Sums rows of values, [node][width], over ranks; all ranks get the same bits. Nodes that no
   *  other rank shares are left alone. row: [node] index of the row of this node in values, -1:
   *  none; all ranks that have a node must agree on whether it has a row. null: all nodes. */
  void sum(double *values, int width, const int *row = nullptr);

  /** Replaces each part of a row (parts of this width) by the largest among ranks: the one with the
   *  greatest first value and, where first values are equal, the greatest next one. */
  void largest(double *values, int width, int parts, const int *row);

  double memory_usage() const;

 private:
  /** Another rank, and the nodes that both ranks have. */
  struct Neighbor {
    int rank;
    std::vector<int> nodes;
    std::vector<double> out, in;
  };
  std::vector<Neighbor> neighbors;
  std::vector<int> shared;    // nodes that another rank has, too
  std::vector<double> own;    // their values

  void exchange(const double *values, int width, const int *row);
};

}    // namespace LAMMPS_NS
#endif
