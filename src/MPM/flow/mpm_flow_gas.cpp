/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_gas.h"

#include "field/mpm_node_system.h"
#include "flow/mpm_flow_pressure.h"
#include "flow/mpm_flow_regions.h"

#include "comm.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// share of its difference from the volume that points leave free by which a volume changes in a
// step
static constexpr double FOLLOWS = 0.02;
// least volume of a pocket, in cells; least volume after a step, over that before it
static constexpr double LEAST_VOLUME = 0.1, LEAST_CHANGE = 0.2;
// cells along each axis of a pocket that takes air from outside with it when it closes
static constexpr int LEAST_SIZE = 2;

MPMFlowGas::MPMFlowGas(LAMMPS *lmp, const MPMFlowLattice &cells, const MPMFlowPressure &water,
                       const MPMFlowGasLaw &law) :
    Pointers(lmp),
    pockets(lmp, cells), cells(cells), water(water), law(law)
{
}

double MPMFlowGas::stiffness(int pocket) const
{
  const auto &of = states[pocket];
  return of.amount > 0.0 ? law.gamma * pressure(of) / of.volume : 0.0;
}

/** Volumes that points leave free: of dry cells, and of wet ones next to these. */
void MPMFlowGas::find_left(const std::vector<double> &share)
{
  const int n = pockets.n(), naround = cells.lattice.dim == 2 ? 9 : 27;
  mine.assign(n, 0.0);
  left.resize(n);
  for (std::size_t k = 0; k < cells.cells.size(); k++) {
    const auto &cell = cells.cells[k];
    // shares in a closed cell at the level of the surface would have no counterpart below it
    if (water.regions && water.regions->is_closed(cell.number)) continue;
    const double fraction = water.regions ? water.regions->volume_fraction(cell.number) : 1.0;
    if (!water.is_wet(cell.number)) {
      const int pocket = pockets.pocket(cell.number);
      if (pocket >= 0) mine[pocket] -= share[cell.number] * fraction;
      continue;
    }
    const int *const around = cells.around.data() + k * naround;
    int many = 0;
    const auto each_next = [&](const auto &f) {
      for (int i = 0; i < naround; i++)
        if (around[i] >= 0 && !water.is_wet(around[i]) && pockets.pocket(around[i]) >= 0)
          f(pockets.pocket(around[i]));
    };
    each_next([&](int) {
      many++;
    });
    each_next([&](int pocket) {
      mine[pocket] += (1.0 - share[cell.number]) * fraction / many;
    });
  }
  sum_in_order(lmp, n, mine.data(), rank_sums, left.data());
  for (int k = 0; k < n; k++)
    left[k] = cells.lattice.cell_volume() * std::max(LEAST_VOLUME, left[k] + pockets.volume_of(k));
}

/** Rates at which volumes grow with velocities of faces. */
std::vector<double> MPMFlowGas::growth(const double *velocity)
{
  const int n = pockets.n();
  const double area = std::pow(cells.lattice.h, cells.lattice.dim - 1);
  std::vector<double> all(n);
  mine.assign(n, 0.0);
  water.visit_surface([&](const MPMFlowLattice::Cell &cell, int side, double) {
    const int pocket = pockets.pocket(cell.near[side]);
    const double flux = water.flux_of_side(velocity, cell, side);
    if (pocket >= 0) mine[pocket] += area * (side % 2 ? -flux : flux);
  });
  sum_in_order(lmp, n, mine.data(), rank_sums, all.data());
  return all;
}

void MPMFlowGas::find(const std::vector<double> &share, const double *velocity)
{
  const bool changed = pockets.find(water);
  find_left(share);
  if (changed || !is_known) {
    const auto rates = growth(velocity);
    if (is_known)
      hand_on(rates);
    else
      begin(rates);
    is_known = true;
  }
  const double least = LEAST_VOLUME * cells.lattice.cell_volume();
  for (int k = 0; k < n(); k++)
    if (has_gas(k))
      states[k].volume = std::max(least, states[k].volume + FOLLOWS * (left[k] - states[k].volume));
}

/** Gives gas of the pressure p to all pockets that are not open. */
void MPMFlowGas::begin(const std::vector<double> &rates)
{
  states.assign(pockets.n(), State());
  for (int k = 0; k < n(); k++) {
    states[k].open = pockets.is_open(k);
    if (states[k].open) continue;
    states[k].amount = states[k].volume = left[k];
    states[k].rate = rates[k];
  }
}

