/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_ELEMENTS_OPTIONS_H
#define LMP_MPM_ELEMENTS_OPTIONS_H

#include "declare/option.h"
#include "elements/mpm_thin_body.h"
#include "mesh/element_body.h"

#include <string>

namespace LAMMPS_NS {

/** Keywords of fix mpm/elements. */
struct MPMElementsOptions {
  std::string file, part;     ///< part: physical group of the mesh; empty: all of it
  bool fbar = false;          ///< average the volume over an element
  MPMThinBody thin;           ///< surfaces or lines
  bool compression = true;    ///< do surfaces and lines resist compression? else they wrinkle
  using Body = MPM_NS::ElementBody;
  /** Resistance to bending: none, or by constant or linear curvatures in triangles. */
  Body::Bending bending = Body::NONE;
  bool curved = false;      ///< is a closed surface curved between its nodes?
  bool has_axes = false;    ///< are axes of the material given?
  double axes[6] = {};      ///< in surfaces: axis 1, and a vector on the side of axis 2

  MPM_NS::Options declare(int dim);
};

}    // namespace LAMMPS_NS
#endif
