/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Combinations with other fixes that implicit steps do not support.

#include "implicit/fix_mpm_implicit.h"

#include "base/mpm_options.h"
#include "contact/fix_mpm_contact.h"
#include "elements/fix_mpm_elements.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_frame.h"
#include "field/mpm_node_action.h"
#include "field/mpm_trial_contact.h"
#include "transfer/kernels.h"

#include "comm.h"
#include "error.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;
/** Style and ID of a fix. */
template <class Interface> static std::string name_of(Interface *of)
{
  const auto *const fix = dynamic_cast<Fix *>(of);
  return fmt::format("fix {} {}", fix->style, fix->id);
}

bool FixMPMImplicit::has_pressure(MPMPhysics *physics, const MPMField &of)
{
  auto *const water = dynamic_cast<MPMPorePressure *>(physics);
  return water && water->node_pressure(of);
}

/** Refuses what implicit steps of a field do not support. */
void FixMPMImplicit::check_field(const MPMPlan &plan, MPMField &of) const
{
  for (auto *other : plan.physics)
    if (dynamic_cast<MPMPorePressure *>(other) &&
        (time.kind == MPMTimeMethod::NEWMARK || time.kind == MPMTimeMethod::MIDPOINT))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/implicit solves for the pressure of {} at the end of a step, which "
                 "newmark and midpoint are not made of: use static or euler",
                 name_of(other));
  check_transfer(of);
  check_stabilization(plan, of);
  check_physics(plan);
  check_elements(plan, of);
  check_actions(plan, of);
  const auto &options = of.options;
  if (options.shape == MPM_NS::LINEAR && !of.frame->is_total() && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/implicit: with shape linear in the updated frame, forces jump when "
                   "points go from cell to cell, and can be wrong by 17 % in runs of many steps: "
                   "use shape quadratic of fix mpm {}, or frame total",
                   of.id());
}

/** Other physics than loads must be solved before the motion, or together with it. */
void FixMPMImplicit::check_physics(const MPMPlan &plan) const
{
  for (auto *other : plan.physics)
    if (other != this && !dynamic_cast<MPMLoad *>(other) && !other->precedes_motion() &&
        !dynamic_cast<MPMPorePressure *>(other))
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/implicit balances stress, inertia, and loads on points, and what {} computes in "
          "explicit steps would not be in its balance: remove one of them",
          name_of(other));
}

/** Points must move with the velocities that forces belong to. */
void FixMPMImplicit::check_transfer(MPMField &of) const
{
  const auto &options = of.options;
  refuse_field(
      lmp, *this, of,
      {{options.scheme != MPMFieldOptions::USL, "scheme",
        "implicit steps end with the stress that goes with their velocities: use scheme usl"},
       {options.series != MPMFieldOptions::LUMPED, "transfer xpic and fmpm",
        "forces are balanced with the lumped mass: use transfer apic or flip"},
       {time.is_static() && adds_change(options.transfer), "transfer flip",
        "points have no velocity in statics: use transfer pic, which has the same forces, or apic"},
       {(time.kind == MPMTimeMethod::NEWMARK || time.keeps_acceleration()) &&
            !(options.transfer == FLIP && options.flip == 1.0),
        "this transfer",
        "points move with another velocity than they have at the end of the step: use transfer "
        "flip 1.0, or euler or midpoint instead"},
       {time.kind == MPMTimeMethod::MIDPOINT &&
            !(options.transfer == FLIP && options.flip == 1.0) &&
            !(options.transfer == APIC && is_mls(options.shape, options.transfer) &&
              !options.strains_by_gradient() && !of.frame->is_total()),
        "this transfer",
        "points move with another velocity than they have at the end of the step: use transfer "
        "flip 1.0, in the updated frame also transfer apic with shape quadratic or cubic and "
        "stress "
        "mls"},
       {options.averages_strain(), "locking fbar and both",
        "their motions of points are not those that forces belong to: use locking pressure"},
       {options.modified_edges, "edges modified", "use edges plain, the default"},
       {options.smooths_volumes(), "smooth", "it is for fluids in explicit steps"},
       {options.has_light_nodes(), "light",
        "nodes with next to no mass are no problem in implicit steps: remove it"},
       {options.heats(), "heat", "the time step is not in its balance: remove it"},
       {options.every > 1, "every", "implicit steps are long already: use every 1"}});
}

