// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 240

// Elastic solids in fix mpm/incompressible: waves of shear, a layer under a flow, disks.

#include "wave_testing.h"

#include "group.h"

#include <complex>

using namespace MPM_TEST;

using Complex = std::complex<double>;

enum { FILLED = 3, FASTEST = 6 };

/** Young's modulus for a shear modulus and Poisson's ratio 0.499. */
std::string neohookean(double density, double G)
{
  return strprintf("mpm/material density %.17g neohookean %.17g 0.499\n", density, 2.998 * G);
}

/** A layer of solid of thickness a on a floor, fluid of the density 1 above it up to a lid at 1,
 *  and a force g cos(w t) along both: the amplitude of the velocity at y, and of its slope. */
struct Layer {
  double a, density, viscosity, G, w;

  Complex velocity(double y, Complex *slope = nullptr) const
  {
    const Complex i(0.0, 1.0), solid = viscosity + G / (i * w);
    const Complex ks = std::sqrt(i * w * density / solid), kf = std::sqrt(i * w / viscosity);
    const Complex free = 1.0 / (i * w), top = kf * (1.0 - a), bottom = ks * a;
    // free (1 - cosh) + B sinh(ks y) below, and free (1 - cosh) + D sinh(kf (1 - y)) above
    const Complex velocities = free * (std::cosh(bottom) - std::cosh(top)),
                  stresses =
                      free * (solid * ks * std::sinh(bottom) + viscosity * kf * std::sinh(top));
    const Complex det = std::sinh(bottom) * viscosity * kf * std::cosh(top) +
        std::sinh(top) * solid * ks * std::cosh(bottom);
    const Complex B = (velocities * viscosity * kf * std::cosh(top) + stresses * std::sinh(top)) /
        det,
                  D = (stresses * std::sinh(bottom) - velocities * solid * ks * std::cosh(bottom)) /
        det;
    if (slope)
      *slope = y < a ? ks * (B * std::cosh(ks * y) - free * std::sinh(ks * y))
                     : kf * (free * std::sinh(kf * (1.0 - y)) - D * std::cosh(kf * (1.0 - y)));
    if (y < a) return free * (1.0 - std::cosh(ks * y)) + B * std::sinh(ks * y);
    return free * (1.0 - std::cosh(kf * (1.0 - y))) + D * std::sinh(kf * (1.0 - y));
  }
};

/** Root mean square error of velocities in the second period, over that of what they should be. */
double error_of_layer(int n, const Layer &layer)
{
  const double h = 1.0 / n, T = 2.0 * PI / layer.w,
               limit = std::min(0.5 * h * h / (8.0 * layer.viscosity),
                                0.5 * h / (2.0 * std::sqrt(layer.G / layer.density)));
  const int steps = (int) std::ceil(T / limit);
  Scene run(
      plane("lj", "p f", strprintf("0 %.17g 0 1", 4 * h), 1, 0.5 * h) +
      strprintf("create_points 1 box spacing %.17g\nregion low block INF INF INF %.17g INF "
                "INF\ngroup low region low\nfix m low ",
                0.5 * h, layer.a) +
      neohookean(layer.density, layer.G) +
      strprintf("fix w all mpm/incompressible %.17g 1 viscosity %.17g solid low wall ylo stick "
                "wall yhi stick\nvariable g equal cos(%.17g*time)\nfix g all gravity v_g "
                "vector 1 0 0\ntimestep %.17g\n",
                h, layer.viscosity, layer.w, T / steps));

  // what it is at the start; the shear of the solid is the slope of its displacement

  const Complex i(0.0, 1.0);
  for (int k = 0; k < run.n(); k++) {
    Complex slope;
    const double y = run.x()[k][1];
    run.v()[k][0] = layer.velocity(y, &slope).real();
    if (y > layer.a) continue;
    const double shear = (slope / (i * layer.w)).real();
    run.points().F[k][1] = shear;
    run.points().tau[k][0] = layer.G * shear * shear;
    run.points().tau[k][3] = layer.G * shear;
  }
  double wrong = 0.0, all = 0.0;
  run.each_step([&](double **) {
    if (run.lmp->update->ntimestep < steps) return;
    const Complex phase = std::exp(Complex(0.0, layer.w * run.time()));
    for (int k = 0; k < run.n(); k++) {
      const double v = (layer.velocity(run.x()[k][1]) * phase).real();
      wrong += std::pow(run.v()[k][0] - v, 2);
      all += v * v;
    }
  });
  run.commands(strprintf("run %d\n", 2 * steps - 1));
  return measured(strprintf("%d cells, interface at %g, density %g: error of the velocity", n,
                            layer.a, layer.density),
                  std::sqrt(wrong / all));
}

