// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Fix mpm/traction: dead forces per area and pressure on the surface of bodies.

#include "mpm_lammps.h"

#include "loads/mpm_face.h"

using namespace MPM_TEST;

constexpr double E = 1e6, NU = 0.3, MU = E / (2.0 * (1.0 + NU));

/** A load T that grows to its value within 1000 steps, and rest after that. */
std::string at_rest(double load, double tolerance = 3e-5)
{
  return strprintf("variable T equal %.17g*(step<1000)*step/1000+%.17g*(step>=1000)\n", load,
                   load) +
      strprintf("fix dt all mpm/dt 0.5\nrun 1000\nfix rest all mpm/relax %g\nrun 8000\n",
                tolerance);
}

/** A quarter of a bar of length 1 and width w with free sides and a load on its end (S1). */
std::string bar(const std::string &options, double w, const std::string &load,
                const std::string &end)
{
  return space("si", "f f f", "0 2.2 0 0.8 0 0.8", 1, 0.03) + "fix grid all mpm 0.1 " + options +
      strprintf("\nregion bar block 0 1 0 %g 0 %g\n", w, w) +
      "create_points 1 region bar ppc 2\nfix m all mpm/material density 1000 neohookean 1e6 0.3\n"
      "fix walls all mpm/boundary xlo ylo zlo slip\nregion end plane 1 0 0 -1 0 0\n" +
      replaced(end, "run 1000", "fix load all mpm/traction region end " + load + "\nrun 1000");
}

/** Stretch along x in the middle third of what was a body from 0 to 1. */
double stretch(Scene &run)
{
  double sum = 0.0, n = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double X = run.reference(i)[0];
    if (X < 1.0 / 3.0 || X > 2.0 / 3.0) continue;
    sum += run.points().F[i][0];
    n += 1.0;
  }
  return sum / n;
}

double stretch_at_rest(const std::string &scene)
{
  Scene run(scene.substr(0, scene.find("variable T")));
  run.set_reference();
  run.commands(scene.substr(scene.find("variable T")));
  EXPECT_LE(run.fix("rest")->compute_scalar(), 1e-4);
  return stretch(run);
}

// Layers at any depth give all of the force, at the surface. Half a spacing below it, forces on
// nodes are the gradients of quadratic functions summed over all layers, those of a uniform stress.
TEST(Face, SharesOfLayers)
{
  for (double c = 0.0; c < 1.0; c += 0.01) {
    double force = 0.0, place = 0.0;
    for (int j = 0; j < 5; j++) {
      force += MPMFace::force_share(c + j);
      place += MPMFace::force_share(c + j) * (c + j);
    }
    EXPECT_NEAR(force, 1.0, 1e-14) << c;
    EXPECT_NEAR(place, 0.0, 1e-14) << c;
  }
  for (int node = -4; node <= 2; node++) {
    double given = 0.0, uniform = 0.0;
    for (int j = 0; j < 20; j++) {
      const double depth = j + 0.5, u = -0.5 * depth - node;    // layers are half a cell apart
      const double slope = 0.5 * (bspline(2, u + 1e-6) - bspline(2, u - 1e-6)) / 2e-6;
      given += MPMFace::force_share(depth) * bspline(2, u) + MPMFace::stress_share(depth) * slope;
      uniform += slope;
    }
    EXPECT_NEAR(given, uniform, 1e-9) << node;
  }
}

// The same of a part of a point, which is at its center, and of whole ones below it.
TEST(Face, SharesOfParts)
{
  for (double part = 0.01; part <= 1.1; part += 0.01) {
    double force = part * MPMFace::force_share_cut(0.5 * part);
    double place = 0.5 * part * force;
    for (int j = 0; j < 5; j++) {
      const double depth = part + 0.5 + j;
      force += MPMFace::force_share_cut(depth);
      place += MPMFace::force_share_cut(depth) * depth;
    }
    EXPECT_NEAR(force, 1.0, 1e-2 * std::max(0.0, part - 1.0) + 1e-14) << part;
    EXPECT_LT(std::fabs(place), 0.1) << part;
  }
  for (double depth = 0.0; depth < 3.5; depth += 0.01)
    EXPECT_NEAR(MPMFace::stress_share_cut(depth + 1e-6) - MPMFace::stress_share_cut(depth),
                -1e-6 * MPMFace::force_share_cut(depth), 1e-11)
        << depth;
}

// dead and following loads on the end of a bar, to 0.5 %
struct Load {
  const char *options;
  double width;
  bool follows;
  double stress, stretch;
  friend void PrintTo(const Load &l, std::ostream *out)
  {
    *out << l.options << " " << l.follows << " " << l.stress;
  }
};
PARAMETER_TEST(Bar, Stretches, Load,
               Values(Load{"frame total", 0.4, false, 2e5, 1.232989},
                      Load{"frame total", 0.4, true, 2e5, 1.204529},
                      Load{"frame total", 0.4, false, -2e5, .828311},
                      Load{"frame total", 0.4, true, -2e5, .809486},
                      Load{"frame total", 0.4, false, 5e5, 1.713567},
                      Load{"frame total", 0.4, true, 5e5, 1.511761},
                      Load{"frame total shape linear transfer flip 1.0", 0.2, false, -5e5, .652897},
                      Load{"frame total shape linear transfer flip 0.99", 0.4, true, -5e5, .579280},
                      Load{"", 0.4, false, 2e5, 1.232989}, Load{"", 0.4, true, 2e5, 1.204529},
                      Load{"", 0.4, false, -2e5, .828311}, Load{"", 0.4, true, -2e5, .809486}))
{
  if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  const auto &l = GetParam();
  const auto scene = bar(l.options, l.width, l.follows ? "pressure v_T" : "traction v_T 0 0",
                         at_rest(l.follows ? -l.stress : l.stress));
  EXPECT_LT(std::fabs(measured("stretch over exact - 1", stretch_at_rest(scene) / l.stretch - 1.0)),
            5e-3);
}

