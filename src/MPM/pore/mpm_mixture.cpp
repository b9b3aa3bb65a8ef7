/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Soil (velocity v) and water (u) at the same place: grains have the share phi of the volume, water
   the porosity n = 1 - phi. Points of soil have the effective stress and the dry mass, points of
   water the pressure p and the density rho_f of the water in the pores, and the volume V that this
   water has by itself; they stand for the volume V/n of the mixture.

   Momentum (S. Bandara, K. Soga, Comput. Geotech. 63 (2015) 199, whose points of water have the
   same):

     phi rho_s dv/dt = div s' - phi grad p + d (u - v) + phi rho_s g
     n rho_f du/dt   =         -  n  grad p - d (u - v) +  n  rho_f g

   Grains do not change their volume. The balance of both masses then is one for the water along its
   path,

     n/rho_f d(rho_f)/dt = - div U,    U = n u + phi v,

   so that what strains the water is the flux of volume U over n. Outside of the soil this is div u.

   At the nodes phi_i is the volume of grains over that of all that is there, and U_i = n_i u_i +
   phi_i v_i. The pressure acts in all of the volume, of which water and grains together are the
   quadrature points, so that there are neither gaps nor overlaps where the soil ends:

     F_i = sum_w V_w p_w grad N_i + sum_s V_s p_s grad N_i,
     n_i F_i on the water,    phi_i F_i on the soil,

   with the volume V_s of the grains of a point of soil, and the mean pressure of the water around
   it,

     p_s = sum_i N_is c_i p_i,    p_i = sum_w N_iw V_w p_w / sum_w N_iw V_w,

   c_i: the share of the pores that is filled. What strains the water then is what makes the work of
   these forces that of its pressure, but for the time step:

     dJ/J = dt div U_w + dt sum_i N_iw c_i sum_s N_is V_s div U_s / sum_w N_iw V_w.

   As the first sum of F_i, for the water's own volume, is there already, the water gets n_i F_i
   less that.

   Volumes at a node: that of grains, V_s, of the soil with its pores, V_m, of water, V_w. In soil
   phi = V_s/V_m; where there is more water than the pores of this soil have, as next to its
   surface, phi = V_s/(V_s + V_w): the larger one counts. Where pores are not full, n_i is less by
   c_i, as next to no water must not bear a force.

   Drag: w = u - v follows dw/dt = a - r w with the rate r = D (1/m_s + 1/m_w) and the acceleration
   a by all other forces, both constant in the step: w is exp(-r dt) w + a (1 - exp(-r dt))/r, exact
   for a difference that fades, and for seepage that is steady.
------------------------------------------------------------------------- */

#include "pore/mpm_mixture.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_block_passes.h"
#include "field/mpm_field.h"
#include "field/mpm_guard.h"
#include "field/mpm_locking.h"
#include "field/mpm_node_action.h"
#include "field/mpm_point_batches.h"
#include "force.h"
#include "material/batch_kernels.h"
#include "material/material.h"
#include "math/matrix.h"
#include "walls/fix_mpm_boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int WIDTH = 8;    // reals of a node: with the old velocity, for both fields

// sums of volumes vary with the places of points, of which pores have few: by how much more there
// is certainly other water

static constexpr double NOISE = 1.2, CERTAIN = 1.7;

// Share of their pores from which on the pores of a node count as full. Below it, pressure acts on
// less than all grains, as next to no water must not bear a force. Where water goes into dry soil,
// a large share holds its front back: with 0.5 a dry bed took up 0.72, 0.80, and 0.76 of the water
// that it should with 12, 24, and 48 cells, and the less the more points a cell had (0.55 with 16);
// with 0.2 this is 0.75, 0.86, and 0.93 (0.77). With 0.05 numerical errors add energy there.

static constexpr double WET = 0.2;

/** Each field has blocks for the sake of the other one: both are renewed together. */
bool MPMMixture::stale() const
{
  return !soil.field->map->valid || !water.field->map->valid;
}

