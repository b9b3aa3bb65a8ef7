// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 300

// Fix mpm/heat: conduction of heat in points, and heat through faces of the box.

#include "elements/thin_testing.h"
#include "heat/heat_testing.h"

using namespace MPM_TEST;

// A bar that nothing heats: T = 1 + cos(pi x) exp(-pi^2 t)
PARAMETER_TEST(Insulated, CosineDecays, const char *,
               Values("relax 1.0", "affine", "relax 1.0 stages 1"))
{
  const std::string transfer = GetParam();
  double rms[3];
  for (int k = 0; k < 3; k++) {
    const int n = 10 << k;
    rms[k] = measured(transfer + strprintf(", %d cells, rms", n),
                      error_of_cosine(bar(n, "transfer " + transfer), 0.3 / (n * n)));
  }
  EXPECT_GT(measured("order", std::log2(rms[1] / rms[2])), 1.9);
  EXPECT_LT(rms[2], transfer == "affine" ? 4.0e-4 : 1.3e-4);
}

// the same along other axes
SERIAL_TEST(Insulated, AlongOtherAxes)
{
  for (const int axis : {1, 2}) {
    const double h = 0.1;
    Scene run((axis == 1 ? plane("lj", "p f", "0 0.4 0 1", 1, 0.01)
                         : space("lj", "p p f", "0 0.4 0 0.4 0 1", 1, 0.01)) +
              "fix grid all mpm 0.1\ncreate_points 1 box ppc 2\n" + conductor() +
              "fix heat all mpm/heat\n");
    Warm warm(run);
    warm.set(cosine(1.0, 1.0, axis));
    run_to(run, 0.1, 0.3 * h * h);
    EXPECT_LT(measured("rms", warm.rms(cosine(DECAYED, 1.0, axis))), 2.0e-3);
  }
}

// what transfers smooth does not grow with the number of steps
SERIAL_TEST(Insulated, ManyShortSteps)
{
  const auto error = [](const char *transfer) {
    return measured(
        transfer,
        error_of_cosine(bar(20, std::string("every 1 transfer ") + transfer), 0.003 / (20 * 20)));
  };
  EXPECT_LT(error("relax 1.0"), 2.0e-3);
  EXPECT_GT(error("affine"), 1.0e-2);
}

// a transfer by which points forget their temperature adds a conductivity at any spacing
SERIAL_TEST(Insulated, PicDoesNotConverge)
{
  const double coarse = error_of_cosine(bar(10, "transfer pic"), 0.3 / (10 * 10)),
               fine = measured("rms", error_of_cosine(bar(20, "transfer pic"), 0.3 / (20 * 20)));
  EXPECT_GT(fine, 0.8 * coarse);
  EXPECT_GT(fine, 0.03);
}

// what m transfers to the nodes and back take away, 1 - (1 - P)^m with P that of pic, in a body
// that hardly conducts, with two capacities, noise, and uneven distances
SERIAL_TEST(Xpic, UndoesSmoothing)
{
  const auto after = [](const std::string &transfer, int steps) {
    Scene run(plane("lj", "f p", "0 6 0 6", 1, 0.1) +
              "region one block 0 3.2 0 6 -0.5 0.5\nregion two block 3.2 5 0 6 -0.5 0.5\n"
              "create_points 1 region one spacing 0.5\ncreate_points 1 region two spacing 0.45\n"
              "group one region one\ngroup two region two\nfix grid all mpm 1.0\n"
              "fix m one mpm/material density 1.0 eos linear 1e-6 thermal conducting 1 0 1e-13\n"
              "fix n two mpm/material density 3.0 eos linear 1e-6 thermal conducting 2 0 1e-13\n"
              "fix heat all mpm/heat transfer " +
              transfer + "\n");
    for (const char *id : {"m", "n"})
      Warm(run, id).set([](const double *x) {
        return 1.0 + std::sin(7.0 * x[0]) * std::cos(5.0 * x[1] + x[0]);
      });
    run.commands(strprintf("timestep 1.0\nrun %d\n", steps));
    std::vector<double> T;
    for (const auto &point : temperatures(run)) T.push_back(point.T);
    return T;
  };
  const auto T0 = after("pic", 0), P1 = after("pic", 1), P2 = after("pic", 2), P3 = after("pic", 3);
  const auto one = after("xpic 1", 1), two = after("xpic 2", 1), three = after("xpic 3", 1);
  double most = 0.0;
  for (std::size_t k = 0; k < T0.size(); k++) {
    EXPECT_NEAR(one[k], P1[k], 1e-12);
    EXPECT_NEAR(two[k], 2.0 * P1[k] - P2[k], 1e-12);
    EXPECT_NEAR(three[k], 3.0 * P1[k] - 3.0 * P2[k] + P3[k], 1e-12);
    most = std::max(most, std::fabs(three[k] - two[k]));
  }
  EXPECT_GT(measured("what the third term changes", most), 0.01);
}

