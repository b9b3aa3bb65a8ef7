/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/mpm_wall_contact_search.h"

#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_stencil.h"
#include "math_extra.h"
#include "region.h"
#include "update.h"
#include "walls/mpm_line_constraint.h"
#include "walls/mpm_wall.h"
#include "walls/mpm_wall_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// Separating walls push where the surface of the material has reached them (mpm_wall_gap.cpp), and
// not as soon as nodes feel it. A disk that rolls toward nodes which hold it from a distance of 1.5
// h gets a normal force in front of its center, whose moment is larger than that of the friction:
// it does not spin.

// gap of walls that move and hold, in node spacings, from which on there is a warning; the true gap
// is about twice as large
static constexpr double NOT_TOUCHED = 0.07;
static constexpr double FILLED = 0.4;    // share of the volume in reach of the node in front
// depth in a region [node spacings] from which on it is taken for granted that material touches a
// node
static constexpr double NOT_INSIDE = 0.01;

MPMWallGap::Sums MPMWallContactSearch::sums(const NodeLine &line) const
{
  MPMWallGap::Sums all;
  for (int k = 0; k < line.n; k++)
    if (line.node[k] >= 0) all.add(line.weight[k], gap.at(line.node[k]));
  return all;
}

void MPMWallContactSearch::find_contacts(MPMWallNodes &list, double dt, double tolerance)
{
  if (wall.region) return find_region_contacts(list, dt, tolerance);
  MPMField &field = list.field;
  const double seen = 0.5 * (stencil_order(field.options.shape) + 1);    // reach of a node
  std::vector<char> near;
  for (auto &face : list.mirrors.faces) {
    near.assign(field.grid.blocks.size(), 0);
    for (const auto &line : face.lines) line.mark_blocks(near);
    for (const auto &column : face.columns)
      if (column.node[0] >= 0) near[column.node[0] / NODES_PER_BLOCK] = 1;
    gap.map(field, near, (face.cut ? 2.0 : 1.0) * seen, face.distance(*domain));
    for (auto &line : face.lines) line.touched = sums(line).touches(face.contact, tolerance);
    for (auto &column : face.columns)
      column.touched =
          column.node[0] >= 0 && gap.at(column.node[0]).touches(face.contact, tolerance);
  }
}

/** Maps mean distances of the material from the region to the nodes of lines and single nodes.
 *  Collective. */
void MPMWallContactSearch::map_region(MPMWallNodes &list, double dt)
{
  MPMField &field = list.field;
  // half width of a function: along the axis it is the reach from the surface to a node, and along
  // all axes the distance is at most sqrt(6) times as large
  const double seen = 0.5 * (stencil_order(field.options.shape) + 1);
  std::vector<char> near(field.grid.blocks.size(), 0);
  for (const auto &node : list.nodes) near[node.node / NODES_PER_BLOCK] = 1;
  list.crossings.mark_blocks(near);
  if (!wall.region_moves()) wall.region->prematch();
  gap.map(field, near, 2.45 * seen, wall.distance_from_region(dt));
}

/** Lines of a region that moves and holds act as soon as nodes on both sides of the surface see
 *  material, which can be half a node spacing in front. Notes the first such place for a warning.
 *  Collective. */
void MPMWallContactSearch::check_gaps(MPMWallNodes &list, double dt)
{
  if (first_gap.is_reported()) return;
  map_region(list, dt);
  Grid &grid = list.field.grid;
  const auto now = (double) update->ntimestep;
  const double h = list.field.lattice.h;
  for (const auto &crossing : list.crossings.lines) {
    MPMLineConstraint constraint;
    if (!crossing.is_in_front(grid) || crossing.goes_through(grid) ||
        !constraint.find(wall, list.field, crossing, 1))
      continue;
    // next to a side of the body, lines see corners that need not be held
    const int64_t ahead = crossing.node[crossing.n - 1];
    if (ahead < 0 || gap.at(ahead).volume < FILLED * std::pow(h, list.field.lattice.dim)) continue;
    const double beyond = sums(crossing).beyond(list.crossings.contact(crossing.contact));
    if (!(beyond > NOT_TOUCHED) || !std::isfinite(beyond)) continue;
    double x[3];
    grid.node_position(crossing.base, x);
    x[crossing.axis] = crossing.surface;
    first_gap.take({now, -beyond, x[0], x[1], x[2]});
  }
  std::array<double, 5> first;
  if (!first_gap.report(world, first) || comm->me) return;
  error->warning(FLERR,
                 "Fix mpm/boundary {}: its region {} holds material near {:.6g} {:.6g} {:.6g} "
                 "across a gap from step {:.0f} on, as nodes on both sides see it: with {} forces "
                 "begin before the material is touched. Use separate, or start with the region at "
                 "the surface of the material; this is said only once",
                 wall.id, wall.region_id, first[2], first[3], first[4], first[0],
                 wall.kind == MPMWall::STICK ? "stick" : "slip");
}

