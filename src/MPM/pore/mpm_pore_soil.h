/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PORE_SOIL_H
#define LMP_MPM_PORE_SOIL_H

#include "grains/mpm_drag.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace LAMMPS_NS {

/** How much water the pores of a soil keep, and let flow, when its pressure p is below that of the
 *  air. With the effective saturation S_e = (S - S_r)/(S_s - S_r), which is one for p >= 0,
 *
 *    S_e = (1 + (-alpha p)^n)^-m, m = 1 - 1/n
 *          (M.T. van Genuchten, Soil Sci. Soc. Am. J. 44 (1980) 892)
 *    S_e = exp(alpha p)   (W.R. Gardner, Soil Sci. 85 (1958) 228)
 *
 *  and the permeability is that of full pores times
 *
 *    k_r = S_e^1/2 (1 - (1 - S_e^(1/m))^m)^2
 *          (Y. Mualem, Water Resour. Res. 12 (1976) 513; van Genuchten)
 *    k_r = S_e^e */
struct MPMRetention {
  enum Law { FULL, VAN_GENUCHTEN, GARDNER };
  enum Flow { OF_LAW, MUALEM, POWER };

  Law law = FULL;                   ///< FULL: pores keep all water
  double alpha = 0.0;               ///< [1/pressure]
  double n = 0.0;                   ///< of van Genuchten
  double least = 0.0;               ///< residual saturation S_r
  double most = 1.0;                ///< saturation S_s for p >= 0
  Flow flow = OF_LAW;               ///< OF_LAW: Mualem for van Genuchten, the power 1 for Gardner
  double power = 1.0;               ///< e
  bool bishop_effective = false;    ///< Bishop's coefficient is S_e, not S

  /** Can pores lose water, so that they are not always full? */
  bool can_dry() const { return law != FULL; }

  /** State at a pressure p below that of the air. */
  struct State {
    double effective, saturation;
    double slope;       ///< dS/dp [1/pressure]
    double relative;    ///< k_r
    double bishop;      ///< chi, share of the pressure in the effective stress (Bishop)
  };
  State at(double p) const
  {
    State state = {};
    if (!can_dry() || !(p < 0.0)) {
      state.effective = state.relative = 1.0;
      state.saturation = most;
      state.slope = 0.0;
    } else if (law == VAN_GENUCHTEN) {
      const double m = 1.0 - 1.0 / n, x = std::pow(-alpha * p, n);
      state.effective = std::exp(-m * std::log1p(x));
      state.slope = state.effective * (n - 1.0) * x / ((1.0 + x) * -p);
      if (flow != POWER) {
        const double open = x > 0.0 ? -std::expm1(-m * std::log1p(1.0 / x)) : 1.0;
        state.relative = std::sqrt(state.effective) * open * open;
      }
    } else {
      state.effective = std::exp(alpha * p);
      state.slope = alpha * state.effective;
      if (flow != POWER) state.relative = state.effective;
    }
    if (can_dry() && p < 0.0) {
      if (flow == POWER) state.relative = std::pow(state.effective, power);
      state.saturation = least + (most - least) * state.effective;
      state.slope *= most - least;
    }
    state.bishop = bishop_effective ? state.effective : state.saturation;
    return state;
  }
  /** Derivative of the pressure in the effective stress with respect to the pressure of the water,
   *  d(chi p)/dp. With full pores it is chi, which is S_s if Bishop's coefficient is the
   *  saturation. */
  double borne(double p) const
  {
    if (!can_dry()) return 1.0;
    const State now = at(p);
    if (p >= 0.0) return now.bishop;
    return now.bishop + p * now.slope / (bishop_effective ? most - least : 1.0);
  }
};

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
