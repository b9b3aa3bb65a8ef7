/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CONTINUATION_H
#define LMP_MPM_CONTINUATION_H

#include "pointers.h"

#include <string>

namespace LAMMPS_NS {
class MPMField;

/** What the run that wrote a restart file had that is not in LAMMPS's part of the file, and of which an
 *  input that goes on from it may have forgotten something: fixes and exclusions from neighbor lists;
 *  and whether points and materials have changed since. */
class MPMContinuation : protected Pointers {
 public:
  MPMContinuation(class LAMMPS *lmp, const MPMField &field) : Pointers(lmp), field(field) {}

  /** Lines for the restart file; on all ranks together. */
  std::string state() const;
  /** Those of the file that the next run goes on from. */
  void expect(const std::string &lines) { expected = lines; }
  /** Node spacing and origin, if they give another lattice than they did. */
  std::string other_lattice() const;
  /** Start of a run, on all ranks together: warns of differences. first: of all fields. */
  void check(bool first);

 private:
  const MPMField &field;
  std::string expected;    // empty: nothing to check

  void sums(double &mass, double &motion) const;
  std::string missing_fixes() const;
  void check_points() const;
  void check_materials() const;
};

}    // namespace LAMMPS_NS
#endif
