// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit
// mpi: 1 3

// Surfaces from files that are not quite closed, OBJ files, and mistakes in both.

#include "mesh/stl_testing.h"

#include "math_eigen.h"
#include "mesh/surface_file.h"
#include "mesh/winding.h"

#include <random>

using namespace MPM_TEST;
using MPM_NS::SurfaceMesh;
using MPM_NS::WindingNumber;

static MPM_NS::SurfaceOptions leaky()
{
  MPM_NS::SurfaceOptions options;
  options.leaky = true;
  return options;
}

static SurfaceMesh filled(const Soup &soup, const MPM_NS::SurfaceOptions &options = leaky())
{
  return SurfaceMesh(text_of(soup), "file.stl", 1.0, {0.0, 0.0, 0.0}, options);
}

static std::string message(const std::string &bytes, const std::string &name = "file.stl",
                           const MPM_NS::SurfaceOptions &options = leaky())
{
  try {
    SurfaceMesh mesh(bytes, name, 1.0, {0.0, 0.0, 0.0}, options);
  } catch (const std::exception &e) {
    return e.what();
  }
  return "";
}

// Places of the centers of cells of this size that are inside.
static int count(const SurfaceMesh &mesh, double size)
{
  int n = 0;
  const auto first = [&](int d) {
    return (int) std::floor(mesh.lo[d] / size);
  };
  const auto last = [&](int d) {
    return (int) std::ceil(mesh.hi[d] / size);
  };
  for (int i = first(0); i < last(0); i++)
    for (int j = first(1); j < last(1); j++)
      for (int k = first(2); k < last(2); k++)
        n += mesh.inside({(i + 0.5) * size, (j + 0.5) * size, (k + 0.5) * size});
  return n;
}

static void expect_known(const SurfaceMesh &mesh, const Solid &solid, double tolerance)
{
  EXPECT_NEAR(mesh.volume, solid.volume, tolerance) << solid.name;
  const double *I = mesh.inertia;
  const double matrix[3][3] = {{I[0], I[3], I[4]}, {I[3], I[1], I[5]}, {I[4], I[5], I[2]}};
  double values[3], vectors[3][3];
  MathEigen::jacobi3(matrix, values, vectors, 1);    // in increasing order
  for (int d = 0; d < 3; d++) EXPECT_NEAR(values[d], solid.moment[d], 1.0e-8) << solid.name;
}

SERIAL_TEST(Leaky, SolidsAreExactFromBothKindsOfFiles)
{
  for (const auto &solid : solids())
    for (const bool fill : {false, true})
      for (const char *name : {"solid.stl", "solid.OBJ"}) {
        const auto bytes = name[6] == 's' ? text_of(solid.soup) : obj_of(solid.soup);
        const SurfaceMesh mesh(bytes, name, 1.0, {0.0, 0.0, 0.0},
                               fill ? leaky() : MPM_NS::SurfaceOptions());
        expect_known(mesh, solid, 1.0e-8);    // the files have nine digits
        EXPECT_TRUE(mesh.holes.none());
        EXPECT_FALSE(mesh.overlaps);
        if (solid.sites && name[6] == 's') EXPECT_EQ(count(mesh, solid.size), solid.sites);
      }
}

// Triangles far away are taken together.
SERIAL_TEST(Leaky, WindingNumbersAreThoseOfAllTriangles)
{
  auto soup = both(ball(1.0, 3), torus(2.0, 0.3, 40));
  for (int k = 0; k < 700; k++) soup.pop_back();    // a piece of the torus
  std::vector<Point> corners;
  std::vector<std::array<int, 3>> triangles;
  for (const auto &t : soup) {
    const int n = (int) corners.size();
    triangles.push_back({n, n + 1, n + 2});
    for (const auto &x : t) corners.push_back(x);
  }
  const WindingNumber winding(corners, triangles);
  std::mt19937 random(4711);
  std::uniform_real_distribution<double> place(-2.5, 2.5);
  double largest = 0.0;
  for (int n = 0; n < 2000; n++) {
    const Point x = {place(random), place(random), 0.4 * place(random)};
    double sum = 0.0;
    for (const auto &t : soup) {
      double r[3][3], length[3];
      for (int c = 0; c < 3; c++) {
        for (int d = 0; d < 3; d++) r[c][d] = t[c][d] - x[d];
        length[c] = sqrt(r[c][0] * r[c][0] + r[c][1] * r[c][1] + r[c][2] * r[c][2]);
      }
      const auto product = [&](int a, int b) {
        return r[a][0] * r[b][0] + r[a][1] * r[b][1] + r[a][2] * r[b][2];
      };
      double det = 0.0;
      for (int d = 0; d < 3; d++)
        det += r[0][d] *
            (r[1][(d + 1) % 3] * r[2][(d + 2) % 3] - r[1][(d + 2) % 3] * r[2][(d + 1) % 3]);
      sum += 2.0 *
          atan2(det,
                length[0] * length[1] * length[2] + product(0, 1) * length[2] +
                    product(1, 2) * length[0] + product(2, 0) * length[1]);
    }
    largest = std::max(largest, fabs(winding(x) - sum / (4.0 * PI)));
  }
  EXPECT_LT(measured("largest error", largest), 0.01);
}

