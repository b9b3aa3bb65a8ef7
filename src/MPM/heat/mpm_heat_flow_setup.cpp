/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Start of a run: conditions, bodies that touch, and bodies on several lattices

#include "heat/mpm_heat_flow.h"

#include "atom.h"
#include "base/mpm_options.h"
#include "contact/fix_mpm_contact.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "input.h"
#include "refine/fix_mpm_refine.h"
#include "refine/mpm_two_scale.h"
#include "region.h"
#include "update.h"
#include "variable.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   constant of Stefan and Boltzmann in the units of the input; 0 where these have no kelvins
------------------------------------------------------------------------- */

double MPMHeatFlow::sigma() const
{
  struct {
    const char *name;
    double energy, time, length;    // in SI units
  } const units[] = {{"si", 1.0, 1.0, 1.0},
                     {"cgs", 1.0e-7, 1.0, 1.0e-2},
                     {"micro", 1.0e-15, 1.0e-6, 1.0e-6},
                     {"nano", 1.0e-21, 1.0e-9, 1.0e-9},
                     {"metal", 1.602176634e-19, 1.0e-12, 1.0e-10},
                     {"real", 4184.0 / 6.02214076e23, 1.0e-15, 1.0e-10},
                     {"electron", 4.3597447222071e-18, 1.0e-15, 0.529177210903e-10}};
  for (const auto &u : units)
    if (!strcmp(update->unit_style, u.name))
      return 5.670374419e-8 * u.time * u.length * u.length / u.energy;
  return 0.0;
}

/** Checks that radiation has temperatures in kelvins, and that variables exist. */
void MPMHeatFlow::check_condition(MPMHeatCondition &c, const std::string &name)
{
  if (c.kind == MPMHeatCondition::RADIATION && sigma() == 0.0)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/heat {} radiation needs temperatures in kelvins, which units {} do not "
               "have: use units si, cgs, micro, nano, metal, real, or electron",
               name, update->unit_style);
  for (int k = 0; k < c.nvalue(); k++) find_variable(lmp, c.value[k], "fix mpm/heat " + name);
}

/* ----------------------------------------------------------------------
   bodies on several lattices: conduction on the nodes of each lattice alone would be wrong at the
   rims
------------------------------------------------------------------------- */

void MPMHeatFlow::init_levels(const MPMPlan &plan)
{
  refined.clear();
  for (const auto *fix : find_fixes<FixMPMRefine>(lmp)) {
    std::vector<MPMHeatLevels::Pair> lattices;
    int count = 0, all = 0;
    for (auto *field : plan.fields) {
      if (!fix->has(field->id())) continue;
      all++;
      count += in(*field).conducts();
    }
    if (count == 0) continue;
    if (count < all)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat {}: the fields of fix mpm/refine {} are one body, but the materials "
                 "of some of them conduct heat and those of others do not: give all of them the "
                 "part 'thermal conducting'",
                 id, fix->id);
    const auto refuse = [&](bool broken, const std::string &what, const std::string &remedy) {
      if (broken)
        error->all(
            FLERR, Error::NOLASTLINE,
            "Fix mpm/heat {}: {} does not go with bodies on several lattices, fix mpm/refine "
            "{}: {}",
            id, what, fix->id, remedy);
    };
    refuse(solver != nullptr, "time euler and sdirk2", "use time explicit");
    refuse(options.transfer.kind == MPMHeatTransfer::XPIC, "transfer xpic",
           "use relax, affine, or pic");
    refuse(!options.surfaces.empty(), "heat through surfaces and regions",
           "use conditions on faces of the box, or a source");
    refuse(options.grains, "grains yes", "leave it out");
    refuse(options.penalty, "penalty yes", "leave it out");
    refuse(options.every > 1 && has_friction, "every with heat of friction", "use every 1");
    refuse(std::any_of(options.pairs.begin(), options.pairs.end(),
                       [fix](const auto &p) {
                         return fix->has(p.field[0]) || fix->has(p.field[1]);
                       }),
           "contact",
           "leave it out, as heat goes from one body to another one at nodes of one lattice");
    for (const auto &two : fix->lattices()) {
      auto &coarse = in(two->coarse), &fine = in(two->fine);
      const bool weighs = coarse.faces.any() && weighs_faces(two->coarse);
      lattices.push_back({two.get(), &coarse, &fine, weighs ? &body_in(two->coarse) : nullptr,
                          weighs ? &body_in(two->fine) : nullptr});
    }
    refined.push_back(std::make_unique<MPMHeatLevels>(lmp, lattices));
  }
}

