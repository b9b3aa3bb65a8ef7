/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "step/mpm_grains.h"

#include "atom.h"
#include "base/mpm_pair_styles.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix.h"
#include "force.h"
#include "modify.h"
#include "neigh_list.h"
#include "region.h"
#include "update.h"

#include <cmath>
#include <cstring>
#include <limits>

// LAMMPS may be built without its package GRANULAR. Only data and virtual functions of its classes
// are used, so that the plugin can be loaded by such a LAMMPS, too

#if __has_include(<pair_granular.h>)
#define MPM_HAS_GRANULAR 1
#include <fix_wall_gran.h>
#include <gran_sub_mod_damping.h>
#include <gran_sub_mod_normal.h>
#include <granular_model.h>
#include <pair_gran_hooke_history.h>
#include <pair_granular.h>
#else
#define MPM_HAS_GRANULAR 0
#endif

using namespace LAMMPS_NS;

/** Steps of the run in one of this atom. */
static int steps_of(const Atom &atom, int i, int every)
{
  return atom.vfrac[i] > 0.0 ? every : 1;
}

/** Springs without damping: half a period, or, with the force k sqrt(R) delta^1.5, the time from
 *  the first touch to the last,
 *
 *    2.94 delta_max / v,   k sqrt(R) delta_max^2.5 2/5 = m v^2 / 2,
 *
 *  with the velocity v of the first touch, which the energy of now has. What is damped takes
 *  longer, but its velocity may decay faster: pi over the fastest rate of the contact holds for
 *  both. */
double MPMGrains::duration(const Law &law, double m, double R, double overlap, double v)
{
  const double never = std::numeric_limits<double>::infinity();
  double rate = std::sqrt(law.k / m), largest = std::max(overlap, 0.0);
  if (law.hertz) {
    const double stiffness = 0.4 * law.k * std::sqrt(R);
    const double energy = 0.5 * m * v * v + stiffness * std::pow(largest, 2.5);
    if (!(energy > 0.0) || !(stiffness > 0.0)) return never;
    largest = std::pow(energy / stiffness, 0.4);
    static const double half = 0.4 * std::tgamma(0.4) * std::tgamma(0.5) / std::tgamma(0.9);
    rate = M_PI * std::sqrt(2.0 * energy / m) / (2.0 * half * largest);
  } else if (rate > 0.0)
    largest = std::hypot(largest, v / rate);
  if (!(rate > 0.0)) return never;

  double decay = 0.5 * law.damping;
  if (law.damping_is == Law::PLAIN) decay /= m;
  if (law.damping_is == Law::BY_MASS_AND_RADIUS) decay *= std::sqrt(R * largest);
  if (law.damping_is == Law::BY_STIFFNESS) {    // force over overlap at the largest one
    const double stiffness = law.hertz ? law.k * std::sqrt(R * largest) : law.k;
    decay *= std::sqrt(stiffness / m);
  }
  return M_PI / (decay > rate ? decay + std::sqrt(decay * decay - rate * rate) : rate);
}

/** Forces in units of mass times acceleration. All of LAMMPS's formulas of damping have the mass in
 *  units of mass, so that a force ~ mass gamma v becomes an acceleration ftm2v gamma v; in that of
 *  tsuji and coeff_restitution, damp sqrt(m k) v, the factor of k takes one root of it. */
MPMGrains::Law MPMGrains::in_units(Law law) const
{
  const double ftm2v = force->ftm2v;
  law.k *= ftm2v;
  law.damping *= law.damping_is == Law::BY_STIFFNESS ? std::sqrt(ftm2v) : ftm2v;
  return law;
}

#if MPM_HAS_GRANULAR

