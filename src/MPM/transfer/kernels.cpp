/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "transfer/kernels.h"

#include <cstdlib>
#include <cstring>

// MPM_HAVE_V3 and MPM_HAVE_V4: the build has compiled transfer/kernels_isa.cpp for x86-64-v3 and -v4.

namespace MPM_NS {

const MPMKernels *mpm_kernels_reference();
const MPMKernels *mpm_kernels_base();
#if defined(MPM_HAVE_V3)
const MPMKernels *mpm_kernels_v3();
#endif
#if defined(MPM_HAVE_V4)
const MPMKernels *mpm_kernels_v4();
#endif

namespace {

#if defined(MPM_HAVE_V3)
  /** CPU and operating system run AVX2 code (x86-64-v3). */
  bool has_v3()
  {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
        __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  }
#endif

#if defined(MPM_HAVE_V4)
  /** CPU and operating system run AVX-512 code (x86-64-v4). */
  bool has_v4()
  {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
        __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
        __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512cd");
  }
#endif

  bool same(const char *a, const char *b)
  {
    return std::strcmp(a, b) == 0;
  }

}    // namespace

/** Names: reference, baseline, avx2, avx512. Without a name, the environment variable MPM_ISA gives
 *  one; without both, the fastest table that runs here. Null for an unknown name, and for an
 *  instruction set that was not built or that the CPU lacks. */
const MPMKernels *MPMKernels::select(const char *name)
{
  if (!name) name = std::getenv("MPM_ISA");
  const bool best = !name || !*name;

#if defined(MPM_HAVE_V4)
  if ((best || same(name, "avx512")) && has_v4()) return mpm_kernels_v4();
#endif
#if defined(MPM_HAVE_V3)
  if ((best || same(name, "avx2")) && has_v3()) return mpm_kernels_v3();
#endif
  if (best || same(name, "baseline")) return mpm_kernels_base();
  if (same(name, "reference")) return mpm_kernels_reference();
  return nullptr;
}

}    // namespace MPM_NS
