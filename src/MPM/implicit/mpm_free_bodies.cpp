/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Statics: a body that walls do not hold along an axis has no stiffness along it, and no
   equilibrium if forces push it that way. This is found before anything is solved: nodes that share
   points form bodies, and what walls take from the motion of a body as a whole is zero along its
   free axes.
------------------------------------------------------------------------- */

#include "field/mpm_point_map.h"
#include "field/mpm_stencil.h"
#include "implicit/mpm_constraints.h"
#include "math/sets.h"
#include "solve/lattice_ranks.h"

#include "comm.h"
#include "fmt/format.h"
#include "force.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <unordered_map>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double HELD = 1.0e-12;      // mean square of what walls take from a motion
static constexpr double CANCELS = 1.0e-6;    // sum of forces over that of their sizes: zero

namespace {

struct Label {
  uint64_t node;
  int set, rank;
};

/** Number of a set of nodes of a rank, among the sets of all ranks. */
uint64_t set_of(const Label &label)
{
  return (uint64_t) label.rank << 32 | (uint64_t) label.set;
}

}    // namespace

/** Numbers the body of each node, from 0 on and the same on all ranks; -1: none. Returns the number
 *  of bodies. Collective. */
static int find_bodies(MPMSolvedNodes &nodes, LatticeRanks &ranks, std::vector<int> &body)
{
  auto &field = nodes.field;
  auto &grid = field.grid;
  const auto &mass = nodes.mass;
  const MPMStencil stencil(field);
  Sets mine(mass.size());
  for (const auto &run : field.map->runs)
    for (bigint i = run.first; i < run.last; i++) {
      int64_t first = -1;
      stencil.visit(grid.blocks[run.slot], (int) i, [&](const MPMStencil::Node &node) {
        if (first < 0) first = node.number;
        mine.join((int) first, (int) node.number);
      });
    }
  std::vector<Label> labels;
  for (int64_t n = 0; n < (int64_t) mass.size(); n++) {
    if (!(mass[n] > 0.0)) continue;
    labels.push_back({lattice_key(nodes.index_of(n)), mine.root((int) n), nodes.lmp->comm->me});
  }
  const auto all = ranks.gather(labels);

  // nodes shared by ranks, and periodic images, join the sets that these have

  std::unordered_map<uint64_t, int> of_node, of_set;
  std::vector<int> number;
  for (const auto &label : all)
    number.push_back(of_set.emplace(set_of(label), (int) of_set.size()).first->second);
  Sets sets(of_set.size());
  for (std::size_t k = 0; k < all.size(); k++) {
    const auto node = of_node.emplace(all[k].node, number[k]);
    if (!node.second) sets.join(node.first->second, number[k]);
  }
  std::unordered_map<int, int> place;
  for (const int set : number) place.emplace(sets.root(set), (int) place.size());
  body.assign(mass.size(), -1);
  std::size_t k = 0;
  for (int64_t n = 0; n < (int64_t) mass.size(); n++) {
    if (!(mass[n] > 0.0)) continue;
    body[n] = place.at(sets.root(of_set.at(set_of(labels[k++]))));
  }
  return (int) place.size();
}

std::string LAMMPS_NS::find_free_body(MPMSolvedNodes &nodes, MPMConstraints &constraints,
                                      LatticeRanks &ranks, const std::vector<double> &external)
{
  auto &grid = nodes.field.grid;
  const auto &mass = nodes.mass;
  std::vector<int> body;
  const int nbodies = find_bodies(nodes, ranks, body), w = nodes.width,
            first = nodes.field.options.axisymmetric ? 1 : 0;

  // sums for each body: products [w][w] of what walls take from unit motions; force; its size;
  // place; nodes

  const int NSUM = w * w + 2 * w + 2;
  std::vector<double> mine((std::size_t) nbodies * NSUM, 0.0), sums, taken[3];
  for (int d = 0; d < w; d++) {
    taken[d].assign(nodes.nreals(), 0.0);
    for (int64_t n = 0; n < (int64_t) mass.size(); n++)
      if (mass[n] > 0.0) taken[d][w * n + d] = 1.0;
    constraints.project(taken[d].data());
    for (int64_t n = 0; n < (int64_t) mass.size(); n++)
      if (mass[n] > 0.0) taken[d][w * n + d] -= 1.0;
  }
  for (int64_t n = 0; n < (int64_t) mass.size(); n++) {
    if (body[n] < 0 || !grid.owns(n)) continue;
    double *const sum = &mine[(std::size_t) body[n] * NSUM], x[3], square = 0.0;
    for (int a = 0; a < w; a++)
      for (int b = 0; b < w; b++)
        for (int d = 0; d < w; d++) sum[w * a + b] += taken[a][w * n + d] * taken[b][w * n + d];
    grid.node_position(n, x);
    for (int d = 0; d < w; d++) {
      sum[w * w + d] += external[w * n + d];
      sum[w * w + w + d] += x[d];
      square += external[w * n + d] * external[w * n + d];
    }
    sum[NSUM - 2] += std::sqrt(square);
    sum[NSUM - 1] += 1.0;
  }
  sums.resize(mine.size());
  MPI_Allreduce(mine.data(), sums.data(), (int) mine.size(), MPI_DOUBLE, MPI_SUM, nodes.lmp->world);

  for (int k = 0; k < nbodies; k++) {
    const double *const sum = &sums[(std::size_t) k * NSUM], number = sum[NSUM - 1];
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 3, 3>;
    const Matrix products =
        Eigen::Map<const Matrix>(sum, w, w).bottomRightCorner(w - first, w - first);
    const Eigen::SelfAdjointEigenSolver<Matrix> axes(products);
    double push[3] = {0.0, 0.0, 0.0}, size = 0.0;    // what is left of the force along free axes
    for (int axis = 0; axis < w - first; axis++) {
      if (axes.eigenvalues()[axis] > HELD * number) continue;
      double along = 0.0;
      for (int d = first; d < w; d++)
        along += axes.eigenvectors()(d - first, axis) * sum[w * w + d];
      for (int d = first; d < w; d++) push[d] += along * axes.eigenvectors()(d - first, axis);
      size = std::hypot(size, along);
    }
    if (!(size > CANCELS * sum[NSUM - 2])) continue;
    const double *const x = sum + w * w + w;
    return fmt::format(
        "the body around ({:.4g}, {:.4g}, {:.4g}) is held by no wall along the force ({:.4g}, "
        "{:.4g}, {:.4g}) "
        "that it bears: hold it by fix mpm/boundary, let its loads cancel, or use euler",
        x[0] / number, x[1] / number, w == 3 ? x[2] / number : 0.0,
        push[0] / nodes.lmp->force->ftm2v, push[1] / nodes.lmp->force->ftm2v,
        push[2] / nodes.lmp->force->ftm2v);
  }
  return "";
}
