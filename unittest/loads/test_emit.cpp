// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input ranks
// mpi: 1 4

// Fix mpm/emit and mpm/absorb: inflow and outflow of material points.

#include "mpm_lammps.h"

using namespace MPM_TEST;

constexpr double U = 2.0, B = 0.1, RHO = 1000.0;

/** A plug of width B that flows along x from an inlet of length 0.1, nearly without stiffness. */
std::string plug(const std::string &lattice, double offset, const std::string &velocity,
                 const std::string &more = "")
{
  return plane("si", "f f", "0 2 0 0.5", 1, 0.01) + "fix grid all mpm " + lattice +
      "\nfix m all mpm/material density 1000 eos linear 0.1\n" +
      strprintf("region inlet block %.17g %.17g %.17g %.17g INF INF\n", 0.1 + offset, 0.2 + offset,
                0.2 + offset, 0.2 + offset + B) +
      "fix in all mpm/emit 1 region inlet velocity " + velocity + " " + more + "\n";
}

/** Water as stiff as its jet needs, in the same inlet, against a wall at x = 0.6. */
std::string jet(const std::string &inlet, const std::string &velocity, double h)
{
  return plane("si", "f f", "0 0.6 -1 1", 1, 0.5 * h) + strprintf("fix grid all mpm %g\n", h) +
      "fix m all mpm/material density 1000 eos tait 4e5 7\n" + inlet +
      "fix in all mpm/emit 1 region inlet velocity " + velocity + R"(
region up block INF INF 0.75 INF INF INF
region down block INF INF INF -0.75 INF INF
fix up all mpm/absorb region up
fix down all mpm/absorb region down
fix wall all mpm/boundary xhi slip
fix dt all mpm/dt 0.4
)";
}

/** The mean of a formula over so many steps, which start at a multiple of their number. */
double mean_of(Scene &run, const std::string &formula, int steps)
{
  run.commands("variable f equal " + formula + "\nfix mean all ave/time 1 " +
               std::to_string(steps) + " " + std::to_string(steps) + " v_f\nrun " +
               std::to_string(steps) + "\n");
  const double mean = run.fix("mean")->compute_scalar();
  run.commands("unfix mean\nvariable f delete\n");
  return mean;
}

/** Largest and smallest distance along x of points of the same height, over their spacing. */
void spacings(Scene &run, double spacing, double &least, double &most)
{
  std::map<long, std::vector<double>> rows;
  for (const auto &s : run.gather()) rows[std::lround(s.x[1] / spacing * 1000)].push_back(s.x[0]);
  least = 1e300;
  most = 0.0;
  for (auto &[y, row] : rows) {
    std::sort(row.begin(), row.end());
    for (std::size_t k = 1; k < row.size(); k++) {
      least = std::min(least, (row[k] - row[k - 1]) / spacing);
      most = std::max(most, (row[k] - row[k - 1]) / spacing);
    }
  }
}

// benchmark S5: mass of the flow, and points on their lattice, at any velocity and offset
struct Inflow {
  const char *options;
  double courant, offset;    // U dt/h, in cells
  friend void PrintTo(const Inflow &i, std::ostream *out)
  {
    *out << i.options << " " << i.courant << " " << i.offset;
  }
};
PARAMETER_TEST(Plug, IsExact, Inflow,
               Values(Inflow{"", 0.01, 0.0}, Inflow{"", 0.1, 0.25}, Inflow{"", 0.37, 0.613},
                      Inflow{"", 0.99, 0.0}, Inflow{"", 0.99, 0.3}, Inflow{"", 0.5, 0.5},
                      Inflow{"shape linear transfer flip 1.0", 0.37, 0.1},
                      Inflow{"shape linear transfer flip 0.95 scheme musl", 0.2, 0.4},
                      Inflow{"shape cubic transfer aflip 0.9", 0.3, 0.7},
                      Inflow{"shape gimp transfer flip 1.0 scheme usf", 0.1, 0.2},
                      Inflow{"shape cpdi scheme usavg", 0.25, 0.9},
                      Inflow{"shape cpdi2 transfer flip 0.99", 0.25, 0.6},
                      Inflow{"transfer polypic", 0.2, 0.1}, Inflow{"locking fbar", 0.2, 0.1},
                      Inflow{"transfer fmpm 2", 0.2, 0.8}))
{
  if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  const auto &p = GetParam();
  const double h = 0.02, d = 0.5 * h, dt = p.courant * h / U;
  const int steps = (int) (0.3 / dt);
  Scene run(plug(strprintf("%g ", h) + p.options, p.offset * h, "2 0 0") +
            strprintf("timestep %.17g\ncompute e all mpm/energy\nthermo_style custom step c_e\n"
                      "run 0\n",
                      dt));
  const double start = run.fix("in")->compute_scalar();
  EXPECT_NEAR(start, RHO * B * 0.1, 1e-9);    // the inlet is full
  run.commands(strprintf("run %d\n", steps));
  // what has entered differs from the flow by half a layer at the most
  const double came = run.fix("in")->compute_scalar() - start, flow = RHO * B * U * steps * dt;
  EXPECT_LE(std::fabs(came - flow), 0.5 * RHO * B * d * (1.0 + 1e-6));
  double mass = 0.0, last = 0.0;
  std::set<double> tags;
  for (const auto &s : run.gather()) {
    mass += s.mass;
    tags.insert(s.tag);
    EXPECT_LT(std::fabs(s.vol * RHO / s.mass - 1.0), 1e-12);
    EXPECT_LT(std::fabs(s.v[0] - U) + std::fabs(s.v[1]), 1e-12);
    last = std::max(last, s.x[0]);
  }
  EXPECT_NEAR(mass, start + came, 1e-9);
  EXPECT_EQ((int) tags.size(), run.n());
  // the first layer began half a spacing from the end of the inlet
  EXPECT_NEAR(last, 0.2 + p.offset * h - 0.5 * d + U * steps * dt, 1e-11);
  double least, most;
  spacings(run, d, least, most);
  EXPECT_NEAR(least, 1.0, 1e-11);
  EXPECT_NEAR(most, 1.0, 1e-11);
  const double *e = run.compute_vector();
  EXPECT_NEAR(e[12], 0.5 * U * U * came, 1e-12 * U * U * came);    // what new points brought
  EXPECT_LT(std::fabs(e[10]), 1e-12 * e[12]);                      // the residual
}

