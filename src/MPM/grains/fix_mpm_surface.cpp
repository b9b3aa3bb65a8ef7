/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "grains/fix_mpm_surface.h"

#include "atom.h"
#include "atom_vec.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_guard.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_node_sums.h"
#include "field/mpm_point_map.h"
#include "field/mpm_setup_checks.h"
#include "force.h"
#include "group.h"
#include "input.h"
#include "modify.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace FixConst;
using namespace MPM_NS;

/** fix ID group mpm/surface keyword value ... */
Options MPMSurfaceOptions::declare()
{
  using namespace option;
  Options o("fix mpm/surface");
  o.add("scale",
        {number(
            scale, "S", POSITIVE, "",
            "ratio of the diameter of a point to the edge of a cube (2d: square) of its volume")});
  o.add("grow",
        {number(grow, "G", AT_LEAST_ONE, "",
                "largest ratio of the diameter of a point to its diameter before deformation")});
  o.add("depth",
        {number(depth, "D", POSITIVE, "",
                "points down to this depth below the surface have a radius, in node spacings")});
  o.add("group", {text(group_id, "group-ID", "group that has exactly the points with a radius")})
      .standard("none");
  o.add("lists",
        {text(grains_id, "group-ID",
              "group of the grains that touch the points; sets up neighbor lists and communication "
              "for these and the surface alone")})
      .standard("not set up");
  return o;
}

FixMPMSurface::FixMPMSurface(LAMMPS *lmp, int narg, char **arg) :
    FixMPMState(lmp, narg, arg), points(MPMPoints::get(atom))
{
  if (!points || !atom->radius_flag)
    error->all(FLERR,
               "Fix mpm/surface requires material points with a radius: use atom_style hybrid "
               "sphere mpm");
  Options options = declare();
  read_options(lmp, options, narg, arg, 3);
  if (options.given("lists")) set_lists(options.where("lists") + 1);
  if (!group_id.empty()) find_group(options.where(options.given("group") ? "group" : "lists") + 1);

  scalar_flag = peratom_flag = 1;
  size_peratom_cols = 0;
  peratom_freq = 1;
  global_freq = 1;
  extscalar = 1;
  comm_forward = 1;
  force_reneighbor = 1;
  next_reneighbor = -1;
  state.declare(at_surface, "mpm/surface:at_surface");
  keep_arrays(false);
  vector_atom = at_surface;
  if (!options.given("scale")) warn_of_diameters();
  give_largest();
}

/** Without the fix, points have the diameter that create_points gives them, times the scale. */
FixMPMSurface::~FixMPMSurface()
{
  const bool all_is_deleted = !update;
  if (all_is_deleted) return;
  surface_group = group_id.empty() ? -1 : group->find(group_id);
  give_all(1.0);
}

/** Groups can be deleted, and their bit given to others: the name decides at the start of each
 *  run. */
void FixMPMSurface::find_group(int iarg)
{
  surface_group = group->find(group_id);
  if (surface_group <= 0 || surface_group == igroup || group->dynamic[surface_group])
    error->all(FLERR, iarg,
               "Fix mpm/surface {} group must be a static group other than all and that of the "
               "fix: {}{}",
               id, group_id, surface_group < 0 ? ", which does not exist" : "");
}

bool FixMPMSurface::keeps_group(int number) const
{
  return !group_id.empty() && group->find(group_id) == number;
}

/** Diameters that create_points or set gave would go without a word. Those that a restart file has
 *  are of this fix: none, the largest, or that of the present volume. */
void FixMPMSurface::warn_of_diameters() const
{
  const auto differs = [](double a, double b) {
    return std::fabs(a - b) > 1.0e-6 * b;
  };
  bigint mine = 0, all;
  double ratio = 0.0, largest;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!has_radius(i)) continue;
    const double r = atom->radius[i], V = atom->vfrac[i], undeformed = radius_of(V, 1.0);
    if (r == 0.0 || !differs(r, undeformed) || !differs(r, radius_of(V, grow)) ||
        !differs(r, present_radius(i)))
      continue;
    mine++;
    ratio = std::max(ratio, r / undeformed);
  }
  MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  MPI_Allreduce(&ratio, &largest, 1, MPI_DOUBLE, MPI_MAX, world);
  if (all && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/surface {} replaces the diameters of {} points, up to {:.6g} times the "
                   "edge of a cube (2d: square) of their volume, by that edge: set the factor with "
                   "keyword scale",
                   id, all, largest);
}

