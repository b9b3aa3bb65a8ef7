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

/** The place of a face (a triangle, in 2d a line) that is closest to x, and the position of x
 *  relative to it. */
struct FacePlace {
  /** Unit normal of the face. Its nodes go around it counterclockwise; in 2d it is on their
   *  left. */
  double normal[3];
  double height;    ///< height of x above the plane of the face, negative on the other side
  bool within;      ///< is the projection of x on the plane inside of the face?
  double
      weight[3];    ///< weights of the nodes: the closest place is the sum of weight times position
  double from[3];     ///< vector from the closest place to x
  double distance;    ///< its length

  /** Finds normal, height, and within, and the closest place if within is true. A face without area
   *  has no normal, and nothing is within it. */
  void find_plane(int dim, const double *const at[3], const double *x);
  /** Finds the closest place if within is false: it is on the rim. */
  void find_rim(int dim, const double *const at[3], const double *x);
};

/** The place of a line from a to b that is closest to x, as a fraction of the way from a to b. */
double place_on_line(const double *a, const double *b, const double *x);

/** An edge or node that several faces share, and the share of a contact that it bears.
 *
 *  A place that is close to several faces of one surface must be pushed back once, without a jump
 *  where another face takes over. The potential phi(d) of the distance d from each face is smooth,
 *  as faces are convex. Therefore this combination is smooth, too: the sum over faces, minus the
 *  sum over edges as often as they are repeated, plus a sum over nodes that makes the total phi
 *  exactly once where a node is closest to x. This is inclusion and exclusion, as in the convergent
 *  contact of M. Li, Z. Ferguson, T. Schneider, T. Langlois, D. Zorin, D. Panozzo, C. Jiang, D.M.
 *  Kaufman, arXiv:2307.15908 (2023). */
struct ContactPart {
  int node[2];    ///< nodes of an edge; for a node both are the same
  /** Share of the contact: the sum over parts and faces is one where one place is closest to x. */
  double share;
  double stiffness;    ///< mean stiffness of its faces, times the share
  /** mean damping of its faces, times the share */
  double damping;
};

/** A face that is close to a place. */
struct ContactFace {
  int node[3];
  double stiffness, damping;
};

/** Finds the edges and nodes that several of these faces share, and the share of the contact that
 *  they bear in addition to the faces. */
void find_common_parts(int dim, const std::vector<ContactFace> &, std::vector<ContactPart> &);

}    // namespace MPM_NS
#endif
