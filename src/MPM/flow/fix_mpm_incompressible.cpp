/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/fix_mpm_incompressible.h"

#include "base/mpm_integrator.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "field/mpm_field.h"
#include "field/mpm_setup_checks.h"
#include "flow/mpm_flow_transfer.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "math_extra.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace LAMMPS_NS;

// entries of the vector with gas; entries about parts of steps, at its end
static constexpr int GAS_VALUES = 5, PART_VALUES = 2;

static void check_command(LAMMPS *lmp, int narg)
{
  require_arguments(lmp, "fix mpm/incompressible", narg, 3, {"h", "density"});
  if (!MPMPoints::get(lmp->atom))
    lmp->error->all(
        FLERR,
        "Fix mpm/incompressible requires material points: use atom_style mpm, or hybrid "
        "with mpm");
  if (!lmp->domain->box_exist)
    lmp->error->all(FLERR,
                    "Fix mpm/incompressible needs the simulation box: define it with create_box "
                    "before");
}

FixMPMIncompressible::FixMPMIncompressible(LAMMPS *lmp, int narg, char **arg) :
    FixMPMState(lmp, narg, arg)
{
  check_command(lmp, narg);
  const int dim = domain->dimension;
  MPMIncompressibleOptions options;
  auto declared = options.declare(dim);
  read_options(lmp, declared, narg, arg, 3);
  flow = std::make_unique<MPMFlow>(lmp, options, groupbit, id, gradient, half_kick);
  state.declare(half_kick, "mpm/incompressible:half_kick", dim);
  if (flow->has_gradients())
    state.declare(gradient, "mpm/incompressible:gradient", flow_slopes(dim));

  time_integrate = 1;
  dynamic_group_allow = 0;
  scalar_flag = vector_flag = 1;
  size_vector = 15 + 3 * flow->options.region_ids.size() +
      (flow->options.has_gas ? GAS_VALUES : 0) + PART_VALUES;
  global_freq = 1;
  extscalar = extvector = 0;
  restart_global = 1;
  keep_arrays();
}

/* ---------------------------------------------------------------------- */

void FixMPMIncompressible::init()
{
  check_integrator(lmp, "Fix mpm/incompressible");
  set_up.remember(lmp);
  if (domain->box_change_size || domain->box_change_shape)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/incompressible requires a box of constant size and shape: remove the fix "
               "that changes it");
  flow->init();
  time_integrate = seen_as_integrator(lmp, *this);
  force_reneighbor = neighbor->includegroup ? 1 : 0;
  next_reneighbor = -1;

  allow_no_ghosts(lmp, spacing());
  atom->sortfreq = 0;
}

void FixMPMIncompressible::setup_pre_neighbor()
{
  flow->checks.check_points();
  refuse_other_integrators(lmp, *this);
  flow->checks.check_others(*this);
  flow->checks.check_time_step();
  flow->parts.cells.sort(true);
  travel = 0.0;
}

/* ----------------------------------------------------------------------
   Called after exchange and borders. The order in which points are summed must not depend on an
   earlier order, so that a run that continues from a restart file sums in the same one.
------------------------------------------------------------------------- */

void FixMPMIncompressible::pre_neighbor()
{
  flow->parts.cells.sort();
  travel = 0.0;
}

/** LAMMPS has set to zero only the forces of atoms in the neighbor lists (neigh_modify include),
 *  see FixMPM::pre_force(). */
void FixMPMIncompressible::pre_force(int)
{
  if (!neighbor->includegroup) return;
  for (int i = atom->nfirst; i < atom->nlocal; i++)
    if (flow->parts.cells.is_point(i)) MathExtra::zero3(atom->f[i]);
}

/** With lists of grains alone, LAMMPS does not see how far points go, which must be less than a
 *  period. */
void FixMPMIncompressible::initial_integrate(int)
{
  set_up.check(lmp, "Fix mpm/incompressible");
  flow->checks.look();
  flow->step();
  travel += flow->largest_velocity() * update->dt;
  for (int d = 0; d < domain->dimension; d++)
    if (neighbor->includegroup && domain->periodicity[d] && travel > 0.25 * domain->prd[d])
      next_reneighbor = update->ntimestep;
}

void FixMPMIncompressible::post_run()
{
  if (MPMField::all(lmp).empty()) set_up.finish(lmp);
  flow->end_run();
}

void FixMPMIncompressible::check_density(double fluid, const std::string &who) const
{
  if (std::fabs(fluid / flow->options.density - 1.0) > MPMFlowLiquids::SAME_DENSITY)
    error->all(FLERR, Error::NOLASTLINE,
               "{}: the density of the fluid is {}, but that of fix {} (style {}) is {}", who,
               fluid, id, style, flow->options.density);
}

void FixMPMIncompressible::visit_batches(int group_bits, const BatchVisitor &visit)
{
  if (flow->parts.solids) flow->parts.solids->visit_batches(group_bits, visit);
}

double FixMPMIncompressible::spacing_around(const std::string &region) const
{
  return std::count(flow->options.region_ids.begin(), flow->options.region_ids.end(), region)
      ? flow->options.h
      : 0.0;
}

/* ----------------------------------------------------------------------
   scalar: number of iterations; vector: this number, what is left of the divergence (relative),
   largest |div v|, volume that points fill, number of wet cells, kinetic energy, largest speed,
   force on the six walls, iterations of the implicit viscosity, force on the regions, and energy
   that spreading has added; with gas: number of pockets that have some, highest and lowest
   pressure, volume, and energy; parts of the last step, and halvings so far
------------------------------------------------------------------------- */

double FixMPMIncompressible::compute_vector(int k)
{
  const auto &results = flow->results;
  double mine = 0.0, all;
  if (k == 0) return results.iterations;
  if (k == 1) return results.residual;
  if (k == 2 || k == 6) {
    if (k == 2) mine = results.divergence;
    for (int i = 0; k == 6 && i < atom->nlocal; i++)
      if (flow->parts.cells.is_point(i)) mine = std::max(mine, MathExtra::len3(atom->v[i]));
    MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_MAX, world);
    return all;
  }
  if (k == 3) mine = results.filled;
  if (k == 4) mine = results.wet;
  if (k == 5)
    for (int i = 0; i < atom->nlocal; i++)
      if (flow->parts.cells.is_point(i))
        mine += 0.5 * force->mvv2e * atom->rmass[i] * MathExtra::lensq3(atom->v[i]);
  if (k == 13) return results.viscous_iterations;
  const int first_of_parts = size_vector - PART_VALUES,
            first_of_gas = first_of_parts - (flow->options.has_gas ? GAS_VALUES : 0);
  if (k >= first_of_parts) return k == first_of_parts ? results.parts : results.halvings;
  if (k >= first_of_gas) return gas_value(k - first_of_gas);
  if (k == first_of_gas - 1)
    mine = flow->energy_of_spreading();
  else if (k > 13)
    mine = results.regions[k - 14];
  else if (k > 6)
    mine = results.walls[(k - 7) / 2][(k - 7) % 2];
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixMPMIncompressible::gas_value(int k) const
{
  const auto &gas = flow->parts.gas;
  if (k == 0) return gas->count();
  if (k == 1) return gas->highest();
  if (k == 2) return gas->lowest();
  return (k == 3 ? gas->volume() : gas->energy() / force->nktv2p);
}

void FixMPMIncompressible::write_restart(FILE *fp)
{
  const auto data = flow->restart_data();
  if (comm->me) return;
  write_state(fp, data.data(), data.size() * sizeof(double));
}
