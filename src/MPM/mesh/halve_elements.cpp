/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/element.h"

#include "mesh/vector3.h"

using namespace MPM_NS;
using namespace MPM_NS::vector3;

// children of an element by numbers of its corners and of the middles between them: a child has as
// its corners the means of two corners of its parent, {k,k} for the corner itself; a quadrangle and
// a hexahedron, the means of two opposite corners

namespace {

struct Children {
  int count;
  int corner[8][8][2];    // [child][corner]
};

const Children LINE = {2, {{{0, 0}, {0, 1}}, {{0, 1}, {1, 1}}}};

const Children TRIANGLE = {4,
                           {{{0, 0}, {0, 1}, {0, 2}},
                            {{0, 1}, {1, 1}, {1, 2}},
                            {{0, 2}, {1, 2}, {2, 2}},
                            {{0, 1}, {1, 2}, {0, 2}}}};

// the octahedron that is left in the middle is divided along one diagonal (J. Bey, Computing 55
// (1995) 355)

const Children TETRAHEDRON = {8,
                              {{{0, 0}, {0, 1}, {0, 2}, {0, 3}},
                               {{0, 1}, {1, 1}, {1, 2}, {1, 3}},
                               {{0, 2}, {1, 2}, {2, 2}, {2, 3}},
                               {{0, 3}, {1, 3}, {2, 3}, {3, 3}},
                               {{0, 1}, {0, 2}, {0, 3}, {1, 3}},
                               {{0, 1}, {0, 2}, {1, 3}, {1, 2}},
                               {{0, 2}, {0, 3}, {1, 3}, {2, 3}},
                               {{0, 2}, {1, 2}, {2, 3}, {1, 3}}}};

}    // namespace

/** Corners of the child at corner c of a square or cube: for each of its own corners k, the mean of
 *  the corners of the parent that agree with c, or, along axes on which k and c differ, of all. */
static std::array<double, 3> corner_of_child(const Mesh &mesh, const MeshElement &e, int c, int k)
{
  const auto &at = CUBE_CORNER;
  std::array<double, 3> x = {0.0, 0.0, 0.0};
  int n = 0;
  for (int m = 0; m < element_nodes(e.type); m++) {
    bool counts = true;
    for (int d = 0; d < 3; d++) counts = counts && (at[k][d] != at[c][d] || at[m][d] == at[c][d]);
    if (!counts) continue;
    for (int d = 0; d < 3; d++) x[d] += mesh.nodes[e.node[m]][d];
    n++;
  }
  for (double &a : x) a /= n;
  return x;
}

void Mesh::halve_elements()
{
  Mesh fine;
  std::vector<int> first_child;
  for (const auto &e : elements) {
    first_child.push_back((int) fine.elements.size());
    const int n = element_nodes(e.type);
    const bool simplex = e.type == ElementType::TRIANGLE || e.type == ElementType::TETRAHEDRON ||
        e.type == ElementType::LINE;
    const auto &children = e.type == ElementType::LINE ? LINE
        : e.type == ElementType::TRIANGLE              ? TRIANGLE
                                                       : TETRAHEDRON;
    for (int c = 0; c < (simplex ? children.count : n); c++) {
      MeshElement child = e;
      for (int k = 0; k < n; k++) {
        const int *const of = children.corner[c][k];
        child.node[k] = (int) fine.nodes.size();
        fine.nodes.push_back(simplex ? 0.5 * (nodes[e.node[of[0]]] + nodes[e.node[of[1]]])
                                     : corner_of_child(*this, e, c, k));
      }
      fine.elements.push_back(child);
    }
  }
  first_child.push_back((int) fine.elements.size());

  fine.groups = groups;
  for (const auto &set : sets) {
    fine.sets.push_back({set.name, {}});
    for (const int k : set.elements)
      for (int c = first_child[k]; c < first_child[k + 1]; c++)
        fine.sets.back().elements.push_back(c);
  }
  for (const auto &one : data) {
    if (one.at_nodes) continue;
    fine.data.push_back({one.name, false, one.width, {}});
    auto &values = fine.data.back().values;
    for (std::size_t k = 0; k < elements.size(); k++)
      for (int c = first_child[k]; c < first_child[k + 1]; c++)
        values.insert(values.end(), &one.values[k * one.width],
                      &one.values[k * one.width] + one.width);
  }
  *this = std::move(fine);
}
