// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics

// Plates, shells, and soap films of fix mpm/elements whose nodes are free, without a lattice:
// benchmark R5. Loads on plates are small, and a damped motion ends in equilibrium.

#include "elements/fix_mpm_elements.h"
#include "elements/thin_testing.h"

using namespace MPM_TEST;

/** What a scene without a lattice needs. */
struct Plate : ThinMesh {
  double thickness, E, nu;
  std::string bending = "yes";

  Plate(double thickness, double E, double nu, const ThinMesh &mesh = {}) :
      ThinMesh(mesh), thickness(thickness), E(E), nu(nu)
  {
  }
  int dim() const { return (int) elements[0].size(); }
  double stiffness() const { return E * pow(thickness, 3) / (12.0 * (1.0 - nu * nu)); }
};

/** n x m pairs of triangles with parallel or alternate diagonals at place(u, v). */
template <class Place>
static ThinMesh sheet_of(int n, int m, const Place &place, bool alternate = false)
{
  ThinMesh body;
  for (int j = 0; j <= m; j++)
    for (int i = 0; i <= n; i++) body.x.push_back(place((double) i / n, (double) j / m));
  for (int j = 0; j < m; j++)
    for (int i = 0; i < n; i++) {
      const int a = j * (n + 1) + i, b = a + n + 1;
      const bool other = alternate && (i + j) % 2;
      body.elements.push_back({a, a + 1, other ? b : b + 1});
      body.elements.push_back({other ? a + 1 : a, b + 1, b});
    }
  return body;
}
/** The same of a square of edge 1 around 0. */
static ThinMesh square_of(int n, bool alternate)
{
  const auto place = [](double u, double v) {
    return Node{u - 0.5, v - 0.5, 0.0};
  };
  return sheet_of(n, n, place, alternate);
}

constexpr double DENSITY = 1.0;

/** Input up to the elements and the time step. */
static std::string scene(const Plate &body, const ScratchFile &file, double room = 0.1)
{
  Node low = body.x[0], high = body.x[0];
  double size = 0.0;
  for (const Node &x : body.x)
    for (int d = 0; d < 3; d++) {
      low[d] = std::min(low[d], x[d]);
      high[d] = std::max(high[d], x[d]);
      size = std::max(size, high[d] - low[d]);
    }
  const double gap = room * size;
  const std::string thick = strprintf("thickness %.17g", body.thickness);
  return with_map(space("si", body.dim() == 2 ? "f f p" : "f f f",
                        strprintf("%g %g %g %g %g %g", low[0] - gap, high[0] + gap, low[1] - gap,
                                  high[1] + gap, low[2] - gap, high[2] + gap),
                        1, 0.01 * size, body.dim())) +
      strprintf("comm_modify cutoff %g\n", 0.3 * size) + "create_points 1 mesh " + file.name + " " +
      thick +
      strprintf("\nfix m all mpm/material density %g linear %.17g %.17g\n", DENSITY, body.E,
                body.nu) +
      "fix e all mpm/elements " + file.name + " " + thick + " bending " + body.bending +
      "\nfix dt all mpm/dt 0.9\n";
}

/** The value of compute w in equilibrium; last: what defines it, and constraints. The lowest mode,
 *  of angular frequency omega, has 0.8 of critical damping. */
static double in_equilibrium(const Plate &body, double omega, const std::string &load,
                             const std::string &last)
{
  const ScratchFile file("plate.msh", body.text());
  Scene run(
      scene(body, file) + load +
      strprintf("compute u all displace/atom\nfix damp all viscous $(mass(all)/count(all)*%.17g)\n",
                1.6 * omega) +
      last + "thermo_style custom step c_w\nrun 0 post no\n");
  while (run.evaluate("time") < 12.0 / omega) run.commands("run 50 post no\n");
  return run.evaluate("c_w");
}

