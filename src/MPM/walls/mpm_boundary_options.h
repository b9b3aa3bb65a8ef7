/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_BOUNDARY_OPTIONS_H
#define LMP_MPM_BOUNDARY_OPTIONS_H

#include "declare/option.h"
#include "field/mpm_friction_heat.h"

#include <string>

namespace LAMMPS_NS {

/** Keywords of fix mpm/boundary. */
struct MPMBoundaryOptions {
  enum Kind { STICK, SLIP, SEPARATE };

  Kind kind = STICK;
  double friction = 0.0;
  MPM_NS::NumberOrVariable velocity[3], rate;    ///< components that are not given are free
  bool by_displacement = false;                  ///< velocity[] holds displacements
  double center[3] = {0.0, 0.0, 0.0}, axis[3] = {0.0, 0.0, 0.0};    ///< of the rotation
  std::string field_id;                                             ///< empty: all fields
  MPMFrictionHeatOptions heat;

  bool all_given() const { return velocity[0].given && velocity[1].given && velocity[2].given; }
  /** Does the impulse decide whether there is contact, or whether it slides? */
  bool decides() const { return kind == SEPARATE || friction > 0.0; }
  bool rotating() const { return axis[0] != 0.0 || axis[1] != 0.0 || axis[2] != 0.0; }
  /** Is the wall given a velocity? If it is a region, material at its surface may leave the
   *  region. */
  bool is_driven() const;
  /** Is one of the quantities that give the motion a variable? */
  bool has_variables() const;
  MPM_NS::Options declare(int dimension);
};

}    // namespace LAMMPS_NS

#endif
