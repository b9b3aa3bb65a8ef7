// labels: unit physics
// This file is part of the MPM package for LAMMPS, distributed under the GNU
// General Public License, version 2; see the file LICENSE.

// Analytic tangents of materials against differences of their updates.

#include "material/material_testing.h"
#include "material/random_field.h"
#include "transfer/kernels.h"

#include <set>

using namespace MPM_NS;
using namespace material_testing;

constexpr int COMPONENT[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};

/** Motions of the points of a batch. */
using Motions = std::vector<Matrix>;

/** Makes the step F_new = (I + A) F of points with motions of their own; t: also the tangent. */
void make_step(MaterialPoint &p, const Motions &A, double dt, Tangent *t = nullptr)
{
  Batch &b = p.batch;
  b.dt = dt;
  b.time = p.time += dt;
  for (int i = 0; i < b.n; i++) {
    Matrix F, dF;
    for (int k = 0; k < 9; k++) F[k] = b.F[k][i];
    dF = A[i] * F;
    for (int k = 0; k < 9; k++) {
      b.A[k][i] = A[i][k];
      b.F[k][i] = F[k] += dF[k];
    }
    b.Jold[i] = b.J[i];
    b.J[i] = det(F);
    b.heat[i] = 0.0;
  }
  if (t)
    p.material.update_with_tangent(b, *t);
  else
    p.material.update(b);
}

/** The motions followed by the small one I + h l with a single component l_j. */
Motions followed(Motions A, int j, double h)
{
  for (auto &a : A) {
    const Matrix old = a;
    for (int c = 0; c < 3; c++) a[3 * (j / 3) + c] += h * (old[3 * (j % 3) + c] + (j % 3 == c));
  }
  return A;
}

double kirchhoff(const MaterialPoint &p, int k, int i)
{
  return p.batch.J[i] * p.batch.stress[k][i];
}

/** Largest entry of the tangent of a point. */
double largest(const Tangent &t, int i)
{
  double most = 0.0;
  for (const auto &component : t.stress)
    for (const auto &row : component) most = std::max(most, std::fabs(row[i]));
  return most;
}

/** Compares the tangent of a step with differences of the update, of fourth order in h. Returns the
 *  number of points with another tangent for which the differences are no derivative either, as
 *  there is a kink of the update within 2 h: those in h and 2 h, or to both sides, do not agree. */
int expect_tangent(const MaterialPoint &before, const Motions &A, double dt, double h,
                   double tolerance)
{
  MaterialPoint end(before), same(before);
  Tangent t;
  make_step(end, A, dt, &t);
  make_step(same, A, dt);
  const int n = before.batch.n;
  std::vector<bool> kink(n);
  std::vector<double> most(n), worst(n);
  for (int i = 0; i < n; i++) most[i] = largest(t, i);
  for (int j = 0; j < 9; j++) {
    std::vector<MaterialPoint> moved;
    for (const double x : {-2.0, -1.0, 1.0, 2.0}) {
      moved.emplace_back(before);
      make_step(moved.back(), followed(A, j, x * h), dt);
    }
    for (int i = 0; i < n; i++)
      for (int k = 0; k < 6; k++) {
        const auto tau = [&](int m) {
          return kirchhoff(moved[m], k, i);
        };
        const double here = kirchhoff(same, k, i);
        const double left = (here - tau(0)) / (2 * h), right = (tau(3) - here) / (2 * h);
        const double wide = 0.5 * (left + right), close = (tau(2) - tau(1)) / (2 * h);
        const double slope = (4 * close - wide) / 3;
        if (std::fabs(left - right) > 1e-3 * most[i] ||
            std::fabs(wide - close) > tolerance * most[i])
          kink[i] = true;
        worst[i] = std::max(worst[i], std::fabs(t.stress[k][j][i] - slope) / most[i]);
      }
  }
  int kinks = 0;
  for (int i = 0; i < n; i++)
    if (kink[i] && worst[i] > tolerance)
      kinks++;
    else
      EXPECT_LT(worst[i], tolerance)
          << "point " << i << ", det F " << end.batch.J[i] << ", plastic " << end.batch.plastic[i];
  return kinks;
}

