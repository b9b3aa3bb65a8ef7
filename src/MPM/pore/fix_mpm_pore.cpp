/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "pore/fix_mpm_pore.h"

#include "atom.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "contact/fix_mpm_rigid.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "force.h"
#include "implicit/fix_mpm_implicit.h"
#include "implicit/fix_mpm_relax.h"
#include "input.h"
#include "modify.h"
#include "pore/mpm_geostatic.h"
#include "step/fix_mpm.h"
#include "step/fix_mpm_dt.h"
#include "variable.h"
#include "walls/fix_mpm_boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;
using Data = MPMStageData;    // what stages read and write

/** fix ID all mpm/pore K RHO G keyword values ... */
FixMPMPore::FixMPMPore(LAMMPS *lmp, int narg, char **arg) :
    FixMPMState(lmp, narg, arg), flow(lmp, options, points, id), checks(lmp, options, id)
{
  if (igroup != 0)
    error->all(FLERR, 1, "Fix mpm/pore acts on all points of its soils: use group all");
  Options declared = options.declare(domain->dimension);
  read_options(lmp, declared, narg, arg, 3);
  options.sets_relax = declared.given("relax");
  options.sets_stages = declared.given("stages");
  options.sets_every = declared.given("every");
  if (options.sets_every && options.waits() && options.sets_relax)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/pore relax has no meaning with every {}, where points take the pressure of "
               "the nodes in each flow: remove it",
               options.every == MPMPoreOptions::AUTO ? "auto" : std::to_string(options.every));
  if (options.soils.empty())
    error->all(FLERR, narg - 1,
               "Fix mpm/pore needs a soil: use soil with the ID of a fix mpm/material, its "
               "porosity, and permeability");
  initial_index = -1;
  if (options.initial.compare(0, 2, "v_") == 0) {
    initial_index = input->variable->find(options.initial.c_str() + 2);
    if (initial_index < 0 || !input->variable->atomstyle(initial_index))
      error->all(FLERR, Error::NOLASTLINE, "Variable {} for fix mpm/pore initial {}",
                 options.initial.substr(2),
                 initial_index < 0 ? "does not exist" : "is not atom-style");
  } else {
    initial_value = utils::numeric(FLERR, options.initial, false, lmp);
  }
  state.declare(points.pressure, "mpm/pore:pressure", 1 + domain->dimension,
                [this](int, double *row) {
                  row[0] = initial_value;
                });
  // declared even if water does not wait now: a run that continues from a restart file may have
  // other conditions
  if (options.can_wait()) state.declare(points.since, "mpm/pore:since");
  if (options.formulation == MPMPoreOptions::U_V_P)
    state.declare(points.inertia, "mpm/pore:flow", domain->dimension);
  if (options.can_dry())
    state.declare(points.content, "mpm/pore:water", [](int, double *row) {
      row[0] = -1.0;
    });
  if (options.warms())
    state.declare(points.warmth, "mpm/pore:temperature", [](int, double *row) {
      row[0] = MPMPore::UNKNOWN;
    });
  const auto at_first = initial_pressures();    // may end with an error: before there are callbacks
  keep_arrays();
  scalar_flag = vector_flag = 1;
  size_vector = MPMPoreSurface::NPART;
  global_freq = 1;
  extscalar = extvector = 1;
  restart_global = 1;
  for (std::size_t i = 0; i < at_first.size(); i++) points.pressure[i][0] = at_first[i];
  if (initial_index >= 0) flow.gradients_known = false;
  for (const auto &soil : options.soils)
    if (auto *fix = dynamic_cast<FixMPMMaterial *>(modify->get_fix_by_id(soil.material)))
      fix->mass_varies = true;
}

FixMPMPore::~FixMPMPore()
{
  for (const auto &soil : options.soils)
    if (auto *fix = dynamic_cast<FixMPMMaterial *>(modify->get_fix_by_id(soil.material)))
      fix->mass_varies = false;
}

/** Initial pressures of the present points; a restart file has others. */
std::vector<double> FixMPMPore::initial_pressures() const
{
  if (initial_index < 0) return {};
  std::vector<double> values(atom->nmax);
  input->variable->compute_atom(initial_index, igroup, values.data(), 1, 0);
  values.resize(atom->nlocal);
  for (int i = 0; i < atom->nlocal; i++)
    if (!std::isfinite(values[i]))
      error->one(FLERR, "Variable {} for fix mpm/pore initial is {} at point {}",
                 options.initial.substr(2), values[i], atom->tag[i]);
  return values;
}

