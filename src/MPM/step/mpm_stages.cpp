/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "step/mpm_stages.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_affine.h"
#include "field/mpm_cpdi.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_frame.h"
#include "field/mpm_guard.h"
#include "field/mpm_locking.h"
#include "field/mpm_passes.h"
#include "field/mpm_physics.h"
#include "field/mpm_plan.h"
#include "field/mpm_point_batches.h"
#include "field/mpm_strain.h"
#include "field/mpm_time_limit.h"
#include "field/mpm_transfer_heat.h"

#include <algorithm>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// Stages: points to nodes, and the momentum equation.

static void to_nodes(MPMField &field, P2G p2g)
{
  MPMPointMap &map = *field.map;
  PointRows r = field.rows();
  if (field.options.averages_stress()) r.tau = field.locking->stress();
  const TransferStep s = field.step_data();
  PointRows stressless = r;    // nodes of elements
  if (!field.elements.empty()) {
    field.work.no_volume.assign(field.atom->nmax, 0.0);
    stressless.vol0 = field.work.no_volume.data();
  }
  double *const nodes = field.grid.nodes();
  for (auto &a : map.active) {
    const auto &block = field.grid.blocks[a.slot];
    field.kernel.prefetch(map.tile, nodes, block.slot, a.box);    // that of the step before
    int base[3];
    map.tile_base(a, base);
    reset_box(a.box);
    for (int k = a.first_run; k < a.last_run; k++)
      run_to_tile(field, p2g, map.runs[k].material ? r : stressless, s, map.runs[k], base, a.box);
    if (field.affine && field.affine->Q && p2g != field.kernel.p2g_force)
      for (int k = a.first_run; k < a.last_run; k++)
        field.affine->modes.p2g(r, &field.affine->Q[0][0], s, map.runs[k].first, map.runs[k].last,
                                base, map.tile);
    field.kernel.flush(map.tile, nodes, block.slot, a.box);
  }
}

void MPMStages::points_to_nodes(MPMField &field, Content content)
{
  const auto &kernel = field.kernel;
  const P2G maps[] = {kernel.p2g, kernel.p2g_momentum, kernel.p2g_force};    // as in enum Content
  if (content != FORCE) field.grid.zero();
  to_nodes(field, maps[content]);
}

void MPMStages::sum_nodes(MPMField &field, Content content)
{
  const int nreal = field.kernel.nreal;
  field.nodes.sum(field.grid.nodes(), nreal, content == FORCE ? 4 : 0, content == ALL ? nreal : 4);
}

void MPMStages::momentum_equation(MPMField &field)
{
  field.kernels->solve_nodes(field.grid.nodes(), (int) field.grid.nnodes(), field.kernel.nreal,
                             field.step_dt(), field.least_node_mass);
  if (field.ledger.on) field.ledger.nodes_solved();
}

void MPMStages::velocities(MPMField &field)
{
  field.kernels->solve_nodes(field.grid.nodes(), (int) field.grid.nnodes(), field.kernel.nreal, 0.0,
                             field.least_node_mass);
}

void MPMStages::back_to_momentum(MPMField &field)
{
  double *record = field.grid.nodes();
  for (int64_t n = field.grid.nnodes(); n > 0; n--, record += 8) {
    for (int d = 0; d < 3; d++) {
      record[d] = record[3] * record[4 + d];
      record[4 + d] = 0.0;
    }
    record[7] = 0.0;
  }
}

// Stages: nodes to points, strain and stress of the points.

/** With scheme usl and without light nodes the motion of this step is that of the material: stress
 *  is made at once, while points are in the cache. */
