// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// timeout: 900

// Conservation laws and symmetries: rigid motion, momentum, angular momentum, energy.

#include "mpm_lammps.h"

#include <tuple>

using namespace MPM_TEST;

static const char *const SHAPES[] = {"linear", "quadratic", "cubic"};
static const char *const TRANSFERS[] = {"pic", "flip 1.0", "flip 0.99", "apic"};
static const char *const SCHEMES[] = {"usl", "usf", "musl"};

static std::vector<std::string> all_options()
{
  std::vector<std::string> list;
  for (auto *shape : SHAPES)
    for (auto *transfer : TRANSFERS)
      for (auto *scheme : SCHEMES)
        list.push_back(strprintf("shape %s transfer %s scheme %s", shape, transfer, scheme));
  return list;
}

/** Linear functions let nodes have nearly no mass and the full force, so that velocities of nodes,
 *  and with them velocity gradients (USL) and affine matrices (APIC), can be anything: round-off
 *  grows without bound. A ball of E = 1000 in free flight, 3d, time step 0.26 h/c, falls to pieces
 *  within 500 steps. Linear functions are sound with FLIP or PIC and USF or MUSL. */
static bool is_sound(const std::string &options)
{
  if (options.find("linear") == std::string::npos) return true;
  const bool usl =
      options.find("usf") == std::string::npos && options.find("musl") == std::string::npos;
  return options.find("apic") == std::string::npos && !usl;
}

static double largest_stress(Scene &run)
{
  double s = 0.0;
  for (int i = 0; i < run.n(); i++)
    for (int c = 0; c < 6; c++) grow(s, run.points().tau[i][c]);
  return s;
}

// C4: rigid translation and free fall, exact for every shape function, transfer and scheme
class RigidMotion : public ::testing::TestWithParam<int> {
 protected:
  static void fly(int dim, const std::string &options, double g)
  {
    SCOPED_TRACE(options);
    const double E = is_sound(options) ? 1000.0 : 1.0e-12;    // the latter: kinematics alone
    const double t = 1.0, dt = 0.01, deep = dim - 2, v[3] = {1.7, -0.9, 1.1 * deep};
    Scene run(box(dim, "si", "f f f", "0 10 0 10 0 10", 1, 0.3) +
              body(strprintf("sphere 4.3 5.2 %g 1.9", 5.0 * deep),
                   strprintf("density 2.0 linear %.17g 0.3", E), "1.0 " + options) +
              strprintf("displace_atoms all move 0.137 0.211 %g\nvelocity all set 1.7 -0.9 %g\n"
                        "fix g all gravity %.17g vector 0 -1 0\ntimestep 0.01\n",
                        0.173 * deep, v[2], g));
    run.set_reference();
    run.commands("run 100\n");
    double error = 0.0, error_v = 0.0;
    ASSERT_GT(run.n(), dim == 2 ? 40 : 200);
    for (int i = 0; i < run.n(); i++)
      for (int d = 0; d < 3; d++) {
        const double fall = d == 1 ? g : 0.0;
        const double exact = run.reference(i)[d] + v[d] * t - 0.5 * fall * t * (t + dt);
        grow(error, run.x()[i][d] - exact);
        grow(error_v, run.v()[i][d] - (v[d] - fall * t));
      }
    EXPECT_LT(error, 1.0e-12);
    EXPECT_LT(error_v, 1.0e-12);
    EXPECT_LT(largest_stress(run), 1.0e-12 * E);
  }
};

TEST_P(RigidMotion, UniformVelocity)
{
  for (const auto &options : all_options()) fly(GetParam(), options, 0.0);
}

TEST_P(RigidMotion, FreeFall)
{
  for (const auto &options : all_options()) fly(GetParam(), options, 1.3);
}

INSTANTIATE_TEST_SUITE_P(Dimension, RigidMotion, ::testing::Values(2, 3));

// a force on group all acts once on each body, in a field of its own or not (pitfall 4)
TEST(TwoBodies, FallWithG)
{
  for (const bool two_fields : {false, true}) {
    Scene run(space("si", "f f f", "0 16 0 8 0 8", 2, 0.3) + "fix grid all mpm 1.0\n" +
              bodies({{"one", "sphere 4 4 5 1.6"}, {"two", "block 9 12 3 5 4 6"}}));
    if (two_fields)
      run.commands("unfix grid\nfix grid one mpm 1.0\nfix second two mpm 1.0 transfer flip 1.0\n");
    run.commands("fix m1 one mpm/material density 1.0 linear 100 0.3\n"
                 "fix m2 two mpm/material density 7.0 neohookean 500 0.2\n"
                 "fix g all gravity 2.5 vector 0 0 -1\ntimestep 0.005\nrun 200\n");
    for (const int type : {1, 2}) {
      const auto s = run.sums(type);
      EXPECT_NEAR(s.p[2] / s.mass, -2.5, 1.0e-12);
      EXPECT_NEAR(s.p[0] / s.mass, 0.0, 1.0e-12);
    }
  }
}

// patch test: points with an affine velocity field keep it, APIC to round-off, and deform with it.
// (Over many steps an affine matrix that belongs to old positions makes an error of order dt.)
PARAMETER_TEST(Patch, AffineVelocity, const char *,
               Values("shape linear transfer apic", "shape quadratic", "shape cubic",
                      "shape quadratic scheme musl", "shape quadratic scheme usf",
                      "shape cubic scheme musl"))
{
  // nearly no stress, so that the motion is free flight
  Scene run(space("si", "f f f", "-8 8 -8 8 -8 8", 1, 0.3) +
            strprintf("fix grid all mpm 1.0 %s\nregion body sphere 0.2 0.1 -0.1 2.4\n"
                      "create_points 1 region body ppc 2\n"
                      "displace_atoms all random 0.2 0.2 0.2 8241\n"
                      "fix soft all mpm/material density 1.0 neohookean 1e-20 0.3\ntimestep 0.1\n",
                      GetParam()));
  run.set_reference();
  const double A[3][3] = {{0.8, 0.3, 0.0}, {-0.2, -0.4, 0.1}, {0.0, 0.25, 0.15}};
  for (int i = 0; i < run.n(); i++)
    for (int d = 0; d < 3; d++) {
      run.v()[i][d] = 0.3;
      for (int e = 0; e < 3; e++) run.v()[i][d] += A[d][e] * run.x()[i][e];
    }
  run.commands("run 1\n");
  const bool usf = std::string(GetParam()).find("usf") != std::string::npos;
  double error = 0.0, error_v = 0.0, error_F = 0.0;
  for (int i = 0; i < run.n(); i++)
    for (int d = 0; d < 3; d++) {
      double v = 0.3;
      for (int e = 0; e < 3; e++) {
        v += A[d][e] * run.reference(i)[e];
        // F = I + dt A; USF looks back instead of ahead, (I - dt A) F = I
        const double *F = run.points().F[i];
        double expected = (d == e) + 0.1 * A[d][e];
        if (usf) {
          expected = d == e;
          for (int k = 0; k < 3; k++) expected += 0.1 * A[d][k] * F[3 * k + e];
        }
        grow(error_F, F[3 * d + e] - expected);
        grow(error_v, run.affine()[i][3 * e + d] - A[d][e]);
      }
      grow(error_v, run.v()[i][d] - v);
      grow(error, run.x()[i][d] - run.reference(i)[d] - 0.1 * v);
    }
  const std::string name = strprintf("patch %s: ", GetParam());
  EXPECT_LT(measured(name + "position", error), 1.0e-13);
  EXPECT_LT(measured(name + "velocity and affine matrix", error_v), 1.0e-12);
  EXPECT_LT(measured(name + "deformation gradient", error_F), 1.0e-13);
}

