/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   The kinetic energy of a node changes in a step by all impulses on it times the mean of its old and its new
   velocity. The part of a tangential impulse J_t between bodies of relative velocity u is J_t . (u_old + u_new)/2,
   and what slides loses that as heat, exactly. With the velocities just before and after the impulse
   it would be more: before it, the shear stress has accelerated the node, by tau dt/(rho h), which is not small against
   the sliding velocity in stiff bodies, and which friction takes back in each step. Where bodies stick there
   is no heat: what is lost there is numerical, and of the order of the step.
------------------------------------------------------------------------- */

#include "mpm_friction_heat.h"

#include "atom.h"
#include "error.h"
#include "fix.h"
#include "fix_mpm_heat.h"
#include "force.h"
#include "modify.h"
#include "mpm_conduction.h"
#include "mpm_field.h"
#include "mpm_passes.h"
#include "mpm_points.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ---------------------------------------------------------------------- */

void MPMFrictionHeatOptions::declare(Options &o, const char *yes, const char *first)
{
  using namespace option;
  o.add("heat",
        {word(kind,
              {{"no", NO, "what friction takes is lost"},
               {"yes", YES, yes},
               {"share", SHARE, "", {number(share, "S", FRACTION, "1", first)}}})},
        "heat of friction for :doc:`fix mpm/heat <fix_mpm_heat>`");
}

MPMFrictionHeat::MPMFrictionHeat(LAMMPS *lmp, const MPMFrictionHeatOptions &options) :
    Pointers(lmp), options(options)
{
}

/* ---------------------------------------------------------------------- */

void MPMFrictionHeat::begin_run(const Fix &user, const std::vector<MPMField *> &fields, bool shared)
{
  const auto heats = modify->get_fix_by_style("^mpm/heat$");
  if (heats.empty())
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix {} {} heat: nothing conducts the heat of friction: define a fix mpm/heat, or drop "
        "the keyword",
        user.style, user.id);
  heat = dynamic_cast<FixMPMHeat *>(heats[0]);
  bodies.clear();
  bool any = false, points = false;
  for (auto *field : fields) {
    Body body = {field, nullptr, false, 0.0, {}};
    std::vector<int> mine(field->materials.size(), 0), here(mine.size());    // of its points
    for (int i = 0; i < atom->nlocal; i++)
      for (std::size_t k = 0; k < mine.size(); k++)
        if (field->is_point(i) && (atom->mask[i] & field->materials[k]->groupbit)) mine[k] = 1;
    MPI_Allreduce(mine.data(), here.data(), (int) here.size(), MPI_INT, MPI_MAX, world);
    int nhere = 0, nconducting = 0;
    for (std::size_t k = 0; k < here.size(); k++) {
      if (!here[k]) continue;
      nhere++;
      points = true;
      const auto &material = *field->materials[k]->material;
      if (!material.conducts()) continue;
      const Conduction c = material.conduction(nullptr);
      if (c.orthotropic && shared && options.kind == MPMFrictionHeatOptions::YES)
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix {} {} heat yes: bodies share the heat by their conductivities, but that of "
                   "fix mpm/material {} is orthotropic: tell the share by 'heat share S'",
                   user.style, user.id, field->materials[k]->id);
      nconducting++;
      body.mixed = body.mixed || material.conduction_varies();
      body.effusivity = std::sqrt(c.conductivity * material.density() * c.capacity);
    }
    body.mixed = nconducting > 0 && (body.mixed || nhere > 1);
    any = any || nconducting > 0;
    field->keep_old = true;
    bodies.push_back(body);
  }
  if (points && !any)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix {} {} heat: no material of its bodies conducts heat: give a fix mpm/material the "
        "part 'thermal conducting', or drop the keyword",
        user.style, user.id);
}

void MPMFrictionHeat::begin_step()
{
  for (auto &body : bodies) {
    auto &conduction = heat->of(*body.field);
    body.conduction = conduction.conducts() ? &conduction : nullptr;
    if (body.mixed) map_effusivity(body);
  }
}

/** Means over points, weighted with their volumes; points that do not conduct count as 0. */
void MPMFrictionHeat::map_effusivity(Body &body)
{
  MPMField &field = *body.field;
  const auto &pic = field.pic;
  const std::size_t nmax = atom->nmax;
  values.resize(3 * nmax);
  weights.resize(nmax);
  const PointRows r = field.rows_at_rest(values.data(), weights.data());
  const TransferStep still = field.step_data(0.0);
  auto &nodes = field.work.nodes;
  points_to(nodes, field, pic, [&](const MPMPointMap::Run &run, const int *base, int *box) {
    for (int i = run.first; i < run.last; i++) {
      weights[i] = atom->vfrac[i] * field.points->jacobian(i);
      values[3 * (std::size_t) i] = 0.0;
      if (!run.material || !run.material->material->conducts()) continue;
      const Conduction c = run.material->material->conduction(run.material->history[i]);
      values[3 * (std::size_t) i] =
          std::sqrt(c.conductivity * atom->rmass[i] / weights[i] * c.capacity);
    }
    pic.p2g_momentum(r, still, run.first, run.last, base, field.map->tile, box);
  });
  field.nodes.sum(nodes.data(), pic.nreal, 0, 4);
  body.at_node.resize(field.grid.nnodes());
  const double *node = nodes.data();
  for (double &e : body.at_node) {
    e = node[3] > 0.0 ? node[0] / node[3] : 0.0;
    node += pic.nreal;
  }
}

/* ---------------------------------------------------------------------- */

double MPMFrictionHeat::effusivity(const Body &body, const double *record) const
{
  const Grid &grid = body.field->grid;
  return body.mixed ? body.at_node[(record - body.field->grid.nodes()) / grid.nreal]
                    : body.effusivity;
}

double MPMFrictionHeat::made(const double *J, const double *old, const double *now, int dim) const
{
  double work = 0.0;
  for (int d = 0; d < dim; d++) work += 0.5 * J[d] * (old[d] + now[d]);
  return -work * force->mvv2e;
}

void MPMFrictionHeat::give(Body &body, const double *record, double energy, bool owned)
{
  // among points of several materials a node may have none that conducts
  if (!body.conduction || energy == 0.0 || effusivity(body, record) == 0.0) return;
  auto &given = body.conduction->given;
  Grid &grid = body.field->grid;
  if (given.empty()) given.resize(grid.nnodes(), 0.0);
  given[(record - grid.nodes()) / grid.nreal] += energy;
  if (owned) heat->book(FixMPMHeat::FRICTION, energy);
}

void MPMFrictionHeat::between(int a, const double *ra, int b, const double *rb, double energy,
                              bool owned)
{
  double share = options.share;
  if (options.kind == MPMFrictionHeatOptions::YES) {
    const double ea = effusivity(bodies[a], ra), eb = effusivity(bodies[b], rb);
    share = ea + eb > 0.0 ? ea / (ea + eb) : 0.0;
  }
  give(bodies[a], ra, share * energy, owned);
  give(bodies[b], rb, (1.0 - share) * energy, owned);
}

void MPMFrictionHeat::at_wall(int field, const double *record, double energy, bool owned)
{
  give(bodies[field], record, options.share * energy, owned);
}

double MPMFrictionHeat::memory_usage() const
{
  double bytes = (values.capacity() + weights.capacity()) * sizeof(double);
  for (const auto &body : bodies) bytes += body.at_node.capacity() * sizeof(double);
  return bytes;
}
