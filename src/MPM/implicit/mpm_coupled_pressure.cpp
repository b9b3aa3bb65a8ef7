/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Newton's method for motion and pressure together. With the stiffness K of the soil, the forces Q
   p of the pressure, and the matrix A of the equations of the pressure when nothing moves,
   corrections of both solve

     K du - Q dp = f,   Q^T du + A dp = g.

   This is solved as a whole: in steps in which pore water first bears nearly all load and then
   none, iterations between the two would converge slowly in one or the other. The solver is
   GMRES, because flow through surfaces makes A unsymmetric. Its preconditioner is a step of the
   fixed-stress split (J. Kim, H.A. Tchelepi, R. Juanes, Comput. Methods Appl. Mech. Eng. 200 (2011)
   1591; J.A. White, N. Castelletto, H.A. Tchelepi, ibid. 303 (2016) 55): du = K^-1 f, and then dp =
   (A + a^2/M)^-1 (g - Q^T du), where the modulus M of soil that cannot widen stands for Q^T K^-1 Q.
   K^-1 is a few iterations of the linear solver for the motion alone, and the other inverse is by
   levels, or factors, for one value at each node. The number of iterations then depends neither on
   the stiffness of the water nor on the length of the step.

   The term a^2/M has to be the matrix of sums over points, sum_p V_p N_ip N_jp a^2/M, and not one
   sum for each node: pressures that alternate from node to node are small between nodes (0.13 of
   the mean square along a line, 0.0024 in space), and so is what the soil takes up of them. With
   one sum for each node, a disc of 200 points of nearly incompressible water needed 45 iterations
   of GMRES for six digits, and a sphere did not converge; the disc now needs 8.

   The preconditioner needs a positive definite K, which K need not be: a fixed pressure pushes soil
   aside where the surface of the soil tilts under a load that does not tilt. In the plane, a
   half-space of soil with the shear modulus G and no Poisson's effect stands at most 2 G/3 of such
   a pressure, and 2 G with water that has no time to leave. From the first K on that is not
   positive definite, the preconditioner uses K without the pressures for the rest of the step.
   Short steps need this after a sudden load of half of the soil's modulus.

   Vectors are compared in a norm in which volumes count as much as forces, both relative to what
   may be left of them.
------------------------------------------------------------------------- */

#include "implicit/mpm_coupled_pressure.h"

#include "atom.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_node_system.h"
#include "implicit/mpm_constraints.h"
#include "implicit/mpm_force_balance.h"
#include "implicit/mpm_motion_system.h"
#include "implicit/mpm_solved_nodes.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

using Clock = MPMImplicitTimes::Clock;

static constexpr double INNER = 0.03;      // accuracy of the motion alone in the preconditioner
static constexpr int MOST_INNER = 1000;    // iterations of it
static constexpr int MOST_OUTER = 240;     // iterations for both together
static constexpr double NEGLIGIBLE = 1.0e-3;    // share of all forces
// share of the residual left by a solution that is used although it is not as accurate as wanted
static constexpr double GAINED = 0.1;
static constexpr double HELD = 1.0e-6;    // sum of squares that walls take of a unit motion
// share of the tolerance, for pressures relative to stress
static constexpr double SMALL = 1.0e-2;
static constexpr double LEAST = 1.0e-15;               // of volumes: round-off
static constexpr int WHOLE[] = {0, 0, 12000, 8500};    // as in mpm_motion_system.cpp

/** The equations of the pressure alone, as the levels see them. */
class MPMCoupledPressure::Flow : public LinearSystem {
 public:
  explicit Flow(MPMCoupledPressure &of) : of(of) {}
  int64_t size() const override { return (int64_t) of.p.size(); }
  void apply(const double *x, double *y) override
  {
    values.assign(x, x + of.p.size());
    of.water.to_points(values, of.dp.data());
    for (std::size_t i = 0; i < of.dV.size(); i++) of.dV[i] = of.softness[i] * of.dp[i];
    of.water.find_changes(x, of.dV.data(), y);
  }
  void products(int n, const double *const *a, const double *const *b, double *value) override
  {
    std::vector<double> mine(n, 0.0);
    add_products(of.nodes.field.grid, 1, n, a, b, 0, mine.data());
    of.nodes.sum_in_order(n, mine.data(), value);
  }

