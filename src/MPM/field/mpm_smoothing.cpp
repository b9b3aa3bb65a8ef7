/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Of q = J - 1 of the points of a fluid, with initial volumes V and functions N,
 *
 *    S q_p = sum_i N_ip (P_i q)(x_p)
 *
 *  is what the nodes see: P_i is the linear function of the place that fits q best around node i,
 *  by least squares with the weights N_iq V_q. q goes towards S q by the share that the user gives
 *  in the time in which sound crosses a cell. Why: see DECISIONS.md.
 *
 *  Nodes that a body moves, by contact or because it has points in the same field, are bound. They
 *  do not strain the liquid next to them as its pressure would. Points count in the fits by what
 *  free nodes have of them, so that the pressure at the body continues that of the liquid. */

#include "field/mpm_smoothing.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_points.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_node_action.h"
#include "field/mpm_point_map.h"
#include "field/mpm_stencil.h"
#include "field/mpm_time_limit.h"
#include "force.h"
#include "material/batch_kernels.h"
#include "material/material.h"
#include "update.h"

#include <algorithm>
#include <climits>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// mean square distance of points around a node along a direction, in node spacings squared, that
// allows for a slope; of points on a regular array it is 0.25 inside a body, and 0 of a single row
// of them
static constexpr double MIN_EXTENT = 1.0e-5;

// least weight of points in the fits: where all nodes are bound, as in a thin layer on a body,
// points count alike
static constexpr double LEAST_WEIGHT = 1.0e-3;

void MPMSmoothing::init()
{
  kernels = SmoothingKernels::select(*field.kernels, field.lattice.dim, field.options.shape);
  if (std::none_of(field.materials.begin(), field.materials.end(), [](auto *material) {
        return material->material->is_barotropic();
      }))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm {}: smooth is for fluids whose pressure depends on their density alone, "
               "but there is none: remove it, or use a material with eos tait or linear, without "
               "strength and history variables",
               field.id());
  const auto actions = find_fixes<MPMNodeAction>(lmp);
  meets_bodies = std::any_of(actions.begin(), actions.end(),
                             [this](auto *action) {
                               return action->touches(field.id());
                             }) ||
      !field.elements.empty() ||
      std::any_of(field.materials.begin(), field.materials.end(), [](auto *material) {
                   return material->material->is_solid();
                 });
  contacts.clear();
  given = 0.0;
}

