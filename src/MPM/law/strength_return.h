/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_STRENGTH_RETURN_H
#define MPM_LAW_STRENGTH_RETURN_H

#include "law/strength.h"

namespace MPM_NS::law {
namespace {

  /** A point after the elastic trial step. */
  struct TrialState {
    double q;        ///< equivalent stress
    double stiff;    ///< 3 G/J
    double J;        ///< mean volume ratio of the step
  };

  /** Von Mises equivalent of a deviator. */
  MPM_INLINE double equivalent(const Sym &s)
  {
    return std::sqrt(1.5 * norm2(s));
  }

  /** Solves r(D) = q - stiff D - Y(D) = 0 for the points with D > 0, which is the first guess; most:
   *  upper bound of D. Iteration, the whole batch at a time: r is convex in D for power hardening
   *  (n < 1), logarithmic or power rate dependence, and both together, and concave in log D. So
   *  Newton in D from the left and Newton in log D from the right approach the root from their side
   *  only, also with infinite slope at D = 0 and when D is smaller than any strain that is ever
   *  seen (small exponents). A bracket catches all else (thermal softening). */
  template <class Flow>
  MPM_INLINE void solve_return(const Batch &b, const Flow &flow, History history,
                               const double *trial, const double *stiff, const double *start,
                               const double *most, double *yield, double *D)
  {
    constexpr int MAX_ITERATIONS = 100;
    alignas(64) double low[BATCH], high[BATCH];
    MPM_SIMD
    for (int i = 0; i < b.n; i++) {
      low[i] = 0.0;
      high[i] = most[i];
    }
    for (int iteration = 0; iteration < MAX_ITERATIONS; iteration++) {
      double busy = 0.0;
      MPM_SIMD_SUM(busy)
      for (int i = 0; i < b.n; i++) {
        const double d = D[i];
        const TrialState t{trial[i], stiff[i], 0.5 * (b.J[i] + b.Jold[i])};
        double y, dy;
        flow.stress(history, i, start[i], t, d, y, dy);
        const double r = t.q - t.stiff * d - y;
        const double s = t.stiff + dy;    // -dr/dD
        const double lo = r > 0.0 ? d : low[i], hi = r > 0.0 ? high[i] : d;
        const double newton = r > 0.0 ? d + r / s : d * exp(r / (d * s));
        const double half = 0.5 * (lo + hi);
        const double next = s > 0.0 && newton > lo && newton < hi ? newton : half;
        const bool active = d > 0.0;
        const bool done = d <= 1e-300 || max(r, -r) <= 1e-13 * y + 1e-15 * t.q;
        const double step = active && !done ? next - d : 0.0;
        low[i] = lo;
        high[i] = hi;
        yield[i] = min(y + dy * step, t.q);
        D[i] = d + step;
        // the error left by a small Newton step is its square: no need to look again
        busy += step * step > (Flow::smooth ? 1e-14 * d * d : 0.0) ? 1.0 : 0.0;
      }
      if (busy == 0.0) return;
    }
  }

  /** Loops of a von Mises strength: radial return to the flow stress at the end of the step
   *  (M.L. Wilkins, Methods Comput. Phys. 3 (1964) 211; J.C. Simo, T.J.R. Hughes, Computational
   *  Inelasticity, 1998, ch. 3), with an unknown increment D of the equivalent plastic strain:
   *
   *    r(D) = q - 3 G/J D - Y(D) = 0,   q = trial equivalent stress
   *
   *  Flow has: Flow(parameters, batch); smooth, false when Y(D) has kinks; shear(i), the shear
   *  modulus of the step; start(history, i), the flow stress for D -> 0; stress(history, i, start,
   *  trial state, D, Y, dY/dD); begin(start, D), the flow stress at the beginning of the step, which
   *  makes the plastic work with Y. start is the stress at which plastic flow begins in this step:
   *  that of start(), or with goes_on = true that of the last step, unless it was far below. First
   *  row of the history: the equivalent plastic strain.
   */
  template <class Flow> struct RadialReturn : ShearElasticity {
    static void update(const LawParameters &p, Batch &b, History history)
    {
      const Flow flow(p, b);
      alignas(64) double trial[BATCH], stiff[BATCH], start[BATCH], yield[BATCH], D[BATCH];
      alignas(64) double most[BATCH];

      double yielding = 0.0;
      MPM_SIMD_SUM(yielding)
      for (int i = 0; i < b.n; i++) {
        const Increment inc = increment(b, i);
        const double G = flow.shear(i);
        const double last = Flow::goes_on ? equivalent(deviator(load_stress(b, i))) : 0.0;
        const Sym s = ElasticDeviator{G}.trial(b, i, inc);
        store_stress(b, i, s);
        const double q = equivalent(s);
        const double modulus = 3.0 * G / b.J[i];
        const double y = flow.start(history, i);
        const double excess = (q - y) / modulus;
        // first guess: all strain is plastic, when that is possible
        const double strain = std::sqrt((2.0 / 3.0) * norm2(deviator(inc.strain)));
        const double guess = min(excess, max(strain, 1e-3 * excess));
        trial[i] = q;
        stiff[i] = modulus;
        most[i] = q / modulus;
        start[i] = last > 0.5 * y ? last : y;
        D[i] = excess > 0.0 ? guess : 0.0;
        yielding += excess > 0.0 ? 1.0 : 0.0;
      }
      if (yielding == 0.0) return;
      solve_return(b, flow, history, trial, stiff, start, most, yield, D);

      double plastic = 0.0;
      MPM_SIMD_SUM(plastic)
      for (int i = 0; i < b.n; i++) {
        const double scale = D[i] > 0.0 ? yield[i] / trial[i] : 1.0;
        store_stress(b, i, scale * load_stress(b, i));
        const double J = 0.5 * (b.J[i] + b.Jold[i]);
        const double begin = flow.begin(start[i], D[i]);
        const double work = J * (0.5 * (begin + yield[i]) * D[i]);
        history[0][i] += D[i];
        plastic += work * b.vol0[i];
        b.plastic[i] = D[i];
        b.heat[i] += p.chi * work;
      }
      b.work[PLASTIC] += plastic;
      b.work[HEAT] += p.chi * plastic;
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
