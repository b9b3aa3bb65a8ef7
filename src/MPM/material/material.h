/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_MATERIAL_H
#define MPM_MATERIAL_MATERIAL_H

// Constitutive models: a batch of points in, stress and history out. Nothing here knows about
// grids, and only the parser knows about LAMMPS (for its error messages).

#include "transfer/kernels.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace MPM_NS {

/** Kinds of work that a law reports, in energy summed over the points of a batch. */
enum Work {
  PLASTIC,          ///< plastic work
  VISCOUS,          ///< work of viscous stress
  HEAT,             ///< part of these two that became heat
  FRACTURE,         ///< work spent on damage, and on friction between fragments
  THERMOELASTIC,    ///< of stress on thermal strain, and of moduli that change with temperature
  NWORK
};

/** Up to BATCH points of one material in structure-of-arrays form.
 *
 *  Kinematics: A = dt * grad v with respect to the positions at the start of the step, so that the
 *  points' own motion x + dt v gives exactly F_new = (I + A) F_old. The velocity gradient of the
 *  middle of the step is G/dt with G = A (I + A/2)^-1; I + A is its Cayley transform, a rotation
 *  when G is skew. Rate-form laws use G (sym: strain increment, skew: incremental rotation).
 */
struct Batch {
  int n;                                  ///< points in use, 1..BATCH
  double dt;                              ///< time step
  double h;                               ///< node spacing, the length of artificial viscosity
  alignas(64) double A[9][BATCH];         ///< dt * velocity gradient, row-major
  alignas(64) double F[9][BATCH];         ///< deformation gradient at the end of the step
  alignas(64) double J[BATCH];            ///< det F at the end of the step
  alignas(64) double Jold[BATCH];         ///< det F at the start of the step
  alignas(64) double stress[6][BATCH];    ///< Cauchy stress; in: start, out: end of the step
  alignas(64) double vol0[BATCH];         ///< initial volume
  double (*history)[BATCH];               ///< [nhistory][BATCH]; in: start, out: end of the step
  double work[NWORK];                     ///< out: energy of each kind spent in this batch and step
  double time;                            ///< at the end of the step

  // passed from part to part of a material within a step

  alignas(64) double heat[BATCH];       ///< in: heat from outside; out: all, per reference volume
  alignas(64) double plastic[BATCH];    ///< increment of the equivalent plastic strain
  alignas(64) double speed[BATCH];      ///< wave speed without viscosity, for viscosities only

  // the same, for a damage only; energies are per reference volume, of the undamaged material

  alignas(64) double kept[BATCH];             ///< share of the stress deviator at the start
  alignas(64) double plastic_work[BATCH];     ///< of the step
  alignas(64) double viscous_mean[BATCH];     ///< mean stress of the viscosities
  alignas(64) double shear_energy[BATCH];     ///< stored by the strength
  alignas(64) double volume_energy[BATCH];    ///< stored by the equation of state
};

/** How the result of a step depends on its motion: derivatives of the discrete update, not of the rates that it
 *  approximates, so that a Newton iteration converges quadratically (J.C. Simo, R.L. Taylor, Comput. Methods Appl. Mech.
 *  Eng. 48 (1985) 101). With the change l = dF F^-1 of the motion, F at the end of the step,
 *
 *    d(J sigma)_k = sum_j stress[k][j] l_j
 *
 *  where l_j is row-major (l_xx, l_xy, ...) and k in the order of Batch::stress. The change of the first Piola-Kirchhoff
 *  stress P = J sigma F^-T is [d(J sigma) - J sigma l^T] F^-T.
 */
struct Tangent {
  /** In: are only motions in the plane xy of interest, and around an axis? Columns of other ones are left alone. */
  bool plane = false;
  alignas(64) double stress[6][9][BATCH];    ///< of the Kirchhoff stress J sigma
  alignas(64) double heat[9][BATCH];    ///< of Batch::heat, passed from part to part of a material

  bool skips(int l) const { return plane && (l == 2 || l == 5 || l == 6 || l == 7); }
};

/** A history variable of a material. */
struct HistoryVariable {
  std::string name;    ///< as used by compute mpm/atom
  double initial;      ///< value of a new point, before Material::initialize()
};

/** Values of a quantity for which a material is meant. */
struct ValidRange {
  std::string quantity;    ///< pressure, rate, density, or name of a history variable
  double low, high;
};

/** Temperature and molten fraction when heat comes or goes: it melts at one temperature. */
struct Melting {
  double temperature;
  double range;    ///< heat of fusion over specific heat; 0: does not melt

  /** T: had no more or less of it melted than before. */
  inline __attribute__((always_inline)) void settle(double &T, double &molten) const
  {
    const double all = T + range * molten, above = all - temperature;    // had it not melted
    const double latent = above < 0.0 ? 0.0 : (above > range ? range : above);
    molten = latent / range;
    T = all - latent;
  }
};

