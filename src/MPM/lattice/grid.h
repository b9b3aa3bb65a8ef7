/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LATTICE_GRID_H
#define MPM_LATTICE_GRID_H

// Block-sparse computing lattice. Knows nothing of physics, points or LAMMPS.

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <unordered_map>
#include <vector>

namespace MPM_NS {

constexpr int NODES_PER_BLOCK = 64;

/** Geometry of the computing lattice: node i along axis d is at origin[d] + i h. */
struct Lattice {
  int dim;             ///< 2 or 3
  double h;            ///< node spacing
  double origin[3];    ///< position of node 0
  bool periodic[3];
  int ncell[3];    ///< cells along a periodic axis; unused for other axes

  /** Node index modulo the period: index of the canonical node of a set of periodic images. */
  int wrap(int axis, int i) const
  {
    if (!periodic[axis]) return i;
    const int r = i % ncell[axis];
    return r < 0 ? r + ncell[axis] : r;
  }
  void node_position(const int index[3], double x[3]) const
  {
    for (int d = 0; d < 3; d++) x[d] = d < dim ? origin[d] + index[d] * h : 0.0;
  }
  double cell_volume() const { return dim == 3 ? h * h * h : h * h; }
};

/** The blocks of nodes within reach of the points of this rank, and their node records.
 *
 *  A block holds 4x4x4 nodes in 3d and 8x8 in 2d; block b of an axis holds nodes b*side ... b*side
 *  + side - 1. Node in block: (ix*4+iy)*4+iz in 3d, ix*8+iy in 2d. A node record has nreal reals;
 *  for its layout see transfer/kernels.h. Periodic images are separate nodes (aliases). Their sums
 *  are added to the canonical node and copied back after the solve, so that no kernel needs to know
 *  about periodicity.
 */
class Grid {
 public:
  struct Block {
    int b[3];                ///< block coordinates
    int slot[27];            ///< neighbors at [9*(dx+1)+3*(dy+1)+(dz+1)], -1: not active
    uint64_t alias = 0;      ///< bit n: node n is a periodic image of a canonical node
    uint64_t owned = 0;      ///< bit n: canonical, and this rank counts it in sums over nodes
    uint64_t reached = 0;    ///< bit n: points of this rank reach it, or an image of it
  };

  Lattice lattice;
  int side, shift_bits;    ///< nodes along a block side, log2 of it
  std::vector<Block> blocks;
  int nreal = 0;    ///< reals of a node record
  /** Range of nodes along each axis that are in use: sums and copies skip periodic images outside
   *  it. clear() resets it to all nodes. */
  int reach_low[3], reach_high[3];

  explicit Grid(const Lattice &lattice) :
      lattice(lattice), side(lattice.dim == 3 ? 4 : 8), shift_bits(lattice.dim == 3 ? 2 : 3)
  {
    clear();
  }

  void clear();                    ///< forget all blocks
  int activate(const int b[3]);    ///< slot of a block, which is activated if necessary
  int find(const int b[3]) const { return find(key(b)); }    ///< slot of a block, or -1
  int find(uint64_t key) const;                              ///< the same, by its block_key()
  void close_periodic();       ///< activate canonical blocks, list the aliases
  void finish();               ///< neighbor tables, owned masks (all canonical)
  void allocate(int nreal);    ///< node records for all blocks, zeroed

  double *nodes() { return node.get(); }
  double *record(int slot, int n) { return record((int64_t) slot * NODES_PER_BLOCK + n); }
  double *record(int64_t which) { return node.get() + which * nreal; }    ///< which: slot*64 + n
  int64_t nnodes() const { return (int64_t) blocks.size() * NODES_PER_BLOCK; }
  void zero();    ///< set all node records to zero

  /** Adds reals [lane, lane+nlane) of periodic images to their canonical node. */
  void fold_aliases(double *nodes, int nreal, int lane, int nlane) const;
  /** Copies all reals of canonical nodes to their periodic images. */
  void copy_aliases(double *nodes, int nreal) const;
  void copy_aliases() { copy_aliases(nodes(), nreal); }

  /** Bits of the nodes of a block whose indices are from low to high, inclusive. */
  uint64_t nodes_between(const Block &, const int low[3], const int high[3]) const;

  void node_index(const Block &block, int n, int index[3]) const
  {
    if (lattice.dim == 3) {
      index[0] = 4 * block.b[0] + (n >> 4);
      index[1] = 4 * block.b[1] + ((n >> 2) & 3);
      index[2] = 4 * block.b[2] + (n & 3);
    } else {
      index[0] = 8 * block.b[0] + (n >> 3);
      index[1] = 8 * block.b[1] + (n & 7);
      index[2] = 0;
    }
  }
  void node_index(int64_t which, int index[3]) const
  {
    node_index(blocks[which / NODES_PER_BLOCK], which % NODES_PER_BLOCK, index);
  }
  void node_position(int64_t which, double x[3]) const
  {
    int index[3];
    node_index(which, index);
    lattice.node_position(index, x);
  }
  /** Is the node (slot*64 + n) canonical, and does this rank count it in sums over nodes? */
  bool owns(int64_t which) const
  {
    return blocks[which / NODES_PER_BLOCK].owned >> (which % NODES_PER_BLOCK) & 1;
  }
  /** Number of a node within its block, from its global index. */
  int number(const int index[3]) const
  {
    const int i = index[0] & (side - 1), j = index[1] & (side - 1), k = index[2] & (side - 1);
    return lattice.dim == 3 ? (4 * i + j) * 4 + k : 8 * i + j;
  }
  /** slot*64 + n of a global node index, or -1 if its block is not active. */
  int64_t locate(const int index[3]) const;
  /** As locate(), but without a search, for nodes in this block and its neighbors. */
  int64_t locate_near(const Block &block, const int index[3]) const
  {
    int neighbor = 0;
    for (int d = 0; d < 3; d++) {
      const int b = d < lattice.dim ? index[d] >> shift_bits : 0;
      neighbor = 3 * neighbor + b - block.b[d] + 1;
    }
    const int slot = block.slot[neighbor];
    return slot < 0 ? -1 : (int64_t) slot * NODES_PER_BLOCK + number(index);
  }

  /** For each node slot*64 + n, its canonical node, which is the node itself if it is no periodic
   *  image. */
  std::vector<int64_t> canonical() const;

  int64_t memory_usage() const;

  static uint64_t block_key(const Block &block) { return key(block.b); }
  /** A number for three coordinates of blocks or nodes. */
  static uint64_t key(const int b[3])
  {
    constexpr uint64_t bias = 1u << 20, mask = (1u << 21) - 1;
    return (((b[0] + bias) & mask) << 42) | (((b[1] + bias) & mask) << 21) | ((b[2] + bias) & mask);
  }

 private:
  std::unordered_map<uint64_t, int> table;
  std::vector<int64_t> alias_node, alias_of;    // parallel lists of node numbers slot*64+n
  struct Free {
    void operator()(double *memory) const { std::free(memory); }
  };
  std::unique_ptr<double[], Free> node;
  int64_t capacity = 0;    // reals
};

}    // namespace MPM_NS
#endif
