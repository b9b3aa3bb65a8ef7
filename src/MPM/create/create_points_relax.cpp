/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// create_points ... relax N: points that follow the surface of a region, with equal volumes.
// Samples of the body are spread over the ranks, in integers, so that all of them find the same
// points.

#include "create/create_points.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "mesh/relaxed_points.h"
#include "region.h"
#include "transfer/shape.h"
#include "walls/mpm_region_cut.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int SAMPLES_2D = 16, SAMPLES_3D = 8;    // samples along each axis of a site
static constexpr int MOST_PARTS = 16;                    // of a divided site, along each axis
static constexpr double ENOUGH = 0.5;    // share of a site inside, for a point to start there
static constexpr double SAME = 1.0e-5;
static constexpr int64_t MOST_POINTS = 100000000;

/** Samples of the part of a site that is in the region. */
void CreatePoints::add_relaxed_site(const bigint *s, const bigint *first,
                                    RelaxedPoints &relaxed) const
{
  const int dim = domain->dimension;
  const auto part = region_cut->inside(s);
  if (part.share == 0.0) return;
  const int parts = split_variable >= 0 ? divisions(s) : 1;
  if (parts > MOST_PARTS)
    error->one(FLERR, Error::NOLASTLINE,
               "Create_points relax: a site is divided by {} along each axis, at most {} are "
               "possible: use a finer spacing with fewer divisions",
               parts, MOST_PARTS);
  const int m = parts * (dim == 2 ? SAMPLES_2D : SAMPLES_3D);
  const RelaxedPoints::Place at = {s[0] - first[0], s[1] - first[1], s[2] - first[2]};
  RelaxedPoints::Place move = {0, 0, 0};
  bool beyond = false;    // does the site reach beyond the box?
  for (int d = 0; d < dim; d++)
    beyond = beyond ||
        (!domain->periodicity[d] &&
         (position(d, s[d]) - 0.5 * spacing[d] < domain->boxlo[d] - SAME * spacing[d] ||
          position(d, s[d]) + 0.5 * spacing[d] > domain->boxhi[d] + SAME * spacing[d]));
  if (part.share == 1.0 && !beyond) {
    relaxed.add_site(at, m, {}, RelaxedPoints::SITE, move);
    return;
  }

  const auto place = [&](const int *k, int d) {
    const double u = (double) RelaxedPoints::sample(dim, m, k, d) / RelaxedPoints::UNIT;
    return position(d, s[d]) + (u - 0.5) * spacing[d];
  };
  const int count = dim == 2 ? m * m : m * m * m;
  std::vector<char> marks(count, 0);
  int inside = 0;
  double sum[3] = {0.0, 0.0, 0.0};
  for (int c = 0; c < count; c++) {
    const int k[3] = {c % m, c / m % m, c / m / m};
    double x[3] = {0.0, 0.0, 0.0};
    bool there = true;
    for (int d = 0; d < dim; d++) {
      x[d] = place(k, d);
      there = there &&
          (domain->periodicity[d] || (x[d] >= domain->boxlo[d] && x[d] < domain->boxhi[d]));
    }
    there = there && !(fix && fix->options.axisymmetric && x[0] < 0.0) &&
        region->match(x[0], x[1], x[2]);
    if (!there) continue;
    marks[c] = 1;
    inside++;
    for (int d = 0; d < dim; d++) sum[d] += x[d];
  }

  // together, the samples have the volume and the center of the part

  double share = beyond ? (double) inside / count : part.share;
  if (inside == 0) {
    if (beyond) return;
    int k[3] = {0, 0, 0};
    for (int d = 0; d < dim; d++) {
      const double u = (part.x[d] - position(d, s[d])) / spacing[d] + 0.5;
      k[d] = std::clamp((int) (u * m), 0, m - 1);
    }
    for (int d = 0; d < dim; d++) sum[d] = place(k, d);
    marks[k[0] + m * (k[1] + m * k[2])] = 1;
    inside = 1;
  }
  for (int d = 0; d < dim && !beyond; d++)
    move[d] = std::llround((part.x[d] - sum[d] / inside) / spacing[d] * RelaxedPoints::UNIT);
  const int64_t volume = std::llround(share * RelaxedPoints::SITE);
  if (volume >= inside) relaxed.add_site(at, m, marks, volume, move);
}

