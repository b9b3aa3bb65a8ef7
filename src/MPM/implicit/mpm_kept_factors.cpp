/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Steps with inertia are much alike, and tangents cost more than forces. The tangents of a step are
   therefore kept for the next ones, as factors, and corrected by what each iteration shows: the
   change of the forces that its correction of the motion made (H. Matthies, G. Strang, Int. J.
   Numer. Methods Eng. 14 (1979) 1613; see QuasiNewton). An iteration then costs the forces of the
   points and a solution with factors. It converges to the same result as Newton's method.

   What changes most is the orientation of the body: the stiffness of a beam along its axis is a
   thousand times that across it, and some degrees of rotation bring much of one into the other.
   Factors therefore turn with the body. A rotation of the whole body turns the stiffness by just
   this rotation. Where rotations R differ between parts of the body, R K^-1 R^T is near the inverse
   of the stiffness as long as R changes little within a cell.
------------------------------------------------------------------------- */

#include "implicit/mpm_kept_factors.h"

#include "implicit/mpm_constraints.h"
#include "implicit/mpm_force_balance.h"
#include "implicit/mpm_motion_system.h"
#include "implicit/mpm_newton.h"
#include "implicit/mpm_solved_nodes.h"

#include "force.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

using Clock = MPMImplicitTimes::Clock;

static constexpr double SAME = 1.0e-10;         // difference of what walls leave free
static constexpr int COST = 20;                 // of making factors, in iterations
static constexpr int MOST_FACTORS = 3;          // factorizations in a step
static constexpr int MOST_WITH_FACTORS = 25;    // iterations in a step
static constexpr std::size_t MOTIONS = 2;       // of former steps that are kept

MPMKeptFactors::MPMKeptFactors(const MPMImplicitParts &parts, MPMMotionSystem &system,
                               MPMNewton &newton) :
    MPMImplicitParts(parts),
    system(system), newton(newton), tangent(balance.tangent()), shared(system.lattice_ranks())
{
}

/** Gathers values of the nodes that this rank owns for all ranks. Collective. */
void MPMKeptFactors::gather(const std::vector<double> &values, std::vector<double> &all)
{
  owned.resize(nodes.nowned * nodes.width);
  for (std::size_t i = 0; i < nodes.nowned; i++)
    std::copy_n(&values[nodes.width * nodes.active[i]], nodes.width, &owned[nodes.width * i]);
  shared.gather(owned, nodes.width, all);
}

/** Do walls leave the nodes of this rank as free as before? */
bool MPMKeptFactors::walls_are_same(const std::vector<double> &walls) const
{
  const auto &places = shared.places();
  for (std::size_t i = 0; i < nodes.active.size(); i++)
    for (int d = 0; d < nodes.width; d++)
      if (!(std::fabs(walls[nodes.width * nodes.active[i] + d] -
                      kept.walls[nodes.width * places[i] + d]) <= SAME))
        return false;
  return true;
}

/** Checks that what was kept belongs to these nodes and walls; otherwise it is dropped.
 *  Collective. */
void MPMKeptFactors::check()
{
  std::vector<uint64_t> blocks;
  blocks.reserve(3 * nodes.field.grid.blocks.size());
  int64_t n = 0;
  for (const auto &block : nodes.field.grid.blocks) {
    uint64_t with_mass = 0;
    for (int k = 0; k < NODES_PER_BLOCK; k++, n++)
      if (nodes.mass[n] > 0.0) with_mass |= (uint64_t) 1 << k;
    blocks.insert(blocks.end(), {Grid::block_key(block), block.owned, with_mass});
  }
  // the same on all ranks
  std::vector<double> walls(nodes.nreals(), 0.0);
  int index[3];
  for (const int64_t node : nodes.active) {
    nodes.field.grid.node_index(node, index);
    for (int d = 0; d < nodes.width; d++)
      walls[nodes.width * node + d] =
          std::cos(0.7 + 2.9 * index[0] + 4.7 * index[1] + 8.3 * index[2] + 1.9 * d);
  }
  constraints.project(walls.data());

  enum { NODES, WALLS };
  int same[2], all[2] = {0, 0};
  if (kept.known && dt == kept.dt) {
    same[NODES] = blocks == kept.nodes;
    same[WALLS] = !same[NODES] || walls_are_same(walls);
    MPI_Allreduce(same, all, 2, MPI_INT, MPI_MIN, nodes.lmp->world);
    if (all[NODES] && all[WALLS]) return;
  }
  std::vector<LatticeIndex> indices;
  for (const int64_t node : nodes.active) indices.push_back(nodes.index_of(node));
  // ranks may now own other nodes of the same set
  if (kept.known && dt == kept.dt && all[WALLS] && shared.renumber(indices, nodes.nowned)) {
    kept.nodes.swap(blocks);
    kept.structured = kept.levels = false;
    same[WALLS] = walls_are_same(walls);
    MPI_Allreduce(same, all, 2, MPI_INT, MPI_MIN, nodes.lmp->world);
    if (all[WALLS]) return;
  }
  kept.clear();
  shared.number(indices, nodes.nowned);
  kept.nodes.swap(blocks);
  gather(walls, kept.walls);
  kept.dt = dt;
  kept.known = true;
  kept.pairs.start(kept.walls.size());
}

