/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/mpm_crossing_lines.h"

#include "field/mpm_field.h"
#include "math_extra.h"
#include "region.h"
#include "walls/mpm_line_constraint.h"
#include "walls/mpm_wall.h"
#include "walls/mpm_wall_reaction.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double SMOOTH = 0.9;         // least cosine between normals of a smooth surface
static constexpr double ALONG = 1.0e-3;       // sine of the angle of a motion along the surface
static constexpr double EQUAL = 1.0e-6;       // difference of equal components of normals
static constexpr double STRAIGHT = 0.9999;    // cosine between a line and the normal, for grips
// node spacings: material on one side is not felt on the other
static constexpr double FELT_THROUGH = 3.0;

void MPMCrossingLines::clear()
{
  lines.clear();
  coupled.clear();
  at_blades.clear();
  by_depth.clear();
  crossed.clear();
  crossed_known.clear();
}

/** Lines of nodes through the surface of a region that separates, along the axis that is nearest to
 *  the normal. Nodes inside that are on such a line do not act on their own.
 *
 *  Next to edges, and where the region is thin, nodes of a line may be nearer to another face, or
 *  beyond it. There, whether a line acts depends on where the material is, see is_in_front(). Such
 *  lines are found from the nodes outside, which are nearest to the face that they look at. */
void MPMCrossingLines::list(const std::vector<MPMWallNode> &nodes,
                            const std::vector<MPMWallNode> &outside)
{
  lines.clear();
  coupled.clear();
  at_blades.clear();
  const double h = field.lattice.h;
  std::vector<int64_t> ahead;
  for (const auto &node : nodes) {
    if (!(node.distance <= MPMWall::ON_SURFACE * h && node.distance >= -h)) continue;
    MPMCrossing c = {};
    if (!find(node, c)) continue;
    if (wall.moves_and_holds) c.front = MPMCrossing::NEAR_OTHERS;
    if (c.inside < c.n) ahead.push_back(c.node[c.inside]);
    lines.push_back(c);
  }
  std::sort(ahead.begin(), ahead.end());
  for (MPMWallNode node : outside) {
    if (std::binary_search(ahead.begin(), ahead.end(), node.node)) continue;
    double x[3];
    field.grid.node_position(node.node, x);
    wall.normal(field, x, node.normal);
    MPMCrossing c = {};
    if (find(node, c)) lines.push_back(c);
    if (wall.looks_for_thin_places && find_blade(node, c)) at_blades.push_back(c);
  }

  // lines along one axis share no nodes; lines along two axes do, and so do lines through both
  // faces of a thin plate: the same order on all ranks
  std::stable_sort(lines.begin(), lines.end(), [](const MPMCrossing &a, const MPMCrossing &b) {
    if (a.front != b.front || a.axis != b.axis || a.front == MPMCrossing::SOUND)
      return std::tie(a.front, a.axis) < std::tie(b.front, b.axis);
    const bool up[2] = {a.normal[a.axis] > 0.0, b.normal[b.axis] > 0.0};
    return std::tie(up[0], a.place) < std::tie(up[1], b.place);
  });
  if (wall.moves_and_holds && wall.kind == MPMWall::STICK) leave_alone();
  if (wall.holds_surface()) coupled = MPMCoupledLines::find(lines, wall.kind == MPMWall::STICK);
}

/** Nodes that are on lines do not act on their own. With slip and friction, a surface that moves
 *  across the lattice hands nodes over, see MPMWallNodes. Lines cannot do this, and there are none
 *  in that case. */
void MPMCrossingLines::take_nodes(std::vector<MPMWallNode> &nodes)
{
  const bool hands_over =
      wall.region_moves() && wall.kind == MPMWall::SLIP && !wall.moves_and_holds;
  if (hands_over)
    lines.erase(std::remove_if(lines.begin(), lines.end(),
                               [&](const MPMCrossing &c) {
                                 double x[3], v[3];
                                 field.grid.node_position(c.base, x);
                                 x[c.axis] = c.surface;
                                 wall.motion.velocity(x, v);
                                 return fabs(MathExtra::dot3(v, c.normal)) >
                                     ALONG * MathExtra::len3(v);
                               }),
                lines.end());
  std::vector<int64_t> on_lines;
  for (const auto &c : lines)
    if (c.front != MPMCrossing::NEAR_OTHERS)
      on_lines.insert(on_lines.end(), c.node, c.node + (hands_over ? c.n : c.inside));
  std::sort(on_lines.begin(), on_lines.end());
  nodes.erase(std::remove_if(nodes.begin(), nodes.end(),
                             [&](const MPMWallNode &node) {
                               return std::binary_search(on_lines.begin(), on_lines.end(),
                                                         node.node);
                             }),
              nodes.end());
}

