/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/incompressible,FixMPMIncompressible);
// clang-format on
#else

#ifndef LMP_FIX_MPM_INCOMPRESSIBLE_H
#define LMP_FIX_MPM_INCOMPRESSIBLE_H

#include "base/mpm_state.h"
#include "base/mpm_step_limit.h"
#include "declare/option.h"
#include "field/mpm_fluid.h"
#include "field/mpm_point_batches.h"
#include "flow/mpm_flow_gas.h"
#include "flow/mpm_flow_lattice.h"
#include "solve/krylov.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMFlowAir;
class MPMFlowBodies;
class MPMFlowGasRows;
class MPMFlowGrains;
class MPMFlowInflow;
class MPMFlowPressure;
class MPMFlowRegions;
class MPMFlowSolids;
class MPMFlowStick;
class MPMFlowStress;
class MPMFlowTension;
class MPMFlowViscosities;
class MPMFlowViscosity;
struct MPMFlowPoints;

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

/** Flow of an incompressible fluid with free surfaces: material points and a staggered lattice of its own, with a
 *  pressure that makes the velocities divergence-free. */
class FixMPMIncompressible :
    public FixMPMState,
    public MPMStepLimit,
    public MPMFluid,
    public MPMPointOwner,
    private MPMIncompressibleOptions {
 public:
  FixMPMIncompressible(class LAMMPS *, int, char **);
  ~FixMPMIncompressible() override;
  int setmask() override;
  void init() override;
  void setup_pre_exchange() override;
  void setup_pre_neighbor() override;
  void setup(int) override;
  void initial_integrate(int) override;
  void pre_neighbor() override;
  void setup_pre_force(int) override;
  void pre_force(int) override;
  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;
  void write_restart(FILE *) override;
  void restart(char *) override;

  /** Stable time step of this rank: the time in which a point passes one node spacing with its present velocity and
   *  acceleration, or a moving region or wall passes one, or the limit of explicit viscosity, of solids, or of surface
   *  tension. tag: of the limiting point; 0: another limit. */
  double stable_dt(tagint &tag) const override;
  double spacing_around(const std::string &region) const override;
  double spacing() const override { return h; }
  void visit_batches(int group_bits, const BatchVisitor &) override;
  MPMFlowSolids *solids_of() const { return solids.get(); }    ///< null: none
  double density_of_groups(int mask) const override;
  void check_density(double of_fluid, const std::string &who) const override;

 private:
  MPMFlowLattice cells;
  std::unique_ptr<MPMFlowPressure> pressure;
  std::unique_ptr<MPMFlowAir> air;
  std::unique_ptr<MPMFlowViscosity> viscous;          // explicit; null: none
  std::unique_ptr<MPMFlowStress> stress;              // implicit viscosity; null: none
  std::unique_ptr<MPMFlowViscosities> viscosities;    // of several liquids; null: there is one
  std::unique_ptr<MPMFlowTension> curved;             // with surface tension; null: none
  std::unique_ptr<MPMFlowRegions> regions;            // null: none
  std::unique_ptr<MPMFlowStick> stick;                // regions without slip; null: none
  std::unique_ptr<MPMFlowBodies> bodies;              // rigid bodies of regions; null: none
  std::unique_ptr<MPMFlowGrains> grains;              // of fix mpm/immersed; null: none
  std::unique_ptr<MPMFlowInflow> inflow;              // of fix mpm/emit; null: none
  std::unique_ptr<MPMFlowSolids> solids;              // null: none
  std::unique_ptr<MPMFlowGas> gas;                    // in pockets; null: none
  std::unique_ptr<MPMFlowGasRows> gas_rows;
  MPMRows gradient;    // [n][flow_slopes(dim)] of velocities of points, with apic
  std::vector<int> liquid_bits;
  std::vector<double> lightness,
      face_volumes;               // of faces, see MPMFlowPressure; with several densities only
  std::vector<double> elastic;    // forces of solids at faces
  bool several = false;           // are there several densities?
  double least_density = 0.0;
  double thickest = 0.0;           // largest viscosity
  bool stiffness_known = false;    // was check_stiffness() done in this run?
  std::vector<double> sums, share, old, star, more, velocity, known, pressures, shift, at_surface,
      potentials, viscous_velocity, before_forces, mobility, without_hold, start_of_part,
      psi_of_parts;

  double dt_before = 0.0;    // duration of the last step; 0: none so far
  mutable double limit_before =
      0.0;    // last stable_dt() with forces; after a restart, of all ranks; 0: none
  bool forces_known = false;    // false at the start of a run, when forces are cleared
  mutable bool told_of_bodies = false, told_of_walls = false;
  bool told_of_large = false, told_of_liquids = false;
  double unseen[2] = {0.0, 0.0};    // MPMFlowUpdate::squares of the last step
  double halvings = 0.0;            // number of halvings of steps and their parts so far
  double energy_of_spread = 0.0;    // energy that spreading has added to points of this rank so far
  std::vector<double> paths;        // [cell][dim] velocities that points move with, if sharp
  double gone = 0.0;    // largest distance that points have moved since neighbor lists were made

  struct {
    double iterations = 0.0, of_stress = 0.0, residual = 0.0, divergence = 0.0, wet = 0.0,
           filled = 0.0, parts = 0.0;
    double walls[3][2] = {};
    std::vector<double> regions = {};    // [3 regions]
  } last;    // results of the last step; filled, wet, walls, and regions for this rank only

  double acceleration_of_stress() const;
  void sum_last_step(bool valid, double *all) const;
  void weight(double *g) const;
  const std::vector<double> *surface_psi() const;
  MPMFlowPoints points_now(double dt) const;
  double density_of(int i) const;
  double largest_nu() const;
  void find_lightness(const MPMFlowPoints &);
  void check_points();
  void check_liquids();
  void check_others() const;
  void check_gas() const;
  double value_of_gas(int k) const;
  void check_solids();
  void check_stiffness();
  void check_depths();
  void note_filling();
  void fit_gradients();
  void find_paths();
  void find_shift();
  void go_on_into_air();
  void find_velocities();
  void add_forces(double dt);
  void add_viscosity(double dt);
  void find_tension(double duration);
  MPM_NS::SolveReport find_stress(double dt, double rounding);
  void find_flow(double duration);
  MPM_NS::SolveReport find_part(double duration);
  void find_pressures(double pressure_to_psi);
  void check_inflow() const;
  void check_speed();
};

}    // namespace LAMMPS_NS
#endif
#endif