// APIC begins with affine matrices that are fit to the velocities of the points
class AffineFit : public ::testing::TestWithParam<std::tuple<int, const char *>> {
 protected:
  static double error(Scene &run, const double A[3][3])
  {
    const int dim = run.dim();
    double worst = 0.0;
    for (int i = 0; i < run.n(); i++)
      for (int d = 0; d < dim; d++)
        for (int e = 0; e < dim; e++) grow(worst, run.affine()[i][dim * e + d] - A[d][e]);
    return worst;
  }
};

TEST_P(AffineFit, LinearFieldsAreExact)
{
  const int dim = std::get<0>(GetParam());
  Scene run;
  // a body with corners, an edge that is one layer thick, over a periodic face
  run.commands(box(dim, "si", "f p f", "-8 8 -8 8 -8 8", 1, 0.3) +
               strprintf("fix grid all mpm 1.0 shape %s\nregion a block -2 3 -2 1 -2 2\n"
                         "region b block 3 5 -2 -1.5 -2 2\nregion body union 2 a b\n"
                         "create_points 1 region body ppc 2\n"
                         "displace_atoms all random 0.15 0.15 %s 8241\n"
                         "fix m all mpm/material density 1.0 neohookean 10 0.3\ntimestep 0.001\n",
                         std::get<1>(GetParam()), dim == 2 ? "0" : "0.15"));
  const double A[3][3] = {{0.8, 0.3, 0.0}, {-0.2, -0.4, 0.1}, {0.0, 0.25, 0.15}};
  auto linear = [&](double scale) {
    run.set_velocity([&](const double *x, double *v) {
      for (int d = 0; d < dim; d++) {
        v[d] = 0.3;
        for (int e = 0; e < dim; e++) v[d] += scale * A[d][e] * x[e];
      }
    });
  };
  linear(1.0);
  run.commands("run 0\n");
  EXPECT_LT(measured("affine fit, error", error(run, A)), 1.0e-11);

  // across the periodic face, for which x varies linearly only when it is constant along y
  run.set_velocity([&](const double *x, double *v) {
    v[1] = A[1][0] * x[0];
  });
  run.set_velocity([&](const double *, double *v) {
    v[0] = v[2] = 0.0;
  });
  const double B[3][3] = {{0.0, 0.0, 0.0}, {A[1][0], 0.0, 0.0}, {0.0, 0.0, 0.0}};
  run.commands("displace_atoms all move 0 8.5 0\nrun 0\n");    // with new velocities: fit again
  EXPECT_LT(error(run, B), 1.0e-11);

  // a step changes them, and a run that goes on does not touch them; a velocity command does
  run.commands("run 20\n");
  const double before = error(run, B);
  EXPECT_GT(before, 1.0e-8);
  run.commands("run 0\n");
  EXPECT_EQ(error(run, B), before);
  run.commands("velocity all set 0.1 0.2 0.0\nrun 0\n");
  const double zero[3][3] = {{0.0}};
  EXPECT_LT(error(run, zero), 1.0e-12);
}

INSTANTIATE_TEST_SUITE_P(Shapes, AffineFit,
                         ::testing::Combine(::testing::Values(2, 3),
                                            ::testing::Values("linear", "quadratic", "cubic")));

// the first field is at rest and needs no fit, the second one turns
TEST(AffineFit, SecondField)
{
  Scene run(
      plane("si", "f f", "0 30 0 12", 2, 0.3) +
      bodies({{"a", "block 3 8 3 8 INF INF"}, {"b", "block 18 23 3 8 INF INF"}}, "spacing 0.5") +
      "fix first a mpm 1.0\nfix grid b mpm 1.0\n"
      "fix m all mpm/material density 1 neohookean 100 0.3\n"
      "velocity b ramp vx -1 1 y 3 8\nrun 0\n");
  for (int i = 0; i < run.n(); i++)
    if (run.is_point(i)) { EXPECT_NEAR(run.affine()[i][2], 0.4, 1.0e-12); }
}

// a plate that is one layer thick has no slope across; a point on its own has none at all
TEST(AffineFit, ThinBodies)
{
  Scene run(space("si", "f f f", "-8 8 -8 8 -8 8", 2, 0.3) + "fix grid all mpm 1.0\n" +
            bodies({{"plate", "block -3 3 -3 3 0 0.5"}, {"one", "block 6 6.5 6 6.5 6 6.5"}}) +
            "fix m all mpm/material density 1.0 neohookean 10 0.3\ntimestep 0.001\n");
  run.set_velocity([&](const double *x, double *v) {
    v[0] = 0.3 - 0.2 * x[1];
    v[1] = 0.2 * x[0];
    v[2] = 0.1 * x[0];
  });
  run.commands("run 0\n");
  const double A[9] = {0.0, 0.2, 0.1, -0.2, 0.0, 0.0, 0.0, 0.0, 0.0};    // columns
  for (int i = 0; i < run.n(); i++)
    for (int c = 0; c < 9; c++)
      EXPECT_NEAR(run.affine()[i][c], run.lmp->atom->type[i] == 1 ? A[c] : 0.0, 1.0e-12);
}

