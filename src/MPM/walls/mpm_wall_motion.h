/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_WALL_MOTION_H
#define LMP_MPM_WALL_MOTION_H

#include "lattice/grid.h"

#include <cstdint>

namespace LAMMPS_NS {

/** State of a wall after the last step, as kept in restart files, without padding. */
struct MPMWallState {
  double work;    ///< on the body, this rank's share; in files as energy, of all ranks
  double shift[3], gradient[3][3], origin[3];    ///< velocity at the end of the last step
  double region[4];                 ///< shift and angle of the region at the end of the last step
  double displaced[3];              ///< displacement at that time
  double turned[3][3], moved[3];    ///< as in MPMWallMotion, at that time
  int64_t acted;                    ///< was there a last step?
};

/** Motion of a wall in a step: its velocity at x is shift + gradient (x - origin). */
class MPMWallMotion {
 public:
  double shift[3], gradient[3][3], origin[3];
  double before[3];    ///< shift in the last step
  bool uniform;        ///< no gradient
  bool changes;        ///< may the velocity differ from that in the last step?

  /** Start of a step that follows this state: the wall is at rest. */
  void begin(const MPMWallState &);
  /** Turns by an angle about a unit axis through a center in the time dt. */
  void rotate(double angle, const double *axis, const double *center, double dt);
  /** For the total frame, whose nodes keep the positions X of the start: from now on, the velocity
   *  is a function of X. The state is that before this step, and becomes that after it. */
  void refer_to_start(MPMWallState &, double dt);
  /** The same motion as a function of the positions at the end of the step. */
  MPMWallMotion at_end_of_step(double dt) const;
  /** Notes the velocity at the end of the step. */
  void end(MPMWallState &) const;

  void velocity(const double *x, double *v) const;
  void velocity(const MPM_NS::Grid &, int64_t node, double *v) const;
  /** Half of the change of the velocity since the last step, for the work on a node. */
  void half_change(const MPM_NS::Grid &, int64_t node, double *v) const;
  /** Component d of the old velocity in a node record relative to the wall, but at most limit. */
  double old_relative(const double *record, int d, double limit) const;
  /** Present position of the material at X, where nodes of the total frame are. */
  void position(const double *X, double *x) const;

 private:
  double gradient_before[3][3], origin_before[3];    // at its end, see at_end_of_step()
  double turned[3][3], moved[3];    // nodes of the total frame at X are at X + turned X + moved
};

}    // namespace LAMMPS_NS

#endif
