/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_OPTIONS_H
#define LMP_MPM_FLOW_OPTIONS_H

#include "declare/option.h"
#include "flow/mpm_flow_gas.h"
#include "flow/mpm_flow_lattice.h"
#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Keywords of fix mpm/incompressible. */
struct MPMIncompressibleOptions {
  enum Transfer { AUTO, APIC, FLIP, AFLIP, PIC };

  double h = 0.0, density = 0.0;
  double viscosity = 0.0;
  bool implicit = false;    ///< implicit viscosity
  double tension = 0.0;
  double angle = 90.0;    ///< contact angle between surfaces and walls [degrees]
  Transfer transfer = AUTO;
  bool transfer_is_given = false;
  double flip = 0.0;       ///< share of FLIP; with AUTO, the share in this step
  double reflect = 0.0;    ///< share of the change by the pressure that is applied again
  bool sharp = false;      ///< sharp paths of points, see find_paths()
  double spread = 0.5;     ///< share of an excess of points that spreads in a step
  double tolerance = 1.0e-9;
  enum Solver { MULTIGRID, FOURIER };
  int solver = MULTIGRID;    ///< preconditioner of the pressure
  int most_iterations = 10000;
  int64_t most_parts = 64;    ///< most parts of a step if implicit viscosity does not converge
  bool parts_are_given = false;
  MPMFlowWall walls[3][2];
  std::vector<std::string> region_ids;
  bool sticks = false;    ///< no slip at regions
  struct Liquid {
    std::string group;
    double density;
    double viscosity = -1.0;    ///< negative: that of all
  };
  std::vector<Liquid> liquids;    ///< groups of points with other densities and viscosities
  std::vector<std::string> solid_groups;
  bool has_gas = false;
  MPMFlowGasLaw gas_law;
  bool outside_is_given = false;
  bool open[3][2] = {};    ///< faces with open air next to them
  bool has_open = false;

  MPM_NS::Options declare(int dim);
  double viscosity_of(const Liquid &one) const
  {
    return one.viscosity < 0.0 ? viscosity : one.viscosity;
  }
  double largest_viscosity() const;
  bool has_several_viscosities() const;

 private:
  int axis = 0, side = 0;    // of the wall that is being read
  MPMFlowWall wall;
  bool wall_is_twice = false;
  std::string region_id;
  Liquid liquid;
  std::string solid_group;
  int open_face = 0;
};

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
  /** Number of the liquid of points in groups with these bits, that are no solids; -1: none. */
  int liquid(int mask) const;
  /** Density of such points. */
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
