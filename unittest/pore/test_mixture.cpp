// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 300

// Fix mpm/mixture: soil and water as two fields.

#include "wave_testing.h"

#include <complex>

using namespace MPM_TEST;

/** Mean height of the points of type 1. */
double height_of_soil(Scene &run)
{
  double sum = 0.0, number = 0.0;
  for (const auto &s : run.gather())
    if (s.type == 1) {
      sum += s.x[1];
      number++;
    }
  return sum / number;
}

constexpr double G = 9.81, POROSITY = 0.4;
constexpr double GRAINS = 2650.0, WATER = 1000.0, DRY = (1.0 - POROSITY) * GRAINS;

/** A column along y of the width of two cells, periodic along x. */
struct Column {
  double h, height;                                      ///< cells; of the box
  double soil[2] = {0.0, 0.0}, water[2] = {0.0, 0.0};    ///< from, to
  double E = 1.0e7, nu = 0.3, K = 2.2e8;
  std::string drag = "darcy 1.0e-10", options = "transfer apic";
  int dim = 2;

  /** 4 cells high, full of soil and water. */
  static Column full(double E, double K, const std::string &drag)
  {
    Column c = {0.1, 0.4};
    c.soil[1] = c.water[1] = c.height;
    c.E = E;
    c.K = K;
    c.drag = drag;
    return c;
  }

  double modulus() const { return E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)); }

  /** Box, points, and materials; type 1: soil, type 2: water. */
  std::string text() const
  {
    const std::string wide = strprintf("0 %.17g", 2.0 * h);
    std::string s = dim == 2
        ? plane("si", "p f", wide + strprintf(" 0 %.17g -0.5 0.5", height), 2, 0.3 * h)
        : space("si", "p f p", wide + strprintf(" 0 %.17g ", height) + wide, 2, 0.3 * h);
    s += "group soil type 1\ngroup water type 2\n";
    s += strprintf("fix s soil mpm %.17g %s\nfix w water mpm %.17g %s\n", h, options.c_str(), h,
                   options.c_str());
    const auto part = [&](const char *name, double low, double high) {
      return high > low
          ? strprintf("region %s block INF INF %.17g %.17g INF INF\n", name, low, high)
          : "";
    };
    s += part("ground", soil[0], soil[1]) +
        (soil[1] > soil[0] ? "create_points 1 region ground ppc 2 fix s group soil\n" : "");
    const auto fill = [&](const char *name, double low, double high, const char *share) {
      if (high > low)
        s += part(name, low, high) + "create_points 2 region " + name + " ppc 2 fix w group water" +
            share + "\n";
    };
    fill("below", water[0], std::min(water[1], soil[0]), "");
    fill("pores", std::max(water[0], soil[0]), std::min(water[1], soil[1]),
         strprintf(" share %.17g", POROSITY).c_str());
    fill("above", std::max(water[0], soil[1]), water[1], "");
    s += strprintf("fix ms soil mpm/material density %.17g linear %.17g %.17g\n", DRY, E, nu);
    s += strprintf("fix mw water mpm/material density %.17g eos linear %.17g\n", WATER, K);
    s += strprintf("fix mix all mpm/mixture s w %.17g 1.0e-3 drag %s\n", GRAINS, drag.c_str());
    return s;
  }

  /** The same with all faces periodic. */
  std::string periodic() const { return replaced(text(), "boundary p f", "boundary p p"); }
};

/** Volume ratio of water with a pressure, by eos linear. */
void set_pressure(Scene &run, int i, double p, double K)
{
  double *const F = run.points().F[i];
  const double J = 1.0 / (1.0 + p / K);
  for (int k = 0; k < 9; k++) F[k] = k % 4 == 0 ? 1.0 : 0.0;
  F[4] = J;
}

/** Stress of soil under uniaxial strain, from the vertical one. */
void set_stress(Scene &run, int i, double vertical, double nu)
{
  double *const tau = run.points().tau[i];
  const double side = vertical * nu / (1.0 - nu);
  tau[0] = side;
  tau[1] = vertical;
  tau[2] = side;
}

struct Fit {
  double value = 0.0, slope = 0.0, rms = 0.0;    ///< at 0; rms of what is left
};

/** Of f(state) of the points of a type between two heights over the height. */
template <class F> Fit fit(Scene &run, int type, double low, double high, const F &f)
{
  double n = 0.0, x = 0.0, xx = 0.0, y = 0.0, xy = 0.0, yy = 0.0;
  for (const auto &s : run.gather()) {
    if (s.type != type || s.x[1] < low || s.x[1] > high) continue;
    const double v = f(s);
    n++;
    x += s.x[1];
    xx += s.x[1] * s.x[1];
    y += v;
    xy += s.x[1] * v;
    yy += v * v;
  }
  Fit fit;
  fit.slope = (xy / n - x / n * y / n) / (xx / n - x / n * x / n);
  fit.value = y / n - fit.slope * x / n;
  const double left = yy / n - fit.value * y / n - fit.slope * xy / n;
  fit.rms = std::sqrt(std::max(0.0, left));
  return fit;
}

double pressure(const Scene::State &s)
{
  return s.pressure();
}
double vertical(const Scene::State &s)
{
  return s.stress[1];
}

// Velocities of soil and water in a periodic box fade exactly with the rate of drag.
PARAMETER_TEST(Relaxation, IsExact, std::string,
               Values("transfer apic", "transfer flip 1.0", "transfer flip 1.0 scheme musl",
                      "transfer apic scheme musl", "transfer aflip 1.0", "shape cubic",
                      "transfer pic"))
{
  if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  for (const int dim : {2, 3}) {
    Column c = Column::full(1.0e3, 1.0e3, "darcy 1.0e-9");
    c.options = GetParam();
    c.dim = dim;
    Scene run(c.periodic() + "timestep 1.0e-4\n");
    for (int i = 0; i < run.n(); i++)
      for (int d = 0; d < dim; d++)
        run.v()[i][d] = run.lmp->atom->type[i] == 1 ? 0.3 * (d + 1) : -1.0 + d;
    const auto before = run.sums();
    run.commands("run 4\n");
    const auto last = run.sums(1);
    run.commands("run 1\n");
    const auto after = run.sums(), soil_after = run.sums(1);
    for (int d = 0; d < dim; d++) {
      const double given = soil_after.p[d] - last.p[d];
      EXPECT_GT(fabs(given), 1.0e-6 * after.mass);
      EXPECT_NEAR(run.fix_vector("mix", 6)[d] * 1.0e-4 / given, 1.0, 1e-11) << dim << d;
    }
    const double rate =
        POROSITY * POROSITY * 1.0e-3 / 1.0e-9 * (1.0 / DRY + 1.0 / (POROSITY * WATER));
    for (int d = 0; d < dim; d++) {
      const double w0 = -1.0 + d - 0.3 * (d + 1);
      double least = HUGE_VAL, most = -HUGE_VAL;
      for (int i = 0; i < run.n(); i++)
        if (run.lmp->atom->type[i] == 2) {
          double soil = 0.0;
          for (int j = 0; j < run.n(); j++)
            if (run.lmp->atom->type[j] == 1) soil = run.v()[j][d];
          least = std::min(least, (run.v()[i][d] - soil) / w0);
          most = std::max(most, (run.v()[i][d] - soil) / w0);
        }
      EXPECT_NEAR(least, exp(-rate * 5.0e-4), 1e-12) << dim << d;
      EXPECT_NEAR(most, exp(-rate * 5.0e-4), 1e-12) << dim << d;
      EXPECT_NEAR(after.p[d], before.p[d], 1e-14 * after.mass);
    }
    const double lost = before.kinetic - after.kinetic;
    EXPECT_NEAR(run.fix("mix")->compute_scalar(), lost, 1e-12 * lost);
  }
}

