/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_mesh_fields.h"

#include "atom.h"
#include "domain.h"
#include "error.h"
#include "group.h"
#include "mesh/gmsh.h"

#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

MPMMeshFields::MPMMeshFields(LAMMPS *lmp, const Mesh &mesh, bool at_nodes, int type, bool by_type,
                             bool by_group, const Names &data) :
    Pointers(lmp),
    at_nodes(at_nodes), only_type(type)
{
  if (by_type) find_types(mesh);
  if (by_group) find_groups(mesh);
  for (const auto &[name, quantity] : data) find_data(mesh, name, quantity);
}

/* ---------------------------------------------------------------------- */

void MPMMeshFields::find_types(const Mesh &mesh)
{
  std::vector<int> of_element;
  for (const auto &e : mesh.elements) of_element.push_back(e.physical);
  for (std::size_t n = 0; n < mesh.sets.size(); n++)
    for (const int k : mesh.sets[n].elements) {
      if (mesh.elements[k].physical) continue;
      if (of_element[k])
        error->all(FLERR, Error::NOLASTLINE,
                   "Create_points types physical: element {} is in the sets {} and {}, and would "
                   "have two types",
                   mesh.elements[k].label, mesh.sets[of_element[k] - 1].name, mesh.sets[n].name);
      of_element[k] = (int) n + 1;
    }
  type.assign(at_nodes ? mesh.nodes.size() : mesh.elements.size(), 0);
  for (std::size_t k = 0; k < mesh.elements.size(); k++) {
    const auto &e = mesh.elements[k];
    if (of_element[k] < 1 || of_element[k] > atom->ntypes)
      error->all(FLERR, Error::NOLASTLINE,
                 "Create_points types physical: element {} is in {}, but types are 1 to {}",
                 e.label, of_element[k] ? "group " + std::to_string(of_element[k]) : "no group",
                 atom->ntypes);
    if (!at_nodes) type[k] = of_element[k];
    for (int j = 0; j < element_nodes(e.type) && at_nodes; j++) {
      int &mine = type[e.node[j]];
      if (mine && mine != of_element[k])
        error->all(FLERR, Error::NOLASTLINE,
                   "Create_points types physical: a node of element {} is in groups {} and {}, and "
                   "would have two types; use the keyword groups, or one mesh for each part",
                   e.label, mine, of_element[k]);
      mine = of_element[k];
    }
  }
}

void MPMMeshFields::find_groups(const Mesh &mesh)
{
  if (mesh.sets.empty())
    error->all(FLERR, Error::NOLASTLINE, "Create_points groups physical: the mesh has no groups");
  bits.assign(at_nodes ? mesh.nodes.size() : mesh.elements.size(), 0);
  for (const auto &set : mesh.sets) {
    if (set.elements.empty()) continue;
    std::string name = set.name;    // words of the input have no blanks
    for (auto &c : name)
      if (c == ' ') c = '_';
    const int igroup = group->find_or_create(name.c_str());
    if (group->dynamic[igroup])
      error->all(
          FLERR, Error::NOLASTLINE,
          "Create_points groups physical: group {} is dynamic: its rule decides what is in it",
          name);
    for (const int k : set.elements) {
      const auto &e = mesh.elements[k];
      if (!at_nodes) bits[k] |= group->bitmask[igroup];
      for (int j = 0; j < element_nodes(e.type) && at_nodes; j++)
        bits[e.node[j]] |= group->bitmask[igroup];
    }
  }
}

/* ---------------------------------------------------------------------- */

void MPMMeshFields::find_data(const Mesh &mesh, const std::string &name,
                              const std::string &quantity)
{
  Field field = {quantity, -1, false, 0, 0, {}};
  std::string known;
  bool elsewhere = false;
  for (const auto &data : mesh.data) {
    elsewhere = elsewhere || (data.name == name && data.at_nodes != at_nodes);
    if (data.at_nodes != at_nodes) continue;
    known += " " + data.name;
    if (data.name != name) continue;
    field.width = data.width;
    field.values = data.values;
  }
  if (field.width == 0)
    error->all(
        FLERR, Error::NOLASTLINE, "Create_points: the file has no data {} for {}; it has{}{}", name,
        at_nodes ? "nodes" : "elements", known.empty() ? " none" : ":" + known,
        elsewhere ? fmt::format(", and data of this name for {}", at_nodes ? "elements" : "nodes")
                  : "");
  int need = domain->dimension;
  if (quantity != "velocity") {
    int flag, columns;
    const bool property =
        quantity.size() > 2 && quantity[1] == '_' && (quantity[0] == 'd' || quantity[0] == 'i');
    field.index = property ? atom->find_custom(&quantity[2], flag, columns) : -1;
    if (field.index < 0 || flag != (quantity[0] == 'd'))
      error->all(FLERR, Error::NOLASTLINE,
                 "Create_points: data can be for velocity, or for {} once fix property/atom has "
                 "defined it",
                 property ? quantity : "d_name or i_name");
    field.is_integer = !flag;
    field.columns = columns;
    need = std::max(1, columns);
  }
  if (quantity == "velocity" ? field.width < need : field.width != need)
    error->all(FLERR, Error::NOLASTLINE, "Create_points: data {} have {} components, but {} has {}",
               name, field.width, quantity, need);
  for (const double value : field.values)
    if (!std::isfinite(value) || (field.is_integer && value != std::floor(value)))
      error->all(FLERR, Error::NOLASTLINE,
                 "Create_points: data {} have the value {}, which cannot be {}", name, value,
                 quantity);
  fields.push_back(field);
}

/* ---------------------------------------------------------------------- */

void MPMMeshFields::set(int first)
{
  for (std::size_t n = 0; n < mine.size(); n++) {
    const int i = first + (int) n, k = mine[n];
    if (!type.empty()) atom->type[i] = type[k];
    if (!bits.empty()) atom->mask[i] |= bits[k];
    for (const auto &field : fields) {
      const double *from = &field.values[(std::size_t) k * field.width];
      for (int c = 0; c < field.width; c++) {
        if (field.index < 0) {
          if (c < domain->dimension) atom->v[i][c] = from[c];
        } else if (field.is_integer)
          (field.columns ? atom->iarray[field.index][i][c] : atom->ivector[field.index][i]) =
              (int) from[c];
        else
          (field.columns ? atom->darray[field.index][i][c] : atom->dvector[field.index][i]) =
              from[c];
      }
    }
  }
}

std::string MPMMeshFields::types() const
{
  if (type.empty()) return " " + std::to_string(only_type);
  std::vector<int> count(atom->ntypes + 1, 0);
  for (const int t : type) count[t]++;
  std::string text = "s";
  for (int t = 1; t <= atom->ntypes; t++)
    if (count[t]) text += fmt::format("{} {} ({})", text == "s" ? "" : ",", t, count[t]);
  return text;
}
