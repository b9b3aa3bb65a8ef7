/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Partly saturated soil, with the saturation S(p), Bishop's coefficient chi, and the relative
   permeability k_r:

     rho dv/dt = div(sigma' - chi p I) + rho g,   rho = (1 - n) rho_s + n w rho_f,
     n dw/dp dp/dt = - w div v - div q,   q = - k k_r (grad p - rho_f g)/G,   w = S exp(p/K),

   so that the storage is n (dS/dp + S/K) as far as p is small beside K. Grains are rigid.

   Flow brings water to a point: its volume W is a state of the point, and each increase of W also
   goes to the mass of the point. The pressure follows from w = W/(volume of pores), the mixed form
   (M.A. Celia, E.T. Bouloutas, R.L. Zarba, Water Resour. Res. 26 (1990) 1483). A step is linear in
   p, with the capacity at its start. The volume of pores is that after the motion of the step, so
   that a closed body of any motion keeps both W and the relation of p and W. Only where pores are
   full before and after the step, p is taken from the step, because 1e-16 of W are 1e-7 Pa of
   water.

   Lag. The part of the pressures of points that nodes do not see, p_p - sum_i N_ip p_i, decays at
   the rate k/(G C h^2) in which flow crosses a cell and, in full pores, in some crossings of waves
   (mpm_pore.cpp); the share of waves falls as the storage grows. With factors e_p of a step that
   differ from point to point the sum of C_p e_p (p_p - ...) is not zero, and water would be lost.
   Hence nodes get the rate C_p (e - e_p) (p_p - ...)/dt, with the greatest factor e: the total of
   all points and nodes is kept, and in full pores nothing changes.

   Full pores next to very dry soil. The conductance is that at the start of a step, while the
   capacity of full pores is almost zero: in one step more water would leave them than they have.
   Hence the flow through a cell in a step is limited to a fifth of the water of a point.

   Slopes. Nodes get p_p + g_p (x_i - x_p) with the gradient g_p of the step before. At a front that
   falls by many 1/alpha within a cell, this would make pressures far above those of any point at
   nodes next to it, and hold its own water back. Hence the part of g_p that differs from water at
   rest changes the pressure of points with suction through a cell by 1/alpha + s at most, with the
   suction s, in which S and k_r change by a factor.

   Surface. Through half a cell next to the surface, water comes in with the mean of the
   permeabilities at the pressure outside and inside: rain on dry soil would otherwise not get in.
   It leaves with the permeability inside: the water that leaves the nodes at the surface must be
   able to reach them, or their pressure would fall without bound.
------------------------------------------------------------------------- */

#include "pore/mpm_pore_suction.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "error.h"
#include "field/mpm_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double DRIEST = 100.0;    // suction times alpha, beyond which soil gets no drier
static constexpr double FULLEST =
    100.0;    // pressure times alpha, above which water that fills the last pores is very stiff
static constexpr double STIFF_ENOUGH = 300.0;    // bulk modulus of the water times alpha
static constexpr double MOST_LAG =
    0.1;    // largest share of the water of a point that leaves by its lag in a step
static constexpr double UNDERSHOOT =
    0.05;    // largest lack of water of a point, relative to its pores

MPMPoreMoisture MPMPoreMoisture::at(const MPMPoreSoil &soil, double J, double p,
                                    const MPMPoreWater &water)
{
  const auto state = soil.retention.at(p);
  if (!soil.retention.can_dry() || !(p < 0.0))
    return {soil.retention.most * (1.0 + p / water.bulk), soil.storage_at(J, water), 1.0,
            state.bishop};
  const double dense = exp(p / water.bulk);
  return {state.saturation * dense,
          soil.pores_at(J) * dense * (state.slope + state.saturation / water.bulk), state.relative,
          state.bishop};
}

/** Pressure for this filling, by Newton's method within bounds. */
double MPMPoreMoisture::pressure(const MPMPoreSoil &soil, double filling, double before,
                                 double guess, const MPMPoreWater &water)
{
  const auto &r = soil.retention;
  if (filling >= r.most) return (filling / r.most - 1.0) * water.bulk;
  constexpr int TURNS = 200;
  constexpr double CLOSE = 4.0e-16;
  const auto error = [&](double p, double *slope = nullptr) {
    const auto state = r.at(p);
    const double dense = exp(p / water.bulk);
    if (slope) *slope = dense * (state.slope + state.saturation / water.bulk);
    return state.saturation * dense - filling;
  };
  double low = std::min(before, -DRIEST / r.alpha), high = 0.0;
  if (error(low) >= 0.0) return low;
  double p = guess < high && guess > low ? guess : std::max(low, -1.0 / r.alpha);
  for (int turn = 0; turn < TURNS; turn++) {
    double slope;
    const double e = error(p, &slope);
    if (e == 0.0) break;
    (e > 0.0 ? high : low) = p;
    double next = p - e / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double change = fabs(next - p);
    p = next;
    if (change <= CLOSE * fabs(p)) break;
  }
  return p;
}

/** Energy by Gauss quadrature with four points, in intervals that grow with the suction. */
double MPMPoreMoisture::energy(const MPMPoreSoil &soil, double J, double p,
                               const MPMPoreWater &water)
{
  if (!soil.retention.can_dry() || !(p < 0.0)) return 0.5 * soil.storage_at(J, water) * p * p;
  static constexpr double AT[] = {0.3399810435848563, 0.8611363115940526},
                          WEIGHT[] = {0.6521451548625461, 0.3478548451374538};
  double sum = 0.0, end = 0.0;
  const double first = 0.25 / soil.retention.alpha;
  for (double begin = 0.0; begin > p; begin = end) {
    end = std::max(p, begin == 0.0 ? -first : 1.5 * begin);
    const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
    for (int k = 0; k < 4; k++) {
      const double q = middle + (k % 2 ? half : -half) * AT[k / 2];
      sum += WEIGHT[k / 2] * half * q * at(soil, J, q, water).storage;
    }
  }
  return sum;
}

MPMPoreSuction::MPMPoreSuction(LAMMPS *lmp, MPMField &field, const MPMPoreWater &water,
                               double *const &content) :
    Pointers(lmp),
    field(field), water(water), content(content)
{
}

void MPMPoreSuction::weigh(int i, const MPMPoreSoil &soil, double p) const
{
  if (content[i] >= 0.0 || !soil.retention.can_dry()) return;
  const double J = field.points->jacobian(i);
  const double pores = soil.pores_at(J) * J * atom->vfrac[i];
  const double filling = MPMPoreMoisture::at(soil, J, p, water).filling;
  content[i] = pores * filling;
  const double missing = p < 0.0 ? 1.0 - filling : 1.0 - soil.retention.most;
  atom->rmass[i] -= water.density * pores * missing;
}

void MPMPoreSuction::begin(int nmax, double usual_rate, double rate_of_waves)
{
  of.resize(nmax);
  usual = usual_rate;
  waves = rate_of_waves;
  slowest = std::numeric_limits<double>::max();
}

void MPMPoreSuction::begin_point(int i, const MPMPoreSoil &soil, double J, double V, double p,
                                 double &capacity, double &conductance, double &through,
                                 double &in_forces)
{
  weigh(i, soil, p);
  Point &point = of[i];
  point.most = capacity;
  point.conductance = through;
  point.keep = usual;
  point.filling = 1.0;
  point.full = soil.pores_at(J) * V;
  if (soil.retention.can_dry()) {
    const auto state = MPMPoreMoisture::at(soil, J, p, water);
    point.filling = p < 0.0 ? state.filling : soil.retention.most;
    in_forces *= state.bishop;
    if (p < 0.0) {
      const double h = field.lattice.h;
      capacity = V * state.storage;
      conductance *= state.relative;
      through *= state.relative;
      point.keep = conductance / (capacity * h * h) + waves * point.most / capacity;
    }
  }
  point.capacity = capacity;
  slowest = std::min(slowest, point.keep);
}

void MPMPoreSuction::find_conductances(MPMNodeScalar &scalar, const MPMPoreSurface &surface,
                                       const Soils &soil)
{
  scalar.add_up(
      [&](const MPMPointMap::Run &, int first, int n, double *values) {
        for (int p = 0; p < n; p++) values[p] = of[first + p].most;
      },
      wet.capacity);
  field.nodes.complete(wet.capacity.data(), 1, 1);
  for (int part = -1; part < MPMPoreSurface::NPART; part++) {
    const double outside = part < 0 ? 0.0 : surface.suction_outside(part);
    auto &nodes = wet.conductance[1 + part];
    if (part >= 0 && outside == 0.0) {
      nodes.clear();
      continue;
    }
    scalar.add_up(
        [&](const MPMPointMap::Run &run, int first, int n, double *values) {
          const double share = soil(run)->retention.at(outside).relative;
          for (int p = 0; p < n; p++) values[p] = share * of[first + p].conductance;
        },
        nodes);
    field.nodes.complete(nodes.data(), 1, 1);
  }
}

void MPMPoreSuction::limit_slope(const MPMPoreSoil &soil, double p, const double *at_rest,
                                 const Lattice &lattice, double *g)
{
  if (!(p < 0.0)) return;
  double square = 0.0;
  for (int d = 0; d < lattice.dim; d++) square += (g[d] - at_rest[d]) * (g[d] - at_rest[d]);
  const double change = lattice.h * sqrt(square), most = 1.0 / soil.retention.alpha - p;
  if (change <= most) return;
  for (int d = 0; d < lattice.dim; d++) g[d] = at_rest[d] + most / change * (g[d] - at_rest[d]);
}

double MPMPoreSuction::take_motion(int i, double more, double dt)
{
  Point &point = of[i];
  point.full += more;
  point.keep = exp(-point.keep * dt);
  // a wet point in dry soil: its capacity does not hold on the way to the pressure there
  const double lag = fabs(point.lag) * point.capacity, most = MOST_LAG * point.filling * point.full;
  if ((1.0 - point.keep) * lag > most) point.keep = 1.0 - most / lag;
  return point.filling;
}

void MPMPoreSuction::take_rates(double dt)
{
  const double mine = exp(-slowest * dt);
  MPI_Allreduce(&mine, &longest, 1, MPI_DOUBLE, MPI_MAX, world);
}

double MPMPoreSuction::take_water(int i, const MPMPoreSoil &soil, double before, double guess,
                                  double more)
{
  if (!soil.retention.can_dry()) return guess;
  content[i] += more;
  if (before >= 0.0 && guess >= 0.0) return guess;
  if (!(content[i] >= -UNDERSHOOT * of[i].full))
    error->one(FLERR, Error::NOLASTLINE,
               "More water flows out of point {} of soil {} than it has: use a smaller time step "
               "(fix mpm/dt), or, where a flux takes water from dry soil, give its suction by "
               "pressure",
               atom->tag[i], soil.material);
  const double filling = content[i] / of[i].full;
  const double now = MPMPoreMoisture::pressure(soil, filling, before, guess, water);
  if (now * soil.retention.alpha > FULLEST && before < 0.0) tell_of_stiff_water(i, soil, now);
  return now;
}

/** Warns, once on each rank that has such a point. */
void MPMPoreSuction::tell_of_stiff_water(int i, const MPMPoreSoil &soil, double p)
{
  if (warned) return;
  warned = true;
  const double alpha = soil.retention.alpha;
  error->warning(
      FLERR,
      "Fix mpm/pore: the water that fills the last pores of point {} of soil {} raises its "
      "pressure to {:.4g} in a step, {:.4g} times 1/alpha of its retention: pressures and "
      "stresses at fronts of water jump, use a smaller bulk modulus of the water, K, of "
      "some {:.2g}, or shorter steps",
      atom->tag[i], soil.material, p, p * alpha, STIFF_ENOUGH / alpha);
}

double MPMPoreSuction::memory_usage() const
{
  double bytes = of.capacity() * sizeof(Point) + wet.capacity.capacity() * sizeof(double);
  for (const auto &nodes : wet.conductance) bytes += nodes.capacity() * sizeof(double);
  return bytes;
}
