/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_INTERNAL_FORCE_H
#define LMP_MPM_INTERNAL_FORCE_H

#include "field/mpm_trial_forces.h"
#include "lmptype.h"

namespace LAMMPS_NS {

/** Internal forces of a body that are not the stress of its points, but are added to atom->f, such
 *  as those of finite elements whose nodes are points. Implemented by a fix. */
class MPMInternalForce : public MPMTrialForces {
 public:
  /** Bit of the group of its points. They have no stress of their own. */
  virtual int group_of_points() const = 0;
  /** Does a fix mpm move these points? */
  virtual bool on_lattice() const = 0;
  /** Energy that the body stores, this rank's share [pressure * volume]. */
  virtual double stored_energy() const = 0;
  /** Smallest stable time step of this rank's part of the body. tag: ID of the point that limits
   *  it; speed: wave speed there, or 0 if it is not a wave that limits it. Collective. */
  virtual double stable_dt(tagint &tag, double &speed) const = 0;
  /** Stops with an error if the time step exceeds the stable one. */
  virtual void check_dt() const = 0;

 protected:
  ~MPMInternalForce() = default;    // owned and deleted as a Fix
};

}    // namespace LAMMPS_NS
#endif
