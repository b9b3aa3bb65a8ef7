/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "output/mpm_point.h"

#include "base/mpm_input.h"
#include "base/mpm_options.h"
#include "material/material_point.h"
#include "material/phase_field.h"

#include "comm.h"
#include "error.h"
#include "force.h"
#include "input.h"
#include "math_const.h"
#include "math_extra.h"
#include "update.h"
#include "variable.h"

#include "fmt/format.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;
using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

static constexpr int CONSOLIDATION_STEPS = 100;
static const char *const component_name[6] = {"xx", "yy", "zz", "xy", "xz", "yz"};
static constexpr int place[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};    // of these
static const char *const path_name[] = {"uniaxial/stress", "uniaxial/strain", "shear", "biaxial",
                                        "triaxial",        "volumetric",      "shock", "mixed"};

MPMPoint::MPMPoint(LAMMPS *lmp) : Command(lmp) {}

MPMPoint::~MPMPoint()
{
  if (fp) fclose(fp);
}

void MPMPoint::command(int narg, char **arg)
{
  parse(narg, arg);
  if (comm->me == 0)
    utils::logmesg(lmp, "Material point, path {}: {}\n", path_name[path], material->describe());

  // all ranks do the same, rank 0 writes
  material->configure(nullptr, force->mvv2e * force->nktv2p, force->nktv2p);
  range_left.assign(material->ranges().size(), false);
  std::unique_ptr<MaterialPoint> start;
  try {
    start = std::make_unique<MaterialPoint>(*material, 1, length);
  } catch (const std::runtime_error &e) {
    error->all(FLERR, "Mpm_point: {}", e.what());
  }
  MaterialPoint &point = *start;
  set_temperature(point);
  if (comm->me == 0 && !file.empty()) {
    fp = fopen(file.c_str(), "w");
    if (!fp) error->one(FLERR, "Cannot write table {}: {}", file, utils::getsyserror());
    utils::print(fp, "# mpm_point, path {}, units {}\n# {}\n", path_name[path], update->unit_style,
                 material->describe());
  }
  if (path == SHOCK)
    run_shock(point);
  else
    run_path(point);

  if (fp) {
    const bool failed = ferror(fp) != 0;
    if (fclose(fp) != 0 || failed)
      error->one(FLERR, "Cannot write to table {}: {}", file, utils::getsyserror());
    fp = nullptr;
  }
  if (comm->me == 0 && iterations)
    utils::logmesg(lmp, "  {:.1f} iterations per step\n", double(iterations) / nsteps);
}

