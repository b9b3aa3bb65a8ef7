/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/mpm_wall_nodes.h"

#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "math_extra.h"
#include "math_special.h"
#include "region.h"
#include "walls/mpm_wall.h"
#include "walls/mpm_wall_reaction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

using MathSpecial::cube;

// node spacings, see list_region() and hold_at_edges()
static constexpr double HAND_OVER = 0.5, LET_GO = 1.0;

MPMWallNodes::MPMWallNodes(MPMWall &wall, MPMField &field, const Domain &box) :
    field(field), mirrors(wall, field, box), crossings(wall, field), wall(wall)
{
}

void MPMWallNodes::topology_changed()
{
  nodes.clear();
  crossings.clear();
  approaches.clear();
  mirrors.find_faces();
  if (!wall.region)
    mirrors.list(nodes);
  else if (!wall.region_moves())
    list_region();
}

/** Blocks in which nodes can be held. Around a moving region that is away from the body there is
 *  nothing to hold. */
std::vector<char> MPMWallNodes::blocks_to_look_at() const
{
  Grid &grid = field.grid;
  const std::size_t nblocks = grid.blocks.size();
  std::vector<char> looks_at(nblocks, 1);
  if (!wall.region_moves() || !wall.holds_surface()) return looks_at;
  std::vector<char> massive(nblocks);
  for (std::size_t ib = 0; ib < nblocks; ib++) {
    const double *record = grid.record((int64_t) ib * NODES_PER_BLOCK);
    double mass = 0.0;
    for (int n = 0; n < NODES_PER_BLOCK; n++, record += grid.nreal) mass += record[3];
    massive[ib] = mass > 0.0;
  }
  for (std::size_t ib = 0; ib < nblocks; ib++) {
    const int *const around = grid.blocks[ib].slot;
    looks_at[ib] = std::any_of(around, around + 27, [&](int block) {
      return block >= 0 && massive[block];
    });
  }
  return looks_at;
}

/** Nodes inside the region or on its surface, for the state of the region that it has now. When the
 *  surface moves across a plane of nodes, these are taken and let go over half a node spacing
 *  outside: a node goes (1 - s^3)^3 of the way to the velocity of the wall in each step, s = 1 at
 *  the end. At once, there would be waves as high as the force itself (DECISIONS.md). Implicit
 *  steps have no hand-over (moves_and_holds), as a part of the way is no projection: lines hold the
 *  material in front, and in a grip single nodes up to half a spacing outside act, fully. */