// where the sides do not move, both are the same; plane strain, sides are periodic
SERIAL_TEST(Bar, UniaxialStrain)
{
  for (const char *options : {"", "frame total", "shape cpdi", "scheme musl transfer flip 0.99"})
    for (const bool follows : {false, true})
      for (const auto &[stress, exact] : std::vector<std::pair<double, double>>{
               {2e5, 1.171287}, {5e5, 1.533718}, {-2e5, .869898}, {-5e5, .727958}}) {
        if (std::string(options) != "frame total" && stress == 5e5) continue;    // comes apart
        const auto scene = plane("si", "f p", "0 2.2 0 0.4", 1, 0.03) + "fix grid all mpm 0.1 " +
            options +
            "\nregion bar block 0 1 INF INF INF INF\ncreate_points 1 region bar ppc 2\n"
            "fix m all mpm/material density 1000 neohookean 1e6 0.3\n"
            "fix walls all mpm/boundary xlo slip\nregion end plane 1 0 0 -1 0 0\n" +
            replaced(at_rest(follows ? -stress : stress), "run 1000",
                     std::string("fix load all mpm/traction region end ") +
                         (follows ? "pressure v_T" : "traction v_T 0 0") + "\nrun 1000");
        EXPECT_NEAR(stretch_at_rest(scene) / exact, 1.0, 5e-3)
            << options << " " << follows << " " << stress;
      }
}

// resultant and moment of the traction on the face, wherever layers of points are below it
SERIAL_TEST(Face, ResultantAndMoment)
{
  for (const double off : {0.0, 0.013, -0.02}) {
    Scene run(space("si", "f f f", "-1 2 -1 2 -1 2", 1, 0.03) +
              "region body block 0 0.8 -0.1 0.5 0.3 0.7\nfix grid all mpm 0.1\n"
              "create_points 1 region body ppc 2\nfix m all mpm/material density 1 linear 1 0.3\n" +
              strprintf("region top plane 0 %.17g 0 0 -1 0\n", 0.5 + off) +
              "fix load all mpm/traction region top traction 3 -5 7 pressure 11\ntimestep 1e-6\n"
              "run 0\n");
    const double f[3] = {3.0, -16.0, 7.0}, x[3] = {0.4, 0.5 + off, 0.5}, A = 0.32;
    const double exact[7] = {A * f[0],
                             A * f[1],
                             A * f[2],
                             A,
                             A * (x[1] * f[2] - x[2] * f[1]),
                             A * (x[2] * f[0] - x[0] * f[2]),
                             A * (x[0] * f[1] - x[1] * f[0])};
    const double *const values = run.fix_vector("load", 7);
    for (int k = 0; k < 7; k++)
      EXPECT_NEAR(values[k], exact[k], 1e-12 * A * 16.0) << off << " " << k;
    // and it is what the body gets
    double sum[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < run.n(); i++)
      for (int d = 0; d < 3; d++) sum[d] += run.lmp->atom->f[i][d];
    for (int d = 0; d < 3; d++) EXPECT_NEAR(sum[d], A * f[d], 1e-12 * A * 16.0);
    const auto before = run.sums();
    run.commands("run 1\n");
    const auto after = run.sums();
    for (int d = 0; d < 3; d++) {
      EXPECT_NEAR((after.p[d] - before.p[d]) / 1e-6, A * f[d], 1e-12 * A * 16.0);
      EXPECT_NEAR((after.L[d] - before.L[d]) / 1e-6, exact[4 + d], 1e-12 * A * 16.0);
    }
  }
}

