/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Where two bodies have mass at a node of the mesh and their points touch, impulses are those of
   fix mpm/contact (MPMNodeContact).

   Normals are along the shortest way between the points of both bodies in the cells around the node
   (math/hull_distance.h), or where bodies have got into each other, those of the plane that tells
   their points apart best (math/plane_between.h). Linear functions reach one cell, so that the
   gradient of the volume of a body at its corner points along the diagonal, and a block that slides
   would be stopped by what is below it.

   Gap. The distance of the points along that normal, of those that are farthest ahead, less half of
   the width of each: the volumes of bodies at a node, by which fix mpm/contact knows whether they
   touch, are not that of the node where cells and points do not match.

   Conditions of the mesh hold all bodies at a node in the same way. Normals and impulses are in the
   directions that are free, so that contact leaves these conditions as they are. */

#include "meshgrid/fix_mpm_mesh_contact.h"

#include "base/mpm_lists.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "base/mpm_state.h"
#include "math/matrix.h"
#include "math/plane_between.h"
#include "meshgrid/fix_mpm_mesh.h"
#include "meshgrid/mpm_mesh_ranks.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "group.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int MAX_ITERATIONS = 200;      // at a node with three or more bodies
static constexpr double CONVERGED = 1.0e-12;    // change of the impulses, relative to them

// bodies that are placed next to each other touch, up to rounding in units of the size of a node
static constexpr double ROUNDING = 1.0e-8;

// points that tell whether bodies touch at a node are not farther beside it, in sizes of the node
static constexpr double BESIDE = 0.5;

static constexpr double OVERLAP = 0.5;    // sizes of a node that are reported at the start

/** fix ID all mpm/mesh/contact MESH group group ... law ... */
Options MPMMeshContactOptions::declare()
{
  using namespace option;
  Options o("fix mpm/mesh/contact");
  declare_law(o, false);
  o.refuse([=] {
    return OptionRules{coefficients()};
  });
  return o;
}

FixMPMMeshContact::FixMPMMeshContact(LAMMPS *lmp, int narg, char **arg) :
    Fix(lmp, narg, arg), report(lmp)
{
  if (igroup != 0)
    error->all(FLERR, 1,
               "Fix mpm/mesh/contact acts on nodes, which have no group: use group all; the bodies "
               "are the groups that are named");
  if (narg < 4) error->all(FLERR, narg - 1, "Fix mpm/mesh/contact needs the ID of a fix mpm/mesh");
  mesh_id = arg[3];

  Options options = declare();
  int iarg = 4;
  for (; iarg < narg && !options.has(arg[iarg]); iarg++) {
    const int which = group->find(arg[iarg]);
    if (which < 0) error->all(FLERR, iarg, "Fix mpm/mesh/contact: there is no group {}", arg[iarg]);
    if (std::count(groups.begin(), groups.end(), group->bitmask[which]))
      error->all(FLERR, iarg, "Fix mpm/mesh/contact group {} is named twice", arg[iarg]);
    groups.push_back(group->bitmask[which]);
  }
  if (groups.size() < 2)
    error->all(FLERR, MIN(4, narg - 1),
               "Fix mpm/mesh/contact needs two or more groups of points, one for each body");
  if (groups.size() > MAX_BODIES)
    error->all(FLERR, 4 + MAX_BODIES, "Fix mpm/mesh/contact takes at most {} bodies", MAX_BODIES);
  read_options(lmp, options, narg, arg, iarg);
  complete();
  keeps_rest = true;
  rounded = 1.0;
  report.set_bodies(count());

  scalar_flag = array_flag = 1;
  size_array_rows = (int) report.entries.size();
  size_array_cols = MPMContactReport::COLUMNS;
  global_freq = 1;
  extscalar = extarray = 1;
  restart_global = 1;
}

void FixMPMMeshContact::init()
{
  const auto *mesh = modify->get_fix_by_id(mesh_id);
  if (!mesh || !dynamic_cast<const FixMPMMesh *>(mesh))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/mesh/contact {}: {} is not the ID of a fix mpm/mesh; for bodies on "
               "lattices use fix mpm/contact",
               id, mesh_id);
}