void MPMWallNodes::list_region()
{
  Grid &grid = field.grid;
  const int dim = field.lattice.dim;
  const double h = field.lattice.h;
  const bool moves = wall.region_moves(), hands_over = moves && wall.kind != MPMWall::SEPARATE,
             across = wall.acts_across();
  const double taken = (hands_over ? HAND_OVER : MPMWall::ON_SURFACE) * h;
  const double far = MPMWall::FAR * h, next = across ? 1.001 * h : taken;
  Region *const region = wall.region;
  const auto &surface = wall.surface;
  const bool box_known = region->bboxflag && !moves;
  const double lo[3] = {region->extent_xlo, region->extent_ylo, region->extent_zlo};
  const double hi[3] = {region->extent_xhi, region->extent_yhi, region->extent_zhi};
  const double radius = 0.5 * (grid.side - 1) * h * sqrt((double) dim);
  const double beyond = across ? h : MPMWall::ON_SURFACE * h;
  std::vector<MPMWallNode> outside;    // next to the surface
  std::array<double, 16> groups;
  const double near_enough = 0.51 * std::sqrt((double) dim) * h + std::max(next, taken);

  nodes.clear();
  if (!moves) region->prematch();
  const std::vector<char> looks_at = blocks_to_look_at();
  for (std::size_t ib = 0; ib < grid.blocks.size(); ib++) {
    if (!looks_at[ib]) continue;
    const int64_t first_node = (int64_t) ib * NODES_PER_BLOCK;
    double first[3], last[3], mid[3];
    grid.node_position(first_node, first);
    grid.node_position(first_node + NODES_PER_BLOCK - 1, last);
    bool near = true;
    for (int d = 0; d < 3; d++) {
      mid[d] = 0.5 * (first[d] + last[d]);
      if (box_known && (last[d] < lo[d] - beyond || first[d] > hi[d] + beyond)) near = false;
    }
    double middle = 0.0;
    if (near && region->nregion == 1) {
      middle = surface->distance(mid, far);
      near = middle <= radius + h || middle >= far;
    }
    if (!near) continue;
    const bool deep = middle < -(radius + next) && middle > -far;
    std::fill(groups.begin(), groups.end(), std::numeric_limits<double>::quiet_NaN());

    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (grid.blocks[ib].alias >> n & 1) continue;
      // in a step, masses are known; no line goes through a node deep inside
      const bool idle = moves && !(grid.record(first_node + n)[3] > 0.0);
      if (idle && (deep || !across)) continue;
      double x[3];
      grid.node_position(first_node + n, x);
      // the middle of two nodes along each axis tells of nodes in front, which are not needed
      if (region->nregion == 1) {
        int group = 0, side = 1;
        double center[3] = {0.0, 0.0, 0.0};
        for (int d = 0; d < dim; d++, side *= grid.side / 2) {
          const int k = (int) std::lround((x[d] - first[d]) / h) / 2;
          group += side * k;
          center[d] = first[d] + (2 * k + 0.5) * h;
        }
        double &ahead = groups[group];
        if (std::isnan(ahead)) ahead = surface->distance(center, near_enough);
        if (ahead >= near_enough) continue;
      }
      MPMWallNode s = {first_node + n};
      const double gap = surface->distance(x, next);
      if (idle && gap <= -next) continue;
      if (gap >= MPMWall::ON_SURFACE * h) {    // or beyond the cutoff
        if (across && gap < next) {
          s.distance = gap;
          outside.push_back(s);
        }
        if (gap >= taken) continue;
        if (!wall.moves_and_holds) s.share = cube(1.0 - cube(gap / taken));
      }
      const bool at_surface = gap > -next;
      if (wall.kind != MPMWall::STICK ||
          (!wall.moves_and_holds && (region->varshape || at_surface)))
        wall.normal(field, x, s.normal);
      if (region->varshape || across) s.distance = at_surface ? gap : surface->distance(x, far);
      nodes.push_back(s);
    }
  }
  if (!across) return;
  crossings.list(nodes, outside);
  if ((!hands_over || wall.moves_and_holds) && !wall.holds_surface()) crossings.take_nodes(nodes);
}

void MPMWallNodes::follow_region(double dt)
{
  if (wall.region->varshape) {
    const double far = MPMWall::FAR * field.lattice.h;
    for (auto &node : nodes) {
      double x[3], v[3];
      field.grid.node_position(node.node, x);
      const double distance = wall.surface->distance(x, far);
      node.growth = 0.0;
      if (std::max(std::fabs(distance), std::fabs(node.distance)) >= far) continue;

      // the normal speed of the surface replaces that of the rigid motion
      wall.motion.velocity(field.grid, node.node, v);
      node.growth = (node.distance - distance) / dt - MathExtra::dot3(v, node.normal);
    }
  }
  const bool hands_over =
      wall.kind == MPMWall::SLIP && !wall.moves_and_holds && !wall.holds_surface();
  if (hands_over && wall.acts_across()) crossings.take_nodes(nodes);
  if (wall.acts_across() && wall.holds_surface()) hold_at_edges();
}

/** Looks along u, the direction of the motion or the opposite one, for a face near a node that is
 *  inside and nearest to another face. Its normal is that half a spacing from the edge between
 *  them. */
bool MPMWallNodes::find_face_ahead(const MPMWallNode &node, const double *u,
                                   MPMWallNode &held) const
{
  constexpr double SAME = 0.9;    // cosine between normals
  const double h = field.lattice.h, *const n = node.normal, far = (LET_GO + HAND_OVER) * h,
               deep = 0.5 * h + std::max(0.0, node.distance);
  double x[3], at[3];
  field.grid.node_position(node.node, x);
  const auto is_inside = [&](double way) {
    for (int d = 0; d < 3; d++) at[d] = x[d] - deep * n[d] + way * u[d];
    return wall.surface->has(at);
  };
  double inside = 0.0, outside = far;
  if (is_inside(outside) || !is_inside(inside)) return false;
  while (outside - inside > MPMWall::ON_SURFACE * h) {
    const double middle = 0.5 * (inside + outside);
    (is_inside(middle) ? inside : outside) = middle;
  }
  is_inside(inside);
  held = node;
  wall.normal(field, at, held.normal);
  double depth = 0.0;
  for (int d = 0; d < 3; d++) depth += (at[d] - x[d]) * held.normal[d];
  if (depth < 0.0 || depth >= far || MathExtra::dot3(held.normal, n) > SAME) return false;
  held.share = cube(1.0 - cube(std::max(0.0, depth / h - LET_GO) / HAND_OVER));
  held.at_edge = true;
  return true;
}