// a face of a block open elsewhere, a surface of triangles, points that have an area together
SERIAL_TEST(Face, OtherSurfaces)
{
  std::string cube = "solid cube\n";
  const double corner[8][3] = {{0, 0, 0},  {.8, 0, 0},  {.8, .6, 0},  {0, .6, 0},
                               {0, 0, .4}, {.8, 0, .4}, {.8, .6, .4}, {0, .6, .4}};
  const int sides[12][3] = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                            {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  for (const auto &side : sides) {
    cube += "facet normal 0 0 0\nouter loop\n";
    for (const int v : side)
      cube += strprintf("vertex %g %g %g\n", corner[v][0], corner[v][1], corner[v][2]);
    cube += "endloop\nendfacet\n";
  }
  const ScratchFile file("cube.stl", cube + "endsolid cube\n");
  const std::string body = space("si", "f f f", "-1 2 -1 2 -1 2", 1, 0.03) +
      "region body block 0 0.8 0 0.6 0 0.4\nfix grid all mpm 0.1\n"
      "create_points 1 region body ppc 2\nfix m all mpm/material density 1 linear 1 0.3\n"
      "timestep 1e-6\n";
  Scene open(body +
             "region top block 0 0.8 0 0.6 0 0.4 open 1 open 2 open 3 open 5 open 6\n"
             "fix load all mpm/traction region top pressure 2\nrun 0\n");
  EXPECT_NEAR(open.fix_vector("load", 7)[1], -2.0 * 0.32, 1e-12);
  EXPECT_NEAR(open.fix_vector("load", 7)[3], 0.32, 1e-12);
  // with the middle of the face, which the group has, no edge is near
  Scene patch(body + "region patch mpm/mesh " + file.name + " 1 0 0 0" +
              "\nregion middle block 0.2 0.6 INF INF 0.15 0.25\ngroup middle region middle\n"
              "group upper id 1\nregion half block INF INF 0.3 INF INF INF\n"
              "group half region half\ngroup both intersect middle half\n"
              "fix load both mpm/traction region patch pressure 2\nrun 0\n");
  EXPECT_NEAR(patch.fix_vector("load", 7)[1], -2.0 * 0.4 * 0.1, 1e-12);
  Scene tagged(body +
               "region tip block 0.7 INF INF INF INF INF\ngroup tip region tip\n"
               "fix load tip mpm/traction points 0.24 2 0 0 traction 0 3 0 pressure -5\nrun 0\n");
  EXPECT_NEAR(tagged.fix_vector("load", 7)[0], 5.0 * 0.24, 1e-12);
  EXPECT_NEAR(tagged.fix_vector("load", 7)[1], 3.0 * 0.24, 1e-12);
}

// points that are parts of cells, at any place of a plane: area, resultant, and moment
SERIAL_TEST(Face, PartsOfCells)
{
  for (double part = 0.15; part < 1.1; part += 0.1) {
    Scene run(space("si", "f f f", "-1 2 -1 2 -1 2", 1, 0.03) +
              strprintf("region body block 0 0.8 -0.1 %.17g 0.3 0.7\n", 0.5 + 0.05 * part) +
              "fix grid all mpm 0.1\ncreate_points 1 region body ppc 2 cut yes\n"
              "fix m all mpm/material density 1 linear 1 0.3\n" +
              strprintf("region top plane 0 %.17g 0 0 -1 0\n", 0.5 + 0.05 * part) +
              "fix load all mpm/traction region top traction 0 0 7 pressure 11\n"
              "fix far all mpm/dashpot region top 2 1\ntimestep 1e-6\nrun 0\n");
    const double A = 0.32, *const values = run.fix_vector("load", 7);
    EXPECT_NEAR(values[1], -11.0 * A, 1e-3 * 11.0 * A) << part;
    EXPECT_NEAR(values[3], A, 1e-3 * A) << part;
    EXPECT_NEAR(values[4], A * ((0.5 + 0.05 * part) * 7.0 + 0.5 * 11.0), 0.01 * A * 7.0) << part;
    EXPECT_NEAR(values[6], -A * 0.4 * 11.0, 1e-3 * A * 4.4) << part;
  }
  for (const double radius : {0.6, 0.63}) {
    Scene run(space("si", "f f f", "-1 1 -1 1 -1 1", 1, 0.03) +
              strprintf("region ball sphere 0 0 0 %g\n", radius) +
              "fix grid all mpm 0.1\ncreate_points 1 region ball ppc 2 cut yes\n"
              "fix m all mpm/material density 1 linear 1 0.3\n"
              "fix load all mpm/traction region ball pressure 3\ntimestep 1e-6\nrun 0\n");
    const double area = 4.0 * PI * radius * radius;
    EXPECT_LT(std::fabs(measured("area over exact - 1", run.fix_vector("load", 7)[3] / area - 1.0)),
              0.02);
  }
  // relaxed points are in layers, though their volumes differ a little
  Scene run(plane("si", "f f", "-1 1 -1 1", 1, 0.03) +
            "region disk sphere 0.013 0.007 0 0.63\nfix grid all mpm 0.1\n"
            "create_points 1 region disk ppc 2 relax 50\n"
            "fix m all mpm/material density 1 linear 1 0.3\n"
            "fix load all mpm/traction region disk pressure 3\ntimestep 1e-6\nrun 0\n");
  const double area = run.fix_vector("load", 7)[3] / (2.0 * PI * 0.63);
  EXPECT_NEAR(measured("relaxed: area over exact", area), 1.0, 0.015);
}

// planes at an angle to the lattice of points; layers closer together than points are told
SERIAL_TEST(Face, Inclined)
{
  const auto slope = [](double angle, const std::string &more) {
    const double a = angle * PI / 180.0;
    return plane("si", "p f", "0 40 0 40", 1, 0.3) + "fix grid all mpm 1.0\n" +
        strprintf("region top plane 20 20 0 %.17g %.17g 0\n", std::sin(a), -std::cos(a)) +
        "region bottom block 5 33 5 INF INF INF\nregion body intersect 2 top bottom\n"
        "create_points 1 region body ppc 2 outside ignore\n"
        "fix m all mpm/material density 1000 linear 100 0.3\ntimestep 1e-6\n"
        "region part block 10 28 INF INF INF INF\ngroup part region part\n"
        "fix load part mpm/traction region top pressure 1" +
        more + "\nrun 0\n";
  };
  for (const double angle : {5.0, 10.0, 30.0}) {
    Scene run(slope(angle, ""));
    EXPECT_NEAR(run.fix_vector("load", 7)[3] * std::cos(angle * PI / 180.0) / 18.0, 1.0, 3e-3)
        << angle;
  }
  EXPECT_EQ(times_said(slope(26.565, ""), "areas of two layers"), 1);
  EXPECT_EQ(times_said(slope(30.0, ""), "areas of two layers"), 0);
  EXPECT_THAT(error_of(slope(45.0, "")), HasSubstr("use the keywords spacing"));
  Scene run(slope(45.0, strprintf(" spacing %.17g", 0.5 / std::sqrt(2.0))));
  EXPECT_NEAR(run.fix_vector("load", 7)[3] / (18.0 * std::sqrt(2.0)), 1.0, 1e-12);
}

// a ball: no resultant, and the area to second order in the distance of points over the radius
SERIAL_TEST(Face, Ball)
{
  Scene run(
      space("si", "f f f", "-1 1 -1 1 -1 1", 1, 0.03) +
      "region ball sphere 0 0 0 0.6\nfix grid all mpm 0.1\ncreate_points 1 region ball ppc 2\n"
      "fix m all mpm/material density 1 linear 1 0.3\n"
      "fix load all mpm/traction region ball pressure 3\ntimestep 1e-6\nrun 0\n");
  const double area = 4.0 * PI * 0.36, *const values = run.fix_vector("load", 7);
  EXPECT_LT(std::fabs(measured("area over exact - 1", values[3] / area - 1.0)), 0.02);
  for (const int k : {0, 1, 2, 4, 5, 6}) EXPECT_NEAR(values[k], 0.0, 1e-12 * 3.0 * area);
}

/** A quarter of a pipe of rubber under pressure, plane strain, its bore cut by the lattice (S2). */
static std::string rubber_pipe(const std::string &options, const std::string &load, double p)
{
  return plane("si", "f f", "0 3.2 0 3.2", 1, 0.03) + "fix grid all mpm 0.1 " + options +
      "\nregion outer cylinder z 0 0 2 INF INF\nregion bore cylinder z 0 0 1 INF INF side out\n"
      "region ring intersect 2 outer bore\ncreate_points 1 region ring ppc 2 outside ignore\n"
      "fix m all mpm/material density 1000 neohookean 1e6 0.3\n"
      "fix walls all mpm/boundary xlo ylo slip\n" +
      replaced(at_rest(p * MU), "run 1000",
               "fix load all mpm/traction region bore " + load + "\nrun 1000");
}

// benchmark S2: radii of the pipe to 1 %
SERIAL_TEST(Pipe, Widens)
{
  struct Case {
    const char *options, *load;
    double p, a, b;
  };
  for (const auto &c : first_of(
           3,
           {Case{"", "pressure v_T", 0.1, 1.081304, 2.052546},
            Case{"frame total", "pressure v_T", 0.2, 1.183161, 2.120533},
            Case{"", "pressure v_T area 1.5707963267948966", 0.2, 1.183161, 2.120533},
            Case{"", "pressure v_T area 1.5707963267948966", 0.4, 1.502870, 2.347360},
            Case{"shape cubic", "pressure v_T area 1.5707963267948966", 0.4, 1.502870, 2.347360},
            Case{"frame total", "pressure v_T area 1.5707963267948966", 0.4, 1.502870,
                 2.347360}})) {
    const auto scene = rubber_pipe(c.options, c.load, c.p);
    Scene run(scene.substr(0, scene.find("variable T")));
    run.set_reference();
    run.commands(scene.substr(scene.find("variable T")));
    // radius over the radius before, next to the surfaces: least squares
    const auto radius = [&](double low, double high, double at) {
      double s[5] = {};
      for (int i = 0; i < run.n(); i++) {
        const double *const X = run.reference(i), *const x = run.x()[i],
                            R = std::hypot(X[0], X[1]) - at;
        if (R < low || R > high) continue;
        const double r = std::hypot(x[0], x[1]), w[5] = {1.0, R, R * R, r, r * R};
        for (int k = 0; k < 5; k++) s[k] += w[k];
      }
      return (s[3] * s[2] - s[4] * s[1]) / (s[0] * s[2] - s[1] * s[1]);
    };
    EXPECT_LT(std::fabs(measured("bore", radius(0.0, 0.2, 1.0) / c.a - 1.0)), 0.01)
        << c.options << c.p;
    EXPECT_LT(std::fabs(measured("outer", radius(-0.2, 0.0, 2.0) / c.b - 1.0)), 0.01);
  }
}

// beyond a stretch of 1.5 of its bore the pipe is several percent too narrow in the updated frame
// (S2 at 0.5 of the shear modulus: 1.7955), which a warning tells
SERIAL_TEST(Pipe, StretchedTooMuchIsTold)
{
  const auto told = [](const char *frame, double p) {
    return lines_that_say(rubber_pipe(frame, "pressure v_T area 1.5707963267948966", p),
                          "the surface is stretched by a factor of 1.");
  };
  EXPECT_EQ(told("", 0.4).size(), 0);
  EXPECT_EQ(told("frame total", 0.5).size(), 0);
  const auto lines = told("", 0.5);
  ASSERT_EQ(lines.size(), 1u);
  const double stretch = std::stod(lines[0].substr(lines[0].find("factor of ") + 10));
  EXPECT_NEAR(measured("stretch", stretch), 1.65, 0.1);
}

// the largest stretch of the end of a bar, whatever its direction in the plane of the end, and also
// where the bar has been sheared along this plane
SERIAL_TEST(Face, StretchIsTheLargestOne)
{
  for (const auto &[yy, yz, zy, zz] :
       {std::array{1.8, 0.0, 0.0, 1.0}, std::array{1.0, 0.0, 0.0, 1.8},
        std::array{1.4, 0.4, 0.4, 1.4}, std::array{1.0, 0.0, 1.4, 1.0}}) {
    Scene run(bar("", 0.2, "", "") + "fix load all mpm/traction region end pressure 1\nrun 0\n");
    for (int i = 0; i < run.n(); i++) {
      double *const F = run.points().F[i];
      F[4] = yy;
      F[5] = yz;
      F[7] = zy;
      F[8] = zz;
    }
    const std::string log = log_of(run, "run 0\n"), words = "is stretched by a factor of ";
    const auto at = log.find(words);
    ASSERT_NE(at, std::string::npos) << log;
    EXPECT_NEAR(std::stod(log.substr(at + words.size())),
                0.5 * (std::hypot(yy + zz, yz - zy) + std::hypot(yy - zz, yz + zy)), 0.006);
  }
}

// pressure on all of a free body: neither force nor torque while it moves, and that pressure inside
SERIAL_TEST(Free, NoForceNoTorque)
{
  for (const char *options :
       {"", "frame total", "scheme musl", "shape cubic", "transfer aflip 1.0"}) {
    Scene run(space("si", "f f f", "-1 1 -1 1 -1 1", 1, 0.03) + "fix grid all mpm 0.1 " + options +
              "\nregion ball sphere 0.03 -0.01 0.02 0.43\ncreate_points 1 region ball ppc 2\n"
              "fix m all mpm/material density 1000 neohookean 1e6 0.3\n"
              "fix load all mpm/traction free pressure 2e5\ntimestep 2e-4\nrun 0\n");
    run.set_velocity([](const double *x, double *v) {
      v[0] = 1.0 - 2.0 * x[1] + 3.0 * x[0] * x[2];
      v[1] = 2.0 * x[0] - x[1] * x[1];
      v[2] = -1.0 + x[0] * x[1];
    });
    run.commands("run 0\n");
    const bool keeps_torque = !*options ||
        strstr(options, "cubic");    // others do not without pressure either
    const auto before = run.sums();
    run.commands("run 200\n");
    const auto after = run.sums();
    const double impulse = 2e5 * PI * 0.43 * 0.43 * 0.04;
    for (int d = 0; d < 3; d++) {
      EXPECT_NEAR(after.p[d], before.p[d], 1e-12 * impulse) << options;
      if (keeps_torque) EXPECT_NEAR(after.L[d], before.L[d], 1e-12 * impulse) << options;
    }
    double J = 0.0;
    for (int i = 0; i < run.n(); i++) J += run.points().jacobian(i) / run.n();
    EXPECT_LT(J, 0.95);
  }
}

SERIAL_TEST(Free, PressureInside)
{
  for (const char *options : {"", "frame total", "axisymmetric yes", "shape cpdi"}) {
    const bool ring = strncmp(options, "axi", 3) == 0;
    Scene run(plane("si", "f f", ring ? "0 2 -1 1" : "-1 1 -1 1", 1, 0.03) +
              "fix grid all mpm 0.1 " + options + "\nregion disk sphere 0.03 0.02 0 0.63\n" +
              "create_points 1 region disk ppc 2 outside ignore\n"
              "fix m all mpm/material density 1000 neohookean 1e6 0.3\n" +
              (ring ? "fix axis all mpm/boundary xlo slip\n" : "") +
              replaced(at_rest(1e5, 1e-7), "run 1000",
                       "fix load all mpm/traction free pressure v_T\nrun 1000"));
    double most = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const auto sigma = run.cauchy(i);
      for (const int c : {0, 1, 3}) grow(most, sigma[c] + (c < 3 ? 1e5 : 0.0));
    }
    EXPECT_LT(measured(std::string(options) + ": error of the stress", most / 1e5), 1e-3);
  }
}

