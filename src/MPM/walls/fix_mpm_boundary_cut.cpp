/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Faces of the box that cut cells: they lie between planes of nodes, so that nodes have no mirror
// images. The velocity at the face, at the lateral position of a line of nodes along the normal, is
// sum_i a_i v_i, a_i = N_i(face), and the material at the face has the velocity V of the wall when
//   sum_i a_i (v_i - V_i) = 0
// for each line. A node that only points right at the face reach could alone do that, with a large
// velocity that other points do not feel, and the body would creep into the wall. Therefore the three
// outermost nodes must also have no curvature, b = (1, -2, 1):
//   sum_i b_i (v_i - V_i) = 0,
// as the mirror images do at a plane. The change of velocities of least kinetic energy that does both,
//   v_i += (lambda a_i + mu b_i)/m_i,
// leaves alone what varies linearly from V at the face. Its impulse is lambda sum_i a_i. A wall acts
// when points are in reach of its outermost node, except for nodes that reach less than 0.5 (linear), 0.2
// or 0.3 of a cell into the box (MIN_WEIGHT). Where no point reaches a linear function's outer node,
// its velocity is extrapolated from the two next ones. Friction, separation and the old velocities of FLIP
// are as at mirror planes.
//
// Regions that separate have such lines, too, through their surface (list_crossings()): a wall that acts on
// nodes one by one acts below the surface, by up to a spacing, and friction has another lever arm there.

#include "walls/fix_mpm_boundary.h"

#include "field/mpm_field.h"
#include "field/mpm_stencil.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// of linear, quadratic and cubic functions
static constexpr double MIN_WEIGHT[4] = {0.0, 0.5, 0.02, 0.0045};
static constexpr double OUTSIDE = 0.25;      // node spacings
static constexpr double AT_NODE = 1.0e-6;    // node spacings
static constexpr double HEAVY = 0.500001;    // share of one node in the mass of mirror images

/* ---------------------------------------------------------------------- */

/** The nodes, from the first one on, and their weights that make the velocity at the place x along an axis; returns their number. */
int FixMPMBoundary::weights_at(const MPMField &field, int axis, int inward, double x, int &first,
                               double *weight)
{
  const int n =
      MPMStencil(field).weights((x - field.lattice.origin[axis]) / field.lattice.h, first, weight);
  if (stencil_order(field.options.shape) > 1) return n;
  weight[2] = 0.0;    // and the next node inside
  if (inward > 0) return 3;
  first--;
  weight[2] = weight[1];
  weight[1] = weight[0];
  weight[0] = 0.0;
  return 3;
}

void FixMPMBoundary::Face::cut_weights(const MPMField &field, double x)
{
  cut = true;
  nweight = weights_at(field, axis, inward, x, first, weight);
}

/* ----------------------------------------------------------------------
   n nodes in the order along the axis, inward: 1 if the material is behind the last one. Returns false where
   no point reaches the wall
------------------------------------------------------------------------- */

bool FixMPMBoundary::find_chain(const FieldNodes &list, const int64_t *node, const double *weight,
                                int n, int inward, Chain &c, double least) const
{
  Grid &grid = list.field->grid;
  const int order = stencil_order(list.field->options.shape);
  const bool keeps = keeps_distance();
  double
      extrapolated = 0.0,
      levers =
          0.0;    // weights of outer nodes without mass, times spacings from the first one with mass
  int first = 0;
  double place = 0.0;    // position of the wall, in nodes from the outermost one
  bool reached = false;
  for (int j = 0; j < n; j++) {
    const int k = inward > 0 ? j : n - 1 - j;
    const double *record = node[k] < 0 ? nullptr : grid.record(node[k]);
    const bool matters = weight[k] >= MIN_WEIGHT[order];
    place += j * weight[k];
    if (!record || record[3] <= least) {
      if (!reached && matters && !keeps) return false;
      if (c.m == 0 && (keeps || (order == 1 && j == 0))) {
        extrapolated += weight[k];
        levers -= j * weight[k];
      }
      continue;
    }
    reached = reached || matters;
    if (c.m == 0) first = j;
    c.node[c.m] = node[k];
    c.r[c.m] = record;
    c.A[c.m] = weight[k];
    c.total += weight[k];
    wall.velocity(*list.field, node[k], c.V[c.m]);
    c.m++;
  }
  if (keeps ? c.m == 0 || first - place > OUTSIDE : !reached) return false;
  // no node with a part in the velocity at the wall has mass
  if (c.total + extrapolated == 0.0) return false;
  if (extrapolated > 0.0) {
    levers += first * extrapolated;
    if (keeps || c.m == 2) {
      c.A[0] += extrapolated;
      c.total += extrapolated;
      if (c.m > 1) {
        c.A[0] += levers;
        c.A[1] -= levers;
      }
    }
  }
  // linear functions with the wall on a node do not involve the next ones, as at a mirror plane
  const bool at_node = order == 1 && *std::max_element(weight, weight + n) > 1.0 - AT_NODE;
  c.inner = c.m - 1;
  if (at_node) c.inner = std::min(c.inner, (int) (std::max_element(c.A, c.A + c.m) - c.A) + 1);
  c.prepare(c.m == n && !at_node);
  return true;
}

