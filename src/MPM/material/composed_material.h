/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_COMPOSED_MATERIAL_H
#define MPM_MATERIAL_COMPOSED_MATERIAL_H

#include "law/heat_curve.h"
#include "material/parts.h"
#include "material/phase_field.h"
#include "material/softening.h"

#include <cstring>
#include <functional>
#include <iterator>
#include <optional>

namespace MPM_NS {

/** Thermal expansion of the points of a batch, given by the stretch theta = exp[ALPHA (T - T0)]. */
struct ThermalStretch {
  double before[BATCH], now[BATCH];    ///< 1/theta at the start and the end of a step
  double change[BATCH];                ///< change of ln theta in the step

  /** theta^3 at the end of the step. */
  double volume(int i) const { return 1.0 / (now[i] * now[i] * now[i]); }
};

/** Rows of a batch that get their values of now back, bit for bit, when this object ends. */
template <class Rows> struct Restored {
  Rows &rows, was;

  explicit Restored(Rows &rows) : rows(rows) { memcpy(was, rows, sizeof(Rows)); }
  ~Restored() { memcpy(rows, was, sizeof(Rows)); }
  Restored(const Restored &) = delete;
  Restored &operator=(const Restored &) = delete;
};

/** Removes the thermal stretch from the motion of a batch while this object exists. The laws then
 *  see F_e = F/theta, J_e = J/theta^3, the increment A_e of the same step with I + A_e = (I + A)
 *  theta_old/theta, and, as initial volume, the stress-free volume V_0 theta^3 of a point (V.A.
 *  Lubarda, Appl. Mech. Rev. 57 (2004) 95: F = F_e F_theta, with a stress that is a function of
 *  F_e). Their energies are then per volume of the expanded material.
 */
class ElasticMotion {
 public:
  /** with_F: a law uses F, so that F is changed, too. */
  ElasticMotion(Batch &b, const ThermalStretch &s, bool with_F) :
      A(b.A), J(b.J), Jold(b.Jold), vol0(b.vol0)
  {
    if (with_F) F.emplace(b.F);
    double ratio[BATCH];
    for (int i = 0; i < b.n; i++) {
      const double now = s.now[i], before = s.before[i];
      ratio[i] = now / before;
      b.J[i] = now * now * now * J.was[i];
      b.Jold[i] = before * before * before * Jold.was[i];
      b.vol0[i] = s.volume(i) * vol0.was[i];
    }
    for (int k = 0; k < 9; k++) {
      const double diagonal = k % 4 == 0 ? 1.0 : 0.0;
      for (int i = 0; i < b.n; i++)
        b.A[k][i] = ratio[i] * A.was[k][i] + diagonal * (ratio[i] - 1.0);
      for (int i = 0; with_F && i < b.n; i++) b.F[k][i] = s.now[i] * F->was[k][i];
    }
  }

 private:
  Restored<double[9][BATCH]> A;
  std::optional<Restored<double[9][BATCH]>> F;
  Restored<double[BATCH]> J, Jold, vol0;
};

/** A material made of laws: the order in which they work on a batch, what they know of each other,
 *  their rows of history, and their parameters where these differ from point to point. Its
 *  functions are in files by what they are for: composed_material.cpp makes it of a definition and
 *  binds the kernels, _stress makes a step, _heat has what depends on temperature, and _varying
 *  parameters that differ between points. */
class ComposedMaterial : public Material {
 public:
  ComposedMaterial(const MaterialDefinition &definition, const LawTable *table);
  bool configure(const char *isa, double pressure_scale, double energy_scale) override;
  double density() const override { return rho; }
  double density(const double *history) const override
  {
    return random_density ? rho * history[random_density->row] : rho;
  }
  const std::vector<HistoryVariable> &history() const override { return variables; }
  bool uses_F() const override { return shape_matters; }
  bool is_barotropic() const override { return eos && !base && !damage && variables.empty(); }
  bool is_viscous() const override;
  bool is_solid() const override;
  bool is_of_surfaces() const override;
  std::string describe() const override { return text; }
  void initialize(const double *x, double *history) const override;
  bool is_thermoelastic() const override { return stress_temperature >= 0; }
  bool conducts() const override { return thermal && thermal->info->conduction; }
  bool conduction_varies() const override
  {
    return conducts() && (!thermal->random.empty() || !conducting.empty() || is_curved());
  }
  Conduction conduction(const double *history) const override;
  /** For mean_conduction(). */
  bool conductivity_varies() const { return conducts() && !conducting.empty(); }
  Conduction conduction(const double *history, double low, double high) const;
  void warm(double *history, double heat) const override;
  std::optional<SofteningRange> softening() const;    ///< see softening_range()
  /** See phase_field_cracks() of phase_field.h. */
  std::optional<PhaseFieldCracks> phase_field_cracks() const;
  /** See heat_since_start(). */
  double heat_of(const double *history) const;
  void initialized() const override;
  void initial_stress(Batch &b) const override;
  void update(Batch &b) const override { update(b, nullptr); }
  bool has_tangent() const override;
  void update_with_tangent(Batch &b, Tangent &t) const override;
  const std::vector<ValidRange> &ranges() const override { return valid; }
  int outside(const Batch &b, int k, double *value) const override;
  void elastic_speed(const Batch &state, double *c) const override;
  void raise_speed(const Batch &b, double *c) const override;
  void stored_energy(const Batch &state, double *w) const override;

