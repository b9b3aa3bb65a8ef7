/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_solids.h"

#include "base/mpm_points.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_physics.h"
#include "field/mpm_time_limit.h"
#include "flow/mpm_flow_boxes.h"
#include "flow/mpm_flow_stencil.h"
#include "force.h"
#include "lattice/staggered.h"
#include "material/batch_kernels.h"
#include "material/material.h"
#include "math/matrix.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// shear by which the stiffness of a law is found
static constexpr double PROBE = 1.0e-6;
// stiffness of a stretched solid over that at rest, up to which an interface reaches its balance
// with the fluid in one step
static constexpr double STIFFER = 3.0;
// least share of fluid that counts against shear along an
// interface, over the largest share of fluid next to a point
static constexpr double LEAST_SHARE = 0.5;
// share of fluid next to a point from which on strains along the interface are those of the solid
// alone
static constexpr double MIXED = 0.1;
// share of fluid next to a point that counts as none, and of air
static constexpr double LEAST_FLUID = 1.0e-6, NO_AIR = 1.0e-12;
// filled share of the surroundings of a face from which on its velocity counts in strains as it is
static constexpr double SUPPORTED = 0.5;
// weight of boxes around a point next to air below which the point comes loose
static constexpr double LOOSE = 0.1;

/** Points of one material that wait for its law. */
struct MPMFlowSolids::Pending {
  Batch batch = {};
  int n = 0, point[BATCH];
  double L[9 * BATCH], F[9 * BATCH], tau[6 * BATCH], volume[BATCH];
  std::vector<double> rows;    // of history
  double stiffest = 0.0;       // shear modulus over density
  tagint tag = 0;
};

namespace {
/** Places of components of a symmetric tensor, stored as xx yy zz xy xz yz. */
constexpr int SYMMETRIC[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};

/** Removes the shear of planes with this normal from a symmetric tensor. */
template <int dim> void take_shear_off(const double *n, double T[3][3])
{
  double along[3], normal = 0.0;
  for (int c = 0; c < dim; c++) {
    along[c] = 0.0;
    for (int d = 0; d < dim; d++) along[c] += T[c][d] * n[d];
    normal += along[c] * n[c];
  }
  for (int c = 0; c < dim; c++) along[c] -= normal * n[c];
  for (int c = 0; c < dim; c++)
    for (int d = 0; d < dim; d++) T[c][d] -= along[c] * n[d] + n[c] * along[d];
}

template <int dim>
void interpolate(const MPMFlowLattice &cells, const Grid::Block &block, const double *t,
                 const double *velocity, double *u)
{
  StaggeredWeights w;
  w.find<dim>(t);
  const MPMFlowStencil<dim> reach(cells.grid, block, w.base);
  std::fill_n(u, dim, 0.0);
  visit<dim>(reach, [&](int64_t number, const int k[3]) {
    for (int c = 0; c < dim; c++) u[c] += w.face<dim>(c, k) * velocity[number * dim + c];
  });
}
}    // namespace

/* ---------------------------------------------------------------------- */

MPMFlowSolids::MPMFlowSolids(LAMMPS *lmp, const MPMFlowLattice &cells, int bits) :
    Pointers(lmp), cells(cells), bits(bits), kernels(BatchKernels::select(cells.lattice.dim))
{
}

MPMFlowSolids::~MPMFlowSolids() = default;

void MPMFlowSolids::init(const std::string &fix)
{
  who = fix;
  materials.clear();
  pending.clear();
  int nhistory = 1;
  for (auto *material : find_fixes<FixMPMMaterial>(lmp)) {
    materials.push_back(material);
    pending.push_back(std::make_unique<Pending>());
    pending.back()->batch.h = cells.lattice.h;
    pending.back()->rows.resize((std::size_t) material->nhistory * BATCH);
    nhistory = std::max(nhistory, material->nhistory);
  }
  history.resize((std::size_t) nhistory * BATCH);
  for (auto &one : pending) one->batch.history = reinterpret_cast<double(*)[BATCH]>(history.data());
}

