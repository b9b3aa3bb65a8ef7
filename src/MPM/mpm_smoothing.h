/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_SMOOTHING_H
#define LMP_MPM_SMOOTHING_H

#include "mpm_field.h"

namespace LAMMPS_NS {

/** Takes out of the volumes of points of fluids, and so out of their pressure, what the nodes do not
 *  see. */
class MPMSmoothing : protected Pointers {
 public:
  MPMSmoothing(class LAMMPS *lmp, MPMField &field) : Pointers(lmp), field(field) {}

  /** Start of a run: there must be a fluid. */
  void init() const;
  /** Start of a step, where points are what the map of them knows: of each fluid, as often as sound crosses
   *  a cell. */
  void smooth();

  double memory_usage() const { return sums.capacity() * sizeof(double); }

 private:
  MPMField &field;
  std::vector<double> sums;    // [node][Fit::WIDTH]

  double time_to_cross(const FixMPMMaterial &) const;
  template <int DIM> void fit_nodes(const FixMPMMaterial *);
  template <int DIM> void change_volumes(const FixMPMMaterial *, double share);
};

}    // namespace LAMMPS_NS
#endif
