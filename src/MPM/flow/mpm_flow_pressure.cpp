/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_pressure.h"

#include "flow/mpm_flow_bodies.h"
#include "flow/mpm_flow_gas.h"
#include "flow/mpm_flow_regions.h"

#include "lammps.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// distance over which points make room for others, in spacings
static constexpr double SPREAD = 8.0;
// share of the surroundings of a cell, and mean share of its neighbors, from which on the cell is
// wet. Water that ends in the middle of cells fills one half of them but for round-off, which must
// not decide: it depends on the number of ranks
static constexpr double HALF = 0.5 + 1.0e-9, SURROUNDED = 0.6;
// excess of points in a cell cut by a region that may not be real: points come in steps there, and
// walls do not
static constexpr double UNSURE = 0.25;
// open share of the surroundings of a cell below which its neighbors decide whether it is wet, if
// it has a least share of water
static constexpr double OPEN_VOLUME = 0.5, LEAST = 0.2;

/** Depth below a flat surface, in spacings, at which a hat function is filled by this share. */
static double depth(double share)
{
  if (share < 0.5) return std::sqrt(2.0 * std::max(share, 0.0)) - 1.0;
  return 1.0 - std::sqrt(2.0 * std::max(1.0 - share, 0.0));
}

double MPMFlowPressure::distance(int64_t wet_cell, int64_t dry) const
{
  if (!(filled[wet_cell] > HALF)) return 0.5;    // surrounded: the place of the surface is unknown
  const double in = depth(filled[wet_cell]), out = depth(filled[dry]);
  return std::max(nearest, in / (in - out));
}

double MPMFlowPressure::aperture(int64_t cell, int axis) const
{
  return regions ? regions->aperture(cell, axis) : 1.0;
}

/** Open share of a side of a cell, also of one in a wall of the box. */
double MPMFlowPressure::aperture_of_side(const MPMFlowLattice::Cell &cell, int side) const
{
  return aperture(side % 2 ? cell.near[side] : cell.number, side / 2);
}

double MPMFlowPressure::density_in(const MPMFlowLattice::Cell &cell) const
{
  if (!inverse_density) return 1.0;
  double sum = 0.0, sides = 0.0;
  for (int s = 0; s < 2 * cells.lattice.dim; s++) {
    const double side = aperture_of_side(cell, s);
    if (side == 0.0) continue;
    sum += side / light(s % 2 ? cell.near[s] : cell.number, s / 2);
    sides += side;
  }
  return sides > 0.0 ? sum / sides : 1.0;
}

double MPMFlowPressure::flux_of_side(const double *velocity, const MPMFlowLattice::Cell &cell,
                                     int side) const
{
  const int axis = side / 2;
  const int64_t of = side % 2 ? cell.near[side] : cell.number;
  const bool wall = cell.walls >> side & 1;
  const double u = wall ? 0.0 : velocity[of * cells.lattice.dim + axis];
  return regions ? regions->aperture(of, axis) * u + regions->flux(of, axis) : u;
}

/** Are the neighbors of a cell filled so well that the cell between them is water? At a flat
 *  surface, their mean is the share of the cell itself. */
bool MPMFlowPressure::is_surrounded(const MPMFlowLattice::Cell &cell) const
{
  double sum = 0.0, sides = 0.0;
  for (int s = 0; s < 2 * cells.lattice.dim; s++) {
    if (cell.walls >> s & 1) continue;
    const double side = aperture_of_side(cell, s);
    sides += side;
    sum += side * std::min(2.0, filled[cell.near[s]]);
  }
  return sum > SURROUNDED * sides;
}

/** A cell next to a wall can have too little room for points to show that it is full: it is wet if
 *  most of its open sides are next to wet cells. */
