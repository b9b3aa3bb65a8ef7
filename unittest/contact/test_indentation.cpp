// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// timeout: 900

// Hard tools in a metal without hardening (fix mpm/contact): a cone and a sphere go in, as bodies
// of revolution, against published finite elements and the plastic limit; a cone is drawn along
// (examples/scratch), as a body and as a region that moves (fix mpm/boundary separate). The elastic
// limit, Hertz, is in test_hertz.cpp.

#include "mesh/stl_testing.h"
#include "mpm_lammps.h"

using namespace MPM_TEST;

static constexpr double NU = 0.3;
static constexpr double SLOPE = 0.3581;    // cone of 70.3 degrees between axis and side

static double wave_speed(double E)
{
  return std::sqrt(E * (1.0 - NU) / (1.0 + NU) / (1.0 - 2.0 * NU));
}

/** Yield stress 1, density 1. */
static std::string metal(double E)
{
  return strprintf("density 1 eos linear %.17g strength j2 %.17g 1.0", E / 3.0 / (1.0 - 2.0 * NU),
                   E / 2.0 / (1.0 + NU));
}

// A block of 16 x 16 between walls without friction, and a tool with the given shape of its lower
// face, which goes in by the depth within so many transits of waves. The force is the mean over 1 %
// of that. The tool is a body, or, if one is given, a region with this face (fix mpm/boundary).
struct Indentation {
  std::vector<double> depth, force;
  std::vector<std::array<double, 2>> surface;    // of the block at the end: r, and z of its points
};

static Indentation press(const std::function<double(double)> &shape, double E, double h, double end,
                         double transits, const std::string &region = "")
{
  const double size = 16.0, time = transits * size / wave_speed(E);
  const int steps = (int) std::ceil(0.01 * time / (0.4 * h / wave_speed(E)));
  const double dt = 0.01 * time / steps;
  const std::string options = "${h} axisymmetric yes scheme musl gain ignore",
                    block = "block 0 INF INF 0 INF INF";
  const std::string body =
      fields({{"one", block}, {"two", "block 0 4 0 $(4*v_h) INF INF"}}, options) +
      strprintf("fix m2 two mpm/material density 1e9 linear %.17g %g\n", E, NU) +
      "fix c all mpm/contact F1 F2\nvariable f equal f_c[1][2]\n";
  const std::string wall = fields({{"one", block}}, options) +
      strprintf("variable y equal %.17g*time\nregion tool %s move NULL v_y NULL\n", -end / time,
                region.c_str()) +
      "fix w all mpm/boundary region tool separate\nvariable f equal f_w[2]\n";
  Scene run(strprintf("variable h equal %.17g\n", h) +
            replaced(plane("lj", "f f", "0 16 -16 4", 2), "atom_style mpm\n",
                     "atom_style mpm\natom_modify map array\nneighbor $(0.5*v_h) bin\n") +
            (region.empty() ? body : wall) + "fix m1 one mpm/material " + metal(E) + "\n" +
            "fix sides all mpm/boundary xlo xhi ylo slip\n" + strprintf("timestep %.17g\n", dt));
  std::vector<tagint> top;
  for (int i = 0; i < run.n(); i++) {
    double *const x = run.x()[i];
    if (run.lmp->atom->type[i] == 2) {
      x[1] += shape(x[0]);
      run.v()[i][1] = -end / time;
    } else if (x[1] > -0.4 * h)
      top.push_back(run.lmp->atom->tag[i]);
  }
  Indentation result;
  run.commands(strprintf("fix mean all ave/time 1 %d %d v_f\n", steps, steps));
  for (int n = 0; n < 100; n++) {
    run.commands(strprintf("run %d post no\n", steps));
    result.depth.push_back((run.time() - 0.5 * steps * dt) * end / time);
    result.force.push_back(run.evaluate("f_mean"));
  }
  for (const auto tag : top) {
    const double *const x = run.x()[run.lmp->atom->map(tag)];
    result.surface.push_back({x[0], x[1]});
  }
  std::sort(result.surface.begin(), result.surface.end());
  return result;
}

