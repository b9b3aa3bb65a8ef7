/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_STEP_LIMIT_H
#define LMP_MPM_STEP_LIMIT_H

#include "lmptype.h"

namespace LAMMPS_NS {

/** A fix other than fix mpm that moves something and limits the time step; fix mpm/dt asks it for
 *  the largest one. */
class MPMStepLimit {
 public:
  /** The largest stable time step for the points of this rank, or the largest double if there is no
   *  limit. tag: ID of the point that limits it, 0 if none does. */
  virtual double stable_dt(tagint &tag) const = 0;
  /** Does it make the steps of material points itself, without a fix mpm? */
  virtual bool makes_steps() const { return true; }

 protected:
  ~MPMStepLimit() = default;    // owned and deleted as a Fix
};

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
