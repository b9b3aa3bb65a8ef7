/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// What makes forces of stress where the input leaves it open (keyword stress of fix mpm)

#include "field/mpm_field.h"

#include "comm.h"
#include "field/mpm_forces.h"
#include "field/mpm_node_action.h"
#include "field/mpm_physics.h"
#include "field/mpm_refined_body.h"

#include <algorithm>

using namespace LAMMPS_NS;

/** Does it, or another lattice of the same body, touch other bodies by a node action? */
bool MPMField::has_contact() const
{
  const auto contacts = find_fixes<MPMNodeAction>(lmp);
  const auto bodies = find_fixes<MPMRefinedBody>(lmp);
  const auto list = MPMField::all(lmp);
  return std::any_of(list.begin(), list.end(), [&](const MPMField *field) {
    const bool mine = field == this || std::any_of(bodies.begin(), bodies.end(), [&](auto *body) {
                        return body->has(id()) && body->has(field->id());
                      });
    return mine && std::any_of(contacts.begin(), contacts.end(), [field](auto *contact) {
             return contact->touches(field->id());
           });
  });
}

/** Fixes can be defined in any order, and come and go between runs: this is found anew for each
 *  run. Where bodies touch by fix mpm/contact, edges give way more with gradients (a block of 6
 *  cells on a base sinks by 14 % more than with one lattice for both, in the place of 8 %), and
 *  pressures of pore water scatter more. */
void MPMField::choose_stress(const std::vector<MPMPhysics *> &all)
{
  const bool alone = !has_contact() && find_fixes<MPMPorePressure>(lmp).empty();
  const auto who = std::find_if(all.begin(), all.end(), [&](const auto *physics) {
    return alone && physics->brings_to_rest();
  });
  const bool before = options.strains_by_gradient();
  chosen.rests = who != all.end();
  if (options.strains_by_gradient() == before || comm->me) return;
  if (before) {
    utils::logmesg(lmp, "Fix mpm {}: stress mls again, the default {}\n", id(),
                   alone ? "of steps that do not bring bodies to rest"
                         : "with fix mpm/contact and fix mpm/pore");
    return;
  }
  const auto *const other = dynamic_cast<Fix *>(*who);
  utils::logmesg(lmp, "Fix mpm {}: stress gradient, the default with fix {} {}\n", id(),
                 other->style, other->id);
}
