/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "pore/mpm_pore_flow.h"

#include "atom.h"
#include "base/mpm_options.h"
#include "base/mpm_pair_styles.h"
#include "base/mpm_points.h"
#include "base/mpm_state.h"
#include "comm.h"
#include "contact/mpm_leaks.h"
#include "contact/pair_mpm_penalty.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "force.h"
#include "implicit/fix_mpm_implicit.h"
#include "input.h"
#include "material/material.h"
#include "math_const.h"
#include "update.h"
#include "variable.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// longest wait for the next flow: node spacings that waves travel, and explicit limits of the flow
static constexpr double MOST_SPACINGS = 2.5, MOST_LIMITS = 10.0;
// points that are farther apart than this many node spacings are as stiff as a lattice can be;
// their waves have the frequency 2/crossing
static constexpr double FINE = 0.6;
// root of the mean square of slopes of points in layers (MPMPore::Layers), equal to the frequency
// of their waves times crossing; the lattice damps waves up to this frequency in MOST_SPACINGS
static constexpr double SLOW = 1.45;
// longest wait with auto, over the time in which flow crosses a layer that is so thin that the
// pressure changes across it by all of its range: in explicit limits it is 6 THIN times the square
// of the thickness in node spacings
static constexpr double THIN = 0.02;
// factor within which times are equal on paper, as sums of ranks differ by round-off
static constexpr double NEARLY = 1.0 + 1.0e-6;

MPMPoreFlow::MPMPoreFlow(LAMMPS *lmp, MPMPoreOptions &options, MPMPorePoints &points,
                         const std::string &id) :
    Pointers(lmp),
    watch(lmp, options, points, *this, id), options(options), points(points)
{
  for (auto *list : {&came, &in_step, &present, &flows})
    list->assign(MPMPoreSurface::NPART + 1, 0.0);
}

void MPMPoreFlow::clear()
{
  fields.clear();
  wet.clear();
  steps.clear();
  steps.add(in_step, present);
}

MPMPore &MPMPoreFlow::add(MPMField &field)
{
  fields.push_back(std::make_unique<MPMPore>(lmp, field, options.water, options.conditions, gravity,
                                             options.relax,
                                             options.formulation == MPMPoreOptions::U_V_P));
  return *fields.back();
}

void MPMPoreFlow::add_wet(MPMPore &field)
{
  wet.push_back(&field);
  steps.add(field.nodes.value, field.nodes.rate);
}

void MPMPoreFlow::take_motion(MPMField &field)
{
  if (step_flows) in(field).take_motion(waited.time + field.step_dt());
}

bool MPMPoreFlow::needs_each_step() const
{
  const bool differs =
      std::any_of(options.soils.begin(), options.soils.end(), [](const auto &soil) {
        return soil.law == MPMPoreSoil::FORMULA || !soil.is_linear();
      });
  const bool varies =
      std::any_of(options.conditions.begin(), options.conditions.end(), [](const auto &c) {
        return !c.value.variable.empty();
      });
  return options.formulation == MPMPoreOptions::U_V_P || options.can_dry() || options.warms() ||
      options.sets_relax || differs || varies ||
      options.conditions[MPMPoreSurface::FREE].kind != MPMPoreCondition::CLOSED ||
      !find_fixes<FixMPMImplicit>(lmp).empty();
}

/** Ends a wait if water flows in each step from now on. The run before, or that of a restart file,
 *  may have ended between two flows: then points get all of their pressure, and the next flow also
 *  covers the time of the wait. */
void MPMPoreFlow::end_wait()
{
  for (int i = 0; i < atom->nlocal && options.can_wait(); i++) {
    const bool changed = waited.steps > 0.0 && points.since[i] > 0.0 && atom->vfrac[i] > 0.0;
    const MPMPoreSoil *const soil = changed ? soil_of(i) : nullptr;
    if (soil)
      points.pressure[i][0] +=
          soil->undrained(points.since[i], MPMPoints::get(atom)->jacobian(i), options.water);
    points.since[i] = 0.0;
  }
  waited.steps = 0.0;
  if (!is_implicit) return;
  // explicit steps that follow start afresh
  waited.time = 0.0;
  rates_known = false;
  thinned = std::numeric_limits<double>::max();
}

