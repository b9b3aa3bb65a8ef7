/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/envelope_factors.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

using namespace MPM_NS;

static constexpr int B = FACTOR_BLOCK;

/** So many places in whole blocks. */
static int padded(int n)
{
  return (n + B - 1) / B * B;
}

/* ----------------------------------------------------------------------
   Unknowns in layers: those that are as many entries away from the first one, which is one that is
   far from another one
------------------------------------------------------------------------- */

void EnvelopeFactors::put_in_layers(const Sparse &A)
{
  const int n = unknowns;
  queue.clear();
  queue.reserve(n);
  layer.assign(n, -1);
  // from a given one: the queue has all that are joined to it, in layers, behind those that it has
  // already
  const auto visit = [&](int seed) {
    std::size_t next = queue.size();
    queue.push_back(seed);
    layer[seed] = 0;
    for (; next < queue.size(); next++)
      for (Sparse::InnerIterator it(A, queue[next]); it; ++it)
        if (const int to = (int) it.row(); layer[to] < 0) {
          layer[to] = layer[queue[next]] + 1;
          queue.push_back(to);
        }
  };
  for (int seed = 0; seed < n; seed++) {
    if (layer[seed] >= 0) continue;
    const std::size_t begin = queue.size();
    int from = seed;
    for (int turn = 0; turn < 3; turn++) {
      for (std::size_t k = begin; k < queue.size(); k++) layer[queue[k]] = -1;
      queue.resize(begin);
      visit(from);
      from = queue.back();
    }
  }
}

void EnvelopeFactors::set_places(const std::vector<LatticeIndex> &nodes, int width)
{
  places.clear();
  for (const auto &node : nodes) places.insert(places.end(), width, node);
}

/** Unknowns in the order of planes across the longest axis. A layer has as many planes as entries
 *  of the matrix reach. */
void EnvelopeFactors::put_in_planes(const Sparse &A)
{
  LatticeIndex low = places[0], high = low;
  for (const auto &place : places)
    for (int d = 0; d < 3; d++) {
      low[d] = std::min(low[d], place[d]);
      high[d] = std::max(high[d], place[d]);
    }
  int axis[3] = {0, 1, 2};
  std::stable_sort(axis, axis + 3, [&](int a, int b) {
    return high[a] - low[a] > high[b] - low[b];
  });
  int reach = 1;
  for (int c = 0; c < unknowns; c++)
    for (Sparse::InnerIterator it(A, c); it; ++it)
      reach = std::max(reach, places[it.row()][axis[0]] - places[c][axis[0]]);
  queue.resize(unknowns);
  std::iota(queue.begin(), queue.end(), 0);
  std::stable_sort(queue.begin(), queue.end(), [&](int a, int b) {
    for (const int d : axis)
      if (places[a][d] != places[b][d]) return places[a][d] < places[b][d];
    return false;
  });
  for (int c = 0; c < unknowns; c++) layer[c] = (places[c][axis[0]] - low[axis[0]]) / reach;
}

/** The number of operations that the factors take in the order of the queue, up to a factor. */
double EnvelopeFactors::operations(const Sparse &A) const
{
  std::vector<int> place(unknowns);
  for (int k = 0; k < unknowns; k++) place[queue[k]] = unknowns - 1 - k;
  double sum = 0.0;
  for (int c = 0; c < unknowns; c++) {
    int first = place[c];
    for (Sparse::InnerIterator it(A, c); it; ++it) first = std::min(first, place[it.row()]);
    const double width = place[c] - first;
    sum += width * width;
  }
  return sum;
}

/** Places of unknowns in one piece. */
void EnvelopeFactors::put_in_order()
{
  const int n = unknowns;
  number.resize(n);
  // backwards, as the envelope then is smaller (A. George, Stanford report STAN-CS-71-208, 1971)
  for (int k = 0; k < n; k++) number[queue[k]] = n - 1 - k;
  unused.clear();
  for (int place = n; place < padded(n); place++) unused.push_back(place);
  part[0] = part[1] = part[2] = padded(n);
}

