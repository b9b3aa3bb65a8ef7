// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit smoke

// All unit styles: the same numbers for lengths, times and masses, with moduli and accelerations
// converted by LAMMPS's own constants, must give the same motion, and energies in energy units.

#include "mesh/stl_testing.h"

using namespace MPM_TEST;

struct Result {
  std::vector<Scene::State> states;
  std::vector<double> energies, forces;    // in mass velocity^2, and mass acceleration
  double wavespeed;
  double inconsistency;    // of mvv2e and 1/ftm2v
};

/** {number P} as a pressure, {A} as force/mass, {F} as a force, in the units of the instance. */
static std::string converted(const std::string &text, Force *force)
{
  std::string out;
  for (std::size_t at = 0, end; at < text.size(); at = end + 1) {
    const auto start = std::min(text.find('{', at), text.size());
    out += text.substr(at, start - at);
    if (start == text.size()) break;
    end = text.find('}', start);
    std::size_t used;
    const double value = std::stod(text.substr(start + 1), &used);
    const double unit = text[end - 1] == 'P' ? force->mvv2e * force->nktv2p : 1.0 / force->ftm2v;
    out += fmt::format("{:.17g}", value * unit);
  }
  return out;
}

/** Runs a scene; forces of its fixes mpm/boundary and mpm/rigid are compared. */
static Result simulate(const std::string &units, const std::string &scene)
{
  Scene run("units " + units + "\n");
  auto *force = run.lmp->force;
  run.commands(converted(scene, force) +
               "compute e all mpm/energy\ncompute c all mpm/atom wavespeed energy\n"
               "compute cmax all reduce max c_c[1]\ncompute sum all reduce sum c_c[2]\n"
               "thermo_style custom step c_e c_e[1] c_e[2] c_e[11] c_cmax c_sum\n"
               "timestep 0.02\nrun 60\n");
  Result r;
  r.states = run.gather();
  auto *energy = run.lmp->modify->get_compute_by_id("e");
  energy->compute_vector();
  const double total = energy->compute_scalar();
  for (int k = 0; k < energy->size_vector; k++)
    r.energies.push_back(energy->vector[k] / force->mvv2e);
  r.energies.push_back(total / force->mvv2e);
  for (auto *fix : run.lmp->modify->get_fix_by_style("^mpm/boundary$"))
    for (int d = 0; d < 3; d++) r.forces.push_back(fix->compute_vector(d) * force->ftm2v);
  r.wavespeed = run.compute_scalar("cmax");
  r.inconsistency = std::abs(force->mvv2e * force->ftm2v - 1.0);
  EXPECT_LT(std::abs(energy->vector[10]), 1.0e-10 * total) << units;
  if (run.lmp->modify->get_fix_by_style("^mpm/elements$").empty()) {
    EXPECT_NEAR(run.compute_scalar("sum"), energy->vector[1], 1.0e-12 * total) << units;
  }
  for (auto &s : r.states)
    for (double &stress : s.stress) stress /= force->mvv2e * force->nktv2p;
  return r;
}

static void compare(const std::string &scene)
{
  const Result lj = simulate("lj", scene);
  EXPECT_GT(lj.energies[0], 0.0);
  EXPECT_GT(lj.energies[1], 0.0);
  double largest = 0.0;
  for (const double f : lj.forces) largest = std::max(largest, std::abs(f));
  for (const std::string units : {"real", "metal", "si", "cgs", "electron", "micro", "nano"}) {
    const Result other = simulate(units, scene);

    // LAMMPS's factors of electron units agree with each other to 8 digits only
    const double tolerance = 1.0e-10 + 100.0 * other.inconsistency;
    EXPECT_LT(difference(lj.states, other.states), tolerance) << units;
    for (std::size_t k = 0; k < lj.energies.size(); k++)
      EXPECT_NEAR(other.energies[k], lj.energies[k], tolerance * lj.energies.back())
          << units << " " << k;
    for (std::size_t k = 0; k < lj.forces.size(); k++)
      EXPECT_NEAR(other.forces[k], lj.forces[k], tolerance * largest) << units << " " << k;
    EXPECT_NEAR(other.wavespeed, lj.wavespeed, tolerance * lj.wavespeed) << units;
  }
}

// without units
static const std::string box3d =
    replaced(space("", "f f f", "0 8 0 8 0 8", 2, 0.3), "units \n", "");
static const std::string box2d = replaced(plane("", "f f", "0 8 0 8", 2, 0.3), "units \n", "");
static const std::string soft = "fix m all mpm/material density 1.5 neohookean {100 P} 0.3\n";

/** A block on a lattice with these options. */
static std::string block(const std::string &options = "")
{
  return box3d + "fix grid all mpm 1.0 " + options +
      "\nregion one block 2 6 2 6 0 4\ncreate_points 1 region one ppc 2\n";
}

