/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "elements/element_forces.h"

#include "atom.h"
#include "base/mpm_image.h"
#include "base/mpm_points.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_time_limit.h"
#include "force.h"
#include "law/axes.h"
#include "material/batch_kernels.h"
#include "material/material.h"
#include "math/matrix.h"
#include "math_extra.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// axes must have at least this part of their length along an element
static constexpr double LEAST_AXIS = 0.1;

/** The kernels of three dimensions serve two as well. */
static const BatchKernels &kernels()
{
  static const BatchKernels &all = *BatchKernels::select(3);
  return all;
}

ElementForces::ElementForces(LAMMPS *lmp, const std::string &id, const MPMElementsOptions &given,
                             ElementBody &body) :
    Pointers(lmp),
    MPMElementsOptions(given), id(id), dim(body.dim), body(body)
{
  batch.history.resize((std::size_t) std::max(1, body.nhistory) * BATCH);
  if (thin) batch.thin.resize(BATCH);
}

void ElementForces::define(FixMPMMaterial *of_nodes)
{
  material = of_nodes;
  if (material->material->is_of_surfaces() && !(thin && body.along == 2))
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/elements {}: the law of fix mpm/material {} bears nothing across a surface, "
        "and is for surfaces in 3d only: use thickness and axes",
        id, material->id);
  if (!thin) return;
  try {
    plane_stress.reset(
        new PlaneStress(*material->material, dim, body.along, compression, has_axes));
    if (bending) {
      const auto [E, ratio] = plane_stress->elastic_constants();
      const double t = thin.across();
      body.stiffness = body.along == dim - 1 ? E * t * t * t / (12.0 * (1.0 - ratio * ratio))
                                             : E * t * t / (4.0 * M_PI);
      body.nu = ratio;
    }
  } catch (const std::runtime_error &e) {
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/elements {}: the material of fix mpm/material {} cannot be that of {}: {}{}", id,
        material->id,
        bending           ? "what resists bending"
            : compression ? "surfaces or lines"
                          : "what does not resist compression",
        e.what(),
        body.along == 2 && !has_axes && !bending && compression
            ? ", or have its axes along the surface: use the keyword axes"
            : "");
  }
}

/** Gradients of the functions in the reference configuration; returns the volume of the point. */
double ElementForces::gradients(const ElementRule &rule, int q, const double (*x)[3],
                                double (*g)[3]) const
{
  return thin ? thin.across() * rule.gradients_along(q, x, g) : rule.gradients(q, x, g);
}

/** Checks that no axis is almost normal to an element, where it would have no direction. */
void ElementForces::check_frame(const double (*frame)[3], bigint label) const
{
  double normal[3], size[3];
  for (int k = 0; k < 2; k++) size[k] = sqrt(dot(axes + 3 * k, axes + 3 * k));
  cross(axes, axes + 3, normal);
  size[2] = sqrt(dot(normal, normal));
  if (!(fabs(dot(frame[0], axes)) > LEAST_AXIS * size[0]) ||
      !(fabs(dot(frame[2], normal)) > LEAST_AXIS * size[2]))
    error->one(FLERR,
               "Fix mpm/elements {}: the axes are all but normal to element {} of the mesh, which "
               "gives them no direction there: give this part of the surface a mesh, or a part, of "
               "its own, with other axes",
               id, label);
}

void ElementForces::make_row(double *r, const MeshElement &element, const double *x, tagint low,
                             bigint &rough)
{
  const double *const origin = x + 3 * (std::size_t) element.node[0];
  r[0] = (double) element.label;
  r[1] = (double) static_cast<int>(element.type);
  const bool bends = body.bends(r);
  double X[PATCH_NODES][3];
  for (int m = 0; m < body.rule_of(r).nnode; m++) {
    MathExtra::sub3(x + 3 * (std::size_t) element.node[m], origin, X[m]);
    nearest_image(*domain, X[m]);
    r[2 + m] = (double) (low + element.node[m]);
    for (int d = 0; d < dim && !bends; d++) r[2 + body.maxnode + m * dim + d] = X[m][d];
  }
  if (!bends) return define_points(r, X, origin);
  if (!body.define_bending(r, X, element.inside, rough))
    error->one(FLERR,
               "Fix mpm/elements {}: element {} of the mesh and the next one make an angle: "
               "bending is for lines that are straight when this fix is defined",
               id, (bigint) r[0]);
}

