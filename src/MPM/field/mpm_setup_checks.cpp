/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_setup_checks.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_pair_styles.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "compute.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_cpdi.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_guard.h"
#include "field/mpm_node_action.h"
#include "fix.h"
#include "force.h"
#include "group.h"
#include "lammps.h"
#include "material/material.h"
#include "modify.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "output.h"
#include "pair.h"
#include "thermo.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

void MPMSetupChecks::run(When when, bool first)
{
  using Checks = MPMSetupChecks;
  struct Check {
    When when;
    bool of_all;    // of all fields together
    void (MPMSetupChecks::*look)();
  };
  static constexpr Check list[] = {{POINTS, false, &Checks::integrators},
                                   {POINTS, false, &Checks::points},
                                   {POINTS, false, &Checks::rings},
                                   {POINTS, true, &Checks::forgotten_points},
                                   {POINTS, true, &Checks::coupling},
                                   {POINTS, true, &Checks::fixes},
                                   {POINTS, true, &Checks::regions},
                                   {POINTS, false, &Checks::new_points},
                                   {POINTS, true, &Checks::computes},
                                   {POINTS, true, &Checks::columns},
                                   {POINTS, true, &Checks::skin},
                                   {POINTS, true, &Checks::lists_after_restart},
                                   {PAIRS, false, &Checks::radii},
                                   {PAIRS, true, &Checks::neighbors},
                                   {PLACES, false, &Checks::places},
                                   {PLACES, false, &Checks::locking},
                                   {PLACES, false, &Checks::liquid_on_bodies},
                                   {LISTS, true, &Checks::lists_of_pairs}};
  for (const auto &check : list)
    if (check.when == when && (first || !check.of_all)) (this->*check.look)();
}

/** A point must have one integrator; fixes of this style may hide from LAMMPS that they are one,
 *  see FixMPM::init(). */
void MPMSetupChecks::integrators()
{
  refuse_other_integrators(lmp, field.fix);
}

void MPMSetupChecks::forgotten_points()
{
  field.guard->expect_points(warn_of_forgotten_points(lmp, "mpm", "have no stress"));
}

void MPMSetupChecks::new_points()
{
  if (update->ntimestep != 0) return;    // later, points may be as hot as they have become
  doubts.check_temperatures(field);
}

void MPMSetupChecks::look()
{
  uncoupled.look();
  doubts.look_at_regions();
  // gravity by variables is not known before it has acted
  if (weighed) return;
  weighed = true;
  if (update->firststep != 0) return;    // later, points may be anywhere
  const auto fields = MPMField::all(lmp);
  for (const auto *one : fields) doubts.check_weight(*one);
  doubts.check_gas(fields);
}

void MPMSetupChecks::coupling()
{
  uncoupled.begin_run(field.fix);
}

/** Points of nearly incompressible solids lock, and averages over points make what bends, and does
 *  not lock, too soft. */
void MPMSetupChecks::locking()
{
  // a bent panel of 12 cells is 2 % too stiff with 0.49, 3 % with 0.495, 7 % with 0.499
  constexpr double LOCKS = 0.4975, FREE = 0.4;
  const auto &o = field.options;
  const bool averages = o.averages_stress() || o.averages_volume() || o.averages_strain();
  if (warned_of_locking) return;
  std::vector<int> mine(field.materials.size(), 0), all(mine.size(), 0);
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i) || field.is_element_node(i)) continue;
    const auto *const material = field.material_of(i);
    for (std::size_t k = 0; k < mine.size(); k++) mine[k] |= field.materials[k] == material;
  }
  MPI_Allreduce(mine.data(), all.data(), (int) mine.size(), MPI_INT, MPI_MAX, world);
  const FixMPMMaterial *locks = nullptr, *free = nullptr;
  bool needs_averages = false;
  for (std::size_t k = 0; k < all.size(); k++) {
    if (!all[k]) continue;
    const auto *const material = field.materials[k];
    const double ratio = MPMRestModuli(*material->material).poisson_ratio();
    if (ratio >= LOCKS) locks = material;
    // plastic flow keeps the volume, too
    const bool is_free = ratio > 0.0 && ratio < FREE && material->nhistory == 0;
    if (is_free)
      free = material;
    else
      needs_averages = true;
  }
  warned_of_locking = averages ? free && !needs_averages : locks != nullptr;
  if (!warned_of_locking || comm->me) return;
  if (averages)
    error->warning(
        FLERR,
        "Fix mpm {}: locking averages what does not lock: fix mpm/material {} has a "
        "Poisson ratio of {:.5g}, with which bodies that bend get 4 to 6 % too soft with "
        "4 cells in their depth, and 17 to 22 % with 2: remove locking",
        field.id(), free->id, MPMRestModuli(*free->material).poisson_ratio());
  else
    error->warning(FLERR,
                   "Fix mpm {}: fix mpm/material {} has a Poisson ratio of {:.5g}, with which "
                   "points lock, and bodies that bend or are indented are 7 to 20 % too stiff on "
                   "10 cells: use locking fbar or pressure",
                   field.id(), locks->id, MPMRestModuli(*locks->material).poisson_ratio());
}

