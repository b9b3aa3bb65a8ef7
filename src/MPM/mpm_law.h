/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_LAW_H
#define LMP_MPM_LAW_H

// What a constitutive law declares (its parameters and history) and the kernels it provides.
//
// A law is one header: a struct with the declaration and the loops over a batch, which is added to
// its list in mpm_law_list.h; nothing else has to change. The headers are compiled once for each
// instruction set by mpm_laws_isa.cpp, and once more without special options by mpm_material.cpp,
// which reads the declarations only. All of their content is in unnamed namespaces, so that the
// linker cannot take a function of one instruction set for that of another.

#include "mpm_material.h"

#include <limits>

#define MPM_INLINE inline __attribute__((always_inline))

// Loops over the points of a batch, without and with sums; MPM_ISA is set for mpm_laws_isa.cpp.
#ifdef MPM_ISA
#define MPM_PRAGMA(x) _Pragma(#x)
#define MPM_SIMD MPM_PRAGMA(omp simd)
#define MPM_SIMD_SUM(...) MPM_PRAGMA(omp simd reduction(+ : __VA_ARGS__))
#else
#define MPM_SIMD
#define MPM_SIMD_SUM(...)
#endif

namespace MPM_NS {

/** Values that a parameter may have: low < value < high, or low <= value <= high when closed. */
struct Range {
  double low, high;
  bool closed;
};
constexpr double UNBOUNDED = std::numeric_limits<double>::infinity();
constexpr double REQUIRED = std::numeric_limits<double>::quiet_NaN();    ///< no default value
constexpr Range POSITIVE{0.0, UNBOUNDED, false};
constexpr Range NOT_NEGATIVE{0.0, UNBOUNDED, true};
constexpr Range FRACTION{0.0, 1.0, true};
constexpr Range POISSON_RATIO{-1.0, 0.5, false};

/** Declaration of one parameter.
 *
 *  Parameters without option are given first, in this order; those of them that have a default are
 *  given all together or not at all. The others follow the words of their option, options in any
 *  order. Options that begin with the same word exclude each other.
 */
struct Parameter {
  const char *option;    ///< word or words that introduce it, "" when positional
  const char *name;      ///< as in the manual
  const char *unit;      ///< kind of unit: pressure, velocity, viscosity, temperature, ..., or 1
  Range range;
  double standard;    ///< value when not given, or REQUIRED
  const char *meaning;
};

/** Declaration of one history variable. */
struct HistoryDeclaration {
  const char *name;    ///< as used by compute mpm/atom
  int initial;         ///< index of the parameter that is its initial value, -1: zero
};

/** Shares of the stress: which ones a law needs from the last step, which ones a viscosity adds. */
enum StressShare { NO_SHARE = 0, PRESSURE = 1, DEVIATOR = 2, WHOLE_STRESS = 3 };

/** The places that a law can take in a material. */
enum Part { CLOSED, EOS, STRENGTH, VISCOSITY, NPARTS };

/** Declaration of a law. */
struct LawInfo {
  const char *name;
  const char *meaning;
  StressShare share;    ///< of the old stress that it builds on; of a viscosity: what it adds
  const Parameter *parameters;
  int nparameters;
  const HistoryDeclaration *history;
  /** History variables that a law with these parameters has. */
  int (*nhistory)(const double *);
  /** What is wrong with parameters that are each in their range; null when all is well. */
  const char *(*check)(const double *);
};

/** Declarations of all laws for one place, in the order of the lists in mpm_law_list.h. */
const std::vector<LawInfo> &declared_laws(Part);

/** Values of the parameters as the kernels get them. */
struct LawParameters {
  static constexpr int MAX = 16;
  double density;       ///< reference density
  double value[MAX];    ///< in the order of the declaration
};

/** Rows of history variables of a batch. */
using History = double (*)[BATCH];

/** Kernels of a closed law, an equation of state, or a strength.
 *
 *  Energies are per reference volume. The parts of a composed material work on one batch in turn:
 *  a strength makes the deviator of the stress, viscosities add to it, and the equation of state
 *  subtracts the pressure. A closed law makes the whole stress.
 */
struct LawKernels {
  /** Stress and history at the end of the step; work of the batch is added to batch.work.
   *  heat[n]: energy dissipated in this step; a strength adds to it, an eos takes it. */
  void (*update)(const LawParameters &, Batch &, History, double *heat);

  /** Adds to k[n] this part's share of density * (wave speed)^2, with the reference density:
   *  J d sigma_nn / d epsilon_nn for a small uniaxial strain on top of the present state. */
  void (*modulus)(const LawParameters &, const Batch &, History, double *k);

  /** Adds to w[n] the stored energy. */
  void (*energy)(const LawParameters &, const Batch &, History, double *w);
};

/** Kernels of a viscosity. */
struct ViscosityKernels {
  /** Adds to the stress, to heat[n], and to batch.work. c[n]: wave speed without viscosity. */
  void (*update)(const LawParameters &, Batch &, const double *c, double *heat);

  /** Raises c[n] so that h / c[n] is the stable step with this viscosity. */
  void (*raise_speed)(const LawParameters &, const Batch &, double *c);
};

/** Kernels of all laws for one instruction set, in the order of the lists in mpm_law_list.h. */
struct LawTable {
  const char *isa;    ///< "baseline", "AVX2" or "AVX-512"
  const LawKernels *closed, *eos, *strength;
  const ViscosityKernels *viscosity;
  void (*clear_stress)(Batch &);    ///< stress of a law with no strength
  void (*speed)(int n, double density, const double *k, double *c);    ///< c = sqrt(k / density)

  /** The table for this CPU, or the one with this name: as MPMKernels::select(). */
  static const LawTable *select(const char *name = nullptr);
};

}    // namespace MPM_NS
#endif
