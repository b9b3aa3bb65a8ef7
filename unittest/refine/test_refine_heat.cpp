// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input ranks
// mpi: 1 4

// Fix mpm/heat in a body on lattices of different spacing (fix mpm/refine).

#include "heat/heat_testing.h"
#include "refine/refine_testing.h"

using namespace MPM_TEST;

const char *const solid =
    "fix m all mpm/material density 1.0 eos linear 1e-6 thermal conducting 1.0 0.0 1.0\n";

struct Lattices {
  int dim, levels;
  const char *shape, *options;
  friend void PrintTo(const Lattices &p, std::ostream *out)
  {
    *out << p.dim << "d " << p.levels << " levels " << p.shape << " " << p.options;
  }
};

// Between faces with two temperatures, the temperature of a body at rest is linear in space, and
// heat that flows is that of the whole section: to round-off with linear functions. With others,
// integrals by coarse points differ next to edges of the finer part (3d, steps of 10, 1, and 0.2:
// 5.1e-4, 5.1e-4, and 5.2e-4)
PARAMETER_TEST(Profile, IsLinear, Lattices,
               Values(Lattices{2, 2, "linear", ""}, Lattices{2, 3, "linear", "frame total"},
                      Lattices{3, 2, "linear", ""}, Lattices{2, 2, "quadratic", ""},
                      Lattices{2, 3, "quadratic", "frame total"}, Lattices{2, 2, "cubic", ""},
                      Lattices{3, 2, "quadratic", ""}))
{
  if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  const auto &p = GetParam();
  const bool linear = p.shape == std::string("linear");
  Scene run(MPI_COMM_SELF);
  run.commands(box(p.dim, "lj", "f f f", "0 12 0 11 0 9", p.levels, 0.2) +
               nested(p.dim, p.levels, p.shape, p.options) + solid +
               "fix heat all mpm/heat xlo temperature 1 xhi temperature 3 stages 200\n"
               "timestep 10\n");
  Warm warm(run);
  const auto line = [](const double *x) {
    return 1.0 + x[0] / 6.0;
  };
  warm.set(line);
  run.commands("run 60\n");
  EXPECT_GT(run.fix("one")->compute_vector(0), 20.0);    // tied
  EXPECT_GT(run.fix("one")->compute_vector(1), 20.0);    // free
  EXPECT_LT(measured("greatest error of the temperature", warm.error(line).most),
            linear ? 1e-12 : (p.shape == std::string("cubic") ? 5e-3 : 5.5e-4));
  const double exact = 11.0 / 6.0 * (p.dim == 3 ? 9.0 : 1.0);
  EXPECT_NEAR(measured("heat through xlo, of the exact one", run.fix_vector("heat", 6)[0] / -exact),
              1.0, linear ? 1e-12 : 3e-3);
  EXPECT_NEAR(measured("through xhi", run.fix_vector("heat", 6)[1] / exact), 1.0,
              linear ? 1e-12 : 3e-3);
}

// A bar without heat through its ends, with a finer part: order 2, no worse than on the coarse one
SERIAL_TEST(Bar, CosineDecays)
{
  for (const std::string &shape : first_of<std::string>(1, {"quadratic", "linear", "cubic"}))
    for (const std::string options : {"", "frame total"}) {
      double rms[3], coarse[3];
      for (int k = 0; k < 3; k++) {
        const int n = 10 << k;
        const auto error_of = [&](const std::string &body) {
          Scene run(plane("lj", "f p", strprintf("0 %d 0 4", n), 2, 0.1) + body +
                    strprintf("fix m all mpm/material density 1.0 eos linear 1e-6 thermal "
                              "conducting 1.0 0.0 %d\nfix heat all mpm/heat\n",
                              n * n));
          Warm warm(run);
          warm.set([n](const double *x) {
            return 1.0 + std::cos(PI * x[0] / n);
          });
          const double before = warm.heat();
          run_to(run, 0.1, 0.1 / (n * n));
          EXPECT_NEAR(warm.heat() / before, 1.0, 1e-13);
          return warm
              .error([n](const double *x) {
                return 1.0 + std::cos(PI * x[0] / n) * 0.372707839;
              })
              .rms;
        };
        rms[k] = measured(
            strprintf("%s %s, %d cells, finer in the middle", shape.c_str(), options.c_str(), n),
            error_of(lattices(2, shape, options,
                              {strprintf("block 0 %d 0 4 INF INF", n),
                               strprintf("block %d %d 0 4 INF INF", 3 * n / 10, 7 * n / 10)})));
        coarse[k] = measured("   the coarse lattice alone",
                             error_of("fix F all mpm 1.0 shape " + shape + " " + options +
                                      "\ncreate_points 1 box ppc 2\n"));
        EXPECT_LT(rms[k], 1.1 * coarse[k]);
      }
      EXPECT_GT(measured("order", std::log2(rms[1] / rms[2])), 1.8);
    }
}