/** mpm_point FILE PATH values keyword values ... material definition */
Options MPMPointOptions::declare()
{
  using namespace option;
  Options o("mpm_point");
  std::vector<OptionWord> paths;
  for (int k = 0; k <= MIXED; k++)
    paths.push_back({path_name[k], k, "", {number(rate, "rate", ANY_NUMBER)}});
  paths[TRIAXIAL].values.push_back(number(pressure, "confining pressure", NOT_NEGATIVE));
  paths[SHOCK].values = {number(rate, "rate", {-UNBOUNDED, 0.0, false})};
  paths[MIXED].values.clear();
  o.argument(word(path, paths, "path"));
  o.add("time", {number(duration, "T", POSITIVE, "time", "duration of the path")}).standard("");
  o.add("strain",
        {number(strain, "E", POSITIVE, "1", "magnitude of the strain at which the path ends")})
      .standard("");
  o.add("cycle",
        {number(amplitude, "A", POSITIVE, "1", "amplitude of the strain"),
         number(cycles, "N", POSITIVE, "", "number of cycles")})
      .standard("");
  o.add("steps", {integer(nsteps, "N", POSITIVE, "number of time steps")});
  o.add("every", {integer(every, "M", POSITIVE, "write a row of the table every this many steps")})
      .standard("steps/1000");
  for (int k = 0; k < 6; k++)
    o.add(component_name[k],
          {word(component[k].kind,
                {{"rate",
                  Component::RATE,
                  "",
                  {variables(&component[k].value, 1, "R", "1/time",
                             "this component of the rate of deformation, can be a variable")}},
                 {"stress",
                  Component::STRESS,
                  "",
                  {variables(&component[k].value, 1, "S", "pressure",
                             "this component of the Cauchy stress, can be a variable")}}})})
        .once();
  o.add("spin",
        {variables(spin, 3, "wx wy wz", "radians/time",
                   "angular velocity of the material, can be variables")});
  o.add("clock",
        {text(clock, "name",
              "internal-style variable that receives the time whenever variables are evaluated")});
  o.add("rotate",
        {numbers(axis, 3, "nx ny nz", ANY_NUMBER, "", "axis of rotation"),
         number(turns, "turns", ANY_NUMBER, "",
                "number of turns that the frame makes during the path")})
      .standard("none");
  o.add("temperature", {number(temperature, "T", ANY_NUMBER, "temperature", "initial temperature")})
      .standard("temperature of the material");
  o.add("length",
        {number(length, "h", POSITIVE, "distance", "node spacing that artificial viscosity uses")});
  const auto given = [this] {
    return (duration > 0.0) + (strain > 0.0) + (amplitude > 0.0);
  };
  const auto changed = [this] {
    return std::any_of(component, component + 6, [](const Component &c) {
      return c.kind != Component::AS_PATH;
    });
  };
  o.refuse([=] {
    return OptionRules{
        {path != MIXED && rate == 0.0, "", "needs a rate that is different from zero"},
        {given() == 0, "", "needs one of the keywords time, strain and cycle"},
        {given() > 1, "", "needs only one of the keywords time, strain and cycle"},
        {path == MIXED && duration < 0.0, "",
         "mixed has no strain of its own: use time instead of strain and cycle"},
        {path == SHOCK && (amplitude > 0.0 || turns != 0.0), "",
         "shock goes from the initial state to each of its states in one step: cycle and rotate do "
         "not go with it"},
        {path == SHOCK && changed(), "",
         "shock is uniaxial compression: no component can be changed; use uniaxial/strain"},
        {axis[0] == 0.0 && axis[1] == 0.0 && axis[2] == 0.0, "rotate",
         "needs an axis that is not zero"}};
  });
  return o;
}

void MPMPoint::parse(int narg, char **arg)
{
  if (narg > 0 && strcmp(arg[0], "NULL") != 0) file = arg[0];
  Options options = declare();
  const int iarg = read_options(lmp, options, narg, arg, 1, "material");
  if (iarg >= narg)
    error->all(FLERR,
               "Mpm_point: the material is missing: end the command with 'material density "
               "...' or 'material file NAME'");
  for (auto &c : component) find_variable(lmp, c.value, "mpm_point");
  for (auto &v : spin) find_variable(lmp, v, "mpm_point");
  const int ivar = input->variable->find(clock.c_str());
  if (!clock.empty() && (ivar < 0 || !input->variable->internalstyle(ivar)))
    error->all(FLERR, options.where("clock") + 1,
               "Mpm_point clock: {} is no internal-style variable: define it with "
               "'variable {} internal 0'",
               clock, clock);
  const double norm = MathExtra::len3(axis);
  for (int d = 0; d < 3 && norm > 0.0; d++) axis[d] /= norm;

  if (amplitude > 0.0) duration = 4.0 * amplitude * cycles / fabs(rate);
  if (strain > 0.0) duration = strain / fabs(rate);
  if (every == 0) every = std::max<bigint>(1, nsteps / 1000);

  material = read_material(lmp, "Mpm_point", iarg + 1, narg, arg);
  if (phase_field_cracks(*material))
    error->all(FLERR,
               "Mpm_point: cracks of damage phasefield are found at nodes, and a point alone has "
               "none: use damage rankine with soften energy");
}

double MPMPoint::value_at(const NumberOrVariable &v, double time)
{
  if (v.variable.empty()) return v.value;
  if (!clock.empty()) input->variable->internal_set(input->variable->find(clock.c_str()), time);
  return evaluate(lmp, v);
}

/** Strain along the path: steady, or to and fro between amplitude and -amplitude. */
double MPMPoint::path_strain(double time) const
{
  if (amplitude < 0.0) return rate * time;
  const double phase = fmod(fabs(rate) * time / amplitude, 4.0);    // quarters of a cycle
  const double s = phase < 1.0 ? phase : phase < 3.0 ? 2.0 - phase : phase - 4.0;
  return rate > 0.0 ? amplitude * s : -amplitude * s;
}

/** What is prescribed in a step from t0 to t1; before the start of a triaxial test: isotropic,
 *  with this share of the confining pressure at the end of the step. */
