/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "meshgrid/mpm_mesh_fbar.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "field/fix_mpm_material.h"
#include "math/matrix.h"
#include "meshgrid/mpm_mesh_body.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

void MPMMeshMeans::clear(int ngroup, int nvalue)
{
  groups = ngroup;
  width = 1 + nvalue;
  sums.resize(row(groups, 0));
  for (int group = 0; group < groups; group++)
    for (const int node : ranks.nodes) std::fill_n(&sums[row(group, node)], width, 0.0);
}

void MPMMeshMeans::add(int group, const BackgroundMesh::Place &place, double weight,
                       const double *values)
{
  const auto &cell = mesh.cells[place.cell];
  for (int k = 0; k < cell.nnode; k++) {
    double *const to = &sums[row(group, cell.node[k])];
    const double w = weight * place.N[k];
    to[0] += w;
    for (int j = 1; j < width; j++) to[j] += w * values[j - 1];
  }
}

void MPMMeshMeans::sum()
{
  for (int group = 0; group < groups; group++) ranks.sum(&sums[row(group, 0)], width);
}

double MPMMeshMeans::mean(int group, const BackgroundMesh::Place &place, int k) const
{
  const auto &cell = mesh.cells[place.cell];
  double all = 0.0;
  for (int j = 0; j < cell.nnode; j++) {
    const double *const from = &sums[row(group, cell.node[j])];
    if (from[0] > 0.0) all += place.N[j] * from[1 + k] / from[0];
  }
  return all;
}

MPMMeshFbar::MPMMeshFbar(MPMMeshBody &body) : body(body), means(body.mesh, body.ranks) {}

/** Of a matrix whose third row and column are those of identity in 2d. */
static double determinant_in(int dim, const double *F)
{
  return dim == 3 ? determinant(F) : F[0] * F[4] - F[1] * F[3];
}

/** F-bar (E.A. de Souza Neto, D. Peric, M. Dutko, D.R.J. Owen, Int. J. Solids Struct. 33 (1996)
 *  3277) with means <> over the points around, which are symmetric: the sum over points of w a <b>
 *  is that of w <a> b. In the total frame the strain of a point has the volume ratio <J> with the J
 *  that the motion of its nodes has there, weighted by initial volumes. The change of the stored
 *  energy is the sum of V0 tau : D with the dilatation d<J>/<J>, so that the force has the mean
 *  stress J <p> of Cauchy stresses p, and gradients with the motion of the nodes. In the updated
 *  frame it is the change of volume in the step that is averaged, by present volumes. In 2d these
 *  are changes in the plane, and p is the mean of the stresses there. */
void MPMMeshFbar::find_stress()
{
  const int dim = body.mesh.dim, ngroup = body.count_bodies() * (int) body.materials.size();
  means.clear(ngroup, 2);
  volumetric.resize(body.atom->nlocal);
  for (const int i : body.order) {
    Volumetric &mine = volumetric[i];
    const auto material =
        std::find(body.materials.begin(), body.materials.end(), body.material_of(i));
    mine.group = (int) (material - body.materials.begin()) * body.count_bodies() +
        (int) (body.rows_of(i) / body.mesh.nodes.size());
    const double *const t = body.points->tau[i], J = body.points->jacobian(i);
    double F[9];
    if (body.options.total) body.motion_of_nodes(body.places[i], F);
    mine.own = body.options.total ? determinant_in(dim, F) : 1.0;
    mine.weight = body.atom->vfrac[i] * (body.options.total ? 1.0 : J);
    const double values[2] = {(t[0] + t[1] + (dim == 3 ? t[2] : 0.0)) / (dim * J), mine.own};
    means.add(mine.group, body.places[i], mine.weight, values);
  }
  means.sum();
  for (const int i : body.order) {
    Volumetric &mine = volumetric[i];
    mine.stress = (body.options.total ? mine.own : body.points->jacobian(i)) *
        means.mean(mine.group, body.places[i], 0);
    mine.all = body.options.total ? means.mean(mine.group, body.places[i], 1) : 1.0;
  }
}

void MPMMeshFbar::find_strain(const std::vector<MeshVector> &velocities)
{
  const int dim = body.mesh.dim;
  const auto own_now = [&](int i) {
    const auto &place = body.places[i];
    double F[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    if (body.options.total) {
      body.motion_of_nodes(place, F);
    } else {
      const auto &one = body.mesh.cells[place.cell];
      for (int k = 0; k < one.nnode; k++) {
        const auto &v = velocities[body.rows_of(i) + one.node[k]];
        for (int d = 0; d < dim; d++)
          for (int e = 0; e < dim; e++) F[3 * d + e] += body.update->dt * v[d] * place.g[k][e];
      }
    }
    return determinant_in(dim, F);
  };
  means.clear(body.count_bodies() * (int) body.materials.size(), 1);
  for (const int i : body.order) {
    Volumetric &mine = volumetric[i];
    const double own = own_now(i);
    means.add(mine.group, body.places[i], mine.weight, &own);
    mine.scale = mine.own / (mine.all * own);
  }
  means.sum();
  for (const int i : body.order) {
    Volumetric &mine = volumetric[i];
    const double change = mine.scale * means.mean(mine.group, body.places[i], 0);
    mine.scale =
        std::pow(std::fabs(change), 1.0 / dim);    // what is inside out stays so, and is an error
  }
}

/** The velocity gradient of a point, column-major, becomes that of the motion with the mean change
 *  of volume. In the total frame it is the change of F in the step, where the nodes have moved on
 *  already. */
void MPMMeshFbar::scale(int i, double *L) const
{
  const int dim = body.mesh.dim;
  const double dt = body.update->dt, scale = volumetric[i].scale;
  if (!body.options.total) {
    for (int d = 0; d < dim; d++)
      for (int e = 0; e < dim; e++)
        L[dim * e + d] = scale * L[dim * e + d] + (d == e ? (scale - 1.0) / dt : 0.0);
    return;
  }
  double now[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}, old[9], step[9];
  body.motion_of_nodes(body.places[i], now);
  std::copy_n(now, 9, old);
  for (int d = 0; d < dim; d++)
    for (int e = 0; e < dim; e++) old[3 * d + e] -= dt * L[dim * e + d];
  const double cofactors[9] = MPM_COFACTORS(old), inv = 1.0 / determinant(old);
  for (int d = 0; d < 3; d++)
    for (int e = 0; e < 3; e++) {
      step[3 * d + e] = 0.0;
      for (int c = 0; c < 3; c++) step[3 * d + e] += now[3 * d + c] * inv * cofactors[3 * e + c];
    }
  const double *const F = body.points->F[i];
  for (int d = 0; d < dim; d++)
    for (int e = 0; e < dim; e++)
      L[dim * e + d] = (scale * product(step, F, d, e) - F[3 * d + e]) / dt;
}
