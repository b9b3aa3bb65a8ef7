/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/mpm_wall_trial.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_point_map.h"
#include "field/mpm_stencil.h"
#include "math_extra.h"
#include "region.h"
#include "update.h"
#include "walls/mpm_line_constraint.h"
#include "walls/mpm_wall.h"
#include "walls/mpm_wall_contact_search.h"
#include "walls/mpm_wall_nodes.h"
#include "walls/mpm_wall_reaction.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// Contact that an implicit solver decides. While it is known what touches, walls hold the normal
// component of their lines of nodes and single nodes, as slip does; the impulse that this needs
// gives the force N of each. Friction acts at the surface: on the nodes of a line in the shares a_k
// with which they make the velocity there, so that a uniform shear stress is in balance node by
// node. The slip is s = sum_k a_k (u_k - dt V_k), along the surface.
static constexpr double LONGEST = 0.99;    // longest w, so that a body that slips keeps a stiffness
// least pull to let go, relative to the largest push; least depth in the wall, in node spacings
static constexpr double WRONG = 1.0e-9;
static constexpr double STILL_RIGHT = 1.0e-4;    // the same in later rounds
static constexpr int AT_ONCE = 6;                // rounds in which everything wrong is changed
// distance from a wall, in node spacings, at which material touches it if other material does, and
// at which statics tries whether it does
static constexpr double NEXT_TO = 0.08, NEARBY = 0.4;
// error of mean distances, in node spacings, within which they decide nothing: contact with regions
// is tabulated
static constexpr double NOT_KNOWN = 0.03;
static constexpr double THROUGH = 0.5;     // node spacings in the wall where contact has failed
static constexpr double AT_WALL = 0.01;    // node spacings

bool MPMWallTrial::decides(const MPMWallNodes &list) const
{
  return in_trials && (wall.decides() || wall.moves_and_holds) && &list.field == field;
}

bool MPMWallTrial::has_friction() const
{
  return wall.rubs();
}

MPMWallNodes &MPMWallTrial::nodes()
{
  return *std::find_if(fields.begin(), fields.end(), [this](const MPMWallNodes &list) {
    return &list.field == field;
  });
}

void MPMWallTrial::begin_trials(MPMField &of, double step, double time, double regular, bool rests)
{
  if (wall.heat.heats())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/boundary {}: implicit steps do not know the heat of friction: remove heat, "
               "or use explicit steps",
               wall.id);
  field = &of;
  in_trials = true;
  dt = step;
  slip_time = time;
  eps = regular;
  soft = 0.0;
  update_motion(wall, fields, dt);
  MPMWallNodes &list = nodes();
  const bool separates = wall.kind == MPMWall::SEPARATE;
  closes = wall.is_grip = false;
  rounds = 0;
  list.approaches.clear();
  if (separates) {
    search.find_contacts(list, dt, NOT_KNOWN);
    search.find_approaches(list, dt);
    find_clearance(list);
  } else if (wall.moves_and_holds && wall.acts_across()) {
    search.check_gaps(list, dt);
    search.find_approaches(list, dt);
  }
  list_constraints(list);

  // Where other material touches, round-off would decide whether material next to the wall does. In
  // statics, nothing else may hold it
  const std::size_t first_node = list.first_node();
  int any = 0, touched = 0;
  for (std::size_t k = 0; k < constraints.size() && separates; k++)
    if (constraints[k].active && constraints[k].n > 0 &&
        (k < first_node || !is_deep(list, k - first_node)))
      any = 1;
  if (separates) MPI_Allreduce(&any, &touched, 1, MPI_INT, MPI_MAX, world);
  for (std::size_t k = first_node; k < constraints.size() && separates && !touched; k++)
    constraints[k].possible = constraints[k].active = false;
  start_approaches(list, touched, rests);
  for (auto &c : constraints) c.coefficient = wall.friction_at(list.field.grid, c.node, c.n);
}

/** Keeps the nodes of a constraint that have mass, with weights that add up to one. */
static void keep_massive(Grid &grid, MPMContactConstraint &c)
{
  int n = 0;
  double all = 0.0;
  for (int j = 0; j < c.n; j++) {
    if (c.node[j] < 0 || !(grid.record(c.node[j])[3] > 0.0) || c.weight[j] == 0.0) continue;
    c.node[n] = c.node[j];
    c.weight[n++] = c.weight[j];
    all += c.weight[j];
  }
  c.n = n;
  for (int j = 0; j < n; j++) c.weight[j] /= all;
}

