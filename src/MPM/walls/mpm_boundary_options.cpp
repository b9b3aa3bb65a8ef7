/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/mpm_wall.h"

#include "math_extra.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** Fix ID all mpm/boundary faces|region REG  stick|slip|separate  keyword values */
Options MPMBoundaryOptions::declare(int dim)
{
  using namespace option;
  Options o("fix mpm/boundary");
  o.argument(word(kind, {{"stick", STICK}, {"slip", SLIP}, {"separate", SEPARATE}}, "kind"));
  o.add("friction",
        {number(friction, "mu", NOT_NEGATIVE, "1",
                "coefficient of Coulomb friction, for *slip* and *separate*")});
  heat.declare(o, "the energy lost by friction becomes heat of the material",
               "share of this energy that becomes heat of the material");
  o.add("velocity",
        {variables(velocity, 3, "vx vy vz", "velocity",
                   "velocity of the wall, can be variables (see below); with *stick*, NULL leaves "
                   "a component free",
                   true)})
      .once();
  o.add("displacement",
        {variables(velocity, 3, "ux uy uz", "distance",
                   "displacement of the wall since this fix was defined, instead of its velocity; "
                   "can be variables; with "
                   "*stick*, NULL leaves a component free",
                   true)})
      .then([this] {
        by_displacement = true;
      })
      .once()
      .standard("none");
  o.add("rotate",
        {numbers(center, 3, "ox oy oz", ANY_NUMBER, "distance", "a point on the axis of rotation"),
         numbers(axis, 3, "ax ay az", ANY_NUMBER, "", "direction of the axis"),
         variables(&rate, 1, "rate", "radians/time",
                   "angular velocity, can be a variable (see below)")})
      .once()
      .standard("none");
  o.add("field",
        {text(field_id, "fix-ID", "ID of the :doc:`fix mpm <fix_mpm>` on which this fix acts")})
      .standard("all");
  o.refuse([=] {
    return OptionRules{
        {kind == STICK, "friction", "needs kind slip or separate"},
        {heat.heats() && friction == 0.0, "heat", "is that of friction, which needs a coefficient"},
        {kind != STICK && !all_given(), "velocity", "allows NULL only with kind stick"},
        {!velocity[0].given && !velocity[1].given && (dim == 2 || !velocity[2].given), "velocity",
         "leaves all components free"},
        {dim == 2 && (!velocity[2].variable.empty() || velocity[2].value != 0.0), "velocity",
         "must have the component 0 along z in 2d: {velocity}"},
        {kind != STICK && !all_given(), "displacement", "allows NULL only with kind stick"},
        {!velocity[0].given && !velocity[1].given && (dim == 2 || !velocity[2].given),
         "displacement", "leaves all components free"},
        {dim == 2 && (!velocity[2].variable.empty() || velocity[2].value != 0.0), "displacement",
         "must have the component 0 along z in 2d: {displacement}"},
        {MathExtra::len3(axis) == 0.0, "rotate", "needs an axis of non-zero length"},
        {dim == 2 && (axis[0] != 0.0 || axis[1] != 0.0), "rotate", "needs an axis along z in 2d"},
        {!all_given(), "rotate", "prescribes all components of the velocity"}};
  });
  return o;
}

bool MPMBoundaryOptions::is_driven() const
{
  return rotating() || std::any_of(velocity, velocity + 3, [](const NumberOrVariable &v) {
           return v.value != 0.0 || !v.variable.empty();
         });
}

bool MPMBoundaryOptions::has_variables() const
{
  return !rate.variable.empty() ||
      std::any_of(velocity, velocity + 3, [](const NumberOrVariable &v) {
        return !v.variable.empty();
      });
}
