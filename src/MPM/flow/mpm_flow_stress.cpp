/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_stress.h"

#include "field/mpm_node_system.h"
#include "flow/mpm_flow_regions.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// shortest distance of the surface from the middle of a cell that masses use, in spacings
static constexpr double NEAREST = 0.1;

MPMFlowStress::MPMFlowStress(LAMMPS *lmp, const MPMFlowLattice &cells,
                             const MPMFlowPressure &water) :
    lmp(lmp),
    cells(cells), water(water), dim(cells.lattice.dim), width(dim * (dim + 1) / 2)
{
}

/** Lengths of wet cells along each axis: up to the middle between two of them, to a wall, or to the
 *  surface. */
void MPMFlowStress::find_lengths()
{
  length.assign(cells.size() * dim, 0.0);
  for (const auto &cell : cells.cells) {
    if (!water.is_wet(cell.number)) continue;
    for (int s = 0; s < 2 * dim; s++) {
      const int other = cell.near[s];
      const bool surface =
          !(cell.walls >> s & 1) && !water.is_wet(other) && aperture_of_side(cell, s) > 0.0;
      length[(int64_t) cell.number * dim + s / 2] +=
          surface ? std::max(NEAREST, water.distance(cell.number, other)) : 0.5;
    }
  }
  cells.publish(length.data(), dim);
}

/* ----------------------------------------------------------------------
   Faces next to water, with their masses. Along its axis, a face reaches from middle to middle of
   its cells or to the surface; along the other axes, it is as long as the cells on its sides.
------------------------------------------------------------------------- */

void MPMFlowStress::find_faces()
{
  faces.clear();
  inverse_mass.assign(cells.size() * dim, 0.0);
  for (const auto &cell : cells.cells)
    for (int c = 0; c < dim; c++) {
      if (cell.walls >> 2 * c & 1) continue;
      const int64_t here = cell.number, lower = cell.near[2 * c];
      const bool in = water.is_wet(here), below = water.is_wet(lower);
      if ((!in && !below) || is_wall(here * dim + c) || is_held(here * dim + c)) continue;
      double mass = 1.0;
      if (!in) mass = std::max(NEAREST, water.distance(lower, here));
      if (!below) mass = std::max(NEAREST, water.distance(here, lower));
      double across[3] = {1.0, 1.0, 1.0};
      for (int d = 0; d < dim; d++) {
        if (d == c) continue;
        across[d] = (length[here * dim + d] + length[lower * dim + d]) / (in && below ? 2.0 : 1.0);
        mass *= across[d];
      }
      Face face = {};
      face.at = here * dim + c;
      const double inside = mass * aperture(face.at);
      if (stick) mass *= stick->mass(face.at);
      double wall_mass = 0.0;
      if (stick && stick->drag(face.at) > 0.0)
        wall_mass = number * at_face(here, lower) * mass * stick->drag(face.at);
      if (wall_mass > 0.0) face.wall = wall_mass * stick->velocity(face.at);
      for (int d = 0; d < dim; d++)
        for (int s = 0; d != c && s < 2; s++) {
          const auto &wall = cells.walls[d][s];
          if (!(cell.walls >> (2 * d + s) & 1)) continue;
          double distance = 0.5, v = wall.v[c];
          bool sticks = wall.sticks;
          if (stick) {    // a region can be in front of the wall of the box
            const int64_t image = (int64_t) cell.near[2 * d + s] * dim + c;
            const auto gap = stick->between(face.at, image);
            if (gap.length < distance) {
              distance = gap.length;
              v = -gap.wall;
              sticks = true;
            }
          }
          if (!sticks) continue;
          const double thick = at_edge(s ? cell.near[2 * d + 1] : here, pair_of(c, d)),
                       drag = number * thick * inside / (distance * across[d]);
          wall_mass += drag;
          face.wall += drag * v;
        }
      if (inverse_density) mass /= (*inverse_density)[face.at];
      face.inverse = inverse_mass[face.at] = 1.0 / (mass + wall_mass);
      face.share = mass * face.inverse;
      face.wall *= face.inverse;
      faces.push_back(face);
    }
  cells.publish(inverse_mass.data(), dim);
}

