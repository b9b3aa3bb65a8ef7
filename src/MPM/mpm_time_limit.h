/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_TIME_LIMIT_H
#define LMP_MPM_TIME_LIMIT_H

#include "pointers.h"

namespace MPM_NS {
struct Batch;
}    // namespace MPM_NS

namespace LAMMPS_NS {
class MPMField;

/** The largest stable time step of a field. */
class MPMTimeLimit : protected Pointers {
 public:
  /** Largest |J/J_old - 1|/dt of this rank's points in all steps since it was set to zero, and whose. */
  struct VolumeRate {
    double most;
    tagint tag;
  } volume_rate = {0.0, 0};
  /** Below that, forces that are impulses over the time step may be beyond the largest number. */
  static constexpr double SMALLEST = 1.0e-150;
  bool bound =
      true;    ///< the step is explicit; set to false by the init_physics() of one that is not
  bool watch_volume = false;    ///< keep volume_rate; set at the start of a run by fix mpm/dt

  MPMTimeLimit(class LAMMPS *lmp, MPMField &field) : Pointers(lmp), field(field) {}

  /** Start of a run. */
  void setup();
  /** Smallest over this rank's points of h/(c + |v|); the point's tag goes to id. */
  double stable_dt(tagint &id, double &wave_speed) const;
  /** Stop when the time step is above the limit; looks at it every few steps. */
  void check();

  void note_volume_rate(const MPM_NS::Batch &, int first);

 private:
  MPMField &field;
  bigint next_check = 0;

  double stable_share(double size) const;
  double share_of_thin_nodes() const;
  void warn() const;
  void warn_of_small() const;
};

/** Elapsed time at the end of the present step, as thermo keyword time has it. */
double elapsed_time(const class Update &);

}    // namespace LAMMPS_NS
#endif
