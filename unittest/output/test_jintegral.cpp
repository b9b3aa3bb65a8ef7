// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart ranks input
// mpi: 1 3
// timeout: 300

// compute mpm/jintegral

#include "base/mpm_image.h"
#include "error.h"
#include "mpm_lammps.h"

using namespace MPM_TEST;

static const double E = 1000.0, NU = 0.3;
static const std::string ELASTIC = "density 1 linear 1000 0.3";

/** J, KI, KII, and the share of the circle that points fill. */
struct Found {
  double J, K1, K2, filled;
  /** K from J, in plane strain. */
  double K() const { return std::sqrt(J * E / (1.0 - NU * NU)); }
};
static Found found(Scene &run, const std::string &id = "J")
{
  const double *const v = run.compute_vector(id);
  EXPECT_EQ(run.compute_scalar(id), v[0]);
  return {v[0], v[1], v[2], v[3]};
}

// ---------------------------------------------------------------------- known fields

/** The field around a tip: stress intensity factors, and stress along the crack. */
struct TipField {
  double K1, K2, T;
  bool plane_stress = false;

  /** Displacement at x[2] from the tip, the crack being along x[0] < 0 (Williams 1957). */
  std::array<double, 2> displacement(const double *x) const
  {
    const double mu = E / (2.0 * (1.0 + NU)), r = std::hypot(x[0], x[1]);
    const double kappa = plane_stress ? (3.0 - NU) / (1.0 + NU) : 3.0 - 4.0 * NU;
    const double half = 0.5 * std::atan2(x[1], x[0]), c = std::cos(half), s = std::sin(half);
    const double size = 0.5 / mu * std::sqrt(r / (2.0 * PI)), t = T * (1.0 + kappa) / (8.0 * mu);
    return {size * (K1 * c * (kappa - 1 + 2 * s * s) + K2 * s * (kappa + 1 + 2 * c * c)) + t * x[0],
            size * (K1 * s * (kappa + 1 - 2 * c * c) - K2 * c * (kappa - 1 - 2 * s * s)) -
                t * x[1] * (3.0 - kappa) / (1.0 + kappa)};
  }
  double J() const { return (K1 * K1 + K2 * K2) * (plane_stress ? 1.0 : 1.0 - NU * NU) / E; }
};

/** Axes of a crack: the direction in which it grows, its normal, and its front. */
using Axes = std::array<std::array<double, 3>, 3>;

static Axes axes_of(int front, double angle)
{
  const int a = (front + 1) % 3, b = (front + 2) % 3;
  Axes e = {};
  e[0][a] = e[1][b] = std::cos(angle * PI / 180);
  e[0][b] = std::sin(angle * PI / 180);
  e[1][a] = -e[0][b];
  e[2][front] = 1.0;
  return e;
}

/** Gives points the deformation and the stress of the field, which is small. tip[3]: where it is.
 *  unit: of the stress in the law. */
