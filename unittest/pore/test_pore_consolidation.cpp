// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// timeout: 600

// Fix mpm/pore: consolidation in which soil changes pressures elsewhere. The soil has modulus,
// density, and size 1, and consolidates slowly next to waves.

#include "pore/pore_testing.h"

using namespace MPM_TEST;

/** Steps of this part of the limit change the results by 1e-4 of them. */
constexpr double LONG = 0.8;

/** Young's modulus of a soil whose modulus is 1 if it cannot widen. */
double young(double nu)
{
  return (1.0 + nu) * (1.0 - 2.0 * nu) / (1.0 - nu);
}

/** Soil, damped, that consolidates as slowly as waves cross 1/slow of it; stiffness of water. */
struct Clay {
  double nu, stiff, slow;

  double rate() const
  {
    return 1.0 / (slow * (1.0 + 1.0 / stiff));
  }    // coefficient of consolidation
  double bulk() const { return young(nu) / (3.0 * (1.0 - 2.0 * nu)); }
  double shear() const { return young(nu) / (2.0 * (1.0 + nu)); }
  std::string material() const
  {
    return strprintf("density 1.0 linear %.17g %.17g", young(nu), nu);
  }
  std::string water(const std::string &drained) const
  {
    return strprintf("fix water all mpm/pore %.17g 1e-9 1.0 soil m 0.5 constant %.17g %s\n",
                     0.5 * stiff, 1.0 / slow, drained.c_str());
  }
  std::string damping(double mass) const
  {
    return strprintf("fix damp all viscous %.17g\n", 2.0 * mass);
  }
};

/** Pressure of the points in a box with this side at the origin. */
double at_origin(Water &water, double side)
{
  const double *const p = water.pressures();
  double sum = 0.0, n = 0.0;
  for (int i = 0; i < water.run.n(); i++) {
    const double *const x = water.run.x()[i];
    if (x[0] > side || x[1] > side || (water.run.dim() == 3 && x[2] > side)) continue;
    sum += p[i];
    n++;
  }
  return sum / n;
}

/** Values of a table at time factors. */
struct At {
  double T, value;
};

// Mandel: a strip between rigid smooth plates which are pressed together, drained at its sides. The
// pressure in its middle rises first, as the sides become stiffer there. A quarter of the strip;
// the plate is a damper: its velocity is the missing force over the resistance
struct Strip {
  double nu, peak;
  std::vector<At> decay;
  std::string more;
};
PARAMETER_TEST(
    Mandel, PressureRisesFirst, Strip,
    Values(Strip{0.2, 1.106897, {{0.1, 1.095414}, {0.2, 0.968114}, {0.5, 0.592785}}},
           Strip{1.0 / 3.0, 1.065056, {{0.1, 1.043109}, {0.2, 0.895613}, {0.5, 0.503593}}},
           Strip{
               0.2, 1.106897, {{0.1, 1.095414}, {0.2, 0.968114}, {0.5, 0.592785}}, " every auto"}))
{
  LONG_AFTER(1);
  const Strip strip = GetParam();
  const Clay clay = {strip.nu, 50.0, 800.0};
  const int n = 16;
  const double h = 1.0 / n, ramp = 0.01, F = 1e-3, c = clay.rate();
  Scene run(
      plane("lj", "f f", strprintf("0 1 0 %.17g", 3 * h), 1, 0.3 * h) +
      strprintf("fix grid all mpm %.17g\ncreate_points 1 box ppc 2\n", h) +
      "fix m all mpm/material " + clay.material() + "\nfix sides all mpm/boundary xlo ylo slip\n" +
      strprintf("variable T equal %.17g*time/%g\n", c, ramp) +
      strprintf("variable F equal %g*0.5*(1-cos(PI*((v_T<1)*v_T+(v_T>=1))))\n", F) +
      strprintf("variable v equal (f_plate[2]-v_F)/%.17g\n", 3.0 * std::sqrt(1.0 + clay.stiff)) +
      "fix plate all mpm/boundary yhi slip velocity 0 v_v 0\n" +
      clay.water("xhi pressure 0" + strip.more) + clay.damping(0.25 * h * h));
  Water water(run);
  // undrained pressure of water and soil under F (Skempton's coefficient, Poisson's number)
  const double Ku = clay.bulk() + clay.stiff, B = clay.stiff / Ku,
               nu_u = (3.0 * Ku - 2.0 * clay.shear()) / (2.0 * (3.0 * Ku + clay.shear()));
  const double p0 = F * B * (1.0 + nu_u) / 3.0;
  const auto pressure = [&](double T) {
    run_until(run, (T + 0.5 * ramp) / c, LONG);
    return at_origin(water, 0.5 * h) / p0;
  };
  double peak = 0.0;
  for (const double T : {0.05, 0.06, 0.065, 0.07, 0.075, 0.08, 0.09})
    peak = std::max(peak, pressure(T));
  EXPECT_NEAR(measured("peak", peak) / strip.peak, 1.0, 0.01);
  for (const auto &at : strip.decay) {
    if (at.T > 0.1 && is_quick()) return;    // takes long
    EXPECT_NEAR(measured(strprintf("T %g", at.T), pressure(at.T)) / at.value, 1.0, 0.02);
  }
  EXPECT_NEAR(measured("force on the plate", run.fix_vector("plate", 2)[1] / F), 1.0, 0.002);
}

