/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */
#ifndef MPM_LAW_NACC_H
#define MPM_LAW_NACC_H

#include "law/critical_state.h"

namespace MPM_NS::law {
namespace {

  enum { NACC_E, NACC_NU, NACC_M, NACC_BETA, NACC_XI, NACC_ALPHA };

  /** Cohesive Cam-Clay (J. Gaume, T. Gast, J. Teran, A. van Herwijnen, C. Jiang, Nat. Commun. 9
   *  (2018) 3047; J. Wolper et al., ACM Trans. Graph. 38 (2019) 119): elliptic yield surface with
   *  tensile strength BETA p0 and hardening
   *
   *    p0 = K sinh(XI max(-alpha, 0)),  alpha = ln of the plastic volume ratio
   *
   *  Elasticity is Hencky's here, and the flow associated with an implicit return, see
   *  CriticalStateReturn. For alpha >= 0 nothing of the strength is left: broken material is free of
   *  stress until it has been compressed again to alpha < 0. */
  struct LawNacc : CriticalStateReturn<LawNacc, HenckyInvariantReturn<LawNacc>> {
    static constexpr const char *name = "nacc";
    static constexpr const char *meaning = "cohesive Cam-Clay: snow, wet sand, soft rock";
    static constexpr Parameter parameters[] = {
        {"", "E", "pressure", POSITIVE, REQUIRED, "Young's modulus"},
        {"", "NU", "1", POISSON_RATIO, REQUIRED, "Poisson's ratio"},
        {"", "M", "1", POSITIVE, REQUIRED, "slope of the critical state line for BETA = 0"},
        {"", "BETA", "1", FRACTION, REQUIRED, "tensile strength over compressive strength"},
        {"", "XI", "1", POSITIVE, REQUIRED, "hardening factor"},
        {"", "ALPHA0", "1", {-UNBOUNDED, 0.0, true}, REQUIRED, "initial value of alpha"}};
    static constexpr HistoryDeclaration history[] = {
        MPM_ELASTIC_STRAIN_HISTORY,
        PLASTIC_STRAIN,
        {"alpha", NACC_ALPHA, "1", "logarithm of the plastic volume ratio"}};

    double Mb, beta, xi;

    LawNacc(const LawParameters &p, const Batch &) :
        CriticalStateReturn(p), Mb(p.value[NACC_M] / std::sqrt(1.0 + 2.0 * p.value[NACC_BETA])),
        beta(p.value[NACC_BETA]), xi(p.value[NACC_XI])
    {
    }

    MPM_INLINE CriticalTrial begin(History history, int i, double v) const
    {
      return {-K * v, history[1][i]};
    }

    MPM_INLINE Compressed compress(const CriticalTrial &s, double x) const
    {
      const double z = min(xi * max(x - s.hard, 0.0), 200.0);
      const double grow = expm1(z), shrink = -grow / (1.0 + grow);    // exp(z) - 1, exp(-z) - 1
      return {s.p - K * x, -K, 0.5 * K * (grow - shrink),
              z > 0.0 ? 0.5 * K * xi * (2.0 + grow + shrink) : 0.0};
    }

    /** The pressure vanishes at x = p/K, the strength at x = alpha. */
    MPM_INLINE bool bracket(const CriticalTrial &s, double sign, double center, double &start,
                            double &end) const
    {
      const bool strong = s.p > K * s.hard;
      start = sign > 0.0 && strong ? max(s.hard, 0.0) : 0.0;
      end = sign > 0.0 || !strong ? s.p / K : max((s.p - center) / K, s.hard);
      return strong;
    }

    MPM_INLINE void finish(History history, int i, const CriticalTrial &s, double x, double D) const
    {
      history[0][i] += D;
      history[1][i] = s.hard - x;
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