void FixMPMPore::init()
{
  require_field(lmp, *this);
  refuse_second(lmp, *this, "one has all soils, each with a keyword soil");
  checks.check_soils();
  checks.check_grains();
  flow.weight = MPMGravity(lmp, "Fix mpm/pore");
  for (int part = 0; part < MPMPoreSurface::NPART; part++) {
    auto &c = options.conditions[part];
    if (c.kind == MPMPoreCondition::CLOSED) continue;
    if (part < MPMPoreSurface::NFACE && domain->periodicity[part / 2])
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/pore face {} belongs to a periodic axis: use boundary f there",
                 MPMPoreOptions::PART_NAME[part]);
    if (c.kind == MPMPoreCondition::HEAD && flow.weight.empty())
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/pore {} head needs a fix gravity of group all, which tells where up is",
                 MPMPoreOptions::PART_NAME[part]);
    find_variable(lmp, c.value, std::string("fix mpm/pore ") + MPMPoreOptions::PART_NAME[part]);
  }
}

/** Finds bodies that close the free surface where they touch it. */
void FixMPMPore::find_seals()
{
  rigid_bodies.clear();
  walls.clear();
  if (!options.seals) return;
  if (options.conditions[MPMPoreSurface::FREE].kind == MPMPoreCondition::CLOSED)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/pore bodies closed needs a free surface that is open elsewhere: use free, "
               "or leave it out");
  for (const auto *body : find_fixes<FixMPMRigid>(lmp)) rigid_bodies.push_back(body);
  for (const auto *wall : find_fixes<FixMPMBoundary>(lmp))
    if (wall->is_region()) walls.push_back(wall);
  if (rigid_bodies.empty() && walls.empty())
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/pore bodies closed: there is no fix mpm/rigid, and no fix mpm/boundary with "
        "a region");
}

double FixMPMPore::distance_to_bodies(const double *x, double far) const
{
  double least = far;
  for (const auto *body : rigid_bodies) least = std::min(least, body->distance(x, far));
  for (const auto *wall : walls) least = std::min(least, wall->distance(x, far));
  return least;
}

void FixMPMPore::init_physics(MPMPlan &plan)
{
  if (moves() && !find_fixes<FixMPMRelax>(lmp).empty())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/relax cannot bring water with inertia to rest: use formulation u-p of fix "
               "{} {} until bodies are at rest",
               style, id);
  flow.clear();
  find_seals();
  if (!options.sets_every) options.every = flow.needs_each_step() ? 1 : MPMPoreOptions::AUTO;
  for (auto *field : plan.fields) {
    field->refuse_element_nodes(*this,
                                "which have no pores: give them a fix mpm/material of their own, "
                                "without a keyword soil",
                                [this](const FixMPMMaterial *of) {
                                  return options.has(of->id);
                                });
    auto &mine = flow.add(*field);
    if (options.seals)
      mine.surface.distance_to_seals = [this](const double *x, double far) {
        return distance_to_bodies(x, far);
      };
    if (options.waits()) mine.wait_with(points.since);
    mine.init(options.soils, points.content, points.warmth);
    if (!mine.has_water()) continue;
    flow.add_wet(mine);
    if (options.formulation == MPMPoreOptions::U_V_P) {
      field->keep_old_velocities();
      checks.check_motion(*this, *field);
    }
    const auto &o = field->options;
    refuse_field(
        lmp, *this, *field,
        {{o.shape != QUADRATIC && o.shape != CUBIC, "this shape", "use shape quadratic or cubic"},
         {o.scheme != MPMFieldOptions::USL, "this scheme", "use scheme usl"},
         {o.total, "frame total", "use frame updated"},
         {o.axisymmetric, "axisymmetric", "use a plane or 3d"},
         {o.modified_edges, "edges modified", "use edges plain"},
         {o.averages_stress() || o.averages_volume() || o.averages_strain(), "locking",
          "the pressure of the water is an average already: use locking none"}});
  }
  flow.find_crossing();
  flow.watch.warn_of_contact();
  flow.is_implicit = !flow.wet.empty() && !find_fixes<FixMPMImplicit>(lmp).empty();
  if (!options.waits()) flow.end_wait();
  // soils that dry have no other formulation, and bodies that relax to rest have no motion of their
  // own
  flow.watch.start(options.formulation == MPMPoreOptions::U_P && !flow.is_implicit &&
                   !options.can_dry() && find_fixes<FixMPMRelax>(lmp).empty());
  if (flow.is_implicit) checks.check_implicit();
}

