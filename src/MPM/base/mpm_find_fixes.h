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
#include "utils.h"

#include <initializer_list>
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

/** All fixes whose style matches one of these patterns, in the order of their definition. Patterns
 *  of LAMMPS have neither alternatives nor groups: "^mpm/(a|b)$" is valid, and matches nothing. */
inline std::vector<Fix *> find_fixes(LAMMPS *lmp, std::initializer_list<const char *> patterns)
{
  std::vector<Fix *> list;
  for (auto *ifix : lmp->modify->get_fix_list())
    for (const char *const pattern : patterns)
      if (utils::strmatch(ifix->style, pattern)) {
        list.push_back(ifix);
        break;
      }
  return list;
}

/** Does a fix do something to atoms, and not just write or store? Those with names in capitals are
 *  LAMMPS's own. */
inline bool acts_on_atoms(const Fix &fix)
{
  for (const char *output :
       {"^ave/", "^print$", "^vector$", "^store", "^halt$", "^balance$", "^python$",
        "^python/invoke$", "^property/atom", "^mpm/cells$", "^[A-Z]"})
    if (utils::strmatch(fix.style, output)) return false;
  return true;
}

}    // namespace LAMMPS_NS
#endif
