/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   A cell of a periodic body, in the total frame. With the mean deformation gradient Fm, and the
   velocity v of points and nodes without the mean motion,

     F <- F + dt (dv/dX + dFm/dt),   f_i = -sum V0 P dN_i/dX

   Periodic v do no work against the mean stress, so that (R. Hill, J. Mech. Phys. Solids 11 (1963)
   357)

     <P> : dFm/dt = <P : dF/dt>,   <.> = sum over points, with V0, over the volume of the cell

   up to the inertia of v, and the work of the mean motion is that of the mean stress <P>. Empty
   places have no stress. The inertia of the mean motion itself, which in a cell of a large body is
   that of the whole body, is left out.

   A component with a stress s* moves like a mass of the inertia rho L^2 for each volume, with the
   mean density rho and the longest edge L of the cell,

     rho L^2 de/dt = s* - s

   so that it swings 2 pi times slower than the slowest wave in the cell, whatever its stiffness is.
   Whenever it passes s*, it goes on with the mean speed since it has done so before: a swing about
   a stress at rest ends at once, one about a stress or another strain that goes on keeps up with
   it. As with kinetic damping (fix mpm/relax), no coefficient has to be chosen.
------------------------------------------------------------------------- */

#include "implicit/mpm_mean_deformation.h"

#include "math/matrix.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

MPMMeanDeformation::MPMMeanDeformation()
{
  std::copy_n(past.F, 9, next);
  std::fill_n(rate, 9, 0.0);
}

double MPMMeanDeformation::stress(int part) const
{
  return past.tau[part] / determinant(past.F);
}

int MPMMeanDeformation::advance(double dt, const Drive *drive, const double *wanted, double inertia)
{
  std::copy_n(past.F, 9, next);
  for (int k = 0; k < NPART; k++) {
    double &F = next[3 * ROW[k] + COLUMN[k]], &speed = past.speed[k];
    const double unit = k > 2 ? 0.0 : 1.0;
    switch (drive[k]) {
      case HELD:
        break;
      case ERATE:
        F += dt * wanted[k];
        break;
      case TRATE:
        F *= std::exp(dt * wanted[k]);
        break;
      case STRAIN:
        F = unit + wanted[k];
        break;
      case STRESS: {
        const double lack = wanted[k] - stress(k);
        if (lack * past.lack[k] < 0.0) {
          speed = past.way[k] / past.time[k];
          past.way[k] = past.time[k] = 0.0;
        }
        past.lack[k] = lack;
        speed += dt * lack / inertia;
        past.way[k] += dt * speed;
        past.time[k] += dt;
        F += dt * speed * past.F[4 * COLUMN[k]];
        break;
      }
    }
    if (k < 3 && !(F > 0.0)) return k;
  }
  for (int c = 0; c < 9; c++) rate[c] = (next[c] - past.F[c]) / dt;
  return -1;
}

double MPMMeanDeformation::end_step(const double *tau, const double *P)
{
  double work = 0.0;
  for (int c = 0; c < 9; c++) work += 0.5 * (past.P[c] + P[c]) * (next[c] - past.F[c]);
  std::copy_n(tau, 6, past.tau);
  std::copy_n(P, 9, past.P);
  std::copy_n(next, 9, past.F);
  return work;
}

void MPMMeanDeformation::forget_speeds(const Drive *drive)
{
  for (int k = 0; k < NPART; k++)
    if (drive[k] != STRESS) past.speed[k] = past.lack[k] = past.way[k] = past.time[k] = 0.0;
}