// A body flies through faces with a hot spot at its rim: heat to round-off, no new extremes
SERIAL_TEST(Heat, IsKeptInABodyThatSpins)
{
  for (const std::string transfer : {"relax 1.0", "affine", "pic"}) {
    Scene run(plane("lj", "p p", "0 16 0 16", 3, 0.3) +
              lattices(2, "quadratic", "",
                       {"block 4 14 5 13 INF INF", "block 8 14 5 13 INF INF",
                        "block 10.5 14 6 12 INF INF"}) +
              "fix m all mpm/material density 1 neohookean 100 0.3 thermal conducting 1 1 0.2\n"
              "variable vx atom 2-0.3*(y-8)\nvariable vy atom 1+0.3*(x-8)\n"
              "velocity all set v_vx v_vy 0\nfix heat all mpm/heat transfer " +
              transfer + "\ntimestep 0.01\n");
    Warm warm(run);
    warm.set([](const double *x) {
      return 1.0 + std::exp(-0.3 * (std::pow(x[0] - 8.5, 2) + std::pow(x[1] - 9, 2)));
    });
    const double before = warm.heat();
    run.commands("run 600\n");
    EXPECT_NEAR(measured(transfer + ": heat", warm.heat() / before - 1.0), 0.0, 1e-13);
    double low = 2.0, high = 1.0;
    for (int i = 0; i < run.n(); i++) {
      low = std::min(low, warm.T(i));
      high = std::max(high, warm.T(i));
    }
    EXPECT_GT(measured("  lowest", low), 0.99);
    EXPECT_LT(measured("  highest", high), 1.7);
  }
}

// A hot spot next to the rim of the finer part, against the one fine lattice
SERIAL_TEST(Heat, SpreadsAcrossTheRim)
{
  const auto spot = [](Scene &run) {
    Warm warm(run);
    warm.set([](const double *x) {
      return std::exp(-(std::pow(x[0] - 12, 2) + std::pow(x[1] - 12, 2)) / 8.0);
    });
  };
  // spread in the infinite plane: 8/(8 + 4 t) exp(-r^2/(8 + 4 t))
  const auto exact = [](const double *x) {
    return 0.5 * std::exp(-(std::pow(x[0] - 12, 2) + std::pow(x[1] - 12, 2)) / 16.0);
  };
  const auto error_of = [&](const std::string &body) {
    Scene run(plane("lj", "p p", "0 24 0 24", 3, 0.2) + body + solid +
              "fix heat all mpm/heat\ntimestep 0.05\n");
    spot(run);
    run.commands("run 40\n");
    return Warm(run).error(exact);
  };
  const auto uniform = [](double h) {
    return strprintf("fix F all mpm %g\ncreate_points 1 box ppc 2\n", h);
  };
  const double coarse = measured("coarse", error_of(uniform(1.0)).most),
               fine = measured("fine", error_of(uniform(0.5)).most);
  const double two =
      measured("two lattices, rim through the spot",
               error_of(lattices(2, "quadratic", "",
                                 {"block 0 24 0 24 INF INF", "block 12 24 12 24 INF INF"}))
                   .most);
  const double around =
      measured("three lattices, spot inside",
               error_of(lattices(2, "quadratic", "",
                                 {"block 0 24 0 24 INF INF", "block 2 22 2 22 INF INF",
                                  "block 9 15 9 15 INF INF"}))
                   .most);
  EXPECT_LT(two, 1.1 * coarse);
  EXPECT_LT(around, 1.5 * fine);
}

