/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/spline_multigrid.h"

#include "solve/block_rows.h"
#include "solve/chebyshev.h"
#include "solve/rim_factors.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numeric>
#include <utility>

using namespace MPM_NS;

// unknowns of a level that is factorized, by dimension
static constexpr int FEW[] = {0, 0, 12000, 4000};

namespace {

using Sparse = BlockRows::Sparse;
using Part = CoarseParts::Part;
using Block = MatrixBlock;

/** The functions of twice the spacing that have a function in them along an axis, and how much of
 *  it. */
int parents(int order, int i, int *parent, double *weight)
{
  const int m = i >> 1;
  const bool odd = i & 1;
  const auto give = [&](int n, std::initializer_list<int> of, std::initializer_list<double> by) {
    std::copy(of.begin(), of.end(), parent);
    std::copy(by.begin(), by.end(), weight);
    return n;
  };
  if (order == 1) return odd ? give(2, {m, m + 1}, {0.5, 0.5}) : give(1, {m}, {1.0});
  if (order == 2)
    return odd ? give(2, {m, m + 1}, {0.75, 0.25}) : give(2, {m - 1, m}, {0.25, 0.75});
  return odd ? give(2, {m, m + 1}, {0.5, 0.5}) : give(3, {m - 1, m, m + 1}, {0.125, 0.75, 0.125});
}

/** Calls f(index, weight) for all parents of a node. period: of the coarse level along each axis,
 *  0: none. */
template <class F>
void each_parent(int order, int dim, const LatticeIndex &index, const int *period, const F &f)
{
  int parent[3][3], n[3] = {1, 1, 1};
  double weight[3][3];
  for (int d = 0; d < 3; d++) {
    parent[d][0] = 0;
    weight[d][0] = 1.0;
    if (d >= dim) continue;
    n[d] = parents(order, index[d], parent[d], weight[d]);
    if (period[d] > 0)
      for (int k = 0; k < n[d]; k++) parent[d][k] = (parent[d][k] + period[d]) % period[d];
  }
  for (int i = 0; i < n[0]; i++)
    for (int j = 0; j < n[1]; j++)
      for (int k = 0; k < n[2]; k++)
        f(LatticeIndex{parent[0][i], parent[1][j], parent[2][k]},
          weight[0][i] * weight[1][j] * weight[2][k]);
}

/** A value [width] of a node. */
struct NodeValue {
  int node;
  double value[3];
};

/** Blocks in the order in which they came. A row has some ten of them, which are looked through. */
struct Blocks {
  std::vector<Block> list;

  Block &at(int row, int column)
  {
    if (row >= (int) rows.size()) rows.resize(row + 1);
    for (const auto &[other, k] : rows[row])
      if (other == column) return list[k];
    rows[row].emplace_back(column, (int) list.size());
    list.push_back({row, column, {}});
    return list.back();
  }
  /** c b b^T of the values b [width] of nodes, the lower triangle. */
  void add_products(const NodeValue *begin, const NodeValue *end, double c, int width)
  {
    for (const NodeValue *row = begin; row < end; row++) {
      if (row->node >= (int) rows.size()) rows.resize(row->node + 1);
      if (rows.size() > place.size()) place.resize(rows.size(), -1);
      auto &columns = rows[row->node];
      for (const auto &[column, k] : columns) place[column] = k;
      for (const NodeValue *column = begin; column < end; column++) {
        if (column->node > row->node) continue;
        int &k = place[column->node];
        if (k < 0) {
          k = (int) list.size();
          columns.emplace_back(column->node, k);
          list.push_back({row->node, column->node, {}});
        }
        double *const to = list[k].value;
        for (int a = 0; a < width; a++)
          for (int b = 0; b < width; b++) to[a * width + b] += c * row->value[a] * column->value[b];
      }
      for (const auto &[column, k] : columns) place[column] = -1;
    }
  }
  /** The same blocks, without values. */
  void zero()
  {
    for (auto &block : list) std::fill_n(block.value, 9, 0.0);
  }
  double memory_usage() const
  {
    double bytes = list.capacity() * sizeof(Block) + rows.capacity() * sizeof(rows[0]) +
        place.capacity() * sizeof(int);
    for (const auto &row : rows) bytes += row.capacity() * sizeof(row[0]);
    return bytes;
  }

 private:
  std::vector<std::vector<std::pair<int, int>>> rows;    // columns, and places in the list
  std::vector<int> place;                                // of the columns of a row, -1: none
};

/** Adds to one triangle of the element, blocks [number][number] of [W][W], what functions with the
 *  gradients [G] have by the stiffness C [G W][G W]. */
template <int W, int G, class F>
void add_blocks(int number, F gradient_of, const double *C, double *element)
{
  constexpr int M = W * G;
  for (int J = 0; J < number; J++) {
    const double *const gJ = gradient_of(J);
    double T[M * W];
    for (int i = 0; i < M; i++)
      for (int b = 0; b < W; b++) {
        double sum = 0.0;
        for (int l = 0; l < G; l++) sum += C[i * M + l * W + b] * gJ[l];
        T[i * W + b] = sum;
      }
    for (int I = J; I < number; I++) {
      const double *const gI = gradient_of(I);
      double *const K = element + (I * number + J) * W * W;
      for (int ab = 0; ab < W * W; ab++) {
        double sum = K[ab];
        for (int l = 0; l < G; l++) sum += gI[l] * T[l * W * W + ab];
        K[ab] = sum;
      }
    }
  }
}

/** The same with G_J [ngrad][width][width], of projected functions, which turn a value into
 *  others. */
template <int W, int G>
void add_held_blocks(int number, const double *gradients, const double *C, double *element)
{
  constexpr int M = W * G;
  for (int J = 0; J < number; J++) {
    const double *const gJ = gradients + (std::size_t) J * M * W;
    double T[M * W] = {};
    for (int i = 0; i < M; i++)
      for (int j = 0; j < M; j++)
        for (int b = 0; b < W; b++) T[i * W + b] += C[i * M + j] * gJ[j * W + b];
    for (int I = J; I < number; I++) {
      const double *const gI = gradients + (std::size_t) I * M * W;
      double *const K = element + ((std::size_t) I * number + J) * W * W;
      double sum[W * W] = {};
      for (int j = 0; j < M; j++)
        for (int a = 0; a < W; a++)
          for (int b = 0; b < W; b++) sum[a * W + b] += gI[j * W + a] * T[j * W + b];
      for (int ab = 0; ab < W * W; ab++) K[ab] += sum[ab];
    }
  }
}

/** Means around nodes of which several ranks may have a part: sums that make their stiffness, and
 *  values of nodes, one mean after the other. */
struct Means {
  struct Head {
    uint64_t around;
    int kind, count;    // count: of values
    double sums[3];
  };
  std::vector<Head> heads;
  std::vector<NodeValue> values;

