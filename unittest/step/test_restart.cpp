// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: restart smoke ranks
// mpi: 1 2 3
// timeout: 900

// A run from a restart file is that run, bit by bit on as many ranks, to round-off on others.

#include "mpm_lammps.h"

#include "neighbor.h"

#include <cmath>
#include <cstring>

using namespace MPM_TEST;

static const std::string head = space("lj", "p p f", "0 8 0 8 0 8", 2);

static std::string fixes(const std::string &options)
{
  return "fix grid all mpm 1.0 " + options + "\n" +
      "group one type 1\ngroup two type 2\n"
      "fix m1 one mpm/material density 1.0 neohookean 10.0 0.3\n"
      "fix m2 two mpm/material density 2.0 eos linear 20.0 "
      "strength j2 5.0 0.05 hardening linear 0.5\n"
      "fix floor all mpm/boundary zlo slip\n"
      "fix step all mpm/dt 0.3\n";
}

static const std::string points = "region one sphere 2.6 3.0 3.2 1.9\n"
                                  "region two block 4.8 7.3 2.0 5.0 2.5 5.5\n"
                                  "create_points 1 region one ppc 2\n"
                                  "create_points 2 region two ppc 2\n";

static const std::string start = "velocity one set 0.6 0.35 -0.4\nvelocity two set -0.5 0.1 -0.3\n";

// a body of the total frame would fall through a floor that it does not touch at first
static const std::string start_level = "velocity one set 0.6 0.35 0\nvelocity two set -0.5 0.1 0\n";

PARAMETER_TEST(Restart, ContinuesBitwise, std::string,
               Values("transfer apic", "shape linear transfer flip 0.99 scheme musl",
                      "shape cubic transfer apic scheme musl", "transfer pic scheme usf",
                      "transfer apic scheme usavg", "frame total transfer apic",
                      "frame total transfer flip 0.99 scheme musl", "locking fbar",
                      "scheme musl locking pressure", "transfer aflip 0.99 scheme musl",
                      "shape cpgimp transfer tpic", "every 3"))
{
  const std::string options = GetParam();
  const ScratchFile half("100.bin"), end("200.bin");
  Scene whole(head + "fix grid all mpm 1.0 " + options + "\n" + points + "unfix grid\n" +
              fixes(options) + (options.find("total") == std::string::npos ? start : start_level) +
              "restart 100 " + replaced(half.name, "100", "*") + "\nrun 200\n");
  const std::string next =
      "read_restart " + half.name + "\nneighbor 0.3 bin\n" + fixes(options) + "run 100\n";
  Scene again(next);
  const auto expected = whole.gather();
  EXPECT_TRUE(identical(expected, again.gather()));
  EXPECT_EQ(again.lmp->update->ntimestep, 200);
  EXPECT_EQ(again.time(), whole.time());

  // one rank reads the file of many
  Scene serial(next, MPI_COMM_SELF);
  EXPECT_LT(difference(expected, serial.gather()), 1.0e-11);
}

// write_restart between runs, and a file of one rank read by many; sums begun before go on, too
PARAMETER_TEST(RestartCommand, ContinuesBitwiseAndOnOtherRanks, std::string,
               Values("transfer apic", "shape cubic transfer flip 1.0 scheme usf"))
{
  const std::string options = GetParam();
  const std::string scene = head + "fix grid all mpm 1.0 " + options + "\n" + points +
      "unfix grid\n" + fixes(options) + start;
  const std::string next = "neighbor 0.3 bin\n" + fixes(options);
  const std::string energy = "compute e all mpm/energy\nthermo_style custom step c_e\n";
  Continued run(scene + energy, 70, next + energy, 60);
  const auto expected = run.whole.gather();
  EXPECT_TRUE(identical(expected, run.again.gather()));
  const auto *sums = run.whole.compute_vector(), *others = run.again.compute_vector();
  const int n = run.whole.lmp->modify->get_compute_by_id("e")->size_vector;
  for (int k = 0; k < n; k++) EXPECT_EQ(sums[k], others[k]) << k;
  EXPECT_NE(sums[8], 0.0);    // transfers

  const ScratchFile file("serial");
  if (rank() == 0) Scene(scene + "run 70\nwrite_restart " + file.name + "\n", MPI_COMM_SELF);
  MPI_Barrier(MPI_COMM_WORLD);
  Scene many("read_restart " + file.name + "\n" + next + "run 60\n");
  EXPECT_LT(difference(expected, many.gather()), 1.0e-11);
}