// F = C d^2. Finite elements of cones of 70.3 degrees (M. Dao et al., Acta Mater. 49, 3899 (2001),
// eq. 7, which has them within some per cent): C/Y is a polynomial in ln(E* /Y), 87.2 for E/Y =
// 250; with a hardness of 2.7 Y (M. Mata et al., J. Mater. Res. 17, 964 (2002)) this is a contact
// 1.19 times as wide as the cone at the old surface. Bodies touch at 0.1 node spacings too late:
// sqrt(F) = sqrt(C) (d - 0.1 h)
static double cone(double r)
{
  return SLOPE * r;
}

static double cone_of_finite_elements(double E)
{
  const double x = std::log(E / (1.0 - NU * NU));
  return ((-1.131 * x + 13.635) * x - 30.594) * x + 29.267;
}

TEST(Indentation, ConeLikeFiniteElements)
{
  LONG_CASE();
  const double E = 250.0, exact = cone_of_finite_elements(E);
  EXPECT_NEAR(exact, 87.2, 0.1);
  double error[2];
  for (int k = 0; k < 2; k++) {
    const double h = k ? 0.25 : 0.5;
    const auto tool = press(cone, E, h, 0.6, 6.0);
    double mean = 0.0, s[5] = {};
    for (int n = 40; n < 100; n++) {
      const double d = tool.depth[n], root = std::sqrt(tool.force[n]);
      if (n >= 80) mean += tool.force[n] / (d * d) / 20;
      s[0] += 1.0, s[1] += d, s[2] += d * d, s[3] += root, s[4] += d * root;
    }
    const double slope = (s[0] * s[4] - s[1] * s[3]) / (s[0] * s[2] - s[1] * s[1]);
    const std::string name = strprintf("depth of %.1f cells: ", 0.6 / h);
    error[k] = std::fabs(measured(name + "error of force", mean / exact - 1.0));
    if (k)
      EXPECT_LT(std::fabs(measured("error of C from its growth", slope * slope / exact - 1)), 0.05);
  }
  EXPECT_LT(error[1], 0.10);
  EXPECT_LT(error[1], error[0]);
}

// A wall that separates acts at its surface: there is no offset, and 5 % hold with few cells, too.
TEST(Indentation, ConeThatIsAWall)
{
  const double E = 250.0, exact = cone_of_finite_elements(E);
  for (const double h : first_of(1, {0.5, 0.25})) {
    const auto tool = press(cone, E, h, 0.6, 6.0, strprintf("plane 0 0 0 %g 1 0", -SLOPE));
    double mean = 0.0;
    for (int n = 80; n < 100; n++) mean += tool.force[n] / (tool.depth[n] * tool.depth[n]) / 20;
    EXPECT_NEAR(measured(strprintf("depth of %.1f cells: force/that of finite elements", 0.6 / h),
                         mean / exact),
                1.0, 0.02);
  }
}

// Full plasticity under a sphere: mean pressure of 2.8 (D. Tabor, The Hardness of Metals (1951)) to
// 3.0 Y (B. Storakers, S. Biwa, P.-L. Larsson, Int. J. Solids Struct. 34, 3061 (1997)); E* a/(Y R)
// = 440. The contact ends where points of the surface, half of their spacing (0.25 h) inside of it,
// are farther than that from the tool
TEST(Indentation, SphereAtThePlasticLimit)
{
  LONG_CASE();
  const double E = 1000.0, R = 5.0, h = 0.25, end = 0.28;
  const auto shape = [&](double r) {
    return R - std::sqrt(R * R - r * r);
  };
  const auto ball = press(shape, E, h, end, 6.0);
  double force = 0.0, gap = 0.0, a = 0.0;
  for (int n = 90; n < 100; n++) force += ball.force[n] / 10;
  int inner = 0;
  const auto distance = [&](int k) {
    return shape(ball.surface[k][0]) - end - ball.surface[k][1];
  };
  for (int k = 0; k + 1 < (int) ball.surface.size() && a == 0.0; k++) {
    const double r = ball.surface[k][0], next = ball.surface[k + 1][0];
    if (r > 0.5 && r < 1.5) gap += distance(k), inner++;
    if (r > 1.0 && distance(k + 1) > 0.25 * h)
      a = r + (next - r) * (0.25 * h - distance(k)) / (distance(k + 1) - distance(k));
  }
  gap /= inner;
  measured("distance of points from the tool, in spacings of nodes", gap / h);
  measured("radius of the contact", a);
  const double pressure = measured("mean pressure / yield stress", force / (PI * a * a));
  EXPECT_GT(pressure, 0.9 * 2.8);
  EXPECT_LT(pressure, 1.1 * 3.0);
  EXPECT_GT(gap, 0.0);         // points do not get into the tool
  EXPECT_LT(gap, 0.25 * h);    // and there is no room left
}

