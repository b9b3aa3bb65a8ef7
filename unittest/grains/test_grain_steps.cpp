// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi ranks
// mpi: 1 2

// Fix mpm/dt grains: the time step as a share of a collision of grains, whose duration has a closed
// form, for each pair style that tells its stiffness; and energy of the rebound.

#include "mpm_lammps.h"

using namespace MPM_TEST;

// a few points that hardly limit the time step, far from the grains
static const std::string head = R"(
units lj
boundary f f f
atom_style hybrid sphere mpm
neighbor 0.5 bin
comm_modify vel yes
region box block 0 20 0 8 0 8
create_box 3 box
fix grid all mpm 1.0 every EVERY
region far block 17 18 3 4 3 4
create_points 1 region far ppc 2
group far type 1
fix m far mpm/material density 1.0 neohookean 1.0e-4 0.3
)";

// of radius 0.5 and 0.4, masses 2 and 1.5
constexpr double MA = 2.0, MB = 1.5, RA = 0.5, RB = 0.4, GAP = 0.02;
static std::string two_grains(double speed)
{
  return replaced(head, "EVERY", "1") +
      strprintf(
             "create_atoms 2 single 9.5 4 4\ncreate_atoms 3 single %.17g 4 4\n"
             "set type 2 diameter 1.0 density %.17g\nset type 3 diameter 0.8 density %.17g\n"
             "group a type 2\ngroup b type 3\ngroup grains type 2 3\nfix move grains nve/sphere\n"
             "velocity b set %.17g 0 0\n",
             9.5 + RA + RB + GAP, MA / (4.0 * PI / 3.0 * 0.125), MB / (4.0 * PI / 3.0 * 0.064),
             -speed);
}

static const std::string pair_hooke = "pair_style gran/hooke 300 NULL 0 NULL 0 0\npair_coeff * *\n",
                         tenth = "fix step all mpm/dt 0.5 grains 0.1\nrun 0\n";

static double reduced_mass()
{
  return MA * MB / (MA + MB);
}
static double radius()
{
  return RA * RB / (RA + RB);
}

/** Force k delta. */
static double hooke_time(double k)
{
  return PI * std::sqrt(reduced_mass() / k);
}

/** Force K delta^1.5: 2.94 ((5 m/(4 K))^2/v)^(1/5), as in textbooks. */
static double hertz_time(double K, double v, double m = reduced_mass())
{
  return 2.9432751843247 * std::pow(std::pow(1.25 * m / K, 2) / v, 0.2);
}

struct Law {
  std::string name, pair;
  double duration;
};

constexpr double SPEED = 0.3, KN = 300.0, YOUNG = 500.0, NU = 0.25;
static const double MATERIAL = 4.0 / 3.0 * YOUNG / (2.0 * (1.0 - NU * NU));
static const std::vector<Law> laws = {
    {"hooke", pair_hooke, hooke_time(KN)},
    {"hooke_history", "pair_style gran/hooke/history 300 NULL 0 NULL 0 0\npair_coeff * *\n",
     hooke_time(KN)},
    {"hertz_history", "pair_style gran/hertz/history 300 NULL 0 NULL 0 0\npair_coeff * *\n",
     hertz_time(KN *std::sqrt(radius()), SPEED)},
    {"granular_hooke",
     "pair_style granular\npair_coeff * * hooke 300 0 tangential linear_nohistory 0 0\n",
     hooke_time(KN)},
    {"granular_hertz",
     "pair_style granular\npair_coeff * * hertz 300 0 tangential linear_nohistory 0 0\n",
     hertz_time(KN *std::sqrt(radius()), SPEED)},
    {"granular_hertz_material",
     "pair_style granular\npair_coeff * * hertz/material 500 0 0.25 tangential mindlin NULL 0 0\n",
     hertz_time(MATERIAL *std::sqrt(radius()), SPEED)},
    // 1/E* = (1 - nu^2)(1/E2 + 1/E3) with E3 = 4 E2
    {"mixed",
     "pair_style granular\npair_coeff 1 1 hertz/material 500 0 0.25 tangential mindlin NULL 0 0\n"
     "pair_coeff 2 2 hertz/material 500 0 0.25 tangential mindlin NULL 0 0\n"
     "pair_coeff 3 3 hertz/material 2000 0 0.25 tangential mindlin NULL 0 0\n",
     hertz_time(1.6 * MATERIAL * std::sqrt(radius()), SPEED)},
    {"hybrid",
     "pair_style hybrid/overlay gran/hooke 300 NULL 0 NULL 0 0 zero 1.0\n"
     "pair_coeff * * zero\npair_coeff 2*3 2*3 gran/hooke\n",
     hooke_time(KN)},
};

