/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "loads/mpm_inlet.h"

#include "base/mpm_image.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "math/matrix.h"
#include "math_const.h"
#include "region.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// samples along an edge of the section, for its area, which is then known to 1e-5 for a circle
static constexpr int AREA_SAMPLES = 1000;

static constexpr double WRONG_AREA = 0.02;    // share by which a known one may be off

// samples along its edges and the flow, which tell whether all sections are the same, and share of
// those that may differ: those next to curved faces, where round-off decides
static constexpr int PRISM_SAMPLES = 40, PRISM_SECTIONS = 9;
static constexpr double MOST_DIFFERENT = 0.01;
static constexpr int MARCH = 2000;    // steps that look for the surface
static constexpr double EDGE =
    1.0e-9;    // lengths, relative to that of the inlet, that are round-off
static constexpr double INFINITE = 1.0e19;    // bounds of regions beyond it are INF
static constexpr double MOST_COLUMNS = 1.0e7;

MPMInlet::MPMInlet(LAMMPS *lmp, const std::string &user, Region *inlet, const double *direction,
                   double spacing, double known_area, bool axisymmetric) :
    Pointers(lmp),
    region(inlet)
{
  const int dim = domain->dimension;
  const std::string name = user + " region " + region->id;
  const double size = std::sqrt(dot(direction, direction));
  for (int d = 0; d < 3; d++) normal[d] = direction[d] / size;
  if (axisymmetric && std::fabs(normal[0]) > EDGE)
    error->all(FLERR, Error::NOLASTLINE,
               "{}: around an axis of symmetry the flow must be along y, as a section of one along "
               "x would change",
               user);

  if (!region->bboxflag)
    error->all(FLERR, Error::NOLASTLINE, "{} must be bounded: use block, cylinder, or intersect",
               name);
  const double low[3] = {region->extent_xlo, region->extent_ylo, region->extent_zlo};
  const double high[3] = {region->extent_xhi, region->extent_yhi, region->extent_zhi};
  double diagonal = 0.0;
  for (int d = 0; d < 3; d++) {
    center[d] = d < dim ? 0.5 * (low[d] + high[d]) : 0.0;
    if (d < dim && !(std::fabs(low[d]) < INFINITE && std::fabs(high[d]) < INFINITE))
      error->all(FLERR, Error::NOLASTLINE, "{} must be bounded along {}", name, (char) ('x' + d));
    if (d < dim) diagonal += (high[d] - low[d]) * (high[d] - low[d]);
  }
  diagonal = std::sqrt(diagonal);
  if (axisymmetric) center[0] = 0.5 * (std::max(low[0], 0.0) + high[0]);
  if (!inside(center))
    error->all(FLERR, Error::NOLASTLINE, "{} must have its middle, {:.6g} {:.6g} {:.6g}, inside",
               name, center[0], center[1], center[2]);

  choose_axes();
  const auto middle_between = [&](const double *axis) {
    double back[3];
    for (int d = 0; d < 3; d++) back[d] = -axis[d];
    const double forth_length = reach_of(axis, diagonal);
    double back_length = reach_of(back, diagonal);
    if (axisymmetric && std::fabs(axis[0]) > 0.5)
      back_length = std::min(back_length, center[0]);    // to the axis of symmetry
    for (int d = 0; d < 3; d++) center[d] += 0.5 * (forth_length - back_length) * axis[d];
    return forth_length + back_length;
  };
  length = middle_between(normal);
  for (int k = 0; k < dim - 1; k++) width[k] = middle_between(across[k]);

  const bool rectangle = find_section(name, low, high);
  check_prism(name);

  double n[2] = {1.0, 1.0}, step[2] = {0.0, 0.0};
  for (int k = 0; k < dim - 1; k++) {
    n[k] = std::max(1.0, std::round(width[k] / spacing));
    step[k] = width[k] / n[k];
  }
  if (!(n[0] * n[1] < MOST_COLUMNS))
    error->all(FLERR, Error::NOLASTLINE, "{} has {:.4g} points across: use a larger spacing", name,
               n[0] * n[1]);
  for (int i = 0; i < (int) n[0]; i++)
    for (int j = 0; j < (int) n[1]; j++) {
      const double a = (i + 0.5 - 0.5 * n[0]) * step[0], b = (j + 0.5 - 0.5 * n[1]) * step[1];
      if (!rectangle && !inside(0.0, a, b)) continue;
      Column column;
      for (int d = 0; d < 3; d++)
        column.x[d] = center[d] - 0.5 * length * normal[d] + a * across[0][d] + b * across[1][d];
      columns.push_back(column);
    }
  if (columns.empty())
    error->all(FLERR, Error::NOLASTLINE, "{} has no point across: use a smaller spacing", name);
  if (known_area > 0.0) {
    double whole = area;    // around an axis that of the annulus
    if (axisymmetric) {
      whole = 0.0;
      for (const auto &column : columns)
        whole += MathConst::MY_2PI * column.x[0] * area / (double) columns.size();
    }
    if (std::fabs(known_area / whole - 1.0) > WRONG_AREA && comm->me == 0)
      error->warning(FLERR,
                     "{} has an area of {:.5g} across the flow, and {:.5g} is given: density and "
                     "pressure of what comes will be wrong",
                     name, whole, known_area);
    area *= known_area / whole;
  }
  for (auto &column : columns) column.area = area / (double) columns.size();
}

