/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   A cell of a fluid has several points, each with a volume of its own, but the forces on its nodes know
   only some means of their pressure. What is not in these means stays in the points for good: nothing
   flows because of it. It comes from where the strain that the nodes can describe is not that of the
   fluid: within one or two cells of a body that deforms, which shares the functions of the nodes with the
   fluid, of a free surface, and of the walls. There it is a strain of the order of that of the body,
   whatever the node spacing is, and the pressure of a liquid is its bulk modulus times that.

   Of q = J - 1 of the points, with initial volumes V and functions N,

     S q_p = sum_i N_ip (P_i q)(x_p)

   is what the nodes see: P_i is the linear function of the place that fits q best around node i, by least
   squares with the weights N_iq V_q. S keeps constant and linear fields, also next to surfaces and walls,
   and so the pressure of a liquid at rest. V S is symmetric, and the norm of S is 1 or less, as N_ip sum
   to one: sum V q (the volume of the fluid) and sum V x q do not change, and the energy of compression
   does not grow. A wave with the wave number k loses a share of the order of (k h)^4.

   q goes towards S q by the share that the user gives in the time in which sound crosses a cell. Errors
   that keep coming, at a rate of strain e, are then of the order of e h/c: they vanish with the node
   spacing.
------------------------------------------------------------------------- */

#include "mpm_smoothing.h"

#include "atom.h"
#include "error.h"
#include "fix_mpm_material.h"
#include "force.h"
#include "material/batch.h"
#include "material/material.h"
#include "mpm_point_batches.h"
#include "mpm_point_map.h"
#include "mpm_points.h"
#include "mpm_stencil.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// mean square distance of points around a node along a direction, in node spacings squared, that allows
// for a slope; of points on a regular array it is 0.25 inside a body, and 0 of a single row of them

static constexpr double MIN_EXTENT = 1.0e-8;

/* ---------------------------------------------------------------------- */

void MPMSmoothing::init() const
{
  if (std::none_of(field.materials.begin(), field.materials.end(), [](auto *material) {
        return material->material->is_barotropic();
      }))
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm {}: smooth is for fluids whose pressure depends on their density alone, but "
        "there is none: remove it, or use a material with eos tait or linear, without strength "
        "and history variables",
        field.id());
}

/* ----------------------------------------------------------------------
   Functions 1, x, y, (z) of the fit. A node has sums over its points of their products, and then of them times
   q; in the end, the coefficients of the functions are in place of the latter
------------------------------------------------------------------------- */

template <int DIM> struct Fit {
  static constexpr int N = DIM + 1, PRODUCTS = N * (N + 1) / 2, WIDTH = PRODUCTS + N;
};

/** To the sums of a node, for a point at x, y, z from it; V: volume times weight. Written out, as it takes
 *  most of the time. */
template <int DIM> static void add(double *s, double V, double q, const double *r)
{
  const double x = r[0], y = r[1], z = r[2], Vx = V * x, Vy = V * y, Vz = V * z;
  s[0] += V;
  s[1] += Vx;
  s[2] += Vx * x;
  s[3] += Vy;
  s[4] += Vy * x;
  s[5] += Vy * y;
  if (DIM == 3) {
    s[6] += Vz;
    s[7] += Vz * x;
    s[8] += Vz * y;
    s[9] += Vz * z;
  }
  s += Fit<DIM>::PRODUCTS;
  s[0] += q * V;
  s[1] += q * Vx;
  s[2] += q * Vy;
  if (DIM == 3) s[3] += q * Vz;
}

/** Calls f(node, N, r) for the nodes of a point, with r from the node to it. */
template <int DIM, class F>
static void visit(const MPMStencil &stencil, bool domains, const Grid::Block &block, int i,
                  const F &f)
{
  if (domains) {
    stencil.visit(block, i, [&](const MPMStencil::Node &node) {
      f(node.number, node.weight, node.r);
    });
    return;
  }
  MPMStencil::Axes axes;
  stencil.find_axes(block, i, axes);
  for (int k0 = 0; k0 < axes.count[0]; k0++)
    for (int k1 = 0; k1 < axes.count[1]; k1++) {
      const double plane = axes.w[0][k0] * axes.w[1][k1];
      for (int k2 = 0; k2 < (DIM == 3 ? axes.count[2] : 1); k2++) {
        const double r[3] = {axes.r[0][k0], axes.r[1][k1], DIM == 3 ? axes.r[2][k2] : 0.0};
        f(axes.number(k0, k1, k2), DIM == 3 ? plane * axes.w[2][k2] : plane, r);
      }
    }
}

/* ----------------------------------------------------------------------
   node spacing over the speed of sound at the reference density, c^2 = -dp/dJ / density: viscosities,
   which raise wave speeds for the time step, do not count
------------------------------------------------------------------------- */

double MPMSmoothing::time_to_cross(const FixMPMMaterial &fluid) const
{
  constexpr double STRAIN = 1.0e-6;
  Batch &b = *field.batch;
  b.n = 2;
  b.history = nullptr;
  for (int p = 0; p < 2; p++) b.J[p] = p ? 1.0 + STRAIN : 1.0 - STRAIN;
  fluid.material->initial_stress(b);
  const double bulk = (b.stress[0][1] - b.stress[0][0]) / (2.0 * STRAIN);
  const double scale = force->mvv2e * force->nktv2p;    // of density velocity^2, in pressure units
  return field.lattice.h * std::sqrt(fluid.material->density() * scale / bulk);
}

