/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/fix_mpm_implicit.h"

#include "base/mpm_options.h"
#include "elements/fix_mpm_elements.h"
#include "field/mpm_affine.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_frame.h"
#include "field/mpm_ledger.h"
#include "field/mpm_strain.h"
#include "field/mpm_time_limit.h"
#include "implicit/mpm_mls_rotation.h"
#include "transfer/kernels.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "modify.h"
#include "platform.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr std::size_t SHOWN = 9;    // sums of forces in an error

using Data = MPMStageData;    // what stages read and write

FixMPMImplicit::FixMPMImplicit(LAMMPS *lmp, int narg, char **arg) :
    FixMPMState(lmp, narg, arg), doubts(lmp)
{
  if (igroup != 0)
    error->all(FLERR, 1, "Fix mpm/implicit steps all points of a fix mpm: use group all");
  Options options = declare();
  read_options(lmp, options, narg, arg, 3);
  scalar_flag = vector_flag = 1;
  size_vector = 12;
  global_freq = 1;
  extscalar = extvector = 0;
  restart_global = 1;
  time_depend = 1;
  dynamic_group_allow = 1;
  if (time.keeps_acceleration()) state.declare(kept.rows, "acceleration", domain->dimension);
  keep_arrays();
}

void FixMPMImplicit::init()
{
  require_field(lmp, *this);
  refuse_second(lmp, *this);
  for (auto *other : modify->get_fix_list())
    if (strcmp(other->style, "mpm/dt") == 0 || strcmp(other->style, "dt/reset") == 0)
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/implicit takes steps of any size, but fix {} {} sets that of explicit steps: "
          "remove it, and use timestep",
          other->style, other->id);
}

void FixMPMImplicit::init_physics(MPMPlan &plan)
{
  fields = plan.fields;
  if (fields.size() > 1) check_bodies(plan);
  if (!stabilize_is_given) choose_stabilize(plan);
  for (auto *field : fields) check_field(plan, *field);
  for (auto *field : fields) {
    field->keep_old_velocities();
    field->time_limit->bound = false;
  }
  if (!time.is_static()) doubts.check_time_step(fmt::format("Fix mpm/implicit {}", id));
  const MPMImplicitOptions &mine = *this;
  solver = std::make_unique<MPMImplicit>(lmp, fields, mine, kept);
}

/** Can nodes that points barely reach get a stiffness of their own? */
bool FixMPMImplicit::may_stabilize(const MPMField &of) const
{
  return !time.moves_by_mean() &&
      (of.options.shape == MPM_NS::QUADRATIC || of.options.shape == MPM_NS::CUBIC) &&
      !of.options.axisymmetric && of.elements.empty();
}

/** By default, nodes get such a stiffness from the first step on that finds no balance without it,
 *  also after a restart. */
void FixMPMImplicit::choose_stabilize(const MPMPlan &plan)
{
  const auto &only = *fields[0];
  const bool possible = fields.size() == 1 && may_stabilize(only) && !only.frame->is_total() &&
      std::none_of(plan.physics.begin(), plan.physics.end(), [&](auto *other) {
                          return has_pressure(other, only);
                        });
  stabilize = possible && total[STUCK] > 0.0 ? ENOUGH_TO_STABILIZE : 0.0;
  stabilize_if_stuck = possible && stabilize == 0.0;
}

void FixMPMImplicit::add_stages(MPMPlan &plan, MPMPlan::Place place)
{
  const Data all = {Data::POSITION, Data::VELOCITY, Data::AFFINE, Data::DEFORMATION,
                    Data::STRESS,   Data::HISTORY,  Data::MASS,   Data::FORCE,
                    Data::NODES,    Data::BLOCKS,   Data::OWN};
  if (place == MPMPlan::AFTER_MOMENTUM)
    plan.together("implicit step", all, {Data::NODES, Data::OWN}, [this]() {
      step();
    });
  if (place == MPMPlan::AFTER_ACTIONS && time.is_static())
    plan.together("implicit step", all, {Data::NODES, Data::OWN}, [this]() {
      solver->set_velocities();
    });
  if (place == MPMPlan::AFTER_SOLVE)
    plan.together("implicit step", all, {Data::NODES, Data::OWN}, [this]() {
      solver->finish();
    });
  if (place == MPMPlan::AFTER_MOTION)
    plan.together("implicit step", all, {Data::OWN}, [this]() {
      solver->check_contacts();
    });
  if (place == MPMPlan::AFTER_MOTION && time.is_static())
    plan.together("implicit step", all, {Data::VELOCITY, Data::AFFINE, Data::OWN}, [this]() {
      rest();
    });
  if (place == MPMPlan::AFTER_MOTION && time.kind == MPMTimeMethod::MIDPOINT &&
      std::any_of(fields.begin(), fields.end(), [](const MPMField *of) {
        return (bool) of->affine;
      }))
    plan.together("implicit step", all, {Data::VELOCITY, Data::AFFINE, Data::OWN}, [this]() {
      solver->end_motion();
    });
}

