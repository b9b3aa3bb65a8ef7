/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Cells that a surface cuts are halved along all axes, and their parts again, as long as the
 *  surface may go through them. Of the smallest parts, the closed share follows from the distance
 *  of their middle, which is linear in cells away from edges. Regions at rest are asked once in a
 *  run. */

#include "field/mpm_free_room.h"

#include "base/mpm_find_fixes.h"
#include "base/mpm_lists.h"
#include "domain.h"
#include "field/mpm_field.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// parts of a cell along each axis for regions that move, which are asked each time
static constexpr int PARTS_IN_MOTION = 4;
static constexpr int REACH = 2;    // of the widest function [node spacings]

double LAMMPS_NS::integral_of_function(Shape shape, double t)
{
  const double a = std::fabs(t);
  double half = 0.5;    // from 0 to a
  if (shape == QUADRATIC) {
    if (a < 0.5)
      half = a * (0.75 - a * a / 3.0);
    else if (a < 1.5)
      half -= std::pow(1.5 - a, 3) / 6.0;
  } else if (shape == CUBIC) {
    if (a < 1.0)
      half = a * (2.0 / 3.0 - a * a * (1.0 / 3.0 - a / 8.0));
    else if (a < 2.0)
      half -= std::pow(2.0 - a, 4) / 24.0;
  } else if (a < 1.0) {
    half = a - 0.5 * a * a;
  }
  return t < 0.0 ? 0.5 - half : 0.5 + half;
}

void MPMFreeRoom::init()
{
  known = false;
  at_rest.clear();
  moving.clear();
  of_block.clear();
}

void MPMFreeRoom::forget_cells()
{
  of_cell.clear();
  in_cells.clear();
  closed_cell = OPEN;
}

void MPMFreeRoom::list_barriers()
{
  if (known) return;
  known = true;
  for (int k = 0; k < FUNCTIONS; k++)
    for (int p = 0; p <= PARTS; p++)
      inside[k][p] = integral_of_function(field.options.shape, (double) p / PARTS + 1 - k);
  for (auto *barrier : find_fixes<MPMBarrier>(lmp))
    if (barrier->keeps_out(field)) (barrier->changes_place() ? moving : at_rest).push_back(barrier);
}

bool MPMFreeRoom::is_cut()
{
  list_barriers();
  return !at_rest.empty() || !moving.empty();
}

/** Distance from the nearest region. */
double MPMFreeRoom::gap(const double *x, double far) const
{
  double least = far;
  for (const auto *barrier : near) least = std::min(least, barrier->gap(x, far));
  return least;
}

/** Can a region be in reach of the nodes of a block? */
bool MPMFreeRoom::is_near(const Grid::Block &block, const MPMBarrier &barrier) const
{
  const auto &lattice = field.lattice;
  const double h = lattice.h,
               radius = (0.5 * (field.grid.side - 1) + REACH) * h * std::sqrt((double) lattice.dim);
  int first[3];
  double middle[3];
  field.grid.node_index(block, 0, first);
  lattice.node_position(first, middle);
  for (int d = 0; d < lattice.dim; d++) middle[d] += 0.5 * (field.grid.side - 1) * h;
  // images of regions are not known: where the block goes beyond a periodic face, points are
  // elsewhere
  for (int d = 0; d < lattice.dim; d++)
    if (lattice.periodic[d] &&
        (middle[d] - radius < domain->boxlo[d] || middle[d] + radius > domain->boxhi[d]))
      return true;
  return barrier.gap(middle, 1.001 * radius) < radius;
}

void MPMFreeRoom::find(const double *nodes, int nreal, std::vector<double> &share)
{
  const Grid &grid = field.grid;
  share.assign(grid.nnodes(), 1.0);
  list_barriers();
  for (auto *barrier : at_rest) barrier->go_to_start();
  for (auto *barrier : moving) barrier->go_to_start();
  const auto set = [&](std::size_t ib, const Shares &of) {
    std::copy(of.begin(), of.end(), share.begin() + (std::ptrdiff_t) ib * NODES_PER_BLOCK);
  };
  std::vector<std::size_t> with_moving;
  for (std::size_t ib = 0; ib < grid.blocks.size(); ib++) {
    const double *record = nodes + ib * NODES_PER_BLOCK * nreal;
    bool has_points = false;
    for (int n = 0; n < NODES_PER_BLOCK && !has_points; n++)
      has_points = record[n * nreal + 3] > 0.0;
    if (!has_points) continue;
    const auto &block = grid.blocks[ib];
    if (std::any_of(moving.begin(), moving.end(), [&](const auto *barrier) {
          return is_near(block, *barrier);
        })) {
      with_moving.push_back(ib);
      continue;
    }
    if (at_rest.empty()) continue;
    const auto key = Grid::block_key(block);
    const auto found = of_block.find(key);
    if (found != of_block.end())
      set(ib, found->second);
    else
      set(ib, of_block[key] = shares(block, PARTS));
  }
  forget_cells();
  for (const auto ib : with_moving) set(ib, shares(grid.blocks[ib], PARTS_IN_MOTION));
  forget_cells();
}