// D w'''' = q: strips that are clamped and simply supported. Two nodes make a clamp
SERIAL_TEST(Bending, Strips)
{
  const double E = 1e6, t = 0.05, D = E * t * t * t / 12.0;
  for (const bool clamped : {true, false}) {
    double errors[2];
    for (int fine = 0; fine < 2; fine++) {
      // without the clamps 0 to 1
      const int n = fine ? 20 : 10, more = clamped ? 1 : 0;
      const double l = 1.0 / n;
      const Plate strip(t, E, 0.0,
                        line(n + more, {-0.5 * more * l, 0, 0}, {1.0 + 0.5 * more * l, 0, 0}));
      const double w0 = (clamped ? 1.0 : 5.0) / 384.0, q = 0.01 * t * D / w0,
                   omega = (clamped ? 22.37 : 9.87) * sqrt(D / (DENSITY * t));
      const double w = -in_equilibrium(
          strip, omega,
          strprintf("region span block %g %g INF INF INF INF\ngroup span region span\n"
                    "group ends subtract all span\nfix move all nve\n"
                    "fix load all gravity %.17g vector 0 -1 0\n",
                    0.9 * l, 1.0 - 0.9 * l, q / (DENSITY * t)),
          strprintf("fix hold ends setforce %s 0 NULL\n", clamped ? "0" : "NULL") +
              "compute w all reduce min c_u[2]\n");
      errors[fine] = measured(strprintf("%s strip, %d lines", clamped ? "clamped" : "supported", n),
                              w / (0.01 * t)) -
          1.0;
    }
    EXPECT_NEAR(errors[1], 0.0, 0.02);
    EXPECT_LT(std::fabs(errors[1]), 0.3 * std::fabs(errors[0]) + 1e-3);
  }
}

// q a^4/64 D, clamped halfway between the inner two of three rings of nodes; the lowest frequency
// of that plate, 10.21583 sqrt(D/rho t)/a^2
SERIAL_TEST(Bending, ClampedCircularPlate)
{
  for (const int n : first_of(1, {6, 12})) {
    const double a = 0.5, t = 0.05, dr = a / (n + 0.5);
    const Plate plate(t, 1e6, 0.3, rings_of_triangles(n + 2, (n + 2) * dr));
    const double D = plate.stiffness(), omega = 10.21583 * sqrt(D / (DENSITY * t)) / (a * a),
                 w0 = 0.01 * t, q = 64.0 * D * w0 / pow(a, 4);
    const std::string held =
        strprintf("region span cylinder z 0 0 %g INF INF\ngroup span region span\n"
                  "fix move span nve\n",
                  (n - 0.5) * dr);
    const double w = -in_equilibrium(
        plate, omega,
        held + strprintf("fix load all gravity %.17g vector 0 0 -1\n", q / (DENSITY * t)),
        "compute w all reduce min c_u[3]\n");
    EXPECT_NEAR(measured(strprintf("deflection, %d rings", n), w / w0), 1.0,
                n == 6 ? 0.015 : 0.005);

    const ScratchFile file("plate.msh", plate.text());
    Scene run(scene(plate, file) + held +
              strprintf("variable q atom (1-(x^2+y^2)/%g)^2\nvariable v atom 0.001*v_q\n", a * a) +
              "velocity span set NULL NULL v_v\nvariable w atom vz*v_q*mass\n"
              "compute w span reduce sum v_w\nthermo_style custom step c_w\nrun 0 post no\n");
    EXPECT_NEAR(measured(strprintf("frequency, %d rings", n),
                         PI / 2.0 / time_of_zero(run, "c_w", 5) / omega),
                1.0, 0.02);
  }
}

// a square on supports, 0.00406235 q L^4/D, whose diagonals are parallel or alternate
SERIAL_TEST(Bending, SupportedSquare)
{
  struct Case {
    int n;
    bool alternate;
    double tolerance;
  };
  for (const auto &c :
       first_of(2, {Case{10, false, 0.005}, Case{10, true, 0.02}, Case{20, false, 0.005}})) {
    const Plate plate(0.1, 1e6, 0.3, square_of(c.n, c.alternate));
    const double t = plate.thickness, D = plate.stiffness(), w0 = 0.01 * t, q = w0 * D / 0.00406235,
                 in = 0.5 - 0.1 / c.n;
    const double w =
        -in_equilibrium(plate, 2.0 * PI * PI * sqrt(D / (DENSITY * t)),
                        strprintf("region span block %g %g %g %g INF INF\ngroup span region span\n"
                                  "group rim subtract all span\nfix move all nve\n"
                                  "fix load all gravity %.17g vector 0 0 -1\n",
                                  -in, in, -in, in, q / (DENSITY * t)),
                        "fix hold rim setforce NULL NULL 0\ncompute w all reduce min c_u[3]\n");
    EXPECT_NEAR(measured(strprintf("deflection, %d squares across%s", c.n,
                                   c.alternate ? ", alternate" : ""),
                         w / w0),
                1.0, c.tolerance);
  }
}