void MPMPoreFlow::find_crossing()
{
  crossing = std::numeric_limits<double>::max();
  const double unit = force->mvv2e * force->nktv2p;
  for (const auto *mine : wet)
    for (const auto *fix : mine->field.materials)
      for (const auto &soil : options.soils) {
        if (soil.material != fix->id) continue;
        const double stiff = soil.storage_at(1.0, options.water) * fix->material->density() * unit;
        crossing = std::min(crossing, mine->field.lattice.h * sqrt(stiff) / soil.biot);
      }
}

MPMPore &MPMPoreFlow::in(const MPMField &field) const
{
  for (const auto &mine : fields)
    if (&mine->field == &field) return *mine;
  error->all(FLERR, Error::NOLASTLINE, "Fix mpm/pore does not know fix mpm {}", field.id());
  return *fields[0];
}

void MPMPoreFlow::evaluate_variables()
{
  weight.find(gravity);
  const bool formulas =
      std::any_of(options.soils.begin(), options.soils.end(), [](const auto &soil) {
        return soil.law == MPMPoreSoil::FORMULA;
      });
  bool any = formulas;
  for (const auto &c : options.conditions) any = any || !c.value.variable.empty();
  evaluate_in_step(lmp, any, [&] {
    for (auto &c : options.conditions) {
      c.now = evaluate(lmp, c.value);
      if (c.kind == MPMPoreCondition::RAIN && c.now < 0.0)
        error->all(FLERR, Error::NOLASTLINE, "Fix mpm/pore {} rain is {}: it must not be negative",
                   MPMPoreOptions::PART_NAME[&c - options.conditions.data()], c.now);
    }
    if (!formulas) return;
    formula_values.assign(atom->nmax, 0.0);
    std::vector<double> values(atom->nmax);
    for (const auto &soil : options.soils) {
      if (soil.law != MPMPoreSoil::FORMULA) continue;
      const int index = input->variable->find(soil.formula.c_str() + 2);
      input->variable->compute_atom(index, 0, values.data(), 1, 0);
      for (int i = 0; i < atom->nlocal; i++) {
        const auto *const soil_here = soil_of(i);
        if (!soil_here || soil_here->material != soil.material) continue;
        if (!(values[i] >= 0.0) || !std::isfinite(values[i]))
          error->one(FLERR, "Variable {} for fix mpm/pore soil {} is {} at point {}",
                     soil.formula.substr(2), soil.material, values[i], atom->tag[i]);
        formula_values[i] = values[i];
      }
    }
  });
}

void MPMPoreFlow::weigh_points()
{
  if (!options.can_dry()) return;
  for (const auto &mine : fields) mine->weigh_points(points.pressure);
}

/** Is there flow in the step that begins? With auto, flow takes one stage, which costs least and is
 *  as exact as flow in each step even where the soil is soft compared with its water and drains
 *  through a curved surface. */
bool MPMPoreFlow::is_time_to_flow() const
{
  if (!options.waits() || !rates_known ||
      (options.every != MPMPoreOptions::AUTO && waited.steps + 1.0 >= options.every))
    return true;
  const double limit = MPMSuperStep::explicit_limit(conducted + exchanged);
  double most = std::min(longest_wait(), std::min(MOST_LIMITS, longest_flow()) * limit);
  if (options.every == MPMPoreOptions::AUTO)
    most = std::min({most, limit, thinned > 0.0 ? THIN / thinned : limit});
  return waited.time + 2.0 * fields[0]->field.step_dt() > most * NEARLY;
}

/** Flow that starts and stops makes waves, whose length is the distance that waves travel in
 *  between. The lattice damps those of up to some node spacings; longer ones grow with each flow.
 *  In between, points have pressures of their own, of which a flow keeps only what nodes see. A
 *  wave that nodes do not see grows if it has turned by more than half of its period by then. For
 *  points that are a node spacing apart its frequency is 2/crossing; with closer points none is
 *  above 1.4/crossing, for which the former bound is enough, together with the damping of such
 *  waves by transfers of velocities. */
