/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "heat/fix_mpm_heat.h"

#include "atom.h"
#include "base/mpm_options.h"
#include "base/mpm_pair_styles.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "contact/pair_mpm_penalty.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_friction_heat.h"
#include "force.h"
#include "implicit/fix_mpm_implicit.h"
#include "input.h"
#include "material/softening.h"
#include "region.h"
#include "variable.h"
#include "walls/mpm_region_surface.h"

#include <algorithm>
#include <limits>

using namespace LAMMPS_NS;
using namespace FixConst;
using namespace MPM_NS;
using Data = MPMStageData;    // what stages read and write

FixMPMHeat::FixMPMHeat(LAMMPS *lmp, int narg, char **arg) :
    FixMPMState(lmp, narg, arg), flow(lmp, options, gradients, id), doubts(lmp)
{
  if (igroup != 0)
    error->all(FLERR, 1,
               "Fix mpm/heat acts on all points whose material has a part thermal conducting: use "
               "group all");
  Options declared = options.declare(domain->dimension);
  read_options(lmp, declared, narg, arg, 3);
  scalar_flag = vector_flag = 1;
  size_vector = flow.n();
  flow.set_size(size_vector);
  global_freq = 1;
  extscalar = extvector = 1;
  restart_global = 1;
  if (options.transfer.has_slopes())
    state.declare(gradients, "mpm/heat:gradient", domain->dimension);
  options.gives_grains = declared.given("grains");
  options.gives_penalty = declared.given("penalty");
  if (options.penalty) state.declare(rubbing, "mpm/heat:rubbing", 1);
  if (options.grains) {
    state.declare(waiting, "mpm/heat:waiting", 1);
    grain_heat = std::make_unique<MPMGrainHeat>(lmp, waiting);
    nevery = 1;
  }
  keep_arrays();
}

int FixMPMHeat::setmask()
{
  const int report = options.in_time.time == MPMDiffusionOptions::EXPLICIT ? 0 : (int) POST_RUN;
  return report | (options.grains ? POST_INTEGRATE | POST_FORCE | END_OF_STEP : 0) |
      (options.penalty ? (int) POST_FORCE : 0);
}

void FixMPMHeat::init()
{
  require_field(lmp, *this);
  if (options.grains) require_each_step("grains yes");
  if (options.penalty) require_each_step("penalty yes");
  refuse_second(lmp, *this, "one acts on all points and faces");
  if (options.grains)
    grain_heat->init();
  else if (atom->heatflow_flag && !options.gives_grains)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/heat: atoms have heat flows, of which material points would know nothing: say "
        "grains yes, or grains no if they exchange none with points");
  find_rubbers();
  warn_of_friction();
  const auto materials = find_fixes<FixMPMMaterial>(lmp);
  if (std::none_of(materials.begin(), materials.end(), [](auto *fix) {
        return fix->material->conducts();
      }))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/heat: no material conducts heat: give a fix mpm/material the part "
               "'thermal conducting' with specific heat, temperature, and conductivity");
  for (int face = 0; face < MPMHeatFaces::NFACE; face++) {
    if (options.conditions[face].kind == MPMHeatCondition::INSULATED) continue;
    if (domain->periodicity[face / 2])
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat face {} belongs to a periodic axis: use boundary f there",
                 MPMHeatOptions::FACE_NAME[face]);
    flow.check_condition(options.conditions[face], MPMHeatOptions::FACE_NAME[face]);
  }
  if (!options.source.empty()) {
    const int source_index = input->variable->find(options.source.c_str() + 2);
    if (source_index < 0 ||
        !(input->variable->equalstyle(source_index) || input->variable->atomstyle(source_index)))
      error->all(FLERR, Error::NOLASTLINE, "Variable {} for fix mpm/heat source {}",
                 options.source.substr(2),
                 source_index < 0 ? "does not exist" : "is not equal-style or atom-style");
    flow.find_source(source_index);
  }
}

/** Refuses every > 1 if other atoms give heat to nodes in each step. */
void FixMPMHeat::require_each_step(const char *giver) const
{
  if (options.every > 1)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/heat {} every {}: {} gives heat to nodes in each step: use every 1", id,
               options.every, giver);
}