/** When an edge of a region has gone past a node, the node is nearest to a face along which the
 *  region moves. The face that pushes the material would hold it no longer with slip: at once, and
 *  long before the next plane of nodes is taken (DECISIONS.md). It holds the node to a depth of one
 *  spacing, and lets it go over half a spacing. With stick, lines through both faces would share
 *  nodes: those through the side leave them to the nodes inside. */
void MPMWallNodes::hold_at_edges()
{
  constexpr double ALONG = 0.1;    // cosine between motion and normal
  const double h = field.lattice.h;
  const auto shift = MPMRegionMotion::of(wall.region);    // a tool that stops holds what it held
  const auto at_edge = [&](const MPMWallNode &node, const auto &use) {
    double u[3];
    wall.motion.velocity(field.grid, node.node, u);
    if (MathExtra::len3(u) == 0.0)
      for (int d = 0; d < 3; d++) u[d] = *shift[d];
    const double speed = MathExtra::len3(u);
    if (speed == 0.0 || std::fabs(MathExtra::dot3(u, node.normal)) > ALONG * speed) return;
    MPMWallNode held;
    for (const double sign : {1.0, -1.0}) {
      const double along[3] = {sign * u[0] / speed, sign * u[1] / speed, sign * u[2] / speed};
      if (find_face_ahead(node, along, held)) use(held);
    }
  };
  if (wall.kind == MPMWall::SLIP) {
    const std::vector<MPMWallNode> inside = nodes;
    for (const auto &node : inside)
      if (node.share == 1.0 && node.distance >= -h)
        at_edge(node, [&](const MPMWallNode &held) {
          nodes.push_back(held);
        });
    return;
  }
  for (auto &line : crossings.lines) {
    MPMWallNode base = {line.base};
    double x[3];
    field.grid.node_position(line.base, x);
    std::copy_n(line.normal, 3, base.normal);
    base.distance = wall.surface->distance(x, MPMWall::FAR * h);
    at_edge(base, [&](const MPMWallNode &) {
      line.at_edge = true;
    });
  }
}

void LAMMPS_NS::update_motion(MPMWall &wall, std::vector<MPMWallNodes> &fields, double dt)
{
  if (!wall.begin_motion()) return;
  const bool moves = wall.region_moves();
  if (moves)
    for (auto &list : fields) list.list_region();
  wall.find_motion(dt);
  if (moves)
    for (auto &list : fields) list.follow_region(dt);
}

std::size_t MPMWallNodes::first_crossing() const
{
  std::size_t n = 0;
  for (const auto &face : mirrors.faces) n += face.size();
  return n;
}

void MPMWallNodes::act(MPMWallContact &contact)
{
  mirrors.act(contact);
  crossings.act(contact, first_crossing());
  auto &held = crossings.held_nodes;
  if (contact.constraints && wall.moves_and_holds)
    for (std::size_t k = 0; k < approaches.size(); k++) {
      const auto &line = approaches[k];
      if ((*contact.constraints)[first_approach() + k].active)
        held.insert(held.end(), line.node, line.node + line.n);
    }
  std::sort(held.begin(), held.end());
  for (std::size_t k = 0; k < nodes.size(); k++) {
    if (!nodes[k].at_edge && !held.empty() &&
        std::binary_search(held.begin(), held.end(), nodes[k].node))
      continue;
    contact.use_constraint(first_node() + k);
    contact.unit = field.grid.record(nodes[k].node)[3];
    act_on_node(contact, nodes[k]);
  }
  contact.constraint = nullptr;
  contact.unit = 1.0;
}

