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

/** Sum of the gravity of all fix gravity commands. */
class MPMGravity {
 public:
  MPMGravity() = default;
  /** user: named in the error if a fix gravity has a group other than all. */
  MPMGravity(LAMMPS *, const std::string &user);
  bool empty() const { return fixes.empty(); }
  /** The present force per mass [force/mass]. */
  void find(double gravity[3]) const;

 private:
  std::vector<Fix *> fixes;
};

}    // namespace LAMMPS_NS
#endif