/** A constraint on a line of nodes. */
static MPMContactConstraint constraint_on(Grid &grid, const NodeLine &line, const double *normal,
                                          bool possible)
{
  MPMContactConstraint c;
  static_cast<NodeLine &>(c) = line;
  MathExtra::copy3(normal, c.normal);
  c.possible = c.active = possible;
  keep_massive(grid, c);
  return c;
}

/** Lists the constraints of faces, crossings, and nodes. */
void MPMWallTrial::list_constraints(MPMWallNodes &list)
{
  Grid &grid = field->grid;
  const MPMStencil stencil(*field);
  const bool separates = wall.kind == MPMWall::SEPARATE;
  constraints.clear();
  for (const auto &face : list.mirrors.faces) {
    double normal[3] = {0.0, 0.0, 0.0};
    normal[face.axis] = face.inward;
    for (const auto &line : face.lines)
      constraints.push_back(constraint_on(grid, line, normal, !separates || line.touched));
    for (const auto &column : face.columns) {
      // in a mirror plane, functions are even: that of the plane, and those of its neighbors on
      // both sides
      NodeLine line;
      int first;
      double weight[NodeLine::MOST];
      const int n = stencil.weights((double) face.plane, first, weight);
      for (int j = 0; j < n; j++) {
        const int away = face.inward * (first + j - face.plane);
        if (std::abs(away) > 1) continue;
        line.node[line.n] = column.node[away < 0 ? MPMMirrorColumn::DEPTH + 1 : away];
        line.weight[line.n++] = weight[j];
      }
      constraints.push_back(constraint_on(grid, line, normal, !separates || column.touched));
    }
  }
  for (const auto &line : list.crossings.lines)
    constraints.push_back(constraint_on(grid, line, line.normal, !separates || line.touched));
  for (const auto &node : list.nodes) {
    NodeLine line;
    line.n = 1;
    line.node[0] = node.node;
    line.weight[0] = 1.0;
    constraints.push_back(constraint_on(grid, line, node.normal, !separates || node.touched));
  }
}

/** Adds the constraints of approaches. touched: does other material touch the wall? */
void MPMWallTrial::start_approaches(MPMWallNodes &list, bool touched, bool rests)
{
  const double h = field->lattice.h;
  for (const auto &line : list.approaches) {
    auto c = constraint_on(field->grid, line, line.normal, true);
    if (wall.moves_and_holds) {
      c.active = line.gap < NEARBY * h;
    } else {
      c.gap = touched && line.gap < NEXT_TO * h ? 0.0 : line.gap;
      c.active = touched ? c.gap == 0.0 : rests && line.gap < NEARBY * h;
    }
    constraints.push_back(c);
  }
}

/** Is the node so far behind the surface that it is not known whether material touches it? */
bool MPMWallTrial::is_deep(const MPMWallNodes &list, std::size_t node) const
{
  return !wall.region || -list.nodes[node].distance > MPMWall::DEEPEST * list.field.lattice.h;
}

bool MPMWallTrial::close_gaps(bool yes)
{
  closes = yes;
  return std::any_of(constraints.begin(), constraints.end(), [](const MPMContactConstraint &c) {
    return c.active && c.gap > 0.0;
  });
}

/** Motion of the surface along the wall, and away from it, relative to the motion of the wall in
 *  this time. */
void MPMWallTrial::find_slip(const MPMContactConstraint &c, const double *u, double time,
                             double *slip, double &away) const
{
  const int dim = field->lattice.dim;
  MathExtra::zero3(slip);
  for (int j = 0; j < c.n; j++) {
    double V[3] = {0.0, 0.0, 0.0};
    if (time > 0.0) wall.motion.velocity(field->grid, c.node[j], V);
    for (int d = 0; d < dim; d++) slip[d] += c.weight[j] * (u[dim * c.node[j] + d] - time * V[d]);
  }
  away = MathExtra::dot3(slip, c.normal);
  for (int d = 0; d < 3; d++) slip[d] -= away * c.normal[d];
}

/** Calls use(constraint) for all contacts that are held and have friction. */
template <class Use> void MPMWallTrial::visit_rubbing(const Use &use)
{
  for (auto &c : constraints)
    if (c.coefficient != 0.0 && c.active && c.n > 0) use(c);
}

/** (|s|^2 + eps^2)^(1/2), see MPMTrialContact. */
double MPMWallTrial::length(const MPMContactConstraint &c) const
{
  const double width = std::max(eps, soft);
  return std::sqrt(MathExtra::lensq3(c.slip) + width * width);
}

