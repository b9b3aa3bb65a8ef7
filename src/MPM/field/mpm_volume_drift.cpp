/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Once in a number of steps, it is found by how much the volumes of points of liquids change until
 *  the next time,
 *
 *    d ln V_p = - rate g sum_i N_ip (f_i - 1)  +  3.75 rate g (p_p - sum_i N_ip <p>_i)/K,
 *    p = K (1 - J)
 *
 *  where g is the strain since the last time, K the stiffness at rest, and sums are over nodes
 *  inside. The first term ties the pressure to the places of the points: where they are too close
 *  together, it rises and drives them apart. What single points would gather of it, unseen by the
 *  nodes, the second one spreads over their neighbors. Both are proportional to the strain, as is
 *  the error, so that nothing happens at rest and no time scale comes in. Each step has its part of
 *  the change, as all of it at once would make waves. Why: see DECISIONS.md. */

#include "field/mpm_volume_drift.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_doubts.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_passes.h"
#include "field/mpm_time_limit.h"
#include "force.h"
#include "material/material.h"
#include "material/material_point.h"
#include "math_special.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

using MathSpecial::square;

// difference of the pressures of points of a gas from the means around them, relative to these,
// that is told: below, the mean pressure is right within 2 %
static constexpr double MOST_SPREAD = 0.05;
// rms difference of fillings from one where points have run away from each other: .18 and more
// where pressures differ by so much, .003 in gas with shocks
static constexpr double LEAST_MISFIT = 0.02;
static const char NEXT_TO_REGIONS[] =
    "Use more points per cell, a larger drift, or a smaller spacing; give each side of a wall with "
    "concave edges a region and a fix mpm/boundary of its own";
static const char GAS_NEEDS[] =
    "Use four points per cell and axis, shape cubic, or cpdi, and transfer apic; a smaller spacing "
    "does not help. What is not meant to expand needs walls around it, or the pressure outside: "
    "fix mpm/traction free pressure";

// steps of the cycle from one look to the next, with and without a correction, and those of the
// mean that a warning is about: waves and splashes pass in less
static constexpr int CORRECT_EVERY = 30, LOOK_EVERY = 400, LOOK_AT_GAS = 200, LASTING = 1000;
// filling of the nodes around a point inside. Linear functions: of the nodes that a flat surface
// reaches, the last one may be half full, and round-off must not decide; wider ones: at most .17
static constexpr double FULL = 0.4, FULL_LINEAR = 0.53;
static constexpr double HARDLY = 1.0e-3;
static constexpr double REACH = 2.0;    // of the widest function [node spacings]
// share of the function of a node in the box that is next to nothing: points hardly sample it
static constexpr double LITTLE = 0.25;
// the same of nodes outside, next to a wall in a plane of nodes: one with less counts no more
static constexpr double LEAST_PART = 0.02;
// of nodes in regions: what points have gone there is an excess
static constexpr double NOTHING = 1.0e-9;
static constexpr double MOST_DRIFT = 0.02;    // mean difference of fillings from one: a warning
// standard deviations of that mean, and the largest difference that may be chance
static constexpr double DEVIATIONS = 3.0, MOST_CHANCE = 0.3;
// greatest share of an excess that is corrected at a time, and greatest excess: a larger change of
// the pressure would make noise; that share of differences of the pressure must be less than one
static constexpr double MOST_SHARE = 0.2, MOST_EXCESS = 0.3, SPREAD = 3.75;
// regular arrays have an excess next to walls, as sums are not integrals; full effect on pressures
static constexpr double LEAST_EXCESS = 0.0075, FULL_EXCESS = 0.02;

void MPMVolumeDrift::init()
{
  corrects = field.options.drift > 0.0 && !field.options.averages_strain() &&
      std::any_of(field.materials.begin(), field.materials.end(), [](const auto *material) {
               return material->volume_rate != nullptr;
             });
  // regions count only where there is liquid: solids next to walls may overlap them a little
  has_liquid = false;
  const auto present = field.present_materials();
  for (std::size_t k = 0; k < present.size(); k++)
    has_liquid = has_liquid || (present[k] && field.materials[k]->volume_rate);
  free_room.init();
  warned = cleared = false;
  inside = {};
  gas = {};
  gases.clear();
  for (const auto *material : field.materials)
    if (is_ideal_gas(*material->material)) gases.insert(material);
  stiffness.clear();
  if (!corrects) return;
  const double scale = force->mvv2e * force->nktv2p;    // of density velocity^2, in pressure units
  for (const auto *material : field.materials) {
    if (!material->volume_rate) continue;
    const double c = MaterialPoint(*material->material).wave_speed();
    stiffness[material] = scale * material->material->density() * c * c;
  }
}

