/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Checks of fix mpm: what may go wrong with points and time step, and what is done about it.

#include "fix_mpm.h"

#include "atom.h"
#include "atom_vec.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix_mpm_elements.h"
#include "fix_mpm_material.h"
#include "force.h"
#include "group.h"
#include "material/batch.h"
#include "modify.h"
#include "mpm_points.h"
#include "neighbor.h"
#include "pair.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int DT_CHECK_EVERY = 20;    // steps between checks of the time step

/* ----------------------------------------------------------------------
   a point must have one integrator; fixes of this style may hide from LAMMPS that they are one,
   see init()
------------------------------------------------------------------------- */

void FixMPM::check_integrators()
{
  for (auto *other : modify->get_fix_list()) {
    if (other == this || !(other->time_integrate || utils::strmatch(other->style, "^mpm$")))
      continue;
    bigint n = 0, all;
    for (int i = 0; i < atom->nlocal; i++)
      if (is_point(i) && (atom->mask[i] & other->groupbit)) n++;
    MPI_Allreduce(&n, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
    if (all)
      error->all(FLERR,
                 "{} material points of fix {} (style mpm) are also integrated by fix {} "
                 "(style {}): give the fixes disjoint groups",
                 all, id, other->id, other->style);
  }
}

/* ----------------------------------------------------------------------
   each point must have one material, positive volume and mass, and a finite state
------------------------------------------------------------------------- */

void FixMPM::check_points()
{
  enum { POINT, NONE, SEVERAL, MASS, STATE, AXIS, SIZE, NKINDS };
  bigint count[NKINDS] = {0}, all[NKINDS];
  tagint example[NKINDS] = {0}, example_all[NKINDS];
  auto note = [&](int kind, int i) {
    count[kind]++;
    example[kind] = std::max(example[kind], atom->tag[i]);
  };

  for (auto *material : materials) material->assign_mass();

  for (int i = 0; i < atom->nlocal; i++) {
    if (!is_point(i)) continue;
    note(POINT, i);
    int n = 0;
    for (auto *material : materials) n += (atom->mask[i] & material->groupbit) != 0;
    if (n == 0) note(NONE, i);
    if (n > 1) note(SEVERAL, i);
    if (n == 1 && !(atom->rmass[i] > 0.0 && std::isfinite(atom->rmass[i]))) note(MASS, i);

    const double J = points->jacobian(i), *v = atom->v[i], *x = atom->x[i];
    double sum = J;
    for (int d = 0; d < 3; d++) sum += fabs(x[d]) + fabs(v[d]);
    for (int c = 0; c < 6; c++) sum += fabs(points->tau[i][c]);
    if (!std::isfinite(sum) || !(J > 0.0)) note(STATE, i);
    if (axisymmetric && !(x[0] > 0.0)) note(AXIS, i);
    for (int d = 0; d < lattice.dim && has_boxes(); d++)
      if (half_size(i) * aspect[d] > 0.5 * (1.0 + 1.0e-6)) {
        note(SIZE, i);
        break;
      }
  }
  MPI_Allreduce(count, all, NKINDS, MPI_LMP_BIGINT, MPI_SUM, world);
  MPI_Allreduce(example, example_all, NKINDS, MPI_LMP_TAGINT, MPI_MAX, world);

  if (all[POINT] == 0)
    error->all(FLERR,
               "Fix mpm {} has no material points: its group {} has no atoms with a volume; "
               "make points with create_points, or give atoms a volume with set ... volume",
               id, group->names[igroup]);
  if (all[NONE])
    error->all(FLERR,
               "{} material points have no material, for instance point {}: "
               "define a fix mpm/material for their group",
               all[NONE], example_all[NONE]);
  if (all[SEVERAL])
    error->all(FLERR,
               "{} material points have more than one material, for instance point {}: "
               "the groups of the mpm/material fixes must be disjoint",
               all[SEVERAL], example_all[SEVERAL]);
  if (all[MASS])
    error->all(FLERR,
               "{} material points have no positive mass, for instance point {}: "
               "check the density of their material or their set mass",
               all[MASS], example_all[MASS]);
  if (all[STATE])
    error->all(FLERR,
               "{} material points have a position, velocity, deformation or stress that is "
               "not finite or is inverted, for instance point {}",
               all[STATE], example_all[STATE]);
  if (all[AXIS])
    error->all(FLERR,
               "{} material points of fix mpm {} axisymmetric are not at positive x, for "
               "instance point {}: x is the distance from the axis",
               all[AXIS], id, example_all[AXIS]);
  if (all[SIZE])
    error->all(FLERR,
               "{} material points are larger than the cells of fix mpm {}, for instance point "
               "{}: shape gimp and cpgimp need at least one point per cell, and aspect if points "
               "are not cubes",
               all[SIZE], id, example_all[SIZE]);
}

/* ----------------------------------------------------------------------
   Neighbor lists of points and grains: the two settings that make them slow. Pairs of points do
   nothing but cost time, unless pair style mpm/penalty is there for them; and with bins of the size
   of a grain, each point tests all points within reach of a grain.
------------------------------------------------------------------------- */

void FixMPM::check_neighbors()
{
  constexpr bigint MANY = 1000;    // points for which it matters
  constexpr double RATIO = 2.0;
  const int ntypes = atom->ntypes;
  std::vector<int> mine(2 * (ntypes + 1), 0), all(2 * (ntypes + 1));    // points, other atoms
  bigint npoints = 0, npoints_all;
  for (int i = 0; i < atom->nlocal; i++) {
    const bool point = atom->vfrac[i] > 0.0;
    mine[2 * atom->type[i] + !point] = 1;
    npoints += point;
  }
  MPI_Allreduce(mine.data(), all.data(), mine.size(), MPI_INT, MPI_MAX, world);
  MPI_Allreduce(&npoints, &npoints_all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (npoints_all < MANY) return;

  double cut_points = 0.0, cut_others = 0.0;    // squares
  for (int t = 1; t <= ntypes; t++) {
    const double cut = force->pair->cutsq[t][t];
    if (all[2 * t]) cut_points = std::max(cut_points, cut);
    if (all[2 * t + 1]) cut_others = std::max(cut_others, cut);
    if (!all[2 * t] || cut == 0.0 || force->pair_match("mpm/penalty", 0)) continue;

    bool excluded = false;
    for (int k = 0; k < neighbor->nex_type; k++)
      excluded = excluded || (neighbor->ex1_type[k] == t && neighbor->ex2_type[k] == t);
    for (int k = 0; k < neighbor->nex_group; k++) {
      const int bits = neighbor->ex1_bit[k] | neighbor->ex2_bit[k];
      int in = 1, in_all;
      for (int i = 0; i < atom->nlocal; i++)
        if (atom->type[i] == t && atom->vfrac[i] > 0.0 && (atom->mask[i] & bits) != bits) in = 0;
      MPI_Allreduce(&in, &in_all, 1, MPI_INT, MPI_MIN, world);
      excluded = excluded || in_all;
    }
    if (!excluded && comm->me == 0)
      error->warning(FLERR,
                     "Fix mpm: pairs of material points of type {} are in the neighbor lists, "
                     "at great cost and for nothing but pair forces between them: use neigh_modify "
                     "exclude type {} {}",
                     t, t, t);
  }
  if (cut_others > RATIO * RATIO * cut_points && neighbor->style != Neighbor::MULTI &&
      comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm: neighbor lists of points and of grains {:.1f} times as large are "
                   "many times faster with neighbor ... multi and comm_modify mode multi",
                   sqrt(cut_others / std::max(cut_points, 1.0e-300)));
}

/* ----------------------------------------------------------------------
   Pair style granular takes its cutoffs from the radii, but what tells it to do so is not in restart
   files: with the settings of a file alone cutoffs are anything, mostly 0. Then there are no ghosts,
   and contacts across ranks and periodic faces are missed without a word.
------------------------------------------------------------------------- */

static void check_cutoffs(LAMMPS *lmp)
{
  const Atom *atom = lmp->atom;
  const int ntypes = atom->ntypes;
  std::vector<double> mine(2 * (ntypes + 1), -1.0),
      all(2 * (ntypes + 1));    // of points, of others
  for (int i = 0; i < atom->nlocal; i++) {
    double &largest = mine[2 * atom->type[i] + !(atom->vfrac[i] > 0.0)];
    largest = std::max(largest, atom->radius[i]);
  }
  MPI_Allreduce(mine.data(), all.data(), mine.size(), MPI_DOUBLE, MPI_MAX, lmp->world);
  for (int i = 1; i <= ntypes; i++)
    for (int j = 1; j <= ntypes; j++) {
      const double sum = all[2 * i] + all[2 * j + 1], cut = sqrt(lmp->force->pair->cutsq[i][j]);
      if (all[2 * i] > 0.0 && all[2 * j + 1] > 0.0 && !(cut >= sum * (1.0 - 1.0e-10)))
        lmp->error->all(
            FLERR, Error::NOLASTLINE,
            "Cutoff {:.6g} of pair style granular between points of type {} and grains of "
            "type {} is below the sum {:.6g} of their largest radii. Read_restart loses the "
            "cutoffs of this pair style: give pair_style and pair_coeff again after it",
            cut, i, j, sum);
    }
}

/* ----------------------------------------------------------------------
   Grains see points by their radius. LAMMPS gives no error for a radius of zero, where no force
   or one between centers remains, nor for one of 0.5, its default, in other units.
------------------------------------------------------------------------- */

void FixMPM::check_radii()
{
  if (!atom->radius_flag) return;
  if (!utils::strmatch(force->pair_style, "^gran") && !force->pair_match("^gran", 0)) return;
  if (strcmp(force->pair_style, "granular") == 0) check_cutoffs(lmp);
  if (!modify->get_fix_by_style("^mpm/surface$").empty()) return;
  const int ntypes = atom->ntypes;
  std::vector<int> grains(ntypes + 1, 0), grains_all(ntypes + 1);    // types of other atoms
  for (int i = 0; i < atom->nlocal; i++)
    if (atom->vfrac[i] == 0.0) grains[atom->type[i]] = 1;
  MPI_Allreduce(grains.data(), grains_all.data(), ntypes + 1, MPI_INT, MPI_MAX, world);

  bigint mine[3] = {0, 0, 0}, all[3];    // points that meet them, without radius, too large
  tagint example = 0, example_all;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!is_point(i)) continue;
    bool meets = false;
    for (int t = 1; t <= ntypes; t++)
      meets = meets || (grains_all[t] && force->pair->cutsq[atom->type[i]][t] > 0.0);
    if (!meets) continue;
    mine[0]++;
    mine[1] += atom->radius[i] == 0.0;
    if (atom->radius[i] <= 2.0 * lattice.h) continue;
    mine[2]++;
    example = std::max(example, atom->tag[i]);
  }
  MPI_Allreduce(mine, all, 3, MPI_LMP_BIGINT, MPI_SUM, world);
  MPI_Allreduce(&example, &example_all, 1, MPI_LMP_TAGINT, MPI_MAX, world);
  if (all[0] == 0) return;
  if (axisymmetric)
    error->all(FLERR, Error::NOLASTLINE,
               "Points of fix mpm {} axisymmetric cannot meet grains through pair style {}: a "
               "grain would be "
               "a ring; let bodies meet through fix mpm/contact, or use 3d for grains",
               id, force->pair_style);
  if (all[1] == all[0])
    error->all(
        FLERR, Error::NOLASTLINE,
        "Points of fix mpm {} have no radius, by which pair style {} couples them to grains: "
        "use fix mpm/surface, or set ... diameter",
        id, force->pair_style);
  if (all[2])
    error->all(FLERR, Error::NOLASTLINE,
               "{} points of fix mpm {} have a radius of more than two node spacings, for instance "
               "point {}: use fix mpm/surface, or set ... diameter",
               all[2], id, example_all);
}

