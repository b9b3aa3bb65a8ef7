/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Material that approaches a separating wall in an implicit step, from up to COMES_FROM node spacings away. The nodes at the wall
// may not even reach it: its surface has to be held, at a place s in front of the wall, and there a line of nodes along the
// normal makes the motion
//
//   sum_i N_i(s) (u_i - dt V) n >= -g
//
// with the gap g at the start of the step. The solver holds it at -g when the trial motion has closed the gap (decide()), and
// lets it go where the wall would pull, as with material that is already at the wall.
//
// Mean distances give the position of the surface, as at the wall (mpm_wall_gap.cpp): s is the place of a wall that the
// material would just touch.

#include "walls/fix_mpm_boundary.h"

#include "field/mpm_field.h"
#include "field/mpm_point_map.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "math_extra.h"
#include "region.h"
#include "update.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int PLACES = 32;          // samples per cell in the search for a surface
static constexpr int COARSE = 8;           // a coarse search takes every 8th sample first
static constexpr double MORE = 0.05;       // node spacings beyond COMES_FROM
static constexpr double FAR = 1.0e8;       // node spacings
static constexpr double THROUGH = 0.5;     // node spacings in the wall where contact has failed
static constexpr double AT_WALL = 0.01;    // node spacings
static constexpr double STRAIGHT = 0.5;    // least cosine between a line and a known normal
static constexpr double DEEPER = 0.1;    // node spacings, for a line whose outer node sees no point

/* ----------------------------------------------------------------------
   Ranks that have a node of a line need all nodes between it and the wall, and the next ones behind it
------------------------------------------------------------------------- */

