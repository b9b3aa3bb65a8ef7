/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_BSPLINE_H
#define MPM_TRANSFER_BSPLINE_H

namespace MPM_NS {

/** Smallest fraction of a point in its cell with linear functions. A point exactly on a node has the
 *  weight 0 but the full gradient at the next node, where its force would act on nothing and the
 *  momentum be lost. A position that is wrong by the last bit of a cell is not. */
constexpr double SMALLEST_FRACTION = 0x1p-52;

/** Uniform B-spline of order 1 (linear), 2 (quadratic) or 3 (cubic) along one axis.
 *
 *  Lengths are in units of the node spacing. A point at position x has the base node
 *  b = floor(x - shift) and the fraction f = x - shift - b in [0,1). It reaches the nodes b ... b +
 *  ORDER; node b + i lies at i - shift - f from the point. Weights in two and three dimensions are
 *  products over the axes.
 *
 *  Functions with cells of several nodes (Bernstein): b = cell floor(x/cell - shift), f in cells.
 *  Points may have a size (Gimp) on which the weights depend, or a domain with such functions at
 *  its corners (PointDomain).
 *
 *  The functions take any type with arithmetic, so that a vector of points works like a number.
 *  They must be inlined: files that are compiled for different instruction sets share this header,
 *  and an out-of-line copy made for one CPU must not serve another.
 */
template <int ORDER> struct BSpline {
  static_assert(ORDER >= 1 && ORDER <= 3, "B-splines are linear, quadratic or cubic");

  static constexpr int order = ORDER, nodes = ORDER + 1;    ///< nodes that a point reaches
  static constexpr int cell = 1;                            ///< node spacings of a cell
  static constexpr double shift = 0.5 * (ORDER - 1);    ///< distance of base node and its interval
  static constexpr bool has_size = false, has_domain = false;    ///< of the points

  /** Inverse of the second moment sum w (x_i - x)^2, which does not depend on the position. Where it
   *  does, as for linear functions, the affine form is not used (value 0). */
  static constexpr double inv_moment = ORDER == 2 ? 4.0 : (ORDER == 3 ? 3.0 : 0.0);

  /** Weights of the nodes for the fraction f. */
  template <class T> [[gnu::always_inline]] static constexpr void weights(const T &f, T *w)
  {
    if constexpr (ORDER == 1) {
      w[0] = 1.0 - f;
      w[1] = f;
    } else if constexpr (ORDER == 2) {
      const T g = 1.0 - f;
      const T c = f - 0.5;
      w[0] = 0.5 * g * g;
      w[1] = 0.75 - c * c;
      w[2] = 0.5 * f * f;
    } else {
      const T g = 1.0 - f;
      const T ff = f * f;
      const T gg = g * g;
      w[0] = (1.0 / 6.0) * gg * g;
      w[1] = 2.0 / 3.0 + ff * (0.5 * f - 1.0);
      w[2] = 2.0 / 3.0 + gg * (0.5 * g - 1.0);
      w[3] = (1.0 / 6.0) * ff * f;
    }
  }

  /** Derivatives of the weights with respect to the position of the point. */
  template <class T> [[gnu::always_inline]] static constexpr void gradients(const T &f, T *dw)
  {
    if constexpr (ORDER == 1) {
      dw[0] = T{} - 1.0;
      dw[1] = T{} + 1.0;
    } else if constexpr (ORDER == 2) {
      dw[0] = f - 1.0;
      dw[1] = 1.0 - 2.0 * f;
      dw[2] = f;
    } else {
      const T g = 1.0 - f;
      dw[0] = -0.5 * g * g;
      dw[1] = f * (1.5 * f - 2.0);
      dw[2] = g * (2.0 - 1.5 * g);
      dw[3] = 0.5 * f * f;
    }
  }
};

}    // namespace MPM_NS
#endif
