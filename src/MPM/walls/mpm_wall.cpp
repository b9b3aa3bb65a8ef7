/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/mpm_wall.h"

#include "base/mpm_options.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "math_extra.h"
#include "modify.h"
#include "region.h"
#include "update.h"
#include "walls/mpm_region_surface.h"
#include "walls/mpm_wall_gap.h"
#include "walls/region_mpm_mesh.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double CELL = 0.5;    // of distances from a mesh [node spacings]

void MPMWall::init()
{
  in_implicit_steps = !modify->get_fix_by_style("^mpm/implicit$").empty();
  looks_ahead = kind == SEPARATE && in_implicit_steps;
  Region *const now = region_id.empty() ? nullptr : domain->get_region_by_id(region_id);
  moves_and_holds = kind != SEPARATE && in_implicit_steps && now && now->dynamic_check();
}

void MPMWall::find_patches()
{
  for (auto &part : patches) {
    part.region = domain->get_region_by_id(part.region_id);
    if (!part.region)
      error->all(FLERR, Error::NOLASTLINE,
                 "Region {} for keyword patch of fix mpm/boundary does not exist", part.region_id);
    part.region->init();
    if (part.region->dynamic_check() || part.region->varshape)
      error->all(FLERR, Error::NOLASTLINE,
                 "Region {} for keyword patch of fix mpm/boundary {} must not move", part.region_id,
                 id);
    part.region->prematch();
    if (comm->me == 0 && !may_meet(*part.region))
      error->warning(
          FLERR,
          "Fix mpm/boundary {}: its wall is nowhere in region {} of keyword patch, which "
          "does nothing: let the region go through the wall, e.g. with INF across it",
          id, part.region_id);
  }
}

/** Can the wall be in this region? True if it is not known: only boxes around them are compared. */
bool MPMWall::may_meet(const Region &part) const
{
  if (!part.bboxflag) return true;
  const double low[3] = {part.extent_xlo, part.extent_ylo, part.extent_zlo},
               high[3] = {part.extent_xhi, part.extent_yhi, part.extent_zhi};
  for (int d = 0; d < domain->dimension; d++)
    if (low[d] > domain->boxhi[d] || high[d] < domain->boxlo[d]) return false;
  if (!face_list.empty())
    return std::any_of(face_list.begin(), face_list.end(), [&](int face) {
      const double at = face % 2 ? domain->boxhi[face / 2] : domain->boxlo[face / 2];
      return low[face / 2] <= at && at <= high[face / 2];
    });
  const auto *mesh = dynamic_cast<RegMPMMesh *>(region);
  if (!mesh || region->dynamic_check()) return true;
  const auto &surface_box = mesh->surface_mesh();
  for (int d = 0; d < domain->dimension; d++)
    if (low[d] > surface_box.hi[d] || high[d] < surface_box.lo[d]) return false;
  return true;
}

double MPMWall::friction_at(const double *x) const
{
  double mu = friction;
  for (const auto &part : patches)
    if (part.region->match(x[0], x[1], x[2])) mu = part.friction;
  return mu;
}

double MPMWall::friction_at(const Grid &grid, const int64_t *node, int n) const
{
  if (patches.empty()) return friction;
  const int64_t *const end = node + n, *const seen = std::find_if(node, end, [](int64_t k) {
                                         return k >= 0;
                                       });
  if (seen == end) return friction;
  double x[3];
  grid.node_position(*seen, x);
  return friction_at(x);
}

void MPMWall::init_region()
{
  motion_step = -1;
  placed = false;
  steps = 0;
  if (region_id.empty()) return find_patches();
  region = domain->get_region_by_id(region_id);
  if (!region)
    error->all(FLERR, Error::NOLASTLINE, "Region {} for fix mpm/boundary does not exist",
               region_id);
  find_patches();
  surface = std::make_unique<MPMRegionSurface>(region, domain->dimension);
  double h = fields[0]->lattice.h;
  for (const auto *field : fields) h = std::min(h, field->lattice.h);
  surface->use_cells(CELL * h);
  if (surface->is_open())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/boundary cannot use region {}: open faces have no inside", region_id);
  if (region->dynamic_check() && region->nregion > 1)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/boundary cannot use region {}: a union or intersection must not move; use "
               "one fix mpm/boundary for each member",
               region_id);
}

