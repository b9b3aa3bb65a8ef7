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
#include "mpm_physics.h"

#include "fix.h"

namespace LAMMPS_NS {
class MPMField;

struct MPMDeformOptions {
  enum Drive { HELD, ERATE, TRATE, STRAIN, STRESS };
  static constexpr int NPART = 6;    ///< xx yy zz xy xz yz

  Drive drive[NPART] = {HELD, HELD, HELD, HELD, HELD, HELD};
  MPM_NS::NumberOrVariable wanted[NPART];    ///< rate, strain, or stress

  MPM_NS::Options declare(int dimension);
};

/** The mean deformation of a periodic cell, along a path of strain or stress, component by component.
 *
 *  Points and nodes have the motion that is left without the mean one, which is periodic, so that box, lattice, and
 *  positions stay as they are: x = Fm X + u with the mean deformation gradient Fm, which is an upper triangular matrix as the box of fix
 *  deform is, and the periodic displacement u. The rate of Fm adds to the gradients that points get of the nodes. */
class FixMPMDeform : public Fix, public MPMPhysics, private MPMDeformOptions {
 public:
  FixMPMDeform(class LAMMPS *, int, char **);
  ~FixMPMDeform() override;
  int setmask() override { return 0; }
  void init() override;
  int modify_param(int, char **) override;
  double compute_scalar() override { return past.work; }
  double compute_vector(int) override;
  void write_restart(FILE *) override;
  void restart(char *) override;

  void init_physics(MPMPlan &) override;
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  bool looks_beyond_points() const override { return false; }

 private:
  std::vector<MPMField *> fields;

  // the same on all ranks, and in restart files
  struct {
    double F[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};    // mean, row-major
    // of components with a stress: speed, for each length of the cell [1/time]; lack of stress in the last step; way and time since
    // that changed its sign
    double speed[NPART] = {}, lack[NPART] = {}, way[NPART] = {}, time[NPART] = {};
    double tau[6] = {};    // mean over the cell before deformation, Kirchhoff [pressure]
    double P[9] = {};      // the same, first Piola-Kirchhoff
    double work = 0.0;     // of the mean deformation, so far [energy]
    double known = 0.0;    // the stress is known
  } past;
  static constexpr int NREAL = 9 + 4 * NPART + 6 + 9 + 2;
  double *reals() { return past.F; }

  double next[9];    // F at the end of the step
  double rate[9];    // of F in this step, which the frames see

  double volume() const;
  double length(int axis) const;
  double stress(int part) const;
  void refuse_combinations() const;
  void warn_of_strain() const;
  void find_motion();
  void find_stress();
  void end_motion();
};

}    // namespace LAMMPS_NS
#endif
#endif
