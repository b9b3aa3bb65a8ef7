// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi input restart
// mpi: 1 3
// timeout: 900

// Contact between fields on different lattices through pair style mpm/penalty (also test_hertz).

#include "mpm_lammps.h"

#include "error.h"
#include "neighbor.h"

using namespace MPM_TEST;

/** Bars of length 1 at a gap of 0.01, each with speed 0.05, with spacings 0.02 and 0.016. */
static const std::string bars = plane("si", "f p", "-0.3 2.6 0 0.08 -0.05 0.05", 2, 0.01) +
    fields({{"one", "block 0 1 0 0.08 -0.05 0.05", "0.02 transfer flip 1.0 scheme musl"},
            {"two", "block 1.01 2.01 0 0.08 -0.05 0.05",
             "0.016 origin 1.01 0 transfer flip 1.0 scheme musl"}}) +
    R"(
fix m1 one mpm/material density 1 linear MODULUS 0
fix m2 two mpm/material density 1 linear MODULUS 0
velocity one set 0.05 0 0
velocity two set -0.05 0 0
pair_style mpm/penalty
pair_coeff 1 2 PENALTY
timestep STEP
compute e all mpm/energy
compute pair all pair mpm/penalty
compute f one reduce sum fx
variable v1 equal vcm(one,x)
variable v2 equal vcm(two,x)
variable p equal v_v1*mass(one)+v_v2*mass(two)
thermo_style custom step c_e c_pair c_f
)";

static std::string two_bars(const std::string &modulus, const std::string &penalty,
                            const std::string &step)
{
  return replaced(bars, {{"MODULUS", modulus}, {"PENALTY", penalty}, {"STEP", step}});
}

// stress rho c v = 0.5 at the interface for 2 L/c = 0.2, then the bars part with their old speeds
TEST(Bars, StressAndRebound)
{
  Scene run(two_bars("100", "50", "2e-4") + "run 0\n");
  const double energy = run.evaluate("c_e");
  double worst = 0.0, drift = 0.0, before = 0.0, after = 0.0;
  for (int k = 1; k <= 40; k++) {
    run.commands("run 50 post no\n");
    worst = std::max(worst, std::fabs(run.evaluate("v_p")));
    drift = std::max(drift, std::fabs(run.evaluate("c_e+c_pair") / energy - 1.0));
    if (k == 14) before = run.evaluate("v_v1");    // t = 0.14
    if (k == 28) after = run.evaluate("v_v1");
  }
  EXPECT_LT(worst, 1e-13 * 0.08 * 0.05);
  EXPECT_NEAR(measured("interface stress", (before - after) / 0.14), 0.5, 0.02 * 0.5);
  EXPECT_LT(measured("change of energy", drift), 0.015);
  EXPECT_LT(measured("speed after", run.evaluate("v_v1")), -0.97 * 0.05);
  EXPECT_NEAR(run.evaluate("v_v1"), -run.evaluate("v_v2"), 1e-13);
  EXPECT_EQ(run.evaluate("c_pair"), 0.0);
  EXPECT_EQ(run.evaluate("c_pair[1]"), 0.0);
}

// bars that are stiff compared with the contact: all energy goes through the contact
SERIAL_TEST(Bars, EnergyOfTheContact)
{
  Scene run(two_bars("500", "1", "8e-5"));
  run.commands("run 0\n");
  const double energy = run.evaluate("c_e");
  double drift = 0.0, most = 0.0;
  for (int k = 0; k < 24; k++) {
    run.commands("run 200 post no\n");
    drift = std::max(drift, std::fabs(run.evaluate("c_e+c_pair") / energy - 1.0));
    most = std::max(most, run.evaluate("c_pair") / energy);
  }
  EXPECT_GT(measured("largest share of the contact", most), 0.9);
  EXPECT_LT(measured("change of energy", drift), 1e-3);
  EXPECT_NEAR(measured("speed after", run.evaluate("v_v1")), -0.05, 5e-3 * 0.05);
}

// damping takes energy, and says how much: c_pair[2] is its power
SERIAL_TEST(Bars, DampingDissipates)
{
  Scene run("comm_modify vel yes\n" + two_bars("500", "1 damping 3", "8e-5"));
  run.commands("fix sum all vector 1 c_pair[2]\nvariable lost equal 8e-5*sum(f_sum)\nrun 0\n");
  const double energy = run.evaluate("c_e");
  run.commands("run 4800\n");
  const double v = run.evaluate("v_v1"), left = run.evaluate("c_e");
  EXPECT_LT(measured("speed after", v), -0.01);
  EXPECT_GT(v, -0.045);
  EXPECT_NEAR(run.evaluate("v_lost"), energy - left, 0.01 * energy);
}

