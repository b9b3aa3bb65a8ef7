// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: smoke unit
// mpi: 1 2

// Closed surfaces of triangles, the region that they bound, and surfaces from files that are not
// quite closed, OBJ files, and mistakes in both.

#include "math_eigen.h"
#include "mesh/stl_testing.h"
#include "mesh/surface_file.h"
#include "mesh/surface_points.h"
#include "mesh/winding.h"

#include <random>

using namespace MPM_TEST;
using MPM_NS::SurfaceMesh;
using MPM_NS::WindingNumber;

TEST(SurfaceMesh, BoxHasExactDistances)
{
  const Point lo = {-1.0, 0.5, 2.0}, hi = {1.0, 2.0, 2.75};
  for (const bool binary : {false, true})
    for (const bool inward : {false, true}) {
      Soup soup = box(lo, hi);
      if (inward)
        for (auto &t : soup) std::swap(t[1], t[2]);
      const SurfaceMesh mesh(binary ? binary_of(soup) : text_of(soup), "box", 1.0, {0.0, 0.0, 0.0});
      ASSERT_EQ(mesh.size(), 12u);
      EXPECT_NEAR(mesh.volume, 2.25, 1.0e-12);
      const double mass = 2.25, a = 2.0, b = 1.5, c = 0.75;
      EXPECT_NEAR(mesh.inertia[0], mass * (b * b + c * c) / 12.0, 1.0e-12);
      EXPECT_NEAR(mesh.inertia[1], mass * (a * a + c * c) / 12.0, 1.0e-12);
      EXPECT_NEAR(mesh.inertia[2], mass * (a * a + b * b) / 12.0, 1.0e-12);
      for (int k = 3; k < 6; k++) EXPECT_NEAR(mesh.inertia[k], 0.0, 1.0e-12);
      srand(7);
      for (int n = 0; n < 3000; n++) {
        Point x, out;
        double inner = -1.0e300, outer = 0.0;
        for (int d = 0; d < 3; d++) {
          x[d] = lo[d] - 1.0 + (hi[d] - lo[d] + 2.0) * rand() / RAND_MAX;
          const double q = std::max(lo[d] - x[d], x[d] - hi[d]);
          inner = std::max(inner, q);
          outer += q > 0.0 ? q * q : 0.0;
        }
        const double exact = inner > 0.0 ? sqrt(outer) : inner;
        EXPECT_NEAR(mesh.distance(x, out), exact, 1.0e-12);
        EXPECT_EQ(mesh.inside(x), exact <= 0.0);
        const double known = mesh.bound(x);
        EXPECT_TRUE(known == 0.0 || (known * exact > 0.0 && fabs(known) <= fabs(exact) + 1.0e-12));
      }
    }
}

// A cylinder of 24 long facets, whose lengths are 20 times their widths: next to a corner the
// surface is the circle, up to the corners next to it around the axis, however far those along the
// axis are
TEST(SurfacePoints, CylinderEndsAtTheNextCorners)
{
  constexpr int N = 24;
  constexpr double ANGLE = 6.28318530717958647693 / N, LENGTH = 20.0 * ANGLE;
  const auto at = [](double k, double z) {
    return Point{std::cos(k * ANGLE), std::sin(k * ANGLE), z};
  };
  Soup soup;
  for (int k = 0; k < N; k++) {
    const int next = (k + 1) % N;
    const Point a = at(k, 0.0), b = at(next, 0.0), c = at(next, LENGTH), d = at(k, LENGTH);
    soup.push_back({a, b, c});
    soup.push_back({a, c, d});
    soup.push_back({b, a, {0.0, 0.0, 0.0}});
    soup.push_back({d, c, {0.0, 0.0, LENGTH}});
  }
  const MPM_NS::SurfacePoints points(soup, 10.0 * LENGTH);
  ASSERT_EQ(points.size(), 2u * N + 2u);
  int corners = 0;
  for (std::size_t i = 0; i < points.size(); i++) {
    if (std::hypot(points[i][0], points[i][1]) < 0.5) continue;
    const double k = std::atan2(points[i][1], points[i][0]) / ANGLE;
    corners++;
    for (const double more : {-2.0, -1.3, -0.5, 0.3, 0.9, 1.5}) {
      Point x;
      const bool near = std::fabs(more) < 1.0;
      EXPECT_EQ(points.farthest(i, at(k + more, 0.0), x), near) << k << " " << more;
      const Point exact = near ? at(k + more, points[i][2]) : points[i];
      for (int d = 0; d < 3; d++) EXPECT_NEAR(x[d], exact[d], 1e-3) << k << " " << more;
    }
  }
  EXPECT_EQ(corners, 2 * N);
}

