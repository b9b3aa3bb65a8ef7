/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "elements/element_nodes.h"

#include "atom.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "fix.h"
#include "group.h"
#include "modify.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

bool ElementNodes::has(int i) const
{
  return atom->mask[i] & fix.groupbit;
}

ElementNodes::IDs ElementNodes::count() const
{
  IDs mine = {0, MAXTAGINT, 0}, all;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!has(i)) continue;
    mine.n++;
    mine.low = std::min(mine.low, atom->tag[i]);
    mine.high = std::max(mine.high, atom->tag[i]);
  }
  MPI_Allreduce(&mine.n, &all.n, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  MPI_Allreduce(&mine.low, &all.low, 1, MPI_LMP_TAGINT, MPI_MIN, world);
  MPI_Allreduce(&mine.high, &all.high, 1, MPI_LMP_TAGINT, MPI_MAX, world);
  return all;
}

void ElementNodes::define(bigint nnode, std::vector<double> &x, std::vector<int> &local)
{
  ids = count();
  if (ids.n != nnode || (bigint) ids.high - ids.low + 1 != nnode)
    error->all(FLERR,
               "Fix mpm/elements {}: group {} has {} atoms with IDs from {} to {}, the mesh has "
               "{} nodes: its group must be the points that one create_points ... mesh made from "
               "the same mesh",
               fix.id, group->names[fix.igroup], ids.n, ids.n ? ids.low : 0, ids.high, nnode);
  std::vector<double> mine(3 * nnode, 0.0);
  x.resize(3 * nnode);
  local.assign(nnode, -1);
  for (int i = 0; i < atom->nlocal; i++) {
    if (!has(i)) continue;
    const tagint k = atom->tag[i] - ids.low;
    local[k] = i;
    std::copy_n(atom->x[i], 3, &mine[3 * k]);
  }
  MPI_Allreduce(mine.data(), x.data(), (int) (3 * nnode), MPI_DOUBLE, MPI_SUM, world);
}

FixMPMMaterial *ElementNodes::find_material() const
{
  const auto all = modify->get_fix_by_style("^mpm/material$");
  int mine = -1, index;
  for (int i = 0; i < atom->nlocal; i++)
    for (int k = 0; k < (int) all.size() && has(i); k++)
      if (atom->mask[i] & all[k]->groupbit) mine = k;
  MPI_Allreduce(&mine, &index, 1, MPI_INT, MPI_MAX, world);
  if (index < 0)
    error->all(FLERR,
               "Fix mpm/elements {}: the points of group {} have no material: define a fix "
               "mpm/material for them before",
               fix.id, group->names[fix.igroup]);
  bigint other = 0, others;
  for (int i = 0; i < atom->nlocal; i++) other += has(i) && !(atom->mask[i] & all[index]->groupbit);
  MPI_Allreduce(&other, &others, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (others)
    error->all(FLERR,
               "Fix mpm/elements {}: the points of group {} must have one material: use a "
               "fix mpm/elements and a mesh for each",
               fix.id, group->names[fix.igroup]);
  return dynamic_cast<FixMPMMaterial *>(all[index]);
}

void ElementNodes::check_volume(double of_elements) const
{
  double volume[2] = {of_elements, 0.0}, volumes[2];
  for (int i = 0; i < atom->nlocal; i++)
    if (has(i)) volume[1] += atom->vfrac[i];
  MPI_Allreduce(volume, volumes, 2, MPI_DOUBLE, MPI_SUM, world);
  if (!modify->nfix_restart_peratom && !(fabs(volumes[0] - volumes[1]) <= 1.0e-6 * volumes[0]))
    error->all(
        FLERR,
        "Fix mpm/elements {}: the elements have a volume of {:.8g}, their nodes of {:.8g}: "
        "points that create_points ... mesh made must not be deformed before, and thickness or "
        "section must be the same",
        fix.id, volumes[0], volumes[1]);
}

void ElementNodes::check() const
{
  const IDs now = count();
  if (now.n != ids.n || now.low != ids.low || now.high != ids.high)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/elements {}: group {} has {} atoms with IDs from {} to {}, but had {} from {} "
        "on: nodes of elements must not be added, deleted or renumbered; unfix it before",
        fix.id, group->names[fix.igroup], now.n, now.n ? now.low : 0, now.high, ids.n, ids.low);
  for (const auto *other : modify->get_fix_by_style("^mpm/elements$"))
    if (other != &fix && has_points_of(other->groupbit))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/elements {} and {} have points in common, which would feel the forces of "
                 "both: give them disjoint groups, or unfix one of them",
                 fix.id, other->id);
  for (const auto *field : MPMField::all(lmp)) {
    if (!has_points_of(field->fix.groupbit)) continue;
    const auto refuse = [&](bool broken, const std::string &what, const std::string &why) {
      if (broken)
        error->all(FLERR, "Fix mpm {} {} fix mpm/elements {}{}", field->id(), what, fix.id, why);
    };
    const auto &given = field->options;
    refuse(given.locking != MPMFieldOptions::NO_CURE, "locking is not for nodes of elements: use",
           " locking fbar");
    refuse(given.bad == MPMFieldOptions::DELETE || given.delete_failed,
           "bad delete and failed delete cannot be used with",
           ", whose nodes must not be deleted: give them a fix mpm of their own");
    refuse(given.axisymmetric, "axisymmetric cannot be used with",
           ", whose elements are of plane strain: use create_points elements with shape cpdi2");
    refuse(given.every > 1, "every cannot be used with",
           ", which strains elements in each step: use every 1");
  }
}

bool ElementNodes::has_points_of(int other_groupbit) const
{
  int mine = 0, any;
  for (int i = 0; i < atom->nlocal; i++) mine |= has(i) && (atom->mask[i] & other_groupbit);
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  return any != 0;
}

const char *ElementNodes::field() const
{
  for (const auto *field : MPMField::all(lmp))
    if (has_points_of(field->fix.groupbit)) return field->id();
  return nullptr;
}
