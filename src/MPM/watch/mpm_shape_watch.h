/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_SHAPE_WATCH_H
#define LMP_MPM_SHAPE_WATCH_H

#include "pointers.h"

#include <array>
#include <map>

namespace LAMMPS_NS {
class MPMField;

/** Warns of points that commands between two runs have moved relative to each other, such as
 *  displace_atoms ramp and change_box remap: their deformation knows nothing of it. Bodies may be
 *  moved as a whole, and turned where they have no strain or stress that would have to turn, too.
 *  Points that are in the same groups are looked at together, as these commands move all of a
 *  group. */
class MPMShapeWatch : protected Pointers {
 public:
  MPMShapeWatch(class LAMMPS *lmp, const MPMField &field) : Pointers(lmp), field(field) {}

  /** End of a run: notes the shapes of bodies. Collective. */
  void finish() { before = find(); }
  /** Start of the next one: compares. Collective. */
  void check();

 private:
  const MPMField &field;
  bool warned = false;

  enum { COUNT, TAGS, PLACE, TAGGED = PLACE + 3, SQUARE = TAGGED + 3, NSUMS = SQUARE + 6 };
  /** Sums over points by the bits of their groups. */
  using Sums = std::array<double, NSUMS>;
  using Shapes = std::map<int, Sums>;
  Shapes before;

  Shapes find() const;
  enum Motion { RIGID, TURNED, STRAINED };
  static Motion compare(const Sums &then, const Sums &now);
  bool is_strained(int mask) const;
};

}    // namespace LAMMPS_NS
#endif
