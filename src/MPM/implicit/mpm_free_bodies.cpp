/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/mpm_free_bodies.h"

#include "field/mpm_frame.h"
#include "field/mpm_point_map.h"
#include "field/mpm_stencil.h"
#include "math/sets.h"
#include "solve/lattice_ranks.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
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
static constexpr int MOST = 6;               // rigid motions

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

struct MPMFreeBodies::Body {
  double center[3] = {}, size = 0.0;    // size: mean distance of its nodes from the center
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();    // mean, of places of nodes to present ones
  bool turns = false;    // may it be turned, as far as the mean F tells?
  // columns: shares of rigid motions that nothing holds
  Eigen::MatrixXd translations, motions;
  Eigen::MatrixXd masses;    // of rigid motions, [motion][motion]
};

MPMFreeBodies::MPMFreeBodies(MPMSolvedNodes &nodes) : nodes(nodes) {}

MPMFreeBodies::~MPMFreeBodies() = default;

void MPMFreeBodies::clear()
{
  bodies.clear();
}

/** Number of rotations that may be free: none in periodic boxes, and around an axis of symmetry. */
int MPMFreeBodies::rotations() const
{
  const int *const periodic = nodes.lmp->domain->periodicity;
  if (nodes.field.options.axisymmetric || std::any_of(periodic, periodic + nodes.width, [](int p) {
        return p;
      }))
    return 0;
  return nodes.width == 3 ? 3 : 1;
}

/** Translations along the axes, and rotations around them that have a mean speed of about one. */
void MPMFreeBodies::rigid_motions(const Body &b, int64_t n, double (*motion)[3]) const
{
  const int w = nodes.width;
  double x[3], r[3];
  nodes.field.grid.node_position(n, x);
  for (int d = 0; d < 3; d++) x[d] = (x[d] - b.center[d]) / b.size;
  for (int d = 0; d < 3; d++) r[d] = b.F(d, 0) * x[0] + b.F(d, 1) * x[1] + b.F(d, 2) * x[2];
  for (int k = 0; k < MOST; k++) std::fill_n(motion[k], 3, 0.0);
  for (int d = 0; d < w; d++) motion[d][d] = 1.0;
  for (int k = 0; k < rotations(); k++) {
    const int axis = w == 3 ? k : 2, i = (axis + 1) % 3, j = (axis + 2) % 3;
    motion[w + k][i] = -r[j];
    motion[w + k][j] = r[i];
  }
}

template <class F> void MPMFreeBodies::each_owned(const F &f) const
{
  const auto &grid = nodes.field.grid;
  for (int64_t n = 0; n < grid.nnodes(); n++)
    if (body[n] >= 0 && nodes.mass[n] > 0.0 && grid.owns(n)) f(n, body[n]);
}

/** Sums over all ranks, in place. */
static void sum_up(std::vector<double> &sums, MPI_Comm world)
{
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), (int) sums.size(), MPI_DOUBLE, MPI_SUM, world);
}

void MPMFreeBodies::find_places(int number)
{
  bodies.assign(number, Body());
  std::vector<double> sums((std::size_t) number * 5, 0.0);
  each_owned([&](int64_t n, int k) {
    double x[3];
    nodes.field.grid.node_position(n, x);
    double *const sum = &sums[(std::size_t) 5 * k];
    for (int d = 0; d < 3; d++) {
      sum[d] += x[d];
      sum[3] += x[d] * x[d];
    }
    sum[4] += 1.0;
  });
  sum_up(sums, nodes.lmp->world);
  for (int k = 0; k < number; k++) {
    const double *const sum = &sums[(std::size_t) 5 * k];
    double square = sum[3] / sum[4];
    for (int d = 0; d < 3; d++) {
      bodies[k].center[d] = sum[d] / sum[4];
      square -= bodies[k].center[d] * bodies[k].center[d];
    }
    bodies[k].size = std::sqrt(std::max(square, 0.0)) + nodes.field.lattice.h;
  }
}

/** In a total frame. */
void MPMFreeBodies::find_deformations()
{
  const auto &field = nodes.field;
  const double *const mass = nodes.lmp->atom->rmass;
  std::vector<double> sums(bodies.size() * 10, 0.0);
  const MPMStencil stencil(field);
  for (const auto &run : field.map->runs)
    for (int i = run.first; i < run.last; i++) {
      int k = -1;
      stencil.visit(field.grid.blocks[run.slot], i, [&](const MPMStencil::Node &node) {
        k = std::max(k, body[node.number]);
      });
      if (k < 0) continue;
      double F[3][3];
      field.frame->lattice_F(i, F);
      for (int c = 0; c < 9; c++) sums[10 * (std::size_t) k + c] += mass[i] * F[c / 3][c % 3];
      sums[10 * (std::size_t) k + 9] += mass[i];
    }
  sum_up(sums, nodes.lmp->world);
  for (std::size_t k = 0; k < bodies.size(); k++)
    if (sums[10 * k + 9] > 0.0)
      for (int c = 0; c < 9; c++) bodies[k].F(c / 3, c % 3) = sums[10 * k + c] / sums[10 * k + 9];
}

