/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_GRAVITY_H
#define LMP_MPM_GRAVITY_H

#include <string>
#include <vector>

namespace LAMMPS_NS {
class Fix;
class LAMMPS;

/** The weight that all fix gravity together give. */
class MPMGravity {
 public:
  MPMGravity() = default;
  /** user: for the error when a fix gravity has another group than all. */
  MPMGravity(LAMMPS *, const std::string &user);
  bool empty() const { return fixes.empty(); }
  /** The present force per mass [force/mass]. */
  void find(double gravity[3]) const;

 private:
  std::vector<Fix *> fixes;
};

}    // namespace LAMMPS_NS
#endif