double MPMPoreFlow::longest_wait() const
{
  if (!coarse) return MOST_SPACINGS * crossing;
  const double dt = fields[0]->field.step_dt();
  const double turns = 2.0 * asin(std::min(1.0, dt / crossing));    // in a step
  return dt * std::floor(MathConst::MY_PI / turns * NEARLY);
}

/** Number of stages. One is enough up to the explicit limit if steps of the motion are shorter than
 *  half of it (see mpm_pore.cpp). */
int MPMPoreFlow::count_stages(double duration, double limit) const
{
  const bool one = duration <= 0.5 * limit || (waited.steps > 0.0 && duration <= limit * NEARLY);
  return one ? 1 : std::max(3, MPMSuperStep::count(duration, limit, options.most_stages));
}

/** The same with or without flow. */
void MPMPoreFlow::begin(bool with_flow)
{
  watch.look_for_leaks();
  if (with_flow || !gradients_known) evaluate_variables();
  const double *const formula = formula_values.empty() ? nullptr : formula_values.data();
  for (auto *field : wet) {
    if (field->motion) field->motion->begin_step(points.inertia);
    if (!gradients_known) field->find_gradients(points.pressure, formula);
    if (with_flow) field->begin_step(points.pressure, points.inertia, formula, waited.steps > 0.0);
    if (!with_flow) field->begin_wait(points.pressure);
  }
  if (with_flow) watch.watch_inertia();
  if (with_flow) watch.look_for_shut_pores();
  gradients_known = true;
}

void MPMPoreFlow::find_greatest_rates()
{
  double mine[3] = {0.0, 0.0, 0.0}, all[3];
  for (const auto *field : wet) {
    mine[0] = std::max(mine[0], field->conduction_rate());
    mine[1] = std::max(mine[1], field->exchange_rate());
    mine[2] = std::max(mine[2], field->widest_spacing());
  }
  MPI_Allreduce(mine, all, 3, MPI_DOUBLE, MPI_MAX, world);
  conducted = all[0];
  exchanged = all[1];
  if (options.waits()) find_coarse_points(all[2]);
  rates_known = true;
}

/** Finds how thin layers are from the pressures after a flow, see THIN. */
void MPMPoreFlow::find_thin_layers()
{
  MPMPore::Slopes mine, all;
  for (const auto *field : wet) field->add_slopes(points.pressure, mine);
  MPI_Allreduce(&mine, &all, sizeof(mine) / sizeof(double), MPI_DOUBLE, MPI_MAX, world);
  const double range = all.highest + all.less;
  thinned = range > 0.0 ? all.steepest / (range * range) : 0.0;
}

/** Finds whether points are coarse: wide, or in layers that are a node spacing apart along one axis
 *  and close along another. */
void MPMPoreFlow::find_coarse_points(double widest)
{
  coarse = widest > FINE;
  for (const auto *field : wet) {
    const auto &soils_here = field->layers_of_points();
    std::vector<double> mine, all;
    for (const auto &soil : soils_here) {
      mine.push_back(soil.volume);
      mine.insert(mine.end(), soil.steep, soil.steep + 3);
    }
    all.resize(mine.size());
    MPI_Allreduce(mine.data(), all.data(), static_cast<int>(mine.size()), MPI_DOUBLE, MPI_SUM,
                  world);
    for (std::size_t k = 0; k < all.size(); k += 4)
      for (int d = 1; d <= 3 && all[k] > 0.0; d++)
        coarse = coarse || all[k + d] > SLOW * SLOW * all[k];
  }
}

/** Finds the rates before the very first step. */
void MPMPoreFlow::find_first_rates()
{
  if (rates_known) return;
  auto *const plan = fields[0]->field.plan;
  plan->find_blocks_now();
  begin(true);
  find_greatest_rates();
  for (auto *field : plan->fields) field->map->valid = false;    // the step finds its own blocks
}

