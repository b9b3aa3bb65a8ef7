/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_TRIANGLE_GAP_H
#define MPM_MESH_TRIANGLE_GAP_H

#include <algorithm>
#include <cmath>

namespace MPM_NS {

/** Largest distance of any place in a triangle from the nearest corner, from the lengths of the
 *  three sides. Without an obtuse angle it is the radius of the circle through the corners. With
 *  one, the center of that circle lies outside, and the place is on the longest side, equally far
 *  from one of its ends and from the opposite corner. */
inline double triangle_gap(double a, double b, double c)
{
  if (a < b) std::swap(a, b);
  if (a < c) std::swap(a, c);    // a is the longest
  const double twice = b * b + c * c - a * a;
  if (twice < 0.0) {
    const double short_side = std::max(b, c), other = std::min(b, c);
    return short_side * short_side * a /
        (a * a + short_side * short_side - other * other);    // side/2 over the cosine at its end
  }
  const double cosine = twice / (2.0 * b * c);
  return a / (2.0 * std::sqrt(std::max(1.0 - cosine * cosine, 1.0e-300)));
}

}    // namespace MPM_NS
#endif
