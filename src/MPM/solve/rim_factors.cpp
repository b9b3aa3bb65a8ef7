/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/rim_factors.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

using namespace MPM_NS;

// a chunk is divided where factors of it would take more operations than this, for one value of a
// node; halves reach so many nodes into each other
static constexpr double MOST_OPERATIONS = 3.0e7;
static constexpr int OVERLAP = 2;

// stiffnesses that differ by more, so near, are those of an interface
static constexpr double INTERFACE_RATIO = 10.0;
static constexpr int INTERFACE_REACH = 2;

// no place of a node is as far
static constexpr int FAR = 1 << 30;

/** Calls f(number of the other one) for the nodes that are up to reach away along an axis, itself
 *  among them; -1: there is none. */
template <class F>
static void each_along(const LatticeNodes &all, int node, int d, int reach, const int *period,
                       const F &f)
{
  for (int k = -reach; k <= reach; k++) {
    LatticeIndex at = all.index[node];
    at[d] += k;
    if (period[d] > 0) at[d] = ((at[d] % period[d]) + period[d]) % period[d];
    f(all.find(at));
  }
}

std::vector<char> MPM_NS::rim_of(const LatticeNodes &all, const std::vector<double> &stiffness,
                                 int dim, int reach, const int *period)
{
  // along one axis after the other: nodes whose neighbors are all there, and the range of
  // stiffnesses around them

  const int n = all.index.size();
  std::vector<char> inner(n, 1);
  auto least = stiffness, most = stiffness;
  for (int d = 0; d < dim; d++) {
    const auto inner_before = inner;
    const auto least_before = least, most_before = most;
    for (int i = 0; i < n; i++) {
      each_along(all, i, d, reach, period, [&](int j) {
        if (j < 0 || !inner_before[j]) inner[i] = 0;
      });
      each_along(all, i, d, INTERFACE_REACH, period, [&](int j) {
        if (j < 0) return;
        least[i] = std::min(least[i], least_before[j]);
        most[i] = std::max(most[i], most_before[j]);
      });
    }
  }
  std::vector<char> rim(n);
  for (int i = 0; i < n; i++) rim[i] = !inner[i] || most[i] > INTERFACE_RATIO * least[i];
  return rim;
}

bool MPM_NS::factorize(Eigen::SparseMatrix<double> A, EnvelopeFactors &factors, bool again)
{
  const int n = A.rows();
  if (n == 0) return true;
  Eigen::VectorXd diagonal(n);
  for (int i = 0; i < n; i++) diagonal[i] = A.coeff(i, i);
  // an entry that has to be put in is as expensive as all of them
  std::vector<Eigen::Triplet<double>> missing;
  for (int i = 0; i < n; i++) {
    bool there = false;
    for (Eigen::SparseMatrix<double>::InnerIterator it(A, i); it && !there; ++it)
      there = it.row() == i;
    if (!there) missing.emplace_back(i, i, 0.0);
  }
  if (!missing.empty()) {
    Eigen::SparseMatrix<double> zeros(n, n);
    zeros.setFromTriplets(missing.begin(), missing.end());
    A = (A + zeros).eval();
  }
  const double tiny = 1.0e-14 * diagonal.maxCoeff();
  for (double shift = 1.0e-10; shift < 1.0e3; shift *= 100.0) {
    for (int i = 0; i < n; i++)
      A.coeffRef(i, i) = diagonal[i] > tiny ? diagonal[i] * (1.0 + shift)
                                            : std::max(tiny, 1.0e-300) * 1.0e14;
    if (again ? factors.compute_again(A) : factors.compute(A)) return true;
    again = true;
  }
  return false;
}

bool MPM_NS::factorize_rows(const Eigen::SparseMatrix<double, Eigen::RowMajor, int> &A,
                            EnvelopeFactors &factors, bool again)
{
  // symmetric: its rows are columns
  const Eigen::Map<const Eigen::SparseMatrix<double>> columns(
      A.rows(), A.cols(), A.nonZeros(), A.outerIndexPtr(), A.innerIndexPtr(), A.valuePtr());
  return factorize(columns, factors, again);
}

/* ---------------------------------------------------------------------- */

/** Half of a chunk with too many operations, and so on. The envelope of a layer is as many nodes as
 *  there are in the layer. */
void RimFactors::start(const std::vector<LatticeIndex> &nodes, int dim, int width_in)
{
  width = width_in;
  std::vector<std::vector<int>> parts(1);    // nodes of each
  for (std::size_t i = 0; i < nodes.size(); i++) parts[0].push_back((int) i);
  std::vector<std::vector<int>> nodes_of;    // of each chunk
  std::vector<double> cost;
  while (!parts.empty()) {
    const std::vector<int> part = std::move(parts.back());
    parts.pop_back();
    LatticeIndex low{FAR, FAR, FAR}, high{-FAR, -FAR, -FAR};
    for (const int i : part)
      for (int d = 0; d < dim; d++) {
        low[d] = std::min(low[d], nodes[i][d]);
        high[d] = std::max(high[d], nodes[i][d]);
      }
    int along = 0;
    for (int d = 1; d < dim; d++)
      if (high[d] - low[d] > high[along] - low[along]) along = d;
    const int length = high[along] - low[along] + 1;
    const double layer = (double) part.size() / length;
    if (part.size() * layer * layer <= MOST_OPERATIONS || length <= 4 * OVERLAP + 2) {
      nodes_of.push_back(part);
      cost.push_back(part.size() * layer * layer);
      continue;
    }
    const int middle = low[along] + length / 2;
    const int from[] = {low[along], middle - OVERLAP}, to[] = {middle - 1 + OVERLAP, high[along]};
    for (int half = 0; half < 2; half++) {
      parts.emplace_back();
      for (const int i : part)
        if (nodes[i][along] >= from[half] && nodes[i][along] <= to[half]) parts.back().push_back(i);
    }
  }
  std::vector<std::vector<Copy>> copies_of(nodes.size());
  for (std::size_t k = 0; k < nodes_of.size(); k++)
    for (std::size_t i = 0; i < nodes_of[k].size(); i++)
      copies_of[nodes_of[k][i]].push_back({(int) k, (int) i});
  first.assign(1, 0);
  copies.clear();
  for (const auto &of : copies_of) {    // chunks in ascending order
    copies.insert(copies.end(), of.begin(), of.end());
    first.push_back((int) copies.size());
  }
  give_to_ranks(nodes_of, cost);
}

