/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_STRENGTH_THERMAL_H
#define MPM_LAW_STRENGTH_THERMAL_H

// Flow stresses of metals that depend on rate and temperature.

#include "law/strength.h"

namespace MPM_NS::law {
namespace {

  enum { JC_G, JC_A, JC_B, JC_N, JC_C, JC_RATE, JC_M, JC_MELT, JC_REF };

  /** Y = (A + B e^N) (1 + C ln max(rate/EPSDOT0, 1)) (1 - T*^M) with plastic strain e, plastic
   *  strain rate and temperature at the end of the step. The temperature rises by the heat of the
   *  plastic work of the step, (Y_start + Y)/2 D, where Y_start is for the old e and T and the
   *  present rate; other heat of the step acts in the next step. */
  template <bool THERMAL> struct JohnsonCookFlow {
    static constexpr bool goes_on = false, estimates = true;
    double G, A, B, N, C, inv_rate;
    double M, soft, Tref, inv_range;    ///< soft: 1, or 0 without thermal softening
    double warm;                        ///< temperature rise per plastic work
    const double *temperature;
    NearPower hardening, softening;

    JohnsonCookFlow(const LawParameters &p, const Batch &b) :
        G(p.value[JC_G]), A(p.value[JC_A]), B(p.value[JC_B]), N(p.value[JC_N]), C(p.value[JC_C]),
        inv_rate(1.0 / max(p.value[JC_RATE] * b.dt, 1e-300)), M(p.value[JC_M]),
        soft(p.value[JC_M] > 0.0 ? 1.0 : 0.0), Tref(p.value[JC_REF]),
        inv_range(1.0 / (p.value[JC_MELT] - p.value[JC_REF])), warm(p.chi * p.warm),
        temperature(MPM_NS::temperature(p, b))
    {
    }

    MPM_INLINE double shear(int) const { return G; }
    /** Homologous temperature T*, within 0 and 1. */
    MPM_INLINE double homologous(double T) const
    {
      return min(max((T - Tref) * inv_range, 0.0), 1.0);
    }
    MPM_INLINE double start(History history, int i)
    {
      const double e = history[0][i], hard = A + hardening.keep(i, B * pow(e, N), e);
      if (!THERMAL) return hard;
      const double t = homologous(temperature[i]);
      return hard * (1.0 - softening.keep(i, soft * pow(t, M), t));
    }

    /** Factor of the rate; out: slope, its derivative with respect to D. */
    MPM_INLINE double rate(double D, double &slope) const
    {
      const double x = D * inv_rate;
      slope = x > 1.0 ? C / D : 0.0;
      return 1.0 + C * log(max(x, 1.0));
    }

    MPM_INLINE FlowStress stress(History history, int i, double start, const TrialState trial,
                                 double D) const
    {
      const double e = history[0][i] + D, inv_e = 1.0 / max(e, 1e-300), power = B * pow(e, N);
      const double hard = A + power, dhard = N * power * inv_e;
      double dfast;
      const double fast = rate(D, dfast), over = D - 1.0 / inv_rate;
      const double y = hard * fast, dy = dhard * fast + hard * dfast;
      // d2 fast/dD2 = -dfast/D
      const double ddy = (N - 1.0) * dhard * inv_e * fast + dfast * (2.0 * dhard - hard / D);
      const double to_kink = max(over, -over);
      if constexpr (!THERMAL) {
        return {y, dy, ddy, to_kink};
      } else {
        const double sigma = trial.q - trial.stiff * D;    // is Y at the solution
        const double half = 0.5 * trial.J * warm;
        const double T = temperature[i] + half * (start * fast + sigma) * D;
        const double dT = half * (start * (fast + dfast * D) + sigma - trial.stiff * D);
        const double ddT = half * (start * dfast - 2.0 * trial.stiff);
        const double t = homologous(T), inv_t = 1.0 / max(t, 1e-300), dt = inv_t * inv_range * dT;
        const double tm = soft * pow(t, M);
        const double changes = t > 0.0 && t < 1.0 ? -M * tm : 0.0;    // in dt
        const double cold = 1.0 - tm, dcold = changes * dt;
        const double ddcold = (M - 1.0) * dcold * dt + changes * inv_t * inv_range * ddT;
        const double u = (T - Tref) * inv_range, v = 1.0 - u, speed = inv_range * max(dT, -dT);
        return {y * cold, dy * cold + y * dcold, ddy * cold + 2.0 * dy * dcold + y * ddcold,
                min(to_kink, min(max(u, -u), max(v, -v)) / max(soft * speed, 1e-300))};
      }
    }

    MPM_INLINE FlowStress estimate(int i, double start, const TrialState trial, double D) const
    {
      const FlowStress h = hardening(i, N, D);
      const double inv = 1.0 / D, hard = A + h.y, x = D * inv_rate;
      const double fast = 1.0 + C * log(max(x, 1.0)), dfast = x > 1.0 ? C * inv : 0.0;
      const double y = hard * fast, dy = h.dy * fast + hard * dfast;
      const double ddy = h.ddy * fast + dfast * (2.0 * h.dy - hard * inv);
      if constexpr (!THERMAL) {
        return {y, dy, ddy, UNBOUNDED};
      } else {
        const double half = 0.5 * inv_range * trial.J * warm;
        const double work = start * fast + trial.q - trial.stiff * D;
        const double dt = half * (work + start * dfast * D - trial.stiff * D);
        const FlowStress m = softening(i, M, half * work * D);
        const double cold = 1.0 - m.y, dcold = -m.dy * dt;
        return {y * cold, dy * cold + y * dcold, ddy * cold + 2.0 * dy * dcold, UNBOUNDED};
      }
    }

    MPM_INLINE double begin(double start, double D) const
    {
      double slope;
      return start * rate(D, slope);
    }
  };

