// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 300

// Fix mpm/heat contact: heat between bodies that touch.

#include "heat/heat_testing.h"

using namespace MPM_TEST;

constexpr int CONTACT = 9;    // place in the vector of fix mpm/heat

/** Two bodies of types 1 and 2 in fields of their own, capacity 1. a, b: regions; Ta, ka:
 *  temperatures, conductivities; moved: commands before the fixes; heat: after "conductance". */
struct Two {
  std::string a, b, grid, heat;
  double Ta = 1.0, Tb = 0.0;
  std::string ka = "1.0", kb = "1.0", moved = "";

  std::string text(double spacing) const
  {
    return "region a block " + a + " INF INF\nregion b block " + b + " INF INF\n" +
        strprintf("create_points 1 region a spacing %.17g\n", spacing) +
        strprintf("create_points 2 region b spacing %.17g\n", spacing) +
        "group a type 1\ngroup b type 2\n" + moved + "fix ga a mpm " + grid + "\nfix gb b mpm " +
        grid + "\n" + conductor(ka, Ta, "ma a") + conductor(kb, Tb, "mb b") +
        "fix touch all mpm/contact ga gb\nfix heat all mpm/heat contact ga gb conductance " + heat +
        "\n";
  }
};

/** Two bars of length 1 along x, periodic along y, of the conductivities 1 and 4, with n cells
 *  each; their interface is at x = 1 + gap/2, and shift node spacings from a node. */
struct Bars {
  int n = 20;
  double shift = 0.0;
  std::string heat;
  double Ta = 0.0;
  std::string velocity = "";
  double gap = 0.0;    // in cells; both bars end at faces of the box
  std::string grid = "";

  std::string text() const
  {
    const double h = 1.0 / n;
    const bool flies = !velocity.empty();
    return plane("lj", flies ? "p p" : "f p",
                 strprintf("%.17g %.17g 0 %.17g", flies ? -2.0 : 0.0, (flies ? 4.0 : 2.0) + gap * h,
                           4 * h),
                 2, 0.1 * h) +
        Two{"0 1 INF INF",
            strprintf("%.17g %.17g INF INF", 1.0 + gap * h, 2.0 + gap * h),
            strprintf("%.17g origin %.17g 0 ", h, 1.0 - shift * h) + grid,
            heat,
            Ta,
            0.0,
            "1.0",
            "4.0"}
            .text(0.5 * h) +
        velocity;
  }
};

/** Two halves of a square around the origin, with n cells along its sides, that is turned. */
static std::string halves(int n, double offset, int degrees)
{
  const double h = 1.0 / n;
  return plane("lj", "f f", "-1 1 -1 1", 2, 0.1 * h) +
      Two{"-0.5 0 -0.5 0.5",
          "0 0.5 -0.5 0.5",
          strprintf("%.17g origin %.17g 0", h, offset * h),
          "1.0",
          1.0,
          0.0,
          "1.0",
          "1.0",
          strprintf("displace_atoms all rotate 0 0 0 0 0 1 %d\n", degrees)}
          .text(0.5 * h);
}

/** Temperature at the interface at x = 1 of the points of one of the bars. */
static double face(Scene &run, const std::string &id, double h)
{
  return measured("face of " + id, Warm(run, id).at_face(1.0, id == "ma" ? -1 : 1, h));
}

static double total_heat(Scene &run)
{
  return Warm(run, "ma").heat() + Warm(run, "mb").heat();
}

// bars of conductivity 1 and 4 between 1 and 0, conductance 2: q = 4/7, faces 3/7 and 1/7
SERIAL_TEST(Steady, FluxAndFaces)
{
  for (const double shift : {0.0, 0.25, 0.5})
    for (const int n : first_of(1, {20, 40})) {
      Scene run(Bars{n, shift, "2.0 xlo temperature 1.0 xhi temperature 0.0 stages 64"}.text() +
                "timestep 0.02\nrun 200\n");
      const double *const power = run.fix_vector("heat", 10);
      const double area = 4.0 / n;
      EXPECT_NEAR(measured(strprintf("%g %d q", shift, n), power[CONTACT] / area), 4.0 / 7.0, 2e-7);
      EXPECT_NEAR(power[0] / power[CONTACT], 1.0, 1e-6);
      EXPECT_NEAR(power[1] / power[CONTACT], -1.0, 4e-7);
      EXPECT_NEAR(face(run, "ma", 1.0 / n), 3.0 / 7.0, 2e-7);
      EXPECT_NEAR(face(run, "mb", 1.0 / n), 1.0 / 7.0, 8e-8);
    }
}

