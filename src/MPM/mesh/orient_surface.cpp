/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/gmsh.h"

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

using namespace MPM_NS;

namespace {

/** A rim of an element: two nodes of a surface, one node of a line, and the sense in which the
 *  element goes along it. */
struct Rim {
  std::pair<int, int> nodes;
  int element;
  bool forward;
};

std::vector<Rim> rims_of(const Mesh &mesh)
{
  std::vector<Rim> rims;
  for (std::size_t e = 0; e < mesh.elements.size(); e++) {
    const auto &element = mesh.elements[e];
    const int n = element_nodes(element.type);
    for (int k = 0; k < n; k++) {
      const int a = element.node[k], b = n == 2 ? a : element.node[(k + 1) % n];
      rims.push_back({std::minmax(a, b), (int) e, n == 2 ? k == 0 : a < b});
    }
  }
  std::sort(rims.begin(), rims.end(), [](const Rim &a, const Rim &b) {
    return std::tie(a.nodes, a.element) < std::tie(b.nodes, b.element);
  });
  return rims;
}

void reverse(MeshElement &e)
{
  std::reverse(e.node, e.node + element_nodes(e.type));
}

}    // namespace

SurfaceKind Mesh::orient_surface()
{
  SurfaceKind kind = {true, true};
  struct Neighbor {
    int element;
    bool same;    // sense along the rim
  };
  std::vector<std::vector<Neighbor>> near(elements.size());
  const auto rims = rims_of(*this);
  for (std::size_t k = 0; k < rims.size();) {
    std::size_t end = k;
    while (end < rims.size() && rims[end].nodes == rims[k].nodes) end++;
    if (end - k == 2) {
      const bool same = rims[k].forward == rims[k + 1].forward;
      near[rims[k].element].push_back({rims[k + 1].element, same});
      near[rims[k + 1].element].push_back({rims[k].element, same});
    } else
      kind.closed = false;
    if (end - k > 2) kind.oriented = false;
    k = end;
  }

  std::vector<int> sense(elements.size(), 0);    // 1: as it is, -1: to be reversed
  std::vector<int> todo;
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
    if (sense[e] < 0) reverse(elements[e]);
  return kind;
}
