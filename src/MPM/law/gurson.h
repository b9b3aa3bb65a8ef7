/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_GURSON_H
#define MPM_LAW_GURSON_H

#include "law/elastoplastic.h"

namespace MPM_NS::law {
namespace {

  /** Ductile metal with voids (A.L. Gurson, J. Eng. Mater. Technol. 99 (1977) 2; V. Tvergaard, A.
   *  Needleman, Acta Metall. 32 (1984) 157). With the Cauchy mean stress m, equivalent stress q,
   *  porosity f, and the flow stress y = SIGMAY (1 + e/E0)^N of the matrix at its plastic strain e,
   *
   *    (q/y)^2 + 2 Q1 f* cosh(3/2 Q2 m/y) - 1 - (Q1 f*)^2 = 0
   *    f* = f up to FC, then linear to 1/Q1 at FF, where all stress is lost
   *    df = (1 - f) dv + A(e) de,  A = FN/(SN sqrt(2 pi)) exp[-((e - EN)/SN)^2/2] in tension
   *    (1 - f) y de = plastic work per volume
   *
   *  with associated flow; v is the plastic volume strain. The elasticity is Hencky's, in Kirchhoff
   *  stress.
   *
   *  Return mapping (N. Aravas, Int. J. Numer. Meth. Eng. 24 (1987) 1395), implicit in all
   *  variables: Newton's method from a first guess. The guess is the flow at the point where the
   *  path from the old stress to the trial stress meets the surface, or, in large steps, the stress
   *  at that point.
   *
   *  Where Newton's method fails (large steps, points close to failure, voids that vanish), a
   *  search follows. For given y and nucleation the unknown is z = log(f/f0). From z follow v (1 -
   *  f = (1 - f0) exp(-v)), m, and two values of q: by the yield surface and by the direction of
   *  flow. Their difference S changes sign between no volume flow and no mean stress. The root is
   *  first bracketed and then followed by chords, while y and nucleation are found by secants of
   *  the strain of the matrix.
   *
   *  A point that has failed bears pressure only, and only after the volume that opened ("gap") has
   *  closed. */
  struct LawGurson : HenckyInvariantReturn<LawGurson> {
    static constexpr const char *name = "gurson";
    static constexpr const char *meaning = "Gurson-Tvergaard-Needleman: ductile metal with voids";
    enum { YOUNG, POISSON, SIGMAY, F0, E0, N, Q1, Q2, FN, EN, SN, FC, FF };
    static constexpr Range INSIDE = {0.0, 1.0, false};
    static constexpr Parameter parameters[] = {
        YOUNGS_MODULUS,
        POISSONS_RATIO,
        {"", "SIGMAY", "pressure", POSITIVE, REQUIRED, "yield stress of the matrix"},
        {"", "F0", "1", {0.0, 0.5, true}, REQUIRED, "initial porosity", OF_NEW_POINTS},
        {"hardening", "E0", "1", POSITIVE, 1.0, "strain scale of the hardening"},
        {"hardening", "N", "1", FRACTION, 0.0, "exponent of the hardening"},
        {"tvergaard", "Q1", "1", POSITIVE, 1.5, "factor of the porosity"},
        {"tvergaard", "Q2", "1", POSITIVE, 1.0, "factor of the mean stress"},
        {"nucleation", "FN", "1", FRACTION, 0.0, "porosity of all voids that can nucleate"},
        {"nucleation", "EN", "1", NOT_NEGATIVE, 0.3, "mean plastic strain of nucleation"},
        {"nucleation", "SN", "1", POSITIVE, 0.1, "its standard deviation"},
        {"coalescence", "FC", "1", INSIDE, 1.0, "porosity at which voids begin to join"},
        {"coalescence", "FF", "1", INSIDE, 0.0, "porosity at failure"}};
    static constexpr HistoryDeclaration history[] = {
        MPM_ELASTIC_STRAIN_HISTORY,
        {"eplastic", ZERO, "1", "equivalent plastic strain of the matrix"},
        {"porosity", F0, "1", "share of voids in the volume"},
        {"damage", ZERO, "1", "f* Q1, share of the flow stress that is lost, 1: failed"},
        {"gap", ZERO, "1", "logarithmic volume strain that opened after failure"}};
    enum { EPLASTIC, POROSITY, FAILED, GAP };
    static constexpr const char *check(const LawParameters &p)
    {
      const double G = p.value[YOUNG] / (2.0 * (1.0 + p.value[POISSON]));
      if (p.value[FF] > 0.0 && !(p.value[FF] > p.value[FC])) return "FF must be above FC";
      if (p.value[FF] > 0.0 && !(p.value[FC] < 1.0 / p.value[Q1])) return "FC must be below 1/Q1";
      if (!(p.value[F0] * p.value[Q1] < 1.0)) return "F0 must be below 1/Q1";
      return p.value[SIGMAY] * p.value[N] <= 3.0 * G * p.value[E0]
          ? nullptr
          : "SIGMAY N/E0, the slope of the hardening at its start, must not exceed 3 G";
    }

