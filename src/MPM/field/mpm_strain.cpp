/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_strain.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_affine.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_frame.h"
#include "field/mpm_guard.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_point_batches.h"
#include "field/mpm_time_limit.h"
#include "field/mpm_transfer_heat.h"
#include "field/mpm_volume_drift.h"
#include "material/batch_kernels.h"
#include "transfer/kernels.h"
#include "update.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// Strain and stress of the points.

void LAMMPS_NS::update_stress(MPMField &field, const PointRows &r, const MPMPointMap::Run &run,
                              int first, int n, const double *L, double dt)
{
  // not through row pointers: one of them per batch is always a cache miss
  Batch &b = *field.batch;
  FixMPMMaterial *material = run.material;
  if (!material) return;    // nodes of elements
  double *F = r.F + 9 * (bigint) first, *tau = r.tau + 6 * (bigint) first;
  field.drift->change_volumes(material, first, n, dt, F);
  double stretched[9 * BATCH];
  for (auto *physics : field.stretching) {
    if (!physics->stretches(first, n)) continue;
    if (L != stretched) std::copy_n(L, field.lattice.dim * field.lattice.dim * n, stretched);
    L = stretched;
    physics->stretch_gradients(field, first, n, dt, stretched);
  }
  field.frame->load(b, first, n, dt, L, F, tau, r.vol0 + first);
  b.history = reinterpret_cast<double(*)[BATCH]>(field.work.history.data());
  b.time = elapsed_time(*field.lmp->update);

  const int nhistory = material->nhistory;
  double *const h = nhistory ? &material->history[0][0] + nhistory * (bigint) first : nullptr;
  if (nhistory) {
    field.batch_kernels->load_history(b, nhistory, h);
    for (int k = 0; k < nhistory * BATCH; k += 8)    // of the next batch, a transfer ahead
      __builtin_prefetch(h + nhistory * n + k, 1);
  }

  double heat[BATCH];
  const bool heats = field.heating != nullptr;
  if (heats) field.heating->give(first, n, heat);
  material->update_batch(b, *field.batch_kernels, heats ? heat : nullptr);
  if (material->watching) material->watch_ranges(b, first);
  if (field.time_limit->watch_volume) field.time_limit->note_volume_rate(b, first);
  if (!field.options.total && !material->material->uses_F()) field.batch_kernels->forget_shape(b);

  const int bad = field.batch_kernels->store(b, F, tau);
  field.jacobians.note(*field.batch_kernels, b, first, field.atom->nmax);
  if (nhistory && !bad) field.batch_kernels->store_history(b, nhistory, h);
  for (int p = 0; p < n && nhistory && bad; p++)
    if (b.J[p] > 0.0)
      for (int k = 0; k < nhistory; k++) h[nhistory * p + k] = b.history[k][p];
  if (field.options.delete_failed && material->damage >= 0)
    for (int p = 0; p < n; p++)
      if (b.history[material->damage][p] >= 1.0) field.guard->point_has_failed(first + p);

  if (bad)
    for (int p = 0; p < n; p++)
      if (!(b.J[p] > 0.0))
        field.guard->point_is_bad(
            first + p, fmt::format("has a deformation gradient of determinant {}", b.J[p]));
}

/** Points without any stress get the pressure of their equation of state, so that the first step
 *  begins with that of a gas; for points that have come to zero stress this changes nothing; points
 *  that have failed keep it. */
void LAMMPS_NS::give_initial_stress(MPMField &field, int first)
{
  Batch &batch = *field.batch;
  const MPMRows tau = field.points->tau;
  std::vector<int> list;
  const FixMPMMaterial *material = nullptr;
  const auto flush = [&]() {
    if (list.empty()) return;
    load_state(field, batch, list.data(), (int) list.size(), material);
    batch.time = elapsed_time(*field.lmp->update);
    material->material->initial_stress(batch);
    for (std::size_t k = 0; k < list.size(); k++) {
      for (int c = 0; c < 6; c++) tau[list[k]][c] = batch.J[k] * batch.stress[c][k];
      // the energy of what begins at another temperature than that of its material
      for (std::size_t m = 0; m < material->material->history().size(); m++)
        material->history[list[k]][m] = batch.history[m][k];
    }
    list.clear();
  };

  for (int i = first; i < field.atom->nlocal; i++) {
    if (!field.is_point(i) || field.is_element_node(i) ||
        std::any_of(tau[i], tau[i] + 6, [](double s) {
          return s != 0.0;
        }))
      continue;
    const auto *mine = field.material_of(i);
    if (mine != material || list.size() == BATCH) flush();
    material = mine;
    const bool failed = mine && mine->damage >= 0 && mine->history[i][mine->damage] >= 1.0;
    if (mine && !failed) list.push_back(i);
  }
  flush();
}

void LAMMPS_NS::put_to_rest(MPMField &field, double taken[2])
{
  const double energy = field.ledger.point_kinetic_energy();
  field.ledger.take(energy);
  taken[0] += energy;
  const auto *const atom = field.atom;
  double power = 0.0;
  const int nC = field.affine ? field.affine->size() : 0,
            nQ = field.affine && field.affine->Q ? MPM_NS::poly_size(field.lattice.dim) : 0;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    double f[3] = {atom->f[i][0], atom->f[i][1], atom->f[i][2]};
    for (const auto *ifix : field.elements)
      for (int d = 0; d < 3; d++) f[d] -= ifix->forces()[3 * (bigint) i + d];
    for (int d = 0; d < 3; d++) power += f[d] * atom->v[i][d];
    std::fill_n(atom->v[i], 3, 0.0);
    if (nC) std::fill_n(field.affine->C[i], nC, 0.0);
    if (nQ) std::fill_n(field.affine->Q[i], nQ, 0.0);
  }
  taken[1] -= 0.5 * power * field.step_dt();
}
