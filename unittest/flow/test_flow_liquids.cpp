// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 3 4

// Liquids of several densities and viscosities in fix mpm/incompressible: layers at rest, that turn
// over, and that are sheared; waves; bodies between them; inflow.

#include "wave_testing.h"

#include "group.h"

#include <Eigen/Dense>

using namespace MPM_TEST;

enum { ITERATIONS = 0, FILLED = 3, KINETIC = 5, FASTEST = 6, YLO = 9, STRESS = 13 };

/** A closed square of two layers with the interface a cos(pi x), the lower one of density below. */
std::string layers(int n, double below, double above, double a)
{
  const double s = 2.0 * std::sinh(PI / 2);
  return plane("si", "f f", "0 1 0 1", 1, 0.01) +
      strprintf("create_points 1 box spacing %.17g\n", 0.5 / n) +
      "region low block INF INF INF 0.5 INF INF\ngroup low region low\ngroup high subtract all "
      "low\nvariable low atom y<0.5\nvariable z atom v_low*y+(1-v_low)*(1-y)\n" +
      strprintf("variable up atom %.17g*cos(PI*x)*(exp(PI*v_z)-exp(-PI*v_z))\n", a / s) +
      strprintf("variable side atom %.17g*sin(PI*x)*(1-2*v_low)*(exp(PI*v_z)+exp(-PI*v_z))\n",
                a / s) +
      "displace_atoms all move v_side v_up 0\n" +
      strprintf("fix w all mpm/incompressible %.17g %.17g reflect 0.8 liquid high %.17g\n", 1.0 / n,
                below, above) +
      "fix g all gravity 9.81 vector 0 -1 0\n";
}

/** Circular frequency of the interface; imaginary, if the heavy liquid is above. */
double frequency(double below, double above)
{
  return std::sqrt(9.81 * PI * std::fabs(below - above) / (below + above) * std::tanh(PI / 2));
}

double amplitude(Scene &run)    // of the lower liquid
{
  const int low = run.lmp->group->bitmask[run.lmp->group->find("low")];
  double sum = 0.0;
  for (int i = 0; i < run.n(); i++)
    if (run.lmp->atom->mask[i] & low) sum += run.x()[i][1] * std::cos(PI * run.x()[i][0]);
  return sum;
}

/** Frequency of a wave over theory, from two times at which it is flat. */
double wave(int n, double below, double above)
{
  const double w = frequency(below, above), dt = 2.0 * PI / (200.0 * w);
  Scene run(layers(n, below, above, 0.02) + strprintf("timestep %.17g\n", dt));
  Crossings flat;
  run.each_step([&](double **) {
    flat.add(run.time(), amplitude(run));
  });
  run.commands("run 165\n");
  EXPECT_EQ(flat.times.size(), 2u);
  return measured(strprintf("%d cells, %g to %g: frequency over theory", n, below, above),
                  flat.frequency() / w);
}

/** Two layers between plates that are 1 apart, one of which is as thick as so many of n cells. */
struct Layers {
  int n, dim, axis;    // axis: across the layers
  double thickness;
  double mu[2], rho[2];

