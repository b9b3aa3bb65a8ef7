/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_LIQUIDS_H
#define LMP_MPM_FLOW_LIQUIDS_H

#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {
struct MPMIncompressibleOptions;

/** Densities and viscosities of the liquids of a flow, by groups of points. */
class MPMFlowLiquids : protected Pointers {
 public:
  std::vector<int> bits;       ///< of the groups of keyword liquid
  double largest_viscosity;    ///< dynamic viscosity
  /** Relative difference of densities that counts as none. */
  static constexpr double SAME_DENSITY = 1.0e-9;

  double least_density;          ///< also of solids, once these are known
  bool has_several_densities;    ///< also of solids, once these are known

  MPMFlowLiquids(class LAMMPS *, const MPMIncompressibleOptions &);
  /** Finds the groups. Stops with an error if one does not exist. */
  void find_groups();
  /** Density of points in groups with these bits, that are no solids. */
  double density(int mask) const;
  /** Largest kinematic viscosity [length^2/time], which limits explicit steps. */
  double largest_kinematic_viscosity() const;
  /** Factor from a stress to an acceleration times a length, with the density of the flow. */
  double acceleration_per_stress() const;

 private:
  const MPMIncompressibleOptions &options;
};

}    // namespace LAMMPS_NS
#endif