// at equally close faces the mean of their normals, at the surface that of the face, edge or corner
TEST(SurfaceMesh, NormalsHaveTheSymmetryOfTheBody)
{
  const SurfaceMesh mesh(text_of(box({-1.0, -1.0, -2.0}, {1.0, 1.0, 2.0})), "box", 1.0,
                         {0.0, 0.0, 0.0});
  const double a = sqrt(0.5), b = sqrt(1.0 / 3.0);
  const struct {
    Point x, normal;
    double distance;
  } cases[] = {
      {{0.25, 0.5, 0.0}, {0.0, 1.0, 0.0}, -0.5}, {{0.25, -0.5, 0.0}, {0.0, -1.0, 0.0}, -0.5},
      {{0.5, 0.5, 0.25}, {a, a, 0.0}, -0.5},     {{-0.5, 0.5, -0.25}, {-a, a, 0.0}, -0.5},
      {{0.5, -0.5, 1.5}, {b, -b, b}, -0.5},      {{0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}, -1.0},
      {{0.0, 0.0, 0.25}, {0.0, 0.0, 0.0}, -1.0}, {{0.5, 0.25, 2.0}, {0.0, 0.0, 1.0}, 0.0},
      {{1.0, 0.25, 2.0}, {a, 0.0, a}, 0.0},      {{1.0, -1.0, 2.0}, {b, -b, b}, 0.0},
      {{4.0, 0.5, 6.0}, {0.6, 0.0, 0.8}, 5.0}};
  for (const auto &c : cases)
    for (const double nudge : {-1.0e-15, 0.0, 1.0e-15}) {    // rounding errors make no difference
      Point normal;
      const Point x = {c.x[0] + nudge, c.x[1], c.x[2]};
      EXPECT_NEAR(mesh.distance_and_normal(x, normal), c.distance, 1.0e-13);
      for (int d = 0; d < 3; d++)
        EXPECT_NEAR(normal[d], c.normal[d], 1.0e-13) << c.x[0] << " " << c.x[1] << " " << c.x[2];
    }
}

// in corners of a box all faces, outside of its edges the edge, never the far face of a plate
TEST(SurfaceMesh, TouchesEachPartOnce)
{
  const SurfaceMesh mesh(text_of(box({0.0, 0.0, 0.0}, {4.0, 4.0, 1.0})), "box", 1.0,
                         {0.0, 0.0, 0.0});
  ASSERT_EQ(mesh.nparts, 6);
  const struct {
    Point x;
    double cutoff;
    std::vector<std::pair<double, Point>> expected;
  } cases[] = {{{0.25, 0.2, 0.3},
                0.5,
                {{-0.2, {0.25, 0.0, 0.3}}, {-0.25, {0.0, 0.2, 0.3}}, {-0.3, {0.25, 0.2, 0.0}}}},
               {{0.25, 0.2, 0.3}, 0.28, {{-0.2, {0.25, 0.0, 0.3}}, {-0.25, {0.0, 0.2, 0.3}}}},
               {{2.0, 2.0, 0.25}, 0.9, {{-0.25, {2.0, 2.0, 0.0}}, {-0.75, {2.0, 2.0, 1.0}}}},
               {{2.0, 2.0, 1.25}, 1.5, {{0.25, {2.0, 2.0, 1.0}}}},
               {{-0.3, 2.0, 1.4}, 1.5, {{0.5, {0.0, 2.0, 1.0}}}},
               {{-0.2, -0.1, 1.2}, 1.5, {{0.3, {0.0, 0.0, 1.0}}}},
               {{-0.2, 2.0, 0.5}, 0.1, {}}};
  for (const auto &c : cases) {
    SurfaceMesh::ClosestPoint list[6];
    const int n = mesh.closest_points(c.x, c.cutoff, list, 6);
    ASSERT_EQ(n, (int) c.expected.size()) << c.x[0] << " " << c.x[1] << " " << c.x[2];
    for (int i = 0; i < n; i++) {
      EXPECT_NEAR(list[i].distance, c.expected[i].first, 1.0e-12);
      for (int d = 0; d < 3; d++) EXPECT_NEAR(list[i].point[d], c.expected[i].second[d], 1.0e-12);
      for (int j = 0; j < i; j++) EXPECT_NE(list[i].part, list[j].part);
    }
  }
  const SurfaceMesh round(text_of(torus(2.0, 0.7, 24)), "torus", 1.0, {0.0, 0.0, 0.0});
  EXPECT_EQ(round.nparts, 1);
}

