// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 400

// Fix mpm/pore in partly saturated soils (retention). Finite volumes are those of richards.py.

#include "pore/pore_bodies_testing.h"

#include "pore/mpm_pore_suction.h"

using namespace MPM_TEST;

constexpr double WEIGHT = 9810.0;    // of water, Pa/m

/** A quantity of points by a compute mpm/atom, which the scene defines with this ID. */
std::vector<double> values(Scene &run, const std::string &quantity)
{
  auto *compute = run.lmp->modify->get_compute_by_id(quantity);
  if (!compute) {
    run.commands("compute " + quantity + " all mpm/atom " + quantity + "\n");
    compute = run.lmp->modify->get_compute_by_id(quantity);
  }
  compute->compute_peratom();
  return {compute->vector_atom, compute->vector_atom + run.n()};
}
double mass(Scene &run)
{
  double sum = 0.0;
  for (int i = 0; i < run.n(); i++) sum += run.mass()[i];
  return over_ranks(sum);
}

/** A column of 1 m and n cells on a smooth floor, two cells wide. */
std::string column(int n, const std::string &water,
                   const std::string &material = "2000 linear 1e8 0.0", double top = 1.0,
                   double offset = 0.0)
{
  const double h = 1.0 / n;
  return plane("si", "p f", strprintf("0 %.17g 0 %.17g", 2 * h, top), 1, 0.3 * h) +
      strprintf("region soil block 0 %.17g 0 1 INF INF\n", 2 * h) +
      strprintf("create_points 1 region soil spacing %.17g\n", 0.5 * h) +
      strprintf("fix grid all mpm %.17g origin 0 %.17g\n", h, offset * h) +
      "fix m all mpm/material density " + material + "\nfix floor all mpm/boundary ylo slip\n" +
      "fix g all gravity 9.81 vector 0 -1 0\n" + "fix water all mpm/pore " + water + "\n";
}

/** Volume of water of all points by saturation and porosity, at its density without pressure. */
double water_in_pores(Scene &run, double K)
{
  const auto S = values(run, "saturation"), n = values(run, "porosity"), p = values(run, "pore");
  double sum = 0.0;
  for (int i = 0; i < run.n(); i++)
    sum += S[i] * std::exp(p[i] / K) * n[i] * run.points().jacobian(i) * run.lmp->atom->vfrac[i];
  return sum;
}

/** Steady infiltration q0 and then q1, in units of the permeability, into a column of the height 1
 *  above a water table: head at the height z and the time t (R. Srivastava, T.-C.J. Yeh, Water
 *  Resour. Res. 27 (1991) 753). range: of the water content. */
double infiltration(double alpha, double K, double range, double q0, double q1, double z, double t)
{
  const double L = alpha, Z = alpha * z, T = alpha * K * t / range;
  double sum = 0.0;
  for (int k = 0; k < 400; k++) {    // tan(x L) = -2 x, in ((k + 1/2) pi/L, (k + 1) pi/L)
    const double x = root_of((k + 0.5) * PI / L, (k + 1.0) * PI / L, [=](double x) {
      return std::sin(x * L) + 2.0 * x * std::cos(x * L);
    });
    sum += std::sin(x * Z) * std::sin(x * L) * std::exp(-x * x * T) /
        (1.0 + 0.5 * L + 2.0 * x * x * L);
  }
  const double k = q1 - (q1 - 1.0) * std::exp(-Z) -
      4.0 * (q1 - q0) * std::exp(0.5 * (L - Z)) * std::exp(-0.25 * T) * sum;
  return std::log(k) / alpha;
}