  void clear()
  {
    heads.clear();
    values.clear();
  }
  /** Calls f(begin, end, c) with the values of all ranks for each mean that no rank before this one
   *  has a part in. Collective. */
  template <class F> void each_of_all(LatticeRanks &ranks, const F &f) const
  {
    const auto counts = ranks.gather(std::vector<int>{(int) heads.size()});
    const auto all = ranks.gather(heads);
    const auto values_of_all = ranks.gather(values);
    struct Part {
      int head, rank;
      std::size_t first;
    };
    std::vector<Part> parts;
    std::size_t first = 0;
    for (int p = 0; p < (int) counts.size(); p++)
      for (int k = 0; k < counts[p]; k++) {
        parts.push_back({(int) parts.size(), p, first});
        first += all[parts.back().head].count;
      }
    const auto before = [&](const Part &a, const Part &b) {
      const Head &x = all[a.head], &y = all[b.head];
      return x.around != y.around ? x.around < y.around : x.kind < y.kind;
    };
    std::stable_sort(parts.begin(), parts.end(), before);
    std::vector<NodeValue> joined;
    for (std::size_t begin = 0, end; begin < parts.size(); begin = end) {
      for (end = begin + 1; end < parts.size() && !before(parts[begin], parts[end]);) end++;
      if (parts[begin].rank != ranks.me()) continue;
      double sums[3] = {0.0, 0.0, 0.0};
      joined.clear();
      for (std::size_t k = begin; k < end; k++) {
        const Head &head = all[parts[k].head];
        for (int i = 0; i < 3; i++) sums[i] += head.sums[i];
        for (int i = 0; i < head.count; i++) {
          const NodeValue &value = values_of_all[parts[k].first + i];
          auto found = k == begin
              ? joined.end()
              : std::find_if(joined.begin(), joined.end(), [&](const NodeValue &other) {
                  return other.node == value.node;
                });
          if (found == joined.end())
            joined.push_back(value);
          else
            for (int a = 0; a < 3; a++) found->value[a] += value.value[a];
        }
      }
      if (sums[0] > 0.0 && sums[1] > 0.0 && sums[2] > 0.0)
        f(joined.data(), joined.data() + joined.size(), sums[0] / (sums[1] * sums[2]));
    }
  }
  double memory_usage() const
  {
    return heads.capacity() * sizeof(Head) + values.capacity() * sizeof(NodeValue);
  }
};

/** A number at random that depends on the place alone. */
double noise(const LatticeIndex &index, int a)
{
  uint64_t seed = lattice_key(index) + 77 * a;
  for (int k = 0; k < 3; k++) {
    seed ^= seed >> 29;
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  }
  return (double) (seed >> 33) / (1u << 30) - 1.0;
}

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 3, 3>;

/** Inverse of a symmetric matrix; directions without stiffness have a little. */
Matrix inverse_of(const Matrix &A)
{
  const double scale = A.trace() / A.rows();
  Eigen::SelfAdjointEigenSolver<Matrix> modes(A);
  Eigen::VectorXd values = modes.eigenvalues();
  for (int a = 0; a < values.size(); a++) values[a] = 1.0 / std::max(values[a], 1.0e-6 * scale);
  return modes.eigenvectors() * values.asDiagonal() * modes.eigenvectors().transpose();
}

}    // namespace

/* ---------------------------------------------------------------------- */

struct SplineMultigrid::Levels {
  const Grid &grid;
  LatticeRanks &ranks;
  const int width, order, dim, few, all;
  bool whole = false;           // the first level below has the nodes themselves, and is factorized
  int period[3] = {0, 0, 0};    // of the first coarse level

  LinearSystem *system = nullptr;
  std::vector<double> projection;    // [node][width][width], empty: none
  std::vector<char> plain;           // [node] it has no constraint
  std::vector<Tie> ties;             // of nodes that are held together with others, by node
  std::vector<char> tied;            // [node] it is one of these
  std::vector<double> inverse;       // [node][width][width], 0 in the rim
  std::vector<char> in_system;       // [node] it has a stiffness
  std::vector<Block> held_part;      // what stands for what is held in the rim, one triangle
  double largest = 0.0;
  bool usable = true;    // all factors are there
  std::vector<double> work[3], rest;

  // nodes at surfaces and interfaces, whose functions are nearly dependent: chunks of them are
  // factorized, on all ranks
  LatticeNodes rim;
  std::vector<int> rim_number;       // [node] in the rim, -1: not in it
  std::vector<int64_t> rim_owned;    // nodes of the rim that this rank owns
  std::vector<int> rim_of_ranks;     // those of all ranks, by their number
  std::vector<int> rim_local;        // of nodes
  std::vector<double> rim_element;
  Blocks rim_blocks;
  RimFactors rim_factors;
  std::vector<Block> rim_ties;    // of all ranks: row u, column x of u = P x
  std::vector<double> rim_x, rim_b;

  // from the nodes of this rank to those of its part of the first coarse level, and from these to
  // the level
  LatticeNodes mine;
  CoarseParts to_mine;
  // of nodes with constraints, whose functions are those of several others where these are tied,
  // and of these in the rim
  struct HeldPart {
    int node;
    double W[9];
  };
  struct HeldParts {
    std::vector<int> first{0};    // [node + 1]
    std::vector<HeldPart> parts;
    const HeldPart *begin(int64_t node) const { return parts.data() + first[node]; }
    const HeldPart *end(int64_t node) const { return parts.data() + first[node + 1]; }
    double memory_usage() const
    {
      return first.capacity() * sizeof(int) + parts.capacity() * sizeof(HeldPart);
    }
  } held_to_mine, held_to_rim;
  std::vector<int> number, of_ranks;
  std::vector<double> partial, of_all;

  // stiffness of points with the same nodes, and that of this rank
  std::vector<int64_t> nodes;
  std::vector<int> local,
      place;    // coarse nodes of these, and the place of a coarse node in that list
  std::vector<double> element, G, KP;
  bool held = false;
  Blocks blocks;
  Means means, rim_means;    // of nodes of this rank's part of the first level, and of the rim

  // of a system that is factorized as a whole, once it has been
  LatticeNodes of_whole;             // all of its nodes
  std::vector<Block> held_nodes;     // those that are not free: row u, column x of u = P x
  bool again = false;                // its structure is known
  std::vector<Block> held_blocks;    // what stands for what is held
  std::vector<Block> sent, of_all_blocks;
  std::vector<int>
      slots;    // places of entries in the values of the matrix: of one triangle, and of the other

  struct Level {
    BlockRows A;
    CoarseParts to_next;
    std::vector<double> x, b;
    // smoother, as on the finest level
    std::vector<double> inverse, work[3];    // [node][width][width]
    std::vector<int> rim;                    // nodes of the rim
    std::unique_ptr<RimFactors> rim_factors;
    std::vector<double> rim_b, rim_x;
    double largest = 0.0;

    void by_blocks(int width, const double *r, double *z);
  };
  std::vector<Level> coarse;
  Sparse last;    // the matrix of the coarsest level, kept if that is all of the system
  EnvelopeFactors factors;

  Levels(const Grid &grid, LatticeRanks &ranks, int width, int order, int few, int all) :
      grid(grid), ranks(ranks), width(width), order(order), dim(grid.lattice.dim), few(few),
      all(all), rim_factors(&ranks),
      factors(&ranks, EnvelopeFactors::ENOUGH, EnvelopeFactors::ROUNDED)
  {
  }

