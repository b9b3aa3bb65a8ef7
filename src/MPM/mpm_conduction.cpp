/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   With the capacities C_p = m_p c_p and volumes V_p of points, and N_ip, grad N_ip where they are,

     C_i = sum_p C_p N_ip,  T_i = sum_p C_p N_ip [T_p + g_p (x_i - x_p)]/C_i,
     C_i dT_i/dt = - sum_p V_p k_p (sum_j T_j grad N_jp) . grad N_ip + sum_p V_p s_p N_ip + faces,

   with the gradient g_p of each point but for the transfer pic, and sources s_p. Then points get

     T_p = sum_i N_ip T_i                                                  (pic, affine)
     T_p = sum_i N_ip T_i + e (T_p - sum_i N_ip T_i of the start)          (relax)
     g_p = D^-1 sum_i N_ip T_i (x_i - x_p),  D = sum_i N_ip (x_i - x_p) (x_i - x_p)^T

   All of them keep sum_p C_p T_p: the sum of weights is one, and sum_i N_ip (x_i - x_p) = 0.

   Without g_p, nodes at faces, whose points are all on one side, would have the temperature of another place: an
   error of first order in the heat that flows. With pic each step smoothes, as a conductivity of the order of h^2/dt
   does, and with affine of the order of h^4 k^2/dt for a wave number k, which is too much in many short steps: a bar with 20 cells
   that is heated from one end was 8 % too warm with steps of 1/100 of the explicit limit. What nodes do
   not see of the temperatures of points goes, by conduction, in about the time h^2 rho c/k in which heat crosses a
   cell: with relax a share 1 - e of it, e = exp(-R dt k/(rho c h^2)), goes in a step, so that what this smoothes does
   not depend on the time step and is of second order. e is that of the material that conducts least: only if it is the
   same for all points is heat kept.

   Stability. The matrix of conduction is a sum over points of V_p k_p grad N grad N^T, that of capacities of
   C_p diag(N); the greatest eigenvalue of the sum is not above the greatest of the parts,

     V_p k_p/C_p max_d sum_i (dN_ip/dx_d)^2/N_ip,

   as functions are products along the axes, for which the matrix sum_i grad N grad N^T/N is diagonal. The
   sum is at most 6/h^2 for quadratic B-splines and 3.2/h^2 for cubic ones, in any dimension and wherever
   points are; the explicit limit 2 over this is about 0.33 h^2 density c/k for the former. Linear functions have no such bound.

   Longer steps are made of stages (MPMSuperStep). The heat through each face goes through the same stages, so that
   it is that of the points to round-off.
------------------------------------------------------------------------- */

#include "mpm_conduction.h"

#include "atom.h"
#include "mpm_field.h"
#include "mpm_points.h"
#include "mpm_stencil.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ---------------------------------------------------------------------- */

MPMConduction::MPMConduction(LAMMPS *lmp, MPMField &field, const MPMHeatTransfer &transfer,
                             const MPMHeatCondition *conditions) :
    Pointers(lmp),
    field(field), faces(lmp, field, conditions), scalar(field), transfer(transfer)
{
}

/* ---------------------------------------------------------------------- */

void MPMConduction::init(double sigma)
{
  thermals.clear();
  slowest = std::numeric_limits<double>::max();
  for (const auto *fix : field.materials) {
    const auto &material = *fix->material;
    if (!material.conducts()) continue;
    const int T = fix->find_history("temperature"), molten = fix->find_history("molten");
    const bool varies = material.conduction_varies();
    const Conduction all = material.conduction(nullptr);
    thermals.push_back({fix, T, molten, varies, all});
    slowest = std::min(slowest, all.conductivity / (material.density() * all.capacity));
  }
  const MPMStencil stencil(field);
  constexpr int SAMPLES = 4096;
  steepest = 0.0;
  for (int k = 0; k < SAMPLES; k++) {
    int node;
    double w[4], slope[4], sum = 0.0;
    const int n = stencil.weights((k + 1.0e-3) / SAMPLES, node, w, slope);
    for (int j = 0; j < n; j++)
      if (w[j] > 0.0) sum += slope[j] * slope[j] / w[j];
    steepest = std::max(steepest, sum);
  }
  fastest = 0.0;
  faces.init(sigma);
  scalar.init(transfer.kind != MPMHeatTransfer::PIC, faces.any());
}

/* ---------------------------------------------------------------------- */