void MPMWallNodes::act_on_node(MPMWallContact &contact, MPMWallNode &node)
{
  MPMWallReaction &reaction = contact.reaction;
  const int dim = field.lattice.dim;
  const double *r = field.grid.record(node.node), *n = node.normal;
  if (r[3] <= 0.0) return;

  double V[3], v[3];
  wall.motion.velocity(field.grid, node.node, V);
  for (int d = 0; d < dim; d++) V[d] += node.growth * n[d];

  if (wall.kind == MPMWall::STICK || (n[0] == 0.0 && n[1] == 0.0 && n[2] == 0.0)) {
    for (int d = 0; d < dim; d++) v[d] = wall.velocity[d].given ? V[d] : r[d];
  } else {
    double normal = 0.0;    // speed of the node away from the wall
    for (int d = 0; d < dim; d++) normal += (r[d] - V[d]) * n[d];
    double slide[3], length = 0.0;
    for (int d = 0; d < dim; d++) {
      slide[d] = r[d] - V[d] - normal * n[d];
      length += slide[d] * slide[d];
    }
    double share;
    if (!contact.holds(field, node, &node.node, 1, n, -normal, sqrt(length), share, r[3])) return;
    const double keep = 1.0 - share;
    for (int d = 0; d < dim; d++) v[d] = V[d] + keep * slide[d];
  }
  const double whole[3] = {v[0], v[1], v[2]};
  for (int d = 0; d < dim && node.share < 1.0; d++) v[d] = r[d] + node.share * (v[d] - r[d]);
  reaction.set_velocity(node.node, V, v, nullptr, whole);
  reaction.end_sliding();
}

void MPMWallNodes::find_water(MPMWallContact &contact, double dt) const
{
  contact.clear_water();
  if (!pore_pressure(field)) return;
  std::vector<char> near(field.grid.blocks.size(), 0);
  mirrors.mark_blocks(near);
  crossings.mark_blocks(near);
  for (const auto &node : nodes) near[node.node / NODES_PER_BLOCK] = 1;
  contact.find_water(field, near, dt);
}

void MPMWallNodes::list_ties(std::vector<int64_t> &ties, std::vector<int64_t> &others) const
{
  crossings.list_ties(ties);
  for (const auto &line : approaches) {
    ties.push_back(line.n);
    ties.insert(ties.end(), line.node, line.node + line.n);
  }
  mirrors.list_ties(ties, others);
}

/** Calls use(node, d) for the components that the wall prescribes, except at mirrors. */
template <class Use> void MPMWallNodes::visit_prescribed(const Use &use) const
{
  const int dim = field.lattice.dim;
  for (const auto &node : nodes)
    for (int d = 0; d < dim; d++)
      if (wall.prescribes(node.normal, d)) use(node.node, d);
  for (const auto &line : crossings.lines)
    for (int k = 0; k < line.inside; k++)
      for (int d = 0; d < dim && line.node[k] >= 0; d++)
        if (wall.prescribes(line.normal, d)) use(line.node[k], d);
}

void MPMWallNodes::mark_prescribed(std::vector<char> &held) const
{
  mirrors.mark_prescribed(held);
  visit_prescribed([&](int64_t node, int d) {
    held[node] |= 1 << d;
  });
}

void MPMWallNodes::predict(const std::vector<char> &near, MPMPredictedVelocities &to) const
{
  mirrors.predict(near, to);
  visit_prescribed([&](int64_t node, int d) {
    if (!near[node / NODES_PER_BLOCK]) return;
    double V[3];
    wall.motion.velocity(field.grid, node, V);
    to.held[3 * node + d] = V[d];
  });
}

double MPMWallNodes::memory_usage() const
{
  return mirrors.memory_usage() + nodes.capacity() * sizeof(MPMWallNode) +
      crossings.lines.capacity() * sizeof(MPMCrossing) +
      approaches.capacity() * sizeof(MPMApproach);
}

/* Blocks of nodes next to those that points reach. Lines of nodes through the surface of a region
 *  can have nodes that only points of another rank reach. A moving region needs different blocks
 *  all the time: they are made around its place at that time, a bit wider, and made anew when it
 *  has moved by that margin. */

static constexpr double WIDER = 2.0;    // node spacings, around a region that moves

void MPMWallNodes::extend_topology()
{
  mirrors.find_faces();
  const bool several_ranks = wall.has_several_ranks();
  if (several_ranks && (wall.looks_ahead || wall.moves_and_holds)) extend_to_approaches();
  if (!wall.region)
    mirrors.extend_topology();
  else if (several_ranks)
    crossings.extend_topology();
}

