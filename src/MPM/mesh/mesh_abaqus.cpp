/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/mesh_file.h"
#include "mesh/vector3.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <unordered_map>

using namespace MPM_NS;
using namespace MPM_NS::vector3;

namespace {

class AbaqusReader {
 public:
  AbaqusReader(std::istream &in, const std::string &name) : in(in), name(name) {}

  Mesh read()
  {
    std::string text;
    while (std::getline(in, text)) {
      line++;
      if (!text.empty() && text.back() == '\r') text.pop_back();
      if (text.compare(0, 2, "**") == 0 || text.find_first_not_of(" \t") == std::string::npos)
        continue;
      if (text[0] == '*')
        keyword(text);
      else if (section == NODE)
        node(text);
      else if (section == ELEMENT)
        element(text);
      else if (section == ELSET)
        members(text);
      else if (section == INSTANCE)
        place(text);
    }
    if (!row.empty()) fail("the last element has too few nodes");
    for (std::size_t k = parts.size() > 1 ? 1 : 0; k < parts.size(); k++)
      for (const auto &set : parts[k].late) {
        line = set.line;
        add_to_set(parts[k].mesh, set.name, members_of(set, parts[k].mesh, &parts[k].element_place),
                   0);
      }
    assemble();
    if (mesh.nodes.empty() || mesh.elements.empty()) fail("the file has no nodes or no elements");
    try {
      mesh.check_repeated();
    } catch (const std::runtime_error &e) {
      fail(e.what());
    }
    return std::move(mesh);
  }

 private:
  enum Section { OTHER, NODE, ELEMENT, ELSET, INSTANCE };
  struct Late {    // a set, which may come before its elements or other sets
    std::string name;
    std::vector<std::string> members;
    std::vector<std::array<int64_t, 3>> ranges;    // first, last, step
    std::string instance;                          // that its members are of, in an assembly
    int line;
  };
  struct Part {
    std::string name;
    Mesh mesh;
    std::unordered_map<int64_t, int> node_place, element_place;
    std::vector<Late> late;
  };
  struct Instance {
    std::string name, part;
    std::vector<std::vector<double>> lines;    // translation; two points of the axis, and angle
    int line;
  };
  std::istream &in;
  std::string name;
  int line = 0;
  Section section = OTHER;
  Mesh mesh;                     // of all
  std::vector<Part> parts{1};    // the first one is what is outside of *PART
  std::size_t now = 0;           // the present one
  std::vector<Instance> instances;
  std::vector<Late> of_assembly;
  ElementType type = ElementType::TRIANGLE;
  bool left_out = false, generate = false;
  int nnodes = 0, set = -1;
  std::vector<int64_t> row;    // of an element, which may go on in the next line
  Late *list = nullptr;        // the present set

  [[noreturn]] void fail(const std::string &what) const
  {
    throw std::runtime_error(name + ":" + std::to_string(line) + ": " + what);
  }

  static std::string upper(std::string text)
  {
    std::string all;
    for (const char c : text)
      if (c != ' ' && c != '\t') all += (char) toupper(c);
    return all;
  }
  static std::vector<std::string> split(const std::string &text)
  {
    std::vector<std::string> words;
    std::string word;
    for (const char c : text + ",")
      if (c == ',') {
        const auto first = word.find_first_not_of(" \t"), last = word.find_last_not_of(" \t");
        words.push_back(first == std::string::npos ? "" : word.substr(first, last - first + 1));
        word.clear();
      } else
        word += c;
    if (words.back().empty()) words.pop_back();    // a comma at the end of a line
    return words;
  }
  /** What has this name in a list, in upper or lower case; its end: nothing. */
  template <class List> static auto find_named(List &list, const std::string &name)
  {
    return std::find_if(list.begin(), list.end(), [&](const auto &each) {
      return upper(each.name) == upper(name);
    });
  }
  double real(const std::string &word, const std::string &what) const
  {
    char *end;
    const double value = strtod(word.c_str(), &end);
    if (word.empty() || *end || !std::isfinite(value)) fail("'" + word + "' is not " + what);
    return value;
  }
  int64_t integer(const std::string &word) const
  {
    char *end;
    const long long value = strtoll(word.c_str(), &end, 10);
    if (word.empty() || *end || value < 0)
      fail("'" + word + "' is not a number of a node or an element");
    return value;
  }

