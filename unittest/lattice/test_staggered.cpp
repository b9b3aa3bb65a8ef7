// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Velocities on a staggered lattice as functions of the place: linear fields, and divergence.

#include "lattice/staggered.h"

#include "gtest/gtest.h"

#include <cmath>
#include <functional>

using namespace MPM_NS;

/** Interpolated velocity at t of coefficients u(c, index), in spacings. */
template <int dim>
static void velocity(const double *t, const std::function<double(int c, const int *index)> &u,
                     double *v)
{
  StaggeredWeights w;
  w.find<dim>(t);
  for (int c = 0; c < dim; c++) v[c] = 0.0;
  int k[3] = {0, 0, 0};
  for (k[0] = 0; k[0] < 3; k[0]++)
    for (k[1] = 0; k[1] < 3; k[1]++)
      for (k[2] = 0; k[2] < (dim == 3 ? 3 : 1); k[2]++) {
        const int index[3] = {w.base[0] + k[0], w.base[1] + k[1], dim == 3 ? w.base[2] + k[2] : 0};
        for (int c = 0; c < dim; c++) v[c] += w.face<dim>(c, k) * u(c, index);
      }
}

/** Some number that depends on the arguments. */
static double noise(int a, const int *index)
{
  const double s = std::sin(12.9898 * a + 78.233 * index[0] + 37.719 * index[1] + 9.1 * index[2]);
  return 1000.0 * s - std::floor(1000.0 * s);
}

template <int dim> static void linear_fields_are_exact()
{
  const double g[3][4] = {{0.3, -0.2, 0.5, 1.0}, {0.7, 0.4, -0.6, 2.0}, {-0.1, 0.9, 0.2, 3.0}};
  const auto u = [&](int c, const int *index) {
    double value = g[c][3];
    for (int d = 0; d < dim; d++) value += g[c][d] * (index[d] + (d == c ? 0.0 : 0.5));
    return value;
  };
  for (int n = 0; n < 200; n++) {
    double t[3], v[3];
    for (int d = 0; d < dim; d++) t[d] = std::fmod(0.37 * n * (d + 1.3), 5.0) - 2.0;
    velocity<dim>(t, u, v);
    for (int c = 0; c < dim; c++) {
      double exact = g[c][3];
      for (int d = 0; d < dim; d++) exact += g[c][d] * t[d];
      EXPECT_NEAR(v[c], exact, 1e-13);
    }
  }
}

/** Divergence of the velocity, by differences that are exact for quadratic functions. */
template <int dim>
static double divergence(const double *t, const std::function<double(int, const int *)> &u)
{
  constexpr double step = 1e-3;
  double sum = 0.0;
  for (int d = 0; d < dim; d++) {
    double low[3] = {t[0], t[1], t[2]}, high[3] = {t[0], t[1], t[2]}, v[3], w[3];
    low[d] -= step;
    high[d] += step;
    velocity<dim>(low, u, v);
    velocity<dim>(high, u, w);
    sum += (w[d] - v[d]) / (2.0 * step);
  }
  return sum;
}

TEST(Staggered, LinearFieldsAreExact)
{
  linear_fields_are_exact<2>();
  linear_fields_are_exact<3>();
}

// faces whose balance is zero in all cells: differences of a stream function at the edges
TEST(Staggered, NoDivergenceAnywhere)
{
  const auto plane = [](int c, const int *i) {
    const int up[3] = {i[0] + (c == 1), i[1] + (c == 0), 0};
    return (c == 0 ? 1.0 : -1.0) * (noise(0, up) - noise(0, i));
  };
  const auto space = [](int c, const int *i) {    // the curl of a potential
    const int a = (c + 1) % 3, b = (c + 2) % 3;
    int up_a[3] = {i[0], i[1], i[2]}, up_b[3] = {i[0], i[1], i[2]};
    up_a[a]++;
    up_b[b]++;
    return noise(b, up_a) - noise(b, i) - noise(a, up_b) + noise(a, i);
  };
  for (int n = 0; n < 200; n++) {
    double t[3];
    for (int d = 0; d < 3; d++) {
      t[d] = std::fmod(0.417 * n * (d + 1.7), 4.0) - 2.0;
      // the differences must not cross where functions change
      const double f = 2.0 * t[d] - std::floor(2.0 * t[d]);
      if (f < 0.01 || f > 0.99) t[d] += 0.1;
    }
    EXPECT_NEAR((divergence<2>(t, plane)), 0.0, 1e-11);
    EXPECT_NEAR((divergence<3>(t, space)), 0.0, 1e-11);
  }
}
