/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Steps with inertia are much alike, and tangents cost more than forces: those of a step are kept for the next ones, as factors, and
   corrected by what each iteration tells of them, which is the difference of the forces that its correction of the motion made (H. Matthies,
   G. Strang, Int. J. Numer. Methods Eng. 14 (1979) 1613; in the form of J. Nocedal, Math. Comput. 35 (1980) 773). An iteration then costs the
   forces of the points and a solution with factors. What it converges to is what Newton's method does.

   What changes most is where the body points to: the stiffness of a beam along its axis is a thousand times that across, and some degrees of
   rotation bring much of one into the other. Factors turn with the body: a rotation of all of it turns the stiffness by just that, and where
   rotations R of the parts are not the same, R K^-1 R^T is near to the inverse of the stiffness as long as they change by little in a cell.
------------------------------------------------------------------------- */

#include "mpm_implicit.h"

#include "force.h"
#include "mpm_field.h"
#include "mpm_plan.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double SAME = 1.0e-10;         // of what walls leave
static constexpr double SYMMETRIC = 1.0e-3;     // of tangents
static constexpr double ROUND_OFF = 2.0e-16;    // of strains: forces are not known better
static constexpr double CURVED = 1.0e-10;       // s . y over the lengths of both, least
static constexpr int MOST_PAIRS = 24;
static constexpr int COST = 20;                 // of factors, in iterations
static constexpr int MOST_FACTORS = 3;          // in a step
static constexpr int MOST_WITH_FACTORS = 25;    // iterations in a step
static constexpr std::size_t MOTIONS = 2;       // that are kept

/** Do factors of tangents serve the steps of this run? */
bool MPMImplicit::can_keep() const
{
  return multigrid && options.time != MPMImplicitOptions::STATIC && !joint && contacts.empty();
}

/** Is what was kept for these nodes and walls? Else it is forgotten. Collective. */
void MPMImplicit::recall()
{
  std::vector<uint64_t> nodes;
  nodes.reserve(3 * grid.blocks.size());
  int64_t n = 0;
  for (const auto &block : grid.blocks) {
    uint64_t heavy = 0;
    for (int k = 0; k < NODES_PER_BLOCK; k++, n++)
      if (mass[n] > 0.0) heavy |= (uint64_t) 1 << k;
    nodes.insert(nodes.end(), {Grid::block_key(block), block.owned, heavy});
  }
  // the same on all ranks
  std::vector<double> walls(nreals());
  int index[3];
  for (n = 0; n < (int64_t) mass.size(); n++) {
    grid.node_index(n, index);
    for (int d = 0; d < width; d++)
      walls[width * n + d] = mass[n] > 0.0
          ? std::cos(0.7 + 2.9 * index[0] + 4.7 * index[1] + 8.3 * index[2] + 1.9 * d)
          : 0.0;
  }
  project(walls.data());
  heavy.clear();
  for (const bool owned : {true, false}) {
    for (n = 0; n < (int64_t) mass.size(); n++)
      if (mass[n] > 0.0 && grid.owns(n) == owned) heavy.push_back(n);
    if (owned) heavy_owned = heavy.size();
  }
  int same = nodes == memory.nodes && dt == memory.dt, all;
  for (std::size_t k = 0; same && k < walls.size(); k++)
    if (!(std::fabs(walls[k] - memory.walls[k]) <= SAME)) same = 0;
  MPI_Allreduce(&same, &all, 1, MPI_INT, MPI_MIN, lmp->world);
  if (all) return;
  memory.clear();
  memory.nodes.swap(nodes);
  memory.walls.swap(walls);
  memory.dt = dt;
}

/** The motion goes on as in the last two steps. */
void MPMImplicit::foresee(std::vector<double> &u)
{
  const auto &last = memory.motions;
  if (last.size() < MOTIONS) return;
  for (int64_t k = 0; k < nreals(); k++) u[k] = 2.0 * last[0][k] - last[1][k];
  meet_walls(u, 1.0);
}

void MPMImplicit::remember(const std::vector<double> &u)
{
  memory.levels = by_levels && large && now.converged;
  if (!now.converged) return;
  std::vector<double> motion;
  if (memory.motions.size() == MOTIONS) {
    motion.swap(memory.motions.back());
    memory.motions.pop_back();
  }
  motion = u;
  memory.motions.push_front(std::move(motion));
}

/** Rotations of the body around nodes since the factors, R R0^T. */
void MPMImplicit::turn_from_factors()
{
  const int w = width, square = w * w;
  std::vector<double> rotations;
  tangent.mean_rotations(heavy, rotations);
  turns.assign(rotations.size(), 0.0);
  for (std::size_t k = 0; k < rotations.size(); k += square)
    for (int a = 0; a < w; a++)
      for (int b = 0; b < w; b++)
        for (int c = 0; c < w; c++)
          turns[k + w * a + b] += rotations[k + w * a + c] * memory.turned[k + w * b + c];
}

/** Vectors of nodes with a mass turn with the body, or back. */
void MPMImplicit::turn(bool back, std::vector<double> &x) const
{
  const int w = width;
  for (std::size_t k = 0; k < turns.size() / (w * w); k++) {
    const double *const R = &turns[k * w * w];
    double *const v = &x[k * w];
    double from[3];
    std::copy_n(v, w, from);
    for (int a = 0; a < w; a++) {
      v[a] = 0.0;
      for (int b = 0; b < w; b++) v[a] += (back ? R[w * b + a] : R[w * a + b]) * from[b];
    }
  }
}

