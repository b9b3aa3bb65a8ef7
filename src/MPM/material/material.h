/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_MATERIAL_H
#define MPM_MATERIAL_MATERIAL_H

// Constitutive models: they take a batch of points and return stress and history. Nothing here
// knows about grids.

#include "law/batch.h"

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace MPM_NS {

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

/** An error in the definition of a material, and the word that causes it. */
struct MaterialError : std::runtime_error {
  int word;    ///< index of the word, or the number of words when something is missing at the end
  MaterialError(int word, const std::string &message) : std::runtime_error(message), word(word) {}
};

/** A constitutive model with its parameters; stateless, all state is in the batch. */
class Material {
 public:
  virtual ~Material() = default;

  /** A material from the words of its definition, "density RHO <parts>" (see material/parser.cpp
   *  for the grammar); throws MaterialError. isa: as for LawTable::select(). */
  static std::unique_ptr<Material> create(const std::vector<std::string> &words,
                                          const char *isa = nullptr);

  /** Chooses the instruction set (as for LawTable::select(); returns false if it cannot run here)
   *  and the scale factors: the unit of density * velocity^2 in units of pressure, mvv2e * nktv2p
   *  of the LAMMPS unit style, and that of energy / volume, nktv2p. Both are 1 in consistent units
   *  and when this is not called. */
  virtual bool configure(const char *isa, double pressure_scale, double energy_scale) = 0;

  virtual double density() const = 0;    ///< reference density; the mean if points differ

  /** Reference density of a point with this history (from initialize(); null if there is no
   *  history). */
  virtual double density(const double *history) const = 0;

  virtual const std::vector<HistoryVariable> &history() const = 0;

  /** Does any law use more of the deformation gradient than its determinant? */
  virtual bool uses_F() const = 0;

  /** Is it a fluid whose pressure depends on its volume only, so that points keep J but no
   *  history? */
  virtual bool is_barotropic() const = 0;
  /** Does it have a viscosity of any kind? Without one, the stress of a barotropic fluid is its
   *  pressure alone. */
  virtual bool is_viscous() const = 0;
  /** Does it resist shear at rest? An equation of state does not, with or without a viscosity. */
  virtual bool is_solid() const = 0;
  /** Does it carry no stress across the plane of its axes 1 and 2, so that only surfaces of
   *  elements can use it? */
  virtual bool is_of_surfaces() const = 0;

  /** Does its stress depend on temperature, by expansion or by its parameters? Then it reports the
   *  work THERMOELASTIC. */
  virtual bool is_thermoelastic() const = 0;

  /** Does it conduct heat? Then its history contains the temperature and, if it melts, the molten
   *  fraction. */
  virtual bool conducts() const = 0;
  /** Thermal properties of a point with this history (null: the mean of all points). */
  virtual Conduction conduction(const double *history) const = 0;
  /** Do the thermal properties depend on the history? */
  virtual bool conduction_varies() const = 0;
  /** Adds heat [energy/mass] to a point whose temperature follows from the enthalpy
   *  (Conduction::by_enthalpy): updates temperature and molten fraction in its history. */
  virtual void warm(double *history, double heat) const = 0;

  /** Sets all history variables of a new point at x; throws std::runtime_error if that is not
   *  possible. */
  virtual void initialize(const double *x, double *history) const = 0;

  /** To be called after points were initialized: frees memory that is needed only for that. */
  virtual void initialized() const = 0;

  /** Initial stress of points: the pressure of the equation of state in the present state, for
   *  example of a gas. The batch has n, h, time and the current F, J, history; sets stress, and
   *  sets A, dt, and Jold as for no motion. */
  virtual void initial_stress(Batch &) const = 0;

  /** Stress and history at the end of the step (hot: one call per batch). */
  virtual void update(Batch &) const = 0;

  /** Is there an analytic tangent? All laws of the material must have one. There is none with
   *  damage, for solids that melt, and for materials with thermal expansion that compression
   *  warms. */
  virtual bool has_tangent() const = 0;

  /** Does what update() does, bit for bit, and also computes the tangent of the step; only for
   *  materials that have one. At a kink of the update, as at yield, the tangent is the derivative
   *  on the side where the step ends. */
  virtual void update_with_tangent(Batch &, Tangent &) const = 0;

  /** Ranges of validity. They do not affect the update; callers may check them with outside(). */
  virtual const std::vector<ValidRange> &ranges() const = 0;

  /** value[n]: the quantity of range k after update(). Returns the number of points outside the
   *  range. */
  virtual int outside(const Batch &, int k, double *value) const = 0;

  /** c[n]: speed of the fastest (longitudinal) wave in the present state, without viscosity. The
   *  batch has n, h and the current F, J, stress, history; A and Jold are not set. */
  virtual void elastic_speed(const Batch &, double *c) const = 0;
  /** Raises c[n] for viscosity such that h/c is the stable time step; batch: as elastic_speed(). */
  virtual void raise_speed(const Batch &, double *c) const = 0;
  /** Both. */
  void wave_speed(const Batch &b, double *c) const
  {
    elastic_speed(b, c);
    raise_speed(b, c);
  }

  /** w[n]: energy stored per reference volume in the present state (elastic energy and that of the
   *  equation of state). In the batch, A and Jold are not set. */
  virtual void stored_energy(const Batch &, double *w) const = 0;

  /** One-line description for the log: names and values of the parts. */
  virtual std::string describe() const = 0;
};

/** Heat per mass that a point of a conducting material has gained since the start, from its initial
 *  temperature to the temperature in this history, including the heat of fusion of the molten part
 *  [energy/mass]; negative if the point has cooled. */
double heat_since_start(const Material &, const double *history);

/** Does any conductivity of this material depend on temperature? */
bool conductivity_varies_with_temperature(const Material &);

/** As Material::conduction(), but with the conductivities averaged over the temperatures from low
 *  to high. */
Conduction mean_conduction(const Material &, const double *history, double low, double high);

}    // namespace MPM_NS
#endif