void FixMPMImplicit::setup(int)
{
  // elements know of their pressure now
  for (const auto *elements : find_fixes<FixMPMElements>(lmp))
    if (const char *const what = elements->beyond_trials())
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/implicit knows of fix mpm/elements {} the forces of its elements, but not {}",
          elements->id, what);
  solver->init();
  seconds = 0.0;
  std::copy_n(total, (int) NTOTAL, at_start);
}

/** The first sums of forces and the last ones, most numbers in all: where a solver does not come to
 *  an end, hundreds are alike. */
static std::string text_of(const std::vector<double> &residuals, double unit, std::size_t most)
{
  const std::size_t n = residuals.size(), first = n > most ? most / 3 : n,
                    last = n > most ? n - (most - first) : n;
  std::string text;
  for (std::size_t k = 0; k < first; k++) text += fmt::format(" {:.9g}", residuals[k] / unit);
  if (last > first) text += fmt::format(" ... ({} more) ...", last - first);
  for (std::size_t k = last; k < n; k++) text += fmt::format(" {:.9g}", residuals[k] / unit);
  return text;
}

void FixMPMImplicit::step()
{
  // at the start of steps, as the step in which a body turns for the first time has no such error
  if (time.is_static() && !warned_of_rotation)
    warned_of_rotation = warn_of_mls_rotation(*this, fields);
  const double begin = platform::walltime();
  const std::vector<double> energies = solver->step(fields[0]->step_dt());
  seconds += platform::walltime() - begin;
  for (std::size_t k = 0; k < fields.size() && time.is_static(); k++) {
    fields[k]->ledger.take(-energies[k] * force->mvv2e);
    taken[0] -= energies[k] * force->mvv2e;
  }
  const auto &now = solver->report();
  total[STEPS]++;
  total[NEWTON] += now.iterations;
  total[LINEAR] += now.linear;
  total[CUTS] += now.cuts;
  total[MADE] += now.made;
  last[LAST_NEWTON] = now.iterations;
  last[LAST_LINEAR] = now.linear;
  last[LAST_CUTS] = now.cuts;
  last[UNBALANCED] = now.unbalanced / force->ftm2v;
  last[ASYMMETRY] = now.asymmetry;
  last[RATIO] = std::max(now.ratio, now.water);
  last[PARTS] = now.parts;
  last[LAST_INDEFINITE] = now.indefinite;
  last[STABILIZING] = now.stabilizing * force->mvv2e;
  total[INDEFINITE] += now.indefinite;
  if (now.stuck) {
    total[STUCK]++;
    if (now.converged && comm->me == 0)
      error->warning(
          FLERR,
          "Fix mpm/implicit {}: step {} found its balance only with a stiffness of nodes that "
          "points barely reach, which steps have from here on: use stabilize 1 from the start, or, "
          "for solids that keep their neighbors, fix mpm ... frame total",
          id, update->ntimestep);
  }
  std::string list;
  if ((report || !now.converged) && comm->me == 0)
    list = text_of(now.residuals, force->ftm2v, now.converged ? now.residuals.size() : SHOWN);
  if (!now.converged)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/implicit {}: no equilibrium in step {} after {} Newton iterations, {}; sums of "
        "forces:{}; ratio {:.3g}; {} tangents were not positive definite. Of the changes of loads "
        "and walls in this step {:.5g} % were reached, in {} parts. Use smaller steps of load or "
        "time, hold bodies that can move freely, or let it be less accurate (keyword tolerance); "
        "above the largest load that bodies can bear, move a wall instead, or use euler{}",
        id, update->ntimestep, now.iterations, now.failure, list, now.ratio, now.indefinite,
        100.0 * now.reached, now.parts,
        fields.size() > 1                  ? ""
            : fields[0]->frame->is_total() ? may_stabilize(*fields[0]) && stabilize == 0.0
                ? ", or stabilize 1 where nodes are next to loose"
                : ""
            : may_stabilize(*fields[0]) && stabilize == 0.0 && !now.stuck
            ? "; where surfaces turn or are inclined, nodes that points barely reach stop the "
              "updated frame: use stabilize 1, or, for solids that keep their neighbors, fix mpm "
              "... frame total"
            : "; slender solids that keep their neighbors need fix mpm ... frame total");
  if (report && comm->me == 0)
    utils::logmesg(lmp, "  implicit step {}:{} {} linear iterations, {} not definite, forces{}\n",
                   update->ntimestep,
                   now.parts > 1 ? fmt::format(" {} parts,", now.parts) : std::string(), now.linear,
                   now.indefinite, list);
}