bool MPMWallNodes::needs(const Grid::Block &block) const
{
  return wall.region || mirrors.needs(block, wall.looks_ahead ? SOUGHT : 0);
}

bool MPMCrossingLines::needs_topology() const
{
  return !blocks_known || !(wall.way_since(blocks_at) <= WIDER * field.lattice.h);
}

/** Lines along several axes share nodes, so blocks all around are needed. */
void MPMCrossingLines::extend_topology()
{
  if (!wall.acts_across()) return;
  const bool moves = wall.region_moves(), known = wall.knows_place();
  Grid &grid = field.grid;
  const int dim = field.lattice.dim;
  const double h = field.lattice.h,
               reach = (0.5 * grid.side * sqrt((double) dim) + 4.0 + (moves ? WIDER : 0.0)) * h;
  if (!moves) wall.region->prematch();
  if (moves && known) {
    wall.restore_region();
    std::copy_n(wall.state.region, 4, blocks_at);
    blocks_known = true;
  }
  const auto is_near = [&](const int *b) {
    if (!known) return true;
    const int first[3] = {b[0] * grid.side, b[1] * grid.side, b[2] * grid.side};
    double middle[3];
    field.lattice.node_position(first, middle);
    for (int d = 0; d < dim; d++) middle[d] += 0.5 * (grid.side - 1) * h;
    return fabs(wall.surface->distance(middle, MPMWall::FAR * h)) <= reach;
  };
  const auto nblocks = (int) grid.blocks.size();
  for (int ib = 0; ib < nblocks; ib++) {
    const int b[3] = {grid.blocks[ib].b[0], grid.blocks[ib].b[1], grid.blocks[ib].b[2]};
    if (!is_near(b)) continue;
    const int rings = wall.holds_surface() ? 2 : 1,
              flat = dim == 3 ? rings : 0;    // see MPMCoupledLines
    for (int k = -flat; k <= flat; k++)
      for (int j = -rings; j <= rings; j++)
        for (int i = -rings; i <= rings; i++) {
          const int next[3] = {b[0] + i, b[1] + j, b[2] + k};
          if (is_near(next)) grid.activate(next);
        }
  }
}

/** Ranks that have a node of a line need all nodes between it and the wall, and the next ones
 *  behind it. */
void MPMWallNodes::extend_to_approaches()
{
  Region *const region = wall.region;
  Grid &grid = field.grid;
  const int dim = field.lattice.dim, nblocks = (int) grid.blocks.size(),
            reach = (SOUGHT + grid.side - 1) / grid.side;
  const double h = field.lattice.h;
  const bool known = region && !wall.region_moves() && region->nregion == 1;
  if (known) region->prematch();
  for (int ib = 0; ib < nblocks; ib++) {
    const int b[3] = {grid.blocks[ib].b[0], grid.blocks[ib].b[1], grid.blocks[ib].b[2]};
    for (const auto &face : mirrors.faces)
      for (int k = -reach; k <= reach; k++) {
        int next[3] = {b[0], b[1], b[2]};
        next[face.axis] += k;
        const auto away = [&](int block) {
          const int first = block * grid.side - face.plane;
          return face.inward > 0 ? first : -first - grid.side + 1;    // of the nearest node
        };
        if (away(b[face.axis]) <= SOUGHT && away(next[face.axis]) <= SOUGHT &&
            away(next[face.axis]) > -2 * grid.side)
          grid.activate(next);
      }
    if (!region) continue;
    double middle[3];
    const int first[3] = {b[0] * grid.side, b[1] * grid.side, b[2] * grid.side};
    field.lattice.node_position(first, middle);
    for (int d = 0; d < dim; d++) middle[d] += 0.5 * (grid.side - 1) * h;
    if (known &&
        std::fabs(wall.surface->distance(middle, MPMWall::FAR * h)) >
            (0.5 * grid.side * std::sqrt((double) dim) + SOUGHT) * h)
      continue;
    const int width = 2 * reach + 1;
    for (int k = 0; k < (dim == 3 ? width * width * width : width * width); k++) {
      const int next[3] = {b[0] + k % width - reach, b[1] + k / width % width - reach,
                           dim == 3 ? b[2] + k / (width * width) - reach : b[2]};
      grid.activate(next);
    }
  }
}
