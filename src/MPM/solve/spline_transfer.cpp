/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/spline_transfer.h"

#include <algorithm>

using namespace MPM_NS;

void SplineTransfer::setup(bool to_itself)
{
  whole = to_itself;
  const auto &grid = nodes.grid;
  const int dim = grid.lattice.dim;
  const auto &lattice = grid.lattice;
  for (int d = 0; d < dim; d++) period[d] = lattice.periodic[d] ? (lattice.ncell[d] + 1) / 2 : 0;
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    if (whole)
      parts.parts.push_back({mine.add(nodes.index_of(node)), 1.0});
    else
      each_parent(order, dim, nodes.index_of(node), period,
                  [&](const LatticeIndex &parent, double weight) {
                    parts.parts.push_back({mine.add(parent), weight});
                  });
    parts.end_row();
  }
  const int ww = nodes.width * nodes.width;
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    const std::size_t first = constrained.parts.size();
    const auto add = [&](int at, double weight, const double *P) {
      auto part = constrained.parts.begin() + first;
      while (part != constrained.parts.end() && part->node != at) ++part;
      if (part == constrained.parts.end()) {
        constrained.parts.push_back({at, {}});
        part = constrained.parts.end() - 1;
      }
      for (int ab = 0; ab < ww; ab++) part->W[ab] += weight * P[ab];
    };
    if (!nodes.plain[node] && !nodes.tied[node])
      for (const auto &part : parts.of(node))
        add(part.node, part.weight, nodes.projection_of(node));
    else if (!nodes.plain[node])
      nodes.each_source(node, [&](const LatticeIndex &index, const double *P) {
        if (whole) return add(mine.add(index), 1.0, P);
        each_parent(order, dim, index, period, [&](const LatticeIndex &parent, double weight) {
          add(mine.add(parent), weight, P);
        });
      });
    constrained.end_row();
  }
}

LatticeNodes SplineTransfer::number_nodes(const std::vector<char> &used, std::vector<int> &rows)
{
  LatticeNodes all;
  std::vector<LatticeIndex> given;
  for (std::size_t k = 0; k < used.size(); k++)
    if (used[k]) given.push_back(mine.index[k]);
  const auto of_rank = ranks.gather(std::vector<int>{(int) given.size()});
  const auto given_by_all = ranks.gather(given);
  rows.assign(1, 0);
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
  all_numbers = ranks.gather(list);
  return all;
}

void SplineTransfer::restriction(const double *r, const double *done,
                                 const std::vector<char> &in_system, std::vector<double> &b)
{
  const int w = nodes.width;
  const auto &grid = nodes.grid;
  partial.assign(number.size() * w, 0.0);
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    if (!grid.owns(node) || !in_system[node]) continue;
    double left[3];
    for (int a = 0; a < w; a++) left[a] = r[node * w + a] - (done ? done[node * w + a] : 0.0);
    if (!nodes.plain[node]) {
      for (const auto &part : constrained.of(node))
        add_part(w, part.W, true, 1.0, left, partial.data() + part.node * w);
      continue;
    }
    for (const auto &part : parts.of(node))
      for (int a = 0; a < w; a++) partial[part.node * w + a] += part.weight * left[a];
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < number.size(); k++)
    if (number[k] >= 0) {
      for (int a = 0; a < w; a++) partial[kept * w + a] = partial[k * w + a];
      kept++;
    }
  partial.resize(kept * w);
  ranks.gather(partial, gathered);
  std::fill(b.begin(), b.end(), 0.0);
  for (std::size_t k = 0; k < all_numbers.size(); k++)
    for (int a = 0; a < w; a++) b[all_numbers[k] * w + a] += gathered[k * w + a];
}

void SplineTransfer::prolongation(const std::vector<double> &x, const std::vector<char> &in_system,
                                  double *z) const
{
  const int w = nodes.width;
  for (int64_t node = 0; node < nodes.grid.nnodes(); node++) {
    if (!in_system[node]) continue;
    double motion[3] = {0.0, 0.0, 0.0};
    if (nodes.plain[node]) {
      for (const auto &part : parts.of(node))
        if (const int from = number[part.node]; from >= 0)
          for (int a = 0; a < w; a++) motion[a] += part.weight * x[from * w + a];
    } else {
      for (const auto &part : constrained.of(node))
        if (const int from = number[part.node]; from >= 0)
          add_part(w, part.W, false, 1.0, x.data() + from * w, motion);
    }
    for (int a = 0; a < w; a++) z[node * w + a] += motion[a];
  }
}