/* ----------------------------------------------------------------------
   points outside fixed faces would silently be lost by the exchange that follows
------------------------------------------------------------------------- */

void FixMPM::check_inside_box()
{
  std::vector<tagint> out;
  double **x = atom->x;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!is_point(i)) continue;
    bool inside = true;
    for (int d = 0; d < 3; d++)
      inside = inside &&
          (domain->periodicity[d] || (x[i][d] >= domain->boxlo[d] && x[i][d] < domain->boxhi[d]));
    if (inside) continue;
    if (policy == DELETE)
      out.push_back(atom->tag[i]);
    else
      error->one(FLERR,
                 "{} has left the box through a fixed face; enlarge the box, put a "
                 "fix mpm/boundary there, or let it go with fix mpm ... bad delete",
                 point_state(i));
  }
  if (policy == DELETE) {
    out.insert(out.end(), bad_points.begin(), bad_points.end());
    delete_points(out, true);
    bad_points.clear();
  }
  if (delete_failed) {
    delete_points(failed_points, false);
    failed_points.clear();
  }
}

/* ---------------------------------------------------------------------- */

std::string FixMPM::point_state(int i) const
{
  const double *x = atom->x[i], *v = atom->v[i];
  return fmt::format("Material point {} at {:.6g} {:.6g} {:.6g} with velocity {:.6g} {:.6g} {:.6g} "
                     "and J = {:.6g}",
                     atom->tag[i], x[0], x[1], x[2], v[0], v[1], v[2], points->jacobian(i));
}

