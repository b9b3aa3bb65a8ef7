/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* The velocities w of a place of a body relative to the obstacle after a step, along the normal out
   of the obstacle, with the gap g at its start:

     w >= -g/dt    the body gets as far as to the surface
     w >= -e w'    if it reaches the surface in this step and has come to it with w' < 0

   The first one is the default, and that of bodies at rest. The second one is for collisions: the
   speed w' at the start of the step is more than loads have given the body in two steps. */

#include "contact/mpm_rigid_collisions.h"

#include "base/mpm_find_fixes.h"
#include "base/mpm_image.h"
#include "comm.h"
#include "contact/mpm_rigid_contact.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "math_extra.h"
#include "mesh/surface_points.h"
#include "update.h"
#include "walls/fix_mpm_boundary.h"

#include <algorithm>
#include <cmath>
#include <functional>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double MARGIN = 0.05;       // node spacings; places farther away do not touch
static constexpr double EQUAL = 1.0e-6;      // difference of distances over the size of a body
static constexpr double SAME_SIDE = 0.99;    // cosine of the angle between normals of one side
static constexpr int DIRECTIONS = 16;        // in which the outermost places of a side are taken
static constexpr double MOVED_OUT = 0.2;     // share of its depth by which a body leaves in a step
static constexpr double DEEP = 0.5;          // node spacings

/** A body as an obstacle for others. Its velocity is part of the solution. */
class MPMBodyObstacle : public MPMObstacle {
 public:
  MPMBodyObstacle(const MPMRigidMember &member) : contact(member.contact)
  {
    name = std::string("the body of fix mpm/rigid ") + member.id;
    friction = member.body.sticks() ? HUGE_VAL : member.body.friction;
    restitution = member.body.restitution;
  }
  double distance(const double *x, double far) const override { return contact.distance(x, far); }
  void normal(const double *x, double *n) const override { contact.normal(x, n); }
  void velocity(const double *, const double *, double *v) const override { MathExtra::zero3(v); }

 private:
  const MPMRigidContact &contact;
};

MPMRigidCollisions::MPMRigidCollisions(LAMMPS *lmp, std::vector<MPMRigidMember> &members,
                                       double dt) :
    Pointers(lmp),
    members(members), dt(dt), bodies(members.size(), -1)
{
  spacing = HUGE_VAL;
  for (const auto *field : MPMField::all(lmp)) spacing = std::min(spacing, field->lattice.h);
}

bool MPMRigidCollisions::is_free(int k) const
{
  const auto &body = members[k].body;
  return body.collides && !std::all_of(body.fixed, body.fixed + 6, [](bool held) {
           return held;
         });
}

void MPMRigidCollisions::act()
{
  const int n = (int) members.size();
  bool any = false;
  for (int k = 0; k < n; k++) any = any || is_free(k);
  if (any) {
    for (const auto &member : members)
      obstacles.push_back(std::make_unique<MPMBodyObstacle>(member));
    for (auto *wall : find_fixes<FixMPMBoundary>(lmp)) wall->list_obstacles(dt, obstacles);
    for (const auto &member : members) {
      MPMRigidBody body = member.body;
      body.spin();
      loaded.insert(loaded.end(), body.v, body.v + 3);
      loaded.insert(loaded.end(), body.omega, body.omega + 3);
    }
    for (int k = 0; k < n; k++)
      for (int o = 0; o < (int) obstacles.size(); o++)
        if (o != k && members[k].body.collides && (o >= n || members[o].body.collides) &&
            (is_free(k) || (o < n && is_free(o))))
          find(k, o);
  }
  for (int k = 0; k < n; k++)
    if (bodies[k] < 0) members[k].contact.act();
  if (impulses.touches.empty()) return;
  solve();
  end();
  move_out();
}

void MPMRigidCollisions::place(int k, const double *in_body, double *x) const
{
  MathExtra::matvec(members[k].body.Q, in_body, x);
  MathExtra::add3(x, members[k].body.x, x);
}

/** Finds where a body touches an obstacle. */
void MPMRigidCollisions::find(int k, int o)
{
  double way = 0.0;
  for (const int body : {k, o})
    if (body < (int) members.size()) {
      const double *const u = &loaded[6 * body];
      way += MathExtra::len3(u) + members[body].contact.farthest * MathExtra::len3(u + 3);
    }
  const auto &obstacle = *obstacles[o];
  double V[3];
  const double no_normal[3] = {0.0, 0.0, 0.0};
  obstacle.velocity(members[k].body.x, no_normal, V);
  const double margin = MARGIN * spacing + dt * (way + MathExtra::len3(V));
  const double reach = margin + members[k].contact.farthest;
  if (obstacle.distance(members[k].body.x, reach) >= reach) return;
  auto near = look(k, obstacle, margin);
  // each side of the obstacle by itself
  while (!near.empty()) {
    const Near first = near.front();
    const auto other = std::stable_partition(near.begin(), near.end(), [&](const Near &place) {
      return MathExtra::dot3(place.n, first.n) > SAME_SIDE;
    });
    for (const auto &place : outermost({near.begin(), other})) add(k, o, place);
    near.erase(near.begin(), other);
  }
}

