// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_THIN_TESTING_H
#define MPM_THIN_TESTING_H

// Meshes of surfaces and lines, and scenes with them.

#include "mpm_lammps.h"

namespace MPM_TEST {

using Node = std::array<double, 3>;

/** A mesh file of Gmsh with elements of one kind: 1 lines, 2 triangles, 3 quadrangles. */
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

/** Nodes and elements of one kind: lines, triangles, or quadrangles. */
struct ThinMesh {
  std::vector<Node> x;
  std::vector<std::vector<int>> elements;

  std::string text() const { return gmsh((int) elements[0].size() - 1, x, elements); }
};

/** n lines from one place to another. */
inline ThinMesh line(int n, const Node &from, const Node &to)
{
  ThinMesh mesh;
  for (int i = 0; i <= n; i++) {
    mesh.x.emplace_back();
    for (int d = 0; d < 3; d++) mesh.x.back()[d] = from[d] + (to[d] - from[d]) * i / n;
    if (i < n) mesh.elements.push_back({i, i + 1});
  }
  return mesh;
}

/** Triangles, each divided in four several times, whose new nodes are on a sphere of radius R. */
inline ThinMesh divided(ThinMesh mesh, int divisions, double R)
{
  for (int k = 0; k < divisions; k++) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [found, is_new] = middles.emplace(std::minmax(a, b), (int) mesh.x.size());
      if (!is_new) return found->second;
      Node m;
      double square = 0.0;
      for (int d = 0; d < 3; d++) square += pow(m[d] = mesh.x[a][d] + mesh.x[b][d], 2);
      for (double &c : m) c *= R / sqrt(square);
      mesh.x.push_back(m);
      return found->second;
    };
    std::vector<std::vector<int>> finer;
    for (const auto &t : mesh.elements) {
      const int a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      for (const auto &part : {std::vector<int>{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}})
        finer.push_back(part);
    }
    mesh.elements.swap(finer);
  }
  return mesh;
}

/** A sphere around 0 of an octahedron whose triangles are divided. */
inline ThinMesh octahedron(int divisions, double R)
{
  return divided(
      {{{R, 0, 0}, {-R, 0, 0}, {0, R, 0}, {0, -R, 0}, {0, 0, R}, {0, 0, -R}},
       {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}},
      divisions, R);
}

/** A disk of triangles in rings around 0, in the plane z = 0. */
inline ThinMesh rings_of_triangles(int rings, double radius)
{
  ThinMesh mesh;
  mesh.x.push_back({0.0, 0.0, 0.0});
  const auto node = [](int ring, int k) {
    return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + k % (6 * ring);
  };
  for (int r = 1; r <= rings; r++)
    for (int k = 0; k < 6 * r; k++) {
      const double angle = 2.0 * PI * k / (6 * r), R = radius * r / rings;
      mesh.x.push_back({R * cos(angle), R * sin(angle), 0.0});
      const int at = k % r, inner = k / r * (r - 1) + at;
      mesh.elements.push_back({node(r, k), node(r, k + 1), node(r - 1, inner)});
      if (at > 0) mesh.elements.push_back({node(r, k), node(r - 1, inner), node(r - 1, inner - 1)});
    }
  return mesh;
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

/** A rectangle or box of n[0] x n[1] (x n[2]) cells with edges l, lower corner 0, maybe cut into
 *  triangles or tetrahedra. skew: displacement of inner nodes in cells. */
inline std::string box_mesh(int dim, const int *n, const double *l, bool simplices, double skew)
{
  const int nz = dim == 3 ? n[2] : 0, sx = 1, sy = n[0] + 1, sz = sy * (n[1] + 1);
  std::vector<Node> nodes;
  std::vector<std::vector<int>> elements;
  for (int k = 0; k <= nz; k++)
    for (int j = 0; j <= n[1]; j++)
      for (int i = 0; i <= n[0]; i++) {
        const bool inner =
            i > 0 && i < n[0] && j > 0 && j < n[1] && (dim == 2 || (k > 0 && k < nz));
        double x[3] = {(double) i, (double) j, (double) k};
        if (inner)
          for (int d = 0; d < dim; d++) x[d] += skew * sin(12.9 * i + 7.3 * j + 4.1 * k + 2.0 * d);
        nodes.push_back(
            {x[0] * l[0] / n[0], x[1] * l[1] / n[1], dim == 3 ? x[2] * l[2] / n[2] : 0.0});
      }
  for (int k = 0; k < std::max(1, nz); k++)
    for (int j = 0; j < n[1]; j++)
      for (int i = 0; i < n[0]; i++) {
        const int a = i * sx + j * sy + k * sz;
        const int c[8] = {a,      a + sx,      a + sx + sy,      a + sy,
                          a + sz, a + sx + sz, a + sx + sy + sz, a + sy + sz};
        if (!simplices) elements.emplace_back(c, c + (dim == 2 ? 4 : 8));
        if (dim == 2 && simplices) {
          elements.push_back({c[0], c[1], c[2]});
          elements.push_back({c[0], c[3], c[2]});    // clockwise
        }
        if (dim == 3 && simplices)
          for (const auto &t : {std::array<int, 2>{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}})
            elements.push_back({c[0], c[t[0]], c[t[1]], c[6]});
      }
  return gmsh(2 * dim - (simplices ? 2 : 1), nodes, elements);
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

/** The scene with a map of IDs, which is asked for before the box is made. */
inline std::string with_map(const std::string &scene)
{
  return replaced(scene, "atom_style mpm\n", "atom_style mpm\natom_modify map array\n");
}

/** Input of a body from a mesh file. thin: words after the file name, such as the thickness;
 *  material: after its density of 1000; more: options of fix mpm/elements. */
inline std::string thin_body(const std::string &file, const std::string &thin,
                             const std::string &material, const std::string &more = "")
{
  return "create_points 1 mesh " + file + " " + thin + "\nfix m all mpm/material density 1000 " +
      material + "\nfix e all mpm/elements " + file + " " + thin + " " + more + "\n";
}

/** Runs until a thermo keyword changes its sign, looking every so many steps; returns the time. */
inline double time_of_zero(Scene &run, const std::string &quantity, int every)
{
  double before = run.evaluate(quantity), from = run.evaluate("time");
  for (int k = 0; k < 2000; k++) {
    run.commands(strprintf("run %d post no\n", every));
    const double now = run.evaluate(quantity), time = run.evaluate("time");
    if (now * before <= 0.0) return from + (time - from) * before / (before - now);
    before = now;
    from = time;
  }
  ADD_FAILURE() << quantity << " does not change its sign";
  return 1e300;
}

}    // namespace MPM_TEST

#endif
