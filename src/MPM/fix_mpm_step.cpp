/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// The step of fix mpm: its stages and what they share.

#include "fix_mpm.h"

#include "atom.h"
#include "fix_mpm_elements.h"
#include "fix_mpm_material.h"
#include "fix_mpm_passes.h"
#include "fix_mpm_visit.h"
#include "force.h"
#include "material/batch.h"
#include "mpm_halo.h"
#include "mpm_node_action.h"
#include "mpm_points.h"
#include "platform.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   one step of all fields, driven by the first instance
------------------------------------------------------------------------- */

void FixMPM::initial_integrate(int /*vflag*/)
{
  if (!driver || wait()) return;

  update_topology();
  for (auto *field : fields) field->points_to_grid();

  if (stress_before()) {
    act_on_nodes(MPMNodeAction::START);
    for (auto *field : fields) field->stress_first();
  }

  for (auto *field : fields) field->solve();
  act_on_nodes(MPMNodeAction::STEP);
  refine_velocities();
  for (auto *field : fields) field->grid_to_points();

  if (any_light()) {
    for (auto *field : fields) field->blend_light_nodes();
    act_on_nodes(MPMNodeAction::MAPPED_BACK);
    for (auto *field : fields) field->gradient_with_light_nodes();
  }

  if (stress_after()) {
    for (auto *field : fields) field->map_back();
    act_on_nodes(MPMNodeAction::MAPPED_BACK);
    for (auto *field : fields) field->stress_last();
  }

  for (auto *field : fields) field->bookkeeping();
}

/* ----------------------------------------------------------------------
   mass, momentum and force of the nodes (with stress before: mass and momentum only), summed over ranks
------------------------------------------------------------------------- */

void FixMPM::points_to_grid()
{
  clock = platform::walltime();
  add_torques();
  if (averages_stress() && !stress_before()) average_pressure();
  grid->zero();
  map_to_nodes(stress_before() ? kernel.p2g_momentum : kernel.p2g);
  lap(report.t_p2g);
  sum_halo(0, stress_before() ? 4 : kernel.nreal);

  if (stress_before()) {
    kernels->solve_nodes(grid->nodes(), grid->nnodes(), kernel.nreal, 0.0);
    lap(report.t_nodes);
  }
}

/* ----------------------------------------------------------------------
   USF, USAVG: stress from the velocity of the start of the step, then the forces
------------------------------------------------------------------------- */

void FixMPM::stress_first()
{
  clock = platform::walltime();
  grid->copy_aliases();
  extend_edges();
  if (scheme == USAVG)
    gradient_and_material(0.5 * step_dt(), 0.75 * step_dt());
  else
    gradient_and_material(step_dt(), step_dt());
  lap(report.t_g2p);

  // back to momentum, free of what boundaries did; room for the force

  double *record = grid->nodes();
  for (int64_t n = grid->nnodes(); n > 0; n--, record += 8) {
    for (int d = 0; d < 3; d++) {
      record[d] = record[3] * record[4 + d];
      record[4 + d] = 0.0;
    }
    record[7] = 0.0;
  }
  lap(report.t_nodes);
  if (averages_stress()) average_pressure();
  map_to_nodes(kernel.p2g_force);
  lap(report.t_p2g);
  sum_halo(4, 4);
}

/* ----------------------------------------------------------------------
   momentum equation on the nodes
------------------------------------------------------------------------- */

void FixMPM::solve()
{
  clock = platform::walltime();
  kernels->solve_nodes(grid->nodes(), grid->nnodes(), kernel.nreal, step_dt());
  if (ledger_on) before_actions = ledger.boundary + ledger.contact + ledger.transfer;
  lap(report.t_nodes);
}

/* ----------------------------------------------------------------------
   velocity and position of the points, and with USL their stress: the motion of this step is that of
   the material then, unless light nodes wait for a better gradient
------------------------------------------------------------------------- */

