/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// labels: unit

// Identities of the B-splines, at random positions.
//
// Tolerance: a weight is computed with a few roundings of numbers that are at most 1, and sums
// have at most four terms with distances up to 2, so errors are a small multiple of 2.2e-16; 1e-14
// leaves a factor of about ten and is far below any mistake in a coefficient.

#include "transfer/shape.h"

#include "gtest/gtest.h"

#include <cmath>
#include <random>

using namespace MPM_NS;

static constexpr double TOLERANCE = 1.0e-14;
static constexpr int POSITIONS = 10000;

/** Calls check(position, base node, fraction) at random positions and at ends of an interval. */
template <class Spline, class Check> static void at_positions(Check check)
{
  std::mt19937 random(4711);
  std::uniform_real_distribution<double> uniform(-8.0, 8.0);
  for (int n = 0; n < POSITIONS; n++) {
    const double x = n == 0 ? Spline::shift : (n == 1 ? std::nextafter(1.0, 0.0) : uniform(random));
    const double base = std::floor(x - Spline::shift);
    check(x, base, x - Spline::shift - base);
  }
}

/** Value of the B-spline of the order at distance x from its node, from its textbook definition as
 *  the centred average of the spline one order lower. */
static double bspline(int order, double x)
{
  if (order == 0) return x >= -0.5 && x < 0.5 ? 1.0 : 0.0;
  const double half = 0.5 * (order + 1);
  return ((half + x) * bspline(order - 1, x + 0.5) + (half - x) * bspline(order - 1, x - 0.5)) /
      order;
}

template <class T> class Shape : public ::testing::Test {
};
template <int N> struct Order {
  static constexpr int value = N;
};
using Orders = ::testing::Types<Order<1>, Order<2>, Order<3>>;

struct OrderName {
  template <class T> static std::string GetName(int)
  {
    return T::value == 1 ? "linear" : (T::value == 2 ? "quadratic" : "cubic");
  }
};
TYPED_TEST_SUITE(Shape, Orders, OrderName);

TYPED_TEST(Shape, IsTheBSpline)
{
  using Spline = BSpline<TypeParam::value>;
  at_positions<Spline>([](double x, double base, double f) {
    double w[4];
    Spline::weights(f, w);
    for (int i = 0; i < Spline::nodes; i++)
      ASSERT_NEAR(w[i], bspline(TypeParam::value, x - (base + i)), TOLERANCE) << "x = " << x;
  });
}

TYPED_TEST(Shape, BaseIsTheFirstNodeInReach)
{
  using Spline = BSpline<TypeParam::value>;
  at_positions<Spline>([](double x, double base, double f) {
    ASSERT_GE(f, 0.0);
    ASSERT_LT(f, 1.0);
    double w[4];
    Spline::weights(f, w);
    for (int i = 0; i < Spline::nodes; i++) ASSERT_GE(w[i], 0.0) << "x = " << x;
    ASSERT_LE(x - base, 0.5 * (TypeParam::value + 1) + TOLERANCE);
  });
}

TYPED_TEST(Shape, PartitionOfUnity)
{
  using Spline = BSpline<TypeParam::value>;
  at_positions<Spline>([](double x, double, double f) {
    double w[4], dw[4], sum = 0.0, dsum = 0.0;
    Spline::weights(f, w);
    Spline::gradients(f, dw);
    for (int i = 0; i < Spline::nodes; i++) {
      sum += w[i];
      dsum += dw[i];
    }
    ASSERT_NEAR(sum, 1.0, TOLERANCE) << "x = " << x;
    ASSERT_NEAR(dsum, 0.0, TOLERANCE) << "x = " << x;
  });
}

TYPED_TEST(Shape, LinearCompleteness)
{
  using Spline = BSpline<TypeParam::value>;
  at_positions<Spline>([](double x, double, double f) {
    double w[4], dw[4], sum = 0.0, dsum = 0.0;
    Spline::weights(f, w);
    Spline::gradients(f, dw);
    for (int i = 0; i < Spline::nodes; i++) {
      const double distance = i - Spline::shift - f;
      sum += w[i] * distance;
      dsum += dw[i] * distance;
    }
    ASSERT_NEAR(sum, 0.0, TOLERANCE) << "x = " << x;
    ASSERT_NEAR(dsum, 1.0, TOLERANCE) << "x = " << x;
  });
}

