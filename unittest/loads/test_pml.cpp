// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Fix mpm/pml: waves leave bodies through perfectly matched layers.

#include "mpm_lammps.h"

#include "error.h"

#include <Eigen/Dense>

#include <complex>

using namespace MPM_TEST;

// density 1, Poisson number 1/4, speed of pressure waves 1
constexpr double CS = 0.57735026918962576;
const std::string MATERIAL = "fix m all mpm/material density 1 linear 0.83333333333333333 0.25\n";

/** A body that fills its box. faces and extent: see plane(). */
std::string filled(const std::string &faces, const std::string &extent, const std::string &options)
{
  return plane("lj", faces, extent, 1, 0.3) + "fix grid all mpm 1.0 " + options +
      "\ncreate_points 1 box ppc 2\n" + MATERIAL;
}

/** Kinetic energy of all points. */
double kinetic(Scene &run)
{
  double sum = 0.0;
  for (int i = 0; i < run.n(); i++)
    for (int d = 0; d < 3; d++) sum += 0.5 * run.mass()[i] * run.v()[i][d] * run.v()[i][d];
  return over_ranks(sum);
}

// Packets of plane waves at an angle to layers or dashpots at the end of a strip, against one that
// goes on: amplitudes of the echoes, as pressure and shear waves, and their share of the energy
struct Incoming {
  bool shear;
  int angle;
  int height, length;    // of the strip; a wave is height times sin(angle) long
  int start, width;      // of the packet of waves, along x
  double travel[2];      // of its middle, until all of the shear, and of the pressure wave is there
  friend void PrintTo(const Incoming &i, std::ostream *out)
  {
    *out << (i.shear ? "shear " : "pressure ") << i.angle;
  }
};

struct Echo {
  double p, s, energy;
};

/** The velocities of the points at two times, by their places. */
using Velocities = std::map<std::array<int, 2>, std::array<double, 2>>;

std::array<Velocities, 2> send(const Incoming &w, int length, const std::string &far)
{
  // along the normal, with 24 cells in a wave
  const double theta = w.angle * PI / 180.0, c = w.shear ? CS : 1.0, dt = 0.3,
               k = w.angle ? 2.0 * PI / w.height / sin(theta) : 2.0 * PI / 24.0;
  Scene run(filled("f p", strprintf("0 %d 0 %d", length, w.height), "") +
            strprintf("timestep %g\n", dt) + far);
  // velocity a cos(k d.x - omega t) of an envelope around the start, along d or across it
  const double d[2] = {cos(theta), sin(theta)},
               a[2] = {w.shear ? -d[1] : d[0], w.shear ? d[0] : d[1]};
  const double dilatation = a[0] * d[0] + a[1] * d[1];
  for (int i = 0; i < run.n(); i++) {
    const double *const x = run.x()[i], along = x[0] * d[0] + x[1] * d[1];
    const double envelope = 1e-4 * exp(-pow((x[0] - w.start) / w.width, 2)),
                 shift = 0.5 * dt * c;    // half a step before
    const double v = envelope * cos(k * (along + shift)), strain = -envelope * cos(k * along) / c;
    for (int b = 0; b < 2; b++) run.v()[i][b] = v * a[b];
    // lambda = mu = 1/3
    double *const tau = run.points().tau[i];
    for (int b = 0; b < 2; b++) tau[b] = strain * (dilatation + 2.0 * a[b] * d[b]) / 3.0;
    tau[2] = strain * dilatation / 3.0;
    tau[3] = strain * (a[0] * d[1] + a[1] * d[0]) / 3.0;
  }
  std::array<Velocities, 2> found;
  int done = 0;
  for (int t = 0; t < 2; t++) {
    const int steps = (int) (w.travel[t] / (c * d[0]) / dt);
    if (steps > done) run.commands(strprintf("run %d\n", steps - done));
    done = steps;
    for (const auto &s : run.gather())
      found[t][{(int) std::floor(2.0 * s.x[0]), (int) std::floor(2.0 * s.x[1])}] = {s.v[0], s.v[1]};
  }
  return found;
}