// Cryer: a sphere under pressure from all sides, drained at its curved surface. Less the state of
// one pressure everywhere, in which nothing flows, this is a sphere without load around which the
// pressure of the water is lowered: first it rises in the middle. An eighth of the sphere
PARAMETER_TEST(Cryer, PressureRisesFirst, const char *, Values("", " every auto"))
{
  LONG_CASE();
  const Clay clay = {0.2, 50.0, 200.0};
  const int n = 12;
  const double h = 1.0 / n, P = 1e-3, c = clay.rate(), L = 1.0 + 1.5 * h;
  Scene run(space("lj", "f f f", strprintf("0 %.17g 0 %.17g 0 %.17g", L, L, L), 1, 0.3 * h) +
            "region ball sphere 0 0 0 1\n" + strprintf("fix grid all mpm %.17g\n", h) +
            "create_points 1 region ball ppc 2 outside ignore\nfix m all mpm/material " +
            clay.material() + "\nfix sides all mpm/boundary xlo ylo zlo slip\n" +
            clay.water(strprintf("free pressure %g%s", -P, GetParam())) +
            clay.damping(0.125 * h * h * h));
  Water water(run);
  const auto pressure = [&](double T) {
    run_until(run, T / c, LONG);
    return 1.0 + at_origin(water, 0.5 * h) / P;
  };
  double peak = 0.0;
  for (const double T : {0.045, 0.05, 0.055, 0.06, 0.065}) peak = std::max(peak, pressure(T));
  EXPECT_NEAR(measured("peak", peak) / 1.36426, 1.0, 0.03);
  for (const auto &at : {At{0.1, 1.194103}, At{0.2, 0.681727}})
    EXPECT_NEAR(measured(strprintf("T %g", at.T), pressure(at.T)) / at.value, 1.0, 0.02);
}

/** A column of large strain: stress over modulus, permeability over that at first, at a stretch. */
struct Large {
  const char *name;
  double q;    // load
  double n0;
  struct Laws {
    std::string soil, permeability;    // in words of the input
    std::function<double(double)> stress, flows;
  } laws;
  int cells;
  std::vector<double> times;
  struct Table {
    std::vector<double> settlement, pressure;    // at the base, over the load
  } table;
  std::string shape = "quadratic";
};

/** Settlement and pressure at the base by finite volumes, at times in ascending order: d(l)/dt + (l
 *  n/K) dp/dt = d/dX(k/l dp/dX) with the stretch l, the volume l n = l - (1 - n0) of water with the
 *  bulk modulus K (infinite with water = 0), and p = q - stress. Loaded without time for flow, or
 *  in a time, ramp, as by load(), and times from its middle on. */
