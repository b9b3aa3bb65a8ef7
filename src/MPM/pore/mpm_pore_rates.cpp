/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Rates of the flow of pore water, and what shows how good its approximations are

#include "pore/mpm_pore.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_passes.h"
#include "force.h"
#include "material/material.h"
#include "math_const.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** Sums that measure the acceleration that u-p neglects. The gradient of the pressure lacks rho_f
 *  times the acceleration of the soil, by which the resistance would dissipate the power K (rho_f
 *  dv/dt)^2. From one step to another, the root of the sum of K (rho_f v)^2 changes at most by dt
 *  times the root of that power, and by as much if a motion keeps its shape, as a standing wave
 *  does: this bound needs no accelerations of points. */
MPMPore::Inertia MPMPore::inertia(const MPMRows &state) const
{
  const int dim = field.lattice.dim;
  const auto along = weight();
  const double momentum = inertial_density();
  Inertia sum;
  each_point_batch(field, [&](const auto &run, int first, int n) {
    if (!soil(run.material)) return;
    for (int i = first; i < first + n; i++) {
      const double *const v = atom->v[i], *const gradient = state[i] + 1;
      double speed = 0.0, push = 0.0, all = 0.0;
      for (int d = 0; d < dim; d++) {
        speed += v[d] * v[d];
        all += gradient[d] * gradient[d];
        push += (gradient[d] - along[d]) * (gradient[d] - along[d]);
      }
      double K = conductance[i];
      if (!quadratic.empty() && K > 0.0) {
        const double V = field.points->jacobian(i) * atom->vfrac[i];
        K = V * secant_mobility(K / V, quadratic[i], sqrt(push));
      }
      sum.add({K * speed, K * push, K * all, atom->rmass[i] * speed});
    }
  });
  const double unit = 1.0 / force->nktv2p;
  return {sum.velocity * momentum * momentum * unit, sum.flow * unit, sum.gradient * unit,
          0.5 * force->mvv2e * sum.kinetic};
}

/** The part r_p of the pressures of points that nodes do not see decays in the time in which flow
 *  crosses a cell, as in the conduction of heat (mpm_conduction.cpp). It also decays in about
 *  1/relax of the time in which a wave crosses a cell, except its smooth part
 *
 *    s_p = sum_i N_ip sum_q C_q N_iq r_q/C_i,  sum_p C_p s_p = sum_p C_p r_p,
 *
 *  as nodes give it back to points without slopes. On the way from nodes to points and back an
 *  alternating pressure keeps 0.61 of itself with slopes, 0.14 without, and a linear one all, with
 *  the errors k^4 and k^2 for a wave with the number k: per time, k^6 is removed. So a pressure
 *  that alternates with almost no force on nodes, which a load makes that the lattice does not
 *  resolve, vanishes in some crossings of a cell, and one over many cells stays. Without s this
 *  would be k^4, and affect pressures in long runs of slow flow. Points need no pass of their own
 *  for s: nodes have its values before they give points theirs. */
double MPMPore::rate_of_waves() const
{
  return relax * waves / field.lattice.h;
}

double MPMPore::rate_of_lag() const
{
  return slowest / (field.lattice.h * field.lattice.h) + rate_of_waves();
}

/** Loss of smooth pressures in one flow. A flow that follows steps without flow removes everything
 *  that nodes do not see, except its smooth part. Nodes see, and give back to points, 1 - 0.056 (k
 *  h)^4 of a wave with the number k with its slopes, and 1 - (k h)^2/4 without slopes, from the
 *  moments of quadratic functions. Soil that gives way holds the rest. */
