/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "output/compute_mpm_fragment.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_interfaces.h"
#include "fracture/fix_mpm_fracture.h"
#include "memory.h"
#include "update.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

Options MPMFragmentOptions::declare()
{
  using namespace option;
  Options o("compute mpm/fragment");
  o.add("separable",
        {number(separable, "D", {0.0, 1.0, false, true}, "",
                "damage from which on a point is of no piece, and separates others")});
  return o;
}

/** compute ID group mpm/fragment keyword value */
ComputeMPMFragment::ComputeMPMFragment(LAMMPS *lmp, int narg, char **arg) :
    Compute(lmp, narg, arg), pieces(lmp)
{
  if (!MPMPoints::get(atom))
    error->all(FLERR, 2, "Compute mpm/fragment requires material points: use atom_style mpm");
  Options declared = declare();
  read_options(lmp, declared, narg, arg, 3);
  scalar_flag = peratom_flag = 1;
  extscalar = 0;
  size_peratom_cols = 0;
}

ComputeMPMFragment::~ComputeMPMFragment()
{
  memory->destroy(vector_atom);
}

void ComputeMPMFragment::init()
{
  if (MPMField::all(lmp).empty())
    error->all(FLERR, Error::NOLASTLINE,
               "Compute mpm/fragment {} looks at points of fix mpm, and there is none: define one",
               id);
}

void ComputeMPMFragment::compute_peratom()
{
  invoked_peratom = update->ntimestep;
  if (atom->nmax > nmax) {
    nmax = atom->nmax;
    memory->destroy(vector_atom);
    memory->create(vector_atom, nmax, "mpm/fragment:piece");
  }
  std::fill_n(vector_atom, atom->nlocal, 0.0);

  // fixes may come and go between runs
  const auto fractures = find_fixes<FixMPMFracture>(lmp);
  const auto refined = find_fixes<MPMRefinedBody>(lmp);
  std::vector<MPMField *> left = MPMField::all(lmp), body;
  while (!left.empty()) {
    const auto *const first = left.front();
    const auto is_apart = [&](const MPMField *field) {
      return field != first && std::none_of(refined.begin(), refined.end(), [&](const auto *one) {
               return one->has(first->id()) && one->has(field->id());
             });
    };
    const auto end = std::stable_partition(left.begin(), left.end(), is_apart);
    body.assign(end, left.end());
    left.erase(end, left.end());
    std::stable_sort(body.begin(), body.end(), [](const auto *a, const auto *b) {
      return a->lattice.h > b->lattice.h;
    });
    pieces.find(body, fractures.empty() ? nullptr : fractures.front(), groupbit, separable,
                vector_atom);
  }
}

/** Each piece has one point with its ID. */
double ComputeMPMFragment::compute_scalar()
{
  if (invoked_peratom != update->ntimestep) compute_peratom();
  invoked_scalar = update->ntimestep;
  bigint mine = 0, all;
  for (int i = 0; i < atom->nlocal; i++) mine += vector_atom[i] == (double) atom->tag[i];
  MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  scalar = (double) all;
  return scalar;
}

double ComputeMPMFragment::memory_usage()
{
  return nmax * sizeof(double) + pieces.memory_usage();
}
