/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_TEMPERATURE_FACTOR_H
#define MPM_MATERIAL_TEMPERATURE_FACTOR_H

#include <vector>

namespace MPM_NS {

/** Factor of a parameter as a function of the temperature T: a table with straight lines between its
 *  entries, or a formula that is one at a temperature R, between two limits. Outside of its table or limits
 *  it is constant. It is monotonic between knots().
 */
class TemperatureFactor {
 public:
  enum Formula {
    LINEAR,         ///< 1 + C (T - R)
    POWER,          ///< (T/R)^C
    EXPONENTIAL,    ///< exp[C (T - R)]
    ARRHENIUS       ///< exp[C (1/T - 1/R)]
  };

  /** A table: temperatures, which increase, and the factors there, as many. */
  TemperatureFactor(std::vector<double> temperatures, std::vector<double> factors) :
      T(std::move(temperatures)), factor(std::move(factors))
  {
  }

  /** A formula with the coefficient C and the reference R between the limits low and high. */
  TemperatureFactor(Formula formula, double c, double reference, double low, double high);

  double at(double temperature) const;
  /** Its mean over these temperatures, low <= high; of a formula by Simpson's rule. */
  double mean(double low, double high) const;
  bool is_table() const { return !factor.empty(); }

  /** Temperatures between the limits of a formula, n with them, from one to the next of which the factor changes by the
   *  same share; of LINEAR the limits alone. */
  std::vector<double> spread(int n) const;

  /** Temperatures between which it has no extremes. */
  const std::vector<double> &knots() const { return T; }

 private:
  std::vector<double> T, factor;    ///< of a formula: T has the limits, factor is empty
  Formula formula = LINEAR;
  double c = 0.0, reference = 0.0;
};

}    // namespace MPM_NS
#endif
