/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Conductivities of points: in layers, at temperatures where they jump, and along axes that turn
// with the material

#include "heat/mpm_conduction.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "error.h"
#include "field/mpm_cpdi.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_passes.h"
#include "field/mpm_stencil.h"
#include "material/material.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// half of the range over which a conductivity that jumps at melting is averaged, in node spacings
static constexpr double HALF_RANGE = 0.25;
// ratio of conductivities for which means across interfaces matter little
static constexpr double SAME = 2.0;

/** Materials of different conductivity in one field get means next to their interfaces, if
 *  conductivities are numbers and functions are smooth. */
void MPMConduction::init_layers()
{
  layers.reset();
  greatest = 0.0;
  const bool can = !total && steepest != 0.0;
  bool differ = false, orthotropic = false;
  double fastest = 0.0, least = 0.0;
  const Thermal *first = nullptr;
  for (const auto &t : thermals) {
    if (!is_present(t)) continue;
    orthotropic = orthotropic || t.all.orthotropic;
    if (!first)
      first = &t;
    else
      differ = differ || t.varies || first->varies || t.all.orthotropic != first->all.orthotropic ||
          t.all.conductivity != first->all.conductivity;
    const double capacity = t.fix->material->density() * t.all.capacity;
    greatest = std::max(greatest, t.all.conductivity);
    least = &t == first ? t.all.conductivity : std::min(least, t.all.conductivity);
    fastest = std::max(fastest, t.all.conductivity / capacity);
  }
  if (!can && differ && greatest > SAME * least && !*warned) {
    *warned = true;
    if (comm->me == 0)
      error->warning(
          FLERR,
          "Fix mpm/heat: conductivities of materials in fix mpm {} are {:.3g} to {:.3g}, "
          "and with {} there are no means across their interfaces, through which too "
          "much heat goes{}: use shape quadratic or cubic{}",
          field.id(), least, greatest, total ? "frame total" : "this shape",
          steepest == 0.0 ? " unless they are in planes of nodes" : "",
          total ? " with frame updated" : "");
  }
  if (!can) {
    greatest = 0.0;
    return;
  }
  if (orthotropic && differ && !*warned) {
    *warned = true;
    if (comm->me == 0)
      error->warning(FLERR,
                     "Fix mpm/heat: materials of different conductivity share fix mpm {}, and one "
                     "of them is orthotropic: there are no means across their interfaces, and with "
                     "few cells too little or too much heat goes through",
                     field.id());
  }
  if (orthotropic) return;
  if (!differ) return;
  const bool along = greatest <= MPMLayerMean::MOST * fastest * least_capacity;
  layers = std::make_unique<MPMLayerMean>(field, along);
  layers->init();
}

/** As Thermal::at(), with the mean of conductivities that jump. */
const Conduction &MPMConduction::conduction_of(const Thermal &t, int i, Conduction &buffer) const
{
  if (!t.jumps || ranges.empty()) return t.at(i, buffer);
  return buffer =
             mean_conduction(*t.fix->material, t.fix->history[i], ranges[i].low, ranges[i].high);
}

/** Finds the ranges of the means of conductivities that jump, from the temperatures of nodes.
 *  Raises the rate of the fastest point by these means. */
void MPMConduction::find_ranges()
{
  if (std::none_of(thermals.begin(), thermals.end(), [](const Thermal &t) {
        return t.jumps;
      }))
    return;
  ranges.resize(atom->nmax);
  const int dim = field.lattice.dim;
  const double half = HALF_RANGE * field.lattice.h;
  scalar.gradients_to_points(
      [&](const MPMPointMap::Run &run, int first, int n, MPMNodeScalar::Rows q) {
        const Thermal &t = *thermal(run.material);
        for (int p = 0; t.jumps && p < n; p++) {
          double reach = 0.0;
          for (int d = 0; d < dim; d++) reach = std::max(reach, half * fabs(q[p][d]));
          ranges[first + p] = {q[p][3] - reach, q[p][3] + reach};
        }
      });
  each_point(field, [&](const auto &run, int i) {
    const Thermal *const t = thermal(run.material);
    if (!t || !t->jumps) return;
    Conduction buffer;
    const double own = t->at(i, buffer).most(), mean = conduction_of(*t, i, buffer).most();
    if (!(mean > own)) return;
    const double here = simple ? mean * volumes[i] / (atom->rmass[i] * buffer.capacity)
                               : bound(*t, i, volumes[i]);
    const double layer = layers ? layers->most(i) / own : 1.0;
    fastest_point = std::max(fastest_point, layer * here);
  });
}