/* ----------------------------------------------------------------------
   Normal stresses are in wet cells, shear stresses where three of the four cells around are wet,
   except at edges in walls.
------------------------------------------------------------------------- */

void MPMFlowStress::find_stresses()
{
  normals.clear();
  edges.clear();
  volumes.assign(cells.size() * width, 0.0);
  if (stick) carried.assign(cells.size() * width, 0.0);
  const int here_around = dim == 2 ? 4 : 13, naround = dim == 2 ? 9 : 27;
  for (std::size_t k = 0; k < cells.cells.size(); k++) {
    const auto &cell = cells.cells[k];
    const int *const around = cells.around.data() + k * naround + here_around;
    const int64_t here = cell.number;
    if (water.is_wet(here)) {
      Normal one = {};
      one.at = here * width;
      one.volume = 1.0;
      for (int d = 0; d < dim; d++) {
        one.volume *= length[here * dim + d];
        one.lower[d] = here * dim + d;
        one.upper[d] = (int64_t) cell.near[2 * d + 1] * dim + d;
      }
      one.volume_fraction = stick ? stick->volume_fraction(here) : 1.0;
      std::fill_n(volumes.begin() + one.at, dim, one.volume);
      const auto wall = [&](int64_t face, int side) {
        const bool open_too = is_wall(face) && !(cell.walls >> side & 1);
        return water.regions->flux(face / dim, face % dim) +
            (open_too ? aperture(face) * stick->velocity(face) : 0.0);
      };
      for (int d = 0; stick && d < dim; d++)
        carried[one.at + d] =
            one.volume * (wall(one.upper[d], 2 * d + 1) - wall(one.lower[d], 2 * d));
      one.compliance = one.volume * one.volume_fraction * (0.5 / (number * in_cell(here)));
      normals.push_back(one);
    }
    for (int c = 0; c < dim; c++)
      for (int d = c + 1; d < dim; d++) {
        if (cell.walls >> 2 * c & 1 || cell.walls >> 2 * d & 1) continue;
        const int step_c = MPMFlowLattice::STRIDE[dim - 2][c],
                  step_d = MPMFlowLattice::STRIDE[dim - 2][d];
        const int64_t left = around[-step_c], below = around[-step_d],
                      corner = around[-step_c - step_d];
        // two cells that meet at the edge alone do not hold each other
        int wet = 0, solid = 0;
        double third = 0.0;
        for (const int64_t one : {here, left, below, corner}) {
          wet += water.is_wet(one);
          solid += stick && water.regions->is_closed(one);
          if (dim == 3) third += length[one * dim + 3 - c - d];
        }
        if (wet == 0 || wet + solid < 3) continue;
        Edge edge;
        edge.at = here * width + dim + pair_of(c, d);
        edge.face[0] = here * dim + c;
        edge.face[1] = below * dim + c;
        edge.face[2] = here * dim + d;
        edge.face[3] = left * dim + d;
        edge.volume = dim == 3 ? third / wet : 1.0;
        for (int k = 0; k < 4; k++)
          edge.area[k] = edge.volume * shear_area(edge.face[k], k < 2 ? d : c);
        if (*std::max_element(edge.area, edge.area + 4) == 0.0) continue;    // in a wall
        volumes[edge.at] = edge.volume;
        if (stick) find_edge(edge, pair_of(c, d));
        edge.compliance = 2.0 * (0.5 / (number * at_edge(here, pair_of(c, d)))) * edge.volume;
        edges.push_back(edge);
      }
  }
  cells.publish(volumes.data(), width);
}

/** Open volume of a shear stress, and velocities of the wall there. */
void MPMFlowStress::find_edge(Edge &edge, int pair)
{
  const int64_t cell = edge.at / width;
  edge.volume *= stick->volume_fraction_at_edge(cell, pair);
  for (int k = 0; k < 4; k++)
    carried[edge.at] +=
        (k % 2 ? 1.0 : -1.0) * edge.area[k] * stick->velocity_near(cell, pair, edge.face[k]);
}

/** Numbers the stresses that exist. Vectors have only these, which are few on the lattice where a
 *  thread flows. */
