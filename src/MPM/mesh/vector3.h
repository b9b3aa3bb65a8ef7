/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_VECTOR3_H
#define MPM_MESH_VECTOR3_H

// Arithmetic with places in space, for the geometry of surfaces and meshes.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace MPM_NS {
namespace vector3 {

  using Vector = std::array<double, 3>;

  inline Vector operator-(const Vector &a, const Vector &b)
  {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }
  inline Vector operator+(const Vector &a, const Vector &b)
  {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
  }
  inline Vector operator*(double s, const Vector &a)
  {
    return {s * a[0], s * a[1], s * a[2]};
  }
  inline double dot(const Vector &a, const Vector &b)
  {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  inline Vector cross(const Vector &a, const Vector &b)
  {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  inline double norm(const Vector &a)
  {
    return std::sqrt(dot(a, a));
  }
  inline double norm(const double *a)
  {
    return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  }
  /** to = a - b. */
  inline void difference(const double *a, const double *b, double *to)
  {
    for (int d = 0; d < 3; d++) to[d] = a[d] - b[d];
  }
  /** Enlarges a box so that it contains x. */
  inline void include(const Vector &x, Vector &lo, Vector &hi)
  {
    for (int d = 0; d < 3; d++) {
      lo[d] = std::min(lo[d], x[d]);
      hi[d] = std::max(hi[d], x[d]);
    }
  }

  /** Reorders the items [first,last) of a list, whose centers are in the box from low to high, so
   *  that those of the lower half along the longest axis of the box come first. Returns where the
   *  upper half begins. */
  template <class Item, class Center>
  int halve(std::vector<Item> &list, int first, int last, const Vector &low, const Vector &high,
            const Center &center_of)
  {
    const Vector size = high - low;
    const int axis = (int) (std::max_element(size.begin(), size.end()) - size.begin());
    const int middle = (first + last) / 2;
    std::nth_element(list.begin() + first, list.begin() + middle, list.begin() + last,
                     [&](const Item &a, const Item &b) {
                       return center_of(a)[axis] < center_of(b)[axis];
                     });
    return middle;
  }

}    // namespace vector3
}    // namespace MPM_NS
#endif
