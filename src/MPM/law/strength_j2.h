/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_STRENGTH_J2_H
#define MPM_LAW_STRENGTH_J2_H

#include "law/strength.h"

namespace MPM_NS::law {
namespace {

  // indices of the parameters, one line per option
  enum { J2_G, J2_SIGMAY, J2_H, J2_B, J2_N };
  enum { J2_VOCE_Q = J2_N + 1, J2_VOCE_BETA, J2_VOCE_H, J2_SWIFT_E0, J2_SWIFT_N };
  enum { J2_COWPER_RATE = J2_SWIFT_N + 1, J2_COWPER_P };
  enum { J2_PERZYNA_S = J2_COWPER_P + 1, J2_PERZYNA_RATE, J2_PERZYNA_M };
  enum { J2_BACK_C = J2_PERZYNA_M + 1, J2_BACK_GAMMA };

  /** Kinds of flow stress at rest over the plastic strain e; a larger number is the size of a
   *  table. */
  enum { HARDENING_LINEAR, HARDENING_POWER, HARDENING_VOCE, SHORT_TABLE = 8 };
  constexpr int LONG_TABLE = LawParameters::MAX_TERMS;

  /** Straight lines between the points of a table, from SIGMAY at e = 0; constant after the last
   *  point. SIZE: largest number of points; only inner loops of fixed length allow the outer loop
   *  to vectorize. */
  template <int SIZE> struct J2Hardening {
    double sigmay;
    double from[SIZE], length[SIZE], slopes[SIZE];

    explicit J2Hardening(const LawParameters &p) : sigmay(p.value[J2_SIGMAY])
    {
      double e = 0.0, y = sigmay;
      for (int k = 0; k < SIZE; k++) {
        from[k] = e;
        length[k] = slopes[k] = 0.0;
        if (k >= p.nterms) continue;
        length[k] = p.term[k][0] - e;
        slopes[k] = (p.term[k][1] - y) / length[k];
        e = p.term[k][0];
        y = p.term[k][1];
      }
    }
    MPM_INLINE double start(int, double e) { return (*this)(e).y; }
    MPM_INLINE FlowStress operator()(double e) const
    {
      double y = sigmay, dy = 0.0, to_kink = UNBOUNDED;
#pragma GCC unroll 32
      for (int k = 0; k < SIZE; k++) {
        const double x = e - from[k], left = length[k] - x;
        y += slopes[k] * min(max(x, 0.0), length[k]);
        dy = x >= 0.0 && left > 0.0 ? slopes[k] : dy;
        to_kink = min(to_kink, min(max(x, -x), max(left, -left)));
      }
      return {y, dy, 0.0, to_kink};
    }
  };

  /** SIGMAY + H e */
  template <> struct J2Hardening<HARDENING_LINEAR> {
    double sigmay, H;

    explicit J2Hardening(const LawParameters &p) : sigmay(p.value[J2_SIGMAY]), H(p.value[J2_H]) {}
    MPM_INLINE double start(int, double e) { return (*this)(e).y; }
    MPM_INLINE FlowStress operator()(double e) const { return {sigmay + H * e, H, 0.0, UNBOUNDED}; }
  };

  /** SIGMAY + H e + B e^N (P. Ludwik, Elemente der technologischen Mechanik, 1909), or
   *  SIGMAY (1 + e/E0)^N (H.W. Swift, J. Mech. Phys. Solids 1 (1952) 1). */
  template <> struct J2Hardening<HARDENING_POWER> {
    double base, H, B, N, inv, offset;
    /** Flow stress and its derivatives at the start of the step, and largest D of the expansion. */
    alignas(64) double y[BATCH], slope[BATCH], bend[BATCH], most[BATCH];

    explicit J2Hardening(const LawParameters &p)
    {
      const bool swift = p.value[J2_SWIFT_E0] > 0.0;
      base = swift ? 0.0 : p.value[J2_SIGMAY];
      H = p.value[J2_H];
      B = swift ? p.value[J2_SIGMAY] : p.value[J2_B];
      N = swift ? p.value[J2_SWIFT_N] : p.value[J2_N];
      inv = swift ? 1.0 / p.value[J2_SWIFT_E0] : 1.0;
      offset = swift ? 1.0 : 0.0;
    }
    MPM_INLINE double start(int i, double e)
    {
      const FlowStress f = (*this)(e);
      y[i] = f.y;
      slope[i] = f.dy;
      bend[i] = f.ddy;
      most[i] = 0.5 * (e + offset / inv);
      return f.y;
    }
    /** Expansion for D small compared with x. */
    MPM_INLINE FlowStress estimate(int i, double D) const
    {
      const double z = min(D, most[i]), dy = slope[i] + z * bend[i], go = z < D ? 0.0 : 1.0;
      return {y[i] + z * (slope[i] + 0.5 * z * bend[i]), go * dy, go * bend[i], UNBOUNDED};
    }
    MPM_INLINE FlowStress operator()(double e) const
    {
      const double x = offset + inv * e, power = B * pow(x, N), inv_x = inv / max(x, 1e-300);
      const double grow = N * power * inv_x;
      return {base + H * e + power, H + grow, (N - 1.0) * grow * inv_x, UNBOUNDED};
    }
  };