/** What the conduction of heat needs to know of a point. */
struct Conduction {
  double capacity;        ///< specific heat [energy/(mass temperature)]
  double conductivity;    ///< [power/(length temperature)], along axis 1 if orthotropic
  Melting melting;
  bool by_enthalpy;     ///< the temperature follows from heat by Material::warm() only
  bool orthotropic;     ///< along axes of the reference configuration, which turn with the material
  double across[2];     ///< conductivity along axes 2 and 3
  double axis[3][3];    ///< unit vectors

  /** The greatest. */
  double most() const
  {
    return orthotropic ? std::max(conductivity, std::max(across[0], across[1])) : conductivity;
  }
};

/** What is wrong with the definition of a material, and which of its words is to blame. */
struct MaterialError : std::runtime_error {
  int word;    ///< index of the word, or the number of words when something is missing at the end
  MaterialError(int word, const std::string &message) : std::runtime_error(message), word(word) {}
};

/** A constitutive model with its parameters; stateless, all state is in the batch. */
class Material {
 public:
  virtual ~Material() = default;

  /** A material from the words of its definition, "density RHO <parts>" (see material/parser.cpp for
   *  the grammar); throws MaterialError. isa: as for LawTable::select(). */
  static std::unique_ptr<Material> create(const std::vector<std::string> &words,
                                          const char *isa = nullptr);

  /** Choose the instruction set (as for LawTable::select(); false: cannot run here) and the unit
   *  of density * velocity^2 in the unit of pressure, mvv2e * nktv2p of the LAMMPS unit style, and
   *  that of energy / volume, nktv2p; both 1 in consistent units and when this is not called. */
  virtual bool configure(const char *isa, double pressure_scale, double energy_scale) = 0;

  virtual double density() const = 0;    ///< reference density, its mean where points differ

  /** Reference density of a point with this history (as of initialize(); null when it has none). */
  virtual double density(const double *history) const = 0;

  virtual const std::vector<HistoryVariable> &history() const = 0;

  /** Does any law look at more of the deformation gradient than its determinant? */
  virtual bool uses_F() const = 0;

  /** A fluid whose pressure depends on its volume only: what points keep is J, and no history. */
  virtual bool is_barotropic() const = 0;
  /** Does it have a viscosity, of any kind? If not, the stress of a barotropic fluid is its pressure alone. */
  virtual bool is_viscous() const = 0;
  /** Does it resist a shear at rest? Not an equation of state with or without a viscosity. */
  virtual bool is_solid() const = 0;
  /** Does it bear nothing across the plane of its axes 1 and 2, so that it is for surfaces of elements only? */
  virtual bool is_of_surfaces() const = 0;

  /** Does its stress change with the temperature, by expansion or by parameters? Then it has the work
   *  THERMOELASTIC. */
  virtual bool is_thermoelastic() const = 0;

  /** Does it conduct heat? Then its history has the temperature and, if it melts, the molten fraction. */
  virtual bool conducts() const = 0;
  /** Of a point with this history (null: the mean of all points); varies: does that matter? */
  virtual Conduction conduction(const double *history) const = 0;
  virtual bool conduction_varies() const = 0;
  /** Heat per mass comes to a point with this history, whose temperature follows from the enthalpy
   *  (Conduction::by_enthalpy): temperature and molten fraction. */
  virtual void warm(double *history, double heat) const = 0;

  /** All history variables of a new point at x; throws std::runtime_error when it cannot be. */
  virtual void initialize(const double *x, double *history) const = 0;

  /** Many points were initialized: what is only needed for that may be freed. */
  virtual void initialized() const = 0;

  /** Stress of points that have none yet: the pressure of the equation of state in the present
   *  state, such as that of a gas. n, h, time and current F, J, history in the batch; sets stress,
   *  and A, dt, and Jold as for no motion. */
  virtual void initial_stress(Batch &) const = 0;

  /** Stress and history at the end of the step (hot: one call per batch). */
  virtual void update(Batch &) const = 0;

  /** Is there an analytic tangent? All laws of the material must have one. Damage has none, and neither have solids
   *  that melt, and bodies with thermal expansion that a compression warms. */
  virtual bool has_tangent() const = 0;

  /** The same as update(), to the last bit, and the tangent of this step; for materials that have one. Where the
   *  update has a kink, as at yield, it is the derivative on the side on which the step has ended. */
  virtual void update_with_tangent(Batch &, Tangent &) const = 0;

  /** Ranges of validity. They change nothing; whoever steps the material may look at them. */
  virtual const std::vector<ValidRange> &ranges() const = 0;

  /** value[n]: the quantity of range k after update(); returns the number of points outside. */
  virtual int outside(const Batch &, int k, double *value) const = 0;

  /** c[n]: speed of the fastest (longitudinal) wave at the present state, raised by a viscosity
   *  such that h/c is the stable time step; n, h and current F, J, stress, history in the batch, A
   *  and Jold are not set. */
  virtual void wave_speed(const Batch &, double *c) const = 0;

  /** w[n]: energy stored per reference volume in the present state (elastic, and of the equation
   *  of state); A and Jold are not set. */
  virtual void stored_energy(const Batch &, double *w) const = 0;

  /** One-line description for the log: names and values of the parts. */
  virtual std::string describe() const = 0;
};

}    // namespace MPM_NS
#endif
