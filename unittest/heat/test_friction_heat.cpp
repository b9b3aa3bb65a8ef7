// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 300

// Heat of friction: keyword heat of fix mpm/contact, fix mpm/boundary, and fix mpm/rigid.

#include "heat/heat_testing.h"
#include "mesh/stl_testing.h"

using namespace MPM_TEST;

// A block of 3000 kg/m^2 and 10 m/s is pressed on a base with 1 MPa and braked by friction of 0.3
// within 0.1 s. Density times specific heat is that of steel, density is higher, so that the block
// is no higher than heat gets

constexpr double STEEL = 7800.0 * 500.0, K = 50.0, PRESSURE = 1.0e6, MU = 0.3, SPEED = 10.0,
                 END = 0.1;

struct Braked {
  double n;    // nodes in the depth sqrt(k t/rho c) that heat gets to
  double modulus = 2e8;
  std::string base = "fix m2 base mpm/material density RHO neohookean MODULUS 0.3 thermal "
                     "conducting CP 0.0 50.0\n";
  std::string heat = "yes";
  std::string more;      // lines before the run
  double ramp = 1e-9;    // the pressure comes within this time
  std::string wall;      // in place of the base

  double h() const { return std::sqrt(K / STEEL * END) / n; }
  double height() const { return 4.0 * n * h(); }
  double rho() const { return 3000.0 / height(); }
  double c() const { return STEEL / rho(); }
  double width() const { return 4.0 * h(); }
  double dt() const { return 0.8 * h() / (1.05 * SPEED + std::sqrt(1.35 * modulus / rho())); }

  std::string scene() const
  {
    const std::string extent =
        strprintf("0 %.17g %.17g %.17g", width(),
                  wall.empty() ? -height() : (wall.find("ylo") == 0 ? 0.0 : -2.0 * h()),
                  height() + 2.0 * h());
    std::string text = plane("si", "p f", extent, 2, 0.1 * h());
    std::vector<Body> all = {{"block", strprintf("block INF INF 0 %.17g INF INF", height())}};
    if (wall.empty())
      all.push_back({"base", strprintf("block INF INF %.17g 0 INF INF", -height())});
    text += fields(all, strprintf("%.17g origin 0 0", h()));
    const auto numbers = [&](std::string line) {
      line = replaced(line, "RHO", strprintf("%.17g", rho()));
      line = replaced(line, "MODULUS", strprintf("%.17g", modulus));
      return replaced(line, "CP", strprintf("%.17g", c()));
    };
    text += numbers("fix m1 block mpm/material density RHO neohookean MODULUS 0.3 thermal "
                    "conducting CP 0.0 50.0\n");
    if (wall.empty())
      text += numbers(base) +
          "fix floor all mpm/boundary ylo stick\nfix touch all mpm/contact F1 F2 law coulomb 0.3 "
          "heat " +
          heat + "\n";
    else
      text += strprintf("region below block INF INF INF 0 INF INF\nfix touch all mpm/boundary %s "
                        "friction 0.3 heat %s\n",
                        wall.c_str(), heat.c_str());
    text +=
        strprintf("variable g equal %.17g*(0.5-0.5*cos(PI*time/%g))*(time<%g)+%.17g*(time>=%g)\n",
                  PRESSURE / 3000.0, ramp, ramp, PRESSURE / 3000.0, ramp);
    return text + "fix push block gravity v_g vector 0 -1 0\nfix heat all mpm/heat\n" +
        strprintf("velocity block set %g 0 0\ncompute e all mpm/energy\n", SPEED) + more;
  }
};

/** At rest until the pressure is there, then with its speed. */
static void press(Scene &run, const Braked &b)
{
  run.commands(strprintf("velocity block set 0 0 0\ntimestep %.17g\nrun %d\nreset_timestep 0\n",
                         b.dt(), (int) (1.2 * b.ramp / b.dt())) +
               "variable g delete\nuncompute e\ncompute e all mpm/energy\n" +
               strprintf("variable g equal %.17g\nvelocity block set %g NULL NULL\n",
                         PRESSURE / 3000.0, SPEED));
}

