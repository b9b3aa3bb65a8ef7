/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_BENDING_H
#define MPM_MESH_BENDING_H

// Bending of surfaces of triangles and of lines, by the positions of their nodes alone. Nothing here knows about LAMMPS.

namespace MPM_NS {

/** Are triangles with these unit normals, whose nodes go around in the same sense, of one smooth surface? */
inline bool is_smooth(const double *n, const double *m)
{
  return n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > 0.7;
}

/** Nodes of a triangle and of those around it: 0 1 2 of the triangle, 3 + i of its neighbor across the edge opposite to node i, which goes from
 *  i + 1 to i + 2, and 6 + 2i and 7 + 2i of the neighbors of that one, across its edges from i + 1 to 3 + i and from 3 + i to i + 2. */
constexpr int PATCH_NODES = 12;

/** Waves that are short for the mesh change the curvatures of triangles less than they do that of a surface, so that a force on one node finds too little resistance. They
 *  show in what no polynomial has at the nodes of a patch: for values w, in sum(s w) with unit vectors s that are normal to all polynomials of an order. Each of
 *  these resists with the energy D (q^2 sum(s w)/area)^2 area/2 times ABOVE_THIRD for polynomials of third order, which vanishes with the fourth power of the size of elements where a surface bends smoothly. Where
 *  nodes with four triangles leave no more than ten nodes, as diagonals do that change direction, it is ABOVE_SECOND for second order: this takes most of the error off that curvatures have
 *  in waves there, which is of second order. q, four times the area over the square of the longest edge, is 1 at most, and less for triangles that are narrower than half a square: along these curvatures are smaller
 *  than w/area. */
constexpr double ABOVE_THIRD = 2.7, ABOVE_SECOND = 0.6;
constexpr int FEW_NODES = 10;    ///< of a patch, up to which it is second order

/** Instead of what is above third order, the curvature can change linearly in a triangle, as in a discrete Kirchhoff triangle (J.L. Batoz, K.J. Bathe, L.W. Ho,
 *  Int. J. Numer. Methods Eng. 15 (1980) 1771), with slopes at corners from the nodes of the patch. Those slopes are exact for
 *  surfaces of second order only and exaggerate the change. This is the part of its energy that resists: with it, waves of twelve edges have 1.00 to 1.02 of the stiffness of a plate, and those of six 0.98 to 1.07. */
constexpr double LINEAR_PART = 0.5;

/** For n nodes, the first three of which are the corners, the sums over values at nodes of the deviations from the mean curvature, xx yy xy and xx yy xy, along two
 *  linear functions whose mean square is one, times the square root of LINEAR_PART. They vanish for surfaces of second order. False: the nodes do not tell slopes at the corners. */
bool linear_curvatures(const double (*at)[2], int n, double (*rows)[6]);

/** Vectors s[.][k] above all polynomials of an order, 2 or 3, for n nodes, and never more than most; returns how many there are. */
int above_polynomials(int order, const double (*at)[2], int n, int most, double (*s)[4]);

/** Curvature of a triangle from slopes across its edges, of which triangles on both sides have the same: the theorem of Gauss gives
 *  b A = sum_i l_i m_i x slope_i, with the length l_i and the outward normal m_i of edge i (Morley's triangle: L.S.D. Morley, Aeronaut. Q. 19
 *  (1968) 149, without slopes as unknowns). A slope is the mean of those of the two triangles at the edge (basic shell triangle: E. Onate, F.
 *  Zarate, Int. J. Numer. Methods Eng. 47 (2000) 557) plus the smallest sum over the nodes around that makes it exact for
 *  all surfaces of second order; at a rim it is that of the triangle, plus such a sum. Triangles are unfolded to the plane of this one for that. Where no sum
 *  is exact at a rim, there is no moment across it. With coefficients h_k the curvature is b = n . sum_k h_k x_k, where n is the present normal, which is zero for a
 *  plane, and does not change by rotations. The same holds for short waves, see above. */
struct BentTriangle {
  static constexpr int MOST =
      9;        // rows: with constant curvatures 7 of 10 nodes or 5 of 12, with linear ones 9 of 12
  int n;        ///< nodes with a part
  int nfree;    ///< rims without moment
  int nrow;     ///< 3, and the number of short waves, or changes of curvatures, that resist
  int ncurvature;       ///< 3, or 9 with changes of curvatures
  double m[2][2];       ///< normals of those rims
  double rest[MOST];    ///< curvatures, and short waves, without moment
  double area;
  // coefficients [nrow][n] of curvatures xx, yy, xy along axes in the plane of the triangle, and of short waves [1/length^2]
  double h[MOST * PATCH_NODES];

  /** How many doubles of this are in use, h being the last. */
  static constexpr int size(bool linear) { return START + (linear ? MOST * PATCH_NODES : 70); }

  /** From the positions X[PATCH_NODES] without moment; has: is there a node 3, 4 ... 11? inside: is no node on a rim, next to which triangles are stiff enough? linear: does the curvature change in it? slots: which nodes have a part, the first three of them those of
   *  the triangle; these are the nodes of what follows. Returns the largest error of a slope inside, in parts of what the curvature makes of it over the size of the patch. */
  double define(const double (*X)[3], const bool *has, bool inside, bool linear, int *slots);

  /** Energy of bending of a plate with stiffness D and Poisson's ratio nu; adds forces on the nodes to f[n]. */
  double bend(double D, double nu, const double (*x)[3], double (*f)[3]) const;

  /** Bounds of the sums, for each node, of the absolute second derivatives of the energy, without moment and for D = 1. */
  void stiffness_sums(double nu, double *sum) const;

 private:
  static constexpr int START =
      2 + 4 + MOST + 1;    // doubles before h: four integers, m, rest, area
  void relax(double nu, double *change) const;
};

/** Bending of two lines that meet: the angle between them, over their mean length (M. Bergou et al., ACM Trans. Graph. 27 (2008)
 *  63, with angles in the place of their tangents). Nodes are 0 1 2 along the line. In the plane the angle has a sign. */
struct BentLine {
  double rest;         ///< angle without moment
  double length[2];    ///< of both lines, without moment

  void define(int dim, const double (*X)[3]);
  /** As above, with the stiffness D [force length^2]. */
  double bend(double D, int dim, const double (*x)[3], double (*f)[3]) const;
  void stiffness_sums(double *sum) const;

 private:
  double mean() const { return 0.5 * (length[0] + length[1]); }
};

}    // namespace MPM_NS
#endif
