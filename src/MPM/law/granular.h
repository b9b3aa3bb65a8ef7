/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_GRANULAR_H
#define MPM_LAW_GRANULAR_H

#include "law/elastoplastic.h"

namespace MPM_NS::law {
namespace {

  enum { DP_E, DP_NU, DP_PHI, DP_COHESION, DP_PSI, DP_TENSION, DP_PLANE };

  /** Elastic-perfectly plastic solid with friction and cohesion (D.C. Drucker, W. Prager, Q. Appl.
   *  Math. 10 (1952) 157), in Kirchhoff stress with pressure p and equivalent stress q:
   *
   *    q <= M p + k,  -p <= TENSION,  flow (volume, shear) = (M_psi, 1) on the cone
   *
   *  M and k are those of a Mohr-Coulomb material: M = 6 sin(phi)/(3 - sin(phi)) and
   *  k = 6 c cos(phi)/(3 - sin(phi)) make the strengths in triaxial compression equal; with "plane",
   *  those in plane strain are equal for any dilatancy angle: with s = sin(phi), t = sin(psi),
   *  M = sqrt(3) s r and k = sqrt(3) c cos(phi) r, and for the flow M_psi = sqrt(3) t / sqrt(1 +
   *  t^2/3), where r = sqrt(1 + t^2/3) / (1 + s t/3) (below).
   *
   *  Return mapping in closed form: cone, tension plane, their intersection. Volume strain
   *  that opens at the tension plane is kept as "gap", see close_gap().
   */
  struct LawDruckerPrager : HenckyInvariantReturn<LawDruckerPrager> {
    static constexpr const char *name = "drucker/prager";
    static constexpr const char *meaning = "Drucker-Prager plasticity: sand, soil, concrete";
    static constexpr Parameter parameters[] = {
        YOUNGS_MODULUS,
        POISSONS_RATIO,
        {"", "PHI", "degrees", {0.0, 80.0, true}, REQUIRED, "friction angle"},
        {"cohesion", "C", "pressure", NOT_NEGATIVE, 0.0, "cohesion"},
        {"dilatancy", "PSI", "degrees", {0.0, 80.0, true}, 0.0, "dilatancy angle"},
        {"tension", "T", "pressure", NOT_NEGATIVE, UNBOUNDED, "highest mean tension"},
        {"plane", "PLANE", FLAG, FRACTION, 0.0, "equal to Mohr-Coulomb in plane strain"}};
    static constexpr HistoryDeclaration history[] = {
        MPM_ELASTIC_STRAIN_HISTORY,
        PLASTIC_STRAIN,
        {"gap", ZERO, "1", "logarithmic volume strain between separated grains"}};
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[DP_PSI] <= p.value[DP_PHI] ? nullptr
                                                : "PSI must not exceed PHI, or flow makes energy";
    }

    double M, k, flow, T;

    explicit LawDruckerPrager(const LawParameters &p) : HenckyInvariantReturn(p)
    {
      const double phi = p.value[DP_PHI] * DEGREES, c = p.value[DP_COHESION];
      const double s = std::sin(phi), t = std::sin(p.value[DP_PSI] * DEGREES);
      if (p.value[DP_PLANE] > 0.0) {
        const double root3 = std::sqrt(3.0), root = std::sqrt(1.0 + t * t / 3.0);
        M = root3 * s * root / (1.0 + s * t / 3.0);
        k = root3 * c * std::cos(phi) * root / (1.0 + s * t / 3.0);
        flow = root3 * t / root;
      } else {
        M = 6.0 * s / (3.0 - s);
        k = 6.0 * c * std::cos(phi) / (3.0 - s);
        flow = 6.0 * t / (3.0 - t);
      }
      T = min(min(p.value[DP_TENSION], 1e200), k / max(M, 1e-200));
    }

