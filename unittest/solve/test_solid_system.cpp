// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit ranks
// mpi: 1 2 3 4

// The stiffness of points on ranks in patches, with its multigrid: as on one rank.

#include "field/mpm_halo.h"
#include "field/mpm_node_system.h"
#include "mpm_lammps.h"
#include "solve/solid_scenes.h"

using namespace MPM_TEST;
using namespace MPM_NS;

bool mine(const double *x)
{
  const unsigned patch = 31 * (unsigned) (7.0 * x[0] + 20.0) + 17 * (unsigned) (5.0 * x[1] + 20.0) +
      5 * (unsigned) (3.0 * x[2] + 20.0);
  return (patch * 2654435761u >> 7) % nranks() == (unsigned) rank();
}

SolidScene inclined(int n)
{
  SolidScene scene{2, 1.0 / n, {0.0, 0.0, 0.0}, {1.0, 1.0, 0.0}};
  scene.inside = [](const double *x) {
    return x[1] > 0.75 * x[0];
  };
  scene.hold = [](const double *x, double(*P)[3]) {
    const double normal[2] = {-0.6, 0.8};
    if (x[1] - 0.75 * x[0] < 0.05)
      for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++) P[a][b] = (a == b) - normal[a] * normal[b];
  };
  scene.density = 0.5;
  return scene;
}

SolidScene clamped(int dim, int n)
{
  SolidScene scene{dim, 1.0 / n, {0.0, 0.0, 0.0}, {1.0, 1.0, dim == 3 ? 1.0 : 0.0}};
  scene.periodic[1] = true;
  scene.hold = [](const double *x, double(*P)[3]) {
    if (x[0] < 1e-9)
      for (int a = 0; a < 3; a++) P[a][a] = 0.0;
  };
  return scene;
}

TEST(SolidSystem, IsThatOfOneRank)
{
  Scene one;
  for (const auto &scene : {inclined(24), clamped(2, 21), clamped(3, 4)}) {
    const auto load = [](const double *x, int a) {
      return std::sin(5.0 * x[0] + 11.0 * x[1] + 3.0 * x[2] + a);
    };
    SolidSystem serial(scene);
    serial.setup();
    const auto b1 = serial.forces(load);
    auto x1 = serial.zeros();
    const auto expected = serial.solve(b1, x1, {1e-9, 0.0, 200});
    ASSERT_TRUE(expected.converged()) << expected.describe();

    std::unique_ptr<MPMHalo> halo(new MPMHalo(one.lmp));
    SolidSystem system(scene, mine, [&](Grid &grid) {
      halo->setup(grid, [](const Grid::Block &) {
        return false;
      });
      return new MPMLatticeRanks(one.lmp, grid, *halo);
    });
    system.setup();
    EXPECT_NEAR(system.multigrid->largest_eigenvalue(), serial.multigrid->largest_eigenvalue(),
                1e-6);
    const auto b = system.forces(load);
    auto x = system.zeros();
    const auto report = system.solve(b, x, {1e-9, 0.0, 200});
    EXPECT_TRUE(report.converged()) << report.describe();
    EXPECT_NEAR(report.iterations, expected.iterations, 1);
    EXPECT_NEAR(report.residuals[1], expected.residuals[1], 1e-6 * expected.residuals[0]);
    double largest = 0.0, size = 0.0;
    for (std::size_t p = 0; p < system.npoints(); p++)
      for (int i = 0; i < system.nnodes; i++) {
        const int64_t node = system.nodes[p * system.nnodes + i];
        int index[3];
        system.grid.node_index(node, index);
        const int64_t other = serial.grid.locate(index);
        ASSERT_GE(other, 0);
        for (int a = 0; a < scene.dim; a++) {
          grow(largest, x[node * scene.dim + a] - x1[other * scene.dim + a]);
          grow(size, x1[other * scene.dim + a]);
        }
      }
    if (system.npoints() > 0) { EXPECT_LT(largest, 1e-6 * size); }
  }
}
