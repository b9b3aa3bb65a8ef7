/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "table/vtk_xml.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>
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

/** Of a character of base64; -1: it is none. */
int digit(char c)
{
  static const std::string digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto at = digits.find(c);
  return at == std::string::npos ? -1 : (int) at;
}

bool is_blank(char c)
{
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

}    // namespace

/** Bytes of an array one after another, as they are or from base64, where what was encoded by
 *  itself (as the lengths of compressed blocks are) ends with a group of four characters. */
class VtkXml::Bytes {
 public:
  Bytes(const VtkXml &file, std::size_t at, bool in_base64, const std::string &what) :
      file(file), at(at), in_base64(in_base64), what(what)
  {
  }

  std::string take(uint64_t n)
  {
    const auto &text = file.text;
    if (!in_base64) {
      if (at > text.size() || n > text.size() - at) cut();
      at += n;
      return text.substr(at - n, n);
    }
    if (n > text.size()) cut();
    while (decoded.size() - used < n) decode();
    used += n;
    return decoded.substr(used - n, n);
  }
  uint64_t length()
  {
    const std::string bytes = take(file.wide ? 8 : 4);
    return (uint64_t) (file.wide ? as_real<uint64_t>(bytes.data())
                                 : as_real<uint32_t>(bytes.data()));
  }

 private:
  const VtkXml &file;
  std::size_t at, used = 0;
  const bool in_base64;
  const std::string what;
  std::string decoded;

  [[noreturn]] void cut() const { file.fail("ends within array " + what + ", it was cut"); }

  /** The next group. */
  void decode()
  {
    const auto &text = file.text;
    int value[4], n = 0, filled = 4;
    while (n < 4) {
      if (at >= text.size() || text[at] == '<') cut();
      const char c = text[at++];
      if (is_blank(c)) continue;
      if (c == '=' && n >= 2) {
        filled = std::min(filled, n);
        value[n++] = 0;
        continue;
      }
      value[n] = digit(c);
      if (value[n++] < 0 || filled < 4) file.fail("array " + what + " is not in base64");
    }
    const int all = (value[0] << 18) | (value[1] << 12) | (value[2] << 6) | value[3];
    for (int k = 0; k < filled - 1; k++) decoded += (char) ((all >> (16 - 8 * k)) & 255);
  }
};

VtkXml::VtkXml(const std::string &text, const std::string &name) : text(text), name(name)
{
  root = element("<VTKFile", 0);
  kind_of_file = attribute(root, "type");
}

void VtkXml::fail(const std::string &what) const
{
  throw std::runtime_error(name + ": " + what);
}

std::size_t VtkXml::end() const
{
  return std::min(appended_tag, text.size());
}

VtkXml::Tag VtkXml::find_tag(const std::string &head, std::size_t from, std::size_t until) const
{
  const auto begin = text.find(head, from);
  if (begin >= until) return {std::string::npos, std::string::npos};
  const auto close = text.find('>', begin);
  if (close >= until) fail("ends within " + head + ", it was cut");
  return {begin, close + 1};
}

VtkXml::Tag VtkXml::element(const std::string &head, std::size_t from) const
{
  const auto tag = find_tag(head, from, end());
  if (!tag.is_there()) fail("has no " + head + ">");
  return tag;
}

std::string VtkXml::attribute(const Tag &tag, const std::string &key) const
{
  const std::string words = text.substr(tag.begin, tag.end - tag.begin);
  for (auto at = words.find(key + "=\""); at != std::string::npos;
       at = words.find(key + "=\"", at + 1)) {
    if (!is_blank(words[at - 1])) continue;
    const auto from = at + key.size() + 2, to = words.find('"', from);
    return to == std::string::npos ? "" : words.substr(from, to - from);
  }
  return "";
}

VtkXml::Tag VtkXml::open()
{
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
  if (find_tag("<Piece", piece.end, end()).is_there()) fail("has several pieces in one file");
  return piece;
}

uint64_t VtkXml::count(const Tag &piece, const std::string &key) const
{
  char *rest;
  const std::string number = attribute(piece, key);
  const long long n = strtoll(number.c_str(), &rest, 10);
  if (number.empty() || *rest || n < 0) fail("has no " + key);
  if ((uint64_t) n > text.size()) fail("cannot have " + key + " " + number + ", it was cut");
  return (uint64_t) n;
}

/** Where bytes begin: behind an underscore. */
void VtkXml::find_appended()
{
  const auto tag = find_tag("<AppendedData", 0, text.size());
  if (!tag.is_there()) return;
  const std::string encoding = attribute(tag, "encoding");
  in_base64 = encoding == "base64";
  if (!in_base64 && encoding != "raw")
    fail("has appended data with the encoding '" + encoding + "', expected raw or base64");
  appended_tag = tag.begin;
  appended = text.find('_', tag.end);
  if (appended == std::string::npos) fail("ends where its data should begin, it was cut");
  appended++;
}