int MPMVolumeDrift::looks_every() const
{
  // where the lattice is not in space, or points share the room with others, there is nothing to
  // compare
  if (field.options.total || field.frame->mean_rate || field.shares_room) return 0;
  if (corrects) return CORRECT_EVERY;
  return gases.empty() ? LOOK_EVERY : LOOK_AT_GAS;
}

/** Share of the integral of the function of a node along an axis that is in the box. */
double MPMVolumeDrift::part_along(int axis, int node) const
{
  const auto &lattice = field.lattice;
  if (lattice.periodic[axis]) return 1.0;
  const double low = (domain->boxlo[axis] - lattice.origin[axis]) / lattice.h,
               high = (domain->boxhi[axis] - lattice.origin[axis]) / lattice.h;
  if (node >= low + REACH && node <= high - REACH) return 1.0;
  const auto plain = [&](int i) {
    return integral_of_function(field.options.shape, high - i) -
        integral_of_function(field.options.shape, low - i);
  };
  double part = plain(node);
  if (field.nodes.edges)    // nodes outside have given theirs to those at the face and inside
    for (int side = 0; side < 2; side++) {
      const int face = (int) std::lround(side ? high : low), out = side ? 1 : -1;
      const double given = plain(face + out);
      if (node == face + out) return 0.0;
      if (node == face) part += 2.0 * given;
      if (node == face - out) part -= given;
    }
  return part;
}

/** The same along all axes. */
double MPMVolumeDrift::part_in_box(int64_t node) const
{
  int index[3];
  field.grid.node_index(node, index);
  double product = 1.0;
  for (int d = 0; d < field.lattice.dim; d++) product *= part_along(d, index[d]);
  return product;
}

/** Length of the circle around an axis of symmetry on which the part in the box of the function of
 *  a node is, in the mean. */
double MPMVolumeDrift::mean_circle(int64_t node) const
{
  constexpr int SLICES = 40;
  int index[3];
  field.grid.node_index(node, index);
  const auto &lattice = field.lattice;
  const MPMFrame &frame = *field.frame;
  const double radius = lattice.origin[0] / lattice.h + index[0];    // in node spacings
  if (radius >= REACH) return frame.circle(radius * lattice.h);
  double sum = 0.0, moment = 0.0;
  for (int k = 0; k < SLICES; k++) {
    const double from = -REACH + 2.0 * REACH * k / SLICES, to = from + 2.0 * REACH / SLICES,
                 middle = radius + 0.5 * (from + to);
    if (middle < 0.0) continue;
    const double share = integral_of_function(field.options.shape, to) -
        integral_of_function(field.options.shape, from);
    sum += share;
    moment += share * middle;
  }
  return sum > 0.0 ? frame.circle(moment / sum * lattice.h) : 0.0;
}

/** Does material fill a region around this node, as in a grip? Then it is no matter of room. In
 *  each row of nodes into a region there is one that hardly reaches out of it and all points
 *  inside. */
bool MPMVolumeDrift::is_in_wall(std::size_t n) const
{
  constexpr double CLOSED = 0.17, MUCH = 0.6;    // share that is left; filling of the other one
  return !share.empty() && share[n] < CLOSED &&
      field.work.nodes[field.pic.nreal * n + 3] >
      (share[n] + MUCH) * field.lattice.cell_volume() * part_in_box((int64_t) n);
}

/** Sums at nodes over the points with a material: work.nodes <- sum N V q and, in the fourth place,
 *  sum N V, of the vectors q, which have two components in 2d, and the weights V. */
void MPMVolumeDrift::sum_at_nodes()
{
  auto &work = field.work;
  const PointRows r = field.rows_at_rest(work.vectors.data(), work.weights.data());
  const TransferStep s = field.step_data(0.0);
  points_to(work.nodes, field, field.pic,
            [&](const MPMPointMap::Run &run, const int *base, int *box) {
              if (run.material)
                field.pic.p2g_momentum(r, s, run.first, run.last, base, field.map->tile, box);
            });
  field.nodes.sum(work.nodes.data(), field.pic.nreal, 0, 4);
}

/** work.vectors <- sum N q of what nodes have in their first places. */
void MPMVolumeDrift::interpolate()
{
  auto &work = field.work;
  const PointRows r = field.rows_at_rest(work.vectors.data(), work.weights.data());
  const TransferStep s = field.step_data(0.0);
  field.nodes.complete(work.nodes.data(), field.pic.nreal, 3);
  points_from(work.nodes, field, field.pic, [&](const MPMPointMap::Run &run, const int *base) {
    field.pic.g2p(r, s, run.first, run.last, base, field.map->tile_load, nullptr);
  });
}

