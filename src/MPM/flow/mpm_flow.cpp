/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow.h"

#include "base/mpm_gravity.h"
#include "base/mpm_points.h"
#include "base/mpm_state.h"
#include "flow/mpm_flow_transfer.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "force.h"
#include "math_extra.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// what quadratic splines add to a velocity component along its own axis, over its second difference
static constexpr double SMOOTHED = 0.125;
// relative change of the time step from which on there are two
// solves: a smaller one changes the pressure as little
static constexpr double DIFFERENT_DT = 0.01;
// tolerance of the spreading of points, which shows only with other numbers of processes
static constexpr double SPREAD_TOLERANCE = 1.0e-8;
// accelerations over that by gravity that limit the first step of a fluid at rest: the pressure
// causes them at the edges of a block of water that is released
static constexpr double FIRST_FALL = 4.0;
// share of FLIP by default in a flow with solids or bodies: apic alone smooths velocities at their
// surfaces in each step, which brakes sinking and swaying bodies in proportion to the number of
// steps
static constexpr double FLIP_OF_BODIES = 0.98;
// transfer auto: share that is kept of the part of velocities that the lattice does not see, if
// this part is below SMOOTH times h^2 d2v_c/dx_c^2 (root mean squares); nothing is kept above
// NOISY. Vortices, waves, and oscillating drops with 16 cells or more in a wave have 0.03 to 0.06;
// remains of flow in a fluid at rest, and fluid that falls or splashes, have 0.2 to 3
static constexpr double FLIP_OF_SMOOTH = 0.98, SMOOTH = 0.08, NOISY = 0.16;
// nothing is kept where numerical errors add energy, either: shares of the largest kinetic energy,
// above which this is so, with solids, too, where energies of waves of 8 cells vary by 12 %, and
// which are worth a warning
static constexpr double GAIN = 0.03, GAIN_OF_SOLIDS = 0.15, MUCH_GAIN = 0.1;
// energy that is in play at least, over the work of all forces along a spacing, unless the
// tolerance of the pressure, which leaves about this share of forces, is larger: that of velocities
// of 0.0014 (g h)^(1/2), and of waves of 0.01 of a spacing. Points of a fluid at rest creep by less
static constexpr double IN_PLAY = 1.0e-6;
// the same of points next to regions, whose surfaces they follow in steps of their own size: at the
// start of a run they settle and spread by less than this, in spacings
static constexpr double SIZE_OF_POINTS = 0.5;
// passes that fit the gradients of velocities with which points begin, at most, and their change of
// velocities of faces, relative to the largest one, that ends them: a pass leaves up to 0.58 of
// what is missing, and 0.9 at walls, if it takes all of the gradients that it finds, and less if it
// takes more of their change
static constexpr int FITS = 200;
static constexpr double FITTED = 1.0e-12, FIT = 1.5;
// relative difference of sums over all points that is no more than another order of them
static constexpr double SAME = 1.0e-11;

MPMFlow::MPMFlow(LAMMPS *lmp, const MPMIncompressibleOptions &chosen, int groupbit,
                 const std::string &id, const MPMRows &gradient, const MPMRows &half_kick) :
    Pointers(lmp),
    options(chosen), liquids(lmp, options), parts(lmp, options, liquids, fields, groupbit),
    checks(lmp, options, liquids, parts, id), groupbit(groupbit), id(id),
    who(fmt::format("Fix mpm/incompressible {}", id)), gradient(gradient), half_kick(half_kick),
    momentum(lmp, options, liquids, parts, fields, results, who)
{
  results.regions.assign(3 * options.region_ids.size(), 0.0);
  choose_transfer();
}

/** With solids or bodies, points keep a part of their velocities by default. Bodies can come and go
 *  between runs. */
void MPMFlow::choose_transfer()
{
  if (options.transfer_is_given) return;
  const bool keeps = parts.solids || parts.bodies;
  options.transfer = keeps ? MPMIncompressibleOptions::AFLIP : MPMIncompressibleOptions::AUTO;
  options.flip = keeps ? FLIP_OF_BODIES : 0.0;
}

