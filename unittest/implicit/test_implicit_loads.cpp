// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Fix mpm/implicit with loads of fix mpm/traction, which follow the surface within a step.

#include "implicit/implicit_testing.h"

using namespace MPM_TEST;

/** A quarter of a tube of rubber, inner radius 1, outer radius 2, under a load on its bore: p times
 *  the shear modulus at the end of that many steps (benchmark S2). */
static std::string tube(const std::string &load, double p, int steps, const std::string &solve,
                        const std::string &grid = "0.1 frame total")
{
  return plane("si", "f f", "0 3 0 3", 1, 0.03) + "fix grid all mpm " + grid +
      "\nregion outer cylinder z 0 0 2 INF INF\nregion bore cylinder z 0 0 1 INF INF side out\n"
      "region tube intersect 2 outer bore\ncreate_points 1 region tube ppc 2 outside ignore\n"
      "fix m all mpm/material density 1000 neohookean 1e6 0.3\n"
      "fix walls all mpm/boundary xlo ylo slip\n" +
      strprintf("variable p equal %.17g*(step+1)/%d\n", p * 1e6 / 2.6, steps) +
      "fix gas all mpm/traction region bore area $(PI/2) " + load +
      "\nfix solve all mpm/implicit " + solve +
      "\ncompute e all mpm/energy\nthermo_style custom step f_gas[4] c_e\ntimestep 1.0\n";
}

/** A quarter of a bar of length 1 with free sides, a load T on its end (S1), in two steps. */
static std::string bar(const std::string &load, double T, const std::string &solve)
{
  return space("si", "f f f", "0 2.2 0 0.8 0 0.8", 1, 0.03) + "fix grid all mpm 0.1 frame total" +
      "\nregion bar block 0 1 0 0.4 0 0.4\ncreate_points 1 region bar ppc 2\n"
      "fix m all mpm/material density 1000 neohookean 1e6 0.3\n"
      "fix walls all mpm/boundary xlo ylo zlo slip\nregion end plane 1 0 0 -1 0 0\n" +
      strprintf("variable T equal %.17g*(step+1)/2\n", T) +
      "fix load all mpm/traction region end " + load + "\nfix solve all mpm/implicit static " +
      solve + "\ntimestep 1.0\n";
}

// pressure acts on the area of the end of the step, whatever its length: benchmark S2
SERIAL_TEST(Tube, Widens)
{
  struct Case {
    double p, radius;
    int steps;
  };
  double found[2];
  for (const auto &c : {Case{0.2, 1.183161, 1}, Case{0.2, 1.183161, 4}, Case{0.4, 1.502870, 2},
                        Case{0.5, 1.795494, 3}}) {
    Scene run(tube("pressure v_p", c.p, c.steps, "static") + strprintf("run %d\n", c.steps));
    const double radius = run.fix_vector("gas", 7)[3] / (0.5 * PI);
    EXPECT_LT(
        std::fabs(measured(strprintf("p/mu %g, %d steps: radius over exact - 1", c.p, c.steps),
                           radius / c.radius - 1.0)),
        0.01);
    if (c.p == 0.2) found[c.steps / 4] = radius;
    const double *const e = run.compute_vector();
    EXPECT_LT(std::fabs(e[10]), 1e-9 * std::fabs(e[5])) << "residual of the ledger";
  }
  EXPECT_NEAR(found[0], found[1], 1e-7) << "a state of equilibrium does not know its past";
}

