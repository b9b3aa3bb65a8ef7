/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_IMAGE_BODY_H
#define MPM_IMAGE_BODY_H

// Bodies in an image that is placed in the simulation box: the types of pixels, and the fraction of
// a box that a body fills. Knows nothing of LAMMPS.

#include "image/image.h"
#include "image/level_set.h"

#include <memory>
#include <vector>

namespace MPM_NS {

/** Pixels with this gray value or a larger one have this type; 0: no body. */
struct GrayStep {
  double from;
  int type;
};

/** Pixels of this color have this type, regardless of their gray value. */
struct ColorType {
  int color[3], type;
};

/** An image, its place in the box, and the bodies in it. */
struct ImageBody {
  Image image;

  // place; d is an axis of the box, c an axis of the image (columns, rows, slices)

  int dim = 3;
  int image_axis[3] = {0, 1, 2};                    ///< [d] the axis c of the image along d
  bool against[3] = {};                             ///< [d] the image counts from the upper end
  double lo[3] = {}, pixel[3] = {1.0, 1.0, 1.0};    ///< [d] lower corner and size of a pixel

  // bodies

  std::vector<GrayStep> steps;    ///< in ascending order; empty: only colors are used
  std::vector<ColorType> colors;
  bool below = false;    ///< with a single step: the darker pixels are the body
  std::unique_ptr<const LevelSet> surface;    ///< null: the surface follows the faces of pixels

  int64_t count(int d) const { return image.n[image_axis[d]]; }
  double hi(int d) const { return lo[d] + pixel[d] * count(d); }

  /** The pixel at x[3], or -1 outside the image. A face between two pixels belongs to the upper
   *  one. */
  int64_t pixel_at(const double *x) const;
  /** The pixel at x[3], or the nearest one outside the image. */
  int64_t nearest_pixel(const double *x) const;
  /** Type of a pixel; 0: in no body. */
  int type_of(int64_t pixel) const;
  /** Type at x[3]; 0: no body there. */
  int type_at(const double *x) const;

  /** Removes columns, rows, and slices at the faces of the image that contain no body. */
  void crop();

  /** Makes the surface of a body with a single step. For the arguments see LevelSet; here wraps[d]
   *  refers to axes of the box. */
  void make_surface(double width, const bool *wraps);
  /** Fraction, 0 to 1, of a box with center x[3] and these edges that is inside the surface. */
  double share_at(const double *x, const double *edges) const;
};

}    // namespace MPM_NS
#endif
