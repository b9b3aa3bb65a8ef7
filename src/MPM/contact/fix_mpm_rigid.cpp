/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "contact/fix_mpm_rigid.h"

#include "base/mpm_find_fixes.h"
#include "base/mpm_gravity.h"
#include "base/mpm_image.h"
#include "base/mpm_options.h"
#include "base/mpm_state.h"
#include "comm.h"
#include "contact/mpm_rigid_collisions.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_physics.h"
#include "field/mpm_setup_checks.h"
#include "force.h"
#include "math_extra.h"
#include "mesh/surface_mesh.h"
#include "mesh/surface_points.h"
#include "modify.h"
#include "update.h"
#include "walls/fix_mpm_boundary.h"
#include "walls/mpm_region_cut.h"
#include "walls/region_mpm_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** fix ID all mpm/rigid REGION density|mass VALUE stick|slip|separate keyword values ... */
Options MPMRigidOptions::declare()
{
  using namespace option;
  Options o("fix mpm/rigid");
  const auto value = number(amount, "", POSITIVE);
  o.argument(text(region_id, "region-ID"));
  o.argument(
      word(by_mass, {{"density", false, "", {value}}, {"mass", true, "", {value}}}, "option"));
  o.argument(word(kind, {{"stick", STICK}, {"slip", SLIP}, {"separate", SEPARATE}}, "contact"));
  o.add("friction",
        {number(friction, "mu", NOT_NEGATIVE, "1",
                "coefficient of friction, for *slip* and *separate*")});
  heat.declare(o, "the energy lost by friction becomes heat of the material, not of the body",
               "share of this energy that becomes heat of the material");
  o.add("collide", {yes_no(collides)},
        "whether the body meets walls of :doc:`fix mpm/boundary <fix_mpm_boundary>` and other "
        "bodies of this style");
  o.add("restitution",
        {number(restitution, "e", {0.0, 1.0, true, true}, "1",
                "ratio of the speeds after and before a collision with these")});
  o.add("velocity",
        {numbers(v, 3, "vx vy vz", ANY_NUMBER, "velocity", "velocity of the center at the start")})
      .once();
  o.add("omega",
        {numbers(omega, 3, "wx wy wz", ANY_NUMBER, "1/time", "angular velocity at the start")})
      .once();
  o.add("gravity",
        {numbers(gravity, 3, "gx gy gz", ANY_NUMBER, "velocity/time", "acceleration of the body")})
      .once();
  o.add("force", {variables(load, 3, "fx fy fz", "force", "force on the center, can be variables")})
      .once();
  o.add("torque",
        {variables(moment, 3, "tx ty tz", "force*distance",
                   "torque about the center, can be variables")})
      .once();
  o.add("hold",
        {any_of(fixed, {"x", "y", "z", "rx", "ry", "rz"},
                "components of the velocity and of the angular velocity that stay zero")})
      .standard("nothing");
  o.refuse([=] {
    OptionRules rules = {{kind == STICK, "friction", "is for slip and separate"},
                         {heat.heats() && friction == 0.0, "heat",
                          "is that of friction, which needs a coefficient"}};
    for (int a = 0; a < 3; a++) {
      const std::string axis(1, "xyz"[a]);
      rules.push_back(
          {fixed[a] && v[a] != 0.0, "", "cannot hold " + axis + " and give it a velocity"});
      rules.push_back({fixed[3 + a] && omega[a] != 0.0, "",
                       "cannot hold r" + axis + " and give it an angular velocity"});
    }
    return rules;
  });
  return o;
}

FixMPMRigid::FixMPMRigid(LAMMPS *lmp, int narg, char **arg) :
    Fix(lmp, narg, arg), contact(lmp, *this), doubts(lmp)
{
  if (igroup != 0)
    error->all(FLERR, 1, "Fix mpm/rigid acts on nodes, which have no group: use group all");
  Options options = declare();
  read_options(lmp, options, narg, arg, 3);
  if (heat.heats()) contact.heating = std::make_unique<MPMFrictionHeat>(lmp, heat);
  weight_given = options.given("gravity");
  find_shape();
  if (domain->dimension == 2) {
    if (v[2] != 0.0 || omega[0] != 0.0 || omega[1] != 0.0 || fixed[2] || fixed[3] || fixed[4])
      error->all(FLERR,
                 "Fix mpm/rigid {}: in 2d a body moves in the plane: leave out what is about z, "
                 "and rotations "
                 "but that about z",
                 id);
    fixed[2] = fixed[3] = fixed[4] = true;
  }
  hold();
  MathExtra::matvec(body_inertia, omega, L);
  spin();

  scalar_flag = vector_flag = 1;
  size_vector = 31;
  global_freq = 1;
  extscalar = 1;
  extvector = 0;
  restart_global = 1;
  if (comm->me == 0)
    utils::logmesg(lmp, "Rigid body {}: mass {:.8g}, center {:.8g} {:.8g} {:.8g}\n", id, mass, x[0],
                   x[1], x[2]);
}