  const double *projection_of(int64_t node) const
  {
    return projection.data() + node * width * width;
  }
  /** P from, or P^T from. */
  void project(int64_t node, const double *from, bool transposed, double *to) const
  {
    for (int a = 0; a < width; a++) {
      to[a] = from[a];
      if (plain[node]) continue;
      to[a] = 0.0;
      const double *const P = projection_of(node);
      for (int b = 0; b < width; b++)
        to[a] += (transposed ? P[b * width + a] : P[a * width + b]) * from[b];
    }
  }
  /** Calls f(index, P) for the nodes x of u = sum P x of a node with constraints. */
  template <class F> void each_source(int64_t node, const F &f) const
  {
    if (!tied[node]) return f(index_of(node), projection_of(node));
    auto tie = std::lower_bound(ties.begin(), ties.end(), node, [](const Tie &a, int64_t of) {
      return a.node < of;
    });
    for (; tie != ties.end() && tie->node == node; ++tie) f(tie->other, tie->P);
  }
  /** Calls f(i, W_i, j, W_j) for the parts i and j of a node. */
  template <class F> void each_pair(const HeldParts &of, int64_t node, const F &f) const
  {
    for (auto i = of.begin(node); i != of.end(node); ++i)
      for (auto j = of.begin(node); j != of.end(node); ++j)
        if (i->node >= j->node) f(*i, *j);
  }
  /** What the other directions of a node with constraints have, so that those are no motions
   *  without stiffness: c (1 - P)^T (1 - P). */
  template <class F>
  void each_held(const HeldParts &of, int64_t node, int self, double c, const F &f) const
  {
    const int w = width;
    std::vector<HeldPart> rest(of.begin(node), of.end(node));
    bool there = false;
    for (auto &part : rest) {
      for (int ab = 0; ab < w * w; ab++) part.W[ab] = -part.W[ab];
      if (part.node != self) continue;
      for (int a = 0; a < w; a++) part.W[a * w + a] += 1.0;
      there = true;
    }
    if (!there) {
      rest.push_back({self, {}});
      for (int a = 0; a < w; a++) rest.back().W[a * w + a] = 1.0;
    }
    for (const auto &i : rest)
      for (const auto &j : rest) {
        if (i.node < j.node) continue;
        Block block{i.node, j.node, {}};
        add_product(i.W, j.W, c, block.value);
        f(block);
      }
  }
  /** to += c A^T B */
  void add_product(const double *A, const double *B, double c, double *to) const
  {
    const int w = width;
    for (int k = 0; k < w; k++)
      for (int a = 0; a < w; a++)
        for (int b = 0; b < w; b++) to[a * w + b] += c * A[k * w + a] * B[k * w + b];
  }
  /** to += W from, or W^T from. */
  void add_part(const double *W, bool transposed, double c, const double *from, double *to) const
  {
    for (int a = 0; a < width; a++)
      for (int b = 0; b < width; b++)
        to[a] += c * (transposed ? W[b * width + a] : W[a * width + b]) * from[b];
  }
  /** rim_b <- P^T rim_b, or rim_x <- P rim_x, of nodes that are tied. */
  void tie_rim(std::vector<double> &x, bool transposed) const
  {
    if (rim_ties.empty()) return;
    const int w = width;
    const auto before = x;
    for (const auto &tie : rim_ties) std::fill_n(x.data() + (std::size_t) tie.row * w, w, 0.0);
    for (const auto &tie : rim_ties) {
      const int from = transposed ? tie.row : tie.column, to = transposed ? tie.column : tie.row;
      add_part(tie.value, transposed, 1.0, before.data() + (std::size_t) from * w,
               x.data() + (std::size_t) to * w);
    }
  }
  void project_whole(double *x, bool transposed) const
  {
    const int w = width;
    std::vector<double> before(x, x + of_whole.index.size() * w);
    for (const auto &held : held_nodes) std::fill_n(x + (std::size_t) held.row * w, w, 0.0);
    for (const auto &held : held_nodes) {
      const int from = transposed ? held.row : held.column,
                to = transposed ? held.column : held.row;
      add_part(held.value, transposed, 1.0, before.data() + (std::size_t) from * w,
               x + (std::size_t) to * w);
    }
  }
  LatticeIndex index_of(int64_t node) const
  {
    int at[3];
    grid.node_index(node, at);
    LatticeIndex index{0, 0, 0};
    for (int d = 0; d < dim; d++) index[d] = grid.lattice.wrap(d, at[d]);
    return index;
  }
  void find_rim(const double *given);
  void factorize_rim(const double *mass);
  void smoother_of(Level &, const LatticeNodes &, const int *cells);
  void find_parents();
  void start(int n, const int64_t *nodes);
  template <int W>
  void hold(const std::vector<int64_t> &of, const HeldParts &, std::vector<int> &number,
            std::vector<double> &K);
  void flush();
  void add_rim(int row, int column, const double *K);
  void add_masses(const double *mass);
  void merge_ranks();
  void number_blocks();
  void assemble_whole(int n);
  bool refill();
  void coarsen(LatticeNodes level, std::vector<int> rows);
  void invert_blocks(const double *given);
  void estimate_largest();

  void by_blocks(const double *r, double *z);
  void smooth(const double *r, double *z, bool from_zero);
  void cycle(std::size_t level);
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
  const int64_t nnodes = on->grid.nnodes();
  const int w = on->width;
  on->plain.assign(nnodes, 1);
  if (projection) {
    on->projection.assign(projection, projection + nnodes * w * w);
    for (int64_t node = 0; node < nnodes; node++)
      for (int a = 0; a < w; a++)
        for (int b = 0; b < w; b++)
          if (projection[(node * w + a) * w + b] != (a == b ? 1.0 : 0.0)) on->plain[node] = 0;
  }
  on->ties = ties;
  on->tied.assign(nnodes, 0);
  for (const auto &tie : ties) {
    on->tied[tie.node] = 1;
    on->plain[tie.node] = 0;
  }
  on->find_rim(blocks);
  on->find_parents();
  on->invert_blocks(blocks);
}

bool SplineMultigrid::begin_again()
{
  auto &o = *on;
  if (!o.again) return false;
  o.blocks.zero();
  o.means.clear();
  for (const auto &held : o.held_blocks) {
    auto &to = o.blocks.at(held.row, held.column);
    for (int ab = 0; ab < o.width * o.width; ab++) to.value[ab] += held.value[ab];
  }
  return true;
}

/** Which nodes of this rank are in the rim: all ranks know all nodes that have a stiffness. A
 *  system that is factorized as a whole needs none. */
void SplineMultigrid::Levels::find_rim(const double *given)
{
  const int w = width;
  const auto stiffness = [&](int64_t node) {
    double trace = 0.0;
    for (int a = 0; a < w; a++) trace += given[(node * w + a) * w + a];
    return trace;
  };
  const auto exists = [&](int64_t node) {
    return stiffness(node) > 0.0;
  };
  std::vector<LatticeIndex> owned;
  std::vector<double> owned_stiffness;
  for (int64_t node = 0; node < grid.nnodes(); node++)
    if (grid.owns(node) && exists(node)) {
      owned.push_back(index_of(node));
      owned_stiffness.push_back(stiffness(node));
    }
  LatticeNodes everywhere;
  for (const auto &index : ranks.gather(owned)) everywhere.add(index);
  rim_number.assign(grid.nnodes(), -1);
  whole = everywhere.index.size() * w <= (std::size_t) all;
  if (whole) return;
  int cells[3] = {0, 0, 0};
  for (int d = 0; d < dim; d++) cells[d] = grid.lattice.periodic[d] ? grid.lattice.ncell[d] : 0;
  const auto in_rim = rim_of(everywhere, ranks.gather(owned_stiffness), dim, order + 1, cells);
  for (std::size_t k = 0; k < in_rim.size(); k++)
    if (in_rim[k]) rim.add(everywhere.index[k]);
  std::vector<LatticeIndex> others;
  for (const auto &tie : ties) others.push_back(tie.other);
  for (const auto &index : ranks.gather(others))
    if (everywhere.find(index) >= 0) rim.add(index);
  rim_factors.start(rim.index, dim, width);
  std::vector<int> list;
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    const auto found = exists(node) ? rim.number.find(lattice_key(index_of(node)))
                                    : rim.number.end();
    if (found == rim.number.end()) continue;
    rim_number[node] = found->second;
    if (!grid.owns(node)) continue;
    rim_owned.push_back(node);
    list.push_back(found->second);
  }
  rim_of_ranks = ranks.gather(list);
  std::vector<Block> mine_tied;
  for (const auto &tie : ties) {
    const int other = rim.find(tie.other);
    if (!grid.owns(tie.node) || rim_number[tie.node] < 0 || other < 0) continue;
    mine_tied.push_back({rim_number[tie.node], other, {}});
    std::copy_n(tie.P, w * w, mine_tied.back().value);
  }
  rim_ties = ranks.gather(mine_tied);
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    if (rim_number[node] >= 0 && !plain[node])
      each_source(node, [&](const LatticeIndex &index, const double *P) {
        const int at = tied[node] ? rim.find(index) : rim_number[node];
        if (at < 0) return;
        held_to_rim.parts.push_back({at, {}});
        std::copy_n(P, w * w, held_to_rim.parts.back().W);
      });
    held_to_rim.first.push_back((int) held_to_rim.parts.size());
  }
}

