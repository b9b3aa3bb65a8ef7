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

/** The plane that tells points of two bodies apart best, by logistic regression (J.A. Nairn, C.C. Hammerquist, G.D. Smith,
 *  Comput. Methods Appl. Mech. Eng. 362 (2020) 112859; here with the likelihood as measure, whose only minimum Newton's
 *  method finds).
 *
 *  With the place r of a point and c = (r, 1), the points of body b, next to those of body a, shall have the probability
 *  s(z) = 1/(1 + exp(-z)), z = phi . c. The plane is z = 0, its normal the direction of the first components of phi,
 *  which minimize
 *
 *    sum_p w_p [ln(1 + exp(z_p)) - y_p z_p] + RIDGE/2 |n|^2,   y = 0 in a, 1 in b,
 *
 *  with weights w_p. The last term keeps n finite where a plane separates all points; the smaller it is, the closer
 *  is the plane to the one in the middle of the gap. Lengths are in units in which points are of order 1 apart. */
struct PlaneBetween {
  static constexpr int ROUNDS = 6;    ///< of Newton's method: converged to 1e-4
  static constexpr int NREAL = 14;    ///< sums of a round: 4 of the gradient, 10 second derivatives

  double phi[4] = {0.0, 0.0, 0.0, 0.0};

  /** What a point adds to the sums of a round, of which all must have been added, from all ranks, before advance(). */
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

  /** A step of Newton's method in dim dimensions. */
  void advance(const double *sums, int dim);
};

}    // namespace MPM_NS
#endif
