// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// timeout: 900

// Scenes with several pieces at work: impact, flow, grains on a block.

#include "mpm_lammps.h"

using namespace MPM_TEST;

// E3: Taylor bar, OFHC copper, 190 m/s, 25.4 mm x 7.6 mm. Experiment (Johnson, Holmquist, J. Appl.
// Phys. 64 (1988) 3901): length 16.2, diameter 13.5, diameter at 0.2 of the initial length 10.1 mm.
TEST(TaylorBar, OfhcCopper)
{
  LONG_CASE();
  const double h = 0.0005, d = 0.25 * h;    // d: half the spacing of points
  Scene run;
  // a quarter of the bar
  run.commands(
      space("si", "f f f", "0 0.0085 0 0.0085 0 0.027", 1, 0.5 * h) +
      strprintf("fix grid all mpm %.17g\nregion bar cylinder z 0 0 0.0038 0 0.0254\n"
                "create_points 1 region bar ppc 2 outside ignore\n"
                "fix copper all mpm/material file Cu_OFHC_J2.mpm\nvelocity all set 0 0 -190\n"
                "fix anvil all mpm/boundary zlo xlo ylo slip\nfix step all mpm/dt 0.5\n"
                "variable t equal time\nfix end all halt 10 v_t > 8.0e-5 error continue\n"
                "run 4000\n",
                h));
  EXPECT_NEAR(run.time(), 8.0e-5, 2.0e-6);
  double top = 0.0, foot = 0.0, waist = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double *x = run.x()[i], r = sqrt(x[0] * x[0] + x[1] * x[1]);
    top = std::max(top, x[2]);
    foot = std::max(foot, r);
    if (std::abs(x[2] - 0.2 * 0.0254) < 0.5 * h) waist = std::max(waist, r);
  }
  const double length = measured("E3 length", 1.0e3 * (top + d));
  const double diameter = measured("E3 diameter", 2.0e3 * (foot + d));
  const double width = measured("E3 width", 2.0e3 * (waist + d));
  const double error = (std::abs(length / 16.2 - 1.0) + std::abs(diameter / 13.5 - 1.0) +
                        std::abs(width / 10.1 - 1.0)) /
      3.0;
  EXPECT_LT(measured("E3 mean error", error), 0.04);
  // and finite elements with the same law: 16.27, 13.48, 10.16
  EXPECT_NEAR(length, 16.27, 0.015 * 16.27);
  EXPECT_NEAR(diameter, 13.48, 0.04 * 13.48);
  EXPECT_NEAR(width, 10.16, 0.03 * 10.16);
}