/** Where nodes that points barely reach have a stiffness of their own. */
void FixMPMImplicit::check_stabilization(const MPMPlan &plan, MPMField &of) const
{
  if (stabilize > 0.0 && !may_stabilize(of))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/implicit stabilize is for points of shape quadratic or cubic of fix mpm "
               "{}, without fix mpm/elements, and not around an axis: remove it",
               of.id());
  for (auto *other : plan.physics)
    if (stabilize > 0.0 && has_pressure(other, of))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/implicit stabilize knows nothing of the pressure of {}: remove it",
                 name_of(other));
}

/** Forces of elements must be known after trial motions. */
void FixMPMImplicit::check_elements(const MPMPlan &plan, MPMField &of) const
{
  for (const auto *elements : find_fixes<FixMPMElements>(lmp)) {
    if (!elements->is_thin())
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/implicit knows the forces of surfaces and lines, but not those of the "
                 "solid elements of fix mpm/elements {}: use points instead, or explicit steps",
                 elements->id);
    if (preconditioner == MULTIGRID)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/implicit solver multigrid is made of the stiffness of points, and knows "
                 "nothing of that of fix mpm/elements {}: use solver blocks",
                 elements->id);
    for (auto *other : plan.physics)
      if (has_pressure(other, of))
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/implicit cannot solve for the pressure of {} together with the "
                   "elements of fix mpm/elements {}: use explicit steps",
                   name_of(other), elements->id);
  }
}

/** Actions on nodes must be projections, or become so when it is known what touches. */
void FixMPMImplicit::check_actions(const MPMPlan &plan, const MPMField &of) const
{
  bool rubs = false;
  for (auto *action : plan.actions) {
    if (action->is_projection()) continue;
    const auto name = name_of(action);
    auto *const contact = action->trial_contact();
    if (!contact)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/implicit holds nodes by walls, and knows nothing of what {} does: "
                 "use fix mpm/boundary, with a region that moves for a rigid body, or explicit "
                 "steps",
                 name);
    for (auto *other : plan.physics)
      if (has_pressure(other, of))
        error->all(
            FLERR, Error::NOLASTLINE,
            "Fix mpm/implicit finds no contact and friction of walls together with the water "
            "of {}, and {} has one of these: use stick, or slip without friction",
            name_of(other), name);
    rubs = rubs || (contact->has_friction() && contact->is_regularised());
  }
  if (slip > 0.0 && !rubs)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/implicit slip is of walls with friction, and there are none: remove it");
}

/** Refuses what is not made for several fields, which are bodies that touch each other. */
void FixMPMImplicit::check_bodies(const MPMPlan &plan) const
{
  const auto contacts = find_fixes<FixMPMContact>(lmp);
  for (const auto *field : fields)
    if (contacts.size() != 1 || !contacts[0]->touches(field->id()))
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/implicit solves for the nodes of one fix mpm, or of all that one fix "
          "mpm/contact names, but there are {} of these and {} of those, and fix mpm {}: let "
          "bodies share a fix mpm, name all of them in one fix mpm/contact, or use explicit steps",
          fields.size(), contacts.size(), field->id());
  if (time.keeps_acceleration())
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/implicit alpha and hht keep accelerations of points, whose part in the force "
        "between bodies (fix mpm/contact {}) would not be told: use newmark or midpoint",
        contacts[0]->id);
  if (preconditioner == MULTIGRID)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/implicit solver multigrid knows one fix mpm, and there are {}, which fix "
               "mpm/contact {} joins: use solver blocks",
               fields.size(), contacts[0]->id);
  for (const auto *field : fields)
    refuse_field(
        lmp, *this, *field,
        {{field->domains != nullptr, "shape cpdi and cpdi2",
          "bodies that touch by fix mpm/contact need functions of nodes: use shape quadratic"},
         {!field->elements.empty(), "fix mpm/elements",
          "contact of elements is for explicit steps: use points"},
         {field->options.shape == MPM_NS::LINEAR, "shape linear",
          "forces between bodies jump when points go from cell to cell: use shape quadratic"}});
  for (auto *action : plan.actions) {
    auto *const contact = action->trial_contact();
    if (!contact || dynamic_cast<MPMBodyContact *>(contact)) continue;
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/implicit knows walls that hold bodies together with fix mpm/contact {}, "
               "but not yet those that separate, have friction, or are regions that move, such as "
               "fix mpm/boundary {}: use stick or slip at faces or regions at rest, or a body of "
               "its own (fix mpm) for the wall",
               contacts[0]->id, dynamic_cast<Fix *>(action)->id);
  }
}
