/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// First values of affine matrices are slopes of the velocities around a point, by least squares:
// with the mean at node i, <.>_i = sum_p m_p N_i(x_p) . / m_i,
//   C = [sum_i N_i m_i <(v - <v>_i) (x - <x>_i)>_i] [sum_i N_i m_i <(x - <x>_i) (x - <x>_i)>_i]^+.
// It is exact for linear fields. With zero, the first step would take a part of the energy of a
// rotation (2 % for a disk of 10 cells).

#include "field/mpm_affine.h"

#include "atom.h"
#include "base/mpm_state.h"
#include "field/mpm_every.h"
#include "field/mpm_frame.h"
#include "field/mpm_passes.h"
#include "field/mpm_plan.h"
#include "field/mpm_point_map.h"
#include "field/mpm_stencil.h"
#include "force.h"
#include "math/random.h"
#include "math_eigen.h"
#include "math_extra.h"
#include "neighbor.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// mean square distance of points around a node, in node spacings squared, that allows for a slope
static constexpr double MIN_EXTENT = 1.0e-4;

MPMAffine::MPMAffine(LAMMPS *lmp, MPMField &field, MPMPointState &state) :
    Pointers(lmp), field(field)
{
  state.declare(C, "mpm:C", size(), [this](int, double *row) {
    if (!this->field.is_running()) row[0] = NAN;    // not known, for fit()
  });
  if (field.options.polypic) state.declare(Q, "mpm:Q", poly_size(field.lattice.dim));
}

/** A number that tells whether points have other velocities than before, whatever rank has them. */
uint64_t MPMAffine::velocity_hash() const
{
  uint64_t mine = 0, all;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i) || std::isnan(C[i][0])) continue;
    uint64_t h = RANDOM_STEP;
    for (int d = 0; d < 3; d++) {
      const double v = atom->v[i][d] + 0.0;    // no negative zero
      uint64_t bits;
      memcpy(&bits, &v, sizeof(bits));
      h = mix_bits(h + bits);
    }
    mine += h;
  }
  MPI_Allreduce(&mine, &all, 1, MPI_UINT64_T, MPI_SUM, world);
  return all;
}

void MPMAffine::check_velocities()
{
  if (!velocities.known || velocity_hash() == velocities.hash) return;
  for (int i = 0; i < atom->nlocal; i++)
    if (field.is_point(i)) {
      C[i][0] = NAN;
      if (Q) memset(Q[i], 0, poly_size(field.lattice.dim) * sizeof(double));
    }
}

void MPMAffine::fit()
{
  int mine = 0, all;
  for (int i = 0; i < atom->nlocal; i++) mine |= field.is_point(i) && std::isnan(C[i][0]);
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MAX, world);
  if (!all) return;

  // at rest, or all with one velocity: spares the sums below, which are the peak of memory
  double range[6], range_all[6];    // largest velocity, and largest with the opposite sign
  for (double &r : range) r = -DBL_MAX;
  for (int i = 0; i < atom->nlocal; i++)
    for (int d = 0; d < 3 && field.is_point(i); d++) {
      range[d] = std::max(range[d], atom->v[i][d]);
      range[3 + d] = std::max(range[3 + d], -atom->v[i][d]);
    }
  MPI_Allreduce(range, range_all, 6, MPI_DOUBLE, MPI_MAX, world);
  bool uniform = true;
  for (int d = 0; d < field.lattice.dim; d++)
    uniform = uniform && range_all[d] == -range_all[3 + d];
  if (uniform) {
    for (int i = 0; i < atom->nlocal; i++)
      if (field.is_point(i) && std::isnan(C[i][0])) memset(C[i], 0, size() * sizeof(double));
    return;
  }

  field.plan->find_blocks_now();
  const MPMStencil stencil(field);
  const int dim = field.lattice.dim;
  enum { M = 0, X = 1, V = 4, VX = 7, XX = 16, NREAL = 22 };    // sums of mass times ...
  std::vector<double> sums(field.grid.nnodes() * NREAL, 0.0);

  each_point(field, [&](const MPMPointMap::Run &run, int i) {
    stencil.visit(field.grid.blocks[run.slot], i, [&](const MPMStencil::Node &node) {
      double *const s = &sums[node.number * NREAL];
      const double *const r = node.r;
      const double m = node.weight * atom->rmass[i], *v = atom->v[i];
      s[M] += m;
      for (int a = 0, k = 0; a < dim; a++) {
        s[X + a] += m * r[a];
        s[V + a] += m * v[a];
        for (int b = 0; b < dim; b++) s[VX + 3 * a + b] += m * v[a] * r[b];
        for (int b = 0; b <= a; b++) s[XX + k++] += m * r[a] * r[b];
      }
    });
  });
  field.nodes.sum(sums.data(), NREAL, 0, NREAL);
  field.nodes.complete(sums.data(), NREAL, NREAL);

  // about the means
  for (double *s = sums.data(); s < sums.data() + sums.size(); s += NREAL) {
    if (s[M] <= 0.0) continue;
    for (int a = 0, k = 0; a < dim; a++) {
      for (int b = 0; b < dim; b++) s[VX + 3 * a + b] -= s[V + a] * s[X + b] / s[M];
      for (int b = 0; b <= a; b++) s[XX + k++] -= s[X + a] * s[X + b] / s[M];
    }
  }

  for (const auto &run : field.map->runs)
    for (int i = run.first; i < run.last; i++) {
      if (!std::isnan(C[i][0])) continue;
      double mass = 0.0, vx[3][3] = {{0.0}}, xx[3][3] = {{0.0}};
      stencil.visit(field.grid.blocks[run.slot], i, [&](const MPMStencil::Node &node) {
        const double *const s = &sums[node.number * NREAL];
        const double weight = node.weight;
        mass += weight * s[M];
        for (int a = 0, k = 0; a < dim; a++) {
          for (int b = 0; b < dim; b++) vx[a][b] += weight * s[VX + 3 * a + b];
          for (int b = 0; b <= a; b++) xx[a][b] += weight * s[XX + k++];
        }
      });
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < a; b++) xx[b][a] = xx[a][b];
      double extent[3], axis[3][3];
      MathEigen::jacobi3(xx, extent, axis);
      for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) {
          double slope = 0.0;
          for (int e = 0; e < 3; e++) {    // axis[.][e]: eigenvector e
            if (!(extent[e] > MIN_EXTENT * mass)) continue;
            double along = 0.0;
            for (int c = 0; c < dim; c++) along += vx[a][c] * axis[c][e];
            slope += along * axis[b][e] / extent[e];
          }
          C[i][dim * b + a] = slope / field.lattice.h;
        }
    }
}