class GrainSteps : public ::testing::TestWithParam<Law> {};
INSTANTIATE_TEST_SUITE_P(All, GrainSteps, ValuesIn(laws), [](const auto &info) {
  return info.param.name;
});

// The time step is the share of the closed form in all of the collision. Of the energy, the rule of
// LAMMPS's nve may gain or lose at first and last touch, which are between two steps, the share
// (omega dt)^2 of what an overlap of one step stores
TEST_P(GrainSteps, AreAShareOfTheCollision)
{
  const Law law = GetParam();
  for (double share : {0.1, 0.03}) {
    Scene run(two_grains(SPEED) + law.pair +
              strprintf("fix step all mpm/dt 0.5 grains %.17g\nrun 0 post no\n", share));
    int touching = 0;
    double time = 0.0, least = 1.0e300, most = 0.0;
    bool first = true;
    for (int n = 0; n < 400; n++) {
      run.commands("run 1 post no\n");
      const double gap = run.evaluate("xcm(b,x)-xcm(a,x)") - RA - RB;
      const double dt = run.lmp->update->dt;
      if (gap < 0.0) {
        touching++;
        time += dt;
        least = std::min(least, dt);
        most = std::max(most, dt);
        if (first) {
          EXPECT_EQ(run.fix("step")->compute_vector(1), 0.0);
          EXPECT_GT(run.fix("step")->compute_vector(0), 8.0);    // a grain, not a point
        }
        first = false;
      } else if (touching)
        break;
    }
    // the integrator keeps the energy, of which the limit is made, to (omega dt)^2
    const double small = std::pow(PI * share, 2);
    EXPECT_NEAR(measured("step/(share of the duration)", least / (share * law.duration)), 1.0,
                small);
    EXPECT_NEAR(measured("longest", most / (share * law.duration)), 1.0, small);
    EXPECT_NEAR(touching, 1.0 / share, 2.0);
    const double v = run.evaluate("vcm(b,x)-vcm(a,x)");
    EXPECT_NEAR(measured("energy of the rebound", v * v / (SPEED * SPEED)), 1.0, small);
  }
}

// linear damping: exp(-gamma t/2) in the time t of the collision
SERIAL_TEST(GrainSteps, DampedRebound)
{
  const double gamma = 8.0, omega = std::sqrt(KN / reduced_mass() - gamma * gamma / 4.0);
  Scene run(two_grains(SPEED) +
            "pair_style gran/hooke 300 NULL 8 NULL 0 0 limit_damping\npair_coeff * *\n"
            "fix step all mpm/dt 0.5 grains 0.02\nrun 0\n");
  EXPECT_NEAR(run.lmp->update->dt / (0.02 * hooke_time(KN)), 1.0, 1.0e-12);
  for (int n = 0; n < 60 && run.evaluate("vcm(b,x)-vcm(a,x)") < 0.0; n++) run.commands("run 1\n");
  for (int n = 0; n < 60 && run.evaluate("xcm(b,x)-xcm(a,x)") < RA + RB; n++)
    run.commands("run 1\n");
  // with limit_damping grains part at tan(omega t1) = -gamma omega/(k/m - gamma^2/2)
  const double k = KN / reduced_mass();
  const double t1 = std::atan2(gamma * omega, gamma * gamma / 2.0 - k) / omega;
  const double e = std::exp(-gamma / 2.0 * t1) *
      std::fabs(std::cos(omega * t1) - gamma / (2.0 * omega) * std::sin(omega * t1));
  EXPECT_NEAR(measured("restitution", run.evaluate("vcm(b,x)-vcm(a,x)") / SPEED), e, 0.02 * e);
}

// of a contact that is damped beyond the critical value the fastest rate counts
SERIAL_TEST(GrainSteps, OverdampedContact)
{
  const double k = KN / reduced_mass(), decay = 30.0;    // gamma/2
  for (const char *damping : {"mass_velocity", "velocity"}) {
    const double gamma = 2.0 * decay * (std::string(damping) == "velocity" ? reduced_mass() : 1.0);
    Scene run(
        two_grains(SPEED) +
        strprintf("pair_style granular\npair_coeff * * hooke 300 %.17g tangential "
                  "linear_nohistory 0 0 damping %s\nfix step all mpm/dt 0.5 grains 0.1\nrun 0\n",
                  gamma, damping));
    const double fastest = decay + std::sqrt(decay * decay - k);
    EXPECT_NEAR(run.lmp->update->dt, 0.1 * PI / fastest, 1.0e-13) << damping;
  }
}