// the same with other shape functions; linear: exact for points in the middle of halves of cells
SERIAL_PARAMETER_TEST(SteadyWithShapes, FluxAndFaces, const char *,
                      Values("shape linear", "shape cubic", "shape gimp", "shape cpdi"))
{
  const std::string shape = GetParam();
  for (const double shift : first_of(1, {shape == "shape linear" ? 0.4 : 0.25, 0.0, 0.5})) {
    Scene run(Bars{20, shift, "2.0 xlo temperature 1.0 xhi temperature 0.0 stages 64", 0.0, "", 0.0,
                   shape}
                  .text());
    run_to(run, 4.0, shape == "shape linear" ? 0.005 : 0.02);
    const double *const power = run.fix_vector("heat", 10);
    EXPECT_NEAR(measured(strprintf("%g q", shift), power[CONTACT] * 5.0) / (4.0 / 7.0), 1.0, 0.01);
    EXPECT_NEAR(power[0] / power[CONTACT], 1.0, 1e-6);
    EXPECT_NEAR(face(run, "ma", 0.05) / (3.0 / 7.0), 1.0, 0.01);
    EXPECT_NEAR(face(run, "mb", 0.05) / (1.0 / 7.0), 1.0, 0.01);
  }
}

// two tubes around an axis of symmetry, one in the other, of conductivity 1 and 4 from r = 1 to 1.5
// to 2, between 1 and 0: the power is 2 pi over the sum of ln(1.5), 1/(1.5 H), and ln(4/3)/4
SERIAL_PARAMETER_TEST(Axis, HeatThroughTwoTubes, const char *,
                      Values("", "shape cubic", "shape linear"))
{
  constexpr double h = 0.05;
  for (const double offset : {0.0, GetParam() == std::string("shape linear") ? 0.5 : 0.4})
    for (const double H : {2.0, 1e9}) {
      const std::string grid =
          strprintf("%g origin %.17g 0 axisymmetric yes %s\n", h, 1.0 - offset * h, GetParam());
      Scene run(plane("lj", "f p", strprintf("1 2 0 %g", 4 * h), 2, 0.1 * h) +
                "region a block 1 1.5 INF INF INF INF\nregion b block 1.5 2 INF INF INF INF\n"
                "group a empty\ngroup b empty\n"
                "fix ga a mpm " +
                grid + "fix gb b mpm " + grid +
                strprintf("create_points 1 region a spacing %g\n", 0.5 * h) +
                strprintf("create_points 2 region b spacing %g\n", 0.5 * h) +
                "group a type 1\ngroup b type 2\n" + conductor("1.0", 0.5, "ma a") +
                conductor("4.0", 0.5, "mb b") + "fix touch all mpm/contact ga gb\n" +
                strprintf("fix heat all mpm/heat contact ga gb conductance %g xlo temperature 1 "
                          "xhi temperature 0 stages 64\n",
                          H));
      run_to(run, 2.0, 1.0 * h * h);
      const double *const power = run.fix_vector("heat", 10);
      const double exact =
          2.0 * PI * 4.0 * h / (std::log(1.5) + 1.0 / (1.5 * H) + std::log(4.0 / 3.0) / 4.0);
      EXPECT_NEAR(measured(strprintf("offset %g, H %g", offset, H), power[CONTACT] / exact), 1.0,
                  0.01);
      EXPECT_NEAR(power[0] / power[CONTACT], 1.0, 1e-10);
    }
}

