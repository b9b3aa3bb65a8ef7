/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   With t = g dt, the base b of a stage, and the linearized changes J of the rates, a correction d
   of the values y solves

     C (1 - t J) d = C (b + t f(y) - y),

   symmetric where J is so in the norm of the capacities C. Both sides are in the units of what is
   conserved (heat), so that nodes that points hardly reach, which have next to no capacity, count
   little. What is prescribed is in the rates, which do not change it: residuals and corrections are
   in the range of a projection P, with C P symmetric.

   The residual must be below the tolerance times the change of the values in the step, both times
   C, and not below the round-off of the rates, which may cancel: about 1e-16 C y (1 + t r) with the
   fastest rate r.
------------------------------------------------------------------------- */

#include "diffusion/mpm_diffusion_solver.h"

#include "diffusion/mpm_node_scalar.h"
#include "field/mpm_field.h"
#include "field/mpm_node_system.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int MOST_NEWTON = 40, MOST_LINEAR = 2000;
// times the greatest rate of the equations: below, the diagonal takes as few products as levels and
// their set-up do
static constexpr double LONG = 100.0;
static constexpr int DO_WELL = 40;    // iterations with the preconditioner of other values
static constexpr double ROUND_OFF = 4.0e-16;

void MPMDiffusion::add_diagonal_of(int n, const int64_t *nodes, int ngrad, const double *gradient,
                                   const double *stiffness, std::vector<double> &diagonal)
{
  for (int i = 0; i < n; i++, gradient += ngrad)
    for (int a = 0; a < ngrad; a++)
      for (int b = 0; b < ngrad; b++)
        diagonal[nodes[i]] += gradient[a] * stiffness[ngrad * a + b] * gradient[b];
}

/** The equations of one part alone, as its levels see them. */
class MPMDiffusionSolver::OnePart : public LinearSystem {
 public:
  OnePart(MPMDiffusionSolver &all, const Part &part) :
      all(all), part(part), x_of_all(all.size(), 0.0), y_of_all(all.size())
  {
  }
  int64_t size() const override { return (int64_t) part.capacity.size(); }
  void apply(const double *x, double *y) override
  {
    std::copy_n(x, size(), x_of_all.data() + part.first);
    all.apply(x_of_all.data(), y_of_all.data());
    std::copy_n(y_of_all.data() + part.first, size(), y);
  }
  void products(int n, const double *const *a, const double *const *b, double *value) override
  {
    std::vector<double> mine(n, 0.0);
    add_products(part.field.grid, 1, n, a, b, 0, mine.data());
    sum_in_order(all.lmp, n, mine.data(), all.rank_sums, value);
  }

 private:
  MPMDiffusionSolver &all;
  const Part &part;
  std::vector<double> x_of_all, y_of_all;
};

void MPMDiffusionSolver::clear()
{
  parts.clear();
  integrals.clear();
}

void MPMDiffusionSolver::add(MPMField &field, MPMNodeScalar &scalar)
{
  parts.push_back({field, scalar, MPMLatticeRanks(lmp, field.grid, *field.nodes.halo)});
}

void MPMDiffusionSolver::add(std::vector<double> &integral, const std::vector<double> &rate)
{
  integrals.push_back({integral, rate, {}, {}});
}

int64_t MPMDiffusionSolver::size() const
{
  int64_t n = 0;
  for (const auto &part : parts) n += (int64_t) part.capacity.size();
  return n;
}

void MPMDiffusionSolver::apply(const double *x, double *y)
{
  int k = 0;
  for (auto &part : parts) {
    part.scalar.value.assign(x + part.first, x + part.first + part.capacity.size());
    equations.project(k++, part.scalar.value);
    part.field.nodes.complete(part.scalar.value.data(), 1, 1);
  }
  equations.find_changes();
  for (auto &part : parts) {
    auto &rate = part.scalar.rate;
    part.field.nodes.complete(rate.data(), 1, 1);
    for (std::size_t i = 0; i < part.capacity.size(); i++)
      y[part.first + i] = part.capacity[i] * (part.scalar.value[i] - implicit_dt * rate[i]);
  }
}

