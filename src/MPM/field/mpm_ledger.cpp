/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_ledger.h"

#include "atom.h"
#include "domain.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_locking.h"
#include "field/mpm_passes.h"
#include "field/mpm_physics.h"
#include "field/mpm_point_map.h"
#include "field/mpm_time_limit.h"
#include "force.h"
#include "math/matrix.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

MPMLedger::NodeSums MPMLedger::sums_over_nodes() const
{
  const Grid &grid = field.grid;
  const double *record = field.grid.nodes();
  NodeSums sums;
  for (const auto &block : grid.blocks) {
    for (int n = 0; n < NODES_PER_BLOCK; n++, record += 8) {
      if (!(block.owned >> n & 1)) continue;
      const double m = record[3];
      sums.mass += m;
      sums.old_energy += m * dot(record + 4, record + 4);
      sums.energy += m * dot(record, record);
      for (int d = 0; d < 3; d++) sums.momentum[d] += 0.5 * m * (record[d] + record[4 + d]);
    }
  }
  sums.old_energy *= 0.5 * force->mvv2e;
  sums.energy *= 0.5 * force->mvv2e;
  return sums;
}

double MPMLedger::point_kinetic_energy() const
{
  const bool deep = field.lattice.dim == 3;
  const int groupbit = field.fix.groupbit, nlocal = atom->nlocal, *const mask = atom->mask;
  const double *const *const v = atom->v, *const mass = atom->rmass, *const volume = atom->vfrac;
  double sum = 0.0;
  for (int i = 0; i < nlocal; i++)
    if ((mask[i] & groupbit) && volume[i] > 0.0)
      sum += mass[i] * (v[i][0] * v[i][0] + v[i][1] * v[i][1] + (deep ? v[i][2] * v[i][2] : 0.0));
  return 0.5 * force->mvv2e * sum;
}

void MPMLedger::account_for_nodes()
{
  const NodeSums sums = sums_over_nodes();
  common = finds_common_acceleration(sums);
  at_points = false;
  account_for_forces(sums);
  transfer += sums.old_energy - kinetic_points;
  kinetic_points = sums.energy;
}

/** Have all points the same acceleration by the forces on them, as by gravity or without any, and
 *  is nothing else put on the nodes? Not in the first steps, and in some later ones, in which the
 *  accounts are checked. Collective. */
bool MPMLedger::finds_common_acceleration(const NodeSums &sums)
{
  static constexpr bigint FIRST = 64, OFTEN = 32;    // of steps with a check
  static constexpr double ROUND_OFF = 1.0e-12;
  const bigint step = update->ntimestep;
  if (step < FIRST || step % OFTEN == 0 || at_points || !field.time_limit->bound ||
      !field.elements.empty() || !field.stretching.empty() || !field.plan->added_stresses.empty())
    return false;
  // of the first point on a rank, and its negative; how much forces differ from it, and their size
  constexpr int N = 6;
  double of_rank[N], greatest[N], sums_of_rank[4] = {0.0, 0.0, 0.0, sums.mass}, total[4], a[3] = {};
  std::fill_n(of_rank, N, -std::numeric_limits<double>::max());
  const PointRows r = field.rows();
  if (const auto &runs = field.map->runs; !runs.empty()) {
    const int i = runs[0].first;
    for (int d = 0; d < 3; d++) {
      of_rank[d] = a[d] = r.f[3 * (bigint) i + d] / r.mass[i];
      of_rank[3 + d] = -a[d];
    }
  }
  for (const auto &run : field.map->runs) {
    double differ = 0.0, mass = 0.0;
    for (int i = run.first; i < run.last; i++) {
      const double *const f = r.f + 3 * (bigint) i, m = r.mass[i];
      mass += m;
      for (int d = 0; d < 3; d++) differ += std::fabs(f[d] - m * a[d]);
    }
    sums_of_rank[0] += differ;
    sums_of_rank[1] += mass * (std::fabs(a[0]) + std::fabs(a[1]) + std::fabs(a[2]));
    sums_of_rank[2] += mass;
  }
  MPI_Allreduce(of_rank, greatest, N, MPI_DOUBLE, MPI_MAX, world);
  MPI_Allreduce(sums_of_rank, total, 4, MPI_DOUBLE, MPI_SUM, world);
  double most = 0.0;
  for (double g : greatest) most = std::max(most, std::fabs(g));
  // with other physics, nodes can have other masses than those of the points
  bool same =
      total[0] <= ROUND_OFF * total[1] && std::fabs(total[2] - total[3]) <= ROUND_OFF * total[2];
  for (int d = 0; d < 3; d++) {
    same = same && greatest[d] + greatest[3 + d] <= ROUND_OFF * most;
    acceleration[d] = 0.5 * (greatest[d] - greatest[3 + d]);
  }
  return same;
}