// LAMMPS's write_data begins as a run does: the inlet is filled by a run alone
SERIAL_TEST(Plug, DataFileIsNoStart)
{
  const ScratchFile file("written.data");
  Scene run(plug("0.02", 0.0, "2 0 0") + "timestep 1e-3\nwrite_data " + file.name + " nocoeff\n");
  EXPECT_EQ(run.n(), 0);
  run.commands("run 0\n");
  EXPECT_NEAR(run.fix("in")->compute_scalar(), RHO * B * 0.1, 1e-9);
}

// an inlet that is not wide enough for two points, or for a whole one, has one column in its middle
SERIAL_TEST(Plug, NarrowInlet)
{
  for (const double width : {0.004, 0.012}) {
    Scene run(replaced(plug("0.02", 0.0, "2 0 0"), "0.30000000000000004 INF",
                       strprintf("%.17g INF", 0.2 + width)) +
              "timestep 0.0004\nrun 50\n");
    EXPECT_GT(run.n(), 10);
    double mass = 0.0;
    for (const auto &s : run.gather()) {
      EXPECT_NEAR(s.x[1], 0.2 + 0.5 * width, 1e-14);
      mass += s.mass;
    }
    EXPECT_NEAR(mass / (RHO * width * 0.01 * run.n()), 1.0, 1e-12);
  }
}

// the section has the mass, not the lattice in it: a width of 5.3 points, a speed that varies
TEST(Plug, PulsesAndOddWidth)
{
  const std::string scene = plane("si", "f f", "0 2 0 0.5", 1, 0.01) +
      R"(fix grid all mpm 0.02
fix m all mpm/material density 1000 eos linear 0.1
region inlet block 0.1 0.2 0.2 0.253 INF INF
variable v equal 1.5*(1+sin(40*time))*(time<0.1||time>0.15)
fix in all mpm/emit 1 region inlet velocity v_v 0 0 normal 3 0 0
timestep 0.0004
run 0
)";
  Scene run(scene);
  const double start = run.fix("in")->compute_scalar();
  EXPECT_NEAR(start, RHO * 0.053 * 0.1, 1e-11);
  run.commands("run 750\n");
  double way = 0.0;
  for (int k = 1; k <= 750; k++) {
    const double t = 0.0004 * k;
    if (t < 0.1 - 1e-9 || t > 0.15 + 1e-9) way += 0.0004 * 1.5 * (1.0 + sin(40.0 * t));
  }
  const double d = 0.01, layers = std::floor((way + 0.1) / d + 0.5);
  EXPECT_NEAR(run.fix("in")->compute_scalar(), RHO * 0.053 * d * layers, 1e-9);
  // in the inlet points are as far apart as ever
  std::vector<double> row;
  for (const auto &s : run.gather())
    if (s.x[0] < 0.18 && std::fabs(s.x[1] - 0.2 - 0.1 * 0.053) < 1e-6) row.push_back(s.x[0]);
  std::sort(row.begin(), row.end());
  ASSERT_GT(row.size(), 6u);
  for (std::size_t k = 1; k < row.size(); k++) EXPECT_NEAR(row[k] - row[k - 1], d, 1e-13);
  EXPECT_GE(row[0], 0.1);
  EXPECT_LE(row[0], 0.1 + d);
}

// rings: the mass is that of the annulus
SERIAL_TEST(Plug, AroundAnAxis)
{
  for (const double inner : {0.0, 0.043}) {
    Scene run(plane("si", "f f", "0 0.5 0 1", 1, 0.01) +
              "fix grid all mpm 0.02 axisymmetric yes\n"
              "fix m all mpm/material density 1000 eos linear 0.1\n" +
              strprintf("region inlet block %g 0.1 0.8 0.9 INF INF\n", inner) +
              "fix in all mpm/emit 1 region inlet velocity 0 -2 0\n"
              "fix axis all mpm/boundary xlo slip\ntimestep 0.001\nrun 200\n");
    const double section = PI * (0.01 - inner * inner);
    EXPECT_NEAR(run.fix("in")->compute_scalar() / (RHO * section * 0.5), 1.0, 1e-12) << inner;
    EXPECT_NEAR(run.fix("in")->compute_vector(8) / (RHO * section * 2.0), 1.0, 1e-12);
    for (const auto &s : run.gather()) EXPECT_NEAR(s.v[1], -2.0, 1e-11);
  }
}

// 3d: a round inlet, along and across the axes of the box
SERIAL_TEST(Plug, InSpace)
{
  struct Case {
    const char *region, *velocity;
    double area, length;
  };
  for (const auto &c : {Case{"cylinder z 0.5 0.5 0.13 0.1 0.3", "0 0 1", PI * 0.0169, 0.2},
                        Case{"cylinder y 0.5 0.52 0.1 0.7 0.9", "0 -1 0", PI * 0.01, 0.2},
                        Case{"block 0.1 0.3 0.41 0.63 0.3 0.57", "1 0 0", 0.22 * 0.27, 0.2}}) {
    Scene run(space("si", "f f f", "0 1 0 1 0 1", 1, 0.02) +
              "fix grid all mpm 0.05\nfix m all mpm/material density 1000 eos linear 0.1\n"
              "region inlet " +
              c.region + "\nfix in all mpm/emit 1 region inlet velocity " + c.velocity +
              "\ntimestep 0.01\nrun 40\n");
    const double flow = RHO * c.area * (c.length + 0.4);
    EXPECT_NEAR(run.fix("in")->compute_scalar() / flow, 1.0, 1e-4) << c.region;
    for (const auto &s : run.gather())
      EXPECT_LT(std::fabs(s.vol * RHO / s.mass - 1.0), 1e-12) << c.region;
  }
}

