/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_LAW_H
#define MPM_LAW_LAW_H

// What a constitutive law declares (its parameters and history) and the kernels it provides.
//
// A law is a struct in a header, with the declaration and the loops over a batch, which is added to
// its list in law/list.h; nothing else has to change. The headers are compiled once for each
// instruction set, see law/list.h, and once more without special options by law/registry.cpp, which
// reads the declarations only. All of their content is in unnamed namespaces, so that the linker
// cannot take a function of one instruction set for that of another.

#include "declare/range.h"
#include "law/batch.h"

#include <cstddef>
#include <deque>
#include <limits>
#include <string>
#include <vector>

#define MPM_INLINE inline __attribute__((always_inline))

// Loops over the points of a batch, without and with sums; MPM_ISA is set when kernels are
// compiled.
#ifdef MPM_ISA
#define MPM_PRAGMA(x) _Pragma(#x)
#define MPM_SIMD MPM_PRAGMA(omp simd)
#define MPM_SIMD_SUM(...) MPM_PRAGMA(omp simd reduction(+ : __VA_ARGS__))
#else
#define MPM_SIMD
#define MPM_SIMD_SUM(...)
#endif

namespace MPM_NS {

constexpr double REQUIRED = std::numeric_limits<double>::quiet_NaN();    ///< no default value
constexpr const char *FLAG = "flag";    ///< unit of an option without a value: 1 when given
constexpr bool OF_NEW_POINTS = true;    ///< last word of a declaration, see Parameter

/** Declaration of one parameter.
 *
 *  Positional parameters (those without an option) come first, in this order; those of them that
 *  have a default are given all together or not at all. The other parameters follow the words of
 *  their option. Options may come in any order; options that begin with the same word exclude each
 *  other. */
struct Parameter {
  const char *option;    ///< word or words that introduce it, "" when positional
  const char *name;      ///< as in the manual
  const char *unit;      ///< kind of unit: pressure, velocity, viscosity, temperature, ..., or 1
  Range range;
  double standard;    ///< default value, or REQUIRED
  const char *meaning;
  /** Does it only set the state of new points? Then it cannot vary with temperature. */
  bool of_new_points = false;
};

constexpr Parameter YOUNGS_MODULUS = {"", "E", "pressure", POSITIVE, REQUIRED, "Young's modulus"};
constexpr Parameter POISSONS_RATIO = {"", "NU", "1", POISSON_RATIO, REQUIRED, "Poisson's ratio"};
constexpr Parameter SHEAR_MODULUS = {"", "G", "pressure", POSITIVE, REQUIRED, "shear modulus"};
constexpr Parameter BULK_MODULUS = {"", "K", "pressure", POSITIVE, REQUIRED, "bulk modulus"};

/** Declaration of one history variable. */
struct HistoryDeclaration {
  const char *name;    ///< as used by compute mpm/atom
  int initial;         ///< index of the parameter that is its initial value, or one of those below
  const char *unit;    ///< kind of unit, as for parameters
  const char *meaning;
};
/** Initial values of history variables: 0, 1, or the value that initialize() sets. */
enum { ZERO = -1, ONE = -2, INITIALIZED = -3 };
constexpr HistoryDeclaration PLASTIC_STRAIN = {"eplastic", ZERO, "1", "equivalent plastic strain"};

/** Parts of the stress: of a law, the parts of the old stress that its update starts from; of a
 *  viscosity, the parts to which it adds. Where these overlap, the material stores the viscous
 *  stress separately and hides it from the law. */
enum StressShare { NO_SHARE = 0, PRESSURE = 1, DEVIATOR = 2, WHOLE_STRESS = 3 };

/** Places of laws in a material, in the order of their history variables. */
enum Part { CLOSED, EOS, STRENGTH, VISCOSITY, DAMAGE, THERMAL, NPARTS };

/** Values of the parameters of a law as its kernels receive them, with what the kernels need from
 *  other parts of the material. */
struct LawParameters {
  static constexpr int MAX = 32, MAX_TERMS = 32, TERM = 4;
  double density;       ///< reference density, in pressure / velocity^2
  double value[MAX];    ///< in the order of the declaration
  int nterms;
  double term[MAX_TERMS][TERM];    ///< values of the repeated option, in the order they are given

