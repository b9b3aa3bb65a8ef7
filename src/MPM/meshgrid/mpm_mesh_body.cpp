/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "meshgrid/mpm_mesh_body.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_lists.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_physics.h"
#include "field/mpm_time_limit.h"
#include "fix.h"
#include "force.h"
#include "material/batch_kernels.h"
#include "material/material.h"
#include "math/matrix.h"
#include "mesh/element.h"
#include "meshgrid/fix_mpm_mesh_contact.h"
#include "meshgrid/mpm_mesh_fbar.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// a point that is farther outside, in widths of the next cell, has left the mesh

static constexpr double OUTSIDE = 0.1;

MPMMeshBody::MPMMeshBody(LAMMPS *lmp, const Fix &fix, const MPMMeshOptions &options,
                         const BackgroundMesh &mesh, MPMMeshForces &forces) :
    Pointers(lmp),
    mesh(mesh), ranks(lmp), forces(forces), shortest(std::numeric_limits<double>::max()),
    batch(new Batch()), fix(fix), options(options)
{
  for (const auto &one : mesh.cells) shortest = std::min(shortest, one.height);
  points = MPMPoints::get(atom);
  if (options.total) positions = mesh.nodes;
  if (options.fbar) fbar = std::make_unique<MPMMeshFbar>(*this);
}

MPMMeshBody::~MPMMeshBody() = default;

void MPMMeshBody::begin_run(FixMPMMeshContact *of_bodies)
{
  points = MPMPoints::get(atom);
  contact = of_bodies;
  const std::size_t rows = count_bodies() * mesh.nodes.size();
  sums.resize(rows);
  before.resize(rows);
  after.resize(rows);
  if (options.musl) mapped.resize(rows);
  find_materials();
  kernels = BatchKernels::select(mesh.dim);
}

void MPMMeshBody::list_points()
{
  order.clear();
  for (int i = 0; i < atom->nlocal; i++)
    if (is_point(i)) order.push_back(i);
  std::sort(order.begin(), order.end(), [this](int a, int b) {
    return atom->tag[a] < atom->tag[b];
  });
  places.resize(atom->nlocal);
  for (const int i : order) places[i].cell = (int) cell[i] - 1;
  find_places();
  find_ranks();
}

bool MPMMeshBody::is_point(int i) const
{
  return (atom->mask[i] & fix.groupbit) && atom->vfrac[i] > 0.0;
}

const double *MPMMeshBody::position(int i) const
{
  return options.total ? X[i] : atom->x[i];
}

FixMPMMaterial *MPMMeshBody::material_of(int i) const
{
  for (auto *material : materials)
    if (atom->mask[i] & material->groupbit) return material;
  return nullptr;
}

int MPMMeshBody::count_bodies() const
{
  return contact ? contact->count() : 1;
}

std::size_t MPMMeshBody::rows_of(int i) const
{
  return contact ? contact->body_of(atom->mask[i]) * mesh.nodes.size() : 0;
}

void MPMMeshBody::find_materials()
{
  materials = find_fixes<FixMPMMaterial>(lmp);
  int nhistory = 1;
  for (const auto *material : materials) nhistory = std::max(nhistory, material->nhistory);
  history.resize((std::size_t) nhistory * BATCH);
}

void MPMMeshBody::find_places()
{
  const int ncell = (int) mesh.cells.size();
  for (const int i : order) {
    auto &place = places[i];
    const int hint = place.cell < ncell ? place.cell : -1;
    mesh.find(position(i), hint, place);
    if (place.cell < 0 || place.outside > OUTSIDE)
      error->one(FLERR,
                 "Point {} of fix mpm/mesh {} is outside of the mesh at step {}: position {:.6g} "
                 "{:.6g} {:.6g}, "
                 "velocity {:.6g} {:.6g} {:.6g}; use a larger mesh, or conditions at its rim",
                 atom->tag[i], fix.id, update->ntimestep, atom->x[i][0], atom->x[i][1],
                 atom->x[i][2], atom->v[i][0], atom->v[i][1], atom->v[i][2]);
    cell[i] = place.cell + 1;
  }
}

