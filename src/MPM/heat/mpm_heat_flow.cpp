/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "heat/mpm_heat_flow.h"

#include "atom.h"
#include "base/mpm_options.h"
#include "base/mpm_state.h"
#include "comm.h"
#include "contact/mpm_leaks.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "input.h"
#include "update.h"
#include "variable.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** Do faces of the box take their weights from the surface that nodes have (MPMHeatBody)? */
bool MPMHeatFlow::weighs_faces(const MPMField &field)
{
  return field.options.shape != MPM_NS::LINEAR && field.options.shape != MPM_NS::BERNSTEIN;
}

MPMHeatFlow::MPMHeatFlow(LAMMPS *lmp, MPMHeatOptions &options, const MPMRows &gradients,
                         const std::string &id) :
    Pointers(lmp),
    options(options), gradients(gradients), id(id)
{
}

void MPMHeatFlow::set_size(int n)
{
  for (auto *heats : {&in_step, &present, &power}) heats->assign(n, 0.0);
}

void MPMHeatFlow::clear()
{
  fields.clear();
  steps.clear();
  solver.reset();
  if (options.in_time.time != MPMDiffusionOptions::EXPLICIT) {
    MPMDiffusion &equations = *this;
    solver = std::make_unique<MPMDiffusionSolver>(lmp, equations, options.in_time);
  }
  steps.add(in_step, present);
}

void MPMHeatFlow::add(MPMField &field)
{
  fields.push_back(
      std::make_unique<MPMConduction>(lmp, field, options.transfer, options.conditions));
  auto &mine = *fields.back();
  mine.init(sigma(), !options.surfaces.empty() || !options.pairs.empty(), warned_of_layers);
  if (solver) mine.faces.hold_exactly();
  if (mine.conducts()) steps.add(mine.temperature, mine.rate);
}

void MPMHeatFlow::begin()
{
  evaluate_variables();
  std::fill(in_step.begin(), in_step.end(), 0.0);
}

/** Warns of materials that do not conduct and are thinner than the reach of nodes, at the first
 *  step, once. */
void MPMHeatFlow::look_for_leaks()
{
  if (leaks_known) return;
  leaks_known = true;
  const auto conducts = [](const FixMPMMaterial *fix) {
    return fix->material->conducts();
  };
  for (const auto &of : fields) {
    const auto &all = of->field.materials;
    if (!of->conducts() || std::all_of(all.begin(), all.end(), conducts)) continue;
    const auto leaks = find_leaks(of->field, world, conducts);
    if (leaks.nodes && comm->me == 0)
      error->warning(
          FLERR,
          "Fix mpm/heat {}: material that does not conduct is so thin that heat leaks through it, "
          "at "
          "{} nodes of fix mpm {}, one of them at {:.6g} {:.6g} {:.6g}: let it have three node "
          "spacings",
          id, leaks.nodes, of->field.id(), leaks.first[0], leaks.first[1], leaks.first[2]);
  }
}

void MPMHeatFlow::evaluate_variables()
{
  evaluate_in_step(lmp, options.has_variables(), [&] {
    for (auto &c : options.conditions)
      for (int k = 0; k < c.nvalue(); k++) c.now[k] = evaluate(lmp, c.value[k]);
    for (auto &[region, c] : options.surfaces)
      for (int k = 0; k < c.nvalue(); k++) c.now[k] = evaluate(lmp, c.value[k]);
    for (auto &p : options.pairs) p.now = evaluate(lmp, p.conductance);
    check_values();
    if (options.source.empty()) return;
    source_values.resize(atom->nmax);
    if (input->variable->atomstyle(source_index))
      input->variable->compute_atom(source_index, 0, source_values.data(), 1, 0);
    else
      std::fill(source_values.begin(), source_values.end(),
                evaluate(lmp, {0.0, options.source.substr(2), true, source_index}));
  });
}

/* ----------------------------------------------------------------------
   called before temperatures go to nodes, as surfaces have sums over points of their own
------------------------------------------------------------------------- */

