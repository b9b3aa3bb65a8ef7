/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_time_limit.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_cpdi.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_guard.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_passes.h"
#include "field/mpm_physics.h"
#include "field/mpm_point_map.h"
#include "field/mpm_setup_checks.h"
#include "field/mpm_stencil.h"
#include "force.h"
#include "material/batch_kernels.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int CHECK_EVERY = 20;    // steps between checks of the time step

void MPMTimeLimit::setup()
{
  next_check = update->ntimestep;
  if (update->nsteps > 0 && !(field.step_dt() >= SMALLEST))
    error->all(FLERR, Error::NOLASTLINE,
               "Time step {:.6g} is below the smallest one of fix mpm, {:.6g}", field.step_dt(),
               SMALLEST);
  if (update->nsteps <= 0 || !field.options.dt_check || !bound) return;
  check();
  warn();
  if (field.plan->fields[0] == &field) warn_of_small();
}

double MPMTimeLimit::stable_dt(tagint &id_min, double &wave_speed) const
{
  Batch &b = *field.batch;
  static const double no_gradient[9 * BATCH] = {0.0};
  double c[BATCH], smallest = std::numeric_limits<double>::max();
  id_min = 0;
  wave_speed = 0.0;
  for (const auto *physics : field.plan->physics) {
    tagint tag = 0;
    const double dt = physics->stable_dt(field, tag);
    if (dt < smallest) {
      smallest = dt;
      id_min = tag;
    }
  }

  const auto limits = [&](int i, double speed) {
    if (speed * smallest <= field.lattice.h) return false;    // a NaN must not be skipped
    smallest = field.lattice.h / speed;
    id_min = atom->tag[i];
    return true;
  };

  for (int i = 0, last; i < atom->nlocal && !std::isnan(smallest); i = last) {
    last = i + 1;
    if (!field.is_point(i)) continue;
    if (field.is_element_node(i)) {    // must not cross a cell; the rest: FixMPMElements
      if (!field.frame->is_total()) limits(i, sqrt(dot(atom->v[i], atom->v[i])));
      continue;
    }

    // consecutive points of one material
    const FixMPMMaterial *material = field.material_of(i);
    while (last < atom->nlocal && last < i + BATCH && field.is_point(last) &&
           field.material_of(last) == material && !field.is_element_node(last))
      last++;
    const int n = last - i, nhistory = material->nhistory;
    field.batch_kernels->load(b, n, 0.0, no_gradient, field.points->F[i], field.points->tau[i],
                              atom->vfrac + i, no_gradient);
    b.history = reinterpret_cast<double(*)[BATCH]>(field.work.history.data());
    for (int p = 0; p < n; p++)
      for (int k = 0; k < nhistory; k++) b.history[k][p] = material->history[i + p][k];
    material->material->wave_speed(b, c);
    for (const auto *physics : field.plan->physics)
      for (int p = 0; p < n; p++) c[p] = physics->wave_speed(field, i + p, c[p]);

    for (int p = 0; p < n && !std::isnan(smallest); p++)
      if (limits(i + p, field.frame->speed(i + p, c[p], field.lattice.h / smallest)))
        wave_speed = c[p];
  }
  return smallest;
}

/** Inverted points are errors anyway. */
void MPMTimeLimit::note_volume_rate(const Batch &b, int first)
{
  double most = 0.0;
  for (int p = 0; p < b.n; p++) most = std::max(most, fabs(b.J[p] / b.Jold[p] - 1.0));
  if (!(most > volume_rate.most * b.dt)) return;
  int fastest = 0;
  while (fastest < b.n - 1 && fabs(b.J[fastest] / b.Jold[fastest] - 1.0) < most) fastest++;
  volume_rate = {most / b.dt, atom->tag[first + fastest]};
}

