// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics extreme
// timeout: 300

// Materials next to each other that differ by factors of 1000 in density and of 1e6 in stiffness.

#include "mpm_lammps.h"

using namespace MPM_TEST;

// J3: a bar whose half is 1e6 times as stiff, of the same density: the impedances have the ratio
// 1000. Of a pulse in the soft half R = 999/1001 = .99800 of the stress returns, and 1.99800 goes
// on, to 1 %; the end of the stiff half absorbs it. The functions of the total frame are linear, so
// that nothing is smeared but one cell.
static constexpr double H = 0.1, SOFT = 1.0, STIFF = 1.0e6;

static std::string two_stiffnesses(double soft, double stiff)
{
  return plane("lj", "f p", strprintf("0 %g 0 %g", soft + stiff + 0.5, H), 2, 0.5 * H) +
      strprintf("fix grid all mpm %g frame total shape linear transfer flip 1.0 scheme musl\n", H) +
      bodies({{"one", strprintf("block 0 %g INF INF INF INF", soft)},
              {"two", strprintf("block %g %g INF INF INF INF", soft, soft + stiff)}},
             "ppc 2 1") +
      strprintf("fix m1 one mpm/material density 1 linear %g 0\n"
                "fix m2 two mpm/material density 1 linear %g 0\ntimestep %g\n",
                SOFT, STIFF, 0.4 * H / 1000.0);
}

TEST(StiffnessRatio, PulseReturns)
{
  const double soft = 8.0, stiff = 2.0, A = 1.0e-5, width = 0.8, Z2 = 1000.0;
  Scene run(two_stiffnesses(soft, stiff) + "run 0\n");
  run.set_reference();
  // displacement of a pulse that moves to the right, stress -A exp(-x^2/2) at its time 0
  const auto shape = [=](double x) {
    return A * exp(-0.5 * pow((x - 0.5 * soft) / width, 2));
  };
  double peak = 0.0;
  run.set_velocity([&](const double *x, double *v) {
    v[0] = 2.0 * (x[0] < soft ? shape(x[0]) : 0.0);
  });
  // two pulses of half of this go both ways; the left one returns with the other sign
  run.each_step([&](double **force) {
    double stress = 0.0, n = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const double X = run.reference(i)[0];
      if (X > soft + stiff - 0.5 * H) force[i][0] = -Z2 * run.v()[i][0] * H;
      if (X < soft + 0.4 * stiff || X > soft + 0.6 * stiff) continue;
      stress -= run.points().tau[i][0];
      n++;
    }
    if (run.time() < soft) peak = std::max(peak, stress / n);
  });
  // momentum of the soft half when the right pulse, A width sqrt(2 pi) H, and the other are back
  const double impulse = A * width * sqrt(2.0 * PI) * H;
  EXPECT_NEAR(run.sums(1).p[0] / impulse, 2.0, 1.0e-3);
  run.commands(strprintf("run %ld\n", std::lround(soft / run.lmp->update->dt)));
  const double passed = 2.0 * impulse - run.sums(1).p[0];
  EXPECT_NEAR(measured("J3 impulse that goes on/of the pulse", passed / impulse), 1.998,
              0.01 * 1.998);
  EXPECT_NEAR(measured("J3 reflection", passed / impulse - 1.0), .998, 0.01);
  EXPECT_NEAR(measured("J3 transmitted stress", peak / A), 1.998, 0.01 * 1.998);
}

// pulled by a force at its end, the two halves have strains in the ratio 1e6, to 1 %
TEST(StiffnessRatio, StrainsAtRest)
{
  const double P = 1.0e-3, omega = 2.17;    // of the stiff half on the soft one
  Scene run(two_stiffnesses(0.4, 0.4) + "fix wall all mpm/boundary xlo slip\nrun 0\n");
  run.set_reference();
  run.each_step([&](double **force) {
    for (int i = 0; i < run.n(); i++) {
      force[i][0] = -2.0 * omega * run.mass()[i] * run.v()[i][0];
      if (run.reference(i)[0] > 0.8 - 0.5 * H) force[i][0] += P * H;
    }
  });
  run.commands(strprintf("run %ld\n", std::lround(14.0 / omega / run.lmp->update->dt)));
  double strain[2] = {0.0, 0.0}, n[2] = {0.0, 0.0};
  for (int i = 0; i < run.n(); i++) {
    const double X = run.reference(i)[0];
    const int k = run.lmp->atom->type[i] - 1;
    // the cells at the joint, and the last one, in which the force is
    if (std::abs(X - 0.4) < H || X > 0.8 - H) continue;
    strain[k] += run.points().F[i][0] - 1.0;
    n[k]++;
  }
  EXPECT_NEAR(measured("J3 strain of the soft half", strain[0] / n[0]), P / SOFT, 0.01 * P);
  EXPECT_NEAR(measured("J3 ratio of the strains", strain[0] / n[0] / (strain[1] / n[1])), 1.0e6,
              1.0e4);
}

