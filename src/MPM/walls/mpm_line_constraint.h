/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_LINE_CONSTRAINT_H
#define LMP_MPM_LINE_CONSTRAINT_H

#include "field/node_line.h"

#include <cstdint>

namespace LAMMPS_NS {
class MPMField;
class MPMWall;

/** The constraint that material has the velocity of a wall where the wall cuts a line of nodes, on
 *  the nodes of the line that have mass, from the outside of the material to the inside. */
class MPMLineConstraint {
 public:
  static constexpr int MOST = NodeLine::MOST;

  int n = 0;    ///< number of nodes; zero: there is no constraint
  int64_t node[MOST];
  const double *record[MOST];
  /** Velocities of the wall at the nodes. */
  double V[MOST][3];
  /** Coefficients of the velocities, and their sum. */
  double A[MOST], total = 0.0;
  /** Coefficients of their curvature, see is_straight(). */
  double B[MOST] = {0.0, 0.0, 0.0, 0.0};

  /** The nodes, from the first one on, and their weights that make the velocity at the place x
   *  along an axis; returns their number. inward: direction into the material, 1 or -1. */
  static int weights_at(const MPMField &, int axis, int inward, double x, int &first,
                        double *weight);

  /** Finds the constraint on a line whose nodes are in the order along the axis. inward: 1 if the
   *  material is behind the last one, else -1. Nodes with no more than the least mass count as
   *  empty. Returns false where no point reaches the wall. */
  bool find(const MPMWall &, MPMField &, const NodeLine &, int inward, double least = 0.0);
  /** Must the velocities of the nodes also be without curvature? */
  bool is_straight() const { return straight; }
  /** Finds the change of velocities of least kinetic energy for velocities relative to the wall.
   *  Returns the multiplier of A, so that the impulse is total times it. */
  double solve(const double *relative, double *change) const;
  /** Bound of old velocities that count as consistent with the wall, from these velocities of the
   *  nodes relative to it: that of the first node inside, as far as it has mass. */
  double limit_of_old(const double *relative) const;
  /** How much a node counts that may have the mass of round-off next to a heavy one: from 0 to 1,
   *  continuously. */
  static double part_of_light(double mass, double heavy);

 private:
  int inner = 0;                           // index of the first node inside
  bool straight = false;                   // B is used
  double inverse[MOST], heaviest = 0.0;    // inverse masses, 1 for the heaviest node
  double AA = 0.0, det = 0.0;

  void prepare(bool all);
  double D(int j, int k) const { return A[j] * B[k] - A[k] * B[j]; }
};

}    // namespace LAMMPS_NS

#endif
