/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FORCE_BALANCE_H
#define LMP_MPM_FORCE_BALANCE_H

#include "implicit/mpm_node_stabilization.h"
#include "implicit/mpm_solved_nodes.h"
#include "implicit/mpm_tangent.h"
#include "implicit/mpm_time_method.h"

#include <memory>
#include <vector>

namespace MPM_NS {
class SplineMultigrid;
}

namespace LAMMPS_NS {

/** The balance of forces of an implicit step without constraints. With the displacement u of nodes
 *  in the step, its residual is
 *      r(u) = f_ext + (1 - alpha_f) f_int(s u) + alpha_f (f_0 - f_ext) - c m (u - u*)
 *  where f_int is that of MPMTangent, f_0 are all forces at the start of the step, and c, s,
 *  alpha_f, and the predictor u* depend on the method of time integration (MPMTimeMethod). Forces
 *  are in units of mass times acceleration. */
class MPMForceBalance {
 public:
  /** Round-off of strains, which limits the accuracy of forces. */
  static constexpr double ROUND_OFF = 2.0e-16;
  MPMForceBalance(MPMSolvedNodes &, const MPMTimeMethod &);

  /** Start of a run. */
  void init();
  /** Start of a step of duration dt. */
  void begin_step(double dt);
  /** Finds f_ext from the forces on points. Collective. */
  void find_external_forces();
  /** Gives nodes that points barely reach a stiffness of their own, by the moduli at the start of
   *  the step and times this factor. Collective. */
  void stabilize(double factor);

  /** Takes the forces at the start of the step from the velocities before and after the momentum
   *  equation; f_ext must be known. */
  void find_start_forces();

  /** Finds r(u), and the inertia forces in it. stress: sum of the sizes of forces by stress on this
   *  rank. False, on all ranks, where points are inside out or have no finite stress.
   *  Collective. */
  bool find_residual(const std::vector<double> &u, std::vector<double> &residual,
                     std::vector<double> &inertia_forces, double &stress);
  /** Finds the tangents at the motion u and their asymmetry; returns the stiffness, see
   *  MPMTangent::linearize(). Collective. */
  double linearize(const std::vector<double> &u, double &asymmetry);
  /** Change of f_int for a change du of s u. Collective. */
  void change_of_forces(const double *du, double *dforce);
  /** y = (c m + (1 - alpha_f) s K) x with K = -df_int/du. Collective. */
  void apply(const double *x, double *y);
  /** Blocks of the diagonal of this matrix, [node][dim][dim]. Collective. */
  void find_blocks(std::vector<double> &blocks);
  /** Gives levels that have begun the stiffness of the points of the first field. */
  void add_stiffness(MPM_NS::SplineMultigrid &);
  /** Sum of forces that counts as round-off after the motion u, for tangents of this stiffness.
   *  Collective. */
  double negligible_forces(const std::vector<double> &u, double stiffness) const;

  /** At the end of a step: forces of loads that follow points, at its start and their change at its
   *  end. Collective. */
  void find_loads(const std::vector<double> &u);
  /** At the end of a step: forces of the stiffness of nodes that points barely reach, and their
   *  energy [mass velocity^2]. Collective. */
  double find_stabilizing_forces(const std::vector<double> &u);

  /** c m of node n. */
  double inertia(int64_t n) const { return inertia_factor * nodes.mass[n]; }
  /** c [1/time^2]. */
  double inertia_per_mass() const { return inertia_factor; }
  /** 1 - alpha_f. */
  double force_share() const { return end_share; }
  /** Time that belongs to s u. */
  double time_of_forces() const { return share * dt; }
  /** s u. */
  const double *scaled(const std::vector<double> &u);
  MPMTangent &tangent(std::size_t body = 0) { return *tangents[body]; }
  bool is_stabilized() const { return !stabilizations.empty(); }

  std::vector<double> external;               ///< f_ext
  std::vector<double> predictor;              ///< u*
  std::vector<double> loads, load_changes;    ///< of find_loads()
  std::vector<double> stabilizing_forces;     ///< of find_stabilizing_forces()
  double memory_usage() const;

 private:
  MPMSolvedNodes &nodes;
  const MPMTimeMethod &time;
  std::vector<std::unique_ptr<MPMTangent>> tangents;                    // of each field
  std::vector<std::unique_ptr<MPMNodeStabilization>> stabilizations;    // empty: none
  double dt = 0.0, inertia_factor = 0.0;
  double share = 1.0;        // s
  double end_share = 1.0;    // 1 - alpha_f
  std::vector<double> internal, partial, blocks_of_body;
  std::vector<double> start_forces;    // alpha_f (f_0 - f_ext), if alpha_f > 0

  int64_t first(std::size_t body) const { return nodes.width * nodes.bodies[body].first; }
};

}    // namespace LAMMPS_NS
#endif
