// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 600

// Membranes, strips, and cables of fix mpm/elements, gas of fix mpm/airbag (benchmarks R and V).

#include "elements/fix_mpm_elements.h"
#include "elements/thin_testing.h"

using namespace MPM_TEST;

/** A sphere of radius R. mixed: every other triangle goes around the other way. */
static std::string sphere(int divisions, double R, bool mixed = false,
                          const std::vector<Node> &centers = {{0.0, 0.0, 0.0}})
{
  ThinMesh one = octahedron(divisions, R), all;
  for (std::size_t k = 0; mixed && k < one.elements.size(); k += 2)
    std::swap(one.elements[k][0], one.elements[k][1]);
  for (const Node &c : centers) {
    const int first = (int) all.x.size();
    for (const auto &t : one.elements)
      all.elements.push_back({first + t[0], first + t[1], first + t[2]});
    for (const Node &p : one.x) all.x.push_back({c[0] + p[0], c[1] + p[1], c[2] + p[2]});
  }
  return all.text();
}

/** Two disks of triangles in rings, at z = 1e-4 and -1e-4, with one rim, at z = 0. */
static std::string two_disks(int rings, double radius)
{
  ThinMesh disk = rings_of_triangles(rings, radius), all = disk;
  const int inner = 1 + 3 * rings * (rings - 1), n = (int) disk.x.size();    // rim: [inner, n)
  for (int i = 0; i < inner; i++) {
    all.x[i][2] = 1e-4;
    all.x.push_back({disk.x[i][0], disk.x[i][1], -1e-4});
  }
  for (auto t : disk.elements) {
    for (int &node : t)
      if (node < inner) node += n;
    all.elements.push_back({t[1], t[0], t[2]});
  }
  return all.text();
}

/** A disk of triangles in rings, normal to z, or to that axis turned about y by an angle. */
static std::string disk(int rings, double radius, const Node &center, double angle = 0.0)
{
  ThinMesh mesh = rings_of_triangles(rings, radius);
  for (Node &p : mesh.x)
    p = {center[0] + p[0] * cos(angle), center[1] + p[1], center[2] - p[0] * sin(angle)};
  return mesh.text();
}

/** Mean distance of points from 0. */
static double radius(Scene &run)
{
  double sum = 0.0;
  const auto all = run.gather();
  for (const auto &s : all) sum += sqrt(s.x[0] * s.x[0] + s.x[1] * s.x[1] + s.x[2] * s.x[2]);
  return sum / all.size();
}

/** A soft balloon, with or without a lattice. */
static std::string balloon_under_pressure(const std::string &file, bool lattice)
{
  return (lattice ? box(3, -0.3, 0.3, 0.05, "transfer flip 0.99")
                  : MPM_TEST::box(3, "si", "f f f", "-0.3 0.3 -0.3 0.3 -0.3 0.3", 1, 0.02)) +
      thin_body(file, "thickness 0.001", "neohookean 1e5 0.3", "compression no") +
      (lattice ? "" : "fix move all nve\n");
}

// Forces are minus the gradient of the energy at large motions of all nodes, with and without
// compression, and with a gas inside, whose work is p dV
TEST(ThinElements, ForcesAreTheGradientOfEnergy)
{
  const struct {
    int dim;
    const char *thin, *more;
    std::string mesh;
    bool gas;
    const char *material = "neohookean 1000 0.3";
  } cases[] = {{3, "thickness 0.01", "", sheet(3, 0.3, true), false},
               {3, "thickness 0.01", "compression no", sheet(3, 0.3, true), false},
               {3, "thickness 0.01", "", sheet(3, 0.3, false), false},
               {3, "section 0.001", "compression no", hanging(8, 0.5, 2), false},
               {3, "section 0.001", "", hanging(8, 0.5, 2), false},
               {2, "thickness 0.01", "compression no", hanging(8, 0.5, 1), false},
               {3, "thickness 0.2", "bending yes", sheet(3, 0.3, true), false},
               {3, "thickness 0.1", "bending yes", sphere(2, 0.3), true},
               {3, "section 0.02", "bending yes", hanging(8, 1.0, 2), false},
               {2, "thickness 0.1", "bending yes", hanging(8, 0.5, 1), false},
               {3, "thickness 0.01", "compression no", sphere(2, 0.3), true},
               {3, "thickness 0.01", "axes 2 1 0.7 -1 1 0.2", sheet(3, 0.3, true), false,
                "woven 2000 1000 50 angle 80"},
               {3, "thickness 0.01", "axes 1 0 0 1 1 1", sheet(3, 0.3, false), false,
                "orthotropic 900 400 500 0.2 0.3 0.1 200 100 300 angle 20"}};
  for (const auto &c : cases) {
    SCOPED_TRACE(std::string(c.thin) + " " + c.more);
    ScratchFile file("thin.msh", c.mesh);
    const std::string input = box(c.dim, -1.2, 1.2, 0.1, "") +
        thin_body(file.name, c.thin, c.material, c.more) +
        (c.gas ? "fix b all mpm/airbag e gas 50 1.4 outside 20\n" : "") + "timestep 1e-6\nrun 0\n";
    const auto displaced = [&](double shift) {
      auto run = std::make_unique<Scene>(input);
      for (int i = 0; i < run->n(); i++) {
        const double t = run->lmp->atom->tag[i];
        for (int d = 0; d < c.dim; d++)
          run->x()[i][d] += 0.02 * sin(1.7 * t + 2.1 * d) + shift * cos(2.3 * t + 0.7 * d);
      }
      run->commands("run 0\n");
      return run;
    };
    double energy[2], work = 0.0;
    for (int side = 0; side < 2; side++) {
      auto run = displaced(side ? 1e-6 : -1e-6);
      const double gas =
          c.gas ? run->fix("b")->compute_vector(7) + 20.0 * run->fix("b")->compute_vector(1) : 0.0;
      energy[side] = sum_over_ranks(run->fix<FixMPMElements>("e")->stored_energy()) + gas;
    }
    auto run = displaced(0.0);
    for (int i = 0; i < run->n(); i++)
      for (int d = 0; d < c.dim; d++)
        work += run->fix<FixMPMElements>("e")->forces()[3 * i + d] *
            cos(2.3 * run->lmp->atom->tag[i] + 0.7 * d);
    EXPECT_NEAR(sum_over_ranks(work) / ((energy[0] - energy[1]) / 2e-6), 1.0, 2e-7);
  }
}

// A woven sheet pulled along its bias, lying anywhere in space: pin-jointed yarns turn towards each
// other, which is the deformation of a picture frame. Its energy is G gamma^2/2, and the forces on
// its end are M sqrt(2) sin(theta/2) per area when its sides are held; yarns add theirs
TEST(ThinElements, WovenTrellis)
{
  const double l = 0.3, t = 0.01, E = 2e6, G = 50.0, half = 0.6, gamma = 0.5 * PI - 2.0 * half;
  const double c = cos(0.8), s = sin(0.8);
  const double turn[3][3] = {{c, -0.6 * s, 0.8 * s}, {s, 0.6 * c, -0.8 * c}, {0.0, 0.8, 0.6}};
  for (const bool squares : {false, true})
    for (const double stretch : {1.0, 1.01}) {
      ScratchFile file("cloth.msh", sheet(6, l, !squares));
      Scene run(box(3, -1.2, 1.2, 0.1, "") +
                thin_body(file.name, "thickness 0.01", strprintf("woven %g %g %g", E, 0.5 * E, G),
                          "axes 1 1 0.3 -1 1 0.2") +
                "timestep 1e-6\nrun 0\n");
      for (int i = 0; i < run.n(); i++) {
        double *const x = run.x()[i];
        const double flat[2] = {stretch * sqrt(2.0) * cos(half) * x[0],
                                stretch * sqrt(2.0) * sin(half) * x[1]};
        for (int d = 0; d < 3; d++) x[d] = turn[d][0] * flat[0] + turn[d][1] * flat[1];
      }
      run.commands("run 0\n");
      const double longer = stretch - 1.0, volume = l * l * t;
      const double energy = volume * (0.5 * G * gamma * gamma + 0.75 * E * longer * longer);
      EXPECT_NEAR(sum_over_ranks(run.fix<FixMPMElements>("e")->stored_energy()) / energy, 1.0,
                  1e-11);
      double along = 0.0, across = 0.0;
      for (int i = 0; i < run.n(); i++)
        for (int d = 0; d < 3 && run.lmp->atom->tag[i] % 7 == 0; d++) {
          const double f = run.fix<FixMPMElements>("e")->forces()[3 * i + d];
          along -= f * turn[d][0];
          across -= f * turn[d][2];
        }
      const double expected = l * t *
          (G * gamma * sqrt(2.0) * sin(half) / stretch + 1.5 * E * longer * cos(half) / sqrt(2.0));
      EXPECT_NEAR(sum_over_ranks(along) / expected, 1.0, 2e-9);
      EXPECT_NEAR(sum_over_ranks(across) / expected, 0.0, 1e-12);
    }
}

