/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_PRESSURE_H
#define LMP_MPM_FLOW_PRESSURE_H

#include "mpm_flow_lattice.h"
#include "mpm_flow_poisson.h"
#include "mpm_flow_rows.h"
#include "mpm_flow_spread.h"
#include "mpm_lattice_ranks.h"
#include "solve/cell_operator.h"
#include "solve/krylov.h"

#include <vector>

namespace LAMMPS_NS {
class MPMFlowBodies;
class MPMFlowGasRows;
class MPMFlowRegions;

/** The pressure that makes a flow free of divergence: the Poisson equation on the cells that are wet.
 *
 *  Cells are wet where points fill more than one half of their surroundings, or less if water is all around: points that
 *  flow are not as even as they were, and what is left between them is no air. The surface is where they fill one half:
 *  a hat that has the depth s below a flat surface is filled by 1/2 + s - s^2/2 of points that are squares (cubes), which tells how far from the middle of a
 *  wet cell the pressure is zero (F. Gibou, R.P. Fedkiw, L.-T. Cheng, M. Kang, J. Comput. Phys. 176 (2002) 205).
 *
 *  The unknown is the potential psi = dt p/density, whose gradient velocities lose, times that density over the one at the face where there
 *  are several. Its solve has a multigrid preconditioner,
 *  which is the faster one from the smallest flows on; that of points that spread reaches but a few cells, and the diagonal is enough
 *  (MPMFlowSpread). */
class MPMFlowPressure : protected Pointers {
 public:
  MPMFlowPressure(class LAMMPS *lmp, const MPMFlowLattice &cells) :
      Pointers(lmp), cells(cells), ranks(lmp, cells.grid, cells.halo_of_cells()),
      coefficients(cells.grid, ranks), rows(lmp, cells), poisson(lmp, cells, rows),
      equal_filling(lmp, rows)
  {
  }

  /** Regions that are solid; null: none. */
  const MPMFlowRegions *regions = nullptr;
  /** Rigid bodies that the pressure moves; null: none. */
  const MPMFlowBodies *bodies = nullptr;
  /** [cell] rate of its volume that comes into a cell, of all cells; null: nothing comes. */
  const std::vector<double> *sources = nullptr;

  /** [cell][dim] density that psi is for over that at faces, of all cells; null: one density. */
  const std::vector<double> *lightness = nullptr;

  /** share: [cell] of its surroundings that is filled, with periodic images, and those beyond walls. */
  void find_wet(const std::vector<double> &share);
  /** Share of the gradient of psi that velocities of faces [cell][dim] lose, of all cells, if what is in the water resists its
   *  motion; null: all of it. Counts until find_wet(). */
  void set_mobility(const std::vector<double> *);
  bool is_wet(int64_t number) const { return flag[number] > 0.0; }
  /** Wet, and so are all neighbors. */
  bool is_deep(const MPMFlowLattice::Cell &) const;

  /** Is the lower face of a cell along an axis in a wall, or open next to a wet cell? */
  bool is_next_to_water(const MPMFlowLattice::Cell &cell, int axis) const
  {
    return cell.walls >> 2 * axis & 1 ||
        ((is_wet(cell.number) || is_wet(cell.near[2 * axis])) && open(cell.number, axis) > 0.0);
  }
  /** Open share of the lower face of a cell along an axis. */
  double open(int64_t cell, int axis) const;

  /** Nearest place of the surface to the middle of a cell that equations are made for, in spacings. Where surfaces have a
   *  pressure, its difference to that in the cell loses as many digits as this has. */
  double nearest = 1.0e-8;

  /** From the middle of a wet cell to the surface, towards a neighbor that is dry, in spacings. */
  double distance(int64_t wet_cell, int64_t dry) const;

