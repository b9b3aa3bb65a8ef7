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

/** Checks of a run that continues from a restart file. Warns when the input lacks something that
 *  the run before had and that LAMMPS does not keep in the file (fixes, exclusions from neighbor
 *  lists), and when points or materials have changed since. */
class MPMContinuation : protected Pointers {
 public:
  MPMContinuation(class LAMMPS *lmp, const MPMField &field) : Pointers(lmp), field(field) {}

  /** The present state, as lines for the restart file. Collective. */
  std::string state() const;
  /** Sets the lines of the restart file from which the next run continues. */
  void expect(const std::string &lines) { expected = lines; }
  /** Text with the node spacing or origin of the run before, if it gave another lattice; else
   *  empty. */
  std::string other_lattice() const;
  /** Start of a run: warns of differences. first: this is the first of all fields. Collective. */
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
