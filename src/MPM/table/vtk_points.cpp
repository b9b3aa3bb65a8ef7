/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// VTK files of points with values of points, as dump mpm/vtk writes them: PolyData in XML with an appended section of bytes, or
// text.

#include "table/table.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>

#ifdef MPM_ZLIB
#include <zlib.h>
#endif

using namespace MPM_NS;

namespace {

template <class T> double as_real(const char *from)
{
  T value;
  memcpy(&value, from, sizeof(T));
  return static_cast<double>(value);
}

struct Kind {
  std::size_t bytes;
  double (*real)(const char *);
};
const std::map<std::string, Kind> kinds = {
    {"Float64", {8, as_real<double>}}, {"Float32", {4, as_real<float>}},
    {"Int64", {8, as_real<int64_t>}},  {"UInt64", {8, as_real<uint64_t>}},
    {"Int32", {4, as_real<int32_t>}},  {"UInt32", {4, as_real<uint32_t>}},
    {"Int16", {2, as_real<int16_t>}},  {"UInt16", {2, as_real<uint16_t>}},
    {"Int8", {1, as_real<int8_t>}},    {"UInt8", {1, as_real<uint8_t>}},
};

class PointsReader {
 public:
  PointsReader(const std::string &text, const std::string &name) : text(text), name(name) {}

  Table read()
  {
    const auto root = element("<VTKFile", 0);
    const std::string type = attribute(root, "type");
    if (type == "PPolyData") return read_pieces();
    if (type != "PolyData")
      fail("is a VTK file of type '" + type + "', expected points (PolyData, .vtp)");
    const uint16_t one = 1;
    const char *machine = *reinterpret_cast<const char *>(&one) ? "LittleEndian" : "BigEndian";
    if (attribute(root, "byte_order") != machine)
      fail("has its bytes in another order than this machine");
    wide = attribute(root, "header_type") == "UInt64";
    const std::string compressor = attribute(root, "compressor");
    compressed = !compressor.empty();
    if (compressed && compressor != "vtkZLibDataCompressor")
      fail("is compressed by " + compressor + ", expected zlib or none");
#ifndef MPM_ZLIB
    if (compressed) fail("is compressed, which needs a LAMMPS that was compiled with zlib");
#endif
    find_appended();
    const auto piece = element("<Piece", 0);
    const auto again = text.find("<Piece", piece.end);
    if (again < appended_tag) fail("has several pieces in one file");
    char *end;
    const std::string number = attribute(piece, "NumberOfPoints");
    const long long n = strtoll(number.c_str(), &end, 10);
    if (number.empty() || *end || n < 0) fail("has no NumberOfPoints");
    if (n == 0) fail("has no points");
    count = (uint64_t) n;
    if (count > text.size()) fail("cannot have " + number + " points, it was cut");

    read_section("PointData");
    read_section("Points");
    if (columns.empty() || !has_points) fail("has no positions of points");
    Table table;
    for (const auto &column : columns) table.names.push_back(column.name);
    table.values.resize(count * columns.size());
    for (std::size_t c = 0; c < columns.size(); c++)
      for (uint64_t k = 0; k < count; k++) {
        const double value = columns[c].values[k];
        if (!std::isfinite(value))
          fail("point " + std::to_string(k) + " has " + columns[c].name + " = " +
               std::to_string(value));
        table.values[k * columns.size() + c] = value;
      }
    read_field_data(table);
    return table;
  }

 private:
  struct Tag {
    std::size_t begin, end;    // of the text of a tag
  };
  struct Column {
    std::string name;
    std::vector<double> values;
  };
  const std::string &text;
  const std::string &name;
  bool wide = false, compressed = false, has_points = false;
  std::size_t appended_tag = std::string::npos, appended = std::string::npos;
  uint64_t count = 0;
  std::vector<Column> columns;

  [[noreturn]] void fail(const std::string &what) const
  {
    throw std::runtime_error(name + ": " + what);
  }