// hoop stress under a small pressure, against p/3 (1 + 4/r^2) of Lame: lattices of points cut bore
// and side, so that forces by mls and by gradients have the same errors in the total frame
SERIAL_TEST(Tube, HasTheStressOfLame)
{
  double error[2][2];
  for (const int fine : {0, 1})
    for (const int gradient : {0, 1}) {
      const std::string grid =
          strprintf("%g frame total stress ", fine ? 0.05 : 0.1) + (gradient ? "gradient" : "mls");
      Scene run(tube("pressure v_p", 1e-4, 1, "static", grid) +
                "compute s all mpm/atom stress/xx stress/yy stress/xy\nvariable q atom x*x+y*y\n"
                "variable hoop atom (c_s[1]*y*y+c_s[2]*x*x-2*c_s[3]*x*y)/v_q\n"
                "variable e atom (3*v_hoop/v_p-1-4/v_q)^2\ncompute m all reduce ave v_e\n"
                "thermo_style custom step c_m\nrun 1\nvariable p equal " +
                strprintf("%.17g\nrun 0\n", 1e2 / 2.6));
      error[fine][gradient] = measured(grid, std::sqrt(run.evaluate("c_m")) / 5.0);
      EXPECT_LT(error[fine][gradient], fine ? 0.05 : 0.07);
    }
  for (const auto &e : error) EXPECT_NEAR(e[1] / e[0], 1.0, 0.1);
}

// a dead load on the bore keeps its direction and total: the same benchmark
SERIAL_TEST(Tube, WidensUnderDeadLoad)
{
  for (const auto &[p, radius] : {std::pair{0.2, 1.153545}, std::pair{0.4, 1.320856}}) {
    Scene run(replaced(tube("traction v_tx v_ty 0", p, 2, "static"), "fix gas",
                       "compute u all displace/atom\nvariable X atom x-c_u[1]\n"
                       "variable Y atom y-c_u[2]\nvariable R atom sqrt(v_X^2+v_Y^2)\n"
                       "variable tx atom v_p*v_X/v_R\nvariable ty atom v_p*v_Y/v_R\nfix gas") +
              "run 2\n");
    const double found = run.fix_vector("gas", 7)[3] / (0.5 * PI);
    EXPECT_LT(
        std::fabs(measured(strprintf("p/mu %g: radius over exact - 1", p), found / radius - 1.0)),
        0.01);
  }
}

// dead and following loads on the end of a bar: benchmark S1
SERIAL_TEST(Bar, Stretches)
{
  struct Case {
    bool follows;
    double load, stretch;
  };
  for (const auto &c : first_of(2,
                                {Case{false, 2e5, 1.232989}, Case{true, 2e5, 1.204529},
                                 Case{false, -2e5, .828311}, Case{true, -2e5, .809486},
                                 Case{false, 5e5, 1.713567}, Case{true, 5e5, 1.511761}})) {
    Scene run(bar(c.follows ? "pressure v_T" : "traction v_T 0 0", c.follows ? -c.load : c.load,
                  std::fabs(c.load) > 2e5 ? "solver multigrid" : ""));
    run.set_reference();
    run.commands("run 2\n");
    double sum = 0.0, n = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const double X = run.reference(i)[0];
      if (X < 1.0 / 3.0 || X > 2.0 / 3.0) continue;
      sum += run.points().F[i][0];
      n += 1.0;
    }
    EXPECT_LT(std::fabs(measured(strprintf("%s %g: stretch over exact - 1",
                                           c.follows ? "following" : "dead", c.load),
                                 sum / n / c.stretch - 1.0)),
              5e-3);
    EXPECT_LE(solved(run, 0), 8.0);
  }
}

// of Newton's method, with a load in one step whose area grows by half
SERIAL_TEST(Tube, ConvergesQuadratically)
{
  expect_quadratic(
      "tube",
      tube("pressure v_p", 0.4, 1, "static tolerance 1e-13 accuracy 1e-10 report yes") + "run 1\n");
}