TYPED_TEST(Shape, SecondMoment)
{
  using Spline = BSpline<TypeParam::value>;
  at_positions<Spline>([](double x, double, double f) {
    double w[4], moment = 0.0;
    Spline::weights(f, w);
    for (int i = 0; i < Spline::nodes; i++) {
      const double distance = i - Spline::shift - f;
      moment += w[i] * distance * distance;
    }
    // 1/4 for quadratic, 1/3 for cubic; that of the linear function depends on the position
    const double exact = TypeParam::value == 1 ? f * (1.0 - f) : 1.0 / Spline::inv_moment;
    ASSERT_NEAR(moment, exact, TOLERANCE) << "x = " << x;
  });
  const double exact[] = {0.0, 0.0, 4.0, 3.0};
  EXPECT_EQ(Spline::inv_moment, exact[TypeParam::value]);
}

TYPED_TEST(Shape, GradientIsTheDerivative)
{
  using Spline = BSpline<TypeParam::value>;
  at_positions<Spline>([](double x, double, double f) {
    // Central differences with the step d are exact up to d^2/6 times the third derivative (at most
    // 3, cubic only) and the rounding error 1e-16 / d.
    const double d = 1.0e-5;
    double low[4], high[4], dw[4];
    Spline::weights(f - d, low);
    Spline::weights(f + d, high);
    Spline::gradients(f, dw);
    for (int i = 0; i < Spline::nodes; i++)
      ASSERT_NEAR(dw[i], (high[i] - low[i]) / (2.0 * d), 2.0e-10) << "x = " << x;
  });
}

TYPED_TEST(Shape, Symmetry)
{
  using Spline = BSpline<TypeParam::value>;
  at_positions<Spline>([](double x, double, double f) {
    double w[4], mirrored[4], dw[4], dmirrored[4];
    Spline::weights(f, w);
    Spline::weights(1.0 - f, mirrored);
    Spline::gradients(f, dw);
    Spline::gradients(1.0 - f, dmirrored);
    for (int i = 0; i < Spline::nodes; i++) {
      ASSERT_NEAR(w[i], mirrored[Spline::nodes - 1 - i], TOLERANCE) << "x = " << x;
      ASSERT_NEAR(dw[i], -dmirrored[Spline::nodes - 1 - i], TOLERANCE) << "x = " << x;
    }
  });
}

TYPED_TEST(Shape, ContinuousFromIntervalToInterval)
{
  using Spline = BSpline<TypeParam::value>;
  double left[4], right[4], dleft[4], dright[4];
  Spline::weights(1.0, left);
  Spline::weights(0.0, right);
  Spline::gradients(1.0, dleft);
  Spline::gradients(0.0, dright);
  EXPECT_EQ(left[0], 0.0);
  EXPECT_EQ(right[Spline::nodes - 1], 0.0);
  for (int i = 1; i < Spline::nodes; i++) {
    EXPECT_NEAR(left[i], right[i - 1], TOLERANCE);
    if (TypeParam::value > 1) { EXPECT_NEAR(dleft[i], dright[i - 1], TOLERANCE); }
  }
}

TYPED_TEST(Shape, IsConstexpr)
{
  using Spline = BSpline<TypeParam::value>;
  struct Sum {
    static constexpr double at(double f)
    {
      double w[4] = {}, sum = 0.0;
      Spline::weights(f, w);
      for (int i = 0; i < Spline::nodes; i++) sum += w[i];
      return sum;
    }
  };
  static_assert(Sum::at(0.25) > 0.999 && Sum::at(0.25) < 1.001, "weights at compile time");
}

// The cubic B-spline for single precision.

TEST(SixfoldCubicShape, IsSixTimesTheCubic)
{
  at_positions<BSpline<3>>([](double x, double, double f) {
    double w[4], dw[4], exact[4], dexact[4];
    SixfoldCubic::weights(f, w);
    SixfoldCubic::gradients(f, dw);
    BSpline<3>::weights(f, exact);
    BSpline<3>::gradients(f, dexact);
    for (int i = 0; i < 4; i++) {
      ASSERT_NEAR(w[i], 6.0 * exact[i], 6.0 * TOLERANCE) << "x = " << x;
      ASSERT_NEAR(dw[i], 6.0 * dexact[i], 6.0 * TOLERANCE) << "x = " << x;
    }
  });
}