void FixMPMSurface::init()
{
  require_field(lmp, *this);
  if (!group_id.empty()) find_group(Error::NOLASTLINE);
  if (!grains_id.empty() && group->find(grains_id) < 0)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/surface {} lists: group {} does not exist any more: keep it, or define the "
               "fix anew with another one",
               id, grains_id);
  pre_exchange_migrate = moves_atoms();    // looked at by the history of pair styles, in its init()
  for (const auto *field : MPMField::all(lmp))
    refuse_field(lmp, *this, *field,
                 {{field->options.axisymmetric, "axisymmetric",
                   "a grain would be a ring: let bodies meet through fix mpm/contact, or use 3d "
                   "for grains"}});
  if (comm->me == 0 && !find_fixes<MPMRefinedBody>(lmp).empty())
    error->warning(FLERR,
                   "Fix mpm/surface {}: points at the rims between the lattices of fix mpm/refine "
                   "count as surface, and have a radius, too: leave them out of group {} if they "
                   "may touch something",
                   id, group->names[igroup]);
  bigint mine[2] = {0, 0}, all[2];    // points, those with a radius below the largest one
  for (int i = 0; i < atom->nlocal; i++) {
    if (!has_radius(i)) continue;
    mine[0]++;
    mine[1] += atom->radius[i] < radius_of(atom->vfrac[i], grow) * (1.0 - 1.0e-10);
  }
  MPI_Allreduce(mine, all, 2, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all[0] == 0)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/surface {} has no material points: its group {} has no atoms with a volume",
               id, group->names[igroup]);
  for (auto *other : modify->get_fix_by_style("^mpm/surface$")) {
    if (other == this) continue;
    int shared = 0, shared_all;
    for (int i = 0; i < atom->nlocal; i++)
      if (has_radius(i) && (atom->mask[i] & other->groupbit)) shared = 1;
    MPI_Allreduce(&shared, &shared_all, 1, MPI_INT, MPI_MAX, world);
    if (shared_all)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/surface {} and {} have points in common: give them disjoint groups", id,
                 other->id);
  }

  // pair styles have taken their cutoffs from the radii of this moment

  if (all[1])
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/surface {}: points were created, or their radius set, after the fix, which "
               "sets it: define the fix after them",
               id);
}

/** Start of a run: as each time that lists are made, so that the step of a restart file, where they
 *  are, has the same radii and lists in the run that goes on from it. This comes before fix mpm
 *  does what the volume on the lattice needs. */
void FixMPMSurface::setup_pre_exchange()
{
  // write_data asks between runs, when all have the largest radii, which the next run begins with
  if (!update->setupflag) return;
  domain->pbc();    // reference positions of points are inside of the box
  for (auto *field : MPMField::all(lmp)) {
    if (force->pair) MPMSetupChecks(lmp, *field).radii();    // cutoffs are for the largest ones
    field->choose_kernels();
    field->map->setup();
    field->map->valid = false;
    field->frame->setup();
  }
  pre_exchange();
}

/** A run without set-up ("run pre no") begins with the largest radii, and lists that are not of the
 *  surface it finds. */
void FixMPMSurface::pre_force(int)
{
  if (!known) {
    find_surface();
    comm->forward_comm(this);
    next_reneighbor = update->ntimestep + 1;
  }
  // of a fix that has come after this one in this step
  if (atom->natoms != natoms && take_grains()) next_reneighbor = update->ntimestep + 1;
}

/** Before ghosts and neighbor lists are made. */
void FixMPMSurface::pre_exchange()
{
  // points may have left the nodes that were in their reach, or else there would be no new lists
  for (auto *field : MPMField::all(lmp)) field->map->valid = false;
  find_surface();
  take_grains();
  if (moves_atoms()) keep_first();
}

