/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "diffusion/mpm_super_step.h"

#include <limits>

using namespace LAMMPS_NS;

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

void MPMSuperStep::advance(int n, double dt, const std::function<void()> &find_rates)
{
  find_rates();
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

double MPMSuperStep::memory_usage() const
{
  double bytes = 0.0;
  for (const auto &list : lists)
    for (const auto *values : {&list.first, &list.first_rate, &list.last})
      bytes += values->capacity() * sizeof(double);
  return bytes;
}