std::vector<VtkXml::Array> VtkXml::section(const std::string &section, uint64_t tuples) const
{
  std::vector<Array> arrays;
  auto begin = find_tag("<" + section + ">", 0, end());
  if (!begin.is_there()) begin = find_tag("<" + section + " ", 0, end());
  if (!begin.is_there() || text[begin.end - 2] == '/') return arrays;
  const auto until = text.find("</" + section + ">", begin.end);
  if (until == std::string::npos) fail("has no end of " + section + ", it was cut");
  for (auto tag = find_tag("<DataArray", begin.end, until); tag.is_there();
       tag = find_tag("<DataArray", tag.end, until)) {
    const std::string what = section == "Points" ? section : attribute(tag, "Name");
    const std::string ncomponent = attribute(tag, "NumberOfComponents");
    const int width = ncomponent.empty() ? 1 : atoi(ncomponent.c_str());
    if (what.empty() || width < 1 || width > 1000)
      fail("has an array '" + what + "' with " + ncomponent + " components");
    arrays.push_back({what, width, read_array(tag, what, tuples == ANY ? ANY : tuples * width)});
  }
  return arrays;
}

std::vector<double> VtkXml::read_array(const Tag &tag, const std::string &what,
                                       uint64_t numbers) const
{
  const auto kind = kinds.find(attribute(tag, "type"));
  if (kind == kinds.end())
    fail("array " + what + " is of the unknown type " + attribute(tag, "type"));
  const std::string format = attribute(tag, "format");
  if (format == "ascii") return read_text(tag, what, numbers);
  std::string bytes;
  if (format == "binary") {
    Bytes inside(*this, tag.end, true, what);
    bytes = read_bytes(inside, what);
  } else if (format == "appended") {
    if (appended == std::string::npos) fail("has no appended data, it was cut");
    char *rest;
    const std::string offset = attribute(tag, "offset");
    const long long place = strtoll(offset.c_str(), &rest, 10);
    if (offset.empty() || *rest || place < 0 || (uint64_t) place > text.size())
      fail("array " + what + " has the offset '" + offset + "' beyond the end of the file");
    Bytes behind(*this, appended + place, in_base64, what);
    bytes = read_bytes(behind, what);
  } else
    fail("array " + what + " has the unknown format '" + format + "'");
  const std::size_t size = kind->second.bytes;
  if (numbers == ANY ? bytes.size() % size : bytes.size() != numbers * size)
    fail("array " + what + " has " + std::to_string(bytes.size()) + " bytes, but " +
         (numbers == ANY
              ? "its numbers have " + std::to_string(size) + " each"
              : std::to_string(numbers) + " numbers need " + std::to_string(numbers * size)));
  std::vector<double> values(bytes.size() / size);
  for (std::size_t k = 0; k < values.size(); k++) values[k] = kind->second.real(&bytes[k * size]);
  return values;
}

std::vector<double> VtkXml::read_text(const Tag &tag, const std::string &what,
                                      uint64_t numbers) const
{
  std::vector<double> values;
  const char *at = &text[tag.end];
  for (uint64_t k = 0; k < numbers; k++) {
    char *rest;
    const double value = strtod(at, &rest);
    if (rest == at && numbers == ANY) break;
    if (rest == at) fail("array " + what + " ends after " + std::to_string(k) + " numbers");
    values.push_back(value);
    at = rest;
  }
  return values;
}

std::string VtkXml::read_bytes(Bytes &from, const std::string &what) const
{
  return compressed ? uncompressed(from, what) : from.take(from.length());
}

std::string VtkXml::uncompressed([[maybe_unused]] Bytes &from,
                                 [[maybe_unused]] const std::string &what) const
{
  std::string bytes;
#ifdef MPM_ZLIB
  const uint64_t nblock = from.length(), block = from.length(), last = from.length();
  if (nblock > text.size() || block > (1u << 30) || last > block)
    fail("array " + what + " has blocks that cannot be");
  std::vector<uint64_t> sizes;
  for (uint64_t k = 0; k < nblock; k++) sizes.push_back(from.length());
  for (uint64_t k = 0; k < nblock; k++) {
    const std::string packed = from.take(sizes[k]);
    const uLongf expected = k + 1 == nblock && last ? last : block;
    uLongf got = expected;
    const std::size_t before = bytes.size();
    bytes.resize(before + expected);
    if (uncompress((Bytef *) &bytes[before], &got, (const Bytef *) packed.data(), sizes[k]) !=
            Z_OK ||
        got != expected)
      fail("array " + what + " cannot be uncompressed");
  }
#endif
  return bytes;
}
