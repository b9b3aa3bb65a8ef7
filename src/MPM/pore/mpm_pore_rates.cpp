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
#include "force.h"
#include "material/material.h"
#include "math_const.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
  const double along[3] = {weight(0), weight(1), dim == 3 ? weight(2) : 0.0};
  const double momentum = water.density * force->mvv2e * force->nktv2p;
  Inertia sum;
  for (const auto &run : field.map->runs) {
    if (!soil(run.material)) continue;
    Inertia here;
    for (int i = run.first; i < run.last; i++) {
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
      here.add({K * speed, K * push, K * all, atom->rmass[i] * speed});
    }
    sum.add(here);
  }
  const double unit = 1.0 / force->nktv2p;
  return {sum.velocity * momentum * momentum * unit, sum.flow * unit, sum.gradient * unit,
          0.5 * force->mvv2e * sum.kinetic};
}

/* ----------------------------------------------------------------------
   The part r_p of the pressures of points that nodes do not see decays in the time in which flow
   crosses a cell, as in the conduction of heat (mpm_conduction.cpp). It also decays in about
   1/relax of the time in which a wave crosses a cell, except its smooth part

     s_p = sum_i N_ip sum_q C_q N_iq r_q/C_i,  sum_p C_p s_p = sum_p C_p r_p,

   as nodes give it back to points without slopes. On the way from nodes to points and back an
   alternating pressure keeps 0.61 of itself with slopes, 0.14 without, and a linear one all, with
   the errors k^4 and k^2 for a wave with the number k: per time, k^6 is removed. So a pressure that
   alternates with almost no force on nodes, which a load makes that the lattice does not resolve,
   vanishes in some crossings of a cell, and one over many cells stays. Without s this would be k^4,
   and affect pressures in long runs of slow flow. Points need no pass of their own for s: nodes
   have its values before they give points theirs.
------------------------------------------------------------------------- */

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

/* ---------------------------------------------------------------------- */

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
