/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   The generalised alpha method and that of Hilber, Hughes, and Taylor. The acceleration at the start of a
   step is that at the end of the step before, which balances forces of no single time. Points keep it, as
   they keep velocities: nodes get the mean by the masses of points, and points get the change of what nodes
   have. In the first step it follows from the forces, as in Newmark's method.
------------------------------------------------------------------------- */

#include "implicit/mpm_implicit.h"

#include "atom.h"
#include "field/mpm_field.h"
#include "field/mpm_stencil.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** Accelerations of nodes from those that points have kept, with walls. */
void MPMImplicit::find_accelerations()
{
  const int dim = width;
  const double *const of_point = lmp->atom->rmass;
  // walls with contact hold by forces of the end of the step alone:
  // until then, nodes have accelerations of the body there
  std::vector<double> borne;
  if (impacts) {
    std::vector<double> rest = acceleration;
    project(rest.data());
    borne = acceleration;
    for (int64_t k = 0; k < nreals(); k++) borne[k] -= rest[k];
  }
  acceleration.assign(nreals(), 0.0);
  for (auto &member : members) {
    MPMField &of = member->field;
    double *const values = &acceleration[dim * member->first];
    const MPMStencil stencil(of);
    for (const auto &run : of.map->runs)
      for (bigint i = run.first; i < run.last; i++) {
        const double *const a = kept.rows[(int) i];
        stencil.visit(of.grid.blocks[run.slot], (int) i, [&](const MPMStencil::Node &node) {
          const double share = of_point[i] * node.weight;
          for (int d = 0; d < dim; d++) values[dim * node.number + d] += share * a[d];
        });
      }
    of.nodes.sum(values, dim, 0, dim);
  }
  for (int64_t k = 0; k < nreals(); k++)
    acceleration[k] = mass[k / dim] > 0.0 ? acceleration[k] / mass[k / dim] : 0.0;
  if (impacts) mean = acceleration;
  project(acceleration.data());
  for (std::size_t k = 0; k < borne.size(); k++) acceleration[k] += borne[k];
}

/** Gives points the change of the accelerations of nodes, in the first step all of them. Points are where
 *  they were at the start of the step. */
void MPMImplicit::keep_accelerations()
{
  const int dim = width;
  const auto &had = impacts ? mean : acceleration;
  if (kept.known)
    for (int64_t k = 0; k < nreals(); k++) next[k] -= had[k];
  for (auto &member : members) {
    MPMField &of = member->field;
    double *const values = &next[dim * member->first];
    of.nodes.complete(values, dim, dim);
    const MPMStencil stencil(of);
    for (const auto &run : of.map->runs)
      for (bigint i = run.first; i < run.last; i++) {
        double *const a = kept.rows[(int) i];
        stencil.visit(of.grid.blocks[run.slot], (int) i, [&](const MPMStencil::Node &node) {
          for (int d = 0; d < dim; d++) a[d] += node.weight * values[dim * node.number + d];
        });
      }
  }
  kept.known = true;
}
