/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_ROLLING_WATCH_H
#define LMP_MPM_ROLLING_WATCH_H

#include "pointers.h"

namespace LAMMPS_NS {
class MPMField;

/** Warns of round bodies that turn where friction acts, and turn too slowly: those whose surface
 *  has the steps of a lattice of points, which roll from edge to edge as a wheel without a rim, and
 *  those with a small radius for the node spacing. */
class MPMRollingWatch : protected Pointers {
 public:
  MPMRollingWatch(class LAMMPS *lmp, const MPMField &field) : Pointers(lmp), field(field) {}

  /** End of a run. Warns once. Collective. */
  void finish();

 private:
  const MPMField &field;
  bool warned = false;
};

}    // namespace LAMMPS_NS
#endif