/** Up to this time, as nearly as steps allow. */
static void run_until(Scene &run, const Braked &b, double time)
{
  const auto done = (double) run.lmp->update->ntimestep;
  run.commands(
      strprintf("timestep %.17g\nrun %d\n", b.dt(), (int) std::lround(time / b.dt() - done)));
}

/** Temperature at the face y = 0 of a body of this type, from the two rows of points next to it. */
static double at_face(Scene &run, const std::string &material, int type, double h)
{
  auto *fix = run.material(material);
  const int column = fix->find_history("temperature");
  double rows[2] = {0.0, 0.0}, n[2] = {0.0, 0.0};
  for (int i = 0; i < run.n(); i++) {
    const double y = std::fabs(run.x()[i][1]);
    if (run.lmp->atom->type[i] != type || y > h) continue;
    rows[y > 0.5 * h] += fix->history[i][column];
    n[y > 0.5 * h]++;
  }
  return 1.5 * rows[0] / n[0] - 0.5 * rows[1] / n[1];
}

static double mean(Scene &run, const std::string &material)
{
  return Warm(run, material).mean();
}

static double heat_of(Scene &run, const std::string &material)
{
  return Warm(run, material).heat();
}

/** Rise at the face, for this sum of the effusivities of the bodies that heat flows to. */
static double rise(double t, double effusivities)
{
  return 2.0 * MU * PRESSURE * SPEED / (effusivities * std::sqrt(PI)) * std::sqrt(t) *
      (1.0 - 2.0 * t / (3.0 * END));
}
const double EFFUSIVITY = std::sqrt(K * STEEL);

// benchmark M5: both bodies of steel. Highest temperature at half of the time: 18.06853 K
SERIAL_TEST(Brake, HeatsBothFaces)
{
  EXPECT_NEAR(rise(0.5 * END, 2.0 * EFFUSIVITY), 18.06853, 1e-5);
  double error[3];
  for (const int k : first_of(1, {0, 1, 2})) {
    Braked b = {2.0 * (1 << k)};
    b.ramp = 0.02;
    Scene run(b.scene());
    press(run, b);
    EXPECT_EQ(heat_in(run), 0.0);
    run_until(run, b, 0.5 * END);
    const double T = at_face(run, "m1", 1, b.h()), U = at_face(run, "m2", 2, b.h());
    error[k] = measured(strprintf("h = %.3g mm, error at half of the time", 1e3 * b.h()),
                        0.5 * (T + U) / 18.06853 - 1.0);
    EXPECT_NEAR(T / U, 1.0, 0.01);
    run_until(run, b, END);
    const double end = measured("error at the end", at_face(run, "m1", 1, b.h()) / 12.77638 - 1.0);
    if (k == 2) {
      EXPECT_NEAR(error[2], 0.0, 8e-4);
      EXPECT_NEAR(end, 0.0, 5e-4);
    }
    EXPECT_NEAR(measured("heat per area", heat_in(run) / b.width()), 150000.0, 30.0);
    EXPECT_NEAR(measured("share", mean(run, "m1") / (mean(run, "m1") + mean(run, "m2"))), 0.5,
                1e-12);
    const double *const e = run.compute_vector();
    EXPECT_NEAR(e[10] / e[17], 0.0, 1e-11);    // residual
    EXPECT_NEAR(e[17] / -e[7], 1.0, 1e-12);    // heat of friction, work of contact
    EXPECT_NEAR(run.evaluate("f_touch") / e[7], 1.0, 1e-12);
    EXPECT_NEAR(e[14] / e[17], 1.0, 1e-11);    // what points have got
  }
  if (!is_quick()) EXPECT_LT(std::fabs(error[1]), 0.3 * std::fabs(error[0]));
}

// what the kinetic energy loses is heat, when the pressure comes slowly, so that nothing vibrates
SERIAL_PARAMETER_TEST(Energy, LostIsHeat, const char *, Values("", "separate", "slip"))
{
  LONG_AFTER(1);
  Braked b = {2.0, 1e9};
  b.ramp = 0.03;
  const std::string kind = GetParam();
  if (!kind.empty()) b.wall = "ylo " + kind;
  Scene run(b.scene() + "run 0\n");
  const double kinetic = run.compute_vector()[0];
  run_until(run, b, END);
  const double *const e = run.compute_vector();
  const double heat = e[17], lost = kinetic - e[0] + e[5] - e[1];    // external work, stored energy
  EXPECT_GT(heat, 0.9 * kinetic);
  EXPECT_NEAR(measured("lost/heat - 1", lost / heat - 1.0), 0.0, 4e-8);
  EXPECT_NEAR(e[17] / -e[kind.empty() ? 7 : 6], 1.0, 1e-12);
  EXPECT_NEAR(run.fix("heat")->compute_vector(7) * run.lmp->update->dt, 0.0, 8e-5 * heat);
}