void MPMStages::nodes_to_points(MPMField &field, Strain strain, const UseGradients &use)
{
  if (field.has_moved()) {
    move_points(field);
    field.set_moved(false);
    return;
  }
  field.nodes.complete_velocities();
  MPMFrame &frame = *field.frame;
  const bool late = field.options.moves_late() || use, strains = strain >= GRADIENTS;
  const bool by_gradient = strains && field.options.strains_by_gradient(),
             refers = strains && frame.refers();
  const bool in_C = field.kernel.gradient_in_C && !refers;    // what stress needs is there
  const bool keeps = strain == GRADIENTS && !in_C;
  const int nL = field.lattice.dim * field.lattice.dim;
  if (late) field.positions_to_come().resize(3 * (std::size_t) field.atom->nmax);
  if (strain != ELSEWHERE) frame.begin_strain();
  double *const kept = keeps ? field.locking->room_for_gradients() : nullptr;

  PointRows r = field.rows();
  if (late) r.xnew = field.positions_to_come().data();
  if (field.domains && !field.mapped.g2p) r.corners_new = field.domains->moved(late);
  const TransferStep s = field.step_data();
  const double dt = field.step_dt();
  const auto &kernel = field.kernel;
  double *const Q = field.affine && field.affine->Q ? &field.affine->Q[0][0] : nullptr;
  const double *const tile = field.map->tile_load;
  double batch_gradients[9 * BATCH];
  points_from_step(field, [&](const MPMPointMap::Run &run, int i, int n, const int *base) {
    const int last = i + n;
    double *const L = keeps ? kept + (bigint) nL * i : batch_gradients;
    if (Q) field.affine->modes.g2p(r, Q, s, i, last, base, tile);
    if (by_gradient) kernel.g2p_gradient(r, s, i, last, base, tile, L);
    if (strain != ELSEWHERE) frame.before_motion(i, last);
    field.map->drifted |=
        kernel.g2p(r, s, i, last, base, tile, strains && !in_C && !by_gradient ? L : nullptr);
    if (strain != ELSEWHERE) frame.after_motion(r, i, last);
    if (refers) frame.refer_gradients(i, n, L);
    const double *const gradients = in_C ? r.C + (bigint) nL * i : L;
    if (use) use(run, i, n, gradients);
    if (strain == STRESS) update_stress(field, r, run, i, n, gradients, dt);
  });
  field.set_moved(static_cast<bool>(use));
  if (strain == GRADIENTS) {
    field.locking->strain(in_C ? r.C : kept, dt);
    move_points(field);
  }
}

/** Nothing that comes between AFTER_SOLVE and the motion may change velocities of nodes, or look at
 *  the state of points. */
bool MPMStages::can_move_first(const MPMField &field)
{
  const auto &o = field.options;
  const auto &all = field.plan->physics;
  return o.scheme == MPMFieldOptions::USL && o.strains_while_moving() && !o.heats() && !o.total &&
      !o.axisymmetric && !o.has_size() &&
      std::count_if(all.begin(), all.end(), [](const auto *physics) {
        return !dynamic_cast<const MPMLoad *>(physics);
      }) == 1;
}

void MPMStages::move_points(MPMField &field)
{
  for (const auto &run : field.map->runs) {
    memcpy(field.atom->x[run.first], &field.positions_to_come()[3 * (std::size_t) run.first],
           3 * sizeof(double) * (run.last - run.first));
    if (field.domains) field.domains->take_late(run.first, run.last);
  }
}

/** With MUSL and USAVG, points and the corners of domains move with the velocities that were mapped
 *  back, which strain takes, too. What moves apart from strain is not held by stress, and under
 *  tension goes away from where it belongs. In the total frame forces do not depend on where points
 *  are. */
void MPMStages::strain_from_nodes(MPMField &field, double motion_dt, double share,
                                  double shift_share, bool moves)
{
  field.nodes.complete_velocities();
  MPMFrame &frame = *field.frame;
  const double dt = share * motion_dt, shift = shift_share * motion_dt;
  const TransferStep s = field.step_data();
  const PointRows r = field.rows();
  PointRows moving = r;
  moves = moves && field.mapped.g2p;
  if (moves && field.domains) moving.corners_new = field.domains->moved(true);
  const bool fbar = field.options.averages_strain();
  double *const kept = fbar ? field.locking->room_for_gradients() : nullptr;
  const int nL = field.lattice.dim * field.lattice.dim;
  frame.begin_strain();
  double batch_gradients[9 * BATCH], velocities[3 * BATCH];
  const double *const tile = field.map->tile_load;
  points_from_step(field, [&](const MPMPointMap::Run &run, int i, int n, const int *base) {
    double *const L = fbar ? kept + (bigint) nL * i : batch_gradients;
    if (moves) {
      PointRows batch = rows_from(field, moving, i);
      batch.v = velocities;
      batch.C = L;
      field.map->drifted |=
          field.mapped.g2p(batch, s, 0, n, base, tile, field.mapped.gradient_in_C ? nullptr : L);
    } else {
      field.kernel.g2p_gradient(r, s, i, i + n, base, tile, L);
    }
    if (shift != 0.0) frame.shift_gradients(n, shift, L);
    frame.refer_gradients(i, n, L);
    frame.strain_of_nodes(r, i, i + n, base, dt, shift);
    if (!fbar) update_stress(field, r, run, i, n, L, dt);
  });
  if (fbar) field.locking->strain(kept, dt);
}

