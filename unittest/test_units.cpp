/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// labels: unit smoke

// All unit styles: the same numbers for lengths, times and masses, with moduli and accelerations
// converted by LAMMPS's own constants, must give the same motion, and energies in energy units.

#include "mpm_lammps.h"

#include "force.h"

#include "gtest/gtest.h"

using namespace MPM_TEST;

struct Result {
  std::vector<Scene::State> states;
  double kinetic, total, wavespeed, scale;    // scale: mvv2e of the unit style
  double inconsistency;                       // of mvv2e and 1/ftm2v
};

static Result simulate(const std::string &units, const std::string &material)
{
  Scene run;
  run.commands("units " + units + "\n");
  auto *force = run.lmp->force;
  const double pressure = force->mvv2e * force->nktv2p;
  auto text = [](double value) {
    return fmt::format("{:.17g}", value);
  };
  std::string law = material;
  for (const char *name : {"P1", "P2", "P3"}) {
    const auto at = law.find(name);
    if (at == std::string::npos) continue;
    const double value = name[1] == '1' ? 100.0 : name[1] == '2' ? 40.0 : 1.0;
    law.replace(at, 2, text(value * pressure));
  }
  run.commands("boundary f f f\natom_style mpm\nneighbor 0.3 bin\ntimestep 0.02\n"
               "region box block 0 8 0 8 0 8\ncreate_box 1 box\nfix grid all mpm 1.0\n"
               "region one block 2 6 2 6 0 4\ncreate_points 1 region one ppc 2\n"
               "fix m all mpm/material density 1.5 " +
               law +
               "\n"
               "fix floor all mpm/boundary zlo separate friction 0.3\n"
               "fix g all gravity " +
               text(0.5 / force->ftm2v) +
               " vector 0.2 0 -1\n"
               "velocity all set 0.3 0.1 -0.5\n"
               "compute e all mpm/energy\ncompute c all mpm/atom wavespeed energy\n"
               "compute cmax all reduce max c_c[1]\ncompute sum all reduce sum c_c[2]\n"
               "thermo_style custom step c_e c_e[1] c_e[2] c_e[11] c_cmax c_sum\n"
               "run 60\n");
  Result r;
  r.states = run.gather();
  auto *energy = run.lmp->modify->get_compute_by_id("e");
  energy->compute_vector();
  r.kinetic = energy->vector[0];
  r.total = energy->compute_scalar();
  r.wavespeed = run.lmp->modify->get_compute_by_id("cmax")->compute_scalar();
  r.scale = force->mvv2e;
  r.inconsistency = std::abs(force->mvv2e * force->ftm2v - 1.0);
  EXPECT_LT(std::abs(energy->vector[10]), 1.0e-10 * r.total) << units;
  const double stored = run.lmp->modify->get_compute_by_id("sum")->compute_scalar();
  EXPECT_NEAR(stored, energy->vector[1], 1.0e-10 * r.total) << units;
  for (auto &s : r.states)
    for (double &stress : s.stress) stress /= pressure;
  return r;
}

class Units : public ::testing::TestWithParam<std::string> {};

TEST_P(Units, SameMotionInAllUnitStyles)
{
  const Result lj = simulate("lj", GetParam());
  EXPECT_GT(lj.kinetic, 0.0);
  for (const std::string units : {"real", "metal", "si", "cgs", "electron", "micro", "nano"}) {
    const Result other = simulate(units, GetParam());

    // LAMMPS's factors of electron units agree with each other to 8 digits only
    const double tolerance = 1.0e-10 + 100.0 * other.inconsistency;
    EXPECT_LT(difference(lj.states, other.states), tolerance) << units;
    EXPECT_NEAR(other.total / other.scale, lj.total, tolerance * lj.total) << units;
    EXPECT_NEAR(other.wavespeed, lj.wavespeed, tolerance * lj.wavespeed) << units;
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, Units,
                         ::testing::Values("neohookean P1 0.3",
                                           "eos shock 8.0 1.5 2.0 strength j2 P2 P3",
                                           "eos tait P1 7 viscosity newtonian P3 "
                                           "viscosity artificial 1.5 0.06"));