// Scratch: one half, a plane of symmetry. A frictionless cone that touches with its front half has
// tangential over normal force 2/pi tan(beta) (0.228) in a rigid plastic body; friction adds mu
// (F.P. Bowden, D. Tabor, The Friction and Lubrication of Solids (1950)). 20 %, as benchmarks of
// this kind ask: there is no material in front in these formulas. The volume of the groove is that
// of the ridges, less what is compressed
struct Scratch {
  double normal, tangential;    // means over the second half of the way
  double groove, ridge;         // volumes below and above the old surface
  double swept;                 // volume of the way of the cone
  double compressed;            // at most: the block under a mean pressure of the yield stress
};

/** way: in depths d. tool: its height at a distance from its axis; a: where that is d. */
static Scratch scratch(double mu, double d, double way, double a,
                       const std::function<double(double)> &tool)
{
  const double E = 250.0, v = 0.025 * wave_speed(E), dt = 0.4 / wave_speed(E);
  const double first = std::round(1.8 * a), reach = std::round(1.6 * a), deep = first;
  Scene run(
      strprintf("variable d equal %.17g\nvariable w equal %.17g\nvariable a equal %.17g\n", d, way,
                a) +
      space("lj", "f f f",
            "0 $(round(3.6*v_a+v_w*v_d)) 0 $(round(1.8*v_a)) -$(round(1.8*v_a)) "
            "$(round(3*v_d)+5)",
            2, 0.5) +
      fields({{"one", "block INF INF INF INF INF 0"},
              {"two", strprintf("block %g %g 0 %g 0 3", first - reach, first + reach, reach)}},
             "1.0 scheme musl gain ignore apart ignore") +
      "fix m1 one mpm/material " + metal(E) + "\n" +
      strprintf("fix m2 two mpm/material density 1e6 linear %.17g %g\n", E, NU) +
      strprintf("fix c all mpm/contact F1 F2 law coulomb %g\n", mu) +
      "fix sides all mpm/boundary xlo xhi ylo yhi slip\n"
      "fix floor all mpm/boundary zlo slip field F1\n" +
      strprintf("timestep %.17g\n", dt));
  const auto move = [&](double vx, double vz) {
    for (int i = 0; i < run.n(); i++) {
      if (run.lmp->atom->type[i] != 2) continue;
      run.v()[i][0] = vx;
      run.v()[i][2] = vz;
    }
  };
  for (int i = 0; i < run.n(); i++) {
    double *const x = run.x()[i];
    if (run.lmp->atom->type[i] == 2) x[2] += tool(std::hypot(x[0] - first, x[1]));
  }
  const int down = (int) std::lround(d / v / dt), steps = (int) std::lround(way * d / v / dt);
  move(0.0, -v);
  run.commands(strprintf("run %d post no\n", down));
  move(v, 0.0);
  run.commands(strprintf("run %d post no\n", steps / 2));
  Scratch s = {};
  const int samples = 20, begin = steps / 2;
  run.commands(strprintf("variable n equal f_c[1][3]\nvariable t equal f_c[1][1]\nfix mean all "
                         "ave/time 1 %d %d v_n v_t\n",
                         begin / samples, begin / samples));
  for (int k = 0; k < samples; k++) {
    run.commands(strprintf("run %d post no\n", begin / samples));
    s.normal += run.evaluate("f_mean[1]") / samples;
    s.tangential -= run.evaluate("f_mean[2]") / samples;
  }

  // heights of columns of material, one for each cell
  std::map<std::pair<int, int>, double> height;
  for (int i = 0; i < run.n(); i++) {
    const double *const x = run.x()[i];
    if (run.lmp->atom->type[i] == 1)
      height[{(int) x[0], (int) x[1]}] += run.lmp->atom->vfrac[i] * run.points().jacobian(i);
  }
  for (const auto &[at, volume] : height)
    (volume > deep ? s.ridge : s.groove) += std::fabs(volume - deep);
  s.compressed = (double) height.size() * deep / (E / 3.0 / (1.0 - 2.0 * NU));
  s.swept = PI / 6.0 * a * a * d + 0.5 * a * d * way * d;
  return s;
}