// contact with musl loses energy that is no heat
TEST(Musl, IsWarnedOf)
{
  for (const bool musl : {false, true}) {
    std::string scene = Braked{2.0}.scene();
    for (int body = 0; musl && body < 2; body++)
      scene = replaced(scene, "origin 0 0\n", "origin 0 0 scheme musl\n");
    EXPECT_EQ(lines_that_say(scene + "run 0\n", "with scheme musl").size(), musl ? 1 : 0);
  }
}

// bodies share heat like their effusivities, 1 to 4; or as they are told; or one of them gets all
SERIAL_TEST(Share, IsThatOfEffusivities)
{
  LONG_CASE();
  Braked b = {4.0};
  b.base = replaced(b.base, "50.0", "800.0");
  Scene run(b.scene());
  run_until(run, b, 0.5 * END);
  const double share = mean(run, "m1") / (mean(run, "m1") + mean(run, "m2"));
  EXPECT_NEAR(measured("share", share) / 0.2, 1.0, 0.02);
  const double exact = rise(0.5 * END, 5.0 * EFFUSIVITY);
  EXPECT_NEAR(measured("upper face", at_face(run, "m1", 1, b.h()) / exact), 1.0, 0.03);

  b = {2.0};
  b.heat = "share 0.3";
  Scene told(b.scene());
  run_until(told, b, 0.02);
  EXPECT_NEAR(mean(told, "m1") / (mean(told, "m1") + mean(told, "m2")), 0.3, 1e-3);

  b = {4.0};
  b.base = replaced(b.base, " thermal conducting CP 0.0 50.0", "");
  Scene insulating(b.scene());
  run_until(insulating, b, 0.5 * END);
  EXPECT_NEAR(measured("insulating base", at_face(insulating, "m1", 1, b.h()) / 36.13705), 1.0,
              0.03);
}

// a base of two materials in layers of points has their effusivities by volume
SERIAL_TEST(Share, OfMixedBodies)
{
  // every second point of the base conducts 16 times as well
  Braked b = {2.0};
  b.base = "variable odd atom id%2==1\ngroup odd variable odd\ngroup right intersect base odd\n"
           "group left subtract base odd\n" +
      replaced(b.base, "m2 base", "m2 left") +
      replaced(replaced(b.base, "m2 base", "m3 right"), "50.0", "800.0");
  Scene run(b.scene());
  run_until(run, b, 0.01);
  const double up = mean(run, "m1"), l = mean(run, "m2"), r = mean(run, "m3");
  EXPECT_NEAR(measured("share", up / (up + 0.5 * (l + r))), 1.0 / (1.0 + 2.5), 1e-3);
  EXPECT_NEAR(run.compute_vector()[14] / run.compute_vector()[17], 1.0, 1e-11);
}

/** A block slides on another one that conducts like this; the normal is along the last axis. */
static std::string sliding(int dim, const std::string &below)
{
  const std::string flat = dim == 2 ? "INF INF " : "INF INF INF INF ", up = dim == 2 ? "y" : "z";
  return box(dim, "lj", dim == 2 ? "p f p" : "p p f", dim == 2 ? "0 1 -2 3 0 0" : "0 1 0 1 -2 3", 2,
             0.1) +
      fields({{"upper", "block " + flat + "0 2" + (dim == 2 ? " INF INF" : "")},
              {"lower", "block " + flat + "-2 0" + (dim == 2 ? " INF INF" : "")}},
             "0.25") +
      "fix m1 upper mpm/material density 1 neohookean 1e5 0.3 thermal conducting 1 0 1\n"
      "fix m2 lower mpm/material density 1 neohookean 1e5 0.3 thermal conducting 1 0 " +
      below +
      "\nfix touch all mpm/contact F1 F2 law coulomb 0.3 heat yes\nfix heat all mpm/heat\n"
      "fix floor all mpm/boundary " +
      up + "lo stick\nfix g all gravity 1 vector 0 " + (dim == 2 ? "-1 0" : "0 -1") +
      "\nvelocity upper set 1 0 0\ntimestep 5e-4\nrun 60\n";
}

struct Share {
  int dim;
  std::string below;
  double K;    // along the normal
};

// of an orthotropic body it is the conductivity along the normal that counts, wherever its axes are
SERIAL_PARAMETER_TEST(ShareOrthotropic, IsThatAlongTheNormal, Share,
                      Values(Share{2, "16 orthotropic 4 1", 4.0},
                             Share{2, "4 orthotropic 16 1 angle 90", 4.0},
                             Share{2, "1 orthotropic 17 1 angle 45", 9.0},
                             Share{3, "16 orthotropic 1 4", 4.0},
                             Share{3, "1 orthotropic 17 3 axes 0 1 1 0 1 -1", 9.0},
                             Share{3, "4 orthotropic 1 9 axes 0 0 1 1 0 0", 4.0}))
{
  const Share &share = GetParam();
  Scene run(sliding(share.dim, share.below));
  const double up = mean(run, "m1"), low = mean(run, "m2");
  EXPECT_GT(up, 0.0);
  EXPECT_NEAR(measured("share", up / (up + low)), 1.0 / (1.0 + std::sqrt(share.K)), 2e-5);
}

// so with points of another material among them, by the mean roots of conductivities
TEST(ShareOrthotropic, AgreesOnRanks)
{
  const std::string scene = replaced(
      replaced(sliding(3, "1 orthotropic 17 3 axes 0 1 1 0 1 -1"), "1e5", "1000"), "fix touch",
      "region part block 0 0.5 INF INF -2 0\ngroup part region part\ngroup rest subtract "
      "lower part\n"
      "unfix m2\n"
      "fix m2 rest mpm/material density 1 neohookean 1000 0.3 thermal conducting 1 0 1 "
      "orthotropic 17 "
      "3 axes 0 1 1 0 1 -1\n"
      "fix m3 part mpm/material density 1 neohookean 1000 0.3 thermal conducting 1 0 "
      "25\nfix touch");
  OnRanks run(scene, "run 20\n");
  EXPECT_LT(run.difference(), 1e-11);
  EXPECT_NEAR(heat_of(run.parallel, "m1") / heat_of(run.serial, "m1"), 1.0, 1e-11);
  // layers of two effusivities, 3 and 5, side by side
  const double up = heat_of(run.serial, "m1"),
               low = heat_of(run.serial, "m2") + heat_of(run.serial, "m3");
  const double share = measured("share", up / (up + low));
  EXPECT_GT(share, 1.0 / 6.0);
  EXPECT_LT(share, 1.0 / 4.0);
}

// a wall is an insulator: all heat goes to the block, also from a region at and between nodes
SERIAL_PARAMETER_TEST(Wall, IsInsulator, const char *,
                      Values("ylo separate", "ylo slip", "region below separate"))
{
  LONG_AFTER(1);
  Braked b = {4.0};
  b.wall = GetParam();
  Scene run(b.scene());
  run_until(run, b, 0.5 * END);
  EXPECT_NEAR(measured("face", at_face(run, "m1", 1, b.h()) / 36.13705), 1.0, 0.03);
  const double *const e = run.compute_vector();
  EXPECT_NEAR(e[17] / -e[6], 1.0, 1e-12);
  EXPECT_NEAR(e[14] / e[17], 1.0, 1e-11);
  EXPECT_NEAR(e[10] / e[17], 0.0, 1e-11);
  b.heat = "share 0.25";
  Scene part(b.scene());
  run_until(part, b, 0.01);
  const double *const some = part.compute_vector();
  EXPECT_NEAR(some[17] / -some[6], 0.25, 1e-12);
}