/** Where does the line along an axis through this node cross the surface? x: position of the node;
 *  way: from there to the surface. False if the normal is not known, or the surface is not
 *  smooth. */
bool MPMCrossingLines::find_surface(const MPMWallNode &node, MPMCrossing &c, double *x,
                                    double &way) const
{
  const double h = field.lattice.h, far = MPMWall::FAR * h;
  const bool is_outside = node.distance > MPMWall::ON_SURFACE * h;
  int index[3];
  double at[3];
  field.grid.node_index(node.node, index);
  field.lattice.node_position(index, x);
  const double *const n = node.normal;
  for (int d = 1; d < field.lattice.dim; d++)    // round-off must not decide
    if (fabs(n[d]) > fabs(n[c.axis]) + EQUAL) c.axis = d;
  const int a = c.axis, outward = n[a] > 0.0 ? 1 : -1;
  const double slope = fabs(n[a]);
  if (slope < 0.5) return false;    // the normal is not known

  // where does the line cross the surface, and is this node the last one before it? On the surface
  // itself, round-off decides on the side, and some regions give no side: look a little outside
  const double outside = 1.0e-3 * h;
  way = -node.distance / slope + outside;
  double distance = 0.0;
  MathExtra::copy3(x, at);
  bool known = true;
  for (int round = 0; round < 2 && known; round++) {
    at[a] = x[a] + outward * way;
    distance = wall.surface->distance(at, far);
    known = fabs(distance) < far;
    way -= distance / slope - outside;
  }
  if (!known) return false;
  if (is_outside) {    // the line may miss an edge
    if (way - outside > -MPMWall::ON_SURFACE * h ||
        way - outside < -(1.0 + MPMWall::ON_SURFACE) * h)
      return false;
    at[a] = x[a] + outward * (way + 0.05 * h);    // an edge itself has no normal
    if (fabs(wall.surface->distance(at, far) - 0.05 * h * slope) > 0.02 * h) return false;
  }
  at[a] = x[a] + outward * way;
  way -= outside;
  if (way > (1.0 - MPMWall::ON_SURFACE) * h) return false;
  if (is_outside) at[a] += outward * 0.05 * h;
  wall.normal(field, at, c.normal);
  c.surface = x[a] + outward * (is_outside ? way : std::max(way, 0.0));
  return MathExtra::dot3(n, c.normal) > SMOOTH;
}

/** The line with this node as the last one inside or, if the node is outside, as the first one
 *  outside. False if there is none, or if it has nodes where the surface is not smooth. */
