/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/emit,FixMPMEmit);
// clang-format on
#else

#ifndef LMP_FIX_MPM_EMIT_H
#define LMP_FIX_MPM_EMIT_H

#include "declare/option.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_node_action.h"
#include "field/mpm_traffic.h"

#include "fix.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixMPMMaterial;
class MPMField;
class MPMFluid;
class MPMInlet;
class Region;

/** Keywords of fix mpm/emit. */
struct MPMEmitOptions {
  std::string region_id;
  MPM_NS::NumberOrVariable velocity[3];    ///< of the material, relative to the inlet
  MPM_NS::NumberOrVariable move[3];        ///< velocity of the inlet
  double normal[3] = {0.0, 0.0, 0.0};    ///< direction of the flow; zero: direction of the velocity
  int ppc = 2;
  double spacing = 0.0, area = 0.0;    ///< 0: not given
  double temperature = 0.0;
  bool has_velocity = false, has_temperature = false;

  MPM_NS::Options declare(int dimension);
};

/** Inflow of material points through a region, the inlet. Points enter at its upstream end, layer
 *  by layer, and move with the given velocity until they leave it, because the nodes of the inlet
 *  have that velocity.
 *
 *  Layers are frozen in the flow: layer k is at the distance S - (k + 1/2) d from the upstream end,
 *  where S is the distance that the flow has traveled so far and d is the distance between layers.
 *  A layer enters at its current place in the step in which this distance becomes positive. So the
 *  mass agrees with the flow for any velocity and time step. */
class FixMPMEmit : public Fix, public MPMNodeAction, public MPMRegionUser, private MPMEmitOptions {
 public:
  FixMPMEmit(class LAMMPS *, int, char **);
  ~FixMPMEmit() override;
  int setmask() override { return FixConst::POST_INTEGRATE | FixConst::PRE_EXCHANGE; }
  void init() override;
  bool uses_region(const std::string &name) const override { return name == region_id; }
  bool sees_images() const override { return true; }
  void setup_pre_exchange() override;
  void post_integrate() override;
  void pre_exchange() override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  /** scalar: mass that has entered; vector: points, mass, momentum, and energy of these, speed and
   *  mass of the flow per time, force of the inlet on the material and its work. */
  double compute_scalar() override { return past.total.mass; }
  double compute_vector(int) override;
  double memory_usage() override;

  Turn turn() const override { return INLETS; }
  bool looks_beyond_points() const override { return false; }
  bool looks_at_all(const MPMField &, const MPM_NS::Grid::Block &) const override { return false; }
  void topology_changed(MPMField &) override;
  bool is_projection() const override { return true; }
  void act(double dt, Stage) override;

  /** Do the points enter this field? */
  bool emits_into(const MPMField &) const;
  bool may_be_empty(const MPMField &field) const override { return emits_into(field); }
  /** What must be known of points before they come: their type, and the largest spacing that
   *  belongs to their volumes in this field. A given area of the section changes these by a share
   *  that the region alone tells later. */
  int type_of_points() const { return type; }
  double largest_spacing(const MPMField &) const;

  // for incompressible flows

  /** Do the points enter the flow of this group? */
  bool emits_into(int flow_groupbit) const { return (flow_groupbit & (1 | groupbit)) != 0; }
  const MPMInlet &shape() const { return *inlet; }    ///< valid from setup_pre_exchange() on
  /** Velocity v[3] of the material relative to the inlet in this step. Collective. */
  void velocity_now(double *v);
  /** The same at the end of this step, after velocity_now(). */
  const double *velocity_at_end() const { return at_end; }

 private:
  int type;
  Region *region = nullptr;
  MPMField *field = nullptr;
  const MPMFluid *fluid = nullptr;    // flow, in place of a field and a material
  FixMPMMaterial *material = nullptr;
  std::unique_ptr<MPMInlet> inlet;
  double layer = 0.0;      // distance between layers
  double section = 0.0;    // area of the inlet; of rings around an axis of symmetry

  // state in restart files, together with that of the inlet
  struct {
    double travel = 0.0;                  // distance that the flow has traveled so far, see above
    double shift[3] = {0.0, 0.0, 0.0};    // displacement of the inlet since the start
    double direction[3] = {0.0, 0.0, 0.0};    // of the flow
    double layers = 0.0;                      // number of layers that have entered
    double started = 0.0;
    double work = 0.0;      // of the inlet on the material, this rank's share [energy]
    double newest = 0.0;    // largest ID of any point so far, including removed points
    double acted = 0.0;     // 1: there was a last step
    double velocity[3] = {0.0, 0.0, 0.0};    // that nodes had in the last step
    MPMTraffic total;                        // of all points that have entered, on all ranks
  } past;
  static constexpr int NREAL = 15 + MPMTraffic::NREAL;

  double flow[3] = {0.0, 0.0, 0.0}, drift[3] = {0.0, 0.0, 0.0};    // of material, of inlet
  double at_end[3] = {0.0, 0.0, 0.0};    // of material; flow may be that of the middle of the step
  double speed = 0.0;                    // along the flow, relative to the inlet
  bigint motion_step = -1;               // step for which these are known
  double impulse[3] = {0.0, 0.0, 0.0}, dt_last = 0.0;    // on the material in the last step
  std::vector<int64_t> nodes;                            // nodes of the inlet, which are held

  bool moves() const;
  void find_field();
  void refuse_combinations() const;
  double spacing_of_nodes() const;
  void make_inlet();
  void evaluate_velocities();
  void update_motion();
  void list_nodes();
  bigint layers_now() const;
  void emit();
  void note_ids();
  tagint largest_id() const;
  tagint last_id(bigint npoint) const;
  void make_point(const double *x, const double *v, double volume, tagint tag);
  void give_temperature(int i);
};

}    // namespace LAMMPS_NS
#endif
#endif
