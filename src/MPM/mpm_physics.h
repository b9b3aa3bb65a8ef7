/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PHYSICS_H
#define LMP_MPM_PHYSICS_H

#include "mpm_plan.h"

#include "fix.h"
#include "lammps.h"
#include "modify.h"
#include "transfer/kernels.h"

#include <limits>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;
class MPMNodePressure;
class MPMTrialForces;

/** Physics that joins the step: heat, pore water, ... Fixes that derive from this class are found by fix
 *  mpm at the start of each run. examples/own-physics has one, line by line. */
class MPMPhysics {
 public:
  /** Start of a run: check, and declare node fields (MPMNodes::add_field). */
  virtual void init_physics(MPMPlan &) = 0;

  /** Append the stages for a place in the step to the plan (MPMPlan::each, MPMPlan::together). */
  virtual void add_stages(MPMPlan &, MPMPlan::Place) = 0;

  /** Setup of a run, before points without stress get one: what points have at first. Places of the points of all fields
   *  are known, nodes are not. */
  virtual void setup_points() {}

  /** The blocks in reach of the points of a field are known: activate others that are needed, and, when
   *  all are known, make lists of nodes; slots are valid until the next call. */
  virtual void extend_topology(MPMField &) {}
  virtual void topology_changed(MPMField &) {}
  /** Does it look at nodes that no point reaches, or at their periodic images? All ranks keep their values then. */
  virtual bool looks_beyond_points() const { return true; }

  /** Largest stable time step of this rank's points of a field; tag: of the point that limits it. */
  virtual double stable_dt(const MPMField &, tagint & /*tag*/) const
  {
    return std::numeric_limits<double>::max();
  }

  /** Speed of the fastest wave of a point whose material alone has the wave speed c. */
  virtual double wave_speed(const MPMField &, int /*i*/, double c) const { return c; }

  /** [n] J times a pressure that internal forces have besides the stress of points, or null: what points
   *  keep as their stress is the effective one. */
  virtual const double *pressure_in_forces(const MPMField &) const { return nullptr; }

  /** Kirchhoff stress that internal forces have besides that of points, as a load on these: its work is external. Have any of
   *  the points [first,last) one? If so, add it to that of n points from first on, tau: [n][6], xx yy zz xy xz yz. */
  virtual bool adds_stress(const MPMField &, int /*first*/, int /*last*/) const { return false; }
  virtual void add_stress(const MPMField &, int /*first*/, int /*n*/, double * /*tau*/) const {}

  /** Does it nothing but load points with forces (atom->f), add_stress(), and, where these depend on the deformation, follow()? It
   *  goes with steps of any kind then. */
  virtual bool only_loads() const { return false; }
  /** Is all that it does to points and forces there before the momentum equation of a step whose stress is solved for, as what it
   *  reads of the motion is that of steps before? */
  virtual bool precedes_motion() const { return false; }
  /** Does it bring bodies to rest, or solve for their state, in many small steps in which surfaces that are inclined to the lattice
   *  give way with moving least squares? Stress is that of gradients by default then. Known when fixes are defined. */
  virtual bool brings_to_rest() const { return false; }
  /** The pressure of nodes that an implicit step solves for together with the motion; null: there is none in this field. If
   *  joins_motion(), which is known when fixes are defined, the physics has its part in such steps by this alone. */
  virtual bool joins_motion() const { return false; }
  virtual MPMNodePressure *node_pressure(const MPMField &) { return nullptr; }

  /** Loads that depend on the deformation of a point, for a solver that looks for the state of the end of a step. Has any of the
   *  points [first,last) one? If so, for n points from first on with the deformation gradients F [n][9], row-major: add what
   *  changes of the forces on them in atom->f, force: [n][3], and add_stress() with these, tau: [n][6]. */
  virtual bool follows(const MPMField &, int /*first*/, int /*last*/) const { return false; }
  virtual void follow(const MPMField &, int /*first*/, int /*n*/, const double * /*F*/,
                      double * /*force*/, double * /*tau*/) const
  {
  }

  /** Loads that depend on where all of the points of a surface are, which are in atom->f, too; null: there are none in this field. */
  virtual MPMTrialForces *trial_forces(const MPMField &) { return nullptr; }

  /** The part of forces on walls that the contact of points does not bear, such as that of water in pores: at nodes of blocks
   *  that are marked in near (and others), force[node][3] is the integral of N p n over the surface of the body [mass
   *  acceleration], n outward; it is of the pressure_in_forces(). Returns false, and leaves force alone, where there is none.
   *  Collective; after the momentum equation. */
  virtual bool surface_force(MPMField &, const std::vector<char> & /*near*/,
                             std::vector<double> & /*force*/) const
  {
    return false;
  }

  /** Points that strain otherwise than the nodes around them move: has any of n points from first on its own rate? If so, in a step
   *  of the duration dt, change their velocity gradients L, [n][dim*dim], column-major. Only of physics that its init_physics() has
   *  put into MPMField::stretching. */
  virtual bool stretches(int /*first*/, int /*n*/) const { return false; }
  virtual void stretch_gradients(MPMField &, int /*first*/, int /*n*/, double /*dt*/,
                                 double * /*L*/)
  {
  }

  /** Quantities of points for compute mpm/atom: names, fixed when the fix is defined, and their values. */
  virtual std::vector<std::string> quantities() const { return {}; }
  virtual double quantity(int /*k*/, int /*i*/) const { return 0.0; }

  /** Entries of compute mpm/energy: names, fixed when the fix is defined, and the present values of
   *  this rank [energy]. */
  struct Account {
    std::string name;
    bool stored;    ///< energy that bodies have now; else energy that has come to them so far
    /** What the motion gives to and gets of this physics is in the entry of time integration: the residual closes without
     *  this entry. */
    bool in_integration = false;
  };
  virtual std::vector<Account> accounts() const { return {}; }
  virtual void account(double * /*values*/) const {}    ///< adds to what is there
  /** How much the points of this rank have of the energy whose changes are in the accounts, which have the round-off of it [energy]. */
  virtual double energy_at_hand() const { return 0.0; }

 protected:
  ~MPMPhysics() = default;    // owned and deleted as a Fix
};

/** What the physics of a field add to internal forces: J times a pressure for each point, or null. */
const double *pressure_of_physics(const MPMField &);
/** Has any physics a load that is a stress of points [first,last)? */
bool physics_adds_stress(const MPMField &, int first, int last);
/** Add the loads of all of them, see MPMPhysics::add_stress(). */
void add_stress_of_physics(const MPMField &, int first, int n, double *tau);
/** MPMPhysics::surface_force() of the physics that has one. */
bool surface_force_of_physics(MPMField &, const std::vector<char> &near,
                              std::vector<double> &force);
/** Take it from the stress of n <= BATCH rows from point first on, for which there is room [6*n]. */
void add_pressure(const double *pressure, MPM_NS::PointRows &, int first, int n, double *room);

/** All fixes that derive from a class, in the order of their definition. */
template <class T> std::vector<T *> find_fixes(LAMMPS *lmp)
{
  std::vector<T *> list;
  for (auto *ifix : lmp->modify->get_fix_list())
    if (auto *found = dynamic_cast<T *>(ifix)) list.push_back(found);
  return list;
}

}    // namespace LAMMPS_NS
#endif
