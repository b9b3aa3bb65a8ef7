/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_KERNELS_ISA_H
#define MPM_TRANSFER_KERNELS_ISA_H

// What the files transfer/*_isa.cpp provide to each other, under names with the instruction set.

#include "transfer/kernels.h"

#define MPM_CONCAT_(a, b) a##b
#define MPM_CONCAT(a, b) MPM_CONCAT_(a, b)
#if !defined(MPM_ISA)
#define MPM_ISA base
#endif

// The vector extensions of transfer/vector.h: without them the plain loops serve, and the other files are
// empty.
#if defined(__has_builtin)
#if __has_builtin(__builtin_shufflevector)
#define MPM_HAVE_VECTORS
#endif
#endif

namespace MPM_NS {
const MPMKernels *mpm_kernels_reference();
const MPMKernels *MPM_CONCAT(mpm_kernels_, MPM_ISA)();

/** Transfers aflip and tpic with B-splines. */
TransferKernels MPM_CONCAT(mpm_kernels_affine_, MPM_ISA)(int dim, Shape, Transfer, bool split);

/** Transfers pic, flip, apic with Bernstein polynomials in the total frame. */
TransferKernels MPM_CONCAT(mpm_kernels_bernstein_, MPM_ISA)(int dim, Transfer, bool split);

/** Transfers pic, flip, apic with B-splines in mixed precision. */
TransferKernels MPM_CONCAT(mpm_kernels_mixed_, MPM_ISA)(int dim, Shape, Transfer, bool split,
                                                        bool total);

/** All transfers with points of finite size. */
TransferKernels MPM_CONCAT(mpm_kernels_gimp_, MPM_ISA)(int dim, Transfer, bool split);

/** All transfers with convected domains, CPDI and CPDI2. */
TransferKernels MPM_CONCAT(mpm_kernels_domain_, MPM_ISA)(int dim, Shape, Transfer, bool split);
TransferKernels mpm_kernels_domain_reference(int dim, Shape, Transfer, bool split);
}    // namespace MPM_NS

namespace {    // not shared between instruction sets

template <MPM_NS::Transfer TRANSFER, int NREAL> struct TransferConstants {
  static constexpr MPM_NS::Transfer transfer = TRANSFER;
  static constexpr int nreal = NREAL;
};

/** make(TransferConstants) of a transfer. */
template <class Make>
MPM_NS::TransferKernels choose_transfer(MPM_NS::Transfer transfer, bool split, Make make)
{
  using namespace MPM_NS;
  switch (transfer) {
    case PIC:
      return make(TransferConstants<PIC, 8>());
    case FLIP:
      return make(TransferConstants<FLIP, 8>());
    case AFLIP:
      return make(TransferConstants<AFLIP, 8>());
    case APIC:
      return split ? make(TransferConstants<APIC, 8>()) : make(TransferConstants<APIC, 4>());
    case TPIC:
      return split ? make(TransferConstants<TPIC, 8>()) : make(TransferConstants<TPIC, 4>());
  }
  return TransferKernels();
}

}    // namespace
#endif