// half-spaces of effusivity 1 and 2, at 1 and 0, conductance 2, at t = 0.1: 0.628014, 0.185993,
// flux 0.884043. Lengths here are in a unit in which that is t = 0.01, and h_c = 2 sqrt(10)
SERIAL_TEST(HalfSpaces, Faces)
{
  for (const double shift : {0.0, 0.25, 0.5})
    for (const int n : first_of(1, {40, 80})) {
      Scene run(Bars{n, shift, strprintf("%.17g", 2.0 * std::sqrt(10.0)), 1.0}.text());
      const double before = total_heat(run);
      run_to(run, 0.01, 0.02 / (n * n));
      EXPECT_NEAR(face(run, "ma", 1.0 / n), 0.628014, 0.00628);
      EXPECT_NEAR(face(run, "mb", 1.0 / n), 0.185993, 0.00186);
      const double *const power = run.fix_vector("heat", 10);
      EXPECT_NEAR(
          measured(strprintf("%g %d flux", shift, n), power[CONTACT] * n / 4.0 / std::sqrt(10.0)),
          0.884043, 3e-4);
      EXPECT_NEAR(total_heat(run) / before, 1.0, 1e-13);
    }
}

// so in longer steps, in which stages keep up with the exchange
SERIAL_TEST(HalfSpaces, FacesInLongSteps)
{
  constexpr int n = 40;
  for (double step = 0.02; step < 0.6; step *= 1.3) {
    Scene run(Bars{n, 0.25, strprintf("%.17g", 2.0 * std::sqrt(10.0)), 1.0}.text());
    const double before = total_heat(run);
    run_to(run, 0.01, step / (n * n));
    EXPECT_NEAR(face(run, "ma", 1.0 / n), 0.628014, 0.0015) << step;
    EXPECT_NEAR(face(run, "mb", 1.0 / n), 0.185993, 0.001) << step;
    EXPECT_NEAR(total_heat(run) / before, 1.0, 1e-13);
  }
}

// perfect contact, faster than the limit of a step: 1/3 at once, and errors that go away with the
// spacing
SERIAL_TEST(Perfect, IsTheLimit)
{
  for (const double shift : {0.0, 0.25, 0.5}) {
    double error[2];
    for (const int n : {20, 40}) {
      Scene run(Bars{n, shift, "1e12", 1.0}.text());
      const double before = total_heat(run);
      run_to(run, 0.02, 0.04 / (n * n));
      error[n == 40] = std::max(std::fabs(face(run, "ma", 1.0 / n) - 1.0 / 3.0),
                                std::fabs(face(run, "mb", 1.0 / n) - 1.0 / 3.0));
      EXPECT_NEAR(total_heat(run) / before, 1.0, 1e-13);
    }
    EXPECT_LT(error[1], 3e-4) << shift;
    EXPECT_GT(measured("order", std::log2(error[0] / error[1])), 0.9) << shift;
  }
}

// two bodies of capacities 1 and 3, h A = 0.5: the difference at t = 1 is 0.513417
SERIAL_TEST(Lumped, Decays)
{
  for (const double H : {0.5, 0.0}) {
    Scene run(
        plane("lj", "f p", "0 4 0 1", 2, 0.01) + strprintf("variable H equal %g\n", H) +
        Two{"0 1 INF INF", "1 4 INF INF", "0.2", "v_H stages 201", 1.0, 0.0, "1e3", "1e3"}.text(
            0.1) +
        "timestep 0.005\nrun 200\n");
    const double difference = Warm(run, "ma").heat() / 1.0 - Warm(run, "mb").heat() / 3.0;
    EXPECT_NEAR(measured("difference", difference), H > 0.0 ? 0.513417 : 1.0, 8e-4);
    EXPECT_NEAR(total_heat(run), 1.0, 1e-13);
  }
}

// what one body loses, the other one gets, in each step, and it is the sum of the powers; a gap
SERIAL_TEST(Gap, Insulates)
{
  for (const double gap : {0.0, 0.5, 1.5}) {
    Scene run(Bars{20, 0.0, "5.0", 1.0, "", gap}.text() + "timestep 1e-4\n");
    double A = Warm(run, "ma").heat(), B = Warm(run, "mb").heat();
    const double all = A + B;
    for (int k = 0; k < 5; k++) {
      run.commands("run 1\n");
      const double a = Warm(run, "ma").heat(), b = Warm(run, "mb").heat();
      const double power = run.fix_vector("heat", 10)[CONTACT];
      if (gap == 0.0)
        EXPECT_GT(power, 0.1);
      else
        EXPECT_EQ(power, 0.0);
      EXPECT_NEAR((A - a) / all, 1e-4 * power / all, 1e-13);
      EXPECT_NEAR((b - B) / all, 1e-4 * power / all, 1e-15);
      A = a;
      B = b;
    }
    EXPECT_EQ(heat_in(run), 0.0);
  }
}