void MPMStages::checks(MPMField &field)
{
  if (field.ledger.on) field.ledger.account_for_points();
  MPMPointMap &map = *field.map;
  if (map.drifted && field.domains && field.domains->corners) field.domains->check_corners();
  if (map.drifted || field.domains) field.guard->check_positions();
  map.check_drift();
  field.guard->handle_bad_points();
  field.frame->end_of_step();
  field.time_limit->check();
  field.count_step();
}

// Stages: nodes with next to no mass, and velocity gradients that they do not spoil.

/** For the velocity gradient and the affine matrix alone, a node that has the share s < light of
 *  the material of a full cell moves with
 *
 *    (s/light) v_i + (1 - s/light) <v>_i,    <v>_i = sum_p V_p N_ip v_p / sum_p V_p N_ip
 *
 *  with the new velocities v_p of the points. Momenta are not touched. Volumes tell how full a cell
 *  is, as bodies of any density may meet at a node; with an axis of symmetry, areas in the
 *  plane. */
void MPMStages::blend_light_nodes(MPMField &field)
{
  auto &nodes = field.work.nodes, &volumes = field.work.weights;
  MPMPointMap &map = *field.map;
  const MPMFrame &frame = *field.frame;
  const MPMRows places = frame.places();
  volumes.resize(field.atom->nmax);
  each_point(field, [&](const MPMPointMap::Run &, int i) {
    volumes[i] = field.atom->vfrac[i] * frame.lattice_jacobian(i) / frame.circle(places[i][0]);
  });
  PointRows r = field.rows();
  r.mass = volumes.data();
  const TransferStep s = field.step_data();
  points_to(nodes, field, field.pic, [&](const MPMPointMap::Run &run, const int *base, int *box) {
    field.pic.p2g_momentum(r, s, run.first, run.last, base, map.tile, box);
  });
  field.nodes.sum(nodes.data(), field.pic.nreal, 0, 4);

  const double full = field.options.light * field.lattice.cell_volume();
  double *record = field.grid.nodes();
  const double *mapped = nodes.data();
  for (int64_t n = field.grid.nnodes(); n > 0;
       n--, record += field.kernel.nreal, mapped += field.pic.nreal) {
    const double volume = mapped[3];
    if (!(volume > 0.0) || volume >= full) continue;
    const double own = volume / full;
    for (int d = 0; d < 3; d++) record[d] = own * record[d] + (1.0 - own) * mapped[d] / volume;
  }
}

/** Gradients go to the affine matrices of transfers that have them, as they are; what stress needs
 *  may refer to another configuration. */
void MPMStages::gradients_with_light_nodes(MPMField &field, bool stress)
{
  field.grid.copy_aliases();
  const bool fbar = stress && field.options.averages_strain();
  double *const of_all = field.affine ? field.affine->rows()
      : fbar                          ? field.locking->room_for_gradients()
                                      : nullptr;
  const PointRows r = field.rows();
  const TransferStep s = field.step_data();
  const int nL = field.lattice.dim * field.lattice.dim;
  const bool refers = stress && field.frame->refers();
  double batch_gradients[9 * BATCH];
  points_from_step(field, [&](const MPMPointMap::Run &run, int i, int n, const int *base) {
    double *L = of_all ? of_all + (bigint) nL * i : batch_gradients;
    field.kernel.g2p_gradient(r, s, i, i + n, base, field.map->tile_load, L);
    if (refers && field.affine) {
      std::copy_n(L, nL * n, batch_gradients);
      L = batch_gradients;
    }
    if (refers) field.frame->refer_gradients(i, n, L);
    if (stress && !fbar) update_stress(field, r, run, i, n, L, field.step_dt());
  });
  if (fbar) field.locking->strain(of_all, field.step_dt());
  if (stress) move_points(field);
}

// Stages: velocities of the nodes by more terms of the inverse of the full mass matrix, XPIC and
// FMPM.