void MPMFlowStress::find_rows()
{
  unknowns.clear();
  for (const auto &one : normals)
    for (int d = 0; d < dim; d++) unknowns.push_back(one.at + d);
  for (const auto &edge : edges) unknowns.push_back(edge.at);
  std::sort(unknowns.begin(), unknowns.end());
  const auto row_of = [&](int64_t at) {
    return (int) (std::lower_bound(unknowns.begin(), unknowns.end(), at) - unknowns.begin());
  };
  for (auto &one : normals) one.row = row_of(one.at);
  for (auto &edge : edges) edge.row = row_of(edge.at);
}

/** Finds the stresses that act on the faces of owned cells. */
void MPMFlowStress::find_forces()
{
  auto face = faces.begin();
  for (const auto &cell : cells.cells)
    for (int c = 0; c < dim; c++) {
      const int64_t here = cell.number;
      if (face == faces.end() || face->at != here * dim + c) continue;
      for (int d = 0; d < dim; d++) {
        const int upper = 2 * d, lower = 2 * d + 1;
        if (d == c) {
          face->from[upper] = here * width + c;
          face->from[lower] = (int64_t) cell.near[2 * c] * width + c;
        } else {
          const int pair = dim + pair_of(c, d);
          face->from[upper] = (int64_t) cell.near[2 * d + 1] * width + pair;
          face->from[lower] = here * width + pair;
        }
        const double share = d == c ? aperture(face->at) : shear_area(face->at, d);
        face->weight[upper] = share * volumes[face->from[upper]];
        face->weight[lower] = -share * volumes[face->from[lower]];
      }
      ++face;
    }
}

void MPMFlowStress::find_diagonal()
{
  inverse_diagonal.resize(size());
  const auto square = [](double x) {
    return x * x;
  };
  for (auto &one : normals) {
    double shares = 0.0;
    for (int d = 0; d < dim; d++) {
      const double from_faces = square(one.volume) *
          (square(aperture(one.lower[d])) * inverse_mass[one.lower[d]] +
           square(aperture(one.upper[d])) * inverse_mass[one.upper[d]]);
      if (several()) {
        inverse_diagonal[one.row + d] = 1.0 / (from_faces + one.compliance);
        shares += from_faces * inverse_diagonal[one.row + d];
      } else
        inverse_diagonal[one.row + d] = 1.0 /
            (from_faces + one.volume * one.volume_fraction * (1.0 - 1.0 / dim) / (2.0 * number));
    }
    // the inverse of diag(a + c) - c/dim, without the difference of numbers that are almost the
    // same
    one.coupling = shares > 0.0 ? one.compliance / shares : 0.0;
  }
  for (const auto &edge : edges) {
    double sum = 0.0;
    for (int k = 0; k < 4; k++) sum += square(edge.area[k]) * inverse_mass[edge.face[k]];
    inverse_diagonal[edge.row] = 1.0 / (sum + (several() ? edge.compliance : edge.volume / number));
  }
}

/* ---------------------------------------------------------------------- */

/** Difference of two flows through areas; to the last digit that of the velocities where the areas
 *  are the same. */
static double difference(const double *area, double upper, double lower)
{
  return area[0] == area[1] ? area[0] * (upper - lower) : area[0] * upper - area[1] * lower;
}

/** out += sign W E u. */
void MPMFlowStress::strain(const double *u, double *out, double sign) const
{
  for (const auto &one : normals)
    for (int d = 0; d < dim; d++)
      out[one.row + d] += sign * one.volume *
          (aperture(one.upper[d]) * u[one.upper[d]] - aperture(one.lower[d]) * u[one.lower[d]]);
  for (const auto &edge : edges) {
    const int64_t *const f = edge.face;
    out[edge.row] += sign *
        (difference(edge.area, u[f[0]], u[f[1]]) + difference(edge.area + 2, u[f[2]], u[f[3]]));
  }
}

/** Copies values to the lattice, and gets those of other ranks. */
void MPMFlowStress::spread(const double *x)
{
  for (std::size_t i = 0; i < unknowns.size(); i++) stress[unknowns[i]] = x[i];
  cells.renew(stress.data(), width);
}

