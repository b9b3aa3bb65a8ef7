/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_SHAPE_H
#define MPM_TRANSFER_SHAPE_H

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
 *  The functions take any type with arithmetic, so that a vector of points works like a number.
 *  They must be inlined: files that are compiled for different instruction sets share this header,
 *  and an out-of-line copy made for one CPU must not serve another.
 */
template <int ORDER> struct BSpline {
  static_assert(ORDER >= 1 && ORDER <= 3, "B-splines are linear, quadratic or cubic");

  static constexpr int nodes = ORDER + 1;               ///< nodes that a point reaches
  static constexpr double shift = 0.5 * (ORDER - 1);    ///< distance of base node and its interval

  /** Inverse of the second moment sum w (x_i - x)^2, which does not depend on the position.
   *  It does for linear functions, for which the affine form is not used (value 0). */
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

/** The cubic B-spline times 6: all coefficients are whole numbers, which single precision holds. Those of
 *  the B-spline itself are not (1/6, 2/3), and what rounding takes from them would give the weights a sum
 *  or a first moment that is wrong by the same amount for each point in each step. */
struct SixfoldCubic {
  static constexpr int nodes = 4;
  static constexpr double multiple = 6.0;

  template <class T> [[gnu::always_inline]] static constexpr void weights(const T &f, T *w)
  {
    const T g = 1.0 - f;
    const T ff = f * f;
    const T gg = g * g;
    w[0] = gg * g;
    w[1] = 4.0 + ff * (3.0 * f - 6.0);
    w[2] = 4.0 + gg * (3.0 * g - 6.0);
    w[3] = ff * f;
  }

  template <class T> [[gnu::always_inline]] static constexpr void gradients(const T &f, T *dw)
  {
    const T g = 1.0 - f;
    dw[0] = -3.0 * g * g;
    dw[1] = f * (9.0 * f - 12.0);
    dw[2] = g * (12.0 - 9.0 * g);
    dw[3] = 3.0 * f * f;
  }
};

/** Quadratic Bernstein polynomials along one axis (V.P. Nguyen, A. de Vaucorbeil, S. Bordas, The
 *  Material Point Method, Springer 2023). A cell has two node spacings, from an even node over an odd one to the next even
 *  one, which are the nodes that its points reach: the base node is 2 floor(x/2), and the fraction
 *  f = x/2 - floor(x/2). The functions are not negative and sum to one; with the nodes as control
 *  points, sum w_i x_i = x. Gradients jump from cell to cell. */
struct Bernstein {
  static constexpr int nodes = 3;

  template <class T> [[gnu::always_inline]] static constexpr void weights(const T &f, T *w)
  {
    const T g = 1.0 - f;
    w[0] = g * g;
    w[1] = 2.0 * f * g;
    w[2] = f * f;
  }

  /** Derivatives with respect to the position in node spacings. */
  template <class T> [[gnu::always_inline]] static constexpr void gradients(const T &f, T *dw)
  {
    dw[0] = f - 1.0;
    dw[1] = 1.0 - 2.0 * f;
    dw[2] = f;
  }
};

[[gnu::always_inline]] inline constexpr double max(double a, double b)
{
  return a > b ? a : b;
}

/** Function of a point of finite size along one axis: the mean of the linear function over the
 *  interval [x - s h, x + s h] that the point covers (S.G. Bardenhagen, E.M. Kober, Comput. Model.
 *  Eng. Sci. 5 (2004) 477, with characteristic functions of boxes). Half sizes s in units of the node
 *  spacing are above 0, where it is the linear function, and at most 1/2, where it is the quadratic
 *  B-spline; so it reaches no more than the nodes of the latter, and base node and fraction are as
 *  for BSpline<2>.
 *
 *  With the distance c = f - 1/2 from the middle node, the part of the interval that is above the
 *  middle node is from max(0, c - s) to max(0, c + s), and the function of the node above is the
 *  mean of u over this part; that of the node below likewise. Weights that are zero are exactly so,
 *  and so are their gradients.
 */
struct Gimp {
  static constexpr int nodes = 3;
  static constexpr double shift = 0.5;

  template <class T>
  [[gnu::always_inline]] static constexpr void weights(const T &f, const T &size, T *w)
  {
    const T c = f - 0.5, inv = T{} + 0.25, factor = inv / size;
    const T up = max(c + size, T{}), low = max(c - size, T{});
    const T down = max(size - c, T{}), high = max(T{} - c - size, T{});
    w[0] = factor * (down - high) * (down + high);
    w[2] = factor * (up - low) * (up + low);
    w[1] = 1.0 - (w[0] + w[2]);
  }

  template <class T>
  [[gnu::always_inline]] static constexpr void gradients(const T &f, const T &size, T *dw)
  {
    const T c = f - 0.5, inv = T{} + 0.25, factor = 2.0 * (inv / size);
    const T up = max(c + size, T{}), low = max(c - size, T{});
    const T down = max(size - c, T{}), high = max(T{} - c - size, T{});
    dw[0] = factor * (high - down);
    dw[2] = factor * (up - low);
    dw[1] = T{} - (dw[0] + dw[2]);
  }
};

}    // namespace MPM_NS
#endif
