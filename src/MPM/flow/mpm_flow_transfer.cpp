/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_transfer.h"

#include "flow/mpm_flow_inflow.h"
#include "flow/mpm_flow_regions.h"
#include "flow/mpm_flow_solids.h"
#include "flow/mpm_flow_stencil.h"
#include "flow/mpm_flow_viscosity.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// points are kept this far inside of walls, in spacings, so that rounding does not take them out of
// the box
static constexpr double INSIDE = 1.0e-6;
// largest change of the velocity of a point over a spacing, in spacings per step. Flows change by
// less, but points that splash can get any gradient, which would give any velocity to faces up to
// 1.5 spacings away
static constexpr double STEEPEST = 0.75;

namespace {
template <int dim> struct Places {
  double origin[3], inv_h, low[3], high[3];
  bool walls[3];

  explicit Places(const MPM_NS::Lattice &lattice) : inv_h(1.0 / lattice.h)
  {
    for (int d = 0; d < dim; d++) {
      origin[d] = lattice.origin[d];
      walls[d] = !lattice.periodic[d];
      low[d] = origin[d] + INSIDE * lattice.h;
      high[d] = origin[d] + (lattice.ncell[d] - INSIDE) * lattice.h;
    }
  }
  void find(const double *x, StaggeredWeights &w) const
  {
    double t[3];
    for (int d = 0; d < dim; d++) t[d] = (x[d] - origin[d]) * inv_h;
    w.find<dim>(t);
  }
  void find_base(const double *x, int base[3]) const
  {
    for (int d = 0; d < dim; d++) base[d] = StaggeredWeights::base_at((x[d] - origin[d]) * inv_h);
  }
  void keep_inside(double *x) const
  {
    for (int d = 0; d < dim; d++)
      if (walls[d]) x[d] = std::max(low[d], std::min(x[d], high[d]));
  }
};

/** Power of the spacing in the unit of row e of gradients. */
template <int dim> double unit_of(int e, double h)
{
  return e < dim * dim ? h : h * h;
}

/** Factor that limits velocity gradients G [distance/time over a spacing] to STEEPEST in a step of
 *  duration dt. */
template <int dim> double limit_of(const double *G, double inv_h, double dt)
{
  double most = 0.0;
  for (int c = 0; c < dim; c++) {
    double sum = 0.0;
    for (int d = 0; d < dim; d++) sum += std::fabs(G[dim * c + d]);
    if constexpr (dim == 3) sum += std::fabs(G[9 + c]);
    most = std::max(most, sum * inv_h * dt);
  }
  return most > STEEPEST ? STEEPEST / most : 1.0;
}

/** Sums of what points whose places have the same base give, until they are added to the cells. */
template <int dim> struct Gifts {
  static constexpr int ROWS = MPMFlowStencil<dim>::ROWS;
  // cells along an axis that the width of points can reach, from base - 1 on
  static constexpr int WIDE = 4;
  static constexpr int FILLED = dim == 3 ? WIDE * WIDE * WIDE : WIDE * WIDE;
  // [c][row][k]: of faces, with one k more than there are, because vector operations take four
  double momentum[dim][ROWS][4], mass[dim][ROWS][4], force[dim][ROWS][4];
  double filled[FILLED];
  int base[3], slot;

  void clear(const int at[3], int new_slot)
  {
    *this = {};
    for (int d = 0; d < dim; d++) base[d] = at[d];
    slot = new_slot;
  }
  void add_to(const MPM_NS::Grid &grid, double *sums) const
  {
    constexpr int width = 3 * dim + 1;
    const MPMFlowStencil<dim> stencil(grid, grid.blocks[slot], base);
    for_each_axis<dim>([&](auto axis) {
      constexpr int c = axis;
      for (int row = 0; row < ROWS; row++)
        for (int k = 0; k < 3; k++) {
          double *const to = sums + stencil.template face<c>(row, k) * width + c;
          to[0] += momentum[c][row][k];
          to[dim] += mass[c][row][k];
          to[2 * dim] += force[c][row][k];
        }
    });
    const double *share = filled;
    for (int kx = -1; kx < WIDE - 1; kx++)
      for (int ky = -1; ky < WIDE - 1; ky++)
        for (int kz = dim == 3 ? -1 : 0; kz < (dim == 3 ? WIDE - 1 : 1); kz++, share++)
          if (*share != 0.0) sums[stencil.number(kx, ky, kz) * width + 3 * dim] += *share;
  }
};

template <int dim>
void give(const MPMFlowLattice &cells, const MPMFlowPoints &points, std::vector<double> &sums)
{
  constexpr int WIDE = Gifts<dim>::WIDE;
  const Places<dim> places(cells.lattice);
  const double h = cells.lattice.h;
  StaggeredWeights w;
  FillingWeights filling;
  MPMFlowNear<dim, Gifts<dim>> near;
  const auto add = [&](const Gifts<dim> &gifts) {
    gifts.add_to(cells.grid, sums.data());
  };
  double volume = 0.0, width_of_point = 0.0;
  for (const auto &run : cells.runs) {
    for (int nth = run.first; nth < run.last; nth++) {
      const int i = cells.points[nth];
      places.find(points.x[i], w);
      auto &to = near.at(w.base, add, [&](Gifts<dim> &gifts) {
        gifts.clear(w.base, run.slot);
      });
      const double m = points.mass[i], V = points.volume[i];
      const double *const f = points.f[i];
      double v[dim], G[flow_slopes(dim)] = {};
      for (int c = 0; c < dim; c++) v[c] = points.v[i][c];
      if (points.gradient) {
        for (int e = 0; e < flow_slopes(dim); e++)
          G[e] = points.gradient[i][e] * unit_of<dim>(e, h);
        const double limit = limit_of<dim>(G, places.inv_h, points.dt);
        for (double &g : G) g *= limit;
      }
      for_each_axis<dim>([&](auto axis) {
        constexpr int c = axis, d = (c + 1) % dim, e = (c + 2) % 3;
        double mass[4], slope[4], force[4];
        for (int k = 0; k < 4; k++) {
          const double N = k < 3 ? w.spline[c][k] : 0.0;
          mass[k] = m * N;
          slope[k] = mass[k] * G[dim * c + c] * w.to_face(c, k);
          force[k] = N * f[c];
        }
        for (int kd = 0; kd < 2; kd++) {
          const double at_d = w.to_middle(d, kd), along_d = v[c] + G[dim * c + d] * at_d;
          for (int ke = 0; ke < dim - 1; ke++) {
            double hats = w.hat[d][kd], value = along_d;
            if constexpr (dim == 3) {
              hats *= w.hat[e][ke];
              value += (G[3 * c + e] + G[9 + c] * at_d) * w.to_middle(e, ke);
            }
            const int row = kd + 2 * ke;
            for (int k = 0; k < 4; k++) {
              to.momentum[c][row][k] += hats * (mass[k] * value + slope[k]);
              to.mass[c][row][k] += hats * mass[k];
              to.force[c][row][k] += hats * force[k];
            }
          }
        }
      });

      if (V != volume) {
        volume = V;
        width_of_point = std::min(1.0, std::pow(V / cells.lattice.cell_volume(), 1.0 / dim));
      }
      double t[3];
      for (int d = 0; d < dim; d++) t[d] = (points.x[i][d] - places.origin[d]) * places.inv_h;
      filling.find<dim>(t, width_of_point);
      int first = 0;
      for (int d = 0; d < dim; d++) first = WIDE * first + filling.first[d] - (w.base[d] - 1);
      for (int k = 0; k < 3; k++)
        for (int l = 0; l < (dim == 3 ? 3 : 1); l++) {
          double *const row = to.filled + first + (dim == 3 ? WIDE * (WIDE * k + l) : WIDE * k);
          const double share = V * filling.share[0][k] * (dim == 3 ? filling.share[1][l] : 1.0);
          for (int n = 0; n < 3; n++) row[n] += share * filling.share[dim - 1][n];
        }
    }
    // block by block: sums then do not depend on which ranks have the other blocks
    near.leave_all(add);
  }
}

template <int dim>
void give_volumes(const MPMFlowLattice &cells, const MPMFlowPoints &points,
                  std::vector<double> &sums)
{
  const Places<dim> places(cells.lattice);
  StaggeredWeights w;
  for (const auto &run : cells.runs) {
    const auto &block = cells.grid.blocks[run.slot];
    for (int nth = run.first; nth < run.last; nth++) {
      const int i = cells.points[nth];
      places.find(points.x[i], w);
      const MPMFlowStencil<dim> reach(cells.grid, block, w.base);
      visit<dim>(reach, [&](int64_t number, const int k[3]) {
        double *const to = sums.data() + number * 2 * dim + dim;
        for (int c = 0; c < dim; c++) to[c] += points.volume[i] * w.face<dim>(c, k);
      });
    }
  }
}

/** Values of a field of velocities at the faces that places with the same base reach:
 *  [c][row][k]. */
template <int dim> struct Faces {
  double at[dim][MPMFlowStencil<dim>::ROWS][3];

  void find(const MPMFlowStencil<dim> &stencil, const double *values)
  {
    for_each_axis<dim>([&](auto axis) {
      constexpr int c = axis;
      for (int row = 0; row < stencil.ROWS; row++)
        for (int k = 0; k < 3; k++)
          at[c][row][k] = values[stencil.template face<c>(row, k) * dim + c];
    });
  }
};

/** The faces of one field, for one place after another. */
template <int dim> class FacesNear {
 public:
  FacesNear(const MPM_NS::Grid &grid, const double *values) : grid(grid), values(values) {}
  const Faces<dim> &at(const MPM_NS::Grid::Block &block, const int base[3])
  {
    return near.at(
        base,
        [](Faces<dim> &) {
        },
        [&](Faces<dim> &faces) {
          faces.find(MPMFlowStencil<dim>(grid, block, base), values);
        });
  }

 private:
  const MPM_NS::Grid &grid;
  const double *const values;
  MPMFlowNear<dim, Faces<dim>> near;
};

/** Velocities of several fields at a place and, if asked for, the gradients [flow_slopes(dim)] of
 *  the first one times the spacing (or its square). Components c are linear along each of the other
 *  axes between two layers of faces. bend: [dim] second derivatives along c, times the square of
 *  the spacing. */
template <int dim, int nfield, bool slopes>
void interpolate(const Faces<dim> *fields, const StaggeredWeights &w, double (*v)[dim], double *G,
                 double *bend)
{
  std::fill_n(v[0], nfield * dim, 0.0);
  if constexpr (slopes) {
    std::fill_n(G, flow_slopes(dim), 0.0);
    std::fill_n(bend, dim, 0.0);
  }
  for_each_axis<dim>([&](auto axis) {
    constexpr int c = axis, d = (c + 1) % dim, e = (c + 2) % 3;
    const double slope[3] = {w.f[c] - 1.0, 1.0 - 2.0 * w.f[c], w.f[c]};
    for (int k = 0; k < 3; k++) {
      const double spline = w.spline[c][k];
      for (int field = 0; field < nfield; field++) {
        const auto &rows = fields[field].at[c];
        double layer = rows[0][k], along_d = rows[1][k] - layer, along_e = 0.0, both = 0.0;
        layer += w.f[d] * along_d;
        if constexpr (dim == 3) {
          const double next = rows[2][k], next_d = rows[3][k] - next;
          both = next_d - along_d;
          along_d += w.f[e] * both;
          along_e = next + w.f[d] * next_d - layer;
          layer += w.f[e] * along_e;
        }
        v[field][c] += spline * layer;
        if (!slopes || field > 0) continue;
        bend[c] += k == 1 ? -2.0 * layer : layer;
        G[dim * c + c] += slope[k] * layer;
        G[dim * c + d] += spline * along_d;
        if constexpr (dim == 3) {
          G[3 * c + e] += spline * along_e;
          G[9 + c] += spline * both;
        }
      }
    }
  });
}

/** The same for one field; G: null if not asked for. */
template <int dim>
void interpolate(const Faces<dim> &faces, const StaggeredWeights &w, double *v, double *G)
{
  double one[1][dim], bend[dim];
  G ? interpolate<dim, 1, true>(&faces, w, one, G, bend)
    : interpolate<dim, 1, false>(&faces, w, one, nullptr, nullptr);
  std::copy_n(one[0], dim, v);
}

/** The same for one to four fields. */
template <int dim, bool slopes>
void interpolate_all(int nfield, const Faces<dim> *fields, const StaggeredWeights &w,
                     double (*v)[dim], double *G, double *bend)
{
  if (nfield == 1)
    interpolate<dim, 1, slopes>(fields, w, v, G, bend);
  else if (nfield == 2)
    interpolate<dim, 2, slopes>(fields, w, v, G, bend);
  else if (nfield == 3)
    interpolate<dim, 3, slopes>(fields, w, v, G, bend);
  else
    interpolate<dim, 4, slopes>(fields, w, v, G, bend);
}

/** Moves a velocity and its gradients, G: [flow_slopes(dim)], to a place that is shift away. */
template <int dim> void move_in_field(const double *shift, double *v, double *G)
{
  for (int c = 0; c < dim; c++) {
    for (int d = 0; d < dim; d++) v[c] += G[dim * c + d] * shift[d];
    if constexpr (dim == 3) {
      const int d = (c + 1) % 3, e = (c + 2) % 3;
      v[c] += G[9 + c] * shift[d] * shift[e];
      G[3 * c + d] += G[9 + c] * shift[e];
      G[3 * c + e] += G[9 + c] * shift[d];
    }
  }
}

/** Interpolates values in the middle of the cells around a place. */
template <int dim> double in_cells(const StaggeredWeights &w, const double *values)
{
  double sum = 0.0;
  for (int n = 0; n < MPMFlowStencil<dim>::CELLS; n++) {
    const int k[3] = {n >> (dim - 1) & 1, n >> (dim - 2) & 1, dim == 3 ? n & 1 : 0};
    sum += w.cell<dim>(k) * values[n];
  }
  return sum;
}

/** Viscosities of cells and edges, over the largest one, near places with the same base. */
template <int dim> struct Thickness {
  double in_cell[MPMFlowStencil<dim>::CELLS];
  double at_edge[dim == 2 ? 1 : 3][2];    // [pair][along the edge]

  void find(const MPMFlowStencil<dim> &stencil, const MPMFlowViscosities &of)
  {
    for (int n = 0; n < stencil.CELLS; n++) in_cell[n] = of.in_cell(stencil.cell(n));
    for (int pair = 0; pair < (dim == 2 ? 1 : 3); pair++)
      for (int k = 0; k < dim - 1; k++) {
        int to[3] = {1, 1, 1};
        if (dim == 3) to[2 - pair] = k;
        at_edge[pair][k] = of.at_edge(stencil.number(to), pair);
      }
  }
  /** Those at a place: of normal stresses, and of the shear stresses 01, 02, 12. */
  void at(const StaggeredWeights &w, double *of) const
  {
    of[0] = in_cells<dim>(w, in_cell);
    for (int pair = 0; pair < (dim == 2 ? 1 : 3); pair++) {
      const double *const edge = at_edge[pair];
      of[1 + pair] = dim == 2 ? edge[0] : edge[0] + w.f[2 - pair] * (edge[1] - edge[0]);
    }
  }
};

/** Adds the viscous stress of an incompressible fluid, without its pressure. G: gradients of the
 *  velocity, in units of the lattice. thick: factors of the viscosity for normal and shear
 *  stresses. */
template <int dim>
void add_viscous(double viscosity, const double *thick, double h, const double *G, double *stress)
{
  static constexpr int PAIRS[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  const double mu = viscosity / unit_of<dim>(0, h);
  double third = 0.0;
  for (int c = 0; c < dim; c++) third += G[dim * c + c] / 3.0;
  for (int c = 0; c < 3; c++)
    stress[c] += 2.0 * (thick[0] * mu) * ((c < dim ? G[dim * c + c] : 0.0) - third);
  for (int k = 0; k < (dim == 2 ? 1 : 3); k++) {
    const auto &[c, d] = PAIRS[k];
    stress[3 + k] += thick[1 + k] * mu * (G[dim * c + d] + G[dim * d + c]);
  }
}

/** What points with the same base get. */
template <int dim> struct Around {
  Faces<dim> fields[5];
  double pressure[MPMFlowStencil<dim>::CELLS];
  Thickness<dim> thickness;

  void find(const MPMFlowStencil<dim> &stencil, int nfield, const double *const *values,
            const double *pressures, const MPMFlowViscosities *viscosities)
  {
    for (int field = 0; field < nfield; field++) fields[field].find(stencil, values[field]);
    for (int n = 0; n < stencil.CELLS; n++) pressure[n] = pressures[stencil.cell(n)];
    if (viscosities) thickness.find(stencil, *viscosities);
  }
};

/** New velocity v of a point that keeps a share of the part of its velocity that cells do not see.
 *  now, old: velocities of the lattice at the point, at the end and at the start of the step. Adds
 *  to squares[2], see MPMFlowUpdate. */
template <int dim>
void keep_unseen(const MPMFlowUpdate &update, double mass, const double *now, const double *old,
                 const double *bend, double *v, double *squares)
{
  for (int c = 0; c < dim; c++) {
    const double unseen = v[c] - old[c];
    if (update.squares) {
      squares[0] += mass * unseen * unseen;
      squares[1] += mass * bend[c] * bend[c];
    }
    v[c] = now[c] + update.flip * unseen;
  }
}

/** Changes the velocity v of point i by its gradient along a shift, unless it keeps the velocity.
 *  Adds the change of the kinetic energy and the work of forces to energy[2]. */
template <int dim>
void change_by_shift(const MPMFlowPoints &points, int i, const double *shift, bool keeps, double *v,
                     double *energy)
{
  double before = 0.0, after = 0.0, work = 0.0;
  for (int c = 0; c < dim; c++) before += v[c] * v[c];
  if (points.gradient && !keeps) move_in_field<dim>(shift, v, points.gradient[i]);
  for (int c = 0; c < dim; c++) {
    after += v[c] * v[c];
    work += points.f[i][c] * shift[c];
  }
  energy[0] += 0.5 * points.mass[i] * (after - before);
  energy[1] += work;
}

template <int dim>
bool get(const MPMFlowLattice &cells, const MPMFlowPoints &points, const double *velocity,
         const MPMFlowUpdate &update, const double *pressure, MPMRows stress)
{
  const Places<dim> places(cells.lattice);
  StaggeredWeights w;
  bool all_in_reach = true;
  double squares[2] = {0.0, 0.0}, energy[4] = {0.0, 0.0, 0.0, 0.0};
  // and, if there are such: those before, those after an impulse, the shift, more
  const double *fields[5] = {velocity};
  const int at_old = 1, at_struck = update.old ? 2 : 1, at_shift = at_struck + !!update.struck,
            at_more = at_shift + (update.shift ? 1 : 0);
  if (update.old) fields[at_old] = update.old;
  if (update.struck) fields[at_struck] = update.struck;
  if (update.shift) fields[at_shift] = update.shift;
  if (update.more) fields[at_more] = update.more;
  const int nall = at_more + (update.more ? 1 : 0);
  double thick[4] = {1.0, 1.0, 1.0, 1.0};    // of one liquid
  MPMFlowNear<dim, Around<dim>> near;
  FacesNear<dim> at_starts(cells.grid, update.paths),
      at_middles(cells.grid, update.paths ? update.paths : velocity);
  for (const auto &run : cells.runs) {
    const auto &block = cells.grid.blocks[run.slot];
    for (int nth = run.first; nth < run.last; nth++) {
      const int i = cells.points[nth];
      double *const x = points.x[i], *const v = points.v[i];
      int base[3];    // at the end of the step
      places.find(x, w);
      const auto &around = near.at(
          w.base,
          [](Around<dim> &) {
          },
          [&](Around<dim> &one) {
            one.find({cells.grid, block, w.base}, nall, fields, pressure, update.viscosities);
          });
      constexpr int NSLOPE = flow_slopes(dim);
      const bool solid = update.solids && update.solids->holds(i);
      const int nfield = at_shift + (update.shift && !solid ? 1 : 0);
      double at_point[4][dim], G[NSLOPE], bend[dim], more[dim] = {}, G_more[NSLOPE];
      points.gradient || update.viscosity > 0.0
          ? interpolate_all<dim, true>(nfield, around.fields, w, at_point, G, bend)
          : interpolate_all<dim, false>(nfield, around.fields, w, at_point, nullptr, nullptr);
      const double *const now = at_point[0];
      const double p = in_cells<dim>(w, around.pressure);
      if (solid)
        update.solids->set_pressure(stress[i], p);
      else
        for (int c = 0; c < 6; c++) stress[i][c] = c < 3 ? -p : 0.0;
      if (!solid && update.viscosity > 0.0) {
        if (update.viscosities) around.thickness.at(w, thick);
        add_viscous<dim>(update.viscosity, thick, cells.lattice.h, G, stress[i]);
      }

      if (update.inflow && update.inflow->carry(x, v, points.half_kick[i], points.dt)) {
        if (points.gradient) std::fill_n(points.gradient[i], NSLOPE, 0.0);
        places.keep_inside(x);
        places.find_base(x, base);
        all_in_reach = all_in_reach && cells.in_reach<dim>(run, base);
        continue;
      }
      double *const half_kick = points.half_kick[i];
      std::copy_n(update.struck ? at_point[at_struck] : v, dim, half_kick);
      if (update.old)
        keep_unseen<dim>(update, points.mass[i], now, at_point[at_old], bend, v, squares);
      else
        std::copy_n(now, dim, v);
      if (update.more) {
        interpolate<dim>(around.fields[at_more], w, more, points.gradient ? G_more : nullptr);
        for (int c = 0; c < dim; c++) v[c] += more[c];
        for (int e = 0; points.gradient && e < NSLOPE; e++) G[e] += G_more[e];
      }
      for (int c = 0; c < dim; c++) half_kick[c] = update.half_kick_share * (v[c] - half_kick[c]);
      if (points.gradient)
        for (int e = 0; e < NSLOPE; e++)
          points.gradient[i][e] = solid && update.gains ? 0.0
                                                        : G[e] / unit_of<dim>(e, cells.lattice.h);

      double shift[dim] = {};
      if (update.shift && !solid) {
        std::copy_n(at_point[at_shift], dim, shift);
        change_by_shift<dim>(points, i, shift, update.gains, v, update.shift_energy);
      }

      // The midpoint rule in the field of velocities, which has no divergence. With all of the
      // change once more, velocities are those in the middle of the step where points were at its
      // start, and paths are straight

      double middle[3] = {x[0], x[1], x[2]}, at_middle[dim], from[dim];
      std::copy_n(x, dim, from);
      const double *start = now;
      double at_start[dim];
      if (update.paths) {
        interpolate<dim>(at_starts.at(block, w.base), w, at_start, nullptr);
        start = at_start;
      }
      for (int d = 0; d < dim; d++) middle[d] += 0.5 * points.dt * start[d];
      places.keep_inside(middle);
      places.find(middle, w);
      interpolate<dim>(at_middles.at(block, w.base), w, at_middle, nullptr);
      for (int d = 0; d < dim; d++) {
        const double u = at_middle[d] + update.reflect * (start[d] - at_middle[d]) + more[d];
        x[d] += points.dt * u + shift[d];
      }
      places.keep_inside(x);
      bool next_to_region = false;
      if (update.regions) {
        next_to_region = update.regions->keep_outside(x, v) < cells.lattice.h;
        places.keep_inside(x);
      }
      double force_square = 0.0;
      for (int c = 0; c < dim; c++) {
        v[c] += half_kick[c];
        energy[0] += points.mass[i] * v[c] * v[c];
        energy[1] += points.f[i][c] * (x[c] - from[c]);
        force_square += points.f[i][c] * points.f[i][c];
      }
      energy[next_to_region ? 3 : 2] += std::sqrt(force_square);
      places.find_base(x, base);
      all_in_reach = all_in_reach && cells.in_reach<dim>(run, base);
    }
  }
  if (update.squares) std::copy_n(squares, 2, update.squares);
  if (update.energy) std::copy_n(energy, 4, update.energy);
  return all_in_reach;
}

template <int dim>
void get_gradient(const MPMFlowLattice &cells, const MPMFlowPoints &points, const double *velocity,
                  double share)
{
  const Places<dim> places(cells.lattice);
  StaggeredWeights w;
  FacesNear<dim> near(cells.grid, velocity);
  double v[dim], G[flow_slopes(dim)];
  for (const auto &run : cells.runs)
    for (int nth = run.first; nth < run.last; nth++) {
      const int i = cells.points[nth];
      places.find(points.x[i], w);
      interpolate<dim>(near.at(cells.grid.blocks[run.slot], w.base), w, v, G);
      for (int e = 0; e < flow_slopes(dim); e++) {
        double &g = points.gradient[i][e];
        g += share * (G[e] / unit_of<dim>(e, cells.lattice.h) - g);
      }
    }
}
}    // namespace

/* ---------------------------------------------------------------------- */

void LAMMPS_NS::give_to_cells(const MPMFlowLattice &cells, const MPMFlowPoints &points,
                              std::vector<double> &sums)
{
  const int dim = cells.lattice.dim;
  sums.assign(cells.size() * (3 * dim + 1), 0.0);
  dim == 2 ? give<2>(cells, points, sums) : give<3>(cells, points, sums);
}

void LAMMPS_NS::give_volumes_to_faces(const MPMFlowLattice &cells, const MPMFlowPoints &points,
                                      std::vector<double> &sums)
{
  const int dim = cells.lattice.dim;
  sums.assign(cells.size() * 2 * dim, 0.0);
  dim == 2 ? give_volumes<2>(cells, points, sums) : give_volumes<3>(cells, points, sums);
}

bool LAMMPS_NS::get_from_cells(const MPMFlowLattice &cells, const MPMFlowPoints &points,
                               const double *velocity, const MPMFlowUpdate &update,
                               const double *pressure, MPMRows stress)
{
  return cells.lattice.dim == 2 ? get<2>(cells, points, velocity, update, pressure, stress)
                                : get<3>(cells, points, velocity, update, pressure, stress);
}

void LAMMPS_NS::get_gradients(const MPMFlowLattice &cells, const MPMFlowPoints &points,
                              const double *velocity, double share)
{
  cells.lattice.dim == 2 ? get_gradient<2>(cells, points, velocity, share)
                         : get_gradient<3>(cells, points, velocity, share);
}
