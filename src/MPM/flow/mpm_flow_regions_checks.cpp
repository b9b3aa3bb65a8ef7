/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Places where regions are too thin, too near to each other, or in the way of bodies

#include "flow/mpm_flow_regions.h"

#include "contact/fix_mpm_rigid.h"

#include "comm.h"
#include "error.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

// distance between two regions from which on there is a gap, in spacings
static constexpr double LEAST_GAP = 0.05;

/** Is a place in a wall, and has it come there by the motion of the last two steps? */
MPMFlowRegions::Meets MPMFlowRegions::meets(int wall, const double *x) const
{
  const double far = FAR * cells.lattice.h;
  if (distance_from(walls[wall], x, far) >= 0.0) return AWAY;
  double v[3], before[3];    // the place that was as far from the wall as x is now
  velocity_at(wall, x, v);
  for (int d = 0; d < 3; d++) before[d] = x[d] + 2.0 * duration_of_motion * v[d];
  return distance_from(walls[wall], before, far) >= 0.0 ? COMES : INSIDE;
}

/** Warns of bodies that have come into walls or regions. Bodies touch nothing, so that a stone
 *  would go on through the floor unnoticed. Overlap at the start of a run is intended, also where
 *  water, and with it the cells in which overlap is seen, comes later. */
void MPMFlowRegions::warn_of_bodies()
{
  constexpr int FACES = 6;
  const double h = cells.lattice.h;
  std::vector<int> mine((FACES + 1) * n(), 0), all(mine.size());
  for (const auto &cell : cells.cells) {
    if (levels[cell.number] > h || levels[cell.number] < -h) continue;
    for (int w = 0; w < n(); w++) {
      if (!walls[w].body) continue;
      int *const here = &mine[(FACES + 1) * w];
      double offset[3] = {0.5, 0.5, 0.5}, x[3];
      for (int k = 0; k < 2 * dim; k++) {
        if (!(cell.walls >> k & 1) || here[k] == COMES) continue;
        offset[k / 2] = k % 2;
        place(cell.index, offset, x);
        offset[k / 2] = 0.5;
        here[k] = std::max<int>(here[k], meets(w, x));
      }
      if (here[FACES] == COMES || !(levels[cell.number] < 0.0)) continue;
      place(cell.index, offset, x);
      const int own = meets(w, x);
      for (int other = 0; other < n() && own != AWAY; other++) {
        const int its = other == w ? AWAY : meets(other, x);
        if (its != AWAY) here[FACES] = std::max({here[FACES], own, its});
      }
    }
  }
  MPI_Allreduce(mine.data(), all.data(), (int) all.size(), MPI_INT, MPI_MAX, world);
  const bool first = met.empty();
  met.resize(all.size());
  for (int k = 0; k < (int) all.size(); k++) {
    if (all[k] == AWAY || met[k]) continue;
    met[k] = 1;
    if (all[k] != COMES || first) continue;
    const int face = k % (FACES + 1);
    if (comm->me == 0)
      error->warning(FLERR,
                     "Fix mpm/incompressible: the body of fix {} goes through {}, as bodies in a "
                     "flow touch neither each other nor walls: end the run before, or hold it",
                     walls[k / (FACES + 1)].body->id,
                     face == FACES ? std::string("another region")
                                   : fmt::format("wall {}{}", (char) ('x' + face / 2),
                                                 face % 2 ? "hi" : "lo"));
  }
}

/** Is there a wall between the middles of opposite faces that are both open? */
bool MPMFlowRegions::is_thin(const MPMFlowLattice::Cell &cell) const
{
  constexpr double OPEN = 0.75, TOWARDS = 0.5;
  const double h = cells.lattice.h;
  for (int d = 0; d < dim; d++) {
    if (aperture(cell.number, d) < OPEN || aperture(cell.near[2 * d + 1], d) < OPEN) continue;
    double from_wall[2], sum = 0.0;
    for (int s = 0; s < 2; s++) {
      double offset[3] = {0.5, 0.5, 0.5}, x[3], n[3];
      offset[d] = s;
      place(cell.index, offset, x);
      int wall;
      sum += distance(x, FAR * h, wall);
      normal_at(wall, x, n);
      from_wall[s] = n[d];
    }
    if (sum < 1.001 * h && from_wall[0] < -TOWARDS && from_wall[1] > TOWARDS && !is_corner(cell, d))
      return true;
  }
  return false;
}

/** A corner of a wall that ends in the cell is as thin there, but lets nothing through: next to the
 *  cell, the wall is thicker than a cell. */
bool MPMFlowRegions::is_corner(const MPMFlowLattice::Cell &cell, int axis) const
{
  // cells up to which a corner of 60 degrees gets that thick, wherever it ends in the cell
  constexpr int NEAR = 2;
  for (int e = 0; e < dim; e++) {
    if (e == axis) continue;
    for (int along = -NEAR; along <= NEAR; along++) {
      int index[3] = {cell.index[0], cell.index[1], cell.index[2]}, wall;
      index[e] += along;
      bool solid = along != 0;
      for (int s = 0; s < 2 && solid; s++) {
        double offset[3] = {0.5, 0.5, 0.5}, x[3];
        offset[axis] = s;
        place(index, offset, x);
        solid = distance(x, FAR * cells.lattice.h, wall) < 0.0;
      }
      if (solid) return true;
    }
  }
  return false;
}

/** Less than a spacing between two regions that face each other: a cell has only a part of one
 *  wall, so that forces on the other wall would count as forces on this one. */
bool MPMFlowRegions::is_gap(const MPMFlowLattice::Cell &cell) const
{
  constexpr double AGAINST = -0.5, middle[3] = {0.5, 0.5, 0.5};
  const double h = cells.lattice.h, far = FAR * h;
  double x[3], normal[2][3];
  int wall;
  place(cell.index, middle, x);
  const double first = distance(x, far, wall);
  normal_at(wall, x, normal[0]);
  for (int w = 0; w < n(); w++) {
    const double sum = w == wall ? 0.0 : first + distance_from(walls[w], x, far);
    if (!(sum > LEAST_GAP * h && sum < 0.999 * h)) continue;
    normal_at(w, x, normal[1]);
    if (MathExtra::dot3(normal[0], normal[1]) < AGAINST) return true;
  }
  return false;
}

/** Warns of regions through which the flow goes, and of gaps between regions. */
void MPMFlowRegions::warn_of_thin(int nthin, int ngaps)
{
  const int mine[2] = {nthin, ngaps};
  int all[2];
  MPI_Allreduce(mine, all, 2, MPI_INT, MPI_SUM, world);
  if (!all[0] && !all[1]) return;
  warned_of_thin = true;
  if (comm->me) return;
  if (all[0])
    error->warning(
        FLERR,
        "Fix mpm/incompressible: regions are thinner than a node spacing in {} cells, so that "
        "the flow goes through: use a smaller node spacing, or thicker walls",
        all[0]);
  if (all[1])
    error->warning(
        FLERR,
        "Fix mpm/incompressible: regions leave gaps of less than a node spacing in {} cells, in "
        "which the flow, its pressure, and the forces on either region are wrong: use a smaller "
        "node spacing, or close the gap",
        all[1]);
}
