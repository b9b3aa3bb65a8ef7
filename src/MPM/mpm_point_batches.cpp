/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_point_batches.h"

#include "atom.h"
#include "fix_mpm_material.h"
#include "material/material.h"
#include "modify.h"
#include "mpm_field.h"

#include <memory>
#include <vector>

using namespace LAMMPS_NS;
using namespace MPM_NS;

void LAMMPS_NS::visit_point_batches(LAMMPS *lmp, int groupbit, const BatchVisitor &visit)
{
  const Atom *atom = lmp->atom;
  auto batch = std::make_unique<Batch>();
  std::vector<double> history;
  std::vector<int> list;
  list.reserve(BATCH);

  for (const auto *field : MPMField::all(lmp)) {
    for (auto *material : field->materials) {
      auto flush = [&]() {
        if (list.empty()) return;
        field->load_state(*batch, list.data(), (int) list.size(), material, history);
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
}
