/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_RUBBER_H
#define MPM_LAW_RUBBER_H

// Hyperelastic laws in which change of volume and change of shape are uncoupled.

#include "law/hyperelastic.h"

namespace MPM_NS::law {
namespace {

  /** Isochoric strain z = J^(-2/3) b - I of a point. */
  struct Isochoric {
    Sym z;
    double logJ;

    MPM_INLINE Isochoric(const Batch &b, int i)
    {
      const Displacement H = displacement(b, i);
      logJ = log_volume(H);
      const double change = expm1((-2.0 / 3.0) * logJ);
      z = add_diagonal((1.0 + change) * left_strain(H), change);
    }

    /** tr(z) = first invariant - 3, which is of second order in the strain. Since det(I + z) = 1,
     *  it equals minus the sum of the other two invariants of z, which do not cancel for small
     *  strains. */
    MPM_INLINE double first() const
    {
      const double t = trace(z);
      return t > 0.01 ? t : -(minors(z) + determinant(z));
    }
  };

  /** Adds the response of an Ogden term MU/ALPHA (sum_a exp(ALPHA (e_a - ln J/3)) - 3) of the
   *  energy. */
  MPM_INLINE void respond_ogden(double mu, double alpha, PrincipalResponse &r, int i)
  {
    const double mean = (1.0 / 3.0) * r.logJ[i];
    const double x = exp(alpha * (r.e[0][i] - mean)), y = exp(alpha * (r.e[1][i] - mean));
    const double z = exp(alpha * (r.e[2][i] - mean)), average = (1.0 / 3.0) * (x + y + z);
    const double third = (1.0 / 3.0) * mu * alpha;
    r.tau[0][i] += mu * (x - average);
    r.tau[1][i] += mu * (y - average);
    r.tau[2][i] += mu * (z - average);
    r.A[0][i] += third * (x + average);
    r.A[1][i] += third * (y + average);
    r.A[2][i] += third * (z + average);
    r.A[3][i] -= third * (x + y - average);
    r.A[4][i] -= third * (x + z - average);
    r.A[5][i] -= third * (y + z - average);
  }

  /** Energy of the change of volume, U = K/4 (J^2 - 1 - 2 ln J): convex, and infinite for J -> 0
   *  (J.C. Simo, T.J.R. Hughes, Computational Inelasticity, 1998, eq. 9.2.5). stress() is J dU/dJ,
   *  derivative() its derivative with respect to ln J. */
  struct VolumeEnergy {
    double K;
    MPM_INLINE double stress(double logJ) const { return 0.5 * K * expm1(2.0 * logJ); }
    MPM_INLINE double derivative(double logJ) const { return K * exp(2.0 * logJ); }
    MPM_INLINE double stored(double logJ) const { return 0.25 * K * expm1_minus(2.0 * logJ); }
  };

  /** Neo-Hookean solid with uncoupled change of volume and change of shape, in the form that most
   *  finite element programs use (P.J. Flory, Trans. Faraday Soc. 57 (1961) 829; R.W. Ogden,
   *  Non-Linear Elastic Deformations, 1984, ch. 7.4):
   *
   *    w = G/2 (I1 - 3) + K/2 (J - 1)^2,   I1 = tr b*,  b* = J^(-2/3) b
   *    J sigma = G dev(b*) + K J (J - 1) I
   *
   *  The energy is finite at J = 0: use another law for compression beyond about one half. */
  struct LawNeoHookeanSplit : IsotropicHyperelastic<LawNeoHookeanSplit>, BulkAndShear {
    static constexpr const char *name = "neohookean/split";
    static constexpr const char *meaning = "neo-Hookean, volume change uncoupled";
    static constexpr Parameter parameters[] = {
        {"", "E", "pressure", POSITIVE, REQUIRED, "Young's modulus at small strain"},
        {"", "NU", "1", POISSON_RATIO, REQUIRED, "Poisson's ratio at small strain"}};

    using BulkAndShear::BulkAndShear;

    MPM_INLINE Sym kirchhoff(const Batch &b, int i) const
    {
      const Isochoric shape(b, i);
      const double u = expm1(shape.logJ);
      return add_diagonal(G * deviator(shape.z), K * (1.0 + u) * u);
    }

    MPM_INLINE double stored(const Batch &b, int i) const
    {
      const Isochoric shape(b, i);
      const double u = expm1(shape.logJ);
      return 0.5 * G * shape.first() + 0.5 * K * u * u;
    }

    /** With s = G b*: l s + s l^T - 2/3 [tr(l) s + (s:l) I] + [2/9 tr(s) + K J (2 J - 1)] tr(l)
     *  I */
    static void tangent(const LawParameters &p, Batch &b, History history, Tangent &t)
    {
      const LawNeoHookeanSplit law(p);
      update(p, b, history);
      alignas(64) double shape[6][BATCH], mean[BATCH];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Isochoric change(b, i);
        const Sym s = law.G * add_diagonal(change.z, 1.0);
        const double J = b.J[i];
        store_rows(shape, i, s);
        mean[i] = (2.0 / 9.0) * trace(s) + law.K * J * (2.0 * J - 1.0);
      }
      add_convected(b.n, shape, t);
      add_mean(b.n, mean, t);
      for (int c = 0; c < 6; c++)
        for (int k = 0; k < 9; k += 4) add_rows(b.n, -2.0 / 3.0, shape[c], t.stress[c][k]);
      for (int c = 0; c < 3; c++)
        for (int k = 0; k < 9; k++)
          if (!t.skips(k))
            add_rows(b.n, -2.0 / 3.0, shape[COMPONENT[k / 3][k % 3]], t.stress[c][k]);
    }

