/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "contact/mpm_contact_bodies.h"

#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_node_sums.h"
#include "field/mpm_physics.h"
#include "field/mpm_point_map.h"
#include "modify.h"
#include "walls/fix_mpm_boundary.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   a body
------------------------------------------------------------------------- */

int64_t MPMContactBody::node_of(const double *record) const
{
  Grid &grid = field->grid;
  return (record - grid.nodes()) / grid.nreal;
}

int64_t MPMContactBody::node_at(const int *index) const
{
  int at[3];
  for (int d = 0; d < 3; d++) at[d] = field->lattice.wrap(d, index[d]);
  return field->grid.locate(at);
}

bool MPMContactBody::knows(const int *index) const
{
  const Grid &grid = field->grid;
  if (node_at(index) >= 0) return true;
  bool inside = true;
  for (int d = 0; d < grid.lattice.dim; d++) {
    const int b = field->lattice.wrap(d, index[d]) >> grid.shift_bits;
    inside = inside && b >= reach.extent[d] && b <= -reach.extent[3 + d];
  }
  return !inside;
}

MPMNodeWalls MPMContactBody::walls_at(const double *record) const
{
  const int64_t node = node_of(record);
  constexpr int ALL = 7;
  MPMNodeWalls walls = {};
  walls.held = (char) (held[node] & ALL);
  for (int d = 0; d < 3; d++) {
    walls.start[d] = record[d];
    walls.velocity[d] = predicted.held[3 * node + d];
    const int place = predicted.mirrored[3 * node + d];
    if (place == 0 || walls.held >> d & 1) continue;
    walls.mirrored |= 1 << d;
    const auto &mirror = predicted.mirrors[std::abs(place) - 1];
    walls.velocity[d] = mirror.wall[d] + (place > 0 ? mirror.odd[d] : -mirror.odd[d]);
    walls.mass[d] = mirror.mass;
  }
  walls.outside = (char) (held[node] >> 3 & walls.mirrored);
  return walls;
}

void MPMContactBody::move_mirrors(const double *record, const std::array<double, 3> &before)
{
  const int64_t node = node_of(record);
  for (int d = 0; d < field->lattice.dim; d++) {
    const int place = predicted.mirrored[3 * node + d];
    if (place == 0) continue;
    auto &mirror = predicted.mirrors[std::abs(place) - 1];
    const double change = (record[d] - before[d]) * record[3] / mirror.mass;
    mirror.odd[d] += place > 0 ? change : -change;
  }
}

void MPMContactBody::mark_near(int slot)
{
  near[slot] = 1;
  const Grid &grid = field->grid;
  const int *const b = grid.blocks[slot].b;
  for (const int image : images)
    for (int corner = 0; corner < 8 && !near[image]; corner++) {
      const auto canonical = canonical_block(grid, grid.blocks[image], corner);
      near[image] = std::equal(canonical.begin(), canonical.end(), b);
    }
}

/* ----------------------------------------------------------------------
   each field has blocks that others need: all are renewed together
------------------------------------------------------------------------- */

void MPMContactBodies::begin_run()
{
  inside.find(*list[0].field, *domain);
  lists_valid = false;
}

int MPMContactBodies::dim() const
{
  return list[0].field->lattice.dim;
}

double MPMContactBodies::spacing() const
{
  return list[0].field->lattice.h;
}

bool MPMContactBodies::is_stale() const
{
  return std::any_of(list.begin(), list.end(), [](const MPMContactBody &body) {
    return !body.field->map->valid;
  });
}

void MPMContactBodies::couple_topology()
{
  if (is_stale())
    for (const auto &body : list) body.field->map->valid = false;
}

/** The boxes of points, see map_boxes(), reach farther than these blocks. */
static void activate_around(Grid &grid)
{
  const std::size_t known = grid.blocks.size();
  for (std::size_t slot = 0; slot < known; slot++) {
    if (!grid.blocks[slot].reached) continue;
    int b[3], low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    for (int d = 0; d < grid.lattice.dim; d++) {
      low[d] = grid.blocks[slot].b[d] - 1;
      high[d] = low[d] + 2;
    }
    for (b[0] = low[0]; b[0] <= high[0]; b[0]++)
      for (b[1] = low[1]; b[1] <= high[1]; b[1]++)
        for (b[2] = low[2]; b[2] <= high[2]; b[2]++) grid.activate(b);
  }
}