/** Before the time step is refused that is due to a wrong number. */
void FixMPMPore::setup_pre_force(int)
{
  if (find_fixes<FixMPMDt>(lmp).empty()) warn_of_soils();
}

/** Now the time step is known that fix mpm/dt sets. */
void FixMPMPore::setup(int)
{
  if (!find_fixes<FixMPMDt>(lmp).empty()) warn_of_soils();
}

void FixMPMPore::warn_of_soils()
{
  std::vector<MPMPoreChecks::Extent> extents(options.soils.size());
  for (int i = 0; i < atom->nlocal; i++) {
    const auto *const soil = atom->vfrac[i] > 0.0 ? flow.soil_of(i) : nullptr;
    for (std::size_t k = 0; k < options.soils.size() && soil; k++)
      if (options.soils[k].material == soil->material) extents[k].take(atom->x[i]);
  }
  MPMPoreChecks::Scene scene = {std::numeric_limits<double>::max(), 0.0, {}};
  for (const auto &mine : flow.fields) scene.h = std::min(scene.h, mine->field.lattice.h);
  scene.duration = update->dt * (double) update->nsteps;
  for (const auto *fix : find_fixes<FixMPMDt>(lmp)) scene.duration = fix->time_left(scene.duration);
  flow.weight.find(scene.gravity);
  checks.warn_of_soils(extents, !flow.weight.empty(), scene);
}

void FixMPMPore::add_stages(MPMPlan &plan, MPMPlan::Place place)
{
  if (place == MPMPlan::BEFORE_POINTS_TO_NODES)
    plan.together("pore pressure",
                  {Data::POSITION, Data::DEFORMATION, Data::MASS, Data::BLOCKS, Data::OWN},
                  {Data::MASS, Data::OWN}, [this]() {
                    flow.begin_step();
                  });
  if (place == MPMPlan::BEFORE_SOLVE && options.formulation == MPMPoreOptions::U_V_P)
    plan.together("inertia of pore water", {Data::NODES, Data::BLOCKS, Data::OWN},
                  {Data::NODES, Data::OWN}, [this]() {
                    flow.separate_inertia();
                  });
  if (place == MPMPlan::AFTER_SOLVE && !flow.is_implicit) {
    const auto move = [this](MPMField &field) {
      flow.take_motion(field);
    };
    plan.each("nodes to points with material",
              {Data::POSITION, Data::VELOCITY, Data::AFFINE, Data::DEFORMATION, Data::STRESS,
               Data::HISTORY, Data::NODES, Data::BLOCKS, Data::OWN},
              {Data::VELOCITY, Data::AFFINE, Data::DEFORMATION, Data::STRESS, Data::HISTORY,
               Data::NODES, Data::OWN},
              move, [this](const MPMField &field) {
                return flow.in(field).moves_first();
              });
    plan.together(
        "flow of pore water",
        {Data::POSITION, Data::DEFORMATION, Data::MASS, Data::NODES, Data::BLOCKS, Data::OWN},
        {Data::MASS, Data::NODES, Data::OWN}, [this]() {
          flow.advance();
        });
  }
  // at this point, fix mpm/implicit has left the velocities of the step on nodes
  if (place == MPMPlan::BEFORE_STRAIN && flow.is_implicit)
    plan.together("flow of pore water",
                  {Data::POSITION, Data::DEFORMATION, Data::NODES, Data::BLOCKS, Data::OWN},
                  {Data::MASS, Data::NODES, Data::OWN}, [this]() {
                    flow.take_solution();
                  });
}

/** Pores of soils without retention are full of water, also above the water table, where suction
 *  holds it. */
