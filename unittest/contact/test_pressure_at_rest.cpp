// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi input restart
// mpi: 1 2
// timeout: 900

// Water at rest on bodies that deform: pressure of points and cells, in one field with the body and
// in two fields in contact; what contact and smooth volumes must do for that.

#include "mpm_lammps.h"

#include "field/mpm_smoothing.h"

using namespace MPM_TEST;

constexpr double GRAVITY = 9.81, DENSITY = 1000.0;

// A pool on a plate that is clamped at its ends, in plane strain; gravity is switched on slowly,
// within some four periods of the lowest bending mode, and the same time is left to come to rest.
struct Pool {
  static constexpr double L = 0.5, H = 0.5, T = 0.1;    // length; depth; thickness of the plate
  static constexpr double E = 1.0e7, NU = 0.3, PLATE_DENSITY = 2500.0;
  static constexpr double SPEED = 40.0;    // of sound in the water
  static constexpr double BOTTOM = 0.05;

  double h;
  Scene run;

  Pool(double h, int nfields, double smooth) : h(h)
  {
    const double top = BOTTOM + T, surface = top + H;
    const std::string water = strprintf(" transfer apic smooth %g", smooth),
                      half = "spacing " + strprintf("%.17g", h / 2);
    std::string fields, walls;
    if (nfields == 2) {
      fields = strprintf("fix W water mpm %.17g origin 0 0%s\nfix P plate mpm %.17g origin 0 0\n"
                         "fix touch all mpm/contact W P gap yes 0.9\n",
                         h, water.c_str(), h);
      walls = "fix sides all mpm/boundary xlo xhi slip field W\n"
              "fix clamp all mpm/boundary xlo xhi stick field P\n";
    } else {
      fields = strprintf("fix W all mpm %.17g origin 0 0%s\n", h, water.c_str());
      walls = strprintf("fix sides all mpm/boundary xlo xhi slip\n"
                        "region left block INF %.17g INF %.17g INF INF\n"
                        "region right block %.17g INF INF %.17g INF INF\n"
                        "fix clamp1 all mpm/boundary region left stick\n"
                        "fix clamp2 all mpm/boundary region right stick\n",
                        1e-3 * h, top, L - 1e-3 * h, top);
    }
    run.commands(
        plane("si", "f f", strprintf("0 %g %.17g %g", L, -2 * h, surface + 0.05), 2, 0.5 * h) +
        bodies({{"water", strprintf("block 0 %g %g %g INF INF", L, top, surface)},
                {"plate", strprintf("block 0 %g %g %g INF INF", L, BOTTOM, top)}},
               half) +
        fields +
        strprintf("fix mw water mpm/material density %g eos tait %g 7\n"
                  "fix mp plate mpm/material density %g neohookean %g %g\n",
                  DENSITY, DENSITY * SPEED * SPEED, PLATE_DENSITY, E, NU) +
        walls + gravity() + until());
  }

  /** Deflection of the plate under the same load, without water, on a lattice of its own. */
  static double deflection_alone(double h)
  {
    const double top = BOTTOM + T;
    Scene run(plane("si", "f f", strprintf("0 %g %.17g %g", L, -2 * h, top + 0.05), 1, 0.5 * h) +
              bodies({{"plate", strprintf("block 0 %g %g %g INF INF", L, BOTTOM, top)}},
                     "spacing " + strprintf("%.17g", h / 2)) +
              strprintf("fix P all mpm %.17g origin 0 0\n"
                        "fix clamp all mpm/boundary xlo xhi stick\n"
                        "fix mp all mpm/material density %g neohookean %g %g\n",
                        h, PLATE_DENSITY, E, NU) +
              gravity() +
              strprintf("variable p equal v_g*%g\n"
                        "region below block INF INF INF %g INF INF\n"
                        "fix load all mpm/traction region below pressure v_p\n",
                        DENSITY * H, top) +
              until());
    return deflection(run.gather(), h, 1);
  }

  /** Mean height that points of this type in the middle have lost. */
  static double deflection(const std::vector<Scene::State> &states, double h, int type)
  {
    double mid = 0.0;
    int n = 0;
    for (const auto &s : states)
      if (s.type == type && std::fabs(s.x[0] - L / 2) < 0.5 * h) {
        mid += s.x[1];
        n++;
      }
    return BOTTOM + T / 2 - mid / n;
  }

  static std::string gravity()
  {
    return strprintf("variable g equal %g*(1-cos(PI*time/0.5))/2*(time<0.5)+%g*(time>=0.5)\n"
                     "variable now equal time\nfix down all gravity v_g vector 0 -1 0\n",
                     GRAVITY, GRAVITY);
  }

  static std::string until()
  {
    return "fix step all mpm/dt 0.4\nfix end all halt 10 v_now > 1.0 error continue\n"
           "thermo 1000000\nrun 1000000\n";
  }

  /** Pressure in the depth z, from dp = rho(p) g dz with the law of Tait. */
  static double hydrostatic(double z)
  {
    const double K = DENSITY * SPEED * SPEED;
    return K / 7 * (std::pow(1 + 6 * DENSITY * GRAVITY * z / K, 7.0 / 6) - 1);
  }