// bodies that move together across the lattice exchange what they do at rest
SERIAL_TEST(Moving, ExchangesTheSame)
{
  double T[2];
  for (const bool moves : {false, true}) {
    const std::string velocity = strprintf("velocity all set %g 0 0\n", moves ? 37.3 : 0.0);
    Scene run(Bars{40, 0.0, "6.0", 1.0, velocity}.text() + "timestep 2e-5\nrun 500\n");
    T[moves] = measured("heat of the first bar", Warm(run, "ma").heat() / (4.0 / 40));
  }
  EXPECT_NEAR((1.0 - T[1]) / (1.0 - T[0]), 1.0, 0.001);
}

/** Two squares of 1 x 1 that touch, with 10 cells along their sides, conductivities of 1e-2 and
 *  2e-2, room around them, and regions: low below the first one, right where it is said. */
static std::string two_squares(double offset, const std::string &right, const std::string &heat)
{
  return plane("lj", "f f", "-0.5 2.5 -0.5 1.5", 2, 0.02) +
      "region low block -1 1 -1 0 INF INF\nregion right block " + right + " INF INF\n" +
      Two{"0 1 0 1",
          "1 2 0 1",
          strprintf("0.1 dtcheck no origin %g %g", offset, offset),
          heat + " stages 9 transfer relax 0",
          1.0,
          1.0,
          "1e-2",
          "2e-2"}
          .text(0.05);
}

// a contact that ends at regions of different temperatures: powers do not depend on the time step.
// A layer that takes its heat once in a step would let through h/dt, here once and five times the
// conductance of a cell: a difference of 40 %
SERIAL_TEST(Edge, DoesNotDependOnTheTimeStep)
{
  for (const double offset : first_of(1, {0.03, 0.0})) {
    double power[2][3];
    for (const bool is_long : {false, true}) {
      Scene run(two_squares(offset, "2 3 -1 2",
                            "1e3 region low convection 1e3 0.0 region right temperature 2.0 "
                            "source v_q") +
                "variable q atom 1e-2*gmask(a)\n");
      run_to(run, 300.0, is_long ? 1.0 : 0.2);
      const double *const all = run.fix_vector("heat", 12);
      for (int k = 0; k < 3; k++) power[is_long][k] = measured("power", all[9 + k]);
    }
    for (int k = 0; k < 3; k++) EXPECT_NEAR(power[1][k] / power[0][k], 1.0, 0.02) << k;
    // steady: from finite volumes of 1/10 to 1/80, extrapolated. The flux is infinite at the end of
    // the contact, so that it converges slowly: 22 % less here, and 14 and 8 % with 20 and 40 cells
    EXPECT_NEAR(power[0][0] + power[0][1], -0.01, 1e-4);
    EXPECT_NEAR(power[0][1] / 0.0196, 1.0, 0.25);
    EXPECT_NEAR(-power[0][2] / 0.0196, 1.0, 0.25);
  }
}

// two bodies at different temperatures below, and a contact that ends there: what it lets through
// at the edge is what conduction does, whatever the conductance and the time step are
SERIAL_TEST(Edge, BetweenTwoTemperatures)
{
  for (const double offset : first_of(1, {0.03, 0.0}))
    for (const std::string &conductance : first_of<std::string>(1, {"1e8", "1"})) {
      double power[2];
      for (const bool is_long : {false, true}) {
        Scene run(
            two_squares(offset, "1 3 -1 0",
                        conductance + " region low temperature 0.0 region right temperature 2.0"));
        run_to(run, 200.0, is_long ? 1.0 : 0.1);
        // behind the powers of both regions, whatever the order of the conditions
        power[is_long] = measured("power", run.fix_vector("heat", 12)[CONTACT + 2]);
      }
      EXPECT_NEAR(power[1] / power[0], 1.0, 1e-3) << offset << " " << conductance;
    }
}

