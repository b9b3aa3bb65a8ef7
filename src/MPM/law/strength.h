/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_STRENGTH_H
#define MPM_LAW_STRENGTH_H

#include "law/tangent.h"

namespace MPM_NS::law {
namespace {

  /** Cauchy stress deviator after an elastic step in rate form; see LawLinear. */
  MPM_INLINE Sym elastic_trial(double G, const Batch &b, int i, const Increment &inc)
  {
    const Sym old = b.Jold[i] * deviator(load_stress(b, i));
    return (1.0 / b.J[i]) * jaumann(inc, old, 2.0 * G * deviator(inc.strain));
  }

  /** Deviators of the Kirchhoff stress at the start of the step; call before the update. */
  inline void old_deviators(const Batch &b, double (*old)[BATCH])
  {
    MPM_SIMD
    for (int i = 0; i < b.n; i++) store_rows(old, i, b.Jold[i] * deviator(load_stress(b, i)));
  }

  /** Wave speed and energy of a strength whose first parameter is the shear modulus. */
  struct ShearElasticity : LawDefaults {
    static constexpr bool uses_F = false;
    static constexpr StressShare share = DEVIATOR;

    /** J ds_nn / d epsilon_nn = 4/3 G - J s_nn */
    static void modulus(const LawParameters &p, const Batch &b, History, double *k)
    {
      const double G = p.value[0];
      MPM_SIMD
      for (int i = 0; i < b.n; i++)
        k[i] += (4.0 / 3.0) * G + b.J[i] * eigenvalue_bound(deviator(load_stress(b, i)));
    }

    static void energy(const LawParameters &p, const Batch &b, History, double *w)
    {
      const double G = p.value[0];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double J = b.J[i];
        w[i] += J * J * norm2(deviator(load_stress(b, i))) / (4.0 * G);
      }
    }
  };

  /** Elastic shear without yield. */
  struct StrengthElastic : ShearElasticity {
    static constexpr const char *name = "elastic";
    static constexpr const char *meaning = "elastic shear, no yield";
    static constexpr Parameter parameters[] = {SHEAR_MODULUS};

    static void update(const LawParameters &p, Batch &b, History)
    {
      const double G = p.value[0];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) store_stress(b, i, elastic_trial(G, b, i, increment(b, i)));
    }

