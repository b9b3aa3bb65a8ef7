/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_EVERY_H
#define LMP_MPM_EVERY_H

#include "atom.h"
#include "base/mpm_rows.h"
#include "field/mpm_field.h"
#include "update.h"

namespace LAMMPS_NS {

/** Steps of the cycle that take several steps of LAMMPS (keyword every). */
class MPMEvery : protected Pointers {
 public:
  /** [n][3] means over the time since the last step of the cycle, of points. */
  std::vector<double> mean_force, mean_torque;

  /** Is written to restart files. */
  struct {
    int waited = 0;          ///< steps of LAMMPS since the last step of the cycle
    double elapsed = 0.0;    ///< duration of these steps
  } progress;

  MPMEvery(class LAMMPS *, MPMField &, MPMPointState &);

  /** Called once in each step of LAMMPS; true if it is not yet time for the cycle. */
  bool wait();
  /** End of a step of the cycle. */
  void finish();
  /** Start of a run: drops a step of the cycle that an error has interrupted. */
  void forget_broken_step();

  /** Duration of the present step of the cycle; steps of LAMMPS still to come count with the
   *  present dt. */
  double step_dt() const
  {
    return progress.elapsed + (field.options.every - progress.waited) * update->dt;
  }
  /** Steps of LAMMPS until the next step of the cycle ends, seen from the end of this step. */
  int steps_to_next() const
  {
    const int every = field.options.every;
    return progress.waited < every ? every - progress.waited : every;
  }
  /** Displacement of a point along axis d from its place on the lattice. */
  double displacement(int i, int d) const { return waiting[i][3 + d]; }

 private:
  MPMField &field;
  // [n][6 or 9] impulse since the last step of the cycle [3], displacement from the place on the
  // lattice [3], and, if atoms have torques, angular impulse [3]
  MPMRows waiting;
  int width() const { return atom->torque_flag ? 9 : 6; }
};

}    // namespace LAMMPS_NS
#endif