TEST(Scratch, ConeInPlasticMetal)
{
  LONG_CASE();
  const double plough = 2.0 / PI * SLOPE;
  double smooth = 0.0;    // ratio without friction
  for (const double mu : {0.0, 0.2}) {
    const auto s = scratch(mu, 1.5, 5.0, 1.5 / SLOPE, [](double r) {
      return SLOPE * r;
    });
    const std::string name = strprintf("mu = %.1f: ", mu);
    measured(name + "normal force", s.normal);
    const double ratio = measured(name + "tangential / normal force", s.tangential / s.normal);
    EXPECT_NEAR(ratio, plough + mu, 0.2 * (plough + mu));
    if (mu == 0.0) smooth = ratio;
    EXPECT_GE(ratio - smooth, 0.8 * mu);
    const double share = measured(name + "volume of groove / swept volume", s.groove / s.swept);
    EXPECT_LT(share, 1.0);
    EXPECT_GT(share,
              std::pow(1.0 - 0.25 / 1.5, 2));    // they touch within half a spacing of points
    measured(name + "volume of ridges / of groove", s.ridge / s.groove);
    EXPECT_LT(s.ridge, s.groove);
    EXPECT_GT(s.ridge, s.groove - s.compressed);
  }
}

// The same with a region as tool, which goes down by the depth and then along. All forces of the
// walls together are what the momentum of the block tells. The force on any piece of the front of
// the cone is inclined by beta + atan(mu) at most, whatever the pressure is. With the same pressure
// everywhere on the front half, and friction against the way of the cone, there is a mean
// inclination, for which benchmarks of this kind ask 20 %
struct Drawn {
  double normal, tangential;    // means over the last quarter of the time
  double error;                 // of the balance of momentum, over the impulse of the tool
};

/** With the cone in an STL file of this name, if there is one. */
static Drawn draw(double mu, double d, double way, const std::string &file = "")
{
  const double E = 250.0, v = 0.025 * wave_speed(E), dt = 0.5 / wave_speed(E);
  const int steps = (int) std::ceil((1.0 + way) * d / v / dt / 4.0);
  const double tip = 0.02 * d;
  Scene run(
      strprintf("variable d equal %.17g\nvariable w equal %.17g\n", d, way) +
      space("lj", "f f f",
            "0 $(round((8+v_w)*v_d)) 0 $(round(5*v_d)) -$(round(4*v_d)) $(round(2*v_d)+3)", 1,
            0.5) +
      fields({{"one", "block INF INF INF INF INF 0"}}, "1.0 scheme musl apart ignore") +
      "fix m1 one mpm/material " + metal(E) + "\n" +
      strprintf("timestep %.17g\nvariable s equal %.17g*step*dt\n", dt, v) + R"(
variable z equal -(v_s<v_d)*v_s-(v_s>=v_d)*v_d
variable x equal (v_s>v_d)*(v_s-v_d)
)" +
      (file.empty() ? strprintf("region tool cone z $(round(4*v_d)) 0 %.17g %.17g %.17g $(8*v_d)",
                                tip / SLOPE, 8.0 * d / SLOPE, tip)
                    : "region tool mpm/mesh " + file + " 1 $(round(4*v_d)) 0 0") +
      strprintf(
          " move v_x NULL v_z\nfix tool all mpm/boundary region tool separate friction %.17g\n",
          mu) +
      strprintf(R"(
fix sides all mpm/boundary xlo xhi ylo yhi zlo slip
variable tx equal f_tool[1]
variable tz equal f_tool[3]
variable sx equal f_sides[1]
variable sz equal f_sides[3]
fix mean all ave/time 1 %d %d v_tx v_tz v_sx v_sz
run %d post no
)",
                steps, steps, 3 * steps));
  double p[2] = {};
  const auto add_momentum = [&](double sign) {
    for (int i = 0; i < run.n(); i++) {
      p[0] += sign * run.lmp->atom->rmass[i] * run.v()[i][0];
      p[1] += sign * run.lmp->atom->rmass[i] * run.v()[i][2];
    }
  };
  add_momentum(-1.0);
  run.commands(strprintf("run %d post no\n", steps));
  add_momentum(1.0);
  double mean[4];
  for (int k = 0; k < 4; k++) mean[k] = run.evaluate(strprintf("f_mean[%d]", k + 1));
  Drawn drawn = {mean[1], -mean[0], 0.0};
  for (int k = 0; k < 2; k++)
    drawn.error = std::max(drawn.error,
                           std::fabs((mean[k] + mean[k + 2]) * steps * dt + p[k]) /
                               (drawn.normal * steps * dt));
  return drawn;
}

