/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Steps with inertia are much alike, and tangents cost more than forces. The tangents of a step are therefore
   kept for the next ones, as factors, and corrected by what each iteration shows: the change of the forces
   that its correction of the motion made (H. Matthies, G. Strang, Int. J. Numer. Methods Eng. 14 (1979) 1613;
   see QuasiNewton). An iteration then costs the forces of the points and a solution with factors. It
   converges to the same result as Newton's method.

   What changes most is the orientation of the body: the stiffness of a beam along its axis is a thousand
   times that across it, and some degrees of rotation bring much of one into the other. Factors therefore turn
   with the body. A rotation of the whole body turns the stiffness by just this rotation. Where rotations R
   differ between parts of the body, R K^-1 R^T is near the inverse of the stiffness as long as R changes
   little within a cell.
------------------------------------------------------------------------- */

#include "implicit/mpm_implicit.h"

#include "field/mpm_field.h"
#include "field/mpm_plan.h"
#include "force.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double SAME = 1.0e-10;         // difference of what walls leave free
static constexpr double SYMMETRIC = 1.0e-3;     // greatest asymmetry of tangents
static constexpr double ROUND_OFF = 2.0e-16;    // of strains, which limits the accuracy of forces
static constexpr int COST = 20;                 // of making factors, in iterations
static constexpr int MOST_FACTORS = 3;          // factorizations in a step
static constexpr int MOST_WITH_FACTORS = 25;    // iterations in a step
static constexpr std::size_t MOTIONS = 2;       // of former steps that are kept

/** Can factors of tangents serve several steps of this run? */
bool MPMImplicit::can_keep() const
{
  return multigrid && options.time != MPMImplicitOptions::STATIC && !joint && contacts.empty();
}

/** Gathers values of the nodes that this rank owns for all ranks. Collective. */
void MPMImplicit::gather_heavy(const std::vector<double> &of_all, std::vector<double> &of_shared)
{
  of_owned.resize(heavy_owned * width);
  for (std::size_t i = 0; i < heavy_owned; i++)
    std::copy_n(&of_all[width * heavy[i]], width, &of_owned[width * i]);
  shared.gather(of_owned, width, of_shared);
}

/** Do walls leave the nodes of this rank as free as before? */
bool MPMImplicit::walls_are_same(const std::vector<double> &walls) const
{
  const auto &places = shared.places();
  for (std::size_t i = 0; i < heavy.size(); i++)
    for (int d = 0; d < width; d++)
      if (!(std::fabs(walls[width * heavy[i] + d] - memory.walls[width * places[i] + d]) <= SAME))
        return false;
  return true;
}

/** Checks that what was kept belongs to these nodes and walls; otherwise it is dropped. Collective. */
void MPMImplicit::recall()
{
  std::vector<uint64_t> nodes;
  nodes.reserve(3 * grid.blocks.size());
  int64_t n = 0;
  for (const auto &block : grid.blocks) {
    uint64_t with_mass = 0;
    for (int k = 0; k < NODES_PER_BLOCK; k++, n++)
      if (mass[n] > 0.0) with_mass |= (uint64_t) 1 << k;
    nodes.insert(nodes.end(), {Grid::block_key(block), block.owned, with_mass});
  }
  // the same on all ranks
  std::vector<double> walls(nreals(), 0.0);
  int index[3];
  for (const int64_t node : heavy) {
    grid.node_index(node, index);
    for (int d = 0; d < width; d++)
      walls[width * node + d] =
          std::cos(0.7 + 2.9 * index[0] + 4.7 * index[1] + 8.3 * index[2] + 1.9 * d);
  }
  project(walls.data());

  enum { NODES, WALLS };
  int same[2], all[2] = {0, 0};
  if (memory.known && dt == memory.dt) {
    same[NODES] = nodes == memory.nodes;
    same[WALLS] = !same[NODES] || walls_are_same(walls);
    MPI_Allreduce(same, all, 2, MPI_INT, MPI_MIN, lmp->world);
    if (all[NODES] && all[WALLS]) return;
  }
  std::vector<LatticeIndex> indices;
  for (const int64_t node : heavy) {
    grid.node_index(node, index);
    indices.push_back({0, 0, 0});
    for (int d = 0; d < width; d++) indices.back()[d] = grid.lattice.wrap(d, index[d]);
  }
  // ranks may now own other nodes of the same set
  if (memory.known && dt == memory.dt && all[WALLS] && shared.renumber(indices, heavy_owned)) {
    memory.nodes.swap(nodes);
    memory.structured = memory.levels = false;
    same[WALLS] = walls_are_same(walls);
    MPI_Allreduce(same, all, 2, MPI_INT, MPI_MIN, lmp->world);
    if (all[WALLS]) return;
  }
  memory.clear();
  shared.number(indices, heavy_owned);
  memory.nodes.swap(nodes);
  gather_heavy(walls, memory.walls);
  memory.dt = dt;
  memory.known = true;
  memory.pairs.start(memory.walls.size());
}