/** First guess: the motion goes on as in the last two steps. */
void MPMKeptFactors::extrapolate(std::vector<double> &u)
{
  const auto &last = kept.motions;
  if (last.size() < MOTIONS) return;
  const auto &places = shared.places();
  for (std::size_t i = 0; i < nodes.active.size(); i++)
    for (int d = 0; d < nodes.width; d++) {
      const std::size_t k = (std::size_t) nodes.width * places[i] + d;
      u[nodes.width * nodes.active[i] + d] = 2.0 * last[0][k] - last[1][k];
    }
  std::vector<double> prescribed(nodes.nreals(), 0.0);
  constraints.meet_walls(u, 1.0, prescribed);
}

void MPMKeptFactors::store(const std::vector<double> &u)
{
  kept.levels = system.uses_levels() && large && report.converged;
  if (!report.converged) return;
  if (!kept.known) check();
  std::vector<double> motion;
  if (kept.motions.size() == MOTIONS) {
    motion.swap(kept.motions.back());
    kept.motions.pop_back();
  }
  gather(u, motion);
  kept.motions.push_front(std::move(motion));
}

/** Rotations of the body around nodes since the factors were made, R R0^T. */
void MPMKeptFactors::find_turns()
{
  const int w = nodes.width, square = w * w;
  tangent.mean_rotations(nodes.active, rotations);
  turns.assign(rotations.size(), 0.0);
  const auto &places = shared.places();
  for (std::size_t i = 0; i < nodes.active.size(); i++) {
    const double *const R = &rotations[i * square], *const R0 = &kept.turned[places[i] * square];
    for (int a = 0; a < w; a++)
      for (int b = 0; b < w; b++)
        for (int c = 0; c < w; c++) turns[i * square + w * a + b] += R[w * a + c] * R0[w * b + c];
  }
}

/** Makes factors of the tangents at the motion u; false if there are no useful ones. Collective. */
bool MPMKeptFactors::make_factors(const std::vector<double> &u)
{
  kept.drop_factors();
  taken = 0.0;
  tangent.keep_deformations(true);
  {
    const Clock timed(times, MPMImplicitTimes::TANGENTS);
    kept.stiffness = tangent.linearize(balance.scaled(u), balance.time_of_forces());
  }
  tangent.keep_deformations(false);
  kept.asymmetry = tangent.asymmetry();
  if (kept.asymmetry > MPMImplicitReport::SYMMETRIC) return false;
  // earlier factors, if any, were for the same nodes and walls
  system.make_levels(kept.structured);
  kept.structured = true;
  report.made++;
  large = !system.levels()->is_whole();
  turns.clear();
  if (!large) {
    tangent.mean_rotations(nodes.active, rotations);
    rotations.resize(nodes.nowned * nodes.width * nodes.width);
    shared.gather(rotations, nodes.width * nodes.width, kept.turned);
    kept.in_factors.clear();
    for (const auto &index : shared.indices())
      kept.in_factors.push_back(system.levels()->place_in_whole(index));
  }
  return kept.factorized = system.levels()->usable() && !large;
}

/** to = R from, or R^T from. */
template <int W> static void turn(const double *R, bool back, const double *from, double *to)
{
  for (int a = 0; a < W; a++) {
    to[a] = 0.0;
    for (int b = 0; b < W; b++) to[a] += (back ? R[W * b + a] : R[W * a + b]) * from[b];
  }
}

/** Shares the residual, turned back to the orientation of the factors, its solution with them, and
 *  the last correction, of all nodes. Collective. */
