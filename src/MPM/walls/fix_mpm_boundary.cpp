/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/fix_mpm_boundary.h"

#include "base/mpm_find_fixes.h"
#include "base/mpm_options.h"
#include "base/mpm_state.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_point_map.h"
#include "force.h"
#include "math_extra.h"
#include "modify.h"
#include "region.h"

#include <algorithm>
#include <cstring>
#include <utility>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static const char *const FACE_NAME[6] = {"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"};
static constexpr const char *PERIODIC =
    "Fix mpm/boundary face {} belongs to a periodic axis: use boundary f there";

FixMPMBoundary::FixMPMBoundary(LAMMPS *lmp, int narg, char **arg) :
    Fix(lmp, narg, arg), wall(lmp, arg[0]), reaction(lmp, wall), contact(wall, reaction),
    search(lmp, wall), thin_regions(lmp, wall), trial(lmp, wall, nodes, search), doubts(lmp)
{
  if (igroup != 0)
    error->all(FLERR, 1,
               "Fix mpm/boundary acts on nodes, which have no group: use group all, and keyword "
               "field to act on one of several fields");

  int iarg = read_place(narg, arg);

  // arguments: what the wall does
  Options options = wall.declare(domain->dimension);
  read_options(lmp, options, narg, arg, iarg);
  if (options.given("velocity") && options.given("displacement"))
    error->all(FLERR, options.where("displacement"),
               "Fix mpm/boundary takes a velocity or a displacement: use one of them");
  const double length = MathExtra::len3(wall.axis);
  for (int d = 0; d < 3 && wall.rotating(); d++) wall.axis[d] /= length;

  if (is_region()) {
    Region *const region = domain->get_region_by_id(wall.region_id);
    if (!region)
      error->all(FLERR, 4, "Region {} for fix mpm/boundary does not exist: define it before",
                 wall.region_id);
    wall.region = region;
    const bool driven = options.given("rotate") || options.given("velocity") ||
        options.given("displacement");
    if (driven && region->dynamic)
      error->all(FLERR,
                 "Fix mpm/boundary takes the velocity of region {} from its own motion: drop "
                 "velocity, displacement, and rotate, or the motion of the region",
                 wall.region_id);
  }

  if (slides_in_vain() && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/boundary {}: faces without friction do not feel that they move along "
                   "themselves: give friction, or use stick",
                   id);

  scalar_flag = vector_flag = 1;
  size_vector = 6;
  global_freq = 1;
  extscalar = extvector = 1;
  restart_global = 1;
}

/** Does the motion of smooth faces have a part along all of them? */
bool FixMPMBoundary::slides_in_vain() const
{
  if (is_region() || wall.kind == MPMWall::STICK || wall.rubs()) return false;
  for (int d = 0; d < 3; d++) {
    const auto &v = wall.velocity[d];
    const auto &faces = wall.face_list;
    const bool moves = v.value != 0.0 || !v.variable.empty();
    if (moves && std::none_of(faces.begin(), faces.end(), [d](int face) {
          return face / 2 == d;
        }))
      return true;
  }
  return false;
}

bool FixMPMBoundary::uses_region(const std::string &name) const
{
  const auto &patches = wall.patches;
  return name == wall.region_id ||
      std::any_of(patches.begin(), patches.end(), [&](const auto &one) {
           return one.region_id == name;
         });
}