void ElementForces::define_points(double *r, const double (*X)[3], const double *first)
{
  const auto &rule = body.rule_of(r);
  double frequency = 0.0, size = 0.0;
  for (int q = 0; q < rule.npoint; q++) {
    double g[MAX_ELEMENT_NODES][3], frame[3][3];
    const double w = gradients(rule, q, X, g);
    if (has_axes) {
      find_frame(g, frame);
      check_frame(frame, (bigint) r[0]);
    }
    if (!(w > 0.0))
      error->one(FLERR, "Fix mpm/elements {}: element {} of the mesh is inverted", id,
                 (bigint) r[0]);
    frequency += w * rule.nnode * rule.largest_eigenvalue(g);
    size += w;
    double at[3], *const s = body.state_of(r, q);
    for (int d = 0; d < 3; d++) {
      at[d] = first[d];
      for (int m = 0; m < rule.nnode; m++) at[d] += rule.N[q][m] * X[m][d];
    }
    s[0] = s[4] = s[8] = 1.0;
    if (thin) find_motion(X, g, rule.nnode, body.motion_of(s));
    if (body.nhistory) material->material->initialize(at, s + 15);
  }
  volume += size;
  shortest = std::min(shortest, 2.0 * sqrt(size / frequency));
}

void ElementForces::set_initial_stress()
{
  for_batches(false, [&](ElementBatch &w) {
    material->material->initial_stress(w.batch);
    for (int p = 0; p < w.n; p++)
      for (int c = 0; c < 6; c++) w.state[p][9 + c] = w.batch.stress[c][p];
  });
}

/** Visits all elements, as many at a time as fit into a batch. */
void ElementForces::for_batches(bool moved, const std::function<void(ElementBatch &)> &visit)
{
  ElementBatch &w = batch;
  const auto flush = [&]() {
    if (w.n == 0) return;
    w.batch.n = w.n;
    w.batch.dt = update->dt;
    w.batch.h = shortest;
    w.batch.time = elapsed_time(*update);
    w.batch.history = reinterpret_cast<double(*)[BATCH]>(w.history.data());
    visit(w);
    w.n = 0;
    w.elements.clear();
  };
  w.n = 0;
  w.elements.clear();
  for (std::size_t e = 0; e < body.size(); e++) {
    if (body.bends(body.row(e))) continue;
    if (w.n + body.rule_of(body.row(e)).npoint > BATCH) flush();
    load(w, e, moved);
  }
  flush();
}

/** Kinematics of an element: F = sum_k x_k grad_0 N_k, or the stored F if the element has not
 *  moved. F-bar (E.A. de Souza Neto et al., Int. J. Solids Struct. 33 (1996) 3277) replaces the J
 *  of each point by the mean of J over the element, in 2d by scaling the plane. */