/** products: of what walls take from rigid motions, [motion][motion] and the number of nodes. */
void MPMFreeBodies::find_free_motions(const std::vector<double> &products)
{
  const int w = nodes.width, m = w + rotations(), first = nodes.field.options.axisymmetric ? 1 : 0;
  for (std::size_t k = 0; k < bodies.size(); k++) {
    const double *const sum = &products[k * (m * m + 1)];
    const Eigen::Map<const Eigen::MatrixXd> all(sum, m, m);
    const auto null_space = [&](int from, int n) {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(all.block(from, from, n, n));
      Eigen::MatrixXd free = Eigen::MatrixXd::Zero(m, n);
      int found = 0;
      for (int axis = 0; axis < n; axis++)
        if (axes.eigenvalues()[axis] <= HELD * sum[m * m])
          free.col(found++).segment(from, n) = axes.eigenvectors().col(axis);
      return Eigen::MatrixXd(free.leftCols(found));
    };
    bodies[k].translations = null_space(first, w - first);
    // rotations are those around the center, and what is left of them beside translations
    bodies[k].motions = first || m == w ? bodies[k].translations : null_space(0, m);
  }
}

void MPMFreeBodies::find_masses()
{
  const int m = nodes.width + rotations();
  std::vector<double> sums(bodies.size() * m * m, 0.0);
  each_owned([&](int64_t n, int k) {
    double motion[MOST][3];
    rigid_motions(bodies[k], n, motion);
    for (int i = 0; i < m; i++)
      for (int j = 0; j < m; j++)
        for (int d = 0; d < nodes.width; d++)
          sums[(std::size_t) k * m * m + i * m + j] += nodes.mass[n] * motion[i][d] * motion[j][d];
  });
  sum_up(sums, nodes.lmp->world);
  for (std::size_t k = 0; k < bodies.size(); k++)
    bodies[k].masses = Eigen::Map<Eigen::MatrixXd>(&sums[k * m * m], m, m);
}

std::string MPMFreeBodies::find(MPMConstraints &constraints, LatticeRanks &ranks,
                                const std::vector<double> &external)
{
  const int w = nodes.width, m = w + rotations();
  const auto nnodes = nodes.field.grid.nnodes();
  find_places(find_bodies(nodes, ranks, body));
  if (nodes.field.frame->is_total() && rotations() > 0) find_deformations();
  std::vector<double> taken[MOST];
  for (int a = 0; a < m; a++) {
    taken[a].assign(nodes.nreals(), 0.0);
    const auto each = [&](const auto &f) {
      for (int64_t n = 0; n < nnodes; n++) {
        if (!(nodes.mass[n] > 0.0)) continue;
        double motion[MOST][3];
        rigid_motions(bodies[body[n]], n, motion);
        for (int d = 0; d < w; d++) f(taken[a][w * n + d], motion[a][d]);
      }
    };
    each([](double &value, double moves) {
      value = moves;
    });
    constraints.project(taken[a].data());
    each([](double &value, double moves) {
      value -= moves;
    });
  }
  std::vector<double> products(bodies.size() * (m * m + 1), 0.0);
  each_owned([&](int64_t n, int k) {
    double *const sum = &products[(std::size_t) k * (m * m + 1)];
    for (int a = 0; a < m; a++)
      for (int b = 0; b < m; b++)
        for (int d = 0; d < w; d++) sum[m * a + b] += taken[a][w * n + d] * taken[b][w * n + d];
    sum[m * m] += 1.0;
  });
  sum_up(products, nodes.lmp->world);
  find_free_motions(products);
  find_masses();
  const auto failure = find_push(external);
  const bool any = std::any_of(bodies.begin(), bodies.end(), [](const auto &b) {
    return b.motions.cols() > 0;
  });
  if (!any) clear();
  return failure;
}