// a clamped square, 0.00126532 q L^4/D, with 21 edges from clamp to clamp, which are halfway
// between the inner two of three rows of nodes that are held: short waves find resistance at a
// clamp, where the curvature jumps, and more of it where diagonals change direction
SERIAL_TEST(Bending, ClampedSquare)
{
  for (const bool alternate : first_of(1, {false, true})) {
    const int n = 24;
    const Plate plate(0.05, 1e6, 0.3, square_of(n, alternate));
    const double L = 21.0 / n, t = plate.thickness, D = plate.stiffness(), w0 = 0.01 * t;
    const double w =
        -in_equilibrium(plate, 35.985 * sqrt(D / (DENSITY * t)) / (L * L),
                        strprintf("region span block %g %g %g %g INF INF\ngroup span region span\n"
                                  "fix move span nve\nfix load all gravity %.17g vector 0 0 -1\n",
                                  -9.5 / n, 9.5 / n, -9.5 / n, 9.5 / n,
                                  w0 * D / (0.00126532 * pow(L, 4)) / (DENSITY * t)),
                        "compute w all reduce min c_u[3]\n");
    EXPECT_NEAR(
        measured(strprintf("deflection, 21 edges%s", alternate ? ", alternate" : ""), w / w0), 1.0,
        alternate ? 0.035 : 0.02);
  }
}

// a free square plate, 13.468 sqrt(D/rho t)/a^2 (nu = 0.3: A.W. Leissa, Vibration of Plates, NASA
// SP-160 (1969), chapter 4), in four periods, with its energy
SERIAL_TEST(Bending, FreeSquare)
{
  double error[2];
  for (int fine = 0; fine < 2; fine++) {
    const int n = fine ? 10 : 5;
    const Plate plate(0.05, 1e6, 0.3, square_of(n, true));
    const ScratchFile file("free.msh", plate.text());
    Scene run(scene(plate, file) +
              "fix move all nve\nvariable q atom x*y\nvariable v atom 0.001*v_q\n"
              "velocity all set NULL NULL v_v\nvariable w atom vz*v_q*mass\ncompute w all reduce "
              "sum v_w\nthermo_style custom step c_w ke\nthermo_modify norm no\nrun 0 post no\n");
    const double energy = run.evaluate("ke");
    double before = run.evaluate("c_w"), time = 0.0, first = 0.0, last = 0.0, drift = 0.0;
    for (int crossings = 0; crossings < 9;) {
      run.commands("run 2 post no\n");
      const double now = run.evaluate("c_w"), then = run.evaluate("time");
      if (now * before <= 0.0) {
        last = time + (then - time) * before / (before - now);
        if (crossings++ == 0) first = last;
      }
      before = now;
      time = then;
      drift = std::max(
          drift,
          std::fabs((run.evaluate("ke") + run.fix<FixMPMElements>("e")->stored_energy()) / energy -
                    1.0));
    }
    error[fine] = measured(strprintf("frequency, %d squares across", n),
                           8.0 * PI / (last - first) /
                               (13.468 * sqrt(plate.stiffness() / (DENSITY * plate.thickness)))) -
        1.0;
    EXPECT_LT(measured("change of energy", drift), 5e-4);
  }
  EXPECT_NEAR(error[1], 0.0, 0.02);
  EXPECT_LT(std::fabs(error[1]), 0.4 * std::fabs(error[0]));
}

// two pairs of opposite forces of 2 on a closed hemisphere: 0.0924 (R 10, t 0.04, E 6.825e7)
SERIAL_TEST(Bending, PinchedHemisphere)
{
  for (const int divisions : first_of(1, {2, 3})) {
    const double F = 0.02, R = 10.0;
    const ThinMesh half = {{{R, 0, 0}, {-R, 0, 0}, {0, R, 0}, {0, -R, 0}, {0, 0, R}},
                           {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}}};
    const Plate shell(0.04, 6.825e7, 0.3, divided(half, divisions, R));
    std::string load = "fix move all nve\n";
    const char *const places[] = {"9.99 INF INF INF", "INF -9.99 INF INF", "INF INF 9.99 INF",
                                  "INF INF INF -9.99"};
    for (int k = 0; k < 4; k++)
      load += strprintf("region p%d block %s INF INF\ngroup p%d region p%d\nfix f%d p%d addforce ",
                        k, places[k], k, k, k, k) +
          strprintf(k < 2 ? "%g 0 0\n" : "0 %g 0\n", k == 0 || k == 3 ? F : -F);
    const double u = in_equilibrium(shell, 4.0, load, "compute w p0 reduce ave c_u[1]\n");
    const double ratio =
        measured(strprintf("displacement, %d elements in a quarter", 1 << divisions),
                 u / (0.0924 * F / 2.0));
    if (divisions == 3)
      EXPECT_NEAR(ratio, 1.0, 0.05);
    else
      EXPECT_NEAR(ratio, 1.19, 0.02);
  }
}