// H1: dam break (J.C. Martin, W.J. Moyce, Phil. Trans. A 244 (1952) 312), a = 57.15 mm, height 2 a;
// front Z = x/a over T = t sqrt(2 g/a) (table 2), height H over tau = t sqrt(g/a) (table 6).
// Numerical fronts are earlier than the gate of the experiment: a shift up to 0.2 is allowed. (With
// 10, 20, 40 cells in a, apic: slope 1.455, 1.401, 1.416; the front at T = 1, 2, 3 is at 1.43,
// 2.63, 4.10, at 1.51, 2.67, 4.08, and at 1.55, 2.66, 4.09: it is late at the start, while it is
// within one cell of the floor, and right from T = 2 on.)
PARAMETER_TEST(DamBreak, MartinMoyce, const char *,
               Values("apic", "aflip 1.0", "flip 0.99 scheme musl"))
{
  LONG_AFTER(1);
  static const double front[][2] = {{.41, 1.11},  {.84, 1.22},  {1.19, 1.44}, {1.43, 1.67},
                                    {1.63, 1.89}, {1.83, 2.11}, {1.98, 2.33}, {2.20, 2.56},
                                    {2.32, 2.78}, {2.51, 3.00}, {2.65, 3.22}, {2.83, 3.44},
                                    {2.98, 3.67}, {3.11, 3.89}, {3.33, 4.11}};
  static const double height[][2] = {{.56, .94},  {.77, .89},  {.93, .83},  {1.08, .78},
                                     {1.28, .72}, {1.46, .67}, {1.66, .61}, {1.84, .56},
                                     {2.00, .50}, {2.21, .44}, {2.45, .39}};
  const double a = 0.05715, g = 9.81, h = a / 10.0;
  Scene run(
      plane("si", "f f", strprintf("0 %.17g 0 %.17g", 6.0 * a, 3.0 * a), 1, 0.5 * h) +
      strprintf(
          "fix grid all mpm %.17g transfer %s\nregion column block 0 %.17g 0 %.17g INF INF\n"
          "create_points 1 region column ppc 2\n"
          "fix water all mpm/material density 1000 eos tait 225000 7 viscosity newtonian 0.001\n"
          "fix walls all mpm/boundary xlo xhi ylo slip\nfix g all gravity %.17g vector 0 -1 0\n"
          "fix step all mpm/dt 0.4\nvariable t equal time\n"
          "fix end all halt 10 v_t > 0.19 error continue\n",
          h, GetParam(), a, 2.0 * a, g));
  const auto start = run.sums();
  std::vector<double> time, Z, H;
  double volume0 = 0.0, volume_error = 0.0, speed = 0.0;
  run.each_step(
      [&](double **) {
        double x = 0.0, y = 0.0, volume = 0.0;
        for (int i = 0; i < run.n(); i++) {
          x = std::max(x, run.x()[i][0]);
          y = std::max(y, run.x()[i][1]);
          volume += run.points().jacobian(i) * run.lmp->atom->vfrac[i];
        }
        if (time.empty()) volume0 = volume;
        grow(volume_error, volume / volume0 - 1.0);
        time.push_back(run.time());
        Z.push_back((x + 0.25 * h) / a);
        H.push_back((y + 0.25 * h) / (2.0 * a));
        if (time.size() > 20) {
          const int k = time.size() - 1;
          speed = std::max(speed, (Z[k] - Z[k - 20]) * a / (time[k] - time[k - 20]));
        }
      },
      5);
  run.commands("run 20000\n");
  auto at = [&](const std::vector<double> &y, double t) {
    int k = 1;
    while (k < (int) time.size() - 1 && time[k] < t) k++;
    return y[k - 1] + (y[k] - y[k - 1]) * (t - time[k - 1]) / (time[k] - time[k - 1]);
  };
  auto rms_front = [&](double shift) {
    double sum = 0.0;
    for (const auto &p : front)
      sum += pow(at(Z, std::max(0.0, p[0] - shift) / sqrt(2.0 * g / a)) - p[1], 2);
    return sqrt(sum / 15.0);
  };
  double best = 0.0;
  for (double shift = 0.0; shift <= 0.2001; shift += 0.01)
    if (rms_front(shift) < rms_front(best)) best = shift;
  measured("H1 shift", best);
  EXPECT_LT(measured("H1 rms of front", rms_front(best)), 0.1);
  const double slope =
      (at(Z, (3.3 - best) / sqrt(2.0 * g / a)) - at(Z, (2.0 - best) / sqrt(2.0 * g / a))) / 1.3;
  EXPECT_NEAR(measured("H1 slope of front", slope), 1.37, 0.12);
  double sum = 0.0;
  for (const auto &p : height) sum += pow(at(H, p[0] / sqrt(g / a)) - p[1], 2);
  EXPECT_LT(measured("H1 rms of height", sqrt(sum / 11.0)), 0.03);
  EXPECT_LT(measured("H1 speed/Ritter bound", speed / (2.0 * sqrt(g * 2.0 * a))), 1.0);
  EXPECT_LT(measured("H1 volume", volume_error), 0.02);
  EXPECT_DOUBLE_EQ(run.sums().mass, start.mass);
}