void MPMDiffusionSolver::precondition(const double *r, double *z)
{
  int k = 0;
  for (auto &part : parts) {
    const std::size_t n = part.capacity.size();
    preconditioned.resize(n);
    if (by_levels)
      part.levels->precondition(r + part.first, preconditioned.data());
    else
      for (std::size_t i = 0; i < n; i++)
        preconditioned[i] = part.diagonal[i] > 0.0 ? r[part.first + i] / part.diagonal[i] : 0.0;
    for (std::size_t i = 0; i < n; i++)
      if (!(part.capacity[i] > 0.0)) preconditioned[i] = 0.0;
    equations.project(k++, preconditioned);
    part.field.nodes.complete(preconditioned.data(), 1, 1);
    std::copy(preconditioned.begin(), preconditioned.end(), z + part.first);
  }
}

void MPMDiffusionSolver::products(int n, const double *const *a, const double *const *b,
                                  double *value)
{
  std::vector<double> mine(n, 0.0);
  for (const auto &part : parts) add_products(part.field.grid, 1, n, a, b, part.first, mine.data());
  sum_in_order(lmp, n, mine.data(), rank_sums, value);
}

/** Diagonals, and in long steps levels, of the equations as they are linearized now. They serve all
 *  stages of a step. */
void MPMDiffusionSolver::prepare(double greatest)
{
  by_levels = implicit_dt * greatest > LONG;
  int k = 0;
  std::vector<double> stiffness;
  for (auto &part : parts) {
    part.diagonal.assign(part.capacity.size(), 0.0);
    equations.add_diagonal(k++, implicit_dt, part.diagonal);
    for (double &d : part.diagonal) d *= implicit_dt;
    part.field.nodes.sum(part.diagonal.data(), 1, 0, 1);
    part.field.nodes.complete(part.diagonal.data(), 1, 1);
    for (std::size_t i = 0; i < part.capacity.size(); i++)
      part.diagonal[i] = part.capacity[i] > 0.0 ? part.diagonal[i] + part.capacity[i] : 0.0;
  }
  k = 0;
  for (auto &part : parts) {
    if (!by_levels) break;
    if (!part.levels)
      part.levels = std::make_unique<SplineMultigrid>(part.field.grid, part.ranks, 1,
                                                      stencil_order(part.field.options.shape));
    part.levels->begin(nullptr, part.diagonal.data());
    equations.each_term(
        k++, implicit_dt,
        [&](int n, const int64_t *nodes, int ngrad, const double *gradient, const double *S) {
          stiffness.assign(S, S + ngrad * ngrad);
          for (double &s : stiffness) s *= implicit_dt;
          part.levels->add_point(n, nodes, ngrad, gradient, stiffness.data());
        });
    part.alone = std::make_unique<OnePart>(*this, part);
    part.levels->finish(*part.alone, part.capacity.data());
    by_levels = by_levels && part.levels->usable();
  }
}

/** What is left of the equations of a stage at the values `at` of all parts; its size. */
double MPMDiffusionSolver::find_residual()
{
  for (auto &part : parts) part.scalar.value = part.at;
  equations.find_rates();
  for (auto &part : parts) part.field.nodes.complete(part.scalar.rate.data(), 1, 1);
  return residual_of_rates();
}

/** The same with the rates that are known at these values. */
double MPMDiffusionSolver::residual_of_rates()
{
  for (const auto &part : parts)
    for (std::size_t i = 0; i < part.capacity.size(); i++)
      residual[part.first + i] =
          part.capacity[i] * (part.base[i] + implicit_dt * part.scalar.rate[i] - part.at[i]);
  return std::sqrt(product(residual.data(), residual.data()));
}

/** Size of the first correction, times capacities, as the preconditioner finds it. The residual
 *  itself is much larger where values decay much faster than in a step. */
