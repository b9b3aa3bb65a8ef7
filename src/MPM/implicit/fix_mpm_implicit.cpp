/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/fix_mpm_implicit.h"

#include "base/mpm_options.h"
#include "contact/fix_mpm_contact.h"
#include "elements/fix_mpm_elements.h"
#include "field/mpm_affine.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_frame.h"
#include "field/mpm_ledger.h"
#include "field/mpm_node_action.h"
#include "field/mpm_rest.h"
#include "field/mpm_time_limit.h"
#include "field/mpm_trial_contact.h"
#include "implicit/mpm_mls_turn.h"
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

using namespace LAMMPS_NS;
using namespace MPM_NS;
using Data = MPMStageData;    // what stages read and write

/* ----------------------------------------------------------------------
   fix ID all mpm/implicit static|euler|newmark|midpoint|alpha|hht keyword value ...
------------------------------------------------------------------------- */

Options MPMImplicitOptions::declare()
{
  using namespace option;
  Options options("fix mpm/implicit");
  options.argument(word(
      time,
      {{"static", STATIC, "without inertia: each step ends in equilibrium"},
       {"euler", EULER, "backward Euler: first order in time, damps fast motion"},
       {"newmark", NEWMARK, "Newmark's method: second order and without damping for gamma = 1/2"},
       {"midpoint", MIDPOINT,
        "mid-point rule: second order, without damping, keeps angular momentum"},
       {"alpha", ALPHA, "generalized alpha method: second order, damps high frequencies only"},
       {"hht", HHT,
        "method of Hilber, Hughes, and Taylor: as alpha, with more damping of medium "
        "frequencies"}}));
  options.add("gamma",
              {number(gamma, "G", {0.5, 1.0, true, true}, "",
                      "parameter gamma of Newmark's method; values above 1/2 damp, with "
                      "first-order accuracy")});
  options.add("rho",
              {number(rho, "R", {0.0, 1.0, true, true}, "",
                      "parameter rho of alpha and hht: the share of the highest frequencies that "
                      "is left after a step")});
  options.add("tolerance",
              {number(tolerance, "R", {0.0, 1.0, false, false}, "",
                      "forces are balanced when the residual is below this share of all forces")});
  options
      .add("absolute",
           {number(absolute, "F", NOT_NEGATIVE, "force",
                   "forces are also balanced when the sum of the residual is below this force")})
      .standard("0 (not used)");
  options.add(
      "iterations",
      {integer(most_iterations, "N", POSITIVE, "largest number of Newton iterations in a step")});
  options.add(
      "parts",
      {integer(most_parts, "N", POSITIVE,
               "a step that does not converge is divided into parts, down to 1/N of the step")});
  options.add("linear",
              {integer(most_linear, "N", POSITIVE,
                       "largest number of iterations of the linear solver in a Newton iteration")});
  options.add("accuracy",
              {number(least_accuracy, "R", {0.0, 1.0, false, false}, "",
                      "largest relative residual of the linear solutions")});
  options.add(
      "solver",
      {word(
          preconditioner,
          {{"blocks", BLOCKS,
            "conjugate gradients, preconditioned with the stiffness of each node by itself"},
           {"multigrid", MULTIGRID,
            "the same on a sequence of lattices, each with twice the spacing: for many cells"}})});
  options
      .add("slip",
           {number(slip, "D", POSITIVE, "distance",
                   "walls reach full Coulomb friction where surfaces slip by much more than this "
                   "in a step")})
      .standard("1e-5 node spacings");
  options
      .add("stabilize",
           {number(stabilize, "C", NOT_NEGATIVE, "",
                   "stiffness of nodes that points barely reach, relative to the modulus of these "
                   "points")})
      .then([this] {
        stabilize_is_given = true;
      })
      .standard("0 until a step does not converge, then 1");
  options.add("report", {yes_no(report)},
              "print the forces before each Newton iteration to the screen and the log file");
  options.refuse([=] {
    return OptionRules{
        {time != NEWMARK, "gamma", "is of Newmark's method: use newmark, or remove it"},
        {stabilize > 0.0 && time != STATIC && time != EULER, "stabilize",
         "is for static and euler: remove it"},
        {!keeps_acceleration(), "rho",
         "is of the methods with a damping of high frequencies: use alpha or hht, or remove it"},
        {time == HHT && rho < 0.5, "rho",
         "is at least 0.5 in the method of Hilber, Hughes, and Taylor: use alpha for {rho}"}};
  });
  return options;
}

FixMPMImplicit::FixMPMImplicit(LAMMPS *lmp, int narg, char **arg) : FixMPMState(lmp, narg, arg)
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
  if (keeps_acceleration()) state.declare(kept.rows, "acceleration", domain->dimension);
  keep_arrays();
}