/** Statics: puts points to rest after they have moved. In step(), nodes got what points had, less
 *  what transfers lose. */
void FixMPMImplicit::rest()
{
  for (auto *field : fields) put_to_rest(*field, taken);
}

std::vector<MPMPhysics::Account> FixMPMImplicit::accounts() const
{
  if (!time.is_static()) return {};
  return {{"rest", false}, {"work at rest", false, true}};
}

void FixMPMImplicit::account(double *values) const
{
  for (int k = 0; k < 2 && time.is_static(); k++) values[k] -= taken[k];
}

/* ---------------------------------------------------------------------- */

void FixMPMImplicit::post_run()
{
  const double steps = total[STEPS] - at_start[STEPS];
  if (comm->me || steps == 0.0 || update->nsteps == 0) return;
  const double indefinite = total[INDEFINITE] - at_start[INDEFINITE];
  const std::string unstable = indefinite > 0.0
      ? fmt::format("; {} tangents were not positive definite", (int64_t) indefinite)
      : "";
  const double made = total[MADE] - at_start[MADE];
  const std::string levels = made > 0.0 ? fmt::format("; multigrid made {} times", (int64_t) made)
                                        : "";
  static constexpr const char *PARTS_OF_STEP[MPMImplicitTimes::NPARTS] = {
      "forces", "tangents", "preconditioners", "linear systems"};
  std::string parts;
  for (int k = 0; k < MPMImplicitTimes::NPARTS; k++)
    parts += fmt::format("{}{:.0f} % {}", k ? ", " : "",
                         100.0 * solver->seconds_of((MPMImplicitTimes::Part) k) /
                             std::max(seconds, 1.0e-300),
                         PARTS_OF_STEP[k]);
  utils::logmesg(lmp,
                 "Fix mpm/implicit {}: {:.2f} Newton iterations in a step, {:.1f} of the linear "
                 "solver in each; last ratio of forces {:.3g}; {:.3g} ms a step ({}){}{}\n",
                 id, (total[NEWTON] - at_start[NEWTON]) / steps,
                 (total[LINEAR] - at_start[LINEAR]) /
                     std::max(1.0, total[NEWTON] - at_start[NEWTON]),
                 last[RATIO], 1000.0 * seconds / steps, parts, levels, unstable);
}

double FixMPMImplicit::compute_vector(int k)
{
  static constexpr int SINCE_START[3] = {NEWTON, LINEAR, CUTS};
  if (k == 11) return last[STABILIZING];
  if (k == 10) return total[MADE];
  if (k >= 8) return last[k == 8 ? PARTS : LAST_INDEFINITE];
  return k < 5 ? last[k] : total[SINCE_START[k - 5]];
}

/* ---------------------------------------------------------------------- */

void FixMPMImplicit::write_restart(FILE *fp)
{
  if (solver) solver->forget();
  keep_totals(world, taken, 2);
  if (comm->me) return;
  double list[NTOTAL + 2 + NLAST + 1];
  std::copy_n(total, (int) NTOTAL, list);
  std::copy_n(taken, 2, list + NTOTAL);
  std::copy_n(last, (int) NLAST, list + NTOTAL + 2);
  list[NTOTAL + 2 + NLAST] = kept.known;
  write_state(fp, list, sizeof(list));
}

void FixMPMImplicit::restart(char *buf)
{
  const auto *const list =
      (const double *) read_state(lmp, id, buf, (NTOTAL + 2 + NLAST + 1) * sizeof(double));
  std::copy_n(list, (int) NTOTAL, total);
  if (comm->me == 0) std::copy_n(list + NTOTAL, 2, taken);
  std::copy_n(list + NTOTAL + 2, (int) NLAST, last);
  kept.known = time.keeps_acceleration() && list[NTOTAL + 2 + NLAST] != 0.0;
}
