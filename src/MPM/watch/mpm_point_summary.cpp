/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "watch/mpm_point_summary.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_physics.h"
#include "field/mpm_point_batches.h"
#include "field/mpm_time_limit.h"
#include "force.h"
#include "material/material.h"
#include "math/matrix.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

// of its initial volume that a point has when nothing holds it any more
static constexpr double COLLAPSED = 1.0e-3;

std::string LAMMPS_NS::point_extremes(LAMMPS *lmp, const MPMField &field)
{
  const Atom *const atom = lmp->atom;
  constexpr double NONE = std::numeric_limits<double>::lowest();
  struct {
    double value;
    int rank;
  } most[3], all[3];    // -J, J, speed
  tagint tags[3] = {0, 0, 0}, of_all[3];
  for (auto &one : most) one = {NONE, lmp->comm->me};
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    const double J = field.points->jacobian(i);
    const double values[3] = {-J, J, sqrt(dot(atom->v[i], atom->v[i]))};
    for (int k = 0; k < 3; k++)
      if (values[k] > most[k].value) {
        most[k].value = values[k];
        tags[k] = atom->tag[i];
      }
  }
  MPI_Allreduce(most, all, 3, MPI_DOUBLE_INT, MPI_MAXLOC, lmp->world);
  for (int k = 0; k < 3; k++)
    if (all[k].rank != lmp->comm->me) tags[k] = 0;
  MPI_Allreduce(tags, of_all, 3, MPI_LMP_TAGINT, MPI_SUM, lmp->world);
  tagint tag;
  double speed, limit, mine = field.time_limit->stable_dt(tag, speed);
  for (const auto *elements : field.elements)
    mine = std::min(mine, elements->stable_dt(tag, speed));
  MPI_Allreduce(&mine, &limit, 1, MPI_DOUBLE, MPI_MIN, lmp->world);

  std::string text;
  if (limit < std::numeric_limits<double>::max())
    text = fmt::format(", at the end {:.2g} of the limit {:.6g}", field.step_dt() / limit, limit);
  if (all[1].value == NONE) return text;
  if (-all[0].value < COLLAPSED && lmp->comm->me == 0)
    lmp->error->warning(
        FLERR,
        "Fix mpm {}: point {} has been pressed to {:.3g} of its volume: its law bears no more than "
        "a finite pressure, or none (corotated, stvenant/kirchhoff, ...), beyond which points "
        "vanish: use one that becomes stiff (neohookean), or check loads and units",
        field.id(), of_all[0], -all[0].value);
  return text +
      fmt::format("\n  volumes {:.4g} (point {}) to {:.4g} (point {}) times the initial ones, "
                  "speeds up to {:.4g} (point {})",
                  -all[0].value, of_all[0], all[1].value, of_all[1], all[2].value, of_all[2]);
}