// so that errors, unlike those of pic, go away with the spacing and do not grow with short steps
SERIAL_PARAMETER_TEST(XpicOfOrder, CosineDecays, const char *, Values("3", "5", "20"))
{
  const auto error = [](int n, double step) {
    return measured(
        strprintf("%d cells, steps of %g limits, rms", n, step),
        error_of_cosine(bar(n, std::string("transfer xpic ") + GetParam()), step / (n * n)));
  };
  const double coarse = error(20, 0.3), fine = error(40, 0.3), in_short_steps = error(20, 0.003);
  EXPECT_GT(measured("order", std::log2(coarse / fine)), 1.9);
  EXPECT_LT(in_short_steps, 2.0 * coarse);
}

// One end is heated, the other one held, the faces anywhere in a cell
PARAMETER_TEST(Ends, HaveTheirTemperature, double, Values(0.0, 0.25, 0.5))
{
  double rms[3];
  for (int k = 0; k < 3; k++) {
    const int n = 20 << k;
    rms[k] = measured(strprintf("offset %g, %d cells, rms", GetParam(), n),
                      error_of_wall(bar(n, "xlo temperature 1.0 xhi temperature 0.0", GetParam()),
                                    0.3 / (n * n)));
  }
  EXPECT_GT(measured("order", std::log2(rms[1] / rms[2])), 1.9);
  EXPECT_LT(rms[2], 6.0e-5);
}

// Steps of many explicit limits are made of stages, of second order in time
SERIAL_TEST(Stages, AreOfSecondOrder)
{
  const auto sine = [](double amplitude) {
    return [=](const double *x) {
      return 1.0 + amplitude * std::sin(0.5 * PI * x[0]);
    };
  };
  for (const int steps : {2, 5, 10}) {
    Scene run(bar(40, "xlo temperature 1.0 stages 64"));
    Warm warm(run);
    warm.set(sine(1.0));
    const double before = warm.heat();
    run_to(run, 0.2, 0.2 / steps);
    EXPECT_LT(measured(strprintf("%d steps, rms", steps),
                       warm.rms(sine(std::exp(-0.25 * PI * PI * 0.2)))),
              3e-4);
    EXPECT_NEAR((warm.heat() - before) / heat_in(run), 1.0, 1e-11);
  }
}

TEST(Stages, AreEnough)
{
  Scene run(bar(20, "stages 5"));
  run.commands("fix mpm all mpm/dt 0.9\nrun 1\n");
  const double limit = 0.98 * 2.0 / (6.0 * 400.0);    // explicit
  EXPECT_NEAR(run.lmp->update->dt / (0.9 * limit * 7.0), 1.0, 3e-6);
  run.commands(strprintf("unfix mpm\ntimestep %g\n", 7.2 * limit));
  expect_error(run, "run 1\n", "of fix mpm/heat heat");
}

// A slab that is cooled by convection: T(0), T(1) for Bi = 1 at t = 0.1, 0.5, 1, and Bi = 0.1, 10
struct Slab {
  double Bi, t, centre, face;
};
PARAMETER_TEST(Convection, CoolsASlab, Slab,
               Values(Slab{1.0, 0.1, 0.993108, 0.723577}, Slab{1.0, 0.5, 0.772526, 0.504522},
                      Slab{0.1, 1.0, 0.922389, 0.878126}, Slab{10.0, 0.1, 0.968424, 0.170574}))
{
  const Slab slab = GetParam();
  for (const double offset : first_of(1, {0.25, 0.0, 0.5})) {
    Scene run(bar(40, strprintf("xhi convection %g 0.0", slab.Bi), offset, "", 1.0));
    Warm warm(run);
    const double before = warm.heat(), h = 1.0 / 40;
    run_to(run, slab.t, 0.3 / 1600);
    EXPECT_NEAR(measured("face", warm.at_face(1.0, -1, h)) / slab.face, 1.0, 0.01);
    EXPECT_NEAR(measured("centre", warm.at(0.25 * h, 2 * h, 3 * h)) / slab.centre, 1.0, 0.01);
    EXPECT_NEAR((warm.heat() - before) / heat_in(run), 1.0, 1e-11);
  }
}

