/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CYCLE_H
#define LMP_MPM_CYCLE_H

namespace LAMMPS_NS {

/** A fix whose points take one step in several steps of the run (a cycle). */
class MPMCycle {
 public:
  /** Steps of the run until the next step of the cycle ends, seen from the end of this step. */
  virtual int steps_to_next() const = 0;

 protected:
  ~MPMCycle() = default;    // owned and deleted as a Fix
};

}    // namespace LAMMPS_NS
#endif