/** To the sums of a node, for a point at r from it; V: volume times weight. */
template <int DIM> static void add(double *s, double V, double q, const double *r)
{
  const double x = r[0], y = r[1], z = r[2], Vx = V * x, Vy = V * y, Vz = V * z;
  s[0] += Vx;
  s[1] += Vy;
  s[2] += DIM == 3 ? Vz : 0.0;
  s[3] += V;
  s[4] += Vx * x;
  s[5] += Vy * y;
  if (DIM == 2) {
    s[6] += Vx * y;
  } else {
    s[6] += Vz * z;
    s[8] += Vx * y;
    s[9] += Vy * z;
    s[10] += Vz * x;
  }
  s += fit_place(DIM);
  s[0] += q * Vx;
  s[1] += q * Vy;
  if (DIM == 3) s[2] += q * Vz;
  s[3] += q * V;
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

/** Node spacing over the speed of sound at the reference density, c^2 = -dp/dJ / density:
 *  viscosities, which raise wave speeds for the time step, do not count. */
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

/** Adds the nodes that bodies of this field reach to those of contact. Collective. */
void MPMSmoothing::find_bound_nodes()
{
  const MPMStencil stencil(field);
  bound.assign(field.grid.nnodes(), 0.0);
  for (const int64_t node : contacts) bound[node] = 1.0;
  for (const auto &run : field.map->runs) {
    if (run.material && !run.material->material->is_solid()) continue;
    for (int i = run.first; i < run.last; i++)
      stencil.visit(field.grid.blocks[run.slot], i, [this](const MPMStencil::Node &node) {
        if (node.weight > 0.0) bound[node.number] = 1.0;
      });
  }
  field.nodes.sum(bound.data(), 1, 0, 1);
  field.nodes.complete(bound.data(), 1, 1);
}

/** Volumes of points times the share of their free nodes, [n]. */
const double *MPMSmoothing::weigh_points(const FixMPMMaterial *fluid)
{
  const MPMStencil stencil(field);
  const double *const vol0 = field.rows().vol0;
  std::vector<char> has_bound(field.grid.blocks.size());
  for (std::size_t n = 0; n < bound.size(); n++)
    if (bound[n] > 0.0) has_bound[n / NODES_PER_BLOCK] = 1;
  weights.resize(atom->nmax);
  for (const auto &run : field.map->runs) {
    if (run.material != fluid) continue;
    const auto &block = field.grid.blocks[run.slot];
    std::copy(vol0 + run.first, vol0 + run.last, weights.begin() + run.first);
    if (std::none_of(block.slot, block.slot + 27, [&](int slot) {
          return slot >= 0 && has_bound[slot];
        }))
      continue;
    for (int i = run.first; i < run.last; i++) {
      double share = 0.0;
      stencil.visit(block, i, [&](const MPMStencil::Node &node) {
        if (!(bound[node.number] > 0.0)) share += node.weight;
      });
      weights[i] *= LEAST_WEIGHT + (1.0 - LEAST_WEIGHT) * share;
    }
  }
  return weights.data();
}

/** The sums of nodes over this rank's points. */
template <int DIM> void MPMSmoothing::add_points(const FixMPMMaterial *fluid)
{
  constexpr int WIDTH = fit_width(DIM);
  const MPMStencil stencil(field);
  PointRows rows = field.rows();
  if (meets_bodies) rows.vol0 = weigh_points(fluid);
  const TransferStep step = field.step_data();
  sums.assign(field.grid.nnodes() * WIDTH, 0.0);
  q.resize(atom->nmax);
  tile.resize((std::size_t) MAX_TILE_NODES * WIDTH);    // zero again when it has been emptied
  boxes.clear();
  for (const auto &run : field.map->runs) {
    if (run.material != fluid) continue;
    const auto &block = field.grid.blocks[run.slot];
    for (int i = run.first; i < run.last; i++) {
      const double *const F = field.points->F[i];    // in a plane, no strain goes out of it
      q[i] = (DIM == 2 ? (F[0] * F[4] - F[1] * F[3]) * F[8] : field.points->jacobian(i)) - 1.0;
    }
    if (!kernels.fit) {
      for (int i = run.first; i < run.last; i++)
        visit<DIM>(stencil, field.domains != nullptr, block, i,
                   [&](int64_t node, double weight, const double *r) {
                     add<DIM>(&sums[node * WIDTH], rows.vol0[i] * weight, q[i], r);
                   });
      continue;
    }
    int base[3];
    for (int d = 0; d < 3; d++) base[d] = block.b[d] * field.grid.side - 1;
    boxes.push_back({INT_MAX, INT_MAX, INT_MAX, -1, -1, -1});
    kernels.fit(rows, q.data(), step, run.first, run.last, base, tile.data(), boxes.back().data());
    kernels.flush(tile.data(), sums.data(), block.slot, boxes.back().data());
  }
  field.nodes.sum(sums.data(), WIDTH, 0, WIDTH);
}

/** Value and slope of q at each node: the normal equations of the fit, solved by decomposition into
 *  L D L^T. A direction in which the points around have no extent gets no slope. The coefficients
 *  are in the end in the place of the sums with q. */
template <int DIM> void MPMSmoothing::fit_nodes()
{
  constexpr int N = DIM + 1, WIDTH = fit_width(DIM);
  constexpr int product[4][4] = {{3}, {0, 4}, {1, DIM == 3 ? 8 : 6, 5}, {2, 10, 9, 6}};    // places
  constexpr int place[4] = {3, 0, 1, 2};    // of the constant, x, y, z
  for (double *s = sums.data(); s < sums.data() + sums.size(); s += WIDTH) {
    if (!(s[3] > 0.0)) continue;
    double L[N][N], inverse[N];    // of D, or zero; row by row first L D, then L
    double *const fit = s + fit_place(DIM), y[4] = {fit[3], fit[0], fit[1], fit[2]};
    const double least = MIN_EXTENT * s[3];
    for (int a = 0; a < N; a++) {
      for (int b = 0; b < a; b++) {
        L[a][b] = s[product[a][b]];
        for (int c = 0; c < b; c++) L[a][b] -= L[a][c] * L[b][c];
      }
      double x = s[product[a][a]];
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
      fit[place[a]] = y[a];
    }
  }
  field.nodes.complete(sums.data(), WIDTH, WIDTH);
}

/** Sum N (fit at the point) of the points of a run. */
template <int DIM> void MPMSmoothing::evaluate_fits(const MPMPointMap::Run &run, const int *box)
{
  constexpr int WIDTH = fit_width(DIM), FIT = fit_place(DIM);
  const auto &block = field.grid.blocks[run.slot];
  if (kernels.evaluate) {
    int base[3];
    for (int d = 0; d < 3; d++) base[d] = block.b[d] * field.grid.side - 1;
    kernels.load(fits.data(), sums.data(), block.slot, box);
    kernels.evaluate(field.rows(), mean.data(), field.step_data(), run.first, run.last, base,
                     fits.data());
    return;
  }
  const MPMStencil stencil(field);
  for (int i = run.first; i < run.last; i++) {
    double sum = 0.0;
    visit<DIM>(stencil, field.domains != nullptr, block, i,
               [&](int64_t node, double weight, const double *r) {
                 const double *const fit = &sums[node * WIDTH + FIT];
                 double at = fit[3] + fit[0] * r[0] + fit[1] * r[1];
                 if (DIM == 3) at += fit[2] * r[2];
                 sum += weight * at;
               });
    mean[i] = sum;
  }
}

/** The roots, of degree DIM, of ratios near one; or of any. */
template <int DIM> static void find_scales(const double *ratio, int n, double *scale)
{
  constexpr double NEAR = 0.05;
  double most = 0.0;
  for (int p = 0; p < n; p++) most = std::max(most, std::fabs(ratio[p] - 1.0));
  if (!(most < NEAR)) {
    for (int p = 0; p < n; p++) scale[p] = DIM == 3 ? std::cbrt(ratio[p]) : std::sqrt(ratio[p]);
    return;
  }
  // a series within 1e-5, and one step of Halley, which is of third order
  for (int p = 0; p < n; p++) {
    constexpr double second = DIM == 3 ? 1.0 / 9.0 : 1.0 / 8.0;
    const double d = ratio[p] - 1.0, s = 1.0 + d * (1.0 / DIM - d * second);
    const double power = DIM == 3 ? s * s * s : s * s;
    scale[p] =
        s * ((DIM - 1) * power + (DIM + 1) * ratio[p]) / ((DIM + 1) * power + (DIM - 1) * ratio[p]);
  }
}

/** F is scaled in the directions that are free, and the pressure follows by the equation of state;
 *  viscous stress stays. */
template <int DIM> void MPMSmoothing::change_volumes(const MPMPointMap::Run &run, double share)
{
  const Material &material = *run.material->material;
  // is all stress the pressure that belongs to the volume of the point?
  const bool plain = !material.is_viscous() && !field.options.averages_stress();
  const double *const vol0 = field.rows().vol0, energy = 1.0 / force->nktv2p;
  Batch &b = *field.batch;
  for (int start = run.first; start < run.last; start += BATCH) {
    const int n = std::min(BATCH, run.last - start);
    double before[BATCH], ratio[BATCH], scale[BATCH];    // Kirchhoff stress; of J, and of lengths
    b.n = n;
    b.history = nullptr;
    if (!plain || meets_bodies) {
      for (int p = 0; p < n; p++) b.J[p] = 1.0 + q[start + p];
      material.initial_stress(b);
      for (int p = 0; p < n; p++) before[p] = b.J[p] * b.stress[0][p];
    }
    for (int p = 0; p < n; p++) {
      const double J = 1.0 + q[start + p], change = share * (mean[start + p] - q[start + p]);
      b.J[p] = std::fabs(change) < J ? J + change : J;
      ratio[p] = b.J[p] / J;
    }
    material.initial_stress(b);
    find_scales<DIM>(ratio, n, scale);
    for (int p = 0; p < n; p++) {
      double *const tau = field.points->tau[start + p], *const F = field.points->F[start + p];
      const double now = b.J[p] * b.stress[0][p];
      if (meets_bodies) {    // dW/dJ is minus the pressure
        const double J = 1.0 + q[start + p];
        given += 0.5 * energy * vol0[start + p] * (now / b.J[p] + before[p] / J) * (b.J[p] - J);
      }
      for (int c = 0; c < 3; c++) tau[c] = plain ? now : tau[c] + (now - before[p]);
      for (int c = 0; c < (DIM == 3 ? 9 : 5); c++) F[c] *= scale[p];
    }
  }
}

template <int DIM> void MPMSmoothing::smooth(const FixMPMMaterial *fluid, double share)
{
  add_points<DIM>(fluid);
  fit_nodes<DIM>();
  mean.resize(q.size());
  fits.resize((std::size_t) MAX_TILE_NODES * 4);
  auto box = boxes.begin();
  for (const auto &run : field.map->runs) {
    if (run.material != fluid) continue;
    evaluate_fits<DIM>(run, kernels.evaluate ? (box++)->data() : nullptr);
    change_volumes<DIM>(run, share);
  }
}

/** As often as sound crosses one cell or two, where the map of points knows their nodes: before
 *  they move. Times are counted from zero, so that they do not depend on when a run starts. */
void MPMSmoothing::smooth()
{
  // half as often with twice the share: errors over a few cells go as fast, at half the cost
  const int crossings = field.options.smooth > 0.5 ? 1 : 2;
  const double now = elapsed_time(*update);
  bool found = !meets_bodies;
  for (auto *fluid : field.materials) {
    if (!fluid->material->is_barotropic()) continue;
    const double cross = crossings * time_to_cross(*fluid);
    const double times = std::floor(now / cross) - std::floor((now - field.step_dt()) / cross);
    if (!(times > 0.0)) continue;
    if (!found) find_bound_nodes();
    found = true;
    field.jacobians.forget();
    const double share = 1.0 - std::pow(1.0 - crossings * field.options.smooth, times);
    if (field.lattice.dim == 3)
      smooth<3>(fluid, share);
    else
      smooth<2>(fluid, share);
  }
  contacts.clear();
}