void MPMPoreFlow::advance()
{
  const double dt = waited.time + fields[0]->field.step_dt();
  if (!step_flows) {
    waited.steps++;
    waited.time = dt;
    return;
  }
  for (auto *field : wet) {
    if (!field->moves_first()) field->take_motion(dt);
    field->move_water();
  }
  // with inertia, flow is a part of waves, and these limit the step
  if (options.formulation == MPMPoreOptions::U_P) find_greatest_rates();
  const double limit = MPMSuperStep::explicit_limit(conducted + exchanged);
  const int stages = count_stages(dt, limit);
  if (options.formulation == MPMPoreOptions::U_P) watch.look_for_long_flow(dt, limit, waited.steps);
  watch.look_for_smoothing(dt);
  waited = {};
  if (stages > options.most_stages)
    error->all(FLERR, Error::NOLASTLINE,
               "The time step {:.6g} is {:.4g} times the explicit limit {:.4g} of the flow of pore "
               "water, which needs more than {} stages: use fix mpm/dt, a smaller timestep, or fix "
               "mpm/pore ... stages{}",
               dt, dt / limit, limit, options.most_stages,
               options.can_dry()
                   ? "; where the last pores fill in a soil with retention, use a smaller bulk "
                     "modulus of the water, K"
                   : "");
  std::fill(in_step.begin(), in_step.end(), 0.0);
  steps.advance(stages, dt, [this]() {
    std::fill(present.begin(), present.end(), 0.0);
    for (auto *field : wet) field->find_rates(present);
  });
  for (auto *field : wet) field->end_step(points.pressure, dt);
  if (options.waits()) find_thin_layers();
  for (std::size_t k = 0; k < came.size(); k++) came[k] += in_step[k];
  dt_last = dt;
  flows_known = false;
}

void MPMPoreFlow::take_solution()
{
  const double dt = fields[0]->field.step_dt();
  std::fill(present.begin(), present.end(), 0.0);
  for (auto *field : wet) field->take_solution(present);
  for (auto *field : wet) field->end_step(points.pressure, dt);
  for (std::size_t k = 0; k < came.size(); k++) came[k] += in_step[k] = dt * present[k];
  dt_last = dt;
  flows_known = false;
}

double MPMPoreFlow::stable_dt(const MPMField &field, tagint &tag) const
{
  if (options.formulation == MPMPoreOptions::U_V_P) return std::numeric_limits<double>::max();
  const_cast<MPMPoreFlow *>(this)->find_first_rates();
  const double rate = in(field).conduction_rate(points.pressure, tag);
  if (rate < 0.0) return std::numeric_limits<double>::max();
  const double limit = MPMSuperStep::explicit_limit(std::max(rate, conducted) + exchanged);
  return longest_flow() * limit;
}

double MPMPoreFlow::pressure_now(int i) const
{
  if (waited.steps == 0.0) return points.pressure[i][0];
  for (const auto *mine : wet)
    if (mine->field.is_point(i)) return points.pressure[i][0] + mine->undrained(i);
  return points.pressure[i][0];
}

const MPMPoreSoil *MPMPoreFlow::soil_of(int i) const
{
  for (const auto *mine : wet)
    if (mine->field.is_point(i)) return mine->soil_of(i);
  return nullptr;
}

