/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_MATERIAL_H
#define MPM_MATERIAL_MATERIAL_H

// Constitutive models: they take a batch of points and return stress and history. Nothing here knows
// about grids, and only the parser knows about LAMMPS (for its error messages).

#include "transfer/kernels.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace MPM_NS {

/** Kinds of work that a law reports, as energies summed over the points of a batch. */
enum Work {
  PLASTIC,          ///< plastic work
  VISCOUS,          ///< work of viscous stress
  HEAT,             ///< part of the plastic and viscous work that became heat
  FRACTURE,         ///< work spent on damage, and on friction between fragments
  THERMOELASTIC,    ///< work of stress on thermal strain, and by moduli that change with temperature
  NWORK
};

/** Up to BATCH points of one material in structure-of-arrays form.
 *
 *  Kinematics: A = dt * grad v with respect to the positions at the start of the step, so that the
 *  motion x + dt v of the points gives exactly F_new = (I + A) F_old. The velocity gradient in the
 *  middle of the step is G/dt with G = A (I + A/2)^-1; I + A is the Cayley transform of G, a rotation
 *  when G is skew. Rate-form laws use G (sym: strain increment, skew: incremental rotation).
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

/** Algorithmic tangent of a step: derivatives of the discrete update, not of the rates that it approximates, so that a
 *  Newton iteration converges quadratically (J.C. Simo, R.L. Taylor, Comput. Methods Appl. Mech. Eng. 48 (1985) 101).
 *  For a change l = dF F^-1 of the motion, with F at the end of the step,
 *
 *    d(J sigma)_k = sum_j stress[k][j] l_j
 *
 *  where l_j is row-major (l_xx, l_xy, ...) and k in the order of Batch::stress. The change of the first Piola-Kirchhoff
 *  stress P = J sigma F^-T is [d(J sigma) - J sigma l^T] F^-T.
 */
struct Tangent {
  /** Input: if true, only motions in the xy plane and around an axis (zz) are needed; other columns are not written. */
  bool plane = false;
  alignas(64) double stress[6][9][BATCH];    ///< tangent of the Kirchhoff stress J sigma
  alignas(
      64) double heat[9]
                     [BATCH];    ///< tangent of Batch::heat, passed between the parts of a material

  /** Is column l not needed? */
  bool skips(int l) const { return plane && (l == 2 || l == 5 || l == 6 || l == 7); }
};

/** A history variable of a material. */
struct HistoryVariable {
  std::string name;    ///< as used by compute mpm/atom
  double initial;      ///< value of a new point, before Material::initialize()
};

/** Range of values of a quantity within which a material is valid. */
struct ValidRange {
  std::string quantity;    ///< pressure, rate, density, or name of a history variable
  double low, high;
};

/** Melting at a single temperature: how heat changes the temperature and the molten fraction. */
struct Melting {
  double temperature;    ///< melting temperature
  double range;          ///< heat of fusion over specific heat; 0: does not melt

  /** Updates T and the molten fraction to equilibrium at constant enthalpy. On input, T is the temperature
   *  at the previous molten fraction. */
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
  bool
      orthotropic;    ///< axes are those of the reference configuration, and turn with the material
  double across[2];     ///< conductivity along axes 2 and 3
  double axis[3][3];    ///< unit vectors along the axes

  /** The largest conductivity. */
  double most() const
  {
    return orthotropic ? std::max(conductivity, std::max(across[0], across[1])) : conductivity;
  }
};

/** An error in the definition of a material, and the word that causes it. */
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

  /** Chooses the instruction set (as for LawTable::select(); returns false if it cannot run here) and
   *  the scale factors: the unit of density * velocity^2 in units of pressure, mvv2e * nktv2p of the
   *  LAMMPS unit style, and that of energy / volume, nktv2p. Both are 1 in consistent units and when
   *  this is not called. */
  virtual bool configure(const char *isa, double pressure_scale, double energy_scale) = 0;

  virtual double density() const = 0;    ///< reference density; the mean if points differ

  /** Reference density of a point with this history (from initialize(); null if there is no history). */
  virtual double density(const double *history) const = 0;

  virtual const std::vector<HistoryVariable> &history() const = 0;

  /** Does any law use more of the deformation gradient than its determinant? */
  virtual bool uses_F() const = 0;

  /** Is it a fluid whose pressure depends on its volume only, so that points keep J but no history? */
  virtual bool is_barotropic() const = 0;
  /** Does it have a viscosity of any kind? Without one, the stress of a barotropic fluid is its pressure alone. */
  virtual bool is_viscous() const = 0;
  /** Does it resist shear at rest? An equation of state does not, with or without a viscosity. */
  virtual bool is_solid() const = 0;
  /** Does it bear no stress across the plane of its axes 1 and 2, so that only surfaces of elements can use it? */
  virtual bool is_of_surfaces() const = 0;

  /** Does its stress depend on temperature, by expansion or by its parameters? Then it reports the work
   *  THERMOELASTIC. */
  virtual bool is_thermoelastic() const = 0;

  /** Does it conduct heat? Then its history contains the temperature and, if it melts, the molten fraction. */
  virtual bool conducts() const = 0;
  /** Thermal properties of a point with this history (null: the mean of all points). */
  virtual Conduction conduction(const double *history) const = 0;
  /** Do the thermal properties depend on the history? */
  virtual bool conduction_varies() const = 0;
  /** Adds heat [energy/mass] to a point whose temperature follows from the enthalpy
   *  (Conduction::by_enthalpy): updates temperature and molten fraction in its history. */
  virtual void warm(double *history, double heat) const = 0;

  /** Sets all history variables of a new point at x; throws std::runtime_error if that is not possible. */
  virtual void initialize(const double *x, double *history) const = 0;

  /** To be called after points were initialized: frees memory that is needed only for that. */
  virtual void initialized() const = 0;

  /** Initial stress of points: the pressure of the equation of state in the present state, for example
   *  of a gas. The batch has n, h, time and the current F, J, history; sets stress, and sets A, dt, and
   *  Jold as for no motion. */
  virtual void initial_stress(Batch &) const = 0;

  /** Stress and history at the end of the step (hot: one call per batch). */
  virtual void update(Batch &) const = 0;

  /** Is there an analytic tangent? All laws of the material must have one. There is none with damage, for solids
   *  that melt, and for materials with thermal expansion that compression warms. */
  virtual bool has_tangent() const = 0;

  /** Does what update() does, bit for bit, and also computes the tangent of the step; only for materials that have
   *  one. At a kink of the update, as at yield, the tangent is the derivative on the side where the step ends. */
  virtual void update_with_tangent(Batch &, Tangent &) const = 0;

  /** Ranges of validity. They do not affect the update; callers may check them with outside(). */
  virtual const std::vector<ValidRange> &ranges() const = 0;

  /** value[n]: the quantity of range k after update(). Returns the number of points outside the range. */
  virtual int outside(const Batch &, int k, double *value) const = 0;

  /** c[n]: speed of the fastest (longitudinal) wave in the present state, increased for viscosity such
   *  that h/c is the stable time step. The batch has n, h and the current F, J, stress, history; A and
   *  Jold are not set. */
  virtual void wave_speed(const Batch &, double *c) const = 0;

  /** w[n]: energy stored per reference volume in the present state (elastic energy and that of the
   *  equation of state). In the batch, A and Jold are not set. */
  virtual void stored_energy(const Batch &, double *w) const = 0;

  /** One-line description for the log: names and values of the parts. */
  virtual std::string describe() const = 0;
};

}    // namespace MPM_NS
#endif
