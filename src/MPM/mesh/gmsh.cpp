/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/element.h"
#include "table/regular_file.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <set>
#include <stdexcept>
#include <unordered_map>

using namespace MPM_NS;

namespace {

constexpr int64_t MAX_COUNT = 2000000000;    // nodes or elements

/** Words of a file, which may be spread over lines at will, or bytes; knows the line for
 *  messages. */
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
    const double value = any_real();
    if (!std::isfinite(value))
      fail(binary ? "a number is not finite" : "'" + word + "' is not a number");
    return value;
  }

  /** Also one that is not finite, which matters where it is used only. */
  double any_real()
  {
    if (binary) return bytes<double>();
    char *end;
    need();
    const double value = strtod(word.c_str(), &end);
    if (*end) fail("'" + word + "' is not a number");
    return value;
  }

  /** A line of its own, without the double quotes around it. */
  std::string name_in_quotes()
  {
    std::string rest;
    need();
    rest_of_line(rest);
    rest = word + rest;
    rest.erase(rest.find_last_not_of(" \t\r") + 1);
    if (rest.size() > 1 && rest.front() == '"' && rest.back() == '"')
      return rest.substr(1, rest.size() - 2);
    return rest;
  }

  /** Of a binary file, an int. */
  int64_t integer(int64_t low = -MAX_COUNT * MAX_COUNT, int64_t high = MAX_COUNT * MAX_COUNT)
  {
    if (binary) return in_range(bytes<int32_t>(), low, high);
    char *end;
    need();
    const long long value = strtoll(word.c_str(), &end, 10);
    if (*end) fail("'" + word + "' is not an integer");
    return in_range(value, low, high);
  }

  /** What is a size_t in binary files of format 4.1, and an int in those of format 2.2. */
  int64_t label()
  {
    return binary && !old ? in_range(bytes<int64_t>(), 0, MAX_COUNT * MAX_COUNT) : integer();
  }
  int64_t count()
  {
    return binary && !old ? in_range(bytes<int64_t>(), 0, MAX_COUNT) : integer(0, MAX_COUNT);
  }
  int tag() { return (int) integer(-MAX_COUNT, MAX_COUNT); }
  std::array<double, 3> position() { return {real(), real(), real()}; }
  void skip_reals(int64_t n)
  {
    for (; n > 0; n--) real();
  }
  void skip_integers(int64_t n)
  {
    for (; n > 0; n--) integer();
  }

  /** What follows the present line is bytes, or words again. */
  bool binary = false;
  bool old = false;        ///< format 2.2
  bool swapped = false;    ///< the other order of bytes

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

  int64_t in_range(int64_t value, int64_t low, int64_t high) const
  {
    if (value < low || value > high)
      fail("the number " + std::to_string(value) + " is out of range");
    return value;
  }

  template <class T> T bytes()
  {
    char raw[sizeof(T)];
    if (!in.read(raw, sizeof(T))) fail("the binary file ends too early");
    if (swapped) std::reverse(raw, raw + sizeof(T));
    T value;
    memcpy(&value, raw, sizeof(T));
    return value;
  }

  std::istream &in;
  std::string name, text, word;
  int line;
  std::size_t pos;
};

/** Bytes instead of words, as long as this exists. */
struct InBytes {
  Words &in;
  InBytes(Words &in, bool yes) : in(in) { in.binary = yes; }
  ~InBytes() { in.binary = false; }
};

/** The mesh while it is read. */
struct Reader {
  Words &in;
  Mesh &mesh;
  bool binary;
  std::unordered_map<int64_t, int> place;          // of the nodes, by number
  std::map<std::pair<int, int>, int> of_entity;    // 4.1: (dimension, entity) -> physical group

