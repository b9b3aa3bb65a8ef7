/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Separating walls push where the surface of the material has reached them (mpm_wall_gap.cpp), and not
// as soon as nodes feel it. A disk that rolls toward nodes which hold it from a distance of 1.5 h gets
// a normal force in front of its center, whose moment is larger than that of the friction: it does not spin.

#include "walls/fix_mpm_boundary.h"

#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_stencil.h"
#include "region.h"
#include "update.h"

#include <algorithm>
#include <array>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// error of mean distances, in node spacings, within which they decide nothing in trials of a solver: contact with regions is
// tabulated
static constexpr double NOT_KNOWN = 0.03;
// gap of walls that move and hold, in node spacings, from which on there is a warning; the true gap is about twice as large
static constexpr double NOT_TOUCHED = 0.07;
static constexpr double FILLED = 0.4;    // share of the volume in reach of the node in front

/* ---------------------------------------------------------------------- */

MPMWallContact FixMPMBoundary::Face::contact_of(const MPMField &field, double x) const
{
  if (!cut) {
    const bool folded = field.options.modified_edges;    // see MPMEdges::fold()
    const double at[2] = {0.0, -1.0}, weights[2] = {1.0, 2.0};
    return {field, at, weights, folded ? 2 : 1};
  }
  double at[4];
  const double face = (x - field.lattice.origin[axis]) / field.lattice.h;
  for (int k = 0; k < nweight; k++) at[k] = inward * (first + k - face);
  return {field, at, weight, nweight};
}

/* ----------------------------------------------------------------------
   finds which lines of nodes are touched in this step
------------------------------------------------------------------------- */

void FixMPMBoundary::find_gaps(FieldNodes &list, double dt)
{
  if (region) return find_region_gaps(list, dt);
  MPMField &field = *list.field;
  const Grid &grid = field.grid;
  const double seen = 0.5 * (stencil_order(field.options.shape) + 1);    // reach of a node
  std::vector<char> near;
  for (int f = 0; f < (int) list.faces.size(); f++) {
    const Face &face = list.faces[f];
    const int n = face.cut ? face.nweight : 1;
    near.assign(grid.blocks.size(), 0);
    for (const auto &line : list.lines)
      for (int k = 0; k < n; k++)
        if (line.face == f && line.node[k] >= 0) near[line.node[k] / NODES_PER_BLOCK] = 1;
    const double wall = face.inward > 0 ? domain->boxlo[face.axis] : domain->boxhi[face.axis];
    gap.map(field, near, true, (face.cut ? 2.0 : 1.0) * seen, [&](const double *x) {
      return face.inward * (x[face.axis] - wall);
    });
    for (auto &line : list.lines) {
      if (line.face != f) continue;
      MPMWallGap::Sums sums;
      for (int k = 0; k < n; k++)
        if (line.node[k] >= 0) sums.add(face.cut ? face.weight[k] : 1.0, gap.at(line.node[k]));
      line.touched = sums.touches(face.contact, in_trials ? NOT_KNOWN : 0.0);
    }
  }
}

/** Maps mean distances of the material from the region to the nodes of lines and single nodes. Collective. */
void FixMPMBoundary::map_region_gaps(FieldNodes &list, double dt)
{
  MPMField &field = *list.field;
  // half width of a function: along the axis it is the reach from the surface to a node, and along all axes
  // the distance is at most sqrt(6) times as large
  const double seen = 0.5 * (stencil_order(field.options.shape) + 1);
  std::vector<char> near(field.grid.blocks.size(), 0);
  for (const auto &single : list.singles) near[single.node / NODES_PER_BLOCK] = 1;
  for (const auto &crossing : list.crossings) crossing.mark_blocks(near);
  if (!region_moves()) region->prematch();
  gap.map(field, near, region->nregion == 1, 2.45 * seen, distance_from_region(field, dt));
}

/* ----------------------------------------------------------------------
   Lines of a region that moves and holds act as soon as nodes on both sides of the surface see material, which can be half a
   node spacing in front. Notes the first such place for a warning. Collective
------------------------------------------------------------------------- */

