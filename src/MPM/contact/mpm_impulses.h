/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_IMPULSES_H
#define LMP_MPM_IMPULSES_H

#include <vector>

namespace LAMMPS_NS {

/** A place where rigid body a meets body b, or an obstacle whose motion is known (b: -1). */
struct MPMTouch {
  int a, b;
  double ra[3], rb[3];       ///< of the place, from the centers of the bodies
  double n[3];               ///< unit normal, towards body a
  double moving[3];          ///< velocity of an obstacle with known motion
  double friction;           ///< coefficient; may be HUGE_VAL
  double least;              ///< smallest velocity of a relative to b along n after the impulse
  double impulse[3] = {};    ///< result, on body a [mass velocity]
};

/** Impulses between rigid bodies that meet at any number of places, with Coulomb friction:
 *
 *    w = v_a - v_b,   J_n >= 0,   w_n >= least,   J_n (w_n - least) = 0,
 *    |J_t| <= mu J_n, and where w_t is not zero, J_t = -mu J_n w_t/|w_t|
 *
 *  with the velocities w after all impulses (J.J. Moreau, Unilateral contact and dry friction in
 *  finite freedom dynamics (1988)). Solved place by place until nothing changes (projected
 *  Gauss-Seidel: M. Jean, Comput. Methods Appl. Mech. Eng. 177 (1999) 235). */
class MPMImpulses {
 public:
  struct Body {
    double u[6];    ///< velocity of the center, and angular velocity; solve() changes them
    double mobility[6][6];    ///< change of u by an impulse and its moment about the center
  };
  std::vector<Body> bodies;
  std::vector<MPMTouch> touches;

  /** Velocity of body a relative to b at the place. */
  void relative_velocity(const MPMTouch &, double *w) const;
  /** Finds the impulses, from zero, and the velocities after them. Places at which no impulse
   *  changes the velocity along the normal have none. */
  void solve();

 private:
  struct Frame {                      // of a touch
    double axis[3][3];                // n and two directions across
    double to_a[3][6], to_b[3][6];    // changes of u by impulses along these axes
    double yield[3];                  // changes of w along these axes by an impulse along them
  };
  std::vector<Frame> frames;

  void find_frame(const MPMTouch &, Frame &) const;
  double find_axis(const MPMTouch &, const double *axis, double *to_a, double *to_b) const;
  void push(const MPMTouch &, const Frame &, int axis, double size);
  double improve(MPMTouch &, const Frame &);
};

}    // namespace LAMMPS_NS
#endif
