/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Along one axis, in quarters of the coarse node spacing, coarse node j is at 4 j, fine node i at p
   = offset + 2 i. Weights of its parents by their distance |p - 4 j|, which are those of the
   two-scale relation of B-splines:

     linear     0: 1      2: 1/2                     (nodes of both lattices are at the same places)
     quadratic  1: 3/4    3: 1/4                     (fine nodes are a quarter of a spacing off)
     cubic      0: 3/4    2: 1/2    4: 1/8

   Momentum of a fine node is sum_p N_ip m_p (v_p + C_p (x_i - x_p)). To the coarse node j the
   points would have given sum_p sum_i T_ij N_ip m_p (v_p + C_p (x_j - x_p)), which differs by sum_i
   T_ij M_i (x_j - x_i), M_i = sum_p N_ip m_p C_p. Without this a velocity that is linear in space
   would not stay so: coarse nodes at the rim of the fine points have masses on one side of them,
   and would get the velocity of the center of these. As sum_j T_ij (x_j - x_i) = 0, the momentum is
   the same with it. */

#include "refine/mpm_two_scale.h"

#include "atom.h"
#include "base/mpm_lists.h"
#include "field/mpm_affine.h"
#include "field/mpm_frame.h"
#include "field/mpm_point_map.h"
#include "field/mpm_stencil.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double ROUNDING = 1.0e-6;    // of places of nodes, in quarters

/** Floor of a/4. */
static int quarter(int a)
{
  return a >> 2;
}

namespace {
/** What a fine node has to do with on one axis of the coarse lattice. */
struct Axis {
  int nparent, parent[3];
  double weight[3];
  int first_cell, last_cell;    // that its function reaches

  /** order: of the spline; p: place of the node. */
  Axis(int order, int p)
  {
    const int reach = order + 1,
              cell = order == 2 ? 2 : 0;    // cells of quadratic functions are around nodes
    nparent = 0;
    for (int j = quarter(p - reach + 3); 4 * j - p <= reach; j++) {
      static constexpr double weights[4][5] = {
          {}, {1.0, 0.0, 0.5}, {0.0, 0.75, 0.0, 0.25}, {0.75, 0.0, 0.5, 0.0, 0.125}};
      const double w = weights[order][std::abs(4 * j - p)];
      if (w == 0.0) continue;
      parent[nparent] = j;
      weight[nparent++] = w;
    }
    first_cell = quarter(p - reach + cell);
    last_cell = quarter(p + reach + cell + 3) - 1;
  }
};
}    // namespace

static double offset_of(const MPMField &coarse, const MPMField &fine, int axis)
{
  return 4.0 * (fine.lattice.origin[axis] - coarse.lattice.origin[axis]) / coarse.lattice.h;
}

bool MPMTwoScale::fits(const MPMField &coarse, const MPMField &fine)
{
  const int odd = stencil_order(coarse.options.shape) == 2;
  for (int d = 0; d < coarse.lattice.dim; d++) {
    const double offset = offset_of(coarse, fine, d), whole = std::nearbyint(offset);
    if (std::fabs(offset - whole) > ROUNDING || std::fabs(std::fmod(whole, 2.0)) != odd)
      return false;
  }
  return true;
}

double MPMTwoScale::fine_origin(const MPMField &coarse, int axis)
{
  const bool odd = stencil_order(coarse.options.shape) == 2;
  return coarse.lattice.origin[axis] + (odd ? 0.25 * coarse.lattice.h : 0.0);
}

MPMTwoScale::MPMTwoScale(LAMMPS *lmp, MPMField &coarse, MPMField &fine, const MPMTwoScale *before) :
    Pointers(lmp), coarse(coarse), fine(fine), before(before)
{
  add_neighbor(coarse);
  for (int d = 0; d < 3; d++)
    offset[d] = d < coarse.lattice.dim ? (int) std::lround(offset_of(coarse, fine, d)) : 0;
}

void MPMTwoScale::add_neighbor(MPMField &field)
{
  marks.push_back({field, field.nodes.add_field("mpm/refine", 1)});
}