void FixMPM::grid_to_points()
{
  clock = platform::walltime();
  if (ledger_on) account_for_nodes();
  grid->copy_aliases();
  extend_edges();

  const bool strains = scheme == USL && light == 0.0;
  const bool fbar = strains && averages_strain(), around = scheme == USL && axisymmetric;
  const bool apart = strains && strains_apart(), refers = strains && R;
  const bool in_C = kernel.gradient_in_C && !refers;    // the gradient that stress needs is there
  if (moves_late()) xnew.resize(3 * (std::size_t) atom->nmax);
  if (moves_late() && corners) corners_late.resize(domain_size() * (std::size_t) atom->nmax);
  if (around) hoop.resize(atom->nmax);
  if (fbar && !in_C) gradients.resize(affine_size() * (std::size_t) atom->nmax);

  PointRows r = rows();
  if (corners) r.corners_new = moves_late() ? corners_late.data() : &corners[0][0];
  const TransferStep s = step_data();
  double batch_gradients[9 * BATCH];
  for (const auto &a : active) {
    int base[3];
    load_tile(a, base);
    for (int k = a.first_run; k < a.last_run; k++)
      for (int i = runs[k].first; i < runs[k].last; i += BATCH) {
        const int last = std::min(i + BATCH, runs[k].last);
        const bigint place_in_C = (bigint) affine_size() * i;
        double *const L = fbar && !in_C ? gradients.data() + place_in_C : batch_gradients;
        if (Q) modes.g2p(r, &Q[0][0], s, i, last, base, tile_load);
        if (apart) kernel.g2p_gradient(r, s, i, last, base, tile_load, L);
        if (around) note_radii(i, last);
        drifted |=
            kernel.g2p(r, s, i, last, base, tile_load, strains && !in_C && !apart ? L : nullptr);
        if (around) hoop_of_motion(r, i, last);
        if (refers) refer_gradients(i, last - i, L);
        if (strains && !fbar)
          material_update(r, runs[k], i, last - i, in_C ? r.C + place_in_C : L, step_dt());
      }
  }
  if (fbar) {
    averaged_material(in_C ? r.C : gradients.data(), step_dt());
    move_points();
  }
  lap(report.t_g2p);
}

/* ----------------------------------------------------------------------
   positions of the end of the step, where they had to wait
------------------------------------------------------------------------- */

void FixMPM::move_points()
{
  for (const auto &run : runs)
    memcpy(&atom->x[run.first][0], &xnew[3 * (std::size_t) run.first],
           3 * sizeof(double) * (run.last - run.first));
  const std::size_t n = domain_size();
  for (const auto &run : runs)
    if (corners)
      memcpy(corners[run.first], &corners_late[n * run.first],
             n * sizeof(double) * (run.last - run.first));
}

/* ----------------------------------------------------------------------
   MUSL, USAVG: the velocity of the points once more to the nodes, at the old positions.
   An affine matrix is that of this step, never the old one.
------------------------------------------------------------------------- */

void FixMPM::map_back()
{
  clock = platform::walltime();
  grid->zero();
  map_to_nodes(kernel.p2g_momentum);
  lap(report.t_p2g);
  sum_halo(0, 4);
  kernels->solve_nodes(grid->nodes(), grid->nnodes(), kernel.nreal, 0.0);
  lap(report.t_nodes);
}

/* ----------------------------------------------------------------------
   MUSL, USAVG: stress from the mapped-back velocity, then move the points
------------------------------------------------------------------------- */

void FixMPM::stress_last()
{
  clock = platform::walltime();
  grid->copy_aliases();
  extend_edges();
  if (scheme == USAVG)
    gradient_and_material(0.5 * step_dt(), -0.25 * step_dt());
  else
    gradient_and_material(step_dt(), 0.0);
  move_points();
  lap(report.t_g2p);
}

