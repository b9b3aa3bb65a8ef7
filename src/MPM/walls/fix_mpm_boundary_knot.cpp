/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// On curved surfaces, where the axis that is nearest to the normal changes, lines of nodes along both axes share nodes and prescribe
// nearly the same.  One after the other, they would undo a part of each other's action, and repetition does not converge in implicit
// steps, whose constraints must be a projection.  Such lines form a knot, with the change of velocities of least kinetic energy
// that satisfies all of them:
//
//   v_i += sum_r l_r c_ri n_r/m_i,  sum_s G_rs l_s = -sum_i c_ri n_r (v_i - V_i),  G_rs = sum_i c_ri c_si n_r n_s/m_i
//
// where each line has a row c = a and, when all of its nodes have mass, a row c = b (fix_mpm_boundary_cut.cpp).  Rows that nearly
// depend on others ask for the same twice: eigenvectors of G, scaled to 1 on its diagonal, with small eigenvalues are left out.
//
// Where material sticks, each prescribed component has these equations on its own, with 1 in place of n_r.

#include "walls/fix_mpm_boundary.h"

#include "field/mpm_field.h"
#include "math_extra.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// cosine between normals up to which lines prescribe different components, or hold different material
static constexpr double CORNER = 0.1, BACK = -0.5;
static constexpr double LEAST = 1.0e-8;    // least mass of a node, relative to the heaviest one
static constexpr double SMALL = 1.0e-3;    // least eigenvalue

/* ----------------------------------------------------------------------
   Lines that share nodes, along different axes and in front of the same material, and lines that share nodes with
   these
------------------------------------------------------------------------- */