void SplineMultigrid::Levels::find_parents()
{
  const auto &lattice = grid.lattice;
  for (int d = 0; d < dim; d++) period[d] = lattice.periodic[d] ? (lattice.ncell[d] + 1) / 2 : 0;
  to_mine = {};
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    if (whole)
      to_mine.parts.push_back({mine.add(index_of(node)), 1.0});
    else
      each_parent(order, dim, index_of(node), period,
                  [&](const LatticeIndex &parent, double weight) {
                    to_mine.parts.push_back({mine.add(parent), weight});
                  });
    to_mine.end_function();
  }
  const int ww = width * width;
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    const std::size_t first = held_to_mine.parts.size();
    const auto add = [&](int at, double weight, const double *P) {
      auto part = held_to_mine.parts.begin() + first;
      while (part != held_to_mine.parts.end() && part->node != at) ++part;
      if (part == held_to_mine.parts.end()) {
        held_to_mine.parts.push_back({at, {}});
        part = held_to_mine.parts.end() - 1;
      }
      for (int ab = 0; ab < ww; ab++) part->W[ab] += weight * P[ab];
    };
    if (!plain[node] && !tied[node])
      for (const auto &part : to_mine.of(node)) add(part.node, part.weight, projection_of(node));
    else if (!plain[node])
      each_source(node, [&](const LatticeIndex &index, const double *P) {
        if (whole) return add(mine.add(index), 1.0, P);
        each_parent(order, dim, index, period, [&](const LatticeIndex &parent, double weight) {
          add(mine.add(parent), weight, P);
        });
      });
    held_to_mine.first.push_back((int) held_to_mine.parts.size());
  }
  place.assign(mine.index.size(), -1);
}

/** The stiffness of points with other nodes. */
void SplineMultigrid::Levels::start(int n, const int64_t *of)
{
  flush();
  nodes.assign(of, of + n);
  held = false;
  for (const int64_t node : nodes) {
    held = held || !plain[node];
    const auto add = [&](int at) {
      const bool known = place[at] >= 0;
      // of a whole, nodes as they are: images of one in a narrow periodic box become one when they
      // are projected
      if (whole) held = held || known;
      if (known && !whole) return;
      place[at] = local.size();
      local.push_back(at);
    };
    if (plain[node] || whole)
      for (const auto &part : to_mine.of(node)) add(part.node);
    else
      for (auto part = held_to_mine.begin(node); part != held_to_mine.end(node); ++part)
        add(part->node);
  }
  element.assign(local.size() * local.size() * width * width, 0.0);
  rim_local.clear();
  for (int i = 0; i < n; i++)
    if (rim_number[nodes[i]] >= 0) rim_local.push_back(i);
  rim_element.assign(rim_local.size() * rim_local.size() * width * width, 0.0);
}

/** A block of the rim, with its transposed. */
void SplineMultigrid::Levels::add_rim(int row, int column, const double *K)
{
  const int w = width;
  const bool lower = row >= column;
  auto &to = lower ? rim_blocks.at(row, column) : rim_blocks.at(column, row);
  for (int a = 0; a < w; a++)
    for (int b = 0; b < w; b++) to.value[a * w + b] += lower ? K[a * w + b] : K[b * w + a];
}

/** From the stiffness K [n][n] of nodes, one triangle, to that of the nodes x of u = P x. number:
 *  of each node, and then of each x. */
template <int W>
void SplineMultigrid::Levels::hold(const std::vector<int64_t> &of, const HeldParts &parts,
                                   std::vector<int> &number, std::vector<double> &K)
{
  constexpr int WW = W * W;
  const std::size_t n = of.size();
  constexpr auto identity = [] {
    HeldPart same{0, {}};
    for (int a = 0; a < W; a++) same.W[a * W + a] = 1.0;
    return same;
  }();
  const auto each_part = [&](std::size_t i, const auto &f) {
    if (plain[of[i]]) return f(number[i], identity.W);
    for (auto part = parts.begin(of[i]); part != parts.end(of[i]); ++part) f(part->node, part->W);
  };
  std::vector<int> to;
  for (std::size_t i = 0; i < n; i++)
    each_part(i, [&](int at, const double *) {
      to.push_back(at);
    });
  std::sort(to.begin(), to.end());
  to.erase(std::unique(to.begin(), to.end()), to.end());
  const auto place_of = [&](int at) {
    return std::lower_bound(to.begin(), to.end(), at) - to.begin();
  };
  const std::size_t nto = to.size();
  KP.assign(nto * n * WW, 0.0);
  for (std::size_t j = 0; j < n; j++)
    each_part(j, [&](int at, const double *P) {
      double *const column = KP.data() + place_of(at) * n * WW;
      for (std::size_t i = 0; i < n; i++) {
        const double *const block = K.data() + (i >= j ? i * n + j : j * n + i) * WW;
        for (int a = 0; a < W; a++)
          for (int k = 0; k < W; k++) {
            const double value = i >= j ? block[a * W + k] : block[k * W + a];
            for (int b = 0; b < W; b++) column[i * WW + a * W + b] += value * P[k * W + b];
          }
      }
    });
  K.assign(nto * nto * WW, 0.0);
  for (std::size_t i = 0; i < n; i++)
    each_part(i, [&](int at, const double *P) {
      const std::size_t I = place_of(at);
      for (std::size_t J = 0; J <= I; J++) {
        const double *const block = KP.data() + (J * n + i) * WW;
        double *const sum = K.data() + (I * nto + J) * WW;
        for (int k = 0; k < W; k++)
          for (int a = 0; a < W; a++)
            for (int b = 0; b < W; b++) sum[a * W + b] += P[k * W + a] * block[k * W + b];
      }
    });
  number = std::move(to);
}

void SplineMultigrid::Levels::flush()
{
  const int w = width;
  const auto project = w == 1 ? &Levels::hold<1> : w == 2 ? &Levels::hold<2> : &Levels::hold<3>;
  for (const int node : local) place[node] = -1;
  if (whole && held) (this->*project)(nodes, held_to_mine, local, element);
  const int n = local.size();
  for (int I = 0; I < n; I++)
    for (int J = 0; J <= I; J++) {
      const double *const K = element.data() + (I * n + J) * w * w;
      // one triangle
      const bool lower = local[I] >= local[J];
      auto &to = lower ? blocks.at(local[I], local[J]) : blocks.at(local[J], local[I]);
      for (int a = 0; a < w; a++)
        for (int b = 0; b < w; b++) to.value[a * w + b] += lower ? K[a * w + b] : K[b * w + a];
    }
  // of the rim, projected, between nodes of the same chunk
  std::vector<int64_t> of_rim;
  std::vector<int> in_rim;
  bool free = true;
  for (const int i : rim_local) {
    of_rim.push_back(nodes[i]);
    in_rim.push_back(rim_number[nodes[i]]);
    free = free && plain[nodes[i]];
  }
  if (!free) (this->*project)(of_rim, held_to_rim, in_rim, rim_element);
  const int m = in_rim.size();
  for (int I = 0; I < m; I++)
    for (int J = 0; J <= I; J++)
      if (rim_factors.together(in_rim[I], in_rim[J]))
        add_rim(in_rim[I], in_rim[J], rim_element.data() + (I * m + J) * w * w);
  local.clear();
  nodes.clear();
  rim_local.clear();
}

