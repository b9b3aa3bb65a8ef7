// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart
// mpi: 1 4
// timeout: 300

// Heat that materials make of their own work, and solids that become liquids, in whole bodies.

#include "heat/heat_testing.h"

using namespace MPM_TEST;

/** A history variable of the points of a material. */
struct History {
  Scene &run;
  FixMPMMaterial *material;
  int column;

  History(Scene &run, const std::string &name) :
      run(run), material(run.material()), column(material->find_history(name))
  {
  }
  double &at(int i) { return material->history[i][column]; }
  /** Mean over points with y in a range. */
  double mean(double low, double high)
  {
    double sum = 0.0, n = 0.0;
    for (int i = 0; i < run.n(); i++)
      if (run.x()[i][1] > low && run.x()[i][1] < high) {
        sum += at(i);
        n++;
      }
    const auto all = over_ranks({sum, n});
    return all[0] / all[1];
  }
};

/** Couette flow of width 1, n cells, walls at 0 and 1; all properties are 1. */
static std::string couette(int n, const std::string &material, const std::string &heat)
{
  const double h = 1.0 / n;
  return plane("lj", "p f", strprintf("0 %.17g 0 1", 4 * h), 1, 0.2 * h) +
      strprintf("fix grid all mpm %.17g\ncreate_points 1 box ppc 2\n", h) +
      "fix m all mpm/material density 1.0 " + material + "\n" +
      "fix low all mpm/boundary ylo stick\nfix high all mpm/boundary yhi stick velocity 1 0 0\n" +
      "variable v atom y\nvelocity all set v_v 0 0\n" + "fix heat all mpm/heat " + heat +
      "\nfix dt all mpm/dt 0.6\n";
}
const std::string FLUID = "eos linear 100.0 viscosity newtonian 1.0 thermal conducting 1.0 0.0 1.0";

static void run_to(Scene &run, double t)
{
  run.commands(strprintf("variable time equal time\nfix until all halt 1 v_time >= %.17g error "
                         "continue message no\nrun 100000\nunfix until\n",
                         t - 1e-9));
}

// Viscous heat between cold walls: (T - T0) k/(mu U^2) from a uniform source, at last y (1 - y)/2
TEST(Couette, IsWarmInTheMiddle)
{
  const int n = 20;
  Scene run(couette(n, FLUID, "ylo temperature 0 yhi temperature 0") +
            "compute e all mpm/energy\n");
  History T(run, "temperature");
  const double h = 1.0 / n;
  // the mean of the two cells in the middle is less by h^2/6 * T''/2
  const double bend = h * h / 6.0;
  for (const auto &[t, exact] : {std::pair{0.05, 0.0462983}, std::pair{0.1, 0.0769191},
                                 std::pair{0.2, 0.1070796}, std::pair{1.5, 0.125}}) {
    run_to(run, t);
    // to first order in what is left of the time
    const double rate = t < 1.0 ? std::exp(-PI * PI * t) * 4.0 / PI : 0.0;
    const double now = exact + rate * (run.time() - t);
    EXPECT_NEAR(measured(strprintf("t %g, middle", t), T.mean(0.5 - h, 0.5 + h) + 0.5 * bend) / now,
                1.0, 0.01);
  }
  // all viscous work has become heat: that of the points and what has gone through the walls
  const double *const e = run.compute_vector();
  double mine = 0.0;
  for (int i = 0; i < run.n(); i++) mine += run.mass()[i] * T.at(i);
  EXPECT_NEAR((over_ranks(mine) - run.fix("heat")->compute_scalar()) / e[3], 1.0, 1e-10);
}

TEST(Couette, IsWarmestAtAnInsulatedWall)
{
  const int n = 20;
  const double h = 1.0 / n;
  Scene run(couette(n, FLUID, "ylo temperature 0"));
  History T(run, "temperature");
  run_to(run, 4.0);
  // T = y - y^2/2, mean of the last cell
  EXPECT_NEAR(measured("at the wall", T.mean(1.0 - h, 1.0)) / (0.5 - h * h / 6.0), 1.0, 8e-4);
}

