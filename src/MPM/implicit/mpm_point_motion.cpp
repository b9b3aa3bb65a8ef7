/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/mpm_point_motion.h"

#include "field/mpm_affine.h"
#include "field/mpm_passes.h"
#include "field/mpm_stencil.h"

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

/* ----------------------------------------------------------------------
   The mid-point rule with affine points. Nodes move by u = dt (v0 + v1)/2, and forces are those
   after u/2. They have no torque about the places of nodes at that time, sum (x_i + u_i/2) x f_i =
   0, because Kirchhoff stress is symmetric, so that sum (x_i + u_i) x m v1_i = sum x_i x m v0_i.
   Points have moved with the mean velocity u/dt, and their matrices are those of this velocity;
   here they get the rest w = v1 - u/dt. The angular momentum of the nodes at their new places is
   that of the points if the matrix D C of a point has

     sum_i N_ip v1_i (x_i + u_i - x_p - u_p)^T

   as its part that is not symmetric, as in the matrices of C. Jiang, C. Schroeder, J. Teran, J.
   Comput. Phys. 338 (2017) 137 for steps of this kind. For backward Euler, u = dt v1, the part with
   u is symmetric by itself.
------------------------------------------------------------------------- */

void MPMAffineMidpoint::find_changes(double step_dt, const std::vector<double> &velocity,
                                     const std::vector<double> &rest)
{
  dt = step_dt;
  const int dim = nodes.width, square = dim * dim, U = dim;
  of_nodes.assign(2 * nodes.nreals(), 0.0);
  for (int64_t n = 0; n < nodes.nnodes(); n++)
    for (int d = 0; d < dim && nodes.mass[n] > 0.0; d++) {
      of_nodes[2 * dim * n + d] = rest[dim * n + d];
      of_nodes[2 * dim * n + U + d] = dt * velocity[dim * n + d];
    }
  of_points.assign((std::size_t) nodes.lmp->atom->nmax * (dim + square), 0.0);
  for (auto &body : nodes.bodies)
    if (body.field.affine) find_changes(body);
}

/** For the points of one field. */
void MPMAffineMidpoint::find_changes(MPMSolvedNodes::Body &body)
{
  MPMField &of = body.field;
  const int dim = nodes.width, square = dim * dim, U = dim;
  double *const values = &of_nodes[2 * dim * body.first];
  of.nodes.complete(values, 2 * dim, 2 * dim);

  const double h = of.lattice.h,
               inverse = shape_constants[of.options.shape].inv_moment / (h * h);    // of D
  const MPMStencil stencil(of);
  for (const auto &run : of.map->runs)
    for (bigint i = run.first; i < run.last; i++) {
      double *const more = &of_points[i * (dim + square)], *const C = more + dim;
      double end[3] = {0.0}, moved[3] = {0.0}, products[9] = {0.0};
      stencil.visit(of.grid.blocks[run.slot], (int) i, [&](const MPMStencil::Node &node) {
        const double *const w = &values[2 * dim * node.number], *const u = w + U;
        for (int a = 0; a < dim; a++) {
          const double v1 = u[a] / dt + w[a];
          more[a] += node.weight * w[a];
          end[a] += node.weight * v1;
          moved[a] += node.weight * u[a];
          for (int b = 0; b < dim; b++) {
            C[dim * b + a] -= inverse * node.weight * w[a] * h * node.r[b];
            products[3 * a + b] += node.weight * v1 * u[b];
          }
        }
      });
      for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++)
          C[dim * b + a] += 0.5 * inverse *
              (products[3 * a + b] - end[a] * moved[b] - products[3 * b + a] + end[b] * moved[a]);
    }
}

void MPMAffineMidpoint::change_points()
{
  const int dim = nodes.width, square = dim * dim;
  for (auto &body : nodes.bodies) {
    MPMField &of = body.field;
    if (!of.affine) continue;
    const double kinetic = of.ledger.on ? of.ledger.point_kinetic_energy() : 0.0;
    for (const auto &run : of.map->runs)
      for (bigint i = run.first; i < run.last; i++) {
        const double *const more = &of_points[i * (dim + square)];
        for (int d = 0; d < dim; d++) nodes.lmp->atom->v[i][d] += more[d];
        for (int k = 0; k < square; k++) of.affine->C[i][k] += more[dim + k];
      }
    if (!of.ledger.on) continue;
    const double gained = of.ledger.point_kinetic_energy() - kinetic;
    of.ledger.transfer += gained;
    of.ledger.take(-gained);
  }
}
