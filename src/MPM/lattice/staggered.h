/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LATTICE_STAGGERED_H
#define MPM_LATTICE_STAGGERED_H

#include <algorithm>
#include <cmath>

namespace MPM_NS {

/** Largest integer that is not above t, which must be one that an int can be. */
inline int cell_below(double t)
{
  const int cell = (int) t;
  return cell - (t < cell);
}

/** Velocities and pressures on a staggered (marker-and-cell) lattice, as functions of the place.
 *
 *  Cell i of an axis reaches from node i to node i + 1. Component c of the velocity has its coefficients at the faces normal
 *  to c, of which cell i has the lower one, and the pressure in the middle of cells. The function of a face is the quadratic
 *  B-spline along c and the hat along the other axes: the slope of the former is the difference of two hats, so that the
 *  divergence of the interpolated velocity is the sum over cells of the product of hats times the balance of the cell's
 *  faces. Where cells around a place have none, the velocity is free of divergence at that very place
 *  (J.A. Evans, T.J.R. Hughes, J. Comput. Phys. 241 (2013) 141; C. Schroeder, R.R. Chowdhury, T. Shinar, J. Comput. Phys. 468
 *  (2022) 111500).
 *
 *  All functions that reach a place have indices base, base + 1, base + 2 along each axis. */
struct StaggeredWeights {
  int base[3];
  double hat[3]
            [3];    ///< [axis][k] of faces normal to another axis, and of cells; the last one is 0
  double spline[3][3];    ///< [axis][k] of faces normal to this axis
  double f[3];    ///< coordinate of the place from the middle of cell base, 0 to 1 [spacings]

  /** t: coordinates in node spacings from node 0. */
  template <int dim> void find(const double *t)
  {
    for (int d = 0; d < dim; d++) {
      base[d] = cell_below(t[d] - 0.5);
      const double x = f[d] = t[d] - 0.5 - base[d];
      hat[d][0] = 1.0 - x;
      hat[d][1] = x;
      hat[d][2] = 0.0;
      spline[d][0] = 0.5 * (1.0 - x) * (1.0 - x);
      spline[d][1] = 0.5 + x * (1.0 - x);
      spline[d][2] = 0.5 * x * x;
    }
  }

  /** From the place to face (or middle of the cell) base + k along an axis, in spacings. */
  double to_face(int d, int k) const { return k - 0.5 - f[d]; }
  double to_middle(int d, int k) const { return k - f[d]; }

  /** Weight of face base + k normal to c. */
  template <int dim> double face(int c, const int k[3]) const
  {
    double w = spline[c][k[c]];
    for (int d = 0; d < dim; d++)
      if (d != c) w *= hat[d][k[d]];
    return w;
  }
  template <int dim> double cell(const int k[3]) const
  {
    double w = 1.0;
    for (int d = 0; d < dim; d++) w *= hat[d][k[d]];
    return w;
  }
};

/** Shares of a point in the hats in the middle of cells, if it is as wide as its volume is: those of points side by side add
 *  up to what they fill, wherever they are. They reach cells first, first + 1, and first + 2 along each axis. */
struct FillingWeights {
  int first[3];
  double share[3][3];

  /** t: as above; width: of the point, in spacings, at most 1. */
  template <int dim> void find(const double *t, double width)
  {
    const double inverse = 1.0 / width;
    for (int d = 0; d < dim; d++) {
      first[d] = cell_below(t[d] - 0.5 - 0.5 * width);
      for (int k = 0; k < 3; k++) {
        const double x = t[d] - 0.5 - first[d] - k;
        share[d][k] = (below(x + 0.5 * width) - below(x - 0.5 * width)) * inverse;
      }
    }
  }
  /** Share of a hat that is below a place. */
  static double below(double x)
  {
    x = std::max(-1.0, std::min(x, 1.0));
    return 0.5 + x * (1.0 - 0.5 * std::fabs(x));
  }
};

}    // namespace MPM_NS
#endif