bool MPMCrossingLines::find(const MPMWallNode &from_node, MPMCrossing &c)
{
  double x[3], way;
  if (!find_surface(from_node, c, x, way)) return false;
  const Grid &grid = field.grid;
  const double h = field.lattice.h;
  const bool is_outside = from_node.distance > MPMWall::ON_SURFACE * h;
  const int a = c.axis, outward = from_node.normal[a] > 0.0 ? 1 : -1;
  int index[3];
  grid.node_index(from_node.node, index);
  const auto along = [&](const double *place) {
    double normal[3];
    wall.normal(field, place, normal);
    return MathExtra::dot3(normal, c.normal) > SMOOTH;
  };

  int first;
  double weight[4];
  c.n = MPMLineConstraint::weights_at(field, a, outward, c.surface, first, weight);
  const int last_inside = index[a] - (is_outside ? outward : 0);
  for (int k = 0; k < c.n; k++) {
    const int from = outward > 0 ? k : c.n - 1 - k;
    int node[3] = {index[0], index[1], index[2]};
    double place[3] = {x[0], x[1], x[2]};
    node[a] = first + from;
    place[a] = field.lattice.origin[a] + h * node[a];
    const int ahead = outward * (node[a] - last_inside);
    if (ahead > 0 && wall.surface->has(place)) return false;
    if (!is_outside && ahead < 0 && !(wall.surface->has(place) && along(place))) return false;
    const int at_place = node[a];
    node[a] = field.lattice.wrap(a, node[a]);
    // regions have no periodic images: this node would have material at the other end of the box
    if (ahead <= 0 && node[a] != at_place) return false;
    c.node[k] = grid.locate(node);
    c.weight[k] = weight[from];
    if (ahead <= 0) c.inside = k + 1;
  }
  int behind[3] = {index[0], index[1], index[2]};
  behind[a] = field.lattice.wrap(a, outward > 0 ? first - 1 : first + c.n);
  c.behind = grid.locate(behind);
  c.base = from_node.node;
  const double cosine = fabs(c.normal[a]);
  const double surface_at = outward * ((c.surface - field.lattice.origin[a]) / h);
  c.contact = contact_index(cosine, surface_at);
  c.place = outward > 0 ? first : -first - c.n + 1;
  c.depth = (surface_at - c.place) * cosine;

  // is there another face within reach of the material in front?
  if (is_outside) c.front = MPMCrossing::NEAR_OTHERS;
  const double surface_x = x[a] + outward * way;
  double at[3] = {x[0], x[1], x[2]};
  for (const double deep : {RESOLVED, 2.0, FELT_THROUGH}) {
    at[a] = surface_x - outward * deep * h;
    if (wall.surface->has(at)) continue;
    if (deep == RESOLVED) {
      at[a] = surface_x - outward * 0.05 * h;    // a line along the edge of the region is not in it
      const bool sound = wall.surface->has(at);
      at[a] = surface_x;
      c.in_plate = sound && is_plate(at, c.normal);
    }
    if (!is_outside) c.front = MPMCrossing::THIN_PLACE;
  }
  return true;
}

/** Directions along a surface with the normal n, as many as it returns: in 3d axes and
 *  diagonals. */
static int directions_along(const double *n, int dim, double t[4][3])
{
  if (dim == 2) {
    t[0][0] = -n[1];
    t[0][1] = n[0];
    t[0][2] = 0.0;
    return 1;
  }
  const double axis[3] = {fabs(n[0]) < 0.6 ? 1.0 : 0.0, fabs(n[0]) < 0.6 ? 0.0 : 1.0, 0.0};
  MathExtra::cross3(n, axis, t[0]);
  MathExtra::norm3(t[0]);
  MathExtra::cross3(n, t[0], t[1]);
  for (int d = 0; d < 3; d++) {
    t[2][d] = sqrt(0.5) * (t[0][d] + t[1][d]);
    t[3][d] = sqrt(0.5) * (t[0][d] - t[1][d]);
  }
  return 4;
}

/** Is the region thinner than nodes resolve below this place of its surface, and around it? Of the
 *  corner of a thick body a line along an axis sees the tip: the body is thick along the normal,
 *  or, if the corner is sharp, a little further from its tip. */
bool MPMCrossingLines::is_plate(const double *surface, const double *n) const
{
  constexpr double AROUND = 2.0;    // node spacings
  const double h = field.lattice.h;
  const auto has = [&](const double *from, double deep) {
    double at[3];
    for (int d = 0; d < 3; d++) at[d] = from[d] - deep * h * n[d];
    return wall.surface->has(at);
  };
  const auto is_thick = [&](const double *from) {
    return has(from, 0.05) && has(from, RESOLVED);
  };
  if (is_thick(surface)) return false;
  double t[4][3], at[3];
  const int ndirections = directions_along(n, field.lattice.dim, t);
  for (int k = 0; k < ndirections; k++)
    for (const double way : {-AROUND * h, AROUND * h}) {
      for (int d = 0; d < 3; d++) at[d] = surface[d] + way * t[k][d];
      if (is_thick(at)) return false;
    }
  return true;
}

/** Is the region behind this node, which is outside at x, narrower than nodes resolve, as at the
 *  edge of a blade? */
