/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_IMAGE_LEVEL_SET_H
#define MPM_IMAGE_LEVEL_SET_H

// The surface of a body in an image with subpixel resolution: where the smoothed values equal a
// threshold.

#include <cstdint>
#include <functional>
#include <vector>

namespace MPM_NS {

/** Fraction of the unit cube of dimension dim, centered at zero, in which value + gradient . x is
 *  positive; exact (R. Scardovelli, S. Zaleski, J. Comput. Phys. 164 (2000) 228). */
double share_above(double value, const double *gradient, int dim);

/** Values at the centers of pixels, positive in the body, with linear interpolation along each axis
 *  between them. All lengths are in pixels, from the lower corner of the first pixel. */
class LevelSet {
 public:
  /** n[3]: number of columns, rows, slices. wraps[3]: axes along which the image is periodic; at
   *  other faces it continues with the values of the outermost pixels. width: standard deviation of
   *  the Gaussian filter that smooths the values; 0: no smoothing. value: value of a pixel by its
   *  number, with columns running fastest. */
  LevelSet(const int64_t *n, int dim, const bool *wraps, double width,
           const std::function<double(int64_t)> &value);

  double at(const double *x) const;

  /** Volume of the body in a box of the image, in pixels. The box is cut at the centers and the
   *  faces of pixels, and the surface is approximated by a plane in each part, so that the error is
   *  of second order in the size of pixels. Space outside the image is empty. */
  double volume(const double *lo, const double *hi) const;

 private:
  int64_t n[3];
  int dim;
  bool wraps[3];
  std::vector<float> values;

  int64_t index(int d, int64_t i) const;
  void smooth(int d, double width);
  /** May the surface cross a box? If not, sets inside: is the box in the body? */
  bool crosses(const double *lo, const double *hi, bool &inside) const;
  /** Volume of the body in a box that no center or face of a pixel cuts. */
  double part(const double *lo, const double *hi) const;
};

}    // namespace MPM_NS
#endif
