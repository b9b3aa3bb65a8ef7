/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef COMPUTE_CLASS
// clang-format off
ComputeStyle(mpm/jintegral,ComputeMPMJIntegral);
// clang-format on
#else

#ifndef LMP_COMPUTE_MPM_JINTEGRAL_H
#define LMP_COMPUTE_MPM_JINTEGRAL_H

#include "compute.h"
#include "declare/option.h"

#include <map>

namespace MPM_NS {
struct Batch;
class Material;
}    // namespace MPM_NS

namespace LAMMPS_NS {

/** Keywords of compute mpm/jintegral. */
struct MPMJIntegralOptions {
  MPM_NS::NumberOrVariable tip[3] = {{0.0, "", false}};    ///< not given
  double direction[3] = {0.0, 0.0, 0.0};
  double radius[2] = {0.0, 0.0};
  int front = 2;                                   ///< axis along which the front of the crack is
  double thickness = 0.0;                          ///< length of the front; 0: that of the box
  enum { WHOLE, SYMMETRIC, SKEW } half = WHOLE;    ///< which half of a body the points are
  bool plane_stress = false;    ///< of the fields that stress intensity factors are compared with
  bool inertia = false;

  MPM_NS::Options declare(int dimension);
};

/** Energy release rate of a crack, and its stress intensity factors, by integrals over the points
 *  around its tip. */
class ComputeMPMJIntegral : public Compute, private MPMJIntegralOptions {
 public:
  ComputeMPMJIntegral(class LAMMPS *, int, char **);
  void init() override;
  double compute_scalar() override;
  void compute_vector() override;

 private:
  enum { J, K1, K2, FILLED, NVALUES };
  enum { RATE, ONE, TWO, NINTEGRALS };    // J, and the interaction integrals of both modes

  /** Elastic constants at rest in the plane across the front. */
  struct Moduli {
    double mu, kappa;    ///< shear modulus, Kolosov's constant; mu = 0: not isotropic
    double half_modulus() const { return 4.0 * mu / (1.0 + kappa); }    ///< E'/2
  };
  /** All that is summed over points. The momentum is that with the present tip, and with the one
   *  before. */
  struct Sums {
    double integral[NINTEGRALS], momentum[2][NINTEGRALS], volume;
  };
  /** Largest values over points. */
  struct Extremes {
    double mu, minus_mu, kappa, minus_kappa, spacing, has_yielded, expands, speed;
  };

  double values[NVALUES] = {0.0};
  double axis[3][3];    // direction of growth, normal of the crack, direction of the front
  double place[3];      // of the tip
  std::map<int, Moduli> moduli;    // by the instance of the fix mpm/material
  int without_stress = 0;          // bits of groups of nodes of elements
  int warnings = 0;                // bits of those that were given in this run

  /** An evaluation, for the rate of momentum. */
  struct Moment {
    double place[3], momentum[NINTEGRALS], time;
    bool exists = false;
  } last, before;    // of this step, if there was one, and of an earlier one in this run

  Moduli find_moduli(const MPM_NS::Material &) const;
  void find_tip();
  void add(const MPM_NS::Batch &, const int *list, const Moduli &, const double *stored,
           Sums &) const;
  void add_momentum(const MPM_NS::Batch &, const int *list, const Moduli &, const double *tip,
                    double *momentum) const;
  void displacement_slope(const MPM_NS::Batch &, int k, int along, double *u) const;
  bool is_inside(int i, const double *tip, double *r) const;
  bool have_yielded(const MPM_NS::Batch &, const int *list, const double *plastic,
                    double at_rest) const;
  void look_at(const Sums &, const Extremes &, double interval);
  void warn(int which, const std::string &);
};

}    // namespace LAMMPS_NS
#endif
#endif
