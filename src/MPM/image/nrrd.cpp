/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// NRRD, pictures and stacks with a header as text (https://teem.sourceforge.net/nrrd/format.html):
// values as bytes (encoding raw), in the same file or in one of their own (a header in a file
// .nhdr).

#include "image/file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>

using namespace MPM_NS;

namespace {

std::vector<std::string> words(const std::string &text)
{
  std::vector<std::string> all(1);
  for (const char c : text)
    if (!isspace((unsigned char) c))
      all.back() += c;
    else if (!all.back().empty())
      all.emplace_back();
  if (all.back().empty()) all.pop_back();
  return all;
}

const std::vector<std::pair<ImageKind, std::vector<std::string>>> kinds = {
    {ImageKind::INT8, {"signed char", "int8", "int8_t"}},
    {ImageKind::UINT8, {"uchar", "unsigned char", "uint8", "uint8_t"}},
    {ImageKind::INT16,
     {"short", "short int", "signed short", "signed short int", "int16", "int16_t"}},
    {ImageKind::UINT16, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
    {ImageKind::INT32, {"int", "signed int", "int32", "int32_t"}},
    {ImageKind::UINT32, {"uint", "unsigned int", "uint32", "uint32_t"}},
    {ImageKind::FLOAT, {"float"}},
    {ImageKind::DOUBLE, {"double"}}};

/** The header, and where the values are. */
struct Header {
  ImageFile &in;
  Image image = {};
  std::string kind = "", encoding = "", endian = "", file = "";
  std::vector<int64_t> sizes = {};
  std::vector<double> spacings = {};
  std::vector<std::string> axes = {};
  int64_t dimension = 0, line_skip = 0, byte_skip = 0;

  int64_t integer(const std::string &field, const std::string &word)
  {
    char *end;
    const long long value = strtoll(word.c_str(), &end, 10);
    if (word.empty() || *end || value > 1000000000000 || value < -1000000000000)
      in.fail("field '" + field + "' has '" + word + "' where an integer should be");
    return value;
  }

  void field(const std::string &name, const std::string &text)
  {
    const auto list = words(text);
    const std::string first = list.empty() ? "" : list[0];
    if (name == "type") kind = text;
    if (name == "dimension") dimension = integer(name, first);
    if (name == "sizes")
      for (const auto &word : list) sizes.push_back(integer(name, word));
    if (name == "encoding") encoding = first;
    if (name == "endian") endian = first;
    if (name == "kinds") axes = list;
    if (name == "line skip" || name == "lineskip") line_skip = integer(name, first);
    if (name == "byte skip" || name == "byteskip") byte_skip = integer(name, first);
    if (name == "data file" || name == "datafile") {
      file = text;
      if (first == "LIST" || list.size() > 1)
        in.fail("has its values in several files: join them (unu save), or read them as numbered "
                "files");
    }
    if (name == "spacings")
      for (const auto &word : list) spacings.push_back(strtod(word.c_str(), nullptr));
    if (name == "space directions") {
      int own = 0;                       // axis of space that this one ought to go along
      for (const auto &word : list) {    // (x,y,z) or none: the length
        double sum = 0.0;
        int along = 0;
        for (const char *c = word.c_str(); *c == '(' || *c == ',';) {
          char *end;
          const double x = strtod(c + 1, &end);
          sum += x * x;
          if (along++ == own ? x < 0.0 : x != 0.0) image.turned = true;
          if (end == c + 1) break;
          c = end;
        }
        spacings.push_back(std::sqrt(sum));
        if (along) own++;
      }
    }
  }

  void read()
  {
    std::string text;
    in.line(text);    // the magic
    while (in.line(text) && !text.empty()) {
      if (text[0] == '#' || text.find(":=") != std::string::npos) continue;
      const auto colon = text.find(": ");
      if (colon == std::string::npos)
        in.fail("has the line '" + text + "' in its header, which is no field");
      std::string value = text.substr(colon + 2);
      value.erase(0, value.find_first_not_of(" \t"));
      value.erase(value.find_last_not_of(" \t") + 1);
      field(text.substr(0, colon), value);
    }
  }

  void check()
  {
    bool known = false;
    for (const auto &[which, names] : kinds)
      if (std::count(names.begin(), names.end(), kind)) {
        image.kind = which;
        known = true;
      }
    if (!known)
      in.fail(kind.empty() ? "has no field 'type'"
                           : "has values of type '" + kind +
                      "', which cannot be read: convert them, "
                      "for example to uchar, short, or float");
    if (encoding != "raw")
      in.fail("has the encoding '" + encoding +
              "', of which only raw can be read: convert it by 'unu save -f nrrd -e raw'");
    if (image_bytes(image.kind) > 1 && endian != "little" && endian != "big")
      in.fail("needs a field 'endian' that is little or big");
    if (dimension < 1 || (int64_t) sizes.size() != dimension)
      in.fail("has the dimension " + std::to_string(dimension) + " but " +
              std::to_string(sizes.size()) + " sizes");
    std::size_t first = 0;    // axis of columns
    if (sizes[0] == 3 && !axes.empty() && (axes[0] == "RGB-color" || axes[0] == "3-color")) {
      image.channels = 3;
      first = 1;
    }
    const std::size_t n = sizes.size() - first;
    if (n != 2 && n != 3)
      in.fail("has " + std::to_string(n) + " axes, where 2 or 3 are needed: columns, rows, slices");
    for (std::size_t d = 0; d < 3; d++) image.n[d] = d < n ? sizes[first + d] : 1;
    for (std::size_t d = 0; d < n && spacings.size() == sizes.size(); d++)
      if (std::isfinite(spacings[first + d])) image.spacing[d] = std::abs(spacings[first + d]);
    image.picture = false;
    if (image.kind == ImageKind::UINT8) image.largest = 255;
    if (image.kind == ImageKind::UINT16) image.largest = 65535;
  }

  void read_values(ImageFile &values)
  {
    std::string text;
    for (int64_t k = 0; k < line_skip; k++)
      if (!values.line(text)) values.fail("ends too early, it was cut");
    if (byte_skip < -1) in.fail("has a negative byte skip");
    const double bytes =
        (double) image.n[0] * image.n[1] * image.n[2] * image.channels * image_bytes(image.kind);
    if (byte_skip == -1 && bytes <= (double) values.size)    // the values are at the end
      values.go_to(values.size - (int64_t) image.bytes());
    else if (byte_skip > 0)
      values.go_to(values.here() + byte_skip);
    values.read_values(image, endian == "big");
  }
};

}    // namespace

Image MPM_NS::read_nrrd(ImageFile &in)
{
  Header header{in};
  header.read();
  header.check();
  if (header.file.empty()) {
    header.read_values(in);
  } else {
    const auto folder = in.name.rfind('/');
    std::string name = header.file;
    if (name[0] != '/' && folder != std::string::npos) name = in.name.substr(0, folder + 1) + name;
    ImageFile values(name);
    header.read_values(values);
  }
  return std::move(header.image);
}