static void set_field(Scene &run, const TipField &field, const double *tip, const Axes &e)
{
  constexpr int voigt[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  for (int i = 0; i < run.n(); i++) {
    double x[2], dx[3], H[3][3] = {};
    for (int d = 0; d < 3; d++) dx[d] = run.x()[i][d] - tip[d];
    nearest_image(*run.lmp->domain, dx);
    for (int a = 0; a < 2; a++) x[a] = e[a][0] * dx[0] + e[a][1] * dx[1] + e[a][2] * dx[2];
    for (int b = 0; b < 2; b++) {
      constexpr double STEP = 1.0e-6;
      double there[2] = {x[0], x[1]}, back[2] = {x[0], x[1]};
      there[b] += STEP;
      back[b] -= STEP;
      for (int a = 0; a < 2; a++)
        H[a][b] = (field.displacement(there)[a] - field.displacement(back)[a]) / (2.0 * STEP);
    }
    if (field.plane_stress) H[2][2] = -NU / (1.0 - NU) * (H[0][0] + H[1][1]);
    const double mu = E / (2.0 * (1.0 + NU)), lambda = 2.0 * mu * NU / (1.0 - 2.0 * NU);
    const double trace = H[0][0] + H[1][1] + H[2][2];
    double *const F = run.points().F[i], *const tau = run.points().tau[i];
    for (int m = 0; m < 3; m++)
      for (int n = 0; n < 3; n++) {
        F[3 * m + n] = m == n;
        for (int a = 0; a < 3; a++)
          for (int b = 0; b < 3; b++) F[3 * m + n] += e[a][m] * H[a][b] * e[b][n];
      }
    for (int k = 0; k < 6; k++) {
      tau[k] = voigt[k][0] == voigt[k][1] ? lambda * trace : 0.0;
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
          tau[k] += mu * e[a][voigt[k][0]] * (H[a][b] + H[b][a]) * e[b][voigt[k][1]];
    }
  }
}

struct Known {
  int dim, front;
  double angle;
  TipField field;
  std::string units, faces, more;
  friend void PrintTo(const Known &k, std::ostream *out)
  {
    *out << k.dim << "d, front " << k.front << ", angle " << k.angle << ", units " << k.units;
  }
};

// Each mode, both, and a stress along the crack, at any angle, along each axis in space, in other
// units, of thin plates in plane stress; the tip is a variable, and the circle goes over periodic
// faces
PARAMETER_TEST(KnownFields, AreFound, Known,
               Values(Known{2, 2, 0.0, {2e-3, 0, 0}, "lj", "f f p", ""},
                      Known{2, 2, 0.0, {0, 2e-3, 1e-3}, "lj", "f f p", ""},
                      Known{2, 2, 30.0, {2e-3, -1e-3, 1e-3}, "lj", "f f p", ""},
                      Known{2, 2, 180.0, {1e-3, 2e-3, 0}, "metal", "p p p", ""},
                      Known{2, 2, -115.0, {1e-3, 2e-3, 0}, "real", "p p p", ""},
                      Known{3, 2, 70.0, {2e-3, 1e-3, 1e-3}, "si", "f f p", ""},
                      Known{3, 0, 30.0, {2e-3, 1e-3, 0}, "lj", "f f f", "front x thickness 2"},
                      Known{3, 1, 20.0, {1e-3, 2e-3, 0}, "lj", "p p p", "front y"},
                      Known{3, 2, 0.0, {2e-3, 1e-3, 0, true}, "lj", "f f p", "plane stress"}))
{
  const Known &k = GetParam();
  const bool is_thinner = k.faces == "f f f";    // than the box
  std::string extent;
  double tip[3] = {};
  for (int d = 0; d < 3; d++) {
    const bool along = d == k.front;
    extent += along ? (k.dim == 2 ? " -0.5 0.5" : is_thinner ? " -2 2" : " -1 1") : " -10 10";
    if (!along) tip[d] = k.faces[0] == 'p' ? 7.5 : 0.5;    // between two rows of points
  }
  tip[(k.front + 1) % 3] -= 0.2;
  std::string body = "region body block";
  for (int d = 0; d < 3; d++) body += d == k.front ? " -1 1" : " -10 10";
  if (k.dim == 2) body = "region body block -10 10 -10 10 INF INF";
  const Axes e = axes_of(k.front, k.angle);
  const auto vector = [&](const double *v) {
    return strprintf(k.dim == 2 ? " %.10f %.10f" : " %.10f %.10f %.10f", v[0], v[1], v[2]);
  };
  std::string at = vector(tip);
  at.replace(1, at.find(' ', 1) - 1, "v_x");
  Scene run(space(k.units, k.faces, extent, 1, 0.5, k.dim) + body + "\nfix grid all mpm 1.0\n" +
            "create_points 1 region body ppc 2\nfix m all mpm/material " + ELASTIC + "\n" +
            strprintf("variable x equal %.10f\n", tip[0]) + "compute J all mpm/jintegral tip" + at +
            " direction" + vector(e[0].data()) + " radius 3 9 " + k.more + "\nrun 0\n");
  set_field(run, k.field, tip, e);
  const Found now = found(run);
  const double J = k.field.J() / run.lmp->force->nktv2p;
  EXPECT_NEAR(now.J, J, 0.004 * J);
  EXPECT_NEAR(now.K1, k.field.K1, 1e-5);
  EXPECT_NEAR(now.K2, k.field.K2, 1e-5);
  EXPECT_NEAR(now.filled, 1.0, 0.01);
}

// What one half of the points gives is doubled
TEST(HalfFields, AreDoubled)
{
  const double tip[3] = {0.3, 0.5, 0.0};
  const Axes e = axes_of(2, 0.0);
  Scene run(plane("lj", "f f", "-10 10 -10 10") + body("box", ELASTIC) +
            "region up block INF INF 0.5 INF INF INF\nregion down block INF INF INF 0.5 INF INF\n"
            "group up region up\ngroup down region down\nrun 0\n");
  for (const std::string half : {"up", "down"})
    for (const std::string kind : {"yes", "skew"})
      run.commands("compute " + half + kind + " " + half +
                   " mpm/jintegral tip 0.3 0.5 direction 1 0 radius 3 9 symmetric " + kind + "\n");
  run.commands("run 0\n");
  for (const std::string half : {"up", "down"}) {
    set_field(run, {2e-3, 0, 0}, tip, e);
    const Found opens = found(run, half + "yes");
    EXPECT_NEAR(opens.K(), 2e-3, 5e-6);
    EXPECT_NEAR(opens.K1, 2e-3, 1e-5);
    EXPECT_EQ(opens.K2, 0.0);
    EXPECT_NEAR(opens.filled, 1.0, 0.01);
    set_field(run, {0, 2e-3, 0}, tip, e);
    const Found slides = found(run, half + "skew");
    EXPECT_NEAR(slides.K(), 2e-3, 5e-6);
    EXPECT_EQ(slides.K1, 0.0);
    EXPECT_NEAR(slides.K2, 2e-3, 1e-5);
  }
}

// ---------------------------------------------------------------------- bodies in equilibrium

/** The upper half of a strip of width 1 and height 2 with an edge crack, under a small stress. The
 *  crack ends in a node: those ahead of it are held, so that it has no width. */
struct HalfStrip {
  int n = 20;    ///< cells in its width
  double a = 0.5;
  std::string stress = "0.01", law = ELASTIC, load, wall = "region lig slip", options;

  std::string scene() const
  {
    const std::string top = "fix load all mpm/traction region top traction 0 " + stress + " 0\n";
    return replaced(
        R"(units lj
dimension 2
boundary f f p
atom_style mpm
variable h equal 1.0/CELLS
neighbor $(0.5*v_h) bin
region box block -0.2 $(1+v_h) 0 $(1.2+2*v_h) $(-0.5*v_h) $(0.5*v_h)
create_box 1 box
region strip block 0 1 0 1 INF INF
fix grid all mpm ${h} frame total OPTIONS
create_points 1 region strip ppc 2
fix m all mpm/material LAW
region lig block END INF INF 0 INF INF
fix symmetry all mpm/boundary WALL
region top block INF INF INF 1 INF INF
region face block INF INF 0 INF INF INF
region crack block INF END INF INF INF INF
group crack region crack
LOAD
fix solve all mpm/implicit static solver multigrid
compute near all mpm/jintegral tip END 0 direction 1 0 radius $(2*v_h) $(4*v_h) symmetric yes
compute J all mpm/jintegral tip END 0 direction 1 0 radius $(4*v_h) $(8*v_h) symmetric yes
compute far all mpm/jintegral tip END 0 direction 1 0 radius $(2*v_h) $(8*v_h) symmetric yes
timestep 1.0
)",
        {{"LOAD", load.empty() ? top : load},
         {"CELLS", std::to_string(n)},
         {"END", strprintf("%g", a)},
         {"LAW", law},
         {"WALL", wall},
         {"OPTIONS", options}});
  }
};