// pressure of water at rest: the weight of the water in place of the body, upwards through its
// center (Archimedes), also of a part that is below the water table only; a body with the density
// of water hangs where it is, with the pressure of the water at each of its points inside
SERIAL_TEST(Free, WaterAtRest)
{
  for (const char *options : {"", "frame total", "shape cubic"}) {
    Scene run(
        space("si", "f f f", "-1 1 -1 1 -1 1", 1, 0.03) + "fix grid all mpm 0.1 " + options +
        "\nregion stone block -0.3 0.5 -0.2 0.2 -0.4 0.3\ncreate_points 1 region stone ppc 2\n"
        "fix m all mpm/material density 1000 neohookean 1e8 0.3\nvariable p atom 9810*(0.6-z)\n"
        "fix load all mpm/traction free pressure v_p\ntimestep 1e-5\nrun 0\n");
    const double *const values = run.fix_vector("load", 7), lift = 9810 * 0.8 * 0.4 * 0.7;
    const double exact[7] = {0.0, 0.0, lift, 0.0, 0.0, -0.1 * lift, 0.0};
    for (int k = 0; k < 7; k++) EXPECT_NEAR(values[k], exact[k], 1e-12 * lift) << k;
    const auto before = run.sums();
    run.commands("run 1\n");
    const auto after = run.sums();
    for (int d = 0; d < 3; d++)
      EXPECT_NEAR((after.p[d] - before.p[d]) / 1e-5, exact[d], 1e-12 * lift) << options;
  }
  Scene half(
      space("si", "f f f", "-1 1 -1 1 -1 1", 1, 0.03) +
      "fix grid all mpm 0.1\nregion stone block -0.3 0.5 -0.2 0.2 -0.4 0.3\n"
      "create_points 1 region stone ppc 2\nfix m all mpm/material density 1000 linear 1e8 0.3\n"
      "variable p atom 9810*(0.0-z)*(z<0)\nfix load all mpm/traction free pressure v_p\n"
      "timestep 1e-5\nrun 0\n");
  EXPECT_NEAR(half.fix_vector("load", 7)[2], 9810 * 0.8 * 0.4 * 0.4, 1e-12 * 9810);

  const auto hangs = plane("si", "f f", "-1 1 -1 1", 1, 0.03) +
      "fix grid all mpm 0.1\nregion disk sphere 0.03 0.02 0 0.63\n"
      "create_points 1 region disk ppc 2 outside ignore\n"
      "fix m all mpm/material density 1000 neohookean 1e7 0.3\n"
      "fix g all gravity 9.81 vector 0 -1 0\nvariable p atom v_T*(1-y)\n" +
      replaced(at_rest(9810, 1e-4), "run 1000",
               "fix load all mpm/traction free pressure v_p\nfix g all gravity v_g vector 0 -1 0\n"
               "run 1000");
  Scene run(replaced(hangs, "variable p", "variable g equal v_T/1000\nvariable p"));
  double most = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const auto sigma = run.cauchy(i);
    for (const int c : {0, 1}) grow(most, sigma[c] + 9810 * (1.0 - run.x()[i][1]));
  }
  EXPECT_LT(measured("error of the stress", most / 9810), 0.02);
}

