/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// The lattice of sites of create_points: which of them are in the box and in the region, and the
// volume and the position of the point of a site.

#include "create/create_points.h"

#include "atom.h"
#include "base/mpm_lists.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "fix.h"
#include "image/body.h"
#include "input.h"
#include "math/random.h"
#include "region.h"
#include "variable.h"
#include "walls/mpm_region_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double TOLERANCE = 1.0e-6;       // in spacings, for positions that coincide
static constexpr double INFINITE = 1.0e19;        // bounds of regions beyond it are INF
static constexpr double MAX_INDEX = 1.0e15;       // largest index of a lattice site
static constexpr double MAX_SITES = 1.0e11;       // most sites that a rank looks at: an hour
static constexpr bigint MAX_COUNT = 200000000;    // sites per rank looked at outside the box

/** Keyword split: a variable of the position says which sites are divided. */
void CreatePoints::find_split(const Options &options)
{
  if (split.empty()) return;
  const int where = options.where("split") + 1;
  if (image)
    error->all(FLERR, where,
               "Create_points keyword split is for regions: use a finer spacing or sites pixels");
  auto *variable = input->variable;
  const auto find = [&](const std::string &word, int iarg, bool place) {
    const int index = utils::strmatch(word, "^v_") ? variable->find(word.c_str() + 2) : -1;
    if (index < 0)
      error->all(FLERR, iarg, "Create_points split {}: there is no such variable; expected v_name",
                 word);
    if (!(place ? variable->internalstyle(index) : variable->equalstyle(index)))
      error->all(FLERR, iarg, "Create_points split {}: variable must be of style {}", word,
                 place ? "internal" : "equal");
    return index;
  };
  split_variable = find(split, where, false);
  for (int d = 0; d < domain->dimension; d++)
    place_variable[d] = find(split_place[d], where + 1 + d, true);
}

/** Number of points along each axis into which the site is divided. */
int CreatePoints::divisions(const bigint *s) const
{
  for (int d = 0; d < domain->dimension; d++)
    input->variable->internal_set(place_variable[d], position(d, s[d]));
  const double n = input->variable->compute_equal(split_variable);
  if (n != std::floor(n) || n < 1.0 || n > MAX_PPC)
    error->one(FLERR, Error::NOLASTLINE,
               "Create_points split: variable {} is {:.8g} at {:.6g} {:.6g} {:.6g}, but must be an "
               "integer from 1 to {}",
               split.substr(2), n, position(0, s[0]), position(1, s[1]), position(2, s[2]),
               MAX_PPC);
  return (int) n;
}

/** Visits the center of each part of a divided site that is in the region, x fastest. Returns the
 *  number of all parts. */
int CreatePoints::for_parts(const bigint *s,
                            const std::function<void(const double *x)> &visit) const
{
  const int dim = domain->dimension, n = divisions(s);
  const int total = dim == 2 ? n * n : n * n * n;
  for (int part = 0; part < total; part++) {
    const int k[3] = {part % n, part / n % n, part / n / n};
    double x[3];
    for (int d = 0; d < 3; d++)
      x[d] = position(d, s[d]) + (d < dim ? ((k[d] + 0.5) / n - 0.5) * spacing[d] : 0.0);
    if (!(fix && fix->options.axisymmetric && x[0] < 0.0) &&
        (!region || region->match(x[0], x[1], x[2])))
      visit(x);
  }
  return total;
}

/** The fix mpm whose lattice is used when the input does not name one. */
void CreatePoints::find_lattice()
{
  if (fix) return;
  for (auto *other : MPMField::all(lmp)) {
    if (!fix) fix = other;
    bool same = other->lattice.h == fix->lattice.h;
    for (int d = 0; d < domain->dimension; d++)
      same = same && other->lattice.origin[d] == fix->lattice.origin[d];
    if (!same)
      error->all(FLERR, Error::NOPOINTER,
                 "Fixes mpm {} and {} have different lattices: say with "
                 "create_points keyword fix which one is meant",
                 fix->id(), other->id());
  }
}

/** Finds the sites in the box and those that can be in the region. The box is half open, as a point
 *  on an upper face would belong to no rank. On a periodic axis exactly one image of each site is
 *  in the range, also when rounding decides on which side of the box it is (positions are wrapped
 *  later). */
