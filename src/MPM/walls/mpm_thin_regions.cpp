/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/mpm_thin_regions.h"

#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "math_extra.h"
#include "region.h"
#include "update.h"
#include "walls/mpm_wall.h"
#include "walls/mpm_wall_nodes.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int LOOK_EVERY = 50;    // steps of this fix between checks

bool MPMThinRegions::is_due() const
{
  return wall.steps % LOOK_EVERY == 1;
}

/** Nodes tell the edges of a tool to half a spacing: what share of its area is this? Half of its
 *  width counts, or all of it where it ends at an axis or a face of the box. */
double MPMThinRegions::error_of_force(const MPMWallNodes &list) const
{
  const Region *const region = wall.region;
  const double *const u = wall.motion.shift;
  const int dim = list.field.lattice.dim;
  if (!region->bboxflag) return 0.0;
  int along = 0;
  for (int d = 1; d < dim; d++)
    if (std::fabs(u[d]) > std::fabs(u[along])) along = d;
  if (!(std::fabs(u[along]) > 0.9 * MathExtra::len3(u))) return 0.0;    // at rest, too
  const double lo[3] = {region->extent_xlo, region->extent_ylo, region->extent_zlo},
               hi[3] = {region->extent_xhi, region->extent_yhi, region->extent_zhi};
  double area = 1.0;
  for (int d = 0; d < dim; d++) {
    if (d == along) continue;
    const bool below = lo[d] <= domain->boxlo[d];
    const bool above = hi[d] >= domain->boxhi[d];
    if (below && above) continue;
    double width = std::min(hi[d], domain->boxhi[d]) - std::max(lo[d], domain->boxlo[d]);
    if (!below && !above) width *= 0.5;
    const double part = 0.5 * list.field.lattice.h / width;
    area *= 1.0 + part;
    if (list.field.options.axisymmetric) area *= 1.0 + part;
  }
  return area - 1.0;
}

/** Is there material at the edges of a narrow tool? */
void MPMThinRegions::look_at_edges(const MPMWallNodes &list, int index)
{
  constexpr double LARGE = 0.1;    // share of the force
  const auto now = (double) update->ntimestep;
  if (!wall.region || !wall.region_moves() || first_edge.knows(now)) return;
  const double error = error_of_force(list);
  if (error < LARGE) return;
  Grid &grid = list.field.grid;
  const auto has_mass = [&](int64_t node) {
    return grid.record(node)[3] > 0.0;
  };
  const auto &nodes = list.nodes;
  const auto &lines = list.crossings.lines;
  if (std::any_of(nodes.begin(), nodes.end(),
                  [&](const MPMWallNode &node) {
                    return node.at_edge && has_mass(node.node);
                  }) ||
      std::any_of(lines.begin(), lines.end(), [&](const MPMCrossing &line) {
        return line.at_edge && has_mass(line.base);
      }))
    first_edge.take({now, (double) index, error, 0.0, 0.0});
}

/** Each rank notes the first such place, in a step with several the first one in space. */
void MPMThinRegions::check(const MPMWallNodes &list, int index)
{
  constexpr double BOTH =
      0.6;    // ratio of masses in front and behind: smaller if material is behind alone
  const auto now = (double) update->ntimestep;
  look_at_edges(list, index);
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
  if (!wall.region) return;
  report_places();
  std::array<double, 5> tool;
  if (first_edge.report(world, tool) && comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/boundary {}: its region {} moves into material and is so narrow that its edges, "
        "which nodes of fix mpm {} tell to half a spacing, are {:.0f} % of it (step {:.0f}): its "
        "force can be wrong by as much, and rises by up to 14 % where it takes nodes. Make the "
        "spacing smaller; this is said only once",
        wall.id, wall.region_id, wall.fields[(std::size_t) tool[1]]->id(), 100.0 * tool[2],
        tool[0]);
}

void MPMThinRegions::report_places()
{
  std::array<double, 5> place;
  if (!first.report(world, place)) return;
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