// points that are rings
PARAMETER_TEST(AxisymmetricRestart, ContinuesBitwise, std::string,
               Values("transfer apic", "shape cpgimp transfer flip 1.0",
                      "transfer apic scheme musl locking both"))
{
  const std::string fixes = "fix grid all mpm 1.0 axisymmetric yes " + GetParam() +
      "\nfix m all mpm/material density 1.0 neohookean 10.0 0.3\n"
      "fix walls all mpm/boundary xlo ylo slip\nfix step all mpm/dt 0.3\n";
  Continued run(plane("lj", "f f", "0 8 0 8") + fixes +
                    "region body sphere 0 3.5 0 3\ncreate_points 1 region body ppc 2\n"
                    "velocity all set 0.3 -0.4 0\n",
                70, "neighbor 0.3 bin\n" + fixes, 60);
  EXPECT_TRUE(identical(run.whole.gather(), run.again.gather()));
}

// the state is more than positions and velocities: without a part of it the run goes on differently
TEST(RestartState, AffineMatrixAndHistoryAreInTheFile)
{
  const ScratchFile file("state");
  Scene whole(head + "fix grid all mpm 1.0\n" + points + fixes("") +
              "velocity one set 0.6 0.35 -0.4\nvelocity two set -1.5 0.1 -1.0\n"
              "compute h two mpm/atom eplastic\ncompute sum two reduce sum c_h\n"
              "thermo_style custom step c_sum\nrun 100\nwrite_restart " +
              file.name + "\nrun 50\n");
  const auto expected = whole.gather();
  const double eplastic = whole.evaluate("c_sum");
  EXPECT_GT(eplastic, 0.01);

  // fixes of another ID or style do not get their state: that is what the comparison is about
  for (const bool with_state : {true, false}) {
    Scene again;
    std::string next = fixes("");
    if (!with_state)
      next = replaced(replaced(next, "fix m2", "fix other"), "fix grid", "fix lattice");
    again.commands("read_restart " + file.name + "\nneighbor 0.3 bin\n" + next +
                   "compute h two mpm/atom eplastic\ncompute sum two reduce sum c_h\n"
                   "thermo_style custom step c_sum\nrun 50\n");
    if (with_state) {
      EXPECT_EQ(difference(expected, again.gather()), 0.0);
      EXPECT_DOUBLE_EQ(again.evaluate("c_sum"), eplastic);
    } else {
      EXPECT_GT(difference(expected, again.gather()), 1.0e-6);
      EXPECT_GT(std::abs(again.evaluate("c_sum") - eplastic), 1.0e-6);
    }
  }
}

/* Read_restart sets the skin to the default of the units of the file where they were others before:
   neighbor lists are made at other steps then, and sums have another order. */
TEST(RestartState, LostSkinHasAWarning)
{
  const std::string more = "neighbor 0.3 bin\n", si = replaced(head, "units lj", "units si") + more;
  const ScratchFile file("skin");
  Scene whole(si + "fix grid all mpm 1.0\n" + points + fixes("") + start +
              "run 70\nwrite_restart " + file.name + "\nrun 60\n");
  const auto expected = whole.gather();
  const struct {
    std::string before, after;
    bool lost;
  } cases[] = {{more, "", true}, {"units si\n" + more, "", false}, {"", more, false}};
  for (const auto &[before, after, lost] : cases) {
    SCOPED_TRACE(before);
    const ScratchFile log("skin.log");
    Scene again("log " + log.name + "\n" + before + "read_restart " + file.name + "\n" + after +
                fixes("") + "run 60\n");
    const auto found = again.gather();
    again.commands("run 0\nlog none\n");
    EXPECT_EQ(again.lmp->neighbor->skin, lost ? 0.001 : 0.3);
    MPI_Barrier(MPI_COMM_WORLD);
    const std::string text = file_text(log.name), warning = "give neighbor and neigh_modify after";
    const auto at = text.find(warning);
    EXPECT_EQ(at != std::string::npos, lost) << text;
    if (lost) {
      EXPECT_THAT(text, HasSubstr("had skin 0.3, every 1 delay 0 check yes once no in the run"));
      EXPECT_EQ(text.find(warning, at + 1), std::string::npos);
    }
    EXPECT_EQ(identical(expected, found), !lost);
  }
}

