/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_VISCOSITIES_H
#define LMP_MPM_FLOW_VISCOSITIES_H

#include "flow/mpm_flow_lattice.h"

#include <vector>

namespace LAMMPS_NS {

/** Viscosities of a flow of several liquids, as shares of the largest one.
 *
 *  Stresses are in the middle of cells and at edges, and belong to boxes of one spacing around
 *  these places. A shear stress is the same on both sides of an interface that is normal to one of
 *  its two axes, and the shears add up: at edges, the viscosity is the harmonic mean over the
 *  volume of points in the box. A normal strain is the same on both sides, and the stresses add up:
 *  in cells, it is the arithmetic mean. Layers along the lattice lines thus have the velocities of
 *  theory, wherever their interface is in a cell. */
class MPMFlowViscosities {
 public:
  static constexpr int kinds(int dim)
  {
    return dim == 2 ? 2 : 4;
  }    ///< cells, and edges 01, 02, 12

  /** viscosity: of points that are in none of the liquids. */
  MPMFlowViscosities(const MPMFlowLattice &cells, double viscosity);
  /** Adds the liquid of the points with a bit of their group; a point in several has the last
   *  one. */
  void add(int bit, double viscosity);

  double largest() const { return most; }
  /** Finds the viscosities of cells and edges from the volumes of points. Collective. */
  void find(double *const *x, const double *volume, const int *mask);
  /** Viscosity in the middle of a cell over the largest one. */
  double in_cell(int64_t cell) const { return mean[cell * kinds(dim)]; }
  /** The same at the lower edge of a cell between the axes of a pair: 01, 02, 12. */
  double at_edge(int64_t cell, int pair) const { return mean[cell * kinds(dim) + 1 + pair]; }

  double memory_usage() const { return (sums.capacity() + mean.capacity()) * sizeof(double); }

 private:
  const MPMFlowLattice &cells;
  const int dim;
  double most;
  std::vector<int> bits = {0};
  std::vector<double> viscosities;
  std::vector<double>
      sums;    // [cell][kind][2] volume; volume times viscosity, or over it at edges
  std::vector<double> mean;    // [cell][kind]

  template <int d> void give(double *const *x, const double *volume, const int *mask);
};

}    // namespace LAMMPS_NS
#endif
