/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/face_contact.h"

#include "math/matrix.h"
#include "mesh/vector3.h"

#include <algorithm>
#include <cmath>

using namespace MPM_NS;
using namespace MPM_NS::vector3;

double MPM_NS::place_on_line(const double *a, const double *b, const double *x)
{
  double along[3], to[3];
  difference(b, a, along);
  difference(x, a, to);
  const double square = dot(along, along);
  return square > 0.0 ? std::min(std::max(dot(along, to) / square, 0.0), 1.0) : 0.0;
}

void FacePlace::find_plane(int dim, const double *const at[3], const double *x)
{
  double a[3], b[3], to[3], square;
  difference(at[1], at[0], a);
  difference(x, at[0], to);
  std::fill_n(weight, 3, 0.0);
  if (dim == 2) {
    normal[0] = -a[1];
    normal[1] = a[0];
    normal[2] = 0.0;
    square = dot(normal, normal);
    weight[1] = dot(a, to) / square;
  } else {
    difference(at[2], at[0], b);
    cross(a, b, normal);
    square = dot(normal, normal);
    double part[3];
    cross(to, b, part);
    weight[1] = dot(part, normal) / square;
    cross(a, to, part);
    weight[2] = dot(part, normal) / square;
  }
  weight[0] = 1.0 - weight[1] - weight[2];
  within = square > 0.0 && weight[0] >= 0.0 && weight[1] >= 0.0 && weight[2] >= 0.0;
  const double length = std::sqrt(square);
  height = square > 0.0 ? dot(normal, to) / length : 0.0;
  for (int d = 0; d < 3; d++) {
    normal[d] = square > 0.0 ? normal[d] / length : 0.0;
    from[d] = height * normal[d];
  }
  distance = std::fabs(height);
}

void FacePlace::find_rim(int dim, const double *const at[3], const double *x)
{
  distance = HUGE_VAL;
  for (int k = 0; k < (dim == 2 ? 1 : 3); k++) {
    const int a = k, b = (k + 1) % 3;
    const double s = place_on_line(at[a], at[b], x);
    double way[3];
    for (int d = 0; d < 3; d++) way[d] = x[d] - at[a][d] - s * (at[b][d] - at[a][d]);
    const double length = norm(way);
    if (length >= distance) continue;
    distance = length;
    std::copy_n(way, 3, from);
    std::fill_n(weight, 3, 0.0);
    weight[a] = 1.0 - s;
    weight[b] = s;
  }
}

void MPM_NS::find_common_parts(int dim, const std::vector<ContactFace> &faces,
                               std::vector<ContactPart> &parts)
{
  parts.clear();
  if (faces.size() < 2) return;

  // each edge, and each node, with the sums over faces; edges are less one of them, their mean
  const auto sum_equal = [&](std::size_t first) {
    const auto begin = parts.begin() + (std::ptrdiff_t) first;
    const auto key = [](const ContactPart &p) {
      return std::make_pair(p.node[0], p.node[1]);
    };
    std::sort(begin, parts.end(), [&](const ContactPart &a, const ContactPart &b) {
      return key(a) < key(b);
    });
    std::size_t to = first;
    for (std::size_t p = first; p < parts.size();) {
      ContactPart sum = parts[p];
      std::size_t q = p + 1;
      for (; q < parts.size() && key(parts[q]) == key(sum); q++) {
        sum.share += parts[q].share;
        sum.stiffness += parts[q].stiffness;
        sum.damping += parts[q].damping;
      }
      const auto n = (double) (q - p);
      parts[to++] = {{sum.node[0], sum.node[1]},
                     1.0 - sum.share,
                     sum.stiffness / n - sum.stiffness,
                     sum.damping / n - sum.damping};
      p = q;
    }
    parts.resize(to);
  };
  for (const auto &f : faces)
    for (int k = 0; k < 3 && dim == 3; k++) {
      const auto [low, high] = std::minmax(f.node[k], f.node[(k + 1) % 3]);
      parts.push_back({{low, high}, 1.0, f.stiffness, f.damping});
    }
  sum_equal(0);
  const std::size_t nedge = parts.size();
  for (const auto &f : faces)
    for (int k = 0; k < dim; k++)
      parts.push_back({{f.node[k], f.node[k]}, 1.0, f.stiffness, f.damping});
  sum_equal(nedge);

  // nodes get back what their edges have taken
  for (std::size_t p = nedge; p < parts.size(); p++)
    for (std::size_t e = 0; e < nedge; e++) {
      if (parts[e].node[0] != parts[p].node[0] && parts[e].node[1] != parts[p].node[0]) continue;
      parts[p].share -= parts[e].share;
      parts[p].stiffness -= parts[e].stiffness;
      parts[p].damping -= parts[e].damping;
    }
  parts.erase(std::remove_if(parts.begin(), parts.end(),
                             [](const ContactPart &p) {
                               return p.share == 0.0 && p.stiffness == 0.0 && p.damping == 0.0;
                             }),
              parts.end());
}

int MPM_NS::side_of_face(int dim, const double *const at[3], const double *x, double range,
                         double margin, bool &within)
{
  FacePlace place;
  place.find_plane(dim, at, x);
  const double least = *std::min_element(place.weight, place.weight + dim);
  within = least >= 0.0;
  if (!(place.distance <= range) || !(least >= -margin)) return 0;
  return place.height >= 0.0 ? 1 : -1;
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
