// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// The command mpm_geostatic: level ground at rest. With pore water: test_pore.cpp.

#include "pore/pore_bodies_testing.h"

using namespace MPM_TEST;

constexpr double G = 9.81, DENSITY = 1800.0;
const char *const SOIL = "linear 1e7 0.3";

/** Ground of n cells in a height of 1 m, in 2d or 3d, its lattice moved by an offset in cells. */
std::string ground(int dim, int n, const std::string &law, double offset,
                   const std::string &options = "", const std::string &units = "si", int wide = 4)
{
  const double h = 1.0 / n;
  const std::string up = dim == 3 ? "0 0 -1" : "0 -1 0", across = strprintf("0 %.17g ", wide * h);
  return box(dim, units, dim == 3 ? "p p f" : "p f p", across + (dim == 3 ? across : "") + "0 1.2",
             1, 0.3 * h) +
      "region soil block INF INF " + (dim == 3 ? "INF INF 0 1\n" : "0 1 INF INF\n") +
      strprintf("create_points 1 region soil spacing %.17g\n", 0.5 * h) +
      strprintf("fix grid all mpm %.17g origin 0 %s%.17g %s\n", h, dim == 3 ? "0 " : "", offset * h,
                options.c_str()) +
      strprintf("fix m all mpm/material density %g ", DENSITY) + law +
      "\nfix floor all mpm/boundary " + (dim == 3 ? "zlo" : "ylo") + " slip\n" +
      strprintf("fix g all gravity %g vector ", G) + up + "\n";
}

// forces on nodes are zero wherever these are, the stress is the weight above
SERIAL_TEST(Geostatic, StaysAtRest)
{
  const int n = 20;
  const double dt = 5e-5, cell = DENSITY * G / n;
  for (const int dim : {2, 3})
    for (const char *options : {"", "stress gradient", "shape cubic", "scheme musl"})
      for (const double offset : {0.0, 0.27}) {
        if (offset > 0.0 && strcmp(options, "shape cubic") == 0) continue;
        Scene run(ground(dim, n, SOIL, offset, options) + "mpm_geostatic grid 0.4\nrun 0\n");
        double most = 0.0;
        for (int i = 0; i < run.n(); i++) {
          const double z = 1.0 - run.x()[i][dim - 1];
          const auto sigma = run.cauchy(i);
          EXPECT_NEAR(sigma[0], 0.4 * sigma[dim - 1], 1e-12 * cell);
          if (std::fabs(z - 0.5) < 0.35)
            most = std::max(most, std::fabs(sigma[dim - 1] + DENSITY * G * z) / cell);
        }
        const auto name = strprintf("%dd %s %g: ", dim, options, offset);
        EXPECT_LT(measured(name + "stress inside", most), 0.01);
        run.commands(strprintf("timestep %g\nrun 1\n", dt));
        EXPECT_LT(measured(name + "force over weight", fall(run, dt)), 1e-11);
        if (dim == 3) continue;
        run.commands("run 400\n");
        EXPECT_LT(measured(name + "velocity", fall(run, 401 * dt)), 1e-11);
      }
}

// sand, which keeps an elastic strain, and units in which stress is not force over area
SERIAL_TEST(Geostatic, SoilsAndUnits)
{
  for (const char *law : {"mohr/coulomb 1e7 0.3 35 0", "drucker/prager 1e7 0.3 35"}) {
    Scene run(ground(2, 20, law, 0.1) + "mpm_geostatic grid 0.5\ntimestep 4e-5\nrun 1\n");
    EXPECT_LT(measured(law, fall(run, 4e-5)), 1e-10);
  }
  for (const char *units : {"metal", "cgs", "lj"}) {
    const auto scene =
        replaced(replaced(ground(2, 20, SOIL, 0.1, "", units), "density 1800", "density 1e-3"),
                 "1e7 0.3", "1e6 0.3");
    Scene run(scene + "mpm_geostatic grid 0.5\ntimestep 1e-8\nrun 1\n");
    EXPECT_LT(measured(units, fall(run, 1e-8)), 1e-10);
  }
}