// A bed of soil in a tank of water stays at rest: pressure, weight of the soil less buoyancy.
PARAMETER_TEST(Still, StaysAtRest, std::string,
               Values("transfer apic", "transfer flip 1.0 scheme musl", "transfer aflip 1.0",
                      "transfer apic smooth 0.5", "shape cubic"))
{
  if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  Column c;
  c.h = 0.05;
  c.height = 1.5;
  c.soil[1] = 0.5;
  c.water[1] = 1.0;
  c.K = 2.0e6;
  c.E = 1.0e6;
  c.options = GetParam();
  Scene run(c.text() +
            "fix walls all mpm/boundary ylo slip\nfix g all gravity 9.81 vector 0 -1 0\n"
            "compute e all mpm/energy\nfix step all mpm/dt 0.4\n");
  const double buoyant = (1.0 - POROSITY) * (GRAINS - WATER) * G;
  for (int i = 0; i < run.n(); i++) {
    const double y = run.x()[i][1];
    if (run.lmp->atom->type[i] == 1)
      set_stress(run, i, -buoyant * (0.5 - y), c.nu);
    else
      set_pressure(run, i, WATER * G * (1.0 - y), c.K);
  }
  run.commands("run 2000\n");
  const auto p = fit(run, 2, 0.02, 0.95, pressure);
  const auto s = fit(run, 1, 0.02, 0.45, vertical);
  double fastest = 0.0;
  for (const auto &q : run.gather()) grow(fastest, q.v[1]);
  const double weight = 2.0 * c.h * G * (WATER * (0.5 + 0.5 * POROSITY) + DRY * 0.5),
               displaced = 2.0 * c.h * G * WATER * (1.0 - POROSITY) * 0.5;
  EXPECT_NEAR(measured("gradient of the pressure", p.slope / (-WATER * G)), 1.0, 0.01);
  EXPECT_LT(measured("rms of what is left", p.rms / (WATER * G)), 0.005);
  EXPECT_NEAR(measured("gradient of the effective stress", s.slope / buoyant), 1.0, 0.01);
  EXPECT_LT(measured("rms of what is left", s.rms / (0.5 * buoyant)), 0.005);
  EXPECT_NEAR(measured("force on the floor", run.fix_vector("walls", 6)[1] / weight), -1.0, 0.005);
  // buoyancy, less what presses the soil on the floor, where there is no water below it
  EXPECT_NEAR(measured("pressure on the soil",
                       run.fix_vector("mix", 6)[4] / (displaced * (1.0 - 1.0 / 0.5))),
              1.0, 0.01);
  EXPECT_LT(measured("fastest", fastest), 8e-5 * sqrt(c.K / WATER));
  EXPECT_LT(fabs(run.compute_vector()[10]), 1.0e-12);
}

/** A bed of 0.5 m under water up to this height, at rest by mpm_geostatic, its floor off nodes. */
std::string bed(int dim, double h, double height, const std::string &options, double offset)
{
  Column c;
  c.h = h;
  c.height = 1.5;
  c.dim = dim;
  c.soil[1] = 0.5;
  c.water[1] = height;
  c.E = 1.0e7;
  c.options = options + strprintf(" origin 0 %.17g", offset * h) + (dim == 3 ? " 0" : "");
  return c.text() + "fix walls all mpm/boundary ylo slip\nfix g all gravity 9.81 vector 0 -1 0\n";
}
const double BUOYANT = (1.0 - POROSITY) * (GRAINS - WATER) * G;

// level ground in water, as mpm_geostatic finds it: what is left of forces, the stress of soil
TEST(Geostatic, StaysAtRest)
{
  const double dt = 2.0e-5;
  for (const int dim : {2, 3})
    for (const char *options : {"transfer apic", "transfer aflip 1.0", "transfer flip 1.0",
                                "stress gradient", "shape cubic", "transfer apic smooth 0.5"})
      for (const double offset : {0.0, 0.3})
        for (const double height : {0.5, 0.9}) {
          if (dim == 3 && (options[0] != 't' || height < 0.6)) continue;
          if (offset > 0.0 && strcmp(options, "shape cubic") == 0) continue;
          auto scene = bed(dim, 0.05, height, options, offset);
          if (offset > 0.0 && height > 0.5) {    // points may be in any order
            const auto at = scene.find("region ground"), next = scene.find("region above");
            const auto bed = scene.substr(at, next - at);
            scene = replaced(replaced(scene, bed, ""), "fix ms soil", bed + "fix ms soil");
          }
          Scene run(scene + "mpm_geostatic s 0.4\n" + strprintf("timestep %g\nrun 1\n", dt));
          double most[3] = {0.0, 0.0, 0.0};
          for (const auto &s : run.gather())
            for (int d = 0; d < dim; d++)
              most[(int) s.type] = std::max(most[(int) s.type], fabs(s.v[d]) / (G * dt));
          const auto name = strprintf("%dd %s, floor %g, water %g: ", dim, options, offset, height);
          EXPECT_LT(measured(name + "force on soil over weight", most[1]), 1e-9);
          EXPECT_LT(measured("on water", most[2]), 1e-8);
          double worst = 0.0, top = 0.0;
          for (const auto &s : run.gather())
            if (s.type == 1) top = std::max(top, s.x[1] + 0.0125);
          for (const auto &s : run.gather()) {
            if (s.type != 1) continue;
            EXPECT_NEAR(s.stress[0], 0.4 * s.stress[1], 1e-12 * BUOYANT);
            if (s.x[1] > 0.15 && s.x[1] < 0.35) grow(worst, s.stress[1] + BUOYANT * (top - s.x[1]));
          }
          // the surface of the soil in the water is where the volumes on nodes change
          EXPECT_LT(measured("stress inside over the weight of a cell", worst / (BUOYANT * 0.05)),
                    0.5);
        }
}

