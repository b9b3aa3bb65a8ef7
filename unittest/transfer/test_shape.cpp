// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

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

/** B-spline at distance x from its node, the centred average of the spline one order lower. */
static double bspline(int order, double x)
{
  if (order == 0) return x >= -0.5 && x < 0.5 ? 1.0 : 0.0;
  const double half = 0.5 * (order + 1);
  return ((half + x) * bspline(order - 1, x + 0.5) + (half - x) * bspline(order - 1, x - 0.5)) /
      order;
}

/** Weights and gradients for the fraction f, and the half size of a point that has one. */
template <class Function> struct Nodes {
  double w[4], dw[4];

  template <class... Size> explicit Nodes(double f, Size... s)
  {
    Function::weights(f, s..., w);
    Function::gradients(f, s..., dw);
  }

  /** At the distances d of the nodes: sum w = 1, sum w d = 0, sum w' = 0, sum w' d = 1. */
  void check_linear_fields(double first, double tolerance) const
  {
    double sum = 0.0, mean = 0.0, dsum = 0.0, dmean = 0.0;
    for (int i = 0; i < Function::nodes; i++) {
      sum += w[i];
      dsum += dw[i];
      mean += w[i] * (first + i);
      dmean += dw[i] * (first + i);
    }
    ASSERT_NEAR(sum, 1.0, TOLERANCE);
    ASSERT_NEAR(mean, 0.0, tolerance);
    ASSERT_NEAR(dsum, 0.0, tolerance);
    ASSERT_NEAR(dmean, 1.0, tolerance);
  }
};

template <class T> class Spline : public ::testing::Test {
};
using Splines = ::testing::Types<BSpline<1>, BSpline<2>, BSpline<3>>;

struct OrderName {
  template <class T> static std::string GetName(int)
  {
    return T::order == 1 ? "linear" : (T::order == 2 ? "quadratic" : "cubic");
  }
};
TYPED_TEST_SUITE(Spline, Splines, OrderName);

TYPED_TEST(Spline, IsTheBSpline)
{
  at_positions<TypeParam>([](double x, double base, double f) {
    const Nodes<TypeParam> at(f);
    for (int i = 0; i < TypeParam::nodes; i++)
      ASSERT_NEAR(at.w[i], bspline(TypeParam::order, x - (base + i)), TOLERANCE) << "x = " << x;
  });
}

TYPED_TEST(Spline, BaseIsTheFirstNodeInReach)
{
  at_positions<TypeParam>([](double x, double base, double f) {
    ASSERT_GE(f, 0.0);
    ASSERT_LT(f, 1.0);
    const Nodes<TypeParam> at(f);
    for (int i = 0; i < TypeParam::nodes; i++) ASSERT_GE(at.w[i], 0.0) << "x = " << x;
    ASSERT_LE(x - base, 0.5 * (TypeParam::order + 1) + TOLERANCE);
  });
}

TYPED_TEST(Spline, LinearFieldsAreExact)
{
  at_positions<TypeParam>([](double, double, double f) {
    Nodes<TypeParam>(f).check_linear_fields(-TypeParam::shift - f, TOLERANCE);
  });
}

TYPED_TEST(Spline, SecondMoment)
{
  at_positions<TypeParam>([](double x, double, double f) {
    const Nodes<TypeParam> at(f);
    double moment = 0.0;
    for (int i = 0; i < TypeParam::nodes; i++) {
      const double distance = i - TypeParam::shift - f;
      moment += at.w[i] * distance * distance;
    }
    // 1/4 for quadratic, 1/3 for cubic; that of the linear function depends on the position
    const double exact = TypeParam::order == 1 ? f * (1.0 - f) : 1.0 / TypeParam::inv_moment;
    ASSERT_NEAR(moment, exact, TOLERANCE) << "x = " << x;
  });
  const double exact[] = {0.0, 0.0, 4.0, 3.0};
  EXPECT_EQ(TypeParam::inv_moment, exact[TypeParam::order]);
}

TYPED_TEST(Spline, GradientIsTheDerivative)
{
  at_positions<TypeParam>([](double x, double, double f) {
    // Central differences: d^2/6 times the third derivative (at most 3, cubic), rounding 1e-16/d.
    const double d = 1.0e-5;
    const Nodes<TypeParam> low(f - d), at(f), high(f + d);
    for (int i = 0; i < TypeParam::nodes; i++)
      ASSERT_NEAR(at.dw[i], (high.w[i] - low.w[i]) / (2.0 * d), 2.0e-10) << "x = " << x;
  });
}

