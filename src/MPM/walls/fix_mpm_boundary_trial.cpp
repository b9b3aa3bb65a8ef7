/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Contact that an implicit solver decides. While it is known what touches, walls hold the normal component of their lines of nodes
// and single nodes, as slip does; the impulse that this needs gives the force N of each. Friction acts at the surface: on
// the nodes of a line in the shares a_k with which they make the velocity there, so that a uniform shear stress is in balance
// node by node. The slip is s = sum_k a_k (u_k - dt V_k), along the surface.

#include "walls/fix_mpm_boundary.h"

#include "field/mpm_field.h"
#include "field/mpm_stencil.h"

#include "error.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double LONGEST = 0.99;    // longest w, so that a body that slips keeps a stiffness
static constexpr double WRONG =
    1.0e-9;    // least pull to let go, relative to the largest push; least depth in the wall, in node spacings
static constexpr double STILL_RIGHT = 1.0e-4;    // the same in later rounds
static constexpr int AT_ONCE = 6;                // rounds in which everything wrong is changed
// distance from a wall, in node spacings, at which material touches it if other material does, and at which statics tries
// whether it does
static constexpr double NEXT_TO = 0.08, NEARBY = 0.4;

/* ---------------------------------------------------------------------- */

void FixMPMBoundary::begin_trials(MPMField &field, double dt, double slip_time, double regular,
                                  bool rests)
{
  if (heating)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/boundary {}: implicit steps do not know the heat of friction: remove heat, "
               "or use explicit steps",
               id);
  tried = &field;
  in_trials = true;
  trial_dt = dt;
  trial_slip_time = slip_time;
  eps = regular;
  soft = 0.0;
  update_motion(dt);
  FieldNodes &list = tried_nodes();
  const bool separates = kind == SEPARATE;
  closes = carrying = false;
  rounds = 0;
  touches.clear();
  list.approaches.clear();
  if (separates) {
    find_gaps(list, dt);
    find_approaches(list, dt);
    find_clear(list, dt);
  } else if (follows && acts_across()) {
    note_gaps(list, dt);
    find_approaches(list, dt);
  }
  for (const auto &line : list.lines) touches.emplace_back(!separates || line.touched);
  for (const auto &crossing : list.crossings) touches.emplace_back(!separates || crossing.touched);
  for (const auto &single : list.singles) touches.emplace_back(!separates || single.touched);

  // Where other material touches, round-off would decide whether material next to the wall does. In statics, nothing else may
  // hold it

  const std::size_t nlines = list.lines.size() + list.crossings.size();
  int any = 0, touched = 0;
  Held held[4];
  double normal[3];
  for (std::size_t k = 0; k < touches.size() && separates; k++)
    if (touches[k].active && (k < nlines || !is_deep(list, k - nlines)) &&
        find_held(list, (int) k, held, normal) > 0)
      any = 1;
  if (separates) MPI_Allreduce(&any, &touched, 1, MPI_INT, MPI_MAX, world);
  for (std::size_t k = nlines; k < touches.size() && separates && !touched; k++)
    touches[k].open = touches[k].active = false;
  for (const auto &line : list.approaches) {
    Touch touch(true);
    if (follows) {
      touch.active = line.gap < NEARBY * field.lattice.h;
      touches.push_back(touch);
      continue;
    }
    touch.gap = touched && line.gap < NEXT_TO * field.lattice.h ? 0.0 : line.gap;
    touch.active = touched ? touch.gap == 0.0 : rests && line.gap < NEARBY * field.lattice.h;
    touches.push_back(touch);
  }
}

/** Is the node so far behind the surface that it is not known whether material touches it? */
bool FixMPMBoundary::is_deep(const FieldNodes &list, std::size_t single) const
{
  return !region || -list.singles[single].distance > DEEPEST * list.field->lattice.h;
}

FixMPMBoundary::FieldNodes &FixMPMBoundary::tried_nodes()
{
  return *std::find_if(nodes.begin(), nodes.end(), [this](const FieldNodes &list) {
    return list.field == tried;
  });
}

