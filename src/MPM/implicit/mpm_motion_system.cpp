/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/mpm_motion_system.h"

#include "implicit/mpm_constraints.h"
#include "implicit/mpm_force_balance.h"
#include "implicit/mpm_solved_nodes.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

using Clock = MPMImplicitTimes::Clock;

static constexpr double PROJECTED = 1.0e-12;    // entries of projections that are not round-off
// iterations in which GMRES must gain something, and share of the residual that may be left
static constexpr int TURN = 1000;
static constexpr double GAIN = 0.9;
// iterations up to which levels are kept for the next tangents
static constexpr int DO_WELL = 15;
static constexpr int TOO_OLD = 300;    // iterations with old levels, after which new ones are tried
// as MPMMotionSystem::WHOLE, with averages of the pressure, for which levels need many iterations
static constexpr int WHOLE_WITH_AVERAGES[] = {0, 0, 60000, 15000};

MPMMotionSystem::MPMMotionSystem(const MPMImplicitParts &parts) :
    MPMImplicitParts(parts), ranks(nodes.lmp, nodes.field.grid, *nodes.field.nodes.halo),
    averages(nodes.field.options.averages_stress())
{
  if (options.preconditioner == MPMImplicitOptions::MULTIGRID)
    multigrid = std::make_unique<SplineMultigrid>(
        nodes.field.grid, ranks, nodes.width, stencil_order(nodes.field.options.shape), 0,
        (averages ? WHOLE_WITH_AVERAGES : WHOLE)[nodes.width]);
}

void MPMMotionSystem::apply(const double *x, double *y)
{
  // levels know what walls leave free only node by node: their vectors are not quite in the range
  // of P
  if (by_levels) {
    allowed.assign(x, x + nodes.nreals());
    constraints.project(allowed.data());
    x = allowed.data();
  }
  balance.apply(x, y);
  constraints.subtract_friction_change(x, report.asymmetry, y);
  constraints.project_forces(y);
}

void MPMMotionSystem::precondition(const double *r, double *z)
{
  if (by_levels) {
    multigrid->precondition(r, z);
    // nodes that are left alone have a stiffness but no mass
    for (int64_t k = 0; nodes.has_unreached() && k < nodes.nreals(); k++)
      if (!(nodes.mass[k / nodes.width] > 0.0)) z[k] = 0.0;
    constraints.project(z);
    return;
  }
  const int width = nodes.width;
  std::fill_n(z, nodes.nreals(), 0.0);
  nodes.each_entry([&](int64_t n, int64_t k) {
    const double *const row = &blocks[width * k];
    double sum = 0.0;
    for (int b = 0; b < width; b++) sum += row[b] * r[width * n + b];
    z[k] = sum;
  });
  constraints.project(z);
}

/** Inverts a symmetric matrix in place, by its Cholesky factors or, where it has none, by its
 *  diagonal. */
static void invert(int n, double *A)
{
  double L[3][3] = {{0.0}}, inverse[3][3] = {{0.0}};
  bool good = true;
  for (int i = 0; i < n && good; i++)
    for (int j = 0; j <= i && good; j++) {
      double sum = 0.5 * (A[n * i + j] + A[n * j + i]);
      for (int k = 0; k < j; k++) sum -= L[i][k] * L[j][k];
      if (i == j) good = sum > 1.0e-12 * A[n * i + i] && A[n * i + i] > 0.0;
      if (good) L[i][j] = i == j ? std::sqrt(sum) : sum / L[j][j];
    }
  if (!good) {
    double most = 0.0;
    for (int i = 0; i < n; i++) most = std::max(most, std::fabs(A[n * i + i]));
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++)
        A[n * i + j] =
            i != j || most == 0.0 ? 0.0 : 1.0 / std::max(std::fabs(A[n * i + i]), 1.0e-6 * most);
    return;
  }
  for (int c = 0; c < n; c++)
    for (int i = c; i < n; i++) {
      double sum = i == c;
      for (int k = c; k < i; k++) sum -= L[i][k] * inverse[k][c];
      inverse[i][c] = sum / L[i][i];
    }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      A[n * i + j] = 0.0;
      for (int k = 0; k < n; k++) A[n * i + j] += inverse[k][i] * inverse[k][j];
    }
}

void MPMMotionSystem::find_blocks()
{
  const Clock timed(times, MPMImplicitTimes::PRECONDITIONERS);
  balance.find_blocks(blocks);
  constraints.add_friction_blocks(blocks.data());
}

/** Inverts the blocks. */
void MPMMotionSystem::prepare_blocks()
{
  const Clock timed(times, MPMImplicitTimes::PRECONDITIONERS);
  const int width = nodes.width;
  for (int64_t n = 0; n < nodes.nnodes(); n++) invert(width, &blocks[width * width * n]);
  by_levels = false;
}