  double interface() const { return thickness / n; }
  int flow() const { return axis ? 0 : 1; }    // axis of the flow
  std::string scene(const std::string &options, const std::string &wall = "") const
  {
    const char *const faces[3][3] = {{}, {}, {"f p", "p f"}};
    const auto wide = strprintf("0 %.17g", 4.0 / n);
    const char upper = axis ? 'y' : 'x';
    std::string text =
        box(dim, "si", dim == 2 ? faces[2][axis] : std::string(faces[2][axis]) + " p",
            (axis ? wide + " 0 1" : "0 1 " + wide) +
                (dim == 3 ? strprintf(" 0 %.17g", 2.0 / n) : ""),
            1, 0.02) +
        strprintf("create_points 1 box spacing %.17g\n", (dim == 3 ? 0.5 : 0.25) / n) +
        strprintf("variable up atom %c>%.17g\ngroup up variable up\n", upper, interface());
    text += strprintf("fix w all mpm/incompressible %.17g %.17g viscosity %.17g liquid up %.17g "
                      "%.17g wall %clo stick wall %chi stick ",
                      1.0 / n, rho[0], mu[0], rho[1], mu[1], upper, upper);
    return text + wall + " " + options + "\n";
  }
  /** Velocity of the steady flow at y with this stress at the lower plate and weight along them. */
  double steady(double y, double stress, double g) const
  {
    const double low = std::min(y, interface()), more = y - low, above = stress - rho[0] * g * low;
    return (stress * low - 0.5 * rho[0] * g * low * low) / mu[0] +
        (above * more - 0.5 * rho[1] * g * more * more) / mu[1];
  }
  /** Root mean square of the error of velocities over that of the velocities, for this speed of the
   *  upper plate; and the largest error of shear stresses over that at the lower plate. */
  std::array<double, 2> errors(Scene &run, double speed, double g) const
  {
    const double at_rest = steady(1.0, 0.0, g),
                 stress = (speed - at_rest) / (steady(1.0, 1.0, g) - at_rest);
    double sum = 0.0, square = 0.0, worst = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const double y = run.x()[i][axis], exact = steady(y, stress, g);
      sum += std::pow(run.v()[i][flow()] - exact, 2);
      square += exact * exact;
      const double here = stress -
          g * (rho[0] * std::min(y, interface()) + rho[1] * std::max(0.0, y - interface()));
      grow(worst, run.points().tau[i][3] - here);
    }
    return {std::sqrt(sum / square), worst / std::fabs(stress)};
  }
};

/** Two liquids between a cylinder of radius 0.2 that turns and one of radius 0.45, with a round
 *  interface: root mean square of the error of velocities over that of the velocities. */
double between_cylinders(int n, double inner, double outer)
{
  Scene run(plane("si", "f f", "0 1 0 1", 1, 0.01) +
            "variable angle equal 1e-3*step*0.2\nregion out sphere 0.503 0.511 0 0.45 side out\n"
            "region in sphere 0.503 0.511 0 0.2 rotate v_angle 0.503 0.511 0 0 0 1\n"
            "region a sphere 0.503 0.511 0 0.2 side out\nregion b sphere 0.503 0.511 0 0.45\n"
            "region fluid intersect 2 a b\nregion core sphere 0.503 0.511 0 0.32\n" +
            strprintf("create_points 1 region fluid spacing %.17g\ngroup core region core\n"
                      "fix w all mpm/incompressible %.17g 1 viscosity %g implicit yes liquid core "
                      "1 %g stick out stick in tolerance 1e-7\n",
                      0.5 / n, 1.0 / n, outer, inner) +
            "timestep 0.2\nrun 4\n");
  // u = A r + B/r in each; the moment of the stress, mu B, is the same in both
  constexpr double a = 0.2, b = 0.45, c = 0.32;
  const double ratio = inner / outer;
  const double B = 1e-3 / (1.0 / (a * a) - 1.0 / (c * c) + ratio * (1.0 / (c * c) - 1.0 / (b * b)));
  double sum = 0.0, square = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double x = run.x()[i][0] - 0.503, y = run.x()[i][1] - 0.511, r = std::hypot(x, y);
    const double u = r < c ? r * (1e-3 + B / (r * r) - B / (a * a))
                           : ratio * B * (1.0 / r - r / (b * b));
    sum += std::pow(run.v()[i][0] + u * y / r, 2) + std::pow(run.v()[i][1] - u * x / r, 2);
    square += u * u;
  }
  return measured(strprintf("%d cells, viscosities %g and %g: error", n, inner, outer),
                  std::sqrt(sum / square));
}

/** Mean velocity over that of theory in a round pipe of radius 1 with a core of another liquid of
 *  radius 0.6, whose weight drives them; the outer liquid has the density 1000. */