// a straight side around an axis is a cylinder, whose deeper layers are rings of another length: a
// tube under pressure has the resultant of its side, and displacements of Lame (plane stress)
SERIAL_TEST(Tube, AroundAnAxis)
{
  for (const char *options : {"stress gradient", "frame total"}) {
    Scene run(plane("si", "f f", "0 1.2 0 0.4", 1, 0.03) +
              "fix grid all mpm 0.1 axisymmetric yes " + options +
              "\nregion tube block 0.4 1 0 0.2 INF INF\ncreate_points 1 region tube ppc 2\n" +
              "fix m all mpm/material density 1000 linear 1e6 0.3\n"
              "fix walls all mpm/boundary xlo ylo slip\nregion bore plane 0.4 0 0 1 0 0\n");
    run.set_reference();
    run.commands(replaced(at_rest(1000.0, 1e-5), "run 1000",
                          "fix load all mpm/traction region bore pressure v_T\nrun 1000"));
    const double *const load = run.fix_vector("load", 7), side = 2.0 * PI * 0.4 * 0.2;
    EXPECT_NEAR(load[0] / (1000.0 * side), 1.0, 2.5e-3);    // the bore grows by 0.16 %
    EXPECT_NEAR(load[3] / side, 1.0, 2.5e-3);
    const double a = 160.0 / 0.84, b = a;    // stress a -+ b/r^2
    double most = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const double R = run.reference(i)[0], exact = ((1.0 - NU) * a * R + (1.0 + NU) * b / R) / E;
      grow(most, (run.x()[i][0] - R) / exact - 1.0);
    }
    EXPECT_LT(measured(std::string(options) + ": error of the displacement", most), 0.02);
  }
}

// a hollow sphere under pressure around an axis: displacements at the bore (Lame) to 1 %
SERIAL_TEST(Sphere, Widens)
{
  const auto scene = plane("si", "f f", "0 2.2 0 2.2", 1, 0.03) +
      "fix grid all mpm 0.1 axisymmetric yes\nregion outer sphere 0 0 0 2\n"
      "region bore sphere 0 0 0 1 side out\nregion shell intersect 2 outer bore\n"
      "create_points 1 region shell ppc 3 outside ignore\n"
      "fix m all mpm/material density 1000 linear 1e6 0.3\n"
      "fix walls all mpm/boundary xlo ylo slip\n";
  Scene run(scene);
  run.set_reference();
  const std::string area = strprintf(" area %.17g\n", 2.0 * PI);
  run.commands(replaced(at_rest(100.0), "run 1000",
                        "fix load all mpm/traction region bore pressure v_T" + area + "run 1000"));
  EXPECT_NEAR(run.fix_vector("load", 7)[3] / (2.0 * PI), 1.0, 1e-3);
  double sum = 0.0, n = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double *const X = run.reference(i), *const x = run.x()[i], R = std::hypot(X[0], X[1]);
    if (R > 1.2) continue;
    const double exact =
        100.0 / 7.0 * ((1.0 - 2.0 * NU) * R / E + (1.0 + NU) * 8.0 / (2.0 * E * R * R));
    sum += (std::hypot(x[0], x[1]) - R) / exact;
    n += 1.0;
  }
  EXPECT_LT(std::fabs(measured("displacement over exact - 1", sum / n - 1.0)), 0.01);
}