/** Fillings, and in work.nodes the mean velocities of the points around. With an axis of symmetry,
 *  volumes are areas in the plane, of which sums of regular arrays are exact. Rings that have come
 *  to the axis have areas without bounds there, and volumes tell. Matter that has opened and bears
 *  no tension, as after spall, has voids in its volume, which take no room of others. */
void MPMVolumeDrift::find_filling()
{
  auto &work = field.work;
  const MPMFrame &frame = *field.frame;
  const MPMRows places = frame.places();
  const bool axis = field.options.axisymmetric;
  work.vectors.resize(3 * (std::size_t) atom->nmax);
  work.weights.resize(std::max(work.weights.size(), (std::size_t) atom->nmax));
  each_point(field, [&](const MPMPointMap::Run &, int i) {
    const double *const tau = field.points->tau[i], J = field.points->jacobian(i);
    const bool is_open = J > 1.0 && tau[0] + tau[1] + tau[2] == 0.0;
    work.weights[i] = atom->vfrac[i] * (is_open ? 1.0 : J) / frame.circle(places[i][0]);
    if (axis) work.vectors[3 * (std::size_t) i] = frame.circle(places[i][0]);
  });
  const int NREAL = field.pic.nreal;
  if (axis) {
    sum_at_nodes();
    circles.resize(field.grid.nnodes());
    for (std::size_t n = 0; n < circles.size(); n++) circles[n] = work.nodes[NREAL * n];
  }
  each_point(field, [&](const MPMPointMap::Run &, int i) {
    std::copy_n(atom->v[i], 3, &work.vectors[3 * (std::size_t) i]);
  });
  sum_at_nodes();
  const double cell = field.lattice.cell_volume();
  fill.assign(field.grid.nnodes(), 0.0);
  share.clear();
  if (has_liquid && free_room.is_cut()) free_room.find(work.nodes.data(), NREAL, share);
  part.resize(fill.size());
  for (std::size_t n = 0; n < fill.size(); n++) {
    double *const record = &work.nodes[NREAL * n];
    if (!(record[3] > 0.0)) continue;
    part[n] = part_in_box((int64_t) n);
    if (!share.empty() && !is_in_wall(n)) part[n] *= std::max(share[n], NOTHING);
    if (part[n] > 0.0) fill[n] = record[3] / (cell * part[n]);
    if (axis && part[n] > 0.0) {
      const double circle = mean_circle((int64_t) n),
                   by_volume = circles[n] / (cell * part[n] * circle);
      if (std::fabs(by_volume - 1.0) < std::fabs(fill[n] - 1.0)) fill[n] = by_volume;
      circles[n] = circle;
    }
    for (int d = 0; d < 3; d++) record[d] /= record[3];
  }
}

/** Strain of points from one look to the next, of the mean velocities: sqrt(2 D:D) times the
 *  time. */
void MPMVolumeDrift::find_strain()
{
  const int dim = field.lattice.dim;
  const double duration = CORRECT_EVERY * field.step_dt();
  const PointRows r = field.rows_at_rest(field.work.vectors.data(), field.work.weights.data());
  const TransferStep s = field.step_data(0.0);
  double L[9 * BATCH];
  change.resize(atom->nmax);
  field.nodes.complete(field.work.nodes.data(), field.pic.nreal, 3);
  points_from(field.work.nodes, field, field.pic,
              [&](const MPMPointMap::Run &run, const int *base) {
                for (int i = run.first; i < run.last; i += BATCH) {
                  const int n = std::min(BATCH, run.last - i);
                  field.pic.g2p_gradient(r, s, i, i + n, base, field.map->tile_load, L);
                  for (int p = 0; p < n; p++) {
                    const double *const l = L + dim * dim * p;
                    double square = 0.0;
                    for (int a = 0; a < dim; a++)
                      for (int b = 0; b < dim; b++) {
                        const double twice = l[dim * a + b] + l[dim * b + a];
                        square += 0.5 * twice * twice;
                      }
                    change[i + p] = duration * std::sqrt(square);
                  }
                }
              });
}

/** Nodes outside of walls, of whose functions next to nothing is in the box, do not make a
 *  surface. */
void MPMVolumeDrift::mark_points_at_surfaces()
{
  const Shape shape = field.options.shape;
  const double full = shape == QUADRATIC || shape == CUBIC ? FULL : FULL_LINEAR;
  auto &work = field.work;
  for (std::size_t n = 0; n < fill.size(); n++) {
    double *const record = &work.nodes[field.pic.nreal * n];
    record[0] = (fill[n] < full && part[n] > LITTLE) || is_in_wall(n);
    record[1] = record[2] = 0.0;
  }
  interpolate();
}