void MPMHeatFlow::find_surfaces()
{
  for (auto &body : bodies) body->begin_step();
  for (auto &body : bodies)
    if (body->conduction) body->conduction->faces.mark_near(body->near);
  for (auto &contact : contacts) contact->mark_near();
  for (auto &surface : surfaces) surface->mark_near();
  if (!surfaces.empty())
    for (auto &body : bodies)
      if (!body->conduction) body->want_all();
  for (auto &body : bodies)
    if (!body->conduction || !levels_with(*body->conduction)) body->find_surface();
  for (auto &levels : refined) levels->find_surface();
  const bool looks = (!surfaces.empty() || !contacts.empty()) &&
      thin.looks((int) (options.surfaces.size() + contacts.size()));
  for (std::size_t k = 0; k < contacts.size(); k++)
    contacts[k]->find_contacts(looks ? &thin : nullptr, (int) (options.surfaces.size() + k));
  for (auto &surface : surfaces) surface->find_lines(looks ? &thin : nullptr);
  if (looks) report_thin();
}

/** One warning, with the same place for any number of ranks. Collective. */
void MPMHeatFlow::report_thin()
{
  MPMHeatThin::Found found;
  if (!thin.report(world, found) || comm->me) return;
  const int nsurface = (int) options.surfaces.size();
  std::string what = "surface";
  if (found.entry >= nsurface)
    what = fmt::format("contact {} {}", options.pairs[found.entry - nsurface].field[0],
                       options.pairs[found.entry - nsurface].field[1]);
  else if (!options.surfaces[found.entry].region.empty())
    what = "region " + options.surfaces[found.entry].region;
  error->warning(FLERR,
                 "Fix mpm/heat {}: more than 5 % of the area of {} belongs to material that is "
                 "thinner than 3 node spacings (4 with shape cubic), first at {:.6g} {:.6g} "
                 "{:.6g} in step {}: heat is missing there, up to 16 % with 2 spacings and half of "
                 "it with 1. Make the spacing of fix mpm smaller; this is said only once",
                 id, what, found.x[0], found.x[1], found.x[2], update->ntimestep);
}

int MPMHeatFlow::exchanges(const MPMConduction &conduction) const
{
  return (int) contacts.size() + !surfaces.empty() + conduction.faces.axes_that_follow();
}

/* ----------------------------------------------------------------------
   temperatures of nodes, and the number of stages that all fields need for their step
------------------------------------------------------------------------- */

/** Finds lines of surfaces and contacts that cross others at edges, when all lines of the step are
 *  known. Collective. */
void MPMHeatFlow::find_edges()
{
  for (auto &body : bodies)
    if (body->conduction) body->begin_edges();
  for (auto &contact : contacts) contact->note_edges();
  for (auto &surface : surfaces) surface->note_edges();
  for (auto &body : bodies) {
    if (!body->conduction) continue;
    body->conduction->faces.note_edges(*body);
    body->end_edges();
  }
}