/** What comes back from the given end with some cells behind the strip, of what goes on without. */
Echo echo(const std::string &name, const Incoming &w, const std::array<Velocities, 2> &without,
          int cells, const std::string &far)
{
  const double theta = w.angle * PI / 180.0, c = w.shear ? CS : 1.0,
               ky = w.angle ? 2.0 * PI / w.height : 0.0,
               k = w.angle ? ky / sin(theta) : 2.0 * PI / 24.0, omega = c * k;
  const bool has_p = !w.shear || CS * ky / k < CS * CS;
  const double kp = has_p ? sqrt(omega * omega - ky * ky) : 0.0,
               ks = sqrt(omega * omega / (CS * CS) - ky * ky), kx = k * cos(theta);
  const auto with = send(w, w.length + cells, far);
  // of waves exp(i (kx x + ky y)) with velocities along the direction; the strip loses as much
  const auto sum_of = [&](const Velocities &velocities, int x_hi, double k, double ex, double ey) {
    std::complex<double> sum = 0.0;
    for (const auto &[place, v] : velocities)
      if (place[0] < 2 * x_hi)
        sum += (v[0] * ex + v[1] * ey) *
            std::exp(std::complex<double>(0.0, -k * 0.5 * place[0] - ky * 0.5 * place[1]));
    return sum;
  };
  const auto amplitude = [&](int t, double k, double ex, double ey) {
    const double d[2] = {kx * c / omega, ky * c / omega};
    return std::abs(sum_of(with[t], w.length, k, ex, ey) -
                    sum_of(without[t], w.length, k, ex, ey)) /
        std::abs(sum_of(without[t], w.length + 150, kx, w.shear ? -d[1] : d[0],
                        w.shear ? d[0] : d[1]));
  };
  Echo e = {0.0, 0.0, 0.0};
  // an echo of the other kind has another length and speed; shear waves of a lattice: 6 % shorter
  for (double K = 0.99 * ks; K < 1.06 * ks; K += 0.005 * ks)
    e.s = std::max(e.s,
                   amplitude(0, -K, ky * CS / omega, ks * CS / omega) *
                       (w.shear ? 1.0 : kx / (ks * CS * CS)));
  if (has_p) e.p = amplitude(1, -kp, -kp / omega, ky / omega) * (w.shear ? kx / kp * CS * CS : 1.0);
  // as much in stress as in motion
  for (int t = 0; t < 2; t++) {
    double echoed = 0.0, came = 0.0;
    for (const auto &[place, v0] : without[t]) {
      came += v0[0] * v0[0] + v0[1] * v0[1];
      if (place[0] >= 2 * w.length) continue;
      const auto &v = with[t].at(place);
      echoed += pow(v[0] - v0[0], 2) + pow(v[1] - v0[1], 2);
    }
    e.energy = std::max(e.energy, echoed / came);
  }
  measured(name + ", pressure wave", e.p);
  measured(name + ", shear wave", e.s);
  measured(name + ", energy", e.energy);
  return e;
}

/** A wall behind a layer of some cells; or dashpots. */
std::string layer(int cells, const std::string &options = "")
{
  return strprintf("fix wall all mpm/boundary xhi stick\nfix far all mpm/pml xhi %d %s\n", cells,
                   options.c_str());
}
std::string dashpots(int length)
{
  return strprintf(
      "region right plane %d 0 0 -1 0 0\nfix far all mpm/dashpot region right 1 %.17g\n", length,
      CS);
}

/** Amplitudes of waves from dashpots, sigma_xx = -rho c_p v_x and sigma_xy = -rho c_s v_y,
 *     for one that comes with amplitude 1: see Lysmer and Kuhlemeyer, J. Eng. Mech. Div. 95 (1969)
 *     859. */
