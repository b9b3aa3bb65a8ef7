/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Soil and its pore water as one set of points with the velocity v of the soil (u-p). With the pressure p of the
   water, compression positive,

     rho dv/dt = div(sigma' - alpha p I) + rho g,
     S dp/dt = - alpha div v - div w,   w = - k (grad p - rho_f g),   S = n/K_f + (alpha - n)/K_s,

   sigma' is the stress of the material, w the volume of water that flows through a unit of area, and k the mobility.
   The acceleration of the water relative to that of the soil is left out, and that of both in w.

   On nodes, with C_p = S_p V_p, and D the matrix of sum_p alpha V_p N_ip grad N_jp,

     p_i = sum_p C_p N_ip (p_p + g_p . (x_i - x_p))/C_i,    M dv/dt = ... + D^T p,    C dp/dt = - D v - ...,

   which means that forces have the pressure sum_i N_ip p_i of each point, and that what the motion squeezes out goes to
   nodes with the same weights: what the pressure takes from the motion is what the water stores, for any position
   of points in their cells. Both matter. With pressures of their own in forces, several points per cell ask for more
   constraints than the velocities of the nodes can give (locking). As D maps onto what D^T sees, motion
   never excites pressures that make no force on nodes, such as one that alternates from node to node. Only
   what changes the pressure otherwise does: drained faces, see mpm_pore_surface.cpp.

   Time. v is new when p follows: symplectic Euler, stable up to 2/omega of undrained waves without flow. An
   explicit step of the flow multiplies a pressure by a = 1 - lambda dt; together they are stable up to
   (omega dt)^2 < 2 (1 + a): not at all near the explicit limit a = -1. Stages of RKL2 have a > 0 whatever
   their number is (their greatest share is 2b < 1 with b = (s^2 + s - 2)/(2 s^2 + 2 s)), hence stages begin at half of that limit,
   and waves and flow do not make each other's limit smaller.

   The motion changes the volume of a point by exactly det(I + dt L) - 1, and water is what fills it.
------------------------------------------------------------------------- */

#include "mpm_pore.h"

#include "atom.h"
#include "fix_mpm_material.h"
#include "force.h"
#include "material/material.h"
#include "mpm_field.h"
#include "mpm_frame.h"
#include "mpm_passes.h"
#include "mpm_points.h"
#include "mpm_stencil.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ---------------------------------------------------------------------- */

MPMPore::MPMPore(LAMMPS *lmp, MPMField &field, const MPMPoreWater &water,
                 const MPMPoreSurface::Conditions &conditions, const double *gravity,
                 double relax) :
    Pointers(lmp),
    field(field), nodes(field), surface(lmp, field, conditions, water, gravity), water(water),
    gravity(gravity), relax(relax)
{
}

void MPMPore::init(const std::vector<MPMPoreSoil> &all)
{
  soils.clear();
  slowest = waves = least_storage = std::numeric_limits<double>::max();
  for (const auto *fix : field.materials)
    for (const auto &one : all)
      if (one.material == fix->id) {
        const double storage = one.storage_at(1.0, water);
        const double unit = force->mvv2e * force->nktv2p;
        soils.push_back({fix, one});
        least_storage = std::min(least_storage, storage);
        slowest = std::min(slowest, one.permeability / (water.resistance * storage));
        waves = std::min(waves, one.biot / sqrt(storage * fix->material->density() * unit));
      }
  nodes.init(true, surface.any());
  wet = !soils.empty();
  if (surface.any()) surface.init();

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
}

void MPMPore::look_for_water()
{
  int any = 0, all;
  for (const auto &run : field.map->runs) any |= soil(run.material) != nullptr;
  MPI_Allreduce(&any, &all, 1, MPI_INT, MPI_BOR, world);
  wet = all;
  if (any) field.jacobians.ask();
  if (wet) return;
  fastest = exchange = 0.0;
  nodes.value.clear();
  nodes.rate.clear();
}

const MPMPore::Soil *MPMPore::soil(const FixMPMMaterial *fix) const
{
  for (const auto &s : soils)
    if (s.fix == fix) return &s;
  return nullptr;
}

const MPMPoreSoil *MPMPore::soil_of(int i) const
{
  const Soil *const s = soil(field.material_of(i));
  return s ? &s->of : nullptr;
}

double MPMPore::mobility(const Soil &s, int i, double J, const double *formula) const
{
  const bool given = s.of.law == MPMPoreSoil::FORMULA;
  return (given ? formula[i] : s.of.permeability_at(J)) / water.resistance;
}

/* ---------------------------------------------------------------------- */

void MPMPore::points_to_nodes(const MPMRows &state, const double *formula)
{
  const int dim = field.lattice.dim;
  for (auto *list : {&capacity, &conductance, &mean, &squeezed}) list->resize(atom->nmax);
  in_forces.assign(atom->nmax, 0.0);
  fastest = exchange = 0.0;
  nodes.points_to_nodes(
      [&](const MPMPointMap::Run &run, int first, int n, MPMNodeScalar::Points &points) {
        const Soil *const s = soil(run.material);
        if (!s) return false;
        double *const C = capacity.data() + first, *const K = conductance.data() + first;
        double most = fastest, room[BATCH];
        const double *const ratios = field.jacobians.get(field, first, n, room);
        for (int p = 0; p < n; p++) {
          const int i = first + p;
          const double J = ratios[p], V = J * atom->vfrac[i];
          C[p] = V * s->of.storage_at(J, water);
          K[p] = V * mobility(*s, i, J, formula);
          in_forces[i] = s->of.biot * J;
          if (K[p] > most * C[p]) most = K[p] / C[p];    // hardly ever: no division
          points.volume[p] = K[p];
          points.capacity[p] = C[p];
          const double *const mine = state[i];
          points.row[p][3] = mine[0];
          points.row[p][0] = mine[1];
          points.row[p][1] = mine[2];
          if (dim == 3) points.row[p][2] = mine[3];
        }
        fastest = most;
        return true;
      },
      false);
}

/* ----------------------------------------------------------------------
   the best fit of nodes to values and gradients, and of gradients to nodes, in turns. Inside of a body a linear pressure is found
   at once; next to surfaces, where nodes have points on one side, the error falls from one turn to the next
------------------------------------------------------------------------- */

void MPMPore::find_gradients(const MPMRows &state, const double *formula)
{
  constexpr int TURNS = 100;
  constexpr double SAME = 1.0e-12;
  const int dim = field.lattice.dim;
  double change = 1.0, most = 0.0;
  for (int turn = 0; turn < TURNS && change > SAME * most; turn++) {
    points_to_nodes(state, formula);
    double mine[2] = {0.0, 0.0}, all[2];
    nodes.nodes_to_points(
        [&](const MPMPointMap::Run &, int first, int n, MPMNodeScalar::Rows q, const double *) {
          for (int p = 0; p < n; p++)
            for (int d = 0; d < dim; d++) {
              double &slope = state[first + p][1 + d];
              mine[0] = std::max(mine[0], fabs(q[p][d] - slope));
              mine[1] = std::max(mine[1], fabs(q[p][d]));
              slope = q[p][d];
            }
        },
        false);
    MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_MAX, world);
    change = all[0];
    most = all[1];
  }
}

