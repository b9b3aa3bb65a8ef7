// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics restart
// mpi: 1 4
// timeout: 200

// Bodies that break: what is deleted is told, history goes with the points, cracks cost energy.

#include "mpm_lammps.h"

using namespace MPM_TEST;

/** Column of a history variable of the only material, by tag, gathered on all ranks. */
std::vector<double> history(Scene &run, const std::string &name)
{
  auto *material =
      dynamic_cast<FixMPMMaterial *>(run.lmp->modify->get_fix_by_style("^mpm/material$")[0]);
  const int column = material->find_history(name);
  EXPECT_GE(column, 0) << name;
  std::vector<double> mine(run.lmp->atom->map_tag_max + 1, 0.0);
  for (int i = 0; i < run.n(); i++) mine[run.lmp->atom->tag[i]] = material->history[i][column];
  return over_ranks(mine, MPI_SUM, run.lmp->world);
}

const std::string head = "units lj\ndimension 2\nboundary f f p\natom_style mpm\n"
                         "atom_modify map array\nneighbor 0.3 bin\n"
                         "region box block 0 24 0 12 -0.5 0.5\ncreate_box 1 box\n";

/** A plate that is torn apart while it flies and turns. */
std::string plate(const std::string &options, const std::string &damage)
{
  return head + "fix grid all mpm 1.0 " + options + "\nregion plate block 6 18 4 8 INF INF\n" +
      "create_points 1 region plate ppc 2\n" +
      "fix m all mpm/material density 1.0 eos linear 100.0 strength elastic 60.0 " + damage +
      "\nvelocity all ramp vx -1.5 2.0 x 6 18\nvelocity all ramp vy -0.3 0.3 x 6 18 sum yes\n"
      "fix step all mpm/dt 0.3\n";
}

const std::string brittle = "damage rankine 6.0 weibull 6 0.25 77 ";

TEST(Deletion, MassAndMomentumAreTold)
{
  for (const std::string scheme : {"usl", "musl", "usf"}) {
    SCOPED_TRACE(scheme);
    Scene run(plate("failed delete scheme " + scheme, brittle) +
              "compute e all mpm/energy\nthermo_style custom step c_e\nrun 0\n");
    const auto start = run.gather();
    const double start_energy = run.compute_scalar();
    run.commands("run 150\n");
    const auto end = run.gather();
    const Totals before(start), after(end);
    const double *told = run.fix_vector("grid", 11) + 6;
    EXPECT_EQ(told[0], start.size() - end.size());
    EXPECT_GT(told[0], 8);
    EXPECT_LT(told[0], 0.8 * start.size());
    EXPECT_NEAR(told[1], before.mass - after.mass, 1e-12 * before.mass);
    for (int d = 0; d < 3; d++) EXPECT_NEAR(told[2 + d], before.p[d] - after.p[d], 1e-11);
    EXPECT_EQ(run.lmp->atom->natoms, end.size());
    for (const double D : history(run, "damage")) EXPECT_LT(D, 1.0);

    // the ledger knows what has gone
    const double *e = run.compute_vector();
    EXPECT_LT(e[12], 0.0);
    EXPECT_NEAR(e[10], 0.0, 1e-12 * e[0]);
    EXPECT_GT(e[11], 0.0);
    EXPECT_LT(std::fabs(e[9]), 0.03 * start_energy) << "integration";
  }
}

// at once, and not when lists are due: with this skin no point goes far enough
TEST(Deletion, DoesNotWaitForNewLists)
{
  Scene run(replaced(plate("failed delete", brittle), "neighbor 0.3 bin", "neighbor 20 bin") +
            "run 0\n");
  const auto all = run.gather().size();
  run.commands("run 60\n");
  const auto left = run.gather().size();
  EXPECT_LT(left, all - 2);
  EXPECT_GT(left, all / 4);
  for (const double D : history(run, "damage")) EXPECT_LT(D, 1.0);
}

TEST(Deletion, IsOff)
{
  Scene run(plate("", brittle + "after none") + "run 150\nrun 0\n");
  EXPECT_EQ(run.fix_vector("grid", 11)[6], 0.0);
  const auto D = history(run, "damage");
  const auto end = run.gather();
  EXPECT_EQ(D.size(), end.size() + 1);
  int failed = 0;
  for (const auto &s : end) {
    if (D[static_cast<int>(s.tag)] < 1.0) continue;
    failed++;
    for (const double stress : s.stress) EXPECT_NEAR(stress, 0.0, 1e-12);
  }
  EXPECT_GT(failed, 8);
}

