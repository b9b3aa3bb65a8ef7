// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: smoke
// mpi: 1 2

// Closed surfaces of triangles, and the region that they bound.

#include "mesh/stl_testing.h"

using namespace MPM_TEST;
using MPM_NS::SurfaceMesh;

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
    SurfaceMesh::Touch list[6];
    const int n = mesh.touches(c.x, c.cutoff, list, 6);
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
  EXPECT_NEAR(mesh.volume, mass, 1.0e-8);
  for (int k = 0; k < 6; k++) EXPECT_NEAR(mesh.inertia[k], mass * exact[k], 1.0e-8) << k;
  EXPECT_NEAR(mesh.center[0], 4.0 + 0.5 * (a + s * c), 1.0e-8);
  EXPECT_NEAR(mesh.center[1], 5.0 + 0.5 * (b + 0.5 * s * c), 1.0e-8);
  EXPECT_NEAR(mesh.center[2], 6.0 + 0.5 * c, 1.0e-8);
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
  EXPECT_NEAR(mesh.volume, mass, 1.0e-8);
  for (int k = 0; k < 6; k++) EXPECT_NEAR(mesh.inertia[k], mass * exact[k], 1.0e-8) << k;
  EXPECT_NEAR(mesh.center[0], 4.0 + 0.25 * a, 1.0e-8);
  EXPECT_NEAR(mesh.center[1], 5.0 + 0.25 * b, 1.0e-8);
  EXPECT_NEAR(mesh.center[2], 6.0 + 0.25 * c, 1.0e-8);
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
    EXPECT_NEAR(mesh.center[0], 1.0, 1.0e-5);
    EXPECT_NEAR(mesh.center[1], -3.0, 1.0e-5);
    EXPECT_NEAR(mesh.center[2], 5.0, 1.0e-5);
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

static std::string message(const std::string &bytes)
{
  try {
    SurfaceMesh mesh(bytes, "file.stl", 1.0, {0.0, 0.0, 0.0});
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
  EXPECT_LT(difference(block.gather(), mesh.gather()), 1.0e-6);
  EXPECT_NEAR(mesh.evaluate("f_w1[3]"), block.evaluate("f_w1[3]"),
              1.0e-5 * fabs(block.evaluate("f_w1[3]")));
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
      EXPECT_NEAR(mesh.evaluate(sum), expected, 1.0e-9 * expected) << sum;
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
    EXPECT_NEAR(start.p[d] - end.p[d], impulse[d], 1.0e-10 * start.mass);
    EXPECT_NEAR(start.L[d] - end.L[d], impulse[3 + d], 1.0e-9 * start.mass);
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