void MPMFlowPressure::follow_neighbors()
{
  std::vector<int> changed;
  for (const auto &cell : cells.cells) {
    if (regions->volume_fraction(cell.number) > OPEN_VOLUME || regions->is_closed(cell.number) ||
        is_wet(cell.number) || filled[cell.number] < LEAST)
      continue;
    double wet_sides = 0.0, sides = 0.0;
    for (int s = 0; s < 2 * cells.lattice.dim; s++) {
      if (cell.walls >> s & 1) continue;
      const double side = aperture_of_side(cell, s);
      sides += side;
      if (is_wet(cell.near[s])) wet_sides += side;
    }
    if (wet_sides > 0.5 * sides) changed.push_back(cell.number);
  }
  for (const int number : changed) flag[number] = 1.0;
  cells.keep_owned(flag.data(), 1);
  cells.publish(flag.data(), 1);
}

void MPMFlowPressure::find_wet(const std::vector<double> &share)
{
  filled = share.data();
  flag.assign(cells.size(), 0.0);
  for (const auto &cell : cells.cells)
    if (!(regions && regions->is_closed(cell.number)))
      flag[cell.number] = share[cell.number] > HALF || is_surrounded(cell) ? 1.0 : 0.0;
  cells.publish(flag.data(), 1);
  if (regions) follow_neighbors();
  cells.reflect_cells(flag.data());
  mobility = nullptr;
  find_weights();
}

void MPMFlowPressure::set_mobility(const std::vector<double> *faces)
{
  mobility = faces;
  find_weights();
}

/** Finds the equations of the wet cells. */
void MPMFlowPressure::find_weights()
{
  wet.clear();
  const int sides = 2 * cells.lattice.dim;
  for (int k = 0; k < (int) cells.cells.size(); k++) {
    const auto &cell = cells.cells[k];
    if (!is_wet(cell.number)) continue;
    Wet one;
    one.cell = k;
    one.diagonal = 0.0;
    for (int s = 0; s < sides; s++) {
      const int other = cell.near[s];
      const double side = cell.walls >> s & 1 ? 0.0 : aperture_of_side(cell, s);
      const bool wall = side == 0.0;
      one.weight[s] = wall ? 0.0 : side * weight_to(cell.number, other);
      if (!wall) one.weight[s] *= light(s % 2 ? other : cell.number, s / 2);
      if (mobility)
        one.weight[s] *=
            (*mobility)[(int64_t) (s % 2 ? other : cell.number) * cells.lattice.dim + s / 2];
      one.near[s] = !wall && is_wet(other) ? other : -1;
      one.diagonal += one.weight[s];
    }
    if (one.diagonal == 0.0) one.diagonal = 1.0;    // walls all around
    wet.push_back(one);
  }
  rows_are_there = levels_are_there = false;
}

/** Finds which rank has which rows, and what ranks send each other. */
void MPMFlowPressure::find_rows()
{
  if (rows_are_there) return;
  rows.begin();
  for (const auto &one : wet) rows.add(cells.cells[one.cell].number, one.near);
  rows.arrange();
  rows_are_there = true;
}

/** Sorts the equations by rows; screen: 1/length^2. */
void MPMFlowPressure::weigh_rows(double screen, std::vector<double> &to_diagonal,
                                 std::vector<double> &to_weight) const
{
  const int sides = rows.sides();
  to_diagonal.resize(rows.size());
  to_weight.resize((std::size_t) rows.size() * sides);
  for (int i = 0; i < rows.size(); i++) {
    const auto &one = wet[rows.row_at(i)];
    to_diagonal[i] = one.diagonal + screen;
    for (int s = 0; s < sides; s++)
      to_weight[(std::size_t) i * sides + s] = one.near[s] < 0 ? 0.0 : one.weight[s];
  }
}

/** Copies values of rows to all cells of all ranks. */
void MPMFlowPressure::to_cells(const std::vector<double> &row_values,
                               std::vector<double> &cell_values) const
{
  cell_values.assign(size(), 0.0);
  for (int i = 0; i < rows.size(); i++) cell_values[rows.cell_at(i)] = row_values[i];
  cells.publish(cell_values.data(), 1);
}