  struct Errors {
    double points, cells, low_points, low_cells;    // of the worst row; of the lowest one
    double deflection;                              // of the plate, over that of a plate alone, - 1
  };

  /** Root mean squares over rows by the pressure there, from two cells below the surface. */
  Errors errors()
  {
    const auto states = run.gather();
    const int nrow = (int) std::lround(2 * H / h), ncolumn = (int) std::lround(2 * L / h);
    double surface = 0.0;
    std::vector<const Scene::State *> water;
    for (const auto &s : states)
      if (s.type == 1) water.push_back(&s);
    EXPECT_EQ((int) water.size(), nrow * ncolumn);
    // points are created row by row, as their tags tell
    const auto row_of = [&](const Scene::State *s) {
      return ((int) s->tag - 1) / ncolumn;
    };
    for (const auto *s : water)
      if (row_of(s) == nrow - 1) surface += (s->x[1] + h / 4) / ncolumn;

    std::vector<double> squares(nrow, 0.0);
    struct Cell {
      double volume = 0.0, p = 0.0, y = 0.0;
    };
    std::map<std::pair<int, int>, Cell> cells;
    for (const auto *s : water) {
      const double exact = hydrostatic(surface - s->x[1]);
      squares[row_of(s)] += std::pow(s->pressure() / exact - 1, 2) / ncolumn;
      Cell &cell = cells[{(int) std::floor(s->x[1] / h), (int) std::floor(s->x[0] / h)}];
      cell.volume += s->vol;
      cell.p += s->vol * s->pressure();
      cell.y += s->vol * s->x[1];
    }
    Errors e = {0, 0, std::sqrt(squares[0]), 0, 0};
    for (int row = 0; row < nrow - 4; row++) e.points = std::max(e.points, std::sqrt(squares[row]));

    std::map<int, std::pair<double, int>> rows;    // sum of squares, number
    for (const auto &[place, cell] : cells) {
      const double z = surface - cell.y / cell.volume;
      if (z < 2 * h) continue;
      rows[place.first].first += std::pow(cell.p / cell.volume / hydrostatic(z) - 1, 2);
      rows[place.first].second++;
    }
    for (const auto &[row, sum] : rows) {
      const double rms = std::sqrt(sum.first / sum.second);
      if (row == rows.begin()->first) e.low_cells = rms;
      e.cells = std::max(e.cells, rms);
    }

    e.deflection = deflection(states, h, 2) / deflection_alone(0.025) - 1;
    return e;
  }
};

struct Coupling {
  int nfields;
  double h, smooth;
};

// The issue is the lowest rows. The pressure was 120 % (two fields) and 34 % off there, whatever
// the spacing. The bounds are those that are wanted, not what comes out

SERIAL_PARAMETER_TEST(WaterOnPlate, PressureIsThatOfItsDepth, Coupling,
                      Values(Coupling{2, 1.0 / 40, 0.4}, Coupling{2, 1.0 / 40, 0.9},
                             Coupling{2, 1.0 / 50, 0.4}, Coupling{1, 1.0 / 40, 0.4},
                             Coupling{1, 1.0 / 50, 0.9}, Coupling{2, 1.0 / 80, 0.4},
                             Coupling{1, 1.0 / 80, 0.4}))
{
  LONG_AFTER(1);
  const auto [nfields, h, smooth] = GetParam();
  Pool pool(h, nfields, smooth);
  const auto e = pool.errors();
  EXPECT_LT(measured("points, worst row", e.points), 0.05);
  EXPECT_LT(measured("points, lowest row", e.low_points), 0.05);
  EXPECT_LT(measured("cells, worst row", e.cells), 0.02);
  EXPECT_LT(measured("cells, lowest row", e.low_cells), 0.02);
  EXPECT_LT(std::fabs(measured("deflection", e.deflection)), 0.015);
}

// That plate is a beam, but for the sections at the clamps, which do not stay plane in such a thick
// one

SERIAL_TEST(WaterOnPlate, PlateAloneIsABeam)
{
  const double load = GRAVITY * (DENSITY * Pool::H + Pool::PLATE_DENSITY * Pool::T),
               bending = load * std::pow(Pool::L, 4) * 12 * (1 - Pool::NU * Pool::NU) /
      (384 * Pool::E * std::pow(Pool::T, 3)),
               shear = load * Pool::L * Pool::L /
      (8 * (5.0 / 6) * Pool::E / (2 * (1 + Pool::NU)) * Pool::T);
  EXPECT_NEAR(measured("deflection", Pool::deflection_alone(0.025) / (bending + shear)), 1.0, 0.03);
}

// Without smooth volumes, pressures on bodies are wrong by a quarter: who models both is told

