/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "create/mpm_point_columns.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "domain.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_physics.h"
#include "material/material.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

using namespace LAMMPS_NS;
using namespace MPM_NS;

namespace {

using Kind = MPMPointColumns::Kind;

struct Known {
  const char *name;    // of all components, as NAME:0; null: has none
  std::vector<const char *> components;
  Kind kind;
};

/** Names that points know of themselves, in the order of components. */
const std::vector<Known> known = {
    {"Points", {"x", "y", "z"}, Kind::PLACE},
    {nullptr, {"id"}, Kind::ID},
    {nullptr, {"type"}, Kind::TYPE},
    {nullptr, {"volume0"}, Kind::VOLUME0},
    {nullptr, {"volume"}, Kind::VOLUME},
    {nullptr, {"density"}, Kind::DENSITY},
    {nullptr, {"mass"}, Kind::MASS},
    {"velocity", {"vx", "vy", "vz"}, Kind::VELOCITY},
    {"F",
     {"F/xx", "F/xy", "F/xz", "F/yx", "F/yy", "F/yz", "F/zx", "F/zy", "F/zz"},
     Kind::DEFORMATION},
    {nullptr,
     {"stress/xx", "stress/yy", "stress/zz", "stress/xy", "stress/xz", "stress/yz"},
     Kind::STRESS},
    {nullptr, {"radius", "diameter"}, Kind::RADIUS},
    {"image", {"ix", "iy", "iz"}, Kind::IMAGE},
};

/** The component of stress for each of the nine of a tensor of VTK, whose lower half is the upper
 *  one. */
constexpr int tensor_component[9] = {0, 3, 4, -1, 1, 5, -1, -1, 2};

/** What is a function of other columns, or of all points. */
const std::set<std::string> follows = {
    "J",     "pressure", "vonmises",  "triaxiality", "principal/1", "principal/2", "principal/3",
    "speed", "energy",   "wavespeed", "principal",   "force",       "fx",          "fy",
    "fz",    "angmom",   "angmom/x",  "angmom/y",    "angmom/z",    "xu",          "yu",
    "zu",    "xs",       "ys",        "zs",          "xsu",         "ysu",         "zsu",
    "proc",  "procp1",   "omega",     "omegax",      "omegay",      "omegaz",      "torque",
    "tqx",   "tqy",      "tqz"};

bool begins(const std::string &name, const std::string &head)
{
  return name.compare(0, head.size(), head) == 0;
}

/** The number behind a colon, which is cut off; -1: there is none. */
int cut_component(std::string &name)
{
  const auto colon = name.rfind(':');
  if (colon == std::string::npos || colon + 1 == name.size() || colon + 4 < name.size()) return -1;
  const std::string digits = name.substr(colon + 1);
  if (digits.find_first_not_of("0123456789") != std::string::npos) return -1;
  name.resize(colon);
  return atoi(digits.c_str());
}

}    // namespace

bool CreatePointsSite::wrap(Domain *domain)
{
  for (int d = 0; d < 3; d++) {
    const double reach = domain->periodicity[d] ? domain->prd[d] : 0.0;
    if (!(x[d] >= domain->boxlo[d] - reach && x[d] < domain->boxhi[d] + reach)) return false;
  }
  domain->remap(x, image);
  return true;
}

/** d_name, i_name, or of arrays d2_name[k], d2_name:k, of fix property/atom. */
bool MPMPointColumns::find_property(const std::string &full, Column &column) const
{
  std::string name = full;
  int component = cut_component(name);
  const auto bracket = name.find('[');
  if (component < 0 && bracket != std::string::npos) {
    component = atoi(name.c_str() + bracket + 1) - 1;
    name.resize(bracket);
  }
  const bool array = begins(name, "d2_") || begins(name, "i2_");
  if (!array && !begins(name, "d_") && !begins(name, "i_")) return false;
  int flag, columns;
  column.index = atom->find_custom(name.c_str() + (array ? 3 : 2), flag, columns);
  column.is_integer = name[0] == 'i';
  column.is_array = columns > 0;
  column.component = std::max(component, 0);
  return column.index >= 0 && flag == !column.is_integer &&
      (columns > 0 ? component >= 0 && component < columns : component < 0);
}