/* ---------------------------------------------------------------------- */

void FixMPM::point_is_bad(int i, const std::string &what, const std::string &cure)
{
  if (policy == ERROR)
    error->one(FLERR,
               "{} {} at step {}: try a smaller time step (fix mpm/dt), more points per "
               "cell, or a smoother shape function; fix mpm ... bad warn|delete goes on",
               point_state(i), what, update->ntimestep);
  if (policy == WARN && nbad_total + (bigint) bad_points.size() < 10)
    error->warning(FLERR, "{} {} at step {}: {}", point_state(i), what, update->ntimestep, cure);
  bad_points.push_back(atom->tag[i]);
}

/* ----------------------------------------------------------------------
   policies warn and delete: count; points to delete, also those that have failed, go at the next
   exchange, made to happen now
------------------------------------------------------------------------- */

void FixMPM::handle_bad_points()
{
  bigint n[2] = {(bigint) bad_points.size(), (bigint) failed_points.size()}, all[2];
  MPI_Allreduce(n, all, 2, MPI_LMP_BIGINT, MPI_SUM, world);
  nbad_total += all[0];
  if (policy != DELETE) bad_points.clear();
  if ((all[0] && policy == DELETE) || all[1]) next_reneighbor = update->ntimestep;
}

/* ---------------------------------------------------------------------- */