/** A run may start between two steps of the cycle (keyword every of fix mpm); then the state of a
 *  region is that at the last step of the cycle. */
void MPMWall::setup()
{
  if (!region_moves()) return;
  evaluate_in_step(lmp, true, [&] {
    region->prematch();
  });
  const auto *field = MPMField::all(lmp)[0];
  if (!state.acted || field->steps_to_next() == field->options.every)
    for (int k = 0; k < 4; k++) state.region[k] = *MPMRegionMotion::of(region)[k];
  placed = true;
}

bool MPMWall::acts_on(const MPMField &field) const
{
  return field_id.empty() || field_id == field.id();
}

bool MPMWall::has_several_ranks() const
{
  return comm->nprocs > 1;
}

bool MPMWall::region_moves() const
{
  return region && region->dynamic_check();
}

/** Nodes inside hold only the points of a body in front of the surface that they reach. The body
 *  would creep into the wall, and stresses next to it would be wrong by an amount that depends on
 *  where the surface is in a cell. Lines hold the surface. Nodes hold material inside a region, as
 *  in a grip, which has no surface there: see MPMCrossingLines. */
bool MPMWall::acts_across() const
{
  if (region->varshape) return false;
  return moves_and_holds || decides() || holds_surface();
}

/** Do lines hold material in front of the surface? They do with stick and slip on a region in
 *  explicit steps, and with slip at rest in implicit ones; nodes act on material inside. Nodes hold
 *  for good what sticks to a region that is driven. */
bool MPMWall::holds_surface() const
{
  const bool sticks = !is_driven() && !in_implicit_steps;
  return (kind == STICK ? sticks : kind == SLIP && !rubs()) && !moves_and_holds;
}

bool MPMWall::prescribes(const double *normal, int d) const
{
  return kind == STICK ? velocity[d].given : std::fabs(normal[d]) == 1.0;
}

bool MPMWall::holds_axis(const MPMField &field) const
{
  return acts_on(field) && std::count(face_list.begin(), face_list.end(), 0) && !decides() &&
      !rotating() && velocity[0].given && velocity[0].variable.empty() && velocity[0].value == 0.0;
}

bool MPMWall::begin_motion()
{
  if (motion_step == update->ntimestep) return false;
  motion_step = update->ntimestep;
  steps++;
  motion.begin(state);
  if (region_moves()) restore_region();
  return true;
}

void MPMWall::find_motion(double dt)
{
  evaluate_in_step(lmp, region_moves() || has_variables(), [&] {
    if (region_moves()) region->prematch();
    for (int d = 0; d < 3; d++) {
      const double value = evaluate(lmp, velocity[d]);
      motion.shift[d] = by_displacement ? (value - state.displaced[d]) / dt : value;
      state.displaced[d] = value;
    }
    if (rotating()) motion.rotate(evaluate(lmp, rate) * dt, axis, center, dt);
  });
  const bool total = fields[0]->options.total;
  if (total) motion.refer_to_start(state, dt);
  if (region_moves()) {
    const auto now = MPMRegionMotion::of(region);
    double *const old = state.region;
    for (int d = 0; d < 3; d++) motion.shift[d] = (*now[d] - old[d]) / dt;
    check_speed(dt);
    if (region->rotateflag) {
      double origin[3];
      MathExtra::add3(MPMRegionMotion::point_of(region), old, origin);
      motion.rotate(region->theta - old[3], MPMRegionMotion::axis_of(region), origin, dt);
    }
    for (int k = 0; k < 4; k++) old[k] = *now[k];
  }
  if (!state.acted) MathExtra::copy3(motion.shift, motion.before);
  // solvers evaluate forces and motion of the same time, and nodes of the total frame are the
  // material
  motion.changes = state.acted && !in_implicit_steps;
  (!motion.uniform && !total ? motion.at_end_of_step(dt) : motion).end(state);
}

/** A region acts on nodes that are inside at the start of a step: one that crosses more than a cell
 *  in a step can pass through a body without touching it. Not all regions give their extent, so
 *  this checks displacements alone, not rotations. */