/** Finds pair styles between bodies; their init() has been called before. */
void FixMPMHeat::find_rubbers()
{
  rubbers.clear();
  if (!options.penalty) return;
  for (const auto &style : MPMPairStyle::all(*force)) {
    auto *const pair = dynamic_cast<PairMPMPenalty *>(style.pair);
    if (!pair || !pair->takes_energy()) continue;
    pair->make_heat();
    rubbers.push_back(pair);
  }
  if (rubbers.empty())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/heat penalty: there is no pair style mpm/penalty with friction or damping: "
               "give its pair_coeff one of these, or drop the keyword");
}

void FixMPMHeat::give(const MPMField &field, std::size_t node, double heat, bool counts)
{
  auto &given = flow.in(field).given;
  if (given.empty()) given.resize(field.grid.nnodes(), 0.0);
  given[node] += heat;
  if (counts) book(MPMHeatFlow::FRICTION, heat);
}

/** Warns once of friction whose heat is lost, unless the input says that this is intended. */
void FixMPMHeat::warn_of_friction()
{
  if (losses_known) return;
  losses_known = true;
  if (comm->me) return;
  for (auto *rubbing : find_fixes<MPMRubbing>(lmp)) {
    const auto *const fix = dynamic_cast<Fix *>(rubbing);
    if (rubbing->loses_heat())
      error->warning(
          FLERR,
          "Fix {} {}: what its friction takes is lost, and warms nothing of fix mpm/heat "
          "{}: give it heat yes, or heat no if that is meant",
          fix->style, fix->id, id);
  }
  for (const auto &style : MPMPairStyle::all(*force)) {
    const auto *const pair = dynamic_cast<PairMPMPenalty *>(style.pair);
    if (pair && pair->takes_energy() && !options.gives_penalty)
      error->warning(FLERR,
                     "Pair style {}: what its friction and damping take is lost, and warms nothing "
                     "of fix mpm/heat {}: give that penalty yes, or penalty no if this is meant",
                     style.name, id);
    if (!pair && style.name.compare(0, 4, "gran") == 0 && !options.gives_grains)
      error->warning(FLERR,
                     "Pair style {}: what its friction and damping take is lost, and warms nothing "
                     "of fix mpm/heat {}: give that grains no or yes if this is meant",
                     style.name, id);
  }
}

/** Forces of pair styles act in the next step, and so does the heat of their friction. */
void FixMPMHeat::setup(int)
{
  flow.clear_iterations();
  take_rubbing();
  check_temperatures();
  check_places();
}

/** Conditions where no material is, or where it is inside of what is a wall for heat. */
void FixMPMHeat::check_places()
{
  constexpr double FAR = std::numeric_limits<double>::max(), NEAR = 1.5;
  double mine[MPMHeatFaces::NFACE], least[MPMHeatFaces::NFACE];
  std::fill_n(mine, (int) MPMHeatFaces::NFACE, FAR);
  const std::size_t nregion = options.surfaces.size();
  std::vector<bigint> places(2 * nregion + 1, 0), all(places.size());    // inside, near; any
  std::vector<std::unique_ptr<MPMRegionSurface>> regions;
  for (const auto &one : options.surfaces) {
    auto *const region = one.region.empty() ? nullptr : domain->get_region_by_id(one.region);
    if (region) region->prematch();
    regions.push_back(region ? std::make_unique<MPMRegionSurface>(region, domain->dimension)
                             : nullptr);
  }
  for (const auto &of : flow.fields) {
    const MPMField &field = of->field;
    const double h = field.lattice.h;
    for (int i = 0; i < atom->nlocal; i++) {
      if (!field.is_point(i)) continue;
      const auto *const material = field.material_of(i);
      if (!material || !material->material->conducts()) continue;
      const double *const x = field.frame->places()[i];
      for (int face = 0; face < MPMHeatFaces::NFACE; face++) {
        const int d = face / 2;
        const double at = face % 2 ? domain->boxhi[d] - x[d] : x[d] - domain->boxlo[d];
        mine[face] = std::min(mine[face], at / h);
      }
      places[2 * nregion]++;
      for (std::size_t k = 0; k < nregion; k++) {
        if (!regions[k]) continue;
        const double distance = regions[k]->distance(x, (NEAR + 0.01) * h);
        places[k] += distance < -h;
        places[nregion + k] += std::fabs(distance) < NEAR * h;
      }
    }
  }
  MPI_Allreduce(mine, least, (int) MPMHeatFaces::NFACE, MPI_DOUBLE, MPI_MIN, world);
  MPI_Allreduce(places.data(), all.data(), (int) all.size(), MPI_LMP_BIGINT, MPI_SUM, world);
  const std::string who = fmt::format("Fix mpm/heat {}", id);
  for (int face = 0; face < MPMHeatFaces::NFACE; face++)
    if (options.conditions[face].kind != MPMHeatCondition::INSULATED && least[face] < FAR)
      doubts.check(
          MPMDoubts::FACE_ALONE, least[face], who,
          fmt::format("{} has a condition, and the nearest material that conducts is {:.3g} "
                      "node spacings away from it",
                      MPMHeatOptions::FACE_NAME[face], least[face]));
  for (std::size_t k = 0; k < nregion; k++) {
    if (options.surfaces[k].condition.kind == MPMHeatCondition::INSULATED) continue;
    doubts.check(MPMDoubts::INSIDE_REGION, (double) all[k], who,
                 fmt::format("{} points are in region {}, more than a node spacing below its "
                             "surface",
                             all[k], options.surfaces[k].region));
    auto *const region = domain->get_region_by_id(options.surfaces[k].region);
    if (region && !region->dynamic_check() && all[2 * nregion] > 0)
      doubts.check(MPMDoubts::REGION_ALONE, all[nregion + k] == 0 ? 1.0 : 0.0, who,
                   fmt::format("region {} has a condition, and no material that conducts is within "
                               "{} node spacings of its surface",
                               options.surfaces[k].region, NEAR));
  }
}