/** Nodes that a body moves do not let liquid next to it be compressed, so that the rows of points
 *  there share the pressure in a wrong way, which the nodes do not see. */
void MPMSetupChecks::liquid_on_bodies()
{
  if (warned_of_liquid || field.options.smooths_volumes()) return;
  const auto actions = find_fixes<MPMNodeAction>(lmp);
  const FixMPMMaterial *liquid = nullptr, *solid = nullptr;
  for (auto *other : MPMField::all(lmp)) {
    const bool near = other == &field ||
        std::any_of(actions.begin(), actions.end(), [&](const auto *action) {
                        return action->touches(field.id()) && action->touches(other->id());
                      });
    if (!near) continue;
    const auto here = other->present_materials();
    for (std::size_t k = 0; k < here.size(); k++) {
      const auto *const material = other->materials[k];
      if (here[k] && material->material->is_solid()) solid = material;
      if (here[k] && other == &field && material->material->is_barotropic()) liquid = material;
    }
  }
  warned_of_liquid = liquid && solid;
  if (warned_of_liquid && comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm {}: pressures of the liquid (fix mpm/material {}) are wrong by 10 to 25 "
        "% in the rows of points next to bodies that deform (fix mpm/material {}), while "
        "forces on these are right: use smooth 0.4",
        field.id(), liquid->id, solid->id);
}

/** In the total frame points stay at their positions in their cells, even where round-off decides
 *  about strain and stress: linear and Bernstein functions have gradients that jump at faces of
 *  cells. */
void MPMSetupChecks::places()
{
  constexpr double NEAR = 1.0e-9;    // in node spacings
  const auto &options = field.options;
  const auto &lattice = field.lattice;
  const auto &shape = shape_constants[options.shape];
  if (!options.total || options.shape == QUADRATIC || options.shape == CUBIC) return;

  const auto is_end = [&](double t) {
    const double cells = (t - shape.shift) / shape.cell;
    return fabs(cells - std::round(cells)) < NEAR;
  };
  int mine[3] = {0, 0, 0}, all[3];    // is any at an end, along each axis?
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i) || field.is_element_node(i)) continue;
    for (int d = 0; d < lattice.dim; d++) {
      const double t = (field.frame->places()[i][d] - lattice.origin[d]) / lattice.h;
      if (is_end(t)) mine[d] = 1;
    }
  }
  MPI_Allreduce(mine, all, 3, MPI_INT, MPI_MAX, world);

  for (int d = 0; d < lattice.dim; d++) {
    if (!all[d]) continue;
    if (comm->me == 0)
      error->warning(FLERR,
                     "Fix mpm {}: round-off decides in which cell points along {} are, and in "
                     "frame total about their stress, as they are on faces of cells: use other "
                     "ones (ppc), or another origin",
                     field.id(), (char) ('x' + d));
    return;
  }
}

