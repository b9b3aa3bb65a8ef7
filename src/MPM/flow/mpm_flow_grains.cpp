/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_grains.h"

#include "flow/mpm_flow_stencil.h"
#include "grains/fix_mpm_immersed.h"

#include "atom.h"
#include "force.h"
#include "math_extra.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// filled share of a face from which on the face has its full weight
static constexpr double HALF = 0.5;
// sum of weights below which a grain is in the air
static constexpr double NOTHING = 1.0e-10;
// order of the splines by which volumes of grains are mapped
static constexpr int ORDER = 2;
// relative change of the slip in finding the slope of the drag
static constexpr double CHANGE = 1.0e-4;

MPMFlowGrains::MPMFlowGrains(LAMMPS *lmp, MPMFlowLattice &cells, const std::string &flow,
                             double density) :
    Pointers(lmp),
    density(density), cells(cells)
{
  for (auto *ifix : modify->get_fix_by_style("^mpm/immersed$")) {
    auto *const fix = dynamic_cast<FixMPMImmersed *>(ifix);
    if (fix && fix->fluid() == flow) fixes.push_back(fix);
  }
}

void MPMFlowGrains::list()
{
  std::vector<std::pair<tagint, std::pair<int, int>>> all;
  for (int kind = 0; kind < (int) fixes.size(); kind++)
    for (int i = 0; i < atom->nlocal; i++)
      if (fixes[kind]->is_grain(i)) all.push_back({atom->tag[i], {i, kind}});
  std::sort(all.begin(), all.end());
  cells.visitors.clear();
  kind_of.clear();
  for (const auto &one : all) {
    cells.visitors.push_back(one.second.first);
    kind_of.push_back(one.second.second);
  }
}

/** Factors of the weights of faces. Images beyond walls have those of the faces inside. */
void MPMFlowGrains::find_filled(const std::vector<double> &point_sums)
{
  const int dim = cells.lattice.dim, width = 3 * dim + 1;
  const double full = density * cells.lattice.cell_volume();
  filled.resize(cells.size() * dim);
  for (int64_t k = 0; k < cells.size(); k++)
    for (int c = 0; c < dim; c++)
      filled[k * dim + c] = std::min(1.0, point_sums[k * width + dim + c] / (HALF * full));
  std::vector<double> images = filled;
  cells.reflect_velocities(images.data(), false);
  for (std::size_t k = 0; k < filled.size(); k++)
    if (filled[k] == 0.0) filled[k] = std::fabs(images[k]);
}

/** Finds the weights of a grain; false if there is no fluid around it. */
template <int dim> bool MPMFlowGrains::find(Grain &g, const std::vector<double> &share) const
{
  double t[3];
  int base[3];
  for (int d = 0; d < dim; d++)
    t[d] = (atom->x[g.i][d] - cells.lattice.origin[d]) / cells.lattice.h;
  g.w.find<dim>(t);
  g.slot = cells.find_block(atom->x[g.i], base);
  if (g.slot < 0) return false;
  const MPMFlowStencil<dim> reach(cells.grid, cells.grid.blocks[g.slot], g.w.base);
  double around = 0.0;
  std::fill_n(g.weight_sums, 3, 0.0);
  visit<dim>(reach, [&](int64_t number, const int k[3]) {
    around += g.w.cell<dim>(k) * share[number];
    for (int c = 0; c < dim; c++)
      g.weight_sums[c] += g.w.face<dim>(c, k) * filled[number * dim + c];
  });
  g.immersed = std::min(1.0, 2.0 * around);
  return g.immersed > NOTHING && *std::min_element(g.weight_sums, g.weight_sums + dim) > NOTHING;
}

template <int dim>
void MPMFlowGrains::interpolate(const Grain &g, const double *values, double *v) const
{
  const MPMFlowStencil<dim> reach(cells.grid, cells.grid.blocks[g.slot], g.w.base);
  std::fill_n(v, 3, 0.0);
  visit<dim>(reach, [&](int64_t number, const int k[3]) {
    for (int c = 0; c < dim; c++)
      v[c] += g.w.face<dim>(c, k) * filled[number * dim + c] * values[number * dim + c];
  });
  for (int c = 0; c < dim; c++) v[c] /= g.weight_sums[c];
}