void MPMContactBodies::blocks_found()
{
  if (!is_stale()) return;
  lists_valid = false;

  for (auto &body : list) {
    if (body.refined) body.refined->extend_for_finer(*body.field);
    if (on_several_lattices || all_near) activate_around(body.field->grid);
    body.reach.find(body.field->grid, world);
  }
}

/* ----------------------------------------------------------------------
   where bodies may meet, a rank must know the mass of all bodies at the nodes of any of them
------------------------------------------------------------------------- */

void MPMContactBodies::extend_topology(MPMField &field)
{
  for (const auto &body : list) {
    if (body.field != &field) continue;
    for (const auto &other : list)
      if (&other != &body) body.reach.activate_those_of(other.reach, field.grid);

    // and also their mirror images at fixed faces. Blocks that are added are visited, too, which
    // gives images of images

    for (std::size_t ib = 0; ib < field.grid.blocks.size(); ib++) {
      int b[3];
      std::copy_n(field.grid.blocks[ib].b, 3, b);
      inside.mirrors(field.grid, b, [&](const int *image) {
        field.grid.activate(image);
      });
    }
  }
}

bool MPMContactBodies::find_shared()
{
  if (lists_valid) return may_touch;
  shared.clear();
  const int n = (int) list.size();
  for (int k = 0; k < n; k++) {
    const Grid &grid = list[k].field->grid;
    list[k].images.clear();
    for (std::size_t slot = 0; slot < grid.blocks.size(); slot++)
      if (grid.blocks[slot].alias) list[k].images.push_back((int) slot);
    for (const auto &block : grid.blocks) {
      MPMSharedBlock c = {{}, ~block.alias, block.owned};
      for (int j = 0; j < n; j++) c.slot[j] = list[j].field->grid.find(block.b);
      const auto has = [](int slot) {
        return slot >= 0;
      };
      const bool listed = std::any_of(c.slot, c.slot + k, has);
      if (!listed && std::any_of(c.slot + k + 1, c.slot + n, has)) shared.push_back(c);
    }
  }

  // the action of walls on the nodes, after contact

  for (auto &body : list) {
    body.held.assign(body.field->grid.nnodes(), 0);
    for (auto *fix : modify->get_fix_by_style("^mpm/boundary$"))
      dynamic_cast<FixMPMBoundary *>(fix)->mark_prescribed(*body.field, body.held);
  }
  int any = !shared.empty(), all;
  MPI_Allreduce(&any, &all, 1, MPI_INT, MPI_MAX, world);
  may_touch = all;
  lists_valid = true;
  return may_touch;
}

/* ----------------------------------------------------------------------
   gradients and volumes of the bodies at the nodes
------------------------------------------------------------------------- */

bool MPMContactBodies::map(bool with_volumes)
{
  for (auto &body : list) body.near.assign(body.field->grid.blocks.size(), all_near);
  int any = 0, all;
  double *record[MOST];
  for (const auto &c : shared) {
    bool meet = false;
    for (int n = 0; n < NODES_PER_BLOCK && !meet; n++)
      meet = (c.canonical >> n & 1) && records(c, n, record) > 1;
    if (!meet) continue;
    any = 1;
    for (std::size_t k = 0; k < list.size(); k++)
      if (c.slot[k] >= 0) list[k].mark_near(c.slot[k]);
  }
  MPI_Allreduce(&any, &all, 1, MPI_INT, MPI_MAX, world);
  if (!all) return false;

  for (auto &body : list) {
    const Grid &grid = body.field->grid;
    for (bool more = true; more;) {    // at edges of the box, images of images, too
      more = false;
      for (std::size_t slot = 0; slot < grid.blocks.size(); slot++)
        if (body.near[slot])
          inside.mirrors(grid, grid.blocks[slot].b, [&](const int *image) {
            const int found = grid.find(image);
            if (found < 0 || body.near[found]) return;
            body.mark_near(found);
            more = true;
          });
    }
    predict_walls(body);
    map_content(body, with_volumes);
    body.water.clear();
    if (pore_pressure(*body.field)) pore_surface_force(*body.field, body.near, body.water);
  }
  return true;
}

/* ----------------------------------------------------------------------
   On several lattices, everything that the function of a node reaches decides what touches,
   including points of finer lattices; the momentum of the node has only points without a free node
   between. Sums of a part of a function over small points differ from those over large ones, but
   with points as boxes they are the same
------------------------------------------------------------------------- */