// time and energies go on where they were
TEST(RestartState, WorkIsInTheFile)
{
  const std::string watch = "compute e all mpm/energy\nthermo_style custom step c_e[3]\n",
                    gravity = "fix g all gravity 0.3 vector 0 0 -1\n";
  Continued run(head + "fix grid all mpm 1.0\n" + points + fixes("") + watch + gravity +
                    "velocity one set 0.6 0.35 -0.4\nvelocity two set -1.5 0.1 -1.0\n",
                100, "neighbor 0.3 bin\n" + fixes("") + gravity + watch, 50);
  auto &whole = run.whole, &again = run.again;
  const double plastic = whole.evaluate("c_e[3]");
  EXPECT_GT(plastic, 1.0e-3);
  EXPECT_NEAR(again.evaluate("c_e[3]"), plastic, 1.0e-12 * plastic);
  EXPECT_EQ(again.time(), whole.time());

  // the ledger: kinetic ... external, boundary, contact, transfer, integration; and it closes
  const double *expected = whole.compute_vector(), *found = again.compute_vector();
  const double scale = expected[0];
  EXPECT_GT(std::abs(expected[5]), 1.0e-3 * scale);
  EXPECT_LT(expected[8], -1.0e-3 * scale);
  EXPECT_GT(std::abs(expected[13]), 1.0e-6 * scale);
  for (int k = 0; k < 14; k++) EXPECT_NEAR(found[k], expected[k], 1.0e-11 * scale) << k;
  EXPECT_LT(std::abs(found[10]), 1.0e-11 * scale);

  // a ledger that is defined later starts where it is defined
  again.commands("compute late all mpm/energy\nthermo_style custom step c_e c_late\nrun 1\n");
  const double *late = again.compute_vector("late");
  EXPECT_LT(std::abs(late[8]), 0.1 * std::abs(expected[8]));
  EXPECT_LT(std::abs(late[10]), 1.0e-11 * scale);
}

// points that leave the box: what is left and what was deleted are what was there, before and after
TEST(RestartState, WhatWasDeletedIsInTheFile)
{
  const ScratchFile file("deleted");
  const double v[3] = {0.3, 0.2, 2.0}, mass = 2.0 * (64.0 + 4 * 4 * 2.5),
               moving = mass - 2.0 * 64.0;
  const std::string fixes = "fix grid all mpm 1.0 bad delete\n"
                            "fix m all mpm/material density 2.0 neohookean 1.0 0.3\n";
  Scene whole(head + fixes +
              "region stays block 0 8 0 8 0 1\nregion goes block 2 6 2 6 4.5 7\n"
              "create_points 1 region stays ppc 2\ncreate_points 2 region goes ppc 2\n"
              "group goes type 2\nvelocity goes set 0.3 0.2 2.0\ntimestep 0.04\nrun 30\n"
              "write_restart " +
              file.name + "\n");
  const auto check = [&](Scene &run) {
    const Totals left(run.gather());
    const double *deleted = run.fix_vector("grid", 11) + 6;    // points, mass, momentum
    EXPECT_NEAR(deleted[0] * 0.25, deleted[1], 1.0e-12 * mass);
    EXPECT_NEAR(left.mass + deleted[1], mass, 1.0e-12 * mass);
    for (int d = 0; d < 3; d++) {
      EXPECT_NEAR(deleted[2 + d], v[d] * deleted[1], 1.0e-12 * mass);
      EXPECT_NEAR(left.p[d] + deleted[2 + d], v[d] * moving, 1.0e-12 * mass);
    }
    return deleted[1];
  };
  const double before = check(whole);
  EXPECT_GT(before, 0.2 * moving);
  EXPECT_LT(before, 0.8 * moving);
  Scene again("read_restart " + file.name + "\nneighbor 0.3 bin\n" + fixes + "run 0\n");
  EXPECT_EQ(check(again), before);
  again.commands("run 50\n");
  EXPECT_NEAR(check(again), moving, 1.0e-12 * mass);
}