struct Contact {
  double first, last;    // time steps
  int touching;
  double rebound;
};
static Contact collide(const std::string &units, const std::string &pair)
{
  Scene run(replaced(two_grains(SPEED), "units lj", "units " + units) + pair +
            "fix step all mpm/dt 0.5 grains 0.05\nrun 0\n");
  Contact result = {run.lmp->update->dt, 0.0, 0, 0.0};
  for (int n = 0; n < 1000; n++) {
    run.commands("run 1 post no\n");
    if (run.evaluate("xcm(b,x)-xcm(a,x)") < RA + RB)
      result.touching++;
    else if (result.touching)
      break;
    result.last = run.lmp->update->dt;
  }
  result.rebound = run.evaluate("vcm(b,x)-vcm(a,x)");
  return result;
}

// In units where a force of 1 gives a mass of 1 another acceleration than 1, the collision is the
// same with forces over this number, and takes the same steps: springs, damping by mass, by its
// velocity alone, and beyond the critical value
SERIAL_TEST(GrainSteps, AreTheSameInOtherUnits)
{
  const double ftm2v = 1.0 / 1.0364269e-4, nktv2p = 1.6021765e6;    // of metal, as in LAMMPS
  const std::vector<std::array<std::string, 2>> pairs = {
      {"gran/hooke %.17g NULL %.17g NULL 0 0\npair_coeff * *", "8"},
      {"gran/hooke %.17g NULL %.17g NULL 0 0\npair_coeff * *", "60"},
      {"gran/hertz/history %.17g NULL %.17g NULL 0 0\npair_coeff * *", "400"},
      {"gran/hertz/history %.17g NULL %.17g NULL 0 0\npair_coeff * *", "1500"},
      {"granular\npair_coeff * * hooke %.17g %.17g tangential linear_nohistory 0 0 damping "
       "velocity",
       "50"},
      {"granular\npair_coeff * * hertz %.17g %.17g tangential linear_nohistory 0 0", "1500"}};
  for (const auto &[pair, damping] : pairs) {
    const auto with = [&](double unit) {
      // gran/hertz/history alone has its stiffness in units of pressure
      const double pressure = unit != 1.0 && pair.find("gran/hertz") == 0 ? nktv2p : 1.0;
      return strprintf(("pair_style " + pair + "\n").c_str(), KN * pressure / unit,
                       stod(damping) / unit);
    };
    const auto lj = collide("lj", with(1.0)), metal = collide("metal", with(ftm2v));
    EXPECT_NEAR(metal.first / lj.first, 1.0, 1.0e-11) << with(1.0);
    EXPECT_NEAR(metal.last / lj.last, 1.0, 1.0e-11) << with(1.0);
    EXPECT_NEAR(metal.rebound / lj.rebound, 1.0, 1.0e-10) << with(1.0);
    EXPECT_EQ(metal.touching, lj.touching) << with(1.0);
    EXPECT_GT(lj.touching, 10) << with(1.0);
  }

  // the damping damp sqrt(m k) v of LAMMPS has no factor of units: in metal it is above critical
  const double e = std::log(0.9), damp = -2.0 * e / std::hypot(PI, e), k = KN / ftm2v;
  Scene run(replaced(two_grains(SPEED), "units lj", "units metal") +
            strprintf("pair_style granular\npair_coeff * * hooke %.17g 0.9 tangential "
                      "linear_nohistory 0 0 damping coeff_restitution\n",
                      k) +
            "fix step all mpm/dt 0.5 grains 0.1\nrun 0\n");
  const double m = reduced_mass(), decay = 0.5 * ftm2v / m * damp * std::sqrt(m * k);
  const double fastest = decay + std::sqrt(decay * decay - ftm2v * k / m);
  EXPECT_NEAR(run.lmp->update->dt * fastest / (0.1 * PI), 1.0, 1.0e-12);
}

