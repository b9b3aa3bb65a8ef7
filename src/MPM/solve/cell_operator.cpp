/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/cell_operator.h"

#include <algorithm>

using namespace MPM_NS;

void CellGraph::color()
{
  for (auto &list : colored) list.clear();
  for (int cell = 0; cell < size(); cell++) {
    const int *const i = index.data() + 3 * cell;
    colored[(i[0] + i[1] + i[2]) & 1].push_back(cell);
  }
}

bool CellGraph::is_proper() const
{
  const auto color_of = [this](int64_t cell) {
    const int *const i = index.data() + 3 * cell;
    return (i[0] + i[1] + i[2]) & 1;
  };
  for (int cell = 0; cell < size(); cell++)
    for (int k = first[cell]; k < first[cell + 1]; k++)
      if (color_of(neighbor[k]) == color_of(cell)) return false;
  return true;
}

/* ---------------------------------------------------------------------- */

void CellOperator::clear()
{
  face.assign(grid.nnodes() * grid.lattice.dim, 0.0);
  outside.assign(grid.nnodes(), 0.0);
}

void CellOperator::share()
{
  const auto share = [&](std::vector<double> &values, int width) {
    std::vector<double> holders(values.size());
    for (std::size_t k = 0; k < values.size(); k++) holders[k] = values[k] > 0.0 ? 1.0 : 0.0;
    ranks.sum(holders.data(), width);
    for (std::size_t k = 0; k < values.size(); k++)
      if (values[k] > 0.0) values[k] /= holders[k];
  };
  share(face, grid.lattice.dim);
  share(outside, 1);
}

void CellOperator::finish()
{
  const int dim = grid.lattice.dim;
  const int64_t nnodes = grid.nnodes();

  // this rank's part of the diagonal, then that of all

  std::vector<double> diagonal(outside);
  std::vector<int64_t> next(nnodes * dim, -1), before(nnodes * dim, -1);
  for (int64_t node = 0; node < nnodes; node++)
    for (int d = 0; d < dim; d++) {
      if (!(face[node * dim + d] > 0.0)) continue;
      int at[3];
      grid.node_index(node, at);
      at[d]++;
      const int64_t other = grid.locate_near(grid.blocks[node / NODES_PER_BLOCK], at);
      if (other < 0) continue;
      next[node * dim + d] = other;
      before[other * dim + d] = node;
      diagonal[node] += face[node * dim + d];
      diagonal[other] += face[node * dim + d];
    }
  ranks.sum(diagonal.data(), 1);

  graph = CellGraph();
  graph.first.push_back(0);
  for (int64_t node = 0; node < nnodes; node++) {
    if (!(diagonal[node] > 0.0)) continue;
    int at[3];
    grid.node_index(node, at);
    for (int d = 0; d < 3; d++) graph.index.push_back(d < dim ? grid.lattice.wrap(d, at[d]) : 0);
    graph.where.push_back(node);
    graph.outside.push_back(outside[node]);
    graph.inverse.push_back(1.0 / diagonal[node]);
    for (int d = 0; d < dim; d++) {
      if (const int64_t other = before[node * dim + d]; other >= 0) {
        graph.neighbor.push_back(other);
        graph.face.push_back(face[other * dim + d]);
      }
      if (const int64_t other = next[node * dim + d]; other >= 0) {
        graph.neighbor.push_back(other);
        graph.face.push_back(face[node * dim + d]);
      }
    }
    graph.first.push_back(graph.neighbor.size());
  }
  graph.color();
}

void CellOperator::apply(const double *x, double *y) const
{
  std::fill_n(y, grid.nnodes(), 0.0);
  for (int cell = 0; cell < graph.size(); cell++) y[graph.where[cell]] = graph.flow(cell, x);
  ranks.sum(y, 1);
}

void CellOperator::scale(const double *r, double *z) const
{
  std::fill_n(z, grid.nnodes(), 0.0);
  for (int cell = 0; cell < graph.size(); cell++)
    z[graph.where[cell]] = graph.inverse[cell] * r[graph.where[cell]];
}
