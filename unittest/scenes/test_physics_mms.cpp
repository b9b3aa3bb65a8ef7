// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// timeout: 900

// Manufactured solution: axis-aligned displacement in the unit interval and square (M. Steffen,
// P.C. Wallstedt, J.E. Guilkey, R.M. Kirby, M. Berzins, CMES 31 (2008) 107; P.C. Wallstedt,
// J.E. Guilkey, J. Comput. Phys. 227 (2008) 9628), neo-Hookean, walls slip. Body force per mass at
// the reference position X:
//   u_i = G sin(pi X_i) sin(c pi t + phi_i), c = sqrt(E/rho), phi = (0, pi)
//   b_i = pi^2 u_i/rho [lambda/F_ii^2 (1 - ln J) + mu (1 + 1/F_ii^2) - E]

#include "mpm_lammps.h"

#include "transfer/cpdi.h"

using namespace MPM_TEST;

struct Solution {
  double G, E, nu, rho;
  int dim;
  void at(const double *X, double t, double *u, double *v, double *F, double *b) const
  {
    const double lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu = 0.5 * E / (1.0 + nu);
    const double c = sqrt(E / rho);
    double J = 1.0;
    for (int i = 0; i < dim; i++) {
      const double phase = c * PI * t + (i == 0 ? 0.0 : PI);
      u[i] = G * sin(PI * X[i]) * sin(phase);
      v[i] = G * PI * c * sin(PI * X[i]) * cos(phase);
      F[i] = 1.0 + G * PI * cos(PI * X[i]) * sin(phase);
      J *= F[i];
    }
    for (int i = 0; i < dim; i++)
      b[i] = PI * PI * u[i] / rho *
          (lambda / (F[i] * F[i]) * (1.0 - log(J)) + mu * (1.0 + 1.0 / (F[i] * F[i])) - E);
  }
};

// the body force against finite differences of the motion: rho a - dP/dX
TEST(Solution, BodyForce)
{
  for (const int dim : {1, 2}) {
    const Solution s = {0.05, 1.0e7, dim == 1 ? 0.0 : 0.3, 1000.0, dim};
    const double lambda = s.E * s.nu / ((1.0 + s.nu) * (1.0 - 2.0 * s.nu)),
                 mu = 0.5 * s.E / (1.0 + s.nu);
    const double X[2] = {0.31, 0.57}, t = 0.0043, d = 1.0e-3, dt = 1.0e-5;
    auto P = [&](int i, double shift) {
      double Y[2] = {X[0], X[1]}, u[2], v[2], F[2], b[2];
      Y[i] += shift;
      s.at(Y, t, u, v, F, b);
      const double J = dim == 1 ? F[0] : F[0] * F[1];
      return mu * (F[i] - 1.0 / F[i]) + lambda * log(J) / F[i];
    };
    auto velocity = [&](int i, double shift) {
      double u[2], v[2], F[2], b[2];
      s.at(X, t + shift, u, v, F, b);
      return v[i];
    };
    for (int i = 0; i < dim; i++) {
      // fourth order
      const double a = (8.0 * (velocity(i, dt) - velocity(i, -dt)) - velocity(i, 2.0 * dt) +
                        velocity(i, -2.0 * dt)) /
          (12.0 * dt);
      const double slope =
          (8.0 * (P(i, d) - P(i, -d)) - P(i, 2.0 * d) + P(i, -2.0 * d)) / (12.0 * d);
      double u[2], v[2], F[2], b[2];
      s.at(X, t, u, v, F, b);
      EXPECT_NEAR((a - slope / s.rho) / b[i], 1.0, 1.0e-9);
    }
  }
}

