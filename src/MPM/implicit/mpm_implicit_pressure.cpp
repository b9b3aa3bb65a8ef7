/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Newton's method for motion and pressure together. With the stiffness K of the soil, the forces Q p of the
   pressure, and the matrix A of the equations of the pressure when nothing moves, corrections of both solve

     K du - Q dp = f,   Q^T du + A dp = g.

   This is solved as a whole: in steps in which pore water first bears nearly all load and then none,
   iterations between the two would converge slowly in one or the other. The solver is GMRES, because flow
   through surfaces makes A unsymmetric. Its preconditioner is a step of the fixed-stress split (J. Kim, H.A.
   Tchelepi, R. Juanes, Comput. Methods Appl. Mech. Eng. 200 (2011) 1591; J.A. White, N. Castelletto, H.A.
   Tchelepi, ibid. 303 (2016) 55): du = K^-1 f, and then dp = (A + a^2/M)^-1 (g - Q^T du), where the modulus M
   of soil that cannot widen stands for Q^T K^-1 Q. K^-1 is a few iterations of the linear solver for the
   motion alone, and the other inverse is by levels, or factors, for one value at each node. The number of
   iterations then depends neither on the stiffness of the water nor on the length of the step.

   The term a^2/M has to be the matrix of sums over points, sum_p V_p N_ip N_jp a^2/M, and not one sum for
   each node: pressures that alternate from node to node are small between nodes (0.13 of the mean square
   along a line, 0.0024 in space), and so is what the soil takes up of them. With one sum for each node, a
   disc of 200 points of nearly incompressible water needed 45 iterations of GMRES for six digits, and a
   sphere did not converge; the disc now needs 8.

   The preconditioner needs a positive definite K, which K need not be: a fixed pressure pushes soil aside
   where the surface of the soil tilts under a load that does not tilt. In the plane, a half-space of soil
   with the shear modulus G and no Poisson's effect stands at most 2 G/3 of such a pressure, and 2 G with
   water that has no time to leave. From the first K on that is not positive definite, the preconditioner uses
   K without the pressures for the rest of the step. Short steps need this after a sudden load of half of the
   soil's modulus.

   Vectors are compared in a norm in which volumes count as much as forces, both relative to what may be left
   of them.
------------------------------------------------------------------------- */

#include "implicit/mpm_implicit_pressure.h"

#include "atom.h"
#include "field/mpm_field.h"
#include "field/mpm_node_pressure.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double INNER = 0.03;      // accuracy of the motion alone in the preconditioner
static constexpr int MOST_INNER = 1000;    // iterations of it
static constexpr int MOST_OUTER = 240;     // iterations for both together
static constexpr double NEGLIGIBLE = 1.0e-3;    // share of all forces
static constexpr int MOST_SHORTER = 5;          // halvings of a correction
// growth of the residual with a correction that is taken all the same
static constexpr double LARGER = 2.0;
// share of the residual left by a solution that is used although it is not as accurate as wanted
static constexpr double GAINED = 0.1;
static constexpr double HELD = 1.0e-6;    // sum of squares that walls take of a unit motion
// share of the tolerance, for pressures relative to stress
static constexpr double SMALL = 1.0e-2;
static constexpr double LEAST = 1.0e-15;               // of volumes: round-off
static constexpr int WHOLE[] = {0, 0, 12000, 8500};    // as in mpm_implicit.cpp

/** The equations of the pressure alone, as the levels see them. */
class MPMImplicit::Joint::Flow : public LinearSystem {
 public:
  explicit Flow(Joint &of) : of(of) {}
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
    add_products(of.motion.grid, 1, n, a, b, 0, mine.data());
    sum_in_order(of.motion.lmp, n, mine.data(), of.of_ranks, value);
  }

 private:
  Joint &of;
  std::vector<double> values;
};

/* ---------------------------------------------------------------------- */

