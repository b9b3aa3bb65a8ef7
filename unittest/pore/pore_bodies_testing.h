// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_PORE_BODIES_TESTING_H
#define MPM_PORE_BODIES_TESTING_H

// Bodies with pore water that collide, for tests of fix mpm/pore on ranks and after restarts.

#include "mpm_lammps.h"

#include "output/compute_mpm_atom.h"

namespace MPM_TEST {

/** Input of a disk and a block of soils and a dry block, which collide across ranks and periodic
 *  faces. water: arguments of fix mpm/pore; variables: lines that define variables in them. */
inline std::string colliding(const std::string &variables, const std::string &water)
{
  return plane("lj", "p p", "0 8 0 8", 3, 0.4) + "fix grid all mpm 0.5\n" +
      bodies({{"one", "sphere 3 4 0 1.6 side in"},
              {"two", "block 5 6.6 3 5 -0.5 0.5"},
              {"dry", "block 3 5 0.8 2 -0.5 0.5"}}) +
      "fix m one mpm/material density 1.0 eos linear 20.0 strength j2 8.0 0.4\n"
      "fix n two mpm/material density 2.0 eos linear 30.0 strength j2 8.0 0.4\n"
      "fix o dry mpm/material density 1.0 neohookean 10.0 0.3\n"
      "velocity all set 0.8 0.5 0\nvelocity two set -0.7 0.5 0\n" +
      variables + "fix water all mpm/pore " + water + "\ntimestep 0.005\n";
}
/** The same scene between walls at all faces along x and y. kind: options of these walls. */
inline std::string between_walls(const std::string &scene, const std::string &kind = "slip")
{
  return replaced(scene, "boundary p p p", "boundary f f p") +
      "fix b all mpm/boundary xlo xhi ylo yhi " + kind + "\n";
}

/** Pressure p and saturation S of the water of a point. */
struct PointWater {
  double tag, p, S;
};
/** Water of all points on all ranks, in order of tags. The scene must have the computes of PORE. */
inline std::vector<PointWater> water_of_points(Scene &run)
{
  const double *const p = run.per_atom("pore")->vector_atom,
                      *const S = run.per_atom("saturation")->vector_atom;
  std::vector<PointWater> mine;
  for (int i = 0; i < run.n(); i++) mine.push_back({(double) run.lmp->atom->tag[i], p[i], S[i]});
  return all_by_tag(mine, run.lmp->world);
}
constexpr const char *PORE = "compute pore all mpm/atom pore\n"
                             "compute saturation all mpm/atom saturation\n";

/** Largest difference between the pressures and between the saturations of the same points of two
 *  scenes. It is 1e300 if there are no points, or not the same number of them. */
inline double water_difference(Scene &a, Scene &b)
{
  const auto one = water_of_points(a), other = water_of_points(b);
  if (one.empty() || one.size() != other.size()) return 1.0e300;
  double most[2] = {0.0, 0.0};
  for (std::size_t k = 0; k < one.size(); k++) {
    grow(most[0], one[k].p - other[k].p);
    grow(most[1], one[k].S - other[k].S);
  }
  return std::max(measured("difference of pressures", most[0]),
                  measured("of saturations", most[1]));
}

/** Expects states, water that came in, pressures, and saturations of one rank, within this. */
inline void expect_same_on_ranks(const std::string &scene, double difference)
{
  OnRanks run(scene + PORE, "run 300\n");
  EXPECT_LT(run.difference(), 1e-11);
  EXPECT_LT(water_difference(run.serial, run.parallel), difference);
  EXPECT_NEAR(run.serial.fix("water")->compute_scalar(),
              run.parallel.fix("water")->compute_scalar(), 1e-12);
}

/** Expects the same bits of colliding() with a restart in the middle. variables: as there. */
inline void expect_continues(const std::string &scene, const std::string &variables)
{
  const std::string tail = scene.substr(scene.find("fix m one"));
  std::string fixes = "neighbor 0.4 bin\nfix grid all mpm 0.5\n" + variables;
  for (std::size_t at = 0, end; at < tail.size(); at = end + 1) {
    end = tail.find('\n', at);
    if (tail.compare(at, 4, "fix ") == 0) fixes += tail.substr(at, end - at) + "\n";
  }
  Continued run(scene + PORE, 60, fixes + PORE + "timestep 0.005\n", 60);
  EXPECT_TRUE(identical(run.whole.gather(), run.again.gather()));
  const auto one = water_of_points(run.whole), two = water_of_points(run.again);
  ASSERT_EQ(one.size(), two.size());
  EXPECT_EQ(memcmp(one.data(), two.data(), one.size() * sizeof(PointWater)), 0);
  EXPECT_EQ(run.whole.fix("water")->compute_scalar(), run.again.fix("water")->compute_scalar());
}

/** Greatest velocity of points over what the weight alone would give them in the time t. */
inline double fall(Scene &run, double t)
{
  double most = 0.0;
  for (int i = 0; i < run.n(); i++)
    for (int d = 0; d < 3; d++) grow(most, run.v()[i][d]);
  return over_ranks(most) / (9.81 * run.lmp->force->ftm2v * t);
}

/** Runs to the time end, with steps that are this part of the stable limit. */
inline void run_until(Scene &run, double end, double part = 0.5)
{
  run.commands(strprintf("fix dt all mpm/dt %g until %.17g\nrun 10000000\n", part, end));
}

}    // namespace MPM_TEST

#endif