// the inside of a uniformly stretching block is free of force, but for spacings that change
PARAMETER_TEST(StressedPatch, InteriorStaysUniform, const char *,
               Values("shape linear transfer apic", "shape linear transfer flip 1.0 scheme musl",
                      "shape quadratic", "shape cubic",
                      "shape quadratic transfer flip 1.0 scheme musl",
                      "shape cubic transfer flip 1.0"))
{
  const double rate = 1.0e-6, E = 100.0, c = sqrt(E * 0.7 / (1.3 * 0.4));
  Scene run(plane("si", "f f", "-12 12 -12 12", 1, 0.3) +
            body("block -10 10 -10 10 INF INF", strprintf("density 1.0 linear %.17g 0.3", E),
                 strprintf("1.0 %s", GetParam())) +
            "timestep 0.01\n");
  run.set_reference();
  run.set_velocity([=](const double *x, double *v) {
    v[0] = rate * x[0];
    v[1] = -0.5 * rate * x[1];
  });
  run.commands("run 10\n");
  // waves come in from the free surface, c t = 1.2, with numerical precursors
  const double t = 0.1, reach = c * t + 6.0;
  double error = 0.0;
  int n = 0;
  for (int i = 0; i < run.n(); i++) {
    const double *X = run.reference(i);
    if (std::abs(X[0]) > 10.0 - reach || std::abs(X[1]) > 10.0 - reach) continue;
    n++;
    grow(error, run.points().F[i][0] - 1.0 - rate * t);
    grow(error, run.points().F[i][4] - 1.0 + 0.5 * rate * t);
    grow(error, run.points().F[i][1]);
  }
  ASSERT_GT(n, 20);
  EXPECT_LT(
      measured(strprintf("stressed patch %s, error / strain", GetParam()), error / (rate * t)),
      1.0e-4);
}

// ten turns of a stressed block, driven by nodes: points, stress, and J come back (pitfalls 1, 13)
struct RotationCase {
  int dim;
  const char *options, *law;
  friend void PrintTo(const RotationCase &c, std::ostream *out) { *out << c.options << c.law; }
};

static const char *const hypoelastic = "linear 1000 0.3";
static const char *const plastic =
    "eos linear 833.33333333333333 strength j2 384.61538461538462 10";
static const char *const rubber = "neohookean 1000 0.3";

static const RotationCase driven_rotation_cases[] = {
    {2, "shape quadratic transfer apic", hypoelastic},
    {3, "shape quadratic transfer apic", hypoelastic},
    {3, "shape linear transfer flip 1.0 scheme musl", hypoelastic},
    {3, "shape cubic transfer pic scheme usf", hypoelastic},
    {2, "shape quadratic transfer apic", plastic},
    {3, "shape quadratic transfer apic", plastic},
    {3, "shape linear transfer flip 1.0 scheme musl", plastic},
    {2, "shape quadratic transfer apic", rubber},
    {3, "shape quadratic transfer apic", rubber},
    {3, "shape linear transfer flip 1.0 scheme musl", rubber}};

PARAMETER_TEST(DrivenRotation, TenTurns, RotationCase, ValuesIn(driven_rotation_cases))
{
  LONG_AFTER(2);
  const auto &c = GetParam();
  Scene run(box(c.dim, "si", "f f f", "-6 6 -6 6 -6 6", 1, 0.3) +
            body(strprintf("block -1 2 -1 1 %s", c.dim == 2 ? "INF INF" : "-1 1"),
                 std::string("density 1.0 ") + c.law, strprintf("1.0 %s dtcheck no", c.options)) +
            strprintf("region everything block -50 50 -50 50 -50 50\n"
                      "fix turn all mpm/boundary region everything stick rotate 0.3 -0.2 0 %s 1.0\n"
                      "timestep %.17g\n",
                      c.dim == 2 ? "0 0 1" : "0.36 0.48 0.8", 2.0 * PI / 100.0));
  run.set_reference();
  const double deep = c.dim - 2;
  double s0[6] = {3.0, -1.0, 0.5, 0.7, -0.4 * deep, 0.2 * deep};
  if (c.law == plastic)
    s0[2] = -s0[0] - s0[1];    // below its yield stress, without pressure, as J = 1
  double F0[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  if (c.law == rubber) {    // which has its stress from F
    const double stretch[9] = {1.003,  0.001,         -0.0006 * deep,
                               0.0005, 0.998,         0.0004 * deep,
                               0.0,    0.0003 * deep, 1.0 + 0.0005 * deep};
    std::copy(stretch, stretch + 9, F0);
  }
  const double J0 = F0[0] * (F0[4] * F0[8] - F0[5] * F0[7]) -
      F0[1] * (F0[3] * F0[8] - F0[5] * F0[6]) + F0[2] * (F0[3] * F0[7] - F0[4] * F0[6]);
  if (c.law == rubber) {
    const double lambda = 1000.0 * 0.3 / (1.3 * 0.4), mu = 1000.0 / 2.6;
    const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
    for (int k = 0; k < 6; k++) {
      s0[k] = k < 3 ? lambda * log(J0) - mu : 0.0;
      for (int d = 0; d < 3; d++) s0[k] += mu * F0[3 * row[k] + d] * F0[3 * column[k] + d];
    }
  }
  const double trace0 = s0[0] + s0[1] + s0[2];
  double norm0 = 0.0;
  for (int k = 0; k < 6; k++) norm0 += (k < 3 ? 1.0 : 2.0) * s0[k] * s0[k];
  for (int i = 0; i < run.n(); i++) {
    for (int k = 0; k < 6; k++) run.points().tau[i][k] = s0[k];
    for (int k = 0; k < 9; k++) run.points().F[i][k] = F0[k];
  }
  double error_J = 0.0, error_invariants = 0.0, turned = 0.0;
  run.each_step([&](double **) {
    for (int i = 0; i < run.n(); i++) {
      const double *s = run.points().tau[i];
      double norm = 0.0;
      for (int k = 0; k < 6; k++) norm += (k < 3 ? 1.0 : 2.0) * s[k] * s[k];
      grow(error_J, run.points().jacobian(i) - J0);
      grow(error_invariants, s[0] + s[1] + s[2] - trace0);
      grow(error_invariants, sqrt(norm) - sqrt(norm0));
      grow(turned, s[0] - s0[0]);
    }
  });
  run.commands("run 1000\n");
  double error_x = 0.0, error_s = 0.0, error_F = 0.0;
  for (int i = 0; i < run.n(); i++) {
    for (int k = 0; k < 9; k++) grow(error_F, run.points().F[i][k] - F0[k]);
    for (int d = 0; d < 3; d++) grow(error_x, run.x()[i][d] - run.reference(i)[d]);
    for (int k = 0; k < 6; k++) grow(error_s, run.points().tau[i][k] - s0[k]);
  }
  // after 1000 steps of 0.06 rad, round-off alone: 1e-10 of the stress, and of the modulus for
  // rubber, whose stress of 1e-3 of it is what J and F leave
  EXPECT_GT(turned, 1.0);
  EXPECT_LT(measured("driven rotation, |J - J0|", error_J), 1.0e-11);
  EXPECT_LT(measured("driven rotation, error of position", error_x), 1.0e-11);
  EXPECT_LT(measured("driven rotation, error of F", error_F), 1.0e-11);
  const double scale = c.law == rubber ? 1000.0 : sqrt(norm0);
  EXPECT_LT(measured("driven rotation, error of stress", error_s / scale), 1.0e-10);
  EXPECT_LT(measured("driven rotation, error of invariants", error_invariants / scale), 1.0e-10);
}

// C1: two elastic disks collide (Sulsky, Chen, Schreyer 1994, section 7.3)
struct DisksCase {
  const char *options;
  double energy_low, energy_high;      // E/E0 at t = 3.5
  double kinetic_low, kinetic_high;    // KE/KE0 at t = 3.5
  const char *law = "linear";
  friend void PrintTo(const DisksCase &c, std::ostream *out) { *out << c.options; }
};

static const std::string two_disks = plane("si", "f f", "0 1 0 1", 2, 0.02) + R"(
fix grid all mpm 0.05 MPM_OPTIONS
)" +
    bodies({{"one", "cylinder z 0.2 0.2 0.2 INF INF"}, {"two", "cylinder z 0.8 0.8 0.2 INF INF"}}) +
    R"(
