/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_ELEMENTS_OPTIONS_H
#define LMP_MPM_ELEMENTS_OPTIONS_H

#include "declare/option.h"
#include "mesh/element_body.h"

#include <string>

namespace LAMMPS_NS {

/** Keywords for bodies that are surfaces or lines of a mesh. They define the volume of these
 *  bodies. */
struct MPMThinBody {
  double thickness = 0.0;    ///< of surfaces, in 2d of lines; 0: not given
  double section = 0.0;      ///< area across lines in 3d; 0: not given

  /** Adds the keywords to the options of a command in dim dimensions. */
  void declare(MPM_NS::Options &o, int dim)
  {
    using namespace MPM_NS;
    using namespace MPM_NS::option;
    o.add("thickness",
          {number(thickness, "T", POSITIVE, "distance",
                  "the body is a surface of the mesh, in 2d lines, of this thickness")})
        .standard("a solid");
    o.add("section",
          {number(section, "A", POSITIVE, "distance^2",
                  "the body is lines of the mesh with this area across, in 3d")});
    is_plane = dim == 2;
  }
  /** Combinations of keywords that are errors. */
  MPM_NS::OptionRules rules() const
  {
    return {{section > 0.0 && is_plane, "section", "is for 3d: lines in 2d have a thickness"},
            {section > 0.0 && thickness > 0.0, "section",
             "is for lines, and thickness for surfaces: use one of them, and two bodies for both"}};
  }

  /** Is the body a surface or lines? */
  explicit operator bool() const { return thickness > 0.0 || section > 0.0; }
  /** Dimension of the elements, in space of dim dimensions. */
  int dimension(int dim) const { return section > 0.0 ? 1 : thickness > 0.0 ? dim - 1 : dim; }
  /** Volume per area of a surface, or per length of a line. */
  double across() const { return section > 0.0 ? section : thickness; }

 private:
  bool is_plane = false;
};

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