void MPMMixture::couple_topology()
{
  if (stale()) soil.field->map->valid = water.field->map->valid = false;
}

/** Forces and old velocities of nodes are needed where soil and water may meet: while they are
 *  apart, nodes are as they would be without this fix. */
void MPMMixture::blocks_found()
{
  if (!stale()) return;
  for (auto *phase : {&soil, &water}) phase->reach.find(phase->field->grid, world);
  boxes_meet = soil.reach.may_meet(water.reach);
  for (auto *phase : {&soil, &water}) phase->field->keep_old_velocities_now(boxes_meet);
}

void MPMMixture::extend_topology(MPMField &field)
{
  if (&field == soil.field) soil.reach.activate_those_of(water.reach, field.grid);
  if (&field == water.field) water.reach.activate_those_of(soil.reach, field.grid);
}

void MPMMixture::topology_changed(MPMField &field)
{
  if (options.has(field.id())) lists_valid = false;
}

/** Blocks that both have, and those with points that reach their nodes or images of these. */
void MPMMixture::list_blocks()
{
  common.clear();
  lists_valid = true;
  may_meet = boxes_meet;
  if (!boxes_meet) return;
  std::vector<std::array<int, 3>> keys;
  const Grid &grid = soil.field->grid;
  for (std::size_t slot = 0; slot < grid.blocks.size(); slot++) {
    const auto &block = grid.blocks[slot];
    const int other = water.field->grid.find(block.b);
    if (other < 0) continue;
    common.push_back({(int) slot, other, ~block.alias});
    keys.push_back({block.b[0], block.b[1], block.b[2]});
  }
  std::sort(keys.begin(), keys.end());
  for (auto *phase : {&soil, &water}) find_near(*phase, keys);
  int any = !common.empty(), all;
  MPI_Allreduce(&any, &all, 1, MPI_INT, MPI_MAX, world);
  may_meet = all;
}

void MPMMixture::find_near(Phase &phase, const std::vector<std::array<int, 3>> &keys) const
{
  const Grid &grid = phase.field->grid;
  std::vector<char> near(grid.blocks.size(), 0);
  for (std::size_t slot = 0; slot < near.size(); slot++)
    for (int corner = 0; corner < 8 && !near[slot]; corner++)
      near[slot] = std::binary_search(keys.begin(), keys.end(),
                                      canonical_block(grid, grid.blocks[slot], corner));
  phase.reaches.assign(near.size(), 0);
  each_block(*phase.field, [&](const auto &a) {
    const int *const around = grid.blocks[a.slot].slot;
    phase.reaches[a.slot] = std::any_of(around, around + 27, [&](int slot) {
      return slot >= 0 && near[slot];
    });
  });
}

/** Nodes [8]: sums over points of their volume times a value, 0, 0, and of the volume. */
template <class Volumes>
void MPMMixture::sum_volumes(Phase &phase, std::vector<double> &to, const Volumes &of)
{
  MPMField &field = *phase.field;
  auto &values = field.work.vectors, &weights = field.work.weights;
  values.resize(3 * (std::size_t) atom->nmax);
  weights.resize(std::max(weights.size(), (std::size_t) atom->nmax));
  const PointRows r = field.rows_at_rest(values.data(), weights.data());
  const TransferStep s = field.step_data(0.0);
  points_to(to, field, field.pic, [&](const MPMPointMap::Run &run, const int *base, int *box) {
    if (!phase.reaches[run.slot]) return;
    for (int i = run.first; i < run.last; i++) {
      double *const value = &values[3 * (std::size_t) i];
      value[0] = value[1] = value[2] = 0.0;
      of(i, weights[i], value[0]);
    }
    field.pic.p2g_momentum(r, s, run.first, run.last, base, field.map->tile, box);
  });
}

/** Nodes [8] to the points that reach common ones: gather(run, first, n, base) with the nodes in
 *  tile_load. */
