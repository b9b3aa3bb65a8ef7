/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_PHASE_FIELD_H
#define MPM_MATERIAL_PHASE_FIELD_H

#include "material/material.h"

#include <optional>

namespace MPM_NS {

/** What fix mpm/phasefield needs of a material with damage phasefield, see law/phase_field.h. */
struct PhaseFieldCracks {
  double length;      ///< l
  double xi, c0;      ///< of w(d)
  double energy;      ///< GC
  double strength;    ///< of cohesive cracks; else 0
  double modulus;     ///< Young's modulus at small strain
  bool varies;        ///< does the length differ between points, or with temperature?
  // columns of the history
  int phase, driving, toughness;
  int shape;    ///< -1: there is none, a = PhaseField::SQUARE
};

/** Nothing if the material has another damage or none. */
std::optional<PhaseFieldCracks> phase_field_cracks(const Material &);

}    // namespace MPM_NS
#endif
