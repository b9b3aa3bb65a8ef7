/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Where a wall cuts cells, the material at the wall, on a line of nodes along the normal, has the
// velocity V of the wall when
//   sum_i a_i (v_i - V_i) = 0,  a_i = N_i(wall).
// A node that only points right at the wall reach could do that alone. Therefore the three
// outermost nodes must also have no curvature, b = (1, -2, 1): sum_i b_i (v_i - V_i) = 0, as with
// mirror images. The change of velocities of least kinetic energy that does both is
//   v_i += (lambda a_i + mu b_i)/m_i,
// whose impulse is lambda sum_i a_i. A wall acts when points are in reach of its outermost node,
// except for nodes that reach less than 0.5 (linear), 0.2 or 0.3 of a cell into the box
// (MIN_WEIGHT). Where no point reaches a linear function's outer node, its velocity is extrapolated
// from the two next ones.

#include "walls/mpm_line_constraint.h"

#include "field/mpm_field.h"
#include "field/mpm_stencil.h"
#include "walls/mpm_wall.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// of linear, quadratic and cubic functions
static constexpr double MIN_WEIGHT[4] = {0.0, 0.5, 0.02, 0.0045};
static constexpr double OUTSIDE = 0.25;      // node spacings
static constexpr double AT_NODE = 1.0e-6;    // node spacings
static constexpr double LIGHT = 1.0e-3;      // mass of a node over that of another one

int MPMLineConstraint::weights_at(const MPMField &field, int axis, int inward, double x, int &first,
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

bool MPMLineConstraint::find(const MPMWall &wall, MPMField &field, const NodeLine &line, int inward,
                             double least)
{
  *this = MPMLineConstraint();
  Grid &grid = field.grid;
  const int order = stencil_order(field.options.shape);
  const bool keeps = wall.keeps_distance();
  // weights of outer nodes without mass, and these times spacings from the first one with mass
  double extrapolated = 0.0, levers = 0.0;
  int first = 0;
  // nodes see points with a size that reach into the next cell, and no farther
  const bool sized = field.options.has_size();
  double place = 0.0;    // position of the wall, in nodes from the outermost one
  for (int j = 0; j < line.n; j++) place += j * line.weight[inward > 0 ? j : line.n - 1 - j];
  bool reached = false;
  for (int j = 0; j < line.n; j++) {
    const int k = inward > 0 ? j : line.n - 1 - j;
    const double *r = line.node[k] < 0 ? nullptr : grid.record(line.node[k]);
    const bool beyond = sized && place - j > 1.0 - AT_NODE;
    const bool matters = line.weight[k] >= MIN_WEIGHT[order] && !beyond;
    if (!r || r[3] <= least) {
      if (!reached && matters && !keeps && !wall.by_distance) return false;
      if (n == 0 && (keeps || beyond || wall.by_distance || (order == 1 && j == 0))) {
        extrapolated += line.weight[k];
        levers -= j * line.weight[k];
      }
      continue;
    }
    reached = reached || matters;
    if (n == 0) first = j;
    node[n] = line.node[k];
    record[n] = r;
    A[n] = line.weight[k];
    total += line.weight[k];
    wall.motion.velocity(grid, line.node[k], V[n]);
    n++;
  }
  if (keeps ? n == 0 || first - place > OUTSIDE : !reached) return false;
  // no node with a part in the velocity at the wall has mass
  if (total + extrapolated == 0.0) return false;
  if (extrapolated > 0.0) {
    levers += first * extrapolated;
    if (keeps || n == 2) {
      A[0] += extrapolated;
      total += extrapolated;
      if (n > 1) {
        A[0] += levers;
        A[1] -= levers;
      }
    }
  }
  // linear functions with the wall on a node do not involve the next ones, as at a mirror plane
  const bool at_node =
      order == 1 && *std::max_element(line.weight, line.weight + line.n) > 1.0 - AT_NODE;
  inner = n - 1;
  if (at_node) inner = std::min(inner, (int) (std::max_element(A, A + n) - A) + 1);
  prepare(n == line.n && !at_node);
  return true;
}

double MPMLineConstraint::part_of_light(double mass, double heavy)
{
  return heavy > 0.0 ? std::min(1.0, mass / (LIGHT * heavy)) : 1.0;
}

/** Points that end in a plane of nodes but for round-off give the nodes beyond it a mass of
 *  round-off, with any velocity. */
double MPMLineConstraint::limit_of_old(const double *relative) const
{
  double limit = std::fabs(relative[0]);
  for (int k = 1; k <= inner; k++)
    limit += part_of_light(record[k][3], heaviest) * (std::fabs(relative[k]) - limit);
  return limit;
}

/** With inverse masses w, and D_jk = A_j B_k - A_k B_j (Lagrange's identity, which does not lose
 *  light nodes among heavy ones),
 *
 *    det = sum_{j<k} w_j w_k D_jk^2,  lambda = -sum_i w_i B_i sum_j D_ji r_j/det,
 *    change of v_k: w_k sum_i w_i D_ik sum_j D_ji r_j/det */
void MPMLineConstraint::prepare(bool all)
{
  straight = all;
  if (straight) {
    B[0] = B[2] = 1.0;
    B[1] = -2.0;
  }
  heaviest = 0.0;
  for (int k = 0; k < n; k++) heaviest = std::max(heaviest, record[k][3]);
  AA = det = 0.0;
  for (int k = 0; k < n; k++) {
    inverse[k] = heaviest / record[k][3];
    AA += A[k] * A[k] * inverse[k];
    for (int j = 0; j < k; j++) det += inverse[j] * inverse[k] * D(j, k) * D(j, k);
  }
}

double MPMLineConstraint::solve(const double *relative, double *change) const
{
  double lambda = 0.0;
  if (!straight) {
    for (int k = 0; k < n; k++) lambda -= A[k] * relative[k] / AA;
    for (int k = 0; k < n; k++) change[k] = lambda * A[k] * inverse[k];
    return lambda * heaviest;
  }
  for (int k = 0; k < n; k++) change[k] = 0.0;
  for (int i = 0; i < n; i++) {
    double sum = 0.0;
    for (int j = 0; j < n; j++) sum += D(j, i) * relative[j];
    sum *= inverse[i] / det;
    lambda -= B[i] * sum;
    for (int k = 0; k < n; k++) change[k] += inverse[k] * D(i, k) * sum;
  }
  return lambda * heaviest;
}