/** Area of the squares of points next to each other at the start that are in a group. */
class Squares {
 public:
  Squares(Scene &run, const std::string &group, double spacing) : run(run)
  {
    const int bit = run.lmp->group->bitmask[run.lmp->group->find(group)];
    std::map<std::array<int, 2>, tagint> at;
    for (int i = 0; i < run.n(); i++)
      if (run.lmp->atom->mask[i] & bit)
        at[{(int) std::floor(run.x()[i][0] / spacing), (int) std::floor(run.x()[i][1] / spacing)}] =
            run.lmp->atom->tag[i];
    for (const auto &one : at) {
      const auto k = one.first;
      const std::array<int, 2> corners[] = {
          {k[0] + 1, k[1]}, {k[0] + 1, k[1] + 1}, {k[0], k[1] + 1}};
      if (!at.count(corners[0]) || !at.count(corners[1]) || !at.count(corners[2])) continue;
      list.push_back({one.second, at[corners[0]], at[corners[1]], at[corners[2]]});
    }
  }
  double area()
  {
    double sum = 0.0;
    for (const auto &square : list) {
      double **const x = run.x();
      int p[4];
      for (int k = 0; k < 4; k++) p[k] = run.lmp->atom->map(square[k]);
      const auto &a = x[p[0]], &b = x[p[1]], &c = x[p[2]], &d = x[p[3]];
      sum += 0.5 * ((c[0] - a[0]) * (d[1] - b[1]) - (c[1] - a[1]) * (d[0] - b[0]));
    }
    return sum;
  }

 private:
  Scene &run;
  std::vector<std::array<tagint, 4>> list;
};

/** A soft disk in a cavity with n cells (Zhao, Freund, Moser, J. Comput. Phys. 227 (2008) 3114). */
std::string cavity(int n, double density = 1.0, const std::string &more = "")
{
  return "atom_modify map array\n" + plane("lj", "f f", "0 1 0 1", 1, 0.02) +
      strprintf("create_points 1 box spacing %.17g\n", 0.5 / n) +
      "region disk sphere 0.6 0.5 0 0.2\ngroup disk region disk\nfix m disk " +
      neohookean(density, 0.1) +
      strprintf("fix w all mpm/incompressible %.17g 1 viscosity 0.01 solid disk wall yhi stick 1 0 "
                "wall ylo stick wall xlo stick wall xhi stick %s\n",
                1.0 / n, more.c_str());
}

// a transverse wave in a box full of solid, without viscosity: of second order
SERIAL_TEST(FlowSolids, WavesOfShear)
{
  double before = 0.0;
  for (const int n : {8, 16}) {
    const double h = 1.0 / n, dt = 0.125 * h;
    for (const int dim : {2, 3}) {
      if (dim == 3 && n == 16) continue;
      Scene run(
          box(dim, "lj", "p p p", strprintf("0 1 0 %.17g 0 %.17g", 4 * h, 4 * h), 1, 0.5 * h) +
          strprintf("create_points 1 box spacing %.17g\nfix m all ", 0.5 * h) +
          neohookean(4.0, 4.0) +
          strprintf("fix w all mpm/incompressible %.17g 1 solid all\nvariable v atom "
                    "0.01*sin(2*PI*x)\nvelocity all set NULL v_v NULL\ntimestep %.17g\n",
                    h, dt));
      // the amplitude of sin(2 pi x), and when it is zero
      Crossings crossings;
      const auto &zeros = crossings.times;
      run.each_step([&](double **) {
        double now = 0.0;
        for (int i = 0; i < run.n(); i++) now += run.v()[i][1] * std::sin(2 * PI * run.x()[i][0]);
        crossings.add(run.time(), now);
      });
      const double kinetic = run.sums().kinetic;
      run.commands(strprintf("run %d\n", 6 * n));
      EXPECT_NEAR(measured("kinetic and stored energy over that at the start",
                           (run.sums().kinetic + run.stored_energy()) / kinetic),
                  1.0, n == 8 ? 0.16 : 0.04);    // of second order, as the period
      EXPECT_GT(measured("stored energy", run.stored_energy() / kinetic), 0.1);
      run.commands(strprintf("run %d\n", 16 * n));
      ASSERT_GE(zeros.size(), 4u);
      const double wrong = measured(strprintf("%d cells, %dd: error of the period", n, dim),
                                    2.0 * (zeros[3] - zeros[0]) / 3.0 - 1.0);
      EXPECT_LT(std::fabs(wrong), 0.05);
      if (n == 16) { EXPECT_GT(measured("order", std::log2(std::fabs(before / wrong))), 1.7); }
      before = wrong;
    }
  }
}

