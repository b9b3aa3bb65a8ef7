/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FIND_FIXES_H
#define LMP_MPM_FIND_FIXES_H

#include "fix.h"
#include "lammps.h"
#include "modify.h"

#include <vector>

namespace LAMMPS_NS {

/** All fixes that derive from class T, in the order of their definition. */
template <class T> std::vector<T *> find_fixes(LAMMPS *lmp)
{
  std::vector<T *> list;
  for (auto *ifix : lmp->modify->get_fix_list())
    if (auto *found = dynamic_cast<T *>(ifix)) list.push_back(found);
  return list;
}

}    // namespace LAMMPS_NS
#endif
