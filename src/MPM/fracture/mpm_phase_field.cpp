/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fracture/mpm_phase_field.h"

#include "atom.h"
#include "base/mpm_lists.h"
#include "comm.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_passes.h"
#include "law/phase_field.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;
using law::Degradation;
using law::PhaseField;

// B over twice GC/(c0 l): with 20 to 1000, energies of cracks differ by .4 %
static constexpr double BARRIER = 100.0;
// share of the driving energy at which d begins to grow, and d, from which on points are looked at
static constexpr double SOUND = 0.81, CRACKED = 0.25, BROKEN = 0.998;
// residual of linear equations, as those before and after are coarse
static constexpr double RESIDUAL = 0.1;
static constexpr int MOST_PRODUCTS = 300;

MPMPhaseField::MPMPhaseField(LAMMPS *lmp, MPMField &field) :
    MPMNodeSystem(lmp, field.grid, 1), field(field), scalar(field)
{
  scalar.init(false, false);
  // of one-dimensional functions, quadratic ones: 11/20 and 1; the preconditioner need not be exact
  const int dim = field.lattice.dim;
  of_values = std::pow(0.55, dim);
  of_gradients = dim * std::pow(0.55, dim - 1);
}

void MPMPhaseField::add(const FixMPMMaterial *material, const Cracks &cracks)
{
  cracks_of[material] = cracks;
}

/** May d of a point grow? */
bool MPMPhaseField::is_active(const Cracks &c, const double *history) const
{
  const double phase = history[c.phase], driving = history[c.driving];
  if (!(driving > 0.0) || phase > BROKEN) return false;
  const double a = c.shape < 0 ? PhaseField::SQUARE : history[c.shape];
  const double at_rest = c.xi * history[c.toughness];    // g' w_p + GC/(c0 l) w' at d = 0
  return a * driving >= (phase > 0.0 ? CRACKED : SOUND) * at_rest;
}

/** Blocks with points whose d may grow, of any rank, and those next to them. Returns whether there
 *  are any. Collective. */
bool MPMPhaseField::find_region()
{
  const Grid &grid = field.grid;
  std::vector<int> mine;    // coordinates of blocks
  for (const auto &a : field.map->active) {
    bool active = false;
    for (int k = a.first_run; k < a.last_run && !active; k++) {
      const auto &run = field.map->runs[k];
      const Cracks *const c = cracks(run);
      for (int i = run.first; c && i < run.last && !active; i++)
        active = is_active(*c, run.material->history[i]);
    }
    if (active) mine.insert(mine.end(), grid.blocks[a.slot].b, grid.blocks[a.slot].b + 3);
  }
  int n = (int) mine.size(), all = 0;
  std::vector<int> counts(lmp->comm->nprocs), first(counts.size() + 1, 0);
  MPI_Allgather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, lmp->world);
  for (std::size_t p = 0; p < counts.size(); p++) first[p + 1] = all += counts[p];
  if (all == 0) return false;
  std::vector<int> of_all(all);
  MPI_Allgatherv(mine.data(), n, MPI_INT, of_all.data(), counts.data(), first.data(), MPI_INT,
                 lmp->world);
  near.assign(grid.blocks.size(), 0);
  const auto &lattice = field.lattice;
  for (int k = 0; k < all; k += 3) {
    // blocks that have nodes next to this one; at periodic faces also those of images
    std::vector<int> along[3];
    for (int a = 0; a < 3; a++) {
      const int b = of_all[k + a];
      along[a] = {b};
      if (a >= lattice.dim) continue;
      along[a] = {b - 1, b, b + 1};
      if (!lattice.periodic[a]) continue;
      for (const int image : {-lattice.ncell[a], lattice.ncell[a]})
        for (const int node : {grid.side * (b - 1), grid.side * (b + 2) - 1})
          along[a].push_back((node + image) >> grid.shift_bits);
    }
    for (const int x : along[0])
      for (const int y : along[1])
        for (const int z : along[2]) {
          const int b[3] = {x, y, z};
          const int slot = grid.find(b);
          if (slot >= 0) near[slot] = 1;
        }
  }
  return true;
}

/** Residual of all nodes at d, and the second derivatives of the points. Returns the largest change
 *  of d at a point since the last call. Collective. */