  /** Johnson-Cook flow stress (G.R. Johnson, W.H. Cook, Proc. 7th Int. Symp. Ballistics, The Hague,
   *  1983, p. 541). Rates below EPSDOT0 count as EPSDOT0. */
  struct StrengthJohnsonCook : ShearElasticity {
    static constexpr const char *name = "johnson/cook";
    static constexpr const char *meaning = "Johnson-Cook plasticity with rate and temperature";
    static constexpr Parameter parameters[] = {
        SHEAR_MODULUS,
        {"", "A", "pressure", NOT_NEGATIVE, REQUIRED, "yield stress"},
        {"", "B", "pressure", NOT_NEGATIVE, REQUIRED, "hardening B e^N"},
        {"", "N", "1", POSITIVE, REQUIRED, "exponent of the plastic strain e"},
        {"", "C", "1", NOT_NEGATIVE, REQUIRED, "rate coefficient"},
        {"", "EPSDOT0", "1/time", POSITIVE, REQUIRED, "reference plastic strain rate"},
        {"", "M", "1", NOT_NEGATIVE, 0.0, "exponent of the temperature, 0: no thermal softening"},
        {"", "TMELT", "temperature", ANY_NUMBER, 1.0, "melting temperature"},
        {"", "TREF", "temperature", ANY_NUMBER, 0.0, "reference temperature"}};
    static constexpr HistoryDeclaration history[] = {PLASTIC_STRAIN};
    static constexpr bool needs_temperature(const LawParameters &p) { return p.value[JC_M] > 0.0; }
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[JC_MELT] > p.value[JC_REF] ? nullptr : "TMELT must be above TREF";
    }

    static void update(const LawParameters &p, Batch &b, History history)
    {
      if (needs_temperature(p))
        RadialReturn<JohnsonCookFlow<true>>::update(p, b, history);
      else
        RadialReturn<JohnsonCookFlow<false>>::update(p, b, history);
    }
  };

