/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/airbag,FixMPMAirbag);
// clang-format on
#else

#ifndef LMP_FIX_MPM_AIRBAG_H
#define LMP_FIX_MPM_AIRBAG_H

#include "declare/option.h"
#include "elements/fix_mpm_elements.h"
#include "fix.h"
#include "math/bag_gas.h"

#include <string>

namespace LAMMPS_NS {

/** Keywords of fix mpm/airbag. */
struct MPMAirbagOptions {
  std::string elements_id;
  MPM_NS::NumberOrVariable pressure;    ///< difference to the pressure outside
  bool has_pressure = false, has_gas = false, has_inflow = false;
  double p = 0.0, gamma = 1.4, outside = 0.0;    ///< initial pressure, adiabatic exponent; outside
  double temperature = 0.0, R = 0.0;       ///< of the initial gas and of that outside; 0: not given
  MPM_NS::NumberOrVariable inflow[2];      ///< mass per time; temperature
  double vent = 0.0, coefficient = 1.0;    ///< area of the vents, and their discharge coefficient
  double opens = 0.0;    ///< difference to the pressure outside at which the vents open for good

  MPM_NS::Options declare();
};

/** Pressure on one side of a surface of fix mpm/elements: a given one, or that of a gas if the
 *  surface is a closed bag. */
class FixMPMAirbag : public Fix, private MPMAirbagOptions, private MPMElementsPressure {
 public:
  FixMPMAirbag(class LAMMPS *, int, char **);
  int setmask() override { return 0; }
  void init() override;
  double compute_scalar() override { return over; }
  double compute_vector(int) override;
  void write_restart(FILE *) override;
  void restart(char *) override;

 private:
  class FixMPMElements *elements = nullptr;
  MPM_NS::BagGas gas;
  bool filled = false;           // does the gas have a volume yet?
  bool open = false;             // are the vents open?
  double over = 0.0;             // present pressure minus that outside
  double volume = 0.0;           // present
  double area = 0.0;             // present
  double in = 0.0, out = 0.0;    // mass that flowed in and out so far

  double on_surface(double volume, double area, bool starting) override;
  bool is_given() const override { return has_pressure; }
  double stiffness(double volume) const override;
  void flow(double dt);
};

}    // namespace LAMMPS_NS
#endif
#endif