  Tag find_tag(const std::string &head, std::size_t from, std::size_t until) const
  {
    const auto begin = text.find(head, from);
    if (begin >= until) return {std::string::npos, std::string::npos};
    const auto end = text.find('>', begin);
    if (end >= until) fail("ends within " + head + ", it was cut");
    return {begin, end + 1};
  }
  Tag element(const std::string &head, std::size_t from) const
  {
    const auto tag = find_tag(head, from, std::min(appended_tag, text.size()));
    if (tag.begin == std::string::npos) fail("has no " + head + ">");
    return tag;
  }
  /** Empty: there is none. */
  std::string attribute(const Tag &tag, const std::string &key) const
  {
    const std::string words = text.substr(tag.begin, tag.end - tag.begin);
    const auto at = words.find(" " + key + "=\"");
    if (at == std::string::npos) return "";
    const auto from = at + key.size() + 3, to = words.find('"', from);
    return to == std::string::npos ? "" : words.substr(from, to - from);
  }

  /** Where bytes begin: behind an underscore. */
  void find_appended()
  {
    const auto tag = find_tag("<AppendedData", 0, text.size());
    if (tag.begin == std::string::npos) return;
    if (attribute(tag, "encoding") != "raw")
      fail("has its data as base64: save them as appended raw data, or as ASCII");
    appended_tag = tag.begin;
    appended = text.find('_', tag.end);
    if (appended == std::string::npos) fail("ends where its data should begin, it was cut");
    appended++;
  }

  void read_section(const std::string &section)
  {
    const std::size_t until = std::min(appended_tag, text.size());
    const auto begin = find_tag("<" + section + ">", 0, until);
    if (begin.begin == std::string::npos) {
      const auto other = find_tag("<" + section + " ", 0, until);
      if (other.begin == std::string::npos) return;
      read_arrays(section, other.end);
    } else
      read_arrays(section, begin.end);
  }

  void read_arrays(const std::string &section, std::size_t from)
  {
    const auto until = text.find("</" + section + ">", from);
    if (until == std::string::npos) fail("has no end of " + section + ", it was cut");
    for (auto tag = find_tag("<DataArray", from, until); tag.begin != std::string::npos;
         tag = find_tag("<DataArray", tag.end, until)) {
      const std::string what = section == "Points" ? section : attribute(tag, "Name");
      const std::string ncomponent = attribute(tag, "NumberOfComponents");
      const int width = ncomponent.empty() ? 1 : atoi(ncomponent.c_str());
      if (what.empty() || width < 1 || width > 1000)
        fail("has an array '" + what + "' with " + ncomponent + " components");
      if (section == "Points") {
        if (width != 3) fail("has positions with " + std::to_string(width) + " components");
        has_points = true;
      }
      const auto values = read_array(tag, what, width);
      for (int c = 0; c < width; c++) {
        Column column = {width == 1 ? what : what + ":" + std::to_string(c), {}};
        column.values.resize(count);
        for (uint64_t k = 0; k < count; k++) column.values[k] = values[k * width + c];
        for (const auto &other : columns)
          if (other.name == column.name) fail("two arrays have the name " + column.name);
        columns.push_back(std::move(column));
      }
    }
  }

  std::vector<double> read_array(const Tag &tag, const std::string &what, int width) const
  {
    const auto kind = kinds.find(attribute(tag, "type"));
    if (kind == kinds.end())
      fail("array " + what + " is of the unknown type " + attribute(tag, "type"));
    const std::string format = attribute(tag, "format");
    std::vector<double> values;
    const uint64_t n = count * width;
    if (format == "ascii") {
      const char *at = &text[tag.end];
      for (uint64_t k = 0; k < n; k++) {
        char *end;
        const double value = strtod(at, &end);
        if (end == at) fail("array " + what + " ends after " + std::to_string(k) + " numbers");
        values.push_back(value);
        at = end;
      }
      return values;
    }
    if (format != "appended")
      fail("array " + what + " has the format '" + format +
           "': save it as appended raw data, or as ASCII");
    if (appended == std::string::npos) fail("has no appended data, it was cut");
    const std::string bytes = read_bytes(attribute(tag, "offset"), what);
    if (bytes.size() != n * kind->second.bytes)
      fail("array " + what + " has " + std::to_string(bytes.size()) + " bytes, but " +
           std::to_string(count) + " points need " + std::to_string(n * kind->second.bytes));
    values.resize(n);
    for (uint64_t k = 0; k < n; k++) values[k] = kind->second.real(&bytes[k * kind->second.bytes]);
    return values;
  }

