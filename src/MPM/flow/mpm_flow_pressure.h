/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_PRESSURE_H
#define LMP_MPM_FLOW_PRESSURE_H

#include "field/mpm_node_system.h"
#include "flow/mpm_flow_fourier.h"
#include "flow/mpm_flow_lattice.h"
#include "flow/mpm_flow_poisson.h"
#include "flow/mpm_flow_rows.h"
#include "solve/cell_operator.h"
#include "solve/krylov.h"

#include <memory>
#include <vector>

namespace LAMMPS_NS {
class MPMFlowBodies;
class MPMFlowGasRows;
class MPMFlowRegions;

/** The pressure that makes a flow free of divergence: the Poisson equation on the cells that are
 *  wet.
 *
 *  Cells are wet if points fill more than one half of their surroundings, or less if water is all
 *  around: points in a flow become uneven, and gaps between them are not air. The surface is where
 *  points fill one half: a hat at the depth s below a flat surface is filled to 1/2 + s - s^2/2 by
 *  points that are squares (cubes). This gives the distance from the middle of a wet cell at which
 *  the pressure is zero (F. Gibou, R.P. Fedkiw, L.-T. Cheng, M. Kang, J. Comput. Phys. 176 (2002)
 *  205).
 *
 *  The unknown is the potential psi = dt p/density, whose gradient is subtracted from velocities;
 *  with several densities it is first multiplied by this density over the density at the face. The
 *  preconditioner of the solver is multigrid, or Fourier transforms, which are faster where water
 *  fills a box (MPMFlowFourier). The equations for spreading points reach only a few cells, and the
 *  diagonal is enough for them (MPMFlowSpread). */
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
  /** [cell] volume that enters a cell per time, over its volume [1/time], of all cells; null:
   *  none. */
  const std::vector<double> *sources = nullptr;

  /** [cell][dim] density in psi over the density at faces, of all cells; null: there is one
   *  density. */
  const std::vector<double> *inverse_density = nullptr;

  /** Uses Fourier transforms as the preconditioner, instead of multigrid; see
   *  MPMFlowFourier::is_there(). */
  void use_fourier();

  /** Density of a cell over that in psi: the mean of its open faces. */
  double density_in(const MPMFlowLattice::Cell &) const;

  /** Finds the wet cells. share: [cell] share of its surroundings that is filled, also of periodic
   *  images and images beyond walls. Must stay valid while this object is used. */
  void find_wet(const std::vector<double> &share);
  /** Sets the share of the gradient of psi that velocities of faces lose, [cell][dim] of all cells,
   *  if objects in the water resist its motion; null: all of it. Holds until the next
   *  find_wet(). */
  void set_mobility(const std::vector<double> *);
  bool is_wet(int64_t number) const { return flag[number] > 0.0; }
  /** Is a cell wet, and are all neighbors, except behind walls? */
  bool is_deep(const MPMFlowLattice::Cell &) const;

  /** Is the lower face of a cell along an axis in a wall, or open next to a wet cell? */
  bool is_next_to_water(const MPMFlowLattice::Cell &cell, int axis) const
  {
    return cell.walls >> 2 * axis & 1 ||
        ((is_wet(cell.number) || is_wet(cell.near[2 * axis])) && aperture(cell.number, axis) > 0.0);
  }
  /** Open share of the lower face of a cell along an axis. */
  double aperture(int64_t cell, int axis) const;

  /** Least distance of the surface from the middle of a cell in the equations, in spacings. If
   *  surfaces have a pressure, its difference to the pressure in the cell loses as many digits as
   *  this has. */
  double nearest = 1.0e-8;

  /** Distance from the middle of a wet cell to the surface, towards a neighbor that is dry, in
   *  spacings. */
  double distance(int64_t wet_cell, int64_t dry) const;

