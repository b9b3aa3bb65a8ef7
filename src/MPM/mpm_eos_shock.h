/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_EOS_SHOCK_H
#define LMP_MPM_EOS_SHOCK_H

#include "mpm_eos.h"

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
   *  Energy: E = E_old - (p_old + p)/2 (J - J_old) + heat, solved together with p, which is linear
   *  in E. One step from the reference state to J lands exactly on the Hugoniot. 1 - S eta is kept
   *  above 0.05, which is a pressure of hundreds of K.
   */
  struct EosShock : LawDefaults {
    static constexpr const char *name = "shock";
    static constexpr const char *meaning = "Mie-Gruneisen with linear shock Hugoniot";
    enum { C0, S, GAMMA0 };
    static constexpr Parameter parameters[] = {
        {"", "C0", "velocity", POSITIVE, REQUIRED, "bulk sound speed at reference density"},
        {"", "S", "1", NOT_NEGATIVE, REQUIRED, "slope dU_s/du_p of the Hugoniot"},
        {"", "GAMMA0", "1", NOT_NEGATIVE, REQUIRED, "Gruneisen parameter at reference density"}};
    static constexpr HistoryDeclaration history[] = {
        {"energy", ZERO, "pressure", "internal energy per reference volume"},
        {"heat", ZERO, "pressure", "part of it that was dissipated"}};
    enum { ENERGY, HEATED };
    static constexpr int nhistory(const LawParameters &) { return 2; }

    double K, s, gamma;

    explicit EosShock(const LawParameters &p) :
        K(p.density * p.value[C0] * p.value[C0]), s(p.value[S]), gamma(p.value[GAMMA0])
    {
    }

    MPM_INLINE double gap(double eta) const { return max(1.0 - s * eta, 0.05); }

    /** Pressure at zero internal energy. */
    MPM_INLINE double cold_pressure(double J) const
    {
      const double eta = 1.0 - J, g = gap(eta);
      return K * eta * (J < 1.0 ? (1.0 - 0.5 * gamma * eta) / (g * g) : 1.0 / J);
    }

    static void update(const LawParameters &p, Batch &b, History history)
    {
      const EosShock eos(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double J = b.J[i], Jold = b.Jold[i], dJ = J - Jold;
        const double Eold = history[ENERGY][i];
        const double cold = eos.cold_pressure(J);
        const double pold = eos.cold_pressure(Jold) + eos.gamma * Eold;
        const double E =
            (Eold - 0.5 * (pold + cold) * dJ + b.heat[i]) / (1.0 + 0.5 * eos.gamma * dJ);
        subtract_pressure(b, i, cold + eos.gamma * E);
        history[ENERGY][i] = E;
        history[HEATED][i] += b.heat[i];
      }
    }

    /** Isentropic -J^2 dp/dJ = J^2 (-(dp/dJ)_E + GAMMA0 p); at least K/100, as the formula loses
     *  its meaning in large tension. */
    static void modulus(const LawParameters &p, const Batch &b, History history, double *k)
    {
      const EosShock eos(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double J = b.J[i], eta = 1.0 - J, g = eos.gap(eta);
        const double ph = eos.K * eta / (g * g);
        const double dph = eos.K * (1.0 + eos.s * eta) / (g * g * g);
        const double squeezed = dph * (1.0 - 0.5 * eos.gamma * eta) - 0.5 * eos.gamma * ph;
        const double slope = J < 1.0 ? squeezed : eos.K / (J * J);
        const double pressure = eos.cold_pressure(J) + eos.gamma * history[ENERGY][i];
        k[i] += max(J * J * (slope + eos.gamma * pressure), 0.01 * eos.K);
      }
    }

    /** Internal energy less the dissipated part, which counts as plastic and viscous work. */
    static void energy(const LawParameters &, const Batch &b, History history, double *w)
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) w[i] += history[ENERGY][i] - history[HEATED][i];
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