void MPMKeptFactors::solve_with_factors()
{
  const int w = nodes.width, each = taken != 0.0 ? 2 * w : w;
  owned.resize(nodes.nowned * each);
  const auto take = [&](auto dim) {
    constexpr int W = decltype(dim)::value;
    for (std::size_t i = 0; i < nodes.nowned; i++) {
      double *const to = &owned[i * each];
      const double *const f = &newton.free_forces()[W * nodes.active[i]],
                          *const du = &newton.last_correction()[W * nodes.active[i]];
      double motion[W];
      for (int d = 0; d < W; d++) motion[d] = taken * du[d];
      if (turns.empty()) {
        std::copy_n(f, W, to);
        if (each > W) std::copy_n(motion, W, to + W);
      } else {
        turn<W>(&turns[i * W * W], true, f, to);
        if (each > W) turn<W>(&turns[i * W * W], true, motion, to + W);
      }
    }
  };
  if (w == 2)
    take(std::integral_constant<int, 2>());
  else
    take(std::integral_constant<int, 3>());
  shared.gather(owned, each, gathered);
  const std::size_t n = shared.size();
  forces.resize(n * w);
  solved.assign(n * w, 0.0);
  whole.assign(system.levels()->nodes_of_whole() * w, 0.0);
  for (std::size_t k = 0; k < n; k++) {
    const int to = kept.in_factors[k];
    for (int d = 0; d < w; d++) {
      forces[w * k + d] = gathered[each * k + d];
      if (to >= 0) whole[w * to + d] = forces[w * k + d];
    }
  }
  system.levels()->solve_whole(whole);
  for (std::size_t k = 0; k < n; k++)
    if (const int from = kept.in_factors[k]; from >= 0)
      std::copy_n(&whole[w * from], w, &solved[w * k]);
  if (taken != 0.0) {
    moved.resize(n * w);
    for (std::size_t k = 0; k < n; k++) std::copy_n(&gathered[each * k + w], w, &moved[w * k]);
    kept.pairs.moved(moved.data());
  }
  taken = 0.0;
}

/** Finds the correction of the motion for the residual, in change, from factors of a tangent and
 *  the pairs that correct them. */
void MPMKeptFactors::find_correction()
{
  const Clock timed(times, MPMImplicitTimes::SYSTEMS);
  solve_with_factors();
  corrected.resize(solved.size());
  kept.pairs.correct(forces.data(), solved.data(), corrected.data());
  const auto &places = shared.places();
  const auto give = [&](auto dim) {
    constexpr int W = decltype(dim)::value;
    for (std::size_t i = 0; i < nodes.active.size(); i++) {
      const double *const from = &corrected[W * places[i]];
      double *const to = &newton.change()[W * nodes.active[i]];
      if (turns.empty())
        std::copy_n(from, W, to);
      else
        turn<W>(&turns[i * W * W], false, from, to);
    }
  };
  if (nodes.width == 2)
    give(std::integral_constant<int, 2>());
  else
    give(std::integral_constant<int, 3>());
  constraints.project(newton.change().data());
}

/** Stores the pair of the last correction before the body turns further. */
void MPMKeptFactors::learn()
{
  if (taken == 0.0) return;
  solve_with_factors();
  kept.pairs.settle(forces.data(), solved.data());
}

/** Finds the end of the step with kept factors. False if it was not found: Newton's method then
 *  goes from the start of the step. */
bool MPMKeptFactors::iterate(std::vector<double> &u)
{
  double size;
  int made = 0, with_these = 0;
  report.residuals.clear();
  // overall, a step costs least if factors are made again as soon as a step costs more than the
  // mean of those before
  if (kept.factorized && kept.steps > 0 && kept.last * kept.steps > kept.iterations + COST)
    kept.drop_factors();
  turns.clear();
  taken = 0.0;
  tangent.keep_deformations(kept.factorized);
  const bool begun = newton.find_residual(u, size);
  tangent.keep_deformations(false);
  if (!begun) return false;
  if (kept.factorized) find_turns();
  while (true) {
    report.residuals.push_back(report.unbalanced);
    const double enough =
        std::max({options.tolerance * size, options.absolute * nodes.lmp->force->ftm2v,
                  MPMForceBalance::ROUND_OFF * kept.stiffness});
    if (report.unbalanced <= enough) break;
    if (!kept.factorized || with_these >= MOST_WITH_FACTORS) {
      if (made == MOST_FACTORS || !make_factors(u)) return false;
      made++;
      with_these = 0;
    }
    find_correction();
    report.iterations++;
    report.linear++;
    with_these++;
    kept.iterations++;
    if (newton.line_search(u, size)) {
      taken = newton.last_share();
      continue;
    }
    report.failure.clear();
    if (with_these == 1 && made) return false;
    kept.drop_factors();
    taken = 0.0;
    if (!newton.find_residual(u, size)) return false;
  }
  learn();
  report.asymmetry = kept.asymmetry;
  kept.steps++;
  kept.last = with_these;
  return true;
}

bool MPMKeptFactors::solve(std::vector<double> &u, double step_dt)
{
  dt = step_dt;
  check();
  std::vector<double> guess = u;
  extrapolate(guess);
  system.use_levels(kept.levels);
  bool found = !large && iterate(guess);
  // with levels, a solution has too many products to do without the present tangent
  if (large) found = newton.iterate(guess, (int) options.most_iterations) == MPMNewton::CONVERGED;
  if (!found) {
    kept.clear();
    system.use_levels(false);
    report.failure.clear();
    return false;
  }
  u.swap(guess);
  report.converged = true;
  report.parts = 1;
  report.reached = 1.0;
  return true;
}

double MPMKeptFactors::memory_usage() const
{
  return kept.memory_usage() + shared.memory_usage() +
      bytes_of(turns, rotations, owned, gathered, whole, forces, moved, solved, corrected);
}
