/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Fast transfers of points of finite size (GIMP), see mpm_kernels_isa.cpp.

#include "mpm_kernels_others.h"

#if !defined(__has_builtin)
#define __has_builtin(x) 0
#endif
#if __has_builtin(__builtin_shufflevector)

#include "mpm_kernels_transfer.h"

namespace {

template <int DIM> TransferKernels choose(Transfer transfer, bool split)
{
  switch (transfer) {
    case PIC:
      return kernels<DIM, GIMP, PIC, 8, false>();
    case FLIP:
      return kernels<DIM, GIMP, FLIP, 8, false>();
    case AFLIP:
      return kernels<DIM, GIMP, AFLIP, 8, false>();
    case APIC:    // the affine matrix is the gradient
    case TPIC:
      return split ? kernels<DIM, GIMP, TPIC, 8, false>() : kernels<DIM, GIMP, TPIC, 4, false>();
  }
  return TransferKernels();
}

}    // namespace

TransferKernels MPM_NS::MPM_CONCAT(mpm_kernels_gimp_, MPM_ISA)(int dim, Transfer transfer,
                                                               bool split)
{
  return dim == 3 ? choose<3>(transfer, split) : choose<2>(transfer, split);
}

#endif
