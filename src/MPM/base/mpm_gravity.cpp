/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "base/mpm_gravity.h"

#include "error.h"
#include "fix.h"
#include "modify.h"

#include <algorithm>

using namespace LAMMPS_NS;

MPMGravity::MPMGravity(LAMMPS *lmp, const std::string &user)
{
  for (auto *fix : lmp->modify->get_fix_by_style("^gravity")) {
    if (fix->igroup != 0)
      lmp->error->all(FLERR, Error::NOLASTLINE,
                      "{} takes the weight from fix gravity {}, which must be of group all", user,
                      fix->id);
    fixes.push_back(fix);
  }
}

void MPMGravity::find(double gravity[3]) const
{
  std::fill_n(gravity, 3, 0.0);
  for (auto *fix : fixes) {
    int dim;
    const auto *const g = (const double *) fix->extract("gvec", dim);
    for (int d = 0; d < 3; d++) gravity[d] += g[d];
  }
}