void FixMPMBoundary::extend_to_approaches(MPMField &field) const
{
  if (comm->nprocs == 1) return;
  Grid &grid = field.grid;
  const int dim = field.lattice.dim, nblocks = (int) grid.blocks.size(),
            reach = (SOUGHT + grid.side - 1) / grid.side;
  const double h = field.lattice.h;
  const bool known = region && !region_moves() && region->nregion == 1;
  const auto faces = region ? Faces() : faces_on_lattice(field);
  if (known) region->prematch();
  for (int ib = 0; ib < nblocks; ib++) {
    const int b[3] = {grid.blocks[ib].b[0], grid.blocks[ib].b[1], grid.blocks[ib].b[2]};
    for (const auto &face : faces)
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
        std::fabs(surface->distance(middle, FAR * h)) >
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

/* ----------------------------------------------------------------------
   Lines of nodes through the surface of material in front of the wall, except those on which the wall acts already
------------------------------------------------------------------------- */

void FixMPMBoundary::find_approaches(FieldNodes &list, double dt)
{
  MPMField &field = *list.field;
  const Grid &grid = field.grid;
  const auto &lattice = field.lattice;
  const int dim = lattice.dim;
  const double h = lattice.h, seen = 0.5 * (stencil_order(field.options.shape) + 1);
  list.approaches.clear();
  for (int f = 0; f < (region ? 1 : (int) list.faces.size()); f++) {
    const Face *const face = region ? nullptr : &list.faces[f];
    const double more = COMES_FROM + MORE + seen;
    std::function<double(const double *)> away;
    if (region) {
      if (!region_moves()) region->prematch();
      away = distance_from_region(field, dt, more);
    } else {
      const double place = face->inward > 0 ? domain->boxlo[face->axis] : domain->boxhi[face->axis];
      away = [face, place](const double *x) {
        return face->inward * (x[face->axis] - place);
      };
    }

    // lines of nodes, each with the node that is nearest to the wall, by axis, direction, and lateral place

    struct Nearest {
      double distance = std::numeric_limits<double>::max();
      int index[3];
      double normal[3];
    };
    std::map<std::array<int, 4>, Nearest> lines;
    const auto key_of = [](int axis, bool up, const int *index) {
      return std::array<int, 4>{2 * axis + up, axis == 0 ? 0 : index[0], axis == 1 ? 0 : index[1],
                                axis == 2 ? 0 : index[2]};
    };
    std::vector<char> near(grid.blocks.size(), 0);
    for (std::size_t ib = 0; ib < grid.blocks.size(); ib++)
      for (int n = 0; n < NODES_PER_BLOCK; n++) {
        const int64_t node = (int64_t) ib * NODES_PER_BLOCK + n;
        if ((grid.blocks[ib].alias >> n & 1) || !(field.grid.record(node)[3] > 0.0)) continue;
        double x[3], normal[3] = {0.0, 0.0, 0.0};
        grid.node_position(node, x);
        const double d = away(x);
        if (!(d > -2.0 * h && d < (COMES_FROM + MORE + seen) * h)) continue;
        if (region)
          surface->normal(x, FAR * h, 1.0e-4 * h, normal);
        else
          normal[face->axis] = face->inward;
        int axis = 0;
        for (int k = 1; k < dim; k++)
          if (std::fabs(normal[k]) > std::fabs(normal[axis])) axis = k;
        if (!(std::fabs(normal[axis]) > STRAIGHT)) continue;
        near[ib] = 1;
        int index[3];
        grid.node_index(node, index);
        auto &line = lines[key_of(axis, normal[axis] > 0.0, index)];
        if (!(std::fabs(d) < line.distance)) continue;
        line.distance = std::fabs(d);
        std::copy_n(index, 3, line.index);
        MathExtra::copy3(normal, line.normal);
      }
    const auto leave_out = [&](int axis, bool up, int64_t node) {
      int index[3];
      if (node < 0) return;
      grid.node_index(node, index);
      lines.erase(key_of(axis, up, index));
    };
    // Where the material has left the outer node of a line through the wall (find_chain()), that line cannot act. A line
    // through the material a little further in can, and explicit steps come back to the wall within a few steps

    Chain acting;
    for (auto &line : list.lines) {
      if (!face || line.face != f || !line.touched) continue;
      acting = Chain();
      line.touched = !face->cut ||
          find_chain(list, line.node, face->weight, face->nweight, face->inward, acting);
      if (line.touched) leave_out(face->axis, face->inward > 0, line.node[0]);
    }
    for (auto &crossing : list.crossings) {
      if (!crossing.touched) continue;
      acting = Chain();
      crossing.touched = find_chain(list, crossing.node, crossing.weight, crossing.n, 1, acting);
      if (crossing.touched)
        leave_out(crossing.axis, crossing.normal[crossing.axis] > 0.0, crossing.base);
    }

    // a wall that holds needs only lines that replace those which cannot act

    if (follows) {
      std::set<std::array<int, 4>> instead;
      for (const auto &crossing : list.crossings) {
        int index[3];
        if (crossing.touched || !is_in_front(field.grid, crossing)) continue;
        grid.node_index(crossing.base, index);
        instead.insert(key_of(crossing.axis, crossing.normal[crossing.axis] > 0.0, index));
      }
      for (auto line = lines.begin(); line != lines.end();)
        line = instead.count(line->first) ? std::next(line) : lines.erase(line);
    }

    gap.map(field, near, !region || region->nregion == 1,
            (region ? 2.45 : 2.0) * seen + COMES_FROM + MORE, away, more);

    // how far behind (negative: in front of) a wall at this place is the surface that the nodes see?

    const auto look = [&](const Nearest &line, int axis, int outward, double place, double distance,
                          Approach &found) {
      int first;
      double weight[4];
      found.axis = axis;
      found.n = weights_at(field, axis, outward, lattice.origin[axis] + h * outward * place, first,
                           weight);
      MPMWallGap::Sums sums;
      for (int k = 0; k < found.n; k++) {
        const int from = outward > 0 ? k : found.n - 1 - k;
        int index[3] = {line.index[0], line.index[1], line.index[2]};
        index[axis] = lattice.wrap(axis, first + from);
        found.node[k] = grid.locate(index);
        found.weight[k] = weight[from];
        if (found.node[k] < 0) continue;
        sums.add(weight[from], gap.at(found.node[k]));
      }
      sums.distance -= distance / h * sums.volume;
      const int full = crossed_contact(list, std::fabs(line.normal[axis]), place);
      return sums.beyond(list.crossed[full]);
    };

    for (const auto &[key, line] : lines) {
      const int axis = key[0] / 2, outward = key[0] % 2 ? 1 : -1;
      double x[3];
      lattice.node_position(line.index, x);
      const double slope = std::fabs(line.normal[axis]),
                   // of the wall, in node spacings that grow outward
          wall_at = outward * (x[axis] - lattice.origin[axis]) / h - away(x) / (slope * h);
      const auto distance = [&](double place) {
        x[axis] = lattice.origin[axis] + h * outward * place;
        return away(x);
      };
      Approach found = {};
      const auto beyond = [&](int sample) {
        const double place = (sample + 0.5) / PLACES;
        return look(line, axis, outward, place, distance(place), found);
      };

      // the first place with material

      const int start = (int) std::floor(wall_at * PLACES),
                last = start + (int) ((COMES_FROM + MORE) / slope * PLACES);
      int high = start;
      double at_high = beyond(high);
      while (at_high > 0.0 && high < last) at_high = beyond(high += COARSE);
      if (at_high > 0.0) continue;
      double place = wall_at;
      if (high > start) {
        int low = high - COARSE;
        while (high - low > 1) {
          const int middle = (low + high) / 2;
          (beyond(middle) > 0.0 ? low : high) = middle;
        }
        const double above = beyond(low);
        at_high = beyond(high);
        place = (low + 0.5) / PLACES;
        if (std::isfinite(above)) place += above / (above - at_high) / PLACES;
      }
      place = std::max(place, wall_at);
      found.gap = std::max(distance(place), 0.0);
      Chain chain;
      for (int k = 0; k < 6; k++, place += DEEPER) {
        look(line, axis, outward, place, distance(place), found);
        chain = Chain();
        if (find_chain(list, found.node, found.weight, found.n, 1, chain)) break;
      }
      if (chain.m == 0) continue;
      if (region)
        surface->normal(x, FAR * h, 1.0e-4 * h, found.normal);
      else
        MathExtra::copy3(line.normal, found.normal);
      list.approaches.push_back(found);
    }
  }
}

/* ----------------------------------------------------------------------
   Holds the normal component at the surface of the material, as in act_on_crossing(). The wall does no work on the way to it
------------------------------------------------------------------------- */

void FixMPMBoundary::act_on_approach(const FieldNodes &list, const Approach &line, Touch &touch)
{
  if (!touch.active) return;
  Grid &grid = list.field->grid;
  const int dim = grid.lattice.dim;
  const bool sticks = kind == STICK;
  const double *const n = line.normal,
                      closing = closes || now.counting ? touch.gap / trial_dt : 0.0;
  Chain chain;
  if (!find_chain(list, line.node, line.weight, line.n, 1, chain)) return;
  double relative[4], change[4], all[3][4] = {};
  for (int k = 0; k < chain.m; k++) {
    relative[k] = closing;
    for (int d = 0; d < dim; d++) relative[k] += (chain.r[k][d] - chain.V[k][d]) * n[d];
  }
  const double lambda = chain.solve(relative, change);
  if (!now.counting) touch.push += chain.total * lambda;
  for (int d = 0; d < dim && sticks; d++) {
    for (int k = 0; k < chain.m; k++) relative[k] = chain.r[k][d] - chain.V[k][d];
    chain.solve(relative, all[d]);
  }
  for (int k = 0; k < chain.m; k++) {
    double v[3] = {0.0, 0.0, 0.0}, whole[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < dim; d++) {
      v[d] = chain.r[k][d] + (sticks ? all[d][k] : change[k] * n[d]);
      whole[d] = v[d] + closing * n[d];
    }
    set_velocity(grid, chain.node[k], chain.V[k], v, nullptr, whole);
  }
}

/* ---------------------------------------------------------------------- */

bool FixMPMBoundary::close_gaps(bool yes)
{
  closes = yes;
  return std::any_of(touches.begin(), touches.end(), [](const Touch &touch) {
    return touch.active && touch.gap > 0.0;
  });
}

/** Distances of points from the wall at the start of the step. */
void FixMPMBoundary::find_clear(const FieldNodes &list, double dt)
{
  const MPMField &field = *list.field;
  const int nfaces = region ? 1 : (int) list.faces.size();
  clear.resize((std::size_t) nfaces * atom->nmax);
  if (region && !region_moves()) region->prematch();
  const auto away = region ? distance_from_region(field, dt) : nullptr;
  for (const auto &run : field.map->runs)
    for (bigint i = run.first; i < run.last; i++)
      for (int f = 0; f < nfaces; f++) {
        const double *const x = atom->x[i];
        double &distance = clear[nfaces * i + f];
        if (region) {
          distance = away(x);
          continue;
        }
        const Face &face = list.faces[f];
        distance = face.inward *
            (x[face.axis] - (face.inward > 0 ? domain->boxlo : domain->boxhi)[face.axis]);
      }
}

/** Checks that no material that was in front of the wall, and was not found to touch it, is in the wall now. */
void FixMPMBoundary::check_arrival()
{
  if (!seeks || !tried) return;
  const MPMField &field = *tried;
  const double h = field.lattice.h;
  const auto &list = tried_nodes();
  const int nfaces = region ? 1 : (int) list.faces.size();
  double worst[2] = {0.0, 0.0}, all[2];    // distance that a point came from, depth
  const double far = MPMWallGap::farthest(field);
  if (region) region->prematch();
  for (const auto &run : field.map->runs)
    for (bigint i = run.first; i < run.last; i++)
      for (int f = 0; f < nfaces; f++) {
        const double before = clear[nfaces * i + f], *const x = atom->x[i];
        if (!(before > 0.0)) continue;
        double depth;
        if (region) {
          depth = -surface->gap(x, far, h);
        } else {
          const Face &face = list.faces[f];
          const int a = face.axis;
          const double place = face.inward > 0 ? domain->boxlo[a] : domain->boxhi[a];
          depth = -face.inward * (x[a] - place - trial_dt * wall.shift[a]);
        }
        if (depth > THROUGH * h || (depth > AT_WALL * h && before > COMES_FROM * h)) {
          worst[0] = std::max(worst[0], before / h);
          worst[1] = std::max(worst[1], depth / h);
        }
      }
  MPI_Allreduce(worst, all, 2, MPI_DOUBLE, MPI_MAX, world);
  if (all[1] > 0.0)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/boundary {}: material from {:.3g} node spacings away came {:.3g} node "
               "spacings into the wall in step {}; fix mpm/implicit finds contact of what is "
               "within {} node spacings of a wall at the start of a step: use a smaller timestep, "
               "smaller steps of load, or a place nearer to the wall at the start",
               id, all[0], all[1], update->ntimestep, COMES_FROM);
}