/** Reads where the wall is; returns the index of the next argument. */
int FixMPMBoundary::read_place(int narg, char **arg)
{
  require_arguments(lmp, "fix mpm/boundary", narg, 3,
                    {"region or one or more of xlo xhi ylo yhi zlo zhi"});
  int iarg = 3;
  if (strcmp(arg[iarg], "region") == 0) {
    require_arguments(lmp, "fix mpm/boundary region", narg, iarg + 1, {"region-ID"});
    wall.region_id = arg[iarg + 1];
    iarg += 2;
  } else {
    for (; iarg < narg; iarg++) {
      const auto *const name = std::find(FACE_NAME, FACE_NAME + 6, std::string(arg[iarg]));
      const int face = (int) (name - FACE_NAME);
      if (face == 6) break;
      if (std::count(wall.face_list.begin(), wall.face_list.end(), face))
        error->all(FLERR, iarg, "Fix mpm/boundary face {} is given twice", arg[iarg]);
      if (face >= 4 && domain->dimension == 2)
        error->all(FLERR, iarg, "Fix mpm/boundary face {} does not exist in 2d", arg[iarg]);
      if (domain->periodicity[face / 2]) error->all(FLERR, iarg, PERIODIC, arg[iarg]);
      wall.face_list.push_back(face);
    }
    if (wall.face_list.empty())
      error->all(FLERR, iarg,
                 "Unknown fix mpm/boundary wall {}: must be region or one or more of xlo xhi ylo "
                 "yhi zlo zhi",
                 arg[iarg]);
  }
  return iarg;
}

void FixMPMBoundary::init()
{
  // fields, in the order of their definition
  require_field(lmp, *this);
  nodes.clear();    // listed with the topology
  wall.fields.clear();
  wall.init();
  for (auto *field : MPMField::all(lmp)) {
    if (!wall.acts_on(*field)) continue;
    wall.fields.push_back(field);
    nodes.emplace_back(wall, *field, *domain);
    check_field(*field);
  }
  if (nodes.empty())
    error->all(FLERR, Error::NOLASTLINE, "Fix mpm/boundary field {} is not the ID of a fix mpm",
               wall.field_id);

  for (auto &v : wall.velocity) find_variable(lmp, v, "fix mpm/boundary velocity");
  find_variable(lmp, wall.rate, "fix mpm/boundary rotate");
  wall.init_region();
  check_faces();
  trial.begin_run();
  has_rubbed = false;
  rubbing.clear();
  for (auto *fix : find_fixes<FixMPMBoundary>(lmp))
    if (fix->trial.has_friction()) rubbing.push_back(fix);
  thin_regions.begin_run();
  search.begin_run();
}

/** Other regions hold what is inside, as grips do; and later, points may be anywhere. */
void FixMPMBoundary::setup(int)
{
  wall.setup();
  if (!wall.region || wall.kind != MPMWall::SEPARATE || wall.state.acted) return;
  doubts.check_inside("Fix mpm/boundary " + std::string(id), "its region " + wall.region_id,
                      wall.fields, [this](const double *x, double far) {
                        return distance(x, far);
                      });
}

/** Refuses options of the field that do not work with this wall. */
void FixMPMBoundary::check_field(const MPMField &field) const
{
  const std::string keeps = "its nodes keep to the same material wherever it goes: instead of ";
  refuse_field(
      lmp, *this, field,
      {{field.options.total && wall.kind == MPMWall::SEPARATE, "frame total",
        keeps + "separate, use fix wall/gran or a pair style"},
       {field.options.total && wall.region_moves(), "frame total",
        keeps + "a moving region, use stick velocity with variables, displacement, or rotate"},
       {field.options.total && !wall.patches.empty(), "frame total",
        keeps + "patch, use frame updated"},
       {field.options.total && wall.rotating() && wall.kind != MPMWall::STICK, "frame total",
        keeps + "slip on a wall that turns, use stick"},
       {field.options.total && wall.rotating() && field.options.stress_before(),
        "scheme usf and usavg", "they ask for the rotation of the step before: use usl or musl"},
       {field.options.total != wall.fields[0]->options.total && wall.rotating(), "frame total",
        "the wall also turns fields of frame updated, whose nodes are elsewhere: use a fix "
        "mpm/boundary with keyword field for each"},
       {field.options.most_distorted > 0.0 && wall.is_driven(), "reference update",
        "the material that a wall with velocity holds would leave it with the first update: use "
        "reference fixed"},
       {field.options.stress_before() && wall.decides(), "scheme usf and usavg",
        "separate and friction need the contact before it is known: use usl or musl"}});
}