/** Halves on both sides of the layer that has this one of the queue. Each is put in layers again
 *  (planes stay as they are), from the middle on, and backwards. */
void EnvelopeFactors::cut(const Sparse &A, int at)
{
  const int n = unknowns;
  int low = at, high = at;
  while (low > 0 && layer[queue[low - 1]] == layer[queue[at]]) low--;
  while (high < n && layer[queue[high]] == layer[queue[at]]) high++;
  enum { FREE = -1, MIDDLE = -2 };
  number.assign(n, FREE);
  for (int k = low; k < high; k++) number[queue[k]] = MIDDLE;
  const int from[2] = {0, high}, to[2] = {low, n};
  unused.clear();
  int place = 0;
  std::vector<int> list;
  std::vector<char> mine(n), listed(n, 0);
  for (int which = 0; which < 2; which++) {
    std::fill(mine.begin(), mine.end(), 0);
    for (int k = from[which]; k < to[which]; k++) mine[queue[k]] = 1;
    list.clear();
    const auto take = [&](int of) {
      for (Sparse::InnerIterator it(A, of); it; ++it)
        if (const int k = (int) it.row(); mine[k] && !listed[k]) {
          listed[k] = 1;
          list.push_back(k);
        }
    };
    for (int k = from[which]; k < to[which] && in_planes; k++)
      list.push_back(queue[which ? k : to[0] - 1 - k]);
    for (const int k : list) listed[k] = 1;
    for (int k = low; k < high; k++) take(queue[k]);
    for (std::size_t next = 0; next < list.size(); next++) take(list[next]);
    // what is not joined to the middle
    for (int k = from[which]; k < to[which]; k++)
      if (!listed[queue[k]]) list.push_back(queue[k]);
    for (std::size_t k = list.size(); k-- > 0;) number[list[k]] = place++;
    for (; place % B; place++) unused.push_back(place);
    part[which] = place;
  }
  for (int k = low; k < high; k++) number[queue[k]] = place++;
  for (; place % B; place++) unused.push_back(place);
  part[2] = place;
}

/** The place in the envelope of a half, -1: it is in the other one. */
int EnvelopeFactors::place_in(int which, int place) const
{
  const int begin = begin_of(which), end = part[which];
  if (place >= part[1]) return place - part[1] + end - begin;
  return place >= begin && place < end ? place - begin : -1;
}

void EnvelopeFactors::find_envelopes(const Sparse &A)
{
  const int between = (part[2] - part[1]) / B;
  for (int which = 0; which < 2; which++) {
    half[which].start(0, 0);
    if (!is_mine(which)) continue;
    half[which].start((part[which] - begin_of(which)) / B, between);
    for (int c = 0; c < unknowns; c++) {
      const int column = place_in(which, number[c]);
      if (column < 0) continue;
      for (Sparse::InnerIterator it(A, c); it; ++it)
        if (const int row = place_in(which, number[it.row()]); row >= column)
          half[which].reach(row, column);
    }
  }
  middle.start(between, 0);
  for (int i = 0; i < between; i++) middle.reach(B * i, 0);
}

/** The entries of the matrix in the envelopes; in places of no unknown, unity. */
void EnvelopeFactors::fill(const Sparse &A)
{
  middle.clear();
  for (int which = 0; which < 2; which++) half[which].clear();
  const auto put = [&](int row, int column, double value) {
    if (column / B > row / B) return;
    if (column >= part[1]) {
      middle.at(row - part[1], column - part[1]) = value;
      return;
    }
    const int which = column >= part[0];
    if (is_mine(which)) half[which].at(place_in(which, row), place_in(which, column)) = value;
  };
  for (int c = 0; c < unknowns; c++)
    for (Sparse::InnerIterator it(A, c); it; ++it) put(number[it.row()], number[c], it.value());
  for (const int place : unused) put(place, place, 1.0);
}

