/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Kernels of all constitutive laws for one instruction set. The build compiles this file once per
// set with -DMPM_ISA=base, v3, v4 and the matching -march; see mpm_law.h.

#include "mpm_law_list.h"

namespace MPM_NS::law {
namespace {

  template <class Laws> struct Kernels;
  template <class... Laws> struct Kernels<List<Laws...>> {
    static constexpr LawKernels table[] = {{Laws::update, Laws::modulus, Laws::energy}...};
  };

  template <class Laws> struct Viscosities;
  template <class... Laws> struct Viscosities<List<Laws...>> {
    static constexpr ViscosityKernels table[] = {{Laws::update, Laws::raise_speed}...};
  };

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

  constexpr LawTable laws = {isa,
                             Kernels<ClosedLaws>::table,
                             Kernels<EosLaws>::table,
                             Kernels<StrengthLaws>::table,
                             Viscosities<ViscosityLaws>::table,
                             clear_stress,
                             speed};

}    // namespace
}    // namespace MPM_NS::law

#define MPM_PASTE(a, b) a##b
#define MPM_NAME(isa) MPM_PASTE(mpm_laws_, isa)

namespace MPM_NS {
const LawTable *MPM_NAME(MPM_ISA)();
const LawTable *MPM_NAME(MPM_ISA)()
{
  return &law::laws;
}
}    // namespace MPM_NS
