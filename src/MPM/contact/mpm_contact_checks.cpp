/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "contact/mpm_contact_checks.h"

#include "atom.h"
#include "base/mpm_image.h"
#include "comm.h"
#include "contact/mpm_contact_bodies.h"
#include "domain.h"
#include "elements/fix_mpm_elements.h"
#include "error.h"
#include "field/mpm_field.h"
#include "fix.h"
#include "math_extra.h"
#include "modify.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

void MPMContactChecks::warn_overlap()
{
  struct {
    double value;
    int rank;
  } mine = {0.0, comm->me}, worst;
  double place[5] = {0.0};    // position of the node, and two bodies
  for (const auto &c : bodies.shared)
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (!(c.canonical >> n & 1)) continue;
      double sum = 0.0;
      struct {
        double fraction;
        int body;
      } most = {0.0, -1}, next = most;
      for (int k = 0; k < bodies.size(); k++) {
        if (c.slot[k] < 0) continue;
        const double s = bodies[k].fraction[(int64_t) c.slot[k] * NODES_PER_BLOCK + n];
        sum += s;
        if (s > most.fraction) {
          next = most;
          most = {s, k};
        } else if (s > next.fraction)
          next = {s, k};
      }
      if (next.fraction < OVERLAP_EACH || sum < OVERLAP || sum <= mine.value) continue;
      mine.value = sum;
      const int64_t node = (int64_t) c.slot[most.body] * NODES_PER_BLOCK + n;
      bodies[most.body].field->grid.node_position(node, place);
      place[3] = most.body;
      place[4] = next.body;
    }
  MPI_Allreduce(&mine, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, world);
  if (worst.value == 0.0) return;
  MPI_Bcast(place, 5, MPI_DOUBLE, worst.rank, world);

  const int first = (int) place[3], second = (int) place[4];
  const tagint tags[2] = {nearest_point(first, place), nearest_point(second, place)};
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/contact {}: bodies {} and {} overlap at the start of the run, for "
                   "instance points {} and {} near {:.6g} {:.6g} {:.6g}: contact keeps bodies from "
                   "approaching each other, but does not part them",
                   fix.id, bodies[first].field->id(), bodies[second].field->id(), tags[0], tags[1],
                   place[0], place[1], place[2]);
}

/** Tag of the point of a body that is nearest to a place. Collective. */
tagint MPMContactChecks::nearest_point(int body, const double *place) const
{
  const MPMField &field = *bodies[body].field;
  struct {
    double value;
    int rank;
  } mine = {1.0e300, comm->me}, nearest;
  tagint tag = 0;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    double r[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < bodies.dim(); k++) r[k] = atom->x[i][k] - place[k];
    nearest_image(*domain, r);
    const double rsq = MathExtra::lensq3(r);
    if (rsq >= mine.value) continue;
    mine.value = rsq;
    tag = atom->tag[i];
  }
  MPI_Allreduce(&mine, &nearest, 1, MPI_DOUBLE_INT, MPI_MINLOC, world);
  MPI_Bcast(&tag, 1, MPI_LMP_TAGINT, nearest.rank, world);
  return tag;
}

void MPMContactChecks::warn_thin()
{
  std::vector<const Fix *> meshes;
  for (Fix *ifix : modify->get_fix_list()) {
    const auto *mesh = dynamic_cast<FixMPMElements *>(ifix);
    if (mesh && mesh->is_thin()) meshes.push_back(ifix);
  }
  if (meshes.empty()) return;
  std::vector<bigint> mine(2 * bodies.size(), 0),
      all(mine.size());    // points of such meshes, others
  for (int i = 0; i < atom->nlocal; i++)
    for (int k = 0; k < bodies.size(); k++) {
      if (!bodies[k].field->is_point(i)) continue;
      const bool is_thin = std::any_of(meshes.begin(), meshes.end(), [&](const Fix *mesh) {
        return atom->mask[i] & mesh->groupbit;
      });
      mine[2 * k + (is_thin ? 0 : 1)]++;
    }
  MPI_Allreduce(mine.data(), all.data(), (int) mine.size(), MPI_LMP_BIGINT, MPI_SUM, world);
  std::vector<int> thin, others;
  for (int k = 0; k < bodies.size(); k++)
    if (all[2 * k + 1] > 0)
      others.push_back(k);
    else if (all[2 * k] > 0)
      thin.push_back(k);
  if (!thin.empty() && !others.empty()) warn_of_thin_body(thin[0], others[0]);
  if (thin.size() > 1) warn_of_thin_pair(thin);
}

