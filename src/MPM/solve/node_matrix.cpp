/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/node_matrix.h"

#include "solve/bytes_of.h"

#include <algorithm>
#include <type_traits>

using namespace MPM_NS;

static int power(int base, int exponent)
{
  return exponent ? base * power(base, exponent - 1) : 1;
}

void NodeMatrix::begin(const Grid &of, int reach_of_points)
{
  if (grid != &of || reach != reach_of_points) {
    grid = &of;
    dim = of.lattice.dim;
    reach = reach_of_points;
    width = power(2 * reach + 1, dim);
    const int side = of.side, across = side + 2 * reach;
    sources.clear();
    for (int k = 0; k < power(across, dim); k++) {
      int at[3] = {0, 0, 0}, neighbor = 0, rest = k;
      for (int d = dim - 1; d >= 0; d--) {
        at[d] = rest % across - reach;
        rest /= across;
      }
      for (int d = 0; d < 3; d++) neighbor = 3 * neighbor + (at[d] < 0 ? 0 : at[d] < side ? 1 : 2);
      sources.push_back({neighbor, of.number(at)});
    }
  }
  value.assign((std::size_t) of.nnodes() * width, 0.0);
  used.assign((std::size_t) of.nnodes() / of.side, 0);
  current.clear();
}

void NodeMatrix::add_point(int n, const int64_t *nodes, int ngrad, const double *gradient,
                           const double *stiffness)
{
  if ((std::size_t) n != current.size() || !std::equal(nodes, nodes + n, current.begin())) {
    flush();
    current.assign(nodes, nodes + n);
    element.assign((std::size_t) n * n, 0.0);
  }
  by_axis.resize(3 * (std::size_t) n);
  double *const g0 = by_axis.data(), *const g1 = g0 + n, *const g2 = g1 + n;
  for (int i = 0; i < n; i++) {
    g0[i] = gradient[ngrad * i];
    g1[i] = ngrad > 1 ? gradient[ngrad * i + 1] : 0.0;
    g2[i] = ngrad > 2 ? gradient[ngrad * i + 2] : 0.0;
  }
  double K[3][3] = {};
  for (int d = 0; d < ngrad; d++)
    for (int e = 0; e < ngrad; e++) K[d][e] = stiffness[ngrad * d + e];
  double *row = element.data();
  for (int i = 0; i < n; i++, row += n) {
    const double h0 = g0[i] * K[0][0] + g1[i] * K[1][0] + g2[i] * K[2][0],
                 h1 = g0[i] * K[0][1] + g1[i] * K[1][1] + g2[i] * K[2][1],
                 h2 = g0[i] * K[0][2] + g1[i] * K[1][2] + g2[i] * K[2][2];
    if (ngrad < 3)
      for (int j = 0; j < n; j++) row[j] += h0 * g0[j] + h1 * g1[j];
    else
      for (int j = 0; j < n; j++) row[j] += h0 * g0[j] + h1 * g1[j] + h2 * g2[j];
  }
}

/** Adds what has been kept of points with the same nodes. */
void NodeMatrix::flush()
{
  const int n = (int) current.size(), row = 2 * reach + 1, side = grid ? grid->side : 1;
  if (n == 0) return;
  std::vector<int> entry(n);    // of a row, relative to that of a node at the origin
  for (int i = 0; i < n; i++) {
    int index[3];
    grid->node_index(current[i], index);
    entry[i] = 0;
    for (int d = 0; d < dim; d++) entry[i] = row * entry[i] + index[d];
    used[current[i] / side] = 1;
  }
  for (int i = 0; i < n; i++) {
    double *const from = value.data() + place(current[i], width / 2);
    const double *const mine = element.data() + (std::size_t) n * i;
    for (int j = 0; j < n; j++) from[(entry[j] - entry[i]) * side] += mine[j];
  }
  current.clear();
}

template <int DIM, int REACH> void NodeMatrix::multiply_blocks(const double *x, double *y) const
{
  constexpr int SIDE = DIM == 3 ? 4 : 8, ACROSS = SIDE + 2 * REACH, ROW = 2 * REACH + 1;
  constexpr int PLANES = DIM == 3 ? SIDE : 1, LAYERS = DIM == 3 ? ROW : 1;
  constexpr int NTILE = DIM == 3 ? ACROSS * ACROSS * ACROSS : ACROSS * ACROSS;
  constexpr int NLINE = NODES_PER_BLOCK / SIDE;
  double tile[NTILE];
  for (std::size_t slot = 0; slot < grid->blocks.size(); slot++) {
    double *const out = y + slot * NODES_PER_BLOCK;
    std::fill_n(out, NODES_PER_BLOCK, 0.0);
    const char *is_used = used.data() + slot * NLINE;
    if (std::none_of(is_used, is_used + NLINE, [](char is) {
          return is;
        }))
      continue;
    const int *const neighbors = grid->blocks[slot].slot;
    for (int k = 0; k < NTILE; k++) {
      const int from = neighbors[sources[k].neighbor];
      tile[k] = from < 0 ? 0.0 : x[(std::size_t) from * NODES_PER_BLOCK + sources[k].node];
    }
    const double *entry = value.data() + slot * NODES_PER_BLOCK * (std::size_t) width;
    double *sum = out;
    for (int plane = 0; plane < PLANES; plane++)
      for (int line = 0; line < SIDE; line++, sum += SIDE) {
        if (!*is_used++) {
          entry += width * SIDE;
          continue;
        }
        const double *const own =
            tile + ((DIM == 3 ? plane + REACH : 0) * ACROSS + line + REACH) * ACROSS + REACH;
        for (int a = 0; a < LAYERS; a++)
          for (int b = 0; b < ROW; b++) {
            const double *at = tile + ((plane + a) * ACROSS + line + b) * ACROSS;
            for (int c = 0; c < ROW; c++, entry += SIDE, at++)
              for (int s = 0; s < SIDE; s++) sum[s] += entry[s] * (at[s] - own[s]);
          }
      }
  }
}

void NodeMatrix::multiply(const double *x, double *y) const
{
  const auto go = [&](auto of_dim) {
    constexpr int DIM = decltype(of_dim)::value;
    if (reach == 1) return multiply_blocks<DIM, 1>(x, y);
    if (reach == 2) return multiply_blocks<DIM, 2>(x, y);
    return multiply_blocks<DIM, 3>(x, y);
  };
  if (dim == 3)
    go(std::integral_constant<int, 3>());
  else
    go(std::integral_constant<int, 2>());
}

double NodeMatrix::memory_usage() const
{
  return bytes_of(value, used, sources, current, element, by_axis);
}
