/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_DIFFUSION_SOLVER_H
#define LMP_MPM_DIFFUSION_SOLVER_H

#include "field/mpm_node_system.h"
#include "solve/krylov.h"
#include "solve/linear_system.h"
#include "solve/spline_multigrid.h"

#include <functional>
#include <list>
#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;
class MPMNodeScalar;

/** Equations of diffusion C dy/dt = F(y) of scalars at nodes, such as temperatures: the interface
 *  that the solver needs. Values, rates, and capacities are those of MPMNodeScalar, with the same
 *  values on all ranks that have a node. */
class MPMDiffusion {
 public:
  /** A contribution G K G^T to the matrix -dF/dy: n nodes of this rank's grid, gradient: G
   *  [n][ngrad], which turns the values at the nodes into ngrad gradients, and stiffness: K
   *  [ngrad][ngrad], which turns gradients into their conjugate fluxes. */
  using Term = std::function<void(int n, const int64_t *nodes, int ngrad, const double *gradient,
                                  const double *stiffness)>;

  /** Find the rates of all values, and of all lists that are integrated with them. Collective. */
  virtual void find_rates() = 0;
  /** Linearize around the present values, for find_changes(). Returns whether the linear equations
   *  are symmetric in the norm of capacities, the same on all ranks. Collective. */
  virtual bool linearize() = 0;
  /** Values are small changes: find the changes of the rates. Collective. */
  virtual void find_changes() = 0;
  /** Remove prescribed components from the changes of the values of a part: a projection that is
   *  orthogonal in the norm of capacities. */
  virtual void project(int part, std::vector<double> &change) = 0;
  /** Terms of a part from this rank, for a preconditioner; prescribed values are stiff. dt: of the
   *  implicit equations. */
  virtual void each_term(int part, double dt, const Term &) = 0;
  /** Adds the diagonal of the sum of these terms. */
  virtual void add_diagonal(int part, double dt, std::vector<double> &diagonal) = 0;

 protected:
  /** Adds the diagonal of a term. */
  static void add_diagonal_of(int n, const int64_t *nodes, int ngrad, const double *gradient,
                              const double *stiffness, std::vector<double> &diagonal);
  ~MPMDiffusion() = default;    // owned and deleted as something else
};

/** Time integration of such equations. */
struct MPMDiffusionOptions {
  enum Time { EXPLICIT, EULER, SDIRK2 };
  Time time = EXPLICIT;
  double tolerance = 1.0e-6;    ///< of the equations, relative to the change in the step
};

/** Implicit steps of equations of diffusion.
 *
 *    euler:  y1 = y0 + dt f(y1), backward Euler, of first order
 *    sdirk2: y1 = y0 + g dt f(y1), y2 = y0 + (1-g) dt f(y1) + g dt f(y2), g = 1 - 1/sqrt(2) (R.
 *    Alexander, SIAM J. Numer. Anal. 14 (1977) 1006), of second order; fast modes decay in a step
 *    as with Euler's method
 *
 *  y1 and y2 are found by Newton's method with conjugate gradients, or with GMRES if the equations
 *  are not symmetric. The preconditioner is multigrid or, in steps in which diffusion reaches only
 *  a few nodes, the diagonal. The values at the end are then computed from the sums above with the
 *  rates at y1 and y2, and so are the lists of integrals. So all that the rates conserve is
 *  conserved to round-off, however accurate the solution is. Nothing is kept from step to step. */
class MPMDiffusionSolver : private MPM_NS::LinearSystem {
  using LinearSystem = MPM_NS::LinearSystem;

 public:
  MPMDiffusionSolver(class LAMMPS *lmp, MPMDiffusion &equations,
                     const MPMDiffusionOptions &options) :
      lmp(lmp),
      equations(equations), options(options)
  {
  }
  /** Removes all parts and lists. */
  void clear();
  /** Adds a part; parts are numbered in the order of these calls. */
  void add(MPMField &, MPMNodeScalar &);
  /** Adds a list of any length that is integrated in time with its rates. */
  void add(std::vector<double> &integral, const std::vector<double> &rate);