// Heat through a face with coarse and fine cells: area times flux, or after the temperature outside
SERIAL_TEST(Faces, HaveAllOfTheirArea)
{
  for (const int dim : {2, 3})
    for (const std::string shape : {"linear", "quadratic", "cubic"})
      for (const double y : {0.0, 0.5}) {
        const std::string from = strprintf("%g", y);
        Scene run(
            box(dim, "lj", dim == 2 ? "f f f" : "f f p", strprintf("0 12 %g 8 0 6", y), 2, 0.2) +
            lattices(dim, shape, "",
                     {"block 0 12 " + from + " 8 INF INF",
                      "block 4 9 " + from + " 8 " + (dim == 3 ? "1 5" : "INF INF")}) +
            solid + "fix heat all mpm/heat ylo flux 2.0\ntimestep 0.02\nrun 10\n");
        const double exact = 2.0 * 12 * (dim == 3 ? 6 : 1);
        EXPECT_NEAR(measured(strprintf("%dd %s from %g: power", dim, shape.c_str(), y),
                             run.fix_vector("heat", 6)[2] / exact),
                    1.0, shape == "linear" ? 1e-12 : 4e-3);
      }
}

// A face of given temperature where points next to a part of it do not conduct, far from the finer
// lattice: in one step, the points there get the heat that they get on one lattice
SERIAL_TEST(Faces, WithPointsThatDoNotConduct)
{
  std::map<std::pair<int, int>, double> before;
  double most = 0.0, hottest = 0.0;
  for (const bool two : {false, true}) {
    Scene run(
        plane("lj", "f f", "0 14 0 6", 2, 0.2) +
        (two ? lattices(2, "quadratic", "", {"block 0 14 0 6 INF INF", "block 9 14 0 6 INF INF"})
             : "fix F all mpm 1.0\ncreate_points 1 box ppc 2\n") +
        "region dry block INF 0.6 2 4 INF INF\ngroup dry region dry\n"
        "group rest subtract all dry\nfix d dry mpm/material density 1 eos linear 1e-6\n" +
        replaced(solid, "fix m all", "fix m rest") +
        "fix heat all mpm/heat xlo temperature 1\ntimestep 0.02\nrun 1\n");
    Warm warm(run);
    for (int i = 0; i < run.n(); i++) {
      const double *const x = run.x()[i];
      if (!warm.has(i) || x[0] > 5.0) continue;
      double &other = before[{std::lround(4.0 * x[0]), std::lround(4.0 * x[1])}];
      if (two) grow(most, warm.T(i) - other);
      other = warm.T(i);
      grow(hottest, other);
    }
  }
  EXPECT_GT(hottest, 0.01);
  EXPECT_LT(measured("difference", most / hottest), 1e-11);
}

// A slab between convection and cold: the profile and the flow are those of the two in series
SERIAL_TEST(Faces, ConvectionInSeries)
{
  for (const std::string shape : {"linear", "quadratic"}) {
    Scene run(plane("lj", "f f", "0 12 0 8", 2, 0.2) +
              lattices(2, shape, "", {"block 0 12 0 8 INF INF", "block 5 12 0 8 INF INF"}) + solid +
              "fix heat all mpm/heat ylo convection 0.5 10 yhi temperature 1 stages 200\n"
              "timestep 5\nrun 200\n");
    // 0.5 (10 - Ts) = (Ts - 1)/8
    const double Ts = (0.5 * 10 + 0.125) / 0.625;
    const double most = Warm(run)
                            .error([Ts](const double *x) {
                              return Ts + (1.0 - Ts) * x[1] / 8.0;
                            })
                            .most;
    EXPECT_LT(measured(shape + ": greatest error", most), shape == "linear" ? 1e-9 : 2e-2);
    EXPECT_NEAR(measured("power", run.fix_vector("heat", 6)[2] / (12 * (Ts - 1) / 8)), 1.0,
                shape == "linear" ? 1e-9 : 1e-3);
  }
}