void FixMPMHeat::check_temperatures()
{
  const auto look = [&](const MPMHeatCondition &wall) {
    if (wall.kind != MPMHeatCondition::TEMPERATURE || !wall.value[0].variable.empty()) return;
    for (const auto &of : flow.fields)
      for (const auto *material : of->field.materials) {
        const auto range = softening_range(*material->material);
        if (range && range->melting > 0.0)
          doubts.check(MPMDoubts::MOLTEN_WALL, wall.value[0].value / range->melting,
                       fmt::format("Fix mpm/heat {}", id),
                       fmt::format("a wall has the temperature {:.6g}, and the strength of fix "
                                   "mpm/material {} ends at {:.6g}",
                                   wall.value[0].value, material->id, range->melting));
      }
  };
  for (const auto &condition : options.conditions) look(condition);
  for (const auto &surface : options.surfaces) look(surface.condition);
  if (!options.radiates()) return;
  constexpr double ICE = 273.15;    // kelvins
  double mine = std::numeric_limits<double>::max(), lowest;
  for (const auto &of : flow.fields)
    for (const auto *material : of->field.materials) {
      const int column = material->temperature();
      if (!material->material->conducts()) continue;
      for (int i = 0; i < atom->nlocal; i++) {
        if (!(atom->mask[i] & material->groupbit) || !of->field.is_point(i)) continue;
        const double T = material->history[i][column];
        if (!(T >= 0.0))
          error->one(FLERR, Error::NOLASTLINE,
                     "Fix mpm/heat {} radiation needs absolute temperatures, but point {} has the "
                     "temperature {:.6g}: give all temperatures in kelvins",
                     id, atom->tag[i], T);
        mine = std::min(mine, T);
      }
    }
  MPI_Allreduce(&mine, &lowest, 1, MPI_DOUBLE, MPI_MIN, world);
  doubts.check(MPMDoubts::COLD, lowest / ICE, fmt::format("Fix mpm/heat {}", id),
               fmt::format("the lowest temperature of a point is {:.6g}", lowest));
}

void FixMPMHeat::post_force(int)
{
  if (options.grains) grain_heat->note_step();
  take_rubbing();
}

void FixMPMHeat::take_rubbing()
{
  if (!options.penalty) return;
  for (int i = 0; i < atom->nlocal; i++) {
    rubbing[i][0] = 0.0;
    for (const auto *pair : rubbers) rubbing[i][0] += pair->heating(i);
  }
}

