// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Fix mpm/deform: periodic cells along paths of mean strain and stress.

#include "mpm_lammps.h"

#include "material/material_point.h"

using namespace MPM_TEST;

/** A cell full of points of one material. */
static std::string cell(int dim, const std::string &units, const std::string &material,
                        const std::string &more = "", const char *edges = "0 4 0 3 0 2")
{
  return box(dim, units, "p p p", edges, 1, 0.3) + "fix grid all mpm 1.0 frame total " + more +
      "\ncreate_points 1 box ppc 2\nfix m all mpm/material " + material + "\n";
}

enum { XX, YY, ZZ, XY, XZ, YZ };

/** Entry of the vector of the fix cell: deformation gradient, true, and nominal stress. */
static double mean_F(Scene &run, int part)
{
  return run.fix("cell")->compute_vector(part);
}
static double mean_stress(Scene &run, int part)
{
  return run.fix("cell")->compute_vector(6 + part);
}
static double mean_nominal(Scene &run, int part)
{
  return run.fix("cell")->compute_vector(12 + part);
}

// In a cell of one material all points have the mean deformation, and the mean stress is that of
// the law along the same path: an elastic and a plastic solid, all components
struct Homogeneous {
  int dim;
  const char *options, *material;
  friend void PrintTo(const Homogeneous &h, std::ostream *out)
  {
    *out << h.dim << "d " << h.options << " " << h.material;
  }
};
SERIAL_PARAMETER_TEST(Law, IsThatOfTheMaterial, Homogeneous,
                      Values(Homogeneous{3, "", "density 1.0 neohookean 100 0.3"},
                             Homogeneous{2, "", "density 1.0 neohookean 100 0.3"},
                             Homogeneous{3, "transfer flip 0.9 shape linear",
                                         "density 1.0 eos linear 100 strength j2 40 0.5"},
                             Homogeneous{2, "scheme musl shape cubic",
                                         "density 1.0 eos linear 100 strength j2 40 0.5"},
                             Homogeneous{2, "locking fbar", "density 1.0 neohookean 100 0.49"},
                             Homogeneous{3, "",
                                         "density 1.0 eos tait 50 7 viscosity newtonian 3.0"}))
{
  const auto &h = GetParam();
  const double dt = 0.01;
  const int steps = 60;
  Scene run(cell(h.dim, "lj", h.material, h.options) +
            "variable xy equal 0.3*sin(4*time)\nvariable zz equal 0.1*time^2\n"
            "variable rate equal 0.2+0.3*time\n"
            "fix cell all mpm/deform x trate -0.4 y erate v_rate xy strain v_xy" +
            (h.dim == 3 ? " z strain v_zz yz erate 0.25 xz strain 0.1\n" : "\n") +
            strprintf("compute e all mpm/energy\nthermo_style custom step c_e\ntimestep "
                      "%g\nrun %d\n",
                      dt, steps));
  MPM_NS::MaterialPoint point(*run.material()->material, 1, 1.0);
  double F[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (int k = 1; k <= steps; k++) {
    const double t = k * dt;
    const bool deep = h.dim == 3;
    const double next[9] = {exp(-0.4 * t),
                            0.3 * sin(4 * t),
                            deep ? 0.1 : 0.0,
                            0.0,
                            F[4] + dt * (0.2 + 0.3 * t),
                            deep ? 0.25 * t : 0.0,
                            0.0,
                            0.0,
                            deep ? 1.0 + 0.1 * t * t : 1.0};
    // A = (next - F) F^-1, of upper triangular matrices
    double A[9], inverse[9] = {};
    for (int d = 0; d < 3; d++) inverse[4 * d] = 1.0 / F[4 * d];
    inverse[1] = -F[1] / (F[0] * F[4]);
    inverse[5] = -F[5] / (F[4] * F[8]);
    inverse[2] = (F[1] * F[5] - F[2] * F[4]) / (F[0] * F[4] * F[8]);
    for (int r = 0; r < 3; r++)
      for (int c = 0; c < 3; c++) {
        A[3 * r + c] = 0.0;
        for (int j = 0; j < 3; j++)
          A[3 * r + c] += (next[3 * r + j] - F[3 * r + j]) * inverse[3 * j + c];
      }
    point.move(A, dt);
    std::copy_n(next, 9, F);
  }
  const int entry[6] = {0, 4, 8, 1, 2, 5};
  for (int k = 0; k < 6; k++) {
    EXPECT_NEAR(mean_F(run, k), F[entry[k]], 1e-12) << k;
    EXPECT_NEAR(mean_stress(run, k), point.stress(k), 1e-10 * (1.0 + std::fabs(point.stress(k))))
        << k;
  }
  for (const auto &s : run.gather()) {
    for (int c = 0; c < 9; c++) EXPECT_NEAR(s.F[c], F[c], 1e-11);
    for (const double v : s.v) EXPECT_NEAR(v, 0.0, 1e-11);
  }
  // the work is that of the stress of the law by the same rule, for the volume of the cell
  const double V = h.dim == 3 ? 24.0 : 12.0;
  EXPECT_NEAR(run.fix("cell")->compute_scalar() / (V * point.power), 1.0, 1e-10);
  const double *const e = run.compute_vector();
  EXPECT_DOUBLE_EQ(e[6], run.fix("cell")->compute_scalar());
  EXPECT_LT(std::fabs(e[10]), 1e-11 * std::fabs(e[6]));
  // what laws do not integrate exactly is theirs
  EXPECT_LT(std::fabs(measured("integration without laws over work", (e[9] - e[13]) / e[6])), 1e-3);
}

// uniaxial stress of a neo-Hookean solid (benchmark S1), in tension and compression
SERIAL_TEST(Stress, NeoHookeanBar)
{
  for (const auto &[stress, stretch] :
       {std::pair{2e5, 1.204529}, {5e5, 1.511761}, {-2e5, .809486}, {-5e5, .579280}}) {
    Scene run(cell(3, "si", "density 1000 neohookean 1e6 0.3") +
              strprintf("fix cell all mpm/deform x stress %g y stress 0 z stress 0\n"
                        "fix dt all mpm/dt 0.3\nrun 3000\n",
                        stress));
    EXPECT_NEAR(measured("stretch", mean_F(run, XX)), stretch, 1e-5 * stretch);
    EXPECT_NEAR(mean_stress(run, XX), stress, 3e-10 * std::fabs(stress));
    EXPECT_NEAR(mean_stress(run, YY), 0.0, 1e-10 * std::fabs(stress));
    EXPECT_NEAR(mean_F(run, YY), mean_F(run, ZZ), 1e-10);
    // nominal: P = sigma A/A0
    EXPECT_NEAR(mean_nominal(run, XX), mean_stress(run, XX) * mean_F(run, YY) * mean_F(run, ZZ),
                1e-10 * std::fabs(stress));
  }
}

// a stress that comes slowly, and a strain rate with free sides: E and the Poisson number
SERIAL_TEST(Stress, FollowsAPath)
{
  // a wave needs 4 for its way through the cell
  Scene run(cell(2, "lj", "density 1 linear 0.83333333333333333 0.25") +
            "variable s equal 1e-6*(1-cos(2*PI*time/2000))\n"
            "fix cell all mpm/deform xy stress v_s x erate 1e-8 y stress 0\n"
            "timestep 0.4\nrun 2500\n");
  // t = 1000
  EXPECT_NEAR(measured("shear", mean_stress(run, XY)), 2e-6, 2e-6 * 0.01);
  EXPECT_NEAR(measured("modulus", mean_F(run, XY) * (1.0 / 3.0) / 2e-6), 1.0, 8e-4);
  // plane strain: sigma_x = E/(1 - nu^2) e_x, e_y = -nu/(1 - nu) e_x
  EXPECT_NEAR(measured("E'", mean_stress(run, XX) / 1e-5 / (0.83333333333333333 / 0.9375)), 1.0,
              4e-5);
  EXPECT_NEAR(measured("contraction", (mean_F(run, YY) - 1.0) / -1e-5 * 3.0), 1.0, 0.001);
}

/** Layers across x of two materials (moduli 1 and 10, Poisson numbers 0.25 and 0.4); n cells. */
static std::string laminate(int n, const std::string &options)
{
  const double h = 8.0 / n;
  return plane("lj", "p p", strprintf("0 8 0 %.17g", 2.0 * h), 2, 0.3 * h) +
      strprintf("fix grid all mpm %.17g frame total %s\n", h, options.c_str()) +
      "region soft block 0 4 INF INF INF INF\nregion stiff block 4 8 INF INF INF INF\n"
      "create_points 1 region soft ppc 2\ncreate_points 2 region stiff ppc 2\n"
      "group soft type 1\ngroup stiff type 2\n"
      "fix soft soft mpm/material density 1 linear 1 0.25\n"
      "fix stiff stiff mpm/material density 1 linear 10 0.4\n";
}

/** Exact stiffness in plane strain (G.E. Backus, J. Geophys. Res. 67 (1962) 4427). */
struct Backus {
  double C11, C12, C22, C66;
  Backus()
  {
    const double E[2] = {1.0, 10.0}, nu[2] = {0.25, 0.4};
    double one_M = 0.0, l_M = 0.0, rest = 0.0, one_G = 0.0;
    for (int k = 0; k < 2; k++) {
      const double G = E[k] / (2.0 * (1.0 + nu[k])),
                   l = E[k] * nu[k] / ((1.0 + nu[k]) * (1.0 - 2.0 * nu[k])), M = l + 2.0 * G;
      one_M += 0.5 / M;
      l_M += 0.5 * l / M;
      rest += 0.5 * (M - l * l / M);
      one_G += 0.5 / G;
    }
    C11 = 1.0 / one_M;
    C12 = l_M * C11;
    C22 = rest + l_M * l_M * C11;
    C66 = 1.0 / one_G;
  }
};

// layers of two solids: all stiffnesses are exact where cells are of one of them
SERIAL_TEST(Laminate, StiffnessIsExact)
{
  const Backus exact;
  struct {
    const char *load;
    int part[2];
    double stiffness[2];
  } cases[] = {{"x", {XX, YY}, {exact.C11, exact.C12}},
               {"y", {YY, XX}, {exact.C22, exact.C12}},
               {"xy", {XY, XX}, {exact.C66, 0.0}}};
  for (const auto &c : cases) {
    const auto stiffness = [&](int n, const char *options, int k) {
      Scene run(laminate(n, options) + "fix cell all mpm/deform " + c.load +
                " strain 1e-8\nfix rest all mpm/relax 1e-9\nfix dt all mpm/dt 0.25\nrun 40000\n");
      return mean_stress(run, c.part[k]) / 1e-8;
    };
    for (int k = 0; k < 2; k++)
      EXPECT_NEAR(measured(c.load, stiffness(8, "shape linear", k)), c.stiffness[k], 1e-6) << k;
    if (strcmp(c.load, "y") == 0) continue;    // strain is the same everywhere
    // functions that are wider than a cell see a layer between the two, a share of a cell wide
    const double coarse = stiffness(8, "", 0) / c.stiffness[0] - 1.0,
                 fine = stiffness(16, "", 0) / c.stiffness[0] - 1.0;
    measured("error with 8 cells in a period", coarse);
    EXPECT_GT(measured("order", std::log2(coarse / fine)), 0.9);
  }
}

// the same layers under a path of stress have the compliance that belongs to it
SERIAL_TEST(Laminate, Compliance)
{
  const Backus C;
  const double det = C.C11 * C.C22 - C.C12 * C.C12, s = 1e-8;
  Scene run(laminate(8, "shape linear") +
            strprintf("fix cell all mpm/deform x stress %g y stress 0 xy stress %g\n"
                      "fix rest all mpm/relax 1e-9 stop no\nfix dt all mpm/dt 0.25\nrun 8000\n",
                      s, 0.5 * s));
  EXPECT_NEAR(measured("along", (mean_F(run, XX) - 1.0) / s / (C.C22 / det)), 1.0, 1e-4);
  EXPECT_NEAR(measured("across", (mean_F(run, YY) - 1.0) / s / (-C.C12 / det)), 1.0, 1e-4);
  EXPECT_NEAR(measured("shear", mean_F(run, XY) / s / (0.5 / C.C66)), 1.0, 1e-5);
}

// a plate with holes is pulled until it yields: the ledger knows the work of the mean motion
SERIAL_TEST(Cell, WorkAndLedger)
{
  Scene run(plane("metal", "p p", "0 10 0 8", 1, 0.3) +
            "fix grid all mpm 1.0 frame total\nregion hole cylinder z 5 4 2.2 INF INF side out\n"
            "create_points 1 region hole ppc 2\n"
            "fix m all mpm/material density 1.0 eos linear 1e5 strength j2 4e4 5000\n"
            "fix cell all mpm/deform x erate 0.01 y stress 0\ncompute e all mpm/energy\n"
            "thermo_style custom step c_e\nfix dt all mpm/dt 0.3\nrun 2000\n");
  const double *const e = run.compute_vector();
  const double energy = run.compute_scalar(), work = run.fix("cell")->compute_scalar();
  EXPECT_DOUBLE_EQ(e[6], work);
  EXPECT_LT(std::fabs(measured("residual over work", e[10] / work)), 1e-11);
  EXPECT_NEAR(measured("energy and losses over work", (energy - e[8]) / work), 1.0, 0.003);
  EXPECT_GT(e[2], 0.1 * work);
  EXPECT_GT(std::fabs(mean_stress(run, XX)), 50 * std::fabs(mean_stress(run, YY)));
}

TEST(Cell, RanksAndRestart)
{
  for (const char *units : {"si", "real"}) {
    const std::string head = space(units, "p p p", "0 5 0 4 0 3", 1, 0.3),
                      points = "region hole sphere 2 2 1 0.9 side out\ncreate_points 1 region hole "
                               "ppc 2\n";
    const std::string fixes =
        "fix grid all mpm 1.0 frame total\n"
        "fix m all mpm/material density 1 eos linear 1.0 strength j2 0.4 0.01\n"
        "variable s equal 0.01*sin(0.1*step)\n"
        "fix cell all mpm/deform x trate v_s y stress v_s z stress 0 yz erate 0.002 xy strain v_s\n"
        "compute e all mpm/energy\nthermo_style custom step c_e\n"
        "timestep 0.2\n";
    // material before points of the first run, none after the restart
    OnRanks run(head + fixes + points, "run 50\n");
    EXPECT_LT(measured("difference to one rank", run.difference()), 1e-10);
    OnRanks even(head + fixes + points, "run 50\n",
                 "comm_style tiled\nfix even all balance 10 1.0 rcb\n");
    EXPECT_LT(measured("difference to one rank, balanced", even.difference()), 1e-10);
    Continued again(head + fixes + points, 20, "neighbor 0.3 bin\n" + fixes, 30);
    EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
    EXPECT_EQ(again.whole.fix("cell")->compute_scalar(), again.again.fix("cell")->compute_scalar());
    for (int k = 0; k < 18; k++)
      EXPECT_EQ(again.whole.fix("cell")->compute_vector(k),
                again.again.fix("cell")->compute_vector(k));
  }
}

// a cell that has yielded is unloaded with fix_modify: plastic strain remains
SERIAL_TEST(Cell, Unloads)
{
  Scene run(cell(3, "lj", "density 1 eos linear 100 strength j2 40 0.5") +
            "variable e equal 0.02*0.5*(1-cos(PI*time/40))\n"
            "fix cell all mpm/deform x strain v_e y stress 0 z stress 0\n"
            "fix dt all mpm/dt 0.5 until 40\nrun 10000\n");
  const double E = 9 * 100.0 * 40.0 / (3 * 100.0 + 40.0), loaded = mean_F(run, XX) - 1.0;
  EXPECT_NEAR(loaded, 0.02, 1e-12);
  EXPECT_NEAR(measured("stress over strength", mean_stress(run, XX) / 0.5), 1.0, 1e-3);
  run.commands("fix_modify cell x stress 0\nfix dt all mpm/dt 0.5 until 80\nrun 10000\n");
  EXPECT_NEAR(mean_stress(run, XX), 0.0, 1e-10);
  EXPECT_NEAR(measured("strain that is gone over stress/E",
                       std::log((1.0 + loaded) / mean_F(run, XX)) / (0.5 / E)),
              1.0, 5e-3);
  // the plastic strain has no volume
  EXPECT_NEAR(mean_F(run, XX) * mean_F(run, YY) * mean_F(run, ZZ), 1.0, 1e-10);
  EXPECT_THAT(run.error("fix_modify cell x rate 1\n"), ::testing::HasSubstr("must be one of"));
  const auto told =
      lines_that_say(cell(2, "lj", "density 1 linear 1 0.3") +
                         "fix cell all mpm/deform x erate 1e-3\ntimestep 0.1\nrun 10\n"
                         "unfix cell\nfix cell all mpm/deform x erate 1e-3\nrun 1\n",
                     "strained already");
  EXPECT_EQ(told.size(), 1u);
}

// units of stress and work
SERIAL_TEST(Cell, Units)
{
  for (const char *units : {"si", "metal", "real", "cgs", "lj"}) {
    Scene run(cell(3, units, "density 2.0 neohookean 300 0.25") +
              "variable s equal 0\nfix cell all mpm/deform x strain 1e-4 y stress v_s\n");
    // in the first step: acceleration by the stress over the inertia rho L^2, by 1e-8 in a step
    const double unit = run.lmp->force->ftm2v / run.lmp->force->nktv2p;
    run.commands(strprintf("variable s equal %.17g\ntimestep 1e-4\nrun 1\n", 2.0 * 16.0 / unit));
    const double stress = 300 * 0.75 / (1.25 * 0.5) * 1e-4;
    EXPECT_NEAR(mean_F(run, YY) - 1.0, 1e-8, 1e-14) << units;
    EXPECT_NEAR(mean_stress(run, XX) / stress, 1.0, 2e-4) << units;
    EXPECT_NEAR(run.fix("cell")->compute_scalar() * run.lmp->force->nktv2p /
                    (0.5 * 24.0 * stress * 1e-4),
                1.0, 5e-5)
        << units;
  }
}

SERIAL_TEST(BadInput, IsRefused)
{
  const std::string scene = cell(2, "lj", "density 1 neohookean 1 0.3"),
                    fix = "fix cell all mpm/deform ";
  expect_refused(
      scene,
      {{fix + "z erate 1", "z"},
       {fix + "x rate 1", "must be one of"},
       {fix + "xy trate 1", "must be one of"},
       {fix + "x erate", "missing argument"},
       {fix + "x erate 1 x strain 1", "x"},
       {fix + "x erate v_none", "does not exist"},
       {"variable a atom x\n" + fix + "x erate v_a", "not equal-style"},
       {fix + "x strain -1", "the length"},
       {"group g type 1\ngroup h empty\nfix cell h mpm/deform x erate 1", "group all"},
       {fix + "x erate 1\nfix b all mpm/deform y erate 1", "more than one"},
       {fix + "x erate 1\nregion b block 0 1 0 1 INF INF\nfix w all mpm/boundary region b stick",
        "walls would hold"},
       {fix + "x stress 1\nfix r all mpm/relax 1e-6", "use stop no"},
       {fix + "x erate 1\nfix s all mpm/implicit static", "remove one of them"},
       {"fix s all mpm/implicit euler\n" + fix + "x erate 1", "remove one of them"},
       {"unfix m\nunfix grid\n" + fix + "x erate 1", "needs a fix mpm"}},
      "timestep 0.1\nrun 1\n");
  const auto refused = [&](const std::string &options, const char *text) {
    Scene run(replaced(scene, "frame total", options));
    EXPECT_THAT(run.error(fix + "x erate 1\nrun 1\n"), ::testing::HasSubstr(text));
  };
  refused("frame updated", "use frame total");
  refused("frame total reference update 2.0", "use reference fixed");
  refused("frame total scheme usf", "use scheme usl or musl");
  refused("frame total every 2", "every 1");
  Scene open(replaced(scene, "boundary p p p", "boundary p f p"));
  EXPECT_THAT(open.error(fix + "x erate 1\nrun 1\n"), ::testing::HasSubstr("use boundary p"));
}