/** Places relative to the middle of the box, for the sake of digits. */
MPMLedger::PointSums MPMLedger::sums_along_acceleration() const
{
  const int dim = field.lattice.dim;
  double middle[3], a[3];
  for (int d = 0; d < 3; d++) {
    middle[d] = 0.5 * (domain->boxlo[d] + domain->boxhi[d]);
    a[d] = d < dim ? acceleration[d] : 0.0;
  }
  PointSums sums;
  const double *const m = atom->rmass;
  for (const auto &run : field.map->runs)
    for (int i = run.first; i < run.last; i++) {
      const double *const x = atom->x[i];
      for (int d = 0; d < 3; d++) sums.place += m[i] * a[d] * (x[d] - middle[d]);
      sums.velocity += m[i] * dot(a, atom->v[i]);
    }
  return sums;
}

/** Work of the forces on points (atom->f) and of their stress on the nodes. */
void MPMLedger::account_for_forces(const NodeSums &sums)
{
  if (!common) {
    account_at_points();
    note_starts();
    return;
  }
  const TransferStep s = field.step_data();
  work_at_nodes = force->mvv2e * s.dt * s.force_scale * dot(acceleration, sums.momentum);
  internal += work_at_nodes + (spent() - spent_before) - (sums.energy - sums.old_energy);
  external += work_at_nodes;
  if (is_accelerated()) before_motion = sums_along_acceleration();
}

/** Work of forces counts on the way that points go, see work_on_points(). The nodes have got another
 *  work from them, because transfers smooth the old velocities: the difference is theirs. */
void MPMLedger::account_for_points()
{
  if (common || !starts.empty()) {
    double late = 0.0;
    const double work = work_on_points(late);
    external += work - work_at_nodes;
    transfer -= work - late - work_at_nodes;
    internal += late;    // an error of the integration
    starts.clear();
  }
  const double kinetic = point_kinetic_energy();
  transfer += kinetic - kinetic_points;
  kinetic_points = kinetic;
}

/** What n points from first on lose to the nodes by their stress, rows.tau: sum of V tau : grad v,
 *  with velocities and their gradients L from the nodes. */
double MPMLedger::stress_power(PointRows &rows, int first, int n, const double *L) const
{
  const int dim = field.lattice.dim, nL = dim * dim;
  MPMFrame::ForceRows room;
  const double *const f = rows.f, *const v = rows.velocity;
  double power = 0.0;
  field.frame->forces(rows, first, n, room);
  for (int p = 0; p < n; p++) {
    const double *const G = L + nL * p;
    if (rows.f != f)    // hoop stress
      for (int d = 0; d < dim; d++)
        power -= force->nktv2p * (rows.f[3 * p + d] - f[3 * p + d]) * v[3 * p + d];
    double rate = 0.0;
    if (rows.P) {
      for (int k = 0; k < nL; k++) rate += rows.P[nL * p + k] * G[k];
    } else {
      const double *const tau = rows.tau + 6 * p;
      if (dim == 3)
        rate = tau[0] * G[0] + tau[1] * G[4] + tau[2] * G[8] + tau[3] * (G[1] + G[3]) +
            tau[4] * (G[2] + G[6]) + tau[5] * (G[5] + G[7]);
      else
        rate = tau[0] * G[0] + tau[1] * G[3] + tau[3] * (G[1] + G[2]);
    }
    power += rows.vol0[p] * rate;
  }
  return power;
}

