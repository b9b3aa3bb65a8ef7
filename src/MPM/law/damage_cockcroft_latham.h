/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_DAMAGE_COCKCROFT_LATHAM_H
#define MPM_LAW_DAMAGE_COCKCROFT_LATHAM_H

#include "law/damage.h"

namespace MPM_NS::law {
namespace {

  /** Ductile failure by the work of the largest principal stress (M.G. Cockcroft, D.J. Latham,
   *  J. Inst. Met. 96 (1968) 33):
   *
   *    used = (1/WC) sum max(sigma_1, 0) de,   e: equivalent plastic strain */
  struct DamageCockcroftLatham : ScalarDamage<DamageCockcroftLatham> {
    static constexpr const char *name = "cockcroft/latham";
    static constexpr const char *meaning = "plastic work of the largest principal stress";
    enum { WC, SOFTEN, ENERGY, AFTER };
    static constexpr Parameter parameters[] = {
        {"", "WC", "pressure", POSITIVE, REQUIRED, "critical work per volume"},
        soften_from,
        soften_energy,
        after_none,
        after_pressure,
        after_friction};
    static constexpr HistoryDeclaration history[] = {damaged, shear_energy, rest_energy,
                                                     ductility_used};
    static constexpr int nhistory(const LawParameters &) { return NDUCTILE; }

    double inv_work;
    Ductile ductile;

    DamageCockcroftLatham(const LawParameters &p, const Batch &b) :
        inv_work(1.0 / p.value[WC]), ductile(p, b, SOFTEN)
    {
    }

    MPM_INLINE double grow(const Batch &b, History history, int i, const Intact &intact) const
    {
      return ductile.use(b, history, i, inv_work * max(principal(intact), 0.0) * b.plastic[i]);
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif
