/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/immersed,FixMPMImmersed);
// clang-format on
#else

#ifndef LMP_FIX_MPM_IMMERSED_H
#define LMP_FIX_MPM_IMMERSED_H

#include "base/mpm_state.h"
#include "declare/option.h"
#include "field/mpm_coupling.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_node_action.h"
#include "grains/mpm_drag.h"

#include <cstdint>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Keywords of fix mpm/immersed. */
struct MPMImmersedOptions {
  std::string field_id;
  double density = 0.0, viscosity = 0.0;    ///< viscosity: read as pressure, kept as mass
  MPM_NS::SphereDrag::Law law = MPM_NS::SphereDrag::GIDASPOW;
  double gravity[3] = {0.0, 0.0, 0.0};
  bool displace = false;    ///< grains displace fluid: it has no mass where grains are

  MPM_NS::Options declare(int dimension);
};

/** Drag and buoyancy between grains smaller than the node spacing and a fluid. The fluid is a field
 *  (fix mpm), with momentum exchange at the nodes around each grain, or an incompressible flow,
 *  which uses only the laws of this fix and exchanges momentum by itself (MPMFlowGrains). */
class FixMPMImmersed :
    public FixMPMState,
    public MPMNodeAction,
    public MPMListedPoints,
    public MPMCoupling,
    private MPMImmersedOptions {
 public:
  FixMPMImmersed(class LAMMPS *, int, char **);
  int setmask() override { return FixConst::FINAL_INTEGRATE; }
  void init() override;
  void setup(int) override;
  void final_integrate() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;

  void init_action() override;
  void couple_topology() override;
  void extend_topology(MPMField &) override;
  void topology_changed(MPMField &) override;
  void act(double dt, Stage) override;

  bool keeps_group(int group) const override;
  bool couples(const std::string &, const std::string &) const override { return false; }
  int atoms_coupled_to(const std::string &one) const override
  {
    return one == field_id ? groupbit : 0;
  }

  // for flows

  /** ID of the fix of the fluid. */
  const std::string &fluid() const { return field_id; }
  const double *acceleration_of_gravity() const { return gravity; }
  /** Do grains displace fluid? */
  bool displaces() const { return displace; }
  /** Is this local atom a grain in the fluid? */
  bool is_grain(int i) const;
  double volume(int i) const;    ///< in 2d per unit of depth
  /** Number of steps for which forces still act on a grain, of those before the end of its
   *  impulses. mass: of the grain; infinite: held. */
  double steps_ahead(int i, double &mass) const;
  /** Gives a grain of this mass the impulse of drag and buoyancy in a step. */
  void push(int i, double mass, const double *impulse);
  /** Share of space that grains fill around a grain, corrected for the end of a bed. solid: mapped
   *  share at the grain; moment: its first moment sum N r [node spacings]; own: volume of the
   *  grain; order: of the splines; cell: volume of a cell. */
  double end_of_bed(double solid, const double *moment, double own, int order, double cell) const;
  /** Drag/slip [mass/time] at the slip w = slip/(1 + slowing K(w)) that remains after a step. */
  double drag_after_step(double diameter, double slip, double solid, double slowing) const;
  /** Notes drag and buoyancy on n grains of this rank, as impulses in a step of the duration dt. */
  void was_pushed(int n, const double *impulses, double dt);

 private:
  struct Mover {    // a fix that integrates grains
    int groupbit;
    double ahead;      // steps for which forces still act
    double at_once;    // share of an impulse that the grain gets before it moves
  };
  struct Grain {
    int i;                 // local index
    std::size_t first;     // index of its first node in nodes
    double w[3][4];        // weights of its nodes along the axes
    double r[3];           // from the first node to the grain, in node spacings
    double around;         // mass of fluid around it
    double mass;           // infinite: held
    double immersed;       // share of the grain that is in the fluid
    double gain[3];        // change of the velocity of the fluid in this step
    double fluid[3];       // velocity of the fluid before buoyancy and drag
    double velocity[3];    // velocity of the grain with forces, before drag
    double part;           // 1/(1 + volume share of grains)
    double coefficient;    // part times the drag per velocity [mass/time]
    double buoyancy[3];    // part times the impulse of buoyancy
  };
  enum { BUOYANCY = 0, COEFFICIENT = 3, DRAG = 4, SOLID = 7, NREAL = 8 };    // in sums

  MPMField *field = nullptr;
  std::vector<Mover> movers;
  MPMRows later;                     // [atom][3] velocities that grains get at the end of the step
  std::vector<int> immersed;         // local indices of the grains of this rank
  std::vector<Grain> grains;         // grains with fluid around them
  std::vector<int64_t> nodes;        // nodes of all grains, none a periodic image
  std::vector<int64_t> canonical;    // [node] the node that it is an image of, or itself
  int count_along[3] = {1, 1, 1};    // number of nodes of a grain along each axis
  std::vector<char> inner;           // [node] result of has_fluid_around(); 0: not evaluated yet
  std::vector<char> used;            // [slot] does the block have sums?
  std::vector<int> slots;            // slots of these blocks
  // [node][8] sums over the grains around a node: impulses of buoyancy [3] and coefficient, shared
  // by the mass of fluid; impulses of drag [3] per mass of fluid; share of space of grains
  std::vector<double> sums;
  double force_now[6] = {};    // impulses of drag [3] and buoyancy [3] on the grains of this rank
  int count = 0;
  double dt_last = 0.0;
  bool told_of_weight = false, told_of_order = false;

  void check_grains(const Fix *driver, double h);
  bool has_fluid_around(int64_t node) const;
  void find_grains(double dt);
  void use(int slot);
  template <class F> void each_used_node(const F &) const;
  bool find_fluid(Grain &);
  void move_by_forces(Grain &, double dt) const;
  void buoyancy_and_coefficient(Grain &, double dt);
  void drag(Grain &, double dt);
  void add_to_nodes(const Grain &, int lane, const double *values);
  void sum_nodes(int lane, int nlane);
  template <class F> void around(const Grain &, const F &) const;
  double porosity(double solid) const;
};

}    // namespace LAMMPS_NS
#endif
#endif