// the ledger has the work, and closes
SERIAL_TEST(Ledger, HasTheWork)
{
  for (const char *options : {"frame total", "transfer flip 1.0"})
    for (const char *surface :
         {"region end pressure", "free pressure", "points 0.16 1 0 0 pressure"}) {
      const auto scene = bar(options, 0.4, "", "");
      Scene run(
          scene + "group end region end\nfix load all mpm/traction " + surface +
          " v_T\nvariable T equal 5e4*step/400\ncompute e all mpm/energy\nthermo_style custom "
          "step c_e\ntimestep 2.5e-4\nrun 400\n");
      const double *const e = run.compute_vector();
      const double work = run.fix("load")->compute_scalar();
      EXPECT_GT(std::fabs(work), 1.0);
      EXPECT_NEAR(e[5] / work, 1.0, 0.01) << options << surface;
      EXPECT_NEAR(e[10], 0.0, 1e-10 * std::fabs(work)) << options << surface;
    }
}

SERIAL_TEST(Units, OfForce)
{
  for (const char *units : {"si", "metal", "real", "lj"}) {
    Scene run(plane(units, "f f", "0 8 0 8", 1, 0.3) + "fix grid all mpm 1.0\n" +
              "region body block 1 7 1 7 INF INF\ncreate_points 1 region body ppc 2\n" +
              "fix m all mpm/material density 2.0 linear 100 0.3\nregion top plane 0 7 0 0 -1 0\n"
              "fix load all mpm/traction region top pressure 3\ntimestep 1e-6\nrun 0\n");
    EXPECT_NEAR(run.fix_vector("load", 7)[1] * run.lmp->force->nktv2p, -18.0, 1e-10) << units;
    run.commands("variable p atom 2*y\nfix sea all mpm/traction free pressure v_p\nrun 0\n");
    EXPECT_NEAR(run.fix_vector("sea", 7)[1] * run.lmp->force->nktv2p, -72.0, 1e-10) << units;
  }
}

// pressure turns with the body, of any law: the resultant is that of the face, and keeps its size
SERIAL_TEST(Face, Turns)
{
  for (const char *law : {"linear 1e6 0.3", "neohookean 1e6 0.3"})
    for (const char *frame : {"", "frame total"}) {
      Scene run(plane("si", "f f", "-2 2 -2 2", 1, 0.03) + "fix grid all mpm 0.1 " + frame +
                "\nregion body block -0.8 0.8 -0.4 0.4 INF INF\ncreate_points 1 region body ppc 2\n"
                "fix m all mpm/material density 1000 " +
                law +
                "\nregion end plane 0.8 0 0 -1 0 0\n"
                "fix load all mpm/traction region end pressure 10\ntimestep 1e-3\nrun 0\n");
      run.set_velocity([](const double *x, double *v) {
        v[0] = -PI * x[1];
        v[1] = PI * x[0];
      });
      run.commands("run 500\n");    // a quarter of a turn
      const double *const f = run.fix_vector("load", 7);
      EXPECT_NEAR(f[0], 0.0, 0.02 * 8.0) << law << frame;
      EXPECT_NEAR(f[1], -8.0, 0.002 * 8.0) << law << frame;
    }
}

// variables in time and place
SERIAL_TEST(Variables, InTimeAndPlace)
{
  Scene run(plane("si", "f f", "0 8 0 8", 1, 0.3) + "fix grid all mpm 1.0\n" +
            "region body block 1 7 1 7 INF INF\ncreate_points 1 region body ppc 2\n" +
            "fix m all mpm/material density 2.0 linear 1e5 0.3\nregion top plane 0 7 0 0 -1 0\n"
            "variable p atom x-1\nvariable t equal 2*step\n"
            "fix load all mpm/traction region top pressure v_p traction v_t 0 0\ntimestep 1e-6\n"
            "run 3\n");
  const double *const f = run.fix_vector("load", 7);
  EXPECT_NEAR(f[1], -18.0, 1e-8);
  EXPECT_NEAR(f[0], 6.0 * 6.0, 1e-9);    // the face turns a little
  // the center of a triangle of pressure
  EXPECT_NEAR((f[6] + 7.0 * f[0]) / f[1], 1.0 + 4.0, 0.02);
}

// one that needs a compute has it in each step, also where no output asks for it
SERIAL_TEST(Variables, OfAComputeThatIsTalliedInSomeSteps)
{
  Scene run(plane("si", "f f", "0 8 0 8", 1, 0.3) + "fix grid all mpm 1.0\n" +
            "region body block 1 7 1 7 INF INF\ncreate_points 1 region body ppc 2\n" +
            "fix m all mpm/material density 2.0 linear 1e5 0.3\nregion top plane 0 7 0 0 -1 0\n"
            "variable p equal 3+0*c_thermo_pe\nthermo 100\n"
            "fix load all mpm/traction region top pressure v_p\ntimestep 1e-6\nrun 3\n");
  EXPECT_NEAR(run.fix_vector("load", 7)[1], -18.0, 1e-8);
}

TEST(Bar, RanksAndRestart)
{
  for (const char *surface :
       {"region end pressure 3e4 traction 0 2e4 -1e4", "free pressure 2e5", "free pressure v_p"}) {
    const auto scene = replaced(bar("", 0.4, "", ""), "region end",
                                "timestep 2e-4\nvariable p atom 1e5*(1+x+y*z)\nregion end") +
        "fix load all mpm/traction " + surface + "\n";
    OnRanks run(scene, "run 60\n");
    EXPECT_LT(run.difference(), 1e-11);
    OnRanks even(scene, "run 60\n", "comm_style tiled\nfix even all balance 10 1.0 rcb\n");
    EXPECT_LT(even.difference(), 1e-11);
    const auto fixes = "neighbor 0.03 bin\n" +
        replaced(scene.substr(scene.find("fix grid")), "create_points 1 region bar ppc 2\n", "");
    Continued again(scene, 20, fixes, 30);
    EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
    EXPECT_EQ(again.whole.fix("load")->compute_scalar(), again.again.fix("load")->compute_scalar());
    for (int k = 0; k < 7; k++)
      EXPECT_EQ(again.whole.fix("load")->compute_vector(k),
                again.again.fix("load")->compute_vector(k));
  }
}

