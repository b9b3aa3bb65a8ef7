/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "contact/mpm_rigid_body.h"

#include "math_extra.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;

void MPMRigidBody::inertia(double out[3][3]) const
{
  double half[3][3];
  MathExtra::times3(Q, body_inertia, half);
  MathExtra::times3_transpose(half, Q, out);
}

void MPMRigidBody::spin()
{
  double I[3][3], inverse[3][3], moment[3];
  inertia(I);
  for (int d = 0; d < 3; d++) {
    moment[d] = fixed[3 + d] ? 0.0 : L[d];
    if (!fixed[3 + d]) continue;
    for (int e = 0; e < 3; e++) I[d][e] = I[e][d] = 0.0;
    I[d][d] = 1.0;
  }
  MathExtra::invert3(I, inverse);
  MathExtra::matvec(inverse, moment, omega);
}

void MPMRigidBody::hold()
{
  for (int d = 0; d < 3; d++) {
    if (fixed[d]) v[d] = 0.0;
    if (fixed[3 + d]) L[d] = 0.0;
  }
}

void MPMRigidBody::push(const double *J)
{
  for (int d = 0; d < 3; d++) {
    if (!fixed[d]) v[d] += J[d] / mass;
    if (!fixed[3 + d]) L[d] += J[3 + d];
  }
}

static void rotate(const double *angle, const double from[3][3], double to[3][3])
{
  const double size = MathExtra::len3(angle);
  double R[3][3];
  const double s = size > 1.0e-8 ? sin(size) / size : 1.0;
  const double c = size > 1.0e-8 ? (1.0 - cos(size)) / (size * size) : 0.5;
  const double K[3][3] = {
      {0.0, -angle[2], angle[1]}, {angle[2], 0.0, -angle[0]}, {-angle[1], angle[0], 0.0}};
  double KK[3][3];
  MathExtra::times3(K, K, KK);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) R[i][j] = (i == j) + s * K[i][j] + c * KK[i][j];
  MathExtra::times3(R, from, to);
}

void MPMRigidBody::move(double dt)
{
  double start[3][3], angle[3];
  memcpy(start, Q, sizeof(Q));
  for (const double share : {0.5, 0.5, 0.5, 1.0}) {    // three rounds find the middle of the step
    spin();
    MathExtra::scale3(share * dt, omega, angle);
    rotate(angle, start, Q);
  }
  spin();
  for (int d = 0; d < 3; d++) x[d] += dt * v[d];
}

void MPMRigidBody::shift(const double *by)
{
  double start[3][3];
  memcpy(start, Q, sizeof(Q));
  rotate(by + 3, start, Q);
  MathExtra::add3(x, by, x);
  spin();
}

void MPMRigidBody::find_mobility(double *mobility)
{
  const MPMRigidMotion before = *this;
  std::fill_n(mobility, 36, 0.0);
  for (int d = 0; d < 3; d++) {
    if (!fixed[d]) mobility[7 * d] = 1.0 / mass;
    if (fixed[3 + d]) continue;
    double unit[3] = {0.0, 0.0, 0.0};
    unit[d] = 1.0;
    MathExtra::copy3(unit, L);
    spin();
    for (int e = 0; e < 3; e++) mobility[6 * (3 + e) + 3 + d] = omega[e];
  }
  static_cast<MPMRigidMotion &>(*this) = before;
}
