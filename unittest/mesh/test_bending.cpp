// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

// labels: unit

// Bending of surfaces of triangles and of lines: energies of cylinders and spheres, and what rotations do.

#include "math/matrix.h"
#include "mesh/bending.h"
#include "mesh/gmsh.h"

#include "gtest/gtest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

using namespace MPM_NS;

namespace {

using Place = std::array<double, 3>;

/** n x n pairs of triangles in a square of edge 1, some pairs with the other diagonal, nodes moved by up to a part of the spacing. */
Mesh sheet(int n, double disorder)
{
  Mesh mesh;
  for (int j = 0; j <= n; j++)
    for (int i = 0; i <= n; i++) {
      const bool inside = i > 0 && j > 0 && i < n && j < n;
      const double u = inside ? disorder / n : 0.0;
      mesh.nodes.push_back({(double) i / n + u * std::sin(7.0 * i * j),
                            (double) j / n + u * std::cos(5.0 * i + 3.0 * j), 0.0});
    }
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) {
      const int a = j * (n + 1) + i, b = a + n + 1;
      const bool other = disorder > 0.0 && (i + j) % 2;
      MeshElement first = {ElementType::TRIANGLE, 0, 1, {a, a + 1, other ? b + 1 : b}},
                  second = {ElementType::TRIANGLE, 0, 2, {other ? a : a + 1, b + 1, b}};
      mesh.elements.push_back(first);
      mesh.elements.push_back(second);
    }
  mesh.add_bending();
  return mesh;
}

void places(const Mesh &mesh, const MeshElement &patch,
            const std::function<Place(const Place &)> &motion, double (*x)[3])
{
  for (int k = 0; k < element_nodes(patch.type); k++) {
    const Place at = motion(mesh.nodes[patch.node[k]]);
    std::copy_n(at.data(), 3, x[k]);
  }
}

Place same(const Place &x)
{
  return x;
}

/** Energy of all patches, with D = 1. */
double energy(const Mesh &mesh, double nu, const std::function<Place(const Place &)> &motion)
{
  double sum = 0.0;
  for (const auto &e : mesh.elements) {
    if (e.type != ElementType::PATCH) continue;
    double X[6][3], x[6][3], f[6][3] = {{0.0}};
    places(mesh, e, same, X);
    places(mesh, e, motion, x);
    bool has[3];
    for (int k = 0; k < 3; k++) has[k] = e.node[3 + k] != e.node[0];
    BentTriangle bent;
    bent.define(X, has);
    sum += bent.bend(1.0, nu, x, f);
  }
  return sum;
}

Place turned(const Place &x)
{
  const double c = std::cos(0.7), s = std::sin(0.7);
  const Place y = {c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]};
  return {c * y[0] + s * y[2], y[1], c * y[2] - s * y[0]};
}

}    // namespace

// a square that is rolled to a cylinder of radius 2, along and across the mesh: D/2 k^2 per area, whatever Poisson's ratio. The rims, which are free,
// have no curvature across themselves, so that the error is of the size of a triangle
TEST(Bending, Cylinders)
{
  const double k = 0.5;
  for (const int axis : {0, 1}) {
    const auto roll = [&](const Place &x) {
      Place y = x;
      y[axis] = std::sin(k * x[axis]) / k;
      y[2] = (1.0 - std::cos(k * x[axis])) / k;
      return turned(y);
    };
    const auto error = [&](int n, double disorder) {
      return std::fabs(energy(sheet(n, disorder), 0.3, roll) / (0.5 * k * k) - 1.0);
    };
    const double coarse = error(16, 0.0), fine = error(32, 0.0);
    EXPECT_LT(fine, 0.05) << axis;
    EXPECT_LT(fine, 0.55 * coarse) << axis;
    EXPECT_LT(error(32, 0.15), 0.1) << axis;    // does not converge, see the manual
    for (const double disorder : {0.0, 0.15})
      EXPECT_NEAR(energy(sheet(8, disorder), 0.3, turned), 0.0, 1e-20);
  }
}

// curvature along both axes and a saddle: D (1 + nu) k^2 and D (1 - nu) k^2
TEST(Bending, PoissonsRatio)
{
  const double k = 1e-3, nu = 0.3;
  for (const int sign : {1, -1}) {
    const auto bend = [&](const Place &x) {
      return turned({x[0], x[1], 0.5 * k * (x[0] * x[0] + sign * x[1] * x[1])});
    };
    const auto twist = [&](const Place &x) {
      return turned({x[0], x[1], k * x[0] * x[1]});
    };
    const double exact = (1.0 + sign * nu) * k * k;
    const double coarse = energy(sheet(20, 0.0), nu, bend) / exact - 1.0,
                 fine = energy(sheet(40, 0.0), nu, bend) / exact - 1.0;
    EXPECT_LT(std::fabs(fine), 0.06);
    EXPECT_LT(std::fabs(fine), 0.6 * std::fabs(coarse));
    if (sign < 0) EXPECT_NEAR(energy(sheet(40, 0.0), nu, twist) / exact, 1.0, 0.06);
  }
}