void FixMPMBoundary::note_gaps(FieldNodes &list, double dt)
{
  if (not_touched.told()) return;
  map_region_gaps(list, dt);
  Grid &grid = list.field->grid;
  const auto now = (double) update->ntimestep;
  const double h = list.field->lattice.h;
  for (const auto &crossing : list.crossings) {
    Chain chain;
    if (!is_in_front(grid, crossing) || goes_through(grid, crossing) ||
        !find_chain(list, crossing.node, crossing.weight, crossing.n, 1, chain))
      continue;
    // next to a side of the body, lines see corners that need not be held
    const int64_t ahead = crossing.node[crossing.n - 1];
    if (ahead < 0 || gap.at(ahead).volume < FILLED * std::pow(h, list.field->lattice.dim)) continue;
    MPMWallGap::Sums sums;
    for (int k = 0; k < crossing.n; k++)
      if (crossing.node[k] >= 0) sums.add(crossing.weight[k], gap.at(crossing.node[k]));
    const double beyond = sums.beyond(list.crossed[crossing.full]);
    if (!(beyond > NOT_TOUCHED) || !std::isfinite(beyond)) continue;
    double x[3];
    grid.node_position(crossing.base, x);
    x[crossing.axis] = crossing.surface;
    not_touched.take({now, -beyond, x[0], x[1], x[2]});
  }
  std::array<double, 5> first;
  if (!not_touched.tell(world, first) || comm->me) return;
  error->warning(
      FLERR,
      "Fix mpm/boundary {}: its region {} holds material near {:.6g} {:.6g} {:.6g} across "
      "a gap from step {:.0f} on, as nodes on both sides see it: with {} forces begin "
      "before the material is touched. Use separate, or start with the region at the "
      "surface of the material; this is said only once",
      id, region_id, first[2], first[3], first[4], first[0], kind == STICK ? "stick" : "slip");
}

/* ----------------------------------------------------------------------
   finds which nodes inside a region are touched in this step
------------------------------------------------------------------------- */

void FixMPMBoundary::find_region_gaps(FieldNodes &list, double dt)
{
  MPMField &field = *list.field;
  const double h = field.lattice.h;
  map_region_gaps(list, dt);
  constexpr int PER_CELL = 32;
  auto &contacts = list.contacts;
  for (auto k = contacts.size(); k <= DEEPEST * PER_CELL; k++) {
    const double at = -(double) k / PER_CELL, weight = 1.0;
    contacts.emplace_back(field, &at, &weight, 1);
  }
  for (auto &single : list.singles) {
    const double depth = -single.distance / h;
    single.touched = true;
    if (depth > DEEPEST || !(depth > -0.01))
      continue;    // deep inside, or the distance is not known
    const auto k = (std::size_t) std::lround(std::max(0.0, depth) * PER_CELL);
    single.touched = gap.at(single.node).touches(contacts[k], in_trials ? NOT_KNOWN : 0.0);
  }
  for (auto &crossing : list.crossings) {
    MPMWallGap::Sums sums;
    for (int k = 0; k < crossing.n; k++)
      if (crossing.node[k] >= 0) sums.add(crossing.weight[k], gap.at(crossing.node[k]));
    crossing.touched = sums.touches(list.crossed[crossing.full], in_trials ? NOT_KNOWN : 0.0);
  }
}

/* ----------------------------------------------------------------------
   index of the contact with a crossing, which depends on the place in a cell. slope: cosine between line and normal;
   place: of the surface on the line, in node spacings, growing towards the material
------------------------------------------------------------------------- */

int FixMPMBoundary::crossed_contact(FieldNodes &list, double slope, double place)
{
  constexpr int PLACES = 32, SLOPES = 32;
  if (list.crossed.empty()) {
    list.crossed.resize(PLACES * (SLOPES + 1));
    list.crossed_known.assign(list.crossed.size(), 0);
  }
  const double in_cell = place - std::floor(place);
  const int k = std::min((int) (PLACES * in_cell), PLACES - 1),
            j = (int) std::lround(SLOPES * slope);
  const int index = j * PLACES + k;
  if (list.crossed_known[index]) return index;
  list.crossed_known[index] = 1;
  int first;
  double weight[4], at[4];
  const double x = 16.0 + (k + 0.5) / PLACES;
  const MPMField &field = *list.field;
  const int n =
      weights_at(field, 0, 1, field.lattice.origin[0] + field.lattice.h * x, first, weight);
  for (int node = 0; node < n; node++) at[node] = (first + node - x) * j / SLOPES;
  list.crossed[index] = {field, at, weight, n};
  return index;
}