double core_in_pipe(int n, double inner, double outer, double density)
{
  constexpr double x0 = 0.017, y0 = 0.031, c = 0.6, G = 1e-9;
  Scene run(
      box(3, "si", "f f p", strprintf("-1.25 1.25 -1.25 1.25 0 %.17g", 2.0 / n), 1, 0.02) +
      "region wall cylinder z 0.017 0.031 1 INF INF side out\n"
      "region fluid cylinder z 0.017 0.031 1 INF INF\n"
      "region core cylinder z 0.017 0.031 0.6 INF INF\n" +
      strprintf("create_points 1 region fluid spacing %.17g\ngroup core region core\n"
                "fix w all mpm/incompressible %.17g 1000 viscosity %g implicit yes stick wall "
                "liquid core %g %g tolerance 1e-7\nfix g all gravity %g vector 0 0 1\n",
                0.5 / n, 1.0 / n, outer, density, inner, G) +
      "timestep 5000\nrun 10\n");
  // the stress at r holds the weight of what is inside
  double sum = 0.0, exact = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double rr = std::pow(run.x()[i][0] - x0, 2) + std::pow(run.x()[i][1] - y0, 2),
                 r = std::max(c, std::sqrt(rr));
    sum += run.v()[i][2];
    exact += 0.5 * G / outer * ((1000 - density) * c * c * std::log(r) + 500 * (1.0 - r * r));
    if (rr < c * c) exact += 0.25 * G / inner * density * (c * c - rr);
  }
  return measured(
      strprintf("%d cells, viscosities %g and %g: mean velocity over theory", n, inner, outer),
      sum / exact);
}

/** A column that collapses under a fluid that is a thousand times lighter, in a closed box. */
std::string column(const std::string &options, double fraction, double max)
{
  return plane("si", "f f", "0 1 0 1", 1, 0.02) +
      "create_points 1 box spacing 0.025\nregion low block INF 0.4 INF 0.6 INF INF\n"
      "group low region low\ngroup air subtract all low\nfix w all mpm/incompressible 0.05 1000 " +
      options +
      strprintf("\nfix g all gravity 9.81 vector 0 -1 0\nfix dt all mpm/dt %g max %g\nrun 0\n",
                fraction, max);
}

/** Largest relative growth of energy in a step; most iterations for pressure and stresses. */
double energy_growth(Scene &run, int nsteps, double *iterations)
{
  double before = 1e30, most = 0.0;
  run.each_step([&](double **) {
    const auto s = run.sums();
    const double now = s.kinetic + 9.81 * s.mass * s.x[1];
    most = std::max(most, now / before - 1.0);
    before = now;
    iterations[0] = std::max(iterations[0], run.fix("w")->compute_vector(ITERATIONS));
    iterations[1] = std::max(iterations[1], run.fix("w")->compute_vector(STRESS));
  });
  run.commands(strprintf("run %d\n", nsteps));
  return measured("largest growth of the energy in a step", most);
}

/** Oil of 500 over water in a tank, with a block of 0.4 x 0.2 between them. */
std::string between(double h, const std::string &fixes)
{
  const std::string hull = "block 0.8137 1.2137 0.3037 0.5037 INF INF";
  return plane("si", "f f", "0 2 0 0.8", 1, 0.5 * h) + "region hull " + hull + "\nregion dry " +
      hull +
      " side out\nregion low block INF INF INF 0.72 INF INF\nregion fluid intersect 2 low dry\n" +
      strprintf("create_points 1 region fluid spacing %.17g\n", 0.5 * h) +
      "region top block INF INF 0.4 INF INF INF\ngroup oil region top\n" + fixes +
      strprintf("fix w all mpm/incompressible %.17g 1000 liquid oil 500 region hull\n", h) +
      "fix g all gravity 9.81 vector 0 -1 0\ntimestep 0.01\n";
}

// oil over water at rest, with a free surface: what both weigh is on the floor
SERIAL_TEST(Liquids, AtRest)
{
  for (const int dim : {2, 3}) {
    Scene run(box(dim, "si", "f f p", "0 1 0 1 0 0.2", 1, 0.01) +
              "region d block INF INF INF 0.8375 INF INF\ncreate_points 1 region d spacing 0.025\n"
              "region high block INF INF 0.43 INF INF INF\ngroup oil region high\n"
              "fix w all mpm/incompressible 0.05 1000 liquid oil 850 tolerance 1e-12\n"
              "fix g all gravity 9.81 vector 0 -1 0\ntimestep 0.01\n" +
              std::string(dim == 2 ? "run 300\n" : "run 3\n"));
    double top = 0.0;
    for (int i = 0; i < run.n(); i++) top = std::max(top, run.x()[i][1]);
    const double weight = 9.81 * (1000.0 * 0.425 + 850.0 * (top + 0.0125 - 0.425));
    EXPECT_LT(measured("speed", run.fix("w")->compute_vector(FASTEST)), 1e-11);
    EXPECT_NEAR(run.fix("w")->compute_vector(YLO) / (weight * (dim == 3 ? 0.2 : 1.0)), 1.0, 1e-11);
  }
}