std::array<double, 2> echo_of_dashpots(const Incoming &w)
{
  const double theta = w.angle * PI / 180.0, slowness = sin(theta) / (w.shear ? CS : 1.0);
  // what a wave leaves over at the dashpots: lambda = mu = 1/3, velocity a along d or across it
  const auto left = [&](bool shear, double direction) -> Eigen::Vector2cd {
    const double c = shear ? CS : 1.0, dy = c * slowness;
    const std::complex<double> dx = direction * sqrt(std::complex<double>(1.0 - dy * dy)),
                               ax = shear ? -dy : dx, ay = shear ? dx : dy,
                               xx = -(3.0 * ax * dx + ay * dy) / (3.0 * c),
                               xy = -(ax * dy + ay * dx) / (3.0 * c);
    return {xx + ax, xy + CS * ay};
  };
  Eigen::Matrix2cd back;
  back << left(false, -1.0), left(true, -1.0);
  const Eigen::Vector2cd r = back.inverse() * left(w.shear, 1.0);
  // past the critical angle the pressure wave only goes along the dashpots
  return {slowness < 1.0 ? std::abs(r[0]) : 0.0, std::abs(r[1])};
}

PARAMETER_TEST(Oblique, Leaves, Incoming,
               Values(Incoming{false, 0, 4, 180, 90, 22, {150.0, 150.0}},
                      Incoming{false, 30, 48, 180, 90, 22, {150.0, 150.0}},
                      Incoming{false, 45, 34, 180, 90, 22, {150.0, 150.0}},
                      Incoming{false, 60, 28, 180, 90, 22, {180.0, 180.0}},
                      Incoming{true, 0, 4, 180, 90, 22, {150.0, 150.0}},
                      Incoming{true, 30, 36, 180, 90, 22, {150.0, 150.0}},
                      Incoming{true, 60, 28, 180, 90, 22, {180.0, 180.0}}))
{
  if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  const auto &w = GetParam();
  if (w.height > 4) LONG_CASE();
  const auto goes_on = send(w, w.length + 150, "");
  const Echo of_10 = echo("layer of 10 cells", w, goes_on, 10, layer(10));
  // 0.01 comes back at 60 degrees, and more at those near it of which a packet is made, too
  EXPECT_LT(of_10.p, w.angle < 60 ? 0.012 : 0.02);
  EXPECT_LT(of_10.s, w.angle < 60 ? 0.012 : 0.021);
  EXPECT_LT(of_10.energy, w.angle < 60 ? 1.5e-4 : 1e-3);
  // half the length: the damping grows faster from cell to cell
  const Echo of_5 = echo("layer of 5 cells", w, goes_on, 5, layer(5));
  EXPECT_LT(of_5.energy, 8e-3);
  EXPECT_GT(of_5.energy, of_10.energy);
  const auto exact = echo_of_dashpots(w);
  const Echo of_dashpots = echo("dashpots", w, goes_on, 0, dashpots(w.length));
  EXPECT_NEAR(of_dashpots.p, exact[0], 0.02);
  EXPECT_NEAR(of_dashpots.s, exact[1], 0.02);
}