  void keyword(const std::string &text)
  {
    if (!row.empty()) fail("the element before has too few nodes");
    const auto words = split(text);
    const std::string key = upper(words[0]);
    std::string kind, of, called, part, instance;
    generate = false;
    for (std::size_t k = 1; k < words.size(); k++) {
      const auto equal = words[k].find('=');
      const std::string option = upper(words[k].substr(0, equal));
      const std::string value = equal == std::string::npos ? "" : words[k].substr(equal + 1);
      const auto first = value.find_first_not_of(" \t\"");
      const std::string bare = first == std::string::npos
          ? ""
          : value.substr(first, value.find_last_not_of(" \t\"") - first + 1);
      if (option == "TYPE") kind = upper(bare);
      if (option == "ELSET") of = bare;
      if (option == "NAME") called = bare;
      if (option == "PART") part = bare;
      if (option == "INSTANCE") instance = bare;
      if (option == "GENERATE") generate = true;
      if (option == "INPUT" && (key == "*NODE" || key == "*ELEMENT" || key == "*ELSET"))
        fail("the option INPUT of " + key + " is not supported: put the lines into this file");
    }
    section = OTHER;
    if (key == "*INCLUDE") fail("*INCLUDE is not supported: put the lines into this file");
    if (key == "*NODE")
      section = NODE;
    else if (key == "*ELEMENT") {
      section = ELEMENT;
      find_type(kind);
      set = of.empty() ? -1 : number_of(parts[now].mesh, of);
    } else if (key == "*ELSET") {
      if (of.empty()) fail("*ELSET needs the option ELSET");
      section = ELSET;
      auto &all = instance.empty() ? parts[now].late : of_assembly;
      all.push_back({of, {}, {}, instance, line});
      list = &all.back();
    } else if (key == "*PART") {
      if (called.empty()) fail("*PART needs the option NAME");
      if (find_part(called)) fail("the part " + called + " is defined twice");
      now = parts.size();
      parts.emplace_back();
      parts.back().name = called;
    } else if (key == "*ENDPART")
      now = 0;
    else if (key == "*INSTANCE") {
      if (called.empty() || part.empty()) fail("*INSTANCE needs the options NAME and PART");
      section = INSTANCE;
      instances.push_back({called, part, {}, line});
    }
  }

  /** Numbers in the names of elements: nodes; letters after them: how they are integrated. */
  void find_type(const std::string &kind)
  {
    const auto begins = [&](const std::string &word) {
      return kind.compare(0, word.size(), word) == 0 &&
          (kind.size() == word.size() || !isdigit(kind[word.size()]));
    };
    const auto any = [&](const std::vector<std::string> &list) {
      return std::any_of(list.begin(), list.end(), begins);
    };
    left_out = false;
    if (any({"CPE3", "CPS3", "CAX3", "S3", "STRI3", "R3D3", "M3D3"}))
      type = ElementType::TRIANGLE;
    else if (any({"CPE4", "CPS4", "CAX4", "S4", "R3D4", "M3D4"}))
      type = ElementType::QUAD;
    else if (begins("C3D4"))
      type = ElementType::TETRAHEDRON;
    else if (begins("C3D8"))
      type = ElementType::HEXAHEDRON;
    else if (any({"T2D2", "T3D2", "B21", "B31", "MASS"}))
      left_out = true;
    else
      fail("elements of type '" + kind +
           "' are not supported: only CPE3, CPE4, C3D4, C3D8, and others with the same nodes are");
    nnodes = element_nodes(type);
  }

  static int number_of(Mesh &mesh, const std::string &of)
  {
    const auto found = find_named(mesh.sets, of) - mesh.sets.begin();
    if (found == (std::ptrdiff_t) mesh.sets.size()) mesh.sets.push_back({of, {}});
    return (int) found;
  }

