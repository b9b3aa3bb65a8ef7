/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/element.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>
#include <stdexcept>
#include <unordered_map>

using namespace MPM_NS;

namespace {

constexpr int64_t MAX_COUNT = 2000000000;    // nodes or elements

/** Words of a file, which may be spread over lines at will; knows the line for messages. */
class Words {
 public:
  Words(std::istream &in, const std::string &name) : in(in), name(name), line(0), pos(0) {}

  [[noreturn]] void fail(const std::string &what) const
  {
    throw std::runtime_error(name + ":" + std::to_string(line) + ": " + what);
  }

  bool next(std::string &word)
  {
    for (;;) {
      pos = text.find_first_not_of(" \t\r", pos);
      if (pos != std::string::npos) break;
      if (!std::getline(in, text)) return false;
      line++;
      pos = 0;
    }
    const std::size_t end = std::min(text.find_first_of(" \t\r", pos), text.size());
    word.assign(text, pos, end - pos);
    pos = end;
    return true;
  }

  void rest_of_line(std::string &rest)
  {
    rest.assign(text, std::min(pos, text.size()), std::string::npos);
    pos = text.size();
  }

  double real()
  {
    char *end;
    need();
    const double value = strtod(word.c_str(), &end);
    if (*end || !std::isfinite(value)) fail("'" + word + "' is not a number");
    return value;
  }

  int64_t integer(int64_t low = -MAX_COUNT * MAX_COUNT, int64_t high = MAX_COUNT * MAX_COUNT)
  {
    char *end;
    need();
    const long long value = strtoll(word.c_str(), &end, 10);
    if (*end) fail("'" + word + "' is not an integer");
    if (value < low || value > high) fail("the number " + word + " is out of range");
    return value;
  }

  int64_t count() { return integer(0, MAX_COUNT); }
  int tag() { return (int) integer(-MAX_COUNT, MAX_COUNT); }
  std::array<double, 3> position() { return {real(), real(), real()}; }
  void skip(int64_t n)
  {
    for (; n > 0; n--) need();
  }

  void expect(const std::string &wanted)
  {
    need();
    if (word != wanted) fail("found '" + word + "' where " + wanted + " should be");
  }

 private:
  void need()
  {
    if (!next(word)) fail("the file ends too early");
  }

  std::istream &in;
  std::string name, text, word;
  int line;
  std::size_t pos;
};

/** The mesh while it is read. */
struct Reader {
  Words &in;
  Mesh &mesh;
  std::unordered_map<int64_t, int> place;          // of the nodes, by number
  std::map<std::pair<int, int>, int> of_entity;    // 4.1: (dimension, entity) -> physical group

  void physical_names()
  {
    for (int64_t n = in.count(); n > 0; n--) {
      const int dim = in.integer(0, 3), tag = in.tag();
      std::string rest;
      in.rest_of_line(rest);
      const auto first = rest.find('"'), last = rest.rfind('"');
      if (first == std::string::npos || first == last)
        in.fail("the name of a physical group must be in double quotes");
      mesh.groups[{dim, tag}] = rest.substr(first + 1, last - first - 1);
    }
  }

  void add_node(int64_t label, const std::array<double, 3> &x)
  {
    if (!place.emplace(label, (int) mesh.nodes.size()).second)
      in.fail("node " + std::to_string(label) + " is defined twice");
    mesh.nodes.push_back(x);
  }

  void nodes_2()
  {
    for (int64_t n = in.count(); n > 0; n--) {
      const int64_t label = in.integer();
      add_node(label, in.position());
    }
  }

  void entities()
  {
    int64_t n[4];
    for (auto &k : n) k = in.count();
    for (int dim = 0; dim < 4; dim++)
      for (; n[dim] > 0; n[dim]--) {
        const int tag = in.tag();
        for (int k = 0; k < (dim ? 6 : 3); k++) in.real();
        const int64_t ngroups = in.count();
        for (int64_t k = 0; k < ngroups; k++) {
          const int group = in.tag();
          if (k == 0) of_entity[{dim, tag}] = std::abs(group);    // negative: reversed
        }
        if (dim) in.skip(in.count());
      }
  }

