/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/background_mesh.h"

#include "math/matrix.h"
#include "mesh/element.h"
#include "mesh/vector3.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

using namespace MPM_NS;
using namespace MPM_NS::vector3;

namespace {

/** Sides of an element, outward. */
struct Sides {
  int count, nnode;
  int node[6][4];
};
const Sides &sides_of(ElementType type)
{
  static const Sides of[4] = {
      {3, 2, {{0, 1}, {1, 2}, {2, 0}}},                        // triangle
      {4, 2, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}},                // quadrangle
      {4, 3, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}},    // tetrahedron
      {6, 4, {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}}};
  return of[static_cast<int>(type)];
}

BackgroundMesh::Face side_of(const BackgroundMesh::Cell &cell, int number, int side)
{
  const auto &sides = sides_of(cell.type);
  BackgroundMesh::Face face = {number, sides.nnode, {}};
  for (int k = 0; k < sides.nnode; k++) face.node[k] = cell.node[sides.node[side][k]];
  return face;
}

/** Side of a simplex that is opposite to a node. */
int opposite(int dim, int k)
{
  static constexpr int side[2][4] = {{1, 2, 0, -1}, {2, 3, 1, 0}};
  return side[dim - 2][k];
}
/** Side of a square or cube where coordinate d is -1 or 1. */
int side_at(int dim, int d, bool high)
{
  static constexpr int square[2][2] = {{3, 1}, {0, 2}}, cube[3][2] = {{5, 3}, {2, 4}, {0, 1}};
  return dim == 2 ? square[d][high] : cube[d][high];
}

bool is_simplex(const BackgroundMesh::Cell &cell, int dim)
{
  return cell.nnode == dim + 1;
}

/** y = J^-1 b for the columns of J; returns det J. In the plane the third row and column are those
 *  of the identity. */
double solve(const double J[9], const double *b, double *y)
{
  const double C[9] = MPM_COFACTORS(J);
  const double det = dot(J, C), inv = 1.0 / det;
  for (int i = 0; i < 3; i++) y[i] = inv * (C[i] * b[0] + C[3 + i] * b[1] + C[6 + i] * b[2]);
  return det;
}

/** J_ab = dx_a/dxi_b. */
void jacobian(const BackgroundMesh &mesh, const BackgroundMesh::Cell &cell, const double (*dN)[3],
              double J[9])
{
  std::fill_n(J, 9, 0.0);
  if (mesh.dim == 2) J[8] = 1.0;
  for (int k = 0; k < cell.nnode; k++)
    for (int a = 0; a < mesh.dim; a++)
      for (int b = 0; b < mesh.dim; b++) J[3 * a + b] += mesh.nodes[cell.node[k]][a] * dN[k][b];
}

/** The map of the natural coordinates of a square or cube to places, and whether it is linear. */
void find_map(const BackgroundMesh &mesh, BackgroundMesh::Cell &cell)
{
  double bent = 0.0;
  for (int a = 0; a < 3; a++) {
    for (int m = 0; m < 8; m++) {
      double sum = 0.0;
      for (int k = 0; k < cell.nnode; k++) {
        const int *const c = CUBE_CORNER[k];
        const int terms[8] = {1,           c[0],        c[1],        c[2],
                              c[0] * c[1], c[1] * c[2], c[2] * c[0], c[0] * c[1] * c[2]};
        // in the plane, all corners have the same third coordinate, and terms with it are others
        // again
        const bool there = mesh.dim == 3 || m < 3 || m == 4;
        sum += there ? terms[m] * mesh.nodes[cell.node[k]][a] : 0.0;
      }
      cell.map[m][a] = sum / cell.nnode;
      if (m > 3) bent = std::max(bent, std::fabs(cell.map[m][a]));
    }
  }
  double size = 0.0;
  for (int a = 0; a < 3; a++) size = std::max(size, cell.high[a] - cell.low[a]);
  cell.parallel = bent < 1.0e-15 * size;
}