/** Places of a body that are nearer to an obstacle than their neighbors, and than the margin. */
std::vector<MPMRigidCollisions::Near> MPMRigidCollisions::look(int k, const MPMObstacle &obstacle,
                                                               double margin) const
{
  const auto &points = *members[k].contact.points;
  const double size = members[k].contact.farthest, far = margin + 10.0 * size;
  std::vector<double> gap(points.size(), HUGE_VAL);
  std::vector<int> candidates;
  for (const auto &cluster : points.clusters()) {
    double x[3];
    place(k, cluster.center.data(), x);
    const double most = margin + cluster.radius;
    if (obstacle.distance(x, most) >= most) continue;
    for (int i = cluster.first; i < cluster.last; i++) {
      place(k, points[i].data(), x);
      gap[i] = obstacle.distance(x, far);
      // only corners are nearer to a plane than others
      if (gap[i] < margin && (points.is_corner(i) || !obstacle.is_plane())) candidates.push_back(i);
    }
  }
  std::vector<Near> near;
  for (const int i : candidates) {
    bool nearest = true;
    points.each_neighbor(i, [&](std::size_t j) {
      if (gap[j] < gap[i] - EQUAL * size) nearest = false;
    });
    Near touch;
    if (nearest && find_touch(k, i, obstacle, touch)) near.push_back(touch);
  }
  return near;
}

/** Where a body of which a point is the nearest one to an obstacle would touch this. */
bool MPMRigidCollisions::find_touch(int k, std::size_t point, const MPMObstacle &obstacle,
                                    Near &near) const
{
  constexpr int ROUNDS = 3;
  const auto &points = *members[k].contact.points;
  const double far = 10.0 * members[k].contact.farthest;
  bool curved = false;
  place(k, points[point].data(), near.x);
  for (int round = 0; round < ROUNDS; round++) {
    obstacle.normal(near.x, near.n);
    if (!(MathExtra::lensq3(near.n) > 0.0)) return false;
    std::array<double, 3> direction, at;
    MathExtra::transpose_matvec(members[k].body.Q, near.n, direction.data());
    for (double &d : direction) d = -d;
    curved = points.farthest(point, direction, at);
    if (!curved) break;
    place(k, at.data(), near.x);
    if (obstacle.is_plane()) break;
  }
  near.gap = obstacle.distance(near.x, far);
  if (!curved && !obstacle.is_plane()) straighten(k, point, near.n);
  return MathExtra::lensq3(near.n) > 0.0;
}

/** The normal of two surfaces that touch is one of each of them, also at their edges and corners:
 *  all of the body is on the outer side. */
void MPMRigidCollisions::straighten(int k, std::size_t point, double *n) const
{
  constexpr int ROUNDS = 3;
  const auto &points = *members[k].contact.points;
  for (int round = 0; round < ROUNDS; round++)
    points.each_neighbor(point, [&](std::size_t j) {
      double local[3], d[3];
      for (int c = 0; c < 3; c++) local[c] = points[j][c] - points[point][c];
      MathExtra::matvec(members[k].body.Q, local, d);
      const double below = MathExtra::dot3(d, n) / MathExtra::lensq3(d);
      if (below * MathExtra::len3(d) > -EQUAL) return;
      for (int c = 0; c < 3; c++) n[c] -= below * d[c];
    });
  const double length = MathExtra::len3(n);
  if (length > 0.1)
    MathExtra::scale3(1.0 / length, n);
  else
    MathExtra::zero3(n);
}

/** Of places on one side, those that are outermost in some directions, and the nearest one: the
 *  others lie between them. */