/** K of handbooks, for a stress of .01. */
static double handbook(double a)
{
  return (a == 0.5 ? 2.8258 : 1.6612) * 0.01 * std::sqrt(PI * a);
}

// Half a strip, with 10 cells in its crack, has the K of handbooks, whatever the contour is
TEST(EdgeCrack, HasTheKOfHandbooks)
{
  for (const double a : {0.5, 0.3}) {
    Scene run(HalfStrip{a == 0.5 ? 20 : 30, a}.scene() + "run 2\n");
    const double K = handbook(a);
    for (const char *id : {"near", "J", "far"}) {
      const Found now = found(run, id);
      EXPECT_NEAR(now.K(), K, 0.004 * K) << id;
      EXPECT_NEAR(now.K1, K, 0.008 * K) << id;
      EXPECT_EQ(now.K2, 0.0);
      EXPECT_NEAR(now.filled, 1.0, 0.04);
    }
    EXPECT_NEAR(found(run, "near").J, found(run, "J").J, 0.008 * found(run, "J").J);
  }
}

SERIAL_TEST(EdgeCrack, HasTheKOfHandbooksOnFineLattices)
{
  for (const int n : {40, 80}) {
    Scene run(HalfStrip{n}.scene() + "run 2\n");
    for (const char *id : {"near", "J", "far"})
      EXPECT_NEAR(found(run, id).K(), handbook(0.5), 0.004 * handbook(0.5)) << n;
  }
}