// pitfall 9: the wave speed of a Tait liquid, and a time step that is stable
TEST(Tait, WaveSpeed)
{
  // K = 100, gamma = 7, density 1: c = 10 at rest, c^2 = K (density ratio)^(gamma - 1)
  for (const double J : {1.0, 0.9}) {
    const double h = 0.01, A = 1.0e-5, width = 0.3, speed = 10.0 * pow(J, -3.0);
    Scene run(plane("si", "f p", strprintf("0 3 0 %g", h), 1, 0.4 * h) +
              strprintf("fix grid all mpm %g\ncreate_points 1 box ppc 2 1\n"
                        "fix m all mpm/material density 1 eos tait 100 7\n"
                        "fix ends all mpm/boundary xlo xhi slip\ncompute c all mpm/atom wavespeed\n"
                        "compute cmax all reduce max c_c\nthermo_style custom step c_cmax\n",
                        h));
    for (int i = 0; i < run.n(); i++) {
      const double X = run.x()[i][0], gauss = exp(-pow((X - 0.9) / width, 2));
      const double strain = -2.0 * A * (X - 0.9) / (width * width) * gauss, JJ = J * (1.0 + strain);
      run.x()[i][0] += A * gauss;
      run.v()[i][0] = -speed * strain;
      // uniformly compressed to J before: by Fyy and Fzz, the points are where they are
      run.points().F[i][0] = 1.0 + strain;
      run.points().F[i][4] = J;
      run.lmp->atom->vfrac[i] /= J;
      run.mass()[i] = run.lmp->atom->vfrac[i];
      const double p = 100.0 / 7.0 * (pow(JJ, -7.0) - 1.0);
      for (int d = 0; d < 3; d++) run.points().tau[i][d] = -JJ * p;
    }
    double position = 0.0, first = 0.0;
    run.each_step([&](double **) {
      double energy = 0.0;
      position = 0.0;
      for (int i = 0; i < run.n(); i++) {
        const double e = run.v()[i][0] * run.v()[i][0];
        energy += e;
        position += e * run.x()[i][0];
      }
      position /= energy;
      if (run.time() == 0.0) first = position;
    });
    const double dt = 0.3 * h / speed;
    const int n = std::lround(1.2 / speed / dt);
    run.commands(strprintf("timestep %.17g\nrun %d\n", dt, n));
    EXPECT_NEAR(measured(strprintf("Tait wave speed/exact, J = %g", J),
                         (position - first) / (n * dt) / speed),
                1.0, 0.01);
    EXPECT_NEAR(run.compute_scalar("cmax") / speed, 1.0, 1.0e-3);
  }
}

// two halves of a liquid collide at half the wave speed, time step 0.8 of the limit
TEST(Tait, TimeStepIsStable)
{
  for (auto *options :
       {"shape quadratic transfer apic", "shape quadratic transfer flip 1.0 scheme musl"}) {
    Scene run(plane("si", "f p", "0 3 0 0.02", 1, 0.01) +
              strprintf("fix grid all mpm 0.02 %s\nregion liquid block 1 2 INF INF INF INF\n"
                        "create_points 1 region liquid ppc 2 1\n"
                        "fix m all mpm/material density 1000 eos tait 225000 7\n"
                        "fix step all mpm/dt 0.8\n",
                        options));
    run.set_velocity([](const double *x, double *v) {
      v[0] = x[0] < 1.5 ? 4.0 : -4.0;
    });
    const double start = run.sums().kinetic;
    double worst = 0.0, smallest = 1.0;
    run.each_step([&](double **) {
      worst = std::max(worst, (run.sums().kinetic + run.stored_energy()) / start);
      for (int i = 0; i < run.n(); i++) smallest = std::min(smallest, run.points().jacobian(i));
    });
    run.commands("run 100\n");
    // 1.004 and, as FLIP damps nothing at this large a step, 1.042
    EXPECT_LT(measured(std::string("Tait impact, largest E/E0, ") + options, worst), 1.06);
    EXPECT_LT(measured(std::string("Tait impact, smallest J, ") + options, smallest), 0.85);
  }
}