// dS/dp by differences, the way back from the water to its pressure, and the model of Mualem
SERIAL_TEST(Retention, Functions)
{
  MPMPoreWater water;
  water.bulk = 1e7;
  water.density = 1000.0;
  water.resistance = WEIGHT;
  for (const bool gardner : {false, true}) {
    MPMPoreSoil soil;
    soil.porosity = 0.4;
    auto &r = soil.retention;
    r.law = gardner ? MPMRetention::GARDNER : MPMRetention::VAN_GENUCHTEN;
    r.alpha = 3.0 / WEIGHT;
    r.n = 1.7;
    r.least = 0.1;
    r.most = 0.95;
    for (const double p : {-1.0, -50.0, -3e3, -2e4}) {
      const double e = 1e-5 * p;
      const auto state = MPMPoreMoisture::at(soil, 1.1, p, water);
      const double slope = (MPMPoreMoisture::at(soil, 1.1, p - e, water).filling -
                            MPMPoreMoisture::at(soil, 1.1, p + e, water).filling) /
          (-2.0 * e);
      EXPECT_NEAR(state.storage / (soil.porosity_at(1.1) * slope), 1.0, 1e-5);
      for (const double guess : {-1e-3, p, -1e5, 7.0})
        EXPECT_NEAR(MPMPoreMoisture::pressure(soil, state.filling, 0.0, guess, water) / p, 1.0,
                    1e-8);
      // energy: by the trapezoidal rule
      double sum = 0.0;
      const int N = 20000;
      for (int k = 0; k < N; k++) {
        const double q = p * (k + 0.5) / N;
        sum += q * p / N * MPMPoreMoisture::at(soil, 1.0, q, water).storage;
      }
      EXPECT_NEAR(MPMPoreMoisture::energy(soil, 1.0, p, water) / sum, 1.0, 2e-4);
    }
    EXPECT_NEAR(MPMPoreMoisture::pressure(soil, 0.95 * (1.0 + 1e-3), 0.0, -5.0, water), 1e4, 1e-6);
  }
  MPMRetention celia;
  celia.law = MPMRetention::VAN_GENUCHTEN;
  celia.alpha = 3.35;
  celia.n = 2.0;
  const auto state = celia.at(-0.75);
  EXPECT_NEAR(state.effective, 1.0 / std::sqrt(1.0 + 2.5125 * 2.5125), 1e-14);
  const double s = state.effective;
  EXPECT_NEAR(state.relative, std::sqrt(s) * std::pow(1.0 - std::sqrt(1.0 - s * s), 2), 1e-14);
}

// Infiltration above a water table (Gardner): the steady profile of 0.1 K stays; then that of 0.9 K
SERIAL_TEST(Infiltration, SrivastavaAndYeh)
{
  LONG_CASE();
  const double alpha = 4.0, K = 0.1, range = 0.34;
  double rms[2];
  for (const int n : {10, 20})
    for (const bool rain : {false, true}) {
      if (rain && n == 20) continue;
      Scene column_of(
          replaced(column(n,
                          strprintf("1e6 1000 9810 soil m 0.4 constant %g retention gardner %.17g "
                                    "saturation 0.15 1 ylo pressure 0 yhi %s v_q initial v_p",
                                    K, alpha / WEIGHT, rain ? "rain" : "flux")),
                   "fix water",
                   "variable q equal 0.01+0.08*(time>0.1)\n"
                   "variable p atom 9810/4*ln(0.1+0.9*exp(-4*y))\nfix water"));
      double worst = 0.0;
      for (const double t : {0.0, 0.2, 0.5, 1.0, 4.0}) {
        if (rain && t > 0.2) continue;
        run_until(column_of, 0.1 + t);
        const auto p = values(column_of, "pore");
        double sum = 0.0;
        for (int i = 0; i < column_of.n(); i++) {
          const double z = column_of.x()[i][1];
          const double exact = infiltration(alpha, K, range, 0.1, t > 0.0 ? 0.9 : 0.1, z, t);
          sum += std::pow(p[i] / WEIGHT - exact, 2) / column_of.n();
        }
        worst = std::max(
            worst, measured(strprintf("%d cells, t %g, rms of the head", n, t), std::sqrt(sum)));
      }
      rms[n == 20] = worst;
    }
  EXPECT_LT(rms[0], 0.01);
  EXPECT_LT(rms[1], 0.6 * rms[0]);
}

