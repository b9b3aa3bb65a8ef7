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
#include "mpm_passes.h"
#include "mpm_points.h"
#include "mpm_stencil.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

enum { VALUE = 0, VOLUME = 1, CAPACITY = 3, OLD = 4, RATE = 4, NREAL = 8 };    // reals of a record

/** Rows of a batch of points that transfers take; kernels may read a little more. */
struct MPMConduction::Room {
  static constexpr int more = 8;
  double value[3 * BATCH + more] = {}, mass[BATCH + more] = {}, C[9 * BATCH + more] = {};
  double place[3 * BATCH + more], flux[6 * BATCH + more] = {}, force[3 * BATCH + more] = {};
  double volume[BATCH + more] = {};
};

/* ---------------------------------------------------------------------- */

MPMConduction::MPMConduction(LAMMPS *lmp, MPMField &field, const MPMHeatTransfer &transfer,
                             const MPMHeatCondition *conditions) :
    Pointers(lmp),
    field(field), faces(lmp, field, conditions), transfer(transfer)
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
  const int dim = field.lattice.dim;
  const Shape shape = field.options.shape;
  static constexpr Transfer kinds[] = {Transfer::AFLIP, Transfer::PIC, Transfer::APIC};
  pic = field.kernels->transfer(dim, shape, Transfer::PIC, true);
  with = field.kernels->transfer(dim, shape, kinds[transfer.kind], true);

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

/** Rows of points from the first on, with their values in the room. */
PointRows MPMConduction::rows(int first, Room &room) const
{
  PointRows b = rows_from(field, field.rows(), first);
  b.v = room.value;
  b.mass = room.mass;
  b.C = room.C;
  b.tau = room.flux;
  b.f = room.force;
  b.vol0 = room.volume;
  b.xnew = room.place;    // a value that is not finite moves points even in no time
  b.from = b.x;
  b.F = nullptr;
  return b;
}

/** Calls f(thermal, first, n) for batches of the points of a run, if they conduct. */
template <class F> void MPMConduction::visit(const MPMPointMap::Run &run, const F &f) const
{
  const Thermal *const t = thermal(run.material);
  for (int i = run.first; t && i < run.last; i += BATCH) f(*t, i, std::min(BATCH, run.last - i));
}

/* ----------------------------------------------------------------------
   temperatures of the nodes; the limit is the largest V k/C of this rank's points
------------------------------------------------------------------------- */

double MPMConduction::points_to_nodes(const MPMRows &gradients)
{
  const int dim = field.lattice.dim;
  const TransferStep still = field.step_data(0.0);
  double most = 0.0;
  volumes.resize(atom->nmax);
  Room room;
  points_to(records, field, with, [&](const MPMPointMap::Run &run, const int *base, int *box) {
    visit(run, [&](const Thermal &t, int first, int n) {
      for (int p = 0; p < n; p++) {
        const int i = first + p;
        const Conduction c = t.at(i);
        const double C = atom->rmass[i] * c.capacity, V = volumes[i] = volume_of(i);
        room.mass[p] = C;
        room.value[3 * p] = t.fix->history[i][t.temperature];
        room.value[3 * p + 1] = V / C;
        for (int d = 0; gradients && d < dim; d++)
          room.C[dim * dim * p + dim * d] = gradients[i][d];
        most = std::max(most, c.conductivity * V / C);
      }
      with.p2g_momentum(rows(first, room), still, 0, n, base, field.map->tile, box);
    });
  });
  field.nodes.sum(records.data(), NREAL, 0, 4);

  const std::size_t n = field.grid.nnodes();
  for (auto *list : {&capacity, &volume, &temperature, &rate}) list->resize(n);
  const double *r = records.data();
  for (std::size_t k = 0; k < n; k++, r += NREAL) {
    capacity[k] = r[CAPACITY];
    volume[k] = r[VOLUME];
    temperature[k] = r[CAPACITY] > 0.0 ? r[VALUE] / r[CAPACITY] : 0.0;
  }
  before = temperature;
  return most;
}

/* ----------------------------------------------------------------------
   the flux k grad T of a point is the first row of a stress
------------------------------------------------------------------------- */