  /** SIGMAY + Q (1 - exp(-BETA e)) + H e (E. Voce, J. Inst. Metals 74 (1948) 537). */
  template <> struct J2Hardening<HARDENING_VOCE> {
    double sigmay, Q, beta, H;

    explicit J2Hardening(const LawParameters &p) :
        sigmay(p.value[J2_SIGMAY]), Q(p.value[J2_VOCE_Q]), beta(p.value[J2_VOCE_BETA]),
        H(p.value[J2_VOCE_H])
    {
    }
    MPM_INLINE double start(int, double e) { return (*this)(e).y; }
    MPM_INLINE FlowStress operator()(double e) const
    {
      const double left = expm1(-beta * e), slope = Q * beta * (1.0 + left);
      return {sigmay + H * e - Q * left, H + slope, -beta * slope, UNBOUNDED};
    }
  };

  /** Flow stress at the end of the step from hardening and plastic strain rate r:
   *
   *    Y (1 + (r/RATE)^(1/P))      G.R. Cowper, P.S. Symonds, Brown Univ. Tech. Rep. 28 (1957)
   *    Y + S (r/RATE)^(1/M)        P. Perzyna, Adv. Appl. Mech. 9 (1966) 243
   */
  template <int KIND, bool RATE> struct J2Flow {
    static constexpr bool goes_on = RATE, estimates = KIND == HARDENING_POWER;
    J2Hardening<KIND> hardening;
    double G;
    /** Y (1 + factor x) + drag x with x = (r/RATE)^exponent; inv_rate: 1/(RATE dt). */
    double inv_rate, exponent, factor, drag;

    J2Flow(const LawParameters &p, const Batch &b) : hardening(p), G(p.value[J2_G])
    {
      const bool perzyna = p.value[J2_PERZYNA_S] > 0.0;
      const double rate = perzyna ? p.value[J2_PERZYNA_RATE] : p.value[J2_COWPER_RATE];
      inv_rate = 1.0 / max(rate * b.dt, 1e-300);
      exponent = 1.0 / (perzyna ? p.value[J2_PERZYNA_M] : p.value[J2_COWPER_P]);
      factor = perzyna ? 0.0 : 1.0;
      drag = p.value[J2_PERZYNA_S];
    }
    MPM_INLINE double shear(int) const { return G; }
    MPM_INLINE double start(History history, int i) { return hardening.start(i, history[0][i]); }
    MPM_INLINE FlowStress stress(History history, int i, double, const TrialState, double D) const
    {
      return with_rate(hardening(history[0][i] + D), D);
    }
    MPM_INLINE FlowStress estimate(int i, double, const TrialState, double D) const
    {
      return with_rate(hardening.estimate(i, D), D);
    }
    /** Flow stress after the update, with the history at the end of the step. */
    MPM_INLINE FlowStress at_end(History history, int i, double D) const
    {
      return with_rate(hardening(history[0][i]), D);
    }
    /** Adds the effect of the rate D/dt to a flow stress at rest. */
    MPM_INLINE FlowStress with_rate(const FlowStress &f, double D) const
    {
      if (!RATE) return f;
      const double x = pow(D * inv_rate, exponent), fast = 1.0 + factor * x;
      const double inv = 1.0 / max(D, 1e-300), dx = exponent * inv * x,
                   resist = f.y * factor + drag;
      return {f.y * fast + drag * x, f.dy * fast + resist * dx,
              f.ddy * fast + (2.0 * f.dy * factor + resist * (exponent - 1.0) * inv) * dx,
              f.to_kink};
    }
    MPM_INLINE double begin(double start, double) const { return start; }
  };