fix rubber all mpm/material density 1000 MPM_LAW 1000 0.3
velocity one set 0.1 0.1 0
velocity two set -0.1 -0.1 0
timestep 0.001
)";

// FLIP MUSL: E/E0 0.985 to 1.015, KE/KE0 0.86 to 0.94; others: losses as tabulated, 10 %. The table
// (hat MUSL 2.407 + .187, bs2 MUSL 2.269 + .328, FLIP 0.99 E/E0 .856, PIC .043, APIC .295) is for a
// law in the rate of the Cauchy stress. With that law, tried in a copy, this package gives 2.408 +
// .187, 2.271 + .337, .857, .043, .279. Law `linear' is in the rate of the Kirchhoff stress,
// stiffer at the compression of 15 % of this impact, and gives E/E0 .999, .999, .834, .055, .299.
// Quadratic MUSL has KE/KE0 = .855, .885, .871 with 20, 40, 80 cells (the table's law .873, .905,
// .898; neohookean .869, .905, .901): with law `linear', 20 cells are too few for the gate, which
// neohookean passes there, and which is asked of all with 40 cells, see Refined. Cubic functions,
// 16 nodes in the two halves of a disk of 8 cells, leave more in vibrations: .815 (neohookean .847)
// with 20 cells. Linear USL is missing: see is_sound(), points pass exactly through nodes here.
static const DisksCase two_disks_cases[] = {
    {"shape linear transfer flip 1.0 scheme musl", .985, 1.015, .86, .94},
    {"shape quadratic transfer flip 1.0 scheme musl", .985, 1.015, .85, .94},
    {"shape cubic transfer flip 1.0 scheme musl", .985, 1.015, .80, .94},
    {"shape quadratic transfer flip 1.0 scheme musl", .985, 1.015, .86, .94, "neohookean"},
    {"shape quadratic transfer flip 1.0 scheme usl", .93, .99, .80, .90},
    {"shape linear transfer flip 0.99 scheme musl", .82, .87, .76, .90},
    {"shape linear transfer pic", .03, .065, .03, .065},
    {"shape quadratic transfer apic", .26, .33, .25, .33},
    {"shape cubic transfer apic", .15, .21, .15, .21}};

PARAMETER_TEST(TwoDisks, Collision, DisksCase, ValuesIn(two_disks_cases))
{
  LONG_AFTER(2);
  const auto &c = GetParam();
  Scene run(replaced(replaced(two_disks, "MPM_OPTIONS", c.options), "MPM_LAW", c.law));
  ASSERT_EQ(run.n(), 416);
  const double start = run.sums().kinetic;
  EXPECT_NEAR(start, 2.6, 1.0e-14);    // of the lattice of 416 points
  const double momentum = run.sums(1).mass * 0.1;
  double p = 0.0, asymmetry = 0.0, lowest = start, t_lowest = 0.0;
  run.each_step([&](double **) {
    const auto all = run.sums(), one = run.sums(1), two = run.sums(2);
    for (int d = 0; d < 2; d++) {
      p = std::max(p, std::abs(all.p[d]) / momentum);
      grow(asymmetry, one.x[d] + two.x[d] - 1.0);
    }
    if (all.kinetic < lowest) {
      lowest = all.kinetic;
      t_lowest = run.time();
    }
  });
  run.commands("run 3500\n");
  const double kinetic = run.sums().kinetic, stored = run.stored_energy();
  const std::string name = strprintf("C1 %s %s: ", c.options, c.law);
  measured(name + "KE end", kinetic);
  measured(name + "SE end", stored);
  measured(name + "KE min", lowest);
  measured(name + "t of KE min", t_lowest);
  EXPECT_LT(measured(name + "momentum", p), 1.0e-12);
  EXPECT_LT(measured(name + "asymmetry", asymmetry), 1.0e-12);
  const auto points = run.gather();    // tags are in the order of sites: the last mirrors the first
  for (std::size_t k = 0; k < points.size(); k++)
    for (int d = 0; d < 2; d++) {
      const auto &other = points[points.size() - 1 - k];
      grow(asymmetry, points[k].x[d] + other.x[d] - 1.0);
      asymmetry = std::max(asymmetry, std::abs(points[k].v[d] + other.v[d]) / 0.1);
    }
  measured(name + "asymmetry of points", asymmetry);
  if (is_sound(c.options)) { EXPECT_LT(asymmetry, 1.0e-10); }
  const double energy = measured(name + "E/E0", (kinetic + stored) / start);
  EXPECT_GT(energy, c.energy_low);
  EXPECT_LT(energy, c.energy_high);
  EXPECT_GT(kinetic / start, c.kinetic_low);
  EXPECT_LT(kinetic / start, c.kinetic_high);
}

TEST(TwoDisks, Refined)
{
  LONG_CASE();
  for (const char *shape : {"quadratic", "cubic"}) {
    std::string scene = replaced(two_disks, "MPM_OPTIONS",
                                 strprintf("shape %s transfer flip 1.0 scheme musl", shape));
    scene = replaced(replaced(scene, "MPM_LAW", "linear"), "mpm 0.05", "mpm 0.025");
    Scene run(replaced(scene, "timestep 0.001", "timestep 0.0005"));
    const double start = run.sums().kinetic;
    run.commands("run 7000\n");
    const double kinetic = run.sums().kinetic;
    const double ratio = measured(strprintf("C1 %s, 40 cells: KE/KE0", shape), kinetic / start);
    EXPECT_GT(ratio, 0.86);
    EXPECT_LT(ratio, 0.94);
    EXPECT_NEAR((kinetic + run.stored_energy()) / start, 1.0, 0.015);
  }
}