// Infiltration into dry sand of New Mexico in a day (M.A. Celia, E.T. Bouloutas, R.L. Zarba, Water
// Resour. Res. 26 (1990) 1483), 1e5 times as fast: heads behind the front, its depth, and the
// water, which is that of the points by their saturation, too
SERIAL_TEST(Infiltration, IntoDrySand)
{
  LONG_CASE();
  double depth[2];
  for (const int n : {25, 50}) {
    Scene run(column(n,
                     strprintf("2.2e9 1000 9810 soil m 0.368 constant 9.22 retention vangenuchten "
                               "%.17g 2.0 saturation %.17g 1 initial -98100 "
                               "ylo pressure -98100 yhi pressure %.17g",
                               3.35 / WEIGHT, 0.102 / 0.368, -0.75 * WEIGHT),
                     "2000 linear 1e8 0.0"));
    run.commands("timestep 1e-9\nrun 0\n");
    const double before = mass(run), water = water_in_pores(run, 2.2e9);
    run_until(run, 0.01, 0.1);    // the jump at the surface fills cells within some steps
    run_until(run, 0.864);
    const double area = 2.0 / n, came = run.fix("water")->compute_scalar();
    EXPECT_NEAR(measured("mass of water", (mass(run) - before - 1000.0 * came) / before), 0.0,
                1e-13);
    EXPECT_NEAR(
        measured("water by the saturation", (water_in_pores(run, 2.2e9) - water - came) / came),
        0.0, 1e-10);
    const auto p = values(run, "pore");
    // heads in rows of points from the top
    std::map<double, double> head;
    for (int i = 0; i < run.n(); i++) head[1.0 - run.x()[i][1]] = p[i] / WEIGHT;
    double front = 0.0, z0 = 0.0, h0 = -0.75;
    for (const auto &[z, h] : head) {
      if (h < -5.0 && front == 0.0) front = z0 + (z - z0) * (h0 + 5.0) / (h0 - h);
      z0 = z;
      h0 = h;
    }
    depth[n == 50] = measured(strprintf("%d cells, depth of the front", n), front) - 0.5640;
    if (n == 25) continue;
    EXPECT_NEAR(measured("water that came in", came / area) / 0.04112, 1.0, 0.02);
    const double z[] = {0.1, 0.2, 0.3, 0.4}, exact[] = {-0.7687, -0.8028, -0.8673, -1.0047};
    for (int k = 0; k < 4; k++) {
      const auto next = head.lower_bound(z[k]), last = std::prev(next);
      const double share = (z[k] - last->first) / (next->first - last->first);
      const double h = last->second + share * (next->second - last->second);
      EXPECT_NEAR(measured(strprintf("head at %g", z[k]), h) / exact[k], 1.0, 0.02);
    }
  }
  EXPECT_LT(std::fabs(depth[1]), 0.02);
  EXPECT_LT(std::fabs(depth[1]), 0.7 * std::fabs(depth[0]));
}

const char *const SAND = "2.2e8 1000 9810 soil m 0.4 constant 1e-3 ",
                  *const DRIES = "retention vangenuchten 3e-4 2.2 saturation 0.1 1 ";

