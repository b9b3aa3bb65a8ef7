/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_ELASTOPLASTIC_H
#define MPM_LAW_ELASTOPLASTIC_H

// Finite-strain elastoplasticity with return mapping in principal logarithmic strains: the common
// part of the laws of soil, rock and snow.

#include "law/spectral.h"

namespace MPM_NS::law {
namespace {

// First rows of the history of these laws: be - I, so that small strains keep their digits. This is
// a macro because lists of declarations cannot be joined.
#define MPM_ELASTIC_STRAIN_HISTORY                                                          \
  {"elastic_xx", ZERO, "1", "elastic left Cauchy-Green tensor less identity, xx"},          \
      {"elastic_yy", ZERO, "1", "the same, yy"}, {"elastic_zz", ZERO, "1", "the same, zz"}, \
      {"elastic_xy", ZERO, "1", "the same, xy"}, {"elastic_xz", ZERO, "1", "the same, xz"}, \
  {                                                                                         \
    "elastic_yz", ZERO, "1", "the same, yz"                                                 \
  }
  constexpr int ELASTIC_STRAIN_ROWS = 6;

  /** f b f^T - I for b = I + c, with f = I + A of this step: f c f^T + A + A^T + A A^T. */
  MPM_INLINE Sym push_forward_strain(const Batch &b, int i, const Sym &c)
  {
    return push_forward(b, i, c) + left_strain(step_displacement(b, i));
  }

  /** det(I + c) - 1 */
  MPM_INLINE double elastic_volume(const Sym &c)
  {
    return trace(c) + minors(c) + determinant(c);
  }

  /** States of a batch along the principal axes of the elastic trial state, [axis][point]. */
  struct PrincipalStates {
    alignas(64) double before[3][BATCH];    ///< elastic strain at the start of the step
    alignas(64) double strain[3][BATCH];    ///< elastic strain; in: trial, out: end of the step
    alignas(64) double tau[3][BATCH];       ///< out: Kirchhoff stress
    alignas(64) double work[BATCH];         ///< out: dissipated work per reference volume
  };

  /** Work of a plastic strain increment: the mean of the work by the stresses at the start and the
   *  end of the step. The old stress counts only if its work in this direction is positive;
   *  otherwise the step began elastically. */
  MPM_INLINE double plastic_work(double by_old, double by_new)
  {
    return max(0.5 * (max(by_old, 0.0) + by_new), 0.0);
  }

  /** Upper bound of the acoustic modulus of Hencky elasticity, J d sigma_nn / d strain_nn: along a
   *  principal axis it is K + 4/3 G - tau_nn; between two axes G increases to G x coth(x) <= G (1 +
   *  x^2/3), where x is the difference of their logarithmic strains. */
  MPM_INLINE double hencky_modulus(double K, double G, double J, const Sym &stress)
  {
    const Sym s = deviator(stress);
    const double s2 = J * J * norm2(s), x2 = 2.0 * s2 / (4.0 * G * G);
    return max(K + (4.0 / 3.0) * G * (1.0 + (1.0 / 3.0) * x2) - (1.0 / 3.0) * J * trace(stress) +
                   std::sqrt((2.0 / 3.0) * s2),
               LEAST_MODULUS * (K + (4.0 / 3.0) * G));
  }

  /** Adds the energy K/2 tr^2(e) + G dev(e):dev(e) of logarithmic strains e to w[n]; history: rows
   *  of be - I. */
  MPM_INLINE void hencky_energy(const Batch &b, double K, double G, History history, double *w)
  {
    Tensors strain;
    log_strains(b.n, history, strain.row);
    MPM_SIMD
    for (int i = 0; i < b.n; i++) {
      const Sym e = load_rows(strain.row, i);
      const double v = trace(e);
      w[i] += 0.5 * K * v * v + G * norm2(deviator(e));
    }
  }