/** r = x less the place of xi, and J_ab = dx_a/dxi_b. */
void map_back(const BackgroundMesh::Cell &cell, int dim, const double *x, const double *xi,
              double *r, double *J)
{
  const auto &m = cell.map;
  if (dim == 2) {
    for (int a = 0; a < 2; a++) {
      r[a] = x[a] - (m[0][a] + m[1][a] * xi[0] + (m[2][a] + m[4][a] * xi[0]) * xi[1]);
      J[3 * a] = m[1][a] + m[4][a] * xi[1];
      J[3 * a + 1] = m[2][a] + m[4][a] * xi[0];
      J[3 * a + 2] = J[6 + a] = 0.0;
    }
    J[8] = 1.0;
    return;
  }
  for (int a = 0; a < 3; a++) {
    // those that go on along zeta
    const double along = m[3][a] + m[5][a] * xi[1] + (m[6][a] + m[7][a] * xi[1]) * xi[0];
    r[a] = x[a] - (m[0][a] + m[1][a] * xi[0] + (m[2][a] + m[4][a] * xi[0]) * xi[1] + along * xi[2]);
    J[3 * a] = m[1][a] + m[4][a] * xi[1] + (m[6][a] + m[7][a] * xi[1]) * xi[2];
    J[3 * a + 1] = m[2][a] + m[4][a] * xi[0] + (m[5][a] + m[7][a] * xi[0]) * xi[2];
    J[3 * a + 2] = along;
  }
}