template <class Gather>
void MPMMixture::from_nodes(const Phase &phase, double *nodes, const Gather &gather)
{
  points_from(
      nodes, *phase.field, phase.field->kernel,
      [&](int slot) {
        return phase.reaches[slot];
      },
      [&](const MPMPointMap::Run &run, const int *base) {
        for (int i = run.first; i < run.last; i += BATCH)
          gather(i, std::min(BATCH, run.last - i), base);
      });
}

double MPMMixture::grains(int i) const
{
  return atom->rmass[i] / options.grain_density;
}

double MPMMixture::volume(const Phase &phase, int i) const
{
  return atom->vfrac[i] * phase.field->points->jacobian(i);
}

/** [n][6] Kirchhoff stress of the water that makes internal forces. */
const double *MPMMixture::water_stress() const
{
  const MPMField &field = *water.field;
  return field.options.averages_stress() ? field.locking->stress() : field.points->tau[0];
}

static double mean_stress(const double *tau)
{
  return (tau[0] + tau[1] + tau[2]) / 3.0;
}

/** Volume of all that is at a node over that of soil with its pores, from the ratio of sums over
 *  points: 1 unless there certainly is more water than in pores. */
static double excess(double ratio)
{
  if (ratio <= NOISE) return 1.0;
  return ratio >= CERTAIN ? ratio : 1.0 + (CERTAIN - 1.0) * (ratio - NOISE) / (CERTAIN - NOISE);
}

MPMMixtureShares::MPMMixtureShares(double grains, double with_pores, double water)
{
  constexpr double LEAST = MPMMixture::LEAST;
  const double share =
      std::min(1.0 - LEAST, grains / (with_pores * excess((grains + water) / with_pores)));
  here = 1.0 - share;
  porosity = std::max(LEAST, 1.0 - grains / with_pores);
  filled = std::min(1.0, water / (WET * porosity * with_pores));
  soil_share = 1.0 - here * filled;
}

/** Shares of the volume at the nodes; false: nowhere are both. */
bool MPMMixture::find_shares()
{
  sum_volumes(soil, soil.volumes, [&](int i, double &all, double &value) {
    all = volume(soil, i);
    value = grains(i) / all;
  });
  const double *const tau = water_stress();
  sum_volumes(water, water.volumes, [&](int i, double &all, double &value) {
    all = volume(water, i);
    value = mean_stress(tau + 6 * (std::size_t) i) * atom->vfrac[i] / all;
  });
  soil.field->nodes.sum(soil.volumes.data(), WIDTH, 0, 4);
  water.field->nodes.sum(water.volumes.data(), WIDTH, 0, 4);

  stress.assign(WIDTH * soil.field->grid.nnodes(), 0.0);
  for (const auto &c : common)
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (!(c.canonical >> n & 1)) continue;
      Node node = {};
      node.soil = (int64_t) c.slot_soil * NODES_PER_BLOCK + n;
      node.water = (int64_t) c.slot_water * NODES_PER_BLOCK + n;
      const double solid = soil.volumes[WIDTH * node.soil],
                   with_pores = soil.volumes[WIDTH * node.soil + 3],
                   wet = water.volumes[WIDTH * node.water + 3];
      const double mass = water.field->grid.record(node.water)[3];
      if (!(solid > 0.0 && wet > 0.0 && mass > 0.0 && soil.field->grid.record(node.soil)[3] > 0.0))
        continue;
      const MPMMixtureShares of(solid, with_pores, wet);
      node.here = of.here;
      node.porosity = of.porosity;
      node.filled = of.filled;
      node.share = of.soil_share;
      node.volume = node.filled * with_pores;
      node.wet = wet;
      node.density = mass / wet;
      node.owned = soil.field->grid.owns(node.soil);
      stress[WIDTH * node.soil] = node.filled * water.volumes[WIDTH * node.water] / wet;
      nodes.push_back(node);
    }
  int any = !nodes.empty(), all;
  MPI_Allreduce(&any, &all, 1, MPI_INT, MPI_MAX, world);
  if (all && !pores_known) look_for_overfull_pores();
  return all;
}

