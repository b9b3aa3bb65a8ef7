/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_forces.h"

#include "field/mpm_field.h"
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
