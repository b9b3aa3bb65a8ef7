/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <unordered_map>

using namespace MPM_NS;

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
    }
    if (!row.empty()) fail("the last element has too few nodes");
    if (mesh.nodes.empty() || mesh.elements.empty()) fail("the file has no nodes or no elements");
    for (const auto &set : late) add_late(set);
    try {
      mesh.check_repeated();
    } catch (const std::runtime_error &e) {
      fail(e.what());
    }
    return std::move(mesh);
  }

 private:
  enum Section { OTHER, NODE, ELEMENT, ELSET };
  struct Late {    // a set, which may come before its elements or other sets
    std::string name;
    std::vector<std::string> members;
    std::vector<std::array<int64_t, 3>> ranges;    // first, last, step
    int line;
  };
  std::istream &in;
  std::string name;
  int line = 0;
  Section section = OTHER;
  Mesh mesh;
  std::unordered_map<int64_t, int> node_place, element_place;
  ElementType type = ElementType::TRIANGLE;
  bool left_out = false, generate = false;
  int nnodes = 0, set = -1;
  std::vector<int64_t> row;    // of an element, which may go on in the next line
  std::vector<Late> late;

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
    std::string kind, of;
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
      set = of.empty() ? -1 : number_of(of);
    } else if (key == "*ELSET") {
      if (of.empty()) fail("*ELSET needs the option ELSET");
      section = ELSET;
      late.push_back({of, {}, {}, line});
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

  int number_of(const std::string &of)
  {
    for (std::size_t k = 0; k < mesh.sets.size(); k++)
      if (upper(mesh.sets[k].name) == upper(of)) return (int) k;
    mesh.sets.push_back({of, {}});
    return (int) mesh.sets.size() - 1;
  }

  void node(const std::string &text)
  {
    const auto words = split(text);
    if (words.size() < 3) fail("a node needs a number and two or three coordinates");
    std::array<double, 3> x = {0.0, 0.0, 0.0};
    for (std::size_t d = 0; d < 3 && d + 1 < words.size(); d++) {
      char *end;
      x[d] = strtod(words[d + 1].c_str(), &end);
      if (words[d + 1].empty() || *end || !std::isfinite(x[d]))
        fail("'" + words[d + 1] + "' is not a coordinate");
    }
    if (!node_place.emplace(integer(words[0]), (int) mesh.nodes.size()).second)
      fail("node " + words[0] + " is defined twice: a file must have one part");
    mesh.nodes.push_back(x);
  }

  void element(const std::string &text)
  {
    if (left_out) return;
    for (const auto &word : split(text)) row.push_back(integer(word));
    if ((int) row.size() < nnodes + 1) return;
    if ((int) row.size() > nnodes + 1)
      fail("element " + std::to_string(row[0]) + " has too many nodes");
    MeshElement e = {type, 0, row[0], {0, 0, 0, 0, 0, 0, 0, 0}};
    for (int k = 0; k < nnodes; k++) {
      const auto found = node_place.find(row[k + 1]);
      if (found == node_place.end())
        fail("element " + std::to_string(row[0]) + " has the node " + std::to_string(row[k + 1]) +
             ", which the file does not define before");
      e.node[k] = found->second;
      for (int j = 0; j < k; j++)
        if (e.node[j] == e.node[k])
          fail("element " + std::to_string(row[0]) + " has the node " + std::to_string(row[k + 1]) +
               " twice");
    }
    const int place = (int) mesh.elements.size();
    if (!element_place.emplace(row[0], place).second)
      fail("element " + std::to_string(row[0]) + " is defined twice: a file must have one part");
    if (set >= 0) mesh.sets[set].elements.push_back(place);
    mesh.elements.push_back(e);
    row.clear();
  }

  void members(const std::string &text)
  {
    auto words = split(text);
    auto &list = late.back().members;
    if (!generate) {
      list.insert(list.end(), words.begin(), words.end());
      return;
    }
    if (words.size() == 2) words.push_back("1");
    if (words.size() != 3)
      fail("GENERATE needs the first and the last number, and may have a step");
    late.back().ranges.push_back({integer(words[0]), integer(words[1]), integer(words[2])});
    if (late.back().ranges.back()[2] < 1) fail("the step of GENERATE must be positive");
  }

  void add_late(const Late &from)
  {
    line = from.line;
    std::vector<int> more;
    for (const auto &word : from.members) {
      if (!word.empty() && word.find_first_not_of("0123456789") == std::string::npos) {
        const auto found = element_place.find(strtoll(word.c_str(), nullptr, 10));
        if (found != element_place.end()) more.push_back(found->second);
        continue;    // else an element that was left out
      }
      const bool known = std::any_of(mesh.sets.begin(), mesh.sets.end(), [&](const MeshSet &set) {
        return upper(set.name) == upper(word);
      });
      if (!known)
        fail("the set " + from.name + " has the set '" + word + "', which is not defined before");
      const int other = number_of(word);
      more.insert(more.end(), mesh.sets[other].elements.begin(), mesh.sets[other].elements.end());
    }
    for (const auto &[first, last, step] : from.ranges)
      for (const auto &[label, place] :
           element_place)    // and not all numbers, which may be very many
        if (label >= first && label <= last && (label - first) % step == 0) more.push_back(place);
    auto &all = mesh.sets[number_of(from.name)].elements;
    all.insert(all.end(), more.begin(), more.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
  }
};

}    // namespace

Mesh MPM_NS::read_abaqus(std::istream &in, const std::string &name)
{
  return AbaqusReader(in, name).read();
}
