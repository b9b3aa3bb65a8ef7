/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_INTEGRATOR_H
#define LMP_MPM_INTEGRATOR_H

#include "error.h"
#include "lammps.h"
#include "update.h"
#include "utils.h"

#include <string>

namespace LAMMPS_NS {

/** Start of a run: stops unless it is one of run_style verlet. who: a fix that moves points. */
inline void check_integrator(LAMMPS *lmp, const std::string &who)
{
  if (utils::strmatch(lmp->update->integrate_style, "^respa"))
    lmp->error->all(FLERR, Error::NOLASTLINE, "{} requires run_style verlet", who);
  if (lmp->update->whichflag == 2)
    lmp->error->all(FLERR, Error::NOLASTLINE,
                    "{} cannot be used with minimize, which would move material points like atoms: "
                    "minimize before the fix is defined",
                    who);
}

/** Start of a step: stops if LAMMPS has not set the fix up, as it does not after the end of a run
 *  within another one. */
inline void check_set_up(LAMMPS *lmp, const std::string &who)
{
  if (lmp->update->whichflag != 1)
    lmp->error->all(FLERR, Error::NOLASTLINE,
                    "{} has not been set up for this step: a command run among the commands of "
                    "run every ends the run that it is part of, so use a loop of runs",
                    who);
}

}    // namespace LAMMPS_NS
#endif
