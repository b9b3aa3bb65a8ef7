// labels: unit physics
// This file is part of the MPM package for LAMMPS, distributed under the GNU
// General Public License, version 2; see the file LICENSE.

// The law of fabrics at a point and on a surface, against closed forms and pin-jointed yarns.

#include "material/plane_stress_testing.h"

using namespace MPM_NS;
using namespace material_testing;

constexpr double E1 = 2e8, E2 = 0.5e8, G = 1e6, DEGREE = M_PI / 180.0;

std::string woven(double E, double F, double shear, const std::string &more = "")
{
  return joined("density 800 woven ", E, " ", F, " ", shear, " ", more);
}

/** First Piola-Kirchhoff stress: work on a change of F per reference volume. */
Matrix nominal(const MaterialPoint &p)
{
  Matrix F, P;
  for (int c = 0; c < 9; c++) F[c] = p.batch.F[c][0];
  const double *const f = F.data();
  const double cofactors[9] = MPM_COFACTORS(f);
  const Matrix s = stress_of(p);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      P[3 * i + j] = 0.0;
      for (int k = 0; k < 3; k++) P[3 * i + j] += s[3 * i + k] * cofactors[3 * k + j];
    }
  return P;
}

/** Unit yarns that were at 0 and theta degrees, turned towards each other, gamma in all. */
Matrix pinned(double theta, double gamma)
{
  const double a = 0.5 * gamma, t = theta * DEGREE, b = t - a;
  // F (1 0) = (cos a, sin a), F (cos t, sin t) = (cos b, sin b)
  const double x = (std::cos(b) - std::cos(t) * std::cos(a)) / std::sin(t),
               y = (std::sin(b) - std::cos(t) * std::sin(a)) / std::sin(t);
  return {std::cos(a), x, 0, std::sin(a), y, 0, 0, 0, 1};
}

// force per width of warp or weft, at any angle, in tension; none in compression or across yarns
TEST(Woven, TensionAlongYarns)
{
  for (const double theta : {90.0, 60.0, 135.0})
    for (const double stretch : {1.0001, 1.05, 1.4, 0.9}) {
      SCOPED_TRACE(joined(theta, " ", stretch));
      const auto material = make(woven(E1, E2, G, joined("angle ", theta)));
      // along the warp, with a width at which the angle of yarns, and the length of the weft, stay
      const double t = theta * DEGREE;
      for (const int family : {0, 1}) {
        const double E = family == 0 ? E1 : E2;
        // with the other yarns' direction fixed: F = stretch a a* + b b*, in the dual basis
        const double a[2] = {1.0, 0.0}, b[2] = {std::cos(t), std::sin(t)};
        const double da[2] = {1.0, -std::cos(t) / std::sin(t)}, db[2] = {0.0, 1.0 / std::sin(t)};
        Matrix F = IDENTITY;
        for (int i = 0; i < 2; i++)
          for (int j = 0; j < 2; j++)
            F[3 * i + j] = (family == 0 ? stretch : 1.0) * a[i] * da[j] +
                (family == 1 ? stretch : 1.0) * b[i] * db[j];
        MaterialPoint p(*material);
        move_to(p, F);
        const Matrix s = stress_of(p);
        const double *const n = family == 0 ? a : b;
        const double J = p.batch.J[0], tension = stretch > 1.0 ? E * (stretch - 1.0) : 0.0;
        const double scale = E1 * std::fabs(stretch - 1.0);
        for (int i = 0; i < 3; i++)
          for (int j = 0; j < 3; j++) {
            const double expected = i < 2 && j < 2 ? tension * stretch * n[i] * n[j] / J : 0.0;
            EXPECT_NEAR(s[3 * i + j], expected, 1e-11 * scale) << i << j;
          }
        EXPECT_NEAR(p.stored_energy(), 0.5 * tension * (stretch - 1.0), 1e-11 * scale);
      }
    }
}

// picture frame: the work of the corners' moment is G gamma^2/2, and more beyond the locking angle
TEST(Woven, PictureFrame)
{
  const double lock = 40.0, GL = 2e7;
  for (const double theta : {90.0, 70.0}) {
    const auto material =
        make(woven(E1, E2, G, joined("angle ", theta, " locking ", lock, " ", GL)));
    for (const double degrees : {-55.0, -20.0, 1e-4, 10.0, 39.9, 40.1, 55.0}) {
      SCOPED_TRACE(joined(theta, " ", degrees));
      const double gamma = degrees * DEGREE, size = std::fabs(gamma), l = lock * DEGREE;
      const double over = std::max(size - l, 0.0), under = size - over;
      const double energy = 0.5 * G * under * under + G * under * over + 0.5 * GL * over * over;
      const double moment = std::copysign(G * under + GL * over, gamma);
      MaterialPoint p(*material);
      move_to(p, pinned(theta, gamma));
      EXPECT_NEAR(p.stored_energy() / energy, 1.0, 1e-9);
      // the power of the stress in a change of the frame alone
      const double d = 1e-6;
      const Matrix more = pinned(theta, gamma + d), less = pinned(theta, gamma - d), P = nominal(p);
      double work = 0.0;
      for (int c = 0; c < 9; c++) work += P[c] * (more[c] - less[c]) / (2.0 * d);
      EXPECT_NEAR(work / moment, 1.0, 8e-10);
    }
  }
}