  double heat_density;    ///< reference density, in pressure / (unit of CP * temperature)
  double chi;             ///< share of the plastic work that becomes heat
  double broken;          ///< share of the work of damage that becomes heat
  double warm;        ///< temperature rise per heat of unit reference volume; 0: no thermal part
  int temperature;    ///< row of the temperature in batch.history, -1: no thermal part
  bool curved = false;    ///< of a thermal part: do its terms hold the knots of a HeatCurve?
};

/** Rows of history variables of a batch, [variable][point], from the first variable of a law on. */
using History = double (*)[BATCH];

/** Temperature of the points of a batch, or null when the material has no thermal part. */
inline __attribute__((always_inline)) double *temperature(const LawParameters &p, const Batch &b)
{
  return p.temperature < 0 ? nullptr : b.history[p.temperature];
}

/** Declaration of a law. The first words of a comment name the kind of law to which a member
 *  applies. */
struct LawInfo {
  const char *name;
  const char *meaning;
  /** Parts of the old stress that it starts from; of a viscosity: parts to which it adds. */
  StressShare share;
  const Parameter *parameters;
  int nparameters;
  const char *term;    ///< option that may be given several times, or null
  const Parameter *term_parameters;
  int nterm_parameters;
  const HistoryDeclaration *history;
  int ndeclared;                             ///< entries of history
  const HistoryDeclaration *term_history;    ///< one set for each term, names followed by 1, 2, ...
  int nterm_history;
  /** Number of history variables that a law with these parameters uses. Null: all. */
  int (*nhistory)(const LawParameters &);
  bool uses_speed;    ///< of a viscosity: does update() read batch.speed?
  bool uses_F;        ///< does any kernel read batch.F? Otherwise only J and A
  /** Of an equation of state: does it have an internal energy that heat raises, so that it expands
   *  when heated? Then the option 'expansion' is not allowed with it. Unless it also finds the
   *  temperature, batch.heat contains the heat of conduction and of the damage of the last step
   *  when it is updated. */
  bool expands;
  /** Of an equation of state: does the temperature follow from its internal energy? Then other
   *  parts change the temperature only through heat, and the first two rows of its history are the
   *  internal energy and the dissipated part of it. The heat of conduction and of damage is added
   *  to both before the update. */
  bool finds_temperature;
  /** Strengths: history variable that is the elastic energy, as a sum over steps; -1: the energy
   *  follows from the stress. */
  int energy_kept;
  /** Of a closed law: does it carry no stress across the plane of its axes 1 and 2, so that it can
   *  be used for surfaces only? */
  bool of_surfaces;
  /** Error message for parameters that are each within range but not valid together; null if they
   *  are valid. */
  const char *(*check)(const LawParameters &);
  /** Does a law with these parameters need the temperature, and therefore a thermal part? */
  bool (*needs_temperature)(const LawParameters &);
  /** Of a thermal part: share of the plastic work that becomes heat. */
  double (*heat_share)(const LawParameters &);
  /** Of a thermal part: temperature rise per heat per reference volume. */
  double (*warming)(const LawParameters &);
  /** Of a thermal part: share of the work of damage that becomes heat. Null: none. */
  double (*fracture_share)(const LawParameters &);
  /** Of a thermal part that conducts heat: data of the conduction. Null: none. */
  Conduction (*conduction)(const LawParameters &);
  /** Of a thermal part: coefficient of linear thermal expansion [1/temperature]. Null: none. */
  double (*expansion)(const LawParameters &);
  int gruneisen;    ///< of a thermal part: index of the Gruneisen parameter, -1: none
  /** Of a thermal part with expansion: does the material compute the Gruneisen parameter from its
   *  bulk modulus? Null: never. */
  bool (*consistent)(const LawParameters &);
  /** Sets the history of a new point at x. history: the values of the variables, one after the
   *  other; in: initial values. Null: keep the initial values. */
  void (*initialize)(const LawParameters &, const double *x, double *history);

