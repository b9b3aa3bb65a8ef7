/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "watch/mpm_fracture_watch.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_cpdi.h"
#include "field/mpm_field.h"
#include "field/mpm_point_batches.h"
#include "fix.h"
#include "force.h"
#include "material/material.h"
#include "math/matrix.h"
#include "modify.h"
#include "update.h"

#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int LOOK_EVERY = 400;    // steps
static constexpr double TENSION =
    1.0e-3;    // of density times wave speed squared: a solid holds together

/** Distance of neighbors, in node spacings, from which on bodies have come apart in trials: a
 *  cantilever of rubber, with three spacings. Bounds of tests with bars: unittest/BOUNDS.md
 *  (Fracture). */
static double limit(Shape shape)
{
  return shape == QUADRATIC ? 1.2 : shape == CUBIC ? 1.15 : 1.0;
}

void MPMFractureWatch::step()
{
  if (++steps % LOOK_EVERY == 0) look();
}

/** Points are as far apart as the undeformed edges of a point, with F. What has no neighbor in this
 *  direction is found, too, but is not stretched. */
void MPMFractureWatch::look()
{
  if (warned) return;
  const auto &options = field.options;
  const double most = limit(options.shape), h = field.lattice.h;
  struct {
    double distance;
    int rank;
  } mine = {0.0, comm->me}, widest;
  double point[4] = {0.0};    // ID, position
  int of_elements =
      0;    // their nodes hold together by elements, wherever nodes of the lattice are
  for (const auto *fix : modify->get_fix_by_style("^mpm/elements$")) of_elements |= fix->groupbit;
  visit_point_batches(
      lmp, field.fix.groupbit,
      [&](const Batch &b, const int *list, const FixMPMMaterial &material) {
        if (!material.material->is_solid()) return;
        double c[BATCH];
        bool known = false;
        for (int p = 0; p < b.n; p++) {
          if (atom->mask[list[p]] & of_elements) continue;
          const double edge = 2.0 * half_size(field, list[p]);
          for (int k = 0; k < field.lattice.dim; k++) {
            const double a[3] = {b.F[k][p], b.F[3 + k][p], b.F[6 + k][p]}, square = dot(a, a);
            const double distance = edge * options.aspect[k] * sqrt(square);
            if (!(distance > most) || distance <= mine.distance) continue;
            if (!known) material.material->wave_speed(b, c);
            known = true;
            const double xx = b.stress[0][p], yy = b.stress[1][p], zz = b.stress[2][p];
            const double tension =
                (a[0] * a[0] * xx + a[1] * a[1] * yy + a[2] * a[2] * zz +
                 2.0 *
                     (a[0] * a[1] * b.stress[3][p] + a[0] * a[2] * b.stress[4][p] +
                      a[1] * a[2] * b.stress[5][p])) /
                square;
            const double holds =
                TENSION * material.material->density() * c[p] * c[p] * force->mvv2e * force->nktv2p;
            if (!(tension > 0.0) || !(tension - (xx + yy + zz) / 3.0 > holds)) continue;
            mine.distance = distance;
            point[0] = (double) atom->tag[list[p]];
            for (int d = 0; d < 3; d++) point[1 + d] = atom->x[list[p]][d];
          }
        }
      });
  MPI_Allreduce(&mine, &widest, 1, MPI_DOUBLE_INT, MPI_MAXLOC, world);
  if (!(widest.distance > most)) return;
  warned = true;
  MPI_Bcast(point, 4, MPI_DOUBLE, widest.rank, world);
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm {}: material under tension is stretched so far that its points are up "
                   "to {:.3g} node spacings ({:.4g}) apart, near point {:.0f} at {:.6g} {:.6g} "
                   "{:.6g} at step {}: it comes apart numerically. Use frame total, shape cpdi, or "
                   "more points per cell; fix mpm ... apart ignore accepts it",
                   field.id(), widest.distance, widest.distance * h, point[0], point[1], point[2],
                   point[3], update->ntimestep);
}