// the area that touches a face counts, wherever its sides are in cells, and nothing behind a gap
SERIAL_TEST(Flux, ComesThroughWhatTouches)
{
  for (const double shift : {0.0, 0.13, 0.25, 0.41, 0.5})
    for (const double gap : {0.0, 0.6, 1.5}) {
      Scene run(plane("lj", "f f", "0 12 0 12", 1, 0.1) +
                strprintf("region body block %g %g %g %g -0.5 0.5\n", gap, gap + 6.0, 2.0 + shift,
                          7.0 + shift) +
                "create_points 1 region body spacing 0.5\nfix grid all mpm 1.0\n" + conductor() +
                "fix heat all mpm/heat xlo flux 2.0 yhi temperature 5.0\ntimestep 0.1\nrun 1\n");
      // points fill whole cells of their own lattice
      double least = 100.0, most = 0.0, nearest = 100.0;
      for (int i = 0; i < run.n(); i++) {
        least = std::min(least, run.x()[i][1] - 0.25);
        most = std::max(most, run.x()[i][1] + 0.25);
        nearest = std::min(nearest, run.x()[i][0] - 0.25);
      }
      const double *const power = run.fix_vector("heat", 7);
      if (nearest < 0.01)
        EXPECT_NEAR(measured("power", power[0]) / (2.0 * (most - least)), 1.0, 0.03) << shift;
      else if (nearest > 0.49)
        EXPECT_EQ(power[0], 0.0) << nearest;
      EXPECT_EQ(power[3], 0.0);
    }
}

// NAFEMS T2: 1000 K at one end, emissivity 0.98 to 300 K at the other one, k = 55.6, length 0.1
SERIAL_TEST(Radiation, SteadyState)
{
  const double h = 0.005;
  Scene run(plane("si", "f p", strprintf("0 0.1 0 %g", 4 * h), 1, 0.1 * h) +
            body("box", "density 7850 eos linear 1e-3 thermal conducting 460 1000 55.6",
                 strprintf("%g", h)) +
            "fix heat all mpm/heat xlo temperature 1000 xhi radiation 0.98 300 stages 64\n");
  Warm warm(run);
  warm.set([](const double *x) {
    return 1000.0 - 730.0 * x[0];
  });
  run.commands("timestep 2.0\nrun 1200\n");
  EXPECT_NEAR(measured("face", warm.at_face(0.1, -1, h)), 927.0040, 3e-4);
  const double *power = run.fix_vector("heat", 7);
  EXPECT_NEAR(power[0] / power[1], -1.0, 2e-7);
}

// the same constant in all units with kelvins: a plate of 1000 K radiates 5.67e4 W/m^2
SERIAL_PARAMETER_TEST(Radiation, InUnits, const char *,
                      Values("si", "cgs", "micro", "nano", "metal", "real", "electron"))
{
  // energy/(time length^2) in SI units
  const std::map<std::string, double> flux = {
      {"si", 1.0},
      {"cgs", 1e-3},
      {"micro", 1e-15 / 1e-6 / 1e-12},
      {"nano", 1e-21 / 1e-9 / 1e-18},
      {"metal", 1.602176634e-19 / 1e-12 / 1e-20},
      {"real", 6.9476954571e-21 / 1e-15 / 1e-20},
      {"electron", 4.3597447222e-18 / 1e-15 / 2.80028520539e-21}};
  Scene run(plane(GetParam(), "f p", "0 8 0 4", 1, 0.1) +
            body("box", "density 1.0 eos linear 1e-6 thermal conducting 1e6 1000 1.0", "1.0") +
            "fix heat all mpm/heat xhi radiation 1.0 0.0\ntimestep 1e-6\nrun 1\n");
  EXPECT_NEAR(run.fix_vector("heat", 7)[1] * flux.at(GetParam()) / 4.0 / -5.670374419e4, 1.0, 1e-9);
}

