/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_jacobians.h"

#include "base/mpm_points.h"
#include "field/mpm_field.h"
#include "material/batch_kernels.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

void MPMJacobians::keep(const BatchKernels &kernels, const Batch &batch, int first, int nmax)
{
  if (J.size() < (std::size_t) nmax) J.resize(nmax);
  kernels.jacobians(batch.F, batch.n, J.data() + first);
  known = true;
}

void MPMJacobians::find(const MPMField &field, int first, int n, double *J)
{
  double F[9][BATCH];
  for (int p = 0; p < n; p++)
    for (int c = 0; c < 9; c++) F[c][p] = field.points->F[first + p][c];
  field.batch_kernels->jacobians(F, n, J);
}
