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

/** Functions 1, x, y, (z) of the fit, their products, and what is fitted. */
static int products(int n)
{
  return n * (n + 1) / 2;
}

int MPMSmoothing::width() const
{
  const int n = field.lattice.dim + 1;
  return products(n) + n;
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
   Times are counted from zero, so that they do not depend on when a run starts
------------------------------------------------------------------------- */

void MPMSmoothing::smooth()
{
  const double now = update->atime + (update->ntimestep - update->atimestep) * update->dt;
  for (auto *fluid : field.materials) {
    if (!fluid->material->is_barotropic()) continue;
    const double cross = time_to_cross(*fluid);
    const double times = std::floor(now / cross) - std::floor((now - field.step_dt()) / cross);
    if (!(times > 0.0)) continue;
    fit_nodes(fluid);
    change_volumes(fluid, 1.0 - std::pow(1.0 - field.options.smooth, times));
  }
}

/* ----------------------------------------------------------------------
   Value and slope of q at each node: the normal equations of the fit, solved by Cholesky's method. A
   direction in which the points around have no extent gets no slope
------------------------------------------------------------------------- */

void MPMSmoothing::fit_nodes(const FixMPMMaterial *fluid)
{
  const int n = field.lattice.dim + 1, first = products(n), width = this->width();
  const MPMStencil stencil(field);
  sums.assign(field.grid.nnodes() * width, 0.0);
  for (const auto &run : field.map->runs) {
    if (run.material != fluid) continue;
    for (int i = run.first; i < run.last; i++) {
      const double V = atom->vfrac[i], q = field.points->jacobian(i) - 1.0;
      stencil.visit(field.grid.blocks[run.slot], i, [&](const MPMStencil::Node &node) {
        double *s = &sums[node.number * width];
        const double f[4] = {1.0, node.r[0], node.r[1], node.r[2]};
        for (int a = 0; a < n; a++) {
          const double w = node.weight * V * f[a];
          for (int b = 0; b <= a; b++) *s++ += w * f[b];
        }
        for (int a = 0; a < n; a++) *s++ += node.weight * V * f[a] * q;
      });
    }
  }
  field.nodes.sum(sums.data(), width, 0, width);

  for (double *s = sums.data(); s < sums.data() + sums.size(); s += width) {
    if (!(s[0] > 0.0)) continue;
    double L[4][4] = {{0.0}}, y[4];    // diagonal elements: their inverse, or zero
    const double *product = s;
    for (int a = 0; a < n; a++)
      for (int b = 0; b <= a; b++) {
        double x = *product++;
        for (int c = 0; c < b; c++) x -= L[a][c] * L[b][c];
        if (b < a)
          L[a][b] = x * L[b][b];
        else
          L[a][a] = a == 0 || x > MIN_EXTENT * s[0] ? 1.0 / std::sqrt(x) : 0.0;
      }
    double *const value = s + first;
    for (int a = 0; a < n; a++) {
      y[a] = value[a];
      for (int c = 0; c < a; c++) y[a] -= L[a][c] * y[c];
      y[a] *= L[a][a];
    }
    for (int a = n - 1; a >= 0; a--) {
      value[a] = y[a];
      for (int c = a + 1; c < n; c++) value[a] -= L[c][a] * value[c];
      value[a] *= L[a][a];
    }
  }
  field.nodes.complete(sums.data(), width, width);
}

/* ----------------------------------------------------------------------
   F is scaled in the directions that are free, and the pressure follows by the equation of state;
   viscous stress stays
------------------------------------------------------------------------- */

void MPMSmoothing::change_volumes(const FixMPMMaterial *fluid, double share)
{
  const int dim = field.lattice.dim, first = products(dim + 1), width = this->width();
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
        stencil.visit(field.grid.blocks[run.slot], start + p, [&](const MPMStencil::Node &node) {
          const double *const fit = &sums[node.number * width + first];
          double at = fit[0];
          for (int d = 0; d < dim; d++) at += fit[1 + d] * node.r[d];
          q += node.weight * at;
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
        const double scale = dim == 3 ? std::cbrt(ratio) : std::sqrt(ratio);
        for (int c = 0; c < (dim == 3 ? 9 : 5); c++) F[c] *= scale;
      }
    }
  }
}
