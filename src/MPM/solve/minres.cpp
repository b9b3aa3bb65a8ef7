/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/minres.h"

#include <algorithm>
#include <cmath>
#include <utility>

using namespace MPM_NS;

// of |A r| over |A| |r|: what is below this is round-off of a residual that the operator does not see
static constexpr double BLIND = 1.0e-10;

SolveReport MinimalResiduals::solve(LinearSystem &system, const double *b, double *x,
                                    const SolveGoal &goal)
{
  SolveReport report;
  const int64_t n = system.size();
  for (auto *vector : {&r, &Az, &v, &v_old, &z, &z_new, &w, &w_old}) vector->resize(n);
  report.right_side = std::sqrt(system.product(b, b));
  const double enough = goal.enough(report.right_side);

  // residuals are known by recurrence, from which round-off may lead away: where this shows, from the start with what is left

  double before = 0.0;
  while (true) {
    find_residual(system, b, x, r.data());
    const double residual = std::sqrt(system.product(r.data(), r.data()));
    const bool first = report.residuals.empty();
    if (first) report.residuals.push_back(0.0);
    report.residuals.back() = residual;
    if (!std::isfinite(residual))
      report.outcome = SolveReport::NOT_FINITE;
    else if (residual <= enough)
      return report;
    else if (report.iterations >= goal.most_iterations || (!first && residual > 0.5 * before))
      report.outcome = SolveReport::TOO_MANY;
    if (!report.converged()) return report;
    before = residual;
    cycle(system, x, goal, enough, report);
    if (!report.converged()) return report;
  }
}

/** Iterations from the residual r on, until its recurrence is small enough, or there have been too many. */
void MinimalResiduals::cycle(LinearSystem &system, double *x, const SolveGoal &goal, double enough,
                             SolveReport &report)
{
  const int64_t n = system.size();
  v = r;
  for (auto *vector : {&v_old, &w, &w_old}) std::fill(vector->begin(), vector->end(), 0.0);
  system.precondition(v.data(), z.data());

  // false: the preconditioner is not positive definite for v
  const auto norm_of = [&](double zv, double &gamma) {
    if (std::isfinite(zv) && zv >= 0.0) {
      gamma = std::sqrt(zv);
      return true;
    }
    report.outcome = std::isfinite(zv) ? SolveReport::INDEFINITE : SolveReport::NOT_FINITE;
    return false;
  };
  double gamma, gamma_old = 1.0, gamma_new;
  if (!norm_of(system.product(z.data(), v.data()), gamma)) return;
  if (gamma == 0.0) {
    report.outcome = SolveReport::INDEFINITE;
    return;
  }
  double eta = gamma, c = 1.0, c_old = 1.0, s = 0.0, s_old = 0.0, largest = 0.0;

  while (report.iterations < goal.most_iterations) {
    // the next vector of Lanczos

    for (int64_t i = 0; i < n; i++) z[i] /= gamma;
    system.apply(z.data(), Az.data());
    const double delta = system.product(Az.data(), z.data());
    const double by_v = delta / gamma, by_v_old = gamma / gamma_old;
    for (int64_t i = 0; i < n; i++) {
      const double next = Az[i] - by_v * v[i] - by_v_old * v_old[i];
      v_old[i] = v[i];
      v[i] = next;
    }
    system.precondition(v.data(), z_new.data());
    if (!norm_of(system.product(z_new.data(), v.data()), gamma_new)) return;
    largest = std::max({largest, std::fabs(delta), gamma_new});

    // its rotation; |A r| is |eta| times the first root here

    const double diagonal = c * delta - c_old * s * gamma;
    if (std::hypot(diagonal, c * gamma_new) <= BLIND * largest) {
      report.outcome = SolveReport::SINGULAR;
      return;
    }
    const double above = s * delta + c_old * c * gamma, above_2 = s_old * gamma;
    const double length = std::hypot(diagonal, gamma_new);
    c_old = c;
    s_old = s;
    c = diagonal / length;
    s = gamma_new / length;

    const double step = c * eta;
    eta *= -s;
    const double by_r = s * s, by_new = gamma_new > 0.0 ? c * eta / gamma_new : 0.0;
    for (int64_t i = 0; i < n; i++) {
      const double next = (z[i] - above_2 * w_old[i] - above * w[i]) / length;
      w_old[i] = w[i];
      w[i] = next;
      x[i] += step * next;
      r[i] = by_r * r[i] + by_new * v[i];
    }
    std::swap(z, z_new);
    gamma_old = gamma;
    gamma = gamma_new;
    report.iterations++;
    report.residuals.push_back(std::sqrt(system.product(r.data(), r.data())));
    // all of the space of Krylov has been seen where gamma is 0

    if (!(report.residuals.back() > enough) || gamma == 0.0) return;
  }
}

double MinimalResiduals::memory_usage() const
{
  double bytes = 0.0;
  for (const auto *vector : {&r, &Az, &v, &v_old, &z, &z_new, &w, &w_old})
    bytes += vector->capacity() * sizeof(double);
  return bytes;
}