/** Refuses faces that belong to two walls. */
void FixMPMBoundary::check_master(int face) const
{
  if (domain->periodicity[face / 2])
    error->all(FLERR, Error::NOLASTLINE, PERIODIC, FACE_NAME[face]);
  for (auto *ifix : modify->get_fix_by_style("^mpm/boundary$")) {
    auto *other = dynamic_cast<FixMPMBoundary *>(ifix);
    if (other == this) continue;
    if (!wall.field_id.empty() && !other->wall.field_id.empty() &&
        wall.field_id != other->wall.field_id)
      continue;
    if (std::count(other->wall.face_list.begin(), other->wall.face_list.end(), face))
      error->all(FLERR, Error::NOLASTLINE,
                 "Face {} belongs to fix mpm/boundary {} and {}: remove one, or give them "
                 "different fields",
                 FACE_NAME[face], id, other->id);

    // opposite face
    if (!std::count(other->wall.face_list.begin(), other->wall.face_list.end(), face ^ 1)) continue;
    for (const auto &list : nodes) {
      const auto &field = list.field;
      if (other->wall.acts_on(field) &&
          MPMMirrorNodes::are_near({{field, *domain, face}, {field, *domain, face ^ 1}}, face / 2))
        error->all(FLERR, Error::NOLASTLINE,
                   "Faces {} and {} are less than 3 cells apart, or 5 when they are not in planes "
                   "of nodes: they must be in the same fix mpm/boundary",
                   FACE_NAME[face], FACE_NAME[face ^ 1]);
    }
  }
}

/** Refuses opposite faces that are too close. */
void FixMPMBoundary::check_faces() const
{
  for (int face : wall.face_list) {
    check_master(face);
    for (const auto &list : nodes) {
      if (!MPMMirrorNodes::are_near(list.mirrors.faces, face / 2)) continue;
      if (wall.decides())
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/boundary separate and friction need at least 3 cells between opposite "
                   "faces, or 5 when they are not in planes of nodes");
      for (const auto &f : list.mirrors.faces)
        if (f.cut && f.axis == face / 2)
          error->all(FLERR, Error::NOLASTLINE,
                     "Fix mpm/boundary faces that are not in planes of nodes of fix mpm {} must be "
                     "at least 5 cells apart: change its spacing or origin",
                     list.field.id());
    }
  }
}

const MPMWallNodes *FixMPMBoundary::nodes_of(const MPMField &field) const
{
  for (const auto &list : nodes)
    if (&list.field == &field) return &list;
  return nullptr;
}

MPMWallNodes *FixMPMBoundary::nodes_of(const MPMField &field)
{
  return const_cast<MPMWallNodes *>(std::as_const(*this).nodes_of(field));
}

void FixMPMBoundary::couple_topology()
{
  if (!wall.region || comm->nprocs == 1 || !wall.placed || !wall.region_moves() ||
      wall.region->nregion != 1 || !wall.acts_across())
    return;
  for (auto &list : nodes)
    if (list.crossings.needs_topology()) list.field.map->valid = false;
}

void FixMPMBoundary::extend_topology(MPMField &field)
{
  if (auto *list = nodes_of(field)) list->extend_topology();
}

void FixMPMBoundary::topology_changed(MPMField &field)
{
  if (auto *list = nodes_of(field)) list->topology_changed();
}

bool FixMPMBoundary::looks_at_all(const MPMField &field, const Grid::Block &block) const
{
  const auto *list = nodes_of(field);
  return list && list->needs(block);
}

void FixMPMBoundary::list_ties(const MPMField &field, std::vector<int64_t> &ties,
                               std::vector<int64_t> &others) const
{
  if (const auto *list = nodes_of(field)) list->list_ties(ties, others);
}

MPMTrialContact *FixMPMBoundary::trial_contact()
{
  return wall.decides() || wall.moves_and_holds ? &trial : nullptr;
}

/** The region of a wall that moves is where it was at the end of the last step. */
void FixMPMBoundary::go_to_start()
{
  if (!wall.region_moves())
    wall.region->prematch();
  else if (wall.placed)
    wall.restore_region();
}