// the change of forces with loads against differences of forces
SERIAL_TEST(Tangent, KnowsTheLoads)
{
  for (const char *options :
       {"", "frame total", "axisymmetric yes", "frame total axisymmetric yes"})
    for (const char *load :
         {"region bore pressure 3e5", "region bore traction 2e5 1e5 0 pressure v_a",
          "free pressure v_a", "points 1.5 1 2 0 pressure 4e5", "region bore moment 0 0 3e5"}) {
      const bool axis = std::string(options).find("axi") != std::string::npos;
      if (axis && std::string(load).find("moment") != std::string::npos) continue;
      Scene run(plane("si", "f f", "0 3 0 3", 1, 0.03) + "fix grid all mpm 0.2 " + options +
                "\nregion outer cylinder z 0 0 2 INF INF\n"
                "region bore cylinder z 0 0 1 INF INF side out\n"
                "region tube intersect 2 outer bore\n"
                "create_points 1 region tube ppc 2 outside ignore\n"
                "fix m all mpm/material density 1000 neohookean 1e6 0.3\n"
                "fix walls all mpm/boundary xlo slip\nvariable a atom 1e5*(1+x*y)\n"
                "fix gas all mpm/traction " +
                load + "\ntimestep 1e-3\nrun 0\n");
      distort(run, 0.05, axis);
      run.commands("run 0\n");    // loads of these
      EXPECT_GT(expect_tangent(run, std::string(options) + " " + load, 0.01, 1e-3, 0), 1e-3)
          << "the load has a part in it";
    }
}

// a body under pressure on all of its surface has that pressure, also in one large step
SERIAL_TEST(Free, IsThePressureInside)
{
  for (const char *options : {"frame total", "", "frame total axisymmetric yes"}) {
    const bool axis = std::string(options).find("axi") != std::string::npos;
    Scene run(plane("si", "f f", "0 2 0 2", 1, 0.03) + "fix grid all mpm 0.1 " + options +
              "\nregion disk sphere 0 0 0 0.63\ncreate_points 1 region disk ppc 2 outside ignore\n"
              "fix m all mpm/material density 1000 neohookean 1e6 0.3\n"
              "fix walls all mpm/boundary xlo ylo slip\n"
              "fix load all mpm/traction free pressure 3e5\n"
              "fix solve all mpm/implicit static tolerance 1e-10\ntimestep 1.0\nrun 1\n");
    double most = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const auto sigma = run.cauchy(i);
      for (const int c : {0, 1, 2, 3})
        if (c != 2 || axis) most = std::max(most, std::fabs(sigma[c] + (c < 3 ? 3e5 : 0.0)));
    }
    EXPECT_LT(measured(std::string(options) + ": error of the stress", most / 3e5), 1e-8);
  }
}

// what the last step took is known at the start of the next run, and after a restart
SERIAL_TEST(Report, OutlivesTheRun)
{
  const auto scene = tube("pressure v_p", 0.2, 2, "static", "0.2 frame total");
  const ScratchFile file("restart");
  Scene run(scene + "run 1\n");
  std::vector<double> before;
  for (int k = 0; k < 8; k++) before.push_back(solved(run, k));
  before.push_back(run.fix("solve")->compute_scalar());
  EXPECT_GT(before[0], 1.0);
  run.commands("run 0\nwrite_restart " + file.name + "\n");
  Scene again("read_restart " + file.name + "\n" + lines_again(scene) + "run 0\n");
  for (int k = 0; k < 8; k++) {
    EXPECT_EQ(solved(run, k), before[k]) << k;
    EXPECT_EQ(solved(again, k), before[k]) << k;
  }
  EXPECT_EQ(run.fix("solve")->compute_scalar(), before[8]);
  EXPECT_EQ(again.fix("solve")->compute_scalar(), before[8]);
}