// a cable between two clamps (H.M. Irvine, Cable Structures (1981)), sag .39978 for EA/W = 102
SERIAL_TEST(ThinElements, Catenary)
{
  LONG_CASE();
  double sag[2];
  for (const int fine : {0, 1}) {
    const double h = fine ? 0.01 : 0.02;
    ScratchFile file("cable.msh", hanging(100, 0.5, 1));
    Scene run(
        box(2, -0.8, 0.8, h, "transfer flip 0.99") +
        thin_body(file.name, "thickness 0.001", "neohookean 1e6 0", "compression no") +
        strprintf("region a sphere 0 0 0 %g\nregion b sphere 0.5 0 0 %g\n", 2.2 * h, 2.2 * h) +
        "fix a all mpm/boundary region a stick\nfix b all mpm/boundary region b stick\n"
        "fix g all gravity 9.81 vector 0 -1 0\nfix dt all mpm/dt 0.5\nfix rest all mpm/relax 1e-3\n"
        "run 20000\n");
    double low = 0.0;
    for (const auto &s : run.gather()) low = std::min(low, s.x[1]);
    sag[fine] = measured("sag", -low);
  }
  EXPECT_NEAR(sag[0] / 0.39978, 1.0, 0.01);
  EXPECT_NEAR(sag[1] / 0.39978, 1.0, 0.005);
  EXPECT_LT(std::fabs(sag[1] - 0.39978), 0.6 * std::fabs(sag[0] - 0.39978));
}

// the lowest vibration of a chain that hangs from a clamp (R3): 1.2024128 sqrt(g/L)
SERIAL_TEST(ThinElements, HangingChain)
{
  LONG_CASE();
  const double h = 0.04;
  ScratchFile file("chain.msh", line(50, {0, 0, 0}, {0, -1, 0}).text());
  Scene run(
      MPM_TEST::box(2, "si", "f f f", "-0.4 0.4 -1.2 0.16", 1, 0.5 * h) +
      "fix grid all mpm 0.04 transfer flip 1.0 gain ignore\n" +
      thin_body(file.name, "thickness 0.001", "neohookean 1e7 0", "compression no") +
      "region a block -1 1 0 1 INF INF\nfix a all mpm/boundary region a stick\n"
      "fix g all gravity 9.81 vector 0 -1 0\nfix dt all mpm/dt 0.5\nfix rest all mpm/relax 1e-4\n"
      "run 4000\nunfix rest\nvariable q atom "
      "1-1.4457965*(1+y)+0.5225818*(1+y)^2-0.08394931*(1+y)^3\n"
      "variable v atom 0.05*v_q\nvelocity all zero linear\nvelocity all set v_v NULL NULL\n"
      "variable w atom vx*v_q\ncompute w all reduce ave v_w\nthermo_style custom step c_w\nrun "
      "0\n");
  const double start = run.evaluate("time"), quarter = time_of_zero(run, "c_w", 50) - start;
  EXPECT_NEAR(measured("frequency", 0.5 * PI / quarter / sqrt(9.81)) / 1.2024128, 1.0, 0.01);
}

// a block falls on a strip, both on the lattice: weights by volume and gap hold it
SERIAL_TEST(Sheet, HoldsABlock)
{
  ScratchFile file("strip.msh", line(16, {-0.4, 0, 0}, {0.4, 0, 0}).text());
  const auto falls = [&](const std::string &contact) {
    return MPM_TEST::box(2, "si", "f f p", "-0.6 0.6 -0.5 0.6 -0.1 0.1", 2, 0.02) +
        "group strip empty\ngroup block empty\nfix a strip mpm 0.05 transfer flip 0.97\n"
        "fix b block mpm 0.05 transfer flip 0.97\ncreate_points 1 mesh " +
        file.name +
        " thickness 0.002 group strip\nregion b block -0.15 0.15 0.03 0.23 INF INF\n"
        "create_points 2 region b ppc 2 fix b group block\n"
        "fix m strip mpm/material density 1000 neohookean 1e7 0.3\n"
        "fix s block mpm/material density 1000 neohookean 1e6 0.3\nfix e strip mpm/elements " +
        file.name + " thickness 0.002 compression no\nfix c all mpm/contact a b " + contact +
        "\nregion in block -0.33 0.33 INF INF INF INF side out\nfix hold all mpm/boundary region "
        "in "
        "stick\nfix g all gravity 9.81 vector 0 -1 0\nfix v all viscous 3\n";
  };
  Scene run(falls("gap no normal volume") + "fix dt all mpm/dt 0.4 until 0.3\nrun 5000\n");
  const double below = run.evaluate("bound(strip,ymin)") - (run.evaluate("xcm(block,y)") - 0.1);
  EXPECT_NEAR(measured("lower face below the strip", below), -0.02, 0.02);
  EXPECT_GT(run.evaluate("f_c[1][2]"), 588.0);    // its weight
  for (const auto &[contact, times] :
       {std::pair("", 1u), std::pair("gap yes 0.5", 1u), std::pair("gap yes normal volume", 1u),
        std::pair("gap yes 0.5 normal volume", 0u), std::pair("gap no normal volume", 0u)}) {
    const auto said =
        lines_that_say(falls(contact) + "velocity block set 0 -1 0\ntimestep 1e-4\nrun 400\n",
                       "pass through what is so thin");
    EXPECT_EQ(said.size(), times) << contact;
  }
  EXPECT_EQ(lines_that_say(replaced(falls(""), "0.03 0.23", "0.35 0.55") + "timestep 1e-4\nrun 1\n",
                           "pass through what is so thin")
                .size(),
            1u);
}

// a strip that falls on another one goes through it, at once without nodes that are full (gap yes)
// or with affine velocities, and slowly with gap no and flip. The log tells, also where the bodies
// are far from each other when the run starts
SERIAL_TEST(Sheet, DoesNotHoldAStrip)
{
  ScratchFile low("low.msh", line(16, {-0.4, 0, 0}, {0.4, 0, 0}).text()),
      near("near.msh", line(6, {-0.15, 0.1, 0}, {0.15, 0.1, 0}).text()),
      far("far.msh", line(6, {-0.15, 0.5, 0}, {0.15, 0.5, 0}).text());
  const auto falls = [&](const std::string &mesh, double thick, const std::string &contact) {
    const std::string size = strprintf(" thickness %g", thick);
    return MPM_TEST::box(2, "si", "f f p", "-0.6 0.6 -0.6 0.6 -0.1 0.1", 2, 0.02) +
        "group a empty\ngroup b empty\nfix a a mpm 0.05 transfer flip 0.97\nfix b b mpm 0.05 "
        "transfer flip 0.97\ncreate_points 1 mesh " +
        low.name + " thickness 0.002 group a\ncreate_points 2 mesh " + mesh + size +
        " group b\nfix m all mpm/material density 1000 neohookean 1e7 0.3\nfix ea a mpm/elements " +
        low.name + " thickness 0.002 compression no\nfix eb b mpm/elements " + mesh + size +
        "\nfix c all mpm/contact a b " + contact +
        "\nregion in block -0.33 0.33 INF INF INF INF side out\nfix hold all mpm/boundary region "
        "in stick\nfix g all gravity 9.81 vector 0 -1 0\nfix v all viscous 0.1\n";
  };
  const auto above = [&](const std::string &transfer, const std::string &contact) {
    Scene run(replaced(falls(near.name, 0.01, contact), "flip 0.97", transfer) +
              "fix dt all mpm/dt 0.4 until 0.3\nrun 5000\n");
    return measured("above", run.evaluate("bound(b,ymin)-bound(a,ymin)"));
  };
  for (const std::string normal : {"colinear", "volume"}) {
    EXPECT_NEAR(above("flip 0.98", "gap no normal " + normal) / 0.05, 1.75, 0.4);
    EXPECT_LT(above("apic", "gap no normal " + normal), 0.0);
  }
  EXPECT_LT(above("flip 0.98", "gap yes 0.5 normal volume"), -0.1);
  const auto warnings = [&](const std::string &mesh, double thick, const std::string &contact,
                            const std::string &text) {
    return lines_that_say(falls(mesh, thick, contact) + "timestep 1e-5\nrun 2\nrun 2\n", text)
        .size();
  };
  const std::string never = "never touch: where they meet", soon = "for a short time only";
  for (const auto &mesh : {near.name, far.name}) {    // one in each run
    EXPECT_EQ(warnings(mesh, 0.01, "", never), 2u);
    EXPECT_EQ(warnings(mesh, 0.01, "gap yes 0.5 normal volume", never), 2u);
    EXPECT_EQ(warnings(mesh, 0.05, "gap yes 0.5 normal volume", never),
              0u);    // as thick as a cell
    EXPECT_EQ(warnings(mesh, 0.01, "gap no", soon), 2u);
    EXPECT_EQ(warnings(mesh, 0.08, "gap no", soon), 0u);
  }
}

