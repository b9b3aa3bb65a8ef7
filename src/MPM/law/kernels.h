/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_KERNELS_H
#define MPM_LAW_KERNELS_H

// What the files laws_<family>_isa.cpp share: each compiles the kernels of one family of laws,
// once for each instruction set (MPM_ISA: base, v3, v4, with the matching -march).

#include "law/declare.h"
#include "law/list.h"
#include "transfer/isa.h"

namespace MPM_NS {
namespace law {
  namespace {

    template <class Laws> struct KernelTable;
    template <Part PART, class... Laws> struct KernelTable<Family<PART, Laws...>> {
      // one more, as there is no empty array
      static constexpr LawKernels table[] = {kernels<Laws>()..., LawKernels{}};
    };

  }    // namespace
}    // namespace law
}    // namespace MPM_NS

/** Defines mpm_laws_<family>_<isa>(), which returns the kernels of the family in the order of its list. */
#define MPM_LAW_FAMILY(family)                         \
  namespace MPM_NS {                                   \
    const LawKernels *MPM_OF_ISA(mpm_laws_##family)(); \
    const LawKernels *MPM_OF_ISA(mpm_laws_##family)()  \
    {                                                  \
      return law::KernelTable<law::family>::table;     \
    }                                                  \
  }

#endif
