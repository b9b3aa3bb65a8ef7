/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "material/plane_stress.h"

#include "material/material_point.h"
#include "math/matrix.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace MPM_NS;

// the stretch across is found up to a part TOLERANCE of it, or until the stress there is this part
// of the stiffness, which is rounding
static constexpr double TOLERANCE = 1.0e-11, NO_STRESS = 1.0e-14;
// relative change of the stretch for the first slope, and the largest of an iteration
static constexpr double PROBE = 1.0e-7, MOST_CHANGE = 0.3;
static constexpr int SECANT_ITERATIONS = 8, MOST_ITERATIONS = 100;
// a stress that is no rounding, as part of the stiffness
static constexpr double BROKEN = 1.0e-8;
static constexpr int MOST_ATTEMPTS = 4;
// a stretch that is no state: laws such as stvenant/kirchhoff lose their stress on the way to zero
static constexpr double NOTHING = 1.0e-5;
// axes of a surface that has collapsed to a line are those of before
static constexpr double COLLAPSED = 1.0e-12;

PlaneStress::PlaneStress(const Material &material, int dim, int along, bool compression,
                         bool axes) :
    material(material),
    dim(dim), along(along), compression(compression), axes(axes)
{
  history.resize(material.history().size() * BATCH);
  check_symmetry();
  if (!compression) check_elasticity();
  find_speed();
}

static void normalize(double *v)
{
  const double inv = 1.0 / sqrt(dot(v, v));
  for (int d = 0; d < 3; d++) v[d] *= inv;
}

/** v without its part along the unit vector n. */
static void remove(const double *n, double *v)
{
  const double part = dot(n, v);
  for (int d = 0; d < 3; d++) v[d] -= part * n[d];
}

static void multiply(const double *F, const double *v, double *to)
{
  for (int d = 0; d < 3; d++) to[d] = dot(F + 3 * d, v);
}

static void add_outer(double factor, const double *a, const double *b, double *to)
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) to[3 * i + j] += factor * a[i] * b[j];
}

void PlaneStress::make_frame(const double *a, const double *b, double (*frame)[3]) const
{
  std::copy_n(a, 3, frame[0]);
  normalize(frame[0]);
  double *const second = frame[1];
  if (along == 2) {
    std::copy_n(b, 3, second);
  } else if (dim == 2) {
    second[0] = -frame[0][1];
    second[1] = frame[0][0];
    second[2] = 0.0;
  } else {    // any
    int least = 0;
    for (int d = 1; d < 3; d++)
      if (std::fabs(frame[0][d]) < std::fabs(frame[0][least])) least = d;
    std::fill_n(second, 3, 0.0);
    second[least] = 1.0;
  }
  remove(frame[0], second);
  normalize(second);
  cross(frame[0], second, frame[2]);
}

/** Another reference configuration, turned so that its axes x y z are those of the frame, has
 *  the same stress. */
void PlaneStress::turn_to_material(const Point &point, double *F) const
{
  if (!axes) return;
  for (int i = 0; i < 3; i++) {
    double row[3];
    multiply(&point.frame[0][0], F + 3 * i, row);
    std::copy_n(row, 3, F + 3 * i);
  }
}

/** Principal stretches and axes, at the start and the end. Axes across a line turn as little as
 *  the line does. */
