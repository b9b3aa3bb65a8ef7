/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// What materials need besides their laws, for one instruction set: see mpm_law_kernels.h.

#include "mpm_math.h"

namespace MPM_NS::law {
namespace {

  void clear_stress(Batch &b)
  {
    for (int k = 0; k < 6; k++) {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) b.stress[k][i] = 0.0;
    }
  }

  void speed(int n, double density, const double *k, double *c)
  {
    const double inv = 1.0 / density;
    MPM_SIMD
    for (int i = 0; i < n; i++) c[i] = std::sqrt(max(k[i] * inv, 0.0));
  }

#if defined(__AVX512F__)
  constexpr const char *isa = "AVX-512";
#elif defined(__AVX2__)
  constexpr const char *isa = "AVX2";
#else
  constexpr const char *isa = "baseline";
#endif

}    // namespace
}    // namespace MPM_NS::law

#define MPM_PASTE(a, b) a##b
#define MPM_NAME(isa) MPM_PASTE(mpm_laws_common_, isa)

namespace MPM_NS {
void MPM_NAME(MPM_ISA)(LawTable &);
void MPM_NAME(MPM_ISA)(LawTable &table)
{
  table.isa = law::isa;
  table.clear_stress = law::clear_stress;
  table.speed = law::speed;
}
}    // namespace MPM_NS