// a grain rests on another one: with Hertz's force of the free collision that compresses as much
SERIAL_TEST(GrainSteps, PairUnderLoad)
{
  const double overlap = 0.01, K = KN * std::sqrt(radius());
  Scene run(two_grains(0.0) +
            "pair_style gran/hertz/history 300 NULL 0 NULL 0 0\npair_coeff * *\n" +
            strprintf("displace_atoms b move %.17g 0 0\n", -overlap - GAP) +
            "fix step all mpm/dt 0.5 grains 0.1\nrun 0\n");
  const double v = std::sqrt(0.8 * K * std::pow(overlap, 2.5) / reduced_mass());
  EXPECT_NEAR(run.lmp->update->dt / (0.1 * hertz_time(K, v)), 1.0, 1.0e-10);
}

// the same for walls: a plane on either side, one that may wiggle, and that of a region
TEST(GrainSteps, WallUnderLoad)
{
  const double overlap = 0.01, K = KN * std::sqrt(RB),
               v = std::sqrt(0.8 * K * std::pow(overlap, 2.5) / MB);
  const std::string pair = "pair_style gran/hertz/history 1.0e-3 NULL 0 NULL 0 0\npair_coeff * *\n";
  const std::string step =
      "displace_atoms b move 5 0 0\nfix step all mpm/dt 0.5 max 1 grains 0.1\n";
  const std::string hertz = " granular hertz 300 0 tangential linear_nohistory 0 0 ";
  const std::string low = strprintf("%.17g", 4.0 - RB + overlap);
  for (const std::string &wall :
       {"wall/gran" + hertz + "zplane " + low + " NULL",
        "wall/gran" + hertz + "yplane 0 " + strprintf("%.17g", 4.0 + RB - overlap),
        "wall/gran" + hertz + "zplane " + low + " 8 wiggle z 0.5 7.0",
        "wall/gran/region" + hertz + "region room"}) {
    SCOPED_TRACE(wall);
    Scene run(two_grains(0.0) + pair + "region room block 0 20 0 8 " + low + " 8\n" + "fix w b " +
              wall + "\n" + step + "run 0\n");
    EXPECT_NEAR(run.lmp->update->dt / (0.1 * hertz_time(K, v, MB)), 1.0, 1.0e-10);
    // one that is frozen has no collision
    run.commands("fix hold b freeze\nrun 0\n");
    EXPECT_EQ(run.lmp->update->dt, 1.0);
  }
  Scene apart(two_grains(0.0) + pair + "fix w a wall/gran" + hertz + "zplane 3 NULL\n" + step +
              "run 0\n");
  EXPECT_EQ(apart.lmp->update->dt, 1.0);

  // one that wiggles by 0.01 to both sides has gone 0.01 after a quarter of a period
  Scene wiggles(two_grains(0.0) + pair + "fix w b wall/gran" + hertz +
                strprintf("zplane %.17g NULL wiggle z 0.01 4.0e-3\n", 4.0 - RB) +
                "displace_atoms b move 5 0 0\ntimestep 1.0e-5\nunfix move\nrun 100\n"
                "fix step all mpm/dt 0.5 max 1 grains 0.1\nrun 0\n");
  EXPECT_NEAR(wiggles.lmp->update->dt / (0.1 * hertz_time(K, v, MB)), 1.0, 1.0e-10);
}

static const std::string skin = "fix skin far mpm/surface\nneigh_modify exclude type 1 1\n",
                         at_point = skin +
    "displace_atoms b move 6.57 -0.25 -0.25\nvelocity b set 0.5 0 0\n";

// walls, frozen grains, and a grain on points
SERIAL_TEST(GrainSteps, OtherPartners)
{
  Scene wall(two_grains(0.0) + pair_hooke +
             "fix w grains wall/gran hooke 5000 NULL 0 NULL 0 0 zplane 0 8\n" + tenth);
  EXPECT_NEAR(wall.lmp->update->dt, 0.1 * PI * std::sqrt(MB / 5000.0), 1.0e-13);
  EXPECT_THAT(wall.error("fix step all mpm/dt 0.5 grains 0.1 min 1.0\nrun 0\n"),
              HasSubstr("collision of grain 10 with a wall"));

  Scene frozen(two_grains(SPEED) + pair_hooke + "fix hold a freeze\n" + tenth);
  EXPECT_NEAR(frozen.lmp->update->dt, 0.1 * PI * std::sqrt(MB / KN), 1.0e-13);

  Scene points(two_grains(SPEED) + pair_hooke + at_point + tenth);
  const double mp = 1.0 / 8.0;
  EXPECT_NEAR(points.lmp->update->dt, 0.1 * PI * std::sqrt(MB * mp / (MB + mp) / KN), 1.0e-13);
}

