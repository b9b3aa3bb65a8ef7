/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATH_BAG_GAS_H
#define MPM_MATH_BAG_GAS_H

#include <cmath>

namespace MPM_NS {

/** An ideal gas with constant specific heat in a bag, in one uniform state and consistent units
 *  (energy is pressure times volume). Its volume is constant between calls of expand(). */
class BagGas {
 public:
  double gamma = 1.4;          ///< ratio of specific heats; 1: isothermal
  double R = 1.0;              ///< specific gas constant [energy/(mass temperature)]
  double mass = 0.0;           ///< mass of gas in the bag
  double volume = 0.0;         ///< volume of the bag
  double temperature = 1.0;    ///< temperature of the gas

  double pressure() const { return mass * R * temperature / volume; }
  /** Internal energy. With gamma = 1 it would be infinite, and 0 is returned; the free energy
   *  relative to a volume of 1 is not counted. */
  double energy() const { return gamma > 1.0 ? pressure() * volume / (gamma - 1.0) : 0.0; }

  /** Changes the volume, adiabatically or, with gamma = 1, at constant temperature. */
  void expand(double to)
  {
    if (gamma > 1.0) temperature *= std::pow(volume / to, gamma - 1.0);
    volume = to;
  }

  /** Adds a mass of gas of the given temperature, with its enthalpy. A negative mass leaves the
   *  bag, and should have the temperature of the bag. */
  void add(double more, double its_temperature)
  {
    const double all = mass + more;
    if (gamma > 1.0) temperature = (mass * temperature + gamma * more * its_temperature) / all;
    mass = all;
  }

  /** Mass per area and time of the isentropic flow through a hole from pressure p to pressure q <
   *  p, choked at the speed of sound (A.H. Shapiro, Compressible Fluid Flow I (1953), chapter 4); 0
   *  if q is not below p. RT: R times the temperature at pressure p. The unit is that of (p/(R T))
   *  sqrt(R T). */
  static double flow(double p, double q, double RT, double gamma)
  {
    if (!(p > q)) return 0.0;
    const double r = q / p;
    if (gamma == 1.0) {    // limit of the expressions below
      const double least = std::exp(-0.5);
      return p / std::sqrt(RT) * (r <= least ? least : r * std::sqrt(-2.0 * std::log(r)));
    }
    const double least = std::pow(2.0 / (gamma + 1.0), gamma / (gamma - 1.0));
    if (r <= least)
      return p * std::sqrt(gamma / RT) *
          std::pow(2.0 / (gamma + 1.0), 0.5 * (gamma + 1.0) / (gamma - 1.0));
    return p * std::sqrt(2.0 * gamma / ((gamma - 1.0) * RT)) * std::pow(r, 1.0 / gamma) *
        std::sqrt(1.0 - std::pow(r, (gamma - 1.0) / gamma));
  }
};

}    // namespace MPM_NS
#endif