void PlaneStress::find_axes(const Point &point, State &s) const
{
  std::memcpy(s.N, point.frame, sizeof(s.N));
  if (along == 1) {
    multiply(point.along, s.N[0], s.n[0]);
    s.lambda[0] = sqrt(dot(s.n[0], s.n[0]));
    if (!(s.lambda[0] > COLLAPSED)) multiply(point.old, s.N[0], s.n[0]);
    normalize(s.n[0]);
    if (dim == 2) {
      s.n[1][0] = -s.n[0][1];
      s.n[1][1] = s.n[0][0];
      s.n[1][2] = 0.0;
    } else {
      double other[3];
      multiply(point.old, s.N[1], s.n[1]);
      multiply(point.old, s.N[2], other);
      normalize(s.n[1]);
      normalize(other);
      if (std::fabs(dot(s.n[0], s.n[1])) < std::fabs(dot(s.n[0], other))) {
        remove(s.n[0], s.n[1]);
      } else {
        remove(s.n[0], other);
        cross(other, s.n[0], s.n[1]);
      }
      normalize(s.n[1]);
    }
    cross(s.n[0], s.n[1], s.n[2]);
    return;
  }

  double t[2][3];
  for (int k = 0; k < 2; k++) multiply(point.along, point.frame[k], t[k]);
  const double c00 = dot(t[0], t[0]), c11 = dot(t[1], t[1]), c01 = dot(t[0], t[1]);
  const double angle = 0.5 * atan2(2.0 * c01, c00 - c11);
  const double c = cos(angle), e = sin(angle);
  for (int d = 0; d < 3; d++) {
    s.N[0][d] = c * point.frame[0][d] + e * point.frame[1][d];
    s.N[1][d] = c * point.frame[1][d] - e * point.frame[0][d];
    s.n[0][d] = c * t[0][d] + e * t[1][d];
    s.n[1][d] = c * t[1][d] - e * t[0][d];
  }
  for (int k = 0; k < 2; k++) s.lambda[k] = sqrt(dot(s.n[k], s.n[k]));
  if (!(s.lambda[0] > COLLAPSED)) multiply(point.old, s.N[0], s.n[0]);
  normalize(s.n[0]);
  remove(s.n[0], s.n[1]);
  if (!(dot(s.n[1], s.n[1]) > COLLAPSED * COLLAPSED)) {
    multiply(point.old, s.N[1], s.n[1]);
    remove(s.n[0], s.n[1]);
  }
  normalize(s.n[1]);
  cross(s.n[0], s.n[1], s.n[2]);
}

/** Axes from the first one on have the same stretch, which is not known; in 2d, z has none. */
void PlaneStress::divide(State &s, int first) const
{
  s.first = first;
  s.done = false;
  std::fill_n(s.fixed, 9, 0.0);
  std::fill_n(s.across, 9, 0.0);
  for (int k = 0; k < first; k++) add_outer(s.lambda[k], s.n[k], s.N[k], s.fixed);
  for (int k = first; k < last_axis(); k++) add_outer(1.0, s.n[k], s.N[k], s.across);
  if (dim == 2) s.fixed[8] = 1.0;
}

void PlaneStress::keep(const Batch &b)
{
  std::memcpy(start, b.stress, sizeof(start));
  for (std::size_t k = 0; k < history.size(); k++) history[k] = b.history[k / BATCH][k % BATCH];
}

/** Batch at the end of the motion, with the rest as at its start. */
void PlaneStress::move(Batch &b, const Point *point)
{
  std::memcpy(b.stress, start, sizeof(start));
  std::fill_n(b.heat, b.n, 0.0);
  for (std::size_t k = 0; k < history.size(); k++) b.history[k / BATCH][k % BATCH] = history[k];
  for (int p = 0; p < b.n; p++) {
    double F[9], change[9];
    for (int c = 0; c < 9; c++) F[c] = state[p].fixed[c] + state[p].stretch * state[p].across[c];
    const double *const old = point[p].old;
    double inverse[9] = MPM_COFACTORS(old);    // transposed
    b.Jold[p] = determinant(old);
    for (int c = 0; c < 9; c++) {
      inverse[c] /= b.Jold[p];
      change[c] = F[c] - old[c];
    }
    b.J[p] = determinant(F);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) b.A[3 * i + j][p] = dot(change + 3 * i, inverse + 3 * j);
    turn_to_material(point[p], F);
    for (int c = 0; c < 9; c++) b.F[c][p] = F[c];
  }
}

