// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

#ifndef MPM_HEAT_TEST_H
#define MPM_HEAT_TEST_H

// What tests of fix mpm/heat have in common.

#include "mpm_lammps.h"

namespace MPM_TEST {

/** Temperatures, capacities, and places of the points of a material with the ID m, which has no melting. */
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
  /** T = f(x) of all points. */
  template <class F> void set(const F &f)
  {
    for (int i = 0; i < run.n(); i++)
      if (has(i)) T(i) = f(run.x()[i]);
  }
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
  /** Differences from f(x). */
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
  /** Mean over the points with their place in a range, at the place that these have in the mean. */
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

inline void run_to(Scene &run, double end, double dt)
{
  const int steps = (int) std::ceil(end / dt - 1.0e-9);
  run.commands(strprintf("timestep %.17g\nrun %d\n", end / steps, steps));
}

/** Roots of x tan(x) = Bi, the k-th from 0 on. */
inline double slab_root(double Bi, int k)
{
  double low = k * PI, high = (k + 0.5) * PI;
  for (int i = 0; i < 100; i++) {
    const double x = 0.5 * (low + high);
    (x * std::tan(x) > Bi ? high : low) = x;
  }
  return low;
}

/** Mean temperature of a slab that is at 1 first, with convection on one side and none on the other, after
 *  the time Fo. */
inline double slab_mean(double Bi, double Fo)
{
  double sum = 0.0;
  for (int k = 0; k < 50; k++) {
    const double b = slab_root(Bi, k);
    sum += 2.0 * std::sin(b) * std::sin(b) / (b * (b + std::sin(b) * std::cos(b))) *
        std::exp(-b * b * Fo);
  }
  return sum;
}

}    // namespace MPM_TEST
#endif
