/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Fast transfers pic, flip, apic with Bernstein polynomials, in the total frame; see
// transfer/kernels_isa.cpp. The affine matrix is the gradient, as the second moment depends on the position.

#include "transfer/kernels_isa.h"

#if defined(MPM_HAVE_VECTORS)

#include "transfer/kernels_fast.h"

namespace {

template <int DIM> TransferKernels choose(Transfer transfer, bool split)
{
  if (transfer == PIC) return kernels<DIM, BERNSTEIN, PIC, 8, true>();
  if (transfer == FLIP) return kernels<DIM, BERNSTEIN, FLIP, 8, true>();
  if (transfer != APIC) return TransferKernels();
  return split ? kernels<DIM, BERNSTEIN, APIC, 8, true>()
               : kernels<DIM, BERNSTEIN, APIC, 4, true>();
}

}    // namespace

TransferKernels MPM_NS::MPM_CONCAT(mpm_kernels_bernstein_, MPM_ISA)(int dim, Transfer transfer,
                                                                    bool split)
{
  return dim == 3 ? choose<3>(transfer, split) : choose<2>(transfer, split);
}

#endif