void FixMPM::delete_points(const std::vector<tagint> &list, bool warn)
{
  std::vector<tagint> sorted(list);
  std::sort(sorted.begin(), sorted.end());
  double lost[5] = {0.0}, all[5];    // points, mass, momentum
  std::vector<double> history;
  for (int i = atom->nlocal - 1; i >= 0 && !sorted.empty(); i--) {
    if (!std::binary_search(sorted.begin(), sorted.end(), atom->tag[i])) continue;
    const double *v = atom->v[i], m = atom->rmass[i];
    lost[0]++;
    lost[1] += m;
    for (int d = 0; d < 3; d++) lost[2 + d] += m * v[d];
    if (ledger_on) {
      const double kinetic = 0.5 * force->mvv2e * m * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      const FixMPMMaterial *material = material_of(i);
      double w[BATCH];
      load_state(*batch, &i, 1, material, history);
      material->material->stored_energy(*batch, w);
      ledger.deleted_kinetic -= kinetic;
      ledger.deleted_stored -= atom->vfrac[i] * w[0] / force->nktv2p;
      kinetic_points -= kinetic;
    }
    atom->avec->copy(atom->nlocal - 1, i, 1);
    atom->nlocal--;
  }
  MPI_Allreduce(lost, all, 5, MPI_DOUBLE, MPI_SUM, world);
  if (all[0] == 0.0) return;
  if (atom->map_style != Atom::MAP_NONE) {    // ghosts do not follow their owners any more
    atom->nghost = 0;
    atom->map_init();
    atom->map_set();
  }
  topology_valid = false;
  atom->natoms -= (bigint) all[0];
  deleted.points += all[0];
  deleted.mass += all[1];
  for (int d = 0; d < 3; d++) deleted.momentum[d] += all[2 + d];
  if (warn && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm {} deleted {:.0f} points of mass {:.6g} and momentum {:.6g} "
                   "{:.6g} {:.6g} at step {}",
                   id, all[0], all[1], all[2], all[3], all[4], update->ntimestep);
}

