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

/** The largest stable time step of a field, and the check of the time step against it. */
class MPMTimeLimit : protected Pointers {
 public:
  /** Largest |J/J_old - 1|/dt of this rank's points in all steps since it was set to zero, and the
   *  tag of that point. */
  struct VolumeRate {
    double most;
    tagint tag;
  } volume_rate = {0.0, 0};
  /** With a smaller time step, forces that are impulses over the time step may exceed the largest
   *  number. */
  static constexpr double SMALLEST = 1.0e-150;
  bool bound = true;            ///< explicit step; init_physics() of implicit ones sets it to false
  bool watch_volume = false;    ///< keep volume_rate; set at the start of a run by fix mpm/dt

  MPMTimeLimit(class LAMMPS *lmp, MPMField &field) : Pointers(lmp), field(field) {}

  /** Start of a run: checks the time step, and warns where it may be unstable. */
  void setup();
  /** Smallest h/(c + |v|) of this rank's points. id: tag of the point that limits it; wave_speed:
   *  its c. */
  double stable_dt(tagint &id, double &wave_speed) const;
  /** Stops with an error if the time step is above the limit. It is checked every few steps. */
  void check();

  /** Updates volume_rate with the points of a batch, which begin at index first. */
  void note_volume_rate(const MPM_NS::Batch &, int first);

 private:
  MPMField &field;
  bigint next_check = 0;

  double stable_share(double size) const;
  double share_of_thin_nodes() const;
  void warn() const;
  void warn_of_small() const;
};

/** Elapsed time at the end of the present step, as for the thermo keyword time. */
double elapsed_time(const class Update &);

}    // namespace LAMMPS_NS
#endif