    static constexpr double LEAST = 1e-12;    ///< porosity of a solid without voids
    static constexpr double CLOSE = 1e-2;     ///< |S|/y at which the first bracket ends
    double sigmay, inv_e0, n, q1, q2, fn, en, inv_sn, fc, slope, limit;

    explicit LawGurson(const LawParameters &p) :
        HenckyInvariantReturn(p), sigmay(p.value[SIGMAY]), inv_e0(1.0 / p.value[E0]), n(p.value[N]),
        q1(p.value[Q1]), q2(p.value[Q2]), fn(p.value[FN]), en(p.value[EN]),
        inv_sn(1.0 / p.value[SN]), fc(p.value[FC]), slope(1.0), limit(1.0 / q1)
    {
      if (p.value[FF] > 0.0) slope = (limit - fc) / (p.value[FF] - fc);
    }

    /** Flow stress y of the matrix at the plastic strain e. */
    MPM_INLINE double flow_stress(double e) const
    {
      return sigmay * exp(n * log(1.0 + e * inv_e0));
    }
    /** A condition as a number, 1 or 0: loops vectorize if conditions are combined as numbers. */
    MPM_INLINE double flag(bool x) const { return x ? 1.0 : 0.0; }
    /** Effective porosity f*. */
    MPM_INLINE double effective(double f) const
    {
      return min(f > fc ? fc + slope * (f - fc) : f, limit);
    }
    /** Nucleation rate A at the strain EN + t SN. For a step it is evaluated at the middle of the
     *  strain increment. */
    MPM_INLINE double nucleation(double t) const
    {
      return fn * inv_sn * 0.39894228040143267794 * exp(-0.5 * t * t);
    }

    /** The yield surface at a porosity and a mean stress, in units of the flow stress. */
    struct Surface {
      double q2;        ///< (q/y)^2 on the surface; negative if the mean stress is too large
      double a_sinh;    ///< half the derivative of the yield function by m/y
      double by_f;      ///< derivative of the yield function by the porosity
    };
    /** f: porosity, M: m/y. */
    MPM_INLINE Surface surface(double f, double M) const
    {
      const double fs = effective(f), b = 1.5 * q2;
      // from the magnitude of x, because 1 + less has no digits left where the mean stress is far
      // below zero
      const double x = b * M, less = expm1(min(max(x, -x), 300.0)), inv = 1.0 / (1.0 + less);
      const double size = 0.5 * (less + less * inv), cosh1 = 0.5 * less * less * inv;
      const double sinh = x < 0.0 ? -size : size;
      const double rest = (1.0 - q1 * fs) * (1.0 - q1 * fs) - 2.0 * q1 * fs * cosh1;
      return {rest, q1 * fs * b * sinh,
              2.0 * q1 * (f > fc ? slope : 1.0) * (1.0 - q1 * fs + cosh1)};
    }