 private:
  double rho;
  double rho_pressure;    ///< density in units of pressure over velocity^2, as the laws need it
  const LawTable *table;
  std::vector<UsedLaw> laws;                                ///< in the order of their parts
  const UsedLaw *base;                                      ///< closed law or strength, or null
  const UsedLaw *eos, *damage, *thermal;                    ///< or null
  std::unique_ptr<const RandomParameter> random_density;    ///< when it differs from point to point
  bool shape_matters = false;                               ///< does a law look at F?
  bool speed_matters = false;    ///< does a viscosity look at batch.speed?
  bool random_heat = false;      ///< does what others take from the thermal part differ?
  /** First of six history variables with what viscosities added to the stress in the last step, for
   *  a closed law or strength that builds on that stress and must not see it; -1 when not
   *  needed. */
  int viscous = -1;
  /** History variable with the temperature to which the stress belongs, when stress depends on it
   *  by expansion or by parameters: conduction and heat may have changed the temperature since.
   *  Else -1. */
  int stress_temperature = -1;
  bool expands = false;                           ///< does it have thermal expansion?
  std::vector<VaryingConductivity> conducting;    ///< those that depend on the temperature
  Conduction mean_conduction = {};                ///< without what differs from point to point
  std::unique_ptr<const TemperatureFactor> capacity_factor;    ///< of the specific heat; or null
  struct {
    double point, latent, range;
  } melting = {};    ///< TMELT, LATENT, and DT of a thermal part
  /** First of nheated history variables with the temperature, and the molten fraction, that the
   *  internal energy of an equation of state knows of: conduction may have changed them since. -1:
   *  not needed. */
  int heated = -1, nheated = 0;
  /** History variable with heat of a damaged point that its temperature has, and its internal
   *  energy has not got yet; -1: not needed. */
  int unspent_heat = -1;
  /** History variable with the solid share to which the stress belongs, when what melts becomes a
   *  liquid with a viscosity of its own; else -1. molten: the one with the molten fraction. */
  int solid = -1, molten = -1;
  std::vector<HistoryVariable> variables;
  std::vector<ValidRange> valid;
  std::vector<int> source;    ///< of the quantities of these, as in UsedRange
  std::string text;

  // making it of a definition

  using Fits = std::function<bool(const UsedLaw &, const Parameter &)>;
  /** A parameter that was added and depends on the temperature. */
  struct Varied {
    const UsedVary &given;
    const UsedLaw *owner;
    ParameterPlace place;
  };
  void add(UsedLaw &law);
  void add(const UsedRange &range);
  void add(const UsedRandom &random);
  /** A parameter that depends on the temperature; a thermal one is in range at all temperatures. */
  void add(const UsedVary &vary, std::vector<Varied> &varied);
  /** It is in its range, and its law can be with all that varies, at all temperatures. */
  static void check(const Varied &v);
  /** A parameter by its name, NAME or LAW.NAME, where LAW is the name of the part or of the closed
   *  law or, of viscosities, as there may be several, that of the law. Parameters of terms are
   *  NAME1, NAME2, ... Null: there is none with this name. choice: adds all names that fit; what,
   *  word: for the error message. */
  UsedLaw *find_parameter(const std::string &wanted, ParameterPlace &place, std::string &choice,
                          const std::string &what, int word, const Fits &fits);
  /** Kernels of all parts, and what they take from each other. */
  void bind(double pressure_scale, double energy_scale);
  /** What a law takes from a thermal part with parameters t. With a damage all plastic work goes
   *  to batch.heat, for account_of_strength(). */
  static void share_heat(const LawInfo &info, const LawParameters &t, bool heats_alone,
                         LawParameters &p);
  /** Does what share_heat() gives differ from point to point? */
  bool random_heats() const;
  /** A material with an internal energy, to which fix mpm/heat brings heat. */
  void expand_by_conducted_heat();
  /** A material with an internal energy and a damage, whose work is heat. */
  void expand_by_heat_of_fracture();
  /** A material whose stress depends on the temperature, by expansion or by parameters. */
  void depend_on_temperature();
  void melt_and_solidify();

