/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "step/fix_mpm_dt.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_options.h"
#include "base/mpm_state.h"
#include "base/mpm_step_limit.h"
#include "comm.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_time_limit.h"
#include "force.h"
#include "integrate.h"
#include "modify.h"
#include "neighbor.h"
#include "output.h"
#include "pair.h"
#include "step/mpm_grains.h"
#include "timer.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double ROUND_OFF = 1.0e-10;    // of times
static constexpr double SAME = 1.0e-9;          // of limits of the time step

/** Fix ID all mpm/dt FRACTION keyword value ... */
Options MPMDtOptions::declare()
{
  using namespace option;
  Options o("fix mpm/dt");
  o.argument(number(fraction, "fraction of h/(c+|v|)", {0.0, 2.0, false, true}));
  o.add("every", {integer(look_every, "N", POSITIVE, "set the time step every this many steps")});
  o.add("grow",
        {number(grow, "R", AT_LEAST_ONE, "",
                "largest factor by which the time step grows at a time")});
  o.add("min",
        {number(dt_min, "dt", POSITIVE, "time", "smallest time step; a smaller one is an error")})
      .standard("none");
  o.add("max", {number(dt_max, "dt", POSITIVE, "time", "largest time step")}).standard("none");
  o.add("strain",
        {number(strain, "S", POSITIVE, "",
                "largest relative change of the volume of a point in a step")})
      .standard("no limit");
  o.add("grains",
        {number(grains, "S", {0.0, 1.0, false, true}, "",
                "largest time step, as a share of the duration of a collision of grains")})
      .standard("no limit");
  o.add("until",
        {number(until, "T", POSITIVE, "time", "end the run exactly when this time has elapsed")})
      .standard("none");
  o.refuse([=] {
    return OptionRules{{dt_max > 0.0 && dt_min > dt_max, "min", "{min} is above max {max}"}};
  });
  return o;
}

FixMPMDt::FixMPMDt(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
{
  if (igroup != 0)
    error->all(FLERR, 1, "Fix mpm/dt looks at the points of all fix mpm: use group all");
  Options options = declare();
  read_options(lmp, options, narg, arg, 3);

  nevery = strain > 0.0 || grains > 0.0 || until > 0.0 ? 1 : look_every;

  time_depend = 1;    // as in fix dt/reset: the elapsed time must not lose its step
  scalar_flag = vector_flag = 1;
  size_vector = 5;
  global_freq = 1;
  extscalar = extvector = 0;
  restart_global = 1;
  comm_forward = 1;
  dynamic_group_allow = 1;
}

FixMPMDt::~FixMPMDt() = default;

void FixMPMDt::init()
{
  const auto limits = find_fixes<MPMStepLimit>(lmp);
  if (MPMField::all(lmp).empty() && find_fixes<MPMInternalForce>(lmp).empty() &&
      std::none_of(limits.begin(), limits.end(), [](const auto *one) {
        return one->makes_steps();
      }))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/dt needs a fix mpm, mpm/mesh, mpm/elements, or mpm/incompressible");
  for (auto *ifix : modify->get_fix_list()) {
    if (ifix == this) continue;
    const std::string other = ifix->style;
    if (other == "dt/reset" || other == "mpm/dt" || other == "smd/adjust_dt")
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix {} {} and fix {} {} both set the time step: remove one", style, id, other,
                 ifix->id);
  }
  if (grains > 0.0)
    collisions = std::make_unique<MPMGrains>(lmp, fmt::format("Fix mpm/dt {} grains", id));
}

/** The step in which the volume of a point would change by STRAIN, at the largest rate of the steps
 *  since the last look. A drop that is alone on the lattice breathes in a few steps: the rate of a
 *  single one of them may be that of a turning point. */
FixMPMDt::Limit FixMPMDt::strain_limit_local() const
{
  Limit mine = carried;
  if (strain == 0.0) return mine;
  for (const auto *field : MPMField::all(lmp)) {
    const auto &rate = field->time_limit->volume_rate;
    const double dt = strain / (rate.most * fraction * field->options.every);
    if (rate.most > 0.0 && dt < mine.dt) mine = {dt, 0.0, (double) rate.tag, NO_GRAIN};
  }
  return mine;
}