// two opposite forces on single nodes of a cylinder between rigid diaphragms: 1.8248e-5 for a force
// of 1 (R 300, length 600, t 3, E 3e6), with equal squares, twice as large as the dent that is
// sqrt(R t) wide, whose diagonals are parallel or change direction
SERIAL_TEST(Bending, PinchedCylinder)
{
  const int around = 32, rows = 10;
  const double R = 300.0, L = 600.0, F = 1000.0;
  for (const int kind : first_of(1, {0, 1, 2})) {
    const bool alternate = kind == 1, shifted = kind == 2;    // rows by half an edge
    Plate shell(3.0, 3e6, 0.3);
    if (shifted) shell.bending = "linear";
    for (int j = 0; j <= rows; j++)
      for (int i = 0; i < around; i++) {
        const double angle = 2.0 * PI * (i + (shifted && j % 2 == 0 ? 0.5 : 0.0)) / around;
        shell.x.push_back({R * cos(angle), R * sin(angle), ((double) j / rows - 0.5) * L});
        if (j == rows) continue;
        const int a = j * around + i, b = j * around + (i + 1) % around;
        const bool other = alternate ? (i + j) % 2 : shifted && j % 2 == 1;
        shell.elements.push_back({a, b, other ? a + around : b + around});
        shell.elements.push_back({other ? b : a, b + around, a + around});
      }
    std::string load = "region span block INF INF INF INF -299 299\ngroup span region span\n"
                       "group ends subtract all span\nfix move all nve\n";
    for (int k = 0; k < 2; k++)
      load += strprintf("region p%d block %s -1 1 -1 1\ngroup p%d region p%d\n"
                        "fix f%d p%d addforce %g 0 0\n",
                        k, k ? "INF -299" : "299 INF", k, k, k, k, k ? F : -F);
    const double u = in_equilibrium(
        shell, 0.2, load, "fix hold ends setforce 0 0 NULL\ncompute w p1 reduce ave c_u[1]\n");
    EXPECT_NEAR(measured(strprintf("displacement, 32 squares around%s",
                                   alternate     ? ", alternate"
                                       : shifted ? ", shifted rows, linear"
                                                 : ""),
                         u / (1.8248e-5 * F)),
                1.0, 0.05);
  }
}

// a force on one node of a supported square, 0.0116008 F L^2/D, also where nodes are moved
SERIAL_TEST(Bending, ForceOnOneNode)
{
  const int n = 10;
  const double t = 0.1, w0 = 0.01 * t, in = 0.49;
  for (const auto &[disorder, bending, tolerance] :
       {std::tuple(0.0, "yes", 0.035), std::tuple(0.2, "yes", 0.045),
        std::tuple(0.0, "linear", 0.01), std::tuple(0.2, "linear", 0.01)}) {
    const double moves = disorder;
    const auto place = [=](double u, double v) {
      const bool moved =
          u > 0.01 && v > 0.01 && u < 0.99 && v < 0.99 && hypot(u - 0.5, v - 0.5) > 0.01;
      const double by = moved ? moves / n : 0.0;
      return Node{u - 0.5 + by * sin(70.0 * u * v * n), v - 0.5 + by * cos(50.0 * u + 30.0 * v),
                  0.0};
    };
    Plate plate(t, 1e6, 0.3, sheet_of(n, n, place));
    plate.bending = bending;
    const double D = plate.stiffness(),
                 w = -in_equilibrium(
                     plate, 2.0 * PI * PI * sqrt(D / (DENSITY * t)),
                     strprintf("region span block %g %g %g %g INF INF\ngroup span region span\n"
                               "group rim subtract all span\nfix move all nve\n"
                               "region p block -0.01 0.01 -0.01 0.01 INF INF\ngroup p region p\n"
                               "fix load p addforce 0 0 %.17g\n",
                               -in, in, -in, in, -w0 * D / 0.0116008),
                     "fix hold rim setforce NULL NULL 0\ncompute w all reduce min c_u[3]\n");
    EXPECT_NEAR(measured(strprintf("deflection, 10 squares across, moved by %g, bending %s",
                                   disorder, bending),
                         w / w0),
                1.0, tolerance);
  }
}