MPMPointColumns::Column MPMPointColumns::column_of(const std::string &name) const
{
  std::string head = name;
  const int part = cut_component(head);
  for (const auto &one : known)
    for (std::size_t k = 0; k < one.components.size(); k++)
      if (name == one.components[k] || (one.name && head == one.name && part == (int) k))
        return {name, one.kind, (int) k};
  if (head == "stress" && part >= 0 && part < 9)
    return {name, tensor_component[part] < 0 ? FOLLOWS : STRESS, tensor_component[part]};
  Column column = {name, PROPERTY};
  if (find_property(name, column)) return column;
  for (const auto *material : find_fixes<FixMPMMaterial>(lmp))
    if (material->find_history(name) >= 0) return {name, HISTORY};
  for (const auto *physics : find_fixes<MPMPhysics>(lmp)) {
    const auto all = physics->quantities();
    if (std::find(all.begin(), all.end(), name) != all.end()) return {name, FOLLOWS};
  }
  if (follows.count(head) || begins(name, "c_") || begins(name, "f_") || begins(name, "v_"))
    return {name, FOLLOWS};
  return {name, UNKNOWN};
}

MPMPointColumns::Kind MPMPointColumns::add(const std::string &name)
{
  columns.push_back(name.empty() ? Column{name, FOLLOWS} : column_of(name));
  return columns.back().kind;
}

std::string MPMPointColumns::component_name(const std::string &name, int c, int width)
{
  static const char *const stress[6] = {"xx", "yy", "zz", "xy", "xz", "yz"};
  if (name == "stress" && width == 6) return name + "/" + stress[c];
  return width == 1 ? name : name + ":" + std::to_string(c);
}

void MPMPointColumns::leave(Kind kind)
{
  for (auto &column : columns)
    if (column.kind == kind) column.kind = FOLLOWS;
}

int MPMPointColumns::find(Kind kind, int component) const
{
  for (std::size_t c = 0; c < columns.size(); c++)
    if (columns[c].kind == kind && columns[c].component == component) return (int) c;
  return -1;
}

bool MPMPointColumns::has_state() const
{
  return std::any_of(columns.begin(), columns.end(), [](const Column &c) {
    return c.kind == DEFORMATION || c.kind == STRESS || c.kind == HISTORY;
  });
}

std::string MPMPointColumns::wrong(int c, double value) const
{
  const auto &column = columns[c];
  const bool whole = column.kind == ID || column.kind == TYPE || column.kind == IMAGE ||
      (column.kind == PROPERTY && column.is_integer);
  if (whole && (value != std::floor(value) || std::fabs(value) > 9.0e15))
    return "must be an integer";
  if (column.kind == PROPERTY && column.is_integer && std::fabs(value) > MAXSMALLINT)
    return "is too large for an integer";
  if (column.kind == ID && (value < 1.0 || value > (double) MAXTAGINT))
    return "must be positive and at most " + std::to_string(MAXTAGINT);
  if (column.kind == IMAGE && std::fabs(value) >= IMGMAX) return "is too large";
  const bool positive = column.kind == VOLUME0 || column.kind == VOLUME || column.kind == MASS ||
      column.kind == DENSITY || column.kind == RADIUS;
  if (positive && !(value > 0.0))
    return "must be positive; leave out what is no material point, by groups of a dump or keyword "
           "part";
  const bool across = (column.kind == PLACE || column.kind == VELOCITY) && column.component == 2;
  // of a deformation gradient, xz yz zx zy
  const bool sheared = column.kind == DEFORMATION && column.component != 8 &&
      (column.component % 3 == 2 || column.component > 5);
  if ((across || sheared) && domain->dimension == 2 && value != 0.0)
    return "must be 0 in a 2d simulation";
  return "";
}

void MPMPointColumns::set(int first, const std::vector<double> &rows) const
{
  auto *points = MPMPoints::get(atom);
  const auto materials = find_fixes<FixMPMMaterial>(lmp);
  const int n = columns.empty() ? 0 : (int) (rows.size() / columns.size());
  for (int k = 0; k < n; k++) set_one(*points, materials, first + k, &rows[k * columns.size()]);
}