bool MPMFlow::has_gradients() const
{
  using Options = MPMIncompressibleOptions;
  return options.transfer == Options::AUTO || options.transfer == Options::APIC ||
      options.transfer == Options::AFLIP;
}

void MPMFlow::init()
{
  parts.init(lmp, options, groupbit, id, momentum.mobilities());
  choose_transfer();
  if (parts.gas) checks.check_gas();
  forces_known = false;
}

void MPMFlow::start()
{
  if (!(update->dt > 0.0))
    error->all(FLERR, Error::NOLASTLINE, "Fix mpm/incompressible requires a positive time step: {}",
               update->dt);
  stiffness_known = false;
  if (parts.grains) parts.grains->list();
  parts.cells.find_cells();
  if (parts.regions) {
    parts.regions->start_run();
    parts.regions->find(0.0);
    if (parts.stick) parts.stick->find(true);
    checks.check_depths();
  }
  double size;
  const double sum = sum_over_points(atom->v, size);
  is_new = !(std::fabs(sum - sum_before) <= SAME * size);
  first_of_run = true;
  if (is_new) {
    dt_before = 0.0;
    energy.begin();
    if (gradient) fit_gradients(points_now(0.0));
  }
  give_to_cells(parts.cells, points_now(0.0), fields.sums);
  parts.cells.sum(fields.sums.data(), 3 * parts.cells.lattice.dim + 1);
  find_velocities();
  parts.pressure->find_wet(fields.filled);
  if (parts.gas && !parts.gas->known()) parts.gas->find(fields.filled, fields.predicted.data());
  find_filled_volume();
  forces_known = true;
  make_plan();
}

/* ----------------------------------------------------------------------
   Names of what stages read and write: points, cells (of the lattice in reach of points), fields of
   the lattice, and parts of the flow.
------------------------------------------------------------------------- */

void MPMFlow::make_plan()
{
  stages.clear();
  stages.add("cells", {"points"}, {"cells"}, [this] {
    begin_step();
    find_cells();
  });
  if (parts.regions)
    stages.add("apertures", {"cells"}, {"apertures"}, [this] {
      find_apertures();
    });
  if (parts.inflow)
    stages.add("inflow", {"cells"}, {"inflow"}, [this] {
      parts.inflow->find(parts.regions.get());
    });
  stages.add("points to faces", {"points", "cells"}, {"sums", "filled", "predicted", "initial"},
             [this] {
               points_to_faces();
             });
  if (liquids.has_several_densities)
    stages.add("densities of faces", {"points", "sums"}, {"inverse density"}, [this] {
      find_inverse_densities();
    });
  if (parts.viscosities)
    stages.add("viscosities", {"points", "cells"}, {"viscosities"}, [this] {
      parts.viscosities->find(atom->x, atom->vfrac, atom->mask);
    });
  if (parts.solids)
    stages.add("forces of solids", {"points", "cells"}, {"solid forces"}, [this] {
      if (!stiffness_known) checks.check_stiffness();
      stiffness_known = true;
      parts.solids->give_forces(fields.solid_forces);
    });
  stages.add("wet cells", {"filled", "predicted"}, {"wet cells"}, [this] {
    find_wet_cells();
  });
  stages.add("velocities and pressures", {"sums", "filled", "predicted", "initial", "wet cells"},
             {"velocity", "pressures", "change"}, [this] {
               find_flow();
               check_speed();
             });
  if (parts.gas)
    stages.add("gas", {"velocity"}, {"gas"}, [this] {
      parts.gas->move(fields.velocity.data(), now.dt);
    });
  if (parts.grains)
    stages.add("forces on grains", {"velocity"}, {"grains"}, [this] {
      parts.grains->end(fields.velocity);
    });
  if (parts.grains || parts.inflow)
    stages.add("mobility", {}, {"mobility"}, [this] {
      parts.pressure->set_mobility(nullptr);    // points also spread among grains
    });
  if (options.sharp)
    stages.add("paths", {"velocity"}, {"paths"}, [this] {
      find_paths();
    });
  if (options.spread > 0.0)
    stages.add("spreading", {"filled", "wet cells"}, {"shift"}, [this] {
      find_shift();
    });
  if (parts.bodies)
    stages.add("bodies", {"pressures"}, {"bodies"}, [this] {
      parts.bodies->move(now.dt, now.kick, now.half_kick_share);
    });
  if (parts.solids)
    stages.add("strain of solids", {"velocity"}, {"points"}, [this] {
      parts.solids->deform(fields.velocity.data(), now.dt, options.viscosity);
    });
  stages.add("faces to points", {"velocity", "initial", "pressures", "change"}, {"points"}, [this] {
    faces_to_points();
    find_filled_volume();
  });
}

