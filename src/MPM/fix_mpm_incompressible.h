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

#include "declare/option.h"
#include "mpm_flow_gas.h"
#include "mpm_flow_lattice.h"
#include "mpm_state.h"
#include "mpm_step_limit.h"
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
class MPMFlowViscosity;
struct MPMFlowPoints;

struct MPMIncompressibleOptions {
  enum Transfer { AUTO, APIC, FLIP, AFLIP, PIC };

  double h = 0.0, density = 0.0;
  double viscosity = 0.0;
  bool implicit = false;    ///< viscosity
  double tension = 0.0;
  double angle = 90.0;    ///< between surfaces and walls, degrees
  Transfer transfer = AUTO;
  bool transfer_is_given = false;
  double flip = 0.0;       ///< share of FLIP, with AUTO that of this step
  double reflect = 0.0;    ///< share of the change by the pressure that comes once more
  bool sharp = false;      ///< paths of points
  double spread = 0.5;     ///< share of an excess of points that spreads in a step
  double tolerance = 1.0e-9;
  int most_iterations = 10000;
  int64_t most_parts = 64;    ///< of a step, where implicit viscosity does not converge
  bool parts_are_given = false;
  MPMFlowWall walls[3][2];
  std::vector<std::string> region_ids;
  bool sticks = false;    ///< regions
  struct Liquid {
    std::string group;
    double density;
  };
  std::vector<Liquid> liquids;    ///< of other densities
  std::vector<std::string> solid_groups;
  bool has_gas = false;
  MPMFlowGasLaw gas_law;
  bool outside_is_given = false;
  bool open[3][2] = {};    ///< faces next to which is open air
  bool has_open = false;

  MPM_NS::Options declare(int dim);

 private:
  int axis = 0, side = 0;    // of the last wall
  MPMFlowWall wall;
  bool wall_is_twice = false;
  std::string region_id;
  Liquid liquid;
  std::string solid_group;
  int open_face = 0;
};

/** Flow of an incompressible fluid, with free surfaces: its points, on a staggered lattice of its own, with a pressure that
 *  makes velocities free of divergence. */
class FixMPMIncompressible :
    public FixMPMState,
    public MPMStepLimit,
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

  /** Time in which a point of this rank passes one spacing with the velocity and the acceleration that it has, or one half of
   *  what viscosity allows; no less than that of points without motion. tag: that of the point, 0: viscosity. */
  double stable_dt(tagint &tag) const override;
  /** Node spacing of a flow for which a region is solid; 0: it is not. */
  double spacing_around(const std::string &region) const;
  double spacing() const { return h; }
  MPMFlowSolids *solids_of() const { return solids.get(); }    ///< null: none
  double density_of_fluid() const { return density; }
  /** An error of who has another density of the fluid. */
  void check_density(double of_fluid, const std::string &who) const;

 private:
  MPMFlowLattice cells;
  std::unique_ptr<MPMFlowPressure> pressure;
  std::unique_ptr<MPMFlowAir> air;
  std::unique_ptr<MPMFlowViscosity> viscous;    // explicit; null: none
  std::unique_ptr<MPMFlowStress> stress;        // implicit viscosity; null: none
  std::unique_ptr<MPMFlowTension> curved;       // with surface tension; null: none
  std::unique_ptr<MPMFlowRegions> regions;      // null: none
  std::unique_ptr<MPMFlowStick> stick;          // regions without slip; null: none
  std::unique_ptr<MPMFlowBodies> bodies;    // of regions; null: these move by themselves, or not
  std::unique_ptr<MPMFlowGrains> grains;    // of fix mpm/immersed; null: none
  std::unique_ptr<MPMFlowInflow> inflow;    // of fix mpm/emit; null: none
  std::unique_ptr<MPMFlowSolids> solids;    // null: none
  std::unique_ptr<MPMFlowGas> gas;          // in pockets; null: none
  std::unique_ptr<MPMFlowGasRows> gas_rows;
  MPMRows gradient;    // [n][flow_slopes(dim)] of velocities of points, with apic
  std::vector<int> liquid_bits;
  std::vector<double> lightness,
      face_volumes;               // of faces, see MPMFlowPressure; with several densities
  std::vector<double> elastic;    // forces of solids at faces
  bool several = false;           // densities
  double least_density = 0.0;
  bool stiffness_known = false;    // in this run
  std::vector<double> sums, share, old, star, more, velocity, known, pressures, shift, at_surface,
      potentials, viscous_velocity, before_forces, mobility, without_hold, start_of_part,
      psi_of_parts;

  double dt_before = 0.0;    // duration of the last step; 0: none so far
  mutable double limit_before =
      0.0;                      // last stable_dt() with forces, on restart of all ranks; 0: none
  bool forces_known = false;    // they are cleared at the start of a run
  mutable bool told_of_bodies = false, told_of_walls = false;
  bool told_of_large = false, told_of_liquids = false;
  double unseen[2] = {0.0, 0.0};    // MPMFlowUpdate::squares of the last step
  double halvings = 0.0;            // of steps and their parts, so far
  double energy_of_spread = 0.0;    // that spreading has added to points so far, of this rank
  std::vector<double> paths;        // [cell][dim] velocities that points move with, if sharp
  double gone = 0.0;                // most that points have moved since neighbor lists were made

  struct {
    double iterations = 0.0, of_stress = 0.0, residual = 0.0, divergence = 0.0, wet = 0.0,
           filled = 0.0, parts = 0.0;
    double walls[3][2] = {};
    std::vector<double> regions = {};    // [3 regions]
  } last;    // of the last step; filled, wet, walls, and regions of this rank

  double acceleration_of_stress() const;
  void sum_last_step(bool valid, double *all) const;
  void weight(double *g) const;
  const std::vector<double> *surface_psi() const;
  MPMFlowPoints points_now(double dt) const;
  double density_of(int i) const;
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
