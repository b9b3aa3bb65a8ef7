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
#include "contact/fix_mpm_contact.h"
#include "contact/mpm_leaks.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "input.h"
#include "refine/fix_mpm_refine.h"
#include "refine/mpm_two_scale.h"
#include "region.h"
#include "update.h"
#include "variable.h"

#include <algorithm>
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
    options.each_condition([this](MPMHeatCondition &c, const std::string &) {
      for (int k = 0; k < c.nvalue(); k++) c.now[k] = evaluate(lmp, c.value[k]);
    });
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

/** Called before temperatures go to nodes, as surfaces have sums over points of their own. */
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

// Temperatures of nodes, and the number of stages that all fields need for their step.

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

  limit = MPMSuperStep::explicit_limit(greatest);
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
    field->faces.add_rates(false, field->temperature, field->rate, present);
  }
  for (auto &levels : refined) levels->rates_from_parents();
  exchange(false, present);
}

/** Heat through surfaces and contacts. changes: temperatures are small changes. Rates must include
 *  all other heat already. */
void MPMHeatFlow::exchange(bool changes, Heats &to)
{
  if (contacts.empty() && surfaces.empty()) return;
  for (auto &body : bodies)
    if (body->conduction) body->begin_stage();
  for (std::size_t k = 0; k < contacts.size(); k++) contacts[k]->exchange(to[contact_places() + k]);
  for (const auto &surface : surfaces) surface->exchange(changes, to.data() + surface_places());
  for (auto &body : bodies) {
    if (!body->conduction) continue;
    body->end_stage();
    body->conduction->faces.hold_rates(body->conduction->rate, to);
  }
}

/** The same equations in implicit steps. */
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
  Heats nowhere(n());
  for (auto *part : parts) {
    part->find_rates(nullptr, nowhere);
    part->faces.add_rates(true, part->temperature, part->rate, nowhere);
  }
  exchange(true, nowhere);
}

void MPMHeatFlow::project(int part, std::vector<double> &change)
{
  Heats nowhere(MPMHeatFaces::NFACE + 1);
  parts[part]->faces.hold_rates(change, nowhere);
}

void MPMHeatFlow::each_term(int k, double dt, const Term &use)
{
  parts[k]->each_term(use);
  each_surface_term(*parts[k], dt, use);
}

void MPMHeatFlow::add_diagonal(int k, double dt, std::vector<double> &diagonal)
{
  const Term add = [&](int n, const int64_t *nodes, int ngrad, const double *G, const double *K) {
    add_diagonal_of(n, nodes, ngrad, G, K, diagonal);
  };
  if (const auto *matrix = parts[k]->kept_matrix())
    for (std::size_t i = 0; i < diagonal.size(); i++) diagonal[i] += matrix->diagonal(i);
  else
    parts[k]->each_term(add);
  each_surface_term(*parts[k], dt, add);
}