/** The most expensive ones first, each to the rank that has least to do. */
void RimFactors::give_to_ranks(const std::vector<std::vector<int>> &nodes_of,
                               const std::vector<double> &cost)
{
  const int nchunks = (int) nodes_of.size(), nranks = number_of_ranks();
  std::vector<int> order(nchunks), rank_of(nchunks);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return cost[a] > cost[b];
  });
  std::vector<double> load(nranks, 0.0);
  for (const int k : order) {
    rank_of[k] = (int) (std::min_element(load.begin(), load.end()) - load.begin());
    load[rank_of[k]] += cost[k];
  }
  const bool shared = nchunks == 1;
  begin_of.assign(nchunks, 0);
  bytes.assign(nranks, 0);
  chunks.clear();
  chunks.resize(nchunks);
  int64_t count = 0;
  for (int p = 0; p < nranks; p++) {
    const int64_t begin = count;
    for (int k = 0; k < nchunks; k++) {
      if (rank_of[k] != p) continue;
      begin_of[k] = count;
      count += (int64_t) nodes_of[k].size() * width;
      if (!shared && nranks > 1 && p != ranks->me()) continue;
      chunks[k].reset(new Chunk(shared ? ranks : nullptr));
      chunks[k]->nodes = nodes_of[k];
    }
    bytes[p] = (int) ((count - begin) * sizeof(double));
  }
}

bool RimFactors::together(int a, int b) const
{
  for (int i = first[a]; i < first[a + 1]; i++)
    for (int j = first[b]; j < first[b + 1]; j++)
      if (copies[i].chunk == copies[j].chunk) return true;
  return false;
}

void RimFactors::add(int row, int column, const double *value)
{
  const int w = width;
  for (int i = first[row]; i < first[row + 1]; i++)
    for (int j = first[column]; j < first[column + 1]; j++) {
      if (copies[i].chunk != copies[j].chunk || !chunks[copies[i].chunk]) continue;
      auto &entries = chunks[copies[i].chunk]->entries;
      const int at = copies[i].place * w, other = copies[j].place * w;
      for (int a = 0; a < w; a++)
        for (int b = 0; b < w; b++)
          if (row != column) {
            entries.emplace_back(at + a, other + b, value[a * w + b]);
            entries.emplace_back(other + b, at + a, value[a * w + b]);
          } else
            entries.emplace_back(at + a, other + b, 0.5 * (value[a * w + b] + value[b * w + a]));
    }
}

bool RimFactors::factorize()
{
  bool good = true;
  for (auto &chunk : chunks) {
    if (!chunk) continue;
    const int n = (int) chunk->nodes.size() * width;
    Eigen::SparseMatrix<double> A(n, n);
    A.setFromTriplets(chunk->entries.begin(), chunk->entries.end());
    std::vector<Eigen::Triplet<double>>().swap(chunk->entries);
    good = MPM_NS::factorize(std::move(A), chunk->factors) && good;
  }
  if (number_of_ranks() == 1) return good;
  for (const char all_right : ranks->gather(std::vector<char>{good})) good = good && all_right;
  return good;
}

void RimFactors::solve(const double *b, double *x)
{
  solutions.clear();
  for (auto &chunk : chunks) {
    if (!chunk) continue;
    const std::size_t begin = solutions.size();
    for (const int node : chunk->nodes)
      for (int a = 0; a < width; a++) solutions.push_back(share(node) * b[node * width + a]);
    chunk->factors.solve(solutions.data() + begin, solutions.data() + begin);
  }
  const double *all = solutions.data();
  if (number_of_ranks() > 1 && chunks.size() > 1)
    all = reinterpret_cast<const double *>(ranks->gather_sizes(all, bytes).data());
  for (int node = 0; node < size(); node++)
    for (int a = 0; a < width; a++) {
      double sum = 0.0;
      for (int i = first[node]; i < first[node + 1]; i++)
        sum += all[begin_of[copies[i].chunk] + copies[i].place * width + a];
      x[node * width + a] = share(node) * sum;
    }
}

double RimFactors::memory_usage() const
{
  double bytes = bytes_of(first, this->bytes, copies, begin_of, solutions);
  for (const auto &chunk : chunks)
    if (chunk) bytes += bytes_of(chunk->nodes, chunk->entries) + chunk->factors.memory_usage();
  return bytes;
}
