/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/mpm_point_accelerations.h"

#include "field/mpm_point_map.h"
#include "field/mpm_stencil.h"
#include "implicit/mpm_solved_nodes.h"

#include "atom.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

void MPMPointAccelerations::to_nodes(MPMSolvedNodes &nodes, std::vector<double> &a) const
{
  const int dim = nodes.width;
  const double *const mass = nodes.lmp->atom->rmass;
  a.assign(nodes.nreals(), 0.0);
  for (auto &body : nodes.bodies) {
    MPMField &field = body.field;
    double *const values = &a[dim * body.first];
    const MPMStencil stencil(field);
    for (const auto &run : field.map->runs)
      for (bigint i = run.first; i < run.last; i++) {
        const double *const mine = rows[(int) i];
        stencil.visit(field.grid.blocks[run.slot], (int) i, [&](const MPMStencil::Node &node) {
          const double part = mass[i] * node.weight;
          for (int d = 0; d < dim; d++) values[dim * node.number + d] += part * mine[d];
        });
      }
    field.nodes.sum(values, dim, 0, dim);
  }
  for (int64_t k = 0; k < nodes.nreals(); k++)
    a[k] = nodes.mass[k / dim] > 0.0 ? a[k] / nodes.mass[k / dim] : 0.0;
}

void MPMPointAccelerations::add_from_nodes(MPMSolvedNodes &nodes, std::vector<double> &change)
{
  const int dim = nodes.width;
  for (auto &body : nodes.bodies) {
    MPMField &field = body.field;
    double *const values = &change[dim * body.first];
    field.nodes.complete(values, dim, dim);
    const MPMStencil stencil(field);
    for (const auto &run : field.map->runs)
      for (bigint i = run.first; i < run.last; i++) {
        double *const mine = rows[(int) i];
        stencil.visit(field.grid.blocks[run.slot], (int) i, [&](const MPMStencil::Node &node) {
          for (int d = 0; d < dim; d++) mine[d] += node.weight * values[dim * node.number + d];
        });
      }
  }
  known = true;
}
