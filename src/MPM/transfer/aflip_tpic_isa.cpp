/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Fast transfers aflip and tpic with B-splines, see transfer/kernels_isa.cpp.

#include "transfer/kernels_isa.h"

#if defined(MPM_HAVE_VECTORS)

#include "transfer/kernels_fast.h"

namespace {

template <int DIM, Shape SHAPE> TransferKernels choose(Transfer transfer, bool split)
{
  if (transfer == AFLIP) return kernels<DIM, SHAPE, AFLIP, 8, false>();
  if constexpr (SHAPE != LINEAR)
    return split ? kernels<DIM, SHAPE, TPIC, 8, false>() : kernels<DIM, SHAPE, TPIC, 4, false>();
  return TransferKernels();
}

template <int DIM> TransferKernels choose(Shape shape, Transfer transfer, bool split)
{
  if (shape == LINEAR) return choose<DIM, LINEAR>(transfer, split);
  if (shape == QUADRATIC) return choose<DIM, QUADRATIC>(transfer, split);
  return choose<DIM, CUBIC>(transfer, split);
}

}    // namespace

TransferKernels MPM_NS::MPM_CONCAT(mpm_kernels_affine_, MPM_ISA)(int dim, Shape shape,
                                                                 Transfer transfer, bool split)
{
  return dim == 3 ? choose<3>(shape, transfer, split) : choose<2>(shape, transfer, split);
}

#endif
