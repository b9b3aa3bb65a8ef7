// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit mpi ranks
// mpi: 1 4

// Equations of cells by lists: against known vectors, and against multigrid on the lattice; and the
// step of a flow without a fix: what stages read and write, where points go.

#include "mpm_lammps.h"

#include "base/mpm_rows.h"
#include "field/mpm_node_system.h"
#include "flow/mpm_flow.h"
#include "flow/mpm_flow_lattice.h"
#include "flow/mpm_flow_poisson.h"
#include "flow/mpm_flow_rows.h"

using namespace MPM_TEST;
using namespace MPM_NS;
/** A number of a cell that does not depend on who has it. */
double noise(const Grid &grid, int64_t cell)
{
  int i[3];
  grid.node_index(cell, i);
  for (int d = 0; d < grid.lattice.dim; d++) i[d] = grid.lattice.wrap(d, i[d]);
  return std::sin(12.9898 * i[0] + 78.233 * i[1] + 37.719 * i[2] + 1.0);
}

/** A box of n cells along each axis, with coefficients of their faces and their surface. */
struct Cells {
  Scene scene;
  MPMFlowLattice cells;
  MPMFlowRows rows;
  std::vector<double> diagonal, weight;    // by places

  Cells(int dim, int n, const std::string &faces, double outside) :
      scene(box(dim, "si", faces, "0 1 0 1 0 1", 1, 0.02) +
            strprintf("create_points 1 box spacing %.17g\nrun 0\n", 1.0 / n)),
      cells(scene.lmp, {dim, 1.0 / n, {0.0, 0.0, 0.0}, {false, false, false}, {1, 1, 1}}, 1),
      rows(scene.lmp, cells)
  {
    cells.check_box("test");
    cells.sort();
    cells.find_cells();
    rows.begin();
    for (const auto &cell : cells.cells) {
      int near[6];
      for (int s = 0; s < 2 * dim; s++) near[s] = cell.walls >> s & 1 ? -1 : cell.near[s];
      rows.add(cell.number, near);
    }
    rows.arrange();
    for (int i = 0; i < rows.size(); i++) {
      const auto &cell = cells.cells[rows.row_at(i)];
      double sum = outside;
      for (int s = 0; s < 2 * dim; s++) {
        weight.push_back(cell.walls >> s & 1 ? 0.0 : face(cell, s));
        sum += weight.back();
      }
      diagonal.push_back(sum);
    }
  }
  double face(const MPMFlowLattice::Cell &cell, int s) const
  {
    return 1.0 + 0.3 * (noise(cells.grid, cell.number) + noise(cells.grid, cell.near[s]));
  }
  /** The largest of all ranks. */
  double most(double mine) const
  {
    double all;
    MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_MAX, scene.lmp->world);
    return all;
  }
};

// of the cells that several ranks reach each has its part, and all cells belong to one
TEST(Rows, CellsOfRanksAreAsManyAsTheirParts)
{
  for (const char *faces : {"f f", "p p"}) {
    Cells of(2, 40, faces, 0.1);
    const double mine = of.rows.size();
    double all;
    MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, of.scene.lmp->world);
    EXPECT_EQ(all, 1600.0) << faces;
    EXPECT_EQ(of.most(mine), 1600.0 / of.scene.lmp->comm->nprocs) << faces;
  }
}

// values that owners change come to ranks that have those from before
TEST(Rows, ValuesAreRenewed)
{
  Cells of(3, 10, "f f f", 0.1);
  auto &cells = of.cells;
  std::vector<double> values(2 * cells.size(), 0.0);
  for (int time = 0; time < 2; time++) {
    for (const auto &cell : cells.cells)
      for (int k = 0; k < 2; k++)
        values[2 * (int64_t) cell.number + k] =
            (time + 1) * (k + 1) * noise(cells.grid, cell.number);
    time ? cells.renew(values.data(), 2) : cells.publish(values.data(), 2);
    for (const auto &cell : cells.cells)
      for (int s = 0; s < 6; s++)
        for (int k = 0; k < 2; k++)
          if (!(cell.walls >> s & 1))
            EXPECT_EQ(values[2 * (int64_t) cell.near[s] + k],
                      (time + 1) * (k + 1) * noise(cells.grid, cell.near[s]));
  }
}

// also where the period is odd, so that two neighbors belong to the same half
TEST(Rows, SpreadSolvesTheEquations)
{
  for (const int dim : {2, 3})
    for (const int n : {10, 11})
      for (const char *faces : {"f f f", "p p p"}) {
        Cells of(dim, n, dim == 3 ? faces : std::string(faces).substr(0, 3), 0.1);
        auto &rows = of.rows;
        std::vector<double> load, x(rows.size(), 0.0);
        for (int i = 0; i < rows.size(); i++) {
          const auto &cell = of.cells.cells[rows.row_at(i)];
          double sum = of.diagonal[i] * noise(of.cells.grid, cell.number);
          for (int s = 0; s < 2 * dim; s++)
            sum -= of.weight[i * 2 * dim + s] * noise(of.cells.grid, cell.near[s]);
          load.push_back(sum);
        }
        MPMFlowSpread spread(of.scene.lmp, rows);
        const auto report =
            spread.solve(of.diagonal, of.weight, load.data(), x.data(), {1e-12, 0.0, 200});
        EXPECT_TRUE(report.converged()) << report.describe();
        double worst = 0.0;
        for (int i = 0; i < rows.size(); i++)
          grow(worst, x[i] - noise(of.cells.grid, rows.cell_at(i)));
        EXPECT_LT(of.most(worst), 1e-10) << dim << " " << n << " " << faces;
        EXPECT_LT(report.iterations, 60);    // all unknowns with the diagonal: up to 110
      }
}

