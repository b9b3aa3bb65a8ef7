/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Create_points TYPE mesh FILE: a point at each node of a mesh of finite elements.

#include "create_points.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "mpm_element.h"
#include "mpm_mesh_input.h"

#include <cmath>
#include <cstring>
#include <stdexcept>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   TYPE mesh FILE keyword value ...
------------------------------------------------------------------------- */

void CreatePoints::parse_mesh(int narg, char **arg)
{
  if (narg < 3) utils::missing_cmd_args(FLERR, "create_points mesh", error);
  const int dim = domain->dimension;
  std::string part;
  double scale = 1.0, move[3] = {0.0, 0.0, 0.0};
  for (int iarg = 3; iarg < narg;) {
    const std::string keyword = arg[iarg];
    const int n = keyword == "move" ? dim : 1;
    if (keyword != "move" && keyword != "scale" && keyword != "part" && keyword != "diameter")
      error->all(FLERR, iarg, "Unknown create_points mesh keyword: {}", keyword);
    if (iarg + n >= narg) utils::missing_cmd_args(FLERR, "create_points mesh " + keyword, error);
    if (keyword == "move")
      for (int d = 0; d < dim; d++)
        move[d] = utils::numeric(FLERR, arg[iarg + 1 + d], false, lmp);
    else if (keyword == "part")
      part = arg[iarg + 1];
    else {
      const double value = utils::numeric(FLERR, arg[iarg + 1], false, lmp);
      if (!(value > 0.0 && std::isfinite(value)))
        error->all(FLERR, iarg + 1, "Create_points mesh {} {} must be > 0", keyword, arg[iarg + 1]);
      if (keyword == "diameter" && !atom->radius_flag)
        error->all(FLERR, iarg, "Create_points diameter needs atom_style hybrid sphere mpm");
      (keyword == "scale" ? scale : diameter) = value;
    }
    iarg += 1 + n;
  }

  Mesh mesh;
  try {
    mesh = read_body(lmp, arg[2], part);
  } catch (const std::runtime_error &e) {
    error->all(FLERR, 2, "Create_points: {}", e.what());
  }

  // a node has its share of the volume of the elements around it

  mesh_sites.resize(mesh.nodes.size());
  double total = 0.0;
  for (auto &site : mesh_sites) site.volume = 0.0;
  for (const auto &e : mesh.elements) {
    const auto &rule = ElementRule::of(e.type);
    double x[MAX_ELEMENT_NODES][3], g[MAX_ELEMENT_NODES][3];
    for (int k = 0; k < rule.nnode; k++)
      for (int d = 0; d < 3; d++) x[k][d] = scale * mesh.nodes[e.node[k]][d];
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
    bool in = true;
    double *const x = mesh_sites[k].x;
    for (int d = 0; d < 3; d++) {
      x[d] = d < dim ? move[d] + scale * mesh.nodes[k][d] : 0.0;
      in = in && (domain->periodicity[d] || (x[d] >= domain->boxlo[d] && x[d] < domain->boxhi[d]));
    }
    outside += !in;
    domain->remap(x);
  }
  if (outside)
    error->all(FLERR, 2, "Create_points: {} nodes of {} are outside of the simulation box; enlarge the "
               "box, or use the keywords scale and move", outside, arg[2]);
}

/* ----------------------------------------------------------------------
   IDs follow the order of nodes in the file
------------------------------------------------------------------------- */

bigint CreatePoints::make_mesh_points()
{
  tagint mytag = 0, maxtag = 0;
  for (int i = 0; i < atom->nlocal; i++) mytag = std::max(mytag, atom->tag[i]);
  MPI_Allreduce(&mytag, &maxtag, 1, MPI_LMP_TAGINT, MPI_MAX, world);
  const bigint n = mesh_sites.size();
  if (atom->tag_enable && maxtag + n >= MAXTAGINT)
    error->all(FLERR, Error::NOLASTLINE, "New atom IDs exceed the maximum allowed ID {}", MAXTAGINT);
  for (bigint k = 0; k < n; k++) mesh_sites[k].tag = atom->tag_enable ? maxtag + k + 1 : 0;
  if (comm->me) mesh_sites.clear();    // all ranks have all
  send_and_make(mesh_sites);
  return n;
}