// and later
SERIAL_TEST(Geostatic, IsStillAtRestLater)
{
  Scene run(bed(2, 0.1, 0.9, "transfer apic", 0.3) +
            "mpm_geostatic s 0.5\nfix step all mpm/dt 0.4\nrun 2000\n");
  double fastest = 0.0;
  for (const auto &s : run.gather()) grow(fastest, s.v[1]);
  EXPECT_LT(measured("velocity over that of free fall", fastest / (G * run.time())), 1e-11);
  // pressure of the floor: all of the weight
  const double weight = 0.2 * G * (WATER * (0.4 + 0.5 * POROSITY) + DRY * 0.5);
  EXPECT_NEAR(measured("floor over weight", -run.fix_vector("walls", 6)[1] / weight), 1.0, 1e-10);
}

TEST(Geostatic, RanksAndRestart)
{
  const std::string scene = bed(2, 0.1, 0.9, "transfer apic", 0.3),
                    start = "mpm_geostatic s 0.5\nvelocity soil set 0.01 0 0\ntimestep 5e-5\n";
  OnRanks run(scene, start + "run 50\n");
  EXPECT_LT(run.difference(), 1e-11);
}

// The standing wave of a sealed column: frequency and decay of equations for both velocities
// (u-v-p), whose roots are those of data on saturated_modes: 4 equations, solved here.
struct Mode {
  double K, k;    ///< bulk modulus of water, hydraulic conductivity
  std::string options;
};

PARAMETER_TEST(StandingWave, HasTheRootsOfBothVelocities, Mode,
               Values(Mode{2.2e8, 1.0e-3, "transfer aflip 1.0"},
                      Mode{2.2e8, 1.0e-3, "transfer flip 1.0 scheme musl"},
                      Mode{2.2e9, 1.0e-3, "transfer aflip 1.0"},
                      Mode{2.2e8, 1.0e-2, "transfer aflip 1.0"},
                      Mode{2.2e8, 1.0e-5, "transfer aflip 1.0"},
                      Mode{2.2e8, 1.0e-3, "transfer apic"}))
{
  if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  const auto &mode = GetParam();
  Column c;
  c.h = 1.0 / 40.0;
  c.height = c.soil[1] = c.water[1] = 1.0;
  c.K = mode.K;
  c.options = mode.options;
  c.drag = strprintf("darcy %.17g", mode.k * 1.0e-3 / (WATER * G));
  Scene run(c.text() + "fix walls all mpm/boundary ylo yhi slip\nfix step all mpm/dt 0.1\n");
  const double speed = 1.0e-3, wave = PI;
  run.set_velocity([&](const double *x, double *v) {
    v[1] = speed * sin(wave * x[1]);
  });
  std::vector<double> t, y;
  run.each_step([&](double **) {
    double sum = 0.0, weight = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const double s = sin(wave * run.x()[i][1]);
      sum += run.mass()[i] * s * run.v()[i][1];
      weight += run.mass()[i] * s * s;
    }
    t.push_back(run.time());
    y.push_back(sum / weight / speed);
  });
  const double omega = 1690.0 * sqrt(mode.K / 2.2e8), end = 3.2 * 2.0 * PI / omega;
  run.commands(strprintf("variable t equal time\nfix end all halt 1 v_t > %.17g error continue\n"
                         "run 100000\n",
                         end));

  // sigma', v, u, p of the mode
  const double M = c.modulus(), n = POROSITY, d = n * WATER * G / mode.k;
  const auto rate = [&](const std::array<double, 4> &s) {
    const double drag = d * (s[2] - s[1]);
    return std::array<double, 4>{
        M * wave * s[1], (-wave * s[0] + (1.0 - n) * wave * s[3] + n * drag) / DRY,
        (wave * s[3] - drag) / WATER, -c.K / n * wave * ((1.0 - n) * s[1] + n * s[2])};
  };
  std::vector<double> exact;
  std::array<double, 4> state = {0.0, 1.0, 1.0, 0.0};
  double now = 0.0;
  for (const double at : t) {
    const int steps = 20;
    const double dt = (at - now) / steps;
    for (int k = 0; k < steps && dt > 0.0; k++) {
      const auto add = [&](const std::array<double, 4> &r, double by) {
        auto sum = state;
        for (int j = 0; j < 4; j++) sum[j] += by * r[j];
        return sum;
      };
      const auto a = rate(state), b = rate(add(a, 0.5 * dt)), e = rate(add(b, 0.5 * dt)),
                 f = rate(add(e, dt));
      for (int j = 0; j < 4; j++) state[j] += dt / 6.0 * (a[j] + 2.0 * b[j] + 2.0 * e[j] + f[j]);
    }
    now = at;
    exact.push_back((DRY * state[1] + n * WATER * state[2]) / (DRY + n * WATER));
  }
  const auto mine = frequency_and_decay(t, y), theory = frequency_and_decay(t, exact);
  measured("decay", mine[1]);
  measured("theory", theory[1]);
  EXPECT_NEAR(measured("frequency / theory", mine[0] / theory[0]), 1.0, 0.005);
  EXPECT_NEAR(mine[1] / theory[1], 1.0, 0.02);
}

// Consolidation of a layer under a load (K. Terzaghi), with the compressibility of the water.
SERIAL_TEST(Consolidation, FollowsTerzaghi)
{
  double errors[2][2];
  for (const int fine : {0, 1}) {
    const double h = fine ? 0.05 : 0.1;
    Column c;
    c.h = h;
    c.height = 1.2;
    c.soil[1] = c.water[1] = 1.0;
    c.drag = strprintf("darcy %.17g", 1.0e-3 * 1.0e-3 / (WATER * G));
    Scene run(replaced(c.text(), "density 1590", strprintf("density %g", (1.0 - POROSITY) * 2670)) +
              "fix walls all mpm/boundary ylo slip\nfix step all mpm/dt 0.4\n");
    const double q = 1.0e4, M = c.modulus(), cv = 1.0e-3 / (WATER * G) / (1.0 / M + POROSITY / c.K);
    const double top = 1.0 - 0.25 * h, p0 = q / (1.0 + POROSITY * M / c.K);
    for (int i = 0; i < run.n(); i++)
      if (run.lmp->atom->type[i] == 1)
        set_stress(run, i, p0 - q, c.nu);
      else
        set_pressure(run, i, p0, c.K);
    std::vector<int> loaded;
    for (int i = 0; i < run.n(); i++)
      if (run.lmp->atom->type[i] == 1 && run.x()[i][1] > top - 0.01 * h)
        loaded.push_back(run.lmp->atom->tag[i]);
    run.each_step([&](double **f) {
      for (int i = 0; i < run.n(); i++)
        if (std::count(loaded.begin(), loaded.end(), run.lmp->atom->tag[i]))
          f[i][1] = -q * 2.0 * h / loaded.size();
    });
    run.commands(strprintf("variable t equal time\nfix end all halt 1 v_t > %.17g error continue\n"
                           "run 100000\n",
                           0.2 / cv));
    // what is above the points in the top row does not count
    double U = 1.0;
    for (int m = 0; m < 400; m++) {
      const double a = (m + 0.5) * PI;
      U -= 2.0 / (a * a) * exp(-0.2 * a * a);
    }
    for (int j = 0; j < 50; j++) {
      const double depth = 0.25 * h * (j + 0.5) / 50;
      double p = 0.0;
      for (int m = 0; m < 400; m++) {
        const double a = (m + 0.5) * PI;
        p += 2.0 / a * sin(a * depth) * exp(-0.2 * a * a);
      }
      U -= (1.0 - p) * 0.25 * h / 50;
    }
    double settled = 0.0, deep = 0.0, n = 0.0;
    for (const auto &s : run.gather()) {
      if (s.type == 1 && s.x[1] > top - 0.1 * h) settled += (top - s.x[1]) / loaded.size();
      if (s.type == 2 && s.x[1] < 0.5 * h) {
        deep += s.pressure();
        n++;
      }
    }
    errors[0][fine] = fabs(measured("settlement", settled / (p0 / M) / U) - 1.0);
    errors[1][fine] = fabs(measured("pressure", deep / n / p0 / 0.772312) - 1.0);
  }
  for (const auto &e : errors) {
    EXPECT_LT(e[1], 0.01);
    EXPECT_GT(measured("order", log2(e[0] / e[1])), 0.9);
  }
}