// a solid that has molten flows as its melt does
TEST(Couette, OfAMelt)
{
  const int n = 12;
  const std::string heat = "ylo temperature 3 yhi temperature 3";
  Scene fluid(couette(n, replaced(FLUID, "1.0 0.0 1.0", "1.0 3.0 1.0"), heat)),
      melt(couette(n,
                   "eos linear 100.0 strength j2 50.0 1.0 viscosity newtonian 1.0 liquid "
                   "thermal conducting 1.0 0.0 1.0 0.9 melt 2.0 5.0",
                   heat));
  History T(melt, "temperature"), f(melt, "molten");
  for (int i = 0; i < melt.n(); i++) {
    T.at(i) = 3.0;
    f.at(i) = 1.0;
  }
  for (Scene *run : {&fluid, &melt}) {
    run->commands("unfix dt\ntimestep 2e-4\nrun 300\n");
    run->commands("unfix high\nfix high all mpm/boundary yhi stick velocity 3 0 0\nrun 300\n");
  }
  EXPECT_LT(measured("difference", difference(fluid.gather(), melt.gather())), 1e-12);
}

// Sheared metal softens by its own heat: 67.97364 K and 275.5936 MPa at a plastic strain of 1
SERIAL_TEST(AdiabaticShear, OfABlock)
{
  const double h = 1e-4, rate = 2e5;
  Scene run(
      plane("si", "p f", strprintf("0 %g 0 %g", 4 * h, 8 * h), 1, 0.2 * h) +
      strprintf("fix grid all mpm %g\ncreate_points 1 box ppc 2\n", h) +
      "fix m all mpm/material density 7830 eos linear 162.7e9 strength j2 79.46e9 500e6 "
      "thermal adiabatic 477 293 0.9 vary SIGMAY linear -0.000666666666666667 293 293 1792\n" +
      strprintf("fix low all mpm/boundary ylo stick\n"
                "fix high all mpm/boundary yhi stick velocity %g 0 0\n"
                "variable v atom %g*y\nvelocity all set v_v 0 0\ncompute e all mpm/energy\n",
                rate * 8 * h, rate) +
      "fix dt all mpm/dt 0.3\n");
  History T(run, "temperature"), e(run, "eplastic");
  run_to(run, 1.0 / rate);
  double worst = 0.0, strain = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double gamma = std::sqrt(3.0) * e.at(i), tau0 = 500e6 / std::sqrt(3.0);
    const double dT = 1500.0 * (1.0 - std::exp(-0.9 * tau0 * gamma / (7830.0 * 477.0 * 1500.0)));
    worst = std::max(worst, std::fabs((T.at(i) - 293.0) / dT - 1.0));
    strain += gamma / run.n();
  }
  EXPECT_NEAR(measured("strain", strain), 1.0, 0.02);
  EXPECT_LT(measured("temperature", worst), 8e-5);
  const double *const energy = run.compute_vector();
  EXPECT_NEAR(energy[4] / energy[2], 0.9, 1e-12);
}

/** A bar that is heated at one end until that has molten, and pulled. */
static std::string bar(const std::string &more)
{
  return plane("lj", "f f", "0 6 0 2", 1, 0.1) + "fix grid all mpm 0.25\n" +
      "region bar block 0 4 0.5 1.5 -0.5 0.5\ncreate_points 1 region bar ppc 2\n"
      "fix m all mpm/material density 1.0 eos linear 100.0 strength j2 50.0 1.0 "
      "viscosity newtonian 0.05 liquid thermal conducting 1.0 0.0 1.0 0.9 melt 1.0 0.5 " +
      more +
      "\nfix heat all mpm/heat xlo temperature 2.0\nfix b all mpm/boundary xlo slip\n"
      "variable v atom 0.4*x\nvelocity all set v_v 0 0\ncompute e all mpm/energy\n";
}