/** Nodes of cells with points, and, as points go to others, of those around these. */
void MPMMeshBody::find_ranks()
{
  std::vector<char> wanted(mesh.nodes.size(), 0), with_points(mesh.cells.size(), 0);
  for (const int i : order) with_points[places[i].cell] = 1;
  for (std::size_t c = 0; c < mesh.cells.size(); c++)
    if (with_points[c])
      for (int k = 0; k < mesh.cells[c].nnode; k++) wanted[mesh.cells[c].node[k]] = 1;
  if (!options.total) {
    const auto touched = wanted;
    for (const auto &one : mesh.cells) {
      const bool near = std::any_of(one.node, one.node + one.nnode, [&](int node) {
        return touched[node];
      });
      for (int k = 0; k < one.nnode && near; k++) wanted[one.node[k]] = 1;
    }
  }
  if (options.total) share_positions();
  has_node.swap(wanted);
  ranks.find(has_node);
  if (!options.total || !forces.has_pressure()) return;
  std::vector<int> lowest(mesh.cells.size(), comm->nprocs);
  for (std::size_t c = 0; c < lowest.size(); c++)
    if (with_points[c]) lowest[c] = comm->me;
  MPI_Allreduce(MPI_IN_PLACE, lowest.data(), (int) lowest.size(), MPI_INT, MPI_MIN, world);
  counts_cell.resize(lowest.size());
  for (std::size_t c = 0; c < lowest.size(); c++) counts_cell[c] = lowest[c] == comm->me;
}

void MPMMeshBody::share_positions()
{
  if (ranks.first.empty()) return;                         // nothing has moved
  std::vector<double> known(4 * positions.size(), 0.0);    // and does any rank know it?
  for (const int node : ranks.nodes) {
    if (!ranks.first[node]) continue;
    std::copy_n(positions[node].data(), 3, &known[4 * (std::size_t) node]);
    known[4 * (std::size_t) node + 3] = 1.0;
  }
  MPI_Allreduce(MPI_IN_PLACE, known.data(), (int) known.size(), MPI_DOUBLE, MPI_SUM, world);
  for (std::size_t node = 0; node < positions.size(); node++)
    if (known[4 * node + 3] > 0.0) std::copy_n(&known[4 * node], 3, positions[node].data());
}

bool MPMMeshBody::lacks_nodes() const
{
  int mine = 0, any;
  for (const int i : order) {
    const auto &one = mesh.cells[places[i].cell];
    for (int k = 0; k < one.nnode; k++) mine |= !has_node[one.node[k]];
  }
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  return any != 0;
}

/** Velocity of a point at a node, with the velocity gradient of APIC. */
void MPMMeshBody::velocity_at(int i, int node, double *u) const
{
  std::copy_n(atom->v[i], 3, u);
  if (!C) return;
  double r[3];
  for (int d = 0; d < 3; d++) r[d] = mesh.nodes[node][d] - position(i)[d];
  for (int d = 0; d < mesh.dim; d++)
    for (int e = 0; e < mesh.dim; e++) u[d] += C[i][3 * d + e] * r[e];
}

/** In the total frame forces are of the first Piola-Kirchhoff stress tau F^-T on gradients in the
 *  reference configuration. */