/* ----------------------------------------------------------------------
   Forces act for half of the step before and half of this one, in two parts: 1/(1 + R) before
   points move, and R/(1 + R) in what comes once more. The pressure has to remove the divergence
   that the motion in the step before has made, within 1/(1 + R) of the duration of that step. Where
   the two durations differ, there is one solve for the velocities, and one with the forces of the
   former duration. The latter gives the pressure and, in proportion to the durations, what comes
   once more.

   What makes velocities that points have been given a flow is an impulse at the start of the step,
   and does not come once more.
------------------------------------------------------------------------- */

void MPMFlow::begin_step()
{
  running = true;
  const bool leapfrog = is_leapfrog();
  begins = !continues() || is_new;
  if (begins && leapfrog) dt_before = 0.0;
  const double dt = update->dt, kick = leapfrog ? 0.5 * (dt_before + dt) : dt,
               before = dt_before > 0.0 ? dt_before : kick;
  now = {dt,
         kick,
         before,
         1.0 / (1.0 + options.reflect),
         leapfrog ? 0.5 * dt / kick : 0.0,
         std::fabs(kick - before) > DIFFERENT_DT * kick,
         false};
  dt_before = dt;
  results.iterations = 0.0;
  undo_half_kick();
}

/** Does the flow of the step before go on? It does not if forces, or bodies, are others than at the
 *  end of the last run: these must not act in place of those before from the middle of the last
 *  step on. Collective. */
bool MPMFlow::continues()
{
  if (!first_of_run) return true;
  first_of_run = false;
  double size;
  const double sum = sum_over_points(atom->f, size);
  const bool same = std::fabs(sum - force_before) <= SAME * size;
  return was_leapfrog == is_leapfrog() && same && !(parts.bodies && parts.bodies->any_new());
}

/** Velocities in the middle of the last step. New ones are those of now. */
void MPMFlow::undo_half_kick()
{
  if (begins && parts.bodies) parts.bodies->forget();
  const int dim = parts.cells.lattice.dim;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!parts.cells.is_point(i)) continue;
    for (int d = 0; d < dim && !begins; d++) atom->v[i][d] -= half_kick[i][d];
    std::fill_n(half_kick[i], dim, 0.0);
  }
}

void MPMFlow::find_flow()
{
  const double kick = now.kick, before = now.dt_before;
  std::vector<double> impulse;
  if (begins && is_leapfrog()) {
    momentum.strike();
    impulse = parts.pressure->psi;
    fields.initial = fields.predicted = fields.velocity;
  }
  momentum.solve(now.part * (now.differs ? before : kick));
  for (std::size_t k = 0; k < impulse.size(); k++)
    parts.pressure->psi[k] += now.part * kick / now.dt * impulse[k];
  momentum.find_pressures(now.part * (now.differs ? before : kick) *
                          liquids.acceleration_per_stress());
  if (options.reflect > 0.0) {
    const double again = options.reflect * (now.differs ? kick / before : 1.0);
    fields.change.resize(fields.velocity.size());
    for (std::size_t k = 0; k < fields.velocity.size(); k++)
      fields.change[k] = again * (fields.velocity[k] - fields.initial[k]);
  }
  if (now.differs) {
    fields.predicted = fields.initial;
    momentum.solve(now.part * kick);
  }
}

void MPMFlow::find_cells()
{
  const auto last =
      sum_last_step(parts.cells.valid && (!parts.grains || parts.cells.visitors_in_reach()));
  parts.cells.valid = last[0] == 0.0;
  if (!is_new) energy.look(last[4], last[5], last[6], atom->natoms);
  find_share(last[1], last[2]);
  if (parts.grains && !parts.cells.valid) parts.grains->list();
  parts.cells.find_cells();
}