/* ----------------------------------------------------------------------
   USF takes the gradient of the velocity that has brought the points to where they are, with
   respect to these positions: dx = (I - dt L)^-1 dx_old. Laws expect dx = (I + dt L') dx_old, so
   L' = L (I - dt L)^-1. With L itself, a body that turns by an angle a in a step would seem to grow
   by 2 a^2 in area and shrink in answer to that, by 2.4 % per revolution of 3300 steps.

   USAVG goes half of the way with each of two gradients. Half of the motion I + dt L is, to third
   order and as an exact rotation for a spin, the Cayley transform of half of the mid-step gradient:
   I + dt/2 L (I + dt/4 L)^-1, and with the gradient at the end I + dt/2 L (I - 3 dt/4 L)^-1. So all
   of these are L (I - shift L)^-1, and the time steps of the law add up to dt.
------------------------------------------------------------------------- */

static void shift_gradient(int dim, int n, double dt, double *gradients)
{
  if (dim == 2) {    // by Cayley-Hamilton
    for (double *L = gradients; n > 0; n--, L += 4) {
      const double shift = dt * (L[0] * L[3] - L[1] * L[2]);
      const double inv = 1.0 / (1.0 - dt * (L[0] + L[3]) + dt * shift);
      L[0] = inv * (L[0] - shift);
      L[1] = inv * L[1];
      L[2] = inv * L[2];
      L[3] = inv * (L[3] - shift);
    }
    return;
  }
  for (double *L = gradients; n > 0; n--, L += 9) {    // 3x3, order of storage does not matter
    double M[9], inv[9], LM[9];
    for (int c = 0; c < 9; c++) M[c] = (c % 4 == 0 ? 1.0 : 0.0) - dt * L[c];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
        inv[3 * i + j] = M[3 * a + c] * M[3 * b + d] - M[3 * a + d] * M[3 * b + c];
      }
    const double det = M[0] * inv[0] + M[1] * inv[3] + M[2] * inv[6];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        LM[3 * i + j] =
            (L[3 * i] * inv[j] + L[3 * i + 1] * inv[3 + j] + L[3 * i + 2] * inv[6 + j]) / det;
    for (int c = 0; c < 9; c++) L[c] = LM[c];
  }
}

/* ----------------------------------------------------------------------
   velocity gradients of the nodes' velocities at the points, and the material update. With MUSL, corners
   move with the velocities that were mapped back: domains that stress does not see are not held by it
------------------------------------------------------------------------- */

void FixMPM::gradient_and_material(double dt, double shift)
{
  const PointRows r = rows();
  const TransferStep s = step_data();
  const bool fbar = averages_strain();
  if (fbar) gradients.resize(affine_size() * (std::size_t) atom->nmax);
  if (axisymmetric) {
    hoop.resize(atom->nmax);
    v_apart.resize(3 * (std::size_t) atom->nmax);
  }
  visit_gradients(
      fbar ? gradients.data() : nullptr,
      [&](const Run &run, int i, int n, const int *base, double *L) {
        if (shift != 0.0 && !total) shift_gradient(lattice.dim, n, shift, L);
        if (R) refer_gradients(i, n, L);
        if (axisymmetric) hoop_of_nodes(r, s, i, i + n, base, dt, total ? 0.0 : shift);
        if (!fbar) material_update(r, run, i, n, L, dt);
      },
      corners && scheme == MUSL ? corners_late.data() : nullptr);
  if (fbar) averaged_material(gradients.data(), dt);
}

/* ----------------------------------------------------------------------
   strain and stress of up to BATCH consecutive points of one material
------------------------------------------------------------------------- */

