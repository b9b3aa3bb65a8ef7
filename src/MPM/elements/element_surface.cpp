/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "elements/element_surface.h"

#include "atom.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "math/matrix.h"
#include "math_extra.h"
#include "mesh/curved_surface.h"
#include "mesh/face_contact.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

namespace {

/** Normal of a triangle (in 2d: a line) whose magnitude is its area (length). at: [dim] corners. */
void area_vector(int dim, const double *const at[3], double *normal)
{
  double a[3], b[3];
  for (int d = 0; d < 3; d++) a[d] = at[1][d] - at[0][d];
  if (dim == 2) {
    normal[0] = a[1];
    normal[1] = -a[0];
    normal[2] = 0.0;
  } else {
    for (int d = 0; d < 3; d++) b[d] = at[2][d] - at[0][d];
    cross(a, b, normal);
    for (int d = 0; d < 3; d++) normal[d] *= 0.5;
  }
}

}    // namespace

ElementSurface::ElementSurface(LAMMPS *lmp, const ElementBody &body, const SurfaceKind &kind) :
    Pointers(lmp), kind(kind), dim(body.dim), body(body)
{
}

void ElementSurface::set_pressure(MPMElementsPressure *who, bool closed, const std::string &id)
{
  if (body.along != dim - 1)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/elements {} has no surface for a pressure: use the keyword thickness", id);
  if (pressure)
    error->all(FLERR, Error::NOLASTLINE, "Fix mpm/elements {} has more than one fix mpm/airbag",
               id);
  if (!kind.oriented)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/elements {}: its surface has no two sides: more than two elements meet at an "
        "edge, or it is a Moebius strip",
        id);
  if (closed && !kind.closed)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/elements {}: its surface has a rim, and encloses no gas: use a closed mesh, whose "
        "elements share their nodes, or fix mpm/airbag pressure",
        id);
  pressure = who;
}

template <class Visit> void ElementSurface::for_faces(Visit visit) const
{
  int known = -1;
  double here[3];
  for (std::size_t e = 0; e < body.nodes.size(); e++) {
    const int i = body.owner[e];
    if (i != known) domain->unmap(atom->x[i], atom->image[i], here);
    known = i;
    if (body.bends(body.row(e))) continue;
    const int nnode = body.rule_of(body.row(e)).nnode;
    double x[4][3];
    for (int m = 0; m < nnode; m++)
      for (int d = 0; d < 3; d++) x[m][d] = here[d] + atom->x[body.nodes[e][m]][d] - atom->x[i][d];
    for (int part = 0; part < (nnode == 4 ? 4 : 1); part++) {
      const double *at[3];
      int node[3];
      for (int m = 0; m < std::min(3, nnode); m++) {
        at[m] = x[SPLIT[part][m]];
        node[m] = body.nodes[e][SPLIT[part][m]];
      }
      visit(nnode == 4 ? 0.5 : 1.0, at, node);
    }
  }
}

double ElementSurface::widest_gap() const
{
  double widest = 0.0, all;
  for_faces([&](double, const double *const at[3], const int *) {
    const auto side = [&](int a, int b) {
      double edge[3];
      MathExtra::sub3(at[a], at[b], edge);
      return sqrt(dot(edge, edge));
    };
    widest = std::max(widest,
                      body.along == 1 ? 0.5 * side(0, 1)
                                      : triangle_gap(side(0, 1), side(1, 2), side(2, 0)));
  });
  MPI_Allreduce(&widest, &all, 1, MPI_DOUBLE, MPI_MAX, world);
  return all;
}

/** p times the gradient of the enclosed volume: a third (in 2d half) of the area for each node, and
 *  the gradient of the volume between the triangles and a curved surface, so that the work is p dV
 *  exactly. */
void ElementSurface::add_pressure(bool starting, double *sums, int width)
{
  double mine[2] = {0.0, 0.0}, all[2];
  for_faces([&](double weight, const double *const at[3], const int *) {
    double normal[3];
    area_vector(dim, at, normal);
    mine[0] += weight * dot(normal, at[0]) / dim;
    mine[1] += weight * sqrt(dot(normal, normal));
  });
  body.for_curved_edges(atom->x, [&](const double(*x)[3], const int *) {
    mine[0] += curved_volume(dim, x, 1.0, nullptr);
  });
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  if (side == 0.0) side = kind.closed && all[0] < 0.0 ? -1.0 : 1.0;
  const double volume = kind.closed ? side * all[0] : 0.0;
  const double p = pressure->on_surface(volume, all[1], starting);
  if (!starting) work += 0.5 * (p + pressure_before) * (volume - volume_before);
  pressure_before = p;
  volume_before = volume;
  const double factor = side * p / (force->nktv2p * dim);
  for_faces([&](double weight, const double *const at[3], const int *node) {
    double normal[3];
    area_vector(dim, at, normal);
    for (int m = 0; m < dim; m++)
      for (int d = 0; d < dim; d++)
        sums[(std::size_t) node[m] * width + width - 3 + d] += weight * factor * normal[d];
  });
  body.for_curved_edges(atom->x, [&](const double(*x)[3], const int *node) {
    double gradient[4][3] = {{0.0}};
    curved_volume(dim, x, factor * dim, gradient);
    for (int m = 0; m <= dim; m++)
      for (int d = 0; d < dim; d++)
        sums[(std::size_t) node[m] * width + width - 3 + d] += gradient[m][d];
  });
}

