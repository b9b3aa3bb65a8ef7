/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_PARTS_H
#define MPM_MATERIAL_PARTS_H

// The definition of a material, as the parser passes it to compose().

#include "law/law.h"
#include "material/material.h"
#include "material/temperature_factor.h"

#include <cstdio>

namespace MPM_NS {

class RandomField;

constexpr const char *part_name[NPARTS] = {"", "eos", "strength", "viscosity", "damage", "thermal"};

/** A random parameter in a definition. */
struct UsedRandom {
  int word;    ///< index of its name in the definition
  std::string name;
  bool lognormal;
  double variation;    ///< standard deviation over mean
  double length;       ///< correlation length
  long seed;
};

/** A parameter in a definition that depends on temperature. */
struct UsedVary {
  int word;    ///< index of its name in the definition
  std::string name, text;
  TemperatureFactor factor;
};

/** Location of a parameter among those of its law. */
struct ParameterPlace {
  int term;         ///< index of the repeated option to which it belongs; -1: none
  int parameter;    ///< index in the declaration of its law

  /** Its value in p, constant or not. */
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

/** A parameter that differs between points: its value is the mean times a factor, which is stored
 *  as a history variable. */
struct RandomParameter : UsedRandom, ParameterPlace {
  int row;    ///< row of the factor in the history of the material
  std::shared_ptr<const RandomField> field;
};

/** A parameter that depends on temperature: its value is the given value times a factor. */
struct VaryingParameter : ParameterPlace {
  TemperatureFactor factor;
};

/** A thermal conductivity that depends on temperature: the given value times a factor. */
struct VaryingConductivity {
  int axis;    ///< 0; in orthotropic materials also 1 and 2
  TemperatureFactor factor;

  double &of(Conduction &c) const { return axis == 0 ? c.conductivity : c.across[axis - 1]; }
};

/** A law of a material, with its parameters. */
struct UsedLaw {
  Part part;
  const LawInfo *info;
  int index;    ///< in the list of laws of its part
  int word;     ///< index of its name in the definition
  LawParameters parameters;

  // set by compose()

  int history = 0;                          ///< first row of its history
  const LawKernels *kernels = nullptr;      ///< for the instruction set that runs
  std::vector<RandomParameter> random;      ///< its parameters that differ between points
  std::vector<VaryingParameter> varying;    ///< its parameters that depend on temperature
  bool varies = false;                      ///< do its LawParameters differ between points?
  bool liquid = false;                      ///< is it a viscosity of the molten part alone?
  /** Is it a strength whose plastic work the damage converts into heat completely? */
  bool heats_alone = false;
};

/** A range of validity in a definition. */
struct UsedRange : ValidRange {
  int word;    ///< index of its quantity in the definition
  /** How the quantity is found if it is not a row of the history. */
  enum { PRESSURE_OF_STRESS = -3, STRAIN_RATE = -2, DENSITY_OF_J = -1 };
};

/** The whole definition; the parser has checked that the parts can be combined. */
struct MaterialDefinition {
  double density = 0.0;
  std::vector<UsedLaw> laws[NPARTS];
  std::vector<UsedRange> ranges;
  std::vector<UsedRandom> random;
  std::vector<UsedVary> vary;

  /** Does a viscosity add to the same part of the stress that a law updates incrementally from step
   *  to step? */
  bool shares_stress() const
  {
    for (const Part part : {CLOSED, STRENGTH})
      for (const auto &law : laws[part])
        for (const auto &viscosity : laws[VISCOSITY])
          if (law.info->share & viscosity.info->share) return true;
    return false;
  }
};

/** Makes the material of a definition; throws MaterialError if a range, a random parameter, or a
 *  parameter that depends on temperature does not fit the material. */
std::unique_ptr<Material> compose(const MaterialDefinition &, const LawTable *);

/** x with up to 15 significant digits. */
inline std::string number(double x)
{
  char text[32];
  snprintf(text, sizeof(text), "%.15g", x);
  return text;
}

/** Name of a law, preceded by the name of its part. */
inline std::string title(const UsedLaw &law)
{
  return std::string(part_name[law.part]) + (law.part == CLOSED ? "" : " ") + law.info->name;
}

}    // namespace MPM_NS
#endif