double MPMTwoScale::memory_usage() const
{
  return bytes_of(tied, parents, tied_of, block_is_tied, shares, affine, moments);
}

/** Parents are at most one coarse node away, and so are the cells that a fine node reaches; those
 *  of a lattice that is some levels finer are parents of parents. */
void MPMTwoScale::extend_coarse(const MPMField &finer, int levels) const
{
  constexpr int FAR = 2;
  Grid &grid = coarse.grid;
  const auto &of = finer.lattice, &to = coarse.lattice;
  const int dim = to.dim;
  for (const auto &block : finer.grid.blocks) {
    if (!block.reached) continue;
    int low[3] = {0, 0, 0}, high[3] = {0, 0, 0}, first[3] = {0, 0, 0}, last[3] = {0, 0, 0}, b[3];
    for (int d = 0; d < dim; d++) {
      const int node = block.b[d] * finer.grid.side;
      const double at = (of.origin[d] - to.origin[d] + node * of.h) / to.h,
                   end = at + (finer.grid.side - 1) * of.h / to.h;
      low[d] = (int) std::floor(at) - FAR * levels;
      high[d] = (int) std::ceil(end) + FAR * levels;
      first[d] = low[d] >> grid.shift_bits;
      last[d] = high[d] >> grid.shift_bits;
    }
    for (b[0] = first[0]; b[0] <= last[0]; b[0]++)
      for (b[1] = first[1]; b[1] <= last[1]; b[1]++)
        for (b[2] = first[2]; b[2] <= last[2]; b[2]++) {
          Grid::Block &active = grid.blocks[grid.activate(b)];
          active.reached |= grid.nodes_between(active, low, high);
        }
  }
}

/** -1: not known to this rank, which no point of it has to do with then. */
int64_t MPMTwoScale::canonical_node(const Grid &grid, const int index[3])
{
  int wrapped[3] = {0, 0, 0};
  for (int d = 0; d < grid.lattice.dim; d++) wrapped[d] = grid.lattice.wrap(d, index[d]);
  return grid.locate(wrapped);
}

bool MPMTwoScale::is_marked(const int cell[3]) const
{
  return std::any_of(marks.begin(), marks.end(), [cell](const Marks &m) {
    const int64_t node = canonical_node(m.field.grid, cell);
    return node >= 0 && *m.cells.at(node) > 0.0;
  });
}

/** Cells with points of a field. */
void MPMTwoScale::mark_points(const Marks &of)
{
  const MPMField &field = of.field;
  const Grid &grid = field.grid;
  const int dim = grid.lattice.dim;
  const double middle = stencil_order(field.options.shape) == 2 ? 0.5 : 0.0;
  of.cells.zero();
  int last[3] = {0, 0, 0}, index[3] = {0, 0, 0}, last_slot = -1;
  for (const auto &run : field.map->runs)
    for (int i = run.first; i < run.last; i++) {
      const double *const x = field.frame->places()[i];
      for (int d = 0; d < dim; d++)
        index[d] = (int) std::floor((x[d] - grid.lattice.origin[d]) / grid.lattice.h + middle);
      if (run.slot == last_slot && std::equal(index, index + 3, last)) continue;
      std::copy_n(index, 3, last);
      last_slot = run.slot;
      const int64_t node = grid.locate_near(grid.blocks[run.slot], index);
      if (node >= 0) *of.cells.at(node) = 1.0;
    }
  field.nodes.sum(of.cells);
}

/** Cells with points of the coarse field, and of other bodies on its lattice. Where there is a
 *  field that is coarser still, its cells count, too: what the fine nodes of this pair reach of
 *  them has no free node of the field between. */
