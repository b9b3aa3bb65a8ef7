/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_conductivity.h"

#include "math_extra.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** The rotation R of F = R U, by R <- (R + R^-T)/2 (N.J. Higham, SIAM J. Sci. Stat. Comput. 7
 *  (1986) 1160). */
static void rotation(const double *F, double R[3][3])
{
  static constexpr int MOST = 30;
  memcpy(R, F, 9 * sizeof(double));
  for (int k = 0; k < MOST; k++) {
    double inverse[3][3], change = 0.0;
    MathExtra::invert3(R, inverse);
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) {
        const double next = 0.5 * (R[a][b] + inverse[b][a]);
        change = std::max(change, fabs(next - R[a][b]));
        inverse[b][a] = next;
      }
    MathExtra::transpose3(inverse, R);
    if (change < 1.0e-14) return;
  }
}

void LAMMPS_NS::principal_conductivities(const Conduction &c, const double *F, double k[3],
                                         double n[3][3])
{
  k[0] = c.conductivity;
  for (int a = 1; a < 3; a++) k[a] = c.orthotropic ? c.across[a - 1] : c.conductivity;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) n[a][b] = a == b;
  if (!c.orthotropic) return;
  double R[3][3];
  rotation(F, R);
  MathExtra::times3_transpose(c.axis, R, n);
}