// The velocity at which the disks part, over that at which they met, is 0.895 in fine lattices of
// quadratic and cubic functions (bench/atlas): with apic, it depends on the number of steps
TEST(TwoDisks, PartWithTheVelocityOfFineLattices)
{
  const auto velocity = [](const char *options, const char *h, double of_limit) {
    Scene run(replaced(replaced(replaced(two_disks, "MPM_OPTIONS", options), "MPM_LAW", "linear"),
                       "mpm 0.05", std::string("mpm ") + h) +
              strprintf("fix step all mpm/dt %g until 3.5\nrun 100000\n", of_limit));
    const auto one = run.sums(1);
    return measured(strprintf("%s, h %s, %g", options, h, of_limit), -one.p[0] / one.mass / 0.1);
  };
  EXPECT_NEAR(velocity("", "0.05", 0.4), 0.895, 0.05);
  EXPECT_NEAR(velocity("", "0.025", 0.4), 0.895, 0.01);
  EXPECT_LT(velocity("", "0.05", 0.1), 0.75);
  for (const double of_limit : {0.4, 0.1})
    EXPECT_NEAR(velocity("transfer aflip 1.0", "0.05", of_limit), 0.895, 0.025);
}

// C3: two rings collide at 60 m/s: momentum, symmetry, energy; no point is lost, they bounce off
TEST(Rings, Collision)
{
  LONG_CASE();
  const double h = 2.5e-3;
  Scene run(plane("si", "f f", "-0.15 0.15 -0.08 0.08", 2, 0.4 * h) +
            strprintf("fix grid all mpm %.17g transfer flip 1.0 scheme musl\n"
                      "region outer1 cylinder z -0.05 0 0.04 INF INF\n"
                      "region inner1 cylinder z -0.05 0 0.03 INF INF side out\n"
                      "region outer2 cylinder z 0.05 0 0.04 INF INF\n"
                      "region inner2 cylinder z 0.05 0 0.03 INF INF side out\n",
                      h) +
            bodies({{"one", "intersect 2 outer1 inner1"}, {"two", "intersect 2 outer2 inner2"}}) +
            "fix m all mpm/material density 1010 neohookean 73.08e6 0.4\n"
            "velocity one set 30 0 0\nvelocity two set -30 0 0\ntimestep 1.25e-6\nrun 0\n");
  const auto start = run.sums();
  const auto energy = [&]() {
    return run.sums().kinetic + run.stored_energy();
  };
  const double E0 = energy();
  double asymmetry = 0.0, drift = 0.0, worst = 0.0;
  for (int k = 0; k < 14; k++) {
    run.commands("run 200 post no\n");
    const auto one = run.sums(1), two = run.sums(2), all = run.sums();
    asymmetry = std::max(asymmetry, std::abs(one.x[0] + two.x[0]) / h);
    drift = std::max(drift, std::abs(all.p[0]) / (start.mass * 30.0));
    grow(worst, energy() / E0 - 1.0);
  }
  EXPECT_LT(measured("C3 asymmetry", asymmetry), 1.0e-8);
  EXPECT_LT(measured("C3 momentum", drift), 1.0e-12);
  EXPECT_LT(measured("C3 energy", worst), 0.02);
  const auto one = run.sums(1);
  const double rebound = measured("C3 rebound", -one.p[0] / one.mass / 30.0);
  EXPECT_GT(rebound, 0.6);
  EXPECT_LT(rebound, 0.95);
  double loneliest = 0.0;
  for (int i = 0; i < run.n(); i++) {
    double nearest = 1.0e300;
    for (int j = 0; j < run.n(); j++)
      if (j != i)
        nearest = std::min(
            nearest, std::hypot(run.x()[i][0] - run.x()[j][0], run.x()[i][1] - run.x()[j][1]));
    loneliest = std::max(loneliest, nearest);
  }
  EXPECT_LT(measured("C3 largest distance to the next point / h", loneliest / h), 1.5);
}

// all kernels of the two storage forms (force apart from momentum, or merged with it)
TEST(LedgerOnOff, SameTrajectory)
{
  for (auto *options : {"shape quadratic transfer apic", "shape cubic transfer apic",
                        "shape quadratic transfer apic scheme musl"}) {
    SCOPED_TRACE(options);
    const char *go = "run 1900\n";    // into the collision
    Scene off, on;
    const std::string scene =
        replaced(replaced(two_disks, "MPM_OPTIONS", options), "MPM_LAW", "linear");
    off.commands(scene + go);
    on.commands(scene + "compute e all mpm/energy\n" + go);
    const auto a = off.gather(), b = on.gather();
    double error = 0.0;
    for (std::size_t k = 0; k < a.size(); k++)
      for (int d = 0; d < 2; d++) {
        grow(error, a[k].x[d] - b[k].x[d]);
        grow(error, (a[k].v[d] - b[k].v[d]) / 0.1);
      }
    EXPECT_LT(measured(strprintf("ledger on/off, %s", options), error), 1.0e-12);
  }
}

// the energy ledger closes at every step, for all transfers and schemes
TEST(Ledger, ClosesToRoundOff)
{
  enum { KINETIC, STORED, EXTERNAL = 5, BOUNDARY, TRANSFER = 8, RESIDUAL = 10 };
  for (const auto &options : all_options()) {
    if (!is_sound(options)) continue;
    SCOPED_TRACE(options);
    // a block falls on the floor with friction, a disk hits the wall
    Scene run(
        plane("si", "f f", "0 14 0 14", 2, 0.3) + "fix grid all mpm 1.0 " + options + "\n" +
        bodies({{"one", "block 2 6 1 4 INF INF"}, {"two", "cylinder z 8.5 4.5 1.9 INF INF"}},
               "ppc 3") +
        strprintf("fix m1 one mpm/material density 1.0 linear 100 0.3\n"
                  "fix m2 two mpm/material density 2.0 neohookean 200 0.2\n"
                  "velocity all set 0.5 -0.7 0\nvelocity two set 1.3 -0.5 0\n"
                  "fix floor all mpm/boundary ylo %s\nfix right all mpm/boundary xhi slip\n"
                  "fix g all gravity 0.5 vector 0 -1 0\ncompute e all mpm/energy\n"
                  "thermo_style custom step c_e c_e[*]\nthermo 1\ntimestep 0.01\n",
                  options.find("usf") == std::string::npos ? "separate friction 0.3" : "slip"));
    double worst = 0.0, scale = 0.0;
    run.commands("run 0 post no\n");
    const double start = run.compute_scalar(), *e = nullptr;
    for (int k = 0; k < 40; k++) {
      run.commands("run 10 post no\n");
      e = run.compute_vector();
      grow(worst, e[RESIDUAL]);
      scale = std::max(scale, std::max(start, e[KINETIC] + e[STORED]));
      // and it is what it says it is
      const auto s = run.sums();
      EXPECT_NEAR(e[KINETIC], s.kinetic, 1.0e-12 * scale);
      EXPECT_NEAR(e[STORED], run.stored_energy(), 1.0e-12 * scale);
    }
    EXPECT_LT(worst / scale, 1.0e-12);
    EXPECT_GT(std::abs(e[EXTERNAL]), 1.0e-3 * scale);
    if (options.find("usf") == std::string::npos) {
      EXPECT_LT(e[BOUNDARY], -1.0e-3 * scale);    // friction; a wall that slips does no work
    } else {
      EXPECT_LT(std::abs(e[BOUNDARY]), 1.0e-12 * scale);
    }
    EXPECT_GT(e[STORED], 0.0);
    if (options.find("flip 1.0") == std::string::npos) {
      EXPECT_LT(e[TRANSFER], -1.0e-2 * scale);    // PIC, APIC: numerical loss
    }
  }
}

