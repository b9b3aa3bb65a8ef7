/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_INTEGRATOR_H
#define LMP_MPM_INTEGRATOR_H

#include "atom.h"
#include "error.h"
#include "fix.h"
#include "lammps.h"
#include "modify.h"
#include "update.h"
#include "utils.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Start of a run: stops unless it is one of run_style verlet. who: a fix that moves points. */
inline void check_integrator(LAMMPS *lmp, const std::string &who)
{
  if (utils::strmatch(lmp->update->integrate_style, "^respa"))
    lmp->error->all(FLERR, Error::NOLASTLINE, "{} requires run_style verlet", who);
  if (lmp->update->whichflag == 2)
    lmp->error->all(FLERR, Error::NOLASTLINE,
                    "{} cannot be used with minimize, which would move material points like atoms: "
                    "minimize before the fix is defined",
                    who);
}

/** Has LAMMPS set a fix that moves points up for a step? */
class MPMSetUp {
 public:
  /** In init(). */
  void remember(LAMMPS *lmp)
  {
    numbers = find(lmp);
    known = true;
    natoms = -1;
  }
  /** In post_run() of the first fix that moves points: the next ones come after points that it has
   *  deleted. */
  void finish(LAMMPS *lmp) { natoms = lmp->atom->natoms; }
  /** Start of a step, before atoms come or go: stops if there was no set-up, as there is none after
   *  the end of a run within another one, or if fixes of this package have been defined or deleted
   *  since then, or atoms since the end of the last run, as run ... pre no would use what is gone,
   *  and leave out what is new. who: the fix that asks. */
  void check(LAMMPS *lmp, const std::string &who) const
  {
    const Update &update = *lmp->update;
    if (update.whichflag != 1)
      lmp->error->all(FLERR, Error::NOLASTLINE,
                      "{} has not been set up for this step: a command run among the commands of "
                      "run every ends the run that it is part of, so use a loop of runs",
                      who);
    if (update.ntimestep != update.firststep + 1) return;
    const bigint now = lmp->atom->natoms;
    if (known && numbers == find(lmp) && (natoms < 0 || natoms == now)) return;
    const std::string what = known && numbers == find(lmp)
        ? fmt::format("there are {} atoms, and were {} at the end of the last run", now, natoms)
        : "fixes mpm/... have been defined or deleted since the last set-up";
    lmp->error->all(FLERR, Error::NOLASTLINE,
                    "{}: {}, which run with pre no leaves out: use run without pre no", who, what);
  }

 private:
  bool known = false;
  std::vector<int> numbers;
  bigint natoms = -1;    // at the end of the run before; -1: LAMMPS has made a set-up since

  /** LAMMPS numbers all fixes that it makes. */
  struct Number : Fix {
    static int of(const Fix &fix) { return fix.*(&Number::instance_me); }
  };
  static std::vector<int> find(LAMMPS *lmp)
  {
    std::vector<int> list;
    for (const auto *fix : lmp->modify->get_fix_list())
      if (utils::strmatch(fix->style, "^mpm")) list.push_back(Number::of(*fix));
    return list;
  }
};

}    // namespace LAMMPS_NS
#endif