/** Does a face of the box limit the functions of nodes that reach this cell? */
bool MPMFreeRoom::is_cut_by_box(int axis, int cell) const
{
  const auto &lattice = field.lattice;
  const double low = (domain->boxlo[axis] - lattice.origin[axis]) / lattice.h,
               high = (domain->boxhi[axis] - lattice.origin[axis]) / lattice.h;
  return !lattice.periodic[axis] && !(cell - 1 - REACH > low && cell + 1 < high);
}

/** The integral of the function of a node along an axis up to t [node spacings], within the box. */
double MPMFreeRoom::in_box(int axis, int node, double t) const
{
  const auto &lattice = field.lattice;
  const Shape shape = field.options.shape;
  if (lattice.periodic[axis]) return integral_of_function(shape, t - node);
  const double low = (domain->boxlo[axis] - lattice.origin[axis]) / lattice.h,
               high = (domain->boxhi[axis] - lattice.origin[axis]) / lattice.h;
  return integral_of_function(shape, std::max(low, std::min(t, high)) - node) -
      integral_of_function(shape, low - node);
}

/** Shares of the nodes of a block. Only the regions next to it count, so that cells get the same
 *  values from all blocks. */
MPMFreeRoom::Shares MPMFreeRoom::shares(const Grid::Block &block, int parts)
{
  near.clear();
  for (const auto *list : {&at_rest, &moving})
    for (auto *barrier : *list)
      if (is_near(block, *barrier)) near.push_back(barrier);
  if (near.empty()) return {};
  const int dim = field.lattice.dim, side = field.grid.side;
  Shares all(NODES_PER_BLOCK, 0.0);    // first what is closed
  int first[3], cell[3] = {0, 0, 0};
  field.grid.node_index(block, 0, first);
  const auto add = [&]() {
    const double *from = closed_in(cell, parts);
    if (!from) return;
    int node[3] = {0, 0, 0};
    for (int k = 0; k < (dim == 3 ? FUNCTIONS : 1); k++)
      for (int j = 0; j < FUNCTIONS; j++)
        for (int i = 0; i < FUNCTIONS; i++, from++) {
          const int at[3] = {cell[0] - 1 + i, cell[1] - 1 + j, cell[2] - 1 + k};
          bool here = true;
          for (int d = 0; d < dim; d++) {
            node[d] = at[d];
            here = here && at[d] >= first[d] && at[d] < first[d] + side;
          }
          if (here) all[field.grid.number(node)] += *from;
        }
  };
  const int before = REACH,
            after = side + REACH - 1;    // cells in reach of the first and last node
  for (int k = dim == 3 ? -before : 0; k < (dim == 3 ? after : 1); k++)
    for (int j = -before; j < after; j++)
      for (int i = -before; i < after; i++) {
        const int next[3] = {i, j, k};
        for (int d = 0; d < dim; d++) cell[d] = first[d] + next[d];
        add();
      }
  for (int n = 0; n < NODES_PER_BLOCK; n++) {
    int index[3];
    field.grid.node_index(block, n, index);
    double whole = 1.0;
    for (int d = 0; d < dim; d++)
      if (is_cut_by_box(d, index[d]) || is_cut_by_box(d, index[d] + REACH))
        whole *= in_box(d, index[d], index[d] + REACH);
    all[n] = whole > 0.0 ? std::max(0.0, 1.0 - all[n] / whole) : 1.0;
  }
  return all;
}