// x = u + s w, y = v + s/2 w with u, v, w independent and uniform over the edges of the box
TEST(SurfaceMesh, ShearedBoxHasExactInertia)
{
  const double a = 2.0, b = 1.5, c = 0.75, s = 0.8, mass = a * b * c;
  const SurfaceMesh mesh(text_of(sheared(box({0.0, 0.0, 0.0}, {a, b, c}), s)), "box", 1.0,
                         {4.0, 5.0, 6.0});
  const double u = a * a / 12.0, v = b * b / 12.0, w = c * c / 12.0;
  const double xx = u + s * s * w, yy = v + 0.25 * s * s * w, xy = 0.5 * s * s * w;
  const double exact[] = {yy + w, xx + w, xx + yy, -xy, -s * w, -0.5 * s * w};
  EXPECT_NEAR(mesh.volume, mass, 1.0e-12);
  for (int k = 0; k < 6; k++) EXPECT_NEAR(mesh.inertia[k], mass * exact[k], 1.0e-12) << k;
  EXPECT_NEAR(mesh.center[0], 4.0 + 0.5 * (a + s * c), 1.0e-12);
  EXPECT_NEAR(mesh.center[1], 5.0 + 0.5 * (b + 0.5 * s * c), 1.0e-12);
  EXPECT_NEAR(mesh.center[2], 6.0 + 0.5 * c, 1.0e-12);
}

// a body whose center is not that of its box
TEST(SurfaceMesh, TetrahedronHasExactInertia)
{
  const double a = 2.0, b = 1.5, c = 0.75, mass = a * b * c / 6.0;
  const Point o = {0.0, 0.0, 0.0}, x = {a, 0.0, 0.0}, y = {0.0, b, 0.0}, z = {0.0, 0.0, c};
  const Soup soup = {{o, y, x}, {o, x, z}, {o, z, y}, {x, y, z}};
  const SurfaceMesh mesh(text_of(soup), "corner", 1.0, {4.0, 5.0, 6.0});
  const double u = 3.0 / 80.0, w = 1.0 / 80.0;
  const double exact[] = {u * (b * b + c * c), u * (a * a + c * c), u * (a * a + b * b),
                          w * a * b,           w * a * c,           w * b * c};
  EXPECT_NEAR(mesh.volume, mass, 1.0e-12);
  for (int k = 0; k < 6; k++) EXPECT_NEAR(mesh.inertia[k], mass * exact[k], 1.0e-12) << k;
  EXPECT_NEAR(mesh.center[0], 4.0 + 0.25 * a, 1.0e-12);
  EXPECT_NEAR(mesh.center[1], 5.0 + 0.25 * b, 1.0e-12);
  EXPECT_NEAR(mesh.center[2], 6.0 + 0.25 * c, 1.0e-12);
}

// at sharp edges, beyond which a point is behind one of the two triangles though it is outside
TEST(SurfaceMesh, SharpEdges)
{
  const double share = 3.0;
  const SurfaceMesh mesh(text_of(sheared(box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}), share)), "box", 1.0,
                         {0.0, 0.0, 0.0});
  srand(5);
  for (int n = 0; n < 3000; n++) {
    const Point x = {6.0 * rand() / RAND_MAX - 1.0, 4.0 * rand() / RAND_MAX - 0.75,
                     2.0 * rand() / RAND_MAX - 0.5};
    const double u[3] = {x[0] - share * x[2], x[1] - 0.5 * share * x[2], x[2]};
    bool inside = true;
    for (const double c : u) inside = inside && c > 0.0 && c < 1.0;
    Point out;
    EXPECT_EQ(mesh.inside(x), inside) << x[0] << " " << x[1] << " " << x[2];
    EXPECT_EQ(mesh.distance(x, out) < 0.0, inside) << x[0] << " " << x[1] << " " << x[2];
  }
}