// Under a dead load, bodies store what the load has lost less what the crack takes: J = d(2 U)/da.
// U of both halves is a cubic function of a, for which the rule of Simpson is exact
SERIAL_TEST(EdgeCrack, ReleasesEnergy)
{
  double J[3], U[3];
  for (int k = 0; k < 3; k++) {
    Scene run(HalfStrip{20, 0.45 + 0.05 * k}.scene() + "run 2\n");
    J[k] = found(run).J;
    U[k] = 2.0 * over_ranks(run.stored_energy());
  }
  const double released = (U[2] - U[0]) / 0.1;
  EXPECT_NEAR((J[0] + 4.0 * J[1] + J[2]) / 6.0, released, 0.012 * released);
}

// By superposition, a pressure on the faces of the crack has the K of the same stress far away
SERIAL_TEST(EdgeCrack, OpensByPressureOnItsFaces)
{
  HalfStrip strip;
  strip.load = "fix load crack mpm/traction region face traction 0 0.01 0";
  Scene run(strip.scene() + "run 2\n");
  for (const char *id : {"near", "J", "far"}) {
    const double K = handbook(0.5);
    EXPECT_NEAR(found(run, id).K(), K, 0.02 * K) << id;
    EXPECT_NEAR(found(run, id).K1, K, 0.02 * K) << id;
  }
}

// Of large strains, too: J is that of any contour, and what the potential energy loses
SERIAL_TEST(EdgeCrack, HasLargeStrains)
{
  double J[3], potential[3];
  for (int k = 0; k < 3; k++) {
    HalfStrip strip{20, 0.45 + 0.05 * k, "v_load", "density 1 neohookean 1000 0.3"};
    Scene run("variable load equal 10*step*(step<5)+50*(step>4)\n" + strip.scene() + "run 6\n");
    J[k] = found(run).J;
    EXPECT_NEAR(found(run, "near").J, J[k], 0.03 * J[k]);
    EXPECT_NEAR(found(run, "far").J, J[k], 0.006 * J[k]);
    potential[k] = run.stored_energy();
    const auto X = run.reference_positions();
    for (int i = 0; i < run.n(); i++)
      for (int d = 0; d < 2; d++)
        potential[k] -= run.lmp->atom->f[i][d] * (run.x()[i][d] - X[i][d]);
    potential[k] = 2.0 * over_ranks(potential[k]);
  }
  const double released = (potential[0] - potential[2]) / 0.1;
  EXPECT_NEAR((J[0] + 4.0 * J[1] + J[2]) / 6.0, released, 0.003 * released);
}

