/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_liquids.h"

#include "flow/mpm_flow_options.h"

#include "error.h"
#include "force.h"
#include "group.h"

#include <algorithm>

using namespace LAMMPS_NS;

MPMFlowLiquids::MPMFlowLiquids(LAMMPS *lmp, const MPMIncompressibleOptions &options) :
    Pointers(lmp), largest_viscosity(options.largest_viscosity()), least_density(options.density),
    has_several_densities(!options.liquids.empty()), options(options)
{
  for (const auto &one : options.liquids) least_density = std::min(least_density, one.density);
}

void MPMFlowLiquids::find_groups()
{
  for (const auto &one : options.liquids) {
    const int igroup = group->find(one.group);
    if (igroup < 0)
      error->all(FLERR, "Fix mpm/incompressible liquid: group {} does not exist", one.group);
    bits.push_back(group->bitmask[igroup]);
  }
}

double MPMFlowLiquids::density(int mask) const
{
  double density = options.density;
  for (std::size_t k = 0; k < bits.size(); k++)
    if (mask & bits[k]) density = options.liquids[k].density;
  return density;
}

double MPMFlowLiquids::acceleration_per_stress() const
{
  return force->ftm2v / (force->nktv2p * options.density);
}

double MPMFlowLiquids::largest_kinematic_viscosity() const
{
  if (!options.has_several_viscosities())
    return largest_viscosity * acceleration_per_stress() * options.density / least_density;
  double most = options.viscosity / options.density;
  for (const auto &one : options.liquids)
    most = std::max(most, options.viscosity_of(one) / one.density);
  return most * options.density * acceleration_per_stress();
}