/** Random motions with gradients of 1e-3 to strain, growing with the number of the point, in space,
 *  in the plane xy, or with a strain around an axis in addition. */
enum Kind { SPACE, PLANE, AROUND };
Motions random_motions(RandomMatrix &random, int n, double strain, Kind kind)
{
  Motions A(n);
  for (int i = 0; i < n; i++) {
    A[i] = random(0.4 * 1e-3 * std::pow(strain * 1e3, (i + 0.5) / n));
    if (kind != SPACE)
      for (const int k : {2, 5, 6, 7}) A[i][k] = 0.0;
    if (kind == PLANE) A[i][8] = 0.0;
  }
  return A;
}

/** What is to have a tangent. */
const std::set<std::string> with_tangent = {"linear",
                                            "neohookean",
                                            "neohookean/split",
                                            "stvenant/kirchhoff",
                                            "hencky",
                                            "corotated",
                                            "mooney/rivlin",
                                            "ogden",
                                            "transversely/isotropic",
                                            "orthotropic",
                                            "woven",
                                            "elastic",
                                            "shock+elastic",
                                            "j2",
                                            "j2 power",
                                            "j2 voce",
                                            "j2 swift",
                                            "j2 table",
                                            "j2 kinematic",
                                            "j2 recovery",
                                            "j2 cowper/symonds",
                                            "j2 perzyna",
                                            "melting",
                                            "conducting",
                                            "tait",
                                            "shock cutoff",
                                            "shock spall",
                                            "polynomial",
                                            "ideal gas",
                                            "stiffened gas",
                                            "jwl",
                                            "jwl burning",
                                            "bulk viscosity",
                                            "damped metal",
                                            "bingham",
                                            "herschel/bulkley",
                                            "power",
                                            "maxwell rubber",
                                            "maxwell linear",
                                            "maxwell fluid"};

/** Other compositions. */
const Sample more[] = {
    {"linear stiff", "density 1000 linear 1e6 0.499"},
    {"damped rubber", "density 1000 neohookean 1e6 0.3 viscosity newtonian 10 bulk 20"},
    {"damped linear", "density 1000 linear 1e6 0.3 viscosity newtonian 10 bulk 20"},
    {"heated metal",
     "density 8930 eos shock 3940 1.49 1.96 strength j2 43e9 157e6 hardening linear 425e6 "
     "kinematic 20e9 100 rate perzyna 1e8 1 4 viscosity newtonian 1e3"},
    {"heated gas", "density 1.2 eos ideal/gas 1.4 pressure 1e5 viscosity newtonian 1e3 bulk 1e3"},
    {"heated products",
     "density 1630 eos jwl 371.2e9 3.231e9 4.15 0.95 0.3 7.0e9 6930 viscosity newtonian 1e6"},
    {"heated relaxing metal",
     "density 8930 eos shock 3940 1.49 1.96 strength j2 43e9 157e6 viscosity maxwell term 1e10 "
     "0.01 term 1e9 1"},
    {"heated slurry",
     "density 1000 eos ideal/gas 1.4 pressure 1e5 viscosity herschel/bulkley 1e3 0.5 1e3 1e5"},
    {"adiabatic metal",
     "density 8930 eos linear 1e11 strength j2 43e9 157e6 hardening voce 2e8 15 1e8 "
     "thermal adiabatic 385 300 0.9"},
    {"long table",
     "density 7800 eos linear 160e9 strength j2 80e9 300e6 point 0.01 3.1e8 point 0.02 3.2e8 "
     "point 0.05 3.4e8 point 0.1 3.6e8 point 0.2 4e8 point 0.4 4.4e8 point 0.8 4.6e8 point 1 4.5e8 "
     "point 2 5e8"},
    {"random", "density 7800 linear 1e6 0.3 random E normal 0.2 0.5 7"},
    {"warm rubber",
     "density 1000 hencky 1e6 0.3 thermal conducting 385 300 400 0.9 expansion 1e-3"},
    {"warm steel",
     "density 7800 eos linear 160e9 strength j2 80e9 300e6 hardening voce 2e8 15 1e8 "
     "thermal conducting 385 300 400 0.9 expansion 1e-3 vary SIGMAY table 300 1 400 0.5"},
};