/* ----------------------------------------------------------------------
   The change of least kinetic energy that removes velocities r relative to the wall, and the
   impulse lambda that belongs to A. With inverse masses w, and AB = sum_k w_k A_k B_k,

     lambda = -(BB sum_j A_j r_j - AB sum_j B_j r_j)/det,  det = AA BB - AB^2

   A node at the very end of the functions of points has 1e-30 of the mass of its neighbors. Its terms would
   drown those of the neighbors in AA, AB, and BB: det would be noise, or zero, and with it the velocities of all
   nodes. With D_jk = A_j B_k - A_k B_j (Lagrange's identity) only terms of pairs of nodes remain:

     det = sum_{j<k} w_j w_k D_jk^2,  lambda = -sum_i w_i B_i sum_j D_ji r_j/det,
     change of v_k: w_k sum_i w_i D_ik sum_j D_ji r_j/det
------------------------------------------------------------------------- */

void FixMPMBoundary::Chain::prepare(bool all)
{
  straight = all;
  if (straight) {
    B[0] = B[2] = 1.0;
    B[1] = -2.0;
  }
  heaviest = 0.0;
  for (int k = 0; k < m; k++) heaviest = std::max(heaviest, r[k][3]);
  AA = det = 0.0;
  for (int k = 0; k < m; k++) {
    inverse[k] = heaviest / r[k][3];
    AA += A[k] * A[k] * inverse[k];
    for (int j = 0; j < k; j++) det += inverse[j] * inverse[k] * D(j, k) * D(j, k);
  }
}

double FixMPMBoundary::Chain::solve(const double *relative, double *change) const
{
  double lambda = 0.0;
  if (!straight) {
    for (int k = 0; k < m; k++) lambda -= A[k] * relative[k] / AA;
    for (int k = 0; k < m; k++) change[k] = lambda * A[k] * inverse[k];
    return lambda * heaviest;
  }
  for (int k = 0; k < m; k++) change[k] = 0.0;
  for (int i = 0; i < m; i++) {
    double sum = 0.0;
    for (int j = 0; j < m; j++) sum += D(j, i) * relative[j];
    sum *= inverse[i] / det;
    lambda -= B[i] * sum;
    for (int k = 0; k < m; k++) change[k] += inverse[k] * D(i, k) * sum;
  }
  return lambda * heaviest;
}

/* ---------------------------------------------------------------------- */

