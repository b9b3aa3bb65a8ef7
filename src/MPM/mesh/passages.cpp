/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/passages.h"

#include "math/matrix.h"

#include <algorithm>
#include <cmath>

using namespace MPM_NS;

int MPM_NS::side_of_face(int dim, const double *const at[3], const double *x, double range,
                         double margin, bool &within)
{
  double a[3], b[3], to[3], normal[3];
  for (int d = 0; d < 3; d++) {
    a[d] = at[1][d] - at[0][d];
    to[d] = x[d] - at[0][d];
  }
  if (dim == 2) {
    const double square = a[0] * a[0] + a[1] * a[1], along = (to[0] * a[0] + to[1] * a[1]) / square,
                 away = (a[0] * to[1] - a[1] * to[0]) / std::sqrt(square);
    const double least = std::min(along, 1.0 - along);
    within = least >= 0.0;
    if (!(std::fabs(away) <= range) || least < -margin) return 0;
    return away >= 0.0 ? 1 : -1;
  }
  for (int d = 0; d < 3; d++) b[d] = at[2][d] - at[0][d];
  cross(a, b, normal);
  const double square = dot(normal, normal), away = dot(normal, to) / std::sqrt(square);
  if (!(std::fabs(away) <= range)) return 0;
  double part[3];
  cross(to, b, part);
  const double v = dot(part, normal) / square;
  cross(a, to, part);
  const double w = dot(part, normal) / square;
  const double least = std::min({v, w, 1.0 - v - w});
  within = least >= 0.0;
  if (least < -margin) return 0;
  return away >= 0.0 ? 1 : -1;
}

const Passages::Sight *Passages::look(std::vector<Sight> now)
{
  std::sort(now.begin(), now.end());
  std::sort(known.begin(), known.end());
  int64_t found = -1;
  for (const auto &sight : now) {
    const auto before = std::lower_bound(known.begin(), known.end(), sight);
    if (before == known.end() || sight < *before || before->side == sight.side) continue;
    if (sight.within || before->within) found = &sight - now.data();
  }
  known.swap(now);
  return found < 0 ? nullptr : &known[found];
}

std::vector<Passages::Sight> Passages::take_others(const std::vector<FaceID> &faces)
{
  const auto first = std::partition(known.begin(), known.end(), [&](const Sight &sight) {
    return std::binary_search(faces.begin(), faces.end(), FaceID(sight.body, sight.face));
  });
  std::vector<Sight> others(first, known.end());
  known.erase(first, known.end());
  return others;
}