void ElementForces::load(ElementBatch &w, std::size_t e, bool moved) const
{
  double *const r = body.row(e);
  const auto &rule = body.rule_of(r);
  double X[MAX_ELEMENT_NODES][3], x[MAX_ELEMENT_NODES][3];
  for (int m = 0; m < rule.nnode; m++) {
    X[m][2] = 0.0;
    for (int d = 0; d < dim; d++) X[m][d] = r[2 + body.maxnode + m * dim + d];
    if (moved) MathExtra::sub3(atom->x[body.nodes[e][m]], atom->x[body.nodes[e][0]], x[m]);
    for (int d = 0; d < dim && trial; d++) {
      x[m][d] += trial->motion[3 * (std::size_t) body.nodes[e][m] + d] -
          trial->motion[3 * (std::size_t) body.nodes[e][0] + d];
      if (m == trial->shifted_node) x[m][d] += trial->shift[d];
    }
  }

  double F[MAX_ELEMENT_POINTS][9], mean = 0.0, size = 0.0;
  w.elements.push_back({e, r, rule, w.n});
  for (int q = 0; q < rule.npoint; q++) {
    const int p = w.n + q;
    double g[MAX_ELEMENT_NODES][3];
    w.state[p] = body.state_of(r, q);
    w.volume[p] = body.swell_of(r) * gradients(rule, q, X, g);
    double *const f = F[q];
    if (thin && moved) {
      load_thin(w.thin[p], x, g, rule.nnode, w.state[p]);
      memcpy(w.g[p], g, sizeof(g));
      continue;
    }
    if (moved) {
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
          f[3 * a + b] = a == b && a >= dim ? 1.0 : 0.0;
          for (int m = 0; m < rule.nnode && a < dim && b < dim; m++)
            f[3 * a + b] += x[m][a] * g[m][b];
        }
    } else {
      memcpy(f, w.state[p], 9 * sizeof(double));
    }
    const double J = w.J[p] = MPMPoints::det(f);
    if (!(J > 0.0) && trial)
      trial->good = false;
    else if (!(J > 0.0))
      error->one(FLERR,
                 "Fix mpm/elements {}: element {} of the mesh has a deformation gradient of "
                 "determinant {} at step {}: use a smaller time step, a finer mesh, or elements of "
                 "better shape",
                 id, (bigint) r[0], J, update->ntimestep);
    mean += w.volume[p] * J;
    size += w.volume[p];
    const double inv = 1.0 / J;
    double inverse[9] = MPM_COFACTORS(f);    // transposed
    for (double &a : inverse) a *= inv;
    for (int m = 0; m < rule.nnode; m++)
      for (int a = 0; a < 3; a++) w.g[p][m][a] = dot(g[m], inverse + 3 * a);
  }

  Batch &b = w.batch;
  for (int q = 0; q < rule.npoint; q++) {
    const int p = w.n + q;
    double *const f = F[q];
    const double *const s = w.state[p];
    if (thin && moved) {    // find_stretches() completes it
      const double inv = 1.0 / MPMPoints::det(s);
      for (int c = 0; c < 6; c++) b.stress[c][p] = inv * s[9 + c];
      b.vol0[p] = w.volume[p];
      for (int k = 0; k < body.nhistory; k++) w.history[k * BATCH + p] = s[15 + k];
      continue;
    }
    b.J[p] = w.J[p];
    if (fbar && moved && rule.npoint > 1) {
      const double J = mean / size, scale = dim == 2 ? sqrt(J / w.J[p]) : cbrt(J / w.J[p]);
      for (int c = 0; c < (dim == 3 ? 9 : 5); c++) f[c] *= scale;
      b.J[p] = J;
    }
    const double Jold = MPMPoints::det(s), inv = 1.0 / Jold;
    b.Jold[p] = Jold;
    PlaneStress::Point point;
    if (has_axes) {
      double g[MAX_ELEMENT_NODES][3];
      gradients(rule, q, X, g);
      find_frame(g, point.frame);
    }
    double inverse[9] = MPM_COFACTORS(s), change[9];
    for (double &a : inverse) a *= inv;
    for (int c = 0; c < 9; c++) change[c] = f[c] - s[c];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) b.A[3 * i + j][p] = dot(change + 3 * i, inverse + 3 * j);
    if (has_axes) plane_stress->turn_to_material(point, f);
    for (int c = 0; c < 9; c++) b.F[c][p] = f[c];
    for (int c = 0; c < 6; c++) b.stress[c][p] = inv * s[9 + c];
    b.vol0[p] = w.volume[p];
    for (int k = 0; k < body.nhistory; k++) w.history[k * BATCH + p] = s[15 + k];
  }
  w.n += rule.npoint;
}

