/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_PASSAGES_H
#define MPM_MESH_PASSAGES_H

#include <cstdint>
#include <utility>
#include <vector>

namespace MPM_NS {

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

}    // namespace MPM_NS
#endif