TEST(SurfaceMesh, TorusConverges)
{
  const double R = 2.0, r = 0.7;
  double before = 0.0;
  for (const int n : {24, 48}) {
    const SurfaceMesh mesh(binary_of(torus(R, r, n)), "torus", 2.0, {1.0, -3.0, 5.0});
    const double volume = 8.0 * 2.0 * PI * PI * R * r * r;
    const double axial = volume * 4.0 * (R * R + 0.75 * r * r);
    const double error = 1.0 - mesh.volume / volume;
    if (before > 0.0) EXPECT_NEAR(before / error, 4.0, 0.1);    // second order
    before = error;
    EXPECT_NEAR(mesh.inertia[2] / axial, 1.0, 2.5 * error);
    EXPECT_NEAR(mesh.center[0], 1.0, 1.0e-11);
    EXPECT_NEAR(mesh.center[1], -3.0, 1.0e-11);
    EXPECT_NEAR(mesh.center[2], 5.0, 1.0e-11);
    srand(11);
    const double sag = 2.0 * (R + r) * (1.0 - cos(PI / n)) + 2.0 * r * (1.0 - cos(PI / n));
    for (int k = 0; k < 2000; k++) {
      Point x, out;
      for (int d = 0; d < 3; d++) x[d] = (d == 2 ? 2.0 : 7.0) * (2.0 * rand() / RAND_MAX - 1.0);
      const double exact = 2.0 * (hypot(hypot(x[0], x[1]) / 2.0 - R, x[2] / 2.0) - r);
      const double found = mesh.distance({x[0] + 1.0, x[1] - 3.0, x[2] + 5.0}, out);
      EXPECT_LT(fabs(found - exact), 1.01 * sag);
    }
  }
}

static std::string message(const std::string &bytes, const MPM_NS::SurfaceOptions &options = {})
{
  try {
    SurfaceMesh mesh(bytes, "file.stl", 1.0, {0.0, 0.0, 0.0}, options);
  } catch (const std::exception &e) {
    return e.what();
  }
  return "";
}

TEST(SurfaceMesh, ReadsTextInUpperCase)
{
  std::string text = text_of(box({0, 0, 0}, {1, 2, 3}));
  for (auto &c : text) c = (char) toupper(c);
  EXPECT_NEAR(SurfaceMesh(text, "file.stl", 1.0, {0.0, 0.0, 0.0}).volume, 6.0, 1.0e-12);
}

TEST(SurfaceMesh, RefusesWhatIsNotClosed)
{
  Soup open = box({0, 0, 0}, {1, 1, 1});
  open.pop_back();
  EXPECT_THAT(message(text_of(open)), HasSubstr("not closed"));
  Soup turned = box({0, 0, 0}, {1, 1, 1});
  std::swap(turned[3][1], turned[3][2]);
  EXPECT_THAT(message(binary_of(turned)), HasSubstr("look outward"));
  EXPECT_THAT(message("something else"), HasSubstr("no STL file"));
  EXPECT_THAT(message("solid x\nendsolid x\n"), HasSubstr("no triangles"));
  EXPECT_THAT(message("solid x\nvertex 0 0\n"), HasSubstr("three coordinates"));
  EXPECT_THAT(message("solid x\nvertex 0 0 nan\nvertex 0 0 1\nvertex 1 0 0\n"),
              HasSubstr("no three coordinates"));
  std::string cut = binary_of(box({0, 0, 0}, {1, 1, 1}));
  cut.resize(cut.size() - 7);
  EXPECT_THAT(message(cut), HasSubstr("no STL file"));
  cut.replace(0, 5, "solid");    // as some programs begin the head of a binary file
  EXPECT_THAT(message(cut), HasSubstr("684 bytes for the 12 triangles of its head, and not 677"));
  EXPECT_THAT(message(text_of({{{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}}})), HasSubstr("no triangles"));
}

