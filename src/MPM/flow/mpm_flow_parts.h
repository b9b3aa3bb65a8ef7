/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_PARTS_H
#define LMP_MPM_FLOW_PARTS_H

#include "flow/mpm_flow_bodies.h"
#include "flow/mpm_flow_gas.h"
#include "flow/mpm_flow_grains.h"
#include "flow/mpm_flow_inflow.h"
#include "flow/mpm_flow_lattice.h"
#include "flow/mpm_flow_options.h"
#include "flow/mpm_flow_pressure.h"
#include "flow/mpm_flow_regions.h"
#include "flow/mpm_flow_solids.h"
#include "flow/mpm_flow_stick.h"
#include "flow/mpm_flow_stress.h"
#include "flow/mpm_flow_tension.h"
#include "flow/mpm_flow_viscosity.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Values of a flow on its lattice, in the course of a step. */
struct MPMFlowFields {
  /** [cell][3 dim + 1] momentum, mass, and force that points give to faces, and their volume in
   *  cells. */
  std::vector<double> sums;
  std::vector<double> filled;       ///< [cell] share of its open surroundings that points fill
  std::vector<double> predicted;    ///< [cell][dim] velocities without the pressure
  std::vector<double> initial;      ///< [cell][dim] velocities before forces and pressure
  /** [cell][dim] velocities that points have been given, as if there were no walls; in the first
   *  step with them. */
  std::vector<double> start;
  std::vector<double> velocity;     ///< [cell][dim] velocities at the end of the step
  std::vector<double> known;        ///< [cell][dim] 1 where there is a velocity, else 0
  std::vector<double> change;       ///< [cell][dim] change of velocities that points get once more
  std::vector<double> pressures;    ///< [cell]
  std::vector<double> shift;        ///< [cell][dim] displacements by which points spread
  std::vector<double> paths;        ///< [cell][dim] velocities with which points move, if sharp
  /** [cell][dim] density of the flow over that of faces, see MPMFlowPressure; with several
   *  densities. */
  std::vector<double> inverse_density;
  std::vector<double> face_volumes;    ///< [cell][2 dim] volumes of points at faces
  std::vector<double> solid_forces;    ///< [cell][dim] forces of solids

  double memory_usage() const;
};

/** Results of a step. Those of parts of the box are the shares of this rank. */
struct MPMFlowResults {
  double iterations = 0.0;            ///< of the pressure, most of a solve
  double viscous_iterations = 0.0;    ///< of the implicit viscosity
  double residual = 0.0;              ///< what is left of the divergence, relative
  double divergence = 0.0;            ///< largest |div v|, of this rank
  double wet = 0.0;                   ///< number of wet cells, of this rank
  double filled = 0.0;                ///< volume that points fill, of this rank
  double parts = 0.0;                 ///< into which the step was divided
  double halvings = 0.0;              ///< of steps and their parts so far
  double walls[3][2] = {};            ///< forces on walls of the box, of this rank
  std::vector<double> regions;        ///< [3 regions] forces on regions, of this rank
};

/** The parts of a flow. Null: the flow has no such part. */
struct MPMFlowParts {
  MPMFlowLattice cells;
  std::unique_ptr<MPMFlowPressure> pressure;
  std::unique_ptr<MPMFlowAir> air;
  std::unique_ptr<MPMFlowViscosity> viscosity;        ///< explicit
  std::unique_ptr<MPMFlowStress> stress;              ///< implicit viscosity
  std::unique_ptr<MPMFlowViscosities> viscosities;    ///< of several liquids
  std::unique_ptr<MPMFlowTension> tension;            ///< surface tension
  std::unique_ptr<MPMFlowRegions> regions;
  std::unique_ptr<MPMFlowStick> stick;      ///< regions without slip
  std::unique_ptr<MPMFlowBodies> bodies;    ///< rigid bodies of regions
  std::unique_ptr<MPMFlowGrains> grains;    ///< of fix mpm/immersed
  std::unique_ptr<MPMFlowInflow> inflow;    ///< of fix mpm/emit
  std::unique_ptr<MPMFlowSolids> solids;
  std::unique_ptr<MPMFlowGas> gas;    ///< in pockets
  std::unique_ptr<MPMFlowGasRows> gas_rows;

  /** Makes the parts that the options ask for, except those of other fixes. groupbit: of the
   *  points. */
  MPMFlowParts(class LAMMPS *, const MPMIncompressibleOptions &, MPMFlowLiquids &,
               const MPMFlowFields &, int groupbit);
  /** Start of a run: bodies, grains, and inflow of other fixes. Stops with an error if parts do not
   *  go together. groupbit, id: of the fix of this flow. mobility: of faces, if there is inflow. */
  void init(class LAMMPS *, const MPMIncompressibleOptions &, int groupbit, const std::string &id,
            const std::vector<double> &mobility);
  double memory_usage() const;

 private:
  void check_walls(class LAMMPS *, const MPMIncompressibleOptions &) const;
  void add_solids(class LAMMPS *, const MPMIncompressibleOptions &);
  void add_gas(class LAMMPS *, const MPMIncompressibleOptions &);
  void init_bodies(class LAMMPS *, const MPMIncompressibleOptions &, const std::string &who);
};

}    // namespace LAMMPS_NS
#endif
