/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/mpm_region_cut.h"

#include "domain.h"
#include "error.h"
#include "math/random.h"
#include "mesh/cell_volumes.h"
#include "mesh/surface_mesh.h"
#include "region.h"
#include "walls/region_mpm_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <exception>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double ROUNDING = 1.0e-9;    // of the volume of a cell

/** Neighbors of a cell, those across a face first, then across an edge, then a corner. */
static std::vector<std::array<int, 3>> directions(int dim)
{
  std::vector<std::array<int, 3>> list;
  for (int apart = 1; apart <= dim; apart++)
    for (int k = -1; k <= 1; k++)
      for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
          if (std::abs(i) + std::abs(j) + std::abs(k) == apart && (dim == 3 || k == 0))
            list.push_back({i, j, k});
  return list;
}

MPMRegionCut::MPMRegionCut(LAMMPS *lmp, Region *region, const double *origin, const double *spacing,
                           bool axis, const bigint *first, const bigint *last) :
    Pointers(lmp),
    region(region), axis(axis), neighbors(directions(lmp->domain->dimension))
{
  std::copy_n(origin, 3, this->origin);
  std::copy_n(spacing, 3, this->spacing);
  const auto *mesh = dynamic_cast<RegMPMMesh *>(region);
  if (!mesh || domain->dimension == 2 || region->dynamic_check() || mesh->surface_mesh().overlaps ||
      mesh->surface_mesh().open)
    return;
  CellVolumes::Range ranges[3];
  for (int d = 0; d < 3; d++) ranges[d] = {first[d], last[d]};
  try {
    volumes = std::make_unique<CellVolumes>(mesh->surface_mesh().soup(), origin, spacing, ranges);
  } catch (const std::exception &problem) {
    error->all(FLERR, Error::NOLASTLINE, "Create_points cut, region {}: {}", region->id,
               problem.what());
  }
}

MPMRegionCut::~MPMRegionCut() = default;

bool MPMRegionCut::match(const double *x) const
{
  return !(axis && x[0] < 0.0) && region->match(x[0], x[1], x[2]);
}

MPMRegionCut::Part MPMRegionCut::whole(const bigint *s) const
{
  Part part;
  part.share = 1.0;
  for (int d = 0; d < 3; d++) part.x[d] = origin[d] + (s[d] + 0.5) * spacing[d];
  return part;
}

MPMRegionCut::Part MPMRegionCut::inside(const bigint *s)
{
  if (volumes) return exact(s);

  // corners, a little inward: faces of cells are often those of the region
  const int dim = domain->dimension;
  Part all = whole(s);
  bool some = match(all.x), every = some;
  for (int c = 0; c < 1 << dim; c++) {
    double x[3];
    for (int d = 0; d < 3; d++)
      x[d] = all.x[d] + (d < dim ? ((c >> d & 1) - 0.5) * (1.0 - 1.0e-6) * spacing[d] : 0.0);
    const bool there = match(x);
    some = some || there;
    every = every && there;
  }
  if (every) return all;
  if (!some) return Part();
  const auto [place, is_new] = tried.emplace(std::array<bigint, 3>{s[0], s[1], s[2]}, Part());
  if (is_new) place->second = try_places(s);
  return place->second;
}

MPMRegionCut::Part MPMRegionCut::exact(const bigint *s) const
{
  const auto sums = (*volumes)(s[0], s[1], s[2]);
  const double cell = spacing[0] * spacing[1] * spacing[2];
  Part part = whole(s);
  part.share = sums.volume / cell;
  double moment[3];
  for (int d = 0; d < 3; d++) moment[d] = sums.moment[d] / cell;
  if (!region->interior) {
    part.share = 1.0 - part.share;
    for (int d = 0; d < 3; d++) moment[d] = 0.5 * spacing[d] - moment[d];
  }
  if (part.share < ROUNDING) return Part();
  if (part.share > 1.0 - ROUNDING) return whole(s);
  for (int d = 0; d < 3; d++) {
    const double in_cell = std::clamp(moment[d] / part.share, 0.0, spacing[d]);
    part.x[d] = origin[d] + s[d] * spacing[d] + in_cell;
  }
  return part;
}

MPMRegionCut::Part MPMRegionCut::try_places(const bigint *s) const
{
  constexpr int TRIES = 1024;
  const int dim = domain->dimension;
  // the root of g^(d+1) = g + 1
  const double g = dim == 2 ? 1.32471795724474602596 : 1.22074408460575947536;
  double step[3], start[3], sum[3] = {0.0, 0.0, 0.0};
  for (int d = 0; d < dim; d++) {
    step[d] = std::pow(g, -(d + 1));
    uint64_t h = mix_bits((uint64_t) d + RANDOM_STEP);
    for (int k = 0; k < 3; k++) h = mix_bits((h ^ (uint64_t) s[k]) + RANDOM_STEP);
    start[d] = (h >> 11) * 0x1.0p-53;
  }
  int n = 0;
  for (int k = 0; k < TRIES; k++) {
    double x[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < dim; d++) {
      const double u = start[d] + k * step[d];
      x[d] = origin[d] + (s[d] + u - std::floor(u)) * spacing[d];
    }
    if (!match(x)) continue;
    n++;
    for (int d = 0; d < dim; d++) sum[d] += x[d];
  }
  Part part;
  part.share = (double) n / TRIES;
  for (int d = 0; d < 3; d++) part.x[d] = n && d < dim ? sum[d] / n : 0.0;
  return part;
}

