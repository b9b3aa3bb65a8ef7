/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/point_stiffness.h"

#include <algorithm>

using namespace MPM_NS;

namespace {

/** Adds to one triangle of the element, blocks [number][number] of [W][W], the stiffness of
 *  functions with the gradients [G] by the stiffness C [G W][G W] of a point. */
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
void add_projected_blocks(int number, const double *gradients, const double *C, double *element)
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

}    // namespace

/** The stiffness of points with other nodes. */
void PointStiffness::start(int n, const int64_t *of)
{
  flush();
  current.assign(of, of + n);
  held = false;
  for (const int64_t node : current) {
    held = held || !constraints.plain[node];
    const auto add = [&](int at) {
      const bool known = place[at] >= 0;
      // a whole system has nodes as they are: images of one in a narrow periodic box become one
      // when they are projected
      if (transfer.whole) held = held || known;
      if (known && !transfer.whole) return;
      place[at] = local.size();
      local.push_back(at);
    };
    if (constraints.plain[node] || transfer.whole)
      for (const auto &part : transfer.parts.of(node)) add(part.node);
    else
      for (const auto &part : transfer.constrained.of(node)) add(part.node);
  }
  element.assign(local.size() * local.size() * width * width, 0.0);
  rim_local.clear();
  for (int i = 0; i < n; i++)
    if (smoother.in_rim(current[i]) >= 0) rim_local.push_back(i);
  rim_element.assign(rim_local.size() * rim_local.size() * width * width, 0.0);
}

/** From the stiffness K [n][n] of nodes, one triangle, to that of the nodes x of u = P x. number:
 *  of each node, and then of each x. */