void SplineMultigrid::add_point(int n, const int64_t *nodes, int ngrad, const double *gradient,
                                const double *stiffness)
{
  auto &o = *on;
  if ((int) o.nodes.size() != n || !std::equal(nodes, nodes + n, o.nodes.begin()))
    o.start(n, nodes);
  const int w = o.width, m = w * ngrad, nc = o.local.size();
  double symmetric[81];
  for (int i = 0; i < m; i++)
    for (int j = 0; j < m; j++)
      symmetric[i * m + j] = 0.5 * (stiffness[i * m + j] + stiffness[j * m + i]);
  const auto add = [&](int number, const auto &gradient_of, std::vector<double> &element) {
    using Gradient = decltype(gradient_of);
    // [width][ngrad]: scalars, and displacements in the plane and in space
    static constexpr void (*table[3][3])(int, Gradient, const double *, double *) = {
        {add_blocks<1, 1, Gradient>, add_blocks<1, 2, Gradient>, add_blocks<1, 3, Gradient>},
        {add_blocks<2, 1, Gradient>, add_blocks<2, 2, Gradient>, add_blocks<2, 3, Gradient>},
        {add_blocks<3, 1, Gradient>, add_blocks<3, 2, Gradient>, add_blocks<3, 3, Gradient>}};
    const auto with = table[w - 1][ngrad - 1];
    with(number, gradient_of, symmetric, element.data());
  };
  add(
      o.rim_local.size(),
      [&](int J) {
        return gradient + o.rim_local[J] * ngrad;
      },
      o.rim_element);
  if (o.whole) {
    add(
        n,
        [&](int J) {
          return gradient + J * ngrad;
        },
        o.element);
    return;
  }
  if (!o.held) {
    // G_J: [ngrad] gradient of a coarse function

    o.G.assign(nc * ngrad, 0.0);
    for (int i = 0; i < n; i++)
      for (const auto &part : o.to_mine.of(nodes[i])) {
        double *const g = o.G.data() + o.place[part.node] * ngrad;
        for (int l = 0; l < ngrad; l++) g[l] += part.weight * gradient[i * ngrad + l];
      }
    add(
        nc,
        [&](int J) {
          return o.G.data() + J * ngrad;
        },
        o.element);
    return;
  }

  o.G.assign((std::size_t) nc * m * w, 0.0);
  for (int i = 0; i < n; i++) {
    const auto g_of = [&](int coarse) {
      return o.G.data() + (std::size_t) o.place[coarse] * m * w;
    };
    if (o.plain[nodes[i]]) {
      for (const auto &part : o.to_mine.of(nodes[i]))
        for (int l = 0; l < ngrad; l++)
          for (int a = 0; a < w; a++)
            g_of(part.node)[(l * w + a) * w + a] += part.weight * gradient[i * ngrad + l];
      continue;
    }
    for (auto part = o.held_to_mine.begin(nodes[i]); part != o.held_to_mine.end(nodes[i]); ++part)
      for (int l = 0; l < ngrad; l++)
        for (int ab = 0; ab < w * w; ab++)
          g_of(part->node)[l * w * w + ab] += gradient[i * ngrad + l] * part->W[ab];
  }
  static constexpr void (*held_table[3][3])(int, const double *, const double *, double *) = {
      {add_held_blocks<1, 1>, add_held_blocks<1, 2>, add_held_blocks<1, 3>},
      {add_held_blocks<2, 1>, add_held_blocks<2, 2>, add_held_blocks<2, 3>},
      {add_held_blocks<3, 1>, add_held_blocks<3, 2>, add_held_blocks<3, 3>}};
  held_table[w - 1][ngrad - 1](nc, o.G.data(), symmetric, o.element.data());
}

void SplineMultigrid::add_mean(int64_t around, int kind, const double sums[3], int n,
                               const int64_t *nodes, const double *changes)
{
  auto &o = *on;
  o.flush();
  Means::Head head{lattice_key(o.index_of(around)), kind, 0, {sums[0], sums[1], sums[2]}};
  Means::Head of_rim = head;
  const std::size_t first = o.means.values.size();
  for (int i = 0; i < n; i++) {
    const double *const change = changes + (std::size_t) i * o.width;
    const auto value_of = [&](int coarse) {
      int &at = o.place[coarse];
      if (at < 0) {
        at = (int) (o.means.values.size() - first);
        o.means.values.push_back({coarse, {0.0, 0.0, 0.0}});
      }
      return o.means.values[first + at].value;
    };
    const bool in_rim = o.rim_number[nodes[i]] >= 0;
    const auto add_to_rim = [&](int at) {
      o.rim_means.values.push_back({at, {0.0, 0.0, 0.0}});
      of_rim.count++;
      return o.rim_means.values.back().value;
    };
    if (o.plain[nodes[i]]) {
      for (const auto &part : o.to_mine.of(nodes[i])) {
        double *const to = value_of(part.node);
        for (int a = 0; a < o.width; a++) to[a] += part.weight * change[a];
      }
      if (in_rim) std::copy_n(change, o.width, add_to_rim(o.rim_number[nodes[i]]));
      continue;
    }
    for (auto part = o.held_to_mine.begin(nodes[i]); part != o.held_to_mine.end(nodes[i]); ++part)
      o.add_part(part->W, true, 1.0, change, value_of(part->node));
    if (!in_rim) continue;
    for (auto part = o.held_to_rim.begin(nodes[i]); part != o.held_to_rim.end(nodes[i]); ++part)
      o.add_part(part->W, true, 1.0, change, add_to_rim(part->node));
  }
  head.count = (int) (o.means.values.size() - first);
  for (std::size_t k = first; k < o.means.values.size(); k++) o.place[o.means.values[k].node] = -1;
  o.means.heads.push_back(head);
  if (of_rim.count) o.rim_means.heads.push_back(of_rim);
}

/** Each node on the rank that owns it. */
void SplineMultigrid::Levels::add_masses(const double *mass)
{
  const int w = width;
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    if (!grid.owns(node) || !(mass[node] > 0.0)) continue;
    if (!plain[node]) {
      each_pair(held_to_mine, node, [&](const HeldPart &i, const HeldPart &j) {
        add_product(i.W, j.W, mass[node], blocks.at(i.node, j.node).value);
      });
      continue;
    }
    for (const auto &i : to_mine.of(node))
      for (const auto &j : to_mine.of(node)) {
        if (j.node > i.node) continue;
        auto &to = blocks.at(i.node, j.node);
        for (int a = 0; a < w; a++) to.value[a * w + a] += i.weight * j.weight * mass[node];
      }
  }
}

/** The nodes of the first coarse level, of all ranks, and its blocks, and from there on all of the
 *  levels. */
void SplineMultigrid::Levels::merge_ranks()
{
  LatticeNodes all;
  // nodes in the order of ranks, those that have a stiffness
  const int w = width;
  std::vector<char> used(mine.index.size(), 0);
  for (const auto &b : blocks.list) used[b.row] = used[b.column] = 1;
  std::vector<LatticeIndex> given;
  for (std::size_t k = 0; k < used.size(); k++)
    if (used[k]) given.push_back(mine.index[k]);
  const auto of_rank = ranks.gather(std::vector<int>{(int) given.size()});
  const auto given_by_all = ranks.gather(given);
  std::vector<int> rows{0};
  auto index = given_by_all.begin();
  for (const int n : of_rank) {
    for (int k = 0; k < n; k++) all.add(*index++);
    rows.push_back((int) all.index.size());
  }
  number.assign(used.size(), -1);
  std::vector<int> list;
  for (std::size_t k = 0; k < used.size(); k++)
    if (const auto found = all.number.find(lattice_key(mine.index[k])); found != all.number.end()) {
      number[k] = found->second;
      list.push_back(found->second);
    }
  of_ranks = ranks.gather(list);
  if (whole) {
    std::vector<Block> mine_held;
    for (int64_t node = 0; node < grid.nnodes(); node++) {
      const int at = number[to_mine.of(node).begin()->node];
      if (!grid.owns(node) || at < 0 || plain[node]) continue;
      for (auto part = held_to_mine.begin(node); part != held_to_mine.end(node); ++part) {
        if (number[part->node] < 0) continue;
        mine_held.push_back({at, number[part->node], {}});
        std::copy_n(part->W, w * w, mine_held.back().value);
      }
    }
    ranks.gather(mine_held, held_nodes);
    of_whole = all;
  }

  coarse.emplace_back();
  number_blocks();
  if (whole) {
    ranks.gather(sent, of_all_blocks);
    coarse[0].x.resize(all.index.size() * w);
    coarse[0].b.resize(all.index.size() * w);
    assemble_whole((int) all.index.size() * w);
  } else {
    blocks = {};
    coarsen(std::move(all), std::move(rows));
  }
}

