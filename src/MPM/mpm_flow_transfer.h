/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_TRANSFER_H
#define LMP_MPM_FLOW_TRANSFER_H

#include "lattice/staggered.h"
#include "mpm_flow_lattice.h"
#include "mpm_rows.h"

#include <vector>

namespace LAMMPS_NS {
class MPMFlowInflow;
class MPMFlowRegions;
class MPMFlowSolids;

/** Width of the rows of velocity gradients of points: dv_c/dx_d, at dim c + d, and in 3d d2v_c/dx_d dx_e with the two other axes d and e,
 *  at 9 + c. Hats along these are all that the functions of faces have there, so that points at rest tell the lattice the very
 *  velocities across c that it has told them; without the products it would lose some of them in each step. */
constexpr int flow_slopes(int dim)
{
  return dim * dim + (dim == 3 ? 3 : 0);
}

/** What points and the staggered lattice of a flow tell each other. */
struct MPMFlowPoints {
  double **x, **v, **f;
  const double *mass, *volume;
  MPMRows gradient;    ///< [n][flow_slopes(dim)], null: none
  double dt;
};

/** How points get their velocity from the cells. */
struct MPMFlowUpdate {
  double flip;           ///< share of what cells do not see of velocities that points keep
  const double *old;     ///< [cell][dim] velocities before forces and pressure; null: without flip
  double reflect;        ///< share of the change by these that comes once more
  const double *more;    ///< [cell][dim] what comes once more; null: without reflect
  /** [cell][dim] displacements, besides the motion with the velocity, with which points keep their place in the field of
   *  velocities; null: none. */
  const double *shift = nullptr;
  const MPMFlowRegions *regions = nullptr;    ///< that points stay out of; null: none
  const MPMFlowInflow *inflow = nullptr;      ///< mouths whose points it moves; null: none
  /** Points that keep the stress of their law, and do not spread; null: none. */
  const MPMFlowSolids *solids = nullptr;
  /** Gets two sums over the points of this rank, with their masses: of the squares of what cells do not see of velocities, and of
   *  h^2 d2v_c/dx_c^2, of which the former is a small share in a smooth flow; null: not asked for. With gradients and flip alone. */
  double *squares = nullptr;
  /** Two sums over the points of this rank are added to it, of what the shift does: the change of the kinetic energy, and the work of forces on the way. */
  double *of_shift = nullptr;
  const double *paths =
      nullptr;    ///< [cell][dim] velocities that points move with; null: those that they get
  double viscosity = 0.0;    ///< stress that points of the fluid have besides the pressure
};

/** Cells from points. sums: [cell][3 dim + 1] momentum, mass, and force at faces, volume in the middle of cells. A point gives a
 *  face normal to c its mass m N, and m N (v_c + grad v_c . (x_i - x)), and what the product of slopes adds. Where the gradient is that of get(), momentum and
 *  angular momentum of the faces are those of the points, with m g_ce D_e for the latter from their gradients, D_e =
 *  f (1 - f) h^2. */
void give_to_cells(const MPMFlowLattice &, const MPMFlowPoints &, std::vector<double> &sums);

/** Volume that points give to faces, with the weights of their mass: sums [cell][2 dim], the second half. */
void give_volumes_to_faces(const MPMFlowLattice &, const MPMFlowPoints &,
                           std::vector<double> &sums);

/** Points from cells: their velocities and gradients, and their motion through the field of velocities [cell][dim], by the
 *  midpoint rule. pressure: [cell], goes to stress[i][0..2]. Returns false when a point has to have its cells found anew. */
bool get_from_cells(const MPMFlowLattice &, const MPMFlowPoints &, const double *velocity,
                    const MPMFlowUpdate &, const double *pressure, MPMRows stress);

/** Gradients of points alone. */
void get_gradients(const MPMFlowLattice &, const MPMFlowPoints &, const double *velocity);

}    // namespace LAMMPS_NS
#endif