/** Programs without FFTW have no random fields. */
bool can_be(const Sample &sample)
{
  return RandomField::available() || !strstr(sample.text, " random ");
}

void expect_tangents(const Sample &sample, const char *isa, unsigned seed)
{
  const auto material = make(sample.text, isa);
  ASSERT_TRUE(material->has_tangent());
  RandomMatrix random(seed);
  for (const Kind kind : {SPACE, PLANE, AROUND}) {
    SCOPED_TRACE(joined(sample.name, " ", isa, " kind ", int(kind)));
    MaterialPoint p(*material, BATCH);
    for (size_t k = 0; k < material->history().size(); k++)
      if (material->history()[k].name == "temperature")
        for (int i = 0; i < BATCH; i++) p.batch.history[k][i] += i;
    int kinks = 0;
    for (int step = 0; step < 4; step++) {
      const Motions A = random_motions(random, BATCH, 0.3, kind);
      kinks += expect_tangent(p, A, 0.01, 1e-6, 1e-7);
      make_step(p, A, 0.01);
    }
    EXPECT_LE(kinks, 4 * BATCH / 20);
  }
}

const char *const instruction_sets[] = {"reference", "avx2", "avx512"};

TEST(Tangent, IsTheDerivativeOfTheUpdate)
{
  for (const auto &sample : samples) {
    if (!with_tangent.count(sample.name)) continue;
    for (const char *isa : instruction_sets)
      if (MPMKernels::select(isa)) expect_tangents(sample, isa, 1);
  }
}

TEST(Tangent, IsTheDerivativeOfComposedMaterials)
{
  for (const auto &sample : more)
    if (can_be(sample)) expect_tangents(sample, "reference", 2);
}

TEST(Tangent, IsThereForTheseMaterials)
{
  for (const auto &sample : samples)
    EXPECT_EQ(make(sample.text)->has_tangent(), with_tangent.count(sample.name) > 0) << sample.name;
  for (const auto &sample : more)
    if (can_be(sample)) EXPECT_TRUE(make(sample.text)->has_tangent()) << sample.name;
  // a compression that warms, and so expands
  EXPECT_FALSE(
      make("density 1000 hencky 1e6 0.3 thermal adiabatic 385 300 0.9 expansion 1e-4 gruneisen 2")
          ->has_tangent());
}

TEST(Tangent, StepIsTheSameToTheLastBit)
{
  for (const auto &sample : samples) {
    SCOPED_TRACE(sample.name);
    const auto material = make(sample.text);
    if (!material->has_tangent()) continue;
    RandomMatrix random(3);
    MaterialPoint p(*material, BATCH - 3), q(p);
    Tangent t;
    for (int step = 0; step < 5; step++) {
      const Motions A = random_motions(random, BATCH, 0.2, SPACE);
      make_step(p, A, 0.01);
      make_step(q, A, 0.01, &t);
      for (int k = 0; k < 6; k++)
        EXPECT_EQ(memcmp(p.batch.stress[k], q.batch.stress[k], p.batch.n * sizeof(double)), 0);
      EXPECT_EQ(memcmp(p.batch.heat, q.batch.heat, p.batch.n * sizeof(double)), 0);
      EXPECT_EQ(memcmp(p.batch.work, q.batch.work, sizeof(p.batch.work)), 0);
      EXPECT_EQ(p.storage, q.storage);
    }
  }
}

TEST(Tangent, OfMotionsInThePlaneHasTheirColumnsOnly)
{
  const std::set<int> others = {2, 5, 6, 7};
  const double mark = 1234.5;
  for (const auto &sample : samples) {
    SCOPED_TRACE(sample.name);
    const auto material = make(sample.text);
    if (!material->has_tangent()) continue;
    RandomMatrix random(6);
    MaterialPoint p(*material, BATCH), q(p);
    const Motions A = random_motions(random, BATCH, 0.2, SPACE);
    Tangent all, plane;
    plane.plane = true;
    const auto rows = [](Tangent &t, int l) {
      std::vector<double *> rows = {t.heat[l]};
      for (auto &component : t.stress) rows.push_back(component[l]);
      return rows;
    };
    for (const int l : others)
      for (double *row : rows(plane, l)) std::fill_n(row, BATCH, mark);
    make_step(p, A, 0.01, &all);
    make_step(q, A, 0.01, &plane);
    for (int l = 0; l < 9; l++)
      for (size_t k = 0; k < 7; k++)
        for (int i = 0; i < BATCH; i++)
          EXPECT_EQ(rows(plane, l)[k][i], others.count(l) ? mark : rows(all, l)[k][i]);
  }
}