 private:
  MPMCoupledPressure &of;
  std::vector<double> values;
};

/* ---------------------------------------------------------------------- */

MPMCoupledPressure::MPMCoupledPressure(MPMSolvedNodes &nodes, MPMForceBalance &balance,
                                       MPMConstraints &constraints, MPMMotionSystem &motion,
                                       const MPMImplicitOptions &options, MPMImplicitReport &report,
                                       MPMImplicitTimes &times, MPMNodePressure &water) :
    nodes(nodes),
    balance(balance), constraints(constraints), motion(motion), options(options), report(report),
    times(times), water(water), tangent(balance.tangent()),
    levels(nodes.field.grid, motion.lattice_ranks(), 1, stencil_order(nodes.field.options.shape), 0,
           WHOLE[nodes.width])
{
}

int64_t MPMCoupledPressure::nreals() const
{
  return nodes.nreals();
}

void MPMCoupledPressure::begin_step(double dt)
{
  water.begin_solve(dt, !options.time.is_static());
  p = water.values_at_start();
  const std::size_t nmax = nodes.lmp->atom->nmax;
  for (auto *list : {&point_pressure, &dp, &dV}) list->assign(nmax, 0.0);
  for (auto *list : {&unbalanced, &correction, &room}) list->assign(p.size(), 0.0);
  no_pressure.assign(p.size(), 0.0);
  first.clear();
  prepared = without_pressure = false;
  tangent.keep_without_pressure(false);
  part_left = 0.0;
  tangent.set_pressure(point_pressure.data());
  find_free_axes();
  double mine[2] = {water.response(), 0.0}, all[2];
  for (const auto &run : nodes.field.map->runs)
    for (int i = run.first; i < run.last; i++) mine[1] += nodes.lmp->atom->vfrac[i];
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, nodes.lmp->world);
  response = all[0];
  volume = all[1];
}

/** In statics, a body that nothing holds along an axis of a periodic box can be anywhere along it.
 *  Its stiffness is singular, and round-off in this motion would be large compared with the rest of
 *  a solution. */
void MPMCoupledPressure::find_free_axes()
{
  free_axes.clear();
  for (int d = 0; d < nodes.width && options.time.is_static(); d++) {
    std::vector<double> unit(nreals(), 0.0), held;
    for (int64_t k = d; k < nreals(); k += nodes.width)
      unit[k] = nodes.mass[k / nodes.width] > 0.0 ? 1.0 : 0.0;
    held = unit;
    constraints.project(held.data());
    for (std::size_t k = 0; k < held.size(); k++) held[k] -= unit[k];
    if (nodes.product(held.data(), held.data()) < HELD) free_axes.push_back(unit);
  }
}

void MPMCoupledPressure::end_step()
{
  water.end_solve(p);
}

/** Removes from a vector these motions, or forces along them, which are only round-off. */
void MPMCoupledPressure::remove_free_motions(double *x)
{
  for (const auto &axis : free_axes) {
    const double *const along = axis.data(), *pairs[] = {along, along}, *of[] = {x, along};
    double sums[2];
    nodes.products(2, pairs, of, sums);
    for (int64_t k = 0; k < nreals(); k++) x[k] -= sums[0] / sums[1] * along[k];
  }
}

void MPMCoupledPressure::set_pressure()
{
  water.to_points(p, point_pressure.data());
}