/** Replaces the symmetric matrix S [n][n] of a node by the nearest projection. */
static void round_projection(int n, double *S)
{
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 3, 3>;
  Eigen::Map<Matrix> of(S, n, n);
  if (of.isIdentity(PROJECTED)) {
    of.setIdentity();
    return;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> axes(of);
  Matrix rounded = Matrix::Zero(n, n);
  for (int k = 0; k < n; k++)
    if (axes.eigenvalues()[k] > 0.5)
      rounded += axes.eigenvectors().col(k) * axes.eigenvectors().col(k).transpose();
  of = rounded;
}

void MPMMotionSystem::make_levels(bool same_structure)
{
  if (same_structure && multigrid->begin_again() && fill_levels()) return;
  begin_levels();
  fill_levels();
}

/** Begins levels with the blocks of the diagonal. Unit vectors show what walls leave free of each
 *  node. Where walls hold nodes together (find_tied_nodes()), this is the freedom of all of these
 *  nodes. Pairs of mirror nodes at faces, and bodies that touch, do not quite fit this scheme:
 *  levels then take the heavier node of a pair as free, and the lighter one as held. */
void MPMMotionSystem::begin_levels()
{
  const Clock timed(times, MPMImplicitTimes::PRECONDITIONERS);
  by_levels = false;
  const int width = nodes.width;
  const int64_t nreals = nodes.nreals();
  std::vector<double> projection, unit(nreals);
  find_blocks();
  nodes.field.nodes.complete(blocks.data(), width * width, width * width);
  if (!constraints.any()) return multigrid->begin(nullptr, blocks.data());
  for (int column = 0; column < width; column++) {
    projection.resize(nreals * width);
    for (int64_t k = 0; k < nreals; k++)
      unit[k] = k % width == column && nodes.mass[k / width] > 0.0 ? 1.0 : 0.0;
    constraints.project(unit.data());
    for (int64_t k = 0; k < nreals; k++) projection[width * k + column] = unit[k];
  }
  const auto ties = find_tied_nodes(nodes, constraints, ranks);
  for (int64_t n = 0; n < nodes.nnodes(); n++)
    round_projection(width, &projection[width * width * n]);
  multigrid->begin(projection.data(), blocks.data(), ties);
}

/** Gives the levels that have begun the values of points and masses. Returns false if these reach
 *  nodes that the levels do not know. */
bool MPMMotionSystem::fill_levels()
{
  const Clock timed(times, MPMImplicitTimes::PRECONDITIONERS);
  by_levels = true;
  balance.add_stiffness(*multigrid);
  std::vector<double> stiff = nodes.mass;
  for (double &m : stiff) m *= balance.inertia_per_mass();
  constraints.add_friction_stiffness(stiff.data());
  return multigrid->finish(
      *this, balance.inertia_per_mass() > 0.0 || constraints.rubs() ? stiff.data() : nullptr);
}

/** For tangents that are not symmetric. GMRES with restarts can reach a state in which it gains
 *  nothing any more. */
SolveReport MPMMotionSystem::solve_general(const double *b, double *x, const SolveGoal &goal)
{
  SolveReport solved;
  for (int done = 0; done < goal.most_iterations;) {
    SolveGoal turn = goal;
    turn.most_iterations = std::min(TURN, goal.most_iterations - done);
    solved = gmres.solve(*this, b, x, turn);
    solved.iterations = done += solved.iterations;
    if (solved.outcome != SolveReport::TOO_MANY) break;
    if (solved.residuals.back() > GAIN * solved.residuals[0]) break;
  }
  return solved;
}

/** Levels take longer to make than to use: those of the first tangents of a step serve all of its
 *  iterations as long as they do well. Nothing outlives the step, because a run that continues from
 *  a restart file must take the same way. */
SolveReport MPMMotionSystem::solve(const double *b, double *x, const SolveGoal &goal)
{
  const Clock timed(times, MPMImplicitTimes::SYSTEMS);
  const auto attempt = [&](int most) {
    auto within = goal;
    within.most_iterations = std::min(most, goal.most_iterations);
    std::fill_n(x, nodes.nreals(), 0.0);
    const bool symmetric = report.asymmetry <= MPMImplicitReport::SYMMETRIC &&
        (!constraints.rubs() || constraints.fixes_pressing_forces(report.asymmetry)) &&
        !(multigrid && averages);
    return symmetric ? conjugate_gradients.solve(*this, b, x, within) : solve_general(b, x, within);
  };
  for (int again = 0; multigrid && again < 2; again++) {
    const bool made = !by_levels;
    if (made) {
      make_levels();
      report.made++;
      if (!multigrid->usable()) break;
    }
    const auto solved = attempt(made ? goal.most_iterations : TOO_OLD);
    if (solved.converged()) {
      if (solved.iterations > DO_WELL) by_levels = false;
      return solved;
    }
    report.linear += solved.iterations;
    by_levels = false;
    // new levels of tangents that are not positive definite are of no use, either
    if (made) break;
  }
  by_levels = false;
  find_blocks();
  prepare_blocks();
  return attempt(goal.most_iterations);
}

double MPMMotionSystem::memory_usage() const
{
  return conjugate_gradients.memory_usage() + gmres.memory_usage() +
      (multigrid ? multigrid->memory_usage() : 0.0) + bytes_of(blocks, allowed);
}