void FixMPMPore::setup_points()
{
  const bool at_rest = options.geostatic && !has_state;
  for (const auto *mine : flow.wet) {
    const auto *const fix = dynamic_cast<FixMPM *>(modify->get_fix_by_id(mine->field.id()));
    if (fix && fix->rests_dry && !options.geostatic && !has_state)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/pore: points of fix mpm {} have the stress of mpm_geostatic, which does "
                 "not know pore water: use keyword geostatic of fix mpm/pore in its place",
                 mine->field.id());
  }
  has_state = true;
  if (!at_rest) {
    flow.weigh_points();
    return;
  }
  if (flow.fields.size() != 1)
    error->all(FLERR, Error::NOLASTLINE, "Fix mpm/pore geostatic needs one fix mpm, not {}",
               flow.fields.size());
  flow.weight.find(flow.gravity);
  MPMGeostatic ground(lmp, flow.fields[0]->field, flow.gravity, "Fix mpm/pore geostatic");
  const auto &where = ground.ground();
  if (options.table > where.top + 0.01 * flow.fields[0]->field.lattice.h)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/pore geostatic: the water table {} is above the surface of the soil, {:.6g}: "
        "water on the soil changes no effective stress, use the height of the surface",
        options.table, where.top);
  const double slope = options.water.density * where.weight * force->nktv2p;
  for (int i = 0; i < atom->nlocal; i++) {
    std::fill_n(points.pressure[i], 1 + domain->dimension, 0.0);
    const MPMPoreSoil *const soil = flow.soil_of(i);
    if (!soil) continue;
    points.pressure[i][0] = slope * (options.table - ground.height(i));
    points.pressure[i][1 + where.axis] = -slope * where.up;
    if (options.most_suction < 0.0 || points.pressure[i][0] >= -options.most_suction ||
        !soil->retention.can_dry())
      continue;
    points.pressure[i][0] = -options.most_suction;
    points.pressure[i][1 + where.axis] = 0.0;
  }
  flow.weigh_points();
  ground.set_stress(options.K0, [&](int i) {
    const auto *const soil = flow.soil_of(i);
    if (!soil) return 0.0;
    return soil->biot * soil->retention.at(points.pressure[i][0]).bishop * points.pressure[i][0];
  });
}

void FixMPMPore::topology_changed(MPMField &field)
{
  if (flow.in(field).has_water()) field.jacobians.ask();
}

bool FixMPMPore::surface_force(MPMField &field, const std::vector<char> &near,
                               std::vector<double> &force) const
{
  const MPMPore &mine = flow.in(field);
  if (mine.has_water()) mine.find_surface_force(points.pressure, near, force);
  return mine.has_water();
}

/** The energy that the water stores, and the part of its kinetic energy that mass and velocity of
 *  points do not include, for compute mpm/energy and the energy watch. */
void FixMPMPore::account(double *values) const
{
  double sum = 0.0, moving = 0.0;
  const auto *const state_of_points = MPMPoints::get(atom);
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->vfrac[i] > 0.0)) continue;
    const MPMPoreSoil *const soil = flow.soil_of(i);
    if (!soil) continue;
    const double J = state_of_points->jacobian(i), p = flow.pressure_now(i);
    sum += J * atom->vfrac[i] * MPMPoreMoisture::energy(*soil, J, p, options.water);
    if (!points.inertia) continue;
    const double pores = J * soil->pores_at(J);
    for (int d = 0; d < domain->dimension; d++)
      moving += atom->vfrac[i] * points.inertia[i][d] *
          (atom->v[i][d] + 0.5 * points.inertia[i][d] / pores);
  }
  values[0] += sum / force->nktv2p + options.water.density * moving * force->mvv2e;
  values[1] += flow.energy_came() / force->nktv2p;
}

std::vector<std::string> FixMPMPore::quantities() const
{
  std::vector<std::string> names = {"pore", "porosity", "saturation"};
  for (int d = 0; options.formulation == MPMPoreOptions::U_V_P && d < domain->dimension; d++)
    names.push_back(std::string("flow_") + (char) ('x' + d));
  return names;
}

double FixMPMPore::quantity(int k, int i) const
{
  const MPMPoreSoil *const soil = flow.soil_of(i);
  if (!soil) return 0.0;
  if (k == 0) return flow.pressure_now(i);
  if (k == 2) return soil->retention.at(points.pressure[i][0]).saturation;
  const double J = MPMPoints::get(atom)->jacobian(i);
  return k == 1 ? std::max(0.0, soil->porosity_at(J)) : points.inertia[i][k - 3] / J;
}
