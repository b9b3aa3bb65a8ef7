/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// The fast kernels, compiled once for each instruction set with MPM_ISA = base, v3 or v4: table, node
// solve, and transfers pic, flip, apic with B-splines. The others are made in files of their own, so
// that they compile side by side.

#include "transfer/kernels_isa.h"

#if !defined(MPM_HAVE_VECTORS)

// no vector extensions: the plain loops serve

const MPM_NS::MPMKernels *MPM_NS::MPM_CONCAT(mpm_kernels_, MPM_ISA)()
{
  return mpm_kernels_reference();
}

#else

#include "transfer/kernels_fast.h"

namespace {

#define MPM_NAME_base "baseline"
#define MPM_NAME_v3 "AVX2"
#define MPM_NAME_v4 "AVX-512"

constexpr double SMALLEST = 2.3e-308;    ///< the inverse of a smaller mass may overflow

void solve_nodes(double *nodes, int nnodes, int nreal, double dt)
{
  double *const end = nodes + static_cast<Index>(nreal) * nnodes;
  for (double *node = nodes; node < end; node += nreal) {
    const Vec<4> p = Vec<4>::load(node);
    const double m = node[3];
    const double inv_m = m > SMALLEST ? 1.0 / m : 0.0;
    const Vec<4> v = inv_m * p;
    if (nreal == 4) {
      v.store(node);
    } else {
      const Vec<4> vnew = v + (dt * inv_m) * Vec<4>::load(node + 4);
      vnew.store(node);
      blend<3>(v, Vec<4>{}).store(node + 4);
    }
    node[3] = m;
  }
}

template <bool TOTAL, int DIM, Shape SHAPE> TransferKernels choose(Transfer transfer, bool split)
{
  switch (transfer) {
    case PIC:
      return kernels<DIM, SHAPE, PIC, 8, TOTAL>();
    case FLIP:
      return kernels<DIM, SHAPE, FLIP, 8, TOTAL>();
    case APIC:
      return split ? kernels<DIM, SHAPE, APIC, 8, TOTAL>() : kernels<DIM, SHAPE, APIC, 4, TOTAL>();
    default:
      if (TOTAL) return TransferKernels();
      return MPM_CONCAT(mpm_kernels_affine_, MPM_ISA)(DIM, SHAPE, transfer, split);
  }
}

template <bool TOTAL, int DIM> TransferKernels choose(Shape shape, Transfer transfer, bool split)
{
  switch (shape) {
    case LINEAR:
      // the affine matrix of linear functions is the gradient anyway
      return choose<TOTAL, DIM, LINEAR>(transfer == TPIC ? APIC : transfer, split);
    case QUADRATIC:
      return choose<TOTAL, DIM, QUADRATIC>(transfer, split);
    case CUBIC:
      return choose<TOTAL, DIM, CUBIC>(transfer, split);
    case GIMP:
    case CPGIMP:
      if (TOTAL) return TransferKernels();
      return MPM_CONCAT(mpm_kernels_gimp_, MPM_ISA)(DIM, transfer, split);
    case CPDI:
    case CPDI2:
      if (TOTAL) return TransferKernels();
      return MPM_CONCAT(mpm_kernels_domain_, MPM_ISA)(DIM, shape, transfer, split);
    case BERNSTEIN:
      return MPM_CONCAT(mpm_kernels_bernstein_, MPM_ISA)(DIM, transfer, split);
  }
  return TransferKernels();
}

template <bool TOTAL> TransferKernels transfer(int dim, Shape shape, Transfer transfer, bool split)
{
  return dim == 3 ? choose<TOTAL, 3>(shape, transfer, split)
                  : choose<TOTAL, 2>(shape, transfer, split);
}

}    // namespace

const MPMKernels *MPM_NS::MPM_CONCAT(mpm_kernels_, MPM_ISA)()
{
  static const MPMKernels table = {MPM_CONCAT(MPM_NAME_, MPM_ISA), transfer<false>, transfer<true>,
                                   MPM_CONCAT(mpm_kernels_mixed_, MPM_ISA), solve_nodes};
  return &table;
}

#endif