void MPMFlowSolids::check_points() const
{
  bigint mine[2] = {0, 0}, all[2];
  int wrong = -1, any;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!cells.is_point(i) || !holds(i)) continue;
    const int m = material_of(i);
    mine[0]++;
    if (m < 0) {
      mine[1]++;
      continue;
    }
    const auto &law = *materials[m]->material;
    if (!law.uses_F() || !law.is_solid() || law.is_of_surfaces() || law.conducts() ||
        law.is_thermoelastic())
      wrong = m;
  }
  MPI_Allreduce(mine, all, 2, MPI_LMP_BIGINT, MPI_SUM, world);
  MPI_Allreduce(&wrong, &any, 1, MPI_INT, MPI_MAX, world);
  if (!all[0])
    error->all(FLERR, Error::NOLASTLINE,
               "{}: the group of keyword solid has no points of this fix: put some into it", who);
  if (all[1])
    error->all(FLERR, Error::NOLASTLINE,
               "{}: {} points of keyword solid have no law: give them a fix mpm/material", who,
               all[1]);
  if (any >= 0)
    error->all(
        FLERR, Error::NOLASTLINE,
        "{}: fix mpm/material {} is no hyperelastic law without heat, which solids in a flow "
        "need: use one such as neohookean",
        who, materials[any]->id);
}

int MPMFlowSolids::material_of(int i) const
{
  for (std::size_t m = 0; m < materials.size(); m++)
    if (atom->mask[i] & materials[m]->groupbit) return (int) m;
  return -1;
}

double MPMFlowSolids::density_of(int i) const
{
  const int m = material_of(i);
  return m < 0 ? 1.0 : materials[m]->density(i);
}

/** Lets point i wait, and calls f(m) once all places of material m are taken. */
template <class F> void MPMFlowSolids::add(int m, int i, const F &f)
{
  auto &p = *pending[m];
  p.point[p.n++] = i;
  if (p.n < BATCH) return;
  f(m);
  p.n = 0;
}

/** Calls f(material) for the points that still wait. */
template <class F> void MPMFlowSolids::finish(const F &f)
{
  for (std::size_t m = 0; m < pending.size(); m++) {
    if (pending[m]->n) f((int) m);
    pending[m]->n = 0;
  }
}

/* ----------------------------------------------------------------------
   Minus the stress times the gradient of functions of faces. Beyond walls, forces act on the
   velocities of images, so that they do the work of the stress. The part that is the same along all
   axes of the lattice is left to the pressure.
------------------------------------------------------------------------- */

template <int dim> void MPMFlowSolids::give(std::vector<double> &forces)
{
  find_shares<dim>();
  const double factor = 1.0 / (force->nktv2p * cells.lattice.h);
  const auto tau = MPMPoints::get(atom)->tau;
  MPMFlowPlace<dim> place(cells.lattice);
  MPMFlowBoxes<dim> boxes;
  double t[3];
  for (const auto &run : cells.runs)
    for (int nth = run.first; nth < run.last; nth++) {
      const int i = cells.points[nth];
      if (!holds(i)) continue;
      place.find(atom->x[i], atom->vfrac[i], t);
      const auto &block = cells.grid.blocks[run.slot];
      boxes.find(t, place.width);
      double mean = 0.0, stress[3][3] = {}, inside[3][3] = {};
      for (int d = 0; d < dim; d++) mean += tau[i][d] / dim;
      for (int c = 0; c < dim; c++)
        for (int d = 0; d < dim; d++)
          stress[c][d] =
              -factor * atom->vfrac[i] * (tau[i][SYMMETRIC[c][d]] - (c == d ? mean : 0.0));
      Interface interface;
      const bool near = find_interface<dim>(block, t, place.width, interface);
      const Air air = find_air<dim>(block, t, place.width);
      if (near) {
        std::copy_n(&stress[0][0], 9, &inside[0][0]);
        take_shear_off<dim>(interface.n, inside);
        const double part = std::min(1.0, interface.most / MIXED);
        for (int c = 0; c < dim; c++)
          for (int d = 0; d < dim; d++) {
            inside[c][d] *= part;
            stress[c][d] -= inside[c][d];
          }
      }
      for (int c = 0; c < dim; c++)
        for (int d = 0; d < dim; d++) {
          const auto add = [&](int64_t number, double slope) {
            forces[number * dim + c] += stress[c][d] * slope;
          };
          if (air.is_near)
            visit_gradients_in_air<dim>(block, t, place.width, air, c, d, add);
          else
            boxes.visit_gradients(cells.grid, block, c, d, add);
        }
      if (!near) continue;
      boxes.find(t, 1.0);
      for (int c = 0; c < dim; c++)
        for (int d = 0; d < dim; d++)
          boxes.visit_gradients_by(cells.grid, block, c, d, weight_of<dim>(c, d),
                                   [&](int64_t number, double slope) {
                                     forces[number * dim + c] += inside[c][d] * slope;
                                   });
    }
}

