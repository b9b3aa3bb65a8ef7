/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_STRENGTH_KINEMATIC_H
#define MPM_LAW_STRENGTH_KINEMATIC_H

#include "law/strength_return.h"

namespace MPM_NS::law {
namespace {

  /** a:b */
  MPM_INLINE double contract(const Sym &a, const Sym &b)
  {
    return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz +
        2.0 * (a.xy * b.xy + a.xz * b.xz + a.yz * b.yz);
  }

  /** A flow stress and a back stress X/J that is part of the flow: seen from the elastic trial state
   *  of s - X/J, what resists D is Y, the growth C g/J of the back stress along the flow, and the
   *  fading of the old back stress, which turns s - w X/J. */
  template <class Flow> struct KinematicFlow {
    static constexpr bool smooth = Flow::smooth;
    const Flow &flow;
    double C, gamma;
    alignas(64) double trial[BATCH];     ///< equivalent value of xi = s - X/J
    alignas(64) double mixed[BATCH];     ///< 3/2 xi : X/J
    alignas(64) double square[BATCH];    ///< 3/2 X/J : X/J
    alignas(64) double slope[BATCH];     ///< C/J

    KinematicFlow(const Flow &flow, double C, double gamma) : flow(flow), C(C), gamma(gamma) {}

    /** Growth g of the back stress / C along the flow; faded = 1 - w. */
    MPM_INLINE double growth(double D, double &faded) const
    {
      faded = -expm1(-gamma * D);
      return gamma > 0.0 ? faded / gamma : D;
    }
    /** Equivalent value of s - w X/J. */
    MPM_INLINE double equivalent(int i, double faded) const
    {
      const double q2 = trial[i] * trial[i] + faded * (2.0 * mixed[i] + faded * square[i]);
      return std::sqrt(max(q2, 1e-30 * trial[i] * trial[i]));
    }
    MPM_INLINE void stress(History history, int i, double start, const TrialState t, double D,
                           double &y, double &dy) const
    {
      flow.stress(history, i, start, t, D, y, dy);
      double faded;
      const double g = growth(D, faded), q = equivalent(i, faded), w = 1.0 - faded;
      y += slope[i] * g + (trial[i] - q);
      dy += slope[i] * w - gamma * w * (mixed[i] + faded * square[i]) / q;
    }
  };

  /** Radial return with the back stress of P.J. Armstrong, C.O. Frederick (CEGB Report RD/B/N731,
   *  1966; Mater. High Temp. 24 (2007) 1), linear (W. Prager, Proc. IMechE 169 (1955) 41) when
   *  GAMMA = 0: X = J times the back stress follows, besides its Jaumann rotation,
   *
   *    dX = 2/3 C de_p - GAMMA X de,   integrated with constant direction of de_p = de N:
   *    X_new = w X + 2/3 C g N,        w = exp(-GAMMA D), g = (1 - w)/GAMMA
   *
   *  which is exact on straight paths. N is along s_new - X_new/J, and so along s - w X/J of the
   *  trial state: one equation for D remains. Stored: 3/4 X:X/C; the rest of the plastic work,
   *  Y de + 3/2 GAMMA/C X:X de, is dissipated.
   */
  template <class Flow> struct KinematicReturn : RadialReturn<Flow> {
    static void update(const LawParameters &p, double C, double gamma, Batch &b, History history,
                       History back)
    {
      const Flow flow(p, b);
      KinematicFlow<Flow> kinematic(flow, C, gamma);
      alignas(64) double stiff[BATCH], start[BATCH], yield[BATCH], D[BATCH], most[BATCH];

      double yielding = 0.0;
      MPM_SIMD_SUM(yielding)
      for (int i = 0; i < b.n; i++) {
        const Increment inc = increment(b, i);
        const double G = flow.shear(i), inv_J = 1.0 / b.J[i];
        const Sym before = deviator(load_stress(b, i)) + (-1.0 / b.Jold[i]) * load_rows(back, i);
        const double last = Flow::goes_on ? equivalent(before) : 0.0;
        const Sym s = ElasticDeviator{G}.trial(b, i, inc);
        const Sym X = rotate(inc, load_rows(back, i)), x = inv_J * X, xi = s + (-1.0) * x;
        store_stress(b, i, s);
        store_rows(back, i, X);
        const double q = equivalent(xi), square = 1.5 * norm2(x);
        kinematic.trial[i] = q;
        kinematic.mixed[i] = 1.5 * contract(xi, x);
        kinematic.square[i] = square;
        kinematic.slope[i] = C * inv_J;
        const double modulus = 3.0 * G * inv_J;
        const double y = flow.start(history, i);
        const double excess = (q - y) / modulus;
        const double strain = std::sqrt((2.0 / 3.0) * norm2(deviator(inc.strain)));
        const double guess = min(excess, max(strain, 1e-3 * excess));
        most[i] = (q + std::sqrt(square)) / modulus;
        stiff[i] = modulus;
        start[i] = last > 0.5 * y ? last : y;
        D[i] = excess > 0.0 ? guess : 0.0;
        yielding += excess > 0.0 ? 1.0 : 0.0;
      }
      if (yielding == 0.0) return;
      solve_return(b, kinematic, history, kinematic.trial, stiff, start, most, yield, D);

      double plastic = 0.0;
      MPM_SIMD_SUM(plastic)
      for (int i = 0; i < b.n; i++) {
        const double d = D[i], inv_J = 1.0 / b.J[i], J = 0.5 * (b.J[i] + b.Jold[i]);
        double faded;
        const double g = kinematic.growth(d, faded), q = kinematic.equivalent(i, faded);
        const Sym X = load_rows(back, i), kept = (1.0 - faded) * X;
        const Sym xi = load_stress(b, i) + (-inv_J) * kept;
        const double y = yield[i] - kinematic.slope[i] * g - (kinematic.trial[i] - q);
        const bool flows = d > 0.0;
        const Sym Xnew = flows ? kept + (C * g / q) * xi : X;
        store_rows(back, i, Xnew);
        store_stress(b, i, inv_J * Xnew + (flows ? y / q : 1.0) * xi);
        const double recovery = 0.75 * gamma / C * (norm2(X) + norm2(Xnew)) * d;
        const double begin = flow.begin(start[i], d);
        const double work = J * (0.5 * (begin + y) * d) + recovery;
        history[0][i] += d;
        plastic += work * b.vol0[i];
        b.plastic[i] = d;
        b.heat[i] += p.chi * work;
      }
      b.work[PLASTIC] += plastic;
      b.work[HEAT] += p.chi * plastic;
    }
  };

  /** Energy that the back stress stores. */
  MPM_INLINE void back_stress_energy(const Batch &b, History back, double C, double *w)
  {
    MPM_SIMD
    for (int i = 0; i < b.n; i++) w[i] += 0.75 / C * norm2(load_rows(back, i));
  }

}    // namespace
}    // namespace MPM_NS::law
#endif