// the work of gravity is what the body gains, in closed form
TEST(Ledger, WorkOfGravity)
{
  for (auto *options :
       {"transfer apic", "transfer flip 1.0 scheme musl", "transfer pic scheme usf"}) {
    Scene run(space("si", "f f f", "0 8 0 8 0 20", 1, 0.3) +
              strprintf("fix grid all mpm 1 %s\nregion body sphere 4 4 16 2.1\n"
                        "create_points 1 region body\n"
                        "fix m all mpm/material density 3 linear 100 0.3\n"
                        "fix g all gravity 2 vector 0 0 -1\ncompute e all mpm/energy\n"
                        "thermo_style custom step c_e[6]\ntimestep 0.02\nrun 100\n",
                        options));
    const double *e = run.compute_vector(), fall = 0.5 * run.sums().mass * 16.0;
    EXPECT_NEAR(e[5] / fall, 1.0, 1.0e-12);
    EXPECT_NEAR(e[8] / fall, 0.0, 1.0e-12);
  }
}

// C2: a spinning disk, free in space. Angular momentum is an invariant of APIC.
struct SpinCase {
  const char *options;
  double revolutions;
  double L_low, L_high;
  double energy_low, energy_high;
  friend void PrintTo(const SpinCase &c, std::ostream *out) { *out << c.options; }
};

static constexpr double SPIN_R = 0.25, SPIN_OMEGA = 10.0;

/** Rigid rotation. */
static void setup_spin(Scene &run, const std::string &options, const std::string &law, double h)
{
  run.commands(
      plane("si", "f f", "-0.5 0.5 -0.5 0.5", 1, 0.4 * h) +
      strprintf("fix grid all mpm %.17g %s\nregion disk cylinder z 0 0 %g INF INF\n"
                "create_points 1 region disk ppc 2\ndisplace_atoms all move %.17g %.17g 0\n"
                "fix m all mpm/material density 1000 %s 1.0e6 0.3\n",
                h, options.c_str(), SPIN_R, 0.37 * h, 0.37 * h, law.c_str()));
  const double o = 0.37 * h;
  run.set_velocity([=](const double *x, double *v) {
    v[0] = -SPIN_OMEGA * (x[1] - o);
    v[1] = SPIN_OMEGA * (x[0] - o);
  });
  run.commands("run 0\n");    // fits the affine matrices of APIC
}

static const SpinCase spinning_disk_cases[] = {
    {"shape quadratic transfer apic", 1.0, 1.0 - 1e-10, 1.0 + 1e-10, .999, 1.0001},
    {"shape cubic transfer apic", 1.0, 1.0 - 1e-10, 1.0 + 1e-10, .999, 1.0001},
    {"shape quadratic transfer apic scheme musl", 0.2, .99995, 1.0001, .999, 1.001},
    {"shape quadratic transfer apic scheme usf", 0.2, 1.0 - 1e-10, 1.0 + 1e-10, .999, 1.001},
    {"shape quadratic transfer aflip 1.0", 1.0, .9995, 1.0001, .999, 1.0001},
    {"shape quadratic transfer aflip 1.0 scheme musl", 0.2, .9995, 1.0001, .999, 1.001},
    {"shape quadratic transfer tpic", 1.0, .99995, 1.0001, .999, 1.0001},
    {"shape gimp transfer apic", 1.0, .9998, 1.0001, .999, 1.0001},
    {"shape cpgimp transfer flip 1.0 scheme musl", 1.0, .97, 1.0001, .97, 1.01},
    {"shape quadratic transfer flip 1.0 scheme musl", 1.0, .97, 1.0001, .97, 1.01},
    {"shape linear transfer flip 1.0 scheme musl", 1.0, .97, 1.0001, .97, 1.01},
    {"shape quadratic transfer pic", 1.0, -.05, .05, 0.0, .05}};

PARAMETER_TEST(SpinningDisk, AngularMomentum, SpinCase, ValuesIn(spinning_disk_cases))
{
  LONG_AFTER(2);
  const auto &c = GetParam();
  const double h = 0.025;
  Scene run;
  setup_spin(run, c.options, "neohookean", h);
  const auto start = run.sums();
  double p = 0.0, drift = 0.0, moved[3] = {};
  const double scale = start.mass * SPIN_OMEGA * SPIN_R;
  run.set_reference();
  run.each_step([&](double **) {
    const auto s = run.sums();
    run.add_angular_momentum_of_motion(moved);
    p = std::max(p, std::max(std::abs(s.p[0]), std::abs(s.p[1])) / scale);
    grow(drift, (s.L[2] - moved[2]) / start.L[2] - 1.0);
  });
  const int n = std::lround(3300 * c.revolutions);
  run.commands(strprintf("timestep %.17g\nrun %d\n", 2.0 * PI / SPIN_OMEGA / 3300.0, n));
  const auto end = run.sums();
  const double L = end.L[2] / start.L[2];
  const double E = (end.kinetic + run.stored_energy()) / start.kinetic;
  const std::string name = strprintf("C2 %s, %g revolutions: ", c.options, c.revolutions);
  EXPECT_LT(measured(name + "momentum", p), 1.0e-13);
  EXPECT_GT(measured(name + "L/L0", L), c.L_low);
  EXPECT_LT(L, c.L_high);
  EXPECT_GT(measured(name + "E/E0", E), c.energy_low);
  EXPECT_LT(E, c.energy_high);
  const std::string options = c.options;
  if (options.find("apic") != std::string::npos && options.find("linear") == std::string::npos &&
      options.find("gimp") == std::string::npos) {
    EXPECT_LT(measured(name + "drift of L", drift), 1.0e-10);
  }
}