/** Blocks of this rank, lower ones, by the numbers of all nodes. */
void SplineMultigrid::Levels::number_blocks()
{
  const int w = width;
  sent = blocks.list;
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
  const auto of_ranks = ranks.gather(std::vector<int>{mine_too});
  if (std::find(of_ranks.begin(), of_ranks.end(), 1) == of_ranks.end()) return;
  Means numbered = means;
  for (auto &value : numbered.values) value.node = number[value.node];
  Blocks more;
  numbered.each_of_all(ranks, [&](const NodeValue *begin, const NodeValue *end, double c) {
    more.add_products(begin, end, c, w);
  });
  sent.insert(sent.end(), more.list.begin(), more.list.end());
}

/** The matrix of a system that is factorized as a whole. */
void SplineMultigrid::Levels::assemble_whole(int n)
{
  const int w = width;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(of_all_blocks.size() * w * w * 2);
  for (const auto &b : of_all_blocks)
    for (int i = 0; i < w; i++)
      for (int j = 0; j < w; j++) {
        const double value = b.value[i * w + j];
        entries.emplace_back(b.row * w + i, b.column * w + j, value);
        if (b.row != b.column) entries.emplace_back(b.column * w + j, b.row * w + i, value);
      }
  last.resize(n, n);
  last.setFromTriplets(entries.begin(), entries.end());
  slots.clear();
  const auto slot = [&](int row, int column) {
    const int *const inner = last.innerIndexPtr(), *const outer = last.outerIndexPtr();
    return (int) (std::lower_bound(inner + outer[row], inner + outer[row + 1], column) - inner);
  };
  slots.reserve(2 * entries.size());
  for (const auto &b : of_all_blocks)
    for (int i = 0; i < w; i++)
      for (int j = 0; j < w; j++) {
        slots.push_back(slot(b.row * w + i, b.column * w + j));
        slots.push_back(b.row != b.column ? slot(b.column * w + j, b.row * w + i) : -1);
      }
}

/** The matrix by other values of blocks; false, on all ranks: these are not those that there
 *  were. */
bool SplineMultigrid::Levels::refill()
{
  const int w = width;
  const auto before = of_all_blocks;
  number_blocks();
  ranks.gather(sent, of_all_blocks);
  const bool same = before.size() == of_all_blocks.size() &&
      std::equal(before.begin(), before.end(), of_all_blocks.begin(),
                 [](const Block &a, const Block &b) {
                   return a.row == b.row && a.column == b.column;
                 });
  if (!same) return false;
  double *const values = last.valuePtr();
  std::fill_n(values, last.nonZeros(), 0.0);
  const int *to = slots.data();
  for (const auto &b : of_all_blocks)
    for (int ij = 0; ij < w * w; ij++, to += 2) {
      values[to[0]] += b.value[ij];
      if (to[1] >= 0) values[to[1]] += b.value[ij];
    }
  return true;
}

/** Levels from the first one on, whose blocks are those that were sent. rows: [ranks + 1] nodes of
 *  each rank. */
void SplineMultigrid::Levels::coarsen(LatticeNodes level, std::vector<int> rows)
{
  int cells[3];
  std::copy_n(period, 3, cells);
  while (true) {
    auto &now = coarse.back();
    now.A.assemble(ranks, width, rows, sent);
    std::vector<Block>().swap(sent);
    const int nodes = now.A.rows();
    now.x.resize((std::size_t) nodes * width);
    now.b.resize((std::size_t) nodes * width);

    // the nodes of the next level belong to those who have the first of their parts
    int half[3];
    for (int d = 0; d < 3; d++) half[d] = (cells[d] + 1) / 2;
    LatticeNodes next;
    std::vector<int> next_rows{0};
    if (nodes * width > few)
      for (int p = 0; p < ranks.number(); p++) {
        for (int k = rows[p]; k < rows[p + 1]; k++) {
          each_parent(order, dim, level.index[k], half,
                      [&](const LatticeIndex &parent, double weight) {
                        now.to_next.parts.push_back({next.add(parent), weight});
                      });
          now.to_next.end_function();
        }
        next_rows.push_back((int) next.index.size());
      }
    if (nodes * width <= few || (int) next.index.size() >= nodes) {
      last = now.A.matrix();
      now.A = {};
      return;
    }
    smoother_of(now, level, cells);
    sent = now.A.coarsened(now.to_next, (int) next.index.size());
    coarse.emplace_back();
    level = std::move(next);
    rows = std::move(next_rows);
    std::copy_n(half, 3, cells);
  }
}

/** The blocks of nodes and of chunks of the rim of an assembled level. */
void SplineMultigrid::Levels::smoother_of(Level &level, const LatticeNodes &nodes, const int *cells)
{
  const int w = width, ww = w * w, nnodes = nodes.index.size();
  auto &A = level.A;
  std::vector<double> own;
  for (int node = A.begin(); node < A.end(); node++) {
    const double *const D = A.find(node, node);
    own.push_back(0.0);
    for (int a = 0; D && a < w; a++) own.back() += D[a * w + a];
  }
  const auto in_rim = rim_of(nodes, A.of_all(own, 1), dim, order + 1, cells);
  std::vector<int> number(nnodes, -1);
  std::vector<LatticeIndex> rim_nodes;
  for (int node = 0; node < nnodes; node++)
    if (in_rim[node]) {
      number[node] = rim_nodes.size();
      rim_nodes.push_back(nodes.index[node]);
      level.rim.push_back(node);
    }
  level.rim_factors.reset(new RimFactors(&ranks));
  level.rim_factors->start(rim_nodes, dim, w);
  own.assign((std::size_t)(A.end() - A.begin()) * ww, 0.0);
  std::vector<Block> of_rim;
  for (int node = A.begin(); node < A.end(); node++) {
    if (const double *const D = A.find(node, node); D && number[node] < 0) {
      const Matrix given = Eigen::Map<const Matrix>(D, w, w);
      if (given.trace() > 0.0)
        Eigen::Map<Matrix>(own.data() + (std::size_t)(node - A.begin()) * ww, w, w) =
            inverse_of(given);
    }
    if (number[node] < 0) continue;
    A.each(node, [&](int other, const double *value) {
      if (other > node || number[other] < 0 ||
          !level.rim_factors->together(number[node], number[other]))
        return;
      of_rim.push_back({number[node], number[other], {}});
      std::copy_n(value, ww, of_rim.back().value);
    });
  }
  level.inverse = A.of_all(own, ww);
  for (const auto &b : ranks.gather(of_rim)) level.rim_factors->add(b.row, b.column, b.value);
  usable = level.rim_factors->factorize() && usable;
  if (!usable) return;
  level.rim_b.resize(level.rim.size() * w);
  level.rim_x.resize(level.rim.size() * w);

  const int64_t n = (int64_t) nnodes * w;
  std::vector<double> start(n);
  for (int64_t i = 0; i < n; i++) start[i] = noise(nodes.index[i / w], i % w);
  level.largest = largest_eigenvalue_of(
      n, std::move(start),
      [&](const double *x, double *y) {
        A.multiply(x, y);
      },
      [&](const double *x, double *y) {
        level.by_blocks(w, x, y);
      },
      [&](const double *x, const double *y) {
        return std::inner_product(x, x + n, y, 0.0);
      });
}