std::vector<MPMRigidCollisions::Near> MPMRigidCollisions::outermost(std::vector<Near> all)
{
  if (all.size() <= DIRECTIONS) return all;
  const double *const n = all[0].n;
  int least = 0;
  for (int d = 1; d < 3; d++)
    if (std::fabs(n[d]) < std::fabs(n[least])) least = d;
  double e[3] = {0.0, 0.0, 0.0}, across[2][3];
  e[least] = 1.0;
  MathExtra::cross3(n, e, across[0]);
  MathExtra::norm3(across[0]);
  MathExtra::cross3(n, across[0], across[1]);
  std::vector<std::size_t> chosen;
  const auto choose = [&](const std::function<double(const Near &)> &height) {
    const auto best = std::max_element(all.begin(), all.end(), [&](const Near &a, const Near &b) {
      return height(a) < height(b);
    });
    chosen.push_back(best - all.begin());
  };
  choose([](const Near &place) {
    return -place.gap;
  });
  for (int k = 0; k < DIRECTIONS; k++) {
    const double angle = 2.0 * M_PI * k / DIRECTIONS, c = cos(angle), s = sin(angle);
    choose([&](const Near &place) {
      return c * MathExtra::dot3(place.x, across[0]) + s * MathExtra::dot3(place.x, across[1]);
    });
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  std::vector<Near> some;
  for (const auto i : chosen) some.push_back(all[i]);
  return some;
}

/** Can an impulse along n at r from its center move this body, of which parts of the motion may be
 *  held? */
static bool yields(const MPMRigidBody &body, const double *r, const double *n)
{
  constexpr double ROUND_OFF = 1.0e-9;
  double moment[3];
  MathExtra::cross3(r, n, moment);
  for (int d = 0; d < 3; d++)
    if ((!body.fixed[d] && std::fabs(n[d]) > ROUND_OFF) ||
        (!body.fixed[3 + d] && std::fabs(moment[d]) > ROUND_OFF * MathExtra::len3(r)))
      return true;
  return false;
}

void MPMRigidCollisions::add(int k, int o, const Near &near)
{
  const auto &obstacle = *obstacles[o];
  const int n = (int) members.size();
  MPMTouch touch;
  MathExtra::sub3(near.x, members[k].body.x, touch.ra);
  MathExtra::zero3(touch.rb);
  if (o < n) {
    MathExtra::sub3(near.x, members[o].body.x, touch.rb);
    nearest_image(*domain, touch.rb);
  }
  // a body that is held at a plane of symmetry may go through it
  if (!yields(members[k].body, touch.ra, near.n) &&
      (o >= n || !yields(members[o].body, touch.rb, near.n)))
    return;
  for (const int body : {k, o}) {
    if (body >= n || bodies[body] >= 0) continue;
    bodies[body] = (int) impulses.bodies.size();
    impulses.bodies.emplace_back();
  }
  touch.a = bodies[k];
  touch.b = o < n ? bodies[o] : -1;
  MathExtra::copy3(near.n, touch.n);
  obstacle.velocity(near.x, near.n, touch.moving);
  touch.friction = obstacle.friction_at(near.x);
  const auto &body = members[k].body;
  if (o < n && !body.sticks()) touch.friction = std::min(touch.friction, body.friction);

  const auto approach = [&](const double *ua, const double *ub) {
    double w[3], v[3];
    MathExtra::cross3(ua + 3, touch.ra, w);
    for (int d = 0; d < 3; d++) w[d] += ua[d] - touch.moving[d];
    if (ub) {
      MathExtra::cross3(ub + 3, touch.rb, v);
      for (int d = 0; d < 3; d++) w[d] -= v[d] + ub[d];
    }
    return MathExtra::dot3(w, touch.n);
  };
  const double before = approach(members[k].old, o < n ? members[o].old : nullptr);
  const double after = approach(&loaded[6 * k], o < n ? &loaded[6 * o] : nullptr);
  const double e = std::min(body.restitution, obstacle.restitution);
  const bool collides = near.gap + dt * after <= 0.0 && before < -2.0 * std::fabs(after - before);
  impulses.touches.push_back(touch);
  rebounds.push_back(collides ? -e * before : 0.0);
  gaps.push_back(near.gap);
  of.push_back(&obstacle);
  places.insert(places.end(), near.x, near.x + 3);
  if (near.gap < -DEEP * spacing) tell(members[k], obstacle, -near.gap);
}

void MPMRigidCollisions::tell(const MPMRigidMember &member, const MPMObstacle &obstacle,
                              double depth) const
{
  if (member.warned_of_depth) return;
  member.warned_of_depth = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/rigid {}: the body is {:.3g} node spacings inside of {} at step {}, "
                   "which pushes it out: begin with a gap, use a smaller timestep, or collide no",
                   member.id, depth / spacing, obstacle.name, update->ntimestep);
}

/** With friction, Newton's law of restitution can give bodies more energy than they had. Then they
 *  part with the largest share of its speeds with which they do not gain any. */