MPMImplicit::Joint::Joint(MPMImplicit &motion, MPMNodePressure &water) :
    motion(motion), water(water),
    levels(motion.field.grid, motion.ranks, 1, stencil_order(motion.field.options.shape), 0,
           WHOLE[motion.width])
{
}

void MPMImplicit::Joint::begin_step()
{
  water.begin_solve(motion.dt, motion.options.time != MPMImplicitOptions::STATIC);
  p = water.values_at_start();
  const std::size_t nmax = motion.lmp->atom->nmax;
  for (auto *list : {&of_points, &dp, &dV}) list->assign(nmax, 0.0);
  for (auto *list : {&left, &correction, &room}) list->assign(p.size(), 0.0);
  none.assign(p.size(), 0.0);
  first.clear();
  prepared = stress_alone = false;
  motion.tangent.keep_without_pressure(false);
  part_left = 0.0;
  motion.tangent.set_pressure(of_points.data());
  find_free_axes();
  double mine[2] = {water.response(), 0.0}, all[2];
  for (const auto &run : motion.field.map->runs)
    for (int i = run.first; i < run.last; i++) mine[1] += motion.lmp->atom->vfrac[i];
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, motion.lmp->world);
  response = all[0];
  volume = all[1];
}

/** In statics, a body that nothing holds along an axis of a periodic box can be anywhere along it. Its
 *  stiffness is singular, and round-off in this motion would be large compared with the rest of a solution. */
void MPMImplicit::Joint::find_free_axes()
{
  free_axes.clear();
  for (int d = 0; d < motion.width && motion.options.time == MPMImplicitOptions::STATIC; d++) {
    std::vector<double> unit(motion.nreals(), 0.0), held;
    for (int64_t k = d; k < motion.nreals(); k += motion.width)
      unit[k] = motion.mass[k / motion.width] > 0.0 ? 1.0 : 0.0;
    held = unit;
    motion.project(held.data());
    for (std::size_t k = 0; k < held.size(); k++) held[k] -= unit[k];
    if (motion.product(held.data(), held.data()) < HELD) free_axes.push_back(unit);
  }
}

void MPMImplicit::Joint::end_step()
{
  water.end_solve(p);
}

/** Removes from a vector these motions, or forces along them, which are only round-off. */
void MPMImplicit::Joint::take_means(double *x)
{
  for (const auto &axis : free_axes) {
    const double *const along = axis.data(), *pairs[] = {along, along}, *of[] = {x, along};
    double sums[2];
    motion.products(2, pairs, of, sums);
    for (int64_t k = 0; k < motion.nreals(); k++) x[k] -= sums[0] / sums[1] * along[k];
  }
}

void MPMImplicit::Joint::set_pressure()
{
  water.to_points(p, of_points.data());
}

double MPMImplicit::Joint::find_residual(const std::vector<double> &u, double forces)
{
  motion.tangent.volume_changes(u.data(), dV.data());
  double mine = water.find_residual(p, dV.data(), left.data());
  MPI_Allreduce(&mine, &carried, 1, MPI_DOUBLE, MPI_SUM, motion.lmp->world);
  const double stress =
      forces * motion.field.lattice.h / (motion.field.step_data().stress_scale * volume);
  round_off = SMALL * motion.options.tolerance * stress * response;
  for (std::size_t k = 0; k < first.size(); k++) left[k] -= part_left * first[k];
  for (std::size_t k = 0; k < left.size(); k++) room[k] = std::sqrt(std::fabs(left[k]));
  const double *const x = room.data();
  Flow(*this).products(1, &x, &x, &sum);
  return sum <= round_off ? 0.0 : sum / carried;
}

/** Sum of volumes that may be left. Where all water is at rest, pressures are noise up to this small part of
 *  the stress. */
double MPMImplicit::Joint::enough() const
{
  return std::max(std::max(motion.options.tolerance, LEAST) * carried, round_off);
}

/** Forces also count as noise relative to those of pressures that carry as much water: where soil is at rest
 *  and without stress, water that comes through its surface is all there is at first. */