template <int W>
void PointStiffness::project(const std::vector<int64_t> &of, const ConstrainedParts &parts,
                             std::vector<int> &number, std::vector<double> &K)
{
  constexpr int WW = W * W;
  const std::size_t n = of.size();
  constexpr auto identity = [] {
    ConstrainedPart same{0, {}};
    for (int a = 0; a < W; a++) same.W[a * W + a] = 1.0;
    return same;
  }();
  const auto each_part = [&](std::size_t i, const auto &f) {
    if (constraints.plain[of[i]]) return f(number[i], identity.W);
    for (const auto &part : parts.of(of[i])) f(part.node, part.W);
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

void PointStiffness::flush()
{
  const int w = width;
  const auto projected = w == 1 ? &PointStiffness::project<1>
      : w == 2                  ? &PointStiffness::project<2>
                                : &PointStiffness::project<3>;
  for (const int node : local) place[node] = -1;
  if (transfer.whole && held) (this->*projected)(current, transfer.constrained, local, element);
  const int n = local.size();
  for (int I = 0; I < n; I++)
    for (int J = 0; J <= I; J++)
      blocks.add_lower(local[I], local[J], element.data() + (I * n + J) * w * w, w);
  // of the rim, projected, between nodes of the same chunk
  std::vector<int64_t> of_rim;
  std::vector<int> in_rim;
  bool free = true;
  for (const int i : rim_local) {
    of_rim.push_back(current[i]);
    in_rim.push_back(smoother.in_rim(current[i]));
    free = free && constraints.plain[current[i]];
  }
  if (!free) (this->*projected)(of_rim, smoother.parts, in_rim, rim_element);
  const int m = in_rim.size();
  for (int I = 0; I < m; I++)
    for (int J = 0; J <= I; J++)
      if (smoother.together(in_rim[I], in_rim[J]))
        smoother.add(in_rim[I], in_rim[J], rim_element.data() + (I * m + J) * w * w);
  local.clear();
  current.clear();
  rim_local.clear();
}

void PointStiffness::add_point(int n, const int64_t *nodes, int ngrad, const double *gradient,
                               const double *stiffness)
{
  if ((int) current.size() != n || !std::equal(nodes, nodes + n, current.begin())) start(n, nodes);
  const int w = width, m = w * ngrad, nc = local.size();
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
      rim_local.size(),
      [&](int J) {
        return gradient + rim_local[J] * ngrad;
      },
      rim_element);
  if (transfer.whole) {
    add(
        n,
        [&](int J) {
          return gradient + J * ngrad;
        },
        element);
    return;
  }
  if (!held) {
    // G_J: [ngrad] gradient of a coarse function

    G.assign(nc * ngrad, 0.0);
    for (int i = 0; i < n; i++)
      for (const auto &part : transfer.parts.of(nodes[i])) {
        double *const g = G.data() + place[part.node] * ngrad;
        for (int l = 0; l < ngrad; l++) g[l] += part.weight * gradient[i * ngrad + l];
      }
    add(
        nc,
        [&](int J) {
          return G.data() + J * ngrad;
        },
        element);
    return;
  }

  G.assign((std::size_t) nc * m * w, 0.0);
  for (int i = 0; i < n; i++) {
    const auto g_of = [&](int coarse) {
      return G.data() + (std::size_t) place[coarse] * m * w;
    };
    if (constraints.plain[nodes[i]]) {
      for (const auto &part : transfer.parts.of(nodes[i]))
        for (int l = 0; l < ngrad; l++)
          for (int a = 0; a < w; a++)
            g_of(part.node)[(l * w + a) * w + a] += part.weight * gradient[i * ngrad + l];
      continue;
    }
    for (const auto &part : transfer.constrained.of(nodes[i]))
      for (int l = 0; l < ngrad; l++)
        for (int ab = 0; ab < w * w; ab++)
          g_of(part.node)[l * w * w + ab] += gradient[i * ngrad + l] * part.W[ab];
  }
  static constexpr void (*projected_table[3][3])(int, const double *, const double *, double *) = {
      {add_projected_blocks<1, 1>, add_projected_blocks<1, 2>, add_projected_blocks<1, 3>},
      {add_projected_blocks<2, 1>, add_projected_blocks<2, 2>, add_projected_blocks<2, 3>},
      {add_projected_blocks<3, 1>, add_projected_blocks<3, 2>, add_projected_blocks<3, 3>}};
  projected_table[w - 1][ngrad - 1](nc, G.data(), symmetric, element.data());
}

void PointStiffness::add_mean(int64_t around, int kind, const double sums[3], int n,
                              const int64_t *nodes, const double *changes)
{
  flush();
  MeanTerms::Head head{
      lattice_key(constraints.index_of(around)), kind, 0, {sums[0], sums[1], sums[2]}};
  MeanTerms::Head of_rim = head;
  const std::size_t first = means.values.size();
  for (int i = 0; i < n; i++) {
    const double *const change = changes + (std::size_t) i * width;
    const auto value_of = [&](int coarse) {
      int &at = place[coarse];
      if (at < 0) {
        at = (int) (means.values.size() - first);
        means.values.push_back({coarse, {0.0, 0.0, 0.0}});
      }
      return means.values[first + at].value;
    };
    const bool in_rim = smoother.in_rim(nodes[i]) >= 0;
    const auto add_to_rim = [&](int at) {
      smoother.means.values.push_back({at, {0.0, 0.0, 0.0}});
      of_rim.count++;
      return smoother.means.values.back().value;
    };
    if (constraints.plain[nodes[i]]) {
      for (const auto &part : transfer.parts.of(nodes[i])) {
        double *const to = value_of(part.node);
        for (int a = 0; a < width; a++) to[a] += part.weight * change[a];
      }
      if (in_rim) std::copy_n(change, width, add_to_rim(smoother.in_rim(nodes[i])));
      continue;
    }
    for (const auto &part : transfer.constrained.of(nodes[i]))
      add_part(width, part.W, true, 1.0, change, value_of(part.node));
    if (!in_rim) continue;
    for (const auto &part : smoother.parts.of(nodes[i]))
      add_part(width, part.W, true, 1.0, change, add_to_rim(part.node));
  }
  head.count = (int) (means.values.size() - first);
  for (std::size_t k = first; k < means.values.size(); k++) place[means.values[k].node] = -1;
  means.heads.push_back(head);
  if (of_rim.count) smoother.means.heads.push_back(of_rim);
}

void PointStiffness::add_masses(const double *mass)
{
  const int w = width;
  const auto &grid = constraints.grid;
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    if (!grid.owns(node) || !(mass[node] > 0.0)) continue;
    if (!constraints.plain[node]) {
      transfer.constrained.each_pair(node, [&](const auto &i, const auto &j) {
        add_product(w, i.W, j.W, mass[node], blocks.at(i.node, j.node).value);
      });
      continue;
    }
    for (const auto &i : transfer.parts.of(node))
      for (const auto &j : transfer.parts.of(node)) {
        if (j.node > i.node) continue;
        auto &to = blocks.at(i.node, j.node);
        for (int a = 0; a < w; a++) to.value[a * w + a] += i.weight * j.weight * mass[node];
      }
  }
}

double PointStiffness::memory_usage() const
{
  return blocks.memory_usage() + means.memory_usage() +
      bytes_of(current, local, place, rim_local, element, G, KP, rim_element);
}