/** A thin body fills no volume, so that the nodes between it and another one are not full. And it
 *  has gradients on both of its sides: on the side away from the other body, its normal is the
 *  wrong one, and contact with the mean of both normals pulls the other body through. With weights
 *  by volume the normal is that of the other body. */
void MPMContactChecks::warn_of_thin_body(int thin, int other)
{
  if (comm->me ||
      (options.normal_by != MPMContactSearchOptions::COLINEAR &&
       (!options.gap || options.full <= 0.5)))
    return;
  error->warning(FLERR,
                 "Fix mpm/contact {}: {} is a surface or line of fix mpm/elements, and {} is not, "
                 "which can pass through what is so thin: use gap no normal volume",
                 fix.id, bodies[thin].field->id(), bodies[other].field->id());
}

/** Two thin bodies never touch where nodes must be full, however near they are. Without this
 *  condition, only nodes that both reach hold them: the other nodes fall freely in each step, as
 *  nothing joins the rows of nodes around a single row of points. FLIP then sinks with g dt times
 *  the ratio of the shares of both kinds of nodes, and affine velocities keep falling at all nodes.
 */
void MPMContactChecks::warn_of_thin_pair(const std::vector<int> &thin)
{
  const double enough = options.gap ? options.full : 1.0;
  std::vector<double> most;
  for (const int k : thin) most.push_back(most_filled(bodies[k]));
  for (std::size_t a = 0; a < thin.size(); a++)
    for (std::size_t b = a + 1; b < thin.size(); b++) {
      if (most[a] + most[b] >= enough) continue;
      if (comm->me) return;
      const char *const ids[] = {bodies[thin[a]].field->id(), bodies[thin[b]].field->id()};
      if (options.gap)
        error->warning(FLERR,
                       "Fix mpm/contact {}: {} and {} are surfaces or lines of fix mpm/elements, "
                       "and never touch: where they meet they fill {:.2g} of the volume of a node, "
                       "and gap yes waits for {:.2g}; move them with fix nve, not fix mpm, and use "
                       "pair_style mpm/sheet, or leave one of them out",
                       fix.id, ids[0], ids[1], most[a] + most[b], options.full);
      else
        error->warning(FLERR,
                       "Fix mpm/contact {}: {} and {} are surfaces or lines of fix mpm/elements, "
                       "which gap no holds apart for a short time only: under a load that stays "
                       "they go through each other, slowly with transfer flip, and at once with "
                       "apic; move them with fix nve, not fix mpm, and use pair_style mpm/sheet",
                       fix.id, ids[0], ids[1]);
      return;
    }
}

/** Returns the largest part of the volume of a node, as far as it is inside the box, that a body
 *  fills now. Collective. */
double MPMContactChecks::most_filled(MPMContactBody &body)
{
  const Grid &grid = body.field->grid;
  body.near.assign(grid.blocks.size(), 1);
  bodies.map_content(body, true);
  double most = 0.0, all;
  for (std::size_t slot = 0; slot < grid.blocks.size(); slot++)
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      int index[3];
      bool image = false;
      grid.node_index(grid.blocks[slot], n, index);
      const double inside = bodies.inside.at(index, grid.lattice.dim, image);
      if (!image && inside > 0.0)
        most = std::max(most, body.fraction[slot * NODES_PER_BLOCK + n] / inside);
    }
  MPI_Allreduce(&most, &all, 1, MPI_DOUBLE, MPI_MAX, world);
  return all;
}
