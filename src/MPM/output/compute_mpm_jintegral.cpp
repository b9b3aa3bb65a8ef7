/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* The domain integral of J (Moran and Shih 1987) in the reference configuration,

     J = sum_p V0 (P_iJ H_i1 - W delta_1J) dq/dX_J - sum_p f_i H_i1 q,   H = F - I,

   is the same for any q that is 1 at the tip and 0 at the boundary of a domain. With a q of the
   present position, dq/dX_J = q_,k F_kJ, it needs no reference positions, and holds for large
   strains:

     J = sum_p V0 (tau_ik H_i1 - W F_k1) q_,k - sum_p f_i H_i1 q.

   Acceleration adds d/dt sum_p m v_i H_i1 q + sum_p m v^2/2 dq/dX_1, where q does not move. This is
   sum_p m a_i H_i1 q for a tip at rest, and otherwise makes J the flux of W and of the kinetic
   energy to the tip (Nakamura, Shih, and Freund 1985).

   Stress intensity factors are those of the terms in J that belong to two fields, this one and that
   of a tip with a factor of 1, times E'/2. */

#include "output/compute_mpm_jintegral.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_image.h"
#include "base/mpm_options.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_point_batches.h"
#include "force.h"
#include "material/material_point.h"
#include "math_const.h"
#include "math_extra.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <utility>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** compute ID group mpm/jintegral keyword values ... */
Options MPMJIntegralOptions::declare(int dim)
{
  using namespace option;
  Options o("compute mpm/jintegral");
  OptionValue position =
      variables(tip, dim, "x y z", "distance", "position of the tip, can be variables");
  position.usage = "x y z (in 2d: x y)";
  o.add("tip", {position}).standard("required");
  o.add("direction",
        {axes(direction, dim, "nx ny nz", ANY_NUMBER, "", "direction in which the crack grows")})
      .standard("required");
  o.add("radius",
        {numbers(radius, 2, "R1 R2", POSITIVE, "distance",
                 "the weight of points is 1 up to the first distance from the tip, 0 from the "
                 "second one on")})
      .standard("required");
  o.add("front",
        {word(front,
              {{"x", 0}, {"y", 1}, {"z", 2, "axis to which the front of the crack is parallel"}})});
  o.add("thickness",
        {number(thickness, "B", POSITIVE, "distance", "length of the front in the points")})
      .standard("length of the box along the front");
  o.add("symmetric",
        {word(half,
              {{"no", WHOLE, "the points are on both sides of the crack"},
               {"yes", SYMMETRIC, "they are one half of a body that opens: J and KI are of both"},
               {"skew", SKEW, "they are one half of a body that slides: J and KII are of both"}})});
  o.add("plane",
        {word(plane_stress,
              {{"strain", false, "stress intensity factors are those of plane strain"},
               {"stress", true, "those of plane stress, for the mean of a thin plate in 3d"}})});
  o.add("inertia", {yes_no(inertia)},
        "include the acceleration of points, from the change since the last evaluation");
  o.refuse([this, dim] {
    const double length = MathExtra::len3(direction);
    return OptionRules{
        {!tip[0].given, "", "needs the keyword tip, with the position of the tip"},
        {!(length > 0.0), "", "needs the keyword direction, in which the crack grows"},
        {!(radius[1] > 0.0), "", "needs the keyword radius, with two distances from the tip"},
        {radius[0] >= radius[1], "radius",
         "{radius}: the first distance must be less than the second one"},
        {dim == 2 && front != 2, "front", "is along z in 2d, not {front}"},
        {dim == 2, "thickness", "is for 3d: in 2d, J is that of a unit of thickness"},
        {dim == 2 && plane_stress, "plane", "is {plane} in 3d only: in 2d, strain is plane"},
        {std::fabs(direction[front]) > 1.0e-10 * length, "direction",
         "{direction} must be normal to the front, which is along {front}"}};
  });
  return o;
}

