/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Conduction in one of several steps of the motion: keyword every.

   With auto, conduction waits for another step while there are at most MOST_STEPS, and the time t
   since the last conduction satisfies, with what was known at that time,

     t <= SHARE t_1                    with the explicit limit t_1 of conduction within bodies
     t |v| <= WAY h                    for all points: bodies move and strain little on the lattice
     t |dT/dt| <= LUMP (Tmax - Tmin)   for all points, dT/dt by the last conduction: temperatures,
                                       and with them thermal stresses, do not change in large lumps

   The first condition makes the error of Euler's method in time smaller than that of the lattice in
   space. For a wave number k, Euler's method is too fast by the share t k^2 K/(2 rho c) < SHARE h^2
   k^2/6 of the rate, and the lattice is too slow by about h^2 k^2/12. Where exchange through a
   surface or a contact is faster than conduction across a cell, it follows with the rate of
   conduction, as in long steps (MPMHeatFaces::limit()).

   A step of several explicit limits is made in parts that double
   (MPMSuperStep::advance_in_parts()). Without these a body whose surface is suddenly at another
   temperature takes only half of the fast changes in each step: the peak of the stress wave of a
   heated half space was 0.83 of the exact one, not 0.88, with steps of 150 limits. What points and
   nodes make of each other in each step is a fast change, too, and half of it would be left in a
   steady state.

   Conduction is in each step if something varies from step to step, such as variables and regions
   that move, if anything is implicit, or if others give heat in each step.

   Sums of ranks differ by round-off, which must not change the number of steps: NEARLY is the
   tolerance for times that are equal in exact arithmetic.

   Heat that friction gives to nodes in a step without conduction goes to points at once, because
   nodes do not outlive the step:

     Q_p = sum_i Q_i m_p N_ip/m_i,

   of which the sum over points is sum_i Q_i. With one capacity for each mass this is the change of
   the temperature of nodes, Q_i/C_i, at the point, as after conduction. Only points next to nodes
   that got heat are visited.
------------------------------------------------------------------------- */

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_passes.h"
#include "field/mpm_stencil.h"
#include "heat/mpm_conduction.h"
#include "heat/mpm_heat_flow.h"
#include "implicit/fix_mpm_implicit.h"
#include "region.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double MOST_STEPS = 10.0;
static constexpr double SHARE = 0.3;
static constexpr double WAY = 0.1;
static constexpr double LUMP = 0.02;
static constexpr double NEARLY = 1.0 + 1.0e-6;
// differences that are below this share of the greatest temperature count as none
static constexpr double ROUND_OFF = 1.0e-9;
static constexpr double BIG = std::numeric_limits<double>::max();

bool MPMHeatFlow::wait()
{
  const double dt = fields[0]->field.step_dt();
  waited.steps++;
  waited.time += dt;
  if (options.every == MPMHeatOptions::AUTO
          ? waited.steps >= MOST_STEPS || waited.time + dt > waited.longest * NEARLY
          : waited.steps >= options.every)
    return false;
  for (auto &field : fields) {
    if (!has_friction || !field->conducts_in_part()) continue;
    if (options.every == MPMHeatOptions::AUTO) return false;
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/heat {} every {}: heat of friction needs that all materials of fix mpm "
               "{} conduct: use every 1",
               id, options.every, field->field.id());
  }
  for (auto &field : fields)
    if (has_friction && field->conducts()) totals.got += field->keep_given();
  return true;
}

/** For the start of a run with every auto: is there anything for which conduction cannot wait? */
bool MPMHeatFlow::needs_each_step() const
{
  const bool moves =
      std::any_of(options.surfaces.begin(), options.surfaces.end(), [this](const auto &s) {
        auto *const region = s.region.empty() ? nullptr : domain->get_region_by_id(s.region);
        return region && region->dynamic_check();
      });
  const bool friction_on_levels = has_friction && !refined.empty();
  return options.grains || options.penalty || solver || moves || options.has_variables() ||
      friction_on_levels || !find_fixes<FixMPMImplicit>(lmp).empty();
}

/** Called after a conduction: time for which the next one may wait. 0: it must be in the next step.
 *  Collective. */