  enum { SCG_G0, SCG_Y0, SCG_BETA, SCG_N, SCG_YMAX, SCG_A, SCG_B, SCG_PRE };
  enum { SCG_MELT = SCG_PRE + 1, SCG_MELT_A, SCG_MELT_GAMMA, SCG_TREF };

  /** G = G0 f and Y = min(Y0 (1 + BETA (e + EPSI))^N, YMAX) f with
   *
   *    f = 1 + A P J^(1/3) - B (T - TREF)
   *
   *  where pressure P and temperature T are those at the end of the last step, and J =
   *  density_0/density. There is no strength at and above the melting temperature TM = TM0 exp(2 MA
   *  (1 - J)) J^(-2 (MGAMMA - MA - 1/3)). f is kept above LEAST. */
  struct SteinbergState {
    static constexpr double LEAST = 0.01;
    double A, B, melt, a, power, tref;
    const double *temperature;    ///< null: temperature TREF

    SteinbergState(const LawParameters &p, const Batch &b) :
        A(p.value[SCG_A]), B(p.value[SCG_B]),
        melt(p.value[SCG_MELT] > 0.0 ? p.value[SCG_MELT] : UNBOUNDED), a(p.value[SCG_MELT_A]),
        power(-2.0 * (p.value[SCG_MELT_GAMMA] - p.value[SCG_MELT_A] - 1.0 / 3.0)),
        tref(p.value[SCG_TREF]), temperature(MPM_NS::temperature(p, b))
    {
    }
    /** Factor f. log_J: log(J). */
    MPM_INLINE double factor(double pressure, double log_J, double T) const
    {
      return max(1.0 + A * pressure * exp((1.0 / 3.0) * log_J) - B * (T - tref), LEAST);
    }
    /** Is the temperature T at or above the melting temperature? */
    MPM_INLINE bool molten(double J, double log_J, double T) const
    {
      return T >= melt * exp(2.0 * a * (1.0 - J) + power * log_J);
    }
    MPM_INLINE double T(int i) const { return temperature ? temperature[i] : tref; }
  };

  /** Flow stress of StrengthSteinberg for RadialReturn. */
  struct SteinbergFlow {
    static constexpr bool goes_on = true;    // f may fall from step to step
    static constexpr bool estimates = true;
    double G0, Y0, beta, n, ymax, pre;
    alignas(64) double G[BATCH], strong[BATCH];    ///< strong: f, or 0 when molten
    NearPower hardening;

