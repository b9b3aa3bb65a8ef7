/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FRACTURE_WATCH_H
#define LMP_MPM_FRACTURE_WATCH_H

#include "field/mpm_interfaces.h"
#include "pointers.h"

namespace LAMMPS_NS {
class MPMField;

/** Warns if a body comes apart numerically (keyword apart of fix mpm): a material that resists
 *  tension is stretched so far that neighboring points no longer share enough nodes. */
class MPMFractureWatch : public MPMWatch, protected Pointers {
 public:
  MPMFractureWatch(class LAMMPS *lmp, MPMField &field) : Pointers(lmp), field(field) {}

  /** Start of a run. */
  void start() override
  {
    steps = 0;
    warned = false;
  }
  /** End of a step of the cycle; checks the points every few hundred steps. */
  void step() override;
  /** End of a run: checks the points a last time. */
  void finish() override { look(); }

 private:
  MPMField &field;
  bigint steps = 0;
  bool warned = false;

  void look();
};

}    // namespace LAMMPS_NS
#endif
