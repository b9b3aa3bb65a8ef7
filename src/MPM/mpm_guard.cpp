/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_guard.h"

#include "atom.h"
#include "atom_vec.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix.h"
#include "fix_mpm_material.h"
#include "force.h"
#include "group.h"
#include "material/material.h"
#include "modify.h"
#include "mpm_boxes.h"
#include "mpm_field.h"
#include "mpm_point_batches.h"
#include "mpm_point_map.h"
#include "mpm_points.h"
#include "neighbor.h"
#include "pair.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ---------------------------------------------------------------------- */

MPMGuard::MPMGuard(LAMMPS *lmp, MPMField &field) :
    Pointers(lmp), deleted(), field(field), nbad_total(0)
{
}

bool MPMGuard::may_delete() const
{
  return field.options.bad == MPMFieldOptions::DELETE || field.options.delete_failed;
}

std::string MPMGuard::describe(int i) const
{
  const double *x = atom->x[i], *v = atom->v[i];
  return fmt::format("Material point {} at {:.6g} {:.6g} {:.6g} with velocity {:.6g} {:.6g} {:.6g} "
                     "and J = {:.6g}",
                     atom->tag[i], x[0], x[1], x[2], v[0], v[1], v[2], field.points->jacobian(i));
}

/* ---------------------------------------------------------------------- */

void MPMGuard::point_is_bad(int i, const std::string &what, const std::string &cure,
                            const std::string &hint)
{
  if (field.options.bad == MPMFieldOptions::ERROR)
    error->one(FLERR, "{} {} at step {}{}", describe(i), what, update->ntimestep, hint);
  if (field.options.bad == MPMFieldOptions::WARN && nbad_total + (bigint) bad_points.size() < 10)
    error->warning(FLERR, "{} {} at step {}: {}", describe(i), what, update->ntimestep, cure);
  bad_points.push_back(atom->tag[i]);
}

void MPMGuard::point_has_failed(int i)
{
  failed_points.push_back(atom->tag[i]);
}

/* ---------------------------------------------------------------------- */

void MPMGuard::check_positions()
{
  for (const auto &run : field.map->runs)
    for (int i = run.first; i < run.last; i++) {
      const double *x = atom->x[i];
      if (!std::isfinite(x[0] + x[1] + x[2])) point_is_bad(i, "has lost its position");
    }
}

/* ----------------------------------------------------------------------
   policies warn and delete: count; points to delete, also those that have failed, go at the next
   exchange, made to happen now
------------------------------------------------------------------------- */

void MPMGuard::handle_bad_points()
{
  const bool deletes = field.options.bad == MPMFieldOptions::DELETE;
  bigint n[2] = {(bigint) bad_points.size(), (bigint) failed_points.size()}, all[2];
  MPI_Allreduce(n, all, 2, MPI_LMP_BIGINT, MPI_SUM, world);
  nbad_total += all[0];
  if (!deletes) bad_points.clear();
  if ((all[0] && deletes) || all[1]) field.fix.next_reneighbor = update->ntimestep;
}

/* ----------------------------------------------------------------------
   points outside fixed faces would silently be lost by the exchange that follows
------------------------------------------------------------------------- */

void MPMGuard::check_inside_box()
{
  std::vector<tagint> out;
  double **x = atom->x;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    bool inside = true;
    for (int d = 0; d < 3; d++)
      inside = inside &&
          (domain->periodicity[d] || (x[i][d] >= domain->boxlo[d] && x[i][d] < domain->boxhi[d]));
    if (inside) continue;
    if (field.options.bad == MPMFieldOptions::DELETE)
      out.push_back(atom->tag[i]);
    else
      error->one(FLERR,
                 "{} has left the box through a fixed face; enlarge the box, put a "
                 "fix mpm/boundary there, or let it go with fix mpm ... bad delete",
                 describe(i));
  }
  if (field.options.bad == MPMFieldOptions::DELETE) {
    out.insert(out.end(), bad_points.begin(), bad_points.end());
    delete_points(out, true);
    bad_points.clear();
  }
  if (field.options.delete_failed) {
    delete_points(failed_points, false);
    failed_points.clear();
  }
}

/* ---------------------------------------------------------------------- */

void MPMGuard::delete_points(const std::vector<tagint> &list, bool warn)
{
  std::vector<tagint> sorted(list);
  std::sort(sorted.begin(), sorted.end());
  double lost[5] = {0.0}, all[5];    // points, mass, momentum
  std::vector<double> history;
  for (int i = atom->nlocal - 1; i >= 0 && !sorted.empty(); i--) {
    if (!std::binary_search(sorted.begin(), sorted.end(), atom->tag[i])) continue;
    const double *v = atom->v[i], m = atom->rmass[i];
    lost[0]++;
    lost[1] += m;
    for (int d = 0; d < 3; d++) lost[2 + d] += m * v[d];
    if (field.ledger.on) {
      const double kinetic = 0.5 * force->mvv2e * m * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      const FixMPMMaterial *material = field.material_of(i);
      double w[BATCH];
      load_state(field, *field.batch, &i, 1, material, history);
      material->material->stored_energy(*field.batch, w);
      field.ledger.remove(kinetic, atom->vfrac[i] * w[0] / force->nktv2p);
    }
    atom->avec->copy(atom->nlocal - 1, i, 1);
    atom->nlocal--;
  }
  MPI_Allreduce(lost, all, 5, MPI_DOUBLE, MPI_SUM, world);
  if (all[0] == 0.0) return;
  if (atom->map_style != Atom::MAP_NONE) {    // ghosts do not follow their owners any more
    atom->nghost = 0;
    atom->map_init();
    atom->map_set();
  }
  field.map->valid = false;
  atom->natoms -= (bigint) all[0];
  deleted.points += all[0];
  deleted.mass += all[1];
  for (int d = 0; d < 3; d++) deleted.momentum[d] += all[2 + d];
  if (warn && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm {} deleted {:.0f} points of mass {:.6g} and momentum {:.6g} "
                   "{:.6g} {:.6g} at step {}",
                   field.id(), all[0], all[1], all[2], all[3], all[4], update->ntimestep);
}
