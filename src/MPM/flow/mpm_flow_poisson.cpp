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
#include "flow/mpm_flow_gas.h"

#include "lammps.h"

#include <algorithm>
#include <cmath>

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
  return multigrid.memory_usage() +
      bytes_of(diagonal, weight, inverse, sum, parts, mine, rank_sums, on_cells[0], on_cells[1],
               part);
}

/* ---------------------------------------------------------------------- */

void MPMFlowSpread::scale(const std::vector<double> &diagonal, const std::vector<double> &weight)
{
  const int n = rows.size(), sides = rows.sides();
  root.resize(n);
  factor.resize(weight.size());
  for (int i = 0; i < n; i++) rows.values[i] = root[i] = 1.0 / std::sqrt(diagonal[i]);
  rows.fetch(MPMFlowRows::EVEN);
  rows.fetch(MPMFlowRows::ODD);
  rows.wait();
  for (int i = 0; i < n; i++)
    for (int s = 0; s < sides; s++) {
      const std::size_t k = (std::size_t) i * sides + s;
      factor[k] = root[i] * weight[k] * rows.values[rows.near(i, s)];
    }
  std::fill(rows.values.begin(), rows.values.end(), 0.0);
}

/* ----------------------------------------------------------------------
   Scaled to a diagonal of one: u_odd = f_odd + C u_even, and (1 - C C) u_even = f_even + C f_odd
------------------------------------------------------------------------- */

SolveReport MPMFlowSpread::solve(const std::vector<double> &diagonal,
                                 const std::vector<double> &weight, const double *load, double *x,
                                 const SolveGoal &goal)
{
  constexpr auto EVEN = MPMFlowRows::EVEN, ODD = MPMFlowRows::ODD;
  scale(diagonal, weight);
  SolveReport report;
  const int all_of = rows.size(), n = rows.size_of(EVEN), nodd = rows.size_of(ODD);
  double *const r = rows.values.data(), *const odd = r + n;
  double mine[3] = {0.0, 0.0, 0.0}, all[3];
  right_side.resize(all_of);
  for (int i = 0; i < all_of; i++) {
    right_side[i] = root[i] * load[i];
    mine[2] += right_side[i] * right_side[i];
  }
  for (auto *vector : {&solution, &direction, &changes}) vector->assign(n, 0.0);
  product.resize(n);

  std::copy_n(right_side.data() + n, nodd, odd);
  rows.sum(EVEN, factor, product.data());
  for (int i = 0; i < n; i++) {
    r[i] = right_side[i] + product[i];
    mine[0] += r[i] * r[i];
  }

  double rr_before = 0.0, alpha = 0.0, enough = 0.0;
  while (true) {
    rows.sum(ODD, factor, odd);
    rows.sum(EVEN, factor, product.data());
    mine[1] = 0.0;
    for (int i = 0; i < n; i++) {
      product[i] = r[i] - product[i];
      mine[1] += r[i] * product[i];
    }
    sum_in_order(lmp, report.iterations ? 2 : 3, mine, sums, all);
    if (report.iterations == 0) {
      report.right_side = std::sqrt(all[2]);
      enough = goal.enough(report.right_side);
    }
    const double rr = all[0], beta = report.iterations ? rr / rr_before : 0.0;
    report.residuals.push_back(std::sqrt(rr));
    if (!std::isfinite(rr) || !std::isfinite(all[1]))
      report.outcome = SolveReport::NOT_FINITE;
    else if (std::sqrt(rr) <= enough)
      break;
    else if (report.iterations == goal.most_iterations)
      report.outcome = SolveReport::TOO_MANY;
    if (!report.converged()) return report;

    const double curvature = report.iterations ? all[1] - beta * rr / alpha : all[1];
    if (!(curvature > 0.0)) {
      report.outcome = std::isfinite(curvature) ? SolveReport::INDEFINITE : SolveReport::NOT_FINITE;
      return report;
    }
    alpha = rr / curvature;
    rr_before = rr;
    mine[0] = 0.0;
    for (int i = 0; i < n; i++) {
      direction[i] = r[i] + beta * direction[i];
      changes[i] = product[i] + beta * changes[i];
      solution[i] += alpha * direction[i];
      r[i] -= alpha * changes[i];
      mine[0] += r[i] * r[i];
    }
    report.iterations++;
  }

  std::copy_n(solution.data(), n, r);
  rows.sum(ODD, factor, odd);
  for (int i = 0; i < nodd; i++) odd[i] += right_side[n + i];
  for (int i = 0; i < all_of; i++) x[i] = root[i] * rows.values[i];
  return report;
}