// There is no J where there is no crack
TEST(EdgeCrack, IsNotThere)
{
  HalfStrip strip;
  Scene cracked(strip.scene() + "run 2\n");
  strip.wall = "ylo slip";
  strip.load = "region part block INF 0.5 INF 1 INF INF\ngroup part region part\n"
               "fix load part mpm/traction region top traction 0 0.01 0";
  Scene whole(strip.scene() + "run 2\n");
  for (const char *id : {"near", "J", "far"})
    EXPECT_LT(std::fabs(found(whole, id).J), 0.005 * found(cracked, id).J) << id;
}

// Two arms that a force bends together slide on each other: a crack in mode II
SERIAL_TEST(SlidingCrack, ReleasesEnergy)
{
  double J[3], U[3];
  for (int k = 0; k < 3; k++) {
    const std::string a = std::to_string(5 + k);
    Scene run(plane("lj", "f f", "-0.5 11 0 1.5", 1, 0.1) + R"(
region arm block 0 10 0 1 INF INF
fix grid all mpm 0.166666666666666667 origin 0 0 frame total
create_points 1 region arm ppc 2
fix m all mpm/material )" +
              ELASTIC + "\nregion lig block " + a + R"( INF INF 0 INF INF
region clamp block 10 INF INF INF INF INF
fix skew all mpm/boundary region lig stick velocity 0 NULL NULL
fix clamp all mpm/boundary region clamp stick
region end block 0 INF INF INF INF INF
fix load all mpm/traction region end traction 0 0.001 0
fix solve all mpm/implicit static solver multigrid
compute J all mpm/jintegral tip )" +
              a + R"( 0 direction 1 0 radius 0.5 1.0 symmetric skew
timestep 1.0
run 2
)");
    const Found now = found(run);
    EXPECT_NEAR(std::fabs(now.K2), now.K(), 0.012 * now.K());
    EXPECT_EQ(now.K1, 0.0);
    J[k] = now.J;
    U[k] = 2.0 * over_ranks(run.stored_energy());
  }
  const double released = 0.5 * (U[2] - U[0]);
  EXPECT_NEAR((J[0] + 4.0 * J[1] + J[2]) / 6.0, released, 0.003 * released);
}

// ---------------------------------------------------------------------- waves

/** A stress that is suddenly there on the top of half a body, which is twice as wide as high. At
 *  its bottom there is a crack, or nothing. */
static std::string wave(const std::string &wall, const std::string &more, double height)
{
  return plane("lj", "f f", strprintf("0 %g 0 %g", 2.0 * height, height + 0.2), 1, 0.05) +
      replaced(R"(
fix grid all mpm 0.1 frame total transfer flip 0.99
region strip block INF INF 0 HEIGHT INF INF
create_points 1 region strip ppc 2
fix m all mpm/material density 1 linear 1.0 0.25
region lig block HEIGHT INF INF 0 INF INF
fix symmetry all mpm/boundary WALL slip
fix sides all mpm/boundary xlo xhi slip
region top block INF INF INF HEIGHT INF INF
region left block INF 2 INF HEIGHT INF INF
group left region left
fix load all mpm/traction region top traction 0 1.0e-4 0
compute J all mpm/jintegral tip HEIGHT 0 direction 1 0 radius 0.3 0.8 symmetric yes inertia yes
compute still all mpm/jintegral tip HEIGHT 0 direction 1 0 radius 0.6 1.4 symmetric yes
compute far all mpm/jintegral tip HEIGHT 0 direction 1 0 radius 0.6 1.4 symmetric yes inertia yes
timestep 0.045
thermo 1
thermo_style custom step c_J c_far
)" + more,
               {{"HEIGHT", strprintf("%g", height)}, {"WALL", wall}});
}

