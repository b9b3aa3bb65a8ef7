/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_BENDING_H
#define MPM_MESH_BENDING_H

// Bending of surfaces of triangles and of lines, by the positions of their nodes alone, and strains
// along a surface that triangles share at their edges. Nothing here knows about LAMMPS.

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

/** Stiffness against short waves, which change the curvatures of triangles less than those of the
 *  surface. They show in the part of the values w at the nodes of a patch that no polynomial of
 *  third order describes, in sum(s w) with unit vectors s that are normal to all of these. Each sum
 *  has the energy ABOVE_THIRD D (q^2 sum(s w)/area)^2 area/2, which vanishes with the fourth power
 *  of the element size; q, at most 1, is four times the area over the square of the longest edge.
 *  Where nodes with four triangles leave no more than FEW_NODES, as with diagonals that change
 *  direction, it is ABOVE_SECOND, and polynomials of second order. */
constexpr double ABOVE_THIRD = 2.7, ABOVE_SECOND = 0.6;
constexpr int FEW_NODES = 10;

/** Instead of the resistance above third order, the curvature can change linearly in a triangle, as
 *  in a discrete Kirchhoff triangle (J.L. Batoz, K.J. Bathe, L.W. Ho, Int. J. Numer. Methods Eng.
 *  15 (1980) 1771), with slopes at the corners from the nodes of the patch. These are exact only
 *  for surfaces of second order and exaggerate the change: this part of its energy resists. */
constexpr double LINEAR_PART = 0.5;

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

/** Correction of the energy of two triangles of constant strain that share the mean of their
 *  strains at their common edge.
 *
 *  In a third of each triangle, the strain is the mean of both strains, which belongs to the edge
 *  (G.R. Liu, T. Nguyen-Thoi, K.Y. Lam, J. Sound Vib. 320 (2009) 1100). This removes a third of V1
 *  V2/(V1 + V2) times the energy of the difference of their strains. Only the fraction PART of that
 *  is removed here, so that the rest is positive also where the material is softer than at rest.
 *  Strains are Green strains in axes of the edge, with the second triangle unfolded to the plane of
 *  the first one, so that rotations, and folds along the edge, cause no strain. The correction
 *  fades to zero as strains approach SMALL. Nodes 0 and 1 are at the edge; node 2 belongs to the
 *  triangle with the edge from 0 to 1, and node 3 to the triangle with the edge from 1 to 0. */
struct SharedStrain {
  static constexpr double PART = 0.7, SMALL = 0.05;
  /** Gradients of the shape functions of both triangles: nodes 0 1 2 and 1 0 3 */
  double g[2][3][2];
  /** PART of a third of A1 A2/(A1 + A2); 0: the triangles do not form one smooth surface */
  double weight;

  /** Sets gradients and weight from the positions X[4] in the reference configuration. */
  void define(const double (*X)[3]);

  /** Energy of the correction, which is never positive, for a sheet with the stiffness K = E t/(1 -
   *  nu^2) and Poisson's ratio nu at the positions x[4]. Adds the forces on the nodes to f[4]. */
  double energy(double K, double nu, const double (*x)[3], double (*f)[3]) const;
};

}    // namespace MPM_NS
#endif
