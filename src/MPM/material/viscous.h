/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_VISCOUS_H
#define MPM_MATERIAL_VISCOUS_H

namespace MPM_NS {

class Material;

/** Does it have a viscosity, of any kind? If not, then the stress of a fluid with Material::is_barotropic() is the
 *  pressure that belongs to its volume. For materials of Material::create(). */
bool is_viscous(const Material &);

}    // namespace MPM_NS
#endif
