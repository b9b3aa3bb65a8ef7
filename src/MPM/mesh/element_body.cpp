/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */
#include "mesh/element_body.h"

#include "mesh/gmsh.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

using namespace MPM_NS;

// error of a slope relative to the effect of the curvature, from which on a triangle is rough
static constexpr double ROUGH = 0.05;

void ElementBody::count_nodes_and_points(const Mesh &mesh)
{
  for (const auto &e : mesh.elements) {
    const auto &rule = ElementRule::of(e.type);
    maxnode = std::max(maxnode, rule.nnode);
    maxpoint = std::max(maxpoint, rule.npoint);
  }
}

std::vector<int> ElementBody::choose_owners(const Mesh &mesh, int &most)
{
  std::vector<int> owned(mesh.nodes.size(), 0), owners;
  for (const auto &element : mesh.elements) {
    const int *const node = element.node,
                     n = element.type == ElementType::PATCH ? 3 : element_nodes(element.type);
    const int owner = *std::min_element(node, node + n, [&](int a, int b) {
      return owned[a] < owned[b];
    });
    most = std::max(most, ++owned[owner]);
    owners.push_back(owner);
  }
  return owners;
}

void ElementBody::set_history(int n)
{
  nhistory = n;
  stride = 2 + maxnode +
      std::max(maxnode * dim + maxpoint * point_size(),
               bending && along == 2 ? 1 + BentTriangle::size(bending == LINEAR) : 0) +
      (curved ? 1 : 0);
}

/** Square of the distance between two nodes of a row in the reference configuration. */
double ElementBody::square_between(const double *r, int k, int m) const
{
  const double *const X = r + 2 + maxnode;
  double square = 0.0;
  for (int d = 0; d < dim; d++)
    square += (X[k * dim + d] - X[m * dim + d]) * (X[k * dim + d] - X[m * dim + d]);
  return square;
}

int ElementBody::nodes_of(const double *r) const
{
  if (type_of(r) != ElementType::PATCH) return rule_of(r).nnode;
  BentTriangle bent;
  memcpy(&bent.n, bent_of(r), sizeof(bent.n));
  return bent.n;
}

std::vector<NearNodes::Edge> ElementBody::edges(int64_t low) const
{
  std::vector<NearNodes::Edge> all;
  for (std::size_t e = 0; e < size(); e++) {
    const double *const r = row(e);
    if (bends(r)) continue;
    for (int k = 0; k < rule_of(r).nnode; k++)
      for (int m = 0; m < k; m++)
        all.push_back(
            {(int64_t) r[2 + k] - low, (int64_t) r[2 + m] - low, sqrt(square_between(r, k, m))});
  }
  return all;
}

std::vector<ElementBody::Face> ElementBody::faces() const
{
  std::vector<Face> all;
  for (std::size_t e = 0; e < nodes.size(); e++)
    for_halves(row(e), [&](int part, int n) {
      all.push_back({(int64_t) row(e)[0], part, {}});
      for (int m = 0; m < n; m++) all.back().node[m] = nodes[e][SPLIT[part][m]];
    });
  return all;
}

void ElementBody::add_numbered_faces(std::size_t e, int64_t low,
                                     std::vector<NumberedFace> &faces) const
{
  const double *const r = row(e);
  for_halves(r, [&](int part, int n) {
    faces.push_back({(int64_t) r[0], part, {}});
    for (int m = 0; m < n; m++) faces.back().node[m] = (int64_t) r[2 + SPLIT[part][m]] - low;
  });
}

