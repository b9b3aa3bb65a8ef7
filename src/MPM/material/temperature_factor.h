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

/** Factor of a parameter as a function of the temperature T: a table with linear interpolation, or
 *  a formula, equal to one at a reference temperature R, between two limits. Outside the table or
 *  the limits it is constant. It is monotonic between knots().
 */
class TemperatureFactor {
 public:
  enum Formula {
    LINEAR,         ///< 1 + C (T - R)
    POWER,          ///< (T/R)^C
    EXPONENTIAL,    ///< exp[C (T - R)]
    ARRHENIUS       ///< exp[C (1/T - 1/R)]
  };

  /** A table: increasing temperatures, and as many factors at these. */
  TemperatureFactor(std::vector<double> temperatures, std::vector<double> factors) :
      T(std::move(temperatures)), factor(std::move(factors))
  {
  }

  /** A formula with the coefficient C and the reference R between the temperatures low and high. */
  TemperatureFactor(Formula formula, double c, double reference, double low, double high);

  double at(double temperature) const;
  /** Mean over the temperatures from low to high, low <= high; for a formula by Simpson's rule. */
  double mean(double low, double high) const;
  bool is_table() const { return !factor.empty(); }

  /** n temperatures from one limit of a formula to the other, including both, such that the factor
   *  changes by the same ratio from each to the next; for LINEAR only the limits. */
  std::vector<double> spread(int n) const;

  /** Temperatures between which the factor is monotonic. */
  const std::vector<double> &knots() const { return T; }

 private:
  std::vector<double> T, factor;    ///< for a formula, T has the limits and factor is empty
  Formula formula = LINEAR;
  double c = 0.0, reference = 0.0;
};

}    // namespace MPM_NS
#endif