/** Largest rms displacement error over time. Without walls the odd solution has a period of 2. */
static double mms_error(int dim, int ne, double G, const std::string &options, bool walls)
{
  const Solution s = {G, 1.0e7, dim == 1 ? 0.0 : 0.3, 1000.0, dim};
  const double h = 1.0 / ne, c = sqrt(s.E / s.rho);
  const double speed = c * sqrt((1.0 - s.nu) / ((1.0 + s.nu) * (1.0 - 2.0 * s.nu)));
  Scene run(plane("si", !walls ? "p p" : (dim == 1 ? "f p" : "f f"),
                  strprintf("%d 1 %g %.17g", walls ? 0 : -1, dim == 1 || walls ? 0.0 : -1.0,
                            dim == 1 ? h : 1.0),
                  1, 0.4 * h) +
            strprintf("fix grid all mpm %.17g %s\ncreate_points 1 box ppc 2 %d\n"
                      "fix m all mpm/material density 1000 neohookean 1.0e7 %g\n",
                      h, options.c_str(), dim == 1 ? 1 : 2, s.nu));
  if (walls)
    run.commands(
        strprintf("fix sides all mpm/boundary xlo xhi %s slip\n", dim == 1 ? "" : "ylo yhi"));
  const int n = walls ? 2 * ne : 4 * ne;
  EXPECT_EQ(run.n(), dim == 1 ? n : n * n);
  run.set_reference();
  const auto C = run.affine();
  for (int i = 0; i < run.n(); i++) {
    double u[2], F[2], b[2];
    s.at(run.reference(i), 0.0, u, run.v()[i], F, b);
    if (!C) continue;
    for (int d = 0; d < 2; d++)
      for (int e = 0; e < 2; e++)
        C[i][2 * e + d] = d == e && d < dim
            ? G * PI * PI * c * cos(PI * run.reference(i)[d]) * (d ? -1.0 : 1.0)
            : 0.0;
  }
  double worst = 0.0;
  run.each_step([&](double **force) {
    const double t = run.time();
    double sum = 0.0;
    for (int i = 0; i < run.n(); i++) {
      double u[2], v[2], F[2], b[2];
      s.at(run.reference(i), t, u, v, F, b);
      for (int d = 0; d < dim; d++) {
        force[i][d] = run.mass()[i] * b[d];
        const double error = run.x()[i][d] - run.reference(i)[d] - u[d];
        sum += error * error;
      }
    }
    worst = std::max(worst, sqrt(sum / run.n()));
  });
  const double dt = 0.2 * h / speed;
  run.commands(strprintf("timestep %.17g\nrun %ld\n", dt, std::lround(2.0 / c / dt)));
  return measured(strprintf("B1 %dd, G = %g, %s, %d cells, %s", dim, G, options.c_str(), ne,
                            walls ? "walls" : "periodic"),
                  worst);
}

struct Row {
  const char *options;    // besides transfer flip 1.0
  double G, tolerance;
  int first;                     // number of cells of the first entry
  std::vector<double> errors;    // for first, 2 first, 4 first, ... cells
  double largest = 0.0;          // for the next number of cells
  friend void PrintTo(const Row &c, std::ostream *out) { *out << c.options << ", G = " << c.G; }
};

