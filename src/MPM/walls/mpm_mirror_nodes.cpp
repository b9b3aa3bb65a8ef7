/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/mpm_mirror_nodes.h"

#include "domain.h"
#include "field/mpm_field.h"
#include "walls/mpm_line_constraint.h"
#include "walls/mpm_wall.h"
#include "walls/mpm_wall_reaction.h"

#include <algorithm>
#include <array>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* The impulse of the projection of mirror planes (README of this room) on the body is
 *
 *    -m(k0) w(k0) - sum_j 2 m1 m2/(m1 + m2) (w1 + w2)
 *
 *  with the velocities w relative to the wall of the nodes k0 + j and of their images k0 - j.
 *  Friction scales the tangential part for a column of nodes (Coulomb's law).
 *
 *  FLIP. Where material is held for good, v_old is constrained like v_new (Sulsky, Chen, Schreyer
 *  1994). But a point that arrives at the wall must lose its velocity: v_old relative to the wall
 *  counts as consistent with it, in each component, only up to the value at the first node
 *  inside. */

static constexpr double HEAVY = 0.500001;    // share of one node in the mass of mirror images

MPMMirrorNodes::MPMMirrorNodes(MPMWall &wall, MPMField &field, const Domain &box) :
    wall(wall), field(field), box(box)
{
  find_faces();
}

void MPMMirrorNodes::find_faces()
{
  faces.clear();
  for (int face : wall.face_list) faces.emplace_back(field, box, face);
}

bool MPMMirrorNodes::are_near(const std::vector<MPMBoxFace> &faces, int axis)
{
  const MPMBoxFace *lo = nullptr, *hi = nullptr;
  for (const auto &f : faces)
    if (f.axis == axis) (f.inward > 0 ? lo : hi) = &f;
  if (!lo || !hi) return false;
  return hi->plane - lo->plane < (lo->cut || hi->cut ? 5 : 3);
}

void MPMMirrorNodes::extend_topology() const
{
  Grid &grid = field.grid;

  // blocks that are added are looked at, too: images of images at edges, and narrow channels
  for (std::size_t ib = 0; ib < grid.blocks.size(); ib++)
    for (const auto &face : faces) {
      int b[3] = {grid.blocks[ib].b[0], grid.blocks[ib].b[1], grid.blocks[ib].b[2]};
      const int first = std::max(b[face.axis] * grid.side, face.begin());
      const int last = std::min(b[face.axis] * grid.side + grid.side - 1, face.end());
      if (first > last) continue;
      std::array<int, 3> needed = {2 * face.plane - last, 2 * face.plane - first, face.plane};
      if (face.cut) needed = {face.begin(), face.end(), face.end()};
      for (const int k : needed) {
        b[face.axis] = k >> grid.shift_bits;
        grid.activate(b);
      }
    }
}

bool MPMMirrorNodes::needs(const Grid::Block &block, int ahead) const
{
  const int side = field.grid.side;
  return std::any_of(faces.begin(), faces.end(), [&](const MPMBoxFace &face) {
    const int first = block.b[face.axis] * side;
    int begin = face.begin(), end = face.end();
    (face.inward > 0 ? end : begin) += face.inward * ahead;
    return first <= end && first + side > begin;
  });
}

void MPMMirrorNodes::list(std::vector<MPMWallNode> &deep)
{
  const Grid &grid = field.grid;
  images.clear();
  groups.clear();
  for (auto &face : faces) {
    face.lines.clear();
    face.columns.clear();
  }
  for (std::size_t ib = 0; ib < grid.blocks.size(); ib++) {
    const auto &block = grid.blocks[ib];
    for (auto &face : faces) {
      const int last = face.plane - face.inward * (MPMMirrorColumn::DEPTH + 1);
      const int lo = block.b[face.axis] * grid.side, hi = lo + grid.side - 1;
      const int start = face.cut ? face.first : face.plane;
      const bool line = (face.cut || wall.decides()) && start >= lo && start <= hi;
      const bool beyond = !face.cut && (face.inward > 0 ? lo <= last : hi >= last);
      if (!line && !beyond) continue;
      for (int n = 0; n < NODES_PER_BLOCK; n++) {
        if (block.alias >> n & 1) continue;
        int index[3];
        grid.node_index(block, n, index);
        if (line && index[face.axis] == start) face.add_line(field, index);
        if (beyond && (last - index[face.axis]) * face.inward >= 0) {
          MPMWallNode node = {(int64_t) ib * NODES_PER_BLOCK + n};
          node.normal[face.axis] = face.inward;
          deep.push_back(node);
        }
      }
    }
  }

  // stick: each component is odd about all faces; slip: the normal component is odd about its own
  // face
  if (wall.kind == MPMWall::STICK) {
    const bool prescribed[3] = {wall.velocity[0].given, wall.velocity[1].given,
                                wall.velocity[2].given};
    list_groups(prescribed, -1);
  } else if (!wall.decides()) {
    for (int d = 0; d < grid.lattice.dim; d++) {
      const bool prescribed[3] = {d == 0, d == 1, d == 2};
      list_groups(prescribed, d);
    }
  }
}

/** Nodes between the mirrors of this axis, or of all axes (-1), each with all its images in these
 *  mirrors. */
void MPMMirrorNodes::list_groups(const bool *prescribed, int axis)
{
  const Grid &grid = field.grid;
  Mirrors mirror = {};
  std::vector<Plane> planes[3];
  for (const auto &face : faces)
    if (!face.cut && (axis < 0 || axis == face.axis)) mirror[face.axis][face.inward < 0] = &face;

  for (std::size_t ib = 0; ib < grid.blocks.size(); ib++) {
    const auto &block = grid.blocks[ib];
    const bool near = std::any_of(faces.begin(), faces.end(), [&](const MPMBoxFace &face) {
      const int lo = block.b[face.axis] * grid.side;
      return &face == mirror[face.axis][face.inward < 0] &&
          lo <= face.plane + MPMMirrorColumn::DEPTH &&
          lo + grid.side > face.plane - MPMMirrorColumn::DEPTH;
    });
    if (!near) continue;
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (block.alias >> n & 1) continue;
      int index[3];
      grid.node_index(block, n, index);
      add_group(mirror, index, prescribed, planes);
    }
  }
}

