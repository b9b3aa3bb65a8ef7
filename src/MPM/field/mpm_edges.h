/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_EDGES_H
#define LMP_MPM_EDGES_H

#include "pointers.h"

#include <cstdint>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Nodes at the fixed faces of the box that are planes of nodes, with their neighbors. */
class MPMEdges : protected Pointers {
 public:
  struct Nodes {
    int64_t outside, face, inside;    ///< outside is negative if no point reaches it
  };
  std::vector<Nodes> lists[3];    ///< by axis

  MPMEdges(class LAMMPS *lmp, const MPMField &field) : Pointers(lmp), field(field) {}

  /** Stops with an error if a fixed face is not a plane of nodes. */
  void check() const;
  /** Makes the lists. without_outside: also with nodes whose neighbor outside does not exist. */
  void find(bool without_outside);

  /** For functions that are modified at the faces: moves the sums of this rank at nodes outside to
   *  the nodes at the face and inside, before the sums of other ranks are added. nodes:
   *  [node][nreal], of which the nlane reals from lane on. */
  void fold(double *nodes, int nreal, int lane, int nlane) const;
  /** Sets the values of nodes outside, for interpolation. Where faces meet, the last axis overrides
   *  others. */
  void extend(double *nodes, int nreal, int lane, int nlane) const;
  double memory_usage() const;

 private:
  const MPMField &field;
  bool face_on_nodes(int axis, int side, int &plane) const;
};

}    // namespace LAMMPS_NS
#endif