// only the motion relative to the wall counts: a block that slides on a wall at rest, a wall that
// slides under a block at rest, and both by halves make the same heat, that of the law of Coulomb
SERIAL_PARAMETER_TEST(WallThatMoves, HeatsAlike, const char *,
                      Values("ylo separate", "ylo slip", "region below separate"))
{
  const bool is_face = GetParam()[0] == 'y';
  constexpr double WEIGHT = 2.0, RELATIVE = 3.0, FRICTION = 0.25;
  double heat = 0.0;
  for (const double block : {RELATIVE, 0.0, 0.5 * RELATIVE}) {
    Scene run(plane("lj", "p f", is_face ? "0 2 0 4" : "0 2 -1 4", 1, 0.1) +
              body("block INF INF 0 2 INF INF",
                   "density 1 neohookean 5000 0.3 thermal conducting 1 0 0.1", "0.25") +
              "region below block INF INF INF 0 INF INF\n" +
              strprintf("fix w all mpm/boundary %s friction %g heat yes velocity %g 0 0\n",
                        GetParam(), FRICTION, block - RELATIVE) +
              strprintf("fix heat all mpm/heat\ncompute e all mpm/energy\n"
                        "fix g all gravity %g vector 0 -1 0\nvelocity all set %g 0 0\n"
                        "timestep 0.001\n",
                        WEIGHT, block));
    run.commands("run 1000\n");
    const double m = run.sums().mass, end = run.sums().p[0] / m - (block - RELATIVE);
    const double *const e = run.compute_vector();
    const auto what = strprintf("block at %g: ", block);
    EXPECT_NEAR(measured(what + "velocity along the wall at the end", end),
                RELATIVE - FRICTION * WEIGHT, 0.01);
    EXPECT_NEAR(measured(what + "heat over energy of the relative motion",
                         e[17] / (0.5 * m * (RELATIVE * RELATIVE - end * end))),
                1.0, 0.01);
    if (heat > 0.0) EXPECT_NEAR(e[17] / heat, 1.0, 1e-9);
    heat = e[17];
    EXPECT_NEAR(e[14] / e[17], 1.0, 1e-11);    // what points have got
    EXPECT_NEAR(e[10] / e[17], 0.0, 1e-10);    // residual
  }
}

// A block hits a wall at an angle: what it loses of its motion along the wall is heat, what nodes
// lose as they meet the wall is none. Friction at its lower face also turns and shears the block,
// which takes 3.6 to 3.8 % of that with 4, 8, and 16 cells in its height and steps of half the
// length: no error that would become less
SERIAL_PARAMETER_TEST(Impact, OfThePushIsNoHeat, const char *, Values("ylo", "region below"))
{
  Scene run(plane("lj", "p f", "0 20 -1 8", 1, 0.2) +
            body("block 6 10 0.3 2.3 -0.5 0.5",
                 "density 1 neohookean 2000 0.3 thermal conducting 1 0 0.1", "0.5") +
            replaced("region below block INF INF INF 0 INF INF\nfix w all mpm/boundary WHERE "
                     "separate friction 0.1 "
                     "heat yes\nfix heat all mpm/heat\ncompute e all mpm/energy\n",
                     "WHERE", GetParam()) +
            (std::string(GetParam()) == "ylo" ? "displace_atoms all move 0 -1 0 units box\n" : "") +
            "velocity all set 5 -2 0\ntimestep 0.002\nrun 0\n");
  const double m = run.sums().mass, before = run.sums().p[0] / m;
  run.commands("run 500\n");
  const double after = run.sums().p[0] / m;
  EXPECT_LT(measured("velocity along the wall", after), 4.9);
  EXPECT_GT(run.sums().p[1], 0.0);
  const double heat = run.compute_vector()[17];
  EXPECT_NEAR(measured("heat over energy of the motion along the wall",
                       heat / (0.5 * m * (before * before - after * after))),
              1.0, 0.05);
}

// nothing slides: not a bit of heat
SERIAL_PARAMETER_TEST(Sticks, MakesNoHeat, const char *,
                      Values("", "ylo separate", "region below separate"))
{
  LONG_AFTER(1);
  Braked b = {2.0};
  b.wall = GetParam();
  b.ramp = 0.01;
  b.more = "velocity block set 0 0 0\nvariable gx equal 0.5*0.3*v_g\nfix tilt block gravity v_gx "
           "vector 1 0 0\n";
  Scene run(b.scene());
  run_until(run, b, 0.02);
  EXPECT_EQ(heat_in(run), 0.0);
  EXPECT_GT(run.fix("touch")->compute_scalar() + run.compute_vector()[5], 0.0);
  EXPECT_EQ(mean(run, "m1"), 0.0);
}

