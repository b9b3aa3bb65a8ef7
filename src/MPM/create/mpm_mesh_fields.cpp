/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "create/mpm_mesh_fields.h"

#include "atom.h"
#include "domain.h"
#include "error.h"
#include "group.h"
#include "math/matrix.h"
#include "mesh/gmsh.h"

#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

MPMMeshFields::MPMMeshFields(LAMMPS *lmp, const Mesh &mesh, bool at_nodes, int type, bool by_type,
                             bool by_group, const std::vector<Data> &data) :
    Pointers(lmp),
    at_nodes(at_nodes), columns(lmp), only_type(type)
{
  if (by_type) find_types(mesh);
  if (by_group) find_groups(mesh);
  std::vector<std::vector<double>> values;    // [column][node or element]
  for (const auto &one : data) find_data(mesh, one, values);
  for (std::size_t k = 0; !values.empty() && k < values[0].size(); k++)
    for (const auto &column : values) rows.push_back(column[k]);
  const int n = columns.size() ? (int) (rows.size() / columns.size()) : 0;
  for (int k = 0; k < n; k++)
    if (!(jacobian(k) > 0.0))
      error->all(FLERR, Error::NOLASTLINE,
                 "Create_points: data F of {} {} have a determinant of {:.8g}, which must be "
                 "positive",
                 at_nodes ? "node" : "element", k + 1, jacobian(k));
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

static constexpr char possible[] =
    "velocity, F (9), stress (6: xx yy zz xy xz yz, or 9), mass, radius, diameter, a history "
    "variable of a fix mpm/material, or d_name, i_name, d2_name, i2_name of fix property/atom, "
    "which must be defined before";

void MPMMeshFields::find_data(const Mesh &mesh, const Data &wanted,
                              std::vector<std::vector<double>> &values)
{
  const MeshData *found = nullptr;
  std::string known;
  bool elsewhere = false;
  int times = 0;
  for (const auto &data : mesh.data) {
    elsewhere = elsewhere || (data.name == wanted.name && data.at_nodes != at_nodes);
    if (data.at_nodes != at_nodes) continue;
    known += " " + data.name;
    if (data.name != wanted.name) continue;
    found = &data;
    times++;
  }
  if (times > 1)
    error->all(FLERR, Error::NOLASTLINE,
               "Create_points: the file has data {} for {} {} times, as of several steps: save "
               "one of them",
               wanted.name, at_nodes ? "nodes" : "elements", times);
  if (!found)
    error->all(
        FLERR, Error::NOLASTLINE, "Create_points: the file has no data {} for {}; it has{}{}",
        wanted.name, at_nodes ? "nodes" : "elements", known.empty() ? " none" : ":" + known,
        elsewhere ? fmt::format(", and data of this name for {}", at_nodes ? "elements" : "nodes")
                  : "");

  const int width = found->width;
  const auto refuse = [&] {
    error->all(FLERR, Error::NOLASTLINE,
               "Create_points: data {} have {} components and cannot be {}: data can be for {}",
               wanted.name, width, wanted.quantity, possible);
  };
  using Columns = MPMPointColumns;
  for (int c = 0; c < width; c++) {
    const auto kind = columns.add(Columns::component_name(wanted.quantity, c, width));
    const bool of_tensor = kind == Columns::FOLLOWS && wanted.quantity == "stress";
    if (kind != Columns::VELOCITY && kind != Columns::DEFORMATION && kind != Columns::STRESS &&
        kind != Columns::MASS && kind != Columns::RADIUS && kind != Columns::HISTORY &&
        kind != Columns::PROPERTY && !of_tensor)
      refuse();
    const int column = columns.size() - 1;
    if (columns.same(column) >= 0)
      error->all(FLERR, Error::NOLASTLINE, "Create_points: {} is given twice by data",
                 wanted.quantity);
    std::vector<double> numbers;
    for (std::size_t k = c; k < found->values.size(); k += width) {
      const double value = wanted.factor * found->values[k];
      const std::string wrong = std::isfinite(value) ? columns.wrong(column, value)
                                                     : "is not finite, or missing";
      if (!wrong.empty())
        error->all(FLERR, Error::NOLASTLINE, "Create_points: data {} have {:.8g} for {}, which {}",
                   wanted.name, value, wanted.quantity, wrong);
      numbers.push_back(value);
    }
    values.push_back(numbers);
  }
  // nothing may be left over
  MPMPointColumns more(lmp);
  const bool all = (wanted.quantity == "velocity" && width == domain->dimension) ||
      (wanted.quantity == "stress" && width == 6);
  if (!all &&
      more.add(Columns::component_name(wanted.quantity, width, width + 1)) != Columns::UNKNOWN)
    refuse();
}

/* ---------------------------------------------------------------------- */

double MPMMeshFields::jacobian(int k) const
{
  if (columns.find(MPMPointColumns::DEFORMATION) < 0) return 1.0;
  double F[9];
  for (int c = 0; c < 9; c++)
    F[c] = rows[(std::size_t) k * columns.size() + columns.find(MPMPointColumns::DEFORMATION, c)];
  return determinant(F);
}

void MPMMeshFields::set(int first)
{
  std::vector<double> some;
  const int n = columns.size();
  for (std::size_t p = 0; p < mine.size(); p++) {
    const int i = first + (int) p, k = mine[p];
    if (!type.empty()) atom->type[i] = type[k];
    if (!bits.empty()) atom->mask[i] |= bits[k];
    const auto from = rows.begin() + (std::ptrdiff_t) k * n;
    some.insert(some.end(), from, from + n);
  }
  columns.set(first, some);
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
