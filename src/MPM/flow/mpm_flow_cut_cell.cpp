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
// of the range of depths in which that of a surface is found
static constexpr int HALVINGS = 20;

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

/** Calls f(weight, place[dim]) for places in a hat function, which add up to one. */
template <class F> static void visit_hat(int dim, const F &f)
{
  const double step = 2.0 / PLACES;
  for (int a = 0; a < PLACES; a++)
    for (int b = 0; b < PLACES; b++)
      for (int c = 0; c < (dim == 3 ? PLACES : 1); c++) {
        const int k[3] = {a, b, c};
        double weight = 1.0, place[3];
        for (int d = 0; d < dim; d++) {
          place[d] = (k[d] + 0.5) * step - 1.0;
          weight *= (1.0 - std::fabs(place[d])) * step;
        }
        f(weight, place);
      }
}

/** Share of the part of a hat function around a place in which a linear function is positive, with
 *  this value there. width: by how much it differs in that part. */
static double positive_at(double value, double width)
{
  return width > 0.0 ? std::max(0.0, std::min(0.5 + value / width, 1.0)) : value > 0.0;
}

static double width_of(int dim, const double *slope)
{
  double width = 0.0;
  for (int d = 0; d < dim; d++) width += std::fabs(slope[d]) * 2.0 / PLACES;
  return width;
}

static double at(int dim, const double *slope, const double *place)
{
  double sum = 0.0;
  for (int d = 0; d < dim; d++) sum += slope[d] * place[d];
  return sum;
}

double MPMFlowCutCell::positive_in_hat(int dim, double middle, const double *slope)
{
  double sum = 0.0;
  const double width = width_of(dim, slope);
  visit_hat(dim, [&](double weight, const double *place) {
    sum += weight * positive_at(middle + at(dim, slope, place), width);
  });
  return sum;
}

double MPMFlowCutCell::share_without_wall(int dim, double middle, const double *slope,
                                          const double *down, double share)
{
  constexpr int MOST = PLACES * PLACES * PLACES;
  double open[MOST], below[MOST], all = 0.0;
  const double width = width_of(dim, slope), width_of_surface = width_of(dim, down);
  int n = 0;
  visit_hat(dim, [&](double weight, const double *place) {
    const double here = weight * positive_at(middle + at(dim, slope, place), width);
    if (here == 0.0) return;
    open[n] = here;
    below[n++] = at(dim, down, place);
    all += here;
  });
  double low = -std::sqrt((double) dim), high = -low;
  for (int k = 0; k < HALVINGS; k++) {
    const double depth = 0.5 * (low + high);
    double sum = 0.0;
    for (int i = 0; i < n; i++) sum += open[i] * positive_at(depth + below[i], width_of_surface);
    (sum < share * all ? low : high) = depth;
  }
  return positive_in_hat(dim, 0.5 * (low + high), down);
}