    /** State of a point for a trial value of z. */
    struct Guess {
      double f, v, m, q, S;    ///< S: difference of q^2 by surface and by flow, over y
    };
    /** mt, qt: trial stresses; f0: porosity with nucleation; y: flow stress (Kirchhoff). */
    MPM_INLINE Guess guess(double z, double mt, double qt, double f0, double y) const
    {
      Guess g;
      const double grown = f0 * expm1(z);
      // f0 + grown has no digits where voids vanish, while cosh is as large as f is small
      g.f = f0 * exp(z);
      const double v = log1p(grown / (1.0 - g.f)), vmax = mt / K;
      g.v = mt > 0.0 ? min(max(v, 0.0), vmax) : max(min(v, 0.0), vmax);
      g.m = mt - K * g.v;
      const Surface s = surface(g.f, g.m / y);
      g.q = y * std::sqrt(max(s.q2, 0.0));
      // shear flow over volume flow is (q/y)/a_sinh
      const double c = g.v == 0.0 ? 0.0 : 3.0 * G * g.v / max(y * s.a_sinh * g.v, 1e-300) * g.v;
      const double by_flow = qt / (1.0 + c);
      g.S = y * s.q2 - by_flow * by_flow / y;
      return g;
    }

    MPM_INLINE void solve(Batch &b, History history, InvariantStates &s) const
    {
      alignas(64) double mt[BATCH], qt[BATCH], m[BATCH], q[BATCH], f[BATCH], more[BATCH];
      alignas(64) double active[BATCH], open[BATCH];    // more: increment of the matrix strain
      alignas(64) double v[BATCH], D[BATCH];            // plastic volume and shear strain
      const double inv_K = 1.0 / K, inv_G3 = 1.0 / (3.0 * G);
      double yielding = 0.0;
      MPM_SIMD_SUM(yielding)
      for (int i = 0; i < b.n; i++) {
        const double failed = history[FAILED][i] >= 1.0 ? 1.0 : 0.0;
        const double gap = history[GAP][i];
        const double closed = failed * min(gap, max(-s.volume[i], 0.0));
        const double volume = s.volume[i] + closed, opened = failed * max(volume, 0.0);
        const double old = max(history[POROSITY][i], LEAST);
        const double flow = flow_stress(history[EPLASTIC][i]);
        const double inv = 1.0 / flow, invJ = inv / b.J[i];
        const double qn = 3.0 * G * s.shear[i] * invJ, mn = K * volume * invJ;
        const Surface end = surface(old, mn);
        const double out = qn * qn - end.q2;
        const double yields = out > 0.0 ? 1.0 - failed : 0.0;
        mt[i] = K * volume;
        qt[i] = 3.0 * G * s.shear[i];
        history[GAP][i] = failed * (gap - closed + opened);
        s.volume[i] = volume - opened;
        s.shear[i] = failed > 0.0 ? 0.0 : s.shear[i];
        s.flow[i] = opened;
        active[i] = yields;
        more[i] = flow;
        v[i] = end.a_sinh;
        D[i] = out;
        yielding += yields;
      }
      if (yielding == 0.0) return;

      // first guess
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double old = max(history[POROSITY][i], LEAST), e = history[EPLASTIC][i];
        const double flow = more[i], inv = 1.0 / flow, y = b.J[i] * flow, stiff = 1.0 / y;
        const double out = max(D[i], 0.0), mn = stiff * mt[i], qn = stiff * qt[i], an = v[i];
        const double xx = b.stress[0][i], yy = b.stress[1][i], zz = b.stress[2][i];
        const double xy = b.stress[3][i], xz = b.stress[4][i], yz = b.stress[5][i];
        const double m0 = (1.0 / 3.0) * inv * (xx + yy + zz);
        const double dx = xx - yy, dy = yy - zz, dz = zz - xx;
        const double shears = xy * xy + xz * xz + yz * yz;
        const double square = 0.5 * (dx * dx + dy * dy + dz * dz) + 3.0 * shears;
        const double q0 = inv * std::sqrt(square);
        const Surface start = surface(old, m0);

        // where the path from the old stress to the trial stress meets the surface
        const double in = max(start.q2 - q0 * q0, 0.0), t = in / (in + max(out, 1e-300));
        const double Q = q0 + t * (qn - q0), M = m0 + t * (mn - m0);
        const double a = start.a_sinh + t * (an - start.a_sinh);

        // a small step: the flow at that point, with derivatives at the start
        const double strain = (M * a + Q * Q) / (1.0 - old), h = n * inv_e0 / (1.0 + e * inv_e0);
        const double born = mt[i] > 0.0 ? nucleation((e - en) * inv_sn) * strain : 0.0;
        const double falls = stiff * (3.0 * G * Q * (Q + qn) + K * a * (a + an));
        const double hardens = 2.0 * h * (Q * Q + a * M) * strain;
        const double weakens = start.by_f * ((1.0 - old) * a + born);
        const double flows = out / max(falls + hardens - weakens, 0.5 * falls);
        // a large step: the stress at that point
        const double most = inv_K * mt[i], all = inv_G3 * qt[i], large = out < 4.0 ? 0.0 : 1.0;
        const double v1 = large > 0.0 ? most - inv_K * y * M : flows * a;
        const double D1 = large > 0.0 ? all - inv_G3 * y * Q : flows * Q;
        const double opens = max(most, 0.0), closes = max(most - opens, -0.5 * old);
        const double vi = max(min(v1, opens), closes), Di = min(max(D1, 0.0), all);
        const double work = (mt[i] - K * vi) * vi + (qt[i] - 3.0 * G * Di) * Di;
        v[i] = vi;
        D[i] = Di;
        more[i] = max(work / ((1.0 - old) * y), 0.0);
      }