// a layer sheared by the fluid above it: of second order, wherever the interface is in a cell
SERIAL_TEST(FlowSolids, LayerUnderAFlow)
{
  for (const double density : first_of(1, {2.0, 1.0}))
    for (const double a : first_of(1, {0.5625, 0.5})) {
      const Layer layer = {a, density, 0.1, 1.0, 4.0};
      const double coarse = error_of_layer(16, layer), fine = error_of_layer(32, layer);
      EXPECT_LT(coarse, 0.0125);
      EXPECT_GT(measured("order", std::log2(coarse / fine)), 1.5);
    }
}

// a disk that goes round in a cavity keeps its area, wherever its points go
SERIAL_TEST(FlowSolids, DiskInACavity)
{
  Scene run(cavity(32) + "fix dt all mpm/dt 0.8 every 1 until 5\n");
  Squares squares(run, "disk", 0.5 / 32);
  const double before = squares.area();
  run.commands("run 2000\n");
  EXPECT_LT(measured("change of the area", std::fabs(squares.area() / before - 1.0)), 0.005);
}

// a heavy disk that sinks slowly in a channel, as a rigid one does (O.H. Faxen, Proc. R. Swed.
// Acad. Eng. Sci. 187 (1946) 1), with middles at nodes of the lattice and in cells, and a shear
// modulus that is as good as infinite; by default as many steps as one likes do not brake it
SERIAL_TEST(FlowSolids, HeavyDiskSinks)
{
  const char *const aflip = "transfer aflip 1.0";
  double kept = 0.0;    // speed with it
  struct Case {
    double a, at, G, dt;
    const char *transfer;
  };
  for (const auto &c : first_of(3,
                                {Case{2, 0.5, 1.0, 0.12, aflip}, Case{2, 0.5, 1.0, 0.12, ""},
                                 Case{2, 0.0, 1.0, 0.12, aflip}, Case{2, 0.0, 4.0, 0.06, aflip},
                                 Case{2, 0.0, 1.0, 0.03, ""}, Case{4, 0.0, 1.0, 0.12, aflip}})) {
    const auto gap = [&](double radius) {
      const double k = radius / (4.0 * c.a);
      return -std::log(k) - 0.9157 + 1.7244 * std::pow(k, 2) - 1.7302 * std::pow(k, 4) +
          2.4056 * std::pow(k, 6);
    };
    const double g = 0.08 / (gap(c.a) * std::pow(c.a, 3));
    Scene run(plane("lj", "f f", strprintf("0 %g 0 %g", 8 * c.a, 14 * c.a), 1, 0.5) +
              "create_points 1 box spacing 0.5\n" +
              strprintf("region disk sphere %g %g 0 %g\ngroup disk region disk\nfix m disk ",
                        4 * c.a + c.at, 7 * c.a + c.at, c.a) +
              neohookean(2.0, c.G) +
              "fix w all mpm/incompressible 1 1 viscosity 1 solid disk wall xlo stick wall xhi "
              "stick " +
              c.transfer + "\nfix g all gravity " +
              strprintf("%.17g vector 0 -1 0\ntimestep %g\nrun %g\n", g, c.dt,
                        std::round(8.0 * c.a * c.a / c.dt)));
    const int bit = run.lmp->group->bitmask[run.lmp->group->find("disk")];
    double sum = 0.0, area = 0.0;
    for (int i = 0; i < run.n(); i++)
      if (run.lmp->atom->mask[i] & bit) {
        sum -= 0.25 * run.v()[i][1];
        area += 0.25;
      }
    // that of a disk of the area that points have
    const double theory = g * area * gap(std::sqrt(area / PI)) / (4.0 * PI);
    const double speed = sum / area / theory;
    EXPECT_NEAR(measured(strprintf("%g cells in the radius, at %g, shear modulus %g, step %g %s: "
                                   "speed over theory",
                                   c.a, c.at, c.G, c.dt, c.transfer),
                         speed),
                1.0, 0.05);
    // by default points keep nearly all of what the lattice does not see
    if (c.at == 0.5 && c.transfer == aflip)
      kept = speed;
    else if (c.at == 0.5)
      EXPECT_NEAR(measured("by default over aflip 1.0", speed / kept), 1.0, 0.01);
  }
}