namespace {
/** Quadratic splines about the middles of cells, of the cells first, first + 1, and first + 2. */
template <int dim> struct Splines {
  int first[3];
  double share[3][3], r[3];    // r: from the middle of the first cell, in spacings
  MPMFlowStencil<dim> reach;

  Splines(const MPMFlowLattice &cells, const StaggeredWeights &w, int slot)
  {
    for (int d = 0; d < dim; d++) {
      const int up = w.f[d] < 0.5 ? 0 : 1;
      const double x = w.f[d] - up;    // from the nearest cell
      first[d] = w.base[d] + up - 1;
      r[d] = x + 1.0;
      share[d][0] = 0.5 * (0.5 - x) * (0.5 - x);
      share[d][1] = 0.75 - x * x;
      share[d][2] = 0.5 * (0.5 + x) * (0.5 + x);
    }
    reach = {cells.grid, cells.grid.blocks[slot], first};
  }
  template <class F> void visit(const F &f) const
  {
    for_each_index<dim>({3, 3, 3}, [&](const int *k) {
      double weight = 1.0;
      for (int d = 0; d < dim; d++) weight *= share[d][k[d]];
      f(reach.number(k), weight, k);
    });
  }
};
}    // namespace

template <int dim> void MPMFlowGrains::add_volume(const Grain &g)
{
  const int width = 3 * dim + 1;
  const double share = fixes[g.kind]->volume(g.i) / cells.lattice.cell_volume();
  Splines<dim>(cells, g.w, g.slot).visit([&](int64_t number, double weight, const int *) {
    sums[number * width + 3 * dim] += weight * share;
  });
}

/** Share of solid around a grain. moment: sum N r of the same, in spacings. */
template <int dim> double MPMFlowGrains::share_around(const Grain &g, double *moment) const
{
  const Splines<dim> splines(cells, g.w, g.slot);
  double all = 0.0;
  std::fill_n(moment, 3, 0.0);
  splines.visit([&](int64_t number, double weight, const int k[3]) {
    const double share = weight * solid[number];
    all += share;
    for (int d = 0; d < dim; d++) moment[d] += share * (splines.r[d] - k[d]);
  });
  return all;
}

/* ----------------------------------------------------------------------
   F = K w + M [(U' - U)/dt - g] with w = U' - v, v = v* + dt F/m. K w is linearized about the slip
   that is left when U' = U, so that laws that grow with the square of the slip do not oscillate.
------------------------------------------------------------------------- */

template <int dim> void MPMFlowGrains::find_force(Grain &g)
{
  const auto &fix = *fixes[g.kind];
  const double *const gravity = fix.acceleration_of_gravity();
  double moment[3], v[3], slip[3] = {0.0, 0.0, 0.0};
  const double volume = fix.volume(g.i), ahead = fix.steps_ahead(g.i, g.mass);
  const double solid_here = fix.end_of_bed(share_around<dim>(g, moment), moment, volume, ORDER,
                                           cells.lattice.cell_volume());
  g.displaced = g.immersed * density * volume;
  for (int d = 0; d < dim; d++) {
    v[d] = atom->v[g.i][d];
    if (std::isfinite(g.mass)) v[d] += ahead * update->dt * force->ftm2v * atom->f[g.i][d] / g.mass;
    slip[d] = g.before[d] - v[d] + duration * g.displaced * gravity[d] / g.mass;
  }
  const double diameter = 2.0 * atom->radius[g.i], w = MathExtra::len3(slip),
               slowing = g.immersed * duration / g.mass;
  const double K = g.immersed * fix.drag_after_step(diameter, w, solid_here, slowing);
  const double left = 1.0 / (1.0 + slowing * (g.immersed > 0.0 ? K / g.immersed : 0.0));
  const double near = fix.drag_after_step(diameter, left * w, solid_here, 0.0),
               beyond = fix.drag_after_step(diameter, (1.0 + CHANGE) * left * w, solid_here, 0.0);
  const double steeper =
      std::max(0.0, std::min(g.immersed * (beyond - near) / CHANGE, K));    // w dK/dw

  const double stiff = K + steeper, held = 1.0 / (1.0 + stiff * duration / g.mass);
  for (int d = 0; d < dim; d++)
    g.least[d] =
        held * (stiff * (g.before[d] - v[d]) - steeper * left * slip[d] - g.displaced * gravity[d]);
  g.rate = held * (stiff + g.displaced / duration);

  // The fluid that a grain displaces has mass and weight on the lattice. If it is not to have
  // these, it gets back the parts of both that it does not need: the force of the pressure around a
  // grain, which moves and bears the fluid in its place

  const double without = fix.displaces() ? g.displaced : 0.0;
  const int width = 3 * dim + 1;
  const MPMFlowStencil<dim> reach(cells.grid, cells.grid.blocks[g.slot], g.w.base);
  visit<dim>(reach, [&](int64_t number, const int k[3]) {
    double *const to = sums.data() + number * width;
    for (int c = 0; c < dim; c++) {
      const double weight = g.w.face<dim>(c, k) / g.weight_sums[c];
      to[dim + c] += weight * (g.rate - without / duration);
      to[2 * dim + c] += weight * (g.least[c] + without * gravity[c]);
    }
  });
}

