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

/** What a node sees of a body with a flat surface at a distance from it: the integral of its function over the
 *  body, and that over the surface. Exact for surfaces along axes; others differ a little, as the variance of the
 *  function is the same in all directions. Distances in node spacings. Of Bernstein polynomials, which have two kinds of
 *  nodes, it is that of the quadratic B-splines on these. */
class MPMNodeProfile {
 public:
  explicit MPMNodeProfile(const MPMField &);

  /** Volume of a node, as a share of that of a cell, at this depth in the body, negative outside of it. */
  double volume(double depth) const;
  /** The depth, from the volume over the area (of the body and its surface at the node, in cells). */
  double depth(double volume_by_area) const;
  /** The same from the volume. */
  double depth_of_volume(double volume) const;
  /** How deep below the surface the part of the body is, in the mean, that a node at this depth sees. */
  double mean_depth(double depth) const;
  /** Nodes as far from the surface as this see nothing of it. */
  double reach() const { return range; }

 private:
  static constexpr int STEPS = 128;    // in a node spacing
  double range;
  std::vector<double> volumes, ratios;    // at depths -range + k/STEPS, growing
  std::vector<double> means;              // depths of what is seen, at the same ones

  static double at(const std::vector<double> &, double place);
  double inverse(const std::vector<double> &, double value) const;
};

}    // namespace LAMMPS_NS
#endif
