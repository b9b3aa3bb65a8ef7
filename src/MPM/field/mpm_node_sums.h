/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_NODE_SUMS_H
#define LMP_MPM_NODE_SUMS_H

// Sums over the points of a field that others than its step need: contact, surfaces, couplings.

#include <functional>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

enum class Weight { MASS, VOLUME };
/** Finds sum_p w_p grad N(x_p), [node][3], at the nodes of blocks that are marked in near (and at
 *  others), with the mass or volume w of the points. */
void map_gradient(MPMField &, Weight, const std::vector<char> &near, std::vector<double> &gradient);
/** The same for volumes, always with the gradients of the functions, even if stress is an affine
 *  term of the transfer and uses other gradients. */
void map_surface(MPMField &, const std::vector<char> &near, std::vector<double> &gradient);
/** Finds, at the same nodes, the forces [node][3] of points whose stress and external force are set
 *  by give(i, tau, f). tau: [6] J times the stress; f: [3]; both in units of a force over
 *  nktv2p. */
void map_forces(MPMField &, const std::vector<char> &near,
                const std::function<void(int i, double *tau, double *f)> &give,
                std::vector<double> &force);
/** Finds, at the same nodes, sum_p V_p N(x_p) as a share of the volume of a cell, [node]. */
void map_volume(MPMField &, const std::vector<char> &near, std::vector<double> &share);
/** Finds the gradients and shares for points of several fields with the functions of the lattice of
 *  this one, as if each point was a box (a square in 2d) with its volume: sums over points that
 *  fill space are then exact for any size of points. Nodes that boxes reach must be active. Updated
 *  frame and B-splines only. */
void map_boxes(MPMField &, const std::vector<MPMField *> &of, Weight, const std::vector<char> &near,
               std::vector<double> &gradient, std::vector<double> &share);
/** Finds this share at the points, [n]: it is 1 inside of a body and falls to 0 across its surface.
 *  Points that have failed do not count as volume. A body on a fixed face of the box has no surface
 *  there (updated frame, faces in planes of nodes). Finds the blocks if necessary. */
void volume_at_points(MPMField &, std::vector<double> &share);

/** Calls f(point, wanted[node], weight, r) for each point and each node that it reaches with
 *  wanted[node] >= 0. wanted: [node]; r: from the node to the point, in node spacings. */
void visit_points(const MPMField &, const std::vector<int> &wanted,
                  const std::function<void(int, int, double, const double *)> &f);

}    // namespace LAMMPS_NS
#endif