// two square sheets that lie on each other, sewn together along their edges (R4): in fields of
// their own they part, and become a cushion of 0.1213 m^3
SERIAL_TEST(Airbag, SheetsInFieldsOfTheirOwnPart)
{
  LONG_CASE();
  const int n = 24;
  std::vector<Node> x;
  std::vector<std::vector<int>> f;
  std::map<std::array<int, 3>, int> place;
  const auto node = [&](int i, int j, int side) {
    const bool seam = std::min(i, j) == 0 || std::max(i, j) == n;
    const auto found = place.emplace(std::array<int, 3>{i, j, seam ? 0 : side}, (int) x.size());
    if (found.second)
      x.push_back({0.84 * i / n - 0.42, 0.84 * j / n - 0.42, seam ? 0.0 : 1e-6 * side});
    return found.first->second;
  };
  for (const int side : {1, -1})
    for (int i = 0; i < n; i += 2)
      for (int j = 0; j < n; j += 2) {
        const int c[4] = {node(i, j, side), node(i + 2, j, side), node(i + 2, j + 2, side),
                          node(i, j + 2, side)};
        for (int k = 0; k < 4; k++) f.push_back({c[k], c[(k + 1) % 4], node(i + 1, j + 1, side)});
      }
  ScratchFile file("cushion.msh", gmsh(2, x, f));
  const auto volume = [&](bool together) {
    Scene run(
        MPM_TEST::box(3, "si", "f f f", "-0.6 0.6 -0.6 0.6 -0.4 0.4", 1, 0.02) +
        "create_points 1 mesh " + file.name + " thickness 0.0006\nvariable up atom z>-1e-9\n" +
        "group up variable up\ngroup down subtract all up\nvariable x atom 0.93*x\nvariable y atom "
        "0.93*y\n" +
        (together ? "fix a all mpm 0.06 transfer flip 0.95\n"
                  : "fix a up mpm 0.06 transfer flip 0.95\nfix b down mpm 0.06 transfer flip "
                    "0.95\n") +
        "fix m all mpm/material density 1000 neohookean 588e6 0.4\nfix e all mpm/elements " +
        file.name + " thickness 0.0006 compression no\nset group all x v_x y v_y\n" +
        "fix p all mpm/airbag e pressure 5000\nfix dt all mpm/dt 0.5\nfix v all viscous "
        "0.05\nrun " +
        (together ? "300\n" : "2500\n"));
    return run.fix("p")->compute_vector(1);
  };
  EXPECT_NEAR(measured("volume", volume(false)) / 0.1213, 1.0, 0.03);
  EXPECT_LT(measured("in one field", volume(true)), 0.01);
}

// free vibrations: a beam between its free ends (R5, 22.37329, plane strain), of lines and of
// triangles, and a circular plate with two nodal diameters (5.3583 for nu = 0.3: A.W. Leissa,
// Vibration of Plates, NASA SP-160 (1969), chapter 2). No clamp is there that could be in another
// place. The lattice makes waves slower, by a part that falls with the square of its spacing
SERIAL_TEST(Bending, FreeVibrations)
{
  const double E = 1e7, rho = 1000.0, t = 0.02;
  const auto frequency = [&](int dim, double nu, double h, const std::string &mesh,
                             const std::string &mode, double expected) {
    ScratchFile file("free.msh", mesh);
    Scene run(
        box(dim, -0.7, 0.7, h, "transfer flip 1.0") +
        thin_body(file.name, "thickness 0.02 ", strprintf("linear %g %g", E, nu), "bending yes") +
        "variable q atom " + mode + "\nvariable v atom 0.02*v_q\nvelocity all set " +
        (dim == 2 ? "NULL v_v NULL" : "NULL NULL v_v") +
        "\nfix dt all mpm/dt 0.5\nvariable w atom " + (dim == 2 ? "vy" : "vz") +
        "*v_q\ncompute w all reduce ave v_w\nthermo_style custom step c_w\nrun 0\n");
    // to the first time without velocity, a quarter of a period
    return PI / 2.0 / time_of_zero(run, "c_w", 20) / expected;
  };
  const double bl = 4.73004074, ratio = 0.982502215;
  const std::string s = strprintf("(x+0.5)*%.9g", bl),
                    mode = strprintf(
                        "0.5*(exp(%s)+exp(-%s))+cos(%s)-%.9g*(0.5*(exp(%s)-exp(-%s))+sin(%s))",
                        s.c_str(), s.c_str(), s.c_str(), ratio, s.c_str(), s.c_str(), s.c_str());
  const auto free_beam = [&](double h) {
    return measured("beam",
                    frequency(2, 0.3, h, line(40, {-0.5, 0.003, 0}, {0.5, 0.003, 0}).text(), mode,
                              22.37329 * t * sqrt(E / (12.0 * rho)) / sqrt(0.91)));
  };
  const double coarse = free_beam(0.05), fine = free_beam(0.025);
  EXPECT_NEAR(fine, 1.0, 0.02);
  EXPECT_NEAR((1.0 - coarse) / (1.0 - fine), 4.0, 1.0);

  const std::string plate = disk(10, 0.5, {0.007, 0.003, 0.004});
  const double D = E * t * t * t / (12.0 * 0.91);
  const auto free_plate = [&](double h) {
    return frequency(3, 0.3, h, plate, "(x-0.007)^2-(y-0.003)^2",
                     5.3583 * sqrt(D / (rho * t)) / 0.25);
  };
  const double coarse_plate = measured("plate", free_plate(0.05)),
               fine_plate = measured("plate", free_plate(0.025));
  EXPECT_NEAR(fine_plate, 1.0, 0.02);
  EXPECT_LT(1.0 - fine_plate, 0.5 * (1.0 - coarse_plate));
}

// a clamped circular membrane under pressure (R1, Hencky), clamped from 0.8 cells before the rim
SERIAL_TEST(ThinElements, HenckysMembrane)
{
  LONG_CASE();
  const double h = 0.05, a = 0.5;
  for (const double off : {0.0, 0.013}) {
    ScratchFile file("membrane.msh", disk(12, 0.62, {off, 0.7 * off, 0.4 * off}));
    Scene run(
        MPM_TEST::box(3, "si", "f f f", "-0.76 0.76 -0.76 0.76 -0.16 0.16", 1, 0.5 * h) +
        "fix grid all mpm 0.05 transfer flip 0.95\n" +
        thin_body(file.name, "thickness 1e-3", "linear 1e6 0.3") +
        strprintf("region c cylinder z %g %g %g -1 1 side out\n", off, 0.7 * off, a - 0.8 * h) +
        "fix c all mpm/boundary region c stick\nfix p all mpm/airbag e pressure 0.1\n"
        "fix dt all mpm/dt 0.5\nfix rest all mpm/relax 1e-3\nrun 6000\n");
    double high = 0.0;
    for (const auto &s : run.gather()) high = std::max(high, s.x[2] - 0.4 * off);
    EXPECT_NEAR(measured("W", high / (a * cbrt(0.1 * a / (1e6 * 1e-3)))) / 0.653443, 1.0, 0.015);
  }
}