/** Water that points in pores have at first and that does not fit in, as with another share than
 *  the porosity: nothing but the weight of all tells of it. At nodes that see soil only, and water
 *  all around, when both are together for the first time. */
void MPMMixture::look_for_overfull_pores()
{
  static constexpr double WHOLE = 0.97, TOO_MUCH = 1.2;
  pores_known = true;
  double mine[3] = {0.0, 0.0, 0.0}, all[3];    // of grains, water, soil
  const double cell = soil.field->lattice.cell_volume();
  for (const auto &node : nodes) {
    const double *const here = &soil.volumes[WIDTH * node.soil];
    if (!node.owned || here[3] < WHOLE * cell || node.wet < WHOLE * (here[3] - here[0])) continue;
    mine[0] += here[0];
    mine[1] += node.wet;
    mine[2] += here[3];
  }
  MPI_Allreduce(mine, all, 3, MPI_DOUBLE, MPI_SUM, world);
  const double pores = all[2] - all[0];
  if (comm->me == 0 && all[1] > TOO_MUCH * pores)
    error->warning(
        FLERR,
        "Fix mpm/mixture {}: water has {:.3g} times the volume of the pores that it is in: give "
        "its points there the share {:.3g} in create_points, which is 1 - density/rhos",
        id, all[1] / pores, pores / all[2]);
}

/** Sum over points of volume times mean stress times gradients: own() of a point is that over the
 *  initial volume. */
template <class Stress>
void MPMMixture::sum_forces(Phase &phase, std::vector<double> &to, const Stress &of)
{
  MPMField &field = *phase.field;
  auto &buffer = field.work.stress;
  buffer.resize(6 * (std::size_t) atom->nmax);
  PointRows r = field.rows();
  r.tau = buffer.data();
  TransferStep s = field.step_data();
  s.force_scale = 0.0;
  points_to(to, field, field.kernel, [&](const MPMPointMap::Run &run, const int *base, int *box) {
    if (!phase.reaches[run.slot]) return;
    for (int i = run.first; i < run.last; i++) {
      double *const mine = &buffer[6 * (std::size_t) i];
      const double value = of(i);
      for (int k = 0; k < 6; k++) mine[k] = k < 3 ? value : 0.0;
    }
    field.kernel.p2g_force(r, s, run.first, run.last, base, field.map->tile, box);
  });
  field.nodes.sum(to.data(), WIDTH, 4, 3);
}

/** Before the momentum equation: forces on the nodes. */
void MPMMixture::share_pressure()
{
  if (!lists_valid) list_blocks();
  nodes.clear();
  meets = may_meet && find_shares();
  if (!meets) return;

  MPMField &field = *soil.field;
  Grid &grid = field.grid;
  field.nodes.complete(stress.data(), WIDTH, 1);
  auto &values = field.work.vectors, &weights = field.work.weights;
  const PointRows r = field.rows_at_rest(values.data(), weights.data());
  const TransferStep s = field.step_data(0.0);
  from_nodes(soil, stress.data(), [&](int first, int n, const int *base) {
    field.pic.g2p(r, s, first, first + n, base, field.map->tile_load, nullptr);
  });
  sum_forces(soil, by_grains, [&](int i) {
    return values[3 * (std::size_t) i] * grains(i) / atom->vfrac[i];
  });
  const double *const tau = water_stress();
  sum_forces(water, by_water, [&](int i) {
    return mean_stress(tau + 6 * (std::size_t) i);
  });

  for (auto &node : nodes) {
    double *const at_soil = grid.record(node.soil) + 4;
    double *const at_water = water.field->grid.record(node.water) + 4;
    for (int d = 0; d < 3; d++) {
      double &grains = by_grains[WIDTH * node.soil + 4 + d];
      const double whole = by_water[WIDTH * node.water + 4 + d] + grains;
      node.force[d] = node.share * whole;
      node.on_water[d] = grains - node.force[d];
      at_soil[d] += node.force[d];
      at_water[d] += node.on_water[d];
      grains = 0.0;
    }
  }

  // where there is no water, all of it is for the soil

  for (std::size_t slot = 0; slot < grid.blocks.size(); slot++)
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      const int64_t which = (int64_t) slot * NODES_PER_BLOCK + n;
      const double *const force = &by_grains[WIDTH * which + 4];
      if ((force[0] == 0.0 && force[1] == 0.0 && force[2] == 0.0) ||
          grid.blocks[slot].alias >> n & 1)
        continue;
      Node node = {};
      node.soil = which;
      node.water = -1;
      node.owned = grid.owns(which);
      for (int d = 0; d < 3; d++) {
        node.force[d] = force[d];
        grid.record(which)[4 + d] += force[d];
      }
      nodes.push_back(node);
    }
}

