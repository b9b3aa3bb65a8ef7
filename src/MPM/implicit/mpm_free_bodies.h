/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FREE_BODIES_H
#define LMP_MPM_FREE_BODIES_H

#include "implicit/mpm_constraints.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Bodies of the first field that walls leave free along or around some axes, in statics: nodes
 *  that share points form bodies, and what walls take from a rigid motion of a body is zero if it
 *  is free.
 *
 *  Such a motion has no stiffness. There is no equilibrium if forces push the body that way, and
 *  otherwise any share of the motion is a solution: the one without it is chosen. What is left of
 *  the forces along it is round-off, which a solver would divide by its own. */
class MPMFreeBodies {
 public:
  explicit MPMFreeBodies(MPMSolvedNodes &);
  ~MPMFreeBodies();

  void clear();
  /** Finds them, in each step and where other nodes touch walls. Returns what is wrong if external
   *  forces [node][dim] push one along an axis along which it is free, or nothing. Collective. */
  std::string find(MPMConstraints &, MPM_NS::LatticeRanks &, const std::vector<double> &external);
  /** Takes off forces [node][dim], in proportion to masses, what moves bodies along free axes, and
   *  what turns them around free axes if it is round-off. Collective. */
  void balance(double *forces);
  /** Takes off displacements what moves bodies along free axes, and around them if balance() has
   *  done so. Collective. */
  void hold(double *displacements) const;

 private:
  struct Body;

  MPMSolvedNodes &nodes;
  std::vector<Body> bodies;
  std::vector<int> body;    // [node]; -1: none

  int rotations() const;
  void rigid_motions(const Body &, int64_t n, double (*motion)[3]) const;
  void find_places(int number);
  void find_deformations();
  void take_off(const std::vector<double> &power, int stride, bool by_mass, double *values) const;
  void find_free_motions(const std::vector<double> &products);
  void find_masses();
  template <class F> void each_owned(const F &f) const;
  std::string find_push(const std::vector<double> &external);
};

}    // namespace LAMMPS_NS
#endif