  /** Number of history variables, without those of the terms. */
  int count_history(const LawParameters &p) const { return nhistory ? nhistory(p) : ndeclared; }
};

/** List of the declarations of laws. References to them stay valid when laws are added. */
using LawList = std::deque<LawInfo>;
/** Declarations of all laws for one place in a material: those of law/list.h in the order of the
 *  lists, then those of plugins. */
const LawList &declared_laws(Part);

/** Kernels of a law; those that do not apply to it are null.
 *
 *  Energies are per reference volume. The parts of a composed material update one batch in turn:
 *    - a damage restores the undamaged stress (prepare);
 *    - a strength computes the deviator of the stress;
 *    - viscosities add to the stress;
 *    - the equation of state subtracts the pressure;
 *    - a damage reduces the stress;
 *    - a thermal part turns batch.heat into a change of temperature.
 *
 *  A closed law computes the whole stress. Damage is invisible to the other parts: it corrects the
 *  plastic work and heat that they have recorded. */
struct LawKernels {
  /** Computes stress and history at the end of the step. Adds the work of the batch to batch.work
   *  and the heat of the points to batch.heat; stores the increments of the equivalent plastic
   *  strain in batch.plastic. */
  void (*update)(const LawParameters &, Batch &, History);

  /** Adds to k[n] the contribution of this part to reference density * (wave speed)^2, that is J d
   *  sigma_nn / d epsilon_nn for a small uniaxial strain on top of the present state. */
  void (*modulus)(const LawParameters &, const Batch &, History, double *k);

  /** Adds the stored energy to w[n]. A damage receives in w[n] the energy of the equation of state
   *  and replaces it by that of the damaged material; the energy() of the strength is then not
   *  called. */
  void (*energy)(const LawParameters &, const Batch &, History, double *w);

  /** Of a viscosity: raises c[n] so that h / c[n] is the stable time step with this viscosity. */
  void (*raise_speed)(const LawParameters &, const Batch &, History, double *c);

  /** Runs before the other parts. A damage restores the stress of the undamaged material and stores
   *  in batch.kept the share of the deviator that was left. A thermal part applies the change of
   *  temperature by compression if stress depends on temperature: stress and heat then belong to
   *  the same time, and their coupling creates no energy. */
  void (*prepare)(const LawParameters &, Batch &, History);

  /** Does the same as update(), bit for bit, and adds the contribution of this part to the tangent
   *  of the step. A part that adds to batch.heat also adds to Tangent::heat; a part whose stress
   *  depends on that heat reads it there. Null: no analytic tangent. Not called for a thermal
   *  part. */
  void (*tangent)(const LawParameters &, Batch &, History, Tangent &);
};

/** Default declarations and kernels; all laws derive from this. */
struct LawDefaults {
  static constexpr StressShare share = NO_SHARE;
  static constexpr bool uses_speed = true, uses_F = true, expands = false,
                        finds_temperature = false, of_surfaces = false;
  static constexpr int gruneisen = -1, energy_kept = -1;
  static constexpr const char *term = nullptr;
  static constexpr std::nullptr_t term_parameters = nullptr, history = nullptr,
                                  term_history = nullptr, nhistory = nullptr;
  static constexpr const char *check(const LawParameters &) { return nullptr; }
  static constexpr bool needs_temperature(const LawParameters &) { return false; }
  static constexpr std::nullptr_t heat_share = nullptr, warming = nullptr, conduction = nullptr,
                                  fracture_share = nullptr, expansion = nullptr,
                                  consistent = nullptr, initialize = nullptr;
  static constexpr std::nullptr_t modulus = nullptr, energy = nullptr, raise_speed = nullptr,
                                  prepare = nullptr, tangent = nullptr;
};

/** Kernels of all laws for one instruction set. */
struct LawTable {
  std::vector<LawKernels> builtin[NPARTS];    ///< in the order of the lists in law/list.h
  void (*speed)(int n, double density, const double *k, double *c);    ///< c = sqrt(k / density)