/** Visits the terms of faces, surfaces, and contacts of a part. */
void MPMHeatFlow::each_surface_term(const MPMConduction &part, double dt, const Term &use) const
{
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
    field->expect_rates(std::numeric_limits<int>::max());
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

/** Heat of what points of different materials keep at different rates (transfer relax) goes to all
 *  points of their nodes. */
void MPMHeatFlow::let_faster_points_go()
{
  const auto add = [](MPMConduction &field) {
    for (std::size_t k = 0; k < field.rate.size(); k++) field.temperature[k] += field.rate[k];
  };
  for (auto &field : fields) {
    if (!field->conducts() || levels_with(*field) || !field->has_faster()) continue;
    field->find_faster();
    add(*field);
  }
  for (auto &levels : refined) {
    const auto is_part = [&](const auto &field) {
      return field->conducts() && levels->has(*field);
    };
    if (std::none_of(fields.begin(), fields.end(), [&](const auto &field) {
          return is_part(field) && field->has_faster();
        }))
      continue;
    for (auto &field : fields)
      if (is_part(field)) field->find_faster();
    levels->sum_rates();
    for (auto &field : fields)
      if (is_part(field)) add(*field);
    levels->temperatures_from_parents();
  }
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
    advance(stages);
  let_faster_points_go();
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
  std::string state;
  state.append((const char *) &totals, sizeof(Totals));
  state.append((const char *) &waited, sizeof(waited));
  state.append((const char *) &length, sizeof(double));
  state.append((const char *) power.data(), power.size() * sizeof(double));
  write_state(fp, state.data(), state.size());
}

/** The power is that of the last conduction until the next one; with other surfaces or contacts, it
 *  belongs to the old ones. */
void MPMHeatFlow::restart(const std::string &id, const char *buf)
{
  constexpr std::size_t FIXED = sizeof(Totals) + sizeof(waited) + sizeof(double);
  const auto state = read_state(lmp, id, buf);
  if (state.size() < FIXED) refuse_state(lmp, id);
  buf = state.data();
  if (comm->me == 0) memcpy(&totals, buf, sizeof(Totals));
  buf += sizeof(Totals);
  memcpy(&waited, buf, sizeof(waited));
  buf += sizeof(waited);
  double length;
  memcpy(&length, buf, sizeof(double));
  if ((double) state.size() != FIXED + length * sizeof(double)) refuse_state(lmp, id);
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

// Start of a run: conditions, bodies that touch, and bodies on several lattices

/** Constant of Stefan and Boltzmann in the units of the input; 0 where these have no kelvins. */
double MPMHeatFlow::sigma() const
{
  struct {
    const char *name;
    double energy, time, length;    // in SI units
  } const units[] = {{"si", 1.0, 1.0, 1.0},
                     {"cgs", 1.0e-7, 1.0, 1.0e-2},
                     {"micro", 1.0e-15, 1.0e-6, 1.0e-6},
                     {"nano", 1.0e-21, 1.0e-9, 1.0e-9},
                     {"metal", 1.602176634e-19, 1.0e-12, 1.0e-10},
                     {"real", 4184.0 / 6.02214076e23, 1.0e-15, 1.0e-10},
                     {"electron", 4.3597447222071e-18, 1.0e-15, 0.529177210903e-10}};
  for (const auto &u : units)
    if (!strcmp(update->unit_style, u.name))
      return 5.670374419e-8 * u.time * u.length * u.length / u.energy;
  return 0.0;
}

void MPMHeatFlow::check_condition(MPMHeatCondition &c, const std::string &name)
{
  if (c.kind == MPMHeatCondition::RADIATION && sigma() == 0.0)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/heat {} radiation needs temperatures in kelvins, which units {} do not "
               "have: use units si, cgs, micro, nano, metal, real, or electron",
               name, update->unit_style);
  for (int k = 0; k < c.nvalue(); k++) find_variable(lmp, c.value[k], "fix mpm/heat " + name);
}

/** Bodies on several lattices: conduction on the nodes of each lattice alone would be wrong at the
 *  rims. */
void MPMHeatFlow::init_levels(const MPMPlan &plan)
{
  refined.clear();
  for (const auto *fix : find_fixes<FixMPMRefine>(lmp)) {
    std::vector<MPMHeatLevels::Pair> lattices;
    int count = 0, all = 0;
    for (auto *field : plan.fields) {
      if (!fix->has(field->id())) continue;
      all++;
      count += in(*field).conducts();
    }
    if (count == 0) continue;
    if (count < all)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat {}: the fields of fix mpm/refine {} are one body, but the materials "
                 "of some of them conduct heat and those of others do not: give all of them the "
                 "part 'thermal conducting'",
                 id, fix->id);
    const auto refuse = [&](bool broken, const std::string &what, const std::string &remedy) {
      if (broken)
        error->all(
            FLERR, Error::NOLASTLINE,
            "Fix mpm/heat {}: {} does not go with bodies on several lattices, fix mpm/refine "
            "{}: {}",
            id, what, fix->id, remedy);
    };
    refuse(solver != nullptr, "time euler and sdirk2", "use time explicit");
    refuse(options.transfer.kind == MPMHeatTransfer::XPIC, "transfer xpic",
           "use relax, affine, or pic");
    refuse(!options.surfaces.empty(), "heat through surfaces and regions",
           "use conditions on faces of the box, or a source");
    refuse(options.grains, "grains yes", "leave it out");
    refuse(options.penalty, "penalty yes", "leave it out");
    refuse(options.every > 1 && has_friction, "every with heat of friction", "use every 1");
    refuse(std::any_of(options.pairs.begin(), options.pairs.end(),
                       [fix](const auto &p) {
                         return fix->has(p.field[0]) || fix->has(p.field[1]);
                       }),
           "contact",
           "leave it out, as heat goes from one body to another one at nodes of one lattice");
    for (const auto &two : fix->lattices()) {
      auto &coarse = in(two->coarse), &fine = in(two->fine);
      const bool weighs = coarse.faces.any() && weighs_faces(two->coarse);
      lattices.push_back({two.get(), &coarse, &fine, weighs ? &body_in(two->coarse) : nullptr,
                          weighs ? &body_in(two->fine) : nullptr});
    }
    refined.push_back(std::make_unique<MPMHeatLevels>(lmp, lattices));
  }
}

