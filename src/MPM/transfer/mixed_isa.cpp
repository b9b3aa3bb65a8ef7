/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Fast transfers pic, flip, apic with B-splines in mixed precision: arithmetic and tiles in single,
// positions, state of points and nodes in double precision. See transfer/kernels_isa.cpp.

#define MPM_MIXED_PRECISION
#include "transfer/kernels_isa.h"

#if defined(MPM_HAVE_VECTORS)

#include "transfer/kernels_fast.h"

namespace {

template <int DIM, Shape SHAPE, bool TOTAL> TransferKernels choose(Transfer transfer, bool split)
{
  if (transfer == PIC) return kernels<DIM, SHAPE, PIC, 8, TOTAL>();
  if (transfer == FLIP) return kernels<DIM, SHAPE, FLIP, 8, TOTAL>();
  if (transfer != APIC) return TransferKernels();
  return split ? kernels<DIM, SHAPE, APIC, 8, TOTAL>() : kernels<DIM, SHAPE, APIC, 4, TOTAL>();
}

template <int DIM, bool TOTAL> TransferKernels choose(Shape shape, Transfer transfer, bool split)
{
  if (shape == LINEAR) return choose<DIM, LINEAR, TOTAL>(transfer, split);
  if (shape == QUADRATIC) return choose<DIM, QUADRATIC, TOTAL>(transfer, split);
  if (shape == CUBIC) return choose<DIM, CUBIC, TOTAL>(transfer, split);
  return TransferKernels();
}

}    // namespace

TransferKernels MPM_NS::MPM_CONCAT(mpm_kernels_mixed_, MPM_ISA)(int dim, Shape shape,
                                                                Transfer transfer, bool split,
                                                                bool total)
{
  if (total)
    return dim == 3 ? choose<3, true>(shape, transfer, split)
                    : choose<2, true>(shape, transfer, split);
  return dim == 3 ? choose<3, false>(shape, transfer, split)
                  : choose<2, false>(shape, transfer, split);
}

#endif
