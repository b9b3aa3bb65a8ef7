/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_WATCH_H
#define LMP_MPM_WATCH_H

#include <string>

namespace LAMMPS_NS {

/** Looks at a run and changes nothing. */
class MPMWatch {
 public:
  virtual ~MPMWatch() noexcept(false) = default;    // as Pointers of LAMMPS
  /** Start of a run. */
  virtual void start() = 0;
  /** Called once in each step of the cycle, by a stage. */
  virtual void step() = 0;
  /** Later in the same step, when points have moved. */
  virtual void moved() {}
  /** End of a run. */
  virtual void finish() = 0;
  /** A line for the summary of the run; may be empty. */
  virtual std::string report() const { return {}; }
};

}    // namespace LAMMPS_NS
#endif
