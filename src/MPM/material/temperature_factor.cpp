/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "material/temperature_factor.h"

#include <algorithm>
#include <cmath>

using namespace MPM_NS;

TemperatureFactor::TemperatureFactor(Formula formula, double c, double reference, double low,
                                     double high) :
    T({low, high}),
    formula(formula), c(c), reference(reference)
{
}

double TemperatureFactor::at(double temperature) const
{
  const double t = std::min(std::max(temperature, T.front()), T.back());
  if (factor.empty()) switch (formula) {
      case LINEAR:
        return 1.0 + c * (t - reference);
      case POWER:
        return std::pow(t / reference, c);
      case EXPONENTIAL:
        return std::exp(c * (t - reference));
      case ARRHENIUS:
        return std::exp(c * (1.0 / t - 1.0 / reference));
    }
  if (!(t < T.back())) return factor.back();
  const std::size_t k = std::upper_bound(T.begin(), T.end(), t) - T.begin() - 1;
  return factor[k] + (factor[k + 1] - factor[k]) * ((t - T[k]) / (T[k + 1] - T[k]));
}

std::vector<double> TemperatureFactor::spread(int n) const
{
  if (formula == LINEAR) return T;
  const double low = T.front(), high = T.back();
  std::vector<double> all = {low};
  for (int k = 1; k < n - 1; k++) {
    const double part = static_cast<double>(k) / (n - 1);
    all.push_back(formula == POWER           ? low * std::pow(high / low, part)
                      : formula == ARRHENIUS ? 1.0 / (1.0 / low + part * (1.0 / high - 1.0 / low))
                                             : low + part * (high - low));
  }
  all.push_back(high);
  return all;
}

double TemperatureFactor::mean(double low, double high) const
{
  if (!(high > low)) return at(low);
  if (!is_table()) return (at(low) + 4.0 * at(0.5 * (low + high)) + at(high)) / 6.0;
  double sum = 0.0, t = low, f = at(low);
  const auto add = [&](double next) {
    const double there = at(next);
    sum += 0.5 * (f + there) * (next - t);
    t = next;
    f = there;
  };
  for (const double knot : T)
    if (knot > low && knot < high) add(knot);
  add(high);
  return sum / (high - low);
}
