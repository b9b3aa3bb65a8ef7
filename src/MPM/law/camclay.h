/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */
#ifndef MPM_LAW_CAMCLAY_H
#define MPM_LAW_CAMCLAY_H

#include "law/critical_state.h"

namespace MPM_NS::law {
namespace {

  enum { CC_G, CC_M, CC_LAMBDA, CC_KAPPA, CC_E0, CC_P0, CC_PC };

  /** Modified Cam-Clay (K.H. Roscoe, J.B. Burland, in: Engineering Plasticity, Cambridge, 1968, p.
   *  535) at finite strain (R.I. Borja, C. Tamagnini, Comput. Methods Appl. Mech. Eng. 155 (1998)
   *  73): in Kirchhoff stress, with elastic volume strain v and kappa* = KAPPA/(1 + E0),
   *
   *    q^2/M^2 + p (p - pc) <= 0,  p = P0 exp(-v/kappa*),  q = 3 G shear,
   *    ln pc grows by plastic compression over (lambda* - kappa*)
   *
   *  so that lines of isotropic compression and swelling are straight in ln J over ln p (R.
   *  Butterfield, Geotechnique 29 (1979) 469). P0 is the pressure of the material as it is created;
   *  its energy there counts as zero. Flow is associated, see CriticalStateReturn. */
  struct LawCamClay : CriticalStateReturn<LawCamClay, InvariantReturn<LawCamClay>> {
    static constexpr const char *name = "camclay";
    static constexpr const char *meaning = "modified Cam-Clay";
    static constexpr Parameter parameters[] = {
        SHEAR_MODULUS,
        {"", "M", "1", POSITIVE, REQUIRED, "slope of the critical state line"},
        {"", "LAMBDA", "1", POSITIVE, REQUIRED,
         "slope of the compression line, void ratio over ln p"},
        {"", "KAPPA", "1", POSITIVE, REQUIRED, "slope of swelling lines"},
        {"", "E0", "1", NOT_NEGATIVE, REQUIRED, "initial void ratio"},
        {"", "P0", "pressure", POSITIVE, REQUIRED, "initial pressure"},
        {"", "PC", "pressure", POSITIVE, REQUIRED, "initial preconsolidation pressure"}};
    static constexpr HistoryDeclaration history[] = {
        MPM_ELASTIC_STRAIN_HISTORY,
        PLASTIC_STRAIN,
        {"preconsolidation", CC_PC, "pressure", "preconsolidation pressure (Kirchhoff)"}};
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[CC_LAMBDA] <= p.value[CC_KAPPA] ? "LAMBDA must be above KAPPA"
          : p.value[CC_PC] < p.value[CC_P0]          ? "PC must not be below P0"
                                                     : nullptr;
    }

    double G, Mb, inv_kappa, inv_plastic, swell, P0, logP0;
    static constexpr double beta = 0.0, LARGEST = 300.0;    // largest exponent

    explicit LawCamClay(const LawParameters &p) :
        G(p.value[CC_G]), Mb(p.value[CC_M]), inv_kappa((1.0 + p.value[CC_E0]) / p.value[CC_KAPPA]),
        inv_plastic((1.0 + p.value[CC_E0]) / (p.value[CC_LAMBDA] - p.value[CC_KAPPA])),
        swell(1.0 / (inv_kappa + inv_plastic)), P0(p.value[CC_P0]), logP0(std::log(p.value[CC_P0]))
    {
    }
    LawCamClay(const LawParameters &p, const Batch &) : LawCamClay(p) {}

    MPM_INLINE double growth(double v) const { return max(min(-v * inv_kappa, LARGEST), -LARGEST); }
    MPM_INLINE double pressure(double v) const { return P0 * exp(growth(v)); }
    MPM_INLINE double volume_energy(double v) const { return P0 / inv_kappa * expm1(growth(v)); }

    /** Logarithms of p and pc. */
    MPM_INLINE CriticalTrial begin(History history, int i, double v) const
    {
      return {logP0 - v * inv_kappa, log(max(history[1][i], 1e-250))};
    }

    MPM_INLINE Compressed compress(const CriticalTrial &s, double x) const
    {
      const double p = exp(max(min(s.p - x * inv_kappa, LARGEST), -LARGEST));
      const double pc = exp(max(min(s.hard + x * inv_plastic, LARGEST), -LARGEST));
      return {p, -inv_kappa * p, pc, inv_plastic * pc};
    }

    /** p = pc/2 where x (1/kappa + 1/(lambda - kappa)) = ln(2 p/pc) */
    MPM_INLINE bool bracket(const CriticalTrial &s, double, double, double &start,
                            double &end) const
    {
      start = 0.0;
      end = swell * (s.p - s.hard + 0.69314718055994530942);
      return true;
    }

    MPM_INLINE void finish(History history, int i, const CriticalTrial &s, double x, double D) const
    {
      history[0][i] += D;
      history[1][i] = x == 0.0 ? history[1][i]
                               : exp(max(min(s.hard + x * inv_plastic, LARGEST), -LARGEST));
    }

    static void modulus(const LawParameters &p, const Batch &b, History history, double *k)
    {
      const LawCamClay law(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double pressure = law.pressure(0.5 * log1p(elastic_volume(load_rows(history, i))));
        const Sym s = deviator(load_stress(b, i));
        k[i] += hencky_modulus(pressure * law.inv_kappa, law.G, b.J[i],
                               add_diagonal(s, -pressure / b.J[i]));
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