void FixMPMBoundary::list_knots(FieldNodes &list) const
{
  auto &lines = list.crossings;
  const double apart = kind == STICK ? BACK : CORNER;
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
  std::vector<int> parent(lines.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  for (auto first = uses.begin(), last = first; first != uses.end(); first = last) {
    while (last != uses.end() && last->node == first->node) last++;
    for (auto a = first; a != last; a++)
      for (auto b = a + 1; b != last; b++) {
        const Crossing &one = lines[a->line], &other = lines[b->line];
        if (one.axis == other.axis || MathExtra::dot3(one.normal, other.normal) < apart) continue;
        const int low = std::min(root(a->line), root(b->line)),
                  high = std::max(root(a->line), root(b->line));
        parent[high] = low;
      }
  }
  std::vector<int> size(lines.size(), 0), place(lines.size(), -1);
  for (std::size_t k = 0; k < lines.size(); k++) size[root((int) k)]++;
  for (std::size_t k = 0; k < lines.size(); k++) {
    const int r = root((int) k);
    if (size[r] < 2) continue;
    if (place[r] < 0) {
      place[r] = (int) list.knots.size();
      list.knots.emplace_back();
    }
    Knot &knot = list.knots[place[r]];
    knot.lines.push_back((int) k);
    lines[k].in_knot = true;
    for (int j = 0; j < lines[k].n; j++)
      if (lines[k].node[j] >= 0) knot.node.push_back(lines[k].node[j]);
  }
  for (auto &knot : list.knots) {
    auto &node = knot.node;
    std::sort(node.begin(), node.end());
    node.erase(std::unique(node.begin(), node.end()), node.end());
  }
}

/* ---------------------------------------------------------------------- */

void FixMPMBoundary::act_on_knot(const FieldNodes &list, Knot &knot)
{
  Grid &grid = list.field->grid;
  const int dim = grid.lattice.dim;
  const auto nnodes = (int) knot.node.size();
  double heaviest = 0.0;
  std::vector<double> mass(nnodes);
  for (int i = 0; i < nnodes; i++)
    heaviest = std::max(heaviest, mass[i] = grid.record(knot.node[i])[3]);
  if (!(heaviest > 0.0)) return;

  struct Row {
    int line, m;
    int node[4];    // indices into knot.node
    double c[4];
    double sum
        [3] = {},
     old[3] =
         {};    // velocity that the row removes: of components that stick, or along the normal (first one)
  };
  std::vector<Row> rows;
  std::vector<double> share(knot.lines.size(), 0.0);
  const bool hold = now.old_share > 0.0, sticks = kind == STICK;
  const int ncomponents = sticks ? dim : 1;
  for (std::size_t k = 0; k < knot.lines.size(); k++) {
    Crossing &line = const_cast<Crossing &>(list.crossings[knot.lines[k]]);
    if (!decide_line(grid, line)) continue;
    Chain chain;
    if (!find_chain(list, line.node, line.weight, line.n, 1, chain, LEAST * heaviest)) continue;
    line.contact = SLIDING;
    share[k] = 1.0;
    const double *const n = line.normal;
    double relative[3][4] = {}, old[3][4] = {};
    Row row = {(int) k, chain.m, {}, {}};
    for (int j = 0; j < chain.m; j++) {
      const auto at = std::lower_bound(knot.node.begin(), knot.node.end(), chain.node[j]);
      row.node[j] = (int) (at - knot.node.begin());
      for (int d = 0; d < dim; d++) {
        const int of = sticks ? d : 0;
        const double by = sticks ? 1.0 : n[d];
        relative[of][j] += by * (chain.r[j][d] - chain.V[j][d]);
        if (hold) old[of][j] += by * (chain.r[j][4 + d] - wall.before[d]);
      }
    }
    for (int b = 0; b < (chain.is_straight() ? 2 : 1); b++) {
      for (int j = 0; j < chain.m; j++) row.c[j] = b ? chain.B[j] : chain.A[j];
      for (int of = 0; of < ncomponents; of++) {
        const double limit = fabs(old[of][chain.inner]);
        row.sum[of] = row.old[of] = 0.0;
        for (int j = 0; j < chain.m; j++) {
          row.sum[of] += row.c[j] * relative[of][j];
          row.old[of] += row.c[j] * std::max(-limit, std::min(old[of][j], limit));
        }
      }
      rows.push_back(row);
    }
  }
  const auto n = (int) rows.size();
  if (n == 0) return;
  const auto normal = [&](const Row &row) {
    return list.crossings[knot.lines[row.line]].normal;
  };

  if (mass != knot.mass || share != knot.share || (int) knot.inverse.size() != n * n) {
    knot.mass = mass;
    knot.share = share;
    Eigen::MatrixXd G = Eigen::MatrixXd::Zero(n, n);
    for (int r = 0; r < n; r++)
      for (int s = 0; s <= r; s++) {
        double sum = 0.0;
        for (int j = 0; j < rows[r].m; j++)
          for (int k = 0; k < rows[s].m; k++)
            if (rows[r].node[j] == rows[s].node[k])
              sum += rows[r].c[j] * rows[s].c[k] * heaviest / mass[rows[r].node[j]];
        G(r, s) = G(s, r) = sticks ? sum : sum * MathExtra::dot3(normal(rows[r]), normal(rows[s]));
      }
    const Eigen::VectorXd scale = G.diagonal().cwiseSqrt().cwiseInverse();
    G = scale.asDiagonal() * G * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(G);
    Eigen::VectorXd values = eigen.eigenvalues();
    for (int r = 0; r < n; r++) values[r] = values[r] > SMALL ? 1.0 / values[r] : 0.0;
    const Eigen::MatrixXd vectors = scale.asDiagonal() * eigen.eigenvectors();
    G = (vectors * values.asDiagonal()).lazyProduct(vectors.transpose());
    knot.inverse.assign(G.data(), G.data() + (std::size_t) n * n);
  }

  std::vector<double> change(3 * nnodes, 0.0), change_old(hold ? 3 * nnodes : 0, 0.0);
  for (int r = 0; r < n; r++) {
    double lambda[3] = {}, lambda_old[3] = {};
    for (int s = 0; s < n; s++)
      for (int of = 0; of < ncomponents; of++) {
        lambda[of] -= knot.inverse[r * n + s] * rows[s].sum[of];
        lambda_old[of] -= knot.inverse[r * n + s] * rows[s].old[of];
      }
    for (int j = 0; j < rows[r].m; j++) {
      const int i = rows[r].node[j];
      const double by = rows[r].c[j] * heaviest / mass[i];
      for (int d = 0; d < dim; d++) {
        if (sticks && !velocity[d].given) continue;
        const int of = sticks ? d : 0;
        const double along = by * (sticks ? 1.0 : normal(rows[r])[d]);
        change[3 * i + d] += lambda[of] * along;
        if (hold) change_old[3 * i + d] += lambda_old[of] * along;
      }
    }
  }
  for (int i = 0; i < nnodes; i++) {
    if (!(mass[i] > LEAST * heaviest)) continue;
    const double *const record = grid.record(knot.node[i]);
    double V[3], v[3], old[3];
    wall.velocity(*list.field, knot.node[i], V);
    for (int d = 0; d < dim; d++) {
      v[d] = record[d] + change[3 * i + d];
      if (hold) old[d] = record[4 + d] + change_old[3 * i + d];
    }
    set_velocity(grid, knot.node[i], V, v, hold ? old : nullptr);
  }
}