bool MPMInlet::inside(const double *x) const
{
  return region->match(x[0], x[1], domain->dimension == 2 ? 0.0 : x[2]);
}

/** At coordinates from the center. */
bool MPMInlet::inside(double along, double a, double b) const
{
  double x[3];
  for (int d = 0; d < 3; d++)
    x[d] = center[d] + along * normal[d] + a * across[0][d] + b * across[1][d];
  return inside(x);
}

/** Distance of the surface from the center in this direction. */
double MPMInlet::reach_of(const double *direction, double most) const
{
  const auto inside_at = [&](double s) {
    const double x[3] = {center[0] + s * direction[0], center[1] + s * direction[1],
                         center[2] + s * direction[2]};
    return inside(x);
  };
  int k = 1;
  while (k <= MARCH && inside_at(most * k / MARCH)) k++;
  double in = most * (k - 1) / MARCH, out = most * k / MARCH;
  for (int pass = 0; pass < 60; pass++) {
    const double half = 0.5 * (in + out);
    (inside_at(half) ? in : out) = half;
  }
  return 0.5 * (in + out);
}

/** Axes of the box, where the flow is along one of them. */
void MPMInlet::choose_axes()
{
  for (auto &axis : across) std::fill_n(axis, 3, 0.0);
  if (domain->dimension == 2) {
    const double sign = normal[0] > normal[1] ? 1.0 : -1.0;
    across[0][0] = -sign * normal[1];
    across[0][1] = sign * normal[0];
    return;
  }
  int most = 0;
  for (int d = 1; d < 3; d++)
    if (std::fabs(normal[d]) > std::fabs(normal[most])) most = d;
  // the next axis of the box, less its part along the flow
  const int next = (most + 1) % 3;
  double size = 0.0;
  for (int d = 0; d < 3; d++) {
    across[0][d] = (d == next ? 1.0 : 0.0) - normal[next] * normal[d];
    size += across[0][d] * across[0][d];
  }
  for (double &a : across[0]) a /= std::sqrt(size);
  for (int d = 0; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    across[1][d] = normal[e] * across[0][f] - normal[f] * across[0][e];
  }
}

/** Area of the section in the middle, and its extent along both axes: is it all of the rectangle of
 *  these? */