PARAMETER_TEST(Units, SameMotionInAllUnitStyles, std::string,
               Values("neohookean {100 P} 0.3", "eos shock 8.0 1.5 2.0 strength j2 {40 P} {1 P}",
                      "eos tait {100 P} 7 viscosity newtonian {1 P} "
                      "viscosity artificial 1.5 0.06"))
{
  compare(block() + "fix m all mpm/material density 1.5 " + GetParam() +
          "\nfix floor all mpm/boundary zlo separate friction 0.3\n"
          "fix g all gravity {0.5 A} vector 0.2 0 -1\nvelocity all set 0.3 0.1 -0.5\n");
}

// the parts of fix mpm that convert units on their own
PARAMETER_TEST(UnitsOfOptions, SameMotionInAllUnitStyles, const char *,
               Values("frame total", "frame total reference update 1.02",
                      "transfer flip 1.0 scheme usf locking both",
                      "shape linear transfer apic light 0.5", "transfer xpic 2",
                      "shape cpdi transfer tpic", "every 3 transfer flip 0.99 edges modified"))
{
  compare(block(GetParam()) + soft +
          "fix floor all mpm/boundary zlo slip\nfix g all gravity {0.5 A} vector 0.2 0 -1\n"
          "velocity all ramp vz 0.0 -1.0 z 0 4\n");
}

// density and modulus eight times as large: the same to the last bit, as factors of two are exact
TEST_P(UnitsOfOptions, DensityAndModulusTogether)
{
  std::vector<Scene::State> states[2];
  for (const int k : {0, 1}) {
    Scene run("units lj\n" + block(GetParam()) +
              fmt::format("fix m all mpm/material density {} neohookean {} 0.3\n", k ? 12.0 : 1.5,
                          k ? 800.0 : 100.0) +
              "fix floor all mpm/boundary zlo slip\nvelocity all ramp vz 0.0 -1.0 z 0 4\n"
              "velocity all ramp vx 0.0 0.5 y 0 4 sum yes\ntimestep 0.02\nrun 60\n");
    states[k] = run.gather();
    for (auto &s : states[k]) {
      s.mass /= k ? 8.0 : 1.0;
      for (double &stress : s.stress) stress /= k ? 8.0 : 1.0;
    }
  }
  EXPECT_TRUE(identical(states[0], states[1])) << difference(states[0], states[1]);
}

TEST(Units, Axisymmetric)
{
  for (const char *options : {"", "frame total transfer flip 1.0 scheme musl"})
    compare(box2d + "fix grid all mpm 1.0 axisymmetric yes " + options +
            "\nregion one block 0 4 0 5 INF INF\ncreate_points 1 region one ppc 2\n" + soft +
            "fix walls all mpm/boundary xlo ylo slip\nfix g all gravity {0.5 A} vector 0 -1 0\n"
            "velocity all ramp vx 0.0 0.5 x 0 4\n");
}

TEST(Units, Contact)
{
  for (const char *law : {"coulomb 0.3", "adhesive {5 P} {3 P} {1 P}"})
    compare(box2d + fields({{"one", "block 1 4 1 4 INF INF"}, {"two", "block 4 7 1 5 INF INF"}}) +
            soft + "fix touch all mpm/contact F1 F2 law " + law +
            "\nvelocity one set 0.6 0.3 0\nvelocity two set -0.6 -0.1 0\n");
}

TEST(Units, Rigid)
{
  const ScratchFile stl("box.stl", binary_of(box({-0.8, -0.8, -0.8}, {0.8, 0.8, 0.8})));
  compare(block() + soft + "fix floor all mpm/boundary zlo stick\nregion shape mpm/mesh " +
          stl.name +
          " 1.0 4.1 3.8 5.2\nfix tool all mpm/rigid shape density 2.0 separate friction 0.2 "
          "gravity 0 0 -0.5 force {0.3 F} 0 0 velocity 0 0 -0.8\n");
}

TEST(Units, Elements)
{
  const ScratchFile mesh(
      "quads.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 2 2 0\n2 4 2 0\n3 6 2 0\n"
      "4 2 4 0\n5 4 4.5 0\n6 6 4 0\n$EndNodes\n$Elements\n2\n1 3 2 1 1 1 2 5 4\n"
      "2 3 2 1 1 2 3 6 5\n$EndElements\n");
  compare(box2d + "fix grid all mpm 1.0\ncreate_points 1 mesh " + mesh.name + "\n" + soft +
          "fix el all mpm/elements " + mesh.name +
          "\nfix g all gravity {0.5 A} vector 0 -1 0\nvelocity all ramp vx -0.5 0.5 x 2 6\n");
}
