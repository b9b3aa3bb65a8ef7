/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Conductivities of points: in layers, at temperatures where they jump, and along axes that turn
// with the material

#include "heat/mpm_conduction.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_passes.h"
#include "field/mpm_stencil.h"
#include "material/material.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// half of the range over which a conductivity that jumps at melting is averaged, in node spacings
static constexpr double HALF_RANGE = 0.25;
// ratio of conductivities for which means across interfaces matter little
static constexpr double SAME = 2.0;

/** Materials of different conductivity in one field get means next to their interfaces, if
 *  conductivities are numbers and functions are smooth. */
void MPMConduction::init_layers()
{
  layers.reset();
  greatest = 0.0;
  const bool can = !total && steepest != 0.0;
  bool differ = false, orthotropic = false;
  double fastest = 0.0, least = 0.0;
  const Thermal *first = nullptr;
  for (const auto &t : thermals) {
    if (!is_present(t)) continue;
    orthotropic = orthotropic || t.all.orthotropic;
    if (!first)
      first = &t;
    else
      differ = differ || t.varies || first->varies || t.all.orthotropic != first->all.orthotropic ||
          t.all.conductivity != first->all.conductivity;
    const double capacity = t.fix->material->density() * t.all.capacity;
    greatest = std::max(greatest, t.all.conductivity);
    least = &t == first ? t.all.conductivity : std::min(least, t.all.conductivity);
    fastest = std::max(fastest, t.all.conductivity / capacity);
  }
  if (!can && differ && greatest > SAME * least && !*warned) {
    *warned = true;
    if (comm->me == 0)
      error->warning(
          FLERR,
          "Fix mpm/heat: conductivities of materials in fix mpm {} are {:.3g} to {:.3g}, "
          "and with {} there are no means across their interfaces, through which too "
          "much heat goes{}: use shape quadratic or cubic{}",
          field.id(), least, greatest, total ? "frame total" : "this shape",
          steepest == 0.0 ? " unless they are in planes of nodes" : "",
          total ? " with frame updated" : "");
  }
  if (!can) {
    greatest = 0.0;
    return;
  }
  if (orthotropic && differ && !*warned) {
    *warned = true;
    if (comm->me == 0)
      error->warning(FLERR,
                     "Fix mpm/heat: materials of different conductivity share fix mpm {}, and one "
                     "of them is orthotropic: there are no means across their interfaces, and with "
                     "few cells too little or too much heat goes through",
                     field.id());
  }
  if (orthotropic) return;
  if (!differ) return;
  const bool along = greatest <= MPMLayerMean::MOST * fastest * least_capacity;
  layers = std::make_unique<MPMLayerMean>(field, along);
  layers->init();
}

/** As Thermal::at(), with the mean of conductivities that jump. */
const Conduction &MPMConduction::conduction_of(const Thermal &t, int i, Conduction &buffer) const
{
  if (!t.jumps || ranges.empty()) return t.at(i, buffer);
  return buffer =
             mean_conduction(*t.fix->material, t.fix->history[i], ranges[i].low, ranges[i].high);
}

/** Finds the ranges of the means of conductivities that jump, from the temperatures of nodes.
 *  Raises the rate of the fastest point by these means. */
void MPMConduction::find_ranges()
{
  if (std::none_of(thermals.begin(), thermals.end(), [](const Thermal &t) {
        return t.jumps;
      }))
    return;
  ranges.resize(atom->nmax);
  const int dim = field.lattice.dim;
  const double half = HALF_RANGE * field.lattice.h;
  scalar.gradients_to_points(
      [&](const MPMPointMap::Run &run, int first, int n, MPMNodeScalar::Rows q) {
        const Thermal &t = *thermal(run.material);
        for (int p = 0; t.jumps && p < n; p++) {
          double reach = 0.0;
          for (int d = 0; d < dim; d++) reach = std::max(reach, half * fabs(q[p][d]));
          ranges[first + p] = {q[p][3] - reach, q[p][3] + reach};
        }
      });
  for (const auto &run : field.map->runs) {
    const Thermal *const t = thermal(run.material);
    for (int i = run.first; t && t->jumps && i < run.last; i++) {
      Conduction buffer;
      const double own = t->at(i, buffer).most(), mean = conduction_of(*t, i, buffer).most();
      if (!(mean > own)) continue;
      const double rate = simple ? mean * volumes[i] / (atom->rmass[i] * buffer.capacity)
                                 : bound(*t, i, volumes[i]);
      const double layer = layers ? layers->most(i) / own : 1.0;
      fastest_point = std::max(fastest_point, layer * rate);
    }
  }
}

/* ----------------------------------------------------------------------
   Conductivity of a point for gradients on the lattice. Total frame: V k becomes V F^-1 k F^-T
------------------------------------------------------------------------- */

void MPMConduction::tensor(const Thermal &t, int i, double k[3][3]) const
{
  Conduction buffer;
  const Conduction &c = conduction_of(t, i, buffer);
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) k[a][b] = a == b ? c.conductivity : 0.0;
  if (c.orthotropic) {
    double along[3], n[3][3];
    principal_conductivities(c, field.points->F[i], along, n);
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++)
        k[a][b] = along[0] * n[0][a] * n[0][b] + along[1] * n[1][a] * n[1][b] +
            along[2] * n[2][a] * n[2][b];
  }
  if (!total) return;
  double F[3][3], inverse[3][3], half[3][3];
  field.frame->lattice_F(i, F);
  MathExtra::invert3(F, inverse);
  MathExtra::times3(inverse, k, half);
  MathExtra::times3_transpose(half, inverse, k);
}
