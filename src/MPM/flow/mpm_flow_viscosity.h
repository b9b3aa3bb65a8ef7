/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_VISCOSITY_H
#define LMP_MPM_FLOW_VISCOSITY_H

#include "flow/mpm_flow_pressure.h"

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
  /** Number of places of viscosities: cells, and edges 01, 02, 12. */
  static constexpr int kinds(int dim) { return dim == 2 ? 2 : 4; }

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

  double memory_usage() const { return MPM_NS::bytes_of(sums, mean); }

 private:
  const MPMFlowLattice &cells;
  const int dim;
  double most;
  std::vector<int> bits = {0};
  std::vector<double> viscosities;
  // [cell][kind][2] volume; volume times viscosity, or over it at edges
  std::vector<double> sums;
  std::vector<double> mean;    // [cell][kind]

  template <int d> void give(double *const *x, const double *volume, const int *mask);
};

/** Stress of a viscous fluid on a staggered lattice, 2 mu times the rate of strain. Normal stresses
 *  are at the middle of cells, shear stresses at edges. The stress is zero in dry cells, and at
 *  edges that touch two or more of them, because a free surface has no traction. The volume that
 *  the stress acts on reaches up to the surface, as for the pressure. */
class MPMFlowViscosity {
 public:
  MPMFlowViscosity(const MPMFlowLattice &cells, const MPMFlowPressure &water) :
      cells(cells), water(water)
  {
  }

  /** Half of the largest stable time step for the kinematic viscosity nu. */
  static double stable_dt(double nu, double h, int dim) { return h * h / (4.0 * dim * nu); }

  /** Viscosities of several liquids; null: there is one. */
  const MPMFlowViscosities *viscosities = nullptr;

  /** sum += factor div(2 D) in owned cells. factor: time step times kinematic viscosity, of several
   *  liquids the largest viscosity over the density in psi. velocity: [cell][dim], complete. */
  void add(double factor, const std::vector<double> &velocity, std::vector<double> &sum) const;

 private:
  const MPMFlowLattice &cells;
  const MPMFlowPressure &water;

  template <bool several>
  void add(double factor, const std::vector<double> &velocity, std::vector<double> &sum) const;
};

}    // namespace LAMMPS_NS
#endif