// A plane wave comes to a crack: K = 4 s sqrt(c t (1 - 2 nu)/pi)/(1 - nu), twice that of a pressure
// on its faces (Freund 1990), as the symmetry doubles the stress of the wave. What is left out
// without inertia can be seen
SERIAL_TEST(Wave, HasTheKOfFreund)
{
  const double nu = 0.25, c = std::sqrt((1 - nu) / ((1 + nu) * (1 - 2 * nu)));
  Scene run(wave("region lig", "", 3));
  for (const int step : {95, 105, 115}) {
    run.commands("run " + std::to_string(step) + " upto\n");
    const double t = run.time() - 3.0 / c;
    const double K = 4e-4 * std::sqrt(c * t * (1 - 2 * nu) / PI) / (1 - nu);
    const double J = (1 - nu * nu) * K * K;
    for (const char *id : {"J", "far"}) {
      EXPECT_NEAR(found(run, id).J, J, 0.03 * J) << id << " " << step;
      EXPECT_NEAR(found(run, id).K1, K, 0.015 * K) << id << " " << step;
    }
    EXPECT_LT(found(run, "still").J, 0.95 * J);
  }
}

// There is no J without a crack, also where waves come and the tip moves
TEST(Wave, IsOfNoCrack)
{
  Scene run("variable tip equal 2+0.4*time\nvariable time equal time\n" +
            replaced(wave("ylo", "", 3), {{"load all", "load left"}, {"tip 3 0", "tip v_tip 0"}}));
  double most = 0.0, still = 0.0;
  for (int step = 60; step <= 100; step += 5) {
    run.commands("run " + std::to_string(step) + " upto\n");
    most = std::max(most, std::fabs(found(run).J));
    still = std::max(still, std::fabs(found(run, "still").J));
  }
  EXPECT_LT(most, 0.05 * still);
}

// ---------------------------------------------------------------------- runs

static const std::string PARTS = "fix even all balance 20 1.0 shift x 10 1.0\n";

static void expect_same(const Found &a, const Found &b)
{
  EXPECT_NEAR(a.J, b.J, 1e-9 * b.J);
  EXPECT_NEAR(a.K1, b.K1, 1e-9 * b.K1);
  EXPECT_NEAR(a.filled, b.filled, 1e-12);
}

TEST(Run, IsTheSameOnAnyNumberOfRanks)
{
  const std::string scene = wave("region lig", PARTS, 1.5) + "run 45\n";
  Scene alone(scene, MPI_COMM_SELF), all(scene);
  for (const char *id : {"J", "far"}) expect_same(found(all, id), found(alone, id));
}

TEST(Run, GoesOnAfterARestart)
{
  const ScratchFile file("restart");
  const std::string scene = wave("region lig", PARTS, 1.5);
  Scene run(scene + "run 40\nwrite_restart " + file.name + "\nrun 5\n");
  Scene again("read_restart " + file.name + "\n" + lines_again(scene, {"thermo"}) + "run 5\n");
  for (const char *id : {"J", "far"}) expect_same(found(again, id), found(run, id));
}

// No bit of a run depends on whether somebody looks at it
TEST(Run, IsTheSameWithoutTheCompute)
{
  std::vector<double> states[2];
  for (const bool with : {false, true}) {
    Scene run(wave("region lig", "", 1.5) + (with ? "" : "thermo_style one\n") + "run 20\n");
    for (const auto &state : run.gather())
      states[with].insert(states[with].end(), state.stress, state.stress + 6);
  }
  EXPECT_EQ(states[0], states[1]);
}

// Bodies of two fix mpm, which both have points around the tip, and a group
TEST(Run, HasSeveralBodies)
{
  const double tip[3] = {0.3, 0.0, 0.0};
  const std::string two = fields(
      {{"a", "block -10 10 0 10 INF INF"}, {"b", "block -10 10 -10 0 INF INF", "0.5 origin 0 0"}});
  Scene run(plane("lj", "f f", "-10 10 -10 10", 2) + two + "fix m all mpm/material " + ELASTIC +
            "\ncompute J all mpm/jintegral tip 0.3 0 direction 1 0 radius 3 9\n"
            "compute a a mpm/jintegral tip 0.3 0 direction 1 0 radius 3 9\nrun 0\n");
  set_field(run, {2e-3, 1e-3, 0}, tip, axes_of(2, 0.0));
  EXPECT_NEAR(found(run).K1, 2e-3, 1e-5);
  EXPECT_NEAR(found(run).K2, 1e-3, 1e-5);
  EXPECT_NEAR(found(run, "a").filled, 0.5, 0.01);
  // the first radius has to be two spacings of the coarser lattice
  EXPECT_THAT(run.error("uncompute J\ncompute J all mpm/jintegral tip 0.3 0 direction 1 0 "
                        "radius 1.5 9\nthermo_style custom step c_J\nrun 0\n"),
              HasSubstr("less than two node spacings of 1,"));
}

