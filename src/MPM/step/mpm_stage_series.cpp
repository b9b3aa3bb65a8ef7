/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Stages: velocities of the nodes by more terms of the inverse of the full mass matrix, XPIC and
// FMPM.

#include "atom.h"
#include "field/mpm_field.h"
#include "field/mpm_passes.h"
#include "field/mpm_plan.h"
#include "step/mpm_stages.h"

#include <algorithm>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

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