double MPMDiffusionSolver::expected_change()
{
  precondition(residual.data(), correction.data());
  for (const auto &part : parts)
    for (std::size_t i = 0; i < part.capacity.size(); i++)
      correction[part.first + i] *= part.capacity[i];
  return std::sqrt(product(correction.data(), correction.data()));
}

/** Of capacities times values, or times their change since the start of the stage. */
double MPMDiffusionSolver::size_of_values(bool of_change)
{
  std::vector<double> &list = correction;
  for (const auto &part : parts)
    for (std::size_t i = 0; i < part.capacity.size(); i++)
      list[part.first + i] = part.capacity[i] * (part.at[i] - (of_change ? part.base[i] : 0.0));
  return std::sqrt(product(list.data(), list.data()));
}

/** The values of a stage, from those that are there; its rates are there in the end.
 *  rates_known: they are there at the start. */
bool MPMDiffusionSolver::solve(double greatest, double fastest, bool rates_known)
{
  residual.assign(size(), 0.0);
  correction.assign(size(), 0.0);
  double left = rates_known ? residual_of_rates() : find_residual(), best = left;
  int worse = 0;
  for (int iteration = 0;; iteration++) {
    const double floor = ROUND_OFF * (1.0 + implicit_dt * fastest) * size_of_values(false);
    double enough = std::max(options.tolerance * (iteration ? size_of_values(true) : left), floor);
    if (!std::isfinite(left)) {
      now.failure = "values are not finite";
      return false;
    }
    if (left <= enough) return true;
    if (iteration == MOST_NEWTON || worse > 3) {
      now.failure = "Newton's method does not converge";
      return false;
    }
    const bool symmetric = equations.linearize();
    const bool made = !prepared;
    if (made) prepare(greatest);
    prepared = true;
    if (iteration == 0) enough = std::max(options.tolerance * expected_change(), floor);
    SolveGoal goal;
    goal.relative = 0.0;
    goal.absolute = 0.5 * enough;
    goal.most_iterations = MOST_LINEAR;
    std::fill(correction.begin(), correction.end(), 0.0);
    const auto solved = symmetric ? conjugate.solve(*this, residual.data(), correction.data(), goal)
                                  : general.solve(*this, residual.data(), correction.data(), goal);
    now.linear += solved.iterations;
    now.newton++;
    if (!made && (!solved.converged() || solved.iterations > DO_WELL)) prepared = false;
    if (!solved.converged() && solved.outcome != SolveReport::TOO_MANY &&
        solved.residuals.back() > 0.5 * solved.residuals.front()) {
      now.failure = "the linear system " + solved.describe();
      return false;
    }
    for (auto &part : parts)
      for (std::size_t i = 0; i < part.capacity.size(); i++)
        part.at[i] += correction[part.first + i];
    left = find_residual();
    worse = left < 0.5 * best ? 0 : worse + 1;
    best = std::min(best, left);
  }
}

const MPMDiffusionSolver::Report &MPMDiffusionSolver::advance(double dt, double greatest,
                                                              double fastest)
{
  static const double G = 1.0 - std::sqrt(0.5);
  now = Report();
  prepared = false;
  int64_t first = 0;
  for (auto &part : parts) {
    part.capacity = part.scalar.capacity;
    part.field.nodes.complete(part.capacity.data(), 1, 1);
    part.field.nodes.complete(part.scalar.value.data(), 1, 1);
    part.at = part.base = part.scalar.value;
    part.first = first;
    first += (int64_t) part.capacity.size();
  }
  for (auto &list : integrals) {
    list.before = list.value;
    list.sum.assign(list.value.size(), 0.0);
  }
  const bool euler = options.time == MPMDiffusionOptions::EULER;
  for (int stage = 0; stage < (euler ? 1 : 2) && now.converged; stage++) {
    const double weight = (euler ? 1.0 : (stage ? G : 1.0 - G)) * dt;
    implicit_dt = (euler ? 1.0 : G) * dt;
    now.converged = solve(greatest, fastest, stage > 0);
    for (auto &part : parts)
      for (std::size_t i = 0; i < part.capacity.size(); i++)
        part.base[i] += weight * part.scalar.rate[i];
    for (auto &list : integrals)
      for (std::size_t i = 0; i < list.sum.size(); i++) list.sum[i] += weight * list.rate[i];
  }
  for (auto &part : parts) part.scalar.value = part.base;
  for (auto &list : integrals)
    for (std::size_t i = 0; i < list.sum.size(); i++) list.value[i] = list.before[i] + list.sum[i];
  return now;
}