bool MPMInlet::find_section(const std::string &user, const double *low, const double *high)
{
  if (domain->dimension == 2) {
    area = width[0];
    return true;
  }
  // the whole section, which may be wider than on the lines through the center
  double first[2] = {0.0, 0.0}, last[2] = {0.0, 0.0};
  for (int corner = 0; corner < 8; corner++)
    for (int k = 0; k < 2; k++) {
      double s = 0.0;
      for (int d = 0; d < 3; d++)
        s += ((corner >> d & 1 ? high[d] : low[d]) - center[d]) * across[k][d];
      first[k] = std::min(first[k], s);
      last[k] = std::max(last[k], s);
    }
  constexpr int n = AREA_SAMPLES;
  const double cell[2] = {(last[0] - first[0]) / n, (last[1] - first[1]) / n};
  bigint found = 0, in_rectangle = 0, of_rectangle = 0;
  double reach[2][2] = {{0.0, 0.0}, {0.0, 0.0}};
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      const double s[2] = {first[0] + (i + 0.5) * cell[0], first[1] + (j + 0.5) * cell[1]};
      const bool in = inside(0.0, s[0], s[1]);
      const bool near = std::fabs(s[0]) < 0.5 * width[0] && std::fabs(s[1]) < 0.5 * width[1];
      found += in;
      of_rectangle += near;
      in_rectangle += near && in;
      for (int k = 0; k < 2 && in; k++) {
        reach[k][0] = std::min(reach[k][0], s[k] - 0.5 * cell[k]);
        reach[k][1] = std::max(reach[k][1], s[k] + 0.5 * cell[k]);
      }
    }
  if (found == 0) error->all(FLERR, Error::NOLASTLINE, "{} has no section", user);
  if (in_rectangle == of_rectangle && found == in_rectangle) {
    area = width[0] * width[1];
    return true;
  }
  area = (double) found * cell[0] * cell[1];
  double shift[2];
  for (int k = 0; k < 2; k++) {
    shift[k] = 0.5 * (reach[k][0] + reach[k][1]);
    width[k] = std::max(width[k], reach[k][1] - reach[k][0]);
  }
  for (int d = 0; d < 3; d++) center[d] += shift[0] * across[0][d] + shift[1] * across[1][d];
  return false;
}

/** All sections must be the same, or else points would leave the inlet through its sides, or not
 *  fill it. */
void MPMInlet::check_prism(const std::string &user) const
{
  const int second = domain->dimension == 3 ? PRISM_SAMPLES : 1;
  bigint n = 0, different = 0;
  for (int k = 0; k < PRISM_SECTIONS; k++)
    for (int i = 0; i < PRISM_SAMPLES; i++)
      for (int j = 0; j < second; j++) {
        const double along = (k + 0.5) / PRISM_SECTIONS - 0.5;
        const double a = 1.2 * ((i + 0.5) / PRISM_SAMPLES - 0.5),
                     b = second > 1 ? 1.2 * ((j + 0.5) / second - 0.5) : 0.0;
        n++;
        different += inside(along * length, a * width[0], b * width[1]) !=
            inside(0.0, a * width[0], b * width[1]);
      }
  if (different > MOST_DIFFERENT * n)
    error->all(
        FLERR, Error::NOLASTLINE,
        "{} must be a straight piece of a pipe along the flow {:.6g} {:.6g} {:.6g}, but its "
        "sections differ: use a block or cylinder along the flow, or cut one by planes (region "
        "intersect)",
        user, normal[0], normal[1], normal[2]);
}

bool MPMInlet::holds(const double *x, double reach) const
{
  double r[3] = {x[0] - center[0], x[1] - center[1],
                 domain->dimension == 2 ? 0.0 : x[2] - center[2]};
  nearest_image(*domain, r);
  const double along = dot(r, normal);
  if (along > (0.5 + EDGE) * length || along < -0.5 * length - reach) return false;
  for (int k = 0; k < domain->dimension - 1; k++)
    if (std::fabs(dot(r, across[k])) > 0.5 * width[k] + reach) return false;
  return true;
}

bool MPMInlet::is_near(const double *from_middle, double distance) const
{
  double r[3] = {from_middle[0], from_middle[1], from_middle[2]};
  nearest_image(*domain, r);
  const double radius =
      0.5 * std::sqrt(length * length + width[0] * width[0] + width[1] * width[1]);
  return dot(r, r) < (radius + distance) * (radius + distance);
}
