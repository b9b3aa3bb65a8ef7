/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/block_kernels.h"

#include "transfer/isa.h"

namespace MPM_NS {
MPM_DECLARE_ISA(BlockKernels, mpm_kernels_blocks)
}    // namespace MPM_NS

using namespace MPM_NS;

BlockKernels BlockKernels::select()
{
  BlockKernels (*const tables[])() = MPM_ALL_ISA(mpm_kernels_blocks);
  InstructionSet set;
  // a name that nobody knows has been refused where transfers were chosen
  if (!select_isa(nullptr, set)) select_isa("baseline", set);
  return tables[set]();
}