/** Mean stress along the axes whose stretch is not known. */
void PlaneStress::stress_across(Batch &b, const Point *point, double *value)
{
  move(b, point);
  material.update(b);
  for (int p = 0; p < b.n; p++) {
    const State &s = state[p];
    double sum = 0.0;
    for (int k = s.first; k < last_axis(); k++) {
      const double *const n = s.n[k];
      sum += n[0] * n[0] * b.stress[0][p] + n[1] * n[1] * b.stress[1][p] +
          n[2] * n[2] * b.stress[2][p] +
          2.0 *
              (n[0] * n[1] * b.stress[3][p] + n[0] * n[2] * b.stress[4][p] +
               n[1] * n[2] * b.stress[5][p]);
    }
    value[p] = sum / (last_axis() - s.first);
  }
}

/** The stretch of all points that are not done, by the secant method. What yields or breaks has a
 *  stress with kinks and steps, between whose sides the secant method can go to and fro: from a few
 *  iterations on, every other one halves the range between the last stretches with a stress below
 *  and above zero. */
int PlaneStress::iterate(Batch &b, const Point *point)
{
  double before[BATCH], now[BATCH], change[BATCH], slope[BATCH], low[BATCH], high[BATCH];
  const auto keep_range = [&](int p, double stress) {
    (stress < 0.0 ? low : high)[p] = state[p].stretch;
  };
  const auto is_none = [this](double stress) {
    return std::fabs(stress) <= NO_STRESS * stiffness;
  };
  std::fill_n(low, b.n, 0.0);
  std::fill_n(high, b.n, HUGE_VAL);
  stress_across(b, point, before);
  for (int p = 0; p < b.n; p++) {
    if (is_none(before[p])) state[p].done = true;
    keep_range(p, before[p]);
    change[p] = state[p].done ? 0.0 : PROBE * state[p].stretch;
    state[p].stretch += change[p];
  }
  stress_across(b, point, now);
  for (int p = 0; p < b.n; p++)
    if (!state[p].done) slope[p] = std::fabs((now[p] - before[p]) / change[p]);

  for (int k = 0; k < MOST_ITERATIONS; k++) {
    int left = -1;
    for (int p = 0; p < b.n; p++) {
      State &s = state[p];
      if (s.done) continue;
      keep_range(p, now[p]);
      const double most = MOST_CHANGE * s.stretch, middle = 0.5 * (low[p] + high[p]);
      change[p] = is_none(now[p]) ? 0.0 : std::max(-most, std::min(most, -now[p] / slope[p]));
      if (k > SECANT_ITERATIONS && k % 2 && low[p] > 0.0 && std::isfinite(middle))
        change[p] = middle - s.stretch;
      s.stretch += change[p];
      s.done = std::fabs(change[p]) <= TOLERANCE * s.stretch && s.stretch > NOTHING;
      if (!s.done) left = p;    // also if not a number
      before[p] = now[p];
    }
    if (left < 0) return -1;
    stress_across(b, point, now);
    for (int p = 0; p < b.n; p++) {
      const double next = std::fabs((now[p] - before[p]) / change[p]);
      if (!state[p].done && next > 0.0 && std::fabs(change[p]) > 1.0e-9 * state[p].stretch)
        slope[p] = next;
    }
  }
  for (int p = 0; p < b.n; p++)
    if (!state[p].done) return p;
  return -1;
}

/** What breaks may do so in the last, small change: then there is another state without stress, and
 *  it is looked for from there. */
int PlaneStress::solve(Batch &b, const Point *point)
{
  int bad = iterate(b, point);
  for (int attempt = 0; bad < 0 && !history.empty(); attempt++) {
    double left[BATCH];
    stress_across(b, point, left);
    for (int p = 0; p < b.n; p++) {
      if (std::fabs(left[p]) <= BROKEN * stiffness || !std::isfinite(left[p])) continue;
      state[p].done = false;
      bad = p;
    }
    if (bad < 0 || attempt == MOST_ATTEMPTS) return bad;
    bad = iterate(b, point);
  }
  return bad;
}