void FixMPM::material_update(const PointRows &r, const Run &run, int first, int n, const double *L,
                             double dt)
{
  // not through row pointers: one of them per batch is always a cache miss
  Batch &b = *batch;
  FixMPMMaterial *material = run.material;
  if (!material) return;    // nodes of elements
  double *F = r.F + 9 * (bigint) first, *tau = r.tau + 6 * (bigint) first;
  const auto load = total ? batch_kernels->load_total : batch_kernels->load;
  load(b, n, dt, L, F, tau, r.vol0 + first, axisymmetric ? hoop.data() + first : nullptr);
  b.history = reinterpret_cast<double(*)[BATCH]>(history_batch.data());
  b.time = current_time();

  const int nhistory = material->nhistory;
  if (nhistory) {
    const double *h = &material->history[0][0] + nhistory * (bigint) first;
    for (int p = 0; p < n; p++)
      for (int k = 0; k < nhistory; k++) b.history[k][p] = h[nhistory * p + k];
  }

  material->material->update(b);
  if (material->watching) material->watch_ranges(b, first);
  if (watch_volume) note_volume_rate(b, first);
  if (!total && !material->material->uses_F()) batch_kernels->forget_shape(b);

  const int bad = batch_kernels->store(b, F, tau);
  if (nhistory) {
    double *h = &material->history[0][0] + nhistory * (bigint) first;
    for (int p = 0; p < n; p++) {
      if (bad && !(b.J[p] > 0.0)) continue;
      for (int k = 0; k < nhistory; k++) h[nhistory * p + k] = b.history[k][p];
    }
  }
  for (int k = 0; k < NWORK; k++) material->work[k] += b.work[k];
  if (delete_failed && material->damage >= 0)
    for (int p = 0; p < n; p++)
      if (b.history[material->damage][p] >= 1.0) failed_points.push_back(atom->tag[first + p]);

  if (bad)
    for (int p = 0; p < n; p++)
      if (!(b.J[p] > 0.0))
        point_is_bad(first + p,
                     fmt::format("has a deformation gradient of determinant {}", b.J[p]));
}

/* ----------------------------------------------------------------------
   what is left: drift, bad points, checks, counters
------------------------------------------------------------------------- */

void FixMPM::bookkeeping()
{
  clock = platform::walltime();
  if (ledger_on) {
    const double kinetic = point_kinetic_energy();
    ledger.transfer += kinetic - kinetic_points;
    kinetic_points = kinetic;
  }

  if (drifted && corners) check_corners();
  if (drifted)    // rare, and the kernels must never see such a position
    for (const auto &run : runs)
      for (int i = run.first; i < run.last; i++) {
        const double *x = atom->x[i];
        if (!std::isfinite(x[0] + x[1] + x[2])) point_is_bad(i, "has lost its position");
      }
  if (has_domains()) drifted = 0;
  if (watch_drift) {
    int all;
    MPI_Allreduce(&drifted, &all, 1, MPI_INT, MPI_BOR, world);
    if (all) topology_valid = false;
    drifted = 0;
  }
  if (policy != ERROR || delete_failed) handle_bad_points();
  if (R) check_distortion();
  if (dt_check && update->ntimestep >= next_dt_check) check_dt();

  report.steps++;
  for (const auto &run : runs) report.point_steps += run.last - run.first;
  report.dt_min = std::min(report.dt_min, step_dt());
  report.dt_max = std::max(report.dt_max, step_dt());
  if (waiting) end_waiting();
  lap(report.t_topology);
}

/* ---------------------------------------------------------------------- */

void FixMPM::act_on_nodes(MPMNodeAction::Stage stage)
{
  if (actions.empty()) return;
  const double start = platform::walltime();
  for (auto *action : actions) action->act(step_dt(), stage);
  report.t_nodes += platform::walltime() - start;
}

void FixMPM::push_node(int64_t node, bool owned, const double *impulse)
{
  double *record = grid->nodes() + node * grid->nreal, change[3];
  if (!(record[3] > 0.0)) return;
  for (int d = 0; d < 3; d++) {
    change[d] = impulse[d] / record[3];
    record[d] += change[d];
  }
  if (owned) count_push(record, change);
}

/* ----------------------------------------------------------------------
   The work of the impulse takes the new velocity: that is what moves points. With the mean of the old
   and the new one it would be the change of kinetic energy; the rest is part of integration
------------------------------------------------------------------------- */

