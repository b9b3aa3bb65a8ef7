/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_STENCIL_H
#define LMP_MPM_FLOW_STENCIL_H

#include "lattice/grid.h"

#include <climits>
#include <cstdint>
#include <type_traits>

namespace LAMMPS_NS {

/** The faces and cells that a place between the middles of cells reaches, see lattice/staggered.h.
 *  They depend only on the base of the place. */
template <int dim> struct MPMFlowStencil {
  static constexpr int ROWS = 2 * (dim - 1);    ///< rows of three faces along c, normal to c
  static constexpr int CELLS = 1 << dim;

  const int *slots;
  // for indices base - 1 to base + 2 along each axis: terms of the neighbor block, and of the
  // number in the block
  int block[3][4], inside[3][4];

  MPMFlowStencil() = default;
  /** For places with this base, in reach of the block of. */
  MPMFlowStencil(const MPM_NS::Grid &grid, const MPM_NS::Grid::Block &of, const int base[3])
  {
    slots = of.slot;
    int stride = 9, step = 1;
    for (int d = 1; d < dim; d++) step *= grid.side;
    for (int d = 0; d < dim; d++) {
      for (int k = 0; k < 4; k++) {
        const int index = base[d] - 1 + k;
        block[d][k] = stride * ((index >> grid.shift_bits) - of.b[d] + 1);
        inside[d][k] = step * (index & (grid.side - 1));
      }
      stride /= 3;
      step >>= grid.shift_bits;
    }
  }
  /** Number of the cell (and of its lower faces) with indices base + k; k: -1 to 2. */
  int64_t number(int kx, int ky, int kz) const
  {
    int to = block[0][kx + 1] + block[1][ky + 1], n = inside[0][kx + 1] + inside[1][ky + 1];
    if constexpr (dim == 3) {
      to += block[2][kz + 1];
      n += inside[2][kz + 1];
    } else {
      to += 1;
    }
    return (int64_t) slots[to] * MPM_NS::NODES_PER_BLOCK + n;
  }
  int64_t number(const int k[3]) const { return number(k[0], k[1], dim == 3 ? k[2] : 0); }
  /** Face k of a row of faces normal to c, along c; row: k_d + 2 k_e with the axes d and e after
   *  c. */
  template <int c> int64_t face(int row, int k) const
  {
    const int kd = row % 2, ke = row / 2;
    if constexpr (dim == 2) return c == 0 ? number(k, kd, 0) : number(kd, k, 0);
    return c == 0 ? number(k, kd, ke) : c == 1 ? number(ke, k, kd) : number(kd, ke, k);
  }
  /** Number of the cell with k of 0 or 1; n: (2 k_x + k_y) 2 + k_z, in 2d 2 k_x + k_y. */
  int64_t cell(int n) const
  {
    if constexpr (dim == 2) return number(n >> 1, n & 1, 0);
    return number(n >> 2, n >> 1 & 1, n & 1);
  }
};

/** Calls f(number, k) for all cells, with indices base + k, whose middle or lower faces a place
 *  with this base reaches. None of these has the last index along two axes. */
template <int dim, class F> inline void visit(const MPMFlowStencil<dim> &stencil, const F &f)
{
  int k[3] = {0, 0, 0};
  for (k[0] = 0; k[0] < 3; k[0]++)
    for (k[1] = 0; k[1] < (k[0] == 2 ? 2 : 3); k[1]++) {
      const int n = dim == 2 ? 1 : (k[0] == 2 || k[1] == 2 ? 2 : 3);
      for (k[2] = 0; k[2] < n; k[2]++) f(stencil.number(k), k);
    }
}

/** Calls f(k) for all indices k below these limits along each axis. */
template <int dim, class F> inline void for_each_index(const int (&n)[3], const F &f)
{
  int k[3] = {0, 0, 0};
  for (k[0] = 0; k[0] < n[0]; k[0]++)
    for (k[1] = 0; k[1] < n[1]; k[1]++)
      for (k[2] = 0; k[2] < (dim == 3 ? n[2] : 1); k[2]++) f(k);
}

/** Calls f(c) for each axis c, a std::integral_constant. */
template <int dim, class F> inline void for_each_axis(const F &f)
{
  f(std::integral_constant<int, 0>());
  f(std::integral_constant<int, 1>());
  if constexpr (dim == 3) f(std::integral_constant<int, 2>());
}

/** Cache of objects T that places with the same base have in common. Bases of points that are
 *  neighbors in memory differ by one at most, or hardly more: so there is one T for each parity of
 *  the indices. */
template <int dim, class T> class MPMFlowNear {
 public:
  MPMFlowNear()
  {
    for (auto &one : entries) one.base[0] = INT_MIN;
  }

  /** The T of a base. If it is not there, make(T &) is called for it, after leave(T &) for the one
   *  that it replaces, if any. */
  template <class Leave, class Make> T &at(const int base[3], const Leave &leave, const Make &make)
  {
    int k = 0;
    for (int d = 0; d < dim; d++) k = 2 * k + (base[d] & 1);
    auto &one = entries[k];
    bool same = true;
    for (int d = 0; d < dim; d++) same = same && one.base[d] == base[d];
    if (same) return one.of;
    if (one.base[0] != INT_MIN) leave(one.of);
    for (int d = 0; d < dim; d++) one.base[d] = base[d];
    make(one.of);
    return one.of;
  }
  /** Calls leave(T &) for all objects that are there, after which there are none. */
  template <class F> void leave_all(const F &leave)
  {
    for (auto &one : entries) {
      if (one.base[0] != INT_MIN) leave(one.of);
      one.base[0] = INT_MIN;
    }
  }

 private:
  struct Entry {
    int base[3];
    T of;
  };
  Entry entries[1 << dim];
};

}    // namespace LAMMPS_NS
#endif