void MPMWallTrial::add_friction(const double *u, double *force)
{
  const int dim = field->lattice.dim;
  visit_rubbing([&](MPMContactConstraint &c) {
    double away;
    find_slip(c, u, slip_time, c.slip, away);
    MathExtra::zero3(c.friction);
    if (!(c.force > 0.0)) return;
    const double length = this->length(c);
    for (int d = 0; d < dim; d++) {
      c.friction[d] = -c.coefficient * c.force * c.slip[d] / length;
      for (int j = 0; j < c.n; j++) force[dim * c.node[j] + d] += c.weight[j] * c.friction[d];
    }
  });
}

/* Where a line reverses its slip, friction changes its sign within eps. Therefore w = s/l, l =
 *  (|s|^2 + eps^2)^(1/2), is an unknown of its own, and l w = s is linearized (T.F. Chan, G.H.
 *  Golub, P. Mulet, SIAM J. Sci. Comput. 20 (1999) 1964):
 *
 *    l dw + w s.ds/l = s + ds - l w
 *
 *  so that friction changes as -mu N (ds - w s.ds/l)/l, which is never quite soft. */

/** Change of direction for a change ds of the slip: (ds - w s.ds/l)/l. */
void MPMWallTrial::change_of_direction(const MPMContactConstraint &c, const double *slip,
                                       double *change) const
{
  const double length = this->length(c), along = MathExtra::dot3(c.slip, slip) / length;
  for (int d = 0; d < 3; d++) change[d] = (slip[d] - along * c.direction[d]) / length;
}

void MPMWallTrial::add_friction_change(const double *du, double scale, double *dforce)
{
  const int dim = field->lattice.dim;
  visit_rubbing([&](MPMContactConstraint &c) {
    if (!(c.force > 0.0)) return;
    double slip[3], turn[3], away;
    find_slip(c, du, 0.0, slip, away);
    change_of_direction(c, slip, turn);
    const double length = this->length(c), more = (c.impulse - c.base) / scale;
    for (int d = 0; d < dim; d++) {
      const double change = -c.coefficient * (more * c.slip[d] / length + c.force * turn[d]);
      for (int j = 0; j < c.n; j++) dforce[dim * c.node[j] + d] += c.weight[j] * change;
    }
  });
}

void MPMWallTrial::correct(const double *du)
{
  visit_rubbing([&](MPMContactConstraint &c) {
    double slip[3], turn[3], away;
    find_slip(c, du, 0.0, slip, away);
    change_of_direction(c, slip, turn);
    double *const w = c.direction;
    const double length = this->length(c);
    for (int d = 0; d < 3; d++) w[d] = c.slip[d] / length + turn[d];
    const double size = MathExtra::len3(w);
    if (size > LONGEST) MathExtra::scale3(LONGEST / size, w);
  });
}

void MPMWallTrial::add_friction_blocks(double *blocks)
{
  const int dim = field->lattice.dim;
  visit_rubbing([&](MPMContactConstraint &c) {
    if (!(c.force > 0.0)) return;
    double along[3] = {0.0, 0.0, 0.0}, turn[3];
    const double slope = c.coefficient * c.force;
    for (int e = 0; e < dim; e++) {
      for (int d = 0; d < 3; d++) along[d] = (d == e) - c.normal[d] * c.normal[e];
      change_of_direction(c, along, turn);
      for (int j = 0; j < c.n; j++)
        for (int d = 0; d < dim; d++)
          blocks[dim * dim * c.node[j] + dim * d + e] +=
              c.weight[j] * c.weight[j] * slope * turn[d];
    }
  });
}

void MPMWallTrial::add_friction_stiffness(double *stiffness)
{
  visit_rubbing([&](MPMContactConstraint &c) {
    if (!(c.force > 0.0)) return;
    double turn[3];
    change_of_direction(c, c.slip, turn);
    const double size = MathExtra::lensq3(c.slip),
                 along = size > 0.0 ? MathExtra::dot3(turn, c.slip) / size : 1.0 / length(c);
    for (int j = 0; j < c.n; j++)
      stiffness[c.node[j]] += c.weight[j] * c.coefficient * c.force * along;
  });
}

/** At first, everything that is wrong is changed. If this oscillates, only the worst half is
 *  changed, and what is almost right stays. */