/** Center, mass, and inertia of the region. */
void FixMPMRigid::find_shape()
{
  const int dim = domain->dimension;
  auto *const any = domain->get_region_by_id(region_id);
  if (!any) error->all(FLERR, 3, "Fix mpm/rigid region {} does not exist", region_id);
  if (dim == 2 && dynamic_cast<RegMPMMesh *>(any))
    error->all(FLERR, 3,
               "Fix mpm/rigid region {} of style mpm/mesh is for 3d: in 2d, move a region with fix "
               "mpm/boundary, or let another one "
               "float in a flow of fix mpm/incompressible",
               region_id);
  double volume, lo[3], hi[3];
  constexpr int VOIGT[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  if (auto *region = dim == 3 ? dynamic_cast<RegMPMMesh *>(any) : nullptr) {
    region->need_body();
    const SurfaceMesh *const mesh = contact.mesh = &region->surface_mesh();
    volume = mesh->volume;
    for (int d = 0; d < 3; d++) {
      first[d] = mesh->center[d];
      lo[d] = mesh->lo[d];
      hi[d] = mesh->hi[d];
      for (int e = 0; e < 3; e++) body_inertia[d][e] = mesh->inertia[VOIGT[d][e]];
    }
  } else {
    if (any->dynamic_check() || !any->interior || any->openflag ||
        !MPMRegionBody::is_bounded(*any, dim))
      error->all(
          FLERR, 3,
          "Fix mpm/rigid needs a region of style mpm/mesh: {}; in a flow of fix mpm/incompressible "
          "also another one that is bounded, at rest, with side in, and without open faces",
          region_id);
    any->init();
    const MPMRegionBody shape(*any, dim);
    if (!(shape.volume > 0.0))
      error->all(FLERR, 3, "Region {} of fix mpm/rigid is empty", region_id);
    volume = shape.volume;
    for (int d = 0; d < 3; d++) {
      first[d] = shape.center[d];
      lo[d] = shape.lo[d];
      hi[d] = shape.hi[d];
      for (int e = 0; e < 3; e++) body_inertia[d][e] = shape.inertia[d][e];
    }
  }
  double far[3];
  for (int d = 0; d < 3; d++) far[d] = std::max(hi[d] - first[d], first[d] - lo[d]);
  contact.farthest = MathExtra::len3(far);
  const double density = by_mass ? amount / volume : amount;
  mass = density * volume;
  for (int d = 0; d < 3; d++) {
    x[d] = first[d];
    for (int e = 0; e < 3; e++) {
      Q[d][e] = d == e;
      body_inertia[d][e] *= density;
    }
  }
}

void FixMPMRigid::init()
{
  auto *const any = domain->get_region_by_id(region_id);
  auto *const region = dynamic_cast<RegMPMMesh *>(any);
  const bool flows = spacing_of_flow() > 0.0;
  if (!any || any->dynamic_check() || !any->interior || (contact.mesh && !region))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/rigid {} needs its region {} at rest and with side in: the fix moves a "
               "copy of it",
               id, region_id);
  if (contact.mesh) {
    region->need_body();
    contact.mesh = &region->surface_mesh();
    find_points();
  } else if (!flows) {
    if (domain->dimension == 2)
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/rigid {} requires 3d, as surfaces are of triangles: in 2d, move a region with "
          "fix mpm/boundary, use a thin 3d box that is periodic, or a flow of fix "
          "mpm/incompressible that has region {}",
          id, region_id);
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/rigid {} needs a region of style mpm/mesh: {}; others are bodies in a flow of fix "
        "mpm/incompressible that has this region",
        id, region_id);
  }
  for (const auto *other : modify->get_fix_by_style("^mpm/rigid$"))
    if (other != this && dynamic_cast<const FixMPMRigid *>(other)->region_id == region_id)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/rigid {} and {} have the same region {}: they would be two bodies in the "
                 "same place, which do not feel each other",
                 id, other->id, region_id);
  const auto fields = MPMField::all(lmp);
  if (flows) {
    if (kind != SLIP || friction > 0.0)
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/rigid {}: a body in a flow of fix mpm/incompressible has no friction and does "
          "not part from it: use slip",
          id);
    if (restitution > 0.0)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/rigid {}: a body in a flow of fix mpm/incompressible meets neither walls "
                 "nor other bodies: drop restitution",
                 id);
    if (!fields.empty())
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/rigid {} is a body in a flow of fix mpm/incompressible, and cannot touch "
                 "points of fix mpm {}: remove one of them",
                 id, fields[0]->id());
  } else
    require_field(lmp, *this);
  for (const auto *field : fields)
    refuse_field(lmp, *this, *field,
                 {{field->options.total, "frame total",
                   "its nodes are not where the body is: use frame updated"},
                  {field->options.stress_before(), "scheme usf and usavg",
                   "these need the contact before it is known: use usl or musl"}});
  for (int d = 0; d < 3; d++) {
    find_variable(lmp, load[d], "fix mpm/rigid force");
    find_variable(lmp, moment[d], "fix mpm/rigid torque");
  }
}

