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
// when points are in reach of its outermost node, but for nodes that reach less than 0.5 (linear), 0.2
// or 0.3 of a cell into the box (MIN_WEIGHT). Where no point reaches a linear function's outer node,
// the two next ones are extrapolated to it. Friction, separation and the old velocities of FLIP are as
// at mirror planes.
//
// Regions that separate have such lines, too, through their surface (list_crossings()): what acts on nodes
// one by one acts below the surface, by up to a spacing, and friction has another lever arm there.

#include "fix_mpm_boundary.h"

#include "mpm_field.h"
#include "mpm_stencil.h"

#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// of linear, quadratic and cubic functions
static constexpr double MIN_WEIGHT[4] = {0.0, 0.5, 0.02, 0.0045};

/* ---------------------------------------------------------------------- */

/** Of the place x along an axis: the nodes, from the first one on, that make the velocity there. */
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
   n nodes in the order along the axis, inward: 1 if the material is behind the last one. False where no
   point reaches the wall
------------------------------------------------------------------------- */

bool FixMPMBoundary::find_chain(const FieldNodes &list, const int64_t *node, const double *weight,
                                int n, int inward, Chain &c) const
{
  Grid &grid = list.field->grid;
  const int order = stencil_order(list.field->options.shape);
  double extrapolated = 0.0;
  bool reached = false;
  for (int j = 0; j < n; j++) {
    const int k = inward > 0 ? j : n - 1 - j;
    const double *record = node[k] < 0 ? nullptr : grid.record(node[k]);
    const bool matters = weight[k] >= MIN_WEIGHT[order];
    if (!record || record[3] <= 0.0) {
      if (!reached && matters) return false;
      if (order == 1 && j == 0) extrapolated = weight[k];
      continue;
    }
    reached = reached || matters;
    c.node[c.m] = node[k];
    c.r[c.m] = record;
    c.A[c.m] = weight[k];
    c.total += weight[k];
    wall.velocity(*list.field, node[k], c.V[c.m]);
    c.m++;
  }
  if (!reached) return false;
  if (extrapolated > 0.0 && c.m == 2) {
    c.A[0] += 2.0 * extrapolated;
    c.A[1] -= extrapolated;
    c.total += extrapolated;
  }
  if (c.m == n) {
    c.B[0] = c.B[2] = 1.0;
    c.B[1] = -2.0;
  }
  for (int k = 0; k < c.m; k++) {
    c.AA += c.A[k] * c.A[k] / c.r[k][3];
    c.AB += c.A[k] * c.B[k] / c.r[k][3];
    c.BB += c.B[k] * c.B[k] / c.r[k][3];
  }
  return true;
}

/** What takes velocities relative to the wall away. */
void FixMPMBoundary::Chain::solve(const double *relative, double &lambda, double &mu) const
{
  double a_sum = 0.0, b_sum = 0.0;
  for (int k = 0; k < m; k++) {
    a_sum -= A[k] * relative[k];
    b_sum -= B[k] * relative[k];
  }
  const double det = AA * BB - AB * AB;
  lambda = BB > 0.0 ? (BB * a_sum - AB * b_sum) / det : a_sum / AA;
  mu = BB > 0.0 ? (AA * b_sum - AB * a_sum) / det : 0.0;
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
  const double *const *const r = chain.r, *const A = chain.A, *const B = chain.B;
  const auto &V = chain.V;
  const double total = chain.total;

  // of old velocities as much is consistent with the wall as the innermost node has, see
  // fix_mpm_boundary.cpp

  // components that stick prescribes now
  const auto prescribed = [&](int d) {
    return velocity[d].given && (d == a) == last;
  };
  double lambda[3] = {0.0, 0.0, 0.0}, mu[3], lambda_old[3] = {0.0, 0.0, 0.0},
         mu_old[3] = {0.0, 0.0, 0.0};
  double relative[4];    // of the nodes to the wall
  for (int d = 0; d < dim; d++) {
    for (int k = 0; k < m; k++) relative[k] = r[k][d] - V[k][d];
    chain.solve(relative, lambda[d], mu[d]);
    if (!hold || !(kind == STICK ? prescribed(d) : d == a)) continue;
    const double limit = fabs(r[m - 1][4 + d] - wall.before[d]);
    for (int k = 0; k < m; k++) relative[k] = wall.old_relative(r[k], d, limit);
    chain.solve(relative, lambda_old[d], mu_old[d]);
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
    const double slide = slide_share(cut.contact, push, total * sqrt(needed));
    if (cut.contact == FREE) return;
    for (int d = 0; d < dim; d++) share[d] = d == a ? 1.0 : slide;
  }

  for (int k = 0; k < m; k++) {
    double v[3], old[3];
    for (int d = 0; d < dim; d++) {
      v[d] = r[k][d] + share[d] * (lambda[d] * A[k] + mu[d] * B[k]) / r[k][3];
      if (hold) old[d] = r[k][4 + d] + (lambda_old[d] * A[k] + mu_old[d] * B[k]) / r[k][3];
    }
    set_velocity(grid, chain.node[k], V[k], v, hold ? old : nullptr);
  }
}

/* ----------------------------------------------------------------------
   Normal and tangential part of the impulse at the surface of a region, whose normal need not be along
   the line
------------------------------------------------------------------------- */

void FixMPMBoundary::act_on_crossing(const FieldNodes &list, Crossing &crossing)
{
  Grid &grid = list.field->grid;
  const int dim = grid.lattice.dim;
  const double *const n = crossing.normal;
  if (crossing.front != Crossing::SOUND) {
    if (!now.decided)
      crossing.acts = crossing.front == Crossing::THIN_PLACE ? !is_behind(grid, crossing, 1.0)
                                                             : is_in_front(grid, crossing);
    if (!crossing.acts) return;
    if (crossing.front == Crossing::NEAR_OTHERS)
      held_by_lines.insert(held_by_lines.end(), crossing.node, crossing.node + crossing.inside);
  }
  Chain chain;
  if (!find_chain(list, crossing.node, crossing.weight, crossing.n, 1, chain)) return;

  double lambda[3] = {0.0, 0.0, 0.0}, mu[3] = {0.0, 0.0, 0.0}, normal[2] = {0.0, 0.0};
  for (int d = 0; d < dim; d++) {
    double relative[4];
    for (int k = 0; k < chain.m; k++) relative[k] = chain.r[k][d] - chain.V[k][d];
    chain.solve(relative, lambda[d], mu[d]);
    normal[0] += lambda[d] * n[d];
    normal[1] += mu[d] * n[d];
  }
  double needed = 0.0;
  for (int d = 0; d < dim; d++) {
    const double slide = lambda[d] - normal[0] * n[d];
    needed += slide * slide;
  }
  const double push = crossing.touched ? chain.total * normal[0] : 0.0;
  const double share = slide_share(crossing.contact, push, chain.total * sqrt(needed));
  if (crossing.contact == FREE) return;
  for (int d = 0; d < dim; d++) {
    lambda[d] = normal[0] * n[d] + share * (lambda[d] - normal[0] * n[d]);
    mu[d] = normal[1] * n[d] + share * (mu[d] - normal[1] * n[d]);
  }
  for (int k = 0; k < chain.m; k++) {
    double v[3];
    for (int d = 0; d < dim; d++)
      v[d] = chain.r[k][d] + (lambda[d] * chain.A[k] + mu[d] * chain.B[k]) / chain.r[k][3];
    count_moment(grid, chain.node[k], chain.r[k], v);
    set_velocity(grid, chain.node[k], chain.V[k], v, nullptr);
  }
}