void MPMSetupChecks::points()
{
  enum { POINT, NONE, SEVERAL, MASS, STATE, AXIS, SIZE, NKINDS };
  bigint count[NKINDS] = {0}, all[NKINDS];
  tagint example[NKINDS] = {0}, example_all[NKINDS];
  auto note = [&](int kind, int i) {
    count[kind]++;
    example[kind] = std::max(example[kind], atom->tag[i]);
  };

  for (auto *material : field.materials) material->assign_mass();

  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    note(POINT, i);
    int n = 0;
    for (auto *material : field.materials) n += (atom->mask[i] & material->groupbit) != 0;
    if (n == 0) note(NONE, i);
    if (n > 1) note(SEVERAL, i);
    if (n == 1 && !(atom->rmass[i] > 0.0 && std::isfinite(atom->rmass[i]))) note(MASS, i);

    const double J = field.points->jacobian(i), *v = atom->v[i], *x = atom->x[i];
    double sum = J;
    for (int d = 0; d < 3; d++) sum += fabs(x[d]) + fabs(v[d]);
    for (int c = 0; c < 6; c++) sum += fabs(field.points->tau[i][c]);
    if (!std::isfinite(sum) || !(J > 0.0)) note(STATE, i);
    if (field.options.axisymmetric && !(x[0] > 0.0)) note(AXIS, i);
    if (field.boxes && field.boxes->is_too_large(i)) note(SIZE, i);
  }
  MPI_Allreduce(count, all, NKINDS, MPI_LMP_BIGINT, MPI_SUM, world);
  MPI_Allreduce(example, example_all, NKINDS, MPI_LMP_TAGINT, MPI_MAX, world);

  const auto actions = find_fixes<MPMNodeAction>(lmp);
  const bool may_be_empty = std::any_of(actions.begin(), actions.end(), [this](const auto *action) {
    return action->may_be_empty(field);
  });
  if (all[POINT] == 0 && !may_be_empty) {
    const bigint others = points_in_both(lmp, 1, 1);
    error->all(FLERR,
               "Fix mpm {} has no material points: its group {} has no atoms with a volume; make "
               "points with create_points{}",
               field.id(), group->names[field.fix.igroup],
               others ? fmt::format(" and its keyword group, or put some of the {} that there are "
                                    "into the group with the group command after it",
                                    others)
                      : ", or give atoms a volume with set ... volume");
  }
  static const char *const refusals[NKINDS] = {
      nullptr,
      "{0} material points have no material, for instance point {1}: define a fix mpm/material for "
      "their group",
      "{0} material points have more than one material, for instance point {1}: the groups of the "
      "mpm/material fixes must be disjoint",
      "{0} material points have no positive mass, for instance point {1}: check the density of "
      "their material or their set mass",
      "{0} material points have a position, velocity, deformation or stress that is not finite or "
      "is inverted, for instance point {1}",
      "{0} material points of fix mpm {2} axisymmetric are not at positive x, for instance point "
      "{1}: x is the distance from the axis",
      "{0} material points are larger than the cells of fix mpm {2}, for instance point {1}: shape "
      "gimp and cpgimp need at least one point per cell, and aspect if points are not cubes"};
  for (int kind = NONE; kind < NKINDS; kind++)
    if (all[kind]) error->all(FLERR, refusals[kind], all[kind], example_all[kind], field.id());
}

/** Warns of points that create_points made before the fix: they have areas instead of volumes of
 *  rings, the same at all radii. */
void MPMSetupChecks::rings()
{
  if (!field.options.axisymmetric) return;
  constexpr double SAME = 1.0e-9, FAR = 1.01;
  constexpr double NONE = std::numeric_limits<double>::max();
  double mine[4] = {-NONE, -NONE, -NONE, -NONE}, all[4];    // most, minus least: volume, radius
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    const double values[2] = {atom->vfrac[i], atom->x[i][0]};
    for (int k = 0; k < 2; k++) {
      mine[2 * k] = std::max(mine[2 * k], values[k]);
      mine[2 * k + 1] = std::max(mine[2 * k + 1], -values[k]);
    }
  }
  MPI_Allreduce(mine, all, 4, MPI_DOUBLE, MPI_MAX, world);
  if (comm->me == 0 && all[0] <= -(1.0 + SAME) * all[1] && all[2] > -FAR * all[3])
    error->warning(FLERR,
                   "Points of fix mpm {} axisymmetric have the same volume at all radii, which "
                   "rings of one section have not: use create_points after the fix",
                   field.id());
}

/** Neighbor lists of points and grains: the two settings that make them slow. Pairs of points only
 *  cost time, unless pair style mpm/penalty uses them; and with bins of the size of a grain, each
 *  point tests all points within reach of a grain. */
