/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// create_points TYPE mesh FILE keyword value ...: a point at each node of a mesh of finite elements
// create_points TYPE elements FILE keyword value ...: a point for each element of a mesh, which is
// its domain with shape cpdi2 of fix mpm

#include "create/create_points_mesh.h"

#include "atom.h"
#include "base/mpm_input.h"
#include "base/mpm_options.h"
#include "comm.h"
#include "create/create_points.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_cpdi.h"
#include "field/mpm_field.h"
#include "group.h"
#include "math/matrix.h"
#include "math_extra.h"
#include "mesh/element.h"
#include "mesh/gmsh.h"
#include "modify.h"
#include "transfer/cpdi.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double TOLERANCE = 1.0e-6;    // of the length of a periodic box

Options CreatePointsMeshOptions::declare(const std::string &command, int dim, bool has_radius,
                                         bool nodes)
{
  using namespace option;
  Options o(command);
  o.add("scale",
        {number(scale, "factor", POSITIVE, "",
                "factor by which the coordinates in the file are multiplied")});
  o.add("move",
        {axes(move, dim, "x y z", ANY_NUMBER, "distance",
              "displacement that is added to the scaled coordinates")});
  o.add("part", {text(part, "name", "name or tag of a physical group of the mesh")})
      .standard("all elements of the dimension of the simulation");
  o.add("types", {word(by_type, {{"one", false}, {"physical", true}})},
        "types of the points: the same for all, or the tag or number of their physical group");
  o.add("groups", {word(by_group, {{"none", false}, {"physical", true}})},
        "additional groups that points join, with the names of their physical groups");
  o.add("data",
        {text(one.name, "name", "name of data in the file, for nodes (mesh) or elements"),
         text(one.quantity, "quantity",
              "quantity of the points that these data give, named like columns of a table; may be "
              "given several times")})
      .standard("none")
      .then([this] {
        data.push_back({one.name, one.quantity, 1.0});
      });
  o.add("factor",
        {text(one.name, "name", "name of data in the file"),
         number(one.factor, "a", ANY_NUMBER, "",
                "factor by which these data are multiplied, for other units; may be given for "
                "several data")})
      .standard("1")
      .then([this] {
        factors.push_back(one);
      });
  if (nodes) thin.declare(o, dim);
  o.add("halve",
        {integer(halve, "N", {0, 6, true},
                 "number of times that edges of elements are halved: 4^N (solids: 8^N) points in "
                 "each element")});
  o.add("diameter",
        {number(diameter, "D", POSITIVE, "distance",
                "diameter of the points in contact with grains")})
      .standard("edge of a cube (2d: square) of the volume");
  o.add("group",
        {text(group_id, "group-ID",
              "group that the points join; it is created if it does not exist")})
      .standard("all");
  o.refuse([this, has_radius, nodes] {
    auto rules = thin.rules();
    rules.push_back({nodes && halve > 0, "halve",
                     "is for points in elements: use create_points elements, or a finer mesh"});
    rules.push_back({!has_radius, "diameter", "needs atom_style hybrid sphere mpm"});
    return rules;
  });
  return o;
}

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

CreatePointsMesh::CreatePointsMesh(LAMMPS *lmp, const CreatePointsMeshOptions &options_given,
                                   const Options &options, bool in_elements, int type,
                                   const char *file, const MPMField *axisymmetric) :
    Pointers(lmp),
    axisymmetric(axisymmetric)
{
  auto given = options_given;
  const int dim = domain->dimension;
  Mesh mesh = read_body(lmp, file, given.part, given.thin.dimension(dim), "Create_points", 2);
  for (auto &x : mesh.nodes)
    for (int d = 0; d < 3; d++) x[d] = d < dim ? given.move[d] + given.scale * x[d] : 0.0;

  for (int k = 0; k < given.halve; k++) mesh.halve_elements();
  for (const auto &factor : given.factors) {
    bool used = false;
    for (auto &data : given.data)
      if (data.name == factor.name) {
        data.factor *= factor.factor;
        used = true;
      }
    if (!used)
      error->all(FLERR, options.where("factor") + 1,
                 "Create_points factor {}: no keyword data takes data of this name", factor.name);
  }
  fields = std::make_unique<MPMMeshFields>(lmp, mesh, !in_elements, type, given.by_type,
                                           given.by_group, given.data);
  if (in_elements)
    find_elements(mesh, file);
  else
    find_nodes(mesh, given.thin, file);
  volume /= sites.size();

  check_periodic(mesh, file);
  wrap(file, in_elements ? "elements" : "nodes");
  if (in_elements && MPMField::all(lmp).empty() && modify->get_fix_by_style("^mpm/mesh$").empty() &&
      comm->me == 0)
    error->warning(
        FLERR,
        "Create_points elements: only centers and volumes of the elements are used, for "
        "there is no fix mpm or mpm/mesh yet: with shape cpdi2, define the fix mpm before");
}

CreatePointsMesh::~CreatePointsMesh() = default;

/** Refuses a mesh that is longer than a periodic box, as it would be wrapped onto itself. */
void CreatePointsMesh::check_periodic(const Mesh &mesh, const char *file) const
{
  for (int d = 0; d < domain->dimension; d++) {
    if (!domain->periodicity[d]) continue;
    const auto [first, last] = std::minmax_element(mesh.nodes.begin(), mesh.nodes.end(),
                                                   [d](const auto &a, const auto &b) {
                                                     return a[d] < b[d];
                                                   });
    const double length = (*last)[d] - (*first)[d];
    if (length > domain->prd[d] * (1.0 + TOLERANCE))
      error->all(
          FLERR, 2,
          "Create_points: mesh {} is {:.6g} long along {}, longer than the periodic box with "
          "{:.6g}, and would overlap itself; enlarge the box, or use the keyword scale",
          file, length, "xyz"[d], domain -> prd[d]);
  }
}