void MPMConduction::find_rates(const double *source, Heats &power)
{
  const int dim = field.lattice.dim;
  double *r = records.data();
  for (std::size_t k = 0; k < temperature.size(); k++, r += NREAL) {
    r[VALUE] = temperature[k];
    r[RATE] = 0.0;
  }
  field.nodes.complete(records.data(), NREAL, 1);
  r = records.data();
  for (std::size_t k = 0; k < temperature.size(); k++, r += NREAL) r[RATE] = 0.0;    // of images

  TransferStep plain = field.step_data(0.0);
  plain.force_scale = plain.stress_scale = 1.0;
  MPMPointMap &map = *field.map;
  Room room;
  double L[9 * BATCH];
  for (const auto &a : map.active) {
    if (a.other_box[0] > a.other_box[3]) continue;
    const auto &block = field.grid.blocks[a.slot];
    int base[3], box[6];
    map.tile_base(a, base);
    reset_box(box);
    pic.load(map.tile_load, records.data(), block.slot, a.other_box);
    for (int k = a.first_run; k < a.last_run; k++)
      visit(map.runs[k], [&](const Thermal &t, int first, int n) {
        const PointRows b = rows(first, room);
        pic.g2p_gradient(b, plain, 0, n, base, map.tile_load, L);
        for (int p = 0; p < n; p++) {
          const double *const G = L + dim * dim * p, K = t.at(first + p).conductivity;
          double *const flux = room.flux + 6 * p;
          flux[0] = K * G[0];
          flux[3] = K * G[dim];
          if (dim == 3) flux[4] = K * G[2 * dim];
          room.volume[p] = volumes[first + p];
          if (!source) continue;
          room.force[3 * p] = room.volume[p] * source[first + p];
          power[SOURCES] += room.force[3 * p];
        }
        pic.p2g_force(b, plain, 0, n, base, map.tile, box);
      });
    pic.flush(map.tile, records.data(), block.slot, box);
  }
  field.nodes.sum(records.data(), NREAL, RATE, 1);
  r = records.data();
  for (std::size_t k = 0; k < rate.size(); k++, r += NREAL)
    rate[k] = capacity[k] > 0.0 ? r[RATE] / capacity[k] : 0.0;
}

/* ----------------------------------------------------------------------
   temperatures of points
------------------------------------------------------------------------- */

double MPMConduction::nodes_to_points(const MPMRows &gradients)
{
  const int dim = field.lattice.dim;
  double *r = records.data();
  for (std::size_t k = 0; k < temperature.size(); k++, r += NREAL) {
    r[VALUE] = temperature[k];
    r[OLD] = before[k];
  }
  field.nodes.complete(records.data(), NREAL, NREAL);
  TransferStep still = field.step_data(0.0);
  const double crossings = slowest * field.step_dt() / (field.lattice.h * field.lattice.h);
  still.flip = transfer.kind == MPMHeatTransfer::RELAX ? exp(-transfer.relax * crossings) : 0.0;
  Room room;
  double got = 0.0;
  points_from(records, field, with, [&](const MPMPointMap::Run &run, const int *base) {
    visit(run, [&](const Thermal &t, int first, int n) {
      for (int p = 0; p < n; p++) room.value[3 * p] = t.fix->history[first + p][t.temperature];
      with.g2p(rows(first, room), still, 0, n, base, field.map->tile_load, nullptr);
      for (int p = 0; p < n; p++) {
        const int i = first + p;
        const Conduction c = t.at(i);
        double *const history = t.fix->history[i], &T = history[t.temperature];
        got += atom->rmass[i] * c.capacity * (room.value[3 * p] - T);
        T = room.value[3 * p];
        if (t.molten >= 0) c.melting.settle(T, history[t.molten]);
        for (int d = 0; gradients && d < dim; d++)
          gradients[i][d] = room.C[dim * dim * p + dim * d];
      }
    });
  });
  return got;
}

/* ---------------------------------------------------------------------- */

double MPMConduction::greatest_rate(double diffusivity, double exchange)
{
  fastest = exchange;
  return diffusivity * steepest / (field.lattice.h * field.lattice.h) + fastest;
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
  double bytes = faces.memory_usage();
  for (const auto *list : {&volumes, &records, &capacity, &volume, &before, &temperature, &rate})
    bytes += list->capacity() * sizeof(double);
  return bytes;
}