// Water flows up through a bed of soil that lies on a sieve, driven by a force in a periodic
// column: Darcy's flow, gradient of the pressure, effective stress, and the gradient at which the
// bed is lifted. The force is uniform in the water, and the soil weighs so much less that the
// difference is that of its weight under water. A body elsewhere, in contact with the soil if it
// were here, changes nothing, nor do walls at the sides, which hold soil and water. In a stiff bed,
// what is left of the effective stress is right to 2 % of itself with aflip: other transfers take a
// part of the head where the water changes its speed at the ends of the bed. Stresses are means
// over cells, in which those of points vary as nodes do not see.
struct Flow {
  double gradient;
  std::string options, with = "";
  double h = 0.05;
  bool stiff = false;
};

PARAMETER_TEST(Seepage, LiftsTheBedAtTheCriticalGradient, Flow,
               Values(Flow{0.9, "transfer apic smooth 0.9"},
                      Flow{0.9, "transfer aflip 1.0 smooth 0.9"},
                      Flow{0.9, "transfer apic smooth 0.9", "third"},
                      Flow{0.9, "transfer apic smooth 0.9", "sides of regions"},
                      Flow{0.9, "transfer aflip 1.0", "", 0.05, true},
                      Flow{0.96, "transfer apic smooth 0.9"},
                      Flow{1.02, "transfer apic smooth 0.9"}, Flow{0.5, "transfer apic smooth 0.9"},
                      Flow{0.9, "transfer apic"}, Flow{0.9, "transfer apic smooth 0.9", "sides"},
                      Flow{0.9, "transfer aflip 1.0", "", 0.025, true}))
{
  LONG_AFTER(7);
  if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  const double i = GetParam().gradient, L = 1.6, H = 0.5;
  Column c;
  c.h = GetParam().h;
  c.height = L;
  c.soil[0] = 0.3;
  c.soil[1] = 0.3 + H;
  c.water[1] = L;
  c.K = 2.0e6;
  const bool stiff = GetParam().stiff;
  c.E = stiff ? 1.0e7 : 1.0e6;
  c.options = GetParam().options;
  const double k = 0.005, gravity = WATER * G;
  c.drag = strprintf("darcy %.17g", k * 1.0e-3 / gravity);
  const std::string with = GetParam().with;
  const std::string base = replaced(c.periodic(), "create_box 2", "create_box 3");
  Scene run((with == "sides" ? replaced(base, "boundary p p", "boundary f p") : base) +
            "fix step all mpm/dt 0.4\nregion sieve block INF INF 0 0.3 INF INF\n"
            "fix sieve all mpm/boundary region sieve separate field s\n");
  if (with == "sides") run.commands("fix sides all mpm/boundary xlo xhi slip\n");
  if (with == "sides of regions")
    run.commands("region sides block -1 0.005 INF INF INF INF\n"
                 "fix sides all mpm/boundary region sides slip\n");
  if (with == "third")
    run.commands(strprintf("group third empty\nfix t third mpm %g %s\n", c.h, c.options.c_str()) +
                 "region far block INF INF 1.2 1.3 INF INF\n"
                 "create_points 3 region far ppc 2 fix t group third overlap yes\n"
                 "fix mt third mpm/material density 1000 neohookean 1.0e5 0.3\n"
                 "fix touch all mpm/contact s t\n");
  const double buoyant = (1.0 - POROSITY) * (GRAINS - WATER) * G;
  for (int j = 0; j < run.n(); j++)
    if (run.lmp->atom->type[j] == 1) set_stress(run, j, -buoyant * (0.3 + H - run.x()[j][1]), c.nu);
  const double drive = i * G * H / L;
  double weight = 0.0;    // of the soil, in the last step
  run.each_step([&](double **f) {
    const double t = run.time(), now = drive * (t < 0.5 ? 0.5 - 0.5 * cos(2.0 * PI * t) : 1.0);
    weight = 0.0;
    for (int j = 0; j < run.n(); j++) {
      const int type = run.lmp->atom->type[j];
      if (type == 1)
        f[j][1] = -run.mass()[j] / DRY * (buoyant - (1.0 - POROSITY) * WATER * now);
      else if (type == 2)
        f[j][1] = run.mass()[j] * now;
      if (type == 1) weight -= f[j][1];
    }
  });
  const double before = height_of_soil(run);
  run.commands(strprintf("variable t equal time\nfix end all halt 1 v_t > %g error continue\n"
                         "run 100000\nunfix end\n",
                         stiff ? 1.5 : 1.0));

  // means over time: of the flux in all of the column; of the gradient of the pressure and the
  // vertical stress of the soil inside of the bed; of all forces on the soil

  double flux = 0.0, slope = 0.0, stress = 0.0, forces = 0.0;
  std::vector<double> of_cells(std::lround(0.3 / c.h), 0.0);
  const int times = 25;
  for (int step = 0; step < times; step++) {
    run.commands("run 50\n");
    const double *const mix = run.fix_vector("mix", 6);
    forces += (mix[1] + mix[4] - weight) / times;
    const double *const sieve = run.fix_vector("sieve", 6);
    forces -= sieve[1] / times;
    // nodes are at x = 0 and h, those at 2 h are images
    if (with.empty()) EXPECT_NEAR(sieve[5], 0.5 * c.h * sieve[1], 1e-11 * c.h * weight);
    double n = 0.0, x = 0.0, xx = 0.0, p = 0.0, xp = 0.0;
    for (const auto &s : run.gather()) {
      if (s.type != 2) continue;
      flux += s.vol * s.v[1] / (2.0 * c.h * L) / times;
      const double at = s.x[1] - L * floor(s.x[1] / L);
      if (at < 0.4 || at > 0.7) continue;
      n++;
      x += at;
      xx += at * at;
      p += s.pressure();
      xp += at * s.pressure();
    }
    slope += (xp / n - x / n * p / n) / (xx / n - x / n * x / n) / times;
    stress += fit(run, 1, 0.4, 0.7, vertical).slope / times;
    for (const auto &s : run.gather()) {
      const int cell = (int) std::floor((s.x[1] - 0.4) / c.h);
      if (s.type == 1 && cell >= 0 && cell < (int) of_cells.size())
        of_cells[cell] += s.stress[1] / (8 * times);
    }
  }
  const double moved = measured("moved", height_of_soil(run) - before);
  if (i > 0.99) {
    EXPECT_GT(moved, 0.02);
    return;
  }
  EXPECT_LT(moved, 1.0e-3);
  EXPECT_NEAR(measured("flux / Darcy", flux / (i * k)), 1.0, 0.01);
  EXPECT_NEAR(measured("gradient of the pressure", (drive * WATER - slope) / gravity / i), 1.0,
              0.01);
  EXPECT_NEAR(measured("effective stress, error", (stress - (buoyant - i * gravity)) / buoyant),
              0.0, 0.02);
  if (stiff) {
    double sum = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < of_cells.size(); k++) {
      const double from_middle = c.h * (k + 0.5 - 0.5 * of_cells.size());
      sum += from_middle * of_cells[k];
      squares += from_middle * from_middle;
    }
    EXPECT_NEAR(measured("effective stress by cells", sum / squares / (buoyant - i * gravity)), 1.0,
                0.02);
  }
  EXPECT_NEAR(measured("all forces on the soil", forces / weight), 0.0, 1e-4);
}

