/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_TRANSFER_H
#define LMP_MPM_FLOW_TRANSFER_H

#include "base/mpm_rows.h"
#include "flow/mpm_flow_lattice.h"
#include "lattice/staggered.h"

#include <vector>

namespace LAMMPS_NS {
class MPMFlowInflow;
class MPMFlowRegions;
class MPMFlowSolids;
class MPMFlowViscosities;

/** Width of the rows of velocity gradients of points: dv_c/dx_d at dim c + d and, in 3d, d2v_c/dx_d
 *  dx_e at 9 + c, with the two other axes d and e. Across c, the functions of faces consist of hats
 *  along these axes only. With the products, points at rest give the lattice exactly the velocities
 *  that it gave them; without the products the lattice would lose some of them in each step. */
constexpr int flow_slopes(int dim)
{
  return dim * dim + (dim == 3 ? 3 : 0);
}

/** Rows of the points that are transferred to and from the staggered lattice of a flow. */
struct MPMFlowPoints {
  double **x, **v, **f;
  const double *mass, *volume;
  MPMRows gradient;    ///< [n][flow_slopes(dim)]; null: no gradients
  double dt;
  MPMRows half_kick = {};    ///< [n][dim] see MPMFlow; only for get_from_cells()
};

/** How points get their velocity from the cells. */
struct MPMFlowUpdate {
  /** Share that points keep of the part of their velocities that cells do not resolve. */
  double flip;
  const double *old;     ///< [cell][dim] velocities before forces and pressure; null: no flip
  double reflect;        ///< share of the change by forces and pressure that is added a second time
  const double *more;    ///< [cell][dim] the change that is added; null: no reflection
  /** Share of their change by which velocities of points go on from the middle of the step to its
   *  end. */
  double half_kick_share;
  /** [cell][dim] velocities before that change, where an impulse has changed those of points
   *  before; null: those of points are. */
  const double *struck;
  /** [cell][dim] displacements of points in addition to the motion with their velocity; the
   *  velocities are changed to fit the new places in the field of velocities. null: none. */
  const double *shift = nullptr;
  const MPMFlowRegions *regions = nullptr;    ///< regions that points must not enter; null: none
  const MPMFlowInflow *inflow = nullptr;      ///< inlets that move the points in them; null: none
  /** Points that keep the stress of their material law and are not shifted; null: none. */
  const MPMFlowSolids *solids = nullptr;
  /** Receives two mass-weighted sums over the points of this rank: of the squares of the velocities
   *  that cells do not resolve, and of the squares of h^2 d2v_c/dx_c^2. In a smooth flow, the first
   *  is a small share of the second. null: not wanted. Only with gradients and flip. */
  double *squares = nullptr;
  /** Two sums over the points of this rank are added to it, both due to the shift: the change of
   *  the kinetic energy, and the work of forces along the shift. */
  double *shift_energy = nullptr;
  /** Has the flow gained energy? Points then keep their velocities in the shift, and those of
   *  solids have no gradients, which damps them. */
  bool gains = false;
  /** Receives four sums over the points of this rank: mass times the square of the velocity after
   *  the step, the work of forces along the way in the step, and the magnitudes of forces, apart
   *  for points less than a spacing from a region, which are the last sum. */
  double *energy = nullptr;
  /** [cell][dim] velocities that points move with; null: their new velocities. */
  const double *paths = nullptr;
  /** Viscosity of the stress that fluid points have in addition to the pressure. */
  double viscosity = 0.0;
  /** Viscosities of cells and edges over this one, of several liquids; null: there is one. Points
   *  have those of the boxes in which the gradients of velocities are constant, so that a shear
   *  stress is the same on both sides of an interface. */
  const MPMFlowViscosities *viscosities = nullptr;
};

/** Transfer from points to cells. sums: [cell][3 dim + 1] with momentum, mass, and force at faces,
 *  and the volume at the middle of cells. A point gives a face normal to c the mass m N and the
 *  momentum m N (v_c + grad v_c . (x_i - x)), plus the part from the product of slopes. If the
 *  gradient comes from get_from_cells(), the momentum and angular momentum of the faces are those
 *  of the points; the angular momentum includes m g_ce D_e from the gradients of the points, with
 *  D_e = f (1 - f) h^2. */
void give_to_cells(const MPMFlowLattice &, const MPMFlowPoints &, std::vector<double> &sums);

/** Volume that points give to faces, with the same weights as their mass; stored in the second half
 *  of sums [cell][2 dim]. */
void give_volumes_to_faces(const MPMFlowLattice &, const MPMFlowPoints &,
                           std::vector<double> &sums);

/** Transfer from cells to points: velocities and gradients, and the motion of points through the
 *  field of velocities [cell][dim] by the midpoint rule. pressure: [cell], is stored in
 *  stress[i][0..2]. Returns false if the cells of any point must be found anew. */
bool get_from_cells(const MPMFlowLattice &, const MPMFlowPoints &, const double *velocity,
                    const MPMFlowUpdate &, const double *pressure, MPMRows stress);

/** Updates only the gradients of points: adds this share of the difference to those of the field of
 *  velocities. */
void get_gradients(const MPMFlowLattice &, const MPMFlowPoints &, const double *velocity,
                   double share);

}    // namespace LAMMPS_NS
#endif
