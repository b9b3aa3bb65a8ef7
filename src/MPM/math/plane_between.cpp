/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "math/plane_between.h"

#include <Eigen/Dense>

using namespace MPM_NS;

void PlaneBetween::advance(const double *sums, int dim)
{
  constexpr double RIDGE = 1.0e-3;
  Eigen::Matrix4d H;
  Eigen::Vector4d g;
  for (int i = 0, m = 4; i < 4; i++) {
    g(i) = sums[i];
    for (int j = 0; j <= i; j++) H(i, j) = H(j, i) = sums[m++];
  }
  for (int i = 0; i < 3; i++) {
    g(i) += RIDGE * phi[i];
    H(i, i) += i < dim ? RIDGE : 1.0;
  }
  H(3, 3) += 1.0e-10;
  Eigen::Vector4d step = H.ldlt().solve(g);
  const double size = step.norm();    // far from the minimum, Newton's steps can be too long
  if (size > 4.0) step *= 4.0 / size;
  for (int i = 0; i < 4; i++) phi[i] -= step(i);
}