// waves between two layers: the interface is as thick as a cell, an error of first order
SERIAL_TEST(Liquids, Waves)
{
  const double coarse = 1.0 - wave(20, 1000.0, 850.0), fine = 1.0 - wave(40, 1000.0, 850.0);
  EXPECT_LT(std::fabs(coarse), 0.05);
  EXPECT_GT(measured("order", std::log2(coarse / fine)), 0.9);
  EXPECT_NEAR(wave(20, 1000.0, 1.0), 1.0, 0.02);
  EXPECT_NEAR(wave(20, 1.0, 1e-3), 1.0, 0.02);    // of any unit
}

// Rayleigh and Taylor: a heavy liquid above a light one, growth as long as the amplitude is small
SERIAL_TEST(Liquids, TurnOver)
{
  const double w = frequency(1.0, 3.0);
  Scene run(layers(20, 1.0, 3.0, 0.005) + strprintf("timestep %.17g\n", 0.01 / w));
  const double before = amplitude(run);
  run.commands("run 200\n");
  EXPECT_NEAR(measured("rate over theory", std::acosh(amplitude(run) / before) / 2.0), 1.0, 0.05);
}

// a column of water collapses under a fluid a thousand times lighter: its energy never grows
SERIAL_TEST(Liquids, LightAndHeavy)
{
  Scene run(column("liquid air 1", 0.25, 0.01));
  double iterations[2] = {};
  EXPECT_LT(energy_growth(run, 240, iterations), 0.001);
  EXPECT_NEAR(measured("volume", run.fix("w")->compute_vector(FILLED)), 1.0, 0.03);
  EXPECT_LT(measured("iterations", iterations[0]), 40.0);
  EXPECT_LT(measured("speed", run.fix("w")->compute_vector(FASTEST)), 20.0);
}

// One shear stress in both layers: the velocity is right wherever their interface is in a cell,
// along both axes; at the middle of cells, where points interpolate, it has a kink
SERIAL_TEST(Shear, Couette)
{
  constexpr double speed = 1e-9;
  for (const int dim : {2, 3})
    for (const int axis : {0, 1})
      for (const double ratio : {1.0, 10.0, 1000.0})
        for (const double part : {0.5, 0.25, 0.0}) {
          if (dim == 3 && (part == 0.25 || ratio == 1.0)) continue;
          double error[2], worst = 0.0;
          for (const int k : {0, 1}) {
            const Layers layers = {8 << k, dim, axis, (4 << k) + part, {1.0, ratio}, {1.0, ratio}};
            Scene run(
                layers.scene("implicit yes tolerance 1e-11",
                             strprintf("%s %g %s", axis ? "" : "0", speed,
                                       (axis ? (dim == 3 ? "0 0" : "0") : (dim == 3 ? "0" : "")))) +
                "timestep 1e5\nrun 3\n");
            const auto both = layers.errors(run, speed, 0.0);
            error[k] = both[0];
            worst = std::max(worst, both[1]);
          }
          measured(strprintf("%dd, axis %d, ratio %g, interface %g: error", dim, axis, ratio, part),
                   error[0]);
          measured("with cells of half the size", error[1]);
          EXPECT_LT(measured("stress", worst), 5e-7);
          if (part == 0.5 || ratio == 1.0)    // the kink is between boxes
            EXPECT_LT(std::max(error[0], error[1]), 3e-9);
          else {
            EXPECT_LT(error[0], 0.02);
            EXPECT_LT(error[1], 0.42 * error[0]);
          }
        }
}