  void (*mean_stress)(const Batch &, double *);    ///< a third of the trace

  /** Equivalent strain rate sqrt(2/3 D:D) at the middle of a step. */
  void (*strain_rate)(const Batch &, double *);

  /** The table for this CPU, or the one with this name; see MPMKernels::select(). */
  static const LawTable *select(const char *name = nullptr);

  /** Kernels of a law by its index in declared_laws(). */
  const LawKernels &kernels(Part, int index) const;
};

/** Version and sizes of structs on which a plugin with laws and the package must agree. */
struct LawVersion {
  int interface;    ///< raised with each change of the interface of laws and package
  int batch, info, kernels, parameters, conduction;
};
constexpr LawVersion law_version{9,
                                 sizeof(Batch),
                                 sizeof(LawInfo),
                                 sizeof(LawKernels),
                                 sizeof(LawParameters),
                                 sizeof(Conduction)};

/** A law of a plugin. */
struct PluginLaw {
  Part part;
  LawInfo info;
  LawKernels kernels;
};

/** Adds laws of a plugin to declared_laws(); returns an error message, or an empty string on
 *  success. */
std::string add_laws(const LawVersion &, const PluginLaw *, int n);

// conversion of the struct of a law to its declaration and its kernels
namespace law {
  namespace {

    /** Number of entries of a declaration; 0 for null. */
    template <class T, int N> constexpr int count(const T (&)[N])
    {
      return N;
    }
    constexpr int count(std::nullptr_t)
    {
      return 0;
    }

    /** Declaration of a law, from the static members of its struct. */
    template <class Law> LawInfo declaration()
    {
      LawInfo info;
      info.name = Law::name;
      info.meaning = Law::meaning;
      info.share = Law::share;
      info.parameters = Law::parameters;
      info.nparameters = count(Law::parameters);
      info.term = Law::term;
      info.term_parameters = Law::term_parameters;
      info.nterm_parameters = count(Law::term_parameters);
      info.history = Law::history;
      info.ndeclared = count(Law::history);
      info.term_history = Law::term_history;
      info.nterm_history = count(Law::term_history);
      info.nhistory = Law::nhistory;
      info.uses_speed = Law::uses_speed;
      info.uses_F = Law::uses_F;
      info.expands = Law::expands;
      info.finds_temperature = Law::finds_temperature;
      info.energy_kept = Law::energy_kept;
      info.of_surfaces = Law::of_surfaces;
      info.gruneisen = Law::gruneisen;
      info.check = Law::check;
      info.needs_temperature = Law::needs_temperature;
      info.heat_share = Law::heat_share;
      info.warming = Law::warming;
      info.fracture_share = Law::fracture_share;
      info.conduction = Law::conduction;
      info.expansion = Law::expansion;
      info.consistent = Law::consistent;
      info.initialize = Law::initialize;
      static_assert(count(Law::parameters) <= LawParameters::MAX);
      static_assert(count(Law::term_parameters) <= LawParameters::TERM);
      return info;
    }

    /** Kernels of a law, from the static functions of its struct. */
    template <class Law> constexpr LawKernels kernels()
    {
      return {Law::update, Law::modulus, Law::energy, Law::raise_speed, Law::prepare, Law::tangent};
    }

  }    // namespace
}    // namespace law

}    // namespace MPM_NS
#endif