bool MPMCrossingLines::is_narrow(const MPMWallNode &node, const double *x) const
{
  const double h = field.lattice.h, *const n = node.normal;
  const int dim = field.lattice.dim;
  const auto match = [&](const double *x) {
    return wall.surface->has(x);
  };
  double middle[3];
  for (int d = 0; d < 3; d++) middle[d] = x[d] - (node.distance + RESOLVED * h) * n[d];
  bool narrow = false;
  if (match(middle)) {
    double t[4][3];
    const int ndirections = directions_along(n, dim, t);
    for (int k = 0; k < ndirections && !narrow; k++) {
      double side[2][3];
      for (int d = 0; d < 3; d++) {
        const double along = h * 0.5 * RESOLVED * t[k][d];
        side[0][d] = middle[d] + along;
        side[1][d] = middle[d] - along;
      }
      narrow = !match(side[0]) && !match(side[1]);
    }
  } else if (const Region &part = wall.surface->part_near(x, MPMWall::FAR * h); part.bboxflag) {
    const double size[3] = {part.extent_xhi - part.extent_xlo, part.extent_yhi - part.extent_ylo,
                            part.extent_zhi - part.extent_zlo};
    narrow = std::count_if(size, size + dim, [h](double extent) {
               return extent < RESOLVED * h;
             }) > 1;
  }
  return narrow;
}

/** Is this node outside, in front of the edge of a blade or of a wire? Then c is the line of nodes
 *  from it into the region. */
bool MPMCrossingLines::find_blade(const MPMWallNode &node, MPMCrossing &c) const
{
  const double h = field.lattice.h, *const n = node.normal;
  if (n[0] == 0.0 && n[1] == 0.0 && n[2] == 0.0) return false;
  double x[3];
  field.grid.node_position(node.node, x);
  if (!is_narrow(node, x)) return false;

  c = {};
  for (int d = 1; d < field.lattice.dim; d++)
    if (fabs(n[d]) > fabs(n[c.axis])) c.axis = d;
  int index[3];
  field.grid.node_index(node.node, index);
  c.base = node.node;
  c.n = 3;
  c.inside = 2;
  c.front = MPMCrossing::NEAR_OTHERS;
  MathExtra::copy3(n, c.normal);
  c.depth = 2.0 * fabs(n[c.axis]) - node.distance / h;
  for (int k = 2; k >= 0; k--) {
    c.node[k] = field.grid.locate(index);
    index[c.axis] = field.lattice.wrap(c.axis, index[c.axis] - (n[c.axis] > 0.0 ? 1 : -1));
  }
  return true;
}

/** Finds the lines that share no nodes with others; of the others, keeps those along the normal. */
void MPMCrossingLines::leave_alone()
{
  std::unordered_map<int64_t, int> uses;
  for (const auto &c : lines)
    for (int k = 0; k < c.n; k++)
      if (c.node[k] >= 0) uses[c.node[k]]++;
  for (auto &c : lines)
    c.alone = std::all_of(c.node, c.node + c.n, [&](int64_t node) {
      return node >= 0 && uses[node] == 1;
    });

  // on a curved surface, successive projections on lines that share nodes converge slowly if at
  // all: nodes are held one by one there
  lines.erase(std::remove_if(lines.begin(), lines.end(),
                             [](const MPMCrossing &c) {
                               return !c.alone && std::fabs(c.normal[c.axis]) < STRAIGHT;
                             }),
              lines.end());
}

/** Does the line act in this step? If so, the nodes inside do not act on their own, unless this is
 *  known from the start. */
bool MPMCrossingLines::decide(const MPMWallContact &contact, MPMCrossing &c)
{
  const bool to_surface = wall.holds_surface();
  if (c.at_edge) return false;
  if (c.front == MPMCrossing::SOUND && !to_surface) return true;
  if (!contact.decided) c.acts = holds(c);
  if (!c.acts) return false;
  if (c.front == MPMCrossing::NEAR_OTHERS || to_surface) {
    // nodes outside act, too, where a moving region hands them over
    const bool all = wall.moves_and_holds || (to_surface && wall.region_moves());
    held_nodes.insert(held_nodes.end(), c.node, c.node + (all ? c.n : c.inside));
  }
  return true;
}

/** Does the line act, and not the nodes inside, judged by the masses of nodes? */
bool MPMCrossingLines::holds(const MPMCrossing &c) const
{
  Grid &grid = field.grid;
  constexpr double AS_MUCH = 1.01;
  switch (c.front) {
    case MPMCrossing::SOUND:
      return !c.has_material_inside(grid);
    case MPMCrossing::THIN_PLACE:
      // nodes act in material that fills the plate
      return !c.is_behind(grid, wall.holds_surface() ? AS_MUCH : 1.0);
    default:
      return c.is_in_front(grid) || (wall.is_grip && c.goes_through(grid));
  }
}