// Errors of an independent code, to 3 % or 10 %. Linear functions converge until points cross
// cells, G = 0.05, and diverge then, but not in the total frame; for motions without crossings,
// frames agree. Quadratic: it has open knot vectors at the ends, which matters for less than 16 and
// 8 cells. With MUSL it moves points with the velocities of the nodes, which makes noise under
// tension: with 64 cells we are better.
static const Row interval_cases[] = {
    {"shape linear scheme usl", 1e-4, .03, 4, {3.115e-5, 8.917e-6, 2.278e-6, 5.721e-7, 1.432e-7}},
    {"shape linear scheme musl", 1e-4, .03, 4, {3.317e-5, 8.999e-6, 2.282e-6, 5.722e-7, 1.432e-7}},
    {"shape linear scheme usf", 1e-4, .03, 4, {3.396e-5, 9.016e-6, 4.488e-6, 2.499e-6, 1.318e-6}},
    {"shape linear scheme musl", .05, .1, 4, {1.741e-2, 8.310e-3, 8.666e-3, 1.390e-2}},
    {"shape quadratic scheme usl", 1e-4, .03, 16, {4.288e-6, 1.091e-6, 2.750e-7}},
    {"shape quadratic scheme musl", 1e-4, .03, 16, {4.324e-6, 1.093e-6, 2.751e-7}},
    {"frame total shape linear", 1e-4, .03, 4, {3.115e-5, 8.917e-6, 2.278e-6, 5.721e-7}},
    {"frame total shape linear scheme musl", .05, .03, 4, {1.653e-2, 4.478e-3, 1.135e-3, 2.847e-4}},
    {"shape quadratic scheme usl", .05, .1, 8, {7.716e-3, 2.099e-3, 5.791e-4, 2.421e-4}},
    {"shape cpgimp aspect 1 2 scheme usl", .05, .1, 8, {6.45e-3, 1.61e-3, 4.01e-4}},
    {"shape cpgimp aspect 1 2 scheme usl", 1e-4, .03, 16, {2.286e-6}},
    {"shape gimp aspect 1 2 scheme usl", 1e-4, .03, 16, {2.286e-6}},
    {"shape quadratic scheme musl", .05, .1, 8, {8.330e-3, 2.152e-3, 6.080e-4}, 2.841e-4}};

PARAMETER_TEST(Interval, Error, Row, ValuesIn(interval_cases))
{
  LONG_AFTER(2);
  const auto &row = GetParam();
  const std::string options = std::string("transfer flip 1.0 ") + row.options;
  int ne = row.first;
  for (const double expected : row.errors) {
    EXPECT_NEAR(mms_error(1, ne, row.G, options, true) / expected, 1.0, row.tolerance) << ne;
    ne *= 2;
  }
  if (row.largest > 0.0) EXPECT_LT(mms_error(1, ne, row.G, options, true), row.largest);
}

// Second order, in one and two dimensions, between walls. The table's cubic splines, with open
// knots, have order 1.5 only (5.71e-6, 1.77e-6, 5.23e-7 for 16, 32, 64 cells); mirror walls keep 2.
// Quadratic functions and 2 points per cell stall at 64 cells for G = 0.05.
struct OrderCase {
  const char *options;
  double G;
  int dim, coarse, fine;
  double largest;    // error on the fine grid: from the table, or the quadratic FLIP entry there
  friend void PrintTo(const OrderCase &c, std::ostream *out)
  {
    *out << c.options << ", G = " << c.G << ", " << c.dim << "d";
  }
};

static const OrderCase order_cases[] = {
    // cpdi samples at corners what cpgimp integrates: same order, errors a tenth larger
    {"shape cpdi aspect 1 2 transfer flip 1.0 scheme usl", .05, 1, 16, 32, 5.791e-4},
    {"shape quadratic transfer apic", 1e-4, 1, 16, 64, 2.75e-7},
    {"shape cubic transfer apic", 1e-4, 1, 16, 64, 5.23e-7},
    {"shape quadratic transfer apic", .05, 1, 8, 32, 5.8e-4},
    {"shape cubic transfer apic", .05, 1, 16, 128, 1.2e-4},
    {"shape cubic transfer flip 1.0 scheme musl", 1e-4, 1, 16, 64, 5.23e-7},
    {"shape cubic transfer flip 1.0 scheme musl", .05, 1, 16, 64, 3.4e-4},
    {"shape quadratic transfer apic", 1e-4, 2, 8, 16, 4.3e-6},
    {"shape cubic transfer apic", 1e-4, 2, 8, 16, 5.7e-6},
    {"shape quadratic transfer apic", .05, 2, 8, 16, 2.1e-3},
    {"shape cubic transfer apic", .05, 2, 8, 16, 3.2e-3},
    {"shape quadratic transfer flip 1.0 scheme musl", .05, 2, 8, 16, 3.5e-3},
    {"shape quadratic transfer apic stress gradient", 1e-4, 1, 16, 64, 2.75e-7},
    {"shape cubic transfer apic stress gradient", 1e-4, 1, 16, 64, 5.23e-7},
    {"shape quadratic transfer apic stress gradient", .05, 2, 8, 16, 2.1e-3},
    {"shape cubic transfer aflip 0.95 stress gradient", .05, 2, 8, 16, 3.2e-3},
    {"frame total shape bernstein transfer flip 1.0", .05, 2, 8, 16, 3.8e-3},
    {"frame total shape bernstein transfer apic", .05, 2, 16, 32, 4.5e-4}};

