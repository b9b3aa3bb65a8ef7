/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_STRESS_H
#define LMP_MPM_FLOW_STRESS_H

#include "mpm_flow_pressure.h"
#include "solve/linear_system.h"

#include <vector>

namespace LAMMPS_NS {
class MPMFlowStick;

/** Viscosity of an incompressible fluid by an implicit step, together with the pressure (E. Larionov, C. Batty, R. Bridson, ACM
 *  Trans. Graph. 36 (2017) 101): velocities u and stresses sigma at the end of a step dt satisfy
 *
 *    density (u - u_1)/dt = div sigma,   dev sigma = 2 mu dev D(u),   div u = 0,
 *
 *  without traction at free surfaces. Pressure and viscous stress belong together: a surface without traction has the pressure
 *  2 mu dv_n/dx_n, and a viscosity that knows nothing of it lets a stretched sheet be too soft by a factor of two as
 *  soon as dt is more than thickness^2/nu.
 *
 *  The unknowns are S = dt sigma/(density h), a velocity: its normal components in the middle of wet cells, [c], and its shear components at edges
 *  between cells, at the lower ones of a cell, [dim + pair]. Velocities are eliminated, so that the system is symmetric and positive definite,
 *  and what it changes of momentum and angular momentum is zero, however well it is solved:
 *
 *    W C S + W E M^-1 E^T W S = W E u_1,
 *
 *  with differences E of velocities, their transpose E^T, which is minus the divergence of a stress, volumes W of cells and edges, masses M of faces (all up to the surface, in those
 *  of a cell), and the compliance C. Walls that stick act on the faces next to them, which has their velocity and a
 *  mass of its own in M. Regions that stick have the velocity of faces whose middle is in them, which have no inverse mass; next to
 *  them, stresses at edges belong to the distance from a face to the wall instead of a spacing, and those in cells to what is open
 *  of the cell and its faces, as for the pressure. Where fluid comes into a cell (MPMFlowPressure::sources), it does from all directions alike: what
 *  comes is no strain, a third of it (in 2d one half) is taken from each normal component of E u_1. */
class MPMFlowStress : public MPM_NS::LinearSystem {
 public:
  MPMFlowStress(class LAMMPS *lmp, const MPMFlowLattice &cells, const MPMFlowPressure &water);

  /** Regions without slip; null: none. */
  const MPMFlowStick *stick = nullptr;
  /** [cell][dim] zero where faces have the velocity that they have before, and no stress changes it, of all cells; null: none have. */
  const std::vector<double> *mobility = nullptr;

  /** A step. number: dt nu/h^2; velocity: [cell][dim] of owned cells, those of faces next to water count and change; afterwards it is
   *  that of all cells. psi: [cell], dt/density times the mean pressure is added to it. */
  MPM_NS::SolveReport step(double number, std::vector<double> &velocity, std::vector<double> &psi,
                           const MPM_NS::SolveGoal &);

  int64_t size() const override { return (int64_t) unknowns.size(); }
  void products(int n, const double *const *a, const double *const *b, double *value) override;
  void apply(const double *x, double *y) override;
  void precondition(const double *r, double *z) override;
  double memory_usage() const;

 private:
  struct Face {
    int64_t at;               // in velocities
    int64_t from[6];          // stresses that act on it, in pairs of the upper and the lower one
    double weight[6];         // volumes of these, negative for the lower ones
    double inverse, share;    // one over its mass with that of walls; share of its own mass in this
    double wall;              // velocity of walls times their share
  };
  struct Normal {
    int64_t at;                    // in stresses, of the first one
    int row;                       // of this one in vectors
    int64_t lower[3], upper[3];    // faces
    double volume, room;           // up to the surface; share of it that is open
  };
  struct Edge {
    int64_t at;
    int row;
    int64_t face[4];    // with the signs + - + -
    double area[2];     // of the stress on the first two, and on the others
    double volume;
  };

  class LAMMPS *const lmp;
  const MPMFlowLattice &cells;
  const MPMFlowPressure &water;
  const int dim, width;
  double number = 0.0;
  std::vector<Face> faces;
  std::vector<Normal> normals;
  std::vector<Edge> edges;
  std::vector<int64_t>
      unknowns;    // places of vectors in stresses: those of owned cells and edges that are there, in order
  std::vector<double> carried;     // [stress] what walls add to W E u; empty without regions
  std::vector<double> areas[2];    // [stress] for both components that a shear stress acts on
  std::vector<double> length, inverse_mass, speed, stress;       // of the lattice
  std::vector<double> right_side, solution, inverse_diagonal;    // by unknowns
  std::vector<double> mine, of_ranks;                            // sums
  MPM_NS::ConjugateGradients method;

  static int pair_of(int c, int d) { return c + d - 1; }    // 01, 02, 12
  void find_lengths();
  void find_faces();
  void find_stresses();
  void find_rows();
  void find_forces();
  void find_diagonal();
  void find_edge(Edge &, double third);
  double open(int64_t face) const;
  double open_side(const MPMFlowLattice::Cell &cell, int side) const;
  bool is_wall(int64_t face) const;
  bool is_held(int64_t face) const { return mobility && (*mobility)[face] == 0.0; }
  void strain(const double *u, double *out, double sign) const;
  void spread(const double *x);
};

}    // namespace LAMMPS_NS
#endif
