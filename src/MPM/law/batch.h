/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_BATCH_H
#define MPM_LAW_BATCH_H

// What a constitutive law works on: a batch of points, the tangent of their step, the kinds of work
// that it reports, and the thermal properties of a point. Nothing here knows about grids.

#include "transfer/kernels.h"

#include <algorithm>

namespace MPM_NS {

/** Kinds of work that a law reports, as energies summed over the points of a batch. */
enum Work {
  PLASTIC,          ///< plastic work
  VISCOUS,          ///< work of viscous stress
  HEAT,             ///< part of the plastic and viscous work that became heat
  FRACTURE,         ///< work spent on damage, and on friction between fragments
  THERMOELASTIC,    ///< work of stress on thermal strain, and by moduli that warming changes
  NWORK
};

/** Up to BATCH points of one material in structure-of-arrays form.
 *
 *  Kinematics: A = dt * grad v with respect to the positions at the start of the step, so that the
 *  motion x + dt v of the points gives exactly F_new = (I + A) F_old. The velocity gradient in the
 *  middle of the step is G/dt with G = A (I + A/2)^-1; I + A is the Cayley transform of G, a
 *  rotation when G is skew. Rate-form laws use G (sym: strain increment, skew: incremental
 *  rotation).
 */
struct Batch {
  int n;                                  ///< points in use, 1..BATCH
  double dt;                              ///< time step
  double h;                               ///< node spacing, length scale of artificial viscosity
  alignas(64) double A[9][BATCH];         ///< dt * velocity gradient, row-major
  alignas(64) double F[9][BATCH];         ///< deformation gradient at the end of the step
  alignas(64) double J[BATCH];            ///< det F at the end of the step
  alignas(64) double Jold[BATCH];         ///< det F at the start of the step
  alignas(64) double stress[6][BATCH];    ///< Cauchy stress; in: start, out: end of the step
  alignas(64) double vol0[BATCH];         ///< initial volume
  double (*history)[BATCH];               ///< [nhistory][BATCH]; in: start, out: end of the step
  double work[NWORK];                     ///< out: energy of each kind spent in this batch and step
  double time;                            ///< at the end of the step

  // passed between the parts of a material within a step

  alignas(64) double heat[BATCH];       ///< in: heat from outside; out: all, per reference volume
  alignas(64) double plastic[BATCH];    ///< increment of the equivalent plastic strain
  alignas(64) double speed[BATCH];      ///< wave speed without viscosity, for viscosities only

  // likewise, used by damage only; energies are per reference volume of the undamaged material

  alignas(64) double kept[BATCH];             ///< fraction of the stress deviator at the start
  alignas(64) double plastic_work[BATCH];     ///< plastic work of the step
  alignas(64) double viscous_mean[BATCH];     ///< mean stress due to the viscosities
  alignas(64) double shear_energy[BATCH];     ///< energy stored by the strength
  alignas(64) double volume_energy[BATCH];    ///< energy stored by the equation of state
};

/** Algorithmic tangent of a step: derivatives of the discrete update, not of the rates that it
 *  approximates, so that a Newton iteration converges quadratically (J.C. Simo, R.L. Taylor,
 *  Comput. Methods Appl. Mech. Eng. 48 (1985) 101). For a change l = dF F^-1 of the motion, with F
 *  at the end of the step,
 *
 *    d(J sigma)_k = sum_j stress[k][j] l_j
 *
 *  where l_j is row-major (l_xx, l_xy, ...) and k in the order of Batch::stress. The change of the
 *  first Piola-Kirchhoff stress P = J sigma F^-T is [d(J sigma) - J sigma l^T] F^-T.
 */
struct Tangent {
  /** Input: if true, only motions in the xy plane and around an axis (zz) are needed; other columns
   *  are not written. */
  bool plane = false;
  alignas(64) double stress[6][9][BATCH];    ///< tangent of the Kirchhoff stress J sigma
  /** Tangent of Batch::heat, passed between the parts of a material. */
  alignas(64) double heat[9][BATCH];

  bool skips(int l) const { return plane && (l == 2 || l == 5 || l == 6 || l == 7); }
};

/** Melting at a single temperature: how heat changes the temperature and the molten fraction. */
struct Melting {
  double temperature;    ///< melting temperature
  double range;          ///< heat of fusion over specific heat; 0: does not melt

  /** Updates T and the molten fraction to equilibrium at constant enthalpy. On input, T is the
   *  temperature at the previous molten fraction. */
  inline __attribute__((always_inline)) void settle(double &T, double &molten) const
  {
    const double all = T + range * molten, above = all - temperature;    // if nothing had melted
    const double latent = above < 0.0 ? 0.0 : (above > range ? range : above);
    molten = latent / range;
    T = all - latent;
  }
};

/** Thermal properties of a point, as needed by heat conduction. */
struct Conduction {
  double capacity;        ///< specific heat [energy/(mass temperature)]
  double conductivity;    ///< [power/(length temperature)], along axis 1 if orthotropic
  Melting melting;
  bool by_enthalpy;    ///< only Material::warm() turns heat into a temperature
  /** Axes are those of the reference configuration, and turn with the material. */
  bool orthotropic;
  double across[2];     ///< conductivity along axes 2 and 3
  double axis[3][3];    ///< unit vectors along the axes

  double most() const
  {
    return orthotropic ? std::max(conductivity, std::max(across[0], across[1])) : conductivity;
  }
};

}    // namespace MPM_NS
#endif
