/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_INTERFACES_H
#define LMP_MPM_INTERFACES_H

#include "lmptype.h"

#include <cstddef>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Takes up heat that is made at nodes and conducts it into the material. Implemented by a fix. */
class MPMHeatSink {
 public:
  /** Does any material of this field conduct heat? */
  virtual bool conducts(const MPMField &) const = 0;
  /** Adds heat of friction [energy] at a node of a field that conducts. counts: it counts on this
   *  rank; all ranks that have the node add the same heat. */
  virtual void give(const MPMField &, std::size_t node, double heat, bool counts) = 0;

 protected:
  ~MPMHeatSink() = default;    // owned and deleted as a Fix
};

/** One body whose points are in several fields, each with half the node spacing of the previous
 *  one. Implemented by a fix. Fields are named by the IDs of their fixes mpm. */
class MPMRefinedBody {
 public:
  /** Is the field part of the body? */
  virtual bool has(const std::string &name) const = 0;
  /** Fields of this body that are finer than this one; empty if that is not part of the body. */
  virtual std::vector<MPMField *> finer_than(const std::string &name) const = 0;
  /** Activates the blocks of this field that the finer fields of the body need; also called before
   *  others use its blocks. */
  virtual void extend_for_finer(const MPMField &) const = 0;

 protected:
  ~MPMRefinedBody() = default;    // owned and deleted as a Fix
};

/** Makes walls, surfaces with a load or heat, bodies, or inlets of regions. Implemented by a
 *  fix. */
class MPMRegionUser {
 public:
  /** Is the region with this ID one of them? */
  virtual bool uses_region(const std::string &region) const = 0;
  /** Do its regions go on behind periodic faces? For others they end where they are. */
  virtual bool sees_images() const { return false; }

 protected:
  ~MPMRegionUser() = default;    // owned and deleted as a Fix
};

/** A region that keeps material out, such as a wall. Implemented by a fix. */
class MPMBarrier {
 public:
  /** Does it keep the material of this field out? */
  virtual bool keeps_out(const MPMField &) const = 0;
  /** Can its region be elsewhere, or have another shape, later in this run? Only during a run. */
  virtual bool changes_place() const = 0;
  /** Puts the region where it is at the start of the step: others may have moved it since. */
  virtual void go_to_start() = 0;
  /** Signed distance of x, negative in the region; far or -far if it is greater. */
  virtual double gap(const double *x, double far) const = 0;

 protected:
  ~MPMBarrier() = default;    // owned and deleted as a Fix
};

/** Knows the points that can touch other atoms. Implemented by a fix. */
class MPMListedPoints {
 public:
  /** Are all points that can touch something in this group (index), so that neighbor lists may be
   *  of this group only? */
  virtual bool keeps_group(int group) const = 0;

 protected:
  ~MPMListedPoints() = default;    // owned and deleted as a Fix
};

/** An incompressible fluid with a lattice of its own, for what moves in it or flows into it.
 *  Implemented by a fix. */
class MPMFluid {
 public:
  /** Node spacing. */
  virtual double spacing() const = 0;
  /** Node spacing if the region is solid for the fluid, else 0. */
  virtual double spacing_around(const std::string &region) const = 0;
  /** Density of points in groups with these bits, that are no solids. */
  virtual double density_of_groups(int mask) const = 0;
  /** Stops with an error if the density of the fluid given by another fix differs. who: the start
   *  of the message. */
  virtual void check_density(double of_fluid, const std::string &who) const = 0;
  /** Are the velocities with which it moves those of the middle of a step, and not those of its
   *  end? */
  virtual bool is_leapfrog() const = 0;

 protected:
  ~MPMFluid() = default;    // owned and deleted as a Fix
};

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
