/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "diffusion/mpm_node_profile.h"

#include "field/mpm_field.h"
#include "field/mpm_stencil.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

MPMNodeProfile::MPMNodeProfile(const MPMField &field)
{
  const MPMStencil stencil(field);
  const bool bernstein = field.options.shape == MPM_NS::BERNSTEIN;
  const auto function = [&](double x) {    // of the node at 0
    int first;
    double w[4];
    const int n = bernstein ? MPMStencil::quadratic(x, first, w) : stencil.weights(x, first, w);
    return first <= 0 && -first < n ? w[-first] : 0.0;
  };
  range = 0.5 * MPM_NS::stencil_order(field.options.shape) + 0.5;
  const int n = (int) std::lround(2 * range * STEPS);
  volumes.assign(n + 1, 0.0);
  ratios.assign(n + 1, 0.0);
  means.assign(n + 1, 0.0);
  constexpr int PARTS = 8;    // of a step, for the integral
  double moment = 0.0;
  for (int k = 1; k <= n; k++) {
    double sum = 0.0;
    for (int j = 0; j < PARTS; j++) {
      const double x = -range + (k - 1 + (j + 0.5) / PARTS) / STEPS;
      const double part = function(x) / (PARTS * STEPS);
      sum += part;
      moment += part * x;
    }
    volumes[k] = volumes[k - 1] + sum;
    if (volumes[k] > 0.0) means[k] = -range + (double) k / STEPS - moment / volumes[k];
    const double area = function(-range + (double) k / STEPS);
    ratios[k] = area > 0.0 && k < n ? volumes[k] / area : std::max(1.0e10, ratios[k - 1]);
  }
}

/** The depth at which a list has a value. */
double MPMNodeProfile::inverse(const std::vector<double> &list, double value) const
{
  if (!(value > list.front())) return -range;
  if (value >= list.back()) return range;
  const auto above = std::upper_bound(list.begin(), list.end(), value);
  const double part = (value - above[-1]) / (above[0] - above[-1]);
  return -range + (above - list.begin() - 1 + part) / STEPS;
}

/** Of a list between its depths, place: of the depth in it. */
double MPMNodeProfile::at(const std::vector<double> &list, double place)
{
  if (place <= 0.0) return 0.0;
  const int k = (int) place;
  if (k + 1 >= (int) list.size()) return list.back();
  return list[k] + (place - k) * (list[k + 1] - list[k]);
}

double MPMNodeProfile::mean_depth(double depth) const
{
  return at(means, (std::min(depth, range) + range) * STEPS) + std::max(0.0, depth - range);
}
