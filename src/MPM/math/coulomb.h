/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATH_COULOMB_H
#define MPM_MATH_COULOMB_H

#include <algorithm>

namespace MPM_NS {

/** Coulomb's law of friction: a force t along two surfaces that press on each other with N >= 0 is
 *  at most mu N + c, with a larger coefficient up to which they stick. Forces may be impulses or
 *  tractions, as long as all of them are. */
struct CoulombFriction {
  double kinetic = 0.0;    ///< mu while the surfaces slide
  double still = 0.0;      ///< mu up to which they stick, not below kinetic

  /** Do they slide under the force t that would make them stick? */
  bool slides(double t, double N, double c = 0.0) const { return t > still * N + c; }

  /** Radial return to the cone: the share of t that friction bears. 1: they stick; 0: nothing can
   *  hold them, also where t is zero but for round-off. */
  double share(double t, double N, double c = 0.0) const
  {
    if (still * N + c == 0.0) return 0.0;
    return slides(t, N, c) ? (kinetic * N + c) / t : 1.0;
  }

  /** Distance from the cone of sliding friction, positive outside. */
  double excess(double t, double N) const { return t - kinetic * std::max(N, 0.0); }

  /** Friction per speed of sliding, which falls to zero with the speed below least (a
   *  regularization). */
  double drag(double speed, double N, double least) const
  {
    return kinetic * N / std::max(speed, least);
  }
};

}    // namespace MPM_NS
#endif