// ---------------------------------------------------------------------- messages

/** A plate of 16 x 16 cells. */
static std::string plate(const std::string &law, const std::string &options = "")
{
  return plane("lj", "f f", "-8 8 -8 8") + "variable zero atom x*0\nfix grid all mpm 1.0" +
      options + "\ncreate_points 1 box ppc 2\nfix m all mpm/material density 1 " + law + "\n";
}
static const std::string CRACK = " all mpm/jintegral tip 0 0 direction 1 0 ";

/** Warnings of a run of no steps with this compute. */
static int warnings(Scene &run, const std::string &more = "radius 2 6")
{
  run.commands("compute J" + CRACK + more + "\nthermo_style custom step c_J c_J[2]\n");
  const double before = over_ranks(run.lmp->error->get_numwarn());
  run.commands("run 0\n");
  found(run);    // says nothing for a second time
  return (int) (over_ranks(run.lmp->error->get_numwarn()) - before);
}

TEST(Warnings, OfValuesWithoutAMeaning)
{
  const std::string elastic = "linear 1000 0.3", yields = "eos linear 800 strength j2 400 1.0";
  Scene good(plate(elastic));
  EXPECT_EQ(warnings(good), 0);
  // the circle goes out of the body, or is filled by half
  Scene large(plate(elastic)), half(plate(elastic));
  EXPECT_EQ(warnings(large, "radius 2 9.5"), 1);
  EXPECT_EQ(warnings(half, "radius 2 6 symmetric yes"), 1);
  // plastic strain near the tip is good, and in the domain it is not
  Scene plastic(plate(yields));
  EXPECT_EQ(warnings(plastic), 0);
  for (const double r : {1.5, 3.0}) {
    Scene yielded(plate(yields));
    auto *m = yielded.material();
    for (int i = 0; i < yielded.n(); i++)
      if (std::hypot(yielded.x()[i][0], yielded.x()[i][1]) < r)
        m->history[i][m->find_history("eplastic")] = 0.01;
    EXPECT_EQ(warnings(yielded), r > 2.0);
  }
  Scene warm(plate(elastic + " thermal conducting 1.0 300 0.5 expansion 1.0e-5") +
             "fix heat all mpm/heat\n");
  EXPECT_EQ(warnings(warm), 1);
  // a wave goes 36.7 in a time of 1
  for (const int every : {2, 5}) {
    Scene seldom(plate(elastic));
    seldom.commands("timestep 0.01\nthermo " + std::to_string(every) + "\n");
    EXPECT_EQ(warnings(seldom, "radius 2 6 inertia yes"), 0);
    const int before = seldom.lmp->error->get_numwarn();
    seldom.commands("run 10\n");
    EXPECT_EQ(over_ranks(seldom.lmp->error->get_numwarn() - before), every > 4);
  }
}

// Stress intensity factors are those of one isotropic material
TEST(Warnings, OfOtherMaterials)
{
  Scene wood(plate("orthotropic 1000 100 100 0.1 0.1 0.1 100 100 100"));
  EXPECT_EQ(warnings(wood), 1);
  EXPECT_EQ(found(wood).K1, 0.0);
  Scene water(plate("eos tait 1000 7"));
  EXPECT_EQ(warnings(water), 1);

  const std::string left = "region left block INF 0 INF INF INF INF\ngroup left region left\n"
                           "group right subtract all left\n";
  Scene two(replaced(plate("linear 1000 0.3"), "fix m all",
                     left + "fix n right mpm/material density 1 linear 1000 0.2\nfix m left"));
  EXPECT_EQ(warnings(two), 1);
  EXPECT_EQ(found(two).K1, 0.0);
}

