/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_NEWTON_H
#define LMP_MPM_NEWTON_H

#include "implicit/mpm_implicit_parts.h"
#include "solve/krylov.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMCoupledPressure;
class MPMMotionSystem;

/** Newton's method for the displacements u of an implicit step,
 *      P^T r(u) = 0,   u = P u + dt w
 *  with the residual r of MPMForceBalance, and P and w of MPMConstraints. It has the line search,
 *  updates of the active set of contacts, and a division of the step into parts where it does not
 *  converge at once. */
class MPMNewton : private MPMImplicitParts {
 public:
  enum Outcome { CONVERGED, FAILED, HOPELESS };    ///< HOPELESS: parts of the step would fail, too

  MPMNewton(const MPMImplicitParts &parts, MPMMotionSystem &system) :
      MPMImplicitParts(parts), system(system)
  {
  }

  /** Start of a step of duration dt. pressure: that of nodes, which is found together with u; null:
   *  none. */
  void begin_step(double dt, MPMCoupledPressure *pressure);
  /** Finds bodies that walls leave free, in statics. Returns what is wrong, or nothing.
   *  Collective. */
  std::string find_free_bodies();
  /** Iterates from u to the balance of forces. Collective. */
  Outcome iterate(std::vector<double> &u, int most_iterations);
  /** The same in as few parts of the step as possible; the report has the result. Collective. */
  void solve_in_parts(std::vector<double> &u);

  /** Finds the residual after the motion u, and without reactions in free_forces(). size: sum of
   *  the sizes of all forces. along: product of the free forces with the given vector, if there is
   *  one. False, on all ranks, where points are inside out or anything is not finite.
   *  Collective. */
  bool find_residual(const std::vector<double> &u, double &size,
                     const std::vector<double> *vector = nullptr, double *along = nullptr);
  /** u <- u + s du with du in change() and the largest s that is not too far. False if there is
   *  none. Collective. */
  bool line_search(std::vector<double> &u, double &size);

  /** r, [node][dim]. */
  const std::vector<double> &residual() const { return unbalanced; }
  /** P^T r, with friction. */
  const std::vector<double> &free_forces() const { return free; }
  /** Correction du that is to be made next. */
  std::vector<double> &change() { return du; }
  /** Correction of the last line search, and its share s. */
  const std::vector<double> &last_correction() const { return correction; }
  double last_share() const { return share; }
  double memory_usage() const
  {
    return MPM_NS::bytes_of(unbalanced, free, du, correction, trial, prescribed, inertia_forces);
  }

 private:
  MPMMotionSystem &system;
  MPMCoupledPressure *pressure = nullptr;

  double dt = 0.0;
  double reached_by_walls = 0.0, aim = 1.0;    // statics: shares of wall motion in this step
  double share = 0.0;
  std::vector<double> unbalanced, free, du, correction, trial, inertia_forces;
  std::vector<double> prescribed;    // displacements that walls will make

  /** State of the iterations. */
  struct Progress {
    int most, before;       // iterations allowed, and those made before
    double size = 0.0;      // of all forces
    double enough = 0.0;    // residual that may be left
    double left = 0.0;      // residual
    double last = 0.0;      // the same in the iteration before; 0: none
    double first = 0.0;     // unbalanced forces when walls have moved, and it is known what touches
    double accuracy = 0.0;      // of linear solutions
    double stiffness = 0.0;     // of the tangents
    double softness = 0.0;      // width of the slip of friction that is still soft; 0: none is
    int slow = 0;               // iterations with next to no gain since the active set has changed
    bool closes = false;        // are walls far from what they hold?
    bool wall_moves = false;    // is there a prescribed displacement?
  };

  Outcome fail(const char *why, Outcome outcome = FAILED);
  void soften_friction(Progress &);
  bool harden_friction(const std::vector<double> &u, Progress &);
  enum Contact { UNCHANGED, CHANGED, BALANCED, INSIDE_OUT };
  Contact update_contact(std::vector<double> &u, Progress &);
  void choose_accuracy(Progress &) const;
  void add_prescribed_forces();
  MPM_NS::SolveReport find_correction(const std::vector<double> &u, Progress &);
  bool make_correction(std::vector<double> &u, Progress &);
  bool close_gaps(std::vector<double> &u, double &size, double &reached);
  bool search_jointly(std::vector<double> &u, double &size);
};

}    // namespace LAMMPS_NS
#endif