// a crust that is no thicker than a cell, and whose K0 is below the active one, yields at the same
// mean stress, as sand without dilation does. The warning has the number of its points on all
// ranks, and the largest change of their stress
TEST(Geostatic, CrustBeyondYieldIsTold)
{
  const int n = 8;
  const double K0 = 0.55, active = std::pow(std::tan(0.25 * PI - 7.5 * PI / 180.0), 2.0);
  const auto scene = [&](double friction, int rows) {
    return replaced(
               ground(3, n, "mohr/coulomb 1e7 0.3 35 0", 0.0), "fix m all",
               strprintf("region high block INF INF INF INF %.17g INF\ngroup crust region high\n"
                         "group rest subtract all crust\n"
                         "fix c crust mpm/material density %g mohr/coulomb 1e7 0.3 %g 0\n"
                         "fix m rest",
                         1.0 - 0.5 * rows / n, DENSITY, friction)) +
        strprintf("mpm_geostatic grid %g\nrun 0\n", K0);
  };
  Scene firm(scene(35.0, 2)), run;
  const auto log = log_of(run, scene(15.0, 2));
  const auto before = firm.gather(), after = run.gather();
  double points = 0.0, most = 0.0, of_same_mean = 0.0;
  for (std::size_t k = 0; k < after.size(); k++) {
    const double *const is = after[k].stress, *const was = before[k].stress;
    const bool crust = after[k].x[2] > 1.0 - 1.0 / n;
    points += crust;
    for (int d = 0; d < 3; d++) {
      if (d < 2) EXPECT_NEAR(is[d] / is[2], crust ? active : K0, 1e-9);
      grow(most, (is[d] - was[d]) * n / (DENSITY * G));
    }
    const double yields = 1.0 - (1.0 + 2.0 * K0) / (1.0 + 2.0 * active);
    if (crust) grow(of_same_mean, yields * was[2] * n / (DENSITY * G));
  }
  EXPECT_NEAR(measured("change over the weight of a cell", most) / of_same_mean, 1.0, 1e-6);
  if (rank() == 0)
    EXPECT_THAT(log,
                HasSubstr(strprintf("stress of %.0f points next to the surface is beyond yield, by "
                                    "up to %.3g times the weight of a cell",
                                    points, most)));
  if (nranks() == 1) expect_error(scene(15.0, 3), "law of fix mpm/material c does not keep");
}

// LAMMPS evaluates the variables of fix gravity in a run, which is later
SERIAL_TEST(Geostatic, GravityByAVariable)
{
  const auto scene = replaced(ground(2, 20, SOIL, 0.1), "gravity 9.81", "gravity v_g");
  Scene run("variable g equal 9.81*exp(-step)\n" + scene +
            "mpm_geostatic grid 0.5\ntimestep 5e-5\nvariable g equal 9.81\nrun 1\n");
  EXPECT_LT(measured("force over weight", fall(run, 5e-5)), 1e-10);
}

// points with nodes off the face do not end there, and a stress next to the face that is not the
// weight above balances nodes: this is told, but not of ground that ends at the face
SERIAL_TEST(Geostatic, GapsAreTold)
{
  for (const int n : {10, 20})
    for (const double offset : {0.0, 0.1, 0.3, 0.5}) {
      auto scene = ground(2, n, SOIL, offset);
      for (const bool after : {false, true}) {
        if (after) {
          const std::string points =
              strprintf("create_points 1 region soil spacing %.17g\n", 0.5 / n);
          scene = replaced(replaced(scene, points, ""), "fix m all", points + "fix m all");
        }
        const auto name = strprintf("%d cells, %g %d", n, offset, after);
        const bool off = after && offset != 0.0 && offset != 0.5;
        EXPECT_EQ(times_said(scene + "mpm_geostatic grid 0.4\nrun 0\n", "the ground ends"),
                  off ? 1 : 0)
            << name;
        Scene run(scene + "mpm_geostatic grid 0.4\nrun 0\n");
        double most = 0.0, top = 0.0;
        for (int i = 0; i < run.n(); i++) top = std::max(top, run.x()[i][1] + 0.25 / n);
        for (int i = 0; i < run.n(); i++) {
          const auto sigma = run.cauchy(i);
          grow(most, sigma[1] / (DENSITY * G) + top - run.x()[i][1]);
        }
        measured(name + ": error of the stress over that of the floor", most);
        if (!off) EXPECT_LT(most, 0.012);
      }
    }
}

