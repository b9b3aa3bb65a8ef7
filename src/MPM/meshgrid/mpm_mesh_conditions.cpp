/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "meshgrid/mpm_mesh_conditions.h"

#include "base/mpm_options.h"
#include "math/matrix.h"
#include "meshgrid/mpm_mesh_ranks.h"

#include "comm.h"
#include "error.h"
#include "force.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// sides whose normals differ by less than 30 degrees are those of a curved wall, others meet at an
// edge

static constexpr double SMOOTH = 0.866;

static constexpr double LOST =
    0.01;    // share of a load on nodes without mass that leads to a warning

MPMMeshForces::MPMMeshForces(LAMMPS *lmp, const BackgroundMesh &mesh,
                             const std::vector<MPMMeshCondition> &conditions) :
    Pointers(lmp),
    mesh(mesh), place(mesh.nodes.size(), -1)
{
  for (const auto &c : conditions)
    list.push_back({c,
                    {0.0, 0.0, 0.0},
                    {0.0, 0.0, 0.0},
                    c.kind == MPMMeshCondition::PRESSURE ? npressure++ : -1,
                    {}});
  for (int k = 0; k < (int) list.size(); k++)
    if (list[k].given.kind == MPMMeshCondition::SLIP) add_slip(k);
  for (int k = 0; k < (int) list.size(); k++) {
    const auto kind = list[k].given.kind;
    if (kind == MPMMeshCondition::VELOCITY)
      for (const int node : mesh.nodes_of(list[k].given.group)) add(node, k);
    else if (kind != MPMMeshCondition::SLIP)
      add_sides(k);
  }
}

MPMMeshForces::NodeCondition &MPMMeshForces::add(int node, int condition)
{
  if (place[node] < 0) {
    place[node] = (int) conditions_at_nodes.size();
    conditions_at_nodes.emplace_back();
  }
  auto &all = conditions_at_nodes[place[node]];
  if (all.empty() || all.back().condition != condition)
    all.push_back({condition, {}, {0.0, 0.0, 0.0}, 0.0});
  return all.back();
}

/** A node where sides meet at an edge, or at walls of several conditions, has no velocity along any
 *  of their normals. */
void MPMMeshForces::add_slip(int condition)
{
  for (const auto &face : mesh.faces_of(list[condition].given.group)) {
    double normal[3], share[4];
    mesh.area(face, mesh.nodes, normal, share);
    for (int k = 0; k < face.nnode; k++) {
      auto &known = add(face.node[k], condition).normals;
      MeshVector *same = nullptr;
      for (auto &n : known)
        if (dot(n.data(), normal) >
            SMOOTH * std::sqrt(dot(n.data(), n.data()) * dot(normal, normal)))
          same = &n;
      if (!same) same = &known.emplace_back(MeshVector{0.0, 0.0, 0.0});
      for (int d = 0; d < 3; d++) (*same)[d] += share[k] * normal[d];
    }
  }
  for (auto &all : conditions_at_nodes) {
    if (all.back().condition != condition) continue;
    std::vector<MeshVector> right_angles, before;
    for (const auto &other : all)
      if (other.condition != condition)
        before.insert(before.end(), other.normals.begin(), other.normals.end());
    for (auto n : all.back().normals) {
      const double length = std::sqrt(dot(n.data(), n.data()));
      for (double &c : n) c /= length;
      for (const auto *others : {&before, &right_angles})
        for (const auto &o : *others) {
          const double along = dot(n.data(), o.data());
          for (int d = 0; d < 3; d++) n[d] -= along * o[d];
        }
      const double left = std::sqrt(dot(n.data(), n.data()));
      if (left < 1.0e-6) continue;    // the same plane
      for (double &c : n) c /= left;
      right_angles.push_back(n);
    }
    all.back().normals.swap(right_angles);
  }
}

void MPMMeshForces::add_sides(int condition)
{
  list[condition].sides = mesh.faces_of(list[condition].given.group);
  for (const auto &face : list[condition].sides) {
    double normal[3], share[4];
    mesh.area(face, mesh.nodes, normal, share);
    const double size = std::sqrt(dot(normal, normal));
    for (int k = 0; k < face.nnode; k++) {
      auto &mine = add(face.node[k], condition);
      for (int d = 0; d < 3; d++) mine.normal[d] += share[k] * normal[d];
      mine.area += share[k] * size;
    }
  }
}

void MPMMeshForces::init(const std::string &user)
{
  varies = false;
  for (auto &c : list)
    for (auto &value : c.given.value) {
      find_variable(lmp, value, user);
      varies = varies || !value.variable.empty();
    }
}