/* ---------------------------------------------------------------------- */

void MPMPore::begin_step(const MPMRows &state, const double *formula)
{
  if (surface.any()) surface.find_places();
  points_to_nodes(state, formula);
  nodes.values_to_points([&](const MPMPointMap::Run &, int first, int n, const double *values) {
    for (int p = 0; p < n; p++) {
      mean[first + p] = values[p];
      in_forces[first + p] *= values[p];
    }
  });
  if (!surface.any()) return;
  // places at surfaces look at nodes of periodic images, too
  field.nodes.complete(nodes.capacity.data(), 1, 1);
  field.nodes.complete(nodes.volume.data(), 1, 1);
  exchange = surface.prepare(nodes, least_storage);
}

/* ---------------------------------------------------------------------- */

void MPMPore::take_motion()
{
  const int nL = field.lattice.dim * field.lattice.dim;
  const double dt = field.step_dt();
  const TransferStep step = field.step_data();
  const PointRows rows = field.rows();
  double L[9 * BATCH];
  field.nodes.complete_velocities();
  points_from_step(field, [&](const MPMPointMap::Run &run, int first, int n, const int *base) {
    const Soil *const s = soil(run.material);
    if (!s) return;
    field.kernel.g2p_gradient(rows, step, first, first + n, base, field.map->tile_load, L);
    double room[BATCH];
    const double *const ratios = field.jacobians.get(field, first, n, room);
    for (int p = 0; p < n; p++) {
      const int i = first + p;
      const double V = ratios[p] * atom->vfrac[i];
      squeezed[i] = -s->of.biot * V * field.frame->volume_change(i, L + nL * p, dt) / dt;
    }
  });
}