// the Scordelis-Lo roof under a hundredth of its weight: 0.3024 for all of it at its free edges
SERIAL_TEST(Bending, ScordelisLoRoof)
{
  LONG_CASE();
  double w[2];
  for (int fine = 0; fine < 2; fine++) {
    const int n = fine ? 20 : 10;
    const double R = 25.0, L = 50.0, top = 80.0 * PI / 180.0;
    const auto place = [=](double u, double v) {
      return Node{(v - 0.5) * L, R * sin((u - 0.5) * top), R * cos((u - 0.5) * top)};
    };
    const Plate roof(0.25, 4.32e8, 0.0, sheet_of(n, n, place));
    w[fine] =
        -in_equilibrium(
            roof, 30.0,
            strprintf(
                "region span block %g %g INF INF INF INF\ngroup span region span\n"
                "group ends subtract all span\nfix move all nve\n"
                "fix load all gravity %.17g vector 0 0 -1\nregion p block -0.1 0.1 INF INF INF %g\n"
                "group p region p\n",
                -L / 2 + 0.1, L / 2 - 0.1, 0.9 / (DENSITY * 0.25), R * cos(0.5 * top) + 1e-3),
            "fix hold ends setforce NULL 0 0\ncompute w p reduce ave c_u[3]\n") /
        0.003024;
    measured(strprintf("deflection, %d elements across", n), w[fine]);
  }
  EXPECT_NEAR(w[1], 1.0, 0.05);
  EXPECT_LT(1.0 - w[1], 0.4 * (1.0 - w[0]));
}

// triangles with too few nodes around them for a curvature are told
SERIAL_TEST(Bending, WarnsOfRoughMeshes)
{
  const auto warnings = [](int n, double shift) {
    const auto place = [=](double u, double v) {
      return Node{u * (1.0 + shift * v), v, 0.0};
    };
    const Plate plate(0.1, 1e6, 0.3, sheet_of(n, n, place));
    const ScratchFile file("rough.msh", plate.text());
    return lines_that_say(scene(plate, file), "too few nodes around them").size();
  };
  EXPECT_EQ(warnings(1, 0.0), 0u);
  EXPECT_EQ(warnings(4, 0.5), 0u);
  EXPECT_EQ(warnings(1, 0.5), 1u);
}

// The nodes of a triangle and its neighbors may be ghosts of other ranks. Here the neighbors are
// the farthest ones, twice the edge of the triangle apart; stretched along that line by 4, as much
// as the norm of F says, they leave next to nothing of the room for more
SERIAL_TEST(Bending, GhostsAreAllNodesOfAPatch)
{
  const auto place = [](double u, double v) {
    return Node{2.0 * u - 0.5 * v, v, 0.0};
  };
  const Plate strip(0.05, 1e6, 0.3, sheet_of(2, 1, place));
  const ScratchFile file("strip.msh", strip.text());
  Scene run(replaced(scene(strip, file, 4.0), "comm_modify", "#") +
            "fix move all nve\nrun 0 post no\n");
  EXPECT_GE(measured("cutoff", run.lmp->comm->get_comm_cutoff()), 2.0);
  for (int i = 0; i < run.n(); i++) run.x()[i][0] *= 4.0;
  run.commands("run 0 post no\nrun 0 post no\n");
  EXPECT_GE(measured("cutoff", run.lmp->comm->get_comm_cutoff()), 8.0);
}

