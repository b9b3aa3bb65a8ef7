// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_HEAT_TESTING_H
#define MPM_HEAT_TESTING_H

// Points with temperatures, and exact solutions, for tests of fix mpm/heat.

#include "mpm_lammps.h"

namespace MPM_TEST {

/** Temperatures, heat capacities, and positions of points of one material, which must not melt. */
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
    return over(sum);
  }
  /** Mean temperature over the points of the material. */
  double mean()
  {
    double sum = 0.0, n = 0.0;
    for (int i = 0; i < run.n(); i++)
      if (has(i)) {
        sum += T(i);
        n++;
      }
    return over(sum) / over(n);
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
    return {std::sqrt(over(sum) / over(n)), over(most, MPI_MAX)};
  }
  template <class F> double rms(const F &f) { return error(f).rms; }
  /** Lowest and highest temperature. */
  std::array<double, 2> range()
  {
    double least = 1.0e300, most = -1.0e300;
    for (int i = 0; i < run.n(); i++)
      if (has(i)) {
        least = std::min(least, T(i));
        most = std::max(most, T(i));
      }
    return {over(least, MPI_MIN), over(most, MPI_MAX)};
  }
  /** Temperature of the material at a face normal to an axis, by the slope of the two layers of
   *  points next to it. side: -1 if the material is below the place x, else 1; h: node spacing; y:
   *  only points less than near from it along y. */
  double at_face(double x, int side, double h, double y = 0.0, double near = 1.0e300)
  {
    double sum[2] = {0.0, 0.0}, count[2] = {0.0, 0.0};
    for (int i = 0; i < run.n(); i++)
      for (int k = 0; k < 2; k++)
        if (has(i) && std::fabs(run.x()[i][1] - y) < near &&
            std::fabs(run.x()[i][0] - x - side * (0.25 + 0.5 * k) * h) < 0.1 * h) {
          sum[k] += T(i);
          count[k]++;
        }
    return 1.5 * over(sum[0]) / over(count[0]) - 0.5 * over(sum[1]) / over(count[1]);
  }
  /** Mean molten fraction, and enthalpy for a capacity and a heat of fusion of 1 each. */
  std::array<double, 2> melt()
  {
    const int molten = material->find_history("molten");
    std::array<double, 2> sum = {0.0, 0.0};
    for (int i = 0; i < run.n(); i++) {
      const double f = material->history[i][molten];
      sum[0] += f / run.n();
      sum[1] += run.mass()[i] * (T(i) + f);
    }
    return sum;
  }
  /** Mean temperature of the points whose distances from x and y along the axes are smaller than
   *  near. It is the temperature at the mean position of these points. */
  double at(double x, double y, double near)
  {
    double sum = 0.0, n = 0.0;
    for (int i = 0; i < run.n(); i++)
      if (std::fabs(run.x()[i][0] - x) < near && std::fabs(run.x()[i][1] - y) < near) {
        sum += T(i);
        n++;
      }
    return over(sum) / over(n);
  }

 private:
  double over(double value, MPI_Op op = MPI_SUM)
  {
    return over_ranks({value}, op, run.lmp->world)[0];
  }
};

/** Heat that fix mpm/heat has brought. */
inline double heat_in(Scene &run)
{
  return run.fix("heat")->compute_scalar();
}

/** Number of warnings of a body too thin for heat through its surface. */
inline int said_thin(const std::string &scene)
{
  return (int) lines_that_say(scene, "is thinner than 3").size();
}

/** The line of fix mpm/material of a body at rest whose density and specific heat are 1. K:
 *  conductivity and what follows it; T0: initial temperature. */
inline std::string conductor(const std::string &K = "1.0", double T0 = 0.0,
                             const std::string &id_and_group = "m all")
{
  return "fix " + id_and_group +
      strprintf(" mpm/material density 1.0 eos linear 1e-6 thermal conducting 1.0 %.17g ", T0) + K +
      "\n";
}

/** Input of a bar of length 1 along x, with n cells, whose capacity and conductivity are 1. Its
 *  ends are faces of the box. It is four cells wide and periodic along y. heat: arguments of fix
 *  mpm/heat; offset: distance of the ends from nodes, in cells; T0: initial temperature. */
inline std::string bar(int n, const std::string &heat, double offset = 0.0,
                       const std::string &grid = "", double T0 = 0.0)
{
  const double h = 1.0 / n;
  return plane("lj", "f p", strprintf("0 1 0 %.17g", 4 * h), 1, 0.1 * h) +
      strprintf("create_points 1 box spacing %.17g\n", 0.5 * h) +
      strprintf("fix grid all mpm %.17g origin %.17g 0 %s\n", h, -offset * h, grid.c_str()) +
      conductor("1.0", T0) + "fix heat all mpm/heat " + heat + "\n";
}

