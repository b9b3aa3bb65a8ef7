/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_rest.h"

#include "field/mpm_affine.h"
#include "field/mpm_field.h"
#include "field/mpm_internal_force.h"
#include "transfer/kernels.h"

#include "atom.h"

#include <algorithm>

using namespace LAMMPS_NS;

void LAMMPS_NS::put_to_rest(MPMField &field, double taken[2])
{
  const double energy = field.ledger.point_kinetic_energy();
  field.ledger.take(energy);
  taken[0] += energy;
  const auto *const atom = field.atom;
  double power = 0.0;
  const int nC = field.affine ? field.affine->size() : 0,
            nQ = field.affine && field.affine->Q ? MPM_NS::poly_size(field.lattice.dim) : 0;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    double f[3] = {atom->f[i][0], atom->f[i][1], atom->f[i][2]};
    for (const auto *ifix : field.elements)
      for (int d = 0; d < 3; d++) f[d] -= ifix->forces()[3 * (bigint) i + d];
    for (int d = 0; d < 3; d++) power += f[d] * atom->v[i][d];
    std::fill_n(atom->v[i], 3, 0.0);
    if (nC) std::fill_n(field.affine->C[i], nC, 0.0);
    if (nQ) std::fill_n(field.affine->Q[i], nQ, 0.0);
  }
  taken[1] -= 0.5 * power * field.step_dt();
}
