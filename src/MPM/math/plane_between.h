/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATH_PLANE_BETWEEN_H
#define MPM_MATH_PLANE_BETWEEN_H

#include <cmath>

namespace MPM_NS {

/** The plane that best separates points of two bodies, by logistic regression (J.A. Nairn, C.C.
 *  Hammerquist, G.D. Smith, Comput. Methods Appl. Mech. Eng. 362 (2020) 112859; here the measure is
 *  the likelihood, whose negative logarithm has a single minimum that Newton's method finds).
 *
 *  For a point at r and c = (r, 1), the probability to belong to body b rather than body a is
 *  modeled as s(z) = 1/(1 + exp(-z)), z = phi . c. The plane is z = 0, and its normal is along n,
 *  the first three components of phi. phi minimizes
 *
 *    sum_p w_p [ln(1 + exp(z_p)) - y_p z_p] + RIDGE/2 |n|^2,   y = 0 in a, 1 in b,
 *
 *  with weights w_p. The last term keeps n finite if a plane separates all points; the smaller it
 *  is, the closer the plane is to the one in the middle of the gap. Lengths are in units in which
 *  the distance of points is of order 1. */
struct PlaneBetween {
  static constexpr int ROUNDS = 6;    ///< Newton iterations: converged to 1e-4
  static constexpr int NREAL =
      14;    ///< sums of a round: 4 of the gradient, 10 of the second derivatives

  double phi[4] = {0.0, 0.0, 0.0, 0.0};

  /** Adds a point at r[3] to sums[NREAL] of a round. The sums must include all points of all ranks
   *  before advance(). of_b: the point belongs to body b. */
  void add(double weight, const double *r, bool of_b, double *sums) const
  {
    const double c[4] = {r[0], r[1], r[2], 1.0};
    double z = 0.0;
    for (int i = 0; i < 4; i++) z += phi[i] * c[i];
    const double s = 1.0 / (1.0 + std::exp(-z)), slope = weight * s * (1.0 - s);
    for (int i = 0, m = 4; i < 4; i++) {
      sums[i] += weight * (s - of_b) * c[i];
      for (int j = 0; j <= i; j++) sums[m++] += slope * c[i] * c[j];
    }
  }

  /** One step of Newton's method in dim dimensions. */
  void advance(const double *sums, int dim);
};

}    // namespace MPM_NS
#endif