/** Work of the forces on points (atom->f) and of their stress, at the mean of the old and the final
 *  velocity of the nodes, which go to the points by the weights and gradients with which P2G has
 *  brought the forces to the nodes. What elements put on atom->f is internal. */
void MPMLedger::account_at_points()
{
  field.nodes.complete_velocities();
  PointRows r = field.rows();
  if (field.options.averages_stress()) r.tau = field.locking->stress();
  const TransferStep s = field.step_data();
  double outer = 0.0, inner = 0.0, stress = 0.0, loads = 0.0;
  double L[9 * BATCH], velocity[3 * BATCH] = {};    // no velocity along z in 2d
  const double *const pressure = pore_pressure(field);
  double total_stress[6 * BATCH + 8];

  const auto account = [&](const MPMPointMap::Run &run, int first, int n, const int *base) {
    PointRows b = rows_from(field, r, first);
    b.velocity = velocity;
    field.kernel.g2p_gradient(b, s, 0, n, base, field.map->tile_load, L);
    const double *const v = velocity, *const f = b.f;
    for (int p = 0; p < n; p++) outer += dot(f + 3 * p, v + 3 * p);
    for (auto *ifix : field.elements) {
      const double *const mine = ifix->forces() + 3 * (bigint) first;
      for (int p = 0; p < n; p++) inner += dot(mine + 3 * p, v + 3 * p);
    }
    if (!run.material) return;    // nodes of elements

    if (pressure) subtract_pressure(pressure, b, first, n, total_stress);
    stress += stress_power(b, first, n, L);
    if (!has_added_stress(field, first, first + n)) return;
    std::fill_n(total_stress, 6 * n, 0.0);
    add_stress(field, first, n, total_stress);
    b = rows_from(field, r, first);
    b.velocity = velocity;
    b.tau = total_stress;
    loads += stress_power(b, first, n, L);
  };
  points_from_step(field, account, true);

  const double unit = force->mvv2e * s.dt;
  work_at_nodes = unit * s.force_scale * (outer - inner);
  external += work_at_nodes - unit * s.stress_scale * loads;
  internal += unit * (s.stress_scale * stress - s.force_scale * inner);
}

/** Before points move. An implicit step finds the work on their way itself. */
void MPMLedger::note_starts()
{
  starts.clear();
  if (work_at_nodes == 0.0 || !field.time_limit->bound) return;
  starts.resize(6 * (std::size_t) atom->nlocal);
  for (const auto &run : field.map->runs)
    for (int i = run.first; i < run.last; i++) {
      std::copy_n(atom->x[i], 3, &starts[6 * (std::size_t) i]);
      std::copy_n(atom->v[i], 3, &starts[6 * (std::size_t) i + 3]);
    }
}

/** Work of forces along the way of points from the middle of the step before to that of this one:
 *  forces are those of the start of the step, and the velocities that kinetic energies are made of
 *  belong to these middles. Where steps vary, forces have acted for another time than between
 *  them: late receives the work along the difference. */
