/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_spread.h"

#include "field/mpm_node_system.h"
#include "lammps.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

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

double MPMFlowSpread::memory_usage() const
{
  double reals = 0.0;
  for (const auto *list :
       {&root, &factor, &right_side, &solution, &direction, &changes, &product, &sums})
    reals += list->capacity();
  return reals * sizeof(double);
}
