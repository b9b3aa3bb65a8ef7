/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_POINT_SUMMARY_H
#define LMP_MPM_POINT_SUMMARY_H

#include <string>

namespace LAMMPS_NS {

/** Energy that material points have now, and energy that they have spent so far [energy], on this
 *  rank. */
struct MPMPointEnergies {
  double kinetic;
  double stored;              ///< elastic energy and energy of the equation of state
  double plastic, viscous;    ///< work so far
  double heat;                ///< part of the plastic work that has become heat
  double fracture;            ///< work spent on damage so far
  double thermoelastic;       ///< energy converted from stress into heat by expansion so far

  /** Energy that the points have taken up, in any form. */
  double taken() const { return stored + plastic + viscous + fracture + thermoelastic; }
  /** Kinetic energy, and the energy that the points have taken up. */
  double total() const { return kinetic + taken(); }
};

/** Energies of the points of all fields at present. */
MPMPointEnergies point_energies(class LAMMPS *lmp);

/** Part of the summary of a run: the time step as a fraction of the largest stable one, and a line
 *  with the smallest and largest volume ratio det F and the largest speed of the points of a field,
 *  with the IDs of these points. Collective. */
std::string point_extremes(class LAMMPS *lmp, const class MPMField &field);

}    // namespace LAMMPS_NS
#endif