// an oblique inlet that moves itself: layers keep their distance, and the velocities add
SERIAL_TEST(Plug, MovingAndOblique)
{
  Scene run(plane("si", "f f", "0 2 0 2", 1, 0.01) + R"(
fix grid all mpm 0.02
fix m all mpm/material density 1000 eos linear 0.1
region a plane 0.3 0.3 0 3 4 0
region b plane 0.36 0.38 0 -3 -4 0
region c plane 0.3 0.3 0 4 -3 0
region d plane 0.332 0.276 0 -4 3 0
region around block 0.3 0.392 0.276 0.38 INF INF
region inlet intersect 5 a b c d around
fix in all mpm/emit 1 region inlet velocity 0.6 0.8 0 move 0.5 -0.25 0
timestep 0.004
run 100
)");
  // 0.1 long, 0.04 wide
  EXPECT_NEAR(run.fix("in")->compute_scalar(), RHO * 0.04 * (0.1 + 0.4), 1e-10);
  double first = -1e300, last = 1e300;
  for (const auto &s : run.gather()) {
    EXPECT_NEAR(s.v[0], 1.1, 1e-11);
    EXPECT_NEAR(s.v[1], 0.55, 1e-12);
    const double along = 0.6 * (s.x[0] - 0.5 * 0.4) + 0.8 * (s.x[1] + 0.25 * 0.4);
    first = std::max(first, along);
    last = std::min(last, along);
  }
  EXPECT_NEAR(first, 0.6 * 0.36 + 0.8 * 0.38 + 0.4 - 0.005, 1e-12);
  EXPECT_NEAR(first - last, 0.5 - 0.01, 1e-12);
}

// an inlet goes through walls, whatever is defined first
SERIAL_TEST(Plug, ThroughAWall)
{
  const std::string wall = "fix wall all mpm/boundary xlo ylo stick\n";
  for (const bool first : {false, true}) {
    Scene run(plane("si", "f f", "0 2 0 0.5", 1, 0.01) +
              "fix grid all mpm 0.02\nfix m all mpm/material density 1000 eos linear 0.1\n"
              "region inlet block 0 0.1 0 0.1 INF INF\n" +
              (first ? wall : "") + "fix in all mpm/emit 1 region inlet velocity 2 0 0\n" +
              (first ? "" : wall) + "timestep 1e-3\nrun 40\n");
    int n = 0;
    for (const auto &s : run.gather()) {
      if (s.x[0] > 0.06) continue;
      n++;
      EXPECT_NEAR(s.v[0], 2.0, 1e-11) << first;
      EXPECT_NEAR(s.vol * RHO / s.mass, 1.0, 1e-12) << first;
    }
    EXPECT_EQ(n, 60);
  }
}

// the inlet bears the weight of what is in it, in units where forces need a factor
SERIAL_TEST(Plug, WeightInTheInlet)
{
  Scene run(plane("metal", "f f", "0 100 0 100", 1, 2.0) + R"(
fix grid all mpm 5
fix m all mpm/material density 2 eos linear 100
region inlet block 30 60 30 80 INF INF
fix in all mpm/emit 1 region inlet velocity 0 0 0 normal 0 -1 0
fix g all gravity 3 vector 0 -1 0
timestep 0.001
run 5
)");
  // fix gravity has the unit of force over mass; below the inlet is a node that can fall
  const double weight = 3000.0 * 3.0;
  EXPECT_NEAR(run.fix("in")->compute_vector(10) / weight, 1.0, 6e-5);
  EXPECT_NEAR(run.fix("in")->compute_vector(9), 0.0, 1e-12 * weight);
  EXPECT_EQ(run.fix("in")->compute_vector(12), 0.0);
}

// new points have the pressure of their equation of state at once
SERIAL_TEST(Plug, GasUnderPressure)
{
  Scene run(plane("si", "f f", "0 2 0 0.1", 1, 0.01) + R"(
fix grid all mpm 0.02
fix m all mpm/material density 1.2 eos ideal/gas 1.4 pressure 1e5
region inlet block 0.1 0.3 0 0.1 INF INF
fix in all mpm/emit 1 region inlet velocity 50 0 0
fix walls all mpm/boundary xlo xhi ylo yhi slip
timestep 1.3e-5
run 39
)");
  // in this step the third layer comes; all are at least a cell and a half from the inlet
  const double pressure = 1e5;
  int n = 0;
  for (const auto &s : run.gather())
    if (s.x[0] < 0.2) {
      n++;
      EXPECT_NEAR(s.pressure(), pressure, 1e-12 * pressure);
    }
  EXPECT_EQ(n, 100);
}

// a jet on a wall and on a plate at 60 degrees (benchmark S5): force, flow rates, mass
SERIAL_TEST(Jet, OnAWall)
{
  LONG_CASE();
  Scene run(jet("region inlet block 0.03 0.13 -0.047 0.053 INF INF\n", "2 0 0", 0.0125));
  run.commands("run 5200\n");
  const int steps = 2600;    // 10 B/U
  const double force = mean_of(run, "f_wall[1]", steps);
  EXPECT_LT(std::fabs(measured("force over rho b U^2 - 1", force / (RHO * B * U * U) - 1.0)),
            0.002);
  double inside = 0.0, points = 0.0;
  for (const auto &s : run.gather()) {
    inside += s.mass;
    points++;
  }
  const double *in = run.fix_vector("in", 2);
  const double came[2] = {in[0], in[1]};
  double went[2] = {0.0, 0.0};
  for (const char *id : {"up", "down"})
    for (int k = 0; k < 2; k++) went[k] += run.fix(id)->compute_vector(k);
  EXPECT_GT(went[0], 1000.0);
  EXPECT_EQ(came[0] - went[0] - points, 0.0);
  EXPECT_LT(std::fabs(came[1] - went[1] - inside), 1e-12 * came[1]);
}