int PlaneStress::update(Batch &b, const Point *point, const std::function<void(Batch &)> &last)
{
  keep(b);
  for (int p = 0; p < b.n; p++) {
    State &s = state[p];
    find_axes(point[p], s);
    double across[3];
    multiply(point[p].old, point[p].frame[along], across);
    s.stretch = sqrt(dot(across, across));
    if (compression) {
      divide(s, along);
    } else if (s.lambda[0] <= 1.0) {    // slack
      s.lambda[0] = s.stretch = 1.0;
      divide(s, 1);
      s.done = true;
    } else
      divide(s, 1);
  }
  int bad = solve(b, point);
  if (bad >= 0) return bad;

  if (!compression && along == 2) {
    bool taut = false;
    for (int p = 0; p < b.n; p++) {
      State &s = state[p];
      if (s.lambda[0] <= 1.0 || s.lambda[1] < s.stretch) continue;
      divide(s, 2);
      taut = true;
    }
    if (taut) bad = solve(b, point);
    if (bad >= 0) return bad;
  }
  move(b, point);
  last(b);
  for (int p = 0; p < b.n && axes; p++)    // without the turn
    for (int c = 0; c < 9; c++)
      b.F[c][p] = state[p].fixed[c] + state[p].stretch * state[p].across[c];
  return -1;
}

namespace {

// a small compression, which all materials resist
constexpr double SMALL = 1.0e-6, SAME = 1.0e-6;
constexpr double UNIT[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
constexpr double STRAINED[9] = {1.0 - SMALL, 0.1 * SMALL, 0.0, 0.1 * SMALL,      1.0 - 0.8 * SMALL,
                                0.0,         0.0,         0.0, 1.0 - 0.7 * SMALL};

/** A point at rest, without deformation. Its length is small, as what breaks would do so at
 *  once. */
struct One : MaterialPoint {
  explicit One(const Material &material) : MaterialPoint(material, 1, SMALL) {}

  /** From old to F. */
  void go(const double *old, const double *F)
  {
    Batch &b = batch;
    double inverse[9] = MPM_COFACTORS(old), change[9];
    b.Jold[0] = determinant(old);
    b.J[0] = determinant(F);
    for (int c = 0; c < 9; c++) {
      inverse[c] /= b.Jold[0];
      change[c] = F[c] - old[c];
      b.F[c][0] = F[c];
    }
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) b.A[3 * i + j][0] = dot(change + 3 * i, inverse + 3 * j);
    material.update(b);
  }

  /** Stress as a matrix. */
  void get(double *m) const
  {
    static constexpr int voigt[9] = {0, 3, 4, 3, 1, 5, 4, 5, 2};
    for (int c = 0; c < 9; c++) m[c] = stress(voigt[c]);
  }
};

double norm(const double *m)
{
  double sum = 0.0;
  for (int c = 0; c < 9; c++) sum += m[c] * m[c];
  return sqrt(sum);
}

/** R m R^T. */
void turn(const double *R, const double *m, double *to)
{
  double half[9];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) half[3 * i + j] = product(R, m, i, j);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) to[3 * i + j] = dot(half + 3 * i, R + 3 * j);
}

}    // namespace

/** Is the stress of a small strain turned by what turns the strain? If not, does a strain that is
 *  the same on both sides of the plane of axes 1 and 2 cause a stress that is? */
