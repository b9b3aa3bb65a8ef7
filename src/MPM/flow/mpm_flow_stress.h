/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_STRESS_H
#define LMP_MPM_FLOW_STRESS_H

#include "flow/mpm_flow_pressure.h"
#include "flow/mpm_flow_stick.h"
#include "flow/mpm_flow_viscosity.h"
#include "solve/linear_system.h"

#include <vector>

namespace LAMMPS_NS {
/** Viscosity of an incompressible fluid in an implicit step, together with the pressure (E.
 *  Larionov, C. Batty, R. Bridson, ACM Trans. Graph. 36 (2017) 101). Velocities u and stresses
 *  sigma at the end of a step dt satisfy
 *
 *    density (u - u_1)/dt = div sigma,   dev sigma = 2 mu dev D(u),   div u = 0,
 *
 *  without traction at free surfaces. Pressure and viscous stress belong together: a surface
 *  without traction has the pressure 2 mu dv_n/dx_n. With a viscous step that ignores it, a
 *  stretched sheet is too soft by a factor of two as soon as dt is more than thickness^2/nu.
 *
 *  The unknowns are S = dt sigma/(density h), a velocity. Its normal components, [c], are in the
 *  middle of wet cells, its shear components, [dim + pair], at the lower edges of cells. Velocities
 *  are eliminated, so that the system is symmetric and positive definite, and conserves momentum
 *  and angular momentum, however accurately it is solved:
 *
 *    W C S + W E M^-1 E^T W S = W E u_1,
 *
 *  with differences E of velocities, their transpose E^T, which is minus the divergence of a
 *  stress, volumes W of cells and edges, masses M of faces (both up to the surface, in units of a
 *  cell), and the compliance C.
 *
 *  Walls of the box that stick drag the faces next to them: this adds a mass with the velocity of
 *  the wall to M. Next to regions that stick, strains are means over the open parts of cells and of
 *  boxes around edges, by what flows through their sides, and volumes and masses are those of open
 *  parts (MPMFlowStick). Faces that are nearly closed have the velocity of the region, and an
 *  inverse mass of zero. Fluid that enters a cell (MPMFlowPressure::sources) does so equally from
 *  all directions: it is no strain, and a third of it (in 2d one half) is subtracted from each
 *  normal component of E u_1.
 *
 *  With several liquids, S has the density of psi, masses are those of the densities of faces, and
 *  the compliance is that of the viscosity in a cell or at an edge. Where this is small, the normal
 *  components of a cell are bound to each other much more than to their neighbors. The
 *  preconditioner then has the equations of these components as a whole, without their neighbors:
 *  with the diagonal alone, the pressure in thin liquids would converge by the ratio of
 *  viscosities. */
class MPMFlowStress : public MPM_NS::LinearSystem {
 public:
  MPMFlowStress(class LAMMPS *lmp, const MPMFlowLattice &cells, const MPMFlowPressure &water);

  /** Regions without slip; null: none. */
  const MPMFlowStick *stick = nullptr;
  /** Viscosities of several liquids; null: there is one. */
  const MPMFlowViscosities *viscosities = nullptr;
  /** See MPMFlowPressure; null: there is one density. */
  const std::vector<double> *inverse_density = nullptr;
  /** [cell][dim] of all cells: zero for faces that keep their velocity, which no stress changes;
   *  null: there are none. */
  const std::vector<double> *mobility = nullptr;

  /** A step. number: dt nu/h^2, of several liquids with the largest viscosity and the density in
   *  psi. velocity: [cell][dim] of owned cells, afterwards of all cells; that of faces next to
   *  water is used and changed. psi: [cell], dt/density times the mean pressure is added to it.
   *  Collective. */
  MPM_NS::SolveReport step(double number, std::vector<double> &velocity, std::vector<double> &psi,
                           const MPM_NS::SolveGoal &);

  int64_t size() const override { return (int64_t) unknowns.size(); }
  void products(int n, const double *const *a, const double *const *b, double *value) override;
  void apply(const double *x, double *y) override;
  void precondition(const double *r, double *z) override;
  double memory_usage() const;

 private:
  struct Face {
    int64_t at;          // place in velocities
    int64_t from[6];     // places of the stresses on it, in pairs of the upper and the lower one
    double weight[6];    // volumes of these, negative for the lower ones
    // one over the sum of its mass and the masses of walls; share of its own mass in the sum
    double inverse, share;
    double wall;    // velocity of walls times their share
  };
  struct Normal {
    int64_t at;                        // place of the first component in stresses
    int row;                           // place of it in vectors
    int64_t lower[3], upper[3];        // faces
    double volume, volume_fraction;    // volume up to the surface; open share of it
    double compliance;                 // of deviators
    double coupling;                   // of the components, in the inverse of their equations
  };
  struct Edge {
    int64_t at;
    int row;
    int64_t face[4];    // with the signs + - + -
    double area[4];     // of the stress on each
    double volume, compliance;
  };

  class LAMMPS *const lmp;
  const MPMFlowLattice &cells;
  const MPMFlowPressure &water;
  const int dim, width;
  double number = 0.0;
  std::vector<Face> faces;
  std::vector<Normal> normals;
  std::vector<Edge> edges;
  // place in stresses of each element of vectors: those of owned wet cells and edges, in ascending
  // order
  std::vector<int64_t> unknowns;
  std::vector<double> carried;    // [stress] contribution of walls to W E u; empty without regions
  std::vector<double> volumes;    // [stress] without the part behind walls
  std::vector<double> length, inverse_mass, speed, stress;       // of the lattice
  std::vector<double> right_side, solution, inverse_diagonal;    // by unknowns
  std::vector<double> mine, rank_sums;                           // sums
  MPM_NS::ConjugateGradients method;

  static int pair_of(int c, int d) { return c + d - 1; }    // 01, 02, 12
  void find_lengths();
  void find_faces();
  void find_stresses();
  void find_rows();
  void find_forces();
  void find_diagonal();
  void find_edge(Edge &, int pair);
  /** Open share of a face. */
  double aperture(int64_t face) const
  {
    return stick ? water.aperture(face / dim, face % dim) : 1.0;
  }
  /** Open share of a side of a cell that is not in a wall of the box. */
  double aperture_of_side(const MPMFlowLattice::Cell &cell, int side) const
  {
    return aperture((int64_t) (side % 2 ? cell.near[side] : cell.number) * dim + side / 2);
  }
  bool is_wall(int64_t face) const { return stick && stick->holds(face); }
  /** Open share of a face for shear along another axis. */
  double shear_area(int64_t face, int axis) const { return stick ? stick->area(face, axis) : 1.0; }
  /** Viscosities over the largest one. */
  double in_cell(int64_t cell) const { return viscosities ? viscosities->in_cell(cell) : 1.0; }
  double at_face(int64_t upper, int64_t lower) const
  {
    return viscosities ? 0.5 * (viscosities->in_cell(upper) + viscosities->in_cell(lower)) : 1.0;
  }
  double at_edge(int64_t cell, int pair) const
  {
    return viscosities ? viscosities->at_edge(cell, pair) : 1.0;
  }
  bool several() const { return viscosities || inverse_density; }
  bool is_held(int64_t face) const { return mobility && (*mobility)[face] == 0.0; }
  void strain(const double *u, double *out, double sign) const;
  void spread(const double *x);
};

}    // namespace LAMMPS_NS
#endif