void FixMPMRigid::init_action()
{
  if (contact.heating) contact.heating->begin_run(*this, MPMField::all(lmp));
}

/** What sticks may be an inclusion. */
void FixMPMRigid::setup(int)
{
  check_weight();
  const auto fields = MPMField::all(lmp);
  if (kind == STICK || dt_last > 0.0 || fields.empty()) return;
  doubts.check_inside("Fix mpm/rigid " + std::string(id), "the body", fields,
                      [this](const double *x, double far) {
                        return distance(x, far);
                      });
}

/** A body that is free to fall, and has no load of its own, is hardly meant to have no weight where
 *  other matter has one. */
void FixMPMRigid::check_weight()
{
  const auto is_given = [](const NumberOrVariable &one) {
    return !one.variable.empty() || one.value != 0.0;
  };
  if (weight_given || std::any_of(load, load + 3, is_given)) return;
  double g[3], along = 0.0;
  MPMGravity(lmp).find(g);
  for (int d = 0; d < 3; d++) along += fixed[d] ? 0.0 : fabs(g[d]);
  doubts.check(
      MPMDoubts::WEIGHTLESS, along > 0.0 ? 1.0 : 0.0, "Fix mpm/rigid " + std::string(id),
      fmt::format("fix gravity ({:.6g} {:.6g} {:.6g}) does not act on the body", g[0], g[1], g[2]));
}

/** Forces that the input gives. */
void FixMPMRigid::load_impulse(double dt)
{
  bool variables = false;
  for (int d = 0; d < 3; d++)
    variables = variables || !load[d].variable.empty() || !moment[d].variable.empty();
  evaluate_in_step(lmp, variables, [&] {
    for (int d = 0; d < 3; d++) {
      v[d] += dt * (gravity[d] + evaluate(lmp, load[d]) * force->ftm2v / mass);
      L[d] += dt * evaluate(lmp, moment[d]) * force->ftm2v;
    }
  });
}

/** Of the fastest point of the body. */
double FixMPMRigid::speed() const
{
  return MathExtra::len3(v) + contact.farthest * MathExtra::len3(omega);
}

double FixMPMRigid::stable_dt(tagint &tag) const
{
  tag = 0;
  double h = HUGE_VAL;
  int every = 1;
  for (const auto *field : MPMField::all(lmp)) {
    h = std::min(h, field->lattice.h);
    every = field->options.every;
  }
  const double flow_spacing = spacing_of_flow();
  if (flow_spacing > 0.0) h = flow_spacing;
  return h / (speed() * every);
}

/** Zero: the body is in none. */
double FixMPMRigid::spacing_of_flow() const
{
  for (const auto *flow : find_fixes<MPMFluid>(lmp)) {
    const double h = flow->spacing_around(region_id);
    if (h > 0.0) return h;
  }
  return 0.0;
}

/** All points of fields, and the flow that it is in. */
bool FixMPMRigid::acts_on(const std::string &name) const
{
  const auto *const flow = dynamic_cast<const MPMFluid *>(modify->get_fix_by_id(name));
  return flow ? flow->spacing_around(region_id) > 0.0 : MPMField::find(lmp, name) != nullptr;
}

bool FixMPMRigid::has_inside(const double *at) const
{
  double r[3], place[3];
  MathExtra::sub3(at, x, r);
  nearest_image(*domain, r);
  if (MathExtra::lensq3(r) > contact.farthest * contact.farthest) return false;
  place_in_region(at, place);
  return domain->get_region_by_id(region_id)->match(place[0], place[1], place[2]);
}

