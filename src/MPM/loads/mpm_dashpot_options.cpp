/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "loads/fix_mpm_dashpot.h"
#include "loads/mpm_face.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** fix ID group mpm/dashpot region REG cp cs keyword values ... */
Options MPMDashpotOptions::declare(int dim)
{
  using namespace option;
  Options o("fix mpm/dashpot");
  o.argument(word(surface, {{"region", REGION, "", {text(region, "REG", "")}}}, "surface"));
  o.argument(number(speed_p, "cp", POSITIVE, "velocity", ""));
  o.argument(number(speed_s, "cs", NOT_NEGATIVE, "velocity", ""));
  o.add("density",
        {number(density, "rho", POSITIVE, "mass/distance^dim",
                "density of the material on the far side")})
      .standard("density of the points next to the surface");
  o.add("incoming",
        {variables(
            incoming, 3, "vx vy vz", "velocity",
            "velocity of the material in waves that come from the far side, can be variables")})
      .then([this] {
        has_incoming = true;
      })
      .once()
      .standard("none");
  o.add("support", {yes_no(support)}, "hold the stress that the surface has at the start");
  o.add("spring",
        {number(relax, "tau", POSITIVE, "time",
                "time that gives springs besides the dashpots the stiffness rho c/tau per area")})
      .standard("none");
  o.add("column",
        {text(column, "fix-ID",
              "ID of a :doc:`fix mpm/column <fix_mpm_column>` with which the far side moves")})
      .standard("none, the far side is at rest");
  MPMFace::declare(o, spacing, area);
  o.refuse([=] {
    return OptionRules{{speed_s >= speed_p, "",
                        "has a speed of shear waves that is not below that of pressure waves"},
                       {dim == 2 && (incoming[2].value != 0.0 || !incoming[2].variable.empty()),
                        "incoming", "must be along x and y in 2d: {incoming}"},
                       {has_incoming && !column.empty(), "column",
                        "is the free field, whose waves come to its base: remove incoming here"}};
  });
  return o;
}
