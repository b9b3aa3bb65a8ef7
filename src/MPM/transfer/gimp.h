/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_GIMP_H
#define MPM_TRANSFER_GIMP_H

namespace MPM_NS {

namespace gimp {
  [[gnu::always_inline]] inline constexpr double max(double a, double b)
  {
    return a > b ? a : b;
  }
}    // namespace gimp

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
 *  and so are their gradients. Members are those of BSpline; the second moment depends on the size.
 */
struct Gimp {
  static constexpr int order = 2, nodes = 3;
  static constexpr int cell = 1;
  static constexpr double shift = 0.5, inv_moment = 0.0;
  static constexpr bool has_size = true, has_domain = false;

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

}    // namespace MPM_NS
#endif