TYPED_TEST(Spline, Symmetry)
{
  at_positions<TypeParam>([](double x, double, double f) {
    const Nodes<TypeParam> at(f), mirrored(1.0 - f);
    for (int i = 0; i < TypeParam::nodes; i++) {
      ASSERT_NEAR(at.w[i], mirrored.w[TypeParam::nodes - 1 - i], TOLERANCE) << "x = " << x;
      ASSERT_NEAR(at.dw[i], -mirrored.dw[TypeParam::nodes - 1 - i], TOLERANCE) << "x = " << x;
    }
  });
}

TYPED_TEST(Spline, ContinuousFromIntervalToInterval)
{
  const Nodes<TypeParam> left(1.0), right(0.0);
  EXPECT_EQ(left.w[0], 0.0);
  EXPECT_EQ(right.w[TypeParam::nodes - 1], 0.0);
  for (int i = 1; i < TypeParam::nodes; i++) {
    EXPECT_NEAR(left.w[i], right.w[i - 1], TOLERANCE);
    if (TypeParam::order > 1) { EXPECT_NEAR(left.dw[i], right.dw[i - 1], TOLERANCE); }
  }
}

TYPED_TEST(Spline, IsConstexpr)
{
  struct Sum {
    static constexpr double at(double f)
    {
      double w[4] = {}, sum = 0.0;
      TypeParam::weights(f, w);
      for (int i = 0; i < TypeParam::nodes; i++) sum += w[i];
      return sum;
    }
  };
  static_assert(Sum::at(0.25) > 0.999 && Sum::at(0.25) < 1.001, "weights at compile time");
}

// Points of finite size: the mean of the linear function over the interval [x - s, x + s].

class GimpShape : public ::testing::TestWithParam<double> {
 protected:
  /** Calls check(distance to the middle node, fraction) at random places and where pieces meet. */
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
    const Nodes<Gimp> at(f, s);
    for (int i = 0; i < 3; i++) {
      const double r = c - (i - 1), mean = (integral(r + s) - integral(r - s)) / (2.0 * s);
      ASSERT_NEAR(at.w[i], mean, TOLERANCE / s) << "c = " << c;
      ASSERT_GE(at.w[i], 0.0);
    }
  });
}

TEST_P(GimpShape, LinearFieldsAreExact)
{
  const double s = GetParam();
  at_positions([s](double c, double f) {
    Nodes<Gimp>(f, s).check_linear_fields(-1.0 - c, TOLERANCE / s);
  });
}

TEST_P(GimpShape, GradientIsTheDerivative)
{
  // Central differences are exact for quadratics; where the second derivative jumps, by at most
  // 1/s, they are off by d/4 times the jump. Rounding adds 1e-16/(s d).
  const double s = GetParam(), d = 1.0e-8;
  at_positions([=](double c, double f) {
    if (std::abs(c) > 0.5 - d) return;
    const Nodes<Gimp> low(f - d, s), at(f, s), high(f + d, s);
    for (int i = 0; i < 3; i++)
      ASSERT_NEAR(at.dw[i], (high.w[i] - low.w[i]) / (2.0 * d), 1.0e-7 / std::min(1.0, 10.0 * s))
          << "c = " << c;
  });
}

TEST_P(GimpShape, WeightAndGradientVanishTogether)
{
  const double s = GetParam();
  at_positions([s](double c, double f) {
    const Nodes<Gimp> at(f, s);
    for (const int i : {0, 2}) {
      if (at.w[i] == 0.0) { ASSERT_EQ(at.dw[i], 0.0) << "c = " << c; }
    }
    if (c >= s) { ASSERT_EQ(at.w[0], 0.0); }
    if (c <= -s) { ASSERT_EQ(at.w[2], 0.0); }
  });
}

INSTANTIATE_TEST_SUITE_P(HalfSizes, GimpShape, ::testing::Values(0.5, 0.37, 0.25, 0.125, 0.01));

TEST(BernsteinShape, LinearFieldsAreExact)
{
  for (double f = 0.0; f <= 1.0; f += 0.01) {
    const double d = 1.0e-4;
    const Nodes<Bernstein> low(f - d), at(f), high(f + d);
    at.check_linear_fields(-2.0 * f, TOLERANCE);
    for (int i = 0; i < 3; i++) {
      EXPECT_GE(at.w[i], 0.0);
      // a cell is two spacings
      EXPECT_NEAR(at.dw[i], 0.5 * (high.w[i] - low.w[i]) / (2.0 * d), 1.0e-11);
    }
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