ComputeMPMJIntegral::ComputeMPMJIntegral(LAMMPS *lmp, int narg, char **arg) :
    Compute(lmp, narg, arg)
{
  if (!atom->rmass || !atom->vfrac)
    error->all(FLERR, 2,
               "Compute mpm/jintegral needs material points: use atom_style mpm, alone or in a "
               "hybrid");
  Options options = declare(domain->dimension);
  read_options(lmp, options, narg, arg, 3);
  const double length = MathExtra::len3(direction);
  for (int d = 0; d < 3; d++) {
    axis[0][d] = direction[d] / length;
    axis[2][d] = d == front ? 1.0 : 0.0;
  }
  MathExtra::cross3(axis[2], axis[0], axis[1]);

  scalar_flag = vector_flag = 1;
  size_vector = NVALUES;
  extscalar = extvector = 0;
  vector = values;
}

void ComputeMPMJIntegral::init()
{
  const auto fields = MPMField::all(lmp);
  if (fields.empty())
    error->all(FLERR, Error::NOLASTLINE,
               "Compute {} of style mpm/jintegral looks at points of fix mpm, and there is none: "
               "define one",
               id);
  for (const char *style : {"^mpm/pore$", "^mpm/mixture$"})
    if (!modify->get_fix_by_style(style).empty())
      error->all(FLERR, Error::NOLASTLINE,
                 "Compute {} of style mpm/jintegral does not know the pressure in pores: remove "
                 "it, or fix {}",
                 id, modify->get_fix_by_style(style)[0]->id);
  for (const auto *field : fields)
    refuse_field(lmp, fmt::format("Compute {} of style mpm/jintegral", id), *field,
                 {{field->options.axisymmetric, "axisymmetric", "use a sector in 3d"}});
  for (auto &x : tip) find_variable(lmp, x, "compute mpm/jintegral tip");
  without_stress = 0;
  for (const auto *body : find_fixes<MPMInternalForce>(lmp))
    without_stress |= body->group_of_points();
  moduli.clear();
  warnings = 0;
  last.exists = before.exists = false;    // velocities may be set between runs
}

/** From small strains along the crack, across it, and in shear, at rest: sigma = C e. In plane
 *  strain, kappa = 3 - 4 nu, in plane stress (3 - nu)/(1 + nu). */
ComputeMPMJIntegral::Moduli ComputeMPMJIntegral::find_moduli(const Material &material) const
{
  constexpr double SMALL = 1.0e-6, SAME = 1.0e-3;
  constexpr double none[9] = {0.0};
  constexpr int voigt[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  const auto stress = [&](const MaterialPoint &point, int a, int b) {
    double sum = 0.0;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) sum += axis[a][i] * point.stress(voigt[i][j]) * axis[b][j];
    return sum;
  };
  double C[3][3];    // [strain][stress]
  for (int k = 0; k < 3; k++) {
    const int a = k == 1, b = k != 0;    // 11, 22, 12
    double strain[9];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        strain[3 * i + j] = 0.5 * SMALL * (axis[a][i] * axis[b][j] + axis[b][i] * axis[a][j]);
    MaterialPoint point(material);
    const MaterialPoint start(point);
    point.move(strain, 1.0);
    point.move(none, 1.0);    // viscous stress is gone
    C[k][0] = (stress(point, 0, 0) - stress(start, 0, 0)) / SMALL;
    C[k][1] = (stress(point, 1, 1) - stress(start, 1, 1)) / SMALL;
    C[k][2] = (stress(point, 0, 1) - stress(start, 0, 1)) / SMALL;
  }
  const double scale = SAME * std::fabs(C[0][0]), mu = C[2][2];
  const bool isotropic = std::fabs(C[0][0] - C[1][1]) <= scale &&
      std::fabs(C[0][0] - C[0][1] - 2.0 * mu) <= scale && std::fabs(C[0][2]) <= scale;
  const double nu = C[0][1] / (C[0][0] + C[0][1]);    // the law is that of 3d
  return {isotropic ? mu : 0.0, plane_stress ? (3.0 - nu) / (1.0 + nu) : 3.0 - 4.0 * nu};
}