// the molten end has no strength; no energy is lost on the way
TEST(Bar, LosesItsStrengthWhereItMelts)
{
  Scene run(bar("") + "timestep 0.003\nrun 700\n");
  History f(run, "molten"), e(run, "eplastic");
  double liquid = 0.0, solid = 0.0, strongest = 0.0, hard = 0.0, strain = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const auto s = run.cauchy(i);
    const double p = -(s[0] + s[1] + s[2]) / 3.0;
    const double q = std::sqrt(
        1.5 *
        (std::pow(s[0] + p, 2) + std::pow(s[1] + p, 2) + std::pow(s[2] + p, 2) + 2 * s[3] * s[3]));
    if (f.at(i) >= 1.0) {
      liquid++;
      strongest = std::max(strongest, q);
      strain = std::max(strain, e.at(i));
    } else if (f.at(i) <= 0.0) {
      solid++;
      hard = std::max(hard, e.at(i));
    }
  }
  const auto n = over_ranks({liquid, solid});
  EXPECT_GT(n[0], 20);
  EXPECT_GT(n[1], 100);
  EXPECT_LT(measured("strongest liquid", over_ranks(strongest, MPI_MAX)), 0.3);
  EXPECT_EQ(over_ranks(strain, MPI_MAX), 0.0);
  EXPECT_GT(measured("plastic strain of the solid", over_ranks(hard, MPI_MAX)), 0.05);
  const double *const energy = run.compute_vector();
  EXPECT_NEAR(energy[10], 0.0, 1e-12);
  EXPECT_LT(std::fabs(measured("laws", energy[13])),
            0.002 * measured("dissipated", energy[2] + energy[3]));
}

TEST(Bar, OnAnyNumberOfRanks)
{
  OnRanks run(bar("expansion 0.01"), "timestep 0.003\nrun 300\n");
  EXPECT_LT(run.difference(), 1e-11);
}

TEST(Bar, Restart)
{
  const std::string scene = bar("expansion 0.01") + "timestep 0.003\n";
  Continued run(scene, 150, lines_again(scene), 150);
  EXPECT_TRUE(identical(run.whole.gather(), run.again.gather()));
}

/** A stream of points that come from fix mpm/emit, the only ones of their field, over a slab. */
static std::string stream(const std::string &transfer)
{
  return plane("si", "f f", "0 2 0 1.2", 2, 0.02) +
      "group a type 1\ngroup b type 2\nfix A a mpm 0.05\nfix B b mpm 0.05\n"
      "region slab block 0 2 0.2 0.4 INF INF\ncreate_points 2 region slab ppc 2\ngroup b type 2\n"
      "region low block INF INF INF 0.26 INF INF\nregion mouth block 0.1 0.3 0.4 0.6 INF INF\n"
      "fix m1 a mpm/material density 1000 linear 1e6 0.3 thermal conducting 100 300 1000\n"
      "fix m2 b mpm/material density 2000 linear 1e6 0.3 thermal conducting 100 300 500\n"
      "fix in a mpm/emit 1 region mouth velocity 2 0 0 temperature 310\n"
      "fix touch all mpm/contact A B law coulomb 0.3 heat yes\n"
      "fix w all mpm/boundary region low stick field B\nfix g a gravity 10 vector 0 -1 0\n"
      "variable q atom 1e6*(y>0.5)\n"
      "fix heat all mpm/heat contact A B conductance 1e4 source v_q transfer " +
      transfer + "\nfix dt all mpm/dt 0.3\n";
}

// what a run finds out at its start does not depend on points that come a moment later: it is the
// same when a run before had them already
SERIAL_PARAMETER_TEST(Emitted, PointsAreKnownFromTheStart, const char *,
                      Values("relax 0", "relax 1", "affine"))
{
  Scene at_once(stream(GetParam()) + "run 60\n"), later(stream(GetParam()) + "run 0\nrun 60\n");
  for (const char *id : {"m1", "m2"}) {
    Warm one(at_once, id), two(later, id);
    const auto range = one.range(), other = two.range();
    measured(id, range[1]);
    for (const int k : {0, 1}) {
      ASSERT_TRUE(std::isfinite(range[k]));
      EXPECT_EQ(range[k], other[k]) << id << k;
    }
    EXPECT_EQ(one.heat(), two.heat()) << id;
  }
}