// NAFEMS T3: T = 100 sin(pi t/40) at one end, 0 at the other: 36.603 at 0.02 after 32 s
SERIAL_TEST(Ends, FollowAVariable)
{
  const double h = 0.1 / 40;
  Scene run(
      plane("si", "f p", strprintf("0 0.1 0 %g", 4 * h), 1, 0.1 * h) +
      body("box", "density 7200 eos linear 1.0 thermal conducting 440.5 0 35", strprintf("%g", h)) +
      "variable T equal 100*sin(PI*time/40)\n"
      "fix heat all mpm/heat xlo temperature 0 xhi temperature v_T\n");
  Warm warm(run);
  run.commands("timestep 0.04\nrun 800\n");
  EXPECT_NEAR(measured("T", warm.at(0.08, 2 * h, 0.9 * h)), 36.603, 0.1);
}

// NAFEMS T4 on a coarse lattice: heat through three faces (the README has finer ones)
SERIAL_TEST(Plate, IsCooled)
{
  const double h = 0.05;
  Scene run(plane("si", "f f", "0 0.6 0 1", 1, 0.1 * h) +
            body("box", "density 7850 eos linear 1e-5 thermal conducting 460 0 52", "0.05") +
            "fix heat all mpm/heat ylo temperature 100 xhi convection 750 0 yhi convection 750 0\n"
            "timestep 400\nrun 200\n");
  EXPECT_NEAR(measured("T", Warm(run).at_face(0.6, -1, h, 0.2, 0.26 * h)), 18.254, 1.0);
  const double *const power = run.fix_vector("heat", 7);
  EXPECT_NEAR((power[1] + power[2] + power[3]) / power[2], 0.0, 6e-7);
}

// sources: a body is heated evenly, or where a variable says so
TEST(Source, HeatsPoints)
{
  for (const char *source : {"equal 2.0", "atom 2.0*(x<0.5)"}) {
    Scene run(bar(10, "source v_s"));
    Warm warm(run);
    const double before = warm.heat();
    run.commands(std::string("variable s ") + source + "\n");
    run_to(run, 0.2, 0.001);
    const double all = source[0] == 'e' ? 0.4 * 0.4 : 0.2 * 0.4;    // power * time * volume
    EXPECT_NEAR((warm.heat() - before) / all, 1.0, 1e-12);
    EXPECT_NEAR(heat_in(run) / all, 1.0, 1e-12);
    EXPECT_NEAR(run.fix_vector("heat", 7)[6] / (all / 0.2), 1.0, 1e-12);
    if (source[0] == 'e')
      for (int i = 0; i < run.n(); i++) EXPECT_NEAR(warm.T(i), 0.4, 1e-12);
  }
}

// volumes of points are those of this step, also in a new order: a source in one of two bodies
TEST(Source, IsOfPresentVolumes)
{
  Scene run("variable s atom 2.0*gmask(one)\n" + disk("source v_s") +
            "compute volumes one mpm/atom volume\ncompute volume one reduce sum c_volumes\n"
            "fix steps all vector 1 f_heat[7] c_volume\nrun 90\n");
  auto *const steps = run.fix("steps");
  double most = 0.0, least = 1.0e9;
  for (int k = 1; k <= 90; k++) {
    const double before = steps->compute_array(k - 1, 1);
    EXPECT_NEAR(steps->compute_array(k, 0) / (2.0 * before), 1.0, 1e-12);
    most = std::max(most, before);
    least = std::min(least, before);
  }
  EXPECT_GT(measured("change of volume", most / least), 1.02);
}

/** A block of 1 x 1 or 1 x 1 x 1 with 10 cells along its sides, at 1, whose material touches all
 *  faces of the box. K: with 1e-3 the rates of its conduction are some 0.1 to 1. */
static std::string block(int dim, double offset, const std::string &heat, const std::string &K)
{
  const std::string at = strprintf(" %g", offset);
  return (dim == 2 ? plane("lj", "f f", "0 1 0 1", 1, 0.02)
                   : space("lj", "f f f", "0 1 0 1 0 1", 1, 0.02)) +
      "create_points 1 box spacing 0.05\nfix grid all mpm 0.1 dtcheck no origin" + at + at +
      (dim == 3 ? at : "") + "\n" + conductor(K, 1.0) + "fix heat all mpm/heat " + heat + "\n";
}