// at any angle to the lattice to 2 %, and with the root of third order of the pressure (R1). A
// sphere clamps the rim, which is the same from all sides
SERIAL_TEST(ThinElements, HenckysMembraneAtAnyAngle)
{
  LONG_CASE();
  const double h = 0.05, a = 0.5;
  double high[2] = {0.0, 0.0};
  for (const auto &[degrees, q] :
       {std::pair(20.0, 0.1), std::pair(45.0, 0.1), std::pair(45.0, 0.8)}) {
    const double angle = degrees * PI / 180.0, n[3] = {sin(angle), 0.0, cos(angle)};
    ScratchFile file("membrane.msh", disk(12, 0.62, {0.0, 0.0, 0.0}, angle));
    Scene run(MPM_TEST::box(3, "si", "f f f", "-0.76 0.76 -0.76 0.76 -0.6 0.6", 1, 0.5 * h) +
              "fix grid all mpm 0.05 transfer flip 0.95\n" +
              thin_body(file.name, "thickness 1e-3", "linear 1e6 0.3") +
              strprintf("region c sphere 0 0 0 %g side out\n", a - 0.8 * h) +
              "fix c all mpm/boundary region c stick\n" +
              strprintf("fix p all mpm/airbag e pressure %g\n", q) +
              "fix dt all mpm/dt 0.8\nfix rest all mpm/relax 1e-3\nrun 4000\n");
    double &most = high[q > 0.5];
    most = 0.0;
    for (const auto &s : run.gather())
      most = std::max(most, s.x[0] * n[0] + s.x[1] * n[1] + s.x[2] * n[2]);
    EXPECT_NEAR(measured(strprintf("%g degrees, pressure %g: W", degrees, q),
                         most / (a * cbrt(q * a / (1e6 * 1e-3)))) /
                    0.653443,
                1.0, 0.02);
  }
  EXPECT_NEAR(measured("exponent", log(high[1] / high[0]) / log(8.0)), 1.0 / 3.0, 0.01);
}

// surfaces and cables have the waves of plane stress: for rubber their time step is not that of its
// compression. At the limit they shake for 1000 steps and do not gain energy, free and, with rims
// that are held, stretched by 3 along all axes, where the limit by moduli at rest is 1.5 times too
// long
SERIAL_TEST(ThinElements, TimeStepOfRubber)
{
  const struct {
    std::string mesh, thin, inner;
  } bodies[] = {{sheet(8, 0.4, true), "thickness 0.01", "block 0.01 0.39 0.01 0.39 -1 1"},
                {sheet(8, 0.4, false), "thickness 0.01", "block 0.01 0.39 0.01 0.39 -1 1"},
                {rings_of_triangles(5, 0.2).text(), "thickness 0.01", "cylinder z 0 0 0.19 -1 1"},
                {line(20, {0.0, 0.0, 0.0}, {0.4, 0.0, 0.0}).text(), "section 1e-4",
                 "block 0.01 0.39 -1 1 -1 1"}};
  for (const auto &body : bodies) {
    ScratchFile file("rubber.msh", body.mesh);
    double limit[2];
    for (const auto &[nu, stretch] :
         {std::pair(0.3, 1.0), std::pair(0.499, 3.0), std::pair(0.499, 1.0)}) {
      SCOPED_TRACE(body.inner + strprintf(", nu %g, stretch %g", nu, stretch));
      Scene run(
          with_map(MPM_TEST::box(3, "si", "f f f", "-2 2 -2 2 -2 2", 1, 0.05)) +
          thin_body(file.name, body.thin, strprintf("neohookean 1e5 %g", nu)) + "region inner " +
          body.inner + "\ngroup inner region inner\nfix move " + (stretch > 1.0 ? "inner" : "all") +
          " nve\nvariable v atom 1e-3*random(-1,1,7)\n" +
          "variable w atom 1e-3*random(-1,1,8)\nvelocity inner set v_v v_w 0\n" +
          strprintf(
              "displace_atoms all ramp x %g %g x -1 1\ndisplace_atoms all ramp y %g %g y -1 1\n",
              1.0 - stretch, stretch - 1.0, 1.0 - stretch, stretch - 1.0) +
          // the first run makes the stretch known
          "timestep 1e-6\nrun 0\nfix dt all mpm/dt 0.98 every 1000000\n"
          "thermo_style custom step ke f_e[1]\nthermo_modify norm no\nrun 0\n");
      limit[nu > 0.4] = run.lmp->update->dt;
      const double at_rest = run.evaluate("f_e[1]");
      double most[2] = {0.0, 0.0};
      for (int k = 0; k < 20; k++) {
        run.commands("run 50 post no\n");
        most[k / 10] =
            std::max(most[k / 10], run.evaluate("ke") + run.evaluate("f_e[1]") - at_rest);
      }
      EXPECT_LT(measured("gain", most[1] / most[0]), 1.2);
    }
    EXPECT_NEAR(measured("limit", limit[1] / limit[0]),
                body.thin[0] == 's' ? 1.0 : sqrt((1.0 - 0.499 * 0.499) / 0.91), 1e-3);
  }
}

// balloons (R2, V1): a stretch of 1.2 by a given pressure, and by either kind of gas
SERIAL_TEST(Airbag, Balloons)
{
  LONG_CASE();
  ScratchFile file("ball.msh", sphere(4, 0.1));
  const std::string rest = "fix dt all mpm/dt 0.4\nfix rest all mpm/relax 1e-4\nrun 3000\n";
  {
    Scene run(box(3, -0.3, 0.3, 0.02, "transfer flip 0.95") +
              thin_body(file.name, "thickness 0.001", "neohookean 1e5 0.3", "compression no") +
              strprintf("fix b all mpm/airbag e pressure %.10g\n", 0.844962 * 1e5 / 2.6 * 0.01) +
              rest);
    EXPECT_NEAR((measured("stretch", radius(run) / 0.1) - 1.0) / 0.2, 1.0, 0.02);
    double least = 1.0, most = 0.0;
    for (const auto &s : run.gather()) {
      const double r = sqrt(s.x[0] * s.x[0] + s.x[1] * s.x[1] + s.x[2] * s.x[2]);
      least = std::min(least, r);
      most = std::max(most, r);
    }
    EXPECT_LT(measured("sphericity", most / least - 1.0), 0.01);
  }
  for (const auto &[gamma, stretch, pressure] :
       {std::tuple(1.4, 0.00227733, 101352.050), std::tuple(1.0, 0.00315578, 101362.337)}) {
    Scene run(box(3, -0.3, 0.3, 0.02, "transfer flip 0.95") +
              thin_body(file.name, "thickness 0.001", "neohookean 2.98e5 0.49") +
              strprintf("fix b all mpm/airbag e gas 102325 %g outside 101325\n", gamma) + rest);
    EXPECT_NEAR((measured("stretch", radius(run) / 0.1) - 1.0) / stretch, 1.0, 0.03);
    EXPECT_NEAR(run.fix("b")->compute_vector(0) / pressure, 1.0, 1e-3);
    const double V = run.fix("b")->compute_vector(1);
    const double before = run.evaluate("f_b[2]");
    EXPECT_EQ(V, before);
  }
}

