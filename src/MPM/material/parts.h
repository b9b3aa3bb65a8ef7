/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_PARTS_H
#define MPM_MATERIAL_PARTS_H

// The definition of a material as the parser hands it over to the composition.

#include "law/law.h"
#include "material/temperature_factor.h"

#include <cstdio>

namespace MPM_NS {

class RandomField;

constexpr const char *part_name[NPARTS] = {"", "eos", "strength", "viscosity", "damage", "thermal"};

/** A random parameter in a definition. */
struct UsedRandom {
  int word;    ///< of the name in the definition
  std::string name;
  bool lognormal;
  double variation;    ///< standard deviation over mean
  double length;
  long seed;
};

/** A parameter that depends on the temperature, in a definition. */
struct UsedVary {
  int word;    ///< of the name in the definition
  std::string name, text;
  TemperatureFactor factor;
};

/** A parameter among those of its law. */
struct ParameterPlace {
  int term;         ///< of the option that is given several times, -1: not of a term
  int parameter;    ///< in the declaration of its law

  /** Its value, constant or not. */
  template <class Parameters> auto &of(Parameters &p) const
  {
    return term < 0 ? p.value[parameter] : p.term[term][parameter];
  }
  const Parameter &declaration(const LawInfo &info) const
  {
    return (term < 0 ? info.parameters : info.term_parameters)[parameter];
  }
  bool operator==(const ParameterPlace &other) const
  {
    return term == other.term && parameter == other.parameter;
  }
};

/** A parameter that differs from point to point: its value is the mean times a factor, which is a
 *  history variable. */
struct RandomParameter : UsedRandom, ParameterPlace {
  int row;    ///< of the factor in the history of the material
  std::shared_ptr<const RandomField> field;
};

/** A parameter that depends on the temperature: its value is the given one times a factor. */
struct WarmParameter : ParameterPlace {
  TemperatureFactor factor;
};

/** The same of a thermal conductivity. */
struct WarmConductivity {
  int axis;    ///< 0, and in orthotropic materials also 1 and 2
  TemperatureFactor factor;

  double &of(Conduction &c) const { return axis == 0 ? c.conductivity : c.across[axis - 1]; }
};

/** A law with its parameters in a material. */
struct UsedLaw {
  Part part;
  const LawInfo *info;
  int index;    ///< in its list
  int word;     ///< of its name in the definition
  LawParameters parameters;

  // set by the composition

  int history = 0;                        ///< first row of its history
  const LawKernels *kernels = nullptr;    ///< for the instruction set that runs
  std::vector<RandomParameter> random;    ///< its own parameters that differ from point to point
  std::vector<WarmParameter> warm;        ///< those that depend on the temperature
  bool varies = false;                    ///< do its LawParameters differ from point to point?
  bool liquid = false;                    ///< is it a viscosity of the molten part only?
  /** Is it a strength whose plastic work is all turned into heat by the damage? */
  bool heats_alone = false;
};

/** A range of validity in a definition. */
struct UsedRange : ValidRange {
  int word;    ///< of its quantity in the definition
  /** How the quantity is found, if not in a row of history. */
  enum { PRESSURE_OF_STRESS = -3, STRAIN_RATE = -2, DENSITY_OF_J = -1 };
};

/** All of it; the parser has checked that the parts go together. */
struct MaterialDefinition {
  double density = 0.0;
  std::vector<UsedLaw> laws[NPARTS];
  std::vector<UsedRange> ranges;
  std::vector<UsedRandom> random;
  std::vector<UsedVary> vary;

  /** Does a viscosity add to that share of the stress on which a law builds in the next step? */
  bool shares_stress() const
  {
    for (const Part part : {CLOSED, STRENGTH})
      for (const auto &law : laws[part])
        for (const auto &viscosity : laws[VISCOSITY])
          if (law.info->share & viscosity.info->share) return true;
    return false;
  }
};

/** The material of a definition; throws MaterialError when a range or random parameter is not one of
 *  the material. */
std::unique_ptr<Material> compose(const MaterialDefinition &, const LawTable *);

inline std::string number(double x)
{
  char text[32];
  snprintf(text, sizeof(text), "%.15g", x);
  return text;
}

/** Name of a law with that of its part in front. */
inline std::string title(const UsedLaw &law)
{
  return std::string(part_name[law.part]) + (law.part == CLOSED ? "" : " ") + law.info->name;
}

}    // namespace MPM_NS
#endif