// the time step is that of the stiff half only while it is there
TEST(StiffnessRatio, TimeStep)
{
  Scene run(two_stiffnesses(0.4, 0.4) + "run 0\n");
  EXPECT_NEAR(run.stable_dt() / (H / 1000.0), 1.0, 1.0e-6);
  run.commands("delete_atoms group two\nrun 0\n");
  EXPECT_NEAR(run.stable_dt() / H, 1.0, 1.0e-6);
}

// J2: water and a gas of a thousandth of its density, one above the other in a closed column, at
// rest. After 1e4 steps: kinetic energy below 1e-4 rho g H^2, pressure of the gas to 5 %, no point
// of gas faster than sound. The column is one point wide, so that water stays above the gas.
TEST(DensityRatio, ColumnsAtRest)
{
  LONG_CASE();
  const double g = 10.0, h = 0.05, c = 40.0, K = 1000.0 * c * c, p0 = 1000.0 * g, gamma = 1.4;
  const double c_gas = sqrt(gamma * p0);
  for (const bool above : {false, true})
    for (const char *options : {"transfer apic", "transfer flip 0.99 scheme musl"}) {
      SCOPED_TRACE(std::string(options) + (above ? ", water above" : ", water below"));
      Scene run(plane("si", "p f", strprintf("0 %g 0 2", h), 2, 0.5 * h) +
                strprintf("fix grid all mpm %g %s\n", h, options) +
                bodies({{"water", strprintf("block INF INF %d %d INF INF", above, 1 + above)},
                        {"gas", strprintf("block INF INF %d %d INF INF", !above, 2 - above)}},
                       "ppc 1 2") +
                strprintf("fix m1 water mpm/material density 1000 eos tait %.17g 7\n"
                          "fix m2 gas mpm/material density 1 eos ideal/gas 1.4 energy %.17g\n"
                          "fix walls all mpm/boundary ylo yhi slip\n"
                          "fix g all gravity %g vector 0 -1 0\ntimestep %.17g\n",
                          K, p0 / (gamma - 1.0), g, 0.4 * h / c_gas));
      for (int i = 0; i < run.n(); i++) {
        if (run.lmp->atom->type[i] != 1) continue;
        const double p = above ? 1000.0 * g * (2.0 - run.x()[i][1])
                               : p0 + 1000.0 * g * (1.0 - run.x()[i][1]);
        const double J = pow(1.0 + 7.0 * p / K, -1.0 / 7.0);
        run.points().F[i][4] = J;
        run.lmp->atom->vfrac[i] /= J;
        for (int d = 0; d < 3; d++) run.points().tau[i][d] = -J * p;
      }
      double fastest = 0.0;
      run.each_step(
          [&](double **) {
            for (int i = 0; i < run.n(); i++)
              if (run.lmp->atom->type[i] == 2) fastest = std::max(fastest, std::abs(run.v()[i][1]));
          },
          10);
      run.commands("run 10000\n");
      double low = 1.0e300, high = 0.0;
      for (const auto &s : run.gather())
        if (s.type == 2) {
          low = std::min(low, s.pressure());
          high = std::max(high, s.pressure());
        }
      const std::string name = std::string("J2 ") + options + (above ? ", water above: " : ": ");
      EXPECT_LT(measured(name + "kinetic energy/rho g H^2", run.sums().kinetic / (h * 1000.0 * g)),
                1.0e-4);
      EXPECT_GT(measured(name + "least pressure of gas", low / p0), 0.95);
      EXPECT_LT(measured(name + "largest", high / p0), 1.05);
      EXPECT_LT(measured(name + "fastest point of gas/sound", fastest / c_gas), 1.0);
      EXPECT_NEAR(run.sums().p[0], 0.0, 1.0e-10);
    }
}