// a load is not lost in silence with the points that carry it
SERIAL_TEST(Traction, TellsOfLostPoints)
{
  for (const char *load :
       {"mpm/traction region end pressure 1", "mpm/traction points 1 1 0 0 pressure 1",
        "mpm/dashpot region end 30 20"}) {
    const auto said =
        lines_that_say(bar("", 0.4, "", "") + "fix load all " + load +
                           "\ntimestep 1e-5\nrun 1\nrun 1\nregion part block 0.9 1.1 0 0.2 0 0.2\n"
                           "delete_atoms region part\nrun 1\nrun 1\n",
                       "points of its surface are gone");
    ASSERT_EQ(said.size(), 1u) << load;
    EXPECT_NE(said[0].find(": 32 of the "), std::string::npos) << said[0];
  }
}

// a table in time (fix mpm/record): values between its rows, before, and after, and their
// integrals, also where the time step changes and after a restart
TEST(Record, TableInTime)
{
  const ScratchFile file("record.csv",
                         "time, a, b\n# none\n0.5, 1, 10\n1.0 3 10\n\n1.5;-1;\t20\r\n");
  const auto scene = plane("si", "f f", "0 8 0 8", 1, 0.3) + "fix grid all mpm 1.0\n" +
      "region body block 1 7 1 7 INF INF\ncreate_points 1 region body ppc 2\n"
      "fix m all mpm/material density 2.0 linear 1e5 0.3\n";
  const auto record = "fix r all mpm/record " + file.name;
  const std::string load = "variable t equal f_r[1]\nregion top plane 0 7 0 0 -1 0\n"
                           "fix load all mpm/traction region top traction v_t 0 0\n";
  Scene run(scene + record + "\n" + record.substr(0, 4) + "s" + record.substr(5) +
            " hold no start -0.25\n" + load + "timestep 1e-6\nthermo_style custom step time f_r\n");
  // time, values, and integrals, of the other one with hold no, which is 0.25 ahead
  const double rows[][7] = {
      {0.0, 1.0, 10.0, -0.5, -5.0, 0.0, 0.0},   {0.25, 1.0, 10.0, -0.25, -2.5, 1.0, 0.0},
      {0.5, 1.0, 10.0, 0.0, 0.0, 2.0, 0.375},   {0.75, 2.0, 10.0, 0.375, 2.5, 3.0, 1.0},
      {1.25, 1.0, 15.0, 1.5, 8.125, -1.0, 1.5}, {1.5, -1.0, 20.0, 1.5, 12.5, 0.0, 1.5},
      {2.5, -1.0, 20.0, 0.5, 32.5, 0.0, 1.5}};
  for (const auto &row : rows) {
    run.commands(strprintf("reset_timestep 0 time %.17g\nrun 0 post no\n", row[0]));
    for (int k = 0; k < 4; k++)
      EXPECT_NEAR(run.fix("r")->compute_vector(k), row[1 + k], 1e-12) << row[0] << " " << k;
    EXPECT_NEAR(run.fix("s")->compute_vector(0), row[5], 1e-12) << row[0];
    EXPECT_NEAR(run.fix("s")->compute_vector(2), row[6], 1e-12) << row[0];
    EXPECT_NEAR(run.fix_vector("load", 7)[0], 6.0 * row[1], 1e-9);
    EXPECT_EQ(run.fix("r")->compute_scalar(), run.fix("r")->compute_vector(0));
  }
  run.commands("reset_timestep 0 time 0.7\ntimestep 0.001\nrun 10\ntimestep 0.002\nrun 20\n");
  EXPECT_NEAR(run.fix("r")->compute_vector(0), 2.0, 1e-11);
  EXPECT_NEAR(run.evaluate("f_r[3]"), 0.375, 1e-12);

  // sums of time steps that are some 1e-16 before and after the rows at the ends are at these rows
  for (const double end : {0.5, 1.5})
    for (const double off : {-3e-16, 3e-16}) {
      run.commands(strprintf("reset_timestep 0 time %.17g\nrun 0 post no\n", end - 0.25 + off));
      EXPECT_NEAR(run.fix("s")->compute_vector(1), end == 0.5 ? 10.0 : 20.0, 1e-9);
    }

  for (const Mistake &m : std::vector<Mistake>{{"", "two rows"},
                                               {"1 2\n", "two rows"},
                                               {"a b\nc d\n", "line 2: 'c' is not a number"},
                                               {"1 2\n2 x\n", "line 2: 'x' is not a number"},
                                               {"1 2\n2 nan\n", "line 2: 'nan' is not finite"},
                                               {"1 2\n2 3 4\n", "line 2: there are 3 numbers"},
                                               {"1 2\n1 3\n", "line 2: times must become larger"},
                                               {"1\n2\n", "at least one value"}}) {
    const ScratchFile bad("bad.txt", m.lines);
    EXPECT_THAT(error_of(scene + "fix r all mpm/record " + bad.name + "\n"), HasSubstr(m.message));
  }
  EXPECT_THAT(error_of(scene + "fix r all mpm/record none.txt\n"), HasSubstr("cannot open"));
  EXPECT_THAT(error_of(scene + "fix r all mpm/record\n"), HasSubstr("name of a file"));
  EXPECT_THAT(error_of(scene + record + " hold maybe\n"), HasSubstr("hold"));
}

// a plane in a body is no surface: loads would act on the section, or on what goes on above a step
SERIAL_TEST(Plane, ThroughABodyIsTold)
{
  const auto told = [](const std::string &bodies, double height, const std::string &group) {
    return times_said(plane("si", "f f", "-1 2 -1 2", 1, 0.03) + "fix grid all mpm 0.1\n" + bodies +
                          "create_points 1 region body ppc 2\n" +
                          "fix m all mpm/material density 1000 linear 1e6 0.3\n" +
                          strprintf("region top plane 0 %g 0 0 -1 0\n", height) + group +
                          "fix load mine mpm/traction region top traction 0 -1e3 0\n"
                          "fix dt all mpm/dt 0.5\nrun 1\n",
                      "goes through the inside of a body");
  };
  const std::string
      block = "region body block 0 1 0 1 INF INF\n",
      step = "region wide block 0 1 0 0.5 INF INF\nregion narrow block 0 0.4 0.5 1 INF INF\n"
             "region body union 2 wide narrow\n",
      all = "group mine union all\n",
      below = "region beside block 0.4 1 INF INF INF INF\ngroup mine region beside\n";
  EXPECT_EQ(told(block, 1.0, all), 0);
  EXPECT_EQ(told(block, 0.5, all), 1);
  EXPECT_EQ(told(step, 0.5, all), 1);
  EXPECT_EQ(told(step, 0.5, below), 0);
}