  void nodes_4()
  {
    const int64_t nblocks = in.count();
    in.skip(3);
    std::vector<int64_t> labels;
    for (int64_t b = 0; b < nblocks; b++) {
      const int dim = in.integer(0, 3);
      in.skip(1);
      const bool parametric = in.integer(0, 1) != 0;
      labels.resize(in.count());
      for (auto &label : labels) label = in.integer();
      for (const auto label : labels) {
        const auto x = in.position();
        if (parametric) in.skip(dim);
        add_node(label, x);
      }
    }
  }

  /** A type of elements, which has another number in Gmsh. */
  struct Kind {
    int nnodes;
    bool kept;
    ElementType type;    // of those that are kept
  };

  Kind kind()
  {
    const int type = (int) in.count();
    if (type >= 2 && type <= 5) {
      const auto kept = static_cast<ElementType>(type - 2);
      return {element_nodes(kept), true, kept};
    }
    if (type == 1) return {2, true, ElementType::LINE};
    if (type == 15) return {1, false, {}};    // a point
    const std::string have =
        ", which is not supported: only lines, triangles, quadrangles, tetrahedra, "
        "and hexahedra of first order are";
    if (type == 6 || type == 7)
      in.fail(std::string("the mesh has a ") + (type == 6 ? "prism" : "pyramid") + have);
    in.fail("the mesh has an element of Gmsh's type " + std::to_string(type) + have +
            " (Gmsh's option Mesh.ElementOrder = 1)");
  }

  void element(int64_t label, int physical, const Kind &kind)
  {
    MeshElement e = {kind.type, physical, label, {0, 0, 0, 0, 0, 0, 0, 0}};
    for (int k = 0; k < kind.nnodes; k++) {
      const int64_t node = in.integer();
      if (!kind.kept) continue;
      const auto found = place.find(node);
      if (found == place.end())
        in.fail("element " + std::to_string(label) + " has the node " + std::to_string(node) +
                ", which the file does not define");
      e.node[k] = found->second;
      for (int j = 0; j < k; j++)
        if (e.node[j] == e.node[k])
          in.fail("element " + std::to_string(label) + " has the node " + std::to_string(node) +
                  " twice");
    }
    if (kind.kept) mesh.elements.push_back(e);
  }

  void elements_2()
  {
    for (int64_t n = in.count(); n > 0; n--) {
      const int64_t label = in.integer();
      const Kind type = kind();
      const int64_t ntags = in.count();
      const int physical = ntags ? in.tag() : 0;
      in.skip(ntags - 1);
      element(label, physical, type);
    }
  }

  void elements_4()
  {
    const int64_t nblocks = in.count();
    in.skip(3);
    for (int64_t b = 0; b < nblocks; b++) {
      const int dim = in.integer(0, 3), entity = in.tag();
      const Kind type = kind();
      const auto found = of_entity.find({dim, entity});
      const int physical = found == of_entity.end() ? 0 : found->second;
      for (int64_t n = in.count(); n > 0; n--) element(in.integer(), physical, type);
    }
  }

  /** The same nodes twice would be twice the mass. */
  void check_repeated()
  {
    std::map<std::array<int, 8>, int64_t> seen;
    for (const auto &e : mesh.elements) {
      if (e.type == ElementType::LINE) continue;    // often the rim of a body, see keep()
      std::array<int, 8> key;
      key.fill(-1);
      const int n = element_nodes(e.type);
      std::copy(e.node, e.node + n, key.begin());
      std::sort(key.begin(), key.begin() + n);
      const auto found = seen.emplace(key, e.label);
      if (!found.second)
        in.fail("elements " + std::to_string(found.first->second) + " and " +
                std::to_string(e.label) +
                " have the same nodes; Gmsh's format 2.2 repeats an element that is in two "
                "physical groups");
    }
  }
};

}    // namespace

/* ---------------------------------------------------------------------- */