PARAMETER_TEST(Order, Two, OrderCase, ValuesIn(order_cases))
{
  LONG_AFTER(2);
  const auto &c = GetParam();
  const double coarse = mms_error(c.dim, c.coarse, c.G, c.options, true);
  const double fine = mms_error(c.dim, c.fine, c.G, c.options, true);
  EXPECT_GT(measured("order", log(coarse / fine) / log((double) c.fine / c.coarse)), 1.9);
  EXPECT_LT(fine, c.largest);
}

TEST(OrderLinear, DivergesWithCellCrossing)
{
  const std::string options = "shape linear transfer flip 1.0 scheme musl";
  EXPECT_GT(mms_error(1, 32, .05, options, true), mms_error(1, 8, .05, options, true));
  EXPECT_GT(mms_error(2, 16, .05, options, true), 0.5 * mms_error(2, 8, .05, options, true));
}

// GIMP with fixed sizes: compressed at a wall, boxes reach beyond it, and mirror walls do as
// symmetry. Expected: a small code of its own in one dimension with such walls. With nodes at and
// within the walls only, as in the table, the functions of these points do not sum to one, and it
// has 7.5e-3, 2.28e-3, 7.8e-4; contiguous boxes never reach beyond, and agree with the table.
TEST(FixedGimp, WallsAgainstSymmetry)
{
  const std::string options = "shape gimp aspect 1 2 transfer flip 1.0 scheme usl";
  const double expected[] = {6.161e-3, 1.612e-3, 4.412e-4};
  for (int k = 0; k < 3; k++) {
    const double walls = mms_error(1, 8 << k, .05, options, true);
    const double symmetry = mms_error(1, 8 << k, .05, options, false);
    EXPECT_NEAR(walls / symmetry, 1.0, 2.0e-3);
    EXPECT_NEAR(walls / expected[k], 1.0, 0.03);
  }
}

// every shape, transfer, and frame: order from 16 to 32 cells; tables are by bench/convergence.py
struct ShapeOrder {
  const char *options;
  double crossing;    // order when points cross cells, in the updated frame, within 0.2
  double D;           // second moment of the functions about points, mean over points, over h^2
  friend void PrintTo(const ShapeOrder &c, std::ostream *out) { *out << c.options; }
};

// Crossing: linear functions do not converge (-0.69 by another code); quadratic ones and gimp
// approach the error at which they stall, 1.86 and 1.87 by other codes: see FixedGimp
static const ShapeOrder shapes[] = {
    {"shape linear", -0.69, 3.0 / 16.0},
    {"shape quadratic", 1.86, 1.0 / 4.0},
    {"shape cubic", 2.0, 1.0 / 3.0},
    {"shape gimp aspect 1 2", 1.87, 3.0 / 16.0},
    {"shape cpgimp aspect 1 2", 2.0, 3.0 / 16.0},
};

struct TransferOrder {
  const char *options;
  double order;         // with smooth functions, within 0.2
  bool total, alone;    // known to the total frame; with a crossing order of its own, not tested
};

static const TransferOrder orders[] = {
    {"pic", 0.0, true, true},    // see pic_error
    {"flip 1.0", 2.0, true, false},
    {"apic", 2.0, true, false},
    {"aflip 1.0", 2.0, false, false},
    {"tpic", 2.0, false, false},
    {"xpic 2", 2.0, true, false},
    // Damps waves by (D k^2 h^2)^2 in each of 1/h steps: order 3, where the other errors, of order
    // 2, are small, as they are with functions of higher order than linear
    {"fmpm 2", 0.0, true, true},
};

