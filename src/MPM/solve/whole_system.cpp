/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/whole_system.h"

#include "solve/node_constraints.h"
#include "solve/rim_factors.h"

#include <algorithm>

using namespace MPM_NS;

void WholeSystem::build(LatticeNodes all, const std::vector<MatrixBlock> &constraints,
                        const std::vector<MatrixBlock> &mine)
{
  nodes = std::move(all);
  ranks.gather(constraints, constrained);
  ranks.gather(mine, blocks);
  factors.set_places(nodes.index, width);
  assemble();
  b.resize(nodes.index.size() * width);
  x.resize(b.size());
}

bool WholeSystem::factorize(bool same_places)
{
  return factorize_rows(matrix, factors, same_places);
}

void WholeSystem::assemble()
{
  const int w = width, n = (int) nodes.index.size() * w;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(blocks.size() * w * w * 2);
  for (const auto &b : blocks)
    for (int i = 0; i < w; i++)
      for (int j = 0; j < w; j++) {
        const double value = b.value[i * w + j];
        entries.emplace_back(b.row * w + i, b.column * w + j, value);
        if (b.row != b.column) entries.emplace_back(b.column * w + j, b.row * w + i, value);
      }
  matrix.resize(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  slots.clear();
  const auto slot = [&](int row, int column) {
    const int *const inner = matrix.innerIndexPtr(), *const outer = matrix.outerIndexPtr();
    return (int) (std::lower_bound(inner + outer[row], inner + outer[row + 1], column) - inner);
  };
  slots.reserve(2 * entries.size());
  for (const auto &b : blocks)
    for (int i = 0; i < w; i++)
      for (int j = 0; j < w; j++) {
        slots.push_back(slot(b.row * w + i, b.column * w + j));
        slots.push_back(b.row != b.column ? slot(b.column * w + j, b.row * w + i) : -1);
      }
}

bool WholeSystem::refill(const std::vector<MatrixBlock> &mine)
{
  const int w = width;
  const auto before = blocks;
  ranks.gather(mine, blocks);
  const bool same = before.size() == blocks.size() &&
      std::equal(before.begin(), before.end(), blocks.begin(),
                 [](const MatrixBlock &a, const MatrixBlock &b) {
                   return a.row == b.row && a.column == b.column;
                 });
  if (!same) return false;
  double *const values = matrix.valuePtr();
  std::fill_n(values, matrix.nonZeros(), 0.0);
  const int *to = slots.data();
  for (const auto &b : blocks)
    for (int ij = 0; ij < w * w; ij++, to += 2) {
      values[to[0]] += b.value[ij];
      if (to[1] >= 0) values[to[1]] += b.value[ij];
    }
  return true;
}

void WholeSystem::solve(std::vector<double> &given)
{
  apply_constraints(width, constrained, true, given);
  factors.solve(given.data(), given.data());
  apply_constraints(width, constrained, false, given);
}

double WholeSystem::memory_usage() const
{
  return factors.memory_usage() + nodes.memory_usage() +
      matrix.nonZeros() * (sizeof(double) + sizeof(int)) + matrix.rows() * sizeof(int) +
      bytes_of(constrained, blocks, slots, x, b);
}