/** Conductivity of a point for gradients on the lattice. Total frame: V k becomes V F^-1 k F^-T. */
void MPMConduction::tensor(const Thermal &t, int i, double k[3][3]) const
{
  Conduction buffer;
  const Conduction &c = conduction_of(t, i, buffer);
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) k[a][b] = a == b ? c.conductivity : 0.0;
  if (c.orthotropic) {
    double along[3], n[3][3];
    principal_conductivities(c, field.points->F[i], along, n);
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++)
        k[a][b] = along[0] * n[0][a] * n[0][b] + along[1] * n[1][a] * n[1][b] +
            along[2] * n[2][a] * n[2][b];
  }
  if (!total) return;
  double F[3][3], inverse[3][3], half[3][3];
  field.frame->lattice_F(i, F);
  MathExtra::invert3(F, inverse);
  MathExtra::times3(inverse, k, half);
  MathExtra::times3_transpose(half, inverse, k);
}

// Bounds of the rates of conduction, which limit explicit steps

// greatest rate of nodes that points barely reach, over the bound of rates inside of a body
static constexpr double MOST_AT_LIGHT_NODES = 4.0;
// Bernstein polynomials: points with less than this share of their conductivity left do not conduct
static constexpr double TOO_LITTLE = 0.7;
// nodes that have less than this share of the conduction around them get no heat through surfaces
static constexpr double LEAST_LEFT = 0.25;
// distance from a side of cells, in cells, within which a point is on both sides
static constexpr double ON_SIDE = 1.0e-9;

/** Upper bound of the greatest eigenvalue of a symmetric matrix: the greatest sum of absolute
 *  values of a row. */
static double greatest_row(int dim, const double k[3][3])
{
  double most = 0.0;
  for (int a = 0; a < dim; a++) {
    double row = 0.0;
    for (int b = 0; b < dim; b++) row += fabs(k[a][b]);
    most = std::max(most, row);
  }
  return most;
}

/** Bound of sum_i grad N grad N^T/N of a point [1/area]; 0 if there is none. */
double MPMConduction::steepness(int i) const
{
  const double h = field.lattice.h;
  const int dim = field.lattice.dim;
  if (field.boxes) {
    double size[3], least = 0.5;
    field.boxes->size_of(i, size);
    for (int d = 0; d < dim; d++) least = std::min(least, size[d]);
    return (2.0 / least + 1.0 / (1.0 - least)) / (h * h);
  }
  if (!field.domains) return steepest;
  double x[24], w[8], g[24], sum[3][3] = {};
  field.domains->corners_of(i, x, w, g);
  for (int c = 0; c < 1 << dim; c++)
    for (int a = 0; a < dim; a++)
      for (int b = 0; b < dim; b++) sum[a][b] += g[dim * c + a] * g[dim * c + b] / w[c];
  return greatest_row(dim, sum);
}

/** Bound of the rate of a point with this volume, or its largest diffusivity for functions that
 *  points do not bound. */
double MPMConduction::bound(const Thermal &t, int i, double volume) const
{
  Conduction buffer;
  const Conduction &c = conduction_of(t, i, buffer);
  double most = c.most();
  if (total) {
    double k[3][3];
    tensor(t, i, k);
    most = greatest_row(field.lattice.dim, k);
  }
  const double steep = steepness(i);
  return most * volume / (atom->rmass[i] * c.capacity) * (steep > 0.0 ? steep : 1.0);
}

/** Adds the rows of the matrix of rates, for functions that points alone do not bound. */
void MPMConduction::add_rows(Left left)
{
  scalar.add_rows([&](const MPMPointMap::Run &run, int first, int n, MPMNodeScalar::Rows q) {
    const Thermal *const t = thermal(run.material);
    for (int p = 0; p < n; p++) {
      double k[3][3];
      tensor(*t, first + p, k);
      double V = volumes[first + p];
      if (cuts.any() && cuts.is_cut[first + p]) V = 0.0;
      if (left == AS_SHARES) V *= shares[first + p];
      for (int a = 0; a < 3; a++) q[p][a] = V * (fabs(k[a][0]) + fabs(k[a][1]) + fabs(k[a][2]));
    }
  });
  for (const auto &part : cuts.parts) {
    double k[3][3];
    tensor(*thermal(field.material_of(part.point)), part.point, k);
    const double times = 2.0 / field.lattice.h * part.volume * volumes[part.point] *
        (left == AS_SHARES ? part.share : 1.0);
    cuts.each_node(part, [&](int node, const double *slope) {
      for (int a = 0; a < 3; a++)
        rate[node] += times * fabs(slope[a]) * (fabs(k[a][0]) + fabs(k[a][1]) + fabs(k[a][2]));
    });
  }
}

/** Reduces the conduction of points at nodes with a much greater rate than inside of a body, which
 *  have next to no capacity. */