bool MPMWallTrial::decide(const double *u, double unbalanced)
{
  if (wall.kind != MPMWall::SEPARATE || unbalanced > 0.0) return false;
  const double h = field->lattice.h;
  double mine = 0.0, largest, worst;
  for (const auto &c : constraints)
    if (c.active) mine = std::max(mine, std::fabs(c.force));
  MPI_Allreduce(&mine, &largest, 1, MPI_DOUBLE, MPI_MAX, world);
  double slip[3], away;
  std::vector<double> wrong(constraints.size(), 0.0);
  mine = 0.0;
  for (std::size_t k = 0; k < constraints.size(); k++) {
    const MPMContactConstraint &c = constraints[k];
    if (!c.possible || c.n == 0) continue;
    if (c.active) {
      wrong[k] = largest > 0.0 ? -c.force / largest : 0.0;
    } else {
      find_slip(c, u, dt, slip, away);
      wrong[k] = (-away - c.gap) / h;
    }
    mine = std::max(mine, wrong[k]);
  }
  MPI_Allreduce(&mine, &worst, 1, MPI_DOUBLE, MPI_MAX, world);
  const bool all = rounds++ < AT_ONCE;
  if (worst <= (all ? WRONG : STILL_RIGHT)) return false;
  bool changed = false;
  for (std::size_t k = 0; k < constraints.size(); k++) {
    if (wrong[k] <= (all ? WRONG : 0.5 * worst)) continue;
    constraints[k].active = !constraints[k].active;
    changed = true;
  }
  return changed;
}

/** Friction at the end of the step, before walls act; its work is that with the final velocities of
 *  the nodes. */
void MPMWallTrial::apply_friction(MPMWallReaction &reaction)
{
  const int dim = field->lattice.dim;
  visit_rubbing([&](MPMContactConstraint &c) {
    for (int j = 0; j < c.n; j++) {
      const int64_t node = c.node[j];
      const double *const record = field->grid.record(node);
      double V[3], v[3] = {0.0, 0.0, 0.0}, whole[3] = {0.0, 0.0, 0.0};
      wall.motion.velocity(field->grid, node, V);
      for (int d = 0; d < dim; d++) {
        v[d] = record[d] + friction_share * dt * c.weight[j] * c.friction[d] / record[3];
        whole[d] = final_velocity[dim * node + d];
      }
      reaction.set_velocity(node, V, v, nullptr, whole);
    }
  });
}

void MPMWallTrial::act_on_approaches(MPMWallReaction &reaction, MPMWallNodes &list)
{
  const std::size_t first = list.first_approach();
  for (std::size_t k = 0; k < list.approaches.size(); k++)
    act_on_approach(reaction, list, list.approaches[k], constraints[first + k]);
}

/** Holds the normal component at the surface of the material, as in MPMCrossingLines. The wall does
 *  no work on the way to it. */
void MPMWallTrial::act_on_approach(MPMWallReaction &reaction, MPMWallNodes &list,
                                   const MPMApproach &line, MPMContactConstraint &c)
{
  if (!c.active) return;
  const int dim = list.field.lattice.dim;
  const bool sticks = wall.kind == MPMWall::STICK;
  const double *const n = line.normal,
                      closing = closes || reaction.is_counting() ? c.gap / dt : 0.0;
  MPMLineConstraint at;
  if (!at.find(wall, list.field, line, 1)) return;
  double relative[4], change[4], all[3][4] = {};
  for (int k = 0; k < at.n; k++) {
    relative[k] = closing;
    for (int d = 0; d < dim; d++) relative[k] += (at.record[k][d] - at.V[k][d]) * n[d];
  }
  const double lambda = at.solve(relative, change);
  if (!reaction.is_counting()) c.impulse += at.total * lambda;
  for (int d = 0; d < dim && sticks; d++) {
    for (int k = 0; k < at.n; k++) relative[k] = at.record[k][d] - at.V[k][d];
    at.solve(relative, all[d]);
  }
  for (int k = 0; k < at.n; k++) {
    double v[3] = {0.0, 0.0, 0.0}, whole[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < dim; d++) {
      v[d] = at.record[k][d] + (sticks ? all[d][k] : change[k] * n[d]);
      whole[d] = v[d] + closing * n[d];
    }
    reaction.set_velocity(at.node[k], at.V[k], v, nullptr, whole);
  }
}