// level ground with a water table in it is at rest, with the weight of the water that it has
SERIAL_TEST(Geostatic, SuctionAboveTheTable)
{
  const double dt = 4e-5;
  const int n = 20;
  for (const char *options : {"", "bishop effective "})
    for (const double offset : {0.0, 0.3}) {
      Scene run(column(n, std::string(SAND) + DRIES + options + "geostatic 0.5 0.4",
                       "2002 linear 1e7 0.3", 1.2, offset) +
                "run 0\n");
      const auto p = values(run, "pore"), S = values(run, "saturation");
      double weight = 0.0, exact = 0.0, worst = 0.0;
      for (int i = 0; i < run.n(); i++) {
        const double y = run.x()[i][1], V = run.lmp->atom->vfrac[i];
        EXPECT_NEAR(p[i], WEIGHT * (0.4 - y), 1e-8);
        const double s = std::max(0.0, -p[i]);
        const double Se = std::pow(1.0 + std::pow(3e-4 * s, 2.2), 1.0 / 2.2 - 1.0);
        EXPECT_NEAR(S[i], 0.1 + 0.9 * Se, 1e-12);
        weight += run.mass()[i];
        exact += V * (2002.0 - 400.0 * (1.0 - S[i] * std::exp(-s / 2.2e8)));
        if (y > 0.8 || y < 0.1) continue;
        double above = 0.0;    // weight of what is above, by fine steps
        for (int k = 0; k < 1000; k++) {
          const double z = y + (1.0 - y) * (k + 0.5) / 1000, q = std::max(0.0, WEIGHT * (z - 0.4));
          const double e = std::pow(1.0 + std::pow(3e-4 * q, 2.2), 1.0 / 2.2 - 1.0);
          above += (1.0 - y) / 1000 * 9.81 * (2002.0 - 400.0 * 0.9 * (1.0 - e));
        }
        const auto sigma = run.cauchy(i);
        const double chi = options[0] ? Se : S[i];
        grow(worst, sigma[1] - chi * p[i] + above);
      }
      EXPECT_NEAR(weight / exact, 1.0, 1e-13);
      EXPECT_LT(measured("total stress over the weight of a cell", worst / (2002 * 9.81 / n)),
                0.05);
      run.commands(strprintf("timestep %g\nrun 1\n", dt));
      EXPECT_LT(measured("force over weight", fall(run, dt)), 1e-10);
      run.commands("run 500\n");
      EXPECT_LT(measured("velocity", fall(run, 501 * dt)), 1e-10);
    }
  Scene dry(column(n, std::string(SAND) + DRIES + "geostatic 0.5 0.4 suction 2000",
                   "2002 linear 1e7 0.3", 1.2, 0.0) +
            "run 0\n");
  const auto p = values(dry, "pore");
  for (int i = 0; i < dry.n(); i++)
    EXPECT_NEAR(p[i], std::max(-2000.0, WEIGHT * (0.4 - dry.x()[i][1])), 1e-8);
  dry.commands(strprintf("timestep %g\nrun 1\n", dt));
  EXPECT_LT(measured("with less suction, force over weight", fall(dry, dt)), 0.05);
}

// also where suction of water at rest changes the saturation by orders of magnitude in a cell
SERIAL_TEST(Geostatic, CapillaryFringeWithinACell)
{
  Scene run(column(10,
                   std::string(SAND) + "retention gardner 4e-3 saturation 0.1 1 geostatic 0.5 0.43",
                   "2002 linear 1e7 0.3", 1.2, 0.0) +
            "timestep 4e-5\nrun 200\n");
  EXPECT_LT(measured("velocity", fall(run, 200 * 4e-5)), 1e-12);
}