void MPMMeshForces::evaluate()
{
  evaluate_in_step(lmp, varies, [this] {
    for (auto &c : list)
      for (int d = 0; d < 3; d++)
        c.value[d] = c.given.value[d].given ? LAMMPS_NS::evaluate(lmp, c.given.value[d]) : 0.0;
  });
}

/** Each side once: by the rank that looks at its cell, for all that have its nodes. */
void MPMMeshForces::follow(const std::vector<char> &cells, const std::vector<MeshVector> &positions,
                           MPMMeshRanks &ranks)
{
  const int width = 3 * npressure;
  normals.resize(width * place.size());
  for (const int node : ranks.nodes) std::fill_n(&normals[(std::size_t) width * node], width, 0.0);
  for (const auto &c : list)
    for (const auto &face : c.sides) {
      if (c.number < 0 || !cells[face.cell]) continue;
      double normal[3], share[4];
      mesh.area(face, positions, normal, share);
      for (int k = 0; k < face.nnode; k++)
        for (int d = 0; d < 3; d++)
          normals[(std::size_t) width * face.node[k] + 3 * c.number + d] += share[k] * normal[d];
    }
  ranks.sum(normals.data(), width);
  for (const int node : ranks.nodes) {
    if (place[node] < 0) continue;
    for (auto &mine : conditions_at_nodes[place[node]]) {
      const int number = list[mine.condition].number;
      if (number >= 0)
        std::copy_n(&normals[(std::size_t) width * node + 3 * number], 3, mine.normal.data());
    }
  }
}

void MPMMeshForces::warn_of_lost_loads(const std::string &user,
                                       const std::function<bool(int)> &carries) const
{
  std::vector<double> all(list.size(), 0.0), mine(list.size(), 0.0), borne(list.size(), 0.0);
  for (int node = 0; node < (int) place.size(); node++) {
    if (place[node] < 0) continue;
    const bool there = carries(node);
    for (const auto &one : conditions_at_nodes[place[node]]) {
      all[one.condition] += one.area;
      if (there) mine[one.condition] += one.area;
    }
  }
  MPI_Allreduce(mine.data(), borne.data(), (int) mine.size(), MPI_DOUBLE, MPI_SUM, world);
  for (std::size_t k = 0; k < list.size() && comm->me == 0; k++)
    if (borne[k] < (1.0 - LOST) * all[k])
      error->warning(FLERR,
                     "{}: {} on {} acts on nothing in {:.3g} % of its area, where no points are "
                     "next to the sides of the mesh",
                     user,
                     list[k].given.kind == MPMMeshCondition::PRESSURE ? "pressure" : "traction",
                     list[k].given.group, 100.0 * (1.0 - borne[k] / all[k]));
}

void MPMMeshForces::add_load(int node, double share, bool count, double *f)
{
  if (place[node] < 0) return;
  const double unit = share / force->nktv2p;
  for (const auto &mine : conditions_at_nodes[place[node]]) {
    auto &c = list[mine.condition];
    if (c.given.kind == MPMMeshCondition::PRESSURE || c.given.kind == MPMMeshCondition::TRACTION)
      for (int d = 0; d < 3; d++) {
        const double part = c.given.kind == MPMMeshCondition::PRESSURE
            ? -unit * c.value[0] * mine.normal[d]
            : unit * c.value[d] * mine.area;
        f[d] += part;
        if (count) c.sum[d] += part;
      }
  }
}

void MPMMeshForces::constrain(int node, double mass_per_time, double *v)
{
  if (place[node] < 0) return;
  for (const auto &mine : conditions_at_nodes[place[node]]) {
    auto &c = list[mine.condition];
    const MeshVector before = {v[0], v[1], v[2]};
    if (c.given.kind == MPMMeshCondition::SLIP)
      for (const auto &n : mine.normals) {
        const double along = dot(n.data(), v);
        for (int d = 0; d < 3; d++) v[d] -= along * n[d];
      }
    else if (c.given.kind == MPMMeshCondition::VELOCITY)
      for (int d = 0; d < 3; d++)
        if (c.given.value[d].given) v[d] = c.value[d];
    for (int d = 0; d < 3; d++) c.sum[d] += mass_per_time * (v[d] - before[d]);
  }
}

bool MPMMeshForces::has_loads() const
{
  return std::any_of(list.begin(), list.end(), [](const Active &c) {
    return c.given.kind == MPMMeshCondition::PRESSURE || c.given.kind == MPMMeshCondition::TRACTION;
  });
}

void MPMMeshForces::clear_sums()
{
  for (auto &c : list) c.sum = {0.0, 0.0, 0.0};
}