TEST(SurfaceMesh, RefusesPartsWithoutInsideAndOutside)
{
  const Soup one = box({0, 0, 0}, {1, 1, 1}), next = box({1.5, 0.25, 0}, {2.5, 1.25, 1}),
             hole = inverted(box({0.2, 0.3, 0.4}, {0.6, 0.7, 0.8}));
  const Soup flat = {{{{3, 0, 0}, {4, 0, 0}, {3, 1, 0}}}, {{{3, 0, 0}, {3, 1, 0}, {4, 0, 0}}}};
  const struct {
    Soup soup;
    const char *error;
  } cases[] = {
      {flat, "without volume"},
      {both(one, flat), "without volume"},
      {both(one, inverted(next)), "looks inward"},
      {both(inverted(one), box({1.5, 0, 0}, {4.5, 1, 1})), "looks inward"},
      {both(one, inverted(hole)), "inside of another one and looks outward"},
      {both(one, box({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5})), "reach into each other"},
      {both(one, box({0.3, 0.3, -1}, {0.6, 0.6, 2})), "reach into each other"},    // no corner does
      {both(one, inverted(box({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}))), "reach into each other"},
  };
  for (const auto &c : cases) {
    EXPECT_THAT(message(text_of(c.soup)), HasSubstr(c.error));
    if (c.soup.size() > 2)    // with the closed parts in the other order
      EXPECT_THAT(message(binary_of(Soup(c.soup.rbegin(), c.soup.rend()))), HasSubstr(c.error));
  }
  // side by side, with a face in common of which each has a part
  EXPECT_EQ(message(text_of(both(one, box({1, 0.5, 0}, {2, 1.5, 1})))), "");
}

TEST(SurfaceMesh, HasCavities)
{
  const Soup room = both(box({0, 0, 0}, {4, 4, 4}), inverted(box({1, 1, 1}, {3, 3, 3})));
  const Soup ball = box({1.5, 1.5, 1.5}, {2.5, 2.5, 2.5});
  for (const bool turned : {false, true}) {
    const Soup soup = both(room, ball);
    const SurfaceMesh mesh(text_of(turned ? inverted(soup) : soup), "room", 1.0, {0, 0, 0});
    EXPECT_NEAR(mesh.volume, 64.0 - 8.0 + 1.0, 1.0e-12);
    for (const double x : {-0.5, 0.5, 1.25, 2.0})
      EXPECT_EQ(mesh.inside({x, 2.0, 2.0}), x == 0.5 || x == 2.0) << x;
  }
}

// The region does all that a block of LAMMPS does: it is filled with points, and is a wall.
static const std::string scene = space("lj", "f f f", "0 8 0 8 0 8") + R"(
fix grid all mpm 1.0
REGIONS
create_points 1 region body ppc 2
fix m all mpm/material density 1.0 neohookean 20.0 0.3
velocity all set 0 0 -0.5
fix w1 all mpm/boundary region wall slip
fix w2 all mpm/boundary region tool stick
timestep 0.02
run 150
)";

TEST(RegionMesh, ActsLikeABlock)
{
  // with corners off the lattice and off the points, where single precision does not matter
  const ScratchFile body("body.stl", text_of(box({0.51, 0.51, 1.51}, {1.51, 1.51, 2.51}))),
      wall("wall.stl", binary_of(box({0.0, 0.0, -1.0}, {8.0, 8.0, 2.25}))),
      tool("tool.stl", text_of(box({3.0, 3.0, 6.25}, {5.0, 5.0, 7.25})));
  const std::string motion = "move NULL NULL v_z";
  Scene block, mesh;
  const std::string z = "variable z equal -0.2*step*dt\n";
  block.commands(replaced(scene, "REGIONS",
                          z +
                              "region body block 2.04 6.04 2.04 6.04 3.04 7.04\n"
                              "region wall block 0 8 0 8 -1 2.25\n"
                              "region tool block 3 5 3 5 6.25 7.25 " +
                              motion + "\n"));
  mesh.commands(replaced(scene, "REGIONS",
                         z + "region body mpm/mesh " + body.name + " 4.0 0 0 -3.0\n" +
                             "region wall mpm/mesh " + wall.name + " 1.0 0 0 0\n" +
                             "region tool mpm/mesh " + tool.name + " 1.0 0 0 0 " + motion + "\n"));
  EXPECT_LT(difference(block.gather(), mesh.gather()), 1.0e-10);
  EXPECT_NEAR(mesh.evaluate("f_w1[3]"), block.evaluate("f_w1[3]"),
              1.0e-10 * fabs(block.evaluate("f_w1[3]")));
  EXPECT_GT(fabs(block.evaluate("f_w1[3]")), 0.1);
}

