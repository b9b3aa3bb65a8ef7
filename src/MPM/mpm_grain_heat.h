/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_GRAIN_HEAT_H
#define LMP_MPM_GRAIN_HEAT_H

#include "mpm_rows.h"
#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {
class FixMPMMaterial;
class MPMConduction;
class MPMField;

/** Heat between grains and material points, by atom->temperature and atom->heatflow, as pair_style granular and
 *  fix heat/flow know them. Grains have their heat at the end of the step in which they touch; points get
 *  theirs from the nodes of the next step, and until then it waits. */
class MPMGrainHeat : protected Pointers {
 public:
  /** waiting: [n][1] heat of points that nodes do not have yet [energy], part of the state of points. */
  MPMGrainHeat(class LAMMPS *lmp, const MPMRows &waiting) : Pointers(lmp), waiting(waiting) {}

  /** Start of a run: stops with an error when something is missing, or something else moves the temperatures
   *  of points. */
  void init();
  /** Puts the temperatures of this rank's points into atom->temperature. */
  void show();
  /** Forces are known: time step that the heat flow belongs to. */
  void note_step();
  /** End of a step: heat that has come to points of this rank, which waits from now on. Returns the sum. */
  double take();
  /** What waits goes to the nodes of a field; collective. */
  void give(MPMConduction &);
  /** Sum over this rank's points. */
  double sum_waiting() const;

  double memory_usage() const { return energy.capacity() * sizeof(double); }

 private:
  const MPMRows &waiting;
  std::vector<MPMField *> fields;
  double dt = 0.0;
  std::vector<double> energy;    // of points, for a field

  const FixMPMMaterial *material_of(int i) const;
};

}    // namespace LAMMPS_NS
#endif