// two halves of a square that is turned, with any offset: each is a slab with Bi = 1 at t = 0.125
SERIAL_TEST(Turned, SlabsCool)
{
  for (const int n : first_of(1, {20, 40}))
    for (const double offset : {0.0, 0.3}) {
      Scene run(halves(n, offset, 30));
      run_to(run, 0.125, 0.2 / (n * n));
      EXPECT_NEAR(measured(strprintf("%d %g heat", n, offset), Warm(run, "ma").heat()),
                  0.5 * (0.5 + 0.5 * slab_mean(1.0, 0.5)), 0.0035);
      EXPECT_NEAR(total_heat(run), 0.5, 1e-13);
    }
}

// the whole area of an interface that is inclined, also at its ends: power in the first step
SERIAL_TEST(Turned, HasItsArea)
{
  for (const double offset : {0.0, 0.3, 0.5}) {
    Scene run(halves(20, offset, 15) + "timestep 1e-8\nrun 1\n");
    EXPECT_NEAR(measured(strprintf("offset %g, area", offset), run.fix_vector("heat", 10)[CONTACT]),
                1.0, 0.01);
  }
}

// a sheet between two blocks: said if it is thin
TEST(Thin, IsSaid)
{
  for (const double offset : {0.0, 0.25, 0.6})
    for (const double cells : {1.0, 2.0, 3.0, 4.0}) {
      const Two bodies = {"-12 0 INF INF", strprintf("0 %g INF INF", cells),
                          strprintf("1.0 origin %g 0", offset), "1.0"};
      EXPECT_EQ(said_thin(plane("lj", "f p", "-12 12 0 8", 2, 0.4) + bodies.text(0.5) +
                          "timestep 0.01\nrun 60\nrun 60\n"),
                cells < 2.5)
          << offset << " " << cells;
    }
}

TEST(Ranks, Agree)
{
  OnRanks run(Bars{10, 0.0, "50.0 xlo convection 3.0 2.0", 1.0}.text() +
                  "velocity a set 0.3 0.2 0\ntimestep 0.002\n",
              "run 60\n");
  EXPECT_LT(run.difference(), 1e-12);
  const double one = Warm(run.serial, "mb").heat(), all = Warm(run.parallel, "mb").heat();
  EXPECT_GT(one, 0.05);
  EXPECT_NEAR(all / one, 1.0, 1e-12);
}

SERIAL_TEST(BadInput, IsRefused)
{
  const std::string scene = replaced(Bars{4, 0.0, "1.0"}.text() + "timestep 0.001\n",
                                     "fix heat all mpm/heat contact ga gb conductance 1.0\n", "");
  expect_refused(
      scene,
      {{"fix heat all mpm/heat contact ga", "contact"},
       {"unfix gb\nfix heat all mpm/heat contact ga gb conductance 1.0", "fix mpm"},
       {"fix heat all mpm/heat contact ga gb resistance 1.0", "conductance"},
       {"fix heat all mpm/heat contact ga gb conductance -1.0", "not negative"},
       {"fix heat all mpm/heat contact ga ga conductance 1.0", "two different bodies"},
       {"fix heat all mpm/heat contact ga gb conductance 1.0 contact gb ga conductance 1.0",
        "given twice"},
       {"fix heat all mpm/heat contact ga gx conductance 1.0", "define a fix mpm/contact ga gx"},
       {"fix heat all mpm/heat contact ga gb conductance v_none", "does not exist"},
       {"variable H equal -1.0\nfix heat all mpm/heat contact ga gb conductance v_H",
        "contact ga gb: variable H = -1, but it must not be negative"},
       {"unfix touch\nfix heat all mpm/heat contact ga gb conductance 1.0",
        "define a fix mpm/contact ga gb"},
       {"unfix ma\nfix ma a mpm/material density 1.0 eos linear 1.0\n"
        "fix heat all mpm/heat contact ga gb conductance 1.0",
        "no material of fix mpm ga conducts heat"}},
      "run 1\n");
}
