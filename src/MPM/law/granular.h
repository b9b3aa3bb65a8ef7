/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_GRANULAR_H
#define MPM_LAW_GRANULAR_H

// Laws of sand, granular flow, and snow.

#include "law/elastoplastic.h"

namespace MPM_NS::law {
namespace {

  /** Elastic-perfectly plastic solid with friction and cohesion (D.C. Drucker, W. Prager, Q. Appl.
   *  Math. 10 (1952) 157), in Kirchhoff stress with pressure p and equivalent stress q:
   *
   *    q <= M p + k,  -p <= TENSION,  flow (volume, shear) = (M_psi, 1) on the cone
   *
   *  M and k are those of a Mohr-Coulomb material. With M = 6 sin(phi)/(3 - sin(phi)) and k = 6 c
   *  cos(phi)/(3 - sin(phi)), the strengths in triaxial compression are equal. With "plane", those
   *  in plane strain are equal for any dilatancy angle: with s = sin(phi), t = sin(psi), and r =
   *  sqrt(1 + t^2/3) / (1 + s t/3), M = sqrt(3) s r, k = sqrt(3) c cos(phi) r, and M_psi = sqrt(3)
   *  t / sqrt(1 + t^2/3).
   *
   *  The return mapping is in closed form: to the cone, the tension plane, or their intersection.
   *  Volume strain that opens at the tension plane is stored as "gap", see close_gap(). */
  struct LawDruckerPrager : HenckyInvariantReturn<LawDruckerPrager> {
    static constexpr const char *name = "drucker/prager";
    static constexpr const char *meaning = "Drucker-Prager plasticity: sand, soil, concrete";
    enum { E, NU, PHI, COHESION, PSI, MEAN_TENSION, PLANE };
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
      return p.value[PSI] <= p.value[PHI] ? nullptr
                                          : "PSI must not exceed PHI, or flow makes energy";
    }

    double M, k, flow, T;