/** Products are summed by blocks of the lattice. */
void MPMFlowStress::products(int n, const double *const *a, const double *const *b, double *value)
{
  mine.assign(n, 0.0);
  const int64_t reals = (int64_t) NODES_PER_BLOCK * width;
  for (std::size_t i = 0, end; i < unknowns.size(); i = end) {
    const int64_t last = (unknowns[i] / reals + 1) * reals;
    for (end = i; end < unknowns.size() && unknowns[end] < last;) end++;
    for (int k = 0; k < n; k++) {
      double sum = 0.0;
      for (std::size_t j = i; j < end; j++) sum += a[k][j] * b[k][j];
      mine[k] += sum;
    }
  }
  sum_in_order(lmp, n, mine.data(), rank_sums, value);
}

void MPMFlowStress::apply(const double *x, double *y)
{
  spread(x);
  for (const auto &face : faces) {
    double force = 0.0;
    for (int k = 0; k < 2 * dim; k++) force += face.weight[k] * stress[face.from[k]];
    speed[face.at] = face.inverse * force;
  }
  cells.renew(speed.data(), dim);
  for (const auto &one : normals) {
    double mean = 0.0;
    for (int d = 0; d < dim; d++) mean += x[one.row + d] / dim;
    for (int d = 0; d < dim; d++) y[one.row + d] = one.compliance * (x[one.row + d] - mean);
  }
  for (const auto &edge : edges) y[edge.row] = edge.compliance * x[edge.row];
  strain(speed.data(), y, -1.0);
}

void MPMFlowStress::precondition(const double *r, double *z)
{
  for (int64_t k = 0; k < size(); k++) z[k] = inverse_diagonal[k] * r[k];
  for (const auto &one : normals) {
    if (!several()) break;
    double sum = 0.0;
    for (int d = 0; d < dim; d++) sum += z[one.row + d];
    for (int d = 0; d < dim; d++)
      z[one.row + d] += one.coupling * inverse_diagonal[one.row + d] * sum;
  }
}

SolveReport MPMFlowStress::step(double new_number, std::vector<double> &velocity,
                                std::vector<double> &psi, const SolveGoal &goal)
{
  number = new_number;
  find_lengths();
  find_faces();
  find_stresses();
  find_rows();
  find_forces();
  find_diagonal();

  const auto walls_are = [&](bool move) {
    for (const auto &cell : cells.cells)
      for (int c = 0; stick && c < dim; c++) {
        const int64_t face = (int64_t) cell.number * dim + c;
        if (is_wall(face)) velocity[face] = move ? stick->velocity(face) : 0.0;
      }
  };
  walls_are(false);
  for (const auto &face : faces) velocity[face.at] = face.share * velocity[face.at] + face.wall;
  cells.publish(velocity.data(), dim);
  right_side.assign(size(), 0.0);
  solution.assign(size(), 0.0);
  stress.assign(cells.size() * width, 0.0);
  speed.assign(cells.size() * dim, 0.0);
  for (std::size_t i = 0; stick && i < unknowns.size(); i++) right_side[i] = carried[unknowns[i]];
  strain(velocity.data(), right_side.data(), 1.0);
  for (const auto &one : normals)
    for (int d = 0; water.sources && d < dim; d++)
      right_side[one.row + d] -=
          one.volume * cells.lattice.h * (*water.sources)[one.at / width] / dim;
  const SolveReport report = method.solve(*this, right_side.data(), solution.data(), goal);
  spread(solution.data());

  cells.keep_owned(velocity.data(), dim);
  walls_are(true);
  for (const auto &face : faces)
    for (int k = 0; k < 2 * dim; k++)
      velocity[face.at] += face.inverse * face.weight[k] * stress[face.from[k]];
  cells.publish(velocity.data(), dim);
  const double to_psi = -cells.lattice.h / dim;
  for (int64_t k = 0; k < cells.size(); k++)
    for (int d = 0; d < dim; d++) psi[k] += to_psi * stress[k * width + d];
  return report;
}

double MPMFlowStress::memory_usage() const
{
  return method.memory_usage() +
      bytes_of(faces, normals, edges, unknowns, length, inverse_mass, volumes, carried, speed,
               right_side, solution, stress, inverse_diagonal);
}