void MPMCrossingLines::act(MPMWallContact &contact, std::size_t first)
{
  held_nodes.clear();
  for (std::size_t k = 0; k < lines.size(); k++) {
    contact.use_constraint(first + k);
    if (!lines[k].coupled) act_on_line(contact, lines[k]);
  }
  contact.constraint = nullptr;
  for (auto &group : coupled)
    group.act(contact.reaction, wall, field, lines, [&](MPMCrossing &line) {
      return decide(contact, line);
    });
}

/** Normal and tangential part of the impulse at the surface of a region, whose normal may be
 *  inclined to the line. */
void MPMCrossingLines::act_on_line(MPMWallContact &contact, MPMCrossing &line)
{
  MPMWallReaction &reaction = contact.reaction;
  const int dim = field.lattice.dim;
  const double *const n = line.normal;
  const bool to_surface = wall.holds_surface();
  if (!decide(contact, line)) return;
  MPMLineConstraint constraint;
  if (!constraint.find(wall, field, line, 1)) return;

  double lambda[3] = {0.0, 0.0, 0.0}, change[3][NodeLine::MOST], normal = 0.0,
         relative[NodeLine::MOST];
  for (int d = 0; d < dim; d++) {
    for (int k = 0; k < constraint.n; k++)
      relative[k] = constraint.record[k][d] - constraint.V[k][d];
    lambda[d] = constraint.solve(relative, change[d]);
    normal += lambda[d] * n[d];
  }

  const bool hold = reaction.old_share() > 0.0 && to_surface;
  double change_of_old[3][NodeLine::MOST] = {};
  if (hold) change_old(constraint, n, change_of_old);

  double needed = 0.0;
  for (int d = 0; d < dim; d++) {
    const double slide = lambda[d] - normal * n[d];
    needed += slide * slide;
  }
  double share;
  if (!contact.holds(field, line, constraint.node, constraint.n, n, constraint.total * normal,
                     constraint.total * sqrt(needed), share))
    return;
  for (int k = 0; k < constraint.n; k++) {
    double v[3], old[3], along = 0.0;
    for (int d = 0; d < dim; d++) along += change[d][k] * n[d];
    for (int d = 0; d < dim; d++) {
      v[d] = constraint.record[k][d] + along * n[d] + share * (change[d][k] - along * n[d]);
      if (wall.kind == MPMWall::STICK && !wall.velocity[d].given) v[d] = constraint.record[k][d];
      if (hold) old[d] = constraint.record[k][4 + d] + change_of_old[d][k];
    }
    reaction.set_velocity(constraint.node[k], constraint.V[k], v, hold ? old : nullptr);
  }
  reaction.end_sliding();
}

/** Changes of the components of old velocities that FLIP updates, as at faces: all that stick
 *  prescribes, or the normal ones. */
void MPMCrossingLines::change_old(const MPMLineConstraint &constraint, const double *n,
                                  double change[3][NodeLine::MOST]) const
{
  const int dim = field.lattice.dim;
  double relative[4], old[3][4] = {}, along[4] = {};
  for (int k = 0; k < constraint.n; k++)
    for (int d = 0; d < dim; d++) {
      old[d][k] = constraint.record[k][4 + d] - wall.motion.before[d];
      along[k] += n[d] * old[d][k];
    }
  const auto take_away = [&](const double *of, double *by) {
    const double limit = constraint.limit_of_old(of);
    for (int k = 0; k < constraint.n; k++) relative[k] = std::max(-limit, std::min(of[k], limit));
    constraint.solve(relative, by);
  };
  if (wall.kind == MPMWall::STICK) {
    for (int d = 0; d < dim; d++)
      if (wall.velocity[d].given) take_away(old[d], change[d]);
  } else {
    double by[4];
    take_away(along, by);
    for (int d = 0; d < dim; d++)
      for (int k = 0; k < constraint.n; k++) change[d][k] = by[k] * n[d];
  }
}