  // a step

  /** A step, and its tangent if t is not null. */
  void update(Batch &b, Tangent *t) const;
  /** Stress and history at the end of the step, and heat per reference volume, but not what heat
   *  does to the temperature. */
  void make_stress(Batch &b, Tangent *t) const;
  /** The thermal part, after all others. */
  void find_temperature(Batch &b) const;
  /** The damage. An internal energy gets the heat of it in the next step: had it got that in this
   *  one, its pressure would not be the one that has done the work. */
  void run_damage(Batch &b) const;
  /** The equation of state. Its internal energy gets what conduction has brought since the last
   *  step, and what the damage has left for it, too, as heat of this one, which the temperature
   *  knows of already. */
  void run_eos(Batch &b, Tangent *t) const;
  /** What the strength has done, for a damage; heat that the equation of state shall have. */
  void account_of_strength(Batch &b) const;
  void plain_speed(const Batch &b, double *c) const;
  /** Energy per reference volume that the laws have stored, those of a batch without thermal
   *  stretch. */
  void energy_of_laws(const Batch &state, double *w) const;
  /** Energy stored by one law, added to w. */
  void add_energy(const UsedLaw *law, const Batch &b, double *w) const;
  /** The strength of the solid part of the points. The elastic energy of shear that melts or is
   *  diluted is heat, and counts as plastic work. */
  void run_solid(Batch &b) const;
  /** Energy of the strength, which only the solid part stores. */
  void add_energy_of_solid(const Batch &state, double *w) const;
  /** A viscosity of the molten part of the points. */
  void run_liquid(const UsedLaw &law, Batch &b) const;
  /** Stress of a material without strength. */
  static void clear_stress(Batch &b)
  {
    for (auto &row : b.stress) std::fill(row, row + b.n, 0.0);
  }
  /** Calls work with the stress and what viscosities added to it, when that is kept apart. */
  template <class Work> void with_viscous_stress(Batch &b, Work work) const;
  void take_viscous_stress(Batch &b) const;
  const Batch &without_viscous_stress(const Batch &b, Batch &copy) const;

  // heat and temperature

  /** The thermal part of a material with an internal energy, or null. */
  const UsedLaw *heating_of_energy() const;
  /** Adds what a damage has left for the internal energy. In tension, which a damaged point does
   *  not bear, that has the work of the undamaged material, and takes it back on the way to
   *  compression. Less would come back if heat came on the way, and the energy keep work that
   *  nobody has done: so this heat, and what is conducted to a failed point, waits. */
  void spend_heat(Batch &b, double *brought) const;
  /** Heat per reference volume. */
  void find_conducted_heat(const Batch &b, double *heat) const;
  /** Heat per mass from one temperature and molten fraction to another. */
  double heat_between(const Conduction &c, double T0, double f0, double T, double f) const;
  /** What an internal energy knows of, see heated. */
  void remember_heat(Batch &b) const;
  /** Initial temperature of a point, at which it has no thermal strain. */
  double first_temperature(const double *history, int stride) const;
  /** Thermal stretch at the temperatures now and before, of the points of a batch. */
  ThermalStretch stretch_of(const Batch &b, const double *before, const double *now) const;
  /** The one to which the stress belongs. */
  ThermalStretch stretch_of(const Batch &b) const
  {
    return stretch_of(b, b.history[stress_temperature], b.history[stress_temperature]);
  }
  /** A step of a material whose stress depends on the temperature. The temperature is that of the
   *  end of the step but for the heat that the step makes. What stress loses or gains by the change
   *  of temperature is the work THERMOELASTIC: that of the stress on the thermal strain, and, at
   *  the same stress or deformation gradient, whatever a law keeps, the change of the stored
   *  energy. */
  void update_by_temperature(Batch &b, Tangent *t) const;
  /** Adds the stored energy with the temperatures before minus that with those of now, in the
   *  elastic state of now. */
  void add_energy_of_warming(Batch &b, const double *before, const ThermalStretch *s,
                             double *work) const;
  /** Wave speed with thermal expansion, which a compression that warms makes faster. */
  void expanded_speed(const Batch &state, double *c) const;
  /** Gruneisen parameter 3 K ALPHA/(density CP) of a thermal part that asks for it: an elastic body
   *  that expands when it is warmed is warmed when it is compressed (M.A. Biot, J. Appl. Phys. 27
   *  (1956) 240). */
  void find_consistent_coupling();
  /** The same of a point with the initial values of its history variables, at its first
   *  temperature. */
  double consistent_gruneisen(std::vector<double> initial) const;
  double youngs_modulus() const;
  /** Bulk modulus without stress, from two small compressions. */
  double bulk_modulus(std::vector<double> initial) const;
  double thermal_value(const char *name) const;
  /** Does heat give the temperature by the enthalpy? */
  bool is_curved() const { return thermal && thermal->parameters.curved; }
  void make_heat_curve(UsedLaw &of);
  law::HeatCurve heat_curve() const;

