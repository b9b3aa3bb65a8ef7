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
/** At the nodes of blocks that are marked in near (and others): sum_p w_p grad N(x_p) with the mass or
 *  volume w of the points, [node][3]. */
void map_gradient(MPMField &, Weight, const std::vector<char> &near, std::vector<double> &gradient);
/** The same of volumes with the gradients of the functions, also where stress is an affine term of the transfer
 *  and so takes other ones. */
void map_surface(MPMField &, const std::vector<char> &near, std::vector<double> &gradient);
/** At the same nodes: forces [node][3] of points whose stress and external force are those that give(i, tau, f) sets;
 *  tau: [6] J times the stress, f: [3], both in the units of a force over nktv2p. */
void map_forces(MPMField &, const std::vector<char> &near,
                const std::function<void(int i, double *tau, double *f)> &give,
                std::vector<double> &force);
/** At the same nodes: sum_p V_p N(x_p) as share of the volume of a cell, [node]. */
void map_volume(MPMField &, const std::vector<char> &near, std::vector<double> &share);
/** The gradients and shares of points of several fields with the functions of this one's lattice, as if each point was a box (a square in
 *  2d) with its volume: sums over points that fill space are exact whatever their sizes. Nodes that boxes reach must be active. Updated
 *  frame, B-splines. */
void map_boxes(MPMField &, const std::vector<MPMField *> &of, Weight, const std::vector<char> &near,
               std::vector<double> &gradient, std::vector<double> &share);
/** At the points, [n]: that share, which is 1 inside of a body and falls to 0 across its surface. Points
 *  that have failed do not count as volume. A body on a fixed face of the box has no surface there
 *  (updated frame, faces in planes of nodes). Finds the blocks if need be. */
void volume_at_points(MPMField &, std::vector<double> &share);

/** Calls f(point, wanted[node], weight, r) for each point and each node that it reaches where wanted is
 *  not negative (wanted: [node]; r: from the node to the point, in node spacings). */
void visit_points(const MPMField &, const std::vector<int> &wanted,
                  const std::function<void(int, int, double, const double *)> &f);

}    // namespace LAMMPS_NS
#endif