void MPMSetupChecks::neighbors()
{
  constexpr bigint MANY = 1000;    // least number of points for a warning
  constexpr double RATIO = 2.0;
  const int ntypes = atom->ntypes;
  std::vector<int> mine(2 * (ntypes + 1), 0), all(2 * (ntypes + 1));    // points, other atoms
  bigint npoints = 0, npoints_all;
  const int listed = group->bitmask[neighbor->includegroup];    // 0: all
  int moved = 0;    // groups of lattices: nodes of sheets without a lattice need their pairs
  for (const auto *other : MPMField::all(lmp)) moved |= other->fix.groupbit;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & listed)) continue;
    const bool point = atom->vfrac[i] > 0.0;
    if (point && !(atom->mask[i] & moved)) continue;
    mine[2 * atom->type[i] + !point] = 1;
    npoints += point;
  }
  MPI_Allreduce(mine.data(), all.data(), mine.size(), MPI_INT, MPI_MAX, world);
  MPI_Allreduce(&npoints, &npoints_all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (npoints_all < MANY) return;

  double cut_points = 0.0, cut_others = 0.0;    // squares of cutoffs
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
                     "Fix mpm: pairs of material points of type {} are in the neighbor lists, at "
                     "great cost and for nothing but pair forces between them: use neigh_modify "
                     "exclude type {} {}, or keyword lists of fix mpm/surface",
                     t, t, t);
  }
  if (cut_others > RATIO * RATIO * cut_points && neighbor->style != Neighbor::MULTI &&
      comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm: neighbor lists of points and of grains {:.1f} times as large are many "
                   "times faster with neighbor ... multi and comm_modify mode multi, which keyword "
                   "lists of fix mpm/surface sets",
                   sqrt(cut_others / std::max(cut_points, 1.0e-300)));
}

void MPMSetupChecks::lists_after_restart()
{
  if (!lists_of_file) return;
  const auto text = [](const Lists &l) {
    return fmt::format("skin {}, every {} delay {} check {} once {}", l.skin, l.every, l.delay,
                       l.check ? "yes" : "no", l.once ? "yes" : "no");
  };
  const std::string then = text(*lists_of_file), now = text(lists());
  lists_of_file.reset();
  if (comm->me == 0 && now != then)
    error->warning(FLERR,
                   "Fix mpm: neighbor lists had {} in the run that wrote the restart file, and "
                   "have {} now: what follows differs in the last digits from that run; give "
                   "neighbor and neigh_modify after read_restart, which sets the skin to the "
                   "default of its units where these were others",
                   then, now);
}

MPMSetupChecks::Lists MPMSetupChecks::lists() const
{
  return {neighbor->skin, neighbor->every, neighbor->delay, neighbor->dist_check,
          neighbor->build_once};
}

/** Fixes that are made for atoms: those that set forces affect only external ones, as forces of
 *  stress never leave the lattice, and thermostats treat the motion of points as heat. */
