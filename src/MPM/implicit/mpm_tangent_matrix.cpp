/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Entries of the matrix, for preconditioners: blocks of its diagonal, and what each point
   contributes.
------------------------------------------------------------------------- */

#include "implicit/mpm_tangent.h"

#include "field/mpm_interfaces.h"

#include <algorithm>
#include <unordered_map>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** The nodes of point i, each of them once, by their numbers where corners of a domain see one of
 *  them together. */
static void collect(const MPMStencil &stencil, const MPMField &field, int slot, int i,
                    std::vector<MPMStencil::Node> &nodes)
{
  nodes.clear();
  stencil.visit(field.grid.blocks[slot], i, [&](const MPMStencil::Node &node) {
    nodes.push_back(node);
  });
  if (!field.domains) return;
  std::sort(nodes.begin(), nodes.end(), [](const auto &a, const auto &b) {
    return a.number < b.number;
  });
  std::size_t n = 0;
  for (const auto &node : nodes) {
    if (n == 0 || nodes[n - 1].number != node.number) {
      nodes[n++] = node;
      continue;
    }
    nodes[n - 1].weight += node.weight;
    for (int d = 0; d < 3; d++) nodes[n - 1].gradient[d] += node.gradient[d];
  }
  nodes.resize(n);
}

void MPMTangent::each_point(const UsePoint &use) const
{
  const MPMStencil stencil(field);
  const double scale = field.step_data().stress_scale;
  const int ngrad = nH > nL ? dim + 1 : dim, size = dim * ngrad;
  std::vector<MPMStencil::Node> reached;
  std::vector<int64_t> nodes;
  std::vector<double> gradients, stiffness((std::size_t) size * size, 0.0);
  for (const auto &run : field.map->runs)
    for (bigint i = run.first; i < run.last; i++) {
      const double *const K = &present()[i * nH * nH], V = scale * atom->vfrac[i];
      const double around = turn_of(i);
      nodes.clear();
      gradients.clear();
      collect(stencil, field, run.slot, (int) i, reached);
      for (const auto &node : reached) {
        nodes.push_back(node.number);
        for (int d = 0; d < dim; d++) gradients.push_back(gradient(node, d));
        if (ngrad > dim) gradients.push_back(around * node.weight);
      }
      for (int k = 0; k < nH; k++)
        for (int l = 0; l < nH; l++) stiffness[size * l + k] = V * K[nH * k + l];
      if (averages && run.material)    // its pressure is that of each_mean()
        for (int k = 0; k < nH; k++)
          for (int l = 0; l < nH; l++)
            stiffness[size * l + k] -= V * volume_gradients[nH * i + l] * mean_tangents[nH * i + k];
      use((int) nodes.size(), nodes.data(), ngrad, gradients.data(), stiffness.data());
    }
}

/** A mean pressure p_I = sum_p N_Ip v_p dp_p/v_I works with the change of volume sum_p N_Ip V_p J
 *  G_p . H_p around its node. */
