/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_FACE_CONTACT_H
#define MPM_MESH_FACE_CONTACT_H

#include <vector>

namespace MPM_NS {

/** The place of a face (a triangle, in 2d a line) that is closest to x, and where x is. */
struct FacePlace {
  double normal
      [3];    ///< of the face, of length one: its nodes go around it counterclockwise, in 2d it is on their left
  double height;    ///< of x above the plane of the face, negative on the other side
  bool within;      ///< is the projection of x on that plane in the face?
  double
      weight[3];      ///< of the nodes: the closest place is the sum of these times their positions
  double from[3];     ///< vector from the closest place to x
  double distance;    ///< its length

  /** Of the plane only: normal, height, and within, and with the last one the closest place. A face without area has no normal, and nothing is within. */
  void find_plane(int dim, const double *const at[3], const double *x);
  /** The closest place if it is not within: that of its rim. */
  void find_rim(int dim, const double *const at[3], const double *x);
};

/** The place of a line from a to b that is closest to x: its share of the way. */
double place_on_line(const double *a, const double *b, const double *x);

/** How much of a contact a face, or an edge or node of several faces, bears. A place that is close to several faces of one surface is to be pushed back by
 *  one of them, and without a jump where another one takes over. Each potential phi(d) of the distance d from a face is smooth, as faces are convex, and so is
 *  the sum over faces, less that over edges as often as they are there again, and then over nodes such that where a node is closest to x all of this is
 *  phi once: inclusion and exclusion, as in the convergent contact of M. Li, Z. Ferguson, T. Schneider, T. Langlois, D. Zorin, D. Panozzo, C. Jiang,
 *  D.M. Kaufman, arXiv:2307.15908 (2023). */
struct ContactPart {
  int node[2];    ///< of an edge; of a node both are the same
  double
      share;    ///< of the contact: the sum over parts and faces is one where one place is closest to x
  double stiffness;    ///< times the share, as the mean over its faces
  double damping;
};

/** A face that is close to x. */
struct ContactFace {
  int node[3];
  double stiffness, damping;
};

/** Edges and nodes that several of these faces have in common, with what they bear besides the faces themselves. */
void find_common_parts(int dim, const std::vector<ContactFace> &, std::vector<ContactPart> &);

}    // namespace MPM_NS
#endif
