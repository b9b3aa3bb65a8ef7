/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_poisson.h"

#include "field/mpm_node_system.h"
#include "flow/mpm_flow_bodies.h"
#include "flow/mpm_flow_fourier.h"
#include "flow/mpm_flow_gas_rows.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

void MPMFlowPoisson::begin()
{
  const int n = rows.size();
  part.resize(n);
  inverse.resize(n);
  sum.resize(n);
  for (int i = 0; i < n; i++) {
    part[i] = multigrid.part_of(rows.cell_at(i));
    inverse[i] = 1.0 / diagonal[i];
  }
}

const double *MPMFlowPoisson::on_lattice(const double *of, std::vector<double> &to) const
{
  to.assign(cells.size(), 0.0);
  for (int i = 0; i < rows.size(); i++) to[rows.cell_at(i)] = of[i];
  return to.data();
}

void MPMFlowPoisson::apply(const double *x, double *y)
{
  const int n = rows.size();
  std::copy_n(x, n, rows.values.data());
  rows.sum_all(weight, sum.data());
  for (int i = 0; i < n; i++) y[i] = diagonal[i] * x[i] - sum[i];
  if (gas) gas->add(x, y);
  if (!bodies) return;
  on_lattice(y, on_cells[1]);
  bodies->add(on_lattice(x, on_cells[0]), on_cells[1].data());
  for (int i = 0; i < n; i++) y[i] = on_cells[1][rows.cell_at(i)];
}

/** Corrects values of even cells by their residuals in sum. */
void MPMFlowPoisson::correct()
{
  const int neven = rows.size_of(MPMFlowRows::EVEN);
  auto &values = rows.values;
  if (fourier) {
    parts.assign(sum.begin(), sum.begin() + neven);
    fourier->solve(parts);
    for (int i = 0; i < neven; i++) values[i] += parts[i];
    return;
  }
  parts.assign(multigrid.parts(), 0.0);
  for (int i = 0; i < neven; i++) parts[part[i]] += sum[i];
  multigrid.correct(parts);
  for (int i = 0; i < neven; i++) values[i] += parts[part[i]];
}

void MPMFlowPoisson::precondition(const double *r, double *z)
{
  constexpr auto EVEN = MPMFlowRows::EVEN, ODD = MPMFlowRows::ODD;
  const int neven = rows.size_of(EVEN), n = rows.size();
  auto &values = rows.values;
  const auto relax_odd = [&]() {
    rows.sum(ODD, weight, sum.data() + neven);
    for (int i = neven; i < n; i++) values[i] = inverse[i] * (r[i] + sum[i]);
  };
  for (int i = 0; i < neven; i++) values[i] = inverse[i] * r[i];
  relax_odd();
  rows.sum(EVEN, weight, sum.data());
  correct();
  relax_odd();
  rows.sum(EVEN, weight, sum.data());
  for (int i = 0; i < neven; i++) z[i] = inverse[i] * (r[i] + sum[i]);
  std::copy_n(values.data() + neven, n - neven, z + neven);
  if (multigrid.closed_pools() == 0) return;
  on_lattice(z, on_cells[0]);
  multigrid.project(on_cells[0].data());
  for (int i = 0; i < n; i++) z[i] = on_cells[0][rows.cell_at(i)];
}

void MPMFlowPoisson::products(int n, const double *const *a, const double *const *b, double *value)
{
  mine.assign(n, 0.0);
  for (int k = 0; k < n; k++)
    for (int i = 0; i < rows.size(); i++) mine[k] += a[k][i] * b[k][i];
  sum_in_order(lmp, n, mine.data(), rank_sums, value);
}

double MPMFlowPoisson::memory_usage() const
{
  double reals = 0.0;
  for (const auto *list :
       {&diagonal, &weight, &inverse, &sum, &parts, &mine, &rank_sums, &on_cells[0], &on_cells[1]})
    reals += list->capacity();
  return reals * sizeof(double) + part.capacity() * sizeof(int) + multigrid.memory_usage();
}
