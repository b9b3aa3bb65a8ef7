/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_POINT_ACCELERATIONS_H
#define LMP_MPM_POINT_ACCELERATIONS_H

#include "base/mpm_rows.h"

#include <vector>

namespace LAMMPS_NS {
class MPMSolvedNodes;

/** Accelerations that points keep from step to step for the generalized alpha method and that of
 *  Hilber, Hughes, and Taylor, [n][dim]. The acceleration at the start of a step is that at the end
 *  of the step before, which balances forces of no single time. Points keep it, as they keep
 *  velocities: nodes get the mean by the masses of points, and points get the change of what nodes
 *  have. */
struct MPMPointAccelerations {
  MPMRows rows;
  bool known = false;    ///< were they found by an earlier step?

  /** Sets a [node][dim] to the mean of the points around. Collective. */
  void to_nodes(MPMSolvedNodes &, std::vector<double> &a) const;
  /** Adds the values of nodes at the points, which are where they were at the start of the step.
   *  Collective. */
  void add_from_nodes(MPMSolvedNodes &, std::vector<double> &change);
};

}    // namespace LAMMPS_NS
#endif
