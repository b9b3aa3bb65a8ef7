/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_cut_cell.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

// places along an axis at which the open share of surroundings is found
static constexpr int PLACES = 8;

double MPMFlowCutCell::positive(double a, double b)
{
  if (a <= 0.0 && b <= 0.0) return 0.0;
  if (a >= 0.0 && b >= 0.0) return 1.0;
  return std::max(a, b) / std::fabs(a - b);
}

double MPMFlowCutCell::positive(double a, double b, double c)
{
  if (a <= 0.0 && b <= 0.0 && c <= 0.0) return 0.0;
  if (a >= 0.0 && b >= 0.0 && c >= 0.0) return 1.0;
  const int n = (a > 0.0) + (b > 0.0) + (c > 0.0);
  const double sign = n == 1 ? 1.0 : -1.0;    // makes the corner that is alone on its side positive
  a *= sign;
  b *= sign;
  c *= sign;
  double share;
  if (a > 0.0)
    share = a * a / ((a - b) * (a - c));
  else if (b > 0.0)
    share = b * b / ((b - a) * (b - c));
  else
    share = c * c / ((c - a) * (c - b));
  return n == 1 ? share : 1.0 - share;
}

double MPMFlowCutCell::positive(double a, double b, double c, double d)
{
  return 0.25 * (positive(a, b, c) + positive(a, c, d) + positive(a, b, d) + positive(b, c, d));
}

void MPMFlowCutCell::add_positive(double a, double b, double *sum)
{
  const double length = positive(a, b);
  sum[0] += length;
  sum[1] += 0.5 * length * (1.0 - length) * (a > b ? -1.0 : 1.0);
}

/** Adds to sum[3] the area and its moments, times weight, of the part of a triangle in which a
 *  linear function with the values f at the corners is positive. */
static void add_triangle(const double f[3], const double corner[3][2], double weight, double *sum)
{
  double x[4][2];    // corners of the positive part, a triangle or a square
  int n = 0;
  for (int k = 0; k < 3; k++) {
    const int next = (k + 1) % 3;
    if (f[k] > 0.0) std::copy_n(corner[k], 2, x[n++]);
    if ((f[k] > 0.0) == (f[next] > 0.0)) continue;
    const double part = f[k] / (f[k] - f[next]);
    for (int e = 0; e < 2; e++) x[n][e] = corner[k][e] + part * (corner[next][e] - corner[k][e]);
    n++;
  }
  for (int k = 2; k < n; k++) {
    const double area = 0.5 * weight *
        std::fabs((x[k - 1][0] - x[0][0]) * (x[k][1] - x[0][1]) -
                  (x[k - 1][1] - x[0][1]) * (x[k][0] - x[0][0]));
    sum[0] += area;
    for (int e = 0; e < 2; e++) sum[1 + e] += area * (x[0][e] + x[k - 1][e] + x[k][e]) / 3.0;
  }
}

void MPMFlowCutCell::add_positive(double a, double b, double c, double d, double *sum)
{
  const double f[4] = {a, b, c, d};
  constexpr double x[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
  for (int left_out = 0; left_out < 4; left_out++) {
    double at[3], corner[3][2];
    for (int k = 0; k < 3; k++) {
      const int from = k < left_out ? k : k + 1;
      at[k] = f[from];
      std::copy_n(x[from], 2, corner[k]);
    }
    add_triangle(at, corner, 0.5, sum);
  }
}

double MPMFlowCutCell::positive_in_hat(int dim, double middle, const double *slope)
{
  double sum = 0.0;
  const double step = 2.0 / PLACES;
  double width = 0.0;
  for (int d = 0; d < dim; d++) width += std::fabs(slope[d]) * step;
  for (int a = 0; a < PLACES; a++)
    for (int b = 0; b < PLACES; b++)
      for (int c = 0; c < (dim == 3 ? PLACES : 1); c++) {
        const int k[3] = {a, b, c};
        double weight = 1.0, at = middle;
        for (int d = 0; d < dim; d++) {
          const double t = (k[d] + 0.5) * step - 1.0;
          weight *= (1.0 - std::fabs(t)) * step;
          at += slope[d] * t;
        }
        sum += weight * (width > 0.0 ? std::max(0.0, std::min(0.5 + at / width, 1.0)) : at > 0.0);
      }
  return sum;
}