// a heavy strip hangs in a fluid at rest: it stretches by L^2 (density difference) g/8G
SERIAL_TEST(FlowSolids, StripHangs)
{
  for (const double at : {0.0, 0.5}) {
    Scene run(
        plane("lj", "f f", "0 12 0 14", 1, 0.5) + "create_points 1 box spacing 0.5\n" +
        strprintf("region s block %g %g 6 INF INF INF\ngroup s region s\n", 4 + at, 8 + at) +
        "region e block INF INF 6 6.5 INF INF\ngroup low region e\ngroup end intersect s low\n"
        "fix m s " +
        neohookean(2.0, 1.0) +
        "fix w all mpm/incompressible 1 1 viscosity 1 solid s wall yhi stick\n"
        "fix g all gravity 0.025 vector 0 -1 0\ntimestep 0.12\n"
        "variable y equal xcm(end,y)\nrun 0\n");
    const double start = run.variable("y");
    run.commands("run 900\n");
    EXPECT_NEAR(measured("sinks over theory", (start - run.variable("y")) / (64.0 * 0.025 / 8.0)),
                1.0, 0.1);
  }
}

// a column alone in the air, with sides anywhere in a cell, on a floor without friction: it swings
// about the state in which its middle has sunk by rho g H^2/(3 E'), with E' = 4 G in the plane
SERIAL_TEST(FlowSolids, ColumnInAir)
{
  for (const int b : {1, 2})
    for (const double at : {0.0, 0.3, 0.5, 0.75, 0.9}) {
      if (b == 2 && at != 0.3) continue;
      const double g = 0.004 / b, H = 8.5 * b;
      Scene run(
          plane("lj", "f f", strprintf("0 %d 0 %d", 14 * b, 10 * b), 1, 0.5) +
          strprintf("region c block %d %d 0 %g INF INF\ncreate_points 1 region c spacing 0.5\n"
                    "displace_atoms all move %g 0 0\nfix m all ",
                    4 * b, 9 * b, H, at) +
          neohookean(1.0, 1.0) + "fix w all mpm/incompressible 1 1 solid all\n" +
          strprintf("fix g all gravity %.17g vector 0 -1 0\ntimestep 0.2\n", g));
      double sum = 0.0;
      int steps = 0;
      run.each_step([&](double **) {
        for (int i = 0; i < run.n(); i++) sum += run.x()[i][1] / run.n();
        steps++;
      });
      run.commands(strprintf("run %d\n", 255 * b));    // three periods of 4 H/(E'/rho)^(1/2)
      EXPECT_NEAR(measured(strprintf("%g cells, sides at %g: sinks over theory", H, at),
                           (0.5 * H - sum / steps) / (g * H * H / 12.0)),
                  1.0, 0.05);
    }
}

// its kinetic energy stays that of its first swing, (rho g)^2 H^3 W/(6 E'): surfaces of solids gain
// energy where they lie between nodes, which was 285 times this, with apic 43 times, after 600
SERIAL_TEST(FlowSolids, ColumnGainsNoEnergy)
{
  const double g = 1.18e-4, theory = g * g * 8000.0 * 5.0 / 24.0;
  Scene run(plane("lj", "f f", "0 14 0 22", 1, 0.5) +
            "region c block 4 9 0 20 INF INF\ncreate_points 1 region c spacing 0.5\n"
            "displace_atoms all move 0.05 0 0\nfix m all " +
            neohookean(1.0, 1.0) + "fix w all mpm/incompressible 1 1 solid all\n" +
            strprintf("fix g all gravity %.17g vector 0 -1 0\ntimestep 0.2\n", g));
  double most = 0.0, fourth = 0.0;
  for (int k = 0; k < (is_quick() ? 150 : 300); k++) {
    run.commands("run 10");
    const double energy = run.fix("w")->compute_vector(5);
    most = std::max(most, energy);
    if (k < 40) fourth = std::max(fourth, k >= 30 ? energy : 0.0);
  }
  EXPECT_NEAR(measured("kinetic energy over theory, fourth swing", fourth / theory), 1.0, 0.05);
  EXPECT_LT(measured("most", most / theory), 1.5);
}