/** The same in a box to 1.5: its end at 1, the region wall, is shift node spacings from a node. */
inline std::string bar_in_box(int n, double shift, const std::string &heat, double T0,
                              const std::string &grid = "")
{
  const double h = 1.0 / n;
  return plane("lj", "f p", strprintf("0 1.5 0 %.17g", 4 * h), 1, 0.1 * h) +
      "region bar block 0 1 INF INF INF INF\nregion wall block 1 2 INF INF INF INF\n" +
      strprintf("create_points 1 region bar spacing %.17g\n", 0.5 * h) +
      strprintf("fix grid all mpm %.17g origin %.17g 0 %s\n", h, 1.0 - shift * h, grid.c_str()) +
      conductor("1.0", T0) + "fix heat all mpm/heat " + heat + "\n";
}

/** 1 + amplitude cos(pi x/length) along an axis. */
inline auto cosine(double amplitude = 1.0, double length = 1.0, int axis = 0)
{
  return [=](const double *x) {
    return 1.0 + amplitude * std::cos(PI * x[axis] / length);
  };
}
/** Its amplitude at t = 0.1. */
const double DECAYED = std::exp(-0.1 * PI * PI);

/** Temperature of a bar of length 1 whose end at 0 has been at 1 for the time t, the other at 0. */
inline double wall_heats(double x, double t)
{
  double T = 1.0 - x;
  for (int k = 1; k < 400; k++)
    T -= 2.0 / (k * PI) * std::sin(k * PI * x) * std::exp(-k * k * PI * PI * t);
  return T;
}

/** The root k = 0, 1, ... of x tan(x) = Bi. */
inline double slab_root(double Bi, int k)
{
  double low = k * PI, high = (k + 0.5) * PI;
  for (int i = 0; i < 100; i++) {
    const double x = 0.5 * (low + high);
    (x * std::tan(x) > Bi ? high : low) = x;
  }
  return low;
}

/** Mean temperature at the Fourier number Fo of a slab of initial temperature 1. One side loses
 *  heat by convection (Biot number Bi) to surroundings of temperature 0; the other side is
 *  insulated. */
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
/** Runs from time 0 to the time end in equal steps of at most dt. */
inline void run_to(Scene &run, double end, double dt)
{
  const int steps = (int) std::ceil(end / dt - 1.0e-9);
  run.commands(strprintf("timestep %.17g\nrun %d\n", end / steps, steps));
}

/** Rms of the error of cosine() after the time 0.1, in steps of at most dt. Heat is kept. */
inline double error_of_cosine(const std::string &bar, double dt)
{
  Scene run(bar);
  Warm warm(run);
  warm.set(cosine());
  const double before = warm.heat();
  run_to(run, 0.1, dt);
  EXPECT_NEAR(warm.heat() / before, 1.0, 1e-13 + 1e-17 / dt);    // round-off of so many steps
  return warm.rms(cosine(DECAYED));
}

/** The same of the temperatures wall_heats(). What comes in is in the points. */
inline double error_of_wall(const std::string &bar, double dt)
{
  Scene run(bar);
  Warm warm(run);
  const double before = warm.heat();
  run_to(run, 0.1, dt);
  EXPECT_NEAR((warm.heat() - before) / heat_in(run), 1.0, 1e-11);
  return warm.rms([](const double *x) {
    return wall_heats(x[0], 0.1);
  });
}

/** Input of a disk and a block, of two conducting materials with different temperatures, and of a
 *  block that does not conduct. They fly across the lattice, all ranks, and periodic faces, and
 *  deform. */
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

/** Largest difference between the temperatures of the same points of two scenes. It is 1e300 if
 *  there are no points, or not the same number of them. */
inline double temperature_difference(Scene &a, Scene &b)
{
  const auto one = temperatures(a), other = temperatures(b);
  if (one.empty() || one.size() != other.size()) return 1.0e300;
  double most = 0.0;
  for (std::size_t k = 0; k < one.size(); k++)
    most = std::max(most, std::fabs(one[k].T - other[k].T));
  return most;
}

/** Expects the same bits of disk() when it continues from a restart file after 30 steps. */
inline void expect_disk_continues(const std::string &scene, int after = 30)
{
  Continued run(scene, 30, lines_again(scene), after);
  EXPECT_TRUE(identical(run.whole.gather(), run.again.gather()));
  EXPECT_EQ(temperature_difference(run.whole, run.again), 0.0);
  EXPECT_EQ(heat_in(run.whole), heat_in(run.again));
}

/** Expects that the bodies of the scene disk() collide without a change of their heat but by
 *  plastic work, to round-off, and that the ledger closes. */
inline void expect_disk_keeps_heat(Scene &run, const std::string &steps)
{
  run.commands("compute e all mpm/energy\nrun 0\n");
  const double before = Warm(run, "m").heat() + Warm(run, "n").heat();
  run.commands(steps);
  const double *const e = run.compute_vector();
  const double made = e[4], after = Warm(run, "m").heat() + Warm(run, "n").heat();
  EXPECT_GT(measured("plastic work that became heat", made), 0.1);
  EXPECT_NEAR((after - before - made) / before, 0.0, 1e-13);
  EXPECT_NEAR(e[14] / before, 0.0, 1e-13);    // conducted heat
  EXPECT_NEAR(e[10], 0.0, 1e-11);             // residual
}

}    // namespace MPM_TEST
#endif