int FixMPMMeshContact::body_of(int mask) const
{
  int body = -1;
  for (int b = 0; b < count(); b++)
    if (mask & groups[b]) body = body == -1 ? b : -2;
  return body;
}

void FixMPMMeshContact::begin_run(const BackgroundMesh &mesh)
{
  points = MPMPoints::get(atom);
  sizes.assign(mesh.nodes.size(), 0.0);
  std::vector<int> cells(sizes.size(), 0);
  for (const auto &one : mesh.cells)    // the mean of those of the cells around
    for (int k = 0; k < one.nnode; k++) {
      double size = 1.0;
      for (int d = 0; d < mesh.dim; d++) size *= one.high[d] - one.low[d];
      sizes[one.node[k]] += std::pow(size, 1.0 / mesh.dim);
      cells[one.node[k]]++;
    }
  for (std::size_t n = 0; n < sizes.size(); n++) sizes[n] /= cells[n];
  row.assign(sizes.size(), -1);
  nodes.clear();
  pairs.clear();
  look = true;
}

/** Pairs of bodies that touch at nodes. All ranks that have a node find the same there. */
void FixMPMMeshContact::find(MPMMeshBody &of)
{
  found.clear();
  overlap = 0.0;
  for (int a = 0; a < count(); a++)
    for (int b = a + 1; b < count(); b++) {
      node_of_row.clear();
      for (const int node : of.ranks.nodes) {
        const bool shared = of.mass_of(a, node) > 0.0 && of.mass_of(b, node) > 0.0;
        row[node] = shared ? (int) node_of_row.size() : -1;
        if (shared) node_of_row.push_back(node);
      }
      // the nodes that two ranks share have the same masses: both know whether there is a message
      find_near(of, a, b);
      find_normals(of);
      find_gaps(of, a, b);
      for (const int node : node_of_row) row[node] = -1;
    }

  // by nodes
  std::stable_sort(found.begin(), found.end(), [](const auto &one, const auto &other) {
    return one.first < other.first;
  });
  pairs.clear();
  nodes.clear();
  for (const auto &[node, contact] : found) {
    if (nodes.empty() || nodes.back().node != node)
      nodes.push_back({node, (int) pairs.size(), (int) pairs.size()});
    pairs.push_back(contact);
    nodes.back().last++;
  }
}

/** Points of two bodies at nodes that both have. */
void FixMPMMeshContact::find_near(MPMMeshBody &of, int a, int b)
{
  near.clear();
  if (node_of_row.empty()) return;
  for (const int i : of.order) {
    const int body = body_of(atom->mask[i]);
    if (body != a && body != b) continue;
    const auto &place = of.places[i];
    const auto &cell = of.mesh.cells[place.cell];
    for (int k = 0; k < cell.nnode; k++) {
      const int node = cell.node[k];
      if (row[node] < 0) continue;
      Near one = {row[node], body == b, place.N[k], {0.0, 0.0, 0.0}, i};
      for (int d = 0; d < of.mesh.dim; d++)
        one.r[d] = (atom->x[i][d] - of.mesh.nodes[node][d]) / sizes[node];
      near.push_back(one);
    }
  }
}

/** Along the shortest way from points to points. */
void FixMPMMeshContact::find_normals(MPMMeshBody &of)
{
  hulls.assign(node_of_row.size(), {});
  std::vector<int> open = row;    // of nodes where it is not known yet
  bool any = !node_of_row.empty();
  for (int round = 0; round < HullDistance::ROUNDS && any; round++) {
    ends.assign(8 * node_of_row.size(), -1.0e300);    // of a and of b: how far ahead, and where
    for (const auto &one : near) {
      const auto &hull = hulls[one.row];
      if (hull.done) continue;
      const double along = dot(hull.x, one.r),
                   mine[4] = {one.is_of_b ? -along : along, one.r[0], one.r[1], one.r[2]};
      double *const end = &ends[8 * one.row + 4 * one.is_of_b];
      if (std::lexicographical_compare(end, end + 4, mine, mine + 4)) std::copy_n(mine, 4, end);
    }
    of.ranks.largest(ends.data(), 4, 2, open.data());
    any = false;
    for (std::size_t r = 0; r < hulls.size(); r++) {
      hulls[r].advance(&ends[8 * r + 1], &ends[8 * r + 5]);
      if (hulls[r].done)
        open[node_of_row[r]] = -1;
      else
        any = true;
    }
  }
  normals.resize(node_of_row.size());
  bool mixed = false;
  for (std::size_t r = 0; r < hulls.size(); r++) {
    const double length = std::sqrt(dot(hulls[r].x, hulls[r].x));
    for (int d = 0; d < 3; d++) normals[r][d] = length > 0.0 ? hulls[r].x[d] / length : 0.0;
    mixed = mixed || length == 0.0;
  }
  if (mixed) separate_mixed(of);
}

