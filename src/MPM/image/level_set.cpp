/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "image/level_set.h"

#include <algorithm>
#include <cmath>

using namespace MPM_NS;

static constexpr double SMALL_SLOPE = 1.0e-4;    // of the others: the surface is along this axis
static constexpr double REACH = 4.0;             // of the Gaussian, in standard deviations
static constexpr double ROUND_OFF = 1.0e-6;      // in pixels

double MPM_NS::share_above(double value, const double *gradient, int dim)
{
  double sum = 0.0, slope[3];
  for (int d = 0; d < dim; d++) sum += std::fabs(gradient[d]);
  double a = value + 0.5 * sum;    // the corner that is farthest above
  if (a <= 0.0) return 0.0;
  if (a >= sum) return 1.0;
  int n = 0;
  double product = 1.0, rest = 0.0;
  for (int d = 0; d < dim; d++) {
    const double m = std::fabs(gradient[d]);
    if (m > SMALL_SLOPE * sum) {
      slope[n++] = m;
      product *= m * n;    // n! in the end
    } else {
      rest += m;
    }
  }
  a -= 0.5 * rest;
  // sum over the corners: (-1)^k (a - slopes of the corner)^n / (n! product of slopes)
  double share = 0.0;
  for (int corner = 0; corner < 1 << n; corner++) {
    double b = a;
    int sign = 1;
    for (int d = 0; d < n; d++)
      if (corner >> d & 1) {
        b -= slope[d];
        sign = -sign;
      }
    if (b > 0.0) share += sign * std::pow(b, n);
  }
  return std::min(std::max(share / product, 0.0), 1.0);
}

LevelSet::LevelSet(const int64_t *size, int dim, const bool *wrap, double width,
                   const std::function<double(int64_t)> &value) :
    dim(dim)
{
  for (int d = 0; d < 3; d++) {
    n[d] = size[d];
    wraps[d] = wrap[d];
  }
  values.resize(n[0] * n[1] * n[2]);
  for (std::size_t k = 0; k < values.size(); k++) values[k] = value(k);
  if (width > 0.0)
    for (int d = 0; d < dim; d++) smooth(d, width);
}

int64_t LevelSet::index(int d, int64_t i) const
{
  if (wraps[d]) return (i % n[d] + n[d]) % n[d];
  return std::min(std::max(i, (int64_t) 0), n[d] - 1);
}

void LevelSet::smooth(int d, double width)
{
  const int64_t reach = std::ceil(REACH * width);
  std::vector<double> weight(2 * reach + 1);
  double sum = 0.0;
  for (int64_t k = -reach; k <= reach; k++)
    sum += weight[k + reach] = std::exp(-0.5 * (k / width) * (k / width));
  for (double &w : weight) w /= sum;

  const int64_t stride = d == 0 ? 1 : d == 1 ? n[0] : n[0] * n[1];
  const int64_t lines = (int64_t) values.size() / n[d];
  std::vector<double> line(n[d] + 2 * reach);
  for (int64_t l = 0; l < lines; l++) {
    float *first = values.data() + l % stride + l / stride * stride * n[d];
    for (int64_t i = -reach; i < n[d] + reach; i++) line[i + reach] = first[index(d, i) * stride];
    for (int64_t i = 0; i < n[d]; i++) {
      double value = 0.0;
      for (std::size_t k = 0; k < weight.size(); k++) value += weight[k] * line[i + k];
      first[i * stride] = value;
    }
  }
}

double LevelSet::at(const double *x) const
{
  int64_t lower[3] = {0, 0, 0}, upper[3] = {0, 0, 0};
  double f[3] = {0.0, 0.0, 0.0};
  for (int d = 0; d < dim; d++) {
    const double u = x[d] - 0.5, whole = std::floor(u);
    f[d] = u - whole;
    lower[d] = index(d, (int64_t) whole);
    upper[d] = index(d, (int64_t) whole + 1);
  }
  double sum = 0.0;
  for (int corner = 0; corner < 1 << dim; corner++) {
    double w = 1.0;
    int64_t at[3];
    for (int d = 0; d < 3; d++) {
      const bool up = corner >> d & 1;
      at[d] = up ? upper[d] : lower[d];
      if (d < dim) w *= up ? f[d] : 1.0 - f[d];
    }
    if (w != 0.0) sum += w * values[at[0] + n[0] * (at[1] + n[1] * at[2])];
  }
  return sum;
}

bool LevelSet::crosses(const double *lo, const double *hi, bool &inside) const
{
  int64_t first[3] = {0, 0, 0}, last[3] = {0, 0, 0}, k[3];
  for (int d = 0; d < dim; d++) {
    first[d] = (int64_t) std::floor(lo[d] - 0.5);
    last[d] = (int64_t) std::floor(hi[d] - 0.5) + 1;
  }
  bool positive = false, negative = false;
  for (k[2] = first[2]; k[2] <= last[2]; k[2]++)
    for (k[1] = first[1]; k[1] <= last[1]; k[1]++) {
      const int64_t row = n[0] * (index(1, k[1]) + n[1] * index(2, k[2]));
      for (k[0] = first[0]; k[0] <= last[0]; k[0]++) {
        const bool up = values[row + index(0, k[0])] > 0.0f;
        positive = positive || up;
        negative = negative || !up;
        if (positive && negative) return true;
      }
    }
  inside = positive;
  return false;
}

double LevelSet::volume(const double *lo, const double *hi) const
{
  double first[3], last[3], all = 1.0;
  for (int d = 0; d < dim; d++) {
    first[d] = std::max(lo[d], 0.0);
    last[d] = std::min(hi[d], (double) n[d]);
    if (last[d] - first[d] <= ROUND_OFF) return 0.0;
    all *= last[d] - first[d];
  }
  bool inside = false;
  if (!crosses(first, last, inside)) return inside ? all : 0.0;

  double sum = 0.0, low[3] = {0.0, 0.0, 0.0}, high[3] = {1.0, 1.0, 1.0};
  const auto end = [&](int d) {
    return d >= dim ? 1.0 : std::min(last[d], 0.5 * (std::floor(2.0 * low[d] + ROUND_OFF) + 1.0));
  };
  const auto begin = [&](int d) {
    return d >= dim ? 0.0 : first[d];
  };
  const auto go_on = [&](int d) {
    return low[d] < (d >= dim ? 1.0 : last[d] - ROUND_OFF);
  };
  for (low[2] = begin(2); go_on(2); low[2] = high[2]) {
    high[2] = end(2);
    for (low[1] = begin(1); go_on(1); low[1] = high[1]) {
      high[1] = end(1);
      for (low[0] = begin(0); go_on(0); low[0] = high[0]) {
        high[0] = end(0);
        sum += part(low, high);
      }
    }
  }
  return sum;
}

double LevelSet::part(const double *lo, const double *hi) const
{
  double x[3] = {0.0, 0.0, 0.0}, gradient[3], size = 1.0;
  for (int d = 0; d < dim; d++) {
    x[d] = 0.5 * (lo[d] + hi[d]);
    size *= hi[d] - lo[d];
  }
  for (int d = 0; d < dim; d++) {
    const double middle = x[d];
    x[d] = hi[d];
    gradient[d] = at(x);
    x[d] = lo[d];
    gradient[d] -= at(x);
    x[d] = middle;
  }
  return size * share_above(at(x), gradient, dim);
}