// A push in the middle of a body: what points do next to it is what they do in a body so large that
// no echo comes back, and nothing of what dashpots leave. 10 cells around
SERIAL_TEST(Pulse, LikeInALargeBody)
{
  LONG_CASE();
  const auto velocities = [](int half, const std::string &far) {
    Scene run(filled("f f", strprintf("-%d %d -%d %d", half, half, half, half), "") + far +
              "region near block -2 2 -2 2 INF INF\ngroup near region near\n"
              "variable f equal 1e-4*exp(-1.0*((time-24)/8)^2)\nfix push near addforce v_f v_f 0\n"
              "timestep 0.4\nregion seen block -14 14 -14 14 INF INF\ngroup seen region seen\n");
    std::vector<double> list;
    for (int k = 0; k < 30; k++) {
      run.commands("run 10 post no\n");
      std::map<std::array<int, 2>, std::array<double, 2>> by_place;
      for (const auto &s : run.gather())
        if (std::fabs(s.x[0]) < 14.0 && std::fabs(s.x[1]) < 14.0)
          by_place[{(int) std::floor(2.0 * s.x[0]), (int) std::floor(2.0 * s.x[1])}] = {s.v[0],
                                                                                        s.v[1]};
      for (const auto &[place, v] : by_place) list.insert(list.end(), {v[0], v[1]});
    }
    return list;
  };
  // the slowest wave of interest is 75 cells long
  const auto exact = velocities(80, "");
  const auto off = [&](const std::vector<double> &list) {
    double difference = 0.0, all = 0.0;
    for (std::size_t k = 0; k < list.size(); k++) {
      difference += (list[k] - exact[k]) * (list[k] - exact[k]);
      all += exact[k] * exact[k];
    }
    EXPECT_EQ(list.size(), exact.size());
    return difference / all;
  };
  std::string walls, layers = "fix far all mpm/pml", dashpots;
  for (const char *face : {"xlo", "xhi", "ylo", "yhi"}) layers += std::string(" ") + face + " 10";
  walls = "fix walls all mpm/boundary xlo xhi ylo yhi stick\n";
  dashpots = "region e plane 16 0 0 -1 0 0\nregion w plane -16 0 0 1 0 0\n"
             "region n plane 0 16 0 0 -1 0\nregion s plane 0 -16 0 0 1 0\n";
  for (const char *face : {"e", "w", "n", "s"})
    dashpots += strprintf("fix %s all mpm/dashpot region %s 1 0.57735026918962576\n", face, face);
  EXPECT_LT(
      measured("energy of the difference, layers", off(velocities(26, walls + layers + "\n"))),
      1e-3);
  EXPECT_GT(measured("energy of the difference, dashpots", off(velocities(16, dashpots))), 0.01);
}

// Random velocities in a body with layers all around: energy falls in each part of 20,000 steps
SERIAL_TEST(Noise, Decays)
{
  for (const char *options : first_of(1, {"scheme musl", "", "shape cubic", "frame total"})) {
    const int steps = options[0] ? 400 : 2000;
    Scene run(filled("f f", "0 18 0 18", options) +
              "fix walls all mpm/boundary xlo xhi ylo yhi stick\n"
              "fix far all mpm/pml xlo 6 xhi 6 ylo 6 yhi 6\n"
              "velocity all create 1e-8 87287 mom no\nfix dt all mpm/dt 0.5\nrun 0\n");
    const double start = kinetic(run);
    double last = start;
    for (int k = 0; k < 10; k++) {
      run.commands(strprintf("run %d post no\n", steps));
      const double now = kinetic(run);
      EXPECT_LE(now, last + 1e-12 * start) << options << " part " << k;
      last = now;
    }
    measured(std::string(options) + ": kinetic energy left", last / start);
    EXPECT_LT(last, 1e-6 * start);
  }
}

// What layers take is what the ledger has lost, in any units and both frames
SERIAL_TEST(Energy, IsThatOfTheLedger)
{
  for (const char *units : first_of(2, {"lj", "si", "metal"}))
    for (const char *options : {"", "frame total"}) {
      Scene run(plane(units, "f f", "0 30 0 30", 1, 0.3) + "fix grid all mpm 1.0 " + options +
                "\ncreate_points 1 box ppc 2\nfix m all mpm/material density 1 linear 100 0.25\n"
                "fix walls all mpm/boundary xhi ylo yhi stick\nfix axis all mpm/boundary xlo slip\n"
                "fix far all mpm/pml xhi 8 ylo 8 yhi 8\ncompute e all mpm/energy\nthermo_style "
                "custom step c_e\n");
      const double c = sqrt(100.0 * 1.2 / run.lmp->force->mvv2e / run.lmp->force->nktv2p);
      for (int i = 0; i < run.n(); i++) {
        const double *const x = run.x()[i];
        const double at = exp(-(pow(x[0] - 8.0, 2) + pow(x[1] - 15.0, 2)) / 9.0);
        for (int d = 0; d < 2; d++) run.v()[i][d] = (d ? 5e-6 : 1e-5) * c * at;
      }
      run.commands(strprintf("timestep %.17g\nrun 0\n", 0.2 / c));
      const double start = run.compute_scalar();
      run.commands("run 500\n");
      const double *const e = run.compute_vector();
      const double left = run.compute_scalar(), work = run.fix("far")->compute_scalar();
      EXPECT_LT(measured(std::string(units) + " " + options + ": energy left", left / start), 0.1);
      measured("transfer and integration", (e[8] + e[9]) / start);
      EXPECT_NEAR(measured("residual", e[10] / start), 0.0, 1e-10);
      EXPECT_NEAR(e[14] / start, work / start, 1e-12);
      EXPECT_LT(work, -0.5 * start);
    }
}

