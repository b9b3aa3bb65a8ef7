/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_GRAIN_HEAT_H
#define LMP_MPM_GRAIN_HEAT_H

#include "base/mpm_rows.h"
#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {
class FixMPMMaterial;
class MPMConduction;
class MPMField;

/** Heat exchange between grains and material points through atom->temperature and atom->heatflow,
 *  which pair_style granular and fix heat/flow use. Grains receive their heat at the end of the
 *  step in which they touch. Points receive theirs from the nodes in the next step; until then the
 *  heat waits. */
class MPMGrainHeat : protected Pointers {
 public:
  /** waiting: [n][1] heat of points that the nodes have not received yet [energy], part of the
   *  state of points. */
  MPMGrainHeat(class LAMMPS *lmp, const MPMRows &waiting) : Pointers(lmp), waiting(waiting) {}

  /** Start of a run: stops with an error if something is missing, or if another fix changes the
   *  temperatures of points. */
  void init();
  /** Copies the temperatures of this rank's points to atom->temperature. */
  void show();
  /** Called when forces are known: notes the time step that the heat flow belongs to. */
  void note_step();
  /** End of a step: adds the heat that points of this rank received to the waiting heat. Returns
   *  the sum. */
  double take();
  /** Gives the waiting heat to the nodes of a field. Collective. */
  void give(MPMConduction &);
  /** Sum of the waiting heat over this rank's points. */
  double sum_waiting() const;

  double memory_usage() const { return energy.capacity() * sizeof(double); }

 private:
  const MPMRows &waiting;
  std::vector<MPMField *> fields;
  double dt = 0.0;
  std::vector<double> energy;    // of points, for one field

  const FixMPMMaterial *material_of(int i) const;
  void warn_of_set();
};

}    // namespace LAMMPS_NS
#endif
