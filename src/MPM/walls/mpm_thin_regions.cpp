/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/mpm_thin_regions.h"

#include "comm.h"
#include "error.h"
#include "field/mpm_field.h"
#include "update.h"
#include "walls/mpm_wall.h"
#include "walls/mpm_wall_nodes.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int LOOK_EVERY = 50;    // steps of this fix between checks

bool MPMThinRegions::is_due() const
{
  return wall.steps % LOOK_EVERY == 1;
}

/** Each rank notes the first such place, in a step with several the first one in space. */
void MPMThinRegions::check(const MPMWallNodes &list, int index)
{
  constexpr double BOTH =
      0.6;    // ratio of masses in front and behind: smaller if material is behind alone
  const auto now = (double) update->ntimestep;
  if (first.knows(now)) return;
  Grid &grid = list.field.grid;
  const auto note = [&](const MPMCrossing &c) {
    double x[3];
    grid.node_position(c.base, x);
    first.take({now, (double) index, x[0], x[1], x[2]});
  };
  const auto has_mass = [&](int64_t node) {
    return node >= 0 && grid.record(node)[3] > 0.0;
  };
  // another rank may know masses of nodes that this one lacks
  const auto judges = [&](const MPMCrossing &c) {
    return comm->nprocs == 1 || std::count(c.node, c.node + c.inside, -1) == 0;
  };
  for (const auto &c : list.crossings.at_blades)
    if (has_mass(c.node[c.inside - 1]) && judges(c) && c.is_in_front(grid)) note(c);
  for (const auto &c : list.crossings.lines)
    if (c.in_plate && judges(c) && !c.is_in_front(grid) && !c.is_behind(grid, BOTH)) note(c);
}

void MPMThinRegions::report()
{
  std::array<double, 5> place;
  if (!wall.region || !first.report(world, place)) return;
  wall.looks_for_thin_places = false;
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/boundary {}: its region {} is thinner than 1.5 node spacings of fix mpm {} near "
        "{:.6g} {:.6g} {:.6g}, where material is at its edge or on both sides (step {:.0f}): its "
        "force can be wrong by tens of percent or zero, and material can pass through it. Make it "
        "thicker there, or the spacing smaller; this is said only once",
        wall.id, wall.region_id, wall.fields[(std::size_t) place[1]]->id(), place[2], place[3],
        place[4], place[0]);
}
