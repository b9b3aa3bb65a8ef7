/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_NODE_PROFILE_H
#define LMP_MPM_NODE_PROFILE_H

#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Integrals of the function of a node over a body with a flat surface, and over this surface, by
 *  the distance of the node from the surface. Exact for surfaces normal to axes; other surfaces
 *  differ little, because the variance of the function is the same in all directions. Distances are
 *  in node spacings. Bernstein polynomials have two kinds of nodes; their profile is that of
 *  quadratic B-splines on the same nodes. */
class MPMNodeProfile {
 public:
  explicit MPMNodeProfile(const MPMField &);

  /** Volume of a node, as a share of the volume of a cell, at this depth in the body; the depth is
   *  negative outside. */
  double volume(double depth) const { return at(volumes, (depth + range) * STEPS); }
  /** Depth from the ratio of volume to area (of the body and of its surface at the node, in
   *  cells). */
  double depth(double volume_by_area) const { return inverse(ratios, volume_by_area); }
  /** Depth from the volume. */
  double depth_of_volume(double volume) const { return inverse(volumes, volume); }
  /** Mean depth below the surface of the part of the body within the function of a node at this
   *  depth. */
  double mean_depth(double depth) const;
  /** Distance from the surface at which nodes no longer reach it. */
  double reach() const { return range; }

 private:
  static constexpr int STEPS = 128;    // steps per node spacing
  double range;
  std::vector<double> volumes, ratios;    // at depths -range + k/STEPS, growing
  std::vector<double> means;              // mean depths, at the same places

  static double at(const std::vector<double> &, double place);
  double inverse(const std::vector<double> &, double value) const;
};

}    // namespace LAMMPS_NS
#endif
