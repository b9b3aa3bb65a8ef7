/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/deform,FixMPMDeform);
// clang-format on
#else

#ifndef LMP_FIX_MPM_DEFORM_H
#define LMP_FIX_MPM_DEFORM_H

#include "declare/option.h"
#include "field/mpm_physics.h"

#include "implicit/mpm_mean_deformation.h"

#include "fix.h"

namespace LAMMPS_NS {
class MPMField;

/** Keywords of fix mpm/deform. */
struct MPMDeformOptions {
  static constexpr int NPART = MPMMeanDeformation::NPART;

  MPMMeanDeformation::Drive drive[NPART] = {};    ///< HELD
  MPM_NS::NumberOrVariable wanted[NPART];         ///< rate, strain, or stress

  MPM_NS::Options declare(int dimension);
};

/** The mean deformation of a periodic cell, along a path of strain or stress, component by
 *  component.
 *
 *  The position is x = Fm X + u with the mean deformation gradient Fm, an upper triangular matrix
 *  as for the box of fix deform, and the periodic displacement u. Points and nodes move only with
 *  u, so that box and lattice stay as they are. The rate of Fm is added to the velocity gradients
 *  that points get from the nodes. */
class FixMPMDeform : public Fix, public MPMPhysics, private MPMDeformOptions {
 public:
  FixMPMDeform(class LAMMPS *, int, char **);
  ~FixMPMDeform() override;
  int setmask() override { return 0; }
  void init() override;
  int modify_param(int, char **) override;
  double compute_scalar() override { return cell.past.work; }
  double compute_vector(int) override;
  void write_restart(FILE *) override;
  void restart(char *) override;

  void init_physics(MPMPlan &) override;
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  bool looks_beyond_points() const override { return false; }

 private:
  std::vector<MPMField *> fields;

  MPMMeanDeformation cell;    // the same on all ranks

  double volume() const;
  void refuse_combinations() const;
  void warn_of_strain() const;
  void find_motion();
  void find_stress(double *mean_tau, double *mean_P);
  void end_motion();
};

}    // namespace LAMMPS_NS
#endif
#endif