/** A body touches material where nodes are inside of it at the start of a step. One that crosses
 *  more than a cell in a step can pass through a body without touching it. All ranks have the same
 *  motion. */
void FixMPMRigid::check_motion(double dt) const
{
  double sum = 0.0;
  for (int d = 0; d < 3; d++) sum += fabs(x[d]) + fabs(v[d]) + fabs(L[d]) + fabs(omega[d]);
  if (!std::isfinite(sum))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/rigid {}: position or velocity of the body is not finite at step {}: see "
               "its force, torque, and gravity, and the material that it touches",
               id, update->ntimestep);
  for (const auto *field : MPMField::all(lmp))
    if (field->options.dt_check && speed() * dt > field->lattice.h)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/rigid {}: the body crosses {:.3g} cells of fix mpm {} in step {} and can "
                 "pass through material without touching it: {}, or fix mpm ... dtcheck no",
                 id, speed() * dt / field->lattice.h, field->id(), update->ntimestep,
                 remedy_of_step(lmp));
}

// cells that a surface may go through; each has some points, of some hundred bytes
static constexpr double MOST_CELLS = 1.0e7;

/** Points of the surface at which it can meet others, as near to each other as nodes. */
void FixMPMRigid::find_points()
{
  auto soup = contact.mesh->soup();
  for (auto &triangle : soup)
    for (auto &corner : triangle)
      for (int d = 0; d < 3; d++) corner[d] -= first[d];
  double h = contact.farthest;
  for (const auto *field : MPMField::all(lmp)) h = std::min(h, field->lattice.h);
  double area = 0.0;
  for (const auto &[a, b, c] : soup) {
    double ab[3], ac[3], twice[3];
    MathExtra::sub3(b.data(), a.data(), ab);
    MathExtra::sub3(c.data(), a.data(), ac);
    MathExtra::cross3(ab, ac, twice);
    area += 0.5 * MathExtra::len3(twice);
  }
  if (!(area < MOST_CELLS * h * h))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/rigid {}: the surface of the body, of area {:.3g}, goes through {:.1e} "
               "cells of the node spacing {:.3g}: use a larger one, or check the scale of the "
               "surface",
               id, area, area / (h * h), h);
  contact.points = std::make_unique<SurfacePoints>(soup, h);
}

/** Nothing holds a body at a face of the box that is no wall: tells once when it goes through. All
 *  ranks have the same motion. */
void FixMPMRigid::warn_of_faces()
{
  if (warned_of_faces || !collides) return;
  const double reach = contact.farthest, least = 1.0e-6 * reach;
  for (int face = 0; face < 6 && !warned_of_faces; face++) {
    const int d = face / 2;
    const bool high = face % 2;
    const double at = high ? domain->boxhi[d] : domain->boxlo[d], sign = high ? 1.0 : -1.0;
    if (domain->periodicity[d] || sign * (x[d] - at) < -reach) continue;
    const auto walls = find_fixes<FixMPMBoundary>(lmp);
    if (std::any_of(walls.begin(), walls.end(), [&](const auto *wall) {
          return wall->has_face(face);
        }))
      continue;
    for (std::size_t i = 0; i < contact.points->size() && !warned_of_faces; i++)
      warned_of_faces =
          sign * (x[d] + MathExtra::dot3(Q[d], (*contact.points)[i].data()) - at) > least;
    if (warned_of_faces && comm->me == 0)
      error->warning(FLERR,
                     "Fix mpm/rigid {}: the body goes through face {}{} of the box at step {}, as "
                     "this is no wall: use fix mpm/boundary",
                     id, (char) ('x' + d), high ? "hi" : "lo", update->ntimestep);
  }
}

/** Velocities after all loads. */
MPMRigidMember FixMPMRigid::begin_step(double dt)
{
  MPMRigidMember member = {
      id, *this, contact, warned_of_depth, {v[0], v[1], v[2], omega[0], omega[1], omega[2]}};
  dt_last = dt;
  std::fill_n(collision, 6, 0.0);
  load_impulse(dt);
  hold();
  return member;
}

/** Moves the body with its velocities after all contact. */
void FixMPMRigid::end_step(double dt, const MPMRigidMember &member)
{
  move(dt);
  if (std::any_of(member.shift, member.shift + 6, [](double by) {
        return by != 0.0;
      }))
    shift(member.shift);

  // The nodes were counted with the new velocity of the body. Impulses on it change its kinetic
  // energy with the mean of both: see MPMWallMotion::half_change(). The sum is the same on
  // all ranks
  const double now[6] = {v[0], v[1], v[2], omega[0], omega[1], omega[2]};
  double faster = 0.0;
  for (int i = 0; i < 6; i++) {
    faster -= 0.5 * impulse[i] * (now[i] - member.old[i]);
    collision_work += 0.5 * collision[i] * (now[i] + member.old[i]);
  }
  if (comm->me == 0) {
    auto &ledger = MPMField::all(lmp)[0]->ledger;
    ledger.contact -= faster * force->mvv2e;
    ledger.driven -= faster * force->mvv2e;
    if (ledger.on) ledger.transfer += faster * force->mvv2e;
  }
  check_motion(dt);
  warn_of_faces();
}