/** Tangential over normal force; n: the part of the normal along the way. */
static double ploughing(double mu)
{
  const double beta = std::atan(SLOPE);
  double along = 0.0, down = 0.0;
  for (int k = 0; k < 1000; k++) {
    const double n = std::sin(beta) * std::cos(PI * ((k + 0.5) / 1000 - 0.5)),
                 t = std::sqrt(1.0 - n * n);
    along += n + mu * t;
    down += std::cos(beta) * (1.0 - mu * n / t);
  }
  return along / down;
}

TEST(Scratch, RegionAsTool)
{
  LONG_CASE();
  EXPECT_NEAR(ploughing(0.0), 2.0 / PI * SLOPE, 1e-6);
  double smooth = 0.0;
  for (const double mu : {0.0, 0.3}) {
    const auto s = draw(mu, 1.5, 4.0);
    const std::string name = strprintf("mu = %.1f: ", mu);
    measured(name + "normal force", s.normal);
    const double ratio = measured(name + "tangential / normal force", s.tangential / s.normal);
    EXPECT_LT(measured(name + "error of the balance of momentum", s.error), 1e-9);
    EXPECT_NEAR(ratio, ploughing(mu), 0.2 * ploughing(mu));
    EXPECT_LT(ratio, std::tan(std::atan(SLOPE) + std::atan(mu)));
    if (mu == 0.0) smooth = ratio;
    EXPECT_NEAR(ratio - smooth, ploughing(mu) - ploughing(0.0), 0.2 * mu);
  }
}

// A cone as an STL file, and as region of LAMMPS, which finds no distance on the axis of a cone:
// here a line of nodes. The cone of 64 triangles is smaller, by 0.12 % of its radius at most
TEST(Scratch, ToolOfTriangles)
{
  LONG_CASE();
  const int n = 64;
  const double top = 12.0;
  const auto at = [&](int i) {
    const double angle = 2.0 * PI * (i % n) / n;
    return Point{top / SLOPE * std::cos(angle), top / SLOPE * std::sin(angle), top};
  };
  Soup cone;
  for (int i = 0; i < n; i++) {
    cone.push_back({Point{0.0, 0.0, 0.0}, at(i + 1), at(i)});
    cone.push_back({Point{0.0, 0.0, top}, at(i), at(i + 1)});
  }
  const ScratchFile file("cone.stl", binary_of(cone));
  const auto round = draw(0.3, 1.5, 1.0), triangles = draw(0.3, 1.5, 1.0, file.name);
  EXPECT_NEAR(measured("normal force on triangles / on cone", triangles.normal / round.normal), 1.0,
              0.01);
  EXPECT_NEAR(measured("tangential force", triangles.tangential / round.tangential), 1.0, 0.01);
}

// A frictionless sphere that touches a rigid plastic body with its front half, by a radius R
// sin(theta), has tangential over normal force 2 (theta - sin cos)/(pi sin^2). 20 %, as the
// benchmark asks, with a radius of 0.4 R. With 0.6 R there is no steady state: the sphere pushes a
// ridge in front of itself, and the ratio grows from 1.2 to more than twice that of the formula
TEST(Scratch, SphereInPlasticMetal)
{
  LONG_CASE();
  const double sine = 0.4, angle = std::asin(sine), d = 0.9, R = d / (1.0 - std::cos(angle));
  const auto s = scratch(0.0, d, 12.0, sine * R, [&](double r) {
    r = std::min(r, 0.65 * R);    // corners of the tool stay in the box
    return R - std::sqrt(R * R - r * r);
  });
  const double plough = 2.0 * (angle - sine * std::cos(angle)) / (PI * sine * sine);
  measured("normal force", s.normal);
  EXPECT_NEAR(measured("tangential / normal force, over formula", s.tangential / s.normal / plough),
              1.0, 0.2);
}
