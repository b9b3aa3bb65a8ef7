// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics

// What tells transfer tpic from transfer apic, from theory. Both have an affine matrix C:
//   tpic: C = sum_i v_i (x) grad N_ip                        the gradient of the field of the nodes
//   apic: C = D^-1 sum_i N_ip v_i (x) (x_i - x_p)    its first moments, D: h^2/4, h^2/3
// A wave v_i = exp(ikx_i) of the nodes has at the points, up to aliases, the velocity S exp(ikx)
// with S = sinc(kh/2)^(n+1) for B-splines of order n, and the gradients
//   tpic: ik S,    apic: -i/(D h) dS^/dk with the transform S^ of N, ik S (1 + k^2 h^2/60 + ...)
// for any n >= 2, so that tpic's is smaller by a third derivative,
//   C_tpic = C_apic + h^2/60 v_xxx + ...
// What comes back to the nodes is A times the wave, with C = ik g:
//   A = S^2 + D k^2 a g,    a of apic,    so that A_apic - A_tpic = D k^4 h^2/60 + ...
// With quadratic functions, aliases count, too: the third moments of N about a point depend on
// where it is in its cell, with a mean square of 72 zeta(6) (h/2 pi)^6 = h^6/840, which tpic does
// not see and which adds k^4 h^6/(4 * 840 D) = 2/7 D k^4 h^2/60 for apic. and with apic the angular
// momentum sum_p m_p [x_p x v_p + D (C_yx - C_xy)] is that of the nodes, while tpic changes it by
// the difference of the matrices. With linear functions D = f (1 - f) h^2 at the distance f h from
// a node, and both are the same: the difference of the nodes over h.

#include "mpm_lammps.h"

using namespace MPM_TEST;

static const char *const names[] = {"", "linear", "quadratic", "cubic"};

/** What a field of nodes (h = 1) is at a point: velocity and gradient of tpic or apic. */
struct AtPoint {
  double v = 0.0, C = 0.0;

  template <class Field> AtPoint(int n, bool tpic, double x, Field field)
  {
    double moment = 0.0, D = 0.0;
    for (int i = std::floor(x) - 3; i <= x + 3; i++) {
      const double w = bspline(n, x - i);
      v += w * field(i);
      moment += w * (i - x) * field(i);
      D += w * (i - x) * (i - x);
      if (tpic) C += bspline_slope(n, x - i) * field(i);
    }
    if (!tpic) C = moment / D;
  }
};

constexpr int CELLS = 8;    // of a wave length
constexpr double K = 2.0 * M_PI / CELLS;

static double wave(double x)
{
  return std::sin(K * x);
}

/** What becomes of a wave of the nodes when it goes to ppc points per cell and back. */
static double amplification(int n, bool tpic, int ppc, double k = K)
{
  double sum = 0.0, mass = 0.0;
  for (int p = -3 * ppc; p < 3 * ppc; p++) {
    const double x = (p + 0.5) / ppc, w = bspline(n, x);
    const AtPoint point(n, tpic, x, [k](double node) {
      return std::cos(k * node);
    });
    sum += w * (point.v - point.C * x);
    mass += w;
  }
  return sum / mass;
}

static std::string medium(int dim, int n, bool tpic, int ppc, const std::string &more = "")
{
  return box(dim, "lj", "p p p", strprintf("0 %d 0 4 0 4", CELLS)) +
      body("box", "density 2 neohookean 1e-12 0.3",
           strprintf("1.0 dtcheck no shape %s transfer %s%s", names[n], tpic ? "tpic" : "apic",
                     more.c_str()),
           std::to_string(ppc)) +
      "timestep 1e-12\nrun 0\n";
}

// a shear wave that points have from nodes: after a step all velocities and matrices are A times
// what they were, to round-off, with either transfer; the other one differs by a percent
TEST(Tpic, ShearWave)
{
  for (const int dim : {2, 3})
    for (const int n : {1, 2, 3})
      for (const bool tpic : {false, true})
        for (const char *more : {"", " kernels reference", " scheme musl"})
          for (const int ppc : {2, 3}) {
            SCOPED_TRACE(strprintf("%dd %s tpic %d ppc %d%s", dim, names[n], tpic, ppc, more));
            Scene run(medium(dim, n, tpic, ppc, (n == 1 ? " light 0.5" : "") + std::string(more)));
            const MPMRows C = run.affine();
            for (int p = 0; p < run.n(); p++) {
              const AtPoint point(n, tpic, run.x()[p][0], wave);
              run.v()[p][1] = point.v;
              for (int c = 0; c < dim * dim; c++) C[p][c] = c == 1 ? point.C : 0.0;    // dv_y/dx
            }
            const std::string scheme = more;
            const double A = amplification(n, tpic, ppc);
            run.commands("run 1 pre no post no\n");
            double worst = 0.0, other = 0.0;
            for (int p = 0; p < run.n(); p++) {
              const AtPoint point(n, tpic, run.x()[p][0], wave),
                  wrong(n, !tpic, run.x()[p][0], wave);
              worst = std::max(worst, std::fabs(run.v()[p][1] - A * point.v));
              worst = std::max(worst, std::fabs(run.v()[p][0]));
              for (int c = 0; c < dim * dim; c++)
                worst = std::max(worst, std::fabs(C[p][c] - (c == 1 ? A * point.C : 0.0)));
              other = std::max(other, std::fabs(point.C - wrong.C));
            }
            EXPECT_LT(worst, 1e-11);
            if (n == 1)
              EXPECT_LT(other, 1e-14);
            else
              EXPECT_GT(other, 5e-3);
          }
}

