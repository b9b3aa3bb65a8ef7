// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_MESH_GRID_TESTING_H
#define MPM_MESH_GRID_TESTING_H

// Meshes for tests of fix mpm/mesh.

#include "mpm_lammps.h"

namespace MPM_TEST {

enum Kind { TRIANGLES, QUADS, TETRAHEDRA, HEXAHEDRA };

/** A mesh file of Gmsh (format 2.2) of a block of n cells along the axes: elements of one kind in
 *  the group "body", sides in the groups "xlo" to "zhi". Triangles and quads are in z = 0, with
 *  edges as sides. map: position of a node from its coordinates 0 to 1 in the block. */
inline std::string gmsh(Kind kind, const std::array<int, 3> &n,
                        const std::function<std::array<double, 3>(double, double, double)> &map)
{
  const bool solid = kind >= TETRAHEDRA;
  const int nz = solid ? n[2] : 0;
  std::string nodes, elements;
  int count = 0;
  const auto number = [&](int i, int j, int k) {
    return (k * (n[1] + 1) + j) * (n[0] + 1) + i + 1;
  };
  for (int k = 0; k <= nz; k++)
    for (int j = 0; j <= n[1]; j++)
      for (int i = 0; i <= n[0]; i++) {
        const auto x = map((double) i / n[0], (double) j / n[1], nz ? (double) k / nz : 0.0);
        nodes += strprintf("%d %.17g %.17g %.17g\n", number(i, j, k), x[0], x[1], x[2]);
      }
  const auto add = [&](int type, int group, const std::vector<int> &node) {
    elements += strprintf("%d %d 2 %d 1", ++count, type, group);
    for (const int one : node) elements += strprintf(" %d", one);
    elements += "\n";
  };
  static const int tetrahedra[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                       {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
  for (int k = 0; k < std::max(1, nz); k++)
    for (int j = 0; j < n[1]; j++)
      for (int i = 0; i < n[0]; i++) {
        const std::vector<int> q = {number(i, j, k), number(i + 1, j, k), number(i + 1, j + 1, k),
                                    number(i, j + 1, k)};
        if (!solid) {
          if (kind == QUADS)
            add(3, 1, q);
          else if ((i + j) % 2) {
            add(2, 1, {q[0], q[1], q[2]});
            add(2, 1, {q[0], q[2], q[3]});
          } else {
            add(2, 1, {q[0], q[1], q[3]});
            add(2, 1, {q[1], q[2], q[3]});
          }
          if (i == 0) add(1, 2, {q[0], q[3]});
          if (i == n[0] - 1) add(1, 3, {q[1], q[2]});
          if (j == 0) add(1, 4, {q[0], q[1]});
          if (j == n[1] - 1) add(1, 5, {q[3], q[2]});
          continue;
        }
        std::vector<int> h = q;
        for (const int node : q) h.push_back(node + (n[0] + 1) * (n[1] + 1));
        if (kind == HEXAHEDRA)
          add(5, 1, h);
        else
          for (const auto &t : tetrahedra) add(4, 1, {h[t[0]], h[t[1]], h[t[2]], h[t[3]]});
        const auto side = [&](bool there, int group, int a, int b, int c, int d) {
          if (!there) return;
          if (kind == HEXAHEDRA) return add(3, group, {h[a], h[b], h[c], h[d]});
          add(2, group, {h[a], h[b], h[c]});    // a-c is the diagonal of the tetrahedra
          add(2, group, {h[a], h[c], h[d]});
        };
        side(i == 0, 2, 0, 3, 7, 4);
        side(i == n[0] - 1, 3, 6, 2, 1, 5);
        side(j == 0, 4, 0, 1, 5, 4);
        side(j == n[1] - 1, 5, 6, 7, 3, 2);
        side(k == 0, 6, 0, 1, 2, 3);
        side(k == nz - 1, 7, 6, 5, 4, 7);
      }
  const int d = solid ? 3 : 2;
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" +
      strprintf("$PhysicalNames\n7\n%d 1 \"body\"\n%d 2 \"xlo\"\n%d 3 \"xhi\"\n%d 4 \"ylo\"\n%d 5 "
                "\"yhi\"\n2 6 \"zlo\"\n2 7 \"zhi\"\n$EndPhysicalNames\n",
                d, d - 1, d - 1, d - 1, d - 1);
  return text + strprintf("$Nodes\n%d\n", number(n[0], n[1], nz)) + nodes +
      strprintf("$EndNodes\n$Elements\n%d\n", count) + elements + "$EndElements\n";
}

}    // namespace MPM_TEST
#endif