SERIAL_TEST(Jet, ObliqueOnAPlate)
{
  LONG_CASE();
  // direction (sin 60, cos 60), 0.1 long and wide, with the middle of the end at 0.25 -0.2
  const double s = std::sqrt(0.75), c = 0.5, x = 0.16, y = -0.25, a = 0.05;
  const auto flat = [&](const char *name, double px, double py, double nx, double ny) {
    return strprintf("region %s plane %.17g %.17g 0 %.17g %.17g 0\n", name, px, py, nx, ny);
  };
  const double rx = a * (s + c), ry = a * (s + c);
  const std::string inlet = flat("a", x - a * s, y - a * c, s, c) +
      flat("b", x + a * s, y + a * c, -s, -c) + flat("c", x - a * c, y + a * s, c, -s) +
      flat("d", x + a * c, y - a * s, -c, s) +
      strprintf("region around block %.17g %.17g %.17g %.17g INF INF\n"
                "region inlet intersect 5 a b c d around\n",
                x - rx, x + rx, y - ry, y + ry);
  Scene run(jet(inlet, strprintf("%.17g %.17g 0", U * s, U * c), 0.0125));
  run.commands("run 7200\n");
  const double up = run.fix("up")->compute_scalar(), down = run.fix("down")->compute_scalar();
  const double force = mean_of(run, "f_wall[1]", 2400);
  EXPECT_LT(std::fabs(measured("force over 346.41 - 1", force / 346.410 - 1.0)), 0.03);
  const double above = run.fix("up")->compute_scalar() - up,
               below = run.fix("down")->compute_scalar() - down;
  EXPECT_NEAR(measured("share that goes forward", above / (above + below)), 0.75, 0.02);
}

// density at the inlet, with the pressure of a wall close behind it
SERIAL_TEST(Jet, DensityAtTheInlet)
{
  Scene run(jet("region inlet block 0.2 0.3 -0.047 0.053 INF INF\n", "2 0 0", 0.0125) +
            "run 4000\n");
  double mass = 0.0, worst = 0.0;
  for (const auto &s : run.gather())
    if (std::fabs(s.x[1] - 0.003) < 0.05 && s.x[0] > 0.21 && s.x[0] < 0.33) {
      grow(worst, s.mass / (RHO * s.vol) - 1.0);
      mass += s.mass;
    }
  EXPECT_LT(measured("density - 1", worst), 5e-4);
  EXPECT_NEAR(measured("mass around the end of the inlet", mass / (RHO * 0.12 * B)), 1.0, 0.06);
}

// An inlet that is shaken with what it holds works with the mean of its velocities before and after
// each step: that is what its material gets as kinetic energy, with any time step and transfer. All
// nodes that its points see are held: its end is just beyond a plane of nodes
TEST(Plug, WorkOfAShakenInlet)
{
  for (const char *options : {"", " transfer flip 0.9", " transfer apic scheme musl"})
    for (const double dt : {0.002, 0.01}) {
      Scene run(plane("si", "f f", "0 2 0 1", 1, 0.02) + "fix grid all mpm 0.05 shape linear" +
                options +
                "\nfix m all mpm/material density 1000 eos linear 0.1\n"
                "region inlet block 0.6 1.000001 0.4 0.6 INF INF\n"
                "variable u equal 0.2+0.5*sin(20*time)\n"
                "fix in all mpm/emit 1 region inlet velocity 0 0 0 normal 1 0 0 move 0 v_u 0\n"
                "compute e all mpm/energy\nthermo_style custom step c_e\n" +
                strprintf("timestep %g\nrun 1\n", dt));
      const auto kinetic = [&]() {
        return over_ranks(run.sums().kinetic);
      };
      const double work = run.fix("in")->compute_vector(12), start = kinetic();
      run.commands("run 40\n");
      const double gained = kinetic() - start;
      EXPECT_GT(std::fabs(gained), 1.0) << options;
      EXPECT_NEAR(run.fix("in")->compute_vector(12) - work, gained, 1e-11 * start)
          << options << " " << dt;
    }
}

// flow through a channel: steady, the same points on any number of ranks and after a restart
TEST(Channel, RanksAndRestart)
{
  const std::string fixes = R"(
fix grid all mpm 0.05 MPM_OPTIONS
fix m all mpm/material density 1000 eos tait 4e4 7 viscosity newtonian 5
region inlet block 0.1 0.3 0.8 1.2 INF INF
variable v equal 1.0+0.5*sin(9*time)
fix in all mpm/emit 1 region inlet velocity v_v 0 0 normal 1 0 0
region sink block 0.05 1.41 0.2 1.8 INF INF side out
fix out all mpm/absorb region sink
fix plate all mpm/boundary region plate slip
fix dt all mpm/dt 0.4
compute e all mpm/energy
thermo_style custom step c_e
)";
  // a jet at a plate; ranks share the inlet
  const std::string plate = "region plate block 0.8 0.9 1 2 INF INF\n";
  const std::string head = plane("si", "f f", "0 1.6 0 2", 1, 0.025) + plate;
  for (const char *options : first_of(
           1,
           {"", "shape linear transfer flip 0.99 scheme musl", "shape gimp transfer aflip 0.95"})) {
    const auto all = replaced(fixes, "MPM_OPTIONS", options);
    Twins twins(head + all, 500, "neighbor 0.025 bin\n" + plate + all, 150, 1e-9);
    EXPECT_GT(twins.whole.fix("out")->compute_scalar(), 10.0) << options;
    // of the inlet also its force and work
    for (const char *id : {"in", "out"})
      for (int k = 0; k < (*id == 'i' ? 13 : 7); k++)
        EXPECT_EQ(twins.whole.fix(id)->compute_vector(k), twins.again.fix(id)->compute_vector(k))
            << options << " " << id << " " << k;
    const double *whole = twins.whole.compute_vector();
    const std::vector<double> first(whole, whole + 13);
    const double *again = twins.again.compute_vector();
    for (int k = 0; k < 13; k++) EXPECT_NEAR(first[k], again[k], 1e-12 * first[0]) << options << k;
    EXPECT_LT(std::fabs(first[10]), 1e-12 * first[0]) << options;
  }
}