void MPMTangent::each_mean(const UseMean &use) const
{
  struct Mean {
    double sums[3] = {0.0, 0.0, 0.0};    // N v M, N v, N V
    std::vector<int64_t> nodes;
    std::vector<double> changes;    // [nodes][dim] of the volume by their motion
  };
  const MPMStencil stencil(field);
  const double scale = field.step_data().stress_scale;
  std::vector<MPMStencil::Node> reached;
  std::vector<double> change;
  for (std::size_t number = 0; averages && number < field.materials.size(); number++) {
    const auto *const material = field.materials[number];
    std::unordered_map<int64_t, Mean> at;
    std::vector<int64_t> order;
    for (const auto &run : field.map->runs) {
      if (run.material != material) continue;
      for (bigint i = run.first; i < run.last; i++) {
        const double *const g = &volume_gradients[nH * i], *const m = &mean_tangents[nH * i];
        const double V = scale * atom->vfrac[i], around = turn_of(i);
        double gm = 0.0, gg = 0.0;
        for (int k = 0; k < nH; k++) {
          gm += g[k] * m[k];
          gg += g[k] * g[k];
        }
        collect(stencil, field, run.slot, (int) i, reached);
        change.assign(reached.size() * dim, 0.0);
        for (std::size_t j = 0; j < reached.size(); j++) {
          const auto &node = reached[j];
          for (int l = 0; l < dim; l++) {
            const double slope = gradient(node, l);
            for (int a = 0; a < dim; a++) change[dim * j + a] += V * g[dim * l + a] * slope;
          }
          if (nH > nL) change[dim * j] += V * g[nL] * around * node.weight;
        }
        for (const auto &node : reached) {
          if (!(node.weight > 0.0)) continue;
          if (!at.count(node.number)) order.push_back(node.number);
          auto &mean = at[node.number];
          mean.sums[0] += node.weight * volumes[i] * gm / gg;
          mean.sums[1] += node.weight * volumes[i];
          mean.sums[2] += node.weight * V;
          for (std::size_t j = 0; j < reached.size(); j++) {
            const auto found = std::find(mean.nodes.begin(), mean.nodes.end(), reached[j].number);
            const std::size_t k = found - mean.nodes.begin();
            if (found == mean.nodes.end()) {
              mean.nodes.push_back(reached[j].number);
              mean.changes.resize(mean.changes.size() + dim, 0.0);
            }
            for (int a = 0; a < dim; a++)
              mean.changes[dim * k + a] += node.weight * change[dim * j + a];
          }
        }
      }
    }
    for (const int64_t node : order) {
      const auto &mean = at[node];
      use(node, (int) number, mean.sums, (int) mean.nodes.size(), mean.nodes.data(),
          mean.changes.data());
    }
  }
}

/** Adds to the block [DIM][DIM] of a node minus its force by its own motion: g: gradient of its
 *  function at a point with the tangents K; turn: H_zz for a unit of u_r; V: volume. */
template <int DIM, int NH>
static void add_block(const double *K, const double *g, double turn, double V, double *block)
{
  constexpr int NL = DIM * DIM;
  for (int b = 0; b < DIM; b++) {
    double sum[NH] = {0.0};    // change of P for a unit of u_b
    for (int m = 0; m < DIM; m++)
      for (int l = 0; l < NH; l++) sum[l] += K[NH * (DIM * m + b) + l] * g[m];
    if (NH > NL && b == 0)
      for (int l = 0; l < NH; l++) sum[l] += K[NH * (NH - 1) + l] * turn;
    for (int a = 0; a < DIM; a++) {
      double force = 0.0;
      for (int j = 0; j < DIM; j++) force += sum[DIM * j + a] * g[j];
      if (NH > NL && a == 0) force += sum[NH - 1] * turn;
      block[DIM * a + b] += V * force;
    }
  }
}

void MPMTangent::diagonal(std::vector<double> &blocks)
{
  const Grid &grid = field.grid;
  const MPMStencil stencil(field);
  const double scale = field.step_data().stress_scale;
  blocks.assign(grid.nnodes() * nL, 0.0);
  std::vector<MPMStencil::Node> reached;
  const auto add = nH > nL ? add_block<2, 5> : dim == 2 ? add_block<2, 4> : add_block<3, 9>;
  for (const auto &run : field.map->runs)
    for (bigint i = run.first; i < run.last; i++) {
      const double *const K = &present()[i * nH * nH], V = scale * atom->vfrac[i];
      const double around = turn_of(i);
      collect(stencil, field, run.slot, (int) i, reached);
      for (const auto &node : reached) {
        double g[3];
        for (int d = 0; d < dim; d++) g[d] = gradient(node, d);
        add(K, g, around * node.weight, V, &blocks[node.number * nL]);
      }
    }
  if (!between.empty()) {    // points that elements join have no other part in this
    std::vector<double> of_points((std::size_t) atom->nmax * nL, 0.0);
    for (auto *forces : between) forces->add_blocks(of_points.data());
    const double unit = field.step_data().force_scale;
    for (const auto &run : field.map->runs)
      for (bigint i = run.first; i < run.last; i++) {
        collect(stencil, field, run.slot, (int) i, reached);
        for (const auto &node : reached)
          for (int k = 0; k < nL; k++)
            blocks[node.number * nL + k] +=
                unit * node.weight * node.weight * of_points[nL * (std::size_t) i + k];
      }
  }
  field.nodes.sum(blocks.data(), nL, 0, nL);
}