/** Largest rms error of pic for a small amplitude, relative to it: of what goes to the nodes and
 *  back, a wave loses D k^2 h^2 in a step: amplitude exp(-D (pi h)^2 t / 2 dt), with dt = 0.2 h/c
 *  as exp(-2.5 D pi^2 h c t). The error is of first order when this exponent is small. */
static double pic_error(double D, int ne)
{
  double error = 0.0;
  for (double ct = 0.0; ct < 2.0; ct += 1e-3)
    error = std::max(error, (1.0 - exp(-2.5 * D * PI * PI * ct / ne)) * std::fabs(sin(PI * ct)));
  return error / sqrt(2.0);
}

static double order(const std::string &options, double G)
{
  const double coarse = mms_error(1, 16, G, options, true);
  const double fine = mms_error(1, 32, G, options, true);
  return measured(options + ": order", log2(coarse / fine));
}

PARAMETER_TEST(Sweep, EveryTransferAndFrame, ShapeOrder, ValuesIn(shapes))
{
  LONG_AFTER(2);
  const auto &shape = GetParam();
  const std::string name = shape.options;
  const bool linear = name.find("linear") != std::string::npos;
  const bool spline = name.find("gimp") == std::string::npos;
  for (const auto &transfer : orders) {
    const std::string options = name + " transfer " + transfer.options;
    const bool fmpm = std::string(transfer.options).find("fmpm") == 0;
    const bool pic = std::string(transfer.options) == "pic";
    const double expected = pic ? log2(pic_error(shape.D, 16) / pic_error(shape.D, 32))
                                : (!fmpm ? transfer.order : (linear || !spline ? 2.0 : 3.0));
    const char *scheme = linear && !fmpm ? " scheme musl" : "";    // see fix mpm: what is sound
    EXPECT_NEAR(order(options + scheme, 1e-4), expected, pic ? 0.03 : 0.2) << options;
    if (pic) {
      const double error = mms_error(1, 32, 1e-4, options + scheme, true);
      EXPECT_NEAR(error / (1e-4 * pic_error(shape.D, 32)), 1.0, 0.02) << options;
    } else if (linear && !fmpm && std::string(transfer.options) != "flip 1.0") {
      EXPECT_LT(order(options + scheme, .05), 0.2) << options;
    } else if (!transfer.alone) {
      EXPECT_NEAR(order(options + scheme, .05), shape.crossing, 0.2) << options;
    }
    if (spline && transfer.total)
      for (const double G : {1e-4, .05})
        EXPECT_NEAR(order(options + " frame total", G), expected, 0.2) << options << ", total";
  }
}

// Functions that are modified at the walls and need no nodes outside are of second order, too.
// Between walls that slip the solution is odd about them, so that the linear continuation f_-1 = 2
// f_0 - f_1 and the mirror image -f_1 are the same: what differs is the lumped mass of the first
// node inside alone, by twice that of its image. With v = sin(pi x) this is of order h (pi h)^2 of
// the mass in motion: the two differ by one order more than each from the exact solution.
TEST(MMS, EdgesModified)
{
  for (const char *options : {"shape cubic transfer flip 1.0 scheme musl",
                              "shape quadratic transfer flip 1.0 scheme musl"}) {
    const std::string modified = options + std::string(" edges modified");
    double error[2], apart[2];
    for (const int k : {0, 1}) {
      error[k] = mms_error(1, 16 << k, 1e-4, modified, true);
      apart[k] = std::abs(mms_error(1, 16 << k, 1e-4, options, true) - error[k]);
    }
    EXPECT_GT(measured("order", log2(error[0] / error[1])), 1.9) << options;
    EXPECT_NEAR(measured("order of the difference", log2(apart[0] / apart[1])), 3.0, 0.2)
        << options;
    EXPECT_GT(apart[1], 0.0);
  }
}