// explicit steps, from rest: a tenth of the largest viscosity over density limits them
SERIAL_TEST(Shear, ExplicitCouette)
{
  constexpr double speed = 1e-9;
  for (const auto &[ratio, rho] : {std::pair(10.0, 1.0), {10.0, 5.0}}) {
    const Layers layers = {8, 2, 1, 4.5, {1.0, ratio}, {1.0, rho}};
    Scene run(layers.scene("", strprintf("%g 0", speed)) +
              "fix dt all mpm/dt 0.9 every 1\nrun 1\n");
    EXPECT_NEAR(run.lmp->update->dt, 0.9 / (64.0 * 8.0 * std::max(1.0, ratio / rho)), 1e-15);
    run.commands("run 2500\n");
    const auto error = layers.errors(run, speed, 0.0);
    EXPECT_LT(measured("error of velocities", error[0]), 5e-5);
    EXPECT_LT(measured("error of stresses", error[1]), 2e-4);
  }
}

// layers of other densities and viscosities that their weight drives between plates: second order
SERIAL_TEST(Shear, Poiseuille)
{
  for (const auto &[ratio, rho] : {std::pair(10.0, 1.0), {1000.0, 0.001}, {0.1, 10.0}})
    for (const double part : {0.5, 0.0}) {
      double error[2];
      for (const int k : {0, 1}) {
        const Layers layers = {8 << k, 2, 1, (4 << k) + part, {1.0, ratio}, {1.0, rho}};
        Scene run(layers.scene("implicit yes tolerance 1e-11") +
                  "fix g all gravity 1e-9 vector 1 0 0\ntimestep 1e5\nrun 3\n");
        error[k] = measured(
            strprintf("%g and %g, interface %g, %d cells: error", ratio, rho, part, 8 << k),
            layers.errors(run, 0.0, 1e-9)[0]);
      }
      EXPECT_LT(error[0], 0.1);
      EXPECT_LT(error[1], 0.42 * error[0]);
    }
}

// A wave of shear in two layers: u = sin(k y) in each, lambda = nu k^2, and one stress
SERIAL_TEST(Shear, Decay)
{
  LONG_CASE();
  for (const bool implicit : {false, true}) {
    const int n = 16;
    const Layers layers = {n, 2, 1, n / 2 + 0.5, {1.0, 4.0}, {1.0, 0.5}};
    const double a = layers.interface(), b = 1.0 - a;
    const auto k = [&](int of, double lambda) {
      return std::sqrt(lambda * layers.rho[of] / layers.mu[of]);
    };
    const double high = std::min(PI * PI / (a * a), 8.0 * PI * PI / (b * b)) - 1e-6;
    const double lambda = root_of(1e-6, high, [&](double lambda) {
      const double k1 = k(0, lambda), k2 = k(1, lambda);
      return layers.mu[0] * k1 / std::tan(k1 * a) + layers.mu[1] * k2 / std::tan(k2 * b);
    });
    const double k1 = k(0, lambda), k2 = k(1, lambda), dt = 0.5 / (n * n * 8.0 * 8.0);
    Scene run(replaced(layers.scene(implicit ? "implicit yes" : ""), "fix w",
                       strprintf("variable u atom "
                                 "1e-6*((1-v_up)*sin(%.17g*y)/%.17g+v_up*sin(%.17g*(1-y))/%.17g)\n"
                                 "velocity all set v_u 0 0\nfix w",
                                 k1, std::sin(k1 * a), k2, std::sin(k2 * b))) +
              strprintf("timestep %.17g\nrun 0\n", dt));
    const double energy = run.fix("w")->compute_vector(KINETIC);
    std::vector<double> mode(run.n());    // points move along x alone, and keep their order
    for (int i = 0; i < run.n(); i++) mode[i] = run.v()[i][0];
    const auto amplitude = [&] {
      double sum = 0.0;
      for (int i = 0; i < run.n(); i++) {
        const double y = run.x()[i][1];
        sum += run.lmp->atom->rmass[i] * run.v()[i][0] *
            (y < a ? std::sin(k1 * y) / std::sin(k1 * a)
                   : std::sin(k2 * (1.0 - y)) / std::sin(k2 * b));
      }
      return sum;
    };
    const double before = amplitude();
    double heat = 0.0;
    run.each_step([&](double **) {
      for (int i = 0; i < run.n(); i++)
        heat += dt * run.lmp->atom->vfrac[i] * std::pow(run.points().tau[i][3], 2) /
            layers.mu[run.x()[i][1] > a];
    });
    const int nsteps = (int) (1.0 / (lambda * dt));
    run.commands(strprintf("run %d\n", nsteps));
    EXPECT_NEAR(
        measured("rate over theory", std::log(before / amplitude()) / (nsteps * dt * lambda)), 1.0,
        0.01);
    EXPECT_NEAR(measured("heat over loss of energy",
                         heat / (energy - run.fix("w")->compute_vector(KINETIC))),
                1.0, 0.02);
  }
}