ElementBody::Extents ElementBody::extents() const
{
  Extents most;
  for (std::size_t e = 0; e < size(); e++) {
    double *const r = row(e);
    const auto &rule = rule_of(r);
    double square = 0.0, stretch = 0.0;
    if (bends(r)) {
      most.bent = std::max(most.bent, extent_of(r));
      continue;
    }
    for (int k = 0; k < rule.nnode; k++)
      for (int j = 0; j < k; j++) square = std::max(square, square_between(r, k, j));
    for (int q = 0; q < rule.npoint; q++) {
      double s = 0.0;
      const double *const F = state_of(r, q);
      for (int c = 0; c < (dim == 3 ? 9 : 5); c++) s += F[c] * F[c];
      stretch = std::max(stretch, s);
    }
    most.stretch = std::max(most.stretch, stretch);
    most.nodes = std::max(most.nodes, sqrt(square * stretch));
  }
  return most;
}

bool ElementBody::define_bending(double *r, const double (*X)[3], bool inside, int64_t &rough) const
{
  double *const to = bent_of(r);
  double nodes_of_all[PATCH_NODES], square = 0.0;
  int slots[PATCH_NODES];
  bool straight = true;
  std::iota(slots, slots + PATCH_NODES, 0);
  if (type_of(r) == ElementType::EDGE) {
    static_assert(sizeof(SharedStrain) <= sizeof(double) * BentTriangle::size(false),
                  "does not fit into a row");
    SharedStrain edge;
    edge.define(X);
    memcpy(to, &edge, sizeof(edge));
  } else if (type_of(r) == ElementType::PATCH) {
    static_assert(sizeof(BentTriangle) == sizeof(double) * BentTriangle::size(true),
                  "does not fit into a row");
    BentTriangle bent;
    bool has[PATCH_NODES - 3];
    for (int k = 0; k < PATCH_NODES - 3; k++) has[k] = r[2 + 3 + k] != r[2];
    rough += bent.define(X, has, inside, bending == LINEAR, slots) > ROUGH;
    memcpy(to, &bent, sizeof(double) * BentTriangle::size(bending == LINEAR));
    std::copy_n(r + 2, PATCH_NODES, nodes_of_all);
    for (int m = 0; m < bent.n; m++) r[2 + m] = nodes_of_all[slots[m]];
  } else {
    BentLine bent;
    bent.define(dim, X);
    straight = !(dim == 3 && bent.rest > 1.0e-6);
    memcpy(to, &bent, sizeof(bent));
  }
  const int nnode = nodes_of(r);
  for (int k = 0; k < nnode; k++)
    for (int m = 0; m < k; m++) {
      double s = 0.0;
      for (int d = 0; d < dim; d++) s += pow(X[slots[k]][d] - X[slots[m]][d], 2);
      square = std::max(square, s);
    }
  extent_of(r) = square;
  return straight;
}

BentTriangle ElementBody::bent_triangle(const double *r) const
{
  BentTriangle bent;
  memcpy(&bent, bent_of(r), sizeof(double) * BentTriangle::size(bending == LINEAR));
  return bent;
}

double ElementBody::bend(const double *r, const double (*x)[3], double (*f)[3]) const
{
  const double *const from = bent_of(r);
  if (type_of(r) == ElementType::PATCH) return bent_triangle(r).bend(stiffness, nu, x, f);
  if (type_of(r) == ElementType::EDGE) {
    SharedStrain edge;
    memcpy(&edge, from, sizeof(edge));
    return edge.energy(12.0 * stiffness / (across * across), nu, x, f);
  }
  BentLine bent;
  memcpy(&bent, from, sizeof(bent));
  return bent.bend(stiffness, dim, x, f);
}

void ElementBody::add_bending_sums(int64_t low, std::vector<double> &sum) const
{
  for (std::size_t e = 0; e < size(); e++) {
    double *const r = row(e), mine[PATCH_NODES];
    if (!bends(r) || type_of(r) == ElementType::EDGE) continue;    // edges make nothing stiffer
    if (type_of(r) == ElementType::PATCH) {
      bent_triangle(r).stiffness_sums(nu, mine);
    } else {
      BentLine bent;
      memcpy(&bent, bent_of(r), sizeof(bent));
      bent.stiffness_sums(mine);
    }
    for (int m = 0; m < nodes_of(r); m++) sum[(int64_t) r[2 + m] - low] += stiffness * mine[m];
  }
}
