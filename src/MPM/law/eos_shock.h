/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_EOS_SHOCK_H
#define MPM_LAW_EOS_SHOCK_H

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
        {"cutoff", "PMIN", "pressure", TENSION, -UNBOUNDED, "lowest pressure, not positive"},
        {"spall", "PSPALL", "pressure", TENSION, -UNBOUNDED,
         "pressure, not positive, below which the material breaks and bears no tension any more"}};
    static constexpr HistoryDeclaration history[] = {
        {"energy", ZERO, "pressure", "internal energy per reference volume"},
        {"heat", ZERO, "pressure", "part of it that was dissipated"},
        {"spalled", ZERO, "1", "1 when the material has broken"}};
    static constexpr int nhistory(const LawParameters &p)
    {
      return p.value[SPALL] > -UNBOUNDED ? 3 : 2;
    }
    static constexpr const char *check(const LawParameters &p)
    {
      return Tension::check(p.value[CUTOFF], p.value[SPALL]);
    }

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

}    // namespace
}    // namespace MPM_NS::law

#endif
