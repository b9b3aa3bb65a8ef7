/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_NODE_STABILIZATION_H
#define LMP_MPM_NODE_STABILIZATION_H

#include "field/mpm_stencil.h"
#include "pointers.h"
#include "solve/bytes_of.h"

#include <functional>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Stiffness of nodes that points barely reach, for implicit steps.
 *
 *  A node at the very end of the functions of a point has loads of the order of its weight w, and a
 *  stiffness of the order of the square of the gradient of w. Next to the corner of a body, where w
 *  = a^2 b^2/4 with distances a and b, it moves in proportion to 1/(a^2 + b^2), some 1e5 node
 *  spacings, and turns the point that it belongs to. With the motion u of the nodes in the step and
 *  the linear motion around each point
 *      v_ip = sum_j N_jp u_j [1 + m r_jp . r_ip]
 *  (r: from nodes to points, in node spacings; m: inverse of their second moment) the node gets the
 *  energy
 *      sum_p c M_p V_p/(2 h^2) sum_i N_ip s_i |u_i - v_ip|^2
 *  Here M is the modulus of the point, and s is the amount, as a share, by which the volume of the
 *  node falls short of a tenth of that of the fullest node. Linear motions, and motions of nodes
 *  with enough points, have no such energy, and each step begins without any. */
class MPMNodeStabilization : protected Pointers {
 public:
  MPMNodeStabilization(class LAMMPS *lmp, MPMField &field);

  /** Start of a step. c: factor of the energy; moduli: M [n] of points. Collective. */
  void begin_step(double c, const std::vector<double> &moduli);
  /** Adds the forces after the motion u [node][dim]. As they are linear in u, these are also the
   *  change of the forces for a change u [mass acceleration]. Collective. */
  void add_forces(const double *u, double *force);
  /** Twice the energy of this rank's points after the motion of the last add_forces(). */
  double twice_energy() const { return energy; }
  /** Stiffness of nodes against their own motion while all others stand still, approximately
   *  [node]. */
  const std::vector<double> &diagonal() const { return stiffness; }
  /** Calls f(n, nodes [n], 1, g [n], c times unity [dim][dim]) for each term of the energy, as
   *  SplineMultigrid::add_point() needs it. A term c (g_i . u)^2/2 belongs to a node i that lacks
   *  points, as seen by one point, with g_ij = delta_ij - dv_ip/du_j. */
  void
  each_term(const std::function<void(int, const int64_t *, int, const double *, const double *)> &f)
      const;
  double memory_usage() const
  {
    return MPM_NS::bytes_of(points, nodes, reached, lacks, stiffness, motion, more, left);
  }

 private:
  /** A node as seen by a point: its index in vectors, N, N s, and r. */
  struct Node {
    int64_t first;
    double weight, lacking, r[3];
  };
  struct Point {
    std::size_t end;    // end of its range in nodes
    double k;           // c M V/h^2
  };
  MPMField &field;
  const int dim;
  std::vector<Point> points;    // points with any such node
  std::vector<Node> nodes;      // nodes of these points, one point after the other
  std::vector<double> lacks, stiffness, motion, more;
  std::vector<MPMStencil::Node> reached;
  std::vector<double> left;
  template <int DIM> void add_forces_of_points();
  double energy = 0.0;
};

}    // namespace LAMMPS_NS
#endif