template <int dim>
void MPMFlowGrains::find_all(const std::vector<double> &share, const std::vector<double> &before)
{
  const int width = 3 * dim + 1;
  grains.clear();
  sums.assign(cells.size() * width, 0.0);
  for (std::size_t k = 0; k < cells.visitors.size(); k++) {
    Grain g = {};
    g.i = cells.visitors[k];
    g.kind = kind_of[k];
    if (!find<dim>(g, share)) continue;
    interpolate<dim>(g, before.data(), g.before);
    add_volume<dim>(g);
    grains.push_back(g);
  }
  cells.sum(sums.data(), width);
  solid.resize(cells.size());
  for (int64_t k = 0; k < cells.size(); k++) solid[k] = sums[k * width + 3 * dim];
  cells.reflect_cells(solid.data());
  std::fill(sums.begin(), sums.end(), 0.0);
  for (auto &g : grains) find_force<dim>(g);
  cells.sum(sums.data(), width);
}

/* ---------------------------------------------------------------------- */

void MPMFlowGrains::begin(double time, const std::vector<double> &point_sums,
                          const std::vector<double> &share, const std::vector<double> &before,
                          std::vector<double> &velocity)
{
  const int dim = cells.lattice.dim, width = 3 * dim + 1;
  duration = time;
  find_filled(point_sums);
  dim == 2 ? find_all<2>(share, before) : find_all<3>(share, before);

  face_mobility.assign(cells.size() * dim, 1.0);
  for (int64_t k = 0; k < cells.size(); k++)
    for (int c = 0; c < dim; c++) {
      const double mass = point_sums[k * width + dim + c];
      if (!(mass > 0.0)) continue;
      const int64_t face = k * dim + c;
      const double per_mass = duration * filled[face] / mass;
      const double mobile = 1.0 / (1.0 + per_mass * sums[k * width + dim + c]);
      velocity[face] = before[face] +
          mobile * (velocity[face] - before[face] - per_mass * sums[k * width + 2 * dim + c]);
      face_mobility[face] = mobile;
    }
  cells.reflect_velocities(velocity.data());
}

template <int dim> void MPMFlowGrains::go_on(const std::vector<double> &velocity)
{
  for (const auto &g : grains) {
    auto &fix = *fixes[g.kind];
    const double *const gravity = fix.acceleration_of_gravity();
    double gain[3], impulse[3] = {0.0, 0.0, 0.0};
    interpolate<dim>(g, velocity.data(), gain);
    auto &kind = kinds[g.kind];
    kind.count++;
    for (int d = 0; d < dim; d++) {
      gain[d] -= g.before[d];
      impulse[d] = duration * (g.least[d] + g.rate * gain[d]);
      const double buoyancy = g.displaced * (gain[d] - duration * gravity[d]);
      kind.impulses[d] += impulse[d] - buoyancy;
      kind.impulses[3 + d] += buoyancy;
    }
    fix.push(g.i, g.mass, impulse);
  }
}

void MPMFlowGrains::end(const std::vector<double> &velocity)
{
  kinds.assign(fixes.size(), {});
  cells.lattice.dim == 2 ? go_on<2>(velocity) : go_on<3>(velocity);
  for (std::size_t k = 0; k < fixes.size(); k++)
    fixes[k]->was_pushed(kinds[k].count, kinds[k].impulses, duration);
}

/* ----------------------------------------------------------------------
   The force on the faces next to a wall bends the pressure, but the half of a cell at the wall has
   no such force.
------------------------------------------------------------------------- */

double MPMFlowGrains::at_wall(int axis, int side, const std::vector<double> &before,
                              const std::vector<double> &velocity) const
{
  const int dim = cells.lattice.dim, width = 3 * dim + 1;
  const auto on_grains = [&](int64_t cell) {
    const int64_t face = cell * dim + axis;
    const double *const sum = &sums[cell * width];
    return filled[face] * (sum[2 * dim + axis] + sum[dim + axis] * (velocity[face] - before[face]));
  };
  double all = 0.0;
  for (const auto &cell : cells.cells) {
    if (!(cell.walls >> (2 * axis + side) & 1)) continue;
    const int upper = cell.near[2 * axis + 1];
    all += on_grains(side ? upper : cell.number);
    if (!(cell.walls >> (2 * axis + 1 - side) & 1))
      all -= 0.5 * on_grains(side ? cell.number : upper);
  }
  return side ? -all : all;
}