namespace {
struct HookeHistory : PairGranHookeHistory {
  using PairGranHookeHistory::gamman;
  using PairGranHookeHistory::kn;
};

struct Wall : FixWallGran {
  using FixWallGran::amplitude;
  using FixWallGran::axis;
  using FixWallGran::dt;
  using FixWallGran::hi;
  using FixWallGran::idregion;
  using FixWallGran::lo;
  using FixWallGran::omega;
  using FixWallGran::time_origin;
  using FixWallGran::wallstyle;
  using FixWallGran::wiggle;
};

bool is_classic(std::string name)
{
  if (utils::strmatch(name, "/omp$")) name.resize(name.size() - 4);
  return name == "gran/hooke" || name == "gran/hooke/history" || name == "gran/hertz/history";
}

std::vector<Fix *> walls_of(Modify &modify)
{
  std::vector<Fix *> walls;
  for (auto *fix : modify.get_fix_list())
    if (strcmp(fix->style, "wall/gran") == 0 || strcmp(fix->style, "wall/gran/region") == 0)
      walls.push_back(fix);
  return walls;
}
}    // namespace

MPMGrains::MPMGrains(LAMMPS *lmp, const std::string &who) : Pointers(lmp), who(who)
{
  if (force->pair && utils::strmatch(force->pair_style, "^hybrid/scaled"))
    error->all(FLERR, Error::NOLASTLINE,
               "{} cannot know the forces of pair style {}: use keyword max instead", who,
               force->pair_style);
  for (const auto &style : MPMPairStyle::all(*force)) {
    if (is_classic(style.name)) {
      auto *const pair = static_cast<PairGranHookeHistory *>(style.pair);
      const bool hertz = utils::strmatch(style.name, "^gran/hertz");
      styles.push_back({style.pair,
                        in_units({pair->*&HookeHistory::kn, hertz, pair->*&HookeHistory::gamman,
                                  hertz ? Law::BY_MASS_AND_RADIUS : Law::BY_MASS}),
                        false});
    } else if (style.name == "granular") {
      styles.push_back({style.pair, {}, true});
      auto *const pair = static_cast<PairGranular *>(style.pair);
      for (int k = 0; k < pair->nmodels; k++) law_of_model(pair->models_list[k]);
    } else if (utils::strmatch(style.name, "^gran"))
      error->all(FLERR, Error::NOLASTLINE,
                 "{} does not know the stiffness of pair style {}: use keyword max instead", who,
                 style.name);
  }
  for (auto *wall : walls_of(*modify)) law_of_model(static_cast<FixWallGran *>(wall)->model);
  if (styles.empty())
    error->all(FLERR, Error::NOLASTLINE,
               "{} needs a pair style of grains: gran/hooke, gran/hooke/history, "
               "gran/hertz/history, or granular",
               who);
}

/** The numbers of a model are what its force is for overlap, contact radius, mass, and velocity
 *  1. */
MPMGrains::Law MPMGrains::law_of_model(void *any) const
{
  auto *const model = static_cast<Granular_NS::GranularModel *>(any);
  auto *const normal = model->normal_model;
  const std::string &name = normal->name, &damping = model->damping_model->name;
  Law law;
  law.hertz = name == "hertz" || name == "hertz/material";
  if (!law.hertz && name != "hooke")
    error->all(FLERR, Error::NOLASTLINE,
               "{} does not know how long collisions with the normal model {} of granular forces "
               "last, but only with hooke, hertz, and hertz/material: use keyword max instead",
               who, name);
  model->delta = model->contact_radius = 1.0;
  model->meff = 1.0;
  model->vnnr = -1.0;
  model->Fnormal = law.k = normal->calculate_forces();
  law.damping = model->damping_model->calculate_forces();
  law.damping_is = damping == "velocity" ? Law::PLAIN
      : damping == "mass_velocity"       ? Law::BY_MASS
      : damping == "viscoelastic"        ? Law::BY_MASS_AND_RADIUS
                                         : Law::BY_STIFFNESS;
  if (law.damping_is == Law::BY_STIFFNESS && law.k > 0.0) law.damping /= std::sqrt(law.k);
  return in_units(law);
}

