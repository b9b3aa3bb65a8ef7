/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Forces on a node are balanced if its velocity does not change: m dv/dt, with the reactions of
   walls and contacts, which have changed velocities in the same step. They are compared with the
   forces that the stress of points brings to nodes, sum_p V_p |sigma_p|/h, which cancel in
   equilibrium.
------------------------------------------------------------------------- */

#include "implicit/fix_mpm_relax.h"

#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "base/mpm_state.h"
#include "contact/fix_mpm_contact.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_frame.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_strain.h"
#include "field/mpm_time_limit.h"
#include "implicit/mpm_mls_rotation.h"
#include "walls/fix_mpm_boundary.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "force.h"
#include "output.h"
#include "timer.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;
using Data = MPMStageData;    // what stages read and write

static constexpr double UNKNOWN = std::numeric_limits<double>::infinity();
static constexpr double ROUND_OFF = 1.0e-13;    // of changes of velocities in a step

/* ----------------------------------------------------------------------
   fix ID all mpm/relax TOLERANCE keyword value ...
------------------------------------------------------------------------- */

Options MPMRelaxOptions::declare()
{
  using namespace option;
  Options o("fix mpm/relax");
  o.argument(number(tolerance, "largest ratio of forces", POSITIVE));
  o.add("every", {integer(look_every, "N", POSITIVE, "check the forces every this many steps")});
  o.add("stop", {yes_no(stops)}, "end the run when forces are balanced");
  o.refuse([this] {
    return OptionRules{
        {tolerance >= 1.0, "", "needs a ratio below 1, which forces without balance have"}};
  });
  return o;
}

