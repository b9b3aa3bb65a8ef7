/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_VISCOSITY_MAXWELL_H
#define MPM_LAW_VISCOSITY_MAXWELL_H

#include "law/spectral.h"
#include "law/tangent.h"

namespace MPM_NS::law {
namespace {

  /** Maxwell elements parallel to the rest of the material: a Prony series G_k exp(-t/TAU_k) of the
   *  shear modulus at finite strain.
   *
   *  Each element has a strain z = c - I, where c is the elastic left Cauchy-Green tensor of the
   *  change of shape. c follows the motion like b* = J^(-2/3) b, and z relaxes to zero (J.
   *  Lubliner, Mech. Res. Commun. 12 (1985) 93, in spatial form):
   *
   *    upper convected rate of c (isochoric part of the motion) = -(c - I)/TAU
   *    J sigma = G dev(c),   w = G/2 (tr c - 3 - ln det c)
   *    dissipation rate = G/(2 TAU) (tr c + tr c^-1 - 6) >= 0
   *
   *  In fast motion an element is the neo-Hookean solid G/2 (tr b* - 3), in slow motion a viscosity
   *  G TAU; at small strain it is linearly viscoelastic. The equation of c is linear in the
   *  reference frame. It is integrated there with the exponential function and linear interpolation
   *  of the tensor to which c relaxes. The update is of second order, exact for small strain at
   *  constant rate, and stable for any step; a superposed rotation only rotates the stress. With
   *  the isochoric part f of the motion of the step, and x = dt/TAU,
   *
   *    z <- exp(-x) f z f^T + (1 - exp(-x))/x (f f^T - I)
   */
  struct ViscosityMaxwell : LawDefaults {
    static constexpr bool uses_F = false;
    static constexpr const char *name = "maxwell";
    static constexpr const char *meaning = "Maxwell elements (Prony series) in shear";
    static constexpr StressShare share = DEVIATOR;
    static constexpr bool uses_speed = false;
    static constexpr std::nullptr_t parameters = nullptr;
    static constexpr const char *term = "term";
    static constexpr Parameter term_parameters[] = {
        {"term", "G", "pressure", POSITIVE, REQUIRED, "shear modulus of the element"},
        {"term", "TAU", "time", POSITIVE, REQUIRED, "its relaxation time"}};
    static constexpr HistoryDeclaration term_history[] = {
        {"maxwell_xx", ZERO, "1", "strain of the element"},
        {"maxwell_yy", ZERO, "1", "strain of the element"},
        {"maxwell_zz", ZERO, "1", "strain of the element"},
        {"maxwell_xy", ZERO, "1", "strain of the element"},
        {"maxwell_xz", ZERO, "1", "strain of the element"},
        {"maxwell_yz", ZERO, "1", "strain of the element"}};

    static const char *check(const LawParameters &p)
    {
      return p.nterms == 0 ? "no element: add 'term G TAU'" : nullptr;
    }

    /** tr(c) + tr(c^-1) - 6, from the invariants of z. */
    static MPM_INLINE double excess(const Sym &z)
    {
      const double one = trace(z), two = minors(z), three = determinant(z);
      return (norm2(z) + one * (two + three) - 3.0 * three) / (1.0 + one + two + three);
    }

    static void update(const LawParameters &p, Batch &b, History history)
    {
      double viscous = 0.0;
      for (int k = 0; k < p.nterms; k++) {
        const History h = history + 6 * k;
        const double G = p.term[k][0], x = b.dt / p.term[k][1];
        const double decay = exp(-x), gain = x > 0.0 ? -expm1(-x) / x : 1.0;
        // weights of both ends in the integral of the dissipation: accurate for small steps, for
        // relaxation in one large step, and for steady flow
        const double first = 0.5 * (1.0 - decay), second = x - first;
        MPM_SIMD_SUM(viscous)
        for (int i = 0; i < b.n; i++) {
          const Displacement H = step_displacement(b, i);
          const double change = expm1((-2.0 / 3.0) * log_volume(H)), scale = 1.0 + change;
          const Sym old = load_rows(h, i);
          const Sym z = (decay * scale) * push_forward(b, i, old) +
              gain * add_diagonal(scale * left_strain(H), change);
          store_rows(h, i, z);
          store_stress(b, i, load_stress(b, i) + (G / b.J[i]) * deviator(z));
          const double work = 0.5 * G * (first * excess(old) + second * excess(z));
          b.heat[i] += work;
          viscous += work * b.vol0[i];
        }
      }
      b.work[VISCOUS] += viscous;
    }