/** Transfers that give points the velocity of the nodes smooth it where the water changes its
 *  speed, at the ends of the soil, in each step. Over the heat of drag in a layer of so many cells
 *  that is 0.04 n (time in which drag lets a difference of velocities fade)/dt/cells, measured with
 *  plugs of n = 0.4 (k = 5 to 50 mm/s, two speeds of sound, two time steps) */
void MPMMixture::warn_of_slow_flow()
{
  static constexpr double LOSS = 0.04, WORTH_TELLING = 0.05, CELLS = 6.0, USUAL = 0.4;
  const auto kind = water.field->options.transfer;
  if (warned_of_slow_flow || kind == FLIP || kind == AFLIP || water.field->materials.empty())
    return;
  const double n = options.reference_porosity > 0.0 ? options.reference_porosity : USUAL;
  const double density = water.field->materials[0]->material->density();
  const double beta = options.drag_coefficient(n, n, density, 0.0);
  const double cells = LOSS / WORTH_TELLING * n * n * density / (beta * dt_last);
  if (!(cells > CELLS)) return;
  warned_of_slow_flow = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/mixture {}: the transfer of fix mpm {} slows the water down in each "
                   "step, by more than 5 % where it flows through less than about {:.3g} cells of "
                   "soil: give the water transfer aflip 1.0",
                   id, options.water_id, cells);
}

/** Drag. A coefficient that depends on the difference of the velocities is that at its end: the one
 *  with which drag leaves just this difference, between none and what no drag leaves. */
void MPMMixture::add_drag(double dt)
{
  dt_last = dt;
  pushes.clear();
  if (options.drag == MPMMixtureOptions::NO_DRAG) return;
  warn_of_slow_flow();
  for (auto &node : nodes) {
    if (node.water < 0) continue;
    double *const at_soil = soil.field->grid.record(node.soil);
    double *const at_water = water.field->grid.record(node.water);
    const double reduced = 1.0 / (1.0 / at_soil[3] + 1.0 / at_water[3]);
    double before[3], gain[3];
    for (int d = 0; d < 3; d++) {
      before[d] = at_water[4 + d] - at_soil[4 + d];
      gain[d] = at_water[d] - at_soil[d] - before[d];
    }

    // what is left of the difference, with a rate, as shares of these

    double fade = 1.0, share = 1.0;
    const auto leave = [&](double difference) {
      node.rate = node.volume *
          options.drag_coefficient(node.porosity, node.here, node.density, difference);
      const double x = dt * node.rate / reduced;
      fade = exp(-x);
      share = mean_decay(x);
      double square = 0.0;
      for (int d = 0; d < 3; d++) {
        const double w = fade * before[d] + share * gain[d];
        square += w * w;
      }
      return sqrt(square);
    };
    double low = 0.0, high = leave(0.0);
    if (!options.drag_is_linear())
      for (int k = 0; k < 60 && high - low > 1.0e-12 * high; k++) {
        const double middle = 0.5 * (low + high);
        if (leave(middle) > middle)
          low = middle;
        else
          high = middle;
      }

    for (int d = 0; d < 3; d++) {
      const double left = fade * before[d] + share * gain[d];
      node.impulse[d] = reduced * (before[d] + gain[d] - left);
      node.free_water[d] = at_water[d];
      node.seen[d] = at_soil[d] += node.impulse[d] / at_soil[3];
      node.after_water[d] = at_water[d] -= node.impulse[d] / at_water[3];
    }
  }
}

