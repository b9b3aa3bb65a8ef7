/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Pore water in implicit steps. The equations on nodes are those at the top of mpm_pore.cpp, with
   the pressure p at the end of the step in forces and in flow (backward Euler), and the volume that
   the motion squeezes out in the whole step:

     C (p - p0) = - sum_p alpha dV_p N_ip + dt (flow to the node by p)
                  - sum_p b_p V_p grad N_ip . grad (p - p0).

   Capacities, permeabilities, and the positions of the flow are those at the start of the step; fix
   mpm/implicit solves for p and the motion together (mpm_coupled_pressure.cpp).

   The last term keeps pressures from alternating. Where water has no time to flow through a cell,
   the soil responds to the pressure by D K^-1 D^T with its stiffness K. For a wave with q radians
   from node to node, this should be 1/M, with the modulus M of soil that cannot widen. It is 1 -
   q^2/4 of this for small q and nothing at q = pi. The flow b grad(p - p0) with b = alpha^2 h^2/(4
   M) makes that 1 + O(q^4) (G. Aguilar, F. Gaspar, F. Lisbona, C. Rodrigo, Int. J. Numer. Methods
   Eng. 75 (2008) 1282). It moves water between nodes, so that none is lost, and vanishes with the
   change of the pressure in a step. With inertia M is that of a soil that does not get far in the
   step, M + rho h^2/dt^2.

   Points keep the part of their pressures that nodes do not see as long as water needs to cross a
   cell, as in explicit steps, but with the storage of soil and water together, and the same share
   everywhere, so that its sum stays zero.
------------------------------------------------------------------------- */

#include "pore/mpm_pore.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_passes.h"
#include "field/mpm_point_batches.h"
#include "field/mpm_stencil.h"
#include "force.h"
#include "material/material.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double SMOOTHING = 0.25;    // b M/(alpha h)^2

void MPMPore::begin_solve(double dt, bool inertial)
{
  const std::size_t nmax = atom->nmax;
  const double h = field.lattice.h, unit = force->mvv2e * force->nktv2p;
  if (!solve) solve = std::make_unique<Solve>();
  unseen.clear();    // from a step that was not known to be implicit
  Solve &s = *solve;
  s.dt = dt;
  s.capacity = nodes.capacity;
  s.start = nodes.value;
  for (auto *list : {&s.capacity, &s.start}) field.nodes.complete(list->data(), 1, 1);
  for (auto *list : {&s.biot, &s.smoothing, &s.more}) list->assign(nmax, 0.0);
  s.gradient.assign(3 * nmax, 0.0);
  int list[BATCH];
  double c[BATCH], slowest = std::numeric_limits<double>::max(), all;
  each_point_batch(field, [&](const auto &run, int first, int n) {
    const Soil *const soil_here = soil(run.material);
    if (!soil_here) return;
    std::iota(list, list + n, first);
    load_state(field, *field.batch, list, n, run.material);
    run.material->material->wave_speed(*field.batch, c);
    for (int p = 0; p < n; p++) {
      const int i = first + p;
      const double J = field.points->jacobian(i), V = J * atom->vfrac[i],
                   density = unit * run.material->density(i) / J, alpha = soil_here->of.biot;
      const double M = density * c[p] * c[p], slow = inertial ? M + density * h * h / (dt * dt) : M;
      s.biot[i] = alpha;
      s.smoothing[i] = SMOOTHING * alpha * alpha * h * h * V / slow;
      slowest = std::min(slowest, conductance[i] / (capacity[i] + alpha * alpha * V / M));
    }
  });
  MPI_Allreduce(&slowest, &all, 1, MPI_DOUBLE, MPI_MIN, world);
  s.keep = exp(-dt * all / (h * h));
  nodes.gradients_to_points([&](const MPMPointMap::Run &, int first, int n, MPMNodeScalar::Rows q) {
    for (int p = 0; p < n; p++)
      std::copy_n(q[p], field.lattice.dim, &s.gradient[3 * (std::size_t)(first + p)]);
  });
}

void MPMPore::to_points(const std::vector<double> &p, double *of_points)
{
  nodes.value = p;
  std::fill_n(of_points, atom->nmax, 0.0);
  nodes.values_to_points([&](const MPMPointMap::Run &, int first, int n, const double *values) {
    for (int k = 0; k < n; k++) of_points[first + k] = solve->biot[first + k] * values[k];
  });
}

double MPMPore::find_residual(const std::vector<double> &p, const double *dV, double *r)
{
  const Solve &s = *solve;
  std::vector<double> inflow(MPMPoreSurface::NPART + 1, 0.0);
  for (int i = 0; i < atom->nlocal; i++) squeezed[i] = -s.biot[i] * dV[i] / s.dt;
  nodes.value = p;
  find_rates(inflow);
  field.nodes.complete(nodes.rate.data(), 1, 1);
  double taken = 0.0;
  for (std::size_t k = 0; k < p.size(); k++) {
    r[k] = s.capacity[k] * (s.start[k] + s.dt * nodes.rate[k] - p[k]);
    if (field.grid.owns((int64_t) k)) taken += s.capacity[k] * fabs(p[k] - s.start[k]);
  }
  // where soil and water were at rest before, the flow through the surface may be the only one
  for (int part = 0; part < MPMPoreSurface::NPART; part++) taken += s.dt * fabs(inflow[part]);
  return taken + s.dt * s.carried;
}

