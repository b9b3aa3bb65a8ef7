/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PAIR_STYLES_H
#define LMP_MPM_PAIR_STYLES_H

#include "force.h"
#include "pair_hybrid.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** A pair style of the run. */
struct MPMPairStyle {
  Pair *pair;
  std::string name;

  /** The pair style, or all pair styles of a hybrid; empty without a pair style. */
  static std::vector<MPMPairStyle> all(const Force &force)
  {
    if (!force.pair) return {};
    auto *const hybrid = dynamic_cast<PairHybrid *>(force.pair);
    if (!hybrid) return {{force.pair, force.pair_style}};
    std::vector<MPMPairStyle> list;
    for (int k = 0; k < hybrid->*&Inside::nstyles; k++)
      list.push_back({(hybrid->*&Inside::styles)[k], (hybrid->*&Inside::keywords)[k]});
    return list;
  }

 private:
  struct Inside : PairHybrid {
    using PairHybrid::keywords;
    using PairHybrid::nstyles;
    using PairHybrid::styles;
  };
};

}    // namespace LAMMPS_NS
#endif