// a mirror wall is the same thing as symmetry
TEST(Walls, AgainstSymmetry)
{
  for (const int dim : {1, 2})
    for (const int ne : {8, 16})
      for (auto *options : {"shape quadratic transfer apic", "shape cubic transfer apic",
                            "shape quadratic transfer flip 1.0 scheme musl"}) {
        const double wall = mms_error(dim, ne, 1e-4, options, true);
        const double symmetry = mms_error(dim, ne, 1e-4, options, false);
        EXPECT_NEAR(wall / symmetry, 1.0, 1.0e-8) << options << " " << ne;
      }
}

// B2, the generalized vortex (K. Kamojjala, R. Brannon, A. Sadeghirad, J. Guilkey, Eng. Comput. 31
// (2015) 269): a ring, 0.75 < R < 1.25, that is swirled by alpha = g(t) s(R), g = G (1 - cos 2 pi
// t)/2, with exact forces at the reference positions. G = 1, a shear of 6.2, tears updated bodies.

struct Swirl {
  double error;    // largest rms error of the positions
  double
      spin;    // angular momentum at the end, where it is 0, over the largest of the exact motion
};

/** n cells across the ring. volume: of domains, and by J, where the ring is turned most. */
static Swirl vortex(const std::string &options, int n, double G, double *volume = nullptr)
{
  const double h = 0.5 / n, c2 = 1.0 / 2.6, w = 2.0 * PI, dt = 0.2 * h / 5.06;
  Scene run(plane("si", "f f",
                  strprintf("%g %g %g %g -0.1 0.1", -1.5 - h, 1.5 + h, -1.5 - h, 1.5 + h), 1,
                  0.5 * h) +
            strprintf(R"(
fix grid all mpm %.17g %s
region outer cylinder z 0 0 1.25 INF INF
region hole cylinder z 0 0 0.75 INF INF side out
region ring intersect 2 outer hole
create_points 1 region ring ppc 2
fix soft all mpm/material density 1000 neohookean 1000 0.3
timestep %.17g
)",
                      h, options.c_str(), dt));
  run.set_reference();
  double worst = 0.0, most = 0.0, impulse = 0.0, torque = 0.0;
  bigint last = -1;
  run.each_step([&](double **force) {
    const double t = run.time();
    const double g = 0.5 * G * (1.0 - cos(w * t)), g1 = 0.5 * G * w * sin(w * t),
                 g2 = 0.5 * G * w * w * cos(w * t);
    double sum = 0.0, spin = 0.0;
    torque = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const double *X = run.reference(i), R = hypot(X[0], X[1]), q = 2.0 * (R - 1.0);
      const double s = 1.0 - 8.0 * q * q + 16.0 * q * q * q * q,
                   s1 = 2.0 * (64.0 * q * q * q - 16.0 * q), s2 = 4.0 * (192.0 * q * q - 16.0),
                   a = g * s;
      const double A = c2 * (3.0 * g * s1 + R * g * s2) - R * g2 * s;
      const double B = R * (c2 * g * s1 * g * s1 - g1 * s * g1 * s);
      const double bR = A * sin(a) + B * cos(a), bT = -A * cos(a) + B * sin(a);
      force[i][0] = run.mass()[i] * (bR * X[0] - bT * X[1]) / R;
      force[i][1] = run.mass()[i] * (bR * X[1] + bT * X[0]) / R;
      const double ex = run.x()[i][0] - X[0] * cos(a) + X[1] * sin(a);
      const double ey = run.x()[i][1] - X[1] * cos(a) - X[0] * sin(a);
      sum += ex * ex + ey * ey;
      spin += run.mass()[i] * g1 * s * R * R;
      torque += run.x()[i][0] * force[i][1] - run.x()[i][1] * force[i][0];
    }
    worst = std::max(worst, sqrt(sum / run.n()));
    grow(most, spin);
    if (run.lmp->update->ntimestep > last) impulse += dt * torque;    // not again in a new run
    last = run.lmp->update->ntimestep;
  });
  const long half = std::lround(0.5 / dt);
  run.commands(strprintf("run %ld\n", half));
  if (volume) {
    volume[0] = volume[1] = 0.0;
    for (int i = 0; i < run.n(); i++) {
      double weight[4], gradient[8];
      volume[0] += MPM_NS::PointDomain<2>::free(run.corners()[i], weight, gradient);
      volume[1] += run.points().jacobian(i) * run.lmp->atom->vfrac[i];
    }
  }
  run.commands(strprintf("run %ld\n", half));
  const std::string name = strprintf("B2, G = %g, %s, %d cells: ", G, options.c_str(), n);
  impulse -= dt * torque;    // of the step to come
  measured(name + "angular momentum given by forces", impulse / most);
  return {measured(name + "error", worst),
          measured(name + "angular momentum, error", (run.sums().L[2] - impulse) / most)};
}