/** The first of the bodies acts for all of them, as they can meet. */
void FixMPMRigid::act(double dt, Stage stage)
{
  if (stage != STEP) return contact.repeat();
  const auto all = find_fixes<FixMPMRigid>(lmp);
  if (all[0] != this) return;
  std::vector<MPMRigidMember> members;
  for (auto *body : all) members.push_back(body->begin_step(dt));
  MPMRigidCollisions(lmp, members, dt).act();
  for (std::size_t k = 0; k < all.size(); k++) all[k]->end_step(dt, members[k]);
}

void FixMPMRigid::motion(double *center, double *velocity, double *angular) const
{
  MathExtra::copy3(x, center);
  MathExtra::copy3(v, velocity);
  MathExtra::copy3(omega, angular);
}

void FixMPMRigid::place_in_region(const double *at, double *place) const
{
  double r[3];
  MathExtra::sub3(at, x, r);
  nearest_image(*domain, r);
  MathExtra::transpose_matvec(Q, r, place);
  for (int d = 0; d < 3; d++) place[d] += first[d];
}

void FixMPMRigid::predict(double duration, double *u, double *inverse)
{
  const MPMRigidMotion before = *this;
  undo_half_kick();
  load_impulse(duration);
  hold();
  spin();
  MathExtra::copy3(v, u);
  MathExtra::copy3(omega, u + 3);
  find_mobility(inverse);
  static_cast<MPMRigidMotion &>(*this) = before;
}

/** Velocities of the middle of the last step. */
void FixMPMRigid::undo_half_kick()
{
  for (int d = 0; d < 3; d++) {
    v[d] -= half_kick[d];
    L[d] -= half_kick[3 + d];
  }
  std::fill_n(half_kick, 6, 0.0);
}

void FixMPMRigid::strike(const double *J)
{
  push(J);
  spin();
}

void FixMPMRigid::go_on(double dt, double kick, double half_kick_share,
                        const double *impulse_of_flow, const double *struck)
{
  dt_last = dt;
  in_flow = 1.0;
  for (int i = 0; i < 6; i++) impulse[i] = dt / kick * impulse_of_flow[i] + struck[i];
  undo_half_kick();
  const MPMRigidMotion before = *this;
  load_impulse(kick);
  hold();
  push(impulse_of_flow);
  move(dt);
  for (int d = 0; d < 3; d++) {
    half_kick[d] = half_kick_share * (v[d] - before.v[d]);
    half_kick[3 + d] = half_kick_share * (L[d] - before.L[d]);
    v[d] += half_kick[d];
    L[d] += half_kick[3 + d];
  }
  spin();
  check_motion(dt);
}

/** Kinetic energy. */
double FixMPMRigid::compute_scalar()
{
  return 0.5 * force->mvv2e * (mass * MathExtra::dot3(v, v) + MathExtra::dot3(L, omega));
}

/** Center, velocity, angular velocity, force and torque of the material, rotation matrix by rows,
 *  force and torque of walls and other bodies, and their work. */
double FixMPMRigid::compute_vector(int i)
{
  if (i < 3) return x[i];
  if (i < 6) return v[i - 3];
  if (i < 9) return omega[i - 6];
  if (i < 15) return dt_last > 0.0 ? impulse[i - 9] / (dt_last * force->ftm2v) : 0.0;
  if (i < 24) return Q[(i - 15) / 3][(i - 15) % 3];
  if (i < 30) return dt_last > 0.0 ? collision[i - 24] / (dt_last * force->ftm2v) : 0.0;
  return collision_work * force->mvv2e;
}

void FixMPMRigid::write_restart(FILE *fp)
{
  if (comm->me) return;
  const MPMRigidMotion &motion = *this;
  write_state(fp, &motion, sizeof(motion));
}

void FixMPMRigid::restart(char *buf)
{
  memcpy(static_cast<MPMRigidMotion *>(this), read_state(lmp, id, buf, sizeof(MPMRigidMotion)),
         sizeof(MPMRigidMotion));
}
