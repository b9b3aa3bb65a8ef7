/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_FACE_CONTACT_H
#define MPM_MESH_FACE_CONTACT_H

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
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

/** Side of a triangle (in 2d: of a line) on which a place is. 1: the side from which its nodes go
 *  around counterclockwise (in 2d: on the left). -1: the other side. 0: the projection of the place
 *  is outside by more than margin, in units of the height of the triangle, or the place is farther
 *  away than range. within: is the projection within the face? */
int side_of_face(int dim, const double *const at[3], const double *x, double range, double margin,
                 bool &within);

/** Detects nodes that have gone through faces of a surface between two looks. Nothing here knows
 *  about LAMMPS. */
class Passages {
 public:
  /** A node that is close to a face, and the side on which it is. */
  struct Sight {
    int64_t node, body, face;
    int32_t side;
    int32_t within;    ///< is its projection within the face, rather than in the margin?

    bool operator<(const Sight &other) const
    {
      if (node != other.node) return node < other.node;
      return body != other.body ? body < other.body : face < other.face;
    }
  };

  using FaceID = std::pair<int64_t, int64_t>;    ///< body, face

  /** Replaces the sights of the last look by those of now. Returns one that has come through a face
   *  since then; null: none. */
  const Sight *look(std::vector<Sight> now);

  /** Removes and returns the sights of all faces except these, which must be sorted. Other ranks
   *  have those faces now. */
  std::vector<Sight> take_others(const std::vector<FaceID> &faces);
  /** Adds sights that come from other ranks. */
  void add(const std::vector<Sight> &more) { known.insert(known.end(), more.begin(), more.end()); }

  void forget() { known.clear(); }
  double memory() const { return (double) known.capacity() * sizeof(Sight); }

 private:
  std::vector<Sight> known;    // sights of the last look
};

/** Largest distance of any place in a triangle from the nearest corner, from the lengths of the
 *  three sides. Without an obtuse angle it is the radius of the circle through the corners. With
 *  one, the center of that circle lies outside, and the place is on the longest side, equally far
 *  from one of its ends and from the opposite corner. */
inline double triangle_gap(double a, double b, double c)
{
  if (a < b) std::swap(a, b);
  if (a < c) std::swap(a, c);    // a is the longest
  const double twice = b * b + c * c - a * a;
  if (twice < 0.0) {
    const double short_side = std::max(b, c), other = std::min(b, c);
    return short_side * short_side * a /
        (a * a + short_side * short_side - other * other);    // side/2 over the cosine at its end
  }
  const double cosine = twice / (2.0 * b * c);
  return a / (2.0 * std::sqrt(std::max(1.0 - cosine * cosine, 1.0e-300)));
}

}    // namespace MPM_NS
#endif
