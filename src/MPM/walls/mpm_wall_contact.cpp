/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Water in pores presses on walls, too, and bears a part of the impulse of the wall. Only the rest
 *  acts between grains and wall: friction is proportional to it, and where it would be negative,
 *  grains leave a separating wall, pushed by the water. Water does not pull at a separating
 *  wall. */

#include "walls/mpm_wall_contact.h"

#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "math/coulomb.h"
#include "walls/mpm_wall.h"
#include "walls/mpm_wall_reaction.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

bool MPMWallContact::holds(MPMField &field, MPMContactState &state, bool touched,
                           const int64_t *node, int n, const double *normal, double push,
                           double tangential, double &share, double mass)
{
  const double by_water = touched ? water_on(node, n, normal) / mass : 0.0;
  share = tangential_share(state, wall.friction_at(field.grid, node, n), touched ? push : 0.0,
                           by_water, tangential);
  if (state == MPMContactState::OPEN && by_water > 0.0) push_by_water(field, node, n, normal);
  if (state == MPMContactState::SLIDING) reaction.begin_sliding(normal);
  return state != MPMContactState::OPEN;
}

/** The share of a tangential impulse that friction gives, where the wall has this impulse along its
 *  normal, of which water bears a part. */
double MPMWallContact::tangential_share(MPMContactState &state, double friction, double normal,
                                        double by_water, double tangential) const
{
  if (wall.kind == MPMWall::STICK) {
    state = MPMContactState::STUCK;
    if (constraint && !reaction.is_counting()) constraint->impulse += unit * normal;
    return 1.0;
  }
  if (constraint) {
    state = constraint->active ? MPMContactState::SLIDING : MPMContactState::OPEN;
    if (!reaction.is_counting()) constraint->impulse += unit * normal;
    return 0.0;
  }
  if (!decided) {
    state = MPMContactState::SLIDING;
    const double grains = normal - by_water;
    if (wall.kind == MPMWall::SEPARATE && normal <= std::max(by_water, 0.0)) {
      state = MPMContactState::OPEN;
    } else if (friction > 0.0 && grains > 0.0) {
      const CoulombFriction law = {friction, friction};
      if (law.slides(tangential, grains)) return law.share(tangential, grains);
      state = MPMContactState::STUCK;
    }
  }
  return state == MPMContactState::STUCK ? 1.0 : 0.0;
}

void MPMWallContact::find_water(MPMField &field, const std::vector<char> &near, double dt)
{
  water.clear();
  if (pore_surface_force(field, near, water))
    for (double &w : water) w *= dt;
}

/** Impulse of the water on the wall at n nodes, -1: none. */
double MPMWallContact::water_on(const int64_t *node, int n, const double *normal) const
{
  double sum = 0.0;
  if (decided || water.empty()) return sum;
  for (int k = 0; k < n; k++)
    for (int d = 0; d < 3 && node[k] >= 0; d++) sum -= water[3 * node[k] + d] * normal[d];
  return sum;
}

/** The impulse of the water, which does work on the body that it lifts, at nodes that the wall has
 *  let go. */
void MPMWallContact::push_by_water(MPMField &field, const int64_t *nodes, int n,
                                   const double *normal)
{
  for (int k = 0; k < n; k++) {
    const int64_t node = nodes[k];
    if (node < 0) continue;
    const double *const record = field.grid.record(node);
    if (!(record[3] > 0.0)) continue;
    double v[3] = {0.0, 0.0, 0.0}, along = 0.0;
    for (int d = 0; d < 3; d++) along += water[3 * node + d] * normal[d];
    for (int d = 0; d < field.lattice.dim; d++) v[d] = record[d] - along * normal[d] / record[3];
    reaction.set_velocity(node, v, v, nullptr);
  }
}