/** Evaluates where the tip is in this step. */
void ComputeMPMJIntegral::find_tip()
{
  for (int d = 0; d < 3; d++) place[d] = evaluate(lmp, tip[d]);
  for (int d = 0; d < domain->dimension; d++)
    if (d != front && !domain->periodicity[d] &&
        !(place[d] >= domain->boxlo[d] && place[d] <= domain->boxhi[d]))
      error->all(FLERR, Error::NOLASTLINE,
                 "Compute {}: the tip of the crack, {} {} {}, is not in the box: change tip", id,
                 place[0], place[1], place[2]);
  for (int d = 0; d < domain->dimension; d++)
    if (d != front && domain->periodicity[d] && 2.0 * radius[1] > domain->prd[d])
      error->all(FLERR, Error::NOLASTLINE,
                 "Compute {}: radius {} is more than half of the periodic box along {}: the circle "
                 "meets itself, so make it smaller",
                 id, radius[1], "xyz"[d]);
}

/** Is a point closer to the tip than the outer radius? r: its position from there in the plane. */
bool ComputeMPMJIntegral::is_inside(int i, const double *tip, double *r) const
{
  if (atom->mask[i] & without_stress) return false;
  double dx[3];
  MathExtra::sub3(atom->x[i], tip, dx);
  nearest_image(*domain, dx);
  for (int a = 0; a < 2; a++) r[a] = MathExtra::dot3(axis[a], dx);
  return r[0] * r[0] + r[1] * r[1] < radius[1] * radius[1];
}

namespace {

/** Stresses, and slopes u_,1 of the displacement, of the fields at a tip with a stress intensity
 *  factor of 1 in one of the modes (Williams 1957). */
struct TipFields {
  double stress[2][2][2], slope[2][2];    // [mode][]

  TipFields(const double *r, double mu, double kappa)
  {
    const double distance = std::hypot(r[0], r[1]), x = r[0] / distance;
    const double k = 1.0 / std::sqrt(MathConst::MY_2PI * distance), to_strain = 0.5 / mu;
    const double c = std::sqrt(std::max(0.0, 0.5 * (1.0 + x))),    // of half the angle
        s = std::copysign(std::sqrt(std::max(0.0, 0.5 * (1.0 - x))), r[1]);
    const double c3 = c * (4.0 * c * c - 3.0), s3 = s * (3.0 - 4.0 * s * s);    // of 3/2 of it
    set(0, k * c * (1.0 - s * s3), k * c * (1.0 + s * s3), k * c * s * c3);
    slope[0][0] = to_strain * k * c * (0.5 * (kappa - 1.0) - s * s3);
    slope[0][1] = to_strain * k * s * (c * c3 - 0.5 * (kappa + 1.0));
    set(1, -k * s * (2.0 + c * c3), k * s * c * c3, k * c * (1.0 - s * s3));
    slope[1][0] = -to_strain * k * s * (0.5 * (kappa + 1.0) + c * c3);
    slope[1][1] = to_strain * k * c * (1.0 - s * s3 - 0.5 * (kappa + 1.0));
  }

 private:
  void set(int mode, double xx, double yy, double xy)
  {
    stress[mode][0][0] = xx;
    stress[mode][1][1] = yy;
    stress[mode][0][1] = stress[mode][1][0] = xy;
  }
};

/** Weight of a point at r from the tip, and its slope: 1 up to the first radius, then
 *  1 - 3 s^2 + 2 s^3, and 0 from the second one on, so that sums over points are smooth. */
struct Weight {
  double q, slope[2] = {0.0, 0.0};

