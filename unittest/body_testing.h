// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_BODY_TESTING_H
#define MPM_BODY_TESTING_H

// Volume, center, and moments of inertia of bodies that consist of points.

#include "mpm_lammps.h"

#include "math_eigen.h"

namespace MPM_TEST {

/** Sums over the initial volumes of all points: their volume, their center, and their second
 *  moments about the center. least: smallest volume of a point. */
struct Sum {
  double volume = 0.0, center[3] = {0.0, 0.0, 0.0}, second[3][3] = {{0.0}}, least = 1.0e300;
  int points = 0;

  explicit Sum(Scene &scene)
  {
    auto *atom = scene.lmp->atom;
    for (int pass = 0; pass < 2; pass++) {
      double mine[10] = {0.0}, all[10];
      for (int i = 0; i < atom->nlocal; i++) {
        const double v = atom->vfrac[i];
        least = std::min(least, v);
        mine[0] += v;
        for (int d = 0; d < 3; d++) {
          mine[1 + d] += v * atom->x[i][d];
          for (int e = d; e < 3; e++)
            mine[4 + d + e + (d > 0)] +=
                v * (atom->x[i][d] - center[d]) * (atom->x[i][e] - center[e]);
        }
      }
      MPI_Allreduce(mine, all, 10, MPI_DOUBLE, MPI_SUM, scene.lmp->world);
      volume = all[0];
      if (pass == 0)
        for (int d = 0; d < 3; d++) center[d] = all[1 + d] / volume;
      for (int d = 0; d < 3; d++)
        for (int e = d; e < 3; e++) second[d][e] = second[e][d] = all[4 + d + e + (d > 0)];
    }
    MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_DOUBLE, MPI_MIN, scene.lmp->world);
    points = (int) scene.lmp->atom->natoms;
  }

  /** Principal moments of inertia for unit density, if each point is a cube with this edge
   *  length. */
  std::array<double, 3> moments(double size) const
  {
    double I[3][3], values[3], vectors[3][3];
    const double trace = second[0][0] + second[1][1] + second[2][2];
    for (int d = 0; d < 3; d++)
      for (int e = 0; e < 3; e++)
        I[d][e] = (d == e ? trace + volume * size * size / 6.0 : 0.0) - second[d][e];
    MathEigen::jacobi3(I, values, vectors, 1);
    return {values[0], values[1], values[2]};
  }
};

inline const std::string box_of_3d = space("lj", "f f f", "-4 4 -4 4 -4 4");
inline const std::string box_of_2d = plane("lj", "f f", "-4 4 -4 4");

}    // namespace MPM_TEST
#endif