/** The group of a node, unless it is an image of another one, or has no images. */
void MPMMirrorNodes::add_group(const Mirrors &mirror, const int *index, const bool *prescribed,
                               std::vector<Plane> planes[3])
{
  int at_wall[3], inner[3];
  bool inside = true, fixed = false, held = false;
  for (int d = 0; d < 3; d++) {
    planes[d].assign(1, {index[d], 1});
    at_wall[d] = inner[d] = index[d];
    for (int side = 0; side < 2; side++) {
      const MPMBoxFace *const face = mirror[d][side], *const opposite = mirror[d][1 - side];
      if (!face) continue;
      const int depth = face->inward * (index[d] - face->plane);
      inside = inside && depth >= 0;
      fixed = fixed || depth == 0;
      if (depth == 0) inner[d] += face->inward;
      held = held || (depth == 0 && opposite && inner[d] == opposite->plane);
      if (depth <= MPMMirrorColumn::DEPTH) at_wall[d] = face->plane;
    }
    // images of images are included: the list grows
    for (std::size_t k = 0; inside && k < planes[d].size(); k++)
      for (const MPMBoxFace *face : mirror[d]) {
        if (!face) continue;
        const Plane image = {2 * face->plane - planes[d][k].index, -planes[d][k].sign};
        const int depth = face->inward * (face->plane - image.index);
        bool skip = depth > MPMMirrorColumn::DEPTH || depth <= 0;
        for (const auto &known : planes[d]) skip = skip || known.index == image.index;
        if (!skip) planes[d].push_back(image);
      }
  }
  if (!inside) return;

  Group group;
  group.first = (int) images.size();
  group.fixed = fixed;
  std::copy_n(prescribed, 3, group.prescribed);
  for (const auto &x : planes[0])
    for (const auto &y : planes[1])
      for (const auto &z : planes[2]) {
        const int k[3] = {x.index, y.index, z.index};
        const int64_t node = field.grid.locate(k);
        if (node >= 0)    // else out of reach of points
          images.push_back({node, x.sign * y.sign * z.sign});
      }
  group.last = (int) images.size();
  group.inner = held ? -1 : field.grid.locate(inner);
  group.wall = field.grid.locate(at_wall);
  if (group.wall < 0) group.wall = images[group.first].node;
  if (fixed || group.last > group.first + 1)
    groups.push_back(group);
  else
    images.pop_back();
}

void MPMMirrorNodes::mark_blocks(std::vector<char> &blocks) const
{
  for (const auto &face : faces) {
    for (const auto &line : face.lines) line.mark_blocks(blocks);
    for (const auto &column : face.columns)
      for (const int64_t node : column.node)
        if (node >= 0) blocks[node / NODES_PER_BLOCK] = 1;
  }
}

