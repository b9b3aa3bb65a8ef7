/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MIXTURE_OPTIONS_H
#define LMP_MPM_MIXTURE_OPTIONS_H

#include "declare/option.h"
#include "grains/mpm_drag.h"

#include <string>

namespace LAMMPS_NS {

/** Keywords of fix mpm/mixture. */
struct MPMMixtureOptions {
  enum Drag { NO_DRAG, DARCY, SPHERES };

  std::string soil_id, water_id;
  double grain_density = 0.0, viscosity = 0.0;    ///< viscosity: read as pressure, kept as mass
  Drag drag = NO_DRAG;
  double permeability = 0.0;          ///< intrinsic [area]
  double reference_porosity = 0.0;    ///< porosity of that permeability; 0: it holds for any
  double diameter = 0.0;              ///< of the grains
  MPM_NS::SphereDrag::Law spheres = MPM_NS::SphereDrag::NONE;

  MPM_NS::Options declare();
  /** Is this field (ID) the soil or the water? */
  bool has(const std::string &field) const { return field == soil_id || field == water_id; }

  /** Drag per volume of soil and velocity difference [mass/(volume time)]. porosity: of the soil; here: porosity at
   *  the node, which differs at the end of the soil and belongs to the velocity difference. */
  double drag_coefficient(double porosity, double here, double water_density,
                          double difference) const;
  /** Is the drag coefficient independent of the velocity difference? */
  bool drag_is_linear() const;
};

}    // namespace LAMMPS_NS
#endif