// a cube of quadrangles, or of triangles: volume, area, and the pressure on its sides, of which
// each corner has three quarters together
SERIAL_TEST(Airbag, CubeOfQuadrangles)
{
  const double a = 0.1, p = 50.0;
  const std::vector<Node> x = {{0, 0, 0}, {a, 0, 0}, {a, a, 0}, {0, a, 0},
                               {0, 0, a}, {a, 0, a}, {a, a, a}, {0, a, a}};
  const std::vector<std::vector<int>> sides = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                               {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  for (const bool triangles : {false, true}) {
    std::vector<std::vector<int>> faces = sides;
    if (triangles) {
      faces.clear();
      for (const auto &f : sides) {
        faces.push_back({f[0], f[1], f[2]});
        faces.push_back({f[0], f[2], f[3]});
      }
    }
    ScratchFile file("cube.msh", gmsh(triangles ? 2 : 3, x, faces));
    Scene run(box(3, -0.3, 0.3, 0.05, "") +
              thin_body(file.name, "thickness 0.001", "neohookean 1e5 0.3") +
              strprintf("fix b all mpm/airbag e gas %g 1.4 outside 1000\ntimestep 1e-6\nrun 0\n",
                        1000.0 + p));
    EXPECT_NEAR(run.fix("b")->compute_vector(1) / (a * a * a), 1.0, 1e-12);
    EXPECT_NEAR(run.fix("b")->compute_vector(2) / (6.0 * a * a), 1.0, 1e-12);
    double sum = 0.0;    // away from the middle of each axis
    for (int i = 0; i < run.n(); i++)
      for (int d = 0; d < 3; d++) {
        const double f = run.fix<FixMPMElements>("e")->forces()[3 * i + d],
                     out = run.x()[i][d] > 0.5 * a ? f : -f;
        if (!triangles) EXPECT_NEAR(out / (0.25 * p * a * a), 1.0, 1e-12);
        sum += out;
      }
    EXPECT_NEAR(sum / (6.0 * p * a * a), 1.0, 1e-12);
  }
}

// a balloon of 512 triangles that stand for the curved surface through their nodes (V1, gas of 3000
// Pa and nothing outside): at rest, the pressure of a neohookean balloon of the stretch that it
// has, for which that of the triangles alone is 1 % off; set free it keeps its energy
SERIAL_TEST(Airbag, CurvedBalloon)
{
  ScratchFile file("ball.msh", sphere(3, 0.1));
  double off[2];
  for (const bool curved : {false, true}) {
    Scene run(with_map(MPM_TEST::box(3, "si", "f f f", "-0.3 0.3 -0.3 0.3 -0.3 0.3", 1, 0.05)) +
              thin_body(file.name, "thickness 0.001", "neohookean 1e5 0.3",
                        curved ? "curved yes" : "curved no") +
              "fix gas all mpm/airbag e gas 1100 1.0\nfix dt all mpm/dt 0.5\nfix move all nve\n"
              "fix damp all viscous $(mass(all)/count(all)*200)\n"
              "thermo_style custom step f_gas ke f_e[1]\nthermo_modify norm no\nrun 2000\n");
    // p = 2 t sigma/R of a thin sphere by its energy: stretches s, s, and q across, without stress
    const double E = 1e5, nu = 0.3, mu = E / 2.6, lambda = E * nu / (1.3 * 0.4),
                 s = radius(run) / 0.1;
    double q = 1.0;
    for (int k = 0; k < 100; k++) {
      const double J = s * s * q, value = mu * (q * q - 1.0) + lambda * log(J);
      q -= value / (2.0 * mu * q + lambda / q);
    }
    const double tau = mu * (s * s - 1.0) + lambda * log(s * s * q),
                 p = 2.0 * 0.001 / 0.1 * tau / (s * s * s);
    off[curved] =
        measured(curved ? "pressure, curved" : "pressure of triangles", run.evaluate("f_gas") / p) -
        1.0;
    double sum[3] = {0.0}, all = 0.0;
    for (int i = 0; i < run.n(); i++)
      for (int d = 0; d < 3; d++) {
        sum[d] += run.lmp->atom->f[i][d];
        all += std::fabs(run.lmp->atom->f[i][d]);
      }
    for (const double f : sum) EXPECT_LT(std::fabs(f), 1e-12 * (all + 1.0));
    run.commands("unfix damp\nvariable v atom 5*y\nvelocity all set NULL v_v NULL\nrun 0\n");
    const double before = run.evaluate("ke") + run.evaluate("f_e[1]") - run.evaluate("f_e[3]"),
                 moving = run.evaluate("ke");
    run.commands("run 500\n");
    EXPECT_NEAR(run.evaluate("ke") + run.evaluate("f_e[1]") - run.evaluate("f_e[3]"), before,
                2e-3 * moving);
  }
  EXPECT_GT(std::fabs(off[0]), 5e-3);
  EXPECT_NEAR(off[1], 0.0, 1e-3);
}

// two equal balloons with one gas, so stiff that their volume is constant (V3): as large as each
// other they are unstable beyond the limit point, and one blows up the other after a disturbance of
// 0.1 %. Without a lattice, which the gas does not need
SERIAL_TEST(Airbag, TwoBalloonsBecomeUnequal)
{
  LONG_CASE();
  const double R = 0.1, unit = 1e3;    // of the pressure: mu t/R
  for (const auto &[start, small, large, pressure] :
       {std::tuple(1.5, 1.208483, 1.708275, 1.123660),
        std::tuple(2.0, 1.104530, 2.447018, 0.813515)}) {
    const ScratchFile file("balloons.msh", sphere(3, R, false, {{-0.3, 0, 0}, {0.3, 0, 0}}));
    const double p = 2.0 * (1.0 / start - pow(start, -7.0));
    Scene run(
        MPM_TEST::box(3, "si", "f f f", "-0.9 0.9 -0.5 0.5 -0.5 0.5", 1, 0.02) +
        thin_body(file.name, "thickness 0.001", "neohookean 2.98e5 0.49") +
        strprintf("variable s atom %g*(1+0.001*(x>0))\nvariable c atom 0.3*((x>0)-(x<0))\n"
                  "variable X atom v_c+v_s*(x-v_c)\nvariable Y atom v_s*y\nvariable Z atom v_s*z\n"
                  "set group all x v_X y v_Y z v_Z\n",
                  start) +
        strprintf("fix b all mpm/airbag e gas %.10g 1 outside 1e5\n", 1e5 + unit * p) +
        "variable fx atom -60*mass*vx\nvariable fy atom -60*mass*vy\nvariable fz atom -60*mass*vz\n"
        "fix slow all addforce v_fx v_fy v_fz\nfix move all nve\nfix dt all mpm/dt 0.4\nrun "
        "4000\n");
    double sum[2] = {0.0, 0.0};
    int n[2] = {0, 0};
    const auto all = run.gather();
    for (const int half : {0, 1}) {
      double center[3] = {0.0, 0.0, 0.0};
      for (const auto &s : all)
        if ((2 * s.tag > (int) all.size()) == half) {
          n[half]++;
          for (int d = 0; d < 3; d++) center[d] += s.x[d];
        }
      for (double &c : center) c /= n[half];
      for (const auto &s : all)
        if ((2 * s.tag > (int) all.size()) == half)
          sum[half] += sqrt(pow(s.x[0] - center[0], 2) + pow(s.x[1] - center[1], 2) +
                            pow(s.x[2] - center[2], 2));
    }
    EXPECT_NEAR(measured("stretch of the small one", sum[0] / n[0] / R) / small, 1.0, 0.015);
    EXPECT_NEAR(measured("stretch of the large one", sum[1] / n[1] / R) / large, 1.0, 0.015);
    EXPECT_NEAR(measured("pressure", (run.evaluate("f_b[1]") - 1e5) / unit) / pressure, 1.0, 0.015);
  }
}

// a balloon of two disks of foil that does not stretch, sewn together at their rims (R4, Mylar
// balloon): W.H. Paulsen, Am. Math. Monthly, 101, 953-958 (1994)
SERIAL_TEST(Airbag, MylarBalloon)
{
  LONG_CASE();
  const int rings = 12;
  const double A = 0.1, p = 100.0, t = 1e-3, E = 1e3 * p * A / t;
  const ScratchFile file("mylar.msh", two_disks(rings, A));
  Scene run(
      MPM_TEST::box(3, "si", "f f f", "-0.2 0.2 -0.2 0.2 -0.2 0.2", 1, 0.01) +
      thin_body(file.name, strprintf("thickness %g", t), strprintf("neohookean %g 0.3", E),
                "compression no") +
      // half blown up and slack: a flat bag has no volume
      strprintf("fix flat all store/state 0 x y z\n"
                "variable s atom (sqrt(f_flat[1]^2+f_flat[2]^2)+1e-12)/%g\n"
                "variable f atom 0.62*sin(0.5*PI*v_s)/v_s\n"
                "variable X atom v_f*f_flat[1]\nvariable Y atom v_f*f_flat[2]\n"
                "variable Z atom 0.4*%g*((f_flat[3]>0)-(f_flat[3]<0))*cos(0.5*PI*v_s)\n"
                "set group all x v_X y v_Y z v_Z\n",
                A, A) +
      strprintf("fix b all mpm/airbag e pressure %g\n", p) +
      "variable fx atom -60*mass*vx\nvariable fy atom -60*mass*vy\nvariable fz atom -60*mass*vz\n"
      "fix slow all addforce v_fx v_fy v_fz\nfix move all nve\nfix dt all mpm/dt 0.4\nrun 7000\n");
  const int first = 1 + 3 * rings * (rings - 1), n = 6 * rings;
  double rim = 0.0, high = 0.0;
  for (const auto &s : run.gather()) {
    if (s.tag > first && s.tag <= first + n) rim += hypot(s.x[0], s.x[1]) / n;
    high = std::max(high, std::fabs(s.x[2]));
  }
  EXPECT_NEAR(measured("radius", rim / A) / 0.7627598, 1.0, 0.01);
  EXPECT_NEAR(measured("thickness", high / rim) / 0.5990701, 1.0, 0.02);
  EXPECT_NEAR(measured("volume", run.evaluate("f_b[2]") / pow(A, 3)) / 1.2185242, 1.0, 0.015);
}

/** Gas as material points in a balloon on the same lattice (V1, 3000 Pa against nothing,
 *  adiabatic), around this place. */
static std::string balloon_with_points(const std::string &file, const std::string &place)
{
  return MPM_TEST::box(3, "si", "f f f", "-0.2 0.2 -0.2 0.2 -0.2 0.2", 2, 0.0125) +
      "fix grid all mpm 0.025 transfer apic\ncreate_points 1 mesh " + file +
      " thickness 0.001 move " + place + "\nregion in sphere " + place +
      " 0.1\ncreate_points 2 region in ppc 2 cut yes overlap yes\n"
      "group skin type 1\ngroup gas type 2\n"
      "fix m skin mpm/material density 1000 neohookean 2.98e5 0.49\n"
      "fix g gas mpm/material density 100 eos ideal/gas 1.4 pressure 3000\n"
      "fix e skin mpm/elements " +
      file + " thickness 0.001\nfix dt all mpm/dt 0.4\nfix rest all mpm/relax 1e-4\n";
}

// at two places in the lattice: nothing gets out, as skin and gas share their velocities, and the
// skin is stretched as by a gas of one state, within what four cells in the radius give
SERIAL_TEST(Airbag, GasAsPoints)
{
  LONG_CASE();
  ScratchFile file("ball.msh", sphere(4, 0.1));
  for (const double off : {0.0, 0.007}) {
    Scene run(balloon_with_points(file.name, strprintf("%g %g %g", off, 0.7 * off, 0.3 * off)) +
              "run 1400\n");
    double sum = 0.0, farthest = 0.0;
    int n = 0;
    for (const auto &s : run.gather()) {
      const double x = s.x[0] - off, y = s.x[1] - 0.7 * off, z = s.x[2] - 0.3 * off,
                   r = sqrt(x * x + y * y + z * z);
      if (s.type == 1) {
        sum += r;
        n++;
      } else
        farthest = std::max(farthest, r);
    }
    EXPECT_NEAR((measured("stretch", sum / n / 0.1) - 1.0) / 0.2489264, 1.0, 0.03);
    EXPECT_LT(measured("farthest gas", farthest), sum / n);
  }
}

// edges of 0.8 to 1.25 spacings let gas through
SERIAL_TEST(Airbag, GapsBetweenNodesAreTold)
{
  for (const int divisions : {3, 4}) {
    ScratchFile file("ball.msh", sphere(divisions, 0.1));
    Scene run(MPI_COMM_SELF);
    const auto log = log_of(run, balloon_with_points(file.name, "0 0 0") + "run 1\n");
    EXPECT_EQ(log.find("other points of the same fix mpm can go through it") != std::string::npos,
              divisions == 3);
  }
}

// gas through a vent (V2) of a heavy bag, without anything outside; then what comes in
SERIAL_TEST(Airbag, VentAndInflow)
{
  ScratchFile file("ball.msh", sphere(2, 0.5));
  const double R = 287.0, T = 300.0, area = 1e-3, tau = 1.0, gamma = 1.4;
  const auto bag = [&](const std::string &gas) {
    return box(3, -1.0, 1.0, 0.2, "") +
        thin_body(file.name, "thickness 1e5", "neohookean 1e5 0.3") +
        "variable rate equal 2*ramp(1,1)\nfix b all mpm/airbag e gas " +
        replaced(gas, "OF_AIR", strprintf("temperature %g %g", T, R)) + "\n";
  };
  Scene run(bag(strprintf("1e5 1.4 OF_AIR vent %g 0.8", area)) + "run 0\n");
  const double V = run.fix("b")->compute_vector(1), mass = run.fix("b")->compute_vector(3);
  EXPECT_NEAR(mass, 1e5 * V / (R * T), 1e-12 * mass);
  const double end = tau * V / (0.8 * 0.578704 * area * sqrt(gamma * R * T));
  run.commands(strprintf("timestep %.15g\nrun 4000\n", end / 4000));
  const auto entry = [&](int k) {
    return run.fix("b")->compute_vector(k);
  };
  EXPECT_NEAR(measured("pressure", entry(0) / 1e5) / 0.279082, 1.0, 3e-5);
  EXPECT_NEAR(entry(4) / T / 0.694444, 1.0, 2e-5);
  EXPECT_NEAR(entry(3) / mass / 0.401878, 1.0, 2e-5);
  EXPECT_NEAR((entry(3) + entry(6)) / mass, 1.0, 1e-12);

  Scene fill(bag("1e5 1.4 OF_AIR inflow v_rate 300") +
             strprintf("timestep %.15g\nrun 100\n", mass / 200.0));
  EXPECT_NEAR(fill.fix("b")->compute_vector(3) / mass, 2.0, 1e-12);
  EXPECT_NEAR(fill.fix("b")->compute_vector(4) / T, 1.2, 3e-5);
  EXPECT_NEAR(fill.fix("b")->compute_vector(5) / mass, 1.0, 1e-12);

  // a bag with half of the pressure outside sucks gas through the vent, which is open from the
  // start; the work of the gas outside makes it warmer
  Scene suck(bag("5e4 1.4 outside 1e5 OF_AIR vent 1e-2 1") + "timestep 1e-4\nrun 4000\n");
  EXPECT_NEAR(measured("pressure", suck.fix("b")->compute_vector(0) / 1e5), 1.0, 3e-6);
  EXPECT_NEAR(suck.fix("b")->compute_vector(5) / mass, 0.5 / gamma, 1e-3);
  EXPECT_NEAR(suck.fix("b")->compute_vector(4) / T, 2.0 * gamma / (gamma + 1.0), 4e-4);

  // a vent so wide that a step could let all gas through: the bag has the pressure outside at once
  Scene wide(bag("1.2e5 1.4 outside 1e5 OF_AIR vent 10 1") + "timestep 1e-4\nrun 10\n");
  const double held = wide.fix("b")->compute_vector(3);
  double most = 0.0;
  for (int k = 0; k < 20; k++) {
    wide.commands("run 1\n");
    most = std::max(most, std::fabs(wide.fix("b")->compute_vector(0) / 1e5 - 1.0));
  }
  EXPECT_LT(measured("pressure of a wide vent", most), 5e-5);
  EXPECT_NEAR(wide.fix("b")->compute_vector(3) / held, 1.0, 1e-3);
}

// mass and vents in all units: p V = m R T, and one unit of the time of the closed form
SERIAL_PARAMETER_TEST(AirbagUnits, EmptyAlike, const char *,
                      Values("si", "cgs", "metal", "real", "lj"))
{
  const ScratchFile file("ball.msh", sphere(2, 0.5));
  constexpr double P = 3.0, T = 300.0, R = 0.02, AREA = 1e-3, GAMMA = 1.4;
  Scene run(replaced(box(3, -1.0, 1.0, 0.2, ""), "units si", strprintf("units %s", GetParam())) +
            thin_body(file.name, "thickness 1e9", "neohookean 1e-3 0.3") +
            strprintf("fix b all mpm/airbag e gas %g %g temperature %g %g vent %g 0.8\nrun 0\n", P,
                      GAMMA, T, R, AREA));
  const auto *force = run.lmp->force;
  const auto entry = [&](int k) {
    return run.fix("b")->compute_vector(k);
  };
  const double V = entry(1), mass = entry(3), energy = P * V / force->nktv2p;
  EXPECT_NEAR(measured("mass over that of the gas", mass / (energy / (R * T))), 1.0, 1e-12);
  EXPECT_NEAR(entry(7) / (energy / (GAMMA - 1.0)), 1.0, 1e-12);
  const double sound = sqrt(GAMMA * R * T / force->mvv2e);
  run.commands(strprintf("timestep %.15g\nrun 1000\n", V / (0.8 * 0.578704 * AREA * sound) / 1000));
  EXPECT_NEAR(measured("pressure", entry(0) / P) / 0.279082, 1.0, 5e-6);
  EXPECT_NEAR(entry(4) / T / 0.694444, 1.0, 6e-6);
  EXPECT_NEAR(entry(3) / mass / 0.401878, 1.0, 5e-6);
  EXPECT_NEAR((entry(3) + entry(6)) / mass, 1.0, 1e-12);
}

// the summary of a run has the time step over the limit of elements, not of the lattice
SERIAL_TEST(Airbag, SummaryTellsTheLimit)
{
  const ScratchFile file("ball.msh", sphere(2, 0.1));
  const auto lines = lines_that_say(
      box(3, -0.3, 0.3, 0.05, "") + thin_body(file.name, "thickness 0.001", "neohookean 1e5 0.3") +
          "fix b all mpm/airbag e gas 1100 1.4 outside 1000\nfix d all mpm/dt 0.5\nrun 100\n",
      " of the limit ");
  ASSERT_EQ(lines.size(), 1u);
  const double share = std::stod(lines[0].substr(lines[0].find("at the end ") + 11));
  EXPECT_NEAR(measured("share of the limit", share), 0.5, 0.05);
}

// gas of 100 bar on both sides of a soft balloon is a spring 134 times as stiff as its skin: the
// time step knows, with and without a lattice, also before there is a first force: omega^2 = 3
// gamma p/(R rho t) of breathing, and that of the skin
TEST(Airbag, TimeStepKnowsTheGas)
{
  const ScratchFile file("ball.msh", sphere(3, 0.1));
  const double omega = sqrt(3.0 * 1.4 * 1.0e7 / (0.1 * 1000.0 * 0.001));
  for (const bool lattice : {true, false}) {
    Scene run(balloon_under_pressure(file.name, lattice) +
              "fix b all mpm/airbag e gas 1.0001e7 1.4 outside 1e7\nfix dt all mpm/dt 0.4\n"
              "thermo_modify norm no\nrun 0\n");
    const double first = run.lmp->update->dt;
    EXPECT_NEAR(measured("limit/that of the gas", first / 0.4 * omega / 2.0), 1.0, 0.01);
    run.commands("run 400\n");
    EXPECT_NEAR(run.lmp->update->dt / first, 1.0, 2e-4);
    // what the gas can give is that of 1000 Pa: half of the square of that over its stiffness
    EXPECT_LT(measured("energy", run.evaluate("ke")), 1e6 / (2.0 * 1.4 * 1.0e7) * 4.09e-3);
    EXPECT_NEAR(run.evaluate("f_b"), 500.0, 600.0);
  }
}

// the check of time steps, also where the skin alone would allow this one
SERIAL_TEST(Airbag, TimeStepAboveThatOfTheGas)
{
  const ScratchFile file("ball.msh", sphere(3, 0.1));
  const std::string gas = "fix b all mpm/airbag e gas 1.0001e7 1.4 outside 1e7\n";
  for (const bool lattice : {true, false}) {
    const auto failure = [&](const std::string &more) {
      Scene run;
      return run.error(balloon_under_pressure(file.name, lattice) + more + "run 10\n");
    };
    EXPECT_EQ(failure("timestep 1.5e-4\n"), "");
    EXPECT_THAT(failure(gas + "timestep 1.5e-4\n"), HasSubstr("by the stiffness of the gas in it"));
    EXPECT_THAT(failure(gas + "fix dt all mpm/dt 0.4 min 1e-4\n"),
                HasSubstr("or the gas of a fix mpm/airbag"));
  }
}

// a bag that lies across periodic faces holds what it holds elsewhere, and keeps it as it moves
TEST(Airbag, AcrossPeriodicFaces)
{
  ScratchFile file("ball.msh", sphere(2, 0.1));
  const auto volumes = [&](const char *move) {
    const std::string options = " thickness 0.001 move " + std::string(move);
    Scene run(MPM_TEST::box(3, "si", "p p p", "-0.3 0.3 -0.3 0.3 -0.3 0.3", 1, 0.02) +
              "fix grid all mpm 0.05 transfer flip 0.95\n" + "create_points 1 mesh " + file.name +
              options + "\nfix m all mpm/material density 1000 neohookean 1e5 0.3\n" +
              "velocity all set 2 0 0\nfix e all mpm/elements " + file.name +
              " thickness 0.001 compression no\n" +
              "fix b all mpm/airbag e gas 1013 1.4 outside 1000\ntimestep 5e-4\nrun 0\n");
    const double before = run.fix("b")->compute_vector(1);
    run.commands("run 100\n");
    return std::pair(before, run.fix("b")->compute_vector(1));
  };
  const auto [before, after] = volumes("0 0 0");
  for (const char *move : {"0.3 0.29 0", "0.25 -0.3 0.3"}) {
    const auto [here, later] = volumes(move);
    EXPECT_NEAR(here / before, 1.0, 1e-12) << move;
    EXPECT_NEAR(later / after, 1.0, 1e-4) << move;
  }
}

TEST(ThinElements, RanksAndRestart)
{
  const struct {
    int dim;
    const char *thin;
    std::string mesh, more;
    const char *options = "compression no";
    const char *law = "neohookean 1e5 0.3";
  } cases[] = {
      {3, "thickness 0.02", sheet(8, 0.4, true), "", "bending yes"},
      {2, "thickness 0.02", hanging(40, 0.5, 1), "", "bending yes"},
      {3, "thickness 0.001", sphere(3, 0.1),
       "fix b all mpm/airbag e gas 1200 1.4 outside 1000 temperature 300 287 vent 1e-4 1 opens "
       "50\n"},
      {3, "section 1e-5", hanging(40, 0.5, 2), "fix gr all gravity 9.81 vector 0 0.6 -0.8\n"},
      {3, "thickness 0.001", sheet(8, 0.4, true), "", "axes 1 2 0 -1 1 0",
       "woven 1e5 5e4 1e3 locking 10 1e4"},
      {2, "thickness 0.001", hanging(40, 0.5, 1), "fix gr all gravity 9.81 vector 0 -1 0\n"}};
  for (const auto &c : cases) {
    SCOPED_TRACE(c.thin);
    ScratchFile file("ranks.msh", c.mesh);
    ScratchFile own("serial.msh", c.mesh);
    const std::string start = box(c.dim, -0.6, 0.6, 0.05, "transfer flip 0.99") +
        thin_body(file.name, c.thin, c.law, c.options) + c.more +
        "velocity all set 0.3 0.2 0\nvelocity all ramp vx 0.0 2.0 x 0.0 0.5 sum yes\n"
        "timestep 0.0002\n";
    Scene serial(replaced(start, file.name, own.name) + "run 200\n", MPI_COMM_SELF);
    Continued run(start, 100, lines_again(start), 100);
    const auto state = run.whole.gather();
    EXPECT_LT(measured("ranks", difference(serial.gather(), state)), 1e-11);
    EXPECT_TRUE(identical(state, run.again.gather()));
  }
}

// the rows of the restart file take the place of those of the mesh before the limit of the time
// step is known; both together were twice as stiff in bending
TEST(ThinElements, StepOfBendingAfterARestart)
{
  ScratchFile file("bent.msh", sheet(8, 0.4, true));
  const std::string start = box(3, -0.6, 0.6, 0.05, "transfer flip 0.99") +
      thin_body(file.name, "thickness 0.02", "neohookean 1e5 0.3", "bending yes") +
      "velocity all set 0.3 0.2 0\nvelocity all ramp vx 0.0 2.0 x 0.0 0.5 sum yes\n"
      "fix d all mpm/dt 0.2\n";
  Continued run(start, 12, lines_again(start), 12);
  EXPECT_EQ(run.whole.lmp->update->dt, run.again.lmp->update->dt);
  EXPECT_TRUE(identical(run.whole.gather(), run.again.gather()));
}

SERIAL_TEST(ThinElements, BadInput)
{
  ScratchFile ball("ball.msh", sphere(2, 0.1)), mixed("mixed.msh", sphere(2, 0.1, true)),
      open("sheet.msh", sheet(4, 0.2, true)), line("line.msh", hanging(20, 0.5, 2));
  const auto failure = [&](const std::string &file, const std::string &thin,
                           const std::string &more, const std::string &bag,
                           const std::string &material = "neohookean 1e5 0.3") {
    Scene run;
    return run.error(box(3, -0.6, 0.6, 0.05, "") + thin_body(file, thin, material, more) + bag +
                     "timestep 1e-6\nrun 0\n");
  };
  const std::string gas = "fix b all mpm/airbag e gas 1e5 1.4\n", thick = "thickness 0.001";
  EXPECT_THAT(failure(ball.name, thick, "compression no", gas), "");
  EXPECT_THAT(failure(mixed.name, thick, "", gas), "");    // sides are made the same
  EXPECT_THAT(failure(open.name, thick, "", "fix b all mpm/airbag e pressure 10\n"), "");
  EXPECT_THAT(failure(open.name, thick, "", gas), HasSubstr("has a rim"));
  EXPECT_THAT(failure(line.name, "section 1e-5", "", gas), HasSubstr("has no surface"));
  EXPECT_THAT(failure(ball.name, "section 1e-5", "", ""), HasSubstr("no elements of dimension 1"));
  EXPECT_THAT(failure(ball.name, "", "", ""),
              HasSubstr("no elements of dimension 3, but 128 of dimension 2 (keywords thickness"));
  EXPECT_THAT(failure(ball.name, thick + " section 1", "", ""), HasSubstr("use one of them"));
  EXPECT_THAT(failure(ball.name, thick, "", "", "eos tait 1e5 7"),
              HasSubstr("surfaces or lines: it resists no shear"));
  EXPECT_THAT(failure(ball.name, thick, "locking fbar", ""), HasSubstr("is for solids"));
  EXPECT_THAT(failure(ball.name, thick, "compression no", "", "eos linear 1e5 strength j2 4e4 100"),
              HasSubstr("must be elastic"));
  ScratchFile squares("squares.msh", sheet(4, 0.2, false));
  EXPECT_THAT(failure(ball.name, thick, "bending yes", ""), "");
  EXPECT_THAT(failure(ball.name, thick, "bending yes compression no", ""),
              HasSubstr("exclude each other"));
  EXPECT_THAT(failure(ball.name, "", "bending yes", ""), HasSubstr("no elements of dimension 3"));
  EXPECT_THAT(failure(squares.name, thick, "bending yes", ""),
              HasSubstr("element 1 is a quadrangle"));
  EXPECT_THAT(failure(line.name, "section 1e-5", "bending yes", ""), HasSubstr("make an angle"));
  EXPECT_THAT(failure(ball.name, thick, "bending yes", "", "eos linear 1e5 strength j2 4e4 100"),
              HasSubstr("what resists bending: it must be elastic"));
  EXPECT_THAT(failure(ball.name, thick, "curved yes", gas), "");
  EXPECT_THAT(failure(ball.name, thick, "curved yes bending yes", gas), "");
  const std::vector<Node> corners = {{0, 0, 0},   {0.1, 0, 0},   {0.1, 0.1, 0},   {0, 0.1, 0},
                                     {0, 0, 0.1}, {0.1, 0, 0.1}, {0.1, 0.1, 0.1}, {0, 0.1, 0.1}};
  ScratchFile box_of_squares(
      "box.msh",
      gmsh(3, corners,
           {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}));
  EXPECT_THAT(failure(box_of_squares.name, thick, "", gas), "");
  EXPECT_THAT(failure(box_of_squares.name, thick, "curved yes", gas),
              HasSubstr("element 1 is a quadrangle: use triangles"));
  EXPECT_THAT(failure(open.name, thick, "curved yes", ""), HasSubstr("has a rim: use curved no"));
  EXPECT_THAT(failure(line.name, "section 1e-5", "curved yes", ""),
              HasSubstr("is for closed surfaces: use thickness"));
  const std::string cloth = "woven 1e5 1e5 1e3", plain = "axes 1 0 0 0 1 0";
  EXPECT_THAT(failure(open.name, thick, plain, "", cloth), "");
  EXPECT_THAT(failure(open.name, thick, "", "", cloth), HasSubstr("use the keyword axes"));
  EXPECT_THAT(failure(open.name, thick, plain, ""), HasSubstr("it is isotropic"));
  EXPECT_THAT(failure(open.name, thick, "axes 0 0 1 0 1 0", "", cloth),
              HasSubstr("all but normal to element 1 "));
  EXPECT_THAT(failure(open.name, thick, "axes 1 0 0 0 0 1", "", cloth),
              HasSubstr("all but normal to element 1 "));
  EXPECT_THAT(failure(open.name, thick, "axes 1 0 0 2 0 0", "", cloth), HasSubstr("not parallel"));
  EXPECT_THAT(failure(open.name, thick, plain + " compression no", "", cloth),
              HasSubstr("nor for compression no"));
  EXPECT_THAT(failure(open.name, thick, plain + " bending yes", "", cloth),
              HasSubstr("is not for bending"));
  EXPECT_THAT(failure(line.name, "section 1e-5", plain, ""), HasSubstr("is for surfaces in 3d"));
  EXPECT_THAT(failure(line.name, "section 1e-5", "", "", cloth), HasSubstr("for surfaces in 3d"));
  Scene points;
  EXPECT_THAT(points.error(box(3, -0.6, 0.6, 0.05, "") +
                           "create_points 1 box\nfix m all mpm/material density 1000 " + cloth +
                           "\ntimestep 1e-6\nrun 0\n"),
              HasSubstr("no nodes of one"));
  EXPECT_THAT(failure(ball.name, thick, "", "fix b all mpm/airbag x gas 1e5 1.4\n"),
              HasSubstr("no fix mpm/elements with ID x"));
  EXPECT_THAT(failure(ball.name, thick, "", "fix b all mpm/airbag e\n"),
              HasSubstr("needs either pressure or gas"));
  EXPECT_THAT(failure(ball.name, thick, "", "fix b all mpm/airbag e gas 1e5 0.9\n"),
              HasSubstr("0.9"));
  EXPECT_THAT(failure(ball.name, thick, "", "fix b all mpm/airbag e gas 1e5 1.4 vent 1 1\n"),
              HasSubstr("use temperature T R"));
  EXPECT_THAT(failure(ball.name, thick, "", "fix b all mpm/airbag e pressure 1 vent 1 1\n"),
              HasSubstr("are for gas"));
  EXPECT_THAT(failure(ball.name, thick, "", "fix b all mpm/airbag e gas 1e5 1.4 gas 2e5 1.4\n"),
              HasSubstr("gas is given twice"));
  EXPECT_THAT(failure(ball.name, thick, "", "fix b all mpm/airbag e pressure 1 pressure 2\n"),
              HasSubstr("pressure is given twice"));
  EXPECT_THAT(failure(ball.name, thick, "",
                      "variable in equal -2\nfix b all mpm/airbag e gas 1e5 1.4 temperature 300 "
                      "287 inflow v_in 250\ntimestep 1e-6\nrun 1\n"),
              HasSubstr("-2 and 250 at step 1"));
  // no vent lets pass more than the exact nozzle does: taken, but said
  const std::string vented = box(3, -0.6, 0.6, 0.05, "") + "create_points 1 mesh " + ball.name +
      " " + thick +
      "\nfix m all mpm/material density 1000 neohookean 1e5 0.3\nfix e all mpm/elements " +
      ball.name + " " + thick + "\nfix b all mpm/airbag e gas 1e5 1.4 temperature 300 287 vent 1 ";
  const std::string said = "above 1: more gas flows out than through a nozzle";
  EXPECT_EQ(lines_that_say(vented + "1.5\n", said).size(), 1u);
  EXPECT_EQ(lines_that_say(vented + "1\n", said).size(), 0u);
  EXPECT_THAT(failure(ball.name, thick, "", gas + "fix c all mpm/airbag e pressure 1\n"),
              HasSubstr("more than one fix mpm/airbag"));
  EXPECT_THAT(failure(ball.name, thick, "", "fix b all mpm/airbag e pressure v_none\n"),
              HasSubstr("none"));
  EXPECT_THAT(failure(ball.name, thick, "",
                      "unfix e\nfix e all mpm/elements " + ball.name + " thickness 0.002\n"),
              HasSubstr("volume"));
}
