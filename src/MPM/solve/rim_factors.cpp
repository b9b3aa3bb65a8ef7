/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/rim_factors.h"

#include <algorithm>
#include <cmath>
#include <utility>

using namespace MPM_NS;

// nodes along a side of a chunk, as a power of 2, by dimension, and how far chunks reach into the next ones
static constexpr int CHUNK_BITS[] = {0, 0, 6, 4};
static constexpr int OVERLAP = 2;
// chunks do not end at index 0, where bodies often do
static constexpr int CHUNK_SHIFT = 4;

std::unordered_set<uint64_t> MPM_NS::rim_of(const std::vector<LatticeIndex> &nodes, int dim,
                                            int reach, const int *period)
{
  std::unordered_set<uint64_t> inner, rim;
  for (const auto &index : nodes) inner.insert(lattice_key(index));
  // along one axis after the other: nodes whose neighbors are all there
  for (int d = 0; d < dim; d++) {
    std::unordered_set<uint64_t> next;
    for (const auto &index : nodes) {
      bool all = inner.count(lattice_key(index));
      for (int k = -reach; all && k <= reach; k++) {
        LatticeIndex at = index;
        at[d] += k;
        if (period[d] > 0) at[d] = ((at[d] % period[d]) + period[d]) % period[d];
        all = inner.count(lattice_key(at));
      }
      if (all) next.insert(lattice_key(index));
    }
    inner.swap(next);
  }
  for (const auto &index : nodes)
    if (!inner.count(lattice_key(index))) rim.insert(lattice_key(index));
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

/* ---------------------------------------------------------------------- */

void RimFactors::start(const std::vector<LatticeIndex> &nodes, int dim, int width_in)
{
  width = width_in;
  first.assign(1, 0);
  chunk.clear();
  LatticeNodes chunks;
  for (const auto &index : nodes) {
    int low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    for (int d = 0; d < dim; d++) {
      low[d] = (index[d] + CHUNK_SHIFT - OVERLAP) >> CHUNK_BITS[dim];
      high[d] = (index[d] + CHUNK_SHIFT + OVERLAP) >> CHUNK_BITS[dim];
    }
    for (int i = low[0]; i <= high[0]; i++)
      for (int j = low[1]; j <= high[1]; j++)
        for (int k = low[2]; k <= high[2]; k++) chunk.push_back(chunks.add({i, j, k}));
    std::sort(chunk.begin() + first.back(), chunk.end());
    first.push_back(chunk.size());
  }
}

bool RimFactors::together(int a, int b) const
{
  for (int i = first[a]; i < first[a + 1]; i++)
    for (int j = first[b]; j < first[b + 1]; j++)
      if (chunk[i] == chunk[j]) return true;
  return false;
}

void RimFactors::add(int row, int column, const double *value)
{
  const int w = width;
  for (int i = first[row]; i < first[row + 1]; i++)
    for (int j = first[column]; j < first[column + 1]; j++) {
      if (chunk[i] != chunk[j]) continue;
      for (int a = 0; a < w; a++)
        for (int b = 0; b < w; b++)
          if (row != column) {
            entries.emplace_back(i * w + a, j * w + b, value[a * w + b]);
            entries.emplace_back(j * w + b, i * w + a, value[a * w + b]);
          } else
            entries.emplace_back(i * w + a, j * w + b, 0.5 * (value[a * w + b] + value[b * w + a]));
    }
}

bool RimFactors::factorize()
{
  const int n = chunk.size() * width;
  Eigen::SparseMatrix<double> A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  entries = {};
  from.resize(n);
  return MPM_NS::factorize(std::move(A), factors);
}

/** Copies of a node share what it has, so that those in many chunks do not get too much. */
double RimFactors::share(int node) const
{
  return 1.0 / std::sqrt(first[node + 1] - first[node]);
}

void RimFactors::solve(const double *b, double *x)
{
  if (chunk.empty()) return;
  for (int node = 0; node < size(); node++)
    for (int i = first[node]; i < first[node + 1]; i++)
      for (int a = 0; a < width; a++) from[i * width + a] = share(node) * b[node * width + a];
  factors.solve(from.data(), from.data());
  for (int node = 0; node < size(); node++)
    for (int a = 0; a < width; a++) {
      double sum = 0.0;
      for (int i = first[node]; i < first[node + 1]; i++) sum += from[i * width + a];
      x[node * width + a] = share(node) * sum;
    }
}

double RimFactors::memory_usage() const
{
  return (first.capacity() + chunk.capacity()) * sizeof(int) +
      entries.capacity() * sizeof(Eigen::Triplet<double>) + from.capacity() * sizeof(double) +
      factors.memory_usage();
}
