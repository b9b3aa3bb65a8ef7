/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_stencil.h"

#include "mpm_boxes.h"
#include "mpm_cpdi.h"
#include "transfer/shape.h"

#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ---------------------------------------------------------------------- */

int MPMStencil::weights(double t, int &first, double w[4]) const
{
  if (field.options.shape == BERNSTEIN) {
    const double cell = std::floor(0.5 * t);
    first = 2 * (int) cell;
    Bernstein::weights(0.5 * t - cell, w);
    return Bernstein::nodes;
  }
  const int order = stencil_order(field.options.shape);
  const double s = t - 0.5 * (order - 1);
  first = (int) std::floor(s);
  if (order == 1)
    BSpline<1>::weights(s - first, w);
  else if (order == 2)
    BSpline<2>::weights(s - first, w);
  else
    BSpline<3>::weights(s - first, w);
  return order + 1;
}

void MPMStencil::weights_of_size(int i, int axis, double t, int first, double w[4]) const
{
  Gimp::weights(t - Gimp::shift - first, field.boxes->sizes[3 * (std::size_t) i + axis], w);
}

int MPMStencil::corners(int i, double *x, double *w) const
{
  if (field.domains) {
    field.domains->corners_of(i, x, w);
    return 1 << field.lattice.dim;
  }
  w[0] = 1.0;
  return 1;
}