/** Contact and the like, which act before walls, are forces like others. What each wall does to the
 *  soil is kept. */
void MPMMixture::note_action(MPMNodeAction &other)
{
  if (options.drag == MPMMixtureOptions::NO_DRAG) return;
  const bool is_wall = other.turn() == MPMNodeAction::WALLS;
  auto *const wall = dynamic_cast<FixMPMBoundary *>(&other);
  for (auto &node : nodes) {
    if (node.water < 0) continue;
    const double *const at_soil = soil.field->grid.record(node.soil),
                        *const at_water = water.field->grid.record(node.water);
    if (!is_wall) {
      for (int d = 0; d < 3; d++) {
        node.free_water[d] += at_water[d] - node.after_water[d];
        node.after_water[d] = at_water[d];
        node.seen[d] = at_soil[d];
      }
      continue;
    }
    Push push = {(std::size_t)(&node - nodes.data()), wall, {}};
    bool any = false;
    for (int d = 0; d < 3; d++) {
      push.change[d] = at_soil[d] - node.seen[d];
      node.seen[d] = at_soil[d];
      node.held[d] = at_water[d] - node.after_water[d];
      any = any || push.change[d] != 0.0;
    }
    if (any && wall) pushes.push_back(push);
  }
}

/** Where a wall has changed the velocity of the soil, but not that of the water, as a sieve does,
 *  what soil presses on it with would have been part of the acceleration a, and drag on the water.
 *  Along the impulse of the wall, which is its normal, soil there has the velocity that the wall
 *  leaves, as if it were infinitely heavy. The wall bears the difference. Walls elsewhere may hold
 *  the water at the same node along other directions. */
void MPMMixture::correct_drag_at_walls()
{
  if (options.drag == MPMMixtureOptions::NO_DRAG || !meets) return;
  for (const auto &push : pushes) {
    auto &node = nodes[push.node];
    const double *const at_soil = soil.field->grid.record(node.soil);
    double *const at_water = water.field->grid.record(node.water);
    const double length = sqrt(dot(push.change, push.change));
    if (!(length > 0.0)) continue;
    double normal[3], reaction[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < 3; d++) normal[d] = push.change[d] / length;
    if (is_held(node, normal)) continue;
    const double before = dot(normal, at_water + 4) - dot(normal, at_soil + 4);
    const double gain = dot(normal, node.free_water) - dot(normal, at_soil) - before;
    const double x = dt_last * node.rate / at_water[3];
    const double left = exp(-x) * before + mean_decay(x) * gain;
    const double change = dot(normal, at_soil) + left - dot(normal, at_water);
    for (int d = 0; d < soil.field->lattice.dim; d++) {
      reaction[d] = at_water[3] * change * normal[d];
      at_water[d] += change * normal[d];
      node.impulse[d] -= reaction[d];
    }
    push.wall->add_reaction(*soil.field, node.soil, reaction);
  }
}

/** Have walls changed the velocity of the water along this direction, by more than rounding? */
bool MPMMixture::is_held(const Node &node, const double *normal) const
{
  constexpr double ACROSS = 1.0e-6, ROUNDING = 1.0e-12;
  const double along = fabs(dot(normal, node.held));
  return along > ACROSS * sqrt(dot(node.held, node.held)) &&
      along > ROUNDING * sqrt(dot(node.after_water, node.after_water));
}

/** Nodes have their final velocities: the work of what has been shared, with the mean of these and
 *  the old ones. The pressure takes from the motion what the water stores. */