/** Distances of points from the wall at the start of the step. */
void MPMWallTrial::find_clearance(MPMWallNodes &list)
{
  const double far = MPMWallGap::farthest(*field);
  std::vector<MPMDistanceFrom> away;
  if (wall.region && !wall.region_moves()) wall.region->prematch();
  if (wall.region) away.push_back(wall.distance_from_region(dt));
  for (const auto &face : list.mirrors.faces) away.push_back(face.distance(*domain));
  clearance.resize(away.size() * atom->nmax);
  for (const auto &run : field->map->runs)
    for (bigint i = run.first; i < run.last; i++)
      for (std::size_t f = 0; f < away.size(); f++)
        clearance[away.size() * i + f] = away[f](atom->x[i], far);
}

/** Checks that no material that was in front of the wall, and was not found to touch it, is in the
 *  wall now. */
void MPMWallTrial::check_arrival()
{
  if (!wall.looks_ahead || !field) return;
  const double h = field->lattice.h;
  const auto &faces = nodes().mirrors.faces;
  const int nfaces = wall.region ? 1 : (int) faces.size();
  double worst[2] = {0.0, 0.0}, all[2];    // distance that a point came from, depth
  const double far = MPMWallGap::farthest(*field);
  if (wall.region) wall.region->prematch();
  for (const auto &run : field->map->runs)
    for (bigint i = run.first; i < run.last; i++)
      for (int f = 0; f < nfaces; f++) {
        const double before = clearance[nfaces * i + f], *const x = atom->x[i];
        if (!(before > 0.0)) continue;
        double depth;
        if (wall.region) {
          depth = -wall.surface->distance(x, far);
        } else {
          const int a = faces[f].axis;
          depth =
              -faces[f].inward * (x[a] - faces[f].position(*domain) - dt * wall.motion.shift[a]);
        }
        if (depth > THROUGH * h || (depth > AT_WALL * h && before > MPMWall::COMES_FROM * h)) {
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
               wall.id, all[0], all[1], update->ntimestep, MPMWall::COMES_FROM);
}

double MPMWallTrial::memory_usage() const
{
  return clearance.capacity() * sizeof(double) +
      constraints.capacity() * sizeof(MPMContactConstraint);
}

// Grips: regions that move with stick, in implicit steps, where material goes through their
// surface. A grip cuts the body: points inside move with it and have no part in the balance of
// forces, and the line of nodes through the surface holds the material there. Where lines share
// nodes, at edges and on curved surfaces, nodes are held one by one.

/** Finds the share of each point that is outside of the grip (left); a point that the surface cuts
 *  is divided by its width. */
bool MPMWallTrial::find_carried(MPMField &of, std::vector<double> &left)
{
  wall.is_grip = wall.moves_and_holds && wall.kind == MPMWall::STICK && wall.acts_across();
  if (!wall.is_grip) return false;
  left.resize(atom->nmax, 1.0);
  const int dim = of.lattice.dim;
  const double h = of.lattice.h, far = MPMWallGap::farthest(of);
  const auto away = wall.distance_from_region(dt);
  for (const auto &run : of.map->runs)
    for (bigint i = run.first; i < run.last; i++) {
      const double *const x = atom->x[i], distance = away(x, far), *const F = of.points->F[i];
      if (distance > h) continue;
      double width = 0.0;
      if (distance > -h) {
        double y[3], v[3], n[3];
        wall.motion.velocity(x, v);
        for (int d = 0; d < 3; d++) y[d] = x[d] + dt * v[d];
        wall.normal(of, y, n);
        for (int c = 0; c < dim; c++) {
          double along = 0.0;
          for (int d = 0; d < dim; d++) along += F[3 * d + c] * n[d];
          width += along * along;
        }
        width = std::sqrt(width) * std::pow(atom->vfrac[i], 1.0 / dim);
      }
      const double share = width > 0.0 ? 0.5 + distance / width : (double) (distance > 0.0);
      if (share < 1.0) left[i] = std::min(left[i], std::max(share, 0.0));
    }
  return true;
}

/** Spreads the force on each line over its nodes, in the shares of the constraint. */
void MPMWallTrial::constrain_carried(MPMField &of, double *force)
{
  if (!wall.is_grip) return;
  const int dim = of.lattice.dim;
  for (const auto &list : fields) {
    if (&list.field != &of) continue;
    for (const auto &c : list.crossings.lines) {
      if (!c.goes_through(of.grid)) continue;
      for (int d = 0; d < dim; d++) {
        double all = 0.0, shares = 0.0;
        for (int k = 0; k < c.n; k++) {
          all += force[dim * c.node[k] + d];
          shares += c.weight[k];
        }
        for (int k = 0; k < c.n; k++) force[dim * c.node[k] + d] = all * c.weight[k] / shares;
      }
    }
  }
}