void FixMPMImplicit::init()
{
  require_field(lmp, *this);
  refuse_second(lmp, *this);
  for (auto *ifix : modify->get_fix_list()) {
    const std::string other = ifix->style;
    if (other == "mpm/dt" || other == "dt/reset")
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/implicit takes steps of any size, but fix {} {} sets that of explicit steps: "
          "remove it, and use timestep",
          other, ifix->id);
  }
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
  const MPMImplicitOptions &mine = *this;
  solver = std::make_unique<MPMImplicit>(lmp, fields, mine, kept);
}

/** Does an implicit step of this field solve for a pressure of this physics, too? */
static bool has_pressure(MPMPhysics *physics, const MPMField &field)
{
  auto *const water = dynamic_cast<MPMPorePressure *>(physics);
  return water && water->node_pressure(field);
}

/** Refuses what implicit steps of a field do not support. */
void FixMPMImplicit::check_field(const MPMPlan &plan, MPMField &of) const
{
  auto *const field = &of;
  const auto &options = field->options;
  for (auto *other : plan.physics)
    if (dynamic_cast<MPMPorePressure *>(other) && (time == NEWMARK || time == MIDPOINT))
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/implicit solves for the pressure of fix {} {} at the end of a step, which "
          "newmark and midpoint are not made of: use static or euler",
          dynamic_cast<Fix *>(other)->style, dynamic_cast<Fix *>(other)->id);
  refuse_field(
      lmp, *this, *field,
      {{options.scheme != MPMFieldOptions::USL, "scheme",
        "implicit steps end with the stress that goes with their velocities: use scheme usl"},
       {options.series != MPMFieldOptions::LUMPED, "transfer xpic and fmpm",
        "forces are balanced with the lumped mass: use transfer apic or flip"},
       {time == STATIC && adds_change(options.transfer), "transfer flip",
        "points have no velocity in statics: use transfer pic, which has the same forces, or apic"},
       {(time == NEWMARK || keeps_acceleration()) &&
            !(options.transfer == FLIP && options.flip == 1.0),
        "this transfer",
        "points move with another velocity than they have at the end of the step: use transfer "
        "flip 1.0, "
        "or euler or midpoint instead"},
       {time == MIDPOINT && !(options.transfer == FLIP && options.flip == 1.0) &&
            !(options.transfer == APIC && is_mls(options.shape, options.transfer) &&
              !options.strains_by_gradient() && !field->frame->is_total()),
        "this transfer",
        "points move with another velocity than they have at the end of the step: use transfer "
        "flip "
        "1.0, in the updated frame also transfer apic with shape quadratic or cubic and stress "
        "mls"},
       {options.averages_strain(), "locking fbar and both",
        "their motions of points are not those that forces belong to: use locking pressure"},
       {options.modified_edges, "edges modified", "use edges plain, the default"},
       {options.smooths_volumes(), "smooth", "it is for fluids in explicit steps"},
       {options.has_light_nodes(), "light",
        "nodes with next to no mass are no problem in implicit steps: remove it"},
       {options.heats(), "heat", "the time step is not in its balance: remove it"},
       {options.every > 1, "every", "implicit steps are long already: use every 1"}});
  if (stabilize > 0.0 && !may_stabilize(*field))
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/implicit stabilize is for points of shape quadratic or cubic of fix mpm {}, "
        "without fix mpm/elements, and not around an axis: remove it",
        field->id());
  for (auto *other : plan.physics)
    if (stabilize > 0.0 && has_pressure(other, *field))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/implicit stabilize knows nothing of the pressure of fix {} {}: remove it",
                 dynamic_cast<Fix *>(other)->style, dynamic_cast<Fix *>(other)->id);
  for (auto *other : plan.physics)
    if (other != this && !dynamic_cast<MPMLoad *>(other) && !other->precedes_motion() &&
        !dynamic_cast<MPMPorePressure *>(other))
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/implicit balances stress, inertia, and loads on points, and what fix {} {} "
          "computes in explicit steps would not be in its balance: remove one of them",
          dynamic_cast<Fix *>(other)->style, dynamic_cast<Fix *>(other)->id);
  for (const auto *elements : find_fixes<FixMPMElements>(lmp)) {
    if (!elements->is_thin())
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/implicit knows the forces of surfaces and lines, but not those of the "
                 "solid elements of fix mpm/elements {}: use points instead, or explicit steps",
                 elements->id);
    if (preconditioner == MULTIGRID)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/implicit solver multigrid is made of the stiffness of points, and knows "
                 "nothing of that of fix mpm/elements {}: use solver blocks",
                 elements->id);
    for (auto *other : plan.physics)
      if (has_pressure(other, *field))
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/implicit cannot solve for the pressure of fix {} {} together with the "
                   "elements of fix mpm/elements {}: use explicit steps",
                   dynamic_cast<Fix *>(other)->style, dynamic_cast<Fix *>(other)->id, elements->id);
  }
  bool rubs = false;
  for (auto *action : plan.actions) {
    if (action->is_projection()) continue;
    const auto *const style = dynamic_cast<Fix *>(action)->style,
                      *const name = dynamic_cast<Fix *>(action)->id;
    auto *const contact = action->trial_contact();
    if (!contact)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/implicit holds nodes by walls, and knows nothing of what fix {} {} does: "
                 "use fix mpm/boundary, with a region that moves for a rigid body, or explicit "
                 "steps",
                 style, name);
    for (auto *other : plan.physics)
      if (has_pressure(other, *field))
        error->all(
            FLERR, Error::NOLASTLINE,
            "Fix mpm/implicit finds no contact and friction of walls together with the water "
            "of fix {} {}, and fix {} {} has one of these: use stick, or slip without "
            "friction",
            dynamic_cast<Fix *>(other)->style, dynamic_cast<Fix *>(other)->id, style, name);
    rubs = rubs || (contact->has_friction() && contact->is_regularised());
  }
  if (slip > 0.0 && !rubs)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/implicit slip is of walls with friction, and there are none: remove it");
  if (options.shape == MPM_NS::LINEAR && !field->frame->is_total() && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/implicit: with shape linear in the updated frame, forces jump when "
                   "points go from cell to cell, and can be wrong by 17 % in runs of many steps: "
                   "use shape quadratic of fix mpm {}, or frame total",
                   field->id());
}