SERIAL_TEST(WaterOnPlate, RoughPressuresAreTold)
{
  const auto told = [](const char *smooth, const char *layer) {
    return times_said(plane("si", "p f", "0 0.1 -0.05 0.3", 2, 0.0125) +
                          bodies({{"water", "block INF INF 0.1 0.2 INF INF"},
                                  {"layer", "block INF INF 0 0.1 INF INF"}},
                                 "spacing 0.0125") +
                          strprintf("fix W water mpm 0.025 %s\nfix L layer mpm 0.025\n"
                                    "fix touch all mpm/contact W L\n"
                                    "fix mw water mpm/material density 1000 eos tait 4.0e5 7\n"
                                    "fix ml layer mpm/material density 2000 %s\n"
                                    "timestep 1.0e-4\nrun 1\nrun 1\n",
                                    smooth, layer),
                      "WARNING: Fix mpm W: pressures of the liquid");
  };
  EXPECT_EQ(told("", "neohookean 1.0e7 0.3"), 1);
  EXPECT_EQ(told("smooth 0.4", "neohookean 1.0e7 0.3"), 0);
  EXPECT_EQ(told("", "eos tait 8.0e5 7"), 0);
}

// A floor whose points reach a row of nodes above it moves these, too, so that the water there
// cannot be compressed. The lowest rows then have 6 % too little of the pressure with smooth
// volumes, if their wrong strain counts in these

struct Joint {
  int nfields;
  double origin;    // of the lattice, in node spacings
};

SERIAL_PARAMETER_TEST(WaterOnStiffFloor, PressureIsThatOfItsDepth, Joint,
                      Values(Joint{2, 0.0}, Joint{2, 0.5}, Joint{1, 0.0}))
{
  const auto [nfields, origin] = GetParam();
  const double h = 0.025, H = 1.0, c = 20.0, K = DENSITY * c * c, floor = 0.1;
  const std::string lattice = strprintf(" mpm %g origin 0 %g", h, origin * h);
  const int ncolumn = 4;
  Scene run(plane("si", "p f", strprintf("0 %g -0.05 %g", 0.5 * ncolumn * h, floor + H + 0.05), 2,
                  0.5 * h) +
            bodies({{"water", strprintf("block INF INF %g %g INF INF", floor, floor + H)},
                    {"layer", strprintf("block INF INF 0 %g INF INF", floor)}},
                   strprintf("spacing %g", 0.5 * h)) +
            (nfields == 2 ? "fix W water" + lattice + " smooth 0.4\nfix L layer" + lattice +
                     "\nfix touch all mpm/contact W L gap yes 0.9\n"
                          : "fix W all" + lattice + " smooth 0.4\n") +
            strprintf("region base block INF INF INF %g INF INF\n"
                      "fix base all mpm/boundary region base stick field %s\n"
                      "fix mw water mpm/material density %g eos tait %g 7\n"
                      "fix ml layer mpm/material density 2500 neohookean 1.0e8 0.3\n",
                      1e-3 * h, nfields == 2 ? "L" : "W", DENSITY, K) +
            strprintf("variable g equal %g*(1-cos(PI*time/0.5))/2*(time<0.5)+%g*(time>=0.5)\n"
                      "variable now equal time\nfix down all gravity v_g vector 0 -1 0\n"
                      "fix step all mpm/dt 0.4\nfix end all halt 10 v_now > 1.0 error continue\n"
                      "thermo 1000000\nrun 1000000\n",
                      GRAVITY, GRAVITY));
  const int nrow = (int) std::lround(2 * H / h);
  std::vector<double> p(nrow, 0.0), y(nrow, 0.0);
  for (const auto &s : run.gather()) {
    if (s.type != 1) continue;
    const int row = ((int) s.tag - 1) / ncolumn;
    p[row] += s.pressure() / ncolumn;
    y[row] += s.x[1] / ncolumn;
  }
  const double surface = y.back() + h / 4;
  for (int row = 0; row < 6; row++) {
    const double z = surface - y[row],
                 exact = K / 7 * (std::pow(1 + 6 * DENSITY * GRAVITY * z / K, 7.0 / 6) - 1);
    EXPECT_NEAR(measured(strprintf("row %d", row).c_str(), p[row] / exact), 1.0, 0.02);
  }
}

/** Two blocks on each other, in a box with these commands for its walls. */
static std::string stack(double h, double interface, const std::string &walls)
{
  return plane("si", "f f", "0 0.2 0 0.3", 2, 0.5 * h) +
      bodies({{"upper", strprintf("block 0 0.2 %.17g %.17g INF INF", interface, interface + 0.1)},
              {"lower", strprintf("block 0 0.2 0 %.17g INF INF", interface)}},
             "spacing " + strprintf("%.17g", h / 2)) +
      strprintf("fix A upper mpm %g\nfix B lower mpm %g\n"
                "fix m1 upper mpm/material density 1000 neohookean 1.0e6 0.3\n"
                "fix m2 lower mpm/material density 2000 neohookean 0.5e6 0.3\n"
                "fix touch all mpm/contact A B gap no\n"
                "fix down all gravity 9.81 vector 0 -1 0\nfix step all mpm/dt 0.4\n",
                h, h) +
      walls + "thermo 1000000\n";
}

