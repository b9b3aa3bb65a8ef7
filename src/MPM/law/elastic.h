/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_ELASTIC_H
#define MPM_LAW_ELASTIC_H

// Isotropic elastic solids with Young's modulus and Poisson's ratio.

#include "law/hyperelastic.h"

namespace MPM_NS::law {
namespace {

  /** Isotropic hypoelasticity: Jaumann rate of the Kirchhoff stress tau = J sigma,
   *
   *    tau^J = 2 mu dev(D) + K tr(D) I,   the integral of tr(D) over a step being ln(J/J_old)
   *
   *  Because the rate is that of tau, not of sigma, tau_m^2/(2 K) + dev(tau):dev(tau)/(4 mu) is a
   *  stored energy whose change equals the stress power on any path. For small strain this is
   *  Hooke's law. The update starts from the old stress. */
  struct LawLinear : LawDefaults, BulkAndShear {
    static constexpr bool uses_F = false;
    static constexpr const char *name = "linear";
    static constexpr const char *meaning = "isotropic linear elastic, rate form";
    static constexpr StressShare share = WHOLE_STRESS;
    static constexpr Parameter parameters[] = {YOUNGS_MODULUS, POISSONS_RATIO};

    using BulkAndShear::BulkAndShear;

    static void update(const LawParameters &p, Batch &b, History)
    {
      const LawLinear law(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Increment inc = increment(b, i);
        const double J = b.J[i], Jold = b.Jold[i];
        const Sym tau = jaumann(inc, Jold * load_stress(b, i), 2.0 * law.G * deviator(inc.strain));
        store_stress(b, i, (1.0 / J) * add_diagonal(tau, law.K * log(J / Jold)));
      }
    }

    static void tangent(const LawParameters &p, Batch &b, History history, Tangent &t)
    {
      const LawLinear law(p);
      alignas(64) double old[6][BATCH], bulk[BATCH];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        store_rows(old, i, b.Jold[i] * load_stress(b, i));
        bulk[i] = law.K;
      }
      update(p, b, history);
      add_elastic_step(b.n, ElasticStep(b, law.G, old), t);
      add_mean(b.n, bulk, t);
    }

    /** J d sigma_nn / d epsilon_nn = lambda + 2 mu - tau_nn, with a bound of -tau_nn over all
     *  directions n. In strong expansion it is negative, and the law has no waves. */
    static void modulus(const LawParameters &p, const Batch &b, History, double *k)
    {
      const LawLinear law(p);
      const double rest = law.K + (4.0 / 3.0) * law.G, least = LEAST_MODULUS * rest;
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Sym tau = b.J[i] * load_stress(b, i);
        k[i] += max(rest - (1.0 / 3.0) * trace(tau) + eigenvalue_bound(deviator(tau)), least);
      }
    }

