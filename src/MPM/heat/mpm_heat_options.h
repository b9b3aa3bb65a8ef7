/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_OPTIONS_H
#define LMP_MPM_HEAT_OPTIONS_H

#include "declare/option.h"
#include "diffusion/mpm_diffusion_solver.h"
#include "heat/mpm_conduction.h"
#include "heat/mpm_heat_contact.h"
#include "heat/mpm_heat_surface.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Keywords of fix mpm/heat. */
struct MPMHeatOptions {
  MPMHeatCondition conditions[MPMHeatFaces::NFACE];
  MPMHeatSurfaces::Conditions surfaces;
  MPMHeatSurfaceCondition surface;    ///< condition that is being read
  std::vector<MPMHeatPair> pairs;
  MPMHeatPair pair;      ///< pair that is being read
  std::string source;    ///< name of a variable, without v_; empty: none
  MPMHeatTransfer transfer;
  int most_stages = 32;
  static constexpr int AUTO = 0;
  int every = AUTO;    // steps of fix mpm per conduction, or AUTO
  MPMDiffusionOptions in_time;
  bool grains = false;
  bool penalty = false;

  bool gives_grains = false, gives_penalty = false;    ///< are the keywords given?

  /** Names of the faces of the box. */
  static const char *const FACE_NAME[];

  MPM_NS::Options declare(int dimension);
  /** Is there radiation? */
  bool radiates() const;
  bool has_variables() const;
};

}    // namespace LAMMPS_NS
#endif
