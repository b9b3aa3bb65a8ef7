/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "pore/mpm_mixture.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double PI = 3.14159265358979323846;

/** fix ID all mpm/mixture SOIL WATER GRAIN_DENSITY VISCOSITY drag ... */
Options MPMMixtureOptions::declare()
{
  using namespace option;
  Options o("fix mpm/mixture");
  o.argument(text(soil_id, "soil-ID"));
  o.argument(text(water_id, "water-ID"));
  o.argument(number(grain_density, "density of the grains", POSITIVE));
  o.argument(number(viscosity, "viscosity of the water", NOT_NEGATIVE));
  const auto diameter_of_grains =
      number(diameter, "d", POSITIVE, "distance", "diameter of the grains");
  enum { DARCY_WORD = 1 };
  static constexpr SphereDrag::Law laws[] = {SphereDrag::ERGUN, SphereDrag::GIDASPOW,
                                             SphereDrag::DIFELICE};
  o.add("drag",
        {word(
            [this] {
              if (drag == NO_DRAG) return 0;
              if (drag == DARCY) return (int) DARCY_WORD;
              return DARCY_WORD + 1 + (int) (std::find(laws, laws + 3, spheres) - laws);
            },
            [this](int word) {
              drag = word == 0 ? NO_DRAG : (word == DARCY_WORD ? DARCY : SPHERES);
              spheres = drag == SPHERES ? laws[word - DARCY_WORD - 1] : SphereDrag::NONE;
              reference_porosity = 0.0;
            },
            {{"none", 0, "no drag"},
             {"darcy",
              DARCY_WORD,
              "Darcy's law",
              {number(permeability, "kappa", POSITIVE, "area", "intrinsic permeability"),
               optional(
                   number(reference_porosity, "n0", {0.0, 1.0, false}, "1",
                          "porosity at which the soil has this permeability; at others it follows "
                          "Kozeny and Carman; default: it does not depend on porosity"))}},
             {"ergun", DARCY_WORD + 1, "packed spheres", {diameter_of_grains}},
             {"gidaspow", DARCY_WORD + 2, "spheres of any porosity", {diameter_of_grains}},
             {"difelice",
              DARCY_WORD + 3,
              "spheres of any porosity, by another law",
              {diameter_of_grains}}})},
        "drag law");
  o.refuse([=] {
    return OptionRules{{drag != NO_DRAG && viscosity == 0.0, "",
                        "needs a positive viscosity for its drag: use drag none without"}};
  });
  return o;
}

/** Laws for spheres have the superficial velocity n w and the gradient of pressure in the drag
 *  ("model B"): in steady flow - grad p = N K n w with N spheres in a volume, and as n grad p is
 *  the drag here, it is n^2 N K w. Where sums over points smear the end of the soil, n w, which is
 *  the same on both sides, has the porosity there. */
double MPMMixtureOptions::drag_coefficient(double n, double here, double water_density,
                                           double difference) const
{
  if (drag == NO_DRAG) return 0.0;
  if (drag == DARCY) {
    const double n0 = reference_porosity;
    const auto kozeny = [](double m) {
      return m * m * m / ((1.0 - m) * (1.0 - m));
    };
    const double kappa = n0 > 0.0 ? permeability * kozeny(n) / kozeny(n0) : permeability;
    return here * here * viscosity / kappa;
  }
  const SphereDrag law = {spheres, water_density, viscosity};
  const double number = 6.0 * (1.0 - n) / (PI * diameter * diameter * diameter);
  return here * here * number * law.on_sphere(diameter, here * difference, n, law.hindrance(n));
}