// Forces of drag by laws for spheres: in a periodic box a force drives water through soil that is
// held, and the difference of velocities after a long time has just this drag.
SERIAL_TEST(Drag, OfSpheresIsThatOfTheLaw)
{
  const double d = 0.01, mu = 1.0e-3, n = POROSITY;
  for (const std::string law : {"ergun", "gidaspow", "difelice"})
    for (const double q : {1.0e-4, 0.05}) {
      // gradient of pressure of the superficial velocity q
      const double Re = WATER * q * d / mu;
      double needed = 150.0 * mu * (1.0 - n) * (1.0 - n) * q / (n * n * n * d * d) +
          1.75 * WATER * (1.0 - n) * q * q / (n * n * n * d);
      if (law == "difelice")
        needed = 0.75 * (1.0 - n) * WATER * q * q / d * pow(0.63 + 4.8 / sqrt(Re), 2.0) *
            pow(n, -(3.7 - 0.65 * exp(-0.5 * pow(1.5 - log10(Re), 2.0))) - 1.0);
      Scene run(Column::full(1.0e4, 1.0e4, law + " 0.01").periodic() + "timestep 5.0e-3\n");
      run.each_step([&](double **f) {
        for (int i = 0; i < run.n(); i++)
          f[i][0] = run.lmp->atom->type[i] == 2 ? needed / WATER * run.mass()[i]
                                                : -needed * n / DRY * run.mass()[i];
      });
      run.commands("run 2500\n");
      double u[2] = {0.0, 0.0};
      for (int i = 0; i < run.n(); i++) u[run.lmp->atom->type[i] - 1] = run.v()[i][0];
      EXPECT_NEAR(measured(law, n * (u[1] - u[0]) / q), 1.0, 1e-11);
    }
}

// Soil of another porosity than that of the permeability; the time step by the page's formula
SERIAL_TEST(Drag, OfDarcyDependsOnPorosity)
{
  const Column c = Column::full(1.0e5, 1.0e6, "darcy 1.0e-9 0.5");
  Scene run(c.periodic() + "timestep 1.0e-4\nvelocity water set 1.0 0 0\nrun 5\n");
  const auto kozeny = [](double n) {
    return n * n * n / ((1.0 - n) * (1.0 - n));
  };
  const double kappa = 1.0e-9 * kozeny(POROSITY) / kozeny(0.5);
  const double rate = POROSITY * POROSITY * 1.0e-3 / kappa * (1.0 / DRY + 1.0 / (POROSITY * WATER));
  double v[2] = {0.0, 0.0};
  for (int i = 0; i < run.n(); i++) v[run.lmp->atom->type[i] - 1] = run.v()[i][0];
  EXPECT_NEAR((v[1] - v[0]) / exp(-rate * 5.0e-4), 1.0, 1e-10);

  run.commands("fix step all mpm/dt 1.0\nvelocity all set 0 0 0\nrun 1\n");
  const double c2 = c.K / WATER + c.K * (1.0 - POROSITY) / (POROSITY * GRAINS) + c.modulus() / DRY;
  EXPECT_NEAR(run.lmp->update->dt * sqrt(c2) / c.h, 1.0, 1e-12);
}

/** A plug of soil in the middle of a column of water, of the permeability k [m/s]. */
Column plug(double k, const std::string &options)
{
  Column c;
  c.h = 0.05;
  c.height = 1.0;
  c.soil[0] = 0.4;
  c.soil[1] = 0.6;
  c.water[1] = 1.0;
  c.K = 4.0e6;
  c.E = 1.0e6;
  c.drag = strprintf("darcy %.17g", k * 1.0e-3 / (WATER * G));
  c.options = options;
  return c;
}

/** Mean velocity of the soil up to the end, from a time on. */
double velocity_of_soil(Scene &run, double from, double to)
{
  run.commands(strprintf(
      "fix end all halt 1 v_t > %.17g error continue message no\nrun 1000000\nunfix end\n", from));
  const double first = height_of_soil(run), start = run.time();
  run.commands(
      strprintf("fix end all halt 1 v_t > %.17g error continue message no\nrun 1000000\n", to));
  const double stop = run.time();
  return (height_of_soil(run) - first) / (stop - start);
}

// A plug of soil in a closed column of water sinks or rises as fast as the drag of the water that
// it pushes aside allows, of the plug's velocity, k (rho_s/rho_f - 1) (1 - n).
SERIAL_TEST(Plug, SinksAsTheWaterLetsIt)
{
  const double k = 5.0e-3;
  for (const double grains : {GRAINS, 500.0}) {
    const Column c = plug(k, "transfer aflip 1.0 smooth 0.5");
    std::string text = replaced(c.text(), strprintf("density %.17g linear", DRY),
                                strprintf("density %.17g linear", (1.0 - POROSITY) * grains));
    text = replaced(text, strprintf("s w %.17g", GRAINS), strprintf("s w %.17g", grains));
    text = replaced(text, "fix s soil mpm 0.050000000000000003 transfer aflip 1.0 smooth 0.5",
                    "fix s soil mpm 0.050000000000000003 transfer aflip 1.0");
    Scene run(
        text +
        "variable t equal time\nvariable g equal 9.81*(time<0.5)*sin(PI*time)^2+9.81*(time>=0.5)\n"
        "fix walls all mpm/boundary ylo yhi slip\nfix g all gravity v_g vector 0 -1 0\n"
        "fix step all mpm/dt 0.4\n");
    const double exact = -k * (grains / WATER - 1.0) * (1.0 - POROSITY);
    const double v = velocity_of_soil(run, 0.6, 1.6);
    EXPECT_NEAR(measured("velocity of the plug over k", v / k), exact / k, 0.02);
  }
}