/** The gas in a closed surface is one spring between all of its nodes, of the stiffness k = -dp/dV
 *  along the gradient g of the volume: omega^2 = k sum_i g_i^2/m_i. For a thin bag, the limit
 *  follows from the size of the bag, whatever its mesh. */
double ElementSurface::volume_gradient(double *gradient) const
{
  double volume = 0.0;
  for_faces([&](double weight, const double *const at[3], const int *node) {
    double normal[3];
    area_vector(dim, at, normal);
    volume += weight * dot(normal, at[0]) / dim;
    for (int m = 0; m < dim; m++)
      for (int d = 0; d < dim; d++)
        gradient[3 * (std::size_t) node[m] + d] += weight * normal[d] / dim;
  });
  body.for_curved_edges(atom->x, [&](const double(*x)[3], const int *node) {
    double of_edge[4][3] = {{0.0}};
    volume += curved_volume(dim, x, 1.0, of_edge);
    for (int m = 0; m <= dim; m++)
      for (int d = 0; d < dim; d++) gradient[3 * (std::size_t) node[m] + d] += of_edge[m][d];
  });
  return volume;
}

double ElementSurface::gas_frequency(double volume, const double *gradient, int groupbit) const
{
  double mine[2] = {volume, 0.0}, all[2];
  for (int i = 0; i < atom->nlocal; i++)
    if (atom->mask[i] & groupbit) {
      const double *const g = &gradient[3 * (std::size_t) i];
      mine[1] += dot(g, g) / atom->rmass[i];
    }
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  const double square = pressure->stiffness(fabs(all[0])) * all[1];
  return sqrt(square * force->ftm2v / force->nktv2p);
}

/** Calls visit(weight, element, corners [3], x) for triangles as for_faces() does. x: positions of
 *  the nodes of the element relative to the first one, after the motion or before. */
template <class Visit>
void ElementSurface::for_moved_faces(const double *motion, const Visit &visit) const
{
  for (std::size_t e = 0; e < body.nodes.size(); e++) {
    const auto first = (std::size_t) body.nodes[e][0];
    const int nnode = body.nodes_of(body.row(e));
    double x[MAX_ELEMENT_NODES][3] = {{0.0}};
    for (int m = 0; m < nnode; m++)
      for (int d = 0; d < 3; d++) {
        const auto here = (std::size_t) body.nodes[e][m];
        x[m][d] = atom->x[here][d] - atom->x[first][d];
        if (motion && d < dim) x[m][d] += motion[3 * here + d] - motion[3 * first + d];
      }
    for (int part = 0; part < (nnode == 4 ? 4 : 1); part++)
      visit(nnode == 4 ? 0.5 : 1.0, e, SPLIT[part], x);
  }
}

/** Adds to sent, times a sign, the pressure of this step on the surfaces as they are after the
 *  motion or before. */
void ElementSurface::add_pressure_after(const double *motion, double sign, double *to) const
{
  for_moved_faces(motion, [&](double weight, std::size_t e, const int *corner, double(*x)[3]) {
    const double factor = weight * (sign * side * pressure_before / (force->nktv2p * dim));
    const double *const at[3] = {x[corner[0]], x[corner[1]], x[corner[2]]};
    double normal[3];
    area_vector(dim, at, normal);
    for (int m = 0; m < dim; m++)
      for (int d = 0; d < dim; d++)
        to[3 * (std::size_t) body.nodes[e][corner[m]] + d] += factor * normal[d];
  });
}

/** An enclosed volume has a symmetric second derivative, so each face gets the symmetric part. */
void ElementSurface::differentiate_pressure(const double *motion, double size_of_element,
                                            double *tangents) const
{
  const int size = body.maxnode * dim;
  for_moved_faces(motion, [&](double weight, std::size_t e, const int *corner, double(*x)[3]) {
    const double factor = weight * (side * pressure_before / (force->nktv2p * dim));
    const double *const at[3] = {x[corner[0]], x[corner[1]], x[corner[2]]};
    double high[3], low[3], K[9][9];
    for (int column = 0; column < dim * dim; column++) {
      // the area is linear, or bilinear, in the positions of nodes, so that differences of any
      // size are exact
      double &place = x[corner[column / dim]][column % dim];
      const double value = place;
      place = value + 0.5 * size_of_element;
      area_vector(dim, at, high);
      place = value - 0.5 * size_of_element;
      area_vector(dim, at, low);
      place = value;
      for (int row = 0; row < dim * dim; row++)
        K[row][column] = factor * (high[row % dim] - low[row % dim]) / size_of_element;
    }
    const auto local = [&](int k) {
      return dim * corner[k / dim] + k % dim;
    };
    for (int column = 0; column < dim * dim; column++)
      for (int row = 0; row < dim * dim; row++)
        tangents[e * size * size + (std::size_t) size * local(column) + local(row)] +=
            kind.closed ? 0.5 * (K[row][column] + K[column][row]) : K[row][column];
  });
}