const MPMConduction::Thermal *MPMConduction::thermal(const FixMPMMaterial *fix) const
{
  for (const auto &t : thermals)
    if (t.fix == fix) return &t;
  return nullptr;
}

double MPMConduction::volume_of(int i) const
{
  return atom->vfrac[i] * field.points->jacobian(i);
}

/* ----------------------------------------------------------------------
   temperatures of the nodes; the limit is the largest V k/C of this rank's points
------------------------------------------------------------------------- */

MPMConduction::Limits MPMConduction::points_to_nodes(const MPMRows &gradients)
{
  const int dim = field.lattice.dim;
  double most = 0.0;
  volumes.resize(atom->nmax);
  scalar.points_to_nodes(
      [&](const MPMPointMap::Run &run, int first, int n, MPMNodeScalar::Points &points) {
        const Thermal *const t = thermal(run.material);
        if (!t) return false;
        for (int p = 0; p < n; p++) {
          const int i = first + p;
          const Conduction c = t->at(i);
          const double C = atom->rmass[i] * c.capacity, V = volumes[i] = volume_of(i);
          points.capacity[p] = C;
          points.volume[p] = V;
          points.value[p] = t->fix->history[i][t->temperature];
          for (int d = 0; gradients && d < dim; d++) points.slope[3 * p + d] = gradients[i][d];
          most = std::max(most, c.conductivity * V / C);
        }
        return true;
      });
  return {most, faces.begin_step(capacity, volume, temperature)};
}

/* ----------------------------------------------------------------------
   rates of the temperatures of the nodes, and the power that comes in
------------------------------------------------------------------------- */

void MPMConduction::find_rates(const double *source, Heats &power)
{
  scalar.find_rates([&](const MPMPointMap::Run &run, int first, int n, MPMNodeScalar::Rows q) {
    const Thermal *const t = thermal(run.material);
    for (int p = 0; p < n; p++) {
      const int i = first + p;
      const double factor = -t->at(i).conductivity * volumes[i];
      for (int d = 0; d < 3; d++) q[p][d] *= factor;
      q[p][3] = source ? volumes[i] * source[i] : 0.0;
      power[SOURCES] += q[p][3];
    }
  });
  for (std::size_t k = 0; k < given.size(); k++)
    if (capacity[k] > 0.0) rate[k] += given[k] / (field.step_dt() * capacity[k]);
}

/* ----------------------------------------------------------------------
   temperatures of points
------------------------------------------------------------------------- */

double MPMConduction::nodes_to_points(const MPMRows &gradients)
{
  const int dim = field.lattice.dim;
  const double crossings = slowest * field.step_dt() / (field.lattice.h * field.lattice.h);
  const bool relaxes = transfer.kind == MPMHeatTransfer::RELAX;
  const double keep = relaxes ? exp(-transfer.relax * crossings) : 0.0;
  double got = 0.0;
  scalar.nodes_to_points(
      [&](const MPMPointMap::Run &run, int first, int n, MPMNodeScalar::Rows q,
          const double *before) {
        const Thermal *const t = thermal(run.material);
        for (int p = 0; p < n; p++) {
          const int i = first + p;
          const Conduction c = t->at(i);
          double *const history = t->fix->history[i], &T = history[t->temperature];
          const double now = relaxes ? q[p][3] + keep * (T - before[p]) : q[p][3];
          got += atom->rmass[i] * c.capacity * (now - T);
          T = now;
          if (t->molten >= 0) c.melting.settle(T, history[t->molten]);
          for (int d = 0; gradients && d < dim; d++) gradients[i][d] = q[p][d];
        }
      },
      relaxes);
  return got;
}

/* ---------------------------------------------------------------------- */

double MPMConduction::greatest_rate(const Limits &all)
{
  fastest = all.exchange;
  return all.diffusivity * steepest / (field.lattice.h * field.lattice.h) + fastest;
}

double MPMConduction::greatest_rate_of_points(tagint &tag) const
{
  double most = 0.0;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    const Thermal *const t = thermal(field.material_of(i));
    if (!t) continue;
    const Conduction c = t->at(i);
    const double here = c.conductivity * volume_of(i) / (atom->rmass[i] * c.capacity);
    if (here <= most) continue;
    most = here;
    tag = atom->tag[i];
  }
  return most * steepest / (field.lattice.h * field.lattice.h) + fastest;
}

double MPMConduction::memory_usage() const
{
  return faces.memory_usage() + scalar.memory_usage() +
      (volumes.capacity() + given.capacity()) * sizeof(double);
}
