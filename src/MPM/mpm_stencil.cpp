/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_stencil.h"

#include "mpm_cpdi.h"
#include "transfer/shape.h"

#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ---------------------------------------------------------------------- */

template <class Functions> static int evaluate(double t, int &first, double w[4], double *slopes)
{
  const double cell = std::floor(t / Functions::cell - Functions::shift);
  const double f = t / Functions::cell - Functions::shift - cell;
  first = Functions::cell * (int) cell;
  Functions::weights(f, w);
  if (slopes) Functions::gradients(f, slopes);
  return Functions::nodes;
}

int MPMStencil::weights(double t, int &first, double w[4], double *slopes) const
{
  const Shape shape = field.options.shape;
  if (shape == BERNSTEIN) return evaluate<Bernstein>(t, first, w, slopes);
  const int order = stencil_order(shape);
  if (order == 1) return evaluate<BSpline<1>>(t, first, w, slopes);
  if (order == 2) return evaluate<BSpline<2>>(t, first, w, slopes);
  return evaluate<BSpline<3>>(t, first, w, slopes);
}

void MPMStencil::weights_of_size(int i, int axis, double t, int first, double w[4],
                                 double slopes[4]) const
{
  const double size = field.boxes->sizes[3 * (std::size_t) i + axis];
  Gimp::weights(t - Gimp::shift - first, size, w);
  Gimp::gradients(t - Gimp::shift - first, size, slopes);
}

int MPMStencil::corners(int i, double *x, double *w, double *g) const
{
  if (field.domains) {
    field.domains->corners_of(i, x, w, g);
    return 1 << field.lattice.dim;
  }
  w[0] = 1.0;
  return 1;
}