MPMGrains::Law MPMGrains::law_of(const Style &style, int itype, int jtype) const
{
  if (!style.granular) return style.law;
  auto *const pair = static_cast<PairGranular *>(style.pair);
  return law_of_model(pair->models_list[pair->types_indices[itype][jtype]]);
}

/** With planes, which may wiggle, and with regions, whose position is that of the last forces;
 *  negative: none. */
static double deepest_overlap(const FixWallGran &wall, Region *region, bigint now, const double *x,
                              double radius)
{
  if (region) {
    double overlap = -1.0;
    if (!region->match(x[0], x[1], x[2])) return overlap;
    const int ncontact = region->surface(x[0], x[1], x[2], radius);
    for (int k = 0; k < ncontact; k++) overlap = std::max(overlap, radius - region->contact[k].r);
    return overlap;
  }
  const int d = wall.*&Wall::wallstyle;
  if (d < 0 || d > 2) return -1.0;
  double shift = 0.0;
  if (wall.*&Wall::wiggle && wall.*&Wall::axis == d) {
    const double t = (double) (now - wall.*&Wall::time_origin) * (wall.*&Wall::dt);
    shift = wall.*&Wall::amplitude * (1.0 - std::cos(wall.*&Wall::omega * t));
  }
  return radius - std::min(x[d] - (wall.*&Wall::lo + shift), wall.*&Wall::hi + shift - x[d]);
}

/** Each grain of the group counts wherever it is, as walls may move, with its whole velocity. */
void MPMGrains::walls(int every, Collision &first) const
{
  const int frozen = frozen_groups();
  for (auto *fix : walls_of(*modify)) {
    const auto &wall = static_cast<const FixWallGran &>(*fix);
    Region *const region = strcmp(fix->style, "wall/gran/region") == 0
        ? domain->get_region_by_id(wall.*&Wall::idregion)
        : nullptr;
    const Law law = law_of_model(wall.model);
    for (int i = 0; i < atom->nlocal; i++) {
      if (!(atom->mask[i] & fix->groupbit) || !(atom->radius[i] > 0.0)) continue;
      if (atom->mask[i] & frozen) continue;
      const double *const v = atom->v[i];
      const double speed = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      const double overlap = law.hertz
          ? deepest_overlap(wall, region, update->ntimestep, atom->x[i], atom->radius[i])
          : 0.0;
      const double t = duration(law, atom->rmass[i], atom->radius[i], overlap, speed) /
          steps_of(*atom, i, every);
      if (t < first.duration) first = {t, atom->tag[i], 0};
    }
  }
}

#else

MPMGrains::MPMGrains(LAMMPS *lmp, const std::string &who) : Pointers(lmp), who(who)
{
  error->all(FLERR, Error::NOLASTLINE, "{} needs LAMMPS with its package GRANULAR", who);
}
MPMGrains::Law MPMGrains::law_of(const Style &, int, int) const
{
  return {};
}
MPMGrains::Law MPMGrains::law_of_model(void *) const
{
  return {};
}
void MPMGrains::walls(int, Collision &) const {}

#endif

int MPMGrains::frozen_groups() const
{
  int frozen = 0;
  for (const auto *fix : modify->get_fix_by_style("^freeze")) frozen |= fix->groupbit;
  return frozen;
}

MPMGrains::Collision MPMGrains::shortest(double ahead, int every) const
{
  Collision first = {std::numeric_limits<double>::infinity(), 0, 0};
  comm->forward_comm();    // velocities of ghosts are of the middle of the step
  for (const auto &style : styles) pairs_of(style, ahead, every, first);
  walls(every, first);
  return first;
}

