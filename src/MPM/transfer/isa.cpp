/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "transfer/isa.h"

#include "transfer/kernels.h"
#include "transfer/scalar.h"
#include "transfer/smoothing.h"

#include <cstdlib>
#include <cstring>
#include <initializer_list>

namespace MPM_NS {
MPM_DECLARE_ISA(const MPMKernels *, mpm_kernels, const char *isa)
const MPMKernels *mpm_kernels_reference();
MPM_DECLARE_ISA(SmoothingKernels, mpm_kernels_smoothing, int dim, Shape)
MPM_DECLARE_ISA(ScalarKernels, mpm_kernels_scalar, int dim, Shape)
ScalarKernels mpm_kernels_scalar_reference(int dim, Shape);
}    // namespace MPM_NS

using namespace MPM_NS;

namespace {

/** CPU and operating system run the code of a set, and the build has it. */
bool runs(InstructionSet set)
{
#if defined(MPM_HAVE_V3) || defined(MPM_HAVE_V4)
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
      __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
#endif
#if defined(MPM_HAVE_V4)
  if (set == V4)
    return v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512cd");
#endif
#if defined(MPM_HAVE_V3)
  if (set == V3) return v3;
#endif
#if defined(MPM_HAVE_NO_BASE)
  return false;
#else
  return set == BASE || set == REFERENCE;
#endif
}

}    // namespace

bool MPM_NS::select_isa(const char *name, InstructionSet &set)
{
  if (!name) name = std::getenv("MPM_ISA");
  const bool best = !name || !*name;
  const char *const names[] = {"baseline", "avx2", "avx512", "reference"};
  for (const InstructionSet candidate : {V4, V3, BASE, REFERENCE})
    if ((best || std::strcmp(name, names[candidate]) == 0) && runs(candidate)) {
      set = candidate;
      return true;
    }
  return false;
}

/** Names of the sets in tables. */
static const char *const sets[] = {"baseline", "AVX2", "AVX-512"};

SmoothingKernels SmoothingKernels::select(const MPMKernels &kernels, int dim, Shape shape)
{
  SmoothingKernels (*const tables[])(int, Shape) = MPM_ALL_ISA(mpm_kernels_smoothing);
  for (int set = BASE; set <= V4; set++)
    if (std::strcmp(kernels.isa, sets[set]) == 0) return tables[set](dim, shape);
  return {};
}

ScalarKernels ScalarKernels::select(const MPMKernels &kernels, int dim, Shape shape)
{
  ScalarKernels (*const tables[])(int, Shape) = MPM_ALL_ISA(mpm_kernels_scalar);
  for (int set = BASE; set <= V4 && !has_domain(shape); set++)
    if (std::strcmp(kernels.isa, sets[set]) == 0) {
      const ScalarKernels fast = tables[set](dim, shape);
      if (fast.prepare) return fast;
    }
  return mpm_kernels_scalar_reference(dim, shape);
}

const MPMKernels *MPMKernels::select(const char *name)
{
  const MPMKernels *(*const tables[])(const char *) = MPM_ALL_ISA(mpm_kernels);
  InstructionSet set;
  if (!select_isa(name, set)) return nullptr;
  return set == REFERENCE ? mpm_kernels_reference() : tables[set](sets[set]);
}