std::vector<std::array<double, 3>> finite_volumes(const Large &column, double water,
                                                  double ramp = 0.0)
{
  constexpr int N = 100;
  constexpr double H = 1.0 / N, EPS = 1e-6;
  double q = column.q;    // at present
  const auto pressure = [&](double l) {
    return q - column.laws.stress(l);
  };
  const auto drained = [&] {
    return root_of(0.3, 1.0, [&](double l) {
      return column.laws.stress(l) - q;
    });
  };
  const double whole = drained();
  double last = whole, growth = 0.0;    // of the load
  const double first = ramp > 0.0 ? 1.0 : root_of(0.3, 1.0, [&](double l) {
    return column.n0 * std::exp(-water * pressure(l)) - (l - 1.0 + column.n0);
  });
  std::vector<double> stretch(N, first), p(N), c(N), takes(N), flux(N + 1, 0.0);
  std::vector<std::array<double, 3>> out;
  double t = 0.0;
  for (const double time : column.times) {
    const double end = time + 0.5 * ramp;
    while (t < end) {
      if (ramp > 0.0) {
        const double part = std::min(1.0, t / ramp);
        q = 0.5 * column.q * (1.0 - std::cos(PI * part));
        growth = 0.5 * column.q * PI / ramp * std::sin(PI * part);
        last = part < 1.0 ? drained() : whole;
      }
      double fastest = 0.0;
      for (int i = 0; i < N; i++) {
        const double l = stretch[i];
        p[i] = pressure(l);
        c[i] = column.laws.flows(l) / l;
        const double slope = (pressure(l + EPS) - p[i]) / EPS;
        takes[i] = 1.0 + water * (l - 1.0 + column.n0) * slope;
        fastest = std::max(fastest, c[i] * slope);
      }
      const double top = column.laws.flows(last) / last;
      flux[0] = p[0] / (0.5 * H) * 2.0 / (1.0 / c[0] + 1.0 / top);
      for (int i = 1; i < N; i++)
        flux[i] = (p[i] - p[i - 1]) / H * 2.0 / (1.0 / c[i] + 1.0 / c[i - 1]);
      const double dt = std::min(end - t, 0.25 * H * H / fastest);
      for (int i = 0; i < N; i++) {
        const double pores = stretch[i] - 1.0 + column.n0;
        stretch[i] += dt * ((flux[i + 1] - flux[i]) / H - water * pores * growth) / takes[i];
      }
      t += dt;
    }
    double mean = 0.0;
    for (const double l : stretch) mean += l / N;
    out.push_back({time, 1.0 - mean, pressure(stretch[N - 1]) / column.q});
  }
  return out;
}

double hencky(double l)
{
  return -std::log(l) / l;
}
double neohooke(double l)    // Poisson's number 0.3
{
  const double mu = young(0.3) / 2.6, lambda = 1.0 - 2.0 * mu;
  return -(mu * (l - 1.0 / l) + lambda * std::log(l) / l);
}
double constant(double)
{
  return 1.0;
}
double squared(double l)
{
  return l * l;
}
double kozeny(double l)    // initial porosity 0.5
{
  const double n = 2.0 * l - 1.0;
  return n * n * n / l;
}

const char *const LINEAR = "linear 1.0 0.0";    // Kirchhoff stress logarithmic in the stretch
const std::string NH = strprintf("neohookean %.17g 0.3", young(0.3));
const Large::Laws SQUARED = {LINEAR, "squared", hencky, squared},
                  CONSTANT = {LINEAR, "constant", hencky, constant},
                  KOZENY = {LINEAR, "kozeny", hencky, kozeny},
                  NH_SQUARED = {NH, "squared", neohooke, squared},
                  NH_CONSTANT = {NH, "constant", neohooke, constant};
const std::vector<double> ALL = {0.05, 0.1, 0.2, 0.5, 1.0}, EARLY = {0.05, 0.1};
const Large::Table SQUARED_02 = {{0.043494, 0.061510, 0.086834, 0.129075, 0.150475},
                                 {0.996783, 0.947665, 0.760760, 0.320468, 0.062965}};
const Large::Table SQUARED_05 = {{0.092101, 0.130248, 0.183627, 0.264878, 0.293418},
                                 {0.996659, 0.945235, 0.742959, 0.251277, 0.026521}};
const Large::Table NEO_HOOKE = {{0.124141, 0.175551, 0.246085, 0.324689, 0.333743},
                                {0.993235, 0.893167, 0.558205, 0.065147, 0.000985}};
