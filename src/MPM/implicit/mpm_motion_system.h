/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MOTION_SYSTEM_H
#define LMP_MPM_MOTION_SYSTEM_H

#include "field/mpm_node_system.h"
#include "implicit/mpm_implicit_parts.h"
#include "solve/krylov.h"
#include "solve/spline_multigrid.h"

#include <memory>
#include <vector>

namespace LAMMPS_NS {

/** The linear system of an iteration for the motion, P^T (c m + K) P with K = -df_int/du, its
 *  preconditioners, and its solution by conjugate gradients or, where tangents are not symmetric,
 *  by GMRES. The preconditioner is either the inverse of the diagonal block of each node, or levels
 *  of lattices, which are the factors of the whole matrix where it is small. */
class MPMMotionSystem : public MPM_NS::LinearSystem, private MPMImplicitParts {
 public:
  /** Largest system, by dimension, that is factorized as a whole, which is faster than levels. */
  static constexpr int WHOLE[] = {0, 0, 12000, 8500};

  explicit MPMMotionSystem(const MPMImplicitParts &);

  /** Finds the correction x for the forces b, with the present tangents. Collective. */
  MPM_NS::SolveReport solve(const double *b, double *x, const MPM_NS::SolveGoal &);

  int64_t size() const override { return nodes.nreals(); }
  void apply(const double *x, double *y) override;
  void precondition(const double *r, double *z) override;
  void products(int n, const double *const *a, const double *const *b, double *value) override
  {
    nodes.products(n, a, b, value);
  }

  /** Levels of lattices, or factors; null: blocks of nodes are the only preconditioner. */
  MPM_NS::SplineMultigrid *levels() { return multigrid.get(); }
  /** Are levels the preconditioner now? */
  bool uses_levels() const { return by_levels; }
  void use_levels(bool yes) { by_levels = yes; }
  /** Makes levels of the present tangents. same_structure: those made before are for the same nodes
   *  and walls. Collective. */
  void make_levels(bool same_structure = false);
  MPMLatticeRanks &lattice_ranks() { return ranks; }
  double memory_usage() const;

 private:
  MPMLatticeRanks ranks;
  MPM_NS::ConjugateGradients conjugate_gradients;
  MPM_NS::FlexibleGMRES gmres{100};
  std::unique_ptr<MPM_NS::SplineMultigrid> multigrid;
  // are pressures averaged around each point? The system is then asymmetric where moduli of these
  // points differ
  const bool averages;
  bool by_levels = false;
  std::vector<double> blocks, allowed;

  void find_blocks();
  void prepare_blocks();
  void begin_levels();
  bool fill_levels();
  MPM_NS::SolveReport solve_general(const double *b, double *x, const MPM_NS::SolveGoal &);
};

}    // namespace LAMMPS_NS
#endif