// Apic slows fast water down in each step, of which a warning tells
SERIAL_TEST(Plug, SlowedByTheTransferIsTold)
{
  const auto told = [](double k, const std::string &options) {
    const Column c = plug(k, options);
    return times_said(c.text() + "fix step all mpm/dt 0.4\nrun 2\n", "slows the water down");
  };
  EXPECT_EQ(told(5.0e-2, ""), 1);
  EXPECT_EQ(told(5.0e-2, "transfer aflip 1.0"), 0);
  EXPECT_EQ(told(1.0e-3, ""), 0);
}

// A pond sinks into a dry bed. Behind a front without suction pores are full: n dL/dt = k (H - n L
// + L)/L with the depth H of the pond at first, and L of the front.
SERIAL_TEST(Pond, SinksIntoADryBed)
{
  LONG_CASE();
  const double k = 0.02, deep = 0.3, end = 3.0;
  double front = 0.0;
  const double d = 1.0e-5;    // of the front
  for (double t = 0.0; t < end; front += d)
    t += d * POROSITY * (front + 0.5 * d) / (k * (deep + (1.0 - POROSITY) * (front + 0.5 * d)));
  Column c;
  c.h = 0.025;
  c.height = 1.0;
  c.soil[1] = 0.6;
  c.water[0] = 0.6;
  c.water[1] = 0.6 + deep;
  c.K = 2.0e6;
  c.drag = strprintf("darcy %.17g", k * 1.0e-3 / (WATER * G));
  c.options = "transfer aflip 1.0";
  Scene run(
      replaced(c.text(), "fix w water mpm 0.025000000000000001",
               "fix w water mpm 0.025 smooth 0.5") +
      "variable t equal time\nfix floor all mpm/boundary ylo slip\n"
      "fix g all gravity 9.81 vector 0 -1 0\nfix step all mpm/dt 0.4\n" +
      strprintf("fix end all halt 10 v_t > %.17g error continue message no\nrun 1000000\n", end));
  double top = 0.0;
  for (const auto &s : run.gather())
    if (s.type == 2) top = std::max(top, s.x[1]);
  const double gone = c.water[1] - (top + 0.25 * c.h);
  EXPECT_GT(measured("water in the bed over exact", gone / (POROSITY * front)), 0.82);
  EXPECT_LT(gone / (POROSITY * front), 1.0);
}

/** Soil falls into a pool, some of which is in its pores; along y there is gravity. */
static std::string slump(int dim, const std::string &options = "transfer apic")
{
  const std::string deep = dim == 3 ? "0 4" : "INF INF";
  return box(dim, "lj", "p f p", "0 10 0 8 0 4", 2, 0.3) +
      "group soil empty\ngroup water empty\nfix s soil mpm 1.0 " + options +
      "\nfix w water mpm 1.0 " + options + "\nregion heap block 2 5 0 5 " + deep +
      "\nregion wet block 2 5 0 2 " + deep + "\nregion left block 0 2 0 2 " + deep +
      "\nregion right block 5 10 0 2 " + deep +
      "\nregion pool union 2 left right\n"
      "create_points 1 region heap ppc 2 fix s group soil jitter 0.2 4711\n"
      "create_points 2 region wet ppc 2 fix w group water share 0.5 jitter 0.2 471\n"
      "create_points 2 region pool ppc 2 fix w group water jitter 0.2 47\n";
}
static const std::string stuff =
    "fix ms soil mpm/material density 1.25 drucker/prager 200.0 0.3 30\n"
    "fix mw water mpm/material density 1.0 eos tait 200.0 7\n"
    "fix mix all mpm/mixture s w 2.5 0.01 drag gidaspow 0.1\nfix floor all mpm/boundary ylo slip\n"
    "fix g all gravity 0.2 vector 0 -1 0\ncompute e all mpm/energy\ntimestep 0.02\n";

TEST(Slump, IsTheSameOnAnyNumberOfRanksAndAfterARestart)
{
  for (const int dim : {2, 3})
    for (const std::string options :
         {"transfer apic smooth 0.5", "transfer flip 0.99 scheme musl"}) {
      const std::string fields =
          "fix s soil mpm 1.0 " + options + "\nfix w water mpm 1.0 " + options + "\n";
      const std::string rest =
          replaced(stuff, "timestep 0.02", dim == 2 ? "fix step all mpm/dt 0.3" : "timestep 0.02");
      Twins run(slump(dim, options) + rest, 60, fields + rest, 60, 1.0e-9);
      for (int k = 0; k < 6; k++)
        EXPECT_NEAR(run.serial.fix_vector("mix", 6)[k], run.whole.fix_vector("mix", 6)[k], 1e-11);
      const double heat = run.serial.fix("mix")->compute_scalar();
      EXPECT_GT(heat, 1.0e-3);    // there is something to compare
      EXPECT_NEAR(run.whole.fix("mix")->compute_scalar(), heat, 1e-12 * heat);
      EXPECT_NEAR(run.again.fix("mix")->compute_scalar(), heat, 1e-12 * heat);
      EXPECT_LT(fabs(measured("residual", run.serial.compute_vector()[10])), 1.0e-11);
    }
}

// a wall that holds the soil and not the water at a node changes what drag does there: the balance
// of energy has this, also where bodies begin inside of a wall
SERIAL_TEST(Slump, LedgerHasDragAtWalls)
{
  const std::string slip = "fix floor all mpm/boundary ylo slip\n";
  for (const char *wall : {"separate", "separate friction 0.3", "slip"}) {
    Scene run(slump(2, "transfer apic") +
              replaced(stuff, slip,
                       std::string("region low block INF INF INF 1.3 INF INF\n"
                                   "fix low all mpm/boundary region low ") +
                           wall + "\n" + slip) +
              "velocity all set 0.6 -0.4 0\nrun 40\n");
    const double *const e = run.compute_vector();
    EXPECT_GT(run.fix("mix")->compute_scalar(), 1.0e-4);
    EXPECT_LT(fabs(measured("residual", e[10] / e[0])), 1.0e-12) << wall;
  }
}

TEST(Slump, IsTheSameWithBalance)
{
  OnRanks run(slump(2) + stuff, "run 80\n", "comm_style tiled\nfix lb all balance 20 1.0 rcb\n");
  EXPECT_LT(measured("difference", run.difference()), 1e-11);
}

// By whole cells: soil and water are on both sides of the periodic faces then
TEST(Slump, IsTheSameAcrossPeriodicFaces)
{
  Scene inside(slump(2) + stuff + "run 60\n"),
      across(slump(2) + stuff + "displace_atoms all move 6 0 0\nrun 60\n");
  for (int k = 0; k < 6; k++)
    EXPECT_NEAR(inside.fix_vector("mix", 6)[k], across.fix_vector("mix", 6)[k], 1e-12);
  EXPECT_NEAR(inside.fix("mix")->compute_scalar(), across.fix("mix")->compute_scalar(), 1e-13);
}