TEST(Tangent, OfStretchesThatAreNearlyEqual)
{
  const double apart[] = {0.0,  1e-15, 1e-13,  1e-11, 1e-9, 1e-8, 1e-7, 1e-6,
                          3e-6, 9e-6,  1.1e-5, 3e-5,  1e-4, 1e-3, 1e-2, 0.1};
  for (const auto &sample : samples)
    for (const double stretch : {0.6, 1.0, 1.5}) {
      SCOPED_TRACE(joined(sample.name, " stretch ", stretch));
      const auto material = make(sample.text);
      if (!material->has_tangent() || !(material->uses_F() || sample.name == samples[0].name))
        continue;
      if (material->is_of_surfaces() && stretch == 1.0) continue;    // yarns begin to bear there
      Motions A;
      for (const double d : apart)
        for (const double third : {0.0, 0.5, 3.0}) {
          const Matrix R = rotation(AXIS, 0.7);
          Matrix F = R *
              diagonal(stretch, stretch * (1.0 + d),
                       stretch * (1.0 + third * (d + 0.1 * (third > 1.0)))) *
              transpose(R);
          for (int k = 0; k < 9; k++) F[k] -= IDENTITY[k];
          A.push_back(F);
        }
      MaterialPoint p(*material, A.size());
      EXPECT_EQ(expect_tangent(p, A, 0.01, 1e-6, 1e-7), 0);
    }
}

TEST(Tangent, HyperelasticIsSymmetric)
{
  for (const auto &sample : samples) {
    SCOPED_TRACE(sample.name);
    const auto material = make(sample.text);
    if (!material->has_tangent() || !material->uses_F()) continue;
    RandomMatrix random(4);
    MaterialPoint p(*material, BATCH);
    Tangent t;
    make_step(p, random_motions(random, BATCH, 0.3, SPACE), 0.01, &t);
    for (int i = 0; i < BATCH; i++) {
      // d(J sigma) - J sigma l^T, what a change of F does to P F^T
      double a[9][9];
      for (int k = 0; k < 9; k++)
        for (int l = 0; l < 9; l++)
          a[k][l] = t.stress[COMPONENT[k / 3][k % 3]][l][i] -
              (k % 3 == l / 3 ? kirchhoff(p, COMPONENT[k / 3][l % 3], i) : 0.0);
      for (int k = 0; k < 9; k++)
        for (int l = 0; l < k; l++)
          EXPECT_NEAR(a[k][l], a[l][k], 1e-10 * largest(t, i)) << k << " " << l;
    }
  }
}

TEST(Tangent, OnBothSidesOfYield)
{
  // by a part in 1e4 of the strain at yield
  for (const char *text :
       {"density 7800 eos linear 160e9 strength j2 80e9 300e6 hardening linear 1e9",
        "density 7800 eos linear 160e9 strength j2 80e9 300e6 hardening voce 2e8 15 1e8",
        "density 7800 eos linear 160e9 strength j2 80e9 300e6 kinematic 20e9 100"}) {
    SCOPED_TRACE(text);
    const auto material = make(text);
    RandomMatrix random(5);
    Motions A;
    for (int i = 0; i < BATCH; i++) {
      const Matrix direction = random(1.0);
      const auto scaled = [&](double x) {
        Matrix a = direction;
        for (double &value : a) value *= x;
        return a;
      };
      const double yields = root_of(0.0, 0.1, [&](double x) {
        MaterialPoint p(*material);
        make_step(p, {scaled(x)}, 1.0);
        return p.batch.plastic[0];
      });
      A.push_back(scaled(yields * (i % 2 ? 1.0 + 1e-4 : 1.0 - 1e-4)));
    }
    MaterialPoint p(*material, BATCH);
    EXPECT_EQ(expect_tangent(p, A, 1.0, 3e-9, 1e-6), 0);
    make_step(p, A, 1.0);
    for (int i = 0; i < BATCH; i++) EXPECT_EQ(p.batch.plastic[i] > 0.0, i % 2 == 1);
  }
}