void FixMPM::count_push(const double *record, const double *change)
{
  if (!ledger_on) return;
  double moved = 0.0, lost = 0.0;
  for (int d = 0; d < lattice.dim; d++) {
    moved += change[d] * record[d];
    lost += 0.5 * change[d] * (record[d] - record[4 + d]);
  }
  ledger.contact += record[3] * moved * force->mvv2e;
  ledger.transfer -= record[3] * lost * force->mvv2e;
}

/* ---------------------------------------------------------------------- */

void FixMPM::map_to_nodes(P2G p2g)
{
  PointRows r = rows();
  if (averages_stress()) r.tau = tau_averaged.data();
  const TransferStep s = step_data();
  PointRows stressless = r;    // nodes of elements
  if (!elements.empty()) {
    zero_volume.assign(atom->nmax, 0.0);
    stressless.vol0 = zero_volume.data();
  }
  for (auto &a : active) {
    const auto &block = grid->blocks[a.slot];
    kernel.prefetch(tile, grid->nodes(), block.slot, a.box);    // that of the step before
    int base[3];
    tile_base(a, base);
    for (int d = 0; d < 3; d++) {
      a.box[d] = 127;
      a.box[3 + d] = -127;
    }
    for (int k = a.first_run; k < a.last_run; k++)
      map_run(p2g, runs[k].material ? r : stressless, s, runs[k], base, a.box);
    if (Q && p2g != kernel.p2g_force)
      for (int k = a.first_run; k < a.last_run; k++)
        modes.p2g(r, &Q[0][0], s, runs[k].first, runs[k].last, base, tile);
    kernel.flush(tile, grid->nodes(), block.slot, a.box);
  }
}

/* ----------------------------------------------------------------------
   points of a run to the tile. In the total frame their first Piola-Kirchhoff stress is made here,
   a batch at a time: to read F and tau costs less than to write and read another matrix.
   With an axis of symmetry, the hoop stress adds to the force
------------------------------------------------------------------------- */

void FixMPM::map_run(P2G p2g, const PointRows &r, const TransferStep &s, const Run &run,
                     const int base[3], int box[6])
{
  if (!(total || axisymmetric) || p2g == kernel.p2g_momentum) {
    p2g(r, s, run.first, run.last, base, tile, box);
    return;
  }
  double P[9 * BATCH + 8], f[3 * BATCH + 8], F[9 * BATCH];
  for (bigint i = run.first; i < run.last; i += BATCH) {
    const int n = (int) std::min<bigint>(BATCH, run.last - i);
    PointRows b = r;    // as if the batch were all
    b.x += 3 * i;
    b.v += 3 * i;
    b.f += 3 * i;
    if (b.C) b.C += affine_size() * i;
    b.vol0 += i;
    b.mass += i;
    b.guarded -= (int) i;
    b.tau += 6 * i;
    if (r.size) b.size += 3 * i;
    if (r.domain) b.domain += domain_size() * i;
    if (total) {
      if (R)
        for (int p = 0; p < n; p++) lattice_F((int) i + p, F + 9 * p);
      batch_kernels->first_piola(n, R ? F : r.F + 9 * i, r.tau + 6 * i, P);
      b.P = P;
    }
    if (axisymmetric) {
      add_hoop_force(r, i, n, f);
      b.f = f;
    }
    p2g(b, s, 0, n, base, tile, box);
  }
}

/* ----------------------------------------------------------------------
   a sum over points at the nodes of some blocks, in nodes that are not those of the step.
   weigh(point) sets what the kernel reads of a point
------------------------------------------------------------------------- */

/** Can points of a block reach nodes of blocks that are marked? */
static bool reaches(const Grid::Block &block, const std::vector<char> &near)
{
  return std::any_of(block.slot, block.slot + 27, [&](int slot) {
    return slot >= 0 && near[slot];
  });
}