const Large::Table NEO_HOOKE_SQUARED = {{0.095397, 0.134911, 0.190432, 0.282052, 0.325526},
                                        {0.997137, 0.953146, 0.780342, 0.334583, 0.058973}};

void PrintTo(const Large &column, std::ostream *out)
{
  *out << column.name;
}

// Consolidation by loads of 0.2, 0.5, and 1 modulus of the soil, against finite volumes with the
// same water, and load, which grows in a short time: both shift what comes late, where the pressure
// at the base is less than one percent of the load, by up to 1 %, and so does the inertia of soil
// of more weight. Rows of the benchmark's table, stiff water and a load at once, check the volumes.
// The load is on the two upper rows of points in such parts that its place is the surface. The
// permeability of Kozeny and Carman falls to 1/10 within a cell of the surface
PARAMETER_TEST(
    LargeStrain, Consolidates, Large,
    Values(Large{"logarithmic, k J^2, 0.2", 0.2, 0.5, SQUARED, 20, ALL, SQUARED_02},
           Large{"logarithmic, k J^2, 0.5", 0.5, 0.5, SQUARED, 20, ALL, SQUARED_05},
           Large{"logarithmic, k J^2, 1", 1.0, 0.7, SQUARED, 20, ALL},
           Large{"logarithmic, constant k, 0.5", 0.5, 0.5, CONSTANT, 20, ALL},
           Large{"logarithmic, Kozeny and Carman, 0.5, 10 cells", 0.5, 0.5, KOZENY, 10, ALL},
           Large{"logarithmic, Kozeny and Carman, 0.5", 0.5, 0.5, KOZENY, 20, ALL},
           Large{"logarithmic, Kozeny and Carman, 0.5, 40 cells", 0.5, 0.5, KOZENY, 40, EARLY},
           Large{"neo-Hooke, constant k, 0.5", 0.5, 0.5, NH_CONSTANT, 20, ALL, NEO_HOOKE},
           Large{"neo-Hooke, constant k, 0.5, cubic", 0.5, 0.5, NH_CONSTANT, 20, ALL, {}, "cubic"},
           Large{"neo-Hooke, k J^2, 0.5", 0.5, 0.5, NH_SQUARED, 20, ALL, NEO_HOOKE_SQUARED}))
{
  LONG_CASE();
  const Large &soil = GetParam();
  constexpr double BULK = 200.0;    // of the water, in moduli of the soil
  const int n = soil.cells;
  const double h = 1.0 / n, ramp = 0.004;
  const auto incompressible = finite_volumes(soil, 0.0);
  const auto exact = finite_volumes(soil, 1.0 / BULK, ramp);
  for (std::size_t k = 0; k < soil.table.settlement.size(); k++) {
    EXPECT_NEAR(incompressible[k][1], soil.table.settlement[k], 2e-4);
    EXPECT_NEAR(incompressible[k][2], soil.table.pressure[k], 2e-4);
  }
  Scene run(replaced(column(n,
                            strprintf("%g 1e-9 1.0 soil m %g %s 1.0 free pressure 0", BULK, soil.n0,
                                      soil.laws.permeability.c_str()),
                            "density 2.5e-4 " + soil.laws.soil),
                     "origin", "shape " + soil.shape + " origin") +
            load(n, 1.5 * soil.q, ramp) +
            strprintf("region next block INF INF %.17g %.17g INF INF\ngroup next region next\n",
                      1.0 - h, 1.0 - 0.5 * h) +
            "variable up equal v_q/3*lx/count(next)\nfix up next addforce 0 v_up 0\n");
  Water water(run);
  run.commands("compute n all mpm/atom porosity\n");
  for (const auto &at : exact) {
    run_until(run, at[0] + 0.5 * ramp, LONG);
    double volume = 0.0;
    auto *compute = run.per_atom("n");
    for (int i = 0; i < run.n(); i++) {
      const double J = run.points().jacobian(i);
      volume += J * run.lmp->atom->vfrac[i];
      EXPECT_NEAR(compute->vector_atom[i], 1.0 - (1.0 - soil.n0) / J, 1e-14);
    }
    const auto name = strprintf("T %g, over the reference: ", at[0]);
    EXPECT_NEAR(measured(name + "settlement", (1.0 - volume * n / 4.0) / at[1]), 1.0, 0.02);
    // of the last part of the load, quadratic functions do not tell where between nodes it is
    const double base = water.mean(0.0, 0.5 / n) / soil.q;
    measured(name + "pressure at the base", base / at[2]);
    EXPECT_NEAR(base, at[2], 0.02 * std::max(at[2], soil.shape == "cubic" ? 0.0 : 0.004));
  }
}