void MPMTwoScale::mark_cells()
{
  for (const auto &m : marks) mark_points(m);
  if (!before) return;

  const Grid &grid = coarse.grid;
  const int dim = grid.lattice.dim, order = stencil_order(coarse.options.shape);
  for (std::size_t slot = 0; slot < grid.blocks.size(); slot++) {
    const auto &block = grid.blocks[slot];
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (!(block.reached >> n & 1)) continue;
      int index[3];
      grid.node_index(block, n, index);
      for (int d = 0; d < dim;
           d++)    // the cell of the coarser lattice around the middle of this one
        index[d] = quarter(before->offset[d] + 2 * index[d] + (order == 2 ? 2 : 1));
      if (before->is_marked(index)) *marks[0].cells.at((int64_t) slot * NODES_PER_BLOCK + n) = 1.0;
    }
  }
}

void MPMTwoScale::find_tied()
{
  if (lists_valid && !fine.options.changes_cells() && !coarse.options.changes_cells()) return;
  mark_cells();

  const Grid &grid = fine.grid, &above = coarse.grid;
  const int dim = grid.lattice.dim, order = stencil_order(coarse.options.shape);
  if (lists_valid)
    for (const auto &t : tied) tied_of[t.node] = -1;
  else
    tied_of.assign(grid.nnodes(), -1);
  block_is_tied.assign(grid.blocks.size(), 0);
  tied.clear();
  parents.clear();
  count = {};

  for (std::size_t slot = 0; slot < grid.blocks.size(); slot++) {
    const auto &block = grid.blocks[slot];
    if (!block.reached) continue;

    // cells that the block reaches, which are few
    constexpr int MOST = 10;
    int low[3] = {0, 0, 0}, high[3] = {0, 0, 0}, c[3];
    for (int d = 0; d < dim; d++) {
      const int first = offset[d] + 2 * block.b[d] * grid.side;
      low[d] = Axis(order, first).first_cell;
      high[d] = Axis(order, first + 2 * (grid.side - 1)).last_cell;
    }
    bool cells[MOST * MOST * MOST], any = false;
    const auto place = [&](int x, int y, int z) {
      return ((x - low[0]) * MOST + y - low[1]) * MOST + z - low[2];
    };
    for (c[0] = low[0]; c[0] <= high[0]; c[0]++)
      for (c[1] = low[1]; c[1] <= high[1]; c[1]++)
        for (c[2] = low[2]; c[2] <= high[2]; c[2]++) {
          const bool marked = is_marked(c);
          cells[place(c[0], c[1], c[2])] = marked;
          any = any || marked;
        }

    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (!(block.reached >> n & 1)) continue;
      const int owned = block.owned >> n & 1;
      count.free += owned;
      if (!any) continue;
      int index[3];
      grid.node_index(block, n, index);
      const Axis axes[3] = {{order, offset[0] + 2 * index[0]},
                            {order, offset[1] + 2 * index[1]},
                            {order, offset[2] + 2 * index[2]}};
      const Axis &x = axes[0], &y = axes[1], &z = axes[2];
      const int zfirst = dim == 3 ? z.first_cell : 0, zlast = dim == 3 ? z.last_cell : 0;
      bool is_tied = false;
      for (int i = x.first_cell; i <= x.last_cell; i++)
        for (int j = y.first_cell; j <= y.last_cell; j++)
          for (int k = zfirst; k <= zlast; k++) is_tied = is_tied || cells[place(i, j, k)];
      if (!is_tied) continue;

      count.free -= owned;
      count.tied += owned;
      const int64_t node = (int64_t) slot * NODES_PER_BLOCK + n;
      block_is_tied[slot] = 1;
      tied_of[node] = tied.size();
      tied.push_back({node, (int) parents.size(), 0});
      const double unit = 0.25 * above.lattice.h;
      for (int i = 0; i < x.nparent; i++)
        for (int j = 0; j < y.nparent; j++)
          for (int k = 0; k < (dim == 3 ? z.nparent : 1); k++) {
            const int of[3] = {x.parent[i], y.parent[j], dim == 3 ? z.parent[k] : 0};
            Parent parent = {canonical_node(above, of),
                             x.weight[i] * y.weight[j] * (dim == 3 ? z.weight[k] : 1.0),
                             {0.0, 0.0, 0.0}};
            for (int d = 0; d < dim; d++)
              parent.r[d] = unit * (4 * of[d] - offset[d] - 2 * index[d]);
            parents.push_back(parent);
          }
      tied.back().last = parents.size();
    }
  }
  find_shares();
  lists_valid = true;
}

