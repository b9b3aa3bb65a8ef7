/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_DRAG_H
#define LMP_MPM_DRAG_H

// Laws of the drag between grains and the fluid around them; no LAMMPS.

#include <algorithm>
#include <cmath>

namespace MPM_NS {

/** Mean of exp(-t) for t from 0 to x. */
inline double mean_decay(double x)
{
  return x > 1.0e-8 ? -std::expm1(-x) / x : 1.0 - 0.5 * x;
}

/** Drag on one sphere of many. In all laws the drag is K(w) times the superficial slip w (porosity
 *  times the difference of the velocities), and includes the force of the pressure gradient along a
 *  bed. Sources: see the page of fix mpm/immersed. */
struct SphereDrag {
  enum Law { NONE, STOKES, SCHILLER, ERGUN, GIDASPOW, DIFELICE };

  Law law;
  double density, viscosity;    ///< of the fluid; viscosity: pressure * time in units of mass

  /** Coefficient of the quadratic term of the pressure gradient in a bed of packed spheres, by
   *  Ergun's law: per square of the superficial velocity. */
  static double bed_inertia(double density, double diameter, double porosity)
  {
    return INERTIAL * density * (1.0 - porosity) / (diameter * porosity * porosity * porosity);
  }

  /** Factor for a sphere in a bed on the drag on a single sphere, in laws in which it does not
   *  depend on the slip. */
  double hindrance(double porosity) const
  {
    return law == GIDASPOW && porosity >= 0.8 ? std::pow(porosity, -4.65) : 1.0;
  }

  /** K [mass/time] at a superficial slip >= 0; hindrance: of hindrance(). */
  double on_sphere(double diameter, double slip, double porosity, double hindrance) const
  {
    constexpr double PI = 3.14159265358979323846;
    const double stokes = 3.0 * PI * viscosity * diameter;
    const double Re = density * slip * diameter / viscosity;
    const auto schiller = [&](double number) {
      return number < 1000.0 ? 1.0 + 0.15 * std::pow(number, 0.687) : 0.44 / 24.0 * number;
    };
    const auto ergun = [&]() {
      const double cube = porosity * porosity * porosity;
      return PI / 6.0 * diameter *
          (VISCOUS * viscosity * (1.0 - porosity) + INERTIAL * density * diameter * slip) / cube;
    };
    switch (law) {
      case STOKES:
        return stokes;
      case SCHILLER:
        return stokes * schiller(Re);
      case ERGUN:
        return ergun();
      case GIDASPOW:
        return porosity < 0.8 ? ergun() : stokes * schiller(Re) * hindrance;
      case DIFELICE: {
        const double logarithm = 1.5 - std::log10(std::max(Re, 1.0e-10));
        const double power = 3.7 - 0.65 * std::exp(-0.5 * logarithm * logarithm);
        const double root = 0.63 * std::sqrt(Re) + 4.8;
        return stokes / 24.0 * root * root * std::pow(porosity, -power - 1.0);
      }
      default:
        return 0.0;
    }
  }

 private:
  static constexpr double VISCOUS = 150.0, INERTIAL = 1.75;    // of Ergun's law
};

}    // namespace MPM_NS
#endif