    explicit LawDruckerPrager(const LawParameters &p) : HenckyInvariantReturn(p)
    {
      const double phi = p.value[PHI] * DEGREES, c = p.value[COHESION];
      const double s = std::sin(phi), t = std::sin(p.value[PSI] * DEGREES);
      if (p.value[PLANE] > 0.0) {
        const double root3 = std::sqrt(3.0), root = std::sqrt(1.0 + t * t / 3.0);
        M = root3 * s * root / (1.0 + s * t / 3.0);
        k = root3 * c * std::cos(phi) * root / (1.0 + s * t / 3.0);
        flow = root3 * t / root;
      } else {
        M = 6.0 * s / (3.0 - s);
        k = 6.0 * c * std::cos(phi) / (3.0 - s);
        flow = 6.0 * t / (3.0 - t);
      }
      T = min(min(p.value[MEAN_TENSION], 1e200), k / max(M, 1e-200));
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

  /** Dense granular flow with the friction coefficient mu(I) (P. Jop, Y. Forterre, O. Pouliquen,
   *  Nature 441 (2006) 727), elastic below yield (S. Dunatunga, K. Kamrin, J. Fluid Mech. 779
   *  (2015) 483). With the shear stress t = q/sqrt(3) and the plastic shear rate g = sqrt(2 D:D),
   *
   *    t <= mu(I) p,  mu(I) = mu_s + (mu_2 - mu_s) I/(I0 + I),  I = g d / sqrt(p/rho_s)
   *
   *  at constant volume; rho_s = density/FRACTION is the density of the grains. There is no
   *  tension: grains that separate are free of stress and close up again, see close_gap().
   *
   *  Return mapping: for x = G dt g, the difference of trial and final t, (trial - x - mu_s p) (x +
   *  A) = (mu_2 - mu_s) p x with A = G dt I0 sqrt(p/rho_s)/d is a quadratic equation. */
  struct LawMuI : HenckyInvariantReturn<LawMuI> {
    static constexpr const char *name = "mui";
    static constexpr const char *meaning = "mu(I) rheology of dense granular flow";
    enum { E, NU, MUS, MU2, INERTIAL, DIAMETER, SOLID };
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
      return p.value[MU2] >= p.value[MUS] ? nullptr : "MU2 must not be below MUS";
    }

    double mus, mu2, I0, d, inv_rhos;

    explicit LawMuI(const LawParameters &p) :
        HenckyInvariantReturn(p), mus(p.value[MUS]), mu2(p.value[MU2]), I0(p.value[INERTIAL]),
        d(p.value[DIAMETER]), inv_rhos(p.value[SOLID] / p.density)
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

  /** Snow (A. Stomakhin, C. Schroeder, L. Chai, J. Teran, A. Selle, ACM Trans. Graph. 32 (2013)
   *  102): principal elastic stretches s_a stay between 1 - THETAC and 1 + THETAS, and the rest of
   *  the motion is plastic. With JE the product of s_a and JP = J/JE,
   *
   *    w = h [mu sum (s_a - 1)^2 + lambda/2 (JE - 1)^2],  h = exp(XI (1 - JP))
   *    tau_a = h [2 mu s_a (s_a - 1) + lambda JE (JE - 1)]
   *
   *  Elastic energy that hardening adds at the present strain is taken from the plastic work. The
   *  box of stretches is not a yield surface with associated flow: the plastic work is negative
   *  where snow at THETAS is drawn out under compression from its sides. Limiting the work to
   *  positive values would violate the balance of energy; another direction of flow would be
   *  another law (nacc). */
  struct LawSnow : PrincipalReturn<LawSnow>, LameModuli {
    static constexpr const char *name = "snow";
    static constexpr const char *meaning = "snow with critical compression and stretch";
    enum { E, NU, THETAC, THETAS, XI };
    static constexpr Parameter parameters[] = {
        {"", "E", "pressure", POSITIVE, REQUIRED, "Young's modulus at the start"},
        POISSONS_RATIO,
        {"", "THETAC", "1", {0.0, 0.9, true}, REQUIRED, "critical compression"},
        {"", "THETAS", "1", {0.0, 0.9, true}, REQUIRED, "critical stretch"},
        {"", "XI", "1", NOT_NEGATIVE, REQUIRED, "hardening exponent"}};
    static constexpr HistoryDeclaration history[] = {
        MPM_ELASTIC_STRAIN_HISTORY, {"jplastic", ONE, "1", "plastic volume ratio"}};

    double low, high, xi;

    explicit LawSnow(const LawParameters &p) :
        LameModuli(p), low(std::log1p(-p.value[THETAC])), high(std::log1p(p.value[THETAS])),
        xi(p.value[XI])
    {
    }

    MPM_INLINE double hardening(double JP) const { return exp(xi * (1.0 - JP)); }

    /** Energy for h = 1. s0, s1, s2, dJ: stretches minus one and their product minus one. */
    MPM_INLINE double elastic(double s0, double s1, double s2, double dJ) const
    {
      return mu * (s0 * s0 + s1 * s1 + s2 * s2) + 0.5 * lambda * dJ * dJ;
    }

    /** 2 mu s_a (s_a - 1) for ds = s_a - 1. */
    MPM_INLINE double shear_part(double ds) const { return 2.0 * mu * (1.0 + ds) * ds; }

    MPM_INLINE bool stay_elastic(Batch &b, History history, const Tensors &strain) const
    {
      double outside = 0.0;
      MPM_SIMD_SUM(outside)
      for (int i = 0; i < b.n; i++) {
        const Sym e = load_rows(strain.row, i);
        const double mean = (1.0 / 3.0) * trace(e), bound = eigenvalue_bound(deviator(e));
        outside += max(mean + bound - high, low - (mean - bound)) < 0.0 ? 0.0 : 1.0;
      }
      if (outside > 0.0) return false;
      Tensors stretch;    // minus identity
      exp_minus_identity(b.n, strain.row, stretch.row);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Sym c = load_rows(history, i), y = load_rows(stretch.row, i);
        const double dJ = expm1(trace(load_rows(strain.row, i)));
        const double h = hardening(history[ELASTIC_STRAIN_ROWS][i]) / b.J[i];
        store_stress(b, i,
                     add_diagonal((2.0 * mu * h) * (c + (-1.0) * y), h * lambda * (1.0 + dJ) * dJ));
      }
      return true;
    }

    MPM_INLINE void map(Batch &b, History history, PrincipalStates &s) const
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double e0 = min(max(s.strain[0][i], low), high), flow0 = s.strain[0][i] - e0;
        const double e1 = min(max(s.strain[1][i], low), high), flow1 = s.strain[1][i] - e1;
        const double e2 = min(max(s.strain[2][i], low), high), flow2 = s.strain[2][i] - e2;
        const double volume = flow0 + flow1 + flow2, m = (1.0 / 3.0) * volume;
        const double JP = history[0][i], JPnew = JP * exp(volume);
        const double h0 = hardening(JP), h = hardening(JPnew);
        // stretches minus one; Kirchhoff stresses for h = 1 at start and end
        const double x0 = expm1(s.before[0][i]), x1 = expm1(s.before[1][i]);
        const double x2 = expm1(s.before[2][i]), y0 = expm1(e0), y1 = expm1(e1), y2 = expm1(e2);
        const double dJ = expm1(s.before[0][i] + s.before[1][i] + s.before[2][i]);
        const double dJnew = expm1(e0 + e1 + e2), pv = lambda * (1.0 + dJnew) * dJnew;
        const double t0 = pv + shear_part(y0), t1 = pv + shear_part(y1), t2 = pv + shear_part(y2);
        const double by_old = lambda * (1.0 + dJ) * dJ * volume + shear_part(x0) * flow0 +
            shear_part(x1) * flow1 + shear_part(x2) * flow2;
        const double by_new = t0 * flow0 + t1 * flow1 + t2 * flow2;
        const double w0 = elastic(x0, x1, x2, dJ), w = elastic(y0, y1, y2, dJnew);
        const double square =
            (flow0 - m) * (flow0 - m) + (flow1 - m) * (flow1 - m) + (flow2 - m) * (flow2 - m);
        s.strain[0][i] = e0;
        s.strain[1][i] = e1;
        s.strain[2][i] = e2;
        s.tau[0][i] = h * t0;
        s.tau[1][i] = h * t1;
        s.tau[2][i] = h * t2;
        s.work[i] = 0.5 * (h0 * by_old + h * by_new) - 0.5 * (w0 + w) * (h - h0);
        b.plastic[i] = std::sqrt((2.0 / 3.0) * square);
        history[0][i] = JPnew;
      }
    }