void CreatePoints::find_ranges()
{
  std::array<double, 3> lo, hi;
  lo.fill(-10.0 * INFINITE);
  hi.fill(10.0 * INFINITE);
  if (region && region->bboxflag && !region->dynamic && !region->varshape) {
    lo = {region->extent_xlo, region->extent_ylo, region->extent_zlo};
    hi = {region->extent_xhi, region->extent_yhi, region->extent_zhi};
  }
  for (int d = 0; d < domain->dimension && image; d++) {
    // a site whose center is beyond a surface may still contain a part of the body
    const double more = image->surface ? 0.5 * spacing[d] : 0.0;
    lo[d] = std::max(lo[d], image->lo[d] - more);
    hi[d] = std::min(hi[d], image->hi(d) + more);
  }
  // only the half with x >= 0 of a body on the axis
  if (fix && fix->options.axisymmetric && lo[0] > -INFINITE) lo[0] = std::max(lo[0], 0.0);

  for (int d = 0; d < domain->dimension; d++) {
    const double boxlo = domain->boxlo[d], boxhi = domain->boxhi[d];
    // also cells whose center is outside the region
    const double beyond = cut || split_variable >= 0 ? 0.5 * spacing[d] : 0.0;
    const bool periodic = domain->periodicity[d];

    // site number, rounded up; a site within the tolerance below counts as being there

    auto first_from = [&](double x) {
      const double s = (x - origin[d]) / spacing[d] - 0.5;
      if (!(fabs(s) < MAX_INDEX))
        error->all(FLERR, Error::NOLASTLINE,
                   "Create_points spacing {:.8g} is too fine for this box or region", spacing[d]);
      return (bigint) ceil(s - TOLERANCE);
    };

    bigint first = first_from(boxlo), end = first_from(boxhi);
    if (periodic) {
      const double nsite = domain->prd[d] / spacing[d];
      if (fabs(nsite - round(nsite)) < TOLERANCE * 10.0) {
        end = first + (bigint) round(nsite);
      } else if (lo[d] < position(d, first) && hi[d] > position(d, end - 1) && comm->me == 0) {
        error->warning(FLERR,
                       "Create_points spacing {:.8g} does not divide the length {:.8g} of the box "
                       "along periodic axis {}: points across the boundary are not at this spacing",
                       spacing[d], domain->prd[d], "xyz"[d]);
      }
    } else {
      while (position(d, first) < boxlo) first++;
      while (position(d, end) < boxhi) end++;
    }
    box[d] = {first, std::max(end - first, (bigint) 0)};

    if (lo[d] > -INFINITE) first = first_from(lo[d] - beyond);
    if (hi[d] < INFINITE) end = first_from(hi[d] + beyond + 2.0 * TOLERANCE * spacing[d]);
    search[d] = {first, std::max(end - first, (bigint) 0)};
  }
}

/** Share of the volume of a site that its point gets; 0: no point. */
double CreatePoints::volume_fraction(const bigint *s) const
{
  if (!taken.empty() && taken.count({s[0], s[1], s[2]})) return 0.0;
  if (region_cut) return region_cut->inside(s).share;
  if (split_variable >= 0) {
    int inside = 0;
    const int all = for_parts(s, [&](const double *) {
      inside++;
    });
    return (double) inside / all;
  }
  double x[3] = {position(0, s[0]), position(1, s[1]), position(2, s[2])};
  if (region && !region->match(x[0], x[1], x[2])) return 0.0;
  if (!image) return 1.0;
  return image->surface ? surface_share(s) : image->type_at(x) > 0;
}

/** The point of a cell that the surface of the region may cut, if there is one. Where cells reach
 *  across the face of a box that is not periodic, the center may be beyond it. */
bool CreatePoints::cut_site(const bigint *s, Site &site) const
{
  const auto part = region_cut->point(s, [this](const bigint *other) {
    return in_box(other) && search[0].contains(other[0]) && search[1].contains(other[1]) &&
        search[2].contains(other[2]);
  });
  if (part.share == 0.0) return false;
  site = {{part.x[0], part.x[1], part.x[2]}, part.share * volume, 0};
  for (int d = 0; d < domain->dimension; d++)
    if (!domain->periodicity[d] && !(site.x[d] >= domain->boxlo[d] && site.x[d] < domain->boxhi[d]))
      site.x[d] = position(d, s[d]);
  domain->remap(site.x);
  return true;
}

/** Visits the sites first to last-1 of a range, x fastest. */
void CreatePoints::for_sites(const Range *range, bigint first, bigint last,
                             const std::function<void(const bigint *s)> &visit) const
{
  if (first >= last) return;
  bigint k[3] = {first % range[0].n, first / range[0].n % range[1].n,
                 first / range[0].n / range[1].n};
  for (bigint n = first; n < last; n++) {
    const bigint s[3] = {range[0].first + k[0], range[1].first + k[1], range[2].first + k[2]};
    visit(s);
    k[0]++;
    for (int d = 0; d < 2 && k[d] == range[d].n; d++) {
      k[d] = 0;
      k[d + 1]++;
    }
  }
}