/** Powers through the faces of such a square with the conductivity 1e-2, after the time end. Faces
 *  xhi and yhi are near an insulator. */
static std::array<double, 4> powers_of_square(double offset, const std::string &heat, double end,
                                              double dt)
{
  Scene run(
      block(2, offset, heat + " xhi convection 0.01 0.5 yhi convection 0.01 0.5 stages 9", "1e-2"));
  run_to(run, end, dt);
  const double *const flows = run.fix_vector("heat", 4);
  return {flows[0], flows[1], flows[2], flows[3]};
}

/** The longest step that a single stage may have. */
static double one_stage(const std::string &scene)
{
  double low = 0.1, high = 10.0;
  while (high / low > 1.005) {
    const double middle = std::sqrt(low * high);
    (error_of(scene + strprintf("timestep %.17g\nrun 1\n", middle)).empty() ? low : high) = middle;
  }
  return low;
}

// convection on faces that meet: steps just below the limit keep temperatures within bounds
SERIAL_TEST(Corner, IsStable)
{
  for (const int dim : {2, 3})
    for (const double offset : first_of(1, {0.025, 0.0, 0.05}))
      for (const double H : {0.03, 0.1, 1e3}) {
        const std::string on = strprintf(" convection %g 0.0 ", H);
        const std::string scene = block(
            dim, offset, "stages 1 xlo" + on + "ylo" + on + (dim == 3 ? "zlo" + on : ""), "1e-3");
        Scene run(scene +
                  strprintf("timestep %.17g\n", 0.99 * measured("limit", one_stage(scene))));
        for (int k = 0; k < 4; k++) {
          run.commands("run 40\n");
          const auto [least, most] = Warm(run).range();
          EXPECT_GT(least, 0.0) << dim << " " << offset << " " << H;
          EXPECT_LT(most, 1.0 + 1e-12) << dim << " " << offset << " " << H;
        }
      }
}

// a square in a room, with a source: in the steady state each face has a quarter of the heat,
// whatever the time step is, although rates at the faces are limited in longer steps
PARAMETER_TEST(Corner, HasItsSteadyState, double, Values(0.25, 1.0, 2.0))
{
  for (const double H : {1.0, 1e4}) {
    const std::string on = strprintf(" convection %g 0.0 ", H);
    Scene run(block(2, 0.0,
                    "xlo" + on + "xhi" + on + "ylo" + on + "yhi" + on + "source v_q stages 9",
                    "1e-2") +
              "variable q equal 0.05\n");
    run_to(run, 400.0, GetParam());
    const double *const flows = run.fix_vector("heat", 4);
    for (int face = 0; face < 4; face++) EXPECT_NEAR(flows[face] / -0.0125, 1.0, 1e-12) << H;
    EXPECT_NEAR(measured("of x, and of y", flows[0] / flows[2]), 1.0, 1e-10);
  }
}

// faces next to each other at different temperatures: what comes in at one goes out at the other
SERIAL_TEST(Corner, OfTwoTemperatures)
{
  for (const char *x : {"convection 1e3 0.0", "temperature 0.0"}) {
    double flow[2];
    for (const bool is_long : {false, true}) {
      const auto flows = powers_of_square(0.0, std::string("xlo ") + x + " ylo convection 1 1.0",
                                          600.0, is_long ? 2.0 : 0.25);
      EXPECT_NEAR(flows[0] + flows[1] + flows[2] + flows[3], 0.0, 1e-12);
      flow[is_long] = measured("flow", flows[2]);
    }
    EXPECT_NEAR(flow[0] / flow[1], 1.0, 0.03);
  }
}

// lines of faces that cross change one another's temperature: with different coefficients and
// temperatures, which nothing makes symmetric, long steps, in which their rates are limited, have
// the powers of short ones, in which they are not. Points do not relax, which depends on the step
SERIAL_TEST(Corner, IsCoupledInLongSteps)
{
  for (const double offset : {0.0, 0.03}) {
    const auto powers = [=](double dt) {
      return powers_of_square(
          offset, "transfer relax 0 xlo convection 0.3 0.0 ylo convection 1.0 1.0", 300.0, dt);
    };
    const auto in_long = powers(2.0), in_short = powers(0.05);
    for (const int face : {0, 2})
      EXPECT_NEAR(measured(strprintf("offset %g", offset), in_long[face] / in_short[face]), 1.0,
                  0.003);
  }
}