/** First guess: the motion goes on as in the last two steps. */
void MPMImplicit::foresee(std::vector<double> &u)
{
  const auto &last = memory.motions;
  if (last.size() < MOTIONS) return;
  const auto &places = shared.places();
  for (std::size_t i = 0; i < heavy.size(); i++)
    for (int d = 0; d < width; d++) {
      const std::size_t k = (std::size_t) width * places[i] + d;
      u[width * heavy[i] + d] = 2.0 * last[0][k] - last[1][k];
    }
  meet_walls(u, 1.0);
}

void MPMImplicit::remember(const std::vector<double> &u)
{
  memory.levels = by_levels && large && now.converged;
  if (!now.converged) return;
  if (!memory.known) recall();
  std::vector<double> motion;
  if (memory.motions.size() == MOTIONS) {
    motion.swap(memory.motions.back());
    memory.motions.pop_back();
  }
  gather_heavy(u, motion);
  memory.motions.push_front(std::move(motion));
}

/** Rotations of the body around nodes since the factors were made, R R0^T. */
void MPMImplicit::turn_from_factors()
{
  const int w = width, square = w * w;
  tangent.mean_rotations(heavy, rotations);
  turns.assign(rotations.size(), 0.0);
  const auto &places = shared.places();
  for (std::size_t i = 0; i < heavy.size(); i++) {
    const double *const R = &rotations[i * square], *const R0 = &memory.turned[places[i] * square];
    for (int a = 0; a < w; a++)
      for (int b = 0; b < w; b++)
        for (int c = 0; c < w; c++) turns[i * square + w * a + b] += R[w * a + c] * R0[w * b + c];
  }
}

/** Makes factors of the tangents at the motion u; false if there are no useful ones. Collective. */
bool MPMImplicit::make_factors(const std::vector<double> &u)
{
  memory.drop_factors();
  taken = 0.0;
  tangent.keep_deformations(true);
  {
    const Clock timed(*this, TANGENTS);
    memory.stiffness = tangent.linearize(part_of(u), part * dt);
  }
  tangent.keep_deformations(false);
  memory.asymmetry = tangent.asymmetry();
  if (memory.asymmetry > SYMMETRIC) return false;
  // earlier factors, if any, were for the same nodes and walls
  if (memory.structured && multigrid->begin_again())
    fill_levels();
  else
    prepare_levels();
  memory.structured = true;
  now.made++;
  large = !multigrid->is_whole();
  turns.clear();
  if (!large) {
    tangent.mean_rotations(heavy, rotations);
    rotations.resize(heavy_owned * width * width);
    shared.gather(rotations, width * width, memory.turned);
    memory.in_factors.clear();
    for (const auto &index : shared.indices())
      memory.in_factors.push_back(multigrid->place_in_whole(index));
  }
  return memory.factorized = multigrid->usable() && !large;
}

/** to = R from, or R^T from. */
template <int W> static void turn(const double *R, bool back, const double *from, double *to)
{
  for (int a = 0; a < W; a++) {
    to[a] = 0.0;
    for (int b = 0; b < W; b++) to[a] += (back ? R[W * b + a] : R[W * a + b]) * from[b];
  }
}

/** Shares the residual, turned back to the orientation of the factors, its solution with them, and the last
 *  correction, of all nodes. Collective. */
