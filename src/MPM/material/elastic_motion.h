/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_ELASTIC_MOTION_H
#define MPM_MATERIAL_ELASTIC_MOTION_H

#include "material/material.h"

#include <cstring>

namespace MPM_NS {

/** Thermal expansion of the points of a batch, given by the stretch theta = exp[ALPHA (T - T0)]. */
struct ThermalStretch {
  double before[BATCH], now[BATCH];    ///< 1/theta at the start and the end of a step
  double change[BATCH];                ///< change of ln theta in the step

  /** theta^3 at the end of the step. */
  double volume(int i) const { return 1.0 / (now[i] * now[i] * now[i]); }
};

/** Removes the thermal stretch from the motion of a batch while this object exists. The laws then
 *  see F_e = F/theta, J_e = J/theta^3, the increment A_e of the same step with I + A_e = (I + A)
 *  theta_old/theta, and, as initial volume, the stress-free volume V_0 theta^3 of a point (V.A.
 *  Lubarda, Appl. Mech. Rev. 57 (2004) 95: F = F_e F_theta, with a stress that is a function of
 *  F_e). Their energies are then per volume of the expanded material.
 */
class ElasticMotion {
 public:
  /** with_F: a law uses F, so that F is changed, too. */
  ElasticMotion(Batch &batch, const ThermalStretch &s, bool with_F) : b(batch), with_F(with_F)
  {
    memcpy(A, b.A, sizeof(A));
    if (with_F) memcpy(F, b.F, sizeof(F));
    memcpy(J, b.J, sizeof(J));
    memcpy(Jold, b.Jold, sizeof(Jold));
    memcpy(vol0, b.vol0, sizeof(vol0));
    double ratio[BATCH];
    for (int i = 0; i < b.n; i++) {
      const double now = s.now[i], before = s.before[i];
      ratio[i] = now / before;
      b.J[i] = now * now * now * J[i];
      b.Jold[i] = before * before * before * Jold[i];
      b.vol0[i] = s.volume(i) * vol0[i];
    }
    for (int k = 0; k < 9; k++) {
      const double diagonal = k % 4 == 0 ? 1.0 : 0.0;
      for (int i = 0; i < b.n; i++) b.A[k][i] = ratio[i] * A[k][i] + diagonal * (ratio[i] - 1.0);
      for (int i = 0; with_F && i < b.n; i++) b.F[k][i] = s.now[i] * F[k][i];
    }
  }

  /** Restores the motion of the batch bit for bit. */
  ~ElasticMotion()
  {
    memcpy(b.A, A, sizeof(A));
    if (with_F) memcpy(b.F, F, sizeof(F));
    memcpy(b.J, J, sizeof(J));
    memcpy(b.Jold, Jold, sizeof(Jold));
    memcpy(b.vol0, vol0, sizeof(vol0));
  }
  ElasticMotion(const ElasticMotion &) = delete;
  ElasticMotion &operator=(const ElasticMotion &) = delete;

 private:
  Batch &b;
  const bool with_F;
  double A[9][BATCH], F[9][BATCH], J[BATCH], Jold[BATCH], vol0[BATCH];
};

}    // namespace MPM_NS
#endif