  /** Data by the numbers of nodes or elements, which may come after them in the file. */
  struct Data {
    MeshData data;    // in the order of labels
    std::vector<int64_t> labels;
  };
  std::vector<Data> data;

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
    int64_t n = in.count();
    const InBytes bytes(in, binary);
    for (; n > 0; n--) {
      const int64_t label = in.label();
      add_node(label, in.position());
    }
  }

  void entities()
  {
    const InBytes bytes(in, binary);
    int64_t n[4];
    for (auto &k : n) k = in.count();
    for (int dim = 0; dim < 4; dim++)
      for (; n[dim] > 0; n[dim]--) {
        const int tag = in.tag();
        in.skip_reals(dim ? 6 : 3);
        const int64_t ngroups = in.count();
        for (int64_t k = 0; k < ngroups; k++) {
          const int group = in.tag();
          if (k == 0) of_entity[{dim, tag}] = std::abs(group);    // negative: reversed
        }
        if (dim) in.skip_integers(in.count());
      }
  }

  void nodes_4()
  {
    const InBytes bytes(in, binary);
    const int64_t nblocks = in.count();
    for (int k = 0; k < 3; k++) in.label();
    std::vector<int64_t> labels;
    for (int64_t b = 0; b < nblocks; b++) {
      const int dim = in.integer(0, 3);
      in.tag();
      const bool parametric = in.integer(0, 1) != 0;
      labels.clear();    // and not made as long as the file says: that may be wrong
      for (int64_t n = in.count(); n > 0; n--) labels.push_back(in.label());
      for (const auto label : labels) {
        const auto x = in.position();
        if (parametric) in.skip_reals(dim);
        add_node(label, x);
      }
    }
  }

  /** A name, real numbers (the time), and integers: step, components, and for how many. */
  void numbers(bool at_nodes)
  {
    Data one;
    one.data.at_nodes = at_nodes;
    for (int64_t n = in.count(), k = 0; k < n; k++) {
      const auto name = in.name_in_quotes();
      if (k == 0) one.data.name = name;
    }
    for (int64_t n = in.count(); n > 0; n--) in.any_real();
    const int64_t nintegers = in.count();
    if (nintegers < 3) in.fail("data must have three integers before their values, or more");
    in.integer();
    one.data.width = (int) in.integer(1, 9);
    int64_t n = in.count();
    in.skip_integers(nintegers - 3);
    const InBytes bytes(in, binary);
    for (; n > 0; n--) {
      one.labels.push_back(in.integer());    // also in binary files of format 4.1
      for (int k = 0; k < one.data.width; k++) one.data.values.push_back(in.any_real());
    }
    data.push_back(std::move(one));
  }

  /** What is missing for a node or an element is not a number. Those of points, which are left out,
   *  are not looked for. */
  void sort_data()
  {
    std::unordered_map<int64_t, int> element_place;
    for (std::size_t k = 0; k < mesh.elements.size() && !data.empty(); k++)
      element_place.emplace(mesh.elements[k].label, (int) k);
    for (auto &one : data) {
      const auto &places = one.data.at_nodes ? place : element_place;
      const std::size_t width = one.data.width,
                        n = one.data.at_nodes ? mesh.nodes.size() : mesh.elements.size();
      std::vector<double> values(n * width, std::nan(""));
      for (std::size_t k = 0; k < one.labels.size(); k++) {
        const auto found = places.find(one.labels[k]);
        if (found == places.end()) continue;
        std::copy_n(one.data.values.begin() + (std::ptrdiff_t)(k * width), width,
                    values.begin() + (std::ptrdiff_t)(found->second * width));
      }
      one.data.values.swap(values);
      mesh.data.push_back(std::move(one.data));
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
    const int type = (int) in.integer(0, MAX_COUNT);
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
      const int64_t node = in.label();
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
    int64_t n = in.count();
    const InBytes bytes(in, binary);
    while (n > 0) {
      // elements of one type follow each other in a binary file, with one head for all of them
      int64_t label = binary ? 0 : in.label();
      const Kind type = kind();
      int64_t same = binary ? in.integer(1, n) : 1;
      const int64_t ntags = in.count();
      for (n -= same; same > 0; same--) {
        if (binary) label = in.label();
        const int physical = ntags ? in.tag() : 0;
        in.skip_integers(ntags - 1);
        element(label, physical, type);
      }
    }
  }

  void elements_4()
  {
    const InBytes bytes(in, binary);
    const int64_t nblocks = in.count();
    for (int k = 0; k < 3; k++) in.label();
    for (int64_t b = 0; b < nblocks; b++) {
      const int dim = in.integer(0, 3), entity = in.tag();
      const Kind type = kind();
      const auto found = of_entity.find({dim, entity});
      const int physical = found == of_entity.end() ? 0 : found->second;
      for (int64_t n = in.count(); n > 0; n--) {
        const int64_t label = in.label();
        element(label, physical, type);
      }
    }
  }
};

}    // namespace

Mesh MPM_NS::read_gmsh(std::istream &stream, const std::string &name)
{
  Mesh mesh;
  Words in(stream, name);
  std::string word;

  if (!in.next(word) || word != "$MeshFormat")
    in.fail("this is not a mesh file of Gmsh, which begins with $MeshFormat, nor one of VTK "
            "(legacy, # vtk "
            "DataFile) or Abaqus (*)");
  in.next(word);
  const bool old = word == "2.2" || word == "2";
  if (!old && word != "4.1")
    in.fail("the format " + word + " of Gmsh is not supported: save as version 2.2 or 4.1");
  in.old = old;
  const bool binary = in.integer(0, 1) == 1;
  in.integer();
  if (binary) {
    const InBytes bytes(in, true);
    const int64_t one = in.integer();
    in.swapped = one == 0x01000000;
    if (one != 1 && !in.swapped)
      in.fail("the head of a binary file has no 1 for the order of bytes");
  }
  Reader reader = {in, mesh, binary, {}, {}, {}};
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
    } else if (section == "NodeData" || section == "ElementData")
      reader.numbers(section == "NodeData");
    else {    // comments, partitions, ...
      while (word != "$End" + section)
        if (!in.next(word)) in.fail("section $" + section + " has no end");
      continue;
    }
    in.expect("$End" + section);
  }
  if (!have_nodes || !have_elements) in.fail("the file has no nodes or no elements");
  reader.sort_data();
  try {
    mesh.check_repeated("; Gmsh's format 2.2 repeats an element that is in two physical groups");
  } catch (const std::runtime_error &e) {
    in.fail(e.what());
  }
  return mesh;
}

