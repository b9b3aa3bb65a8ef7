/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_DAMAGE_GRADY_KIPP_H
#define MPM_LAW_DAMAGE_GRADY_KIPP_H

#include "law/damage.h"
#include "law/math.h"

namespace MPM_NS::law {
namespace {

  /** Dynamic fragmentation (D.E. Grady, M.E. Kipp, Int. J. Rock Mech. Min. Sci. 17 (1980) 147): K e^M
   *  flaws per volume grow with velocity CG at the tensile strain e = sigma_1/E,
   *
   *    d(D^(1/3))/dt = (M + 3)/3 alpha^(1/3) e^(M/3),
   *    alpha = 8 pi CG^3 K / [(M + 1) (M + 2) (M + 3)]
   *
   *  At constant strain rate D = alpha rate^M t^(M+3), and fragments have the size 6 CG t/(M + 2)
   *  with the time t under tension until D = 1 (also H.J. Melosh, E.V. Ryan, E. Asphaug,
   *  J. Geophys. Res. 97 (1992) 14735). The strain is that of the end of the step. */
  struct DamageGradyKipp : ScalarDamage<DamageGradyKipp> {
    static constexpr const char *name = "grady/kipp";
    static constexpr const char *meaning = "dynamic fragmentation by growing flaws";
    enum { K, M, CG, E, AFTER };
    static constexpr Parameter parameters[] = {
        {"", "K", "1/volume", POSITIVE, REQUIRED, "flaws per volume at unit strain"},
        {"", "M", "1", POSITIVE, REQUIRED, "exponent of the strain"},
        {"", "CG", "velocity", POSITIVE, REQUIRED, "velocity at which cracks grow"},
        {"", "E", "pressure", POSITIVE, REQUIRED, "Young's modulus"},
        after_none,
        after_pressure,
        after_friction};
    static constexpr HistoryDeclaration history[] = {
        damaged,
        shear_energy,
        rest_energy,
        {"fragment", ZERO, "length", "size of fragments, final when the point has failed"}};
    enum { FRAGMENT = NDAMAGE, NFRAGMENT };
    static constexpr int nhistory(const LawParameters &) { return NFRAGMENT; }

    double inv_E, exponent, log_growth, size;

    DamageGradyKipp(const LawParameters &p, const Batch &b) :
        inv_E(1.0 / p.value[E]), exponent(p.value[M] / 3.0)
    {
      // the logarithm, as K may be 1e60
      const double m = p.value[M], pi = 3.14159265358979323846;
      const double alpha = log(8.0 * pi / ((m + 1.0) * (m + 2.0) * (m + 3.0))) + log(p.value[K]) +
          3.0 * log(p.value[CG]);
      log_growth = (1.0 / 3.0) * alpha + log(max((m + 3.0) / 3.0 * b.dt, 1e-300));
      size = 6.0 * p.value[CG] * b.dt / (m + 2.0);
    }

    MPM_INLINE double grow(const Batch &, History history, int i, const Intact &intact) const
    {
      const double strain = max(principal(intact), 0.0) * inv_E, D = history[DAMAGED][i];
      const double more = exp(log_growth + exponent * log(max(strain, 1e-300)));
      const double side = pow(D, 1.0 / 3.0) + (strain > 0.0 ? min(more, 1.0) : 0.0);
      history[FRAGMENT][i] += strain > 0.0 && D < 1.0 ? size : 0.0;
      return side * side * side;
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
