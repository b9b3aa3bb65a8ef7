/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_EOS_LINEAR_IN_ENERGY_H
#define MPM_LAW_EOS_LINEAR_IN_ENERGY_H

#include "law/eos.h"

namespace MPM_NS::law {
namespace {

  /** Mie-Gruneisen with the shock Hugoniot U_s = C0 + S u_p (M.H. Rice, R.G. McQueen, J.M. Walsh,
   *  Solid State Physics 6 (1958) 1; M.L. Wilkins, Computer Simulation of Dynamic Phenomena, 1999),
   *  with density * Gruneisen parameter constant. With eta = 1 - J, E the internal energy per
   *  reference volume and K = density_0 C0^2:
   *
   *    compression  p = p_H (1 - GAMMA0 eta / 2) + GAMMA0 E,   p_H = K eta / (1 - S eta)^2
   *    tension      p = K (1/J - 1) + GAMMA0 E
   *
   *  1 - S eta is kept above 0.05, which is a pressure of hundreds of K. */
  struct EosShock : LinearInEnergy<EosShock> {
    static constexpr const char *name = "shock";
    static constexpr const char *meaning = "Mie-Gruneisen with linear shock Hugoniot";
    enum { C0, S, GAMMA0, CUTOFF, SPALL };
    static constexpr Parameter parameters[] = {
        {"", "C0", "velocity", POSITIVE, REQUIRED, "bulk sound speed at reference density"},
        {"", "S", "1", NOT_NEGATIVE, REQUIRED, "slope dU_s/du_p of the Hugoniot"},
        {"", "GAMMA0", "1", NOT_NEGATIVE, REQUIRED, "Gruneisen parameter at reference density"},
        cutoff,
        spall};
    static constexpr HistoryDeclaration history[] = {internal_energy(ZERO), dissipated, spalled};

    double K, s, gamma0, least;
    Tension tension;

    explicit EosShock(const LawParameters &p) :
        K(p.density * p.value[C0] * p.value[C0]), s(p.value[S]), gamma0(p.value[GAMMA0]),
        least(LEAST_MODULUS * K), tension(p.value[CUTOFF], p.value[SPALL])
    {
    }

    MPM_INLINE double gap(double eta) const { return max(1.0 - s * eta, 0.05); }
    MPM_INLINE double gamma(double) const { return gamma0; }

    MPM_INLINE double cold(double J) const
    {
      const double eta = 1.0 - J, g = gap(eta);
      return K * eta * (J < 1.0 ? (1.0 - 0.5 * gamma0 * eta) / (g * g) : 1.0 / J);
    }

    MPM_INLINE double slope(double J, double) const
    {
      const double eta = 1.0 - J, g = gap(eta);
      const double ph = K * eta / (g * g);
      const double dph = K * (1.0 + s * eta) / (g * g * g);
      const double squeezed = dph * (1.0 - 0.5 * gamma0 * eta) - 0.5 * gamma0 * ph;
      return J < 1.0 ? squeezed : K / (J * J);
    }
  };

  /** Polynomial in mu = density/density_0 - 1, with the internal energy E per reference volume: the
   *  linear polynomial of hydrocodes (J.O. Hallquist, LS-DYNA Theory Manual, 2006, chapter on
   *  equations of state) with coefficients of its own in tension, as in AUTODYN:
   *
   *    compression  p = A1 mu + A2 mu^2 + A3 mu^3 + (B0 + B1 mu) E
   *    tension      p = T1 mu + T2 mu^2 + B0 E
   */
  struct EosPolynomial : LinearInEnergy<EosPolynomial> {
    static constexpr const char *name = "polynomial";
    static constexpr const char *meaning = "polynomial in density, linear in energy";
    enum { A1, A2, A3, B0, B1, T1, T2, E0, CUTOFF, SPALL };
    static constexpr Parameter parameters[] = {
        {"", "A1", "pressure", POSITIVE, REQUIRED, "bulk modulus"},
        {"", "A2", "pressure", ANY_NUMBER, REQUIRED, "coefficient of the square in compression"},
        {"", "A3", "pressure", ANY_NUMBER, REQUIRED, "coefficient of the cube in compression"},
        {"", "B0", "1", NOT_NEGATIVE, REQUIRED, "coefficient of the energy"},
        {"", "B1", "1", ANY_NUMBER, REQUIRED, "coefficient of mu times energy in compression"},
        {"", "T1", "pressure", NOT_NEGATIVE, 0.0, "linear coefficient in tension, 0: A1"},
        {"", "T2", "pressure", ANY_NUMBER, 0.0, "coefficient of the square in tension"},
        {"energy", "E0", "pressure", NOT_NEGATIVE, 0.0, "initial energy per reference volume"},
        cutoff,
        spall};
    static constexpr HistoryDeclaration history[] = {internal_energy(E0), dissipated, spalled};

    double a1, a2, a3, b0, b1, t1, t2, least;
    Tension tension;

    explicit EosPolynomial(const LawParameters &p) :
        a1(p.value[A1]), a2(p.value[A2]), a3(p.value[A3]), b0(p.value[B0]), b1(p.value[B1]),
        t1(p.value[T1] > 0.0 ? p.value[T1] : a1), t2(p.value[T2]), least(LEAST_MODULUS * a1),
        tension(p.value[CUTOFF], p.value[SPALL])
    {
    }

    MPM_INLINE double gamma(double J) const { return b0 + b1 * max((1.0 - J) / J, 0.0); }

    MPM_INLINE double cold(double J) const
    {
      const double mu = (1.0 - J) / J;
      const double squeezed = a1 + mu * (a2 + mu * a3), stretched = t1 + mu * t2;
      return mu * (J < 1.0 ? squeezed : stretched);
    }

    MPM_INLINE double slope(double J, double E) const
    {
      const double mu = (1.0 - J) / J;
      const double squeezed = a1 + mu * (2.0 * a2 + 3.0 * mu * a3) + b1 * E;
      const double stretched = t1 + 2.0 * mu * t2;
      return (J < 1.0 ? squeezed : stretched) / (J * J);
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
