/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CUT_ROOMS_H
#define LMP_MPM_CUT_ROOMS_H

#include "mpm_point_map.h"

#include <functional>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Rooms of points (boxes of their volume around them) that sides of cells divide, with Bernstein polynomials, whose gradients jump
 *  there: the parts in each cell. Sums of gradients over points that fill space are those of parts, which are integrals wherever
 *  points are; with the gradients where the points are, they depend on how many of these are in a cell. */
class MPMCutRooms {
 public:
  static constexpr int NODES = 3;    ///< along an axis
  struct Part {
    int point;
    double volume;    ///< share of that of the point
    double share;     ///< for the user
    double w[3][NODES], slope[3][NODES];
    int node[NODES * NODES * NODES];
  };

  explicit MPMCutRooms(MPMField &field) : field(field) {}

  /** Parts in cells all of whose nodes this rank has, of the points of wanted runs. */
  void find(const std::function<bool(const MPMPointMap::Run &)> &wanted);
  std::vector<Part> parts;
  bool any() const { return !parts.empty(); }
  /** [n] A point that is in parts. */
  std::vector<char> is_cut;
  /** The room of a point that is not cut, as one part; false if this rank does not have all of its nodes. */
  bool make_whole(int point, const MPMPointMap::Run &, Part &) const;

  /** Calls f(node, gradient of its function in the middle of the part). */
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
  void gradient(const Part &, const std::vector<double> &values, double g[3]) const;
  /** Adds q . grad N to the nodes. */
  void add(const Part &, const double *q, std::vector<double> &nodes) const;

  double memory_usage() const { return parts.capacity() * sizeof(Part) + is_cut.capacity(); }

 private:
  MPMField &field;

  int dim() const;
  bool set_nodes(const double *middle, int slot, Part &) const;
};

}    // namespace LAMMPS_NS
#endif