TEST(BadInput, IsRefused)
{
  const std::string J = "compute J" + CRACK, end = "\nthermo_style custom step c_J\nrun 0";
  expect_refused(
      plate("linear 1000 0.3"),
      {
          {"compute J all mpm/jintegral", "needs the keyword tip"},
          {"compute J all mpm/jintegral direction 1 0 radius 2 4", "needs the keyword tip"},
          {"compute J all mpm/jintegral tip 0 0 radius 2 4", "needs the keyword direction"},
          {J, "needs the keyword radius"},
          {J + "radius 2", "radius"},
          {J + "radius 4 2", "must be less than the second"},
          {J + "radius 4 4", "must be less than the second"},
          {J + "radius 0 4", "radius"},
          {J + "radius two 4", "radius"},
          {J + "radius 2 4 front x", "along z in 2d"},
          {J + "radius 2 4 front w", "front"},
          {J + "radius 2 4 thickness 2", "for 3d"},
          {J + "radius 2 4 plane stress", "in 3d only"},
          {J + "radius 2 4 symmetric maybe", "symmetric"},
          {J + "radius 2 4 inertia perhaps", "inertia"},
          {J + "radius 2 4 modulus 1", "Unknown compute mpm/jintegral keyword"},
          {"compute J all mpm/jintegral tip 0 0 direction 0 0 radius 2 4", "keyword direction"},
          {"compute J all mpm/jintegral tip 0 v_none direction 1 0 radius 2 4" + end, "none"},
          {"compute J all mpm/jintegral tip 0 v_zero direction 1 0 radius 2 4" + end, "zero"},
          {"compute J all mpm/jintegral tip 9 0 direction 1 0 radius 2 4" + end, "not in the box"},
          {J + "radius 1.9 4" + end, "less than two node spacings of 1,"},
          {"group none empty\ncompute J none mpm/jintegral tip 0 0 direction 1 0 radius 2 4" + end,
           "there are no points of its group"},
          {J + "radius 2 4\nunfix m\nunfix grid\nrun 0", "looks at points of fix mpm"},
      });
  expect_refused(space("lj", "p p p", "-8 8 -8 8 -1 1") + body("box", ELASTIC),
                 {
                     {"compute J all mpm/jintegral tip 0 0 0 direction 1 0 1 radius 2 4",
                      "must be normal to the front"},
                     {"compute J all mpm/jintegral tip 0 0 0 direction 1 0 0 radius 2 8.1" + end,
                      "more than half of the periodic box along x"},
                 });
  expect_error(replaced(plate("linear 1000 0.3", " axisymmetric yes"), "-8 8 -8 8", "0 8 -8 8") +
                   J + "radius 2 4" + end + "\n",
               "use a sector in 3d");
  expect_error(plane("lj", "f f", "0 8 0 8", 2) +
                   "group s empty\ngroup w empty\nfix a s mpm 1.0\n"
                   "fix b w mpm 1.0 transfer aflip 1.0\n"
                   "region r block 1 7 0 3 INF INF\n"
                   "create_points 1 region r ppc 2 fix a group s\n"
                   "create_points 2 region r ppc 2 fix b group w share 0.5\n"
                   "fix m s mpm/material density 1.25 linear 100.0 0.3\n"
                   "fix n w mpm/material density 1.0 eos tait 100.0 7\n"
                   "fix mix all mpm/mixture a b 2.5 0.01 drag darcy 0.01\n"
                   "compute J s mpm/jintegral tip 4 1.5 direction 1 0 radius 2 3" +
                   end + "\n",
               "remove it, or fix mix");
  expect_error(plate("linear 1000 0.3") +
                   "fix p all mpm/pore 1000.0 0.5 1.0 soil m 0.4 constant 0.01\n" + J +
                   "radius 2 4" + end + "\n",
               "does not know the pressure in pores: remove it, or fix p");
  expect_error("atom_style atomic\nregion box block 0 1 0 1 0 1\ncreate_box 1 box\n"
               "compute J all mpm/jintegral tip 0 0 0 direction 1 0 0 radius 2 4\n",
               "use atom_style mpm");
}