/* ----------------------------------------------------------------------
   Hands the gas of the former pockets to the present ones. Outside air that is closed in keeps its
   pressure. A pocket that opens within the fluid has no gas, and the pressure outside.
------------------------------------------------------------------------- */

void MPMFlowGas::hand_on(const std::vector<double> &rates)
{
  std::vector<State> before(pockets.n());
  before.swap(states);
  std::vector<double> given(before.size(), 0.0), got(n(), 0.0);
  for (const auto &share : pockets.overlaps()) {
    given[share.from] += (double) share.cells;
    got[share.to] += (double) share.cells;
  }
  const bigint least = cells.lattice.dim == 2 ? LEAST_SIZE * LEAST_SIZE
                                              : LEAST_SIZE * LEAST_SIZE * LEAST_SIZE;
  const double thicker = std::pow(law.outside / law.p, 1.0 / law.gamma);
  std::vector<char> is_new(n(), 0);
  for (int k = 0; k < n(); k++) {
    states[k].open = pockets.is_open(k);
    if (got[k] > 0.0 || states[k].open) continue;
    states[k].volume = left[k];
    is_new[k] = 1;
  }
  for (const auto &share : pockets.overlaps()) {
    const auto &from = before[share.from];
    auto &to = states[share.to];
    if (to.open) continue;
    if (from.open) {
      const double volume = left[share.to] * (double) share.cells / got[share.to];
      to.volume += volume;
      if (pockets.cells_of(share.to) >= least) to.amount += volume * thicker;
      is_new[share.to] = 1;
    } else {
      const double part = (double) share.cells / given[share.from];
      to.volume += part * from.volume;
      to.amount += part * from.amount;
      to.rate += part * from.rate;
    }
  }
  for (int k = 0; k < n(); k++)
    if (is_new[k]) states[k].rate = rates[k];
}

void MPMFlowGas::move(const double *velocity, double dt)
{
  const auto rates = growth(velocity);
  const double least = LEAST_VOLUME * cells.lattice.cell_volume();
  for (int k = 0; k < n(); k++) {
    auto &of = states[k];
    if (of.open) continue;
    of.rate = rates[k];
    of.volume = std::max({least, LEAST_CHANGE * of.volume, of.volume + dt * of.rate});
  }
}

/* ---------------------------------------------------------------------- */

int MPMFlowGas::count() const
{
  int many = 0;
  for (int k = 0; k < n(); k++) many += has_gas(k);
  return many;
}

double MPMFlowGas::highest() const
{
  double most = 0.0;
  for (int k = 0; k < n(); k++)
    if (has_gas(k)) most = std::max(most, pressure(states[k]));
  return most;
}

double MPMFlowGas::lowest() const
{
  double least = highest();
  for (int k = 0; k < n(); k++)
    if (has_gas(k)) least = std::min(least, pressure(states[k]));
  return least;
}

double MPMFlowGas::volume() const
{
  double sum = 0.0;
  for (int k = 0; k < n(); k++)
    if (has_gas(k)) sum += states[k].volume;
  return sum;
}

double MPMFlowGas::energy() const
{
  double sum = 0.0;
  for (int k = 0; k < n(); k++) {
    if (!has_gas(k)) continue;
    const auto &of = states[k];
    sum += law.gamma == 1.0 ? law.p * of.amount * std::log(of.amount / of.volume)
                            : (pressure(of) * of.volume - law.p * of.amount) / (law.gamma - 1.0);
    sum += law.outside * (of.volume - of.amount);
  }
  return sum;
}

/* ---------------------------------------------------------------------- */

std::vector<double> MPMFlowGas::restart_data() const
{
  std::vector<double> all = {(double) is_known, (double) n()};
  for (const auto &of : states)
    all.insert(all.end(), {of.amount, of.volume, of.rate, (double) of.open});
  const auto runs = pockets.runs();
  all.insert(all.end(), runs.begin(), runs.end());
  return all;
}

bool MPMFlowGas::restart(const double *from, std::size_t n)
{
  if (n < 2 || from[0] == 0.0) return true;
  const double *const end = from + n;
  states.resize((std::size_t) from[1]);
  from += 2;
  for (auto &of : states) {
    of = {from[0], from[1], from[2], from[3] != 0.0};
    from += 4;
  }
  is_known = true;
  return pockets.set_runs(from, end - from);
}

/* ---------------------------------------------------------------------- */

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