void CreatePointsMesh::wrap(const char *file, const char *what)
{
  bigint outside = 0;
  for (auto &site : sites) outside += !site.wrap(domain);
  if (outside)
    error->all(
        FLERR, 2,
        "Create_points: {} {} of {} are outside of the simulation box, along periodic axes by "
        "more than its length; enlarge the box, or use the keywords scale and move",
        outside, what, file);
}

/** A node gets its share of the volume of the elements around it. */
static constexpr char bad_element[] = "Create_points: element {} of {} has no volume or is twisted";

void CreatePointsMesh::find_nodes(const Mesh &mesh, const MPMThinBody &thin, const char *file)
{
  for (const auto &x : mesh.nodes) sites.push_back({{x[0], x[1], x[2]}, 0.0, 0});
  for (const auto &e : mesh.elements) {
    const auto &rule = ElementRule::of(e.type);
    double x[MAX_ELEMENT_NODES][3], g[MAX_ELEMENT_NODES][3];
    for (int k = 0; k < rule.nnode; k++) MathExtra::copy3(mesh.nodes[e.node[k]].data(), x[k]);
    for (int q = 0; q < rule.npoint; q++) {
      const double w = thin ? thin.across() * rule.gradients_along(q, x, g)
                            : rule.gradients(q, x, g);
      if (!(w > 0.0)) error->all(FLERR, 2, bad_element, e.label, file);
      volume += w;
      for (int k = 0; k < rule.nnode; k++) sites[e.node[k]].volume += w * rule.N[q][k];
    }
  }
}

/** An element is the domain of its point. */
/** Nodes as corners of the domain, by ElementType. */
static constexpr int corner_nodes[][8] = {
    {0, 1, 2, 2}, {0, 1, 3, 2}, {0, 1, 2, 2, 3, 3, 3, 3}, {0, 1, 3, 2, 4, 5, 7, 6}};

void CreatePointsMesh::find_elements(const Mesh &mesh, const char *file)
{
  const int dim = domain->dimension, ncorner = 1 << dim;
  for (const auto &e : mesh.elements) {
    CreatePointsSite site = {{0.0, 0.0, 0.0}, 0.0, 0};
    Corners corner;
    const int *node = corner_nodes[static_cast<int>(e.type)];
    double w[8], g[24];
    for (int c = 0; c < ncorner; c++)
      for (int d = 0; d < dim; d++) corner[dim * c + d] = mesh.nodes[e.node[node[c]]][d];
    site.volume = dim == 2 ? PointDomain<2>::free(corner.data(), w, g)
                           : PointDomain<3>::free(corner.data(), w, g);
    if (!(site.volume > 0.0 && *std::min_element(w, w + ncorner) >= 0.0))
      error->all(FLERR, 2, bad_element, e.label, file);
    for (int c = 0; c < ncorner && axisymmetric; c++)
      if (corner[dim * c] < -1.0e-10 * domain->xprd)
        error->all(FLERR, 2,
                   "Create_points: element {} of {} reaches below x = 0, which is the axis of "
                   "fix mpm {}",
                   e.label, file, axisymmetric->id());
    for (int d = 0; d < dim; d++) {
      for (int c = 0; c < ncorner; c++) site.x[d] += w[c] * corner[dim * c + d];
      for (int c = 0; c < ncorner; c++) corner[dim * c + d] -= site.x[d];
    }
    volume += site.volume;
    sites.push_back(site);
    corners.push_back(corner);
  }
}

void CreatePointsMesh::set_domains(int first)
{
  const int n = domain->dimension << domain->dimension;
  for (auto *field : MPMField::all(lmp)) {
    if (!field->domains || !field->domains->corners) continue;
    for (std::size_t k = 0; k < corners.size(); k++)
      std::copy_n(corners[k].data(), n, field->domains->corners[first + k]);
  }
}

void CreatePoints::parse_mesh(int narg, char **arg)
{
  const std::string what = std::string("create_points ") + arg[1];
  require_arguments(lmp, what, narg, 2, {"file"});
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
  Options options = given.declare(what, dim, atom->radius_flag, !in_elements);
  read_options(lmp, options, narg, arg, 3);
  diameter = given.diameter;
  find_group(options, given.group_id);

  mesh = std::make_unique<CreatePointsMesh>(lmp, given, options, in_elements, type, arg[2], fix);
  volume = mesh->volume;
}

/** All ranks have all sites, and IDs follow their order in the file; returns the number of
 *  points. */
bigint CreatePoints::make_mesh_points()
{
  const bigint n = mesh->sites.size();
  const tagint maxtag = largest_tag();
  check_tags(maxtag, n);
  if (comm->nprocs > 1) comm->coord2proc_setup();
  std::vector<CreatePointsMesh::Corners> mine;
  for (bigint k = 0; k < n; k++) {
    auto &site = mesh->sites[k];
    site.volume /= mesh->fields->jacobian((int) k);
    if (owner(site.x) != comm->me) continue;
    site.tag = atom->tag_enable ? maxtag + k + 1 : 0;
    mesh->fields->add((int) k);
    make_point(site);
    if (!mesh->corners.empty()) mine.push_back(mesh->corners[k]);
  }
  mesh->corners.swap(mine);
  return n;
}
