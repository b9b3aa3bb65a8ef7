/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_COUPLED_PRESSURE_H
#define LMP_MPM_COUPLED_PRESSURE_H

#include "implicit/mpm_implicit_parts.h"
#include "solve/krylov.h"
#include "solve/spline_multigrid.h"

#include <vector>

namespace LAMMPS_NS {
class MPMMotionSystem;
class MPMNodePressure;
class MPMTangent;

/** The part of implicit steps that belongs to a pressure of nodes: its values p, the residual of
 *  its equations, and the joint linear system with the motion. Vectors of that system are
 *  [node][dim] displacements, followed by [node] pressures. */
class MPMCoupledPressure : public MPM_NS::LinearSystem, private MPMImplicitParts {
 public:
  MPMCoupledPressure(const MPMImplicitParts &, MPMMotionSystem &, MPMNodePressure &);

  /** Start and end of a step of duration dt. */
  void begin_step(double dt);
  void end_step();

  /** Gives points the present pressure in their forces. */
  void set_pressure();
  /** Finds the residual of the equations at p and the motion u. forces: sum of forces by stress
   *  (MPMTangent::forces()). Returns the ratio of the residual to all volumes in the equations. */
  double find_residual(const std::vector<double> &u, double forces);
  /** Sets the sum of unbalanced forces that is allowed. */
  void allow_force(double enough) { enough_force = enough; }
  /** excess(): the larger of the residuals of forces and of volumes, each relative to the residual
   *  allowed. enough(): the residual of volumes that is allowed. */
  double excess() const;
  double enough() const;
  /** Sum of unbalanced forces that is allowed however small all forces are. */
  double negligible_forces() const;
  /** Moves the nodes that walls hold first, and finds the change of forces and volumes that this
   *  causes. */
  void move_walls(const std::vector<double> &u, double *forces);
  /** Solves for the corrections of both at the motion u, du for the given forces. */
  MPM_NS::SolveReport solve(const std::vector<double> &u, const std::vector<double> &forces,
                            std::vector<double> &du, const MPM_NS::SolveGoal &);
  /** p <- p + s times its correction. */
  void move(double s);

  // parts of a step, see MPMNewton::solve_in_parts(): values at the start of the next part, and the
  // initial residual

  void keep() { kept = p; }
  void go_back() { p = kept; }
  void set_first() { first = unbalanced; }
  void set_part(double aim) { part_left = 1.0 - aim; }

  double memory_usage() const;

 private:
  class Flow;    // the pressure alone, for its multigrid levels

  MPMMotionSystem &motion;
  MPMNodePressure &water;
  MPMTangent &tangent;
  MPM_NS::FlexibleGMRES solver{60};
  MPM_NS::SplineMultigrid levels;
  bool prepared = false;    // are the levels up to date in this step?
  // does the motion in the preconditioner ignore the pressure in this step?
  bool without_pressure = false;
  const std::vector<double> *at = nullptr;    // motion at which the system is linearized
  double response = 0.0, volume = 0.0;    // response to a unit of pressure; volume of all points
  double enough_force = 0.0;              // unbalanced forces that are allowed
  double round_off = 0.0;                 // volumes below which pressures are not resolved
  double part_left = 0.0;                 // remaining share of the initial residual
  double sum = 0.0, carried = 0.0;        // sum of the residual, and of all volumes
  double weight = 1.0;                    // weight of volumes in products of vectors
  std::vector<double> p, kept, unbalanced, first, correction;    // [node]
  std::vector<double> rhs, solution, room, no_pressure;
  std::vector<double> point_pressure, dp, dV;    // [n]
  std::vector<double> softness;                  // [n] softness of the soil, for the levels
  // [node][dim] motions of the whole body that nothing resists
  std::vector<std::vector<double>> free_axes;

  int64_t nnodes() const { return (int64_t) p.size(); }
  int64_t nreals() const { return nodes.nreals(); }
  int64_t size() const override { return nreals() + nnodes(); }
  void apply(const double *x, double *y) override;
  void precondition(const double *r, double *z) override;
  void products(int n, const double *const *a, const double *const *b, double *value) override;
  void find_free_axes();
  void remove_free_motions(double *x);
  void prepare();
  MPM_NS::SolveReport solve_motion(const double *forces, double *z, const MPM_NS::SolveGoal &);
};

}    // namespace LAMMPS_NS
#endif