void SplineMultigrid::Levels::Level::by_blocks(int w, const double *r, double *z)
{
  const int n = A.rows() * w;
  for (int i = 0; i < n; i++) {
    double sum = 0.0;
    const int node = i / w;
    for (int b = 0; b < w; b++) sum += inverse[(std::size_t) i * w + b] * r[node * w + b];
    z[i] = sum;
  }
  if (rim.empty()) return;
  for (std::size_t k = 0; k < rim.size(); k++) std::copy_n(r + rim[k] * w, w, rim_b.data() + k * w);
  rim_factors->solve(rim_b.data(), rim_x.data());
  for (std::size_t k = 0; k < rim.size(); k++) std::copy_n(rim_x.data() + k * w, w, z + rim[k] * w);
}

/** Of nodes that are not in the rim. What is held has unity there, and nothing afterwards. */
void SplineMultigrid::Levels::invert_blocks(const double *given)
{
  const int w = width;
  inverse.assign(grid.nnodes() * w * w, 0.0);
  in_system.assign(grid.nnodes(), 0);
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    Matrix D = Eigen::Map<const Matrix>(given + node * w * w, w, w);
    D = (0.5 * (D + D.transpose())).eval();
    const double scale = D.trace() / w;
    if (!(scale > 0.0)) continue;
    in_system[node] = 1;
    if (plain[node]) {
      if (rim_number[node] < 0 && !whole)
        Eigen::Map<Matrix>(inverse.data() + node * w * w, w, w) = inverse_of(D);
      continue;
    }
    if (whole) {
      const int k = to_mine.of(node).begin()->node;
      each_held(held_to_mine, node, k, scale, [&](const Block &held) {
        auto &to = blocks.at(held.row, held.column);
        if (!grid.owns(node)) return;
        held_blocks.push_back(held);
        for (int ab = 0; ab < w * w; ab++) to.value[ab] += held.value[ab];
      });
      continue;
    }
    if (rim_number[node] >= 0) {
      if (grid.owns(node))
        each_held(held_to_rim, node, rim_number[node], scale, [&](const Block &held) {
          held_part.push_back(held);
        });
      continue;
    }
    const Matrix P = Eigen::Map<const Matrix>(projection_of(node), w, w);
    const Matrix rest = Matrix::Identity(w, w) - P, held = scale * rest.transpose() * rest;
    const Matrix free = P.transpose() * D * P + held;
    const Matrix inverted = P * inverse_of(free) * P.transpose();
    Eigen::Map<Matrix>(inverse.data() + node * w * w, w, w) = inverted;
  }
}

void SplineMultigrid::Levels::factorize_rim(const double *mass)
{
  const int w = width;
  for (const int64_t node : rim_owned) {
    const int k = rim_number[node];
    auto &to = rim_blocks.at(k, k);
    if (!mass) continue;
    if (plain[node])
      for (int a = 0; a < w; a++) to.value[a * w + a] += mass[node];
    else
      each_pair(held_to_rim, node, [&](const HeldPart &i, const HeldPart &j) {
        if (rim_factors.together(i.node, j.node))
          add_product(i.W, j.W, mass[node], rim_blocks.at(i.node, j.node).value);
      });
  }
  for (const auto &held : held_part) {
    if (!rim_factors.together(held.row, held.column)) continue;
    auto &to = rim_blocks.at(held.row, held.column);
    for (int ab = 0; ab < w * w; ab++) to.value[ab] += held.value[ab];
  }
  rim_means.each_of_all(ranks, [&](const NodeValue *begin, const NodeValue *end, double c) {
    Blocks more;
    more.add_products(begin, end, c, w);
    for (const auto &b : more.list) {
      if (!rim_factors.together(b.row, b.column)) continue;
      auto &to = rim_blocks.at(b.row, b.column);
      for (int ab = 0; ab < w * w; ab++) to.value[ab] += b.value[ab];
    }
  });
  rim_means.clear();
  const auto of_all = ranks.gather(rim_blocks.list);
  rim_blocks = {};
  for (const auto &b : of_all) rim_factors.add(b.row, b.column, b.value);
  usable = rim_factors.factorize() && usable;
  rim_b.resize(rim.index.size() * w);
  rim_x.resize(rim.index.size() * w);
}

void SplineMultigrid::Levels::by_blocks(const double *r, double *z)
{
  const int w = width;
  for (int64_t node = 0; node < grid.nnodes(); node++)
    for (int a = 0; a < w; a++) {
      double sum = 0.0;
      for (int b = 0; b < w; b++) sum += inverse[(node * w + a) * w + b] * r[node * w + b];
      z[node * w + a] = sum;
    }
  if (rim.index.empty()) return;
  partial.resize(rim_owned.size() * w);
  for (std::size_t k = 0; k < rim_owned.size(); k++)
    if (tied[rim_owned[k]])
      std::copy_n(r + rim_owned[k] * w, w, partial.data() + k * w);
    else
      project(rim_owned[k], r + rim_owned[k] * w, true, partial.data() + k * w);
  ranks.gather(partial, of_all);
  for (std::size_t k = 0; k < rim_of_ranks.size(); k++)
    for (int a = 0; a < w; a++) rim_b[rim_of_ranks[k] * w + a] = of_all[k * w + a];
  tie_rim(rim_b, true);
  rim_factors.solve(rim_b.data(), rim_x.data());
  tie_rim(rim_x, false);
  for (int64_t node = 0; node < grid.nnodes(); node++)
    if (rim_number[node] >= 0 && tied[node])
      std::copy_n(rim_x.data() + rim_number[node] * w, w, z + node * w);
    else if (rim_number[node] >= 0)
      project(node, rim_x.data() + rim_number[node] * w, false, z + node * w);
}

void SplineMultigrid::Levels::estimate_largest()
{
  const int64_t n = grid.nnodes() * width;
  std::vector<double> start(n);
  for (int64_t i = 0; i < n; i++) start[i] = noise(index_of(i / width), i % width);
  largest = largest_eigenvalue_of(
      n, std::move(start),
      [&](const double *x, double *y) {
        system->apply(x, y);
      },
      [&](const double *x, double *y) {
        by_blocks(x, y);
      },
      [&](const double *x, const double *y) {
        return system->product(x, y);
      });
}

void SplineMultigrid::finish(LinearSystem &system, const double *mass)
{
  auto &o = *on;
  o.system = &system;
  o.flush();
  if (mass) o.add_masses(mass);
  if (!o.whole) o.factorize_rim(mass);
  bool again = o.again;
  if (again)
    o.usable = true;
  else
    o.merge_ranks();
  if (again && !o.refill()) {
    o.assemble_whole((int) o.last.rows());
    again = false;
  }
  // symmetric: its rows are columns
  const Sparse &last = o.last;
  const Eigen::Map<const Eigen::SparseMatrix<double>> columns(
      last.rows(), last.cols(), last.nonZeros(), last.outerIndexPtr(), last.innerIndexPtr(),
      last.valuePtr());
  o.usable = o.usable && factorize(columns, o.factors, again);
  o.again = o.whole && o.usable;
  if (!o.whole) o.last = Sparse();
  if (o.usable && !o.whole) o.estimate_largest();
}