// two points of volumes 1 and 0.8^3: radii 0.5 and 0.4, face of the smaller one 0.64
SERIAL_TEST(TwoPoints, ForceEnergyAndPower)
{
  Scene run(space("lj", "f f f", "0 5 0 5 0 5", 2) + R"(comm_modify vel yes
create_atoms 1 single 2 2 2
create_atoms 2 single 2.8 2 2
set type 1 volume 1.0
set type 2 volume 0.512
group one type 1
group two type 2
fix F1 one mpm 1.0
fix F2 two mpm 0.9
fix m all mpm/material density 1 neohookean 50 0.3
pair_style mpm/penalty
pair_coeff 1 2 50 friction 0.3 0.05
velocity one set 0 1 0
compute pair all pair mpm/penalty
compute f one reduce sum fx fy
thermo_style custom step c_pair c_f[1] c_f[2]
timestep 0.001
run 0
)");
  const double force = 50.0 * 0.64 * 0.1 / 0.9;
  EXPECT_NEAR(run.evaluate("c_f[1]"), -force, 1e-12);
  EXPECT_NEAR(run.evaluate("c_f[2]"), -0.3 * force, 1e-12);
  EXPECT_NEAR(run.evaluate("c_pair"), 0.05 * force, 1e-12);
  EXPECT_EQ(run.evaluate("c_pair[1]"), 1.0);
  EXPECT_NEAR(run.evaluate("c_pair[2]"), 0.3 * force, 1e-12);

  // damping takes as much as the elastic force, of points that part as fast as they may: no pull
  run.commands("pair_coeff 1 2 50 damping 0.5\nvelocity one set -100 0 0\nrun 0\n");
  EXPECT_EQ(run.evaluate("c_f[1]"), 0.0);
  EXPECT_NEAR(run.evaluate("c_pair[2]"), 100.0 * force, 1e-10);
}

/** A block on a plane of other spacing, gravity tilted by 30 degrees. */
static const std::string incline = plane("si", "f f", "0 3 0 1.4 -0.05 0.05", 2, 0.03) +
    fields({{"plane", "block 0 3 0 0.4 -0.05 0.05", "0.1"},
            {"body", "block 0.5 1.5 0.4 0.8 -0.05 0.05", "0.07 origin 0.5 0.4"}}) +
    R"(
comm_modify vel yes
fix m1 plane mpm/material density 1000 neohookean 4.2e6 0.4
fix m2 body mpm/material density 1000 neohookean 4.2e6 0.4
fix floor all mpm/boundary ylo stick field F1
fix sides all mpm/boundary xlo xhi slip field F1
pair_style mpm/penalty
pair_coeff 1 2 1e6 damping 0.3 FRICTION
fix g body gravity 9.81 vector 0.5 -0.8660254037844386 0
fix dt all mpm/dt 0.3
variable x equal xcm(body,x)
variable v equal vcm(body,x)
compute f body reduce sum fx fy
thermo_style custom step c_f[1] c_f[2]
)";

SERIAL_TEST(Friction, BlockSlidesOrSticks)
{
  const double g = 9.81, sine = 0.5, cosine = std::sqrt(0.75), slip = 0.02;
  for (const double mu : {0.0, 0.1, 0.3, 0.8}) {
    SCOPED_TRACE(mu);
    Scene run(replaced(incline, "FRICTION",
                       mu > 0.0 ? strprintf("friction %g %g", mu, slip) : std::string()));
    run.commands("run 500\n");
    const double t0 = run.evaluate("time"), v0 = run.evaluate("v_v"), x0 = run.evaluate("v_x");
    run.commands("run 1000\n");
    const double t = run.evaluate("time"), v = run.evaluate("v_v");
    const double a = std::max(0.0, g * (sine - mu * cosine));
    if (a > 0.0)
      EXPECT_NEAR(measured("acceleration", (v - v0) / (t - t0)), a, 0.05 * g * sine);
    else
      EXPECT_LT(measured("creep", std::fabs(run.evaluate("v_x") - x0) / (t - t0)), 2.5 * slip);
  }
}

