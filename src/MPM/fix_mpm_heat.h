/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/heat,FixMPMHeat);
// clang-format on
#else

#ifndef LMP_FIX_MPM_HEAT_H
#define LMP_FIX_MPM_HEAT_H

#include "mpm_conduction.h"
#include "mpm_physics.h"
#include "mpm_state.h"
#include "mpm_super_step.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

struct MPMHeatOptions {
  MPMHeatCondition conditions[MPMHeatFaces::NFACE];
  std::string source;    ///< variable, without v_; empty: none
  MPMHeatTransfer transfer;
  int most_stages = 32;

  MPM_NS::Options declare(int dimension);
};

/** Conduction of heat in the points of materials with a part thermal conducting, and heat through the faces
 *  of the box. Points of different fields (fix mpm) exchange no heat. */
class FixMPMHeat : public FixMPMState, public MPMPhysics, private MPMHeatOptions {
 public:
  FixMPMHeat(class LAMMPS *, int, char **);
  int setmask() override { return 0; }    // called by fix mpm
  void init() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  double memory_usage() override;

  void init_physics(MPMPlan &) override;
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  void extend_topology(MPMField &field) override { of(field).faces.extend_topology(); }
  void topology_changed(MPMField &field) override { of(field).faces.topology_changed(); }
  double stable_dt(const MPMField &field, tagint &tag) const override;
  std::vector<Account> accounts() const override;
  void account(double *values) const override;

  MPMConduction &of(const MPMField &) const;

  /** Who else gives heat to nodes and points. */
  enum Giver { FRICTION, NGIVER };
  /** Heat that nodes or points of this rank were given in this step [energy], before they conduct. */
  void book(Giver giver, double heat) { booked[giver] += heat; }

 private:
  using Heats = MPMConduction::Heats;

  MPMRows gradients;    // [n][dim] of the temperature at points; not with transfer pic
  std::vector<std::unique_ptr<MPMConduction>> fields;
  MPMSuperStep steps;    // of the temperatures of all fields together
  // so far, this rank's share, in restart files that of all ranks: heat through faces and of sources; of points
  Heats came;
  double got = 0.0;
  Heats in_step, present;    // heat of the last step, and power in a stage of it, this rank's share
  Heats power;
  static constexpr int NCAME = MPMHeatFaces::NFACE + 1;    // then those of givers
  double booked[NGIVER] = {};                              // by givers since the last step
  double dt_last = 0.0;
  bool power_known = true;
  int source_index = -1;
  std::vector<double> source_values;    // [n] of an atom-style variable

  double sigma() const;
  void evaluate_variables();
  int count_stages();
  void find_rates();
  void conduct();
};

}    // namespace LAMMPS_NS
#endif
#endif