  void node(const std::string &text)
  {
    const auto words = split(text);
    if (words.size() < 3) fail("a node needs a number and two or three coordinates");
    std::array<double, 3> x = {0.0, 0.0, 0.0};
    for (std::size_t d = 0; d < 3 && d + 1 < words.size(); d++)
      x[d] = real(words[d + 1], "a coordinate");
    auto &mine = parts[now];
    if (!mine.node_place.emplace(integer(words[0]), (int) mine.mesh.nodes.size()).second)
      fail("node " + words[0] + " is defined twice: put parts between *PART and *END PART");
    mine.mesh.nodes.push_back(x);
  }

  void element(const std::string &text)
  {
    if (left_out) return;
    auto &mine = parts[now];
    for (const auto &word : split(text)) row.push_back(integer(word));
    if ((int) row.size() < nnodes + 1) return;
    if ((int) row.size() > nnodes + 1)
      fail("element " + std::to_string(row[0]) + " has too many nodes");
    MeshElement e = {type, 0, row[0], {0, 0, 0, 0, 0, 0, 0, 0}};
    for (int k = 0; k < nnodes; k++) {
      const auto found = mine.node_place.find(row[k + 1]);
      if (found == mine.node_place.end())
        fail("element " + std::to_string(row[0]) + " has the node " + std::to_string(row[k + 1]) +
             ", which the file does not define before");
      e.node[k] = found->second;
      for (int j = 0; j < k; j++)
        if (e.node[j] == e.node[k])
          fail("element " + std::to_string(row[0]) + " has the node " + std::to_string(row[k + 1]) +
               " twice");
    }
    const int place = (int) mine.mesh.elements.size();
    if (!mine.element_place.emplace(row[0], place).second)
      fail("element " + std::to_string(row[0]) +
           " is defined twice: put parts between *PART and *END PART");
    if (set >= 0) mine.mesh.sets[set].elements.push_back(place);
    mine.mesh.elements.push_back(e);
    row.clear();
  }

  void members(const std::string &text)
  {
    auto words = split(text);
    if (!generate) {
      list->members.insert(list->members.end(), words.begin(), words.end());
      return;
    }
    if (words.size() == 2) words.push_back("1");
    if (words.size() != 3)
      fail("GENERATE needs the first and the last number, and may have a step");
    list->ranges.push_back({integer(words[0]), integer(words[1]), integer(words[2])});
    if (list->ranges.back()[2] < 1) fail("the step of GENERATE must be positive");
  }

  /** A line of *INSTANCE. */
  void place(const std::string &text)
  {
    auto &mine = instances.back();
    const std::size_t most = mine.lines.empty() ? 3 : 7;
    std::vector<double> numbers;
    for (const auto &word : split(text))
      numbers.push_back(real(word, "a number of where the instance " + mine.name + " is"));
    if (mine.lines.size() == 2 || numbers.size() > most || (most == 7 && numbers.size() != 7))
      fail("the instance " + mine.name +
           " needs three numbers of its translation, and may have seven of a rotation");
    numbers.resize(most, 0.0);
    if (most == 7 && numbers[0] == numbers[3] && numbers[1] == numbers[4] &&
        numbers[2] == numbers[5])
      fail("the axis of the instance " + mine.name + " has no direction");
    mine.lines.push_back(numbers);
  }

  Part *find_part(const std::string &of)
  {
    const auto found = find_named(parts, of);    // what is outside of parts has no name
    return found == parts.end() ? nullptr : &*found;
  }

  /** A node of a part at its place in the assembly: moved, and then turned around an axis by an
   *  angle in degrees (O. Rodrigues). */
  static std::array<double, 3> moved(const Instance &of, std::array<double, 3> x)
  {
    if (of.lines.empty()) return x;
    for (int d = 0; d < 3; d++) x[d] += of.lines[0][d];
    if (of.lines.size() == 1) return x;
    const auto &turn = of.lines[1];
    double axis[3], from[3], along = 0.0;
    difference(&turn[3], &turn[0], axis);
    difference(x.data(), &turn[0], from);
    const double length = norm(axis);
    for (int d = 0; d < 3; d++) along += (axis[d] /= length) * from[d];
    const double angle = turn[6] * std::acos(-1.0) / 180.0, c = std::cos(angle),
                 sine = std::sin(angle);
    for (int d = 0; d < 3; d++) {
      const int e = (d + 1) % 3, f = (d + 2) % 3;
      x[d] = turn[d] + c * from[d] + sine * (axis[e] * from[f] - axis[f] * from[e]) +
          (1.0 - c) * along * axis[d];
    }
    return x;
  }

