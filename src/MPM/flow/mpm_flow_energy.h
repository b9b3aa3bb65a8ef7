/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_ENERGY_H
#define LMP_MPM_FLOW_ENERGY_H

#include "lmptype.h"
#include <array>

namespace LAMMPS_NS {
struct MPMFlowParts;
struct MPMIncompressibleOptions;

/** Detects when numerical errors add energy to a flow: the kinetic energy of its points may grow by
 *  the work of the forces on them, and by no more. What work does not explain counts from its
 *  lowest value, so that losses do not hide what is added later. */
class MPMFlowEnergy {
 public:
  /** Sums over the points of this rank: kinetic energy after the last step, work of forces so far,
   *  and the energy in play at least, with forces of the last step; energies. */
  double kinetic = 0.0, work = 0.0, in_play = 0.0;
  /** only_forces_work() in the last step. */
  bool counts = false;

  /** Begins anew: points have other velocities. */
  void begin();
  /** Start of a step, with sums of the above over all ranks. npoints: if others come or go with
   *  their energy, the step before does not count, either. */
  void look(double all_kinetic, double all_work, double all_in_play, bigint npoints);
  /** Energy that work does not explain now, over the largest kinetic energy so far, or what is in
   *  play at least: a fluid at rest has the kinetic energy of round-off. */
  double gain() const { return most > 0.0 ? (last - least) / most : 0.0; }
  /** The largest gain() since the last call of this function, and the kinetic energy. */
  std::array<double, 2> largest_gain();

  static constexpr int NREAL = 8;
  /** State for restart files, with sums over all ranks. */
  std::array<double, NREAL> state(double all_kinetic, double all_work, double all_in_play) const;
  /** Takes this state; is_first: on the first rank. */
  void set_state(const double *from, bool is_first);

 private:
  double last = 0.0;                 // kinetic energy minus work, up to a constant
  double least = 0.0, most = 0.0;    // lowest of these, largest kinetic energy or in_play
  double largest = 0.0;              // gain
  bigint npoints = -1;               // -1: no step so far
};

/** Do walls, gas, bodies, and all else that is not a force on points leave the energy of the flow
 *  alone? */
bool only_forces_work(const MPMFlowParts &, const MPMIncompressibleOptions &);

}    // namespace LAMMPS_NS
#endif