void MPMMixture::account_for_work()
{
  const auto mean = [](const double *record, int d) {
    return 0.5 * (record[d] + record[4 + d]);
  };
  double lost = 0.0, on_soil = 0.0, on_water = 0.0;
  for (const auto &node : nodes) {
    if (!node.owned) continue;
    const double *const at_soil = soil.field->grid.record(node.soil);
    for (int d = 0; d < 3; d++) on_soil += node.force[d] * mean(at_soil, d);
    if (node.water < 0) continue;
    const double *const at_water = water.field->grid.record(node.water);
    for (int d = 0; d < 3; d++) {
      on_water += node.on_water[d] * mean(at_water, d);
      lost += node.impulse[d] * (mean(at_water, d) - mean(at_soil, d));
    }
  }
  dissipated += lost * force->mvv2e;
  const double unit = water.field->step_dt() * force->mvv2e;
  if (soil.field->ledger.on) soil.field->ledger.internal -= on_soil * unit;
  if (water.field->ledger.on) water.field->ledger.internal -= on_water * unit;
  soil.field->ledger.count_at_points();
  water.field->ledger.count_at_points();
}

/** The water's volume changes by the flux of both; its points are strained with its own velocity
 *  after this. */
void MPMMixture::share_strain()
{
  if (!meets) return;
  Grid &soil_grid = soil.field->grid, &water_grid = water.field->grid;
  const int dim = soil.field->lattice.dim, nL = dim * dim;
  double L[9 * BATCH];
  const auto divergence = [&](int p) {
    const double *const mine = L + nL * p;
    return mine[0] + mine[nL - 1] + (dim == 3 ? mine[4] : 0.0);
  };

  // div U at points of soil, and its sums at the nodes

  flux.assign(soil_grid.nodes(), soil_grid.nodes() + WIDTH * soil_grid.nnodes());
  lead.assign(WIDTH * water_grid.nnodes(), 0.0);
  for (const auto &node : nodes) {
    if (node.water < 0) continue;
    const double *const at_soil = soil_grid.record(node.soil),
                        *const at_water = water_grid.record(node.water);
    for (int d = 0; d < 3; d++) {
      const double ahead = node.share * (at_soil[d] - at_water[d]);
      lead[WIDTH * node.water + d] = ahead;
      flux[WIDTH * node.soil + d] = at_water[d] + ahead;
    }
  }
  soil.field->nodes.complete(flux.data(), WIDTH, 3);
  water.field->nodes.complete(lead.data(), WIDTH, 3);

  const TransferStep s = soil.field->step_data();
  rates.resize(atom->nmax);
  const PointRows r = soil.field->rows();
  from_nodes(soil, flux.data(), [&](int first, int n, const int *base) {
    soil.field->kernel.g2p_gradient(r, s, first, first + n, base, soil.field->map->tile_load, L);
    for (int p = 0; p < n; p++) rates[first + p] = divergence(p);
  });
  sum_volumes(soil, soil.volumes, [&](int i, double &all, double &value) {
    all = grains(i);
    value = rates[i];
  });
  soil.field->nodes.sum(soil.volumes.data(), WIDTH, 0, 1);

  // and what points of water get of these, besides the divergence at their own places

  MPMField &field = *water.field;
  water.volumes.assign(WIDTH * water_grid.nnodes(), 0.0);
  for (const auto &node : nodes)
    if (node.water >= 0)
      water.volumes[WIDTH * node.water] = node.filled / node.wet * soil.volumes[WIDTH * node.soil];
  field.nodes.complete(water.volumes.data(), WIDTH, 1);
  auto &values = field.work.vectors, &weights = field.work.weights;
  values.resize(3 * (std::size_t) atom->nmax);
  weights.resize(std::max(weights.size(), (std::size_t) atom->nmax));
  const PointRows at_rest = field.rows_at_rest(values.data(), weights.data());
  const TransferStep no_time = field.step_data(0.0);
  from_nodes(water, water.volumes.data(), [&](int first, int n, const int *base) {
    field.pic.g2p(at_rest, no_time, first, first + n, base, field.map->tile_load, nullptr);
  });
  const PointRows rows = field.rows();
  const double dt = field.step_dt();
  from_nodes(water, lead.data(), [&](int first, int n, const int *base) {
    field.kernel.g2p_gradient(rows, s, first, first + n, base, field.map->tile_load, L);
    for (int p = 0; p < n; p++) {
      const int i = first + p;
      const double change = 1.0 + dt * (divergence(p) + values[3 * (std::size_t) i]);
      if (!(change > 0.0)) {
        field.guard->point_is_bad(
            i, fmt::format("of water is compressed by the soil to {} of its volume", change));
        continue;
      }
      const double stretch = dim == 3 ? cbrt(change) : sqrt(change);
      double *const F = field.points->F[i];
      for (int k = 0; k < 3 * dim; k++) F[k] *= stretch;
    }
  });
  field.jacobians.forget();
}