int MPMHeatFlow::count_stages()
{
  static constexpr int NRATE =
      4;    // rates of a field: of its conduction, and of its faces normal to each axis
  look_for_leaks();
  std::vector<double> mine(NRATE * fields.size(), 0.0), all;
  find_surfaces();
  for (auto &levels : refined) {
    const double bound = levels->points_to_nodes(gradients, !solver);
    for (std::size_t k = 0; k < fields.size(); k++)
      if (levels->has(*fields[k])) mine[NRATE * k] = bound;
  }
  for (std::size_t k = 0; k < fields.size(); k++) {
    auto &field = *fields[k];
    if (!field.conducts()) continue;
    if (!levels_with(field)) mine[NRATE * k] = field.points_to_nodes(gradients, !solver);
    if (field.faces.any())
      field.faces.begin_step(field.face_capacity(), field.node_volume(),
                             weighs_faces(field.field) ? &body_in(field.field) : nullptr,
                             field.face_gradient(), field.temperature, &mine[NRATE * k + 1]);
  }
  for (auto &contact : contacts) mine.push_back(contact->begin_step());
  for (auto &surface : surfaces) mine.push_back(surface->begin_step());
  all.resize(mine.size());
  MPI_Allreduce(mine.data(), all.data(), (int) all.size(), MPI_DOUBLE, MPI_MAX, world);
  double greatest = 0.0;
  for (std::size_t k = 0; k < fields.size(); k++) {
    fields[k]->keep_rate(all[NRATE * k]);
    greatest = std::max(greatest, all[NRATE * k]);
  }

  // a node can be at faces, in contacts with several bodies, and at a surface; nodes of different
  // fields are separate. Exchange that needs no stage needs no limit
  static constexpr double BELOW_ONE_STEP = 0.95;
  int most_at_a_node = 0;
  for (auto &field : fields) most_at_a_node = std::max(most_at_a_node, exchanges(*field));
  const double dt = waited.time,
               cap = std::max(greatest, BELOW_ONE_STEP / (dt * std::max(most_at_a_node, 1)));
  const double *rates = all.data() + NRATE * fields.size();
  const bool has_lines = !contacts.empty() || !surfaces.empty();
  if (has_lines) find_edges();
  double most = 0.0;
  for (std::size_t k = 0; k < fields.size(); k++) {
    for (auto &body : bodies)
      if (has_lines && body->conduction == fields[k].get())
        fields[k]->faces.slow_down_at_edges(*body, fields[k]->rate_at_edges());
    const double rate =
        fields[k]->faces.limit(cap, fields[k]->rate_at_edges(), &all[NRATE * k + 1]);
    most = std::max(most, rate);
  }
  greatest += most;
  for (auto &contact : contacts) {
    contact->limit(cap);
    greatest += std::min(cap, *rates++);
  }
  most = 0.0;
  for (auto &surface : surfaces) {
    surface->limit(cap, surface->body.conduction->rate_at_edges());
    most = std::max(most, std::min(cap, *rates++));
  }
  greatest += most;
  fastest = greatest;
  if (solver) return 0;

  const double limit = MPMSuperStep::explicit_limit(greatest);
  const int stages = MPMSuperStep::count(dt, limit, options.most_stages);
  if (stages > options.most_stages)
    error->all(FLERR, Error::NOLASTLINE,
               "The time step {:.6g} is {:.4g} times the explicit limit {:.4g} of the conduction "
               "of heat, which needs more than {} stages: use fix mpm/dt, a smaller timestep{}, "
               "fix mpm/heat ... stages, or implicit steps, fix mpm/heat ... time sdirk2",
               dt, dt / limit, limit, options.most_stages,
               options.every > 1 ? " or fix mpm/heat ... every" : "");
  return stages;
}

void MPMHeatFlow::find_rates()
{
  std::fill(present.begin(), present.end(), 0.0);
  for (auto &field : fields)
    if (field->conducts())
      field->find_rates(options.source.empty() ? nullptr : source_values.data(), present);
  for (auto &levels : refined) levels->sum_rates();
  for (auto &field : fields) {
    if (!field->conducts()) continue;
    field->add_given();
    field->faces.add_rates(field->temperature, field->rate, present);
  }
  for (auto &levels : refined) levels->rates_from_parents();
  if (contacts.empty() && surfaces.empty()) return;
  for (auto &body : bodies)
    if (body->conduction) body->begin_stage();
  for (std::size_t k = 0; k < contacts.size(); k++)
    contacts[k]->exchange(present[contact_places() + k]);
  for (const auto &surface : surfaces) surface->exchange(present.data() + surface_places());
  for (auto &body : bodies) {
    if (!body->conduction) continue;
    body->end_stage();
    body->conduction->faces.hold_rates(body->conduction->rate, present);
  }
}

/* ----------------------------------------------------------------------
   the same equations in implicit steps
------------------------------------------------------------------------- */

bool MPMHeatFlow::linearize()
{
  int mine = 1, all;
  for (auto *part : parts) mine &= part->faces.linearize(part->temperature);
  for (const auto &contact : contacts) mine &= contact->is_symmetric();
  for (auto &surface : surfaces) mine &= surface->linearize();
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MIN, world);
  return all;
}