// Blocks that fill the width between slippery walls move up and down only. Normals that were
// inclined towards the walls, as a body ends there, made them move along the interface

SERIAL_TEST(ContactAtWalls, NormalsAreNotInclined)
{
  for (const double interface : {0.1, 0.09}) {
    Scene run(
        stack(0.02, interface,
              "fix sides all mpm/boundary xlo xhi slip\nfix floor all mpm/boundary ylo slip\n"));
    std::vector<double> x;
    for (const auto &s : run.gather()) x.push_back(s.x[0]);
    run.commands("run 1000\n");
    double most = 0.0;
    const auto states = run.gather();
    for (std::size_t i = 0; i < states.size(); i++)
      most = std::max(most, std::fabs(states[i].x[0] - x[i]));
    EXPECT_LT(measured("motion along the interface", most), 1e-10 * 0.2);
  }
}

// The upper block slips along the sides, the lower one is clamped there. Where the upper one
// arrives, both have one velocity along the normal after contact and walls, whatever the masses.
// Contact at a node moves the lower one at the images of the node, too: when each node was solved
// on its own, water went down into the clamp of a plate for good

SERIAL_PARAMETER_TEST(ContactAtWalls, BodiesMoveTogetherAfterBoth, int, Values(2, 3))
{
  const int dim = GetParam();
  const double speed = 0.1;
  const auto block = [&](double low) {
    return "block 0 6 " + std::string(dim == 3 ? "0 4 " : "") + strprintf("%g %g", low, low + 3) +
        (dim == 3 ? "" : " INF INF");
  };
  double most = 0.0;
  for (const double interface : {4.0, 4.3})
    for (const double density :
         {0.001, 0.1, 0.5, 10.0}) {    // iterations are slow where it is light
      Scene run(
          box(dim, "lj", "f f f", dim == 3 ? "0 6 0 4 0 10" : "0 6 0 10 -0.5 0.5", 2, 0.5) +
          bodies({{"upper", block(interface)}, {"lower", block(interface - 3)}}, "spacing 0.5") +
          "fix A upper mpm 1.0\nfix B lower mpm 1.0\n"
          "fix m1 upper mpm/material density 1 eos tait 100 7\n" +
          strprintf("fix m2 lower mpm/material density %g neohookean %g 0.3\n", density,
                    100 * std::min(1.0, density)) +
          "fix touch all mpm/contact A B gap no\n"
          "fix sides all mpm/boundary xlo xhi slip field A\n"
          "fix clamp all mpm/boundary xlo xhi stick field B\n" +
          (dim == 3 ? "fix front all mpm/boundary ylo yhi slip\n" : "") +
          strprintf("velocity upper set 0 %s\n", dim == 3 ? "0 -0.1" : "-0.1 0") +
          "timestep 0.01\nrun 1 post no\n");
      int n = 0;
      const auto look = [&](const Scene::Node &node) {
        const double *const other = run.node(node.index, "B");
        if (node.mass == 0.0 || !other) return;
        most = std::max(most, std::fabs(node.v[dim - 1] - other[dim - 1]));
        n++;
      };
      run.each_node(look, "A");
      EXPECT_GT(n, 10);
    }
  EXPECT_LT(measured("relative velocity, of that before", most / speed), 1e-10);
}

// A body that is held does not yield. The block on it sags by its weight, by rho g H^2/2 over the
// modulus of confined compression; its lowest points, h/4 above the face, by rho g H/M times that.
// It fell through when half of what contact took away was given to the body that is held

SERIAL_PARAMETER_TEST(BodyThatIsHeld, DoesNotYield, double, Values(0.0, 0.02))
{
  const double speed = GetParam();    // of the wall, and of all, upward
  const double h = 0.02, H = 0.1, M = 1.0e6 * (1 - 0.3) / ((1 + 0.3) * (1 - 2 * 0.3));
  Scene run(
      stack(h, 0.1,
            "fix sides all mpm/boundary xlo xhi slip\nregion held block INF INF INF 0.2 INF INF\n" +
                strprintf("fix hold all mpm/boundary region held stick velocity 0 %g 0 field B\n"
                          "velocity all set 0 %g 0\n",
                          speed, speed)));
  std::vector<double> y;
  for (const auto &s : run.gather()) y.push_back(s.x[1]);
  run.commands("run 3000\n");
  double lowest = 0.0, lift = 0.0;
  const auto states = run.gather();
  for (std::size_t i = 0; i < states.size(); i++)    // the held body moves as a whole
    if (states[i].type == 2) lift = states[i].x[1] - y[i];
  for (std::size_t i = 0; i < states.size(); i++) {
    if (states[i].type != 1 || y[i] > 0.1 + 0.5 * h) continue;
    lowest = std::max(lowest, y[i] + lift - states[i].x[1]);
  }
  // it vibrates: twice of that at rest
  const double sag = DENSITY * GRAVITY * H / M * h;
  EXPECT_LT(measured("lowest points sink", lowest), 2 * sag);
  // the wall bears both: it takes what contact gives to the body that is held
  const double weight = GRAVITY * (1000 + 2000) * 0.1 * 0.2;
  run.commands("fix mean all ave/time 1 1000 1000 f_hold[2]\nrun 2000\n");
  EXPECT_NEAR(run.evaluate("f_mean") / weight, -1.0, 4e-5);
}

