/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_CHECKS_H
#define LMP_MPM_FLOW_CHECKS_H

#include "field/mpm_coupling.h"
#include "field/mpm_doubts.h"
#include "flow/mpm_flow_parts.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Checks of a flow before a run: its points, groups, and what else is in the box. Each stops with
 *  an error, or warns once. */
class MPMFlowChecks : protected Pointers {
 public:
  /** id: of the fix. */
  MPMFlowChecks(class LAMMPS *, const MPMIncompressibleOptions &, MPMFlowLiquids &,
                const MPMFlowParts &, const std::string &id);

  /** Gives a mass to points that have none yet, and checks all points and groups. Finds the
   *  densities of solids. */
  void check_points();
  /** Checks for other fixes in the same box whose points this flow would go through. */
  void check_others(const Fix &mine);
  /** Refuses points outside of the box. */
  void check_box() const;
  /** Refuses what the volume of a pocket, which follows from the flow through its surface, does not
   *  account for. */
  void check_gas();
  /** Refuses points that begin deep in a wall. Points near its surface are moved out of it in the
   *  first step. */
  void check_depths() const;
  /** Refuses a time step that is too large for the stiffness of solids, and warns of a fluid that
   *  is not viscous enough for it. */
  void check_stiffness();

  /** Warns of a time step that nobody has set. */
  void check_time_step();

  /** Once in each step: what may become wrong in it. */
  void look();

  MPMUncoupled uncoupled;    ///< other matter in the same box

 private:
  const MPMIncompressibleOptions &options;
  MPMFlowLiquids &liquids;
  const MPMFlowParts &parts;
  const std::string id, who;
  MPMDoubts doubts;
  bool warned_of_size = false, warned_of_liquids = false, warned_of_regions = false,
       warned_of_interfaces = false, warned_of_laws = false, warned_of_loads = false,
       has_gravity = false;

  double density(int i) const;
  bool is_solid(int i) const;
  void check_masses(const std::vector<bigint> &mine) const;
  void check_liquids();
  void check_solids();
  void check_laws();
  void check_loads();
};

}    // namespace LAMMPS_NS
#endif