    MPM_INLINE void solve(Batch &b, History history, InvariantStates &s) const
    {
      const double corner = k - M * T;    // q where cone and tension plane meet
      const double inv = 1.0 / (3.0 * G + K * M * flow);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        double gap = history[1][i];
        const double v = close_gap(s.volume[i], gap);
        const double p = -K * v, q = 3.0 * G * s.shear[i];
        const double cone = max(q - M * p - k, 0.0) * inv;    // increment of shear strain
        const double pc = p + K * flow * cone;
        const bool tension = pc < -T;
        const double D = tension ? max(q - corner, 0.0) / (3.0 * G) : cone;
        const double opened = tension ? v - T / K - flow * D : 0.0;
        s.volume[i] = tension ? T / K : v - flow * cone;
        s.shear[i] -= D;
        s.flow[i] = flow * D + opened;
        history[0][i] += D;
        history[1][i] = gap + opened;
      }
    }
  };

  enum { MUI_E, MUI_NU, MUI_S, MUI_2, MUI_I0, MUI_D, MUI_FRACTION };

  /** Dense flow of grains with the friction coefficient mu(I) (P. Jop, Y. Forterre, O. Pouliquen,
   *  Nature 441 (2006) 727), elastic below yield (S. Dunatunga, K. Kamrin, J. Fluid Mech. 779 (2015)
   *  483): with the shear stress t = q/sqrt(3) and the plastic shear rate g = sqrt(2 D:D),
   *
   *    t <= mu(I) p,  mu(I) = mu_s + (mu_2 - mu_s) I/(I0 + I),  I = g d / sqrt(p/rho_s)
   *
   *  at constant volume; rho_s = density/FRACTION is the density of the grains. No tension: grains
   *  that separate are free of stress and close up again, see close_gap().
   *
   *  Return: with x = G dt g the difference of trial and final t, (trial - x - mu_s p) (x + A) =
   *  (mu_2 - mu_s) p x, where A = G dt I0 sqrt(p/rho_s)/d, is a quadratic equation. */
  struct LawMuI : HenckyInvariantReturn<LawMuI> {
    static constexpr const char *name = "mui";
    static constexpr const char *meaning = "mu(I) rheology of dense granular flow";
    static constexpr Parameter parameters[] = {
        {"", "E", "pressure", POSITIVE, REQUIRED, "Young's modulus of the bulk"},
        {"", "NU", "1", POISSON_RATIO, REQUIRED, "Poisson's ratio of the bulk"},
        {"", "MUS", "1", NOT_NEGATIVE, REQUIRED, "friction coefficient at rest"},
        {"", "MU2", "1", NOT_NEGATIVE, REQUIRED, "friction coefficient of fast flow"},
        {"", "I0", "1", POSITIVE, REQUIRED, "inertial number half-way from MUS to MU2"},
        {"", "D", "length", POSITIVE, REQUIRED, "diameter of the grains"},
        {"fraction", "FRACTION", "1", {0.1, 1.0, true}, 0.6, "solid volume fraction at RHO"}};
    static constexpr HistoryDeclaration history[] = {
        MPM_ELASTIC_STRAIN_HISTORY,
        PLASTIC_STRAIN,
        {"gap", ZERO, "1", "logarithmic volume strain between separated grains"},
        {"inertial", ZERO, "1", "inertial number"}};
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[MUI_2] >= p.value[MUI_S] ? nullptr : "MU2 must not be below MUS";
    }

    double mus, mu2, I0, d, inv_rhos;

    explicit LawMuI(const LawParameters &p) :
        HenckyInvariantReturn(p), mus(p.value[MUI_S]), mu2(p.value[MUI_2]), I0(p.value[MUI_I0]),
        d(p.value[MUI_D]), inv_rhos(p.value[MUI_FRACTION] / p.density)
    {
    }

    MPM_INLINE void solve(Batch &b, History history, InvariantStates &s) const
    {
      constexpr double ROOT3 = 1.7320508075688772935;
      const double stiff = G * b.dt, inv_d = 1.0 / d, inv_stiff = 1.0 / max(stiff, 1e-300);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        double gap = history[1][i];
        const double v = close_gap(s.volume[i], gap);
        const double p = max(-K * v, 0.0), opened = max(v, 0.0);
        const double t = ROOT3 * G * s.shear[i];
        const double speed = std::sqrt(p * inv_rhos / b.J[i]);    // of Cauchy pressure
        const double A = stiff * I0 * speed * inv_d;
        const double excess = max(t - mus * p, 0.0), B = t - mu2 * p - A, C = A * excess;
        const double root = std::sqrt(B * B + 4.0 * C);
        const double slow = 2.0 * C / max(root - B, 1e-300), fast = 0.5 * (B + root);
        const double x = excess > 0.0 ? min(B > 0.0 ? fast : slow, t) : 0.0;
        const double D = x / (ROOT3 * G);
        s.volume[i] = v - opened;
        s.shear[i] -= D;
        s.flow[i] = opened;
        history[0][i] += D;
        history[1][i] = gap + opened;
        history[2][i] = speed > 0.0 ? x * inv_stiff * d / speed : 0.0;
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
