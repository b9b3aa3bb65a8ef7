/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "lattice/grid.h"

#include <algorithm>
#include <climits>
#include <cstring>
#include <new>
#include <numeric>
#include <type_traits>

using namespace MPM_NS;

void Grid::clear()
{
  blocks.clear();
  table.clear();
  alias_node.clear();
  alias_of.clear();
  std::fill_n(reach_low, 3, INT_MIN);
  std::fill_n(reach_high, 3, INT_MAX);
}

int Grid::find(uint64_t key) const
{
  auto found = table.find(key);
  return found == table.end() ? -1 : found->second;
}

int Grid::activate(const int b[3])
{
  auto inserted = table.emplace(key(b), (int) blocks.size());
  if (inserted.second) {
    Block block;
    std::copy(b, b + 3, block.b);
    std::fill(block.slot, block.slot + 27, -1);
    blocks.push_back(block);
  }
  return inserted.first->second;
}

int64_t Grid::locate(const int index[3]) const
{
  const int b[3] = {index[0] >> shift_bits, index[1] >> shift_bits,
                    lattice.dim == 3 ? index[2] >> shift_bits : 0};
  const int slot = find(b);
  if (slot < 0) return -1;
  return (int64_t) slot * NODES_PER_BLOCK + number(index);
}

void Grid::close_periodic()
{
  if (!lattice.periodic[0] && !lattice.periodic[1] && !lattice.periodic[2]) return;

  // blocks made active here are canonical, so that one pass over the growing list is enough
  for (std::size_t ib = 0; ib < blocks.size(); ib++) {
    bool inside = true;
    for (int d = 0; d < lattice.dim; d++)
      if (lattice.periodic[d]) {
        const int lo = blocks[ib].b[d] * side;
        inside = inside && lo >= 0 && lo + side <= lattice.ncell[d];
      }
    if (inside) continue;
    int canonical_block[3], slot = -1;    // of the last node, mostly that of the next one
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      int index[3], canonical[3];
      node_index(blocks[ib], n, index);
      bool same = true, reached = true;
      for (int d = 0; d < 3; d++) {
        canonical[d] = d < lattice.dim ? lattice.wrap(d, index[d]) : 0;
        same = same && canonical[d] == index[d];
        reached = reached && index[d] >= reach_low[d] && index[d] <= reach_high[d];
      }
      if (same) continue;
      const int b[3] = {canonical[0] >> shift_bits, canonical[1] >> shift_bits,
                        lattice.dim == 3 ? canonical[2] >> shift_bits : 0};
      if (slot < 0 || !std::equal(b, b + 3, canonical_block)) {
        slot = activate(b);
        std::copy_n(b, 3, canonical_block);
      }
      blocks[ib].alias |= uint64_t(1) << n;
      blocks[slot].reached |= (blocks[ib].reached >> n & 1) << number(canonical);
      if (!reached) continue;
      alias_node.push_back((int64_t) ib * NODES_PER_BLOCK + n);
      alias_of.push_back((int64_t) slot * NODES_PER_BLOCK + number(canonical));
    }
  }
}

void Grid::finish()
{
  for (auto &block : blocks) {
    block.owned = ~block.alias;
    for (int s = 0; s < 27; s++) {
      const int b[3] = {block.b[0] + s / 9 - 1, block.b[1] + s / 3 % 3 - 1, block.b[2] + s % 3 - 1};
      block.slot[s] = lattice.dim == 3 || s % 3 == 1 ? find(b) : -1;
    }
  }
}

uint64_t Grid::nodes_between(const Block &block, const int low[3], const int high[3]) const
{
  uint64_t bits = 1;
  for (int d = lattice.dim - 1, stride = 1; d >= 0; d--, stride *= side) {
    const uint64_t row = bits;
    bits = 0;
    const int first = block.b[d] * side;
    const int begin = std::max(0, low[d] - first), end = std::min(side - 1, high[d] - first);
    for (int k = begin; k <= end; k++) bits |= row << k * stride;
  }
  return bits;
}

void Grid::allocate(int nreal_in)
{
  nreal = nreal_in;
  const int64_t need = nnodes() * nreal;
  if (need > capacity) {
    node.reset();    // never both at a time, to save memory
    capacity = need + need / 8 + 512;
    void *memory = nullptr;
    if (posix_memalign(&memory, 64, capacity * sizeof(double)) != 0) throw std::bad_alloc();
    node.reset(static_cast<double *>(memory));
  }
  zero();
}

void Grid::zero()
{
  if (node) memset(nodes(), 0, nnodes() * nreal * sizeof(double));
}

namespace {

/** Calls move(n). Where n is small it is one that the compiler knows: an inner loop over a few
 *  numbers would take twice the time of their sums. */
template <class Move> void with_width(int n, const Move &move)
{
  switch (n) {
    case 1:
      return move(std::integral_constant<int, 1>());
    case 2:
      return move(std::integral_constant<int, 2>());
    case 3:
      return move(std::integral_constant<int, 3>());
    case 4:
      return move(std::integral_constant<int, 4>());
    default:
      return move(n);
  }
}

}    // namespace

void Grid::fold_aliases(double *nodes, int nreals, int lane, int nlane) const
{
  with_width(nlane, [&](auto width) {
    for (std::size_t k = 0; k < alias_node.size(); k++) {
      const double *from = nodes + alias_node[k] * nreals + lane;
      double *to = nodes + alias_of[k] * nreals + lane;
      for (int r = 0; r < width; r++) to[r] += from[r];
    }
  });
}

void Grid::copy_aliases(double *nodes, int nreals) const
{
  with_width(nreals, [&](auto width) {
    for (std::size_t k = 0; k < alias_node.size(); k++) {
      const double *from = nodes + alias_of[k] * width;
      double *to = nodes + alias_node[k] * width;
      for (int r = 0; r < width; r++) to[r] = from[r];
    }
  });
}

std::vector<int64_t> Grid::canonical() const
{
  std::vector<int64_t> nodes(nnodes());
  std::iota(nodes.begin(), nodes.end(), 0);
  for (std::size_t k = 0; k < alias_node.size(); k++) nodes[alias_node[k]] = alias_of[k];
  return nodes;
}

int64_t Grid::memory_usage() const
{
  return capacity * sizeof(double) + blocks.capacity() * sizeof(Block) +
      (alias_node.capacity() + alias_of.capacity()) * sizeof(int64_t) +
      table.size() * (sizeof(uint64_t) + sizeof(int) + 3 * sizeof(void *));
}