/** Can what is in the cell be light? A center inside is as good as a large part, and costs less to
 *  find out. */
bool MPMRegionCut::may_be_light(const bigint *s) const
{
  return volumes || !match(whole(s).x);
}

/** The cell that the part of this one goes to, or the cell itself. */
MPMRegionCut::Index MPMRegionCut::receiver(const bigint *s, const Sites &among)
{
  const Index here = {s[0], s[1], s[2]};
  if (!may_be_light(s) || !among(s)) return here;
  const double share = inside(s).share;
  if (share >= LIGHT || share == 0.0) return here;
  Index to = here;
  double largest = 0.0;
  int apart = 0;
  for (const auto &step : neighbors) {
    const int n = std::abs(step[0]) + std::abs(step[1]) + std::abs(step[2]);
    if (n > apart && largest > 0.0) break;
    apart = n;
    const Index next = {s[0] + step[0], s[1] + step[1], s[2] + step[2]};
    if (!among(next.data())) continue;
    const double other = inside(next.data()).share;
    // those that differ by rounding are equal, and the first of them is taken
    if (other < LIGHT || other <= largest * (1.0 + ROUNDING)) continue;
    largest = other;
    to = next;
  }
  return to;
}

MPMRegionCut::Part MPMRegionCut::point(const bigint *s, const Sites &among)
{
  Part mine = inside(s);
  const Index here = {s[0], s[1], s[2]};
  if (mine.share == 0.0 || receiver(s, among) != here) return Part();
  if (mine.share < LIGHT) return mine;
  double moment[3] = {0.0, 0.0, 0.0};    // relative to the own part
  for (const auto &step : neighbors) {
    const Index next = {s[0] + step[0], s[1] + step[1], s[2] + step[2]};
    if (receiver(next.data(), among) != here) continue;
    const Part other = inside(next.data());
    mine.share += other.share;
    for (int d = 0; d < 3; d++) moment[d] += other.share * (other.x[d] - mine.x[d]);
  }
  for (int d = 0; d < 3; d++) mine.x[d] += moment[d] / mine.share;
  return mine;
}

// samples along each axis
static constexpr int SAMPLES_2D = 2000, SAMPLES_3D = 160;

static void box_of(const Region &region, double *lo, double *hi)
{
  lo[0] = region.extent_xlo;
  hi[0] = region.extent_xhi;
  lo[1] = region.extent_ylo;
  hi[1] = region.extent_yhi;
  lo[2] = region.extent_zlo;
  hi[2] = region.extent_zhi;
}

bool MPMRegionBody::is_bounded(const Region &region, int dim)
{
  constexpr double FAR = 1.0e19;    // infinite edges are at 1e20
  double lo[3], hi[3];
  box_of(region, lo, hi);
  bool is = region.bboxflag;
  for (int d = 0; d < dim; d++) is = is && lo[d] > -FAR && hi[d] < FAR && hi[d] > lo[d];
  return is;
}

MPMRegionBody::MPMRegionBody(Region &region, int dim)
{
  const int n = dim == 2 ? SAMPLES_2D : SAMPLES_3D;
  box_of(region, lo, hi);
  double step[3] = {1.0, 1.0, 1.0};
  for (int d = 0; d < dim; d++) step[d] = (hi[d] - lo[d]) / n;
  if (dim == 2) lo[2] = hi[2] = 0.0;
  const double piece = step[0] * step[1] * (dim == 3 ? step[2] : 1.0);

  // sums about the middle of the box
  double first[3] = {}, second[3][3] = {};
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      for (int k = 0; k < (dim == 3 ? n : 1); k++) {
        const int place[3] = {i, j, k};
        double x[3] = {0.0, 0.0, 0.0}, r[3] = {0.0, 0.0, 0.0};
        for (int d = 0; d < dim; d++) {
          r[d] = (place[d] + 0.5 - 0.5 * n) * step[d];
          x[d] = 0.5 * (lo[d] + hi[d]) + r[d];
        }
        if (!region.match(x[0], x[1], x[2])) continue;
        volume += piece;
        for (int d = 0; d < dim; d++) {
          first[d] += piece * r[d];
          for (int e = 0; e < dim; e++) second[d][e] += piece * r[d] * r[e];
        }
      }
  if (volume == 0.0) return;
  for (int d = 0; d < dim; d++) center[d] = 0.5 * (lo[d] + hi[d]) + first[d] / volume;
  double trace = 0.0;
  for (int d = 0; d < dim; d++) {
    for (int e = 0; e < dim; e++) second[d][e] -= first[d] * first[e] / volume;
    second[d][d] += volume * step[d] * step[d] / 12.0;    // of the piece that a sample stands for
    trace += second[d][d];
  }
  for (int d = 0; d < 3; d++)
    for (int e = 0; e < 3; e++) inertia[d][e] = (d == e ? trace : 0.0) - second[d][e];
}
