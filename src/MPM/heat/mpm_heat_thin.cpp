/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   A node whose function reaches both surfaces of a body gets parts of V grad N of both, which
   cancel: what is left belongs to a smaller area. That happens where the body is thinner than the
   functions are wide, 3 node spacings for quadratic functions and 4 for cubic ones. It is found by
   looking that deep along the normal: in a thin body, there is no material just behind this depth.
   At edges and corners there is, as far as they are not sharper than a right angle. The area of the
   lines would not show the difference, because it is small at edges, too.
------------------------------------------------------------------------- */

#include "heat/mpm_heat_thin.h"

#include "field/mpm_field.h"
#include "heat/mpm_heat_body.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int LOOK_EVERY = 50;    // steps
// node spacings behind the width of the functions at which material is looked for
static constexpr double BEHIND = 0.3;
// greatest filled share of the volume of nodes at an empty place
static constexpr double EMPTY = 0.2;
static constexpr double KNOWN = 0.5;         // least share of the nodes there that are known
static constexpr double LEAST_ROOM = 0.1;    // least share of the nodes there that is in the box
// share of the area that is too thin: less would not change the sum by 3 %
static constexpr double MUCH = 0.05;

/* ----------------------------------------------------------------------
   Is the place empty of material? 1: yes, 0: no, -1: unknown. Nothing is known where no points have
   been summed up; with one rank, nodes that have no block have no points.
------------------------------------------------------------------------- */

static int is_empty(const MPMHeatBody &body, const double *at)
{
  const auto &lattice = body.field.lattice;
  int first[3] = {0, 0, 0};
  for (int d = 0; d < lattice.dim; d++) first[d] = (int) std::floor(at[d]);
  double known = 0.0, share = 0.0, room = 0.0;
  for (int k = 0; k < (1 << lattice.dim); k++) {
    int index[3] = {0, 0, 0};
    double w = 1.0, inside = 1.0;
    for (int d = 0; d < lattice.dim; d++) {
      const int up = k >> d & 1;
      const double part = at[d] - first[d];
      w *= up ? part : 1.0 - part;
      inside *= body.room(d, first[d] + up);
      index[d] = lattice.wrap(d, first[d] + up);
    }
    const int64_t node = body.field.grid.locate(index);
    if (node < 0 ? !body.knows_all() : !body.near[node / NODES_PER_BLOCK]) continue;
    known += w;
    room += w * inside;
    if (node >= 0) share += w * body.share[node];
  }
  if (known < KNOWN) return -1;
  // material at a face of the box goes on behind it
  return room > LEAST_ROOM && share < EMPTY * room;
}

/* ---------------------------------------------------------------------- */

bool MPMHeatThin::looks(int nentries)
{
  if (warned || steps++ % LOOK_EVERY) return false;
  areas.assign(nentries, {0.0, 0.0});
  notes.assign(nentries, {});
  return true;
}

void MPMHeatThin::take(int entry, const MPMHeatBody &body, const double *at, const double *into,
                       double area)
{
  const auto &lattice = body.field.lattice;
  const double deep = 2.0 * body.profile.reach() + BEHIND;
  double behind[3] = {0.0, 0.0, 0.0};
  for (int d = 0; d < lattice.dim; d++) behind[d] = at[d] + deep * into[d];
  const int empty = is_empty(body, behind);
  if (empty < 0) return;
  areas[entry][1] += area;
  if (!empty) return;
  areas[entry][0] += area;
  double x[3] = {0.0, 0.0, 0.0};
  for (int d = 0; d < lattice.dim; d++) x[d] = lattice.origin[d] + at[d] * lattice.h;
  notes[entry].take({0.0, x[0], x[1], x[2]});
}

bool MPMHeatThin::report(MPI_Comm world, Found &found)
{
  std::vector<std::array<double, 2>> all(areas.size());
  MPI_Allreduce(areas.data(), all.data(), 2 * (int) areas.size(), MPI_DOUBLE, MPI_SUM, world);
  for (std::size_t k = 0; k < all.size(); k++) {
    std::array<double, 4> first;
    if (!(all[k][0] > MUCH * all[k][1]) || !notes[k].report(world, first)) continue;
    found = {(int) k, {first[1], first[2], first[3]}};
    return warned = true;
  }
  return false;
}
