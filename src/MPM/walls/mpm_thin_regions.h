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
 *  reach of nodes and have material in front of them, plates with material on both sides, and tools
 *  that move into material and are so narrow that the place of their edges matters. */
class MPMThinRegions : protected Pointers {
 public:
  MPMThinRegions(class LAMMPS *lmp, MPMWall &wall) : Pointers(lmp), wall(wall) {}

  /** Start of a run. */
  void begin_run()
  {
    first.begin();
    first_edge.begin();
  }
  /** Looks for such places in a step; index: of the field. */
  void check(const MPMWallNodes &, int index);
  /** Is this a step in which ranks compare their findings? */
  bool is_due() const;
  /** Prints one warning of each kind, with the same place for any number of ranks. Collective. */
  void report();

 private:
  MPMWall &wall;
  MPMFirstNote<5> first, first_edge;    // step, index of the field, place; or error of the force

  double error_of_force(const MPMWallNodes &) const;
  void look_at_edges(const MPMWallNodes &, int index);
  void report_places();
};

}    // namespace LAMMPS_NS

#endif
