/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Bounds of the rates of conduction, which limit explicit steps

#include "heat/mpm_conduction.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "field/mpm_cpdi.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_passes.h"
#include "field/mpm_stencil.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

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

double MPMConduction::crossing_rate() const
{
  return slowest / (field.lattice.h * field.lattice.h);
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

bool MPMConduction::is_bounded_by_rows() const
{
  return !field.boxes && !field.domains && steepest == 0.0;
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
  for (const auto &run : field.map->runs)
    for (int i = run.first; thermal(run.material) && i < run.last; i++) {
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
    }
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

/* ---------------------------------------------------------------------- */

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
