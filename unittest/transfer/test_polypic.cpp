// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input ranks
// mpi: 1 3

// Polynomial particle in cell with bilinear modes: transfer polypic.

#include "mpm_lammps.h"

using namespace MPM_TEST;

const char *const shapes[] = {"shape quadratic", "shape cubic"};

/** A block of 6 x 6 (x 6) cells with points at random. */
std::string block(int dim, const std::string &options)
{
  return strprintf(R"(
units lj
dimension %d
boundary p p p
atom_style mpm
region box block 0 12 0 12 %s
create_box 1 box
fix g all mpm 1.0 %s
region body block 3 9 3 9 %s
create_points 1 region body ppc 2 jitter 0.4 4711
fix m all mpm/material density 2 neohookean 5 0.3
timestep 0.01
thermo_style custom step
)",
                   dim, dim == 2 ? "-0.5 0.5" : "0 12", options.c_str(),
                   dim == 2 ? "INF INF" : "3 9");
}

/** Coefficient of the product of the coordinates in mode (bit a: x_a) of component i. */
double coefficient(int mode, int i)
{
  return 0.3 * sin(1.0 + 2.7 * mode + 1.3 * i) / (1 << mode % 3);
}

/** Derivative along the axes in the bits of ALONG of the multilinear field, at x. */
double field(int dim, const double *x, int i, int along)
{
  double sum = 0.0;
  for (int mode = 0; mode < 1 << dim; mode++) {
    if ((mode & along) != along) continue;
    double term = coefficient(mode, i);
    for (int a = 0; a < dim; a++)
      if (mode & ~along & 1 << a) term *= x[a] - 6.0;
    sum += term;
  }
  return sum;
}

// a field of products goes to nodes and back if points have its modes; apic changes it

TEST(Polypic, RoundTrip)
{
  const int bits[4] = {3, 5, 6, 7};    // xy xz yz xyz
  for (const int dim : {2, 3})
    for (const std::string shape : shapes)
      for (const char *ledger : {"", "compute e all mpm/energy\nthermo_style custom step c_e\n"})
        for (const std::string transfer :
             {" transfer polypic kernels baseline", " transfer polypic",
              " transfer polypic kernels reference", " transfer apic"}) {
          const bool poly = transfer != " transfer apic";
          SCOPED_TRACE(strprintf("%dd %s %s %s", dim, shape.c_str(), transfer.c_str(), ledger));
          Scene run(block(dim, shape + transfer) + ledger + "timestep 1e-14\nrun 0\n");
          const MPMRows C = run.affine("g"), Q = run.modes("g");
          ASSERT_EQ((bool) Q, poly);
          const int nmode = dim == 2 ? 1 : 4;
          for (int i = 0; i < run.n(); i++)
            for (int d = 0; d < dim; d++) {
              run.v()[i][d] = field(dim, run.x()[i], d, 0);
              for (int a = 0; a < dim; a++) C[i][dim * a + d] = field(dim, run.x()[i], d, 1 << a);
              for (int m = 0; m < nmode && poly; m++)
                Q[i][dim * m + d] = field(dim, run.x()[i], d, bits[m]);
            }
          run.commands("run 1 pre no post no\n");
          double worst = 0.0, modes = 0.0;
          for (int i = 0; i < run.n(); i++)
            for (int d = 0; d < dim; d++) {
              grow(worst, run.v()[i][d] - field(dim, run.x()[i], d, 0));
              for (int a = 0; a < dim; a++)
                grow(worst, C[i][dim * a + d] - field(dim, run.x()[i], d, 1 << a));
              for (int m = 0; m < nmode && poly; m++)
                grow(modes, Q[i][dim * m + d] - field(dim, run.x()[i], d, bits[m]));
            }
          if (poly) {
            EXPECT_LT(worst, 1e-11);
            EXPECT_LT(modes, 1e-11);
          } else if (nranks() == 1) {
            EXPECT_GT(worst, 1e-2);
          }
        }
}

// momentum and angular momentum (with that of the affine fields) in elastic motion; with musl and
// usavg, points move with other velocities: 1e-4 of angular momentum is promised