// velocities changed between runs change affine matrices, also after a restart file, on any ranks
TEST(RestartState, NewVelocitiesAreSeen)
{
  const ScratchFile file("fit");
  const std::string spin = "velocity all ramp vx -0.5 0.5 y 1 6\n";
  const std::string begin =
      head + "fix grid all mpm 1.0\n" + points + fixes("") + start + "run 50\n";
  Scene whole, serial(MPI_COMM_SELF), without;
  whole.commands(begin + "write_restart " + file.name + "\n" + spin + "run 20\n");
  serial.commands(begin + spin + "run 20\n");
  without.commands(begin + "run 20\n");
  const auto expected = whole.gather();
  EXPECT_LT(difference(expected, serial.gather()), 1.0e-11);
  EXPECT_GT(difference(expected, without.gather()), 1.0e-3);
  for (const bool before_fixes : {true, false}) {
    Scene again("read_restart " + file.name + "\nneighbor 0.3 bin\n" +
                (before_fixes ? spin + fixes("") : fixes("") + spin) + "run 20\n");
    EXPECT_LT(difference(expected, again.gather()), 1.0e-11);
  }
}

// a change before the file is written counts as without a file: a new time step in the next run
TEST(RestartState, TimeStepIsThatWithoutTheFile)
{
  const ScratchFile file("dt");
  const std::string fast = "velocity all set 1.5 0 -0.5\n";
  Scene whole(head + "fix grid all mpm 1.0\n" + points + fixes("") + start + "run 50\n" + fast +
              "write_restart " + file.name + "\nrun 1\n");
  Scene again("read_restart " + file.name + "\nneighbor 0.3 bin\n" + fixes("") + "run 1\n");
  EXPECT_EQ(again.lmp->update->dt, whole.lmp->update->dt);

  // without the set-up of a run, and with other fixes than in the last one
  Scene early(head + "fix grid all mpm 1.0\n" + points + fixes("") + start + "write_restart " +
              file.name + " noinit\nrun 1\nunfix m2\n");
  EXPECT_EQ(early.error("write_restart " + file.name + " noinit\n"), "");
}

// what is done in some steps only counts them itself, or by steps of the run
SERIAL_TEST(ResetTimestep, ChangesNothing)
{
  const std::string scene = plane("si", "f f", "0 1 0 1", 2, 0.02) +
      "fix grid all mpm 0.05\nregion b block 0.2 0.8 0.2 0.6 INF INF\n"
      "create_points 1 region b ppc 2\nregion e block 0.2 0.3 0.8 0.9 INF INF\n"
      "fix m all mpm/material density 1000 neohookean 1e5 0.3 thermal conducting 500 293 50 "
      "expansion 1e-2\n"
      "fix h all mpm/heat every 7 surface convection 500 400\nfix w all mpm/boundary ylo separate\n"
      "fix g all gravity 9.81 vector 0 -1 0\ntimestep 1e-3\n"
      "fix e all mpm/emit 2 region e velocity 0 -2 0\nrun 53\n";
  Scene whole(scene + "run 60\n");
  for (const int step : {0, 52, 1000}) {
    Scene parts(scene + strprintf("reset_timestep %d\nrun 60\n", step));
    EXPECT_TRUE(identical(whole.gather(), parts.gather())) << step;
  }
}

// what depends on time goes on after a file that was written during a run, too, whose time LAMMPS
// alone would take for that of the start of the run
SERIAL_TEST(RestartFile, KnowsItsTime)
{
  const std::string load = "neighbor 0.02 bin\nvariable g equal 9.81*sin(30*time)\n"
                           "fix g all gravity v_g vector 0 -1 0\n";
  for (const std::string grid :
       {"fix grid all mpm 0.05\nfix m all mpm/material density 1000 neohookean 1e5 0.3\n",
        "fix w all mpm/incompressible 0.05 1000\n"}) {
    const ScratchFile file("time");
    Scene whole(plane("si", "f f", "0 1 0 1", 1, 0.02) +
                "region b block 0.2 0.8 0.2 0.6 INF INF\ncreate_points 1 region b spacing 0.025\n" +
                grid + load + "timestep 1e-3\nrestart 20 " + file.name + " " + file.name +
                "2\nrun 60\n");
    Scene again("read_restart " + file.name + "2\n" + grid + load + "run 20\n");
    EXPECT_NEAR(again.time(), 0.06, 1e-12);
    EXPECT_LT(difference(whole.gather(), again.gather()), 1e-9);
    std::remove((file.name + "2").c_str());
  }
}