// no point gets the ID of one that was removed, by any inlet, on any ranks, nor after a restart
TEST(Channel, IDsComeOnce)
{
  const std::string fixes = R"(
fix grid all mpm 0.02
fix m all mpm/material density 1000 eos linear 0.1
region inlet block 0.1 0.2 0.2 0.3 INF INF
region other block 0.15 0.25 0.38 0.44 INF INF
fix in all mpm/emit 1 region inlet velocity 2 0 0
fix on all mpm/emit 1 region other velocity 1 0 0
timestep 0.002
)";
  const int body = 20 * 30;
  const std::string scene = plane("si", "f f", "0 2 0 0.5", 1, 0.01) + fixes +
      "region b block 1.5 1.7 0.1 0.4 INF INF\ncreate_points 1 region b\n";
  Scene all(scene + "run 20\n");
  tagint last = 0;
  for (const auto &s : all.gather()) last = std::max(last, (tagint) s.tag);
  EXPECT_GT(last, body + 160 + 80);
  const std::string removed = "run 20\nregion behind block INF 0.24 INF INF INF INF\n"
                              "group new region behind\ndelete_atoms group new compress no\n";
  Twins twins(scene + removed, 0, fixes, 20, 1e-9);
  int kept = 0, came = 0;
  for (const auto &s : twins.whole.gather()) (s.tag > last ? came : kept)++;
  EXPECT_EQ(came,
            twins.whole.fix("in")->compute_vector(0) + twins.whole.fix("on")->compute_vector(0) -
                (last - body));
  EXPECT_GT(came, 80);
  EXPECT_GT(kept, 40);
  // the one that comes later knows of the others' points
  Scene second(scene + removed +
               "unfix in\nregion third block 0.5 0.6 0.1 0.2 INF INF\n"
               "fix later all mpm/emit 1 region third velocity 1 0 0\nrun 1\n");
  for (const auto &s : second.gather())
    if (s.x[0] < 1.0 && s.x[1] < 0.2) EXPECT_GT(s.tag, last);
}

// numbers, masses, and momenta balance, and the watch of energies knows of points that come and go
TEST(Channel, Balance)
{
  Scene run(plane("si", "f f", "0 1.6 0 0.4", 1, 0.025) + R"(
fix grid all mpm 0.05 gain error 1e-3
fix m all mpm/material density 1000 eos linear 4e4
region inlet block 0.1 0.3 0.08 0.323 INF INF
fix in all mpm/emit 1 region inlet velocity 1 0 0 ppc 3
region sink block 1.41 INF INF INF INF INF
fix out all mpm/absorb region sink every 3
fix dt all mpm/dt 0.5
run 3000
)");
  const auto all = run.gather();
  double mass = 0.0;
  for (const auto &s : all) mass += s.mass;
  const double *in = run.fix_vector("in", 13);
  const std::vector<double> came(in, in + 13);
  const double *out = run.fix_vector("out", 8);
  EXPECT_GT(out[0], 1000.0);
  EXPECT_EQ(came[0] - out[0], (double) all.size());
  EXPECT_LT(std::fabs(came[1] - out[1] - mass), 1e-11 * came[1]);
  EXPECT_NEAR(out[2], out[1] * 1.0, 1e-12 * out[1]);
  EXPECT_NEAR(out[5], 0.5 * out[1], 1e-12 * out[1]);
  EXPECT_EQ(came[7], 1.0);
  EXPECT_NEAR(came[8], 243.0, 1e-9);
  EXPECT_LT(std::fabs(came[9]), 1e-10);    // nothing pushes against the inlet
  // constant: the same number of points, but for the layer that comes next
  const int n = (int) all.size();
  run.commands("run 1500\n");
  EXPECT_NEAR((double) run.gather().size(), n, 30.0);
}

// points that come and go do not look like others that were added or removed, with which the watch
// of energies begins anew: what transfers take of a jet at a wall is what the ledger has
SERIAL_TEST(Channel, WatchKnows)
{
  const auto text = lines_that_say(
      jet("region inlet block 0.03 0.13 -0.047 0.053 INF INF\n", "2 0 0", 0.02) +
          "compute e all mpm/energy\nthermo_style custom step c_e[9] c_e[10] c_e[11]\n"
          "variable lost equal -(c_e[9]+c_e[10]+c_e[11])\nrun 2700\n"
          "print \"the ledger lost ${lost}\"\n",
      "lost");
  const auto watch = lines_that_say(
      jet("region inlet block 0.03 0.13 -0.047 0.053 INF INF\n", "2 0 0", 0.02) + "run 2700\n",
      "energy at the end: kinetic");
  ASSERT_EQ(watch.size(), 1u);
  double ledger = 0.0, kinetic, stored, took;
  for (const auto &line : text) sscanf(line.c_str(), "the ledger lost %lf", &ledger);
  ASSERT_EQ(sscanf(watch[0].c_str(),
                   " energy at the end: kinetic %lf, stored %lf; since the start transfers and "
                   "friction took %lf",
                   &kinetic, &stored, &took),
            3)
      << watch[0];
  EXPECT_GT(ledger, 20.0);
  EXPECT_NEAR(measured("taken by the watch over that of the ledger", took / ledger), 1.0, 0.002);
}

