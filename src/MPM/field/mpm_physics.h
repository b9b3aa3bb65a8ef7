/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PHYSICS_H
#define LMP_MPM_PHYSICS_H

#include "field/mpm_plan.h"

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

/** Physics that takes part in the step, such as heat or pore water. At the start of each run, fix mpm finds
 *  all fixes that derive from this class. The example in examples/own-physics is explained line by line. */
class MPMPhysics {
 public:
  /** Start of a run: check the settings, and declare node fields (MPMNodes::add_field). */
  virtual void init_physics(MPMPlan &) = 0;

  /** Append the stages for one place in the step to the plan (MPMPlan::each, MPMPlan::together). */
  virtual void add_stages(MPMPlan &, MPMPlan::Place) = 0;

  /** Setup of a run: initial values of points, before points without stress get one. The positions of the
   *  points of all fields are known, nodes are not. */
  virtual void setup_points() {}

  /** Called when the blocks in reach of the points of a field are known: activate any other blocks that are
   *  needed. */
  virtual void extend_topology(MPMField &) {}
  /** Called when all blocks are known: make lists of nodes. Slots are valid until the next call. */
  virtual void topology_changed(MPMField &) {}
  /** Does this physics read nodes that no point reaches, or their periodic images? If so, all ranks keep the
   *  values of these nodes. */
  virtual bool looks_beyond_points() const { return true; }

  /** Largest stable time step for the points of a field on this rank; tag: ID of the point that limits it. */
  virtual double stable_dt(const MPMField &, tagint & /*tag*/) const
  {
    return std::numeric_limits<double>::max();
  }

  /** Speed of the fastest wave at point i, where c is the wave speed of its material alone. */
  virtual double wave_speed(const MPMField &, int /*i*/, double c) const { return c; }

  /** [n] J times a pressure that acts in the internal forces in addition to the stress of the points, or
   *  null. The stress that points keep is then the effective stress. */
  virtual const double *pressure_in_forces(const MPMField &) const { return nullptr; }

  /** Kirchhoff stress that acts in the internal forces in addition to the stress of the points, as a load on
   *  them: its work counts as external. adds_stress(): has any of the points [first,last) such a stress?
   *  add_stress(): add it for n points from first on, tau: [n][6], xx yy zz xy xz yz. */
  virtual bool adds_stress(const MPMField &, int /*first*/, int /*last*/) const { return false; }
  virtual void add_stress(const MPMField &, int /*first*/, int /*n*/, double * /*tau*/) const {}

  /** Does this physics only apply loads to points, by forces (atom->f), add_stress(), and, where loads depend
   *  on the deformation, follow()? Then it can be used with steps of any kind. */
  virtual bool only_loads() const { return false; }
  /** In a step whose stress is solved for: does everything that this physics does to points and forces happen
   *  before the momentum equation? This holds if it reads only the motion of earlier steps. */
  virtual bool precedes_motion() const { return false; }
  /** Does this physics bring bodies to rest, or solve for their state, in many small steps? Moving least
   *  squares let surfaces that are inclined to the lattice give way in these, so stress uses gradients by
   *  default. The answer must be known when fixes are defined. */
  virtual bool brings_to_rest() const { return false; }
  /** joins_motion(): does an implicit step solve for a pressure of nodes of this physics together with the
   *  motion? Then this is all that the physics does in such steps. The answer must be known when fixes are
   *  defined. node_pressure(): that pressure in a field, or null where the field has none. */
  virtual bool joins_motion() const { return false; }
  virtual MPMNodePressure *node_pressure(const MPMField &) { return nullptr; }