/** Growth of the wave with the wave number k between half spaces (S. Chandrasekhar, Hydrodynamic
 *  and Hydromagnetic Stability, 1961, chapter X): the solution n of the conditions at the
 *  interface, for velocities A exp(-k |y|) + B exp(-q |y|) on each side. rho, mu: below, above. */
double growth_rate(double k, double g, const double *rho, const double *mu)
{
  const auto determinant = [&](double n) {
    Eigen::Matrix4d M;    // A and B below, A and B above
    for (int s = 0; s < 2; s++) {
      const double q = std::sqrt(k * k + n * rho[s] / mu[s]), side = s ? -1.0 : 1.0;
      M.col(2 * s) << side, k, side * 2.0 * mu[s] * k * k,
          rho[s] * (n / k + side * g / n) + 2.0 * mu[s] * k;
      M.col(2 * s + 1) << side, q, side * mu[s] * (q * q + k * k),
          side * rho[s] * g / n + 2.0 * mu[s] * q;
    }
    return M.determinant();
  };
  return root_of(1e-3, std::sqrt(g * k), determinant);
}

// A heavy liquid above a light one of the same viscosity per density, or a tenth.
SERIAL_TEST(Shear, GrowthOfWaves)
{
  constexpr int N = 16;
  constexpr double K = 2.0 * PI, DT = 0.005;
  for (const double thick : first_of(1, {1000.0, 100.0})) {
    const double rho[] = {1000.0, 2000.0}, mu[] = {50.0, thick};
    Scene run(
        plane("si", "f f", "0 0.5 0 2", 1, 0.005) +
        strprintf("create_points 1 box spacing %.17g\n", 0.25 / N) +
        "region top block INF INF 1 INF INF INF\ngroup heavy region top\n"
        "variable up atom 1e-4*cos(2*PI*x)*exp(-2*PI*abs(y-1))\n"
        "variable side atom 1e-4*sin(2*PI*x)*exp(-2*PI*abs(y-1))*(2*(y>1)-1)\n"
        "velocity all set v_side v_up NULL\n" +
        strprintf("fix w all mpm/incompressible %.17g 1000 viscosity 50 implicit yes iterations "
                  "1000 liquid heavy 2000 %g\n",
                  0.5 / N, thick) +
        "fix g all gravity 9.81 vector 0 -1 0\n" + strprintf("timestep %g\n", DT));
    run.commands("run 200");
    const double before = run.fix("w")->compute_vector(KINETIC);
    run.commands("run 60");
    const double rate = 0.5 * std::log(run.fix("w")->compute_vector(KINETIC) / before) / (60 * DT);
    EXPECT_LT(std::abs(rate / growth_rate(K, 9.81, rho, mu) - 1.0), 0.02) << rate << ' ' << thick;
  }
}

// interfaces and walls that are oblique to the lattice, with 5 and 10 cells in the gap
SERIAL_TEST(Shear, BetweenCylinders)
{
  for (const auto &[inner, outer] : {std::pair(10.0, 1.0), {1.0, 10.0}}) {
    const double coarse = between_cylinders(20, inner, outer),
                 fine = between_cylinders(40, inner, outer);
    EXPECT_LT(coarse, 0.1);
    EXPECT_LT(fine, 0.6 * coarse);
  }
}