/** Finds axes for the motion along a surface or a line: those of the material, projected on the
 *  surface, if it has any. */
void ElementForces::find_frame(const double (*g)[3], double (*frame)[3]) const
{
  if (!has_axes) return plane_stress->make_frame(g[1], g[body.along], frame);
  double normal[3], flat[2][3];
  cross(g[1], g[2], normal);
  const double inv = 1.0 / dot(normal, normal);
  for (int k = 0; k < 2; k++) {
    const double part = inv * dot(normal, axes + 3 * k);
    for (int d = 0; d < 3; d++) flat[k][d] = axes[3 * k + d] - part * normal[d];
  }
  plane_stress->make_frame(flat[0], flat[1], frame);
}

/** Sets the motion along a surface or a line. */
void ElementForces::load_thin(PlaneStress::Point &point, const double (*x)[3], const double (*g)[3],
                              int nnode, const double *state) const
{
  find_frame(g, point.frame);
  find_motion(x, g, nnode, point.along);
  point.old = state;
}

/** Sets to = sum_k x_k grad N_k. */
void ElementForces::find_motion(const double (*x)[3], const double (*g)[3], int nnode,
                                double *to) const
{
  std::fill_n(to, 9, 0.0);
  for (int m = 0; m < nnode; m++)
    for (int a = 0; a < dim; a++)
      for (int b = 0; b < dim; b++) to[3 * a + b] += x[m][a] * g[m][b];
}

/** Finds stress and deformation gradient of surfaces and lines. */
void ElementForces::find_stretches(ElementBatch &w)
{
  const int bad = plane_stress->update(w.batch, w.thin.data(), [this](Batch &b) {
    material->update_batch(b, kernels());
  });
  if (trial && bad >= 0) trial->good = false;
  for (const auto &[number, row, rule, start] : w.elements)
    if (!trial && bad >= start && bad < start + rule.npoint)
      error->one(
          FLERR,
          "Fix mpm/elements {}: no state without stress across element {} was found at step {}: "
          "use a smaller time step, a finer mesh, or a law such as neohookean (stvenant/kirchhoff "
          "gives way at large strains)",
          id, (bigint) row[0], update->ntimestep);
}

/** Stress and history of the points in the batch. At the start of a run, nothing has moved since
 *  the last evaluation of the stress, unless a command has moved points. */
void ElementForces::find_stress(ElementBatch &w, bool starting)
{
  Batch &b = w.batch;
  if (starting) {
    double largest = 0.0;
    for (int c = 0; c < 9; c++)
      for (int p = 0; p < w.n; p++)
        largest = std::max(
            largest, fabs(thin ? w.thin[p].along[c] - body.motion_of(w.state[p])[c] : b.A[c][p]));
    if (largest < 1.0e-10) {
      if (thin) map_gradients(w);
      return;
    }
  }
  if (thin)
    find_stretches(w);
  else
    material->update_batch(b, kernels());
  for (int p = 0; p < w.n; p++) {
    double *const s = w.state[p];
    for (int c = 0; c < 9; c++) s[c] = b.F[c][p];
    for (int c = 0; c < 6; c++) s[9 + c] = b.J[p] * b.stress[c][p];
    for (int h = 0; h < body.nhistory; h++) s[15 + h] = w.history[h * BATCH + p];
    if (thin) std::copy_n(w.thin[p].along, 9, body.motion_of(s));
  }
  if (thin) map_gradients(w);
}

/** Maps gradients in the reference configuration to those in space. */
void ElementForces::map_gradients(ElementBatch &w)
{
  for (const auto &[number, row, rule, start] : w.elements)
    for (int p = start; p < start + rule.npoint; p++) {
      const double *const F = w.state[p];
      const double cofactors[9] = MPM_COFACTORS(F), inv = 1.0 / determinant(F);
      for (int m = 0; m < rule.nnode; m++) {
        double g[3];
        for (int a = 0; a < 3; a++) g[a] = inv * dot(w.g[p][m], cofactors + 3 * a);
        MathExtra::copy3(g, w.g[p][m]);
      }
    }
}