// While soil and water are apart, nodes are those of two fields; the ledger has long records
TEST(Apart, CostsNothingAndChangesNothing)
{
  const std::string fields = "fix s soil mpm 1.0\nfix w water mpm 1.0\n";
  const std::string scene = box(2, "lj", "p f p", "0 8 0 24", 2, 0.3) +
      "group soil empty\ngroup water empty\n" + fields +
      "region heap block 2 5 18 20 INF INF\nregion pool block INF INF 0 2 INF INF\n"
      "create_points 1 region heap ppc 2 fix s group soil\n"
      "create_points 2 region pool ppc 2 fix w group water\nvelocity soil set 0 -5 0\n";
  const std::string rest = replaced(stuff, "compute e all mpm/energy\n", "");
  Twins late(scene + rest, 60, fields + rest, 120, 1.0e-9);
  Twins early(scene + rest, 150, fields + rest, 30, 1.0e-9);
  EXPECT_GT(fabs(late.whole.fix_vector("mix", 6)[4]), 1.0e-3);    // they have met
  EXPECT_LT(difference(late.whole.gather(), early.whole.gather()), 1e-12);

  OnRanks ledger(scene + stuff, "run 180\n");
  EXPECT_LT(measured("difference", difference(ledger.parallel.gather(), late.whole.gather())),
            1e-11);

  Scene apart(scene + rest + "run 60\n");
  EXPECT_EQ(apart.grid("s").nreal, 4);
  EXPECT_EQ(apart.grid("w").nreal, 4);
  apart.commands("run 120\n");
  EXPECT_EQ(apart.grid("s").nreal, 8);
  EXPECT_EQ(apart.grid("w").nreal, 8);
}

// Without a floor, momentum is that of gravity alone
SERIAL_TEST(Slump, KeepsMomentum)
{
  for (const std::string options :
       {"transfer apic", "transfer flip 1.0 scheme musl", "transfer aflip 1.0 shape cubic"}) {
    const std::string free = replaced(replaced(stuff, "fix floor all mpm/boundary ylo slip\n", ""),
                                      "fix g all gravity 0.2 vector 0 -1 0\n", "");
    Scene run(slump(2, options) + free + "displace_atoms all move 0 1 0\n");
    run.set_velocity([&](const double *x, double *v) {
      v[0] = 0.2 * sin(x[1]);
      v[1] = 0.1 * cos(x[0]);
    });
    for (int i = 0; i < run.n(); i++)
      if (run.lmp->atom->type[i] == 1) run.v()[i][0] += 0.5;
    const auto before = run.sums();
    run.commands("run 50\n");
    const auto after = run.sums();
    EXPECT_GT(fabs(run.fix_vector("mix", 6)[0]), 1.0e-3);
    for (int d = 0; d < 2; d++)
      EXPECT_NEAR(after.p[d], before.p[d], 2e-14 * before.mass) << options;
    EXPECT_LT(fabs(run.compute_vector()[10]), 1.0e-12 * before.kinetic) << options;
  }
}

// Rate of the drag in units where that of pressure is not that of mass, length and time
SERIAL_TEST(Units, OfTheViscosityAreThoseOfPressure)
{
  Scene run(plane("metal", "p p", "0 4 0 4", 2, 0.3) +
            "group soil type 1\ngroup water type 2\nfix s soil mpm 1.0\nfix w water mpm 1.0\n"
            "create_points 1 box ppc 2 fix s group soil\n"
            "create_points 2 box ppc 2 fix w group water share 0.4\n"
            "fix ms soil mpm/material density 1.2 linear 1.0e4 0.3\n"
            "fix mw water mpm/material density 0.6 eos linear 1.0e4\n"
            "fix mix all mpm/mixture s w 2.0 10.0 drag darcy 2.0\ntimestep 0.01\n"
            "velocity water set 1.0 0 0\nrun 10\n");
  // 1 bar is 1e5 Pa, and 1 g/mol/(A ps^2) is 1e-3/6.02214076e23 kg / (1e-10 m 1e-24 s^2)
  const double bar = 1.0e5 / (1.0e-3 / 6.02214076e23 / 1.0e-34);
  const double rate = 0.4 * 0.4 * 10.0 * bar / 2.0 * (1.0 / 1.2 + 1.0 / 0.24);
  double v[2];
  for (int i = 0; i < run.n(); i++) v[run.lmp->atom->type[i] - 1] = run.v()[i][0];
  EXPECT_NEAR((v[1] - v[0]) / exp(-rate * 0.1), 1.0, 3e-9);

  const double before = run.sums(1).p[0];
  run.commands("run 1\n");
  const double given = (run.sums(1).p[0] - before) / (0.01 * run.lmp->force->ftm2v);
  EXPECT_NEAR(run.fix_vector("mix", 6)[0] / given, 1.0, 1e-12);
}

// Soil in half of a periodic box full of water, whose pressure is not uniform: the soil gets the
// share of the volume of its grains of the difference between its ends, and energy is kept, where
// mass velocity^2 is no energy and pressure times volume neither.
SERIAL_TEST(Units, OfForcesAndEnergy)
{
  for (const std::string drag : {"none", "darcy 2.0"}) {
    Scene run(plane("metal", "p p", "0 16 0 4", 2, 0.3) +
              "group soil empty\ngroup water empty\nfix s soil mpm 0.5\nfix w water mpm 0.5\n"
              "region half block 4 12 INF INF INF INF\n"
              "region rest block 4 12 INF INF INF INF side out\n"
              "create_points 1 region half ppc 2 fix s group soil\n"
              "create_points 2 region half ppc 2 fix w group water share 0.4\n"
              "create_points 2 region rest ppc 2 fix w group water\n"
              "fix ms soil mpm/material density 1.2 linear 1.0e4 0.3\n"
              "fix mw water mpm/material density 0.6 eos linear 1.0e4\n"
              "fix mix all mpm/mixture s w 2.0 10.0 drag " +
              drag + "\ncompute e all mpm/energy\ntimestep 0.001\nrun 0\n");
    const double P = 20.0, k = 2.0 * PI / 16.0;
    for (int i = 0; i < run.n(); i++)
      if (run.lmp->atom->type[i] == 2)
        set_pressure(run, i, P * sin(k * (run.x()[i][0] - 8.0)), 1.0e4);
    run.commands("run 1\n");
    const auto before = run.sums(1);
    run.commands("run 1\n");
    const double *const mix = run.fix_vector("mix", 6);
    const double given = (run.sums(1).p[0] - before.p[0]) / (0.001 * run.lmp->force->ftm2v);
    EXPECT_NEAR((mix[0] + mix[3]) / given, 1.0, 1e-12) << drag;
    EXPECT_NEAR(measured("pressure", mix[3] / (-0.6 * 2.0 * P * 4.0 / run.lmp->force->nktv2p)), 1.0,
                0.03)
        << drag;
    run.commands("run 200\n");
    const auto all = run.sums();
    const double *const e = run.compute_vector();
    EXPECT_GT(all.kinetic, 0.0);
    EXPECT_LT(fabs(measured("momentum", all.p[0] / sqrt(all.mass * all.kinetic))), 1e-12);
    EXPECT_LT(fabs(measured("residual", e[10] / (all.kinetic * run.lmp->force->mvv2e))), 1e-11);
  }
}