// a beam that stands on a floor is loaded across at once: its end goes to twice its deflection at
// rest, that of a beam with E' = 4 G and shear (S.P. Timoshenko)
SERIAL_TEST(FlowSolids, BeamInAir)
{
  for (const int t : {4, 6})
    for (const double at : {0.0, 0.3}) {
      if (t == 6 && at == 0.0) continue;
      const double L = 4 * t, h3 = t * t,
                   w = 12.0 * std::pow(L, 4) / (32.0 * h3) + L * L * 6.0 / 10.0, g = 0.1 * t / w;
      Scene run(plane("lj", "f f", strprintf("0 %d 0 %g", 20 + t, L + 4), 1, 0.5) +
                strprintf("region c block 8 %d 0 %g INF INF\ncreate_points 1 region c spacing "
                          "0.5\nregion t block INF INF %g INF INF INF\ngroup tip region t\n"
                          "displace_atoms all move %g 0 0\nfix m all ",
                          8 + t, L, L - 0.5, at) +
                neohookean(1.0, 1.0) +
                "fix w all mpm/incompressible 1 1 solid all wall ylo stick\n"
                "variable x equal xcm(tip,x)\nrun 0\n" +
                strprintf("fix g all gravity %.17g vector 1 0 0\ntimestep 0.2\n", g));
      const double start = run.variable("x");
      const int bit = run.lmp->group->bitmask[run.lmp->group->find("tip")];
      double most = 0.0;
      run.each_step([&](double **) {
        double sum = 0.0;
        int n = 0;
        for (int i = 0; i < run.n(); i++)
          if (run.lmp->atom->mask[i] & bit) {
            sum += run.x()[i][0];
            n++;
          }
        most = std::max(most, sum / n - start);
      });
      run.commands(strprintf("run %d\n", 140 * t));
      EXPECT_NEAR(measured(strprintf("%d cells, sides at %g: deflection over theory", t, at),
                           most / (0.2 * t)),
                  1.0, t == 4 ? 0.13 : 0.08);
    }
}

// a block of solid in 3d that stands in the middle of cells
SERIAL_TEST(FlowSolids, BlockInAir)
{
  Scene run(box(3, "lj", "f f f", "0 8 0 8 0 9", 1, 0.5) +
            "region c block 2 5 2 5 0 5\ncreate_points 1 region c spacing 0.5\n"
            "displace_atoms all move 0.3 0.5 0\nfix m all " +
            neohookean(1.0, 1.0) +
            "fix w all mpm/incompressible 1 1 solid all\nfix g all gravity 0.02 vector 0 0 -1\n"
            "compute c all mpm/atom wavespeed\ncompute least all reduce min c_c\n"
            "thermo_style custom step c_least\ntimestep 0.15\nvariable z equal xcm(all,z)\n");
  double sum = 0.0;
  int steps = 0;
  run.each_step([&](double **) {
    sum += run.variable("z");
    steps++;
  });
  run.commands("run 154\n");    // two periods of 4 H/(3 G/rho)^(1/2)
  EXPECT_NEAR(measured("sinks over theory", (2.5 - sum / steps) / (0.02 * 25.0 / 9.0)), 1.0, 0.03);
  const double modulus = 2.998 * 0.501 / (1.499 * 0.002);    // E (1-nu)/((1+nu) (1-2 nu))
  EXPECT_NEAR(measured("slowest wave", run.evaluate("c_least") / std::sqrt(modulus)), 1.0, 1e-6);
}

// a stream with vortices and a heavy disk: momentum is that of points that fill cells evenly
SERIAL_TEST(FlowSolids, Momentum)
{
  for (const double viscosity : {0.0, 0.005}) {
    Scene run(
        plane("lj", "p p", "0 1 0 1", 1, 0.02) +
        "create_points 1 box spacing 0.025\nregion disk sphere 0.5 0.5 0 0.25\ngroup disk region "
        "disk\nvariable u atom 1+0.5*sin(2*PI*x)*cos(2*PI*y)\nvariable v atom "
        "-0.5*cos(2*PI*x)*sin(2*PI*y)\nvelocity all set v_u v_v NULL\nfix m disk " +
        neohookean(2.0, 1.0) +
        strprintf("fix w all mpm/incompressible 0.05 1 viscosity %g solid disk\nfix dt all "
                  "mpm/dt 0.5 every 1 max 0.02\nrun 0\n",
                  viscosity));
    const auto before = run.sums();
    run.commands("run 100\n");
    const auto after = run.sums();
    for (int d = 0; d < 2; d++)
      EXPECT_LT(measured(strprintf("viscosity %g: change of the mean velocity along %c", viscosity,
                                   'x' + d),
                         std::fabs(after.p[d] - before.p[d]) / before.mass),
                1e-3);
    EXPECT_LT(measured("kinetic energy over that before", after.kinetic / before.kinetic), 1.0);
  }
}