// the invariants over 1000 steps, in 3d, of a body without symmetry
PARAMETER_TEST(FreeBody, Invariants, const char *,
               Values("shape quadratic transfer apic", "shape cubic transfer apic",
                      "shape quadratic transfer apic scheme musl",
                      "shape linear transfer flip 1.0 scheme musl",
                      "shape quadratic transfer flip 0.99 scheme musl"))
{
  Scene run(space("si", "f f f", "-7 7 -7 7 -7 7", 1, 0.3) +
            strprintf("fix grid all mpm 1.0 %s\nregion a block -2 1 -2 2 -1 2\n"
                      "region b sphere 1 0.5 0 1.8\nregion body union 2 a b\n"
                      "create_points 1 region body ppc 2\n"
                      "fix m all mpm/material density 1.0 neohookean 50 0.3\ntimestep 0.02\n",
                      GetParam()));
  run.set_velocity([](const double *x, double *v) {
    v[0] = -0.4 * x[1] + 0.1 * x[2] + 0.02;
    v[1] = 0.3 * x[0] - 0.2 * x[2] - 0.01;
    v[2] = 0.2 * x[1] + 0.15 * sin(x[0]) + 0.03;
  });
  run.commands("run 0\n");
  const auto start = run.sums();
  double mass = 0.0, p = 0.0, L = 0.0, moved[3] = {};
  const double scale_p = sqrt(2.0 * start.kinetic * start.mass);
  double scale_L = 0.0;
  for (double l : start.L) scale_L += l * l;
  scale_L = sqrt(scale_L);
  run.set_reference();
  run.each_step([&](double **) {
    const auto s = run.sums();
    run.add_angular_momentum_of_motion(moved);
    grow(mass, s.mass / start.mass - 1.0);
    for (int d = 0; d < 3; d++) {
      p = std::max(p, std::abs(s.p[d] - start.p[d]) / scale_p);
      L = std::max(L, std::abs(s.L[d] - moved[d] - start.L[d]) / scale_L);
    }
  });
  run.commands("run 1000\n");
  const std::string name = strprintf("free body %s: ", GetParam());
  EXPECT_LT(measured(name + "mass", mass), 1.0e-13);
  EXPECT_LT(measured(name + "momentum", p), 1.0e-13);
  // musl moves points with velocities that were mapped back, and not with those that they have:
  // what that changes is known to round-off, and as small as the manual says
  if (strstr(GetParam(), "apic")) {
    EXPECT_LT(measured(name + "angular momentum", L), 1.0e-12);
    double size = 0.0;
    for (double l : moved) size += l * l;
    EXPECT_LT(measured(name + "that of the motion", sqrt(size) / scale_L),
              strstr(GetParam(), "musl") ? 2.0e-4 : 1.0e-12);
  }
}

// compute mpm/atom angmom: an affine field that spins has m omega (D_xx + D_yy), D the mean of r r
struct AffineSpin {
  const char *options;
  std::function<double(double)> D;    // along an axis, of the place in the cell, h = 1
};

static double hats(double f)
{
  f -= std::floor(f);
  return f * (1.0 - f);
}

TEST(AffineSpin, IsThatOfTheShapeFunctions)
{
  const double half = 0.25;    // of a point
  const auto gimp =
      [=](double f) {    // mean over the point of (x - x_p)^2 and of those of linear functions
        double sum = 0.0;
        const int n = 2000;
        for (int k = 0; k < n; k++) sum += hats(f - half + 2.0 * half * (k + 0.5) / n) / n;
        return half * half / 3.0 + sum;
      };
  const auto cpdi = [=](double f) {
    return half * half + 0.5 * (hats(f - half) + hats(f + half));
  };
  const auto uniform = [](double D) {
    return [=](double) {
      return D;
    };
  };
  const AffineSpin cases[] = {{"transfer apic", uniform(0.25)},
                              {"transfer polypic", uniform(0.25)},
                              {"shape cubic transfer tpic", uniform(1.0 / 3.0)},
                              {"shape cubic transfer aflip 1.0", uniform(1.0 / 3.0)},
                              {"transfer apic frame total", uniform(0.25)},
                              {"shape linear transfer apic light 0.5", hats},
                              {"shape gimp transfer apic", gimp},
                              {"shape cpgimp transfer apic", gimp},
                              {"shape cpdi transfer apic", cpdi},
                              {"shape cpdi2 transfer apic", cpdi},
                              {"transfer flip 1.0", uniform(0.0)}};
  const double omega = 0.01;
  for (const auto &c : cases)
    for (int dim : {2, 3}) {
      Scene run(box(dim, "lj", "f f f", "0 8 0 8 0 8") +
                strprintf("fix grid all mpm 1.0 %s\nregion body block 2 5 2 5 %s\n"
                          "create_points 1 region body ppc 2\ndisplace_atoms all move 0.25 0.1 0\n"
                          "fix m all mpm/material density 3.0 neohookean 1.0 0.3\ntimestep 1.0e-9\n"
                          "compute q all mpm/atom angmom/*\nrun 0\n",
                          c.options, dim == 3 ? "2 5" : "INF INF"));
      run.set_velocity([=](const double *x, double *v) {
        v[0] = -omega * (x[1] - 3.0);
        v[1] = omega * (x[0] - 3.0);
      });
      run.commands("run 0\n");
      auto *compute = run.per_atom("q");
      for (int i = 0; i < run.n(); i++) {
        const double *x = run.x()[i];
        const double L = run.lmp->atom->rmass[i] * omega * (c.D(x[0]) + c.D(x[1]));
        for (int d = 0; d < 3; d++)
          ASSERT_NEAR(compute->array_atom[i][d], d == 2 ? L : 0.0, 1.0e-7 * omega) << c.options;
      }
    }
}

// with that of the velocities of points, it is what is conserved
TEST(AffineSpin, CompletesTheAngularMomentum)
{
  for (const char *options :
       {"transfer apic", "transfer polypic", "shape cubic transfer apic scheme usf",
        "transfer apic frame total"}) {
    SCOPED_TRACE(options);
    Scene run(plane("lj", "p p", "0 16 0 16") +
              body("block 2 9 2 5 INF INF", "density 3.0 neohookean 1.0 0.3",
                   strprintf("1.0 %s", options)) +
              "timestep 0.5\ncompute q all mpm/atom angmom/z\ncompute sum all reduce sum c_q\n"
              "variable L equal angmom(all,z)+c_sum\nthermo_style custom step c_sum\n");
    run.set_velocity([](const double *x, double *v) {
      v[0] = 0.4 - 0.02 * (x[1] - 3.5);
      v[1] = 0.3 + 0.02 * (x[0] - 5.5) + 0.05 * cos(x[0]);
    });
    run.commands("run 0\n");
    const double start = run.evaluate("v_L"), part = run.evaluate("c_sum") / start;
    run.commands("run 500\n");    // most of a turn
    const double L =
        measured(std::string(options) + ": change of L", run.evaluate("v_L") / start - 1.0);
    const auto s = run.sums();
    const double about = s.x[0] * s.p[1] - s.x[1] * s.p[0];
    EXPECT_NEAR(run.evaluate("v_L"), s.L[2] - about, 1.0e-11 * start);
    EXPECT_GT(part, 0.02);
    if (std::string(options).find("total") == std::string::npos) {
      EXPECT_LT(std::abs(L), 1.0e-11);
    }
  }
}

