/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_boxes.h"

#include "atom.h"
#include "mpm_field.h"
#include "mpm_frame.h"
#include "mpm_point_map.h"
#include "mpm_points.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double MAX_SIZE = 0.5;    // in node spacings: more nodes than the stencil has

/* ---------------------------------------------------------------------- */

MPMBoxes::MPMBoxes(LAMMPS *lmp, MPMField &field) : Pointers(lmp), field(field) {}

/* ----------------------------------------------------------------------
   Sizes stay the same throughout a step. At the start
   a point is a box of its volume. A contiguous one follows F: what was a box of half sizes l has the
   second moments F diag(l^2) F^T/3, along axis d those of an interval with the half size
   [sum_e (F_de l_e)^2]^1/2. Without shear and rotation this is F_dd l_d, and a cube that just turns
   keeps its size. Half a cell is the limit: beyond, a point would reach more nodes than the stencil
   has.
------------------------------------------------------------------------- */

void MPMBoxes::update()
{
  sizes.resize(3 * (std::size_t) atom->nmax, MAX_SIZE);
  for (const auto &run : field.map->runs)
    for (int i = run.first; i < run.last; i++) size_of(i, &sizes[3 * (std::size_t) i]);
}

void MPMBoxes::size_of(int i, double *size) const
{
  constexpr double MIN_SIZE = 1.0e-4;
  const int dim = field.lattice.dim;
  const double *const aspect = field.options.aspect;
  const double half = half_size(field, i), *F = field.points->F[i];
  for (int d = 0; d < dim; d++, F += 3) {
    double edge = aspect[d];
    if (field.options.shape == CPGIMP) {
      double square = 0.0;
      for (int e = 0; e < dim; e++) square += F[e] * F[e] * aspect[e] * aspect[e];
      edge = sqrt(square);
    }
    size[d] = std::max(MIN_SIZE, std::min(MAX_SIZE, half * edge));
  }
}

bool MPMBoxes::is_too_large(int i) const
{
  const double half = half_size(field, i);
  for (int d = 0; d < field.lattice.dim; d++)
    if (half * field.options.aspect[d] > MAX_SIZE * (1.0 + 1.0e-6)) return true;
  return false;
}

double MPMBoxes::smallest() const
{
  double least = MAX_SIZE;
  for (int i = 0; i < atom->nlocal; i++)
    if (field.is_point(i)) least = std::min(least, half_size(field, i));
  return least;
}

double LAMMPS_NS::half_size(const MPMField &field, int i)
{
  const double section = field.frame->section(i);
  return 0.5 * (field.lattice.dim == 3 ? cbrt(section) : sqrt(section)) / field.lattice.h;
}