/** A body that is pushed is not held: it may go to what bears it. */
std::string MPMFreeBodies::find_push(const std::vector<double> &external)
{
  std::string failure;
  const int w = nodes.width;
  std::vector<double> sums(bodies.size() * (w + 1), 0.0);
  each_owned([&](int64_t n, int k) {
    double *const sum = &sums[(std::size_t) k * (w + 1)], square = 0.0;
    for (int d = 0; d < w; d++) {
      sum[d] += external[w * n + d];
      square += external[w * n + d] * external[w * n + d];
    }
    sum[w] += std::sqrt(square);
  });
  sum_up(sums, nodes.lmp->world);
  for (std::size_t k = 0; k < bodies.size(); k++) {
    const Eigen::Map<const Eigen::VectorXd> force(&sums[k * (w + 1)], w);
    const auto axes = bodies[k].translations.topRows(w);
    const Eigen::VectorXd push = axes * (axes.transpose() * force);
    if (!(push.norm() > CANCELS * sums[k * (w + 1) + w])) continue;
    const double *const x = bodies[k].center, unit = 1.0 / nodes.lmp->force->ftm2v;
    failure = fmt::format(
        "the body around ({:.4g}, {:.4g}, {:.4g}) is held by no wall along the force ({:.4g}, "
        "{:.4g}, {:.4g}) "
        "that it bears: hold it by fix mpm/boundary, let its loads cancel, or use euler",
        x[0], x[1], w == 3 ? x[2] : 0.0, unit * push[0], unit * push[1],
        w == 3 ? unit * push[2] : 0.0);
    bodies[k].translations.resize(bodies[k].translations.rows(), 0);
    bodies[k].motions = bodies[k].translations;
  }
  return failure;
}

/** Takes off motions. power: of the rigid motions of each body, [motion]; by_mass: the changes are
 *  multiplied by masses. */
void MPMFreeBodies::take_off(const std::vector<double> &power, int stride, bool by_mass,
                             double *values) const
{
  const int w = nodes.width, m = w + rotations();
  std::vector<Eigen::VectorXd> rates(bodies.size());
  for (std::size_t k = 0; k < bodies.size(); k++) {
    const Eigen::Map<const Eigen::VectorXd> of_body(&power[k * stride], m);
    const auto &free = bodies[k].turns ? bodies[k].motions : bodies[k].translations;
    const Eigen::MatrixXd mass = free.transpose() * bodies[k].masses * free;
    rates[k] = Eigen::VectorXd::Zero(m);
    if (free.cols() > 0) rates[k] = free * mass.ldlt().solve(free.transpose() * of_body);
  }
  for (int64_t n = 0; n < nodes.field.grid.nnodes(); n++) {
    if (body[n] < 0 || !(nodes.mass[n] > 0.0)) continue;
    double motion[MOST][3];
    rigid_motions(bodies[body[n]], n, motion);
    for (int a = 0; a < m; a++)
      for (int d = 0; d < w; d++)
        values[w * n + d] -= (by_mass ? nodes.mass[n] : 1.0) * rates[body[n]][a] * motion[a][d];
  }
}

void MPMFreeBodies::balance(double *forces)
{
  if (bodies.empty()) return;
  const int w = nodes.width, m = w + rotations();
  // of each body the power of its rigid motions, and the sum of the sizes of forces
  std::vector<double> sums(bodies.size() * (m + 1), 0.0);
  each_owned([&](int64_t n, int k) {
    double motion[MOST][3], *const sum = &sums[(std::size_t) k * (m + 1)];
    rigid_motions(bodies[k], n, motion);
    for (int a = 0; a < m; a++)
      for (int d = 0; d < w; d++) sum[a] += motion[a][d] * forces[w * n + d];
    for (int d = 0; d < w; d++) sum[m] += std::fabs(forces[w * n + d]);
  });
  sum_up(sums, nodes.lmp->world);
  // forces of a body have no torque: if these have, it has other places than the mean F tells
  for (std::size_t k = 0; k < bodies.size(); k++) {
    const Eigen::Map<const Eigen::VectorXd> power(&sums[k * (m + 1)], m);
    bodies[k].turns =
        (bodies[k].motions.transpose() * power).norm() <= CANCELS * sums[k * (m + 1) + m];
  }
  take_off(sums, m + 1, true, forces);
}

void MPMFreeBodies::hold(double *displacements) const
{
  if (bodies.empty()) return;
  const int w = nodes.width, m = w + rotations();
  std::vector<double> sums(bodies.size() * m, 0.0);
  each_owned([&](int64_t n, int k) {
    double motion[MOST][3];
    rigid_motions(bodies[k], n, motion);
    for (int a = 0; a < m; a++)
      for (int d = 0; d < w; d++)
        sums[(std::size_t) k * m + a] += nodes.mass[n] * motion[a][d] * displacements[w * n + d];
  });
  sum_up(sums, nodes.lmp->world);
  take_off(sums, m, false, displacements);
}
