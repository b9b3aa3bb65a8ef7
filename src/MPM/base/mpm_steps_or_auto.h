/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_STEPS_OR_AUTO_H
#define LMP_MPM_STEPS_OR_AUTO_H

#include "declare/option.h"

#include <string>

namespace LAMMPS_NS {

/** Value of a keyword every: a number of steps, or the word auto, which is stored as 0. */
inline MPM_NS::OptionValue steps_or_auto(int &to, const std::string &of_number,
                                         const std::string &of_auto)
{
  MPM_NS::OptionValue value = MPM_NS::option::integer(to, "N", MPM_NS::POSITIVE, of_number);
  const auto read = value.read;
  const auto text = value.text;
  value.usage = "N or *auto*";
  value.notes.push_back({"*auto*", of_auto});
  value.read = [&to, read](MPM_NS::OptionReader &r) {
    if (r.iarg < r.input.narg && std::string(r.input.arg[r.iarg]) == "auto") {
      r.next();
      to = 0;
    } else {
      read(r);
    }
  };
  value.text = [&to, text] {
    return to ? text() : std::string("auto");
  };
  return value;
}

}    // namespace LAMMPS_NS
#endif