void FixMPMHeat::give_rubbing(double dt)
{
  double sum = 0.0;
  for (auto &of : flow.fields) {
    if (!of->conducts()) continue;
    clear_points(rubbed, atom);
    for (int i = 0; i < atom->nlocal; i++)
      if (of->field.is_point(i)) sum += rubbed[i] = dt * rubbing[i][0];
    of->give(rubbed);
  }
  book(MPMHeatFlow::FRICTION, sum);
}

void FixMPMHeat::init_physics(MPMPlan &plan)
{
  // fix mpm calls this before init() of this fix
  const auto all = find_fixes<MPMRubbing>(lmp);
  flow.has_friction = std::any_of(all.begin(), all.end(), [](const auto *fix) {
    return fix->gives_heat();
  });
  flow.clear();
  for (auto *field : plan.fields) {
    const auto &o = field->options;
    refuse_field(lmp, *this, *field,
                 {{o.modified_edges, "edges modified", "use edges plain"},
                  {o.axisymmetric && domain->boxlo[0] <= 1.0e-6 * field->lattice.h &&
                       options.conditions[0].kind != MPMHeatCondition::INSULATED,
                   "a condition at xlo, which is the axis of symmetry", "leave xlo insulated"}});
    const bool touches =
        std::any_of(options.pairs.begin(), options.pairs.end(), [&](const auto &p) {
          return p.field[0] == field->id() || p.field[1] == field->id();
        });
    refuse_field(lmp, *this, *field,
                 {{o.total && touches, "frame total with contact",
                   "its nodes are not where the body is, and do not know where bodies touch: use "
                   "frame updated"}});
    field->refuse_element_nodes(*this,
                                "through which no heat goes: give them a fix mpm/material without "
                                "thermal conducting",
                                [](const FixMPMMaterial *of) {
                                  return of->material->conducts();
                                });
    if (gradients) field->slopes.push_back(&gradients);
    flow.add(*field);
  }
  flow.init_contacts();
  flow.init_levels(plan);
  flow.init_waits();
}

void FixMPMHeat::add_stages(MPMPlan &plan, MPMPlan::Place place)
{
  // points strain at the end of a step with their temperatures at that time: an implicit step must
  // know these before
  const bool is_implicit = !find_fixes<FixMPMImplicit>(lmp).empty();
  if (place == (is_implicit ? MPMPlan::BEFORE_SOLVE : MPMPlan::AFTER_SOLVE))
    plan.together("conduction of heat",
                  {Data::POSITION, Data::DEFORMATION, Data::STRESS, Data::HISTORY, Data::MASS,
                   Data::NODES, Data::BLOCKS, Data::OWN},
                  {Data::STRESS, Data::HISTORY, Data::OWN}, [this]() {
                    conduct();
                  });
}

/** Entries of compute mpm/energy. The heat of points is a sum over points, separate from the heat
 *  that nodes were given. */
std::vector<MPMPhysics::Account> FixMPMHeat::accounts() const
{
  return {{"conducted heat", true, false, true},
          {"heat through faces", false},
          {"heat of sources", false},
          {"heat of friction", false},
          {"heat of grains", false}};
}

void FixMPMHeat::account(double *values) const
{
  values[0] += flow.totals.got;
  if (options.grains) values[0] += grain_heat->sum_waiting();
  values[1] += flow.totals.through_faces;
  values[2] += flow.totals.of_sources;
  for (int k = 0; k < MPMHeatFlow::NGIVER; k++)
    values[3 + k] += flow.totals.given[k] + flow.totals.booked[k];
}

double FixMPMHeat::energy_at_hand() const
{
  double heat = 0.0;
  for (const auto &of : flow.fields)
    if (of->conducts()) heat += of->heat_of_points();
  return heat;
}

void FixMPMHeat::conduct()
{
  if (flow.wait()) return;
  flow.begin();
  for (auto &field : flow.fields)
    if (options.grains && field->conducts()) grain_heat->give(*field);
  if (options.penalty) give_rubbing(flow.fields[0]->field.step_dt());
  flow.conduct();
}

double FixMPMHeat::memory_usage()
{
  double bytes =
      FixMPMState::memory_usage() + flow.memory_usage() + rubbed.capacity() * sizeof(double);
  if (options.grains) bytes += grain_heat->memory_usage();
  return bytes;
}
