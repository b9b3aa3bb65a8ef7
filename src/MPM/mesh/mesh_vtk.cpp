/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/mesh_file.h"
#include "table/vtk_xml.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <stdexcept>

using namespace MPM_NS;

namespace {

constexpr int64_t MAX_COUNT = 2000000000;

/** Nodes, cells, and their numbers, of which the elements of a mesh are made. */
class VtkCells {
 protected:
  explicit VtkCells(const std::string &name) : name(name) {}

  const std::string name;
  Mesh mesh;
  std::vector<int64_t> cells, offsets, types;
  std::vector<MeshData> of_cells;
  int64_t ncells = 0;

  [[noreturn]] void fail(const std::string &what) const
  {
    throw std::runtime_error(name + ": " + what);
  }

  std::vector<int64_t> whole(const std::vector<double> &values) const
  {
    std::vector<int64_t> all;
    for (const double value : values) {
      if (!(std::fabs(value) <= MAX_COUNT) || value != std::floor(value))
        fail("a number that ought to be an integer is not");
      all.push_back((int64_t) value);
    }
    return all;
  }
  void set_nodes(const std::vector<double> &x)
  {
    for (std::size_t k = 0; k < x.size() / 3; k++) {
      if (!std::isfinite(x[3 * k] + x[3 * k + 1] + x[3 * k + 2]))
        fail("point " + std::to_string(k) + " is not finite");
      mesh.nodes.push_back({x[3 * k], x[3 * k + 1], x[3 * k + 2]});
    }
  }
  Mesh finish()
  {
    if (mesh.nodes.empty() || types.empty()) fail("the file has no points or no cells");
    make_elements();
    return std::move(mesh);
  }

 private:
  std::vector<int> element_of;    // of each cell, -1: left out

  void make_elements()
  {
    if ((int64_t) types.size() != ncells)
      fail("the types of cells (CELL_TYPES) are not those of all cells");
    for (int64_t k = 0; k < ncells; k++) {
      const int64_t first = offsets[k], n = offsets[k + 1] - first;
      const int type = (int) types[k];
      element_of.push_back(-1);
      if (type == 1 || type == 2 || type == 4) continue;    // points, and lines of several parts
      static const std::map<int, ElementType> supported = {
          {3, ElementType::LINE},         {5, ElementType::TRIANGLE},
          {8, ElementType::QUAD},         {9, ElementType::QUAD},
          {10, ElementType::TETRAHEDRON}, {11, ElementType::HEXAHEDRON},
          {12, ElementType::HEXAHEDRON}};
      const auto found = supported.find(type);
      if (found == supported.end())
        fail("cell " + std::to_string(k) + " is of VTK's type " + std::to_string(type) +
             ", which is not supported: only lines, triangles, quadrangles, tetrahedra, and "
             "hexahedra of first order are");
      MeshElement e = {found->second, 0, k, {0, 0, 0, 0, 0, 0, 0, 0}};
      if (n != element_nodes(e.type) || first < 0 || first + n > (int64_t) cells.size())
        fail("cell " + std::to_string(k) + " has a wrong number of points");
      for (int j = 0; j < n; j++) {
        const int64_t node = cells[first + j];
        if (node < 0 || node >= (int64_t) mesh.nodes.size())
          fail("cell " + std::to_string(k) + " has the point " + std::to_string(node) +
               ", which the file does not have");
        e.node[j] = (int) node;
        for (int i = 0; i < j; i++)
          if (e.node[i] == e.node[j])
            fail("cell " + std::to_string(k) + " has the point " + std::to_string(node) + " twice");
      }
      // pixels and voxels count along x, y, z
      if (type == 8 || type == 11) std::swap(e.node[2], e.node[3]);
      if (type == 11) std::swap(e.node[6], e.node[7]);
      element_of.back() = (int) mesh.elements.size();
      mesh.elements.push_back(e);
    }
    for (auto &d : of_cells) {
      std::vector<double> kept;
      for (int64_t k = 0; k < ncells; k++)
        for (int c = 0; c < d.width && element_of[k] >= 0; c++)
          kept.push_back(d.values[k * d.width + c]);
      d.values.swap(kept);
      mesh.data.push_back(d);
    }
    try {
      mesh.check_repeated();
    } catch (const std::runtime_error &e) {
      fail(e.what());
    }
  }
};

/** Legacy files. */
class VtkReader : private VtkCells {
 public:
  VtkReader(std::istream &in, const std::string &name) : VtkCells(name), in(in) {}