    /** The terms of z are convected with the isochoric part of the motion: with y = z + (1 -
     *  exp(-x))/x I, dz = l y + y l^T - 2/3 tr(l) y. The derivative of excess() is dz:(I -
     *  c^-2). */
    static void tangent(const LawParameters &p, Batch &b, History history, Tangent &t)
    {
      update(p, b, history);
      for (int term = 0; term < p.nterms; term++) {
        const History h = history + 6 * term;
        const double G = p.term[term][0], x = b.dt / p.term[term][1];
        const double lost = -expm1(-x), gain = x > 0.0 ? lost / x : 1.0;
        const double second = 0.5 * G * (x - 0.5 * lost);
        alignas(64) double y[6][BATCH], dissipation[6][BATCH], change[6][BATCH];
        MPM_SIMD
        for (int i = 0; i < b.n; i++) {
          const Sym c = add_diagonal(load_rows(h, i), 1.0), squared = square(c);
          // c^-2 = cof(c^2)/det(c^2)
          const Sym cofactors = {squared.yy * squared.zz - squared.yz * squared.yz,
                                 squared.xx * squared.zz - squared.xz * squared.xz,
                                 squared.xx * squared.yy - squared.xy * squared.xy,
                                 squared.xz * squared.yz - squared.xy * squared.zz,
                                 squared.xy * squared.yz - squared.xz * squared.yy,
                                 squared.xy * squared.xz - squared.yz * squared.xx};
          const double inv = 1.0 / determinant(squared);
          store_rows(y, i, add_diagonal(c, gain - 1.0));
          store_rows(dissipation, i, second * add_diagonal((-inv) * cofactors, 1.0));
        }
        for (int k = 0; k < 9; k++) {
          if (t.skips(k)) continue;
          const int row = k / 3, column = k % 3;
          for (int m = 0; m < 6; m++) {
            const double left = FIRST[m] == row ? 1.0 : 0.0, right = SECOND[m] == row ? 1.0 : 0.0;
            const double volume = row == column ? -2.0 / 3.0 : 0.0;
            const double *const yl = y[COMPONENT[column][SECOND[m]]];
            const double *const yr = y[COMPONENT[FIRST[m]][column]];
            MPM_SIMD
            for (int i = 0; i < b.n; i++)
              change[m][i] = left * yl[i] + right * yr[i] + volume * y[m][i];
          }
          double *const heat = t.heat[k];
          MPM_SIMD
          for (int i = 0; i < b.n; i++) {
            const Sym dz = load_rows(change, i);
            add_column(t, k, i, G * deviator(dz));
            heat[i] += contract(load_rows(dissipation, i), dz);
          }
        }
      }
    }

    /** Modulus for a sudden strain, in which the elements do not relax. The bound is that of
     *  largest_modulus(), with the principal values of c in place of those of b*. */
    static void modulus(const LawParameters &p, const Batch &b, History history, double *k)
    {
      for (int term = 0; term < p.nterms; term++) {
        const History h = history + 6 * term;
        const double G = p.term[term][0];
        MPM_SIMD
        for (int i = 0; i < b.n; i++) {
          const Sym z = load_rows(h, i);
          const double most = 1.0 + largest_principal(z);
          const double least = max(1.0 - largest_principal(-1.0 * z), 0.0);
          const double sum = 3.0 + trace(z);
          const double along = (5.0 / 9.0) * sum - (1.0 / 3.0) * least;
          const double across = most + (1.0 / 9.0) * max(6.0 * most - sum, sum - 6.0 * least);
          k[i] += G * max(along, across);
        }
      }
    }

    static void energy(const LawParameters &p, const Batch &b, History history, double *w)
    {
      for (int term = 0; term < p.nterms; term++) {
        const History h = history + 6 * term;
        const double G = p.term[term][0];
        MPM_SIMD
        for (int i = 0; i < b.n; i++) {
          const Sym z = load_rows(h, i);
          const double rest = minors(z) + determinant(z);    // det c - 1 - tr z
          w[i] += 0.5 * G * (minus1_minus_log(1.0 + trace(z) + rest) - rest);
        }
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
