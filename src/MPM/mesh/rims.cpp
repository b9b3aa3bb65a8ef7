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
