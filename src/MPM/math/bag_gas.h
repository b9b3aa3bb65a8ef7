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

/** An ideal gas with constant specific heat in a bag, as one state, in consistent units: energy is pressure times volume. Between
 *  calls of expand() its volume is constant. */
class BagGas {
 public:
  double gamma = 1.4;          ///< ratio of specific heats; 1: the temperature is kept
  double R = 1.0;              ///< specific gas constant [energy/(mass temperature)]
  double mass = 0.0;           ///< in the bag
  double volume = 0.0;         ///< of the bag
  double temperature = 1.0;    ///< of the gas

  double pressure() const { return mass * R * temperature / volume; }
  /** Internal energy; with gamma 1, of which the gas has no end, the free energy against a volume 1 is not counted: 0. */
  double energy() const { return gamma > 1.0 ? pressure() * volume / (gamma - 1.0) : 0.0; }

  /** To another volume, without heat, or, with gamma 1, at the same temperature. */
  void expand(double to)
  {
    if (gamma > 1.0) temperature *= std::pow(volume / to, gamma - 1.0);
    volume = to;
  }

  /** Gas of a temperature comes in, with its enthalpy; a negative mass goes out, which should have that of the bag. */
  void add(double more, double its_temperature)
  {
    const double all = mass + more;
    if (gamma > 1.0) temperature = (mass * temperature + gamma * more * its_temperature) / all;
    mass = all;
  }

  /** Mass per area and time through a hole from where the pressure is p to where it is q < p, isentropic, at the speed of sound at
   *  most (A.H. Shapiro, Compressible Fluid Flow I (1953), chapter 4). Consistent units: (p/(R T)) sqrt(R T). */
  static double flow(double p, double q, double RT, double gamma);
};

}    // namespace MPM_NS
#endif
