/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATH_HULL_DISTANCE_H
#define MPM_MATH_HULL_DISTANCE_H

namespace MPM_NS {

/** The shortest vector from the convex hull of points a to the convex hull of points b: the point
 *  of least norm in the hull of all differences b - a (P. Wolfe, Math. Program. 11 (1976) 128).
 *  Each step needs only the extreme points along the direction x, so that the points may be
 *  distributed over ranks. */
class HullDistance {
 public:
  double x[3] = {0.0, 0.0, 0.0};    ///< from a to b
  bool done = false;                ///< x is final; it is zero if the hulls overlap

  /** One step. a: the point of the first set with the largest x . a; b: the point of the second set
   *  with the smallest x . b. In the first call, any points of the two sets. */
  void advance(const double *a, const double *b);

  static constexpr int ROUNDS =
      60;    ///< calls after which only round-off can have prevented the end

 private:
  int n = 0;    // corners of the simplex that contains x
  double corner[4][3], share[4];

  void nearest(double *s) const;
};

}    // namespace MPM_NS
#endif