void SplineMultigrid::Levels::smooth(const double *r, double *z, bool from_zero)
{
  chebyshev(
      grid.nnodes() * width, largest, r, z, from_zero, work,
      [&](const double *x, double *y) {
        system->apply(x, y);
      },
      [&](const double *x, double *y) {
        by_blocks(x, y);
      });
}

/** x of a coarse level from its b. */
void SplineMultigrid::Levels::cycle(std::size_t which)
{
  auto &level = coarse[which];
  if (which + 1 == coarse.size()) {
    if (!level.b.empty()) factors.solve(level.b.data(), level.x.data());
    return;
  }
  const auto smooth_level = [&](bool from_zero) {
    chebyshev(
        level.b.size(), level.largest, level.b.data(), level.x.data(), from_zero, level.work,
        [&](const double *x, double *y) {
          level.A.multiply(x, y);
        },
        [&](const double *x, double *y) {
          level.by_blocks(width, x, y);
        });
  };
  auto &next = coarse[which + 1];
  std::fill(level.x.begin(), level.x.end(), 0.0);
  smooth_level(true);
  auto &rest = level.work[0];
  level.A.multiply(level.x.data(), rest.data());
  std::fill(next.b.begin(), next.b.end(), 0.0);
  const int w = width;
  for (int node = 0; node < level.A.rows(); node++)
    for (const auto &part : level.to_next.of(node))
      for (int a = 0; a < w; a++)
        next.b[part.node * w + a] += part.weight * (level.b[node * w + a] - rest[node * w + a]);
  cycle(which + 1);
  for (int node = 0; node < level.A.rows(); node++)
    for (const auto &part : level.to_next.of(node))
      for (int a = 0; a < w; a++) level.x[node * w + a] += part.weight * next.x[part.node * w + a];
  smooth_level(false);
}

void SplineMultigrid::precondition(const double *r, double *z)
{
  auto &o = *on;
  const int w = o.width;
  const int64_t nnodes = o.grid.nnodes();
  if (!o.usable) {
    std::copy_n(r, nnodes * w, z);
    return;
  }
  std::fill_n(z, nnodes * w, 0.0);
  if (!o.whole) {
    o.rest.assign(nnodes * w, 0.0);
    o.smooth(r, z, true);
    o.system->apply(z, o.rest.data());
  }

  // residuals of the nodes that this rank owns go to its part of the coarse level, and those of all
  // ranks to the level

  auto &partial = o.partial;
  partial.assign(o.number.size() * w, 0.0);
  for (int64_t node = 0; node < nnodes; node++) {
    if (!o.grid.owns(node) || !o.in_system[node]) continue;
    double left[3];
    for (int a = 0; a < w; a++) left[a] = r[node * w + a] - (o.whole ? 0.0 : o.rest[node * w + a]);
    if (!o.plain[node]) {
      for (auto part = o.held_to_mine.begin(node); part != o.held_to_mine.end(node); ++part)
        o.add_part(part->W, true, 1.0, left, partial.data() + part->node * w);
      continue;
    }
    for (const auto &part : o.to_mine.of(node))
      for (int a = 0; a < w; a++) partial[part.node * w + a] += part.weight * left[a];
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < o.number.size(); k++)
    if (o.number[k] >= 0) {
      for (int a = 0; a < w; a++) partial[kept * w + a] = partial[k * w + a];
      kept++;
    }
  partial.resize(kept * w);
  o.ranks.gather(partial, o.of_all);
  auto &coarse = o.coarse[0];
  std::fill(coarse.b.begin(), coarse.b.end(), 0.0);
  for (std::size_t k = 0; k < o.of_ranks.size(); k++)
    for (int a = 0; a < w; a++) coarse.b[o.of_ranks[k] * w + a] += o.of_all[k * w + a];
  o.cycle(0);

  for (int64_t node = 0; node < nnodes; node++) {
    if (!o.in_system[node]) continue;
    double motion[3] = {0.0, 0.0, 0.0};
    if (o.plain[node]) {
      for (const auto &part : o.to_mine.of(node))
        if (const int from = o.number[part.node]; from >= 0)
          for (int a = 0; a < w; a++) motion[a] += part.weight * coarse.x[from * w + a];
    } else {
      for (auto part = o.held_to_mine.begin(node); part != o.held_to_mine.end(node); ++part)
        if (const int from = o.number[part->node]; from >= 0)
          o.add_part(part->W, false, 1.0, coarse.x.data() + from * w, motion);
    }
    for (int a = 0; a < w; a++) z[node * w + a] += motion[a];
  }
  if (!o.whole) o.smooth(r, z, false);
}

int SplineMultigrid::nodes_of_whole() const
{
  return (int) on->of_whole.index.size();
}

int SplineMultigrid::place_in_whole(const LatticeIndex &index) const
{
  return on->of_whole.find(index);
}

void SplineMultigrid::solve_whole(double *b)
{
  auto &o = *on;
  o.project_whole(b, true);
  o.factors.solve(b, b);
  o.project_whole(b, false);
}

bool SplineMultigrid::usable() const
{
  return on->usable;
}

bool SplineMultigrid::is_whole() const
{
  return on->whole;
}

int SplineMultigrid::levels() const
{
  return on->coarse.size() + (on->whole ? 0 : 1);
}

double SplineMultigrid::largest_eigenvalue() const
{
  return on->largest;
}

double SplineMultigrid::memory_usage() const
{
  const auto &o = *on;
  // a node of a hash map: what it has, and a pointer in it and to it
  constexpr double HASHED = sizeof(std::pair<const uint64_t, int>) + 2 * sizeof(void *);
  double bytes = o.to_mine.memory_usage() + o.factors.memory_usage() +
      o.rim_factors.memory_usage() + o.plain.capacity() + o.in_system.capacity() +
      o.blocks.memory_usage() + o.rim_blocks.memory_usage() + o.means.memory_usage() +
      o.rim_means.memory_usage() +
      (o.held_blocks.capacity() + o.sent.capacity() + o.of_all_blocks.capacity()) * sizeof(Block) +
      o.slots.capacity() * sizeof(int) +
      (o.rim_owned.capacity() + o.nodes.capacity()) * sizeof(int64_t);
  bytes +=
      (o.held_nodes.capacity() + o.rim_ties.capacity() + o.held_part.capacity()) * sizeof(Block) +
      o.ties.capacity() * sizeof(Tie) + o.held_to_mine.memory_usage() +
      o.held_to_rim.memory_usage() + o.tied.capacity();
  for (const auto *list : {&o.rim, &o.mine, &o.of_whole})
    bytes += list->index.capacity() * sizeof(LatticeIndex) + list->number.size() * HASHED;
  for (const auto *list :
       {&o.rim_number, &o.rim_of_ranks, &o.rim_local, &o.number, &o.of_ranks, &o.local, &o.place})
    bytes += list->capacity() * sizeof(int);
  for (const auto *list :
       {&o.projection, &o.inverse, &o.work[0], &o.work[1], &o.work[2], &o.rest, &o.rim_element,
        &o.rim_x, &o.rim_b, &o.partial, &o.of_all, &o.element, &o.G, &o.KP})
    bytes += list->capacity() * sizeof(double);
  bytes += o.last.nonZeros() * (sizeof(double) + sizeof(int)) + o.last.rows() * sizeof(int);
  for (const auto &level : o.coarse) {
    bytes += level.A.memory_usage() + level.to_next.memory_usage() +
        (level.x.size() + level.b.size()) * sizeof(double) + level.rim.capacity() * sizeof(int);
    for (const auto *list : {&level.inverse, &level.work[0], &level.work[1], &level.work[2],
                             &level.rim_b, &level.rim_x})
      bytes += list->capacity() * sizeof(double);
    if (level.rim_factors) bytes += level.rim_factors->memory_usage();
  }
  return bytes;
}
