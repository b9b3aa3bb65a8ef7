/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "lattice/grid.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

using namespace MPM_NS;

Grid::Grid(const Lattice &lattice_in) : lattice(lattice_in), nreal(0), node(nullptr), capacity(0)
{
  side = lattice.dim == 3 ? 4 : 8;
  shift_bits = lattice.dim == 3 ? 2 : 3;
}

Grid::~Grid()
{
  free(node);
}

void Grid::clear()
{
  blocks.clear();
  table.clear();
  alias_node.clear();
  alias_of.clear();
}

int Grid::find(const int b[3]) const
{
  auto found = table.find(key(b));
  return found == table.end() ? -1 : found->second;
}

int Grid::activate(const int b[3])
{
  auto inserted = table.emplace(key(b), (int) blocks.size());
  if (inserted.second) {
    Block block;
    for (int d = 0; d < 3; d++) block.b[d] = b[d];
    for (int &s : block.slot) s = -1;
    block.alias = 0;
    block.owned = 0;
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
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      int index[3], canonical[3];
      node_index(blocks[ib], n, index);
      bool same = true;
      for (int d = 0; d < 3; d++) {
        canonical[d] = d < lattice.dim ? lattice.wrap(d, index[d]) : 0;
        same = same && canonical[d] == index[d];
      }
      if (same) continue;
      const int b[3] = {canonical[0] >> shift_bits, canonical[1] >> shift_bits,
                        lattice.dim == 3 ? canonical[2] >> shift_bits : 0};
      activate(b);
      blocks[ib].alias |= uint64_t(1) << n;
      alias_node.push_back((int64_t) ib * NODES_PER_BLOCK + n);
      alias_of.push_back(locate(canonical));
    }
  }
}

void Grid::finish()
{
  for (auto &block : blocks) {
    block.owned = ~block.alias;
    for (int dx = -1; dx <= 1; dx++)
      for (int dy = -1; dy <= 1; dy++)
        for (int dz = -1; dz <= 1; dz++) {
          const int b[3] = {block.b[0] + dx, block.b[1] + dy, block.b[2] + dz};
          block.slot[9 * (dx + 1) + 3 * (dy + 1) + dz + 1] = (lattice.dim == 3 || dz == 0) ? find(b)
                                                                                           : -1;
        }
  }
}

void Grid::allocate(int nreal_in)
{
  nreal = nreal_in;
  const int64_t need = nnodes() * nreal;
  if (need > capacity) {
    free(node);
    capacity = need + need / 8 + 512;
    void *mem = nullptr;
    if (posix_memalign(&mem, 64, capacity * sizeof(double)) != 0) throw std::bad_alloc();
    node = static_cast<double *>(mem);
  }
  zero();
}

void Grid::zero()
{
  if (node) memset(node, 0, nnodes() * nreal * sizeof(double));
}

void Grid::fold_aliases(double *nodes, int nreals, int lane, int nlane) const
{
  for (std::size_t k = 0; k < alias_node.size(); k++) {
    const double *from = nodes + alias_node[k] * nreals;
    double *to = nodes + alias_of[k] * nreals;
    for (int r = lane; r < lane + nlane; r++) to[r] += from[r];
  }
}

void Grid::copy_aliases(double *nodes, int nreals) const
{
  for (std::size_t k = 0; k < alias_node.size(); k++)
    memcpy(nodes + alias_node[k] * nreals, nodes + alias_of[k] * nreals, nreals * sizeof(double));
}

int64_t Grid::memory_usage() const
{
  return capacity * sizeof(double) + blocks.capacity() * sizeof(Block) +
      (alias_node.capacity() + alias_of.capacity()) * sizeof(int64_t) +
      table.size() * (sizeof(uint64_t) + sizeof(int) + 3 * sizeof(void *));
}
