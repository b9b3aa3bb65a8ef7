// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit ranks
// mpi: 1 2 3 4

// Poisson's equation on cells that are distributed over ranks, in patches that have nothing to do
// with its geometry: the same iterations and pressures as on one rank.

#include "field/mpm_halo.h"
#include "field/mpm_node_system.h"
#include "mpm_lammps.h"
#include "solve/cell_scenes.h"

using namespace MPM_TEST;
using namespace MPM_NS;

/** The rank of a cell: patches of 5 x 7 cells. */
int rank_of(const int *i)
{
  const unsigned patch = 31 * ((i[0] + 100) / 5) + 17 * ((i[1] + 100) / 7) + 5 * ((i[2] + 100) / 6);
  return (patch * 2654435761u >> 7) % nranks();
}

/** The blocks of this rank: its wet cells and their neighbors. */
Grid grid_of(const CellScene &scene)
{
  Grid grid(scene.lattice());
  const auto mine = [&](const int *i) {
    return scene.is_wet(i) && rank_of(i) == rank();
  };
  scene.each([&](const int *i) {
    if (!mine(i)) return;
    for (int d = -1; d < 2 * scene.dim; d++) {
      int at[3] = {i[0], i[1], i[2]}, b[3];
      if (d >= 0) at[d / 2] += 2 * (d % 2) - 1;
      for (int e = 0; e < 3; e++) b[e] = e < scene.dim ? at[e] >> grid.shift_bits : 0;
      auto &block = grid.blocks[grid.activate(b)];
      block.reached |= uint64_t(1) << grid.number(at);
    }
  });
  grid.close_periodic();
  grid.finish();
  return grid;
}

/** The system of a scene on all ranks. */
class RanksSystem : public MPMNodeSystem {
 public:
  const std::unique_ptr<MPMHalo> halo;
  MPMLatticeRanks ranks;
  CellOperator A;
  CellMultigrid multigrid;

  /** alike: all ranks that know a coefficient give it, and share; or the owner of a cell does. */
  RanksSystem(LAMMPS *lmp, const CellScene &scene, Grid &grid, bool alike) :
      MPMNodeSystem(lmp, grid, 1), halo(new MPMHalo(lmp)), ranks(lmp, grid, *halo), A(grid, ranks)
  {
    halo->setup(grid, [](const Grid::Block &) {
      return false;
    });
    A.clear();
    const auto reached = [&](int64_t node) {
      return node >= 0 &&
          (grid.blocks[node / NODES_PER_BLOCK].reached >> (node % NODES_PER_BLOCK) & 1);
    };
    for (int64_t node = 0; node < grid.nnodes(); node++) {
      int upper[3];
      grid.node_index(node, upper);
      if (!reached(node)) continue;
      scene.give(A, node);
      for (int d = 0; d < scene.dim; d++) {
        upper[d]++;
        if (!reached(grid.locate(upper))) A.face[node * scene.dim + d] = 0.0;
        upper[d]--;
      }
    }
    if (alike)
      A.share();
    else
      owners_give(scene);
    A.finish();
    multigrid.setup(A);
  }
  void apply(const double *x, double *y) override { A.apply(x, y); }
  void precondition(const double *r, double *z) override { multigrid.precondition(r, z); }
  const Grid &nodes() const { return grid; }

 private:
  /** Each rank gives the coefficients of its own cells to the next ones. */
  void owners_give(const CellScene &scene)
  {
    A.clear();
    for (int64_t node = 0; node < grid.nnodes(); node++) {
      int index[3];
      grid.node_index(node, index);
      bool canonical = true;
      for (int d = 0; d < scene.dim; d++)
        canonical = canonical && grid.lattice.wrap(d, index[d]) == index[d];
      if (canonical && rank_of(index) == rank()) scene.give(A, node);
    }
  }
};

CellScene tank(int dim, int n)
{
  CellScene scene{dim, n};
  scene.wet = [](const double *x) {
    return sloping(x) || disk(x);
  };
  return scene;
}

/** A closed pool and one with a surface, with a wall between them, in a box with an odd period. */
CellScene pools(int dim, int n)
{
  CellScene scene{dim, n};
  scene.periodic[1] = true;
  scene.wet = [](const double *x) {
    return x[0] < 0.5 || x[0] + 0.1 * std::cos(6.28 * x[1]) < 0.8;
  };
  scene.open = [n](const int *i, int d) {
    return d == 0 && i[0] == n / 2 - 1 ? 0.0 : 1.0 + 0.1 * (i[1] % 5);
  };
  return scene;
}

TEST(CellSystem, IsThatOfOneRank)
{
  Scene one;
  for (const auto &scene : {tank(2, 60), tank(3, 18), pools(2, 51), pools(3, 15)})
    for (const bool alike : {true, false}) {
      CellSystem serial(scene);
      auto b1 = serial.noise(), x1 = serial.zeros();
      const double mean1 = serial.multigrid.project(b1.data());
      const auto expected = serial.solve(b1, x1, {1e-10, 0.0, 100});
      ASSERT_TRUE(expected.converged());

      Grid grid = grid_of(scene);
      RanksSystem system(one.lmp, scene, grid, alike);
      EXPECT_EQ(system.multigrid.closed_pools(), serial.multigrid.closed_pools());
      std::vector<double> b(grid.nnodes(), 0.0), x(grid.nnodes(), 0.0);
      for (int64_t node = 0; node < grid.nnodes(); node++) {
        int i[3];
        grid.node_index(node, i);
        for (int d = 0; d < scene.dim; d++) i[d] = grid.lattice.wrap(d, i[d]);
        if (scene.is_wet(i)) b[node] = CellSystem::noise_at(i, 1);
      }
      EXPECT_NEAR(system.multigrid.project(b.data()), mean1, 1e-13);
      const auto report = ConjugateGradients().solve(system, b.data(), x.data(), {1e-10, 0.0, 100});
      EXPECT_TRUE(report.converged()) << report.describe();
      EXPECT_NEAR(report.iterations, expected.iterations, 1);
      EXPECT_NEAR(report.residuals[1], expected.residuals[1], 1e-10 * expected.residuals[0]);
      int64_t seen = 0;
      for (const auto &block : grid.blocks)
        for (int n = 0; n < NODES_PER_BLOCK; n++) {
          int i[3];
          grid.node_index(block, n, i);
          if (!(block.reached >> n & 1)) continue;
          for (int d = 0; d < scene.dim; d++) i[d] = grid.lattice.wrap(d, i[d]);
          if (!scene.is_wet(i)) continue;
          const int64_t here = (&block - grid.blocks.data()) * NODES_PER_BLOCK + n;
          EXPECT_LT(std::fabs(x[here] - x1[serial.grid.locate(i)]), 1e-8);
          seen += grid.owns(here);
        }
      int64_t wet = 0;
      scene.each([&](const int *i) {
        wet += scene.is_wet(i);
      });
      EXPECT_EQ(over_ranks((double) seen), wet);
    }
}
