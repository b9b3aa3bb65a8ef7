/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PORE_CHECKS_H
#define LMP_MPM_PORE_CHECKS_H

#include "pointers.h"
#include "pore/mpm_pore_options.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {
class Fix;
class MPMField;

/** Checks of soils with pore water at the start of a run. Each stops with an error, or warns. */
class MPMPoreChecks : protected Pointers {
 public:
  /** id: of the fix, for messages. */
  MPMPoreChecks(class LAMMPS *lmp, const MPMPoreOptions &options, const std::string &id) :
      Pointers(lmp), options(options), id(id)
  {
  }

  /** Checks materials and variables of soils. */
  void check_soils() const;
  /** Checks soils with grains that are not rigid, once. */
  void check_grains();
  /** Warns of soils without points, as with the ID of another material, where the ground stays dry,
   *  and of soils that are lighter than their water, whose grains have a negative weight; without
   *  gravity, this is a way to allow longer steps. here: which soils have points on this rank.
   *  Collective. */
  void warn_of_soils(const std::vector<int> &here, bool has_weight) const;
  /** Checks options that implicit steps cannot have: their equations are linear in the pressure of
   *  nodes. */
  void check_implicit() const;
  /** Checks that the mass that moves by itself is less than all mass, and that nodes have
   *  accelerations. */
  void check_motion(const Fix &, MPMField &) const;

 private:
  const MPMPoreOptions &options;
  const std::string id;
  bool grains_known = false;    // was check_grains() done?
};

}    // namespace LAMMPS_NS
#endif