void MPMImplicit::share_forces()
{
  const int w = width, each = taken != 0.0 ? 2 * w : w;
  of_owned.resize(heavy_owned * each);
  const auto take = [&](auto dim) {
    constexpr int W = decltype(dim)::value;
    for (std::size_t i = 0; i < heavy_owned; i++) {
      double *const to = &of_owned[i * each];
      const double *const f = &free[W * heavy[i]], *const du = &correction[W * heavy[i]];
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
  shared.gather(of_owned, each, of_everyone);
  const std::size_t n = shared.size();
  left.resize(n * w);
  solved.assign(n * w, 0.0);
  of_system.assign(multigrid->nodes_of_whole() * w, 0.0);
  for (std::size_t k = 0; k < n; k++) {
    const int to = memory.in_factors[k];
    for (int d = 0; d < w; d++) {
      left[w * k + d] = of_everyone[each * k + d];
      if (to >= 0) of_system[w * to + d] = left[w * k + d];
    }
  }
  multigrid->solve_whole(of_system.data());
  for (std::size_t k = 0; k < n; k++)
    if (const int from = memory.in_factors[k]; from >= 0)
      std::copy_n(&of_system[w * from], w, &solved[w * k]);
  if (taken != 0.0) {
    moved.resize(n * w);
    for (std::size_t k = 0; k < n; k++) std::copy_n(&of_everyone[each * k + w], w, &moved[w * k]);
    memory.pairs.moved(moved.data());
  }
  taken = 0.0;
}

/** Finds the correction of the motion for the residual, in change, from factors of a tangent and the pairs
 *  that correct them. */
void MPMImplicit::find_correction()
{
  const Clock timed(*this, SYSTEMS);
  share_forces();
  corrected.resize(solved.size());
  memory.pairs.correct(left.data(), solved.data(), corrected.data());
  const auto &places = shared.places();
  const auto give = [&](auto dim) {
    constexpr int W = decltype(dim)::value;
    for (std::size_t i = 0; i < heavy.size(); i++) {
      const double *const from = &corrected[W * places[i]];
      double *const to = &change[W * heavy[i]];
      if (turns.empty())
        std::copy_n(from, W, to);
      else
        turn<W>(&turns[i * W * W], false, from, to);
    }
  };
  if (width == 2)
    give(std::integral_constant<int, 2>());
  else
    give(std::integral_constant<int, 3>());
  project(change.data());
}

/** Stores the pair of the last correction before the body turns further. */
void MPMImplicit::learn()
{
  if (taken == 0.0) return;
  share_forces();
  memory.pairs.settle(left.data(), solved.data());
}

/** Finds the end of the step with kept factors. False if it was not found: Newton's method then goes from the
 *  start of the step. */
bool MPMImplicit::go_on(std::vector<double> &u)
{
  double size;
  int made = 0, with_these = 0;
  now.residuals.clear();
  // overall, a step costs least if factors are made again as soon
  // as a step costs more than the mean of those before
  if (memory.factorized && memory.steps > 0 &&
      memory.last * memory.steps > memory.iterations + COST)
    memory.drop_factors();
  turns.clear();
  taken = 0.0;
  tangent.keep_deformations(memory.factorized);
  const bool begun = find_residual(u, size);
  tangent.keep_deformations(false);
  if (!begun) return false;
  if (memory.factorized) turn_from_factors();
  while (true) {
    now.residuals.push_back(now.unbalanced);
    const double enough = std::max({options.tolerance * size, options.absolute * lmp->force->ftm2v,
                                    ROUND_OFF * memory.stiffness});
    if (now.unbalanced <= enough) break;
    if (!memory.factorized || with_these >= MOST_WITH_FACTORS) {
      if (made == MOST_FACTORS || !make_factors(u)) return false;
      made++;
      with_these = 0;
    }
    find_correction();
    now.iterations++;
    now.linear++;
    with_these++;
    memory.iterations++;
    const double slope = product(change.data(), free.data());
    if (!search(u, slope, size)) {
      now.failure.clear();
      if (with_these == 1 && made) return false;
      memory.drop_factors();
      taken = 0.0;
      if (!find_residual(u, size)) return false;
      continue;
    }
  }
  learn();
  now.asymmetry = memory.asymmetry;
  memory.steps++;
  memory.last = with_these;
  return true;
}

/** Solves the step with what earlier steps have left. False, with u as it was, if this does not lead to its
 *  end. */
bool MPMImplicit::go_on_from_before(std::vector<double> &u)
{
  recall();
  std::vector<double> foreseen = u;
  foresee(foreseen);
  by_levels = memory.levels;
  bool found = !large && go_on(foreseen);
  // with levels, a solution has too many products to do without the present tangent
  if (large) found = newton(foreseen, (int) options.most_iterations) == CONVERGED;
  if (!found) {
    memory.clear();
    by_levels = false;
    now.failure.clear();
    return false;
  }
  u.swap(foreseen);
  now.converged = true;
  now.parts = 1;
  now.reached = 1.0;
  return true;
}
