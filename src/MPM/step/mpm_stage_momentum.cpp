/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Stages: points to nodes, and the momentum equation.

#include "atom.h"
#include "field/mpm_affine.h"
#include "field/mpm_cpdi.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_locking.h"
#include "field/mpm_passes.h"
#include "step/mpm_stages.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** Where the frame has forces of its own (Piola-Kirchhoff stress, hoop stress), it makes them a
 *  batch at a time, and so are those of other physics. */
void LAMMPS_NS::run_to_tile(MPMField &field, P2G p2g, const PointRows &rows,
                            const TransferStep &step, const MPMPointMap::Run &run,
                            const int base[3], int box[6])
{
  double *const tile = field.map->tile;
  const double *const pressure = pore_pressure(field);
  const bool loaded =
      p2g != field.kernel.p2g_momentum && has_added_stress(field, run.first, run.last);
  if ((!field.frame->changes_forces() && !pressure && !loaded) ||
      p2g == field.kernel.p2g_momentum) {
    p2g(rows, step, run.first, run.last, base, tile, box);
    return;
  }
  MPMFrame::ForceRows room;
  double stress[6 * BATCH + 8];
  for (int i = run.first; i < run.last; i += BATCH) {
    const int n = std::min(BATCH, run.last - i);
    PointRows b = rows_from(field, rows, i);
    if (pressure) subtract_pressure(pressure, b, i, n, stress);
    if (loaded) {
      if (!pressure) std::copy_n(b.tau, 6 * n, stress);
      add_stress(field, i, n, stress);
      b.tau = stress;
    }
    field.frame->forces(b, i, n, room);
    p2g(b, step, 0, n, base, tile, box);
  }
}

PointRows LAMMPS_NS::rows_from(const MPMField &field, const PointRows &rows, int first)
{
  const int nC = field.lattice.dim * field.lattice.dim;
  const bigint i = first;
  PointRows b = rows;
  b.x += 3 * i;
  b.v += 3 * i;
  b.f += 3 * i;
  if (b.C) b.C += nC * i;
  if (b.F) b.F += 9 * i;
  b.vol0 += i;
  b.mass += i;
  b.guarded -= first;
  b.tau += 6 * i;
  if (b.size) b.size += 3 * i;
  if (b.domain) b.domain += field.domains->size() * i;
  if (b.xnew) b.xnew += 3 * i;
  if (b.from) b.from += 3 * i;
  if (b.corners_new) b.corners_new += field.domains->size() * i;
  return b;
}

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
                             field.step_dt());
  if (field.ledger.on) field.ledger.nodes_solved();
}

void MPMStages::velocities(MPMField &field)
{
  field.kernels->solve_nodes(field.grid.nodes(), (int) field.grid.nnodes(), field.kernel.nreal,
                             0.0);
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