// K1(a): a grain (pair style granular) hits a free block of material points off its centre
static std::string grain_on_block(const std::string &options, const std::string &tangential)
{
  return strprintf("units si\nboundary f f f\natom_style hybrid sphere mpm\ncomm_modify vel yes\n"
                   "neighbor 0.002 bin\nregion box block -0.06 0.06 -0.06 0.06 -0.06 0.08\n"
                   "create_box 2 box\nfix grid all mpm 0.005 %s\n"
                   "region block block -0.02 0.02 -0.02 0.02 -0.02 0\n"
                   "create_points 1 region block ppc 2\ngroup block type 1\n"
                   "fix soft block mpm/material density 1000 neohookean 1.0e5 0.3\n"
                   "create_atoms 2 single 0.0061 -0.0033 0.00855\ngroup grains type 2\n"
                   "set type 1 diameter 0.0025\nset type 2 diameter 0.014 density 2500\n"
                   "velocity grains set 0.05 0.03 -0.5\npair_style granular\n"
                   "pair_coeff * * hertz 1.0e5 0.0 %s\nneigh_modify exclude type 1 1\n"
                   "fix move grains nve/sphere\ntimestep 2.5e-5\n",
                   options.c_str(), tangential.c_str());
}

PARAMETER_TEST(GrainOnBlock, Momentum, const char *,
               Values("transfer apic", "transfer flip 1.0 scheme musl",
                      "frame total transfer apic"))
{
  LONG_AFTER(1);
  for (const bool friction : {false, true}) {
    SCOPED_TRACE(friction ? "friction" : "no friction");
    Scene run(grain_on_block(GetParam(),
                             friction ? "tangential linear_history 300.0 0.0 0.5"
                                      : "tangential linear_nohistory 0.0 0.0"));
    const auto start = run.sums();
    const double scale = run.sums(2).mass * 0.5;
    double p = 0.0, L = 0.0;
    run.each_step([&](double **) {
      const auto s = run.sums();
      for (int d = 0; d < 3; d++) {
        p = std::max(p, std::abs(s.p[d] - start.p[d]) / scale);
        L = std::max(L, std::abs(s.L[d] - start.L[d]) / (scale * 0.02));
      }
    });
    run.commands("run 1000\n");
    // it did bounce
    EXPECT_GT(run.sums(2).p[2], 0.0);
    EXPECT_LT(run.sums(1).p[2], -0.5 * scale);
    const std::string name = strprintf("K1(a) %s%s: ", GetParam(), friction ? ", friction" : "");
    EXPECT_LT(measured(name + "momentum", p), 1.0e-12);
    // also with tangential forces, whose torque a point takes into its affine field (without:
    // 0.0015); FLIP does not keep it, and in the total frame only affine motion does
    measured(name + "angular momentum", L);
    if (name.find("apic") != std::string::npos) {
      EXPECT_LT(L, name.find("total") == std::string::npos ? 1.0e-12 : 4.0e-4);
    }
    // out of contact there is no energy but that of motion and in the block. FLIP with MUSL keeps
    // it to first order in the time step; friction takes 7 %. APIC damps vibrations of 8 cells.
    double spin = 0.0;
    for (int i = 0; i < run.n(); i++)
      if (run.lmp->atom->type[i] == 2)
        for (int d = 0; d < 3; d++)
          spin +=
              0.2 * run.mass()[i] * pow(run.lmp->atom->radius[i] * run.lmp->atom->omega[i][d], 2);
    const double energy = (run.sums().kinetic + spin + run.stored_energy()) / start.kinetic;
    measured(name + "energy", energy);
    if (!friction && name.find("flip") != std::string::npos) { EXPECT_NEAR(energy, 1.0, 0.01); }
  }
}