/* With S from nodes to points, S+ = m^-1 S^T M back, and u = p/m of the nodes, the full mass matrix
 *  gives (S+ S)^-1 u, of which m terms of the Neumann series are
 *
 *    u_1 = u,   u_(n+1) = u_n + (u - S+ S u_n)
 *
 *  XPIC(m) (C.C. Hammerquist, J.A. Nairn, Comput. Methods Appl. Mech. Eng. 318 (2017) 724) does
 *  this to the velocity of the start of the step and adds the increment of the lumped solve.
 *  FMPM(m) (J.A. Nairn, C.C. Hammerquist, Comput. Methods Appl. Mech. Eng. 380 (2021) 113794) does
 *  it to the new velocity, which also moves positions. The transfer that follows is v_p = S v_new +
 *  flip (v_p - S v_old): XPIC clears v_p and leaves v_old - u_m in the place of v_old; FMPM leaves
 *  u_m in that of v_new, with flip = 0. */

/** Velocities of the nodes, in the reals from lane on, before terms are added. */
static void save_velocities(MPMField &field, int lane)
{
  auto &saved = field.work.node_velocities;
  saved.resize(3 * field.grid.nnodes());
  const double *record = field.grid.nodes() + lane;
  for (std::size_t k = 0; k < saved.size(); k += 3, record += 8)
    for (int d = 0; d < 3; d++) saved[k + d] = record[d];
}

/** u <- u + (saved - S+ S u) for the velocities u at a place of the records. */
static void add_term(MPMField &field, int lane)
{
  const int NREAL = field.pic.nreal;
  const int64_t nnodes = field.grid.nnodes();
  double *const record = field.grid.nodes();
  auto &nodes = field.work.nodes;
  const auto &saved = field.work.node_velocities;
  MPMPointMap &map = *field.map;
  field.work.vectors.assign(3 * (std::size_t) field.atom->nmax, 0.0);
  const PointRows r = field.rows_at_rest(field.work.vectors.data(), field.rows().mass);
  const TransferStep s = field.step_data(0.0);

  nodes.assign(nnodes * NREAL, 0.0);
  for (int64_t n = 0; n < nnodes; n++)
    for (int d = 0; d < 3; d++) nodes[NREAL * n + d] = record[NREAL * n + lane + d];
  field.grid.copy_aliases(nodes.data(), NREAL);
  for (auto &a : map.active) std::copy_n(a.box, 6, a.other_box);    // points are where they were
  points_from(nodes, field, field.pic, [&](const MPMPointMap::Run &run, const int *base) {
    field.pic.g2p(r, s, run.first, run.last, base, map.tile_load, nullptr);
  });
  points_to(nodes, field, field.pic, [&](const MPMPointMap::Run &run, const int *base, int *box) {
    field.pic.p2g_momentum(r, s, run.first, run.last, base, map.tile, box);
  });
  field.nodes.sum(nodes.data(), NREAL, 0, 3);

  for (int64_t n = 0; n < nnodes; n++) {
    const double m = record[NREAL * n + 3];
    if (!(m > 0.0)) continue;
    for (int d = 0; d < 3; d++)
      record[NREAL * n + lane + d] += saved[3 * n + d] - nodes[NREAL * n + d] / m;
  }
}

void MPMStages::xpic(MPMField &field)
{
  save_velocities(field, 4);
  for (int n = 2; n <= field.options.order; n++) add_term(field, 4);
  double *record = field.grid.nodes() + 4;
  const double *old = field.work.node_velocities.data();
  for (int64_t n = field.grid.nnodes(); n > 0; n--, record += 8, old += 3)
    for (int d = 0; d < 3; d++) record[d] = old[d] - record[d];
  double *const v = field.rows().v;
  for (const auto &run : field.map->runs)
    memset(v + 3 * (bigint) run.first, 0, 3 * sizeof(double) * (run.last - run.first));
}

void MPMStages::fmpm(MPMPlan &plan)
{
  int terms = 1;
  for (auto *field : plan.fields)
    if (field->options.has_fmpm()) {
      save_velocities(*field, 0);
      terms = std::max(terms, field->options.order);
    }
  for (int n = 2; n <= terms; n++) {
    for (auto *field : plan.fields)
      if (field->options.has_fmpm() && n <= field->options.order) add_term(*field, 0);
    plan.act_on_nodes(MPMNodeAction::AGAIN);
  }
  for (auto *field : plan.fields)
    if (field->options.has_fmpm() && field->ledger.on)
      field->ledger.count_series(field->work.node_velocities);
}