  Mesh read()
  {
    skip_line();    // version, known
    skip_line();    // title
    std::string word = need();
    if (word != "ASCII" && word != "BINARY") fail("'" + word + "' is neither ASCII nor BINARY");
    binary = word == "BINARY";
    if (need() != "DATASET" || need() != "UNSTRUCTURED_GRID")
      fail("only DATASET UNSTRUCTURED_GRID can be read");
    while (in >> word) section(word);
    return finish();
  }

 private:
  std::istream &in;
  bool binary = false;
  int64_t ndata = 0;    // tuples of the present data
  bool at_nodes = true;

  std::string need()
  {
    std::string word;
    if (!(in >> word)) fail("the file ends too early");
    return word;
  }
  int64_t count()
  {
    const std::string word = need();
    char *end;
    const long long value = strtoll(word.c_str(), &end, 10);
    if (*end || value < 0 || value > MAX_COUNT) fail("'" + word + "' is not a count");
    return value;
  }
  void skip_line() { in.ignore(std::numeric_limits<std::streamsize>::max(), '\n'); }

  /** Binary numbers begin after the line of their type, and have the most significant byte
   *  first. */
  template <class T> double number_as()
  {
    char raw[sizeof(T)];
    if (!in.read(raw, sizeof(T))) fail("the file ends too early");
    const uint16_t one = 1;
    char low;
    memcpy(&low, &one, 1);
    if (low) std::reverse(raw, raw + sizeof(T));
    T value;
    memcpy(&value, raw, sizeof(T));
    return (double) value;
  }
  std::vector<double> numbers(const std::string &type, int64_t n)
  {
    using Read = double (VtkReader::*)();
    static const std::map<std::string, Read> readers = {
        {"float", &VtkReader::number_as<float>},
        {"double", &VtkReader::number_as<double>},
        {"int", &VtkReader::number_as<int32_t>},
        {"vtktypeint32", &VtkReader::number_as<int32_t>},
        {"unsigned_int", &VtkReader::number_as<uint32_t>},
        {"long", &VtkReader::number_as<int64_t>},
        {"vtktypeint64", &VtkReader::number_as<int64_t>},
        {"vtkIdType", &VtkReader::number_as<int64_t>},
        {"short", &VtkReader::number_as<int16_t>},
        {"unsigned_char", &VtkReader::number_as<uint8_t>},
        {"char", &VtkReader::number_as<int8_t>},
        {"signed_char", &VtkReader::number_as<int8_t>}};
    const auto reader = readers.find(type);
    std::vector<double> all;
    if (binary) skip_line();
    for (int64_t k = 0; k < n; k++) {
      if (binary) {
        if (reader == readers.end()) fail("numbers of type " + type + " are not supported");
        all.push_back((this->*reader->second)());
        continue;
      }
      const std::string word = need();
      char *end;
      all.push_back(strtod(word.c_str(), &end));
      if (*end) fail("'" + word + "' is not a number");
    }
    return all;
  }

