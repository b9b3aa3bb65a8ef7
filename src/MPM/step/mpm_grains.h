/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_GRAINS_H
#define LMP_MPM_GRAINS_H

#include "lmptype.h"
#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Durations of the collisions of grains with each other, with points, and with walls, from the
 *  stiffness of pair styles and walls of the package GRANULAR of LAMMPS. */
class MPMGrains : protected Pointers {
 public:
  /** Contact force as a function of the overlap delta: k delta, or k sqrt(R) delta^1.5 (hertz), in
   *  units of mass times acceleration. */
  struct Law {
    double k = 0.0;
    bool hertz = false;
    /** Force over the product of the velocity of approach and the quantity of damping_is. */
    double damping = 0.0;
    enum { BY_MASS, PLAIN, BY_MASS_AND_RADIUS, BY_STIFFNESS } damping_is = BY_MASS;
  };
  struct Collision {
    /** Infinite: no collision. For a collision with a point, divided by the number of steps of the
     *  run per step of the points. */
    double duration;
    tagint i, j;    ///< j = 0: collision with a wall
  };

  /** Stops with an error if no pair style provides its stiffness. who: the command in the
   *  message. */
  MPMGrains(class LAMMPS *, const std::string &who);

  /** Shortest collision on this rank. It considers pairs that touch, or that would touch within the
   *  time ahead at their present speeds, and each grain in the group of a wall with this wall,
   *  wherever the grain is, at its overlap and with its full velocity. Frozen grains are left out.
   *  Points take one step in EVERY of the run; above 1, ghosts must have their volume, by which
   *  they are recognized as points. Collective: updates other values of ghosts. */
  Collision shortest(double ahead, int every) const;

  /** Duration of the collision of two bodies with the reduced mass m, the reduced radius R, and the
   *  velocity v at an overlap. */
  static double duration(const Law &, double m, double R, double overlap, double v);

 private:
  struct Style {
    class Pair *pair;
    Law law;
    bool granular;    // each pair of types has its own law
  };
  std::vector<Style> styles;
  std::string who;

  Law in_units(Law) const;
  int frozen_groups() const;
  Law law_of(const Style &, int itype, int jtype) const;
  Law law_of_model(void *model) const;
  void pairs_of(const Style &, double ahead, int every, Collision &) const;
  void walls(int every, Collision &) const;
};

/** Warns if a pair style of grains acts between material points of the group that touch now. Called
 *  after neighbor lists were made. */
void warn_of_points_as_grains(LAMMPS *lmp, int groupbit, const std::string &who);

}    // namespace LAMMPS_NS
#endif
