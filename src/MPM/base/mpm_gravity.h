/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_GRAVITY_H
#define LMP_MPM_GRAVITY_H

#include "atom.h"
#include "error.h"
#include "fix.h"
#include "fix_gravity.h"
#include "lammps.h"
#include "modify.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Sum of the gravity of all fix gravity commands. */
class MPMGravity {
 public:
  MPMGravity() = default;
  /** Of all groups. Stops with an error where one has no direction, as LAMMPS sees it. */
  explicit MPMGravity(LAMMPS *lmp) :
      atom(lmp->atom), fixes(lmp->modify->get_fix_by_style("^gravity"))
  {
    double g[3];
    find(g);
    if (!std::isfinite(g[0] + g[1] + g[2]))
      lmp->error->all(
          FLERR, Error::NOLASTLINE,
          "Fix gravity has no direction: use a vector that is not zero, in 2d one along "
          "x or y");
  }
  /** user: named in the error if a fix gravity has a group other than all. */
  MPMGravity(LAMMPS *lmp, const std::string &user) :
      atom(lmp->atom), fixes(lmp->modify->get_fix_by_style("^gravity"))
  {
    for (const auto *fix : fixes)
      if (fix->igroup != 0)
        lmp->error->all(FLERR, Error::NOLASTLINE,
                        "{} takes the weight from fix gravity {}, which must be of group all", user,
                        fix->id);
  }
  bool empty() const { return fixes.empty(); }
  /** Is a fix gravity one by variables, which has no vector before its first forces? */
  static bool varies(const Fix *fix)
  {
    struct Gravity : public FixGravity {    // it does not tell
      static bool varies(const FixGravity *fix) { return fix->*(&Gravity::varflag) != CONSTANT; }
    };
    const auto *const gravity = dynamic_cast<const FixGravity *>(fix);
    return !gravity || Gravity::varies(gravity);
  }
  /** The present force per mass [force/mass]. After init(); all ranks must call it. */
  void find(double gravity[3])
  {
    if (!evaluated) evaluate();
    std::fill_n(gravity, 3, 0.0);
    for (auto *fix : fixes) {
      int dim;
      const auto *const g = (const double *) fix->extract("gvec", dim);
      for (int d = 0; d < 3; d++) gravity[d] += g[d];
    }
  }

 private:
  Atom *atom = nullptr;
  std::vector<Fix *> fixes;
  bool evaluated = false;

  /** LAMMPS evaluates the variables of fix gravity when it adds its forces, which may come
   *  later. */
  void evaluate()
  {
    evaluated = true;
    if (std::none_of(fixes.begin(), fixes.end(), varies)) return;
    const std::size_t n = 3 * (std::size_t) atom->nlocal;
    double *const f = n ? &atom->f[0][0] : nullptr;
    const std::vector<double> kept(f, f + n);
    for (auto *fix : fixes)
      if (varies(fix)) fix->post_force(0);
    std::copy_n(kept.data(), n, f);
  }
};

}    // namespace LAMMPS_NS
#endif