void MPMFlow::find_apertures()
{
  parts.regions->find(now.dt);
  if (parts.stick) parts.stick->find(false);
}

void MPMFlow::points_to_faces()
{
  if (is_new) find_start();
  give_to_cells(parts.cells, points_now(now.dt), fields.sums);
  parts.cells.sum(fields.sums.data(), 3 * parts.cells.lattice.dim + 1);
  find_velocities();
  if (is_new) {
    fields.predicted = fields.start;
    parts.cells.reflect_velocities(fields.predicted.data());
  } else if (begins)
    fields.start = fields.predicted;
  now.keeps = options.flip > 0.0 || options.transfer == MPMIncompressibleOptions::AUTO;
  if (now.keeps || options.reflect > 0.0 || now.differs || begins)
    fields.initial = fields.predicted;
}

void MPMFlow::find_wet_cells()
{
  parts.pressure->find_wet(fields.filled);
  if (parts.gas) parts.gas->find(fields.filled, fields.predicted.data());
}

void MPMFlow::faces_to_points()
{
  double shift_energy[2] = {0.0, 0.0}, step_energy[4] = {0.0, 0.0, 0.0, 0.0};
  const MPMFlowUpdate update = {
      options.flip,
      !now.keeps   ? nullptr
          : begins ? fields.start.data()
                   : fields.initial.data(),
      options.reflect,
      options.reflect > 0.0 ? fields.change.data() : nullptr,
      now.half_kick_share,
      begins && now.half_kick_share > 0.0 ? fields.initial.data() : nullptr,
      options.spread > 0.0 ? fields.shift.data() : nullptr,
      parts.regions.get(),
      parts.inflow.get(),
      parts.solids.get(),
      options.transfer == MPMIncompressibleOptions::AUTO ? unseen : nullptr,
      shift_energy,
      gains(),
      step_energy,
      options.sharp ? fields.paths.data() : nullptr,
      liquids.largest_viscosity,
      parts.viscosities.get()};
  parts.cells.valid = get_from_cells(parts.cells, points_now(now.dt), fields.velocity.data(),
                                     update, fields.pressures.data(), MPMPoints::get(atom)->tau);
  energy.kinetic = 0.5 * force->mvv2e * step_energy[0];
  energy.work += step_energy[1];
  energy.in_play = options.h *
      (std::max(IN_PLAY, options.tolerance) * (step_energy[2] + step_energy[3]) +
       SIZE_OF_POINTS * step_energy[3]);
  energy.counts = only_forces_work(parts, options);
  if (parts.solids) energy.work -= parts.solids->take_work();
  spreading_energy += force->mvv2e * shift_energy[0] - shift_energy[1];
  is_new = begins = false;
  was_leapfrog = is_leapfrog();
}

/** Sums over all ranks: number of ranks whose cells are not those of their points,
 *  MPMFlowUpdate::squares of the last step, the energy of spreading, and those of MPMFlowEnergy. */
