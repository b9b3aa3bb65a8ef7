/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "step/fix_mpm.h"

#include "atom.h"
#include "base/mpm_integrator.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "base/mpm_version.h"
#include "comm.h"
#include "compute.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_affine.h"
#include "field/mpm_cpdi.h"
#include "field/mpm_every.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_guard.h"
#include "field/mpm_halo.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_physics.h"
#include "field/mpm_plan.h"
#include "field/mpm_point_map.h"
#include "field/mpm_setup_checks.h"
#include "field/mpm_strain.h"
#include "field/mpm_time_limit.h"
#include "force.h"
#include "group.h"
#include "modify.h"
#include "neighbor.h"
#include "output.h"
#include "step/mpm_grains.h"
#include "step/mpm_stages.h"
#include "update.h"
#include "watch/mpm_continuation.h"
#include "watch/mpm_energy_watch.h"
#include "watch/mpm_fracture_watch.h"
#include "watch/mpm_point_summary.h"
#include "watch/mpm_rolling_watch.h"
#include "watch/mpm_shape_watch.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace FixConst;

/** Fix ID group mpm H keyword value ... */
FixMPM::FixMPM(LAMMPS *lmp, int narg, char **arg) : FixMPMState(lmp, narg, arg)
{
  if (!MPMPoints::get(atom))
    error->all(FLERR, "Fix mpm requires material points: use atom_style mpm, or hybrid with mpm");
  if (!domain->box_exist)
    error->all(FLERR, "Fix mpm needs the simulation box: define it with create_box before");
  if (!atom->tag_enable)
    error->all(FLERR,
               "Fix mpm tells points from each other by their IDs: remove atom_modify id no");
  require_arguments(lmp, "fix mpm", narg, 3, {"h"});
  const double h = utils::numeric(FLERR, arg[3], false, lmp);
  if (!(h > 0.0) || !std::isfinite(h))
    error->all(FLERR, 3, "Fix mpm node spacing must be positive: {}", arg[3]);

  MPMFieldOptions options;
  auto declared = options.declare(domain->dimension);
  read_options(lmp, declared, narg, arg, 4);
  if (!declared.given("origin")) std::copy_n(domain->boxlo, domain->dimension, options.origin);
  field.reset(new MPMField(lmp, *this, h, options, state));
  if (options.watches_fracture()) field->fracture_watch.reset(new MPMFractureWatch(lmp, *field));
  checks.reset(new MPMSetupChecks(lmp, *field));
  continuation.reset(new MPMContinuation(lmp, *field));
  shape_watch.reset(new MPMShapeWatch(lmp, *field));
  rolling_watch.reset(new MPMRollingWatch(lmp, *field));
  if (comm->me == 0)
    utils::logmesg(lmp, "Fix mpm {}, MPM package {}: spacing {} {}\n", id, MPM_VERSION, h,
                   options.declare(3).text());

  time_integrate = 1;
  dynamic_group_allow = 0;
  scalar_flag = vector_flag = 1;
  size_vector = 11;
  global_freq = 1;
  extscalar = 1;
  extvector = 0;
  restart_global = 1;
  if (field->guard->may_delete() || options.most_distorted > 0.0) {
    force_reneighbor = 1;
    next_reneighbor = -1;
  }
  keep_arrays();
}

FixMPM::~FixMPM() = default;

int FixMPM::setmask()
{
  return INITIAL_INTEGRATE | PRE_EXCHANGE | PRE_NEIGHBOR | PRE_FORCE;
}

void FixMPM::init()
{
  check_integrator(lmp, "Fix mpm");
  set_up.remember(lmp);
  field->points = MPMPoints::get(atom);
  field->check_box();
  if (domain->box_change_size || domain->box_change_shape)
    error->all(FLERR,
               "Fix mpm requires a box of constant size and shape: remove the fix that changes it, "
               "or use fix mpm/deform to strain a periodic cell");
  if (comm->me == 0)
    for (const auto &text : MPMFieldOptions(field->options).declare(3).warnings())
      error->warning(FLERR, text);

  // all fields step together, driven by the first one
  plan.reset();
  if (modify->get_fix_by_style("^mpm$")[0] == this) {
    for (auto *each : MPMField::all(lmp))
      if (each->every) each->every->forget_broken_step();
    check_fields();
    plan.reset(new MPMPlan(lmp));
    plan->watch.reset(new MPMEnergyWatch(lmp, plan->fields));
    plan->make(MPMStages::make_scheme);
  }

  time_integrate = seen_as_integrator(lmp, *this);

  allow_no_ghosts(lmp, field->lattice.h);

  // points are kept in order of blocks and cells here
  atom->sortfreq = 0;
}

