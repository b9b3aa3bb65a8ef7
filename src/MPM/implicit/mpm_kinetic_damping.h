/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_KINETIC_DAMPING_H
#define LMP_MPM_KINETIC_DAMPING_H

#include <algorithm>
#include <limits>

namespace LAMMPS_NS {

/** Kinetic damping: finds from the kinetic energies of steps when velocities are to be set to zero,
 *  namely when the energy has passed a maximum.
 *
 *  A body that is released from a state out of equilibrium turns the energy that it has too much
 *  into motion. Where this is greatest it passes through equilibrium of its slowest mode; taking
 *  the motion away there takes that energy out, and what is left is that of the other modes. No
 *  coefficient has to be chosen, and where the energy does not fall nothing is done.
 *
 *  Velocities belong to the middle of steps. A mode of angular frequency omega that starts at u is
 *  at u cos((n + 1/2) theta)/cos(theta/2) n steps after a rest, with 2 sin(theta/2) = omega dt.
 *  Where its maximum is passed within three steps, that is for omega dt from 0.77 to 1.41, this is
 *  further away than it began, by up to a quarter each time, and the mode grows without end when no
 *  other one is left. From rest, however, forces have half a step to the middle of the next one
 *  only: where nodes get half of the change of their velocities there, the mode is at u cos(n
 *  theta). As that makes way more slowly, it is done once the energies at rests that come so soon
 *  have grown. */
struct MPMKineticDamping {
  double kinetic = 0.0;     ///< energy at the end of the last step
  double nrests = 0.0;      ///< number of times that velocities were set to zero
  double nsteps = 0.0;      ///< number of steps so far
  double rested = 0.0;      ///< value of nsteps at the last rest
  double interval = 0.0;    ///< steps between the last two rests
  double peak = 0.0;        ///< energy before it fell in this step; 0: it did not fall
  /** Smallest peak at rests that follow each other soon. */
  double least = std::numeric_limits<double>::infinity();
  double grows = 0.0;    ///< 1: these peaks have grown

  static constexpr double SOON = 3.0;       ///< steps between two rests
  static constexpr double GROWN = 100.0;    ///< ratio of peaks that counts as growth
  /** Least fall of the energy, relative to it: that of a body in free flight differs by
   *  round-off. */
  static constexpr double FALL = 1.0e-10;

  /** Is half of the change of velocities to be left out in the step that comes next, the first
   *  after a rest? */
  bool starts_by_half() const { return grows > 0.0 && kinetic == 0.0 && interval <= SOON; }
  /** The energy at the end of a step. Returns whether it has fallen, so that velocities are to be
   *  set to zero. */
  bool advance(double energy)
  {
    const bool falls = energy < (1.0 - FALL) * kinetic;
    peak = falls ? kinetic : 0.0;
    kinetic = energy;
    nsteps++;
    return falls;
  }
  /** Velocities were set to zero. */
  void rest()
  {
    kinetic = 0.0;
    nrests++;
    interval = nsteps - rested;
    rested = nsteps;
    if (interval > SOON || peak == 0.0) return;
    if (peak > GROWN * least) grows = 1.0;
    least = std::min(least, peak);
  }
};

}    // namespace LAMMPS_NS
#endif