// friction of walls is that of grains: a block slides by its weight less what water bears at the
// floor, in pores that are full with the saturation Ss, partly full, or below a water table
SERIAL_TEST(Walls, FrictionIsThatOfGrains)
{
  LONG_CASE();
  const double mu = 0.3, H = 0.4, T = 0.05;
  for (const char *bishop : {"saturation", "effective"})
    for (const auto &[Ss, table] :
         {std::pair{0.7, 0.4}, std::pair{1.0, 0.4}, std::pair{0.7, -0.2}, std::pair{0.7, 0.17}}) {
      const auto effective = [](double p) {
        return std::pow(1.0 + std::pow(3e-4 * std::max(0.0, -p), 1.6), 1.0 / 1.6 - 1.0);
      };
      double m = 0.0;    // over the area, by fine steps
      for (int k = 0; k < 4000; k++) {
        const double p = WEIGHT * (table - H * (k + 0.5) / 4000);
        m += H / 4000 * (1600.0 + 400.0 * (0.1 + (Ss - 0.1) * effective(p)));
      }
      const double p0 = WEIGHT * table, Se = effective(p0);
      const double chi = bishop[0] == 'e' ? Se : 0.1 + (Ss - 0.1) * Se;
      const double slower = mu * (9.81 * m - chi * p0) / m;
      // what suction pulls with at the top counts for the floor where the top is within four nodes
      const bool full = table == H;
      for (const double h : {full ? 0.1 : 0.05, full ? 0.05 : 0.025}) {
        Scene run(
            plane("si", "p f", strprintf("0 %.17g 0 0.8", 8 * h), 1, 0.3 * h) +
            strprintf("region soil block 0 %.17g 0 %g INF INF\n", 8 * h, H) +
            strprintf("create_points 1 region soil spacing %g\nfix grid all mpm %g\n", 0.5 * h, h) +
            "fix m all mpm/material density 2000 linear 1e7 0.3\n"
            "fix floor all mpm/boundary ylo slip friction 0.3\n"
            "fix g all gravity 9.81 vector 0 -1 0\n" +
            strprintf("fix water all mpm/pore 1e7 1000 9810 soil m 0.4 constant 1e-9 retention "
                      "vangenuchten 3e-4 1.6 saturation 0.1 %g bishop %s geostatic 0.5 %g\n",
                      Ss, bishop, table) +
            "velocity all set 5 0 0\n");
        run_until(run, T);
        const auto s = run.sums();
        EXPECT_NEAR(measured(strprintf("%s, Ss %g, table %g, spacing %g: over %.4f m/s^2", bishop,
                                       Ss, table, h, slower),
                             (5.0 - s.p[0] / s.mass) / (T * slower)),
                    1.0, 0.01);
      }
    }
}

// soil whose pores stay full is that without retention, to round-off as compilers contract sums
SERIAL_TEST(FullPores, AreAsWithoutRetention)
{
  const auto scene = [](const char *dries) {
    return column(10,
                  std::string("2.2e8 1000 9810 soil m 0.4 kozeny 1e-3 ") + dries +
                      "geostatic 0.5 1 ylo pressure 1.1e4 yhi pressure 300",
                  "2002 linear 1e7 0.3", 1.0, 0.2) +
        "velocity all set 0 -0.05 0\ntimestep 4e-5\nrun 500\n";
  };
  Scene always(scene("")), dries(scene(DRIES));
  EXPECT_LT(difference(always.gather(), dries.gather()), 1e-12);
  const auto one = values(always, "pore"), two = values(dries, "pore");
  EXPECT_GT(*std::min_element(one.begin(), one.end()), 0.0);
  for (std::size_t i = 0; i < one.size(); i++) EXPECT_NEAR(two[i] / one[i], 1.0, 1e-12);
  EXPECT_NEAR(dries.fix("water")->compute_scalar() / always.fix("water")->compute_scalar(), 1.0,
              1e-10);
}

