/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "material/batch_kernels.h"

#include "transfer/isa.h"

namespace MPM_NS {
MPM_DECLARE_ISA(const BatchKernels *, mpm_batch, int dim, bool hoop)
}    // namespace MPM_NS

using namespace MPM_NS;

const BatchKernels *BatchKernels::select(int dim, const char *isa, bool hoop)
{
  const BatchKernels *(*const tables[])(int, bool) = MPM_ALL_ISA(mpm_batch);
  InstructionSet set;
  return select_isa(isa, set) ? tables[set](dim, hoop) : nullptr;
}