// a state that is longer or shorter than the fix expects belongs to another version or to other
// options, and is not read
SERIAL_TEST(RestartFile, HasStatesOfTheRightSize)
{
  const ScratchFile file("sizes.bin");
  const std::string input = head + "fix grid all mpm 1.0\n" + points + fixes("") + start,
                    with = "\nneighbor 0.3 bin\n" + fixes("") + "run 0\n";
  Scene whole(input + "run 20\nwrite_restart " + file.name + "\n");
  const std::string bytes = file_text(file.name);
  int nstates = 0;
  for (std::size_t at = sizeof(int); at + 24 < bytes.size(); at++) {
    double header[3];    // size, -size, checksum; before it, the number of all bytes
    memcpy(header, bytes.data() + at, sizeof(header));
    if (!(header[0] >= 8.0 && header[0] < 1.0e4) || header[1] != -header[0]) continue;
    nstates++;
    for (const int more : {8, -8}) {
      std::string state = bytes.substr(at + 24, (std::size_t) header[0]);
      state.resize(state.size() + more, '\0');
      const double other[3] = {header[0] + more, -header[0] - more,
                               checksum(state.data(), state.size())};
      const int all = (int) (sizeof(other) + state.size());
      const ScratchFile changed("changed.bin",
                                bytes.substr(0, at - sizeof(int)) +
                                    std::string((const char *) &all, sizeof(int)) +
                                    std::string((const char *) other, sizeof(other)) + state +
                                    bytes.substr(at + 24 + (std::size_t) header[0]));
      Scene again;
      EXPECT_THAT(again.error("read_restart " + changed.name + with),
                  ::testing::AnyOf(::testing::HasSubstr("longer or shorter"),
                                   ::testing::HasSubstr("have the history variables"),
                                   ::testing::HasSubstr("has other options")))
          << at << ' ' << more;
    }
  }
  EXPECT_EQ(nstates, 5);    // mpm, two materials, boundary, dt
}

// bytes that have changed on a disk are seen, in each state of a fix, and in what belongs to a
// point
SERIAL_TEST(RestartFile, DamageIsSeen)
{
  const ScratchFile file("whole.bin");
  const std::string input = head + "fix grid all mpm 1.0\n" + points + fixes("") + start,
                    with = "\nneighbor 0.3 bin\n" + fixes("") + "run 0\n";
  Scene whole(input + "run 20\nwrite_restart " + file.name + "\n");
  const std::string bytes = file_text(file.name);
  const auto number = [&](std::size_t at) {
    double value;
    memcpy(&value, bytes.data() + at, sizeof(value));
    return value;
  };
  std::vector<std::size_t> places;    // of bytes that change
  for (std::size_t at = 0; at + 24 < bytes.size(); at++) {
    const double size = number(at);    // a state begins with its size, twice
    if (size >= 8.0 && size < 1.0e4 && size == std::floor(size) && number(at + 8) == -size)
      places.insert(places.end(), {at, at + 10, at + 24 + (std::size_t) size / 2});
  }
  EXPECT_EQ(places.size(), 5u * 3u);    // mpm, two materials, boundary, dt
  // the velocity of a point comes before its deformation, its stress, and its history
  const auto atoms = whole.gather();
  const auto found = bytes.find(std::string((const char *) atoms[5].v, sizeof(atoms[5].v)));
  ASSERT_NE(found, std::string::npos);
  for (const int real : {0, 2, 8, 12, 18}) places.push_back(found + 8 * real + 3);

  for (const auto place : places) {
    std::string changed = bytes;
    changed[place] ^= 0x10;
    const ScratchFile damaged("damaged.bin", changed);
    Scene again;
    EXPECT_THAT(again.error("read_restart " + damaged.name + with),
                ::testing::HasSubstr("is not what was written"))
        << place << " of " << bytes.size();
  }
  // image flags that read_restart changes are no damage
  Scene again;
  EXPECT_EQ(again.error("read_restart " + file.name + " remap" + with), "");
  EXPECT_TRUE(identical(whole.gather(), again.gather()));
}