Mesh MPM_NS::read_gmsh(std::istream &stream, const std::string &name)
{
  Mesh mesh;
  Words in(stream, name);
  Reader reader = {in, mesh, {}, {}};
  std::string word;

  if (!in.next(word) || word != "$MeshFormat")
    in.fail("this is not a mesh file of Gmsh, which begins with $MeshFormat");
  in.next(word);
  const bool old = word == "2.2" || word == "2";
  if (!old && word != "4.1")
    in.fail("the format " + word + " of Gmsh is not supported: save as version 2.2 or 4.1");
  if (in.count() != 0)
    in.fail("binary files are not supported: save as ASCII (Gmsh: without -bin)");
  in.count();
  in.expect("$EndMeshFormat");

  bool have_nodes = false, have_elements = false;
  while (in.next(word)) {
    if (word.size() < 2 || word[0] != '$') in.fail("found '" + word + "' between sections");
    const std::string section = word.substr(1);
    if (section == "PhysicalNames")
      reader.physical_names();
    else if (section == "Entities" && !old)
      reader.entities();
    else if (section == "Nodes") {
      old ? reader.nodes_2() : reader.nodes_4();
      have_nodes = true;
    } else if (section == "Elements") {
      if (!have_nodes) in.fail("elements come before nodes");
      old ? reader.elements_2() : reader.elements_4();
      have_elements = true;
    } else {    // comments, data, partitions, ...
      while (word != "$End" + section)
        if (!in.next(word)) in.fail("section $" + section + " has no end");
      continue;
    }
    in.expect("$End" + section);
  }
  if (!have_nodes || !have_elements) in.fail("the file has no nodes or no elements");
  reader.check_repeated();
  return mesh;
}

/* ---------------------------------------------------------------------- */

Mesh MPM_NS::read_gmsh(const std::string &file)
{
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot open the mesh file " + file);
  return read_gmsh(in, file);
}

/* ---------------------------------------------------------------------- */

void Mesh::keep(int dim, const std::string &group)
{
  int tag = 0;
  if (!group.empty()) {
    bool found = false;
    for (const auto &g : groups)
      if (g.first.first == dim && g.second == group) {
        tag = g.first.second;
        found = true;
      }
    char *end;
    if (!found) tag = (int) strtol(group.c_str(), &end, 10);
    if (!found && *end)
      throw std::runtime_error("the mesh has no physical group '" + group + "' of dimension " +
                               std::to_string(dim));
  }
  std::size_t n = 0;
  for (const auto &e : elements)
    if (element_dimension(e.type) == dim && (group.empty() || e.physical == tag)) elements[n++] = e;
  elements.resize(n);
  if (n == 0)
    throw std::runtime_error("the mesh has no elements of dimension " + std::to_string(dim) +
                             (group.empty() ? "" : " in the physical group " + group));

  std::set<std::pair<int, int>> lines;
  for (const auto &e : elements)
    if (dim == 1 && !lines.insert(std::minmax(e.node[0], e.node[1])).second)
      throw std::runtime_error("the line " + std::to_string(e.label) +
                               " of the mesh has the nodes of another line");

  std::vector<int> place(nodes.size(), -1);
  for (const auto &e : elements)
    for (int k = 0; k < element_nodes(e.type); k++) place[e.node[k]] = 0;
  int next = 0;
  for (std::size_t i = 0; i < nodes.size(); i++) {
    if (place[i] < 0) continue;
    nodes[next] = nodes[i];
    place[i] = next++;
  }
  nodes.resize(next);
  for (auto &e : elements)
    for (int k = 0; k < element_nodes(e.type); k++) e.node[k] = place[e.node[k]];
}

/* ---------------------------------------------------------------------- */

void Mesh::orient()
{
  for (auto &e : elements) {
    if (size(e) >= 0.0) continue;
    if (e.type == ElementType::HEXAHEDRON)
      for (int k = 0; k < 4; k++) std::swap(e.node[k], e.node[4 + k]);
    else
      std::swap(e.node[1], e.node[e.type == ElementType::QUAD ? 3 : 2]);
  }
}

/* ---------------------------------------------------------------------- */

double Mesh::size(const MeshElement &e) const
{
  const auto &rule = ElementRule::of(e.type);
  double x[MAX_ELEMENT_NODES][3], g[MAX_ELEMENT_NODES][3], sum = 0.0;
  for (int k = 0; k < rule.nnode; k++)
    for (int d = 0; d < 3; d++) x[k][d] = nodes[e.node[k]][d];
  for (int q = 0; q < rule.npoint; q++) sum += rule.gradients(q, x, g);
  return sum;
}
