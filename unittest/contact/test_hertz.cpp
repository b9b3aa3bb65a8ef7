// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// timeout: 600

// Hertz contact: force and contact radius against indentation, on one lattice (fix
// mpm/contact) and on two (pair mpm/penalty), with an error that falls with the node spacing.

#include "mpm_lammps.h"

#include <utility>

using namespace MPM_TEST;

/** An elastic block of width W (radius or edge) and depth D between smooth walls; a rigid
 *  paraboloid of radius R is pressed into its upper face. Modulus 1, density 1. */
struct Block {
  double nu, R, W, D;

  double plane_modulus() const { return 1.0 / (1.0 - nu * nu); }
  double wave_modulus() const { return (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)); }
  double wave_speed() const { return std::sqrt(wave_modulus()); }

  // K.L. Johnson, Contact Mechanics (1985), section 4.2, with the radius a of the contact
  double force(double a) const { return 4.0 / 3.0 * plane_modulus() * a * a * a / R; }
  double peak(double a) const { return 2.0 / PI * plane_modulus() * a / R; }

  /** Pressure of wave number k, times what it has as amplitude of J0 or of cosines, to the
   *  displacement of the surface: of a half-space 2/(E* k), of a layer on a floor without friction
   *  less by the factor (cosh 2u - 1)/(sinh 2u + 2u), u = k D. */
  double compliance(double k) const
  {
    const double u = std::min(k * D, 300.0);
    return 2.0 / (plane_modulus() * k) * (std::cosh(2.0 * u) - 1.0) /
        (std::sinh(2.0 * u) + 2.0 * u);
  }
  /** Integral of r p(r) J0(k r) over the pressure of Hertz, p = peak sqrt(1 - r^2/a^2). */
  double transform(double a, double k) const
  {
    const double q = k * a;
    return peak(a) * a * a * (std::sin(q) - q * std::cos(q)) / (q * q * q);
  }

  // The indentation is the displacement of the surface at the center. That of a half-space would be
  // a^2/R; walls and floor change it by a relative amount of the order of a/D, which these series
  // have, but the shape of the surface, and with it force and pressure, by (a/D)^3 only.
  double indentation_round(double a) const    // in a cylinder
  {
    double sum = force(a) * D / (PI * W * W * wave_modulus());
    for (int n = 1; n < 4000; n++) {
      double q = (n + 0.25) * PI - 3.0 / (8.0 * (n + 0.25) * PI);    // zero of J1
      for (int k = 0; k < 3; k++) q -= j1(q) / (j0(q) - j1(q) / q);
      sum += compliance(q / W) * transform(a, q / W) * 2.0 / (W * W * j0(q) * j0(q));
    }
    return sum;
  }
  double indentation_square(double a) const    // a quarter of it in a corner of W x W
  {
    double sum = force(a) * D / (4.0 * W * W * wave_modulus());
    for (int m = 0; m < 800; m++)
      for (int n = 0; n < 800; n++) {
        if (m + n == 0) continue;
        const double k = PI / W * std::hypot(m, n);
        sum += (m ? 2.0 : 1.0) * (n ? 2.0 : 1.0) * 0.5 * PI / (W * W) * compliance(k) *
            transform(a, k);
      }
    return sum;
  }
};

/** Errors at three radii of the contact: of the force relative to it, and of the radius. */
struct Errors {
  double force[3], radius[3];
};

static constexpr double RADII[3] = {0.6, 0.8, 1.0};

/** What a run has to tell: force on the part of the paraboloid, radius of the contact. */
struct Probe {
  int depth;    // axis along which it comes down
  double part;
  std::function<double(Scene &)> force, radius;
};

/** The paraboloid comes down so slowly that waves cross the block many times. */
static Errors press(Scene &run, const Block &block, double (Block::*indentation)(double) const,
                    const Probe &probe, double h, double transits)
{
  const double end = (block.*indentation)(1.0);
  const double time = transits * block.D / block.wave_speed(), speed = end / time;
  for (int i = 0; i < run.n(); i++) {
    if (run.lmp->atom->type[i] != 2) continue;
    double *const x = run.x()[i];
    const double across = probe.depth == 1 ? x[0] * x[0] : x[0] * x[0] + x[1] * x[1];
    x[probe.depth] += 0.5 * across / block.R;    // a plate, sheared
    run.v()[i][probe.depth] = -speed;
  }
  Errors errors;
  const double dt = run.lmp->update->dt;
  const int steps = (int) (time / dt), samples = 10, window = steps / 60 / samples * samples;
  for (int n = 0; n < 3; n++) {
    const double a = RADII[n];
    const double at = (block.*indentation)(a) / end * time;
    run.commands(strprintf("run %d post no\n", (int) ((at - run.time()) / dt) - window));
    double f = 0.0, radius = 0.0, exact_f = 0.0, exact_a = 0.0;
    for (int k = 0; k < samples; k++) {
      run.commands(strprintf("run %d post no\n", window / samples));
      const double now = a * std::sqrt(run.time() / at);    // near a the indentation goes with a^2
      exact_a += now / samples;
      exact_f += block.force(now) / samples;
      f += probe.force(run) / probe.part / samples;
      radius += probe.radius(run) / samples;
    }
    const std::string name = strprintf("h/a = %.3f: ", h / a);
    errors.force[n] = std::fabs(measured(name + "error of the force", f / exact_f - 1.0));
    errors.radius[n] =
        std::fabs(measured(name + "error of the radius in cells", (radius - exact_a) / h)) * h;
  }
  return errors;
}

