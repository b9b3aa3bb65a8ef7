/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_NODE_CONSTRAINTS_H
#define MPM_SOLVE_NODE_CONSTRAINTS_H

#include "lattice/grid.h"
#include "solve/lattice_nodes.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace MPM_NS {
/** A block [width][width] of a matrix. */
struct MatrixBlock {
  int row, column;
  double value[9];
};
/** to += c A^T B of matrices [w][w] */
inline void add_product(int w, const double *A, const double *B, double c, double *to)
{
  for (int k = 0; k < w; k++)
    for (int a = 0; a < w; a++)
      for (int b = 0; b < w; b++) to[a * w + b] += c * A[k * w + a] * B[k * w + b];
}

/** to += c W from, or c W^T from. */
inline void add_part(int w, const double *W, bool transposed, double c, const double *from,
                     double *to)
{
  for (int a = 0; a < w; a++)
    for (int b = 0; b < w; b++) to[a] += c * (transposed ? W[b * w + a] : W[a * w + b]) * from[b];
}

/** x <- P x, or P^T x, of the nodes that have rows in the list: row u, column x of u = P x. */
inline void apply_constraints(int w, const std::vector<MatrixBlock> &list, bool transposed,
                              std::vector<double> &x)
{
  const auto before = x;
  for (const auto &part : list) std::fill_n(x.data() + (std::size_t) part.row * w, w, 0.0);
  for (const auto &part : list) {
    const int from = transposed ? part.row : part.column, to = transposed ? part.column : part.row;
    add_part(w, part.value, transposed, 1.0, before.data() + (std::size_t) from * w,
             x.data() + (std::size_t) to * w);
  }
}

/** A term of a constraint that couples several nodes: the motion of a node is u = sum P x over
 *  itself and other nodes, with P [width][width]. */
struct NodeTie {
  int64_t node;
  LatticeIndex other;
  double P[9];
};

/** The constraints of the nodes of a rank: u = P x of the node itself, or u = sum P x. */
class NodeConstraints {
 public:
  NodeConstraints(const Grid &grid, int width) : grid(grid), width(width) {}
  const Grid &grid;
  const int width;

  std::vector<char> plain;      ///< [node] it has no constraint
  std::vector<char> tied;       ///< [node] it is coupled with others
  std::vector<NodeTie> ties;    ///< sorted by node

  /** projection: [node][width][width]; null: none. */
  void setup(const double *given, const std::vector<NodeTie> &given_ties)
  {
    const int64_t nnodes = grid.nnodes();
    const int w = width;
    plain.assign(nnodes, 1);
    if (given) {
      projection.assign(given, given + nnodes * w * w);
      for (int64_t node = 0; node < nnodes; node++)
        for (int a = 0; a < w; a++)
          for (int b = 0; b < w; b++)
            if (given[(node * w + a) * w + b] != (a == b ? 1.0 : 0.0)) plain[node] = 0;
    }
    ties = given_ties;
    tied.assign(nnodes, 0);
    for (const auto &tie : ties) {
      tied[tie.node] = 1;
      plain[tie.node] = 0;
    }
  }
  /** Index of a node, the same for all of its periodic images. */
  LatticeIndex index_of(int64_t node) const
  {
    int at[3];
    grid.node_index(node, at);
    LatticeIndex index{0, 0, 0};
    for (int d = 0; d < grid.lattice.dim; d++) index[d] = grid.lattice.wrap(d, at[d]);
    return index;
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
    auto tie = std::lower_bound(ties.begin(), ties.end(), node, [](const NodeTie &a, int64_t of) {
      return a.node < of;
    });
    for (; tie != ties.end() && tie->node == node; ++tie) f(tie->other, tie->P);
  }
  double memory_usage() const { return bytes_of(projection, plain, tied, ties); }

 private:
  std::vector<double> projection;    // [node][width][width], empty: none
};

/** Parts that each of several functions or nodes has in those of another set. */
template <class One> struct PartLists {
  using Part = One;
  struct Range {
    const Part *from, *to;
    const Part *begin() const { return from; }
    const Part *end() const { return to; }
  };
  std::vector<int> first{0};    // [rows + 1] ranges in parts
  std::vector<Part> parts;

  Range of(int64_t row) const { return {parts.data() + first[row], parts.data() + first[row + 1]}; }
  void end_row() { first.push_back((int) parts.size()); }
  double memory_usage() const { return bytes_of(first, parts); }
};

/** Each function as a weighted sum of functions of a coarser level. */
struct WeightedPart {
  int node;
  double weight;
};
using CoarseParts = PartLists<WeightedPart>;

/** What nodes with constraints are of the nodes of another set: u = sum W x, with W
 *  [width][width]. */
struct ConstrainedPart {
  int node;
  double W[9];
};
struct ConstrainedParts : PartLists<ConstrainedPart> {
  /** Calls f(i, j) for the parts i and j of a node, in one triangle. */
  template <class F> void each_pair(int64_t node, const F &f) const
  {
    for (const auto &i : of(node))
      for (const auto &j : of(node))
        if (i.node >= j.node) f(i, j);
  }
  /** Calls f(block) for the blocks of c (1 - P)^T (1 - P): the directions that a constraint takes
   *  from a node get this stiffness, so that they are no motions without any. self: the node in the
   *  other set. */
  template <class F> void each_fixed(int w, int64_t node, int self, double c, const F &f) const
  {
    std::vector<Part> rest(of(node).begin(), of(node).end());
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
        MatrixBlock block{i.node, j.node, {}};
        add_product(w, i.W, j.W, c, block.value);
        f(block);
      }
  }
};

}    // namespace MPM_NS
#endif