double MPMPoreFlow::volume_came() const
{
  double mine = 0.0, all;
  for (int part = 0; part < MPMPoreSurface::NPART; part++) mine += came[part];
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double MPMPoreFlow::inflow(int part)
{
  if (!flows_known) {
    MPI_Allreduce(in_step.data(), flows.data(), MPMPoreSurface::NPART, MPI_DOUBLE, MPI_SUM, world);
    for (double &flow : flows) flow /= dt_last;
    flows_known = true;
  }
  return flows[part];
}

void MPMPoreFlow::write_restart(FILE *fp, bool has_state)
{
  write_totals(fp, world, came,
               {gradients_known ? 1.0 : 0.0, has_state ? 1.0 : 0.0, rates_known ? 1.0 : 0.0,
                conducted, exchanged, coarse ? 1.0 : 0.0, waited.steps, waited.time, thinned});
}

bool MPMPoreFlow::restart(const std::string &id, const char *buf)
{
  const auto *const list =
      (const double *) read_state(lmp, id, buf, (came.size() + 9) * sizeof(double));
  const double *const same = list + came.size();
  if (comm->me == 0) std::copy_n(list, came.size(), came.begin());
  gradients_known = same[0] != 0.0;
  rates_known = same[2] != 0.0;
  conducted = same[3];
  exchanged = same[4];
  coarse = same[5] != 0.0;
  waited = {same[6], same[7]};
  thinned = same[8];
  return same[1] != 0.0;
}

double MPMPoreFlow::memory_usage() const
{
  double bytes = steps.memory_usage() + formula_values.capacity() * sizeof(double);
  for (const auto &field : fields) bytes += field->memory_usage();
  return bytes;
}

MPMPoreWatch::MPMPoreWatch(LAMMPS *lmp, const MPMPoreOptions &options, const MPMPorePoints &points,
                           const MPMPoreFlow &flow, const std::string &id) :
    Pointers(lmp),
    options(options), points(points), flow(flow), id(id)
{
}

void MPMPoreWatch::start(bool neglects_inertia)
{
  watched.points = -1;    // velocities may have been set since the last run
  watched.flows = 0;
  measures_inertia = neglects_inertia && !inertia_known;
}

void MPMPoreWatch::look_for_leaks()
{
  if (leaks_known) return;
  leaks_known = true;
  for (auto *mine : flow.wet) {
    const auto &all = mine->field.materials;
    if (std::all_of(all.begin(), all.end(), [&](const auto *material) {
          return options.has(material->id);
        }))
      continue;
    const auto leaks = find_leaks(mine->field, world, [&](const FixMPMMaterial *material) {
      return options.has(material->id);
    });
    if (leaks.nodes && comm->me == 0)
      error->warning(
          FLERR,
          "Fix mpm/pore: material without water is so thin that water leaks through it, at {} "
          "nodes "
          "of fix mpm {}, one of them at {:.6g} {:.6g} {:.6g}: let it have three node spacings",
          leaks.nodes, mine->field.id(), leaks.first[0], leaks.first[1], leaks.first[2]);
  }
}

void MPMPoreWatch::look_for_shut_pores()
{
  if (shut_known) return;
  tagint mine = MAXTAGINT, lowest;
  for (const auto *field : flow.wet) mine = std::min(mine, field->shut_point());
  MPI_Allreduce(&mine, &lowest, 1, MPI_LMP_TAGINT, MPI_MIN, world);
  if (lowest == MAXTAGINT) return;
  shut_known = true;
  double here[2] = {0.0, 0.0}, worst[2];
  for (int i = 0; mine == lowest && i < atom->nlocal; i++)
    if (atom->tag[i] == lowest) {
      here[0] = MPMPoints::get(atom)->jacobian(i);
      here[1] = flow.soil_of(i)->shut();
    }
  MPI_Allreduce(here, worst, 2, MPI_DOUBLE, MPI_MAX, world);
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/pore: the pores of point {} are shut: it has {:.4g} of its initial volume, while "
        "the "
        "grains alone have {:.4g}, 1 - n0: use a law that becomes stiff before pores close, or "
        "check n0, the stiffness of the soil, and its load",
        lowest, worst[0], worst[1]);
}

void MPMPoreWatch::look_for_long_flow(double duration, double limit, double steps)
{
  if (long_known || options.every == MPMPoreOptions::AUTO || steps == 0.0 ||
      duration <= limit * NEARLY ||
      options.conditions[MPMPoreSurface::FREE].kind == MPMPoreCondition::CLOSED)
    return;
  long_known = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/pore every {}: {} steps have one flow, for {:.3g} times its explicit "
                   "limit: curved surfaces of soft soil drain too fast then, by 1 to 2 % of the "
                   "pressure: use every auto",
                   options.every, steps + 1.0, duration / limit);
}