  // parameters that vary

  /** Parameters of a law at one point after the other. */
  class LocalParameters {
   public:
    LocalParameters(const ComposedMaterial &, const UsedLaw &);
    LocalParameters(const LocalParameters &) = delete;

    /** At the point with the values history[0], history[stride], ... of its history variables, and
     *  the temperature to which its stress belongs, or, of shares of heat alone, that of now. */
    const LawParameters &at(const double *history, int stride);
    const LawParameters &at(const double *history, int stride, double temperature);

   private:
    const ComposedMaterial &material;
    const UsedLaw &law;
    LawParameters p, heat;

    static void replace(const UsedLaw &, LawParameters &, const double *history, int stride,
                        double temperature);
  };
  /** Factor of a parameter at x; it must keep the parameter in the range that it is declared
   *  with. */
  static void set_factor(const RandomParameter &r, const Parameter &declared, double mean,
                         const double *x, double *history);
  static void check_range(const Parameter &declared, double value);
  /** History of a law at a new point with these parameters. */
  /** Energy that the equation of state has, without its dissipated part; history of a point, with
   *  this stride. */
  double internal_energy(const double *history, int stride) const;
  static void initialize(const UsedLaw &law, const LawParameters &p, const double *x,
                         double *history);
  static bool is_capacity(const Parameter &declared) { return !strcmp(declared.name, "CP"); }
  static bool is_conductivity(const Parameter &declared);
  /** Is it a share of work that becomes heat? */
  static bool is_share(const Parameter &declared);
  /** Can a parameter depend on the temperature? */
  static bool can_vary(const UsedLaw &law, const Parameter &declared);
  /** Knots of all factors of a law, and some temperatures between them: what parameters must be
   *  together need not hold between knots because it holds there. */
  static std::vector<double> temperatures_to_check(const UsedLaw &law);

  // kernels, of all points or of one after the other

  static History rows(const Batch &b, const UsedLaw &law)
  {
    return b.history ? b.history + law.history : nullptr;
  }
  /** The rows of a batch but A, F, stress, and history. */
  static constexpr double (Batch::*single_rows[])[BATCH] = {&Batch::J,
                                                            &Batch::Jold,
                                                            &Batch::vol0,
                                                            &Batch::heat,
                                                            &Batch::plastic,
                                                            &Batch::speed,
                                                            &Batch::kept,
                                                            &Batch::plastic_work,
                                                            &Batch::viscous_mean,
                                                            &Batch::shear_energy,
                                                            &Batch::volume_energy};
  static_assert(sizeof(Batch) < (9 + 9 + 6 + std::size(single_rows) + 1) * BATCH * sizeof(double),
                "all rows are listed");
  /** Update by a law, if there is one. */
  void run(const UsedLaw *law, Batch &b) const;
  /** The same, and its tangent if t is not null. */
  void run(const UsedLaw *law, Batch &b, Tangent *t) const;
  /** A kernel that changes a batch. */
  void call(void (*kernel)(const LawParameters &, Batch &, History), const UsedLaw &law,
            Batch &b) const;
  /** A kernel that adds to values of the points. */
  void call(void (*kernel)(const LawParameters &, const Batch &, History, double *),
            const UsedLaw &law, const Batch &b, double *value) const;
  /** What a kernel has changed in the batch of point i of another one. */
  static void take_back(const Batch &one, int i, Batch &b);
  /** Calls work for each point in a batch of its own, with its own parameters. The history is not
   *  copied: its rows are those of the batch, beginning with the point. */
  template <class Work> void one_by_one(const UsedLaw &law, const Batch &b, Work work) const;
};

}    // namespace MPM_NS
#endif