void MPMWall::check_speed(double dt)
{
  const double along[3] = {motion.shift[0], motion.shift[1],
                           domain->dimension == 3 ? motion.shift[2] : 0.0};
  const double way = dt * MathExtra::len3(along);
  // LAMMPS of 2025 gives no value to the angle of regions that do not turn
  if (!std::isfinite(way) || (region->rotateflag && !std::isfinite(region->theta)))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/boundary {}: the motion of its region {} is not finite at step {}", id,
               region_id, update->ntimestep);
  for (const auto *field : fields) {
    const double h = field->lattice.h;
    if (warned || !(way > (looks_ahead ? COMES_FROM : 1.0) * h)) continue;
    warned = true;
    if (comm->me == 0)
      error->warning(FLERR,
                     "Fix mpm/boundary {}: its region crosses {:.3g} cells of fix mpm {} in step "
                     "{} and can pass through material without touching it: use a smaller "
                     "timestep; this is said only once",
                     id, way / h, field->id(), update->ntimestep);
  }
}

void MPMWall::restore_region()
{
  for (int k = 0; k < 4; k++) *MPMRegionMotion::of(region)[k] = state.region[k];
}

bool MPMWall::knows_place() const
{
  return region->nregion == 1 && (placed || !region_moves());
}

double MPMWall::way_since(const double *then) const
{
  double shift[3], way = 0.0;
  MathExtra::sub3(state.region, then, shift);
  if (region->rotateflag) {
    const double *const point = MPMRegionMotion::point_of(region);
    double farthest[3];
    for (int d = 0; d < 3; d++)
      farthest[d] =
          std::max(std::fabs(domain->boxlo[d] - point[d]), std::fabs(domain->boxhi[d] - point[d])) +
          std::max(std::fabs(state.region[d]), std::fabs(then[d]));
    way = std::fabs(state.region[3] - then[3]) * MathExtra::len3(farthest);
  }
  return way + MathExtra::len3(shift);
}

void MPMWall::normal(const MPMField &field, const double *x, double *n) const
{
  const double h = field.lattice.h;
  surface->normal(x, FAR * h, NORMAL_STEP * h, n);
}

MPMDistanceFrom MPMWall::distance_from_region(double dt) const
{
  if (!region_moves())
    return [this](const double *x, double cutoff) {
      return surface->distance_in_cells(x, cutoff);
    };
  return [this, dt](const double *x, double cutoff) {
    double y[3], v[3];
    motion.velocity(x, v);
    for (int d = 0; d < 3; d++) y[d] = x[d] + dt * v[d];
    return surface->distance(y, cutoff);
  };
}

/* The velocity given to a node at x by a rotation is the chord ((R(dt) - I)(x - o))/dt: as
 *  positions are updated by x += dt v, the tangent would carry points outward. USF asks how the
 *  material has moved to its present position: by the chord of the step that has ended, (I -
 *  R^-1)(x - o)/dt. */

void MPMWallMotion::begin(const MPMWallState &state)
{
  *this = {};
  uniform = true;
  MathExtra::copy3(state.shift, before);
  std::copy_n(state.gradient[0], 9, gradient_before[0]);
  MathExtra::copy3(state.origin, origin_before);
}

/** Gradient = (R - I)/dt for a rotation about a unit axis through o. */
void MPMWallMotion::rotate(double angle, const double *u, const double *o, double dt)
{
  uniform = false;
  MathExtra::copy3(o, origin);
  const double s = sin(angle) / dt, half = sin(0.5 * angle);
  const double c = 2.0 * half * half / dt;    // (1 - cos)/dt
  const double K[3][3] = {{0.0, -u[2], u[1]}, {u[2], 0.0, -u[0]}, {-u[1], u[0], 0.0}};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      gradient[i][j] = s * K[i][j] + c * (u[i] * u[j] - (i == j ? 1.0 : 0.0));
}

/** Nodes have moved from X to x = X + T X + m, so s + G (x - o) becomes s + G (m - o) + (G + G T)
 *  X. */
