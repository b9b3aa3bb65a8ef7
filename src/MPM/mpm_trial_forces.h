/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_TRIAL_FORCES_H
#define LMP_MPM_TRIAL_FORCES_H

namespace LAMMPS_NS {

/** Forces between points besides the stress of these, after a motion that a solver tries: of finite elements whose nodes are points. State is
 *  that of the start of the step, and is not changed. Vectors are [point of this rank][3], forces in units of force. All functions are
 *  collective. */
class MPMTrialForces {
 public:
  /** Forces after the displacements u in the step; adds the sum of their sizes over elements of this rank to carried. False, on this rank, where
   *  an element has no finite stress. */
  virtual bool forces_after(const double *u, double *force, double &carried) = 0;
  /** Differentiates them there. Returns the sum of the stiffness of the elements of this rank times their lengths: a strain e makes
   *  forces of e times that. */
  virtual double differentiate(const double *u) = 0;
  /** Adds the change of forces for a change du of the displacements. */
  virtual void add_change(const double *du, double *dforce) = 0;
  /** Adds minus the change of the force on each point by its own displacement, [point][dim][dim]. */
  virtual void add_blocks(double *blocks) = 0;
  /** Forces at the start of the step, as they are in atom->f. */
  virtual const double *forces() const = 0;
  /** Largest |K_kl - K_lk| of elements of this rank over their largest entry. */
  virtual double asymmetry() const = 0;

 protected:
  ~MPMTrialForces() = default;
};

}    // namespace LAMMPS_NS
#endif
