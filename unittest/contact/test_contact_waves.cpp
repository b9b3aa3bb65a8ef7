// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// timeout: 300

// A stress wave meets the interface of two bars that touch (fix mpm/contact): of a compressive
// pulse, the share T = 2 Z2/(Z1 + Z2) of the stress goes on, R = (Z2 - Z1)/(Z1 + Z2) returns, with
// the impedances Z = rho c; tension does not pass.

#include "mpm_lammps.h"

using namespace MPM_TEST;

// both bars have the length 1, c = 10; Z1 = 10. A pulse p sin^2(pi t/tau) is 0.3 long.
static constexpr double PULSE = 0.03, WIDTH = 0.16;

static const std::string bars = plane("si", "f p", "-0.5 2.9 0 0.16 -0.05 0.05", 2) +
    "neighbor $(0.5*v_h) bin\n" +
    fields({{"one", "block 0 1 0 0.16 -0.05 0.05"}, {"two", "block 1 2 0 0.16 -0.05 0.05"}},
           "${h} OPTIONS") +
    R"(
fix m1 one mpm/material density 1 linear 100 0
fix m2 two mpm/material density RATIO linear $(100*RATIO) 0
fix c all mpm/contact F1 F2
timestep $(0.04*v_h)
variable p1 equal vcm(one,x)*mass(one)/0.16
variable p2 equal vcm(two,x)*mass(two)/0.16
variable gap equal bound(two,xmin)-bound(one,xmax)-0.5*v_h
)";

/** The bars, with a pulse of this stress on its way from the left end at time 0. */
struct Bars {
  Scene run;
  double impulse = 0.0;    // given so far

  Bars(double h, const std::string &options, double ratio, double p)
  {
    run.commands(strprintf("variable h equal %g\n", h) +
                 replaced(bars, {{"RATIO", strprintf("%g", ratio)}, {"OPTIONS", options}}));
    run.set_reference();
    run.each_step([this, h, p](double **force) {
      const double dt = run.lmp->update->dt,
                   t = run.time() + 0.5 * dt;    // middle of the step to come
      if (t > PULSE) return;
      const double stress = p * std::pow(std::sin(PI * t / PULSE), 2);
      impulse += stress * dt;
      for (int i = 0; i < run.n(); i++)
        if (run.reference(i)[0] < 0.5 * h) force[i][0] = stress * 0.5 * h;
    });
  }
  void until(double t)
  {
    const double steps = (t - run.time()) / run.lmp->update->dt;
    run.commands(strprintf("run %d post no\n", (int) std::lround(steps)));
  }
  double momentum(int bar) { return run.evaluate("v_p" + std::to_string(bar)); }
  double stress() { return run.evaluate("f_c[1][1]") / WIDTH; }
  double gap() { return run.evaluate("v_gap"); }
};

// The pulse has 15 and 30 cells. Nodes that two bodies share have an error of their own, which
// falls with more than the first power of the spacing
class Waves : public ::testing::TestWithParam<const char *> {};

TEST_P(Waves, CompressionPasses)
{
  LONG_CASE();
  for (const double ratio : {1.0, 4.0, 0.25}) {
    const double T = 2.0 * ratio / (1.0 + ratio);
    double error[2], peak_error[2];
    for (int k = 0; k < 2; k++) {
      Bars bars(k ? 0.01 : 0.02, GetParam(), ratio, 1.0);
      double peak = 0.0;
      for (int n = 1; n <= 80; n++) {
        bars.until(0.09 + 0.001 * n);
        peak = std::max(peak, bars.stress());
      }
      // at 0.17 both pulses are away from the interface and the ends; none has been lost: R - T = 1
      const double p1 = bars.momentum(1) / bars.impulse, p2 = bars.momentum(2) / bars.impulse;
      EXPECT_NEAR(bars.impulse, 0.5 * PULSE, 1e-3 * PULSE);
      EXPECT_NEAR(p1 + p2, 1.0, 1e-10);
      EXPECT_EQ(bars.stress(), 0.0);
      const std::string name = strprintf("Z2/Z1 = %g, %d cells: ", ratio, 15 << k);
      error[k] = std::fabs(measured(name + "transmitted/exact", p2 / T) - 1.0);
      peak_error[k] = std::fabs(measured(name + "peak of the stress/exact", peak / T) - 1.0);
    }
    EXPECT_LT(error[1], 0.03);
    EXPECT_LT(error[1], 0.5 * error[0]);
    EXPECT_LT(peak_error[1], 0.04);
  }
}

// A compressive pulse comes back from the free end as tension, which parts the bars: the gap is
// twice the displacement impulse/Z2 that a pulse carries. Tension from the first bar does not pass
TEST_P(Waves, TensionParts)
{
  LONG_CASE();
  double error[2];
  for (int k = 0; k < 2; k++) {
    const double h = k ? 0.01 : 0.02;
    Bars bars(h, GetParam(), 1.0, 1.0);
    bars.until(0.17);
    const double p1 = bars.momentum(1);
    bars.until(0.45);
    const double exact = 2.0 * bars.impulse / 10.0;
    EXPECT_NEAR(bars.momentum(1), p1, 1e-12 * bars.impulse);    // nothing comes back
    EXPECT_EQ(bars.stress(), 0.0);
    error[k] = std::fabs(measured("gap/exact", bars.gap() / exact) - 1.0);

    Bars pulled(h, GetParam(), 1.0, -1.0);
    pulled.until(0.17);
    EXPECT_NEAR(measured("tension that passes", pulled.momentum(2) / pulled.impulse), 0.0, 1e-5);
    EXPECT_NEAR(measured("gap/exact", pulled.gap() / (-2.0 * pulled.impulse / 10.0)), 1.0, 0.02);
  }
  EXPECT_LT(error[1], 0.05);
  EXPECT_LT(error[1], 0.5 * error[0]);
}

INSTANTIATE_TEST_SUITE_P(Contact, Waves,
                         ::testing::Values("transfer flip 1.0 scheme musl", "transfer apic"));