/** Lines through faces that cut cells act twice. At edges, tangential components of one face are
 *  normal ones of another: these come last, so that no material gets out. */
void MPMMirrorNodes::act(MPMWallContact &contact)
{
  for (const bool last : {false, true}) {
    std::size_t k = 0;
    for (auto &face : faces) {
      if (!last || wall.kind == MPMWall::STICK || wall.rubs())
        for (std::size_t j = 0; j < face.lines.size(); j++) {
          contact.use_constraint(k + j);
          act_on_line(contact, face, face.lines[j], last);
        }
      k += face.size();
    }
  }
  std::size_t k = 0;
  for (auto &face : faces) {
    for (std::size_t j = 0; j < face.columns.size(); j++) {
      contact.use_constraint(k + j);
      act_on_column(contact, face, face.columns[j]);
    }
    k += face.size();
  }
  contact.constraint = nullptr;
  for (const auto &group : groups) act_on_group(contact.reaction, group);
}

/** Do the node and its images have mass, and more than one of them? A single one is free unless it
 *  is in the plane of the wall. For most nodes near walls this is false. */
bool MPMMirrorNodes::is_constrained(const Image *image, int n, bool fixed) const
{
  int massive = 0;
  for (int k = 0; k < n; k++) massive += field.grid.record(image[k].node)[3] > 0.0;
  return massive > (fixed ? 0 : 1);
}

/** Sets the prescribed velocities of a node and its images: odd about the wall, and equal to the
 *  wall in its plane (fixed). */
void MPMMirrorNodes::project(MPMWallReaction &reaction, const Image *image, int n, bool fixed,
                             const Prescribed &p)
{
  Grid &grid = field.grid;
  const int dim = grid.lattice.dim;
  const bool hold = p.hold[0] || p.hold[1] || p.hold[2];
  double mass = 0.0, w[3] = {0.0, 0.0, 0.0}, w_old[3] = {0.0, 0.0, 0.0};
  for (int k = 0; k < n; k++) {
    const int sign = image[k].sign;
    const double *r = grid.record(image[k].node);
    if (r[3] <= 0.0) continue;
    mass += r[3];
    for (int d = 0; d < dim; d++) {
      w[d] += sign * r[3] * (r[d] - p.V[d]);
      if (hold) w_old[d] += sign * r[3] * wall.motion.old_relative(r, d, p.limit[d]);
    }
  }
  for (int d = 0; d < dim; d++) {
    w[d] = fixed ? 0.0 : w[d] / mass;
    w_old[d] = fixed ? 0.0 : w_old[d] / mass;
  }

  for (int k = 0; k < n; k++) {
    const int sign = image[k].sign;
    const double *r = grid.record(image[k].node);
    double v[3], old[3];
    for (int d = 0; d < dim; d++) {
      const double odd = p.V[d] + sign * w[d];
      v[d] = p.share[d] == 1.0 ? odd : r[d] + p.share[d] * (odd - r[d]);
      if (!hold) continue;
      old[d] = r[4 + d];
      if (p.hold[d]) old[d] += sign * w_old[d] - wall.motion.old_relative(r, d, p.limit[d]);
    }
    reaction.set_velocity(image[k].node, p.V, v, hold ? old : nullptr);
  }
}

/** Bound of old velocities that count as consistent with the wall, from the first node inside next
 *  to a node of this mass, see FLIP above. */
static void limit_of_old(const double *record, double mass, const double *wall, int dim,
                         double *limit)
{
  const double part = MPMLineConstraint::part_of_light(record[3], mass);
  for (int d = 0; d < dim; d++)
    limit[d] = record[3] > 0.0 ? part * fabs(record[4 + d] - wall[d]) : 0.0;
}

