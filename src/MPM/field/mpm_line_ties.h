/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_LINE_TIES_H
#define LMP_MPM_LINE_TIES_H

#include <cstdint>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Interface of a node action that is a projection, or converges to one: lists the nodes that it
 *  ties together. */
class MPMLineTies {
 public:
  /** Adds groups of nodes of a field to two lists. Each group is the number of its nodes followed
   *  by the nodes, with -1 for none. others: groups for which the projection node by node serves as
   *  well, unless they share nodes with ties. */
  virtual void list_ties(const MPMField &, std::vector<int64_t> &ties,
                         std::vector<int64_t> &others) const = 0;

 protected:
  ~MPMLineTies() = default;
};

}    // namespace LAMMPS_NS
#endif