void MPMSetupChecks::fixes()
{
  static const char *const forces =
      "sets their external forces only, not those of stress, and does not hold them: use fix "
      "mpm/boundary, or fix addforce for a load";
  static const char *const heat =
      "takes their motion for heat, but they have no temperature: give it a group without them";
  static const std::pair<const char *, const char *> doubts[] = {
      {"^setforce", forces},   {"^freeze", forces}, {"^aveforce", forces}, {"^lineforce", forces},
      {"^planeforce", forces}, {"^langevin", heat}, {"^temp/", heat}};
  const auto fields = MPMField::all(lmp);
  for (const auto *other : modify->get_fix_list())
    for (const auto &[style, what] : doubts) {
      if (!utils::strmatch(other->style, style)) continue;
      bigint n = 0, all;
      for (int i = 0; i < atom->nlocal; i++)
        for (const auto *one : fields) n += (atom->mask[i] & other->groupbit) && one->is_point(i);
      MPI_Allreduce(&n, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
      if (all && comm->me == 0)
        error->warning(FLERR, "Fix {} (style {}) has {} material points in its group and {}",
                       other->id, other->style, all, what);
    }
}

/** Is there something besides points that has an energy, so that the one of LAMMPS says something?
 *  Forces of grains have none. */
bool MPMSetupChecks::has_energies() const
{
  const auto styles = MPMPairStyle::all(*force);
  return force->bond || force->angle || force->dihedral || force->improper || force->kspace ||
      modify->n_energy_global > 0 ||
      std::any_of(styles.begin(), styles.end(), [](const MPMPairStyle &style) {
           return style.name != "zero" && !utils::strmatch(style.name, "^gran");
         });
}

/** Computes that are made for atoms. Those of LAMMPS's own log are left to columns(). */
void MPMSetupChecks::computes()
{
  static const char *const stress =
      "sees their velocities and the forces of pairs, not their stress: use the pressure or the "
      "stress of compute mpm/atom, and compute reduce ... ave for a mean";
  static const char *const heat =
      "takes their motion for heat: use the temperature of compute mpm/atom, or give it a group "
      "without them";
  static const char *const energy = "sees the energy of pairs, not that of their stress: use "
                                    "compute mpm/energy, or the energy of "
                                    "compute mpm/atom";
  const char *const of_pairs = has_energies() ? nullptr : energy;
  const std::pair<const char *, const char *> doubts[] = {
      {"^pressure", stress}, {"^stress/atom", stress}, {"^centroid/stress/", stress},
      {"^temp$", heat},      {"^temp/", heat},         {"^pe$", of_pairs},
      {"^pe/atom", of_pairs}};
  for (const auto *compute : modify->get_compute_list())
    for (const auto &[style, what] : doubts) {
      if (!what || !utils::strmatch(compute->style, style) ||
          utils::strmatch(compute->id, "^thermo_") || !told_of.insert(compute->id).second)
        continue;
      const bigint all = points_in_both(lmp, 1, compute->groupbit);
      if (all && comm->me == 0)
        error->warning(FLERR, "Compute {} (style {}) has {} material points in its group and {}",
                       compute->id, compute->style, all, what);
    }
}

/** The default style of the log has such columns, too; this is said without a warning. */
void MPMSetupChecks::columns()
{
  static const char *const common[] = {"Step", "Temp", "E_pair", "E_mol", "TotEng", "Press"};
  if (comm->me || !output->thermo) return;
  std::vector<std::string> words;
  for (const auto &word : output->thermo->get_keywords())    // some may be empty
    if (!word.empty() && word != "Volume") words.push_back(word);
  const auto find = [&](std::initializer_list<const char *> names) {
    std::string found;
    for (const char *const word : names)
      if (std::count(words.begin(), words.end(), word) &&
          told_of.insert(std::string("column ") + word).second)
        found += (found.empty() ? "" : " ") + std::string(word);
    return found;
  };
  const auto tell = [&](const std::string &text) {
    if (std::equal(words.begin(), words.end(), std::begin(common), std::end(common)))
      utils::logmesg(lmp, "Fix mpm: columns {}\n", text);
    else
      error->warning(FLERR, "Fix mpm: columns {}", text);
  };
  const std::string atoms = find({"Temp", "Press", "Pxx", "Pyy", "Pzz", "Pxy", "Pxz", "Pyz"}),
                    energies = has_energies()
      ? find({"TotEng", "Enthalpy", "Econserve"})
      : find({"PotEng", "TotEng", "Enthalpy", "Econserve", "E_pair", "E_vdwl", "E_mol"});
  if (!atoms.empty())
    tell(fmt::format("of the log ({}) see the velocities of material points and the forces of "
                     "pairs, not the temperature or stress of points: for these, use compute "
                     "mpm/atom, and compute reduce ... ave",
                     atoms));
  if (!energies.empty())
    tell(fmt::format("of the log ({}) see the energy of pairs, not that of the stress of material "
                     "points: for this, use compute mpm/energy",
                     energies));
}

/** With the default skin of the units, lists and blocks of nodes may be rebuilt in each step. A
 *  skin counts as small for grains only if it is a small part of their size. */
void MPMSetupChecks::skin()
{
  constexpr double SMALL = 0.1;    // of the node spacing; half of it is a good choice
  if (neighbor->every > 1 || neighbor->delay > 0 || neighbor->build_once) return;
  double h = field.lattice.h;
  for (const auto *other : MPMField::all(lmp)) h = std::min(h, other->lattice.h);
  const double size = force->pair ? std::min(h, 0.5 * force->pair->cutforce) : h;
  if (comm->me == 0 && neighbor->skin < SMALL * size)
    error->warning(FLERR,
                   "Fix mpm: the neighbor skin {:.3g} is small for the node spacing {:.3g}, so "
                   "that lists and blocks of nodes are made anew after next to no motion, at great "
                   "cost: use neighbor {:.3g} {}",
                   neighbor->skin, h, 0.5 * h,
                   neighbor->style == Neighbor::MULTI ? "multi" : "bin");
}

/** Blocks of nodes and the order of points work with a large skin, but lists and ghosts grow with
 *  the cube of skin and cutoff (DECISIONS.md). */
void MPMSetupChecks::lists_of_pairs()
{
  constexpr double MANY = 10.0, RATIO = 8.0;    // pairs per atom; ratio for twice the cutoff in 3d
  if (neighbor->skin <= field.lattice.h) return;
  double mine[3] = {0.0, 0.0, (double) atom->nlocal}, all[3];    // pairs, pairs in reach, atoms
  for (const auto &style : MPMPairStyle::all(*force)) {
    const auto *const list = style.pair->list;
    if (!list) continue;
    for (int ii = 0; ii < list->inum; ii++) {
      const int i = list->ilist[ii];
      mine[0] += list->numneigh[i];
      for (int jj = 0; jj < list->numneigh[i]; jj++) {
        const int j = list->firstneigh[i][jj] & NEIGHMASK;
        double d2 = 0.0;
        for (int d = 0; d < 3; d++) {
          const double distance = atom->x[i][d] - atom->x[j][d];
          d2 += distance * distance;
        }
        mine[1] += d2 < force->pair->cutsq[atom->type[i]][atom->type[j]];
      }
    }
  }
  MPI_Allreduce(mine, all, 3, MPI_DOUBLE, MPI_SUM, world);
  const double cut = force->pair->cutforce;
  if (comm->me || all[0] - all[1] < MANY * all[2] || all[0] < RATIO * all[1]) return;
  error->warning(FLERR,
                 "Fix mpm: the neighbor skin {:.3g} is large for the cutoff {:.3g} of the pair "
                 "style: there are {:.0f} pairs per atom in the neighbor lists, {:.2g} of them "
                 "within the cutoff, at great cost: use neighbor {:.3g} {}",
                 neighbor->skin, cut, all[0] / all[2], all[1] / all[2],
                 0.5 * std::min(field.lattice.h, cut),
                 neighbor->style == Neighbor::MULTI ? "multi" : "bin");
}

/** Pair style granular takes its cutoffs from the radii, but restart files lack the data that it
 *  needs for this: with the settings of a file alone, cutoffs are undefined, mostly 0. Then there
 *  are no ghosts, and contacts across ranks and periodic faces are missed silently. */
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
            "Cutoff {:.6g} of pair style granular between points of type {} and grains of type {} "
            "is below the sum {:.6g} of their largest radii. Read_restart loses the cutoffs of "
            "this pair style: give pair_style and pair_coeff again after it",
            cut, i, j, sum);
    }
}