std::array<double, 7> MPMFlow::sum_last_step(bool valid) const
{
  const std::array<double, 7> mine = {valid ? 0.0 : 1.0, unseen[0],      unseen[1],
                                      spreading_energy,  energy.kinetic, energy.work,
                                      energy.in_play};
  std::array<double, 7> all;
  MPI_Allreduce(mine.data(), all.data(), 7, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

/** Have numerical errors added so much energy that points have to lose some? */
bool MPMFlow::gains() const
{
  return energy.gain() > (parts.solids ? GAIN_OF_SOLIDS : GAIN);
}

/** Share that points keep by default. */
void MPMFlow::find_share(double unseen_square, double bend_square)
{
  if (options.transfer_is_given && options.transfer != MPMIncompressibleOptions::AUTO) return;
  const double rest = std::sqrt(unseen_square), smooth = std::sqrt(bend_square);
  if (gains())
    options.flip = 0.0;
  else if (options.transfer != MPMIncompressibleOptions::AUTO)
    options.flip = FLIP_OF_BODIES;
  else
    options.flip = smooth > 0.0
        ? FLIP_OF_SMOOTH * std::clamp((NOISY - rest / smooth) / (NOISY - SMOOTH), 0.0, 1.0)
        : 0.0;
}

/** At the end of a run: warns of energy that numerical errors have added to its points. */
void MPMFlow::report_gain()
{
  const auto [gain, most] = energy.largest_gain();
  if (comm->me || !(gain > (parts.solids ? GAIN_OF_SOLIDS : MUCH_GAIN))) return;
  error->warning(
      FLERR,
      "{}: numerical errors have added up to {:.0f} % of the largest kinetic energy ({:.4g}) to "
      "the points in this run: {}; use a smaller spacing{}",
      who, 100.0 * gain, most,
      parts.solids ? "solids, whose surfaces lie between nodes, have been damped"
                   : "films and jets are thinner than the node spacing",
      options.transfer == MPMIncompressibleOptions::APIC ? "" : ", or transfer apic");
}

MPMFlowPoints MPMFlow::points_now(double dt) const
{
  return {atom->x, atom->v, atom->f, atom->rmass, atom->vfrac, gradient, dt, half_kick};
}

/** Velocities of faces from the momentum of points, and filled shares; both are complete. */
void MPMFlow::find_velocities()
{
  const int dim = parts.cells.lattice.dim, width = 3 * dim + 1;
  const double per_cell = 1.0 / parts.cells.lattice.cell_volume();
  fields.predicted.resize(parts.cells.size() * dim);
  fields.filled.resize(parts.cells.size());
  for (int64_t k = 0; k < parts.cells.size(); k++) {
    const double *const from = fields.sums.data() + k * width;
    for (int c = 0; c < dim; c++)
      fields.predicted[k * dim + c] = from[dim + c] > 0.0 ? from[c] / from[dim + c] : 0.0;
    fields.filled[k] = per_cell * from[3 * dim];
  }
  parts.cells.reflect_velocities(fields.predicted.data());
  parts.cells.reflect_cells(fields.filled.data());
  if (parts.regions) parts.regions->normalize(fields.filled);
}

/** Densities of faces, from the mass and the volume that points give them. */
void MPMFlow::find_inverse_densities()
{
  const int dim = parts.cells.lattice.dim, width = 3 * dim + 1;
  give_volumes_to_faces(parts.cells, points_now(now.dt), fields.face_volumes);
  parts.cells.sum(fields.face_volumes.data(), 2 * dim);
  fields.inverse_density.assign(parts.cells.size() * dim, 1.0);
  for (int64_t k = 0; k < parts.cells.size(); k++)
    for (int c = 0; c < dim; c++) {
      const double mass = fields.sums[k * width + dim + c];
      if (mass > 0.0)
        fields.inverse_density[k * dim + c] =
            options.density * fields.face_volumes[2 * k * dim + dim + c] / mass;
    }
  parts.pressure->inverse_density = &fields.inverse_density;
}

/** Notes the volume that points fill. */
void MPMFlow::find_filled_volume()
{
  results.wet = (double) parts.pressure->nwet();
  results.filled = 0.0;
  for (const auto &cell : parts.cells.cells)
    results.filled += std::min(1.0, fields.filled[cell.number]) *
        (parts.regions ? parts.regions->volume_fraction(cell.number) : 1.0);
  results.filled *= parts.cells.lattice.cell_volume();
}

/* ----------------------------------------------------------------------
   Velocities that points have been given, before the first step or since the last one, are those of
   no flow: they may have divergence, and go through walls. The lattice then must not take them for
   such that a wall has stopped. An image behind the wall, with the opposite velocity, would already
   slow down the faces next to it, and their gradients would be those of a flow that is at rest at
   the wall.
------------------------------------------------------------------------- */

/** Velocities of faces as points give them, without walls. */
void MPMFlow::find_free_velocities(const MPMFlowPoints &points)
{
  const int dim = parts.cells.lattice.dim, width = 3 * dim + 1;
  give_to_cells(parts.cells, points, fields.sums);
  parts.cells.sum_freely(fields.sums.data(), width);
  fields.start.resize(parts.cells.size() * dim);
  for (int64_t k = 0; k < parts.cells.size(); k++)
    for (int c = 0; c < dim; c++) {
      const double mass = fields.sums[k * width + dim + c];
      fields.start[k * dim + c] = mass > 0.0 ? fields.sums[k * width + c] / mass : 0.0;
    }
}

/** Points that begin with a velocity get its gradient, too, because the lattice would otherwise get
 *  a mean over a cell. */
void MPMFlow::fit_gradients(const MPMFlowPoints &points)
{
  const int n = flow_slopes(parts.cells.lattice.dim);
  for (int i = 0; i < atom->nlocal; i++)
    if (parts.cells.is_point(i)) std::fill_n(points.gradient[i], n, 0.0);
  std::vector<double> before;
  for (int pass = 0; pass < FITS; pass++) {
    before.swap(fields.start);
    find_free_velocities(points);
    before.resize(fields.start.size());
    double mine[2] = {0.0, 0.0}, most[2];
    for (std::size_t k = 0; k < before.size(); k++) {
      mine[0] = std::max(mine[0], std::fabs(fields.start[k] - before[k]));
      mine[1] = std::max(mine[1], std::fabs(fields.start[k]));
    }
    MPI_Allreduce(mine, most, 2, MPI_DOUBLE, MPI_MAX, world);
    if (pass > 0 && most[0] <= FITTED * most[1]) break;
    get_gradients(parts.cells, points, fields.start.data(), FIT);
  }
}

/** Velocities of faces before walls stop them. Transfers without gradients need these for this step
 *  only. */
void MPMFlow::find_start()
{
  auto points = points_now(now.dt);
  const int n = flow_slopes(parts.cells.lattice.dim);
  std::vector<double> for_this_step;
  if (!gradient) {
    for_this_step.resize((std::size_t) n * atom->nlocal);
    points.gradient = {for_this_step.data(), n};
    fit_gradients(points);
  }
  find_free_velocities(points);
}

/** A sum over values [n][3] of the points of all ranks, with the mass and another factor of each
 *  point, so that it differs if any of them differs. size: the sum of their magnitudes. */
double MPMFlow::sum_over_points(double **values, double &size) const
{
  double mine[2] = {0.0, 0.0}, all[2];
  for (int i = 0; i < atom->nlocal; i++)
    if (parts.cells.is_point(i))
      for (int d = 0; d < parts.cells.lattice.dim; d++) {
        const double value = atom->rmass[i] * values[i][d];
        mine[0] += std::cos((double) atom->tag[i] + d) * value;
        mine[1] += std::fabs(value);
      }
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  size = all[1];
  return all[0];
}

/** Notes the sums by which the next run sees that velocities or forces are others. */
void MPMFlow::find_sums()
{
  double size;
  sum_before = sum_over_points(atom->v, size);
  force_before = sum_over_points(atom->f, size);
}

void MPMFlow::end_run()
{
  running = false;
  if (is_new) return;
  find_sums();
  report_gain();
}

/* ----------------------------------------------------------------------
   Interpolation with quadratic splines adds h^2/8 of its second derivative along its own axis to a
   component. Here as much of the second differences along all axes is taken from all components,
   which keeps a field without divergence free of divergence. Where a neighbor has no velocity, far
   out in the air, there is no such difference.
------------------------------------------------------------------------- */

void MPMFlow::find_paths()
{
  const int dim = parts.cells.lattice.dim;
  fields.paths.assign(fields.velocity.size(), 0.0);
  for (const auto &cell : parts.cells.cells)
    for (int c = 0; c < dim; c++) {
      const int64_t face = (int64_t) cell.number * dim + c;
      double second = 0.0;
      for (int d = 0; d < dim; d++) {
        const int64_t lower = (int64_t) cell.near[2 * d] * dim + c,
                      upper = (int64_t) cell.near[2 * d + 1] * dim + c;
        const bool have_lower = fields.known[lower] > 0.0 ||
            parts.cells.ends_at_wall(cell, c, 2 * d),
                   have_upper = fields.known[upper] > 0.0 ||
            parts.cells.ends_at_wall(cell, c, 2 * d + 1);
        if (have_lower && have_upper)
          second += fields.velocity[lower] - 2.0 * fields.velocity[face] + fields.velocity[upper];
      }
      fields.paths[face] = fields.velocity[face] - SMOOTHED * second;
    }
  parts.cells.publish(fields.paths.data(), dim);
  parts.cells.reflect_paths(fields.paths.data());
}

/** Finds displacements by which points that are too close spread again. */
void MPMFlow::find_shift()
{
  fields.shift.resize(fields.predicted.size());
  fields.known.assign(fields.predicted.size(), 0.0);
  fields.shift.assign(fields.predicted.size(), 0.0);
  const auto report = parts.pressure->spread(
      options.spread, fields.shift.data(), fields.known.data(),
      {SPREAD_TOLERANCE, std::numeric_limits<double>::min(), options.most_iterations});
  if (!report.converged())
    error->all(FLERR, Error::NOLASTLINE,
               "{}: the spreading of points {} at step {}; allow more iterations", who,
               report.describe(), update->ntimestep);
  parts.air->extend(fields.shift, fields.known);
  if (parts.regions) parts.regions->hold(fields.shift, false);
  parts.cells.reflect_velocities(fields.shift.data(), false);
}

void MPMFlow::check_speed()
{
  const int dim = parts.cells.lattice.dim;
  double most[1] = {0.0}, all[1];
  const auto look_at = [&](double v) {
    if (!std::isfinite(v)) most[0] = std::numeric_limits<double>::infinity();
    most[0] = std::max(most[0], std::fabs(v));
  };

  // the velocity of a moving wall is between those of faces next to it and of images beyond, which
  // are twice as fast, but move nothing

  for (const auto &cell : parts.cells.cells)
    for (int c = 0; c < dim; c++) look_at(fields.velocity[(int64_t) cell.number * dim + c]);
  for (int d = 0; d < dim; d++)
    for (const auto &wall : options.walls[d])
      for (int c = 0; c < dim; c++)
        if (wall.sticks) look_at(wall.v[c]);
  MPI_Allreduce(most, all, 1, MPI_DOUBLE, MPI_MAX, world);

  fastest = all[0];
  if (all[0] * update->dt <= MPMFlowLattice::MOST_MOTION * options.h) return;
  // what hits a wall flat is several times faster after the step: no limit by earlier speeds can
  // predict that

  const bool is_set = !modify->get_fix_by_style("^mpm/dt$").empty();
  error->all(
      FLERR, Error::NOLASTLINE,
      "{}: at step {} the velocity {:.6g} is more than {} node spacings in a time "
      "step of {:.6g}; {}",
      who, update->ntimestep, all[0], MPMFlowLattice::MOST_MOTION, update->dt,
      is_set ? "where something hits a wall, water, or a solid it is several times faster after "
               "one step: "
               "give fix mpm/dt a smaller fraction, such as 0.4, or a smaller max"
             : "reduce it, or let fix mpm/dt set it");
}

double MPMFlow::stable_dt(tagint &tag) const
{
  double dt = std::numeric_limits<double>::max();
  tag = 0;
  if (liquids.largest_viscosity > 0.0 && !options.implicit)
    dt = MPMFlowViscosity::stable_dt(liquids.largest_kinematic_viscosity(), options.h,
                                     parts.cells.lattice.dim);
  if (parts.solids) {
    tagint stiffest = 0;
    const double shear = parts.solids->stable_dt(stiffest);
    if (shear < dt) {
      dt = shear;
      tag = stiffest;
    }
  }
  if (options.tension > 0.0)
    dt = std::min(
        dt,
        MPMFlowTension::stable_dt(options.tension * liquids.acceleration_per_stress(), options.h));

  if (!forces_known && limit_before > 0.0) dt = std::min(dt, limit_before);
  dt = limit_of_motion(dt, tag);
  if (dt == 0.0) return 0.0;
  double moving = parts.regions ? parts.regions->largest_speed()
                                : 0.0;    // points next to it move with it
  for (const auto &axis_walls : options.walls)
    for (const auto &face : axis_walls)
      if (face.sticks && liquids.largest_viscosity > 0.0)
        moving = std::max(moving, MathExtra::len3(face.v));
  if (moving * dt > options.h) {
    dt = options.h / moving;
    tag = 0;
  }
  if (forces_known) limit_before = dt;
  return dt;
}

/** Limit by the velocity and acceleration of points, at most dt; 0: a velocity is not finite. At
 *  the start of a run there are no forces yet. Those at the end of the last run count by the limit
 *  that they gave, also if that run has written the restart file; at the start of the first run,
 *  gravity counts. */
double MPMFlow::limit_of_motion(double dt, tagint &tag) const
{
  double g[3] = {0.0, 0.0, 0.0};
  if (!forces_known && !(limit_before > 0.0)) MPMGravity{lmp}.find(g);
  const double least = FIRST_FALL * MathExtra::len3(g) * force->ftm2v;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!parts.cells.is_point(i)) continue;
    double square = 0.0, force_square = 0.0;
    for (int d = 0; d < parts.cells.lattice.dim; d++) {
      square += atom->v[i][d] * atom->v[i][d];
      force_square += atom->f[i][d] * atom->f[i][d];
    }
    const double a = std::max(least, std::sqrt(force_square) * force->ftm2v / atom->rmass[i]);
    const double speed = 0.5 * (std::sqrt(square) + std::sqrt(square + 4.0 * a * options.h));
    if (speed * dt > options.h) {
      dt = options.h / speed;
      tag = atom->tag[i];
    } else if (!std::isfinite(speed)) {
      tag = atom->tag[i];
      return 0.0;
    }
  }
  return dt;
}

