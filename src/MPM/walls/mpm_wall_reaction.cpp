/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/mpm_wall_reaction.h"

#include "comm.h"
#include "field/mpm_field.h"
#include "field/mpm_friction_heat.h"
#include "force.h"
#include "math_extra.h"
#include "walls/mpm_wall.h"

#include <algorithm>
#include <vector>

using namespace LAMMPS_NS;
using namespace MPM_NS;

MPMWallReaction::MPMWallReaction(LAMMPS *lmp, MPMWall &wall) : Pointers(lmp), wall(wall) {}

MPMWallReaction::~MPMWallReaction() = default;

void MPMWallReaction::begin_run(const Fix &user)
{
  if (!wall.heat.heats()) return;
  if (!heating) heating = std::make_unique<MPMFrictionHeat>(lmp, wall.heat);
  std::vector<MPMField *> fields;
  for (auto *of_all : MPMField::all(lmp))
    if (wall.acts_on(*of_all)) fields.push_back(of_all);
  heating->begin_run(user, fields);
}

void MPMWallReaction::begin_step(double dt)
{
  std::copy_n(on_bodies, 6, impulse);
  std::fill_n(on_bodies, 6, 0.0);
  dt_last = dt;
  reaction_known = false;
  if (heating) heating->begin_step();
}

void MPMWallReaction::begin_field(int index, bool counts)
{
  place = index;
  field = wall.fields[index];
  counting = counts;
  ledger = field->ledger.on ? &field->ledger : nullptr;
  kinetic = driven = collided = 0.0;
  sliding = nullptr;
  share_of_old = counts && wall.motion.uniform && !field->kernel.affine ? field->options.flip : 0.0;
}

void MPMWallReaction::end_field()
{
  if (!counting) return;
  field->ledger.boundary += kinetic * force->mvv2e;
  field->ledger.driven += driven * force->mvv2e;
  if (ledger) ledger->transfer += collided * force->mvv2e;
}

/** Work is impulse times the velocity with which points are then moved, less half of the change of
 *  the velocity of the wall. The kinetic energy of the nodes changes by the change of velocity
 *  times the mean of old and new one; the part that is not work is lost. */
void MPMWallReaction::set_velocity(int64_t node, const double *V, const double *v,
                                   const double *old, const double *whole)
{
  Grid &grid = field->grid;
  double *const record = grid.record(node);
  const int dim = grid.lattice.dim;
  double change[3] = {0.0}, more = 0.0;
  for (int d = 0; d < dim; d++) change[d] = v[d] - record[d];
  if (sliding) more = slip_work(node, V, change, v, whole ? whole : v);
  if (counting && grid.owns(node)) {
    double moved = more, by_wall = 0.0, gained = 0.0, change_old[3] = {0.0}, push[3] = {0.0};
    double faster[3] = {0.0};
    if (wall.motion.changes) wall.motion.half_change(grid, node, faster);
    for (int d = 0; d < dim; d++) {
      if (old) change_old[d] = old[d] - record[4 + d];
      const double given = change[d] - share_of_old * change_old[d];
      push[d] = record[3] * given;
      impulse[d] += push[d];
      moved += given * ((whole ? whole : v)[d] - faster[d]);
      by_wall += given * (V[d] - faster[d]);
      if (ledger)
        gained += 0.5 * (change[d] - change_old[d]) * (v[d] + (old ? old[d] : record[4 + d]));
    }
    add_moment(*field, node, push);
    if (ledger) ledger->note_push(record, change, change_old);
    wall.state.work += record[3] * moved;
    kinetic += record[3] * moved;
    driven += record[3] * by_wall;
    collided += record[3] * (gained - moved);
  }
  std::copy_n(v, dim, record);
  if (old) std::copy_n(old, dim, record + 4);
}

/** Moment about the origin of an impulse on a node. */
void MPMWallReaction::add_moment(const MPMField &field, int64_t node, const double *push)
{
  double X[3], x[3], moment[3];
  field.grid.node_position(node, X);
  wall.motion.position(X, x);
  MathExtra::cross3(x, push, moment);
  for (int d = 0; d < 3; d++) impulse[3 + d] += moment[d];
}

/** Impulse on a node, counted like any other, see set_velocity(). */
void MPMWallReaction::add(MPMField &field, int64_t node, const double *push)
{
  Grid &grid = field.grid;
  if (!grid.owns(node)) return;
  const double *const record = grid.record(node);
  double V[3], faster[3] = {0.0}, moved = 0.0, driven = 0.0, gained = 0.0;
  wall.motion.velocity(grid, node, V);
  if (wall.motion.changes) wall.motion.half_change(grid, node, faster);
  for (int d = 0; d < grid.lattice.dim; d++) {
    impulse[d] += push[d];
    moved += push[d] * (record[d] - faster[d]);
    driven += push[d] * (V[d] - faster[d]);
    if (field.ledger.on) gained += 0.5 * push[d] * (record[d] + record[4 + d]);
  }
  add_moment(field, node, push);
  reaction_known = false;
  wall.state.work += moved;
  field.ledger.boundary += moved * force->mvv2e;
  field.ledger.driven += driven * force->mvv2e;
  if (field.ledger.on) field.ledger.transfer += (gained - moved) * force->mvv2e;
}

void MPMWallReaction::add_body_impulse(const double *x, const double *push)
{
  if (comm->me) return;
  double moment[3];
  MathExtra::cross3(x, push, moment);
  for (int d = 0; d < 3; d++) {
    on_bodies[d] += push[d];
    on_bodies[3 + d] += moment[d];
  }
}

/** Gives the heat of friction to a node whose velocity changes to v. The work of the tangential
 *  impulse was counted with another velocity; returns the work per mass that the ledger must
 *  add. */
double MPMWallReaction::slip_work(int64_t node, const double *V, const double *change,
                                  const double *v, const double *counted)
{
  Grid &grid = field->grid;
  const double *const record = grid.record(node);
  const int dim = grid.lattice.dim;
  double along = 0.0, J[3] = {0.0}, old[3] = {0.0}, relative[3] = {0.0};
  double work = 0.0, by_wall = 0.0;
  for (int d = 0; d < dim; d++) along += change[d] * sliding[d];
  for (int d = 0; d < dim; d++) {
    const double slide = change[d] - along * sliding[d];
    J[d] = record[3] * slide;
    old[d] = record[4 + d] - V[d];
    relative[d] = v[d] - V[d];
    work += slide * counted[d];
    by_wall += slide * V[d];
  }
  const double heat = heating->made(J, old, relative, dim);
  heating->at_wall(place, record, heat, grid.owns(node));
  return by_wall - heat / (record[3] * force->mvv2e) - work;
}

double MPMWallReaction::work() const
{
  double all;
  MPI_Allreduce(&wall.state.work, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all * force->mvv2e;
}

double MPMWallReaction::force_on_wall(int component)
{
  if (!reaction_known) {
    MPI_Allreduce(impulse, reaction, 6, MPI_DOUBLE, MPI_SUM, world);
    for (double &r : reaction) r /= -dt_last * force->ftm2v;
    reaction_known = true;
  }
  return reaction[component];
}

double MPMWallReaction::memory_usage() const
{
  return heating ? heating->memory_usage() : 0.0;
}