/* ----------------------------------------------------------------------
   smallest h/(c + |v|) over this rank's points. Total frame: points stay where they are on the
   lattice, but waves cross it faster where it is compressed: a plane wave with wave vector K there
   has k = F^-T K in space, |k| <= |K|/s with the smallest singular value s of F: s h/c
------------------------------------------------------------------------- */

double FixMPM::stable_dt_local(tagint &id_min, double &wave_speed) const
{
  Batch &b = *batch;
  static const double no_gradient[9 * BATCH] = {0.0};
  std::vector<double> history;
  double c[BATCH], smallest = std::numeric_limits<double>::max();
  id_min = 0;
  wave_speed = 0.0;

  for (int i = 0, last; i < atom->nlocal; i = last) {
    last = i + 1;
    if (!is_point(i)) continue;
    if (is_node(i)) {    // must not cross a cell in a step; the rest: FixMPMElements
      const double *v = atom->v[i], speed = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      if (total || speed * smallest <= lattice.h) continue;
      smallest = lattice.h / speed;
      id_min = atom->tag[i];
      if (std::isnan(smallest)) return smallest;
      continue;
    }

    // consecutive points of one material

    const FixMPMMaterial *material = material_of(i);
    while (last < atom->nlocal && last < i + BATCH && is_point(last) &&
           material_of(last) == material && !is_node(last))
      last++;
    const int n = last - i, nhistory = material->nhistory;
    batch_kernels->load(b, n, 0.0, no_gradient, points->F[i], points->tau[i], atom->vfrac + i,
                        no_gradient);
    history.resize((std::size_t) std::max(1, nhistory) * BATCH);
    b.history = reinterpret_cast<double(*)[BATCH]>(history.data());
    for (int p = 0; p < n; p++)
      for (int k = 0; k < nhistory; k++) b.history[k][p] = material->history[i + p][k];
    material->material->wave_speed(b, c);

    for (int p = 0; p < n; p++) {
      const double *v = atom->v[i + p];
      if (axisymmetric) c[p] *= hoop_stiffening(i + p);
      double speed = c[p] + sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      if (total) {
        double least, most;
        stretches(i + p, least, most);
        speed = c[p] / least;
      }
      if (speed * smallest <= lattice.h) continue;    // NaN does not pass unseen
      smallest = lattice.h / speed;
      id_min = atom->tag[i + p];
      wave_speed = c[p];
      if (std::isnan(smallest)) return smallest;
    }
  }
  return smallest;
}

/* ----------------------------------------------------------------------
   change of volume of the points of a batch in this step; inverted ones are errors anyway
------------------------------------------------------------------------- */

void FixMPM::note_volume_rate(const Batch &b, int first)
{
  double most = 0.0;
  for (int p = 0; p < b.n; p++) most = std::max(most, fabs(b.J[p] / b.Jold[p] - 1.0));
  if (!(most > volume_rate.most * b.dt)) return;
  int fastest = 0;
  while (fastest < b.n - 1 && fabs(b.J[fastest] / b.Jold[fastest] - 1.0) < most) fastest++;
  volume_rate = {most / b.dt, atom->tag[first + fastest]};
}

