/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */
#ifndef MPM_LAW_CRITICAL_STATE_H
#define MPM_LAW_CRITICAL_STATE_H

#include "law/elastoplastic.h"

namespace MPM_NS::law {
namespace {

  /** Before plastic flow: pressure and hardening variable, or functions of these. */
  struct CriticalTrial {
    double p, hard;
  };

  /** What pressure and size of the yield surface become with plastic compression. */
  struct Compressed {
    double p, dp;      ///< pressure after plastic volume strain x (compression), and derivative
    double p0, dp0;    ///< compressive strength, and derivative
  };

  /** Laws with an elliptic yield surface in pressure p and equivalent stress q that hardens with
   *  plastic volume strain, and associated flow (K.H. Roscoe, J.B. Burland, in: Engineering
   *  Plasticity, Cambridge, 1968, p. 535; with tensile strength BETA p0 as in J. Gaume et al., Nat.
   *  Commun. 9 (2018) 3047):
   *
   *    q^2 (1 + 2 BETA) + M^2 (p + BETA p0) (p - p0) <= 0
   *
   *  With center p_m, half axes a and b = a M_b, M_b = M/sqrt(1 + 2 BETA), and u = (p - p_m)/a, flow
   *  goes as (x, shear) = (u, sqrt(1 - u^2)/M_b). For a plastic volume strain x the flow rule gives
   *  q/b = s = q_trial u/(b u + 3 G x/M_b), and the yield surface s^2 + u^2 = 1. x lies between 0 and
   *  the value that makes u = 0; 1 - 1/sqrt(s^2 + u^2) is nearly linear in x, and Newton's
   *  iteration within a bracket, a batch at a time, finds the root.
   *
   *  Law has: Base; G, M_b, beta; begin(history, i, volume); compress(trial, x);
   *  bracket(trial, sign of u, p_m, start, end) of x, false when no strength is left at the end;
   *  finish(history, i, trial, x, increment of shear). */
  template <class Law, class Base> struct CriticalStateReturn : Base {
    using Base::Base;
    static constexpr int MAX_ITERATIONS = 100;

    MPM_INLINE void solve(Batch &b, History history, InvariantStates &t) const
    {
      const Law &law = static_cast<const Law &>(*this);
      const double G = law.G, Mb = law.Mb, beta = law.beta, c = 3.0 * G / Mb;
      const double center = 0.5 * (1.0 - beta), half_axis = 0.5 * (1.0 + beta);
      alignas(64) double x[BATCH], from[BATCH], to[BATCH], sign[BATCH], p[BATCH], hard[BATCH];
      double yielding = 0.0;
      MPM_SIMD_SUM(yielding)
      for (int i = 0; i < b.n; i++) {
        const CriticalTrial state = law.begin(history, i, t.volume[i]);
        p[i] = state.p;
        hard[i] = state.hard;
        const Compressed k = law.compress(state, 0.0);
        const double a = half_axis * k.p0, q = 3.0 * G * t.shear[i];
        const double up = k.p + beta * k.p0, down = k.p0 - k.p;    // a (1 + u), a (1 - u)
        const bool plastic = q * q > Mb * Mb * up * down || up < 0.0 || down < 0.0;
        sign[i] = k.p > center * k.p0 ? 1.0 : -1.0;
        double start, end;
        const bool strong = law.bracket(state, sign[i], center * k.p0, start, end);
        // without strength all goes to the end, no stress, unless shear alone made it yield
        const bool search = plastic && (strong || (sign[i] < 0.0 && up > 0.0));
        // a first guess inside, when start is where the surface has no size
        const double guess = a > 0.0 ? start : 0.5 * (start + end);
        x[i] = !plastic ? 0.0 : search ? guess : end;
        from[i] = start;
        to[i] = search ? end : start;
        yielding += search ? 1.0 : 0.0;
      }
      for (int iteration = 0; yielding > 0.0 && iteration < MAX_ITERATIONS; iteration++) {
        double busy = 0.0;
        MPM_SIMD_SUM(busy)
        for (int i = 0; i < b.n; i++) {
          const CriticalTrial state = {p[i], hard[i]};
          const Compressed k = law.compress(state, x[i]);
          const double a = max(half_axis * k.p0, 1e-100), inv = 1.0 / a;
          const double q = 3.0 * G * t.shear[i];
          const double u = (k.p - center * k.p0) * inv;
          const double du = (k.dp - (center + u * half_axis) * k.dp0) * inv;
          const double bb = Mb * a, db = Mb * half_axis * k.dp0;
          const double D = bb * u + c * x[i];
          const double invD = D == 0.0 ? 0.0 : 1.0 / D;
          const double s = q * u * invD;
          const double ds = q * (du * c * x[i] - u * (u * db + c)) * invD * invD;
          const double w = (k.p + beta * k.p0) * inv * ((k.p0 - k.p) * inv);    // 1 - u^2
          const double f = s * s - w, df = 2.0 * (s * ds + u * du);
          const double root = std::sqrt(max(1.0 + f, 1e-300));
          const bool beyond = u * sign[i] <= 0.0;
          const double r = beyond ? -1.0 : f / (root * (1.0 + root));
          const double slope = 0.5 * df / (root * root * root);
          const bool active = from[i] != to[i];
          from[i] = active && r > 0.0 ? x[i] : from[i];
          to[i] = active && !(r > 0.0) ? x[i] : to[i];
          const double newton = x[i] - r / slope, half = 0.5 * (from[i] + to[i]);
          const double low = min(from[i], to[i]), high = max(from[i], to[i]);
          const double next = !beyond && newton > low && newton < high ? newton : half;
          const double size = s * s + max(w, -w);
          const bool done = !beyond && max(f, -f) <= 1e-14 * size;
          const double step = active && !done ? next - x[i] : 0.0;
          x[i] += step;
          to[i] = done ? from[i] : to[i];
          busy += step * step > 1e-30 * x[i] * x[i] ? 1.0 : 0.0;
        }
        if (busy == 0.0) break;
      }
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const CriticalTrial state = {p[i], hard[i]};
        const Compressed k = law.compress(state, x[i]);
        const double yield = Mb * std::sqrt(max((k.p + beta * k.p0) * (k.p0 - k.p), 0.0));
        const double shear = min(yield / (3.0 * G), t.shear[i]);
        law.finish(history, i, state, x[i], t.shear[i] - shear);
        t.volume[i] += x[i];
        t.shear[i] = shear;
        t.flow[i] = -x[i];
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
