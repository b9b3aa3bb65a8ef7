/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CUT_DOMAINS_H
#define LMP_MPM_CUT_DOMAINS_H

#include "field/mpm_point_map.h"

#include <functional>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** The parts in each cell of the domains of points (boxes of their volume around them) that are
 *  divided by sides of cells. For Bernstein polynomials, whose gradients jump at these sides. Sums
 *  of gradients over parts are integrals wherever the points are; with gradients at the points
 *  instead, sums depend on how many points are in a cell. */
class MPMCutDomains {
 public:
  static constexpr int NODES = 3;    ///< along an axis
  struct Part {
    int point;
    double volume;    ///< share of the volume of the point
    double share;     ///< free for use by the caller
    /** Functions and their derivatives along each axis in the middle of the part. */
    double w[3][NODES], slope[3][NODES];
    int node[NODES * NODES * NODES];    ///< in 2d the first NODES^2
  };

  explicit MPMCutDomains(MPMField &field) : field(field) {}

  /** Finds the parts of the points in wanted runs, in cells of which this rank has all nodes. */
  void find(const std::function<bool(const MPMPointMap::Run &)> &wanted);
  std::vector<Part> parts;
  bool any() const { return !parts.empty(); }
  /** [n] Is the domain of a point divided into parts? */
  std::vector<char> is_cut;
  /** The domain of a point that is not cut, as one part; false if this rank does not have all of
   *  its nodes. */
  bool make_whole(int point, const MPMPointMap::Run &, Part &) const;

  /** Calls f(node, gradient[3] of its function in the middle of the part). */
  template <class F> void each_node(const Part &part, const F &f) const
  {
    int n = 0;
    const int last = dim() == 3 ? NODES : 1;
    for (int i = 0; i < NODES; i++)
      for (int j = 0; j < NODES; j++)
        for (int k = 0; k < last; k++) {
          const double gradient[3] = {part.slope[0][i] * part.w[1][j] * part.w[2][k],
                                      part.w[0][i] * part.slope[1][j] * part.w[2][k],
                                      part.w[0][i] * part.w[1][j] * part.slope[2][k]};
          f(part.node[n++], gradient);
        }
  }
  /** Gradient of values at nodes in the middle of the part. */
  void gradient(const Part &, const std::vector<double> &values, double g[3]) const;
  /** Adds q[3] . grad N to the values of the nodes of the part. */
  void add(const Part &, const double *q, std::vector<double> &nodes) const;

  double memory_usage() const { return parts.capacity() * sizeof(Part) + is_cut.capacity(); }

 private:
  MPMField &field;

  int dim() const;
  bool set_nodes(const double *middle, int slot, Part &) const;
};

}    // namespace LAMMPS_NS
#endif
