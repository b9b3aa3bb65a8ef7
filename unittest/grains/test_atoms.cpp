// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// mpi: 1 2

// Atoms of molecular dynamics and material points in one run.

#include "mpm_lammps.h"

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
)";

// Atoms have the velocity of full steps, points that of half steps: the momentum of all, with the
// second half of the last impulse given to the points, is constant to round-off.

// With every K, points take a step in every K of the atoms, with the mean of the K forces.
PARAMETER_TEST(Atoms, HitABodyWithConstantMomentum, int, Values(1, 2, 5))
{
  Scene run(replaced(scene, "mpm 1.0\n", strprintf("mpm 1.0 every %d\n", GetParam())) +
            "run 0 post no\n");
  auto *atom = run.lmp->atom;

  const auto momentum = [&]() {
    std::vector<double> mine(4);    // the last: momentum of the points along z
    for (int i = 0; i < atom->nlocal; i++) {
      for (int d = 0; d < 3; d++) {
        mine[d] += atom->rmass[i] * atom->v[i][d];
        if (atom->type[i] == 1) mine[d] += 0.5 * run.lmp->update->dt * atom->f[i][d];
      }
      if (atom->type[i] == 1) mine[3] += atom->rmass[i] * atom->v[i][2];
    }
    return over_ranks(mine);
  };

  const auto start = momentum();
  double pushed = 0.0;
  EXPECT_DOUBLE_EQ(start[3], 0.0);
  for (int k = 0; k < 10; k++) {
    run.commands("run 60 post no\n");
    const auto now = momentum();
    for (int d = 0; d < 3; d++) EXPECT_NEAR(now[d], start[d], 1.0e-12 * std::abs(start[2]));
    pushed = std::min(pushed, now[3]);
  }
  EXPECT_LT(pushed, 0.5 * start[2]);    // the atoms did hit the body
}

// A plate of points hits a crystal of atoms, twice as both are periodic: fcc, lj/cut 2.5, and a
// plate of its density, Poisson number and c11, at 5 % of the speed of sound, 9.534. Energy of
// atoms and points, less what the ledger has as errors of the method in the points, is that of the
// start, to 1e-4; momentum is constant, to 1e-10. Asked over 1e5 steps, in which the plate hits
// again and again. What is lost and not in the ledger belongs to the impacts and is of first order
// in the time step: points move with the new velocities of the nodes, while the ledger counts the
// work of forces at the mean of the old and the new one, and transfers change one into the other.
// With a step of 0.002 it is 0.7e-4 after 4e4 steps and 1.2e-4 after 1e5; with 0.001 it is half as
// much in the same time, and 0.2e-4 after 1e5 steps (crystal without plate: 3e-6).
TEST(Crystal, KeepsMomentumAndEnergyWithAPlate)
{
  struct Case {
    int every, steps, wide;
    double dt;
  };
  for (const auto &[every, steps, wide, dt] :
       first_of(1, {Case{5, 4000, 6, 0.004}, Case{1, 40000, 4, 0.002}})) {
    Scene run("variable a equal 1.549603\nunits lj\nboundary p p p\natom_style hybrid atomic mpm\n"
              "neighbor 0.3 bin\n" +
              strprintf("region box block 0 $(%d*v_a) 0 $(%d*v_a) 0 $(12*v_a)\n", wide, wide) +
              "create_box 2 box\nmass * 1.0\nlattice fcc $(4/v_a^3)\n"
              "region c block INF INF INF INF 0 $(3.99*v_a) units box\ncreate_atoms 2 region c\n"
              "group crystal type 2\nset type 2 mass 1.0\n" +
              strprintf("fix grid all mpm $(v_a) transfer flip 1.0 every %d\n", every) +
              "region p block INF INF INF INF $(5*v_a) $(8*v_a) units box\n"
              "create_points 1 region p ppc 2\ngroup plate type 1\n"
              "fix m plate mpm/material density 1.074975 linear 57.3528 0.36277\n"
              "velocity plate set 0 0 -0.4767 units box\npair_style lj/cut 2.5\n"
              "pair_coeff * * 1.0 1.0 2.5\npair_coeff 1 2 0.5 0.8 0.898\npair_modify shift yes\n"
              "neigh_modify exclude type 1 1\nfix move crystal nve\ntimestep 0.004\n"
              "compute kc crystal ke\ncompute e all mpm/energy\n"
              "thermo_style custom step c_kc pe c_e[1]\nthermo_modify norm no\n"
              "variable p equal mass(crystal)*vcm(crystal,z)+mass(plate)*vcm(plate,z)\n"
              "variable total equal c_kc+c_thermo_pe+c_e[1]+c_e[2]-c_e[9]-c_e[10]\nrun 0\n"
              "fix mean all ave/time 10 40 400 v_total\n");
    const double p = run.evaluate("v_p"), impact = run.evaluate("c_e[1]");
    // means over 400 steps: velocities of points are those of half a step before
    run.commands(strprintf("timestep %g\nrun 400\n", dt));
    const double energy = run.evaluate("f_mean");
    run.commands(strprintf("run %d\n", steps - 400));
    EXPECT_NEAR(measured("momentum/start", run.evaluate("v_p") / p), 1.0, 1.0e-12);
    EXPECT_LT(std::abs(measured("energy gained/all", (run.evaluate("f_mean") - energy) / energy)),
              1.0e-4);
    EXPECT_LT(run.evaluate("c_e[1]"), 0.8 * impact);    // it has hit
  }
}

