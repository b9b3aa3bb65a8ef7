/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_ledger.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "domain.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_locking.h"
#include "field/mpm_passes.h"
#include "field/mpm_physics.h"
#include "field/mpm_point_map.h"
#include "field/mpm_setup_checks.h"
#include "field/mpm_time_limit.h"
#include "force.h"
#include "group.h"
#include "math/matrix.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

namespace {
constexpr double ROUND_OFF = 1.0e-12;

/** Is the force on a mass another one than that of an acceleration? */
bool differs(const double f[3], double mass, const double a[3])
{
  double difference = 0.0, size = 0.0;
  for (int d = 0; d < 3; d++) {
    difference += std::fabs(f[d] - mass * a[d]);
    size += std::fabs(mass * a[d]);
  }
  return !(difference <= ROUND_OFF * size);
}
}    // namespace

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

/** Are there fixes of LAMMPS, such as fix momentum, that may change velocities of points other than
 *  by forces? */
bool MPMLedger::finds_others() const
{
  using namespace FixConst;
  for (auto *other : modify->get_fix_list()) {
    const int when = modify->get_fix_mask(other);
    if (!acts_on_atoms(*other) || utils::strmatch(other->style, "^mpm") ||
        !(when & (INITIAL_INTEGRATE | POST_INTEGRATE | FINAL_INTEGRATE | END_OF_STEP)))
      continue;
    if (group->dynamic[other->igroup] || points_in_both(lmp, field.fix.groupbit, other->groupbit))
      return true;
  }
  return false;
}

void MPMLedger::setup()
{
  if (!on) return;
  kinetic_points = point_kinetic_energy();
  disturbed = finds_others();
}

void MPMLedger::begin_step()
{
  const bool is_first = update->ntimestep == update->firststep + 1;    // perhaps without set-up
  if (on && (disturbed || is_first)) kinetic_points = point_kinetic_energy();
}

void MPMLedger::account_for_nodes()
{
  const NodeSums sums = sums_over_nodes();
  account_for_forces(sums);
  transfer += sums.old_energy - kinetic_points;
  kinetic_points = sums.energy;
}

/** Acceleration of most points of this rank by the forces on them, by a vote of some points spread
 *  over all. Returns false where it has no points, or where more than half of these differ. */
bool MPMLedger::elect_acceleration(const PointRows &r, double a[3]) const
{
  static constexpr int VOTES = 9;
  const auto &runs = field.map->runs;
  if (runs.empty()) return false;
  double of_point[VOTES][3];
  for (int k = 0; k < VOTES; k++) {
    const auto &run = runs[(bigint) k * runs.size() / VOTES];
    const int i = run.first + (int) ((bigint) k * (run.last - run.first) / VOTES);
    for (int d = 0; d < 3; d++) of_point[k][d] = r.f[3 * (bigint) i + d] / r.mass[i];
  }
  for (int k = 0; 2 * k <= VOTES; k++) {
    int votes = 0;
    for (int l = k; l < VOTES; l++) votes += differs(of_point[l], 1.0, of_point[k]) ? 0 : 1;
    if (2 * votes <= VOTES) continue;
    std::copy_n(of_point[k], 3, a);
    return true;
  }
  return false;
}

/** Have nearly all points the same acceleration by the forces on them, as by gravity or without
 *  any, and is nothing else put on the nodes? The points with other forces become others. Not in
 *  the first steps, and in some later ones, in which the accounts are checked. Collective. */
bool MPMLedger::finds_common_acceleration(const NodeSums &sums)
{
  static constexpr bigint FIRST = 64, OFTEN = 32;    // of steps with a check
  static constexpr double FEW = 0.25;                // most of the points with other forces
  const bigint step = update->ntimestep;
  if (step < FIRST || step % OFTEN == 0 || at_points || !field.time_limit->bound ||
      !field.elements.empty() || !field.stretching.empty())
    return false;
  // of this rank, and its negative
  constexpr int N = 6;
  double of_rank[N], greatest[N];
  std::fill_n(of_rank, N, -std::numeric_limits<double>::max());
  const PointRows r = field.rows();
  if (elect_acceleration(r, of_rank))
    for (int d = 0; d < 3; d++) of_rank[3 + d] = -of_rank[d];
  MPI_Allreduce(of_rank, greatest, N, MPI_DOUBLE, MPI_MAX, world);
  double most = 0.0;
  for (double g : greatest) most = std::max(most, std::fabs(g));
  for (int d = 0; d < 3; d++) {
    if (!(greatest[d] + greatest[3 + d] <= ROUND_OFF * most)) return false;
    acceleration[d] = 0.5 * (greatest[d] - greatest[3 + d]);
  }

  bigint n = 0;
  double of_points = 0.0;
  for (const auto &run : field.map->runs) {
    n += run.last - run.first;
    for (int i = run.first; i < run.last; i++) {
      of_points += r.mass[i];
      if (differs(r.f + 3 * (bigint) i, r.mass[i], acceleration)) others.push_back(i);
    }
  }
  std::sort(others.begin(), others.end());
  const double sums_of_rank[] = {(double) n, (double) others.size(), of_points, sums.mass};
  double total[4];
  MPI_Allreduce(sums_of_rank, total, 4, MPI_DOUBLE, MPI_SUM, world);
  // with other physics, nodes can have other masses than those of the points
  return total[1] <= FEW * total[0] && std::fabs(total[2] - total[3]) <= ROUND_OFF * total[2];
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
  others.clear();
  common = finds_common_acceleration(sums);
  at_points = false;
  if (common) {
    const TransferStep s = field.step_data();
    const double unit = force->mvv2e * s.dt;
    const OtherPowers power = powers_of_others();
    work_at_nodes = unit * s.force_scale * (dot(acceleration, sums.momentum) + power.forces);
    external += work_at_nodes + unit * s.stress_scale * power.loads;
    internal += (spent() - spent_before) - (sums.energy - sums.old_energy);
    if (is_accelerated()) before_motion = sums_along_acceleration();
  } else {
    account_at_points();
    std::fill_n(acceleration, 3, 0.0);
    others.clear();
    // an implicit step finds the work on the way of points itself
    if (work_at_nodes != 0.0 && field.time_limit->bound)
      each_point(field, [&](const MPMPointMap::Run &, int i) {
        others.push_back(i);
      });
  }
  note_starts();
}