void PlaneStress::check_symmetry()
{
  // about x + y by one radian, which is no symmetry of anything
  const double c = cos(1.0), s = sin(1.0), r = sqrt(0.5);
  const double R[9] = {0.5 * (1.0 + c), 0.5 * (1.0 - c), r * s,
                       0.5 * (1.0 - c), 0.5 * (1.0 + c), -r * s,
                       -r * s,          r * s,           c};
  double strained[9], stress[9], wanted[9], turned[9];
  One one(material), other(material);
  one.go(UNIT, STRAINED);
  one.get(stress);
  stiffness = norm(stress) / SMALL;
  // of a fluid without viscosity: a pressure, which vanishes with the stress across
  const double pressure = (stress[0] + stress[4] + stress[8]) / 3.0;
  double shear[9];
  for (int k = 0; k < 9; k++) shear[k] = stress[k] - (k % 4 ? 0.0 : pressure);
  if (norm(stress) > 0.0 && norm(shear) <= SAME * norm(stress))
    throw std::runtime_error(
        "it resists no shear, and bears nothing along either then: use a solid");
  turn(R, stress, wanted);
  turn(R, STRAINED, strained);
  other.go(UNIT, strained);
  other.get(turned);
  for (int k = 0; k < 9; k++) turned[k] -= wanted[k];
  const bool isotropic = norm(turned) <= SAME * norm(wanted);
  if (!axes && !isotropic) throw std::runtime_error("it must be isotropic");
  if (!axes) return;
  if (along != 2 || dim != 3 || !compression)
    throw std::runtime_error("axes are for surfaces in 3d that resist compression");
  if (isotropic) throw std::runtime_error("it is isotropic, and has no axes");
  if (!(std::fabs(stress[2]) + std::fabs(stress[5]) <= SAME * norm(stress)))
    throw std::runtime_error("the plane of its axes x and y is no plane of symmetry");
}

void PlaneStress::check_elasticity() const
{
  if (!material.history().empty())
    throw std::runtime_error("it must be elastic, without history variables");
  double rest[9], stress[9], again[9];
  One one(material);
  one.go(UNIT, UNIT);
  one.get(rest);
  one.go(UNIT, STRAINED);
  one.get(stress);
  one.go(STRAINED, STRAINED);
  one.get(again);
  for (int k = 0; k < 9; k++) again[k] -= stress[k];
  One faster(material);
  double quick[9];
  faster.batch.dt = 1.0e-3;
  faster.go(UNIT, STRAINED);
  faster.get(quick);
  for (int k = 0; k < 9; k++) quick[k] -= stress[k];
  if (!(norm(again) <= SAME * norm(stress) && norm(quick) <= SAME * norm(stress)))
    throw std::runtime_error(
        "it must be elastic: its stress must follow from the deformation alone");
  if (!(norm(rest) <= SAME * norm(stress)))
    throw std::runtime_error("it must be free of stress when it is not deformed");
}

/** Lame's constants {lambda, mu} at rest, from the stress 2 mu e + lambda tr(e) I in a small
 *  strain. */
static std::array<double, 2> lame_constants(const Material &material)
{
  double stress[9];
  One one(material);
  one.go(UNIT, STRAINED);
  one.get(stress);
  const double trace = STRAINED[0] + STRAINED[4] + STRAINED[8] - 3.0;
  const double mu = 0.5 * stress[1] / STRAINED[1];
  return {(stress[0] - 2.0 * mu * (STRAINED[0] - 1.0)) / trace, mu};
}

std::array<double, 2> PlaneStress::elastic_constants() const
{
  if (axes) throw std::runtime_error("it must be isotropic");
  check_elasticity();
  const auto [lambda, mu] = lame_constants(material);
  return {mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu), 0.5 * lambda / (lambda + mu)};
}

/** Is it elastic, or does it come back from a large strain without stress, as what relaxes in time
 *  does? What yields or breaks does not. */
void PlaneStress::find_speed()
{
  constexpr double LARGE[9] = {1.2, 0.0, 0.0, 0.0, 1.0 / 1.2, 0.0, 0.0, 0.0, 1.0};
  double strained[9], back[9];
  One one(material);
  one.go(UNIT, LARGE);
  one.get(strained);
  one.go(LARGE, UNIT);
  one.get(back);
  springs_back = material.history().empty() || norm(back) <= 0.01 * norm(strained);
  if (axes) return;
  const auto [lambda, mu] = lame_constants(material);
  const double modulus = lambda + 2.0 * mu;
  // surfaces and strips have one direction without stress, cables two
  const double released = last_axis() - along == 1 ? lambda * lambda / modulus
                                                   : lambda * lambda / (lambda + mu);
  share_at_rest = 1.0 - released / modulus;
}
