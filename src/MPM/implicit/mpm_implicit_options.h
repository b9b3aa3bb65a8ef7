/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_IMPLICIT_OPTIONS_H
#define LMP_MPM_IMPLICIT_OPTIONS_H

#include "declare/option.h"
#include "implicit/mpm_time_method.h"

#include <cstdint>

namespace LAMMPS_NS {

/** Time integration and solver options of fix mpm/implicit. */
struct MPMImplicitOptions {
  MPMTimeMethod time;
  double tolerance = 1.0e-8;         ///< tolerance of the ratio of forces
  double absolute = 0.0;             ///< sum of unbalanced forces that is accepted, too [force]
  int64_t most_iterations = 50;      ///< iterations of Newton's method in a step
  int64_t most_parts = 64;           ///< parts of a step that does not converge at once
  int64_t most_linear = 10000;       ///< iterations of the linear solver in each Newton iteration
  double least_accuracy = 1.0e-3;    ///< largest relative residual of linear solutions
  enum Preconditioner { BLOCKS, MULTIGRID };
  Preconditioner preconditioner = BLOCKS;
  /** Slip in a step above which friction is that of Coulomb [distance]; 0: a share of the node
   *  spacing. */
  double slip = 0.0;
  /** Stiffness of nodes that points barely reach, relative to the modulus. */
  double stabilize = 0.0;
  bool stabilize_is_given = false;
  /** Stabilize from the first step on that finds no balance otherwise. */
  bool stabilize_if_stuck = false;
  static constexpr double ENOUGH_TO_STABILIZE = 1.0;
  bool report = false;    ///< print residuals of each step to the log

  /** Declares the arguments and keywords of fix mpm/implicit. */
  MPM_NS::Options declare();
};

}    // namespace LAMMPS_NS
#endif