    static void tangent(const LawParameters &p, Batch &b, History history, Tangent &t)
    {
      alignas(64) double old[6][BATCH];
      old_deviators(b, old);
      update(p, b, history);
      add_elastic_step(b.n, ElasticStep(b, p.value[0], old), t);
    }
  };

  /** State of a point after the elastic trial step. */
  struct TrialState {
    double q;        ///< equivalent stress
    double stiff;    ///< 3 G/J
    double J;        ///< mean volume ratio of the step
  };

  /** Flow stress y at the end of a step as a function of its plastic strain increment D, its first
   *  two derivatives, and to_kink, the distance of D from the next kink of the function. */
  struct FlowStress {
    double y, dy, ddy, to_kink;
  };

  /** Second-order expansion of c x^n about an x0 > 0 that is the same for all D: c x0^n (1 + n z +
   *  n (n - 1)/2 z^2) with z = (x - x0)/x0. It is constant for |z| > 1/2. */
  struct NearPower {
    alignas(64) double at[BATCH];         ///< c x0^n
    alignas(64) double inverse[BATCH];    ///< 1/x0

    /** Stores value = c x0^n and x0 of point i; returns value. */
    MPM_INLINE double keep(int i, double value, double x0)
    {
      at[i] = value;
      inverse[i] = 1.0 / (x0 + 1e-300);
      return value;
    }
    /** Expansion for the exponent n at x = x0 + change, with derivatives with respect to x. */
    MPM_INLINE FlowStress operator()(int i, double n, double change) const
    {
      const double w = change * inverse[i], z = min(max(w, -0.5), 0.5), half = 0.5 * (n - 1.0);
      const double slope = z == w ? n * at[i] * inverse[i] : 0.0;
      return {at[i] * (1.0 + n * z * (1.0 + half * z)), slope * (1.0 + 2.0 * half * z),
              2.0 * half * slope * inverse[i], UNBOUNDED};
    }
  };

  /** Change of D in a step of third order (E. Halley, 1694) for r(D) = q - stiff D - Y(D) = 0; far
   *  above the root, in a Newton step in log D. */
  MPM_INLINE double third_order_step(const TrialState &t, double D, const FlowStress &f)
  {
    const double r = t.q - t.stiff * D - f.y, s = t.stiff + f.dy, square = 2.0 * s * s;
    const double bent = min(max(square + r * f.ddy, 0.5 * square), 8.0 * square);
    const double far = D * (rough_exp(r / (s * D)) - 1.0), near = 2.0 * r * s / bent;
    return r < -0.5 * s * D ? far : near;
  }

  /** Solves r(D) = 0 without any safeguard; one to three steps are enough for nearly all points.
   *  open: in: 1 for points to solve; out: 1 for points without a solution yet, whose D is only a
   *  guess. Returns the number of open points. With ROUGH, the iteration uses the estimates of Flow
   *  until D has a few digits; all points stay open, and yield is unchanged. */
  template <bool ROUGH, class Flow>
  MPM_INLINE double solve_quickly(const Batch &b, const Flow &flow, History history,
                                  const double *trial, const double *stiff, const double *start,
                                  double *yield, double *D, double *open)
  {
    constexpr int MAX_ITERATIONS = ROUGH ? 6 : 4;
    double busy = 1.0;
    for (int iteration = 0; iteration < MAX_ITERATIONS && busy > 0.0; iteration++) {
      busy = 0.0;
      MPM_SIMD_SUM(busy)
      for (int i = 0; i < b.n; i++) {
        const double d = D[i], safe = max(d, 1e-300), on = open[i];
        const TrialState t{trial[i], stiff[i], 0.5 * (b.J[i] + b.Jold[i])};
        if constexpr (ROUGH) {
          const double step = third_order_step(t, safe, flow.estimate(i, start[i], t, safe));
          D[i] = d > 0.0 ? d + step : d;
          busy += d > 0.0 && step * step > 1e-4 * d * d ? on : 0.0;
        } else {
          const FlowStress f = flow.stress(history, i, start[i], t, safe);
          const double step = third_order_step(t, safe, f), size = max(step, -step);
          // upper bound of the remaining error, since |ddy/D| bounds the third derivative
          const double rest = max(f.ddy, -f.ddy) * size * size * size;
          const double off = max(rest - 1e-14 * f.y * safe, size - min(f.to_kink, 0.1 * safe));
          const double here = off <= 0.0 ? 0.0 : on;    // not a number: stays open
          yield[i] = on > 0.0 ? min(f.y + step * (f.dy + 0.5 * step * f.ddy), t.q) : yield[i];
          D[i] = on > 0.0 ? d + step : d;
          open[i] = here;
          busy += here;
        }
      }
    }
    return busy;
  }

  /** Solves r(D) = q - stiff D - Y(D) = 0 for the points with D > 0, where D is the first guess and
   *  most an upper bound of the solution. Points that solve_quickly() leaves open are solved with a
   *  bracket, all together. r is convex in D for power hardening (n < 1), for logarithmic or power
   *  rate dependence, and for both together, and it is concave in log D. Therefore Newton steps in
   *  D from the left and in log D from the right approach the root from one side only, even with
   *  infinite slope at D = 0 and when D is smaller than any observable strain (small exponents).
   *  The bracket catches all other cases (thermal softening). */
  template <class Flow>
  MPM_INLINE void solve_return(const Batch &b, const Flow &flow, History history,
                               const double *trial, const double *stiff, const double *start,
                               const double *most, double *yield, double *D)
  {
    constexpr int MAX_ITERATIONS = 100;
    alignas(64) double low[BATCH], high[BATCH], open[BATCH], guess[BATCH];
    MPM_SIMD
    for (int i = 0; i < b.n; i++) {
      guess[i] = D[i];
      open[i] = D[i] > 0.0 ? 1.0 : 0.0;
      yield[i] = start[i];    // of points that do not yield, whose work is this times zero
    }
    if constexpr (Flow::estimates)
      solve_quickly<true>(b, flow, history, trial, stiff, start, yield, D, open);
    if (solve_quickly<false>(b, flow, history, trial, stiff, start, yield, D, open) == 0.0) return;
    MPM_SIMD
    for (int i = 0; i < b.n; i++) {
      const double quick = D[i] < most[i] ? D[i] : guess[i];
      D[i] = open[i] > 0.0 ? quick : D[i];
      low[i] = 0.0;
      high[i] = most[i];
    }
    for (int iteration = 0; iteration < MAX_ITERATIONS; iteration++) {
      double busy = 0.0;
      MPM_SIMD_SUM(busy)
      for (int i = 0; i < b.n; i++) {
        const double d = D[i], on = open[i];
        const TrialState t{trial[i], stiff[i], 0.5 * (b.J[i] + b.Jold[i])};
        const FlowStress f = flow.stress(history, i, start[i], t, d);
        const double r = t.q - t.stiff * d - f.y;
        const double s = t.stiff + f.dy;    // -dr/dD
        const double lo = r > 0.0 ? d : low[i], hi = r > 0.0 ? high[i] : d;
        const double newton = r > 0.0 ? d + r / s : d * exp(r / (d * s));
        const double half = 0.5 * (lo + hi);
        const double next = s > 0.0 && newton > lo && newton < hi ? newton : half;
        const bool done = d <= 1e-300 || max(r, -r) <= 1e-13 * f.y + 1e-15 * t.q;
        const double step = done ? 0.0 : next - d;
        low[i] = lo;
        high[i] = hi;
        yield[i] = on > 0.0 ? min(f.y + f.dy * step, t.q) : yield[i];
        D[i] = on > 0.0 ? d + step : d;
        // a small Newton step leaves an error of its square, so that no further iteration is needed
        const double size = max(step, -step) < f.to_kink ? 1e-14 * d * d : 0.0;
        open[i] = step * step > size ? on : 0.0;
        busy += open[i];
      }
      if (busy == 0.0) return;
    }
  }

  /** Kernels of a von Mises strength: radial return to the flow stress at the end of the step (M.L.
   *  Wilkins, Methods Comput. Phys. 3 (1964) 211; J.C. Simo, T.J.R. Hughes, Computational
   *  Inelasticity, 1998, ch. 3), with an unknown increment D of the equivalent plastic strain:
   *
   *    r(D) = q - 3 G/J D - Y(D) = 0,   q = trial equivalent stress
   *
   *  Flow provides:
   *    Flow(parameters, batch)
   *    shear(i), the shear modulus of the step
   *    start(history, i), the flow stress for D -> 0
   *    stress(history, i, start, trial state, D), which returns Y(D)
   *    begin(start, D), the flow stress at the beginning of the step; the plastic work is the mean
   *      of this and Y, times D
   *    estimates; if true, also estimate(i, start, trial state, D), which returns about the same as
   *      stress() with fewer elementary functions, from values that start() has stored
   *    goes_on; selects the argument start, the stress at which plastic flow begins in this step.
   *      false: the result of start(); true: the equivalent stress of the last step, unless it was
   *      far below
   *
   *  First row of the history: the equivalent plastic strain. */
  template <class Flow> struct RadialReturn : ShearElasticity {
    static void update(const LawParameters &p, Batch &b, History history)
    {
      Flow flow(p, b);
      update(flow, p, b, history);
    }
    static void update(Flow &flow, const LawParameters &p, Batch &b, History history)
    {
      alignas(64) double trial[BATCH], stiff[BATCH], start[BATCH], yield[BATCH], D[BATCH];
      alignas(64) double most[BATCH];

      double yielding = 0.0;
      MPM_SIMD_SUM(yielding)
      for (int i = 0; i < b.n; i++) {
        const Increment inc = increment(b, i);
        const double G = flow.shear(i);
        const double last = Flow::goes_on ? equivalent(deviator(load_stress(b, i))) : 0.0;
        const Sym s = elastic_trial(G, b, i, inc);
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

  /** Flow stress with a back stress X/J, for solve_return(). Relative to the elastic trial state of
   *  s - X/J, plastic flow D is resisted by Y, by the growth C g/J of the back stress along the
   *  flow, and by the fading of the old back stress, which turns s - w X/J. */
  template <class Flow> struct KinematicFlow {
    static constexpr bool estimates = Flow::estimates;
    const Flow &flow;
    double C, gamma;
    alignas(64) double trial[BATCH];     ///< equivalent value of xi = s - X/J
    alignas(64) double mixed[BATCH];     ///< 3/2 xi : X/J
    alignas(64) double square[BATCH];    ///< 3/2 X/J : X/J
    alignas(64) double slope[BATCH];     ///< C/J

    KinematicFlow(const Flow &flow, double C, double gamma) : flow(flow), C(C), gamma(gamma) {}

    /** Growth g of the back stress along the flow, divided by C; out: faded = 1 - w. */
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
    MPM_INLINE FlowStress stress(History history, int i, double start, const TrialState t,
                                 double D) const
    {
      return with_back_stress(flow.stress(history, i, start, t, D), i, D);
    }
    MPM_INLINE FlowStress estimate(int i, double start, const TrialState t, double D) const
    {
      return with_back_stress(flow.estimate(i, start, t, D), i, D);
    }
    /** Adds the resistance of the back stress to a flow stress. */
    MPM_INLINE FlowStress with_back_stress(const FlowStress &f, int i, double D) const
    {
      double faded;
      const double g = growth(D, faded), q = equivalent(i, faded), w = 1.0 - faded;
      const double inv = 1.0 / q, fade = mixed[i] + faded * square[i], dq = gamma * w * fade * inv;
      const double ddq = inv * (gamma * gamma * w * (w * square[i] - fade) - dq * dq);
      return {f.y + slope[i] * g + (trial[i] - q), f.dy + slope[i] * w - dq,
              f.ddy - gamma * slope[i] * w - ddq, f.to_kink};
    }
  };

  /** Radial return with the back stress of P.J. Armstrong, C.O. Frederick (CEGB Report RD/B/N731,
   *  1966; Mater. High Temp. 24 (2007) 1), which is linear (W. Prager, Proc. IMechE 169 (1955) 41)
   *  if GAMMA = 0. In addition to its Jaumann rotation, X = J times the back stress changes by
   *
   *    dX = 2/3 C de_p - GAMMA X de,   integrated with constant direction of de_p = de N:
   *    X_new = w X + 2/3 C g N,        w = exp(-GAMMA D), g = (1 - w)/GAMMA
   *
   *  which is exact on straight paths. N is along s_new - X_new/J, and therefore along s - w X/J of
   *  the trial state, so that one equation for D remains. The stored energy is 3/4 X:X/C; the rest
   *  of the plastic work, Y de + 3/2 GAMMA/C X:X de, is dissipated. */
  template <class Flow> struct KinematicReturn : RadialReturn<Flow> {
    static void update(const LawParameters &p, double C, double gamma, Batch &b, History history,
                       History back)
    {
      Flow flow(p, b);
      KinematicFlow<Flow> kinematic(flow, C, gamma);
      alignas(64) double stiff[BATCH], start[BATCH], yield[BATCH], D[BATCH], most[BATCH];

      double yielding = 0.0;
      MPM_SIMD_SUM(yielding)
      for (int i = 0; i < b.n; i++) {
        const Increment inc = increment(b, i);
        const double G = flow.shear(i), inv_J = 1.0 / b.J[i];
        const Sym before = deviator(load_stress(b, i)) + (-1.0 / b.Jold[i]) * load_rows(back, i);
        const double last = Flow::goes_on ? equivalent(before) : 0.0;
        const Sym s = elastic_trial(G, b, i, inc);
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
        // without flow: 0 and 1. A conditional choice of tensors would not vectorize
        const double grown = d > 0.0 ? C * g / q : 0.0, scale = d > 0.0 ? y / q : 1.0;
        const Sym Xnew = kept + grown * xi;
        store_rows(back, i, Xnew);
        store_stress(b, i, inv_J * Xnew + scale * xi);
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

  /** Flow stress of a radial return at the ends of a step, for its tangent. */
  struct FlowOfStep {
    alignas(64) double begin[BATCH];    ///< stress at which plastic flow begins, as in RadialReturn
    alignas(64) double end[BATCH], slope[BATCH];    ///< Y(D) and dY/dD
  };

  /** Consistent tangent of RadialReturn and, with KINEMATIC, of KinematicReturn (J.C. Simo, T.J.R.
   *  Hughes, Computational Inelasticity, 1998, ch. 3.3 and 8; E.A. de Souza Neto, D. Peric, D.R.J.
   *  Owen, Computational Methods for Plasticity, 2008, ch. 7.4), here for Kirchhoff stresses. With
   *  the trial deviator t, the rotated back stress X, and xi = t - w X with equivalent value q, the
   *  step ends with
   *
   *    J s = t - (3 G D/q) xi,   q - 3 G D - J Y(D) - C g(D) = 0,
   *
   *  where t and X depend on the strain and rotation of the step. Construct it before the
   *  update. */
  template <bool KINEMATIC> struct ReturnTangent {
    const double C, gamma;
    alignas(64) double old[6][BATCH], X[6][BATCH];
    alignas(64) double last[BATCH];    ///< old equivalent stress, back stress subtracted

    ReturnTangent(double C, double gamma, const Batch &b, const double (*back)[BATCH]) :
        C(C), gamma(gamma)
    {
      old_deviators(b, old);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double inv = 1.0 / b.Jold[i];
        const Sym s = load_rows(old, i);
        if constexpr (KINEMATIC) {
          const Increment inc = increment(b, i);
          const Sym before = load_rows(back, i);
          store_rows(X, i, rotate(inc, before));
          last[i] = inv * equivalent(s + (-1.0) * before);
        } else {
          last[i] = inv * equivalent(s);
        }
      }
    }

    /** After the update: adds the tangent with the shear modulus G, and that of the heat, the share
     *  chi of the work. */
    void add(double G, double chi, const FlowOfStep &flow, const Batch &b, Tangent &t) const
    {
      const ElasticStep step(b, G, old);
      alignas(64) double xi[6][BATCH], inv_q[BATCH], cross[BATCH], compliance[BATCH];
      alignas(64) double trial[6][BATCH],
          turned[6][BATCH];    // changes of the trial deviator, of X
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double D = b.plastic[i], w = kept(D);
        const Sym x = KINEMATIC ? step.trial(i) + (-w) * load_rows(X, i) : step.trial(i);
        const double inv = 1.0 / max(equivalent(x), 1e-30 * G);
        // derivative of q with respect to D at a given motion
        const double fading = KINEMATIC ? 1.5 * inv * gamma * w * contract(x, load_rows(X, i))
                                        : 0.0;
        const double stiff = 3.0 * G + b.J[i] * flow.slope[i] + (KINEMATIC ? C * w : 0.0) - fading;
        store_rows(xi, i, x);
        inv_q[i] = inv;
        cross[i] = fading;
        compliance[i] = D > 0.0 ? 1.0 / stiff : 0.0;
      }
      for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) {
          if (t.skips(3 * k + l)) continue;
          const double volume = k == l ? 1.0 : 0.0;
          double *const heat = t.heat[3 * k + l];
          step.column(b.n, k, l, trial);
          if constexpr (KINEMATIC) {
            const StepMotion::Columns columns = step.columns(k, l);
            MPM_SIMD
            for (int i = 0; i < b.n; i++)
              store_rows(turned, i, columns(i).spin.of(load_rows(X, i)));
          }
          MPM_SIMD
          for (int i = 0; i < b.n; i++) {
            const double D = b.plastic[i], J = b.J[i], inv = inv_q[i], y = flow.end[i];
            const Sym x = load_rows(xi, i), dt = load_rows(trial, i);
            if constexpr (KINEMATIC) {
              const double w = kept(D), g = growth(D);
              const Sym back = load_rows(X, i), turn = w * load_rows(turned, i);
              const Sym moved = dt + (-1.0) * turn;
              const double dq0 = 1.5 * inv * contract(x, moved);
              const double dD = compliance[i] * (dq0 - volume * J * y), dq = dq0 + cross[i] * dD;
              const Sym fade = (gamma * w * dD) * back, dx = moved + fade;
              const double share = 3.0 * G * inv;
              add_column(t, 3 * k + l, i,
                         dt + (-share * D) * dx + (share * (D * inv * dq - dD)) * x);
              const Sym end = w * back + (C * g * inv) * x;
              const Sym dend = turn + (-1.0) * fade + (C * inv * (w * dD - g * inv * dq)) * x +
                  (C * g * inv) * dx;
              const double recovery = 0.75 * gamma / C;
              heat[i] += chi *
                  (work(flow, b, i, volume, D, dD) +
                   recovery * ((norm2(back) + norm2(end)) * dD + 2.0 * D * contract(end, dend)));
            } else {
              const double dq = 1.5 * inv * contract(x, dt);
              const double dD = compliance[i] * (dq - volume * J * y), share = 3.0 * G * inv;
              add_column(t, 3 * k + l, i,
                         (1.0 - share * D) * dt + (share * (D * inv * dq - dD)) * x);
              heat[i] += chi * work(flow, b, i, volume, D, dD);
            }
          }
        }
    }

   private:
    /** Factor w of the old back stress. */
    MPM_INLINE double kept(double D) const { return KINEMATIC ? 1.0 + expm1(-gamma * D) : 1.0; }
    /** Growth g of the back stress, divided by C. */
    MPM_INLINE double growth(double D) const
    {
      const double faded = -expm1(-gamma * D);
      return gamma > 0.0 ? faded / gamma : D;
    }
    /** Derivative of the plastic work per reference volume. */
    static MPM_INLINE double work(const FlowOfStep &flow, const Batch &b, int i, double volume,
                                  double D, double dD)
    {
      const double mean = 0.5 * (flow.begin[i] + flow.end[i]);
      return 0.5 * volume * b.J[i] * mean * D +
          0.5 * (b.J[i] + b.Jold[i]) * (mean + 0.5 * flow.slope[i] * D) * dD;
    }
  };

  /** Adds the energy that the back stress stores to w[n]. */
  MPM_INLINE void back_stress_energy(const Batch &b, History back, double C, double *w)
  {
    MPM_SIMD
    for (int i = 0; i < b.n; i++) w[i] += 0.75 / C * norm2(load_rows(back, i));
  }

}    // namespace
}    // namespace MPM_NS::law
#endif
