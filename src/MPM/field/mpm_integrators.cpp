/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_integrators.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "fix.h"
#include "lammps.h"
#include "modify.h"

#include <algorithm>

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

bigint LAMMPS_NS::warn_of_forgotten_points(LAMMPS *lmp, const std::string &style,
                                           const std::string &lack)
{
  const Atom *atom = lmp->atom;
  int moved = 0;    // groups that something moves
  for (const auto *ifix : lmp->modify->get_fix_list())
    if (ifix->time_integrate || utils::strmatch(ifix->style, "^mpm$")) moved |= ifix->groupbit;
  bigint mine[2] = {0, 0}, all[2];    // points, those that do not move
  tagint example = 0, example_all;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->vfrac[i] > 0.0)) continue;
    mine[0]++;
    if (atom->mask[i] & moved) continue;
    mine[1]++;
    example = std::max(example, atom->tag[i]);
  }
  MPI_Allreduce(mine, all, 2, MPI_LMP_BIGINT, MPI_SUM, lmp->world);
  if (all[1] == 0) return all[0];
  MPI_Allreduce(&example, &example_all, 1, MPI_LMP_TAGINT, MPI_MAX, lmp->world);
  if (lmp->comm->me == 0)
    lmp->error->warning(
        FLERR,
        "{} material points belong to no fix {}, for instance point {}: they do not "
        "move and {}; if they shall, put them into the group of a fix {} with "
        "keyword group of create_points, or with the group command after it",
        all[1], style, example_all, lack, style);
  return all[0];
}