// Rain of three times the permeability on dry soil: first all of it goes in, then what full pores
// let through. No water comes in through a face with air outside, but it leaves there
SERIAL_TEST(Surface, RainAndSeepage)
{
  LONG_CASE();
  const double K = 0.1;
  for (const char *top : {"yhi", "free"}) {
    Scene run(column(20,
                     strprintf("1e6 1000 9810 soil m 0.4 constant %g retention gardner %.17g "
                               "saturation 0.15 1 initial -4905 %s rain 0.3 ylo seepage",
                               K, 4.0 / WEIGHT, top),
                     "2000 linear 1e8 0.0", top[0] == 'y' ? 1.0 : 1.2) +
              "timestep 1e-9\nrun 0\n");
    const double area = 0.1, before = mass(run);
    const int part = top[0] == 'y' ? 3 : 6;
    run_until(run, 0.01);
    const double *flow = run.fix_vector("water", 7);
    EXPECT_NEAR(measured("rain that goes in at first", flow[part] / area), 0.3, 0.01);
    EXPECT_EQ(flow[2], 0.0);
    run_until(run, 6.0);
    flow = run.fix_vector("water", 7);
    EXPECT_NEAR(measured("rain that goes in at last", flow[part] / area) / K, 1.0, 0.02);
    EXPECT_NEAR(measured("seepage", flow[2] / area) / K, -1.0, 0.02);
    const double came = run.fix("water")->compute_scalar();
    EXPECT_NEAR((mass(run) - before - 1000.0 * came) / before, 0.0, 1e-13);
  }
}

/** A full surface takes water into dry soil, from -10 m: 1 m with n cells. K: of the water. */
std::string absorbs(int n, double K, double end)
{
  const double h = 1.0 / n;
  return plane("si", "f p", strprintf("0 1 0 %.17g", 2 * h), 1, 0.3 * h) +
      strprintf("fix grid all mpm %.17g\ncreate_points 1 box ppc 2\n", h) +
      "fix m all mpm/material density 2000 linear 1e8 0.0\nfix ends all mpm/boundary xlo xhi "
      "slip\n" +
      strprintf(
             "fix water all mpm/pore %g 1000 9810 soil m 0.4 constant 0.1 retention vangenuchten "
             "%.17g 1.6 saturation 0.1 1 initial -98100 xlo pressure 0\n",
             K, 3.35 / WEIGHT) +
      strprintf("fix dt all mpm/dt 0.1 until 0.002\nrun 100000\nfix dt all mpm/dt 0.5 until %g\n"
                "run 100000\n",
                end);
}

// Absorption into dry soil, whose water grows with the root of the time: 0.0386 m after 0.3 s,
// 0.0585 and 0.0494 with 10 and 20 finite volumes. Also where water is stiff
SERIAL_TEST(Surface, FillsDrySoil)
{
  LONG_CASE();
  for (const double K : {1e6, 1e7}) {
    double more[2];
    for (const int n : {10, 20}) {
      Scene run(absorbs(n, K, 0.3));
      const double came = run.fix("water")->compute_scalar() * n / 2.0;
      more[n == 20] = measured(strprintf("K %g, %d cells, water", K, n), came) - 0.0386;
    }
    EXPECT_LT(more[0], 0.0585 - 0.0386);
    EXPECT_LT(more[1], 0.0494 - 0.0386);
    EXPECT_GT(more[1], 0.0);
    EXPECT_LT(more[1], 0.6 * more[0]);
  }
}

// soil that dries to a suction outside: through any face alike
SERIAL_TEST(Surface, DriesThroughAnyFace)
{
  std::vector<double> went;
  for (const char *face : {"xlo", "xhi"}) {
    Scene run(replaced(absorbs(10, 1e6, 0.02),
                       {{"initial -98100", "initial -3000"},
                        {"xlo pressure 0", std::string(face) + " pressure -30000"}}));
    went.push_back(measured(face, run.fix("water")->compute_scalar()));
  }
  EXPECT_LT(went[0], 0.0);
  EXPECT_NEAR(went[1] / went[0], 1.0, 1e-9);
}

// pressures that jump where the last pores fill are told, and too stiff water is refused
SERIAL_TEST(Surface, StiffWater)
{
  const char *const told = "use a smaller bulk modulus of the water, K, of some 8.8e+05";
  EXPECT_EQ(times_said(absorbs(10, 1e7, 0.02), told), 0);
  EXPECT_GT(times_said(absorbs(10, 1e8, 0.02), told), 0);
  expect_error(absorbs(10, 2.2e9, 0.02), "use a smaller bulk modulus of the water");
}

