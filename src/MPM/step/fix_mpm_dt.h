/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/dt,FixMPMDt);
// clang-format on
#else

#ifndef LMP_FIX_MPM_DT_H
#define LMP_FIX_MPM_DT_H

#include "declare/option.h"
#include "fix.h"

#include <limits>
#include <memory>
#include <vector>

namespace LAMMPS_NS {

/** Keywords of fix mpm/dt. */
struct MPMDtOptions {
  double fraction = 0.0, grow = 1.05, dt_min = 0.0, dt_max = 0.0;    ///< dt_min, dt_max: 0 = none
  double strain = 0.0;    ///< largest change of volume in a step; 0: no limit
  double grains = 0.0;    ///< largest share of a collision of grains in a step; 0: no limit
  double until = 0.0;     ///< elapsed time at which runs end; 0: none
  int look_every = 10;    ///< steps between checks of wave speeds

  MPM_NS::Options declare();
};

/** Sets the time step to a fraction of the smallest h/(c + |v|) over all material points. Can also
 *  limit the change of volume of points in a step and the share of a collision of grains in a step,
 *  and end runs at a given time. */
class FixMPMDt : public Fix, private MPMDtOptions {
 public:
  FixMPMDt(class LAMMPS *, int, char **);
  ~FixMPMDt() override;
  int setmask() override    // setup_pre_force() comes before fix mpm checks the time step
  {
    return FixConst::PRE_FORCE | FixConst::END_OF_STEP | FixConst::POST_RUN;
  }
  void init() override;
  void setup_pre_force(int) override;
  void end_of_step() override;
  void post_run() override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  int pack_forward_comm(int, int *, double *, int, int *) override;
  void unpack_forward_comm(int, int, double *) override;
  double compute_scalar() override;
  double compute_vector(int) override;
  /** Time to the end of the run, at most this one. */
  double time_left(double most) const;

 private:
  /** The point that limits the time step, or the collision of grains. */
  struct Limit {
    double dt;       // h/(c + |v|); 0: no valid wave speed; limit of strain or grains: dt/fraction
    double speed;    // wave speed; 0: limit of strain or grains
    double tag;
    double other;    // tag of the other grain; 0: a wall; NO_GRAIN: no collision
  };
  static constexpr double NO_GRAIN = -1.0;
  static constexpr Limit NO_POINTS = {std::numeric_limits<double>::max(), 0.0, 0.0, NO_GRAIN};
  Limit limit = {0.0, 0.0, 0.0, NO_GRAIN};
  std::unique_ptr<class MPMGrains> collisions;    // keyword grains
  double wanted = 0.0;    // time step before the last steps are fitted to the end time
  bigint nchanges = 0;

  // runs that end at a time
  bool ended = false, warned_of_rest = false;
  double time_at_start = 0.0, wall_at_start = 0.0;

  // state at the end of the last run, to detect changes since then
  bool continues = false;
  double dt_left = 0.0, wanted_left = 0.0;
  double limit_left = 0.0, grains_left = 0.0;    // time steps allowed by points and by grains
  Limit carried = NO_POINTS;    // limit by strain since the last check, from the restart file

  Limit find_limit() const { return grain_limit(point_limit()); }
  Limit point_limit() const;
  Limit strain_limit_local() const;
  Limit grain_limit(const Limit &points) const;
  Limit grain_limit(const Limit &points, double longest) const;
  double allowed(const Limit &limit) const
  {
    return limit.dt < NO_POINTS.dt ? fraction * limit.dt : NO_POINTS.dt;
  }
  double grain_dt(const Limit &) const;
  void note_limits();
  std::vector<double> saved_options() const;
  Limit smallest(Limit) const;
  std::string what_limits() const;
  void set_dt(double);
  void change_dt(double);
  void look();
  bool at_end() const;
  void stop_run();
  double fit_to_end(double dt, int least) const;
  void announce_end();
};

}    // namespace LAMMPS_NS
#endif
#endif