/** Can sites be counted that may be in the region, also outside of the box? */
bool CreatePoints::is_countable() const
{
  return (double) search[0].n * search[1].n * search[2].n / comm->nprocs < MAX_COUNT;
}

/** Keyword cut: of a region much larger than the box, only the part in the box matters. */
void CreatePoints::begin_cut()
{
  bigint first[3], last[3];
  for (int d = 0; d < 3; d++) {
    const Range &range = is_countable() ? search[d] : box[d];
    first[d] = range.first - 1;
    last[d] = range.end();
  }
  region_cut = std::make_unique<MPMRegionCut>(lmp, region, origin, spacing,
                                              fix && fix->options.axisymmetric, first, last);
}

/** Refuses, or reports, parts of the region outside the box. */
void CreatePoints::check_outside()
{
  bool exceeds = false, empty = false;
  for (int d = 0; d < domain->dimension; d++) {
    exceeds = exceeds || search[d].first < box[d].first || search[d].end() > box[d].end();
    empty = empty || search[d].n == 0;
  }
  if (!exceeds || empty) return;

  const std::string what = image ? "image" : fmt::format("region {}", region->id);
  std::string count = "an unknown number of";
  if (is_countable()) {
    const bigint n = search[0].n * search[1].n * search[2].n;
    bigint mine = 0, all = 0;
    for_sites(search, n * comm->me / comm->nprocs, n * (comm->me + 1) / comm->nprocs,
              [&](const bigint *s) {
                mine += !in_box(s) && in_region(s);
              });
    MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
    if (all == 0) return;
    count = std::to_string(all);
  }

  if (!ignore_outside)
    error->all(FLERR, Error::NOLASTLINE,
               "Create_points {} reaches beyond the simulation box: {} points would be "
               "outside; enlarge the box, cut the {}, or use create_points keyword outside "
               "ignore",
               what, count, image ? "image" : "region");
  if (comm->me == 0)
    utils::logmesg(lmp, "Create_points leaves out {} points of {} outside the box\n", count, what);
}

/** Refuses, or reports, new points close to existing material points. An existing point is closer
 *  than half a spacing along all axes to one site only, that of the cell of the site lattice
 *  that it is in: no other points need to be looked at. A body whose points have a share of the
 *  volume is meant to be in the same place as one in another field. */
/** Does atom i belong to the body of the new points? It does if it is in a field that they are in
 *  or, where they are in no field yet, if it has their type. */
bool CreatePoints::same_body(int i) const
{
  const int bits = group_bits | 1;    // 1: all
  bool in_field = false;
  for (const auto *field : MPMField::all(lmp)) {
    if (!(bits & field->fix.groupbit)) continue;
    in_field = true;
    if (atom->mask[i] & field->fix.groupbit) return true;
  }
  return !in_field && atom->type[i] == type;
}

/** Is x in the region, and not on its surface? Regions that touch have their common surface
 *  both. */
bool CreatePoints::is_inside(const double *x) const
{
  if (!region) return true;
  for (int d = 0; d < domain->dimension; d++)
    for (const double side : {-1.0, 1.0}) {
      double place[3] = {x[0], x[1], x[2]};
      place[d] += side * TOLERANCE * spacing[d];
      if (!region->match(place[0], place[1], place[2])) return false;
    }
  return true;
}