  /** Von Mises plasticity with isotropic and kinematic hardening and rate dependence. If there is
   *  only linear isotropic hardening, the return is computed in closed form. */
  struct StrengthJ2 : ShearElasticity {
    static constexpr const char *name = "j2";
    static constexpr const char *meaning = "von Mises plasticity with hardening and rate";
    static constexpr Parameter parameters[] = {
        SHEAR_MODULUS,
        {"", "SIGMAY", "pressure", NOT_NEGATIVE, REQUIRED, "yield stress in uniaxial tension"},
        {"hardening linear", "H", "pressure", NOT_NEGATIVE, 0.0,
         "slope of flow stress over plastic strain"},
        {"hardening power", "B", "pressure", NOT_NEGATIVE, 0.0, "hardening B e^N"},
        {"hardening power", "N", "1", POSITIVE, 1.0, "exponent of the plastic strain e"},
        {"hardening voce", "Q", "pressure", NOT_NEGATIVE, 0.0, "hardening Q (1 - exp(-BETA e))"},
        {"hardening voce", "BETA", "1", NOT_NEGATIVE, 0.0, "rate of the exponential"},
        {"hardening voce", "HVOCE", "pressure", NOT_NEGATIVE, 0.0, "slope that is added"},
        {"hardening swift", "E0", "1", POSITIVE, 0.0, "strain of SIGMAY (1 + e/E0)^NSWIFT"},
        {"hardening swift", "NSWIFT", "1", POSITIVE, 1.0, "exponent"},
        {"rate cowper/symonds", "RATE", "1/time", POSITIVE, 0.0,
         "plastic strain rate that doubles the flow stress"},
        {"rate cowper/symonds", "P", "1", AT_LEAST_ONE, 1.0, "inverse exponent of the rate"},
        {"rate perzyna", "S", "pressure", POSITIVE, 0.0, "overstress at the rate RATEP"},
        {"rate perzyna", "RATEP", "1/time", POSITIVE, 1.0, "reference plastic strain rate"},
        {"rate perzyna", "M", "1", AT_LEAST_ONE, 1.0, "inverse exponent of the rate"},
        {"kinematic", "C", "pressure", POSITIVE, 0.0, "initial slope of the back stress"},
        {"kinematic", "GAMMA", "1", NOT_NEGATIVE, 0.0, "dynamic recovery, back stress <= C/GAMMA"}};
    static constexpr const char *term = "point";
    static constexpr Parameter term_parameters[] = {
        {"", "E", "1", POSITIVE, REQUIRED, "plastic strain"},
        {"", "SIGMA", "pressure", NOT_NEGATIVE, REQUIRED, "flow stress there"}};
    static constexpr HistoryDeclaration history[] = {
        PLASTIC_STRAIN,
        {"backxx", ZERO, "pressure", "back stress times J"},
        {"backyy", ZERO, "pressure", "back stress times J"},
        {"backzz", ZERO, "pressure", "back stress times J"},
        {"backxy", ZERO, "pressure", "back stress times J"},
        {"backxz", ZERO, "pressure", "back stress times J"},
        {"backyz", ZERO, "pressure", "back stress times J"}};

    static constexpr bool kinematic(const LawParameters &p) { return p.value[J2_BACK_C] > 0.0; }
    static constexpr bool rate(const LawParameters &p)
    {
      return p.value[J2_COWPER_RATE] > 0.0 || p.value[J2_PERZYNA_S] > 0.0;
    }
    static constexpr bool power(const LawParameters &p)
    {
      return p.value[J2_B] > 0.0 || p.value[J2_SWIFT_E0] > 0.0;
    }
    static constexpr bool voce(const LawParameters &p) { return p.value[J2_VOCE_Q] > 0.0; }
    static constexpr int nhistory(const LawParameters &p) { return kinematic(p) ? 7 : 1; }

    static const char *check(const LawParameters &p)
    {
      if (p.nterms > 0 && (power(p) || p.value[J2_H] > 0.0 || voce(p) || p.value[J2_VOCE_H] > 0.0))
        return "points of the flow stress do not go with hardening: use one of them";
      double e = 0.0, y = p.value[J2_SIGMAY];
      for (int k = 0; k < p.nterms; k++) {
        if (!(p.term[k][0] > e)) return "plastic strains of points must increase";
        if (y - p.term[k][1] > 0.5 * p.value[J2_G] * (p.term[k][0] - e))
          return "the flow stress must not fall faster than G/2 between points";
        e = p.term[k][0];
        y = p.term[k][1];
      }
      return nullptr;
    }

    static void update(const LawParameters &p, Batch &b, History history)
    {
      if (kind(p) == HARDENING_LINEAR && !rate(p) && !kinematic(p))
        linear(p, b, history);
      else
        with_flow(p, [&](auto flow) {
          choose_kinematic<typename decltype(flow)::type>(p, b, history);
        });
    }

    static void tangent(const LawParameters &p, Batch &b, History history, Tangent &t)
    {
      if (kinematic(p))
        tangent_of_return<true>(p, b, history, t);
      else
        tangent_of_return<false>(p, b, history, t);
    }