template <class Weigh>
void FixMPM::map_some(const PointRows &r, const TransferStep &s, P2G p2g,
                      const std::vector<char> &near, int lane, int nlane, const Weigh &weigh)
{
  map_apart(kernel, [&](const Run &run, const int *base, int *box) {
    if (!reaches(grid->blocks[run.slot], near)) return;
    for (int i = run.first; i < run.last; i++) weigh(i);
    p2g(r, s, run.first, run.last, base, tile, box);
  });
  sum_copies(nodes_apart.data(), kernel.nreal, lane, nlane);
}

/* ----------------------------------------------------------------------
   the internal force of the Cauchy stress -I is the gradient of the volume; with an axis of
   symmetry, that of the area in the plane, times the length of the circle through the node
------------------------------------------------------------------------- */

void FixMPM::map_gradient(Content content, const std::vector<char> &near,
                          std::vector<double> &gradient)
{
  rows_apart.resize(6 * (std::size_t) atom->nmax);
  PointRows r = rows();
  r.tau = rows_apart.data();
  TransferStep s = step_data();
  s.dt = 1.0;
  s.force_scale = 0.0;
  s.stress_scale = 1.0;

  const int lane = kernel.nreal == 8 ? 4 : 0;
  map_some(r, s, kernel.p2g_force, near, lane, 3, [&](int i) {
    double *const tau = r.tau + 6 * (std::size_t) i;
    const double weight =
        (content == OF_MASS ? atom->rmass[i] / atom->vfrac[i] : points->jacobian(i)) /
        circle(atom->x[i][0]);
    for (int k = 0; k < 6; k++) tau[k] = k < 3 ? -weight : 0.0;
  });
  gradient.resize(3 * grid->nnodes());
  for (int64_t n = 0; n < grid->nnodes(); n++) {
    const double length = node_circle((int) (n / NODES_PER_BLOCK), (int) (n % NODES_PER_BLOCK));
    for (int d = 0; d < 3; d++)
      gradient[3 * n + d] = length * nodes_apart[n * kernel.nreal + lane + d];
  }
}

/* ---------------------------------------------------------------------- */

void FixMPM::map_volume(const std::vector<char> &near, std::vector<double> &share)
{
  rows_apart.resize(6 * (std::size_t) atom->nmax);
  PointRows r = rows();
  r.mass = rows_apart.data();
  map_some(r, step_data(), kernel.p2g_momentum, near, 3, 1, [&](int i) {
    rows_apart[i] = atom->vfrac[i] * points->jacobian(i) / circle(atom->x[i][0]);
  });
  const double h = lattice.h, inverse = 1.0 / (lattice.dim == 3 ? h * h * h : h * h);
  share.resize(grid->nnodes());
  for (int64_t n = 0; n < grid->nnodes(); n++)
    share[n] = inverse * nodes_apart[n * kernel.nreal + 3];
}

/* ---------------------------------------------------------------------- */

void FixMPM::visit_points(const std::vector<int> &wanted,
                          const std::function<void(int, int, double, const double *)> &f) const
{
  std::vector<char> near(grid->blocks.size(), 0);
  for (std::size_t n = 0; n < wanted.size(); n++)
    if (wanted[n] >= 0) near[n / NODES_PER_BLOCK] = 1;
  for (const auto &run : runs) {
    const auto &block = grid->blocks[run.slot];
    if (!reaches(block, near)) continue;
    for (int i = run.first; i < run.last; i++)
      visit_nodes(block, i, [&](int64_t node, double weight, const double *r) {
        if (weight != 0.0 && wanted[node] >= 0) f(i, wanted[node], weight, r);
      });
  }
}

void FixMPM::sum_over_ranks(double *nodes, int nreal) const
{
  halo->sum(nodes, nreal, 0, nreal);
}

/* ----------------------------------------------------------------------
   volumes on the lattice: in the total frame those of the reference configuration
------------------------------------------------------------------------- */