// hot points in a cold channel; the heat that is in the channel is that of what came and went
SERIAL_TEST(Channel, Temperature)
{
  Scene run(plane("si", "f f", "0 1.6 0 0.4", 1, 0.025) + R"(
fix grid all mpm 0.05
fix m all mpm/material density 1000 eos linear 4e4 thermal conducting 900 300 50 melt 350 2e5
region inlet block 0.1 0.3 0.1 0.3 INF INF
fix in all mpm/emit 1 region inlet velocity 1 0 0 temperature 400
fix heat all mpm/heat
region sink block 1.41 INF INF INF INF INF
fix out all mpm/absorb region sink
compute T all mpm/atom temperature molten
fix dt all mpm/dt 0.5
run 500
)");
  auto *T = run.per_atom("T");
  for (int i = 0; i < run.n(); i++) {
    EXPECT_NEAR(T->array_atom[i][0], 400.0, 1e-9);
    EXPECT_EQ(T->array_atom[i][1], 1.0);
  }
}

// a bar with heat sources slides into a sink: the heat of the points that are still there, of which
// the material tells only what heat makes what temperature, and of those that went is what came
PARAMETER_TEST(Sink, HeatIsInBalance, const char *,
               Values("", "melt 310 2e4", "melt 310 2e4 over 5",
                      "melt 310 2e4 vary CP table 300 1.0 700 6.0"))
{
  const auto scene = [](const char *more) {
    return plane("si", "p p", "0 2 0 0.2", 1, 0.025) +
        "fix grid all mpm 0.05\nregion bar block 0 1.4 INF INF INF INF\n"
        "create_points 1 region bar ppc 2\n"
        "fix m all mpm/material density 1000 eos linear 4e4 thermal conducting 900 300 50 " +
        more +
        "\nvelocity all set 1 0 0\nvariable s atom 1e8*(1+x)\nfix heat all mpm/heat source v_s\n"
        "region sink block 1.6 2 INF INF INF INF\nfix out all mpm/absorb region sink\n"
        "compute T all mpm/atom temperature molten\ncompute e all mpm/energy\ntimestep 1e-3\n";
  };
  const bool table = strstr(GetParam(), "vary");
  Scene run(replaced(scene(GetParam()), " molten", *GetParam() ? " molten" : "") + "run 600\n");
  const double *const out = run.fix_vector("out", 9);
  EXPECT_GT(out[0], 50.0);
  const double gone = out[8], came = run.fix("heat")->compute_scalar();
  auto *const T = run.lmp->modify->get_compute_by_id("T");
  double there = 0.0;
  T->compute_peratom();
  for (int i = 0; i < run.n(); i++) {
    const double *const columns = *GetParam() ? T->array_atom[i] : &T->vector_atom[i];
    const double t = columns[0] - 300.0, molten = *GetParam() ? columns[1] : 0.0;
    // with the table, specific heat rises by half in 40 K
    const double h = 900.0 * (table ? t + 0.25 * t * t / 40.0 : t) + 2e4 * molten;
    there += run.lmp->atom->rmass[i] * h;
  }
  there = over_ranks(there, MPI_SUM);
  EXPECT_GT(gone, 0.1 * came);
  EXPECT_NEAR(measured("heat that is there and that went, over what came", (there + gone) / came),
              1.0, 1e-12);
}

// a bar of points that differ in heat is warmed and goes as a whole: what went is what came
TEST(Sink, HeatOfPointsThatDiffer)
{
  Scene run(plane("si", "p p", "0 2 0 0.2", 1, 0.025) +
            "fix grid all mpm 0.05\nregion bar block 0 1.4 INF INF INF INF\n"
            "create_points 1 region bar ppc 2\n"
            "fix m all mpm/material density 1000 eos linear 4e4 thermal conducting 900 300 50 "
            "random T0 normal 0.1 0.2 7 random CP normal 0.1 0.2 8\n"
            "velocity all set 1 0 0\nvariable s atom 1e8*(1+x)\nfix heat all mpm/heat source v_s\n"
            "region sink block 1.6 2 INF INF INF INF\nfix out all mpm/absorb region sink every 10\n"
            "timestep 1e-3\nrun 1700\n");
  const double gone = run.fix_vector("out", 9)[8], came = run.fix("heat")->compute_scalar();
  EXPECT_EQ(run.lmp->atom->natoms, 0);
  EXPECT_NEAR(measured("heat that went over what came", gone / came), 1.0, 1e-12);
}

// a column of an incompressible fluid runs out of the box: what is there and has gone is all of it
TEST(Channel, DrainOfAnIncompressibleFluid)
{
  const std::string scene = plane("si", "f f", "0 2 0 1", 1, 0.025) + R"(
fix flow all mpm/incompressible 0.05 1000
region dam block 0 0.6 0 0.8 INF INF
create_points 1 region dam spacing 0.025
region sink block 1.6 INF INF INF INF INF
fix out all mpm/absorb region sink
fix g all gravity 9.81 vector 0 -1 0
fix dt all mpm/dt 0.5 max 0.01
)";
  OnRanks runs(scene, "run 90\n");
  EXPECT_LT(runs.difference(), 1e-12);    // of a pressure that is solved to 1e-9
  const auto rest = runs.parallel.gather();
  double mass = 0.0;
  for (const auto &s : rest) mass += s.mass;
  auto *out = runs.parallel.fix("out");
  EXPECT_GT(out->compute_vector(0), 100.0);
  EXPECT_EQ(out->compute_vector(0) + (double) rest.size(), 768.0);
  EXPECT_NEAR(out->compute_scalar() + mass, 480.0, 1e-9);
  EXPECT_EQ((double) runs.parallel.lmp->atom->natoms, (double) rest.size());
}

