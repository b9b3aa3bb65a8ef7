/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Stages: nodes to points, strain and stress of the points.

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
#include "field/mpm_point_batches.h"
#include "field/mpm_strain.h"
#include "field/mpm_time_limit.h"
#include "field/mpm_transfer_heat.h"
#include "step/mpm_stages.h"
#include "update.h"

#include <algorithm>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

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