void MPMMeshBody::points_to_nodes()
{
  const std::size_t nnode = mesh.nodes.size();
  for (int body = 0; body < count_bodies(); body++)
    for (const int node : ranks.nodes) sums[body * nnode + node] = {};
  const int dim = mesh.dim;
  const double unit = 1.0 / force->nktv2p;
  if (fbar) fbar->find_stress();
  for (const int i : order) {
    const auto &place = places[i];
    const auto &one = mesh.cells[place.cell];
    const double *const t = points->tau[i], *const f = atom->f[i];
    const double m = atom->rmass[i], V = unit * atom->vfrac[i];
    double P[9] = {t[0], t[3], t[4], t[3], t[1], t[5], t[4], t[5], t[2]};
    if (fbar) {
      const double mean = (t[0] + t[1] + (dim == 3 ? t[2] : 0.0)) / dim;
      for (int d = 0; d < dim; d++) P[4 * d] += fbar->mean_stress(i) - mean;
    }
    if (options.total) {
      double F[9];
      std::copy_n(points->F[i], 9, F);
      if (fbar) motion_of_nodes(place, F);
      const double cofactors[9] = MPM_COFACTORS(F),
                   inv = 1.0 / (F[0] * cofactors[0] + F[1] * cofactors[1] + F[2] * cofactors[2]);
      double product[9];
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
          product[3 * a + b] = 0.0;
          for (int c = 0; c < 3; c++)
            product[3 * a + b] += P[3 * a + c] * inv * cofactors[3 * c + b];
        }
      std::copy_n(product, 9, P);
    }
    const std::size_t rows = rows_of(i);
    for (int k = 0; k < one.nnode; k++) {
      Node &node = sums[rows + one.node[k]];
      const double w = m * place.N[k], *const g = place.g[k];
      double u[3];
      velocity_at(i, one.node[k], u);
      node.mass += w;
      for (int d = 0; d < dim; d++) {
        node.momentum[d] += w * u[d];
        node.load[d] += place.N[k] * f[d];
        node.force[d] -= V * dot(P + 3 * d, g);
      }
    }
  }
  for (int body = 0; body < count_bodies(); body++) ranks.sum(&sums[body * nnode].mass, WIDTH);
}

void MPMMeshBody::motion_of_nodes(const BackgroundMesh::Place &place, double F[9]) const
{
  const int dim = mesh.dim;
  const auto &one = mesh.cells[place.cell];
  for (int d = 0; d < dim; d++)
    for (int e = 0; e < dim; e++) {
      F[3 * d + e] = 0.0;
      for (int k = 0; k < one.nnode; k++) F[3 * d + e] += positions[one.node[k]][d] * place.g[k][e];
    }
}

bool MPMMeshBody::counts_mass_at(int node) const
{
  return has_node[node] && ranks.first[node] && mass_of_all(node) > 0.0;
}

/** Of all bodies at a node. */
double MPMMeshBody::mass_of_all(int node) const
{
  double mass = 0.0;
  for (int body = 0; body < count_bodies(); body++) mass += mass_of(body, node);
  return mass;
}

/** The work of a force is that at the mean of the velocities before and after the step, which is
 *  what it does to the kinetic energy of the node. A load is of the body that is there; where two
 *  bodies meet at a loaded side, each has the share of its mass at the node, so that the load
 *  neither presses them on each other nor parts them. */
void MPMMeshBody::find_velocities()
{
  const int dim = mesh.dim;
  const double dt = update->dt, impulse = dt * force->ftm2v;
  const auto each = [&](auto f) {
    for (int body = 0; body < count_bodies(); body++)
      for (const int node : ranks.nodes) f(node, body * mesh.nodes.size() + node);
  };
  each([&](int node, std::size_t row) {
    Node &mine = sums[row];
    before[row] = after[row] = {0.0, 0.0, 0.0};
    if (!(mine.mass > 0.0)) return;
    forces.add_load(node, mine.mass / mass_of_all(node), ranks.first[node], mine.load);
    for (int d = 0; d < dim; d++) {
      before[row][d] = mine.momentum[d] / mine.mass;
      after[row][d] = before[row][d] + impulse * (mine.force[d] + mine.load[d]) / mine.mass;
    }
  });
  if (contact) contact->act(*this, after, false);
  each([&](int node, std::size_t row) {
    const Node &mine = sums[row];
    if (!(mine.mass > 0.0)) return;
    const bool counts = ranks.first[node];
    MeshVector &v = after[row];
    const MeshVector free = v;
    forces.constrain(node, counts ? mine.mass / impulse : 0.0, v.data());
    for (int d = 0; d < dim && counts; d++)
      load_work += 0.5 * (before[row][d] + v[d]) *
          (dt * mine.load[d] + mine.mass * (v[d] - free[d]) / force->ftm2v);
  });
}