// Ground under its weight, with the stress of that, stays as it is
SERIAL_TEST(Static, Stays)
{
  for (const char *options : first_of(1, {"", "shape cubic"})) {
    Scene run(plane("si", "f f", "0 30 0 24", 1, 0.3) + "fix grid all mpm 1.0 " + options +
              "\nregion ground block INF INF 0 20 INF INF\ncreate_points 1 region ground ppc 2\n"
              "fix m all mpm/material density 2000 linear 1e8 0.25\n"
              "fix g all gravity 9.81 vector 0 -1 0\nfix floor all mpm/boundary ylo stick\n"
              "fix sides all mpm/boundary xlo xhi slip\nmpm_geostatic grid 0.5\ntimestep 1e-3\n"
              "fix far all mpm/pml xlo 6 xhi 6 ylo 6\nvariable y equal xcm(all,y)\nrun 0\n");
    const double before = run.variable("y");
    run.commands("run 2000\n");
    const double sag = 2000 * 9.81 * 20.0 * 20.0 / (2.0 * 1.2e8);    // if it had had no stress
    EXPECT_LT(std::fabs(measured(std::string(options) + ": motion over settlement",
                                 (run.variable("y") - before) / sag)),
              1e-3);
  }
}

TEST(PML, RanksAndRestart)
{
  for (const char *options : {"", "frame total"}) {
    const auto scene = space("si", "f f f", "0 1.2 0 1.1 0 1.2", 1, 0.03) +
        "fix grid all mpm 0.1 " + options +
        "\nregion block block 0 1.2 0 1.1 0 1\ncreate_points 1 region block ppc 2\n"
        "fix m all mpm/material density 1000 neohookean 1e6 0.3\ntimestep 6e-4\n"
        "fix walls all mpm/boundary xlo xhi ylo yhi zlo stick\n";
    const std::string start =
                          "velocity all create 1e20 1234 mom no loop geom\nvelocity all ramp vx "
                          "0 0.2 x 0.4 1 sum yes\nrun 5\n",
                      fix = "fix far all mpm/pml xlo 4 xhi 3 ylo 4 zlo 5 mix 0.05\n";
    OnRanks run(scene + fix + start, "run 30\n");
    EXPECT_LT(measured("difference to one rank", run.difference()), 1e-11);
    OnRanks even(scene + fix + start, "run 30\n",
                 "comm_style tiled\nfix even all balance 10 1.0 rcb\n");
    EXPECT_LT(measured("difference to one rank, balanced", even.difference()), 1e-11);
    const auto next = "neighbor 0.03 bin\n" +
        replaced(scene.substr(scene.find("fix grid")), "create_points 1 region block ppc 2\n", "");
    Continued again(scene + fix + start, 20, next + fix, 20);
    EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
    EXPECT_EQ(again.whole.fix("far")->compute_scalar(), again.again.fix("far")->compute_scalar());
    EXPECT_LT(again.whole.fix("far")->compute_scalar(), 0.0);
  }
}