MixedControl MPMPoint::control(double t0, double t1, bool started, double share)
{
  MixedControl c;
  const double r = path == MIXED ? 0.0 : (path_strain(t1) - path_strain(t0)) / (t1 - t0);
  const auto free_from = [&c](int axis, double stress) {
    std::fill(c.stress_given + axis, c.stress_given + 3, true);
    std::fill(c.stress + axis, c.stress + 3, stress);
  };
  switch (path) {
    case UNIAXIAL_STRESS:
      c.L[0] = r;
      free_from(1, 0.0);
      break;
    case BIAXIAL:
      c.L[0] = c.L[4] = r;
      free_from(2, 0.0);
      break;
    case TRIAXIAL:
      if (started) c.L[0] = r;
      free_from(started ? 1 : 0, -share * pressure);
      break;
    case SHEAR:
      c.L[1] = r;
      break;
    case VOLUMETRIC:
      c.L[0] = c.L[4] = c.L[8] = r / 3.0;
      break;
    default:
      c.L[0] = r;    // uniaxial strain
  }

  const double middle = 0.5 * (t0 + t1);
  for (int k = 0; k < 6; k++) {
    if (component[k].kind == Component::AS_PATH) continue;
    const bool is_rate = component[k].kind == Component::RATE;
    const double value = value_at(component[k].value, is_rate ? middle : t1);
    const auto [i, j] = place[k];
    c.L[3 * i + j] = c.L[3 * j + i] = is_rate ? value : 0.0;
    c.stress_given[k] = !is_rate;
    c.stress[k] = is_rate ? 0.0 : value;
  }
  for (int d = 0; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    const double w = value_at(spin[d], middle);
    c.L[3 * e + f] -= w;
    c.L[3 * f + e] += w;
  }
  return c;
}

void MPMPoint::run_path(MaterialPoint &point)
{
  const double dt = duration / nsteps;
  const int before = path == TRIAXIAL && pressure > 0.0 ? CONSOLIDATION_STEPS : 0;
  const Eigen::Vector3d n = turns == 0.0 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d(axis);
  point.time = -before * dt;
  write(point, -before);
  for (bigint step = 1 - before; step <= nsteps; step++) {
    const bool started = step > 0;
    const double t1 = step * dt, share = started ? 1.0 : double(step + before) / before;
    const double angle = started ? MathConst::MY_2PI * turns * step / nsteps : 0.0;
    const Matrix3 rotation = Eigen::AngleAxisd(angle, n).toRotationMatrix();
    try {
      const MixedControl c = control(t1 - dt, t1, started, share);
      iterations += point.step(c, dt, turns == 0.0 ? nullptr : rotation.data());
    } catch (const std::runtime_error &e) {
      error->all(FLERR,
                 "Mpm_point: step {} at time {:.6g}: {}; is the stress beyond the strength, or the "
                 "step too large?",
                 step, t1, e.what());
    }
    point.time = t1;    // free of the rounding of sums
    check(point, step);
    write(point, step);
  }
}

/** States behind shocks of growing strength: each is reached from the initial state by a smooth
 *  compression with the heat that is missing in the jump condition of energy (Rankine, Hugoniot),
 *  as laws see the temperature of the start of a step. Viscous stress is gone a moment later. */
void MPMPoint::run_shock(MaterialPoint &initial)
{
  constexpr int PARTS = 500, MOST = 50;
  constexpr double ROUND_OFF = 1.0e-13, MOMENT = 1.0e-6;
  initial.time = 0.0;
  write(initial, 0);
  initial_pressure = -initial.stress(0);
  const double start = initial.internal_energy();
  for (bigint step = 1; step <= nsteps; step++) {
    const double t = duration * step / nsteps / PARTS, A[9] = {expm1(rate * t)}, none[9] = {};
    const auto compress = [&](MaterialPoint &point, double heat) {
      for (int k = 0; k < PARTS; k++) point.move(A, t, heat / PARTS);
      point.move(none, MOMENT * t);
    };
    double heat = 0.0, missing = 0.0, last_heat = 0.0, last_missing = 0.0;
    for (int k = 0; k < MOST; k++) {
      MaterialPoint point(initial);
      compress(point, heat);
      const double jump = 0.5 * (initial_pressure - point.stress(0)) * (1.0 - point.batch.J[0]);
      missing = jump - (point.internal_energy() - start);
      if (!(std::fabs(missing) > ROUND_OFF * std::fabs(jump))) break;
      const double next = k == 0 ? heat + missing
                                 : heat - missing * (heat - last_heat) / (missing - last_missing);
      if (next == heat || !std::isfinite(next)) break;
      last_heat = heat;
      last_missing = missing;
      heat = next;
    }
    MaterialPoint point(initial);
    compress(point, heat);
    point.time = duration * step / nsteps;
    check(point, step);
    write(point, step);
  }
}