// Grains that fall into a corner of three walls, and into an edge with friction and its history.
// (With history and three walls at once, fix wall/gran/region takes the history of one wall for
// another when they are touched in another order than the region lists them.)
TEST(RegionMesh, HoldsGrainsLikeABlock)
{
  const ScratchFile room("room.stl", text_of(box({1.0, 1.0, 1.0}, {9.0, 9.0, 9.0})));
  const std::string text = R"(
units lj
boundary f f f
atom_style sphere
comm_modify vel yes
region box block 0 10 0 10 0 10
create_box 1 box
REGION
region seeds block 1.5 3 3.5 5 1.5 3
lattice sc 1.1
create_atoms 1 region seeds
set group all diameter 1.0 density 1.0
velocity all create 0.5 4711 loop geom
pair_style granular
pair_coeff * * hooke 500.0 20.0 tangential linear_nohistory 1.0 0.5
fix move all nve/sphere
fix wall all wall/gran/region granular hooke 500.0 20.0 tangential FRICTION region room
fix pull all gravity 2.0 vector PULL
timestep 0.002
compute all all reduce sumsq x y z vx vy vz
thermo_style custom step atoms c_all[*]
run 1500
)";
  for (const bool history : {false, true}) {
    const auto with = [&](const std::string &region) {
      return replaced(replaced(replaced(text, "REGION", region), "PULL",
                               history ? "-0.8 0 -1" : "-0.8 -1.8 -1"),
                      "FRICTION",
                      history ? "linear_history 300.0 1.0 0.5" : "linear_nohistory 1.0 0.5");
    };
    Scene block, mesh;
    block.commands(with("region room block 1 9 1 9 1 9"));
    mesh.commands(with("region room mpm/mesh " + room.name + " 1.0 0 0 0"));
    EXPECT_EQ(mesh.evaluate("atoms"), 8);
    for (int k = 1; k <= 6; k++) {
      const std::string sum = "c_all[" + std::to_string(k) + "]";
      const double expected = block.evaluate(sum);
      EXPECT_NEAR(mesh.evaluate(sum), expected, 1.0e-12 * expected) << sum;
    }
  }
}

// What a tool takes of the angular momentum of a body is its torque over time.
SERIAL_TEST(RegionMesh, HasATorque)
{
  const ScratchFile tool("torus.stl", binary_of(torus(1.0, 0.4, 30)));
  Scene run(space("lj", "f f f", "0 10 0 10 0 10") +
            body("block 3 6 4 7 2 4", "density 1.0 neohookean 20.0 0.3", "0.5") +
            "velocity all set 0.1 0.2 1.0\nregion tool mpm/mesh " + tool.name +
            " 1.5 4.4 6.1 5.0\nfix w all mpm/boundary region tool separate friction 0.3\n"
            "timestep 0.01\n");
  double impulse[6] = {0.0};
  auto *wall = run.fix("w");
  bool first = true;
  const auto start = run.sums();
  run.each_step([&](double **) {
    for (int d = 0; d < 6 && !first; d++)
      impulse[d] += run.lmp->update->dt * wall->compute_vector(d);
    first = false;
  });
  run.commands("run 300\n");
  const auto end = run.sums();
  for (int d = 0; d < 3; d++) {
    EXPECT_NEAR(start.p[d] - end.p[d], impulse[d], 1.0e-12 * start.mass);
    EXPECT_NEAR(start.L[d] - end.L[d], impulse[3 + d], 1.0e-12 * start.mass);
  }
  EXPECT_GT(fabs(impulse[3]), 0.1 * start.mass);
}

TEST(RegionMesh, RefusesMistakes)
{
  const ScratchFile body("mistake.stl", text_of(box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}))),
      flat("flat.stl",
           text_of({{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}}}));
  expect_refused("units lj\natom_style mpm\n",
                 {{"region r mpm/mesh " + body.name + " 1.0 0 0", "region mpm/mesh"},
                  {"region r mpm/mesh " + body.name + " 0.0 0 0 0", "scale must be positive: 0.0"},
                  {"region r mpm/mesh none.stl 1.0 0 0 0", "Cannot open file none.stl"},
                  {"region r mpm/mesh " + flat.name + " 1.0 0 0 0", "without volume"}});
}

/** A plane z = slope x, two triangles over [0,8] x [0,8] that look up, or a ridge of four whose far
 *  half falls. */