/* ---------------------------------------------------------------------- */

void FixMPM::check_dt()
{
  next_dt_check = update->ntimestep + DT_CHECK_EVERY;
  if (!dt_check) return;
  for (auto *ifix : elements)
    if (driver) ifix->check_dt();
  tagint tag;
  double c;
  const double limit = stable_dt_local(tag, c);
  if (!(step_dt() <= limit)) {
    const int i = find_local(tag);
    error->one(FLERR,
               "Time step {:.6g} is above the limit {} = {:.6g} at step {}: {}, wave "
               "speed {:.6g}; use timestep, fix mpm/dt, or fix mpm ... dtcheck no",
               step_dt(), total ? "s h/c (s: smallest stretch)" : "h/(c+|v|)", limit,
               update->ntimestep, point_state(i), c);
  }
}

/* ----------------------------------------------------------------------
   largest stable time step in parts of h/(c + |v|) where it is below 1: the smallest of what
   bench/extremes has measured for bodies anywhere on the lattice, rounded down. Stress that is made
   from velocities which the same stress has just changed (USL without affine matrix) costs most;
   with points of finite size it goes with the square root of their half size s in node spacings, as
   the ratio of stiffness and mass of a node that they barely reach is E/(rho h^2 s). Domains (CPDI)
   do not care for size. Linear functions without any limit have warnings of their own, see
   check_light_nodes() and light_share().
------------------------------------------------------------------------- */

double FixMPM::stable_share(double size) const
{
  const bool usl = scheme == USL, affine = is_affine(transfer);
  if (extent == UNIFORM || extent == CONTIGUOUS) {
    const double share = refinement == FMPM ? 0.37 : (usl ? 0.5 : (affine ? 0.55 : 1.0));
    return usl ? std::min(share, 1.25 * share / 0.5 * sqrt(size)) : share;
  }
  if (refinement == FMPM) return 0.4;
  if (shape == LINEAR && extent == NO_SIZE && !total) {
    if (light > 0.0) return scheme == USF ? 0.28 : 0.7;
    if (usl) return 0.65;
    return affine ? 0.9 : (scheme == USAVG ? 1.0 : (scheme == USF ? 0.25 : 0.65));
  }
  if (affine) {
    if (shape == CUBIC) return 1.0;
    if (transfer == TPIC && shape == QUADRATIC) return usl ? 0.7 : 0.85;
    return bernstein ? 0.8 : (shape == QUADRATIC ? 0.95 : (total ? 0.75 : 0.85));
  }
  if (!usl) return 1.0;
  return shape == LINEAR ? 0.6 : (shape == QUADRATIC ? 0.55 : 0.9);
}

/* ---------------------------------------------------------------------- */

void FixMPM::warn_dt()
{
  if (!dt_check) return;
  tagint tag;
  double c, mine[2] = {stable_dt_local(tag, c), 0.5}, all[2];
  if (extent == UNIFORM || extent == CONTIGUOUS)
    for (int i = 0; i < atom->nlocal; i++)
      if (is_point(i)) mine[1] = std::min(mine[1], half_size(i));
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_MIN, world);
  const double share = std::min(stable_share(all[1]), light_share());
  if (comm->me == 0 && share < 1.0 && step_dt() > share * all[0])
    error->warning(
        FLERR,
        "Fix mpm {}: the time step is {:.3g} h/(c+|v|), but this shape, transfer and "
        "scheme can be unstable above {:.2g}, depending on where points are in their cells: "
        "use fix mpm/dt {:.2g} or less, or another scheme{}",
        id, step_dt() / all[0], share, share,
        total ? ", or an origin for which faces of the body are on nodes" : "");
}

int FixMPM::find_local(tagint tag) const
{
  int i = 0;
  while (i < atom->nlocal - 1 && atom->tag[i] != tag) i++;
  return i;
}
