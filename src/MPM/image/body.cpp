/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "image/body.h"

#include <algorithm>
#include <cmath>

using namespace MPM_NS;

static constexpr double ROUND_OFF = 1.0e-6;    // in pixels
static constexpr double NO_VOLUME = 1.0e-9;    // share of a box that is round-off

int64_t ImageBody::pixel_at(const double *x) const
{
  for (int d = 0; d < dim; d++) {
    const double u = std::floor((x[d] - lo[d]) / pixel[d] + ROUND_OFF);
    if (!(u >= 0.0 && u < count(d))) return -1;
  }
  return nearest_pixel(x);
}

int64_t ImageBody::nearest_pixel(const double *x) const
{
  int64_t at[3] = {0, 0, 0};
  for (int d = 0; d < dim; d++) {
    const double u = std::floor((x[d] - lo[d]) / pixel[d] + ROUND_OFF);
    const auto k = (int64_t) std::min(std::max(u, 0.0), count(d) - 1.0);
    at[image_axis[d]] = against[d] ? count(d) - 1 - k : k;
  }
  return at[0] + image.n[0] * (at[1] + image.n[1] * at[2]);
}

int ImageBody::type_of(int64_t k) const
{
  for (const auto &c : colors)
    if (image.channels == 3 && image.number(k, 0) == c.color[0] &&
        image.number(k, 1) == c.color[1] && image.number(k, 2) == c.color[2])
      return c.type;
  if (steps.empty()) return 0;
  const double value = image.gray(k);
  if (below) return value < steps[0].from ? steps[0].type : 0;
  int type = 0;
  for (const auto &step : steps)
    if (value >= step.from) type = step.type;
  return type;
}

int ImageBody::type_at(const double *x) const
{
  const int64_t k = pixel_at(x);
  return k < 0 ? 0 : type_of(k);
}

void ImageBody::crop()
{
  int64_t first[3] = {image.n[0], image.n[1], image.n[2]}, last[3] = {-1, -1, -1}, at[3];
  for (at[2] = 0; at[2] < image.n[2]; at[2]++)
    for (at[1] = 0; at[1] < image.n[1]; at[1]++)
      for (at[0] = 0; at[0] < image.n[0]; at[0]++) {
        if (!type_of(at[0] + image.n[0] * (at[1] + image.n[1] * at[2]))) continue;
        for (int c = 0; c < 3; c++) {
          first[c] = std::min(first[c], at[c]);
          last[c] = std::max(last[c], at[c]);
        }
      }
  if (last[0] < 0) return;    // there are no bodies, which somebody else will say
  int64_t kept[3];
  for (int c = 0; c < 3; c++) kept[c] = last[c] + 1 - first[c];
  for (int d = 0; d < dim; d++) {
    const int c = image_axis[d];
    lo[d] += pixel[d] * (against[d] ? count(d) - 1 - last[c] : first[c]);
  }
  image.crop(first, kept);
}

void ImageBody::make_surface(double width, const bool *wraps)
{
  bool wrap[3] = {false, false, false};
  for (int d = 0; d < dim; d++) wrap[image_axis[d]] = wraps[d];
  const double from = steps[0].from;
  surface = std::make_unique<const LevelSet>(image.n, dim, wrap, width, [&](int64_t k) {
    return below ? from - image.gray(k) : image.gray(k) - from;
  });
}

double ImageBody::share_at(const double *x, const double *edges) const
{
  double a[3] = {0.0, 0.0, 0.0}, b[3] = {1.0, 1.0, 1.0}, volume = 1.0;
  for (int d = 0; d < dim; d++) {
    const int c = image_axis[d];
    a[c] = (x[d] - 0.5 * edges[d] - lo[d]) / pixel[d];
    b[c] = (x[d] + 0.5 * edges[d] - lo[d]) / pixel[d];
    volume *= b[c] - a[c];
    if (against[d]) {
      std::swap(a[c], b[c]);
      a[c] = count(d) - a[c];
      b[c] = count(d) - b[c];
    }
  }
  const double share = surface->volume(a, b) / volume;
  return share > NO_VOLUME ? std::min(share, 1.0) : 0.0;
}
