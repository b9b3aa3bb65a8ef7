/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_EOS_JWL_H
#define MPM_LAW_EOS_JWL_H

#include "law/eos.h"

namespace MPM_NS::law {
namespace {

  /** Detonation products after Jones, Wilkins and Lee (E.L. Lee, H.C. Hornig, J.W. Kury, UCRL-50422,
   *  1968), with programmed burn (M.L. Wilkins, UCRL-7322, 1963; E.L. Giroux, HEMP User's Manual,
   *  UCRL-51079, 1973). With the internal energy E per reference volume:
   *
   *    p = f [A (1 - OMEGA/(R1 J)) exp(-R1 J) + B (1 - OMEGA/(R2 J)) exp(-R2 J) + OMEGA E / J]
   *    f = D (t - t_light) / (WIDTH h) within 0 and 1, never decreasing
   *
   *  The detonation reaches a point at t_light: the time of a detonation point plus the distance
   *  from it over D, the earliest of all detonation points, at the position where the point is
   *  made. Without detonation points all has burnt from the start. E is E0 from the start and
   *  changes by the work of the pressure and by heat only: the chemical energy is released once. */
  struct EosJWL : InternalEnergy {
    static constexpr const char *name = "jwl";
    static constexpr const char *meaning = "Jones-Wilkins-Lee detonation products";
    enum { A, B, R1, R2, OMEGA, E0, D, WIDTH };
    static constexpr Parameter parameters[] = {
        {"", "A", "pressure", NOT_NEGATIVE, REQUIRED, "coefficient of the first exponential"},
        {"", "B", "pressure", ANY_NUMBER, REQUIRED, "coefficient of the second exponential"},
        {"", "R1", "1", POSITIVE, REQUIRED, "rate of the first exponential"},
        {"", "R2", "1", POSITIVE, REQUIRED, "rate of the second exponential"},
        {"", "OMEGA", "1", POSITIVE, REQUIRED, "Gruneisen parameter of the products"},
        {"", "E0", "pressure", POSITIVE, REQUIRED, "chemical energy per reference volume"},
        {"", "D", "velocity", POSITIVE, REQUIRED, "detonation velocity"},
        {"width", "WIDTH", "1", POSITIVE, 3.0, "width of the burn in node spacings"}};
    static constexpr const char *term = "detonate";
    static constexpr Parameter term_parameters[] = {
        {"detonate", "X", "length", ANY_NUMBER, REQUIRED, "detonation point"},
        {"detonate", "Y", "length", ANY_NUMBER, REQUIRED, "detonation point"},
        {"detonate", "Z", "length", ANY_NUMBER, REQUIRED, "detonation point"},
        {"detonate", "T", "time", ANY_NUMBER, REQUIRED, "time of its detonation"}};
    static constexpr HistoryDeclaration history[] = {
        internal_energy(E0),
        dissipated,
        {"burn", INITIALIZED, "1", "burn fraction"},
        {"lighting", INITIALIZED, "time", "time at which the detonation arrives"}};
    enum { BURN = HEATED + 1, LIGHTING };
    static void initialize(const LawParameters &p, const double *x, double *history)
    {
      for (int k = 0; k < p.nterms; k++) {
        const double *d = p.term[k];
        const double r2 = (x[0] - d[0]) * (x[0] - d[0]) + (x[1] - d[1]) * (x[1] - d[1]) +
            (x[2] - d[2]) * (x[2] - d[2]);
        const double light = d[3] + std::sqrt(r2) / p.value[D];
        history[LIGHTING] = k == 0 ? light : min(history[LIGHTING], light);
      }
      history[BURN] = p.nterms ? 0.0 : 1.0;
    }

    double a, b, r1, r2, omega;

    explicit EosJWL(const LawParameters &p) :
        a(p.value[A]), b(p.value[B]), r1(p.value[R1]), r2(p.value[R2]), omega(p.value[OMEGA])
    {
    }

    /** Pressure of the products at zero internal energy, and its slope -dp/dJ. */
    MPM_INLINE double cold(double J) const
    {
      return a * (1.0 - omega / (r1 * J)) * exp(-r1 * J) +
          b * (1.0 - omega / (r2 * J)) * exp(-r2 * J);
    }
    MPM_INLINE double slope(double J) const
    {
      const double w = omega / J;
      return a * (r1 - w - w / (r1 * J)) * exp(-r1 * J) +
          b * (r2 - w - w / (r2 * J)) * exp(-r2 * J);
    }

    static void update(const LawParameters &p, Batch &batch, History history)
    {
      const EosJWL eos(p);
      const double time = batch.time, rate = p.value[D] / (p.value[WIDTH] * batch.h);
      MPM_SIMD
      for (int i = 0; i < batch.n; i++) {
        const double J = batch.J[i], Jold = batch.Jold[i], dJ = J - Jold;
        const double Eold = history[ENERGY][i], before = history[BURN][i];
        const double burn = min(max((time - history[LIGHTING][i]) * rate, before), 1.0);
        const double cold = burn * eos.cold(J), gamma = burn * eos.omega / J;
        const double pold = max(before * (eos.cold(Jold) + eos.omega / Jold * Eold), 0.0);
        const double E =
            (Eold - 0.5 * (pold + cold) * dJ + batch.heat[i]) / max(1.0 + 0.5 * gamma * dJ, 0.1);
        const double pressure = cold + gamma * E;
        const bool below = pressure < 0.0;
        subtract_pressure(batch, i, below ? 0.0 : pressure);
        history[ENERGY][i] = below ? Eold - 0.5 * pold * dJ + batch.heat[i] : E;
        history[HEATED][i] += batch.heat[i];
        history[BURN][i] = burn;
      }
    }

    /** Isentropic -J^2 dp/dJ. While the explosive burns at least density_0 D^2: the front is no
     *  slower, and the pressure still has to come. */
    static void modulus(const LawParameters &p, const Batch &batch, History history, double *k)
    {
      const EosJWL eos(p);
      const double front = p.density * p.value[D] * p.value[D];
      MPM_SIMD
      for (int i = 0; i < batch.n; i++) {
        const double J = batch.J[i], E = history[ENERGY][i], burn = history[BURN][i];
        const double gamma = eos.omega / J, pressure = max(burn * (eos.cold(J) + gamma * E), 0.0);
        const double slope = eos.slope(J) + gamma / J * E + gamma * pressure;
        k[i] += max(burn * J * J * slope, burn < 1.0 ? front : 0.0);
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