    MPM_INLINE void respond_at(PrincipalResponse &r, int i) const
    {
      respond_ogden(G, 2.0, r, i);
      const double J = exp(r.logJ[i]);
      respond_mean(K * J * (J - 1.0), K * J * (2.0 * J - 1.0), r, i);
    }
  };

  /** Rubber after M. Mooney, J. Appl. Phys. 11 (1940) 582, and R.S. Rivlin, Phil. Trans. R. Soc. A
   *  241 (1948) 379, with uncoupled change of volume and change of shape:
   *
   *    w = C10 (I1 - 3) + C01 (I2 - 3) + K/4 (J^2 - 1 - 2 ln J)
   *
   *  I1, I2: traces of b* = J^(-2/3) b and of its inverse. With z = b* - I,
   *
   *    J sigma = dev[2 C10 z + 2 C01 ((1 + tr z) z - z^2)] + K/2 (J^2 - 1) I
   *
   *  Shear modulus at small strain: 2 (C10 + C01). */
  struct LawMooneyRivlin : IsotropicHyperelastic<LawMooneyRivlin> {
    static constexpr const char *name = "mooney/rivlin";
    static constexpr const char *meaning = "rubber with two invariants, compressible";
    static constexpr Parameter parameters[] = {
        {"", "C10", "pressure", POSITIVE, REQUIRED, "coefficient of the first invariant"},
        {"", "C01", "pressure", NOT_NEGATIVE, REQUIRED, "coefficient of the second invariant"},
        BULK_MODULUS};

    double C10, C01;
    VolumeEnergy volume;

    explicit LawMooneyRivlin(const LawParameters &p) :
        C10(p.value[0]), C01(p.value[1]), volume{p.value[2]}
    {
    }

    MPM_INLINE Sym kirchhoff(const Batch &b, int i) const
    {
      const Isochoric shape(b, i);
      const double c = 2.0 * C10 + 2.0 * C01 * (1.0 + shape.first());
      return add_diagonal(deviator(c * shape.z + (-2.0 * C01) * square(shape.z)),
                          volume.stress(shape.logJ));
    }

    MPM_INLINE double stored(const Batch &b, int i) const
    {
      const Isochoric shape(b, i);
      const double first = shape.first();
      // det(I + z) = 1: trace of the inverse = 3 + 2 tr(z) + minors(z)
      const double second = 2.0 * first + minors(shape.z);
      return C10 * first + C01 * second + volume.stored(shape.logJ);
    }

    MPM_INLINE void respond_at(PrincipalResponse &r, int i) const
    {
      respond_ogden(2.0 * C10, 2.0, r, i);
      respond_ogden(-2.0 * C01, -2.0, r, i);
      const double logJ = r.logJ[i];
      respond_mean(volume.stress(logJ), volume.derivative(logJ), r, i);
    }
  };

  /** Rubber after R.W. Ogden, Proc. R. Soc. London A 326 (1972) 565 and 328 (1972) 567, with
   *  uncoupled change of volume and change of shape; stretches l_a = J^(-1/3) * principal
   *  stretches:
   *
   *    w = sum_p MU_p/ALPHA_p (l_1^ALPHA_p + l_2^ALPHA_p + l_3^ALPHA_p - 3)
   *          + K/4 (J^2 - 1 - 2 ln J)
   *    J sigma_a = sum_p MU_p (l_a^ALPHA_p - mean of l_b^ALPHA_p) + K/2 (J^2 - 1)
   *
   *  Shear modulus at small strain: sum_p MU_p ALPHA_p / 2. */
  struct LawOgden : IsotropicHyperelastic<LawOgden> {
    static constexpr const char *name = "ogden";
    static constexpr const char *meaning = "rubber in powers of the principal stretches";
    static constexpr Parameter parameters[] = {BULK_MODULUS};
    static constexpr const char *term = "term";
    static constexpr Parameter term_parameters[] = {
        {"term", "MU", "pressure", ANY_NUMBER, REQUIRED, "coefficient, of the sign of ALPHA"},
        {"term", "ALPHA", "1", ANY_NUMBER, REQUIRED, "exponent of the stretches"}};

    /** Checks the sufficient condition of R. Hill for stability, as in Ogden's paper. */
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
      alignas(64) double e[3][BATCH], tau[3][BATCH];
      Tensors strain;
      left_strains(b, strain);
      const Spectral axes(b.n, strain.row);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double logJ = log_volume(displacement(b, i)), mean = (1.0 / 3.0) * logJ;
        const double pressure = volume.stress(logJ);
        for (int a = 0; a < 3; a++) {
          e[a][i] = log_strain(axes.value[a][i]) - mean;
          tau[a][i] = pressure;
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
      for (int i = 0; i < b.n; i++)
        store_stress(b, i, (1.0 / b.J[i]) * axes.recompose(i, tau[0][i], tau[1][i], tau[2][i]));
    }

    static void energy(const LawParameters &p, const Batch &b, History, double *w)
    {
      const VolumeEnergy volume{p.value[0]};
      alignas(64) double e[3][BATCH];
      Tensors strain;
      left_strains(b, strain);
      const Spectral axes(b.n, strain.row);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double logJ = log_volume(displacement(b, i));
        for (int a = 0; a < 3; a++) e[a][i] = log_strain(axes.value[a][i]) - (1.0 / 3.0) * logJ;
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