void MPMPoint::set_temperature(MaterialPoint &point)
{
  if (std::isnan(temperature)) return;
  const auto &variables = material->history();
  for (std::size_t k = 0; k < variables.size(); k++)
    if (variables[k].name == "temperature") {
      point.batch.history[k][0] = temperature;
      // laws see the temperature of the start of a step: one at rest gives the stress
      const double none[9] = {};
      point.move(none, 1.0e-6 * duration);
      if (std::fabs(point.history(k) - temperature) > 1.0e-6 * std::fabs(temperature))
        error->all(FLERR,
                   "Mpm_point temperature {}: the temperature of this material belongs to its "
                   "energy, or to what has melted, and would be {:.6g} in the first step: give T0 "
                   "of its thermal part instead",
                   temperature, point.history(k));
      return;
    }
  error->all(FLERR,
             "Mpm_point temperature: the material has none: add 'thermal adiabatic' or "
             "'thermal constant'");
}

/** Is the state sound, and in the ranges of validity? */
void MPMPoint::check(const MaterialPoint &point, bigint step)
{
  double sum = point.batch.J[0];
  for (int k = 0; k < 6; k++) sum += point.stress(k);
  if (!std::isfinite(sum) || !(point.batch.J[0] > 0.0))
    error->all(FLERR, "Mpm_point: step {} at time {:.6g}: the state is not finite; use {}", step,
               point.time, path == SHOCK ? "a smaller strain" : "more steps");

  for (std::size_t k = 0; k < range_left.size(); k++) {
    double value[BATCH];
    if (range_left[k] || !material->outside(point.batch, k, value)) continue;
    range_left[k] = true;
    const auto &range = material->ranges()[k];
    if (comm->me == 0)
      error->warning(FLERR,
                     "Mpm_point: {} {:.6g} at step {} is out of the range of this material, {:.6g} "
                     "to {:.6g}; this is said only once",
                     range.quantity, value[0], step, range.low, range.high);
  }
}

/** Logarithmic strain (ln b)/2, b = F F^T. Of the eigenvalues of b, rounding of the largest one
 *  leaves nothing of one that is smaller by 10^16. So when they differ much, the smallest
 *  stretch is the inverse of the largest one of F^-1 = (cof F)^T/J, and that in the middle what
 *  these leave of J. */
static Eigen::Matrix3d log_strain(const Matrix3 &F, double J)
{
  using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;
  const Solver b(F * F.transpose());
  if (b.eigenvalues()[0] > 1.0e-6 * b.eigenvalues()[2]) {
    const Eigen::Matrix3d &axes = b.eigenvectors();
    const Eigen::Vector3d e = 0.5 * b.eigenvalues().array().log();
    return axes * e.asDiagonal() * axes.transpose();
  }

  // each over its size, so that squares do not overflow
  const double size = F.cwiseAbs().maxCoeff();
  const Matrix3 f = F / size;
  Matrix3 cof;
  for (int i = 0; i < 3; i++) cof.row(i) = f.row((i + 1) % 3).cross(f.row((i + 2) % 3));
  const double cof_size = cof.cwiseAbs().maxCoeff();
  cof /= cof_size;
  const Solver stretch(f * f.transpose()), inverse(cof * cof.transpose());
  const double most = 0.5 * log(stretch.eigenvalues()[2]) + log(size);
  const double of_two = 0.5 * log(inverse.eigenvalues()[2]) + log(cof_size) + 2.0 * log(size);

  const Eigen::Vector3d first = stretch.eigenvectors().col(2);
  Eigen::Vector3d last = inverse.eigenvectors().col(2);
  last = (last - first * first.dot(last)).normalized();
  Eigen::Matrix3d axes;
  axes << first, first.cross(last), last;
  const Eigen::Vector3d e(most, of_two - most, log(J) - of_two);
  return axes * e.asDiagonal() * axes.transpose();
}