// A tube between two temperatures: 1 + log(r)/log(2), with a finer ring around the bore
SERIAL_TEST(Axisymmetric, Tube)
{
  double rms[2];
  for (int k = 0; k < 2; k++) {
    const int n = 10 << k;
    Scene run(plane("lj", "f p", strprintf("%d %d 0 4", n, 2 * n), 2, 0.1) +
              lattices(2, "quadratic", "axisymmetric yes",
                       {strprintf("block %d %d 0 4 INF INF", n, 2 * n),
                        strprintf("block %d %d 0 4 INF INF", n, 14 * n / 10)}) +
              solid +
              strprintf("fix heat all mpm/heat xlo temperature 1 xhi temperature 2 stages 200\n"
                        "timestep %g\nrun 60\n",
                        0.05 * n * n));
    rms[k] = measured(strprintf("%d cells", n),
                      Warm(run)
                          .error([n](const double *x) {
                            return 1.0 + std::log(x[0] / n) / std::log(2.0);
                          })
                          .rms);
    EXPECT_NEAR(measured("power", run.fix_vector("heat", 6)[1] / (2.0 * PI * 4.0 / std::log(2.0))),
                1.0, 2e-4);
  }
  EXPECT_LT(rms[1], 5e-6);
  EXPECT_LT(rms[1], 0.4 * rms[0]);
}

// Friction at a wall below coarse and fine cells: what it takes from the motion warms the body
PARAMETER_TEST(Friction, WarmsAllLattices, const char *, Values("", "every auto"))
{
  Scene run(plane("lj", "p f", "0 16 0 10", 2, 0.3) +
            lattices(2, "quadratic", "", {"block 0 16 0 6 INF INF", "block 4 10 0 6 INF INF"}) +
            "fix m all mpm/material density 1 linear 100 0.3 thermal conducting 1 0 0.2\n"
            "velocity all set 1 0 0\nfix g all gravity 1 vector 0 -1 0\n"
            "fix w all mpm/boundary ylo separate friction 0.3 heat yes\nfix heat all mpm/heat " +
            GetParam() +
            "\ncompute e all mpm/energy\nthermo_style custom step c_e\ntimestep 0.02\nrun 100\n");
  EXPECT_NEAR(measured("heat of points over what came",
                       Warm(run).heat() / run.fix("heat")->compute_scalar()),
              1.0, 1e-12);
  // mu N v t, less what slows down
  EXPECT_NEAR(measured("heat of friction", run.fix("heat")->compute_scalar() / 96.0), 0.42, 0.1);
  EXPECT_LT(std::fabs(measured("residual of the ledger", run.compute_vector()[10])), 1e-10);
}

TEST(Refine, HeatRanksAndRestart)
{
  for (const int dim : first_of(1, {2, 3})) {
    const std::string head = box(dim, "lj", "p f p", "0 14 0 12 0 9", 3, 0.3),
                      fields = nested(dim, 3, dim == 2 ? "linear" : "quadratic", ""),
                      fixes = "fix m all mpm/material density 1 neohookean 1 0.3 thermal "
                              "conducting 1 1 1\n"
                              "fix heat all mpm/heat ylo convection 2 5 yhi flux 1\n"
                              "fix w all mpm/boundary ylo slip\ntimestep 0.05\n",
                      start = "variable vx atom 0.5+0.05*y\nvariable vy atom 0.02*(x-6)\n"
                              "velocity all set v_vx v_vy 0\n";
    const auto gather = [](Scene &run) {
      std::vector<Named> mine;
      Warm warm(run);
      for (int i = 0; i < run.n(); i++) mine.push_back({(double) run.lmp->atom->tag[i], warm.T(i)});
      return all_by_tag(mine, run.lmp->world);
    };
    const auto differ = [&](Scene &a, Scene &b) {
      const auto one = gather(a), other = gather(b);
      EXPECT_EQ(one.size(), other.size());
      double most = 0.0, size = 0.0;
      for (std::size_t k = 0; k < one.size(); k++) {
        grow(most, one[k].T - other[k].T);
        grow(size, one[k].T);
      }
      return most / size;
    };
    OnRanks ranks(head + fields + fixes + start, "run 16\n");
    EXPECT_LT(measured("difference to one rank", differ(ranks.serial, ranks.parallel)), 1e-12);
    OnRanks even(head + fields + fixes + start, "run 16\n",
                 "comm_style tiled\nfix even all balance 4 1.0 rcb\n");
    EXPECT_LT(measured("balanced", differ(even.serial, even.parallel)), 1e-12);
    Continued restart(head + fields + fixes + start, 8,
                      "neighbor 0.3 bin\n" + without_points(fields) + fixes, 8);
    EXPECT_EQ(measured("restart", differ(restart.whole, restart.again)), 0.0);
  }
}