static Soup hillside(double slope, bool ridge)
{
  Soup soup;
  const auto strip = [&](double from, double to, double low, double high) {
    const Point a = {from, 0.0, low}, b = {to, 0.0, high}, c = {to, 8.0, high},
                d = {from, 8.0, low};
    soup.push_back({a, b, c});
    soup.push_back({a, c, d});
  };
  strip(0.0, ridge ? 4.0 : 8.0, 0.0, (ridge ? 4.0 : 8.0) * slope);
  if (ridge) strip(4.0, 8.0, 4.0 * slope, 0.0);
  return soup;
}

static MPM_NS::SurfaceOptions open_surface()
{
  MPM_NS::SurfaceOptions options;
  options.open = true;
  return options;
}

// Behind a plane, and beyond its rim, the side is that of the plane; behind a ridge, of both
// planes.
SERIAL_TEST(OpenSurface, GoesOnBeyondItsRim)
{
  const double slope = 0.75;    // normal (-.6, 0, .8)
  for (const bool ridge : {false, true}) {
    const SurfaceMesh mesh(text_of(hillside(slope, ridge)), "hill", 1.0, {0.0, 0.0, 0.0},
                           open_surface());
    EXPECT_TRUE(mesh.open);
    EXPECT_EQ(mesh.rim.size(), ridge ? 6u : 4u);
    EXPECT_TRUE(std::isnan(mesh.volume));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-3.0, 11.0);
    int over = 0;
    for (int n = 0; n < 3000; n++) {
      const Point x = {any(random), any(random), any(random)};
      double exact = 0.8 * x[2] - 0.6 * x[0];
      if (ridge) exact = std::max(exact, 0.8 * x[2] + 0.6 * (x[0] - 8.0));
      EXPECT_EQ(mesh.inside(x), exact <= 0.0) << x[0] << " " << x[1] << " " << x[2];
      Point closest;
      const double d = mesh.distance(x, closest);
      EXPECT_EQ(d > 0.0, exact > 0.0);
      if (ridge || closest[0] < 1.0e-9 || closest[0] > 8.0 - 1.0e-9 || x[1] < 0.0 || x[1] > 8.0)
        continue;
      EXPECT_NEAR(d, exact, 1.0e-12);
      over++;
    }
    EXPECT_TRUE(ridge || over > 500);
  }
}

SERIAL_TEST(OpenSurface, RefusesTrianglesThatLookToDifferentSides)
{
  Soup soup = hillside(0.5, true);
  EXPECT_EQ(message(text_of(soup), open_surface()), "");
  EXPECT_THAT(message(text_of(soup)), AllOf(HasSubstr("not closed"), HasSubstr("surface open")));
  std::swap(soup[1][0], soup[1][1]);
  EXPECT_THAT(message(text_of(soup), open_surface()), HasSubstr("look to different sides"));
  // a closed body is one, also where it may be open
  const SurfaceMesh cube(text_of(box({0, 0, 0}, {1, 1, 1})), "cube", 1.0, {0.0, 0.0, 0.0},
                         open_surface());
  EXPECT_FALSE(cube.open);
  EXPECT_NEAR(cube.volume, 1.0, 1.0e-12);
}

// A body slides on terrain as on a plane of LAMMPS: points behind it, force, and motion.
TEST(OpenSurface, HoldsABodyLikeAPlane)
{
  const ScratchFile hill("hill.stl", text_of(hillside(0.5, false)));
  const std::string input = space("lj", "f f f", "0 8 0 8 -2 10") + R"(
fix grid all mpm 0.5
region body block 1 3 3 5 1.6 3.1
REGIONS
region start intersect 2 body air
create_points 1 region start ppc 2
fix m all mpm/material density 1.0 neohookean 100.0 0.3
fix w all mpm/boundary region ground separate friction 0.2
fix g all gravity 1.0 vector 0 0 -1
timestep 0.01
run 200
)";
  const std::string file = "mpm/mesh " + hill.name + " 1.0 0 0 0 surface open";
  Scene plane, mesh;
  plane.commands(replaced(input, "REGIONS",
                          "region ground plane 0 0 0 0.5 0 -1\nregion air plane 0 0 0 -0.5 0 1"));
  mesh.commands(
      replaced(input, "REGIONS", "region ground " + file + "\nregion air " + file + " side out"));
  EXPECT_GT(plane.gather().size(), 200u);
  EXPECT_LT(difference(plane.gather(), mesh.gather()), 1.0e-10);
  for (const char *force : {"f_w[1]", "f_w[3]"})
    EXPECT_NEAR(mesh.evaluate(force), plane.evaluate(force), 1.0e-9);
  EXPECT_LT(plane.evaluate("f_w[3]"), -0.5);
}