// Water on a bed that is held by the floor and gets thinner than a cell, to nothing. Next to the
// floor the normal of the interface is nearly that of the floor, along which neither body yields:
// contact outside of the mirror made up for it along the floor, the bed took it as a push from the
// other side, and so on; 6e5 times the energy in play went round in contact and wall

SERIAL_TEST(ContactAtWalls, ThinEndsOnTheFloorGainNothing)
{
  const double depth = 0.1, c = 10;
  Scene run(
      plane("si", "f f", "0 0.24 0 0.2", 2, 0.01) +
      "region above plane 0.04 0 0 -0.05 1 0\nregion below plane 0.04 0 0 0.05 -1 0\n"
      "region tank block 0 0.24 0 0.1 INF INF\n"
      "region wet intersect 2 tank above\nregion dry intersect 2 tank below\n"
      "create_points 1 region wet spacing 0.01\ncreate_points 2 region dry spacing 0.01\n"
      "group water type 1\ngroup bed type 2\n"
      "fix W water mpm 0.02 transfer apic smooth 0.4\nfix B bed mpm 0.02 transfer flip 1.0\n" +
      strprintf("fix m1 water mpm/material density %g eos tait %g 7\n", DENSITY, DENSITY * c * c) +
      "fix m2 bed mpm/material density 2500 neohookean 1.0e5 0.3\n"
      "fix touch all mpm/contact W B gap yes 0.9\n"
      "fix walls all mpm/boundary xlo xhi ylo slip field W\n"
      "fix hold all mpm/boundary ylo xhi stick field B\n"
      "fix down all gravity 9.81 vector 0 -1 0\nfix step all mpm/dt 0.4\n"
      "thermo 1000000\n");
  double fastest = 0.0, most = 0.0;
  for (int k = 0; k < 20; k++) {
    run.commands("run 25 post no\n");
    most = 0.0;
    for (const auto &s : run.gather()) {
      if (s.type != 1) continue;
      fastest = std::max(fastest, std::hypot(s.v[0], s.v[1]));
      most = std::max(most, std::fabs(s.F[0] * s.F[4] - s.F[1] * s.F[3] - 1));
    }
  }
  // gravity comes at once: the waves have twice the pressure at rest, and g depth/c
  EXPECT_LT(measured("fastest", fastest), GRAVITY * depth / c);
  EXPECT_LT(measured("change of volume at the end", most), 2 * GRAVITY * depth / (c * c));
}

/** A drop of a fluid at rest, with points anywhere. */
static std::string drop(int dim, const std::string &options = "smooth 1.0")
{
  return box(dim, "si", "f f f", "0 8 0 8 0 8", 1, 0.5) +
      strprintf("fix grid all mpm 1.0 dtcheck no %s\n", options.c_str()) +
      (dim == 3 ? "region ball sphere 4 4.2 3.9 2.3\n" : "region ball sphere 4 4.2 0 2.3\n") +
      "create_points 1 region ball ppc 2\ndisplace_atoms all random 0.1 0.1 " +
      (dim == 3 ? "0.1" : "0") +
      " 4711\n"
      "fix m all mpm/material density 1.0 eos tait 1.0e2 7\n"
      "timestep 0.25\nthermo 1000000\nrun 1 post no\n";
}

/** What smoothing must keep, and what it may only take. */
struct Sums {
  double volume = 0.0, moment[3] = {0.0, 0.0, 0.0}, square = 0.0;

  explicit Sums(LAMMPS *lmp)
  {
    const auto *points = MPMPoints::get(lmp->atom);
    std::vector<double> all(5, 0.0);
    for (int i = 0; i < lmp->atom->nlocal; i++) {
      const double V = lmp->atom->vfrac[i], q = points->jacobian(i) - 1;
      all[0] += V * q;
      for (int d = 0; d < 3; d++) all[1 + d] += V * q * lmp->atom->x[i][d];
      all[4] += V * q * q;
    }
    all = over_ranks(all);
    volume = all[0];
    std::copy_n(&all[1], 3, moment);
    square = all[4];
  }
};

static double pressure_of_drop(double J)
{
  return 1.0e2 / 7 * (std::pow(J, -7) - 1);
}

static void set_volumes(LAMMPS *lmp, int dim,
                        const std::function<double(const double *, tagint)> &q)
{
  auto *points = MPMPoints::get(lmp->atom);
  for (int i = 0; i < lmp->atom->nlocal; i++) {
    const double J = 1 + q(lmp->atom->x[i], lmp->atom->tag[i]);
    for (int c = 0; c < (dim == 3 ? 9 : 8); c += 4)
      points->F[i][c] = dim == 3 ? std::cbrt(J) : std::sqrt(J);
    for (int c = 0; c < 3; c++) points->tau[i][c] = -J * pressure_of_drop(J);
  }
}

