/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_forces.h"

#include "field/mpm_cpdi.h"
#include "field/mpm_passes.h"
#include "field/mpm_plan.h"
#include "material/batch_kernels.h"

#include <algorithm>
#include <cstdint>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** No two of them have one: each refuses what it does not go with. */
const double *LAMMPS_NS::pore_pressure(const MPMField &field)
{
  for (const auto *water : field.plan->pore_pressures)
    if (const double *const pressure = water->pressure_in_forces(field)) return pressure;
  return nullptr;
}

bool LAMMPS_NS::has_added_stress(const MPMField &field, int first, int last)
{
  const auto &all = field.plan->added_stresses;
  return std::any_of(all.begin(), all.end(), [&](const auto *one) {
    return one->adds_stress(field, first, last);
  });
}

void LAMMPS_NS::add_stress(const MPMField &field, int first, int n, double *tau)
{
  for (const auto *one : field.plan->added_stresses) one->add_stress(field, first, n, tau);
}

bool LAMMPS_NS::pore_surface_force(MPMField &field, const std::vector<char> &near,
                                   std::vector<double> &force)
{
  const auto &all = field.plan->pore_pressures;
  return std::any_of(all.begin(), all.end(), [&](const auto *water) {
    return water->surface_force(field, near, force);
  });
}

void LAMMPS_NS::subtract_pressure(const double *pressure, PointRows &rows, int first, int n,
                                  double *work)
{
  const double *tau = rows.tau;
  const auto next = reinterpret_cast<std::uintptr_t>(rows.tau + 6 * n);    // of the next batch
  for (int k = 0; k < 6 * BATCH; k += 8)
    __builtin_prefetch(reinterpret_cast<const void *>(next + 8 * k));
  rows.tau = work;
  std::copy_n(tau, 6 * n, work);
  for (int p = 0; p < n; p++, work += 6)
    for (int c = 0; c < 3; c++) work[c] -= pressure[first + p];
}

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