FixMPMRelax::FixMPMRelax(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
{
  if (igroup != 0)
    error->all(FLERR, 1, "Fix mpm/relax brings the points of all fix mpm to rest: use group all");
  Options options = declare();
  read_options(lmp, options, narg, arg, 3);
  ratio = UNKNOWN;
  nevery = 1;
  scalar_flag = vector_flag = 1;
  size_vector = 4;
  global_freq = 1;
  extscalar = extvector = 0;
  restart_global = 1;
  dynamic_group_allow = 1;
}

void FixMPMRelax::init()
{
  require_field(lmp, *this);
  refuse_second(lmp, *this);
}

void FixMPMRelax::init_physics(MPMPlan &plan)
{
  fields = plan.fields;
  for (auto *field : fields) field->keep_old_velocities();
  may_start_by_half = can_start_by_half(plan);
}

/** Half of the velocities is what holds at nodes, too, where walls are at rest and other physics
 *  does not look at these. */
bool FixMPMRelax::can_start_by_half(const MPMPlan &plan) const
{
  const bool simple_fields = std::none_of(fields.begin(), fields.end(), [](const MPMField *field) {
    return field->options.has_fmpm() || field->options.has_xpic();
  });
  const bool at_rest = std::all_of(plan.actions.begin(), plan.actions.end(), [](auto *action) {
    const auto *wall = dynamic_cast<FixMPMBoundary *>(action);
    return wall ? !wall->moves()
                : dynamic_cast<FixMPMContact *>(action) || dynamic_cast<MPMRefinedBody *>(action);
  });
  const bool alone = std::all_of(plan.physics.begin(), plan.physics.end(), [this](auto *other) {
    return other == this || dynamic_cast<MPMLoad *>(other) ||
        dynamic_cast<MPMRefinedBody *>(other) || dynamic_cast<MPMHeatSink *>(other);
  });
  return simple_fields && at_rest && alone;
}

void FixMPMRelax::add_stages(MPMPlan &plan, MPMPlan::Place place)
{
  if (place == MPMPlan::AFTER_SOLVE)
    plan.together("relaxation", {Data::VELOCITY, Data::MASS, Data::NODES, Data::BLOCKS, Data::OWN},
                  {Data::NODES, Data::OWN}, [this]() {
                    look();
                  });
  if (place == MPMPlan::AFTER_MOTION)
    plan.together("relaxation", {Data::VELOCITY, Data::MASS, Data::FORCE},
                  {Data::VELOCITY, Data::AFFINE, Data::OWN}, [this]() {
                    if (falls) rest();
                  });
}

void FixMPMRelax::setup(int)
{
  state = RUNNING;
  ratio = UNKNOWN;    // loads can be others
  best = {UNKNOWN, damping.nsteps, damping.nrests};
  start = damping.nsteps;
  rests_before = damping.nrests;
  look_at = 0.0;
  measure();
}

/* ---------------------------------------------------------------------- */

/** Half a step from rest to the middle of this one: walls and contacts have had the forces of all
 *  of it. Of this, the ledger has the energy that nodes lose; the watch, which has the work of
 *  forces at the mean velocities of points, the rest. */
void FixMPMRelax::start_by_half()
{
  for (auto *field : fields) {
    Grid &grid = field->grid;
    const double before = field->ledger.sums_over_nodes().energy;
    for (int64_t node = 0; node < grid.nnodes(); node++) {
      double *const record = grid.record(node);
      if (!(record[3] > 0.0)) continue;
      for (int d = 0; d < 3; d++) record[d] -= 0.5 * (record[d] - record[4 + d]);
    }
    const double after = field->ledger.sums_over_nodes().energy;
    field->ledger.take(before - after);
    field->ledger.count_at_points();
    taken[0] += before - after;
    taken[1] -= before - 2.0 * after;
  }
  damping.kinetic *= 0.25;
}

void FixMPMRelax::look()
{
  const bool starts = may_start_by_half && damping.starts_by_half();
  const bool looks = std::fmod(damping.nsteps, look_every) == 0.0;
  // energy, forces, forces of stress, and those that would stop everything in a step
  double mine[4] = {0.0, 0.0, 0.0, 0.0}, all[4];
  for (auto *field : fields) {
    Grid &grid = field->grid;
    const double *record = grid.nodes();
    double energy = 0.0, forces = 0.0, momenta = 0.0;
    for (const auto &block : grid.blocks)
      for (int n = 0; n < NODES_PER_BLOCK; n++, record += 8) {
        if (!(block.owned >> n & 1) || !(record[3] > 0.0)) continue;
        double square = 0.0, speed = 0.0;
        for (int d = 0; d < 3; d++) {
          const double change = record[d] - record[4 + d];
          speed += record[d] * record[d];
          square += change * change;
        }
        energy += 0.5 * record[3] * speed;
        forces += record[3] * sqrt(square);
        momenta += record[3] * sqrt(speed);
      }
    mine[0] += energy * force->mvv2e;
    mine[1] += forces / (field->step_dt() * force->ftm2v);
    mine[3] += momenta / (field->step_dt() * force->ftm2v);
  }
  if (looks) mine[2] = force_of_stress();
  MPI_Allreduce(mine, all, 4, MPI_DOUBLE, MPI_SUM, world);
  falls = damping.advance(all[0]) || state == LAST_STEP;
  unbalanced = all[1];
  if (starts) start_by_half();
  if (!looks) return;
  carried = all[2];
  // what round-off does to the velocities of a body in free flight is no force
  ratio = unbalanced <= ROUND_OFF * all[3] ? 0.0 : unbalanced / carried;
  // forces that this brings are not there yet
  for (const auto *field : fields)
    if (field->frame->strains_on_average()) ratio = UNKNOWN;
  if (ratio <= tolerance) falls = true;
  look_for_stall();
  look_for_bending();
}

/** Of all bodies together. The thickness is that of a straight strip or plate of their volume. */
void FixMPMRelax::measure()
{
  double end[6], ends[6], mine = 0.0, volume;    // low ends, and minus high ends
  std::fill_n(end, 6, UNKNOWN);
  for (const auto *field : fields)
    for (int i = 0; i < atom->nlocal; i++) {
      if (!field->is_point(i)) continue;
      mine += field->points->jacobian(i) * atom->vfrac[i];
      for (int d = 0; d < 3; d++) {
        end[d] = std::min(end[d], atom->x[i][d]);
        end[3 + d] = std::min(end[3 + d], -atom->x[i][d]);
      }
    }
  MPI_Allreduce(end, ends, 6, MPI_DOUBLE, MPI_MIN, world);
  MPI_Allreduce(&mine, &volume, 1, MPI_DOUBLE, MPI_SUM, world);
  const int dim = fields[0]->lattice.dim;
  length = thickness = 0.0;
  if (fields[0]->options.axisymmetric) return;    // volumes are those of rings
  double size[3] = {};                            // in 2d the smallest is 0
  for (int d = 0; d < dim; d++) size[d] = -ends[3 + d] - ends[d];
  std::sort(size, size + 3);
  length = size[2];
  thickness = volume / (dim == 3 ? length * (size[1] + fields[0]->lattice.h) : length);
}

/** What bends slowly has a first rest after 1.55 (length/thickness)^2 (thickness/h) steps of the
 *  limit, as a cantilever, and is at rest after half as many more. Bodies that are pulled or
 *  pressed have a first rest when waves have come along them. */
void FixMPMRelax::look_for_bending()
{
  constexpr double THIN = 40.0, CROSSED = 5.0, STEPS = 2.3;
  const double steps = damping.nsteps - start;
  if (warned_of_bending || !stops || damping.nrests > rests_before || steps < look_at ||
      !(length > THIN * thickness))
    return;
  look_at = steps + 500.0;
  double mine = UNKNOWN, limit, h = fields[0]->lattice.h;
  for (const auto *field : fields) {
    tagint tag;
    double speed;
    mine = std::min(mine, field->time_limit->stable_dt(tag, speed));
    h = std::min(h, field->lattice.h);
  }
  MPI_Allreduce(&mine, &limit, 1, MPI_DOUBLE, MPI_MIN, world);
  const double cell = limit / fields[0]->step_dt();    // steps
  if (steps < CROSSED * length / h * cell) return;
  warned_of_bending = true;
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/relax {}: there was no rest in {:.0f} steps, in which waves have come "
        "{:.0f} times along the bodies: with {:.0f} times the length of their thickness, "
        "those that bend take some {:.1g} steps: use fix mpm/implicit static in its place",
        id, steps, CROSSED, length / thickness, STEPS * length * length / (thickness * h) * cell);
}