// A push in the corner of a body in 3d, behind three planes of symmetry: like in a larger body
SERIAL_TEST(Space, LikeInALargeBody)
{
  const auto velocities = [](int size, const std::string &far) {
    const std::string walls = size > 20 ? "" : "fix far_walls all mpm/boundary xhi yhi zhi stick\n";
    Scene run(space("lj", "f f f", strprintf("0 %d 0 %d 0 %d", size, size, size), 1, 0.3) +
              "fix grid all mpm 1.0\ncreate_points 1 box ppc 2\n" + MATERIAL +
              "fix walls all mpm/boundary xlo ylo zlo slip\n" + walls + far +
              "region near sphere 0 0 0 4\ngroup near region near\n"
              "velocity near set 1e-4 1e-4 5e-5\ntimestep 0.4\n");
    std::vector<double> list;
    for (int k = 0; k < 10; k++) {
      run.commands("run 10 post no\n");
      std::map<std::array<int, 3>, std::array<double, 3>> by_place;
      for (const auto &s : run.gather())
        if (s.x[0] < 8.0 && s.x[1] < 8.0 && s.x[2] < 8.0)
          by_place[{(int) (2.0 * s.x[0]), (int) (2.0 * s.x[1]), (int) (2.0 * s.x[2])}] = {
              s.v[0], s.v[1], s.v[2]};
      for (const auto &[place, v] : by_place) list.insert(list.end(), v.begin(), v.end());
    }
    return list;
  };
  const auto exact = velocities(26, ""),
             here = velocities(18, "fix far all mpm/pml xhi 8 yhi 8 zhi 8\n");
  ASSERT_EQ(exact.size(), here.size());
  double difference = 0.0, all = 0.0;
  for (std::size_t k = 0; k < here.size(); k++) {
    difference += (here[k] - exact[k]) * (here[k] - exact[k]);
    all += exact[k] * exact[k];
  }
  EXPECT_LT(measured("energy of the difference", difference / all), 1e-3);
}

SERIAL_TEST(PML, BadInput)
{
  const auto plain = filled("f p", "0 20 0 8", "");
  const std::string fix = "fix far all mpm/pml ";
  expect_refused(plain,
                 {{fix, "has no layer"},
                  {fix + "xlo", "missing argument"},
                  {fix + "xlo 0", "xlo"},
                  {fix + "xlo -3", "xlo"},
                  {fix + "xlo 2.5", "2.5"},
                  {fix + "ylo 5", "is periodic at ylo"},
                  {fix + "zlo 5", "zlo"},
                  {fix + "xlo 12 xhi 12", "thicker than the box"},
                  {fix + "xhi 5 xhi 6", "xhi is given twice"},
                  {fix + "xhi 5 reflection 0", "reflection"},
                  {fix + "xhi 5 reflection 1", "reflection"},
                  {fix + "xhi 5 exponent 0", "exponent"},
                  {fix + "xhi 5 speed 0", "speed"},
                  {fix + "xhi 5 mix 2", "mix"},
                  {fix + "xhi 5 thickness 3", "thickness"},
                  {fix + "xlo 3\nfix more all mpm/pml xhi 3", "more than one fix mpm/pml"},
                  {"group some id 1\nfix far some mpm/pml xhi 3", "no point of its group"},
                  {"fix water all mpm/pore 10 1 1 soil m 0.4 constant 1\n" + fix + "xhi 5",
                   "use faces further away, or soil without water"},
                  {"unfix m\nunfix grid\n" + fix + "xhi 5", "needs a fix mpm"}},
                 "timestep 0.1\nrun 1\n");
  for (const char *options : {"scheme usf", "scheme usavg", "shape cpdi transfer pic",
                              "locking pressure", "transfer flip 1.0", "transfer aflip 0.9"})
    expect_refused(filled("f p", "0 20 0 8", options), {{fix + "xhi 5", "cannot be used with"}},
                   "timestep 0.1\nrun 1\n");
}

// Layers are told that they are strained more than they are made for
SERIAL_TEST(PML, WarnsOfLargeStrain)
{
  for (const double v : {0.005, 0.05}) {
    Scene run(filled("f p", "0 20 0 4", "") +
              "fix walls all mpm/boundary xhi stick\nfix far all mpm/pml xhi 8\n" +
              strprintf("velocity all set %g 0 0\ntimestep 0.2\nrun 100\n", v));
    EXPECT_EQ(run.lmp->error->get_numwarn(), v > 0.01 ? 1 : 0);
  }
}