  Weight(const double *r, const double *radius)
  {
    const double distance = std::hypot(r[0], r[1]), width = radius[1] - radius[0];
    const double s = std::max(0.0, (distance - radius[0]) / width);
    q = (1.0 - s) * (1.0 - s) * (1.0 + 2.0 * s);
    if (s > 0.0)
      for (int a = 0; a < 2; a++) slope[a] = -6.0 * s * (1.0 - s) / width * r[a] / distance;
  }
};

}    // namespace

/** Derivative of the displacement of point k of a batch along an axis. */
void ComputeMPMJIntegral::displacement_slope(const Batch &batch, int k, int along, double *u) const
{
  const double *const e = axis[along];
  for (int m = 0; m < 3; m++)
    u[m] = batch.F[3 * m][k] * e[0] + batch.F[3 * m + 1][k] * e[1] + batch.F[3 * m + 2][k] * e[2] -
        e[m];
}

/** Adds the integrals over points of a batch. stored: energy per reference volume. */
void ComputeMPMJIntegral::add(const Batch &batch, const int *list, const Moduli &of,
                              const double *stored, Sums &sums) const
{
  constexpr int voigt[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  const double to_energy = 1.0 / force->nktv2p;
  for (int k = 0; k < batch.n; k++) {
    const int i = list[k];
    double r[2];
    if (!is_inside(i, place, r)) continue;
    const Weight weight(r, radius);
    const double q = weight.q, *const dq = weight.slope;

    double slope[3], across[3], pull[3];    // u_,1, u_,2, and tau grad q
    displacement_slope(batch, k, 0, slope);
    displacement_slope(batch, k, 1, across);
    for (int m = 0; m < 3; m++) {
      pull[m] = 0.0;
      for (int n = 0; n < 3; n++)
        pull[m] += batch.stress[voigt[m][n]][k] * (axis[0][n] * dq[0] + axis[1][n] * dq[1]);
      pull[m] *= batch.J[k];
    }
    const double H[2][2] = {{MathExtra::dot3(axis[0], slope), MathExtra::dot3(axis[0], across)},
                            {MathExtra::dot3(axis[1], slope), MathExtra::dot3(axis[1], across)}};

    const double V = to_energy * batch.vol0[k], *const f = atom->f[i];
    const double dq_reference = (1.0 + H[0][0]) * dq[0] + H[1][0] * dq[1];    // dq/dX_1
    const double kinetic =
        inertia ? 0.5 * force->mvv2e * atom->rmass[i] * MathExtra::lensq3(atom->v[i]) : 0.0;
    sums.volume += batch.vol0[k] * batch.J[k];
    sums.integral[RATE] += V * MathExtra::dot3(pull, slope) - q * MathExtra::dot3(f, slope) +
        (kinetic - V * stored[k]) * dq_reference;
    if (!(of.mu > 0.0) || (r[0] == 0.0 && r[1] == 0.0)) continue;

    const TipFields near(r, of.mu, of.kappa);
    double load[2];    // along and across the crack
    for (int a = 0; a < 2; a++)
      load[a] = V * MathExtra::dot3(axis[a], pull) - q * MathExtra::dot3(axis[a], f);
    for (const int mode : {0, 1}) {
      double sum = 0.0;
      for (int a = 0; a < 2; a++) {
        sum += load[a] * near.slope[mode][a];
        for (int b = 0; b < 2; b++)
          sum += V * near.stress[mode][a][b] * (H[a][0] * dq[b] - H[a][b] * dq[0]);
      }
      sums.integral[ONE + mode] += of.half_modulus() * sum;
    }
  }
}

/** Adds sum_p m v_i H_i1 q, and what corresponds to it for both modes. */
void ComputeMPMJIntegral::add_momentum(const Batch &batch, const int *list, const Moduli &of,
                                       const double *tip_then, double *momentum) const
{
  for (int k = 0; k < batch.n; k++) {
    const int i = list[k];
    double r[2], slope[3];
    if (!is_inside(i, tip_then, r)) continue;
    displacement_slope(batch, k, 0, slope);
    const double *const v = atom->v[i];
    const double mass = force->mvv2e * atom->rmass[i] * Weight(r, radius).q;
    momentum[RATE] += mass * MathExtra::dot3(v, slope);
    if (!(of.mu > 0.0) || (r[0] == 0.0 && r[1] == 0.0)) continue;
    const TipFields near(r, of.mu, of.kappa);
    const double along = MathExtra::dot3(axis[0], v), across = MathExtra::dot3(axis[1], v);
    for (const int mode : {0, 1})
      momentum[ONE + mode] +=
          of.half_modulus() * mass * (along * near.slope[mode][0] + across * near.slope[mode][1]);
  }
}

/** Is there plastic strain where q varies? */
bool ComputeMPMJIntegral::have_yielded(const Batch &batch, const int *list, const double *plastic,
                                       double at_rest) const
{
  for (int k = 0; k < batch.n; k++) {
    double r[2];
    if (plastic[k] != at_rest && is_inside(list[k], place, r) && std::hypot(r[0], r[1]) > radius[0])
      return true;
  }
  return false;
}

void ComputeMPMJIntegral::compute_vector()
{
  invoked_vector = update->ntimestep;
  find_tip();
  const double time = update->atime + (update->ntimestep - update->atimestep) * update->dt;
  if (last.exists && time > last.time) before = last;    // not if called again in the same step
  Sums mine = {}, sums;
  Extremes my_most = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL, 0.0, 0.0, 0.0, 0.0}, most;
  const auto fields = MPMField::all(lmp);
  visit_point_batches(
      lmp, groupbit, [&](const Batch &batch, const int *list, const FixMPMMaterial &material) {
        const auto field = std::find_if(fields.begin(), fields.end(), [&](const auto *one) {
          return one->is_point(list[0]);
        });
        if (field == fields.end()) return;
        double unused[2], stored[BATCH];
        const auto is_near = [&](const double *tip_then) {
          return std::any_of(list, list + batch.n, [&](int i) {
            return is_inside(i, tip_then, unused);
          });
        };
        const bool is_now = is_near(place), was = before.exists && is_near(before.place);
        if (!is_now && !was) return;
        const auto [at, is_new] = moduli.insert({material.instance(), {}});
        if (is_new) at->second = find_moduli(*material.material);
        const Moduli &of = at->second;
        if (was) add_momentum(batch, list, of, before.place, mine.momentum[1]);
        if (!is_now) return;
        if (inertia) add_momentum(batch, list, of, place, mine.momentum[0]);
        material.material->stored_energy(batch, stored);
        add(batch, list, of, stored, mine);

        if (before.exists) {
          double speed[BATCH];
          material.material->elastic_speed(batch, speed);
          my_most.speed = std::max(my_most.speed, *std::max_element(speed, speed + batch.n));
        }
        my_most.mu = std::max(my_most.mu, of.mu);
        my_most.minus_mu = std::max(my_most.minus_mu, -of.mu);
        my_most.kappa = std::max(my_most.kappa, of.kappa);
        my_most.minus_kappa = std::max(my_most.minus_kappa, -of.kappa);
        if (material.material->is_thermoelastic()) my_most.expands = 1.0;
        for (const auto &[name, at_rest] : {std::pair("eplastic", 0.0), {"jplastic", 1.0}})
          if (const int row = material.find_history(name);
              row >= 0 && have_yielded(batch, list, batch.history[row], at_rest))
            my_most.has_yielded = 1.0;
        my_most.spacing = std::max(my_most.spacing, (*field)->lattice.h);
      });
  constexpr int NSUMS = sizeof(Sums) / sizeof(double), NMOST = sizeof(Extremes) / sizeof(double);
  MPI_Allreduce(&mine, &sums, NSUMS, MPI_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(&my_most, &most, NMOST, MPI_DOUBLE, MPI_MAX, world);

  if (before.exists)
    for (int k = 0; k < NINTEGRALS; k++)
      sums.integral[k] += (sums.momentum[1][k] - before.momentum[k]) / (time - before.time);
  std::copy_n(place, 3, last.place);
  std::copy_n(sums.momentum[0], NINTEGRALS, last.momentum);
  last.time = time;
  last.exists = inertia;

  double length = 1.0;    // in 2d, volumes and forces are those of a unit of it
  if (domain->dimension == 3) length = thickness > 0.0 ? thickness : domain->prd[front];
  const double sides = half == WHOLE ? 1.0 : 2.0;
  values[J] = sides * sums.integral[RATE] / length;
  values[K1] = half == SKEW ? 0.0 : sides * force->nktv2p * sums.integral[ONE] / length;
  values[K2] = half == SYMMETRIC ? 0.0 : sides * force->nktv2p * sums.integral[TWO] / length;
  values[FILLED] = sides * sums.volume / (length * MathConst::MY_PI * radius[1] * radius[1]);
  look_at(sums, most, before.exists ? time - before.time : 0.0);
  scalar = values[J];
}

/** Are there points that resolve the fields, all around the tip, with a law for which the integrals
 *  have a meaning? */
void ComputeMPMJIntegral::look_at(const Sums &sums, const Extremes &most, double interval)
{
  constexpr double LEAST_CELLS = 2.0, MOST_DIFFERENT = 0.05, SAME = 1.0e-6, MOST_WAY = 0.25;
  enum { FILLED_BADLY, YIELDED, EXPANDS, MODULI, SELDOM };
  if (!(sums.volume > 0.0))
    error->all(FLERR, Error::NOLASTLINE,
               "Compute {}: there are no points of its group closer than {} to the tip at "
               "{} {} {}: change tip, radius, or the group",
               id, radius[1], place[0], place[1], place[2]);
  if (radius[0] < LEAST_CELLS * most.spacing * (1.0 - SAME))
    error->all(FLERR, Error::NOLASTLINE,
               "Compute {}: radius {} is less than two node spacings of {}, which do not resolve "
               "the fields at the tip: make it larger",
               id, radius[0], most.spacing);
  if (!(std::fabs(values[FILLED] - 1.0) <= MOST_DIFFERENT))
    warn(FILLED_BADLY,
         fmt::format("points fill {:.1f} % of the circle with the radius {} around the tip: make "
                     "it smaller if it goes out of the body, and check thickness, symmetric, and "
                     "the group",
                     100.0 * values[FILLED], radius[1]));
  if (most.has_yielded > 0.0)
    warn(YIELDED,
         "points between both radii have plastic strain, for which J depends on the radii: make "
         "the first one larger than the plastic zone");
  if (most.expands > 0.0)
    warn(EXPANDS,
         "the material expands with temperature, for which J depends on the radii where the "
         "temperature varies: make them small");
  if (most.speed * interval > MOST_WAY * radius[1])
    warn(SELDOM,
         fmt::format("waves go {:.2g} times as far as the radius {} in the time since the last "
                     "evaluation, over which inertia takes the mean acceleration: evaluate it in "
                     "more steps",
                     most.speed * interval / radius[1], radius[1]));
  const bool uniform = -most.minus_mu > 0.0 && most.mu + most.minus_mu <= SAME * most.mu &&
      most.kappa + most.minus_kappa <= SAME;
  if (uniform) return;
  values[K1] = values[K2] = 0.0;
  warn(MODULI,
       "stress intensity factors are 0, as the points around the tip have no isotropic elastic "
       "law, or several ones: choose the group, or use J");
}

/** Once in each run. */
void ComputeMPMJIntegral::warn(int which, const std::string &text)
{
  if (comm->me == 0 && !(warnings & (1 << which)))
    error->warning(FLERR, "Compute {}: {}", id, text);
  warnings |= 1 << which;
}

double ComputeMPMJIntegral::compute_scalar()
{
  if (invoked_vector != update->ntimestep) compute_vector();
  invoked_scalar = update->ntimestep;
  return scalar;
}
