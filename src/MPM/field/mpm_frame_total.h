/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FRAME_TOTAL_H
#define LMP_MPM_FRAME_TOTAL_H

#include "field/mpm_frame.h"

namespace LAMMPS_NS {

/** Total Lagrangian frame: nodes are places of a reference configuration, which may be updated. */
class MPMFrameTotal : public MPMFrame {
 public:
  MPMRows X;    ///< [n][3] reference position, NAN before it is known
  /** [n][9] F at the last update of the reference, row-major; null: no updates. */
  MPMRows R;

  MPMFrameTotal(class LAMMPS *, MPMField &, MPMPointState &);

  void setup() override;
  bool renew_places() override;
  void end_of_step() override;
  bool is_total() const override { return true; }
  MPMRows places() const override { return X; }
  bool changes_forces() const override { return true; }
  void forces(MPM_NS::PointRows &, int first, int n, ForceRows &) const override;
  void shift_gradients(int, double, double *) const override {}
  bool refers() const override { return R || mean_rate; }
  void refer_gradients(int first, int n, double *L) const override;
  double volume_change(int i, const double *L, double dt) const override;
  void lattice_F(int i, double F[3][3]) const override;
  double lattice_jacobian(int i) const override;
  double speed(int i, double &c, double known) const override;
  double radius(int i, double x) const override;
  void start_counting() override { nupdate = 0; }
  std::string report() const override;

 private:
  bigint nupdate = 0;         // updates of the reference in this run
  bool refer_anew = false;    // the present configuration is to become the reference

  void stretches(int i, double &smallest, double &largest) const;
};

}    // namespace LAMMPS_NS
#endif