// the sums above against the expansions for long waves
TEST(Tpic, TheoryOfLongWaves)
{
  const double x = 0.5 * K;
  const int ppc = 64;    // next to an integral
  for (const int n : {2, 3}) {
    const double D = n == 2 ? 0.25 : 1.0 / 3.0;
    double gradient[2] = {0.0, 0.0};
    for (const bool tpic : {false, true})
      for (int p = 0; p < ppc * CELLS; p++) {
        const double at = (p + 0.5) / ppc;
        gradient[tpic] += AtPoint(n, tpic, at, wave).C * std::cos(K * at) * 2.0 / (ppc * CELLS);
      }
    EXPECT_NEAR(gradient[1], K * std::pow(std::sin(x) / x, n + 1), 1e-5);
    EXPECT_NEAR(gradient[1] / gradient[0],
                x * x * std::sin(x) / (3.0 * (std::sin(x) - x * std::cos(x))), 1e-5);
    EXPECT_NEAR(gradient[1] / gradient[0], 1.0 - K * K / 60.0, 1e-4);
    const double k = M_PI / 32;
    const double more = amplification(n, false, ppc, k) - amplification(n, true, ppc, k);
    EXPECT_NEAR(measured("A_apic - A_tpic, over D k^4 h^2/60", more / (D * std::pow(k, 4) / 60.0)),
                n == 2 ? 9.0 / 7.0 : 1.0, 0.01);
    EXPECT_LT(amplification(n, false, ppc, k), 1.0);
  }
}

// internal forces: tpic has the gradients of the functions, apic their moments
TEST(Tpic, Force)
{
  const double dt = 1e-12, density = 2.0;
  const int ppc = 2;
  for (const int dim : {2, 3})
    for (const int n : {2, 3})
      for (const bool tpic : {false, true}) {
        SCOPED_TRACE(strprintf("%dd %s tpic %d", dim, names[n], tpic));
        Scene run(medium(dim, n, tpic, ppc));
        for (int p = 0; p < run.n(); p++)
          run.points().tau[p][3] = std::cos(K * run.x()[p][0]);    // xy
        run.commands("run 1 pre no post no\n");
        const double D = n == 2 ? 0.25 : 1.0 / 3.0;
        const auto node = [&](int i) {
          double f = 0.0, mass = 0.0;
          for (int p = -3 * ppc; p < 3 * ppc; p++) {
            const double x = i + (p + 0.5) / ppc, w = bspline(n, x - i);
            f -= std::cos(K * x) * (tpic ? bspline_slope(n, x - i) : w * (i - x) / D);
            mass += density * w;
          }
          return f / mass;
        };
        double worst = 0.0, largest = 0.0;
        for (int p = 0; p < run.n(); p++) {
          const double expected = AtPoint(n, tpic, run.x()[p][0], node).v;
          worst = std::max(worst, std::fabs(run.v()[p][1] / dt - expected));
          largest = std::max(largest, std::fabs(expected));
        }
        EXPECT_GT(largest, 0.2);
        EXPECT_LT(worst, 1e-11);
      }
}

// A free block whose velocity is a cubic polynomial: both give the points the same velocities; apic
// keeps the angular momentum, tpic changes it by D times the difference of the matrices. With cubic
// functions that is h^2/60 v_xxx inside the block. Both keep that of an affine motion.
TEST(Tpic, AngularMomentum)
{
  for (const int n : {2, 3})
    for (const bool affine : {false, true}) {
      SCOPED_TRACE(strprintf("%s affine %d", names[n], affine));
      Scene run[2];
      double change[2];
      std::vector<Scene::State> state[2];
      for (const int tpic : {0, 1}) {
        auto &r = run[tpic];
        r.commands(plane("lj", "p p", "0 20 0 20") +
                   body("block 4 16 4 16 INF INF", "density 2 neohookean 1e-12 0.3",
                        strprintf("1.0 shape %s transfer %s", names[n], tpic ? "tpic" : "apic"),
                        "4") +
                   "timestep 1e-14\nrun 0\n");
        for (int p = 0; p < r.n(); p++) {
          const double x = r.x()[p][0] - 10.0, y = r.x()[p][1] - 10.0, cubic = affine ? 0.0 : 0.01;
          r.v()[p][0] = 0.2 * x - 0.3 * y;
          r.v()[p][1] = 0.5 * x + cubic * x * x * x;
          const double C[4] = {0.2, 0.5 + 3.0 * cubic * x * x, -0.3, 0.0};
          std::copy(C, C + 4, r.affine()[p]);
        }
        const double before = r.sums().L[2];
        r.commands("run 1 pre no post no\n");
        change[tpic] = (r.sums().L[2] - before) / std::fabs(before);
        state[tpic] = r.gather();
      }
      for (std::size_t p = 0; p < state[0].size(); p++)
        for (int d = 0; d < 2; d++) ASSERT_NEAR(state[0][p].v[d], state[1][p].v[d], 1e-13);
      EXPECT_NEAR(change[0], 0.0, 1e-13);
      if (affine) {
        EXPECT_NEAR(change[1], 0.0, 1e-13);
        continue;
      }
      EXPECT_GT(measured("change of the angular momentum by tpic", std::fabs(change[1])), 1e-6);
      if (n == 2) continue;
      double mean = 0.0;
      int inside = 0;
      for (int p = 0; p < run[0].n(); p++) {
        const double x = run[0].x()[p][0], y = run[0].x()[p][1];
        ASSERT_NEAR(run[1].x()[p][0], x, 1e-12);
        if (x < 8.0 || x > 12.0 || y < 8.0 || y > 12.0) continue;
        inside++;
        mean += run[1].affine()[p][1] - run[0].affine()[p][1];
      }
      EXPECT_NEAR(mean / inside, 0.06 / 60.0, 0.01 * 0.06 / 60.0);
    }
}