  void section(const std::string &word)
  {
    if (word == "POINTS") {
      const int64_t n = count();
      set_nodes(numbers(need(), 3 * n));
    } else if (word == "CELLS") {
      const int64_t n = count(), size = count();
      const auto at = in.tellg();
      std::string next;
      skip_line();
      const auto after = in.tellg();
      std::getline(in, next);
      if (next.compare(0, 7, "OFFSETS") == 0) {    // version 5
        in.clear();
        in.seekg(after);
        need();
        offsets = whole(numbers(need(), n));
        if (need() != "CONNECTIVITY") fail("CONNECTIVITY is missing");
        cells = whole(numbers(need(), size));
        ncells = n - 1;
        if (ncells < 0 || offsets[0] != 0 || offsets[ncells] != size)
          fail("offsets of cells are wrong");
      } else {
        in.clear();
        in.seekg(at);
        const auto raw = whole(numbers("int", size));
        ncells = n;
        offsets.assign(1, 0);
        for (int64_t k = 0; k < size;) {
          const int64_t m = raw[k++];
          if (m < 0 || m > size - k) fail("cells have more points than their list");
          for (int64_t j = 0; j < m; j++) cells.push_back(raw[k++]);
          offsets.push_back((int64_t) cells.size());
        }
        if ((int64_t) offsets.size() != ncells + 1)
          fail("the list of cells has not as many as it says");
      }
    } else if (word == "CELL_TYPES")
      types = whole(numbers("int", count()));
    else if (word == "POINT_DATA" || word == "CELL_DATA") {
      at_nodes = word == "POINT_DATA";
      ndata = count();
      if (ndata != (at_nodes ? (int64_t) mesh.nodes.size() : ncells))
        fail(word + " is not for all");
    } else if (word == "SCALARS") {
      const std::string what = need(), type = need();
      std::string rest;
      std::getline(in, rest);
      const int width = rest.find_first_not_of(" \t\r") == std::string::npos ? 1
                                                                             : atoi(rest.c_str());
      if (width < 1 || width > 4) fail("scalars have 1 to 4 components");
      if (need() != "LOOKUP_TABLE") fail("LOOKUP_TABLE is missing");
      need();
      add(what, width, type);
    } else if (word == "VECTORS" || word == "NORMALS" || word == "TENSORS") {
      const std::string what = need(), type = need();
      add(what, word == "TENSORS" ? 9 : 3, type);
    } else if (word == "FIELD") {
      const std::string of = need();
      for (int64_t n = count(); n > 0; n--) {
        const std::string what = need();
        const int64_t width = count(), m = count();
        const std::string type = need();
        const bool mine = ndata > 0 && m == ndata && width <= 1000;
        if (mine)
          add(what, (int) width, type);
        else
          numbers(type, width * m);
      }
    } else if (word == "METADATA") {    // to the next empty line
      skip_line();
      for (std::string line; std::getline(in, line) && !line.empty() && line != "\r";) {}
    } else
      fail("'" + word + "' is not supported");
  }

  void add(const std::string &what, int width, const std::string &type)
  {
    auto &list = at_nodes ? mesh.data : of_cells;
    list.push_back({what, at_nodes, width, numbers(type, width * ndata)});
  }
};

/** Files in XML. */
class VtuReader : private VtkCells {
 public:
  VtuReader(const std::string &text, const std::string &name) : VtkCells(name), xml(text, name) {}

  Mesh read()
  {
    if (xml.type() != "UnstructuredGrid")
      fail("is a VTK file of type '" + xml.type() + "', expected UnstructuredGrid (.vtu)");
    const auto piece = xml.open();
    const uint64_t n = xml.count(piece, "NumberOfPoints");
    ncells = (int64_t) xml.count(piece, "NumberOfCells");
    const auto points = xml.section("Points", n);
    if (points.empty() || points[0].width != 3) fail("has no points with three components");
    set_nodes(points[0].values);
    for (const auto &array : xml.section("Cells", VtkXml::ANY)) {
      if (array.name == "connectivity") cells = whole(array.values);
      if (array.name == "types") types = whole(array.values);
      if (array.name != "offsets") continue;
      offsets = whole(array.values);    // of ends
      offsets.insert(offsets.begin(), 0);
    }
    if ((int64_t) offsets.size() != ncells + 1) fail("the offsets are not those of all cells");
    for (const auto &array : xml.section("PointData", n))
      mesh.data.push_back({array.name, true, array.width, array.values});
    for (const auto &array : xml.section("CellData", ncells))
      of_cells.push_back({array.name, false, array.width, array.values});
    return finish();
  }

 private:
  VtkXml xml;
};

}    // namespace

Mesh MPM_NS::read_vtu_mesh(const std::string &text, const std::string &name)
{
  return VtuReader(text, name).read();
}

Mesh MPM_NS::read_vtk_mesh(std::istream &in, const std::string &name)
{
  return VtkReader(in, name).read();
}
