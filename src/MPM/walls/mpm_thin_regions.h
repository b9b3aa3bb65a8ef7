/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_THIN_REGIONS_H
#define LMP_MPM_THIN_REGIONS_H

#include "base/mpm_first_note.h"
#include "pointers.h"

namespace LAMMPS_NS {
class MPMWall;
class MPMWallNodes;

/** Warns of regions that are too thin for the nodes: blades or wires that are narrower than the
 *  reach of nodes and have material in front of them, and plates with material on both sides. */
class MPMThinRegions : protected Pointers {
 public:
  MPMThinRegions(class LAMMPS *lmp, MPMWall &wall) : Pointers(lmp), wall(wall) {}

  /** Start of a run. */
  void begin_run() { first.begin(); }
  /** Looks for such places in a step; index: of the field. */
  void check(const MPMWallNodes &, int index);
  /** Is this a step in which ranks compare their findings? */
  bool is_due() const;
  /** Prints one warning, with the same place for any number of ranks. Collective. */
  void report();

 private:
  MPMWall &wall;
  MPMFirstNote<5> first;    // step, index of the field, place
};

}    // namespace LAMMPS_NS

#endif