/** A float with the arithmetic of a vector of floats: numbers are rounded, then combined. */
struct Single {
  float a;
  Single operator+(Single b) const { return {a + b.a}; }
  Single operator-(Single b) const { return {a - b.a}; }
  Single operator*(Single b) const { return {a * b.a}; }
  friend Single operator+(Single a, double s) { return {a.a + static_cast<float>(s)}; }
  friend Single operator-(Single a, double s) { return {a.a - static_cast<float>(s)}; }
  friend Single operator+(double s, Single a) { return {static_cast<float>(s) + a.a}; }
  friend Single operator-(double s, Single a) { return {static_cast<float>(s) - a.a}; }
  friend Single operator*(double s, Single a) { return {static_cast<float>(s) * a.a}; }
};

/** Mean errors of the sums of weights (less one) and of gradients, and of their first moments (less the
 *  position, less one), over fractions that are floats. */
template <class Spline> static void mean_errors(double multiple, double shift, double *mean)
{
  const int n = 1000000;
  std::mt19937 random(4711);
  for (int k = 0; k < 4; k++) mean[k] = 0.0;
  for (int p = 0; p < n; p++) {
    const float f = std::ldexp(static_cast<float>(random() >> 9), -23);
    Single w[4], dw[4];
    Spline::weights(Single{f}, w);
    Spline::gradients(Single{f}, dw);
    double error[4] = {-1.0, -(f + shift), 0.0, -1.0};
    for (int i = 0; i < Spline::nodes; i++) {
      error[0] += w[i].a / multiple;
      error[1] += i * (w[i].a / multiple);
      error[2] += dw[i].a / multiple;
      error[3] += i * (dw[i].a / multiple);
    }
    for (int k = 0; k < 4; k++) mean[k] += error[k] / n;
  }
}

// What single precision rounds must be as often up as down. Each of these sums has rounding errors of
// the size 2^-24 = 6e-8; the mean of a million is zero within 6e-11, and five times that is allowed. The
// rounded coefficients 1/6 and 2/3 of the cubic B-spline give a sum that is too large by 4e-8

TEST(SinglePrecision, RoundingFavorsNoNode)
{
  double mean[4];
  const auto check = [&](const char *name) {
    for (int k = 0; k < 4; k++) EXPECT_NEAR(mean[k], 0.0, 3.0e-10) << name << " " << k;
  };
  mean_errors<BSpline<2>>(1.0, 0.5, mean);
  check("quadratic");
  mean_errors<SixfoldCubic>(SixfoldCubic::multiple, 1.0, mean);
  check("cubic");
  mean_errors<BSpline<3>>(1.0, 1.0, mean);
  EXPECT_GT(std::abs(mean[0]), 3.0e-8);
}

// Points of finite size: the mean of the linear function over the interval [x - s, x + s].

class GimpShape : public ::testing::TestWithParam<double> {
 protected:
  /** Calls check(distance to the middle node, fraction) at random places and at those where the
   *  function changes its form. */
  template <class Check> void at_positions(Check check) const
  {
    const double s = GetParam();
    std::mt19937 random(4711);
    std::uniform_real_distribution<double> uniform(-0.5, 0.5);
    for (const double c : {-0.5, -s, 0.0, s}) check(c, c + 0.5);
    for (int n = 0; n < POSITIONS; n++) {
      const double c = uniform(random);
      check(c, c + 0.5);
    }
  }
};

/** Integral of the linear function from minus infinity to u. */
static double integral(double u)
{
  if (u <= -1.0) return 0.0;
  if (u >= 1.0) return 1.0;
  return u < 0.0 ? 0.5 * (1.0 + u) * (1.0 + u) : 1.0 - 0.5 * (1.0 - u) * (1.0 - u);
}

TEST_P(GimpShape, IsTheMean)
{
  const double s = GetParam();
  at_positions([s](double c, double f) {
    double w[3];
    Gimp::weights(f, s, w);
    for (int i = 0; i < 3; i++) {
      const double r = c - (i - 1), mean = (integral(r + s) - integral(r - s)) / (2.0 * s);
      ASSERT_NEAR(w[i], mean, TOLERANCE / s) << "c = " << c;
      ASSERT_GE(w[i], 0.0);
    }
  });
}