/** Smooths the volumes that a function gives. */
static void smooth_volumes(Scene &run, int dim,
                           const std::function<double(const double *, tagint)> &q)
{
  set_volumes(run.lmp, dim, q);
  MPMField::find(run.lmp, "grid")->smoothing->smooth();
}

/** Noise of this size. */
static std::function<double(const double *, tagint)> noise(double size = 0.05)
{
  return [=](const double *, tagint tag) {
    return size * std::sin(12.9898 * tag);
  };
}

/** Volumes of all points by their tags. */
static std::map<tagint, double> volumes(Scene &run)
{
  std::map<tagint, double> J;
  for (const auto &s : run.gather()) J[(tagint) s.tag] = s.F[0] * s.F[4] * s.F[8];
  return J;
}

PARAMETER_TEST(SmoothVolumes, KeepLinearFieldsVolumeAndItsMoment, int, Values(2, 3))
{
  const int dim = GetParam();
  Scene run(drop(dim));

  // linear in space: nothing changes, also at the surface of the drop
  const auto linear = [](const double *x, tagint) {
    return 0.02 + 0.01 * x[0] - 0.013 * x[1] + 0.007 * x[2];
  };
  smooth_volumes(run, dim, linear);
  auto *points = MPMPoints::get(run.lmp->atom);
  for (int i = 0; i < run.lmp->atom->nlocal; i++)
    EXPECT_NEAR(points->jacobian(i) - 1, linear(run.lmp->atom->x[i], 0), 1e-13);

  // noise: what is conserved stays, the rest becomes less
  set_volumes(run.lmp, dim, noise());
  const Sums before(run.lmp);
  MPMField::find(run.lmp, "grid")->smoothing->smooth();
  const Sums after(run.lmp);
  const double size = std::sqrt(before.square * run.lmp->atom->natoms);
  EXPECT_NEAR(after.volume, before.volume, 1e-13 * size);
  for (int d = 0; d < dim; d++) EXPECT_NEAR(after.moment[d], before.moment[d], 1e-12 * size);
  // a share 1 leaves S q: with 2^dim points in a cell and one fit of dim + 1 numbers for each node,
  // noise cannot keep as much as a half
  EXPECT_LT(measured("squares left", after.square / before.square), 0.5);

  // pressure belongs to the new volumes
  for (const auto &s : run.gather()) {
    const double J = s.F[0] * s.F[4] * s.F[8];
    EXPECT_NEAR(s.pressure(), pressure_of_drop(J), 1e-11);
  }
}

// What viscosities add to the stress is not touched
TEST(SmoothVolumes, KeepViscousStress)
{
  for (const int dim : {2, 3}) {
    Scene run(replaced(drop(dim), "eos tait 1.0e2 7", "eos tait 1.0e2 7 viscosity newtonian 0.1"));
    set_volumes(run.lmp, dim, noise());
    auto *points = MPMPoints::get(run.lmp->atom);
    const double viscous[6] = {0.5, -0.2, 0.1, 0.3, 0.0, 0.0};
    for (int i = 0; i < run.lmp->atom->nlocal; i++)
      for (int c = 0; c < 6; c++) points->tau[i][c] += viscous[c];
    MPMField::find(run.lmp, "grid")->smoothing->smooth();
    for (int i = 0; i < run.lmp->atom->nlocal; i++) {
      const double J = points->jacobian(i);
      for (int c = 0; c < 6; c++)
        EXPECT_NEAR(points->tau[i][c] + (c < 3 ? J * pressure_of_drop(J) : 0.0), viscous[c], 1e-11);
    }
  }
}

// Fast sums and plain ones

PARAMETER_TEST(FastSmoothVolumes, AreThoseOfPlainLoops, int, Values(2, 3))
{
  const int dim = GetParam();
  for (const char *const shape : {"linear", "quadratic", "cubic"}) {
    std::map<tagint, double> J[2];
    for (const bool plain : {false, true}) {
      Scene run(
          drop(dim, strprintf("smooth 1.0 shape %s%s", shape, plain ? " kernels reference" : "")));
      smooth_volumes(run, dim, noise());
      J[plain] = volumes(run);
    }
    double most = 0.0;
    for (const auto &[tag, ratio] : J[0]) most = std::max(most, std::fabs(ratio - J[1][tag]));
    EXPECT_LT(measured(shape, most), 1e-13);
  }
}

// The share is that of the time in which sound crosses a cell, here .1: two end in the step from 0
// to .25. A share 1 takes all that nodes do not see, another share that part of it
PARAMETER_TEST(SmoothShare, IsThatOfEachCrossing, int, Values(2, 3))
{
  const int dim = GetParam();
  const auto changes = [&](double share) {
    Scene run(drop(dim, strprintf("smooth %g", share)));
    smooth_volumes(run, dim, noise(0.01));
    auto found = volumes(run);
    for (auto &[tag, change] : found) change -= 1 + noise(0.01)(nullptr, tag);
    return found;
  };
  const auto whole = changes(1.0);
  // twice in the two crossings of a step; up to a half once, with twice the share
  for (const auto &[share, expected] : {std::pair{0.7, 1 - 0.3 * 0.3}, {0.3, 2 * 0.3}}) {
    auto found = changes(share);
    EXPECT_EQ(found.size(), whole.size());
    for (const auto &[tag, change] : whole) EXPECT_NEAR(found[tag], expected * change, 1e-12);
  }
}

