/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/mpm_mirror_nodes.h"

#include "domain.h"
#include "field/mpm_field.h"
#include "walls/mpm_line_constraint.h"
#include "walls/mpm_wall.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

MPMBoxFace::MPMBoxFace(const MPMField &field, const Domain &box, int face) :
    axis(face / 2), inward(face % 2 ? -1 : 1)
{
  const double x = position(box);
  const double h = field.lattice.h, origin = field.lattice.origin[axis];
  plane = (int) std::lround((x - origin) / h);
  const double plane_x = origin + plane * h;
  cut = std::fabs(x - plane_x) > MPMWall::ON_SURFACE * h;
  if (cut) nweight = MPMLineConstraint::weights_at(field, axis, inward, x, first, weight);
  contact = contact_of(field, x);
}

double MPMBoxFace::position(const Domain &box) const
{
  return inward > 0 ? box.boxlo[axis] : box.boxhi[axis];
}

static constexpr double FILLED = 0.4;    // share of the volume in reach of the node in front

MPMContactDistance MPMBoxFace::contact_of(const MPMField &field, double x) const
{
  if (!cut) {
    const bool folded = field.options.modified_edges;    // see MPMEdges::fold()
    const double at[2] = {0.0, -1.0}, weights[2] = {1.0, 2.0};
    return {field, at, weights, folded ? 2 : 1};
  }
  double at[4];
  const double face = (x - field.lattice.origin[axis]) / field.lattice.h;
  for (int k = 0; k < nweight; k++) at[k] = inward * (first + k - face);
  return {field, at, weight, nweight};
}

void MPMBoxFace::add_line(const MPMField &field, const int *index)
{
  const auto at = [&](int along) {
    int k[3] = {index[0], index[1], index[2]};
    k[axis] = along;
    return field.grid.locate(k);
  };
  if (cut) {
    MPMFaceLine line;
    line.axis = axis;
    line.n = nweight;
    std::copy_n(weight, nweight, line.weight);
    for (int j = 0; j < nweight; j++) line.node[j] = at(first + j);
    if (line.is_complete()) lines.push_back(line);    // else out of reach of points, as is the face
    return;
  }
  MPMMirrorColumn column;
  column.node[0] = at(plane);
  for (int j = 1; j <= MPMMirrorColumn::DEPTH; j++) {
    int64_t &inside = column.node[j], &image = column.node[MPMMirrorColumn::DEPTH + j];
    inside = at(plane + inward * j);
    image = at(plane - inward * j);
    if (inside < 0 || image < 0) inside = image = -1;    // both out of reach of points
  }
  columns.push_back(column);
}