// points that take one step in three of the run: the share is that of a step of theirs
TEST(GrainSteps, OfPointsWithLongSteps)
{
  const std::string scene = replaced(two_grains(SPEED), "every 1", "every 3");
  Scene points(scene + pair_hooke + at_point + tenth);
  const double mp = 1.0 / 8.0;
  EXPECT_NEAR(points.lmp->update->dt, 0.1 / 3.0 * PI * std::sqrt(MB * mp / (MB + mp) / KN),
              1.0e-13);

  Scene grains(scene + pair_hooke + tenth);
  EXPECT_NEAR(grains.lmp->update->dt, 0.1 * PI * std::sqrt(reduced_mass() / KN), 1.0e-13);

  // walls hold points of their group, too
  Scene wall(scene + replaced(pair_hooke, "300", "0.01") + skin +
             "fix w far wall/gran hooke 5000 NULL 0 NULL 0 0 zplane 0 8\n" + tenth);
  EXPECT_NEAR(wall.lmp->update->dt, 0.1 / 3.0 * PI * std::sqrt(mp / 5000.0), 1.0e-13);
}

// a grain comes from far away, between two looks, with points that take one step in three
TEST(GrainSteps, ArriveBetweenLooks)
{
  const double speed = 6.0;
  Scene run(replaced(two_grains(speed), "every 1", "every 3") + "displace_atoms b move 4.0 0 0\n" +
            pair_hooke + "fix step all mpm/dt 0.5 max 0.01 grains 0.05 every 1000\nrun 0\n");
  EXPECT_EQ(run.lmp->update->dt, 0.01);
  int touching = 0;
  for (int n = 0; n < 200; n++) {
    run.commands("run 1 pre no post no\n");
    if (run.evaluate("xcm(b,x)-xcm(a,x)") < RA + RB) {
      EXPECT_NEAR(run.lmp->update->dt, 0.05 * hooke_time(KN), 1.0e-13);
      touching++;
    }
  }
  EXPECT_NEAR(touching, 20, 2);
}

// grains go on after all points have left: when nothing collides, nothing limits the time step, and
// it stays as it is; when something does later, it counts
TEST(GrainSteps, GoOnWithoutPoints)
{
  const std::string hooke =
      pair_hooke + "neigh_modify exclude type 1 1 exclude type 1 2 exclude type 1 3\n";
  for (int every : {1, 3}) {
    const auto scene = [&](const std::string &options) {
      return replaced(two_grains(0.0), "every 1", strprintf("bad delete every %d", every)) + hooke +
          "velocity far set 5 0 0\nfix step all mpm/dt 0.5 every 2 " + options + "\n";
    };
    const double dt = 0.5 / 5.01 / every;    // h/(c + v)
    for (const char *options : {"", "grains 0.05", "grains 0.05 max 10"})
      for (const char *wall : {"",
                               "fix w grains wall/gran granular hertz 5 0 tangential "
                               "linear_nohistory 0 0 zplane 0 8\n"}) {
        SCOPED_TRACE(std::string(options) + " every " + std::to_string(every) + " " + wall);
        Scene run(scene(options) + wall + "run 60\n");
        EXPECT_EQ(run.lmp->atom->natoms, 2);
        EXPECT_NEAR(run.lmp->update->dt, dt, 0.002 * dt);
      }
    Scene meet(scene("grains 0.05") +
               "displace_atoms b move 0.3 0 0\nvelocity b set -0.3 0 0\nrun 100\n");
    EXPECT_EQ(meet.lmp->atom->natoms, 2);
    EXPECT_NEAR(meet.lmp->update->dt, 0.05 * hooke_time(KN), 1.0e-13);
    EXPECT_NEAR(meet.evaluate("vcm(b,x)"), 0.3 * (MA - MB) / (MA + MB), 2.0e-4);
    EXPECT_NEAR(meet.evaluate("vcm(a,x)"), -0.6 * MB / (MA + MB), 2.0e-4);
  }
}

// the same on two ranks as on one
TEST(GrainSteps, OnRanks)
{
  const std::string scene =
      two_grains(SPEED) + laws[5].pair + "fix step all mpm/dt 0.5 grains 0.05\n";
  Scene run(scene + "run 60\n");
  const double both[] = {run.evaluate("time"), run.evaluate("vcm(b,x)"), run.lmp->update->dt};
  Scene serial(scene + "run 60\n", MPI_COMM_SELF);
  EXPECT_NEAR(both[0] / serial.evaluate("time"), 1.0, 1.0e-11);
  EXPECT_NEAR(both[1] / serial.evaluate("vcm(b,x)"), 1.0, 1.0e-11);
  EXPECT_NEAR(both[2] / serial.lmp->update->dt, 1.0, 1.0e-11);
  EXPECT_LT(std::fabs(both[1]), SPEED);
}

