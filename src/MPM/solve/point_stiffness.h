/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_POINT_STIFFNESS_H
#define MPM_SOLVE_POINT_STIFFNESS_H

#include "solve/fine_smoother.h"
#include "solve/spline_transfer.h"

#include <vector>

namespace MPM_NS {

/** Adds the stiffness of points to the blocks of the first coarse level, as a Galerkin operator of
 *  that level, and to those of the rim of the finest one. */
class PointStiffness {
 public:
  PointStiffness(const NodeConstraints &constraints, const SplineTransfer &transfer,
                 FineSmoother &smoother) :
      constraints(constraints),
      transfer(transfer), smoother(smoother), width(constraints.width)
  {
  }
  /** To be called when the transfer knows its nodes. */
  void setup() { place.assign(transfer.mine.index.size(), -1); }

  BlockList blocks;    ///< of the level, of the part of this rank
  MeanTerms means;     ///< of nodes of this part

  /** See SplineMultigrid. */
  void add_point(int n, const int64_t *nodes, int ngrad, const double *gradient,
                 const double *stiffness);
  void add_mean(int64_t around, int kind, const double sums[3], int n, const int64_t *nodes,
                const double *changes);
  /** Each node on the rank that owns it. */
  void add_masses(const double *mass);
  /** Adds to the blocks what has been kept of points with the same nodes. */
  void flush();
  double memory_usage() const;

 private:
  const NodeConstraints &constraints;
  const SplineTransfer &transfer;
  FineSmoother &smoother;
  const int width;
  // points with the same nodes: these, those of the level, and the place of each in that list
  std::vector<int64_t> current;
  std::vector<int> local, place;
  std::vector<double> element, G, KP;
  std::vector<int> rim_local;    // those of the nodes that are in the rim
  std::vector<double> rim_element;
  bool held = false;    // has a node a constraint?

  void start(int n, const int64_t *nodes);
  template <int W>
  void project(const std::vector<int64_t> &of, const ConstrainedParts &, std::vector<int> &number,
               std::vector<double> &K);
};

}    // namespace MPM_NS
#endif
