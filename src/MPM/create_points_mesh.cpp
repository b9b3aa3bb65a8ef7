/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Create_points TYPE mesh FILE: a point at each node of a mesh of finite elements; reading of a mesh.

#include "create_points.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "math_extra.h"
#include "mesh/element.h"
#include "modify.h"
#include "mpm_field.h"
#include "mpm_mesh_input.h"
#include "mpm_options.h"

#include <cmath>
#include <cstring>
#include <stdexcept>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   TYPE mesh|elements FILE keyword value ...: the mesh, scaled and moved
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

Mesh CreatePoints::read_mesh(int narg, char **arg)
{
  const std::string what = std::string("create_points ") + arg[1];
  if (narg < 3) utils::missing_cmd_args(FLERR, what, error);
  for (auto *field : MPMField::all(lmp))
    if (field->options.axisymmetric) fix = field;
  if (fix && strcmp(arg[1], "mesh") == 0)
    error->all(FLERR, 1,
               "Create_points mesh cannot be used with axisymmetric fix mpm {}: elements, to "
               "which its points belong, are of plane strain; use create_points elements or region",
               fix->id());

  const int dim = domain->dimension;
  CreatePointsMeshOptions given;
  Options options = given.declare(what, dim, atom->radius_flag);
  read_options(lmp, options, narg, arg, 3);
  diameter = given.diameter;

  Mesh mesh;
  try {
    mesh = read_body(lmp, arg[2], given.part);
  } catch (const std::runtime_error &e) {
    error->all(FLERR, 2, "Create_points: {}", e.what());
  }
  for (auto &x : mesh.nodes)
    for (int d = 0; d < 3; d++) x[d] = d < dim ? given.move[d] + given.scale * x[d] : 0.0;
  return mesh;
}

/* ----------------------------------------------------------------------
   wrap a position into the box; false: it is outside
------------------------------------------------------------------------- */

bool CreatePoints::put_into_box(double *x) const
{
  for (int d = 0; d < 3; d++)
    if (!domain->periodicity[d] && !(x[d] >= domain->boxlo[d] && x[d] < domain->boxhi[d]))
      return false;
  domain->remap(x);
  return true;
}

/* ---------------------------------------------------------------------- */

void CreatePoints::parse_mesh(int narg, char **arg)
{
  const Mesh mesh = read_mesh(narg, arg);

  // a node has its share of the volume of the elements around it

  mesh_sites.resize(mesh.nodes.size());
  double total = 0.0;
  for (auto &site : mesh_sites) site.volume = 0.0;
  for (const auto &e : mesh.elements) {
    const auto &rule = ElementRule::of(e.type);
    double x[MAX_ELEMENT_NODES][3], g[MAX_ELEMENT_NODES][3];
    for (int k = 0; k < rule.nnode; k++) MathExtra::copy3(mesh.nodes[e.node[k]].data(), x[k]);
    for (int q = 0; q < rule.npoint; q++) {
      const double w = rule.gradients(q, x, g);
      if (!(w > 0.0))
        error->all(FLERR, 2, "Create_points: element {} of {} has no volume or is twisted", e.label,
                   arg[2]);
      total += w;
      for (int k = 0; k < rule.nnode; k++) mesh_sites[e.node[k]].volume += w * rule.N[q][k];
    }
  }
  volume = total / mesh_sites.size();

  bigint outside = 0;
  for (std::size_t k = 0; k < mesh_sites.size(); k++) {
    MathExtra::copy3(mesh.nodes[k].data(), mesh_sites[k].x);
    outside += !put_into_box(mesh_sites[k].x);
  }
  if (outside)
    error->all(FLERR, 2,
               "Create_points: {} nodes of {} are outside of the simulation box; enlarge the "
               "box, or use the keywords scale and move",
               outside, arg[2]);
}

/* ----------------------------------------------------------------------
   IDs follow the order of nodes in the file
------------------------------------------------------------------------- */

bigint CreatePoints::make_mesh_points()
{
  const bigint n = mesh_sites.size();
  const tagint maxtag = largest_tag();
  check_tags(maxtag, n);
  for (bigint k = 0; k < n; k++) mesh_sites[k].tag = atom->tag_enable ? maxtag + k + 1 : 0;
  if (comm->me) mesh_sites.clear();    // all ranks have all
  send_and_make(mesh_sites);
  return n;
}
