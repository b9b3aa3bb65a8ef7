/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_guard.h"

#include "base/mpm_points.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_passes.h"
#include "field/mpm_point_batches.h"
#include "field/mpm_point_map.h"
#include "field/mpm_traffic.h"
#include "fix.h"
#include "neighbor.h"
#include "output.h"
#include "thermo.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

std::string MPMGuard::describe(int i) const
{
  const double *x = atom->x[i], *v = atom->v[i];
  return fmt::format(
      "Material point {} at {:.6g} {:.6g} {:.6g} with velocity {:.6g} {:.6g} {:.6g} and J = {:.6g}",
      atom->tag[i], x[0], x[1], x[2], v[0], v[1], v[2], field.points->jacobian(i));
}

void MPMGuard::point_is_bad(int i, const std::string &what, const std::string &cure,
                            const std::string &hint)
{
  if (field.options.bad == MPMFieldOptions::ERROR)
    error->one(FLERR, "{} {} at step {}{}", describe(i), what, update->ntimestep, hint);
  if (field.options.bad == MPMFieldOptions::WARN && nbad_total + (bigint) bad_points.size() < 10)
    error->warning(FLERR, "{} {} at step {}: {}", describe(i), what, update->ntimestep, cure);
  bad_points.push_back(atom->tag[i]);
}

void MPMGuard::check_positions()
{
  // nothing can be done with a point whose position is not finite: unless it is deleted, it ends
  // the run as one outside the box
  each_point(field, [&](const MPMPointMap::Run &, int i) {
    const double *x = atom->x[i];
    if (std::isfinite(x[0] + x[1] + x[2])) return;
    if (field.options.bad == MPMFieldOptions::WARN)
      error->one(FLERR, "{} has lost its position at step {}", describe(i), update->ntimestep);
    point_is_bad(i, "has lost its position");
  });
}

void MPMGuard::handle_bad_points()
{
  if (field.options.bad == MPMFieldOptions::ERROR && !may_delete()) return;
  const bool deletes = field.options.bad == MPMFieldOptions::DELETE;
  bigint n[2] = {(bigint) bad_points.size(), (bigint) failed_points.size()}, all[2];
  MPI_Allreduce(n, all, 2, MPI_LMP_BIGINT, MPI_SUM, world);
  nbad_total += all[0];
  if (!deletes) bad_points.clear();
  if ((all[0] && deletes) || all[1]) field.fix.next_reneighbor = update->ntimestep;
}

void MPMGuard::wrap_far_points()
{
  constexpr double LIMIT = 1.0e6;    // periods; a point that is farther away is lost
  if (neighbor->dist_check && !neighbor->build_once && neighbor->every == 1 &&
      neighbor->delay == 0 && !neighbor->includegroup)
    return;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    double most = 0.0;    // periods from the middle of the box
    for (int d = 0; d < field.lattice.dim; d++)
      if (domain->periodicity[d])
        most = std::max(most,
                        fabs(atom->x[i][d] - 0.5 * (domain->boxlo[d] + domain->boxhi[d])) /
                            domain->prd[d]);
    if (most > 1.5 && most < LIMIT) domain->remap(atom->x[i], atom->image[i]);
  }
}

void MPMGuard::check_inside_box()
{
  wrap_far_points();
  const bool deletes = field.options.bad == MPMFieldOptions::DELETE;
  double **x = atom->x;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    bool inside = true, somewhere = true;    // LAMMPS wraps by at most one period
    for (int d = 0; d < 3; d++) {
      const double from_middle = fabs(x[i][d] - 0.5 * (domain->boxlo[d] + domain->boxhi[d]));
      if (domain->periodicity[d])
        somewhere = somewhere && from_middle <= 1.5 * domain->prd[d];
      else
        inside = inside && x[i][d] >= domain->boxlo[d] && x[i][d] < domain->boxhi[d];
    }
    if (inside && somewhere) continue;
    if (deletes)
      bad_points.push_back(atom->tag[i]);
    else if (!somewhere)
      error->one(FLERR, "{} has lost its position at step {}: it is periods of the box away",
                 describe(i), update->ntimestep);
    else
      error->one(
          FLERR,
          "{} has left the box through a fixed face; enlarge the box, put a fix "
          "mpm/boundary there, or let it go with fix mpm ... bad delete (through a wall goes "
          "only what is much too soft for its load: check moduli and units)",
          describe(i));
  }
  if (deletes) delete_points(bad_points, true);
  if (field.options.delete_failed) delete_points(failed_points, false);
}

/** LAMMPS reports the number of lost atoms with thermodynamic output, but not which ones are
 *  lost. */
void MPMGuard::tell_lost_atoms() const
{
  if (atom->natoms <= npoints || output->thermo->lostflag == Thermo::IGNORE) return;
  bigint lost = 0, all;
  int example = -1;
  for (int i = 0; i < atom->nlocal; i++) {
    if (atom->vfrac[i] > 0.0) continue;
    const double *const x = atom->x[i];
    bool inside = true;
    for (int d = 0; d < 3; d++)
      inside = inside &&
          (domain->periodicity[d] || (x[d] >= domain->boxlo[d] && x[d] < domain->boxhi[d]));
    if (inside) continue;
    lost++;
    if (example < 0 || atom->tag[i] < atom->tag[example]) example = i;
  }
  MPI_Allreduce(&lost, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all == 0) return;
  const tagint first = example < 0 ? MAXTAGINT : atom->tag[example];
  tagint first_all;
  MPI_Allreduce(&first, &first_all, 1, MPI_LMP_TAGINT, MPI_MIN, world);
  double state[6] = {0.0}, state_all[6];
  if (first == first_all) {
    std::copy_n(atom->x[example], 3, state);
    std::copy_n(atom->v[example], 3, state + 3);
  }
  MPI_Reduce(state, state_all, 6, MPI_DOUBLE, MPI_SUM, 0, world);
  if (comm->me == 0)
    error->warning(FLERR,
                   "{} atoms that are no material points have left the box through a fixed face "
                   "and are lost at step {}, for instance atom {} at {:.6g} {:.6g} {:.6g} with "
                   "velocity {:.6g} {:.6g} {:.6g}: enlarge the box, put a wall there (fix "
                   "wall/gran), or give thermo_modify lost ignore",
                   all, update->ntimestep, first_all, state_all[0], state_all[1], state_all[2],
                   state_all[3], state_all[4], state_all[5]);
}

void MPMGuard::delete_points(std::vector<tagint> &list, bool warn)
{
  std::vector<tagint> sorted;
  sorted.swap(list);
  std::sort(sorted.begin(), sorted.end());
  const MPMTraffic gone = remove_points(
      lmp,
      [&](int i) {
        return std::binary_search(sorted.begin(), sorted.end(), atom->tag[i]);
      },
      false);
  if (gone.points == 0.0) return;
  deleted.points += gone.points;
  deleted.mass += gone.mass;
  for (int d = 0; d < 3; d++) deleted.momentum[d] += gone.momentum[d];
  if (warn && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm {} deleted {:.0f} points of mass {:.6g} and momentum {:.6g} {:.6g} "
                   "{:.6g} at step {}",
                   field.id(), gone.points, gone.mass, gone.momentum[0], gone.momentum[1],
                   gone.momentum[2], update->ntimestep);
}
