// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MATERIAL_TESTING_H
#define MATERIAL_TESTING_H

// Tools for tests of constitutive laws: 3x3 matrices, motions of a point, and samples of all laws.
// This header includes the standard headers that these tests need.

#include "material/material_point.h"
#include "math/matrix.h"
#include "patterns.h"
#include "root_of.h"

#include "gtest/gtest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace material_testing {

using MPM_NS::Batch;
using MPM_NS::Material;
using MPM_NS::MaterialPoint;
using MPM_TEST::root_of;

using Matrix = std::array<double, 9>;
constexpr Matrix IDENTITY = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/** Texts and numbers joined to one text, with 17 digits of the numbers. */
template <class... Parts> std::string joined(const Parts &...parts)
{
  std::ostringstream text;
  text.precision(17);
  (text << ... << parts);
  return text.str();
}

inline std::vector<std::string> words_of(const std::string &text)
{
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

/** The material with this definition. isa: instruction set; null: the default. */
inline std::unique_ptr<Material> make(const std::string &text, const char *isa = nullptr)
{
  return Material::create(words_of(text), isa);
}

/** A point that owns its material. */
struct Held {
  std::unique_ptr<Material> held;
};
struct Point : private Held, public MaterialPoint {
  template <class... Args>
  explicit Point(const std::string &text, Args... args) :
      Held{make(text)}, MaterialPoint(*held, args...)
  {
  }
};

/** The definition in a material file of the folder potentials, without comments. */
inline std::string definition(const std::string &name)
{
  std::ifstream file(std::string(MPM_SOURCE_DIR) + "/potentials/" + name + ".mpm");
  if (!file) throw std::runtime_error("no material file " + name);
  std::string text;
  for (std::string line; std::getline(file, line);) text += line.substr(0, line.find('#')) + " ";
  return text;
}

inline Matrix operator*(const Matrix &a, const Matrix &b)
{
  Matrix c;
  for (int k = 0; k < 9; k++) c[k] = MPM_NS::product(a.data(), b.data(), k / 3, k % 3);
  return c;
}

inline Matrix transpose(const Matrix &a)
{
  return {a[0], a[3], a[6], a[1], a[4], a[7], a[2], a[5], a[8]};
}

inline Matrix diagonal(double x, double y, double z)
{
  return {x, 0, 0, 0, y, 0, 0, 0, z};
}
inline Matrix isotropic(double x)
{
  return diagonal(x, x, x);
}
inline Matrix uniaxial_stretch(double l)
{
  return diagonal(l, 1, 1);
}

inline double det(const Matrix &F)
{
  return MPM_NS::determinant(F.data());
}

/** Moves a point of a batch by I + A. */
inline void displace(Batch &b, int i, Matrix A)
{
  Matrix F;
  for (int k = 0; k < 9; k++) {
    b.A[k][i] = A[k];
    A[k] += IDENTITY[k];
    F[k] = b.F[k][i];
  }
  F = A * F;
  for (int k = 0; k < 9; k++) b.F[k][i] = F[k];
  b.Jold[i] = b.J[i];
  b.J[i] = det(F);
}

inline Matrix inverse(const Matrix &M)
{
  Matrix c = MPM_COFACTORS(M);
  for (double &x : c) x /= det(M);
  return transpose(c);
}

constexpr std::array<double, 3> AXIS = {0.48, 0.6, 0.64};    ///< axis of rotations in most tests

/** Rotation by an angle about a unit axis. */
inline Matrix rotation(const std::array<double, 3> &n, double angle)
{
  const double c = std::cos(angle), s = std::sin(angle);
  const Matrix skew = {0, -n[2], n[1], n[2], 0, -n[0], -n[1], n[0], 0};
  Matrix R{};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      R[3 * i + j] = (i == j ? c : 0.0) + (1.0 - c) * n[i] * n[j] + s * skew[3 * i + j];
  return R;
}

/** Velocity gradient that turns a point by an angle about AXIS in one step of unit time. */
inline Matrix spin(double angle)
{
  const double w = 2.0 * std::tan(0.5 * angle);
  return {0, -w * AXIS[2], w * AXIS[1], w * AXIS[2], 0, -w * AXIS[0], -w * AXIS[1], w * AXIS[0], 0};
}

inline Matrix stress_of(const MaterialPoint &p)
{
  return {p.stress(0), p.stress(3), p.stress(4), p.stress(3), p.stress(1),
          p.stress(5), p.stress(4), p.stress(5), p.stress(2)};
}

/** Frobenius norm. */
inline double size(const Matrix &a)
{
  double sum = 0.0;
  for (const double x : a) sum += x * x;
  return std::sqrt(sum);
}

inline double distance(const Matrix &a, const Matrix &b)
{
  Matrix d;
  for (int k = 0; k < 9; k++) d[k] = a[k] - b[k];
  return size(d);
}

/** Row of the history variable with this name. */
inline int row(const Material &material, const std::string &name)
{
  for (size_t k = 0; k < material.history().size(); k++)
    if (material.history()[k].name == name) return k;
  ADD_FAILURE() << "no history variable " << name;
  return 0;
}
inline double value(const MaterialPoint &p, const std::string &name)
{
  return p.history(row(p.material, name));
}

/** Moves a point to a new deformation gradient in one step. */
inline void move_to(MaterialPoint &p, const Matrix &F, double dt = 1.0)
{
  Matrix old;
  for (int k = 0; k < 9; k++) old[k] = p.batch.F[k][0];
  Matrix A = F * inverse(old);
  for (int k = 0; k < 9; k++) A[k] -= IDENTITY[k];
  p.move(A.data(), dt);
}

/** Stretches a point along x to the stretch l, in n equal steps. */
inline void compress(MaterialPoint &p, double l, int n, double dt = 1.0)
{
  const double start = p.batch.F[0][0];
  for (int i = 1; i <= n; i++) move_to(p, uniaxial_stretch(start + (l - start) * i / n), dt);
}

/** Makes n steps with the velocity gradient L. */
inline void steps(MaterialPoint &p, const Matrix &L, double dt, int n = 1)
{
  for (int i = 0; i < n; i++) p.step(L.data(), dt);
}

/** Makes n steps of the motion F_new = (I + A) F. */
inline void moves(MaterialPoint &p, const Matrix &A, double dt, int n = 1)
{
  for (int i = 0; i < n; i++) p.move(A.data(), dt);
}

/** Makes n steps of a motion F(t), t from 0 to 1, of two points, plain and turned. The motion of
 *  the second point is rotated in addition, by an angle that grows to the given one. Calls
 *  check(plain, turned, difference) after each step; difference: of stress from plain, rotated. */
template <class Motion, class Check>
void turn_on_top(const Material &material, const Motion &F, double angle, int n, const Check &check)
{
  MaterialPoint plain(material), turned(material);
  for (int i = 1; i <= n; i++) {
    const double t = 1.0 * i / n;
    const Matrix R = rotation(AXIS, angle * t);
    move_to(plain, F(t), 1.0 / n);
    move_to(turned, R * F(t), 1.0 / n);
    check(plain, turned, distance(stress_of(turned), R * stress_of(plain) * transpose(R)));
  }
}

/** Expects that a rotation on top of a motion rotates the stress and does not change the stored
 *  energy, to a relative tolerance. more(plain, turned): other checks of the two points. */
template <class Motion, class More>
void expect_objective(const Material &material, const Motion &F, double angle, double tolerance,
                      const More &more)
{
  turn_on_top(material, F, angle, 50,
              [&](const MaterialPoint &plain, const MaterialPoint &turned, double difference) {
                EXPECT_LT(difference, tolerance * size(stress_of(plain)));
                EXPECT_NEAR(turned.stored_energy(), plain.stored_energy(),
                            tolerance * plain.stored_energy());
                more(plain, turned);
              });
}

/** Matrices of normally distributed random numbers. */
struct RandomMatrix {
  std::mt19937 random;
  std::normal_distribution<double> normal;
  explicit RandomMatrix(unsigned seed) : random(seed) {}

  Matrix operator()(double deviation)
  {
    Matrix a;
    for (double &x : a) x = deviation * normal(random);
    return a;
  }
};

/** Makes n steps with random velocity gradients, for repeats points with each size of the strain
 *  and each duration of a step. Calls check(p, e, dt) after each step. e: first history variable
 *  before the step, 0 if the law has none. */
template <class Check>
void random_steps(const Material &material, std::mt19937 &random,
                  const std::vector<double> &strains, const std::vector<double> &durations,
                  int repeats, int n, const Check &check)
{
  std::normal_distribution<double> normal;
  for (const double strain : strains)
    for (const double dt : durations)
      for (int repeat = 0; repeat < repeats; repeat++) {
        SCOPED_TRACE("strain " + std::to_string(strain) + " dt " + std::to_string(dt));
        MaterialPoint p(material);
        for (int i = 0; i < n; i++) {
          Matrix L;
          for (double &x : L) x = 0.4 * strain / dt * normal(random);
          const double e = material.history().empty() ? 0.0 : p.history(0);
          p.step(L.data(), dt);
          ASSERT_TRUE(std::isfinite(p.vonmises()));
          check(p, e, dt);
        }
      }
}

/** Expects the equivalent stress to be equal to the flow stress Y in plastic flow, and not above it
 *  otherwise. digits_of: another stress whose rounding errors are allowed for. */
inline void expect_on_surface(const MaterialPoint &p, double Y, double digits_of = 0.0)
{
  if (p.batch.plastic[0] > 0.0)
    EXPECT_NEAR(p.vonmises(), Y, 1e-10 * (Y + digits_of));
  else
    EXPECT_LE(p.vonmises(), Y * (1 + 1e-12));
}

/** A wrong definition, a part or pattern of the message. word: which one it is about (-1: any). */
struct Refusal {
  std::string text;
  const char *message;
  int word = -1;
};
/** Expects errors for these definitions. start: common first words of them. */
inline void expect_refused(const std::vector<Refusal> &refusals, const std::string &start = "")
{
  for (const auto &bad : refusals) {
    try {
      make(start + bad.text);
      ADD_FAILURE() << "accepted: " << bad.text;
    } catch (const MPM_NS::MaterialError &e) {
      if (bad.word >= 0) { EXPECT_EQ(e.word, bad.word) << bad.text << ": " << e.what(); }
      const std::string found = e.what();
      EXPECT_TRUE(found.find(bad.message) != std::string::npos ||
                  MPM_TEST::contains(found, bad.message))
          << bad.text << ": " << found;
    }
  }
}

/** Expects stress, wave speed, stored energy, and history to be finite. */
inline void expect_finite(const MaterialPoint &p)
{
  for (int k = 0; k < 6; k++) EXPECT_TRUE(std::isfinite(p.stress(k))) << "stress " << k;
  EXPECT_TRUE(std::isfinite(p.wave_speed()));
  EXPECT_TRUE(std::isfinite(p.stored_energy()));
  for (size_t k = 0; k < p.material.history().size(); k++)
    EXPECT_TRUE(std::isfinite(p.history(k))) << p.material.history()[k].name;
}

/** The errors error(n), error(2 n), error(4 n), ... with n, 2 n, 4 n, ... steps. */
template <std::size_t N = 3, class Error> std::array<double, N> refined(int n, const Error &error)
{
  std::array<double, N> result;
  for (std::size_t k = 0; k < N; k++) result[k] = error(n << k);
  return result;
}

/** Expects the errors for steps that are halved each time to decrease with this order. */
template <std::size_t N>
void expect_order(const std::array<double, N> &error, double order, double tolerance)
{
  for (std::size_t k = 1; k < N; k++)
    EXPECT_NEAR(std::log2(error[k - 1] / error[k]), order, tolerance);
}

/** Makes n steps up to the time with a velocity gradient L(t), taken in the middle of each step. */
inline void follow(MaterialPoint &p, const std::function<Matrix(double)> &L, double time, int n)
{
  const double dt = time / n;
  for (int i = 0; i < n; i++) p.step(L((i + 0.5) * dt).data(), dt);
}

/** Unknowns of a system of differential equations. */
using State = std::vector<double>;
/** Integrates dy/dt = f(t, y) from t = 0 in n steps of the classical Runge-Kutta method. */
inline State runge_kutta(const std::function<State(double, const State &)> &f, State y, double time,
                         int n)
{
  const double h = time / n;
  const auto shifted = [](const State &y, double h, const State &k) {
    State z = y;
    for (size_t i = 0; i < y.size(); i++) z[i] += h * k[i];
    return z;
  };
  for (int i = 0; i < n; i++) {
    const double t = i * h;
    const State a = f(t, y), b = f(t + h / 2, shifted(y, h / 2, a)),
                c = f(t + h / 2, shifted(y, h / 2, b)), d = f(t + h, shifted(y, h, c));
    for (size_t k = 0; k < y.size(); k++) y[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
  }
  return y;
}

constexpr double MPa = 1e6, GPa = 1e9;

/** A material, with a name for messages. The list has one of each kind, for the tests of properties
 *  that all laws share (objectivity, energy, wave speed, instruction sets, extremes). */
struct Sample {
  const char *name, *text;
};
inline const Sample samples[] = {
    {"linear", "density 1000 linear 1e6 0.3"},
    {"neohookean", "density 1000 neohookean 1e6 0.3"},
    {"neohookean/split", "density 1000 neohookean/split 1e6 0.3"},
    {"stvenant/kirchhoff", "density 1000 stvenant/kirchhoff 1e6 0.3"},
    {"hencky", "density 1000 hencky 1e6 0.3"},
    {"mooney/rivlin", "density 1000 mooney/rivlin 0.3e6 0.1e6 2e6"},
    {"ogden", "density 1000 ogden 2e6 term 0.63e6 1.3 term 0.0012e6 5 term -0.01e6 -2"},
    {"transversely/isotropic",
     "density 1580 transversely/isotropic 126e9 11e9 0.28 0.4 6.6e9 axis 1 2 -0.5"},
    {"orthotropic",
     "density 600 orthotropic 11e9 0.9e9 0.5e9 0.4 0.45 0.5 0.7e9 0.65e9 0.05e9 "
     "axes 1 2 0 0 1 1 angle 20"},
    {"woven", "density 800 woven 2e8 1e8 5e6 angle 80 locking 40 2e7"},
    {"elastic", "density 2700 eos linear 70e9 strength elastic 26e9"},
    {"shock+elastic", "density 2703 eos shock 5350 1.34 2 strength elastic 26e9"},
    {"j2", "density 8930 eos shock 3940 1.49 1.96 strength j2 43e9 157e6 hardening linear 425e6"},
    {"j2 power", "density 8940 eos linear 1e11 strength j2 44e9 65e6 hardening power 356e6 0.37"},
    {"j2 voce", "density 7800 eos linear 160e9 strength j2 80e9 300e6 hardening voce 2e8 15 1e8"},
    {"j2 swift", "density 7800 eos linear 160e9 strength j2 80e9 300e6 hardening swift 0.002 0.2"},
    {"j2 table", "density 7800 eos linear 160e9 strength j2 80e9 300e6 point 0.1 4e8 point 1 6e8"},
    {"j2 kinematic", "density 7800 eos linear 160e9 strength j2 80e9 300e6 kinematic 20e9 0"},
    {"j2 recovery",
     "density 7800 eos shock 3940 1.49 1.96 strength j2 80e9 300e6 hardening linear 1e9 "
     "kinematic 20e9 100"},
    {"j2 cowper/symonds",
     "density 7800 eos linear 160e9 strength j2 80e9 300e6 hardening power 5e8 0.3 "
     "rate cowper/symonds 40.4 5"},
    {"j2 perzyna",
     "density 7800 eos linear 160e9 strength j2 80e9 300e6 rate perzyna 1e8 1 4 "
     "kinematic 20e9 100"},
    {"johnson/cook",
     "density 7830 eos linear 172e9 strength johnson/cook 79.6e9 806e6 614e6 0.168 "
     "0.0089 1 1.1 1540 20 thermal adiabatic 460 20 0.9"},
    {"johnson/cook cold",
     "density 8940 eos shock 3933 1.5 2 strength johnson/cook 44e9 65e6 356e6 0.37 0.013 1e-3"},
    {"zerilli/armstrong bcc",
     "density 7870 eos linear 165e9 strength zerilli/armstrong 80e9 65e6 form bcc 1033e6 0.00698 "
     "0.000415 266e6 0.289 rate 1 thermal adiabatic 450 300 0.9"},
    {"zerilli/armstrong fcc",
     "density 8930 eos shock 3940 1.49 1.96 strength zerilli/armstrong 47e9 65e6 form fcc 890e6 "
     "0.0028 0.000115 melt 1356 rate 1 thermal adiabatic 385 300 0.9"},
    {"steinberg",
     "density 8930 eos shock 3940 1.489 2.02 strength steinberg 47.7e9 0.12e9 36 0.45 0.64e9 "
     "2.83e-11 3.77e-4 melt 1790 1.5 2.02 tref 300 thermal adiabatic 385 300 0.9 gruneisen 2.02"},
    {"johnson/cook warm",
     "density 7830 eos linear 172e9 strength johnson/cook 79.6e9 806e6 614e6 0.168 "
     "0.0089 1 1.1 1540 20 thermal constant 600"},
    {"melting",
     "density 8930 eos linear 1e11 strength j2 43e9 157e6 thermal adiabatic 385 300 0.9 "
     "melt 300.5 200 gruneisen 2"},
    {"conducting",
     "density 8930 eos linear 1e11 strength j2 43e9 157e6 thermal conducting 385 300 400 0.9 "
     "melt 300.5 200 gruneisen 2"},
    {"steinberg cold",
     "density 8930 eos linear 137e9 strength steinberg 47.7e9 0.12e9 36 0.45 0.64e9 2.83e-11 0 "
     "prestrain 0.01"},
    {"tait", "density 1000 eos tait 2.2e9 7 cutoff -1e5 viscosity newtonian 1e-3"},
    {"fluid", "density 1000 eos linear 1e6 viscosity newtonian 1 viscosity artificial 1.5 0.06"},
    {"drucker/prager", "density 1600 drucker/prager 1e6 0.3 30"},
    {"drucker/prager cohesion",
     "density 1600 drucker/prager 1e6 0.3 35 cohesion 2e4 dilatancy 10 tension 5e3 plane"},
    {"gurson",
     "density 7800 gurson 200e9 0.3 400e6 0.02 hardening 0.01 0.1 nucleation 0.04 0.1 0.05 "
     "coalescence 0.15 0.25"},
    {"johnson/cook damage",
     "density 7830 eos linear 172e9 strength johnson/cook 79.6e9 806e6 614e6 0.168 0.0089 1 1.1 "
     "1540 20 thermal adiabatic 460 20 0.9 damage johnson/cook 0.1 0.5 -1.5 rate -0.01 1 "
     "temperature 0.6 1540 20 soften from 0.1 after friction 0.3"},
    {"energy of damage",
     "density 2703 eos shock 5350 1.34 2 strength j2 26e9 0.3e9 "
     "damage cockcroft/latham 2e7 soften energy 6e6 viscosity artificial 1.5 0.06"},
    {"rankine",
     "density 2400 eos linear 2e10 strength elastic 1.5e10 damage rankine 1e7 soften energy 1e8 "
     "weibull 5 1 7"},
    {"phasefield",
     "density 2400 eos linear 2e10 strength elastic 1.5e10 damage phasefield 1e8 1.0 model "
     "cohesive 1e7 after friction 0.5"},
    {"grady/kipp",
     "density 2700 eos linear 2e10 strength elastic 1.5e10 "
     "damage grady/kipp 1e4 3 0.1 4e10 after none"},
    {"mohr/coulomb", "density 1900 mohr/coulomb 1e6 0.3 30 1e4 dilatancy 10"},
    {"mohr/coulomb soft", "density 1900 mohr/coulomb 1e6 0.3 30 3e4 residual 1e4 20 5"},
    {"mui", "density 1500 mui 1e6 0.3 0.38 0.64 0.3 1e-3"},
    {"snow", "density 400 snow 1.4e5 0.2 0.025 0.0075 5"},
    {"camclay", "density 1900 camclay 5e6 0.9 0.2 0.04 0 1e5 1.5e5"},
    {"nacc", "density 250 nacc 1e6 0.3 1.85 0.3 3 -0.05"},
    {"viscous rubber",
     "density 1000 neohookean 1e6 0.3 viscosity newtonian 10 viscosity artificial 2 1"},
    {"shock cutoff", "density 8930 eos shock 3940 1.49 1.96 cutoff -1e9"},
    {"shock spall", "density 8930 eos shock 3940 1.49 1.96 spall -1e9 strength elastic 43e9"},
    {"polynomial", "density 2700 eos polynomial 7e10 8e10 5e10 2 1.5 6e10 1e10 energy 1e9"},
    {"ideal gas", "density 1.2 eos ideal/gas 1.4 pressure 1e5"},
    {"stiffened gas", "density 1000 eos stiffened/gas 4.4 6e8 pressure 1e5 cutoff -1e6"},
    {"jwl", "density 1630 eos jwl 371.2e9 3.231e9 4.15 0.95 0.3 7.0e9 6930"},
    {"jwl burning", "density 1630 eos jwl 371.2e9 3.231e9 4.15 0.95 0.3 7.0e9 69 detonate 0 0 0 0"},
    {"bulk viscosity", "density 1000 eos linear 1e6 viscosity newtonian 1 bulk 2"},
    {"bingham", "density 1000 eos linear 1e6 viscosity bingham 1 2 10"},
    {"herschel/bulkley", "density 1000 eos linear 1e6 viscosity herschel/bulkley 1 0.5 2 10"},
    {"power", "density 1000 eos tait 1e6 7 viscosity power 2 0.5 0.1 10"},
    {"damped linear",
     "density 1000 linear 1e6 0.3 viscosity newtonian 10 bulk 20 viscosity artificial 2 1"},
    {"damped metal",
     "density 8930 eos linear 1e11 strength j2 43e9 157e6 hardening linear 425e6 "
     "viscosity newtonian 1e3"},
    {"maxwell rubber",
     "density 1000 hencky 1e6 0.3 viscosity maxwell term 2e5 0.1 term 1e5 0.01 term 1e5 1e-5"},
    {"maxwell linear", "density 1000 linear 1e6 0.3 viscosity maxwell term 2e5 0.1"},
    {"maxwell fluid", "density 1000 eos tait 1e6 7 viscosity maxwell term 2e5 0.1"},
    {"corotated", "density 1000 corotated 1e6 0.3"},
};

}    // namespace material_testing
#endif