// in 3d, with round walls: the error is of second order
SERIAL_TEST(Shear, CoreInPipe)
{
  EXPECT_NEAR(core_in_pipe(4, 1.0, 10.0, 500.0), 1.0, 0.04);
  EXPECT_NEAR(core_in_pipe(8, 1.0, 10.0, 500.0), 1.0, 0.01);
  EXPECT_NEAR(core_in_pipe(4, 10.0, 1.0, 1000.0), 1.0, 0.04);
  EXPECT_NEAR(core_in_pipe(8, 10.0, 1.0, 1000.0), 1.0, 0.01);
}

// honey in a fluid that is a thousand times lighter and thinner: the equations converge, and energy
// never grows; with explicit steps at the limit of fix mpm/dt, too
SERIAL_TEST(Shear, ThickAndThin)
{
  for (const char *options : {"viscosity 10 implicit yes liquid air 1 0.01",
                              "viscosity 0.01 implicit yes liquid air 1 10",
                              "viscosity 10 implicit yes liquid air 1 0"}) {
    Scene run(column(options, 0.4, 0.01));
    double iterations[2] = {};
    EXPECT_LT(energy_growth(run, 40, iterations), 1e-6);
    EXPECT_LT(measured(std::string(options) + ": iterations", iterations[1]), 400.0);
    EXPECT_LT(measured("of the pressure", iterations[0]), 40.0);
    EXPECT_LT(measured("speed", run.fix("w")->compute_vector(FASTEST)), 20.0);
  }
  Scene run(column("viscosity 150 liquid air 1 0.05", 0.9, 0.01));
  double iterations[2] = {};
  EXPECT_LT(energy_growth(run, 150, iterations), 1e-6);
  EXPECT_LT(measured("speed", run.fix("w")->compute_vector(FASTEST)), 20.0);
}

// a block between oil and water: the force on it when it is held, and how deep it floats
SERIAL_TEST(Body, BetweenLiquids)
{
  for (const double h : first_of(1, {0.04, 0.02})) {
    Scene held(between(h, "") + "run 1\n");
    const double lift = 9.81 * 0.4 * (1000.0 * (0.4 - 0.3037) + 500.0 * (0.5037 - 0.4));
    EXPECT_NEAR(measured("force over theory", held.fix("w")->compute_vector(15) / lift), 1.0, 0.01);

    Scene run(between(h,
                      "fix body all mpm/rigid hull density 700 slip gravity 0 -9.81 0 hold x "
                      "rz\n") +
              "run 200\n");
    double sum = 0.0, force = 0.0;
    int n = 0;
    run.each_step([&](double **) {
      sum += run.fix("body")->compute_vector(1);
      force += run.fix("w")->compute_vector(15);
      n++;
    });
    run.commands("run 200\n");
    const double level = (2.0 * 0.4 - 0.4 * (0.4 - 0.3037) + 0.4 * 0.08) / 2.0;
    EXPECT_NEAR(measured("depth in the water over theory", (level - (sum / n - 0.1)) / 0.08), 1.0,
                h < 0.03 ? 0.015 : 0.04);
    EXPECT_NEAR(measured("force over weight", force / n / (700.0 * 0.08 * 9.81)), 1.0,
                h < 0.03 ? 0.003 : 0.01);
  }
}

// oil that comes into water has its own density
SERIAL_TEST(Inflow, HasItsDensity)
{
  Scene run(plane("si", "f f", "0 1 0 1", 1, 0.02) +
            "region water block INF INF 0 0.4 INF INF\ncreate_points 1 region water spacing 0.025\n"
            "region inlet block 0.4 0.6 0.7 0.85 INF INF\ngroup oil empty\n"
            "fix in oil mpm/emit 1 region inlet velocity 0 -0.5 0\n"
            "fix w all mpm/incompressible 0.05 1000 liquid oil 800\n"
            "fix g all gravity 9.81 vector 0 -1 0\nfix dt all mpm/dt 0.4 max 0.01\nrun 60\n");
  const int oil = run.lmp->group->bitmask[run.lmp->group->find("oil")];
  double worst = 0.0, mass = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const bool in = run.lmp->atom->mask[i] & oil;
    grow(worst, run.lmp->atom->rmass[i] / run.lmp->atom->vfrac[i] - (in ? 800.0 : 1000.0));
    if (in) mass += run.lmp->atom->rmass[i];
  }
  EXPECT_LT(worst, 1e-9);
  EXPECT_GT(mass, 10.0);
  EXPECT_NEAR(run.fix("in")->compute_vector(8), 800.0 * 0.2 * 0.5, 1e-10);
}