/** Grains see points by their radius. LAMMPS gives no error for a radius of zero, which leaves no
 *  force or one between centers, nor for one of 0.5, its default, in other units. */
void MPMSetupChecks::radii()
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

  bigint mine[3] = {0, 0, 0}, all[3];    // points that meet grains, without radius, too large
  tagint example = 0, example_all;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    bool meets = false;
    for (int t = 1; t <= ntypes; t++)
      meets = meets || (grains_all[t] && force->pair->cutsq[atom->type[i]][t] > 0.0);
    if (!meets) continue;
    mine[0]++;
    mine[1] += atom->radius[i] == 0.0;
    if (atom->radius[i] <= 2.0 * field.lattice.h) continue;
    mine[2]++;
    example = std::max(example, atom->tag[i]);
  }
  MPI_Allreduce(mine, all, 3, MPI_LMP_BIGINT, MPI_SUM, world);
  MPI_Allreduce(&example, &example_all, 1, MPI_LMP_TAGINT, MPI_MAX, world);
  if (all[0] == 0) return;
  if (field.options.axisymmetric)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Points of fix mpm {} axisymmetric cannot meet grains through pair style {}: a grain would "
        "be a ring; let bodies meet through fix mpm/contact, or use 3d for grains",
        field.id(), force->pair_style);
  if (all[1] == all[0])
    error->all(FLERR, Error::NOLASTLINE,
               "Points of fix mpm {} have no radius, by which pair style {} couples them to "
               "grains: use fix mpm/surface, or set ... diameter",
               field.id(), force->pair_style);
  if (all[2])
    error->all(FLERR, Error::NOLASTLINE,
               "{} points of fix mpm {} have a radius of more than two node spacings, for instance "
               "point {}: use fix mpm/surface, or set ... diameter",
               all[2], field.id(), example_all);
}

