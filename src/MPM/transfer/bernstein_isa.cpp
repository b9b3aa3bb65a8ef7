/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Fast transfers with Bernstein polynomials, in the total frame; see transfer/kernels_isa.cpp.

#include "transfer/kernels_isa.h"

#if defined(MPM_HAVE_VECTORS)

#include "transfer/kernels_fast.h"

TransferKernels MPM_NS::MPM_OF_ISA(mpm_kernels_bernstein)(const KernelChoice &choice)
{
  return kernels_of_file<BERNSTEIN_FILE>(choice);
}

#endif