/** A body on its way to rest halves the ratio in a few rests. */
void FixMPMRelax::look_for_stall()
{
  constexpr double LESS = 0.9, SHARE = 0.5, STEPS = 2000.0, RESTS = 20.0;
  const double steps = damping.nsteps - best.step, rests = damping.nrests - best.nrests;
  if (ratio < LESS * best.ratio) best = {ratio, damping.nsteps, damping.nrests};
  if (warned_of_stall || !stops || steps < STEPS || steps < SHARE * (damping.nsteps - start) ||
      rests < RESTS)
    return;
  warned_of_stall = true;
  const std::string what = remedy();
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/relax {}: forces get no more balanced: their ratio has not fallen below "
        "{:.3g} for {:.0f} steps and {:.0f} rests (tolerance {:.3g}): {}",
        id, LESS * best.ratio, steps, rests, tolerance, what);
}

/** Less than two points per cell and axis, in bodies whose points come to other cells?
 *  Collective. */
bool FixMPMRelax::has_few_points() const
{
  constexpr double MOST = 0.6;    // volume of points on average, in cells
  double mine[2] = {0.0, 0.0}, all[2];
  for (const auto *field : fields) {
    if (field->options.total) continue;
    const double cell = std::pow(field->lattice.h, field->lattice.dim);
    for (int i = 0; i < atom->nlocal; i++) {
      if (!field->is_point(i) || field->is_element_node(i)) continue;
      mine[0] += 1.0;
      mine[1] += atom->vfrac[i] / (cell * field->frame->circle(atom->x[i][0]));
    }
  }
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  return all[1] > MOST * all[0];
}

/** Is this an option of any field? */
bool FixMPMRelax::any_has(bool (*is)(const MPMFieldOptions &)) const
{
  return std::any_of(fields.begin(), fields.end(), [&](const MPMField *field) {
    return is(field->options);
  });
}

static bool maps_back(const MPMFieldOptions &options)
{
  return options.scheme != MPMFieldOptions::USL;
}

static bool refines(const MPMFieldOptions &options)
{
  return options.has_fmpm() || options.has_xpic();
}