TEST(Polypic, Conservation)
{
  for (const std::string shape : shapes)
    for (const char *scheme : {"usl", "musl", "usf", "usavg"}) {
      SCOPED_TRACE(shape + scheme);
      Scene run;
      run.commands(block(2, shape + " transfer polypic scheme " + scheme) +
                   "variable vx atom -0.3*(y-6)+0.02*x*y\nvariable vy atom 0.3*(x-6)-0.01*x*x\n"
                   "velocity all set v_vx v_vy 0\nrun 1\n");
      const auto sums = [&](double *sum) {
        const auto s = run.sums();
        const double mine[3] = {s.p[0], s.p[1], s.L[2]};
        MPI_Allreduce(mine, sum, 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
      };
      double before[3], after[3], moved[3] = {};
      sums(before);
      if (nranks() == 1) {
        run.set_reference();
        run.each_step([&](double **) {
          run.add_angular_momentum_of_motion(moved);
        });
      }
      run.commands("run 200\n");
      sums(after);
      const bool moves_mapped = std::string(scheme) == "musl" || std::string(scheme) == "usavg";
      const double size = std::fabs(before[2]) + 1.0;
      for (int k = 0; k < 3; k++)
        EXPECT_NEAR(after[k], before[k], (k == 2 && moves_mapped ? 1e-4 : 1e-11) * size);
      if (nranks() == 1) EXPECT_NEAR(after[2] - moved[2], before[2], 1e-11 * size);
    }
}

// Taylor-Green vortices of a fluid without viscosity, two wave lengths of 16 cells: what transfers
// take of the kinetic energy, as the viscosity that would do the same, nu = -ln(E/E0)/(4 k^2 t)

static double viscosity(const std::string &options)
{
  Scene run(replaced(R"(
units lj
dimension 2
boundary p p p
atom_style mpm
region box block 0 32 0 32 -0.5 0.5
create_box 1 box
fix g all mpm 1.0 OPTIONS
create_points 1 box ppc 2
fix m all mpm/material density 1 eos linear 100
variable k equal PI/8
variable vx atom 0.5*sin(v_k*x)*cos(v_k*y)
variable vy atom -0.5*cos(v_k*x)*sin(v_k*y)
velocity all set v_vx v_vy 0
variable e atom 0.5*mass*(vx*vx+vy*vy)
compute e all reduce sum v_e
thermo_style custom step c_e
timestep 0.04
run 0
)",
                     "OPTIONS", options));
  const double E = run.evaluate("c_e"), k = M_PI / 8.0, t = 0.04 * 150;
  run.commands("run 150\n");
  return -log(run.evaluate("c_e") / E) / (4.0 * k * k * t);
}

TEST(Polypic, LessDissipation)
{
  for (const std::string shape : shapes) {
    const double apic = measured(shape + ", apic, viscosity", viscosity(shape + " transfer apic"));
    const double poly =
        measured(shape + ", polypic, viscosity", viscosity(shape + " transfer polypic"));
    EXPECT_GT(poly, 0.0);
    EXPECT_LT(poly, 0.9 * apic);
  }
}

TEST(Polypic, RanksAndRestart)
{
  for (const int dim : {2, 3}) {
    const std::string text = block(dim, "transfer polypic"),
                      motion =
                          "variable v atom 0.6*sin(0.7*x)*cos(0.5*y)\nvelocity all set v_v v_v 0\n";
    Scene serial(text + motion + "run 60\n", MPI_COMM_SELF);
    const auto first = text.find("fix g "), body = text.find("region body"),
               mat = text.find("fix m ");
    Continued run(text + motion, 30, text.substr(first, body - first) + text.substr(mat), 30);
    const auto state = run.whole.gather();
    EXPECT_LT(measured("ranks", difference(serial.gather(), state)), 1e-10);
    EXPECT_LT(measured("restart", difference(state, run.again.gather())), 1e-10);
  }
}

TEST(Polypic, Refused)
{
  for (const std::string options : {"shape linear", "shape gimp", "frame total"})
    expect_error(plane("lj", "p p", "0 4 0 4") + "fix g all mpm 1.0 transfer polypic " + options,
                 "needs shape quadratic or cubic and frame updated");
}