/** Factors of the tangents at the motion u; false: there are none that are of use. Collective. */
bool MPMImplicit::make_factors(const std::vector<double> &u)
{
  memory.drop_factors();
  tangent.keep_deformations(true);
  memory.stiffness = tangent.linearize(part_of(u), part * dt);
  tangent.keep_deformations(false);
  memory.asymmetry = tangent.asymmetry();
  if (memory.asymmetry > SYMMETRIC) return false;
  // nodes and walls are those of the factors before, if there were any
  if (memory.structured && multigrid->begin_again())
    fill_levels();
  else
    prepare_levels();
  memory.structured = true;
  now.made++;
  large = !multigrid->is_whole();
  turns.clear();
  if (!large) tangent.mean_rotations(heavy, memory.turned);
  return memory.factorized = multigrid->usable() && !large;
}

/** The product of two vectors of nodes with a mass, in the order of ranks. Collective. */
double MPMImplicit::product_of_heavy(const std::vector<double> &a, const std::vector<double> &b)
{
  // several sums at a time, as one waits for its last addition
  double part[4] = {0.0, 0.0, 0.0, 0.0}, mine = 0.0, value;
  const std::size_t n = heavy_owned * width, whole = n - n % 4;
  for (std::size_t k = 0; k < whole; k += 4)
    for (int i = 0; i < 4; i++) part[i] += a[k + i] * b[k + i];
  for (std::size_t k = whole; k < n; k++) mine += a[k] * b[k];
  mine += (part[0] + part[1]) + (part[2] + part[3]);
  sum_in_order(lmp, 1, &mine, of_ranks, &value);
  return value;
}

void MPMImplicit::take_heavy(const std::vector<double> &of_all, std::vector<double> &of_heavy) const
{
  of_heavy.resize(heavy.size() * width);
  double *to = of_heavy.data();
  for (const int64_t node : heavy)
    for (int d = 0; d < width; d++) *to++ = of_all[node * width + d];
}

void MPMImplicit::put_heavy(const std::vector<double> &of_heavy, std::vector<double> &of_all) const
{
  const double *from = of_heavy.data();
  for (const int64_t node : heavy)
    for (int d = 0; d < width; d++) of_all[node * width + d] = *from++;
}

/** The correction of the motion by the forces that are left, in change: factors of a tangent, and what pairs tell of it. */
void MPMImplicit::find_correction()
{
  const int n = (int) memory.pairs.size();
  std::vector<double> along(n);
  const auto add = [](double share, const std::vector<double> &of, std::vector<double> &to) {
    for (std::size_t k = 0; k < to.size(); k++) to[k] += share * of[k];
  };
  take_heavy(free, of_heavy);
  turn(true, of_heavy);
  for (int k = n - 1; k >= 0; k--) {
    const auto &pair = memory.pairs[k];
    along[k] = product_of_heavy(pair.s, of_heavy) / pair.sy;
    add(-along[k], pair.y, of_heavy);
  }
  trial = free;
  put_heavy(of_heavy, trial);
  multigrid->precondition(trial.data(), change.data());
  take_heavy(change, of_heavy);
  for (int k = 0; k < n; k++) {
    const auto &pair = memory.pairs[k];
    add(along[k] - product_of_heavy(pair.y, of_heavy) / pair.sy, pair.s, of_heavy);
  }
  turn(false, of_heavy);
  put_heavy(of_heavy, change);
  project(change.data());
}

/** What the correction from u0 to u told, with forces f0 that were left before and those that are now: u0 and f0 of nodes with a mass. */
void MPMImplicit::learn(const std::vector<double> &u0, const std::vector<double> &u,
                        const std::vector<double> &f0)
{
  MPMImplicitMemory::Pair pair;
  if ((int) memory.pairs.size() >= MOST_PAIRS) {
    pair = std::move(memory.pairs.front());
    memory.pairs.pop_front();
  }
  take_heavy(u, pair.s);
  take_heavy(free, pair.y);
  double mine[3] = {0.0, 0.0, 0.0}, sums[3];
  for (std::size_t k = 0; k < pair.s.size(); k++) {
    pair.s[k] -= u0[k];
    pair.y[k] = f0[k] - pair.y[k];
  }
  turn(true, pair.s);
  turn(true, pair.y);
  for (std::size_t k = 0; k < pair.s.size(); k++) {
    const double s = pair.s[k], y = pair.y[k];
    if (k >= heavy_owned * width) continue;
    mine[0] += s * y;
    mine[1] += s * s;
    mine[2] += y * y;
  }
  sum_in_order(lmp, 3, mine, of_ranks, sums);
  pair.sy = sums[0];
  if (sums[0] > CURVED * std::sqrt(sums[1] * sums[2])) memory.pairs.push_back(std::move(pair));
}

/** The end of the step with kept factors: false if it was not found, and Newton's method shall go from the start of the step. */
bool MPMImplicit::go_on(std::vector<double> &u)
{
  double size;
  int made = 0, with_these = 0;
  std::vector<double> u0, f0;
  now.residuals.clear();
  // on the whole, a step costs least when factors are made again as soon as one costs more than the mean of those before
  if (memory.factorized && memory.steps > 0 &&
      memory.last * memory.steps > memory.iterations + COST)
    memory.drop_factors();
  turns.clear();
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
    take_heavy(u, u0);
    take_heavy(free, f0);
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
      if (!find_residual(u, size)) return false;
      continue;
    }
    learn(u0, u, f0);
  }
  now.asymmetry = memory.asymmetry;
  memory.steps++;
  memory.last = with_these;
  return true;
}

/** The step by what those before have left: false, and u as it was, where this does not lead to its end. */
bool MPMImplicit::go_on_from_before(std::vector<double> &u)
{
  recall();
  std::vector<double> foreseen = u;
  foresee(foreseen);
  by_levels = memory.levels;
  bool found = !large && go_on(foreseen);
  // levels are too many products to do without the present tangent
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