SERIAL_TEST(BadInput, IsRefused)
{
  const std::string head = plane("lj", "f f", "0 8 0 8", 2, 0.2) +
      "region l block 0 4 0 8 INF INF\nregion r block 4 8 0 8 INF INF\ngroup a type 1\n"
      "group b type 2\nfix a a mpm 1.0\nfix b b mpm 0.5 origin 0.25 0.25\n"
      "fix one all mpm/refine a b\ncreate_points 1 region l ppc 2 fix a\n"
      "create_points 2 region r ppc 2 fix b\ngroup a type 1\ngroup b type 2\n";
  expect_refused(
      head + solid,
      {{"fix h all mpm/heat time euler\nrun 0\n", "use time explicit"},
       {"fix h all mpm/heat transfer xpic 2\nrun 0\n", "use relax, affine, or pic"},
       {"fix h all mpm/heat surface flux 1\nrun 0\n", "use conditions on faces of the box"},
       {"fix h all mpm/heat region l flux 1\nrun 0\n", "use conditions on faces of the box"},
       {"fix w all mpm/boundary ylo separate friction 0.3 heat yes\nfix h all mpm/heat every "
        "4\nrun 0\n",
        "use every 1"}});
  // the skin of the body is one coarse cell deep
  const std::string skin = plane("lj", "f f", "0 8 0 8", 2, 0.2) +
      lattices(2, "quadratic", "", {"block 0 8 0 8 INF INF", "block 0 8 0 1 INF INF"}) + solid;
  EXPECT_EQ(times_said(skin + "fix h all mpm/heat ylo flux 1\nrun 2\n", "end within"), 1);
  EXPECT_EQ(times_said(skin + "fix h all mpm/heat yhi flux 1\nrun 2\n", "end within"), 0);
  // an interface of materials at the rim, and one a coarse cell away from it
  const auto layers = [](const char *fine, int axis = 0) {
    const auto block = [axis](const char *along, const char *across) {
      std::string text = "block";
      for (int d = 0; d < 3; d++) text += std::string(" ") + (d == axis ? along : across);
      return text;
    };
    const auto all = block("0 12", "0 4");
    return times_said(
        space("lj", "f f f", all.substr(6), 2, 0.2) +
            lattices(3, "quadratic", "", {all, block(fine, "0 4")}) + "region A " +
            block("0 6", "INF INF") + "\nregion B " + block("6 12", "INF INF") +
            "\n"
            "group A region A\ngroup B region B\n"
            "fix m A mpm/material density 1 eos linear 1e-6 thermal conducting 1 2 1\n"
            "fix n B mpm/material density 1 eos linear 1e-6 thermal conducting 1 2 10\n"
            "fix h all mpm/heat\nrun 0\n",
        "let one lattice go on");
  };
  for (const int axis : {0, 1, 2})
    for (const char *fine : {"0 6", "6 12"}) EXPECT_EQ(layers(fine, axis), 1) << fine << axis;
  EXPECT_EQ(layers("5 12"), 0);
}