/** Two disks, one of two materials, slide along each other and the floor. */
const std::string disks = plane("lj", "p f", "0 16 0 8", 3, 0.4) +
    fields({{"one", "cylinder z 3.1 2.5 2.5 INF INF"}, {"two", "cylinder z 12.9 3.3 2.5 INF INF"}},
           "0.5") +
    R"(
region part block 0 3 0 8 -0.5 0.5
group part region part
group other subtract one part
fix m1 other mpm/material density 1 neohookean 50 0.3 thermal conducting 1.0 0.5 0.3
fix m2 part mpm/material density 2 neohookean 50 0.3 thermal conducting 0.7 1.0 0.1
fix m3 two mpm/material density 1 neohookean 80 0.3 thermal conducting 2.0 0.0 0.2
fix c all mpm/contact F1 F2 law coulomb 0.3 heat yes
fix w all mpm/boundary ylo separate friction 0.4 heat share 0.6
fix heat all mpm/heat
fix g all gravity 0.5 vector 0 -1 0
velocity one set -1.5 -0.2 0
velocity two set 1.0 -0.4 0
timestep 0.01
)";

static double heat(Scene &run)
{
  return heat_of(run, "m1") + heat_of(run, "m2") + heat_of(run, "m3");
}

PARAMETER_TEST(Disks, AgreeOnRanksAndCloseTheLedger, const char *,
               Values("", "scheme musl", "transfer flip 0.99"))
{
  LONG_AFTER(1);
  const std::string scene = replaced(disks, "mpm 0.5\n", strprintf("mpm 0.5 %s\n", GetParam()));
  Scene start(disks + "run 0\n");
  const double before = heat(start);
  OnRanks run(scene + "compute e all mpm/energy\n", "run 300\n");
  EXPECT_LT(run.difference(), 1e-11);
  const double made = run.parallel.compute_vector()[17];
  EXPECT_GT(measured("heat", made), 0.01);
  EXPECT_LT(run.parallel.evaluate("f_c"), -0.01);    // of both kinds
  EXPECT_LT(run.parallel.evaluate("f_w"), -0.01);
  EXPECT_NEAR(made, -run.parallel.evaluate("f_c") - 0.6 * run.parallel.evaluate("f_w"), 1e-11);
  EXPECT_NEAR(heat(run.parallel) - before, made, 1e-11 * before);
  EXPECT_NEAR(made / run.serial.compute_vector()[17], 1.0, 1e-10);
  EXPECT_NEAR(run.parallel.compute_vector()[10], 0.0, 1e-10);
}

TEST(Disks, ContinueFromARestartFile)
{
  Continued run(disks, 200, lines_again(disks), 60);
  EXPECT_TRUE(identical(run.whole.gather(), run.again.gather()));
  EXPECT_EQ(heat_in(run.whole), heat_in(run.again));
  Scene never(disks + "run 260\n");    // written
  EXPECT_NEAR(heat_in(run.again) / heat_in(never), 1.0, 1e-12);
  EXPECT_EQ(heat(run.whole), heat(run.again));
}

// heat in other units: an energy of mvv2e
SERIAL_TEST(Units, Metal)
{
  const std::string scene = plane("metal", "p f", "0 40 0 80", 1, 2.0) +
      "fix F1 all mpm 10\nregion low block INF INF 0 60 INF INF\ncreate_points 1 region low ppc 2\n"
      "fix m all mpm/material density 0.5 neohookean 1e5 0.3 thermal conducting 1e-3 300 1e-4\n"
      "fix w all mpm/boundary ylo slip friction 0.4 heat yes\nfix heat all mpm/heat\ncompute e all "
      "mpm/energy\n"
      "fix push all gravity 5e-3 vector 0 -1 0\nvelocity all set 5 0 0\ntimestep 0.005\n";
  Scene run(scene + "run 0\n");
  const double kinetic = run.compute_vector()[0];
  run.commands("run 600\n");
  const double *const e = run.compute_vector();
  EXPECT_GT(measured("heat/kinetic energy", e[17] / kinetic), 0.05);
  EXPECT_NEAR(e[17] / -e[6], 1.0, 1e-11);
  EXPECT_NEAR(e[14] / e[17], 1.0, 1e-10);
  EXPECT_NEAR(e[10] / e[17], 0.0, 1e-11);
}