  /** Loads that depend on the deformation of a point, for a solver that looks for the state at the end of a
   *  step. follows(): has any of the points [first,last) such a load? follow(): for n points from first on
   *  with the deformation gradients F [n][9], row-major, add the change of their forces relative to those in
   *  atom->f, force: [n][3], and of the stress of add_stress(), tau: [n][6]. */
  virtual bool follows(const MPMField &, int /*first*/, int /*last*/) const { return false; }
  virtual void follow(const MPMField &, int /*first*/, int /*n*/, const double * /*F*/,
                      double * /*force*/, double * /*tau*/) const
  {
  }

  /** Loads that depend on the positions of all points of a surface, and are in atom->f, too; null where a
   *  field has none. */
  virtual MPMTrialForces *trial_forces(const MPMField &) { return nullptr; }

  /** The part of the forces on walls that the contact of points does not bear, such as the pressure of water
   *  in pores: force[node][3] is the integral of N p n over the surface of the body [mass acceleration], with
   *  n outward and p the pressure of pressure_in_forces(). It is found at the nodes of the blocks marked in
   *  near (and may be found at others). Returns false, and leaves force unchanged, where there is no such
   *  part. Collective; call after the momentum equation. */
  virtual bool surface_force(MPMField &, const std::vector<char> & /*near*/,
                             std::vector<double> & /*force*/) const
  {
    return false;
  }

  /** Points whose strain rate differs from the motion of the nodes around them. stretches(): has any of n
   *  points from first on a rate of its own? stretch_gradients(): change the velocity gradients L of these
   *  points in a step of duration dt, [n][dim*dim], column-major. Called only for physics that its
   *  init_physics() has added to MPMField::stretching. */
  virtual bool stretches(int /*first*/, int /*n*/) const { return false; }
  virtual void stretch_gradients(MPMField &, int /*first*/, int /*n*/, double /*dt*/,
                                 double * /*L*/)
  {
  }

  /** Quantities of points for compute mpm/atom: their names, which are fixed when the fix is defined, and the
   *  value of quantity k at point i. */
  virtual std::vector<std::string> quantities() const { return {}; }
  virtual double quantity(int /*k*/, int /*i*/) const { return 0.0; }

  /** Entries of compute mpm/energy: their names, which are fixed when the fix is defined, and their present
   *  values on this rank [energy]. */
  struct Account {
    std::string name;
    bool stored;    ///< energy that bodies have now; false: energy received so far
    /** The energy exchanged between the motion and this physics is part of the entry of time integration: the
     *  residual closes without this entry. */
    bool in_integration = false;
  };
  virtual std::vector<Account> accounts() const { return {}; }
  virtual void account(double * /*values*/) const {}    ///< adds to values
  /** Energy that the points of this rank have now, of which the accounts hold the changes. It sets the size
   *  of the round-off of these accounts [energy]. */
  virtual double energy_at_hand() const { return 0.0; }

 protected:
  ~MPMPhysics() = default;    // owned and deleted as a Fix
};

/** J times the pressure that the physics of a field adds to the internal forces, for each point, or null. */
const double *pressure_of_physics(const MPMField &);
/** Does any physics add a stress to the points [first,last)? */
bool physics_adds_stress(const MPMField &, int first, int last);
/** Adds the stress of all physics, see MPMPhysics::add_stress(). */
void add_stress_of_physics(const MPMField &, int first, int n, double *tau);
/** Calls MPMPhysics::surface_force() of the physics that has such a force. */
bool surface_force_of_physics(MPMField &, const std::vector<char> &near,
                              std::vector<double> &force);
/** Subtracts a pressure from the stress of n <= BATCH rows from point first on; room: work space [6*n]. */
void add_pressure(const double *pressure, MPM_NS::PointRows &, int first, int n, double *room);

/** All fixes that derive from class T, in the order of their definition. */
template <class T> std::vector<T *> find_fixes(LAMMPS *lmp)
{
  std::vector<T *> list;
  for (auto *ifix : lmp->modify->get_fix_list())
    if (auto *found = dynamic_cast<T *>(ifix)) list.push_back(found);
  return list;
}

}    // namespace LAMMPS_NS
#endif
