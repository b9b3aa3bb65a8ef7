/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// What materials need besides their laws, for one instruction set: see law/list.h.

#include "law/kinematics.h"
#include "transfer/isa.h"

namespace MPM_NS::law {
namespace {

  void speed(int n, double density, const double *k, double *c)
  {
    const double inv = 1.0 / density;
    MPM_SIMD
    for (int i = 0; i < n; i++) c[i] = std::sqrt(max(k[i] * inv, 0.0));
  }

  void mean_stress(const Batch &b, double *mean)
  {
    MPM_SIMD
    for (int i = 0; i < b.n; i++) mean[i] = (1.0 / 3.0) * trace(load_stress(b, i));
  }

  void strain_rate(const Batch &b, double *rate)
  {
    const double c = (2.0 / 3.0) / (b.dt * b.dt);
    MPM_SIMD
    for (int i = 0; i < b.n; i++) rate[i] = std::sqrt(c * norm2(increment(b, i).strain));
  }

}    // namespace
}    // namespace MPM_NS::law

namespace MPM_NS {
void MPM_OF_ISA(mpm_laws_common)(LawTable &);
void MPM_OF_ISA(mpm_laws_common)(LawTable &table)
{
  table.speed = law::speed;
  table.mean_stress = law::mean_stress;
  table.strain_rate = law::strain_rate;
}
}    // namespace MPM_NS