// a rigid body that slides on a block: what both lose is heat of the block
SERIAL_TEST(RigidBody, HeatsTheMaterial)
{
  const ScratchFile file("box.stl", binary_of(torus(1.0, 0.5, 24)));
  Scene run(space("lj", "p p f", "0 8 0 4 -3 4", 1, 0.2) +
            "fix grid all mpm 0.5\nregion low block INF INF INF INF -3 0\ncreate_points 1 region "
            "low ppc 2\n"
            "fix m all mpm/material density 1 neohookean 300 0.3 thermal conducting 1.0 0.0 0.1\n"
            "fix floor all mpm/boundary zlo stick\n"
            "region ring mpm/mesh " +
            file.name +
            " 1.0 2 2 0.45\n"
            "fix tool all mpm/rigid ring density 4 separate friction 0.3 heat yes velocity 2 0 0 "
            "gravity 0 0 -1\n"
            "fix heat all mpm/heat\ncompute e all mpm/energy\ntimestep 0.005\nrun 0\n");
  const MPM_NS::SurfaceMesh mesh(binary_of(torus(1.0, 0.5, 24)), "torus", 1.0, {0.0, 0.0, 0.0});
  const double kinetic = run.fix("tool")->compute_scalar();
  const double z = run.fix_vector("tool", 24)[2];
  run.commands("run 300\n");
  // what body and block lose: the motion of the body, its weight, and what the block has got of it;
  // but for what nodes lose when the body meets them, which the ledger has under transfers
  const double fall = 4.0 * mesh.volume * (z - run.fix_vector("tool", 24)[2]);
  const double *const e = run.compute_vector();
  const double lost =
      kinetic - run.fix("tool")->compute_scalar() + fall - e[0] - e[1] + e[8] + e[9];
  EXPECT_NEAR(measured("lost/heat", lost / e[17]), 1.0, 8e-4);
  EXPECT_NEAR(e[14] / e[17], 1.0, 1e-11);
  EXPECT_NEAR(e[10], 0.0, 1e-10);
}

SERIAL_TEST(BadInput, IsRefused)
{
  const std::string bare = plane("lj", "p f", "0 4 0 8", 2, 0.1) +
      fields({{"up", "block 0 4 4 8 -0.5 0.5"}, {"low", "block 0 4 0 4 -0.5 0.5"}});
  const std::string scene = bare +
      "fix m all mpm/material density 1 eos linear 1 thermal conducting 1 0 1\ntimestep 0.01\n";
  expect_refused(
      scene,
      {{"fix c all mpm/contact F1 F2 heat yes\nfix h all mpm/heat", "use law coulomb or adhesive"},
       {"fix c all mpm/contact F1 F2 law stick heat yes\nfix h all mpm/heat",
        "use law coulomb or adhesive"},
       {"fix c all mpm/contact F1 F2 law coulomb 0.3 heat share 1.2\nfix h all mpm/heat", "heat"},
       {"fix c all mpm/contact F1 F2 law coulomb 0.3 heat yes", "define a fix mpm/heat"},
       {"fix b all mpm/boundary ylo slip heat yes\nfix h all mpm/heat", "needs a coefficient"},
       {"fix b all mpm/boundary ylo slip friction 0.3 heat yes", "define a fix mpm/heat"}},
      "run 1\n");
  expect_error(bare +
                   "fix m all mpm/material density 1 eos linear 1 thermal conducting 1 0 1 "
                   "orthotropic 100 1 axes 1 0 0 0 1 1\ntimestep 0.01\nfix h all mpm/heat\n"
                   "fix c all mpm/contact F1 F2 law coulomb 0.3 heat yes\nrun 1\n",
               "must be normal to the plane");
  expect_error(
      bare +
          "group none type 3\nfix m all mpm/material density 1 eos linear 1\n"
          "fix b all mpm/boundary ylo slip friction 0.3 heat yes\nfix h all mpm/heat\nrun 1\n",
      "conduct");
}