void MPMPoreWatch::look_for_smoothing(double duration)
{
  constexpr double MUCH = 0.02, OF_FLOW = 0.2;
  if (smooth_known) return;
  MPMPore::Smoothing most = {0.0, 0.0};
  for (const auto *mine : flow.wet) {
    const auto here = mine->smoothing(duration);
    if (here.share * here.over_flow > most.share * most.over_flow) most = here;
  }
  smoothed += most.share;
  if (smoothed < MUCH || most.over_flow < OF_FLOW) return;
  smooth_known = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/pore {}: pressures that vary over {} node spacings have lost {:.0f} % "
                   "to {}, {:.2g} times what flow has taken, and become too even in a long run: "
                   "use {}, a smaller spacing, or fix mpm/implicit",
                   id, MPMPore::Smoothing::WAVELENGTH, 100.0 * smoothed,
                   options.waits() ? "every" : "relax", most.over_flow,
                   options.waits() ? "every 1 and a small relax" : "a smaller relax");
}

void MPMPoreWatch::watch_inertia()
{
  constexpr int EACH = 4;
  if (!measures_inertia || watched.flows++ % EACH) return;
  MPMPore::Inertia mine, all;
  for (const auto *field : flow.wet) mine.add(field->inertia(points.pressure));
  const double here[4] = {mine.velocity, mine.flow, mine.gradient, mine.kinetic};
  double sum[4];
  MPI_Allreduce(here, sum, 4, MPI_DOUBLE, MPI_SUM, world);
  all = {sum[0], sum[1], sum[2], sum[3]};
  const double now = update->atime + (update->ntimestep - update->atimestep) * update->dt,
               passed = now - watched.time;
  if (watched.points == atom->natoms && passed > 0.0) {
    const double rate = (sqrt(all.velocity) - sqrt(watched.last.velocity)) / passed;
    watched.left_out += rate * rate * passed;
    watched.flow += 0.5 * (all.flow + watched.last.flow) * passed;
    watched.gradient += 0.5 * (all.gradient + watched.last.gradient) * passed;
    watched.exchanged += fabs(all.kinetic - watched.last.kinetic);
  }
  watched.most = std::max(watched.most, all.kinetic);
  watched.last = all;
  watched.time = now;
  watched.points = atom->natoms;
}

/** The acceleration that u-p neglects matters if its part in the energy that the flow
 *  has dissipated is not small, and not small relative to the energy of the motion. Waves of a load
 *  that comes at once satisfy the latter, too, but slow flow then dissipates far more in the end.
 *  Ground that nearly rests has small accelerations relative to that of its weight, and runs that
 *  end before the motion has come to rest for the first time do not allow a judgment yet. Warns
 *  once. */
void MPMPoreWatch::look_at_inertia()
{
  constexpr double OF_FLOW = 0.03, OF_MOTION = 0.02, OF_WEIGHT = 1.0e-4, UP_AND_DOWN = 1.5,
                   FALLEN = 0.5;
  const double part = watched.left_out;
  const bool has_swung = watched.exchanged > UP_AND_DOWN * watched.most ||
      watched.last.kinetic < FALLEN * watched.most;
  if (inertia_known || !has_swung || !(part > OF_FLOW * watched.flow) ||
      !(part > OF_MOTION * watched.exchanged) || !(part > OF_WEIGHT * watched.gradient))
    return;
  inertia_known = true;
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/pore {}: formulation u-p leaves out the acceleration of the water, which in these "
        "runs is {:.0f} % of what drives its flow, in the root of the mean square: waves fade too "
        "fast, and fast flow is wrong: use formulation u-v-p",
        id, std::min(999.0, 100.0 * sqrt(part / watched.flow)));
}

void MPMPoreWatch::warn_of_contact() const
{
  if (comm->me || flow.wet.empty()) return;
  for (const auto &style : MPMPairStyle::all(*force)) {
    const auto *const penalty = dynamic_cast<const PairMPMPenalty *>(style.pair);
    if (penalty ? penalty->has_friction() : style.name.compare(0, 4, "gran") == 0)
      error->warning(
          FLERR,
          "Pair style {}: any friction on soils of fix mpm/pore {} is that of the total stress, "
          "with "
          "the pressure of the water: use fix mpm/contact, fix mpm/boundary with a region, or fix "
          "mpm/rigid, which know what water bears",
          style.name, id);
  }
}