// LAMMPS takes the cutoff of communication from the lengths of bonds only where there is no pair
// style and no cutoff of the user. Two beads are bonded across a periodic face, 0.42 apart, next to
// material points, or to elements, whose nodes are ghosts up to 0.1.
TEST(Bonds, ReachAcrossFacesWithoutAPairStyle)
{
  const ScratchFile cable(
      "cable.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0.8 0.4 0\n2 0.9 0.4 0\n3 1.0 0.4 0\n"
      "$EndNodes\n$Elements\n2\n1 1 0 1 2\n2 1 0 2 3\n$EndElements\n");
  const std::string of_cable = cable.name + " thickness 0.01", block = "region block spacing 0.025",
                    solid = "fix m points mpm/material density 1000 neohookean 1.0e5 0.3\n";
  const std::pair<std::string, std::string> cases[] = {
      {block, solid + "fix grid points mpm 0.05"},
      {block, "fix grid points mpm/incompressible 0.05 1000"},
      {"mesh " + of_cable,
       solid + "fix e points mpm/elements " + of_cable + "\nfix points points nve"}};
  for (const auto &[points, fixes] : cases) {
    Scene run("units si\ndimension 2\nboundary p p p\natom_style hybrid bond mpm\n"
              "neighbor 0.02 bin\nregion box block 0 2 0 1 -0.1 0.1\n"
              "create_box 2 box bond/types 1 extra/bond/per/atom 2 extra/special/per/atom 8\n"
              "region block block 0.8 1.2 0.2 0.6 INF INF\nmass * 1\ncreate_points 1 " +
              points +
              "\ngroup points type 1\nvariable n equal count(points)\n"
              "create_atoms 2 single 0.21 0.81 0\ncreate_atoms 2 single 1.79 0.81 0\n"
              "group beads type 2\nset group beads mass 10\n" +
              fixes +
              "\nfix move beads nve\nbond_style harmonic\nbond_coeff 1 200 0.3\n"
              "create_bonds single/bond 1 $(v_n+1) $(v_n+2)\n"
              "timestep 1e-5\nthermo_style custom step ebond\n");
    for (int k = 0; k < 2; k++) {
      run.commands("run 0\n");
      EXPECT_NEAR(run.evaluate("ebond"), 200.0 * (0.42 - 0.3) * (0.42 - 0.3), 1.0e-12) << fixes;
    }
  }
}