constexpr double SIMPLEX[4][3] = {{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/** The n <= 4 nodes of a side in ascending order, then -1. */
std::array<int, 4> key_of(const int *node, const int *local, int n)
{
  std::array<int, 4> key = {-1, -1, -1, -1};
  for (int k = 0; k < n; k++) {
    const int next = node[local ? local[k] : k];
    int place = k;
    for (; place > 0 && key[place - 1] > next; place--) key[place] = key[place - 1];
    key[place] = next;
  }
  return key;
}

}    // namespace

BackgroundMesh::BackgroundMesh(const Mesh &mesh, int dim, const std::string &part) : dim(dim)
{
  rest = mesh;
  add_cells(mesh, part);
  connect();
  sort_into_bins();
}

void BackgroundMesh::add_cells(const Mesh &mesh, const std::string &part)
{
  std::vector<const MeshElement *> chosen;
  if (part.empty())
    for (const auto &e : mesh.elements) chosen.push_back(&e);
  else
    chosen = elements_of(part);

  place_of.assign(mesh.nodes.size(), -1);
  for (const auto *e : chosen)
    for (int k = 0; k < element_nodes(e->type) && element_dimension(e->type) == dim; k++)
      place_of[e->node[k]] = 0;
  for (std::size_t i = 0; i < mesh.nodes.size(); i++)
    if (place_of[i] == 0) {
      place_of[i] = (int) nodes.size();
      nodes.push_back(mesh.nodes[i]);
      if (dim == 2) nodes.back()[2] = 0.0;
    }

  for (const auto *e : chosen) {
    if (element_dimension(e->type) != dim) continue;
    Cell cell = {};
    cell.type = e->type;
    cell.nnode = element_nodes(e->type);
    cell.nface = sides_of(e->type).count;
    cell.label = e->label;
    std::fill_n(cell.neighbor, 6, -1);
    for (int k = 0; k < cell.nnode; k++) cell.node[k] = place_of[e->node[k]];
    cell.low = cell.high = nodes[cell.node[0]];
    for (int k = 1; k < cell.nnode; k++) include(nodes[cell.node[k]], cell.low, cell.high);

    // the volume at each corner of a square or cube: shape functions must have a place for each
    // point
    const bool simplex = is_simplex(cell, dim);
    double volume = 0.0, N[8], dN[8][3], J[9], none[3] = {0.0, 0.0, 0.0}, y[3];
    for (int k = 0; k < (simplex ? 1 : cell.nnode); k++) {
      double corner[3];
      std::copy_n(CUBE_CORNER[k], 3, corner);
      if (!simplex) cube_functions(dim, corner, N, dN);
      jacobian(*this, cell, simplex ? SIMPLEX : dN, J);
      const double det = solve(J, none, y);
      if (!(det > 0.0))
        throw std::runtime_error("element " + std::to_string(e->label) +
                                 " of the mesh has no volume, or is folded");
      volume += simplex ? det / (dim == 2 ? 2.0 : 6.0) : det;
    }
    double largest = 0.0;
    for (int s = 0; s < cell.nface; s++) {
      double normal[3], share[4];
      area(side_of(cell, 0, s), nodes, normal, share);
      largest = std::max(largest, norm(normal));
    }
    cell.height = (simplex ? dim : 1.0) * volume / largest;
    if (!simplex) find_map(*this, cell);
    cells.push_back(cell);
  }
  if (cells.empty())
    throw std::runtime_error("the mesh has no elements of dimension " + std::to_string(dim) +
                             (part.empty() ? "" : " in the physical group " + part));
}

/** Neighbors across faces. */
void BackgroundMesh::connect()
{
  std::map<std::array<int, 4>, std::pair<int, int>> open;
  std::map<std::array<int, 4>, bool> shut;
  for (int c = 0; c < (int) cells.size(); c++) {
    const auto &sides = sides_of(cells[c].type);
    for (int s = 0; s < sides.count; s++) {
      const auto key = key_of(cells[c].node, sides.node[s], sides.nnode);
      const auto found = open.find(key);
      if (found == open.end()) {
        if (shut.count(key))
          throw std::runtime_error("element " + std::to_string(cells[c].label) +
                                   " of the mesh has a side that belongs to two others");
        open[key] = {c, s};
        continue;
      }
      const auto [other, side] = found->second;
      cells[c].neighbor[s] = other;
      cells[other].neighbor[side] = c;
      open.erase(found);
      shut[key] = true;
    }
  }
}

/** About one cell in each. */
void BackgroundMesh::sort_into_bins()
{
  Vector high = nodes[0];
  low = nodes[0];
  for (const auto &x : nodes) include(x, low, high);
  double volume = 1.0;
  for (int d = 0; d < dim; d++) volume *= high[d] - low[d];
  const double width = std::pow(volume / (double) cells.size(), 1.0 / dim);
  for (int d = 0; d < 3; d++) {
    nbin[d] = d < dim ? std::max(1, (int) std::min(1000.0, (high[d] - low[d]) / width)) : 1;
    size[d] = d < dim ? (high[d] - low[d]) / nbin[d] : 1.0;
  }
  const auto visit = [&](const Cell &cell, auto act) {
    int from[3], to[3];
    for (int d = 0; d < 3; d++) {
      const double more = 0.1 * (cell.high[d] - cell.low[d]);
      const auto bin_at = [&](double x) {
        return std::clamp((int) std::floor((x - low[d]) / size[d]), 0, nbin[d] - 1);
      };
      from[d] = bin_at(cell.low[d] - more);
      to[d] = bin_at(cell.high[d] + more);
    }
    for (int z = from[2]; z <= to[2]; z++)
      for (int y = from[1]; y <= to[1]; y++)
        for (int x = from[0]; x <= to[0]; x++) act((z * nbin[1] + y) * nbin[0] + x);
  };
  first_in_bin.assign((std::size_t) nbin[0] * nbin[1] * nbin[2] + 1, 0);
  for (const auto &cell : cells)
    visit(cell, [&](int bin) {
      first_in_bin[bin + 1]++;
    });
  for (std::size_t k = 1; k < first_in_bin.size(); k++) first_in_bin[k] += first_in_bin[k - 1];
  in_bin.resize(first_in_bin.back());
  auto next = first_in_bin;
  for (int c = 0; c < (int) cells.size(); c++)
    visit(cells[c], [&](int bin) {
      in_bin[next[bin]++] = c;
    });
}

/** Natural coordinates of x: of a simplex those of the nodes but the first one, else from -1 to 1.
 *  Returns by which share of its width x is outside, and across which side to go to it. */
double BackgroundMesh::natural(const Cell &cell, const double *x, double *xi, int &across) const
{
  double J[9], r[3] = {0.0, 0.0, 0.0}, y[3];
  across = -1;
  if (is_simplex(cell, dim)) {
    jacobian(*this, cell, SIMPLEX, J);
    for (int d = 0; d < dim; d++) r[d] = x[d] - nodes[cell.node[0]][d];
    solve(J, r, xi);
    double lowest = 1.0, first = 1.0;
    for (int k = 1; k <= dim; k++) first -= xi[k - 1];
    for (int k = 0; k <= dim; k++) {
      const double N = k == 0 ? first : xi[k - 1];
      if (N >= lowest) continue;
      lowest = N;
      across = opposite(dim, k);
    }
    return std::max(0.0, -lowest);
  }

  // Newton's method, whose error is squared in each step; what is far away needs the direction only
  for (int d = 0; d < 3; d++) xi[d] = 0.0;
  for (int step = 0; step < 30; step++) {
    map_back(cell, dim, x, xi, r, J);
    solve(J, r, y);
    double most = 0.0;
    for (int d = 0; d < dim; d++) {
      const double before = xi[d];
      xi[d] = std::clamp(xi[d] + y[d], -2.0, 2.0);
      most = std::max(most, std::fabs(xi[d] - before));
    }
    if (cell.parallel || most < 1.0e-8) break;
  }
  double farthest = 0.0;
  for (int d = 0; d < dim; d++)
    if (std::fabs(xi[d]) > farthest) {
      farthest = std::fabs(xi[d]);
      across = side_at(dim, d, xi[d] > 0.0);
    }
  return std::max(0.0, 0.5 * (farthest - 1.0));
}

/** Shape functions and gradients at a place that is in the cell. */
void BackgroundMesh::evaluate(const Cell &cell, const double *xi, Place &place) const
{
  double dN[8][3], J[9];
  const bool simplex = is_simplex(cell, dim);
  if (simplex) {
    place.N[0] = 1.0;
    for (int k = 1; k <= dim; k++) {
      place.N[k] = xi[k - 1];
      place.N[0] -= xi[k - 1];
    }
    jacobian(*this, cell, SIMPLEX, J);
  } else {
    const double none[3] = {0.0, 0.0, 0.0};
    double r[3];
    cube_functions(dim, xi, place.N, dN);
    map_back(cell, dim, none, xi, r, J);
  }
  const double C[9] = MPM_COFACTORS(J), inv = 1.0 / dot(J, C);
  const double(*const d)[3] = simplex ? SIMPLEX : dN;
  for (int k = 0; k < cell.nnode; k++)
    for (int a = 0; a < 3; a++)
      place.g[k][a] = a < dim
          ? inv * (C[3 * a] * d[k][0] + C[3 * a + 1] * d[k][1] + C[3 * a + 2] * d[k][2])
          : 0.0;
}

void BackgroundMesh::find(const double *x, int hint, Place &place) const
{
  double xi[3], best_xi[3] = {0.0, 0.0, 0.0};
  int best = -1;
  double least = std::numeric_limits<double>::max();
  const auto look = [&](int c, int &across) {
    const double outside = natural(cells[c], x, xi, across);
    if (outside < least) {
      least = outside;
      best = c;
      std::copy_n(xi, 3, best_xi);
    }
    return outside;
  };

  // a walk ends where it would leave the mesh, around a corner of which the point may still be
  // inside
  int across;
  const int longest = 100;
  for (int c = hint, n = 0; c >= 0 && n < longest; n++) {
    if (look(c, across) == 0.0) break;
    c = cells[c].neighbor[across];
  }
  if (least > 0.0) {
    int bin = 0;
    bool near = true;
    for (int d = 2; d >= 0; d--) {
      const int k = d < dim ? (int) std::floor((x[d] - low[d]) / size[d]) : 0;
      near = near && k >= -1 && k <= nbin[d];
      bin = bin * nbin[d] + std::clamp(k, 0, nbin[d] - 1);
    }
    for (int k = first_in_bin[bin]; near && k < first_in_bin[bin + 1] && least > 0.0; k++) {
      const auto &cell = cells[in_bin[k]];
      bool in_reach = true;
      for (int d = 0; d < dim; d++) {
        const double more = 0.1 * (cell.high[d] - cell.low[d]);
        in_reach = in_reach && x[d] >= cell.low[d] - more && x[d] <= cell.high[d] + more;
      }
      if (in_reach) look(in_bin[k], across);
    }
  }
  place.cell = best;
  if (best < 0) return;
  place.outside = least;
  const auto &cell = cells[best];
  if (least > 0.0) {    // to its rim
    if (is_simplex(cell, dim)) {
      double first = 1.0, sum;
      for (int d = 0; d < dim; d++) {
        first -= best_xi[d];
        best_xi[d] = std::max(0.0, best_xi[d]);
      }
      sum = std::max(0.0, first);
      for (int d = 0; d < dim; d++) sum += best_xi[d];
      for (int d = 0; d < dim; d++) best_xi[d] /= sum;
    } else {
      for (int d = 0; d < dim; d++) best_xi[d] = std::clamp(best_xi[d], -1.0, 1.0);
    }
  }
  evaluate(cell, best_xi, place);
}

std::vector<const MeshElement *> BackgroundMesh::elements_of(const std::string &group) const
{
  std::vector<const MeshElement *> list;
  for (const auto &set : rest.sets)
    if (set.name == group)
      for (const int k : set.elements) list.push_back(&rest.elements[k]);
  if (!list.empty()) return list;
  char *end;
  const int tag = (int) strtol(group.c_str(), &end, 10);
  const bool number = !group.empty() && *end == 0;
  std::string names;
  for (const auto &e : rest.elements) {
    const auto name = rest.groups.find({element_dimension(e.type), e.physical});
    if ((name != rest.groups.end() && name->second == group) ||
        (number && e.physical != 0 && e.physical == tag))
      list.push_back(&e);
  }
  if (!list.empty()) return list;
  for (const auto &[key, name] : rest.groups) names += " " + name;
  for (const auto &set : rest.sets) names += " " + set.name;
  throw std::runtime_error("the mesh has no elements in a physical group or set '" + group +
                           "'; it has" + (names.empty() ? " none" : ":" + names));
}

std::vector<int> BackgroundMesh::nodes_of(const std::string &group) const
{
  std::vector<int> list;
  for (const auto *e : elements_of(group))
    for (int k = 0; k < element_nodes(e->type); k++)
      if (place_of[e->node[k]] >= 0) list.push_back(place_of[e->node[k]]);
  if (list.empty())
    throw std::runtime_error("no node of the physical group '" + group + "' belongs to a cell");
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

std::vector<BackgroundMesh::Face> BackgroundMesh::faces_of(const std::string &group) const
{
  std::map<std::array<int, 4>, std::pair<int, int>> side;
  for (int c = 0; c < (int) cells.size(); c++) {
    const auto &sides = sides_of(cells[c].type);
    for (int s = 0; s < sides.count; s++)
      side[key_of(cells[c].node, sides.node[s], sides.nnode)] = {c, s};
  }
  std::vector<Face> list;
  for (const auto *e : elements_of(group)) {
    const int n = element_nodes(e->type);
    const std::string name =
        "element " + std::to_string(e->label) + " of the physical group '" + group + "'";
    int node[8] = {};
    for (int k = 0; k < n; k++) node[k] = place_of[e->node[k]];
    const auto found = element_dimension(e->type) == dim - 1 ? side.find(key_of(node, nullptr, n))
                                                             : side.end();
    if (found == side.end()) throw std::runtime_error(name + " is not the side of a cell");
    const auto [c, s] = found->second;
    if (cells[c].neighbor[s] >= 0)
      throw std::runtime_error(name + " is between two cells, and not at the rim of the mesh");
    list.push_back(side_of(cells[c], c, s));
  }
  return list;
}

/** A quadrangle need not be flat: its area vector is half the cross product of its diagonals, and
 *  the integral of each of its functions is that over the bilinear surface, here by 2 x 2 points
 *  along that vector. */
void BackgroundMesh::area(const Face &face, const std::vector<std::array<double, 3>> &positions,
                          double normal[3], double share[4]) const
{
  const auto at = [&](int k) -> const std::array<double, 3> & {
    return positions[face.node[k]];
  };
  for (int k = 0; k < face.nnode; k++) share[k] = 1.0 / face.nnode;
  if (dim == 2) {
    normal[0] = at(1)[1] - at(0)[1];
    normal[1] = at(0)[0] - at(1)[0];
    normal[2] = 0.0;
    return;
  }
  const Vector a = (face.nnode == 3 ? at(1) : at(2)) - at(0),
               b = face.nnode == 3 ? at(2) - at(0) : at(3) - at(1);
  cross(a.data(), b.data(), normal);
  for (int d = 0; d < 3; d++) normal[d] *= 0.5;
  if (face.nnode == 3) return;
  const double all = dot(normal, normal);
  std::fill_n(share, 4, 0.0);
  for (int q = 0; q < 4; q++) {
    const double xi[3] = {CUBE_CORNER[q][0] / std::sqrt(3.0), CUBE_CORNER[q][1] / std::sqrt(3.0)};
    double N[8], dN[8][3], u[3] = {0.0}, v[3] = {0.0}, w[3];
    cube_functions(2, xi, N, dN);
    for (int k = 0; k < 4; k++)
      for (int d = 0; d < 3; d++) {
        u[d] += at(k)[d] * dN[k][0];
        v[d] += at(k)[d] * dN[k][1];
      }
    cross(u, v, w);
    for (int k = 0; k < 4; k++) share[k] += N[k] * dot(w, normal) / all;
  }
}
