/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Keyword lists of fix mpm/surface: the settings of neighbor lists and communication that a run with grains needs
// to be fast. They are LAMMPS's own commands, which the log shows.

#include "grains/fix_mpm_surface.h"

#include "atom.h"
#include "error.h"
#include "force.h"
#include "group.h"
#include "input.h"
#include "modify.h"
#include "neighbor.h"

#include <vector>

using namespace LAMMPS_NS;

/* ---------------------------------------------------------------------- */

void FixMPMSurface::set_lists(int iarg)
{
  if (group->find(grains_id) < 0)
    error->all(FLERR, iarg, "Fix mpm/surface {} lists: group {} does not exist", id, grains_id);
  if (force->pair_match("mpm/penalty", 0))
    error->all(FLERR, iarg,
               "Fix mpm/surface {} lists leaves out pairs of points, which pair style mpm/penalty "
               "needs: give neighbor, neigh_modify and comm_modify instead",
               id);
  for (auto *other : modify->get_fix_by_style("^mpm/surface$")) {
    const auto *surface = dynamic_cast<FixMPMSurface *>(other);
    if (surface && surface != this && !surface->grains_id.empty())
      error->all(FLERR, iarg,
                 "Fix mpm/surface {} lists: fix {} has set the lists; use one fix mpm/surface for "
                 "the points of both",
                 id, surface->id);
  }
  if (group_id.empty()) group_id = id;

  const auto command = [this](const std::string &text) {
    input->one(text);
  };
  command(fmt::format("neighbor {:.17g} multi", neighbor->skin));
  command("comm_modify vel yes mode multi");
  const std::vector<int> types = types_of_points(iarg);
  for (const int a : types)
    for (const int b : types)
      if (a <= b) command(fmt::format("neigh_modify exclude type {} {}", a, b));
  command(fmt::format("group {} union {} {}", group_id, grains_id, group->names[igroup]));
  command(fmt::format("atom_modify first {}", group_id));
  command(fmt::format("neigh_modify include {}", group_id));
  command(fmt::format("comm_modify group {}", group_id));
}

/* ----------------------------------------------------------------------
   types of the points of this fix, which grains must not have
------------------------------------------------------------------------- */

std::vector<int> FixMPMSurface::types_of_points(int iarg) const
{
  const int ntypes = atom->ntypes;
  std::vector<int> mine(2 * (ntypes + 1), 0), all(mine.size()), types;
  for (int i = 0; i < atom->nlocal; i++)
    if (has_radius(i))
      mine[2 * atom->type[i]] = 1;
    else if (atom->vfrac[i] == 0.0)
      mine[2 * atom->type[i] + 1] = 1;
  MPI_Allreduce(mine.data(), all.data(), (int) mine.size(), MPI_INT, MPI_MAX, world);
  for (int t = 1; t <= ntypes; t++) {
    if (!all[2 * t]) continue;
    if (all[2 * t + 1])
      error->all(FLERR, iarg,
                 "Fix mpm/surface {} lists: material points and other atoms have the type {}: give "
                 "them different ones",
                 id, t);
    types.push_back(t);
  }
  return types;
}
