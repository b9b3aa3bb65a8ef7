/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/spline_multigrid.h"

#include "solve/coarse_levels.h"
#include "solve/fine_smoother.h"
#include "solve/point_stiffness.h"
#include "solve/rim_factors.h"
#include "solve/spline_transfer.h"
#include "solve/whole_system.h"

#include <algorithm>
#include <cmath>
#include <utility>

using namespace MPM_NS;

// unknowns of a level that is factorized, by dimension
static constexpr int FEW[] = {0, 0, 12000, 4000};

struct SplineMultigrid::Levels {
  const Grid &grid;
  LatticeRanks &ranks;
  const int width, order, dim, few, all;
  NodeConstraints nodes;
  SplineTransfer transfer;
  FineSmoother smoother;
  PointStiffness points;
  CoarseLevels coarse;
  WholeSystem whole;    // in place of levels

  bool is_whole = false;
  LinearSystem *system = nullptr;
  std::vector<char> in_system;       // [node] it has a stiffness
  bool usable = true;                // all factors are there
  bool again = false;                // the structure of the whole system is known
  std::vector<MatrixBlock> fixed;    // what stands for what constraints fix in the whole system
  std::vector<double> rest;

  Levels(const Grid &grid, LatticeRanks &ranks, int width, int order, int few, int all) :
      grid(grid), ranks(ranks), width(width), order(order), dim(grid.lattice.dim), few(few),
      all(all), nodes(grid, width), transfer(nodes, ranks, order), smoother(nodes, ranks),
      points(nodes, transfer, smoother), coarse(ranks, width, order, dim, few), whole(ranks, width)
  {
  }
  void find_rim(const double *given);
  void set_blocks(const double *given);
  std::vector<MatrixBlock> numbered_blocks();
  std::vector<MatrixBlock> constraints_of_whole() const;
  void build();
};

SplineMultigrid::SplineMultigrid(const Grid &grid, LatticeRanks &ranks, int width, int order,
                                 int few, int all) :
    on(new Levels(grid, ranks, width, order, few > 0 ? few : FEW[grid.lattice.dim], all))
{
}

SplineMultigrid::~SplineMultigrid() = default;

void SplineMultigrid::begin(const double *projection, const double *blocks,
                            const std::vector<Tie> &ties)
{
  const auto before = std::move(on);
  on.reset(new Levels(before->grid, before->ranks, before->width, before->order, before->few,
                      before->all));
  on->nodes.setup(projection, ties);
  on->find_rim(blocks);
  on->transfer.setup(on->is_whole);
  on->points.setup();
  on->set_blocks(blocks);
}

bool SplineMultigrid::begin_again()
{
  auto &o = *on;
  if (!o.again) return false;
  o.points.blocks.zero();
  o.points.means.clear();
  for (const auto &block : o.fixed) o.points.blocks.add(block, o.width);
  return true;
}

/** Which nodes are in the rim: all ranks know all nodes that have a stiffness. A system that is
 *  factorized as a whole needs no rim. */
void SplineMultigrid::Levels::find_rim(const double *given)
{
  const int w = width;
  std::vector<char> exists(grid.nnodes(), 0);
  std::vector<LatticeIndex> owned;
  std::vector<double> owned_stiffness;
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    double trace = 0.0;
    for (int a = 0; a < w; a++) trace += given[(node * w + a) * w + a];
    exists[node] = trace > 0.0;
    if (!grid.owns(node) || !exists[node]) continue;
    owned.push_back(nodes.index_of(node));
    owned_stiffness.push_back(trace);
  }
  LatticeNodes everywhere;
  for (const auto &index : ranks.gather(owned)) everywhere.add(index);
  is_whole = everywhere.index.size() * w <= (std::size_t) all;
  if (is_whole) return;
  int cells[3] = {0, 0, 0};
  for (int d = 0; d < dim; d++) cells[d] = grid.lattice.periodic[d] ? grid.lattice.ncell[d] : 0;
  const auto in_rim = rim_of(everywhere, ranks.gather(owned_stiffness), dim, order + 1, cells);
  smoother.find_rim(everywhere, in_rim, exists);
}

/** The diagonal blocks of nodes, for the smoother; of a whole system, the stiffness that stands for
 *  what constraints fix. */
void SplineMultigrid::Levels::set_blocks(const double *given)
{
  const int w = width;
  in_system.assign(grid.nnodes(), 0);
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    NodeBlock D = Eigen::Map<const NodeBlock>(given + node * w * w, w, w);
    D = (0.5 * (D + D.transpose())).eval();
    const double scale = D.trace() / w;
    if (!(scale > 0.0)) continue;
    in_system[node] = 1;
    if (!is_whole) {
      smoother.set_block(node, D, scale);
      continue;
    }
    if (nodes.plain[node]) continue;
    const int k = transfer.parts.of(node).begin()->node;
    transfer.constrained.each_fixed(w, node, k, scale, [&](const MatrixBlock &block) {
      points.blocks.at(block.row, block.column);
      if (!grid.owns(node)) return;
      fixed.push_back(block);
      points.blocks.add(block, w);
    });
  }
}

void SplineMultigrid::add_point(int n, const int64_t *nodes, int ngrad, const double *gradient,
                                const double *stiffness)
{
  on->points.add_point(n, nodes, ngrad, gradient, stiffness);
}

void SplineMultigrid::add_mean(int64_t around, int kind, const double sums[3], int n,
                               const int64_t *nodes, const double *changes)
{
  on->points.add_mean(around, kind, sums, n, nodes, changes);
}