// The fastest of all points limits the time step and is named, here one of compressed water.
TEST(TimeStep, IsThatOfTheFastestPoint)
{
  for (const int fastest : {70, 84, 120}) {
    Scene run(slump(2) + replaced(stuff, "timestep 0.02", "timestep 1.0e-6") + "run 1\n");
    for (int i = 0; i < run.n(); i++)
      if (run.lmp->atom->tag[i] == fastest)
        for (int k = 0; k < 9; k += 4) run.points().F[i][k] = 0.97;
    run.commands("fix step all mpm/dt 0.3\nrun 0\n");
    EXPECT_EQ(run.fix_vector("step", 1)[0], fastest);
  }
}

// Soil and what is in its pores are at the same place; two of the same kind are a mistake.
SERIAL_TEST(Share, IsNoOverlapWithTheSoilAlone)
{
  const std::string fields = box(2, "lj", "p f p", "0 10 0 8", 2, 0.3) +
      "group soil empty\ngroup water empty\nfix s soil mpm 1.0\nfix w water mpm 1.0\n"
      "region heap block 2 5 0 5 INF INF\n";
  const std::string soil = "create_points 1 region heap ppc 2 fix s group soil\n",
                    water = "create_points 2 region heap ppc 2 fix w group water share 0.5\n";
  Scene fine(fields + soil + water);
  EXPECT_EQ(fine.n(), 120);
  expect_error(fields + soil + water + water, "refuses overlapping bodies: 60 existing");
  expect_error(fields + soil + water + soil, "refuses overlapping bodies: 120 existing");
  expect_error(fields + water + soil, "make the soil first");
  expect_error(fields + soil + soil, "refuses overlapping bodies: 60 existing");
  Scene allowed(fields + soil + water + replaced(water, "\n", " overlap yes\n"));
  EXPECT_EQ(allowed.n(), 180);

  // in no field yet: by type
  const std::string free_soil = replaced(soil, " group soil", ""),
                    free_water = replaced(water, " group water", "");
  Scene later(fields + free_soil + free_water);
  EXPECT_EQ(later.n(), 120);
  expect_error(fields + free_soil + free_water + free_water, "refuses overlapping bodies: 60");
  expect_error(fields + free_soil + replaced(free_water, "create_points 2", "create_points 1"),
               "refuses overlapping bodies: 60");
}

// water that has another share of its places than the pores have: too much of it is told. Water
// above the bed, or beside it, and places of points by chance are no reason
SERIAL_TEST(Share, ThatIsNotThePorosityIsTold)
{
  const auto told = [](const std::string &scene, const char *share, double height) {
    return times_said(replaced(scene, height > 0.0 ? "share 0.4" : "share 0.5", share) +
                          "timestep 1e-6\nrun 2\n",
                      "times the volume of the pores");
  };
  for (const double height : {0.3, 0.5, 0.9})
    for (const double offset : {0.0, 0.3}) {
      const auto scene = bed(2, 0.1, height, "", offset);
      for (const char *share : {"share 0.1", "share 0.4", "share 0.45"})
        EXPECT_EQ(told(scene, share, height), 0);
      for (const char *share : {"share 0.6", "share 0.9"}) EXPECT_EQ(told(scene, share, height), 1);
    }
  for (const char *share : {"share 0.3", "share 0.5"})
    EXPECT_EQ(told(slump(2) + stuff, share, 0.0), 0);
}

SERIAL_TEST(Mixture, RefusesBadInput)
{
  expect_error(bed(2, 0.1, 0.9, "", 0.0) + "mpm_geostatic w 0.5\n", "name that of the soil, s");
  expect_error(bed(2, 0.1, 0.9, "", 0.0) + "delete_atoms group water\nmpm_geostatic s 0.5\n",
               "has no points of water");
  // what carries nothing like its own weight
  expect_error(replaced(bed(2, 0.1, 0.9, "", 0.0), strprintf("eos linear %.17g", Column().K),
                        "eos linear 1e3") +
                   "mpm_geostatic s 0.5\n",
               "does not have the pressure at rest");
  const std::string good =
      slump(2) + replaced(replaced(stuff, "fix mix all", "#"), "compute e", "#");
  const std::string fix = "fix mix all mpm/mixture ";
  expect_refused(good,
                 {{"fix mix soil mpm/mixture s w 2.5 0.01", "use group all"},
                  {fix + "s s 2.5 0.01", "needs two fields"},
                  {fix + "s x 2.5 0.01", "x is not the ID of a fix mpm"},
                  {fix + "s w 0 0.01", "density of the grains must be positive"},
                  {fix + "s w 2.5", "missing argument"},
                  {fix + "s w 2.5 0 drag ergun 0.1", "positive viscosity"},
                  {fix + "s w 2.5 0.01 drag darcy 1.0 1.0", "above 0 and below 1"},
                  {fix + "s w 2.5 0.01 drag stokes 1.0", "drag"},
                  {fix + "w s 2.5 0.01", "are no fluid"},
                  {fix + "s w 2.5 0.01\nfix two all mpm/mixture s w 2.5 0.01", "in common"},
                  {fix + "s w 2.5 0.01\nfix c all mpm/contact s w", "keeps the water out"},
                  {fix +
                       "s w 2.5 0.01\npair_style mpm/penalty\npair_coeff * * 0.0\n"
                       "pair_coeff 1 2 1.0",
                   "pair_coeff with modulus 0"},
                  {fix + "s w 2.5 0.01\nfix p all mpm/pore 200 1 10 soil ms 0.5 constant 1.0",
                   "fix mpm/pore p has water in the pores of ms already"},
                  {fix + "s w 1.0 0.01", "that of dry soil"}},
                 "run 1\n");
  for (const Mistake &mistake : {Mistake{"shape linear", "shape quadratic or cubic"},
                                 {"scheme usf", "usl or musl"},
                                 {"transfer xpic 2", "apic, aflip, or flip"},
                                 {"locking fbar", "use smooth"},
                                 {"frame total", "frame updated"},
                                 {"edges modified", "edges plain"}})
    expect_error(slump(2, mistake.lines) + stuff + "run 1\n", mistake.message);
  expect_error(replaced(slump(2), "fix w water mpm 1.0", "fix w water mpm 0.5") + stuff + "run 1\n",
               "same lattice");
  expect_error(replaced(slump(2), "share 0.5", "share 0") + stuff, "must be positive");
}
