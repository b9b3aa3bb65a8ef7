/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Compiled once for each instruction set: table of kernels of the set, and solve. The transfers of
// each shape are made in files of their own, so that they compile side by side.

#include "transfer/kernels_isa.h"

#if !defined(MPM_HAVE_VECTORS)

// no vector extensions: the plain loops serve

const MPM_NS::MPMKernels *MPM_NS::MPM_OF_ISA(mpm_kernels)(const char *)
{
  return mpm_kernels_reference();
}

#else

#include "transfer/vector.h"

#include <cstddef>

using namespace MPM_NS;

namespace {

void solve_nodes(double *nodes, int nnodes, int nreal, double dt, double least)
{
  double *const end = nodes + static_cast<std::ptrdiff_t>(nreal) * nnodes;
  for (double *node = nodes; node < end; node += nreal) {
    const Vec<4> p = Vec<4>::load(node);
    const double m = node[3];
    const double inv_m = m > least ? 1.0 / m : 0.0;
    const Vec<4> v = inv_m * p;
    if (nreal == 4) {
      v.store(node);
    } else {
      const Vec<4> vnew = v + (dt * inv_m) * Vec<4>::load(node + 4);
      vnew.store(node);
      blend<3>(v, Vec<4>{}).store(node + 4);
    }
    node[3] = m;
  }
}

template <bool TOTAL>
TransferKernels choose_among_files(int dim, Shape shape, Transfer transfer, bool split)
{
  const KernelChoice choice = {dim, shape, transfer, split, TOTAL};
  switch (shape) {
    case LINEAR:
      return MPM_OF_ISA(mpm_kernels_linear)(choice);
    case QUADRATIC:
      return MPM_OF_ISA(mpm_kernels_quadratic)(choice);
    case CUBIC:
      return MPM_OF_ISA(mpm_kernels_cubic)(choice);
    case GIMP:
    case CPGIMP:
      return MPM_OF_ISA(mpm_kernels_gimp)(choice);
    case BERNSTEIN:
      return MPM_OF_ISA(mpm_kernels_bernstein)(choice);
    case CPDI:
      return MPM_OF_ISA(mpm_kernels_cpdi)(choice);
    case CPDI2:
      return MPM_OF_ISA(mpm_kernels_cpdi2)(choice);
  }
  return {};
}

}    // namespace

const MPMKernels *MPM_NS::MPM_OF_ISA(mpm_kernels)(const char *isa)
{
  static const MPMKernels table = {isa, choose_among_files<false>, choose_among_files<true>,
                                   MPM_OF_ISA(mpm_kernels_poly), solve_nodes};
  return &table;
}

#endif