double MPMConduction::bound_by_rows(double greatest_of_rank)
{
  const double usual = 4.0 * field.lattice.dim / (field.lattice.h * field.lattice.h);
  double mine[2] = {usual * fastest_point, greatest_of_rank}, all[2];
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_MAX, world);
  shares.clear();
  idle.clear();
  usual_rate = all[0];
  if (cuts.any()) {
    shares.assign(atom->nmax, 1.0);
    for (const auto &part : cuts.parts) shares[part.point] = 0.0;
  }
  const double limit = MOST_AT_LIGHT_NODES * all[0];
  if (all[1] <= limit) return mine[1];

  field.nodes.complete(rate.data(), 1, 1);
  shares.resize(atom->nmax, 1.0);
  if (looks_beyond_points()) {
    idle.resize(rate.size());
    for (std::size_t k = 0; k < rate.size(); k++) idle[k] = rate[k] * TOO_LITTLE > limit;
  }
  for (auto &part : cuts.parts)
    for (int k = 0; k < (field.lattice.dim == 3 ? 27 : 9); k++)
      if (is_idle(part.node[k]))
        part.share = 0.0;
      else if (part.share * rate[part.node[k]] > limit)
        part.share = limit / rate[part.node[k]];
  MPMStencil stencil(field);
  const double width = shape_constants[field.options.shape].cell, h = field.lattice.h;
  const int dim = field.lattice.dim;
  each_point(field, [&](const auto &run, int i) {
    if (!thermal(run.material)) return;
    // on a side of cells, round-off decides in which of them the kernels see the point
    const double *const place = field.frame->places()[i];
    bool on_side[3] = {false, false, false};
    for (int d = 0; d < dim; d++) {
      const double cells = (place[d] - field.lattice.origin[d]) / (width * h);
      on_side[d] = std::fabs(cells - std::round(cells)) < ON_SIDE;
    }
    for (int k = 0; k < 1 << dim; k++) {
      double x[3] = {place[0], place[1], place[2]};
      bool again = false;
      for (int d = 0; d < dim; d++) {
        if (on_side[d]) x[d] += (k >> d & 1 ? 2.0 : -2.0) * ON_SIDE * width * h;
        again = again || (!on_side[d] && (k >> d & 1));
      }
      if (again) continue;
      stencil.visit_around(x, [&](int64_t node, double, const double *) {
        if (is_idle(node))
          shares[i] = 0.0;
        else if (shares[i] * rate[node] > limit)
          shares[i] = limit / rate[node];
      });
    }
  });
  if (looks_beyond_points()) {
    const std::vector<double> whole = rate;
    add_rows(AS_SHARES);
    scalar.greatest_row();
    field.nodes.complete(rate.data(), 1, 1);
    for (std::size_t k = 0; k < rate.size(); k++)
      if (rate[k] < LEAST_LEFT * whole[k]) idle[k] = 1;
  }
  return limit;
}

/** Greatest of all conductivities, including those that points have at present by their temperature
 *  or a random field. */
double MPMConduction::greatest_possible() const
{
  if (std::none_of(thermals.begin(), thermals.end(), [this](const Thermal &t) {
        return t.varies && is_present(t);
      }))
    return greatest;
  double mine = greatest, all;
  Conduction buffer;
  for (int i = 0; i < atom->nlocal; i++)
    if (const Thermal *const t = field.is_point(i) ? thermal(field.material_of(i)) : nullptr)
      mine = std::max(mine, t->at(i, buffer).conductivity);
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_MAX, world);
  return all;
}

/** Points with domains have the bound of the last step and, before the first step, that inside of
 *  an undeformed body. Functions that points alone do not bound have the rate of light nodes, which
 *  appear as soon as a point comes to another cell. */
double MPMConduction::greatest_rate_of_points(tagint &tag) const
{
  if (!active) return 0.0;
  const double h = field.lattice.h;
  const int dim = field.lattice.dim;
  const bool bounded = steepest > 0.0 || field.boxes;
  double most = 0.0;
  const double possible = layers ? greatest_possible() : 0.0;
  Conduction buffer;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    const Thermal *const t = thermal(field.material_of(i));
    if (!t) continue;
    double here = 0.0;
    if (bounded) {
      here = bound(*t, i, volume_of(i));
      // at interfaces what is possible counts, not what is there at
      // present, so that it is the same after a restart
      if (layers) here *= layers->most_over_own(possible / t->at(i, buffer).conductivity);
    } else if (!field.domains || conducted == 0.0) {
      double k[3][3], x[24], least = 1.0;
      tensor(*t, i, k);
      if (field.domains) field.domains->corners_of_box(i, x);
      for (int d = 0; field.domains && d < dim; d++)
        for (int c = 0; c < 1 << dim; c++) least = std::min(least, fabs(x[dim * c + d]) / h);
      const double steep = field.domains ? 1.0 / (least * least) : MOST_AT_LIGHT_NODES * 4.0 * dim;
      here = steep / (h * h) * greatest_row(dim, k) * volume_of(i) /
          (atom->rmass[i] * t->at(i, buffer).capacity);
    }
    if (here <= most) continue;
    most = here;
    tag = atom->tag[i];
  }
  return field.domains && conducted > 0.0 ? conducted : most;
}
