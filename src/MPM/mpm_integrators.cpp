/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_integrators.h"

#include "atom.h"
#include "error.h"
#include "fix.h"
#include "lammps.h"
#include "modify.h"

using namespace LAMMPS_NS;

void LAMMPS_NS::refuse_other_integrators(LAMMPS *lmp, const Fix &mine)
{
  const Atom *atom = lmp->atom;
  for (const auto *other : lmp->modify->get_fix_list()) {
    if (other == &mine || !(other->time_integrate || utils::strmatch(other->style, "^mpm$")))
      continue;
    bigint n = 0, all;
    for (int i = 0; i < atom->nlocal; i++)
      if (atom->vfrac[i] > 0.0 && (atom->mask[i] & mine.groupbit) &&
          (atom->mask[i] & other->groupbit))
        n++;
    MPI_Allreduce(&n, &all, 1, MPI_LMP_BIGINT, MPI_SUM, lmp->world);
    if (all)
      lmp->error->all(
          FLERR, Error::NOLASTLINE,
          "{} material points of fix {} (style {}) are also integrated by fix {} (style {}): "
          "give the fixes disjoint groups",
          all, mine.id, mine.style, other->id, other->style);
  }
}