const char *const OF_BLOCKS = "variable p atom 0.4*(x-4)\nvariable k atom 0.01*(1+y)\n";
/** Two blocks of soils that dry and one that does not, which collide. */
std::string blocks(const std::string &more)
{
  return colliding(
      OF_BLOCKS,
      "20.0 0.5 2.0 soil m 0.4 kozeny 0.1 retention vangenuchten 1.0 1.8 saturation 0.1 0.9 soil n "
      "0.3 formula v_k retention gardner 0.7 relative power 3 bishop effective soil o 0.2 constant "
      "0.01 " +
          more);
}

TEST(Ranks, Agree)
{
  expect_same_on_ranks(blocks("initial v_p"), 1e-9);
  expect_same_on_ranks(
      between_walls(
          blocks("initial v_p xlo pressure -1.0 free rain 0.02 ylo seepage xhi pressure 0.5")),
      1e-9);
}

TEST(Restart, Continues)
{
  expect_continues(blocks("free rain 0.02 initial v_p"), OF_BLOCKS);
}

// a body whose water flows keeps its mass and its momentum while it moves
TEST(Momentum, OfABodyThatMoves)
{
  Scene run(
      plane("lj", "p p", "0 8 0 8", 1, 0.4) + "fix grid all mpm 0.5\n" +
      bodies({{"one", "block 2 5 3 5 -0.5 0.5"}}) +
      "fix m one mpm/material density 1.0 linear 50.0 0.2\n"
      "velocity all set 1.0 0.5 0\nvariable p atom 0.5*(x-4)\n"
      "fix water all mpm/pore 50.0 0.5 1.0 soil m 0.4 constant 0.1 retention vangenuchten 1.0 2.0 "
      "initial v_p\ntimestep 0.005\nrun 0\n");
  const auto sums = [&]() {
    const auto s = run.sums();
    return over_ranks({s.mass, s.p[0], s.p[1]});
  };
  const auto before = sums();
  run.commands("run 400\n");
  const auto after = sums();
  EXPECT_NEAR(after[0] / before[0], 1.0, 1e-13);
  for (int d = 1; d < 3; d++) EXPECT_NEAR(measured("momentum", after[d] / before[d]), 1.0, 8e-5);
}

// the ledger closes with suction, and the time step is that of waves in soil with as much water
SERIAL_TEST(Ledger, Closes)
{
  Scene run(column(20, std::string(SAND) + DRIES + "geostatic 0.5 0.4 yhi rain 1e-3",
                   "2002 linear 1e7 0.3", 1.0) +
            "velocity all set 0 0.01 0\ncompute e all mpm/energy\nfix dt all mpm/dt 0.2\nrun 0\n");
  const double before = run.compute_scalar();
  run.commands("run 2000\n");
  EXPECT_NEAR(measured("residual", run.compute_vector()[10] / before), 0.0, 1e-10);
}

SERIAL_TEST(TimeStep, OfDrySoil)
{
  const double M = 1e7 * 0.7 / (1.3 * 0.4);
  Scene run(column(10,
                   "2.2e9 1000 9810 soil m 0.4 constant 1e-9 retention gardner 1e-4 initial -2e4",
                   "2002 linear 1e7 0.3") +
            "run 0\n");
  const double S = std::exp(-2.0), w = S * std::exp(-2e4 / 2.2e9),
               storage = 0.4 * w * (1e-4 + 1.0 / 2.2e9);
  const double density = 2002.0 - 400.0 * (1.0 - w);
  EXPECT_NEAR(run.stable_dt() / (0.1 / std::sqrt((M + S * w / storage) / density)), 1.0, 1e-12);
  // and that of flow: of 64 stages, or of one
  Scene flow(column(10,
                    "2.2e9 1000 9810 soil m 0.4 constant 10 retention gardner 1e-4 initial -2e4 "
                    "stages 1",
                    "2002 linear 1e7 0.3") +
             "run 0\n");
  const double D = 10.0 / 9810.0 * S / storage;
  EXPECT_NEAR(flow.stable_dt() / (0.98 * 0.01 / (6.0 * D)), 1.0, 3e-6);
}