// each point keeps the history of its law, here temperatures that nothing changes
SERIAL_TEST(FlowSolids, KeepTheirHistory)
{
  Scene run(plane("lj", "p p", "0 1 0 1", 1, 0.1) +
            "create_points 1 box spacing 0.125\nfix m all mpm/material density 1 neohookean 1 0.49 "
            "thermal constant 300\nfix w all mpm/incompressible 0.25 1 solid all\n"
            "variable v atom 0.1*sin(2*PI*x)\nvelocity all set NULL v_v NULL\ntimestep 0.02\n"
            "run 0\n");
  auto *const material = run.material("m");
  const int T = material->find_history("temperature");
  for (int i = 0; i < run.n(); i++) material->history[i][T] = 300.0 + run.lmp->atom->tag[i];
  run.commands("run 3\n");
  double sheared = 0.0;
  for (int i = 0; i < run.n(); i++) {
    EXPECT_EQ(material->history[i][T], 300.0 + run.lmp->atom->tag[i]);
    grow(sheared, run.points().F[i][3]);
  }
  EXPECT_GT(sheared, 0.01);
}

// on four ranks, balanced; and the same to the last bit from a restart file
TEST(FlowSolids, RanksAndRestart)
{
  for (const int dim : {2, 3}) {
    const double h = dim == 2 ? 0.05 : 0.1;
    const auto scene = box(dim, "lj", "f f p", "0 1 0 1 0 0.4", 1, 0.02) +
        "region d block INF INF INF 0.81 INF INF\n" +
        strprintf("create_points 1 region d spacing %g\n", 0.5 * h) +
        "region low block INF 0.4 INF 0.6 INF INF\ngroup low region low\nvelocity low set 1 0.5 "
        "0\n";
    const auto fixes = "fix m low " + neohookean(2.0, 1.0) +
        strprintf("fix w all mpm/incompressible %g 1 tolerance 1e-11 viscosity 0.01 solid low wall "
                  "ylo stick%s\n",
                  h, dim == 2 ? " transfer aflip 0.98" : "") +
        "fix g all gravity 1 vector 0 -1 0\nfix dt all mpm/dt 0.5 every 1 max 0.01\n";
    OnRanks run(scene + fixes, "run 15\n", "fix b all balance 5 1.05 shift xy 10 1.05\n");
    EXPECT_LT(measured("difference", run.difference()), 1e-12);
    Continued again(scene + fixes, 6, "neighbor 0.02 bin\n" + fixes, 12);
    EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
  }
}

SERIAL_TEST(FlowSolids, BadInput)
{
  const auto plain = plane("si", "p f", "0 1 0 1", 1, 0.02) +
      "create_points 1 box spacing 0.05\nregion s block 0.2 0.6 0.2 0.6 INF INF\ngroup s region s\n"
      "group none empty\nfix m s mpm/material density 1100 neohookean 1e4 0.49\n";
  const std::string fix = "fix w all mpm/incompressible 0.1 1000 ";
  expect_refused(plain,
                 {{fix + "solid", "solid"},
                  {fix + "solid nobody", "group nobody does not exist"},
                  {fix + "solid none", "has no points of this fix"},
                  {fix + "solid all", "have no law"},
                  {fix + "solid s tension 1", "leave one of them out"},
                  {fix + "solid s reflect 0.5", "leave it out"},
                  {fix + "solid s viscosity 1 implicit yes", "use explicit viscosity"},
                  {"unfix m\nfix m s mpm/material density 1000 linear 1e4 0.3\n" + fix + "solid s",
                   "is no hyperelastic law"},
                  {"timestep 1\n" + fix + "solid s", "too large for the stiffness of its solids"}},
                 "run 1\n");
  for (const auto &[viscosity, warnings] : {std::pair{"", 1u}, std::pair{" viscosity 100", 0u}})
    EXPECT_EQ(times_said(plain + fix + "solid s" + viscosity + "\ntimestep 0.001\nrun 1\nrun 1\n",
                         "are not stable in a fluid of so little viscosity"),
              warnings);
}
