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
#include "mpm_node_action.h"
#include "mpm_traffic.h"

#include "fix.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixMPMIncompressible;
class FixMPMMaterial;
class MPMField;
class MPMMouth;
class Region;

struct MPMEmitOptions {
  std::string region_id;
  MPM_NS::NumberOrVariable velocity[3];    ///< of the material, relative to the mouth
  MPM_NS::NumberOrVariable move[3];        ///< velocity of the mouth
  double normal[3] = {0.0, 0.0, 0.0};      ///< direction of the flow; zero: that of the velocity
  int ppc = 2;
  double spacing = 0.0, area = 0.0;    ///< 0: not given
  double temperature = 0.0;
  bool has_velocity = false, has_temperature = false;

  MPM_NS::Options declare(int dimension);
};

/** Inflow of material points through a region, the mouth. Points enter at its upstream end, layer by layer, and move with the
 *  given velocity until they leave it: the nodes of the mouth have that velocity.
 *
 *  Layers are frozen in the flow: layer k is at the distance S - (k + 1/2) d from the upstream end, with the way S of the
 *  flow so far and the distance d of layers. It enters in the step in which this becomes positive, at the place that it has by then. So the
 *  mass is that of the flow at any velocity and time step. */
class FixMPMEmit : public Fix, public MPMNodeAction, private MPMEmitOptions {
 public:
  FixMPMEmit(class LAMMPS *, int, char **);
  ~FixMPMEmit() override;
  int setmask() override;
  void init() override;
  void setup_pre_exchange() override;
  void post_integrate() override;
  void pre_exchange() override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;

  Turn turn() const override { return MOUTHS; }
  bool looks_beyond_points() const override { return false; }
  bool looks_at_all(const MPMField &, const MPM_NS::Grid::Block &) const override { return false; }
  void topology_changed(MPMField &) override;
  bool is_projection() const override { return true; }
  void act(double dt, Stage) override;

  /** Are its points in this field? */
  bool emits_into(const MPMField &) const;

  // for incompressible flows

  bool emits_into(const Fix &flow) const { return (flow.groupbit & (1 | groupbit)) != 0; }
  const MPMMouth &passage() const { return *mouth; }    ///< from setup_pre_exchange() on
  /** Of the material in this step; collective. */
  void velocity_now(double *v);

 private:
  int type;
  Region *region = nullptr;
  MPMField *field = nullptr;
  const FixMPMIncompressible *fluid = nullptr;    // in place of a field and a material
  FixMPMMaterial *material = nullptr;
  std::unique_ptr<MPMMouth> mouth;
  double layer = 0.0;      // distance of layers
  double section = 0.0;    // area of the mouth, that of rings around an axis of symmetry

  // what restart files keep, with what the mouth is made of
  struct {
    double travel = 0.0;                      // way of the flow through the mouth so far
    double shift[3] = {0.0, 0.0, 0.0};        // of the mouth since the start
    double direction[3] = {0.0, 0.0, 0.0};    // of the flow
    double layers = 0.0;                      // that have entered
    double started = 0.0;
    double work = 0.0;      // of the mouth on the material, this rank's share [energy]
    double newest = 0.0;    // largest ID of any point so far, also of those that were removed
    double acted = 0.0;     // there was a last step,
    double velocity[3] = {0.0, 0.0, 0.0};    // and what nodes were given in it
    MPMTraffic total;                        // that has entered, of all ranks
  } past;
  static constexpr int NREAL = 15 + MPMTraffic::NREAL;

  double flow[3] = {0.0, 0.0, 0.0}, drift[3] = {0.0, 0.0, 0.0};    // velocities of this step
  double speed = 0.0;                                    // along the flow, relative to the mouth
  bigint motion_step = -1;                               // for which these are known
  double impulse[3] = {0.0, 0.0, 0.0}, dt_last = 0.0;    // on the material in the last step
  std::vector<int64_t> nodes;                            // that are held

  bool moves() const;
  void find_field();
  void refuse_combinations() const;
  double spacing_of_nodes() const;
  void make_mouth();
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