// nothing is lost at the start: without a fit, the first step took 2 % of the kinetic energy
TEST(SpinningDisk, KeepsItsEnergyAtTheStart)
{
  for (auto *options : {"shape quadratic", "shape cubic", "shape quadratic scheme musl"}) {
    Scene run;
    setup_spin(run, options, "neohookean", 0.025);
    const double start = run.sums().kinetic;
    run.commands("timestep 1e-6\nrun 1\n");
    EXPECT_LT(measured(std::string("loss of the first step, ") + options,
                       std::abs(run.sums().kinetic / start - 1.0)),
              1.0e-9);
  }
}

// five revolutions: the disk keeps its size, and J agrees with it (pitfall 13).
// F_new = (1 + dt L) F belongs to x_new = x + dt v: det(1 + dt L) is the change of volume of the
// points' own motion. The exponential of dt L is not: for a body that turns by an angle a in a step
// its determinant is exp(2 cos a - 2) < 1, and the stress would let the disk grow, by 1.2 % of its
// area in each revolution (tried: the radius grew by 2.7 % in five).
// Centrifugal stretch in plane strain, K = (1-2nu)(1+nu) rho omega^2/(8 E (1-nu)):
// u(r) = K ((3-2nu) R^2 - r^2) r, mean J - 1 = 2 u(R)/R = 1.625e-3, and the polar radius of
// gyration grows by K R^2 ((3-2nu) - 2/3) = 1.0060e-3.
struct LongSpinCase {
  const char *options, *law;
  friend void PrintTo(const LongSpinCase &c, std::ostream *out) { *out << c.options; }
};

static const LongSpinCase long_spin_cases[] = {{"transfer apic", "neohookean"},
                                               {"transfer apic", "linear"},
                                               {"transfer apic scheme musl", "neohookean"},
                                               {"transfer apic scheme usf", "neohookean"}};

PARAMETER_TEST(LongSpin, SizeAndJ, LongSpinCase, ValuesIn(long_spin_cases))
{
  LONG_CASE();
  const double h = 0.025;
  Scene run;
  setup_spin(run, GetParam().options, GetParam().law, h);
  // means over one revolution of the radius of gyration of the points, and of J
  double gyration0 = 0.0, gyration[5] = {0.0}, J[5] = {0.0};
  int count[5] = {0};
  const int steps = 3300;
  const double dt = 2.0 * PI / SPIN_OMEGA / steps;
  run.each_step(
      [&](double **) {
        const auto s = run.sums();
        double r2 = 0.0, sum = 0.0;
        for (int i = 0; i < run.n(); i++) {
          const double dx = run.x()[i][0] - s.x[0], dy = run.x()[i][1] - s.x[1];
          r2 += dx * dx + dy * dy;
          sum += run.points().jacobian(i);
        }
        const double r = sqrt(r2 / run.n());
        if (run.time() == 0.0) gyration0 = r;
        const int k = std::min(4, (int) (run.time() / (steps * dt)));
        gyration[k] += r;
        J[k] += sum / run.n();
        count[k]++;
      },
      10);
  run.commands(strprintf("timestep %.17g\nrun %d\n", dt, 5 * steps));
  for (int k = 0; k < 5; k++) {
    gyration[k] = gyration[k] / count[k] / gyration0 - 1.0;
    J[k] = J[k] / count[k] - 1.0;
  }
  const std::string name = strprintf("long spin, %s, %s: ", GetParam().options, GetParam().law);
  EXPECT_NEAR(measured(name + "J - 1, first revolution", J[0]), 1.625e-3, 0.03 * 1.625e-3);
  EXPECT_NEAR(measured(name + "J - 1, fifth revolution", J[4]), 1.625e-3, 0.03 * 1.625e-3);
  measured(name + "gyration, first", gyration[0]);
  measured(name + "gyration, fifth", gyration[4]);
  EXPECT_NEAR(J[4], J[0], 1.0e-5);    // a drift of 2e-6 per revolution would be seen
  if (name.find("usf") == std::string::npos) {
    EXPECT_NEAR(gyration[0], 1.006e-3, 0.03 * 1.006e-3);
    EXPECT_NEAR(gyration[4], 1.006e-3, 0.03 * 1.006e-3);
    EXPECT_NEAR(gyration[4], gyration[0], 3.0e-5);
  } else {
    // what USF maps anew has affine matrices of the positions before: 1e-4 per revolution
    EXPECT_NEAR(gyration[0], 1.006e-3, 0.1 * 1.006e-3);
    EXPECT_NEAR(gyration[4], gyration[0], 6.0e-4);
  }
}

// a spinning rod gains no shear in the frame that turns with it (pitfall 1: 0.07 in 1.9 turns)
TEST(SpinningRod, GainsNoShear)
{
  LONG_CASE();
  const double omega = 2.0 * PI;
  Scene run(plane("si", "f f", "-0.8 0.8 -0.8 0.8", 1, 0.02) +
            "fix grid all mpm 0.05\nregion rod block -0.5 0.5 -0.1 0.1 INF INF\n"
            "create_points 1 region rod ppc 2\n"
            "fix m all mpm/material density 1000 linear 1.0e7 0.3\ntimestep 1.0e-4\n");
  run.set_velocity([=](const double *x, double *v) {
    v[0] = -omega * x[1];
    v[1] = omega * x[0];
  });
  double shear = 0.0, strain = 0.0;
  run.each_step(
      [&](double **) {
        if (run.time() < 1.7) return;
        for (int i = 0; i < run.n(); i++) {
          const double *F = run.points().F[i];
          // F = R U, in the plane: tan(angle) = (F21 - F12)/(F11 + F22)
          const double a = atan2(F[3] - F[1], F[0] + F[4]);
          const double Uxy = cos(a) * F[1] + sin(a) * F[4], Uxx = cos(a) * F[0] + sin(a) * F[3];
          grow(shear, Uxy);
          grow(strain, Uxx - 1.0);
        }
      },
      50);
  run.commands("run 19000\n");
  // centrifugal strain rho omega^2 l^2/8/E* is 4.5e-4 at the centre
  EXPECT_LT(measured("spinning rod, largest shear", shear), 5.0e-4);
  EXPECT_LT(measured("spinning rod, largest strain along it", strain), 3.0e-3);
}