void CreatePoints::check_overlap()
{
  const int dim = domain->dimension;
  double **x = atom->x;
  std::vector<std::array<bigint, 3>> of_others;
  bigint mine[2] = {0, -MAXTAGINT}, all[2], apart = 0, all_apart;

  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->vfrac[i] > 0.0)) continue;
    const bool same = same_body(i);
    if (share < 1.0 && !same) continue;
    bigint s[3] = {0, 0, 0};
    for (int d = 0; d < dim; d++) {
      s[d] = (bigint) floor((x[i][d] - origin[d]) / spacing[d]);
      if (domain->periodicity[d] && box[d].n > 0) {
        if (s[d] < box[d].first) s[d] += box[d].n;
        if (s[d] >= box[d].end()) s[d] -= box[d].n;
      }
    }
    // the rest of a cut cell may belong to another body
    if (!in_box(s) || !in_region(s)) continue;
    if ((cut || split_variable >= 0) && region && !region->match(x[i][0], x[i][1], x[i][2]))
      continue;
    if (!is_inside(x[i])) {    // bodies that touch do not overlap
      double apart = 0.0;
      for (int d = 0; d < dim; d++) {
        double r = x[i][d] - position(d, s[d]);
        if (domain->periodicity[d]) r -= domain->prd[d] * std::round(r / domain->prd[d]);
        apart = std::max(apart, fabs(r) / spacing[d]);
      }
      if (apart < 10.0 * TOLERANCE) of_others.push_back({s[0], s[1], s[2]});
      continue;
    }
    mine[0]++;
    apart += !same;
    mine[1] = std::max(mine[1], -(bigint) atom->tag[i]);
  }
  for (const auto &site : gather_on_all(of_others, world)) taken.insert(site);
  if (!taken.empty() && comm->me == 0)
    utils::logmesg(lmp,
                   "Create_points leaves out {} points on the surface of region {}, where other "
                   "bodies have points\n",
                   taken.size(), region->id);
  MPI_Allreduce(&mine[0], &all[0], 1, MPI_LMP_BIGINT, MPI_SUM, world);
  MPI_Allreduce(&mine[1], &all[1], 1, MPI_LMP_BIGINT, MPI_MAX, world);
  if (all[0] == 0) return;
  MPI_Allreduce(&apart, &all_apart, 1, MPI_LMP_BIGINT, MPI_SUM, world);

  const auto message = fmt::format("{} existing material point{} (the first has ID {}) closer than "
                                   "half a spacing to new points",
                                   all[0], all[0] > 1 ? "s are" : " is", -all[1]);
  if (!allow_overlap)
    error->all(FLERR, Error::NOLASTLINE,
               "Create_points refuses overlapping bodies: {}; change the "
               "region, delete the old points first, or use create_points keyword overlap yes{}",
               message,
               all_apart ? "; of a soil and the water in its pores make the soil first, and the "
                           "water with keyword share"
                         : "");
  if (comm->me == 0) utils::logmesg(lmp, "Create_points makes overlapping bodies: {}\n", message);
}

/** Position of the point of a site: the site's, displaced by jitter, inside the box. The random
 *  number comes from the site and the seed alone. */
void CreatePoints::point_position(const bigint *s, double *x) const
{
  for (int d = 0; d < 3; d++) {
    x[d] = position(d, s[d]);
    if (jitter == 0.0 || d >= domain->dimension) continue;
    uint64_t h = mix_bits((uint64_t) seed * 4 + d + RANDOM_STEP);
    for (int k = 0; k < 3; k++) h = mix_bits((h ^ (uint64_t) s[k]) + RANDOM_STEP);
    const double u = (h >> 11) * 0x1.0p-53;
    const double move = (2.0 * u - 1.0) * jitter * spacing[d];
    for (double xnew : {x[d] + move, x[d] - move})
      if (domain->periodicity[d] || (xnew >= domain->boxlo[d] && xnew < domain->boxhi[d])) {
        x[d] = xnew;
        break;
      }
  }
  domain->remap(x);
}

/** Sites that are in the box and can be in the region; returns how many there are. */
bigint CreatePoints::ranges_in_box(Range *range) const
{
  double nsite = 1.0;
  for (int d = 0; d < 3; d++) {
    const bigint first = std::max(search[d].first, box[d].first);
    const bigint end = std::min(search[d].end(), box[d].end());
    range[d] = {first, std::max(end - first, (bigint) 0)};
    nsite *= range[d].n;
  }
  if (nsite > MAX_SITES * comm->nprocs)
    error->all(FLERR, Error::NOLASTLINE,
               "Create_points would have to look at {:.3g} sites: use a "
               "wider spacing, a smaller region, or one with a bounding box",
               nsite);
  return range[0].n * range[1].n * range[2].n;
}

/** Makes the points of a divided site. */
void CreatePoints::make_parts(const bigint *s, std::vector<Site> &made) const
{
  const std::size_t first = made.size();
  const int all = for_parts(s, [&](const double *x) {
    made.push_back({{x[0], x[1], x[2]}, 0.0, 0});
    for (int d = 0; d < domain->dimension; d++)
      if (!domain->periodicity[d] && !(x[d] >= domain->boxlo[d] && x[d] < domain->boxhi[d])) {
        made.pop_back();
        beyond_box++;
        return;
      }
    domain->remap(made.back().x);
  });
  for (auto k = first; k < made.size(); k++) made[k].volume = volume / all;
}