  struct Report {
    bool converged = true;
    int newton = 0, linear = 0;    ///< iterations in the step
    std::string failure;
  };
  /** A step. greatest, fastest: bounds of the rates of diffusion, and of all rates [1/time].
   *  Collective. */
  const Report &advance(double dt, double greatest, double fastest);
  double memory_usage() const;

 private:
  struct Part {
    MPMField &field;
    MPMNodeScalar &scalar;
    MPMLatticeRanks ranks;
    std::vector<double> capacity{};      // also of images
    std::vector<double> base{}, at{};    // values from which the stage starts; present values
    std::vector<double> diagonal{};
    int64_t first = 0;    // place of the part in vectors
    std::unique_ptr<LinearSystem> alone{};
    std::unique_ptr<MPM_NS::SplineMultigrid> levels{};
  };
  struct Integral {
    std::vector<double> &value;
    const std::vector<double> &rate;
    std::vector<double> before, sum;
  };

  class LAMMPS *const lmp;
  MPMDiffusion &equations;
  const MPMDiffusionOptions &options;
  std::list<Part> parts;
  std::list<Integral> integrals;
  MPM_NS::ConjugateGradients conjugate;
  MPM_NS::FlexibleGMRES general{40};
  Report now;
  double implicit_dt = 0.0;    // time step of the implicit equations: dt, or g dt
  // of the preconditioner in this step: is it ready, and is it multigrid?
  bool prepared = false, by_levels = false;
  std::vector<double> residual, correction, preconditioned, rank_sums;

  int64_t size() const override;
  void apply(const double *x, double *y) override;
  void precondition(const double *r, double *z) override;
  void products(int n, const double *const *a, const double *const *b, double *value) override;

  void prepare(double greatest);
  bool solve(double greatest, double fastest, bool rates_known);
  double find_residual();
  double residual_of_rates();
  double expected_change();
  double size_of_values(bool of_change);

  class OnePart;    // the equations of one part, for its multigrid levels
};

/** Explicit steps of diffusion equations, dy/dt = rate(y), that are longer than the limit of one
 *  explicit step. They consist of stages: RKL2 (C.D. Meyer, D.S. Balsara, T.D. Aslam, J. Comput.
 *  Phys. 257 (2014) 594) is of second order in time, and stable up to (s^2 + s - 2)/4 explicit
 *  limits with s stages. A step with one stage uses Euler's method.
 *
 *  All lists of values that are added take part in each stage, so that a rate may depend on the
 *  values of all of them. A sum of values that the rates conserve is conserved to round-off. The
 *  time integral of a power can be a list of values, too. */
class MPMSuperStep {
 public:
  /** Add a list of values and their rates. Both must have the same length whenever advance() is
   *  called. */
  void add(std::vector<double> &value, const std::vector<double> &rate);
  void clear() { lists.clear(); }

  /** Make one step. find_rates sets all rates from the present values; it is called once per
   *  stage, or once less if rates are known already. */
  void advance(int stages, double dt, const std::function<void()> &find_rates,
               bool rates_known = false);
  /** Make one step in parts, the first one not longer than the explicit limit, each of the others
   *  as long as all before it, as RKL2 removes only half of what decays much faster than a step.
   *  Rates must be known. It has some 2.4 times as many stages. */
  void advance_in_parts(double dt, double limit, const std::function<void()> &find_rates);

  /** The limit of a step with one stage, with a margin. greatest: bound of the eigenvalues of minus
   *  the rates [1/time]. */
  static double explicit_limit(double greatest);
  /** The longest step with at most this number of stages, in explicit limits. */
  static double reach(int most_stages);
  /** Number of stages of a step, or most_stages + 1 if most_stages do not suffice. */
  static int count(double dt, double limit, int most_stages);

  double memory_usage() const;

 private:
  struct Values {
    std::vector<double> &y;
    const std::vector<double> &rate;
    std::vector<double> first, first_rate, last;    // of stages
  };
  std::list<Values> lists;
};

}    // namespace LAMMPS_NS
#endif