double MPMImplicit::Joint::negligible_forces() const
{
  const double pressure = SMALL * motion.options.tolerance * carried / response;
  return response > 0.0
      ? pressure * motion.field.step_data().stress_scale * volume / motion.field.lattice.h
      : 0.0;
}

double MPMImplicit::Joint::excess() const
{
  const double of_forces = motion.now.unbalanced > 0.0 ? motion.now.unbalanced / motion.enough_force
                                                       : 0.0,
               of_volumes = sum > 0.0 ? sum / enough() : 0.0;
  return std::max(of_forces, of_volumes);
}

void MPMImplicit::Joint::move_walls(const std::vector<double> &u, double *forces)
{
  motion.tangent.change_of_forces(u.data(), forces, dp.data(), dV.data());
  water.find_changes(none.data(), dV.data(), room.data());
  for (std::size_t k = 0; k < left.size(); k++) left[k] -= room[k];
}

void MPMImplicit::Joint::move(double s)
{
  for (std::size_t k = 0; k < p.size(); k++) p[k] += s * correction[k];
}

/* ---------------------------------------------------------------------- */

/** Builds the levels of the pressure with the moduli of the first tangents of a step, which serve all of it. */
void MPMImplicit::Joint::prepare()
{
  const Clock timed(motion, PRECONDITIONERS);
  if (prepared) return;
  prepared = true;
  std::vector<double> moduli, diagonal(p.size(), 0.0);
  motion.tangent.find_moduli(moduli);
  water.find_softness(moduli, softness);
  water.each_term(
      softness,
      [&](int n, const int64_t *nodes, int ngrad, const double *gradient, const double *S) {
        for (int i = 0; i < n; i++, gradient += ngrad)
          for (int a = 0; a < ngrad; a++)
            for (int b = 0; b < ngrad; b++)
              diagonal[nodes[i]] += gradient[a] * S[ngrad * a + b] * gradient[b];
      });
  motion.field.nodes.sum(diagonal.data(), 1, 0, 1);
  motion.field.nodes.complete(diagonal.data(), 1, 1);
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

void MPMImplicit::Joint::apply(const double *x, double *y)
{
  const int64_t n = motion.nreals();
  room.assign(x + n, x + size());
  water.to_points(room, dp.data());
  motion.tangent.change_of_forces(x, y, dp.data(), dV.data());
  for (int64_t k = 0; k < n; k++) {
    const double m = motion.mass[k / motion.width];
    y[k] = m > 0.0 ? motion.inertia * m * x[k] - y[k] : 0.0;
  }
  motion.project_forces(y);
  water.find_changes(x + n, dV.data(), y + n);
}

/** The motion by forces at fixed pressures, see the top of this file. */
SolveReport MPMImplicit::Joint::move_alone(const double *forces, double *z, const SolveGoal &goal)
{
  motion.tangent.leave_out_pressure(stress_alone);
  auto solved = motion.solve(forces, z, goal);
  if (solved.outcome == SolveReport::INDEFINITE && !stress_alone) {
    motion.now.linear += solved.iterations;
    stress_alone = true;
    motion.by_levels = false;
    motion.tangent.keep_without_pressure(true);
    motion.tangent.linearize(motion.part_of(*at), motion.part * motion.dt);
    motion.tangent.leave_out_pressure(true);
    solved = motion.solve(forces, z, goal);
  }
  motion.tangent.leave_out_pressure(false);
  return solved;
}

void MPMImplicit::Joint::precondition(const double *r, double *z)
{
  const int64_t n = motion.nreals();
  SolveGoal goal;
  goal.relative = INNER;
  goal.absolute = NEGLIGIBLE * std::sqrt(product(r, r));    // relative to volumes
  goal.most_iterations = (int) std::min<int64_t>(motion.options.most_linear, MOST_INNER);
  std::vector<double> forces(r, r + n);
  take_means(forces.data());
  const auto solved = move_alone(forces.data(), z, goal);
  motion.now.linear += solved.iterations;
  take_means(z);
  std::fill(dp.begin(), dp.end(), 0.0);
  motion.tangent.change_of_forces(z, rhs.data(), dp.data(), dV.data());
  water.find_changes(none.data(), dV.data(), room.data());
  const auto &capacity = water.capacities();
  for (std::size_t k = 0; k < room.size(); k++) room[k] = r[n + k] - room[k];
  levels.precondition(room.data(), z + n);
  for (std::size_t k = 0; k < room.size(); k++)
    if (!(capacity[k] > 0.0)) z[n + k] = 0.0;
  motion.field.nodes.complete(z + n, 1, 1);
}

void MPMImplicit::Joint::products(int n, const double *const *a, const double *const *b,
                                  double *value)
{
  std::vector<double> forces(n, 0.0), volumes(n, 0.0);
  add_products(motion.grid, motion.width, n, a, b, 0, forces.data());
  add_products(motion.grid, 1, n, a, b, motion.nreals(), volumes.data());
  for (int k = 0; k < n; k++) forces[k] += weight * weight * volumes[k];
  sum_in_order(motion.lmp, n, forces.data(), of_ranks, value);
}

SolveReport MPMImplicit::Joint::solve(const std::vector<double> &u, const SolveGoal &goal)
{
  const Clock timed(motion, SYSTEMS);
  const int64_t n = motion.nreals();
  at = &u;
  prepare();
  weight = enough() > 0.0 && motion.enough_force > 0.0 ? motion.enough_force / enough() : 1.0;
  rhs.resize(size());
  std::vector<double> b(size());
  std::copy_n(motion.free.data(), n, b.data());
  std::copy(left.begin(), left.end(), b.begin() + n);
  solution.assign(size(), 0.0);
  SolveGoal mine = goal;
  mine.most_iterations = std::min(goal.most_iterations, MOST_OUTER);
  auto solved = solver.solve(*this, b.data(), solution.data(), mine);
  // Newton's method goes on with what was gained
  if (solved.outcome == SolveReport::TOO_MANY &&
      solved.residuals.back() < GAINED * solved.residuals.front())
    solved.outcome = SolveReport::CONVERGED;
  std::copy_n(solution.data(), n, motion.change.data());
  correction.assign(solution.begin() + n, solution.end());
  return solved;
}

double MPMImplicit::Joint::memory_usage() const
{
  double bytes = solver.memory_usage() + levels.memory_usage();
  for (const auto *list : {&p, &kept, &left, &first, &correction, &rhs, &solution, &softness, &room,
                           &none, &of_points, &dp, &dV})
    bytes += list->capacity() * sizeof(double);
  return bytes;
}

/* ----------------------------------------------------------------------
   u and p <- u + s du, p + s dp. Motion and pressure have no common energy with a minimum, so the residual
   has to decrease. Where it does not for any share s, because soil yields, the share that leaves least is
   taken if this is not much more than before.
------------------------------------------------------------------------- */

bool MPMImplicit::search_jointly(std::vector<double> &u, double &size)
{
  const std::vector<double> du = change;
  const double before = joint->excess();
  double best = 0.0, best_part = 0.0, at = 0.0;
  const auto go_to = [&](double s) {
    for (int64_t k = 0; k < nreals(); k++) trial[k] = u[k] + s * du[k];
    joint->move(s - at);
    at = s;
    return find_residual(trial, size);
  };
  double s = 1.0;
  for (int cut = 0; cut <= MOST_SHORTER; cut++, now.cuts++, s *= 0.5) {
    if (!go_to(s)) continue;
    const double left = joint->excess();
    if (best_part == 0.0 || left < best) {
      best = left;
      best_part = s;
    }
    if (left < before) {
      u = trial;
      return true;
    }
  }
  if (best_part > 0.0 && best < LARGER * before && go_to(best_part)) {
    u = trial;
    return true;
  }
  now.failure = "no part of the last correction leaves less of forces and volumes";
  return false;
}
