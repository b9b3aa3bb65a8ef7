/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_HYPERELASTIC_H
#define MPM_LAW_HYPERELASTIC_H

#include "law/spectral.h"
#include "law/tangent.h"

namespace MPM_NS::law {
namespace {

  /** b - I of the points of a batch. */
  MPM_INLINE void left_strains(const Batch &b, Tensors &strain)
  {
    MPM_SIMD
    for (int i = 0; i < b.n; i++) store_rows(strain.row, i, left_strain(displacement(b, i)));
  }

  /** Logarithmic strains ln(b)/2 of the points of a batch. */
  MPM_INLINE void logarithmic_strains(const Batch &b, Tensors &strain)
  {
    left_strains(b, strain);
    log_strains(b.n, strain.row, strain.row);
  }

  /** Kernels of a law whose stress is a function of F. Law provides:
   *    Law(parameters)
   *    kirchhoff(batch, i), the Kirchhoff stress J sigma
   *    stored(batch, i), the energy per reference volume
   */
  template <class Law> struct Hyperelastic : LawDefaults {
    static void update(const LawParameters &p, Batch &b, History)
    {
      const Law law(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) store_stress(b, i, (1.0 / b.J[i]) * law.kirchhoff(b, i));
    }

    static void energy(const LawParameters &p, const Batch &b, History, double *w)
    {
      const Law law(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) w[i] += law.stored(b, i);
    }
  };

  /** Response of isotropic points along their principal axes. */
  struct PrincipalResponse {
    alignas(64) double e[3][BATCH];      ///< logarithms of the principal stretches
    alignas(64) double logJ[BATCH];      ///< their sum
    alignas(64) double tau[3][BATCH];    ///< out: principal Kirchhoff stresses
    alignas(64) double A[6][BATCH];      ///< out: d tau_a / d e_b for ab = 11 22 33 12 13 23
  };

  /** Entry of largest_modulus() for waves along axis b that move points along axis a. ab: index of
   *  A_ab. */
  MPM_INLINE double pair_modulus(const PrincipalResponse &r, int i, int a, int b, int ab)
  {
    const double d = r.e[a][i] - r.e[b][i], coupling = r.A[ab][i], tau = r.tau[b][i];
    const bool equal = d * d < 1e-10;    // equal stretches: the limit
    const double limit = 0.5 * (r.A[a][i] - coupling);
    const double s = equal ? limit : (r.tau[a][i] - tau) / expm1(2.0 * (equal ? 1.0 : d));
    return s + std::fabs(coupling + s - tau);
  }

  /** Largest density_0 c^2 of all waves in an isotropic elastic point, or a slightly larger value.
   *
   *  For a plane wave with normal n and polarization m, both in principal axes, density_0 c^2 is
   *  (R.W. Ogden, Non-Linear Elastic Deformations, 1984, ch. 6.3; here with Kirchhoff stresses)
   *
   *    sum_a (A_aa - tau_a) n_a^2 m_a^2
   *      + sum_(a != b) [s_ab n_b^2 m_a^2 + (A_ab + s_ab - tau_b) n_a m_a n_b m_b],
   *    s_ab = (tau_a - tau_b) / (exp(2 (e_a - e_b)) - 1),
   *
   *  a quadratic form in m. The largest eigenvalue of its matrix is at most max_a (M v)_a / v_a for
   *  any positive v, where M has the absolute values of the off-diagonal entries (L. Collatz, Math.
   *  Z. 48 (1942) 221). With v = |n|, this is a mean over n_b^2 of the entries computed below,
   *  whose maximum is thus a bound for all n. The bound is exact at small strain. */
  MPM_INLINE double largest_modulus(const PrincipalResponse &r, int i)
  {
    const double k0 = r.A[0][i] - r.tau[0][i], k1 = r.A[1][i] - r.tau[1][i];
    const double k2 = r.A[2][i] - r.tau[2][i];
    const double k3 = max(pair_modulus(r, i, 0, 1, 3), pair_modulus(r, i, 1, 0, 3));
    const double k4 = max(pair_modulus(r, i, 0, 2, 4), pair_modulus(r, i, 2, 0, 4));
    const double k5 = max(pair_modulus(r, i, 1, 2, 5), pair_modulus(r, i, 2, 1, 5));
    return max(max(max(k0, k1), max(k2, k3)), max(k4, k5));
  }