/** Pressure over that at the base at first, and degree of consolidation by own weight. */
double of_weight(double z, double T)
{
  double sum = 0.0;
  for (int m = 0; m < 2000; m++) {
    const double M = (2 * m + 1) * PI2;
    sum += (m % 2 ? -2.0 : 2.0) / (M * M) * std::sin(M * z) * std::exp(-M * M * T);
  }
  return sum;
}

/** Volume of all points, and, [n], volume of water that a point takes up for a unit of pressure. */
double volumes(Scene &run, double Kf, std::vector<double> &storage)
{
  double sum = 0.0;
  storage.resize(run.n());
  for (int i = 0; i < run.n(); i++) {
    const double V0 = run.lmp->atom->vfrac[i], V = V0 * run.points().jacobian(i);
    storage[i] = (V - 0.6 * V0) / Kf;
    sum += V;
  }
  return sum;
}

// A column that consolidates under its own weight. The water that has left is the settlement, and
// what the water in the pores gets of its volume when its pressure falls
SERIAL_TEST(SelfWeight, Consolidates)
{
  LONG_CASE();
  const int n = 20;
  const double Kf = 2.2e8, c = 1e-3 / 9810.0 / (1.0 / MODULUS + 0.4 / Kf), weight = 1002 * 9.81;
  for (const double offset : {0.0, 0.3}) {
    Scene run(replaced(column(n,
                              strprintf("%g 1000 9810 soil m 0.4 constant 1e-3 initial v_p "
                                        "free pressure 0",
                                        Kf),
                              SOIL, 1.2, offset),
                       "fix water",
                       "fix g all gravity 9.81 vector 0 -1 0\n"
                       "variable p atom 2002*9.81*(1-y)\nfix water"));
    Water water(run);
    run.commands("fix dt all mpm/dt 0.5\nrun 0\n");
    std::vector<double> before, after, p(run.n());
    const double whole = volumes(run, Kf, before), area = 4.0 / n;
    std::copy_n(water.pressures(), run.n(), p.begin());
    double expanded = 0.0, from = 0.0;
    for (const auto &[T, U, base] :
         {std::array{0.05, 0.099956, 0.747687}, std::array{0.1, 0.197746, 0.643177},
          std::array{0.2, 0.370386, 0.495912}, std::array{0.5, 0.699455, 0.236050}}) {
      EXPECT_NEAR(of_weight(1.0, T), base, 1e-6);
      double volume = 0.0;
      constexpr int PARTS = 50;
      for (int k = 1; k <= PARTS; k++) {
        run_until(run, (from + (T - from) * k / PARTS) / c, LONG);
        volume = volumes(run, Kf, after);
        const double *const now = water.pressures();
        for (int i = 0; i < run.n(); i++) {
          expanded -= 0.5 * (before[i] + after[i]) * (now[i] - p[i]);
          p[i] = now[i];
        }
        before = after;
      }
      from = T;
      const double settled = (whole - volume) / area,
                   out = -run.fix("water")->compute_scalar() / area;
      const auto name = strprintf("offset %g, T %g: ", offset, T);
      EXPECT_NEAR(measured(name + "U", settled / (0.5 * weight / MODULUS)) / U, 1.0, 0.01);
      const double excess = water.mean(0.0, 0.5 / n) - 9810.0 * (1.0 - 0.25 / n);
      EXPECT_NEAR(measured(name + "base", excess / weight) / of_weight(1.0 - 0.25 / n, T), 1.0,
                  0.01);
      EXPECT_NEAR(measured(name + "water out", (out - expanded / area) / settled), 1.0, 1e-8);
    }
  }
}