// Each of these is the same body, with something wrong that is found and put right.
SERIAL_TEST(Leaky, SmallMistakesAreRepaired)
{
  const Soup good = torus(1.0, 0.4, 32);
  const SurfaceMesh whole = filled(good);
  const int sites = count(whole, 0.07);

  Soup turned = good;
  for (std::size_t k = 0; k < turned.size(); k += 3) std::swap(turned[k][0], turned[k][2]);
  const SurfaceMesh a = filled(turned);
  EXPECT_EQ(a.holes.edges, 0u);
  EXPECT_EQ(a.holes.turned, (good.size() + 2) / 3);
  EXPECT_NEAR(a.volume, whole.volume, 1.0e-8);
  EXPECT_EQ(count(a, 0.07), sites);

  const SurfaceMesh b = filled(both(good, {good[5], good[77]}));
  EXPECT_EQ(b.holes.repeated, 2u);
  EXPECT_NEAR(b.volume, whole.volume, 1.0e-8);
  EXPECT_EQ(count(b, 0.07), sites);

  Soup missing = good;
  missing.erase(missing.begin() + 700);
  missing.erase(missing.begin() + 100);
  const SurfaceMesh c = filled(missing);
  EXPECT_EQ(c.holes.edges, 6u);
  EXPECT_EQ(c.holes.holes, 2u);
  EXPECT_EQ(c.holes.turned, 0u);
  EXPECT_NEAR(c.volume, whole.volume, 1.0e-8);    // patches are flat
  EXPECT_EQ(count(c, 0.07), sites);

  EXPECT_NEAR(filled(inverted(missing)).volume, whole.volume, 1.0e-8);
  EXPECT_THAT(message(text_of(missing), "file.stl", MPM_NS::SurfaceOptions()),
              AllOf(HasSubstr("not closed"), HasSubstr("surface leaky")));
}

// A box without a lid has a hole of a known size.
SERIAL_TEST(Leaky, HolesAreMeasured)
{
  Soup open = box({0, 0, 0}, {3, 4, 2});
  open.resize(10);    // without the upper face
  const SurfaceMesh mesh = filled(open);
  EXPECT_EQ(mesh.holes.edges, 4u);
  EXPECT_EQ(mesh.holes.holes, 1u);
  EXPECT_NEAR(mesh.holes.widest, 5.0, 1.0e-12);
  EXPECT_NEAR(mesh.holes.at[2], 2.0, 1.0e-12);
  EXPECT_NEAR(mesh.holes.area, 12.0 / 40.0, 1.0e-12);
  EXPECT_NEAR(mesh.volume, 24.0, 1.0e-12);
}

