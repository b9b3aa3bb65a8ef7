/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATH_HULL_DISTANCE_H
#define MPM_MATH_HULL_DISTANCE_H

namespace MPM_NS {

/** The shortest vector from the convex hull of some points to that of others, the point of least norm in the hull of all
 *  differences b - a (P. Wolfe, Math. Program. 11 (1976) 128). It needs the points only through those that are farthest ahead
 *  along a direction, so that these may be spread over ranks. */
class HullDistance {
 public:
  double x[3] = {0.0, 0.0, 0.0};    ///< from a to b
  bool done = false;                ///< then x is it, zero if the hulls overlap

  /** a, b: of the points of a that with the greatest x . a, of those of b that with the least x . b. For the first call any of
   *  them. */
  void advance(const double *a, const double *b);

  static constexpr int ROUNDS = 60;    ///< calls after which rounding keeps it from the end

 private:
  int n = 0;    // corners of the simplex that has x in it
  double corner[4][3], share[4];

  void nearest(double *s) const;
};

}    // namespace MPM_NS
#endif