static std::string with_map(const std::string &box)
{
  return replaced(box, "atom_style mpm\n",
                  "atom_style mpm\natom_modify map array\nneighbor $(0.3*v_h) bin\n");
}
static const std::string materials = "fix m1 one mpm/material density 1.0 linear 1.0 0.3\n"
                                     "fix m2 two mpm/material density 1.0e9 linear 1.0 0.3\n"
                                     "timestep $(0.4*v_h/1.16)\n";
static double contact_force(Scene &run)
{
  return run.evaluate("-f_c[1][2]");
}

// The exact solution itself: in a deep and wide block the indentation is that of a half-space, less
// F a0/(pi E* D) for a wide layer, with a0 = 1.16757, the integral of 1 - L
TEST(Hertz, SeriesHaveTheKnownLimits)
{
  const Block wide = {0.3, 10.0, 60.0, 10.0};
  const double layer = 0.1 - wide.force(1.0) * 1.16757 / (PI * wide.plane_modulus() * wide.D);
  EXPECT_NEAR(wide.indentation_round(1.0), layer, 2.0e-4 * layer);
  const Block near = {0.3, 10.0, 8.0, 8.0};
  EXPECT_NEAR(near.indentation_square(1.0), near.indentation_round(1.0),
              0.02 * near.indentation_round(1.0));
}

// a body of revolution on another one, on one lattice
TEST(Hertz, OnOneLattice)
{
  const Block block = {0.3, 10.0, 8.0, 8.0};
  Errors error[2];
  for (int k = 0; k < 2; k++) {
    const double h = 0.25 / (1 << k);
    Scene run(
        strprintf("variable h equal %g\n", h) + with_map(plane("lj", "f f", "0 8 0 11", 2)) +
        fields({{"one", "block 0 8 0 8 INF INF"}, {"two", "block 0 2.5 8 $(8+3*v_h) INF INF"}},
               "${h} axisymmetric yes transfer flip 1.0 scheme musl") +
        materials + "fix axis all mpm/boundary xlo xhi ylo slip\nfix c all mpm/contact F2 F1\n");
    // The stress of single points is uneven down to some cells below the contact, its mean over
    // four layers is not. At depth z the mean of r^2 with the stress as weight is 2/5 a^2 + 2 z^2,
    // of which 3 z^3/s is beyond the radius s, with a share (z/s)^3 of the force
    std::vector<std::pair<tagint, double>> layers;
    for (int i = 0; i < run.n(); i++) {
      const double z = 8.0 - run.x()[i][1];
      if (z > h && z < 3.0 * h) layers.emplace_back(run.lmp->atom->tag[i], z);
    }
    const auto radius = [&](Scene &r) {
      const double s = 4.0;
      double force = 0.0, first = 0.0, part = 0.0, square = 0.0;
      for (const auto &[tag, z] : layers) {
        square += 2.0 * z * z - 3.0 * z * z * z / s;
        part += 1.0 - z * z * z / (s * s * s);
        const int i = r.lmp->atom->map(tag);
        const double x = r.x()[i][0];
        if (x > s) continue;
        const auto stress = r.cauchy(i);
        force -= stress[1] * x;
        first -= stress[1] * x * x * x;
      }
      const double second = first / force * part - square;
      return std::sqrt(std::max(0.0, 2.5 * second / layers.size()));
    };
    const Probe probe = {1, 1.0, contact_force, radius};
    error[k] = press(run, block, &Block::indentation_round, probe, h, 15.0);
  }
  for (int n = 0; n < 3; n++) {
    EXPECT_LT(error[1].force[n], 0.03);
    EXPECT_LT(error[1].force[n], 0.5 * error[0].force[n]);
    EXPECT_LT(error[1].radius[n], 0.75 * 0.125);
    EXPECT_LT(error[1].radius[n], 0.5 * error[0].radius[n]);
  }
  EXPECT_LT(error[1].force[2], 0.01);
}

