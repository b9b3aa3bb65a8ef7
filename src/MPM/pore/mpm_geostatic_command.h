/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef COMMAND_CLASS
// clang-format off
CommandStyle(mpm_geostatic,MPMGeostaticCommand);
// clang-format on
#else

#ifndef LMP_MPM_GEOSTATIC_COMMAND_H
#define LMP_MPM_GEOSTATIC_COMMAND_H

#include "command.h"

namespace LAMMPS_NS {

/** Command mpm_geostatic: gives the points of a field the stress of level ground at rest under its
 *  weight (MPMGeostatic). */
class MPMGeostaticCommand : public Command {
 public:
  MPMGeostaticCommand(class LAMMPS *lmp) : Command(lmp) {}
  void command(int, char **) override;

 private:
  void check_fixes();
  void check_field(const class MPMField &);
  const class FixMPMMixture *mixture_of(const class MPMField &);
};

}    // namespace LAMMPS_NS
#endif
#endif
