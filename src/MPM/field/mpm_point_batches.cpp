/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_point_batches.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_physics.h"
#include "material/material.h"

#include <memory>
#include <vector>

using namespace LAMMPS_NS;
using namespace MPM_NS;

void LAMMPS_NS::load_state(MPMField &field, Batch &b, const int *list, int n,
                           const FixMPMMaterial *material)
{
  const MPMPoints &points = *field.points;
  b.n = n;
  b.dt = field.step_dt();
  b.h = field.lattice.h;
  b.history = reinterpret_cast<double(*)[BATCH]>(field.work.history.data());
  for (int p = 0; p < n; p++) {
    const int i = list[p];
    const double *F = points.F[i];
    for (int c = 0; c < 9; c++) b.F[c][p] = F[c];
    b.J[p] = points.jacobian(i);
    for (int c = 0; c < 6; c++) b.stress[c][p] = points.tau[i][c] / b.J[p];
    b.vol0[p] = field.atom->vfrac[i];
    for (int k = 0; k < material->nhistory; k++) b.history[k][p] = material->history[i][k];
  }
}

void LAMMPS_NS::visit_point_batches(LAMMPS *lmp, int groupbit, const BatchVisitor &visit)
{
  const Atom *atom = lmp->atom;
  auto batch = std::make_unique<Batch>();
  std::vector<int> list;
  list.reserve(BATCH);

  for (auto *field : MPMField::all(lmp)) {
    field->find_materials();
    for (int i = 0; i < atom->nlocal; i++)
      if ((atom->mask[i] & groupbit) && field->is_point(i) && !field->material_of(i))
        lmp->error->one(FLERR, Error::NOLASTLINE,
                        "Material point {} of fix mpm {} has no material: define a fix "
                        "mpm/material for its group",
                        atom->tag[i], field->id());
    for (auto *material : field->materials) {
      auto flush = [&]() {
        if (list.empty()) return;
        load_state(*field, *batch, list.data(), (int) list.size(), material);
        visit(*batch, list.data(), *material);
        list.clear();
      };

      for (int i = 0; i < atom->nlocal; i++) {
        if (!(atom->mask[i] & groupbit) || !field->is_point(i)) continue;
        if (field->material_of(i) != material) continue;
        list.push_back(i);
        if ((int) list.size() == BATCH) flush();
      }
      flush();
    }
  }
  for (auto *owner : find_fixes<MPMPointOwner>(lmp)) owner->visit_batches(groupbit, visit);
}
