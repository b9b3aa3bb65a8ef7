/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_TIED_NODES_H
#define LMP_MPM_TIED_NODES_H

#include "solve/lattice_ranks.h"
#include "solve/spline_multigrid.h"

#include <vector>

namespace LAMMPS_NS {
class MPMConstraints;
class MPMSolvedNodes;

/** Finds groups of nodes that walls hold together, along lines through surfaces and faces
 *  (MPMLineTies), and the part of P within each group, from unit vectors of one node of each group
 *  at a time. Where lines of several surfaces chain many nodes together along edges, each node has
 *  the part of the nodes near it. The result has the nodes of this rank, in their order.
 *  Collective. */
std::vector<MPM_NS::SplineMultigrid::Tie> find_tied_nodes(MPMSolvedNodes &, MPMConstraints &,
                                                          MPM_NS::LatticeRanks &);

}    // namespace LAMMPS_NS
#endif
