/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_EVERY_H
#define LMP_MPM_EVERY_H

#include "mpm_state.h"
#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Steps of LAMMPS between the steps of the cycle (keyword every). */
class MPMEvery : protected Pointers {
 public:
  std::vector<double> mean_force,
      mean_torque;    ///< [n][3] on points since the last step of the cycle

  /** What goes to restart files. */
  struct {
    int waited;        ///< steps of LAMMPS since the last step of the cycle
    double elapsed;    ///< and their duration
  } progress;

  MPMEvery(class LAMMPS *, MPMField &, MPMPointState &);

  /** Called once in each step of LAMMPS; true when it is not yet time for the cycle. */
  bool wait();
  /** End of a step of the cycle. */
  void finish();

  /** Duration of the present step of the cycle. */
  double step_dt() const;
  /** Steps of LAMMPS until the next step of the cycle ends, seen from the end of this step. */
  int steps_to_next() const;
  /** From the place of a point on the lattice to where it is, along axis d. */
  double displacement(int i, int d) const { return waiting[i][3 + d]; }

 private:
  MPMField &field;
  double *
      *waiting;    // [n][6 or 9] impulse since the last step of the cycle, displacement from the
                   // place on the lattice, angular impulse if atoms have torques
  int width() const;
};

}    // namespace LAMMPS_NS
#endif
