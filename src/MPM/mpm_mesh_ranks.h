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

/** Which nodes of a mesh, known to all ranks, are those of which ranks, and sums over these. */
class MPMMeshRanks : protected Pointers {
 public:
  std::vector<int> nodes;     ///< of this rank, in ascending order
  std::vector<char> first;    ///< [node] is this the first rank that has it?

  explicit MPMMeshRanks(class LAMMPS *lmp) : Pointers(lmp) {}

  /** mine: [node] does this rank need it? Collective. */
  void find(const std::vector<char> &mine);

  /** Sum rows of values, [node][width], over ranks; all ranks get the same bits. Nodes of other ranks are left alone.
   *  row: [node] the row of this node in values, -1: none, the same nodes on all ranks that have them; null: all nodes. */
  void sum(double *values, int width, const int *row = nullptr);

  /** Rows of parts of this width: each part is that of the rank whose is the greatest, by its first value, of those that are equal
   *  by the next. */
  void largest(double *values, int width, int parts, const int *row);

  double memory_usage() const;

 private:
  /** Another rank, and the nodes that both have. */
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