void FixMPMBoundary::act_on_cut(const FieldNodes &list, Line &cut, bool last)
{
  Grid &grid = list.field->grid;
  const Face &face = list.faces[cut.face];
  const int dim = grid.lattice.dim, a = face.axis;
  const bool hold = now.old_share > 0.0 && (kind == STICK || (kind == SLIP && !last));
  if (last && kind != STICK && cut.contact == FREE) return;

  Chain chain;
  if (!find_chain(list, cut.node, face.weight, face.nweight, face.inward, chain)) return;
  const int m = chain.m;
  const double *const *const r = chain.r;
  const auto &V = chain.V;
  const double total = chain.total;

  // old velocities are consistent with the wall up to the value at the innermost node, see
  // fix_mpm_boundary.cpp

  // components that stick prescribes in this pass
  const auto prescribed = [&](int d) {
    return velocity[d].given && (d == a) == last;
  };
  const double normal[3] = {(double) (a == 0), (double) (a == 1), (double) (a == 2)};
  double lambda[3] = {0.0, 0.0, 0.0}, lambda_old[3] = {0.0, 0.0, 0.0};
  double change[3][4], change_old[3][4] = {};
  double relative[4];    // velocities of the nodes relative to the wall
  for (int d = 0; d < dim; d++) {
    for (int k = 0; k < m; k++) relative[k] = r[k][d] - V[k][d];
    lambda[d] = chain.solve(relative, change[d]);
    if (!hold || !(kind == STICK ? prescribed(d) : d == a)) continue;
    const double limit = fabs(r[chain.inner][4 + d] - wall.before[d]);
    for (int k = 0; k < m; k++) relative[k] = wall.old_relative(r[k], d, limit);
    lambda_old[d] = chain.solve(relative, change_old[d]);
  }

  double share[3] = {0.0, 0.0, 0.0};
  if (kind == STICK) {
    for (int d = 0; d < dim; d++) share[d] = prescribed(d) ? 1.0 : 0.0;
  } else if (last) {
    share[a] = 1.0;
  } else {
    const double push =
        cut.touched ? face.inward * total * (lambda[a] - now.old_share * lambda_old[a]) : 0.0;
    double needed = 0.0;
    for (int d = 0; d < dim; d++)
      if (d != a) needed += lambda[d] * lambda[d];
    double inward[3] = {0.0, 0.0, 0.0};
    inward[a] = face.inward;
    const double of_water = cut.touched ? water_on(chain.node, m, inward) : 0.0;
    const double slide = slide_share(cut.contact, push, of_water, total * sqrt(needed));
    if (cut.contact == FREE) {
      for (int k = 0; k < m && of_water > 0.0; k++) push_by_water(grid, chain.node[k], inward);
      return;
    }
    for (int d = 0; d < dim; d++) share[d] = d == a ? 1.0 : slide;
    heat_if_sliding(cut.contact, normal);
  }

  for (int k = 0; k < m; k++) {
    double v[3], old[3];
    for (int d = 0; d < dim; d++) {
      v[d] = r[k][d] + share[d] * change[d][k];
      if (hold) old[d] = r[k][4 + d] + change_old[d][k];
    }
    set_velocity(grid, chain.node[k], V[k], v, hold ? old : nullptr);
  }
  now.normal = nullptr;
}

/** Does the line act in this step? If so, the nodes inside do not act on their own, unless this is known from the start. */
bool FixMPMBoundary::decide_line(Grid &grid, Crossing &c)
{
  const bool to_surface = holds_surface();
  if (c.front == Crossing::SOUND && !to_surface) return true;
  if (!now.decided) c.acts = holds_line(grid, c);
  if (!c.acts) return false;
  if (c.front == Crossing::NEAR_OTHERS || to_surface) {
    // nodes outside act, too, where a moving region hands them over
    const bool all = follows || (to_surface && region_moves());
    held_by_lines.insert(held_by_lines.end(), c.node, c.node + (all ? c.n : c.inside));
  }
  return true;
}

/* ----------------------------------------------------------------------
   Normal and tangential part of the impulse at the surface of a region, whose normal may be inclined
   to the line
------------------------------------------------------------------------- */