/** Gives the same equations to the multigrid preconditioner: owners of cells give the weights of
 *  their upper faces. */
void MPMFlowPressure::find_levels()
{
  if (levels_are_there) return;
  const int dim = cells.lattice.dim;
  coefficients.clear();
  for (const auto &one : wet) {
    const int64_t number = cells.cells[one.cell].number;
    // summed apart: a closed pool has nothing outside, to the last digit
    double outside = 0.0, inside = 0.0;
    for (int s = 0; s < 2 * dim; s++) {
      (one.near[s] < 0 ? outside : inside) += one.weight[s];
      if (s % 2 && one.near[s] >= 0) coefficients.face[number * dim + s / 2] = one.weight[s];
    }
    coefficients.outside[number] = inside + outside > 0.0 ? outside : one.diagonal;
  }
  coefficients.finish();
  poisson.multigrid.setup(coefficients);
  find_rows();
  weigh_rows(0.0, poisson.diagonal, poisson.weight);
  poisson.begin();
  if (fourier) find_box();
  levels_are_there = true;
}

void MPMFlowPressure::use_fourier()
{
  fourier = std::make_unique<MPMFlowFourier>(lmp, cells);
  poisson.fourier = fourier.get();
}

/** Gives the wet cells to the Fourier transforms, with the mean weight of faces between them. */
void MPMFlowPressure::find_box()
{
  double mine[2] = {0.0, 0.0}, all[2];
  fourier->begin();
  for (int i = 0; i < rows.size(); i++) {
    const auto &one = wet[rows.row_at(i)];
    int closed = 0;
    for (int s = 0; s < 2 * cells.lattice.dim; s++) {
      if (one.weight[s] == 0.0) closed |= 1 << s;
      if (one.near[s] < 0) continue;
      mine[0] += one.weight[s];
      mine[1] += 1.0;
    }
    fourier->add(cells.cells[one.cell].index, closed, i < rows.size_of(MPMFlowRows::EVEN));
  }
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  const double h = cells.lattice.h;
  fourier->arrange(all[0] > 0.0 ? all[0] / all[1] : 1.0 / (h * h));
}

/* ---------------------------------------------------------------------- */

SolveReport MPMFlowPressure::project(const double *before, double *after, double *known,
                                     const SolveGoal &goal, const std::vector<double> *surface,
                                     MPMFlowGasRows *gas)
{
  const double h = cells.lattice.h;
  right_side.assign(size(), 0.0);
  for (const auto &one : wet) {
    const auto &cell = cells.cells[one.cell];
    right_side[cell.number] = -outflow(before, cell) / h;
  }
  if (surface) find_lift(*surface);
  if (gas) gas->load(before, lift, right_side);
  cells.publish(right_side.data(), 1);
  find_levels();
  poisson.multigrid.project(right_side.data());
  poisson.bodies = bodies;
  poisson.gas = gas;
  if (gas) gas->arrange(rows);
  solution.assign(2 * (std::size_t) rows.size(), 0.0);
  double *const load = solution.data() + rows.size();
  for (int i = 0; i < rows.size(); i++) load[i] = right_side[rows.cell_at(i)];
  const SolveReport report = method.solve(poisson, load, solution.data(), goal);
  if (gas) gas->end(solution.data());
  to_cells(solution, psi);
  for (int64_t k = 0; surface && k < size(); k++) psi[k] += lift[k];
  subtract_gradient(psi, before, after, known, surface);
  return report;
}

/* ----------------------------------------------------------------------
   The lift is the psi of the surface next to a cell, and the mean of all surfaces elsewhere; only
   the rest is solved for. The norm of the right side is then that of what drives a flow, and not
   that of a pressure divided by small distances.
------------------------------------------------------------------------- */