TEST(OpenSurface, SaysThatItEndsInTheBox)
{
  const ScratchFile hill("hill.stl", text_of(hillside(0.5, false)));
  const std::string file = "region r mpm/mesh " + hill.name + " 1.0 0 0 0 surface open\nrun 0\n",
                    ends = "ends in the box, near";
  EXPECT_EQ(times_said(space("lj", "f f f", "0 8 0 8 -2 10") + file, ends), 0);
  EXPECT_EQ(times_said(space("lj", "f f f", "0 9 0 8 -2 10") + file, ends), 1);
  expect_refused(space("lj", "f f f", "0 8 0 8 -2 10") + "region r mpm/mesh " + hill.name +
                     " 1.0 0 0 0 surface open\nfix grid all mpm 0.5\n",
                 {{"fix b all mpm/rigid r density 1.0 slip", "a wall and no body"}});
}

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
  const WindingNumber winding(soup);
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
  EXPECT_NEAR(a.volume, whole.volume, 1.0e-12);
  EXPECT_EQ(count(a, 0.07), sites);

  const SurfaceMesh b = filled(both(good, {good[5], good[77]}));
  EXPECT_EQ(b.holes.repeated, 2u);
  EXPECT_NEAR(b.volume, whole.volume, 1.0e-12);
  EXPECT_EQ(count(b, 0.07), sites);

  Soup missing = good;
  missing.erase(missing.begin() + 700);
  missing.erase(missing.begin() + 100);
  const SurfaceMesh c = filled(missing);
  EXPECT_EQ(c.holes.edges, 6u);
  EXPECT_EQ(c.holes.holes, 2u);
  EXPECT_EQ(c.holes.turned, 0u);
  EXPECT_NEAR(c.volume, whole.volume, 1.0e-12);    // patches are flat
  EXPECT_EQ(count(c, 0.07), sites);

  EXPECT_NEAR(filled(inverted(missing)).volume, whole.volume, 1.0e-12);
  EXPECT_THAT(message(text_of(missing)),
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
  EXPECT_THAT(message("", leaky()), HasSubstr("is empty"));
  EXPECT_THAT(message(huge, leaky()), HasSubstr("214748364834 bytes for the 4294967295 triangles"));
  EXPECT_THAT(message(none, leaky()), HasSubstr("no triangles"));
  EXPECT_THAT(message(nan, leaky()), HasSubstr("not finite"));
  EXPECT_THAT(message(binary.substr(0, 300), leaky()), HasSubstr("no STL file"));
  EXPECT_THAT(message(text.substr(0, text.size() - 30), leaky()), HasSubstr("endsolid"));
  EXPECT_THAT(message(text.substr(0, text.size() / 2), leaky()), HasSubstr("File file.stl"));
  EXPECT_THAT(message(text_of({cube[0]}), leaky()), HasSubstr("no volume"));
  EXPECT_THAT(message(text_of({cube[0], cube[1]}), leaky()), HasSubstr("no volume"));
  EXPECT_THAT(message(text_of(both(cube, inverted(cube))), leaky()), HasSubstr("no volume"));
  // three triangles at one edge
  const Soup wing = {{{{0, 0, 0}, {0, 0, 1}, {0.5, -1, 0.5}}}};
  EXPECT_THAT(message(text_of(both(cube, wing))), HasSubstr("not closed"));
  EXPECT_EQ(message(text_of(both(cube, wing)), leaky()), "");
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
  EXPECT_NEAR(run.lmp->atom->natoms * pow(0.04, 3), 0.125 * 6.0, 0.004);
  for (int d = 0; d < 3; d++)
    EXPECT_NEAR(run.evaluate("c_c[" + std::to_string(d + 1) + "]"), 0.5 * center[d] + shift[d],
                0.0012);
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
                 {{region + "surface full", "full"},
                  {region + "surface", "missing"},
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