static const std::string disks = plane("lj", "p p", "0 24 0 12", 2) +
    fields({{"one", "cylinder z 3.1 6.2 2.5 INF INF", "0.5"},
            {"two", "cylinder z 20.9 5.3 2.5 INF INF", "0.6"}}) +
    R"(
neighbor 0.3 bin
comm_modify vel yes
fix m all mpm/material density 1 neohookean 50 0.3
pair_style mpm/penalty growth 1.3
pair_coeff 1 2 50 friction 0.3 0.05 damping 0.1
velocity one set -0.5 0.02 0
velocity two set 0.5 0 0
timestep 0.01
variable px equal vcm(all,x)*mass(all)
variable py equal vcm(all,y)*mass(all)
variable v equal vcm(one,x)
compute e all pe/atom pair
compute esum all reduce sum c_e
thermo_style custom step pe c_esum
)";

// without Newton's third law a pair of a point and an image of another is there twice, on one rank,
// too: it is one contact, and its friction one work
TEST(Parallel, PairsAcrossAPeriodicFaceCountOnce)
{
  std::vector<std::array<double, 2>> told;
  for (const char *newton : {"on", "off"}) {
    Scene run(std::string("newton ") + newton + "\n" + disks +
              "compute told all pair mpm/penalty\n"
              "thermo_style custom step c_told[1] c_told[2]\nrun 120\n");
    told.push_back({run.evaluate("c_told[1]"), run.evaluate("c_told[2]")});
  }
  EXPECT_GT(told[0][0], 0.0);
  EXPECT_GT(told[0][1], 0.0);
  EXPECT_EQ(told[0][0], told[1][0]);
  EXPECT_NEAR(told[0][1], told[1][1], 1e-10 * told[0][1]);
}

TEST(Parallel, RanksAgreeAcrossAPeriodicFaceAndAfterARestart)
{
  Twins run(disks, 160, lines_again(disks), 140, 1e-10);
  EXPECT_GT(run.again.evaluate("pe"), 0.0);
  OnRanks off("newton off\n" + disks, "run 300\n");
  EXPECT_LT(off.difference(), 1e-10);
  for (Scene *one : {&run.whole, &off.parallel})
    EXPECT_GT(one->evaluate("v_v"), -0.25);    // they have met through the face
}

TEST(Parallel, MomentumAndEnergyOfAtoms)
{
  Scene run(disks + "run 0\n");
  const double p[2] = {run.evaluate("v_px"), run.evaluate("v_py")};
  run.commands("run 250\n");
  EXPECT_GT(run.evaluate("pe"), 0.0);
  EXPECT_NEAR(run.evaluate("c_esum"), run.evaluate("pe*atoms"), 1e-12);
  EXPECT_NEAR(run.evaluate("v_px"), p[0], 1e-12);
  EXPECT_NEAR(run.evaluate("v_py"), p[1], 1e-12);
}

// types that two fields share, lists by collection, a hybrid: the contact is the same
TEST(Lists, ContactDoesNotDependOnThem)
{
  std::vector<Scene::State> reference;
  const std::string penalty = "pair_style mpm/penalty growth 1.3\n"
                              "pair_coeff 1 2 50 friction 0.3 0.05 damping 0.1\n";
  const std::string variants[] = {
      disks,
      replaced(disks, penalty,
               "set type 2 type 1\npair_style mpm/penalty growth 1.3\n"
               "pair_coeff 1 1 50 friction 0.3 0.05 damping 0.1\n"),
      replaced(disks, "neighbor 0.3 bin", "neighbor 0.3 multi\ncomm_modify mode multi") +
          "neigh_modify exclude type 1 1 exclude type 2 2\n",
      replaced(disks, penalty,
               "pair_style hybrid/overlay zero 1.0 mpm/penalty growth 1.3\n"
               "pair_coeff * * zero\n"
               "pair_coeff 1 2 mpm/penalty 50 friction 0.3 0.05 damping 0.1\n"),
  };
  for (const auto &text : variants) {
    SCOPED_TRACE(text);
    Scene run(text + "run 250\n");
    const auto state = run.gather();
    if (reference.empty()) reference = state;
    ASSERT_EQ(state.size(), reference.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < state.size(); i++)
      for (int d = 0; d < 2; d++)
        worst = std::max(worst, std::fabs(state[i].v[d] - reference[i].v[d]));
    EXPECT_LT(worst, 1e-10);
  }
}

