/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_SHAPE_H
#define MPM_TRANSFER_SHAPE_H

// What depends on the shape of a point: all of it is next to the weights of the shape.

#include "transfer/bernstein.h"
#include "transfer/bspline.h"
#include "transfer/cpdi.h"
#include "transfer/gimp.h"

namespace MPM_NS {

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

/** The function of a shape along one axis, with its constants and weights. */
template <Shape> struct FunctionOf;
template <> struct FunctionOf<LINEAR> : BSpline<1> {
};
template <> struct FunctionOf<QUADRATIC> : BSpline<2> {
};
template <> struct FunctionOf<CUBIC> : BSpline<3> {
};
template <> struct FunctionOf<GIMP> : Gimp {
};
template <> struct FunctionOf<CPDI> : DomainCorner {
};
template <> struct FunctionOf<CPDI2> : DomainCorner {
};
template <> struct FunctionOf<BERNSTEIN> : Bernstein {
};
template <> struct FunctionOf<CPGIMP> : Gimp {
};

/** The constants of a shape that is known at run time only, see BSpline. */
struct ShapeConstants {
  int order, cell;
  double shift, inv_moment;
  bool has_size, has_domain;
};
template <Shape SHAPE> constexpr ShapeConstants constants_of()
{
  using F = FunctionOf<SHAPE>;
  return {F::order, F::cell, F::shift, F::inv_moment, F::has_size, F::has_domain};
}
constexpr ShapeConstants shape_constants[] = {{},
                                              constants_of<LINEAR>(),
                                              constants_of<QUADRATIC>(),
                                              constants_of<CUBIC>(),
                                              constants_of<GIMP>(),
                                              constants_of<CPDI>(),
                                              constants_of<CPDI2>(),
                                              constants_of<BERNSTEIN>(),
                                              constants_of<CPGIMP>()};

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