// water that has left a tank through a hole in its floor has the speed of the height that it has
// lost, but for what transfers take where the flow turns round the edges of the hole (benchmark S5)
SERIAL_TEST(Drain, SpeedOfTheHeight)
{
  Scene run(plane("si", "f f", "0 0.8 -0.3 0.7", 1, 0.01) + R"(
fix grid all mpm 0.0125 transfer aflip 0.99
fix m all mpm/material density 1000 eos tait 6e4 7
region tank block 0 0.8 0 0.5 INF INF
create_points 1 region tank ppc 2
region slab block -1 2 -0.05 0 INF INF
region hole block 0.35 0.45 INF INF INF INF side out
region floor intersect 2 slab hole
fix floor all mpm/boundary region floor slip
fix walls all mpm/boundary xlo xhi slip
fix g all gravity 9.81 vector 0 -1 0
region drain block INF INF INF -0.2 INF INF
fix out all mpm/absorb region drain
fix dt all mpm/dt 0.4 until 0.3
run 20000
)");
  const auto level = [&run]() {
    double top = 0.0;
    for (const auto &s : run.gather()) top = std::max(top, s.x[1]);
    return top;
  };
  const double *out = run.fix_vector("out", 8);
  const double mass = out[1], kinetic = out[5], before = level();
  run.commands("fix dt all mpm/dt 0.4 until 0.4\nrun 20000\n");
  out = run.fix_vector("out", 8);
  const double height = 0.5 * (before + level()) + 0.2;
  EXPECT_GT(out[1] - mass, 10.0);
  const double speed = std::sqrt((out[5] - kinetic) / ((out[1] - mass) * 9.81 * height));
  EXPECT_LT(measured("speed over that of the height", speed), 1.0);
  EXPECT_GT(speed, 0.95);
}

// a drain at an edge of a periodic box is as large as in the middle
SERIAL_TEST(Drain, AcrossPeriodicFaces)
{
  for (const double x : {6.0, 0.3, 12.0})
    for (const double y : {5.0, 0.0}) {
      int inside = 0;
      for (int i = 0; i < 24; i++)
        for (int j = 0; j < 20; j++) {
          const double dx = std::remainder(0.5 * i + 0.25 - x, 12.0),
                       dy = std::remainder(0.5 * j + 0.25 - y, 10.0);
          inside += dx * dx + dy * dy < 2.2 * 2.2;
        }
      Scene run(plane("lj", "p p", "0 12 0 10", 1, 0.5) +
                body("box", "density 1.0 linear 100.0 0.3") +
                strprintf("region drain cylinder z %g %g 2.2 INF INF\n", x, y) +
                "fix out all mpm/absorb region drain\ntimestep 0.005\nrun 2\n");
      EXPECT_EQ(run.lmp->atom->natoms, 480 - inside) << x << " " << y;
    }
}

// mistakes are told, with the remedy
TEST(BadInput, IsRefused)
{
  const std::string head = plane("si", "f f", "0 1.6 0 0.4", 2, 0.025) + R"(
region inlet block 0.1 0.3 0.1 0.3 INF INF
region ball sphere 0.3 0.2 0 0.1
region all block INF INF INF INF INF INF
region wide block 0.1 0.3 -0.1 0.3 INF INF
region short block 0.1 0.12 0.1 0.3 INF INF
region ring cylinder z 0.3 0.2 0.1 -0.5 0.5 side out
region slant intersect 2 inlet cut
variable back equal 0.5-step
variable turn equal step*0.01
variable atoms atom x
)";
  const std::string scene = replaced(head, "region slant intersect 2 inlet cut\n",
                                     "region cut plane 0.2 0.2 0 -1 -1 0\n"
                                     "region slant intersect 2 inlet cut\n") +
      "fix grid all mpm 0.05\nfix m all mpm/material density 1000 eos linear 4e4\ntimestep 1e-4\n";
  const std::string emit = "fix in all mpm/emit 1 region inlet velocity 1 0 0 ";
  expect_refused(
      scene,
      {{"fix in all mpm/emit", "Illegal fix mpm/emit"},
       {"fix in all mpm/emit 3 region inlet velocity 1 0 0", "Invalid atom type 3"},
       {"fix in all mpm/emit 1 velocity 1 0 0", "needs an inlet: use the keyword region"},
       {"fix in all mpm/emit 1 region inlet", "needs the velocity"},
       {"fix in all mpm/emit 1 region none velocity 1 0 0", "Region none"},
       {"fix in all mpm/emit 1 region inlet velocity 1 0 1", "along z in 2d"},
       {"fix in all mpm/emit 1 region inlet velocity 0 0 0", "use the keyword normal"},
       {"fix in all mpm/emit 1 region inlet velocity v_none 0 0", "does not exist"},
       {"fix in all mpm/emit 1 region inlet velocity v_atoms 0 0", "not equal-style"},
       {"fix in all mpm/emit 1 region ball velocity 1 0 0", "straight piece of a pipe"},
       {"fix in all mpm/emit 1 region slant velocity 1 0 0", "straight piece of a pipe"},
       {"fix in all mpm/emit 1 region inlet velocity 1 1 0", "straight piece of a pipe"},
       {"fix in all mpm/emit 1 region all velocity 1 0 0", "must be bounded"},
       {"fix in all mpm/emit 1 region ring velocity 1 0 0", "must be bounded"},
       {"fix in all mpm/emit 1 region wide velocity 1 0 0", "outside of the box"},
       {"fix in all mpm/emit 1 region short velocity 1 0 0", "less than a cell"},
       {emit + "ppc 3 spacing 0.01", "either of them"},
       {emit + "ppc 0", "ppc"},
       {emit + "spacing -1", "spacing"},
       {emit + "normal 0 0 0", "length zero"},
       {emit + "normal 0 1 0", "not along the direction"},
       {emit + "temperature 400", "thermal conducting"},
       {emit + "hot yes", "hot"},
       {emit + "velocity 2 0 0", "velocity is given twice"},
       {emit + "region wide", "region is given twice"},
       {"fix out all mpm/absorb region inlet region wide", "region is given twice"},
       {"fix in all mpm/emit 1 region inlet velocity v_back 0 0", "use the keyword normal"},
       {"fix in all mpm/emit 1 region inlet velocity 1 v_turn 0", "not along the direction"},
       {"create_points 1 region inlet ppc 2\n" + emit, "is in the inlet at the start"},
       {emit + "\nfix rest all mpm/relax 1e-3", "does not come to rest"},
       {"fix out all mpm/absorb", "needs the keyword region"},
       {"fix out all mpm/absorb region none", "does not exist"},
       {"fix out all mpm/absorb region inlet every 0", "every"},
       {emit + "\nfix out all mpm/absorb region inlet\nregion inlet delete", "does not exist"}},
      "run 3\n");
  expect_refused(
      head.substr(0, head.find("region slant")),
      {{"group w type 1\nfix grid w mpm 0.05\nfix m w mpm/material density 1 eos linear 1\n" + emit,
        "no fix mpm"},
       {"fix grid all mpm 0.05\ngroup w type 1\nfix m w mpm/material density 1 eos linear 1\n" +
            emit,
        "no material"},
       {"fix grid all mpm 0.05 frame total\nfix m all mpm/material density 1 eos linear 1\n" + emit,
        "frame total"},
       {"fix grid all mpm 0.05 every 2\nfix m all mpm/material density 1 eos linear 1\n" + emit,
        "every"},
       {"fix flow all mpm/incompressible 0.05 1000 reflect 0.5\n" + emit,
        "reflect cannot be used with points"},
       {"fix grid all mpm 0.05\nfix m all mpm/material density 1 eos linear 1\n"
        "fix n all mpm/material density 2 eos linear 1\n" +
            emit,
        "disjoint groups"}},
      "run 3\n");
}