bigint LAMMPS_NS::points_in_both(LAMMPS *lmp, int one, int other)
{
  const Atom *atom = lmp->atom;
  bigint n = 0, all;
  for (int i = 0; i < atom->nlocal; i++)
    n += atom->vfrac[i] > 0.0 && (atom->mask[i] & one) && (atom->mask[i] & other);
  MPI_Allreduce(&n, &all, 1, MPI_LMP_BIGINT, MPI_SUM, lmp->world);
  return all;
}

std::string LAMMPS_NS::remedy_of_step(LAMMPS *lmp)
{
  const auto fixes = lmp->modify->get_fix_by_style("^mpm/dt$");
  if (fixes.empty()) return "use timestep, fix mpm/dt";
  return fmt::format(
      "give fix mpm/dt {} the keyword every 1, strain 0.05, or a smaller fraction, as "
      "the limit has become less since it last looked",
      fixes[0]->id);
}

/** Does a fix move atoms of its group? Those of this package may hide it from LAMMPS. */
static bool moves_atoms(const Fix &fix)
{
  const std::string style = fix.style;
  return fix.time_integrate || style == "mpm" || style == "mpm/mesh" ||
      style == "mpm/incompressible";
}

int LAMMPS_NS::seen_as_integrator(LAMMPS *lmp, const Fix &mine)
{
  const auto &fixes = lmp->modify->get_fix_list();
  return std::none_of(fixes.begin(), fixes.end(), [&](const Fix *other) {
    return other != &mine && other->time_integrate;
  });
}

void LAMMPS_NS::allow_no_ghosts(LAMMPS *lmp, double h)
{
  const double nothing = 1.0e-8 * h;
  double &cutoff = lmp->comm->cutghostuser;
  const Force &force = *lmp->force;
  const bool any = (force.pair && force.pair->cutforce > 0.0) || force.bond || force.angle ||
      force.dihedral || force.improper;
  if (!any && cutoff == 0.0) cutoff = nothing;
  if (any && cutoff == nothing) cutoff = 0.0;
}

void LAMMPS_NS::refuse_other_integrators(LAMMPS *lmp, const Fix &mine)
{
  for (const auto *other : lmp->modify->get_fix_list()) {
    if (other == &mine || !moves_atoms(*other)) continue;
    const bigint all = points_in_both(lmp, mine.groupbit, other->groupbit);
    if (all)
      lmp->error->all(FLERR, Error::NOLASTLINE,
                      "{} material points of fix {} (style {}) are also integrated by fix {} "
                      "(style {}): give the fixes disjoint groups",
                      all, mine.id, mine.style, other->id, other->style);
  }
}

bigint LAMMPS_NS::warn_of_forgotten_points(LAMMPS *lmp, const std::string &style,
                                           const std::string &lack)
{
  const Atom *atom = lmp->atom;
  int moved = 0;    // groups that something moves
  for (const auto *ifix : lmp->modify->get_fix_list())
    if (moves_atoms(*ifix)) moved |= ifix->groupbit;
  bigint mine[2] = {0, 0}, all[2];    // points, those that do not move
  tagint example = 0, example_all;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->vfrac[i] > 0.0)) continue;
    mine[0]++;
    if (atom->mask[i] & moved) continue;
    mine[1]++;
    example = std::max(example, atom->tag[i]);
  }
  MPI_Allreduce(mine, all, 2, MPI_LMP_BIGINT, MPI_SUM, lmp->world);
  if (all[1] == 0) return all[0];
  MPI_Allreduce(&example, &example_all, 1, MPI_LMP_TAGINT, MPI_MAX, lmp->world);
  if (lmp->comm->me == 0)
    lmp->error->warning(FLERR,
                        "{} material points belong to no fix {}, for instance point {}: they do "
                        "not move and {}; if they shall, put them into the group of a fix {} with "
                        "keyword group of create_points, or with the group command after it",
                        all[1], style, example_all, lack, style);
  return all[0];
}
