/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_KERNELS_H
#define MPM_TRANSFER_KERNELS_H

// Interface of the hot kernels. The files transfer/*_isa.cpp are compiled once for each instruction
// set; every compilation fills one MPMKernels table and MPMKernels::select() picks one at run time.
// Nothing here knows about LAMMPS.

#include "transfer/shape.h"

namespace MPM_NS {

enum Transfer { PIC, FLIP, APIC, AFLIP, TPIC };

/** Points have an affine matrix. */
constexpr bool is_affine(Transfer transfer)
{
  return transfer == APIC || transfer == AFLIP || transfer == TPIC;
}
/** Points keep a share of their velocity and add the change of the nodes'. */
constexpr bool adds_change(Transfer transfer)
{
  return transfer == FLIP || transfer == AFLIP;
}
/** The affine matrix is the fit of moving least squares, and stress is an affine term. */
constexpr bool is_mls(Shape shape, Transfer transfer)
{
  return shape_constants[shape].inv_moment > 0.0 && (transfer == APIC || transfer == AFLIP);
}
/** The affine matrix is the velocity gradient, too. That of domains with APIC is not: it is the fit
 *  with the second moment of the weights, which depends on the position and the shape of the
 *  domain. */
constexpr bool is_gradient(Shape shape, Transfer transfer)
{
  return is_affine(transfer) && (transfer == TPIC || !has_domain(shape));
}

constexpr int BATCH = 64;    ///< points handed to a constitutive law at a time

/** Side of a block of nodes: 64 nodes in 2d and in 3d. */
constexpr int block_side(int dim)
{
  return dim == 3 ? 4 : 8;
}

/** Nodes along a side of a tile: a block of base nodes, one more on each side, and the stencil. */
constexpr int tile_side(int dim, int order)
{
  return block_side(dim) + 2 + order;
}

/** Index of a node in a tile, in nodes; odd strides keep rows out of each other's cache sets. */
constexpr int tile_stride_y(int dim, int order)
{
  return dim == 3 ? (tile_side(dim, order) | 1) : 1;
}
constexpr int tile_stride_x(int dim, int order)
{
  return dim == 3 ? tile_stride_y(dim, order) * tile_side(dim, order) + (order == 1 ? 1 : 0)
                  : (tile_side(dim, order) | 1);
}
/** Nodes to allocate for a tile. */
constexpr int tile_nodes(int dim, int order)
{
  return tile_stride_x(dim, order) * tile_side(dim, order) + 8;
}

/** Largest number of nodes in a tile of B-splines (cubic, 3d: 9 * 9 * 9 and padding). */
constexpr int MAX_TILE_NODES = 1024;

/** Tiles of domains: three blocks along each side, as corners may be far from their point. */
constexpr int domain_tile_side(int dim)
{
  return 3 * block_side(dim);
}
constexpr int domain_stride_y(int dim)
{
  return dim == 3 ? domain_tile_side(dim) + 1 : 1;
}
constexpr int domain_stride_x(int dim)
{
  return dim == 3 ? domain_stride_y(dim) * domain_tile_side(dim) : domain_tile_side(dim) + 1;
}
constexpr int domain_tile_nodes(int dim)
{
  return domain_stride_x(dim) * domain_tile_side(dim) + 8;
}

/** State of points as contiguous rows; pointers are to the first row of the rank. */
struct PointRows {
  double *x;              ///< [n][3] position (total frame: reference position)
  double *v;              ///< [n][3] velocity
  const double *f;        ///< [n][3] external force (gravity, contact, walls, ...)
  double *C;              ///< [n][dim*dim] affine matrix, column-major: C[dim*j+i] = d v_i / d x_j
  double *tau;            ///< [n][6] Kirchhoff stress J sigma, xx yy zz xy xz yz
  const double *vol0;     ///< [n] initial volume: V sigma = V0 tau
  const double *mass;     ///< [n]
  double *xnew;           ///< [n][3] where G2P puts the new position (x itself, unless MUSL)
  double *F = nullptr;    ///< [n][9] prefetched by G2P for the law, if given; not changed
  int guarded = 0;        ///< behind the rows before this one there is memory that may be read
  const double *from = nullptr;    ///< [n][3] total frame: the position that G2P adds dt v to
  const double *P = nullptr;       ///< [n][dim*dim] total frame: first Piola-Kirchhoff stress, the
                                   ///< place of tau, column-major: P[dim*j+i] = P_ij
  const double *size = nullptr;    ///< [n][3] GIMP: half size along each axis in node spacings
  /** CPDI: [n][dim][dim] half edges; CPDI2: [n][2^dim][dim] corners relative to x, in the order of
   *  transfer/cpdi.h. */
  const double *domain = nullptr;
  /** CPDI2: where G2P puts the new corners, with the point at the center; null: nowhere. */
  double *corners_new = nullptr;
  double *velocity = nullptr;    ///< [n][3] where g2p_gradient puts the velocity; null: nowhere
};

/** What a transfer needs to know about the lattice and the step. */
struct TransferStep {
  double h;    ///< node spacing
  double inv_h;
  double origin[3];    ///< position of node (0,0,0)
  double dt;
  double flip;                  ///< FLIP share of the velocity update (0: PIC, 1: FLIP)
  double force_scale = 1.0;     ///< external force to mass * acceleration (ftm2v of LAMMPS)
  double stress_scale = 1.0;    ///< stress * area to mass * acceleration (ftm2v / nktv2p)
};

/** Transfers between the points [first,last) of one block and its tile.
 *
 *  base: node index of tile entry (0,0,0), which is the block's first base node minus one per axis.
 *  A base node of a point is floor((x - origin)/h - s), s = 0, 1/2, 1 for linear, quadratic (GIMP),
 *  cubic, and 2 floor((x - origin)/(2 h)) for BERNSTEIN. In 2d, z is ignored, and tiles and base
 *  have two axes (base[2] unused). Domains: base is the first node of the block before; each corner
 *  has a base node (s = 0), and all of them and their next nodes must be in the tile, which has the
 *  block's neighbors on all sides.
 *
 *  Tile entry layout, 8-byte reals:
 *   merged (4 reals): on P2G px py pz m, momentum including dt * force; on G2P vx vy vz m.
 *   split  (8 reals): on P2G px py pz m | fx fy fz 0; on G2P vx vy vz m | vx_old vy_old vz_old 0.
 *  Align tiles to 64 bytes; other addresses work, more slowly.
 *
 *  box: [6] lowest and highest tile index of base nodes (x,y,z low; x,y,z high); widened, not
 *  reset.
 */
using P2G = void (*)(const PointRows &, const TransferStep &, int first, int last,
                     const int base[3], double *tile, int box[6]);

/** G2P returns 0, or non-zero when a point's new position has left the range of its tile (domains:
 *  when it is not finite, or a domain is inverted, with weights that are not positive).
 *  L: [last-first][dim*dim] column-major velocity gradient with respect to the positions in x;
 *  kernels whose gradient is in C write the same matrix there; L may be null. */
using G2P = int (*)(const PointRows &, const TransferStep &, int first, int last, const int base[3],
                    const double *tile, double *L);

/** Moves the box of a tile between tile and node array, all reals of an entry. flush: adds the tile
 *  to the nodes and clears that part of the tile; load: fills it from the nodes. nodes:
 *  [nblocks][64][nreal], node index in a block (ix*4+iy)*4+iz in 3d, ix*8+iy in 2d. slot: [27]
 *  block index of the neighbors at [9*(bx+1)+3*(by+1)+(bz+1)], b = -1,0,1 (2d: bz = 0); those that
 *  the box and its stencil touch must be valid. box: as filled by P2G; the stencil (order nodes
 *  upward) is added here. */
using TileIO = void (*)(double *tile, double *nodes, const int slot[27], const int box[6]);

/** All kernels of one dimension, shape, and transfer. Null pointers: not available in this
 *  combination. */
struct TransferKernels {
  int nreal;             ///< reals of a tile entry and node record: 4 merged, 8 split
  int margin;            ///< nodes of a tile in front of the block, see P2G
  bool affine;           ///< uses C
  bool gradient_in_C;    ///< g2p leaves the velocity gradient there
  P2G p2g;               ///< mass, momentum and force (internal and external)
  P2G p2g_momentum;      ///< mass and momentum only, force reals untouched
  P2G p2g_force;       ///< force only (split: the force reals; merged: dt * force on the momentum)
  G2P g2p;             ///< velocity, position, C, velocity gradient
  G2P g2p_gradient;    ///< velocity gradient into L, velocity if asked for; points stay; returns 0
  TileIO flush;        ///< tile -> nodes, all reals
  TileIO load;         ///< nodes -> tile
  TileIO load_mean;    ///< split: the mean of velocity and old velocity of the nodes -> velocity
  TileIO prefetch;     ///< nodes of the box into the cache, for a flush or load some time later
};

/** Transfers of the modes of a velocity field around a point that are products of two or three
 *  coordinates: polynomial particle in cell (C. Fu, Q. Guo, T. Gast, C. Jiang, J. Teran, ACM Trans.
 *  Graph. 36 (2017) 222) with 4 modes in 2d, 8 in 3d. The constant and the linear ones are those of
 *  APIC.
 *
 *  With weights w of quadratic or cubic B-splines and distances d of nodes from the point, moments
 *  along each axis are sum w = 1, sum w d = 0, sum w d^2 = D, whatever the position. Products of 1
 *  and d over the axes are therefore orthogonal, and the best coefficient of a mode s is sum_i w_i
 *  s(d_i) v_i over sum_i w_i s(d_i)^2 = D or D^2 or D^3.
 */
struct PolyKernels {
  /** Adds the momentum of the modes Q [n][poly_size] to the tile, to which P2G has gone. */
  void (*p2g)(const PointRows &, const double *Q, const TransferStep &, int first, int last,
              const int base[3], double *tile);
  /** Fits the modes to the velocities of the nodes; to be called before G2P moves the points. */
  void (*g2p)(const PointRows &, double *Q, const TransferStep &, int first, int last,
              const int base[3], const double *tile);
};

/** Numbers per point: modes xy, in 3d xy, xz, yz, xyz, each a vector of dim components. */
constexpr int poly_size(int dim)
{
  return dim == 3 ? 12 : 2;
}

constexpr double LEAST_MASS = 2.3e-308;    ///< the inverse of a smaller mass may overflow

/** Kernel table of one instruction set. */
struct MPMKernels {
  const char *isa;    ///< "reference", "baseline", "AVX2" or "AVX-512"

