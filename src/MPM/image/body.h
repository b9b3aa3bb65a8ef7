/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_IMAGE_BODY_H
#define MPM_IMAGE_BODY_H

// Bodies in an image that has its place in the simulation box: which pixels are of which type, and the share of a
// box that is in a body. Knows nothing of LAMMPS.

#include "image/image.h"
#include "image/level_set.h"

#include <memory>
#include <vector>

namespace MPM_NS {

/** Pixels of this gray value and above have this type, 0: they are in no body. */
struct GrayStep {
  double from;
  int type;
};

/** Pixels of this color have this type, whatever their gray value is. */
struct ColorType {
  int color[3], type;
};

struct ImageBody {
  Image image;

  // place; d is an axis of the box, c one of the image: columns, rows, slices

  int dim = 3;
  int image_axis[3] = {0, 1, 2};    ///< of d
  bool against[3] = {};             ///< of d: the image counts from the upper end
  double lo[3] = {}, pixel[3] = {1.0, 1.0, 1.0};

  // bodies

  std::vector<GrayStep> steps;    ///< in ascending order; none: only colors count
  std::vector<ColorType> colors;
  bool below = false;                         ///< a single step: what is darker than it is the body
  std::unique_ptr<const LevelSet> surface;    ///< null: that of the pixels

  int64_t count(int d) const { return image.n[image_axis[d]]; }
  double hi(int d) const { return lo[d] + pixel[d] * count(d); }

  /** The pixel at x[3], -1 outside of the image. What is between two pixels belongs to the upper one. */
  int64_t pixel_at(const double *x) const;
  /** The same, outside of the image the nearest one. */
  int64_t nearest_pixel(const double *x) const;
  int type_of(int64_t pixel) const;
  /** Type at x, 0: no body there. */
  int type_at(const double *x) const;

  /** Leaves out columns, rows, and slices at the faces in which nothing is in a body. */
  void crop();

  /** Makes the surface of a body with a single step, see LevelSet for the arguments; wraps: of d. */
  void make_surface(double width, const bool *wraps);
  /** Share of a box with its center at x that is in the body of the surface, 0 to 1. */
  double share_at(const double *x, const double *edges) const;
};

}    // namespace MPM_NS
#endif