// What one part has in another one, or shares with it, counts once; walls of cavities are turned.
SERIAL_TEST(Leaky, PartsInPartsAndAcrossEachOther)
{
  const Soup outer = box({0, 0, 0}, {4, 4, 4}), inner = box({1, 1, 1}, {3, 3, 3}),
             core = box({1.5, 1.5, 1.5}, {2.5, 2.5, 2.5}), across = box({2, 1, 1}, {6, 2, 2});
  const struct {
    Soup soup;
    int sites;
    bool overlaps;
  } cases[] = {{both(outer, inverted(inner)), 512 - 64, false},
               {both(both(outer, inverted(inner)), core), 512 - 64 + 8, false},
               {both(outer, inner), 512, true},
               {both(outer, across), 512 + 16, true},
               {both(outer, inverted(both(inner, inner))), 512 - 64, true},
               {both(outer, box({5, 0, 0}, {6, 1, 1})), 512 + 8, false}};
  for (const auto &c : cases) {
    const SurfaceMesh mesh = filled(c.soup);
    EXPECT_EQ(count(mesh, 0.5), c.sites);
    // so near to the surfaces that the number is asked for, and not known from places around
    const bool hollow = c.sites % 512 && c.sites < 512;
    for (const double near : {0.02, 1.0e-6}) {
      EXPECT_FALSE(mesh.inside({0.4, 2.2, -near}));
      EXPECT_TRUE(mesh.inside({0.4, 2.2, near}));
      EXPECT_TRUE(mesh.inside({2.2, 2.3, 1.0 - near}));
      EXPECT_EQ(mesh.inside({2.2, 2.3, 1.0 + near}), !hollow);
    }
  }
  EXPECT_TRUE(filled(cases[2].soup).overlaps);
  EXPECT_TRUE(filled(cases[3].soup).overlaps);
  EXPECT_FALSE(filled(cases[1].soup).overlaps);
}

SERIAL_TEST(Leaky, ObjFiles)
{
  const auto read = [](const std::string &text) {
    return MPM_NS::read_surface(text, "x.obj");
  };
  const std::string five = "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\n";
  EXPECT_EQ(read(five + "f 1 2 3 4 5\n").size(), 9u);
  EXPECT_EQ(read(five + "f 1/1 2/2/2 \\\n3//4 # no\n").size(), 9u / 3u);
  EXPECT_EQ(read(five + "g a\ns off\nusemtl m\nvt 0 0\nvn 0 0 1\r\nf -1 -2 -3\r\n").size(), 3u);
  // an arrow that is not convex, but can be cut from one of its corners
  EXPECT_EQ(read("v 0 0 0\nv 2 1 0\nv 0 2 0\nv 0.5 1 0\nf 1 2 3 4\n").size(), 6u);
  const struct {
    std::string text, error;
  } cases[] = {
      {"", "is empty"},
      {five, "no triangles"},
      {five + "f 1 2\n", "line 6: a face needs three vertices"},
      {five + "f 1 2 6\n", "there is no vertex 6, the file has 5"},
      {five + "f 1 2 0\n", "there is no vertex 0"},
      {five + "f 1 2 -6\n", "there is no vertex -6"},
      {five + "f 1 2 x\n", "'x' is no vertex"},
      {five + "f 1 2 3.5\n", "'3.5' is no vertex"},
      {five + "f 1 2 99999999999999999999999\n", "there is no vertex"},
      {"v 0 0\n", "line 1: a vertex needs three finite"},
      {"v 0 0 nan\n", "three finite"},
      {"v 0 0 1e999\n", "three finite"},
      {"v 0 0 1x\n", "three finite"},
      {"solid x\n", "'solid' is no statement"},
      {"v 0 0 0\nv 3 0 0\nv 3 3 0\nv 2 3 0\nv 2 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nf 1 2 3 4 5 6 7 "
       "8\n",
       "not convex"},
  };
  for (const auto &c : cases) {
    std::string text;
    try {
      read(c.text);
    } catch (const std::exception &e) {
      text = e.what();
    }
    EXPECT_THAT(text, HasSubstr(c.error));
  }
}