  /** Removes the divergence from velocities [cell][dim] of faces next to wet cells. known:
   *  [cell][dim] is 1 for these faces, and 0 for others. after and known have values in owned cells
   *  only. surface: [cell][dim] psi of a free surface between a cell and its lower neighbor along
   *  an axis, of all cells; null: zero. gas: its pressure is found together with psi, and surface
   *  is its at_surface(); null: none. Collective. */
  MPM_NS::SolveReport project(const double *before, double *after, double *known,
                              const MPM_NS::SolveGoal &,
                              const std::vector<double> *surface = nullptr,
                              MPMFlowGasRows *gas = nullptr);
  /** Finds displacements of faces that move points from cells that they overfill to cells that they
   *  do not fill, away from surfaces: their divergence is rate (share - 1), with an effect that is
   *  limited to a few cells. As in T. Kugelstadt, A. Longva, N. Thuerey, J. Bender, IEEE Trans.
   *  Vis. Comput. Graph. 27 (2021) 2731. Collective. */
  MPM_NS::SolveReport spread(double rate, double *displacement, double *known,
                             const MPM_NS::SolveGoal &);

  std::vector<double> psi;    ///< of all cells, zero where there is no water
  /** Largest |div v| of the wet cells of this rank, less sources [1/time]. */
  double largest_divergence(const double *velocity) const;
  /** Adds the net outflow of the wet cells of this rank, less sources, to out, and the sources to
   *  in [volume/time, in 2d area/time]. */
  void add_balance(const double *velocity, double *out, double *in) const;
  int64_t nwet() const { return (int64_t) wet.size(); }    ///< number of wet cells of this rank
  /** Sets values to psi of all cells. Dry cells next to the surface get values for which linear
   *  interpolation gives psi at the surface, zero or that of project(); cells farther away get psi
   *  of the gas. Collective. */
  void extend_into_air(std::vector<double> &values, const std::vector<double> *surface = nullptr,
                       const MPMFlowGasRows *gas = nullptr) const;
  /** Integral of psi over a wall of the box, the share of this rank. */
  double at_wall(int axis, int side) const;

  /** Flux through a side of a cell, positive along its axis, per area, including the flux that a
   *  wall in it carries. Through a wall of the box goes only the flux of regions that move
   *  there. */
  double flux_of_side(const double *velocity, const MPMFlowLattice::Cell &cell, int side) const;
  /** Calls f(cell, side, weight) for all sides of wet cells of this rank that are free surfaces.
   *  weight: of psi at the surface in the equation of the cell. */
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
    int near[6];         // numbers of wet neighbors; -1: dry, or a wall
    double weight[6];    // of the difference to the neighbor, 1/h^2; dry: of psi itself; walls: 0
    double diagonal;
  };
  const MPMFlowLattice &cells;
  MPMLatticeRanks ranks;
  MPM_NS::CellOperator coefficients;    // of the equations, for the multigrid preconditioner
  MPMFlowRows rows;                     // of the wet cells
  MPMFlowPoisson poisson;
  std::unique_ptr<MPMFlowFourier> fourier;                  // null: multigrid
  bool rows_are_there = false, levels_are_there = false;    // for the cells that are wet now
  std::vector<Wet> wet;
  std::vector<double> excess, lift, flag, right_side, solution;
  const double *filled = nullptr;
  const std::vector<double> *mobility = nullptr;
  MPMFlowSpread equal_filling;
  std::vector<double> diagonal, weight;    // of the rows of equal_filling
  MPM_NS::ConjugateGradients method;

  int64_t size() const { return cells.size(); }
  void find_rows();
  void weigh_rows(double screen, std::vector<double> &diagonal, std::vector<double> &weight) const;
  void to_cells(const std::vector<double> &row_values, std::vector<double> &cell_values) const;
  void find_lift(const std::vector<double> &surface);
  /** Factor of the difference of psi, or of psi itself where the other cell is dry: 1/h^2 over the
   *  distance in spacings. */
  double weight_to(int64_t wet_cell, int64_t other) const
  {
    const double h = cells.lattice.h;
    return 1.0 / (h * h * (is_wet(other) ? 1.0 : distance(wet_cell, other)));
  }
  double aperture_of_side(const MPMFlowLattice::Cell &cell, int side) const;
  double outflow(const double *velocity, const MPMFlowLattice::Cell &) const;
  void subtract_gradient(const std::vector<double> &of, const double *before, double *after,
                         double *known, const std::vector<double> *surface = nullptr) const;
  bool is_surrounded(const MPMFlowLattice::Cell &) const;
  void follow_neighbors();
  void find_weights();
  void find_levels();
  void find_box();
  double light(int64_t cell, int axis) const
  {
    return inverse_density ? (*inverse_density)[cell * cells.lattice.dim + axis] : 1.0;
  }
};

}    // namespace LAMMPS_NS
#endif