void MPMHeatFlow::find_changes()
{
  for (auto *part : parts) {
    part->find_changes();
    part->faces.add_changes(part->temperature, part->rate);
  }
  if (contacts.empty() && surfaces.empty()) return;
  Heats nowhere(MPMHeatFaces::NFACE + 1);
  double between = 0.0;
  for (auto &body : bodies)
    if (body->conduction) body->begin_stage();
  for (const auto &contact : contacts) contact->exchange(between);
  for (const auto &surface : surfaces) surface->exchange_changes();
  for (auto &body : bodies) {
    if (!body->conduction) continue;
    body->end_stage();
    body->conduction->faces.hold_rates(body->conduction->rate, nowhere);
  }
}

void MPMHeatFlow::project(int part, std::vector<double> &change)
{
  Heats nowhere(MPMHeatFaces::NFACE + 1);
  parts[part]->faces.hold_rates(change, nowhere);
}

void MPMHeatFlow::each_term(int k, double dt, const Term &use)
{
  const auto &part = *parts[k];
  part.each_term(use);
  part.faces.each_term(std::max(part.bound_of_rates(), 1.0 / dt), use);
  for (const auto &body : bodies) {
    if (body->conduction != &part) continue;
    for (const auto &contact : contacts) contact->each_term(*body, use);
    for (const auto &surface : surfaces)
      if (&surface->body == body.get()) surface->each_term(use);
  }
}

void MPMHeatFlow::solve()
{
  solver->clear();
  solver->add(in_step, present);
  parts.clear();
  double greatest = 0.0;
  for (auto &field : fields) {
    if (!field->conducts()) continue;
    parts.push_back(field.get());
    solver->add(field->field, field->scalar);
    greatest = std::max(greatest, field->bound_of_rates());
  }
  const auto &report = solver->advance(dt_last, greatest, fastest);
  iterations[STEPS]++;
  iterations[NEWTON] += report.newton;
  iterations[LINEAR] += report.linear;
  if (!report.converged)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/heat {}: no solution for the temperatures in step {} after {} iterations "
               "of Newton's method and {} of the linear solver: {}. Use a smaller timestep, a "
               "larger tolerance, or time explicit",
               id, update->ntimestep, report.newton, report.linear, report.failure);
}

void MPMHeatFlow::report() const
{
  const double n = iterations[STEPS];
  if (comm->me || n == 0.0 || update->nsteps == 0) return;
  utils::logmesg(lmp,
                 "Fix mpm/heat {}: {:.2f} Newton iterations in a step, {:.1f} of the linear solver "
                 "in each\n",
                 id, iterations[NEWTON] / n,
                 iterations[LINEAR] / std::max(1.0, iterations[NEWTON]));
}

void MPMHeatFlow::conduct()
{
  for (auto &field : fields) field->duration = waited.time;
  const int stages = count_stages();
  for (auto &field : fields)
    if (field->conducts()) field->faces.hold(field->temperature, in_step);
  for (auto &levels : refined) {
    levels->look_for_thin_surfaces();
    levels->temperatures_from_parents();
  }
  dt_last = waited.time;
  waited = {};
  if (solver)
    solve();
  else
    steps.advance(stages, dt_last, [this]() {
      find_rates();
    });
  for (auto &field : fields) {
    if (field->conducts()) totals.got += field->nodes_to_points(gradients);
    field->given.clear();
  }
  for (int face = 0; face < MPMHeatFaces::NFACE; face++) totals.through_faces += in_step[face];
  for (int k = surface_places(); k < contact_places(); k++) totals.through_faces += in_step[k];
  totals.of_sources += in_step[MPMConduction::SOURCES];
  for (int k = 0; k < NGIVER; k++) totals.given[k] += in_step[GIVERS + k] = totals.booked[k];
  std::fill_n(totals.booked, NGIVER, 0.0);
  power_known = false;
  if (options.every == MPMHeatOptions::AUTO) waited.longest = longest_wait();
  warn_of_fronts();
}