void FixMPM::check_fields() const
{
  const auto &mine = field->options;
  for (const auto *other : MPMField::all(lmp)) {
    const auto &options = other->options;
    const std::pair<bool, const char *> rules[] = {
        {options.every != mine.every, "have the same every"},
        {other->steps_to_next() != field->steps_to_next(),
         "be at the same step of every, as all are after a multiple of its steps"},
        {options.scheme != mine.scheme, "have the same scheme"},
        {options.gain != mine.gain || options.most_gain != mine.most_gain, "have the same gain"},
        {options.axisymmetric != mine.axisymmetric, "be axisymmetric, or none"}};
    for (const auto &[differ, what] : rules)
      if (differ)
        error->all(FLERR, "All fix mpm instances must {}: {} and {} differ", what, id, other->id());
  }
  check_include();
}

/** Points that touch something must be in the neighbor lists; none does where the only others are
 *  grains in a fluid. */
void FixMPM::check_include() const
{
  const int listed = neighbor->includegroup;
  if (!listed) return;
  for (const auto *points : find_fixes<MPMListedPoints>(lmp))
    if (points->keeps_group(listed)) return;
  error->all(FLERR,
             "Neigh_modify include {} leaves out material points that can touch others: use fix "
             "mpm/surface with keyword group {}, or the group of a fix mpm/immersed",
             group->names[listed], group->names[listed]);
}

void FixMPM::setup_pre_exchange()
{
  if (field->affine) field->affine->check_velocities();
  field->guard->check_inside_box();
}

void FixMPM::setup_pre_neighbor()
{
  field->choose_kernels();
  field->map->setup();
  const bool first = plan != nullptr;
  checks->run(MPMSetupChecks::POINTS, first);
  continuation->check(first);
  shape_watch->check();
  if (force->pair) checks->run(MPMSetupChecks::PAIRS, first);
  field->frame->setup();
  checks->run(MPMSetupChecks::PLACES, first);

  // other physics may ask for the points of any field
  const auto &all = field->plan->fields;
  if (field.get() != all.back()) return;
  for (auto *physics : find_fixes<MPMPhysics>(lmp)) physics->setup_points();
  for (auto *one : all) {
    give_initial_stress(*one);
    one->map->sort();
    one->map->valid = false;
  }
}

void FixMPM::setup(int)
{
  if (update->dt <= 0.0) error->all(FLERR, "Fix mpm requires a positive time step: {}", update->dt);
  if (force->pair) checks->run(MPMSetupChecks::LISTS, plan != nullptr);
  if (force->pair) warn_of_points_as_grains(lmp, groupbit, fmt::format("Fix mpm {}", id));
  if (plan) plan->start();
  field->begin_run();
  if (field->affine) field->affine->fit();
  if (field->every && field->every->progress.waited) field->map->valid = false;
  field->ledger.setup();
  field->time_limit->setup();
}

void FixMPM::initial_integrate(int /*vflag*/)
{
  set_up.check(lmp, "Fix mpm");
  if (!plan) return;
  checks->look();
  plan->step();
}

void FixMPM::pre_exchange()
{
  no_torques = false;
  field->guard->check_inside_box();
  if (plan) field->guard->tell_lost_atoms();
}

/** After exchange and borders: restore the order of points when it has decayed. At steps with a
 *  restart file the order must not depend on history, so that a run that continues from the file
 *  sums in the same order. */
void FixMPM::pre_neighbor()
{
  int flag = field->map->wants_sort(), flag_all;
  MPI_Allreduce(&flag, &flag_all, 1, MPI_INT, MPI_MAX, world);
  const bool restarts = output->restart_flag && output->next_restart == update->ntimestep;
  if (field->frame->renew_places() || flag_all || restarts) field->map->sort();
  field->map->valid = false;
}

/** LAMMPS has set to zero the forces of the atoms in the neighbor lists only (neigh_modify
 *  include). Nothing exerts torques on the others, so that these stay zero until atoms change their
 *  places in memory. */
void FixMPM::pre_force(int)
{
  if (!plan || !neighbor->includegroup) return;
  const std::size_t n = 3 * (std::size_t)(atom->nlocal - atom->nfirst) * sizeof(double);
  if (n == 0) return;
  memset(&atom->f[atom->nfirst][0], 0, n);
  if (atom->torque_flag && !no_torques) memset(&atom->torque[atom->nfirst][0], 0, n);
  no_torques = true;
}

void FixMPM::post_run()
{
  if (plan) {
    plan->watch->finish();
    set_up.finish(lmp);
  }
  if (field->fracture_watch) field->fracture_watch->finish();
  field->end_run();
  field->guard->wrap_far_points();
  field->ledger.start.clear();
  if (field->affine) field->affine->remember_velocities();
  shape_watch->finish();
  rolling_watch->finish();
  if (field->counts().steps)
    field->plan->report(*field, bytes_per_point(), point_extremes(lmp, *field));
}

/** Scalar: number of points; vector: blocks with points, active blocks, points per block, updates
 *  of the topology and sorts in this run, halo bytes sent per step; points, mass and momentum
 *  deleted so far. */