void MPMTwoScale::find_shares()
{
  const MPMStencil stencil(fine);
  MPMStencil::Axes axes;
  shares.clear();
  for (const auto &a : fine.map->active) {
    const auto &block = fine.grid.blocks[a.slot];
    const bool near = std::any_of(block.slot, block.slot + 27, [&](int slot) {
      return slot >= 0 && block_is_tied[slot];
    });
    if (!near) continue;
    for (int k = a.first_run; k < a.last_run; k++)
      for (int i = fine.map->runs[k].first; i < fine.map->runs[k].last; i++) {
        stencil.find_axes(block, i, axes);
        for (int x = 0; x < axes.count[0]; x++)
          for (int y = 0; y < axes.count[1]; y++)
            for (int z = 0; z < axes.count[2]; z++) {
              const int t = tied_of[axes.number(x, y, z)];
              if (t >= 0) shares.push_back({t, i, axes.w[0][x] * axes.w[1][y] * axes.w[2][z]});
            }
      }
  }
}

/** Sums of N_ip w_p times a row of each point at tied nodes, with what nodes of this lattice have
 *  got from finer ones that are tied to them. */
template <class Weight>
void MPMTwoScale::sum_at_tied(const Weight &weight, const MPMRows &rows, int width,
                              std::vector<double> &sums, const MPMTwoScale *after,
                              const std::vector<double> *of_after) const
{
  sums.assign(width * tied.size(), 0.0);
  for (const auto &share : shares) {
    const double m = share.weight * weight(share.point), *const from = rows[share.point];
    double *const to = &sums[(std::size_t) width * share.tied];
    for (int c = 0; c < width; c++) to[c] += m * from[c];
  }
  if (!after) return;
  for (std::size_t finer = 0; finer < after->tied.size(); finer++)
    for (int k = after->tied[finer].first; k < after->tied[finer].last; k++) {
      const int t = tied_of[after->parents[k].node];
      if (t < 0) continue;
      for (int c = 0; c < width; c++)
        sums[(std::size_t) width * t + c] +=
            after->parents[k].weight * (*of_after)[width * finer + c];
    }
}

void MPMTwoScale::sum_affine(const MPMTwoScale *after)
{
  const double *const mass = fine.atom->rmass;
  sum_at_tied(
      [mass](int i) {
        return mass[i];
      },
      fine.affine->C, fine.affine->size(), affine, after, after ? &after->affine : nullptr);
}

void MPMTwoScale::to_parents(const MPMTwoScale *after)
{
  sum_affine(after);
  const int dim = fine.lattice.dim, nC = dim * dim, nreal = fine.grid.nreal;
  for (std::size_t t = 0; t < tied.size(); t++) {
    double *const record = fine.grid.record(tied[t].node);
    const double *const M = &affine[nC * t];
    for (int k = tied[t].first; k < tied[t].last; k++) {
      const Parent &parent = parents[k];
      double *const to = coarse.grid.record(parent.node);
      for (int r = 0; r < nreal; r++) to[r] += parent.weight * record[r];
      for (int j = 0; j < dim; j++)
        for (int i = 0; i < dim; i++) to[i] += parent.weight * M[dim * j + i] * parent.r[j];
    }
    std::fill_n(record, nreal, 0.0);
  }
}

void MPMTwoScale::from_parents()
{
  const int nreal = fine.grid.nreal;
  for (const auto &t : tied) {
    double *const record = fine.grid.record(t.node);
    for (int r = 0; r < nreal; r += 4) std::fill_n(record + r, 3, 0.0);
    for (int k = t.first; k < t.last; k++) {
      const double *const from = coarse.grid.record(parents[k].node);
      for (int r = 0; r < nreal; r += 4)
        for (int d = 0; d < 3; d++) record[r + d] += parents[k].weight * from[r + d];
    }
  }
}

