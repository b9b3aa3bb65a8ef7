/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Fast transfers of points of finite size (GIMP), see transfer/kernels_isa.cpp.

#include "transfer/kernels_isa.h"

#if defined(MPM_HAVE_VECTORS)

#include "transfer/kernels_fast.h"

namespace {

template <int DIM> TransferKernels choose(Transfer transfer, bool split)
{
  // the affine matrix is the gradient
  return choose_transfer(transfer == APIC ? TPIC : transfer, split, [](auto constants) {
    return kernels<DIM, GIMP, constants.transfer, constants.nreal, false>();
  });
}

}    // namespace

TransferKernels MPM_NS::MPM_CONCAT(mpm_kernels_gimp_, MPM_ISA)(int dim, Transfer transfer,
                                                               bool split)
{
  return dim == 3 ? choose<3>(transfer, split) : choose<2>(transfer, split);
}

#endif
