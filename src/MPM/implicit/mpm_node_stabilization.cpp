/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/mpm_node_stabilization.h"

#include "atom.h"
#include "field/mpm_field.h"
#include "field/mpm_point_map.h"

#include <algorithm>
#include <cstdint>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double ENOUGH = 0.1;    // of the volume of the fullest node

MPMNodeStabilization::MPMNodeStabilization(LAMMPS *lmp, MPMField &field) :
    Pointers(lmp), field(field), dim(field.lattice.dim)
{
}

void MPMNodeStabilization::begin_step(double c, const std::vector<double> &moduli)
{
  const MPMStencil stencil(field);
  const double h = field.lattice.h, unit = c * field.step_data().stress_scale / (h * h);
  lacks.assign(field.grid.nnodes(), 0.0);
  stiffness.assign(field.grid.nnodes(), 0.0);
  points.clear();
  nodes.clear();
  const auto visit = [&](const auto &use) {
    for (const auto &run : field.map->runs)
      for (bigint i = run.first; i < run.last; i++) {
        if (!run.material) continue;    // nodes of elements
        reached.clear();
        stencil.visit(field.grid.blocks[run.slot], (int) i, [&](const MPMStencil::Node &node) {
          if (node.weight > 0.0) reached.push_back(node);
        });
        use((int) i);
      }
  };
  visit([&](int i) {
    for (const auto &node : reached) lacks[node.number] += node.weight * atom->vfrac[i];
  });
  field.nodes.sum(lacks.data(), 1, 0, 1);
  double mine = 0.0, most;
  for (const double volume : lacks) mine = std::max(mine, volume);
  MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE, MPI_MAX, world);
  for (double &of : lacks) of = of > 0.0 ? std::max(0.0, 1.0 - of / (ENOUGH * most)) : 0.0;
  visit([&](int i) {
    const double k = unit * std::max(0.0, moduli[i]) * atom->vfrac[i];
    bool any = false;
    for (const auto &node : reached) {
      any = any || lacks[node.number] > 0.0;
      stiffness[node.number] += k * node.weight * lacks[node.number];
    }
    if (!any) return;
    for (const auto &node : reached)
      nodes.push_back({dim * node.number,
                       node.weight,
                       node.weight * lacks[node.number],
                       {node.r[0], node.r[1], node.r[2]}});
    points.push_back({nodes.size(), k});
  });
  field.nodes.sum(stiffness.data(), 1, 0, 1);
}

/** With W = diag(N), S = diag(s), and the linear motion v = A u, in which A is the projection for
 *  which W A is symmetric, forces are -k (1 - A)^T W S (1 - A) u. */
template <int DIM> void MPMNodeStabilization::add_forces_of_points()
{
  const double m = shape_constants[field.options.shape].inv_moment;
  const Node *begin = nodes.data();
  for (const auto &point : points) {
    const Node *const end = nodes.data() + point.end;
    left.resize(DIM * (end - begin));
    double mean[DIM] = {0.0}, slope[DIM][DIM] = {{0.0}}, rest[DIM] = {0.0},
           turn[DIM][DIM] = {{0.0}}, sum = 0.0;
    for (const Node *node = begin; node < end; node++)
      for (int d = 0; d < DIM; d++) {
        const double part = node->weight * motion[node->first + d];
        mean[d] += part;
        for (int e = 0; e < DIM; e++) slope[d][e] += part * node->r[e];
      }
    double *of = left.data();
    for (const Node *node = begin; node < end; node++, of += DIM)
      for (int d = 0; d < DIM; d++) {
        double way = motion[node->first + d] - mean[d];
        for (int e = 0; e < DIM; e++) way -= m * slope[d][e] * node->r[e];
        of[d] = node->lacking * way;
        sum += of[d] * way;
        rest[d] += of[d];
        for (int e = 0; e < DIM; e++) turn[d][e] += m * of[d] * node->r[e];
      }
    energy += point.k * sum;
    of = left.data();
    for (const Node *node = begin; node < end; node++, of += DIM)
      for (int d = 0; d < DIM; d++) {
        double linear = rest[d];
        for (int e = 0; e < DIM; e++) linear += turn[d][e] * node->r[e];
        more[node->first + d] -= point.k * (of[d] - node->weight * linear);
      }
    begin = end;
  }
}

void MPMNodeStabilization::add_forces(const double *u, double *force)
{
  const int64_t nreals = dim * field.grid.nnodes();
  motion.assign(u, u + nreals);
  more.assign(nreals, 0.0);
  field.nodes.complete(motion.data(), dim, dim);
  energy = 0.0;
  dim == 2 ? add_forces_of_points<2>() : add_forces_of_points<3>();
  field.nodes.sum(more.data(), dim, 0, dim);
  for (int64_t k = 0; k < nreals; k++) force[k] += more[k];
}

void MPMNodeStabilization::each_term(
    const std::function<void(int, const int64_t *, int, const double *, const double *)> &f) const
{
  const double m = shape_constants[field.options.shape].inv_moment;
  std::vector<int64_t> numbers;
  std::vector<double> g, unity(dim * dim, 0.0);
  const Node *begin = nodes.data();
  for (const auto &point : points) {
    const Node *const end = nodes.data() + point.end;
    numbers.clear();
    for (const Node *node = begin; node < end; node++) numbers.push_back(node->first / dim);
    for (const Node *weak = begin; weak < end; weak++) {
      if (!(weak->lacking > 0.0)) continue;
      g.clear();
      for (const Node *node = begin; node < end; node++) {
        double linear = 1.0;
        for (int d = 0; d < dim; d++) linear += m * node->r[d] * weak->r[d];
        g.push_back((node == weak ? 1.0 : 0.0) - node->weight * linear);
      }
      for (int d = 0; d < dim; d++) unity[(dim + 1) * d] = point.k * weak->lacking;
      f((int) numbers.size(), numbers.data(), 1, g.data(), unity.data());
    }
    begin = end;
  }
}