// a body that is one field feels nothing; modulus 0 is no contact; fix mpm/contact has precedence
TEST(Lists, NoContact)
{
  const std::string same = replaced(disks, "mpm 0.6", "mpm 0.5");
  const std::string contact = "fix c all mpm/contact F1 F2 law coulomb 0.3\n";
  for (const auto &text : {replaced(disks, "pair_coeff 1 2 50", "pair_coeff 1 2 0"), same + contact,
                           same + contact + "pair_coeff 1 1 50\n"}) {
    Scene run(text + "compute pair all pair mpm/penalty\nrun 200\n");
    EXPECT_EQ(run.evaluate("c_pair[1]"), 0.0);
    EXPECT_EQ(run.evaluate("pe"), 0.0);
  }
}

// total-Lagrangian fields, whose lattices are those of their reference, meet in the same way
TEST(Lists, TotalFrame)
{
  double v[2];
  for (int total = 0; total < 2; total++) {
    std::string text = replaced(disks, " friction 0.3 0.05 damping 0.1", "");
    if (total)
      text =
          replaced(text, {{"mpm 0.5", "mpm 0.5 frame total"}, {"mpm 0.6", "mpm 0.6 frame total"}});
    Scene run(text + "run 400\n");
    v[total] = run.evaluate("v_v");
    EXPECT_EQ(run.evaluate("pe"), 0.0);    // they have parted
  }
  EXPECT_GT(measured("updated", v[0]), 0.3);
  EXPECT_NEAR(measured("total", v[1]), v[0], 0.01);
}

// a grain between two bodies: the granular style moves it, this one couples the bodies only
TEST(Lists, GrainsNextToBodies)
{
  const std::string grain =
      "create_atoms 3 single 17.6 5.3 0\nset type 3 diameter 1 density 1\n"
      "group grain type 3\nvelocity grain set 1.5 0 0\nfix move grain nve/sphere disc\n"
      "pair_style hybrid/overlay granular mpm/penalty growth 1.3\npair_coeff * * none\n"
      "pair_coeff 1*3 3 granular hooke 50 0 tangential linear_nohistory 0 0\n"
      "pair_coeff 1 2 mpm/penalty";
  Scene run(replaced(disks,
                     {{"atom_style mpm", "atom_style hybrid sphere mpm"},
                      {"create_box 2 box", "create_box 3 box"},
                      {"pair_style mpm/penalty growth 1.3\npair_coeff 1 2", grain}}) +
            "compute pair all pair mpm/penalty\nrun 0\n");
  const double p = run.evaluate("v_px");
  run.commands("run 250\n");
  EXPECT_GT(run.evaluate("c_pair[1]"), 0.0);
  EXPECT_LT(measured("grain", run.evaluate("vcm(grain,x)")), 0.5);    // it has bounced
  EXPECT_NEAR(run.evaluate("v_px"), p, 1e-12);
}

// ghosts have the present radii: bodies that have swollen touch at the border of two ranks
TEST(Radii, FollowTheVolume)
{
  OnRanks both(replaced(disks,
                        {{"neohookean 50 0.3", "eos ideal/gas 1.4 pressure 1"},
                         {"velocity one set -0.5 0.02 0\nvelocity two set 0.5 0 0\n", ""},
                         {"3.1 6.2", "5.2 6.2"},
                         {"20.9 5.3", "10.9 5.3"}}),
               "run 150\n");
  double J = 0.0;
  for (const auto &state : both.serial.gather()) J = std::max(J, state.F[0] * state.F[4]);
  measured("largest J", J);
  EXPECT_GT(J, 1.3);
  EXPECT_GT(both.serial.evaluate("pe"), 0.0);
  EXPECT_LT(both.difference(), 1e-10);
}

