/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_DASHPOT_OPTIONS_H
#define LMP_MPM_DASHPOT_OPTIONS_H

#include "declare/option.h"

#include <string>

namespace LAMMPS_NS {

/** Keywords of fix mpm/dashpot. */
struct MPMDashpotOptions {
  enum Surface { REGION };

  Surface surface = REGION;
  std::string region;
  double speed_p = 0.0, speed_s = 0.0;
  double density = 0.0;    ///< 0: density of the points
  MPM_NS::NumberOrVariable incoming[3];
  bool has_incoming = false, support = true;
  double relax = 0.0, spacing = 0.0, area = 0.0;    ///< 0: not given
  std::string column;    ///< ID of the fix mpm/column with the motion of the far side; empty: none

  MPM_NS::Options declare(int dimension);
};

}    // namespace LAMMPS_NS
#endif
