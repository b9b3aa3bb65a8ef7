/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PORE_SOIL_H
#define LMP_MPM_PORE_SOIL_H

#include "grains/mpm_drag.h"
#include "pore/mpm_retention.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace LAMMPS_NS {

/** Pore water: its bulk modulus [pressure], its density, and the divisor that makes permeabilities
 *  mobilities. The divisor is the unit weight [pressure/length] for hydraulic conductivities, or
 *  the viscosity [pressure time] for permeabilities in units of area. */
struct MPMPoreWater {
  double bulk = 0.0, density = 0.0, resistance = 0.0;
};

/** Properties of the pores of a material. Volumes are those of the present state, and J is their
 *  ratio to the initial ones. */
struct MPMPoreSoil {
  enum Law { CONSTANT, KOZENY, SQUARED, FORMULA };

  std::string material;    ///< ID of its fix mpm/material
  double porosity = 0.0;
  Law law = CONSTANT;
  double permeability = 0.0;
  std::string formula;    ///< name of a variable, with v_
  double biot = 1.0;      ///< coefficient of Biot
  double grains = 0.0;    ///< bulk modulus of the grains [pressure]; 0: rigid
  /** gradient of pressure per square of flow (Forchheimer); see quadratic_at() */
  double quadratic = 0.0;
  /** of grains, from which the quadratic term follows (Ergun); 0: use the number above */
  double diameter = 0.0;
  bool warms = false;        ///< are of_grains and of_water given?
  double of_grains = 0.0;    ///< volumetric thermal expansion of the grains [1/temperature]
  double of_water = 0.0;     ///< the same of the water
  MPMRetention retention;

  /** Volume by which grains and water in a unit of volume grow per unit of temperature. */
  double growth_at(double J) const
  {
    const double n = pores_at(J);
    return (biot - n) * of_grains + n * of_water;
  }

  /** Porosity at J; grains keep their volume. */
  double porosity_at(double J) const { return 1.0 - (1.0 - porosity) / J; }
  /** The same, but at least a hundredth of the initial porosity, where it must not vanish. */
  double pores_at(double J) const { return std::max(porosity_at(J), 0.01 * porosity); }

  /** Kozeny and Carman: proportional to n^3/(1 - n)^2, from its initial value; nothing flows
   *  without pores. */
  double permeability_at(double J) const
  {
    if (law == KOZENY) {
      const double n = std::max(0.0, porosity_at(J)) / porosity;
      return permeability * n * n * n * J * J;
    }
    return law == SQUARED ? permeability * J * J : permeability;
  }

  /** J at which grains fill the whole volume. */
  double shut() const { return 1.0 - porosity; }

  /** Does Darcy's law hold, without a quadratic term? */
  bool is_linear() const { return quadratic == 0.0 && diameter == 0.0; }

  /** Part of the gradient of the pressure beyond Darcy's law, per square of the flow. density: of
   *  the water, in units of pressure over velocity squared. */
  double quadratic_at(double J, double density) const
  {
    if (diameter == 0.0) return quadratic;
    const double n = pores_at(J);
    return MPM_NS::SphereDrag::bed_inertia(density, diameter, n);
  }

  /** Volume of water that a unit of volume takes up per unit of pressure, when pores are full. */
  double storage_at(double J, const MPMPoreWater &water) const
  {
    const double n = pores_at(J);
    return retention.most * n / water.bulk +
        (grains > 0.0 ? std::max(0.0, biot - n) / grains : 0.0);
  }
  /** The same for n points at once, per unit of their initial volume, that is, times J; without
   *  divisions. */
  void storage_at(int n, const double *J, const MPMPoreWater &water, double *storage) const
  {
    const double of_water = retention.most / water.bulk,
                 of_grains = grains > 0.0 ? 1.0 / grains : 0.0;
    const double solid = 1.0 - porosity, least = 0.01 * porosity;
    for (int p = 0; p < n; p++) {
      const double pores = std::max(J[p] - solid, least * J[p]);
      storage[p] = of_water * pores + of_grains * std::max(0.0, biot * J[p] - pores);
    }
  }

  /** Change of the pressure when the ratio of volumes has changed from since to J and no water
   *  left. */
  double undrained(double since, double J, const MPMPoreWater &water) const
  {
    return biot * (since / J - 1.0) / storage_at(J, water);
  }
};

/** Ratio of the flow w to the gradient i of the pressure that drives it, where i = w/mobility +
 *  quadratic w^2. */
inline double secant_mobility(double mobility, double quadratic, double gradient)
{
  return 2.0 * mobility / (1.0 + std::sqrt(1.0 + 4.0 * quadratic * mobility * mobility * gradient));
}

/** Resistance to the flow at an interface of soils, across [0] and along [1] it. In each of the two
 *  directions, the gradient of the pressure that drives a flow w is linear w + quadratic |w| w. */
struct MPMPoreResistance {
  double linear[2], quadratic[2];

  /** Resistance in direction k to a flow of this magnitude. */
  double at(int k, double flow) const { return linear[k] + quadratic[k] * flow; }
  /** Magnitude of the flow for which |flow_k| = push_k/(free + at(k, flow)) in both directions
   *  k. */
  double flow(const double *push, double free) const
  {
    // the flow in one direction alone is less. The right-hand side is convex in the flow: from
    // below, Newton's method never goes beyond the solution
    double w = 0.0;
    for (int k = 0; k < 2; k++) {
      const double first = free + linear[k];
      w = std::max(
          w, 2.0 * push[k] / (first + std::sqrt(first * first + 4.0 * quadratic[k] * push[k])));
    }
    for (int turn = 0; turn < 60; turn++) {
      double square = 0.0, slope = 0.0;
      for (int k = 0; k < 2; k++) {
        const double r = free + at(k, w), flow = push[k] / r;
        square += flow * flow;
        slope += flow * flow * quadratic[k] / r;
      }
      if (square == 0.0) return 0.0;
      const double both = std::sqrt(square), step = (both - w) / (1.0 + slope / both);
      w += step;
      if (!(step > 1.0e-14 * w)) break;
    }
    return w;
  }
};

}    // namespace LAMMPS_NS
#endif
