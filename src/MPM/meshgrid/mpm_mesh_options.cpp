/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "meshgrid/mpm_mesh_body.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** fix ID group mpm/mesh FILE keyword values ... */
Options MPMMeshOptions::declare(int dim)
{
  using namespace option;
  Options o("fix mpm/mesh");
  o.argument(text(file, "file"));
  o.add("part",
        {text(
            part, "name",
            "name or tag of a physical group of the mesh, or a set, whose elements are the cells")})
      .standard("all elements of the dimension of the simulation");
  o.add("frame",
        {word(total,
              {{"updated", false, "nodes are fixed in space, and points move through the mesh"},
               {"total", true, "nodes are fixed in the undeformed body"}})})
      .keep();
  o.add("scheme",
        {word(musl,
              {{"usl", false, "strain from the velocities after the momentum equation"},
               {"musl", true,
                "strain from the new velocities of the points, mapped back to the nodes"}})})
      .keep();
  o.add(
       "transfer",
       {word(transfer,
             {{"flip",
               FLIP,
               "velocities of points get the change of the nodes",
               {number(flip, "share", FRACTION, "1", "1: FLIP, 0: PIC")}},
              {"apic", APIC, "velocities of points come with the velocity gradient of the cell"}})})
      .keep();
  o.add("locking",
        {word(fbar,
              {{"none", false, "nothing"},
               {"fbar", true, "changes of volume and the mean stress, over the points around"}})},
        "quantity that is averaged to prevent volumetric locking")
      .keep();
  const auto condition = [&](const std::string &keyword, MPMMeshCondition::Kind kind,
                             const std::string &names, const std::string &unit,
                             const std::string &meaning, int n, bool null) {
    std::vector<OptionValue> values = {text(next.group, "name", meaning)};
    if (n)
      values.push_back(variables(next.value, n, names, unit,
                                 null ? "components, can be variables; NULL leaves a component free"
                                      : "value of the load, can be a variable",
                                 null));
    add_condition(o, keyword, values, kind, next, conditions);
  };
  condition("velocity", MPMMeshCondition::VELOCITY, dim == 3 ? "vx vy vz" : "vx vy", "velocity",
            "name of a physical group or set whose nodes have this velocity", dim, true);
  condition("slip", MPMMeshCondition::SLIP, "", "",
            "name of sides whose nodes have no velocity along the normals", 0, false);
  condition("pressure", MPMMeshCondition::PRESSURE, "p", "pressure",
            "name of sides of the mesh, which are fixed in space (frame updated) or move with the "
            "body (frame total)",
            1, false);
  condition("traction", MPMMeshCondition::TRACTION, dim == 3 ? "tx ty tz" : "tx ty", "pressure",
            "name of sides of the mesh, with their area in the file", dim, false);
  o.refuse([this, dim] {
    OptionRules rules;
    refuse_twice(rules, conditions, MPMMeshCondition::VELOCITY, "velocity", "give it once", dim);
    refuse_twice(rules, conditions, MPMMeshCondition::SLIP, "slip", "give it once");
    refuse_twice(rules, conditions, MPMMeshCondition::PRESSURE, "pressure", "give the sum once");
    refuse_twice(rules, conditions, MPMMeshCondition::TRACTION, "traction", "give the sum once");
    return rules;
  });
  return o;
}