MPMHeatLevels *MPMHeatFlow::levels_with(const MPMConduction &one) const
{
  for (const auto &levels : refined)
    if (levels->has(one)) return levels.get();
  return nullptr;
}

MPMHeatBody &MPMHeatFlow::body_in(const MPMField &field)
{
  for (auto &body : bodies)
    if (&body->field == &field) return *body;
  auto &conduction = in(field);
  bodies.push_back(std::make_unique<MPMHeatBody>(lmp, conduction.field,
                                                 conduction.conducts() ? &conduction : nullptr));
  return *bodies.back();
}

/** Finds bodies that touch: they hide free surfaces of each other, even if they do not conduct. */
void MPMHeatFlow::find_neighbors()
{
  if (std::none_of(options.surfaces.begin(), options.surfaces.end(), [](const auto &s) {
        return s.region.empty();
      }))
    return;
  const auto contacts = find_fixes<FixMPMContact>(lmp);
  for (auto &surface : surfaces)
    for (auto &field : fields) {
      const auto &mine = surface->body.field, &other = field->field;
      if (std::any_of(contacts.begin(), contacts.end(), [&](auto *fix) {
            return fix->couples(mine.id(), other.id());
          }))
        surface->neighbors.push_back(&body_in(other));
    }
}

void MPMHeatFlow::init_contacts()
{
  for (auto &one : options.surfaces) {
    check_condition(one.condition, one.region.empty() ? "surface" : "region " + one.region);
    if (one.region.empty()) continue;
    auto *region = domain->get_region_by_id(one.region);
    if (!region)
      error->all(FLERR, Error::NOLASTLINE, "Fix mpm/heat region {} does not exist", one.region);
    if (MPMRegionSurface(region, domain->dimension).is_open())
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat cannot use region {}: open faces have no inside", one.region);
    if (region->dynamic_check() && region->nregion > 1)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat cannot use region {}: a union or intersection must not move; use "
                 "its parts one by one",
                 one.region);
  }
  for (auto &p : options.pairs) {
    const auto contacts = find_fixes<FixMPMContact>(lmp);
    if (std::none_of(contacts.begin(), contacts.end(), [&](auto *fix) {
          return fix->couples(p.field[0], p.field[1]);
        }))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat contact {} {}: there is no contact between two fix mpm with these "
                 "IDs: define a fix mpm/contact {} {}",
                 p.field[0], p.field[1], p.field[0], p.field[1]);
    find_variable(lmp, p.conductance, "fix mpm/heat contact");
  }
  bodies.clear();
  contacts.clear();
  surfaces.clear();
  for (auto &field : fields)
    if (!options.surfaces.empty() && field->conducts())
      surfaces.push_back(
          std::make_unique<MPMHeatSurfaces>(lmp, body_in(field->field), options.surfaces, sigma()));
  find_neighbors();
  for (auto &field : fields)
    if (field->conducts() && field->faces.any() && weighs_faces(field->field))
      body_in(field->field);
  for (const auto &p : options.pairs) {
    MPMHeatBody *body[2];
    for (int k = 0; k < 2; k++) {
      auto *const of = MPMField::find(lmp, p.field[k]);
      if (!of)
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/heat contact {} {}: there is no fix mpm with the ID {}", p.field[0],
                   p.field[1], p.field[k]);
      body[k] = &body_in(*of);
      const auto here = of->present_materials();
      bool any = false;
      for (std::size_t m = 0; m < here.size(); m++)
        any = any || (here[m] && of->materials[m]->material->conducts());
      if (!any)
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/heat contact {} {}: no material of fix mpm {} conducts heat: give it "
                   "the part 'thermal conducting', or remove the contact",
                   p.field[0], p.field[1], p.field[k]);
    }
    contacts.push_back(std::make_unique<MPMHeatContact>(lmp, *body[0], *body[1], p));
  }
}