/* ----------------------------------------------------------------------
   Between runs, forces are no longer those of points: the command write_restart gives points to
   other processes without their forces. Velocities may be others by then, which the next run has to
   see. So what the end of the last run has left counts.
------------------------------------------------------------------------- */

std::vector<double> MPMFlow::restart_data()
{
  tagint tag;
  if (running) find_sums();
  double mine = running ? stable_dt(tag) : limit_before, limit;
  MPI_Allreduce(&mine, &limit, 1, MPI_DOUBLE, MPI_MIN, world);
  keep_totals(world, &spreading_energy, 1);
  keep_totals(world, &energy.work, 1);
  const auto last = sum_last_step(true);
  std::vector<double> state = {dt_before,
                               limit,
                               last[1],
                               last[2],
                               last[3],
                               results.halvings,
                               0.0,
                               0.0,
                               sum_before,
                               force_before,
                               (double) was_leapfrog};
  const auto energies = energy.state(last[4], last[5], last[6]);
  state.insert(state.end(), energies.begin(), energies.end());
  if (parts.regions) {
    const auto motion = parts.regions->motion();
    state[6] = (double) motion.size();
    state.insert(state.end(), motion.begin(), motion.end());
  }
  if (parts.gas) {
    const auto gas = parts.gas->restart_data();
    state[7] = (double) gas.size();
    state.insert(state.end(), gas.begin(), gas.end());
  }
  return state;
}