void MPMContactBodies::map_content(MPMContactBody &body, bool with_volumes)
{
  const Weight weight = by_mass ? Weight::MASS : Weight::VOLUME;
  if (on_several_lattices) {
    std::vector<MPMField *> all = body.finer;
    all.push_back(body.field);
    map_boxes(*body.field, all, weight, body.near, body.gradient, body.fraction);
    return;
  }
  map_gradient(*body.field, weight, body.near, body.gradient);
  if (with_volumes) map_volume(*body.field, body.near, body.fraction);
}

void MPMContactBodies::predict_walls(MPMContactBody &body)
{
  body.predicted.reset((int64_t) body.held.size());
  for (auto *fix : modify->get_fix_by_style("^mpm/boundary$"))
    dynamic_cast<FixMPMBoundary *>(fix)->predict(*body.field, body.near, body.predicted);
}

int MPMContactBodies::records(const MPMSharedBlock &c, int n, double *record[MOST])
{
  int massive = 0;
  for (std::size_t k = 0; k < list.size(); k++) {
    record[k] = c.slot[k] < 0 ? nullptr : list[k].field->grid.record(c.slot[k], n);
    if (record[k] && !(record[k][3] > 0.0)) record[k] = nullptr;
    massive += record[k] != nullptr;
  }
  return massive;
}

double MPMContactBodies::filled(const MPMSharedBlock &c, int n) const
{
  int any = 0, index[3];
  while (c.slot[any] < 0) any++;
  const Grid &grid = list[any].field->grid;
  grid.node_index(grid.blocks[c.slot[any]], n, index);
  bool image = false;
  const double most = inside.at(index, grid.lattice.dim, image);
  double sum = 0.0;
  for (std::size_t k = 0; k < list.size(); k++) {
    int64_t node = c.slot[k] < 0 ? -1 : (int64_t) c.slot[k] * NODES_PER_BLOCK + n;
    if (image) node = list[k].field->grid.locate(index);
    if (node >= 0) sum += list[k].fraction[node];
  }
  return most > 0.0 ? sum / most : 0.0;
}

double MPMContactBodies::fraction(const MPMContactBody &body, const int *index) const
{
  int at[3] = {index[0], index[1], index[2]};
  bool image = false;
  const double most = inside.at(at, body.field->lattice.dim, image);
  const int64_t node = body.node_at(at);
  return node >= 0 && most > 0.0 ? body.fraction[node] / most : 0.0;
}

void MPMContactBodies::gradient_with_mirrors(const MPMContactBody &body, int slot, int n,
                                             double *g) const
{
  const Grid &grid = body.field->grid;
  const int dim = grid.lattice.dim;
  int index[3], axis[3], plane[3], naxis = 0;
  grid.node_index(grid.blocks[slot], n, index);
  for (int d = 0; d < dim; d++)
    for (const auto &near : inside.across(d)) {
      if (!near.mirror || std::abs(index[d] - near.plane) > MPMInsideFraction::REACH) continue;
      axis[naxis] = d;
      plane[naxis++] = near.plane;
      break;    // in a narrow box, one of the two
    }
  std::copy_n(&body.gradient[3 * ((int64_t) slot * NODES_PER_BLOCK + n)], 3, g);
  for (int images = 1; images < 1 << naxis; images++) {
    int image[3] = {index[0], index[1], index[2]};
    double sign[3] = {1.0, 1.0, 1.0};
    for (int k = 0; k < naxis; k++) {
      if (!(images >> k & 1)) continue;
      image[axis[k]] = 2 * plane[k] - index[axis[k]];
      sign[axis[k]] = -1.0;
    }
    const int64_t node = grid.locate(image);
    if (node < 0) continue;
    for (int d = 0; d < dim; d++) g[d] += sign[d] * body.gradient[3 * node + d];
  }
}

void MPMContactBodies::book(double *const *record, const Velocities &start)
{
  for (int k = 0; k < size(); k++) {
    // another rank may own the node in this field: other impulses on it are booked there
    if (!record[k] || !list[k].field->grid.owns(list[k].node_of(record[k]))) continue;
    double change[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < dim(); d++) change[d] = record[k][d] - start[k][d];
    list[k].field->ledger.count_push(record[k], change);
  }
}

double MPMContactBodies::memory_usage() const
{
  double bytes = shared.capacity() * sizeof(MPMSharedBlock);
  for (const auto &body : list)
    bytes +=
        (body.gradient.capacity() + body.fraction.capacity() + body.predicted.held.capacity()) *
        sizeof(double);
  return bytes;
}