std::string FixMPMRelax::remedy() const
{
  const bool few = has_few_points();
  if (any_has(maps_back))
    return "give fix mpm the scheme usl: the velocities that strain the points with this one leave "
           "out what varies from node to node";
  if (any_has(refines))
    return "give fix mpm the transfer apic: with this one stops excite fast vibrations";
  if (few)
    return "use two points per cell and axis (ppc 2 of create_points): with fewer, bodies give way "
           "without stress";
  if (!may_start_by_half)
    return "give fix mpm shape linear and fix mpm/dt a fraction of at most 0.35, as stops excite "
           "fast vibrations, or do without walls that move and other physics until bodies rest";
  return "there may be no equilibrium, of a body that nothing holds or that does not bear its "
         "load; if results are near enough, use a larger tolerance";
}

/** Of the points of this rank. */
double FixMPMRelax::force_of_stress() const
{
  double sum = 0.0;
  for (auto *field : fields) {
    double mine = 0.0;
    for (int i = 0; i < atom->nlocal; i++) {
      if (!field->is_point(i)) continue;
      const double *const s = field->points->tau[i];
      mine += atom->vfrac[i] *
          sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2] +
               2.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
    }
    sum += mine / (field->lattice.h * force->nktv2p);
  }
  return sum;
}

/* ---------------------------------------------------------------------- */

void FixMPMRelax::rest()
{
  if (!warned_of_rotation) warned_of_rotation = warn_of_mls_rotation(*this, fields);
  for (auto *field : fields) put_to_rest(*field, taken);
  damping.rest();
}

/* ----------------------------------------------------------------------
   the run ends as with fix halt, a step after it is known that it does, so that there is
   thermodynamic output of the last one
------------------------------------------------------------------------- */

void FixMPMRelax::end_of_step()
{
  if (!stops) return;
  if (state == LAST_STEP) {
    state = ENDED;
    timer->force_timeout();
  } else if (state == RUNNING && ratio <= tolerance) {
    state = LAST_STEP;
    const bigint last = update->ntimestep + 1;
    output->next_thermo = std::min(output->next_thermo, last);
    output->next = std::min(output->next, last);
    modify->addstep_compute_all(last);
  }
}

void FixMPMRelax::post_run()
{
  if (state == ENDED) {
    timer->reset_timeout();
    if (comm->me == 0)
      utils::logmesg(lmp, "Fix mpm/relax {}: forces are balanced to {:.3g} after {:.0f} rests\n",
                     id, ratio, damping.nrests);
  } else if (comm->me == 0 && update->nsteps > 0 && stops) {
    const bool nearly = state == LAST_STEP;
    error->warning(
        FLERR,
        "Fix mpm/relax {}: the run has ended {} (ratio of forces {:.3g}, tolerance {:.3g}): "
        "{}",
        id, nearly ? "just before the last rest" : "before forces are balanced", ratio, tolerance,
        warned_of_stall || warned_of_bending ? "see the warning before"
            : any_has(maps_back)
            ? "run more steps, and give fix mpm the scheme usl, which takes far fewer"
            : "run more steps");
  }
}

double FixMPMRelax::compute_vector(int k)
{
  const double values[4] = {unbalanced, carried, damping.kinetic, damping.nrests};
  return values[k];
}

/* ---------------------------------------------------------------------- */

void FixMPMRelax::write_restart(FILE *fp)
{
  keep_totals(world, taken, 2);
  if (comm->me) return;
  const auto &d = damping;
  const double list[] = {d.kinetic, unbalanced, carried,  ratio,      d.nrests, d.nsteps,
                         taken[0],  taken[1],   d.rested, d.interval, d.least,  d.grows};
  write_state(fp, list, sizeof(list));
}

void FixMPMRelax::restart(char *buf)
{
  const auto *const list = (const double *) read_state(lmp, id, buf, 12 * sizeof(double));
  damping.kinetic = list[0];
  unbalanced = list[1];
  carried = list[2];
  ratio = list[3];
  damping.nrests = list[4];
  damping.nsteps = list[5];
  if (comm->me == 0) std::copy_n(list + 6, 2, taken);
  damping.rested = list[8];
  damping.interval = list[9];
  damping.least = list[10];
  damping.grows = list[11];
}