  /** Kernels for dimension 2 or 3; split: keep force and old velocity apart (FLIP, energy ledger).
   *  PIC, FLIP and AFLIP are always split. */
  TransferKernels (*transfer)(int dim, Shape, Transfer, bool split);

  /** The same in the total frame: nodes are places of the reference configuration. C and L are
   *  gradients with respect to the reference position, internal forces are -V0 P grad N, and G2P
   *  moves a point from its row of from. G2P returns non-zero for positions that are not finite.
   *  Fast kernels are for PIC, FLIP, APIC with B-splines and BERNSTEIN; domains (split) have
   *  p2g_force and g2p_gradient alone. The other table has those of the total frame for BERNSTEIN,
   *  too. */
  TransferKernels (*transfer_total)(int dim, Shape, Transfer, bool split);

  /** The modes of polypic, for QUADRATIC and CUBIC; nreal: of the records of nodes. */
  PolyKernels (*poly)(int dim, Shape, int nreal);

  /** v = p/m on n nodes, and the momentum equation.
   *  merged: (p,m) -> (p/m, m).  split: (p,m|f) -> ((p + dt f)/m, m | p/m).
   *  A node with not more than the mass least gets velocity 0.  least: not below LEAST_MASS. */
  void (*solve_nodes)(double *nodes, int nnodes, int nreal, double dt, double least);

  /** The table for this CPU, or the one that the name asks for (null when it cannot run here). */
  static const MPMKernels *select(const char *name = nullptr);
};

}    // namespace MPM_NS
#endif
