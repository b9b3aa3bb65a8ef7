/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// labels: physics
// mpi: 1 2

// Atoms of molecular dynamics and material points in one run.

#include "mpm_lammps.h"

#include "gtest/gtest.h"

using namespace MPM_TEST;

static const char *const scene = R"(
units lj
boundary p p p
atom_style hybrid atomic mpm
neighbor 0.3 bin
region box block 0 12 0 12 0 24
create_box 2 box
mass * 1.0
fix grid all mpm 1.0
region slab block 2 10 2 10 4 8
create_points 1 region slab ppc 2
group slab type 1
fix soft slab mpm/material density 1.0 neohookean 200.0 0.3
lattice sc 1.2 origin 0.5 0.5 0.5
region gas block 3 9 3 9 10 16 units box
create_atoms 2 region gas
group gas type 2
set type 2 mass 1.0
velocity gas set 0.05 0 -1.0 units box
pair_style lj/cut 1.12
pair_coeff * * 1.0 1.0 1.12
pair_coeff 1 2 1.0 0.8 0.9
pair_modify shift yes
neigh_modify exclude type 1 1
fix md gas nve
timestep 0.004
thermo 1000
)";

// Atoms have the velocity of full steps, points that of half steps: the momentum of all, with the
// second half of the last impulse given to the points, is constant to round-off.

// With every K, points take a step in every K of the atoms, with the mean of the K forces.

class Atoms : public ::testing::TestWithParam<int> {};

TEST_P(Atoms, HitABodyWithConstantMomentum)
{
  Scene run;
  run.commands(replaced(scene, "mpm 1.0\n", strprintf("mpm 1.0 every %d\n", GetParam())));
  run.commands("run 0 post no\n");
  auto *atom = run.lmp->atom;

  auto momentum = [&](double *p) {
    double mine[4] = {0.0, 0.0, 0.0, 0.0};    // the last: momentum of the points along z
    for (int i = 0; i < atom->nlocal; i++) {
      for (int d = 0; d < 3; d++) {
        mine[d] += atom->rmass[i] * atom->v[i][d];
        if (atom->type[i] == 1) mine[d] += 0.5 * run.lmp->update->dt * atom->f[i][d];
      }
      if (atom->type[i] == 1) mine[3] += atom->rmass[i] * atom->v[i][2];
    }
    MPI_Allreduce(mine, p, 4, MPI_DOUBLE, MPI_SUM, run.lmp->world);
  };

  double start[4], now[4], pushed = 0.0;
  momentum(start);
  EXPECT_DOUBLE_EQ(start[3], 0.0);
  for (int k = 0; k < 10; k++) {
    run.commands("run 60 post no\n");
    momentum(now);
    for (int d = 0; d < 3; d++) EXPECT_NEAR(now[d], start[d], 1.0e-12 * std::abs(start[2]));
    pushed = std::min(pushed, now[3]);
  }
  EXPECT_LT(pushed, 0.5 * start[2]);    // the atoms did hit the body
}

INSTANTIATE_TEST_SUITE_P(Every, Atoms, ::testing::Values(1, 2, 5));