void MPMWallContactSearch::find_region_contacts(MPMWallNodes &list, double dt, double tolerance)
{
  const double h = list.field.lattice.h;
  map_region(list, dt);
  for (auto &node : list.nodes) {
    const double depth = -node.distance / h;
    // deep inside, or where the distance is not known
    node.touched = depth > MPMWall::DEEPEST || !(depth > -NOT_INSIDE) ||
        gap.at(node.node).touches(list.crossings.contact_at_depth(depth), tolerance);
  }
  for (auto &line : list.crossings.lines)
    line.touched = sums(line).touches(list.crossings.contact(line.contact), tolerance);
}

// Material that approaches a separating wall in an implicit step, from up to COMES_FROM node
// spacings away, is held at its surface, the place s of a wall that it would just touch. A line of
// nodes along the normal there makes the motion sum_i N_i(s) (u_i - dt V) n >= -g with the gap g at
// the start of the step.
static constexpr int PLACES = 32;          // samples per cell in the search for a surface
static constexpr int COARSE = 8;           // a coarse search takes every 8th sample first
static constexpr double MORE = 0.05;       // node spacings beyond COMES_FROM
static constexpr double STRAIGHT = 0.5;    // least cosine between a line and a known normal
static constexpr double DEEPER = 0.1;    // node spacings, for a line whose outer node sees no point
static constexpr int DEEPER_TRIES = 6;

MPMWallContactSearch::Key MPMWallContactSearch::key_of(int axis, bool up, const int *index)
{
  return {2 * axis + up, axis == 0 ? 0 : index[0], axis == 1 ? 0 : index[1],
          axis == 2 ? 0 : index[2]};
}

/** Distance from a face, or from the region (face null). */
MPMDistanceFrom MPMWallContactSearch::distance_from(const MPMBoxFace *face, double dt) const
{
  if (!face) {
    if (!wall.region_moves()) wall.region->prematch();
    return wall.distance_from_region(dt);
  }
  return face->distance(*domain);
}

/** Lines of nodes in front of the wall, each with the node that is nearest to the wall; near: their
 *  blocks. */
MPMWallContactSearch::Lines MPMWallContactSearch::lines_in_front(const MPMWallNodes &list,
                                                                 const MPMBoxFace *face,
                                                                 const Distance &away,
                                                                 std::vector<char> &near) const
{
  Lines lines;
  MPMField &field = list.field;
  const Grid &grid = field.grid;
  const double h = field.lattice.h, seen = 0.5 * (stencil_order(field.options.shape) + 1);
  near.assign(grid.blocks.size(), 0);
  for (std::size_t ib = 0; ib < grid.blocks.size(); ib++)
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      const int64_t node = (int64_t) ib * NODES_PER_BLOCK + n;
      if ((grid.blocks[ib].alias >> n & 1) || !(field.grid.record(node)[3] > 0.0)) continue;
      double x[3], normal[3] = {0.0, 0.0, 0.0};
      grid.node_position(node, x);
      const double d = away(x);
      if (!(d > -2.0 * h && d < (MPMWall::COMES_FROM + MORE + seen) * h)) continue;
      if (face)
        normal[face->axis] = face->inward;
      else
        wall.normal(field, x, normal);
      int axis = 0;
      for (int k = 1; k < field.lattice.dim; k++)
        if (std::fabs(normal[k]) > std::fabs(normal[axis])) axis = k;
      if (!(std::fabs(normal[axis]) > STRAIGHT)) continue;
      near[ib] = 1;
      int index[3];
      grid.node_index(node, index);
      const NearestNode none = {std::numeric_limits<double>::max(), {}, {}};
      auto &line = lines.emplace(key_of(axis, normal[axis] > 0.0, index), none).first->second;
      if (!(std::fabs(d) < line.distance)) continue;
      line.distance = std::fabs(d);
      std::copy_n(index, 3, line.index);
      MathExtra::copy3(normal, line.normal);
    }
  return lines;
}

/** Where the material has left the outer node of a line through the wall, that line cannot act. A
 *  line through the material a little further in can, and explicit steps come back to the wall
 *  within a few steps. */
void MPMWallContactSearch::leave_out_acting(MPMWallNodes &list, MPMBoxFace *face,
                                            Lines &lines) const
{
  MPMField &field = list.field;
  const auto key_at = [&](int axis, bool up, int64_t node) {
    int index[3];
    field.grid.node_index(node, index);
    return key_of(axis, up, index);
  };
  MPMLineConstraint acting;
  if (face) {
    for (auto &line : face->lines) {
      if (!line.touched) continue;
      line.touched = acting.find(wall, field, line, face->inward);
      if (line.touched) lines.erase(key_at(face->axis, face->inward > 0, line.node[0]));
    }
    for (const auto &column : face->columns)
      if (column.touched && column.node[0] >= 0)
        lines.erase(key_at(face->axis, face->inward > 0, column.node[0]));
  }
  const auto key_on = [&](const MPMCrossing &line) {
    return key_at(line.axis, line.normal[line.axis] > 0.0, line.base);
  };
  for (auto &line : list.crossings.lines) {
    if (!line.touched) continue;
    line.touched = acting.find(wall, field, line, 1);
    if (line.touched) lines.erase(key_on(line));
  }
  if (!wall.moves_and_holds) return;

  // a wall that holds needs only lines that replace those which cannot act
  std::set<Key> instead;
  for (const auto &line : list.crossings.lines)
    if (!line.touched && line.is_in_front(field.grid)) instead.insert(key_on(line));
  for (auto line = lines.begin(); line != lines.end();)
    line = instead.count(line->first) ? std::next(line) : lines.erase(line);
}