// K1(b): a grain hits the end of a column between slipping sides: v' = -F/m - F'/Z with
// F = k delta^(3/2), Z = density c A. k^.4 m^.6 v^.2/Z = .102252: e = .840153, t = .904748 ms.
// The column is one cell wide, one point to a layer, so that the grain pushes on the whole face;
// mass and stiffness are those of the case with 20 x 20 mm, times the ratio of the faces.
PARAMETER_TEST(GrainOnColumn, Restitution, int, Values(1, 2, 5, 10, 20))
{
  LONG_AFTER(1);
  const double ratio = 25.0e-6 / 400.0e-6;
  const double m = 1.308997e-3 * ratio, k = 1.03584e6 * ratio, Z = 46.40955 * ratio;

  // the differential equation: delta' = v - F/Z, v' = -F/m
  double delta = 0.0, v = 1.0, t = 0.0, dt = 1.0e-8, force = 0.0;
  while (t == 0.0 || delta > 0.0) {
    auto rate = [&](double d, double w, double *r) {
      const double F = d > 0.0 ? k * pow(d, 1.5) : 0.0;
      r[0] = w - F / Z;
      r[1] = -F / m;
    };
    double a[2], b[2];
    rate(delta, v, a);
    rate(delta + 0.5 * dt * a[0], v + 0.5 * dt * a[1], b);
    delta += dt * b[0];
    v += dt * b[1];
    t += dt;
    force = std::max(force, -m * b[1]);
  }
  EXPECT_NEAR(-v, 0.840153, 1.0e-5);
  EXPECT_NEAR(t, 0.904748e-3, 1.0e-7);

  const double R = 0.002, Rp = 0.00125, Reff = R * Rp / (R + Rp);
  const double density = m / (4.0 / 3.0 * 3.14159265358979323846 * R * R * R);
  Scene run(strprintf(
      "units si\nboundary f f f\natom_style hybrid sphere mpm\ncomm_modify vel yes\n"
      "neighbor 0.002 bin\nregion box block 0 0.005 0 0.005 -0.16 0.02\ncreate_box 2 box\n"
      "fix grid all mpm 0.005 every %d\nregion column block 0 0.005 0 0.005 -0.15 0\n"
      "create_points 1 region column ppc 1 1 2\ngroup column type 1\n"
      "fix m column mpm/material density 1000 linear 1.0e7 0.3\n"
      "fix sides all mpm/boundary xlo xhi ylo yhi slip\ncreate_atoms 2 single 0.0025 0.0025 %.17g\n"
      "group grains type 2\nset type 1 diameter 0.0025\nset type 2 diameter %.17g density %.17g\n"
      "velocity grains set 0 0 -1\npair_style granular\n"
      "pair_coeff * * hertz %.17g 0.0 tangential linear_nohistory 0.0 0.0\n"
      "neigh_modify exclude type 1 1\nfix move grains nve/sphere\ncompute e all mpm/energy\n"
      "timestep 1.0e-6\nthermo_style custom step c_e[6]\n",
      GetParam(), -0.00125 + R + Rp + 1.0e-5, 2.0 * R, density, k / sqrt(Reff)));
  ASSERT_NEAR(run.sums(2).mass / m, 1.0, 1.0e-12);
  double largest = 0.0, first = -1.0, last = 0.0;
  run.each_step([&](double **) {
    for (int i = 0; i < run.n(); i++) {
      if (run.lmp->atom->type[i] != 2) continue;
      const double F = run.lmp->atom->f[i][2];
      largest = std::max(largest, F);
      if (F > 0.0) {
        if (first < 0.0) first = run.time();
        last = run.time();
      }
    }
  });
  run.commands("run 1600\n");

  // what the grain has lost and the column has not received
  const double energy = 0.5 * m, lost = energy - run.sums(2).kinetic - run.evaluate("c_e[6]");
  // of first order in the step of the points
  EXPECT_LT(std::abs(measured("K1(b) energy lost between grain and points/exact", lost / energy)),
            3.4e-5 * (3 + GetParam()));
  EXPECT_NEAR(measured("K1(b) e", run.sums(2).p[2] / m), 0.840153, 0.02 * 0.840153);
  EXPECT_NEAR(measured("K1(b) contact time", last - first), 0.904748e-3, 0.02 * 0.904748e-3);
  EXPECT_NEAR(measured("K1(b) largest force/exact", largest / force), 1.0, 0.03);
}