// what others need all points of is not absorbed, whatever groups the fixes have: a field with
// *every*, the nodes of elements, and both parts of a mixture
SERIAL_TEST(BadInput, AbsorbsPointsThatOthersNeed)
{
  const ScratchFile line(
      "line.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0.3 0.7 0\n2 0.4 0.7 0\n"
      "3 0.5 0.7 0\n$EndNodes\n$Elements\n2\n1 1 2 0 1 1 2\n2 1 2 0 1 2 3\n"
      "$EndElements\n");
  const std::string start = plane("si", "f f", "0 1 0 1", 2, 0.01) +
      "region b block 0.2 0.5 0.2 0.5 INF INF\ngroup one empty\ngroup two empty\n"
      "region r block 0.8 1 INF INF INF INF\n",
                    end = "timestep 1e-5\nrun 1\n";
  const std::string elements = "fix F all mpm 0.05\nfix m all mpm/material density 1000 linear 1e6 "
                               "0.3\ncreate_points 1 mesh " +
      line.name + " thickness 0.01 group one\ncreate_points 2 region b ppc 2 group two\n" +
      "fix e one mpm/elements " + line.name + " thickness 0.01\n";
  const std::string mixture = "fix F one mpm 0.05\nfix G two mpm 0.05\n"
                              "create_points 1 region b ppc 2 fix F group one\n"
                              "create_points 2 region b ppc 2 fix G group two share 0.4\n"
                              "fix m one mpm/material density 1600 linear 1e6 0.3\n"
                              "fix n two mpm/material density 1000 eos tait 1e6 7\n"
                              "fix mix all mpm/mixture F G 2650 1e-3 drag darcy 1e-6\n",
                    slow = "fix F one mpm 0.05 every 2\nfix G two mpm 0.05 every 2\n"
                           "create_points 1 region b ppc 2 fix F group one\n"
                           "fix m all mpm/material density 1600 linear 1e6 0.3\n";
  for (const char *group : {"all", "one"}) {
    const auto absorb = strprintf("fix out %s mpm/absorb region r\n", group);
    expect_error(start + elements + absorb + end,
                 "cannot remove points of fix e (style mpm/elements)");
    expect_error(start + mixture + absorb + end,
                 "cannot remove points of fix mix (style mpm/mixture)");
    expect_error(start + slow + absorb + end, "cannot be used with every of fix mpm F");
  }
  Scene others(start + elements + "fix out two mpm/absorb region r\n" + end);
}

// Around an axis of symmetry the area that is given is that of an annulus, as what is found
SERIAL_TEST(Emit, AreaOfAnAnnulus)
{
  const double exact = PI * (0.09 * 0.09 - 0.03 * 0.03);
  for (const std::string area : {"", "area "}) {
    const std::string scene = plane("si", "f f", "0 0.3 0 0.8", 1, 0.01) +
        "fix grid all mpm 0.02 axisymmetric yes\nfix axis all mpm/boundary xlo slip\n"
        "fix m all mpm/material density 1000 eos linear 0.1\n"
        "region inlet block 0.03 0.09 0.1 0.2 INF INF\n"
        "fix in all mpm/emit 1 region inlet velocity 0 2 0 " +
        (area.empty() ? "" : area + strprintf("%.17g", exact)) + "\ntimestep 0.001\nrun 1\n";
    EXPECT_EQ(times_said(scene, "across the flow, and"), 0);
    Scene run(scene);
    EXPECT_NEAR(run.fix_vector("in", 13)[8] / (2000.0 * exact), 1.0, 1e-12);
  }
}

SERIAL_TEST(BadInput, AnotherArea)
{
  const auto told = [](double area) {
    return times_said(plug("0.02", 0.0, "2 0 0", strprintf("area %.17g", area)) +
                          "timestep 0.001\nrun 1\n",
                      "across the flow, and");
  };
  EXPECT_EQ(told(B), 0);
  EXPECT_EQ(told(1.01 * B), 0);
  EXPECT_EQ(told(10.0 * B), 1);
}

// an inlet that moves out of the box takes its points there
SERIAL_TEST(BadInput, OutOfTheBox)
{
  Scene run(plug("0.02", 0.0, "2 0 0", "move -4 0 0") + "timestep 0.001\n");
  expect_error(run, "run 200\n", "has left the box through a fixed face");
}

// IDs end somewhere
SERIAL_TEST(BadInput, LastID)
{
  Scene run(plug("0.02", 0.0, "2 0 0") + "timestep 0.001\nrun 1\n");
  run.lmp->atom->tag[0] = MAXTAGINT - 40;
  expect_error(run, "run 100\n", "use reset_atoms id");
}