// nodes of finite elements do not bear loads of this fix, on all of the surface neither
SERIAL_TEST(Traction, TellsOfNodesOfElements)
{
  const ScratchFile mesh(
      "square.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 3 3 0\n2 3.5 3 0\n3 3.5 3.5 "
      "0\n4 3 3.5 0\n$EndNodes\n$Elements\n1\n1 3 2 1 1 1 2 3 4\n$EndElements\n");
  const std::string start = plane("lj", "p p", "0 8 0 8", 2) + "fix grid all mpm 0.5\n",
                    nodes = "create_points 2 mesh " + mesh.name + "\n",
                    end =
                        "group nodes type 2\nfix m all mpm/material density 1 neohookean 100 0.3\n"
                        "fix e nodes mpm/elements " +
      mesh.name + "\nfix load all mpm/traction free pressure 1\ntimestep 1e-3\nrun 1\nrun 1\n";
  EXPECT_EQ(times_said(start + nodes +
                           "region b block 0 2 0 2 INF INF\ncreate_points 1 region b ppc 2\n" + end,
                       "4 points of group all are nodes of fix mpm/elements"),
            1);
  Scene run;
  EXPECT_THAT(run.error(start + nodes + end), HasSubstr("all points of group all are nodes"));
}

// a round bar drawn by a pressure: its updated rim curls and holds the load at 1/3 of the strain
SERIAL_TEST(Pressure, OfARimThatCurls)
{
  const auto scene = [](const char *frame) {
    return plane("si", "f f", "0 0.8 0 2.4", 1, 0.05) +
        strprintf("fix grid all mpm 0.1 axisymmetric yes %s\n", frame) +
        "region bar block 0 0.2 0 1 INF INF\nregion end plane 0 1 0 0 -1 0\n"
        "create_points 1 region bar ppc 2\nfix m all mpm/material density 1000 neohookean 1e6 0.3\n"
        "fix walls all mpm/boundary xlo ylo slip\n"
        "variable p equal -3.5e5*(time/2*(time<2)+(time>=2))\n"
        "fix load all mpm/traction region end pressure v_p\nfix dt all mpm/dt 0.5\nrun 3000\n"
        "fix rest all mpm/relax 1e-6\nrun 6000\n";
  };
  EXPECT_EQ(times_said(scene("stress mls"), "its rim has curled"), 1);
  EXPECT_EQ(times_said(scene("frame total"), "its rim has curled"), 0);
}

// The load is that of the area which is given, also if that is a slip of the pen
SERIAL_TEST(Traction, WarnsOfAnotherArea)
{
  const auto told = [](const std::string &more) {
    return times_said(bar("", 0.4, "", "") + "fix load all mpm/traction region end pressure 1 " +
                          more + "\ntimestep 1e-5\nrun 1\n",
                      "the force is that of the area which is given");
  };
  Scene run(bar("", 0.4, "", "") +
            "fix load all mpm/traction region end pressure 1\ntimestep 1e-5\nrun 1\n");
  const double area = run.fix_vector("load", 7)[3];
  EXPECT_EQ(told(""), 0);
  EXPECT_EQ(told(strprintf("area %.17g", 1.2 * area)), 0);
  EXPECT_EQ(told(strprintf("area %.17g", 10.0 * area)), 1);
  EXPECT_EQ(told(strprintf("area %.17g", 0.1 * area)), 1);
}

SERIAL_TEST(Traction, BadInput)
{
  const auto plain = bar("", 0.4, "", "");
  const std::string fix = "fix load all mpm/traction ";
  expect_refused(
      plain,
      {{fix, "missing argument"},
       {fix + "end pressure 1", "must be one of region points free"},
       {fix + "region", "missing argument"},
       {fix + "region end", "has no load: use traction, pressure, or moment"},
       {fix + "region end moment 1 2", "missing argument"},
       {fix + "region end moment 1 2 nan", "nan"},
       {fix + "free moment 1 2 3", "must not be on all of the free surface"},
       {"variable s atom x\n" + fix + "region end moment v_s 0 0", "moment is not equal-style"},
       {"variable s atom x\n" + fix + "region end moment 0 0 v_s", "moment is not equal-style"},
       {fix + "region nowhere pressure 1",
        "Region nowhere for fix mpm/traction load does not exist"},
       {fix + "region end pressure", "missing argument"},
       {fix + "region end pressure 1 pressure 2", "pressure is given twice"},
       {fix + "region end traction 1 0 0 traction 2 0 0", "traction is given twice"},
       {fix + "region end pressure nan", "nan"},
       {fix + "region end pressure v_none", "none for fix mpm/traction pressure does not exist"},
       {"variable s string one\n" + fix + "region end pressure v_s",
        "is not equal-style or atom-style"},
       {"variable a atom 1/(x-x)\n" + fix + "free pressure v_a", "Divide by 0"},
       {"variable b equal 1/(step-1)\n" + fix + "region end pressure v_b", "Divide by 0"},
       {fix + "region end traction 1 0", "missing argument"},
       {fix + "region end pressure 1 area 0", "area"},
       {fix + "region end pressure 1 spacing -1", "spacing"},
       {fix + "region end pressure 1 spacing 0.08", "are not in layers"},
       {fix + "free traction 1 0 0", "whose resultant is zero"},
       {fix + "free pressure 1 area 2", "surface of a region"},
       {fix + "points 0 1 0 0 pressure 1", "A"},
       {fix + "points 1 0 0 0 pressure 1", "length zero"},
       {fix + "region end pressure 1 depth 2", "depth"},
       {"region far plane 1.5 0 0 -1 0 0\n" + fix + "region far pressure 1", "finds no points"},
       {"group none empty\nfix load none mpm/traction points 1 1 0 0 pressure 1",
        "has no points in group none"},
       {"unfix walls\nunfix m\nunfix grid\n" + fix + "region end pressure 1", "needs a fix mpm"}},
      "timestep 1e-5\nrun 1\n");
}
