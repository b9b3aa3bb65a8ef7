/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Soil (velocity v, acceleration a) and pore water (velocity v + w/n) as one set of points (u-v-p;
   O.C. Zienkiewicz, T. Shiomi, Int. J. Numer. Anal. Methods Geomech. 8 (1984) 71, without
   convective terms). With the density rho of both and R the resistance to the flow w,

     rho a + rho_f dw/dt = div(sigma' - alpha p I) + rho g
     rho_f/n dw/dt       = - grad p + rho_f (g - a) - R w
     S dp/dt             = - alpha div v - div w

   Unknowns are the velocity of the soil on nodes, the pressure on nodes (mpm_pore.cpp), and w in
   points: walls need no boundary condition for it, points do not lose w to the lattice in
   transfers, and where drag dominates, the equations on nodes become those of u-p.

   Drag. In a step with the duration t everything except w is constant, and w is integrated exactly:
   with the rate of drag r = n R/rho_f and the mean f = (1 - exp(-r t))/(r t) of its decay,

     w' = w + t f n (A - a),    A = g - (grad p + R w)/rho_f.

   That is a decaying difference without acceleration, and Darcy's law where r t is large, so that
   drag does not limit the step: leapfrog of waves with this factor is stable up to 2/omega of the
   waves without drag (f < (1 + exp(-r t))/2).

   Inertia. A point gives rho_f V dw/dt = mu (A - a) to the water, where mu = f n rho_f V is the
   mass that moves by itself. On nodes, with sums of mu_p N_ip as with masses,

     (m_i - mu_i) a_i = F_i - sum_p mu_p N_ip A_p,    a_p = sum_i N_ip a_i,

   so that both unknowns are solved at once, node by node. Walls and contact act on the mass m_i -
   mu_i of the node. Momentum is kept to round-off. The inverse of the mass matrix, (1/s, -N^T/s;
   -N/s, n/(rho_f V) + N N^T/s) with s = m_i - mu_i, is symmetric and positive, as soil is heavier
   than its water: waves have an energy which this integration keeps bounded.

   Surface. Where the pressure p_s outside is given, the flow out of an area A with the normal m is
   that of the points next to it, Q = A m . <w>. With the same weights c_p of this mean, the
   remaining pressure difference drives these points by A m c_p (p - p_s)/V_p in addition to - grad
   p. One pressure makes no flow: one that rises to the surface with just the gradient that balances
   its own push, for which nodes beyond the surface leave room. So the flow that p - p_s would make
   from rest in a step is added. A linear pressure is a solution, and the resistance bounds every
   flow.

   A resistance that depends on w (Forchheimer) is taken at the flow w* that an implicit step would
   leave, |w*| (1 + t n/rho_f (R_0 + R_1 |w*|)) = |w + t n/rho_f (rho_f g - grad p)|: steady flow is
   exact.
------------------------------------------------------------------------- */

#include "pore/mpm_pore_motion.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "field/mpm_block_passes.h"
#include "field/mpm_field.h"
#include "force.h"
#include "math/matrix.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int WIDTH = 8;    // reals of a node in sums over points

MPMPoreMotion::MPMPoreMotion(LAMMPS *lmp, MPMField &field, double density, const double *gravity) :
    Pointers(lmp), field(field), density(density), gravity(gravity)
{
}

/** Acceleration of free water per gradient of pressure. */
double MPMPoreMotion::acceleration() const
{
  return force->ftm2v / (force->nktv2p * density);
}

/** Rate of drag times the time step. */
double MPMPoreMotion::fading(const Pores &pores, double resistance) const
{
  return pores.porosity * resistance * acceleration() * field.step_dt();
}

void MPMPoreMotion::begin_step(const MPMRows &of_points)
{
  flow = of_points;
  clear_points(share, atom);
  clear_points(lead, atom, 3);
}

void MPMPoreMotion::set_gradient(int i, const double *gradient)
{
  for (int d = 0; d < field.lattice.dim; d++) lead[3 * (std::size_t) i + d] = gradient[d];
}

double MPMPoreMotion::response(int i, const Pores &pores) const
{
  double square = 0.0;
  for (int d = 0; d < field.lattice.dim; d++) square += flow[i][d] * flow[i][d];
  const double resistance = pores.resistance + pores.quadratic * sqrt(square) / pores.J;
  return std::isfinite(resistance) ? -expm1(-fading(pores, resistance)) / resistance : 0.0;
}

/** Interpolates vectors of nodes, the first reals of each, to field.work.vectors of points. */
void MPMPoreMotion::to_points(std::vector<double> &of_nodes, const Wanted &wanted)
{
  field.nodes.complete(of_nodes.data(), WIDTH, field.lattice.dim);
  auto &values = field.work.vectors, &weights = field.work.weights;
  values.resize(3 * (std::size_t) atom->nmax);
  weights.resize(std::max(weights.size(), (std::size_t) atom->nmax));
  const PointRows rows = field.rows_at_rest(values.data(), weights.data());
  const TransferStep step = field.step_data(0.0);
  points_from(
      of_nodes.data(), field, field.pic,
      [&](int slot) {
        return !wanted || wanted(slot);
      },
      [&](const MPMPointMap::Run &run, const int *base) {
        field.pic.g2p(rows, step, run.first, run.last, base, field.map->tile_load, nullptr);
      });
}

void MPMPoreMotion::add_gradients(std::vector<double> &of_nodes, const Wanted &wanted)
{
  to_points(of_nodes, wanted);
  each_point(field, [&](const auto &run, int i) {
    if (!wanted(run.slot)) return;
    for (int d = 0; d < 3; d++) {
      const std::size_t k = 3 * (std::size_t) i + d;
      lead[k] += field.work.vectors[k];
    }
  });
}

void MPMPoreMotion::begin_point(int i, const Pores &pores, const MPMPoreResistance *r,
                                const double *normal)
{
  const int dim = field.lattice.dim;
  double *const mine = &lead[3 * (std::size_t) i];
  if (!std::isfinite(pores.resistance)) {    // nothing flows
    std::fill_n(mine, 3, 0.0);
    return;
  }
  const double unit = acceleration(), gain = pores.porosity * field.step_dt();
  double w[3] = {0.0, 0.0, 0.0}, free[3] = {0.0, 0.0, 0.0}, resistance = pores.resistance;
  for (int d = 0; d < dim; d++) {
    w[d] = flow[i][d] / pores.J;
    free[d] = force->ftm2v * gravity[d] - unit * mine[d];
  }
  if (r) {
    begin_at_interface(i, pores, *r, normal, w, free);
    return;
  }
  if (pores.quadratic > 0.0) {
    double square = 0.0;
    for (int d = 0; d < dim; d++) square += (w[d] + gain * free[d]) * (w[d] + gain * free[d]);
    const double a = 1.0 + gain * unit * resistance, b = gain * unit * pores.quadratic;
    const double pushed = sqrt(square);
    resistance += pores.quadratic * 2.0 * pushed / (a + sqrt(a * a + 4.0 * b * pushed));
  }
  const double x = fading(pores, resistance);
  share[i] = mean_decay(x) * pores.porosity * density * pores.volume;
  for (int d = 0; d < dim; d++) mine[d] = free[d] - unit * resistance * w[d];
}

/** Starts the step of w at an interface. Drag differs across and along the interface, and so does
 *  the mean of its decay; the stronger drag determines the effect of the acceleration of the soil
 *  on the flow in both directions. */
void MPMPoreMotion::begin_at_interface(int i, const Pores &pores, const MPMPoreResistance &r,
                                       const double *normal, const double *w, const double *free)
{
  double *const mine = &lead[3 * (std::size_t) i];
  const double unit = acceleration(), gain = pores.porosity * field.step_dt();
  double pushed[3], parts[2][3], of_flow[2][3], push[2];
  for (int d = 0; d < 3; d++) pushed[d] = w[d] + gain * free[d];
  const double across = dot(pushed, normal), flow_across = dot(w, normal);
  for (int d = 0; d < 3; d++) {
    parts[0][d] = dot(free, normal) * normal[d];
    parts[1][d] = free[d] - parts[0][d];
    of_flow[0][d] = flow_across * normal[d];
    of_flow[1][d] = w[d] - of_flow[0][d];
  }
  push[0] = fabs(across) / (gain * unit);
  push[1] = sqrt(std::max(0.0, dot(pushed, pushed) - across * across)) / (gain * unit);
  const double flows = r.flow(push, 1.0 / (gain * unit));
  double mean[2];
  for (int k = 0; k < 2; k++) mean[k] = mean_decay(fading(pores, r.at(k, flows)));
  const double least = std::min(mean[0], mean[1]);
  share[i] = least * pores.porosity * density * pores.volume;
  for (int d = 0; d < 3; d++) {
    mine[d] = 0.0;
    for (int k = 0; k < 2; k++)
      mine[d] += mean[k] / least * (parts[k][d] - unit * r.at(k, flows) * of_flow[k][d]);
  }
}

/** Sums over points to [node][8]: weight times vector, 0, and weight, from weigh(i, weight,
 *  vector) */
template <class Weigh>
void MPMPoreMotion::sum(std::vector<double> &to, const Wanted &wanted, const Weigh &weigh)
{
  auto &values = field.work.vectors, &weights = field.work.weights;
  values.resize(3 * (std::size_t) atom->nmax);
  weights.resize(std::max(weights.size(), (std::size_t) atom->nmax));
  const PointRows rows = field.rows_at_rest(values.data(), weights.data());
  const TransferStep step = field.step_data(0.0);
  points_to(to, field, field.pic, [&](const MPMPointMap::Run &run, const int *base, int *box) {
    if (wanted && !wanted(run.slot)) return;
    for (int i = run.first; i < run.last; i++) weigh(i, weights[i], &values[3 * (std::size_t) i]);
    field.pic.p2g_momentum(rows, step, run.first, run.last, base, field.map->tile, box);
  });
  field.nodes.sum(to.data(), WIDTH, 0, 4);
}

void MPMPoreMotion::separate()
{
  sum(nodes, nullptr, [&](int i, double &weight, double *vector) {
    weight = share[i];
    for (int d = 0; d < 3; d++) vector[d] = lead[3 * (std::size_t) i + d];
  });
  Grid &grid = field.grid;
  for (int64_t n = 0; n < grid.nnodes(); n++) {
    const double *const mine = &nodes[WIDTH * n];
    double *const record = grid.record(n);
    if (!(mine[3] > 0.0 && record[3] > 0.0)) continue;
    const double left = 1.0 - mine[3] / record[3];
    for (int d = 0; d < 3; d++) {
      record[d] *= left;
      record[4 + d] -= mine[d];
    }
    record[3] -= mine[3];
  }
}

/** Includes the ledger, which has seen nodes without the mass that moves by itself: for the soil,
 *  the inertia of the water is a force, whose work is like that of the pressure. */
void MPMPoreMotion::move()
{
  const int dim = field.lattice.dim;
  const double dt = field.step_dt();
  Grid &grid = field.grid;
  change.assign(WIDTH * grid.nnodes(), 0.0);
  double work = 0.0, kinetic = 0.0;
  for (int64_t n = 0; n < grid.nnodes(); n++) {
    const double *const mine = &nodes[WIDTH * n];
    double *const record = grid.record(n), *const a = &change[WIDTH * n];
    for (int d = 0; d < dim; d++) a[d] = (record[d] - record[4 + d]) / dt;
    if (!(mine[3] > 0.0 && record[3] > 0.0)) continue;
    record[3] += mine[3];
    if (!field.ledger.on || !grid.owns(n)) continue;
    for (int d = 0; d < dim; d++) {
      work += (mine[3] * a[d] - mine[d]) * 0.5 * (record[d] + record[4 + d]) * dt;
      kinetic += 0.5 * mine[3] * (record[d] * record[d] - record[4 + d] * record[4 + d]);
    }
  }
  field.ledger.internal -= work * force->mvv2e;
  field.ledger.transfer -= kinetic * force->mvv2e;
  field.ledger.count_at_points();

  to_points(change, nullptr);
  const auto &values = field.work.vectors;
  each_point(field, [&](const auto &, int i) {
    const double gain = share[i] * dt / (density * atom->vfrac[i]);
    for (int d = 0; d < dim; d++) {
      const std::size_t k = 3 * (std::size_t) i + d;
      flow[i][d] += gain * (lead[k] - values[k]);
    }
  });
}

void MPMPoreMotion::discharge(int i, double *q) const
{
  for (int d = 0; d < field.lattice.dim; d++) q[d] = atom->vfrac[i] * flow[i][d];
}

void MPMPoreMotion::flow_at_nodes(const Wanted &wanted, std::vector<double> &of_nodes)
{
  sum(of_nodes, wanted, [&](int i, double &weight, double *vector) {
    weight = atom->vfrac[i];
    std::fill_n(vector, 3, 0.0);
    for (int d = 0; d < field.lattice.dim; d++) vector[d] = flow[i][d];
  });
  field.nodes.complete(of_nodes.data(), WIDTH, 4);
}

/** From c^2 of A x = c^2 B x with the stiffness A = (E + alpha^2/S, alpha/S; alpha/S, 1/S) and the
 *  inertia B = (rho, rho_f; rho_f, rho_f/n) */
double MPMPoreMotion::wave_speed(double c, double of_both, double biot, double storage,
                                 double porosity) const
{
  const double unit = force->mvv2e * force->nktv2p, rho = unit * of_both, rhof = unit * density;
  const double E = rho * c * c;
  const double square = rho * rhof / porosity - rhof * rhof;
  const double linear =
      (E + biot * biot / storage) * rhof / porosity + (rho - 2.0 * rhof * biot) / storage;
  const double root = sqrt(std::max(0.0, linear * linear - 4.0 * square * E / storage));
  return sqrt((linear + root) / (2.0 * square));
}

double MPMPoreMotion::memory_usage() const
{
  double bytes = 0.0;
  for (const auto *list : {&share, &lead, &nodes, &change})
    bytes += list->capacity() * sizeof(double);
  return bytes;
}
