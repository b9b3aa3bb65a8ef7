/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_MATERIAL_POINT_H
#define MPM_MATERIAL_MATERIAL_POINT_H

// Drives a material along a prescribed motion without a grid, for tests and for plots of a law.

#include "material/material.h"

namespace MPM_NS {

/** Motion of a step in which some components are determined by a given stress.
 *
 *  L is the velocity gradient, constant during the step: F_new = exp(dt L) F. For each component k
 *  of the symmetric part (order of the stress) with stress_given[k], a rate of deformation is added
 *  to L such that the Cauchy stress at the end of the step has the value stress[k].
 */
struct MixedControl {
  double L[9] = {};    ///< row-major
  bool stress_given[6] = {};
  double stress[6] = {};
};

/** A batch of equal points that all follow the same velocity gradient. */
class MaterialPoint {
 public:
  /** n points of reference volume 1 each; h: length of the artificial viscosity. */
  explicit MaterialPoint(const Material &, int n = 1, double h = 1.0);
  MaterialPoint(const MaterialPoint &);
  MaterialPoint &operator=(const MaterialPoint &) = delete;

  /** One step with the velocity gradient L[9] (row-major) at the middle of the step. */
  void step(const double *L, double dt);

  /** One step of the motion F_new = (I + A) F, with this heat from outside per reference volume. */
  void move(const double *A, double dt, double heat = 0.0);
  /** Stored energy and all that has become heat or fracture so far, per reference volume. */
  double internal_energy() const;

  /** One step of a partly known motion; throws std::runtime_error if no motion gives the stress.
   *  rotation: rotation at the end of the step of the frame to which the control refers (row-major;
   *  null: as before, initially none). Returns the number of iterations. */
  int step(const MixedControl &, double dt, const double *rotation = nullptr);

  /** One step with strain rate along x and free lateral surfaces (sigma_yy = sigma_zz = 0). */
  void step_uniaxial_stress(double rate, double dt);

  const Material &material;
  Batch batch = {};
  std::vector<double> storage;    ///< history of the batch
  double time = 0.0;
  double power = 0.0;         ///< stress power so far, integral of P:dF by the trapezoidal rule
  double work[NWORK] = {};    ///< work of each kind so far, per reference volume
  /** Rotation of the frame in which the motion is controlled, see step(). */
  double rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

  /** Deformation gradient F[9] and Cauchy stress[6] in the frame in which the motion is
   *  controlled. */
  void frame_state(double *F, double *stress) const;

  // state of the first point
  double stress(int k) const { return batch.stress[k][0]; }
  double history(int k) const { return batch.history[k][0]; }
  double density() const;    ///< reference density
  double pressure() const { return -(stress(0) + stress(1) + stress(2)) / 3.0; }
  double vonmises() const;
  double wave_speed() const;
  double stored_energy() const;

 private:
  double guess[6] = {};    ///< rate of deformation found in the last step with mixed control
};

}    // namespace MPM_NS
#endif