/** Where bodies have got into each other: along the normal of the plane that tells their points
 *  apart best. */
void FixMPMMeshContact::separate_mixed(MPMMeshBody &of)
{
  constexpr int N = PlaneBetween::NREAL;
  const auto is_mixed = [this](int r) {
    return dot(hulls[r].x, hulls[r].x) == 0.0;
  };
  std::vector<int> mixed = row;
  for (std::size_t r = 0; r < hulls.size(); r++)
    if (!is_mixed((int) r)) mixed[node_of_row[r]] = -1;
  std::vector<PlaneBetween> planes(hulls.size());
  std::vector<double> sums;
  for (int round = 0; round < PlaneBetween::ROUNDS; round++) {
    sums.assign(N * hulls.size(), 0.0);
    for (const auto &one : near)
      if (is_mixed(one.row))
        planes[one.row].add(one.weight, one.r, one.is_of_b, &sums[(std::size_t) N * one.row]);
    of.ranks.sum(sums.data(), N, mixed.data());
    for (std::size_t r = 0; r < planes.size(); r++)
      if (is_mixed((int) r)) planes[r].advance(&sums[N * r], of.mesh.dim);
  }
  for (std::size_t r = 0; r < planes.size(); r++) {
    if (!is_mixed((int) r)) continue;
    double *const phi = planes[r].phi;
    if (of.mesh.dim == 2) phi[2] = 0.0;
    const double length = std::sqrt(dot(phi, phi));
    for (int d = 0; d < 3; d++) normals[r][d] = length > 0.0 ? phi[d] / length : 0.0;
  }
}

/** Half of the width of a point along n: that of a square or cube of its volume, stretched as
 *  planes with this normal are. */
void FixMPMMeshContact::find_gaps(MPMMeshBody &of, int a, int b)
{
  const int dim = of.mesh.dim;
  ends.assign(2 * node_of_row.size(), -1.0e300);
  for (const auto &one : near) {
    const double *const n = normals[one.row].data(), *const F = points->F[one.point];
    double along = 0.0, stretch = 0.0, square = 0.0;
    for (int d = 0; d < dim; d++) {
      square += one.r[d] * one.r[d];
      double t = 0.0;
      for (int e = 0; e < dim; e++) t += F[3 * e + d] * n[e];
      stretch += t * t;
      along += n[d] * one.r[d];
    }
    if (square - along * along > BESIDE * BESIDE) continue;
    const double half = 0.5 * std::pow(atom->vfrac[one.point], 1.0 / dim) * std::sqrt(stretch) /
        sizes[node_of_row[one.row]];
    double &end = ends[2 * one.row + one.is_of_b];
    end = std::max(end, (one.is_of_b ? -along : along) + half);
  }
  of.ranks.largest(ends.data(), 1, 2, row.data());
  for (std::size_t r = 0; r < node_of_row.size(); r++) {
    const double depth = ends[2 * r] + ends[2 * r + 1];
    if (!(depth >= -ROUNDING)) continue;
    overlap = std::max(overlap, depth);

    // in the directions that are free at the node
    const int node = node_of_row[r];
    MeshVector n = normals[r], zero = {0.0, 0.0, 0.0};
    of.forces.constrain(node, 0.0, n.data());
    of.forces.constrain(node, 0.0, zero.data());
    for (int d = 0; d < 3; d++) n[d] -= zero[d];
    const double length = std::sqrt(dot(n.data(), n.data()));
    if (!(length > 1.0e-3)) continue;
    MPMNodeContact contact = {};
    contact.a = a;
    contact.b = b;
    for (int d = 0; d < 3; d++) contact.n[d] = n[d] / length;
    found.emplace_back(node, contact);
  }
}