  /** Base of laws with F = Fe Fp and the history be = Fe Fe^T (J.C. Simo, Comput. Methods Appl.
   *  Mech. Eng. 99 (1992) 61; E.A. de Souza Neto, D. Peric, D.R.J. Owen, Computational Methods for
   *  Plasticity, 2008, ch. 14.4). The trial state f be f^T is exact for any rotation. Its
   *  logarithmic strain ln(be)/2 is returned to the yield surface as in small-strain plasticity,
   *  and the axes stay. Stresses of the law are Kirchhoff stresses, J times Cauchy. A law provides
   *  its own modulus() unless its elasticity is Hencky's with Young's modulus and Poisson's ratio
   *  as first parameters.
   *
   *  Strains at the start of the step are those of the trial state minus the strain increment along
   *  its axes; the work of a step is then accurate to third order. */
  struct FiniteStrainReturn : LawDefaults {
    static constexpr bool uses_F = false;

    /** Computes the trial state in the history, where it remains if all points stay elastic, and
     *  its logarithmic strain. */
    static MPM_INLINE void trial_strains(const Batch &b, History history, Tensors &strain)
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++)
        store_rows(history, i, push_forward_strain(b, i, load_rows(history, i)));
      log_strains(b.n, history, strain.row);
    }

    static void modulus(const LawParameters &p, const Batch &b, History, double *k)
    {
      const BulkAndShear m(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) k[i] += hencky_modulus(m.K, m.G, b.J[i], load_stress(b, i));
    }
  };

  /** Return mapping along principal axes, for any isotropic law. In addition to its declaration,
   *  Law provides:
   *    Law(parameters)
   *    stay_elastic(batch, history, strains): computes the stresses and returns true if all points
   *      certainly stay elastic
   *    map(batch, history, states): returns the strains to the yield surface and computes the rest;
   *      history starts after be
   *    energy()
   *
   *  Most bodies yield in a few places only; batches that stay elastic do not need the principal
   *  axes. */
  template <class Law> struct PrincipalReturn : FiniteStrainReturn {
    static void update(const LawParameters &p, Batch &b, History history)
    {
      const Law law(p);
      Tensors strain;
      trial_strains(b, history, strain);
      if (!law.stay_elastic(b, history, strain)) return_along_axes(p, law, b, history, strain);
    }

    // a separate function: together with update() it would not vectorize
    [[gnu::noinline]] static void return_along_axes(const LawParameters &p, const Law &law,
                                                    Batch &b, History history,
                                                    const Tensors &strain)
    {
      PrincipalStates s;
      const Spectral axes(b.n, strain.row);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Increment total = increment(b, i);
        for (int a = 0; a < 3; a++) {
          s.strain[a][i] = axes.value[a][i];
          s.before[a][i] = s.strain[a][i] - axes.along(a, i, total.strain);
        }
      }
      law.map(b, history + ELASTIC_STRAIN_ROWS, s);
      double plastic = 0.0;
      MPM_SIMD_SUM(plastic)
      for (int i = 0; i < b.n; i++) {
        // the axes are written out, as in energy(), because loops over small arrays do not
        // vectorize
        const double inv = 1.0 / b.J[i];
        store_rows(history, i,
                   axes.recompose(i, expm1(2.0 * s.strain[0][i]), expm1(2.0 * s.strain[1][i]),
                                  expm1(2.0 * s.strain[2][i])));
        store_stress(b, i,
                     axes.recompose(i, inv * s.tau[0][i], inv * s.tau[1][i], inv * s.tau[2][i]));
        b.heat[i] += p.chi * s.work[i];
        plastic += s.work[i] * b.vol0[i];
      }
      b.work[PLASTIC] += plastic;
      b.work[HEAT] += p.chi * plastic;
    }
  };

  /** States of a batch in invariants. */
  struct InvariantStates {
    alignas(64) double volume[BATCH];    ///< tr of the elastic strain; in: trial, out: end of step
    alignas(64) double shear[BATCH];     ///< sqrt(2/3 e:e) of its deviator e; in and out as volume
    alignas(64) double flow[BATCH];      ///< out: plastic volume strain, with work -p * flow
  };

  /** Return mapping of laws whose yield surface and flow do not depend on the third invariant and
   *  whose shear modulus is constant, in terms of the pressure p = -tr(tau)/3 and the equivalent
   *  stress q = 3 G shear.
   *
   *  Law provides G; pressure(v) and volume_energy(v) of the elastic volume strain v; and
   *  solve(batch, history, states), where history starts after be. */
  template <class Law> struct InvariantReturn : FiniteStrainReturn {
    static void update(const LawParameters &p, Batch &b, History history)
    {
      const Law law(p);
      const double G = law.G;
      Tensors strain;
      InvariantStates t;
      alignas(64) double shear[BATCH];    // of the trial state
      trial_strains(b, history, strain);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Sym trial = load_rows(strain.row, i);
        t.volume[i] = trace(trial);
        t.flow[i] = 0.0;
        t.shear[i] = shear[i] = std::sqrt((2.0 / 3.0) * norm2(deviator(trial)));
      }
      law.solve(b, history + ELASTIC_STRAIN_ROWS, t);
      double plastic = 0.0, moved = 0.0;
      MPM_SIMD_SUM(plastic, moved)
      for (int i = 0; i < b.n; i++) {
        const Sym trial = load_rows(strain.row, i), e = deviator(trial);
        const Increment total = increment(b, i);
        const double scale = shear[i] > 0.0 ? t.shear[i] / shear[i] : 1.0;
        const double pressure = law.pressure(t.volume[i]), inv = 1.0 / b.J[i];
        const double before = law.pressure(trace(trial) - trace(total.strain));
        const double by_shear = 2.0 * G * (1.0 - scale) * (norm2(e) - contract(e, total.strain));
        const double D = shear[i] - t.shear[i];
        const double work = plastic_work(by_shear - before * t.flow[i],
                                         3.0 * G * t.shear[i] * D - pressure * t.flow[i]);
        store_stress(b, i, add_diagonal((2.0 * G * scale * inv) * e, -pressure * inv));
        store_rows(strain.row, i, add_diagonal((2.0 * scale) * e, (2.0 / 3.0) * t.volume[i]));
        b.plastic[i] = D;
        b.heat[i] += p.chi * work;
        plastic += work * b.vol0[i];
        const double off = t.volume[i] - trace(trial);
        moved += off * off + D * D > 0.0 ? 1.0 : 0.0;
      }
      if (moved > 0.0) exp_minus_identity(b.n, strain.row, history);
      b.work[PLASTIC] += plastic;
      b.work[HEAT] += p.chi * plastic;
    }

    static void energy(const LawParameters &p, const Batch &b, History history, double *w)
    {
      const Law law(p);
      Tensors strain;
      log_strains(b.n, history, strain.row);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Sym e = load_rows(strain.row, i);
        w[i] += law.volume_energy(trace(e)) + law.G * norm2(deviator(e));
      }
    }
  };

  /** InvariantReturn with Kirchhoff stress linear in the logarithmic elastic strain (H. Hencky,
   *  1928). */
  template <class Law> struct HenckyInvariantReturn : InvariantReturn<Law>, BulkAndShear {
    using BulkAndShear::BulkAndShear;
    MPM_INLINE double pressure(double v) const { return -K * v; }
    MPM_INLINE double volume_energy(double v) const { return 0.5 * K * v * v; }
  };

  /** Separated grains: the volume strain that opened between them without stress ("gap") must close
   *  again before they carry pressure (A.P. Tampubolon et al., ACM Trans. Graph. 36 (2017) 105,
   *  volume correction of G. Klar et al., ACM Trans. Graph. 35 (2016) 103). Reduces gap and returns
   *  the trial volume strain after closing. */
  MPM_INLINE double close_gap(double volume, double &gap)
  {
    const double closed = min(gap, max(-volume, 0.0));
    gap -= closed;
    return volume + closed;
  }

  constexpr double DEGREES = 0.017453292519943295769;

}    // namespace
}    // namespace MPM_NS::law
#endif