void MPMMirrorNodes::act_on_column(MPMWallContact &contact, const MPMBoxFace &face,
                                   MPMMirrorColumn &column)
{
  Grid &grid = field.grid;
  MPMWallReaction &reaction = contact.reaction;
  const int dim = grid.lattice.dim, a = face.axis;
  const Image plane = {column.node[0], 1};
  const double *r = grid.record(plane.node);
  Prescribed prescribed = {};
  const double *V = prescribed.V, *limit = prescribed.limit;
  wall.motion.velocity(grid, plane.node, prescribed.V);

  struct {
    Image images[2];           // inside, image
    const double *in, *out;    // their records
    double mass;
  } pairs[MPMMirrorColumn::DEPTH];
  int npairs = 0;
  for (int j = 1; j <= MPMMirrorColumn::DEPTH; j++) {
    const int64_t inside = column.node[j], image = column.node[MPMMirrorColumn::DEPTH + j];
    if (inside < 0) continue;
    const double *in = grid.record(inside), *out = grid.record(image);
    if (in[3] <= 0.0 || out[3] <= 0.0) continue;
    const double mass = 2.0 * in[3] * out[3] / (in[3] + out[3]);
    pairs[npairs++] = {{{inside, 1}, {image, -1}}, in, out, mass};
  }

  if (npairs == 0 && !(r[3] > 0.0)) return;

  // impulse that would bring all components to the velocity of the wall
  double to_stick[3] = {0.0, 0.0, 0.0};
  for (int d = 0; d < dim; d++) {
    to_stick[d] = -r[3] * (r[d] - V[d]);
    for (int k = 0; k < npairs; k++)
      to_stick[d] -= pairs[k].mass * (pairs[k].in[d] + pairs[k].out[d] - 2.0 * V[d]);
  }

  // slip: the old normal velocity is constrained, too, which is no impulse
  if (wall.kind == MPMWall::SLIP && reaction.old_share() > 0.0) {
    prescribed.hold[a] = true;
    if (column.node[1] >= 0)
      limit_of_old(grid.record(column.node[1]), r[3], wall.motion.before, dim, prescribed.limit);
    to_stick[a] += reaction.old_share() * r[3] * wall.motion.old_relative(r, a, limit[a]);
    for (int k = 0; k < npairs; k++)
      to_stick[a] += reaction.old_share() * pairs[k].mass *
          (wall.motion.old_relative(pairs[k].in, a, limit[a]) +
           wall.motion.old_relative(pairs[k].out, a, limit[a]));
  }

  double needed = 0.0;
  for (int d = 0; d < dim; d++)
    if (d != a) needed += to_stick[d] * to_stick[d];
  double inward[3] = {0.0, 0.0, 0.0};
  inward[a] = face.inward;
  double slide;
  if (!contact.holds(field, column, column.node, MPMMirrorColumn::LENGTH, inward,
                     face.inward * to_stick[a], sqrt(needed), slide))
    return;
  for (int d = 0; d < dim; d++) prescribed.share[d] = d == a ? 1.0 : slide;
  if (r[3] > 0.0) project(reaction, &plane, 1, true, prescribed);
  for (int k = 0; k < npairs; k++) project(reaction, pairs[k].images, 2, false, prescribed);
  reaction.end_sliding();
}

void MPMMirrorNodes::act_on_group(MPMWallReaction &reaction, const Group &group)
{
  Grid &grid = field.grid;
  const int dim = grid.lattice.dim;
  const Image *const first = &images[group.first];
  const int n = group.last - group.first;
  if (!is_constrained(first, n, group.fixed)) return;
  Prescribed prescribed = {};
  wall.motion.velocity(grid, group.wall, prescribed.V);
  const bool hold = reaction.old_share() > 0.0;
  if (hold && group.inner >= 0) {
    double heaviest = 0.0;
    for (int k = 0; k < n; k++) heaviest = std::max(heaviest, grid.record(first[k].node)[3]);
    limit_of_old(grid.record(group.inner), heaviest, wall.motion.before, dim, prescribed.limit);
  }
  for (int d = 0; d < dim; d++) {
    prescribed.share[d] = group.prescribed[d] ? 1.0 : 0.0;
    prescribed.hold[d] = hold && group.prescribed[d];
  }
  project(reaction, first, n, group.fixed, prescribed);
}

