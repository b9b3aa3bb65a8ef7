/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "material/batch.h"

#include <cstring>

namespace MPM_NS {
const BatchKernels *mpm_batch_base(int dim, bool hoop);
const BatchKernels *mpm_batch_v3(int dim, bool hoop);
const BatchKernels *mpm_batch_v4(int dim, bool hoop);
}    // namespace MPM_NS

using namespace MPM_NS;

const BatchKernels *BatchKernels::select(int dim, const char *isa, bool hoop)
{
  // the transfer kernels decide which instruction set runs
  const MPMKernels *chosen = MPMKernels::select(isa);
  if (!chosen) return nullptr;
#ifdef MPM_HAVE_V4
  if (strcmp(chosen->isa, "AVX-512") == 0) return mpm_batch_v4(dim, hoop);
#endif
#ifdef MPM_HAVE_V3
  if (strcmp(chosen->isa, "AVX2") == 0) return mpm_batch_v3(dim, hoop);
#endif
  return mpm_batch_base(dim, hoop);
}
