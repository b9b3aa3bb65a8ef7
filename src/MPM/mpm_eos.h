/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_EOS_H
#define LMP_MPM_EOS_H

#include "mpm_law_kinematics.h"

namespace MPM_NS::law {
namespace {

  MPM_INLINE void subtract_pressure(Batch &b, int i, double p)
  {
    b.stress[0][i] -= p;
    b.stress[1][i] -= p;
    b.stress[2][i] -= p;
  }

  /** Loops of an equation of state p(J) without energy.
   *
   *  Eos has, with the volume ratio J = density_0 / density: pressure(J), bulk(J) = -J^2 dp/dJ (the
   *  reference density times the square of the sound speed), stored(J) = -integral of p dJ from 1.
   */
  template <class Eos> struct Barotropic : LawDefaults {
    static void update(const LawParameters &p, Batch &b, History)
    {
      const Eos eos(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) subtract_pressure(b, i, eos.pressure(b.J[i]));
    }

    static void modulus(const LawParameters &p, const Batch &b, History, double *k)
    {
      const Eos eos(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) k[i] += eos.bulk(b.J[i]);
    }

    static void energy(const LawParameters &p, const Batch &b, History, double *w)
    {
      const Eos eos(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) w[i] += eos.stored(b.J[i]);
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