// units in which mass, energy, and pressure do not fit together, in three dimensions: at rest
SERIAL_TEST(Units, MetalInThreeDimensions)
{
  const double nktv2p = 1.6021765e6, gradient = 0.5 * 2.0 * nktv2p;
  Scene run(
      space("metal", "p p f", "0 20 0 20 0 110", 1, 1.5) +
      "region soil block 0 20 0 20 0 100\ncreate_points 1 region soil spacing 2.5\n"
      "fix grid all mpm 5.0\nfix m all mpm/material density 1.0 linear 1e12 0.0\n"
      "fix floor all mpm/boundary zlo slip\nfix g all gravity 2.0 vector 0 0 -1\n" +
      strprintf("fix water all mpm/pore 1e12 0.5 1.0 soil m 0.4 constant 1e-9 retention gardner "
                "%.17g geostatic 0.5 40 free seepage\n",
                0.02 / gradient) +
      "timestep 1e-6\nrun 0\n");
  const auto S = values(run, "saturation");
  for (int i = 0; i < run.n(); i++)
    EXPECT_NEAR(S[i], std::exp(-0.02 * std::max(0.0, run.x()[i][2] - 40.0)), 1e-12);
  run.commands("run 200\n");
  double most = 0.0;
  for (int i = 0; i < run.n(); i++)
    for (int d = 0; d < 3; d++) grow(most, run.v()[i][d]);
  EXPECT_LT(measured("velocity over that of free fall", most / (2.0 * 2e-4)), 1e-9);
}

SERIAL_TEST(BadInput, IsRefused)
{
  const std::string plain = plane("si", "f p", "0 4 0 4", 1, 0.1) +
      "fix grid all mpm 1.0\ncreate_points 1 box ppc 2\n"
      "fix m all mpm/material density 2000.0 linear 1e7 0.3\ntimestep 1e-4\n";
  const std::string water = "fix water all mpm/pore 2e7 1000 9810 ",
                    soil = water + "soil m 0.4 constant 1e-5 ";
  expect_refused(
      plain,
      {{water + "retention gardner 1e-4", "needs a soil"},
       {soil + "retention brooks 1e-4", "must be one of vangenuchten gardner"},
       {soil + "retention gardner 0", "alpha"},
       {soil + "retention vangenuchten 1e-4", "n"},
       {soil + "retention vangenuchten 1e-4 1.0", "n"},
       {soil + "saturation 0.1 1", "needs the retention"},
       {soil + "relative mualem", "needs the retention"},
       {soil + "bishop effective", "needs the retention"},
       {soil + "retention gardner 1e-4 saturation 0.5 0.4", "Sr below Ss"},
       {soil + "retention gardner 1e-4 saturation 0.5 1.4", "Ss"},
       {soil + "retention gardner 1e-4 relative mualem", "mualem is for retention vangenuchten"},
       {soil + "retention gardner 1e-4 relative power -1", "e"},
       {soil + "retention gardner 1e-4 biot 0.9 1e10", "needs rigid grains"},
       {soil + "suction 100", "needs geostatic"},
       {soil + "geostatic 0.5 1 suction 100", "suction needs a soil with retention"},
       {soil + "xlo rain -1e-3", "must not be negative"},
       {soil + "xlo seepage 0", "seepage"},
       {"fix water all mpm/pore 2e7 6000 9810 soil m 0.4 constant 1e-5 retention gardner 1e-4",
        "below that of the water in its pores"},
       {soil + "retention gardner 1e-3 initial -1e3 xlo flux -1000", "flows out of point"},
       {soil + "retention gardner 1e-3 initial -1e3 xlo flux -1000",
        "use a smaller time step (fix mpm/dt), or, where a flux"}},
      "run 100\n");
}