void MPMWallMotion::refer_to_start(MPMWallState &state, double dt)
{
  std::copy_n(state.turned[0], 9, turned[0]);
  MathExtra::copy3(state.moved, moved);
  if (!uniform) {
    double product[3][3];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        shift[i] += gradient[i][j] * (moved[j] - origin[j]);
        product[i][j] = gradient[i][j];
        for (int k = 0; k < 3; k++) product[i][j] += gradient[i][k] * turned[k][j];
      }
    std::copy_n(product[0], 9, gradient[0]);
    std::fill_n(origin, 3, 0.0);
  }
  for (int i = 0; i < 3; i++) {
    state.moved[i] += dt * shift[i];
    for (int j = 0; j < 3; j++) state.turned[i][j] += dt * gradient[i][j];
  }
}

/** Velocity during the step of the material that is at x at its end. It came from y, x = y + dt (s
 *  + G (y - o)): with R = 1 + dt G, s + G R^T (x - o - dt s), G R^T = -G^T. */
MPMWallMotion MPMWallMotion::at_end_of_step(double dt) const
{
  MPMWallMotion end = *this;
  for (int i = 0; i < 3; i++) {
    end.origin[i] += dt * shift[i];
    for (int j = 0; j < 3; j++) end.gradient[i][j] = -gradient[j][i];
  }
  return end;
}

void MPMWallMotion::end(MPMWallState &state) const
{
  MathExtra::copy3(shift, state.shift);
  std::copy_n(gradient[0], 9, state.gradient[0]);
  MathExtra::copy3(origin, state.origin);
}

void MPMWallMotion::velocity(const double *x, double *v) const
{
  MathExtra::copy3(shift, v);
  if (uniform) return;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) v[i] += gradient[i][j] * (x[j] - origin[j]);
}

void MPMWallMotion::velocity(const Grid &grid, int64_t node, double *v) const
{
  double x[3];
  if (!uniform) grid.node_position(node, x);
  velocity(x, v);
}

/** An impulse R dt of the wall that takes its node from the velocity u to v adds R dt (u + v)/2 to
 *  the kinetic and stored energy. R dt v would differ from it by R (v - u) dt/2 in each step, which
 *  adds up where a mass is shaken. */
void MPMWallMotion::half_change(const Grid &grid, int64_t node, double *v) const
{
  double x[3];
  for (int d = 0; d < 3; d++) v[d] = 0.5 * (shift[d] - before[d]);
  if (uniform) return;
  grid.node_position(node, x);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      v[i] += 0.5 *
          (gradient[i][j] * (x[j] - origin[j]) - gradient_before[i][j] * (x[j] - origin_before[j]));
}

/** The part of old velocities relative to the wall that counts as consistent with it, see
 *  mpm_mirror_nodes.cpp. */
double MPMWallMotion::old_relative(const double *record, int d, double limit) const
{
  return std::max(-limit, std::min(record[4 + d] - before[d], limit));
}

void MPMWallMotion::position(const double *X, double *x) const
{
  for (int i = 0; i < 3; i++) x[i] = X[i] + moved[i] + MathExtra::dot3(turned[i], X);
}

/** Fix ID all mpm/boundary faces|region REG  stick|slip|separate  keyword values */
Options MPMBoundaryOptions::declare(int dim)
{
  using namespace option;
  Options o("fix mpm/boundary");
  o.argument(word(kind, {{"stick", STICK}, {"slip", SLIP}, {"separate", SEPARATE}}, "kind"));
  o.add("friction",
        {number(friction, "mu", NOT_NEGATIVE, "1",
                "coefficient of Coulomb friction, for *slip* and *separate*")});
  o.add("patch",
        {text(patch.region_id, "region-ID", "in this region the wall has another coefficient"),
         number(patch.friction, "mu", NOT_NEGATIVE, "1",
                "this coefficient of friction; the keyword can be given several times")})
      .then([this] {
        patches.push_back(patch);
      })
      .standard("none");
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
                   "can be variables; with *stick*, NULL leaves a component free",
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
        {kind == STICK, "patch", "has friction, which needs kind slip or separate"},
        {heat.heats() && !rubs(), "heat", "is that of friction, which needs a coefficient"},
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

double MPMBoundaryOptions::least_friction() const
{
  double least = friction;
  for (const auto &part : patches)
    if (part.friction > 0.0 && !(least > 0.0 && least < part.friction)) least = part.friction;
  return least;
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