// a cycle and a product, on the finest level by lists and on the lattice; the box is closed, too
TEST(Rows, PoissonIsThatOfTheLattice)
{
  for (const int dim : {2, 3})
    for (const double outside : {0.01, 0.0}) {
      Cells of(dim, dim == 3 ? 14 : 50, dim == 3 ? "f f f" : "f f", outside);
      auto &rows = of.rows;
      auto &grid = of.cells.grid;
      MPMLatticeRanks ranks(of.scene.lmp, grid, of.cells.halo_of_cells());
      CellOperator A(grid, ranks);
      A.clear();
      std::vector<double> r(grid.nnodes(), 0.0), z(grid.nnodes());
      for (const auto &cell : of.cells.cells) {
        for (int d = 0; d < dim; d++)
          if (!(cell.walls >> (2 * d + 1) & 1))
            A.face[(int64_t) cell.number * dim + d] = of.face(cell, 2 * d + 1);
        A.outside[cell.number] = outside;
        r[cell.number] = noise(grid, cell.number);
      }
      A.finish();
      of.cells.publish(r.data(), 1);

      MPMFlowPoisson poisson(of.scene.lmp, of.cells, rows);
      poisson.multigrid.setup(A);
      poisson.diagonal = of.diagonal;
      poisson.weight = of.weight;
      poisson.begin();
      std::vector<double> mine(rows.size()), of_rows(rows.size());
      for (int i = 0; i < rows.size(); i++) mine[i] = r[rows.cell_at(i)];
      const auto compare = [&]() {
        double worst = 0.0, size = 0.0;
        for (int i = 0; i < rows.size(); i++) {
          grow(worst, of_rows[i] - z[rows.cell_at(i)]);
          grow(size, of_rows[i]);
        }
        EXPECT_LT(of.most(worst), 1e-12 * of.most(size)) << dim << " " << outside;
      };
      A.apply(r.data(), z.data());
      poisson.apply(mine.data(), of_rows.data());
      compare();
      poisson.multigrid.precondition(r.data(), z.data());
      poisson.precondition(mine.data(), of_rows.data());
      compare();
    }
}

constexpr double H = 0.1;

/** Water in the lower part of a box, with a velocity that has a divergence. */
std::string water()
{
  return box(2, "si", "f f", "0 1 0 1", 1, 0.02) + "region wet block 0 1 0 0.6 INF INF\n" +
      strprintf("create_points 1 region wet spacing %.17g\n", 0.5 * H) +
      "variable vx atom sin(7*x+3*y)\nvariable vy atom cos(5*x*y)\n"
      "velocity all set v_vx v_vy 0.0\ntimestep 0.01\n";
}

MPMIncompressibleOptions options()
{
  MPMIncompressibleOptions chosen;
  chosen.h = H;
  chosen.density = 1000.0;
  chosen.transfer = MPMIncompressibleOptions::PIC;
  chosen.transfer_is_given = true;
  return chosen;
}

/** A flow that is ready for its first step. */
void start(MPMFlow &flow)
{
  flow.init();
  flow.checks.check_points();
  flow.parts.cells.sort();
  flow.start();
}

// a stage reads points, or what an earlier stage has written
SERIAL_TEST(Plan, StagesReadWhatOthersWrote)
{
  for (const bool gas : {false, true}) {
    Scene scene(water() + "run 0\n");
    auto chosen = options();
    chosen.has_gas = gas;
    chosen.gas_law.p = 1.0e5;
    const MPMRows none;
    MPMFlow flow(scene.lmp, chosen, 1, "w", none, none);
    start(flow);
    std::set<std::string> known = {"points"}, names;
    for (const auto &stage : flow.plan().list()) {
      EXPECT_TRUE(names.insert(stage.name).second) << stage.name;
      for (const auto &read : stage.reads.list())
        EXPECT_TRUE(known.count(read)) << stage.name << " " << read;
      EXPECT_FALSE(stage.writes.list().empty()) << stage.name;
      known.insert(stage.writes.list().begin(), stage.writes.list().end());
    }
    EXPECT_EQ(names.count("gas"), gas);
    EXPECT_EQ(flow.plan().list().back().name, "faces to points");
  }
}

SERIAL_TEST(Plan, MovesPointsAsTheFixDoes)
{
  constexpr int STEPS = 4;
  Scene one(water() + "run 0\n"),
      two(water() + "fix w all mpm/incompressible 0.1 1000 transfer pic\n");
  const MPMRows none;
  std::vector<double> beyond_middle(2 * one.lmp->atom->nmax, 0.0);
  const MPMRows half_kick = {beyond_middle.data(), 2};
  MPMFlow flow(one.lmp, options(), 1, "w", none, half_kick);
  start(flow);
  for (int step = 0; step < STEPS; step++) flow.step();
  two.commands(strprintf("run %d\n", STEPS));
  const auto *const mine = one.lmp->atom, *const its = two.lmp->atom;
  ASSERT_EQ(mine->nlocal, its->nlocal);
  ASSERT_GT(mine->natoms, 0);
  std::map<tagint, int> place;
  for (int j = 0; j < its->nlocal; j++) place[its->tag[j]] = j;
  for (int i = 0; i < mine->nlocal; i++) {
    const int j = place.at(mine->tag[i]);
    for (int d = 0; d < 2; d++) {
      EXPECT_NEAR(mine->x[i][d], its->x[j][d], 1e-12);
      EXPECT_NEAR(mine->v[i][d], its->v[j][d], 1e-12);
    }
  }
  EXPECT_LT(flow.results.residual, 3e-9);
}