void MPMTimeLimit::check()
{
  if (!field.options.dt_check || !bound || update->ntimestep < next_check) return;
  next_check = update->ntimestep + CHECK_EVERY;
  for (auto *ifix : field.elements)
    if (field.plan->fields[0] == &field) ifix->check_dt();
  tagint tag;
  double c;
  const double limit = stable_dt(tag, c);
  if (!(field.step_dt() <= limit)) {
    int i = 0;
    while (i < atom->nlocal - 1 && atom->tag[i] != tag) i++;
    const std::string remedy = remedy_of_step(lmp);
    if (c == 0.0)    // dtcheck no would not make it stable
      for (const auto *physics : field.plan->physics) {
        const auto *const ifix = dynamic_cast<const Fix *>(physics);
        if (!ifix || physics->stable_dt(field, tag) > limit) continue;
        error->one(FLERR,
                   "Time step {:.6g} is above the limit {:.6g} of fix {} {} at step {}: {}; {}{}",
                   field.step_dt(), limit, ifix->style, ifix->id, update->ntimestep,
                   field.guard->describe(i), remedy,
                   utils::strmatch(ifix->style, "^mpm/heat$") ? ", more of its stages, or its "
                                                                "keyword time sdirk2"
                       : utils::strmatch(ifix->style, "^mpm/pore$") ? ", or more of its stages"
                                                                    : "");
      }
    error->one(
        FLERR,
        "Time step {:.6g} is above the limit {} = {:.6g} at step {}: {}, wave speed {:.6g}; {}",
        field.step_dt(), field.frame->is_total() ? "s h/c (s: smallest stretch)" : "h/(c+|v|)",
        limit, update->ntimestep, field.guard->describe(i), c,
        remedy + ", or fix mpm ... dtcheck no");
  }
}

/** Largest stable time step relative to h/(c + |v|), where it is below 1: the smallest value that
 *  bench/extremes has measured, rounded down. With points of finite size it is proportional to the
 *  square root of their half size s in node spacings, as a node that they barely reach has the
 *  ratio E/(rho h^2 s) of stiffness and mass. Linear functions without any limit have warnings of
 *  their own, see blend_light_nodes() and share_of_thin_nodes(). */
double MPMTimeLimit::stable_share(double size) const
{
  const auto &options = field.options;
  const Shape shape = options.shape;
  const auto scheme = options.scheme;
  const bool usl = scheme == MPMFieldOptions::USL, affine = is_affine(options.transfer);
  const bool fmpm = options.series == MPMFieldOptions::FMPM;
  if (field.boxes) {
    const double share = fmpm ? 0.37 : (usl ? 0.5 : (affine ? 0.55 : 1.0));
    return usl ? std::min(share, 1.25 * share / 0.5 * sqrt(size)) : share;
  }
  if (fmpm) return 0.4;
  if (shape == LINEAR && options.changes_cells()) {
    if (options.has_light_nodes()) return scheme == MPMFieldOptions::USF ? 0.28 : 0.7;
    if (usl) return 0.65;
    if (affine) return 0.9;
    return scheme == MPMFieldOptions::USAVG ? 1.0 : (scheme == MPMFieldOptions::USF ? 0.25 : 0.65);
  }
  if (affine) {
    if (shape == CUBIC) return 1.0;
    if (options.transfer == TPIC && shape == QUADRATIC) return usl ? 0.7 : 0.85;
    return shape == BERNSTEIN ? 0.8 : (shape == QUADRATIC ? 0.95 : (options.total ? 0.75 : 0.85));
  }
  if (!usl) return 1.0;
  const int order = stencil_order(shape);
  return order == 1 ? 0.6 : (order == 2 ? 0.55 : 0.9);
}

/** The total frame has no remedy for light nodes, but its lattice does not change: the largest
 *  stable time step in h/c is known. A node with the stiffness k = sum_p V_p E |grad N_ip|^2 and
 *  the mass m = sum_p m_p N_ip is stable for dt < (m/k)^1/2 with USL; trials agree within 15 %, and
 *  give 1.6 times as much with affine matrices. Bernstein functions of the middle of a cell begin
 *  like linear ones. */