/** Integrals of functions over the closed part of a cell, null if nothing is closed. */
const double *MPMFreeRoom::closed_in(const int *index, int parts)
{
  const auto key = Grid::key(index);
  const auto found = of_cell.find(key);
  if (found != of_cell.end())
    return found->second == OPEN ? nullptr : in_cells[found->second].data();

  const auto &lattice = field.lattice;
  const double h = lattice.h, radius = 0.5 * h * std::sqrt((double) lattice.dim);
  Cell cell(index);
  double middle[3] = {0.0, 0.0, 0.0};
  lattice.node_position(index, cell.low);
  for (int d = 0; d < lattice.dim; d++) {
    if (lattice.periodic[d]) {    // points are in the box
      const double length = domain->boxhi[d] - domain->boxlo[d];
      cell.low[d] -= length * std::floor((cell.low[d] - domain->boxlo[d]) / length + 1.0e-9);
    }
    middle[d] = cell.low[d] + 0.5 * h;
    cell.is_cut[d] = is_cut_by_box(d, index[d]);
  }
  int &at = of_cell[key];
  at = OPEN;
  const double distance = gap(middle, 1.001 * radius);
  if (distance >= radius) return nullptr;
  const bool is_closed =
      distance <= -radius && std::none_of(cell.is_cut, cell.is_cut + 3, [](bool cut) {
        return cut;
      });
  if (is_closed && closed_cell != OPEN)
    at = closed_cell;
  else {
    at = (int) in_cells.size();
    if (is_closed) closed_cell = at;
    in_cells.push_back({});
    cell.closed = in_cells.back().data();
    for (int d = 0; d < lattice.dim; d++)
      for (int k = 0; k < FUNCTIONS; k++)
        for (int p = 0; p <= PARTS; p++)
          cell.upto[d][k][p] = cell.is_cut[d]
              ? in_box(d, index[d] - 1 + k, index[d] + (double) p / PARTS)
              : inside[k][p];
    const int first[3] = {0, 0, 0};
    add_closed(cell, first, PARTS, PARTS / parts);
  }
  return in_cells[at].data();
}

/** Where the surface is smooth, the distance in a cell is linear: that at its middle and the slope
 *  follow from the distances of the middles of its halves. */
void MPMFreeRoom::find_slope(Cell &cell) const
{
  constexpr double SMOOTH = 0.02;    // largest difference from a plane [node spacings]
  const int dim = field.lattice.dim, n = 1 << dim;
  const double h = field.lattice.h, far = h * std::sqrt((double) dim);
  double at[8], x[3] = {0.0, 0.0, 0.0}, mean = 0.0, most = 0.0;
  for (int k = 0; k < n; k++) {
    for (int d = 0; d < dim; d++) x[d] = cell.low[d] + ((k >> d & 1) ? 0.75 : 0.25) * h;
    at[k] = gap(x, far);
    mean += at[k] / n;
    for (int d = 0; d < dim; d++) cell.slope[d] += ((k >> d & 1) ? at[k] : -at[k]) * 2.0 / (n * h);
  }
  for (int k = 0; k < n; k++) {
    double plane = mean;
    for (int d = 0; d < dim; d++) plane += ((k >> d & 1) ? 0.25 : -0.25) * h * cell.slope[d];
    most = std::max(most, std::fabs(at[k] - plane));
  }
  cell.middle = mean;
  cell.is_smooth = most < SMOOTH * h;
}

/** Adds what is closed in a part of a cell that begins at part and has this size along each axis;
 *  it is halved down to the least size. */
void MPMFreeRoom::add_closed(Cell &cell, const int *part, int size, int least) const
{
  const int dim = field.lattice.dim;
  const double h = field.lattice.h, width = size * h / PARTS,
               radius = 0.5 * width * std::sqrt((double) dim);
  double x[3] = {0.0, 0.0, 0.0}, distance = cell.middle;
  for (int d = 0; d < dim; d++) {
    x[d] = cell.low[d] + part[d] * h / PARTS + 0.5 * width;
    distance += cell.slope[d] * (x[d] - cell.low[d] - 0.5 * h);
  }
  if (!cell.is_smooth) distance = gap(x, 1.001 * radius);
  if (distance >= radius) return;
  if (distance > -radius && size > least) {
    if (size == PARTS) find_slope(cell);
    const int half = size / 2;
    for (int k = 0; k < (dim == 3 ? 2 : 1); k++)
      for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
          const int next[3] = {part[0] + i * half, part[1] + j * half, part[2] + k * half};
          add_closed(cell, next, half, least);
        }
    return;
  }
  const double share = std::max(0.0, std::min(1.0, 0.5 - distance / width));
  if (share == 0.0) return;
  double of[3][FUNCTIONS] = {};
  for (int d = 0; d < dim; d++)
    for (int k = 0; k < FUNCTIONS; k++)
      of[d][k] = cell.upto[d][k][part[d] + size] - cell.upto[d][k][part[d]];
  double *sum = cell.closed;
  for (int k = 0; k < (dim == 3 ? FUNCTIONS : 1); k++)
    for (int j = 0; j < FUNCTIONS; j++) {
      const double across = share * of[1][j] * (dim == 3 ? of[2][k] : 1.0);
      for (int i = 0; i < FUNCTIONS; i++) *sum++ += across * of[0][i];
    }
}

double MPMFreeRoom::memory_usage() const
{
  double bytes = bytes_of(in_cells);
  for (const auto &block : of_block) bytes += 64.0 + block.second.capacity() * sizeof(double);
  return bytes;
}