/** Work of forces counts on the way that points go, see work_on_points(). The nodes have got
 *  another work from them, because transfers smooth the old velocities: the difference is
 *  theirs. */
void MPMLedger::account_for_points()
{
  if (common || !others.empty()) {
    double late = 0.0;
    const double work = work_on_points(late);
    external += work - work_at_nodes;
    transfer -= work - late - work_at_nodes;
    internal += late;    // an error of the integration
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
    b = rows_from(field, r, first);
    b.velocity = velocity;
    loads += added_stress_power(b, first, n, L);
  };
  points_from_step(field, account, true);

  const double unit = force->mvv2e * s.dt;
  work_at_nodes = unit * s.force_scale * (outer - inner);
  external += work_at_nodes - unit * s.stress_scale * loads;
  internal += unit * (s.stress_scale * stress - s.force_scale * inner);
}

/** Before points move. */
void MPMLedger::note_starts()
{
  starts.resize(6 * others.size());
  double *start = starts.data();
  for (int i : others) {
    std::copy_n(atom->x[i], 3, start);
    std::copy_n(atom->v[i], 3, start + 3);
    start += 6;
  }
}

/** Force on a point beyond the acceleration that all have in common, without those of elements. */
void MPMLedger::find_other_force(const PointRows &r, int i, double f[3]) const
{
  field.outer_force(r.f, i, f);
  for (int d = 0; d < 3; d++) f[d] -= r.mass[i] * acceleration[d];
}

/** What n points from first on lose to the nodes by the stress that is put on them from outside.
 *  rows: as in stress_power(); b.tau changes. */
double MPMLedger::added_stress_power(PointRows &b, int first, int n, const double *L) const
{
  double stress[6 * BATCH + 8];
  std::fill_n(stress, 6 * n, 0.0);
  add_stress(field, first, n, stress);
  b.tau = stress;
  return stress_power(b, first, n, L);
}

/** Powers at the nodes, by the mean of the old and the final velocity. Only batches with such
 *  points ask the nodes. */
MPMLedger::OtherPowers MPMLedger::powers_of_others()
{
  OtherPowers power;
  const bool loads = !field.plan->added_stresses.empty();
  if (others.empty() && !loads) return power;
  field.nodes.complete_velocities();
  const PointRows r = field.rows();
  const TransferStep s = field.step_data();
  double f[3], L[9 * BATCH], velocity[3 * BATCH] = {};
  MPMPointMap &map = *field.map;
  for (const auto &a : map.active) {
    bool loaded = false;
    int base[3];
    for (int k = a.first_run; k < a.last_run; k++) {
      const auto &run = map.runs[k];
      auto other = std::lower_bound(others.begin(), others.end(), run.first);
      const bool run_is_stressed = loads && has_added_stress(field, run.first, run.last);
      for (int first = run.first; first < run.last; first += BATCH) {
        const int last = std::min(first + BATCH, run.last), n = last - first;
        const bool is_stressed = run_is_stressed && has_added_stress(field, first, last);
        const bool is_pushed = other != others.end() && *other < last;
        if (!is_stressed && !is_pushed) continue;
        if (!loaded) map.load_tile(a, base, true);
        loaded = true;
        PointRows b = rows_from(field, r, first);
        b.velocity = velocity;
        field.kernel.g2p_gradient(b, s, 0, n, base, map.tile_load, L);
        for (; other != others.end() && *other < last; ++other) {
          find_other_force(r, *other, f);
          power.forces += dot(f, velocity + 3 * (*other - first));
        }
        if (is_stressed) power.loads -= added_stress_power(b, first, n, L);
      }
    }
  }
  return power;
}

/** Work of forces along the way of points from the middle of the step before to that of this one:
 *  forces are those of the start of the step, and the velocities that kinetic energies are made of
 *  belong to these middles. Where steps vary, forces have acted for another time than between
 *  them: late receives the work along the difference. */
double MPMLedger::work_on_points(double &late) const
{
  const double half = 0.5 * field.step_dt(), half_before = 0.5 * field.step_dt_before();
  const double unit = force->mvv2e * force->ftm2v;
  double sum = 0.0, before = 0.0;
  if (is_accelerated()) {
    const PointSums now = sums_along_acceleration();
    before = before_motion.velocity;
    sum = now.place - before_motion.place - half * now.velocity + half_before * before;
  }
  const PointRows r = field.rows();
  const double *start = starts.data();
  double f[3];
  for (int i : others) {
    const double *const x = start, *const v = start + 3;
    find_other_force(r, i, f);
    for (int d = 0; d < field.lattice.dim; d++) {
      sum += f[d] * (atom->x[i][d] - x[d] - half * atom->v[i][d] + half_before * v[d]);
      before += f[d] * v[d];
    }
    start += 6;
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