double MPMPore::response() const
{
  const double h = field.lattice.h;
  double sum = 0.0;
  each_point(field, [&](const auto &run, int i) {
    if (soil(run.material)) sum += capacity[i] + solve->dt * conductance[i] / (h * h);
  });
  return sum;
}

/** Flow of a point from minus the gradient of the pressure, times its volume, in place. */
void MPMPore::conduct(int i, double *q) const
{
  double more[3];
  for (int d = 0; d < 3; d++) more[d] = solve->smoothing[i] / solve->dt * q[d];
  if (layers) layers->multiply(i, q);
  for (int d = 0; d < 3; d++) q[d] = (layers ? volumes[i] : conductance[i]) * q[d] + more[d];
}

void MPMPore::find_changes(const double *p, const double *dV, double *y)
{
  const Solve &s = *solve;
  nodes.value.assign(p, p + s.capacity.size());
  std::function<void()> more;
  if (surface.any())
    more = [&] {
      surface.add_changes(nodes);
    };
  nodes.find_rates(
      [&](const MPMPointMap::Run &, int first, int n, MPMNodeScalar::Rows q) {
        for (int k = 0; k < n; k++) {
          const int i = first + k;
          for (int d = 0; d < 3; d++) q[k][d] = d < field.lattice.dim ? -q[k][d] : 0.0;
          conduct(i, q[k]);
          q[k][3] = dV ? -s.biot[i] * dV[i] / s.dt : 0.0;
        }
      },
      more);
  field.nodes.complete(nodes.rate.data(), 1, 1);
  for (std::size_t k = 0; k < s.capacity.size(); k++)
    y[k] = s.capacity[k] * (p[k] - s.dt * nodes.rate[k]);
}

void MPMPore::find_softness(const std::vector<double> &moduli, std::vector<double> &softness)
{
  static constexpr double LEAST = 1.0e-3;    // least share of the elastic modulus, where soil flows
  const Solve &s = *solve;
  const double h = field.lattice.h;
  softness.assign(atom->nmax, 0.0);
  each_point(field, [&](const auto &, int i) {
    const double alpha = s.biot[i], V = field.points->jacobian(i) * atom->vfrac[i];
    if (!(s.smoothing[i] > 0.0)) return;
    const double elastic = SMOOTHING * alpha * alpha * h * h * V / s.smoothing[i];
    softness[i] = V / std::max(moduli[i], LEAST * elastic);
  });
}

void MPMPore::each_term(const std::vector<double> &softness, const Term &use)
{
  const MPMStencil stencil(field);
  const int dim = field.lattice.dim;
  const double dt = solve->dt;
  std::vector<int64_t> list;
  std::vector<double> gradients, weights;
  each_point(field, [&](const auto &run, int i) {
    if (!soil(run.material)) return;
    list.clear();
    gradients.clear();
    weights.clear();
    stencil.visit(field.grid.blocks[run.slot], i, [&](const MPMStencil::Node &node) {
      list.push_back(node.number);
      gradients.insert(gradients.end(), node.gradient, node.gradient + dim);
      weights.push_back(node.weight);
    });
    double stiffness[9];
    for (int column = 0; column < dim; column++) {
      double q[3] = {0.0, 0.0, 0.0};
      q[column] = dt;
      conduct(i, q);
      for (int d = 0; d < dim; d++) stiffness[dim * d + column] = q[d];
    }
    use((int) list.size(), list.data(), dim, gradients.data(), stiffness);
    const double of_soil = solve->biot[i] * solve->biot[i] * softness[i];
    use((int) list.size(), list.data(), 1, weights.data(), &of_soil);
  });
  if (surface.any()) surface.each_term(dt, use);
}

/** The residual of the equations, within the tolerance of the solution, goes to the mass of points
 *  as well, so that points get exactly the water that comes through the surface, to round-off. */
void MPMPore::take_solution(std::vector<double> &inflow)
{
  const std::vector<double> now = nodes.value;
  // the residual has had the rates of volumes in the place of volumes
  each_point(field, [&](const auto &, int i) {
    squeezed[i] = field.points->jacobian(i) * atom->vfrac[i];
  });
  take_motion(field.step_dt());
  find_rates(inflow);
  field.nodes.complete(nodes.rate.data(), 1, 1);
  for (std::size_t k = 0; k < now.size(); k++)
    nodes.value[k] = solve->start[k] + solve->dt * nodes.rate[k] - now[k];
  nodes.values_to_points([&](const MPMPointMap::Run &, int first, int n, const double *values) {
    std::copy_n(values, n, &solve->more[first]);
  });
  nodes.value = now;
}
