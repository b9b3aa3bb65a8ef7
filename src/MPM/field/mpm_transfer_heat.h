/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_TRANSFER_HEAT_H
#define LMP_MPM_TRANSFER_HEAT_H

#include "field/mpm_field.h"

namespace LAMMPS_NS {

/** Converts the kinetic energy that transfers lose into heat of the points (keyword heat). */
class MPMTransferHeat : protected Pointers {
 public:
  MPMTransferHeat(class LAMMPS *lmp, MPMField &field) : Pointers(lmp), field(field) {}

  /** Start of a run: warns if no material takes up heat. */
  void init() const;
  /** Finds the terms that depend on the old velocities. Call before points get their new ones. */
  void before_motion();
  /** The heat of n points from first on in this step, per reference volume. The points must have
   *  their new velocities. The ledger counts this heat as given back. */
  void give(int first, int n, double *heat);

  double memory_usage() const { return (energy.capacity() + C.capacity()) * sizeof(double); }

 private:
  MPMField &field;
  std::vector<double>
      energy;               // [n] twice the energy over the mass, without that of the new velocity
  std::vector<double> C;    // [n][dim*dim] fit of the old velocities of the nodes

  double second_moment() const;
};

}    // namespace LAMMPS_NS
#endif