void FixMPM::volume_at_points(std::vector<double> &share)
{
  find_topology();
  std::vector<double> values(3 * (std::size_t) atom->nmax), weights(atom->nmax);
  const PointRows r = rows_at_rest(values.data(), weights.data());
  TransferStep s = step_data();
  s.dt = 0.0;

  map_apart(pic, [&](const Run &run, const int *base, int *box) {
    const int damage = run.material ? run.material->damage : -1;
    for (int i = run.first; i < run.last; i++) {
      const bool failed = damage >= 0 && run.material->history[i][damage] >= 1.0;
      const double J = !total ? points->jacobian(i) : (R ? MPMPoints::det(R[i]) : 1.0);
      weights[i] = failed ? 0.0 : atom->vfrac[i] * J;
    }
    pic.p2g_momentum(r, s, run.first, run.last, base, tile, box);
  });

  // behind a fixed face, the mirror image: nothing can get between it and the body

  const int nreal = pic.nreal;
  double *const volume = nodes_apart.data() + 3;
  EdgeLists faces;
  if (!total && !modified_edges) list_edges(faces, true);
  for (int a = lattice.dim - 1; a >= 0; a--)
    for (const auto &e : faces[a]) {
      volume[e.face * nreal] *= 2.0;
      if (e.outside >= 0) volume[e.inside * nreal] += volume[e.outside * nreal];
    }
  sum_copies(nodes_apart.data(), nreal, 3, 1);
  for (int a = 0; a < lattice.dim; a++)
    for (const auto &e : faces[a])
      if (e.outside >= 0) volume[e.outside * nreal] = volume[e.inside * nreal];
  const double h = lattice.h, inverse = 1.0 / (lattice.dim == 3 ? h * h * h : h * h);
  for (int64_t n = 0; n < grid->nnodes(); n++)
    nodes_apart[n * nreal] = inverse * nodes_apart[n * nreal + 3];
  grid->copy_aliases(nodes_apart.data(), nreal);
  extend_edges(nodes_apart.data(), nreal, 0, 1);
  gather_apart(pic, [&](const Run &run, const int *base) {
    pic.g2p(r, s, run.first, run.last, base, tile_load, nullptr);
  });

  share.resize(atom->nmax);
  for (const auto &run : runs)
    for (int i = run.first; i < run.last; i++) share[i] = values[3 * (std::size_t) i];
}

/* ----------------------------------------------------------------------
   node index of the first entry of the tile of a block
------------------------------------------------------------------------- */

void FixMPM::tile_base(const ActiveBlock &a, int base[3]) const
{
  for (int d = 0; d < 3; d++) base[d] = grid->side * grid->blocks[a.slot].b[d] - kernel.margin;
}

/* ----------------------------------------------------------------------
   nodes of a block to the tile, and those of the next block towards the cache: in a large run
   they are not there, and nothing else would hide that
------------------------------------------------------------------------- */

void FixMPM::load_tile(const ActiveBlock &a, int base[3])
{
  const auto &block = grid->blocks[a.slot];
  tile_base(a, base);
  kernel.load(tile_load, grid->nodes(), block.slot, a.box);
  const ActiveBlock *next = &a + 1;
  if (next < active.data() + active.size())
    kernel.prefetch(tile_load, grid->nodes(), grid->blocks[next->slot].slot, next->box);
}

/* ----------------------------------------------------------------------
   add what periodic images and other ranks hold of a node
------------------------------------------------------------------------- */

void FixMPM::sum_halo(int lane, int nlane)
{
  sum_copies(grid->nodes(), kernel.nreal, lane, nlane);
  lap(report.t_halo);
}

/* ---------------------------------------------------------------------- */

void FixMPM::sum_copies(double *nodes, int nreal, int lane, int nlane)
{
  fold_edges(nodes, nreal, lane, nlane);
  grid->fold_aliases(nodes, nreal, lane, nlane);
  halo->sum(nodes, nreal, lane, nlane);
}

/* ---------------------------------------------------------------------- */

void FixMPM::lap(double &timer)
{
  const double now = platform::walltime();
  timer += now - clock;
  clock = now;
}