// benchmark P1 (c): an end moment rolls a beam up. kappa over M/EI, and the stretch of its middle,
// are those of this rubber in pure bending in plane strain (the equations of a curved strip solved
// as a boundary value problem)
SERIAL_TEST(Beam, IsRolledUpByAMoment)
{
  struct Case {
    double part, curvature, stretch;
    int cells, steps;
  };
  for (const auto &c :
       {Case{0.5, 1.0051066, 1.0030935, 4, 8}, Case{1.0, 1.0210080, 1.0125423, 4, 16}}) {
    const double spacing = 0.5 / c.cells;
    Scene run(
        plane("si", "f f", "-6 22 -6 16", 1, 0.1) +
        body("block 0 20 -0.5 0.5 INF INF", "density 1000 neohookean 1e6 0.3",
             strprintf("%.17g frame total", 2.0 * spacing)) +
        "region wall block INF 0 INF INF INF INF\nfix clamp all mpm/boundary region wall stick\n"
        "region end plane 20 0 0 -1 0 0\n" +
        strprintf("variable M equal %.17g*(step+1)/%d\n",
                  c.part * 2.0 * PI / 20.0 * 1e6 / 0.91 / 12.0, c.steps) +
        "fix bend all mpm/traction region end moment 0 0 v_M\n"
        "fix solve all mpm/implicit static solver multigrid\ncompute e all mpm/energy\n"
        "thermo_style custom step c_e\ntimestep 1.0\n");
    run.set_reference();
    run.commands(strprintf("run %d\n", c.steps));
    double tip[2] = {0.0, 0.0}, n = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const double *const X = run.reference(i);
      if (X[0] < 20.0 - spacing || std::fabs(X[1]) > spacing) continue;
      for (int d = 0; d < 2; d++) tip[d] += run.x()[i][d];
      n += 1.0;
    }
    const double kappa = c.part * c.curvature * 2.0 * PI / 20.0, radius = c.stretch / kappa,
                 angle = kappa * (20.0 - 0.5 * spacing),
                 miss = std::hypot(tip[0] / n - radius * std::sin(angle),
                                   tip[1] / n - radius * (1.0 - std::cos(angle)));
    EXPECT_LT(
        measured(
            strprintf("%g of a circle, %d cells: way of the tip from its place over the length",
                      c.part, c.cells),
            miss / 20.0),
        0.02);
    const double *const f = run.fix_vector("bend", 7),
                        M = c.part * 2.0 * PI / 20.0 * 1e6 / 0.91 / 12.0;
    EXPECT_NEAR(measured("moment over what is asked for", f[6] / M), (c.steps + 1.0) / c.steps,
                1e-10);
    EXPECT_LT(std::hypot(f[0], f[1]), 1e-9 * M);
    const double work = run.fix("bend")->compute_scalar(), *const e = run.compute_vector();
    // the load of the next step is there at the end of a step: its mean is late by half of one
    EXPECT_NEAR(measured("work over energy", work / e[1]), 1.0, 2.0 / c.steps);
    EXPECT_LT(std::fabs(measured("residual of the ledger over energy", e[9] / e[1])),
              1.5 / c.steps);
  }
}

// a moment with a part along the axis of a bar bends and twists it, as in explicit steps
SERIAL_TEST(Bar, HasAMomentInSpace)
{
  for (const char *solve :
       {"fix solve all mpm/implicit static solver multigrid\ntimestep 1.0\n", "timestep 1e-5\n"}) {
    Scene run(space("si", "f f f", "0 2.2 -0.6 0.6 -0.6 0.6", 1, 0.03) +
              "fix grid all mpm 0.1 frame total\nregion bar block 0 1 -0.2 0.2 -0.2 0.2\n"
              "create_points 1 region bar ppc 2\n"
              "fix m all mpm/material density 1000 neohookean 1e6 0.3\n"
              "fix walls all mpm/boundary xlo stick\nregion end plane 1 0 0 -1 0 0\n"
              "fix load all mpm/traction region end moment 300 100 -200\n" +
              solve + "run 2\n");
    const double *const f = run.fix_vector("load", 7);
    for (int d = 0; d < 3; d++) {
      EXPECT_NEAR(f[d], 0.0, 1e-9);
      EXPECT_NEAR(f[4 + d], d == 0 ? 300.0 : d == 1 ? 100.0 : -200.0, 1e-8);
    }
    const double *const r = run.fix_vector("walls", 3);
    for (int d = 0; d < 3; d++) EXPECT_NEAR(r[d], 0.0, 5e-4);
  }
}

