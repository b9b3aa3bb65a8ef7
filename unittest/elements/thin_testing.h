// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_THIN_TESTING_H
#define MPM_THIN_TESTING_H

// Meshes of surfaces and lines, and scenes with them.

#include "mpm_lammps.h"

namespace MPM_TEST {

using Node = std::array<double, 3>;

/** A mesh file of Gmsh with elements of one kind: 1 for lines, 2 for triangles, 3 for
 *  quadrangles. */
inline std::string gmsh(int kind, const std::vector<Node> &nodes,
                        const std::vector<std::vector<int>> &elements)
{
  std::string text =
      strprintf("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n", (int) nodes.size());
  for (std::size_t i = 0; i < nodes.size(); i++)
    text += strprintf("%d %.17g %.17g %.17g\n", (int) i + 1, nodes[i][0], nodes[i][1], nodes[i][2]);
  text += strprintf("$EndNodes\n$Elements\n%d\n", (int) elements.size());
  for (std::size_t e = 0; e < elements.size(); e++) {
    text += strprintf("%d %d 2 1 1", (int) e + 1, kind);
    for (const int node : elements[e]) text += strprintf(" %d", node + 1);
    text += "\n";
  }
  return text + "$EndElements\n";
}

/** Mesh of a cable of length 1 with n lines: two straight halves that hang between x = 0 and x =
 *  span. up: vertical axis, 1 or 2. */
inline std::string hanging(int n, double span, int up)
{
  std::vector<Node> nodes;
  std::vector<std::vector<int>> lines;
  const double drop = sqrt(0.25 - 0.25 * span * span);
  for (int i = 0; i <= n; i++) {
    Node x = {span * i / n, 0.0, 0.0};
    x[up] = -drop * (1.0 - std::fabs(2.0 * i / n - 1.0));
    nodes.push_back(x);
    if (i < n) lines.push_back({i, i + 1});
  }
  return gmsh(1, nodes, lines);
}

/** Mesh of n x n squares or pairs of triangles, from 0 to l along x and y in the plane z = 0. */
inline std::string sheet(int n, double l, bool triangles)
{
  std::vector<Node> x;
  std::vector<std::vector<int>> f;
  for (int j = 0; j <= n; j++)
    for (int i = 0; i <= n; i++) x.push_back({l * i / n, l * j / n, 0.0});
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) {
      const int a = j * (n + 1) + i, b = a + n + 1;
      if (triangles) {
        f.push_back({a, a + 1, b});
        f.push_back({a + 1, b + 1, b});
      } else
        f.push_back({a, a + 1, b + 1, b});
    }
  return gmsh(triangles ? 2 : 3, x, f);
}

/** Input of a box from low to high along each axis, and of a lattice with spacing h. */
inline std::string box(int dim, double low, double high, double h, const std::string &options)
{
  const std::string range = strprintf("%g %g ", low, high);
  return strprintf("units si\ndimension %d\nboundary f f %s\nneighbor %g bin\natom_style mpm\n",
                   dim, dim == 2 ? "p" : "f", 0.5 * h) +
      "region box block " + range + range + (dim == 2 ? "-0.01 0.01" : range) +
      "\ncreate_box 1 box\n" + strprintf("fix grid all mpm %g ", h) + options + "\n";
}

/** Input of a body from a mesh file. thin: words after the file name, such as the thickness;
 *  material: after its density of 1000; more: options of fix mpm/elements. */
inline std::string thin_body(const std::string &file, const std::string &thin,
                             const std::string &material, const std::string &more = "")
{
  return "create_points 1 mesh " + file + " " + thin + "\nfix m all mpm/material density 1000 " +
      material + "\nfix e all mpm/elements " + file + " " + thin + " " + more + "\n";
}

inline double sum_over_ranks(double x)
{
  double all;
  MPI_Allreduce(&x, &all, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return all;
}

}    // namespace MPM_TEST

#endif