  /** Contribution to the tangent of an isotropic point for shear in the plane of its principal axes
   *  a and b. With d tau_ab = s_ab l_ab + s_ba l_ba, s_ab = (tau_a - tau_b)/(exp(2 (e_a - e_b)) -
   *  1), the mean of s_ab and s_ba is
   *
   *    m_ab = (tau_a - tau_b)/2 coth(e_a - e_b)
   *
   *  (G.A. Holzapfel, Nonlinear Solid Mechanics, 2000, ch. 6.6; E.A. de Souza Neto et al.,
   *  Computational Methods for Plasticity, 2008, app. A). The remainder is a rotation of the
   *  stress. m_ab is an even function of e_a - e_b: where this difference is small, the error of
   *  the limit is of second order. */
  MPM_INLINE double shear_tangent(const PrincipalResponse &r, int i, int a, int b, int ab)
  {
    const double d = r.e[a][i] - r.e[b][i];
    const bool equal = d * d < 1e-10;
    const double ratio = 1.0 + 2.0 / expm1(2.0 * (equal ? 1.0 : d));
    const double limit = 0.25 * (r.A[a][i] + r.A[b][i] - 2.0 * r.A[ab][i]);
    return equal ? limit : 0.5 * (r.tau[a][i] - r.tau[b][i]) * ratio;
  }

  /** Computes the response of n points; r.tau and r.A must be zero on entry. */
  template <class Law> struct IsotropicHyperelastic : Hyperelastic<Law> {
    static void respond(const LawParameters &p, int n, PrincipalResponse &r)
    {
      const Law law(p);
      MPM_SIMD
      for (int i = 0; i < n; i++) law.respond_at(r, i);
    }

    static void modulus(const LawParameters &p, const Batch &b, History, double *k)
    {
      PrincipalResponse r;
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Displacement H = displacement(b, i);
        const Sym strain = left_strain(H);
        const double mean = (1.0 / 3.0) * trace(strain);
        const DeviatorRoots root(deviator(strain));
        r.logJ[i] = log_volume(H);
        r.e[0][i] = log_strain(mean + root.first);
        r.e[1][i] = log_strain(mean - 0.5 * root.first + root.half);
        r.e[2][i] = log_strain(mean - 0.5 * root.first - root.half);
        for (int a = 0; a < 3; a++) {
          r.tau[a][i] = 0.0;
          r.A[a][i] = r.A[a + 3][i] = 0.0;
        }
      }
      Law::respond(p, b.n, r);
      PrincipalResponse rest;
      for (int a = 0; a < 3; a++)
        rest.e[a][0] = rest.tau[a][0] = rest.A[a][0] = rest.A[a + 3][0] = 0.0;
      rest.logJ[0] = 0.0;
      Law::respond(p, 1, rest);
      const double least = LEAST_MODULUS * rest.A[0][0];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) k[i] += max(largest_modulus(r, i), least);
    }

    static void tangent(const LawParameters &p, Batch &b, History history, Tangent &t)
    {
      Law::update(p, b, history);
      Tensors strain;
      left_strains(b, strain);
      const Spectral axes(b.n, strain.row);
      PrincipalResponse r;
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        r.logJ[i] = log_volume(displacement(b, i));
        for (int a = 0; a < 3; a++) {
          r.e[a][i] = log_strain(axes.value[a][i]);
          r.tau[a][i] = 0.0;
          r.A[a][i] = r.A[a + 3][i] = 0.0;
        }
      }
      Law::respond(p, b.n, r);
      FrameModuli moduli;
      alignas(64) double tau[6][BATCH];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        store_rows(tau, i, b.J[i] * load_stress(b, i));
        for (int k = 0; k < 6; k++) moduli.A[k][i] = r.A[k][i];
        moduli.m[0][i] = shear_tangent(r, i, 0, 1, 3);
        moduli.m[1][i] = shear_tangent(r, i, 0, 2, 4);
        moduli.m[2][i] = shear_tangent(r, i, 1, 2, 5);
      }
      add_turned(b.n, tau, t);
      add_frame_tangent(b.n, axes.vector, moduli, t);
    }
  };

  /** Adds a mean Kirchhoff stress with its derivative with respect to ln J. */
  MPM_INLINE void respond_mean(double tau, double derivative, PrincipalResponse &r, int i)
  {
    for (int a = 0; a < 3; a++) {
      r.tau[a][i] += tau;
      r.A[a][i] += derivative;
      r.A[a + 3][i] += derivative;
    }
  }

}    // namespace
}    // namespace MPM_NS::law
#endif