// f_k = -sum_q V0 tau grad N_k. With F-bar the power of the stress is tau : (L + (mean - tr L)/dim
// I) where mean is the rate of the mean of J. In the force, the mean of the pressure acts on the
// gradients of the volume of the element and replaces the pressure of each point: force and strain
// are consistent, and an elastic body keeps its energy

/** Adds -f_k to f, in units of stress times volume over length. */
void ElementForces::find_forces(const ElementBatch &w, int start, const ElementRule &rule,
                                double (*f)[3]) const
{
  const bool average = fbar && rule.npoint > 1;
  double volume = 0.0, pressure = 0.0;
  for (int q = 0; q < rule.npoint; q++) {
    const int p = start + q;
    const double *const s = w.state[p], V = w.volume[p];
    double t[6];
    for (int c = 0; c < 6; c++) t[c] = V * s[9 + c];
    if (average) {
      const double trace = (t[0] + t[1] + (dim == 3 ? t[2] : 0.0)) / dim;
      pressure += trace;
      for (int d = 0; d < dim; d++) t[d] -= trace;
      volume += V * w.J[p];
    }
    for (int m = 0; m < rule.nnode; m++) {
      const double *const g = w.g[p][m];
      f[m][0] += t[0] * g[0] + t[3] * g[1] + t[4] * g[2];
      f[m][1] += t[3] * g[0] + t[1] * g[1] + t[5] * g[2];
      f[m][2] += t[4] * g[0] + t[5] * g[1] + t[2] * g[2];
    }
  }
  for (int q = 0; q < rule.npoint && average; q++) {
    const double factor = pressure * w.volume[start + q] * w.J[start + q] / volume;
    for (int m = 0; m < rule.nnode; m++)
      for (int d = 0; d < dim; d++) f[m][d] += factor * w.g[start + q][m][d];
  }
}

/** Adds the forces of elements, and shares of their state, to the sums of their nodes. */
void ElementForces::add_sums(ElementBatch &w, double *sums, int width) const
{
  const double scale = 1.0 / force->nktv2p;
  for (const auto &[number, row, rule, start] : w.elements) {
    double f[MAX_ELEMENT_NODES][3] = {{0.0}}, share[MAX_ELEMENT_NODES] = {0.0};
    double size = 0.0;
    w.mean.assign(15 + body.nhistory, 0.0);
    find_forces(w, start, rule, f);
    for (int q = 0; q < rule.npoint; q++) {
      const double V = w.volume[start + q] / body.swell_of(row);    // as for the masses of nodes
      for (int m = 0; m < rule.nnode; m++) share[m] += V * rule.N[q][m];
      size += V;
    }
    for (int q = 0; q < rule.npoint; q++) {
      const double *const s = w.state[start + q], weight = w.volume[start + q] / size;
      for (int c = 0; c < 15 + body.nhistory; c++) w.mean[c] += weight * s[c];
      // the elements of a fold are rotated by angles that have no mean
      if (thin) w.mean[0] += weight * (MPMPoints::det(s) - s[0]);
    }
    for (int m = 0; m < rule.nnode; m++) {
      double *const sum = &sums[(std::size_t) body.nodes[number][m] * width];
      for (int d = 0; d < dim; d++) sum[d] -= scale * f[m][d];
      for (int c = 0; c < 15 + body.nhistory; c++) sum[3 + c] += share[m] * w.mean[c];
    }
  }
}

void ElementForces::strain(bool starting, double *sums, int width)
{
  for_batches(true, [&](ElementBatch &w) {
    find_stress(w, starting);
    add_sums(w, sums, width);
  });
  if (!bending) return;
  const double scale = 1.0 / force->nktv2p;
  body.for_bending(atom->x, [&](double, std::size_t e, int nnode, const double(*f)[3]) {
    for (int m = 0; m < nnode; m++)
      for (int d = 0; d < dim; d++)
        sums[(std::size_t) body.nodes[e][m] * width + d] += scale * f[m][d];
  });
}