void MPMGrains::pairs_of(const Style &style, double ahead, int every, Collision &first) const
{
  const auto *const list = style.pair->list;
  if (!list) return;
  const int frozen = frozen_groups();
  const auto mobility = [&](int i) {
    return atom->mask[i] & frozen ? 0.0 : 1.0 / atom->rmass[i];
  };
  for (int ii = 0; ii < list->inum; ii++) {
    const int i = list->ilist[ii];
    for (int jj = 0; jj < list->numneigh[i]; jj++) {
      const int j = list->firstneigh[i][jj] & NEIGHMASK;
      double d2 = 0.0, dv = 0.0;
      for (int a = 0; a < 3; a++) {
        const double d = atom->x[i][a] - atom->x[j][a];
        d2 += d * d;
        dv += d * (atom->v[i][a] - atom->v[j][a]);
      }
      const double distance = std::sqrt(d2), sum = atom->radius[i] + atom->radius[j];
      const double v = distance > 0.0 ? dv / distance : 0.0, overlap = sum - distance;
      if (overlap < 0.0 && !(v < 0.0 && -overlap <= -v * ahead)) continue;
      const double moves = mobility(i) + mobility(j);
      if (moves == 0.0) continue;
      const double R = atom->radius[i] * atom->radius[j] / sum;
      const auto law = law_of(style, atom->type[i], atom->type[j]);
      const double t = duration(law, 1.0 / moves, R, overlap, v) /
          std::max(steps_of(*atom, i, every), steps_of(*atom, j, every));
      if (t < first.duration) first = {t, atom->tag[i], atom->tag[j]};
    }
  }
}

/** Points of one body touch each other as soon as they have their usual diameter. A pair style of
 *  grains that is there for other atoms then pushes them apart, besides the stress of the material:
 *  a body is stiffer, and starts with energy where diameters are larger than distances. */
void LAMMPS_NS::warn_of_points_as_grains(LAMMPS *lmp, int groupbit, const std::string &who)
{
  constexpr double TOUCH = 1.0001;
  const Atom *const atom = lmp->atom;
  if (!atom->radius_flag || !atom->vfrac) return;
  bigint mine = 0, pairs = 0;
  int type = lmp->atom->ntypes + 1, first;
  for (const auto &style : MPMPairStyle::all(*lmp->force)) {
    const NeighList *const list = style.pair->list;
    if (!utils::strmatch(style.name, "^gran") || !list) continue;
    for (int ii = 0; ii < list->inum; ii++) {
      const int i = list->ilist[ii];
      if (!(atom->mask[i] & groupbit) || !(atom->vfrac[i] > 0.0)) continue;
      for (int jj = 0; jj < list->numneigh[i]; jj++) {
        const int j = list->firstneigh[i][jj] & NEIGHMASK;
        // copies of other processes may not have the diameters that fix mpm/surface has just set
        if (j >= atom->nlocal || !(atom->mask[j] & groupbit) || !(atom->vfrac[j] > 0.0)) continue;
        if (atom->type[i] != atom->type[j])
          continue;    // bodies that are to touch as grains have a type each
        double square = 0.0;
        for (int d = 0; d < 3; d++)
          square += (atom->x[i][d] - atom->x[j][d]) * (atom->x[i][d] - atom->x[j][d]);
        const double reach = TOUCH * (atom->radius[i] + atom->radius[j]);
        if (square > reach * reach) continue;
        mine++;
        type = std::min(type, atom->type[i]);
      }
    }
  }
  MPI_Allreduce(&mine, &pairs, 1, MPI_LMP_BIGINT, MPI_SUM, lmp->world);
  MPI_Allreduce(&type, &first, 1, MPI_INT, MPI_MIN, lmp->world);
  if (pairs && lmp->comm->me == 0)
    lmp->error->warning(FLERR,
                        "{}: at least {} pairs of its material points touch as grains by the pair "
                        "style, whose forces are added to the stress of the material: use "
                        "neigh_modify exclude type {} {}, or keyword lists of fix mpm/surface",
                        who, pairs, first, first);
}
