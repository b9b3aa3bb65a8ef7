/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_POINT_ENERGIES_H
#define LMP_MPM_POINT_ENERGIES_H

namespace LAMMPS_NS {

/** Energy that material points have, and have spent so far [energy]; this rank's share. */
struct MPMPointEnergies {
  double kinetic;
  double stored;              ///< elastic energy and energy of the equation of state
  double plastic, viscous;    ///< work so far
  double heat;                ///< the part of the plastic work that has become heat
  double fracture;            ///< work spent on damage so far
  double thermoelastic;       ///< energy that went from stress into heat by expansion so far

  /** What the points have taken up, in whatever form. */
  double taken() const { return stored + plastic + viscous + fracture + thermoelastic; }
  double total() const { return kinetic + taken(); }
};

/** Those of the points of all fields, as they are now. */
MPMPointEnergies point_energies(class LAMMPS *lmp);

}    // namespace LAMMPS_NS
#endif
