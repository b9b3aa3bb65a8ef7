/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/quasi_newton.h"

#include <algorithm>
#include <cmath>

using namespace MPM_NS;

static constexpr double CURVED = 1.0e-10;    // s . y over the lengths of both, least

void QuasiNewton::start(std::size_t entries)
{
  n = entries;
  // kernels take four entries at a time
  padded = (n + 3) / 4 * 4;
  order.clear();
  last_motion.clear();
}

/** Products of the pairs with f and z, and a new pair. */
void QuasiNewton::look(const double *f, const double *z)
{
  of_f.assign(padded, 0.0);
  of_z.assign(padded, 0.0);
  std::copy_n(f, n, of_f.begin());
  std::copy_n(z, n, of_z.begin());
  std::fill_n(s_f, MOST, 0.0);
  std::fill_n(y_z, MOST, 0.0);
  const int used = (pairs() + B - 1) / B;
  for (int b = 0; b < used; b++) {
    kernels.of_doubles.subtract_from_rows(s_f + B * b, S[b].data(), of_f.data(), (int64_t) padded);
    kernels.of_doubles.subtract_from_rows(y_z + B * b, Y[b].data(), of_z.data(), (int64_t) padded);
  }
  for (int k = 0; k < MOST; k++) {
    s_f[k] = -s_f[k];
    y_z[k] = -y_z[k];
  }
  if (has_moved()) learn();
}

void QuasiNewton::learn()
{
  // of the new pair with itself and with these vectors
  double sy = 0.0, ss = 0.0, yy = 0.0, yz = 0.0, with_f = 0.0, with_z = 0.0;
  for (std::size_t k = 0; k < n; k++) {
    const double s = last_motion[k], y = last_f[k] - of_f[k];
    sy += s * y;
    ss += s * s;
    yy += y * y;
    yz += y * (last_z[k] - of_z[k]);
    with_f += s * of_f[k];
    with_z += y * of_z[k];
  }
  if (sy > CURVED * std::sqrt(ss * yy)) {
    int at = pairs();
    if (at == MOST) {
      at = order.front();
      order.erase(order.begin());
    }
    for (const int other : order) {
      SY[other][at] = last_s_f[other] - s_f[other];
      YZ[other][at] = YZ[at][other] = last_y_z[other] - y_z[other];
    }
    SY[at][at] = sy;
    YZ[at][at] = yz;
    s_f[at] = with_f;
    y_z[at] = with_z;
    const int b = at / B;
    if (at % B == 0 && S[b].size() < padded * B)
      for (auto *list : {&S[b], &Y[b], &Z[b]}) list->assign(padded * B, 0.0);
    double *const s = S[b].data() + at % B, *const y = Y[b].data() + at % B,
                  *const z = Z[b].data() + at % B;
    for (std::size_t k = 0; k < n; k++) {
      s[B * k] = last_motion[k];
      y[B * k] = last_f[k] - of_f[k];
      z[B * k] = last_z[k] - of_z[k];
    }
    order.push_back(at);
  }
  last_motion.clear();
}

void QuasiNewton::correct(const double *f, const double *z, double *d)
{
  look(f, z);
  const int m = pairs();
  double t[MOST], a[MOST], of_S[MOST] = {0.0}, of_Z[MOST] = {0.0};
  for (int i = m - 1; i >= 0; i--) {    // R t = S^T f
    const int at = order[i];
    t[i] = s_f[at];
    for (int j = i + 1; j < m; j++) t[i] -= SY[at][order[j]] * t[j];
    t[i] /= SY[at][at];
  }
  for (int i = 0; i < m; i++) {    // R^T a = (D + Y^T H0 Y) t - Y^T z
    const int at = order[i];
    a[i] = SY[at][at] * t[i] - y_z[at];
    for (int j = 0; j < m; j++) a[i] += YZ[at][order[j]] * t[j];
    for (int j = 0; j < i; j++) a[i] -= SY[order[j]][at] * a[j];
    a[i] /= SY[at][at];
    of_S[at] = -a[i];
    of_Z[at] = t[i];
  }
  sum = of_z;
  for (int b = 0; B * b < m; b++) {
    kernels.of_doubles.subtract_from_columns(sum.data(), S[b].data(), of_S + B * b,
                                             (int64_t) padded);
    kernels.of_doubles.subtract_from_columns(sum.data(), Z[b].data(), of_Z + B * b,
                                             (int64_t) padded);
  }
  std::copy_n(sum.begin(), n, d);
  last_f.swap(of_f);
  last_z.swap(of_z);
  std::copy_n(s_f, MOST, last_s_f);
  std::copy_n(y_z, MOST, last_y_z);
}

double QuasiNewton::memory_usage() const
{
  double bytes = bytes_of(last_motion, last_f, last_z, of_f, of_z, sum);
  for (int b = 0; b < BLOCKS; b++) bytes += bytes_of(S[b], Y[b], Z[b]);
  return bytes;
}
