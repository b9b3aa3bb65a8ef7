/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_DIFFUSION_SOLVER_H
#define LMP_MPM_DIFFUSION_SOLVER_H

#include "mpm_lattice_ranks.h"
#include "solve/flexible_gmres.h"
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

/** Equations of diffusion C dy/dt = F(y) of scalars at nodes, such as temperatures, as their solver sees them. Values, rates,
 *  and capacities are those of MPMNodeScalar; all of them are the same on all ranks that have a node. */
class MPMDiffusion {
 public:
  /** What adds to the matrix -dF/dy: n nodes of this rank's grid, [n][ngrad] numbers by which their values make ngrad ones, and
   *  [ngrad][ngrad] coefficients that turn these into what is conjugate to them. */
  using Term = std::function<void(int n, const int64_t *nodes, int ngrad, const double *gradient,
                                  const double *stiffness)>;

  /** Rates of all values, and of all lists that are integrated with them. Collective. */
  virtual void find_rates() = 0;
  /** From here on changes are those around the present values. Are they symmetric in the norm of capacities, on all ranks?
   *  Collective. */
  virtual bool linearize() = 0;
  /** Values are small changes: the changes of the rates. Collective. */
  virtual void find_changes() = 0;
  /** Take from the changes of the values of a part what is prescribed: a projection that is orthogonal in the norm of capacities. */
  virtual void project(int part, std::vector<double> &change) = 0;
  /** Terms of a part from this rank, for a preconditioner; prescribed values as stiff ones. dt: of the implicit equations. */
  virtual void each_term(int part, double dt, const Term &) = 0;

 protected:
  ~MPMDiffusion() = default;    // owned and deleted as something else
};

/** How long steps of such equations are made. */
struct MPMDiffusionOptions {
  enum Time { EXPLICIT, EULER, SDIRK2 };
  Time time = EXPLICIT;
  double tolerance = 1.0e-6;    ///< of equations, of the change in the step
};

/** Implicit steps of equations of diffusion.
 *
 *    euler:  y1 = y0 + dt f(y1), backward Euler, of first order
 *    sdirk2: y1 = y0 + g dt f(y1), y2 = y0 + (1-g) dt f(y1) + g dt f(y2), g = 1 - 1/sqrt(2) (R. Alexander, SIAM J. Numer. Anal. 14
 *            (1977) 1006): of second order, and what is fast decays in a step as with Euler's method
 *
 *  y1 and y2 are found by Newton's method with conjugate gradients, or GMRES where the equations are not symmetric, and a multigrid
 *  preconditioner or, in steps in which hardly anything gets farther than a few nodes, the diagonal. Then the values of the
 *  end are the sum above with the rates of these, so that what rates conserve is conserved to round-off, however accurate
 *  the solution is, and so are the lists of integrals that go along. Nothing is kept from step to step. */
class MPMDiffusionSolver : private MPM_NS::LinearSystem {
  using LinearSystem = MPM_NS::LinearSystem;

 public:
  MPMDiffusionSolver(class LAMMPS *lmp, MPMDiffusion &equations,
                     const MPMDiffusionOptions &options) :
      lmp(lmp),
      equations(equations), options(options)
  {
  }
  void clear();
  /** A part, numbered in the order of these calls. */
  void add(MPMField &, MPMNodeScalar &);
  /** A list that is integrated in time, of any length. */
  void add(std::vector<double> &integral, const std::vector<double> &rate);

  struct Report {
    bool converged = true;
    int newton = 0, linear = 0;    ///< iterations in the step
    std::string failure;
  };
  /** A step. greatest, fastest: bounds of the rates of diffusion, and of all that there are [1/time]. Collective. */
  const Report &advance(double dt, double greatest, double fastest);
  double memory_usage() const;

 private:
  struct Part {
    MPMField &field;
    MPMNodeScalar &scalar;
    MPMLatticeRanks ranks;
    std::vector<double> capacity;    // also of images
    std::vector<double> base, at;    // of the equations; the present values
    std::vector<double> diagonal;
    int64_t first = 0;    // place in vectors
    std::unique_ptr<LinearSystem> alone;
    std::unique_ptr<MPM_NS::SplineMultigrid> levels;
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
  double implicit_dt = 0.0;                    // of the equations: g dt
  bool prepared = false, by_levels = false;    // the preconditioner, in this step
  std::vector<double> residual, correction, room, of_ranks;

  int64_t size() const override;
  void apply(const double *x, double *y) override;
  void precondition(const double *r, double *z) override;
  void products(int n, const double *const *a, const double *const *b, double *value) override;

  void prepare(double greatest);
  bool solve(double greatest, double fastest);
  double find_residual();
  double size_of_values(bool of_change);

  class OnePart;    // what the levels of a part see
};

}    // namespace LAMMPS_NS
#endif
