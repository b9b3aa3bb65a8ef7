/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_IMPLICIT_PRESSURE_H
#define LMP_MPM_IMPLICIT_PRESSURE_H

#include "mpm_implicit.h"

#include <memory>
#include <vector>

namespace LAMMPS_NS {
class MPMNodePressure;

/** The part of a pressure of nodes in the implicit steps of their motion: its values p, what is left of its equations, and the linear
 *  system of both, whose vectors are [node][dim] displacements and, behind these, [node] pressures. */
class MPMImplicit::Joint : public MPM_NS::LinearSystem {
 public:
  Joint(MPMImplicit &motion, MPMNodePressure &water);

  void begin_step();
  void end_step();

  /** Points have the present pressure in their forces. */
  void set_pressure();
  /** What is left of the equations at p and the motion u, with the sum of forces by stress (MPMTangent::forces()); returns its ratio to all volumes in them. */
  double find_residual(const std::vector<double> &u, double forces);
  /** What is left of forces and volumes, in parts of what may be left, the larger one. */
  double excess() const;
  double enough() const;
  /** Sum of forces that may be left however small all forces are. */
  double negligible_forces() const;
  /** Nodes that walls hold move first: the change of forces, and volumes that this takes. */
  void move_walls(const std::vector<double> &u, double *forces);
  /** Corrections of both from the motion u on, that of the motion in motion.change. */
  MPM_NS::SolveReport solve(const std::vector<double> &u, const MPM_NS::SolveGoal &);
  /** p <- p + s times its correction. */
  void move(double s);

  // parts of a step, see MPMImplicit::approach(): values of where the next one begins, and what is left at first

  void keep() { kept = p; }
  void go_back() { p = kept; }
  void set_first() { first = left; }
  void set_part(double aim) { part_left = 1.0 - aim; }

  double memory_usage() const;

 private:
  class Flow;    // the pressure alone, for its levels

  MPMImplicit &motion;
  MPMNodePressure &water;
  MPM_NS::FlexibleGMRES solver{60};
  MPM_NS::SplineMultigrid levels;
  bool prepared = false;        // the levels, in this step
  bool stress_alone = false;    // motion in the preconditioner: in this step without the pressure
  const std::vector<double> *at = nullptr;    // where it is linearized
  double response = 0.0, volume = 0.0;        // of a unit of pressure; of all points
  double round_off = 0.0;                     // volumes that pressures are not known better than
  double part_left = 0.0;                     // of what is left at first
  double sum = 0.0, carried = 0.0;            // of what is left, and of all volumes
  double weight = 1.0;                        // of volumes in products of vectors
  std::vector<double> p, kept, left, first, correction;    // [node]
  std::vector<double> rhs, solution, room, none;
  std::vector<double> of_points, dp, dV;    // [n]
  std::vector<double> softness;             // [n] of the soil, for the levels
  std::vector<double> of_ranks;
  std::vector<std::vector<double>> free_axes;    // [node][dim] motions of all that nothing resists

  int64_t size() const override { return motion.nreals() + (int64_t) motion.mass.size(); }
  void apply(const double *x, double *y) override;
  void precondition(const double *r, double *z) override;
  void products(int n, const double *const *a, const double *const *b, double *value) override;
  void find_free_axes();
  void take_means(double *x);
  void prepare();
  MPM_NS::SolveReport move_alone(const double *forces, double *z, const MPM_NS::SolveGoal &);
};

}    // namespace LAMMPS_NS
#endif