void MPMMeshBody::nodes_to_points()
{
  const int dim = mesh.dim;
  for (const int i : order) {
    const auto &place = places[i];
    const auto &one = mesh.cells[place.cell];
    const std::size_t rows = rows_of(i);
    double v[3] = {0.0, 0.0, 0.0}, change[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < one.nnode; k++) {
      const double N = place.N[k], *const a = after[rows + one.node[k]].data(),
                   *const b = before[rows + one.node[k]].data();
      for (int d = 0; d < dim; d++) {
        v[d] += N * a[d];
        change[d] += N * (a[d] - b[d]);
      }
    }
    const double share = options.transfer == MPMMeshOptions::FLIP ? options.flip : 0.0;
    for (int d = 0; d < dim; d++)
      atom->v[i][d] = share * (atom->v[i][d] + change[d]) + (1.0 - share) * v[d];
  }
}

void MPMMeshBody::map_back()
{
  const int dim = mesh.dim;
  const std::size_t nnode = mesh.nodes.size();
  for (int body = 0; body < count_bodies(); body++)
    for (const int node : ranks.nodes) mapped[body * nnode + node] = {0.0, 0.0, 0.0};
  for (const int i : order) {
    const auto &place = places[i];
    const auto &one = mesh.cells[place.cell];
    const std::size_t rows = rows_of(i);
    for (int k = 0; k < one.nnode; k++) {
      double u[3];
      velocity_at(i, one.node[k], u);
      for (int d = 0; d < dim; d++)
        mapped[rows + one.node[k]][d] += atom->rmass[i] * place.N[k] * u[d];
    }
  }
  for (int body = 0; body < count_bodies(); body++) ranks.sum(mapped[body * nnode].data(), 3);
  const auto each = [&](auto f) {
    for (int body = 0; body < count_bodies(); body++)
      for (const int node : ranks.nodes)
        if (sums[body * nnode + node].mass > 0.0) f(node, body * nnode + node);
  };
  each([&](int, std::size_t row) {
    for (double &v : mapped[row]) v /= sums[row].mass;
  });
  if (contact) contact->act(*this, mapped, true);
  each([&](int node, std::size_t row) {
    forces.constrain(node, 0.0, mapped[row].data());
  });
}

/** In the updated frame points move with the velocities that strain them. Nodes that points barely
 *  reach can have any velocity after the momentum equation, whose gradient would be that of the
 *  points: it is that of the mapped velocities, too. In the total frame forces do not depend on
 *  where points are. */
void MPMMeshBody::move_and_strain()
{
  const int dim = mesh.dim, nL = dim * dim;
  const double dt = update->dt;
  const auto &strains = options.musl ? mapped : after;
  const auto &moves = options.musl && !options.total ? mapped : after;
  if (options.total)
    for (const int node : ranks.nodes)
      for (int d = 0; d < dim; d++) positions[node][d] += dt * strains[node][d];
  if (fbar) fbar->find_strain(strains);
  Batch &b = *batch;
  for_batches(order, [&](const int *list, int n, FixMPMMaterial *material) {
    double L[9 * BATCH] = {}, F[9 * BATCH], tau[6 * BATCH], vol0[BATCH];
    for (int p = 0; p < n; p++) {
      const int i = list[p];
      const auto &place = places[i];
      const auto &one = mesh.cells[place.cell];
      const std::size_t rows = rows_of(i);
      for (int k = 0; k < one.nnode; k++) {
        const auto &u = strains[rows + one.node[k]], &v = moves[rows + one.node[k]];
        for (int d = 0; d < dim; d++) {
          atom->x[i][d] += dt * place.N[k] * v[d];
          for (int e = 0; e < dim; e++) L[nL * p + dim * e + d] += u[d] * place.g[k][e];
        }
      }
      for (int d = 0; d < dim && C; d++)
        for (int e = 0; e < dim; e++) C[i][3 * d + e] = L[nL * p + dim * e + d];
      if (fbar) fbar->scale(i, L + nL * p);
      std::copy_n(points->F[i], 9, F + 9 * p);
      std::copy_n(points->tau[i], 6, tau + 6 * p);
      vol0[p] = atom->vfrac[i];
    }
    b.n = n;
    b.h = shortest;
    b.time = elapsed_time(*update);
    b.history = reinterpret_cast<double(*)[BATCH]>(history.data());
    (options.total ? kernels->load_total : kernels->load)(b, n, dt, L, F, tau, vol0, nullptr);
    for (int k = 0; k < material->nhistory; k++)
      for (int p = 0; p < n; p++) b.history[k][p] = material->history[list[p]][k];
    material->update_batch(b, *kernels);
    if (!options.total && !material->material->uses_F()) kernels->forget_shape(b);
    const int bad = kernels->store(b, F, tau);
    for (int p = 0; p < n; p++) {
      const int i = list[p];
      if (bad && !(b.J[p] > 0.0))
        error->one(FLERR,
                   "Point {} of fix mpm/mesh {} has a deformation gradient of determinant {} at "
                   "step {}: position {:.6g} "
                   "{:.6g} {:.6g}, velocity {:.6g} {:.6g} {:.6g}; use a smaller time step, or a "
                   "finer mesh",
                   atom->tag[i], fix.id, b.J[p], update->ntimestep, atom->x[i][0], atom->x[i][1],
                   atom->x[i][2], atom->v[i][0], atom->v[i][1], atom->v[i][2]);
      std::copy_n(F + 9 * p, 9, points->F[i]);
      std::copy_n(tau + 6 * p, 6, points->tau[i]);
      for (int k = 0; k < material->nhistory; k++) material->history[i][k] = b.history[k][p];
    }
  });
}