/** Points start where most of a site is inside, and are relaxed; returns their number. */
bigint CreatePoints::make_relaxed_points()
{
  Range range[3];
  const bigint nsite = ranges_in_box(range);
  const int dim = domain->dimension;
  RelaxedPoints::Place n = {1, 1, 1};
  std::array<bool, 3> periodic = {false, false, false};
  bigint begin[3] = {0, 0, 0};
  for (int d = 0; d < dim; d++) {
    periodic[d] = domain->periodicity[d];
    const Range &all = periodic[d] ? box[d] : range[d];
    if (periodic[d] && std::fabs(all.n * spacing[d] - domain->prd[d]) > SAME * spacing[d])
      error->all(FLERR, Error::NOLASTLINE,
                 "Create_points relax: spacing {:.8g} does not divide the length {:.8g} of the box "
                 "along periodic axis {}: choose one that does",
                 spacing[d], domain->prd[d], "xyz"[d]);
    n[d] = all.n;
    begin[d] = all.first;
    if (n[d] > RelaxedPoints::MOST_SITES)
      error->all(FLERR, Error::NOLASTLINE,
                 "Create_points relax: {} sites along {} are too many: use a wider spacing, or "
                 "keyword cut in place of relax",
                 n[d], "xyz"[d]);
  }
  if (nsite == 0) return 0;
  if (fix && fix->options.shape == LINEAR && comm->me == 0)
    error->warning(FLERR,
                   "Create_points relax: points come to be next to faces of cells, where nodes "
                   "beyond have next to no mass, with which shape linear of fix {} can become "
                   "unstable: use shape quadratic, or keyword cut in place of relax",
                   fix->id());
  RelaxedPoints relaxed(dim, n, periodic);

  const bigint first = nsite * comm->me / comm->nprocs,
               last = nsite * (comm->me + 1) / comm->nprocs;
  std::vector<double> mine;    // positions in units of sites, and shares of the volume
  for_sites(range, first, last, [&](const bigint *s) {
    const auto add = [&](const double *x, double share) {
      for (int d = 0; d < 3; d++)
        mine.push_back(d < dim ? (x[d] - origin[d]) / spacing[d] - (double) begin[d] : 0.0);
      mine.push_back(share);
    };
    if (split_variable >= 0) {
      const std::size_t before = mine.size();
      const int all = for_parts(s, [&](const double *x) {
        add(x, 0.0);
      });
      for (auto k = before; k < mine.size(); k += 4) mine[k + 3] = 1.0 / all;
    } else {
      const auto part = region_cut->inside(s);
      if (part.share >= ENOUGH) add(part.x, 1.0);
    }
    add_relaxed_site(s, begin, relaxed);
  });

  // all ranks have all points, in the order of sites

  bigint count = mine.size(), all = 0;
  MPI_Allreduce(&count, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all / 4 > MOST_POINTS)
    error->all(FLERR, Error::NOLASTLINE,
               "Create_points relax: {} points are too many, as each process has all of them: use "
               "keyword cut in place of relax",
               all / 4);
  if (all == 0) return 0;
  int size = (int) count;
  std::vector<int> sizes(comm->nprocs), places(comm->nprocs, 0);
  MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, world);
  for (int p = 1; p < comm->nprocs; p++) places[p] = places[p - 1] + sizes[p - 1];
  std::vector<double> list(all);
  MPI_Allgatherv(mine.data(), size, MPI_DOUBLE, list.data(), sizes.data(), places.data(),
                 MPI_DOUBLE, world);
  for (bigint k = 0; k < all; k += 4) relaxed.add_point(&list[k], list[k + 3]);

  const bool reached = relaxed.relax(relax, [this](std::vector<int64_t> &values) {
    MPI_Allreduce(MPI_IN_PLACE, values.data(), (int) values.size(), MPI_INT64_T, MPI_SUM, world);
  });
  if (!reached)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Create_points relax: parts of region {} are too thin for points to begin there, and "
        "farther than {} spacings from all others: use a finer spacing",
        region->id, RelaxedPoints::REACH);
  if (comm->me == 0)
    utils::logmesg(lmp,
                   "Create_points relax: volumes within {:.2g} % of what they ought to be, last "
                   "moved by at most {:.2g} spacings\n",
                   100.0 * relaxed.scatter, relaxed.moved);

  const tagint maxtag = largest_tag();
  check_tags(maxtag, relaxed.size());
  if (comm->nprocs > 1) comm->coord2proc_setup();
  bigint npoints = 0;
  for (std::size_t k = 0; k < relaxed.size(); k++) {
    const double share = relaxed.volume(k);
    if (!(share > 0.0)) continue;
    npoints++;
    const auto place = relaxed.center(k);
    Site site = {{0.0, 0.0, 0.0}, share * volume, 0};
    for (int d = 0; d < dim; d++) {
      site.x[d] = origin[d] + (place[d] + (double) begin[d]) * spacing[d];
      if (!domain->periodicity[d])
        site.x[d] = std::clamp(site.x[d], domain->boxlo[d],
                               std::nextafter(domain->boxhi[d], domain->boxlo[d]));
    }
    domain->remap(site.x);
    site.tag = atom->tag_enable ? (tagint) (maxtag + npoints) : 0;
    if (owner(site.x) == comm->me) make_point(site);
  }
  return npoints;
}