/** Sums over nodes inside. work.nodes: what a correction interpolates, the excess of volume and the
 *  mean pressure. */
void MPMVolumeDrift::find_inside()
{
  auto &work = field.work;
  const int NREAL = field.pic.nreal;
  for (const auto &run : field.map->runs) {
    const double K = rates(run.material) ? stiffness[run.material] : 0.0;
    for (int i = run.first; i < run.last; i++) {
      double *const q = &work.vectors[3 * (std::size_t) i];
      const double *const tau = field.points->tau[i];
      const double J = field.points->jacobian(i);
      q[0] = q[0] > HARDLY;
      q[1] = K > 0.0 ? K * (1.0 - J) : -(tau[0] + tau[1] + tau[2]) / (3.0 * J);
      q[2] = 0.0;
    }
  }
  sum_at_nodes();
  double mine[5] = {0.0}, all[5];
  for (std::size_t n = 0; n < fill.size(); n++) {
    double *const record = &work.nodes[NREAL * n];
    const double excess = fill[n] - 1.0;
    const bool is_inside = record[3] > 0.0 && record[0] < HARDLY * record[3];
    if (is_inside && field.grid.owns((int64_t) n)) {
      const double room = circles.empty() ? part[n] : part[n] * circles[n];
      mine[0] += 1.0;
      mine[4] += part[n] > LITTLE;
      mine[1] += room;
      mine[2] += room * excess;
      // little room that is too small for its points must not tell for all
      mine[3] += square(room * excess) / std::max(room, LEAST_PART * (room / part[n]));
    }
    record[0] = is_inside ? part[n] * excess : 0.0;
    record[2] = is_inside ? 0.0 : 1.0;
    if (record[3] > 0.0) record[1] /= record[3];
  }
  MPI_Allreduce(mine, all, 5, MPI_DOUBLE, MPI_SUM, world);
  inside.nodes = all[4] > 0.0 ? all[0] : 0.0;    // a layer of a cell has none but those in the wall
  if (inside.nodes == 0.0) return;
  inside.mean = 1.0 + all[2] / all[1];
  inside.rms = std::sqrt(all[3] / all[1]);
}

/** Mean difference of the pressures of points of gases from the means around them, relative to
 *  these. Of points all of whose nodes are inside, which another interpolation tells, as vectors
 *  have two components in 2d; each counts by its volume. */
void MPMVolumeDrift::find_spread()
{
  for (std::size_t n = 0; n < fill.size(); n++) {
    double *const record = &field.work.nodes[field.pic.nreal * n];
    record[0] = record[2];
  }
  interpolate();
  double mine[2] = {0.0}, all[2];
  for (const auto &run : field.map->runs) {
    if (!gases.count(run.material)) continue;
    for (int i = run.first; i < run.last; i++) {
      const double *const q = &field.work.vectors[3 * (std::size_t) i];
      if (q[0] > HARDLY) continue;
      const double *const tau = field.points->tau[i];
      const double J = field.points->jacobian(i), V = field.work.weights[i];
      mine[0] += V * std::fabs((tau[0] + tau[1] + tau[2]) / (3.0 * J) + q[1]);
      mine[1] += V * q[1];
    }
  }
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  gas.spread = all[1] > 0.0 ? all[0] / all[1] : 0.0;
}

/** Warns of points of a gas that run away from each other: some expand, and outweigh the others.
 *  Pressures differ in the front of a shock, too, and behind it, but volumes fit the room there. */
void MPMVolumeDrift::note_spread()
{
  if (gas.warned || gas.spread < MOST_SPREAD || inside.rms < LEAST_MISFIT) return;
  gas.warned = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm {}: the pressures of points of gas differ by {:.2g} of the mean "
                   "pressures around them at step {}: the gas has expanded or has been stirred so "
                   "far that too few points are in a cell, and pressures become too low. {}",
                   field.id(), gas.spread, update->ntimestep, GAS_NEEDS);
}