// on three and four ranks, balanced; and the same to the last bit from a restart file
TEST(Liquids, RanksAndRestart)
{
  for (const int dim : {2, 3}) {
    const double h = dim == 2 ? 0.05 : 0.1;
    const auto scene = box(dim, "si", "f f p", "0 1 0 1 0 0.4", 1, 0.02) +
        "region d block INF INF INF 0.81 INF INF\n" +
        strprintf("create_points 1 region d spacing %g\n", 0.5 * h) +
        "region low block INF 0.4 INF 0.6 INF INF\ngroup low region low\ngroup high subtract all "
        "low\n";
    for (const char *liquids :
         {"1000 liquid high 100", "1000 viscosity 30 wall xlo stick liquid high 100 0.5",
          "1000 viscosity 30 implicit yes wall xlo stick liquid high 100 0.5"}) {
      const auto fixes =
          strprintf("fix w all mpm/incompressible %g %s tolerance 1e-11\n", h, liquids) +
          "fix g all gravity 9.81 vector 0 -1 0\ntimestep 0.003\n";
      OnRanks run(scene + fixes, "run 15\n", "fix b all balance 5 1.05 shift xy 10 1.05\n");
      EXPECT_LT(measured("difference", run.difference()), 1e-12);
      Continued again(scene + fixes, 6, "neighbor 0.02 bin\n" + fixes, 12);
      EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
    }
  }
}

SERIAL_TEST(Liquids, BadInput)
{
  const auto plain = plane("si", "p f", "0 1 0 1", 1, 0.02) + "create_points 1 box spacing 0.05\n";
  const std::string fix = "fix w all mpm/incompressible 0.1 1000 ";
  expect_refused(
      plain,
      {{fix + "liquid", "liquid"},
       {fix + "liquid all", "liquid"},
       {fix + "liquid none 800", "group none does not exist"},
       {fix + "liquid all 0", "0"},
       {fix + "liquid all nan", "nan"},
       {fix + "liquid all 800 -1", "-1"},
       {fix + "liquid all 800 nan", "nan"},
       {fix + "liquid all 800 viscosity", "viscosity"},
       {fix + "liquid none 800 1", "group none does not exist"},
       {fix + "liquid all 800 1 2", "2"},
       {fix + "viscosity 1 liquid all 800 2 solid all", "fluids of one viscosity"},
       {fix + "liquid all 800 0 implicit yes", "add the keyword viscosity"},
       {"region b sphere 0.5 0.5 0 0.001\n" + fix + "liquid all 800 1 region b",
        "use the keyword stick"},
       {fix + "liquid all 800 20000", "too large for the viscosity, which allows 7.5e-05"},
       {fix + "liquid all 800 tension 1", "leave one of them out"},
       // points keep the mass that they have
       {"group few id <= 30\n" + fix + "liquid few 800\nrun 0\nunfix w\n" + fix + "liquid few 900",
        "30 points have another mass than density 900 of liquid few"},
       {"group few id <= 30\n" + fix + "liquid few 800\nrun 0\nunfix w\n" + fix,
        "30 points have another mass than density 1000 times"}},
      "timestep 0.001\nrun 1\n");

  // a group that is empty, as its points were made later, is told of once; one that has some is not
  const std::string last = " 800\ntimestep 0.001\nrun 1\nrun 1\n",
                    say = "keyword liquid has no points of this fix";
  EXPECT_EQ(times_said(plain + "group oil empty\n" + fix + "liquid oil" + last, say), 1);
  EXPECT_EQ(times_said(plain + "group oil id 1\n" + fix + "liquid oil" + last, say), 0);
}