/** Refuses what is not made for several fields, which are bodies that touch each other. */
void FixMPMImplicit::check_bodies(const MPMPlan &plan) const
{
  const auto contacts = find_fixes<FixMPMContact>(lmp);
  for (const auto *field : fields)
    if (contacts.size() != 1 || !contacts[0]->touches(field->id()))
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/implicit solves for the nodes of one fix mpm, or of all that one fix "
          "mpm/contact names, but there are {} of these and {} of those, and fix mpm {}: let "
          "bodies share a fix mpm, name all of them in one fix mpm/contact, or use explicit steps",
          fields.size(), contacts.size(), field->id());
  if (keeps_acceleration())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/implicit alpha and hht keep accelerations of points, whose part in the "
               "force between bodies (fix mpm/contact {}) would not be told: use newmark or "
               "midpoint",
               contacts[0]->id);
  if (preconditioner == MULTIGRID)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/implicit solver multigrid knows one fix mpm, and there are {}, which fix "
               "mpm/contact {} joins: use solver blocks",
               fields.size(), contacts[0]->id);
  for (const auto *field : fields)
    refuse_field(lmp, *this, *field,
                 {{field->domains != nullptr, "shape cpdi and cpdi2",
                   "bodies that touch by fix mpm/contact need functions of nodes: use shape "
                   "quadratic"},
                  {!field->elements.empty(), "fix mpm/elements",
                   "contact of elements is for explicit steps: use points"},
                  {field->options.shape == MPM_NS::LINEAR, "shape linear",
                   "forces between bodies jump when points go from cell to cell: use shape "
                   "quadratic"}});
  for (auto *action : plan.actions) {
    auto *const contact = action->trial_contact();
    if (!contact || dynamic_cast<MPMBodyContact *>(contact)) continue;
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/implicit knows walls that hold bodies together with fix mpm/contact {}, but "
        "not yet those that separate, have friction, or are regions that move, such as fix "
        "mpm/boundary {}: use stick or slip at faces or regions at rest, or a body of its "
        "own (fix mpm) for the wall",
        contacts[0]->id, dynamic_cast<Fix *>(action)->id);
  }
}

/** Can nodes that points barely reach get a stiffness of their own? */
bool FixMPMImplicit::may_stabilize(const MPMField &of) const
{
  return (time == STATIC || time == EULER) &&
      (of.options.shape == MPM_NS::QUADRATIC || of.options.shape == MPM_NS::CUBIC) &&
      !of.options.axisymmetric && of.elements.empty();
}

/** By default, nodes get such a stiffness from the first step on that finds no balance without it, also after
 *  a restart. */
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
  if (place == MPMPlan::AFTER_ACTIONS && time == STATIC)
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
  if (place == MPMPlan::AFTER_MOTION && time == STATIC)
    plan.together("implicit step", all, {Data::VELOCITY, Data::AFFINE, Data::OWN}, [this]() {
      rest();
    });
  if (place == MPMPlan::AFTER_MOTION && time == MIDPOINT &&
      std::any_of(fields.begin(), fields.end(), [](const MPMField *of) {
        return (bool) of->affine;
      }))
    plan.together("implicit step", all, {Data::VELOCITY, Data::AFFINE, Data::OWN}, [this]() {
      solver->end_motion();
    });
}

