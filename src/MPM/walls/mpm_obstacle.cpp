/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/mpm_obstacle.h"

#include "domain.h"
#include "math_extra.h"
#include "region.h"
#include "walls/fix_mpm_boundary.h"
#include "walls/mpm_region_surface.h"
#include "walls/mpm_wall.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;

MPMWallObstacle::MPMWallObstacle(FixMPMBoundary &fix, const MPMWall &wall, const Domain &box,
                                 int face, double spacing, double dt) :
    fix(fix),
    wall(wall), box(box), face(face), plane(face >= 0 || strcmp(wall.region->style, "plane") == 0),
    spacing(spacing), dt(dt)
{
  name = face < 0 ? "the region of fix mpm/boundary " : "a face of fix mpm/boundary ";
  name += fix.id;
}

/** What sticks does not slide, unless the wall leaves it free to do so. */
double MPMWallObstacle::friction_at(const double *x) const
{
  if (wall.kind == MPMWall::STICK) return wall.all_given() ? HUGE_VAL : 0.0;
  return wall.friction_at(x);
}

/** The place for which a region, which is already where it will be at the end of the step, has the
 *  distance of x at the start; in the box, as periodic images of regions do not act. */
void MPMWallObstacle::place(const double *x, double *y) const
{
  for (int d = 0; d < 3; d++) {
    y[d] = x[d];
    if (box.periodicity[d]) y[d] -= box.prd[d] * std::floor((x[d] - box.boxlo[d]) / box.prd[d]);
  }
  if (!wall.region_moves()) return;
  double v[3];
  wall.motion.velocity(y, v);
  for (int d = 0; d < 3; d++) y[d] += dt * v[d];
}

double MPMWallObstacle::distance(const double *x, double far) const
{
  if (face >= 0)
    return face % 2 ? box.boxhi[face / 2] - x[face / 2] : x[face / 2] - box.boxlo[face / 2];
  double y[3];
  place(x, y);
  return wall.surface->distance(y, far);
}

void MPMWallObstacle::normal(const double *x, double *n) const
{
  MathExtra::zero3(n);
  if (face >= 0) {
    n[face / 2] = face % 2 ? -1.0 : 1.0;
    return;
  }
  double y[3];
  place(x, y);
  wall.surface->normal(y, MPMWall::FAR * spacing, MPMWall::NORMAL_STEP * spacing, n);
}

/** A face that has a velocity, and a region that does not move by itself, stay where they are: they
 *  push, but do not make way. */
void MPMWallObstacle::velocity(const double *x, const double *n, double *v) const
{
  wall.motion.velocity(x, v);
  if (wall.region_moves()) return;
  const double back = std::min(0.0, MathExtra::dot3(v, n));
  for (int d = 0; d < 3; d++) v[d] -= back * n[d];
}

void MPMWallObstacle::push(const double *x, const double *impulse)
{
  fix.add_body_impulse(x, impulse);
}