/** Grains that have come since the last time (fix pour, create_atoms, ...) are in the group of the
 *  lists, too. Returns whether there are any. Collective. */
bool FixMPMSurface::take_grains()
{
  natoms = atom->natoms;
  if (grains_id.empty()) return false;
  const int of_grains = group->bitmask[group->find(grains_id)], bit = group->bitmask[surface_group];
  int some = 0, some_all;
  for (int i = 0; i < atom->nlocal; i++) {
    int &mask = atom->mask[i];
    if (!(mask & of_grains) || (mask & bit) || has_radius(i)) continue;
    mask |= bit;
    some = 1;
  }
  MPI_Allreduce(&some, &some_all, 1, MPI_INT, MPI_MAX, world);
  return some_all;
}

bool FixMPMSurface::moves_atoms() const
{
  return surface_group >= 0 && atom->firstgroupname &&
      group->find(atom->firstgroupname) == surface_group;
}

/** The group is first in memory (atom_modify first), and a few points have left it or come to it.
 *  LAMMPS would shift all atoms behind each of them by one place. Here the few change places. */
void FixMPMSurface::keep_first()
{
  const int bit = group->bitmask[surface_group], n = atom->nlocal;
  if (n == atom->nmax) atom->avec->grow(0);
  const int *const mask = atom->mask;
  int nfirst = 0;
  for (int i = 0; i < n; i++) nfirst += (mask[i] & bit) != 0;

  // the free place is that of the first ghost, which the map must forget before

  if (atom->map_style != Atom::MAP_NONE) atom->map_clear();
  atom->nghost = 0;
  for (int out = 0, in = nfirst; out < nfirst; out++) {
    if (mask[out] & bit) continue;
    while (!(mask[in] & bit)) in++;    // as many are in the wrong part on both sides
    atom->avec->copy(out, n, 0);
    atom->avec->copy(in, out, 0);
    atom->avec->copy(n, in, 0);
    in++;
  }
  for (auto *field : MPMField::all(lmp)) field->map->valid = false;
}

bool FixMPMSurface::has_radius(int i) const
{
  return (atom->mask[i] & groupbit) && atom->vfrac[i] > 0.0;
}

double FixMPMSurface::radius_of(double V, double growth) const
{
  return 0.5 * scale * growth * (domain->dimension == 3 ? std::cbrt(V) : std::sqrt(V));
}

/** Of a point at the surface. */
double FixMPMSurface::present_radius(int i) const
{
  const double V = atom->vfrac[i];
  return std::min(radius_of(V * points->jacobian(i), 1.0), radius_of(V, grow));
}

/** All points have a radius, with this growth. */
void FixMPMSurface::give_all(double growth)
{
  known = false;
  for (int i = 0; i < atom->nlocal; i++)
    if (has_radius(i)) give_radius(i, true, radius_of(atom->vfrac[i], growth));
}

void FixMPMSurface::give_radius(int i, bool surface, double radius)
{
  at_surface[i] = surface;
  atom->radius[i] = surface ? radius : 0.0;
  if (surface_group < 0) return;
  const int bit = group->bitmask[surface_group];
  atom->mask[i] = surface ? atom->mask[i] | bit : atom->mask[i] & ~bit;
}

/** The volume at the nodes over that of a cell, interpolated, goes from 1 inside of a body to 0
 *  outside. To map and to interpolate smooths a step by functions with the variance (order + 1)/12
 *  of the B-spline each: at the depth y it is close to the normal distribution with the sum of
 *  both. */
void FixMPMSurface::find_surface()
{
  known = true;
  for (auto *field : MPMField::all(lmp)) {
    volume_at_points(*field, share);
    const double deviation = std::sqrt((stencil_order(field->options.shape) + 1) / 6.0);
    const double limit = 0.5 * std::erfc(-depth / (deviation * std::sqrt(2.0)));
    for (int i = 0; i < atom->nlocal; i++) {
      if (!has_radius(i) || !field->is_point(i)) continue;
      const auto *material = field->material_of(i);
      const bool failed =
          material && material->damage >= 0 && material->history[i][material->damage] >= 1.0;
      give_radius(i, failed || share[i] < limit, present_radius(i));
    }
  }
}