// perfect convection on both does not let through at the edge what conduction does not
SERIAL_TEST(Corner, HasAFiniteFlow)
{
  const auto flow = [](const std::string &H) {
    return measured(H,
                    powers_of_square(0.0,
                                     "xlo convection " + H + " 0.0 ylo convection " + H + " 1.0",
                                     600.0, 2.0)[2]);
  };
  EXPECT_NEAR(flow("1e8") / flow("1e3"), 1.0, 4e-5);
}

// both sides of a thin plate have nodes in common, and yet their whole coefficients
SERIAL_TEST(ThinPlate, LetsHeatThrough)
{
  for (const double cells : {1.0, 1.5, 2.0, 3.0})
    for (const double offset : {0.0, 0.5})
      for (const double H : {1.0, 1e4}) {
        Scene run(
            plane("lj", "f p", strprintf("0 %g 0 4", cells), 1, 0.1) +
            strprintf("fix grid all mpm 1.0 dtcheck no origin %g 0\n", offset) +
            "create_points 1 box spacing 0.5\n" + conductor("1.0", 0.5) +
            strprintf(
                "fix heat all mpm/heat xlo convection %g 1.0 xhi convection %g 0.0 stages 9\n", H,
                H));
        run_to(run, 60.0, 1.0);
        const double *const power = run.fix_vector("heat", 2);
        // points out of the middle of halves of cells are no integral: they fill lines by 0.99
        const double error = cells == 1.0 && offset > 0.0 ? 0.02 : 1e-8;
        for (int side = 0; side < 2; side++)
          EXPECT_NEAR(measured(strprintf("%g cells, offset %g, H %g", cells, offset, H),
                               (side ? -0.25 : 0.25) * power[side] * (2.0 / H + cells)),
                      1.0, error);
      }
}

// what is held there follows that outside in no time, and heat is what comes through the faces
SERIAL_TEST(Corner, OfPerfectConvection)
{
  const auto heat = [](const std::string &condition) {
    Scene run(block(2, 0.03, "xlo " + condition + " 0.0 ylo " + condition + " 0.0", "1e-3"));
    const double before = Warm(run).heat();
    run_to(run, 40.0, 0.5);
    const double after = measured("heat", Warm(run).heat());
    EXPECT_NEAR((after - before) / heat_in(run), 1.0, 1e-11);
    return after;
  };
  EXPECT_NEAR(heat("convection 1e6") / heat("temperature"), 1.0, 0.01);
}

// fix mpm/dt knows how fast heat comes through faces before the first step, also with all stages
SERIAL_TEST(Corner, HasATimeStep)
{
  for (const char *kind : {"convection 1000.0 0.0", "convection v_H 0.0"}) {
    const std::string on = std::string(" ") + kind + " ";
    Scene run(replaced(block(2, 0.0, "stages 5 xlo" + on + "yhi" + on, "1e-3"), "dtcheck no", "") +
              "variable H equal 1000\nfix dt all mpm/dt 0.95\ntimestep 1e-3\n");
    run.commands("run 20\nrun 20\n");
    EXPECT_GT(measured("dt", run.lmp->update->dt), 1.0);
  }
}

// Stefan: ice at its melting point, St = 1: the front is at 2 * 0.62006263 sqrt(t)
SERIAL_PARAMETER_TEST(Melting, FrontMoves, const char *, Values("scheme usl", "scheme usf"))
{
  const int n = 100;
  Scene run(replaced(bar(n, "xlo temperature 1.0", 0.0, GetParam()), "1.0 0 1.0",
                     "1.0 0 1.0 melt 0.0 1.0"));
  Warm warm(run);
  run_to(run, 0.1, 0.3 / (n * n));
  const int molten = warm.material->find_history("molten");
  for (int i = 0; i < run.n(); i++) {
    const double f = warm.material->history[i][molten];
    if (f > 0.0 && f < 1.0) EXPECT_NEAR(warm.T(i), 0.0, 1e-12);
  }
  const auto [liquid, enthalpy] = warm.melt();
  EXPECT_NEAR(measured("front", liquid), 0.392162, 0.002);
  EXPECT_NEAR(enthalpy / heat_in(run), 1.0, 1e-11);
}