double MPMPhaseField::find_residual(bool first)
{
  double mine = 0.0, most;
  scalar.value = d;
  scalar.find_rates([&](const Run &run, int begin, int n, MPMNodeScalar::Rows q) {
    const Cracks &c = *cracks(run);
    const PhaseField f = {c.xi, c.c0};
    for (int p = 0; p < n; p++) {
      const int i = begin + p;
      const double *const history = run.material->history[i];
      const double V = field.atom->vfrac[i], k = history[c.toughness], old = history[c.phase];
      const double a = c.shape < 0 ? PhaseField::SQUARE : history[c.shape];
      const double now = q[p][3], inside = std::min(1.0, std::max(0.0, now));
      const Degradation g(inside, a);
      const double barrier = 2.0 * BARRIER * k;
      double force = g.slope * history[c.driving] + k * f.slope(inside);
      // where w(d) is concave, its tangent is above it: what is solved for then only falls
      double stiff =
          std::max(0.0, g.curvature * history[c.driving]) + k * std::max(0.0, f.curvature());
      if (inside - force / barrier < old) stiff += barrier;
      if (now < old) force -= barrier * (old - now);
      if (!first) mine = std::max(mine, std::fabs(now - value[i]));
      value[i] = now;
      stiffness[i] = V * stiff;
      const double along = -2.0 * V * k * c.length * c.length;
      for (int e = 0; e < 3; e++) q[p][e] *= along;
      q[p][3] = -V * force;
    }
  });
  residual.resize(d.size());
  for (std::size_t n = 0; n < d.size(); n++) residual[n] = scalar.capacity[n] * scalar.rate[n];
  MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE, MPI_MAX, lmp->world);
  return most;
}

/** For the preconditioner, with mean values of the functions of the shape. */
void MPMPhaseField::find_diagonal()
{
  const double inv_h2 = 1.0 / (field.lattice.h * field.lattice.h);
  scalar.add_up(
      [&](const Run &run, int begin, int n, double *values) {
        const Cracks &c = *cracks(run);
        for (int p = 0; p < n; p++) {
          const int i = begin + p;
          const double along = 2.0 * field.atom->vfrac[i] * run.material->history[i][c.toughness] *
              c.length * c.length;
          values[p] = of_values * stiffness[i] + of_gradients * inv_h2 * along;
        }
      },
      diagonal);
}

void MPMPhaseField::apply(const double *x, double *y)
{
  products++;
  scalar.value.assign(x, x + size());
  scalar.find_rates([&](const Run &run, int begin, int n, MPMNodeScalar::Rows q) {
    const Cracks &c = *cracks(run);
    for (int p = 0; p < n; p++) {
      const int i = begin + p;
      const double along =
          2.0 * field.atom->vfrac[i] * run.material->history[i][c.toughness] * c.length * c.length;
      for (int e = 0; e < 3; e++) q[p][e] *= along;
      q[p][3] *= stiffness[i];
    }
  });
  for (int64_t n = 0; n < size(); n++) y[n] = scalar.capacity[n] * scalar.rate[n];
}

void MPMPhaseField::precondition(const double *r, double *z)
{
  for (int64_t n = 0; n < size(); n++) z[n] = diagonal[n] > 0.0 ? r[n] / diagonal[n] : 0.0;
}

void MPMPhaseField::set_points()
{
  each_point(field, [&](const Run &run, int i) {
    const Cracks *const c = cracks(run);
    if (!c || !near[run.slot]) return;
    double &phase = run.material->history[i][c->phase];
    phase = std::max(phase, std::min(1.0, value[i]));
  });
}

std::string MPMPhaseField::solve(const Goal &goal)
{
  report = {};
  products = 0;
  if (!find_region()) return {};
  value.resize(field.atom->nmax);
  stiffness.resize(field.atom->nmax);
  double counts[2] = {0.0, 0.0}, all[2];
  each_point(field, [&](const Run &run, int) {
    if (!cracks(run)) return;
    counts[0] += near[run.slot];
    counts[1] += 1.0;
  });
  MPI_Allreduce(counts, all, 2, MPI_DOUBLE, MPI_SUM, lmp->world);
  report.share = all[0] / all[1];

  scalar.points_to_nodes(
      [&](const Run &run, int begin, int n, MPMNodeScalar::Points &points) {
        const Cracks *const c = cracks(run);
        if (!c || !near[run.slot]) return false;
        for (int p = 0; p < n; p++) {
          points.row[p][3] = run.material->history[begin + p][c->phase];
          points.capacity[p] = field.atom->vfrac[begin + p];
        }
        return true;
      },
      false);
  d = scalar.value;
  while (true) {
    const double changed = find_residual(report.newton == 0);
    if (report.newton == goal.most || (report.newton > 0 && changed <= goal.tolerance)) break;
    find_diagonal();
    change.assign(d.size(), 0.0);
    const SolveGoal of_step = {RESIDUAL, 0.0, MOST_PRODUCTS, true};
    const auto solved = conjugate.solve(*this, residual.data(), change.data(), of_step);
    if (solved.outcome == SolveReport::NOT_FINITE || solved.outcome == SolveReport::INDEFINITE)
      return "the linear system " + solved.describe();
    for (std::size_t n = 0; n < d.size(); n++) d[n] += change[n];
    report.newton++;
  }
  report.products = products;
  set_points();
  return {};
}

double MPMPhaseField::memory_usage() const
{
  return scalar.memory_usage() + conjugate.memory_usage() +
      bytes_of(near, d, change, residual, diagonal, value, stiffness);
}