/** The smallest limit of all points of all fields, known to all ranks. */
FixMPMDt::Limit FixMPMDt::point_limit() const
{
  Limit mine = strain_limit_local();
  tagint tag = 0;
  double speed = 0.0;
  const auto compare = [&](double dt, int every = 1) {
    if (dt >= NO_POINTS.dt) return;
    dt /= every;
    if (!(dt > 0.0)) dt = 0.0;    // also NaN
    if (dt < mine.dt) mine = {dt, speed, (double) tag, NO_GRAIN};
  };
  for (auto *field : MPMField::all(lmp))
    compare(field->time_limit->stable_dt(tag, speed), field->options.every);
  for (const auto *body : find_fixes<MPMInternalForce>(lmp)) compare(body->stable_dt(tag, speed));
  speed = 0.0;
  for (const auto *other : find_fixes<MPMStepLimit>(lmp)) compare(other->stable_dt(tag));
  return smallest(mine);
}

double FixMPMDt::grain_dt(const Limit &limit) const
{
  return limit.other == NO_GRAIN ? NO_POINTS.dt : allowed(limit);
}

/** Grains that will touch before the next look count, too; longest: bound of the time step until
 *  then. At looks it is what points alone would allow, and not the time step of now, which a
 *  restart may change. */
FixMPMDt::Limit FixMPMDt::grain_limit(const Limit &points) const
{
  double longest = points.dt < NO_POINTS.dt ? fraction * points.dt : grow * wanted;
  if (dt_max > 0.0) longest = std::min(longest, dt_max);
  return grain_limit(points, longest);
}

FixMPMDt::Limit FixMPMDt::grain_limit(const Limit &points, double longest) const
{
  if (!collisions) return points;
  const auto fields = MPMField::all(lmp);    // all of the same every
  const int every = fields.empty() ? 1 : fields[0]->options.every;
  if (every > 1) comm->forward_comm(const_cast<FixMPMDt *>(this));
  const auto first = collisions->shortest(look_every * longest, every);
  const double dt = grains * first.duration / fraction;    // infinite without one
  return smallest(dt < points.dt ? Limit{dt, 0.0, (double) first.i, (double) first.j} : points);
}

/** Volumes, which ghosts do not have otherwise: those of points are positive. */
int FixMPMDt::pack_forward_comm(int n, int *list, double *buf, int, int *)
{
  for (int k = 0; k < n; k++) buf[k] = atom->vfrac[list[k]];
  return n;
}

void FixMPMDt::unpack_forward_comm(int n, int first, double *buf)
{
  std::copy(buf, buf + n, atom->vfrac + first);
}

FixMPMDt::Limit FixMPMDt::smallest(Limit mine) const
{
  struct {
    double dt;
    int rank;
  } local = {mine.dt, comm->me}, first;
  MPI_Allreduce(&local, &first, 1, MPI_DOUBLE_INT, MPI_MINLOC, world);
  MPI_Bcast(&mine, 4, MPI_DOUBLE, first.rank, world);
  return mine;
}

/** Start of a run: the time step is set at once, without limit to its growth. When the state is the
 *  one that the last run or the restart file left, then the time step is kept, so that a run in two
 *  parts takes the same steps as one without a break. The neighbor lists are new ones: pairs of
 *  grains that these have, and those at the end of the last run had not, do not make another state
 *  of it, but are looked at as whenever lists are new. */
void FixMPMDt::setup_pre_force(int)
{
  for (auto *field : MPMField::all(lmp)) field->time_limit->watch_volume = strain > 0.0;
  wanted = update->dt;
  const Limit points = point_limit();
  limit = grain_limit(points);
  ended = false;
  time_at_start = elapsed_time(*update);
  wall_at_start = platform::walltime();
  const double dt_grains = grain_dt(limit);
  const bool goes_on = continues && update->dt == dt_left &&
      fabs(allowed(points) - limit_left) <= SAME * limit_left &&
      dt_grains <= (1.0 + SAME) * grains_left;
  if (goes_on) {
    update->dt_default = 0;
    wanted = wanted_left;
    if (dt_grains < (1.0 - SAME) * grains_left && dt_grains < wanted) set_dt(dt_grains);
  } else if (limit.dt < NO_POINTS.dt)
    set_dt(fraction * limit.dt);
  else if (dt_max > 0.0 && !find_fixes<MPMFluid>(lmp).empty())
    set_dt(dt_max);    // of a fluid at rest
  if (until == 0.0) return;
  if (comm->me == 0 && update->nsteps > 0 && time_at_start > (1.0 + ROUND_OFF) * until)
    error->warning(FLERR, "Fix mpm/dt {}: until {:.6g} has passed: it is the time {:.6g}", id,
                   until, time_at_start);
  if (at_end())
    stop_run();
  else
    change_dt(fit_to_end(wanted, 2));    // output of the last one is asked for at the end of a step
}