// heat is kept to round-off while bodies collide
PARAMETER_TEST(Closed, KeepsHeat, const char *, Values("", "transfer xpic 4"))
{
  Scene run(disk(GetParam()));
  expect_disk_keeps_heat(run, "run 100\n");
  const auto T = temperatures(run);
  const auto hottest = std::max_element(T.begin(), T.end(), [](const Named &a, const Named &b) {
    return a.T < b.T;
  });
  EXPECT_LT(measured("hottest", hottest->T), 2.0 + run.compute_vector()[4]);
}

TEST(Ranks, Agree)
{
  const std::string walls =
      replaced(disk("xlo temperature 3.0 xhi convection 0.5 0.0 ylo flux 0.3"), "boundary p p p",
               "boundary f f p") +
      "fix b all mpm/boundary xlo xhi ylo yhi slip\n";
  for (const auto &scene : {disk(""), disk("transfer xpic 4"), walls}) {
    OnRanks run(scene, "run 90\n");
    EXPECT_LT(run.difference(), 1e-12);
    EXPECT_LT(measured("difference", temperature_difference(run.serial, run.parallel)), 1e-12);
    EXPECT_NEAR(heat_in(run.serial), heat_in(run.parallel), 1e-11);
  }
}

PARAMETER_TEST(Restart, Continues, const char *, Values("affine", "xpic 4"))
{
  expect_disk_continues("variable s atom 0.1*x\n" +
                        disk(std::string("transfer ") + GetParam() + " source v_s"));
}

// a body that moves across the lattice has the temperatures of one at rest
SERIAL_TEST(Moving, HasTheSameTemperatures)
{
  double rms[2];
  for (const bool moves : {false, true}) {
    Scene run(plane("lj", "p p", "0 16 0 1", 1, 0.02) +
              body("block 3 5 0 1 -0.5 0.5",
                   "density 1.0 eos linear 1e-3 thermal conducting 1.0 0.0 0.05", "0.1") +
              "fix heat all mpm/heat every 1\n");
    Warm warm(run);
    const double v = moves ? 7.3 : 0.0;
    const auto wave = [](double amplitude, double start) {
      return [=](const double *x) {
        return 1.0 + amplitude * std::cos(PI * (x[0] - start));
      };
    };
    warm.set(wave(1.0, 3.0));
    run.commands(strprintf("velocity all set %g 0 0\ntimestep 0.002\nrun 500\n", v));
    rms[moves] = measured(moves ? "moving, rms" : "at rest, rms",
                          warm.rms(wave(std::exp(-0.05 * PI * PI), 3.0 + v)));
  }
  EXPECT_LT(rms[0], 6e-3);
  EXPECT_NEAR(rms[1], rms[0], 1e-3);
}

// without any heat to conduct, mechanics are the same to the last bit
TEST(Idle, ChangesNothing)
{
  const std::string heated = disk("");
  std::string plain = replaced(heated, "fix heat all mpm/heat \n", "");
  plain = replaced(replaced(plain, "conducting 1.5 1.0 0.4", "adiabatic 1.5 1.0"),
                   "conducting 0.7 2.0 0.1", "adiabatic 0.7 2.0");
  Scene with(heated + "run 60\n"), without(plain + "run 60\n");
  EXPECT_TRUE(identical(with.gather(), without.gather()));
}

SERIAL_TEST(Radiation, OfDegreesCelsius)
{
  const auto input = [](const char *where, double start) {
    return replaced(bar(4, std::string(where) + " radiation 1.0 20", 0.0, "", start), "lj", "si") +
        "run 1\n";
  };
  for (const char *where : {"xlo", "surface"}) {
    expect_error(input(where, -20.0), "has the temperature -20: give all temperatures in kelvins");
    for (const double start : {20.0, 293.0})
      EXPECT_EQ(times_said(input(where, start), "is this one in degrees Celsius?"), start < 100.0);
  }
}