/** Points at the surface. */
double FixMPMSurface::compute_scalar()
{
  double mine = 0.0, all;
  for (int i = 0; i < atom->nlocal; i++)
    if (has_radius(i)) mine += at_surface[i];
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

void FixMPMSurface::grow_arrays(int nmax)
{
  FixMPMState::grow_arrays(nmax);
  vector_atom = at_surface;
}

int FixMPMSurface::pack_forward_comm(int n, int *list, double *buf, int, int *)
{
  for (int k = 0; k < n; k++) buf[k] = atom->radius[list[k]];
  return n;
}

void FixMPMSurface::unpack_forward_comm(int n, int first, double *buf)
{
  for (int k = 0; k < n; k++) atom->radius[first + k] = buf[k];
}

/** Keyword lists: the settings of neighbor lists and communication that a run with grains needs to
 *  be fast. They are LAMMPS's own commands, which the log shows. */
void FixMPMSurface::set_lists(int iarg)
{
  if (group->find(grains_id) < 0)
    error->all(FLERR, iarg, "Fix mpm/surface {} lists: group {} does not exist", id, grains_id);
  if (force->pair_match("mpm/penalty", 0))
    error->all(FLERR, iarg,
               "Fix mpm/surface {} lists leaves out pairs of points, which pair style mpm/penalty "
               "needs: give neighbor, neigh_modify and comm_modify instead",
               id);
  for (auto *other : modify->get_fix_by_style("^mpm/surface$")) {
    const auto *surface = dynamic_cast<FixMPMSurface *>(other);
    if (surface && surface != this && !surface->grains_id.empty())
      error->all(FLERR, iarg,
                 "Fix mpm/surface {} lists: fix {} has set the lists; use one fix mpm/surface for "
                 "the points of both",
                 id, surface->id);
  }
  if (group_id.empty()) group_id = id;

  const auto command = [this](const std::string &text) {
    input->one(text);
  };
  // LAMMPS forgets a cutoff of the user when the mode changes. That of fix mpm, which is next to
  // nothing, is no such cutoff
  const double cutoff = comm->mode == Comm::SINGLE ? comm->cutghostuser : 0.0;
  command(fmt::format("neighbor {:.17g} multi", neighbor->skin));
  command("comm_modify vel yes mode multi");
  if (cutoff > 1.0e-4 * neighbor->skin)
    command(fmt::format("comm_modify cutoff/multi * {:.17g}", cutoff));
  const std::vector<int> types = types_of_points(iarg);
  for (const int a : types)
    for (const int b : types)
      if (a <= b) command(fmt::format("neigh_modify exclude type {} {}", a, b));
  command(fmt::format("group {} union {} {}", group_id, grains_id, group->names[igroup]));
  command(fmt::format("atom_modify first {}", group_id));
  command(fmt::format("neigh_modify include {}", group_id));
  command(fmt::format("comm_modify group {}", group_id));
}

/** Types of the points of this fix, which grains must not have. */
std::vector<int> FixMPMSurface::types_of_points(int iarg) const
{
  const int ntypes = atom->ntypes;
  std::vector<int> mine(2 * (ntypes + 1), 0), all(mine.size()), types;
  for (int i = 0; i < atom->nlocal; i++)
    if (has_radius(i))
      mine[2 * atom->type[i]] = 1;
    else if (atom->vfrac[i] == 0.0)
      mine[2 * atom->type[i] + 1] = 1;
  MPI_Allreduce(mine.data(), all.data(), (int) mine.size(), MPI_INT, MPI_MAX, world);
  for (int t = 1; t <= ntypes; t++) {
    if (!all[2 * t]) continue;
    if (all[2 * t + 1])
      error->all(FLERR, iarg,
                 "Fix mpm/surface {} lists: material points and other atoms have the type {}: give "
                 "them different ones",
                 id, t);
    types.push_back(t);
  }
  return types;
}