// a wall in the ground is removed: the sand behind it moves, what is far away does not
SERIAL_TEST(Geostatic, PartIsTakenAway)
{
  Scene run(ground(2, 20, "mohr/coulomb 1e7 0.3 35 0", 0.0, "", "si", 40) +
            "mpm_geostatic grid 0.43\nregion pit block 0.2 0.6 0.5 1.1 INF INF\n"
            "delete_atoms region pit\ntimestep 4e-5\nrun 125\n");
  double bank = 0.0, far = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double x = run.x()[i][0], v = std::hypot(run.v()[i][0], run.v()[i][1]);
    if (std::fabs(x - 0.4) < 0.3) bank = std::max(bank, v);
    if (std::fabs(x - 1.4) < 0.05) far = std::max(far, v);    // 0.8 m from the pit, or more
  }
  EXPECT_GT(measured("speed of the bank over g t", bank / (G * 0.005)), 0.2);
  // waves, at 87 m/s, are not there yet
  EXPECT_LT(measured("far away", far / (G * 0.005)), 1e-3);
}

TEST(Geostatic, RanksAndRestart)
{
  const std::string scene = ground(3, 8, "mohr/coulomb 1e7 0.3 35 0", 0.3),
                    start = "mpm_geostatic grid 0.5\nvelocity all set 0 0 0.01\ntimestep 8e-5\n";
  OnRanks run(scene, start + "run 100\n");
  EXPECT_LT(run.difference(), 1e-11);
  const std::string fixes = "neighbor 0.0375 bin\nfix grid" +
      scene.substr(scene.find("fix grid") + 8) + "timestep 8e-5\n";
  Continued again(scene + start, 30, fixes, 30);
  EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
}

SERIAL_TEST(Geostatic, BadInput)
{
  const auto plain = ground(2, 10, SOIL, 0.0);
  expect_refused(
      plain,
      {{"mpm_geostatic", "missing argument"},
       {"mpm_geostatic grid", "missing argument"},
       {"mpm_geostatic grid -0.5", "K0"},
       {"mpm_geostatic grid 0.5 0.5", "0.5"},
       {"mpm_geostatic gird 0.5", "no fix mpm with the ID gird"},
       {"unfix g\nmpm_geostatic grid 0.5", "needs a weight along an axis"},
       {"fix h all gravity 1 vector 1 0 0\nmpm_geostatic grid 0.5", "needs a weight along an axis"},
       {"group some id 1\nfix h some gravity 1 vector 0 1 0\nmpm_geostatic grid 0.5",
        "must be of group all"},
       {"delete_atoms group all\nmpm_geostatic grid 0.5", "needs points"},
       {"displace_atoms all move 0 0.15 0\nmpm_geostatic grid 0.5", "needs level ground"},
       {"fix w all mpm/pore 2e7 1000 9810 soil m 0.4 constant 1e-3\nmpm_geostatic grid 1",
        "use keyword geostatic of fix mpm/pore"}});
  // also where the water comes after the command, unless it gives points its own state at rest
  const std::string later =
      "mpm_geostatic grid 0.5\nfix w all mpm/pore 2e7 1000 9810 soil m 0.4 constant 1e-3";
  expect_error(plain + later + "\ntimestep 1e-5\nrun 0\n", "use keyword geostatic");
  Scene run(plain + later + " geostatic 0.5 1\ntimestep 1e-5\nrun 0\n");
  // a part of a body on two lattices has not the weight of the other part
  const std::string lattices = R"(unfix grid
group upper region high
group lower subtract all upper
fix grid lower mpm 0.1
fix fine upper mpm 0.05 origin 0.025 0.025
)";
  const std::string two = plain + "region high block INF INF 0.5 1 INF INF\n" + lattices;
  const std::string refine = "fix R all mpm/refine grid fine\n", rest = "mpm_geostatic grid 0.5\n";
  expect_error(two + refine + rest, "has only a part of the points of fix R");
  expect_error(two + rest + refine + "timestep 1e-5\nrun 0\n", "know the weight of the other");
  const auto refused = [&](const char *what, const std::string &with, const char *why) {
    expect_error(replaced(plain, what, with) + "mpm_geostatic grid 0.5\n", why);
  };
  refused("linear 1e7", "hencky 1e7", "does not keep the stress");
  refused("fix m all",
          "group one id 1\ngroup rest subtract all one\n"
          "fix rock one mpm/material density 1800 hencky 1e7 0.3\nfix m rest",
          "law of fix mpm/material rock does not keep the stress");
  refused("linear 1e7 0.3", "mohr/coulomb 1e7 0.3 15 0", "K0 within its yield surface");
  refused("origin 0 0", "shape linear origin 0 0", "use shape quadratic or cubic");
  refused("origin 0 0", "shape cubic origin 0 0.04", "in a plane of nodes");
  refused("origin 0 0", "frame total origin 0 0", "use frame updated");
  refused("origin 0 0", "locking pressure origin 0 0", "use locking none");
}