void MPMTwoScale::sums_to_parents(std::vector<double> &of_fine, std::vector<double> &of_coarse,
                                  int width) const
{
  for (const auto &t : tied) {
    double *const from = &of_fine[width * t.node];
    for (int k = t.first; k < t.last; k++)
      for (int c = 0; c < width; c++)
        of_coarse[width * parents[k].node + c] += parents[k].weight * from[c];
    std::fill_n(from, width, 0.0);
  }
}

void MPMTwoScale::moments_to_parents(const std::function<double(int)> &weight,
                                     const MPMRows &slopes, const MPMTwoScale *after,
                                     std::vector<double> &of_fine, std::vector<double> &of_coarse)
{
  const int dim = fine.lattice.dim;
  if (slopes) {
    sum_at_tied(weight, slopes, dim, moments, after, after ? &after->moments : nullptr);
    for (std::size_t t = 0; t < tied.size(); t++)
      for (int k = tied[t].first; k < tied[t].last; k++)
        for (int d = 0; d < dim; d++)
          of_coarse[parents[k].node] += parents[k].weight * moments[dim * t + d] * parents[k].r[d];
  }
  sums_to_parents(of_fine, of_coarse);
}

void MPMTwoScale::values_from_parents(const std::vector<double> &of_coarse,
                                      std::vector<double> &of_fine) const
{
  for (const auto &t : tied) {
    double sum = 0.0;
    for (int k = t.first; k < t.last; k++) sum += parents[k].weight * of_coarse[parents[k].node];
    of_fine[t.node] = sum;
  }
}

void MPMTwoScale::greatest_from_parents(const std::vector<double> &of_coarse,
                                        std::vector<double> &of_fine) const
{
  for (const auto &t : tied)
    for (int k = t.first; k < t.last; k++)
      of_fine[t.node] = std::max(of_fine[t.node], of_coarse[parents[k].node]);
}

double MPMTwoScale::share_of_thin(const std::vector<MPMField *> &body) const
{
  const Grid &grid = coarse.grid;
  const int dim = grid.lattice.dim;
  const auto visit = [&](const MPMField &field, const auto &f) {
    for (const auto &run : field.map->runs)
      for (int i = run.first; i < run.last; i++) {
        const double *const x = field.frame->places()[i];
        int cell[3] = {0, 0, 0};
        for (int d = 0; d < dim; d++)
          cell[d] = (int) std::floor((x[d] - grid.lattice.origin[d]) / grid.lattice.h);
        f(cell);
      }
  };
  enum { COARSE, FINE, NKIND };
  std::vector<double> has(NKIND * grid.nnodes(), 0.0);
  for (const auto *field : body) {
    const int kind = field->lattice.h > 0.75 * grid.lattice.h ? COARSE : FINE;
    visit(*field, [&](const int *cell) {
      const int64_t node = canonical_node(grid, cell);
      if (node >= 0) has[NKIND * node + kind] = 1.0;
    });
  }
  coarse.nodes.sum(has.data(), NKIND, 0, NKIND);
  const auto is_in = [&](const int *cell, int kind) {
    const int64_t node = canonical_node(grid, cell);
    return node >= 0 && has[NKIND * node + kind] > 0.0;
  };

  double mine[2] = {0.0, 0.0}, all[2];
  visit(fine, [&](const int *cell) {
    if (is_in(cell, COARSE)) return;
    bool outside = false, thin = false;
    for (int k = 0; k < 2 * dim; k++) {
      int next[3] = {cell[0], cell[1], cell[2]}, below[3] = {cell[0], cell[1], cell[2]};
      next[k / 2] += k % 2 ? 1 : -1;
      below[k / 2] -= k % 2 ? 1 : -1;
      if (is_in(next, FINE) || is_in(next, COARSE)) continue;
      outside = true;
      thin = thin || is_in(below, COARSE);
    }
    mine[0] += thin;
    mine[1] += outside;
  });
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  return all[1] > 0.0 ? all[0] / all[1] : 0.0;
}