int MPMCrossingLines::contact_index(double slope, double place)
{
  constexpr int PLACES = 32, SLOPES = 32;
  if (crossed.empty()) {
    crossed.resize(PLACES * (SLOPES + 1));
    crossed_known.assign(crossed.size(), 0);
  }
  const double in_cell = place - std::floor(place);
  const int k = std::min((int) (PLACES * in_cell), PLACES - 1),
            j = (int) std::lround(SLOPES * slope);
  const int index = j * PLACES + k;
  if (crossed_known[index]) return index;
  crossed_known[index] = 1;
  int first;
  double weight[4], at[4];
  const double x = 16.0 + (k + 0.5) / PLACES;
  const int n = MPMLineConstraint::weights_at(
      field, 0, 1, field.lattice.origin[0] + field.lattice.h * x, first, weight);
  for (int node = 0; node < n; node++) at[node] = (first + node - x) * j / SLOPES;
  crossed[index] = {field, at, weight, n};
  return index;
}

const MPMContactDistance &MPMCrossingLines::contact_at_depth(double depth)
{
  constexpr int PER_CELL = 32;
  const auto k = (std::size_t) std::lround(std::max(0.0, depth) * PER_CELL);
  for (auto j = by_depth.size(); j <= k; j++) {
    const double at = -(double) j / PER_CELL, weight = 1.0;
    by_depth.emplace_back(field, &at, &weight, 1);
  }
  return by_depth[k];
}

void MPMCrossingLines::mark_blocks(std::vector<char> &blocks) const
{
  for (const auto &line : lines) line.mark_blocks(blocks);
}

void MPMCrossingLines::list_ties(std::vector<int64_t> &ties) const
{
  const auto add = [&](const std::vector<int64_t> &nodes) {
    ties.push_back((int64_t) nodes.size());
    ties.insert(ties.end(), nodes.begin(), nodes.end());
  };
  for (const auto &line : lines) add({line.node, line.node + line.n});
  for (const auto &group : coupled) add(group.nodes);
}

// Where a region is thin, a node can be nearer to another face than to the one that the material
// touches. The masses of the nodes on a line show where the material is.

static double mass(Grid &grid, int64_t node)
{
  return node < 0 ? 0.0 : grid.record(node)[3];
}

/** In front of a plane, a node at the distance x from the surface has the mass that its (quadratic)
 *  function has over x' > -x. If it has more than with a surface that is INTO deeper in the wall,
 *  then there is material at another face. INTO is enough for functions of other shapes. */
bool MPMCrossing::is_in_front(Grid &grid) const
{
  constexpr double INTO = 0.3, LITTLE = 1.0e-3;    // in node spacings; share of the mass
  const auto share = [](double x) {
    const double s = std::fabs(x), y = 1.5 - std::min(s, 1.5);
    const double less = s < 0.5 ? 0.5 - 0.75 * s + s * s * s / 3.0 : y * y * y / 6.0;
    return x < 0.0 ? less : 1.0 - less;
  };
  double full = 0.0;
  const double step = std::fabs(normal[axis]);
  for (int k = inside; k < n; k++)
    full = std::max(full, mass(grid, node[k]) / share(k * step - depth + INTO));
  for (int k = 0; k < inside; k++)
    if (mass(grid, node[k]) > full * (share(k * step - depth + INTO) + LITTLE)) return false;
  return full > 0.0;
}

bool MPMCrossing::is_behind(Grid &grid, double share) const
{
  double in_front = 0.0, in_region = 0.0;
  for (int k = 0; k < n; k++) {
    double &most = k < inside ? in_region : in_front;
    most = std::max(most, mass(grid, node[k]));
  }
  return in_front <= share * in_region;
}

/** At most the tails of functions across an inclined line bring the node behind the line mass of
 *  the material in front. */
bool MPMCrossing::has_material_inside(Grid &grid) const
{
  constexpr double MUCH = 0.1;
  const double there = mass(grid, behind);
  if (there <= 0.0) return false;
  double most = 0.0;
  for (int k = 0; k < n; k++) most = std::max(most, mass(grid, node[k]));
  return there > MUCH * most;
}

bool MPMCrossing::goes_through(Grid &grid) const
{
  return alone && std::all_of(node, node + n, [&](int64_t node) {
           return grid.record(node)[3] > 0.0;
         });
}