void MPMFlowPressure::find_lift(const std::vector<double> &surface)
{
  const int dim = cells.lattice.dim;
  double mine[2] = {0.0, 0.0}, all[2];
  lift.assign(size(), 0.0);
  const auto visit = [&](const Wet &one, double &weight, double &sum) {
    const auto &cell = cells.cells[one.cell];
    weight = sum = 0.0;
    for (int s = 0; s < 2 * dim; s++) {
      if (one.near[s] >= 0 || one.weight[s] == 0.0) continue;
      weight += one.weight[s];
      sum += one.weight[s] * surface[(int64_t) (s % 2 ? cell.near[s] : cell.number) * dim + s / 2];
    }
  };
  double weight, sum;
  for (const auto &one : wet) {
    visit(one, weight, sum);
    if (weight == 0.0) continue;
    mine[0] += sum / weight;
    mine[1] += 1.0;
  }
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  for (const auto &one : wet) {
    const int number = cells.cells[one.cell].number;
    visit(one, weight, sum);
    lift[number] = weight > 0.0 ? sum / weight : all[1] > 0.0 ? all[0] / all[1] : 0.0;
  }
  cells.publish(lift.data(), 1);
  // at surfaces the terms of a cell add up to zero, by the choice of its lift
  for (const auto &one : wet) {
    const int number = cells.cells[one.cell].number;
    for (int s = 0; s < 2 * dim; s++)
      if (one.near[s] >= 0)
        right_side[number] -= one.weight[s] * (lift[number] - lift[one.near[s]]);
  }
}

/** Subtracts the gradient for owned cells. A null before stands for zero. */
void MPMFlowPressure::subtract_gradient(const std::vector<double> &of, const double *before,
                                        double *after, double *known,
                                        const std::vector<double> *surface) const
{
  const int dim = cells.lattice.dim;
  const double h = cells.lattice.h;
  for (const auto &cell : cells.cells)
    for (int d = 0; d < dim; d++) {
      const int64_t face = (int64_t) cell.number * dim + d;
      const int here = cell.number, lower = cell.near[2 * d];
      const bool in = is_wet(here), below = is_wet(lower), wall = cell.walls >> 2 * d & 1;
      after[face] = known[face] = 0.0;
      if (wall || ((in || below) && aperture(here, d) > 0.0)) known[face] = 1.0;
      if (wall || known[face] == 0.0) continue;
      const double weight = light(here, d) *
          (in ? weight_to(here, lower) : weight_to(lower, here)) *
          (mobility ? (*mobility)[face] : 1.0);
      double step = of[here] - of[lower];    // a dry cell has zero
      if (surface && in != below) step += in ? -(*surface)[face] : (*surface)[face];
      after[face] = (before ? before[face] : 0.0) - h * weight * step;
    }
}

bool MPMFlowPressure::is_deep(const MPMFlowLattice::Cell &cell) const
{
  bool deep = is_wet(cell.number);
  for (int s = 0; s < 2 * cells.lattice.dim; s++)
    deep =
        deep && (cell.walls >> s & 1 || is_wet(cell.near[s]) || aperture_of_side(cell, s) == 0.0);
  return deep;
}

SolveReport MPMFlowPressure::spread(double rate, double *displacement, double *known,
                                    const SolveGoal &goal)
{
  const double h = cells.lattice.h;
  if (inverse_density) {    // spreading of points has no density
    inverse_density = nullptr;
    find_weights();
  }
  const double screen = 1.0 / (SPREAD * SPREAD * h * h);
  find_rows();
  weigh_rows(screen, diagonal, weight);
  solution.resize(rows.size());
  for (int i = 0; i < rows.size(); i++) {
    const auto &cell = cells.cells[wet[rows.row_at(i)].cell];
    double more = filled[cell.number] - 1.0;
    if (regions && regions->volume_fraction(cell.number) < 1.0)
      more = std::max(0.0, more - UNSURE);
    else if (more < 0.0 && !is_deep(cell))
      more = 0.0;
    solution[i] = rate * std::min(more, 1.0);
  }
  const SolveReport report =
      equal_filling.solve(diagonal, weight, solution.data(), solution.data(), goal);
  to_cells(solution, excess);
  subtract_gradient(excess, nullptr, displacement, known);
  return report;
}

