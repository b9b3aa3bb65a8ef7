// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

#ifndef MPM_HEAT_TESTING_H
#define MPM_HEAT_TESTING_H

// Points with temperatures, for tests of fix mpm/heat.

#include "mpm_lammps.h"

namespace MPM_TEST {

/** Temperatures, heat capacities, and positions of the points of one material, which must not melt.
 *  id: of its fix mpm/material. */
struct Warm {
  Scene &run;
  FixMPMMaterial *material;
  int column;

  explicit Warm(Scene &run, const std::string &id = "m") :
      run(run), material(run.material(id)), column(material->find_history("temperature"))
  {
  }
  double &T(int i) { return material->history[i][column]; }
  bool has(int i) { return run.lmp->atom->mask[i] & material->groupbit; }
  double capacity(int i)
  {
    return run.mass()[i] * material->material->conduction(material->history[i]).capacity;
  }
  /** Sets T = f(x) for all points of the material. */
  template <class F> void set(const F &f)
  {
    for (int i = 0; i < run.n(); i++)
      if (has(i)) T(i) = f(run.x()[i]);
  }
  /** Heat of the material: the sum of capacity times temperature over all ranks. */
  double heat()
  {
    double sum = 0.0;
    for (int i = 0; i < run.n(); i++)
      if (has(i)) sum += capacity(i) * T(i);
    return over_ranks(sum);
  }
  struct Error {
    double rms, most;
  };
  /** Rms and largest difference of the temperatures from f(x), over all ranks. */
  template <class F> Error error(const F &f)
  {
    double sum = 0.0, n = 0.0, most = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const double d = T(i) - f(run.x()[i]);
      sum += d * d;
      n++;
      most = std::max(most, std::fabs(d));
    }
    const auto all = over_ranks({sum, n});
    return {std::sqrt(all[0] / all[1]), over_ranks(most, MPI_MAX)};
  }
  /** Mean temperature of the points whose distances from x and y along the axes are smaller than near.
   *  It is the temperature at the mean position of these points. */
  double at(double x, double y, double near)
  {
    double sum = 0.0, n = 0.0;
    for (int i = 0; i < run.n(); i++)
      if (std::fabs(run.x()[i][0] - x) < near && std::fabs(run.x()[i][1] - y) < near) {
        sum += T(i);
        n++;
      }
    const auto all = over_ranks({sum, n});
    return all[0] / all[1];
  }
};

/** Number of lines in the log of a scene that warn of a body too thin for heat through its surface. */
inline int said_thin(const std::string &scene)
{
  return (int) lines_that_say(scene, "is thinner than 3").size();
}

/** Input of a bar of length 1 along x, with n cells, whose capacity and conductivity are 1. Its ends are
 *  faces of the box. It is four cells wide and periodic along y. heat: arguments of fix mpm/heat;
 *  offset: distance of the ends from nodes, in cells; T0: initial temperature. */
inline std::string bar(int n, const std::string &heat, double offset = 0.0,
                       const std::string &grid = "", double T0 = 0.0)
{
  const double h = 1.0 / n;
  return plane("lj", "f p", strprintf("0 1 0 %.17g", 4 * h), 1, 0.1 * h) +
      strprintf("create_points 1 box spacing %.17g\n", 0.5 * h) +
      strprintf("fix grid all mpm %.17g origin %.17g 0 %s\n", h, -offset * h, grid.c_str()) +
      strprintf(
             "fix m all mpm/material density 1.0 eos linear 1e-6 thermal conducting 1.0 %g 1.0\n",
             T0) +
      "fix heat all mpm/heat " + heat + "\n";
}
/** Runs from time 0 to the time end in equal steps of at most dt. */
inline void run_to(Scene &run, double end, double dt)
{
  const int steps = (int) std::ceil(end / dt - 1.0e-9);
  run.commands(strprintf("timestep %.17g\nrun %d\n", end / steps, steps));
}

/** Input of a disk and a block, of two conducting materials with different temperatures, and of a block
 *  that does not conduct. They fly across the lattice, all ranks, and periodic faces, and deform. */
inline std::string disk(const std::string &heat, const std::string &velocity = "0.8 0.5 0",
                        const std::string &grid = "")
{
  return plane("lj", "p p", "0 8 0 8", 3, 0.4) + "fix grid all mpm 0.5 " + grid + "\n" +
      bodies({{"one", "sphere 3 4 0 1.6 side in"},
              {"two", "block 5 6.6 3 5 -0.5 0.5"},
              {"cold", "block 3 5 0.8 2 -0.5 0.5"}}) +
      "fix m one mpm/material density 1.0 eos linear 20.0 strength j2 8.0 0.4 thermal conducting "
      "1.5 1.0 0.4\n"
      "fix n two mpm/material density 2.0 eos linear 30.0 thermal conducting 0.7 2.0 0.1\n"
      "fix o cold mpm/material density 1.0 neohookean 10.0 0.3\n"
      "velocity all set " +
      velocity + "\nvelocity two set -0.7 0.5 0\n" + "fix heat all mpm/heat " + heat +
      "\ntimestep 0.02\n";
}

/** Tag and temperature of a point. */
struct Named {
  double tag, T;
};
/** Temperatures of all points of the materials m and n, on all ranks, in order of tags. */
inline std::vector<Named> temperatures(Scene &run)
{
  std::vector<Named> mine;
  for (const char *id : {"m", "n"}) {
    Warm warm(run, id);
    for (int i = 0; i < run.n(); i++)
      if (warm.has(i)) mine.push_back({(double) run.lmp->atom->tag[i], warm.T(i)});
  }
  return all_by_tag(mine, run.lmp->world);
}

/** Largest difference between the temperatures of the same points of two scenes. It is 1e300 if there
 *  are no points, or not the same number of them. */
inline double temperature_difference(Scene &a, Scene &b)
{
  const auto one = temperatures(a), other = temperatures(b);
  if (one.empty() || one.size() != other.size()) return 1.0e300;
  double most = 0.0;
  for (std::size_t k = 0; k < one.size(); k++)
    most = std::max(most, std::fabs(one[k].T - other[k].T));
  return most;
}

}    // namespace MPM_TEST
#endif