/** All that is known of a point, in the order of the columns. */
std::vector<std::pair<std::string, double>> MPMPoint::row(const MaterialPoint &point, bigint step)
{
  std::vector<std::pair<std::string, double>> row = {{"step", step}, {"time", point.time}};
  const auto add = [&row](const std::string &name, double value) {
    row.emplace_back(name, value + 0.0);    // no -0
  };

  double F[9], stress[6];
  point.frame_state(F, stress);
  for (int k = 0; k < 9; k++) add(fmt::format("F{}{}", "xyz"[k / 3], "xyz"[k % 3]), F[k]);
  add("J", point.batch.J[0]);

  const Eigen::Matrix3d E = log_strain(Eigen::Map<const Matrix3>(F), point.batch.J[0]);
  Eigen::Matrix3d s;
  for (int k = 0; k < 6; k++) {
    const auto [i, j] = place[k];
    add(std::string("e") + component_name[k], E(i, j));
    s(i, j) = s(j, i) = stress[k];
  }
  for (int k = 0; k < 6; k++) add(std::string("s") + component_name[k], stress[k]);

  const double mises = point.vonmises();
  s -= Eigen::Matrix3d::Identity() * (s.trace() / 3.0);
  add("pressure", point.pressure());
  add("vonmises", mises);
  const double cube = mises * mises * mises;
  double lode = 0.0;
  if (mises > 0.0)
    lode = 13.5 * (std::isnormal(cube) ? s.determinant() / cube : (s / mises).determinant());
  add("lode", lode);

  add("stored", point.stored_energy());
  add("work", point.power);
  add("plastic", point.work[PLASTIC]);
  add("viscous", point.work[VISCOUS]);
  add("heat", point.work[HEAT]);
  add("wavespeed", point.wave_speed());
  if (path == SHOCK) {
    // jump conditions of mass, momentum, and energy with the stress along the shock's normal
    const double P0 = initial_pressure, P = -stress[0] - P0, eta = 1.0 - point.batch.J[0];
    const double density = point.density() * force->mvv2e * force->nktv2p;
    add("us", eta > 0.0 ? sqrt(P / (density * eta)) : point.wave_speed());
    add("up", sqrt(std::max(0.0, P * eta) / density));
    add("jump", (0.5 * P + P0) * eta);
  }
  for (std::size_t k = 0; k < material->history().size(); k++)
    add(material->history()[k].name, point.history(k));
  return row;
}

/** A line of the table, behind lines of comment and the names of the columns, and one of the
 *  log. */
void MPMPoint::write(const MaterialPoint &point, bigint step)
{
  const bool first = step == (path == TRIAXIAL && pressure > 0.0 ? -CONSOLIDATION_STEPS : 0);
  const bool in_table = !file.empty() && (step % every == 0 || step == nsteps || first);
  const bool in_log = first || step == nsteps || step % std::max<bigint>(1, nsteps / 10) == 0;
  if (!in_table && !in_log) return;

  const auto columns = row(point, step);
  for (const auto &[name, value] : columns)
    if (!std::isfinite(value))
      error->all(FLERR, "Mpm_point: step {} at time {:.6g}: {} is not finite", step, point.time,
                 name);
  if (comm->me != 0) return;
  if (in_table) {
    std::vector<std::string> names, values;
    for (const auto &[name, value] : columns) {
      names.push_back(name);
      values.push_back(fmt::format("{:.15g}", value));
    }
    if (first) utils::print(fp, "{}\n", utils::join_words(names, " "));
    utils::print(fp, "{}\n", utils::join_words(values, " "));
  }
  if (in_log) {
    std::string names = "   Step          Time     ",
                values = fmt::format("{:10d}   {:<14.8g}", step, point.time);
    static const char *const shown[] = {"exx",      "exy",    "sxx", "sxy", "pressure",
                                        "vonmises", "stored", "us",  "up"};
    for (const auto &[name, value] : columns)
      if (std::find(std::begin(shown), std::end(shown), name) != std::end(shown)) {
        names += fmt::format(" {:^14}", name);
        values += fmt::format(" {:<14.8g}", value);
      }
    if (first) utils::logmesg(lmp, "{}\n", names);
    utils::logmesg(lmp, "{}\n", values);
  }
}
