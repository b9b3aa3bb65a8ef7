/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// VTK files of points with values of points, as dump mpm/vtk writes them: PolyData in XML with an
// appended section of bytes, or text.

#include "table/table.h"
#include "table/vtk_xml.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>

using namespace MPM_NS;

namespace {

class PointsReader {
 public:
  PointsReader(const std::string &text, const std::string &name) :
      text(text), name(name), xml(text, name)
  {
  }

  Table read()
  {
    if (xml.type() == "PPolyData") return read_pieces();
    if (xml.type() != "PolyData")
      xml.fail("is a VTK file of type '" + xml.type() + "', expected points (PolyData, .vtp)");
    const uint64_t n = xml.count(xml.open(), "NumberOfPoints");
    if (n == 0) xml.fail("has no points");
    auto arrays = xml.section("PointData", n);
    const auto points = xml.section("Points", n);
    if (points.empty()) xml.fail("has no positions of points");
    if (points[0].width != 3)
      xml.fail("has positions with " + std::to_string(points[0].width) + " components");
    arrays.insert(arrays.end(), points.begin(), points.end());

    Table table;
    for (const auto &array : arrays)
      for (int c = 0; c < array.width; c++) {
        const std::string column = array.width == 1 ? array.name
                                                    : array.name + ":" + std::to_string(c);
        for (const auto &other : table.names)
          if (other == column) xml.fail("two arrays have the name " + column);
        table.names.push_back(column);
      }
    table.values.reserve(n * table.names.size());
    for (uint64_t k = 0; k < n; k++)
      for (const auto &array : arrays)
        for (int c = 0; c < array.width; c++) {
          const double value = array.values[k * array.width + c];
          if (!std::isfinite(value))
            xml.fail("point " + std::to_string(k) + " has " +
                     table.names[table.values.size() % table.names.size()] + " = " +
                     std::to_string(value));
          table.values.push_back(value);
        }
    read_field_data(table);
    return table;
  }

 private:
  const std::string &text, &name;
  VtkXml xml;

  /** What dump mpm/vtk says of a snapshot. */
  void read_field_data(Table &table) const
  {
    const std::size_t until = xml.end();
    const auto value_of = [&](const std::string &key,
                              const std::function<void(const char *)> &use) {
      const auto tag = xml.find_tag("Name=\"" + key + "\"", 0, until);
      if (tag.is_there()) use(&text[tag.end]);
    };
    value_of("TimeValue", [&](const char *at) {
      table.time = strtod(at, nullptr);
    });
    value_of("TimeStep", [&](const char *at) {
      table.step = strtoll(at, nullptr, 10);
    });
    value_of("Units", [&](const char *at) {
      std::istringstream codes(std::string(at, strcspn(at, "<")));
      for (int code; codes >> code && code > 0 && code < 128;) table.units += (char) code;
    });
    table.is_dump = table.step >= 0;
  }

  Table read_pieces()
  {
    const auto slash = name.find_last_of('/');
    const std::string folder = slash == std::string::npos ? "" : name.substr(0, slash + 1);
    Table all;
    for (auto tag = xml.find_tag("<Piece", 0, text.size()); tag.is_there();
         tag = xml.find_tag("<Piece", tag.end, text.size())) {
      const std::string file = folder + xml.attribute(tag, "Source");
      std::ifstream in(file, std::ios::binary);
      if (!in) xml.fail("cannot read its piece " + file);
      const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
      // a process without points
      if (bytes.find("NumberOfPoints=\"0\"") != std::string::npos) continue;
      Table piece = PointsReader(bytes, file).read();
      if (all.names.empty()) {
        all = std::move(piece);
        continue;
      }
      if (piece.names != all.names || piece.step != all.step)
        xml.fail("its piece " + file +
                 " has other arrays than those before, or is of another step");
      all.values.insert(all.values.end(), piece.values.begin(), piece.values.end());
    }
    if (all.names.empty()) xml.fail("has no pieces with points");
    return all;
  }
};

}    // namespace

Table MPM_NS::read_vtk_points(const std::string &text, const std::string &name)
{
  return PointsReader(text, name).read();
}
