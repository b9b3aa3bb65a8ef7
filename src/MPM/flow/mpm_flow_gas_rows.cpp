/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_gas_rows.h"

#include "field/mpm_node_system.h"
#include "flow/mpm_flow_pressure.h"

#include "comm.h"

#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

void MPMFlowGasRows::begin(double step, double pressure_to_psi,
                           const std::vector<double> *surface_tension)
{
  const int n = gas.n();
  duration = step;
  tension = surface_tension;
  psi.resize(n);
  stiffness.resize(n);
  for (int k = 0; k < n; k++) {
    const double softness = pressure_to_psi * gas.stiffness(k);
    psi[k] = pressure_to_psi * gas.over(k) + BEFORE * softness * duration * gas.rate(k);
    stiffness[k] = NOW * softness;
  }
  fill();
}

/** Copies pressures of pockets to their faces. */
void MPMFlowGasRows::fill()
{
  const int dim = cells.lattice.dim;
  surface.assign(cells.size() * dim, 0.0);
  for (const auto &cell : cells.cells)
    for (int d = 0; d < dim; d++) {
      const int here = cell.number, lower = cell.near[2 * d];
      if (cell.walls >> 2 * d & 1 || water.is_wet(here) == water.is_wet(lower)) continue;
      const int pocket = gas.pockets.pocket(water.is_wet(here) ? lower : here);
      const int64_t face = (int64_t) here * dim + d;
      surface[face] = (pocket >= 0 ? psi[pocket] : 0.0) + (tension ? (*tension)[face] : 0.0);
    }
  cells.publish(surface.data(), dim);
}

void MPMFlowGasRows::load(const double *velocity, const std::vector<double> &lift,
                          std::vector<double> &right_side)
{
  const int n = gas.n(), dim = cells.lattice.dim;
  const double h = cells.lattice.h, area = std::pow(h, dim - 1);
  entries.clear();
  mine.assign(3 * n, 0.0);
  water.visit_surface([&](const MPMFlowLattice::Cell &cell, int side, double weight) {
    const int pocket = gas.pockets.pocket(cell.near[side]);
    if (pocket < 0 || !gas.has_gas(pocket)) return;
    const int64_t face = (int64_t) (side % 2 ? cell.near[side] : cell.number) * dim + side / 2;
    const double flux = water.flux_of_side(velocity, cell, side);
    mine[3 * pocket] += side % 2 ? flux : -flux;
    mine[3 * pocket + 1] += weight * (lift[cell.number] - surface[face]);
    mine[3 * pocket + 2] += weight;
    entries.push_back({cell.number, pocket, weight});
  });
  all.resize(3 * n);
  sum_in_order(lmp, 3 * n, mine.data(), rank_sums, all.data());
  for (int k = 0; k < n; k++) {
    double *const of = &all[3 * k];
    const double per_velocity = stiffness[k] * duration * area, change = per_velocity * h,
                 one = 1.0 + change * of[2];
    of[0] = (per_velocity * of[0] + change * of[1]) / one;
    of[1] = of[2] = change / one;
  }
  for (const auto &entry : entries) right_side[entry.wet] += entry.weight * all[3 * entry.pocket];
}

void MPMFlowGasRows::arrange(const MPMFlowRows &rows)
{
  places.clear();
  std::vector<int> place_of(entries.empty() ? 0 : cells.size(), -1);
  for (int i = 0; i < rows.size() && !place_of.empty(); i++) place_of[rows.cell_at(i)] = i;
  for (const auto &entry : entries)
    places.push_back({place_of[entry.wet], entry.pocket, entry.weight});
}

/** Products s.x of pockets. */
const double *MPMFlowGasRows::sum(const double *x)
{
  const int n = gas.n();
  mine.assign(n, 0.0);
  sums.resize(n);
  for (const auto &at : places) mine[at.pocket] += at.weight * x[at.place];
  sum_in_order(lmp, n, mine.data(), rank_sums, sums.data());
  return sums.data();
}

void MPMFlowGasRows::add(const double *x, double *y)
{
  const double *const pocket_sums = sum(x);
  for (const auto &at : places)
    y[at.place] -= at.weight * all[3 * at.pocket + 1] * pocket_sums[at.pocket];
}

void MPMFlowGasRows::end(const double *x)
{
  const double *const pocket_sums = sum(x);
  for (int k = 0; k < gas.n(); k++) psi[k] += all[3 * k] + all[3 * k + 1] * pocket_sums[k];
  fill();
}

double MPMFlowGasRows::at_wall(int axis, int side) const
{
  double sum = 0.0;
  for (int k = 0; k < gas.n(); k++) sum += gas.pockets.cells_at(k, axis, side) * psi[k];
  return sum * std::pow(cells.lattice.h, cells.lattice.dim - 1);
}

/** The surface of a pocket is zero as a vector sum: a region has the part that water and box do not
 *  have. */
void MPMFlowGasRows::add_to_region(double *force) const
{
  const int dim = cells.lattice.dim;
  const double area = std::pow(cells.lattice.h, dim - 1);
  water.visit_surface([&](const MPMFlowLattice::Cell &cell, int side, double) {
    const int pocket = gas.pockets.pocket(cell.near[side]);
    const int64_t of = side % 2 ? cell.near[side] : cell.number;
    if (pocket >= 0)
      force[side / 2] += (side % 2 ? area : -area) * water.aperture(of, side / 2) * psi[pocket];
  });
  if (lmp->comm->me == 0)
    for (int d = 0; d < dim; d++) force[d] += at_wall(d, 0) - at_wall(d, 1);
}

double MPMFlowGasRows::memory_usage() const
{
  double reals = 0.0;
  for (const auto *list : {&surface, &psi, &stiffness, &all, &mine, &sums, &rank_sums})
    reals += list->capacity();
  return reals * sizeof(double) + entries.capacity() * sizeof(Entry) +
      places.capacity() * sizeof(Place);
}