    static void energy(const LawParameters &p, const Batch &b, History, double *w)
    {
      const LawLinear law(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Sym tau = b.J[i] * load_stress(b, i);
        const double mean = (1.0 / 3.0) * trace(tau);
        w[i] += mean * mean / (2.0 * law.K) + norm2(deviator(tau)) / (4.0 * law.G);
      }
    }
  };

  /** Compressible neo-Hookean solid in the logarithmic form (J. Simo, K. Pister, Comput. Methods
   *  Appl. Mech. Eng. 46 (1984) 201; J. Bonet, R. Wood, Nonlinear Continuum Mechanics, eq. 6.27):
   *
   *    w = mu/2 (tr b - 3 - 2 ln J) + lambda/2 ln^2 J
   *    sigma = [mu (b - I) + lambda ln J I] / J
   */
  struct LawNeoHookean : Hyperelastic<LawNeoHookean>, LameModuli {
    static constexpr const char *name = "neohookean";
    static constexpr const char *meaning = "compressible neo-Hookean hyperelastic";
    static constexpr Parameter parameters[] = {
        {"", "E", "pressure", POSITIVE, REQUIRED, "Young's modulus at small strain"},
        {"", "NU", "1", POISSON_RATIO, REQUIRED, "Poisson's ratio at small strain"}};

    using LameModuli::LameModuli;

    static void update(const LawParameters &p, Batch &b, History)
    {
      const LawNeoHookean law(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double J = b.J[i], inv = 1.0 / J;
        const Sym bb = left_cauchy_green(b, i);
        store_stress(b, i, add_diagonal(law.mu * inv * bb, (law.lambda * log(J) - law.mu) * inv));
      }
    }

    /** Derivative of the Kirchhoff stress: mu (l b + b l^T) + lambda tr(l) I. */
    static void tangent(const LawParameters &p, Batch &b, History history, Tangent &t)
    {
      const LawNeoHookean law(p);
      update(p, b, history);
      alignas(64) double left[6][BATCH], lambda[BATCH];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        store_rows(left, i, law.mu * left_cauchy_green(b, i));
        lambda[i] = law.lambda;
      }
      add_convected(b.n, left, t);
      add_mean(b.n, lambda, t);
    }

    /** From the acoustic tensor: J rho c^2 = mu n.b.n + mu + lambda (1 - ln J), largest along the
     *  longest principal stretch. */
    static void modulus(const LawParameters &p, const Batch &b, History, double *k)
    {
      const LawNeoHookean law(p);
      const double least = LEAST_MODULUS * (law.lambda + 2.0 * law.mu);
      MPM_SIMD
      for (int i = 0; i < b.n; i++)
        k[i] += max(law.mu * (largest_principal(left_cauchy_green(b, i)) + 1.0) +
                        law.lambda * (1.0 - log(b.J[i])),
                    least);
    }

    /** With H = F - I and det F - 1 = tr H + minors + det H, the terms of first order in H in tr b
     *  - 3 - 2 ln J are cancelled analytically, so that small strains keep full relative
     *  precision. */
    MPM_INLINE double stored(const Batch &b, int i) const
    {
      const Displacement H = displacement(b, i);
      const double square = H.xx * H.xx + H.xy * H.xy + H.xz * H.xz + H.yx * H.yx + H.yy * H.yy +
          H.yz * H.yz + H.zx * H.zx + H.zy * H.zy + H.zz * H.zz;
      const double J = b.J[i], logJ = log(J);
      return 0.5 * mu *
          (square - 2.0 * (H.minors() + H.determinant()) + 2.0 * minus1_minus_log(J)) +
          0.5 * lambda * logJ * logJ;
    }
  };

  /** Second Piola-Kirchhoff stress linear in the Green-Lagrange strain E = (F^T F - I)/2
   *  (R.W. Ogden, Non-Linear Elastic Deformations, 1984, ch. 4.4):
   *
   *    w = lambda/2 tr^2(E) + mu E:E,   J sigma = F [lambda tr(E) I + 2 mu E] F^T
   *
   *  with F E F^T = (b^2 - b)/2. It softens in compression: under uniaxial compression the
   *  stress falls below a stretch of 1/sqrt(3). */
  struct LawStVenantKirchhoff : IsotropicHyperelastic<LawStVenantKirchhoff>, LameModuli {
    static constexpr const char *name = "stvenant/kirchhoff";
    static constexpr const char *meaning = "hyperelastic, linear in Green-Lagrange strain";
    static constexpr Parameter parameters[] = {YOUNGS_MODULUS, POISSONS_RATIO};

    using LameModuli::LameModuli;

    MPM_INLINE Sym kirchhoff(const Batch &b, int i) const
    {
      const Sym g = left_strain(displacement(b, i));    // b - I; b^2 - b = b g = g + g^2
      const double t = 0.5 * lambda * trace(g);
      return add_diagonal((t + mu) * g + mu * square(g), t);
    }

    MPM_INLINE double stored(const Batch &b, int i) const
    {
      const Sym e = green_lagrange(displacement(b, i));
      const double t = trace(e);
      return 0.5 * lambda * t * t + mu * norm2(e);
    }

    /** l tau + tau l^T + lambda (b:d) b + 2 mu b d b, where d is the symmetric part of l. */
    static void tangent(const LawParameters &p, Batch &b, History history, Tangent &t)
    {
      const LawStVenantKirchhoff law(p);
      update(p, b, history);
      alignas(64) double tau[6][BATCH], left[6][BATCH];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        store_rows(tau, i, b.J[i] * load_stress(b, i));
        store_rows(left, i, left_cauchy_green(b, i));
      }
      add_convected(b.n, tau, t);
      for (int k = 0; k < 9; k++)
        for (int c = 0; c < 6 && !t.skips(k); c++) {
          const double *const bij = left[c], *const bkl = left[COMPONENT[k / 3][k % 3]];
          const double *const bik = left[COMPONENT[FIRST[c]][k / 3]];
          const double *const blj = left[COMPONENT[k % 3][SECOND[c]]];
          const double *const bil = left[COMPONENT[FIRST[c]][k % 3]];
          const double *const bkj = left[COMPONENT[k / 3][SECOND[c]]];
          double *const row = t.stress[c][k];
          MPM_SIMD
          for (int i = 0; i < b.n; i++)
            row[i] += law.lambda * bij[i] * bkl[i] + law.mu * (bik[i] * blj[i] + bil[i] * bkj[i]);
        }
    }

    MPM_INLINE void respond_at(PrincipalResponse &r, int i) const
    {
      const double x = exp(2.0 * r.e[0][i]), y = exp(2.0 * r.e[1][i]);
      const double z = exp(2.0 * r.e[2][i]), t = 0.5 * lambda * (x + y + z - 3.0);
      // second Piola-Kirchhoff stresses
      const double Sx = t + mu * (x - 1.0), Sy = t + mu * (y - 1.0);
      const double Sz = t + mu * (z - 1.0), M = lambda + 2.0 * mu;
      r.tau[0][i] = x * Sx;
      r.tau[1][i] = y * Sy;
      r.tau[2][i] = z * Sz;
      r.A[0][i] = x * (2.0 * Sx + M * x);
      r.A[1][i] = y * (2.0 * Sy + M * y);
      r.A[2][i] = z * (2.0 * Sz + M * z);
      r.A[3][i] = lambda * x * y;
      r.A[4][i] = lambda * x * z;
      r.A[5][i] = lambda * y * z;
    }
  };

  /** Hyperelastic solid that is linear in the engineering strains u = V - I, with the left stretch
   *  V = sqrt(b), except in its change of volume (fixed corotated energy: A. Stomakhin, R. Howes,
   *  C. Schroeder, J. Teran, Proc. ACM SIGGRAPH/Eurographics Symp. Computer Animation (2012) 25,
   *  eq. 7):
   *
   *    w = mu u:u + lambda/2 (J - 1)^2,   J sigma = 2 mu V u + lambda J (J - 1) I
   *
   *  With NU = 0, nominal stresses are E times the engineering strains, as in the theory of
   *  bars. */
  struct LawCorotated : IsotropicHyperelastic<LawCorotated>, LameModuli {
    static constexpr const char *name = "corotated";
    static constexpr const char *meaning = "hyperelastic, linear in engineering strain";
    static constexpr Parameter parameters[] = {YOUNGS_MODULUS, POISSONS_RATIO};

    using LameModuli::LameModuli;

    static void engineering_strains(const Batch &b, Tensors &strain)
    {
      logarithmic_strains(b, strain);
      exp_minus_identity(b.n, strain.row, strain.row);
    }

    static void update(const LawParameters &p, Batch &b, History)
    {
      const LawCorotated law(p);
      Tensors strain;
      engineering_strains(b, strain);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Sym u = load_rows(strain.row, i);
        const double grown = expm1(log_volume(displacement(b, i)));
        store_stress(b, i,
                     add_diagonal((2.0 * law.mu / b.J[i]) * (u + square(u)), law.lambda * grown));
      }
    }

    static void energy(const LawParameters &p, const Batch &b, History, double *w)
    {
      const LawCorotated law(p);
      Tensors strain;
      engineering_strains(b, strain);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double grown = expm1(log_volume(displacement(b, i)));
        w[i] += law.mu * norm2(load_rows(strain.row, i)) + 0.5 * law.lambda * grown * grown;
      }
    }

    MPM_INLINE void respond_at(PrincipalResponse &r, int i) const
    {
      for (int a = 0; a < 3; a++) {
        const double u = expm1(r.e[a][i]), stretch = 1.0 + u;
        r.tau[a][i] = 2.0 * mu * stretch * u;
        r.A[a][i] = 2.0 * mu * stretch * (stretch + u);
        r.A[a + 3][i] = 0.0;
      }
      const double grown = expm1(r.logJ[i]), J = 1.0 + grown;
      respond_mean(lambda * J * grown, lambda * J * (J + grown), r, i);
    }
  };

  /** Hyperelastic solid that is linear in the logarithmic (Hencky) strain e = ln(b)/2
   *  (H. Hencky, Z. Techn. Phys. 9 (1928) 215; L. Anand, J. Appl. Mech. 46 (1979) 78):
   *
   *    w = G dev(e):dev(e) + K/2 ln^2 J,   J sigma = 2 G dev(e) + K ln J I
   */
  struct LawHencky : IsotropicHyperelastic<LawHencky>, BulkAndShear {
    static constexpr const char *name = "hencky";
    static constexpr const char *meaning = "hyperelastic, linear in logarithmic strain";
    static constexpr Parameter parameters[] = {YOUNGS_MODULUS, POISSONS_RATIO};

    using BulkAndShear::BulkAndShear;

    static void update(const LawParameters &p, Batch &b, History)
    {
      const LawHencky law(p);
      Tensors strain;
      logarithmic_strains(b, strain);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Sym e = load_rows(strain.row, i);
        const double logJ = log_volume(displacement(b, i));
        store_stress(b, i, (1.0 / b.J[i]) * add_diagonal(2.0 * law.G * deviator(e), law.K * logJ));
      }
    }

    static void energy(const LawParameters &p, const Batch &b, History, double *w)
    {
      const LawHencky law(p);
      Tensors strain;
      logarithmic_strains(b, strain);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double logJ = log_volume(displacement(b, i));
        w[i] += law.G * norm2(deviator(load_rows(strain.row, i))) + 0.5 * law.K * logJ * logJ;
      }
    }

    MPM_INLINE void respond_at(PrincipalResponse &r, int i) const
    {
      for (int a = 0; a < 3; a++) {
        r.tau[a][i] = 2.0 * G * (r.e[a][i] - (1.0 / 3.0) * r.logJ[i]);
        r.A[a][i] = (4.0 / 3.0) * G;
        r.A[a + 3][i] = -(2.0 / 3.0) * G;
      }
      respond_mean(K * r.logJ[i], K, r, i);
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