double FixMPM::compute_scalar()
{
  double n = 0.0, all;
  for (int i = 0; i < atom->nlocal; i++) n += field->is_point(i);
  MPI_Allreduce(&n, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixMPM::compute_vector(int k)
{
  const auto &deleted = field->guard->deleted;
  if (k == 6) return deleted.points;
  if (k == 7) return deleted.mass;
  if (k > 7) return deleted.momentum[k - 8];
  const auto &map = *field->map;
  if (k == 3) return map.nbuild;
  if (k == 4) return map.nsort;
  double mine[4] = {
      (double) map.active.size(), (double) field->grid.blocks.size(), (double) map.npoints(),
      (double) field->nodes.halo->bytes_sent / std::max((bigint) 1, field->counts().steps)};
  double all[4];
  MPI_Allreduce(mine, all, 4, MPI_DOUBLE, MPI_SUM, world);
  if (k == 2) return all[0] > 0.0 ? all[2] / all[0] : 0.0;
  return all[k == 5 ? 3 : k];
}

/** Per-point state: what LAMMPS keeps of any atom, atom style mpm, affine matrix, history. */
double FixMPM::bytes_per_point() const
{
  double bytes = 9 * sizeof(double) + sizeof(tagint) + 2 * sizeof(int) + sizeof(imageint);
  bytes += (1 + 1 + 9 + 6) * sizeof(double);    // mass, V0, F, stress
  bytes += state.size() * sizeof(double) + field->frame->bytes_per_point();
  if (field->boxes) bytes += 3 * sizeof(double);
  if (field->domains) bytes += field->domains->bytes_per_point();
  for (auto *material : field->materials) bytes += material->nhistory * sizeof(double);
  return bytes;
}

/** Totals of the ledger, what was deleted, which velocities the affine matrices belong to, when
 *  neighbor lists are made, the options that a run must go on with, the duration of the last step,
 *  and what else the run has. */

namespace {
struct Saved {
  MPMEnergies ledger;
  MPMGuard::Deleted deleted;
  double elapsed;
  MPMAffine::Velocities velocities;
  MPMSetupChecks::Lists lists;
  double last_dt;
  int waited, nstart, ntext;    // nstart reals, ntext characters, and lines follow
};
}    // namespace

void FixMPM::write_restart(FILE *fp)
{
  Saved saved;
  memset(&saved, 0, sizeof(Saved));
  if (field->affine) {
    if (field->is_running()) field->affine->remember_velocities();
    saved.velocities = field->affine->velocities;
  }
  if (field->every) {
    saved.waited = field->every->progress.waited;
    saved.elapsed = field->every->progress.elapsed;
  }
  saved.deleted = field->guard->deleted;
  saved.lists = checks->lists();
  MPMEnergies &energies = field->ledger;
  keep_totals(world, (double *) &energies, sizeof(MPMEnergies) / sizeof(double));
  saved.ledger = energies;
  std::vector<double> start = field->ledger.start;
  for (auto *compute : modify->get_compute_by_style("^mpm/energy$"))
    if (start.empty()) start = dynamic_cast<MPMEnergyStart *>(compute)->start_sums();
  const std::string text = MPMFieldOptions(field->options).declare(3).kept();
  saved.nstart = (int) start.size();
  saved.ntext = (int) text.size();
  const std::string lines = continuation->state();
  saved.last_dt = field->dt_of_last_step();
  if (comm->me) return;
  std::string state((const char *) &saved, sizeof(Saved));
  state.append((const char *) start.data(), start.size() * sizeof(double));
  state += text + lines;
  write_state(fp, state.c_str(), state.size() + 1);
}

void FixMPM::restart(char *buf)
{
  Saved saved;
  const auto state = read_state(lmp, id, buf);
  if (state.size() < sizeof(Saved)) refuse_state(lmp, id);
  memcpy(&saved, state.data(), sizeof(Saved));
  const std::size_t size = sizeof(Saved) + saved.nstart * sizeof(double) + saved.ntext;
  if (saved.nstart < 0 || saved.ntext < 0 || state.size() <= size) refuse_state(lmp, id);
  const char *const start = state.data() + sizeof(Saved);
  const char *const text = start + saved.nstart * sizeof(double);
  const std::string lines = text + saved.ntext;
  if (state.size() != size + lines.size() + 1) refuse_state(lmp, id);
  continuation->expect(lines);
  std::string differences = continuation->other_lattice();
  if (differences.empty())
    differences = MPMFieldOptions(field->options)
                      .declare(3)
                      .differences(std::string(text, text + saved.ntext));
  if (!differences.empty())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm {} has other options than in the restart file: {}; give it those of the "
               "file, or another ID to begin anew",
               id, differences);

  // without it, the first step counts for the one before, as in a run from the start
  field->continue_after(saved.last_dt);
  if (comm->me == 0) static_cast<MPMEnergies &>(field->ledger) = saved.ledger;
  field->guard->deleted = saved.deleted;
  checks->lists_of_file = saved.lists;
  if (field->affine) field->affine->velocities = saved.velocities;
  if (field->every) {
    field->every->progress.waited = saved.waited;
    field->every->progress.elapsed = saved.elapsed;
  }
  field->ledger.start.resize(saved.nstart);
  if (saved.nstart) memcpy(field->ledger.start.data(), start, saved.nstart * sizeof(double));
}
