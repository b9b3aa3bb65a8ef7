/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_WOVEN_H
#define MPM_LAW_WOVEN_H

#include "law/hyperelastic.h"

namespace MPM_NS::law {
namespace {

  /** Fabric of two families of yarns, warp and weft, that cross at pins. With the stretches lambda
   *  of the yarns and the change gamma of the angle theta between them,
   *
   *    w = E1 <lambda1 - 1>^2/2 + E2 <lambda2 - 1>^2/2 + (integral of M over gamma),
   *    J sigma = sum_k E_k <lambda_k - 1> lambda_k a_k a_k
   *              + M/sin(theta) [a_1 a_2 + a_2 a_1 - cos(theta) (a_1 a_1 + a_2 a_2)]
   *
   *  where a_k are unit vectors along the deformed yarns, which rotate like material lines and do
   *  not stay normal to each other (X.Q. Peng, J. Cao, Composites A 36 (2005) 859; M.J. King, P.
   *  Jearanaisilawong, S. Socrate, Int. J. Solids Struct. 42 (2005) 3867). Yarns bear tension only.
   *  The moment M per reference volume is G gamma, with another modulus beyond the locking angle.
   *  The warp is along axis 1 of the reference configuration, and the weft in the plane of axes 1
   *  and 2. No stress acts across this plane, whatever the stretch normal to it. */
  struct LawWoven : LawDefaults {
    static constexpr const char *name = "woven";
    static constexpr const char *meaning = "fabric of two families of yarns, for surfaces";
    static constexpr bool of_surfaces = true;
    enum { E1, E2, G, THETA, GAMMA, GL };
    static constexpr Parameter parameters[] = {
        {"", "E1", "pressure", POSITIVE, REQUIRED, "stiffness of the warp"},
        {"", "E2", "pressure", POSITIVE, REQUIRED, "stiffness of the weft"},
        {"", "G", "pressure", POSITIVE, REQUIRED, "stiffness against shear"},
        {"angle", "THETA", "degrees", {0.0, 180.0, false}, 90.0, "from warp to weft, at rest"},
        {"locking", "GAMMA", "degrees", POSITIVE, 180.0, "angle of shear of locking"},
        {"locking", "GL", "pressure", NOT_NEGATIVE, 0.0, "stiffness against shear beyond"}};

    static constexpr double DEGREE = 3.14159265358979323846 / 180.0;
    // lower limit of the sine of the angle: the angle of yarns that lie on each other is undefined
    static constexpr double LEAST_SINE = 1e-6;

    double E[2], shear, beyond, lock;
    double c0, s0;    ///< cosine and sine of the angle at rest

    explicit LawWoven(const LawParameters &p) :
        E{p.value[E1], p.value[E2]}, shear(p.value[G]), beyond(p.value[GL]),
        lock(p.value[GAMMA] * DEGREE), c0(std::cos(p.value[THETA] * DEGREE)),
        s0(std::sin(p.value[THETA] * DEGREE))
    {
    }

    /** Stretch and energy of a yarn with the Green-Lagrange strain x, and first and second
     *  derivative of the energy by x. */
    struct Yarn {
      double stretch, energy, first, second;

      MPM_INLINE Yarn(double E, double x)
      {
        const double square = 1.0 + 2.0 * x;
        stretch = std::sqrt(max(square, LEAST_SINE * LEAST_SINE));
        const double longer = max(2.0 * x / (1.0 + stretch), 0.0);
        energy = 0.5 * E * longer * longer;
        first = E * longer / stretch;
        second = x >= 0.0 ? E / (stretch * stretch * stretch) : 0.0;
      }
    };

    /** Angle between the yarns of a point: cosine c, sine s, and change gamma (positive when the
     *  angle becomes smaller). */
    struct Angle {
      double c, s, gamma;

      /** z: a_1 (F^T F - I) a_2 / 2 with the directions at rest; stretches: product of both
       *  stretches. */
      MPM_INLINE Angle(const LawWoven &law, double z, double stretches)
      {
        c = max(-1.0, min(1.0, (law.c0 + 2.0 * z) / stretches));
        s = max(std::sqrt((1.0 - c) * (1.0 + c)), LEAST_SINE);
        gamma = std::atan2(law.s0 * c - law.c0 * s, law.c0 * c + law.s0 * s);
      }
    };

    /** Moment M. */
    MPM_INLINE double moment(double gamma) const
    {
      const double over = excess(gamma);
      return shear * (gamma - over) + beyond * over;
    }
    /** Derivative of M with respect to gamma. */
    MPM_INLINE double slope(double gamma) const { return excess(gamma) == 0.0 ? shear : beyond; }
    /** Part of gamma beyond the locking angle. */
    MPM_INLINE double excess(double gamma) const { return gamma - max(-lock, min(lock, gamma)); }
    /** Energy of shear: integral of M over gamma. */
    MPM_INLINE double sheared(double gamma) const
    {
      const double over = excess(gamma), under = gamma - over;
      return 0.5 * shear * under * under + over * (shear * under + 0.5 * beyond * over);
    }

    /** State of the yarns of a point. */
    struct Point {
      double A[3], B[3];    ///< F a_1 and F a_2, with the directions a_k at rest
      Yarn warp, weft;
      Angle angle;