double MPMTimeLimit::share_of_thin_nodes() const
{
  const auto &options = field.options;
  const bool bernstein = options.shape == BERNSTEIN;
  if (!options.total || options.has_light_nodes() ||
      !(options.scheme == MPMFieldOptions::USL || is_affine(options.transfer)) ||
      !(options.shape == LINEAR || bernstein))
    return 1.0;
  field.plan->find_blocks_now();
  const Grid &grid = field.grid;
  const MPMStencil stencil(field);
  constexpr int NREAL = 2;
  std::vector<double> sums(grid.nnodes() * NREAL, 0.0);
  each_point(field, [&](const MPMPointMap::Run &run, int i) {
    stencil.visit(grid.blocks[run.slot], i, [&](const MPMStencil::Node &node) {
      const double weight = node.weight, *const r = node.r;
      if (weight <= 0.0) return;
      double slope = 0.0;    // square of (grad N)/N
      int index[3];
      grid.node_index(node.number, index);
      for (int d = 0; d < field.lattice.dim; d++) {
        const double a = fabs(r[d]);
        if (!bernstein)
          slope += 1.0 / ((1.0 - a) * (1.0 - a));
        else if (index[d] % 2)
          slope += 4.0 * a * a / ((1.0 - a * a) * (1.0 - a * a));
        else
          slope += 1.0 / ((1.0 - 0.5 * a) * (1.0 - 0.5 * a));
      }
      sums[node.number * NREAL] += atom->vfrac[i] * weight;
      sums[node.number * NREAL + 1] += atom->vfrac[i] * weight * weight * slope;
    });
  });
  field.nodes.sum(sums.data(), NREAL, 0, NREAL);
  double mine = 0.0, all;
  for (std::size_t k = 0; k < sums.size(); k += NREAL)
    if (sums[k] > 0.0) mine = std::max(mine, sums[k + 1] / sums[k]);
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_MAX, world);
  return all > 1.0 ? 1.0 / sqrt(all) : 1.0;
}

void MPMTimeLimit::warn() const
{
  tagint tag;
  double c, mine[2] = {stable_dt(tag, c), 0.5}, all[2];
  if (field.boxes) mine[1] = field.boxes->smallest();
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_MIN, world);
  const double share = std::min(stable_share(all[1]), share_of_thin_nodes());
  if (comm->me == 0 && share < 1.0 && field.step_dt() > share * all[0])
    error->warning(
        FLERR,
        "Fix mpm {}: the time step is {:.3g} h/(c+|v|), but this shape, transfer and scheme can be "
        "unstable above {:.2g}, depending on where points are in their cells: use fix mpm/dt "
        "{:.2g} or less, or another scheme{}",
        field.id(), field.step_dt() / all[0], share, share,
        field.frame->is_total() ? ", or an origin for which faces of the body are on nodes" : "");
}

/** Warns if nobody has set the time step, and the default of the units is that of atoms: for most
 *  bodies so small that nothing moves. If a pair style indicates atoms or grains, it may be right,
 *  unless it is tiny. A time step that was set for other reasons than these points (grains, finite
 *  elements, heat or pore water), or by fix mpm/dt, may have to be small. */
void MPMTimeLimit::warn_of_small() const
{
  constexpr double SMALL = 1.0e-2;    // share of the limit below which a time step is small
  tagint tag;
  double c, mine = std::numeric_limits<double>::max(), limit;
  for (const auto *other : field.plan->fields)
    mine = std::min(mine, other->time_limit->stable_dt(tag, c));
  MPI_Allreduce(&mine, &limit, 1, MPI_DOUBLE, MPI_MIN, world);
  if (limit == std::numeric_limits<double>::max() || comm->me) return;    // there are no waves
  if (!find_fixes(lmp, {"^mpm/dt$", "^dt/reset"}).empty()) return;
  const double dt = field.step_dt();
  if (update->dt_default) {
    if (dt < (force->pair ? 0.1 : 1.0) * SMALL * limit)
      error->warning(FLERR,
                     "Fix mpm: the time step {:.3g}, which no command has set since units {} or "
                     "read_restart, is next to nothing for the limit {:.3g} of these points: use "
                     "fix mpm/dt 0.5, or timestep",
                     dt, update->unit_style, limit);
    return;
  }
  const bool alone = !force->pair && field.elements.empty() && field.plan->physics.empty() &&
      find_fixes(lmp, {"^mpm/rigid$"}).empty();    // bodies that turn have a limit of their own
  if (alone && dt < SMALL * limit)
    error->warning(FLERR,
                   "Fix mpm: the time step {:.3g} is far below the limit {:.3g} of these points: "
                   "fix mpm/dt 0.5 would take {:.0f} times fewer steps",
                   dt, limit, 0.5 * limit / dt);
}

double LAMMPS_NS::elapsed_time(const Update &update)
{
  return update.atime + (double) (update.ntimestep - update.atimestep) * update.dt;
}
