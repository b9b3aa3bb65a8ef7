/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_LISTED_POINTS_H
#define LMP_MPM_LISTED_POINTS_H

namespace LAMMPS_NS {

/** Knows the points that can touch other atoms. Implemented by a fix. */
class MPMListedPoints {
 public:
  /** Are all points that can touch something in this group (index), so that neighbor lists may be
   *  of this group only? */
  virtual bool keeps_group(int group) const = 0;

 protected:
  ~MPMListedPoints() = default;    // owned and deleted as a Fix
};

}    // namespace LAMMPS_NS
#endif
