/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_AIR_H
#define LMP_MPM_FLOW_AIR_H

#include "flow/mpm_flow_lattice.h"

#include <vector>

namespace LAMMPS_NS {

/** Extends the velocities of the water to faces in the air that points near the surface reach:
 *  layer by layer, as means of the known velocities around. */
class MPMFlowAir {
 public:
  /** Layers of faces that a point just below the surface reaches, also from its place after half a
   *  step. */
  static constexpr int LAYERS = 3;

  explicit MPMFlowAir(const MPMFlowLattice &cells) : cells(cells) {}

  /** velocity, known (1 or 0): [cell][dim], of owned cells before and of all cells afterwards.
   *  Collective. */
  void extend(std::vector<double> &velocity, std::vector<double> &known);
  double memory_usage() const
  {
    return all.capacity() * sizeof(double) + unknown.capacity() * sizeof(Face) +
        found.capacity() * sizeof(Found);
  }

 private:
  struct Face {
    int cell, axis;    // cell: place in the list of cells
  };
  struct Found {
    int64_t place;    // in the array all
    double value;
  };
  const MPMFlowLattice &cells;
  std::vector<double> all;
  std::vector<Face> unknown;
  std::vector<Found> found;
};

}    // namespace LAMMPS_NS
#endif
