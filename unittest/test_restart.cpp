/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */


// labels: restart
// mpi: 1 2 3
// timeout: 300

// A run continued from a restart file is the uninterrupted run, bit by bit on the same number of
// ranks, and to round-off on another.

#include "mpm_lammps.h"

#include "gtest/gtest.h"

#include <cstring>

using namespace MPM_TEST;

static const std::string head = "units lj\nboundary p p f\natom_style mpm\nneighbor 0.3 bin\n"
                                "region box block 0 8 0 8 0 8\ncreate_box 2 box\n";

static std::string fixes(const std::string &options)
{
  return "fix grid all mpm 1.0 " + options + "\n" +
      "group one type 1\ngroup two type 2\n"
      "fix m1 one mpm/material density 1.0 neohookean 10.0 0.3\n"
      "fix m2 two mpm/material density 2.0 eos linear 20.0 "
      "strength j2 5.0 0.05 hardening linear 0.5\n"
      "fix floor all mpm/boundary zlo slip\n"
      "fix step all mpm/dt 0.3\n"
      "thermo 1000\n";
}

static const std::string points =
    "region one sphere 2.6 3.0 3.2 1.9\n"
    "region two block 4.8 7.3 2.0 5.0 2.5 5.5\n"
    "create_points 1 region one ppc 2\n"
    "create_points 2 region two ppc 2\n";

static const std::string start = "velocity one set 0.6 0.35 -0.4\n"
                                 "velocity two set -0.5 0.1 -0.3\n";

static std::string file_name()
{
  int nprocs;
  MPI_Comm_size(MPI_COMM_WORLD, &nprocs);
  return "mpm_restart." + std::to_string(nprocs) + ".*.bin";
}

static std::string file_at(int step)
{
  std::string name = file_name();
  return name.replace(name.find("*"), 1, std::to_string(step));
}

class Restart : public ::testing::TestWithParam<std::string> {};

TEST_P(Restart, ContinuesBitwise)
{
  const std::string options = GetParam();
  Run whole;
  whole.commands(head + "fix grid all mpm 1.0 " + options + "\n" + points + "unfix grid\n" +
                 fixes(options) + start + "restart 100 " + file_name() + "\nrun 200\n");
  auto expected = whole.gather();
  const double time = whole.lmp->update->atime +
      (whole.lmp->update->ntimestep - whole.lmp->update->atimestep) * whole.lmp->update->dt;

  Run again;
  again.commands("read_restart " + file_at(100) + "\nneighbor 0.3 bin\n" + fixes(options) +
                 "run 100\n");
  auto found = again.gather();
  ASSERT_EQ(expected.size(), found.size());
  EXPECT_EQ(again.lmp->update->ntimestep, 200);
  EXPECT_EQ(0, memcmp(expected.data(), found.data(), found.size() * sizeof(Run::State)));
  EXPECT_LT(difference(expected, found), 1.0e-300);
  EXPECT_EQ(time, again.lmp->update->atime +
            (again.lmp->update->ntimestep - again.lmp->update->atimestep) * again.lmp->update->dt);

  // one rank reads the file of many

  MPI_Barrier(MPI_COMM_WORLD);
  Run serial(MPI_COMM_SELF);
  serial.commands("read_restart " + file_at(100) + "\nneighbor 0.3 bin\n" + fixes(options) +
                  "run 100\n");
  EXPECT_LT(difference(expected, serial.gather()), 1.0e-11);
  MPI_Barrier(MPI_COMM_WORLD);
  int me;
  MPI_Comm_rank(MPI_COMM_WORLD, &me);
  if (me == 0)
    for (int step : {100, 200}) remove(file_at(step).c_str());
}

INSTANTIATE_TEST_SUITE_P(Options, Restart,
                         ::testing::Values("transfer apic", "shape linear transfer flip 0.99 scheme musl",
                                           "shape cubic transfer apic scheme musl",
                                           "transfer pic scheme usf"));
