/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MATERIAL_POINT_H
#define LMP_MPM_MATERIAL_POINT_H

// Drives a material along a prescribed motion, without a grid: for tests and for plots of a law.

#include "mpm_material.h"

namespace MPM_NS {

/** A batch of equal points that all follow the same velocity gradient. */
class MaterialPoint {
 public:
  /** n points of reference volume 1 each; h: length of the artificial viscosity. */
  explicit MaterialPoint(const Material &, int n = 1, double h = 1.0);
  MaterialPoint(const MaterialPoint &);
  MaterialPoint &operator=(const MaterialPoint &) = delete;

  /** One step with the velocity gradient L[9] (row-major) of the middle of the step. */
  void step(const double *L, double dt);

  /** One step of the motion F_new = (I + A) F. */
  void move(const double *A, double dt);

  /** One step with strain rate along x and free lateral surfaces (sigma_yy = sigma_zz = 0). */
  void step_uniaxial_stress(double rate, double dt);

  const Material &material;
  Batch batch;
  std::vector<double> storage;    ///< history of the batch
  double time;
  double power;          ///< stress power so far, integral of P:dF by the trapezoidal rule
  double work[NWORK];    ///< so far, per reference volume

  /** State of the first point. */
  double stress(int k) const { return batch.stress[k][0]; }
  double history(int k) const { return batch.history[k][0]; }
  double pressure() const;
  double vonmises() const;
  double wave_speed() const;
  double stored_energy() const;
};

}    // namespace MPM_NS
#endif
