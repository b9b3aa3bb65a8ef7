/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLUID_H
#define LMP_MPM_FLUID_H

#include <string>

namespace LAMMPS_NS {

/** An incompressible fluid with a lattice of its own, for what moves in it or flows into it.
 *  Implemented by a fix. */
class MPMFluid {
 public:
  /** Node spacing. */
  virtual double spacing() const = 0;
  /** Node spacing if the region is solid for the fluid, else 0. */
  virtual double spacing_around(const std::string &region) const = 0;
  /** Density of points in groups with these bits, that are no solids. */
  virtual double density_of_groups(int mask) const = 0;
  /** Stops with an error if the density of the fluid given by another fix differs. who: the start
   *  of the message. */
  virtual void check_density(double of_fluid, const std::string &who) const = 0;

 protected:
  ~MPMFluid() = default;    // owned and deleted as a Fix
};

}    // namespace LAMMPS_NS
#endif