SERIAL_TEST(BadInput, IsRefused)
{
  const std::string plain = plane("lj", "f p", "0 4 0 4", 1, 0.1) +
      "fix grid all mpm 1.0\ncreate_points 1 box ppc 2\n"
      "fix m all mpm/material density 1.0 eos linear 1.0 thermal conducting 1 0 1\n"
      "timestep 0.01\n";
  expect_refused(plain,
                 {{"fix heat all mpm/heat xlo", "xlo"},
                  {"fix heat all mpm/heat xlo cold", "must be one of insulated temperature flux"},
                  {"fix heat all mpm/heat zlo flux 1.0", "zlo does not exist in 2d"},
                  {"fix heat all mpm/heat xlo convection 10 300 xlo radiation 0.8 300", "twice"},
                  {"fix heat all mpm/heat source v_p source v_p", "twice"},
                  {"fix heat all mpm/heat ylo flux 1.0", "periodic axis: use boundary f"},
                  {"fix heat all mpm/heat xlo convection -1.0 0.0", "not negative"},
                  {"fix heat all mpm/heat xlo radiation 1.5 0.0", "not above 1"},
                  {"fix heat all mpm/heat xlo radiation 0.5 -1.0", "absolute temperature"},
                  {"fix heat all mpm/heat xlo radiation 0.5 1.0", "use units si"},
                  {"fix heat all mpm/heat xlo temperature v_none", "does not exist"},
                  {"fix heat all mpm/heat source 1.0", "must be a variable"},
                  {"fix heat all mpm/heat source v_none", "does not exist"},
                  {"variable H equal -1.0\nfix heat all mpm/heat xlo convection v_H 0.0",
                   "xlo: variable H = -1, but it must not be negative"},
                  {"fix heat all mpm/heat stages 0", "stages"},
                  {"fix heat all mpm/heat transfer flip", "must be one of relax pic affine xpic"},
                  {"fix heat all mpm/heat transfer xpic 0", "order"},
                  {"fix heat all mpm/heat transfer xpic", "missing argument"},
                  {"group a type 1\nfix heat a mpm/heat", "use group all"},
                  {"fix heat all mpm/heat\nfix more all mpm/heat", "more than one"}},
                 "run 1\n");
  for (const char *cold : {"temperature -20", "convection 5 -20"})
    expect_error(replaced(replaced(plain, "units lj", "units si"), "1 0 1", "1 300 1") +
                     "fix heat all mpm/heat xhi radiation 0.9 300 xlo " + cold + "\nrun 1\n",
                 "xlo: the value = -20, but it must be an absolute temperature");
  expect_error(replaced(plain, "conducting 1 0 1", "adiabatic 1 0") +
                   "fix heat all mpm/heat\nrun 1\n",
               "thermal conducting");
  expect_error(replaced(plain, "conducting 1 0 1", "conducting 1 0") + "run 1\n", "K");
}

// a surface that is suddenly warm, in a few steps of very many explicit limits
SERIAL_PARAMETER_TEST(SuddenHeat, InLongSteps, int, Values(1, 2, 4))
{
  const double error = error_of_wall(
      bar(40, "xlo temperature 1.0 xhi temperature 0.0 every 1 stages 200"), 0.1 / GetParam());
  EXPECT_LT(measured(strprintf("%d steps", GetParam()), error), 0.01);
}

// nodes of finite elements have no temperature that heat could change
SERIAL_TEST(Elements, TakeNoPart)
{
  const ScratchFile mesh("lines.msh", line(8, {2, 5, 0}, {6, 5, 0}).text());
  const auto scene = [&](const std::string &of_nodes) {
    return plane("lj", "f f", "0 8 0 8", 3, 0.1) + "fix grid all mpm 1\ncreate_points 1 mesh " +
        mesh.name +
        " thickness 0.1\nregion low block 1 7 1 3 INF INF\nregion high block 1 7 3 4 INF INF\n"
        "create_points 2 region low ppc 2\ncreate_points 3 region high ppc 2\n"
        "group g1 type 1\ngroup g2 type 2\ngroup g3 type 3\n"
        "fix m1 g1 mpm/material density 1 linear 10 0.3 " +
        of_nodes +
        "\nfix m g2 mpm/material density 1 eos linear 1e-6 thermal conducting 1 0 1\n"
        "fix m3 g3 mpm/material density 1 eos linear 1e-6\nfix e g1 mpm/elements " +
        mesh.name + " thickness 0.1\nfix heat all mpm/heat\ntimestep 0.01\n";
  };
  expect_error(scene("thermal conducting 1 0 1") + "run 1\n", "nodes of fix mpm/elements");
  Scene run(scene(""));
  Warm warm(run);
  warm.set(cosine());
  const double before = warm.heat();
  run.commands("run 20\n");
  EXPECT_NEAR(warm.heat() / before, 1.0, 1e-12);
  EXPECT_LT(warm.range()[1], 1.9);
}
