/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Lines of nodes along two axes that share nodes act together, with the change of velocities of
// least kinetic energy that satisfies all of them (one after the other, they would not be a
// projection):
//
//   v_i += sum_r l_r c_ri n_r/m_i,  sum_s G_rs l_s = -sum_i c_ri n_r (v_i - V_i),
//   G_rs = sum_i c_ri c_si n_r n_s/m_i
//
// where each line has a row c = a and, when all of its nodes have mass, a row c = b
// (mpm_line_constraint.cpp). Eigenvectors of G, scaled to 1 on its diagonal, with small eigenvalues
// are left out. Where material sticks, each prescribed component has these equations with 1 in
// place of n_r.

#include "walls/mpm_crossing_lines.h"

#include "field/mpm_field.h"
#include "math/sets.h"
#include "math_extra.h"
#include "walls/mpm_line_constraint.h"
#include "walls/mpm_wall.h"
#include "walls/mpm_wall_reaction.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// cosine between normals up to which lines prescribe different components, or hold different
// material
static constexpr double CORNER = 0.1, BACK = -0.5;
static constexpr double LEAST = 1.0e-8;    // least mass of a node, relative to the heaviest one
static constexpr double SMALL = 1.0e-3;    // least eigenvalue

std::vector<MPMCoupledLines> MPMCoupledLines::find(std::vector<MPMCrossing> &lines, bool sticks)
{
  std::vector<MPMCoupledLines> found;
  const double apart = sticks ? BACK : CORNER;
  struct Use {
    int64_t node;
    int line;
  };
  std::vector<Use> uses;
  for (std::size_t k = 0; k < lines.size(); k++)
    for (int j = 0; j < lines[k].n; j++)
      if (lines[k].node[j] >= 0) uses.push_back({lines[k].node[j], (int) k});
  std::stable_sort(uses.begin(), uses.end(), [](const Use &a, const Use &b) {
    return a.node < b.node;
  });
  Sets sets(lines.size());
  for (auto first = uses.begin(), last = first; first != uses.end(); first = last) {
    while (last != uses.end() && last->node == first->node) last++;
    for (auto a = first; a != last; a++)
      for (auto b = a + 1; b != last; b++) {
        const MPMCrossing &one = lines[a->line], &other = lines[b->line];
        if (one.axis == other.axis || MathExtra::dot3(one.normal, other.normal) < apart) continue;
        sets.join(a->line, b->line);
      }
  }
  std::vector<int> size(lines.size(), 0), place(lines.size(), -1);
  for (std::size_t k = 0; k < lines.size(); k++) size[sets.root((int) k)]++;
  for (std::size_t k = 0; k < lines.size(); k++) {
    const int r = sets.root((int) k);
    if (size[r] < 2) continue;
    if (place[r] < 0) {
      place[r] = (int) found.size();
      found.emplace_back();
    }
    MPMCoupledLines &group = found[place[r]];
    group.lines.push_back((int) k);
    lines[k].coupled = true;
    for (int j = 0; j < lines[k].n; j++)
      if (lines[k].node[j] >= 0) group.nodes.push_back(lines[k].node[j]);
  }
  for (auto &group : found) {
    auto &nodes = group.nodes;
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
  return found;
}

/** Start of an act: the masses of nodes. Returns false if there is none. */
bool MPMCoupledLines::begin(MPMField &field)
{
  rows.clear();
  active.assign(lines.size(), 0.0);
  mass.resize(nodes.size());
  heaviest = 0.0;
  for (std::size_t i = 0; i < nodes.size(); i++)
    heaviest = std::max(heaviest, mass[i] = field.grid.record(nodes[i])[3]);
  return heaviest > 0.0;
}

/** Adds the equations of a line. */
void MPMCoupledLines::add_rows(std::size_t k, const MPMWallReaction &reaction, const MPMWall &wall,
                               MPMField &field, MPMCrossing &line)
{
  MPMLineConstraint constraint;
  if (!constraint.find(wall, field, line, 1, LEAST * heaviest)) return;
  line.state = MPMContactState::SLIDING;
  active[k] = 1.0;
  const int dim = field.lattice.dim;
  const bool hold = reaction.old_share() > 0.0, sticks = wall.kind == MPMWall::STICK;
  const double *const n = line.normal;
  double relative[3][NodeLine::MOST] = {}, old[3][NodeLine::MOST] = {};
  Row row = {};
  row.n = constraint.n;
  MathExtra::copy3(n, row.normal);
  for (int j = 0; j < constraint.n; j++) {
    const auto at = std::lower_bound(nodes.begin(), nodes.end(), constraint.node[j]);
    row.node[j] = (int) (at - nodes.begin());
    for (int d = 0; d < dim; d++) {
      const int of = sticks ? d : 0;
      const double by = sticks ? 1.0 : n[d];
      relative[of][j] += by * (constraint.record[j][d] - constraint.V[j][d]);
      if (hold) old[of][j] += by * (constraint.record[j][4 + d] - wall.motion.before[d]);
    }
  }
  for (int b = 0; b < (constraint.is_straight() ? 2 : 1); b++) {
    for (int j = 0; j < constraint.n; j++) row.c[j] = b ? constraint.B[j] : constraint.A[j];
    for (int of = 0; of < (sticks ? dim : 1); of++) {
      const double limit = constraint.limit_of_old(old[of]);
      row.sum[of] = row.old[of] = 0.0;
      for (int j = 0; j < constraint.n; j++) {
        row.sum[of] += row.c[j] * relative[of][j];
        row.old[of] += row.c[j] * std::max(-limit, std::min(old[of][j], limit));
      }
    }
    rows.push_back(row);
  }
}

/** The generalized inverse of the matrix G, unless it is known. */
void MPMCoupledLines::find_inverse(bool sticks)
{
  const auto n = (int) rows.size();
  if (mass == known_mass && active == known_active && (int) inverse.size() == n * n) return;
  known_mass = mass;
  known_active = active;
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(n, n);
  for (int r = 0; r < n; r++)
    for (int s = 0; s <= r; s++) {
      double sum = 0.0;
      for (int j = 0; j < rows[r].n; j++)
        for (int k = 0; k < rows[s].n; k++)
          if (rows[r].node[j] == rows[s].node[k])
            sum += rows[r].c[j] * rows[s].c[k] * heaviest / mass[rows[r].node[j]];
      G(r, s) = G(s, r) = sticks ? sum : sum * MathExtra::dot3(rows[r].normal, rows[s].normal);
    }
  const Eigen::VectorXd scale = G.diagonal().cwiseSqrt().cwiseInverse();
  G = scale.asDiagonal() * G * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(G);
  Eigen::VectorXd values = eigen.eigenvalues();
  for (int r = 0; r < n; r++) values[r] = values[r] > SMALL ? 1.0 / values[r] : 0.0;
  const Eigen::MatrixXd vectors = scale.asDiagonal() * eigen.eigenvectors();
  G = (vectors * values.asDiagonal()).lazyProduct(vectors.transpose());
  inverse.assign(G.data(), G.data() + (std::size_t) n * n);
}

/** Solves the equations and sets the velocities of the nodes. */
void MPMCoupledLines::solve(MPMWallReaction &reaction, const MPMWall &wall, MPMField &field)
{
  const auto n = (int) rows.size(), nnodes = (int) nodes.size();
  if (n == 0) return;
  const bool hold = reaction.old_share() > 0.0, sticks = wall.kind == MPMWall::STICK;
  const int dim = field.lattice.dim, ncomponents = sticks ? dim : 1;
  find_inverse(sticks);
  std::vector<double> change(3 * nnodes, 0.0), change_old(hold ? 3 * nnodes : 0, 0.0);
  for (int r = 0; r < n; r++) {
    double lambda[3] = {}, lambda_old[3] = {};
    for (int s = 0; s < n; s++)
      for (int of = 0; of < ncomponents; of++) {
        lambda[of] -= inverse[r * n + s] * rows[s].sum[of];
        lambda_old[of] -= inverse[r * n + s] * rows[s].old[of];
      }
    for (int j = 0; j < rows[r].n; j++) {
      const int i = rows[r].node[j];
      const double by = rows[r].c[j] * heaviest / mass[i];
      for (int d = 0; d < dim; d++) {
        if (sticks && !wall.velocity[d].given) continue;
        const int of = sticks ? d : 0;
        const double along = by * (sticks ? 1.0 : rows[r].normal[d]);
        change[3 * i + d] += lambda[of] * along;
        if (hold) change_old[3 * i + d] += lambda_old[of] * along;
      }
    }
  }
  for (int i = 0; i < nnodes; i++) {
    if (!(mass[i] > LEAST * heaviest)) continue;
    const double *const record = field.grid.record(nodes[i]);
    double V[3], v[3], old[3];
    wall.motion.velocity(field.grid, nodes[i], V);
    for (int d = 0; d < dim; d++) {
      v[d] = record[d] + change[3 * i + d];
      if (hold) old[d] = record[4 + d] + change_old[3 * i + d];
    }
    reaction.set_velocity(nodes[i], V, v, hold ? old : nullptr);
  }
}