// files written in the collision, and after it, when the time step grows by a factor at each look
SERIAL_TEST(GrainSteps, GoOnFromARestartFile)
{
  const std::string pair = laws[5].pair, step = "fix step all mpm/dt 0.5 grains 0.05\n";
  for (const bool parted : {false, true}) {
    const ScratchFile file("restart");
    const auto scene = two_grains(SPEED) + pair + step;
    Scene whole(scene + (parted ? "run 45\n" : "run 12\n"));
    const double then = whole.lmp->update->dt;
    EXPECT_EQ(whole.evaluate("vcm(b,x)-vcm(a,x)") > 0.9 * SPEED, parted);
    whole.commands("write_restart " + file.name + "\nrun 20\n");
    if (parted) EXPECT_NEAR(whole.lmp->update->dt / then, 1.05 * 1.05, 1.0e-12);
    Scene parts("read_restart " + file.name + "\n" +
                lines_again(scene, {"pair_style", "pair_coeff"}) + "run 20\n");
    EXPECT_EQ(parts.lmp->update->dt, whole.lmp->update->dt);
    EXPECT_EQ(parts.evaluate("time"), whole.evaluate("time"));
  }
}

// A run in two parts takes the steps of one without a break, although its second part has lists
// with more pairs: grains come near while the time step grows, as points slow down
TEST(GrainSteps, PartsOfARunWithOtherLists)
{
  const std::string scene = two_grains(SPEED) + pair_hooke +
      "neigh_modify exclude type 1 1\ndisplace_atoms b move 0.68 0 0\n"
      "velocity far set 10 0 0\nfix drag far viscous 1\n"
      "fix step all mpm/dt 0.5 grains 1.0\n";
  Scene whole(scene + "run 35\n");
  const double dt = whole.lmp->update->dt, time = whole.evaluate("time");
  EXPECT_LT(dt, 0.5 * hooke_time(KN));    // it still grows
  for (int first = 3; first < 35; first += 3) {
    const ScratchFile file("restart");
    Scene parts(scene + strprintf("run %d\nwrite_restart ", first) + file.name + "\n" +
                strprintf("run %d\n", 35 - first));
    EXPECT_EQ(parts.lmp->update->dt, dt) << first;
    EXPECT_NEAR(parts.evaluate("time"), time, 1.0e-12 * time) << first;
  }
  // grains that have other velocities, so that they do not meet, are another state
  Scene apart(two_grains(SPEED) + pair_hooke +
              "fix step all mpm/dt 0.5 max 0.1 grains 0.1\nrun 2\n");
  EXPECT_NEAR(apart.lmp->update->dt, 0.1 * hooke_time(KN), 1.0e-13);
  apart.commands("velocity b set 0.3 0 0\nrun 0\n");
  EXPECT_EQ(apart.lmp->update->dt, 0.1);
  apart.commands("velocity b set -0.3 0 0\nrun 0\n");
  EXPECT_NEAR(apart.lmp->update->dt, 0.1 * hooke_time(KN), 1.0e-13);
}

SERIAL_TEST(GrainSteps, AreRefusedWithTheReason)
{
  const std::vector<std::array<std::string, 2>> bad = {
      {"", "needs a pair style of grains: gran/hooke"},
      {"pair_style zero 1.0\npair_coeff * *\n", "needs a pair style of grains"},
      {"pair_style granular\npair_coeff * * jkr 500 0 0.25 1 tangential mindlin NULL 0 0\n",
       "normal model jkr .* use keyword max"},
      {pair_hooke +
           "fix w grains wall/gran granular dmt 500 0 0.25 1 tangential mindlin NULL 0 0 zplane 0 "
           "8\n",
       "normal model dmt"}};
  for (const auto &[text, reason] : bad)
    EXPECT_THAT(Scene().error(two_grains(SPEED) + text + tenth), ::testing::ContainsRegex(reason));
  for (const char *share : {"0", "-0.1", "1.1"})
    EXPECT_THAT(Scene().error(two_grains(SPEED) + "fix step all mpm/dt 0.5 grains " + share + "\n"),
                HasSubstr("grains must be above 0 and at most 1"));
}