// J2, in motion: a column of water, twice as high as wide, collapses in a closed tank that is full
// of this gas otherwise. Asked: pressure of the gas to 5 %, momentum to 1e-10, no point of gas
// faster than sound. The gas weighs so little that water moves as without it. The run ends when the
// front has gone as far as the column was wide. Later the pressure falls, by 23 % in another 0.8
// units of time, as the volumes of points of gas next to water, which moves them whatever their
// pressure is, drift: together they outgrow the tank.
TEST(DensityRatio, DamBreakUnderGas)
{
  LONG_CASE();
  const double h = 0.125, c = 20.0, K = 1000.0 * c * c, c_gas = 60.0, gamma = 1.4;
  const double p0 = c_gas * c_gas / gamma;
  double front[2] = {0.0, 0.0};
  for (const bool with_gas : {false, true}) {
    Scene run(plane("si", "f f", "0 5 0 3", 2, 0.4 * h) +
              strprintf("fix grid all mpm %g\nregion column block 0 1 0 2 INF INF\n"
                        "create_points 1 region column ppc 2\ngroup water type 1\n"
                        "fix m1 water mpm/material density 1000 eos tait %.17g 7\n",
                        h, K) +
              (with_gas ? strprintf("region rest block 0 1 0 2 INF INF side out\n"
                                    "create_points 2 region rest ppc 2\ngroup gas type 2\n"
                                    "fix m2 gas mpm/material density 1 eos ideal/gas %g energy "
                                    "%.17g\n",
                                    gamma, p0 / (gamma - 1.0))
                        : std::string("")) +
              strprintf("fix walls all mpm/boundary xlo xhi ylo yhi slip\n"
                        "fix g all gravity 1 vector 0 -1 0\ntimestep %.17g\n",
                        0.4 * h / c_gas));
    for (int i = 0; i < run.n(); i++) {
      if (run.lmp->atom->type[i] != 1) continue;
      const double p = (with_gas ? p0 : 0.0) + 1000.0 * (2.0 - run.x()[i][1]);
      const double J = pow(1.0 + 7.0 * p / K, -1.0 / 7.0);
      run.points().F[i][4] = J;
      run.lmp->atom->vfrac[i] /= J;
      for (int d = 0; d < 3; d++) run.points().tau[i][d] = -J * p;
    }
    run.commands("run 0\n");
    auto *walls = run.fix("walls");
    double impulse = 0.0, error = 0.0, scale = 0.0, fastest = 0.0, low = 1.0e300, high = 0.0;
    run.each_step([&](double **) {
      const auto step = run.lmp->update->ntimestep;
      if (step > 0) impulse += walls->compute_vector(0) * run.lmp->update->dt;
      if (step % 40 > 0) return;
      const double p = run.sums().p[0];
      scale = std::max(scale, std::abs(p));
      error = std::max(error, std::abs(p + impulse));
      double mean = 0.0, volume = 0.0;
      for (const auto &s : run.gather()) {
        if (s.type != 2) continue;
        fastest = std::max(fastest, std::hypot(s.v[0], s.v[1]));
        mean += s.pressure() * s.vol;
        volume += s.vol;
      }
      if (with_gas) {
        low = std::min(low, mean / volume / p0);
        high = std::max(high, mean / volume / p0);
      }
    });
    run.commands(strprintf("run %ld\n", std::lround(1.2 / run.lmp->update->dt)));
    for (const auto &s : run.gather())
      if (s.type == 1) front[with_gas] = std::max(front[with_gas], s.x[0]);
    const std::string name = strprintf("J2 dam, %s gas: ", with_gas ? "with" : "without");
    EXPECT_LT(measured(name + "error of the momentum", error / scale), 1.0e-10);
    if (!with_gas) continue;
    EXPECT_GT(measured(name + "least pressure", low), 0.95);
    EXPECT_LT(measured(name + "largest", high), 1.05);
    EXPECT_LT(measured(name + "fastest point of gas/sound", fastest / c_gas), 1.0);
  }
  EXPECT_NEAR(measured("J2 dam, front with gas", front[1]), measured("and without", front[0]), h);
}