      const double left = newton(b, history, mt, qt, active, v, D, more, m, q, f, open);
      if (left > 0.0) search(b, history, mt, qt, open, m, q, f, more);

      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double yields = active[i], fs = effective(f[i]), trial = inv_K * mt[i];
        const double fails = fs < limit ? 0.0 : yields;
        const double damage = fails > 0.0 ? 1.0 : min(q1 * fs, 1.0 - 1e-15);
        const double shear = fails > 0.0 ? 0.0 : inv_G3 * min(q[i], qt[i]);
        const double v = fails > 0.0 ? max(trial, 0.0) : trial - inv_K * m[i];
        history[EPLASTIC][i] += yields > 0.0 ? more[i] : 0.0;
        history[POROSITY][i] = yields > 0.0 ? f[i] : history[POROSITY][i];
        history[FAILED][i] = yields > 0.0 ? damage : history[FAILED][i];
        s.shear[i] = yields > 0.0 ? shear : s.shear[i];
        s.flow[i] = yields > 0.0 ? v : s.flow[i];
        s.volume[i] = yields > 0.0 ? trial - v : s.volume[i];
      }
    }

   private:
    /** Newton's method for the plastic volume strain v, the plastic shear strain D, and the
     *  increment w of the matrix strain. With M = m/y, Q = q/y, and a, half the derivative of the
     *  yield function by M,
     *
     *    Q^2 - surface(f, M) = 0,   D a - v Q = 0,   (1 - f) w - M v - Q D = 0
     *
     *  In: v, D, w are a first guess. Out: the solution with m, q, f; open is 1 for points without
     *  a reliable solution. Returns the number of these points. */
    [[gnu::noinline]] double newton(const Batch &b, History history, const double *mt,
                                    const double *qt, const double *active, double *v, double *D,
                                    double *w, double *m, double *q, double *f, double *open) const
    {
      alignas(64) double good[BATCH];
      const double inv_K = 1.0 / K, G3 = 3.0 * G, inv_G3 = 1.0 / G3, bq = 1.5 * q2;
      const double range = 2.0 / (bq * K);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        open[i] = active[i];
        good[i] = 0.0;
      }
      double busy = 1.0;
      for (int iteration = 0; iteration < 12 && busy > 0.0; iteration++) {
        busy = 0.0;
        MPM_SIMD_SUM(busy)
        for (int i = 0; i < b.n; i++) {
          const double vi = v[i], Di = D[i], wi = w[i], e = history[EPLASTIC][i];
          const double E = 1.0 + (e + wi) * inv_e0;
          const double y = b.J[i] * sigmay * exp(n * log(E)), inv = 1.0 / (y * E), s = inv * E;
          const double k = K * s, g = G3 * s, h = n * inv_e0 * inv * y;
          const double M = s * mt[i] - k * vi, Q = s * qt[i] - g * Di;

          const double t = (e + 0.5 * wi - en) * inv_sn;
          const double density = mt[i] > 0.0 ? nucleation(t) : 0.0;
          const double begin = max(history[POROSITY][i], LEAST) + density * wi;
          const double fall = expm1(-vi), fi = begin - (1.0 - begin) * fall, solid = 1.0 - fi;
          const double f_w = (1.0 + fall) * density * (1.0 - 0.5 * inv_sn * t * wi);

          // yield function and its derivatives, as in surface()
          const double fs = fi > fc ? fc + slope * (fi - fc) : fi, ds = fi > fc ? slope : 1.0;
          const double less = expm1(min(bq * max(M, -M), 300.0)), inv_exp = 1.0 / (1.0 + less);
          const double half = 0.5 * (less + less * inv_exp), cosh1 = 0.5 * less * less * inv_exp;
          const double sinh = M < 0.0 ? -half : half;
          const double c = 1.0 - q1 * fs, rest = c * c - 2.0 * q1 * fs * cosh1;
          const double rest_f = -2.0 * q1 * ds * (c + cosh1);
          const double a = q1 * fs * bq * sinh, a_f = q1 * ds * bq * sinh;
          const double a_M = q1 * fs * bq * bq * (1.0 + cosh1);

          const double R1 = Q * Q - rest, R2 = Di * a - vi * Q, R3 = solid * wi - M * vi - Q * Di;
          const double R1v = -rest_f * solid - 2.0 * a * k, R1D = -2.0 * Q * g;
          const double R1w = -2.0 * Q * Q * h - rest_f * f_w - 2.0 * a * M * h;
          const double R2v = Di * (a_f * solid - a_M * k) - Q, R2D = a + vi * g;
          const double R2w = Di * (a_f * f_w - a_M * M * h) + vi * Q * h;
          const double R3v = k * vi - solid * wi - M, R3D = g * Di - Q;
          const double R3w = solid - f_w * wi + h * (M * vi + Q * Di);

          // w eliminated
          const double A11 = R1v * R3w - R1w * R3v, A12 = R1D * R3w - R1w * R3D;
          const double A21 = R2v * R3w - R2w * R3v, A22 = R2D * R3w - R2w * R3D;
          const double B1 = R1 * R3w - R1w * R3, B2 = R2 * R3w - R2w * R3;
          const double det = A11 * A22 - A12 * A21, r = 1.0 / (det * R3w);
          const double dv = r * R3w * (A12 * B2 - B1 * A22), dD = r * R3w * (A21 * B1 - A11 * B2);
          const double dw = -r * det * (R3 + R3v * dv + R3D * dD);

          // the remaining error of the step is of the order of the squares of these
          const double size2 = g * g * Di * Di + k * k * vi * vi;
          const double miss = R1 * R1, flow2 = Di * Di * a * a + vi * vi * Q * Q;
          const double off1 = max(miss - 1e-12, miss * miss - max(1e-18 * size2, 1e-300));
          const double off2 = R2 * R2 - (1e-12 * flow2 + 1e-30 * Di * Di * Q * Q);
          const double off3 = R3 * R3 - 1e-12 * solid * solid * wi * wi;
          const double near = flag(off1 < 0.0) * flag(off2 <= 0.0) * flag(off3 <= 0.0);
          const double sure = flag(fi > 1e-3 * begin) * flag(fs < limit) * flag(Q >= 0.0);

          // the argument of cosh changes by no more than 2, and some porosity stays
          const double most = range * y, least = max(-most, -0.8 * fi / solid);
          const double v1 = vi + min(max(dv, least), most), all = inv_K * mt[i];
          const double v2 = max(min(v1, max(all, 0.0)), min(all, 0.0));
          const double D1 = min(max(Di + dD, 0.0), inv_G3 * qt[i]), w1 = max(wi + dw, 0.0);
          const double here = open[i], good_now = near * sure * flag(vi * M >= 0.0);
          v[i] = here > 0.0 ? v2 : vi;
          D[i] = here > 0.0 ? D1 : Di;
          w[i] = here > 0.0 ? w1 : wi;
          good[i] += here * good_now;
          open[i] = here * (1.0 - near);
          busy += open[i];
        }
      }
      double left = 0.0;
      MPM_SIMD_SUM(left)
      for (int i = 0; i < b.n; i++) {
        const double t = (history[EPLASTIC][i] + 0.5 * w[i] - en) * inv_sn;
        const double begin =
            max(history[POROSITY][i], LEAST) + (mt[i] > 0.0 ? nucleation(t) : 0.0) * w[i];
        f[i] = begin - (1.0 - begin) * expm1(-v[i]);
        m[i] = mt[i] - K * v[i];
        q[i] = qt[i] - G3 * D[i];
        open[i] = active[i] > good[i] ? 1.0 : 0.0;
        left += open[i];
      }
      return left;
    }

    /** The slow but safe search for the points that are open, see the description of the law. */
    [[gnu::noinline]] void search(const Batch &b, History history, const double *mt,
                                  const double *qt, double *open, double *m, double *q, double *f,
                                  double *more) const
    {
      alignas(64) double f0[BATCH], y[BATCH], z[BATCH], chord[BATCH], w[BATCH], active[BATCH];
      alignas(64) double last[BATCH], missed[BATCH], end[BATCH];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        f0[i] = max(history[POROSITY][i], LEAST);
        y[i] = b.J[i] * flow_stress(history[EPLASTIC][i]);
        active[i] = open[i];    // a finished point stays as it is while others iterate
        z[i] = w[i] = chord[i] = last[i] = missed[i] = 0.0;
      }
      bracket(b, mt, qt, f0, y, open, z, chord, end, CLOSE);
      double busy = 1.0;
      for (int iteration = 0; iteration < 30 && busy > 0.0; iteration++) {
        busy = 0.0;
        MPM_SIMD_SUM(busy)
        for (int i = 0; i < b.n; i++) {
          const double low = min(0.0, end[i]), high = max(0.0, end[i]);
          const double first = iteration > 0 ? guess(z[i], mt[i], qt[i], f0[i], y[i]).S : 0.0;
          const double zi = min(max(z[i] - first * chord[i], low), high);
          const Guess g = guess(zi, mt[i], qt[i], f0[i], y[i]);
          const double fall = g.S - first;
          const double slope = max(first, -first) > 1e-9 * y[i] && fall != 0.0 ? (zi - z[i]) / fall
                                                                               : chord[i];
          const double way = slope * chord[i] > 0.0 ? slope : chord[i], rest = g.S * way;

          // increment of the matrix strain from the plastic work, compared with the one used for y
          const double D = (qt[i] - g.q) / (3.0 * G);
          const double work = max((g.m * g.v + g.q * D) / ((1.0 - g.f) * y[i]), 0.0);
          const double r = w[i] - work, change = w[i] - last[i];
          const double secant = iteration > 0 && change != 0.0 ? (r - missed[i]) / change : 1.0;
          const double next = max(w[i] - r / (secant > 0.3 ? secant : 1.0), 0.0);
          const double here = open[i], off1 = max(r, -r) - 1e-12 * (w[i] + 1e-6);
          const double off2 = max(rest, -rest) - (1e-11 * (high - low) + 1e-15);
          const double go = max(off1, off2) > 0.0 ? here : 0.0;

          const double e = history[EPLASTIC][i], old = max(history[POROSITY][i], LEAST);
          const double middle = (e + 0.5 * next - en) * inv_sn;
          const double born = mt[i] > 0.0 ? nucleation(middle) * next : 0.0;
          last[i] = w[i];
          missed[i] = r;
          z[i] = go > 0.0 ? min(max(zi - rest, low), high) : here > 0.0 ? zi : z[i];
          w[i] = go > 0.0 ? next : w[i];
          y[i] = go > 0.0 ? b.J[i] * flow_stress(e + next) : y[i];
          f0[i] = go > 0.0 ? min(old + born, 0.999) : f0[i];
          chord[i] = way;
          open[i] = go;
          busy += open[i];
        }
      }
      // after large steps, y and nucleation of the remaining points are kept as they are
      if (busy > 0.0) bracket(b, mt, qt, f0, y, open, z, chord, end, 1e-13);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Guess g = guess(z[i], mt[i], qt[i], f0[i], y[i]);
        const bool here = active[i] > 0.0;
        m[i] = here ? g.m : m[i];
        q[i] = here ? g.q : q[i];
        f[i] = here ? g.f : f[i];
        more[i] = here ? w[i] : more[i];
      }
    }

    /** z at which S vanishes, between no volume flow (S < 0) and no mean stress (S > 0), until |S|
     *  < close y, and the inverse slope (chord) there: false position (Illinois method) with
     *  bisections. end: z without mean stress. */
    [[gnu::noinline]] void bracket(const Batch &b, const double *mt, const double *qt,
                                   const double *f0, const double *y, const double *active,
                                   double *z, double *chord, double *end, double close) const
    {
      alignas(64) double za[BATCH], zb[BATCH], Sa[BATCH], Sb[BATCH], side[BATCH], open[BATCH];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double far = -expm1(-mt[i] / K) / f0[i] + exp(-mt[i] / K);    // all volume flows
        za[i] = 0.0;
        zb[i] = log(min(max(far, 1e-280), (1.0 - 1e-9) / f0[i]));
        end[i] = zb[i];
        Sa[i] = guess(za[i], mt[i], qt[i], f0[i], y[i]).S;
        Sb[i] = guess(zb[i], mt[i], qt[i], f0[i], y[i]).S;
        z[i] = active[i] > 0.0 ? za[i] : z[i];
        side[i] = 0.0;
        open[i] = active[i];
      }
      for (int iteration = 0; iteration < 60; iteration++) {
        double busy = 0.0;
        const double regular = flag(iteration % 4 != 3);
        MPM_SIMD_SUM(busy)
        for (int i = 0; i < b.n; i++) {
          const double span = Sb[i] - Sa[i], cut = span > 0.0 ? -Sa[i] / span : 0.5;
          const double inside = flag(cut > 0.0) * flag(cut < 1.0) * regular;
          const double t = inside > 0.0 ? cut : 0.5;
          const double next = za[i] + t * (zb[i] - za[i]);
          const double S = guess(next, mt[i], qt[i], f0[i], y[i]).S;
          const double here = open[i], now = S < 0.0 ? -1.0 : 1.0;
          const double repeat = now == side[i] ? 0.5 : 1.0;
          const double wide = max(zb[i] - za[i], za[i] - zb[i]) > 1e-14 ? here : 0.0;
          Sa[i] = S < 0.0 ? S : repeat * Sa[i];
          Sb[i] = S < 0.0 ? repeat * Sb[i] : S;
          za[i] = S < 0.0 ? next : za[i];
          zb[i] = S < 0.0 ? zb[i] : next;
          side[i] = now;
          z[i] = here > 0.0 ? next : z[i];
          open[i] = max(S, -S) > close * y[i] ? wide : 0.0;
          busy += open[i];
        }
        if (busy == 0.0) break;
      }
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double d = 1e-6 * end[i], up = z[i] + d;
        const double S = guess(z[i], mt[i], qt[i], f0[i], y[i]).S;
        const double S1 = guess(up, mt[i], qt[i], f0[i], y[i]).S;
        chord[i] = S1 != S ? (up - z[i]) / (S1 - S) : 0.0;
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