void FixMPMBoundary::forget_pushes()
{
  for (auto &touch : touches) touch.push = 0.0;
}

void FixMPMBoundary::take_base()
{
  for (auto &touch : touches) touch.base = touch.push;
}

void FixMPMBoundary::take_forces(double scale)
{
  for (auto &touch : touches) touch.force = (touch.push - touch.base) / scale;
}

/* ----------------------------------------------------------------------
   nodes of contact k with mass, at most 4, with shares that add up to one; normal: from the wall to the body.
   Returns their number
------------------------------------------------------------------------- */

int FixMPMBoundary::find_held(const FieldNodes &list, int k, Held *held, double *normal) const
{
  Grid &grid = list.field->grid;
  const int nlines = (int) list.lines.size(), ncrossings = (int) list.crossings.size();
  int n = 0;
  double all = 0.0;
  const auto add = [&](int64_t node, double share) {
    if (node < 0 || !(grid.record(node)[3] > 0.0) || share == 0.0) return;
    held[n++] = {node, share};
    all += share;
  };
  MathExtra::zero3(normal);
  if (k < nlines) {
    const Line &line = list.lines[k];
    const Face &face = list.faces[line.face];
    normal[face.axis] = face.inward;
    if (face.cut) {
      for (int j = 0; j < face.nweight; j++) add(line.node[j], face.weight[j]);
    } else {
      // in a mirror plane, functions are even: that of the plane, and those of its neighbors on both sides
      int first;
      double weight[4];
      const int many = MPMStencil(*list.field).weights((double) face.plane, first, weight);
      for (int j = 0; j < many; j++) {
        const int away = face.inward * (first + j - face.plane);
        if (std::abs(away) <= 1) add(line.node[away < 0 ? DEPTH + 1 : away], weight[j]);
      }
    }
  } else if (k < nlines + ncrossings) {
    const Crossing &crossing = list.crossings[k - nlines];
    MathExtra::copy3(crossing.normal, normal);
    for (int j = 0; j < crossing.n; j++) add(crossing.node[j], crossing.weight[j]);
  } else if (const int nsingles = (int) list.singles.size(); k < nlines + ncrossings + nsingles) {
    const Single &single = list.singles[k - nlines - ncrossings];
    MathExtra::copy3(single.normal, normal);
    add(single.node, 1.0);
  } else {
    const Approach &line = list.approaches[k - nlines - ncrossings - nsingles];
    MathExtra::copy3(line.normal, normal);
    for (int j = 0; j < line.n; j++) add(line.node[j], line.weight[j]);
  }
  for (int j = 0; j < n; j++) held[j].share /= all;
  return n;
}

/** Motion of the surface along the wall, and away from it, relative to the motion of the wall in this time. */
void FixMPMBoundary::find_slip(const Held *held, int n, const double *normal, const double *u,
                               double time, double *slip, double &away) const
{
  const int dim = tried->grid.lattice.dim;
  MathExtra::zero3(slip);
  for (int j = 0; j < n; j++) {
    double V[3] = {0.0, 0.0, 0.0};
    if (time > 0.0) wall.velocity(*tried, held[j].node, V);
    for (int d = 0; d < dim; d++)
      slip[d] += held[j].share * (u[dim * held[j].node + d] - time * V[d]);
  }
  away = MathExtra::dot3(slip, normal);
  for (int d = 0; d < 3; d++) slip[d] -= away * normal[d];
}

/** Calls use(touch, nodes, n, normal) for all contacts that are held. */
template <class Use> void FixMPMBoundary::visit_touches(const Use &use)
{
  const FieldNodes &list = tried_nodes();
  Held held[4];
  double normal[3];
  for (std::size_t k = 0; k < touches.size(); k++) {
    if (!touches[k].active) continue;
    const int n = find_held(list, (int) k, held, normal);
    if (n) use(touches[k], held, n, normal);
  }
}

/* ---------------------------------------------------------------------- */