/** Of waves in the mixture, without drag the fastest: c^2 < K/rho_f + K phi/(n rho_s) + M/(phi
 *  rho_s) with the bulk modulus K of the water and the modulus M of the soil; drag slows them
 *  down. */
int MPMMixture::fastest_wave(const Phase &phase, double &most, double &speed) const
{
  MPMField &field = *phase.field;
  double c[BATCH];
  int fastest = -1;
  each_material_batch(field, [&](const std::vector<int> &list, const FixMPMMaterial *material) {
    load_state(field, *field.batch, list.data(), (int) list.size(), material);
    material->material->wave_speed(*field.batch, c);
    for (std::size_t p = 0; p < list.size(); p++) {
      const double *const v = atom->v[list[p]];
      if (c[p] > most) fastest = list[p];
      most = std::max(most, c[p]);
      speed = std::max(speed, sqrt(dot(v, v)));
    }
  });
  return fastest;
}

/** Of all points of both, once they have met. It is that of the rank with the fastest of them, of
 *  the phase with the larger part in it. Also before a step, where it is not known which blocks
 *  points are in. */
double MPMMixture::stable_dt(const MPMField &field, tagint &tag) const
{
  const double none = std::numeric_limits<double>::max();
  if (&field != water.field || !meets) return none;
  double mine[5] = {}, most[5];
  for (int i = 0; i < atom->nlocal; i++) {
    if (soil.field->is_point(i)) mine[0] = std::max(mine[0], grains(i) / volume(soil, i));
    if (field.is_point(i)) mine[1] = std::max(mine[1], atom->rmass[i] / volume(water, i));
  }
  const int fastest[2] = {fastest_wave(soil, mine[2], mine[4]),
                          fastest_wave(water, mine[3], mine[4])};
  MPI_Allreduce(mine, most, 5, MPI_DOUBLE, MPI_MAX, world);
  const double share = std::min(most[0], 1.0 - LEAST);
  const double square[2] = {most[2] * most[2],
                            most[3] * most[3] *
                                (1.0 + share * most[1] / ((1.0 - share) * options.grain_density))};
  const int larger = square[0] > square[1] ? 0 : 1;
  if (fastest[larger] < 0 || mine[2 + larger] < most[2 + larger]) return none;
  tag = atom->tag[fastest[larger]];
  return field.lattice.h / (sqrt(square[0] + square[1]) + most[4]);
}

bool MPMMixture::shares_points(const FixMPMMaterial &material) const
{
  int mine = 0, any;
  for (int i = 0; i < atom->nlocal && !mine; i++)
    mine = (atom->mask[i] & material.groupbit) &&
        (soil.field->is_point(i) || water.field->is_point(i));
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  return any;
}

double MPMMixture::force_on_soil(int i) const
{
  double mine = 0.0, all;
  for (const auto &node : nodes)
    if (node.owned) mine += i < 3 ? node.impulse[i] / dt_last : node.force[i - 3];
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all / force->ftm2v;
}

double MPMMixture::memory_usage() const
{
  std::size_t reals = 0;
  for (const auto *list :
       {&soil.volumes, &water.volumes, &stress, &by_grains, &by_water, &flux, &lead, &rates})
    reals += list->capacity();
  return (double) (reals * sizeof(double) + nodes.capacity() * sizeof(Node));
}