MPMHeatLevels *MPMHeatFlow::levels_with(const MPMConduction &one) const
{
  for (const auto &levels : refined)
    if (levels->has(one)) return levels.get();
  return nullptr;
}

MPMHeatBody &MPMHeatFlow::body_in(const MPMField &field)
{
  for (auto &body : bodies)
    if (&body->field == &field) return *body;
  auto &conduction = in(field);
  bodies.push_back(std::make_unique<MPMHeatBody>(lmp, conduction.field,
                                                 conduction.conducts() ? &conduction : nullptr));
  return *bodies.back();
}

/** Does a field have points that conduct, on any rank? */
static bool has_conducting_points(const MPMField &field, MPI_Comm world)
{
  const Atom &atom = *field.atom;
  int any = 0, all;
  for (int i = 0; i < atom.nlocal && !any; i++) {
    const auto *const fix = field.is_point(i) ? field.material_of(i) : nullptr;
    any = fix && fix->material->conducts();
  }
  MPI_Allreduce(&any, &all, 1, MPI_INT, MPI_MAX, world);
  return all;
}

/** Finds bodies that touch: they hide free surfaces of each other, even if they do not conduct. */
void MPMHeatFlow::find_neighbors()
{
  if (std::none_of(options.surfaces.begin(), options.surfaces.end(), [](const auto &s) {
        return s.region.empty();
      }))
    return;
  const auto contacts = find_fixes<FixMPMContact>(lmp);
  for (auto &surface : surfaces)
    for (auto &field : fields) {
      const auto &mine = surface->body.field, &other = field->field;
      if (std::any_of(contacts.begin(), contacts.end(), [&](auto *fix) {
            return fix->couples(mine.id(), other.id());
          }))
        surface->neighbors.push_back(&body_in(other));
    }
}

void MPMHeatFlow::init_contacts()
{
  for (auto &one : options.surfaces) {
    check_condition(one.condition, one.region.empty() ? "surface" : "region " + one.region);
    if (one.region.empty()) continue;
    auto *region = domain->get_region_by_id(one.region);
    if (!region)
      error->all(FLERR, Error::NOLASTLINE, "Fix mpm/heat region {} does not exist", one.region);
    if (MPMRegionSurface(region, domain->dimension).is_open())
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat cannot use region {}: open faces have no inside", one.region);
    if (region->dynamic_check() && region->nregion > 1)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat cannot use region {}: a union or intersection must not move; use "
                 "its parts one by one",
                 one.region);
  }
  for (auto &p : options.pairs) {
    const auto contacts = find_fixes<FixMPMContact>(lmp);
    if (std::none_of(contacts.begin(), contacts.end(), [&](auto *fix) {
          return fix->couples(p.field[0], p.field[1]);
        }))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat contact {} {}: there is no contact between two fix mpm with these "
                 "IDs: define a fix mpm/contact {} {}",
                 p.field[0], p.field[1], p.field[0], p.field[1]);
    find_variable(lmp, p.conductance, "fix mpm/heat contact");
  }
  bodies.clear();
  contacts.clear();
  surfaces.clear();
  for (auto &field : fields)
    if (!options.surfaces.empty() && field->conducts())
      surfaces.push_back(
          std::make_unique<MPMHeatSurfaces>(lmp, body_in(field->field), options.surfaces, sigma()));
  find_neighbors();
  for (auto &field : fields)
    if (field->conducts() && field->faces.any() && weighs_faces(field->field))
      body_in(field->field);
  for (const auto &p : options.pairs) {
    MPMHeatBody *body[2];
    for (int k = 0; k < 2; k++) {
      auto *const of = MPMField::find(lmp, p.field[k]);
      if (!of)
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/heat contact {} {}: there is no fix mpm with the ID {}", p.field[0],
                   p.field[1], p.field[k]);
      body[k] = &body_in(*of);
      if (!has_conducting_points(body[k]->field, world))
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/heat contact {} {}: no material of fix mpm {} conducts heat: give it "
                   "the part 'thermal conducting', or remove the contact",
                   p.field[0], p.field[1], p.field[k]);
    }
    contacts.push_back(std::make_unique<MPMHeatContact>(lmp, *body[0], *body[1], p));
  }
}

