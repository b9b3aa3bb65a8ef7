/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_INTERNAL_FORCE_H
#define LMP_MPM_INTERNAL_FORCE_H

#include "lmptype.h"

namespace LAMMPS_NS {

/** Forces between points besides the stress of points, after a motion that a solver tries: for
 *  instance of finite elements whose nodes are points. The state is that of the start of the step,
 *  and does not change. Vectors are [point of this rank][3], forces in units of force. All
 *  functions are collective. */
class MPMTrialForces {
 public:
  /** Forces after the displacements u in the step. Adds the sum of their sizes over the elements of
   *  this rank to carried. Returns false on this rank if an element has no finite stress. */
  virtual bool forces_after(const double *u, double *force, double &carried) = 0;
  /** Finds the derivatives of the forces there. Returns the sum of the stiffness of the elements of
   *  this rank times their lengths: a strain e makes forces of e times this sum. */
  virtual double differentiate(const double *u) = 0;
  /** Adds the change of the forces for a change du of the displacements. */
  virtual void add_change(const double *du, double *dforce) = 0;
  /** Adds minus the change of the force on each point due to its own displacement,
   *  [point][dim][dim]. */
  virtual void add_blocks(double *blocks) = 0;
  /** Forces at the start of the step, as in atom->f. */
  virtual const double *forces() const = 0;
  /** Largest |K_kl - K_lk| of the elements of this rank over their largest entry. */
  virtual double asymmetry() const = 0;

 protected:
  ~MPMTrialForces() = default;
};

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