void FixMPMBoundary::act_on_crossing(const FieldNodes &list, Crossing &crossing)
{
  Grid &grid = list.field->grid;
  const int dim = grid.lattice.dim;
  const double *const n = crossing.normal;
  const bool to_surface = holds_surface();
  if (!decide_line(grid, crossing)) return;
  Chain chain;
  if (!find_chain(list, crossing.node, crossing.weight, crossing.n, 1, chain)) return;

  double lambda[3] = {0.0, 0.0, 0.0}, change[3][4], normal = 0.0, relative[4];
  for (int d = 0; d < dim; d++) {
    for (int k = 0; k < chain.m; k++) relative[k] = chain.r[k][d] - chain.V[k][d];
    lambda[d] = chain.solve(relative, change[d]);
    normal += lambda[d] * n[d];
  }

  // components of old velocities that FLIP updates, as at faces: all that stick prescribes, or the normal ones

  const bool hold = now.old_share > 0.0 && to_surface;
  double change_old[3][4] = {};
  if (hold) {
    double old[3][4] = {}, along[4] = {};
    for (int k = 0; k < chain.m; k++)
      for (int d = 0; d < dim; d++) {
        old[d][k] = chain.r[k][4 + d] - wall.before[d];
        along[k] += n[d] * old[d][k];
      }
    const auto take_away = [&](const double *of, double *by) {
      const double limit = fabs(of[chain.inner]);
      for (int k = 0; k < chain.m; k++) relative[k] = std::max(-limit, std::min(of[k], limit));
      chain.solve(relative, by);
    };
    if (kind == STICK) {
      for (int d = 0; d < dim; d++)
        if (velocity[d].given) take_away(old[d], change_old[d]);
    } else {
      double by[4];
      take_away(along, by);
      for (int d = 0; d < dim; d++)
        for (int k = 0; k < chain.m; k++) change_old[d][k] = by[k] * n[d];
    }
  }

  double needed = 0.0;
  for (int d = 0; d < dim; d++) {
    const double slide = lambda[d] - normal * n[d];
    needed += slide * slide;
  }
  const double push = crossing.touched ? chain.total * normal : 0.0;
  const double of_water = crossing.touched ? water_on(chain.node, chain.m, n) : 0.0;
  const double share = slide_share(crossing.contact, push, of_water, chain.total * sqrt(needed));
  if (crossing.contact == FREE) {
    for (int k = 0; k < chain.m && of_water > 0.0; k++) push_by_water(grid, chain.node[k], n);
    return;
  }
  heat_if_sliding(crossing.contact, n);
  for (int k = 0; k < chain.m; k++) {
    double v[3], old[3], along = 0.0;
    for (int d = 0; d < dim; d++) along += change[d][k] * n[d];
    for (int d = 0; d < dim; d++) {
      v[d] = chain.r[k][d] + along * n[d] + share * (change[d][k] - along * n[d]);
      if (kind == STICK && !velocity[d].given) v[d] = chain.r[k][d];
      if (hold) old[d] = chain.r[k][4 + d] + change_old[d][k];
    }
    set_velocity(grid, chain.node[k], chain.V[k], v, hold ? old : nullptr);
  }
  now.normal = nullptr;
}

/* ----------------------------------------------------------------------
   lists lines through surfaces and faces, and mirror images. Images with a heavy node go to others, as most of the mass
   is in that node
------------------------------------------------------------------------- */

void FixMPMBoundary::list_ties(const MPMField &field, std::vector<int64_t> &ties,
                               std::vector<int64_t> &others) const
{
  const auto add = [](std::vector<int64_t> &to, const int64_t *node, int64_t n) {
    to.push_back(n);
    to.insert(to.end(), node, node + n);
  };
  for (const auto &list : nodes) {
    if (list.field != &field) continue;
    for (const auto &crossing : list.crossings) add(ties, crossing.node, crossing.n);
    for (const auto &knot : list.knots) add(ties, knot.node.data(), (int64_t) knot.node.size());
    for (const auto &approach : list.approaches) add(ties, approach.node, approach.n);
    for (const auto &line : list.lines) add(ties, line.node, list.faces[line.face].length());
    for (const auto &orbit : list.orbits) {
      double most = 0.0, sum = 0.0;
      for (int k = orbit.first; k < orbit.last; k++) {
        const double mass = list.field->grid.record(list.members[k].node)[3];
        most = std::max(most, mass);
        sum += mass;
      }
      auto &to = orbit.fixed || most > HEAVY * sum ? others : ties;
      to.push_back(orbit.last - orbit.first);
      for (int k = orbit.first; k < orbit.last; k++) to.push_back(list.members[k].node);
    }
  }
}