// a plate that breaks, and expands by the heat of fracture: all of it is in temperature and
// internal energy, the ledger closes, and laws make no more errors than without that heat
TEST(Heat, OfFractureIsInTheInternalEnergy)
{
  double laws[2];
  int k = 0;
  for (const char *thermal : {"adiabatic 1e-3 300 0", "adiabatic 1e-3 300 0 fracture 0.8",
                              "conducting 1e-3 300 1e-3 0 fracture 0.8"}) {
    SCOPED_TRACE(thermal);
    const bool hot = k > 0;
    Scene run(replaced(plate("",
                             std::string("damage rankine 6.0 soften energy 1.0 after friction "
                                         "0.3 thermal ") +
                                 thermal),
                       "eos linear 100.0", "eos shock 10 1.5 2") +
              (k == 2 ? "fix heat all mpm/heat\n" : "") + "compute e all mpm/energy\nrun 0\n");
    const double start = run.compute_scalar();
    run.commands("run 200\n");
    const double *const e = run.compute_vector();
    EXPECT_NEAR(measured("residual", e[10] / start), 0.0, 1e-13);
    EXPECT_GT(measured("work of fracture", e[11] / start), 0.5);
    const double error = measured("error of laws", e[13] / start);
    const auto T = history(run, "temperature"), heat = history(run, "heat");
    const auto left = hot ? history(run, "unspent_heat") : std::vector<double>(T.size());
    double temperature = 0.0, energy = 0.0;
    const double volume = 0.25;
    for (std::size_t i = 1; i < T.size(); i++) {
      temperature += volume * 1e-3 * (T[i] - 300.0);
      energy += volume * (heat[i] + left[i]);
    }
    EXPECT_NEAR(temperature / start, e[4] / start, 1e-12);
    EXPECT_NEAR(energy / start, e[4] / start, 1e-12);
    EXPECT_NEAR(e[4] / start, hot ? 0.8 * e[11] / start : 0.0, 1e-12);
    if (k < 2) laws[k] = std::fabs(error);
    k++;
  }
  EXPECT_LT(laws[1], 1.2 * laws[0]);
}

// strengths are a matter of position and seed; a run on many ranks is that on one
TEST(DamageOnRanks, SameAsSerial)
{
  for (const std::string option : {"", "failed delete"}) {
    SCOPED_TRACE(option);
    OnRanks run(plate(option, brittle + "soften energy 3.0"), "");
    auto &many = run.parallel, &serial = run.serial;
    EXPECT_EQ(history(many, "random"), history(serial, "random"));
    for (Scene *one : {&many, &serial}) one->commands("run 120\n");
    EXPECT_LT(run.difference(), 1e-9);
    const auto D = history(many, "damage"), E = history(serial, "damage");
    double largest = 0.0;
    for (size_t k = 0; k < D.size(); k++) {
      largest = std::max(largest, D[k]);
      EXPECT_LT(std::fabs(D[k] - E[k]), 1e-9);
    }
    EXPECT_GT(largest, 0.5);
    for (int k = 6; k < 11; k++)
      EXPECT_NEAR(many.fix_vector("grid", 11)[k], serial.fix_vector("grid", 11)[k], 1e-9);
  }
}

TEST(DamageRestart, ContinuesBitwise)
{
  const std::string laws[] = {brittle + "soften energy 3.0 after friction 0.3",
                              "damage grady/kipp 1e5 3 2.0 150.0", "damage rankine 6.0 after none"};
  for (const auto &law : laws) {
    SCOPED_TRACE(law);
    Continued run(plate("", law), 80,
                  "neighbor 0.3 bin\nfix grid all mpm 1.0\n"
                  "fix m all mpm/material density 1.0 eos linear 100.0 strength elastic 60.0 " +
                      law + "\nfix step all mpm/dt 0.3\n",
                  60);
    auto &whole = run.whole, &again = run.again;
    EXPECT_TRUE(identical(whole.gather(), again.gather()));
    auto *material = whole.material();
    for (const auto &variable : material->material->history())
      EXPECT_EQ(history(whole, variable.name), history(again, variable.name)) << variable.name;
    double largest = 0.0;
    for (const double d : history(whole, "damage")) largest = std::max(largest, d);
    EXPECT_GT(largest, 0.0);
  }
}

/** Energy per area of a crack over GC, in a bar that is pulled until a row of weak cells breaks. */
double crack_energy(const std::string &options, double h, const std::string &rest)
{
  const double GC = 0.004;
  Scene run(
      plane("lj", "f p", strprintf("-6 6 0 %g", 2 * h), 2, 0.5 * h) +
          strprintf(
              "fix grid all mpm %g %s\nregion bar block -4 4 INF INF INF INF\n"
              "region left block -6 -3.5 INF INF INF INF\n"
              "region right block 3.5 6 INF INF INF INF\n"
              "region weak block 0 %g INF INF INF INF\ncreate_points 1 region bar ppc 2\n"
              "set region weak type 2\ngroup strong type 1\ngroup weak type 2\n"
              "fix m1 strong mpm/material density 1.0 eos linear 100.0 strength elastic 60.0 %s\n"
              "fix m2 weak mpm/material density 1.0 eos linear 100.0 strength elastic 60.0 damage "
              "rankine 0.3 soften energy %g\n"
              "fix l all mpm/boundary region left stick velocity -0.004 NULL NULL\n"
              "fix r all mpm/boundary region right stick velocity 0.004 NULL NULL\n"
              "velocity all ramp vx -0.004 0.004 x -3.5 3.5\ncompute e all mpm/energy\n"
              "thermo_style custom step time c_e[12]\nfix step all mpm/dt 0.5\nrun %d\n",
              h, options.c_str(), h, rest.c_str(), GC, (int) (30.0 / (0.5 * h / 13.5))),
      MPI_COMM_SELF);
  return run.compute_vector()[11] / (2 * h * GC);
}

TEST(Crack, EnergyDoesNotDependOnTheSpacing)
{
  const std::string all = "damage rankine 0.315 soften energy 0.004";
  for (const double h : {0.5, 0.25, 0.125}) {
    SCOPED_TRACE(h);
    // only one row of cells can break
    EXPECT_NEAR(crack_energy("", h, ""), 1.0, 1e-3);
    // all can: the strain must localize by itself
    EXPECT_NEAR(crack_energy("shape linear transfer flip 1 scheme musl", h, all), 1.05, 0.02);
  }
}
