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
/* ---------------------------------------------------------------------- */

// what is left of a vector after its parts along others, over its length, when it is one of their
// span but for round-off
static constexpr double ROUND_OFF = 1.0e-14;

SolveReport FlexibleGMRES::solve(LinearSystem &system, const double *b, double *x,
                                 const SolveGoal &goal)
{
  SolveReport report;
  const int64_t n = system.size();
  v.resize(longest + 1);
  z.resize(longest);
  h.assign((std::size_t) longest * (longest + 2), 0.0);
  c.assign(longest, 0.0);
  s.assign(longest, 0.0);
  g.assign(longest + 1, 0.0);
  report.right_side = std::sqrt(system.product(b, b));
  const double enough = goal.enough(report.right_side);

  bool exhausted = false;    // the space of Krylov was at the end of a cycle
  double before = 0.0;       // residual at its start
  while (true) {
    // from here on with the true residual, also to check that which is known by rotations
    v[0].resize(n);
    auto &r = v[0];
    find_residual(system, b, x, r.data());
    const double residual = std::sqrt(system.product(r.data(), r.data()));
    if (report.residuals.empty()) report.residuals.push_back(residual);
    report.residuals.back() = residual;
    if (!std::isfinite(residual))
      report.outcome = SolveReport::NOT_FINITE;
    else if (residual <= enough)
      return report;
    else if (exhausted && residual > 0.5 * before)
      report.outcome = SolveReport::SINGULAR;
    else if (report.iterations >= goal.most_iterations)
      report.outcome = SolveReport::TOO_MANY;
    if (!report.converged()) return report;

    before = residual;
    for (int64_t i = 0; i < n; i++) r[i] /= residual;
    g[0] = residual;
    int j = 0;
    double largest = 0.0;
    while (j < longest && report.iterations < goal.most_iterations) {
      z[j].resize(n);
      v[j + 1].resize(n);
      system.precondition(v[j].data(), z[j].data());
      system.apply(z[j].data(), v[j + 1].data());
      orthogonalize(system, j, largest);

      double *const row = column(j);
      for (int k = 0; k < j; k++) {
        const double upper = c[k] * row[k] + s[k] * row[k + 1];
        row[k + 1] = c[k] * row[k + 1] - s[k] * row[k];
        row[k] = upper;
      }
      const double length = std::hypot(row[j], row[j + 1]);
      if (!std::isfinite(length)) {
        update(j, x);
        report.outcome = SolveReport::NOT_FINITE;
        return report;
      }
      exhausted = row[j + 1] <= ROUND_OFF * largest;
      report.iterations++;
      if (length <= ROUND_OFF * largest) {    // nothing that the vectors before have not given
        report.residuals.push_back(0.0);
        break;
      }
      c[j] = row[j] / length;
      s[j] = row[j + 1] / length;
      row[j] = length;
      g[j + 1] = -s[j] * g[j];
      g[j] *= c[j];
      j++;
      report.residuals.push_back(std::fabs(g[j]));
      if (exhausted || report.residuals.back() <= enough) break;
    }
    update(j, x);
  }
}

void FlexibleGMRES::orthogonalize(LinearSystem &system, int j, double &largest)
{
  const int64_t n = system.size();
  auto &next = v[j + 1];
  double *const row = column(j);
  std::fill_n(row, j + 2, 0.0);

  // classical Gram and Schmidt twice: as good as the modified form once, with two sums over ranks
  // and not j + 1

  left.resize(j + 2);
  right.assign(j + 2, next.data());
  part.resize(j + 2);
  for (int k = 0; k < j + 2; k++) left[k] = v[k].data();
  for (int pass = 0; pass < 2; pass++) {
    system.products(j + 2, left.data(), right.data(), part.data());
    if (pass == 0) largest = std::max(largest, std::sqrt(part[j + 1]));
    for (int k = 0; k <= j; k++) {
      row[k] += part[k];
      const double *const vk = v[k].data();
      for (int64_t i = 0; i < n; i++) next[i] -= part[k] * vk[i];
    }
  }
  row[j + 1] = std::sqrt(system.product(next.data(), next.data()));
  if (row[j + 1] > 0.0)
    for (int64_t i = 0; i < n; i++) next[i] /= row[j + 1];
}

/** Add the best combination of the first n vectors to x. */
void FlexibleGMRES::update(int n, double *x)
{
  auto &y = part;
  y.resize(n);
  for (int j = n - 1; j >= 0; j--) {
    y[j] = g[j];
    for (int k = j + 1; k < n; k++) y[j] -= h[(std::size_t) k * (longest + 2) + j] * y[k];
    y[j] /= h[(std::size_t) j * (longest + 2) + j];
  }
  for (int j = 0; j < n; j++)
    for (std::size_t i = 0; i < z[j].size(); i++) x[i] += y[j] * z[j][i];
}

double FlexibleGMRES::memory_usage() const
{
  double bytes = h.capacity() * sizeof(double);
  for (const auto *vectors : {&v, &z})
    for (const auto &vector : *vectors) bytes += vector.capacity() * sizeof(double);
  return bytes;
}