TEST_P(GimpShape, PartitionOfUnityAndLinearCompleteness)
{
  const double s = GetParam();
  at_positions([s](double c, double f) {
    double w[3], dw[3], sum = 0.0, first = 0.0, dsum = 0.0, dfirst = 0.0;
    Gimp::weights(f, s, w);
    Gimp::gradients(f, s, dw);
    for (int i = 0; i < 3; i++) {
      sum += w[i];
      dsum += dw[i];
      first += w[i] * (i - 1 - c);
      dfirst += dw[i] * (i - 1 - c);
    }
    ASSERT_NEAR(sum, 1.0, TOLERANCE) << "c = " << c;
    ASSERT_NEAR(dsum, 0.0, TOLERANCE / s) << "c = " << c;
    ASSERT_NEAR(first, 0.0, TOLERANCE / s) << "c = " << c;
    ASSERT_NEAR(dfirst, 1.0, TOLERANCE / s) << "c = " << c;
  });
}

TEST_P(GimpShape, GradientIsTheDerivative)
{
  // Central differences are exact for quadratics; where the second derivative jumps, by at most
  // 1/s, they are off by d/4 times the jump. Rounding adds 1e-16/(s d).
  const double s = GetParam(), d = 1.0e-8;
  at_positions([=](double c, double f) {
    if (std::abs(c) > 0.5 - d) return;
    double low[3], high[3], dw[3];
    Gimp::weights(f - d, s, low);
    Gimp::weights(f + d, s, high);
    Gimp::gradients(f, s, dw);
    for (int i = 0; i < 3; i++)
      ASSERT_NEAR(dw[i], (high[i] - low[i]) / (2.0 * d), 1.0e-7 / std::min(1.0, 10.0 * s))
          << "c = " << c;
  });
}

TEST_P(GimpShape, WeightAndGradientVanishTogether)
{
  const double s = GetParam();
  at_positions([s](double c, double f) {
    double w[3], dw[3];
    Gimp::weights(f, s, w);
    Gimp::gradients(f, s, dw);
    for (const int i : {0, 2}) {
      if (w[i] == 0.0) { ASSERT_EQ(dw[i], 0.0) << "c = " << c; }
    }
    if (c >= s) { ASSERT_EQ(w[0], 0.0); }
    if (c <= -s) { ASSERT_EQ(w[2], 0.0); }
  });
}

INSTANTIATE_TEST_SUITE_P(HalfSizes, GimpShape, ::testing::Values(0.5, 0.37, 0.25, 0.125, 0.01));

TEST(BernsteinShape, PartitionOfUnityAndLinearCompleteness)
{
  for (double f = 0.0; f <= 1.0; f += 0.01) {
    double w[3], dw[3], low[3], high[3], sum = 0.0, first = 0.0, dsum = 0.0, dfirst = 0.0;
    const double d = 1.0e-4;
    Bernstein::weights(f, w);
    Bernstein::gradients(f, dw);
    Bernstein::weights(f - d, low);
    Bernstein::weights(f + d, high);
    for (int i = 0; i < 3; i++) {
      EXPECT_GE(w[i], 0.0);
      sum += w[i];
      dsum += dw[i];
      first += w[i] * i;
      dfirst += dw[i] * i;
      EXPECT_NEAR(dw[i], 0.5 * (high[i] - low[i]) / (2.0 * d),
                  1.0e-11);    // a cell is two spacings
    }
    EXPECT_NEAR(sum, 1.0, TOLERANCE);
    EXPECT_NEAR(dsum, 0.0, TOLERANCE);
    EXPECT_NEAR(first, 2.0 * f, TOLERANCE);
    EXPECT_NEAR(dfirst, 1.0, TOLERANCE);
  }
}

// a point as large as a cell has the quadratic B-spline, one of no size the linear function
TEST(GimpLimits, AreSplines)
{
  for (double f = 0.0; f < 1.0; f += 0.01) {
    double w[3], spline[3], hat[2];
    Gimp::weights(f, 0.5, w);
    BSpline<2>::weights(f, spline);
    for (int i = 0; i < 3; i++) EXPECT_NEAR(w[i], spline[i], TOLERANCE);
    if (std::abs(f - 0.5) < 1.0e-4) continue;
    Gimp::weights(f, 1.0e-4, w);
    BSpline<1>::weights(f < 0.5 ? f + 0.5 : f - 0.5, hat);
    for (int i = 0; i < 2; i++) EXPECT_NEAR(w[f < 0.5 ? i : i + 1], hat[i], 1.0e-11);
  }
}
