/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "contact/mpm_impulses.h"

#include "math/coulomb.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int MAX_ROUNDS = 1000;
static constexpr double SMALLEST = 1.0e-13;    // change of velocities over the largest velocity

/** Velocity at a place of a body that moves with u. */
static void velocity_at(const double *u, const double *r, double *v)
{
  MathExtra::cross3(u + 3, r, v);
  MathExtra::add3(v, u, v);
}

void MPMImpulses::relative_velocity(const MPMTouch &touch, double *w) const
{
  double v[3];
  velocity_at(bodies[touch.a].u, touch.ra, w);
  MathExtra::sub3(w, touch.moving, w);
  if (touch.b < 0) return;
  velocity_at(bodies[touch.b].u, touch.rb, v);
  MathExtra::sub3(w, v, w);
}

/** Effect of an impulse of 1 along an axis on the velocities of the bodies; returns that on the
 *  relative velocity along the axis. */
double MPMImpulses::find_axis(const MPMTouch &touch, const double *axis, double *to_a,
                              double *to_b) const
{
  double change = 0.0;
  for (const bool second : {false, true}) {
    const int body = second ? touch.b : touch.a;
    if (body < 0) continue;
    const double *const r = second ? touch.rb : touch.ra;
    double *const to = second ? to_b : to_a;
    double push[6], v[3];
    MathExtra::copy3(axis, push);
    MathExtra::cross3(r, axis, push + 3);
    for (int i = 0; i < 6; i++) {
      to[i] = 0.0;
      for (int j = 0; j < 6; j++) to[i] += bodies[body].mobility[i][j] * push[j];
    }
    velocity_at(to, r, v);
    change += MathExtra::dot3(v, axis);
    for (int i = 0; second && i < 6; i++) to[i] *= -1.0;
  }
  return change;
}

void MPMImpulses::find_frame(const MPMTouch &touch, Frame &frame) const
{
  int least = 0;
  for (int d = 1; d < 3; d++)
    if (std::fabs(touch.n[d]) < std::fabs(touch.n[least])) least = d;
  double e[3] = {0.0, 0.0, 0.0};
  e[least] = 1.0;
  MathExtra::copy3(touch.n, frame.axis[0]);
  MathExtra::cross3(touch.n, e, frame.axis[1]);
  MathExtra::norm3(frame.axis[1]);
  MathExtra::cross3(touch.n, frame.axis[1], frame.axis[2]);
  double most = 0.0;
  for (const int body : {touch.a, touch.b})
    for (int d = 0; body >= 0 && d < 3; d++) most = std::max(most, bodies[body].mobility[d][d]);
  for (int k = 0; k < 3; k++) {
    frame.yield[k] = find_axis(touch, frame.axis[k], frame.to_a[k], frame.to_b[k]);
    // what is held does not yield, but for round-off
    if (!(frame.yield[k] > 1.0e-12 * most)) frame.yield[k] = 0.0;
  }
}

void MPMImpulses::push(const MPMTouch &touch, const Frame &frame, int axis, double size)
{
  for (int i = 0; i < 6; i++) bodies[touch.a].u[i] += size * frame.to_a[axis][i];
  if (touch.b < 0) return;
  for (int i = 0; i < 6; i++) bodies[touch.b].u[i] += size * frame.to_b[axis][i];
}

/** Finds the impulse at one place for given ones at all others. Returns the change of the relative
 *  velocity there. */
double MPMImpulses::improve(MPMTouch &touch, const Frame &frame)
{
  const auto &[n, t1, t2] = frame.axis;
  double w[3], J[3];
  relative_velocity(touch, w);
  for (int k = 0; k < 3; k++) J[k] = MathExtra::dot3(touch.impulse, frame.axis[k]);
  if (frame.yield[0] == 0.0) return 0.0;
  const double normal =
      std::max(0.0, J[0] + (touch.least - MathExtra::dot3(w, n)) / frame.yield[0]);
  const double change = normal - J[0];
  push(touch, frame, 0, change);
  double largest = std::fabs(change) * frame.yield[0];
  double along[2] = {J[1], J[2]};
  if (touch.friction > 0.0) {
    relative_velocity(touch, w);
    const double yield = std::max(frame.yield[1], frame.yield[2]);
    if (yield > 0.0) {
      along[0] -= MathExtra::dot3(w, t1) / yield;
      along[1] -= MathExtra::dot3(w, t2) / yield;
    }
    const double mu = touch.friction;
    const double share = normal == 0.0 ? 0.0
        : std::isinf(mu)               ? 1.0
                         : CoulombFriction{mu, mu}.share(std::hypot(along[0], along[1]), normal);
    for (int k = 0; k < 2; k++) {
      along[k] *= share;
      push(touch, frame, 1 + k, along[k] - J[1 + k]);
      largest = std::max(largest, std::fabs(along[k] - J[1 + k]) * yield);
    }
  }
  for (int d = 0; d < 3; d++)
    touch.impulse[d] = normal * n[d] + along[0] * t1[d] + along[1] * t2[d];
  return largest;
}

void MPMImpulses::solve()
{
  frames.resize(touches.size());
  double largest = 0.0, w[3];
  for (std::size_t k = 0; k < touches.size(); k++) {
    auto &touch = touches[k];
    find_frame(touch, frames[k]);
    MathExtra::zero3(touch.impulse);
    relative_velocity(touch, w);
    largest = std::max({largest, MathExtra::len3(w), std::fabs(touch.least)});
  }
  for (int round = 0; round < MAX_ROUNDS; round++) {
    double change = 0.0;
    for (std::size_t k = 0; k < touches.size(); k++)
      change = std::max(change, improve(touches[k], frames[k]));
    if (change <= SMALLEST * largest) break;
  }
}