void MPMRigidCollisions::find_impulses()
{
  constexpr int HALVINGS = 10;
  const auto start = impulses.bodies;
  std::vector<double> before, w(3);
  double scale = 0.0;
  for (const auto &touch : impulses.touches) {
    impulses.relative_velocity(touch, w.data());
    before.insert(before.end(), w.begin(), w.end());
  }
  const auto gains = [&](double share) {
    impulses.bodies = start;
    for (std::size_t k = 0; k < gaps.size(); k++) {
      auto &least = impulses.touches[k].least;
      least = -std::max(gaps[k], 0.0) / dt;
      if (rebounds[k] > 0.0) least = std::max(least, share * rebounds[k]);
    }
    impulses.solve();
    double gain = 0.0;
    scale = 0.0;
    for (std::size_t k = 0; k < gaps.size(); k++) {
      const auto &touch = impulses.touches[k];
      impulses.relative_velocity(touch, w.data());
      for (int d = 0; d < 3; d++) {
        const double work = 0.5 * touch.impulse[d] * (w[d] + before[3 * k + d]);
        gain += work;
        scale += std::fabs(touch.impulse[d] * before[3 * k + d]);
      }
    }
    return gain > 1.0e-9 * scale;
  };
  double most = 1.0, least = 0.0;
  if (!gains(most)) return;
  for (int k = 0; k < HALVINGS; k++) {
    const double share = 0.5 * (least + most);
    (gains(share) ? most : least) = share;
  }
  gains(least);
}

/** The velocities of bodies and nodes after all contact. */
void MPMRigidCollisions::solve()
{
  constexpr int MAX_ROUNDS = 30;
  const auto each = [&](const std::function<void(MPMRigidMember &, MPMImpulses::Body &)> &f) {
    for (std::size_t k = 0; k < members.size(); k++)
      if (bodies[k] >= 0) f(members[k], impulses.bodies[bodies[k]]);
  };
  each([](MPMRigidMember &member, MPMImpulses::Body &) {
    member.contact.begin();
  });
  bool changed = true;
  for (int round = 0; round < MAX_ROUNDS && changed; round++) {
    each([](MPMRigidMember &member, MPMImpulses::Body &body) {
      member.contact.find_motion(body.u, body.mobility);
    });
    find_impulses();
    changed = false;
    each([&](MPMRigidMember &member, MPMImpulses::Body &body) {
      if (member.contact.decide(body.u)) changed = true;
    });
  }
  each([](MPMRigidMember &member, MPMImpulses::Body &body) {
    member.contact.end(body.u);
  });
}

/** Gives bodies and walls their impulses. */
void MPMRigidCollisions::end()
{
  std::vector<double> sums(6 * impulses.bodies.size(), 0.0);
  for (std::size_t k = 0; k < impulses.touches.size(); k++) {
    const auto &touch = impulses.touches[k];
    const_cast<MPMObstacle *>(of[k])->push(&places[3 * k], touch.impulse);
    for (const int sign : {1, -1}) {
      const int body = sign > 0 ? touch.a : touch.b;
      if (body < 0) continue;
      double moment[3];
      MathExtra::cross3(sign > 0 ? touch.ra : touch.rb, touch.impulse, moment);
      for (int d = 0; d < 3; d++) {
        sums[6 * body + d] += sign * touch.impulse[d];
        sums[6 * body + 3 + d] += sign * moment[d];
      }
    }
  }
  for (std::size_t k = 0; k < members.size(); k++) {
    if (bodies[k] < 0) continue;
    auto &body = members[k].body;
    std::copy_n(&sums[6 * bodies[k]], 6, body.collision);
    body.push(body.collision);
  }
}

/** Bodies that are inside of obstacles go out of them, without friction, and into no other ones. */
void MPMRigidCollisions::move_out()
{
  double deepest = 0.0;
  for (const double gap : gaps) deepest = std::min(deepest, gap);
  if (deepest > -EQUAL * spacing) return;
  for (std::size_t k = 0; k < impulses.touches.size(); k++) {
    auto &touch = impulses.touches[k];
    double w[3];
    impulses.relative_velocity(touch, w);
    touch.least = gaps[k] < 0.0 ? -MOVED_OUT * gaps[k] / dt
                                : -std::max(0.0, gaps[k] / dt + MathExtra::dot3(w, touch.n));
  }
  for (auto &touch : impulses.touches) {
    MathExtra::zero3(touch.moving);
    touch.friction = 0.0;
  }
  for (auto &body : impulses.bodies) std::fill_n(body.u, 6, 0.0);
  impulses.solve();
  for (std::size_t k = 0; k < members.size(); k++)
    for (int i = 0; bodies[k] >= 0 && i < 6; i++)
      members[k].shift[i] = dt * impulses.bodies[bodies[k]].u[i];
}
