/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_OGDEN_H
#define MPM_LAW_OGDEN_H

#include "law/hyperelastic.h"

namespace MPM_NS::law {
namespace {

  /** Rubber after R.W. Ogden, Proc. R. Soc. London A 326 (1972) 565 and 328 (1972) 567, with change
   *  of volume uncoupled from change of shape; stretches l_a = J^(-1/3) * principal stretches:
   *
   *    w = sum_p MU_p/ALPHA_p (l_1^ALPHA_p + l_2^ALPHA_p + l_3^ALPHA_p - 3)
   *          + K/4 (J^2 - 1 - 2 ln J)
   *    J sigma_a = sum_p MU_p (l_a^ALPHA_p - mean of l_b^ALPHA_p) + K/2 (J^2 - 1)
   *
   *  Shear modulus at small strain: sum_p MU_p ALPHA_p / 2. */
  struct LawOgden : IsotropicHyperelastic<LawOgden> {
    static constexpr const char *name = "ogden";
    static constexpr const char *meaning = "rubber in powers of the principal stretches";
    static constexpr Parameter parameters[] = {
        {"", "K", "pressure", POSITIVE, REQUIRED, "bulk modulus"}};
    static constexpr const char *term = "term";
    static constexpr Parameter term_parameters[] = {
        {"term", "MU", "pressure", ANY_NUMBER, REQUIRED, "coefficient, of the sign of ALPHA"},
        {"term", "ALPHA", "1", ANY_NUMBER, REQUIRED, "exponent of the stretches"}};

    /** R. Hill's sufficient condition for stability, as in Ogden's paper. */
    static const char *check(const LawParameters &p)
    {
      if (p.nterms == 0) return "no term: add 'term MU ALPHA'";
      for (int k = 0; k < p.nterms; k++)
        if (p.term[k][0] * p.term[k][1] <= 0.0)
          return "MU and ALPHA of a term must have the same sign, or the material is unstable "
                 "(ALPHA of some other programs: see the manual)";
      return nullptr;
    }

    static void update(const LawParameters &p, Batch &b, History)
    {
      const VolumeEnergy volume{p.value[0]};
      alignas(64) double e[3][BATCH], tau[3][BATCH], axis[9][BATCH];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Displacement H = displacement(b, i);
        const Spectral s = spectral(left_strain(H));
        const double logJ = log_volume(H), mean = (1.0 / 3.0) * logJ;
        const double pressure = volume.stress(logJ);
        for (int a = 0; a < 3; a++) {
          e[a][i] = 0.5 * log1p(max(s.value[a], -1.0 + 1e-15)) - mean;
          tau[a][i] = pressure;
          axis[a][i] = s.vector[0][a];
          axis[a + 3][i] = s.vector[1][a];
          axis[a + 6][i] = s.vector[2][a];
        }
      }
      for (int k = 0; k < p.nterms; k++) {
        const double mu = p.term[k][0], alpha = p.term[k][1];
        MPM_SIMD
        for (int i = 0; i < b.n; i++) {
          const double x = expm1(alpha * e[0][i]), y = expm1(alpha * e[1][i]);
          const double z = expm1(alpha * e[2][i]), mean = (1.0 / 3.0) * (x + y + z);
          tau[0][i] += mu * (x - mean);
          tau[1][i] += mu * (y - mean);
          tau[2][i] += mu * (z - mean);
        }
      }
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        Sym r = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
        add_dyad(r, axis[0][i], axis[3][i], axis[6][i], tau[0][i]);
        add_dyad(r, axis[1][i], axis[4][i], axis[7][i], tau[1][i]);
        add_dyad(r, axis[2][i], axis[5][i], axis[8][i], tau[2][i]);
        store_stress(b, i, (1.0 / b.J[i]) * r);
      }
    }

    static void energy(const LawParameters &p, const Batch &b, History, double *w)
    {
      const VolumeEnergy volume{p.value[0]};
      alignas(64) double e[3][BATCH];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Displacement H = displacement(b, i);
        const Spectral s = spectral(left_strain(H));
        const double logJ = log_volume(H);
        for (int a = 0; a < 3; a++)
          e[a][i] = 0.5 * log1p(max(s.value[a], -1.0 + 1e-15)) - (1.0 / 3.0) * logJ;
        w[i] += volume.stored(logJ);
      }
      for (int k = 0; k < p.nterms; k++) {
        const double mu = p.term[k][0], alpha = p.term[k][1];
        MPM_SIMD
        for (int i = 0; i < b.n; i++)    // the strains add up to zero: no term of first order
          w[i] += mu / alpha *
              (expm1_minus(alpha * e[0][i]) + expm1_minus(alpha * e[1][i]) +
               expm1_minus(alpha * e[2][i]));
      }
    }

    static void respond(const LawParameters &p, int n, PrincipalResponse &r)
    {
      const VolumeEnergy volume{p.value[0]};
      for (int k = 0; k < p.nterms; k++) {
        const double mu = p.term[k][0], alpha = p.term[k][1];
        MPM_SIMD
        for (int i = 0; i < n; i++) respond_ogden(mu, alpha, r, i);
      }
      MPM_SIMD
      for (int i = 0; i < n; i++)
        respond_mean(volume.stress(r.logJ[i]), volume.derivative(r.logJ[i]), r, i);
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
