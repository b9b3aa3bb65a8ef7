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

/** How long the collisions of grains last, with each other, with points, and with walls, from the
 *  stiffness that pair styles and walls of LAMMPS's package GRANULAR have. */
class MPMGrains : protected Pointers {
 public:
  /** The force of a contact as it depends on the overlap: k delta, or k sqrt(R) delta^1.5, in units of mass times
   *  acceleration. */
  struct Law {
    double k = 0.0;
    bool hertz = false;
    double damping = 0.0;    ///< force over the velocity of approach, and over what it goes by
    enum { BY_MASS, PLAIN, BY_MASS_AND_RADIUS, BY_STIFFNESS } damping_is = BY_MASS;
  };
  struct Collision {
    /** Infinite: none. With a point it is divided by the number of steps of the run in one of the points. */
    double duration;
    tagint i, j;    ///< j = 0: with a wall
  };

  /** An error if there is no pair style that tells its stiffness; who: the command in it. */
  MPMGrains(class LAMMPS *, const std::string &who);

  /** Of the pairs of this rank that touch, or that would within this time at their present speeds, and of each grain in
   *  the group of a wall with this wall, wherever it is, at its overlap and with all of its velocity; not of frozen ones.
   *  Points take one step in EVERY of the run; above 1, ghosts must have their volume, which tells that they are points.
   *  Collective: brings other values of ghosts up to date. */
  Collision shortest(double ahead, int every) const;

  /** Of two bodies with the reduced mass m, radius R, and the velocity v at an overlap. */
  static double duration(const Law &, double m, double R, double overlap, double v);

 private:
  struct Style {
    class Pair *pair;
    Law law;
    bool granular;    // each pair of types has a law of its own
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

}    // namespace LAMMPS_NS
#endif