void MPMMeshBody::load_state(const int *list, int n, const FixMPMMaterial *material) const
{
  Batch &b = *batch;
  b.n = n;
  b.dt = update->dt;
  b.h = shortest;
  b.history = reinterpret_cast<double(*)[BATCH]>(const_cast<double *>(history.data()));
  for (int p = 0; p < n; p++) {
    const int i = list[p];
    for (int c = 0; c < 9; c++) b.F[c][p] = points->F[i][c];
    b.J[p] = points->jacobian(i);
    for (int c = 0; c < 6; c++) b.stress[c][p] = points->tau[i][c] / b.J[p];
    b.vol0[p] = atom->vfrac[i];
    for (int k = 0; k < material->nhistory; k++) b.history[k][p] = material->history[i][k];
  }
}

/** h/(c + |v|) with the height of the cell; in the total frame it shrinks with the smallest
 *  stretch, and points stay in their cells. */
double MPMMeshBody::stable_dt(tagint &tag) const
{
  // at the end of a step points have moved since their cells were found, unless there was a new
  // neighbor list
  const auto cell_now = [this](int i) {
    BackgroundMesh::Place place = places[i];
    if (!options.total) mesh.find(position(i), places[i].cell, place);
    return place.cell < 0 ? places[i].cell : place.cell;
  };

  double smallest = std::numeric_limits<double>::max(), c[BATCH];
  tag = 0;
  for_batches(order, [&](const int *list, int n, const FixMPMMaterial *material) {
    load_state(list, n, material);
    material->material->wave_speed(*batch, c);
    for (int p = 0; p < n; p++) {
      const int i = list[p];
      double h = mesh.cells[cell_now(i)].height, speed = c[p];
      if (options.total) {
        const double *const F = points->F[i];
        const double cofactors[9] = MPM_COFACTORS(F), inv = 1.0 / dot(F, cofactors);
        double rows[3][3];
        for (int k = 0; k < 9; k++) rows[k / 3][k % 3] = inv * cofactors[k];
        h /= std::sqrt(ElementRule::of(ElementType::TRIANGLE).largest_eigenvalue(rows));
      } else {
        speed += std::sqrt(dot(atom->v[i], atom->v[i]));
      }
      const double dt = speed > 0.0 ? h / speed : std::numeric_limits<double>::max();
      if (std::isnan(smallest) || dt >= smallest) continue;    // NaN does not pass unseen
      smallest = dt;
      tag = atom->tag[i];
    }
  });
  return smallest;
}

double MPMMeshBody::memory_usage() const
{
  return ranks.memory_usage() + bytes_of(places, sums, before, after, mapped) +
      (fbar ? fbar->memory_usage() : 0.0);
}
