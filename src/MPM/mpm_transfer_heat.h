/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_TRANSFER_HEAT_H
#define LMP_MPM_TRANSFER_HEAT_H

#include "mpm_field.h"

namespace LAMMPS_NS {

/** The kinetic energy that transfers lose becomes heat of the points (keyword heat). */
class MPMTransferHeat : protected Pointers {
 public:
  MPMTransferHeat(class LAMMPS *lmp, MPMField &field) : Pointers(lmp), field(field) {}

  /** Start of a run: tells when no material takes up heat. */
  void init() const;
  /** Before points get their new velocities: what depends on the old ones. */
  void before_motion();
  /** The heat of n points from first on in this step, per reference volume; they have their new velocities. It
   *  is booked as given back. */
  void give(int first, int n, double *heat);

  double memory_usage() const { return (energy.capacity() + C.capacity()) * sizeof(double); }

 private:
  MPMField &field;
  std::vector<double>
      energy;    // [n] twice the energy over the mass of the point, less that of its new velocity
  std::vector<double> C;    // [n][dim*dim] fit of the old velocities of the nodes

  double second_moment() const;
};

}    // namespace LAMMPS_NS
#endif