/** Net flow out of a cell through its sides, per area of a side. */
double MPMFlowPressure::outflow(const double *velocity, const MPMFlowLattice::Cell &cell) const
{
  double sum = 0.0;
  for (int d = 0; d < cells.lattice.dim; d++)
    sum += flux_of_side(velocity, cell, 2 * d + 1) - flux_of_side(velocity, cell, 2 * d);
  return sources ? sum - cells.lattice.h * (*sources)[cell.number] : sum;
}

double MPMFlowPressure::largest_divergence(const double *velocity) const
{
  double most = 0.0;
  for (const auto &one : wet)
    most = std::max(most, std::fabs(outflow(velocity, cells.cells[one.cell])));
  return most / cells.lattice.h;
}

void MPMFlowPressure::add_balance(const double *velocity, double *out, double *in) const
{
  const double h = cells.lattice.h, area = std::pow(h, cells.lattice.dim - 1);
  for (const auto &one : wet) {
    const auto &cell = cells.cells[one.cell];
    *out += area * outflow(velocity, cell);
    if (sources) *in += area * h * (*sources)[cell.number];
  }
}

void MPMFlowPressure::extend_into_air(std::vector<double> &values,
                                      const std::vector<double> *surface,
                                      const MPMFlowGasRows *gas) const
{
  const int dim = cells.lattice.dim;
  values.assign(size(), 0.0);
  for (const auto &one : wet)
    values[cells.cells[one.cell].number] = psi[cells.cells[one.cell].number];
  for (const auto &cell : cells.cells) {
    if (is_wet(cell.number)) continue;
    double sum = 0.0;
    int n = 0;
    for (int s = 0; s < 2 * cells.lattice.dim; s++) {
      const int other = cell.near[s];
      if (cell.walls >> s & 1 || !is_wet(other) || aperture_of_side(cell, s) == 0.0) continue;
      // from the middle of the wet cell to the surface
      const double in = distance(other, cell.number);
      const double at = surface ? (*surface)[(int64_t) (s % 2 ? other : cell.number) * dim + s / 2]
                                : 0.0;
      sum += at + (psi[other] - at) * (in - 1.0) / in;
      n++;
    }
    if (n)
      values[cell.number] = sum / n;
    else if (gas)
      values[cell.number] = gas->in_cell(cell.number);
  }
  cells.publish(values.data(), 1);
  if (regions) regions->extrapolate(values, flag);
}

double MPMFlowPressure::at_wall(int axis, int side) const
{
  double sum = 0.0;
  for (const auto &one : wet) {
    const auto &cell = cells.cells[one.cell];
    if (!(cell.walls >> (2 * axis + side) & 1)) continue;
    const int next = cell.near[2 * axis + 1 - side];
    const bool both = is_wet(next) && !(cell.walls >> (2 * axis + 1 - side) & 1);
    const double value = both ? 1.5 * psi[cell.number] - 0.5 * psi[next] : psi[cell.number];
    sum += aperture_of_side(cell, 2 * axis + side) * value;
  }
  return sum * std::pow(cells.lattice.h, cells.lattice.dim - 1);
}

double MPMFlowPressure::memory_usage() const
{
  return bytes_of(psi, lift, excess, flag, right_side, solution, diagonal, weight, wet) +
      method.memory_usage() + coefficients.memory_usage() + rows.memory_usage() +
      poisson.memory_usage() + (fourier ? fourier->memory_usage() : 0.0) +
      equal_filling.memory_usage();
}
