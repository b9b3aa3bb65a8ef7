/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_GEOSTATIC_WATER_H
#define LMP_MPM_GEOSTATIC_WATER_H

#include "pore/mpm_geostatic.h"

#include <vector>

namespace LAMMPS_NS {
class FixMPMMixture;

/** Water at rest in level ground and above it, where the water is a separate field (fix mpm/mixture). See
 *  mpm_geostatic_water.cpp. */
class MPMGeostaticWater : protected Pointers {
 public:
  /** ground: the soil of the mixture. who: first words of error messages. */
  MPMGeostaticWater(class LAMMPS *, const MPMGeostatic &ground, const FixMPMMixture &,
                    const std::string &who);

  /** Sets the pressure of all points of the water by changing their volume. Returns the weight of the soil that
   *  the water carries, for each function of the height (MPMGeostatic::set_stress()). Collective. */
  std::vector<double> set_pressure();
  double top() const { return surface; }    ///< height of the water surface [distance]

 private:
  const MPMGeostatic &ground;
  const FixMPMMixture &mixture;
  MPMField &soil, &water;
  const std::string who;
  double surface, density;
  int nplanes = 0;

  void find_water();
  void find_volumes(std::vector<double> &volumes) const;
  double strain(const std::vector<double> &pressure) const;
  /** Stops with an error if the water does not come to rest. differs: from the pressure of its law; left: share of its weight
   *  that is not carried. */
  void check_rest(const std::vector<double> &pressure, double differs, double left) const;
};

}    // namespace LAMMPS_NS
#endif