void MPMFlowSolids::give_forces(std::vector<double> &forces)
{
  const int dim = cells.lattice.dim;
  forces.assign(cells.size() * dim, 0.0);
  dim == 2 ? give<2>(forces) : give<3>(forces);
  cells.sum(forces.data(), dim, false);
}

/* ----------------------------------------------------------------------
   The gradient is that at the middle of the path of a point, where the point has the velocity with
   which it moves: the map of the step is then of second order. It keeps volume, as the flow does.
------------------------------------------------------------------------- */

template <int dim> void MPMFlowSolids::strain(const double *velocity, double dt, double viscosity)
{
  std::vector<double> stiffness;
  for (std::size_t m = 0; m < materials.size(); m++)
    stiffness.push_back(STIFFER * stiffness_at_rest((int) m, dt));
  const auto update_points = [&](int m) {
    this->update_points(m, dt);
  };
  MPMFlowPlace<dim> place(cells.lattice);
  MPMFlowBoxes<dim> boxes;
  const double inv_h = 1.0 / cells.lattice.h;
  for (const auto &run : cells.runs)
    for (int nth = run.first; nth < run.last; nth++) {
      const int i = cells.points[nth];
      if (!holds(i)) continue;
      const auto &block = cells.grid.blocks[run.slot];
      double t[3] = {}, u[3];
      place.find(atom->x[i], atom->vfrac[i], t);
      interpolate<dim>(cells, block, t, velocity, u);
      const double start[3] = {t[0], t[1], t[2]};
      for (int d = 0; d < dim; d++) {
        t[d] += 0.5 * dt * inv_h * u[d];
        if (!cells.lattice.periodic[d])
          t[d] = std::max(0.0, std::min(t[d], (double) cells.lattice.ncell[d]));
      }
      boxes.find(t, place.width);
      const Air air = find_air<dim>(block, t, place.width);
      double A[3][3] = {}, M[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
      for (int c = 0; c < dim; c++)
        for (int d = 0; d < dim; d++) {
          double sum = 0.0;
          const auto add = [&](int64_t number, double slope) {
            sum += slope * velocity[number * dim + c];
          };
          if (air.is_near)
            visit_gradients_in_air<dim>(block, t, place.width, air, c, d, add);
          else
            boxes.visit_gradients(cells.grid, block, c, d, add);
          A[c][d] = dt * inv_h * sum;
        }
      const int m = material_of(i);
      Interface interface;
      if (find_interface<dim>(block, start, place.width, interface)) {
        boxes.find(t, 1.0);
        double more[3][3] = {}, both[3][3] = {};
        for (int c = 0; c < dim; c++)
          for (int d = 0; d < dim; d++)
            boxes.visit_gradients_by(
                cells.grid, block, c, d, weight_of<dim>(c, d), [&](int64_t number, double slope) {
                  more[c][d] += dt * inv_h * slope * velocity[number * dim + c];
                });
        for (int c = 0; c < dim; c++)
          for (int d = 0; d < dim; d++)
            both[c][d] = 0.5 * (more[c][d] + more[d][c] - A[c][d] - A[d][c]);
        take_shear_off<dim>(interface.n, both);
        const double part = std::min(1.0, interface.most / MIXED);
        for (int c = 0; c < dim; c++)
          for (int d = 0; d < dim; d++) A[c][d] += part * both[c][d];
        leave_to_fluid<dim>(i, interface, stiffness[m], viscosity, dt, A);
      }
      for (int c = 0; c < dim; c++)
        for (int d = 0; d < dim; d++) {
          M[3 * c + d] += A[c][d];
          for (int e = 0; e < dim; e++) M[3 * c + d] += 0.5 * A[c][e] * A[e][d];
        }
      const double det = determinant(M);
      if (!(det > 0.0))
        error->one(FLERR, Error::NOLASTLINE,
                   "{}: point {} of a solid is turned inside out at step {}: take smaller time "
                   "steps",
                   who, atom->tag[i], update->ntimestep);
      const double scale = std::pow(det, -1.0 / dim);
      auto &to = *pending[m];
      for (int c = 0; c < dim; c++)
        for (int d = 0; d < dim; d++)
          to.L[dim * dim * to.n + dim * d + c] = (scale * M[3 * c + d] - (c == d ? 1.0 : 0.0)) / dt;
      add(m, i, update_points);
    }
  finish(update_points);
}

void MPMFlowSolids::deform(const double *velocity, double dt, double viscosity)
{
  cells.lattice.dim == 2 ? strain<2>(velocity, dt, viscosity) : strain<3>(velocity, dt, viscosity);
}

/* ----------------------------------------------------------------------
   Shares of solid in the volume of points in boxes of one spacing around corners of cells. The
   lattice has means of shears over these boxes.
   Also the volume in boxes around faces, in which stresses act on their velocities.
------------------------------------------------------------------------- */

template <int dim> void MPMFlowSolids::find_shares()
{
  constexpr int KINDS = MPMFlowBoxes<dim>::KINDS, width = 2 * KINDS;
  constexpr auto &AXES = MPMFlowBoxes<dim>::AXES;
  MPMFlowPlace<dim> place(cells.lattice);
  MPMFlowBoxes<dim> boxes;
  double t[3];
  shares.assign(cells.size() * width, 0.0);
  faces.assign(cells.size() * 2 * dim, 0.0);
  for (const auto &run : cells.runs)
    for (int nth = run.first; nth < run.last; nth++) {
      const int i = cells.points[nth];
      place.find(atom->x[i], atom->vfrac[i], t);
      boxes.find(t, place.width);
      const double all = atom->vfrac[i], solid = holds(i) ? all : 0.0;
      for (int kind = 0; kind < KINDS; kind++) {
        typename MPMFlowBoxes<dim>::Place places[3];
        MPMFlowBoxes<dim>::places_of(AXES[kind][0], AXES[kind][1], places);
        boxes.visit_boxes(cells.grid, cells.grid.blocks[run.slot], places,
                          [&](int64_t number, double share) {
                            shares[width * number + 2 * kind] += solid * share;
                            shares[width * number + 2 * kind + 1] += all * share;
                          });
      }
      for (int c = 0; c < dim; c++) {
        typename MPMFlowBoxes<dim>::Place places[3] = {
            MPMFlowBoxes<dim>::CELL, MPMFlowBoxes<dim>::CELL, MPMFlowBoxes<dim>::CELL};
        places[c] = MPMFlowBoxes<dim>::NODE;
        boxes.visit_boxes(cells.grid, cells.grid.blocks[run.slot], places,
                          [&](int64_t number, double share) {
                            faces[2 * dim * number + dim + c] += all * share;
                          });
      }
    }
  cells.sum(faces.data(), 2 * dim);
  cells.reflect_faces(faces.data(), 2 * dim);
  cells.sum_freely(shares.data(), width);
  solid_share.resize(cells.size());
  for (int64_t k = 0; k < cells.size(); k++) {
    const double *const volumes = shares.data() + width * k;
    solid_share[k] = volumes[1] > 0.0 ? volumes[0] / volumes[1] : 0.0;
  }
  cells.reflect_cells(solid_share.data());
}

/** Finds the shares of fluid in the boxes of a point, and the normal. False where there is no fluid
 *  or no normal. */
template <int dim>
bool MPMFlowSolids::find_interface(const Grid::Block &block, const double *t, double width,
                                   Interface &to) const
{
  constexpr int KINDS = MPMFlowBoxes<dim>::KINDS;
  constexpr auto &AXES = MPMFlowBoxes<dim>::AXES;
  MPMFlowBoxes<dim> boxes;
  boxes.find(t, width);
  double length = 0.0, most = 0.0;
  auto &fluid = to.fluid;
  auto &n = to.n;
  std::fill_n(fluid, KINDS, 0.0);
  std::fill_n(n, 3, 0.0);
  for (int kind = 0; kind < KINDS; kind++) {
    typename MPMFlowBoxes<dim>::Place places[3];
    MPMFlowBoxes<dim>::places_of(AXES[kind][0], AXES[kind][1], places);
    boxes.visit_boxes(cells.grid, block, places, [&](int64_t number, double share) {
      const double *const s = shares.data() + 2 * KINDS * number + 2 * kind;
      if (s[1] > 0.0) fluid[kind] += share * (1.0 - s[0] / s[1]);
    });
    most = std::max(most, fluid[kind]);
  }
  to.most = most;
  if (most < LEAST_FLUID) return false;

  // the normal, by splines of cells, which reach all of these boxes: even next to no fluid gives a
  // direction

  int base[3] = {0, 0, 0};
  double spline[3][3], slope[3][3];
  for (int d = 0; d < dim; d++) {
    base[d] = (int) std::floor(t[d]) - 1;
    const double x = t[d] - base[d] - 1.5;
    spline[d][0] = 0.5 * (0.5 - x) * (0.5 - x);
    spline[d][1] = 0.75 - x * x;
    spline[d][2] = 0.5 * (0.5 + x) * (0.5 + x);
    slope[d][0] = x - 0.5;
    slope[d][1] = -2.0 * x;
    slope[d][2] = x + 0.5;
  }
  const MPMFlowStencil<dim> reach(cells.grid, block, base);
  for_each_index<dim>({3, 3, 3}, [&](const int *k) {
    const double share = solid_share[reach.number(k)];
    for (int d = 0; d < dim; d++) {
      double weight = share;
      for (int e = 0; e < dim; e++) weight *= e == d ? slope[e][k[e]] : spline[e][k[e]];
      n[d] += weight;
    }
  });
  for (int d = 0; d < dim; d++) length += n[d] * n[d];
  if (!(length > 0.0)) return false;
  length = std::sqrt(length);
  for (int d = 0; d < dim; d++) n[d] /= length;
  return true;
}

double MPMFlowSolids::support_of(int64_t number, int c) const
{
  return std::min(1.0, volume_around(number, c) / (SUPPORTED * cells.lattice.cell_volume()));
}

/* ----------------------------------------------------------------------
   Next to a free surface, boxes have faces around which there is hardly any mass. Their velocities
   are those of the air, and a stress that acts on them accelerates them without limit. A point
   takes its gradients from those of its boxes that are supported, as if these went on to the point,
   and gives its stress to the same faces. If it has none, it takes those up to half a spacing
   farther away.
------------------------------------------------------------------------- */

template <int dim>
MPMFlowSolids::Air MPMFlowSolids::find_air(const Grid::Block &block, const double *t,
                                           double width) const
{
  MPMFlowBoxes<dim> narrow, wide;
  narrow.find(t, width, 1.0);
  wide.find(t, 1.0, 1.0);
  Air air;
  double least = 1.0;
  for (int c = 0; c < dim; c++)
    for (int d = 0; d < dim; d++) {
      double of_narrow = 0.0, of_wide = 0.0;
      narrow.visit_differences(cells.grid, block, c, d,
                               [&](const int *k, int64_t low, int64_t high) {
                                 const double support = support_of_box(low, high, c);
                                 of_narrow += support * narrow.share_in(c, d, k);
                                 of_wide += support * wide.share_in(c, d, k);
                               });
      air.missing[c][d] = of_narrow < 1.0 - NO_AIR ? 1.0 - of_narrow : 0.0;
      air.is_near = air.is_near || air.missing[c][d] > 0.0;
      air.all[c][d] = of_narrow + air.missing[c][d] * of_wide;
      least = std::min(least, air.all[c][d]);
    }
  air.hold = std::min(1.0, least / LOOSE);
  return air;
}

template <int dim, class F>
void MPMFlowSolids::visit_gradients_in_air(const Grid::Block &block, const double *t, double width,
                                           const Air &air, int c, int d, const F &f) const
{
  if (air.hold == 0.0) return;
  MPMFlowBoxes<dim> narrow, wide;
  narrow.find(t, width, 1.0);
  wide.find(t, 1.0, 1.0);
  const double factor = air.hold / air.all[c][d];
  narrow.visit_differences(cells.grid, block, c, d, [&](const int *k, int64_t low, int64_t high) {
    const double weight = factor * support_of_box(low, high, c) *
        (narrow.share_in(c, d, k) + air.missing[c][d] * wide.share_in(c, d, k));
    if (weight == 0.0) return;
    f(high, weight);
    f(low, -weight);
  });
}

/* ----------------------------------------------------------------------
   Next to a fluid, the velocity gradient in a box is a mean of those of fluid and solid. Shear of
   planes along the interface: the stress along the interface is the same on both sides, so the
   fluid has the shear of the solid plus that which the stress of the law causes by its viscosity;
   the rest is that of the solid. Without this both would have the same shear, and solids would hold
   a layer of fluid of up to half a spacing. The stress is that at the end of the step: a nearly
   rigid solid then leaves all shear to the fluid, whatever the duration of the step.

   The other strains are the same on both sides at the interface, but fluid in a box away from it
   has others. The solid takes those of boxes in proportion to their solid (weight_of()), and gives
   them its stress: otherwise a corner of solid in a box would make all of the box stiff.
------------------------------------------------------------------------- */

template <int dim>
void MPMFlowSolids::leave_to_fluid(int i, const Interface &interface, double stiffness,
                                   double viscosity, double dt, double A[3][3]) const
{
  const auto &fluid = interface.fluid;
  const auto &n = interface.n;
  // the part of the present traction along the interface, and what the law adds to it in the step
  // if the solid has all of the strain

  const double *const tau = MPMPoints::get(atom)->tau[i];
  double traction[3] = {}, normal = 0.0, square = 0.0;
  for (int c = 0; c < dim; c++)
    for (int d = 0; d < dim; d++)
      traction[c] += (tau[SYMMETRIC[c][d]] + stiffness * (A[c][d] + A[d][c])) * n[d];
  for (int c = 0; c < dim; c++) normal += n[c] * traction[c];
  for (int c = 0; c < dim; c++) {
    traction[c] -= normal * n[c];
    square += traction[c] * traction[c];
  }
  if (!(square > 0.0)) return;

  // this stress, at the end of the step, causes the additional shear of the fluid, and is reduced
  // by it

  double share = 0.0;
  for (int c = 0; c < dim; c++)
    for (int d = 0; d < dim; d++)
      share += fluid[MPMFlowBoxes<dim>::kind_of(c, d)] * traction[c] * n[d] *
          (traction[c] * n[d] + traction[d] * n[c]) / square;
  const double resistance =
      viscosity + std::max(share, LEAST_SHARE * interface.most) * stiffness * dt;
  for (int c = 0; c < dim; c++)
    for (int d = 0; d < dim; d++)
      A[c][d] -= fluid[MPMFlowBoxes<dim>::kind_of(c, d)] * dt / resistance * traction[c] * n[d];
}

/** Loads the present state of the points that wait for their law. */
void MPMFlowSolids::load(int m, double dt)
{
  auto &p = *pending[m];
  const auto &points = *MPMPoints::get(atom);
  const int width = materials[m]->nhistory;
  for (int k = 0; k < p.n; k++) {
    const int i = p.point[k];
    std::copy_n(points.F[i], 9, p.F + 9 * k);
    std::copy_n(points.tau[i], 6, p.tau + 6 * k);
    p.volume[k] = atom->vfrac[i];
    if (width)
      std::copy_n(materials[m]->history[i], width, p.rows.data() + (std::size_t) width * k);
  }
  kernels->load(p.batch, p.n, dt, p.L, p.F, p.tau, p.volume, nullptr);
  if (width) kernels->load_history(p.batch, width, p.rows.data());
  p.batch.time = elapsed_time(*update);
}

/** Adds half of the work that the present stresses would do in a step; the pressure does none. */
void MPMFlowSolids::add_half_of_work(const Pending &p, double dt)
{
  const int dim = cells.lattice.dim;
  for (int k = 0; k < p.n; k++) {
    const double *const tau = p.tau + 6 * k, *const L = p.L + dim * dim * k;
    double mean = 0.0, power = 0.0;
    for (int d = 0; d < dim; d++) mean += tau[d] / dim;
    for (int c = 0; c < dim; c++)
      for (int d = 0; d < dim; d++)
        power += L[dim * d + c] * (tau[SYMMETRIC[c][d]] - (c == d ? mean : 0.0));
    strain_work += 0.5 * dt * p.volume[k] * power / force->nktv2p;
  }
}

void MPMFlowSolids::update_points(int m, double dt)
{
  auto &p = *pending[m];
  load(m, dt);
  auto &material = *materials[m];
  add_half_of_work(p, dt);
  material.update_batch(p.batch, *kernels);
  kernels->store(p.batch, p.F, p.tau);
  add_half_of_work(p, dt);
  const int width = material.nhistory;
  if (width) kernels->store_history(p.batch, width, p.rows.data());
  const auto &points = *MPMPoints::get(atom);
  for (int k = 0; k < p.n; k++) {
    const int i = p.point[k];
    std::copy_n(p.F + 9 * k, 9, points.F[i]);
    std::copy_n(p.tau + 6 * k, 6, points.tau[i]);
    if (width) std::copy_n(p.rows.data() + (std::size_t) width * k, width, material.history[i]);
  }
}

/* ----------------------------------------------------------------------
   Stiffness of a law against shear waves: a small shear along a of planes with the normal n changes
   the stress along a on these planes. Directions are those of axes and diagonals. In steps of this
   duration a viscosity of the law acts like a stiffness.
------------------------------------------------------------------------- */

void MPMFlowSolids::probe(int m)
{
  auto &p = *pending[m];
  const int dim = cells.lattice.dim;
  const double r = std::sqrt(0.5);
  struct Shear {
    double n[3], a[3];
  };
  static const Shear plane[] = {{{1, 0, 0}, {0, 1, 0}},
                                {{0, 1, 0}, {1, 0, 0}},
                                {{r, r, 0}, {r, -r, 0}},
                                {{r, -r, 0}, {r, r, 0}}};
  static const Shear space[] = {
      {{1, 0, 0}, {0, 0, 1}},  {{0, 1, 0}, {0, 0, 1}},  {{0, 0, 1}, {1, 0, 0}},
      {{0, 0, 1}, {0, 1, 0}},  {{r, 0, r}, {r, 0, -r}}, {{r, 0, -r}, {r, 0, r}},
      {{0, r, r}, {0, r, -r}}, {{0, r, -r}, {0, r, r}}, {{r, r, 0}, {0, 0, 1}},
      {{r, -r, 0}, {0, 0, 1}}, {{r, 0, r}, {0, 1, 0}},  {{r, 0, -r}, {0, 1, 0}},
      {{0, r, r}, {1, 0, 0}},  {{0, r, -r}, {1, 0, 0}}};
  std::vector<Shear> shears(std::begin(plane), std::end(plane));
  if (dim == 3) shears.insert(shears.end(), std::begin(space), std::end(space));

  const double dt = update->dt;
  double rest[6][BATCH];
  std::fill_n(p.L, dim * dim * p.n, 0.0);
  std::fill_n(p.batch.heat, BATCH, 0.0);
  load(m, dt);
  materials[m]->material->update(p.batch);
  for (int c = 0; c < 6; c++) std::copy_n(p.batch.stress[c], p.n, rest[c]);
  for (const auto &shear : shears) {
    for (int k = 0; k < p.n; k++)
      for (int c = 0; c < dim; c++)
        for (int d = 0; d < dim; d++)
          p.L[dim * dim * k + dim * d + c] = PROBE / dt * shear.a[c] * shear.n[d];
    std::fill_n(p.batch.heat, BATCH, 0.0);
    load(m, dt);
    materials[m]->material->update(p.batch);
    for (int k = 0; k < p.n; k++) {
      double change = 0.0;
      for (int c = 0; c < dim; c++)
        for (int d = 0; d < dim; d++) {
          const int e = SYMMETRIC[c][d];
          change += shear.a[c] * shear.n[d] * (p.batch.stress[e][k] - rest[e][k]);
        }
      const double stiffness =
          change / PROBE * p.volume[k] / atom->rmass[p.point[k]];    // NaN: the state is not valid
      if (stiffness > p.stiffest || std::isnan(stiffness)) {
        p.stiffest = std::isnan(stiffness) ? std::numeric_limits<double>::infinity() : stiffness;
        p.tag = atom->tag[p.point[k]];
      }
    }
  }
}

/** Shear modulus of a material before any deformation, with what its viscosity adds in a step. */
double MPMFlowSolids::stiffness_at_rest(int m, double dt)
{
  auto &p = *pending[m];
  const int dim = cells.lattice.dim, width = materials[m]->nhistory;
  const double none[3] = {0.0, 0.0, 0.0};
  for (int c = 0; c < 9; c++) p.F[c] = c % 4 == 0 ? 1.0 : 0.0;
  std::fill_n(p.tau, 6, 0.0);
  std::fill_n(p.L, dim * dim, 0.0);
  p.L[dim] = PROBE / dt;
  p.volume[0] = 1.0;
  if (width) {
    materials[m]->material->initialize(none, p.rows.data());
    kernels->load_history(p.batch, width, p.rows.data());
  }
  kernels->load(p.batch, 1, dt, p.L, p.F, p.tau, p.volume, nullptr);
  p.batch.heat[0] = 0.0;
  p.batch.time = elapsed_time(*update);
  materials[m]->material->update(p.batch);
  return p.batch.stress[3][0] / PROBE;
}

double MPMFlowSolids::stable_dt(tagint &tag)
{
  for (auto &one : pending) one->stiffest = 0.0;
  const auto probe = [this](int m) {
    this->probe(m);
  };
  for (int i = 0; i < atom->nlocal; i++)
    if (cells.is_point(i) && holds(i)) add(material_of(i), i, probe);
  finish(probe);
  double most = 0.0;
  for (const auto &one : pending) {
    if (one->stiffest <= most) continue;
    most = one->stiffest;
    tag = one->tag;
  }
  const double speed = std::sqrt(most * force->ftm2v / force->nktv2p);
  return speed > 0.0 ? cells.lattice.h / (std::sqrt(2.0 * cells.lattice.dim) * speed)
                     : std::numeric_limits<double>::max();
}

void MPMFlowSolids::visit_batches(
    int groupbit, const std::function<void(const Batch &, const int *, const FixMPMMaterial &)> &f)
{
  const int dim = cells.lattice.dim;
  const auto flush = [&](int m) {
    auto &p = *pending[m];
    std::fill_n(p.L, dim * dim * p.n, 0.0);
    load(m, update->dt);
    f(p.batch, p.point, *materials[m]);
  };
  for (int i = 0; i < atom->nlocal && !materials.empty(); i++) {
    if (!(atom->mask[i] & groupbit) || !cells.is_point(i) || !holds(i)) continue;
    const int m = material_of(i);
    if (m >= 0) add(m, i, flush);
  }
  finish(flush);
}

double MPMFlowSolids::memory_usage() const
{
  double bytes =
      bytes_of(history, shares, solid_share, faces) + pending.size() * (double) sizeof(Pending);
  for (const auto &one : pending) bytes += bytes_of(one->rows);
  return bytes;
}
