/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LATTICE_STAGGERED_H
#define MPM_LATTICE_STAGGERED_H

#include <algorithm>

namespace MPM_NS {

/** Largest integer not above t; t must be within the range of int. */
inline int cell_below(double t)
{
  const int cell = (int) t;
  return cell - (t < cell);
}

/** Velocities and pressures on a staggered (marker-and-cell) lattice, as functions of the place.
 *
 *  Cell i along an axis reaches from node i to node i + 1. Component c of the velocity has its
 *  coefficients at the faces normal to c, where face i is the lower face of cell i; the pressure
 *  has its coefficients in the middle of cells. The basis function of a face is the quadratic
 *  B-spline along c times the hat functions along the other axes. The slope of this spline is the
 *  difference of two hats, so that the divergence of the interpolated velocity is the sum over
 *  cells of the product of hats times the net flow through the faces of the cell. If this net flow
 *  vanishes for the cells around a place, the velocity is free of divergence exactly at that place
 *  (J.A. Evans, T.J.R. Hughes, J. Comput. Phys. 241 (2013) 141; C. Schroeder, R.R. Chowdhury, T.
 *  Shinar, J. Comput. Phys. 468 (2022) 111500).
 *
 *  The functions that are nonzero at a place have indices base, base + 1, base + 2 along each
 *  axis. */
struct StaggeredWeights {
  int base[3];
  double hat[3][3];       ///< [axis][k] for faces normal to other axes, and for cells; last one 0
  double spline[3][3];    ///< [axis][k] for faces normal to this axis
  double f[3];            ///< distance of the place from the middle of cell base, 0 to 1 [spacings]

  /** The base of a place t along an axis, in node spacings from node 0. */
  static int base_at(double t) { return cell_below(t - 0.5); }

  /** Computes the weights at t, in node spacings from node 0. */
  template <int dim> void find(const double *t)
  {
    for (int d = 0; d < dim; d++) {
      base[d] = base_at(t[d]);
      const double x = f[d] = t[d] - 0.5 - base[d];
      hat[d][0] = 1.0 - x;
      hat[d][1] = x;
      hat[d][2] = 0.0;
      spline[d][0] = 0.5 * (1.0 - x) * (1.0 - x);
      spline[d][1] = 0.5 + x * (1.0 - x);
      spline[d][2] = 0.5 * x * x;
    }
  }

  /** Distance along axis d from the place to face, or to the middle of cell, base + k, in
   *  spacings. */
  double to_face(int d, int k) const { return k - 0.5 - f[d]; }
  double to_middle(int d, int k) const { return k - f[d]; }

  /** Weight of face base + k normal to axis c. */
  template <int dim> double face(int c, const int k[3]) const
  {
    double w = spline[c][k[c]];
    for (int d = 0; d < dim; d++)
      if (d != c) w *= hat[d][k[d]];
    return w;
  }
  /** Weight of cell base + k. */
  template <int dim> double cell(const int k[3]) const
  {
    double w = 1.0;
    for (int d = 0; d < dim; d++) w *= hat[d][k[d]];
    return w;
  }
};

/** Weights of the hats in the middle of cells for a point of finite width, averaged over its width.
 *  For points side by side, wherever they are, the weights times their volumes add up to the
 *  integral of each hat over the space that they fill. The weights reach cells first, first + 1,
 *  and first + 2 along each axis. */
struct FillingWeights {
  int first[3];
  double share[3][3];

  /** Computes the weights at t, in node spacings from node 0. width: width of the point in
   *  spacings, at most 1. */
  template <int dim> void find(const double *t, double width)
  {
    const double half_inverse = 0.5 / width;
    for (int d = 0; d < dim; d++) {
      const double low = t[d] - 0.5 - 0.5 * width;
      first[d] = cell_below(low);
      // from the lower end of the point, and from its upper end, to the middle of cell first + 1
      const double before = 1.0 - (low - first[d]), after = width - before,
                   left = std::max(0.0, -after), right = std::max(0.0, after);
      share[d][0] = half_inverse * (before - left) * (before + left);
      share[d][2] = half_inverse * right * right;
      share[d][1] = 1.0 - share[d][0] - share[d][2];
    }
  }
};

}    // namespace MPM_NS
#endif
