/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_SHAPE_H
#define MPM_TRANSFER_SHAPE_H

// The functions of points along one axis, and which shape has which: all that depends on the shape
// of a point, but for the domains of transfer/cpdi.h.

#include <array>
#include <tuple>

namespace MPM_NS {

/** Smallest fraction of a point in its cell with linear functions. A point exactly on a node has
 *  the weight 0 but the full gradient at the next node, where its force would act on nothing and
 *  the momentum be lost. A position that is wrong by the last bit of a cell is not. */
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
 *  its corners (DomainCorner).
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

  /** Inverse of the second moment sum w (x_i - x)^2, which does not depend on the position. Where
   *  it does, as for linear functions, the affine form is not used (value 0). */
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

/** Quadratic Bernstein polynomials along one axis (V.P. Nguyen, A. de Vaucorbeil, S. Bordas, The
 *  Material Point Method, Springer 2023). A cell has two node spacings, from an even node over an
 *  odd one to the next even one, and these are the nodes that its points reach: the base node is 2
 *  floor(x/2), and the fraction f = x/2 - floor(x/2). The functions are not negative and sum to
 *  one; with the nodes as control points, sum w_i x_i = x. Derivatives with respect to the position
 *  in node spacings are those of the quadratic B-spline with this f; they jump from cell to cell.
 *  The second moment depends on the position. */
struct Bernstein : BSpline<2> {
  static constexpr int cell = 2;
  static constexpr double shift = 0.0, inv_moment = 0.0;

  template <class T> [[gnu::always_inline]] static constexpr void weights(const T &f, T *w)
  {
    const T g = 1.0 - f;
    w[0] = g * g;
    w[1] = 2.0 * f * g;
    w[2] = f * f;
  }
};

/** The linear function at the corners of a domain, see transfer/cpdi.h. */
struct DomainCorner : BSpline<1> {
  static constexpr bool has_domain = true;
};

namespace gimp {
  [[gnu::always_inline]] inline constexpr double max(double a, double b)
  {
    return a > b ? a : b;
  }
}    // namespace gimp

/** Function of a point of finite size along one axis: the mean of the linear function over the
 *  interval [x - s h, x + s h] that the point covers (S.G. Bardenhagen, E.M. Kober, Comput. Model.
 *  Eng. Sci. 5 (2004) 477, with characteristic functions of boxes). Half sizes s in units of the
 *  node spacing are above 0, where it is the linear function, and at most 1/2, where it is the
 *  quadratic B-spline; so it reaches no more than the nodes of the latter, and base node and
 *  fraction are as for BSpline<2>.
 *
 *  With the distance c = f - 1/2 from the middle node, the part of the interval that is above the
 *  middle node is from max(0, c - s) to max(0, c + s), and the function of the node above is the
 *  mean of u over this part; that of the node below likewise. Weights that are zero are exactly so,
 *  and so are their gradients. The second moment depends on the size.
 */
struct Gimp : BSpline<2> {
  static constexpr double inv_moment = 0.0;
  static constexpr bool has_size = true;

  template <class T>
  [[gnu::always_inline]] static constexpr void weights(const T &f, const T &size, T *w)
  {
    using gimp::max;    // and, for vectors, theirs
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
    using gimp::max;
    const T c = f - 0.5, inv = T{} + 0.25, factor = 2.0 * (inv / size);
    const T up = max(c + size, T{}), low = max(c - size, T{});
    const T down = max(size - c, T{}), high = max(T{} - c - size, T{});
    dw[0] = factor * (high - down);
    dw[2] = factor * (up - low);
    dw[1] = T{} - (dw[0] + dw[2]);
  }
};

/** B-splines of order 1 to 3; functions of points of finite size, which is fixed (GIMP) or changes
 *  with the deformation (CPGIMP); linear functions at the corners of a domain, which is a
 *  parallelepiped (CPDI) or has free corners (CPDI2); Bernstein polynomials. */
enum Shape {
  LINEAR = 1,
  QUADRATIC = 2,
  CUBIC = 3,
  GIMP = 4,
  CPDI = 5,
  CPDI2 = 6,
  BERNSTEIN = 7,
  CPGIMP = 8
};

/** The functions along one axis, in the order of the shapes. */
using Functions = std::tuple<BSpline<1>, BSpline<2>, BSpline<3>, Gimp, DomainCorner, DomainCorner,
                             Bernstein, Gimp>;
template <Shape SHAPE> using FunctionOf = std::tuple_element_t<SHAPE - 1, Functions>;

/** The constants of a shape that is known at run time only, see BSpline. */
struct ShapeConstants {
  int order, cell;
  double shift, inv_moment;
  bool has_size, has_domain;
};
template <class... F>
constexpr std::array<ShapeConstants, 1 + sizeof...(F)> constants_of(std::tuple<F...>)
{
  return {{{}, {F::order, F::cell, F::shift, F::inv_moment, F::has_size, F::has_domain}...}};
}
constexpr auto shape_constants = constants_of(Functions());

constexpr bool has_size(Shape shape)
{
  return shape_constants[shape].has_size;
}
constexpr bool has_domain(Shape shape)
{
  return shape_constants[shape].has_domain;
}
/** A point (of a domain, each corner) reaches this + 1 nodes along each axis, the same as the
 *  B-spline of this order. */
constexpr int stencil_order(Shape shape)
{
  return shape_constants[shape].order;
}

}    // namespace MPM_NS
#endif