// Pulled along the bias, with free sides, yarns that hardly stretch turn like pin-jointed rods: a
// stretch of sqrt(2) cos(theta/2), and a force by virtual work of M sqrt(2)/sin(theta/2) per
// reference area. Stiffer yarns are closer to this, with an error that falls as 1/E
TEST(Woven, BiasExtensionIsATrellis)
{
  const double stretch = 1.25, half = std::acos(stretch / std::sqrt(2.0)),
               gamma = 0.5 * M_PI - 2.0 * half;
  const double force = G * gamma * std::sqrt(2.0) / std::sin(half);
  const Matrix R = rotation({0, 0, 1}, 0.25 * M_PI);
  double errors[2];
  for (const int stiff : {0, 1}) {
    const double E = stiff ? 1e6 * G : 1e4 * G;
    const auto material = make(woven(E, E, G));
    const auto at = [&](double side) {
      MaterialPoint p(*material);
      // the bias is along x: yarns at -45 and 45 degrees
      move_to(p, diagonal(stretch, side, 1.0) * transpose(R));
      return p;
    };
    const double side = root_of(0.3, 1.0, [&](double side) {
      return at(side).stress(1);
    });
    const MaterialPoint p = at(side);
    errors[stiff] = std::fabs(p.stress(0) * p.batch.J[0] / stretch / force - 1.0) +
        std::fabs(side / (std::sqrt(2.0) * std::sin(half)) - 1.0);
  }
  EXPECT_LT(errors[1], 1e-4);
  EXPECT_NEAR(errors[0] / errors[1], 100.0, 0.6);
}

// a surface with any normal, turned in space: the stress of the law in its own axes, turned; also
// of wood. The deformation gradient that is kept is that of space, not of the axes
TEST(Woven, AxesLieOnSurfaces)
{
  const Matrix turn = rotation(AXIS, 0.9), later = rotation({0.6, -0.8, 0.0}, 1.7);
  for (const std::string &text :
       {woven(E1, E2, G, "angle 75"),
        std::string(
            "density 440 orthotropic 11e9 0.9e9 0.5e9 0.37 0.47 0.43 0.7e9 0.65e9 0.04e9")}) {
    SCOPED_TRACE(text);
    Matrix flat = {1.02, 0.3, 0, 0.1, 1.05, 0, 0, 0, 1};
    Surface cloth(text, 3, 2, true, true, {turn[0], turn[3], turn[6]}, {turn[1], turn[4], turn[7]});
    const Matrix s = cloth.go(later * flat * transpose(turn));
    flat[8] = 0.0;
    double thickness = 0.0;    // of the deformed surface
    const Matrix back = transpose(later) *
        Matrix{cloth.old[0], cloth.old[1], cloth.old[2], cloth.old[3], cloth.old[4],
               cloth.old[5], cloth.old[6], cloth.old[7], cloth.old[8]} *
        turn;
    thickness = flat[8] = back[8];
    EXPECT_LT(distance(back, flat), 1e-12);
    MaterialPoint p(*cloth.material);
    move_to(p, flat);
    const Matrix expected = later * stress_of(p) * transpose(later);
    EXPECT_LT(distance(s, expected), 1e-12 * size(expected));
    EXPECT_NEAR(p.stress(2) / size(expected), 0.0, 1e-11);
    if (text.find("woven") != std::string::npos) EXPECT_NEAR(thickness, 1.0, 1e-15);
  }
}

TEST(Woven, Refuses)
{
  const auto message = [](const std::string &text, int along, bool compression,
                          bool axes) -> std::string {
    try {
      const auto material = make(text);
      PlaneStress state(*material, 3, along, compression, axes);
      if (!axes) state.elastic_constants();
    } catch (const std::runtime_error &e) {
      return e.what();
    }
    return "";
  };
  const std::string cloth = woven(E1, E2, G);
  EXPECT_EQ(message(cloth, 2, true, true), "");
  EXPECT_EQ(message(cloth, 2, true, false), "it must be isotropic");
  EXPECT_NE(message(cloth, 2, false, true).find("resist compression"), std::string::npos);
  EXPECT_NE(message(cloth, 1, true, true).find("surfaces"), std::string::npos);
  EXPECT_NE(message("density 1 neohookean 1 0.3", 2, true, true).find("has no axes"),
            std::string::npos);
  EXPECT_NE(message("density 440 orthotropic 11e9 0.9e9 0.5e9 0.37 0.47 0.43 0.7e9 0.65e9 0.04e9 "
                    "axes 1 0 0.5 0 1 0",
                    2, true, true)
                .find("no plane of symmetry"),
            std::string::npos);
  for (const char *more : {"angle 0", "angle 180", "locking 0 1", "locking 30 -1", "locking 30"})
    EXPECT_THROW(make(woven(E1, E2, G, more)), std::exception) << more;
  EXPECT_THROW(make("density 1 woven 1 1 0"), std::exception);
}