MPMPore::Smoothing MPMPore::smoothing(double duration) const
{
  constexpr double PHASE = MathConst::MY_2PI / Smoothing::WAVELENGTH, SQUARE = PHASE * PHASE,
                   UNSEEN = 0.056 * SQUARE * SQUARE, ROUGH = 0.25 * SQUARE;
  if (suction || solve) return {0.0, 0.0};
  const double h = field.lattice.h, lag = after_wait ? 1.0 : 1.0 - exp(-rate_of_waves() * duration);
  const double lost = lag * UNSEEN * ROUGH, flowed = slowest * duration * SQUARE / (h * h);
  const bool known = std::none_of(soils.begin(), soils.end(), [](const auto &s) {
    return s.of.law == MPMPoreSoil::FORMULA;
  });
  return {of_storage * lost, known ? lost / std::max(flowed, 1.0e-6 * lost) : 0.0};
}

double MPMPore::conduction_rate() const
{
  return fastest * steepest / (field.lattice.h * field.lattice.h);
}

double MPMPore::conduction_rate(const MPMRows &state, tagint &tag) const
{
  double most = -1.0;
  for (int i = 0; i < atom->nlocal && has_water(); i++) {
    if (!field.is_point(i)) continue;
    const Soil *const s = soil(field.material_of(i));
    if (!s) continue;
    const double J = field.points->jacobian(i);
    const double k = s->of.law == MPMPoreSoil::FORMULA ? 0.0 : mobility(*s, i, J, nullptr);
    double here = k / s->of.storage_at(J, water);
    if (s->of.retention.can_dry() && state[i][0] < 0.0) {
      const auto moisture = MPMPoreMoisture::at(s->of, J, state[i][0], water);
      here = k * moisture.relative / moisture.storage;
    }
    if (here <= most) continue;
    most = here;
    tag = atom->tag[i];
  }
  return most < 0.0 ? most : most * steepest / (field.lattice.h * field.lattice.h);
}

double MPMPore::widest_spacing() const
{
  return pow(largest, 1.0 / field.lattice.dim) / field.lattice.h;
}

double MPMPore::wave_speed(int i, double p, double c) const
{
  const Soil *const s = soil(field.material_of(i));
  if (!s) return c;
  const double J = field.points->jacobian(i), density = atom->rmass[i] / (J * atom->vfrac[i]);
  const double storage = s->of.storage_at(J, water);
  if (motion) return motion->wave_speed(c, density, s->of.biot, storage, s->of.pores_at(J));
  double more = s->of.biot * s->of.biot / storage;
  if (s->of.retention.can_dry()) {
    const auto moisture = MPMPoreMoisture::at(s->of, J, p, water);
    more = moisture.bishop * std::min(1.0, moisture.filling) / moisture.storage;
    c *= sqrt(s->fix->density(i) * atom->vfrac[i] / atom->rmass[i]);    // c is that of full pores
  }
  return sqrt(c * c + more / (density * force->mvv2e * force->nktv2p));
}

/* ----------------------------------------------------------------------
   Steps between two flows of pore water, in which no water leaves its point (keyword every of fix
   mpm/pore).

   The motion changes the pressure of a point by dp = - alpha dV/C, with the change dV of its volume
   since the last flow and its storage C = S V. This needs no nodes, and forces have p + dp. The
   step with the flow takes dp to nodes with the same weights as each step that does not wait
   (mpm_pore.cpp), so that nodes see the same part of the motion, and points get the pressure of
   nodes. The part of dp that nodes cannot see, with which points would lock, is lost before it
   exceeds the effect of waves in so many steps.

   A flow right after a step with flow is the same as without waits, to the last bit.

   The flow starts with all of dp except that of its own step. If the squeezed volume were spread
   over the time of the flow, the flow would act in forces half of that time too late, and waves
   would have a frequency that is too high by a quarter of the share of their pressure that flow
   takes in that time.
------------------------------------------------------------------------- */

double MPMPore::undrained(const Soil &s, int i, double J) const
{
  const double last = (*waiting)[i];
  return last > 0.0 ? s.of.undrained(last, J, water) : 0.0;
}

double MPMPore::undrained(int i) const
{
  const Soil *const s = waiting ? soil(field.material_of(i)) : nullptr;
  return s ? undrained(*s, i, field.points->jacobian(i)) : 0.0;
}

/** Starts a flow: all changes go into the pressure of points, and into forces. squeezed has the
 *  volumes of points, and capacity their storage. */