void MPMPointColumns::set_one(MPMPoints &points, const std::vector<FixMPMMaterial *> &materials,
                              int i, const double *row) const
{
  double sigma[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  int image[3] = {0, 0, 0};
  bool has_stress = false, has_image = false;
  for (std::size_t c = 0; c < columns.size(); c++) {
    const auto &column = columns[c];
    const double value = row[c];
    switch (column.kind) {
      case VELOCITY:
        atom->v[i][column.component] = value;
        break;
      case DEFORMATION:
        points.F[i][column.component] = value;
        break;
      case STRESS:
        sigma[column.component] = value;
        has_stress = true;
        break;
      case MASS:
        atom->rmass[i] = value;
        break;
      case RADIUS:
        if (atom->radius_flag) atom->radius[i] = column.component ? 0.5 * value : value;
        break;
      case IMAGE:
        image[column.component] = (int) value;
        has_image = true;
        break;
      case HISTORY:
        for (const auto *material : materials) {
          const int k = material->find_history(column.name);
          if (k >= 0 && (atom->mask[i] & material->groupbit)) material->history[i][k] = value;
        }
        break;
      case PROPERTY:
        if (column.is_integer)
          (column.is_array ? atom->iarray[column.index][i][column.component]
                           : atom->ivector[column.index][i]) = (int) value;
        else
          (column.is_array ? atom->darray[column.index][i][column.component]
                           : atom->dvector[column.index][i]) = value;
        break;
      default:
        break;
    }
  }
  if (has_stress) {
    const double J = points.jacobian(i);
    for (int k = 0; k < 6; k++) points.tau[i][k] = J * sigma[k];
  }
  if (has_image) {
    // the place of the file may have been outside of the box, as between two neighbor lists, and
    // was wrapped
    const imageint wrapped = atom->image[i];
    image[0] += (int) (wrapped & IMGMASK) - IMGMAX;
    image[1] += (int) (wrapped >> IMGBITS & IMGMASK) - IMGMAX;
    image[2] += (int) (wrapped >> IMG2BITS) - IMGMAX;
    atom->image[i] = ((imageint) (image[0] + IMGMAX) & IMGMASK) |
        (((imageint) (image[1] + IMGMAX) & IMGMASK) << IMGBITS) |
        (((imageint) (image[2] + IMGMAX) & IMGMASK) << IMG2BITS);
  }
}

std::string MPMPointColumns::missing() const
{
  std::string text;
  const auto need = [&](Kind kind, const std::string &what) {
    if (std::none_of(columns.begin(), columns.end(), [&](const Column &c) {
          return c.kind == kind;
        }))
      text += (text.empty() ? "" : ", ") + what;
  };
  need(VELOCITY, "velocity");
  need(DEFORMATION, "F");
  need(STRESS, "stress");
  for (const auto *fix : find_fixes<FixMPMState>(lmp)) {
    std::string names;
    if (const auto *material = dynamic_cast<const FixMPMMaterial *>(fix)) {
      for (const auto &variable : material->material->history())
        if (std::none_of(columns.begin(), columns.end(), [&](const Column &c) {
              return c.kind == HISTORY && c.name == variable.name;
            }))
          names += " " + variable.name;
    } else
      names = fix->keeps();
    if (!names.empty())
      text += (text.empty() ? "" : ", ") + names.substr(names[0] == ' ') + " of fix " + fix->id;
  }
  return text;
}

int MPMPointColumns::same(int c) const
{
  const auto &mine = columns[c];
  if (mine.kind >= FOLLOWS) return -1;
  for (int k = 0; k < c; k++) {
    const auto &other = columns[k];
    const bool radius = mine.kind == RADIUS;    // or diameter
    if (other.kind == mine.kind && (radius || other.component == mine.component) &&
        other.index == mine.index && other.is_integer == mine.is_integer &&
        other.is_array == mine.is_array && (mine.kind != HISTORY || other.name == mine.name))
      return k;
  }
  return -1;
}

std::string MPMPointColumns::names() const
{
  std::string text;
  for (const auto &column : columns) text += (column.name.empty() ? "NULL" : column.name) + " ";
  return text;
}

std::string MPMPointColumns::names(bool taken) const
{
  std::string text;
  for (const auto &column : columns)
    if (!column.name.empty() && (column.kind != FOLLOWS) == taken) text += " " + column.name;
  return text;
}