/** Warns of long conductions with fronts: points take the heat of fusion at their end, which cools
 *  or warms the material beyond a front too much. */
void MPMHeatFlow::warn_of_fronts()
{
  static constexpr double LONG = 4.0;    // in explicit limits
  const double limits = dt_last / MPMSuperStep::explicit_limit(fastest);
  if (fronts_known || !(limits > LONG)) return;
  const bool melts = std::any_of(fields.begin(), fields.end(), [](const auto &field) {
    return field->conducts() && field->melts();
  });
  if (!melts) return;
  int mine = 0, any;
  for (const auto &field : fields) mine |= field->conducts() && field->has_front();
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  if (!any) return;
  fronts_known = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/heat {}: material melts or freezes, and conduction in a step of {:.4g} "
                   "is {:.4g} of its explicit limits long: points take the heat of fusion at the "
                   "end of it, so that the front may be some 5 % off its place with 3 limits, 15 % "
                   "with 12: use steps of at most {:.4g}, or see that shorter ones change nothing",
                   id, dt_last, limits, dt_last / limits);
}

double MPMHeatFlow::stable_dt(const MPMField &field, tagint &tag) const
{
  // other exchange is at most as fast as conduction
  if (solver) return std::numeric_limits<double>::max();
  const auto &conduction = in(field);
  const double rate = conduction.greatest_rate_of_points(tag);
  const double others = (double) contacts.size() + (surfaces.empty() ? 0.0 : 1.0);
  return MPMSuperStep::reach(options.most_stages) *
      MPMSuperStep::explicit_limit(
             (1.0 + others) * rate +
             conduction.faces.expected_rate(rate, conduction.least_capacity)) /
      std::max(options.every, 1);
}

/* ----------------------------------------------------------------------
   heat that has come in so far, and the power in the last conduction
------------------------------------------------------------------------- */

double MPMHeatFlow::heat_came() const
{
  double mine = totals.through_faces + totals.of_sources, all;
  for (int k = 0; k < NGIVER; k++) mine += totals.given[k] + totals.booked[k];
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

const std::vector<double> &MPMHeatFlow::powers()
{
  if (!power_known) {
    MPI_Allreduce(in_step.data(), power.data(), (int) power.size(), MPI_DOUBLE, MPI_SUM, world);
    for (double &p : power) p /= dt_last;
    power_known = true;
  }
  return power;
}

void MPMHeatFlow::write_restart(FILE *fp)
{
  keep_totals(world, &totals.through_faces, sizeof(Totals) / sizeof(double));
  powers();
  if (comm->me) return;
  const double length = (double) power.size();
  const int size = sizeof(Totals) + sizeof(waited) + (1 + power.size()) * sizeof(double);
  fwrite(&size, sizeof(int), 1, fp);
  fwrite(&totals, sizeof(Totals), 1, fp);
  fwrite(&waited, sizeof(waited), 1, fp);
  fwrite(&length, sizeof(double), 1, fp);
  fwrite(power.data(), sizeof(double), power.size(), fp);
}

/** The power is that of the last conduction until the next one; with other surfaces or contacts, it
 *  belongs to the old ones. */
void MPMHeatFlow::restart(const char *buf)
{
  if (comm->me == 0) memcpy(&totals, buf, sizeof(Totals));
  buf += sizeof(Totals);
  memcpy(&waited, buf, sizeof(waited));
  buf += sizeof(waited);
  double length;
  memcpy(&length, buf, sizeof(double));
  if (length == (double) power.size())
    memcpy(power.data(), buf + sizeof(double), power.size() * sizeof(double));
}

double MPMHeatFlow::memory_usage() const
{
  double bytes = steps.memory_usage() + source_values.capacity() * sizeof(double);
  if (solver) bytes += solver->memory_usage();
  for (const auto &field : fields) bytes += field->memory_usage();
  for (const auto &body : bodies) bytes += body->memory_usage();
  for (const auto &contact : contacts) bytes += contact->memory_usage();
  for (const auto &surface : surfaces) bytes += surface->memory_usage();
  return bytes;
}