double MPMHeatFlow::longest_wait() const
{
  if (each_step) return 0.0;
  double rate = 0.0, h = BIG;
  for (const auto &of : fields) {
    if (!of->conducts()) continue;
    rate = std::max(rate, of->bound_of_rates());
    h = std::min(h, of->field.lattice.h);
  }
  const double longest = SHARE * MPMSuperStep::explicit_limit(rate),
               shortest = 2.0 * fields[0]->field.step_dt();
  if (rate == 0.0 || longest * NEARLY < shortest) return 0.0;

  MPMConduction::Motion mine, all;
  for (const auto &of : fields)
    if (of->conducts()) of->add_motion(mine);
  MPI_Allreduce(&mine, &all, sizeof(mine) / sizeof(double), MPI_DOUBLE, MPI_MAX, world);
  double t = longest;
  if (all.speed > 0.0) t = std::min(t, WAY * h / all.speed);
  const double range = all.highest + all.less;
  if (range > ROUND_OFF * std::max(fabs(all.highest), fabs(all.less)) && all.change > 0.0)
    t = std::min(t, LUMP * range / all.change * dt_last);
  return t;
}

/** One explicit step of all temperatures. */
void MPMHeatFlow::advance(int stages)
{
  const auto rates = [this]() {
    find_rates();
  };
  find_rates();
  for (auto &field : fields)
    if (field->conducts()) field->expect_rates(stages > 1 ? 2 * stages : 1);
  if (stages > 1)
    steps.advance_in_parts(dt_last, limit, rates);
  else
    steps.advance(1, dt_last, rates, true);
}

double MPMConduction::keep_given()
{
  static constexpr int MASS = 3;    // of a node, in its record
  Grid &grid = field.grid;
  given.resize(grid.nnodes(), 0.0);
  for (std::size_t k = 0; k < given.size(); k++)
    if (given[k] != 0.0) given[k] /= grid.nodes()[grid.nreal * k + MASS];
  field.nodes.complete(given.data(), 1, 1);
  warmed.assign(grid.blocks.size(), 0);
  for (std::size_t k = 0; k < given.size(); k++)
    if (given[k] != 0.0) warmed[k / NODES_PER_BLOCK] = 1;

  const MPMStencil stencil(field);
  Conduction buffer;
  double got = 0.0;
  each_point_batch(field, [&](const auto &run, int first, int n) {
    const auto &block = grid.blocks[run.slot];
    const Thermal *const t = thermal(run.material);
    if (!t || std::none_of(std::begin(block.slot), std::end(block.slot), [&](int slot) {
          return slot >= 0 && warmed[slot];
        }))
      return;
    for (int i = first; i < first + n; i++) {
      double heat = 0.0;
      stencil.visit(block, i, [&](const MPMStencil::Node &node) {
        heat += node.weight * given[node.number];
      });
      if (heat == 0.0) continue;
      got += atom->rmass[i] * heat;
      double *const history = t->fix->history[i];
      const Conduction &c = t->at(i, buffer);
      if (c.by_enthalpy) {
        t->fix->material->warm(history, heat);
      } else {
        history[t->temperature] += heat / c.capacity;
        if (t->molten >= 0) c.melting.settle(history[t->temperature], history[t->molten]);
      }
    }
  });
  given.clear();
  return got;
}

void MPMConduction::add_motion(Motion &motion) const
{
  double square = 0.0, high = motion.highest, less = motion.less;
  each_point_batch(field, [&](const auto &run, int first, int n) {
    const Thermal *const t = thermal(run.material);
    if (!t) return;
    const double *const v = atom->v[first], *const history = t->fix->history[first];
    const int width = t->fix->nhistory;
    for (int p = 0; p < n; p++) {
      const double *const w = v + 3 * p, T = history[width * p + t->temperature];
      square = std::max(square, w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
      high = std::max(high, T);
      less = std::max(less, -T);
    }
  });
  motion.speed = std::max(motion.speed, sqrt(square));
  motion.change = std::max(motion.change, change);
  motion.highest = high;
  motion.less = less;
}