TEST(Loads, RanksAndRestart)
{
  for (const char *load :
       {"region bore area $(PI/2) pressure v_p", "free pressure v_a", "region bore moment 0 0 2e4"})
    for (const char *solve : {"static", "euler", "static solver multigrid"}) {
      const auto scene = replaced(
          replaced(tube("pressure v_p", 0.3, 4, std::string(solve) + " tolerance 1e-11",
                        "0.2 frame total"),
                   "fix gas all mpm/traction region bore area $(PI/2) pressure v_p",
                   std::string("variable a atom v_p*(1+x*y)\nfix gas all mpm/traction ") + load),
          "timestep 1.0", "timestep 0.01");
      const auto next = "neighbor 0.03 bin\n" +
          replaced(scene.substr(scene.find("fix grid")),
                   "create_points 1 region tube ppc 2 outside ignore\n", "");
      Twins(scene, 2, next, 2, 1e-9);
    }
}

// what is not in the balance is refused, and truly named
SERIAL_TEST(Physics, ThatIsRefused)
{
  expect_refused(
      replaced(tube("pressure v_p", 0.1, 1, "static", "0.2 frame total"),
               "compute e all mpm/energy\nthermo_style custom step f_gas[4] c_e\n", ""),
      {{"fix water all mpm/pore 2e9 1000 9810 soil m 0.4 constant 1e-4", "use frame updated"},
       {"fix rest all mpm/relax 1e-5", "would not be in its balance"}},
      "run 1\n");
}

// A load on a disk of radius 1 on a block of radius and height 10, on rollers (U2): settlement of
// the surface at the middle and at the rim of the disk by finite elements that were refined, and
// the vertical stress a radius below, which is that of a half space (Boussinesq)
SERIAL_TEST(Boussinesq, SettlementAndStress)
{
  const double h = 0.25, p = 1e3, E = 1e7;
  Scene run(
      plane("si", "f f", "0 10 0 12", 1, 0.08) +
      strprintf("fix grid all mpm %g axisymmetric yes frame total\n", h) +
      "region soil block 0 10 0 10 INF INF\ncreate_points 1 region soil ppc 2\n" +
      strprintf("fix m all mpm/material density 1000 linear %g 0.3\n", E) +
      "fix walls all mpm/boundary xlo xhi ylo slip\nfix solve all mpm/implicit static\n" +
      strprintf("region under block 0 1 %g 11 INF INF\ngroup under region under\n"
                "fix load under mpm/traction points $(PI) 0 1 0 traction 0 %g 0\ntimestep 1\n",
                10.0 - 0.5 * h, -p));
  run.set_reference();
  run.commands("run 1\n");
  // columns next to the axis and to the rim, layers below the surface and around the depth
  std::map<tagint, double> sigma;
  for (const auto &point : run.gather()) sigma[(tagint) point.tag] = point.stress[1];
  double w[3][2], stress = 0.0;
  const double s = 0.5 * h, columns[3] = {0.5 * s, 1.0 - 0.5 * s, 1.0 + 0.5 * s};
  for (int i = 0; i < run.n(); i++) {
    const double *const X = run.reference(i);
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < 2; k++)
        if (std::fabs(X[0] - columns[c]) + std::fabs(X[1] - 10.0 + (k + 0.5) * s) < 1e-9)
          w[c][k] = (X[1] - run.x()[i][1]) * 0.1 * E / p;
    if (std::fabs(X[0] - columns[0]) < 1e-9 && std::fabs(X[1] - 9.0) < 0.51 * s)
      stress += 0.5 * sigma[run.lmp->atom->tag[i]] / p;
  }
  const auto surface = [&](int c) {
    return 1.5 * w[c][0] - 0.5 * w[c][1];
  };
  EXPECT_NEAR(measured("settlement", surface(0)) / 0.16907, 1.0, 0.01);
  EXPECT_NEAR(measured("at the rim", 0.5 * (surface(1) + surface(2))) / 0.10297, 1.0, 0.02);
  EXPECT_NEAR(measured("stress", stress) / -0.646447, 1.0, 0.03);
}