void MPMPore::find_rates(std::vector<double> &inflow)
{
  double weight[3];    // of the water, in pressure per length
  for (int d = 0; d < 3; d++) weight[d] = water.density * gravity[d] * force->nktv2p;
  const auto flow = [&](const MPMPointMap::Run &, int first, int n, MPMNodeScalar::Rows q) {
    double power[3] = {0.0, 0.0, 0.0};
    for (int p = 0; p < n; p++) {
      for (int d = 0; d < 3; d++) {
        q[p][d] = -conductance[first + p] * (q[p][d] - weight[d]);
        power[d] += q[p][d] * weight[d];
      }
      q[p][3] = squeezed[first + p];
    }
    inflow[MPMPoreSurface::ENERGY] += power[0] + power[1] + power[2];
  };
  if (surface.any())
    nodes.find_rates(flow, [&] {
      surface.add_rates(nodes, inflow);
    });
  else
    nodes.find_rates(flow);
}

/* ----------------------------------------------------------------------
   What nodes do not see of the pressures of points goes in the time in which flow crosses a cell, as in the conduction of
   heat (mpm_conduction.cpp), and also in about 1/relax of the time in which a wave does. On the way from nodes to points
   and back an alternating pressure keeps 0.61 of itself, and a linear one all: per time, k^4 is taken from a wave with the number
   k. So a pressure that alternates with next to no force on nodes, which a load that the lattice does not resolve makes, goes in
   some crossings of a cell, and one over many cells stays.
------------------------------------------------------------------------- */

void MPMPore::end_step(const MPMRows &state)
{
  const int dim = field.lattice.dim;
  const double dt = field.step_dt(), h = field.lattice.h;
  const double keep = exp(-(slowest / (h * h) + relax * waves / h) * dt);
  nodes.nodes_to_points(
      [&](const MPMPointMap::Run &, int first, int n, MPMNodeScalar::Rows q, const double *) {
        for (int p = 0; p < n; p++) {
          const int i = first + p;
          double *const mine = state[i];
          const double now = q[p][3] + keep * (mine[0] - mean[i]);
          const double more = capacity[i] * (now - mine[0]) - squeezed[i] * dt;
          atom->rmass[i] += water.density * more;
          mine[0] = now;
          for (int d = 0; d < dim; d++) mine[1 + d] = q[p][d];
        }
      },
      false);
}

/* ---------------------------------------------------------------------- */

double MPMPore::greatest_rate() const
{
  return fastest * steepest / (field.lattice.h * field.lattice.h) + exchange;
}

double MPMPore::greatest_rate(tagint &tag) const
{
  if (!wet) return 0.0;
  double most = fastest;    // formulas are evaluated in steps
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    const Soil *const s = soil(field.material_of(i));
    if (!s || s->of.law == MPMPoreSoil::FORMULA) continue;
    const double J = field.points->jacobian(i);
    const double here = mobility(*s, i, J, nullptr) / s->of.storage_at(J, water);
    if (here <= most) continue;
    most = here;
    tag = atom->tag[i];
  }
  return most * steepest / (field.lattice.h * field.lattice.h) + exchange;
}

double MPMPore::wave_speed(int i, double c) const
{
  const Soil *const s = wet ? soil(field.material_of(i)) : nullptr;
  if (!s) return c;
  const double J = field.points->jacobian(i), density = atom->rmass[i] / (J * atom->vfrac[i]);
  const double more = s->of.biot * s->of.biot / s->of.storage_at(J, water);
  return sqrt(c * c + more / (density * force->mvv2e * force->nktv2p));
}

double MPMPore::memory_usage() const
{
  double bytes = nodes.memory_usage() + surface.memory_usage();
  for (const auto *list : {&in_forces, &capacity, &conductance, &mean, &squeezed})
    bytes += list->capacity() * sizeof(double);
  return bytes;
}