// Points that have moved in a step by more than the skin are not where the map of nodes knows them
TEST(SmoothVolumes, OfFastPointsHaveAllNodes)
{
  for (const int dim : {2, 3}) {
    std::map<tagint, double> J[2];
    for (const bool wide : {false, true}) {
      Scene run(drop(dim) + "neighbor " + (wide ? "2.0" : "0.001") +
                " bin\nvelocity all set 3 2 0\n");
      set_volumes(run.lmp, dim, noise(1.0e-6));    // next to no forces
      run.commands("run 2 post no\n");
      J[wide] = volumes(run);
    }
    for (const auto &[tag, ratio] : J[0]) EXPECT_NEAR(ratio, J[1][tag], 1e-14);
  }
}

static const std::string tank = plane("si", "f f", "0 1 0 1", 1, 0.02) +
    body("block 0 0.4 0 0.5 INF INF", "density 1000 eos tait 4.0e5 7 viscosity newtonian 1.0e-3",
         "0.05 smooth 0.4") +
    R"(timestep 5.0e-4
thermo 1000000
fix down all gravity 9.81 vector 0.3 -1 0
fix walls all mpm/boundary xlo xhi ylo slip
)";

TEST(SmoothVolumes, AreThoseOfOneRankAndOfARestart)
{
  Twins(tank, 201, lines_again(tank, {"thermo"}), 200, 1e-8);
}

static const std::string pool_on_block = plane("si", "f f", "0 1 0 1", 2, 0.02) +
    bodies({{"water", "block 0 1 0.2 0.55 INF INF"}, {"block", "block 0 1 0 0.2 INF INF"}},
           "spacing 0.025") +
    R"(fix W water mpm 0.05 smooth 0.4
fix B block mpm 0.05
fix mw water mpm/material density 1000 eos tait 4.0e5 7 viscosity newtonian 1.0e-3
fix mb block mpm/material density 2000 neohookean 1.0e6 0.3
fix touch all mpm/contact W B gap yes 0.9
timestep 4.0e-4
thermo 1000000
fix down all gravity 9.81 vector 0.3 -1 0
fix walls all mpm/boundary xlo xhi ylo slip
)";

TEST(SmoothVolumes, OnABodyAreThoseOfOneRankAndOfARestart)
{
  Twins(pool_on_block, 201, lines_again(pool_on_block, {"thermo"}), 200, 1e-8);
}

// A standing sound wave of 16 cells: the energy in volumes falls by less than (k h)^4 per crossing

SERIAL_TEST(SmoothVolumes, LeaveSoundAlone)
{
  double energy[2];
  for (const bool smooth : {false, true}) {
    Scene run(plane("si", "p p", "0 16 0 1", 1, 0.5) + "fix grid all mpm 1.0 transfer flip 1.0" +
              (smooth ? " smooth 0.4" : "") +
              "\ncreate_points 1 region box ppc 2\n"
              "fix m all mpm/material density 1 eos tait 1.0 1\n"
              "compute e all mpm/energy\nthermo_style custom step c_e\n"
              "variable v atom 1e-3*sin(2*PI*x/16)\nvelocity all set v_v 0 NULL\n"
              "compute k all ke\ntimestep 0.1\nthermo_style custom step c_e c_k\nthermo "
              "1000000\nrun 640\n");
    energy[smooth] = run.evaluate("c_k");
  }
  // four periods: 64 crossings, in which the share (2 pi/16)^4 = 0.024 times 0.4/2 of the energy of
  // the volumes, which is half of all, may go: less than 0.27 in all
  EXPECT_LT(measured("energy lost", 1 - energy[1] / energy[0]), 0.05);
}

// Sloshing: the first mode of water in a tank, of small amplitude. In a fluid with a constant speed
// c of sound, velocity is grad phi, with phi = Z(y) cos(k x) exp(i w t):
//
//   Z'' - g/c^2 Z' - (k^2 - w^2/c^2) Z = 0,   Z' = 0 at the floor,   g Z' = w^2 Z at the surface
//
// which for large c is w^2 = g k tanh(k d)

static double frequency_of_sloshing(double L, double depth, double c)
{
  const double k = M_PI / L, b = GRAVITY / (2 * c * c);
  const double d = c * c / GRAVITY * std::log(1 + GRAVITY * depth / (c * c));    // under its weight
  double square = GRAVITY * k * std::tanh(k * d);
  for (int it = 0; it < 100; it++) {
    const double m = std::sqrt(k * k - square / (c * c) + b * b), sh = std::sinh(m * d),
                 ch = std::cosh(m * d);
    square = GRAVITY * (b + m * (sh - b / m * ch) / (ch - b / m * sh));
  }
  return std::sqrt(square);
}