void MPMPore::gather(const Soil &s, int first, int n, const double *J, const MPMRows &state)
{
  const int width = 1 + field.lattice.dim;
  const double alpha = s.of.biot;
  const double *const V = squeezed.data() + first, *const C = capacity.data() + first,
                      *const initial = atom->vfrac + first;
  double *const last = *waiting + first, *const part = in_forces.data() + first,
                *const value = mean.data() + first, *row = state[first];
  if (after_wait) {
    double change[BATCH];
    for (int p = 0; p < n; p++) {
      const double since = last[p] > 0.0 ? last[p] : J[p];
      change[p] = alpha * (since - J[p]) * initial[p] / C[p];
    }
    for (int p = 0; p < n; p++, row += width) value[p] = row[0] += change[p];
    for (int p = 0; p < n; p++) part[p] *= value[p];
  }
  for (int p = 0; p < n; p++) largest = std::max(largest, V[p]);
  look_at_layers(lie[&s - soils.data()], first, n, V);
  std::copy_n(J, n, last);
}

/** Measures how much points lie in layers. With quadratic functions, velocities of nodes that
 *  alternate between 1 and -1 along an axis have the slope 0 at nodes, and 2 per cell in the middle
 *  between them; in between the slope is linear. */
void MPMPore::look_at_layers(Layers &sum, int first, int n, const double *V) const
{
  double volume = 0.0;
  for (int p = 0; p < n; p++) volume += V[p];
  sum.volume += volume;
  for (int d = 0; d < field.lattice.dim; d++) {
    const double *const x = atom->x[first] + d;
    const double origin = field.lattice.origin[d], cells = 1.0 / field.lattice.h;
    double steep = 0.0;
    for (int p = 0; p < n; p++) {
      const double at = cells * (x[3 * p] - origin), slope = 4.0 * (at - std::floor(at + 0.5));
      steep += V[p] * slope * slope;
    }
    sum.steep[d] += steep;
  }
}

void MPMPore::add_slopes(const MPMRows &state, Slopes &sum) const
{
  const int dim = field.lattice.dim;
  const auto along = weight();
  each_point_batch(field, [&](const auto &run, int first, int n) {
    if (!soil(run.material)) return;
    const double *row = state[first];
    double steepest = sum.steepest, highest = sum.highest, less = sum.less;
    for (int i = first; i < first + n; i++, row += 1 + dim) {
      double square = 0.0;
      for (int d = 0; d < dim; d++) square += (row[1 + d] - along[d]) * (row[1 + d] - along[d]);
      if (square * conductance[i] > steepest * capacity[i])
        steepest = square * conductance[i] / capacity[i];
      highest = std::max(highest, row[0]);
      less = std::max(less, -row[0]);
    }
    sum = {steepest, highest, less};
  });
}

void MPMPore::begin_wait(const MPMRows &state)
{
  in_forces.resize(atom->nmax);
  const int width = 1 + field.lattice.dim;
  double buffer[BATCH], p_old[BATCH], storage[BATCH];
  each_point_batch(field, [&](const auto &run, int first, int n) {
    const Soil *const s = soil(run.material);
    double *const part = in_forces.data() + first, *const last = *waiting + first;
    if (!s) {
      std::fill_n(part, n, 0.0);
      return;
    }
    const double alpha = s->of.biot;
    const double *const J = field.jacobians.get(field, first, n, buffer), *row = state[first];
    int unknown = 0;
    for (int p = 0; p < n; p++) unknown += !(last[p] > 0.0);
    for (int p = 0; unknown && p < n; p++) last[p] = last[p] > 0.0 ? last[p] : J[p];
    for (int p = 0; p < n; p++, row += width) p_old[p] = row[0];
    // a loop of its own, which the compiler can vectorize with its divisions
    s->of.storage_at(n, J, water, storage);
    for (int p = 0; p < n; p++)
      part[p] = alpha * (J[p] * p_old[p] + alpha * J[p] * (last[p] - J[p]) / storage[p]);
  });
}
