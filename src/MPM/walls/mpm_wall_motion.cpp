/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Rotation. The velocity given to a node at x is the chord ((R(dt) - I)(x - o))/dt and not the
 *  tangent omega x (x - o): positions are updated by x += dt v, so that the tangent would carry
 *  every point outward by a factor sqrt(1 + (omega dt)^2) per step, and the chord puts it back on
 *  its circle exactly, since splines reproduce linear fields. USF asks for velocities first, to
 *  find how the material has moved to its present position: then the chord is that of the step that
 *  has ended, (I - R^-1)(x - o)/dt, whose matrix is minus the transpose of the other one. */

#include "walls/mpm_wall.h"

#include "math_extra.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

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

/** Half of the change of the velocity of the wall, at the node, since the last step. An impulse R
 *  dt of the wall takes its node from the velocity u to v, with which points then go from x to x'.
 *  It adds R dt (u + v)/2 to the kinetic and stored energy, up to terms that the next step cancels,
 *  as the forces at x do work on half of the way to x and half of the way to x'. R dt v would
 *  differ from it by R (v - u) dt/2 in each step, which adds up where a mass is shaken. */
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
