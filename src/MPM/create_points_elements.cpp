/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Create_points TYPE elements FILE: a point for each element of a mesh, which is its domain with
// shape cpdi2 of fix mpm.

#include "create_points.h"

#include "atom.h"
#include "atom_vec.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "mesh/gmsh.h"
#include "modify.h"
#include "mpm_cpdi.h"
#include "mpm_field.h"
#include "mpm_frame.h"
#include "transfer/cpdi.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   nodes of an element as corners of a domain
------------------------------------------------------------------------- */

static const int *corner_nodes(ElementType type)
{
  static constexpr int triangle[] = {0, 1, 2, 2}, quad[] = {0, 1, 3, 2},
                       tetrahedron[] = {0, 1, 2, 2, 3, 3, 3, 3},
                       hexahedron[] = {0, 1, 3, 2, 4, 5, 7, 6};
  switch (type) {
    case ElementType::TRIANGLE:
      return triangle;
    case ElementType::QUAD:
      return quad;
    case ElementType::TETRAHEDRON:
      return tetrahedron;
    default:
      return hexahedron;
  }
}

/* ----------------------------------------------------------------------
   TYPE elements FILE keyword value ...
------------------------------------------------------------------------- */

void CreatePoints::parse_elements(int narg, char **arg)
{
  const Mesh mesh = read_mesh(narg, arg);
  const int dim = domain->dimension, ncorner = 1 << dim;
  bigint outside = 0;
  for (const auto &e : mesh.elements) {
    Element element;
    const int *node = corner_nodes(e.type);
    double w[8], g[24];
    for (int c = 0; c < ncorner; c++)
      for (int d = 0; d < dim; d++) element.corners[dim * c + d] = mesh.nodes[e.node[node[c]]][d];
    element.volume = dim == 2 ? PointDomain<2>::free(element.corners, w, g)
                              : PointDomain<3>::free(element.corners, w, g);
    if (!(element.volume > 0.0 && *std::min_element(w, w + ncorner) >= 0.0))
      error->all(FLERR, 2, "Create_points: element {} of {} has no volume or is twisted", e.label,
                 arg[2]);
    for (int c = 0; c < ncorner && fix; c++)
      if (element.corners[dim * c] < -1.0e-10 * domain->xprd)
        error->all(FLERR, 2,
                   "Create_points: element {} of {} reaches below x = 0, which is the axis of "
                   "fix mpm {}",
                   e.label, arg[2], fix->id());
    for (int d = 0; d < 3; d++) {
      element.x[d] = 0.0;
      for (int c = 0; c < ncorner && d < dim; c++)
        element.x[d] += w[c] * element.corners[dim * c + d];
      for (int c = 0; c < ncorner && d < dim; c++) element.corners[dim * c + d] -= element.x[d];
    }
    outside += !put_into_box(element.x);
    volume += element.volume;
    elements.push_back(element);
  }
  if (outside)
    error->all(FLERR, 2,
               "Create_points: {} elements of {} are outside of the simulation box; enlarge "
               "the box, or use the keywords scale and move",
               outside, arg[2]);
  volume /= elements.size();
}

/* ----------------------------------------------------------------------
   IDs follow the order of elements in the file; returns the number of points
------------------------------------------------------------------------- */

bigint CreatePoints::make_element_points()
{
  const bigint n = elements.size();
  const tagint maxtag = largest_tag();
  check_tags(maxtag, n);
  if (comm->nprocs > 1) comm->coord2proc_setup();
  std::vector<Element> mine;
  for (bigint k = 0; k < n; k++) {
    auto &e = elements[k];
    int unused[3];
    if (comm->nprocs > 1 && comm->coord2proc(e.x, unused[0], unused[1], unused[2]) != comm->me)
      continue;
    atom->avec->create_atom(type, e.x);
    const int i = atom->nlocal - 1;
    atom->tag[i] = atom->tag_enable ? maxtag + k + 1 : 0;
    atom->vfrac[i] = e.volume * (fix ? fix->frame->circle(e.x[0]) : 1.0);
    atom->rmass[i] = 0.0;    // not known yet, see fix mpm/material
    const double edge = domain->dimension == 3 ? std::cbrt(e.volume) : std::sqrt(e.volume);
    if (atom->radius_flag) atom->radius[i] = 0.5 * (diameter > 0.0 ? diameter : edge);
    mine.push_back(e);
  }
  elements.swap(mine);
  return n;
}

/* ----------------------------------------------------------------------
   once fixes know of the points
------------------------------------------------------------------------- */

void CreatePoints::set_domains(int first)
{
  const int n = domain->dimension << domain->dimension;
  for (auto *field : MPMField::all(lmp)) {
    if (!field->domains || !field->domains->corners) continue;
    for (std::size_t k = 0; k < elements.size(); k++)
      std::copy_n(elements[k].corners, n, field->domains->corners[first + k]);
  }
}