    SteinbergFlow(const LawParameters &p, const Batch &b) :
        G0(p.value[SCG_G0]), Y0(p.value[SCG_Y0]), beta(p.value[SCG_BETA]), n(p.value[SCG_N]),
        ymax(p.value[SCG_YMAX]), pre(p.value[SCG_PRE])
    {
      const SteinbergState state(p, b);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double T = state.T(i), J = b.Jold[i], log_J = log(J);
        const double f = state.factor((-1.0 / 3.0) * trace(load_stress(b, i)), log_J, T);
        G[i] = G0 * f;
        strong[i] = state.molten(J, log_J, T) ? 0.0 : f;
      }
    }
    MPM_INLINE double shear(int i) const { return G[i]; }
    MPM_INLINE double start(History history, int i)
    {
      const double x = 1.0 + beta * (history[0][i] + pre);
      return strong[i] * min(hardening.keep(i, Y0 * pow(x, n), x), ymax);
    }
    MPM_INLINE FlowStress estimate(int i, double, const TrialState, double D) const
    {
      const FlowStress h = hardening(i, n, beta * D);
      const double grows = h.y < ymax ? strong[i] * beta : 0.0;
      return {strong[i] * min(h.y, ymax), grows * h.dy, grows * beta * h.ddy, UNBOUNDED};
    }
    MPM_INLINE FlowStress stress(History history, int i, double, const TrialState, double D) const
    {
      const double x = 1.0 + beta * (history[0][i] + D + pre), hard = Y0 * pow(x, n);
      const double inv = beta / x, slope = n * hard * inv, left = ymax - hard;
      const double grows = left > 0.0 ? strong[i] : 0.0;
      return {strong[i] * min(hard, ymax), grows * slope, grows * (n - 1.0) * slope * inv,
              0.5 * max(left, -left) / max(slope, 1e-300)};
    }
    MPM_INLINE double begin(double start, double) const { return start; }
  };

  /** Strength at high pressure (D.J. Steinberg, S.G. Cochran, M.W. Guinan, J. Appl. Phys. 51 (1980)
   *  1498, eqs. 1, 2 and 4; D.J. Steinberg, UCRL-MA-106439, 1996), in rate form with the present
   *  shear modulus. The elastic energy is then the energy that the stress has stored, a history
   *  variable. */
  struct StrengthSteinberg : RadialReturn<SteinbergFlow> {
    static constexpr const char *name = "steinberg";
    static constexpr const char *meaning = "Steinberg-Cochran-Guinan plasticity, with pressure";
    static constexpr Parameter parameters[] = {
        {"", "G0", "pressure", POSITIVE, REQUIRED, "shear modulus at reference"},
        {"", "Y0", "pressure", NOT_NEGATIVE, REQUIRED, "yield stress at reference"},
        {"", "BETA", "1", NOT_NEGATIVE, REQUIRED, "factor of the plastic strain"},
        {"", "N", "1", NOT_NEGATIVE, REQUIRED, "exponent of hardening"},
        {"", "YMAX", "pressure", POSITIVE, REQUIRED, "limit of hardening, at reference"},
        {"", "A", "1/pressure", NOT_NEGATIVE, REQUIRED, "effect of pressure, G'_P/G0"},
        {"", "B", "1/temperature", NOT_NEGATIVE, REQUIRED, "effect of temperature, -G'_T/G0"},
        {"prestrain", "EPSI", "1", NOT_NEGATIVE, 0.0, "plastic strain before the start",
         OF_NEW_POINTS},
        {"melt", "TM0", "temperature", POSITIVE, 0.0, "melting temperature at reference, 0: none"},
        {"melt", "MA", "1", NOT_NEGATIVE, 0.0, "change of the Gruneisen parameter with volume"},
        {"melt", "MGAMMA", "1", NOT_NEGATIVE, 0.0, "Gruneisen parameter at reference"},
        {"tref", "TREF", "temperature", NOT_NEGATIVE, 300.0, "reference temperature"}};
    static constexpr HistoryDeclaration history[] = {
        PLASTIC_STRAIN, {"shear_energy", ZERO, "pressure", "elastic energy of the deviator"}};
    static constexpr int energy_kept = 1;
    static constexpr bool needs_temperature(const LawParameters &p)
    {
      return p.value[SCG_B] > 0.0 || p.value[SCG_MELT] > 0.0;
    }
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[SCG_YMAX] >= p.value[SCG_Y0] ? nullptr : "YMAX must not be below Y0";
    }

    static void update(const LawParameters &p, Batch &b, History history)
    {
      alignas(64) double before[BATCH];
      SteinbergFlow flow(p, b);
      MPM_SIMD
      for (int i = 0; i < b.n; i++)
        before[i] = b.Jold[i] * b.Jold[i] * norm2(deviator(load_stress(b, i)));
      RadialReturn<SteinbergFlow>::update(flow, p, b, history);
      MPM_SIMD
      for (int i = 0; i < b.n; i++)
        history[1][i] +=
            (b.J[i] * b.J[i] * norm2(load_stress(b, i)) - before[i]) / (4.0 * flow.G[i]);
    }

    static void modulus(const LawParameters &p, const Batch &b, History, double *k)
    {
      const SteinbergState state(p, b);
      const double G0 = p.value[SCG_G0];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Sym s = load_stress(b, i);
        const double G = G0 * state.factor((-1.0 / 3.0) * trace(s), log(b.J[i]), state.T(i));
        k[i] += (4.0 / 3.0) * G + b.J[i] * eigenvalue_bound(deviator(s));
      }
    }

    static void energy(const LawParameters &, const Batch &b, History history, double *w)
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) w[i] += history[1][i];
    }
  };

  enum { ZA_G, ZA_C0, ZA_BCC_C1, ZA_BCC_C3, ZA_BCC_C4, ZA_BCC_C5, ZA_BCC_N };
  enum { ZA_FCC_C2 = ZA_BCC_N + 1, ZA_FCC_C3, ZA_FCC_C4, ZA_MELT, ZA_RATE };

  /** Y = C0 + (C1 + C2 sqrt(e)) exp(-C3 T + C4 T ln(r/RATE)) + C5 e^N with plastic strain e,
   *  plastic strain rate r and temperature T at the end of the step; C2 = 0 (bcc) or C1 = C5 = 0
   *  (fcc). The exponent is at most 0. T rises by the heat of the plastic work of the step,
   *  (Y_begin + Y)/2 D; other heat of the step acts in the next step. */
  struct ZerilliArmstrongFlow {
    static constexpr bool goes_on = true, estimates = true;
    double G, C0, C1, C2, C3, C4, C5, N;
    double inv_rate, melt, warm;    ///< warm: temperature rise per plastic work
    const double *temperature;
    NearPower hardening, root;    ///< C5 e^N, e^(1/2)

    ZerilliArmstrongFlow(const LawParameters &p, const Batch &b) :
        G(p.value[ZA_G]), C0(p.value[ZA_C0]), C1(p.value[ZA_BCC_C1]), C2(p.value[ZA_FCC_C2]),
        C3(p.value[ZA_BCC_C3] + p.value[ZA_FCC_C3]), C4(p.value[ZA_BCC_C4] + p.value[ZA_FCC_C4]),
        C5(p.value[ZA_BCC_C5]), N(p.value[ZA_BCC_N]),
        inv_rate(1.0 / max(p.value[ZA_RATE] * b.dt, 1e-300)),
        melt(p.value[ZA_MELT] > 0.0 ? p.value[ZA_MELT] : UNBOUNDED), warm(p.chi * p.warm),
        temperature(MPM_NS::temperature(p, b))
    {
    }
    MPM_INLINE double shear(int) const { return G; }
    MPM_INLINE double start(History history, int i)
    {
      // at rate 0 there is no thermal stress, except at absolute zero
      const double e = history[0][i], T = temperature[i],
                   square_root = root.keep(i, std::sqrt(e), e);
      const double thermal = T * C4 > 0.0 ? 0.0 : (C1 + C2 * square_root) * exp(-C3 * T);
      const double y = C0 + thermal + hardening.keep(i, C5 * pow(e, N), e);
      return T < melt ? y : 0.0;
    }
    MPM_INLINE FlowStress estimate(int i, double begin, const TrialState t, double D) const
    {
      const FlowStress h = hardening(i, N, D), r = root(i, 0.5, D);
      const double half = 0.5 * t.J * warm, work = begin + t.q - t.stiff * D, inv_D = 1.0 / D;
      const double T = temperature[i] + half * work * D, dT = half * (work - t.stiff * D);
      const double slope = C4 * log(max(D * inv_rate, 1e-300)) - C3, x = slope * T;
      const double height = exp(min(x, 0.0)), thermal = (C1 + C2 * r.y) * height;
      const double below = x < 0.0 ? 1.0 : 0.0, dx = below * (slope * dT + C4 * T * inv_D);
      const double ddx = below * C4 * inv_D * (2.0 * dT - T * inv_D);
      const double rise = C2 * height, solid = temperature[i] < melt ? 1.0 : 0.0;
      return {solid * (C0 + thermal + h.y), solid * (thermal * dx + rise * r.dy + h.dy),
              solid * (thermal * (ddx + dx * dx) + rise * (r.ddy + 2.0 * dx * r.dy) + h.ddy),
              UNBOUNDED};
    }
    MPM_INLINE FlowStress stress(History history, int i, double begin, const TrialState t,
                                 double D) const
    {
      const double e = history[0][i] + D, inv_e = 1.0 / max(e, 1e-300), root = std::sqrt(e);
      const double power = C5 * pow(e, N), dpower = N * power * inv_e;
      const double sigma = t.q - t.stiff * D;    // is Y at the solution
      const double half = 0.5 * t.J * warm;
      const double T = max(temperature[i] + half * (begin + sigma) * D, 0.0);
      const double dT = half * (begin + sigma - t.stiff * D), inv_D = 1.0 / max(D, 1e-300);
      const double slope = C4 * log(max(D * inv_rate, 1e-300)) - C3, x = slope * T;
      const double height = exp(min(x, 0.0)), thermal = (C1 + C2 * root) * height;
      const double below = x < 0.0 ? 1.0 : 0.0, all = slope * dT + C4 * T * inv_D;
      const double dx = below * all;
      const double ddx =
          below * (C4 * inv_D * (2.0 * dT - T * inv_D) - 2.0 * slope * half * t.stiff);
      const double rise = 0.5 * C2 * root * inv_e * height;    // of C2 sqrt(e)
      const double solid = temperature[i] < melt ? 1.0 : 0.0;
      return {solid * (C0 + thermal + power), solid * (thermal * dx + rise + dpower),
              solid *
                  (thermal * (ddx + dx * dx) + rise * (2.0 * dx - 0.5 * inv_e) +
                   (N - 1.0) * dpower * inv_e),
              0.5 * max(x, -x) / max(max(all, -all), 1e-300)};
    }
    MPM_INLINE double begin(double start, double) const { return start; }
  };

  /** Flow stress from thermally activated motion of dislocations (F.J. Zerilli, R.W. Armstrong, J.
   *  Appl. Phys. 61 (1987) 1816, eqs. 9 and 10). If a melting temperature is given, there is no
   *  strength at and above it. */
  struct StrengthZerilliArmstrong : RadialReturn<ZerilliArmstrongFlow> {
    static constexpr const char *name = "zerilli/armstrong";
    static constexpr const char *meaning = "Zerilli-Armstrong plasticity of bcc and fcc metals";
    static constexpr Parameter parameters[] = {
        SHEAR_MODULUS,
        {"", "C0", "pressure", NOT_NEGATIVE, REQUIRED, "athermal stress, with that of grain size"},
        {"form bcc", "C1", "pressure", NOT_NEGATIVE, 0.0, "thermal stress at absolute zero"},
        {"form bcc", "C3", "1/temperature", NOT_NEGATIVE, 0.0, "decay with temperature"},
        {"form bcc", "C4", "1/temperature", NOT_NEGATIVE, 0.0, "effect of the rate"},
        {"form bcc", "C5", "pressure", NOT_NEGATIVE, 0.0, "hardening C5 e^N"},
        {"form bcc", "N", "1", POSITIVE, 1.0, "exponent of the plastic strain e"},
        {"form fcc", "C2", "pressure", POSITIVE, 0.0, "hardening C2 e^(1/2) at absolute zero"},
        {"form fcc", "C3", "1/temperature", NOT_NEGATIVE, 0.0, "decay with temperature"},
        {"form fcc", "C4", "1/temperature", NOT_NEGATIVE, 0.0, "effect of the rate"},
        {"melt", "TMELT", "temperature", POSITIVE, 0.0, "melting temperature, 0: none"},
        {"rate", "RATE", "1/time", POSITIVE, 1.0, "unit of the plastic strain rate, 1/s"}};
    static constexpr HistoryDeclaration history[] = {PLASTIC_STRAIN};
    static constexpr bool needs_temperature(const LawParameters &) { return true; }
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[ZA_BCC_C1] > 0.0 || p.value[ZA_BCC_C5] > 0.0 || p.value[ZA_FCC_C2] > 0.0
          ? nullptr
          : "add 'form bcc' or 'form fcc' with constants that are not zero";
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
