/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_IMAGE_LEVEL_SET_H
#define MPM_IMAGE_LEVEL_SET_H

// The surface of a body in an image, between pixels: where the smoothed values are those of a threshold.

#include <cstdint>
#include <functional>
#include <vector>

namespace MPM_NS {

/** Share of the unit cube (of dimension dim) centered at zero in which value + gradient . x is positive; exact (R.
 *  Scardovelli, S. Zaleski, J. Comput. Phys. 164 (2000) 228). */
double share_above(double value, const double *gradient, int dim);

/** Values at the centers of pixels, positive in the body, and linear between these along each axis. All lengths are in
 *  pixels, from the lower corner of the first one. */
class LevelSet {
 public:
  /** width: standard deviation of the Gaussian that values are smoothed with, 0: not at all. wraps: axes along
   *  which the image goes on from its begin; at other faces it goes on as at its last pixels. value: of a pixel by its
   *  number, columns first. */
  LevelSet(const int64_t *n, int dim, const bool *wraps, double width,
           const std::function<double(int64_t)> &value);

  double at(const double *x) const;

  /** Volume of the body in a box of the image, in pixels: the box is cut at the centers of pixels and between them, and
   *  in each part the surface is a plane, so that the error is of second order in the size of pixels. What is
   *  outside of the image is empty. */
  double volume(const double *lo, const double *hi) const;

 private:
  int64_t n[3];
  int dim;
  bool wraps[3];
  std::vector<float> values;

  int64_t index(int d, int64_t i) const;
  void smooth(int d, double width);
  /** May the surface go through a box? If not: is the box inside? */
  bool crosses(const double *lo, const double *hi, bool &inside) const;
  /** Volume of the body in a box between pixels. */
  double part(const double *lo, const double *hi) const;
};

}    // namespace MPM_NS
#endif
