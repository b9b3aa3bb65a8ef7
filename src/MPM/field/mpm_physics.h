/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PHYSICS_H
#define LMP_MPM_PHYSICS_H

#include "field/mpm_plan.h"

#include "base/mpm_find_fixes.h"

#include <limits>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Physics that takes part in the step, such as heat or pore water. At the start of each run, fix
 *  mpm finds all fixes that derive from this class. The example in examples/own-physics is
 *  explained line by line. What acts on points in other ways than stages do also derives from the
 *  classes of mpm_forces.h. */
class MPMPhysics {
 public:
  /** Start of a run: check the settings, and declare node fields (MPMNodes::add_field). */
  virtual void init_physics(MPMPlan &) = 0;
  /** Does init_physics() need what that of all others has found, in whatever order fixes are
   *  defined? */
  virtual bool needs_others() const { return false; }

  /** Append the stages for one place in the step to the plan (MPMPlan::each, MPMPlan::together). */
  virtual void add_stages(MPMPlan &, MPMPlan::Place) = 0;

  /** Setup of a run: initial values of points, before points without stress get one. The positions
   *  of the points of all fields are known, nodes are not. */
  virtual void setup_points() {}

  /** Called when the blocks in reach of the points of a field are known: activate any other blocks
   *  that are needed. */
  virtual void extend_topology(MPMField &) {}
  /** Called when all blocks are known: make lists of nodes. Slots are valid until the next call. */
  virtual void topology_changed(MPMField &) {}
  /** Does this physics read nodes that no point reaches, or their periodic images? If so, all ranks
   *  keep the values of these nodes. */
  virtual bool looks_beyond_points() const { return true; }

  /** Largest stable time step for the points of a field on this rank; tag: ID of the point that
   *  limits it. */
  virtual double stable_dt(const MPMField &, tagint & /*tag*/) const
  {
    return std::numeric_limits<double>::max();
  }

  /** Speed of the fastest wave at point i, where c is the wave speed of its material alone. */
  virtual double wave_speed(const MPMField &, int /*i*/, double c) const { return c; }

  /** In a step whose stress is solved for: does everything that this physics does to points and
   *  forces happen before the momentum equation? This holds if it reads only the motion of earlier
   *  steps. */
  virtual bool precedes_motion() const { return false; }
  /** Does this physics bring bodies to rest, or solve for their state, in many small steps? Moving
   *  least squares let surfaces that are inclined to the lattice give way in these, so stress uses
   *  gradients by default. The answer must be known when fixes are defined. */
  virtual bool brings_to_rest() const { return false; }
  /** Quantities of points for compute mpm/atom: their names, which are fixed when the fix is
   *  defined, and the value of quantity k at point i. */
  virtual std::vector<std::string> quantities() const { return {}; }
  virtual double quantity(int /*k*/, int /*i*/) const { return 0.0; }

  /** Entries of compute mpm/energy: their names, which are fixed when the fix is defined, and their
   *  present values on this rank [energy]. */
  struct Account {
    std::string name;
    bool stored;    ///< energy that bodies have now; false: energy received so far
    /** The energy exchanged between the motion and this physics is part of the entry of time
     *  integration: the residual closes without this entry. */
    bool in_integration = false;
    bool heat = false;    ///< is what bodies have now heat, which no motion can have given?
  };
  virtual std::vector<Account> accounts() const { return {}; }
  virtual void account(double * /*values*/) const {}    ///< adds to values
  /** Energy that the points of this rank have now, of which the accounts hold the changes. It sets
   *  the size of the round-off of these accounts [energy]. */
  virtual double energy_at_hand() const { return 0.0; }

 protected:
  ~MPMPhysics() = default;    // owned and deleted as a Fix
};

}    // namespace LAMMPS_NS
#endif
