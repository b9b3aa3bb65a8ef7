/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/relaxed_points.h"

#include <algorithm>
#include <cmath>

using namespace MPM_NS;

void RelaxedPoints::add_point(const double *x, double share)
{
  Point point = {{0, 0, 0}, share};
  for (int d = 0; d < dim; d++) point.x[d] = std::llround(x[d] * UNIT);
  points.push_back(point);
  shares += share;
}

int64_t RelaxedPoints::sample(int dim, int m, const int *k, int d)
{
  int64_t at = 0, all = 1;
  for (int digit = 0; digit < dim; digit++) {
    const int next = k[(d + digit) % dim];
    // backward in every other part, so that places along two axes are not correlated
    at = at * m + (digit > 0 && k[d] % 2 ? m - 1 - next : next);
    all *= m;
  }
  return (2 * at + 1) * UNIT / (2 * all);
}

void RelaxedPoints::add_site(const Place &at, int m, const std::vector<char> &some, int64_t volume,
                             const Place &move)
{
  int64_t count = std::count(some.begin(), some.end(), 1);
  if (some.empty()) count = dim == 2 ? m * m : m * m * m;
  Site site = {{0, 0, 0}, m, volume / count, some.empty() ? ALL : marks.size()};
  for (int d = 0; d < dim; d++) site.corner[d] = at[d] * UNIT + move[d];
  marks.insert(marks.end(), some.begin(), some.end());
  sites.push_back(site);
}

/** Points in reach of a site. */
void RelaxedPoints::sort_points()
{
  order.clear();
  for (std::size_t k = 0; k < points.size(); k++) {
    int64_t at[3] = {0, 0, 0};
    for (int d = 0; d < dim; d++) {
      int64_t &x = points[k].x[d];
      if (periodic[d]) x -= n[d] * UNIT * (int64_t) std::floor((double) x / (double) (n[d] * UNIT));
      at[d] = std::clamp(x / UNIT, (int64_t) 0, n[d] - 1);
    }
    order.emplace_back((at[2] * n[1] + at[1]) * n[0] + at[0], (int) k);
  }
  std::sort(order.begin(), order.end());
}

/** Images of points in sites that are no farther away than so many sites along each axis. */
void RelaxedPoints::list_near(const Site &site, int reach, std::vector<Near> &near) const
{
  near.clear();
  int64_t at[3], image[3] = {0, 0, 0};
  for (int d = 0; d < 3; d++)
    at[d] = std::clamp((site.corner[d] + UNIT / 2) / UNIT, (int64_t) 0, n[d] - 1);
  // false: there is no such site
  const auto wrap = [&](int d, int64_t k, int64_t &s) {
    s = at[d] + k;
    image[d] = 0;
    if (s >= 0 && s < n[d]) return true;
    if (!periodic[d]) return false;
    const int64_t times = s >= 0 ? s / n[d] : -((n[d] - 1 - s) / n[d]);
    image[d] = times * n[d] * UNIT;
    s -= times * n[d];
    return true;
  };
  int64_t s[3];
  const int deep = dim == 3 ? reach : 0;
  for (int k = -deep; k <= deep; k++) {
    if (!wrap(2, k, s[2])) continue;
    for (int j = -reach; j <= reach; j++) {
      if (!wrap(1, j, s[1])) continue;
      for (int i = -reach; i <= reach; i++) {
        if (!wrap(0, i, s[0])) continue;
        const int64_t key = (s[2] * n[1] + s[1]) * n[0] + s[0];
        for (auto p = std::lower_bound(order.begin(), order.end(), std::make_pair(key, 0));
             p != order.end() && p->first == key; ++p) {
          const Point &point = points[p->second];
          near.push_back({p->second, point.x, point.weight});
          for (int d = 0; d < 3; d++) near.back().x[d] += image[d];
        }
      }
    }
  }
}

/** Until no point farther away can be nearest to any place of the site. */
bool RelaxedPoints::find_near(const Site &site, std::vector<Near> &near) const
{
  for (int reach = 2; reach <= REACH + 1; reach++) {
    list_near(site, reach, near);
    int64_t limit = INT64_MAX;
    for (const auto &one : near) {
      int64_t far = -one.weight;
      for (int d = 0; d < dim; d++) {
        const int64_t x = std::llabs(one.x[d] - site.corner[d] - UNIT / 2) + UNIT / 2;
        far += x * x;
      }
      limit = std::min(limit, far);
    }
    // half a site: that by which samples can be displaced
    const int64_t beyond = reach * UNIT - UNIT / 2;
    if (limit < beyond * beyond - most_weight) return true;
  }
  return false;
}

/** Samples to the points that they are nearest to: boxes of samples are halved until few points can
 *  be that of any of them. */
