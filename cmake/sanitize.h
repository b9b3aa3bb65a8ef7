/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Included before all else with sanitizers: functions that are inlined by force are compiled once instead of at
// each call, which saves minutes. The prefetch of SSE has to be inlined, as its argument must be a constant.

#ifdef __SSE__
#include <xmmintrin.h>
#endif
#define always_inline unused