void FixMPMImplicit::setup(int)
{
  for (const auto *elements :
       find_fixes<FixMPMElements>(lmp))    // elements know of their pressure now
    if (const char *const what = elements->beyond_trials())
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/implicit knows of fix mpm/elements {} the forces of its elements, but not {}",
          elements->id, what);
  solver->init();
  seconds = 0.0;
  std::copy_n(total, (int) NTOTAL, at_start);
}

/* ---------------------------------------------------------------------- */

void FixMPMImplicit::step()
{
  if (time == STATIC && !told_of_turns) tell_of_turns();
  const double begin = platform::walltime();
  const std::vector<double> energies = solver->step(fields[0]->step_dt());
  seconds += platform::walltime() - begin;
  for (std::size_t k = 0; k < fields.size() && time == STATIC; k++) {
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
          "points barely reach, which steps have from here on: use stabilize 1 from the "
          "start, or, for solids that keep their neighbors, fix mpm ... frame total",
          id, update->ntimestep);
  }
  std::string list;
  if ((report || !now.converged) && comm->me == 0)
    for (const double r : now.residuals) list += fmt::format(" {:.9g}", r / force->ftm2v);
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

/** Statics: puts points to rest after they have moved. In step(), nodes got what points had, less what
 *  transfers lose. */
void FixMPMImplicit::rest()
{
  for (auto *field : fields) put_to_rest(*field, taken);
}

/** Warns once of bodies that are turned. Called at the start of steps: the step in which a body turns for the
 *  first time has no such error. */
void FixMPMImplicit::tell_of_turns()
{
  for (const auto *field : fields) {
    const double turn = turn_with_mls(*field);
    if (!is_turned(turn)) continue;
    told_of_turns = true;
    if (comm->me == 0)
      error->warning(FLERR, "Fix mpm/implicit {}: {}", id, about_turn_with_mls(turn, field->id()));
    return;
  }
}

std::vector<MPMPhysics::Account> FixMPMImplicit::accounts() const
{
  if (time != STATIC) return {};
  return {{"rest", false}, {"work at rest", false, true}};
}

void FixMPMImplicit::account(double *values) const
{
  for (int k = 0; k < 2 && time == STATIC; k++) values[k] -= taken[k];
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
  static constexpr const char *PARTS_OF_STEP[MPMImplicit::NPARTS] = {
      "forces", "tangents", "preconditioners", "linear systems"};
  std::string parts;
  for (int k = 0; k < MPMImplicit::NPARTS; k++)
    parts +=
        fmt::format("{}{:.0f} % {}", k ? ", " : "",
                    100.0 * solver->seconds_of((MPMImplicit::Part) k) / std::max(seconds, 1.0e-300),
                    PARTS_OF_STEP[k]);
  utils::logmesg(lmp,
                 "Fix mpm/implicit {}: {:.2f} Newton iterations in a step, {:.1f} of the linear "
                 "solver in each; "
                 "last ratio of forces {:.3g}; {:.3g} ms a step ({}){}{}\n",
                 id, (total[NEWTON] - at_start[NEWTON]) / steps,
                 (total[LINEAR] - at_start[LINEAR]) /
                     std::max(1.0, total[NEWTON] - at_start[NEWTON]),
                 last[RATIO], 1000.0 * seconds / steps, parts, levels, unstable);
}

double FixMPMImplicit::compute_scalar()
{
  return last[RATIO];
}

double FixMPMImplicit::compute_vector(int k)
{
  static constexpr int SINCE_START[3] = {NEWTON, LINEAR, CUTS};
  if (k == 11) return last[STABILIZING];
  if (k == 10) return total[MADE];
  if (k >= 8) return last[k == 8 ? PARTS : LAST_INDEFINITE];
  return k < 5 ? last[k] : total[SINCE_START[k - 5]];
}

double FixMPMImplicit::memory_usage()
{
  return FixMPMState::memory_usage() + (solver ? solver->memory_usage() : 0.0);
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
  const int size = sizeof(list);
  fwrite(&size, sizeof(int), 1, fp);
  fwrite(list, size, 1, fp);
}

void FixMPMImplicit::restart(char *buf)
{
  const auto *const list = (const double *) buf;
  std::copy_n(list, (int) NTOTAL, total);
  if (comm->me == 0) std::copy_n(list + NTOTAL, 2, taken);
  std::copy_n(list + NTOTAL + 2, (int) NLAST, last);
  kept.known = keeps_acceleration() && list[NTOTAL + 2 + NLAST] != 0.0;
}