void MPMHeatFlow::extend_topology(MPMField &field)
{
  in(field).extend_topology();
  for (auto &surface : surfaces)
    if (&surface->body.field == &field) surface->extend_topology();
  for (auto &contact : contacts) contact->extend_topology(field);
}

void MPMHeatFlow::topology_changed(MPMField &field)
{
  in(field).faces.topology_changed();
  in(field).find_points(bodies.empty() && !levels_with(in(field)));
  for (auto &body : bodies) body->topology_changed();
  for (auto &surface : surfaces) surface->topology_changed();
  for (auto &contact : contacts) contact->topology_changed();
}

/** Are nodes needed that no point reaches? Conduction alone needs none, but lines through surfaces
 *  do. */
bool MPMHeatFlow::looks_beyond_points() const
{
  return !bodies.empty() || std::any_of(fields.begin(), fields.end(), [](const auto &field) {
    return field->has_materials() && (field->faces.any() || field->looks_beyond_points());
  });
}

MPMConduction &MPMHeatFlow::in(const MPMField &field) const
{
  for (const auto &mine : fields)
    if (&mine->field == &field) return *mine;
  error->all(FLERR, Error::NOLASTLINE, "Fix mpm/heat does not know fix mpm {}", field.id());
  return *fields[0];
}

/** Checks the values of variables by the same rules as numbers in the input. */
void MPMHeatFlow::check_values() const
{
  const auto refuse = [&](bool wrong, const std::string &where, const MPM_NS::NumberOrVariable &v,
                          double now, const char *needed) {
    if (wrong)
      error->all(FLERR, Error::NOLASTLINE, "Fix mpm/heat {}: {} = {:.6g}, but it must {}", where,
                 v.variable.empty() ? "the value" : "variable " + v.variable, now, needed);
  };
  const bool absolute = options.radiates();
  const auto check = [&](const MPMHeatCondition &c, const std::string &where) {
    const int T = c.kind == MPMHeatCondition::TEMPERATURE ? 0
        : c.kind == MPMHeatCondition::CONVECTION          ? 1
                                                          : -1;
    if (absolute && T >= 0)
      refuse(!(c.now[T] >= 0.0), where, c.value[T], c.now[T],
             "be an absolute temperature, not below 0, where something radiates");
    if (c.kind < MPMHeatCondition::CONVECTION) return;
    refuse(!(c.now[0] >= 0.0), where, c.value[0], c.now[0], "not be negative");
    if (c.kind != MPMHeatCondition::RADIATION) return;
    refuse(c.now[0] > 1.0, where, c.value[0], c.now[0], "not be above 1");
    refuse(!(c.now[1] >= 0.0), where, c.value[1], c.now[1],
           "be an absolute temperature, not below 0");
  };
  options.each_condition(check);
  for (const auto &p : options.pairs)
    refuse(!(p.now >= 0.0), fmt::format("contact {} {}", p.field[0], p.field[1]), p.conductance,
           p.now, "not be negative");
}