// without motion, and with motions so small that squares of strains or stresses underflow, in SI
// and other units: finite, and the same as that of a small motion
TEST(Tangent, OfNextToNoMotion)
{
  std::vector<Sample> all(std::begin(samples), std::end(samples));
  all.insert(all.end(), std::begin(more), std::end(more));
  for (const Sample &one :
       {Sample{"tough steel", "density 7800 eos linear 160e9 strength j2 80e9 1e30"},
        Sample{"stiff rubber", "density 1000 neohookean 1e15 0.3"},
        Sample{"stiff ogden", "density 1000 hencky 1e15 0.3"},
        Sample{"soft gel", "density 1e-21 neohookean/split 1e-15 0.45"},
        Sample{"soft metal", "density 1e-21 eos linear 1e-15 strength j2 1e-15 1e-17"},
        Sample{"hard metal",
               "density 1e21 eos linear 1e20 strength j2 1e20 1e17 hardening linear 1e18"}})
    all.push_back(one);
  for (const auto &sample : all) {
    if (!can_be(sample)) continue;
    const auto material = make(sample.text);
    if (!material->has_tangent()) continue;
    if (material->is_of_surfaces()) continue;    // each of the yarns has two sides
    SCOPED_TRACE(sample.name);
    Motions A;
    for (const double size :
         {1e-9, -1e-9, 0.0, 5e-324, 1e-310, 1e-200, 1e-160, 1e-150, 1e-80, 1e-30, 1e-17})
      for (const int shape : {0, 1}) {
        Matrix a = diagonal(shape ? 0.0 : size, 0.0, 0.0);
        a[1] = size;
        A.push_back(a);
      }
    MaterialPoint p(*material, A.size());
    Tangent t;
    make_step(p, A, 0.01, &t);
    for (std::size_t i = 0; i < A.size(); i++) {
      // of extension or compression, where these differ
      double worst[2] = {};
      for (int k = 0; k < 6; k++)
        for (int l = 0; l < 9; l++)
          for (const int side : {0, 1}) {
            const double difference = std::fabs(t.stress[k][l][i] - t.stress[k][l][2 * side]);
            // also where one is not a number
            if (!(difference <= worst[side])) worst[side] = difference;
          }
      const double least = std::min(worst[0], worst[1]);
      EXPECT_LE(least, 4e-8 * largest(t, 0)) << "motion " << A[i][0] << " " << A[i][1];
    }
  }
}

TEST(Tangent, ConvergesQuadratically)
{
  // uniaxial stress after a large plastic strain, by Newton's method for lateral stretches
  const auto material =
      make("density 7800 eos linear 160e9 strength j2 80e9 300e6 hardening voce 2e8 15 1e8");
  MaterialPoint before(*material);
  Matrix A = diagonal(0.05, -0.02, -0.02);
  std::vector<double> residuals;
  for (int iteration = 0; iteration < 12; iteration++) {
    MaterialPoint p(before);
    Tangent t;
    make_step(p, {A}, 1.0, &t);
    const double y = kirchhoff(p, 1, 0), z = kirchhoff(p, 2, 0);
    residuals.push_back(std::hypot(y, z) / kirchhoff(p, 0, 0));
    const double yy = t.stress[1][4][0], yz = t.stress[1][8][0], zy = t.stress[2][4][0],
                 zz = t.stress[2][8][0];
    const double d = yy * zz - yz * zy;
    A[4] -= (1.0 + A[4]) * (zz * y - yz * z) / d;
    A[8] -= (1.0 + A[8]) * (yy * z - zy * y) / d;
  }
  EXPECT_LT(residuals.back(), 1e-12);
  for (std::size_t k = 1; k < residuals.size(); k++)
    if (residuals[k - 1] < 1e-2) {
      EXPECT_LT(residuals[k], 100 * residuals[k - 1] * residuals[k - 1] + 1e-13);
    }
}