double MPMDiffusionSolver::memory_usage() const
{
  double bytes = conjugate.memory_usage() + general.memory_usage() +
      (residual.capacity() + correction.capacity() + preconditioned.capacity()) * sizeof(double);
  for (const auto &part : parts) {
    for (const auto *list : {&part.capacity, &part.base, &part.at, &part.diagonal})
      bytes += list->capacity() * sizeof(double);
    if (part.levels) bytes += part.levels->memory_usage();
  }
  return bytes;
}

static constexpr double BELOW_LIMIT = 0.98;

void MPMSuperStep::add(std::vector<double> &value, const std::vector<double> &rate)
{
  lists.push_back({value, rate, {}, {}, {}});
}

/** Of s stages, in explicit limits. */
static double length(int s)
{
  return s < 3 ? 1.0 : (s * s + s - 2.0) / 4.0;
}

double MPMSuperStep::explicit_limit(double greatest)
{
  return greatest > 0.0 ? BELOW_LIMIT * 2.0 / greatest : std::numeric_limits<double>::max();
}

double MPMSuperStep::reach(int most_stages)
{
  return length(most_stages - (most_stages + 1) % 2);    // numbers of stages are odd
}

int MPMSuperStep::count(double dt, double limit, int most_stages)
{
  if (dt <= limit) return 1;
  for (int s = 3; s <= most_stages; s += 2)
    if (dt <= limit * length(s)) return s;
  return most_stages + 1;
}

void MPMSuperStep::advance(int n, double dt, const std::function<void()> &find_rates,
                           bool rates_known)
{
  if (!rates_known) find_rates();
  if (n == 1) {
    for (auto &list : lists)
      for (std::size_t k = 0; k < list.y.size(); k++) list.y[k] += dt * list.rate[k];
    return;
  }
  const auto b = [](int j) {
    return j < 2 ? 1.0 / 3.0 : (j * j + j - 2.0) / (2.0 * j * (j + 1.0));
  };
  const double w = 4.0 / (n * n + n - 2.0);
  for (auto &list : lists) {
    list.first = list.last = list.y;
    list.first_rate = list.rate;
    for (std::size_t k = 0; k < list.y.size(); k++) list.y[k] += b(1) * w * dt * list.rate[k];
  }
  for (int j = 2; j <= n; j++) {
    find_rates();
    const double mu = (2.0 * j - 1.0) / j * b(j) / b(j - 1), nu = -(j - 1.0) / j * b(j) / b(j - 2);
    const double more = mu * w * dt, less = -(1.0 - b(j - 1)) * more;
    for (auto &list : lists)
      for (std::size_t k = 0; k < list.y.size(); k++) {
        const double now = list.y[k];
        list.y[k] = mu * now + nu * list.last[k] + (1.0 - mu - nu) * list.first[k] +
            more * list.rate[k] + less * list.first_rate[k];
        list.last[k] = now;
      }
  }
}

void MPMSuperStep::advance_in_parts(double dt, double limit,
                                    const std::function<void()> &find_rates)
{
  double part = dt, left = dt;
  while (part > limit) part *= 0.5;
  for (bool first = true; left > 0.5 * part; first = false) {
    advance(count(part, limit, std::numeric_limits<int>::max()), part, find_rates, first);
    left -= part;
    if (!first) part *= 2.0;
  }
}

double MPMSuperStep::memory_usage() const
{
  double bytes = 0.0;
  for (const auto &list : lists)
    for (const auto *values : {&list.first, &list.first_rate, &list.last})
      bytes += values->capacity() * sizeof(double);
  return bytes;
}