/** How far behind (negative: in front of) a wall at this place on a line is the surface that the
 *  nodes see? The line gets the nodes and weights for this place. */
double MPMWallContactSearch::beyond(MPMWallNodes &list, const Key &key, const NearestNode &nearest,
                                    double place, double distance, MPMApproach &line) const
{
  const auto &lattice = list.field.lattice;
  const double h = lattice.h;
  const int axis = key[0] / 2, outward = key[0] % 2 ? 1 : -1;
  int first;
  double weight[NodeLine::MOST];
  line.axis = axis;
  line.n = MPMLineConstraint::weights_at(list.field, axis, outward,
                                         lattice.origin[axis] + h * outward * place, first, weight);
  for (int k = 0; k < line.n; k++) {
    const int from = outward > 0 ? k : line.n - 1 - k;
    int index[3] = {nearest.index[0], nearest.index[1], nearest.index[2]};
    index[axis] = lattice.wrap(axis, first + from);
    line.node[k] = list.field.grid.locate(index);
    line.weight[k] = weight[from];
  }
  MPMWallGap::Sums seen = sums(line);
  seen.distance -= distance / h * seen.volume;
  return seen.beyond(
      list.crossings.contact(list.crossings.contact_index(std::fabs(nearest.normal[axis]), place)));
}

/** Finds the first place with material on a line, and the line of nodes there. x: this place. */
bool MPMWallContactSearch::find_surface(MPMWallNodes &list, const Key &key,
                                        const NearestNode &nearest, const Distance &away, double *x,
                                        MPMApproach &found) const
{
  const auto &lattice = list.field.lattice;
  const double h = lattice.h;
  const int axis = key[0] / 2, outward = key[0] % 2 ? 1 : -1;
  lattice.node_position(nearest.index, x);
  const double slope = std::fabs(nearest.normal[axis]),
               // of the wall, in node spacings that grow outward
      wall_at = outward * (x[axis] - lattice.origin[axis]) / h - away(x) / (slope * h);
  const auto distance = [&](double place) {
    x[axis] = lattice.origin[axis] + h * outward * place;
    return away(x);
  };
  const auto at_sample = [&](int sample) {
    const double place = (sample + 0.5) / PLACES;
    return beyond(list, key, nearest, place, distance(place), found);
  };
  const int start = (int) std::floor(wall_at * PLACES),
            last = start + (int) ((MPMWall::COMES_FROM + MORE) / slope * PLACES);
  int high = start;
  double at_high = at_sample(high);
  while (at_high > 0.0 && high < last) at_high = at_sample(high += COARSE);
  if (at_high > 0.0) return false;
  double place = wall_at;
  if (high > start) {
    int low = high - COARSE;
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      (at_sample(middle) > 0.0 ? low : high) = middle;
    }
    const double above = at_sample(low);
    at_high = at_sample(high);
    place = (low + 0.5) / PLACES;
    if (std::isfinite(above)) place += above / (above - at_high) / PLACES;
  }
  place = std::max(place, wall_at);
  found.gap = std::max(distance(place), 0.0);
  MPMLineConstraint acting;
  for (int k = 0; k < DEEPER_TRIES; k++, place += DEEPER) {
    beyond(list, key, nearest, place, distance(place), found);
    if (acting.find(wall, list.field, found, 1)) break;
  }
  return acting.n > 0;
}

void MPMWallContactSearch::find_approaches(MPMWallNodes &list, double dt)
{
  MPMField &field = list.field;
  const double seen = 0.5 * (stencil_order(field.options.shape) + 1),
               more = MPMWall::COMES_FROM + MORE + seen, far = MPMWallGap::farthest(field, more);
  list.approaches.clear();
  std::vector<MPMBoxFace *> faces;
  for (auto &face : list.mirrors.faces) faces.push_back(&face);
  if (wall.region) faces.assign(1, nullptr);
  for (MPMBoxFace *const face : faces) {
    const MPMDistanceFrom away = distance_from(face, dt);
    const Distance away_if_near = [&](const double *x) {
      return away(x, far);
    };
    std::vector<char> near;
    Lines lines = lines_in_front(list, face, away_if_near, near);
    leave_out_acting(list, face, lines);
    gap.map(field, near, (face ? 2.0 : 2.45) * seen + MPMWall::COMES_FROM + MORE, away, more);
    for (const auto &[key, nearest] : lines) {
      MPMApproach found = {};
      double x[3];
      if (!find_surface(list, key, nearest, away_if_near, x, found)) continue;
      if (face)
        MathExtra::copy3(nearest.normal, found.normal);
      else
        wall.normal(field, x, found.normal);
      list.approaches.push_back(found);
    }
  }
}