struct VortexCase {
  const char *options;
  double G, order;              // asked between 10 and 20 cells
  std::vector<double> other;    // errors of another code with 5, 10, 20 cells, to 10 %; where known
  friend void PrintTo(const VortexCase &c, std::ostream *out) { *out << c.options; }
};

// asked: G = 0.1, updated frame: order 1.6, 2.5e-3 with 20 cells; G = 1, total frame and CPDI:
// order 1.8; and less than 1 % of the angular momentum at the end, where it is 0. The forces
// themselves, sampled by an array of points with steps at its rims, leave 1.5 % of it with 20
// cells: what is asked is therefore asked of the rest, and of APIC in the updated frame, which
// conserves it, to round-off. The first steps, from 5 to 10 cells, are not of any order yet: 1.5
// (APIC) and 1.1 (APIC, total frame) by the other code.
static const VortexCase vortex_cases[] = {
    {"transfer apic", 0.1, 1.6, {1.94e-2, 6.83e-3, 1.82e-3}},
    {"transfer flip 1.0 scheme musl", 0.1, 1.6, {2.83e-2, 6.94e-3, 1.98e-3}},
    {"shape cpgimp transfer apic", 0.1, 1.6, {}},
    {"shape cpdi transfer apic", 0.1, 1.6, {}},
    {"frame total dtcheck no transfer apic", 1.0, 1.8, {1.67e-1, 7.75e-2, 2.01e-2}},
    {"frame total dtcheck no transfer flip 1.0", 1.0, 1.8, {2.83e-1, 7.36e-2, 1.92e-2}},
    {"shape cpdi transfer apic", 1.0, 1.8, {}},
    // 1.73 between 10 and 20 cells, 1.89 between 20 and 40, which takes a minute
    {"shape cpdi transfer flip 1.0", 1.0, 1.6, {}}};

PARAMETER_TEST(Vortex, Converges, VortexCase, ValuesIn(vortex_cases))
{
  LONG_AFTER(1);
  const auto &c = GetParam();
  double error[3];
  for (int k = c.other.empty() ? 1 : 0; k < 3; k++) {
    const auto swirl = vortex(c.options, 5 << k, c.G);
    error[k] = swirl.error;
    if (!c.other.empty()) { EXPECT_NEAR(swirl.error / c.other[k], 1.0, 0.1) << (5 << k); }
    const bool exact = std::string(c.options) == "transfer apic";
    if (k == 2) { EXPECT_LT(std::abs(swirl.spin), exact ? 1.0e-14 : 0.01); }
  }
  EXPECT_GT(measured("order", log2(error[1] / error[2])), c.order);
  if (c.G == 0.1) { EXPECT_LT(error[2], 2.5e-3); }
}

// with 5 cells across, the ragged rim turns free corners inside out; volumes are those of F
TEST(VortexVolume, FreeCorners)
{
  for (const char *options :
       {"shape cpdi2 transfer apic", "shape cpdi2 transfer apic scheme musl"}) {
    double volume[2];
    EXPECT_LT(vortex(options, 10, 1.0, volume).error, 0.065);
    EXPECT_NEAR(volume[0] / volume[1], 1.0, 1e-13) << options;
  }
}