/* ----------------------------------------------------------------------
   As often as sound crosses a cell, where the map of points knows their nodes: before they move. Times are
   counted from zero, so that they do not depend on when a run starts
------------------------------------------------------------------------- */

void MPMSmoothing::smooth()
{
  const double now = update->atime + (update->ntimestep - update->atimestep) * update->dt;
  for (auto *fluid : field.materials) {
    if (!fluid->material->is_barotropic()) continue;
    const double cross = time_to_cross(*fluid);
    const double times = std::floor(now / cross) - std::floor((now - field.step_dt()) / cross);
    if (!(times > 0.0)) continue;
    const double share = 1.0 - std::pow(1.0 - field.options.smooth, times);
    if (field.lattice.dim == 3) {
      fit_nodes<3>(fluid);
      change_volumes<3>(fluid, share);
    } else {
      fit_nodes<2>(fluid);
      change_volumes<2>(fluid, share);
    }
  }
}

/* ----------------------------------------------------------------------
   Value and slope of q at each node: the normal equations of the fit, solved by decomposition into L D L^T.
   A direction in which the points around have no extent gets no slope
------------------------------------------------------------------------- */

template <int DIM> void MPMSmoothing::fit_nodes(const FixMPMMaterial *fluid)
{
  constexpr int N = Fit<DIM>::N, PRODUCTS = Fit<DIM>::PRODUCTS, WIDTH = Fit<DIM>::WIDTH;
  const MPMStencil stencil(field);
  sums.assign(field.grid.nnodes() * WIDTH, 0.0);
  for (const auto &run : field.map->runs) {
    if (run.material != fluid) continue;
    for (int i = run.first; i < run.last; i++) {
      const double V = atom->vfrac[i], q = field.points->jacobian(i) - 1.0;
      visit<DIM>(stencil, field.domains != nullptr, field.grid.blocks[run.slot], i,
                 [&](int64_t node, double weight, const double *r) {
                   add<DIM>(&sums[node * WIDTH], V * weight, q, r);
                 });
    }
  }
  field.nodes.sum(sums.data(), WIDTH, 0, WIDTH);

  for (double *s = sums.data(); s < sums.data() + sums.size(); s += WIDTH) {
    if (!(s[0] > 0.0)) continue;
    double L[N][N], inverse[N];    // of D, or zero; row by row first L D, then L
    double *const y = s + PRODUCTS;
    const double least = MIN_EXTENT * s[0], *product = s;
    for (int a = 0; a < N; a++) {
      for (int b = 0; b < a; b++) {
        L[a][b] = *product++;
        for (int c = 0; c < b; c++) L[a][b] -= L[a][c] * L[b][c];
      }
      double x = *product++;
      for (int b = 0; b < a; b++) {
        const double scaled = L[a][b] * inverse[b];
        x -= L[a][b] * scaled;
        y[a] -= scaled * y[b];
        L[a][b] = scaled;
      }
      inverse[a] = a == 0 || x > least ? 1.0 / x : 0.0;
    }
    for (int a = N - 1; a >= 0; a--) {
      y[a] *= inverse[a];
      for (int c = a + 1; c < N; c++) y[a] -= L[c][a] * y[c];
    }
  }
  field.nodes.complete(sums.data(), WIDTH, WIDTH);
}

/* ----------------------------------------------------------------------
   F is scaled in the directions that are free, and the pressure follows by the equation of state;
   viscous stress stays
------------------------------------------------------------------------- */

template <int DIM> void MPMSmoothing::change_volumes(const FixMPMMaterial *fluid, double share)
{
  constexpr int PRODUCTS = Fit<DIM>::PRODUCTS, WIDTH = Fit<DIM>::WIDTH;
  const MPMStencil stencil(field);
  const Material &material = *fluid->material;
  Batch &b = *field.batch;
  for (const auto &run : field.map->runs) {
    if (run.material != fluid) continue;
    for (int start = run.first; start < run.last; start += BATCH) {
      const int n = std::min(BATCH, run.last - start);
      int list[BATCH];
      double change[BATCH], mean[BATCH];    // of J; of the Kirchhoff stress before
      for (int p = 0; p < n; p++) {
        list[p] = start + p;
        double q = 0.0;
        visit<DIM>(stencil, field.domains != nullptr, field.grid.blocks[run.slot], start + p,
                   [&](int64_t node, double weight, const double *r) {
                     const double *const fit = &sums[node * WIDTH + PRODUCTS];
                     double at = fit[0] + fit[1] * r[0] + fit[2] * r[1];
                     if (DIM == 3) at += fit[DIM] * r[2];
                     q += weight * at;
                   });
        change[p] = share * (q + 1.0 - field.points->jacobian(start + p));
      }
      load_state(field, b, list, n, fluid);
      material.initial_stress(b);
      for (int p = 0; p < n; p++) {
        mean[p] = b.J[p] * b.stress[0][p];
        if (!(std::fabs(change[p]) < b.J[p])) change[p] = 0.0;
        b.J[p] += change[p];
      }
      material.initial_stress(b);
      for (int p = 0; p < n; p++) {
        double *const tau = field.points->tau[start + p], *const F = field.points->F[start + p];
        for (int c = 0; c < 3; c++) tau[c] += b.J[p] * b.stress[0][p] - mean[p];
        const double ratio = b.J[p] / (b.J[p] - change[p]);
        const double scale = DIM == 3 ? std::cbrt(ratio) : std::sqrt(ratio);
        for (int c = 0; c < (DIM == 3 ? 9 : 5); c++) F[c] *= scale;
      }
    }
  }
}