double MPMCoupledPressure::find_residual(const std::vector<double> &u, double forces)
{
  tangent.volume_changes(u.data(), dV.data());
  double mine = water.find_residual(p, dV.data(), unbalanced.data());
  MPI_Allreduce(&mine, &carried, 1, MPI_DOUBLE, MPI_SUM, nodes.lmp->world);
  const double stress =
      forces * nodes.field.lattice.h / (nodes.field.step_data().stress_scale * volume);
  round_off = SMALL * options.tolerance * stress * response;
  for (std::size_t k = 0; k < first.size(); k++) unbalanced[k] -= part_left * first[k];
  for (std::size_t k = 0; k < unbalanced.size(); k++) room[k] = std::sqrt(std::fabs(unbalanced[k]));
  const double *const x = room.data();
  Flow(*this).products(1, &x, &x, &sum);
  return sum <= round_off ? 0.0 : sum / carried;
}

/** Sum of volumes that may be unbalanced. Where all water is at rest, pressures are noise up to
 *  this small part of the stress. */
double MPMCoupledPressure::enough() const
{
  return std::max(std::max(options.tolerance, LEAST) * carried, round_off);
}

/** Forces also count as noise relative to those of pressures that carry as much water: where soil
 *  is at rest and without stress, water that comes through its surface is all there is at first. */
double MPMCoupledPressure::negligible_forces() const
{
  const double pressure = SMALL * options.tolerance * carried / response;
  return response > 0.0
      ? pressure * nodes.field.step_data().stress_scale * volume / nodes.field.lattice.h
      : 0.0;
}

double MPMCoupledPressure::excess() const
{
  const double of_forces = report.unbalanced > 0.0 ? report.unbalanced / enough_force : 0.0,
               of_volumes = sum > 0.0 ? sum / enough() : 0.0;
  return std::max(of_forces, of_volumes);
}

void MPMCoupledPressure::move_walls(const std::vector<double> &u, double *forces)
{
  tangent.change_of_forces(u.data(), forces, dp.data(), dV.data());
  water.find_changes(no_pressure.data(), dV.data(), room.data());
  for (std::size_t k = 0; k < unbalanced.size(); k++) unbalanced[k] -= room[k];
}

void MPMCoupledPressure::move(double s)
{
  for (std::size_t k = 0; k < p.size(); k++) p[k] += s * correction[k];
}

/* ---------------------------------------------------------------------- */

/** Builds the levels of the pressure with the moduli of the first tangents of a step, which serve
 *  all of it. */
void MPMCoupledPressure::prepare()
{
  const Clock timed(times, MPMImplicitTimes::PRECONDITIONERS);
  if (prepared) return;
  prepared = true;
  std::vector<double> moduli, diagonal(p.size(), 0.0);
  tangent.find_moduli(moduli);
  water.find_softness(moduli, softness);
  water.each_term(
      softness,
      [&](int n, const int64_t *nodes, int ngrad, const double *gradient, const double *S) {
        for (int i = 0; i < n; i++, gradient += ngrad)
          for (int a = 0; a < ngrad; a++)
            for (int b = 0; b < ngrad; b++)
              diagonal[nodes[i]] += gradient[a] * S[ngrad * a + b] * gradient[b];
      });
  nodes.field.nodes.sum(diagonal.data(), 1, 0, 1);
  nodes.field.nodes.complete(diagonal.data(), 1, 1);
  const auto &capacity = water.capacities();
  for (std::size_t k = 0; k < p.size(); k++)
    diagonal[k] = capacity[k] > 0.0 ? diagonal[k] + capacity[k] : 0.0;
  levels.begin(nullptr, diagonal.data());
  water.each_term(
      softness,
      [&](int n, const int64_t *nodes, int ngrad, const double *gradient, const double *S) {
        levels.add_point(n, nodes, ngrad, gradient, S);
      });
  Flow flow(*this);
  levels.finish(flow, capacity.data());
}

void MPMCoupledPressure::apply(const double *x, double *y)
{
  const int64_t n = nreals();
  room.assign(x + n, x + size());
  water.to_points(room, dp.data());
  tangent.change_of_forces(x, y, dp.data(), dV.data());
  for (int64_t k = 0; k < n; k++) {
    const double m = nodes.mass[k / nodes.width];
    y[k] = m > 0.0 ? balance.inertia_per_mass() * m * x[k] - y[k] : 0.0;
  }
  constraints.project_forces(y);
  water.find_changes(x + n, dV.data(), y + n);
}

