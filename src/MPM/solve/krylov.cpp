/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/krylov.h"

#include <cmath>
#include <cstdio>

using namespace MPM_NS;

std::string SolveReport::describe() const
{
  static const char *const meanings[] = {
      "converged", "did not converge", "is not positive definite",
      "is singular, and the right side not in its range,", "has a residual that is not a number"};
  char text[64];
  std::string all = std::string(meanings[outcome]) + " after " + std::to_string(iterations) +
      " iterations, residuals";
  // at most eight of them, the last one among these

  const std::size_t n = residuals.size(), every = (n + 7) / 8;
  for (std::size_t k = every ? (n - 1) % every : 0; k < n; k += every) {
    snprintf(text, sizeof(text), " %.3g", residuals[k]);
    all += text;
  }
  return all;
}

void MPM_NS::find_residual(LinearSystem &system, const double *b, const double *x, double *r)
{
  const int64_t n = system.size();
  system.apply(x, r);
  for (int64_t i = 0; i < n; i++) r[i] = b[i] - r[i];
}

SolveReport ConjugateGradients::solve(LinearSystem &system, const double *b, double *x,
                                      const SolveGoal &goal)
{
  SolveReport report;
  const int64_t n = system.size();
  for (auto *vector : {&r, &z, &p, &Ap}) vector->resize(n);

  find_residual(system, b, x, r.data());
  const auto precondition = [&](double &rz, double &rr) {
    system.precondition(r.data(), z.data());
    const double *const left[] = {r.data(), r.data()}, *const right[] = {z.data(), r.data()};
    double value[2];
    system.products(2, left, right, value);
    rz = value[0];
    rr = value[1];
  };

  report.right_side = std::sqrt(system.product(b, b));
  double rz, rr;
  precondition(rz, rr);
  if (goal.natural) report.right_side = std::sqrt(std::max(rz, 0.0));
  const double enough = goal.enough(report.right_side);
  p = z;
  while (true) {
    if (goal.natural && rr > 0.0 && rz > 0.0) rr = rz;
    report.residuals.push_back(std::sqrt(rr));
    if (!std::isfinite(rr) || !std::isfinite(rz))
      report.outcome = SolveReport::NOT_FINITE;
    else if (std::sqrt(rr) <= enough)
      return report;
    else if (rz <= 0.0)
      report.outcome = SolveReport::INDEFINITE;
    else if (report.iterations == goal.most_iterations)
      report.outcome = SolveReport::TOO_MANY;
    if (!report.converged()) return report;

    system.apply(p.data(), Ap.data());
    const double curvature = system.product(p.data(), Ap.data());
    if (!(curvature > 0.0)) {
      report.outcome = std::isfinite(curvature) ? SolveReport::INDEFINITE : SolveReport::NOT_FINITE;
      return report;
    }
    const double alpha = rz / curvature;
    for (int64_t i = 0; i < n; i++) {
      x[i] += alpha * p[i];
      r[i] -= alpha * Ap[i];
    }
    const double rz_before = rz;
    precondition(rz, rr);
    const double beta = rz / rz_before;
    for (int64_t i = 0; i < n; i++) p[i] = z[i] + beta * p[i];
    report.iterations++;
  }
}