double MPMLedger::work_on_points(double &late) const
{
  const double half = 0.5 * field.step_dt(), half_before = 0.5 * field.step_dt_before();
  const double unit = force->mvv2e * force->ftm2v;
  if (common) {
    if (!is_accelerated()) return 0.0;
    const PointSums now = sums_along_acceleration();
    late = unit * (half_before - half) * before_motion.velocity;
    return unit *
        (now.place - before_motion.place - half * now.velocity +
         half_before * before_motion.velocity);
  }
  const double *const f = field.rows().f;
  double sum = 0.0, before = 0.0;
  for (const auto &run : field.map->runs)
    for (int i = run.first; i < run.last; i++) {
      const bigint row = 3 * (bigint) i;
      const double *const x = &starts[2 * row], *const v = x + 3;
      for (int d = 0; d < field.lattice.dim; d++) {
        double of_others = f[row + d];
        for (const auto *ifix : field.elements) of_others -= ifix->forces()[row + d];
        sum += of_others * (atom->x[i][d] - x[d] - half * atom->v[i][d] + half_before * v[d]);
        before += of_others * v[d];
      }
    }
  late = unit * (half_before - half) * before;
  return unit * sum;
}

/** Is there a mass that can take it? */
bool MPMLedger::change_by(double *record, const double *impulse, double change[3])
{
  if (!(record[3] > 0.0)) return false;
  for (int d = 0; d < 3; d++) {
    change[d] = impulse[d] / record[3];
    record[d] += change[d];
  }
  return true;
}

void MPMLedger::push_node(double *record, bool owned, const double *impulse)
{
  double change[3];
  if (!change_by(record, impulse, change) || !owned) return;
  for (int d = 0; d < field.lattice.dim; d++) driven += impulse[d] * record[d] * force->mvv2e;
  count_push(record, change);
}

void MPMLedger::drag_node(double *record, bool owned, const double *impulse)
{
  double change[3], done = 0.0;
  if (!change_by(record, impulse, change) || !owned) return;
  for (int d = 0; d < field.lattice.dim; d++)
    done += 0.5 * impulse[d] * (record[d] + record[4 + d]) * force->mvv2e;
  driven += done;
  contact += done;
  if (on) note_push(record, change);
}

/** The work of the impulse takes the new velocity: that is what moves points. With the mean of the
 *  old and the new one it would be the change of kinetic energy; the rest is lost in the
 *  collision. */
void MPMLedger::count_push(const double *record, const double *change)
{
  double moved = 0.0, lost = 0.0;
  for (int d = 0; d < field.lattice.dim; d++) moved += change[d] * record[d];
  contact += record[3] * moved * force->mvv2e;
  if (!on) return;
  for (int d = 0; d < field.lattice.dim; d++) lost += 0.5 * change[d] * (record[d] - record[4 + d]);
  transfer -= record[3] * lost * force->mvv2e;
  note_push(record, change);
}

/** Where several actions meet at a node, each was counted with the velocity that it left, which the
 *  next one changes. The kinetic energy of the node has the mean of its old and its final velocity
 *  in all of them: what the change adds to earlier impulses is part of the collision. */
double *MPMLedger::impulse(const double *record)
{
  if (impulses.empty()) impulses.resize(3 * field.grid.nnodes());
  return &impulses[3 * ((record - field.grid.nodes()) / field.grid.nreal)];
}

void MPMLedger::note_push(const double *record, const double *change, const double *change_old)
{
  double *const earlier = impulse(record), met = 0.0;
  for (int d = 0; d < field.lattice.dim; d++) {
    const double with = change_old ? change_old[d] : 0.0;
    met += 0.5 * earlier[d] * (change[d] + with);
    earlier[d] += record[3] * (change[d] - with);
  }
  transfer += met * force->mvv2e;
}

/** The change works as an impulse, which is numerical. */
void MPMLedger::count_series(const std::vector<double> &velocities)
{
  Grid &grid = field.grid;
  for (int64_t n = 0; n < grid.nnodes(); n++) {
    if (!grid.owns(n)) continue;
    const double *const record = grid.record(n);
    double change[3] = {0.0, 0.0, 0.0}, gained = 0.0;
    for (int d = 0; d < field.lattice.dim; d++) {
      change[d] = record[d] - velocities[3 * n + d];
      gained += 0.5 * change[d] * (record[d] + record[4 + d]);
    }
    transfer += record[3] * gained * force->mvv2e;
    note_push(record, change);
  }
}