Mesh MPM_NS::read_gmsh(const std::string &file)
{
  std::ifstream in(file, std::ios::binary);
  if (!in || is_no_file(file)) throw std::runtime_error("cannot open the mesh file " + file);
  return read_gmsh(in, file);
}

void Mesh::check_repeated(const std::string &hint) const
{
  std::map<std::array<int, 8>, int64_t> seen;
  for (const auto &e : elements) {
    if (e.type == ElementType::LINE) continue;    // often the rim of a body, see keep()
    std::array<int, 8> key;
    key.fill(-1);
    const int n = element_nodes(e.type);
    std::copy(e.node, e.node + n, key.begin());
    std::sort(key.begin(), key.begin() + n);
    const auto found = seen.emplace(key, e.label);
    if (!found.second)
      throw std::runtime_error("elements " + std::to_string(found.first->second) + " and " +
                               std::to_string(e.label) + " have the same nodes" + hint);
  }
}

/** The numbers of what is left: place has for each the number that it gets, or -1. */
static void keep_data(std::vector<MeshData> &data, bool at_nodes, const std::vector<int> &place)
{
  for (auto &d : data) {
    if (d.at_nodes != at_nodes) continue;
    std::size_t n = 0;
    for (std::size_t i = 0; i < place.size(); i++)
      for (int k = 0; k < d.width && place[i] >= 0; k++) d.values[n++] = d.values[i * d.width + k];
    d.values.resize(n);
  }
}

void Mesh::keep(int dim, const std::string &group)
{
  // physical groups of this dimension become sets
  std::map<int, std::size_t> known;
  const bool have_sets = !sets.empty();
  for (int k = 0; k < (int) elements.size() && !have_sets; k++) {
    const auto &e = elements[k];
    if (e.physical == 0 || element_dimension(e.type) != dim) continue;
    const auto [place, is_new] = known.emplace(e.physical, sets.size());
    if (is_new) {
      const auto name = groups.find({dim, e.physical});
      sets.push_back({name == groups.end() ? std::to_string(e.physical) : name->second, {}});
    }
    sets[place->second].elements.push_back(k);
  }

  std::vector<char> wanted(elements.size(), group.empty());
  if (!group.empty()) {
    int tag = 0;
    bool found = false;
    for (const auto &set : sets)
      if (set.name == group) {
        for (const int k : set.elements) wanted[k] = 1;
        found = true;
      }
    char *end;
    if (!found) tag = (int) strtol(group.c_str(), &end, 10);
    if (!found && *end)
      throw std::runtime_error("the mesh has no physical group '" + group + "' of dimension " +
                               std::to_string(dim));
    for (std::size_t k = 0; k < elements.size() && !found; k++)
      wanted[k] = elements[k].physical == tag;
  }
  std::vector<int> element_place(elements.size(), -1);
  std::size_t n = 0;
  int others[4] = {0, 0, 0, 0};
  for (std::size_t k = 0; k < elements.size(); k++) {
    if (!wanted[k]) continue;
    others[element_dimension(elements[k].type)]++;
    if (element_dimension(elements[k].type) != dim) continue;
    element_place[k] = (int) n;
    elements[n++] = elements[k];
  }
  elements.resize(n);
  if (n == 0) {
    std::string text = "the mesh has no elements of dimension " + std::to_string(dim) +
        (group.empty() ? "" : " in the physical group " + group);
    const int other = others[2] > 0 ? 2 : 1;
    if (others[other] > 0)
      text += ", but " + std::to_string(others[other]) + " of dimension " + std::to_string(other) +
          " (keywords thickness and section of create_points mesh and fix mpm/elements make bodies "
          "of surfaces and lines)";
    throw std::runtime_error(text);
  }
  for (auto &set : sets) {
    std::vector<int> left;
    for (const int k : set.elements)
      if (element_place[k] >= 0) left.push_back(element_place[k]);
    set.elements.swap(left);
  }
  keep_data(data, false, element_place);

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
  keep_data(data, true, place);
}

void Mesh::orient(int dim)
{
  for (auto &e : elements) {
    if (element_dimension(e.type) != dim || size(e) >= 0.0) continue;
    if (e.type == ElementType::HEXAHEDRON)
      for (int k = 0; k < 4; k++) std::swap(e.node[k], e.node[4 + k]);
    else
      std::swap(e.node[1], e.node[e.type == ElementType::QUAD ? 3 : 2]);
  }
}

double Mesh::size(const MeshElement &e) const
{
  const auto &rule = ElementRule::of(e.type);
  double x[MAX_ELEMENT_NODES][3], g[MAX_ELEMENT_NODES][3], sum = 0.0;
  for (int k = 0; k < rule.nnode; k++)
    for (int d = 0; d < 3; d++) x[k][d] = nodes[e.node[k]][d];
  for (int q = 0; q < rule.npoint; q++) sum += rule.gradients(q, x, g);
  return sum;
}