/** The motion by forces at fixed pressures, see the top of this file. */
SolveReport MPMCoupledPressure::solve_motion(const double *forces, double *z, const SolveGoal &goal)
{
  tangent.leave_out_pressure(without_pressure);
  auto solved = motion.solve(forces, z, goal);
  if (solved.outcome == SolveReport::INDEFINITE && !without_pressure) {
    report.linear += solved.iterations;
    without_pressure = true;
    motion.use_levels(false);
    tangent.keep_without_pressure(true);
    tangent.linearize(balance.scaled(*at), balance.time_of_forces());
    tangent.leave_out_pressure(true);
    solved = motion.solve(forces, z, goal);
  }
  tangent.leave_out_pressure(false);
  return solved;
}

void MPMCoupledPressure::precondition(const double *r, double *z)
{
  const int64_t n = nreals();
  SolveGoal goal;
  goal.relative = INNER;
  goal.absolute = NEGLIGIBLE * std::sqrt(product(r, r));    // relative to volumes
  goal.most_iterations = (int) std::min<int64_t>(options.most_linear, MOST_INNER);
  std::vector<double> forces(r, r + n);
  remove_free_motions(forces.data());
  const auto solved = solve_motion(forces.data(), z, goal);
  report.linear += solved.iterations;
  remove_free_motions(z);
  std::fill(dp.begin(), dp.end(), 0.0);
  tangent.change_of_forces(z, rhs.data(), dp.data(), dV.data());
  water.find_changes(no_pressure.data(), dV.data(), room.data());
  const auto &capacity = water.capacities();
  for (std::size_t k = 0; k < room.size(); k++) room[k] = r[n + k] - room[k];
  levels.precondition(room.data(), z + n);
  for (std::size_t k = 0; k < room.size(); k++)
    if (!(capacity[k] > 0.0)) z[n + k] = 0.0;
  nodes.field.nodes.complete(z + n, 1, 1);
}

void MPMCoupledPressure::products(int n, const double *const *a, const double *const *b,
                                  double *value)
{
  std::vector<double> forces(n, 0.0), volumes(n, 0.0);
  add_products(nodes.field.grid, nodes.width, n, a, b, 0, forces.data());
  add_products(nodes.field.grid, 1, n, a, b, nreals(), volumes.data());
  for (int k = 0; k < n; k++) forces[k] += weight * weight * volumes[k];
  nodes.sum_in_order(n, forces.data(), value);
}

SolveReport MPMCoupledPressure::solve(const std::vector<double> &u,
                                      const std::vector<double> &forces, std::vector<double> &du,
                                      const SolveGoal &goal)
{
  const Clock timed(times, MPMImplicitTimes::SYSTEMS);
  const int64_t n = nreals();
  at = &u;
  prepare();
  weight = enough() > 0.0 && enough_force > 0.0 ? enough_force / enough() : 1.0;
  rhs.resize(size());
  std::vector<double> b(size());
  std::copy_n(forces.data(), n, b.data());
  std::copy(unbalanced.begin(), unbalanced.end(), b.begin() + n);
  solution.assign(size(), 0.0);
  SolveGoal mine = goal;
  mine.most_iterations = std::min(goal.most_iterations, MOST_OUTER);
  auto solved = solver.solve(*this, b.data(), solution.data(), mine);
  // Newton's method goes on with what was gained
  if (solved.outcome == SolveReport::TOO_MANY &&
      solved.residuals.back() < GAINED * solved.residuals.front())
    solved.outcome = SolveReport::CONVERGED;
  std::copy_n(solution.data(), n, du.data());
  correction.assign(solution.begin() + n, solution.end());
  return solved;
}

double MPMCoupledPressure::memory_usage() const
{
  double bytes = solver.memory_usage() + levels.memory_usage();
  for (const auto *list : {&p, &kept, &unbalanced, &first, &correction, &rhs, &solution, &softness,
                           &room, &no_pressure, &point_pressure, &dp, &dV})
    bytes += list->capacity() * sizeof(double);
  return bytes;
}