    static void energy(const LawParameters &p, const Batch &b, History history, double *w)
    {
      const LawSnow law(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Sym c = load_rows(history, i);
        const double mean = (1.0 / 3.0) * trace(c), dJ2 = elastic_volume(c);
        const DeviatorRoots root(deviator(c));
        const double pair = mean - 0.5 * root.first;
        w[i] += law.hardening(history[ELASTIC_STRAIN_ROWS][i]) *
            law.elastic(root_minus_1(mean + root.first), root_minus_1(pair + root.half),
                        root_minus_1(pair - root.half), root_minus_1(dJ2));
      }
    }

    /** sqrt(1 + c) - 1 without cancellation. */
    static MPM_INLINE double root_minus_1(double c)
    {
      return c / (1.0 + std::sqrt(max(1.0 + c, 0.0)));
    }

    /** J d sigma_nn / d strain_nn = h (2 mu s_n^2 + lambda JE^2) along a principal axis. */
    static void modulus(const LawParameters &p, const Batch &b, History history, double *k)
    {
      const LawSnow law(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Sym c = load_rows(history, i);
        const double largest = 1.0 + (1.0 / 3.0) * trace(c) + eigenvalue_bound(deviator(c));
        k[i] += law.hardening(history[ELASTIC_STRAIN_ROWS][i]) *
            (2.0 * law.mu * largest + law.lambda * (1.0 + elastic_volume(c)));
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