/** Impulses at a node. Of more than two bodies, those of all pairs follow from the same velocities,
 *  so that their order does not matter (projected Jacobi iterations). */
void FixMPMMeshContact::solve(MPMMeshBody &of, const Node &at, std::vector<MeshVector> &velocities,
                              bool decided)
{
  const std::size_t nnode = sizes.size();
  const int dim = of.mesh.dim;
  using Record = std::array<double, 4>;    // velocity and mass
  Record held[MAX_BODIES], now[MAX_BODIES], end[MAX_BODIES];
  int nbody = 0;
  for (int b = 0; b < count(); b++) {
    const double mass = of.mass_of(b, at.node);
    const MeshVector &v = velocities[b * nnode + at.node];
    end[b] = held[b] = {v[0], v[1], v[2], mass};
    if (!(mass > 0.0)) continue;
    nbody++;
    of.forces.constrain(at.node, 0.0, held[b].data());
    now[b] = held[b];
  }
  for (int p = at.first; p < at.last; p++) {
    MPMNodeContact &pair = pairs[p];
    pair.begin({}, {});
    pair.ra = now[pair.a].data();
    pair.rb = now[pair.b].data();
  }
  for (int it = 0; it < MAX_ITERATIONS; it++) {
    double largest = 0.0;
    for (int p = at.first; p < at.last; p++)
      largest = std::max(largest, pairs[p].iterate(*this, dim, nbody - 1, 0.0, decided));
    std::copy_n(held, count(), now);
    for (int p = at.first; p < at.last; p++) pairs[p].push(dim);
    if (nbody == 2 || largest < CONVERGED) break;
  }
  const bool counts = !decided && of.ranks.first[at.node];
  for (int p = at.first; p < at.last; p++) {
    MPMNodeContact &pair = pairs[p];
    if (counts && pair.state != MPMNodeContact::OPEN) {
      auto &entry = report.of(pair.a, pair.b);
      entry.work += entry.add(pair, dim);
    }
    pair.ra = end[pair.a].data();
    pair.rb = end[pair.b].data();
    pair.push(dim);
  }
  for (int b = 0; b < count(); b++)
    if (end[b][3] > 0.0) std::copy_n(end[b].data(), 3, velocities[b * nnode + at.node].data());
}

void FixMPMMeshContact::act(MPMMeshBody &of, std::vector<MeshVector> &velocities, bool decided)
{
  if (!decided) {
    report.begin_step(update->dt);
    find(of);
    if (look) warn_overlap();
    look = false;
  }
  for (const auto &node : nodes) solve(of, node, velocities, decided);
}

void FixMPMMeshContact::warn_overlap()
{
  double deepest;
  MPI_Allreduce(&overlap, &deepest, 1, MPI_DOUBLE, MPI_MAX, world);
  if (deepest > OVERLAP && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/mesh/contact {}: bodies overlap at the start of the run, by {:.2g} "
                   "cells: contact keeps bodies from approaching each other, but does not part "
                   "them",
                   id, deepest);
}

void FixMPMMeshContact::write_restart(FILE *fp)
{
  std::vector<double> totals = {comm->me == 0 ? (double) size_array_rows : 0.0};
  for (int p = 0; p < size_array_rows; p++) totals.push_back(report.entries[p].work);
  write_totals(fp, world, totals);
  for (int p = 0; p < size_array_rows; p++) report.entries[p].work = totals[p + 1];
}

void FixMPMMeshContact::restart(char *buf)
{
  const auto state = read_state(lmp, id, buf);
  const auto *const list = (const double *) state.data();
  if (state.size() != (1 + size_array_rows) * sizeof(double))
    error->all(FLERR, Error::NOPOINTER,
               "Fix mpm/mesh/contact {} had another number of bodies when the restart file was "
               "written: name as many, or give the fix another ID to begin anew",
               id);
  for (int p = 0; p < size_array_rows; p++)
    report.entries[p].work = comm->me == 0 ? list[p + 1] : 0.0;
}

double FixMPMMeshContact::memory_usage()
{
  return bytes_of(near, pairs, hulls, sizes, ends, row, node_of_row);
}