SERIAL_TEST(Leaky, RefusesFilesThatAreCutOrHaveNothingInside)
{
  const Soup cube = box({0, 0, 0}, {1, 1, 1});
  const std::string text = text_of(cube), binary = binary_of(cube);
  std::string huge = binary, none = binary.substr(0, 84), nan = binary;
  const uint32_t most = 0xffffffff, zero = 0;
  memcpy(&huge[80], &most, 4);
  memcpy(&none[80], &zero, 4);
  const float not_a_number = NAN;
  memcpy(&nan[84 + 12], &not_a_number, 4);
  EXPECT_THAT(message(""), HasSubstr("is empty"));
  EXPECT_THAT(message(huge), HasSubstr("214748364834 bytes for the 4294967295 triangles"));
  EXPECT_THAT(message(none), HasSubstr("no triangles"));
  EXPECT_THAT(message(nan), HasSubstr("not finite"));
  EXPECT_THAT(message(binary.substr(0, 300)), HasSubstr("no STL file"));
  EXPECT_THAT(message(text.substr(0, text.size() - 30)), HasSubstr("endsolid"));
  EXPECT_THAT(message(text.substr(0, text.size() / 2)), HasSubstr("File file.stl"));
  EXPECT_THAT(message(text_of({cube[0]})), HasSubstr("no volume"));
  EXPECT_THAT(message(text_of({cube[0], cube[1]})), HasSubstr("no volume"));
  EXPECT_THAT(message(text_of(both(cube, inverted(cube)))), HasSubstr("no volume"));
  // three triangles at one edge
  const Soup wing = {{{{0, 0, 0}, {0, 0, 1}, {0.5, -1, 0.5}}}};
  EXPECT_THAT(message(text_of(both(cube, wing)), "file.stl", MPM_NS::SurfaceOptions()),
              HasSubstr("not closed"));
  EXPECT_EQ(message(text_of(both(cube, wing))), "");
}

static const std::string space_of_points = space("lj", "f f f", "-3 3 -3 3 -3 3");

// The box of 1 x 2 x 3 about (1,1,1): its center is known, and so is that of its points.
TEST(RegionLeaky, IsTurnedScaledAndMoved)
{
  Soup open = box({0, 0, 0}, {1, 2, 3});
  open.pop_back();
  const ScratchFile file("box.stl", text_of(open));
  Scene run(space_of_points + "region r mpm/mesh " + file.name +
            " 0.5 0.1 0.2 -0.3 surface leaky turn 30 1 1 1\ncreate_points 1 region r spacing 0.04\n"
            "set group all mass 1.0\ncompute c all reduce ave x y z\n"
            "thermo_style custom step c_c[1]\nrun 0\n");
  const double center[3] = {0.71132487, 0.71132487, 1.57735027}, shift[3] = {0.1, 0.2, -0.3};
  EXPECT_NEAR(run.lmp->atom->natoms * pow(0.04, 3), 0.125 * 6.0, 0.01);
  for (int d = 0; d < 3; d++)
    EXPECT_NEAR(run.evaluate("c_c[" + std::to_string(d + 1) + "]"), 0.5 * center[d] + shift[d],
                0.005);
}

TEST(RegionLeaky, SaysWhatIsWrong)
{
  Soup open = box({0, 0, 0}, {1, 2, 2});
  open.resize(11);
  std::swap(open[3][0], open[3][1]);
  const ScratchFile file("open.stl", text_of(open)),
      closed("closed.stl", text_of(box({0, 0, 0}, {1, 1, 1})));
  const std::string input = space_of_points + "region r mpm/mesh ",
                    end = " 1.0 0 0 0 surface leaky\n";
  EXPECT_EQ(times_said(input + file.name + end, "3 open edges around 1 hole, "), 1);
  EXPECT_EQ(times_said(input + file.name + end, "1 triangles turned, 0 left out"), 1);
  EXPECT_EQ(times_said(input + file.name + end, "is leaky: look at the region"), 1);
  EXPECT_EQ(times_said(input + closed.name + end, "its surface is closed"), 1);
  EXPECT_EQ(times_said(input + closed.name + end, "WARNING"), 0);
}

TEST(RegionLeaky, RefusesMistakes)
{
  const ScratchFile file("cube.stl", text_of(box({0, 0, 0}, {1, 1, 1})));
  const std::string region = "region r mpm/mesh " + file.name + " 1.0 0 0 0 ";
  expect_refused(space_of_points,
                 {{region + "surface open", "open"},
                  {region + "turn 30 0 0 0", "axis"},
                  {region + "turn 30 0 0", "turn"},
                  {region + "side out surface leaky", "must come before the keyword side"},
                  {region + "holes fill", "holes"}});
  expect_refused(space_of_points + region + "surface leaky\nfix g all mpm 0.5\n" +
                     "create_points 1 region r ppc 2\n"
                     "fix m all mpm/material density 1.0 neohookean 20.0 0.3\n",
                 {{"fix w all mpm/boundary region r slip\nrun 0", "surface leaky"},
                  {"fix b all mpm/rigid r density 1.0 slip\nrun 0", "surface leaky"}});
}