void RelaxedPoints::share_samples(const Site &site, const Box &box, const Near *begin,
                                  const Near *end)
{
  int64_t x[3] = {0, 0, 0};
  for (int k = box.lo[2]; k < box.hi[2]; k++)
    for (int j = box.lo[1]; j < box.hi[1]; j++)
      for (int i = box.lo[0]; i < box.hi[0]; i++) {
        if (site.marks != ALL && !marks[site.marks + i + site.m * (j + (std::size_t) site.m * k)])
          continue;
        const int at[3] = {i, j, k};
        for (int d = 0; d < dim; d++) x[d] = site.corner[d] + sample(dim, site.m, at, d);
        const Near *nearest = begin;
        int64_t least = INT64_MAX;
        for (const Near *one = begin; one < end; one++) {
          int64_t square = -one->weight;
          for (int d = 0; d < 3; d++) square += (x[d] - one->x[d]) * (x[d] - one->x[d]);
          if (square < least || (square == least && one->index < nearest->index)) {
            least = square;
            nearest = one;
          }
        }
        Point &point = points[nearest->index];
        point.volume += site.volume;
        for (int d = 0; d < 3; d++) point.moment[d] += site.volume * (x[d] - nearest->x[d]);
      }
}

void RelaxedPoints::share_box(const Site &site, const Box &box, std::vector<Near> &near,
                              std::size_t first)
{
  const std::size_t end = near.size();
  int64_t lo[3] = {0, 0, 0}, hi[3] = {0, 0, 0};
  int count = 1;
  for (int d = 0; d < dim; d++) {
    lo[d] = site.corner[d] + box.lo[d] * UNIT / site.m;
    hi[d] = site.corner[d] + box.hi[d] * UNIT / site.m + 1;
    count *= box.hi[d] - box.lo[d];
  }
  const auto reach = [&](const Near &one, bool farthest) {
    int64_t square = -one.weight;
    for (int d = 0; d < dim; d++) {
      const int64_t a = lo[d] - one.x[d], b = one.x[d] - hi[d];
      const int64_t x = farthest ? std::max(std::llabs(a), std::llabs(b))
                                 : std::max({(long long) a, (long long) b, 0LL});
      square += x * x;
    }
    return square;
  };
  int64_t limit = INT64_MAX;
  for (std::size_t k = first; k < end; k++) limit = std::min(limit, reach(near[k], true));
  for (std::size_t k = first; k < end; k++)
    if (reach(near[k], false) <= limit) near.push_back(Near(near[k]));

  if (near.size() - end == 1 || count <= 8) {
    share_samples(site, box, near.data() + end, near.data() + near.size());
  } else {
    int middle[3];
    for (int d = 0; d < 3; d++) middle[d] = (box.lo[d] + box.hi[d]) / 2;
    for (int part = 0; part < 8; part++) {
      Box half = box;
      bool empty = false;
      for (int d = 0; d < 3; d++) {
        (part >> d & 1 ? half.lo[d] : half.hi[d]) = middle[d];
        // of one sample there is an upper half alone
        empty = empty || half.lo[d] == half.hi[d];
      }
      if (!empty) share_box(site, half, near, end);
    }
  }
  near.resize(end);
}

/** Cells of all points, and their sums over all processes. */
void RelaxedPoints::find_cells(const Sum &sum)
{
  sort_points();
  most_weight = points[0].weight;
  for (auto &point : points) {
    most_weight = std::max(most_weight, point.weight);
    point.volume = 0;
    point.moment = {0, 0, 0};
  }
  std::vector<Near> near;
  for (const auto &site : sites) {
    if (find_near(site, near))
      share_box(site, {{0, 0, 0}, {site.m, site.m, dim == 3 ? site.m : 1}}, near, 0);
    else
      lost = true;
  }
  std::vector<int64_t> values;
  for (const auto &point : points) {
    values.push_back(point.volume);
    for (int d = 0; d < dim; d++) values.push_back(point.moment[d]);
  }
  values.push_back(lost);
  sum(values);
  const int64_t *value = values.data();
  for (auto &point : points) {
    point.volume = *value++;
    for (int d = 0; d < dim; d++) point.moment[d] = *value++;
  }
  lost = *value > 0;
}

bool RelaxedPoints::relax(int times, const Sum &sum)
{
  constexpr double RATE = 0.25;    // of the weights, stable for square, cubic, and closest packing
  constexpr int EVEN = 10;         // times at the end, in which only volumes become more equal
  const int last = times + EVEN;
  for (int time = 0; time <= last; time++) {
    find_cells(sum);
    if (lost) return false;
    double total = 0.0;
    for (const auto &point : points) total += (double) point.volume;
    scatter = 0.0;
    if (time < times) moved = 0.0;
    for (auto &point : points) {
      const double want = point.share / shares * total,
                   more = ((double) point.volume - want) / want;
      scatter = std::max(scatter, std::fabs(more));
      if (time == last) continue;
      point.weight -= std::llround(RATE * std::clamp(more, -1.0, 1.0) * UNIT * UNIT *
                                   std::pow(want / SITE, 2.0 / dim));
      if (time >= times || point.volume == 0) continue;
      double square = 0.0;
      for (int d = 0; d < dim; d++) {
        const double x = (double) point.moment[d] / (double) point.volume;
        point.x[d] += std::llround(x);
        square += x * x;
      }
      moved = std::max(moved, std::sqrt(square) / UNIT);
    }
  }
  return true;
}

std::array<double, 3> RelaxedPoints::center(std::size_t k) const
{
  std::array<double, 3> x = {0.0, 0.0, 0.0};
  const Point &point = points[k];
  for (int d = 0; d < dim; d++)
    x[d] = ((double) point.x[d] +
            (point.volume ? (double) point.moment[d] / (double) point.volume : 0.0)) /
        UNIT;
  return x;
}