struct Sloshed {
  double period;    // relative to that of the theory
  double loss;      // of amplitude in a period
};

/** n: cells along the tank of 1 m with 0.5 m of water. */
static Sloshed slosh(double smooth, int n, double c)
{
  const double L = 1.0, depth = 0.5, h = L / n, dt = 0.4 * h / c, k = M_PI / L, amplitude = 0.01;
  const double w = frequency_of_sloshing(L, depth, c);
  Scene run(
      plane("si", "f f", "0 1 0 0.8", 1, 0.5 * h) +
      strprintf("fix W all mpm %.17g origin 0 0 transfer apic%s\n", h,
                smooth > 0 ? strprintf(" smooth %g", smooth).c_str() : "") +
      strprintf("region water block 0 %g 0 %g INF INF\ncreate_points 1 region water spacing "
                "%.17g\n",
                L, depth, h / 2) +
      strprintf("fix m all mpm/material density %g eos linear %g\n", DENSITY, DENSITY * c * c) +
      strprintf("variable g equal %g*(1-cos(PI*time))/2*(time<1)+%g*(time>=1)\n", GRAVITY,
                GRAVITY) +
      "fix down all gravity v_g vector 0 -1 0\n"
      "fix walls all mpm/boundary xlo xhi ylo slip\n" +
      strprintf("timestep %.17g\nthermo 1000000\nrun %d\n", dt, (int) std::ceil(1 / dt)));
  auto *atom = run.lmp->atom;
  for (int i = 0; i < atom->nlocal; i++) {
    const double x = atom->x[i][0], y = atom->x[i][1], v = amplitude * w / std::sinh(k * depth);
    atom->v[i][0] += v * std::sin(k * x) * std::cosh(k * y);
    atom->v[i][1] -= v * std::cos(k * x) * std::sinh(k * y);
  }

  // mean velocity and displacement along the tank, some forty times in a period
  const int stride = (int) std::ceil(2 * M_PI / w / 40 / dt);
  const double tau = stride * dt;
  std::vector<double> zero;    // times of upward crossings of the velocity
  double last = 0.0, first_size = 0.0, size = 0.0;
  for (int s = 0; s * tau < 3.4 * 2 * M_PI / w; s++) {
    if (s) run.commands("run " + std::to_string(stride) + " post no\n");
    double v = 0.0, x = 0.0;
    for (int i = 0; i < atom->nlocal; i++) {
      v += atom->v[i][0] / atom->nlocal;
      x += (atom->x[i][0] - L / 2) / atom->nlocal;
    }
    if (s && last < 0 && v >= 0) {
      zero.push_back((s - v / (v - last)) * tau);
      size = std::hypot(v, w * x);
      if (zero.size() == 1) first_size = size;
    }
    last = v;
  }
  const double nperiod = (double) zero.size() - 1;
  EXPECT_GE(nperiod, 2);
  if (nperiod < 1) return {NAN, NAN};
  return {(zero.back() - zero.front()) / nperiod * w / (2 * M_PI),
          1 - std::pow(size / first_size, 1 / nperiod)};
}

struct Tank {
  int n;
  double c, smooth;
};

// The period is that of the theory but for terms of the second order in k h, and smooth volumes
// take less of the amplitude. In the first case the period is 4.7 % too short without them
SERIAL_PARAMETER_TEST(Sloshing, HasThePeriodOfLinearTheory, Tank,
                      Values(Tank{20, 40, 0.4}, Tank{40, 10, 0.9}))
{
  LONG_AFTER(1);
  const auto [n, c, smooth] = GetParam();
  const double second = std::pow(M_PI / n, 2);
  const auto without = slosh(0.0, n, c), with = slosh(smooth, n, c);
  measured("period without", without.period - 1);
  EXPECT_LT(std::fabs(measured("period", with.period - 1)), second);
  EXPECT_LT(measured("loss in a period more than without", with.loss - without.loss), second);
}

SERIAL_TEST(SmoothVolumes, BadInput)
{
  const auto refused = [](const std::string &options, const std::string &material) {
    Scene run;
    return run.error(plane("si", "f f", "0 4 0 4") + "fix grid all mpm 1.0 " + options +
                     "\ncreate_points 1 region box ppc 2\nfix m all mpm/material density 1 " +
                     material + "\ntimestep 0.01\nrun 1\n");
  };
  EXPECT_THAT(refused("smooth 0.4", "linear 1.0 0.3"),
              HasSubstr("smooth is for fluids whose pressure"));
  EXPECT_THAT(refused("smooth 1.4", "eos tait 1.0 7"), HasSubstr("smooth"));
  EXPECT_THAT(refused("smooth 0.4 frame total", "eos tait 1.0 7"), HasSubstr("frame total is not"));
  EXPECT_THAT(refused("smooth 0.4 transfer flip 1.0 edges modified", "eos tait 1.0 7"),
              HasSubstr("edges plain"));
}