/** A run ends as with fix halt. Its last steps are equal parts of the time that is left, and no
 *  longer than wanted; points that take one step in several of the run have moved at its end. */
bool FixMPMDt::at_end() const
{
  return until > 0.0 && until - elapsed_time(*update) <= ROUND_OFF * until;
}

double FixMPMDt::time_left(double most) const
{
  return until > 0.0 ? std::min(most, until - elapsed_time(*update)) : most;
}

void FixMPMDt::stop_run()
{
  ended = true;
  timer->force_timeout();
}

double FixMPMDt::fit_to_end(double dt, int least) const
{
  const auto fields = MPMField::all(lmp);    // all of the same every
  const int cycle = fields.empty() ? 1 : fields[0]->options.every;
  const double left = until - elapsed_time(*update);
  if (left > 2.0 * cycle * dt) return dt;
  int n = std::max(least, (int) std::ceil(left / dt * (1.0 - ROUND_OFF)));
  while (cycle > 1 && n % cycle != fields[0]->steps_to_next() % cycle) n++;
  return left / n;
}

/** Thermodynamic output of the last step, which is to come. */
void FixMPMDt::announce_end()
{
  const bigint last = update->ntimestep + 1;
  if (until - elapsed_time(*update) > (1.0 + ROUND_OFF) * update->dt) return;
  output->next_thermo = std::min(output->next_thermo, last);
  output->next = std::min(output->next, last);
  modify->addstep_compute_all(last);
}

/** The limit of strain is kept at once, as in an impact the next look could be too late; that of
 *  grains when there are new neighbor lists, as in old ones two that are about to touch may not be
 *  a pair. */
void FixMPMDt::end_of_step()
{
  if (at_end()) return stop_run();
  look();
  if (until == 0.0) return;
  change_dt(fit_to_end(wanted, 1));
  announce_end();
}

void FixMPMDt::look()
{
  if (update->ntimestep % look_every) {
    const bool new_pairs = collisions && neighbor->ago == 0;
    if (strain == 0.0 && !new_pairs) return;
    Limit steps = smallest(strain_limit_local());
    if (new_pairs) steps = grain_limit(steps, wanted);
    if (!(fraction * steps.dt < wanted)) return;
    limit = steps;
    return set_dt(fraction * limit.dt);
  }
  limit = find_limit();
  carried = NO_POINTS;
  for (auto *field : MPMField::all(lmp)) field->time_limit->volume_rate = {0.0, 0};
  if (limit.dt < NO_POINTS.dt) set_dt(std::min(fraction * limit.dt, grow * wanted));
}

/** Set the time step, and tell everybody when it changes, as fix dt/reset does. */
void FixMPMDt::set_dt(double dt)
{
  if (dt_max > 0.0) dt = std::min(dt, dt_max);
  const auto tag = (tagint) limit.tag;
  if (limit.dt == 0.0)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/dt: point {} has no valid wave speed or velocity at step {}", tag,
               update->ntimestep);
  if (dt < MPMTimeLimit::SMALLEST)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/dt: time step {:.6g} is below the smallest one of fix mpm, {:.6g}", dt,
               MPMTimeLimit::SMALLEST);
  if (dt < dt_min)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/dt: time step {:.6g} needed by {} at step {} is below min {:.6g}; see what "
               "happened to it, or lower min",
               dt, what_limits(), update->ntimestep, dt_min);
  wanted = dt;
  if (until == 0.0) change_dt(dt);    // otherwise it has to fit first
}