  /** What there is outside of parts, or the parts where instances put them; without instances each
   *  part once, where its nodes are. Sets of parts have the elements of all instances, and each of
   *  several instances is a set. */
  void assemble()
  {
    if (parts.size() == 1) {
      mesh = std::move(parts[0].mesh);
      return;
    }
    if (!parts[0].mesh.elements.empty()) fail("the file has elements in its parts, and outside");
    const bool named = !instances.empty();
    for (std::size_t k = 1; k < parts.size() && !named; k++)
      instances.push_back({parts[k].name, parts[k].name, {}, line});
    std::vector<int> first;    // element of each instance
    for (const auto &each : instances) {
      line = each.line;
      const Part *const part = find_part(each.part);
      if (!part) fail("there is no part " + each.part);
      const int node = (int) mesh.nodes.size(), element = (int) mesh.elements.size();
      first.push_back(element);
      for (const auto &x : part->mesh.nodes) mesh.nodes.push_back(moved(each, x));
      for (auto e : part->mesh.elements) {
        for (int k = 0; k < element_nodes(e.type); k++) e.node[k] += node;
        mesh.elements.push_back(e);
      }
      auto sets = part->mesh.sets;
      MeshSet all{each.name, {}};
      for (int k = 0; k < (int) part->mesh.elements.size(); k++) all.elements.push_back(k);
      if (instances.size() > 1) sets.push_back(all);
      for (const auto &more : sets) add_to_set(mesh, more.name, more.elements, element);
    }
    for (const auto &set : of_assembly) {
      line = set.line;
      const auto of = find_named(instances, set.instance);
      if (of == instances.end()) fail("there is no instance " + set.instance);
      const Part *const part = find_part(of->part);
      add_to_set(mesh, set.name, members_of(set, part->mesh, &part->element_place),
                 first[of - instances.begin()]);
    }
    for (const auto &set : parts[0].late) {    // of other sets of the assembly
      line = set.line;
      add_to_set(mesh, set.name, members_of(set, mesh, nullptr), 0);
    }
  }

  /** Elements of a set, by their numbers, and by other sets of the mesh. elements: places by
   *  number; null: numbers tell nothing. */
  std::vector<int> members_of(const Late &from, const Mesh &of,
                              const std::unordered_map<int64_t, int> *elements) const
  {
    std::vector<int> all;
    for (const auto &word : from.members) {
      if (!word.empty() && word.find_first_not_of("0123456789") == std::string::npos) {
        if (!elements)
          fail("the set " + from.name + " has element " + word +
               ", of an instance it does not name");
        const auto found = elements->find(strtoll(word.c_str(), nullptr, 10));
        if (found != elements->end()) all.push_back(found->second);
        continue;    // else an element that was left out
      }
      const auto known = find_named(of.sets, word);
      if (known == of.sets.end())
        fail("the set " + from.name + " has the set '" + word + "', which is not defined before");
      all.insert(all.end(), known->elements.begin(), known->elements.end());
    }
    if (!from.ranges.empty() && !elements)
      fail("the set " + from.name + " has elements of an instance that it does not name");
    for (const auto &[first, last, step] : from.ranges)
      for (const auto &[label, place] : *elements)    // and not all numbers, which may be very many
        if (label >= first && label <= last && (label - first) % step == 0) all.push_back(place);
    return all;
  }

  /** more: places of elements from a first one on. */
  static void add_to_set(Mesh &mesh, const std::string &of, const std::vector<int> &more, int first)
  {
    auto &all = mesh.sets[number_of(mesh, of)].elements;
    for (const int k : more) all.push_back(first + k);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
  }
};

}    // namespace

Mesh MPM_NS::read_abaqus(std::istream &in, const std::string &name)
{
  return AbaqusReader(in, name).read();
}
