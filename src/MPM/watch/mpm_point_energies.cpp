/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "watch/mpm_point_energies.h"

#include "atom.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_internal_force.h"
#include "field/mpm_physics.h"
#include "field/mpm_point_batches.h"
#include "force.h"
#include "material/material.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

MPMPointEnergies LAMMPS_NS::point_energies(LAMMPS *lmp)
{
  const Atom *const atom = lmp->atom;
  const Force *const force = lmp->force;
  MPMPointEnergies mine = {};

  for (const auto *field : MPMField::all(lmp)) mine.kinetic += field->ledger.point_kinetic_energy();

  for (const auto *material : find_fixes<FixMPMMaterial>(lmp)) {
    mine.plastic += material->work[Work::PLASTIC];
    mine.viscous += material->work[Work::VISCOUS];
    mine.heat += material->work[Work::HEAT];
    mine.fracture += material->work[Work::FRACTURE];
    mine.thermoelastic += material->work[Work::THERMOELASTIC];
  }

  int nodes = 0;    // groups of nodes of elements, which store the energy
  for (auto *elements : find_fixes<MPMInternalForce>(lmp)) {
    nodes |= elements->group_of_points();
    if (elements->on_lattice()) mine.stored += elements->stored_energy();
  }
  visit_point_batches(lmp, 1,
                      [&](const Batch &batch, const int *list, const FixMPMMaterial &material) {
                        double w[BATCH];
                        material.material->stored_energy(batch, w);
                        for (int k = 0; k < batch.n; k++)
                          if (!(atom->mask[list[k]] & nodes)) mine.stored += batch.vol0[k] * w[k];
                      });
  for (double *energy : {&mine.plastic, &mine.viscous, &mine.heat, &mine.fracture,
                         &mine.thermoelastic, &mine.stored})
    *energy /= force->nktv2p;
  return mine;
}