      MPM_INLINE Point(const LawWoven &law, const Batch &b, int i) : Point(law, b, i, strain(b, i))
      {
      }
      static MPM_INLINE Sym strain(const Batch &b, int i)
      {
        return green_lagrange(displacement(b, i));
      }
      MPM_INLINE Point(const LawWoven &law, const Batch &b, int i, const Sym &e) :
          warp(law.E[0], e.xx),
          weft(law.E[1],
               law.c0 * law.c0 * e.xx + 2.0 * law.c0 * law.s0 * e.xy + law.s0 * law.s0 * e.yy),
          angle(law, law.c0 * e.xx + law.s0 * e.xy, warp.stretch * weft.stretch)
      {
        for (int k = 0; k < 3; k++) {
          A[k] = b.F[3 * k][i];
          B[k] = law.c0 * b.F[3 * k][i] + law.s0 * b.F[3 * k + 1][i];
        }
      }
    };

    static void update(const LawParameters &p, Batch &b, History)
    {
      const LawWoven law(p);
      for (int i = 0; i < b.n; i++) {
        const Point at(law, b, i);
        const double l = at.warp.stretch, m = at.weft.stretch, c = at.angle.c;
        const double M = law.moment(at.angle.gamma) / at.angle.s;
        const double aa = at.warp.first - M * c / (l * l), bb = at.weft.first - M * c / (m * m),
                     ab = M / (l * m), inv = 1.0 / b.J[i];
        const double *const A = at.A, *const B = at.B;
        const auto entry = [&](int j, int k) {
          return inv * (aa * A[j] * A[k] + bb * B[j] * B[k] + ab * (A[j] * B[k] + B[j] * A[k]));
        };
        store_stress(
            b, i, {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)});
      }
    }

    static void energy(const LawParameters &p, const Batch &b, History, double *w)
    {
      const LawWoven law(p);
      for (int i = 0; i < b.n; i++) {
        const Point at(law, b, i);
        w[i] += at.warp.energy + at.weft.energy + law.sheared(at.angle.gamma);
      }
    }

    /** A wave with normal n stretches the yarns by at most sum_k E_k lambda_k^2 (n a_k)^2, taut or
     *  not; the largest value over n is an eigenvalue. Shear adds its larger modulus at small
     *  strain, and the moment adds a term from the rotation of the yarns. */
    static void modulus(const LawParameters &p, const Batch &b, History, double *k)
    {
      const LawWoven law(p);
      const double stiff = max(law.shear, law.beyond);
      for (int i = 0; i < b.n; i++) {
        const Point at(law, b, i);
        const double l = max(at.warp.stretch, 1.0), m = max(at.weft.stretch, 1.0), c = at.angle.c;
        const double one = law.E[0] * l * l, two = law.E[1] * m * m, half = 0.5 * (one - two);
        const double M = std::fabs(law.moment(at.angle.gamma));
        k[i] += 0.5 * (one + two) + std::sqrt(half * half + one * two * c * c) + stiff +
            4.0 * M / at.angle.s;
      }
    }

    /** l tau + tau l^T + F (d2w/dE2 : F^T l F) F^T. */
    static void tangent(const LawParameters &p, Batch &b, History history, Tangent &t)
    {
      update(p, b, history);
      const LawWoven law(p);
      alignas(64) double tau[6][BATCH];
      for (int i = 0; i < b.n; i++) store_rows(tau, i, b.J[i] * load_stress(b, i));
      add_convected(b.n, tau, t);
      for (int i = 0; i < b.n; i++) {
        const Point at(law, b, i);
        const double pp = at.warp.stretch * at.warp.stretch, qq = at.weft.stretch * at.weft.stretch,
                     c = at.angle.c, s = at.angle.s;
        // derivatives of the energy by the cosine, and of that by the strains
        const double M = law.moment(at.angle.gamma), first = M / s,
                     second = law.slope(at.angle.gamma) / (s * s) + M * c / (s * s * s);
        const double r = 2.0 / (at.warp.stretch * at.weft.stretch), cx = -c / pp, cy = -c / qq;
        const double xx = at.warp.second + second * cx * cx + first * 3.0 * c / (pp * pp),
                     yy = at.weft.second + second * cy * cy + first * 3.0 * c / (qq * qq),
                     xy = second * cx * cy + first * c / (pp * qq),
                     xz = second * cx * r - first * r / pp, yz = second * cy * r - first * r / qq,
                     zz = second * r * r;
        const double *const A = at.A, *const B = at.B;
        for (int column = 0; column < 9; column++) {
          if (t.skips(column)) continue;
          const int j = column / 3, k = column % 3;
          const double x = A[j] * A[k], y = B[j] * B[k], z = 0.5 * (A[j] * B[k] + B[j] * A[k]);
          const double dx = xx * x + xy * y + xz * z, dy = xy * x + yy * y + yz * z,
                       dz = 0.5 * (xz * x + yz * y + zz * z);
          for (int m = 0; m < 6; m++) {
            const int u = FIRST[m], v = SECOND[m];
            t.stress[m][column][i] +=
                dx * A[u] * A[v] + dy * B[u] * B[v] + dz * (A[u] * B[v] + B[u] * A[v]);
          }
        }
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
