/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Stages: nodes to points.

#include "atom.h"
#include "mpm_affine.h"
#include "mpm_cpdi.h"
#include "mpm_every.h"
#include "mpm_field.h"
#include "mpm_frame.h"
#include "mpm_guard.h"
#include "mpm_locking.h"
#include "mpm_passes.h"
#include "mpm_stages.h"
#include "mpm_time_limit.h"

#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   With scheme usl and without light nodes the motion of this step is that of the material: stress is
   made at once, while points are in the cache
------------------------------------------------------------------------- */

void MPMStages::nodes_to_points(MPMField &field, Strain strain)
{
  field.nodes.complete_velocities();
  MPMFrame &frame = *field.frame;
  const bool late = field.options.moves_late(), strains = strain >= GRADIENTS;
  const bool apart = strains && field.options.strains_apart(), refers = strains && frame.refers();
  const bool in_C = field.kernel.gradient_in_C && !refers;    // what stress needs is there
  const bool keeps = strain == GRADIENTS && !in_C;
  const int nL = field.lattice.dim * field.lattice.dim;
  if (late) field.work.xnew.resize(3 * (std::size_t) field.atom->nmax);
  if (strain != ELSEWHERE) frame.begin_strain();
  double *const kept = keeps ? field.locking->room_for_gradients() : nullptr;

  PointRows r = field.rows();
  if (field.domains) r.corners_new = field.domains->moved(late);
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
    if (apart) kernel.g2p_gradient(r, s, i, last, base, tile, L);
    if (strain != ELSEWHERE) frame.before_motion(i, last);
    field.map->drifted |=
        kernel.g2p(r, s, i, last, base, tile, strains && !in_C && !apart ? L : nullptr);
    if (strain != ELSEWHERE) frame.after_motion(r, i, last);
    if (refers) frame.refer_gradients(i, n, L);
    if (strain == STRESS) update_stress(field, r, run, i, n, in_C ? r.C + (bigint) nL * i : L, dt);
  });
  if (strain == GRADIENTS) {
    field.locking->strain(in_C ? r.C : kept, dt);
    move_points(field);
  }
}

/* ---------------------------------------------------------------------- */

void MPMStages::move_points(MPMField &field)
{
  double **const x = field.atom->x;
  for (const auto &run : field.map->runs)
    memcpy(&x[run.first][0], &field.work.xnew[3 * (std::size_t) run.first],
           3 * sizeof(double) * (run.last - run.first));
  if (field.domains)
    for (const auto &run : field.map->runs) field.domains->take_late(run.first, run.last);
}

/* ---------------------------------------------------------------------- */

void MPMStages::checks(MPMField &field)
{
  if (field.ledger.on) field.ledger.account_for_points();
  MPMPointMap &map = *field.map;
  if (map.drifted && field.domains) field.domains->check_corners();
  if (map.drifted) field.guard->check_positions();
  map.check_drift();
  field.guard->handle_bad_points();
  field.frame->end_of_step();
  field.time_limit->check();
  auto &counts = field.counts;
  const double dt = field.step_dt();
  counts.dt_min = std::min(counts.dt_min, dt);
  counts.dt_max = std::max(counts.dt_max, dt);
  counts.steps++;
  counts.point_steps += map.npoints();
  if (field.every) field.every->finish();
}