void FixMPMBoundary::add_friction(const double *u, double *force)
{
  const int dim = tried->grid.lattice.dim;
  if (friction == 0.0) return;
  const double width = std::max(eps, soft);
  visit_touches([&](Touch &touch, const Held *held, int n, const double *normal) {
    double away;
    find_slip(held, n, normal, u, trial_slip_time, touch.slip, away);
    MathExtra::zero3(touch.rubs);
    if (!(touch.force > 0.0)) return;
    const double length = std::sqrt(MathExtra::lensq3(touch.slip) + width * width);
    for (int d = 0; d < dim; d++) {
      touch.rubs[d] = -friction * touch.force * touch.slip[d] / length;
      for (int j = 0; j < n; j++) force[dim * held[j].node + d] += held[j].share * touch.rubs[d];
    }
  });
}

/* ----------------------------------------------------------------------
   Where a line reverses its slip, friction changes its sign within a distance of eps, which a derivative taken farther away does not
   show: Newton's method would oscillate. Therefore w = s/l, l = (|s|^2 + eps^2)^(1/2), is an unknown of its own, and
   l w = s is linearized:

     l dw + w s.ds/l = s + ds - l w

   so that friction changes as -mu N (ds - w s.ds/l)/l. This is stiff as long as w, which is a little shorter than one, does not
   have the direction of s, and never quite soft
   (T.F. Chan, G.H. Golub, P. Mulet, SIAM J. Sci. Comput. 20 (1999) 1964, for other sums of lengths).
------------------------------------------------------------------------- */

/** Change of direction for a change ds of the slip: (ds - w s.ds/l)/l. */
void FixMPMBoundary::change_of_direction(const Touch &touch, const double *slip,
                                         double *change) const
{
  const double width = std::max(eps, soft),
               length = std::sqrt(MathExtra::lensq3(touch.slip) + width * width),
               along = MathExtra::dot3(touch.slip, slip) / length;
  for (int d = 0; d < 3; d++) change[d] = (slip[d] - along * touch.dual[d]) / length;
}

void FixMPMBoundary::add_friction_change(const double *du, double scale, double *dforce)
{
  const int dim = tried->grid.lattice.dim;
  if (friction == 0.0) return;
  const double width = std::max(eps, soft);
  visit_touches([&](Touch &touch, const Held *held, int n, const double *normal) {
    if (!(touch.force > 0.0)) return;
    double slip[3], turn[3], away;
    find_slip(held, n, normal, du, 0.0, slip, away);
    change_of_direction(touch, slip, turn);
    const double length = std::sqrt(MathExtra::lensq3(touch.slip) + width * width),
                 more = (touch.push - touch.base) / scale;
    for (int d = 0; d < dim; d++) {
      const double change = -friction * (more * touch.slip[d] / length + touch.force * turn[d]);
      for (int j = 0; j < n; j++) dforce[dim * held[j].node + d] += held[j].share * change;
    }
  });
}

void FixMPMBoundary::correct(const double *du)
{
  if (friction == 0.0) return;
  const double width = std::max(eps, soft);
  visit_touches([&](Touch &touch, const Held *held, int n, const double *normal) {
    double slip[3], turn[3], away;
    find_slip(held, n, normal, du, 0.0, slip, away);
    change_of_direction(touch, slip, turn);
    double *const w = touch.dual;
    const double length = std::sqrt(MathExtra::lensq3(touch.slip) + width * width);
    for (int d = 0; d < 3; d++) w[d] = touch.slip[d] / length + turn[d];
    const double size = MathExtra::len3(w);
    if (size > LONGEST) MathExtra::scale3(LONGEST / size, w);
  });
}