void FixMPMBoundary::mark_prescribed(const MPMField &field, std::vector<char> &held) const
{
  const auto *list = nodes_of(field);
  if (list && wall.is_predictable()) list->mark_prescribed(held);
}

void FixMPMBoundary::predict(MPMField &field, const std::vector<char> &near,
                             MPMPredictedVelocities &to)
{
  if (!wall.is_predictable()) return;
  update_motion(wall, nodes, field.step_dt());
  if (const auto *list = nodes_of(field)) list->predict(near, to);
}

void FixMPMBoundary::list_obstacles(double dt, std::vector<std::unique_ptr<MPMObstacle>> &list)
{
  update_motion(wall, nodes, dt);
  const std::vector<int> the_region = {-1};
  for (const int face : is_region() ? the_region : wall.face_list)
    list.push_back(std::make_unique<MPMWallObstacle>(*this, wall, *domain, face,
                                                     wall.fields[0]->lattice.h, dt));
}

/** Friction that an implicit solver has found, once in a step and for all walls before any of them
 *  holds nodes: at nodes that another wall holds, this bears the friction. */
void FixMPMBoundary::rub(double dt)
{
  if (!trial.take_friction()) return;
  has_rubbed = true;
  update_motion(wall, nodes, dt);
  reaction.begin_step(dt);
  for (std::size_t k = 0; k < nodes.size(); k++) {
    if (!trial.decides(nodes[k])) continue;
    reaction.begin_field((int) k, true);
    trial.apply_friction(reaction);
    reaction.end_field();
  }
}

void FixMPMBoundary::act(double dt, Stage stage)
{
  const bool count = stage == STEP;
  if (count)
    for (auto *other : rubbing) other->rub(dt);
  update_motion(wall, nodes, dt);
  if (count && !has_rubbed) reaction.begin_step(dt);
  if (count) has_rubbed = false;
  const MPMWallMotion in_step = wall.motion;
  if (stage == START && !wall.motion.uniform) wall.motion = in_step.at_end_of_step(dt);
  contact.decided = stage == MAPPED_BACK || stage == AGAIN;
  wall.by_distance = wall.kind == MPMWall::SEPARATE && !trial.has_begun();
  for (std::size_t k = 0; k < nodes.size(); k++) {
    auto &list = nodes[k];
    if (count && wall.kind == MPMWall::SEPARATE && !trial.has_begun())
      search.find_contacts(list, dt, 0.0);
    if (count && wall.decides()) list.find_water(contact, dt);
    if (count) thin_regions.check(list, (int) k);
    const bool tries = trial.decides(list);
    contact.constraints = tries ? &trial.constraints : nullptr;
    reaction.begin_field((int) k, count);
    list.act(contact);
    if (tries) trial.act_on_approaches(reaction, list);
    reaction.end_field();
  }
  wall.motion = in_step;
  wall.by_distance = false;    // between steps, a solver may ask
  if (count) wall.state.acted = 1;
  if (count && thin_regions.is_due()) thin_regions.report();
}

void FixMPMBoundary::write_restart(FILE *fp)
{
  MPMWallState &state = wall.state;
  keep_totals(world, &state.work, 1);
  MPMWallState all = state;
  all.work *= force->mvv2e;
  state.work = all.work / force->mvv2e;    // with the precision of the file
  if (comm->me) return;
  write_state(fp, &all, sizeof(MPMWallState));
}

void FixMPMBoundary::restart(char *buf)
{
  memcpy(&wall.state, read_state(lmp, id, buf, sizeof(MPMWallState)), sizeof(MPMWallState));
  wall.state.work = comm->me == 0 ? wall.state.work / force->mvv2e : 0.0;
}

double FixMPMBoundary::memory_usage()
{
  double bytes = reaction.memory_usage() + trial.memory_usage();
  for (const auto &list : nodes) bytes += list.memory_usage();
  return bytes;
}