void MPMMirrorNodes::act_on_line(MPMWallContact &contact, const MPMBoxFace &face, MPMFaceLine &line,
                                 bool last)
{
  MPMWallReaction &reaction = contact.reaction;
  const int dim = field.lattice.dim, a = face.axis;
  const bool hold = reaction.old_share() > 0.0 &&
      (wall.kind == MPMWall::STICK || (wall.kind == MPMWall::SLIP && !last));
  if (last && wall.kind != MPMWall::STICK && line.state == MPMContactState::OPEN) return;

  MPMLineConstraint constraint;
  if (!constraint.find(wall, field, line, face.inward)) return;
  const int m = constraint.n;
  const double *const *const r = constraint.record;
  const auto &V = constraint.V;
  const double total = constraint.total;

  // components that stick prescribes in this pass
  const auto prescribed = [&](int d) {
    return wall.velocity[d].given && (d == a) == last;
  };
  double inward[3] = {0.0, 0.0, 0.0};
  inward[a] = face.inward;
  double lambda[3] = {0.0, 0.0, 0.0}, lambda_old[3] = {0.0, 0.0, 0.0};
  double change[3][4], change_old[3][4] = {};
  double relative[4];    // velocities of the nodes relative to the wall
  for (int d = 0; d < dim; d++) {
    for (int k = 0; k < m; k++) relative[k] = r[k][d] - V[k][d];
    lambda[d] = constraint.solve(relative, change[d]);
    if (!hold || !(wall.kind == MPMWall::STICK ? prescribed(d) : d == a)) continue;
    for (int k = 0; k < m; k++) relative[k] = r[k][4 + d] - wall.motion.before[d];
    const double limit = constraint.limit_of_old(relative);
    for (int k = 0; k < m; k++) relative[k] = wall.motion.old_relative(r[k], d, limit);
    lambda_old[d] = constraint.solve(relative, change_old[d]);
  }

  double share[3] = {0.0, 0.0, 0.0};
  if (wall.kind == MPMWall::STICK) {
    for (int d = 0; d < dim; d++) share[d] = prescribed(d) ? 1.0 : 0.0;
  } else if (last) {
    share[a] = 1.0;
  } else {
    const double push = face.inward * total * (lambda[a] - reaction.old_share() * lambda_old[a]);
    double needed = 0.0, slide;
    for (int d = 0; d < dim; d++)
      if (d != a) needed += lambda[d] * lambda[d];
    if (!contact.holds(field, line, constraint.node, m, inward, push, total * sqrt(needed), slide))
      return;
    for (int d = 0; d < dim; d++) share[d] = d == a ? 1.0 : slide;
  }

  for (int k = 0; k < m; k++) {
    double v[3], old[3];
    for (int d = 0; d < dim; d++) {
      v[d] = r[k][d] + share[d] * change[d][k];
      if (hold) old[d] = r[k][4 + d] + change_old[d][k];
    }
    reaction.set_velocity(constraint.node[k], V[k], v, hold ? old : nullptr);
  }
  reaction.end_sliding();
}

/** Images with a heavy node go to others, as most of the mass is in that node. */
void MPMMirrorNodes::list_ties(std::vector<int64_t> &ties, std::vector<int64_t> &others) const
{
  for (const auto &face : faces) {
    for (const auto &line : face.lines) {
      ties.push_back(line.n);
      ties.insert(ties.end(), line.node, line.node + line.n);
    }
    for (const auto &column : face.columns) {
      ties.push_back(MPMMirrorColumn::LENGTH);
      ties.insert(ties.end(), column.node, column.node + MPMMirrorColumn::LENGTH);
    }
  }
  for (const auto &group : groups) {
    double most = 0.0, sum = 0.0;
    for (int k = group.first; k < group.last; k++) {
      const double mass = field.grid.record(images[k].node)[3];
      most = std::max(most, mass);
      sum += mass;
    }
    auto &to = group.fixed || most > HEAVY * sum ? others : ties;
    to.push_back(group.last - group.first);
    for (int k = group.first; k < group.last; k++) to.push_back(images[k].node);
  }
}

/** A node outside of a mirror is held if its image inside is. */
void MPMMirrorNodes::mark_prescribed(std::vector<char> &held) const
{
  const auto outside = [&](int64_t node) {
    int index[3];
    field.grid.node_index(node, index);
    return std::any_of(faces.begin(), faces.end(), [&](const MPMBoxFace &face) {
      return !face.cut && (index[face.axis] - face.plane) * face.inward < 0;
    });
  };
  for (const auto &group : groups)
    for (int k = group.first; k < group.last; k++) {
      const int64_t node = images[k].node;
      if (!group.fixed && !outside(node)) continue;
      for (int d = 0; d < field.lattice.dim; d++)
        if (group.prescribed[d]) held[node] |= (group.fixed ? 1 : 8) << d;
    }
}

