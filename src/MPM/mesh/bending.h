/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_BENDING_H
#define MPM_MESH_BENDING_H

// Bending of surfaces of triangles and of lines, by the positions of their nodes alone. Nothing
// here knows about LAMMPS.

namespace MPM_NS {

/** Do triangles with these unit normals, whose nodes go around in the same sense, belong to one
 *  smooth surface? */
inline bool is_smooth(const double *n, const double *m)
{
  return n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > 0.7;
}

/** Number of nodes of a patch, that is of a triangle and the triangles around it. Nodes 0, 1, 2 are
 *  those of the triangle. Node 3 + i belongs to its neighbor across the edge opposite to node i,
 *  which goes from i + 1 to i + 2. Nodes 6 + 2i and 7 + 2i belong to the neighbors of that
 *  neighbor, across its edges from i + 1 to 3 + i and from 3 + i to i + 2. */
constexpr int PATCH_NODES = 12;

/** Stiffness against short waves. Waves that are short compared with the mesh change the curvatures
 *  of triangles less than those of the surface, so that a force on one node meets too little
 *  resistance. Such waves show in the part of the values at the nodes of a patch that no polynomial
 *  describes: for values w, in sum(s w) with unit vectors s that are normal to all polynomials of
 *  an order. Each sum resists with the energy D (q^2 sum(s w)/area)^2 area/2 times ABOVE_THIRD for
 *  polynomials of third order. This energy vanishes with the fourth power of the element size where
 *  a surface bends smoothly. Where nodes with four triangles leave no more than ten nodes, as with
 *  diagonals that change direction, the factor is ABOVE_SECOND for polynomials of second order.
 *  This removes most of the error of the curvatures of waves there, which is of second order. q is
 *  four times the area over the square of the longest edge. It is 1 at most, and less for triangles
 *  that are narrower than half a square, in which curvatures along the triangle are smaller than
 *  w/area. */
constexpr double ABOVE_THIRD = 2.7, ABOVE_SECOND = 0.6;
constexpr int FEW_NODES = 10;    ///< number of nodes of a patch up to which second order is used

/** Instead of the resistance above third order, the curvature can change linearly in a triangle, as
 *  in a discrete Kirchhoff triangle (J.L. Batoz, K.J. Bathe, L.W. Ho, Int. J. Numer. Methods Eng.
 *  15 (1980) 1771), with slopes at the corners from the nodes of the patch. These slopes are exact
 *  only for surfaces of second order and exaggerate the change, so that only this part of its
 *  energy resists. With it, waves of twelve edges have 1.00 to 1.02 of the stiffness of a plate,
 *  and waves of six edges 0.98 to 1.07. */
constexpr double LINEAR_PART = 0.5;

/** For n nodes, the first three of which are the corners: coefficients of the values at the nodes
 *  that give the deviations from the mean curvature (xx yy xy and xx yy xy) along two linear
 *  functions whose mean square is one, times the square root of LINEAR_PART. They vanish for
 *  surfaces of second order. Returns false if the nodes do not determine the slopes at the
 *  corners. */
bool linear_curvatures(const double (*at)[2], int n, double (*rows)[6]);

/** Finds vectors s[.][k] for n nodes that are normal to all polynomials of an order (2 or 3), no
 *  more than most of them. Returns their number. */
int above_polynomials(int order, const double (*at)[2], int n, int most, double (*s)[4]);

/** Curvature of a triangle from the slopes across its edges, which the triangles on both sides of
 *  an edge share. By the theorem of Gauss, b A = sum_i l_i m_i x slope_i, with the length l_i and
 *  the outward normal m_i of edge i (Morley's triangle: L.S.D. Morley, Aeronaut. Q. 19 (1968) 149,
 *  without slopes as unknowns).
 *
 *  A slope is the mean of the slopes of the two triangles at the edge (basic shell triangle: E.
 *  Onate, F. Zarate, Int. J. Numer. Methods Eng. 47 (2000) 557), plus the smallest sum over the
 *  surrounding nodes that makes it exact for all surfaces of second order. At a rim it is the slope
 *  of the triangle plus such a sum. For this, triangles are unfolded to the plane of this one.
 *  Where no sum is exact at a rim, there is no moment across it.
 *
 *  With coefficients h_k the curvature is b = n . sum_k h_k x_k with the present normal n. The sum
 *  is zero for a plane, and b does not change by rotations. The same holds for short waves, see
 *  above. */
struct BentTriangle {
  static constexpr int MOST =
      9;        // rows: with constant curvatures 7 of 10 nodes or 5 of 12, with linear ones 9 of 12
  int n;        ///< number of nodes that contribute
  int nfree;    ///< number of rims without moment
  int nrow;     ///< 3 plus the number of short waves, or of changes of curvature, that resist
  int ncurvature;       ///< 3, or 9 with changes of curvature
  double m[2][2];       ///< normals of those rims
  double rest[MOST];    ///< curvatures and short waves in the state without moment
  double area;
  // coefficients [nrow][n] of the curvatures xx, yy, xy along axes in the plane of the triangle,
  // and of short waves [1/length^2]
  double h[MOST * PATCH_NODES];

  /** Size of the part of this object that is in use, in doubles; h is its last member. */
  static constexpr int size(bool linear) { return START + (linear ? MOST * PATCH_NODES : 70); }

  /** Sets the coefficients from the positions X[PATCH_NODES] without moment. has: does node 3, 4
   *  ... 11 exist? inside: is no node on a rim? Triangles next to a rim are stiff enough. linear:
   *  does the curvature change in the triangle? slots: receives the nodes that contribute, the
   *  first three being those of the triangle; the functions below use these nodes. Returns the
   *  largest error of a slope inside, relative to the slope that the curvature makes over the size
   *  of the patch. */
  double define(const double (*X)[3], const bool *has, bool inside, bool linear, int *slots);

  /** Bending energy of a plate with stiffness D and Poisson's ratio nu at the positions x[n]. Adds
   *  the forces on the nodes to f[n]. */
  double bend(double D, double nu, const double (*x)[3], double (*f)[3]) const;

  /** For each node, a bound of the sum of the absolute second derivatives of the energy, without
   *  moment and for D = 1. */
  void stiffness_sums(double nu, double *sum) const;

 private:
  static constexpr int START =
      2 + 4 + MOST + 1;    // doubles before h: four integers, m, rest, area
  void relax(double nu, double *change) const;
};

/** Bending of two lines that meet: the angle between them over their mean length (M. Bergou et al.,
 *  ACM Trans. Graph. 27 (2008) 63, with angles instead of their tangents). Nodes 0, 1, 2 follow
 *  each other along the line. In the plane the angle has a sign. */
struct BentLine {
  double rest;         ///< angle in the state without moment
  double length[2];    ///< lengths of both lines in the state without moment

  /** Sets angle and lengths from the positions X[3] without moment. */
  void define(int dim, const double (*X)[3]);
  /** Bending energy with the stiffness D [force length^2]. Adds the forces on the nodes to f. */
  double bend(double D, int dim, const double (*x)[3], double (*f)[3]) const;
  /** As for BentTriangle. */
  void stiffness_sums(double *sum) const;

 private:
  double mean() const { return 0.5 * (length[0] + length[1]); }
};

}    // namespace MPM_NS
#endif