void MPMHeatFlow::extend_topology(MPMField &field)
{
  in(field).extend_topology();
  for (auto &surface : surfaces)
    if (&surface->body.field == &field) surface->extend_topology();
  for (auto &contact : contacts) contact->extend_topology(field);
}

void MPMHeatFlow::topology_changed(MPMField &field)
{
  in(field).faces.topology_changed();
  in(field).find_points(bodies.empty() && !levels_with(in(field)));
  for (auto &body : bodies) body->topology_changed();
  for (auto &surface : surfaces) surface->topology_changed();
  for (auto &contact : contacts) contact->topology_changed();
}

/** Are nodes needed that no point reaches? Conduction alone needs none, but lines through surfaces
 *  do. */
bool MPMHeatFlow::looks_beyond_points() const
{
  return !bodies.empty() || std::any_of(fields.begin(), fields.end(), [](const auto &field) {
    return field->has_materials() && (field->faces.any() || field->looks_beyond_points());
  });
}

MPMConduction &MPMHeatFlow::in(const MPMField &field) const
{
  for (const auto &mine : fields)
    if (&mine->field == &field) return *mine;
  error->all(FLERR, Error::NOLASTLINE, "Fix mpm/heat does not know fix mpm {}", field.id());
  return *fields[0];
}

/* ---------------------------------------------------------------------- */

/** Checks the values of variables by the same rules as numbers in the input. */
void MPMHeatFlow::check_values() const
{
  const auto refuse = [&](bool wrong, const std::string &where, const MPM_NS::NumberOrVariable &v,
                          double now, const char *needed) {
    if (wrong)
      error->all(FLERR, Error::NOLASTLINE, "Fix mpm/heat {}: {} = {:.6g}, but it must {}", where,
                 v.variable.empty() ? "the value" : "variable " + v.variable, now, needed);
  };
  const bool absolute = options.radiates();
  const auto check = [&](const MPMHeatCondition &c, const std::string &where) {
    const int T = c.kind == MPMHeatCondition::TEMPERATURE ? 0
        : c.kind == MPMHeatCondition::CONVECTION          ? 1
                                                          : -1;
    if (absolute && T >= 0)
      refuse(!(c.now[T] >= 0.0), where, c.value[T], c.now[T],
             "be an absolute temperature, not below 0, where something radiates");
    if (c.kind < MPMHeatCondition::CONVECTION) return;
    refuse(!(c.now[0] >= 0.0), where, c.value[0], c.now[0], "not be negative");
    if (c.kind != MPMHeatCondition::RADIATION) return;
    refuse(c.now[0] > 1.0, where, c.value[0], c.now[0], "not be above 1");
    refuse(!(c.now[1] >= 0.0), where, c.value[1], c.now[1],
           "be an absolute temperature, not below 0");
  };
  for (int face = 0; face < MPMHeatFaces::NFACE; face++)
    check(options.conditions[face], MPMHeatOptions::FACE_NAME[face]);
  for (const auto &[region, c] : options.surfaces)
    check(c, region.empty() ? "surface" : "region " + region);
  for (const auto &p : options.pairs)
    refuse(!(p.now >= 0.0), fmt::format("contact {} {}", p.field[0], p.field[1]), p.conductance,
           p.now, "not be negative");
}