// forces are minus the gradient of the energy, of a patch that is curved at rest, one without a neighbor, and of lines
TEST(Bending, ForcesAreTheGradientOfEnergy)
{
  const double X[6][3] = {{0, 0, 0},     {1, 0.1, 0},      {0.2, 1, 0.1},
                          {1.1, 1, 0.3}, {-0.7, 0.6, 0.2}, {0.6, -0.8, -0.1}};
  for (const bool full : {true, false}) {
    const bool has[3] = {true, full, true};
    BentTriangle bent;
    bent.define(X, has);
    double x[6][3], f[6][3] = {{0.0}}, none[6][3], total[3] = {0.0};
    EXPECT_NEAR(bent.bend(1.0, 0.3, X, f), 0.0, 1e-28);
    for (int k = 0; k < 6; k++)
      for (int d = 0; d < 3; d++) {
        x[k][d] = X[k][d] + 0.2 * std::sin(3.0 * k + d);
        f[k][d] = 0.0;
      }
    bent.bend(2.0, 0.3, x, f);
    for (int k = 0; k < 6; k++)
      for (int d = 0; d < 3; d++) {
        total[d] += f[k][d];
        double side[2];
        for (int s = 0; s < 2; s++) {
          x[k][d] += s ? 2e-6 : -1e-6;
          side[s] = bent.bend(2.0, 0.3, x, none);
        }
        x[k][d] -= 1e-6;
        EXPECT_NEAR(f[k][d], -(side[1] - side[0]) / 2e-6, 1e-7);
      }
    for (const double sum : total) EXPECT_NEAR(sum, 0.0, 1e-14);
  }
  for (const int dim : {2, 3}) {
    double line[3][3] = {{0, 0, 0}, {1, 0.2, 0}, {2.2, 0.44, 0}}, f[3][3] = {{0.0}}, none[3][3];
    if (dim == 2) line[2][1] = 0.9;
    BentLine bent;
    bent.define(dim, line);
    for (int k = 0; k < 3; k++)
      for (int d = 0; d < dim; d++) line[k][d] += 0.2 * std::cos(2.0 * k + d);
    bent.bend(2.0, dim, line, f);
    for (int k = 0; k < 3; k++)
      for (int d = 0; d < dim; d++) {
        double side[2];
        for (int s = 0; s < 2; s++) {
          line[k][d] += s ? 2e-6 : -1e-6;
          side[s] = bent.bend(2.0, dim, line, none);
        }
        line[k][d] -= 1e-6;
        EXPECT_NEAR(f[k][d], -(side[1] - side[0]) / 2e-6, 1e-7);
      }
  }
}

// n equal lines bent to an arc of angle 1: D angle^2/(2 l n), but for half a line at each end
TEST(Bending, Arc)
{
  const int n = 50;
  double sum = 0.0;
  for (int k = 0; k + 1 < n; k++) {
    double X[3][3] = {{0.0}}, x[3][3] = {{0.0}}, f[3][3];
    for (int m = 0; m < 3; m++) {
      X[m][0] = 0.1 * (k + m);
      x[m][0] = 5.0 * std::sin((k + m) / 50.0);
      x[m][1] = 5.0 * std::cos((k + m) / 50.0);
    }
    BentLine bent;
    bent.define(2, X);
    sum += bent.bend(3.0, 2, x, f);
  }
  EXPECT_NEAR(sum / (3.0 / (2.0 * 0.1 * n) * (n - 1) / n), 1.0, 1e-12);
}

TEST(Bending, Refuses)
{
  Mesh squares;
  squares.nodes.resize(4);
  squares.elements.push_back({ElementType::QUAD, 0, 7, {0, 1, 2, 3}});
  EXPECT_THROW(squares.add_bending(), std::runtime_error);
  Mesh book;
  book.nodes.resize(5);
  for (int k = 2; k < 5; k++) book.elements.push_back({ElementType::TRIANGLE, 0, k, {0, 1, k}});
  EXPECT_THROW(book.add_bending(), std::runtime_error);
}