TEST(BadInput, IsRefused)
{
  expect_refused(
      disks,
      {{"pair_style mpm/penalty growth", "Illegal pair_style mpm/penalty growth"},
       {"pair_style mpm/penalty growth 0.9", "must be at least 1"},
       {"pair_style mpm/penalty stiff 1", "Unknown pair_style mpm/penalty keyword: stiff"},
       {"pair_style none\npair_style mpm/penalty\npair_coeff 1 1 5",
        "no pair_coeff for types 1 and 2"},
       {"pair_style none\npair_style mpm/penalty", "All pair coeffs are not set"},
       {"pair_coeff 1 2", "Illegal pair_coeff mpm/penalty"},
       {"pair_coeff 1 2 -5", "modulus must not be negative"},
       {"pair_coeff 1 2 nan", "nan"},
       {"pair_coeff 1 2 5 friction 0.3", "Illegal pair_coeff mpm/penalty"},
       {"pair_coeff 1 2 5 friction -0.3 1", "must not be negative"},
       {"pair_coeff 1 2 5 friction 0.3 0", "friction slip must be positive"},
       {"pair_coeff 1 2 5 damping -1", "must not be negative"},
       {"pair_coeff 1 2 5 sticky", "Unknown pair_coeff mpm/penalty keyword: sticky"},
       {"pair_coeff 1 3 5", "3"},
       {"comm_modify vel no", "comm_modify vel yes"},
       {"unfix F2", "only one fix mpm"},
       {"unfix F1\nunfix F2", "no fix mpm"}},
      "run 1\n");
  expect_error("region box block 0 1 0 1 0 1\ncreate_box 1 box\npair_style mpm/penalty\n"
               "pair_coeff * * 1\nmass 1 1\nrun 0\n",
               "requires material points");
}

// axisymmetric: rings that are in contact along their circle
static std::string rings(const std::string &more)
{
  return plane("si", "f f", "0 6 0 12", 2, 0.1) +
      "group one type 1\ngroup two type 2\n"
      "fix F1 one mpm 0.5 axisymmetric yes transfer flip 1.0 scheme musl\n"
      "fix F2 two mpm 0.4 axisymmetric yes transfer flip 1.0 scheme musl\n"
      "fix axis all mpm/boundary xlo slip\npair_style mpm/penalty\n" +
      more;
}

static std::string rods(const std::string &one, const std::string &two, const std::string &more)
{
  return rings(bodies({{"one", "block " + one + " INF INF"}, {"two", "block " + two + " INF INF"}},
                      "ppc 2 fix F#") +
               "compute e all mpm/energy\ncompute pair all pair mpm/penalty\n"
               "thermo_style custom step c_e c_pair\n" +
               more);
}

// the force on each point is minus the slope of the energy, along both axes, while the area of a
// ring in the plane stays: F_zz goes with its radius
SERIAL_TEST(Rings, ForceIsTheSlopeOfTheEnergy)
{
  const double r[2] = {1.0, 1.14}, y[2] = {5.0, 5.1}, area = 0.04, E = 3.0, step = 1e-5;
  Scene run;
  std::string scene;
  for (int k = 0; k < 2; k++)
    scene += strprintf("create_atoms %d single %.17g %.17g 0\nset type %d volume %.17g\n", k + 1,
                       r[k], y[k], k + 1, 2.0 * M_PI * r[k] * area);
  run.commands(
      rings(scene +
            "group one type 1\ngroup two type 2\npair_coeff 1 2 3.0\n"
            "fix m all mpm/material density 1 linear 1 0\ntimestep 1e-9\n"
            "compute pair all pair mpm/penalty\nthermo_style custom step c_pair\nrun 0\n"));
  const auto energy = [&](int point, int axis, double by) {
    const auto at = [&]() {
      int i = 0;
      while (run.lmp->atom->type[i] != point + 1) i++;
      return i;
    };
    run.x()[at()][axis] += by;
    run.points().F[at()][8] = run.x()[at()][0] / r[point];
    run.commands("run 0 post no\n");
    const double found = run.evaluate("c_pair");
    run.x()[at()][axis] -= by;
    run.points().F[at()][8] = 1.0;
    return found;
  };
  const double distance = hypot(r[0] - r[1], y[0] - y[1]), overlap = 0.2 - distance;
  EXPECT_NEAR(energy(0, 0, 0.0), 0.5 * E * 0.2 * M_PI * (r[0] + r[1]) * overlap * overlap / 0.2,
              1e-14);
  double f[2][2];
  for (int i = 0; i < 2; i++)
    for (int d = 0; d < 2; d++) f[run.lmp->atom->type[i] - 1][d] = run.lmp->atom->f[i][d];
  for (int k = 0; k < 2; k++)
    for (int d = 0; d < 2; d++)
      EXPECT_NEAR(f[k][d], (energy(k, d, -step) - energy(k, d, step)) / (2.0 * step), 1e-8);
  EXPECT_LT(f[0][0] + f[1][0], -1e-3);
  EXPECT_NEAR(f[0][1] + f[1][1], 0.0, 1e-15);
}

