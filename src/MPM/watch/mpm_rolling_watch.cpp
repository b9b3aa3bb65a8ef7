/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "watch/mpm_rolling_watch.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_friction_heat.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace LAMMPS_NS;

/** Has the point turned by an angle whose sine is more than this, or by a right angle or more, and
 *  is it hardly strained [change of squared lengths]? */
static bool is_turned(const double *F)
{
  constexpr double SINE = 0.2, STRAIN = 0.1;
  const double twice[3] = {F[7] - F[5], F[2] - F[6], F[3] - F[1]};
  const bool is_acute = F[0] + F[4] + F[8] > 1.0;    // 1 + 2 cos(angle)
  if (is_acute && std::hypot(twice[0], twice[1], twice[2]) < 2.0 * SINE) return false;
  for (int a = 0; a < 3; a++)
    for (int b = a; b < 3; b++) {
      const double C = F[a] * F[b] + F[3 + a] * F[3 + b] + F[6 + a] * F[6 + b];
      if (std::fabs(C - (a == b)) > STRAIN) return false;
    }
  return true;
}

/** The normal force of what rolls is ahead of its middle, by less the finer the lattice is. */
void MPMRollingWatch::finish()
{
  // node spacings by which it is, as found in trials, and the share of the torque of friction that
  // is told
  constexpr double AHEAD = 0.15, LARGE = 0.1;
  const auto &points = *MPMPoints::get(atom);
  if (warned || points.round.empty()) return;
  double friction = HUGE_VAL;    // the least one
  for (const auto *fix : find_fixes<MPMRubbing>(lmp))
    if (fix->coefficient() > 0.0) friction = std::min(friction, fix->coefficient());
  if (friction == HUGE_VAL) return;

  const int ntypes = atom->ntypes;
  std::vector<double> mine(2 * ntypes), all(2 * ntypes);    // points of a type, turned ones
  for (int i = 0; i < atom->nlocal; i++) {
    const int type = atom->type[i];
    if (!field.is_point(i) || points.round[type].radius == 0.0) continue;
    mine[2 * (type - 1)]++;
    if (is_turned(points.F[i])) mine[2 * (type - 1) + 1]++;
  }
  MPI_Allreduce(mine.data(), all.data(), 2 * ntypes, MPI_DOUBLE, MPI_SUM, world);
  for (int type = 1; type <= ntypes && !warned; type++) {
    const auto &body = points.round[type];
    if (!(all[2 * type - 1] > 0.5 * all[2 * type - 2])) continue;
    const double part = AHEAD * field.lattice.h / (friction * body.radius);
    if (!body.has_steps && part < LARGE) continue;
    warned = true;
    if (comm->me) return;
    if (body.has_steps)
      error->warning(
          FLERR,
          "Fix mpm {}: points of type {} have turned where friction acts, and create_points cut "
          "them out of a lattice as whole points: if this is a round body, it rolls and slips as a "
          "polygon, and gets 7 to 50 % too little spin where it slips, with any spacing: use "
          "create_points ... cut yes, or relax 20 for points of equal masses",
          field.id(), type);
    else
      error->warning(
          FLERR,
          "Fix mpm {}: points of type {} have turned where friction acts: if this is a round body, "
          "the normal force is up to {} node spacings ahead of its middle, which takes {:.0f} % of "
          "the spin where it slips, and {:.1f} % of its radius as resistance where it rolls: make "
          "the spacing smaller",
          field.id(), type, AHEAD, 100.0 * part, 100.0 * part * friction);
  }
}