/* ---------------------------------------------------------------------- */

bool EnvelopeFactors::compute(const Sparse &A)
{
  unknowns = (int) A.rows();
  constexpr double FEWER = 0.8;
  put_in_layers(A);
  in_planes = false;
  if ((int) places.size() == unknowns && unknowns > 0) {
    const auto layers = std::make_pair(queue, layer);
    const double in_layers = operations(A);
    put_in_planes(A);
    in_planes = operations(A) < FEWER * in_layers;
    if (!in_planes) std::tie(queue, layer) = layers;
  }
  put_in_order();
  find_envelopes(A);
  if (half[0].count() > split) {
    cut(A, std::max(0, unknowns - 1 - half[0].place_of_half()));
    find_envelopes(A);
  }
  return compute_again(A);
}

bool EnvelopeFactors::compute_again(const Sparse &A)
{
  fill(A);
  const bool good = factorize();
  if (precision == ROUNDED)
    for (auto *part : {&half[0], &half[1], &middle}) part->round();
  return good;
}

/** What all ranks have own_part, in their order. */
void EnvelopeFactors::gather()
{
  if (ranks)
    ranks->gather(own_part, gathered);
  else
    gathered = own_part;
}

bool EnvelopeFactors::factorize()
{
  bool good = true;
  for (int which = 0; which < 2; which++)
    if (is_mine(which) && !half[which].factorize()) good = false;
  if (!has_halves()) return good;
  own_part.clear();
  for (int which = 0; which < 2; which++) {
    if (!is_mine(which)) continue;
    own_part.push_back(good);
    half[which].give_rest(own_part);
  }
  gather();
  const double *of = gathered.data();
  for (int which = 0; which < 2; which++) {
    good = good && *of++ == 1.0;
    middle.add(of);
    of += middle.size();
  }
  return good && middle.factorize();
}

void EnvelopeFactors::solve(const double *b, double *x)
{
  solution.assign(part[2], 0.0);
  double *const y = solution.data();
  for (int k = 0; k < unknowns; k++) y[number[k]] = b[k];
  if (!has_halves()) {
    half[0].solve_forward(y);
    half[0].solve_backward(y);
    for (int k = 0; k < unknowns; k++) x[k] = y[number[k]];
    return;
  }
  const int between = part[2] - part[1];
  const auto end_of = [this](int which) {
    return part[which] - begin_of(which);
  };
  own_part.clear();
  for (int which = 0; which < 2; which++) {
    if (!is_mine(which)) continue;
    auto &own = of_half[which];
    own.assign(y + begin_of(which), y + part[which]);
    own.resize(end_of(which) + between, 0.0);
    half[which].solve_forward(own.data());
    own_part.insert(own_part.end(), own.begin() + end_of(which), own.end());
  }
  gather();
  double *const inner = y + part[1];
  for (int which = 0; which < 2; which++)
    for (int k = 0; k < between; k++) inner[k] += gathered[(std::size_t) between * which + k];
  middle.solve_forward(inner);
  middle.solve_backward(inner);
  own_part.clear();
  for (int which = 0; which < 2; which++) {
    if (!is_mine(which)) continue;
    auto &own = of_half[which];
    std::copy_n(inner, between, own.begin() + end_of(which));
    half[which].solve_backward(own.data());
    own_part.insert(own_part.end(), own.begin(), own.begin() + end_of(which));
  }
  gather();
  for (int k = 0; k < unknowns; k++)
    x[k] = number[k] < part[1] ? gathered[number[k]] : y[number[k]];
}

double EnvelopeFactors::memory_usage() const
{
  return half[0].memory_usage() + half[1].memory_usage() + middle.memory_usage() +
      bytes_of(number, queue, layer, places, unused, solution, own_part, gathered, of_half[0],
               of_half[1]);
}