std::string FixMPMDt::what_limits() const
{
  const auto tag = (tagint) limit.tag, other = (tagint) limit.other;
  if (limit.other > 0.0) return fmt::format("the collision of grains {} and {}", tag, other);
  if (limit.other == 0.0) return fmt::format("the collision of grain {} with a wall", tag);
  if (tag == 0) return "a rigid body of fix mpm/rigid";
  if (limit.speed == 0.0)
    return fmt::format(
        "point {} (its change of volume, other physics, or the gas of a fix mpm/airbag)", tag);
  return fmt::format("point {} (wave speed {:.6g})", tag, limit.speed);
}

void FixMPMDt::change_dt(double dt)
{
  if (dt == update->dt) return;

  update->update_time();
  update->dt = dt;
  update->dt_default = 0;
  if (utils::strmatch(update->integrate_style, "^respa")) update->integrate->reset_dt();
  if (force->pair) force->pair->reset_dt();
  for (auto *ifix : modify->get_fix_list()) ifix->reset_dt();
  output->reset_dt();
  nchanges++;
}

void FixMPMDt::note_limits()
{
  const Limit points = point_limit();
  limit_left = allowed(points);
  grains_left = grain_dt(grain_limit(points));
}

void FixMPMDt::post_run()
{
  dt_left = update->dt;
  wanted_left = wanted;
  note_limits();
  continues = true;
  if (until == 0.0) return;
  if (ended)
    timer->reset_timeout();
  else if (comm->me == 0 && update->nsteps > 0 && !warned_of_rest)
    error->warning(
        FLERR,
        "Fix mpm/dt {}: the run has ended at the time {:.6g}, before until {:.6g}, which takes "
        "about "
        "{:.3g} more steps like the last one: a run of more steps than that ends there by itself",
        id, elapsed_time(*update), until, (until - elapsed_time(*update)) / update->dt);
  warned_of_rest = warned_of_rest || update->nsteps > 0;    // once: runs can have many parts
}

double FixMPMDt::compute_scalar()
{
  return update->dt;
}

double FixMPMDt::compute_vector(int i)
{
  const double values[3] = {limit.tag, limit.speed, (double) nchanges};
  if (i < 3) return values[i];
  if (until == 0.0) return 0.0;
  const double passed = elapsed_time(*update) - time_at_start, left = until - time_at_start;
  if (i == 3) return left > 0.0 ? passed / left : 1.0;
  return passed > 0.0 ? (left / passed - 1.0) * (platform::walltime() - wall_at_start) : 0.0;
}

/** Between runs: what the last one has left, as the next run compares with that; the fixes may not
 *  be those of the last run. */

std::vector<double> FixMPMDt::saved_options() const
{
  return {fraction, dt_max, grow, strain, grains, (double) look_every};
}

void FixMPMDt::write_restart(FILE *fp)
{
  const auto fields = MPMField::all(lmp);
  const bool flows = update->whichflag == 1 && !find_fixes<MPMFluid>(lmp).empty();
  const bool running = flows || std::any_of(fields.begin(), fields.end(), [](const auto *field) {
                         return field->is_running();
                       });
  const Limit steps = smallest(strain_limit_local());
  if (running) {
    dt_left = update->dt;
    wanted_left = wanted;
    note_limits();
  }
  std::vector<double> state = {dt_left,   limit_left,  (double) nchanges, steps.dt,
                               steps.tag, wanted_left, grains_left};
  const auto options = saved_options();
  state.insert(state.end(), options.begin(), options.end());
  if (comm->me) return;
  write_state(fp, state.data(), state.size() * sizeof(double));
}

void FixMPMDt::restart(char *buf)
{
  constexpr std::size_t NSAVED = 7;
  const auto options = saved_options();
  const auto *next =
      (const double *) read_state(lmp, id, buf, (NSAVED + options.size()) * sizeof(double));
  dt_left = *next++;
  limit_left = *next++;
  nchanges = (bigint) *next++;
  if (strain > 0.0) carried = {next[0], 0.0, next[1], NO_GRAIN};
  next += 2;
  wanted_left = *next++;
  grains_left = *next++;
  continues = !(dt_max > 0.0 && wanted_left > dt_max);
  for (const double option : options) continues = continues && option == *next++;
}