/** Warns if fillings differ from one for long, and by more than chance. */
void MPMVolumeDrift::note(int every)
{
  if (inside.nodes == 0.0) return;
  note_spread();
  if (inside.lasting == 0.0) inside.lasting = inside.mean;
  inside.lasting += std::min(1.0, (double) every / LASTING) * (inside.mean - inside.lasting);
  const double drift = inside.lasting - 1.0;
  // other bodies may have pores, such as a heap of strands or chips
  const double wrong = corrects ? std::fabs(drift) : drift;
  const double chance = DEVIATIONS * inside.rms / std::sqrt(inside.nodes);
  if (warned || wrong < MOST_DRIFT + std::min(MOST_CHANCE, chance)) return;
  warned = true;
  const auto other_liquid =
      std::find_if(field.materials.begin(), field.materials.end(), [&](const FixMPMMaterial *one) {
        return !one->material->is_solid() && !one->material->is_barotropic() && !gases.count(one);
      });
  const std::string not_corrected = other_liquid == field.materials.end()
      ? ""
      : fmt::format("For a liquid at low pressure, use eos tait or linear in fix mpm/material {}, "
                    "whose volumes follow the room, as those of this equation of state cannot",
                    (*other_liquid)->id);
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm {}: inside of its bodies, the volumes of the points add up to {:.4g} "
                   "times the room that they fill at step {}: volumes and places have drifted "
                   "apart, and so have pressures and densities. {}",
                   field.id(), 1.0 + drift, update->ntimestep,
                   corrects && !share.empty() ? NEXT_TO_REGIONS
                       : corrects             ? "Use more points per cell, or a larger drift"
                       : gases.size() == field.materials.size() ? GAS_NEEDS
                       : !not_corrected.empty()                 ? not_corrected.c_str()
                       : field.options.drift > 0.0
                       ? "Check the volumes at the start; use a smaller time step or spacing, more "
                         "points per cell, transfer apic, or frame total"
                       : "Use fix mpm ... drift 4 for liquids");
}

void MPMVolumeDrift::step()
{
  corrects = corrects && looks_every() > 0 && field.time_limit->bound;    // not in implicit steps
  if (!corrects && !cleared) clear_rates();
  const int every = looks_every();
  // also for the summary of a run that is not short
  const bool last =
      update->ntimestep == update->laststep && update->laststep - update->firststep >= LOOK_EVERY;
  if (every == 0 || ((update->ntimestep / field.options.every) % every && !last)) return;
  const bool now = corrects && (update->ntimestep / field.options.every) % every == 0;
  find_filling();
  if (now) find_strain();
  mark_points_at_surfaces();
  find_inside();
  if (now) {
    interpolate();
    find_rates();
  }
  if (!gases.empty()) find_spread();
  note(every);
}

/** Without corrections, rates of a run before must not wait for the next run that has some. */
void MPMVolumeDrift::clear_rates()
{
  cleared = true;
  for (const auto &run : field.map->runs)
    if (run.material && run.material->volume_rate)
      std::fill(run.material->volume_rate + run.first, run.material->volume_rate + run.last, 0.0);
}

/** Null where nothing changes. */
double *MPMVolumeDrift::rates(const FixMPMMaterial *material) const
{
  return corrects && material ? material->volume_rate : nullptr;
}

void MPMVolumeDrift::find_rates()
{
  const double duration = CORRECT_EVERY * field.step_dt();
  for (const auto &run : field.map->runs) {
    double *const rate = rates(run.material);
    if (!rate) continue;
    const double K = stiffness[run.material];
    for (int i = run.first; i < run.last; i++) {
      const double *const q = &field.work.vectors[3 * (std::size_t) i];
      const double size = std::max(0.0, std::min(MOST_EXCESS, std::fabs(q[0])) - LEAST_EXCESS),
                   share = std::min(MOST_SHARE, field.options.drift * change[i]),
                   difference = 1.0 - field.points->jacobian(i) - q[1] / K,
                   spread = SPREAD * std::min(1.0, size / FULL_EXCESS) * difference;
      rate[i] = share * (spread - std::copysign(size, q[0])) / duration;
    }
  }
}

void MPMVolumeDrift::change_volumes(const FixMPMMaterial *material, int first, int n, double dt,
                                    double *F) const
{
  const double *const rate = rates(material);
  if (!rate) return;
  const int dim = field.lattice.dim;
  for (int p = 0; p < n; p++, F += 9) {
    const double factor = 1.0 + rate[first + p] * dt / dim;
    for (int k = 0; k < 3 * dim; k++) F[k] *= factor;
  }
}

std::string MPMVolumeDrift::report() const
{
  if (inside.nodes == 0.0) return "";
  return fmt::format("  inside of bodies, volumes add up to {:.4f} of the room, {:.2g} rms at "
                     "nodes{}\n",
                     inside.mean, inside.rms,
                     gases.empty() ? ""
                                   : fmt::format("; pressures of points of gas differ by {:.2g} "
                                                 "from the means around them",
                                                 gas.spread));
}
