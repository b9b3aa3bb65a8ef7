/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/rims.h"

#include "mesh/gmsh.h"

#include <algorithm>
#include <stdexcept>
#include <string>

using namespace MPM_NS;

Rims MPM_NS::find_rims(const Mesh &mesh)
{
  const auto problem = [&](std::size_t e, const std::string &what) {
    return std::runtime_error("element " + std::to_string(mesh.elements[e].label) + " " + what);
  };
  Rims rims;
  for (std::size_t e = 0; e < mesh.elements.size(); e++) {
    const auto &element = mesh.elements[e];
    const int *const node = element.node;
    if (element.type == ElementType::LINE) {
      for (int k = 0; k < 2; k++) rims[{node[k], node[k]}].emplace_back(e, k);
    } else if (element.type == ElementType::TRIANGLE) {
      for (int k = 0; k < 3; k++)
        rims[std::minmax(node[(k + 1) % 3], node[(k + 2) % 3])].emplace_back(e, k);
    } else
      throw problem(e, "is a quadrangle: use triangles");
  }
  for (const auto &[nodes, parts] : rims)
    if (parts.size() > 2) throw problem(parts[0].first, "has a rim with more than two elements");
  return rims;
}

SurfaceKind Mesh::orient_surface()
{
  struct Side {    // an element at a rim: two nodes of a surface, one node of a line
    int element;
    bool forward;    // sense in which the element goes along the rim
  };
  std::map<std::pair<int, int>, std::vector<Side>> rims;
  for (std::size_t e = 0; e < elements.size(); e++) {
    const int *const node = elements[e].node, n = element_nodes(elements[e].type);
    for (int k = 0; k < n; k++) {
      const int a = node[k], b = n == 2 ? a : node[(k + 1) % n];
      rims[std::minmax(a, b)].push_back({(int) e, n == 2 ? k == 0 : a < b});
    }
  }

  SurfaceKind kind = {true, true};
  struct Neighbor {
    int element;
    bool same;    // sense along the rim
  };
  std::vector<std::vector<Neighbor>> near(elements.size());
  for (const auto &[nodes, sides] : rims) {
    kind.closed = kind.closed && sides.size() == 2;
    kind.oriented = kind.oriented && sides.size() <= 2;
    if (sides.size() != 2) continue;
    const bool same = sides[0].forward == sides[1].forward;
    near[sides[0].element].push_back({sides[1].element, same});
    near[sides[1].element].push_back({sides[0].element, same});
  }

  std::vector<int> sense(elements.size(), 0), todo;    // 1: as it is, -1: to be reversed
  for (std::size_t e = 0; e < elements.size(); e++) {
    if (sense[e]) continue;
    sense[e] = 1;
    todo.push_back((int) e);
    while (!todo.empty()) {
      const int here = todo.back();
      todo.pop_back();
      for (const auto &neighbor : near[here]) {
        const int wanted = neighbor.same ? -sense[here] : sense[here];
        int &has = sense[neighbor.element];
        if (has == 0) {
          has = wanted;
          todo.push_back(neighbor.element);
        } else if (has != wanted)
          kind.oriented = false;
      }
    }
  }
  for (std::size_t e = 0; e < elements.size(); e++)
    if (sense[e] < 0)
      std::reverse(elements[e].node, elements[e].node + element_nodes(elements[e].type));
  return kind;
}

void MPM_NS::add_edges(Mesh &mesh, const Rims &rims)
{
  for (const auto &[nodes, parts] : rims) {
    if (parts.size() != 2) continue;
    const int k = parts[0].second, other = parts[1].second;
    MeshElement edge = mesh.elements[parts[0].first];
    const MeshElement &next = mesh.elements[parts[1].first];
    if (edge.type == ElementType::TRIANGLE) {
      const int all[4] = {edge.node[(k + 1) % 3], edge.node[(k + 2) % 3], edge.node[k],
                          next.node[other]};
      edge.type = ElementType::EDGE;
      std::copy_n(all, 4, edge.node);
    } else {
      const int all[3] = {edge.node[1 - k], nodes.first, next.node[1 - other]};
      edge.type = ElementType::CORNER;
      std::copy_n(all, 3, edge.node);
      if (k == 0) std::swap(edge.node[0], edge.node[2]);    // it begins there
    }
    mesh.elements.push_back(edge);
  }
}
