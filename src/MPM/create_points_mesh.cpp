/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Create_points TYPE mesh FILE: a point at each node of a mesh of finite elements.
// Create_points TYPE elements FILE: a point for each element of a mesh, which is its domain with
// shape cpdi2 of fix mpm.

#include "create_points.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "math_extra.h"
#include "mesh/element.h"
#include "mpm_cpdi.h"
#include "mpm_field.h"
#include "mpm_input.h"
#include "mpm_options.h"
#include "transfer/cpdi.h"

#include <algorithm>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   TYPE mesh|elements FILE keyword value ...
------------------------------------------------------------------------- */

Options CreatePointsMeshOptions::declare(const std::string &command, int dim, bool has_radius)
{
  using namespace option;
  Options o(command);
  o.add("scale", {number(scale, "factor", POSITIVE, "", "factor on the coordinates of the file")});
  o.add("move",
        {axes(move, dim, "x y z", ANY_NUMBER, "distance", "added to the scaled coordinates")});
  o.add("part", {text(part, "name", "name or tag of a physical group of the mesh")})
      .standard("all elements of the dimension of the simulation");
  o.add("diameter",
        {number(diameter, "D", POSITIVE, "distance",
                "diameter of the points in contact with grains")})
      .standard("edge of a cube (2d: square) of the volume");
  o.refuse([=] {
    return OptionRules{{!has_radius, "diameter", "needs atom_style hybrid sphere mpm"}};
  });
  return o;
}

void CreatePoints::parse_mesh(int narg, char **arg)
{
  const std::string what = std::string("create_points ") + arg[1];
  if (narg < 3) utils::missing_cmd_args(FLERR, what, error);
  for (auto *field : MPMField::all(lmp))
    if (field->options.axisymmetric) fix = field;
  const bool in_elements = strcmp(arg[1], "elements") == 0;
  if (fix && !in_elements)
    error->all(FLERR, 1,
               "Create_points mesh cannot be used with axisymmetric fix mpm {}: elements, to "
               "which its points belong, are of plane strain; use create_points elements or region",
               fix->id());

  const int dim = domain->dimension;
  CreatePointsMeshOptions given;
  Options options = given.declare(what, dim, atom->radius_flag);
  read_options(lmp, options, narg, arg, 3);
  diameter = given.diameter;

  Mesh mesh = read_body(lmp, arg[2], given.part, "Create_points", 2);
  for (auto &x : mesh.nodes)
    for (int d = 0; d < 3; d++) x[d] = d < dim ? given.move[d] + given.scale * x[d] : 0.0;

  volume = 0.0;
  if (in_elements)
    find_elements(mesh, arg[2]);
  else
    find_nodes(mesh, arg[2]);
  volume /= mesh_sites.size();

  bigint outside = 0;
  for (auto &site : mesh_sites) {
    bool inside = true;
    for (int d = 0; d < 3; d++)
      inside = inside &&
          (domain->periodicity[d] ||
           (site.x[d] >= domain->boxlo[d] && site.x[d] < domain->boxhi[d]));
    outside += !inside;
    domain->remap(site.x);
  }
  if (outside)
    error->all(FLERR, 2,
               "Create_points: {} {} of {} are outside of the simulation box; enlarge the "
               "box, or use the keywords scale and move",
               outside, in_elements ? "elements" : "nodes", arg[2]);
}

/* ----------------------------------------------------------------------
   a node has its share of the volume of the elements around it
------------------------------------------------------------------------- */

static constexpr char bad_element[] = "Create_points: element {} of {} has no volume or is twisted";

void CreatePoints::find_nodes(const Mesh &mesh, const char *file)
{
  for (const auto &x : mesh.nodes) mesh_sites.push_back({{x[0], x[1], x[2]}, 0.0, 0});
  for (const auto &e : mesh.elements) {
    const auto &rule = ElementRule::of(e.type);
    double x[MAX_ELEMENT_NODES][3], g[MAX_ELEMENT_NODES][3];
    for (int k = 0; k < rule.nnode; k++) MathExtra::copy3(mesh.nodes[e.node[k]].data(), x[k]);
    for (int q = 0; q < rule.npoint; q++) {
      const double w = rule.gradients(q, x, g);
      if (!(w > 0.0)) error->all(FLERR, 2, bad_element, e.label, file);
      volume += w;
      for (int k = 0; k < rule.nnode; k++) mesh_sites[e.node[k]].volume += w * rule.N[q][k];
    }
  }
}

/* ----------------------------------------------------------------------
   an element is the domain of its point
------------------------------------------------------------------------- */

/** Nodes as corners of the domain, by ElementType. */
static constexpr int corner_nodes[][8] = {
    {0, 1, 2, 2}, {0, 1, 3, 2}, {0, 1, 2, 2, 3, 3, 3, 3}, {0, 1, 3, 2, 4, 5, 7, 6}};

void CreatePoints::find_elements(const Mesh &mesh, const char *file)
{
  const int dim = domain->dimension, ncorner = 1 << dim;
  for (const auto &e : mesh.elements) {
    Site site = {{0.0, 0.0, 0.0}, 0.0, 0};
    Corners corner;
    const int *node = corner_nodes[static_cast<int>(e.type)];
    double w[8], g[24];
    for (int c = 0; c < ncorner; c++)
      for (int d = 0; d < dim; d++) corner[dim * c + d] = mesh.nodes[e.node[node[c]]][d];
    site.volume = dim == 2 ? PointDomain<2>::free(corner.data(), w, g)
                           : PointDomain<3>::free(corner.data(), w, g);
    if (!(site.volume > 0.0 && *std::min_element(w, w + ncorner) >= 0.0))
      error->all(FLERR, 2, bad_element, e.label, file);
    for (int c = 0; c < ncorner && fix; c++)
      if (corner[dim * c] < -1.0e-10 * domain->xprd)
        error->all(FLERR, 2,
                   "Create_points: element {} of {} reaches below x = 0, which is the axis of "
                   "fix mpm {}",
                   e.label, file, fix->id());
    for (int d = 0; d < dim; d++) {
      for (int c = 0; c < ncorner; c++) site.x[d] += w[c] * corner[dim * c + d];
      for (int c = 0; c < ncorner; c++) corner[dim * c + d] -= site.x[d];
    }
    volume += site.volume;
    mesh_sites.push_back(site);
    corners.push_back(corner);
  }
}

/* ----------------------------------------------------------------------
   all ranks have all sites, and IDs follow their order in the file; returns the number of points
------------------------------------------------------------------------- */

bigint CreatePoints::make_mesh_points()
{
  const bigint n = mesh_sites.size();
  const tagint maxtag = largest_tag();
  check_tags(maxtag, n);
  if (comm->nprocs > 1) comm->coord2proc_setup();
  std::vector<Corners> mine;
  for (bigint k = 0; k < n; k++) {
    auto &site = mesh_sites[k];
    if (owner(site.x) != comm->me) continue;
    site.tag = atom->tag_enable ? maxtag + k + 1 : 0;
    make_point(site);
    if (!corners.empty()) mine.push_back(corners[k]);
  }
  corners.swap(mine);
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
    for (std::size_t k = 0; k < corners.size(); k++)
      std::copy_n(corners[k].data(), n, field->domains->corners[first + k]);
  }
}