void MPMMirrorNodes::predict(const std::vector<char> &near, MPMPredictedVelocities &to) const
{
  const Grid &grid = field.grid;
  const int dim = field.lattice.dim;
  const auto is_near = [&](const Image &image) {
    return near[image.node / NODES_PER_BLOCK] != 0;
  };
  for (const auto &group : groups) {
    const Image *const first = &images[group.first], *const last = first + group.last - group.first;
    if (group.fixed) {
      for (const Image *image = first; image < last; image++) {
        if (!is_near(*image)) continue;
        double V[3];
        wall.motion.velocity(grid, image->node, V);
        for (int d = 0; d < dim; d++)
          if (group.prescribed[d]) to.held[3 * image->node + d] = V[d];
      }
      continue;
    }
    if (std::none_of(first, last, is_near)) continue;
    MPMPredictedVelocities::Mirror mirror = {};
    wall.motion.velocity(grid, group.wall, mirror.wall);
    for (const Image *image = first; image < last; image++) {
      const double *const r = field.grid.record(image->node);
      mirror.mass += r[3];
      for (int d = 0; d < dim; d++) mirror.odd[d] += image->sign * r[3] * (r[d] - mirror.wall[d]);
    }
    if (!(mirror.mass > 0.0)) continue;
    for (int d = 0; d < dim; d++) mirror.odd[d] /= mirror.mass;
    to.mirrors.push_back(mirror);
    const int place = (int) to.mirrors.size();
    for (const Image *image = first; image < last; image++)
      for (int d = 0; d < dim; d++)
        if (group.prescribed[d]) to.mirrored[3 * image->node + d] = image->sign * place;
  }
}

double MPMMirrorNodes::memory_usage() const
{
  double bytes = images.capacity() * sizeof(Image) + groups.capacity() * sizeof(Group);
  for (const auto &face : faces)
    bytes += face.lines.capacity() * sizeof(MPMFaceLine) +
        face.columns.capacity() * sizeof(MPMMirrorColumn);
  return bytes;
}

void MPMPredictedVelocities::reset(int64_t nnodes)
{
  held.assign(3 * nnodes, 0.0);
  mirrored.assign(3 * nnodes, 0);
  mirrors.clear();
}

MPMBoxFace::MPMBoxFace(const MPMField &field, const Domain &box, int face) :
    axis(face / 2), inward(face % 2 ? -1 : 1)
{
  const double x = position(box);
  const double h = field.lattice.h, origin = field.lattice.origin[axis];
  plane = (int) std::lround((x - origin) / h);
  const double plane_x = origin + plane * h;
  cut = std::fabs(x - plane_x) > MPMWall::ON_SURFACE * h;
  if (cut) nweight = MPMLineConstraint::weights_at(field, axis, inward, x, first, weight);
  contact = contact_of(field, x);
}

double MPMBoxFace::position(const Domain &box) const
{
  return inward > 0 ? box.boxlo[axis] : box.boxhi[axis];
}

MPMDistanceFrom MPMBoxFace::distance(const Domain &box) const
{
  return [a = axis, sign = inward, place = position(box)](const double *x, double) {
    return sign * (x[a] - place);
  };
}

MPMContactDistance MPMBoxFace::contact_of(const MPMField &field, double x) const
{
  if (!cut) {
    const bool folded = field.options.modified_edges;    // see MPMEdges::fold()
    const double at[2] = {0.0, -1.0}, weights[2] = {1.0, 2.0};
    return {field, at, weights, folded ? 2 : 1};
  }
  double at[4];
  const double face = (x - field.lattice.origin[axis]) / field.lattice.h;
  for (int k = 0; k < nweight; k++) at[k] = inward * (first + k - face);
  return {field, at, weight, nweight};
}

void MPMBoxFace::add_line(const MPMField &field, const int *index)
{
  const auto at = [&](int along) {
    int k[3] = {index[0], index[1], index[2]};
    k[axis] = along;
    return field.grid.locate(k);
  };
  if (cut) {
    MPMFaceLine line;
    line.axis = axis;
    line.n = nweight;
    std::copy_n(weight, nweight, line.weight);
    for (int j = 0; j < nweight; j++) line.node[j] = at(first + j);
    if (line.is_complete()) lines.push_back(line);    // else out of reach of points, as is the face
    return;
  }
  MPMMirrorColumn column;
  column.node[0] = at(plane);
  for (int j = 1; j <= MPMMirrorColumn::DEPTH; j++) {
    int64_t &inside = column.node[j], &image = column.node[MPMMirrorColumn::DEPTH + j];
    inside = at(plane + inward * j);
    image = at(plane - inward * j);
    if (inside < 0 || image < 0) inside = image = -1;    // both out of reach of points
  }
  columns.push_back(column);
}
