/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "math/hull_distance.h"

#include "math/matrix.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

using namespace MPM_NS;

static constexpr double ROUNDING =
    1.0e-15;    // of products, relative to the lengths of the two vectors
static constexpr double ZERO = 1.0e-12;    // of shares

/** A corner is added, then those are left out that the point of least norm in the plane through
 *  all does not need. What is left to gain ends at rounding: with a larger tolerance the
 *  direction would jump while rows of points turn. */
void HullDistance::advance(const double *a, const double *b)
{
  if (done) return;
  const double added[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const double square = dot(x, x);
  bool known = false;
  for (int i = 0; i < n; i++) known = known || std::equal(added, added + 3, corner[i]);
  if (known ||
      (n > 0 && square - dot(x, added) <= ROUNDING * std::sqrt(square * dot(added, added)))) {
    done = true;
    return;
  }
  const bool first = n == 0;
  std::copy_n(added, 3, corner[n]);
  share[n] = n == 0 ? 1.0 : 0.0;
  n++;
  while (n > 1) {
    double s[4];
    nearest(s);
    double step = 1.0;    // from the shares there are to these, until the first is gone
    for (int i = 0; i < n; i++)
      if (s[i] < ZERO && share[i] > s[i]) step = std::min(step, share[i] / (share[i] - s[i]));
    int left = 0;
    for (int i = 0; i < n; i++) {
      const double now = share[i] + step * (s[i] - share[i]);
      if (now <= ZERO && step < 1.0) continue;
      std::copy_n(corner[i], 3, corner[left]);
      share[left++] = now;
    }
    const bool all = left == n;
    n = left;
    if (step == 1.0 || all) break;
  }
  if (n == 1) share[0] = 1.0;
  double now[3] = {0.0, 0.0, 0.0};
  for (int d = 0; d < 3; d++)
    for (int i = 0; i < n; i++) now[d] += share[i] * corner[i][d];
  done = !first && dot(now, now) >= square;    // by rounding
  if (done) return;
  std::copy_n(now, 3, x);

  // three corners in the plane, or four in space, that have the origin between them: the hulls
  // overlap

  double largest = 0.0;
  for (int i = 0; i < n; i++) largest = std::max(largest, dot(corner[i], corner[i]));
  if (dot(x, x) > 1.0e-16 * largest) {
    done = n == 4;    // in one plane, by rounding
    return;
  }
  std::fill_n(x, 3, 0.0);
  done = true;
}

/** Shares of the corners in the point of least norm of the line, plane, or space through them. */
void HullDistance::nearest(double *s) const
{
  Eigen::MatrixXd edges(3, n - 1);
  const Eigen::Vector3d first(corner[0][0], corner[0][1], corner[0][2]);
  for (int i = 1; i < n; i++)
    for (int d = 0; d < 3; d++) edges(d, i - 1) = corner[i][d] - corner[0][d];
  const Eigen::VectorXd others = edges.colPivHouseholderQr().solve(-first);
  s[0] = 1.0 - others.sum();
  for (int i = 1; i < n; i++) s[i] = others(i - 1);
}