// K1(d): a grain rests on a block under gravity for 1e5 steps. Asked: the force is its weight to 1
// %, the center of mass does not drift, nothing heats up. It has settled, with viscous friction,
// before. Flip 1.0 is not here: with musl it gains energy without bound in so many steps
// (Howto_mpm_stability), and throws the grain.
TEST(GrainAtRest, HundredThousandSteps)
{
  LONG_CASE();
  for (const char *options : {"transfer apic", "transfer flip 0.99 scheme musl"}) {
    Scene run(
        strprintf("units si\nboundary p p f\natom_style hybrid sphere mpm\ncomm_modify vel yes\n"
                  "neighbor 0.002 bin\nregion box block 0 0.02 0 0.02 0 0.04\ncreate_box 2 box\n"
                  "fix grid all mpm 0.005 %s\nregion block block INF INF INF INF 0 0.01\n"
                  "create_points 1 region block ppc 2\ngroup block type 1\n"
                  "fix soft block mpm/material density 1000 neohookean 1.0e5 0.3\n"
                  "fix floor all mpm/boundary zlo stick\n"
                  "create_atoms 2 single 0.0101 0.0097 0.0159\ngroup grains type 2\n"
                  "set type 1 diameter 0.0025\nset type 2 diameter 0.012 density 2500\n"
                  "pair_style granular\npair_coeff * * hertz 1.0e5 0.0 tangential linear_history "
                  "300.0 0.0 0.5\n"
                  "neigh_modify exclude type 1 1\nfix move grains nve/sphere\n"
                  "fix g grains gravity 9.81 vector 0 0 -1\ntimestep 1.0e-4\n"
                  "fix slow all viscous 0.02\nrun 20000\nunfix slow\nrun 1000\n",
                  options));
    const auto start = run.sums(2), block = run.sums(1);
    double force = 0.0, worst = 0.0, n = 0.0, drift = 0.0, fastest = 0.0;
    run.each_step(
        [&](double **) {
          for (int i = 0; i < run.n(); i++) {
            if (run.lmp->atom->type[i] != 2) continue;
            const double f = run.lmp->atom->f[i][2] / (9.81 * start.mass) + 1.0;
            force += f;
            grow(worst, f - 1.0);
            n++;
          }
          const auto grain = run.sums(2);
          for (int d = 0; d < 3; d++) {
            grow(drift, grain.x[d] - start.x[d]);
            grow(drift, run.sums(1).x[d] - block.x[d]);
          }
          fastest = std::max(fastest, grain.kinetic + run.sums(1).kinetic);
        },
        100);
    run.commands("run 100000\n");
    const std::string name = strprintf("K1(d) %s: ", options);
    EXPECT_NEAR(measured(name + "mean force/weight", force / n), 1.0, 0.01);
    EXPECT_LT(measured(name + "largest difference of the force", worst), 0.01);
    // what F2 of the references allows to a body that sticks: 1e-3 R in a second
    EXPECT_LT(measured(name + "drift in 10 s/R", drift / 0.006), 1.0e-2);
    // of the energy of a fall by the depth of the contact, some 0.1 mm
    EXPECT_LT(measured(name + "kinetic energy/m g 0.1 mm", fastest / (start.mass * 9.81e-4)),
              1.0e-3);
  }
}