  uint64_t length(std::size_t &at, const std::string &what) const
  {
    const std::size_t bytes = wide ? 8 : 4;
    if (text.size() < bytes || at > text.size() - bytes)
      fail("ends within array " + what + ", it was cut");
    uint64_t value = 0;
    uint32_t narrow;
    if (wide)
      memcpy(&value, &text[at], 8);
    else {
      memcpy(&narrow, &text[at], 4);
      value = narrow;
    }
    at += bytes;
    return value;
  }

  std::string read_bytes(const std::string &offset, const std::string &what) const
  {
    char *end;
    const long long place = strtoll(offset.c_str(), &end, 10);
    if (offset.empty() || *end || place < 0 || (uint64_t) place > text.size())
      fail("array " + what + " has the offset '" + offset + "' beyond the end of the file");
    std::size_t at = appended + place;
    const auto check = [&](uint64_t bytes) {
      if (at > text.size() || bytes > text.size() - at)
        fail("ends within array " + what + ", it was cut");
    };
    if (!compressed) {
      const uint64_t bytes = length(at, what);
      check(bytes);
      return text.substr(at, bytes);
    }
#ifdef MPM_ZLIB
    const uint64_t nblock = length(at, what), block = length(at, what), last = length(at, what);
    if (nblock > text.size() || block > (1u << 30) || last > block)
      fail("array " + what + " has blocks that cannot be");
    std::vector<uint64_t> sizes;
    for (uint64_t k = 0; k < nblock; k++) sizes.push_back(length(at, what));
    std::string bytes;
    for (uint64_t k = 0; k < nblock; k++) {
      check(sizes[k]);
      const uLongf expected = k + 1 == nblock && last ? last : block;
      uLongf got = expected;
      const std::size_t before = bytes.size();
      bytes.resize(before + expected);
      if (uncompress((Bytef *) &bytes[before], &got, (const Bytef *) &text[at], sizes[k]) != Z_OK ||
          got != expected)
        fail("array " + what + " cannot be uncompressed");
      at += sizes[k];
    }
    return bytes;
#else
    return "";
#endif
  }

  /** What dump mpm/vtk says of a snapshot. */
  void read_field_data(Table &table) const
  {
    const std::size_t until = std::min(appended_tag, text.size());
    const auto value_of = [&](const std::string &key,
                              const std::function<void(const char *)> &use) {
      const auto tag = find_tag("Name=\"" + key + "\"", 0, until);
      if (tag.begin != std::string::npos) use(&text[tag.end]);
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
    for (auto tag = find_tag("<Piece", 0, text.size()); tag.begin != std::string::npos;
         tag = find_tag("<Piece", tag.end, text.size())) {
      const std::string file = folder + attribute(tag, "Source");
      std::ifstream in(file, std::ios::binary);
      if (!in) fail("cannot read its piece " + file);
      const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
      // a process without points
      if (bytes.find("NumberOfPoints=\"0\"") != std::string::npos) continue;
      Table piece = PointsReader(bytes, file).read();
      if (all.names.empty()) {
        all = std::move(piece);
        continue;
      }
      if (piece.names != all.names || piece.step != all.step)
        fail("its piece " + file + " has other arrays than those before, or is of another step");
      all.values.insert(all.values.end(), piece.values.begin(), piece.values.end());
    }
    if (all.names.empty()) fail("has no pieces with points");
    return all;
  }
};

}    // namespace

Table MPM_NS::read_vtk_points(const std::string &text, const std::string &name)
{
  return PointsReader(text, name).read();
}