void MPMFlow::restart(const std::string &id, const char *buf)
{
  constexpr std::size_t NFIXED = 11 + MPMFlowEnergy::NREAL;
  const auto all = read_state(lmp, id, buf);
  if (all.size() < NFIXED * sizeof(double)) refuse_state(lmp, id);
  const auto *const state = (const double *) all.data();
  const double *const from = state + NFIXED;
  dt_before = state[0];
  limit_before = state[1];
  for (int k = 0; k < 2; k++) unseen[k] = comm->me ? 0.0 : state[2 + k];
  spreading_energy = comm->me ? 0.0 : state[4];
  results.halvings = state[5];
  sum_before = state[8];
  force_before = state[9];
  was_leapfrog = state[10] > 0.0;
  energy.set_state(state + 11, comm->me == 0);
  const auto nmotion = (std::size_t) state[6], ngas = (std::size_t) state[7];
  if (all.size() != (NFIXED + nmotion + ngas) * sizeof(double)) refuse_state(lmp, id);
  if (parts.regions) parts.regions->set_motion({from, from + nmotion});
  if (parts.gas && !parts.gas->restart(from + nmotion, ngas))
    error->all(FLERR, Error::NOLASTLINE,
               "{}: the gas in the restart file is that of a lattice with another node "
               "spacing: use the same one",
               who);
}