// A block of twenty radii of the contact (U3) on four lattices (fix mpm/refine)
TEST(Hertz, OnSeveralLattices)
{
  LONG_CASE();
  const Block block = {0.3, 10.0, 20.0, 20.0};
  const double ends[4] = {3.0, 6.0, 11.0, 20.0};    // of the lattices, from the finest
  Errors error[2];
  for (int k = 0; k < 2; k++) {
    const double h = 0.25 / (1 << k), coarse = 8.0 * h;
    std::string lattices, points, all;
    for (int level = 0; level < 4; level++) {    // from the coarsest
      const int type = level == 0 ? 1 : level + 2;
      const double spacing = coarse / (1 << level), origin = 0.5 * (coarse - spacing),
                   end = ends[3 - level], inner = level < 3 ? ends[2 - level] : 0.0;
      const std::string options =
          strprintf("mpm %.17g origin %.17g %.17g axisymmetric yes scheme musl stress gradient",
                    spacing, origin, origin);
      lattices += strprintf("group g%d type %d\nfix F%d g%d %s\n", level, type, level, level,
                            options.c_str());
      all += strprintf(" F%d", level);
      points +=
          strprintf("region o%d block 0 %g %g 20 INF INF\nregion i%d block 0 %g %g 20 INF INF "
                    "side out\nregion r%d intersect 2 o%d i%d\n",
                    level, end, 20.0 - end, level, inner, 20.0 - inner, level, level, level) +
          strprintf("create_points %d region %c%d ppc 2 fix F%d\ngroup g%d type %d\n", type,
                    level < 3 ? 'r' : 'o', level, level, level, type);
      if (level < 3) continue;
      lattices += "group two type 2\nfix T two " + options + "\n";
      points +=
          strprintf("region two block 0 2.5 20 %.17g INF INF\ncreate_points 2 region two ppc 2 "
                    "fix T\ngroup two type 2\n",
                    20.0 + 3.0 * h);
    }
    Scene run(strprintf("variable h equal %g\n", h) + with_map(plane("lj", "f f", "0 20 0 23", 5)) +
              lattices + "fix block all mpm/refine" + all + "\n" + points +
              "group one subtract all two\n" + materials +
              "fix axis all mpm/boundary xlo xhi ylo slip\nfix c all mpm/contact T F3\n");
    const auto none = [](Scene &) {
      return 0.0;
    };
    const Probe probe = {1, 1.0, contact_force, none};
    error[k] = press(run, block, &Block::indentation_round, probe, h, 8.0);
  }
  for (int n = 0; n < 3; n++) EXPECT_LT(error[1].force[n], 0.5 * error[0].force[n]);
  EXPECT_LT(error[1].force[2], 0.03);    // eight cells in the radius
}

// in three dimensions, on two lattices: a quarter. Spheres of points touch late where they face
// gaps of the other lattice, and the layer of contact yields: the force is too small by what both
// are of the indentation, which is of first order in the spacing of points
TEST(Hertz, OnTwoLattices)
{
  LONG_CASE();
  const Block block = {0.3, 4.0, 4.0, 4.0};
  Errors error[2];
  for (int k = 0; k < 2; k++) {
    const double h = k ? 0.2 : 1.0 / 3.0;
    Scene run(strprintf("variable h equal %.17g\n", h) +
              with_map(space("lj", "f f f", "0 4 0 4 0 7", 2)) +
              fields({{"one", "block 0 4 0 4 0 4", "${h} transfer flip 1.0 scheme musl"},
                      {"two", "block 0 1.6 0 1.6 4 $(4+2.4*v_h)",
                       "$(0.8*v_h) origin 0 0 4 transfer flip 1.0 scheme musl"}}) +
              materials + R"(fix sides all mpm/boundary xlo xhi ylo yhi zlo slip
pair_style mpm/penalty
pair_coeff 1 2 1.0
compute f two reduce sum fz
thermo_style custom step c_f
)");
    // forces on the points of the paraboloid: the mean of r^2 is 2/5 a^2
    const auto force = [](Scene &r) {
      return r.evaluate("c_f");
    };
    const auto radius = [](Scene &r) {
      double sum = 0.0, second = 0.0;
      for (int i = 0; i < r.n(); i++) {
        if (r.lmp->atom->type[i] != 2) continue;
        const double *x = r.x()[i], f = r.lmp->atom->f[i][2];
        sum += f;
        second += f * (x[0] * x[0] + x[1] * x[1]);
      }
      return std::sqrt(2.5 * second / sum);
    };
    const Probe probe = {2, 0.25, force, radius};
    error[k] = press(run, block, &Block::indentation_square, probe, h, 8.0);
  }
  for (int n = 0; n < 3; n++) {
    EXPECT_LT(error[1].force[n], 0.62 * error[0].force[n]);    // first order
    EXPECT_LT(error[1].radius[n], 0.1 * 0.2);
  }
  EXPECT_LT(error[1].force[2], 0.07);
}