/** Torques that pair styles exert on points (tangential forces act on the surface of a point)
 *  change the angular momentum of its affine field, m D (C - C^T), D = h^2/4 or h^2/3; in the total
 *  frame m D (C F^T - F C^T). */
bool MPMAffine::takes_torques() const
{
  const Shape shape = field.options.shape;
  return (shape == QUADRATIC || shape == CUBIC) && atom->torque_flag;
}

void MPMAffine::add_torques()
{
  const int dim = field.lattice.dim;
  const double h = field.lattice.h;
  const double inv_moment = shape_constants[field.options.shape].inv_moment / (h * h);
  // pair styles act on atoms in neighbor lists; with every, on those of several lists
  const int end = neighbor->includegroup && !field.every ? atom->nfirst : atom->nlocal;
  for (const auto &run : field.map->runs)
    for (int i = run.first; i < std::min(run.last, end); i++) {
      const double *torque = field.every ? &field.every->mean_torque[3 * (std::size_t) i]
                                         : atom->torque[i];
      if (torque[0] == 0.0 && torque[1] == 0.0 && torque[2] == 0.0) continue;    // most points
      double W[3][3] = {{0.0}};    // what a gradient in space would change by
      const double scale = 0.5 * field.step_dt() * force->ftm2v * inv_moment / atom->rmass[i];
      for (int d = dim == 3 ? 0 : 2; d < 3; d++) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        W[f][e] = scale * torque[d];
        W[e][f] = -scale * torque[d];
      }
      if (field.frame->is_total()) {
        // the velocity C (X - X_p) is at F (X - X_p): the part of C F^T is the same as without F
        double F[3][3], inverse[3][3], G[3][3];
        field.frame->lattice_F(i, F);
        MathExtra::invert3(F, inverse);
        MathExtra::times3_transpose(W, inverse, G);
        memcpy(W, G, sizeof(W));
      }
      for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) C[i][dim * b + a] += W[a][b];
    }
}

/** What nodes get of the affine field has the angular momentum m <F r x C r> about the point, where
 *  < > are means with the shape functions N_ip over the places r of nodes from the point, and F is
 *  that of the total frame, else 1. <r r> is D in the moving least squares form; with other
 *  functions it depends on where the point is in its cell. Bilinear modes (PolyPIC) have none, as
 *  products of coordinates are orthogonal to linear functions. */
void MPMAffine::angular_momentum(int i, double L[3]) const
{
  L[0] = L[1] = L[2] = 0.0;
  if (std::isnan(C[i][0])) return;
  const int dim = field.lattice.dim;

  // the functions at the point or, of domains, at their corners
  int ncorner = 1;
  double corner[24] = {0.0}, share[8] = {1.0}, size[3];
  if (field.domains) {
    ncorner = 1 << dim;
    std::fill(share, share + ncorner, 1.0 / ncorner);
    if (!field.domains->corners || std::isnan(field.domains->corners[i][0])) {
      field.domains->corners_of_box(i, corner);
    } else {
      field.domains->corners_of(i, corner, share);
    }
  }
  if (field.boxes) field.boxes->size_of(i, size);
  const MPMStencil stencil(field);
  double rr[3][3] = {{0.0}};
  for (int c = 0; c < ncorner; c++) {
    double first_moment[3] = {0.0}, second_moment[3] = {0.0};
    for (int d = 0; d < dim; d++) {
      const double at = (field.frame->places()[i][d] - field.lattice.origin[d]) / field.lattice.h;
      const double t = at + corner[dim * c + d] / field.lattice.h;
      int node;
      double w[4];
      const int n = stencil.weights(t, node, w);
      if (field.boxes) Gimp::weights(t - Gimp::shift - node, size[d], w);
      for (int k = 0; k < n; k++) {
        const double r = node + k - at;
        first_moment[d] += w[k] * r;
        second_moment[d] += w[k] * r * r;
      }
    }
    for (int a = 0; a < dim; a++)
      for (int b = 0; b < dim; b++)
        rr[a][b] += share[c] * (a == b ? second_moment[a] : first_moment[a] * first_moment[b]);
  }

  double F[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}, moment[3][3] = {{0.0}};
  if (field.frame->is_total()) field.frame->lattice_F(i, F);
  for (int e = 0; e < dim; e++)
    for (int f = 0; f < dim; f++)
      for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) moment[e][f] += F[e][a] * rr[a][b] * C[i][dim * b + f];
  const double scale = atom->rmass[i] * field.lattice.h * field.lattice.h;
  for (int d = dim == 3 ? 0 : 2; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    L[d] = scale * (moment[e][f] - moment[f][e]);
  }
}