// a rod that swells in a sleeve on another lattice pushes it outward. Its work is the energy of the
// contact, but for the share of contact modulus over bulk modulus that changes of radii take
SERIAL_TEST(Rings, RodSwellsInASleeve)
{
  Scene run(rods("0 2 4 8", "2.05 3.25 4 8",
                 "pair_coeff 1 2 2.0\nfix m all mpm/material density 1 neohookean 10.0 0.3\n"
                 "timestep 0.01\n"));
  run.set_velocity([](const double *x, double *v) {
    v[0] = x[0] < 2.02 ? 0.3 * x[0] : 0.0;
  });
  run.commands("run 0\n");
  const double start = run.evaluate("c_e");
  double touch = 0.0, drift = 0.0, stretch = 0.0;
  for (int k = 0; k < 40; k++) {
    run.commands("run 5 post no\n");
    touch = std::max(touch, run.evaluate("c_pair") / start);
    drift = std::max(drift, std::fabs(run.evaluate("c_e[6]") + run.evaluate("c_pair")) / start);
    double inner = 0.0, outer = 100.0;
    for (int i = 0; i < run.n(); i++) {
      const double r = run.x()[i][0];
      if (run.lmp->atom->type[i] == 1)
        inner = std::max(inner, r);
      else {
        outer = std::min(outer, r);
        stretch = std::max(stretch, run.points().F[i][8]);
      }
    }
    ASSERT_GT(outer, inner);
  }
  EXPECT_GT(measured("energy of the contact", touch), 0.1);
  EXPECT_LT(measured("work of the contact and its energy", drift),
            touch * 2.0 / (10.0 / (3.0 * 0.4)));
  EXPECT_GT(measured("stretch of the sleeve", stretch), 1.01);
  EXPECT_NEAR(run.sums().p[1], 0.0, 1e-12);
}

// two rods that collide along the axis: the stress is rho c v, as in the plane
SERIAL_TEST(Rings, RodsCollide)
{
  Scene run;
  const double v = 0.05, c = 10.0;
  run.commands(rods("0 2 0.5 5.5", "0 2 5.6 10.4",
                    "pair_coeff 1 2 20.0\nfix m all mpm/material density 1 linear 100.0 0\n"
                    "timestep 0.004\nvelocity one set 0 0.05 0\nvelocity two set 0 -0.05 0\n"
                    "variable p equal mass(one)*vcm(one,y)\nrun 0\n"));
  const double start = run.evaluate("c_e"), all = run.sums().p[1];
  double before = 0.0, drift = 0.0;
  for (int k = 1; k <= 100; k++) {    // until 2.0: contact lasts from 1.0 to 2.0
    run.commands("run 5 post no\n");
    if (k == 70) before = run.evaluate("v_p");
    drift = std::max(drift, std::fabs(run.evaluate("c_e[6]") + run.evaluate("c_pair")) / start);
    if (k == 95)
      EXPECT_NEAR(
          measured("stress / rho c v", (before - run.evaluate("v_p")) / (0.5 * 4.0 * M_PI * c * v)),
          1.0, 0.02);
  }
  EXPECT_LT(measured("work of the contact and its energy", drift), 0.02);
  EXPECT_NEAR(run.sums().p[1], all, 1e-12);
}

// where stress is made apart from the motion, x/F_zz does not stay the initial radius of a ring
SERIAL_TEST(Rings, GoOnWithNewNeighborLists)
{
  for (const char *options : {"scheme musl", "locking fbar"}) {
    Scene run(plane("lj", "f f", "0 8 0 16", 2, 0.3) +
              fields({{"one", "block 0 4 2 6 INF INF"}, {"two", "block 0 4 6 10 INF INF"}},
                     strprintf("1.0 axisymmetric yes %s", options)) +
              "fix soft all mpm/material density 1.0 neohookean 10.0 0.3\n"
              "fix axis all mpm/boundary xlo slip\npair_style mpm/penalty\npair_coeff 1 2 5.0\n"
              "timestep 0.02\nvelocity all ramp vy 0.1 -0.1 y 2 10\n"
              "velocity all ramp vx 0 -0.4 x 0 4 sum yes\n");
    EXPECT_EQ(run.error("run 100\n"), "") << options;
    EXPECT_GT(run.lmp->neighbor->ncalls, 1) << options;
  }
}