  /** Takes the divergence from velocities [cell][dim] of faces next to wet cells. known: [cell][dim] in which these are
   *  marked with 1, and others with 0. Both have values in owned cells only. surface: [cell][dim] psi of a free surface
   *  between a cell and the one before it along an axis, of all cells; null: zero. gas: whose pressure is found with it, and that has surface; null: none. */
  MPM_NS::SolveReport project(const double *before, double *after, double *known,
                              const MPM_NS::SolveGoal &,
                              const std::vector<double> *surface = nullptr,
                              MPMFlowGasRows *gas = nullptr);
  /** Displacements of faces that take points from where they fill more than all of a cell to where they leave some of it
   *  empty, and no surface is near: their divergence is rate (share - 1), but for what is farther than a few cells. As in
   *  T. Kugelstadt, A. Longva, N. Thuerey, J. Bender, IEEE Trans. Vis. Comput. Graph. 27 (2021) 2731. */
  MPM_NS::SolveReport spread(double rate, double *displacement, double *known,
                             const MPM_NS::SolveGoal &);

  std::vector<double> psi;    ///< of all cells, zero where there is no water
  /** Largest |div v| of the wet cells of this rank [1/time]. */
  double largest_divergence(const double *velocity) const;
  /** What flows out of the wet cells of this rank and does not come into them, and what comes (volume/time, in 2d area). */
  void add_balance(const double *velocity, double *out, double *in) const;
  int64_t nwet() const { return (int64_t) wet.size(); }    ///< of this rank
  /** psi with values next to the surface that make it what it is there in between, zero or that of project(), and farther away that of
   *  gas; of all cells. */
  void extend_into_air(std::vector<double> &values, const std::vector<double> *surface = nullptr,
                       const MPMFlowGasRows *gas = nullptr) const;
  /** Integral of psi over the wall of an axis, the share of this rank. */
  double at_wall(int axis, int side) const;

  /** What flows through a side of a cell along its axis, per area, with what a wall in it carries along. Through a wall of the box goes but
   *  what moves there of a region. */
  double flux_of_side(const double *velocity, const MPMFlowLattice::Cell &cell, int side) const;
  /** Calls f(cell, side, weight) for all sides of wet cells of this rank that are free surfaces; weight: of psi there in the equation of the cell. */
  template <class F> void visit_surface(const F &f) const
  {
    for (const auto &one : wet)
      for (int s = 0; s < 2 * cells.lattice.dim; s++)
        if (one.near[s] < 0 && one.weight[s] != 0.0) f(cells.cells[one.cell], s, one.weight[s]);
  }

  double memory_usage() const;

 private:
  struct Wet {
    int cell;            // in the list of cells
    int near[6];         // numbers; of neighbors that are dry, the cell itself
    double weight[6];    // of the difference to the neighbor, 1/h^2; of dry ones, of psi itself
    double diagonal;
  };
  const MPMFlowLattice &cells;
  MPMLatticeRanks ranks;
  MPM_NS::CellOperator coefficients;    // as the multigrid preconditioner has them
  MPMFlowRows rows;                     // of the wet cells
  MPMFlowPoisson poisson;
  bool rows_are_there = false, levels_are_there = false;    // for the cells that are wet now
  std::vector<Wet> wet;
  std::vector<double> excess, lift, flag, right_side, solution;
  const double *share_of = nullptr;
  const std::vector<double> *mobility = nullptr;
  MPMFlowSpread equal_filling;
  std::vector<double> diagonal, weight;    // of its rows
  MPM_NS::ConjugateGradients method;

  int64_t size() const { return cells.size(); }
  void find_rows();
  void weigh_rows(double screen, std::vector<double> &diagonal, std::vector<double> &weight) const;
  void to_cells(const std::vector<double> &of_rows, std::vector<double> &of_cells) const;
  void find_lift(const std::vector<double> &surface);
  double weight_to(int64_t wet_cell, int64_t other) const;
  double open_side(const MPMFlowLattice::Cell &cell, int side) const;
  double outflow(const double *velocity, const MPMFlowLattice::Cell &) const;
  void subtract_gradient(const std::vector<double> &of, const double *before, double *after,
                         double *known, const std::vector<double> *surface = nullptr) const;
  bool is_surrounded(const MPMFlowLattice::Cell &) const;
  void follow_neighbors();
  void find_weights();
  void find_levels();
  double light(int64_t cell, int axis) const
  {
    return lightness ? (*lightness)[cell * cells.lattice.dim + axis] : 1.0;
  }
};

}    // namespace LAMMPS_NS
#endif
