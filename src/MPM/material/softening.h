/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_SOFTENING_H
#define MPM_MATERIAL_SOFTENING_H

#include "material/material.h"

#include <optional>

namespace MPM_NS {

/** Temperatures between which the strength or the ductility of a material changes, from TREF and
 *  TMELT of its laws; TMELT is infinite where a law has none. */
struct SofteningRange {
  double reference, melting;
};

/** The range of a material, for doubts about temperatures; nothing if none of its laws depends on
 *  temperature in this way. */
std::optional<SofteningRange> softening_range(const Material &);

}    // namespace MPM_NS
#endif