// a strip of lines rolled to half a circle without being stretched has the energy of bending alone,
// D angle^2/2 l for each corner, and no stress
SERIAL_TEST(Bending, RolledStripHasNoMembraneStress)
{
  const int n = 20;
  const double young = 1e6, l = 1.0 / n, angle = PI / n, R = 0.5 * l / sin(0.5 * angle);
  const Plate strip(0.05, young, 0.3, line(n, {0, 0, 0}, {1, 0, 0}));
  const ScratchFile file("strip.msh", strip.text());
  Scene run(replaced(scene(strip, file, 0.8), "linear", "neohookean") +
            "fix move all nve\nrun 0 post no\n");
  for (const double stretch : {1.0, 1.001}) {
    for (int i = 0; i < run.n(); i++) {
      const double at = (run.lmp->atom->tag[i] - 1) * angle;
      run.x()[i][0] = stretch * R * sin(at);
      run.x()[i][1] = stretch * R * (1.0 - cos(at));
    }
    run.commands("run 0 post no\n");
    double worst = 0.0;
    for (int i = 0; i < run.n(); i++)
      for (int c = 0; c < 6; c++) worst = std::max(worst, std::fabs(run.points().tau[i][c]));
    const double energy = (n - 1) * strip.stiffness() * angle * angle / (2.0 * l),
                 stored = run.fix<FixMPMElements>("e")->stored_energy();
    if (stretch == 1.0) {
      EXPECT_LT(measured("stress over Young's modulus", worst / young), 1e-12);
      EXPECT_NEAR(measured("energy of bending", stored / energy), 1.0,
                  1e-5);    // by a modulus that is found numerically
    } else
      EXPECT_NEAR(measured("stress of a stretch by 0.001", 0.91 * worst / young), 1e-3, 1e-5);
  }
}

/** Neck of a sheet between two rings of radius 1, 2 h apart, that is stretched from a cylinder
 *  whose length over its diameter is ratio, 8 times as small. */
static double neck(double h, double ratio, int rows)
{
  const double small = 1.0 / 8.0, length = 2.0 * ratio * small;
  const int around = 2 * (int) std::round(PI * rows / (2.0 * ratio));
  ThinMesh film;
  for (int j = 0; j <= rows; j++)
    for (int i = 0; i < around; i++) {
      const double angle = 2.0 * PI * i / around;
      film.x.push_back(
          {small * cos(angle), small * sin(angle), ((double) j / rows - 0.5) * length});
      if (j == rows) continue;
      const int a = j * around + i, b = j * around + (i + 1) % around;
      film.elements.push_back({a, b, b + around});
      film.elements.push_back({a, b + around, a + around});
    }
  const ScratchFile file("film.msh", film.text());
  Scene run(with_map(space("si", "f f f", "-2 2 -2 2 -1 1", 1, 0.1)) +
            "comm_modify cutoff 1.5\ncreate_points 1 mesh " + file.name +
            " thickness 0.01\nfix m all mpm/material density 1 neohookean 1 0.3\n"
            "fix e all mpm/elements " +
            file.name + " thickness 0.01\nfix dt all mpm/dt 0.8\n" +
            strprintf("region span block INF INF INF INF %.17g %.17g\ngroup span region span\n"
                      "region waist block INF INF INF INF %.17g %.17g\ngroup waist region waist\n",
                      -0.499 * length, 0.499 * length, -0.01 * length, 0.01 * length) +
            strprintf("run 0 post no\nvariable X atom 8*x\nvariable Y atom 8*y\nvariable Z atom "
                      "z*%.17g\nset group all x v_X y v_Y z v_Z\n",
                      2.0 * h / length) +
            "fix move span nve\nfix damp all viscous $(mass(all)/count(all)*16)\n"
            "variable r atom sqrt(x*x+y*y)\ncompute r waist reduce ave v_r\n"
            "thermo_style custom step c_r\nrun 0 post no\n");
  while (run.evaluate("time") < 1.5) run.commands("run 20 post no\n");
  return run.evaluate("c_r");
}

// A sheet of neohookean that is stretched far has the energy of the squares of its stretches, which
// is least for a surface of least area where all directions are stretched alike (Douglas 1931). A
// catenoid is so from a cylinder whose length over its diameter is h over the radius of the neck. A
// soap film between rings of radius 1 is none above h = 0.6627434
SERIAL_TEST(ThinElements, SoapFilm)
{
  EXPECT_NEAR(measured("neck for h = 0.5, 6 rows", neck(0.5, 0.5 / 0.848338, 6) / 0.848338), 1.0,
              0.002);
  EXPECT_NEAR(measured("neck for h = 0.5, 12 rows", neck(0.5, 0.5 / 0.848338, 12) / 0.848338), 1.0,
              0.0005);
  for (const double h : {0.6, 0.7}) {
    double radius = 1.0;
    for (int k = 0; k < 14 && radius > 0.4; k++) radius = neck(h, h / radius, 8);
    measured(strprintf("neck for h = %g", h), radius);
    if (h < 0.66)
      EXPECT_NEAR(radius / 0.745071, 1.0, 0.01);
    else
      EXPECT_LT(radius, 0.4);
  }
}