    static void energy(const LawParameters &p, const Batch &b, History history, double *w)
    {
      ShearElasticity::energy(p, b, history, w);
      if (kinematic(p)) back_stress_energy(b, history + 1, p.value[J2_BACK_C], w);
    }

   private:
    /** Kind of hardening: HARDENING_..., or the size of the table. */
    static constexpr int kind(const LawParameters &p)
    {
      if (p.nterms > 0) return p.nterms > SHORT_TABLE ? LONG_TABLE : SHORT_TABLE;
      if (voce(p) || p.value[J2_VOCE_H] > 0.0) return HARDENING_VOCE;
      return power(p) ? HARDENING_POWER : HARDENING_LINEAR;
    }

    /** Carries the type of a flow stress as a value, for use(FlowType<...>()). */
    template <class Flow> struct FlowType {
      using type = Flow;
    };
    /** Calls use() with the type of flow stress that the parameters select. */
    template <class Use> static MPM_INLINE void with_flow(const LawParameters &p, const Use &use)
    {
      switch (kind(p)) {
        case LONG_TABLE:
          return with_rate<LONG_TABLE>(p, use);
        case SHORT_TABLE:
          return with_rate<SHORT_TABLE>(p, use);
        case HARDENING_VOCE:
          return with_rate<HARDENING_VOCE>(p, use);
        case HARDENING_POWER:
          return with_rate<HARDENING_POWER>(p, use);
        default:
          return with_rate<HARDENING_LINEAR>(p, use);
      }
    }
    template <int KIND, class Use>
    static MPM_INLINE void with_rate(const LawParameters &p, const Use &use)
    {
      if (rate(p))
        use(FlowType<J2Flow<KIND, true>>());
      else
        use(FlowType<J2Flow<KIND, false>>());
    }

    template <bool KINEMATIC>
    static void tangent_of_return(const LawParameters &p, Batch &b, History history, Tangent &t)
    {
      const ReturnTangent<KINEMATIC> motion(p.value[J2_BACK_C], p.value[J2_BACK_GAMMA], b,
                                            KINEMATIC ? history + 1 : nullptr);
      FlowOfStep of_step;
      with_flow(p, [&](auto type) {
        using Flow = typename decltype(type)::type;
        Flow flow(p, b);
        MPM_SIMD
        for (int i = 0; i < b.n; i++) {
          const double y = flow.start(history, i), last = Flow::goes_on ? motion.last[i] : 0.0;
          of_step.begin[i] = last > 0.5 * y ? last : y;
        }
      });
      update(p, b, history);
      with_flow(p, [&](auto type) {
        const typename decltype(type)::type flow(p, b);
        MPM_SIMD
        for (int i = 0; i < b.n; i++) {
          const FlowStress f = flow.at_end(history, i, b.plastic[i]);
          of_step.end[i] = f.y;
          of_step.slope[i] = f.dy;
        }
      });
      motion.add(p.value[J2_G], p.chi, of_step, b, t);
    }

    /** Updates with or without a back stress, as the parameters select. */
    template <class Flow>
    static MPM_INLINE void choose_kinematic(const LawParameters &p, Batch &b, History history)
    {
      if (kinematic(p))
        KinematicReturn<Flow>::update(p, p.value[J2_BACK_C], p.value[J2_BACK_GAMMA], b, history,
                                      history + 1);
      else
        RadialReturn<Flow>::update(p, b, history);
    }

    /** Radial return with linear hardening, in closed form. */
    static MPM_INLINE void linear(const LawParameters &p, Batch &b, History history)
    {
      const double G = p.value[J2_G], sigmay = p.value[J2_SIGMAY], H = p.value[J2_H];
      double plastic = 0.0;
      MPM_SIMD_SUM(plastic)
      for (int i = 0; i < b.n; i++) {
        const Increment inc = increment(b, i);
        const Sym s = elastic_trial(G, b, i, inc);
        const double q = std::sqrt(1.5 * norm2(s));
        const double e = history[0][i], y = sigmay + H * e;
        const double J = b.J[i];
        const double D = max(q - y, 0.0) / (3.0 * G / J + H);
        const double ynew = y + H * D;
        store_stress(b, i, (q > y ? ynew / q : 1.0) * s);
        const double work = 0.5 * (J + b.Jold[i]) * 0.5 * (y + ynew) * D;
        history[0][i] = e + D;
        b.plastic[i] = D;
        b.heat[i] += p.chi * work;
        plastic += work * b.vol0[i];
      }
      b.work[PLASTIC] += plastic;
      b.work[HEAT] += p.chi * plastic;
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
