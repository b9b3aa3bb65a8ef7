/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_BOXES_H
#define LMP_MPM_BOXES_H

#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Points of finite size along the axes: GIMP with fixed sizes or with those of deformed points. */
class MPMBoxes : protected Pointers {
 public:
  std::vector<double> sizes;    ///< half sizes in node spacings, [n][3]

  MPMBoxes(class LAMMPS *, MPMField &);

  /** Sizes of this step. */
  void update();
  void size_of(int i, double size[3]) const;
  /** Is an undeformed point larger than a cell? */
  bool is_too_large(int i) const;
  /** Smallest half size of the undeformed points of this rank, in node spacings, at most that of a
   *  cell. */
  double smallest() const;

 private:
  MPMField &field;
};

/** Half of the edge of a cube (2d: square) with the initial volume of the point, in node spacings. */
double half_size(const MPMField &, int i);

}    // namespace LAMMPS_NS
#endif