/** Blocks of this rank, lower ones, by the numbers of all nodes. */
std::vector<MatrixBlock> SplineMultigrid::Levels::numbered_blocks()
{
  const int w = width;
  const auto &number = transfer.number;
  const auto &means = points.means;
  std::vector<MatrixBlock> sent = points.blocks.list;
  for (auto &b : sent) {
    b.row = number[b.row];
    b.column = number[b.column];
    if (b.row >= b.column) continue;
    std::swap(b.row, b.column);
    double turned[9];
    for (int i = 0; i < w; i++)
      for (int j = 0; j < w; j++) turned[i * w + j] = b.value[j * w + i];
    std::copy_n(turned, w * w, b.value);
  }
  int mine_too = !means.heads.empty();
  const auto any_rank = ranks.gather(std::vector<int>{mine_too});
  if (std::find(any_rank.begin(), any_rank.end(), 1) == any_rank.end()) return sent;
  MeanTerms numbered = means;
  for (auto &value : numbered.values) value.node = number[value.node];
  BlockList more;
  numbered.each_of_all(ranks, [&](const NodeValue *begin, const NodeValue *end, double c) {
    more.add_products(begin, end, c, w);
  });
  sent.insert(sent.end(), more.list.begin(), more.list.end());
  return sent;
}

/** P of the nodes that this rank owns and that are not free, by the numbers of the whole system. */
std::vector<MatrixBlock> SplineMultigrid::Levels::constraints_of_whole() const
{
  const auto &number = transfer.number;
  std::vector<MatrixBlock> mine;
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    const int at = number[transfer.parts.of(node).begin()->node];
    if (!grid.owns(node) || at < 0 || nodes.plain[node]) continue;
    for (const auto &part : transfer.constrained.of(node)) {
      if (number[part.node] < 0) continue;
      mine.push_back({at, number[part.node], {}});
      std::copy_n(part.W, width * width, mine.back().value);
    }
  }
  return mine;
}

/** The nodes of the first coarse level, of all ranks, and its blocks, and from there on all of the
 *  levels. */
void SplineMultigrid::Levels::build()
{
  std::vector<char> used(transfer.mine.index.size(), 0);
  for (const auto &b : points.blocks.list) used[b.row] = used[b.column] = 1;
  std::vector<int> rows;
  LatticeNodes level = transfer.number_nodes(used, rows);
  if (is_whole) {
    whole.build(std::move(level), constraints_of_whole(), numbered_blocks());
    return;
  }
  auto blocks = numbered_blocks();
  points.blocks = {};
  coarse.build(std::move(level), std::move(rows), transfer.period, std::move(blocks));
}

bool SplineMultigrid::finish(LinearSystem &system, const double *mass)
{
  auto &o = *on;
  o.system = &system;
  o.points.flush();
  if (mass) o.points.add_masses(mass);
  if (!o.is_whole) {
    o.usable = o.smoother.factorize(mass) && o.usable;
    o.build();
    o.usable = o.usable && o.coarse.factorize();
    if (o.usable) o.smoother.estimate_largest(system);
    return true;
  }
  bool same_places = o.again;
  if (!o.again) {
    o.build();
  } else if (!o.whole.refill(o.numbered_blocks())) {
    if (!o.whole.knows_nodes()) return o.again = false;
    o.whole.assemble();
    same_places = false;
  }
  o.usable = o.again = o.whole.factorize(same_places);
  return true;
}

void SplineMultigrid::precondition(const double *r, double *z)
{
  auto &o = *on;
  const int64_t n = o.grid.nnodes() * o.width;
  if (!o.usable) {
    std::copy_n(r, n, z);
    return;
  }
  std::fill_n(z, n, 0.0);
  if (o.is_whole) {
    o.transfer.restriction(r, nullptr, o.in_system, o.whole.b);
    o.whole.solve();
    o.transfer.prolongation(o.whole.x, o.in_system, z);
    return;
  }
  o.rest.assign(n, 0.0);
  o.smoother.smooth(*o.system, r, z, true);
  o.system->apply(z, o.rest.data());
  o.transfer.restriction(r, o.rest.data(), o.in_system, o.coarse.b());
  o.coarse.cycle();
  o.transfer.prolongation(o.coarse.x(), o.in_system, z);
  o.smoother.smooth(*o.system, r, z, false);
}

int SplineMultigrid::nodes_of_whole() const
{
  return (int) on->whole.nodes.index.size();
}

int SplineMultigrid::place_in_whole(const LatticeIndex &index) const
{
  return on->whole.nodes.find(index);
}

void SplineMultigrid::solve_whole(std::vector<double> &b)
{
  on->whole.solve(b);
}

bool SplineMultigrid::usable() const
{
  return on->usable;
}

bool SplineMultigrid::is_whole() const
{
  return on->is_whole;
}

int SplineMultigrid::levels() const
{
  return on->is_whole ? 1 : on->coarse.size() + 1;
}

double SplineMultigrid::largest_eigenvalue() const
{
  return on->smoother.largest;
}

double SplineMultigrid::memory_usage() const
{
  const auto &o = *on;
  return o.nodes.memory_usage() + o.transfer.memory_usage() + o.smoother.memory_usage() +
      o.points.memory_usage() + o.coarse.memory_usage() + o.whole.memory_usage() +
      bytes_of(o.in_system, o.fixed, o.rest);
}