bool ElementForces::try_motion(Trial &motion, const Use &use)
{
  const std::vector<double> before = body.pool;
  const double scale = 1.0 / force->nktv2p;
  trial = &motion;
  bool &good = motion.good;
  good = true;
  for_batches(true, [&](ElementBatch &w) {
    if (good) find_stress(w, false);
    for (const auto &element : w.elements) {
      double f[MAX_ELEMENT_NODES][3] = {{0.0}};
      if (good) find_forces(w, element.start, element.rule, f);
      for (int m = 0; m < element.rule.nnode; m++)
        for (int d = 0; d < dim; d++) {
          f[m][d] *= -scale;
          good = good && std::isfinite(f[m][d]);
        }
      if (good) use(element.number, element.rule.nnode, f);
    }
  });
  trial = nullptr;
  std::copy(before.begin(), before.end(), body.pool.begin());
  return good;
}

void ElementForces::add_stored_energy(double &sum)
{
  double energy[BATCH];
  for_batches(false, [&](ElementBatch &w) {
    material->material->stored_energy(w.batch, energy);
    for (int p = 0; p < w.n; p++) sum += w.volume[p] * energy[p];
  });
  if (bending)
    body.for_bending(atom->x, [&](double stored, std::size_t, int, const double(*)[3]) {
      sum += stored;
    });
}

/** By the theorem of Gerschgorin: its square is at most the largest sum of a row of the stiffness
 *  over its mass. */
void ElementForces::find_bending_frequency(int groupbit, const ElementNodes::IDs &ids)
{
  std::vector<double> sum(ids.n, 0.0), all(ids.n);
  body.add_bending_sums(ids.low, sum);
  MPI_Allreduce(sum.data(), all.data(), (int) ids.n, MPI_DOUBLE, MPI_SUM, world);
  double largest = 0.0, square;
  for (int i = 0; i < atom->nlocal; i++)
    if (atom->mask[i] & groupbit)
      largest = std::max(largest, all[atom->tag[i] - ids.low] / atom->rmass[i]);
  MPI_Allreduce(&largest, &square, 1, MPI_DOUBLE, MPI_MAX, world);
  bending_frequency = sqrt(square * force->ftm2v / force->nktv2p);
}

/** The square of the highest frequency of an element with lumped masses rho_0 V_0/n at its n nodes
 *  and a stiffness of rho c^2 at most for any strain is n c^2 times the mean of the largest
 *  eigenvalue of sum_k grad N_k x grad N_k at most, and that of the body is not larger. The lattice
 *  can only lower it: its velocities are a part of those that nodes can have, and its lumped mass
 *  is not less than theirs. */
double ElementForces::stable_dt(tagint &tag, double &speed)
{
  double smallest = std::numeric_limits<double>::max(), c[BATCH];
  tag = 0;
  speed = 0.0;
  for_batches(false, [&](ElementBatch &w) {
    if (thin) {
      const double *motion[BATCH];
      for (int p = 0; p < w.n; p++) motion[p] = body.motion_of(w.state[p]);
      plane_stress->wave_speed(w.batch, motion, c);
    } else
      material->material->wave_speed(w.batch, c);
    for (const auto &[number, row, rule, start] : w.elements) {
      double sum = 0.0, size = 0.0, largest = 0.0;
      const double stiffer = body.swell_of(row);
      for (int q = 0; q < rule.npoint; q++) {
        const int p = start + q;
        sum += stiffer * w.volume[p] * c[p] * c[p] * rule.nnode * rule.largest_eigenvalue(w.g[p]);
        size += w.volume[p];
        largest = std::max(largest, c[p]);
      }
      const double dt = 2.0 * sqrt(size / sum);
      if (std::isnan(smallest) || dt >= smallest) continue;    // NaN does not pass unseen
      smallest = dt;
      tag = (tagint) row[2];
      speed = largest;
    }
  });
  return smallest;
}