void FixMPMBoundary::add_friction_blocks(double *blocks)
{
  const int dim = tried->grid.lattice.dim;
  if (friction == 0.0) return;
  visit_touches([&](Touch &touch, const Held *held, int n, const double *normal) {
    if (!(touch.force > 0.0)) return;
    double along[3] = {0.0, 0.0, 0.0}, turn[3];
    const double slope = friction * touch.force;
    for (int e = 0; e < dim; e++) {
      for (int d = 0; d < 3; d++) along[d] = (d == e) - normal[d] * normal[e];
      change_of_direction(touch, along, turn);
      for (int j = 0; j < n; j++)
        for (int d = 0; d < dim; d++)
          blocks[dim * dim * held[j].node + dim * d + e] +=
              held[j].share * held[j].share * slope * turn[d];
    }
  });
}

void FixMPMBoundary::add_friction_stiffness(double *stiffness)
{
  if (friction == 0.0) return;
  visit_touches([&](Touch &touch, const Held *held, int n, const double *) {
    if (!(touch.force > 0.0)) return;
    double turn[3];
    change_of_direction(touch, touch.slip, turn);
    const double size = MathExtra::lensq3(touch.slip),
                 length = std::sqrt(size + std::max(eps, soft) * std::max(eps, soft)),
                 along = size > 0.0 ? MathExtra::dot3(turn, touch.slip) / size : 1.0 / length;
    for (int j = 0; j < n; j++)
      stiffness[held[j].node] += held[j].share * friction * touch.force * along;
  });
}

/* ---------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   At first, everything that is wrong is changed. If this oscillates, only the worst half is changed, and what is almost right stays
------------------------------------------------------------------------- */

bool FixMPMBoundary::decide(const double *u, double unbalanced)
{
  if (kind != SEPARATE || unbalanced > 0.0) return false;
  const FieldNodes &list = tried_nodes();
  const double h = tried->lattice.h;
  double mine = 0.0, largest, worst;
  for (const auto &touch : touches)
    if (touch.active) mine = std::max(mine, std::fabs(touch.force));
  MPI_Allreduce(&mine, &largest, 1, MPI_DOUBLE, MPI_MAX, world);
  Held held[4];
  double normal[3], slip[3], away;
  std::vector<double> wrong(touches.size(), 0.0);
  mine = 0.0;
  for (std::size_t k = 0; k < touches.size(); k++) {
    const Touch &touch = touches[k];
    if (!touch.open) continue;
    const int n = find_held(list, (int) k, held, normal);
    if (!n) continue;
    if (touch.active) {
      wrong[k] = largest > 0.0 ? -touch.force / largest : 0.0;
    } else {
      find_slip(held, n, normal, u, trial_dt, slip, away);
      wrong[k] = (-away - touch.gap) / h;
    }
    mine = std::max(mine, wrong[k]);
  }
  MPI_Allreduce(&mine, &worst, 1, MPI_DOUBLE, MPI_MAX, world);
  const bool all = rounds++ < AT_ONCE;
  if (worst <= (all ? WRONG : STILL_RIGHT)) return false;
  bool changed = false;
  for (std::size_t k = 0; k < touches.size(); k++) {
    if (wrong[k] <= (all ? WRONG : 0.5 * worst)) continue;
    touches[k].active = !touches[k].active;
    changed = true;
  }
  return changed;
}

/* ----------------------------------------------------------------------
   friction at the end of the step, before walls act; its work is that with the final velocities of the nodes
------------------------------------------------------------------------- */

void FixMPMBoundary::rub_nodes(Grid &grid)
{
  const int dim = grid.lattice.dim;
  if (friction == 0.0) return;
  visit_touches([&](Touch &touch, const Held *held, int n, const double *) {
    for (int j = 0; j < n; j++) {
      const int64_t node = held[j].node;
      const double *const record = grid.record(node);
      double V[3], v[3] = {0.0, 0.0, 0.0}, whole[3] = {0.0, 0.0, 0.0};
      wall.velocity(*tried, node, V);
      for (int d = 0; d < dim; d++) {
        v[d] = record[d] + rub_share * trial_dt * held[j].share * touch.rubs[d] / record[3];
        whole[d] = motion[dim * node + d];
      }
      set_velocity(grid, node, V, v, nullptr, whole);
    }
  });
}
